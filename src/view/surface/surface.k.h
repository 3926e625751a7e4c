/* Kernels of the surface of particles. Lengths are in support radii R, so that the kernel is (1 - q^2)^3;
   positions count from the origin of the grid. Bins are cubes of side 1 that hold particles, blocks are cubes
   of 8^3 nodes; both are known by a key, group first, x last, and sorted by it. */
#pragma once
#include "exec/portable.h"

enum {
    SURFACE_SIDE = 8, SURFACE_NODES = SURFACE_SIDE*SURFACE_SIDE*SURFACE_SIDE,
    SURFACE_BINS = 16,           /* along a block, R and a cell around it, at most: cells are <= 1.18 R */
    SURFACE_CHUNK = 64,          /* bins of one item of surface_density, vertices of surface_values */
    SURFACE_PAD = 8
};

typedef struct surface_view {
    /* particles and their images in the sides, by bin; SURFACE_PAD more are there to be read */
    const float *x, *y, *z;
    float *count;                /* sum of the kernel over all around, itself included */
    float *strength;             /* of its share in the level set */
    const uint64_t *bin_key;
    const int32_t *bin_begin;    /* bin_count + 1 */
    int64_t bin_count;
    uint64_t bins[3];            /* along each axis */
    const uint64_t *block_key;
    int64_t block_count;
    uint64_t blocks[3];
    float cell[3];
    int32_t low[3], high[3];     /* nodes within the flat sides */
    float *node;                 /* level set minus its level, by block; -1 beyond flat sides */
    float level, alone;          /* count below which a particle has nothing around */
    float dense, scale;          /* count where strength falls more slowly; density of one particle */

    tobi_float4 *vertex;         /* w: how far it is smoothed, by the particles around */
    const int32_t *block_of, *of;
    int64_t vertex_count;
    int32_t field_count;
    const int32_t *components;
    const double *const *values; /* of each field, by particle */
    float *const *fields;        /* of each field, by vertex */
} surface_view;

/* First bin whose key is not below. */
TOBI_FN int64_t surface_find_bin(const surface_view *v, uint64_t key)
{
    int64_t low = 0, high = v->bin_count;
    while (low < high) {
        const int64_t middle = (low + high)/2;
        if (v->bin_key[middle] < key) low = middle + 1;
        else high = middle;
    }
    return low;
}

/* Strength of a particle whose kernel sum is s (itself 1): s^-3/4 of the sum over a lattice gives volumes of
   drops and balls right; where there is little around, 1/s keeps films and threads whole. */
TOBI_FN float surface_strength(const surface_view *v, float s)
{
    if (s < v->alone) return 0;
    const float root = sqrtf(v->scale*(s > v->dense ? s : v->dense));
    const float power = 1/(root*sqrtf(root));
    return v->scale*(s > v->dense ? power : power*v->dense/s);
}

