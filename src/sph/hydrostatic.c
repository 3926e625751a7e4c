/* Pressure that no solve knows: of still water below its level, and of vessels without a free surface, where
   gravity along axes with walls makes nothing else. It is taken from what the particles feel (s->gravity),
   which pressures that pull would have to hold, and added exactly where pressures and forces leave. Of
   several fluids it is that of the first, of still water that of the lightest, and the others feel the rest.
   Drawback: the rest of a heavier fluid's weight is left to the particles. */
#include "sph/hydrostatic.h"
#include "geom/vec3.h"
#include "sph/state.h"

void sph_remove_gravity(tobi_system *s)
{
    for (int a = 0; a < 3; a++)
        if (!s->box.periodic[a]) s->gravity[a] = 0;
}

void sph_gravity_at(const tobi_system *s, const double x[3], int fluid, double gravity[3])
{
    const tobi_reference *w = &sph_of(s)->reference;
    const double held = tobi_reference_share(w, x)*w->push/s->fluid[fluid].density;
    const double rest = 1 - s->fluid[0].density/s->fluid[fluid].density;     /* as sph_add_buoyancy */
    for (int a = 0; a < 3; a++) gravity[a] = s->gravity[a] - held*w->down[a];
    for (int a = 0; a < s->box.dimension && rest != 0; a++)
        gravity[a] += rest*(s->sim->def.gravity[a] - s->gravity[a]);
    if (!s->sim->acceleration.acts) return;
    double more[3];
    tobi_acceleration_at(&s->sim->acceleration, x, more);
    for (int a = 0; a < 3; a++) gravity[a] += more[a];
}

double sph_hydrostatic(const tobi_system *s, const double x[3])
{
    double sum = 0;
    for (int a = 0; a < s->box.dimension; a++)
        sum += (s->sim->def.gravity[a] - s->gravity[a])*(x[a] - 0.5*s->box.size[a]);
    return (sum == 0 ? 0 : s->fluid[0].density*sum) + tobi_reference_pressure(&sph_of(s)->reference, x) -
           s->sim->nest.lift;
}

double sph_still_pressure(const tobi_system *s, const tobi_body *b, int64_t point, const double *x)
{
    const tobi_reference *w = &sph_of(s)->reference;
    const double still = tobi_reference_pressure(w, x);
    if (b->wet[point] == TOBI_DRY || b->wet[point] == TOBI_BURIED || !(w->push > 0)) return 0;
    if (b->wet[point] == TOBI_WET) return still;
    const double deep = tobi_reference_depth(w, x) - sph_of(s)->middle + 0.5*s->smoothing.spacing;
    const double all = w->push*fmax(deep, 0);
    return still + fmax(1 - b->covered[point]/TOBI_COVERED, 0)*(all - still);
}

/* Force and torque of still water on a body, where it is wet. *shape (or NULL): W, by a change of shape. */
static void sum_reference(const tobi_system *s, const tobi_body *b, double f[6], double *shape)
{
    for (int64_t k = 0; k < b->point_count; k++) {
        if (!b->wet[k]) continue;
        double p = -b->area[k]*sph_still_pressure(s, b, k, b->point[k]), arm[3], flow[3];
        const double *n = b->normal[k];
        for (int a = 0; a < 3; a++) arm[a] = b->point[k][a] + b->lower[a] - b->centre[a];
        for (int a = 0; a < 3; a++) {
            int q = (a + 1)%3, r = (a + 2)%3;
            f[a] += p*n[a];
            f[3 + a] += p*(arm[q]*n[r] - arm[r]*n[q]);
        }
        if (!shape || !b->deforms) continue;
        tobi_body_point_flow(b, k, flow);
        *shape += p*vec3_dot(n, flow);
    }
}

/* The walls take what is left of the weight that still water holds. */
static void add_reference(tobi_system *s)
{
    sph_state *state = sph_of(s);
    const double held = state->reference.push*state->reference_volume;
    for (int a = 0; a < 3; a++) s->info.wall_force[a] += state->reference.down[a]*held;
    for (int k = 0; k < s->sim->body_count; k++) {
        double f[6] = {0};
        tobi_body_load *load = &s->sim->bodies[k].load[s->number];
        sum_reference(s, &s->sim->bodies[k], f, &load->shape);
        for (int a = 0; a < 6; a++) load->pressure[a] += f[a];
        for (int a = 0; a < 3; a++) s->info.wall_force[a] -= f[a];
    }
}

/* Adds a force along one axis that is the same in each part of the volume. */
static void add_uniform(const tobi_body *b, int axis, double force, double f[6])
{
    double arm[3] = { 0 };
    for (int k = 0; k < 3; k++) vec3_add_scaled(arm, arm, b->middle[k], b->frame[k]);
    f[axis] += force;
    f[3 + (axis + 1)%3] += force*arm[(axis + 2)%3];
    f[3 + (axis + 2)%3] -= force*arm[(axis + 1)%3];
}

void sph_add_hydrostatic(tobi_system *s)
{
    double held = s->smoothing.volume*(double)s->particles.count, solids[3];
    sph_soft_still_sum(s, solids);
    for (int a = 0; a < 3; a++) s->info.wall_force[a] -= solids[a];
    if (sph_of(s)->reference.push > 0) add_reference(s);
    for (int a = 0; a < s->box.dimension; a++) {
        double push = s->fluid[0].density*(s->sim->def.gravity[a] - s->gravity[a]);
        if (push == 0) continue;
        for (int k = 0; k < s->sim->body_count; k++) {
            tobi_body *b = &s->sim->bodies[k];
            if (b->is_absent) continue;
            add_uniform(b, a, -push*b->info.volume, b->load[s->number].pressure);
            s->info.wall_force[a] += push*b->info.volume;
        }
        s->info.wall_force[a] += push*held;
    }
}

void sph_body_hydrostatic(const tobi_system *s, int body, double f[6])
{
    for (int a = 0; a < s->box.dimension; a++) {
        double push = s->sim->def.gravity[a] - s->gravity[a];
        const tobi_body *b = &s->sim->bodies[body];
        if (push != 0) add_uniform(b, a, -s->fluid[0].density*push*b->info.volume, f);
    }
    if (sph_of(s)->reference.push > 0) sum_reference(s, &s->sim->bodies[body], f, NULL);
}
