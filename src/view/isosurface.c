/* A smooth surface around particles, quick enough for a picture: the kernel sum on the nodes of sparse
   blocks, surface nets (Gibson 1998) and smoothing that keeps volume (Taubin 1995). At plane walls the
   sum is divided by the share of the kernel inside, and the surface lies in the wall. Particles without
   company become balls. Drawback: sheets thinner than a spacing are torn. */
#include "view/isosurface.h"
#include <stdlib.h>
#include <string.h>

static const float reach_in_spacings = 2;
static const int64_t many = 200000;      /* particles: from here on cells are larger, by a quarter */


static void free_grid(grid *s)
{
    void *all[] = { s->at, s->place, s->block, s->first, s->entry, s->colored, s->node, s->colors, s->vertex,
                    s->quad, s->cell, s->point, s->moved, s->locked, s->corner, s->extra, s->touched };
    for (size_t k = 0; k < sizeof all/sizeof *all; k++) free(all[k]);
}

/* Where nodes lie: walls run through the middle of cells, so that a surface in a wall is well inside one. */
static void place_grid(grid *s, const surface_request *r, double low[3], double high[3])
{
    const tobi_picture *f = r->f;
    s->edge = (r->count > many ? 2.5 : 2)*r->radius;
    for (double blocks = INFINITY; blocks > BLOCKS_AT_MOST; s->edge *= 2) {
        blocks = 1;
        for (int k = 0; k < 3; k++) blocks *= 2 + (high[k] - low[k])/(BLOCK_EDGE*s->edge);
        if (blocks <= BLOCKS_AT_MOST) break;
    }
    s->reach = (float)(reach_in_spacings*fmax(2*r->radius, s->edge)/s->edge);
    const double margin = ceil(s->reach) + 2;
    for (int k = 0; k < 3; k++) {
        const double first = floor((low[k] - f->box_min[k])/s->edge - margin) + 0.5;
        s->low[k] = f->box_min[k] + first*s->edge;
        s->size[k] = (int)((high[k] - s->low[k])/s->edge + margin)/BLOCK_EDGE + 1;
        s->wall[k][0] = (float)-first;
        s->wall[k][1] = (float)((f->box_max[k] - s->low[k])/s->edge);
    }
}

/* The extent of the particles in and near the domain; others are in no surface. False: there are none. */
static bool find_extent(const surface_request *r, double low[3], double high[3])
{
    const tobi_picture *f = r->f;
    for (int k = 0; k < 3; k++) low[k] = INFINITY, high[k] = -INFINITY;
    for (int64_t i = 0; i < r->count; i++) {
        const double *p = f->positions[r->row[i]];
        int inside = 0;
        for (int k = 0; k < 3; k++)
            inside += p[k] >= f->box_min[k] - 4*r->radius && p[k] <= f->box_max[k] + 4*r->radius;
        for (int k = 0; k < 3 && inside == 3; k++) {
            low[k] = p[k] < low[k] ? p[k] : low[k];
            high[k] = p[k] > high[k] ? p[k] : high[k];
        }
    }
    return low[0] <= high[0];
}

static void place_particles(grid *s, const surface_request *r)
{
    const tobi_picture *f = r->f;
    for (int64_t i = 0; i < r->count; i++) {
        const double *p = f->positions[r->row[i]];
        int inside = 0;
        for (int k = 0; k < 3; k++) {
            inside += p[k] >= f->box_min[k] - 4*r->radius && p[k] <= f->box_max[k] + 4*r->radius;
            s->place[i][k] = (float)((p[k] - s->low[k])/s->edge);
        }
        if (inside < 3) s->place[i][0] = -1;
    }
}

