/* At a node where cuts cross the particles decide again in each branch of the tree that the cuts so far make;
   what a particle does not know leaves it with the side that outweighs. Pairs of leaves are parted by the
   cut at which their ways part, and by deeper ones that face each other. The drawback is that each node
   walks over all members near its block. */
#include "mpm/cut/cross.h"
#include "base/error.h"
#include "mpm/cut/cuts.h"
#include "geom/vec3.h"
#include "mpm/spline.h"
#include "mpm/cut/majority.h"
#include <stdlib.h>
#include <string.h>

/* Faces that look at each other less than this, the cosine of their normals, do not part two pieces. */
static const double OPPOSED = -0.5;

void mpm_cross_free(mpm_cross *c)
{
    tobi_array_free(c->doubt);
    free(c->at);
    free(c->pair);
    memset(c, 0, sizeof *c);
}

tobi_status mpm_cross_reserve(mpm_cross *c, int64_t count, tobi_error *err)
{
    if (count <= c->room) return TOBI_OK;
    free(c->at);
    c->room = count + count/4 + 8;
    c->at = malloc((size_t)c->room*sizeof *c->at);
    if (c->at) return TOBI_OK;
    c->room = c->count = 0;
    return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld nodes where cuts cross", (long long)count);
}

tobi_status mpm_cross_reserve_pairs(mpm_cross *c, tobi_error *err)
{
    c->pair_count = 0;
    for (int64_t k = 0; k < c->count; k++) {
        const int velocities = 1 << c->at[k].levels;
        c->at[k].begin = c->pair_count;
        c->at[k].end = c->pair_count += velocities*(velocities - 1)/2;
    }
    if (c->pair_count <= c->pair_room) return TOBI_OK;
    free(c->pair);
    c->pair_room = c->pair_count + c->pair_count/4;
    c->pair = malloc((size_t)c->pair_room*sizeof *c->pair);
    if (c->pair) return TOBI_OK;
    c->pair_room = c->pair_count = c->count = 0;
    return tobi_fail(err, TOBI_NO_MEMORY, "no memory for nodes where cuts cross");
}

/* A walk over the members that feel a node. */
typedef struct walk {
    const struct mpm_cut *cut;
    const mpm_grid *grid;
    const mpm_view *view;
    const mpm_patch *patch;
    int at[3];                         /* the node, cells from the domain's corner                 */
    int o;                             /* of patch->cover                                          */
    int32_t next;
    int64_t particle;                  /* the present one                                          */
    float weight;                      /* kg                                                       */
    quad place;                        /* m from the patch's corner, 1                             */
} walk;

static walk begin_walk(const struct mpm_cut *c, const mpm_grid *g, const mpm_view *v, int64_t node)
{
    const int three = g->dimension == 3, nodes = three ? MPM_NODES_3D : MPM_NODES_2D, n = (int)(node%nodes);
    walk w = { .cut = c, .grid = g, .view = v, .patch = &g->patch[node/nodes] };
    const int inner[3] = {three ? n/16 : n/4, three ? n/4%4 : n%4, three ? n%4 : 0};
    for (int a = 0; a < 3; a++) w.at[a] = w.patch->corner[a] + inner[a];
    return w;
}

static void look_at_member(walk *w, const mpm_member *one)
{
    const double *x = &w->view->position[one->particle].x;
    double weight = w->view->strain[one->particle].c[2].w;
    w->particle = one->particle;
    w->place = (quad){0, 0, 0, 1};
    for (int a = 0; a < w->grid->dimension; a++) {
        double along[3];
        mpm_spline(x[a]*w->view->inverse_cell, along);
        weight *= along[w->at[a] - one->base[a]];
        w->place[a] = (float)(x[a] - w->patch->corner[a]*(double)w->view->cell);
    }
    w->weight = (float)weight;
}

/* Goes to the next member; 0 at the end. */
static int walk_on(walk *w)
{
    for (; w->o < 27; w->o++, w->next = 0) {
        const int32_t block = w->patch->cover[w->o];
        if (block < 0) continue;
        const mpm_member *list = w->cut->member + w->grid->block[block].begin;
        while (w->next < w->cut->members[block]) {
            const mpm_member *one = &list[w->next++];
            int feels = 1;
            for (int a = 0; a < w->grid->dimension; a++)
                feels &= w->at[a] >= one->base[a] && w->at[a] <= one->base[a] + 2;
            if (!feels) continue;
            look_at_member(w, one);
            return 1;
        }
    }
    return 0;
}

/* The cut of the tree that a branch of this level meets. */
static int place_of(int level, int branch) { return (1 << level) - 1 + (branch & ((1 << level) - 1)); }

