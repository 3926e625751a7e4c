/* The step of the world. Bodies and the clock are moved here and nowhere else. The first system sets the
   length; one whose stable step is shorter takes substeps, under the constant forces of a liquid on solids.
   Drawback: where bodies move by forces the shortest stable step holds for all. */
#include "world/step.h"
#include "world/absorb.h"
#include "world/acceleration.h"
#include "world/beside.h"
#include "world/bodies.h"
#include "world/motors.h"
#include "world/nest.h"
#include "world/openings.h"
#include "world/runaway.h"
#include "base/error.h"
#include <math.h>
#include <string.h>

static tobi_status remember(tobi_world *w, tobi_error *err)
{
    for (int k = 0; k < w->system_count; k++)
        if (w->system[k].method->remember) TOBI_TRY(w->system[k].method->remember(&w->system[k], err));
    return TOBI_OK;
}

static void take_back(tobi_world *w, double dt)
{
    for (int k = 0; k < w->system_count; k++)
        if (w->system[k].method->take_back) w->system[k].method->take_back(&w->system[k]);
    w->sim.dt = dt;
}

/* Substeps of a system in a step of another. */
enum { SUBSTEP_LIMIT = 10000 };
/* s: the square of the inverse of a shorter step is no float. */
static const double LEAST_STEP = 1e-18;

/* m: the farthest that a driven body is from its place after a time; INFINITY where it would be too fast. */
static tobi_status find_way_to(tobi_world *w, double step, double *way, tobi_error *err)
{
    tobi_simulation *s = &w->sim;
    double speed = 0;
    *way = INFINITY;
    for (int k = 0; k < s->body_count; k++) {
        if (!s->bodies[k].motion || s->bodies[k].rigid.kind != TOBI_PRESCRIBED) continue;
        const tobi_status status = tobi_body_predict(&s->bodies[k], s->time, step, &speed, err);
        if (status == TOBI_INVALID) return TOBI_OK;
        TOBI_TRY(status);
    }
    *way = speed*step;
    return TOBI_OK;
}

/* m: the farthest that a driven body goes in a step. Without gravity steps may be as long as a period, at
   the end of which a body that swings is back: it is looked for within as well. */
static tobi_status find_way(tobi_world *w, double step, double *way, tobi_error *err)
{
    const int looks = tobi_simulation_pull_size(&w->sim) > 0 ? 1 : TOBI_LOOKS;
    *way = 0;
    for (int n = 0; n < looks && isfinite(*way); n++) {
        double far;
        TOBI_TRY(find_way_to(w, TOBI_LOOK[n]*step, &far, err));
        *way = fmax(*way, far);
    }
    return TOBI_OK;
}

static int is_driven(const tobi_simulation *s)
{
    int driven = 0;
    for (int k = 0; k < s->body_count; k++)
        driven |= s->bodies[k].motion && s->bodies[k].rigid.kind == TOBI_PRESCRIBED;
    return driven;
}

/* A body that rests may set off within the step, and methods know the speeds of the last step alone. Without
   gravity nothing else bounds it. Halves dt until such bodies go twice the way that cfl allows, at most. A
   jump is as far in a sixty-fourth of the step as in the whole: it is left to the whole. So is what swings
   faster than that: the first step, which nothing bounds, is halved on, and later ones grow by as much. */
static tobi_status look_ahead(tobi_world *w, double max_dt, double *dt, tobi_error *err)
{
    enum { LOOKS = 6, FIRST_LOOKS = 60 };
    const tobi_simulation *s = &w->sim;
    const double most = s->def.cfl*w->system[0].smoothing.spacing;
    const int first = s->dt == 0, apart = first ? FIRST_LOOKS : LOOKS;
    double way, marked_way = INFINITY, marked = *dt;
    if (s->def.time_step > 0 || w->system[0].method->solids) return TOBI_OK;
    if (!first && is_driven(s) && !(tobi_simulation_pull_size(s) > 0))
        *dt = marked = fmin(*dt, ldexp(s->dt, LOOKS));
    for (int looks = 0;; looks++, *dt *= 0.5) {
        const double step = tobi_simulation_fit_dt(*dt, max_dt);
        if (s->body_speed*step > 0.5*most) return TOBI_OK;      /* it counts already */
        TOBI_TRY(find_way(w, step, &way, err));
        if (way <= 2*most) return TOBI_OK;
        if (looks%apart == 0 && looks > 0 && way >= 0.5*marked_way) {
            *dt = marked;
            return TOBI_OK;
        }
        if (looks%apart == 0) marked_way = way, marked = *dt;
        if (max_dt > 0) *dt = fmin(*dt, max_dt);
    }
}

