/* Solids that start in more pieces than their regions have parts: what is thinner than the lattice has no
   particles there. Each region is looked at by itself, so regions that touch are nobody's business. A mesh is
   filled anew with finer lattices, to say which spacing holds it together. Drawback: lattices of more than
   some millions of points are not tried. */
#include "world/note_pieces.h"
#include "geom/bvh.h"
#include "base/param.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double TRIAL_POINTS = 4e6;      /* of all lattices tried, inside the mesh and around it */
static const double FINER = 0.8;             /* one lattice after the other                          */

static int32_t find_root(int32_t *parent, int32_t i)
{
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

static void join(int32_t *parent, int32_t a, int32_t b)
{
    a = find_root(parent, a);
    b = find_root(parent, b);
    parent[a > b ? a : b] = a > b ? b : a;
}

/* Parts of a mesh that share no vertex, cavities aside: their volume is negative. 0 without memory. */
static int count_parts(const tobi_mesh *m)
{
    int32_t *parent = malloc((size_t)(m->vertex_count + 1)*sizeof *parent);
    double *volume = calloc((size_t)m->vertex_count + 1, sizeof *volume);
    int parts = 0;
    for (int64_t i = 0; parent && i < m->vertex_count; i++) parent[i] = (int32_t)i;
    for (int64_t t = 0; parent && t < m->triangle_count; t++)
        for (int k = 1; k < 3; k++) join(parent, m->triangles[t][0], m->triangles[t][k]);
    for (int64_t t = 0; parent && volume && t < m->triangle_count; t++) {
        const double *a = m->vertices[m->triangles[t][0]], *b = m->vertices[m->triangles[t][1]],
                     *c = m->vertices[m->triangles[t][2]];
        volume[find_root(parent, m->triangles[t][0])] +=
            a[0]*(b[1]*c[2] - b[2]*c[1]) + a[1]*(b[2]*c[0] - b[0]*c[2]) + a[2]*(b[0]*c[1] - b[1]*c[0]);
    }
    for (int64_t i = 0; parent && volume && i < m->vertex_count; i++) parts += volume[i] > 0;
    free(parent);
    free(volume);
    return parts;
}

/* A lattice over the box of a region. */
typedef struct trial {
    const tobi_region *region;
    const tobi_bvh *tree;
    int64_t n[3];
    double spacing;
    int dimension;
    uint8_t *inside;
} trial;

static void look(const void *view, int64_t begin, int64_t end, double *totals)
{
    const trial *t = view;
    (void)totals;
    for (int64_t p = begin; p < end; p++) {
        const int64_t at[3] = { p%t->n[0], p/t->n[0]%t->n[1], p/(t->n[0]*t->n[1]) };
        double x[3] = { 0, 0, 0 };
        for (int a = 0; a < t->dimension; a++)
            x[a] = t->region->lower[a] + ((double)at[a] + 0.5)*t->spacing;
        t->inside[p] = (uint8_t)tobi_bvh_inside(t->tree, x);
    }
}

/* Pieces of what is inside, linked within 1.5 spacings: along sides and the diagonals of faces. */
static int count_linked(const trial *t, int32_t *parent)
{
    const int64_t count = t->n[0]*t->n[1]*t->n[2];
    int pieces = 0;
    for (int64_t p = 0; p < count; p++) parent[p] = (int32_t)p;
    for (int64_t p = 0; p < count; p++) {
        const int64_t at[3] = { p%t->n[0], p/t->n[0]%t->n[1], p/(t->n[0]*t->n[1]) };
        for (int k = 0; t->inside[p] && k < 27; k++) {
            const int way[3] = { k%3 - 1, k/3%3 - 1, k/9 - 1 };
            int64_t to = 0, stride = 1;
            int within = way[0]*way[0] + way[1]*way[1] + way[2]*way[2] <= 2;
            for (int a = 0; a < 3; a++) {
                within &= at[a] + way[a] >= 0 && at[a] + way[a] < t->n[a];
                to += stride*(at[a] + way[a]);
                stride *= t->n[a];
            }
            if (within && to < p && t->inside[to]) join(parent, (int32_t)p, (int32_t)to);
        }
    }
    for (int64_t p = 0; p < count; p++) pieces += t->inside[p] && find_root(parent, (int32_t)p) == p;
    return pieces;
}

/* Pieces at a spacing; 0 if that is too much to try. *points are taken off what is left to try. */
static int try_spacing(tobi_exec *x, trial *t, double *points)
{
    double count = 1;
    for (int a = 0; a < 3; a++) {
        const double side = t->region->upper[a] - t->region->lower[a];
        const double n = a < t->dimension ? ceil(side/t->spacing) : 1;
        count *= n;
        t->n[a] = count <= *points ? (int64_t)n : 1;
    }
    *points -= count;
    if (*points < 0) return 0;
    t->inside = malloc((size_t)count + 1);
    int32_t *parent = malloc(((size_t)count + 1)*sizeof *parent);
    int pieces = 0;
    if (t->inside && parent) {
        tobi_launch(x, TOBI_HOST(look, 0, 0), t, 0, (int64_t)count, NULL);
        pieces = count_linked(t, parent);
    }
    free(t->inside);
    free(parent);
    return pieces;
}

/* The coarsest of some finer spacings at which the region has no more pieces than parts; 0 = none. *finest:
   the last that was tried. */
static tobi_status find_spacing(tobi_system *s, const tobi_region *r, int parts, double *fits,
                                double *finest, tobi_error *err)
{
    const tobi_mesh *m = &r->shape;
    tobi_bvh *tree;
    double points = TRIAL_POINTS;
    *fits = *finest = 0;
    TOBI_TRY(tobi_bvh_build(m->vertex_count, (const double (*)[3])m->vertices, m->triangle_count,
                            (const int32_t (*)[3])m->triangles, &tree, err));
    if (m->overlapping) tobi_bvh_use_winding(tree);
    trial t = { .region = r, .tree = tree, .spacing = s->smoothing.spacing, .dimension = s->box.dimension };
    for (int pieces = 1; pieces > 0 && *fits == 0;) {
        t.spacing *= FINER;
        pieces = try_spacing(&s->sim->exec, &t, &points);
        if (pieces > 0) *finest = t.spacing;
        if (pieces > 0 && pieces <= parts) *fits = t.spacing;
    }
    tobi_bvh_free(tree);
    return TOBI_OK;
}

/* What a region's particles are in: pieces and debris, with their masses. */
typedef struct tally { int pieces, fragments; double debris; char masses[80]; } tally;

static void count_pieces(const tobi_world *w, int64_t first, int64_t end, uint8_t *seen, tally *sum)
{
    const tobi_pieces *found = &w->pieces.found;
    size_t used = 0;
    *sum = (tally){ 0 };
    memset(seen, 0, (size_t)(found->count + found->fragments));
    for (int64_t i = first; i < end; i++)
        if (w->pieces.of[i] >= 0) seen[w->pieces.of[i]] = 1;
    for (int64_t k = 0; k < found->count + found->fragments; k++) {
        const tobi_piece *p = &found->piece[k];
        if (!seen[k]) continue;
        sum->fragments += p->fragment;
        if (p->fragment) sum->debris += p->mass;
        else if (++sum->pieces <= 3)
            used += (size_t)snprintf(sum->masses + used, sizeof sum->masses - used, "%s%.4g",
                                     used ? ", " : "", p->mass);
        else if (sum->pieces == 4) snprintf(sum->masses + used, sizeof sum->masses - used, " ...");
    }
}

static tobi_status note_region(tobi_world *w, const tobi_region *r, const tally *sum, int parts,
                               tobi_error *err)
{
    const char *unit = w->system[r->system].box.dimension == 3 ? "kg" : "kg/m";
    char text[3*TOBI_NOTE], debris[TOBI_NOTE] = "", why[TOBI_NOTE];
    double fits = 0, finest = 0;
    if (r->shape.triangle_count) TOBI_TRY(find_spacing(&w->system[r->system], r, parts, &fits, &finest, err));
    if (sum->fragments)
        snprintf(debris, sizeof debris, tr(" and %d of debris (%.3g %s)"), sum->fragments, sum->debris, unit);
    if (fits > 0)
        snprintf(why, sizeof why, tr("parts of its mesh are thinner than the spacing, %.4g m; at %.4g m it "
                 "is whole"), w->system[r->system].smoothing.spacing, fits);
    else if (finest > 0)
        snprintf(why, sizeof why, tr("parts of its mesh are far thinner than the spacing, %.4g m, or do not "
                 "touch; at %.4g m it is not whole either"), w->system[r->system].smoothing.spacing, finest);
    else
        snprintf(why, sizeof why, tr("parts of it are thinner than the spacing, %.4g m, or bodies, planes "
                 "and sides part it"), w->system[r->system].smoothing.spacing);
    snprintf(text, sizeof text, tr("fill[%d] starts in %d pieces (%s %s)%s: %s\n"), r->number, sum->pieces,
             sum->masses, unit, debris, why);
    return tobi_world_add_notes(w, "solid", w->system[r->system].solids[r->owner].name, text, err);
}

tobi_status tobi_world_note_pieces(tobi_world *w, tobi_error *err)
{
    const tobi_system *s = tobi_world_solids(w);
    const tobi_pieces *found;
    int any = 0;
    for (int k = 0; s && k < s->solid_count; k++)
        any |= tobi_solid_uses(s->solids[k].def.model, "cut_friction");
    if (!any) return TOBI_OK;
    TOBI_TRY(tobi_world_pieces(w, &found, err));
    uint8_t *seen = malloc((size_t)(found->count + found->fragments) + 1);
    tobi_status status = seen ? TOBI_OK : tobi_fail(err, TOBI_NO_MEMORY, "no memory for a note");
    int64_t first = 0;
    for (int k = 0; k < w->region_count && status == TOBI_OK; k++) {
        const tobi_region *r = &w->regions[k];
        tally sum;
        if (&w->system[r->system] != s) continue;
        count_pieces(w, first, first + r->placed, seen, &sum);
        first += r->placed;
        if (!tobi_solid_uses(s->solids[r->owner].def.model, "cut_friction") ||
            sum.pieces + sum.fragments < 2) continue;
        const int parts = r->shape.triangle_count ? count_parts(&r->shape) : 1;
        if (sum.pieces + sum.fragments > parts) status = note_region(w, r, &sum, parts, err);
    }
    free(seen);
    return status;
}
