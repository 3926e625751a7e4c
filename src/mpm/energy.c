/* Sums of the energy that solids have, lose and are given. They lie with what a restart needs (mpm_memory);
   what damping, sides and contacts take is added to them where it is taken, in mlsmpm.c. */
#include "mpm/energy.h"
#include "mpm/damage.h"
#include "mpm/fields.h"

/* totals: elastic energy, kinetic, potential; spent on cracks. */
static void sum_energy(const void *view, int64_t begin, int64_t end, double *totals)
{
    const mpm_view *v = view;
    for (int64_t i = begin; i < end; i++) {
        const double mass = v->strain[i].c[2].w;
        totals[0] += mpm_sample_particle(v, i).energy;
        totals[1] += mpm_kinetic(v, i);
        totals[3] += mpm_damage_spent(v, i);
        for (int a = 0; a < 3; a++) totals[2] -= mass*v->gravity[a]*(&v->position[i].x)[a];
    }
}

/* The energy of all solids, J; t as in sum_energy. */
static double find_energy(tobi_system *s, const mlsmpm *m, double t[TOBI_TOTALS])
{
    const mpm_view v = mpm_output_view(m);
    tobi_launch(&s->sim->exec, TOBI_HOST(sum_energy, 4, 0), &v, 0, s->particles.count, t);
    return t[0] + t[1] + t[2];
}

double mpm_energy_find(tobi_system *s, const mlsmpm *m)
{
    double t[TOBI_TOTALS];
    return find_energy(s, m, t);
}

void mpm_energy_start(tobi_system *s, mlsmpm *m) { m->memory.start_energy = mpm_energy_find(s, m); }

void mpm_energy_drop(mlsmpm *m, const mpm_view *v, int64_t i)
{
    double t[4] = {0, 0, 0, 0};
    sum_energy(v, i, i + 1, t);
    m->memory.start_energy -= t[0] + t[1] + t[2];
    m->memory.steps -= t[0] + t[3];
    m->memory.fracture += t[3];
    m->memory.node_energy -= t[1];
}

void mpm_energy_add_transfer(tobi_system *s, mlsmpm *m)
{
    double came[TOBI_TOTALS], arrived[TOBI_TOTALS];
    if (!m->def.measure_transfer) return;
    tobi_launch_each(&s->sim->exec, m->kernels->scatter_unstressed, &m->view, m->grid.block_count, came);
    tobi_launch_each(&s->sim->exec, m->kernels->energy_unstressed, &m->view, mpm_count_patches(m), arrived);
    if (s->step > 0) m->memory.transfer += m->memory.node_energy - came[0];
    m->memory.transfer += came[1] - arrived[0];
}

void mpm_energy_add_nodes(tobi_system *s, mlsmpm *m)
{
    double t[TOBI_TOTALS];
    if (!m->def.measure_transfer) return;
    tobi_launch_each(&s->sim->exec, m->kernels->energy_nodes, &m->view, mpm_count_patches(m), t);
    m->memory.node_energy = t[0];
    m->memory.steps += t[1];
}

void mpm_energy_add_flow(tobi_system *s, mlsmpm *m)
{
    const mpm_view v = mpm_output_view(m);
    double t[TOBI_TOTALS];
    if (!m->def.measure_transfer) return;
    tobi_launch(&s->sim->exec, TOBI_HOST(mpm_sum_flow, 1, 0), &v, 0, s->particles.count, t);
    m->memory.flow += t[0];
}

void mpm_energy_report(tobi_system *s)
{
    const mlsmpm *m = s->state;
    double t[TOBI_TOTALS], energy = find_energy(s, m, t);
    s->info.elastic_energy = t[0];
    s->info.energy_lost = m->memory.age < 0 ? 0 : m->memory.start_energy + m->memory.body_work - energy;
    s->info.work_bodies = m->memory.body_work;
    s->info.fracture_work = m->memory.fracture + t[3];
    s->info.friction_work = m->memory.friction;
    s->info.damping_work = m->memory.damping;
    s->info.side_work = m->memory.sides;
    s->info.plastic_work = m->memory.flow;
    if (!m->def.measure_transfer || s->step == 0) return;
    s->info.transfer_dissipation = m->memory.transfer + m->memory.node_energy - t[1];
    s->info.step_work = m->memory.steps - m->memory.flow - t[0] - t[3];
}
