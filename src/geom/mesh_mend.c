/* Mending a surface whose edges do not belong to two triangles each, without moving what is closed.

   Only vertices on borders are welded, so that thin parts keep their thickness. Edges where several
   solids, or parts of one, touch are taken apart by angle: two triangles with the material between them
   stay together. Where the parts hang together around both ends of the edge, doubling its ends would
   not part them, so all pairs of triangles but one get a middle vertex of their own. Drawback: a few
   more triangles. */
#include "geom/mesh_mend.h"
#include "geom/vec3.h"
#include <stdlib.h>
#include <string.h>

#define TURN 6.28318530717958647692

/* Border tolerances tried, as parts of the box: single precision, six and four digits of a text file,
   the chord error of a coarse tessellation. */
static const double tolerances[] = {1e-7, 1e-6, 1e-5, 1e-4, 1e-3};

static tobi_status count_faults(const tobi_mesh *mesh, int32_t (**opposite)[3], tobi_edge_report *report)
{
    free(*opposite);
    *opposite = malloc((size_t)(mesh->triangle_count + 1)*sizeof **opposite);
    if (!*opposite) return TOBI_NO_MEMORY;
    return tobi_edges_match(mesh->vertex_count, mesh->triangle_count,
                            (const int32_t (*)[3])mesh->triangles, *opposite, report);
}

static void swap_meshes(tobi_mesh *a, tobi_mesh *b)
{
    tobi_mesh swap = *a;
    *a = *b;
    *b = swap;
}

/* --- welding borders ---------------------------------------------------------------------- */

static void mark_borders(const tobi_mesh *mesh, const int32_t (*opposite)[3], char *mark)
{
    memset(mark, 0, (size_t)mesh->vertex_count);
    for (int64_t t = 0; t < mesh->triangle_count; t++)
        for (int k = 0; k < 3; k++)
            if (opposite[t][k] < 0)
                mark[mesh->triangles[t][k]] = mark[mesh->triangles[t][(k + 1) % 3]] = 1;
}

/* A copy welded at one tolerance, kept if it is less open. */
static tobi_status try_weld(tobi_mesh *mesh, double tolerance, const char *mark,
                            tobi_edge_report *report, double *used)
{
    tobi_mesh copy;
    tobi_edge_report after = {0};
    int32_t (*opposite)[3] = NULL;
    TOBI_TRY(tobi_mesh_copy(mesh, &copy, NULL));
    tobi_status status = tobi_mesh_weld(&copy, tolerance, mark);
    if (status == TOBI_OK) status = count_faults(&copy, &opposite, &after);
    if (status == TOBI_OK && copy.triangle_count && after.open < report->open &&
        after.open + after.non_manifold < report->open + report->non_manifold) {
        copy.texture = mesh->texture;
        mesh->texture = NULL;
        swap_meshes(mesh, &copy);
        *report = after;
        *used = tolerance;
    }
    free(opposite);
    tobi_mesh_free(&copy);
    return status;
}

static tobi_status weld_borders(tobi_mesh *mesh, tobi_edge_report *report)
{
    int64_t before = report->open;
    double used = 0, min[3], max[3];
    tobi_mesh_box(mesh, min, max);
    double size = fmax(max[0] - min[0], fmax(max[1] - min[1], max[2] - min[2]));
    for (size_t i = 0; i < sizeof tolerances/sizeof *tolerances && report->open; i++) {
        int32_t (*opposite)[3] = NULL;
        tobi_edge_report same;
        char *mark = malloc((size_t)mesh->vertex_count + 1);
        tobi_status status = mark ? count_faults(mesh, &opposite, &same) : TOBI_NO_MEMORY;
        if (status == TOBI_OK) {
            mark_borders(mesh, (const int32_t (*)[3])opposite, mark);
            status = try_weld(mesh, tolerances[i], mark, report, &used);
        }
        free(mark);
        free(opposite);
        TOBI_TRY(status);
    }
    if (used > 0)
        tobi_mesh_note(mesh, tr("vertices on borders closer than %.3g m welded: %lld open edges became %lld"),
                       used*size, (long long)before, (long long)report->open);
    return TOBI_OK;
}

/* --- double triangles --------------------------------------------------------------------- */

typedef struct face_key { int32_t corner[3], triangle, odd; } face_key;

