/* Incompressible SPH: one Poisson equation per step, with a compact Laplacian, for the pressure that makes
   the velocity free of divergence (Cummins & Rudman 1999). Walls are mirrors, made pair by pair. Volume is
   held by a small source of pressure, evenness by a shift of positions; neither gives speed to particles.
   One list serves a step: that of the middle of the way, or of its begin (decisions 46, 66). Drawback: what
   divergence and Laplacian do not share stays in the velocity, some 5e-4 of a volume per step. */
#include "sph/boundary/boundary.h"
#include "sph/isph/isph.h"
#include "sph/isph/fields.h"
#include "sph/isph/forces.h"
#include "sph/isph/gaps.h"
#include "sph/isph/carry.h"
#include "sph/isph/porous.h"
#include "sph/porous_carry.h"
#include "sph/isph/verbs.h"
#include "sph/kernels.h"
#include "sph/openings.h"
#include "sph/phases.h"
#include "sph/reference.h"
#include "sph/sensor/probe.h"
#include "sph/viscosity.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Steps in a row that may fail to converge. */
enum { FAILURES = 50 };
/* Solves of a step again, as motors meet their bounds. */
enum { MOST_AGAIN = 3 };

/* Spacings that a wave of the depth at the start may go in a step beside soft solids. */
static const double SOFT_COURANT = 0.08;
/* The same of a wave along a thin solid. */
static const double STIFF_COURANT = 2;

/* Spacings in the step that errors of volume are corrected by: the default of cfl. */
static const double VOLUME_COURANT = 0.4;
static const double FULL_SHIFT_STEP = 0.2, SHIFT_AT_REST = 0.1;
/* Over what a gradient taken at the begin of the shift amplifies, by Lax and Wendroff: more than 1, as
   particles are disordered, and the more the farther they go in a step: at least, and per spacing. */
static const double SHIFT_DAMPING = 2, SHIFT_DAMPING_OF_WAY = 15;

/* Spacings in the step that gravity allows, which is 0.1 sqrt(g d): a gap that closes more slowly may as well
   be at rest. */
static const double GAP_AT_REST = 0.025;

static void launch(tobi_system *s, isph *m, tobi_kernel k, double *totals)
{
    tobi_launch(&s->sim->exec, k, &m->solver.view, 0, s->particles.count, totals);
}

static void choose_smoothing(const void *def, int driven, int *shape, double *support)
{
    const tobi_isph_def *d = def;
    (void)driven;
    *shape = d->kernel;
    *support = d->support > 0 ? d->support : tobi_smoothing_support(d->kernel, 2.5);
}

tobi_status isph_create_state(tobi_system *s, const tobi_isph_def *def, tobi_error *err)
{
    isph *m = s->state = calloc(1, sizeof *m);
    if (!m) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the isph state");
    m->def = *def;
    m->common.mirrors = 1;
    m->kernel = sph_kernels_for(s->sim->exec.isa, m->def.kernel);
    isph_solver_begin(&m->solver, s, &m->def);
    m->solver.coupled = tobi_couple_any(s);
    m->solver.view.kinematic = m->view.kinematic;
    if (sph_phases_have_tension(s)) m->solver.view.interface_tension = m->view.interface_tension;
    return tobi_exec_reserve(&s->sim->exec, (int64_t)TOBI_PROBE_PIECES*TOBI_BLOCK, err);
}

static tobi_status create(tobi_system *s, tobi_error *err) { return isph_create_state(s, s->def, err); }

static unsigned list_needs(const tobi_system *s, int full)
{
    const tobi_isph_def *d = s->def;
    return sph_needs(s, full) | (d->filter > 0 ? SPH_NEED_FILTER : 0) |
           (sph_porous_carried(s) ? SPH_NEED_CARRIED : 0);
}

int isph_list_memory(tobi_system *s, double **values)
{
    isph *m = s->state;
    *values = &m->memory.speed;
    return ISPH_MEMORY;
}

