/* DFSPH (Bender & Koschier 2015, 2017): a divergence-free velocity and a constant density, by two pressure
   equations that share one symmetric matrix-free operator. Two things differ from the paper:
   - The density equation moves positions and leaves velocities alone. In the paper its correction e/dt
     enters the velocity, so that rearrangements of particles become kinetic energy and the pressure carries
     the noise of e/dt^2. Here pressure is what makes the velocity divergence-free.
   - Conjugate gradients with warm start replace the Jacobi sweeps: the same two pair passes per iteration. A
     multigrid cycle preconditions them, so that iterations hardly grow with the depth.
   Drawback: a free surface is an active set chosen at the start of a solve, not during it. */
#include "sph/state.h"
#include "sph/hydrostatic.h"
#include "sph/dfsph.h"
#include "sph/dfsph_solve.h"
#include "sph/boundary/boundary.h"
#include "sph/openings.h"
#include "sph/porous.h"
#include "sph/porous_carry.h"
#include "sph/stages.h"
#include "sph/reference.h"
#include "sph/viscosity.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of the lattice around bodies, before the first step. */
enum { SETTLING_ROUNDS = 10 };
/* Cells of the preconditioner's grid, in support radii: the operator is weak below. */
enum { GRID_WIDTH = 2 };
/* Density error of a lattice that has nothing to settle: that of a flat wall's sums. */
static const double SETTLED = 0.01;

/* Share of the kernel average in the pressure a step starts from. */
static const double PRESSURE_SMOOTHING = 0.02;

/* Share of the density error in an outlet's buffer that its positions give way to in a step. */
static const float BUFFER_RELAXATION = 0.1f;

/* Spacings: the shortest support at which particle shifting closes cavities instead of stirring. */
static const double SHIFTING_SUPPORT = 2.5;

/* Shifting, without which cavities open, wants more neighbours than the shortest support reaches. */
static void choose_smoothing(const void *def, int driven, int *shape, double *support)
{
    const tobi_dfsph_def *d = def;
    *shape = d->kernel;
    *support = d->support > 0 ? d->support
               : tobi_smoothing_support(d->kernel, driven ? SHIFTING_SUPPORT : 2);
}

static int reaches_far(const tobi_system *s)
{
    return s->smoothing.h > (SHIFTING_SUPPORT - 1e-6)*s->smoothing.spacing;
}

static void bind_view(tobi_system *s, dfsph *m)
{
    sph_view *v = &m->view;
    sph_bind_view(s, v, m->memory.vessel);
    sph_reference_set(s, m->memory.level);
    v->reference = sph_of(s)->reference;
}

static tobi_status create(tobi_system *s, tobi_error *err)
{
    dfsph *m = s->state = calloc(1, sizeof *m);
    if (!m) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the dfsph state");
    m->def = *(const tobi_dfsph_def *)s->def;
    m->common.past_edges = 1;
    m->kernel = sph_kernels_for(s->sim->exec.isa, m->def.kernel);
    if (sph_has_openings(s)) m->def.still_water = 0;       /* the level of the start is none for long */
    return TOBI_OK;
}

static int list_memory(tobi_system *s, double **values)
{
    dfsph *m = s->state;
    *values = &m->memory.speed;
    return 7;
}

/* dt <= min(cfl d/|v|, cfl d/(2 sqrt(|p|/rho)), 0.25 sqrt(d/g), 0.8/(nu rate)) with the rate of the
   viscous sum of a particle at a no-slip wall. The pressure keeps
   particles apart like a spring of frequency sqrt(p/rho)/d, which an explicit step must resolve.
   Not above a tenth more than the last. */
