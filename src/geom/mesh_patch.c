/* Closing holes. Open edges are walked into loops, at a crossing the sharpest way back, so that a crack
   between two tessellations of one edge falls into slivers; each loop is cut into triangles by ears in
   its own plane. Whether the patches are right is asked of the surface without them: the generalised
   winding number there is the whole number of the closed surface less the solid angle of the patches,
   exactly, so no sum over the surface is needed. */
#include "geom/lines.h"
#include "geom/mesh_mend.h"
#include "geom/vec3.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
enum { POINTS = 40 };             /* sampling points along the longest side                        */
#define MAX_ANGLES 2e8            /* points times patches                                          */

typedef struct patcher {
    tobi_mesh *mesh;
    int64_t room;                 /* of triangles                                                  */
    int64_t *start;               /* per vertex, into leaving                                      */
    int32_t *leaving;             /* open half-edges by their first vertex                         */
    char *used;                   /* of each entry of leaving                                      */
    int32_t *loop;                /* vertices                                                      */
    double (*flat)[2];            /* of the loop in its plane                                      */
    tobi_holes *holes;
} patcher;

/* --- loops -------------------------------------------------------------------------------- */

static tobi_status list_open(patcher *p, const int32_t (*opposite)[3])
{
    const tobi_mesh *m = p->mesh;
    int64_t n = 0;
    p->start = calloc((size_t)m->vertex_count + 2, sizeof *p->start);
    if (!p->start) return TOBI_NO_MEMORY;
    for (int64_t h = 0; h < 3*m->triangle_count; h++) {
        if (opposite[h/3][h % 3] != TOBI_EDGE_OPEN) continue;
        p->start[m->triangles[h/3][h % 3] + 2]++;
        n++;
    }
    p->leaving = malloc((size_t)(n + 1)*sizeof *p->leaving);
    p->used = calloc((size_t)n + 1, 1);
    p->loop = malloc((size_t)(n + 1)*sizeof *p->loop);
    p->flat = malloc((size_t)(n + 1)*sizeof *p->flat);
    if (!p->leaving || !p->used || !p->loop || !p->flat) return TOBI_NO_MEMORY;
    for (int64_t v = 0; v < m->vertex_count; v++) p->start[v + 2] += p->start[v + 1];
    for (int64_t h = 0; h < 3*m->triangle_count; h++)
        if (opposite[h/3][h % 3] == TOBI_EDGE_OPEN)
            p->leaving[p->start[m->triangles[h/3][h % 3] + 1]++] = (int32_t)h;
    p->holes->edges = n;
    return TOBI_OK;
}

static int32_t head_of(const tobi_mesh *m, int32_t half) { return m->triangles[half/3][(half % 3 + 1) % 3]; }

/* The unused open half-edge from vertex v that turns back most sharply towards `from`; -1 if none. */
static int64_t find_next(const patcher *p, int32_t from, int32_t v)
{
    const tobi_mesh *m = p->mesh;
    double back[3], best = -INFINITY;
    int64_t found = -1;
    vec3_sub(back, m->vertices[from], m->vertices[v]);
    vec3_normalize(back);
    for (int64_t i = p->start[v]; i < p->start[v + 1]; i++) {
        double to[3];
        if (p->used[i]) continue;
        vec3_sub(to, m->vertices[head_of(m, p->leaving[i])], m->vertices[v]);
        vec3_normalize(to);
        if (vec3_dot(to, back) <= best) continue;
        best = vec3_dot(to, back);
        found = i;
    }
    return found;
}

/* Walks a loop from an entry of leaving; the vertices go to p->loop. 0 if it does not come back. */
static int64_t walk_loop(patcher *p, int64_t entry)
{
    int64_t n = 0;
    int32_t first = p->mesh->triangles[p->leaving[entry]/3][p->leaving[entry] % 3], at = first;
    while (entry >= 0) {
        int32_t to = head_of(p->mesh, p->leaving[entry]);
        p->used[entry] = 1;
        p->loop[n++] = at;
        if (to == first) return n;
        entry = find_next(p, at, to);
        at = to;
    }
    return 0;
}

