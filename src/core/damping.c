/* Damping zones: a rate on velocities that grows with the square of the way into the zone, implicit in time
   (as the sponge layers of Altomare et al., Coastal Engineering 127 (2017) 37). Drawback: a current would be
   damped like a wave. */
#include "core/damping.h"
#include "core/system.h"
#include "geom/vec3.h"
#include <math.h>

static void damp_range(const void *view, int64_t begin, int64_t end, double *totals)
{
    const tobi_system *s = view;
    const int dimension = s->box.dimension;
    (void)totals;
    for (int64_t i = begin; i < end; i++) {
        const double *x = &s->particles.position[i].x;
        float *u = &s->particles.velocity[i].x;
        for (int k = 0; k < s->sim->damping_count; k++) {
            const tobi_damping *z = &s->sim->damping[k];
            double along = -z->begin;
            int inside = 1;
            for (int a = 0; a < dimension; a++) {
                inside &= x[a] >= z->lower[a] && x[a] <= z->upper[a];
                along += x[a]*z->direction[a];
            }
            if (!inside) continue;
            const double f = fmin(fmax(along/z->length, 0), 1);
            const float keep = (float)(1/(1 + s->dt*z->rate*f*f));
            for (int a = 0; a < dimension; a++) u[a] *= keep;
        }
    }
}

void tobi_damping_apply(tobi_system *s)
{
    if (s->sim->damping_count > 0)
        tobi_launch(&s->sim->exec, TOBI_HOST(damp_range, 0, 0), s, 0, s->particles.count, NULL);
}