/* Solids answer a step late: they swing where long waves pass more of a spacing in a step and, without
   gravity, where they themselves swing too much in one (decision 84). */
static double choose_soft_dt(const tobi_system *s)
{
    if (!s->sim->soft.solids) return INFINITY;
    const double *g = s->sim->def.gravity, d = s->smoothing.spacing;
    if (g[0] != 0 || g[1] != 0 || g[2] != 0) return SOFT_COURANT*d/sqrt(fmax(s->start_head, 1e-24));
    return STIFF_COURANT*d/fmax(sph_soft_wave_speed(s), 1e-12);
}

/* Particles and a body may go against each other: cfl bounds what both go. A thin tail drew a cavity into the
   water when each went 0.4 of a spacing. Sides of the domain only slide. */
double isph_choose_dt(tobi_system *s)
{
    isph *m = s->state;
    const double fixed = s->sim->def.time_step, most = s->sim->def.time_step_max;
    const double body = s->sim->body_speed > s->sim->wall_speed ? s->sim->body_speed : 0;
    const double speed = fmax(m->memory.speed + body, s->sim->body_speed);
    m->motion_dt = fmin(s->sim->def.cfl*s->smoothing.spacing/fmax(speed, 1e-12), sph_gravity_dt(s));
    m->volume_dt = fmin(VOLUME_COURANT*s->smoothing.spacing/fmax(speed, 1e-12), sph_gravity_dt(s));
    const double dt = fmin(fmin(m->motion_dt, choose_soft_dt(s)),
                           fmin(sph_force_dt(s), tobi_couple_dt(s)));
    return fixed > 0 ? fixed : most > 0 ? fmin(dt, most) : dt;
}

/* m/s: of the fastest particle or body. */
static double find_speed(const tobi_system *s, const isph *m)
{
    return fmax(m->memory.speed, s->sim->body_speed);
}

/* Still liquid needs less of the shift, which would stir it: all of it where the fastest particle or body
   goes FULL_SHIFT_STEP spacings in a step. */
static void choose_shift(const tobi_system *s, isph *m)
{
    const double way = find_speed(s, m)*s->dt/s->smoothing.spacing;
    m->solver.view.shifting = m->def.shifting*fmax(SHIFT_AT_REST, fmin(way/FULL_SHIFT_STEP, 1));
    m->solver.view.shift_damping = fmax(SHIFT_DAMPING, SHIFT_DAMPING_OF_WAY*way);
}

/* What the closing of a gap is measured by: liquid at rest stirs, which is no closing. */
static double choose_gap_speed(const tobi_system *s, const isph *m)
{
    return fmax(find_speed(s, m), GAP_AT_REST*s->smoothing.spacing/sph_gravity_dt(s));
}

static void bind_soft(const tobi_system *s, isph_view *v)
{
    const sph_soft *q = &sph_of(s)->soft;
    v->soft_last = s->sim->soft.solids ? q->last : NULL;
    v->soft = q->link;
    v->soft_velocity = q->velocity;
    v->soft_change = (const double (*)[3])q->change;
}

/* Particle-scale motion makes disorder, and disorder lifts the liquid: decision 117. The filter takes all
   particles for equally heavy. */
static void bind(tobi_system *s, isph *m)
{
    sph_bind_view(s, &m->view, m->memory.vessel);
    m->view.blind = m->def.filter > 0 && tobi_system_density_ratio(s) == 1;
}