/* Gravity in time, or a tank, may set off likewise. Methods know the largest acceleration until now. Halves
   dt until it is at most twice as long as what comes within it allows. */
static tobi_status look_at_drive(tobi_world *w, double max_dt, double *dt, tobi_error *err)
{
    const tobi_simulation *s = &w->sim;
    const double *g = s->def.gravity;
    double pull;
    if (!w->drive || s->def.time_step > 0 || w->system[0].method->solids) return TOBI_OK;
    if (g[0] != 0 || g[1] != 0 || g[2] != 0) return TOBI_OK;        /* that bounds it */
    if (max_dt > 0) *dt = fmin(*dt, max_dt);
    for (;; *dt *= 0.5) {
        const double step = tobi_simulation_fit_dt(*dt, max_dt);
        TOBI_TRY(tobi_world_find_pull(w, step, &pull, err));
        const double most = 0.25*w->system[0].smoothing.spacing;
        if (!(step*step*pull > most) || step < LEAST_STEP) return TOBI_OK;
    }
}

/* s: without gravity, what pressures at outlets allow, which push as a weight would over the longest side. */
static double bound_without_gravity(const tobi_world *w)
{
    const tobi_simulation *s = &w->sim;
    const tobi_system *sys = &w->system[0];
    const double d = sys->smoothing.spacing, speed = tobi_system_fall_speed(sys);
    double longest = 0;
    if (tobi_simulation_pull_size(s) > 0 || s->def.time_step > 0 || sys->method->solids) return INFINITY;
    for (int a = 0; a < s->def.dimension; a++) longest = fmax(longest, sys->box.size[a]);
    return speed > 0 ? 0.25*sqrt(2*d*longest)/speed : INFINITY;
}

/* The solid whose material allows the shortest step. */
static int find_stiffest(const tobi_system *s)
{
    int stiffest = 0;
    for (int k = 1; k < s->solid_count; k++)
        if (s->method->stable_dt(s, k, 0) < s->method->stable_dt(s, stiffest, 0)) stiffest = k;
    return stiffest;
}

static tobi_status check_substeps(const tobi_system *s, int64_t count, double step, tobi_error *err)
{
    if (count <= SUBSTEP_LIMIT) return TOBI_OK;
    const int k = find_stiffest(s);
    tobi_fail(err, TOBI_INVALID, "solid '%s' needs %lld substeps in a step of %.3g s, allowed are %d; solids "
              "less stiff, or a shorter time_step_max, need fewer", s->solids[k].name, (long long)count, step,
              SUBSTEP_LIMIT);
    return tobi_at_key(err, TOBI_INVALID, "solids[%d]", k);
}

/* The step of all, and the substeps that each system takes in it. */
static tobi_status choose_dt(tobi_world *w, double max_dt, int64_t substeps[TOBI_SYSTEM_LIMIT],
                             tobi_error *err)
{
    tobi_simulation *s = &w->sim;
    double stable[TOBI_SYSTEM_LIMIT] = { 0 }, dt;
    for (int k = 0; k < w->system_count; k++) stable[k] = w->system[k].method->max_dt(&w->system[k]);
    dt = stable[0];
    if (tobi_body_any_free(s->bodies, s->body_count))
        for (int k = 1; k < w->system_count; k++) dt = fmin(dt, stable[k]);
    if (dt < LEAST_STEP)
        return tobi_fail(err, TOBI_STALLED, "the time step would be %.3g s at t = %.9g s; allowed are %g s "
                         "or more", dt, s->time, LEAST_STEP);
    dt = fmin(dt, bound_without_gravity(w));
    TOBI_TRY(look_at_drive(w, max_dt, &dt, err));
    TOBI_TRY(look_ahead(w, max_dt, &dt, err));
    s->dt = tobi_simulation_fit_dt(dt, max_dt);
    for (int k = 0; k < w->system_count; k++) {
        substeps[k] = k > 0 ? (int64_t)fmax(ceil(s->dt/stable[k]*(1 - 1e-9)), 1) : 1;
        w->system[k].dt = s->dt/(double)substeps[k];
        TOBI_TRY(check_substeps(&w->system[k], substeps[k], s->dt, err));
    }
    return TOBI_OK;
}

