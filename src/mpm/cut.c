#include "mpm/cut.h"
#include "base/error.h"
#include "core/blade.h"
#include "core/cuts.h"
#include "exec/rows.h"
#include "geom/vec3.h"
#include "mpm/vote.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

void mpm_cut_free(mpm_cut *c)
{
    free(c->side);
    free(c->seam);
    free(c->tile);
    free(c->face);
    free(c->hidden);
    free(c->voter);
    free(c->voters);
    free(c->crowd);
    free(c->rows);
    memset(c, 0, sizeof *c);
}

static int nodes_of(const mpm_grid *g) { return g->dimension == 3 ? MPM_NODES_3D : MPM_NODES_2D; }

static tobi_status reserve(mpm_cut *c, const mpm_grid *g, int64_t particles, tobi_error *err)
{
    int64_t nodes = g->patch_room*nodes_of(g);
    if (nodes > c->node_room) {
        free(c->side);
        free(c->seam);
        c->side = malloc((size_t)nodes*sizeof *c->side);
        c->seam = malloc((size_t)nodes*sizeof *c->seam);
        c->node_room = c->side && c->seam ? nodes : 0;
    }
    if (particles > c->particle_room) {
        free(c->face);
        free(c->hidden);
        free(c->voter);
        c->voter = malloc((size_t)particles*sizeof *c->voter);
        c->face = malloc((size_t)particles*sizeof *c->face);
        c->hidden = calloc((size_t)particles, sizeof *c->hidden);
        c->particle_room = c->face && c->hidden && c->voter ? particles : 0;
    }
    if (g->block_room > c->block_room) {
        free(c->voters);
        free(c->crowd);
        c->voters = malloc((size_t)g->block_room*sizeof *c->voters);
        c->crowd = malloc((size_t)g->block_room*sizeof *c->crowd);
        c->block_room = c->voters && c->crowd ? g->block_room : 0;
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

/* One blade. A blade that meets no material ends its cut; the next one it makes has a new number. */
static void mark_blade(tobi_simulation *s, tobi_body *b, const mpm_view *v, double *number)
{
    const double cell = v->cell, band = find_band(s->box.dimension, cell), least = 1e-3*s->smoothing.spacing;
    const double mine = b->rigid.cut > 0 ? b->rigid.cut : *number + 1;
    double low[3], high[3];
    int met = 0, dim = s->box.dimension;
    tobi_blade_bring(b, dim);
    tobi_blade_box(b, band, low, high);
    #pragma omp parallel for num_threads(s->exec.threads) reduction(|: met)
    for (int64_t i = 0; i < s->particles.count; i++) {
        const double x[3] = {v->position[i].x, v->position[i].y, v->position[i].z};
        tobi_blade_place at;
        double f[3][3];
        int out = !can_be_cut(v->material[v->solid[i]].model);
        for (int a = 0; a < dim; a++) out |= x[a] < low[a] || x[a] > high[a];
        if (out || !tobi_blade_locate_world(b, dim, x, &at)) continue;
        if (at.beyond > 0.25*cell || fabs(at.aside) > band || fabs(at.ahead) > cell)
            continue;
        met = 1;
        if (at.ahead > 0) continue;
        mpm_vote_deformation(v, i, f);
        remember(&s->particles.cuts[i], f, mine, &at, least);
    }
    b->rigid.cut = met ? mine : 0;
    if (met) *number = fmax(*number, mine);
}

void mpm_cut_mark(tobi_simulation *s, const mpm_view *v, double *number)
{
    for (int k = 0; k < s->body_count; k++)
        if (s->bodies[k].blade) mark_blade(s, &s->bodies[k], v, number);
}

/* The sides of the nodes around a block, as its tile. */
static void copy_sides(const mpm_cut *c, const mpm_block *b, float *tile, int dim)
{
    const int deep = dim == 3 ? 8 : 1;
    for (int x = 0; x < 8; x++)
        for (int y = 0; y < 8; y++)
            for (int z = 0; z < deep; z++) {
                const int o = ((x + 3)/4*3 + (y + 3)/4)*3 + (dim == 3 ? (z + 3)/4 : 1);
                const int row = (x + 3)%4*4 + (y + 3)%4;
                tile[dim == 3 ? (x*8 + y)*8 + z : x*8 + y] =
                    c->side[(int64_t)b->around[o]*(dim == 3 ? MPM_NODES_3D : MPM_NODES_2D) +
                            (dim == 3 ? row*4 + (z + 3)%4 : row)];
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

/* Whether a particle of the block may have a node of its tile hidden from it: 1 for each that is so. */
static int hides(const mpm_view *v, const mpm_block *b, const float *tile, int nodes)
{
    float other[MOST];
    int count = 0, found = 0;
    for (int64_t i = b->begin; i < b->end; i++) {
        if (v->apart && !note(other, &count, mpm_side_of(v->material[v->solid[i]].group))) return 1;
        for (int k = 0; v->cuts && k < TOBI_CUTS_EACH && v->cuts[i].c[k].w != 0; k++)
            if (!note(other, &count, -v->cuts[i].c[k].w)) return 1;
    }
    for (int k = 0; k < count; k++)
        for (int n = 0; n < nodes; n++) found |= tile[n] == other[k];
    return found;
}

/* Marks the particle blocks that need a twin, as twin == 1, and gives them tiles of sides. */
static tobi_status find_split(mpm_cut *c, mpm_grid *g, const mpm_view *v, const tobi_exec *x, tobi_error *err)
{
    const int nodes = g->dimension == 3 ? MPM_TILE_3D : MPM_TILE_2D;
    c->tile_count = 0;
    for (int64_t k = 0; k < g->block_count; k++) {
        mpm_block *b = &g->block[k];
        b->twin = 0;
        for (int o = 0; o < 27 && (v->apart || c->voters[k] > 0); o++)
            b->twin |= b->around[o] >= 0 && g->patch[b->around[o]].twin >= 0;
        b->sides = b->twin ? (int32_t)c->tile_count++ : -1;
    }
    if (c->tile_count > c->tile_room) {
        free(c->tile);
        c->tile_room = c->tile_count + c->tile_count/4 + 8;
        c->tile = calloc((size_t)c->tile_room*MPM_SIDES, sizeof *c->tile);
        if (!c->tile) {
            c->tile_room = 0;
            return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the cuts of %lld blocks",
                             (long long)c->tile_count);
        }
    }
    #pragma omp parallel for num_threads(tobi_team(x, c->tile_count, 4)) schedule(dynamic, 4)
    for (int64_t k = 0; k < g->block_count; k++) {
        mpm_block *b = &g->block[k];
        if (!b->twin) continue;
        copy_sides(c, b, c->tile + (int64_t)b->sides*MPM_SIDES, g->dimension);
        b->twin = hides(v, b, c->tile + (int64_t)b->sides*MPM_SIDES, nodes);
    }
    return TOBI_OK;
}

/* Numbers the twins of the node blocks with two velocities. */
static void number_patches(mpm_grid *g)
{
    g->patch_twins = 0;
    for (int64_t k = 0; k < g->patch_count; k++)
        g->patch[k].twin = g->patch[k].twin == 1 ? (int32_t)(g->patch_count + g->patch_twins++) : -1;
}

/* Twins of the particle blocks that find_split has marked, and of the node blocks. */
static void make_twins(mpm_grid *g)
{
    g->block_twins = 0;
    for (int64_t k = 0; k < g->block_count; k++) {
        mpm_block *b = &g->block[k];
        b->twin = b->twin ? (int32_t)(g->block_count + g->block_twins++) : -1;
        if (b->twin < 0) continue;
        mpm_block *t = &g->block[b->twin];
        *t = *b;
        t->begin = t->end = 0;
        t->twin = -1;
        for (int o = 0; o < 27; o++) {
            const int32_t twin = b->around[o] >= 0 ? g->patch[b->around[o]].twin : -1;
            if (twin >= 0) t->around[o] = twin;
        }
    }
    for (int64_t k = 0; k < g->patch_count; k++) {
        const mpm_patch *p = &g->patch[k];
        if (p->twin < 0) continue;
        mpm_patch *t = &g->patch[p->twin];
        *t = *p;
        t->twin = -1;
        for (int o = 0; o < 27; o++) t->cover[o] = p->cover[o] >= 0 ? g->block[p->cover[o]].twin : -1;
    }
}

/* Packs the seams of the nodes with a side. */
static void list_seams(mpm_cut *c, const mpm_grid *g)
{
    const int nodes = nodes_of(g);
    c->seam_count = 0;
    for (int64_t k = 0; k < g->patch_count; k++)
        for (int n = 0; n < nodes && g->patch[k].twin >= 0; n++) {
            if (c->side[k*nodes + n] == 0) continue;
            mpm_seam *seam = &c->seam[c->seam_count++];
            *seam = c->seam[k*nodes + n];
            seam->first = (int32_t)(k*nodes + n);
            seam->second = (int32_t)(g->patch[k].twin*(int64_t)nodes + n);
        }
}

static void look_at_blocks(mpm_cut *c, const tobi_simulation *s, const mpm_grid *g, const mpm_view *v)
{
    #pragma omp parallel for num_threads(s->exec.threads)
    for (int64_t k = 0; k < g->block_count; k++) {
        mpm_vote_list(c, v, &g->block[k], k, g->dimension);
        if (v->apart) c->crowd[k] = mpm_meet_look(v, &g->block[k], g->dimension);
    }
}

/* Twins of the blocks that need them, once the sides are known. */
static tobi_status split_blocks(mpm_cut *c, tobi_simulation *s, mpm_grid *g, const mpm_view *v,
                                tobi_error *err)
{
    number_patches(g);
    list_seams(c, g);
    TOBI_TRY(find_split(c, g, v, &s->exec, err));
    make_twins(g);
    memset(c->hidden, 0, (size_t)s->particles.count*sizeof *c->hidden);
    return TOBI_OK;
}

tobi_status mpm_cut_find(mpm_cut *c, tobi_simulation *s, mpm_grid *g, const mpm_view *v, tobi_error *err)
{
    const int nodes = nodes_of(g);
    TOBI_TRY(reserve(c, g, s->particles.capacity, err));
    look_at_blocks(c, s, g, v);
    #pragma omp parallel for num_threads(s->exec.threads) schedule(dynamic, 8)
    for (int64_t k = 0; k < g->patch_count; k++) {
        g->patch[k].twin = mpm_vote_count(c, g, v, k);
        if (v->apart)
            g->patch[k].twin |= mpm_meet_find(g, v, c->crowd, &g->patch[k], c->side + k*nodes,
                                              c->seam + k*nodes);
    }
    return split_blocks(c, s, g, v, err);
}

tobi_status mpm_cut_keep(const mpm_cut *c, double **rows, int64_t *count, tobi_error *err)
{
    *count = c->rows ? c->row_count : c->seam_count;       /* loaded and not run since */
    *rows = malloc((size_t)(*count + 1)*TOBI_RECALL_ROW*sizeof **rows);
    if (!*rows)
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld nodes with two velocities",
                         (long long)*count);
    if (c->rows) memcpy(*rows, c->rows, (size_t)*count*TOBI_RECALL_ROW*sizeof **rows);
    for (int64_t k = 0; k < *count && !c->rows; k++) {
        const mpm_seam *m = &c->seam[k];
        const double row[TOBI_RECALL_ROW] = {m->first, c->side[m->first], m->normal[0], m->normal[1],
                                             m->normal[2], m->gap, m->friction, m->fixed};
        memcpy(*rows + TOBI_RECALL_ROW*k, row, sizeof row);
    }
    return TOBI_OK;
}

tobi_status mpm_cut_recall(mpm_cut *c, tobi_simulation *s, mpm_grid *g, const mpm_view *v, tobi_error *err)
{
    const int nodes = nodes_of(g);
    TOBI_TRY(reserve(c, g, s->particles.capacity, err));
    memset(c->side, 0, (size_t)(g->patch_count*nodes)*sizeof *c->side);
    for (int64_t k = 0; k < g->patch_count; k++) g->patch[k].twin = 0;
    for (int64_t i = 0; i < c->row_count; i++) {
        const double *row = c->rows + TOBI_RECALL_ROW*i;
        if (!(row[0] >= 0 && row[0] < (double)(g->patch_count*nodes)))
            return tobi_fail(err, TOBI_DAMAGED,
                             "the checkpoint remembers a cut at node %g, the grid has %lld", row[0],
                             (long long)(g->patch_count*nodes));
        const int64_t k = (int64_t)row[0];
        g->patch[k/nodes].twin = 1;
        c->side[k] = (float)row[1];
        c->seam[k] = (mpm_seam){ .normal = {(float)row[2], (float)row[3], (float)row[4]},
                                 .gap = (float)row[5], .friction = (float)row[6], .fixed = (int)row[7] };
    }
    look_at_blocks(c, s, g, v);
    return split_blocks(c, s, g, v, err);
}

/* A seam and the two velocities it couples. */
typedef struct joint {
    double along, u[3], n[3];          /* m/s, of the second relative to the first                 */
} joint;

static joint look_at(const mpm_seam *seam, const tobi_float4 *first, const tobi_float4 *second)
{
    joint j;
    for (int a = 0; a < 3; a++) {
        j.n[a] = seam->normal[a];
        j.u[a] = (double)(&second->x)[a] - (&first->x)[a];
    }
    j.along = vec3_dot(j.u, j.n);
    return j;
}

/* One sweep of contact between the faces, eq. (3): the sum of its impulses pushes and obeys friction;
   momentum is kept. */
static void press(mpm_seam *seam, tobi_float4 *first, tobi_float4 *second, double dt)
{
    const joint j = look_at(seam, first, second);
    const double lack = -fmax(seam->gap, 0)/dt - j.along;
    double was[3] = {seam->push[0], seam->push[1], seam->push[2]}, slide[3];
    if (lack <= 0 && was[0] == 0 && was[1] == 0 && was[2] == 0) return;
    const double mass = seam->fixed == 1   ? second->w
                        : seam->fixed == 2 ? first->w
                                           : (double)first->w*second->w/((double)first->w + second->w);
    double normal = fmax(0, vec3_dot(was, j.n) + mass*lack);
    for (int a = 0; a < 3; a++) slide[a] = was[a] - mass*(j.u[a] - j.along*j.n[a]);
    vec3_add_scaled(slide, slide, -vec3_dot(slide, j.n), j.n);
    double size = vec3_length(slide), grip = seam->friction*normal, keep = size > grip ? grip/size : 1;
    for (int a = 0; a < 3; a++) {
        double push = normal*j.n[a] + keep*slide[a], change = push - was[a];
        if (seam->fixed != 1) (&first->x)[a] -= (float)(change/first->w);
        if (seam->fixed != 2) (&second->x)[a] += (float)(change/second->w);
        seam->push[a] = (float)push;
    }
}

/* The gap at the end of the step; returns what the push has cost, J. */
static double settle_seam(mpm_seam *seam, const tobi_float4 *first, const tobi_float4 *second, double dt)
{
    const joint j = look_at(seam, first, second);
    seam->gap += (float)(j.along*dt);
    return -(seam->push[0]*j.u[0] + seam->push[1]*j.u[1] + seam->push[2]*j.u[2]);
}

/* What is stationary does not even fall. */
static void begin_seam(mpm_seam *seam, tobi_float4 *first, tobi_float4 *second)
{
    tobi_float4 *fixed = seam->fixed == 1 ? first : second;
    if (seam->fixed) fixed->x = fixed->y = fixed->z = 0;
    memset(seam->push, 0, sizeof seam->push);
}

enum { BEGIN, PRESS, SETTLE };

/* A walk over the seams. */
typedef struct walk {
    mpm_seam *seam;
    tobi_float4 *node;
    double dt;
    int what;
} walk;

/* Returns what the pushes have cost, J. */
static double visit_range(const walk *w, int64_t begin, int64_t end)
{
    double lost = 0;
    for (int64_t k = begin; k < end; k++) {
        mpm_seam *seam = &w->seam[k];
        tobi_float4 *first = &w->node[seam->first], *second = &w->node[seam->second];
        if (!(first->w > 0) || !(second->w > 0)) continue;
        if (w->what == BEGIN) begin_seam(seam, first, second);
        if (w->what == SETTLE) lost += settle_seam(seam, first, second, w->dt);
        else press(seam, first, second, w->dt);
    }
    return lost;
}

static double visit_seams(mpm_cut *c, tobi_exec *x, const mpm_grid *g, double dt, int what)
{
    const walk w = { .seam = c->seam, .node = g->node, .dt = dt, .what = what };
    const int64_t parts = (c->seam_count + TOBI_BLOCK - 1)/TOBI_BLOCK;
    double *part = x->partial, lost = 0;
    #pragma omp parallel for num_threads(tobi_team(x, parts, 8))
    for (int64_t q = 0; q < parts; q++)
        part[q] = visit_range(&w, q*TOBI_BLOCK, q < parts - 1 ? (q + 1)*TOBI_BLOCK : c->seam_count);
    for (int64_t q = 0; q < parts; q++) lost += part[q];
    return lost;
}

void mpm_cut_meet(mpm_cut *c, tobi_exec *x, const mpm_grid *g, double dt)
{
    visit_seams(c, x, g, dt, BEGIN);
}

void mpm_cut_sweep(mpm_cut *c, tobi_exec *x, const mpm_grid *g, double dt)
{
    visit_seams(c, x, g, dt, PRESS);
}

double mpm_cut_settle(mpm_cut *c, tobi_exec *x, const mpm_grid *g, double dt)
{
    return visit_seams(c, x, g, dt, SETTLE);
}
