/* Closedness and orientation: match edges, mend and patch what is open, flood each connected shell until
   its triangles agree, then turn whole shells by how many other shells they lie in (even outward, odd
   inward).

   A shell lies in another one when the winding number of that one is not 0 at points all over it; one
   that pokes out is a solid of its own, and what both hold counts once (mesh->overlapping). */
#include "geom/bvh.h"
#include "geom/edges.h"
#include "geom/lines.h"
#include "geom/mesh.h"
#include "geom/mesh_mend.h"
#include "geom/vec3.h"
#include <stdlib.h>
#include <string.h>

#define DOUBT_ALLOWED 0.02       /* of the volume, between two ways to close the holes     */
#define OVERLAP_SEEN 1e-3        /* of the volume: less is left alone                      */
enum { SAMPLES = 9, LINES = 200 };

enum surface { CLOSED, OPEN, VESSEL };

typedef struct shell_set {
    int64_t count;
    int32_t *of_triangle;        /* shell of each triangle                  */
    int32_t *order;              /* triangles grouped by shell              */
    int64_t *start;              /* count + 1 offsets into order            */
    double (*box)[6];            /* min and max of each shell               */
    double *volume;              /* signed                                  */
} shell_set;

typedef struct orient_work {
    int32_t (*opposite)[3];
    int32_t *stack;
    signed char *turn;           /* -1 unseen, 0 as is, 1 to be turned      */
    int64_t turned;              /* triangles that disagreed with most      */
    shell_set shells;
    tobi_holes holes;
    const char *name;
    enum surface what;           /* OPEN: patches only tell the outside                */
} orient_work;

static void free_work(orient_work *w)
{
    free(w->opposite);
    free(w->stack);
    free(w->turn);
    free(w->shells.of_triangle);
    free(w->shells.order);
    free(w->shells.start);
    free(w->shells.box);
    free(w->shells.volume);
}

static tobi_status allocate_work(orient_work *w, int64_t n)
{
    orient_work fresh = {.holes = w->holes, .turned = w->turned, .name = w->name,
                         .what = w->what};
    free_work(w);
    *w = fresh;
    w->opposite = malloc((size_t)n*sizeof *w->opposite);
    w->stack = malloc((size_t)n*sizeof *w->stack);
    w->turn = malloc((size_t)n);
    w->shells.of_triangle = malloc((size_t)n*sizeof(int32_t));
    w->shells.order = malloc((size_t)n*sizeof(int32_t));
    return w->opposite && w->stack && w->turn && w->shells.of_triangle && w->shells.order
               ? TOBI_OK : TOBI_NO_MEMORY;
}

static tobi_status fail_non_manifold(const tobi_mesh *mesh, const orient_work *w, const tobi_edge_report *r,
                                     tobi_error *err)
{
    const double *a = mesh->vertices[r->ends[0]], *b = mesh->vertices[r->ends[1]];
    return tobi_fail(err, TOBI_INVALID, "mesh '%s' does not say what is inside: %lld edges with more than "
                     "two triangles and %lld with one, the first from (%.6g, %.6g, %.6g) to "
                     "(%.6g, %.6g, %.6g): sheets without thickness? %s",
                     w->name, (long long)r->non_manifold, (long long)r->open, a[0], a[1], a[2], b[0], b[1],
                     b[2], w->what == OPEN ? tr("A vessel is open at its top alone, also in 2-D")
                                             : tr("A closed surface is needed"));
}

/* True if half-edges h and g run from the same vertex, that is, if their triangles disagree. */
static int runs_alike(const tobi_mesh *mesh, int32_t h, int32_t g)
{
    return mesh->triangles[h/3][h % 3] == mesh->triangles[g/3][g % 3];
}

/* Visits one shell from a seed triangle; if most of it is to be turned, the rest is instead. Returns the
   half-edge where two triangles cannot be made to agree, or -1. */
static int32_t flood_shell(const tobi_mesh *mesh, orient_work *w, int32_t seed, int32_t shell)
{
    int64_t top = 0, seen = 0, turned = 0;
    w->stack[top++] = seed;
    w->turn[seed] = 0;
    w->shells.of_triangle[seed] = shell;
    while (top) {
        int32_t t = w->stack[--top];
        w->shells.order[seen++] = t;
        turned += w->turn[t];
        for (int k = 0; k < 3; k++) {
            int32_t g = w->opposite[t][k], u = g/3;
            if (g < 0) continue;
            signed char turn = (signed char)(w->turn[t] ^ runs_alike(mesh, 3*t + k, g));
            if (w->turn[u] < 0) {
                w->turn[u] = turn;
                w->shells.of_triangle[u] = shell;
                w->stack[top++] = u;
            } else if (w->turn[u] != turn) {
                return 3*t + k;
            }
        }
    }
    for (int64_t i = 0; i < seen && 2*turned > seen; i++) w->turn[w->shells.order[i]] ^= 1;
    w->turned += 2*turned > seen ? seen - turned : turned;
    return -1;
}

