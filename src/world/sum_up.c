/* What a step tells about the world: the sums of what its systems tell. Drawback: a member that is
   missing here is that of the first system alone. */
#include "world/step.h"
#include <math.h>

static void add_info(tobi_step_info *sum, const tobi_step_info *one)
{
    const double all = (double)(sum->fluid_particles + one->fluid_particles);
    const double share = (double)one->fluid_particles/fmax(all, 1);
    sum->density_converged &= one->density_converged;
    sum->divergence_converged &= one->divergence_converged;
    sum->viscosity_failed |= one->viscosity_failed;
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
    sum->mass_held += one->mass_held;
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