/* Corners in ascending order; odd: sorting turned the triangle. */
static face_key make_key(const int32_t t[3], int32_t triangle)
{
    face_key f = {{t[0], t[1], t[2]}, triangle, 0};
    for (int i = 0; i < 3; i++) {
        int k = i % 2;
        if (f.corner[k] <= f.corner[k + 1]) continue;
        int32_t swap = f.corner[k];
        f.corner[k] = f.corner[k + 1];
        f.corner[k + 1] = swap;
        f.odd ^= 1;
    }
    return f;
}

static int compare_faces(const void *a, const void *b)
{
    const face_key *p = a, *q = b;
    for (int k = 0; k < 3; k++)
        if (p->corner[k] != q->corner[k]) return p->corner[k] < q->corner[k] ? -1 : 1;
    return (p->triangle > q->triangle) - (p->triangle < q->triangle);
}

/* Of equal triangles one stays; two that face each other are an inner wall between solids: both go. */
static tobi_status drop_double_triangles(tobi_mesh *mesh)
{
    int64_t n = mesh->triangle_count, kept = 0;
    face_key *keys = malloc((size_t)(n + 1)*sizeof *keys);
    char *drop = calloc((size_t)n + 1, 1);
    if (!keys || !drop) {
        free(keys);
        free(drop);
        return TOBI_NO_MEMORY;
    }
    for (int64_t t = 0; t < n; t++) keys[t] = make_key(mesh->triangles[t], (int32_t)t);
    qsort(keys, (size_t)n, sizeof *keys, compare_faces);
    for (int64_t i = 0, j; i < n; i = j) {
        int64_t of[2] = {0, 0};
        for (j = i; j < n && !memcmp(keys[j].corner, keys[i].corner, sizeof keys[i].corner); j++)
            of[keys[j].odd]++;
        int keep = of[0] == of[1] ? -1 : of[0] > of[1] ? 0 : 1;
        for (int64_t k = i; k < j; k++) {
            if (keys[k].odd == keep) keep = -1;
            else drop[keys[k].triangle] = 1;
        }
    }
    for (int64_t t = 0; t < n; t++)
        if (!drop[t]) memmove(mesh->triangles[kept++], mesh->triangles[t], sizeof *mesh->triangles);
    if (kept < n && kept) {
        mesh->triangle_count = kept;
        tobi_mesh_note(mesh, tr("%lld double triangles dropped"), (long long)(n - kept));
    }
    free(keys);
    free(drop);
    return TOBI_OK;
}

/* --- edges of more than two triangles ----------------------------------------------------- */

typedef struct spoke {
    double angle;                 /* of the third corner around the edge                           */
    int32_t half, along;          /* half-edge; 1 if it runs from the lower vertex to the upper     */
    int32_t low, high;
} spoke;

static int compare_edges(const void *a, const void *b)
{
    const spoke *p = a, *q = b;
    if (p->low != q->low) return p->low < q->low ? -1 : 1;
    if (p->high != q->high) return p->high < q->high ? -1 : 1;
    if (p->angle != q->angle) return p->angle < q->angle ? -1 : 1;
    return (p->half > q->half) - (p->half < q->half);
}

static void measure_angle(const tobi_mesh *mesh, spoke *s)
{
    const double *a = mesh->vertices[s->low], *b = mesh->vertices[s->high],
                 *c = mesh->vertices[mesh->triangles[s->half/3][(s->half % 3 + 2) % 3]];
    double axis[3], x[3], y[3], r[3];
    vec3_sub(axis, b, a);
    vec3_normalize(axis);
    int k = fabs(axis[0]) < fabs(axis[1]) ? 0 : 1;
    if (fabs(axis[2]) < fabs(axis[k])) k = 2;
    vec3_cross(x, axis, (double[3]){k == 0, k == 1, k == 2});
    vec3_cross(y, axis, x);
    vec3_sub(r, c, a);
    s->angle = atan2(vec3_dot(r, y), vec3_dot(r, x));
}

/* Pairs outward triangles that run along an edge with the nearest one below (way -1, the side of their
   material) or above (way 1, the side of the air) that runs against it. Returns the widest angle within a
   pair. */
static double pair_spokes(const spoke *s, int64_t n, int way, int32_t *opposite)
{
    double widest = 0;
    for (int64_t i = 0; i < n; i++) {
        if (!s[i].along) continue;
        int64_t depth = 0, j = i;
        do {
            depth += s[j].along ? 1 : -1;
            if (!depth) break;
            j = (j + n + way) % n;
        } while (j != i);
        opposite[s[i].half] = s[j].half;
        opposite[s[j].half] = s[i].half;
        double angle = way*(s[j].angle - s[i].angle);
        widest = fmax(widest, angle < 0 ? angle + TURN : angle);
    }
    return widest;
}