static double choose_dt(tobi_system *s)
{
    dfsph *m = s->state;
    double d = s->smoothing.spacing, dt, speed = fmax(m->memory.speed, s->sim->body_speed);
    m->motion_dt = fmin(sph_gravity_dt(s),
                        s->sim->def.cfl*d/sqrt(fmax(fmax(speed*speed, 4*m->memory.head), 1e-24)));
    if (s->sim->def.time_step > 0) {
        dt = s->sim->def.time_step;
    } else {
        dt = fmin(m->motion_dt, fmin(sph_force_dt(s), tobi_couple_dt(s)));
        if (s->sim->def.time_step_max > 0) dt = fmin(dt, s->sim->def.time_step_max);
        if (m->memory.dt > 0) dt = fmin(dt, 1.1*m->memory.dt);
        else {      /* liquid beside solids sets off at once, and that before a body through narrow places */
            const double depth = s->sim->soft.solids ? 4*s->start_head : 0;
            const tobi_simulation *w = s->sim;
            const double body = w->body_speed > w->wall_speed ? TOBI_NARROWEST*w->body_speed : 0;
            dt = fmin(dt, s->sim->def.cfl*d/sqrt(fmax(fmax(depth, body*body), 1e-24)));
        }
        m->memory.dt = dt;
    }
    return dt;
}

static tobi_status find_neighbors(tobi_system *s, dfsph *m, double *clock, tobi_error *err)
{
    if (!m->grid.memory) {
        const tobi_cell_points cells = tobi_cells_points(&s->cells, &s->box, &s->particles);
        TOBI_TRY(tobi_multigrid_create(&m->grid, &cells, GRID_WIDTH, 1, err));
    }
    TOBI_TRY(sph_find_neighbors(s, clock, err));
    bind_view(s, m);
    return TOBI_OK;
}

static tobi_status classify_vessel(tobi_system *s, dfsph *m, double *clock, tobi_error *err)
{
    TOBI_TRY(sph_classify_vessel(s, &m->view, m->kernel, &m->memory.vessel, clock, err));
    if (m->memory.vessel == SPH_VESSEL_OPEN) return TOBI_OK;
    sph_remove_gravity(s);
    bind_view(s, m);
    return TOBI_OK;
}

static void apply_forces(tobi_system *s, dfsph *m, double *clock)
{
    /* per motion step: a step made short by viscosity or by the user filters less */
    double scale = 2*s->smoothing.rate, dt = fmax(s->dt, m->motion_dt), share = m->def.filter;
    if (m->view.exact) share = fmax(share - sph_viscous_share(s, &m->view, dt), 0);
    m->view.filter = (float)(share/(dt*scale*scale));
    sph_apply_forces(s, &m->view, m->kernel, clock);
    sph_viscosity_solve(s, &m->view, m->kernel, NULL, clock);
}

/* A surface particle has pressure 0 about a spacing outside, over its share of the surface. */
static void set_grid(tobi_system *s, dfsph *m)
{
    const sph_fields *f = sph_fields_of(&s->particles);
    const tobi_cell_points points = tobi_cells_points(&s->cells, &s->box, &s->particles);
    const double d = s->smoothing.spacing, strength = m->view.inverse_density[0];
    const tobi_grid_weights w = {.strength = strength,
                                 .volume = s->smoothing.volume,
                                 .active = f->precondition,
                                 .marked = f->surface,
                                 .hold = strength/(d*d)};
    tobi_multigrid_set(&m->grid, &s->sim->exec, &points, &w);
}

/* Of the tolerances. Under a free surface the shorter steps that follow take out what the first leave: 3 % of
   the pressure at a floor where water starts at rest. */
static double first_share(const tobi_system *s, const dfsph *m)
{
    enum { FIRST_STEPS = 10 };
    const int alone = !tobi_couple_any(s) && sph_of(s)->soft.points == 0;
    return s->step < FIRST_STEPS && m->memory.vessel != SPH_VESSEL_FULL && alone ? 0.3 : 1;
}

