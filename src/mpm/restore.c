/* The nodes with several velocities in checkpoints: what particles are now does not say what they were when
   the sides were found. A row per node with two velocities; of a node where cuts cross, one with its tree
   and one for each face of its pairs. The last column says which. */
#include "base/error.h"
#include "mpm/cut/cut.h"
#include <stdlib.h>
#include <string.h>

enum { CUT_FACE_ROW, TREE_ROW, NEIGHBOR_ROW, FACE_ROW = NEIGHBOR_ROW + MPM_NEIGHBORS,
       KIND = TOBI_RESTORED_ROW - 1 };
_Static_assert((int)MPM_VELOCITIES <= (int)KIND, "a node and the cuts of its tree in one row");

static int64_t count_rows(const mpm_cut *c)
{
    int64_t count = c->cut_face_count + (1 + MPM_NEIGHBORS)*c->cross.count;
    for (int64_t k = 0; k < c->cross.pair_count; k++) count += c->cross.pair[k].count;
    return count;
}

static double *put_row(double *at, const double row[KIND], int kind)
{
    memcpy(at, row, KIND*sizeof *at);
    at[KIND] = kind;
    return at + TOBI_RESTORED_ROW;
}

static double *put_crossing(const mpm_cut *c, const mpm_crossing *x, double *to)
{
    for (int kind = TREE_ROW; kind < FACE_ROW; kind++) {
        const float *from = kind == TREE_ROW ? x->mark : x->neighbor[kind - NEIGHBOR_ROW];
        double tree[KIND] = {x->node};
        for (int m = 0; m < MPM_VELOCITIES - 1; m++) tree[1 + m] = from[m];
        to = put_row(to, tree, kind);
    }
    for (int64_t n = x->begin; n < x->end; n++)
        for (int k = 0; k < c->cross.pair[n].count; k++) {
            const mpm_face *f = &c->cross.pair[n].face[k];
            const double row[KIND] = {x->node, (double)(n - x->begin), f->normal[0], f->normal[1],
                                      f->normal[2], f->gap, c->cross.pair[n].cut_face.friction};
            to = put_row(to, row, FACE_ROW);
        }
    return to;
}

tobi_status mpm_cut_keep(const mpm_cut *c, double **rows, int64_t *count, tobi_error *err)
{
    *count = c->rows ? c->row_count : count_rows(c);       /* loaded and not run since */
    *rows = malloc((size_t)(*count + 1)*TOBI_RESTORED_ROW*sizeof **rows);
    if (!*rows)
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld nodes with two velocities",
                         (long long)*count);
    if (c->rows) {
        memcpy(*rows, c->rows, (size_t)*count*TOBI_RESTORED_ROW*sizeof **rows);
        return TOBI_OK;
    }
    double *to = *rows;
    for (int64_t k = 0; k < c->cut_face_count; k++) {
        const mpm_cut_face *m = &c->cut_face[k];
        const double row[KIND] = {m->first, c->side[m->first], m->normal[0], m->normal[1], m->normal[2],
                                  m->gap, m->friction, m->fixed};
        to = put_row(to, row, CUT_FACE_ROW);
    }
    for (int64_t k = 0; k < c->cross.count; k++) to = put_crossing(c, &c->cross.at[k], to);
    return TOBI_OK;
}

static void get_cut_face(mpm_cut *c, const double *row, int64_t node)
{
    c->side[node] = (float)row[1];
    c->cut_face[node] = (mpm_cut_face){ .normal = {(float)row[2], (float)row[3], (float)row[4]},
                                .gap = (float)row[5], .friction = (float)row[6], .fixed = (int)row[7] };
}

/* Returns the levels of the tree. */
static int get_tree(mpm_cut *c, const double *row, int64_t node)
{
    mpm_crossing *x = &c->cross.at[c->cross.count++];
    *x = (mpm_crossing){ .node = (int32_t)node, .levels = 1 };
    for (int m = 0; m < MPM_VELOCITIES - 1; m++) {
        x->mark[m] = (float)row[1 + m];
        while (x->mark[m] != 0 && m >= (1 << x->levels) - 1) x->levels++;
    }
    c->side[node] = x->mark[0];
    return x->levels;
}

/* What belongs to a crossing: neighbors or a face. Returns 0 if there is no such crossing or pair. */
static int get_rest(mpm_cut *c, const double *row, int64_t node)
{
    const int64_t k = mpm_cross_first(&c->cross, node);
    if (k == c->cross.count || c->cross.at[k].node != node) return 0;
    if (row[KIND] < FACE_ROW) {
        float *neighbor = c->cross.at[k].neighbor[(int)row[KIND] - NEIGHBOR_ROW];
        for (int m = 0; m < MPM_VELOCITIES - 1; m++) neighbor[m] = (float)row[1 + m];
        return 1;
    }
    if (!(row[1] >= 0 && row[1] < (double)(c->cross.at[k].end - c->cross.at[k].begin))) return 0;
    mpm_pair *p = &c->cross.pair[c->cross.at[k].begin + (int64_t)row[1]];
    if (p->count == MPM_LEVELS) return 0;
    p->face[p->count++] = (mpm_face){ {(float)row[2], (float)row[3], (float)row[4]}, (float)row[5] };
    p->cut_face.friction = (float)row[6];
    return 1;
}

static tobi_status reserve_crossings(mpm_cut *c, tobi_error *err)
{
    int64_t count = 0;
    for (int64_t i = 0; i < c->row_count; i++) count += c->rows[TOBI_RESTORED_ROW*i + KIND] == TREE_ROW;
    c->cross.count = 0;
    return mpm_cross_reserve(&c->cross, count, err);
}

tobi_status mpm_cut_read(mpm_cut *c, mpm_grid *g, tobi_error *err)
{
    const int64_t nodes = g->dimension == 3 ? MPM_NODES_3D : MPM_NODES_2D;
    memset(c->side, 0, (size_t)(g->patch_count*nodes)*sizeof *c->side);
    for (int64_t k = 0; k < g->patch_count; k++) g->patch[k].levels = 0;
    TOBI_TRY(reserve_crossings(c, err));
    for (int rest = 0; rest < 2; rest++) {
        for (int64_t i = 0; i < c->row_count; i++) {
            const double *row = c->rows + TOBI_RESTORED_ROW*i;
            const int64_t k = row[0] >= 0 && row[0] < (double)(g->patch_count*nodes) ? (int64_t)row[0] : -1;
            int levels = 1;
            if (k < 0 || (rest && row[KIND] >= NEIGHBOR_ROW && !get_rest(c, row, k)))
                return tobi_fail(err, TOBI_DAMAGED,
                                 "the checkpoint remembers a cut at node %g, the grid has %lld", row[0],
                                 (long long)(g->patch_count*nodes));
            if (rest || row[KIND] >= NEIGHBOR_ROW) continue;
            if (row[KIND] == TREE_ROW) levels = get_tree(c, row, k);
            else get_cut_face(c, row, k);
            if (g->patch[k/nodes].levels < levels) g->patch[k/nodes].levels = levels;
        }
        if (rest) break;
        TOBI_TRY(mpm_cross_reserve_pairs(&c->cross, err));
        for (int64_t k = 0; k < c->cross.count; k++) mpm_cross_pair(&c->cross, &c->cross.at[k]);
    }
    return TOBI_OK;
}
