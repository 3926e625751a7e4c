/* A cut is memory of particles: the side on which each lies of the edge that passed it. Nodes with
   both sides get a second velocity, where cuts cross more. Drawback: a particle remembers three cuts only. */
#include "mpm/cut/cut.h"
#include "base/error.h"
#include "mpm/cut/blade.h"
#include "mpm/cut/cuts.h"
#include "mpm/particle_fields.h"
#include "exec/rows.h"
#include "geom/vec3.h"
#include "mpm/cut/majority.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

void mpm_cut_free(mpm_cut *c)
{
    tobi_array_free(c->side);
    tobi_array_free(c->cut_face);
    tobi_array_free(c->tile);
    tobi_array_free(c->face);
    for (int l = 0; l < MPM_LEVELS; l++) tobi_array_free(c->hidden[l]);
    tobi_array_free(c->member);
    tobi_array_free(c->members);
    tobi_array_free(c->extent);
    free(c->rows);
    mpm_cross_free(&c->cross);
    memset(c, 0, sizeof *c);
}

static int nodes_of(const mpm_grid *g) { return g->dimension == 3 ? MPM_NODES_3D : MPM_NODES_2D; }

static tobi_status reserve(mpm_cut *c, const mpm_grid *g, int64_t particles, tobi_error *err)
{
    int64_t nodes = g->patch_room*nodes_of(g);
    if (nodes > c->node_room) {
        tobi_array_free(c->side);
        tobi_array_free(c->cut_face);
        tobi_array_free(c->cross.doubt);
        c->cross.doubt = tobi_array_make(g->patch_room, sizeof *c->cross.doubt);
        c->side = tobi_array_make(nodes, sizeof *c->side);
        c->cut_face = tobi_array_make(nodes, sizeof *c->cut_face);
        c->node_room = c->side && c->cut_face && c->cross.doubt ? nodes : 0;
    }
    if (particles > c->particle_room) {
        int hidden = 1;
        tobi_array_free(c->face);
        tobi_array_free(c->member);
        for (int l = 0; l < MPM_LEVELS; l++) {
            tobi_array_free(c->hidden[l]);
            c->hidden[l] = tobi_array_zero(particles, sizeof *c->hidden[l]);
            hidden &= c->hidden[l] != NULL;
        }
        c->member = tobi_array_make(particles, sizeof *c->member);
        c->face = tobi_array_make(particles, sizeof *c->face);
        c->particle_room = c->face && hidden && c->member ? particles : 0;
    }
    if (g->block_room > c->block_room) {
        tobi_array_free(c->members);
        tobi_array_free(c->extent);
        c->members = tobi_array_make(g->block_room, sizeof *c->members);
        c->extent = tobi_array_make(g->block_room, sizeof *c->extent);
        c->block_room = c->members && c->extent ? g->block_room : 0;
    }
    if (c->node_room >= nodes && c->particle_room >= particles && c->block_room >= g->block_room)
        return TOBI_OK;
    return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the cuts of %lld particles", (long long)particles);
}

/* How far from a cut a particle may feel nodes beyond it, however the material turns, m; a quarter of a cell
   more for its being compressed. */
static double find_band(int dimension, double cell) { return (1.5*sqrt(dimension) + 0.25)*cell; }

/* The particle remembers the cut. A full memory forgets the farthest. */
static void remember(tobi_columns *cuts, const double f[3][3], double number, const tobi_blade_place *at,
                     double least)
{
    double back[3], square, side = at->aside < 0 ? -1 : 1, size = fmax(fabs(at->aside), least);
    int k = 0;
    for (; k < TOBI_CUTS_EACH && cuts->c[k].w != 0; k++)
        if (fabs(cuts->c[k].w) == number) return;
    for (int a = 0; a < 3; a++)
        back[a] = side*(f[0][a]*at->normal[0] + f[1][a]*at->normal[1] + f[2][a]*at->normal[2]);
    square = vec3_dot(back, back);
    if (!(square > 0)) return;
    tobi_float4 mark = {(float)(back[0]*size/square), (float)(back[1]*size/square),
                        (float)(back[2]*size/square), (float)(side*number)};
    if (k == TOBI_CUTS_EACH) {
        double far = mark.x*mark.x + mark.y*mark.y + mark.z*mark.z;
        for (int n = 0; n < TOBI_CUTS_EACH; n++) {
            const tobi_float4 *c = &cuts->c[n];
            double d = c->x*c->x + c->y*c->y + c->z*c->z;
            if (d > far) { far = d; k = n; }
        }
        if (k == TOBI_CUTS_EACH) return;
    }
    cuts->c[k] = mark;
}