void view_find_blocks(const grid *s, const float place[3], float reach, reached *r)
{
    unsigned low[3], high[3], other = r->count == 0;      /* no place is below 0 */
    for (int k = 0; k < 3; k++) {
        low[k] = (unsigned)(int)(place[k] - reach)/BLOCK_EDGE;
        high[k] = (unsigned)(int)(place[k] + reach)/BLOCK_EDGE;
        other |= (low[k] ^ r->low[k]) | (high[k] ^ r->high[k]);
    }
    if (!other) return;
    const int64_t across = s->size[0], layer = across*s->size[1];
    const int64_t first = low[2]*layer + low[1]*across + low[0];
    const unsigned more[3] = { high[0] - low[0], high[1] - low[1], high[2] - low[2] };
    r->count = 0;
    for (int k = 0; k < 3; k++) r->low[k] = low[k], r->high[k] = high[k];
    for (unsigned z = 0; z <= more[2]; z++)
        for (unsigned y = 0; y <= more[1]; y++)
            for (unsigned x = 0; x <= more[0]; x++) r->at[r->count++] = first + z*layer + y*across + x;
}

/* A block has all nodes that a particle reaches and the next ones, so that no surface ends at its edge. */
static bool make_blocks(grid *s, int64_t count)
{
    const int64_t places = (int64_t)s->size[0]*s->size[1]*s->size[2];
    reached r = { .count = 0 };
    s->at = malloc((size_t)places*sizeof *s->at);
    if (!s->at) return false;
    memset(s->at, -1, (size_t)places*sizeof *s->at);
    for (int64_t i = 0; i < count; i++) {
        if (s->place[i][0] < 0) continue;
        view_find_blocks(s, s->place[i], s->reach + 1, &r);
        for (int k = 0; k < r.count; k++) s->at[r.at[k]] = 0;
    }
    for (int64_t k = 0; k < places; k++)
        if (s->at[k] == 0) s->at[k] = (int32_t)s->blocks++;
    s->block = malloc((size_t)(s->blocks + 1)*sizeof *s->block);
    s->first = calloc((size_t)s->blocks + 2, sizeof *s->first);
    if (!s->block || !s->first) return false;
    for (int z = 0; z < s->size[2]; z++)
        for (int y = 0; y < s->size[1]; y++)
            for (int x = 0; x < s->size[0]; x++) {
                const int32_t k = *block_at(s, x, y, z);
                if (k >= 0) s->block[k][0] = x, s->block[k][1] = y, s->block[k][2] = z;
            }
    return true;
}

/* The particles of each block in their order: a counting sort. */
static bool list_particles(grid *s, int64_t count)
{
    reached r = { .count = 0 };
    for (int64_t i = 0; i < count; i++) {
        if (s->place[i][0] < 0) continue;
        view_find_blocks(s, s->place[i], s->reach, &r);
        for (int k = 0; k < r.count; k++) s->first[s->at[r.at[k]] + 2]++;
    }
    for (int64_t k = 2; k < s->blocks + 2; k++) s->first[k] += s->first[k - 1];
    s->entry = malloc((size_t)(s->first[s->blocks + 1] + 1)*sizeof *s->entry);
    for (int64_t i = 0; s->entry && i < count; i++) {
        if (s->place[i][0] < 0) continue;
        view_find_blocks(s, s->place[i], s->reach, &r);
        for (int k = 0; k < r.count; k++) s->entry[s->first[s->at[r.at[k]] + 1]++] = (int32_t)i;
    }
    return s->entry != NULL;
}

/* Cells that a place lies beyond what is drawn. */
typedef double beyond(const grid *s, const double p[3]);

static double beyond_plane(const grid *s, const double p[3])
{
    const double half = fmax(0.5*s->f->slice, s->edge);      /* the grid sees nothing thinner */
    return view_beyond(s->f, p, half)/s->edge;
}

/* Where the liquid of a nest goes on. Farther, so that there is no groove between. */
static double beyond_nests(const grid *s, const double p[3])
{
    static const double LAP = 2;      /* cells: smoothing rounds so much */
    return view_beyond_nests(s->f->nests, s->f->nest_count, s->nest, p)/s->edge - LAP;
}

/* There sums fall through the level, as in a wall. */
static void limit_sums(const grid *s, int64_t b, beyond *of)
{
    float *node = s->node + b*BLOCK_NODES;
    for (int z = 0; z < BLOCK_EDGE; z++)
        for (int y = 0; y < BLOCK_EDGE; y++)
            for (int x = 0; x < BLOCK_EDGE; x++, node++) {
                const double p[3] = { s->low[0] + s->edge*(BLOCK_EDGE*s->block[b][0] + x),
                                      s->low[1] + s->edge*(BLOCK_EDGE*s->block[b][1] + y),
                                      s->low[2] + s->edge*(BLOCK_EDGE*s->block[b][2] + z) };
                const float most = s->level - 0.5f*(float)of(s, p);
                *node = *node < most ? *node : most;
            }
}

