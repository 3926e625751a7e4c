/* Weakly compressible SPH (Monaghan 1994): pressure by the Tait equation, steps short enough for sound.
   The density of that equation is carried along by the continuity equation, so that the fewer neighbours
   at a surface and the kernel's share of walls are no compression; a position shift keeps the particles'
   own density from drifting away from it (docs/theory/wcsph.md). Operators, walls and bodies are those
   of DFSPH. Drawback: the step is that of sound, and pressure waves of the start ring on for a while. */
#include "sph/state.h"
#include "sph/hydrostatic.h"
#include "sph/wcsph.h"
#include "sph/boundary/boundary.h"
#include "sph/kernels.h"
#include "sph/openings.h"
#include "sph/porous.h"
#include "sph/stages.h"
#include "sph/reference.h"
#include "sph/viscosity.h"
#include <math.h>
#include <stdlib.h>

/* Share of the kernel average in the pressure, per time that sound takes over a spacing. */
static const double PRESSURE_SMOOTHING = 0.25;
/* Share of the density error that positions give way to, in the same time. */
static const double RELAXATION = 0.05;
/* With inlets or outlets, share of the density error that the pressure answers, in the same time. */
static const double RECOVERY = 0.01;

typedef struct wcsph {
    sph_state common;                            /* comes first */
    tobi_wcsph_def def;
    sph_view view;
    const sph_kernels *kernel;
    /* survives a restart; vessel: SPH_VESSEL_*; low, level: depths of the surface and of still water, m */
    struct { double speed, vessel, low, level, open; } memory;
    double sound;                                 /* m/s                                              */
    double compliance;                            /* m2/kg, of the bodies: tobi_couple_compliance     */
} wcsph;

static void launch(tobi_system *s, wcsph *m, tobi_kernel k, double *totals)
{
    tobi_launch(&s->sim->exec, k, &m->view, 0, s->particles.count, totals);
}

static void choose_smoothing(const void *def, int driven, int *shape, double *support)
{
    const tobi_wcsph_def *d = def;
    (void)driven;
    *shape = d->kernel;
    *support = d->support > 0 ? d->support : tobi_smoothing_support(d->kernel, 2);
}

static double find_sound(const tobi_system *s)
{
    const tobi_wcsph_def *d = s->def;
    double least, most;
    tobi_system_densities(s, &least, &most);
    return sqrt(d->exponent*d->stiffness/least);
}

static double limit_dt(const tobi_system *s, int solid, double speed)
{
    (void)solid;
    return fmin(s->sim->def.cfl*s->smoothing.spacing/(find_sound(s) + speed), sph_gravity_dt(s));
}

static tobi_status create(tobi_system *s, tobi_error *err)
{
    wcsph *m = s->state = calloc(1, sizeof *m);
    if (!m) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the wcsph state");
    m->def = *(const tobi_wcsph_def *)s->def;
    m->kernel = sph_kernels_for(s->sim->exec.isa, m->def.kernel);
    m->sound = find_sound(s);
    m->compliance = fmax(tobi_couple_compliance(s), sph_soft_compliance(s));
    return TOBI_OK;
}

static int list_memory(tobi_system *s, double **values)
{
    wcsph *m = s->state;
    *values = &m->memory.speed;
    return 5;
}

static void bind_view(tobi_system *s, wcsph *m)
{
    sph_view *v = &m->view;
    double d = s->smoothing.spacing;
    sph_bind_view(s, v, m->memory.vessel);
    sph_reference_set(s, m->memory.level);
    v->reference = sph_of(s)->reference;
    v->stiffness = (float)m->def.stiffness;
    v->exponent = (float)m->def.exponent;
    v->recovery = sph_has_openings(s) ? (float)(RECOVERY*m->sound/d) : 0;
    v->recovery_pressure = (float)sph_openings_mean_pressure(s);
    v->damping = (float)(m->def.damping*s->fluid[0].density*m->sound*d);
}

/* The layer of water at a body is a spring between the two, explicit in time, eq. (25). INFINITY without. */
static double body_dt(const tobi_system *s, const wcsph *m)
{
    double d = s->smoothing.spacing, limit = 2/(1 + s->fluid[0].density*d*m->compliance);
    if (!(m->compliance > 0)) return INFINITY;
    return limit/(sqrt(m->def.damping*m->def.damping + limit) + m->def.damping)*d/m->sound;
}

