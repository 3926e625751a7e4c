/* Most members stand where all are of one side. So the sides are looked at first, by base node, and
   majorities are found for those nodes alone that see both: the others have one velocity in any case. */
#include "mpm/cut/majority.h"
#include "mpm/cut/cuts.h"
#include "exec/rows.h"
#include "geom/vec3.h"
#include "mpm/spline.h"
#include <math.h>
#include <string.h>

enum { SPAN = 6, CELLS = SPAN*SPAN*SPAN };     /* base nodes whose particles reach a patch         */

void mpm_majority_deformation(const mpm_view *v, int64_t i, double f[3][3])
{
    const tobi_columns *e = &v->strain[i], *l = &v->affine[i];
    double was[3][3];
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) was[r][c] = (&e->c[c].x)[r] + (r == c);
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            f[r][c] = was[r][c];
            for (int k = 0; k < 3; k++) f[r][c] += v->strain_dt*(&l->c[k].x)[r]*was[k][c];
        }
}

/* Inverse transpose of F times n. */
static void turn_normal(const double f[3][3], const double n[3], double out[3])
{
    double c[3][3], det = 0;
    for (int a = 0; a < 3; a++)
        vec3_cross(c[a], f[(a + 1)%3], f[(a + 2)%3]);      /* rows of the cofactor matrix */
    det = vec3_dot(f[0], c[0]);
    for (int a = 0; a < 3; a++) out[a] = vec3_dot(c[a], n)/det;
}

/* Where the cuts a particle remembers are now. */
static void find_faces(mpm_cut *c, const mpm_view *v, int64_t i)
{
    const tobi_columns *cuts = &v->cuts[i];
    double f[3][3];
    mpm_majority_deformation(v, i, f);
    for (int k = 0; k < TOBI_CUTS_EACH && cuts->c[k].w != 0; k++) {
        double rest[3] = {cuts->c[k].x, cuts->c[k].y, cuts->c[k].z}, now[3];
        double far = vec3_length(rest);
        vec3_normalize(rest);
        turn_normal(f, rest, now);
        double stretch = vec3_length(now);
        vec3_normalize(now);
        c->face[i].c[k] = (tobi_float4){(float)now[0], (float)now[1], (float)now[2], (float)(far/stretch)};
    }
}

/* The run that begins with member k of so many in the list. */
static void join_run(mpm_member *first, int32_t k, int32_t count)
{
    mpm_member *one = first + 1;
    for (; one < first + (count - k) && !memcmp(one->base, first->base, sizeof one->base); one++)
        first->sides |= one->sides;
    first->end = k + (int32_t)(one - first);
}

void mpm_majority_list(mpm_cut *c, const mpm_view *v, const mpm_block *b, int64_t number, int dimension)
{
    mpm_member *list = c->member + b->begin;
    int32_t count = 0;
    for (int64_t i = b->begin; i < b->end && v->cuts; i++) {
        if (v->cuts[i].c[0].w == 0) continue;
        mpm_member *one = &list[count++];
        double unused[3];
        *one = (mpm_member){ .base = {0, 0, -1}, .particle = (int32_t)i };
        for (int a = 0; a < dimension; a++)
            one->base[a] = (int32_t)mpm_spline((&v->position[i].x)[a]*v->inverse_cell, unused);
        for (int k = 0; k < TOBI_CUTS_EACH; k++)
            one->sides |= (v->cuts[i].c[k].w > 0 ? 1 : 0) | (v->cuts[i].c[k].w < 0 ? 2 : 0);
        find_faces(c, v, i);
    }
    for (int32_t k = 0; k < count; k = list[k].end) join_run(&list[k], k, count);
    c->members[number] = count;
}

mpm_face mpm_majority_measure(const mpm_side_sums *first, const mpm_side_sums *second)
{
    mpm_face f;
    const double weight[2] = {first->place[3], second->place[3]};
    double n[3], gap = -first->face[3]/weight[0] - second->face[3]/weight[1];
    for (int a = 0; a < 3; a++) n[a] = (double)second->face[a] - first->face[a];
    vec3_normalize(n);
    for (int a = 0; a < 3; a++) {
        gap += n[a]*(second->place[a]/weight[1] - first->place[a]/weight[0]);
        f.normal[a] = (float)n[a];
    }
    f.gap = (float)gap;
    return f;
}

/* The node's side and cut face by its majorities; returns how many cuts have both sides there. */
static int decide(const mpm_majority majorities[MPM_MAJORITIES], float *side, mpm_cut_face *cut_face)
{
    int both = 0;
    const mpm_majority *best = mpm_majority_pick(majorities, &both);
    *side = 0;
    if (!best) return 0;
    const int own = mpm_majority_own(best);
    const mpm_face face = mpm_majority_measure(&best->side[own], &best->side[!own]);
    memcpy(cut_face->normal, face.normal, sizeof cut_face->normal);
    cut_face->gap = face.gap;
    cut_face->fixed = 0;
    cut_face->friction = (float)(best->friction/((double)best->side[0].place[3] + best->side[1].place[3]));
    *side = own ? -best->number : best->number;
    return both;
}

/* Nodes of a patch and base nodes around it, by place. */
typedef struct node_sides {
    unsigned char sides[CELLS];        /* of the members with this base node: 1 +, 2 -, 3 both      */
    unsigned char wanted[CELLS];       /* 1: a node of the patch that sees both                    */
    unsigned char near[CELLS];         /* 1: members with this base node reach such a node          */
} node_sides;

/* Place of a base node or a node, counted from the patch. */
static int cell_of(int a, int b, int c) { return ((a + 2)*SPAN + b + 2)*SPAN + c + 2; }

