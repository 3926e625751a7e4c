/* Diffuse particles through a substep (Ihmsen et al. 2012, section 3.3). By how much water is around, each is
   spray, which flies; foam, which moves with the water; or a bubble, which rises and is dragged along, its
   velocity taken exactly through the substep. Foam and spray dissolve, bubbles do not; what comes into a body
   is gone. Drawback: they do not feel each other. */
#include "view/foam/foam.h"

typedef struct move_view { tobi_foam *f; double dt; int64_t *first; } move_view;

#define INSIDE 0.6f              /* fullness of a body, above which a place is in it */

/* Fullness of water and bodies at x, and the water's mean velocity; INFINITY: in a body. */
static float look_around(const tobi_foam *f, const double x[3], double u[3])
{
    const foam_cells *c = &f->cells;
    const float inverse = (float)(1/c->reach);
    const float p[3] = { (float)(x[0] - c->low[0]), (float)(x[1] - c->low[1]), (float)(x[2] - c->low[2]) };
    float sum = 0, solid = 0, mean[3] = { 0, 0, 0 };
    int64_t from, to;
    foam_runs r = foam_first_run(c, p);
    while (foam_next_run(c, &r, &from, &to))
        for (int64_t j = from; j < to; j++) {
            const tobi_float4 q = c->place[j], v = c->move[j];
            const float d[3] = { q.x - p[0], q.y - p[1], q.z - p[2] };
            const float square = d[0]*d[0] + d[1]*d[1] + d[2]*d[2], w = 1 - sqrtf(square)*inverse;
            if (!(w > 0)) continue;
            if (q.w >= FOAM_SOLID) {
                solid += w;
                continue;
            }
            sum += w;
            mean[0] += w*v.x, mean[1] += w*v.y, mean[2] += w*v.z;
        }
    for (int a = 0; a < 3; a++) u[a] = sum > 0 ? (double)(mean[a]/sum) : 0;
    return solid > INSIDE*f->full ? INFINITY : (sum + solid)/f->full;
}

/* Spray beyond a side is gone; what is in water stays in the domain. */
static void meet_sides(const tobi_foam *f, foam_drop *d)
{
    for (int a = 0; a < f->def.dimension; a++) {
        const double low = f->def.box_min[a], high = f->def.box_max[a];
        if (d->x[a] >= low && d->x[a] <= high) continue;
        if (d->kind == TOBI_SPRAY) d->kind = -1;
        d->x[a] = d->x[a] < low ? low : high;
    }
}

static void move_one(const tobi_foam *f, double dt, foam_drop *d)
{
    double u[3];
    const float fullness = look_around(f, d->x, u);
    d->age += (float)dt;
    if (fullness == INFINITY) {
        d->kind = -1;
        return;
    }
    if (fullness < FOAM_SPRAY) {
        d->kind = TOBI_SPRAY;
        for (int a = 0; a < 3; a++) {
            d->x[a] += dt*(d->v[a] + 0.5*dt*f->def.gravity[a]);
            d->v[a] += dt*f->def.gravity[a];
        }
    } else {
        const double share = fullness > FOAM_BUBBLE && f->relax > 0 ? 1 - exp(-dt/f->relax) : 1;
        const double rise = fullness > FOAM_BUBBLE ? f->rise : 0;
        d->kind = fullness > FOAM_BUBBLE ? TOBI_BUBBLE : TOBI_FOAM;
        for (int a = 0; a < 3; a++) {
            const double end = u[a] + rise*f->up[a], slip = d->v[a] - end;
            d->x[a] += dt*end + (share < 1 ? f->relax*share*slip : 0);
            d->v[a] = end + (1 - share)*slip;
        }
    }
    if (d->kind != TOBI_BUBBLE) d->life -= (float)dt;
    if (!(d->life > 0) || !isfinite(d->x[0] + d->x[1] + d->x[2])) d->kind = -1;
    else meet_sides(f, d);
}

static void move_all(const void *view, int64_t begin, int64_t end)
{
    const move_view *v = view;
    for (int64_t i = begin; i < end; i++) {
        move_one(v->f, v->dt, &v->f->drop[i]);
        v->first[i] = v->f->drop[i].kind >= 0;
    }
}

static void keep_all(const void *view, int64_t begin, int64_t end)
{
    const move_view *v = view;
    for (int64_t i = begin; i < end; i++)
        if (v->f->drop[i].kind >= 0) v->f->spare[v->first[i]] = v->f->drop[i];
}

tobi_status foam_move(tobi_foam *f, double dt, tobi_error *err)
{
    if (!foam_room(&f->number, &f->number_room, f->count + 1, sizeof *f->number) ||
        !foam_room(&f->spare, &f->spare_room, f->count, sizeof *f->spare)) return foam_no_memory(err);
    TOBI_TRY(tobi_exec_reserve(&f->exec, f->count, err));
    const move_view v = { f, dt, f->number };
    tobi_loop(f->exec.threads, f->count, 256, move_all, &v);
    const int64_t kept = tobi_scan(&f->exec, f->count, f->number);
    if (kept == f->count) return TOBI_OK;
    tobi_loop(f->exec.threads, f->count, 0, keep_all, &v);
    foam_drop *const old = f->drop;
    const int64_t room = f->drop_room;
    f->drop = f->spare, f->drop_room = f->spare_room;
    f->spare = old, f->spare_room = room;
    f->count = kept;
    return TOBI_OK;
}