static void record_hole(patcher *p, int64_t n)
{
    tobi_holes *h = p->holes;
    double centre[3] = {0}, length = 0;
    for (int64_t i = 0; i < n; i++) {
        const double *a = p->mesh->vertices[p->loop[i]], *b = p->mesh->vertices[p->loop[(i + 1) % n]];
        double step = sqrt(vec3_distance2(a, b));
        length += step;
        for (int k = 0; k < 3; k++) centre[k] += 0.5*step*(a[k] + b[k]);
    }
    h->count++;
    int i = h->listed < 3 ? h->listed++ : 3;
    for (; i > 0 && h->largest[i - 1].length < length; i--)
        if (i < 3) h->largest[i] = h->largest[i - 1];
    if (i == 3) return;
    for (int k = 0; k < 3; k++) h->largest[i].centre[k] = length > 0 ? centre[k]/length : centre[k];
    h->largest[i].length = length;
    h->largest[i].edges = n;
}

/* --- patches ------------------------------------------------------------------------------ */

static int add_triangle(patcher *p, int32_t a, int32_t b, int32_t c)
{
    tobi_mesh *m = p->mesh;
    if (a == b || b == c || c == a) return 1;
    if (m->triangle_count == p->room) {
        int64_t room = p->room + p->room/8 + 64;
        int32_t (*more)[3] = realloc(m->triangles, (size_t)(room + 1)*sizeof *more);
        if (!more || room > INT32_MAX/3) return 0;
        m->triangles = more;
        p->room = room;
    }
    memcpy(m->triangles[m->triangle_count++], (int32_t[3]){a, b, c}, sizeof *m->triangles);
    return 1;
}

static double turn_of(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0])*(c[1] - a[1]) - (b[1] - a[1])*(c[0] - a[0]);
}

/* The loop in the plane of its area vector (Newell), turned so that it runs counter-clockwise. */
static void flatten_loop(patcher *p, int64_t n)
{
    double normal[3] = {0}, x[3], y[3];
    const double *o = p->mesh->vertices[p->loop[0]];
    for (int64_t i = 1; i + 1 < n; i++) {
        double a[3], b[3], c[3];
        vec3_sub(a, p->mesh->vertices[p->loop[i]], o);
        vec3_sub(b, p->mesh->vertices[p->loop[i + 1]], o);
        vec3_cross(c, a, b);
        vec3_add_scaled(normal, normal, 1, c);
    }
    vec3_normalize(normal);
    int k = fabs(normal[0]) < fabs(normal[1]) ? 0 : 1;
    if (fabs(normal[2]) < fabs(normal[k])) k = 2;
    vec3_cross(x, normal, (double[3]){k == 0, k == 1, k == 2});
    vec3_normalize(x);
    vec3_cross(y, normal, x);
    for (int64_t i = 0; i < n; i++) {
        double r[3];
        vec3_sub(r, p->mesh->vertices[p->loop[i]], o);
        p->flat[i][0] = vec3_dot(r, x);
        p->flat[i][1] = vec3_dot(r, y);
    }
}

/* An ear: a corner that turns left, with no other corner of the loop in its triangle. */
static int is_ear(const patcher *p, int64_t n, int64_t i)
{
    const double *a = p->flat[(i + n - 1) % n], *b = p->flat[i], *c = p->flat[(i + 1) % n];
    if (!(turn_of(a, b, c) > 0)) return 0;
    for (int64_t j = 0; j < n; j++) {
        const double *q = p->flat[j];
        if (j == i || j == (i + 1) % n || j == (i + n - 1) % n) continue;
        if (turn_of(a, b, q) >= 0 && turn_of(b, c, q) >= 0 && turn_of(c, a, q) >= 0 &&
            !(q[0] == a[0] && q[1] == a[1]) && !(q[0] == c[0] && q[1] == c[1])) return 0;
    }
    return 1;
}

/* Cuts ears off the loop until nothing is left; where no corner is one (a loop that crosses itself or
   has no area), any corner goes. The patch runs against the open edges. */
static int fill_loop(patcher *p, int64_t n)
{
    flatten_loop(p, n);
    for (int64_t i = 0, misses = 0; n > 3; i = (i + 1) % n) {
        if (!is_ear(p, n, i) && misses++ < n) continue;
        if (!add_triangle(p, p->loop[i], p->loop[(i + n - 1) % n], p->loop[(i + 1) % n])) return 0;
        memmove(p->loop + i, p->loop + i + 1, (size_t)(n - i - 1)*sizeof *p->loop);
        memmove(p->flat + i, p->flat + i + 1, (size_t)(n - i - 1)*sizeof *p->flat);
        n--;
        misses = 0;
        if (i >= n) i = 0;
    }
    return n < 3 || add_triangle(p, p->loop[1], p->loop[0], p->loop[2]);
}