static int has(const tobi_columns *cuts, float mark)
{
    int found = 0;
    for (int k = 0; mark != 0 && k < TOBI_CUTS_EACH; k++) found |= cuts->c[k].w == mark;
    return found;
}

/* The branch that a particle takes through so many levels, as mpm_find_hidden has it. */
static int find_branch(const mpm_crossing *at, int levels, const tobi_columns *cuts)
{
    int q = 0;
    for (int l = 0; l < levels; l++) {
        const int n = place_of(l, q);
        int neighbor = 0;
        for (int m = 0; m < MPM_NEIGHBORS; m++) neighbor |= has(cuts, at->neighbor[m][n]);
        q |= (has(cuts, -at->mark[n]) || (neighbor && !has(cuts, at->mark[n]))) << l;
    }
    return q;
}

/* Particles of one side of a cut that know another cut too: how much of them on either side of that. */
typedef struct company { float mark, weight[2]; } company;

enum { COMPANIES = 2*MPM_MAJORITIES };

static void join(company list[COMPANIES], float mark, int across, float weight)
{
    int k = 0;
    while (k < COMPANIES && list[k].mark != 0 && list[k].mark != mark) k++;
    if (k == COMPANIES) return;
    list[k].mark = mark;
    list[k].weight[across] += weight;
}

/* The marks of most of those that are rather across. */
static void choose_neighbors(mpm_crossing *at, int place, const company list[COMPANIES])
{
    float before = INFINITY;
    for (int m = 0; m < MPM_NEIGHBORS; m++) {
        const company *best = NULL;
        for (int k = 0; k < COMPANIES && list[k].mark != 0; k++)
            if (list[k].weight[1] > list[k].weight[0] && list[k].weight[1] < before &&
                (!best || list[k].weight[1] > best->weight[1]))
                best = &list[k];
        at->neighbor[m][place] = best ? best->mark : 0;
        before = best ? best->weight[1] : 0;
    }
}

/* Who does not know the cuts of a level goes with those who share his other sides. */
static void find_neighbors(mpm_crossing *at, int level, const struct mpm_cut *c, const mpm_grid *g,
                        const mpm_view *v)
{
    company list[MPM_VELOCITIES/2][COMPANIES];
    memset(list, 0, sizeof list);
    for (walk w = begin_walk(c, g, v, at->node); walk_on(&w);) {
        const tobi_columns *cuts = &v->cuts[w.particle];
        const int q = find_branch(at, level, cuts);
        const float mark = at->mark[place_of(level, q)];
        const int across = has(cuts, -mark);
        if (!across && !has(cuts, mark)) continue;
        for (int k = 0; k < TOBI_CUTS_EACH && cuts->c[k].w != 0; k++)
            if (fabsf(cuts->c[k].w) != fabsf(mark)) join(list[q], cuts->c[k].w, across, w.weight);
    }
    for (int q = 0; q < 1 << level; q++) choose_neighbors(at, place_of(level, q), list[q]);
}

/* The cuts of one level of the tree; returns whether there are any. */
static int grow_level(mpm_crossing *at, int level, const struct mpm_cut *c, const mpm_grid *g,
                      const mpm_view *v)
{
    mpm_majority majorities[MPM_VELOCITIES/2][MPM_MAJORITIES];
    int any = 0, unused = 0;
    memset(majorities, 0, sizeof majorities);
    for (walk w = begin_walk(c, g, v, at->node); walk_on(&w);) {
        const tobi_columns *cuts = &v->cuts[w.particle];
        const int q = find_branch(at, level, cuts);
        for (int k = 0; k < TOBI_CUTS_EACH && cuts->c[k].w != 0; k++)
            mpm_majority_add(majorities[q], cuts->c[k].w, w.weight, w.place,
                             quad_load(&c->face[w.particle].c[k]), 0);
    }
    for (int q = 0; q < 1 << level; q++) {
        const mpm_majority *best = mpm_majority_pick(majorities[q], &unused);
        if (!best) continue;
        at->mark[place_of(level, q)] = mpm_majority_own(best) ? -best->number : best->number;
        any = 1;
    }
    return any;
}

static void grow_tree(mpm_crossing *at, const struct mpm_cut *c, const mpm_grid *g, const mpm_view *v)
{
    memset(at->mark, 0, sizeof at->mark);
    memset(at->neighbor, 0, sizeof at->neighbor);
    at->mark[0] = c->side[at->node];
    at->levels = 1;
    find_neighbors(at, 0, c, g, v);
    while (at->levels < MPM_LEVELS && grow_level(at, at->levels, c, g, v))
        find_neighbors(at, at->levels++, c, g, v);
}

