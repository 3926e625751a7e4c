/* Marching cubes over blocks: first how many vertices and triangles each block has, then their places, so
   that blocks go to threads in any order. A vertex belongs to the block of the lower end of its edge.
   Drawback: the nodes of a block are copied together twice. */
#include "view/surface/surface.h"
#include <stdlib.h>
#include <string.h>

enum { SIDE = SURFACE_SIDE, ROW = SIDE + 1 };

typedef struct march_view { surface_work *w; const surface_cases *cases; } march_view;

/* The nodes of a block and the first ones of those beside it, and which of them are inside, by rows. */
typedef struct tile { float node[ROW][ROW][ROW]; uint32_t inside[ROW][ROW]; bool mixed; } tile;

static float node_at(const surface_work *w, int64_t b, int x, int y, int z)
{
    const int32_t from = w->beside[b][(x >> 3) + 2*(y >> 3) + 4*(z >> 3)];
    if (from < 0) return -w->view.level;
    return w->node[from*(int64_t)SURFACE_NODES + ((z & 7)*SIDE + (y & 7))*SIDE + (x & 7)];
}

static void load_tile(const surface_work *w, int64_t b, tile *t)
{
    uint32_t any = 0, all = (1 << ROW) - 1;
    for (int z = 0; z < ROW; z++)
        for (int y = 0; y < ROW; y++) {
            const int32_t from = w->beside[b][2*(y >> 3) + 4*(z >> 3)];
            float *row = t->node[z][y];
            if (from >= 0)
                memcpy(row, w->node + from*(int64_t)SURFACE_NODES + ((z & 7)*SIDE + (y & 7))*SIDE,
                       SIDE*sizeof *row);
            else
                for (int x = 0; x < SIDE; x++) row[x] = -w->view.level;
            row[SIDE] = node_at(w, b, SIDE, y, z);
            uint32_t bits = 0;
            for (int x = 0; x < ROW; x++) bits |= (uint32_t)(row[x] > 0) << x;
            t->inside[z][y] = bits;
            any |= bits;
            all &= bits;
        }
    t->mixed = any != 0 && all != (1 << ROW) - 1;
}

/* Crossed edges that begin in each row. */
static int list_rows(const tile *t, surface_rows *rows)
{
    int n = 0;
    for (int axis = 0; axis < 3; axis++)
        for (int z = 0; z < SIDE; z++)
            for (int y = 0; y < SIDE; y++) {
                const uint32_t here = t->inside[z][y];
                const uint32_t there = axis == 0 ? here >> 1 : t->inside[z + (axis == 2)][y + (axis == 1)];
                const uint8_t cross = (uint8_t)((here ^ there) & 0xff);
                rows->cross[axis][z][y] = cross;
                rows->before[axis][z][y] = (uint16_t)n;
                n += __builtin_popcount(cross);
            }
    return n;
}

/* Cells of a row that the surface passes, a bit each, and the corners of one of them. */
static uint32_t cells_of_row(const tile *t, int y, int z)
{
    const uint32_t a = t->inside[z][y], b = t->inside[z][y + 1];
    const uint32_t c = t->inside[z + 1][y], d = t->inside[z + 1][y + 1];
    const uint32_t any = a | b | c | d, all = a & b & c & d;
    return (any | any >> 1) & ~(all & all >> 1) & 0xff;
}

static int case_of(const tile *t, int x, int y, int z)
{
    return (int)((t->inside[z][y] >> x & 3) | (t->inside[z][y + 1] >> x & 3) << 2 |
                 (t->inside[z + 1][y] >> x & 3) << 4 | (t->inside[z + 1][y + 1] >> x & 3) << 6);
}

static void count_blocks(const void *view, int64_t begin, int64_t end)
{
    const march_view *m = view;
    surface_work *w = m->w;
    tile t;
    for (int64_t b = begin; b < end; b++) {
        load_tile(w, b, &t);
        w->vertex_begin[b] = w->triangle_begin[b] = 0;
        if (!t.mixed) {
            memset(&w->rows[b], 0, sizeof w->rows[b]);
            continue;
        }
        w->vertex_begin[b] = list_rows(&t, &w->rows[b]);
        for (int z = 0; z < SIDE; z++)
            for (int y = 0; y < SIDE; y++)
                for (uint32_t cells = cells_of_row(&t, y, z); cells; cells &= cells - 1)
                    w->triangle_begin[b] += m->cases->count[case_of(&t, tobi_lowest_bit(cells), y, z)];
    }
}

/* The vertex on the edge along `axis` from node at; mask: which flat sides it lies on. */
static tobi_float4 place_vertex(const surface_work *w, const tile *t, const int32_t from[3], const int at[3],
                                int axis, uint8_t *sides)
{
    const surface_view *v = &w->view;
    const float a = t->node[at[2]][at[1]][at[0]];
    const float b = t->node[at[2] + (axis == 2)][at[1] + (axis == 1)][at[0] + (axis == 0)];
    float p[3], share = a/(a - b);
    *sides = 0;
    for (int k = 0; k < 3; k++) {
        const int32_t n = from[k] + at[k];
        const bool below = k == axis && n < v->low[k], above = k == axis && n + 1 > v->high[k];
        if (below) share = 1;
        if (above) share = 0;
        if (below || (k != axis && n == v->low[k])) *sides |= (uint8_t)(1 << k);
        if (above || (k != axis && n == v->high[k])) *sides |= (uint8_t)(8 << k);
        if (below || above) *sides |= SURFACE_WITHIN;
    }
    for (int k = 0; k < 3; k++) p[k] = ((float)(from[k] + at[k]) + (k == axis ? share : 0))*v->cell[k];
    return (tobi_float4){ p[0], p[1], p[2], 0 };
}

