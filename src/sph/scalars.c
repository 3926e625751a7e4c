/* Temperature and concentration: explicit diffusion at the positions of the lists, walls with values or
   fluxes. Drawback: a step of strong diffusion, as of heat in liquid metals, is short. */
#include "sph/scalars.h"
#include "sph/boundary/boundary.h"
#include "sph/scalars.k.h"
#include "sph/stages.h"
#include "sph/state.h"
#include <math.h>

int sph_scalars_any(const tobi_system *s)
{
    int any = 0;
    for (int k = 0; k < TOBI_SCALAR_LIMIT; k++) any |= s->sim->scalar[k].given;
    return any;
}

int sph_scalars_thin(const tobi_system *s)
{
    int any = 0;
    for (int k = 0; k < TOBI_SCALAR_LIMIT; k++) any |= s->sim->scalar[k].thinning != 0;
    return any;
}

tobi_scalar_lift sph_scalars_lift(const tobi_system *s)
{
    tobi_scalar_lift lift = { 0 };
    for (int k = 0; k < TOBI_SCALAR_LIMIT; k++) {
        const tobi_scalar *c = &s->sim->scalar[k];
        lift.value[k] = c->value;
        lift.acts |= c->expansion != 0;
        lift.share[k] = (float)-c->expansion;
        for (int a = 0; a < s->box.dimension; a++)
            lift.per_unit[k][a] = (float)(-c->expansion*s->sim->def.gravity[a]);
    }
    return lift;
}

void sph_scalars_add_lift(const tobi_system *s, int64_t i, double g[3])
{
    const tobi_double2 *all = sph_fields_of(&s->particles)->scalars;
    if (!all) return;
    const tobi_scalar_lift lift = sph_scalars_lift(s);
    const tobi_double2 own = all[i];
    float more[3] = { 0, 0, 0 };
    double beside[3];
    tobi_scalar_add_lift(&lift, own, more);
    if (s->sim->acceleration.acts) {
        tobi_acceleration_at(&s->sim->acceleration, &s->particles.position[i].x, beside);
        tobi_scalar_add_share(&lift, own, beside, more);
    }
    for (int a = 0; a < 3; a++) g[a] += more[a];
}

/* 1 over 2 d sum sigma of the layers of a lattice beside a wall: the share of a flux that they would take. */
static double find_lattice(const tobi_smoothing_constants *c)
{
    double sum = 0;
    for (double s = 0.5*c->spacing; s < c->h; s += c->spacing) {
        const double at = s/c->h*TOBI_PLANE_SAMPLES, share = at - floor(at);
        const float *sigma = c->plane.sigma + (int)at;
        sum += 2*c->spacing*((1 - share)*(double)sigma[0] + share*(double)sigma[1]);
    }
    return 1/sum;
}

void sph_scalars_bind(const tobi_system *s, sph_view *v)
{
    const sph_fields *f = sph_fields_of(&s->particles);
    v->scalars = f->scalars; v->scalar_now = f->scalar_now; v->scalar_change = f->scalar_change;
    v->scalar.lift = sph_scalars_lift(s);
    v->scalar.thins = sph_scalars_thin(s);
    if (!v->scalars) return;
    v->scalar.lattice = (float)find_lattice(&s->smoothing);
    for (int k = 0; k < TOBI_SCALAR_LIMIT; k++) {
        const tobi_scalar *c = &s->sim->scalar[k];
        v->scalar.diffusivity[k] = (float)c->diffusivity;
        v->scalar.thinning[k] = (float)c->thinning;
        v->scalar.per_eddy[k] = c->given ? (float)(1/c->turbulent_number) : 0;
    }
}

/* m2/s: of a step of length 1. */
static double find_most(const tobi_system *s)
{
    return 0.8/(2*s->smoothing.rate + 2*s->smoothing.plane.sigma[0]/(0.25*s->smoothing.spacing));
}

double sph_scalars_dt(const tobi_system *s)
{
    double most = 0;
    for (int k = 0; k < TOBI_SCALAR_LIMIT; k++) most = fmax(most, s->sim->scalar[k].diffusivity);
    return most > 0 ? find_most(s)/most : INFINITY;
}

/* Eddies that mix neighbours within a step do so at the most that is stable. */
static float find_most_eddy(const tobi_system *s)
{
    double most = INFINITY;
    for (int k = 0; k < TOBI_SCALAR_LIMIT; k++) {
        const tobi_scalar *c = &s->sim->scalar[k];
        if (c->given)
            most = fmin(most, c->turbulent_number*fmax(find_most(s)/s->dt - c->diffusivity, 0));
    }
    return (float)most;
}

/* A side, `plane` of the view, or a body, and what of it counts. weighs: looks at what it would give. */
typedef struct giver {
    const tobi_system *s;
    const sph_view *v;
    const tobi_scalar_place *place;
    int plane, weighs;
} giver;

/* What particle i gets of a wall at the distance `at`, whose integral of the kernel is sigma. t: kg unit/s;
   or kg/s per unit that the wall is above the particle, and that times the value of the particle. */
