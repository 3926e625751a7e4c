/* Blocks of nodes where the level set is not nothing: those that bins with particles reach, sorted by key and
   looked up by halving. Drawback: a block inside the liquid is computed like one at its surface. */
#include "view/surface/surface.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int64_t surface_find_block(const surface_view *v, uint64_t key)
{
    int64_t low = 0, high = v->block_count;
    while (low < high) {
        const int64_t middle = (low + high)/2;
        if (v->block_key[middle] < key) low = middle + 1;
        else high = middle;
    }
    return low < v->block_count && v->block_key[low] == key ? low : -1;
}

/* First and last block along each axis that hold nodes within R of a bin, or low corners of their cells. */
static void find_range(const surface_view *v, uint64_t key, int64_t first[3], int64_t last[3])
{
    for (int a = 0; a < 3; a++) {
        const double bin = (double)(key%v->bins[a]), cell = v->cell[a];
        key /= v->bins[a];
        first[a] = (int64_t)((bin - 1)/cell - 1)/SURFACE_SIDE;
        last[a] = (int64_t)((bin + 2)/cell + 1)/SURFACE_SIDE;
    }
}

static bool is_empty(const surface_work *w, int64_t bin)
{
    for (int64_t k = w->bin_begin[bin]; k < w->bin_begin[bin + 1]; k++)
        if (w->strength[k] > 0) return false;
    return true;
}

/* Keys of the blocks that bins reach, those of the bin before left out where it lies in the same row; counts
   only, if keys is NULL. */
static int64_t collect_keys(const surface_work *w, uint64_t *keys)
{
    const surface_view *v = &w->view;
    int64_t n = 0, reached = -1, first[3], last[3];
    for (int64_t b = 0; b < v->bin_count; b++) {
        const uint64_t key = v->bin_key[b], row = key/v->bins[0];
        const uint64_t group = row/v->bins[1]/v->bins[2];
        find_range(v, key, first, last);
        if (b == 0 || v->bin_key[b - 1]/v->bins[0] != row) reached = -1;
        if (is_empty(w, b)) continue;
        if (first[0] <= reached) first[0] = reached + 1;
        if (last[0] > reached) reached = last[0];
        for (int64_t z = first[2]; z <= last[2]; z++)
            for (int64_t y = first[1]; y <= last[1]; y++)
                for (int64_t x = first[0]; x <= last[0]; x++, n++)
                    if (keys) keys[n] = ((group*v->blocks[2] + (uint64_t)z)*v->blocks[1] + (uint64_t)y)*
                                        v->blocks[0] + (uint64_t)x;
    }
    return n;
}

static tobi_status check_memory(double bytes, tobi_error *err)
{
    const double have = (double)sysconf(_SC_PHYS_PAGES)*(double)sysconf(_SC_PAGESIZE);
    return have > 0 && bytes > have ? surface_no_memory(err, bytes) : TOBI_OK;
}

static tobi_status list_keys(surface_work *w, tobi_error *err)
{
    surface_view *v = &w->view;
    const int64_t n = collect_keys(w, NULL);
    TOBI_TRY(check_memory(40.0*(double)n, err));
    if (n > INT32_MAX) return surface_no_memory(err, 40.0*(double)n);
    w->block_key = tobi_array_make(n + 1, sizeof *w->block_key);
    int32_t *order = malloc((size_t)n*sizeof *order + 1);
    tobi_status status = w->block_key && order ? TOBI_OK : surface_no_memory(err, 12.0*(double)n);
    if (status == TOBI_OK) {
        collect_keys(w, w->block_key);
        uint64_t top = 0;
        for (int64_t k = 0; k < n; k++) top = w->block_key[k] > top ? w->block_key[k] : top;
        status = surface_sort(w, n, top + 1, w->block_key, order, err);
        int64_t kept = 0;
        for (int64_t k = 0; status == TOBI_OK && k < n; k++)
            if (k == 0 || w->block_key[k] != w->block_key[k - 1]) w->block_key[kept++] = w->block_key[k];
        v->block_key = w->block_key;
        v->block_count = kept;
    }
    free(order);
    return status;
}

static void find_beside(const void *view, int64_t begin, int64_t end)
{
    surface_work *w = *(surface_work *const *)view;
    const surface_view *v = &w->view;
    for (int64_t b = begin; b < end; b++)
        for (int k = 0; k < 8; k++) {
            const uint64_t step = (uint64_t)(k & 1) +
                v->blocks[0]*((uint64_t)(k >> 1 & 1) + v->blocks[1]*(uint64_t)(k >> 2));
            w->beside[b][k] = k ? (int32_t)surface_find_block(v, v->block_key[b] + step) : (int32_t)b;
        }
}

tobi_status surface_list_blocks(surface_work *w, tobi_error *err)
{
    surface_view *v = &w->view;
    TOBI_TRY(list_keys(w, err));
    const double each = SURFACE_NODES*sizeof *w->node + sizeof *w->rows + sizeof *w->beside + 16;
    const double bytes = each*(double)v->block_count;
    TOBI_TRY(check_memory(bytes, err));
    w->node = tobi_array_make(v->block_count*SURFACE_NODES + 1, sizeof *w->node);
    w->beside = tobi_array_make(v->block_count + 1, sizeof *w->beside);
    if (!w->node || !w->beside) return surface_no_memory(err, bytes);
    v->node = w->node;
    tobi_loop(w->exec.threads, v->block_count, 64, find_beside, &(surface_work *){ w });
    tobi_launch_each(&w->exec, tobi_view_kernels_for(w->exec.isa)->surface_splat, v, v->block_count, NULL);
    return TOBI_OK;
}

/* Whether a corner of the cell around a point is inside. */
static bool is_covered(const surface_work *w, int64_t k, uint64_t group)
{
    const surface_view *v = &w->view;
    const float p[3] = { w->x[k], w->y[k], w->z[k] };
    for (int c = 0; c < 8; c++) {
        uint64_t key = group;
        int at = 0;
        for (int a = 2; a >= 0; a--) {
            const int n = (int)(p[a]/v->cell[a]) + (c >> a & 1);
            key = key*v->blocks[a] + (uint64_t)(n/SURFACE_SIDE);
            at = at*SURFACE_SIDE + n%SURFACE_SIDE;
        }
        const int64_t b = surface_find_block(v, key);
        if (b >= 0 && w->node[b*SURFACE_NODES + at] > 0) return true;
    }
    return false;
}

/* Particles that are alone, or that the grid is too coarse to see. */
tobi_status surface_find_drops(surface_work *w, tobi_error *err)
{
    w->drop = tobi_array_make(w->points + 1, sizeof *w->drop);
    if (!w->drop) return surface_no_memory(err, 4.0*(double)w->points);
    const int32_t *group = w->def->group;
    for (int64_t k = 0; k < w->points; k++) {
        const int32_t i = w->of[k];
        if (i < 0 || w->count[k] > w->view.dense) continue;
        if (w->strength[k] > 0 && is_covered(w, k, group ? (uint64_t)group[i] : 0)) continue;
        w->drop[w->drops++] = i;
    }
    return TOBI_OK;
}