static void make_vertices(surface_work *w, int64_t b, const tile *t, const int32_t from[3])
{
    int64_t to = w->vertex_begin[b];
    for (int axis = 0; axis < 3; axis++)
        for (int z = 0; z < SIDE; z++)
            for (int y = 0; y < SIDE; y++)
                for (uint32_t cross = w->rows[b].cross[axis][z][y]; cross; cross &= cross - 1, to++) {
                    const int at[3] = { tobi_lowest_bit(cross), y, z };
                    w->vertex[to] = place_vertex(w, t, from, at, axis, &w->sides[to]);
                    w->block_of[to] = (int32_t)b;
                }
}

static int32_t vertex_of(const surface_work *w, int64_t b, int edge, int x, int y, int z)
{
    const int axis = edge >> 2, u = edge & 1, v = edge >> 1 & 1;
    x += axis > 0 ? u : 0;
    y += axis == 0 ? u : axis == 2 ? v : 0;
    z += axis < 2 ? v : 0;
    const int32_t from = w->beside[b][(x >> 3) + 2*(y >> 3) + 4*(z >> 3)];
    const surface_rows *r = &w->rows[from];
    const uint32_t before = r->cross[axis][z & 7][y & 7] & ((1u << (x & 7)) - 1);
    return (int32_t)(w->vertex_begin[from] + r->before[axis][z & 7][y & 7] + __builtin_popcount(before));
}

static void make_triangles(surface_work *w, const surface_cases *cases, int64_t b, const tile *t)
{
    int64_t to = w->triangle_begin[b];
    for (int z = 0; z < SIDE; z++)
        for (int y = 0; y < SIDE; y++)
            for (uint32_t cells = cells_of_row(t, y, z); cells; cells &= cells - 1) {
                const int x = tobi_lowest_bit(cells), c = case_of(t, x, y, z);
                for (int k = 0; k < cases->count[c]; k++, to++)
                    for (int q = 0; q < 3; q++)
                        w->triangle[to][q] = vertex_of(w, b, cases->edge[c][3*k + q], x, y, z);
            }
}

static void fill_blocks(const void *view, int64_t begin, int64_t end)
{
    const march_view *m = view;
    surface_work *w = m->w;
    tile t;
    for (int64_t b = begin; b < end; b++) {
        if (w->vertex_begin[b] == w->vertex_begin[b + 1] && w->triangle_begin[b] == w->triangle_begin[b + 1])
            continue;
        int32_t from[3];
        surface_place(&w->view, b, from);
        for (int a = 0; a < 3; a++) from[a] *= SIDE;
        load_tile(w, b, &t);
        make_vertices(w, b, &t, from);
        make_triangles(w, m->cases, b, &t);
    }
}

tobi_status surface_march(surface_work *w, tobi_error *err)
{
    const int64_t blocks = w->view.block_count;
    surface_cases *cases = malloc(sizeof *cases);
    w->rows = tobi_array_make(blocks + 1, sizeof *w->rows);
    w->vertex_begin = tobi_array_make(blocks + 1, sizeof *w->vertex_begin);
    w->triangle_begin = tobi_array_make(blocks + 1, sizeof *w->triangle_begin);
    tobi_status status = TOBI_OK;
    if (!cases || !w->rows || !w->vertex_begin || !w->triangle_begin)
        status = surface_no_memory(err, (double)blocks*(double)sizeof *w->rows);
    const march_view m = { w, cases };
    if (status == TOBI_OK) {
        surface_make_cases(cases);
        tobi_loop(w->exec.threads, blocks, 16, count_blocks, &m);
        status = tobi_exec_reserve(&w->exec, blocks, err);
    }
    if (status == TOBI_OK) {
        w->vertices = w->vertex_begin[blocks] = tobi_scan(&w->exec, blocks, w->vertex_begin);
        w->triangles = w->triangle_begin[blocks] = tobi_scan(&w->exec, blocks, w->triangle_begin);
        const double bytes = 40.0*(double)w->vertices + 12.0*(double)w->triangles;
        if (w->vertices > INT32_MAX/2 || w->triangles > INT32_MAX/3) status = surface_no_memory(err, bytes);
    }
    if (status == TOBI_OK) {
        w->vertex = tobi_array_make(w->vertices + 1, sizeof *w->vertex);
        w->sides = tobi_array_make(w->vertices + 1, sizeof *w->sides);
        w->block_of = tobi_array_make(w->vertices + 1, sizeof *w->block_of);
        w->triangle = tobi_array_make(w->triangles + 1, sizeof *w->triangle);
        if (!w->vertex || !w->sides || !w->block_of || !w->triangle)
            status = surface_no_memory(err, 40.0*(double)w->vertices + 12.0*(double)w->triangles);
    }
    if (status == TOBI_OK) tobi_loop(w->exec.threads, blocks, 16, fill_blocks, &m);
    free(cases);
    return status;
}