tobi_status tobi_mesh_patch(tobi_mesh *mesh, const int32_t (*opposite)[3], tobi_holes *holes)
{
    patcher p = {.mesh = mesh, .room = mesh->triangle_count, .holes = holes};
    *holes = (tobi_holes){.first = mesh->triangle_count};
    tobi_status status = list_open(&p, opposite);
    for (int64_t i = 0; status == TOBI_OK && i < holes->edges; i++) {
        if (p.used[i]) continue;
        int64_t n = walk_loop(&p, i);
        if (n) record_hole(&p, n);
        if (n && !fill_loop(&p, n)) status = TOBI_NO_MEMORY;
    }
    free(p.start);
    free(p.leaving);
    free(p.used);
    free(p.loop);
    free(p.flat);
    return status;
}

void tobi_holes_describe(const tobi_holes *h, char *text, size_t size)
{
    int used = snprintf(text, size, tr("%lld hole%s (%lld open edges)"), (long long)h->count,
                        h->count == 1 ? "" : "s", (long long)h->edges);
    for (int i = 0; i < h->listed && used > 0 && (size_t)used < size; i++)
        used += snprintf(text + used, size - (size_t)used, tr("%s %.4g m around at (%.4g, %.4g, %.4g)"),
                         i ? "," : h->count > 3 ? tr(", the largest") : ":", h->largest[i].length,
                         h->largest[i].centre[0], h->largest[i].centre[1], h->largest[i].centre[2]);
}

/* --- what the surface says without its patches -------------------------------------------- */

/* Solid angle of the patches at p over 4 pi (van Oosterom & Strackee 1983). */
static double see_patches(const tobi_mesh *mesh, int64_t first, const double p[3])
{
    double sum = 0;
    for (int64_t t = first; t < mesh->triangle_count; t++) {
        double e[3][3], n[3], l[3];
        for (int c = 0; c < 3; c++) {
            vec3_sub(e[c], mesh->vertices[mesh->triangles[t][c]], p);
            l[c] = vec3_length(e[c]);
        }
        vec3_cross(n, e[1], e[2]);
        sum += atan2(vec3_dot(e[0], n), l[0]*l[1]*l[2] + vec3_dot(e[0], e[1])*l[2] +
                     vec3_dot(e[1], e[2])*l[0] + vec3_dot(e[2], e[0])*l[1]);
    }
    return sum/(2*PI);
}

/* Winding number of the closed surface on a line at z: what was entered and not left below. */
static int wind_below(const tobi_lines *l, int64_t line, double z)
{
    int wound = 0;
    for (int64_t c = l->start[line]; c < l->start[line + 1] && l->cuts[c].at < z; c++)
        wound += l->cuts[c].turn;
    return wound;
}

tobi_status tobi_holes_doubt(const tobi_mesh *mesh, const tobi_holes *holes, double *doubt)
{
    double min[3], max[3], size = 0, inside = 0, differ = 0;
    int64_t patches = mesh->triangle_count - holes->first, points = POINTS;
    tobi_lines l = {0};
    *doubt = 0;
    if (patches <= 0) return TOBI_OK;
    tobi_mesh_box(mesh, min, max);
    for (int k = 0; k < 3; k++) size = fmax(size, max[k] - min[k]);
    while (points > 10 && (double)points*(double)points*(double)points*(double)patches > MAX_ANGLES) points--;
    tobi_status status = tobi_lines_cut(&l, mesh, NULL, size/(double)points, NULL);
    for (int64_t i = 0; status == TOBI_OK && i < l.size[0]; i++)
        for (int64_t j = 0; j < l.size[1]; j++)
            for (double z = 0.5*(min[2] - max[2]); z <= 0.5*(max[2] - min[2]); z += l.fine) {
                double p[3] = {l.middle[0] + (double)(i + l.low[0])*l.fine,
                               l.middle[1] + (double)(j + l.low[1])*l.fine, l.middle[2] + z};
                int wound = wind_below(&l, i*l.size[1] + j, z);
                double open = wound - see_patches(mesh, holes->first, p);
                inside += wound > 0;
                differ += (wound > 0) != (open > 0.5) && fabs(open - 0.5) > 1e-6;
            }
    tobi_lines_free(&l);
    *doubt = inside > 0 ? differ/inside : differ > 0 ? INFINITY : 0;
    return status == TOBI_OK ? TOBI_OK : TOBI_NO_MEMORY;
}
