/* Closedness and orientation: match edges, flood each connected shell until its triangles agree,
   then turn whole shells by how many other shells they lie in (even outward, odd inward).

   A shell lies in another one when its box does and the winding number (solid angle sum of
   van Oosterom & Strackee 1983) of three of its triangles says so. Drawback: shells that overlap
   without one holding the other count as separate solids. */
#include "geom/edges.h"
#include "geom/mesh.h"
#include "geom/vec3.h"
#include <stdlib.h>

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
    shell_set shells;
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
    *w = (orient_work){0};
    w->opposite = malloc((size_t)n*sizeof *w->opposite);
    w->stack = malloc((size_t)n*sizeof *w->stack);
    w->turn = malloc((size_t)n);
    w->shells.of_triangle = malloc((size_t)n*sizeof(int32_t));
    w->shells.order = malloc((size_t)n*sizeof(int32_t));
    return w->opposite && w->stack && w->turn && w->shells.of_triangle && w->shells.order
               ? TOBI_OK : TOBI_NO_MEMORY;
}

static tobi_status fail_open(const tobi_mesh *mesh, const char *name, const tobi_edge_report *r,
                             tobi_error *err)
{
    const double *a = mesh->vertices[r->ends[0]], *b = mesh->vertices[r->ends[1]];
    return tobi_fail(err, TOBI_INVALID, "mesh '%s' is not closed: %lld open edges (one triangle) and "
                     "%lld edges with more than two triangles, the first from (%.6g, %.6g, %.6g) to "
                     "(%.6g, %.6g, %.6g); allowed is a surface whose every edge belongs to exactly two "
                     "triangles (%lld triangles were read)", name, (long long)r->open,
                     (long long)r->crowded, a[0], a[1], a[2], b[0], b[1], b[2],
                     (long long)mesh->triangle_count);
}

/* True if half-edges h and g run from the same vertex, that is, if their triangles disagree. */
static int runs_alike(const tobi_mesh *mesh, int32_t h, int32_t g)
{
    return mesh->triangles[h/3][h % 3] == mesh->triangles[g/3][g % 3];
}

/* Visits one shell from a seed triangle. Returns the half-edge where two triangles cannot be made to
   agree, or -1. */
static int32_t flood_shell(const tobi_mesh *mesh, orient_work *w, int32_t seed, int32_t shell)
{
    int64_t top = 0;
    w->stack[top++] = seed;
    w->turn[seed] = 0;
    w->shells.of_triangle[seed] = shell;
    while (top) {
        int32_t t = w->stack[--top];
        for (int k = 0; k < 3; k++) {
            int32_t g = w->opposite[t][k], u = g/3;
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

/* Winding number of p in one shell: +-1 inside, 0 outside. */
static double wind_around(const tobi_mesh *mesh, const shell_set *s, int64_t shell, const double p[3])
{
    double sum = 0;
    for (int64_t j = s->start[shell]; j < s->start[shell + 1]; j++) {
        double e[3][3], n[3], l[3];
        for (int c = 0; c < 3; c++) {
            vec3_sub(e[c], mesh->vertices[mesh->triangles[s->order[j]][c]], p);
            l[c] = vec3_length(e[c]);
        }
        vec3_cross(n, e[1], e[2]);
        sum += atan2(vec3_dot(e[0], n), l[0]*l[1]*l[2] + vec3_dot(e[0], e[1])*l[2] +
                     vec3_dot(e[1], e[2])*l[0] + vec3_dot(e[2], e[0])*l[1]);
    }
    return sum/(2*3.14159265358979323846);
}

static int lies_in(const tobi_mesh *mesh, const shell_set *s, int64_t inner, int64_t outer)
{
    const double *a = s->box[inner], *b = s->box[outer];
    for (int k = 0; k < 3; k++)
        if (a[k] < b[k] || a[3 + k] > b[3 + k]) return 0;
    int64_t first = s->start[inner], n = s->start[inner + 1] - first;
    for (int i = 0; i < 3; i++) {
        const int32_t *t = mesh->triangles[s->order[first + i*(n - 1)/2]];
        double p[3];
        for (int k = 0; k < 3; k++)
            p[k] = (mesh->vertices[t[0]][k] + mesh->vertices[t[1]][k] + mesh->vertices[t[2]][k])/3;
        if (fabs(wind_around(mesh, s, outer, p)) < 0.5) return 0;
    }
    return 1;
}

static tobi_status turn_shells(tobi_mesh *mesh, shell_set *s, const char *name, tobi_error *err)
{
    for (int64_t i = 0; i < s->count; i++) {
        const double *b = s->box[i];
        double size = fmax(b[3] - b[0], fmax(b[4] - b[1], b[5] - b[2])), depth = 0;
        if (fabs(s->volume[i]) <= 1e-12*size*size*size)
            return tobi_fail(err, TOBI_INVALID, "mesh '%s': the shell around (%.6g, %.6g, %.6g) encloses "
                             "no volume; a body needs an inside", name, (b[0] + b[3])/2,
                             (b[1] + b[4])/2, (b[2] + b[5])/2);
        for (int64_t j = 0; j < s->count; j++)
            if (j != i && lies_in(mesh, s, i, j)) depth++;
        if ((s->volume[i] < 0) == (fmod(depth, 2) == 1)) continue;
        for (int64_t j = s->start[i]; j < s->start[i + 1]; j++) turn_triangle(mesh->triangles[s->order[j]]);
    }
    return TOBI_OK;
}

static tobi_status orient_mesh(tobi_mesh *mesh, const char *name, orient_work *w, tobi_error *err)
{
    tobi_edge_report report;
    TOBI_TRY(tobi_edges_match(mesh->vertex_count, mesh->triangle_count,
                              (const int32_t (*)[3])mesh->triangles, w->opposite, &report));
    if (report.open || report.crowded) return fail_open(mesh, name, &report, err);
    for (int64_t t = 0; t < mesh->triangle_count; t++) w->turn[t] = -1;
    for (int64_t t = 0; t < mesh->triangle_count; t++) {
        if (w->turn[t] >= 0) continue;
        int32_t bad = flood_shell(mesh, w, (int32_t)t, (int32_t)w->shells.count++);
        if (bad < 0) continue;
        const double *x = mesh->vertices[mesh->triangles[bad/3][bad % 3]];
        return tobi_fail(err, TOBI_INVALID, "mesh '%s' has no inside: its triangles cannot be made to "
                         "agree at (%.6g, %.6g, %.6g), as on a Moebius band", name, x[0], x[1], x[2]);
    }
    for (int64_t t = 0; t < mesh->triangle_count; t++)
        if (w->turn[t]) turn_triangle(mesh->triangles[t]);
    TOBI_TRY(measure_shells(mesh, &w->shells));
    return turn_shells(mesh, &w->shells, name, err);
}

tobi_status tobi_mesh_orient(tobi_mesh *mesh, const char *name, tobi_error *err)
{
    if (!mesh->triangle_count)
        return tobi_fail(err, TOBI_INVALID, "mesh '%s': no triangles; a closed surface is needed", name);
    orient_work w;
    tobi_status status = allocate_work(&w, mesh->triangle_count);
    if (status == TOBI_OK) status = orient_mesh(mesh, name, &w, err);
    if (status == TOBI_NO_MEMORY)
        tobi_fail(err, status, "mesh '%s': no memory to check %lld triangles", name,
                  (long long)mesh->triangle_count);
    free_work(&w);
    return status;
}