static tobi_status find_neighbors(tobi_system *s, isph *m, double *clock, tobi_error *err)
{
    const int classified = m->memory.vessel != SPH_VESSEL_UNKNOWN;
    TOBI_TRY(sph_find_neighbors(s, clock, err));
    bind(s, m);
    TOBI_TRY(sph_classify_vessel(s, &m->view, m->kernel, &m->memory.vessel, clock, err));
    if (!classified && s->sim->body_count > 0)       /* all pairs, to be cut again */
        TOBI_TRY(sph_find_neighbors(s, clock, err));
    bind(s, m);
    m->solver.view.held = NULL;
    m->solver.view.capillary = sph_fields_of(&s->particles)->capillary;
    m->solver.view.open = m->solver.view.fades = m->memory.vessel != SPH_VESSEL_FULL;
    m->solver.view.volume_dt = fmax(m->volume_dt, s->dt);
    m->solver.view.gap_speed = choose_gap_speed(s, m);
    choose_shift(s, m);
    TOBI_TRY(sph_find_boundaries(s, &m->view, m->kernel, clock, err));
    TOBI_TRY(isph_solver_bind(&m->solver, s, err));
    TOBI_TRY(isph_bodies_find_mirrors(&m->solver, s, err));
    TOBI_TRY(isph_forces_find_coupling(&m->solver, s, err));
    tobi_stage_end(&s->sim->stages, "walls and bodies", clock);
    bind_soft(s, &m->solver.view);
    sph_measure_density(s, &m->view, m->kernel, 0, clock);
    return TOBI_OK;
}

tobi_status isph_remember(tobi_system *s, tobi_error *err)
{
    isph *m = s->state;
    return sph_undo_begin(&m->undo, s, &m->memory.speed, ISPH_MEMORY, err);
}

void isph_take_back(tobi_system *s)
{
    isph *m = s->state;
    sph_undo_restore(&m->undo, s, &m->memory.speed, ISPH_MEMORY);
}

/* Bodies and solids have one pose in a step, and liquid comes and goes once, at its end. */
static int is_second_order(const tobi_system *s, const isph *m)
{
    if (m->def.time_order < 2 || tobi_couple_any(s) || sph_has_openings(s)) return 0;
    if (s->sim->soft.solids) return 0;
    for (int k = 0; k < s->sim->body_count; k++)
        if (s->sim->bodies[k].motion) return 0;
    return 1;
}

/* To the middle of the step, by the velocities before it. The sort at the begin keeps rows in the order that
   they have when results are read between two steps. */
static tobi_status drift(tobi_system *s, isph *m, double *clock, tobi_error *err)
{
    tobi_cells_sort(&s->cells, &s->box, &s->particles, sph_fields_of(&s->particles)->pressure, &s->sim->exec);
    TOBI_TRY(sph_undo_keep(&m->undo, s, 1, err));
    TOBI_TRY(isph_solver_bind(&m->solver, s, err));
    launch(s, m, m->kernel->isph_drift, NULL);
    tobi_stage_end(&s->sim->stages, "advance", clock);
    return TOBI_OK;
}

/* Cones need the normal first. */
static void find_geometry(tobi_system *s, isph *m, double *totals)
{
    if (m->def.surface_rule == TOBI_SURFACE_CONE) launch(s, m, m->kernel->isph_geometry, NULL);
    if (m->solver.view.by_mark) launch(s, m, m->kernel->isph_mark, NULL);
    launch(s, m, m->kernel->isph_geometry, totals);
}

/* Depths of what is at a free surface. totals: the largest. */
static void find_depths(const void *view, int64_t begin, int64_t end, double *totals)
{
    const tobi_system *s = view;
    const isph *m = s->state;
    float *depth = sph_fields_of(&s->particles)->surface_depth;
    for (int64_t i = begin; i < end; i++) {
        const double *x = &s->particles.position[i].x;
        depth[i] = m->solver.view.gate[i] >= 1 ? (float)tobi_reference_depth(&m->common.soft.still, x) : 0;
        totals[6] = fmax(totals[6], depth[i]);
    }
}

