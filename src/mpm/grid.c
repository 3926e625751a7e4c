/* Blocks of nodes exist only around blocks of particles, found by sorting, not by hashing. Drawback:
   the list is made anew in every step. */
#include "mpm/grid.h"
#include "mpm/particle_fields.h"
#include "base/error.h"
#include <math.h>
#include <string.h>

enum { BLOCK = 4, CELL_BITS = 6 };

/* Bits of a key below its block: the cell and, where there may be cuts, the side of the first that the
   particle remembers. Particles of one cell and side see the same nodes, and are added up together as long as
   they follow one another. */
static int key_bits(const tobi_particles *p) { return CELL_BITS + (mpm_fields_of(p)->cuts != NULL); }

static double most_blocks(const tobi_particles *p) { return (double)(UINT64_C(1) << (32 - key_bits(p))); }

static int tile_nodes(const mpm_grid *g) { return (g->dimension == 3 ? MPM_TILE_3D : MPM_TILE_2D) + 8; }
static int block_nodes(const mpm_grid *g) { return g->dimension == 3 ? MPM_NODES_3D : MPM_NODES_2D; }

tobi_status mpm_grid_create(mpm_grid *g, int dimension, int layers, const tobi_exec *x, tobi_error *err)
{
    memset(g, 0, sizeof *g);
    g->dimension = dimension;
    g->layers = layers;
    g->histogram = tobi_array_make(tobi_sort_histogram_size(x), sizeof *g->histogram);
    return g->histogram ? TOBI_OK : tobi_fail(err, TOBI_NO_MEMORY, "no memory for the grid");
}

void mpm_grid_free(mpm_grid *g)
{
    void *const arrays[] = { g->block, g->patch, g->reach, g->block_key, g->patch_key, g->node,
                             g->old, g->wave, g->scratch, g->histogram, g->begin };
    for (size_t k = 0; k < sizeof arrays/sizeof *arrays; k++) tobi_array_free(arrays[k]);
    memset(g, 0, sizeof *g);
}

int64_t mpm_grid_bytes(const mpm_grid *g)
{
    int64_t node = (int64_t)sizeof(tobi_float4)*block_nodes(g)*g->layers;
    int64_t block = (int64_t)(sizeof(mpm_block) + sizeof(mpm_reach) + sizeof(uint32_t));
    return g->scratch_bytes + g->block_room*block +
           g->patch_room*(node + (int64_t)(sizeof(mpm_patch) + sizeof(uint32_t)));
}

/* Makes *array hold `count` items; its content is lost. */
static int grow(void **array, int64_t count, size_t size)
{
    tobi_array_free(*array);
    *array = tobi_array_make(count, size);
    return *array != NULL;
}

static tobi_status reserve_scratch(mpm_grid *g, int64_t bytes, tobi_error *err)
{
    if (bytes <= g->scratch_bytes) return TOBI_OK;
    if (!grow((void **)&g->scratch, bytes, 1)) {
        g->scratch_bytes = 0;
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for sorting: %lld bytes", (long long)bytes);
    }
    g->scratch_bytes = bytes;
    return TOBI_OK;
}

/* Lists where runs of equal keys begin, in g->begin, and the end after them; returns how many in *count. */
static tobi_status list_runs(mpm_grid *g, const uint32_t *keys, int64_t n, int bits, int64_t *count,
                             tobi_exec *x, tobi_error *err)
{
    *count = tobi_find_runs(x, n, keys, bits, NULL);
    if (*count + 1 > g->begin_room) {
        g->begin_room = *count + *count/8 + 8;
        if (!grow((void **)&g->begin, g->begin_room, sizeof *g->begin)) {
            g->begin_room = 0;
            return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld blocks", (long long)*count);
        }
    }
    tobi_find_runs(x, n, keys, bits, g->begin);
    g->begin[*count] = n;
    return TOBI_OK;
}

/* The same, with the first `used` of its items. */
static int extend(void **array, int64_t used, int64_t count, size_t size)
{
    void *before = *array;
    *array = NULL;
    const int grown = grow(array, count, size);
    if (grown && used > 0) memcpy(*array, before, (size_t)used*size);
    tobi_array_free(before);
    return grown;
}

