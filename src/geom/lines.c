/* Cutting a mesh by lines: rows of constant y are cut with each triangle, the lines of a row with the
   piece between. The half-open rule of polygon filling (an edge's upper end is not part of it), each
   edge always from its lower-numbered vertex: a line through an edge or a vertex is still cut an even
   number of times. */
#include "geom/lines.h"
#include "geom/vec3.h"
#include <stdlib.h>
#include <string.h>

#define MAX_LINES 400000000LL

typedef tobi_line_cut cut;

void tobi_lines_free(tobi_lines *l)
{
    free(l->start);
    free(l->cuts);
}

/* Files a cut (pass 1), or only counts it (pass 0). */
static void add_cut(tobi_lines *l, int pass, int64_t line, double at, int turn)
{
    if (pass == 0) l->start[line + 2]++;
    else l->cuts[l->start[line + 1]++] = (cut){at, turn};
}

/* Where the row y cuts the edge from p to q, which it straddles: x and z. */
static void cut_edge(const double p[3], const double q[3], double y, double out[2])
{
    double s = (y - p[1])/(q[1] - p[1]);
    out[0] = p[0] + s*(q[0] - p[0]);
    out[1] = p[2] + s*(q[2] - p[2]);
}

/* Cuts the lines of one row that meet a triangle (corners relative to the middle). */
static void cut_row(tobi_lines *l, int pass, double corner[3][3], const int32_t t[3], int64_t j)
{
    double y = (double)j*l->fine, rise[2] = {0}, fall[2] = {0};
    int found = 0;
    for (int k = 0; k < 3; k++) {
        int next = (k + 1) % 3;
        int up = corner[k][1] <= y && corner[next][1] > y, down = corner[next][1] <= y && corner[k][1] > y;
        if (!up && !down) continue;
        int from = t[k] < t[next] ? k : next, to = from == k ? next : k;
        cut_edge(corner[from], corner[to], y, up ? rise : fall);
        found++;
    }
    if (found != 2 || rise[0] == fall[0]) return;
    /* a rising edge on the right: seen from +z the triangle runs counter-clockwise and faces up */
    int turn = rise[0] > fall[0] ? -1 : 1;
    const double *left = turn < 0 ? fall : rise, *right = turn < 0 ? rise : fall;
    int64_t i = (int64_t)ceil(left[0]/l->fine) - 1, end = (int64_t)ceil(right[0]/l->fine) + 1;
    for (; i <= end; i++) {
        double x = (double)i*l->fine;
        if (x < left[0] || x >= right[0]) continue;
        double s = (x - left[0])/(right[0] - left[0]);
        add_cut(l, pass, tobi_line_index(l, i, j), left[1] + s*(right[1] - left[1]), turn);
    }
}

static void cut_triangles(tobi_lines *l, int pass, const tobi_mesh *mesh)
{
    for (int64_t t = 0; t < mesh->triangle_count; t++) {
        double corner[3][3], low = INFINITY, high = -INFINITY;
        for (int c = 0; c < 3; c++) {
            vec3_sub(corner[c], mesh->vertices[mesh->triangles[t][c]], l->middle);
            low = fmin(low, corner[c][1]);
            high = fmax(high, corner[c][1]);
        }
        int64_t end = (int64_t)floor(high/l->fine);
        for (int64_t j = (int64_t)ceil(low/l->fine); j <= end; j++)
            cut_row(l, pass, corner, mesh->triangles[t], j);
    }
}

static void cut_pieces(tobi_lines *l, int pass, const tobi_section *s)
{
    for (int64_t n = 0; n < s->count; n++) {
        double a[2], b[2];
        for (int k = 0; k < 2; k++) {
            a[k] = s->from[n][k] - l->middle[k];
            b[k] = s->to[n][k] - l->middle[k];
        }
        /* the inside lies on the left: a piece running to +x is entered on the way up */
        int turn = a[0] < b[0] ? 1 : -1;
        const double *left = turn > 0 ? a : b, *right = turn > 0 ? b : a;
        int64_t i = (int64_t)ceil(left[0]/l->fine) - 1, end = (int64_t)ceil(right[0]/l->fine) + 1;
        for (; i <= end; i++) {
            double x = (double)i*l->fine;
            if (x < left[0] || x >= right[0]) continue;
            double f = (x - left[0])/(right[0] - left[0]);
            add_cut(l, pass, tobi_line_index(l, i, 0), left[1] + f*(right[1] - left[1]), turn);
        }
    }
}

static int compare_cuts(const void *a, const void *b)
{
    const cut *p = a, *q = b;
    if (p->at != q->at) return p->at < q->at ? -1 : 1;
    return q->turn - p->turn;
}

tobi_status tobi_lines_cut(tobi_lines *l, const tobi_mesh *mesh, const tobi_section *section,
                           double fine, tobi_error *err)
{
    double min[3], max[3];
    tobi_mesh_box(mesh, min, max);
    l->dimension = section ? 2 : 3;
    l->fine = fine;
    for (int k = 0; k < 3; k++) l->middle[k] = section && k == 2 ? 0 : 0.5*(min[k] + max[k]);
    double estimate = 1;
    for (int k = 0; k < 2; k++) {
        double half = section && k ? 0 : 0.5*(max[k] - min[k])/l->fine;
        estimate *= 2*half + 3;
        if (!(estimate < (double)MAX_LINES))
            return tobi_fail(err, TOBI_INVALID,
                             "lines every %g m are too fine for a body of %g x %g x %g m; a larger "
                             "body spacing asks for less", fine, max[0] - min[0], max[1] - min[1],
                             max[2] - min[2]);
        l->low[k] = -(int64_t)half - 2;
        l->size[k] = section && k ? 1 : 2*((int64_t)half + 2) + 1;
        if (section && k) l->low[k] = 0;
    }
    int64_t n = l->size[0]*l->size[1];
    l->start = calloc((size_t)n + 2, sizeof *l->start);
    for (int pass = 0; pass < 2 && l->start; pass++) {
        if (section) cut_pieces(l, pass, section);
        else cut_triangles(l, pass, mesh);
        if (pass) continue;
        for (int64_t i = 0; i < n; i++) l->start[i + 2] += l->start[i + 1];
        l->cuts = malloc((size_t)(l->start[n + 1] + 1)*sizeof *l->cuts);
        if (!l->cuts) break;
    }
    if (!l->start || !l->cuts)
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for lines every %g m through a body", fine);
    for (int64_t i = 0; i < n; i++)
        qsort(l->cuts + l->start[i], (size_t)(l->start[i + 1] - l->start[i]), sizeof *l->cuts,
              compare_cuts);
    return TOBI_OK;
}