/* The hydrostatic pressure that presses soft solids by itself (decision 112). The solve knows all of it. */
static void find_still(tobi_system *s, isph *m)
{
    tobi_reference *still = &m->common.soft.still;
    double t[TOBI_TOTALS];
    if (!s->sim->soft.solids) return;
    *still = sph_reference_make(s, 0);
    tobi_launch(&s->sim->exec, TOBI_HOST(find_depths, 0, 1), s, 0, s->particles.count, t);
    m->common.lowest = t[6];
    *still = sph_reference_make(s, m->memory.vessel != SPH_VESSEL_FULL ? sph_reference_low(s)
                                   : sph_reference_below_air(s, 0.5*s->smoothing.spacing));
}

tobi_status isph_begin(tobi_system *s, tobi_error *err)
{
    isph *m = s->state;
    double t[TOBI_TOTALS], clock = tobi_clock();
    isph_view *v = &m->solver.view;
    sph_use_dt(s, &m->view);
    v->second_order = is_second_order(s, m);
    v->keeps_volume = m->def.time_order > 1;
    v->way = v->second_order ? 0.5*s->dt : s->dt;
    if (v->second_order) TOBI_TRY(drift(s, m, &clock, err));
    for (int k = 0; k < s->sim->body_count; k++)
        if (s->sim->bodies[k].motion) tobi_body_set_previous_velocities(&s->sim->bodies[k]);
    sph_set_body_velocities(s, &clock);
    TOBI_TRY(find_neighbors(s, m, &clock, err));
    if (!v->second_order) TOBI_TRY(sph_undo_keep(&m->undo, s, 0, err));
    sph_openings_mark(s, &m->view);
    v->held = m->view.held;
    find_geometry(s, m, t);
    find_still(s, m);
    isph_gaps_add_still(&m->solver, s);
    sph_soft_balance(s, v->concentration_gradient, v->gate);
    s->info.volume_drift = t[1] > 0 ? -t[0]/t[1] : 0;
    sph_porous_begin(s);
    tobi_stage_end(&s->sim->stages, "geometry", &clock);
    return TOBI_OK;
}

/* Takes back what pressure has added to the velocities kept in viscous_expected, where it pulls. */
static void expect_no_pull(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_fields *f = sph_fields_of(&s->particles);
    for (int64_t i = begin; i < end; i++)
        if (f->pressure[i] < 0) s->particles.velocity[i] = f->viscous_expected[i];
}

/* Gravity and the pressure of the last step: implicit viscosity acts on what is left of both. Under a free
   surface pressure pulls where liquid is drawn thin, and that changes from step to step: a sheet swung ever
   faster. */
static void expect(tobi_system *s)
{
    isph *m = s->state;
    sph_show_pressure(s);
    launch(s, m, m->kernel->isph_projection, NULL);
    if (m->solver.view.open) tobi_loop(s->sim->exec.threads, s->particles.count, 0, expect_no_pull, s);
    launch(s, m, m->kernel->isph_gravity, NULL);
}

/* 1/s: of (13b), per step that motion allows. */
static double choose_filter(const tobi_system *s, const isph *m)
{
    const double scale = 2*s->smoothing.rate, dt = fmax(s->dt, m->motion_dt);
    if (!m->view.blind) return 0;
    return fmax(m->def.filter - sph_viscous_share(s, &m->view, dt), 0)/(dt*scale*scale);
}

/* Viscosity, friction and tension are those of the other SPH methods, with gravity, and what walls make of
   it, left out: the images of the pressure equation know that. */
void isph_forces(tobi_system *s)
{
    isph *m = s->state;
    double clock = tobi_clock();
    sph_view without = m->view;
    const int corrected = m->def.viscosity_form != TOBI_VISCOSITY_PLAIN;
    if (corrected) sph_phases_find(s, &m->view, m->kernel);
    if (corrected) launch(s, m, m->kernel->isph_viscosity, NULL);
    for (int a = 0; a < 3; a++) without.gravity[a] = 0;
    without.acceleration.acts = 0;
    without.scalar.lift.acts = 0;
    without.filter = (float)choose_filter(s, m);
    without.jumps = 1;
    sph_apply_forces(s, &without, m->kernel, &clock);
    if (corrected) launch(s, m, m->kernel->isph_add_shift_velocity, NULL);
    isph_bodies_remove_hydrostatic(s);
    sph_viscosity_solve(s, &without, m->kernel, expect, &clock);
    isph_porous_brake(s);
    launch(s, m, m->kernel->isph_gravity, NULL);
    sph_openings_hold(s);
}