/* Sum of (1 - q^2)^3 over particles [begin, end). */
TOBI_FN lane surface_sum(const surface_view *v, int64_t begin, int64_t end, float x, float y, float z,
                         lane sum)
{
    const float order[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    const lane px = lane_set(x), py = lane_set(y), pz = lane_set(z), one = lane_set(1);
    for (int64_t k = begin; k < end; k += TOBI_LANES) {
        const lane dx = lane_load(v->x + k) - px, dy = lane_load(v->y + k) - py;
        const lane dz = lane_load(v->z + k) - pz;
        lane t = lane_positive(one - (dx*dx + dy*dy + dz*dz));
        t = t*t*t;
        if (k + TOBI_LANES > end)
            t = lane_where_less(lane_load(order), lane_set((float)(end - k)), t, lane_set(0));
        sum = sum + t;
    }
    return sum;
}

/* Count and strength of the particles of a chunk of bins. The nine rows of bins around move on with it. */
TOBI_FN void surface_density(const surface_view *v, int64_t chunk, double *totals)
{
    (void)totals;
    const int64_t first = chunk*SURFACE_CHUNK;
    const int64_t last = first + SURFACE_CHUNK < v->bin_count ? first + SURFACE_CHUNK : v->bin_count;
    int64_t row[9];
    uint64_t step[9];
    for (int k = 0; k < 9; k++) {
        step[k] = (uint64_t)(k/3)*v->bins[0]*v->bins[1] + (uint64_t)(k%3)*v->bins[0];
        row[k] = -1;
    }
    const uint64_t back = v->bins[0]*v->bins[1] + v->bins[0] + 1;
    for (int64_t b = first; b < last; b++) {
        int64_t from[9], to[9];
        for (int k = 0; k < 9; k++) {
            const uint64_t key = v->bin_key[b] - back + step[k];
            if (row[k] < 0) row[k] = surface_find_bin(v, key);
            while (row[k] < v->bin_count && v->bin_key[row[k]] < key) row[k]++;
            int64_t end = row[k];
            while (end < v->bin_count && v->bin_key[end] <= key + 2) end++;
            from[k] = v->bin_begin[row[k]];
            to[k] = v->bin_begin[end];
        }
        for (int64_t i = v->bin_begin[b]; i < v->bin_begin[b + 1]; i++) {
            lane sum = lane_set(0);
            for (int k = 0; k < 9; k++) sum = surface_sum(v, from[k], to[k], v->x[i], v->y[i], v->z[i], sum);
            v->count[i] = lane_sum(sum);
            v->strength[i] = surface_strength(v, v->count[i]);
        }
    }
}

/* The bins that reach a block, and where their particles begin. */
typedef struct surface_bins {
    int32_t first[3], n[3];      /* bins along each axis */
    int32_t begin[SURFACE_BINS][SURFACE_BINS][SURFACE_BINS + 1];     /* z, y, x */
} surface_bins;

/* Place of a block in units of blocks, and its group. */
TOBI_FN uint64_t surface_place(const surface_view *v, int64_t block, int32_t place[3])
{
    uint64_t key = v->block_key[block];
    for (int a = 0; a < 3; a++) {
        place[a] = (int32_t)(key%v->blocks[a]);
        key /= v->blocks[a];
    }
    return key;
}

/* reach: around the nodes of the block, in R. */
TOBI_FN void surface_list_bins(const surface_view *v, int64_t block, float reach, surface_bins *s)
{
    int32_t place[3];
    const uint64_t group = surface_place(v, block, place);
    for (int a = 0; a < 3; a++) {
        const float low = (float)(place[a]*SURFACE_SIDE)*v->cell[a];
        int32_t first = (int32_t)(low - reach), last = (int32_t)(low + (SURFACE_SIDE - 1)*v->cell[a] + reach);
        if (low < reach) first = 0;
        if (last >= (int32_t)v->bins[a]) last = (int32_t)v->bins[a] - 1;
        if (last >= first + SURFACE_BINS) last = first + SURFACE_BINS - 1;
        s->first[a] = first;
        s->n[a] = last - first + 1;
    }
    for (int z = 0; z < s->n[2]; z++)
        for (int y = 0; y < s->n[1]; y++) {
            const uint64_t key = ((group*v->bins[2] + (uint64_t)(s->first[2] + z))*v->bins[1] +
                                  (uint64_t)(s->first[1] + y))*v->bins[0] + (uint64_t)s->first[0];
            int64_t b = surface_find_bin(v, key);
            for (int x = 0; x <= s->n[0]; x++) {
                while (b < v->bin_count && v->bin_key[b] < key + (uint64_t)x) b++;
                s->begin[z][y][x] = v->bin_begin[b];
            }
        }
}

/* First and last of eight nodes, `cell` apart, within 1 of p. */
TOBI_FN void surface_reach(float p, float cell, int *first, int *last)
{
    const float low = (p - 1)/cell, high = (p + 1)/cell;
    *first = low <= 0 ? 0 : low > SURFACE_SIDE ? SURFACE_SIDE : (int)low + 1;
    *last = high < 0 ? -1 : high >= SURFACE_SIDE - 1 ? SURFACE_SIDE - 1 : (int)high;
}

/* Adds a particle at p, seen from the first node, to the nodes of a block. */
TOBI_FN void surface_add(const float p[3], float strength, const float cell[3], float *node)
{
    int first[3], last[3];
    for (int a = 0; a < 3; a++) {
        surface_reach(p[a], cell[a], &first[a], &last[a]);
        if (first[a] > last[a]) return;
    }
    lane square[SURFACE_SIDE/TOBI_LANES];
    for (int k = 0; k < SURFACE_SIDE/TOBI_LANES; k++) {
        float dx[TOBI_LANES];
        for (int m = 0; m < TOBI_LANES; m++) {
            const float d = (float)(k*TOBI_LANES + m)*cell[0] - p[0];
            dx[m] = d*d;
        }
        square[k] = lane_load(dx);
    }
    const lane weight = lane_set(strength);
    for (int z = first[2]; z <= last[2]; z++) {
        const float dz = (float)z*cell[2] - p[2], rest = 1 - dz*dz;
        for (int y = first[1]; y <= last[1]; y++) {
            const float dy = (float)y*cell[1] - p[1], left = rest - dy*dy;
            if (left <= 0) continue;
            float *row = node + (z*SURFACE_SIDE + y)*SURFACE_SIDE;
            for (int k = 0; k < SURFACE_SIDE/TOBI_LANES; k++) {
                const lane t = lane_positive(lane_set(left) - square[k]);
                lane_store(row + k*TOBI_LANES, lane_load(row + k*TOBI_LANES) + weight*(t*t*t));
            }
        }
    }
}

/* Nodes beyond flat sides are outside whatever is there. */
TOBI_FN void surface_cut_sides(const surface_view *v, const int32_t place[3], float *node)
{
    int inside = 1;
    for (int a = 0; a < 3; a++)
        inside &= place[a]*SURFACE_SIDE >= v->low[a] &&
                  place[a]*SURFACE_SIDE + SURFACE_SIDE - 1 <= v->high[a];
    if (inside) return;
    for (int k = 0; k < SURFACE_NODES; k++) {
        const int at[3] = {k%SURFACE_SIDE, k/SURFACE_SIDE%SURFACE_SIDE, k/SURFACE_SIDE/SURFACE_SIDE};
        for (int a = 0; a < 3; a++) {
            const int32_t n = place[a]*SURFACE_SIDE + at[a];
            if (n < v->low[a] || n > v->high[a]) node[k] = -1;
        }
    }
}

/* The level set at the nodes of a block: every particle within R adds its strength times the kernel. */
TOBI_FN void surface_splat(const surface_view *v, int64_t block, double *totals)
{
    (void)totals;
    int32_t place[3];
    surface_bins s;
    surface_place(v, block, place);
    surface_list_bins(v, block, 1, &s);
    float *node = v->node + block*SURFACE_NODES, from[3];
    for (int a = 0; a < 3; a++) from[a] = (float)(place[a]*SURFACE_SIDE)*v->cell[a];
    for (int k = 0; k < SURFACE_NODES; k++) node[k] = -v->level;
    for (int z = 0; z < s.n[2]; z++)
        for (int y = 0; y < s.n[1]; y++)
            for (int64_t i = s.begin[z][y][0]; i < s.begin[z][y][s.n[0]]; i++) {
                const float p[3] = {v->x[i] - from[0], v->y[i] - from[1], v->z[i] - from[2]};
                if (v->strength[i] > 0) surface_add(p, v->strength[i], v->cell, node);
            }
    surface_cut_sides(v, place, node);
}

/* How far a vertex is smoothed, by the mean density around it: not at all in threads and drops. */
TOBI_FN float surface_share(float density)
{
    float u = (density - 0.45f)/0.4f;
    u = u < 0 ? 0 : u > 1 ? 1 : u;
    return u*u*(3 - 2*u);
}

/* A particle's part in the means at a vertex. */
TOBI_FN void surface_mean(const surface_view *v, int64_t i, int64_t k, float weight, float *sum)
{
    const int64_t particle = v->of[k] < 0 ? -1 - (int64_t)v->of[k] : v->of[k];
    sum[0] += weight;
    sum[1] += weight*v->count[k];
    for (int f = 0; f < v->field_count; f++) {
        const int n = v->components[f];
        for (int c = 0; c < n; c++) v->fields[f][i*n + c] += weight*(float)v->values[f][particle*n + c];
    }
}

/* Adds the particles [begin, end) to the means at vertex i. */
TOBI_FN void surface_add_means(const surface_view *v, int64_t i, int64_t begin, int64_t end, float *sum)
{
    const tobi_float4 p = v->vertex[i];
    for (int64_t k = begin; k < end; k += TOBI_LANES) {
        const lane dx = lane_load(v->x + k) - lane_set(p.x), dy = lane_load(v->y + k) - lane_set(p.y);
        const lane dz = lane_load(v->z + k) - lane_set(p.z);
        const lane t = lane_positive(lane_set(1) - (dx*dx + dy*dy + dz*dz));
        const lane weight = lane_load(v->strength + k)*(t*t*t);
        if (lane_sum(weight) <= 0) continue;
        for (int m = 0; m < TOBI_LANES && k + m < end; m++)
            if (lane_at(weight, m) > 0) surface_mean(v, i, k + m, lane_at(weight, m), sum);
    }
}

/* Means at a chunk of vertices: fields, and how far they are smoothed. */
TOBI_FN void surface_values(const surface_view *v, int64_t chunk, double *totals)
{
    (void)totals;
    const int64_t first = chunk*SURFACE_CHUNK;
    const int64_t last = first + SURFACE_CHUNK < v->vertex_count ? first + SURFACE_CHUNK : v->vertex_count;
    const float reach = 1 + (v->cell[0] > v->cell[1] ? v->cell[0] > v->cell[2] ? v->cell[0] : v->cell[2]
                                                     : v->cell[1] > v->cell[2] ? v->cell[1] : v->cell[2]);
    surface_bins s;
    for (int a = 0; a < 3; a++) s.first[a] = s.n[a] = 0;
    int32_t block = -1;
    for (int64_t i = first; i < last; i++) {
        if (v->block_of[i] != block) surface_list_bins(v, block = v->block_of[i], reach, &s);
        const float p[3] = {v->vertex[i].x, v->vertex[i].y, v->vertex[i].z};
        int low[3], high[3];
        for (int a = 0; a < 3; a++) {
            low[a] = (int)p[a] - 1 - s.first[a];
            high[a] = low[a] + 2 < s.n[a] ? low[a] + 2 : s.n[a] - 1;
            if (low[a] < 0) low[a] = 0;
        }
        float sum[2] = {0, 0};
        for (int f = 0; f < v->field_count; f++)
            for (int c = 0; c < v->components[f]; c++) v->fields[f][i*v->components[f] + c] = 0;
        for (int z = low[2]; z <= high[2]; z++)
            for (int y = low[1]; y <= high[1]; y++)
                surface_add_means(v, i, s.begin[z][y][low[0]], s.begin[z][y][high[0] + 1], sum);
        const float one = sum[0] > 0 ? 1/sum[0] : 0;
        v->vertex[i].w = surface_share(v->scale*sum[1]*one);
        for (int f = 0; f < v->field_count; f++)
            for (int c = 0; c < v->components[f]; c++) v->fields[f][i*v->components[f] + c] *= one;
    }
}