/* Sums of the block: 1 inside whatever wall is near; beyond a wall they fall through the level in it. */
static void limit_block(const grid *s, int64_t b)
{
    float *node = s->node + b*BLOCK_NODES, factor[3][BLOCK_EDGE], most[3][BLOCK_EDGE];
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < BLOCK_EDGE; i++) {
            const float at = (float)(BLOCK_EDGE*s->block[b][k] + i);
            const float l = at - s->wall[k][0], h = s->wall[k][1] - at, inside = l < h ? l : h;
            factor[k][i] = 1/(share_inside(l/s->reach)*share_inside(h/s->reach));
            most[k][i] = s->level + 0.5f*inside;
        }
    for (int z = 0; z < BLOCK_EDGE; z++)
        for (int y = 0; y < BLOCK_EDGE; y++) {
            const float by = s->per_particle*factor[2][z]*factor[1][y];
            const float top = most[2][z] < most[1][y] ? most[2][z] : most[1][y];
            for (int x = 0; x < BLOCK_EDGE; x++, node++) {
                const float sum = *node*by*factor[0][x], limit = top < most[0][x] ? top : most[0][x];
                *node = sum < limit ? sum : limit;
            }
        }
}

static void limit_blocks(const void *view, int64_t begin, int64_t end)
{
    const grid *s = view;
    for (int64_t b = begin; b < end; b++) {
        limit_block(s, b);
        if (s->f->clip) limit_sums(s, b, beyond_plane);
        if (s->f->nest) limit_sums(s, b, beyond_nests);
    }
}

/* The nodes of a block and the next ones. */
typedef struct apron { float node[APRON][APRON][APRON]; uint16_t inside[APRON][APRON]; } apron;

static bool fill_apron(const grid *s, int64_t b, apron *a)
{
    const int32_t *at = s->block[b];
    int any = 0, all = 1;
    for (int z = 0; z < APRON; z++)
        for (int y = 0; y < APRON; y++) {
            float *row = a->node[z][y];
            for (int part = 0; part < 2; part++) {
                const int p[3] = { at[0] + part, at[1] + y/BLOCK_EDGE, at[2] + z/BLOCK_EDGE };
                const bool there = p[0] < s->size[0] && p[1] < s->size[1] && p[2] < s->size[2];
                const int32_t from = there ? *block_at(s, p[0], p[1], p[2]) : -1;
                const int64_t offset = (z%BLOCK_EDGE*BLOCK_EDGE + y%BLOCK_EDGE)*BLOCK_EDGE;
                const float *node = from < 0 ? NULL : s->node + (int64_t)from*BLOCK_NODES + offset;
                for (int x = 0; x < (part ? 1 : BLOCK_EDGE); x++) row[part*BLOCK_EDGE
                                                                      + x] = node ? node[x] : 0;
            }
            int mask = 0;
            for (int x = 0; x < APRON; x++) mask |= (row[x] >= s->level) << x;
            a->inside[z][y] = (uint16_t)mask;
            any |= mask, all &= mask == (1 << APRON) - 1;
        }
    return any && !all;
}

/* Of the cells of a row: bit x is set if the surface goes through. */
static int crossed_cells(const apron *a, int y, int z)
{
    const int m[4] = { a->inside[z][y], a->inside[z][y + 1], a->inside[z + 1][y], a->inside[z + 1][y + 1] };
    const int any = m[0] | m[1] | m[2] | m[3], all = m[0] & m[1] & m[2] & m[3];
    return (any | any >> 1) & ~(all & all >> 1) & ((1 << BLOCK_EDGE) - 1);
}

/* Of the edges that begin at the nodes of a row: bit x is set if the surface goes through. */
static int crossed_edges(const apron *a, int y, int z, int axis)
{
    const int here = a->inside[z][y];
    const int there = axis == 0 ? here >> 1 : axis == 1 ? a->inside[z][y + 1] : a->inside[z + 1][y];
    return (here ^ there) & ((1 << BLOCK_EDGE) - 1);
}