/* One failure is an event, and the best answer so far is used; many in a row are the end of the run. */
static tobi_status judge(tobi_system *s, isph *m, const tobi_linear_report *report, tobi_error *err)
{
    const int good = report->status == TOBI_LINEAR_CONVERGED;
    s->info.divergence_iterations = report->iterations;
    s->info.divergence_converged = good;
    s->info.density_converged = 1;          /* there is no second equation */
    s->info.pressure_residual = report->residual;
    m->memory.failures = good ? 0 : m->memory.failures + 1;
    if (m->memory.failures <= FAILURES) return TOBI_OK;
    return tobi_fail(err, TOBI_DIVERGED, "the pressure equation did not converge in %d steps in a row; at "
                     "t = %.9g s its residual is %.3g after %d iterations, isph.tolerance asks for %.3g",
                     FAILURES + 1, s->sim->time, report->residual, report->iterations, m->def.tolerance);
}

tobi_status isph_solve(tobi_system *s, tobi_error *err)
{
    isph *m = s->state;
    double t[TOBI_TOTALS], clock = tobi_clock();
    TOBI_TRY(tobi_simulation_check_stop(s->sim, err));
    m->solver.pockets = m->memory.vessel == SPH_VESSEL_POCKETS;
    m->solver.view.porous = sph_fields_of(&s->particles)->porous;
    tobi_linear_report report;
    int again = MOST_AGAIN, iterations = 0;
    isph_carry_find(&m->solver, s);
    do {
        isph_forces_predict(&m->solver, s);
        sph_soft_predict(s, m->solver.sweeps.count == 0);
        report = isph_solver_run(&m->solver, s);
        iterations += report.iterations;
    } while (again-- > 0 && isph_forces_overrun(&m->solver, s));
    report.iterations = iterations;
    isph_solver_store(&m->solver);
    if (m->solver.pockets) m->memory.vessel = SPH_VESSEL_POCKETS;
    TOBI_TRY(tobi_simulation_check_stop(s->sim, err));
    TOBI_TRY(judge(s, m, &report, err));
    m->memory.started = 1;
    tobi_stage_end(&s->sim->stages, "pressure solve", &clock);
    isph_forces_correct(&m->solver, s);
    sph_soft_correct(s, m->solver.view.solution);
    sph_openings_continue(s, 1);
    sph_openings_slope(s);
    isph_porous_compare(&m->solver, s);
    launch(s, m, m->kernel->isph_projection, t);
    m->solver.view.porous = NULL;
    isph_porous_measure(&m->solver, s);
    sph_openings_drive(s);
    s->info.force_sum = t[0]*s->smoothing.volume;
    tobi_stage_end(&s->sim->stages, "pressure force", &clock);
    return TOBI_OK;
}

/* On the sides of the domain friction, as it was made; isph_measure adds the pressure. */
static void measure_forces(tobi_system *s, isph *m, double *clock)
{
    double friction[TOBI_TOTALS];
    sph_stage(s, &m->view, SPH_MOVE);
    sph_view without = m->view;
    without.pressure = NULL;
    for (int a = 0; a < 3; a++) without.gravity[a] = 0;
    without.acceleration.acts = 0;
    without.scalar.lift.acts = 0;
    tobi_launch(&s->sim->exec, m->kernel->sph_wall_force, &without, 0, s->particles.count, friction);
    memcpy(s->info.wall_force, friction, sizeof s->info.wall_force);
    sph_viscosity_load(s);
    m->sides_due = 1;
    tobi_boundary_load(s);
    isph_forces_load(&m->solver, s);
    sph_soft_load(s);
    tobi_couple_correct(s);
    tobi_stage_end(&s->sim->stages, "walls and bodies", clock);
}