/* Place of the member's base node; -1 = it does not reach the patch. */
static int find_cell(const mpm_member *one, const mpm_patch *p)
{
    int at[3], out = 0;
    for (int a = 0; a < 3; a++) {
        at[a] = one->base[a] - p->corner[a];
        out |= at[a] > 3 || at[a] < -2;
    }
    return out ? -1 : cell_of(at[0], at[1], at[2]);
}

/* Joins each entry with those of the two places before it along every axis (step 1), or after it (-1). */
static void spread(unsigned char x[CELLS], int step)
{
    const int stride[3] = {SPAN*SPAN, SPAN, 1};
    for (int a = 0; a < 3; a++)
        for (int n = 0; n < CELLS; n++) {
            const int k = step > 0 ? CELLS - 1 - n : n, at = k/stride[a]%SPAN;
            for (int m = 1; m <= 2; m++)
                if (at - m*step >= 0 && at - m*step < SPAN) x[k] |= x[k - m*step*stride[a]];
        }
}

/* Returns whether any node sees both sides. */
static int find_wanted(const mpm_cut *c, const mpm_grid *g, const mpm_patch *p, node_sides *q)
{
    int any = 0;
    memset(q, 0, sizeof *q);
    for (int o = 0; o < 27; o++) {
        if (p->cover[o] < 0) continue;
        const mpm_member *list = c->member + g->block[p->cover[o]].begin;
        for (int32_t k = 0; k < c->members[p->cover[o]]; k = list[k].end) {
            const int cell = find_cell(&list[k], p);
            if (cell < 0) continue;
            q->sides[cell] |= list[k].sides;
            any |= list[k].sides;
        }
    }
    if (any != 3) return 0;
    any = 0;
    spread(q->sides, 1);
    for (int x = 0; x < 4; x++)
        for (int y = 0; y < 4; y++)
            for (int z = 0; z < (g->dimension == 3 ? 4 : 1); z++)
                any |= q->wanted[cell_of(x, y, z)] = q->sides[cell_of(x, y, z)] == 3;
    memcpy(q->near, q->wanted, sizeof q->near);
    spread(q->near, -1);
    return any;
}

/* Counts one particle on its side at the wanted nodes of a block that feel it. */
static void add_particle(const mpm_cut *c, const mpm_grid *g, const mpm_view *v, const mpm_patch *p,
                          const node_sides *q, int64_t i, mpm_majority majorities[][MPM_MAJORITIES])
{
    const int dim = g->dimension;
    const double x[3] = {v->position[i].x, v->position[i].y, v->position[i].z};
    const double mass = v->strain[i].c[2].w;
    double w[3][3] = {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}};
    int first[3] = {0, 0, -1}, low[3], high[3];
    for (int a = 0; a < dim; a++) first[a] = (int)mpm_spline(x[a]*v->inverse_cell, w[a]) - p->corner[a];
    for (int a = 0; a < 3; a++) {
        low[a] = first[a] < 0 ? -first[a] : 0;
        high[a] = first[a] > 1 ? 3 - first[a] : 2;
    }
    if (dim == 2) low[2] = high[2] = 1;
    const float friction = v->material[v->solid[i]].cut_friction;
    quad place = {0, 0, 0, 1};
    for (int a = 0; a < dim; a++) place[a] = (float)(x[a] - p->corner[a]*(double)v->cell);
    for (int k = 0; k < TOBI_CUTS_EACH && v->cuts[i].c[k].w != 0; k++) {
        const quad face = quad_load(&c->face[i].c[k]);
        const float mark = v->cuts[i].c[k].w;
        for (int p0 = low[0]; p0 <= high[0]; p0++)
            for (int p1 = low[1]; p1 <= high[1]; p1++) {
                const int row = (first[0] + p0)*4 + first[1] + p1;
                const double along = mass*w[0][p0]*w[1][p1];
                for (int p2 = low[2]; p2 <= high[2]; p2++)
                    if (q->wanted[cell_of(first[0] + p0, first[1] + p1, first[2] + p2)])
                        mpm_majority_add(majorities[dim == 3 ? row*4 + first[2] + p2 : row], mark,
                                     (float)(along*w[2][p2]), place, face, friction);
            }
    }
}

int mpm_majority_count(mpm_cut *c, const mpm_grid *g, const mpm_view *v, int64_t patch)
{
    const mpm_patch *p = &g->patch[patch];
    const int nodes = g->dimension == 3 ? MPM_NODES_3D : MPM_NODES_2D;
    mpm_majority majorities[MPM_NODES_3D][MPM_MAJORITIES];
    node_sides q;
    int two = 0;
    c->cross.doubt[patch] = 0;
    memset(c->side + patch*nodes, 0, (size_t)nodes*sizeof *c->side);
    if (!v->cuts || !find_wanted(c, g, p, &q)) return 0;
    memset(majorities, 0, sizeof majorities);
    for (int o = 0; o < 27; o++) {
        if (p->cover[o] < 0) continue;
        const mpm_member *list = c->member + g->block[p->cover[o]].begin;
        for (int32_t k = 0; k < c->members[p->cover[o]]; k = list[k].end) {
            const int cell = find_cell(&list[k], p);
            for (int32_t n = k; n < list[k].end && cell >= 0 && q.near[cell]; n++)
                add_particle(c, g, v, p, &q, list[n].particle, majorities);
        }
    }
    for (int n = 0; n < nodes; n++) {
        const int cuts = decide(majorities[n], &c->side[patch*nodes + n], &c->cut_face[patch*nodes + n]);
        two |= cuts > 0;
        if (cuts > 1) c->cross.doubt[patch] |= UINT64_C(1) << n;
    }
    return two;
}