static void count_crossings(const void *view, int64_t begin, int64_t end)
{
    const grid *s = view;
    apron a;
    for (int64_t b = begin; b < end; b++) {
        int64_t vertices = 0, quads = 0;
        const bool crossed = fill_apron(s, b, &a);
        for (int z = 0; z < BLOCK_EDGE && crossed; z++)
            for (int y = 0; y < BLOCK_EDGE; y++) {
                vertices += __builtin_popcount((unsigned)crossed_cells(&a, y, z));
                for (int k = 0; k < 3; k++) quads += __builtin_popcount((unsigned)crossed_edges(&a, y, z, k));
            }
        s->vertex[b + 1] = vertices;
        s->quad[b + 1] = quads;
    }
}

/* Where the surface cuts an edge of a cell, from the cell's first node; false: it does not. */
static bool find_crossing(const grid *s, const apron *a, const int at[3], int e, float out[3])
{
    const int axis = e/4, u = e & 1, w = e >> 1 & 1;
    const int from[3] = { axis == 0 ? 0 : u, axis == 1 ? 0 : axis == 0 ? u : w, axis == 2 ? 0 : w };
    const float p = a->node[at[2] + from[2]][at[1] + from[1]][at[0] + from[0]];
    const float q = a->node[at[2] + from[2] + (axis == 2)][at[1] + from[1] + (axis == 1)]
        [at[0] + from[0] + (axis == 0)];
    if ((p >= s->level) == (q >= s->level)) return false;
    const float t = (s->level - p)/(q - p);
    for (int k = 0; k < 3; k++) out[k] = (float)from[k] + (k == axis ? t : 0);
    return true;
}

/* The vertex of a cell: the mean of where the surface cuts its edges. Where a wall runs through the cell
   the vertex lies in it; where the free surface meets the wall, edges across the wall do not count. */
static void place_vertex(const grid *s, const apron *a, const int at[3], const int32_t block[3], int64_t v)
{
    float sum[2][3] = { { 0, 0, 0 }, { 0, 0, 0 } }, crossing[3], wall[3] = { 0, 0, 0 };
    int count[2] = { 0, 0 };
    uint8_t locked = 0;
    for (int k = 0; k < 3; k++)
        for (int side = 0; side < 2; side++) {
            const float cell = (float)(BLOCK_EDGE*block[k] + at[k]);
            if (!(s->wall[k][side] > cell && s->wall[k][side] < cell + 1)) continue;
            wall[k] = s->wall[k][side];
            locked |= (uint8_t)(1 << k);
        }
    for (int e = 0; e < 12; e++) {
        if (!find_crossing(s, a, at, e, crossing)) continue;
        const int across = locked >> e/4 & 1;
        for (int k = 0; k < 3; k++) sum[across][k] += crossing[k];
        count[across]++;
    }
    const int used = count[0] > 0 ? 0 : 1;
    for (int k = 0; k < 3; k++)
        s->point[v][k] = locked >> k & 1 ? wall[k]
            : (float)(BLOCK_EDGE*block[k] + at[k]) + sum[used][k]/(float)count[used];
    s->locked[v] = locked && used == 0 ? locked | WATERLINE : locked;
}

static void place_vertices(const void *view, int64_t begin, int64_t end)
{
    const grid *s = view;
    apron a;
    for (int64_t b = begin; b < end; b++) {
        int64_t v = s->vertex[b];
        if (v == s->vertex[b + 1]) continue;
        fill_apron(s, b, &a);
        int32_t *cell = s->cell + b*BLOCK_NODES;
        for (int z = 0; z < BLOCK_EDGE; z++)
            for (int y = 0; y < BLOCK_EDGE; y++) {
                const int crossed = crossed_cells(&a, y, z);
                for (int x = 0; x < BLOCK_EDGE; x++, cell++) {
                    if (!(crossed >> x & 1)) continue;
                    *cell = (int32_t)v;
                    place_vertex(s, &a, (int[3]){ x, y, z }, s->block[b], v++);
                }
            }
    }
}