/* Pressure of the step: v becomes divergence-free. */
static void remove_divergence(tobi_system *s, dfsph *m, double *clock)
{
    const sph_kernels *k = m->kernel;
    double t[TOBI_TOTALS];
    sph_stage(s, &m->view, SPH_SOLVE);
    m->view.pressure = sph_fields_of(&s->particles)->pressure;
    dfsph_launch(s, m, k->sph_warm_start, NULL);
    dfsph_launch(s, m, k->sph_pressure_accel, NULL);
    tobi_couple_press(s);
    dfsph_launch(s, m, k->sph_source, t);
    dfsph_solve q = {.tolerance = first_share(s, m)*m->def.divergence_tolerance,
               .relative_tolerance = first_share(s, m)*m->def.pressure_tolerance,
               .min = m->def.divergence_iterations_min, .max = m->def.divergence_iterations_max,
               .source = t[0], .grid = 1, .coupled = 1, .constant_free = m->memory.vessel == SPH_VESSEL_FULL};
    dfsph_add_answers(s, NULL);
    dfsph_launch(s, m, k->sph_warm_residual, t);
    set_grid(s, m);
    dfsph_solve_pressure(s, m, t, &q);
    sph_porous_kick(s, &m->view, k, t);
    s->info.force_sum = t[0]*s->smoothing.volume;
    m->memory.head = fmin(q.head, sph_explained_head(s));
    s->info.divergence_iterations = q.iterations;
    s->info.divergence_converged = q.converged;
    s->info.divergence_mean = q.error/s->dt;
    s->info.divergence_max = q.worst*s->dt;
    s->info.pressure_residual = q.relative;
    tobi_stage_end(&s->sim->stages, "divergence solve", clock);
}

/* The shift of the position solve, with particle shifting where the vessel is full. */
static void shift_positions(tobi_system *s, dfsph *m)
{
    double d = s->smoothing.spacing;
    double strength = m->memory.vessel == SPH_VESSEL_FULL && reaches_far(s) ? m->def.shifting : 0;
    m->view.background = (float)(strength*d*d*s->fluid[0].density/(2*s->dt*s->dt));
    m->view.relaxation = BUFFER_RELAXATION;
    if (sph_has_openings(s)) dfsph_launch(s, m, m->kernel->sph_relax_outlet, NULL);
    dfsph_launch(s, m, m->kernel->sph_shift, NULL);
}

/* Whether a cavity two or three spacings wide has opened in a full vessel. Disorder makes one such particle
   in 1e5 as well. */
static int has_void(const tobi_system *s)
{
    return sph_of(s)->open > (s->box.dimension == 3 ? 20 : 6) + 1e-5*(double)s->particles.count;
}

/* Shift of positions that takes out the density error; left in accel. A cavity in a full vessel shows as
   compression of the rest, whose mean is then solved for, so that the rest expands into it. No test of
   |r|/|s|: where the error starts below its tolerance, |r| rises for tens of iterations before it falls,
   with nothing to gain. */
static void correct_density(tobi_system *s, dfsph *m, double *clock)
{
    double t[TOBI_TOTALS];
    sph_stage(s, &m->view, SPH_CORRECT);
    m->view.pressure = sph_fields_of(&s->particles)->correction;
    dfsph_launch(s, m, m->kernel->sph_density_residual, t);
    double mean = t[2]*s->dt*s->dt/sph_rows(s);
    int full = m->memory.vessel == SPH_VESSEL_FULL, closes = has_void(s) && mean > m->def.density_tolerance;
    dfsph_solve q = {.tolerance = m->def.density_tolerance,
               .relative_tolerance = HUGE_VAL, .nothing = 1e-3*m->def.density_tolerance,
               .min = m->def.density_iterations_min, .max = m->def.density_iterations_max,
               .source = t[0], .constant_free = full && !closes};
    dfsph_solve_pressure(s, m, t, &q);
    shift_positions(s, m);
    s->info.density_iterations = q.iterations;
    s->info.density_converged = q.converged;
    tobi_stage_end(&s->sim->stages, "density solve", clock);
}

/* Before the first step: a lattice cut by a body has gaps along it that water would leak through, and pairs
   that crowd. Near bodies the shift of (12) takes place without time passing. Bodies that move by forces set
   off slowly and gain nothing, decision 31. */