/* Room for `need` blocks; the first `used` stay. */
static tobi_status extend_blocks(mpm_grid *g, int64_t used, int64_t need, tobi_error *err)
{
    if (need > g->block_room) {
        g->block_room = need + need/8 + 8;
        if (!extend((void **)&g->block, used, g->block_room, sizeof *g->block) ||
            !grow((void **)&g->reach, g->block_room, sizeof *g->reach) ||
            !extend((void **)&g->block_key, used, g->block_room, sizeof *g->block_key)) {
            g->block_room = 0;
            return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld blocks", (long long)need);
        }
    }
    return TOBI_OK;
}

static tobi_status reserve_blocks(mpm_grid *g, int64_t count, tobi_error *err)
{
    TOBI_TRY(extend_blocks(g, 0, count, err));
    g->block_count = count;
    g->block_twins = 0;
    return TOBI_OK;
}

static tobi_status extend_patches(mpm_grid *g, int64_t used, int64_t need, tobi_error *err)
{
    if (need > g->patch_room) {
        g->patch_room = need + need/8 + 8;
        int64_t nodes = g->patch_room*block_nodes(g);
        if (!extend((void **)&g->patch, used, g->patch_room, sizeof *g->patch) ||
            !extend((void **)&g->patch_key, used, g->patch_room, sizeof *g->patch_key) ||
            !grow((void **)&g->node, nodes, sizeof *g->node) ||
            (g->layers > 1 && !grow((void **)&g->old, nodes, sizeof *g->old)) ||
            (g->layers > 2 && !grow((void **)&g->wave, nodes, sizeof *g->wave))) {
            g->patch_room = 0;
            return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld blocks of nodes", (long long)need);
        }
    }
    return TOBI_OK;
}

static tobi_status reserve_patches(mpm_grid *g, int64_t count, tobi_error *err)
{
    TOBI_TRY(extend_patches(g, 0, count, err));
    g->patch_count = count;
    g->patch_twins = 0;
    return TOBI_OK;
}

/* The base node of a particle along an axis, and its block; cells begin at -4, so that both stay positive. */
static int base_node(double x, double inverse_cell) { return (int)floor(x*inverse_cell - 0.5) + BLOCK; }

/* The corner of the particle's block, in blocks: of its base node now, or where it is at home. */
static void find_block(const tobi_particles *p, int64_t i, double inverse_cell, int home, int dimension,
                       int b[3])
{
    const double *x = &p->position[i].x;
    for (int a = 0; a < 3; a++) {
        if (a >= dimension) b[a] = 0;
        else if (home) b[a] = (int)mpm_fields_of(p)->affine[i].c[a].w/BLOCK + 1;
        else b[a] = base_node(x[a], inverse_cell)/BLOCK;
    }
}

/* What the loops over particles, their blocks and the blocks of nodes need. */
typedef struct sorting {
    mpm_grid *grid;
    const tobi_particles *particles;
    double inverse_cell;
    int home;
    uint32_t *keys;
    int64_t around;                    /* blocks around one */
    int (*low)[3], (*high)[3];         /* of each part of the particles */
} sorting;

enum { BOX_PARTS = 64 };

/* The blocks of parts of the particles. */
static void box_parts(const void *view, int64_t begin, int64_t end)
{
    const sorting *s = view;
    const int64_t n = s->particles->count;
    for (int64_t q = begin; q < end; q++) {
        int low[3] = {1 << 30, 1 << 30, 1 << 30}, high[3] = {0, 0, 0};
        for (int64_t i = n*q/BOX_PARTS; i < n*(q + 1)/BOX_PARTS; i++) {
            int b[3];
            find_block(s->particles, i, s->inverse_cell, s->home, s->grid->dimension, b);
            for (int a = 0; a < 3; a++) {
                if (b[a] < low[a]) low[a] = b[a];
                if (b[a] > high[a]) high[a] = b[a];
            }
        }
        memcpy(s->low[q], low, sizeof low);
        memcpy(s->high[q], high, sizeof high);
    }
}