static int can_be_cut(int model) { return model != TOBI_LIQUID && model != TOBI_SAND; }

typedef struct marking {
    tobi_system *s;
    const tobi_body *b;
    const mpm_view *v;
    double band, mine, low[3], high[3];
    int *met;
} marking;

static void mark_particles(const void *view, int64_t begin, int64_t end)
{
    const marking *m = view;
    const mpm_view *v = m->v;
    const int dim = m->s->box.dimension;
    const double least = 1e-3*m->s->smoothing.spacing;
    int met = 0;
    for (int64_t i = begin; i < end; i++) {
        const double x[3] = {v->position[i].x, v->position[i].y, v->position[i].z};
        tobi_blade_place at;
        double f[3][3];
        int out = !can_be_cut(v->material[v->solid[i]].model);
        for (int a = 0; a < dim; a++) out |= x[a] < m->low[a] || x[a] > m->high[a];
        if (out || !tobi_blade_locate_world(m->b, dim, x, &at)) continue;
        if (at.beyond > 0.25*v->cell || fabs(at.aside) > m->band || fabs(at.ahead) > v->cell) continue;
        met = 1;
        if (at.ahead > 0) continue;
        mpm_majority_deformation(v, i, f);
        remember(&mpm_fields_of(&m->s->particles)->cuts[i], f, m->mine, &at, least);
    }
    if (met) __atomic_store_n(m->met, 1, __ATOMIC_RELAXED);
}

/* One blade. A blade that meets no material ends its cut; the next one it makes has a new number. */
static void mark_blade(tobi_system *s, tobi_body *b, const mpm_view *v, double *number)
{
    const double mine = b->rigid.cut > 0 ? b->rigid.cut : *number + 1;
    int met = 0, dim = s->box.dimension;
    marking view = { .s = s, .b = b, .v = v, .band = find_band(dim, v->cell), .mine = mine, .met = &met };
    tobi_blade_update(b, dim);
    tobi_blade_box(b, view.band, view.low, view.high);
    tobi_loop(s->sim->exec.threads, s->particles.count, 0, mark_particles, &view);
    b->rigid.cut = met ? mine : 0;
    if (met) *number = fmax(*number, mine);
}

void mpm_cut_mark(tobi_system *s, const mpm_view *v, double *number)
{
    for (int k = 0; k < s->sim->body_count; k++)
        if (s->sim->bodies[k].blade) mark_blade(s, &s->sim->bodies[k], v, number);
}

/* Place of the node in row x, y and column z of a block's tile: -1 .. 6 of its own counting. */
static int tile_place(int x, int y, int z, int dim) { return dim == 3 ? (x*8 + y)*8 + z : x*8 + y; }

/* The sides of the nodes around a block, as its first tile. */
static void copy_sides(const mpm_cut *c, const mpm_block *b, float *tile, int dim)
{
    const int deep = dim == 3 ? 8 : 1;
    for (int x = 0; x < 8; x++)
        for (int y = 0; y < 8; y++)
            for (int z = 0; z < deep; z++) {
                const int o = ((x + 3)/4*3 + (y + 3)/4)*3 + (dim == 3 ? (z + 3)/4 : 1);
                const int row = (x + 3)%4*4 + (y + 3)%4;
                tile[tile_place(x, y, z, dim)] =
                    c->side[(int64_t)b->around[o]*(dim == 3 ? MPM_NODES_3D : MPM_NODES_2D) +
                            (dim == 3 ? row*4 + (z + 3)%4 : row)];
            }
}

/* Tiles of sides of a block with so many levels. */
static int count_tiles(int levels)
{
    const int twins = (1 << levels) - 1;
    return levels > 1 ? (1 + MPM_NEIGHBORS)*twins : twins;
}