static void turn_triangle(int32_t t[3])
{
    int32_t swap = t[1];
    t[1] = t[2];
    t[2] = swap;
}

/* Groups the triangles by shell and measures each shell. */
static tobi_status measure_shells(const tobi_mesh *mesh, shell_set *s)
{
    s->start = calloc((size_t)s->count + 2, sizeof *s->start);
    s->box = malloc((size_t)s->count*sizeof *s->box);
    s->volume = calloc((size_t)s->count, sizeof *s->volume);
    if (!s->start || !s->box || !s->volume) return TOBI_NO_MEMORY;
    for (int64_t t = 0; t < mesh->triangle_count; t++) s->start[s->of_triangle[t] + 2]++;
    for (int64_t i = 0; i < s->count; i++) s->start[i + 2] += s->start[i + 1];
    for (int64_t t = 0; t < mesh->triangle_count; t++)
        s->order[s->start[s->of_triangle[t] + 1]++] = (int32_t)t;
    for (int64_t i = 0; i < s->count; i++) {
        double *box = s->box[i];
        for (int k = 0; k < 3; k++) {
            box[k] = INFINITY;
            box[3 + k] = -INFINITY;
        }
        const double *origin = mesh->vertices[mesh->triangles[s->order[s->start[i]]][0]];
        for (int64_t j = s->start[i]; j < s->start[i + 1]; j++) {
            double e[3][3], n[3];
            for (int c = 0; c < 3; c++) {
                const double *x = mesh->vertices[mesh->triangles[s->order[j]][c]];
                vec3_sub(e[c], x, origin);
                for (int k = 0; k < 3; k++) {
                    box[k] = fmin(box[k], x[k]);
                    box[3 + k] = fmax(box[3 + k], x[k]);
                }
            }
            vec3_cross(n, e[1], e[2]);
            s->volume[i] += vec3_dot(e[0], n)/6;
        }
    }
    return TOBI_OK;
}

/* Which shells a line crosses: the winding number of each at the point. */
typedef struct shell_census {
    const shell_set *s;
    int *wound, *holds;          /* at the present point; at how many points not 0 */
    int32_t touched[1024];       /* shells with wound set                          */
    int count;
} shell_census;

static void count_crossing(void *user, int32_t triangle, int turn)
{
    shell_census *c = user;
    int32_t shell = c->s->of_triangle[triangle];
    int known = 0;
    for (int i = 0; i < c->count && !known; i++) known = c->touched[i] == shell;
    if (!known && c->count == 1024) return;
    if (!known) c->touched[c->count++] = shell;
    c->wound[shell] -= turn;
}

/* How many shells hold this one: at all of up to SAMPLES of its triangles. */
static int find_depth(const tobi_mesh *mesh, const tobi_bvh *bvh, int64_t shell, shell_census *c)
{
    const shell_set *s = c->s;
    int64_t first = s->start[shell], n = s->start[shell + 1] - first;
    int32_t holders[1024];
    int samples = n < SAMPLES ? (int)n : SAMPLES, depth = 0, candidates = 0;
    for (int i = 0; i < samples; i++) {
        const int32_t *t = mesh->triangles[s->order[first + i*(n - 1)/(samples > 1 ? samples - 1 : 1)]];
        double p[3];
        for (int k = 0; k < 3; k++)
            p[k] = (mesh->vertices[t[0]][k] + mesh->vertices[t[1]][k] + mesh->vertices[t[2]][k])/3;
        c->count = 0;
        tobi_bvh_look_up(bvh, p, count_crossing, c);
        for (int j = 0; j < c->count; j++) {
            int32_t other = c->touched[j];
            if (c->wound[other] && other != shell) c->holds[other]++;
            if (i == 0) holders[candidates++] = other;
            c->wound[other] = 0;
        }
        /* a shell not seen by the first point cannot hold all */
        for (int j = 0; i && j < c->count; j++) {
            int seen = 0;
            for (int k = 0; k < candidates && !seen; k++) seen = holders[k] == c->touched[j];
            if (!seen) c->holds[c->touched[j]] = 0;
        }
    }
    for (int k = 0; k < candidates; k++) {
        depth += c->holds[holders[k]] == samples;
        c->holds[holders[k]] = 0;
    }
    return depth;
}