void isph_move(tobi_system *s)
{
    isph *m = s->state;
    double t[TOBI_TOTALS], clock = tobi_clock();
    measure_forces(s, m, &clock);
    launch(s, m, m->kernel->isph_shift, t);
    s->info.divergence_mean = t[0]/sph_rows(s);
    s->info.divergence_max = t[6];
    if (m->def.xsph > 0) launch(s, m, m->kernel->isph_xsph, NULL);
    launch(s, m, m->kernel->isph_add_shift_velocity, NULL);
    tobi_stage_end(&s->sim->stages, "shifting", &clock);
    m->view.dt = (float)m->solver.view.way;
    m->memory.speed = sph_move_particles(s, &m->view, m->kernel, &clock);
    sph_use_dt(s, &m->view);
}

/* Eq. (11), where somebody asks, once after a step: then the lists are those of the particles. */
void isph_measure(tobi_system *s)
{
    isph *m = s->state;
    double force[3];
    if (!m->sides_due) return;
    m->sides_due = 0;
    tobi_probe_sides(s, force);
    for (int a = 0; a < 3; a++) s->info.wall_force[a] += force[a];
}

/* A load brings its forces with it. */
void isph_follow_gravity(tobi_system *s, int loaded)
{
    isph *m = s->state;
    if (loaded) m->sides_due = 0;
}

tobi_status isph_refresh(tobi_system *s, tobi_error *err)
{
    double clock = tobi_clock();
    return find_neighbors(s, s->state, &clock, err);
}

void isph_derive(tobi_system *s, const char *field)
{
    isph *m = s->state;
    isph_view *v = &m->solver.view;
    if (!isph_fields_know(field)) {
        sph_derive(s, &m->view, m->kernel, field);
        return;
    }
    v->dt = s->dt > 0 ? s->dt : isph_choose_dt(s);
    v->volume_dt = fmax(m->volume_dt, v->dt);
    find_geometry(s, m, NULL);
    sph_stage(s, &m->view, SPH_DERIVE);
    isph_fields_derive(&m->solver, s, &m->view, field);
    v->dt = s->dt;
}

void isph_read(const tobi_system *s, const char *field, int64_t i, double *out)
{
    if (isph_fields_know(field)) isph_fields_read(s, field, i, out);
    else sph_read(s, field, i, out);
}

int64_t isph_estimate(const tobi_system *s, const tobi_system_plan *plan)
{
    const tobi_isph_def *def = s->method == &tobi_isph ? s->def : NULL;      /* eisph has no other solver */
    return isph_solver_estimate(def, plan) + plan->particles*sph_undo_row_bytes(s);
}

void isph_account(const tobi_system *s, tobi_account *a)
{
    const isph *m = s->state;
    sph_account(s, a);
    isph_solver_account(&m->solver, a);
    tobi_account_add(a, "copies to take a step back", sph_undo_bytes(&m->undo, s));
}

void isph_free_state(void *state)
{
    isph *m = state;
    if (m) tobi_boundary_links_free(&m->common.links);
    if (m) sph_soft_free(&m->common.soft);
    if (m) isph_solver_free(&m->solver);
    if (m) sph_undo_free(&m->undo);
    free(m);
}

const tobi_method tobi_isph = {
    .name = "isph",
    .doc = "Incompressible SPH: one Poisson equation per step, for forces and pressures.",
    .density_ratio = 1000,
    .params = &tobi_isph_table,
    .smoothing = choose_smoothing,
    .create = create,
    .needs = list_needs,
    .max_dt = isph_choose_dt,
    .begin = isph_begin,
    .packs_lists = 1,          /* the matrix takes most of the time, and of the memory with the lists */
    .fills_pipes = 1,
    .nests = 2,
    .rough_forces = 1,
    ISPH_VERBS
};