/* The marks of the deeper levels around a block and the neighbors, as its other tiles. */
static void copy_marks(const mpm_cut *c, const mpm_block *b, float *tile, int dim)
{
    const int three = dim == 3, nodes = three ? MPM_NODES_3D : MPM_NODES_2D;
    const int twins = (1 << b->levels) - 1;
    memset(tile + MPM_SIDES, 0, (size_t)(count_tiles(b->levels) - 1)*MPM_SIDES*sizeof *tile);
    for (int o = 0; o < 27; o++) {
        if (b->around[o] < 0) continue;
        const int64_t first = (int64_t)b->around[o]*nodes;
        for (int64_t k = mpm_cross_first(&c->cross, first);
             k < c->cross.count && c->cross.at[k].node < first + nodes; k++) {
            const mpm_crossing *at = &c->cross.at[k];
            const int n = (int)(at->node - first);
            const int x = o/9*4 - 3 + (three ? n/16 : n/4), y = o/3%3*4 - 3 + (three ? n/4%4 : n%4),
                      z = three ? o%3*4 - 3 + n%4 : 0;
            if (x < 0 || y < 0 || z < 0 || x > 7 || y > 7 || z > 7) continue;
            float *to = tile + tile_place(x, y, z, dim);
            for (int m = 1; m < twins; m++) to[m*MPM_SIDES] = at->mark[m];
            for (int m = 0; m < MPM_NEIGHBORS*twins; m++)
                to[(twins + m)*MPM_SIDES] = at->neighbor[m/twins][m%twins];
        }
    }
}

enum { MOST = 16 };                    /* sides that a block of particles is asked about          */

/* Adds a side to a list if it is not there; 0 if the list is full. */
static int note(float list[MOST], int *count, float side)
{
    int n = 0;
    while (n < *count && list[n] != side) n++;
    if (n == MOST) return 0;
    list[n] = side;
    if (n == *count) ++*count;
    return 1;
}

/* Lists the sides whose nodes may be hidden from particles of a block; -1: too many. */
static int list_other_sides(const mpm_view *v, const mpm_block *b, float other[MOST])
{
    int count = 0;
    for (int64_t i = b->begin; i < b->end; i++) {
        if (v->apart && !note(other, &count, mpm_side_of(v->material[v->solid[i]].group))) return -1;
        for (int k = 0; v->cuts && k < TOBI_CUTS_EACH && v->cuts[i].c[k].w != 0; k++)
            if (!note(other, &count, -v->cuts[i].c[k].w)) return -1;
    }
    return count;
}

/* Whether a particle of the block may have a node of its tile hidden from it: 1 for each that is so. */
static int hides(const mpm_view *v, const mpm_block *b, const float *tile, int nodes)
{
    float other[MOST];
    const int count = list_other_sides(v, b, other);
    int found = count < 0;
    for (int k = 0; k < count; k++)
        for (int n = 0; n < nodes; n++) found |= tile[n] == other[k];
    return found;
}

/* What the loops over blocks need. */
typedef struct splitting { mpm_cut *c; mpm_grid *g; const mpm_view *v; } splitting;

static void fill_tiles(const void *view, int64_t begin, int64_t end)
{
    const splitting *s = view;
    const mpm_grid *g = s->g;
    const int nodes = g->dimension == 3 ? MPM_TILE_3D : MPM_TILE_2D;
    for (int64_t k = begin; k < end; k++) {
        mpm_block *b = &g->block[k];
        if (b->levels == 0) continue;
        float *tile = s->c->tile + (int64_t)b->sides*MPM_SIDES;
        copy_sides(s->c, b, tile, g->dimension);
        if (b->levels > 1) copy_marks(s->c, b, tile, g->dimension);
        else b->levels = hides(s->v, b, tile, nodes);
    }
}