/* The box of blocks around all particles, with a layer more. */
static tobi_status find_box(mpm_grid *g, const tobi_particles *p, double inverse_cell, int home, tobi_exec *x,
                            tobi_error *err)
{
    int low[BOX_PARTS][3], high[BOX_PARTS][3];
    const sorting view = { .grid = g, .particles = p, .inverse_cell = inverse_cell, .home = home, .low = low,
                           .high = high };
    double total = 1;
    tobi_loop(x->threads, BOX_PARTS, 0, box_parts, &view);
    for (int a = 0; a < 3; a++) {
        int first = low[0][a], last = high[0][a];
        for (int q = 1; q < BOX_PARTS; q++) {
            if (low[q][a] < first) first = low[q][a];
            if (high[q][a] > last) last = high[q][a];
        }
        g->low[a] = first - 1;
        g->count[a] = last - first + 3;
        total *= g->count[a];
    }
    if (total < most_blocks(p)) return TOBI_OK;
    return tobi_fail(err, TOBI_UNSUPPORTED,
                     "the solids reach over %d x %d x %d blocks of cells; allowed are %.0f together. "
                     "Fewer particles astray or a larger spacing help",
                     g->count[0], g->count[1], g->count[2], most_blocks(p));
}

static uint32_t block_key(const mpm_grid *g, const int b[3])
{
    return ((uint32_t)(b[0] - g->low[0])*(uint32_t)g->count[1] + (uint32_t)(b[1] - g->low[1]))*
           (uint32_t)g->count[2] + (uint32_t)(b[2] - g->low[2]);
}

static void corner_of(const mpm_grid *g, uint32_t key, int32_t corner[3])
{
    const int b[3] = {(int)(key/(uint32_t)g->count[2]/(uint32_t)g->count[1]) + g->low[0],
                      (int)(key/(uint32_t)g->count[2]%(uint32_t)g->count[1]) + g->low[1],
                      (int)(key%(uint32_t)g->count[2]) + g->low[2]};
    for (int a = 0; a < 3; a++) corner[a] = a < g->dimension ? BLOCK*(b[a] - 1) : 0;
}

static void key_particles(const void *view, int64_t begin, int64_t end)
{
    const sorting *s = view;
    const tobi_particles *p = s->particles;
    const mpm_fields *f = mpm_fields_of(p);
    for (int64_t i = begin; i < end; i++) {
        int b[3];
        uint32_t cell = 0;
        find_block(p, i, s->inverse_cell, s->home, s->grid->dimension, b);
        for (int a = 0; a < s->grid->dimension && !s->home; a++)
            cell = cell*BLOCK + (uint32_t)base_node((&p->position[i].x)[a], s->inverse_cell)%BLOCK;
        if (f->cuts && !s->home) cell = cell*2 + (f->cuts[i].c[0].w < 0);
        s->keys[i] = block_key(s->grid, b) << key_bits(p) | cell;
    }
}

static void find_keys(mpm_grid *g, const tobi_particles *p, double inverse_cell, int home, tobi_exec *x,
                      uint32_t *keys)
{
    const sorting view = { .grid = g, .particles = p, .inverse_cell = inverse_cell, .home = home,
                           .keys = keys };
    tobi_loop(x->threads, p->count, 0, key_particles, &view);
}

static void fill_blocks(const void *view, int64_t begin, int64_t end)
{
    const sorting *s = view;
    const mpm_grid *g = s->grid;
    for (int64_t k = begin; k < end; k++) {
        g->block_key[k] = s->keys[g->begin[k]] >> key_bits(s->particles);
        g->block[k].begin = g->begin[k];
        g->block[k].end = g->begin[k + 1];
        g->block[k].twin = -1;
        g->block[k].levels = 0;
        corner_of(g, g->block_key[k], g->block[k].corner);
    }
}