/* dt <= min(cfl d/(c + |v|), 0.25 sqrt(d/g), viscous limit, bodies' limit), eq. (24). */
static double choose_dt(tobi_system *s)
{
    const wcsph *m = s->state;
    double speed = fmax(m->memory.speed, s->sim->body_speed);
    if (s->sim->def.time_step > 0) return s->sim->def.time_step;
    double dt = fmin(limit_dt(s, TOBI_LIQUIDS, speed), sph_force_dt(s));
    dt = fmin(dt, fmin(body_dt(s, m), tobi_couple_dt(s)));
    return s->sim->def.time_step_max > 0 ? fmin(dt, s->sim->def.time_step_max) : dt;
}

/* Drop of the free surface. Gaps between a lattice and a body in it look like one: what sees a body does not
   count. */
static double find_surface(tobi_system *s)
{
    sph_state *state = sph_of(s);
    const sph_fields *f = sph_fields_of(&s->particles);
    for (int64_t k = 0; k < state->links.count; k++) f->surface_depth[state->links.link[k].particle] = 0;
    sph_openings_hide_surface(s);
    return sph_reference_low(s);
}

/* Once, in a vessel just looked into. Above air beside a soft solid rest is all in the particles. */
static void start_at_rest(tobi_system *s, wcsph *m)
{
    int dry = 0;
    if (m->def.still_water && sph_reference_begins(s)) {
        m->memory.low = find_surface(s);
        m->memory.level = sph_reference_surface(s);
        dry = m->memory.low > m->memory.level;
    }
    bind_view(s, m);
    m->view.reference_before = sph_of(s)->reference;
    if (dry) m->view.reference.cover = INFINITY;
    launch(s, m, m->kernel->sph_rest, NULL);
    if (m->def.still_water && !(m->view.reference.push > 0)) sph_openings_start(s);
    if (dry) m->memory.level = 0;
}

static tobi_status find_neighbors(tobi_system *s, wcsph *m, double *clock, tobi_error *err)
{
    TOBI_TRY(sph_find_neighbors(s, clock, err));
    bind_view(s, m);
    int new = m->memory.vessel == SPH_VESSEL_UNKNOWN;
    TOBI_TRY(sph_classify_vessel(s, &m->view, m->kernel, &m->memory.vessel, clock, err));
    if (m->memory.vessel == SPH_VESSEL_FULL) sph_remove_gravity(s);
    if (new) start_at_rest(s, m);
    bind_view(s, m);
    return TOBI_OK;
}

/* A share of a time step: `share` of each spacing that sound travels in it. */
static double share_of_step(const tobi_system *s, const wcsph *m, double share)
{
    return fmin(share*m->sound*s->dt/s->smoothing.spacing, 0.5);
}

static void apply_forces(tobi_system *s, wcsph *m, double *clock)
{
    double scale = 2*s->smoothing.rate, motion = 10*s->sim->def.cfl*s->smoothing.spacing/m->sound;
    m->view.filter = (float)(m->def.filter/(fmax(s->dt, motion)*scale*scale));
    sph_apply_forces(s, &m->view, m->kernel, clock);
    sph_viscosity_solve(s, &m->view, m->kernel, NULL, clock);
}

/* The equation of state, and its force. */
static void apply_pressure(tobi_system *s, wcsph *m, double *clock)
{
    double t[TOBI_TOTALS];
    sph_stage(s, &m->view, SPH_TAIT);
    sph_viscosity_expect(s, 1);       /* the pressure that viscosity has seen: what it did stays with it */
    launch(s, m, m->kernel->sph_carry, NULL);
    launch(s, m, m->kernel->sph_tait, t);
    sph_viscosity_expect(s, -1);
    s->info.divergence_mean = t[0]/sph_rows(s);
    s->info.divergence_max = t[6];
    s->info.density_converged = s->info.divergence_converged = 1;      /* there is no solver */
    launch(s, m, m->kernel->sph_pressure_kick, t);
    s->info.force_sum = t[0]*s->smoothing.volume;
    tobi_stage_end(&s->sim->stages, "pressure", clock);
}

/* Walls feel the pressure with its damping. */
static void measure_forces(tobi_system *s, wcsph *m, double *clock)
{
    sph_fields *f = sph_fields_of(&s->particles);
    float *state = f->pressure;
    sph_stage(s, &m->view, SPH_MOVE);
    m->view.pressure = f->pressure = f->damped;
    sph_measure_forces(s, &m->view, m->kernel, clock);
    m->view.pressure = f->pressure = state;
}