/* Finds the levels of the particle blocks, and gives those that have any tiles of sides. */
static tobi_status find_split(mpm_cut *c, mpm_grid *g, const mpm_view *v, const tobi_exec *x, tobi_error *err)
{
    const splitting view = { c, g, v };
    c->tile_count = 0;
    for (int64_t k = 0; k < g->block_count; k++) {
        mpm_block *b = &g->block[k];
        b->levels = 0;
        for (int o = 0; o < 27 && (v->apart || c->members[k] > 0); o++)
            if (b->around[o] >= 0 && g->patch[b->around[o]].levels > b->levels)
                b->levels = g->patch[b->around[o]].levels;
        b->sides = b->levels > 0 ? (int32_t)c->tile_count : -1;
        c->tile_count += count_tiles(b->levels);
    }
    if (c->tile_count > c->tile_room) {
        tobi_array_free(c->tile);
        c->tile_room = c->tile_count + c->tile_count/4 + 8;
        c->tile = tobi_array_zero(c->tile_room*MPM_SIDES, sizeof *c->tile);
        if (!c->tile) {
            c->tile_room = 0;
            return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the cuts of %lld blocks",
                             (long long)c->tile_count);
        }
    }
    tobi_loop(tobi_team(x, c->tile_count, 4), g->block_count, 4, fill_tiles, &view);
    return TOBI_OK;
}

/* Numbers the twins of the node blocks. */
static void number_patches(mpm_grid *g)
{
    g->patch_twins = g->levels = 0;
    for (int64_t k = 0; k < g->patch_count; k++) {
        mpm_patch *p = &g->patch[k];
        p->twin = p->levels > 0 ? (int32_t)(g->patch_count + g->patch_twins) : -1;
        g->patch_twins += (1 << p->levels) - 1;
        if (p->levels > g->levels) g->levels = p->levels;
    }
}

/* and of the blocks of particles. */
static void number_blocks(mpm_grid *g)
{
    g->block_twins = 0;
    for (int64_t k = 0; k < g->block_count; k++) {
        mpm_block *b = &g->block[k];
        b->twin = b->levels > 0 ? (int32_t)(g->block_count + g->block_twins) : -1;
        g->block_twins += (1 << b->levels) - 1;
    }
}

/* Index of velocity q of a node block, by as many bits as it has levels. */
static int32_t patch_of(const mpm_grid *g, int32_t patch, int q)
{
    const mpm_patch *p = &g->patch[patch];
    q &= (1 << p->levels) - 1;
    return q ? p->twin + q - 1 : patch;
}

static void make_twins(mpm_grid *g)
{
    for (int64_t k = 0; k < g->block_count; k++) {
        const mpm_block *b = &g->block[k];
        for (int q = 1; q < 1 << b->levels; q++) {
            mpm_block *t = &g->block[b->twin + q - 1];
            *t = *b;
            t->begin = t->end = 0;
            t->twin = -1;
            t->levels = 0;
            for (int o = 0; o < 27; o++)
                if (b->around[o] >= 0) t->around[o] = patch_of(g, b->around[o], q);
        }
    }
    for (int64_t k = 0; k < g->patch_count; k++) {
        const mpm_patch *p = &g->patch[k];
        for (int q = 1; q < 1 << p->levels; q++) {
            mpm_patch *t = &g->patch[p->twin + q - 1];
            *t = *p;
            t->twin = -1;
            t->levels = 0;
            for (int o = 0; o < 27; o++) {
                const mpm_block *b = p->cover[o] >= 0 ? &g->block[p->cover[o]] : NULL;
                t->cover[o] = b && q < 1 << b->levels ? b->twin + q - 1 : -1;
            }
        }
    }
}

/* Packs the cut faces of the nodes with a side at which no cuts cross. */
static void list_cut_faces(mpm_cut *c, const mpm_grid *g)
{
    const int nodes = nodes_of(g);
    int64_t crossing = 0;
    c->cut_face_count = 0;
    for (int64_t k = 0; k < g->patch_count; k++)
        for (int n = 0; n < nodes && g->patch[k].twin >= 0; n++) {
            if (c->side[k*nodes + n] == 0) continue;
            if (crossing < c->cross.count && c->cross.at[crossing].node == k*nodes + n) {
                crossing++;
                continue;
            }
            mpm_cut_face *cut_face = &c->cut_face[c->cut_face_count++];
            *cut_face = c->cut_face[k*nodes + n];
            cut_face->first = (int32_t)(k*nodes + n);
            cut_face->second = (int32_t)(g->patch[k].twin*(int64_t)nodes + n);
        }
}

static void list_members(const void *view, int64_t begin, int64_t end)
{
    const splitting *s = view;
    const mpm_grid *g = s->g;
    for (int64_t k = begin; k < end; k++) {
        mpm_majority_list(s->c, s->v, &g->block[k], k, g->dimension);
        if (s->v->apart) s->c->extent[k] = mpm_solid_contact_look(s->v, &g->block[k], g->dimension);
    }
}