static tobi_status predict_bodies(tobi_simulation *s, tobi_error *err)
{
    double clock = tobi_clock();
    s->body_speed = s->wall_speed;
    for (int k = 0; k < s->body_count; k++) {
        tobi_body_clear_loads(&s->bodies[k]);
        TOBI_TRY(tobi_body_predict(&s->bodies[k], s->time, s->dt, &s->body_speed, err));
    }
    TOBI_TRY(tobi_constraints_close(&s->constraints, s->bodies, s->time, s->dt, err));
    tobi_stage_end(&s->stages, "motion", &clock);
    return TOBI_OK;
}

/* What bodies or another system stir stays as fast when those stop: a body on a spring stops at each turn. */
static void remember_speed(tobi_world *w)
{
    double imposed = w->sim.body_speed;
    for (int k = 0; k < w->system_count; k++) imposed = fmax(imposed, w->system[k].start_speed);
    for (int k = 0; k < w->system_count; k++)
        w->system[k].start_speed = fmax(w->system[k].start_speed, imposed);
}

/* It leaves its narrow place as a jet. */
static void remember_pushed(tobi_world *w)
{
    for (int k = 0; k < w->system_count; k++) {
        tobi_system *s = &w->system[k];
        if (s->fluid_count > 0) s->pushed_speed = fmax(s->pushed_speed, tobi_system_pushed_speed(s));
    }
}

/* One step or substep of a system. */
static tobi_status step_system(tobi_system *s, tobi_error *err)
{
    const tobi_method *m = s->method;
    if (m->begin) TOBI_TRY(m->begin(s, err));
    tobi_damping_apply(s);
    if (m->forces) m->forces(s);
    if (m->solve) TOBI_TRY(m->solve(s, err));
    m->move(s);
    s->step++;
    return TOBI_OK;
}

static tobi_status move_bodies(tobi_world *w, tobi_error *err)
{
    tobi_simulation *s = &w->sim;
    double clock = tobi_clock();
    for (int k = 0; k < s->body_count; k++)
        TOBI_TRY(tobi_body_advance(&s->bodies[k], s->time + s->dt, s->dt, err));
    tobi_stage_end(&s->stages, "motion", &clock);
    for (int k = 0; k < w->system_count; k++)
        if (w->system[k].method->finish) w->system[k].method->finish(&w->system[k]);
    for (int k = 0; k < s->body_count; k++) tobi_body_sum_loads(&s->bodies[k]);
    return TOBI_OK;
}

/* Bodies with a motion, `way` s after the begin of the step, `more` of it since they were last placed. */
static tobi_status place_bodies(tobi_simulation *s, double way, double more, tobi_error *err)
{
    s->way = way;
    for (int k = 0; k < s->body_count; k++)
        if (s->bodies[k].rigid.kind == TOBI_PRESCRIBED)
            TOBI_TRY(tobi_body_place_within(&s->bodies[k], s->time, way, more, err));
    return TOBI_OK;
}

static tobi_status take_substeps(tobi_world *w, tobi_system *s, int64_t count, tobi_error *err)
{
    for (int64_t n = 0; n < count; n++) {
        if (n > 0) TOBI_TRY(place_bodies(&w->sim, (double)n*s->dt, s->dt, err));
        TOBI_TRY(step_system(s, err));
    }
    return count > 1 ? place_bodies(&w->sim, 0, -(double)(count - 1)*s->dt, err) : TOBI_OK;
}

