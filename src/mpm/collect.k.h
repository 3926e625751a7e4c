/* The grid: tiles of blocks become velocities of nodes, which gravity and planes change. */
#pragma once
#include "mpm/scatter.k.h"

/* Coulomb contact of a node with a plane, eq. (13); v becomes the velocity after. */
TOBI_FN void mpm_apply_plane(const mpm_plane *p, float v[3])
{
    float n[3], r[3], along = 0, slide = 0;
    for (int a = 0; a < 3; a++) {
        n[a] = (float)p->normal[a];
        r[a] = v[a] - p->velocity[a];
        along += n[a]*r[a];
    }
    if (p->kind == TOBI_WALL_NO_SLIP) {
        for (int a = 0; a < 3; a++) v[a] = p->velocity[a];
        return;
    }
    if (p->kind == TOBI_WALL_SEPARATE && along >= 0) return;
    for (int a = 0; a < 3; a++) {
        r[a] -= along*n[a];
        slide += r[a]*r[a];
    }
    slide = sqrtf(slide);
    float limit = p->kind == TOBI_WALL_SEPARATE ? -p->friction*along : 0;
    float left = slide > limit ? 1 - limit/(slide + 1e-30f) : 0;
    for (int a = 0; a < 3; a++) v[a] = p->velocity[a] + r[a]*left;
}

/* Rows x 8 + y of a tile that lie in the node blocks before, beside and behind its own along x, and y. */
TOBI_FN uint64_t mpm_rows_at(int x, int y)
{
    const uint64_t along[3] = {UINT64_C(0x0101010000000000), UINT64_C(0x0000000101010100), UINT64_C(1)},
                   across[3] = {UINT64_C(0xe0), UINT64_C(0x1e), UINT64_C(0x01)};
    return along[x]*across[y];
}

/* Sums the tiles over a block of nodes: momentum and mass, in the order of `cover`. Counted from the node -4
   of a block, nodes 4 b .. 4 b + 3 are those of the block at offset b - 1; tiles begin at 3. frame: the
   velocity from which the sums are counted, that of the first tile, eq. (25). 0: there is nothing. */
TOBI_FN int mpm_sum_tiles(const mpm_view *v, const mpm_patch *g, const tobi_float4 *tiles, quad *sum,
                          quad *frame, const int dim)
{
    int any = 0;
    *frame = quad_set(0);
    for (int n = 0; n < (dim == 3 ? MPM_NODES_3D : MPM_NODES_2D); n++) sum[n] = quad_set(0);
    for (int o = 0; o < 27; o++) {
        if (g->cover[o] < 0) continue;
        const int x = o/9, y = o/3%3, z = o%3, count = dim == 2 || z == 2 ? 1 : 3 + z;
        const tobi_float4 *tile = tiles + (int64_t)g->cover[o]*((dim == 3 ? MPM_TILE_3D : MPM_TILE_2D) + 8);
        uint64_t rows = v->reach[g->cover[o]].rows[z] & mpm_rows_at(x, y);
        const quad own = quad_load(&v->reach[g->cover[o]].frame);
        if (rows && !any) *frame = own;
        const quad shift = own - *frame;
        any |= rows != 0;
        for (; rows; rows &= rows - 1) {
            const int row = tobi_lowest_bit(rows), at = 4*((row >> 3) + 4*x - 5) + (row & 7) + 4*y - 5;
            const tobi_float4 *from = dim == 3 ? tile + 8*row + (z == 0 ? 5 : z == 1 ? 1 : 0) : tile + row;
            quad *to = dim == 3 ? sum + 4*at + (z == 2 ? 3 : 0) : sum + at;
            for (int n = 0; n < count; n++) {
                const quad part = quad_load(from + n);
                to[n] = to[n] + (part + quad_set(part[3])*shift);
            }
        }
    }
    return any;
}

/* Planes that node n of a block lies behind change its velocity u. */
TOBI_FN void mpm_apply_planes(const mpm_view *v, const mpm_patch *g, int n, float u[3], int dim)
{
    const int at[3] = {g->corner[0] + (dim == 3 ? n/16 : n/4), g->corner[1] + (dim == 3 ? n/4%4 : n%4),
                       dim == 3 ? g->corner[2] + n%4 : 0};
    for (int p = 0; p < v->plane_count; p++) {
        const mpm_plane *plane = &v->plane[p];
        if (plane->limited && !(g->obey[plane->limited - 1] >> n & 1)) continue;
        double depth = plane->normal[0]*at[0] + plane->normal[1]*at[1] + plane->normal[2]*at[2] -
                       plane->offset*v->inverse_cell;
        if (depth < 1e-6) mpm_apply_plane(plane, u);
    }
}

/* Momentum of a block of nodes becomes velocity, eq. (12), which gravity and planes change.
   totals: 0..2 momentum given to the planes, 3 work done on them. */
TOBI_FN void mpm_collect(const mpm_view *v, int64_t number, double *totals, const int dim)
{
    const mpm_patch *g = &v->patch[number];
    const int nodes = dim == 3 ? MPM_NODES_3D : MPM_NODES_2D;
    const quad fall = {v->fall[0], v->fall[1], v->fall[2], 0};
    tobi_float4 *node = v->node + number*nodes;
    quad sum[MPM_NODES_3D], unstressed[MPM_NODES_3D], given = quad_set(0), frame;
    if (!mpm_sum_tiles(v, g, v->tile, sum, &frame, dim)) {
        mpm_clear(node, nodes);
        if (v->old) mpm_clear(v->old + number*nodes, nodes);
        if (v->wave) mpm_clear(v->wave + number*nodes, nodes);
        return;
    }
    if (v->old) mpm_sum_tiles(v, g, v->unstressed, unstressed, &frame, dim);
    for (int n = 0; n < nodes; n++) {
        const float mass = sum[n][3], divisor = mass > 0 ? mass : INFINITY;
        quad u = sum[n]/quad_set(divisor);
        if (v->old) {
            quad before = unstressed[n]/quad_set(divisor);
            if (mass > 0) before = before + frame;
            if (v->wave) quad_store(&v->wave[number*nodes + n], before);
            quad_store(&v->old[number*nodes + n], v->wave ? before*quad_set(1 - v->order) : before);
        }
        if (mass > 0) u = u + frame + fall;
        if (g->planes && mass > 0) {
            float after[3] = {u[0], u[1], u[2]};
            mpm_apply_planes(v, g, n, after, dim);
            quad change = {u[0] - after[0], u[1] - after[1], u[2] - after[2], 0};
            given = given + change*quad_set(mass);
            u = u - change;
            totals[3] += (double)mass*(change[0]*u[0] + change[1]*u[1] + change[2]*u[2]);
        }
        u[3] = mass;
        quad_store(&node[n], u);
    }
    for (int a = 0; a < 3; a++) totals[a] += given[a];
}