static void give(const giver *g, int64_t i, float at, float sigma, double *t)
{
    const sph_view *v = g->v;
    const tobi_float4 now = v->scalar_now[i];
    const int k = g->place->field;
    const float diffusivity = v->scalar.diffusivity[k] + v->scalar.per_eddy[k]*now.z;
    const tobi_scalar_wall unit = { 1, 1, 0, g->place->wall.resistance };
    if (sph_driven(v, i)) return;
    const float rate = g->weighs ? sph_scalar_wall_rate(v, &unit, diffusivity, sigma, at, 0, now.w)
        : sph_scalar_wall_rate(v, &g->place->wall, diffusivity, sigma, at, (&now.x)[k], now.w);
    t[0] += g->s->smoothing.volume*now.w*rate;
    if (g->weighs) t[1] += g->s->smoothing.volume*now.w*rate*(double)(&now.x)[k];
    else (&v->scalar_change[i].x)[k] += v->scalar.dt*rate;
}

static float keep_off(const sph_view *v, float at) { return at > 0.25f*v->spacing ? at : 0.25f*v->spacing; }

static void give_from_plane(const void *view, int64_t begin, int64_t end, double *t)
{
    const giver *g = view;
    for (int64_t i = begin; i < end; i++) {
        const float at = sph_plane_distance(g->v, g->plane, i), s = keep_off(g->v, at);
        if (at < g->v->h) give(g, i, s, sph_plane_value(g->v, g->v->table->sigma, s), t);
    }
}

/* Over the entries of a body: each particle has one. */
static void give_from_body(const void *view, int64_t begin, int64_t end, double *t)
{
    const giver *g = view;
    for (int64_t k = begin; k < end; k++) {
        const tobi_boundary_link *l = &sph_of(g->s)->links.link[k];
        const double *n = l->gradient, sigma = sqrt(n[0]*n[0] + n[1]*n[1] + n[2]*n[2]);
        give(g, l->particle, keep_off(g->v, l->distance), (float)sigma, t);
    }
}

static void launch(const giver *g, tobi_exec *exec, double *t)
{
    const int64_t *first = sph_of(g->s)->links.first;
    const int body = g->place->number;
    if (g->place->kind == TOBI_SCALAR_AT_SIDE)
        tobi_launch(exec, TOBI_HOST(give_from_plane, 2, 0), g, 0, g->s->particles.count, t);
    else tobi_launch(exec, TOBI_HOST(give_from_body, 2, 0), g, first[body], first[body + 1], t);
}

/* Eq. (3b): a wall with a heat capacity gives by the value that it has at the end of the step. */
static void find_value(giver *g, tobi_scalar_place *p, tobi_exec *exec, double capacity)
{
    double t[TOBI_TOTALS] = { 0 };
    const double dt = g->s->dt;
    g->weighs = 1;
    launch(g, exec, t);
    g->weighs = 0;
    p->stored = (p->capacity*p->stored + dt*(p->power + capacity*t[1]))/(p->capacity + dt*capacity*t[0]);
    p->wall.value = (float)p->stored;
}

/* One wall after the other: a particle may see several. */
static void give_from_walls(tobi_system *s, const sph_view *v)
{
    for (int k = 0; k < s->sim->scalar_place_count; k++) {
        tobi_scalar_place *p = &s->sim->scalar_place[k];
        const double capacity = s->sim->scalar[p->field].capacity;
        giver g = { s, v, p, 0, 0 };
        if (p->kind < TOBI_SCALAR_AT_SIDE) continue;
        double t[TOBI_TOTALS] = { 0 };
        while (p->kind == TOBI_SCALAR_AT_SIDE && p->number != 2*v->plane[g.plane].axis +
                                                              (v->plane[g.plane].sign < 0)) g.plane++;
        if (p->capacity > 0) find_value(&g, p, &s->sim->exec, capacity);
        launch(&g, &s->sim->exec, t);
        p->flow = capacity*t[0];
    }
}

void sph_scalars_spread(tobi_system *s, sph_view *v, const sph_kernels *k)
{
    double t[TOBI_TOTALS];
    if (!v->scalars) return;
    v->scalar.dt = (float)s->dt;
    v->scalar.way = v->dt;
    v->scalar.most_eddy = find_most_eddy(s);
    tobi_launch(&s->sim->exec, k->sph_scalar_look, v, 0, s->particles.count, NULL);
    tobi_launch(&s->sim->exec, k->sph_scalar_spread, v, 0, s->particles.count, t);
    for (int c = 0; c < TOBI_SCALAR_LIMIT; c++) {
        const double added = t[c], taken = t[2 + c];
        v->scalar.gain[c] = added > taken ? (float)(taken/added) : 1;
        v->scalar.loss[c] = taken > added ? (float)(added/taken) : 1;
    }
    give_from_walls(s, v);
    tobi_launch(&s->sim->exec, k->sph_scalar_take, v, 0, s->particles.count, t);
    s->sim->scalar_power = t[0];
}
