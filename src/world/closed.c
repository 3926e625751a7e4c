/* Whether a world can gain energy after its start. Drawback: a world that anything drives counts as open,
   however little that gives. */
#include "core/rigid.h"
#include "world/energies.h"
#include "world/world.h"
#include <math.h>

/* A joint with a spring begins at the angle or place where the spring rests. */
static int gives_energy(const tobi_body *b)
{
    const tobi_rigid *r = &b->rigid;
    double given = 0;
    for (int a = 0; a < 3; a++) given += fabs(r->force[a]) + fabs(r->torque[a]);
    return b->motion || b->absent[1] > 0 || r->control || given > 0;
}

static int has_tension(const tobi_system *s)
{
    double sum = 0;
    for (int k = 0; k < s->fluid_count; k++) {
        sum += s->fluid[k].tension;
        for (int n = 0; n < s->fluid_count; n++) sum += s->fluid[k].interface_tension[n];
    }
    return sum > 0;
}

/* Gravity upwards would make energies negative; round a periodic domain what falls falls for ever. */
static int falls_to_floor(const tobi_world_def *d)
{
    for (int a = 0; a < d->dimension; a++)
        if (d->gravity[a] > 0 || (d->gravity[a] < 0 && d->wall_min[a] == TOBI_WALL_PERIODIC)) return 0;
    return 1;
}

/* Lines may begin taut, springs of joints between bodies beside their rest. */
static int is_closed(const tobi_world *w)
{
    const tobi_simulation *s = &w->sim;
    if (w->drive || s->opening_count || w->line_count || s->constraints.count || w->motor_count) return 0;
    if (s->wall_speed > 0) return 0;
    for (int k = 0; k < s->body_count; k++)
        if (gives_energy(&s->bodies[k])) return 0;
    for (int k = 0; k < w->system_count; k++)
        if (has_tension(&w->system[k])) return 0;
    return falls_to_floor(&s->def);
}

int tobi_world_closed(const tobi_world *w, double *bodies)
{
    tobi_energy e;
    if (!w || !is_closed(w)) return 0;
    tobi_energy_sum_bodies(w, &e);
    if (bodies) *bodies = e.kinetic + e.potential;
    return 1;
}