static tobi_status relax_lattice(tobi_system *s, dfsph *m, double *clock, tobi_error *err)
{
    const tobi_simulation *w = s->sim;
    if (s->step > 0 || w->body_count == 0 || tobi_body_any_free(w->bodies, w->body_count)) return TOBI_OK;
    for (int k = 0; k < SETTLING_ROUNDS; k++) {
        TOBI_TRY(sph_find_boundaries(s, &m->view, m->kernel, clock, err));
        m->diagonal = sph_measure_density(s, &m->view, m->kernel, 0, clock);
        if (s->info.density_error_max < SETTLED) return TOBI_OK;
        correct_density(s, m, clock);
        TOBI_TRY(tobi_simulation_check_stop(s->sim, err));
        tobi_boundary_relax(s);
        TOBI_TRY(find_neighbors(s, m, clock, err));
    }
    return TOBI_OK;
}

/* The level of still water follows the free surface of the last step. */
static void set_reference(tobi_system *s, dfsph *m)
{
    sph_reference_move(s, &m->view.reference_before, m->def.still_water ? m->memory.low : 0, m->memory.open,
                       fmax(m->memory.speed, s->sim->body_speed), &m->memory.level);
}

/* Before the first step: still water and the share of gravity that walls carry, (18) and (6b), follow from
   the pressure of the step before. Without one the water would set off as if neither were there, and the
   second step would press it back: a sensor read 1.8 times the pressure of rest. So the first step's pressure
   is solved for twice with the velocities of the start before it is used. */
static tobi_status find_first_pressure(tobi_system *s, dfsph *m, double *clock, tobi_error *err)
{
    if (s->step > 0) return TOBI_OK;
    tobi_float4 *kept = tobi_array_make(s->particles.count, sizeof *kept);
    if (!kept) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the velocities of the start");
    memcpy(kept, s->particles.velocity, (size_t)s->particles.count*sizeof *kept);
    tobi_status status = TOBI_OK;
    for (int k = 0; k < 2 && status == TOBI_OK; k++) {
        status = sph_find_boundaries(s, &m->view, m->kernel, clock, err);
        if (status != TOBI_OK) break;
        m->diagonal = sph_measure_density(s, &m->view, m->kernel, 0, clock);
        m->memory.low = sph_reference_low(s);
        apply_forces(s, m, clock);
        tobi_couple_begin(s);
        sph_soft_begin(s, 1);
        remove_divergence(s, m, clock);
        memcpy(s->particles.velocity, kept, (size_t)s->particles.count*sizeof *kept);
        set_reference(s, m);
        bind_view(s, m);
    }
    tobi_array_free(kept);
    return status;
}

/* May be stopped as long as nothing has moved. */
static tobi_status remember(tobi_system *s, tobi_error *err)
{
    dfsph *m = s->state;
    double *memory;
    const int n = list_memory(s, &memory);
    return sph_undo_begin(&m->undo, s, memory, n, err);
}

static void take_back(tobi_system *s)
{
    dfsph *m = s->state;
    double *memory;
    const int n = list_memory(s, &memory);
    sph_undo_restore(&m->undo, s, memory, n);
}

static tobi_status begin(tobi_system *s, tobi_error *err)
{
    dfsph *m = s->state;
    double clock = tobi_clock();
    sph_use_dt(s, &m->view);
    sph_set_body_velocities(s, &clock);
    set_reference(s, m);
    TOBI_TRY(find_neighbors(s, m, &clock, err));
    TOBI_TRY(sph_undo_keep(&m->undo, s, 0, err));
    TOBI_TRY(classify_vessel(s, m, &clock, err));
    TOBI_TRY(relax_lattice(s, m, &clock, err));
    sph_openings_mark(s, &m->view);
    TOBI_TRY(find_first_pressure(s, m, &clock, err));
    TOBI_TRY(sph_find_boundaries(s, &m->view, m->kernel, &clock, err));
    m->diagonal = sph_measure_density(s, &m->view, m->kernel, PRESSURE_SMOOTHING, &clock);
    m->memory.low = sph_reference_low(s);
    m->memory.open = sph_reference_open(s);
    sph_porous_begin(s);
    return TOBI_OK;
}

