/* Pairs of particles of different fluids in isph: density between them, and the jump of the pressure. The
   pressure equation is div (1/rho grad p), scaled by the density of the first fluid, so that one fluid has
   the entries it always had. Equation numbers: docs/theory/two_liquids.md. */
#pragma once
#include "sph/isph/images.k.h"

typedef struct isph_pair_phase {
    lane face, image;                /* 1: density between the two, and of the way from j to its image, over
                                        that of the first fluid                                             */
    lane jump;                       /* Pa: pressure of i over that of j by the tension of the interface    */
} isph_pair_phase;

/* Densities lie in series along the way from i to j, eq. (51): the interface parts it by the distances of
   both from it. Behind sides there is more of j. Surfaces of bodies may lie across layers: images there
   continue what is between the two, so that layers at rest are exact. */
TOBI_FN isph_pair_phase isph_see_phase(const isph_view *v, int64_t i, const tobi_neighbors *n, const int kind)
{
    const tobi_float4 own = v->phase[i];
    const float scale = (float)(1/v->density);
    lane rho, mu, depth, id;
    lane_load_float4(v->phase, n->j, &rho, &mu, &depth, &id);
    isph_pair_phase p;
    p.face = (rho + (own.x - rho)*(own.z/(own.z + depth)))*scale;
    p.image = kind == ISPH_BODY ? p.face : rho*scale;
    p.jump = lane_set(0);
    if (!v->interface_tension) return p;
    const float *row = v->interface_tension[v->fluid[i]];
    const float kappa = v->interface[i].w;
    lane x, y, z, k;
    lane_load_float4(v->interface, n->j, &x, &y, &z, &k);
    for (int f = 0; f < v->fluid_count; f++) {
        const lane apart = id - (float)f, half = lane_set(0.5f*row[f]);
        p.jump += lane_where_less(apart*apart, lane_set(0.25f), half, lane_set(0))*(kappa - k);
    }
    return p;
}

/* Density of i over that of the first fluid. */
TOBI_FN double isph_density_of(const isph_view *v, int64_t i)
{
    return v->phase ? v->phase[i].x/v->density : 1;
}