/* What is heard of each piece: of the cuts that it knows, with its side, 0 = no more. */
typedef struct piece {
    mpm_side_sums face[MPM_MAJORITIES];
    float mark[MPM_MAJORITIES], weight, friction;
} piece;

static void add_face(piece *p, float mark, float w, quad place, quad face)
{
    int k = 0;
    while (k < MPM_MAJORITIES && p->mark[k] != 0 && p->mark[k] != mark) k++;
    if (k == MPM_MAJORITIES) return;
    p->mark[k] = mark;
    mpm_majority_add_side(&p->face[k], w, place, face);
}

static void collect_pieces(const mpm_crossing *at, const struct mpm_cut *c, const mpm_grid *g,
                           const mpm_view *v,
                        piece pieces[MPM_VELOCITIES])
{
    memset(pieces, 0, MPM_VELOCITIES*sizeof *pieces);
    for (walk w = begin_walk(c, g, v, at->node); walk_on(&w);) {
        const tobi_columns *cuts = &v->cuts[w.particle];
        piece *p = &pieces[find_branch(at, at->levels, cuts)];
        p->weight += w.weight;
        p->friction += w.weight*v->material[v->solid[w.particle]].cut_friction;
        for (int k = 0; k < TOBI_CUTS_EACH && cuts->c[k].w != 0; k++)
            add_face(p, cuts->c[k].w, w.weight, w.place, quad_load(&c->face[w.particle].c[k]));
    }
}

static int are_opposed(const mpm_side_sums *a, const mpm_side_sums *b)
{
    double p[3] = {a->face[0], a->face[1], a->face[2]}, q[3] = {b->face[0], b->face[1], b->face[2]};
    vec3_normalize(p);
    vec3_normalize(q);
    return vec3_dot(p, q) < OPPOSED;
}

/* The level at which the ways to two leaves of the tree part. */
static int find_fork(int a, int b)
{
    int l = 0;
    while (!((a ^ b) >> l & 1)) l++;
    return l;
}

/* Which sides of a cut a piece knows: 1 that of the mark, 2 the other, 3 both. */
static int find_sides(const piece *p, float mark)
{
    int sides = 0;
    for (int k = 0; k < MPM_MAJORITIES; k++) sides |= p->mark[k] == mark ? 1 : p->mark[k] == -mark ? 2 : 0;
    return sides;
}

/* Whether face k of a piece and face l of another part the two: those of one cut on its two sides, or of two
   cuts that look at each other, of which neither piece knows the other's. */
static int part(const piece *a, int k, const piece *b, int l)
{
    const float one = a->mark[k], two = b->mark[l];
    if (one == 0 || two == 0) return 0;
    if (one == -two) return find_sides(a, one) == 1 && find_sides(b, two) == 1;
    return find_sides(b, one) == 0 && find_sides(a, two) == 0 && are_opposed(&a->face[k], &b->face[l]);
}

/* The faces at which two pieces may touch: none if those of the cut at which their ways part are not near. */
static void fill_pair(const mpm_crossing *at, const piece *pieces, mpm_pair *pair)
{
    const int fork = find_fork(pair->cut_face.first, pair->cut_face.second);
    const piece *one = &pieces[pair->cut_face.first], *two = &pieces[pair->cut_face.second];
    const float mark = at->mark[place_of(fork, pair->cut_face.first)];
    if (mark == 0 || find_sides(one, mark) != 1 || find_sides(two, -mark) != 1) return;
    for (int k = 0; k < MPM_MAJORITIES; k++)
        for (int l = 0; l < MPM_MAJORITIES && pair->count < MPM_LEVELS; l++)
            if (part(one, k, two, l))
                pair->face[pair->count++] = mpm_majority_measure(&one->face[k], &two->face[l]);
    pair->cut_face.friction = (one->friction + two->friction)/(one->weight + two->weight);
}

void mpm_cross_pair(mpm_cross *c, const mpm_crossing *at)
{
    mpm_pair *pair = c->pair + at->begin;
    for (int b = 1; b < 1 << at->levels; b++)
        for (int a = 0; a < b; a++) {
            const int swapped = a >> find_fork(a, b) & 1;
            *pair++ = (mpm_pair){ .cut_face = { .first = swapped ? b : a, .second = swapped ? a : b } };
        }
}

static void fill_pairs(const mpm_crossing *at, struct mpm_cut *c, const mpm_grid *g, const mpm_view *v)
{
    piece pieces[MPM_VELOCITIES];
    collect_pieces(at, c, g, v, pieces);
    mpm_cross_pair(&c->cross, at);
    for (int64_t n = at->begin; n < at->end; n++) fill_pair(at, pieces, &c->cross.pair[n]);
}