static void forces(tobi_system *s)
{
    double clock = tobi_clock();
    apply_forces(s, s->state, &clock);
    sph_porous_brake(s);
}

static tobi_status solve(tobi_system *s, tobi_error *err)
{
    dfsph *m = s->state;
    double clock = tobi_clock();
    TOBI_TRY(tobi_simulation_check_stop(s->sim, err));
    tobi_couple_begin(s);
    sph_soft_begin(s, 1);
    m->view.porous = sph_fields_of(&s->particles)->porous;
    remove_divergence(s, m, &clock);
    m->view.porous = NULL;
    sph_porous_measure(s);
    TOBI_TRY(tobi_simulation_check_stop(s->sim, err));
    correct_density(s, m, &clock);
    return tobi_simulation_check_stop(s->sim, err);
}

static void move(tobi_system *s)
{
    dfsph *m = s->state;
    double clock = tobi_clock();
    sph_stage(s, &m->view, SPH_MOVE);
    m->view.pressure = sph_fields_of(&s->particles)->pressure;
    sph_measure_forces(s, &m->view, m->kernel, &clock);
    sph_add_hydrostatic(s);
    tobi_couple_correct(s);
    m->memory.speed = sph_move_particles(s, &m->view, m->kernel, &clock);
}

static tobi_status refresh(tobi_system *s, tobi_error *err)
{
    dfsph *m = s->state;
    double clock = tobi_clock();
    TOBI_TRY(find_neighbors(s, m, &clock, err));
    TOBI_TRY(classify_vessel(s, m, &clock, err));
    TOBI_TRY(sph_find_boundaries(s, &m->view, m->kernel, &clock, err));
    m->diagonal = sph_measure_density(s, &m->view, m->kernel, 0, &clock);
    (void)sph_reference_low(s);
    return TOBI_OK;
}

static void derive(tobi_system *s, const char *field)
{
    dfsph *m = s->state;
    sph_derive(s, &m->view, m->kernel, field);
}

static void follow_gravity(tobi_system *s, int loaded)
{
    dfsph *m = s->state;
    const sph_surface surface = { &m->memory.vessel, &m->memory.low, &m->memory.level, sph_reference_low,
                                  m->def.still_water };
    if (!loaded) sph_reference_follow(s, &m->view, m->kernel, &surface);
}

static int64_t estimate(const tobi_system *s, const tobi_system_plan *plan)
{
    return tobi_multigrid_plan_bytes(&plan->cells, GRID_WIDTH) + plan->particles*sph_undo_row_bytes(s);
}

static void account(const tobi_system *s, tobi_account *a)
{
    const dfsph *m = s->state;
    sph_account(s, a);
    tobi_account_add(a, "grid of the solver", tobi_multigrid_bytes(&m->grid));
    tobi_account_add(a, "copies to take a step back", sph_undo_bytes(&m->undo, s));
}

static void free_state(void *state)
{
    dfsph *m = state;
    if (m) tobi_boundary_links_free(&m->common.links);
    if (m) sph_soft_free(&m->common.soft);
    if (m) tobi_multigrid_free(&m->grid);
    if (m) sph_undo_free(&m->undo);
    free(m);
}

const tobi_method tobi_dfsph = {
    .name = "dfsph",
    .doc = "Divergence-free SPH for water: incompressible, free surface, walls and moving bodies.",
    .density_ratio = 10,
    .damps_waves = 1,
    .nests = 1,
    .params = &tobi_dfsph_table,
    .fields = &sph_field_list,
    .outputs = sph_outputs,
    .needs = sph_needs,
    .smoothing = choose_smoothing,
    .create = create,
    .max_dt = choose_dt,
    .remember = remember,
    .take_back = take_back,
    .begin = begin,
    .forces = forces,
    .solve = solve, .move = move, .finish = sph_finish,
    .refresh = refresh,
    .read = sph_read, .derive = derive,
    .memory = list_memory,
    .follow_gravity = follow_gravity,
    .estimate = estimate,
    .account = account,
    .free = free_state,
};