static tobi_status find_depths(const tobi_mesh *mesh, const shell_set *s, int *depth, tobi_error *err)
{
    tobi_bvh *bvh = NULL;
    if (s->count == 1) return TOBI_OK;
    TOBI_TRY(tobi_bvh_build(mesh->vertex_count, (const double (*)[3])mesh->vertices, mesh->triangle_count,
                            (const int32_t (*)[3])mesh->triangles, &bvh, err));
    shell_census c = {.s = s};
    c.wound = calloc((size_t)s->count, sizeof *c.wound);
    c.holds = calloc((size_t)s->count, sizeof *c.holds);
    for (int64_t i = 0; c.wound && c.holds && i < s->count; i++) depth[i] = find_depth(mesh, bvh, i, &c);
    tobi_status status = c.wound && c.holds ? TOBI_OK : TOBI_NO_MEMORY;
    free(c.wound);
    free(c.holds);
    tobi_bvh_free(bvh);
    return status;
}

static tobi_status fail_flat(const orient_work *w, const double b[6], tobi_error *err)
{
    char holes[600] = "";
    if (w->holes.count) tobi_holes_describe(&w->holes, holes, sizeof holes);
    return tobi_fail(err, TOBI_INVALID, "mesh '%s': the shell around (%.6g, %.6g, %.6g) encloses no volume; "
                     "a body needs an inside%s%s", w->name, (b[0] + b[3])/2, (b[1] + b[4])/2,
                     (b[2] + b[5])/2, holes[0] ? tr(". The surface has ") : "", holes);
}

static tobi_status turn_shells(tobi_mesh *mesh, orient_work *w, tobi_error *err)
{
    shell_set *s = &w->shells;
    int64_t turned = 0, hollow = 0;
    for (int64_t i = 0; i < s->count; i++) {
        const double *b = s->box[i];
        double size = fmax(b[3] - b[0], fmax(b[4] - b[1], b[5] - b[2]));
        if (fabs(s->volume[i]) <= 1e-12*size*size*size) return fail_flat(w, b, err);
    }
    int *depth = calloc((size_t)s->count, sizeof *depth);
    tobi_status status = depth ? find_depths(mesh, s, depth, err) : TOBI_NO_MEMORY;
    for (int64_t i = 0; status == TOBI_OK && i < s->count; i++) {
        hollow += depth[i] % 2;
        if ((s->volume[i] < 0) == (depth[i] % 2 == 1)) continue;
        turned++;
        for (int64_t j = s->start[i]; j < s->start[i + 1]; j++) turn_triangle(mesh->triangles[s->order[j]]);
    }
    free(depth);
    if (hollow && w->what != VESSEL)                   /* it is there to be filled */
        tobi_mesh_note(mesh, tr("%lld of %lld shells lie inside another one and are hollows; those of a body "
                       "are filled by regions that cover it"), (long long)hollow, (long long)s->count);
    if (turned)
        tobi_mesh_note(mesh, tr("%lld of %lld shells turned: the outermost look outwards, hollows inwards"),
                       (long long)turned, (long long)s->count);
    return status;
}

/* Looks for volume that is inside more than once, or inside out. */
static tobi_status find_overlaps(tobi_mesh *mesh, tobi_error *err)
{
    double min[3], max[3], size = 0, inside = 0, twice = 0, negative = 0;
    tobi_lines l = {0};
    tobi_mesh_box(mesh, min, max);
    for (int k = 0; k < 3; k++) size = fmax(size, max[k] - min[k]);
    tobi_status status = tobi_lines_cut(&l, mesh, NULL, size/LINES, err);
    for (int64_t line = 0; status == TOBI_OK && line < l.size[0]*l.size[1]; line++) {
        int wound = 0;
        for (int64_t c = l.start[line]; c + 1 < l.start[line + 1]; c++) {
            double length = l.cuts[c + 1].at - l.cuts[c].at;
            wound += l.cuts[c].turn;
            if (wound > 0) inside += length;
            if (wound > 1) twice += length;
            if (wound < 0) negative += length;
        }
    }
    tobi_lines_free(&l);
    TOBI_TRY(status);
    mesh->overlapping = twice + negative > OVERLAP_SEEN*inside;
    if (mesh->overlapping && twice > 0)
        tobi_mesh_note(mesh, tr("parts of the surface overlap: %.2g %% of the volume lies in more than one "
                       "and counts once"), 100*twice/inside);
    if (mesh->overlapping && negative > OVERLAP_SEEN*inside)
        tobi_mesh_note(mesh, tr("parts of the surface are inside out: %.2g %% of the volume, which counts as "
                       "outside"), 100*negative/inside);
    return TOBI_OK;
}

static tobi_status match_edges(const tobi_mesh *mesh, orient_work *w, tobi_edge_report *report)
{
    return tobi_edges_match(mesh->vertex_count, mesh->triangle_count, (const int32_t (*)[3])mesh->triangles,
                            w->opposite, report);
}

/* Matches edges and makes the triangles of each shell agree, over open edges or not. Those that are turned
   have their edges in another order. */