/* Blocks of particles from their sorted keys. */
static tobi_status make_blocks(mpm_grid *g, uint32_t *keys, const tobi_particles *p, tobi_exec *x,
                               tobi_error *err)
{
    const sorting view = { .grid = g, .particles = p, .keys = keys };
    int64_t count;
    TOBI_TRY(list_runs(g, keys, p->count, key_bits(p), &count, x, err));
    TOBI_TRY(reserve_blocks(g, count, err));
    tobi_loop(x->threads, count, 0, fill_blocks, &view);
    return TOBI_OK;
}

static int32_t find_key(const uint32_t *keys, int64_t n, uint32_t key)
{
    int64_t low = 0, high = n;
    while (low < high) {
        int64_t middle = (low + high)/2;
        if (keys[middle] < key) low = middle + 1;
        else high = middle;
    }
    return low < n && keys[low] == key ? (int32_t)low : -1;
}

/* Key of the block at offset o = (x + 1)*9 + (y + 1)*3 + z + 1. */
static uint32_t beside(const mpm_grid *g, uint32_t key, int o)
{
    int64_t step = ((int64_t)(o/9 - 1)*g->count[1] + (o/3%3 - 1))*g->count[2] + (o%3 - 1);
    return (uint32_t)((int64_t)key + step);
}

static int is_offset(const mpm_grid *g, int o) { return g->dimension == 3 || o%3 == 1; }

static void key_around(const void *view, int64_t begin, int64_t end)
{
    const sorting *s = view;
    for (int64_t k = begin; k < end; k++)
        for (int o = 0, at = 0; o < 27; o++)
            if (is_offset(s->grid, o))
                s->keys[k*s->around + at++] = beside(s->grid, s->grid->block_key[k], o);
}

static void key_patches(const void *view, int64_t begin, int64_t end)
{
    const sorting *s = view;
    for (int64_t k = begin; k < end; k++) s->grid->patch_key[k] = s->keys[s->grid->begin[k]];
}

static void fill_patches(const void *view, int64_t begin, int64_t end)
{
    const mpm_grid *g = ((const sorting *)view)->grid;
    for (int64_t k = begin; k < end; k++) {
        mpm_patch *p = &g->patch[k];
        corner_of(g, g->patch_key[k], p->corner);
        p->twin = -1;
        p->levels = 0;
        for (int o = 0; o < 27; o++)
            p->cover[o] = is_offset(g, o) ? find_key(g->block_key, g->block_count,
                                                     beside(g, g->patch_key[k], o)) : -1;
    }
}

static void find_around(const void *view, int64_t begin, int64_t end)
{
    const mpm_grid *g = ((const sorting *)view)->grid;
    for (int64_t k = begin; k < end; k++)
        for (int o = 0; o < 27; o++)
            g->block[k].around[o] =
                is_offset(g, o) ? find_key(g->patch_key, g->patch_count, beside(g, g->block_key[k], o)) : -1;
}

/* Blocks of nodes: those around any block of particles. */
static tobi_status make_patches(mpm_grid *g, tobi_exec *x, tobi_error *err)
{
    int64_t around = g->dimension == 3 ? 27 : 9, n = g->block_count*around;
    TOBI_TRY(reserve_scratch(g, 4*n*(int64_t)sizeof(uint32_t), err));
    uint32_t *keys = (uint32_t *)(void *)g->scratch, *key_scratch = keys + n;
    int32_t *order = (int32_t *)(void *)(keys + 2*n), *order_scratch = order + n;
    const sorting view = { .grid = g, .keys = keys, .around = around };
    tobi_loop(x->threads, g->block_count, 0, key_around, &view);
    uint32_t limit = (uint32_t)g->count[0]*(uint32_t)g->count[1]*(uint32_t)g->count[2];
    tobi_sort_by_key(x, n, limit, keys, order, key_scratch, order_scratch, g->histogram);
    int64_t count;
    TOBI_TRY(list_runs(g, keys, n, 0, &count, x, err));
    TOBI_TRY(reserve_patches(g, count, err));
    tobi_loop(x->threads, count, 0, key_patches, &view);
    tobi_loop(x->threads, count, 0, fill_patches, &view);
    tobi_loop(x->threads, g->block_count, 0, find_around, &view);
    return TOBI_OK;
}

