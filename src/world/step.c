/* The step of the world. Bodies and the clock are moved here and nowhere else. The first system sets the
   length; one whose stable step is shorter takes substeps. Drawback: systems meet only through bodies, and
   where there are bodies the shortest stable step holds for all. */
#include "world/step.h"
#include "world/bodies.h"
#include "world/limits.h"
#include "base/error.h"
#include <math.h>

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

/* The step of all, and the substeps that each system takes in it. */
static void choose_dt(tobi_world *w, double max_dt, int64_t substeps[TOBI_SYSTEM_LIMIT])
{
    tobi_simulation *s = &w->sim;
    double stable[TOBI_SYSTEM_LIMIT] = { 0 }, dt;
    for (int k = 0; k < w->system_count; k++) stable[k] = w->system[k].method->max_dt(&w->system[k]);
    dt = stable[0];
    for (int k = 1; k < w->system_count && s->body_count > 0; k++) dt = fmin(dt, stable[k]);
    s->dt = tobi_simulation_fit_dt(dt, max_dt);
    for (int k = 0; k < w->system_count; k++) {
        substeps[k] = k > 0 ? (int64_t)fmax(ceil(s->dt/stable[k]*(1 - 1e-9)), 1) : 1;
        w->system[k].dt = s->dt/(double)substeps[k];
    }
}

static tobi_status predict_bodies(tobi_simulation *s, tobi_error *err)
{
    double clock = tobi_clock();
    s->body_speed = s->wall_speed;
    for (int k = 0; k < s->body_count; k++)
        TOBI_TRY(tobi_body_predict(&s->bodies[k], s->time, s->dt, &s->body_speed, err));
    tobi_stage_end(&s->stages, "motion", &clock);
    return TOBI_OK;
}

/* One step or substep of a system. */
static tobi_status step_system(tobi_system *s, tobi_error *err)
{
    const tobi_method *m = s->method;
    TOBI_TRY(m->begin(s, err));
    if (m->forces) m->forces(s);
    TOBI_TRY(m->solve(s, err));
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
    return TOBI_OK;
}

static tobi_status step_systems(tobi_world *w, const int64_t substeps[TOBI_SYSTEM_LIMIT], tobi_error *err)
{
    for (int k = 0; k < w->system_count; k++)
        for (int64_t n = 0; n < substeps[k]; n++) TOBI_TRY(step_system(&w->system[k], err));
    return TOBI_OK;
}

static void add_info(tobi_step_info *sum, const tobi_step_info *one)
{
    const double all = (double)(sum->fluid_particles + one->fluid_particles);
    const double share = (double)one->fluid_particles/fmax(all, 1);
    sum->density_converged &= one->density_converged;
    sum->divergence_converged &= one->divergence_converged;
    sum->surface_share += share*(one->surface_share - sum->surface_share);
    sum->speed_max = fmax(sum->speed_max, one->speed_max);
    for (int a = 0; a < 3; a++) {
        sum->wall_force[a] += one->wall_force[a];
        sum->momentum[a] += one->momentum[a];
    }
    sum->weight += one->weight;
    sum->kinetic_energy += one->kinetic_energy;
    sum->potential_energy += one->potential_energy;
    sum->elastic_energy += one->elastic_energy;
    sum->fluid_particles += one->fluid_particles;
    sum->particles_lost += one->particles_lost;
    sum->put_back += one->put_back;
    sum->capped += one->capped;
    sum->contacts += one->contacts;
}

/* What only solids have, from theirs; at most one system has solids. */
static void add_solid_info(tobi_step_info *sum, const tobi_step_info *one)
{
    sum->work_bodies = one->work_bodies;
    sum->energy_lost = one->energy_lost;
    sum->transfer_dissipation = one->transfer_dissipation;
    sum->plastic_work = one->plastic_work;
    sum->step_work = one->step_work;
    sum->damping_work = one->damping_work;
    sum->friction_work = one->friction_work;
    sum->fracture_work = one->fracture_work;
    sum->side_work = one->side_work;
}

void tobi_step_sum_up(tobi_world *w)
{
    tobi_step_info *sum = &w->sim.info;
    *sum = w->system[0].info;
    for (int k = 1; k < w->system_count; k++) {
        add_info(sum, &w->system[k].info);
        if (w->system[k].solid_count) add_solid_info(sum, &w->system[k].info);
    }
    sum->step = w->sim.step;
    sum->time = w->sim.time;
    sum->dt = w->sim.dt;
}

tobi_status tobi_step_take(tobi_world *w, double max_dt, tobi_error *err)
{
    const double before = w->sim.dt;
    int64_t substeps[TOBI_SYSTEM_LIMIT];
    TOBI_TRY(tobi_simulation_heed(&w->sim, err));
    tobi_world_cap_step(w);
    TOBI_TRY(remember(w, err));
    choose_dt(w, max_dt, substeps);
    TOBI_TRY(predict_bodies(&w->sim, err));
    tobi_status status = step_systems(w, substeps, err);
    if (status == TOBI_STOPPED) take_back(w, before);
    TOBI_TRY(status);
    TOBI_TRY(move_bodies(w, err));
    w->sim.time += w->sim.dt;
    w->sim.step++;
    return tobi_world_kick_bodies(w, err);
}
