/* Momenta of solids and bodies together, for tests of what goes between them. */
#pragma once
#include "mpm/particle_fields.h"
#include "world/world.h"
#include <string.h>

/* Of bodies and particles, N s and N m s about the origin of the system; 2-D per metre. */
static inline void find_momenta(tobi_world *world, double momentum[3], double spin[3])
{
    const tobi_system *s = tobi_world_solids(world);
    const tobi_particles *p = &s->particles;
    const mpm_fields *f = mpm_fields_of(p);
    const double cell = 2*s->smoothing.spacing;
    memset(momentum, 0, 3*sizeof *momentum);
    memset(spin, 0, 3*sizeof *spin);
    for (int64_t i = 0; i < p->count; i++) {
        const double m = mpm_mass(s, i), *x = &p->position[i].x;
        const float *v = &p->velocity[i].x;
        for (int a = 0; a < 3; a++) {
            const int b = (a + 1)%3, c = (a + 2)%3;
            momentum[a] += m*v[a];
            const float *along = &f->affine[i].c[b].x, *across = &f->affine[i].c[c].x;
            spin[a] += m*(x[b]*v[c] - x[c]*v[b] + 0.25*cell*cell*(along[c] - across[b]));
        }
    }
    for (int k = 0; k < world->sim.body_count; k++) {
        const tobi_rigid *r = &world->sim.bodies[k].rigid;
        const double *x = r->position, *v = r->velocity;
        for (int a = 0; a < 3; a++) {
            const int b = (a + 1)%3, c = (a + 2)%3;
            momentum[a] += r->mass*v[a];
            spin[a] += r->mass*(x[b]*v[c] - x[c]*v[b]) + r->momentum[a];
        }
    }
}
