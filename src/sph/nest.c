/* The rim of a nest is no unknown: velocities and pressures are fits through the outer liquid, as of a sensor
   (docs/decisions/0157-nests.md). Drawback: the outer liquid is that of the end of its step. */
#include "sph/nest.h"
#include "sph/hydrostatic.h"
#include "sph/openings.h"
#include "sph/sensor/probe.h"
#include "sph/state.h"
#include <math.h>

/* s: from the end of the step at hand to the time of the outer liquid. */
static double find_lead(const tobi_system *s)
{
    const tobi_simulation *w = s->sim;
    return w->nest.outer->sim->time - (w->time + s->dt);
}

/* By isph forces are added to the velocity that a row has at the begin of the step, as to those of free rows;
   by dfsph it has that of the end from the begin on. */
static void mark_row(const tobi_system *s, int64_t i, const double x[3])
{
    const sph_fields *f = sph_fields_of(&s->particles);
    tobi_float4 *v = &s->particles.velocity[i], *held = &f->held[i];
    const double lead = find_lead(s), first = lead + (sph_of(s)->mirrors ? s->dt : 0);
    double pressure, u[3], a[3], scalar[TOBI_SCALAR_LIMIT];
    *held = (tobi_float4){ v->x, v->y, v->z, SPH_NEST_MARK };
    f->pressure[i] = s->cells.record[i].w = 0;
    if (!tobi_probe_liquid(s->sim->nest.outer, x, &pressure, u, a, scalar)) return;
    for (int c = 0; c < s->box.dimension; c++) {
        (&held->x)[c] = (float)(u[c] - lead*a[c]);
        (&v->x)[c] = (float)(u[c] - first*a[c]);
    }
    f->pressure[i] = s->cells.record[i].w = (float)(pressure - sph_hydrostatic(s, x));
    if (f->scalars) f->scalars[i] = (tobi_double2){ scalar[0], scalar[1] };
}

/* Of the outer liquid's suction and twice its dynamic pressure. */
static const double LIFT = 2;
/* Outer spacings: nearer to the sides of the box the outer liquid keeps its velocity. */
static const double MARGIN = 2;

static void mark_range(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    for (int64_t i = begin; i < end; i++) {
        const tobi_double3 *p = &s->particles.position[i];
        const double x[3] = { p->x, p->y, p->z };
        if (tobi_nest_outside(&s->sim->nest, s->box.dimension, x) > 0) mark_row(s, i, x);
    }
}

/* totals: [6] the most, over the rows, of what the pressure is below 0, Pa. */
static void find_suction(const void *view, int64_t begin, int64_t end, double *totals)
{
    const tobi_system *s = view;
    const float *pressure = sph_fields_of(&s->particles)->pressure;
    for (int64_t i = begin; i < end; i++) {
        const tobi_double3 *p = &s->particles.position[i];
        const double x[3] = { p->x, p->y, p->z };
        totals[6] = fmax(totals[6], -pressure[i] - sph_hydrostatic(s, x));
    }
}

/* Without a free surface outside, pressure is known but for a constant, and may be below 0; in the nest a
   void would grow there. So all pressures of the nest are lifted above 0, and read without the lift. */
static void lift(tobi_system *s)
{
    const tobi_system *outer = s->sim->nest.outer;
    double t[TOBI_TOTALS];
    s->sim->nest.lift = 0;
    if (!sph_of(outer)->full) return;
    tobi_launch(&outer->sim->exec, TOBI_HOST(find_suction, 0, 1), outer, 0, outer->particles.count, t);
    s->sim->nest.lift = LIFT*(t[6] + s->fluid[0].density*outer->info.speed_max*outer->info.speed_max);
}

void sph_nest_mark(tobi_system *s)
{
    if (!s->sim->nest.outer) return;
    lift(s);
    tobi_loop(s->sim->exec.threads, s->particles.count, 512, mark_range, s);
}

static void hold_range(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const tobi_float4 *held = sph_fields_of(&s->particles)->held;
    for (int64_t i = begin; i < end; i++)
        if (held[i].w == SPH_NEST_MARK)
            s->particles.velocity[i] = (tobi_float4){ held[i].x, held[i].y, held[i].z, 0 };
}

void sph_nest_hold(tobi_system *s)
{
    if (s->sim->nest.outer) tobi_loop(s->sim->exec.threads, s->particles.count, 0, hold_range, s);
}

typedef struct feeding { const tobi_system *s; tobi_system *outer; } feeding;

static void feed_range(const void *view, int64_t begin, int64_t end)
{
    const feeding *g = view;
    const tobi_system *s = g->s;
    const double margin = MARGIN*g->outer->smoothing.spacing;
    for (int64_t i = begin; i < end; i++) {
        const tobi_particles *p = &g->outer->particles;
        const double x[3] = { p->position[i].x, p->position[i].y, p->position[i].z };
        double pressure, u[3], a[3], scalar[TOBI_SCALAR_LIMIT];
        if (tobi_nest_outside(&s->sim->nest, s->box.dimension, x) > -margin) continue;
        if (tobi_probe_liquid(s, x, &pressure, u, a, scalar) <= 2*s->box.dimension) continue;
        for (int c = 0; c < s->box.dimension; c++) (&p->velocity[i].x)[c] = (float)u[c];
    }
}

void sph_nest_feed(const tobi_system *s, tobi_system *outer)
{
    const feeding g = { s, outer };
    tobi_loop(s->sim->exec.threads, outer->particles.count, 512, feed_range, &g);
}