/* The bodies' velocities with the forces of this step, where zones that they carry answer. */
static void expect_bodies(tobi_system *s)
{
    sph_fields *f = sph_fields_of(&s->particles);
    float *state = f->pressure;
    f->pressure = f->damped;
    tobi_couple_expect(s);
    f->pressure = state;
}

static void shift_positions(tobi_system *s, wcsph *m, double *clock)
{
    m->view.background = 0;
    m->view.relaxation = (float)share_of_step(s, m, RELAXATION);
    launch(s, m, m->kernel->sph_relax, NULL);
    launch(s, m, m->kernel->sph_shift, NULL);
    tobi_stage_end(&s->sim->stages, "position shift", clock);
}

static tobi_status begin(tobi_system *s, tobi_error *err)
{
    wcsph *m = s->state;
    double clock = tobi_clock();
    sph_use_dt(s, &m->view);
    sph_set_body_velocities(s, &clock);
    sph_reference_move(s, &m->view.reference_before, m->def.still_water ? m->memory.low : 0, m->memory.open,
                       fmax(m->memory.speed, s->sim->body_speed), &m->memory.level);
    TOBI_TRY(find_neighbors(s, m, &clock, err));
    sph_openings_mark(s, &m->view);
    TOBI_TRY(sph_find_boundaries(s, &m->view, m->kernel, &clock, err));
    sph_measure_density(s, &m->view, m->kernel, share_of_step(s, m, PRESSURE_SMOOTHING), &clock);
    m->memory.low = find_surface(s);
    m->memory.open = sph_reference_open(s);
    sph_porous_begin(s);
    return TOBI_OK;
}

static void forces(tobi_system *s)
{
    double clock = tobi_clock();
    apply_forces(s, s->state, &clock);
}

static tobi_status solve(tobi_system *s, tobi_error *err)
{
    double clock = tobi_clock();
    (void)err;
    tobi_couple_begin(s);
    sph_soft_begin(s, 0);
    apply_pressure(s, s->state, &clock);
    sph_porous_brake(s);
    expect_bodies(s);
    sph_porous_measure(s);
    return TOBI_OK;
}

static void move(tobi_system *s)
{
    wcsph *m = s->state;
    double clock = tobi_clock();
    measure_forces(s, m, &clock);
    sph_add_hydrostatic(s);
    tobi_couple_correct(s);
    shift_positions(s, m, &clock);
    m->memory.speed = sph_move_particles(s, &m->view, m->kernel, &clock);
}

static tobi_status refresh(tobi_system *s, tobi_error *err)
{
    wcsph *m = s->state;
    double clock = tobi_clock();
    TOBI_TRY(find_neighbors(s, m, &clock, err));
    TOBI_TRY(sph_find_boundaries(s, &m->view, m->kernel, &clock, err));
    sph_measure_density(s, &m->view, m->kernel, 0, &clock);
    (void)find_surface(s);
    return TOBI_OK;
}

static void derive(tobi_system *s, const char *field)
{
    wcsph *m = s->state;
    sph_derive(s, &m->view, m->kernel, field);
}

static void follow_gravity(tobi_system *s, int loaded)
{
    wcsph *m = s->state;
    const sph_surface surface = { &m->memory.vessel, &m->memory.low, &m->memory.level, find_surface,
                                  m->def.still_water };
    if (!loaded) sph_reference_follow(s, &m->view, m->kernel, &surface);
}

static void free_state(void *state)
{
    if (state) tobi_boundary_links_free(&((wcsph *)state)->common.links);
    if (state) sph_soft_free(&((wcsph *)state)->common.soft);
    free(state);
}

const tobi_method tobi_wcsph = {
    .name = "wcsph",
    .doc = "Weakly compressible SPH: pressure by the Tait equation, short steps, no solver.",
    .density_ratio = 2,
    .damps_waves = 1,
    .fills_pipes = 1,
    .params = &tobi_wcsph_table,
    .fields = &sph_field_list,
    .outputs = sph_outputs,
    .needs = sph_needs,
    .smoothing = choose_smoothing,
    .create = create,
    .max_dt = choose_dt,
    .begin = begin,
    .forces = forces,
    .solve = solve,
    .move = move,
    .finish = sph_finish,
    .stable_dt = limit_dt,
    .sound = find_sound,
    .refresh = refresh,
    .read = sph_read,
    .derive = derive,
    .memory = list_memory,
    .follow_gravity = follow_gravity,
    .account = sph_account,
    .free = free_state,
};
