/* Several fluids: launches of phases.k.h (decision 70). All sums of the SPH methods are over volumes, so that
   fluids share them; what fluids do to each other beyond that stands here. Drawback: the viscosity of pairs
   and the curvature take six passes over the neighbours of all, though few are near an interface. */
#include "sph/phases.h"
#include "sph/fields.h"
#include <math.h>

static void launch(tobi_system *s, sph_view *v, tobi_kernel k)
{
    tobi_launch(&s->sim->exec, k, v, 0, s->particles.count, NULL);
}

int sph_phases_have_tension(const tobi_system *s)
{
    for (int a = 0; a < s->fluid_count; a++)
        for (int b = 0; b < a; b++)
            if (s->fluid[a].interface_tension[b] > 0) return 1;
    return 0;
}

void sph_phases_bind(const tobi_system *s, sph_view *v)
{
    const sph_fields *f = sph_fields_of(&s->particles);
    v->phase = f->phase;
    v->interface = f->interface;
    v->fluid_count = s->fluid_count;
    for (int a = 0; a < s->fluid_count; a++)
        for (int b = 0; b < s->fluid_count; b++)
            v->interface_tension[a][b] = (float)s->fluid[a].interface_tension[b];
}

void sph_phases_find(tobi_system *s, sph_view *v, const sph_kernels *k)
{
    if (!v->phase) return;
    launch(s, v, k->sph_phase_set);
    launch(s, v, k->sph_phase_depth);
    launch(s, v, k->sph_phase_place);
    if (!sph_phases_have_tension(s)) return;
    launch(s, v, k->sph_phase_normal);
    launch(s, v, k->sph_phase_curvature);
    launch(s, v, k->sph_phase_even);
    launch(s, v, k->sph_phase_bend);
}

int sph_phases_differ(const tobi_system *s)
{
    for (int f = 1; f < s->fluid_count; f++)
        if (s->fluid[f].viscosity != s->fluid[0].viscosity) return 1;
    return 0;
}

void sph_phases_set(tobi_system *s, sph_view *v, const sph_kernels *k)
{
    launch(s, v, k->sph_phase_set);
}

void sph_phases_rub(tobi_system *s, sph_view *v, const sph_kernels *k)
{
    if (!v->phase || !sph_phases_differ(s)) return;
    launch(s, v, k->sph_phase_set);
    launch(s, v, k->sph_phase_viscosity);
}

void sph_phases_kick(tobi_system *s, sph_view *v, const sph_kernels *k)
{
    if (v->phase && sph_phases_differ(s)) launch(s, v, k->sph_phase_kick);
}

void sph_phases_pull(tobi_system *s, sph_view *v, const sph_kernels *k)
{
    if (v->phase && sph_phases_have_tension(s)) launch(s, v, k->sph_phase_tension);
}

double sph_phases_dt(const tobi_system *s)
{
    const double d = s->smoothing.spacing;
    double dt = INFINITY;
    for (int a = 0; a < s->fluid_count; a++)
        for (int b = 0; b < a; b++) {
            const double sigma = s->fluid[a].interface_tension[b],
                         rho = 0.5*(s->fluid[a].density + s->fluid[b].density);
            if (sigma > 0) dt = fmin(dt, 0.4*sqrt(rho*d*d*d/(2*acos(-1)*sigma)));
        }
    return dt;
}