static void find_majorities(const void *view, int64_t begin, int64_t end)
{
    const splitting *s = view;
    const mpm_cut *c = s->c;
    const mpm_grid *g = s->g;
    const int nodes = nodes_of(g);
    for (int64_t k = begin; k < end; k++) {
        g->patch[k].levels = mpm_majority_count(s->c, g, s->v, k);
        if (s->v->apart)
            g->patch[k].levels |= mpm_solid_contact_find(g, s->v, c->extent, &g->patch[k], c->side + k*nodes,
                                                c->cut_face + k*nodes);
    }
}

/* Twins of the blocks that need them, once the sides are known. */
static tobi_status split_blocks(mpm_cut *c, tobi_system *s, mpm_grid *g, const mpm_view *v,
                                tobi_error *err)
{
    number_patches(g);
    mpm_cross_place(&c->cross, g);
    list_cut_faces(c, g);
    TOBI_TRY(find_split(c, g, v, &s->sim->exec, err));
    number_blocks(g);
    TOBI_TRY(mpm_grid_reserve_twins(g, &s->sim->exec, err));
    make_twins(g);
    memset(c->hidden[0], 0, (size_t)s->particles.count*sizeof *c->hidden[0]);
    return TOBI_OK;
}

tobi_status mpm_cut_find(mpm_cut *c, tobi_system *s, mpm_grid *g, const mpm_view *v, tobi_error *err)
{
    const splitting view = { c, g, v };
    TOBI_TRY(reserve(c, g, s->particles.capacity, err));
    tobi_loop(s->sim->exec.threads, g->block_count, 0, list_members, &view);
    tobi_loop(s->sim->exec.threads, g->patch_count, 8, find_majorities, &view);
    TOBI_TRY(mpm_cross_find(c, &s->sim->exec, g, v, err));
    return split_blocks(c, s, g, v, err);
}

tobi_status mpm_cut_restore(mpm_cut *c, tobi_system *s, mpm_grid *g, const mpm_view *v, tobi_error *err)
{
    const splitting view = { c, g, v };
    TOBI_TRY(reserve(c, g, s->particles.capacity, err));
    TOBI_TRY(mpm_cut_read(c, g, err));
    tobi_loop(s->sim->exec.threads, g->block_count, 0, list_members, &view);
    return split_blocks(c, s, g, v, err);
}

typedef struct visiting {
    const mpm_cut *c;
    tobi_float4 *node;
    double dt;
    mpm_visit what;
    double *part;                      /* J, lost in each block of cut faces */
} visiting;

static void visit_parts(const void *view, int64_t begin, int64_t end)
{
    const visiting *v = view;
    const int64_t count = v->c->cut_face_count;
    for (int64_t q = begin; q < end; q++) {
        const int64_t last = (q + 1)*TOBI_BLOCK;
        v->part[q] = mpm_cut_faces_visit(v->c->cut_face, q*TOBI_BLOCK, last < count ? last : count, v->node,
                                         v->dt,
                                     v->what);
    }
}

/* A walk over the cut faces and over the nodes where cuts cross. */
static double visit(mpm_cut *c, tobi_exec *x, const mpm_grid *g, double dt, mpm_visit what)
{
    const int64_t parts = (c->cut_face_count + TOBI_BLOCK - 1)/TOBI_BLOCK;
    double *part = x->partial, lost = 0;
    const visiting view = { c, g->node, dt, what, part };
    tobi_loop(tobi_team(x, parts, 8), parts, 0, visit_parts, &view);
    for (int64_t q = 0; q < parts; q++) lost += part[q];
    return lost + mpm_cross_visit(&c->cross, x, g->node, dt, what);
}

void mpm_cut_begin(mpm_cut *c, tobi_exec *x, const mpm_grid *g, double dt) { visit(c, x, g, dt, MPM_BEGIN); }

void mpm_cut_sweep(mpm_cut *c, tobi_exec *x, const mpm_grid *g, double dt) { visit(c, x, g, dt, MPM_PRESS); }

double mpm_cut_finish(mpm_cut *c, tobi_exec *x, const mpm_grid *g, double dt)
{
    return visit(c, x, g, dt, MPM_FINISH);
}
