/* What every method does to its particles. */
#include "core/system.h"
#include <math.h>
#include <string.h>

/* totals: kinetic, potential, momentum x y z, mass. Potential against the box's lower corner. */
static void measure_range(const void *view, int64_t begin, int64_t end, double *t)
{
    const tobi_system *s = view;
    for (int64_t i = begin; i < end; i++) {
        double m = s->particles.strain ? s->particles.strain[i].c[2].w
                                       : s->smoothing.volume*s->fluid[s->particles.fluid[i]].density;
        tobi_float4 v = s->particles.velocity[i];
        const double *x = &s->particles.position[i].x;
        t[0] += 0.5*m*((double)v.x*v.x + (double)v.y*v.y + (double)v.z*v.z);
        for (int a = 0; a < s->box.dimension; a++) t[1] -= m*s->sim->def.gravity[a]*x[a];
        t[2] += m*v.x; t[3] += m*v.y; t[4] += m*v.z;
        t[5] += m;
    }
}

void tobi_system_measure(tobi_system *s)
{
    double t[TOBI_TOTALS], g2 = 0;
    tobi_launch(&s->sim->exec, measure_range, s, 0, s->particles.count, t);
    for (int a = 0; a < s->box.dimension; a++) g2 += s->sim->def.gravity[a]*s->sim->def.gravity[a];
    s->info.kinetic_energy = t[0];
    s->info.potential_energy = t[1];
    for (int a = 0; a < 3; a++) s->info.momentum[a] = t[2 + a];
    s->info.weight = t[5]*sqrt(g2);
}

void tobi_system_fill_up(tobi_system *s)
{
    for (int a = 0; a < 3; a++)
        if (!s->box.periodic[a]) s->gravity[a] = 0;
}

double tobi_system_hydrostatic(const tobi_system *s, const double x[3])
{
    double sum = 0;
    for (int a = 0; a < s->box.dimension; a++)
        sum += (s->sim->def.gravity[a] - s->gravity[a])*(x[a] - 0.5*s->box.size[a]);
    return (sum == 0 ? 0 : s->fluid[0].density*sum) + tobi_still_pressure(&s->still, x);
}

/* Where particles do not fit in, nothing but still water presses: all of it. */
static double still_pressure(const tobi_still *w, const double *x, int wet)
{
    if (wet != TOBI_WET_GAP) return tobi_still_pressure(w, x);
    return w->push*fmax(tobi_still_drop(w, x) - w->level, 0);
}

/* Force and torque of still water on a body, where it is wet. */
static void sum_still(const tobi_system *s, const tobi_body *b, double f[6])
{
    for (int64_t k = 0; k < b->point_count; k++) {
        if (!b->wet[k]) continue;
        double p = -b->area[k]*still_pressure(&s->still, b->point[k], b->wet[k]), arm[3];
        const double *n = b->normal[k];
        for (int a = 0; a < 3; a++) arm[a] = b->point[k][a] + b->lower[a] - b->centre[a];
        for (int a = 0; a < 3; a++) {
            int q = (a + 1)%3, r = (a + 2)%3;
            f[a] += p*n[a];
            f[3 + a] += p*(arm[q]*n[r] - arm[r]*n[q]);
        }
    }
}

/* The walls take what is left of the weight that still water holds. */
static void add_still(tobi_system *s)
{
    for (int a = 0; a < 3; a++) s->info.wall_force[a] += s->still.down[a]*s->still.push*s->still_volume;
    for (int k = 0; k < s->sim->body_count; k++) {
        double f[6] = {0};
        sum_still(s, &s->sim->bodies[k], f);
        for (int a = 0; a < 6; a++) s->sim->bodies[k].load[s->number].pressure[a] += f[a];
        for (int a = 0; a < 3; a++) s->info.wall_force[a] -= f[a];
    }
}

void tobi_system_add_hydrostatic(tobi_system *s)
{
    double held = s->smoothing.volume*(double)s->particles.count;
    if (s->still.push > 0) add_still(s);
    for (int a = 0; a < s->box.dimension; a++) {
        double push = s->fluid[0].density*(s->sim->def.gravity[a] - s->gravity[a]);
        if (push == 0) continue;
        for (int k = 0; k < s->sim->body_count; k++) {
            s->sim->bodies[k].load[s->number].pressure[a] -= push*s->sim->bodies[k].info.volume;
            s->info.wall_force[a] += push*s->sim->bodies[k].info.volume;
        }
        s->info.wall_force[a] += push*held;
    }
}

void tobi_system_body_hydrostatic(const tobi_system *s, int body, double f[6])
{
    for (int a = 0; a < s->box.dimension; a++) {
        double push = s->sim->def.gravity[a] - s->gravity[a];
        if (push != 0) f[a] -= s->fluid[0].density*push*s->sim->bodies[body].info.volume;
    }
    if (s->still.push > 0) sum_still(s, &s->sim->bodies[body], f);
}

double tobi_system_speed_scale(const tobi_system *s)
{
    double fall = 0, capillary = 0;
    for (int a = 0; a < s->box.dimension; a++) fall += fabs(s->sim->def.gravity[a])*s->box.size[a];
    for (int f = 0; f < s->fluid_count; f++)
        capillary = fmax(capillary, 8*s->fluid[f].tension/(s->fluid[f].density*s->smoothing.spacing));
    return sqrt(2*fall + capillary) + s->sim->body_speed + 2*s->start_speed;
}
