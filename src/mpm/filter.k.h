/* What only some runs need: the filter of XPIC, and measuring what transfers cost. */
#pragma once
#include "mpm/gather.k.h"

/* XPIC, eq. (16): the velocity `wave` goes to the particles and back to the tiles, */
TOBI_FN void mpm_filter(const mpm_view *v, int64_t number, double *totals, const int dim)
{
    const mpm_block *b = &v->block[number];
    tobi_float4 tile[MPM_VELOCITIES*(MPM_TILE_3D + 8)], *unstressed[MPM_VELOCITIES];
    const quad zero[3] = {quad_set(0), quad_set(0), quad_set(0)};
    const tobi_float4 frame = v->reach[number].frame;
    row g[9];
    (void)totals;
    for (int r = 0; r < 9; r++) g[r] = row_set(0);
    mpm_clear_tiles(b, v->unstressed, number, unstressed, dim);
    mpm_copy_tiles(v, number, v->wave, quad_load(&frame), tile, dim);
    for (int64_t i = b->begin; i < b->end; i += MPM_WIDE) {
        const int count = b->end - i < MPM_WIDE ? (int)(b->end - i) : MPM_WIDE;
        mpm_stencil s;
        mpm_find_stencil(v, b, i, dim, &s);
        for (int k = 0; k < count; k++) {
            const mpm_hidden hidden = mpm_read_hidden(v, i + k, b->levels);
            quad u, mass = quad_set(v->strain[i + k].c[2].w);
            if (mpm_is_hidden(&hidden)) mpm_load_split(tile, b->levels, s.first[k], &hidden, g, dim);
            else mpm_load_rows(tile, s.first[k], g, dim);
            u = row_first(mpm_interpolate(g, &s, k, dim));
            u[3] = 1;
            if (mpm_is_hidden(&hidden))
                mpm_add_split(unstressed, b->levels, &s, k, &hidden, u*mass, zero, dim);
            else mpm_add_unstressed(unstressed[0], &s, k, u*mass, dim);
        }
    }
}

/* and from there to the nodes; `old` takes its share. */
TOBI_FN void mpm_filter_nodes(const mpm_view *v, int64_t number, double *totals, const int dim)
{
    const int nodes = dim == 3 ? MPM_NODES_3D : MPM_NODES_2D;
    quad sum[MPM_NODES_3D], frame;
    (void)totals;
    mpm_sum_tiles(v, &v->patch[number], v->unstressed, sum, &frame, dim);
    for (int n = 0; n < nodes; n++) {
        const float mass = sum[n][3];
        const int64_t at = number*nodes + n;
        quad u = sum[n]*quad_set(mass > 0 ? 1/mass : 0) + (mass > 0 ? frame : quad_set(0));
        quad_store(&v->wave[at], u);
        quad_store(&v->old[at], quad_load(&v->old[at]) - u*quad_set(v->order));
    }
}

/* For measuring what transfers cost: momentum with APIC's affine part, without stress, into the
   unstressed tile. totals: kinetic energy of the particles, 0 as they came and 1 after damping. */
TOBI_FN void mpm_scatter_unstressed(const mpm_view *v, int64_t number, double *totals, const int dim)
{
    const mpm_block *b = &v->block[number];
    const quad frame = quad_load(&v->reach[number].frame);
    tobi_float4 *unstressed[MPM_VELOCITIES];
    mpm_clear_tiles(b, v->unstressed, number, unstressed, dim);
    for (int64_t i = b->begin; i < b->end; i += MPM_WIDE) {
        const int count = b->end - i < MPM_WIDE ? (int)(b->end - i) : MPM_WIDE;
        mpm_stencil s;
        mpm_find_stencil(v, b, i, dim, &s);
        for (int k = 0; k < count; k++) {
            const float mass = v->strain[i + k].c[2].w, keep = v->material[v->solid[i + k]].keep;
            double square = 0;
            for (int n = 0; n < 9*v->affine_momentum; n++) {
                double c = (&v->affine[i + k].c[n/3].x)[n%3];
                square += 0.25*(double)v->cell*v->cell*c*c;
            }
            for (int a = 0; a < 3; a++) {
                double u = (&v->velocity[i + k].x)[a];
                square += u*u;
            }
            totals[0] += 0.5*mass*square;
            totals[1] += 0.5*mass*keep*keep*square;
            const quad moving = quad_set(mass*keep), cell = quad_set(v->affine_momentum ? v->cell : 0);
            quad base = quad_load(&v->velocity[i + k])*moving - frame*quad_set(mass), column[3];
            base[3] = mass;
            for (int c = 0; c < 3; c++) {
                column[c] = quad_load(&v->affine[i + k].c[c])*cell*moving;
                column[c][3] = 0;
                if (c < dim) base = base - column[c]*quad_set(s.offset[c][k]);
            }
            const mpm_hidden hidden = mpm_read_hidden(v, i + k, b->levels);
            mpm_add_split(unstressed, b->levels, &s, k, &hidden, base, column, dim);
        }
    }
}

/* Kinetic energy of a block of nodes into totals[0]: of the unstressed tiles, */
TOBI_FN void mpm_energy_unstressed(const mpm_view *v, int64_t number, double *totals, const int dim)
{
    quad sum[MPM_NODES_3D], frame;
    mpm_sum_tiles(v, &v->patch[number], v->unstressed, sum, &frame, dim);
    for (int n = 0; n < (dim == 3 ? MPM_NODES_3D : MPM_NODES_2D); n++) {
        quad square = sum[n] + quad_set(sum[n][3])*frame;
        square = square*square;
        if (sum[n][3] > 0) totals[0] += 0.5*(double)(square[0] + square[1] + square[2])/sum[n][3];
    }
}

/* and of the nodes as they are. totals[1]: the sums of eq. (23). */
TOBI_FN void mpm_energy_nodes(const mpm_view *v, int64_t number, double *totals, const int dim)
{
    const int nodes = dim == 3 ? MPM_NODES_3D : MPM_NODES_2D;
    quad pushed[MPM_NODES_3D], unstressed[MPM_NODES_3D], frame;
    mpm_sum_tiles(v, &v->patch[number], v->tile, pushed, &frame, dim);
    mpm_sum_tiles(v, &v->patch[number], v->unstressed, unstressed, &frame, dim);
    for (int n = 0; n < nodes; n++) {
        quad u = quad_load(&v->node[number*nodes + n]), square = u*u;
        if (!(u[3] > 0)) continue;
        quad change = u - frame - unstressed[n]*quad_set(1/u[3]), stress = u*(pushed[n] - unstressed[n]);
        totals[0] += 0.5*(double)(square[0] + square[1] + square[2])*u[3];
        square = change*change;
        totals[1] += 0.5*(double)(square[0] + square[1] + square[2])*u[3];
        totals[1] -= (double)stress[0] + stress[1] + stress[2];
    }
}
