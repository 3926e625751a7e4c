/* Pairs of particles in porous zones in isph: drag along the way from one to the other lies in series, as the
   density of several fluids does. Equation numbers: docs/theory/porous.md. */
#pragma once
#include "sph/isph/images.k.h"
#include "sph/porous.k.h"

/* Least share of the pair's Laplacian where the drag differs by direction: below 0 the matrix would have no
   solution by conjugate gradients. */
#define ISPH_POROUS_LEAST 0.25f

typedef struct isph_pair_porous {
    lane part[3];                    /* m: c P d, of the mean of both, d the way from j to i                */
    lane inverse;                    /* 1/(1 + c)                                                           */
    lane share;                      /* 1: of the pair in div(M grad p), eq. (4)                            */
} isph_pair_porous;

/* Adds c P d of one particle, and what it makes of the pair. */
TOBI_FN void isph_add_porous(const isph_view *v, const tobi_neighbors *n, lane x, lane y, lane z, lane w,
                             lane part[3], lane *drag, lane *row)
{
    const lane zero = lane_set(0), s2 = x*x + y*y + z*z, along = x*n->dx + y*n->dy + z*n->dz,
               sign = lane_where_less(zero, w, lane_set(-1), lane_set(1)),
               line = 0.5f*((float)(v->dimension + 2)*along*along/(n->r2 + 1e-30f) - s2);
    part[0] += 0.5f*(w*n->dx + sign*along*x);
    part[1] += 0.5f*(w*n->dy + sign*along*y);
    part[2] += 0.5f*(w*n->dz + sign*along*z);
    *drag += 0.5f*lane_where_less(zero, w, w, s2);
    *row += 0.5f*(w + sign*line);
}

TOBI_FN isph_pair_porous isph_see_porous(const isph_view *v, int64_t i, const tobi_neighbors *n)
{
    const tobi_float4 own = v->porous[i];
    isph_pair_porous p = {{lane_set(0), lane_set(0), lane_set(0)}, lane_set(0), lane_set(0)};
    lane x, y, z, w, drag = lane_set(0), row = lane_set(0);
    lane_load_float4(v->porous, n->j, &x, &y, &z, &w);
    isph_add_porous(v, n, lane_set(own.x), lane_set(own.y), lane_set(own.z), lane_set(own.w), p.part, &drag,
                    &row);
    isph_add_porous(v, n, x, y, z, w, p.part, &drag, &row);
    p.inverse = 1/(1 + drag);
    p.share = p.inverse*(ISPH_POROUS_LEAST + lane_positive(1 + drag - row - ISPH_POROUS_LEAST));
    return p;
}

/* Adds to out the part of x, the same for all pairs, that the drag of each takes, times weight. */
TOBI_FN void isph_add_taken(const isph_view *v, int64_t i, const tobi_neighbors *n, lane inverse, lane weight,
                            const float x[3], lane out[3])
{
    const tobi_float4 own = v->porous[i];
    const lane zero = lane_set(0), k = 0.5f*weight*inverse;
    float part[3];
    lane s[3], w;
    sph_porous_part(own, x, part);
    lane_load_float4(v->porous, n->j, &s[0], &s[1], &s[2], &w);
    const lane sign = lane_where_less(zero, w, lane_set(-1), lane_set(1)),
               along = sign*(s[0]*x[0] + s[1]*x[1] + s[2]*x[2]);
    for (int c = 0; c < 3; c++) out[c] += k*(w*x[c] + along*s[c] + part[c]);
}

/* Along the lack of neighbours at a free surface: sums over pairs, which have as much drag as what is missing
   opposite. */
typedef struct isph_lack_porous { lane all, open, taken[3]; } isph_lack_porous;

TOBI_FN void isph_begin_lack(isph_lack_porous *l)
{
    l->all = l->open = l->taken[0] = l->taken[1] = l->taken[2] = lane_set(0);
}

TOBI_FN void isph_add_lack(isph_lack_porous *l, lane weight, lane share)
{
    l->all += weight;
    l->open += weight*share;
}

/* 1: what is open of it; of none that of the particle. */
TOBI_FN double isph_open(const isph_view *v, int64_t i, const isph_lack_porous *l)
{
    const double all = v->porous ? lane_sum(l->all) : 0, open = v->porous ? lane_sum(l->open) : 0;
    if (!v->porous) return 1;
    if (!(all > 0 && open > 0)) return sph_porous_mean(v->porous[i], v->dimension);
    return open < all ? open/all : 1;
}
