/* The weakly compressible pressure, with the operators of pressure.k.h: C u, eq. (7), and a(p), eq. (8).
   Equation numbers above 20: docs/theory/wcsph.md. */
#pragma once
#include "sph/pressure.k.h"

/* Water at rest from the first step on, eq. (21c); payload = that pressure. */
TOBI_FN void sph_rest(const sph_view *v, int64_t i, double *totals)
{
    const tobi_reference *w = &v->reference;
    const double *x = &v->position[i].x;
    double depth = tobi_reference_depth(w, x) - w->level;
    (void)totals;
    v->pressure[i] = depth > 0 ? (float)(w->push*depth - tobi_reference_pressure(w, x)) : 0;
    v->record[i].w = v->pressure[i];
}

/* What the reference gains as its level moves and the particle sinks in it is no compression: the pressure
   beside it loses that, eq. (21b); one that is given has none of it. */
TOBI_FN void sph_carry(const sph_view *v, int64_t i, double *totals)
{
    const tobi_reference *w = &v->reference;
    const double *x = &v->position[i].x;
    tobi_float4 u = v->velocity[i];
    double held = w->push*tobi_reference_share(w, x), sink = 0, rho = 1/v->inverse_density[v->fluid[i]];
    (void)totals;
    for (int c = 0; c < 3; c++) sink += (held*w->down[c] + rho*v->removed_gravity[c])*(&u.x)[c];
    double rise = tobi_reference_pressure(w, x) - tobi_reference_pressure(&v->reference_before, x);
    if (!sph_held(v, i)) v->pressure[i] -= (float)(rise + v->dt*sink);
}

/* What draws the pressure to that of the density, over dp/dt, eq. (21d). */
TOBI_FN float sph_recovery(const sph_view *v, int64_t i)
{
    if (!(v->recovery > 0)) return 0;
    float asked = (v->pressure[i] - v->recovery_pressure)/(v->exponent*v->stiffness);
    return v->recovery*(sph_density_error(v, i) - asked);
}

/* dp/dt = exponent (p + B) C v, eq. (21), which is the Tait equation carried along with the particle.
   The payload of the pressure force adds the damping of sound, eq. (22). A free surface does not pull.
   totals: |C v|, |p|; maximum: |C v|. */
#define sph_tait_acc sph_compression_acc
TOBI_FN void sph_tait_start(const sph_view *v, int64_t i, sph_compression_acc *a)
{
    sph_compression_start(v, i, a, v->velocity);
}
TOBI_FN void sph_tait_pair(const sph_view *v, int64_t i, const tobi_neighbors *n, sph_compression_acc *a,
                           const int shape)
{
    (void)i;
    sph_compression_pair(v, n, a, v->velocity, shape);
}
TOBI_FN void sph_tait_finish(const sph_view *v, int64_t i, sph_compression_acc *a, double *totals)
{
    float rate = sph_compression_value(v, i, a, v->velocity, 1), size = fabsf(rate);
    float change = v->dt*v->exponent*(v->pressure[i] + v->stiffness);
    float p = v->pressure[i] + change*(rate + sph_recovery(v, i));
    float push = p + v->damping*rate;
    if (v->diagonal[i] <= v->isolated) p = push = 0;
    if (sph_held(v, i)) p = push = v->pressure[i];
    float least = sph_floor(v, i);
    if (v->surface[i] && p < least) p = least;
    if (v->surface[i] && push < least) push = least;
    v->pressure[i] = p;
    v->damped[i] = push;
    v->record[i].w = push;
    totals[0] += size;
    totals[1] += fabsf(p);
    totals[6] = size > totals[6] ? size : totals[6];
}

/* Payload = the potential of the shift, eq. (23); what is carried has none. */
TOBI_FN void sph_relax(const sph_view *v, int64_t i, double *totals)
{
    (void)totals;
    v->record[i].w = sph_carried(v, i) ? 0 : sph_relax_value(v, i);
}