/* The vertex of the cell at a place counted from a block's first cell, -1 to 7. */
static int32_t vertex_of(const grid *s, const int32_t block[3], int x, int y, int z)
{
    const int below[3] = { x < 0, y < 0, z < 0 };
    const int32_t b = *block_at(s, block[0] - below[0], block[1] - below[1], block[2] - below[2]);
    const int at = ((z & 7)*BLOCK_EDGE + (y & 7))*BLOCK_EDGE + (x & 7);
    return s->cell[(int64_t)b*BLOCK_NODES + at];
}

/* Around each edge that the surface cuts: the vertices of its four cells, anticlockwise from outside. */
static void make_quads(const void *view, int64_t begin, int64_t end)
{
    static const int turn[4][2] = { { -1, -1 }, { 0, -1 }, { 0, 0 }, { -1, 0 } };
    const grid *s = view;
    apron a;
    for (int64_t b = begin; b < end; b++) {
        int64_t q = s->quad[b];
        if (q == s->quad[b + 1]) continue;
        fill_apron(s, b, &a);
        for (int z = 0; z < BLOCK_EDGE; z++)
            for (int y = 0; y < BLOCK_EDGE; y++)
                for (int axis = 0; axis < 3; axis++)
                    for (int crossed = crossed_edges(&a, y, z, axis); crossed; crossed &= crossed - 1) {
                        const int x = __builtin_ctz((unsigned)crossed), at[3] = { x, y, z };
                        const int outward = a.inside[z][y] >> x & 1;
                        for (int k = 0; k < 4; k++) {
                            int c[3] = { at[0], at[1], at[2] };
                            c[(axis + 1)%3] += turn[k][0];
                            c[(axis + 2)%3] += turn[k][1];
                            s->corner[q][outward ? k : 3 - k] = vertex_of(s, s->block[b], c[0], c[1], c[2]);
                        }
                        q++;
                    }
    }
}

/* Moves each vertex by a share of the way to the mean of its neighbours; with shares of both signs the volume
   stays. Those in a wall have neighbours there, those of a waterline along it. An edge is in two quads, once
   in each direction. */
static void smooth(grid *s, float share)
{
    const int64_t vertices = s->vertex[s->blocks], quads = s->quad[s->blocks];
    float *weight = (float *)(void *)s->node;      /* no longer needed, and longer */
    memset(s->moved, 0, (size_t)vertices*sizeof *s->moved);
    memset(weight, 0, (size_t)vertices*sizeof *weight);
    for (int64_t q = 0; q < quads; q++)
        for (int k = 0; k < 4; k++) {
            const int32_t a = s->corner[q][k], b = s->corner[q][(k + 1) & 3];
            if ((s->locked[b] & s->locked[a]) != s->locked[a]) continue;
            for (int m = 0; m < 3; m++) s->moved[a][m] += s->point[b][m];
            weight[a]++;
        }
    for (int64_t v = 0; v < vertices; v++)
        for (int m = 0; m < 3 && weight[v] > 0; m++)
            if (!(s->locked[v] >> m & 1))
                s->point[v][m] += share*(s->moved[v][m]/weight[v] - s->point[v][m]);
}

static void add_up(int64_t *count, int64_t n)
{
    count[0] = 0;
    for (int64_t k = 0; k < n; k++) count[k + 1] += count[k];
}

/* Sums on all nodes; colours where the surface is or next to it. */
static bool sum_particles(grid *s, const surface_request *r, const vec *colors)
{
    const tile_kernels *k = s->c->kernels;
    s->node = malloc((size_t)s->blocks*BLOCK_NODES*sizeof *s->node);
    s->vertex = calloc((size_t)s->blocks + 1, sizeof *s->vertex);
    s->quad = calloc((size_t)s->blocks + 1, sizeof *s->quad);
    s->colored = malloc((size_t)(s->blocks + 1)*sizeof *s->colored);
    if (!s->node || !s->vertex || !s->quad || !s->colored) return false;
    node_view view = { (const int32_t (*)[3])s->block, s->first, s->entry, (const float (*)[3])s->place,
                       colors,
                       s->node, NULL, s->colored, s->reach, NULL, NULL };
    tobi_loop(s->c->threads, s->blocks, 1, k->sum_nodes, &view);
    if (r->joins || r->evens) {
        if (!view_weigh_particles(s, r)) return false;
        view.extra = s->extra, view.touched = s->touched;
        tobi_loop(s->c->threads, s->blocks, 1, k->sum_nodes, &view);
    }
    tobi_loop(s->c->threads, s->blocks, 0, limit_blocks, s);
    tobi_loop(s->c->threads, s->blocks, 1, count_crossings, s);
    for (int64_t b = 0; b < s->blocks; b++)
        s->colored[b] = s->vertex[b + 1] > 0 ? (int32_t)s->colored_count++ : -1;
    if (!r->color) return true;
    view.colors = s->colors = malloc((size_t)(s->colored_count*4*BLOCK_NODES + 1)*sizeof *s->colors);
    if (!s->colors) return false;
    tobi_loop(s->c->threads, s->blocks, 1, k->sum_colors, &view);
    return true;
}