/* What the loops over the nodes in doubt need. */
typedef struct crossing_view {
    struct mpm_cut *cut;
    mpm_grid *grid;
    const mpm_view *v;
} crossing_view;

static void grow_trees(const void *view, int64_t begin, int64_t end)
{
    const crossing_view *c = view;
    for (int64_t k = begin; k < end; k++) grow_tree(&c->cut->cross.at[k], c->cut, c->grid, c->v);
}

static void fill_crossings(const void *view, int64_t begin, int64_t end)
{
    const crossing_view *c = view;
    for (int64_t k = begin; k < end; k++) fill_pairs(&c->cut->cross.at[k], c->cut, c->grid, c->v);
}

/* Lists the nodes in doubt. */
static tobi_status list_doubts(mpm_cross *c, const mpm_grid *g, tobi_error *err)
{
    const int nodes = g->dimension == 3 ? MPM_NODES_3D : MPM_NODES_2D;
    int64_t count = 0;
    for (int64_t k = 0; k < g->patch_count; k++) count += __builtin_popcountll(c->doubt[k]);
    TOBI_TRY(mpm_cross_reserve(c, count, err));
    for (int64_t k = 0; k < g->patch_count && count > 0; k++)
        for (int n = 0; n < nodes && c->doubt[k]; n++)
            if (c->doubt[k] >> n & 1) c->at[c->count++].node = (int32_t)(k*nodes + n);
    return TOBI_OK;
}

tobi_status mpm_cross_find(struct mpm_cut *c, const tobi_exec *x, mpm_grid *g, const mpm_view *v,
                           tobi_error *err)
{
    const int nodes = g->dimension == 3 ? MPM_NODES_3D : MPM_NODES_2D;
    mpm_cross *all = &c->cross;
    int64_t kept = 0;
    all->count = 0;
    TOBI_TRY(list_doubts(all, g, err));
    const crossing_view view = { c, g, v };
    tobi_loop(tobi_team(x, all->count, 8), all->count, 4, grow_trees, &view);
    for (int64_t k = 0; k < all->count; k++) {
        mpm_patch *p = &g->patch[all->at[k].node/nodes];
        if (all->at[k].levels < 2) continue;
        if (p->levels < all->at[k].levels) p->levels = all->at[k].levels;
        all->at[kept++] = all->at[k];
    }
    all->count = kept;
    TOBI_TRY(mpm_cross_reserve_pairs(all, err));
    tobi_loop(tobi_team(x, all->count, 8), all->count, 4, fill_crossings, &view);
    return TOBI_OK;
}

void mpm_cross_place(mpm_cross *c, const mpm_grid *g)
{
    const int nodes = g->dimension == 3 ? MPM_NODES_3D : MPM_NODES_2D;
    for (int64_t k = 0; k < c->count; k++) {
        const int64_t node = c->at[k].node, twin = g->patch[node/nodes].twin;
        for (int64_t n = c->at[k].begin; n < c->at[k].end; n++) {
            mpm_cut_face *s = &c->pair[n].cut_face;
            s->first = (int32_t)(s->first ? (twin + s->first - 1)*nodes + node%nodes : node);
            s->second = (int32_t)(s->second ? (twin + s->second - 1)*nodes + node%nodes : node);
        }
    }
}

int64_t mpm_cross_first(const mpm_cross *c, int64_t node)
{
    int64_t low = 0, high = c->count;
    while (low < high) {
        const int64_t middle = (low + high)/2;
        if (c->at[middle].node < node) low = middle + 1;
        else high = middle;
    }
    return low;
}

typedef struct visiting { mpm_cross *cross; tobi_float4 *node; double dt; mpm_visit what; } visiting;

static void visit_crossings(const void *view, int64_t begin, int64_t end)
{
    const visiting *v = view;
    for (int64_t k = begin; k < end; k++) {
        mpm_crossing *at = &v->cross->at[k];
        mpm_pair *pair = v->cross->pair + at->begin;
        at->lost = mpm_pairs_visit(pair, at->end - at->begin, v->node, v->dt, v->what);
        if (v->what == MPM_BEGIN) mpm_pairs_visit(pair, at->end - at->begin, v->node, v->dt, MPM_PRESS);
    }
}

double mpm_cross_visit(mpm_cross *c, tobi_exec *x, tobi_float4 *node, double dt, mpm_visit what)
{
    const visiting view = { c, node, dt, what };
    double lost = 0;
    tobi_loop(tobi_team(x, c->count, 64), c->count, 0, visit_crossings, &view);
    for (int64_t k = 0; k < c->count; k++) lost += c->at[k].lost;
    return lost;
}