/* The pseudonormal of a pair of triangles tells inside from outside around their edge only for the pair's
   own wedge, so that is the narrow one: material, or air if a part has more than 180 degrees there. */
static void pair_edge(const spoke *s, int64_t n, int32_t *opposite)
{
    int64_t balance = 0;
    for (int64_t i = 0; i < n; i++) balance += s[i].along ? 1 : -1;
    if (balance || n < 4) return;
    if (pair_spokes(s, n, -1, opposite) > TURN/2) pair_spokes(s, n, 1, opposite);
}

/* Gives every fan of triangles that hang together around a vertex a vertex of its own. */
static tobi_status split_vertices(tobi_mesh *mesh, const int32_t *opposite)
{
    int64_t n = 3*mesh->triangle_count, room = mesh->vertex_count + n;
    double (*vertices)[3] = malloc((size_t)(room + 1)*sizeof *vertices);
    int32_t *owner = malloc((size_t)(n + 1)*sizeof *owner);      /* vertex of each corner, -1 unseen */
    char *seen = calloc((size_t)mesh->vertex_count + 1, 1);
    int64_t count = mesh->vertex_count;
    if (!vertices || !owner || !seen || room > INT32_MAX) {
        free(vertices);
        free(owner);
        free(seen);
        return TOBI_NO_MEMORY;
    }
    memcpy(vertices, mesh->vertices, (size_t)count*sizeof *vertices);
    memset(owner, 0xff, (size_t)n*sizeof *owner);
    for (int64_t start = 0; start < n; start++) {
        if (owner[start] >= 0) continue;
        int32_t v = mesh->triangles[start/3][start % 3], me = v;
        if (seen[v]) {
            me = (int32_t)count++;
            memcpy(vertices[me], mesh->vertices[v], sizeof *vertices);
        }
        seen[v] = 1;
        owner[start] = me;
        for (int side = 0; side < 2; side++) {
            /* cross the edge that leaves, or arrives at, this corner; then always the other one at v */
            int64_t edge = side ? 3*(start/3) + (start + 2) % 3 : start;
            for (int32_t g; (g = opposite[edge]) >= 0;) {
                int64_t c = mesh->triangles[g/3][g % 3] == v ? g : 3*(g/3) + (g + 1) % 3;
                if (owner[c] >= 0) break;
                owner[c] = me;
                edge = c == g ? 3*(c/3) + (c + 2) % 3 : c;
            }
        }
    }
    for (int64_t c = 0; c < n; c++) mesh->triangles[c/3][c % 3] = owner[c];
    free(mesh->vertices);
    mesh->vertices = vertices;
    mesh->vertex_count = count;
    free(owner);
    free(seen);
    return TOBI_OK;
}

/* The half-edges of non-manifold edges, by edge and by angle around it; *out is malloced. */
static tobi_status find_spokes(const tobi_mesh *mesh, const int32_t (*opposite)[3], spoke **out,
                               int64_t *count)
{
    int64_t n = 0;
    for (int64_t h = 0; h < 3*mesh->triangle_count; h++) n += opposite[h/3][h % 3] == TOBI_EDGE_NON_MANIFOLD;
    spoke *s = malloc((size_t)(n + 1)*sizeof *s);
    *out = s;
    *count = n;
    if (!s) return TOBI_NO_MEMORY;
    n = 0;
    for (int64_t h = 0; h < 3*mesh->triangle_count; h++) {
        if (opposite[h/3][h % 3] != TOBI_EDGE_NON_MANIFOLD) continue;
        int32_t a = mesh->triangles[h/3][h % 3], b = mesh->triangles[h/3][(h % 3 + 1) % 3];
        s[n] = (spoke){0, (int32_t)h, a < b, a < b ? a : b, a < b ? b : a};
        measure_angle(mesh, &s[n++]);
    }
    qsort(s, (size_t)n, sizeof *s, compare_edges);
    return TOBI_OK;
}

static int64_t end_of_edge(const spoke *s, int64_t i, int64_t n)
{
    int64_t j = i + 1;
    while (j < n && s[j].low == s[i].low && s[j].high == s[i].high) j++;
    return j;
}

/* Parts the edges by doubling the vertices at their ends; opposite receives the pairs of triangles. */
static tobi_status split_edges(tobi_mesh *mesh, int32_t (*opposite)[3])
{
    spoke *s;
    int64_t n;
    TOBI_TRY(find_spokes(mesh, (const int32_t (*)[3])opposite, &s, &n));
    for (int64_t i = 0, j; i < n; i = j) {
        j = end_of_edge(s, i, n);
        pair_edge(s + i, j - i, &opposite[0][0]);
    }
    free(s);
    return split_vertices(mesh, &opposite[0][0]);
}

