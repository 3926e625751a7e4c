/* New diffuse particles: each particle of water makes as many as its rate says, in a cylinder along its way
   through the substep (Ihmsen et al. 2012, section 3.2). Whole numbers come by chance, so that the mean is
   right. Drawback: those that find no room are left out evenly, by a lower rate of all. */
#include "view/foam/foam.h"

typedef struct make_view {
    tobi_foam *f;
    double s, dt, thin;          /* thin: of all rates */
    int64_t first, most;         /* id of the first; how many there is room for */
} make_view;

static double rate_of(const make_view *v, int64_t i)
{
    const foam_water *a = &v->f->before, *b = &v->f->after;
    const int64_t j = a->partner[i];
    return j < 0 ? 0 : (1 - v->s)*(double)a->rate[i] + v->s*(double)b->rate[j];
}

static void count_new(const void *view, int64_t begin, int64_t end)
{
    const make_view *v = view;
    const tobi_foam *f = v->f;
    for (int64_t i = begin; i < end; i++) {
        const double mean = v->thin*v->dt*rate_of(v, i);
        f->number[i] = mean > 0 ? (int64_t)(mean + foam_chance(f->before.id[i], f->substep, 0)) : 0;
    }
}

/* Two unit vectors across a third. */
static void find_across(const double n[3], double e[3], double g[3])
{
    int least = fabs(n[0]) < fabs(n[1]) ? 0 : 1;
    double length = 0;
    if (fabs(n[2]) < fabs(n[least])) least = 2;
    for (int a = 0; a < 3; a++) e[a] = (a == least) - n[least]*n[a];
    for (int a = 0; a < 3; a++) length += e[a]*e[a];
    for (int a = 0; a < 3; a++) e[a] /= sqrt(length);
    for (int a = 0; a < 3; a++) g[a] = n[(a + 1)%3]*e[(a + 2)%3] - n[(a + 2)%3]*e[(a + 1)%3];
}

/* The k-th of a particle at x with velocity u. */
static void make_one(const make_view *v, int64_t i, int k, const double x[3], const double u[3], foam_drop *d)
{
    const tobi_foam *f = v->f;
    const int64_t id = f->before.id[i];
    double chance[4], n[3], e[3], g[3], speed = sqrt(u[0]*u[0] + u[1]*u[1] + u[2]*u[2]);
    for (int m = 0; m < 4; m++) chance[m] = foam_chance(id, f->substep, 1 + 4*k + m);
    for (int a = 0; a < 3; a++) n[a] = speed > 0 ? u[a]/speed : (double)(a == 0);
    find_across(n, e, g);
    const double share = sqrt(chance[0]), angle = 6.283185307179586*chance[1];
    const double wide = f->def.spacing/2, along = v->dt*(chance[2] - 0.5);
    const double spread = (double)f->before.spread[i];
    for (int a = 0; a < 3; a++) {
        double across = share*(cos(angle)*e[a] + sin(angle)*g[a]);
        if (f->def.dimension == 2) across = (2*chance[0] - 1)*(a == 0 ? -n[1] : a == 1 ? n[0] : 0);
        d->x[a] = x[a] + wide*across + along*u[a];
        d->v[a] = u[a] + spread*across;
    }
    d->age = 0;
    d->life = (float)(-f->lifetime*log(1 - chance[3]));
    d->kind = TOBI_FOAM;
}

static void fill_new(const void *view, int64_t begin, int64_t end)
{
    const make_view *v = view;
    tobi_foam *f = v->f;
    double x[3], u[3];
    for (int64_t i = begin; i < end; i++) {
        const int64_t from = f->number[i], to = f->number[i + 1];
        if (from >= v->most || from == to || !foam_find_row(&f->before, &f->after, v->s, i, x, u)) continue;
        for (int64_t k = from; k < to && k < v->most; k++) {
            foam_drop *d = &f->drop[f->count + k];
            make_one(v, i, (int)(k - from), x, u, d);
            d->id = v->first + k;
        }
    }
}

static int64_t count_all(make_view *v)
{
    tobi_foam *f = v->f;
    tobi_loop(f->exec.threads, f->before.count, 0, count_new, v);
    return f->number[f->before.count] = tobi_scan(&f->exec, f->before.count, f->number);
}

static tobi_status grow(tobi_foam *f, int64_t count, tobi_error *err)
{
    if (count <= f->drop_room) return TOBI_OK;
    const int64_t room = count + count/2 + 1024;
    foam_drop *longer = tobi_array_grow(f->drop, f->count, room, sizeof *longer);
    if (!longer) return foam_no_memory(err);
    f->drop = longer, f->drop_room = room;
    return TOBI_OK;
}

tobi_status foam_make(tobi_foam *f, double s, double dt, tobi_error *err)
{
    make_view v = { .f = f, .s = s, .dt = dt, .thin = 1, .first = f->next_id };
    v.most = f->def.most - f->count;
    if (!foam_room(&f->number, &f->number_room, f->before.count + 1, sizeof *f->number))
        return foam_no_memory(err);
    TOBI_TRY(tobi_exec_reserve(&f->exec, f->before.count, err));
    int64_t count = count_all(&v);
    if (count > v.most) {
        f->left_out += (double)(count - v.most);
        v.thin = (double)v.most/(double)count;
        count = count_all(&v);
        if (count > v.most) count = v.most;
    }
    TOBI_TRY(grow(f, f->count + count, err));
    tobi_loop(f->exec.threads, f->before.count, 1024, fill_new, &v);
    f->count += count;
    f->next_id += count;
    return TOBI_OK;
}

tobi_status tobi_foam_add(tobi_foam *foam, const double position[3], const double velocity[3], double life,
                          tobi_error *err)
{
    TOBI_NEED(foam, "the foam");
    TOBI_NEED(position, "the position");
    TOBI_NEED(velocity, "the velocity");
    if (foam->count >= foam->def.most)
        return tobi_fail(err, TOBI_INVALID, "foam: there are %lld diffuse particles already, as many as "
                         "there may be", (long long)foam->count);
    TOBI_TRY(grow(foam, foam->count + 1, err));
    foam_drop *d = &foam->drop[foam->count++];
    *d = (foam_drop){ .life = (float)life, .kind = TOBI_FOAM, .id = foam->next_id++ };
    for (int a = 0; a < 3; a++) d->x[a] = position[a], d->v[a] = velocity[a];
    return TOBI_OK;
}