static tobi_status step_systems(tobi_world *w, const int64_t substeps[TOBI_SYSTEM_LIMIT], tobi_error *err)
{
    for (int k = 0; k < w->system_count; k++) TOBI_TRY(take_substeps(w, &w->system[k], substeps[k], err));
    return TOBI_OK;
}

static tobi_status take_step(tobi_world *w, double max_dt, tobi_error *err)
{
    tobi_simulation *s = &w->sim;
    int64_t substeps[TOBI_SYSTEM_LIMIT];
    tobi_world_cap_step(w);
    TOBI_TRY(tobi_nest_remember(w, err));
    tobi_nest_follow(w);
    TOBI_TRY(remember(w, err));
    TOBI_TRY(tobi_world_sample_drive(w, s->time, err));
    TOBI_TRY(choose_dt(w, max_dt, substeps, err));
    TOBI_TRY(tobi_world_sample_drive(w, s->time + s->dt, err));      /* what comes within it may speed up */
    TOBI_TRY(tobi_world_drive(w, err));
    TOBI_TRY(tobi_motors_tell(w, s->time, s->dt, err));
    tobi_absorb_predict(w);
    TOBI_TRY(predict_bodies(s, err));
    TOBI_TRY(tobi_world_carry_porous(w, err));
    s->changed = 1;
    remember_speed(w);
    TOBI_TRY(step_systems(w, substeps, err));
    tobi_constraints_settle(&s->constraints, s->bodies, s->dt);
    if (s->soft.solids) s->body_speed = fmax(s->body_speed, s->soft.speed);
    TOBI_TRY(move_bodies(w, err));
    remember_pushed(w);
    s->time += s->dt;
    s->step++;
    TOBI_TRY(tobi_world_kick_bodies(w, err));
    for (int k = 0; k < s->body_count; k++) tobi_body_find_power(&s->bodies[k], s->dt);
    TOBI_TRY(tobi_openings_pass(w, err));
    TOBI_TRY(tobi_nest_tally(w, err));
    TOBI_TRY(tobi_nest_pass(w, err));
    tobi_absorb_finish(w);
    tobi_step_sum_up(w);
    for (int k = 0; k < w->system_count; k++) TOBI_TRY(tobi_runaway_check(&w->system[k], err));
    return tobi_beside_check(w, err);
}

/* What the choice of a step may change before anything moves. */
typedef struct kept { double memory[TOBI_SYSTEM_LIMIT][TOBI_MEMORY_LIMIT], dt, body_speed; } kept;

static void keep_memory(tobi_world *w, kept *keep)
{
    double *memory;
    for (int k = 0; k < w->system_count; k++) {
        const int n = tobi_system_memory(&w->system[k], &memory);
        assert(n <= TOBI_MEMORY_LIMIT);
        memcpy(keep->memory[k], memory, (size_t)n*sizeof *memory);
    }
    keep->dt = w->sim.dt;
    keep->body_speed = w->sim.body_speed;
}

static void put_back(tobi_world *w, const kept *keep)
{
    double *memory;
    for (int k = 0; k < w->system_count; k++) {
        const int n = tobi_system_memory(&w->system[k], &memory);
        memcpy(memory, keep->memory[k], (size_t)n*sizeof *memory);
        w->system[k].dt = keep->dt;
    }
    w->sim.dt = keep->dt;
    w->sim.body_speed = keep->body_speed;
}

/* A step that fails before anything has moved leaves the world as it was; after that the failure stays in
   w->failure. A method takes back itself what the caller stops. */
tobi_status tobi_step_take(tobi_world *w, double max_dt, tobi_error *err)
{
    kept keep;
    TOBI_TRY(tobi_simulation_check_stop(&w->sim, err));
    keep_memory(w, &keep);
    w->sim.changed = 0;
    const tobi_status status = take_step(w, max_dt, &w->failure);
    if (status == TOBI_OK) return TOBI_OK;
    if (err) *err = w->failure;
    if (status == TOBI_STOPPED || !w->sim.changed) w->failure.status = TOBI_OK;
    if (status == TOBI_STOPPED) take_back(w, keep.dt);
    else if (!w->sim.changed) put_back(w, &keep);
    return status;
}