static bool make_mesh(grid *s)
{
    add_up(s->vertex, s->blocks);
    add_up(s->quad, s->blocks);
    const size_t vertices = (size_t)s->vertex[s->blocks], quads = (size_t)s->quad[s->blocks];
    s->cell = malloc((size_t)s->blocks*BLOCK_NODES*sizeof *s->cell);
    s->point = malloc((vertices + 1)*sizeof *s->point);
    s->moved = malloc((vertices + 1)*sizeof *s->moved);
    s->locked = malloc(vertices + 1);
    s->corner = malloc((quads + 1)*sizeof *s->corner);
    if (!s->cell || !s->point || !s->moved || !s->locked || !s->corner) return false;
    tobi_loop(s->c->threads, s->blocks, 0, place_vertices, s);
    tobi_loop(s->c->threads, s->blocks, 0, make_quads, s);
    return true;
}

/* Whether the eye is inside of the surface. */
static bool is_around(const grid *s, const double eye[3])
{
    float place[3];
    for (int k = 0; k < 3; k++) {
        const double at = (eye[k] - s->low[k])/s->edge;
        if (!(at >= 1 && at < s->size[k]*BLOCK_EDGE - 1)) return false;
        place[k] = (float)at;
    }
    for (int n = 0; n < 8; n++)
        if (*block_at(s, ((int)place[0] + (n & 1))/BLOCK_EDGE, ((int)place[1] + (n >> 1 & 1))/BLOCK_EDGE,
                      ((int)place[2] + (n >> 2))/BLOCK_EDGE) < 0)
            return false;
    return view_sum_at(s, place) > s->level;
}

tobi_status view_add_surface(geometry *g, geometry *drops, const canvas *c, const surface_request *r,
                             bool *around,
                             tobi_error *err)
{
    grid s = { .c = c, .f = r->f, .level = r->level, .nest = r->nest };
    double low[3], high[3];
    vec *colors = NULL;
    bool enough = true;
    const bool any = find_extent(r, low, high);
    if (any) {
        place_grid(&s, r, low, high);
        const float spacings = s.reach*(float)(s.edge/(2*r->radius));
        s.per_particle = 1/(spacings*spacings*spacings*12.566371f*16/315);
        s.place = malloc((size_t)(r->count + 1)*sizeof *s.place);
        colors = r->color ? malloc((size_t)(r->count + 1)*sizeof *colors) : NULL;
        enough = s.place && (!r->color || colors);
        if (enough) place_particles(&s, r);
        for (int64_t i = 0; enough && colors && i < r->count; i++) colors[i] = r->color[r->row[i]];
        enough = enough && make_blocks(&s, r->count) && list_particles(&s, r->count) &&
                 sum_particles(&s, r, colors) && make_mesh(&s);
    }
    *around = enough && any && is_around(&s, c->camera.eye);
    if (enough && r->drop > 0) enough = view_add_drops(&s, r, drops);
    for (int k = 0; k < 2*ROUNDS && enough && any; k++) smooth(&s, k & 1 ? -0.52f : 0.5f);
    if (enough && any) enough = view_add_faces(&s, r, g);
    free(colors);
    free_grid(&s);
    return enough ? TOBI_OK : tobi_fail(err, TOBI_NO_MEMORY, "no memory for a picture");
}