static tobi_status reserve_rest(mpm_grid *g, tobi_exec *x, tobi_error *err)
{
    const int64_t patches = g->patch_count + g->patch_twins, blocks = g->block_count + g->block_twins;
    TOBI_TRY(tobi_exec_reserve(x, (patches > blocks ? patches : blocks)*TOBI_BLOCK, err));
    int64_t tiles = blocks*(g->layers > 1 ? 2 : 1);
    return reserve_scratch(g, tiles*tile_nodes(g)*(int64_t)sizeof(tobi_float4), err);
}

tobi_status mpm_grid_reserve_twins(mpm_grid *g, tobi_exec *x, tobi_error *err)
{
    TOBI_TRY(extend_blocks(g, g->block_count, g->block_count + g->block_twins, err));
    TOBI_TRY(extend_patches(g, g->patch_count, g->patch_count + g->patch_twins, err));
    return reserve_rest(g, x, err);
}

tobi_status mpm_grid_sort(mpm_grid *g, tobi_particles *p, double inverse_cell, tobi_exec *x, tobi_error *err)
{
    int64_t n = p->count;
    TOBI_TRY(find_box(g, p, inverse_cell, 0, x, err));
    TOBI_TRY(reserve_scratch(g, n*(int64_t)(sizeof(int32_t) + sizeof(tobi_columns)) + 64, err));
    /* The order first; the other three arrays of the sort share their place with the fields' copies. */
    int32_t *order = (int32_t *)(void *)g->scratch, *order_scratch = order + n;
    uint32_t *keys = (uint32_t *)(void *)(order + 2*n), *key_scratch = keys + n;
    find_keys(g, p, inverse_cell, 0, x, keys);
    uint32_t blocks = (uint32_t)g->count[0]*(uint32_t)g->count[1]*(uint32_t)g->count[2];
    tobi_sort_by_key(x, n, blocks << key_bits(p), keys, order, key_scratch, order_scratch, g->histogram);
    TOBI_TRY(make_blocks(g, keys, p, x, err));
    size_t room = ((size_t)n*sizeof *order + 63)/64*64;
    tobi_particles_permute(p, order, g->scratch + room, x->threads);
    TOBI_TRY(make_patches(g, x, err));
    return reserve_rest(g, x, err);
}

tobi_status mpm_grid_restore(mpm_grid *g, tobi_particles *p, tobi_exec *x, tobi_error *err)
{
    TOBI_TRY(find_box(g, p, 0, 1, x, err));
    TOBI_TRY(reserve_scratch(g, p->count*(int64_t)sizeof(uint32_t), err));
    uint32_t *keys = (uint32_t *)(void *)g->scratch;
    find_keys(g, p, 0, 1, x, keys);
    TOBI_TRY(make_blocks(g, keys, p, x, err));
    TOBI_TRY(make_patches(g, x, err));
    return reserve_rest(g, x, err);
}

int64_t mpm_grid_find_patch(const mpm_grid *g, const int at[3])
{
    int b[3];
    for (int a = 0; a < 3; a++) {
        b[a] = a < g->dimension ? (at[a] + BLOCK)/BLOCK : 0;
        if (at[a] < -BLOCK || b[a] < g->low[a] || b[a] >= g->low[a] + g->count[a]) return -1;
    }
    return find_key(g->patch_key, g->patch_count, block_key(g, b));
}

void mpm_grid_bind(const mpm_grid *g, mpm_view *v)
{
    v->block = g->block;
    v->patch = g->patch;
    v->reach = g->reach;
    v->node = g->node;
    v->old = g->layers > 1 ? g->old : NULL;
    v->wave = g->layers > 2 ? g->wave : NULL;
    v->tile = (tobi_float4 *)(void *)g->scratch;
    v->unstressed = g->layers > 1 ? v->tile + (g->block_count + g->block_twins)*tile_nodes(g) : NULL;
}
