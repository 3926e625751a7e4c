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
    const tobi_scalar_lift lift = sph_scalars_lift(s);
    float more[3] = { 0, 0, 0 };
    if (!lift.acts) return;
    const tobi_double2 own = sph_fields_of(&s->particles)->scalars[i];
    double beside[3];
    tobi_scalar_add_lift(&lift, own, more);
    if (s->sim->acceleration.acts) {
        tobi_acceleration_at(&s->sim->acceleration, &s->particles.position[i].x, beside);
        tobi_scalar_add_share(&lift, own, beside, more);
    }
    for (int a = 0; a < 3; a++) g[a] += more[a];
}

/* Of side or body `number`; the last that names it counts. Nothing passes where none does. */
static tobi_scalar_wall find_wall(const tobi_system *s, int field, int kind, int number)
{
    tobi_scalar_wall wall = { 0, 0, 0, 0 };
    for (int k = 0; k < s->sim->scalar_place_count; k++) {
        const tobi_scalar_place *p = &s->sim->scalar_place[k];
        if (p->field != field || p->kind != kind || p->number != number) continue;
        wall = p->wall;
        if (p->wall.fixed != 0) wall.value = (float)(p->value - s->sim->scalar[field].value);
    }
    return wall;
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
        for (int p = 0; p < v->plane_count; p++)
            v->scalar.plane[p][k] = find_wall(s, k, TOBI_SCALAR_AT_SIDE,
                                              2*v->plane[p].axis + (v->plane[p].sign < 0));
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

typedef struct walls {
    tobi_system *s;
    const sph_view *v;
    tobi_scalar_wall wall[TOBI_SCALAR_LIMIT];      /* of the plane `number`                     */
    int number;
} walls;

static float find_diffusivity(const sph_view *v, int k, int64_t i)
{
    return v->scalar.diffusivity[k] + v->scalar.per_eddy[k]*v->scalar_now[i].z;
}

/* What a body gives particle i, unit/s. */
static float find_body_rate(const sph_view *v, const tobi_scalar_wall *w, int k, const tobi_boundary_link *l)
{
    const double *g = l->gradient;
    const float sigma = (float)sqrt(g[0]*g[0] + g[1]*g[1] + g[2]*g[2]), least = 0.25f*v->spacing;
    return sph_scalar_wall_rate(v, w, find_diffusivity(v, k, l->particle), sigma,
                                l->distance > least ? l->distance : least, (&v->scalar_now[l->particle].x)[k],
                                v->scalar_now[l->particle].w);
}

static int has_wall(const tobi_scalar_wall wall[TOBI_SCALAR_LIMIT])
{
    int has = 0;
    for (int k = 0; k < TOBI_SCALAR_LIMIT; k++) has |= wall[k].fixed != 0 || wall[k].flux != 0;
    return has;
}

static void find_walls(const tobi_system *s, int kind, int number, tobi_scalar_wall wall[TOBI_SCALAR_LIMIT])
{
    for (int k = 0; k < TOBI_SCALAR_LIMIT; k++) wall[k] = find_wall(s, k, kind, number);
}

/* Adds what bodies give. */
static void add_bodies(const void *view, int64_t begin, int64_t end)
{
    const walls *w = view;
    const tobi_system *s = w->s;
    const tobi_boundary_links *n = &sph_of(s)->links;
    SPH_FOR_NEAR_PARTICLES(s, k, i, e) {
        const tobi_boundary_link *l = &n->link[e - n->entry];
        tobi_scalar_wall wall[TOBI_SCALAR_LIMIT];
        if (sph_driven(w->v, i)) continue;
        find_walls(s, TOBI_SCALAR_AT_BODY, l->body, wall);
        for (int c = 0; has_wall(wall) && c < TOBI_SCALAR_LIMIT; c++)
            (&w->v->scalar_change[i].x)[c] += w->v->scalar.dt*find_body_rate(w->v, &wall[c], c, l);
    }
}

static double find_mass(const tobi_system *s, int64_t i)
{
    return s->smoothing.volume*s->fluid[s->particles.fluid[i]].density;
}

/* Over the entries of a body: kg unit/s of each. */
static void sum_body(const void *view, int64_t begin, int64_t end, double *t)
{
    const walls *w = view;
    const tobi_boundary_links *n = &sph_of(w->s)->links;
    for (int64_t k = begin; k < end; k++) {
        const tobi_boundary_link *l = &n->link[k];
        tobi_scalar_wall wall[TOBI_SCALAR_LIMIT];
        if (sph_driven(w->v, l->particle)) continue;
        find_walls(w->s, TOBI_SCALAR_AT_BODY, l->body, wall);
        for (int c = 0; has_wall(wall) && c < TOBI_SCALAR_LIMIT; c++)
            t[c] += find_mass(w->s, l->particle)*find_body_rate(w->v, &wall[c], c, l);
    }
}

/* Over particles: the same of a plane. */
static void sum_plane(const void *view, int64_t begin, int64_t end, double *t)
{
    const walls *w = view;
    const sph_view *v = w->v;
    for (int64_t i = begin; i < end; i++) {
        const float at = sph_plane_distance(v, w->number, i), least = 0.25f*v->spacing,
                    s = at > least ? at : least;
        if (at >= v->h || sph_driven(v, i)) continue;
        for (int k = 0; k < TOBI_SCALAR_LIMIT; k++)
            t[k] += find_mass(w->s, i)*
                    sph_scalar_wall_rate(v, &w->wall[k], find_diffusivity(v, k, i),
                                         sph_plane_value(v, v->table->sigma, s), s, (&v->scalar_now[i].x)[k],
                                         v->scalar_now[i].w);
    }
}

static void keep_flow(tobi_system *s, int kind, int number, const double *t)
{
    for (int k = 0; k < s->sim->scalar_place_count; k++) {
        tobi_scalar_place *p = &s->sim->scalar_place[k];
        if (p->kind == kind && p->number == number) p->flow = s->sim->scalar[p->field].capacity*t[p->field];
    }
}

static void measure_flows(tobi_system *s, const sph_view *v)
{
    walls w = { s, v, { { 0, 0, 0, 0 } }, 0 };
    double t[TOBI_TOTALS];
    for (int p = 0; p < v->plane_count; p++) {
        for (int k = 0; k < TOBI_SCALAR_LIMIT; k++) w.wall[k] = v->scalar.plane[p][k];
        w.number = p;
        if (!has_wall(w.wall)) continue;
        tobi_launch(&s->sim->exec, TOBI_HOST(sum_plane, 2, 0), &w, 0, s->particles.count, t);
        keep_flow(s, TOBI_SCALAR_AT_SIDE, 2*v->plane[p].axis + (v->plane[p].sign < 0), t);
    }
    if (s->sim->body_count == 0) return;
    tobi_boundary_sum(s, TOBI_HOST(sum_body, 2, 0), &w, 0);
    for (int k = 0; k < s->sim->body_count; k++)
        keep_flow(s, TOBI_SCALAR_AT_BODY, k, sph_of(s)->links.total[k]);
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
    const walls w = { s, v, { { 0, 0, 0, 0 } }, 0 };
    if (s->sim->body_count > 0) tobi_loop(s->sim->exec.threads, sph_of(s)->links.count, 0, add_bodies, &w);
    measure_flows(s, v);
    tobi_launch(&s->sim->exec, k->sph_scalar_take, v, 0, s->particles.count, t);
    s->sim->scalar_power = t[0];
}