/* Cuts a triangle from the middle m of its half-edge to the corner across. */
static void cut_triangle(tobi_mesh *mesh, int32_t half, int32_t m)
{
    int32_t *t = mesh->triangles[half/3], *new = mesh->triangles[mesh->triangle_count++];
    int k = half % 3, next = (k + 1) % 3;
    new[0] = m;
    new[1] = t[next];
    new[2] = t[(k + 2) % 3];
    t[next] = m;
}

/* Parts the edges that still are non-manifold (now) by middle vertices for all pairs (paired) but the first.
   A triangle is cut once in a call; *cuts is how many pairs were. */
static tobi_status cut_edges(tobi_mesh *mesh, const int32_t (*now)[3], const int32_t *paired, int64_t *cuts)
{
    spoke *s;
    int64_t n, room = mesh->triangle_count;
    *cuts = 0;
    TOBI_TRY(find_spokes(mesh, now, &s, &n));
    char *touched = calloc((size_t)room + 1, 1);
    int32_t (*triangles)[3] = realloc(mesh->triangles, (size_t)(room + n + 1)*sizeof *triangles);
    if (triangles) mesh->triangles = triangles;
    double (*vertices)[3] = realloc(mesh->vertices, (size_t)(mesh->vertex_count + n + 1)*sizeof *vertices);
    if (vertices) mesh->vertices = vertices;
    int fits = touched && triangles && vertices && 3*(room + n) <= INT32_MAX;
    for (int64_t i = 0, j; fits && i < n; i = j) {
        j = end_of_edge(s, i, n);
        for (int64_t k = i, pairs = 0; k < j; k++) {
            int32_t h = s[k].half, g = paired[h];
            if (!s[k].along || g < 0 || !pairs++ || touched[h/3] || touched[g/3]) continue;
            int32_t m = (int32_t)mesh->vertex_count++;
            const double *a = mesh->vertices[s[k].low], *b = mesh->vertices[s[k].high];
            for (int c = 0; c < 3; c++) mesh->vertices[m][c] = 0.5*(a[c] + b[c]);
            cut_triangle(mesh, h, m);
            cut_triangle(mesh, g, m);
            touched[h/3] = touched[g/3] = 1;
            ++*cuts;
        }
    }
    free(touched);
    free(s);
    return fits ? TOBI_OK : TOBI_NO_MEMORY;
}

/* Takes edges apart until none is non-manifold, or only such where no pairs can be made. opposite is that of
   the mesh and is freed. */
static tobi_status part_non_manifold(tobi_mesh *mesh, int32_t (*opposite)[3], tobi_edge_report report)
{
    tobi_status status = TOBI_OK;
    tobi_mesh_note(mesh, tr("%lld edges with more than two triangles taken apart: parts that touch there "
                   "stay apart"), (long long)report.non_manifold);
    for (int64_t cuts = 1; status == TOBI_OK && report.non_manifold && cuts;) {
        int32_t (*now)[3] = NULL;
        cuts = 0;
        status = split_edges(mesh, opposite);
        if (status == TOBI_OK) status = count_faults(mesh, &now, &report);
        if (status == TOBI_OK && report.non_manifold)
            status = cut_edges(mesh, (const int32_t (*)[3])now, &opposite[0][0], &cuts);
        free(now);
        if (status == TOBI_OK && cuts) status = count_faults(mesh, &opposite, &report);
    }
    free(opposite);
    return status;
}

tobi_status tobi_mesh_mend(tobi_mesh *mesh)
{
    int32_t (*opposite)[3] = NULL;
    tobi_edge_report report = {0};
    tobi_status status = count_faults(mesh, &opposite, &report);
    if (status == TOBI_OK && report.non_manifold) {
        status = drop_double_triangles(mesh);
        if (status == TOBI_OK) status = count_faults(mesh, &opposite, &report);
    }
    if (status == TOBI_OK && report.open) {
        status = weld_borders(mesh, &report);
        if (status == TOBI_OK) status = drop_double_triangles(mesh);
        if (status == TOBI_OK) status = count_faults(mesh, &opposite, &report);
    }
    if (status == TOBI_OK && report.non_manifold) return part_non_manifold(mesh, opposite, report);
    free(opposite);
    return status;
}