static tobi_status flood_mesh(tobi_mesh *mesh, orient_work *w, tobi_edge_report *report, tobi_error *err)
{
    const int64_t before = w->turned;
    TOBI_TRY(allocate_work(w, mesh->triangle_count));
    TOBI_TRY(match_edges(mesh, w, report));
    for (int64_t t = 0; t < mesh->triangle_count; t++) w->turn[t] = -1;
    for (int64_t t = 0; t < mesh->triangle_count; t++) {
        if (w->turn[t] >= 0) continue;
        int32_t bad = flood_shell(mesh, w, (int32_t)t, (int32_t)w->shells.count++);
        if (bad < 0) continue;
        const double *x = mesh->vertices[mesh->triangles[bad/3][bad % 3]];
        return tobi_fail(err, TOBI_INVALID, "mesh '%s' has no inside: its triangles cannot be made to "
                         "agree at (%.6g, %.6g, %.6g), as on a Moebius band", w->name, x[0], x[1], x[2]);
    }
    for (int64_t t = 0; t < mesh->triangle_count; t++)
        if (w->turn[t]) turn_triangle(mesh->triangles[t]);
    return w->turned > before ? match_edges(mesh, w, report) : TOBI_OK;
}

static tobi_status close_holes(tobi_mesh *mesh, orient_work *w, tobi_edge_report *report, tobi_error *err)
{
    TOBI_TRY(tobi_mesh_patch(mesh, (const int32_t (*)[3])w->opposite, &w->holes));
    return flood_mesh(mesh, w, report, err);
}

/* The holes are closed; was it clear how? */
static tobi_status judge_holes(tobi_mesh *mesh, orient_work *w, tobi_error *err)
{
    char text[600];
    double doubt;
    TOBI_TRY(tobi_holes_doubt(mesh, &w->holes, &doubt));
    tobi_holes_describe(&w->holes, text, sizeof text);
    if (doubt > DOUBT_ALLOWED)
        return tobi_fail(err, TOBI_INVALID, "mesh '%s' does not say what is inside: %s. Flat patches and the "
                         "winding number of the open surface disagree about %.2g %% of the volume, allowed "
                         "are %.2g %%; close the surface", w->name, text, fmin(100*doubt, 1e6),
                         100*DOUBT_ALLOWED);
    tobi_mesh_note(mesh, tr("%s closed by patches; the winding number of the open surface agrees, so volume, "
                   "centre and inertia are those of the patched surface, to within %.2g %%"), text,
                   fmax(100*doubt, 0.1));
    return TOBI_OK;
}

static tobi_status orient_mesh(tobi_mesh *mesh, orient_work *w, tobi_error *err)
{
    tobi_edge_report report = {0};
    TOBI_TRY(match_edges(mesh, w, &report));
    if (report.open || report.non_manifold) TOBI_TRY(tobi_mesh_mend(mesh));
    TOBI_TRY(flood_mesh(mesh, w, &report, err));
    if (w->turned)
        tobi_mesh_note(mesh, tr("%lld of %lld triangles turned to agree with their neighbours"),
                       (long long)w->turned, (long long)mesh->triangle_count);
    if (report.non_manifold) return fail_non_manifold(mesh, w, &report, err);
    int patched = report.open > 0;
    if (patched) TOBI_TRY(close_holes(mesh, w, &report, err));
    if (report.open || report.non_manifold) return fail_non_manifold(mesh, w, &report, err);
    TOBI_TRY(measure_shells(mesh, &w->shells));
    TOBI_TRY(turn_shells(mesh, w, err));
    if (w->what == OPEN) {
        if (patched) mesh->triangle_count = w->holes.first;
        return TOBI_OK;
    }
    if (patched) TOBI_TRY(judge_holes(mesh, w, err));
    return find_overlaps(mesh, err);
}

static tobi_status orient(tobi_mesh *mesh, const char *name, enum surface what, tobi_error *err)
{
    if (!mesh->triangle_count)
        return tobi_fail(err, TOBI_INVALID, "mesh '%s': no triangles; a closed surface is needed", name);
    orient_work w = {.name = name, .what = what};
    tobi_status status = allocate_work(&w, mesh->triangle_count);
    if (status == TOBI_OK) status = orient_mesh(mesh, &w, err);
    if (status == TOBI_NO_MEMORY)
        tobi_fail(err, status, "mesh '%s': no memory to check %lld triangles", name,
                  (long long)mesh->triangle_count);
    free_work(&w);
    return status;
}

tobi_status tobi_mesh_orient(tobi_mesh *mesh, const char *name, tobi_error *err)
{
    return orient(mesh, name, CLOSED, err);
}

tobi_status tobi_mesh_orient_open(tobi_mesh *mesh, const char *name, tobi_error *err)
{
    return orient(mesh, name, OPEN, err);
}

tobi_status tobi_mesh_orient_vessel(tobi_mesh *mesh, const char *name, tobi_error *err)
{
    return orient(mesh, name, VESSEL, err);
}
