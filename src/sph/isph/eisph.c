/* Explicit incompressible SPH: the step of isph with a few sweeps of the pressure equation, from the pressure
   of the last step, in place of a solve. What they leave is sound, so the step is bounded by its speed, or
   the sweeps are as many as the step needs (decision 51). The first step is solved. Drawback: liquid at rest
   in deep tanks costs more than by isph, and pressure arrives with sound. */
#include "sph/isph/isph.h"
#include "sph/isph/sweeps.h"
#include "sph/isph/verbs.h"
#include "sph/openings.h"
#include "sph/porous_carry.h"
#include <math.h>

/* Most sweeps that the method chooses itself. */
enum { SWEEPS_MAX = 200 };
/* Speed of sound over that of the flow; and what the pressure forgets over what it takes in of the error of
   volume: below 1 sound gains energy (eq. E.8). */
static const double SOUND = 10, FORGET = 2;
/* Times of sound over the depth in which both shares rise from 0: at once, the compression that goes with
   them would come as a blow, 13 % of the pressure at a floor. */
static const double RISE = 30;

static void choose_smoothing(const void *def, int stirred, int *shape, double *support)
{
    const tobi_eisph_def *d = def;
    (void)stirred;
    *shape = d->kernel;
    *support = d->support > 0 ? d->support : tobi_smoothing_support(d->kernel, 2.5);
}

static tobi_status create(tobi_system *s, tobi_error *err)
{
    const tobi_eisph_def *d = s->def;
    tobi_isph_def def;
    tobi_param_defaults(&tobi_isph_table, &def);
    def.kernel = d->kernel;
    def.support = d->support;
    def.volume_gain = d->volume_gain;
    def.shifting = d->shifting;
    def.time_order = 1;
    def.filter = 0;
    return isph_create_state(s, &def, err);
}

/* m/s */
static double sound(const tobi_system *s, const isph *m)
{
    const tobi_eisph_def *d = s->def;
    const double *g = s->gravity, fall = 2*sqrt(g[0]*g[0] + g[1]*g[1] + g[2]*g[2])*m->memory.depth,
                 speed = fmax(fmax(m->memory.speed, s->sim->body_speed), sqrt(fall));
    return d->sound_speed > 0 ? d->sound_speed : SOUND*speed;
}

/* Of isph, and eq. (E.6) for the sweeps asked for, or the most. */
static double choose_dt(tobi_system *s)
{
    const isph *m = s->state;
    const tobi_eisph_def *d = s->def;
    const double dt = isph_choose_dt(s), c = sound(s, m);
    if (s->sim->def.time_step > 0 || !(c > 0) || m->memory.started == 0) return dt;
    const double reach = isph_sweeps_reach(d->sweeps > 0 ? d->sweeps : SWEEPS_MAX, d->iteration);
    return fmin(dt, sqrt(reach/m->solver.view.full)/c);
}

static int count_sweeps(const tobi_system *s, const isph *m)
{
    const tobi_eisph_def *d = s->def;
    const double way = sound(s, m)*s->dt;
    int n = 1;
    if (d->sweeps > 0) return d->sweeps;
    while (n < SWEEPS_MAX && isph_sweeps_reach(n, d->iteration) < way*way*m->solver.view.full) n++;
    return n;
}

static void measure_depth(tobi_system *s, isph *m)
{
    double t[TOBI_TOTALS] = { 0 }, size = 0;
    const isph_view *v = &m->solver.view;
    for (int a = 0; a < v->dimension; a++) size += v->size[a]*v->size[a];
    tobi_launch(&s->sim->exec, m->kernel->eisph_extent, v, 0, v->count, t);
    m->memory.depth = fmax(0, t[6] + t[7] - 2*sqrt(size)) + v->spacing;
}

static tobi_status begin(tobi_system *s, tobi_error *err)
{
    isph *m = s->state;
    const tobi_eisph_def *d = s->def;
    isph_view *v = &m->solver.view;
    TOBI_TRY(isph_begin(s, err));
    measure_depth(s, m);
    m->solver.sweeps = (isph_sweeps){ 0, d->iteration };
    v->keep = 1;
    v->fades = 0;                        /* its late pressure lets the surface settle instead */
    if (m->memory.started == 0) return TOBI_OK;
    m->solver.sweeps.count = count_sweeps(s, m);
    v->volume_gain = d->volume_gain*fmin(s->sim->time*sound(s, m)/(RISE*m->memory.depth), 1);
    /* what the pressure forgets comes back as compression: of a pipe under pressure only the losses may */
    v->base = sph_openings_mean_pressure(s);
    v->keep = 1 - FORGET*v->volume_gain*v->dt/v->volume_dt;
    return TOBI_OK;
}

static unsigned list_needs(const tobi_system *s, int full)
{
    return sph_needs(s, full) | (sph_porous_carried(s) ? SPH_NEED_CARRIED : 0);
}

const tobi_method tobi_eisph = {
    .name = "eisph",
    .doc = "Incompressible SPH with an explicit update of the pressure: a few sweeps in place of a solve.",
    .density_ratio = 10,
    .params = &tobi_eisph_table,
    .smoothing = choose_smoothing,
    .create = create,
    .needs = list_needs,
    .max_dt = choose_dt,
    .begin = begin,
    .rough_forces = 1,
    ISPH_VERBS
};
