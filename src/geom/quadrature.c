/* Surface pieces. Halving the longest edge keeps the pieces of a sliver few and their areas powers
   of two of the triangle's. */
#include "geom/quadrature.h"
#include "exec/exec.h"
#include "geom/section.h"
#include "geom/vec3.h"
#include <stdlib.h>
#include <string.h>

#define MAX_PIECES 2000000000LL

typedef struct piece {
    double corner[3][3];     /* barycentric corners                       */
    double fraction;
} piece;

void tobi_quadrature_free(tobi_quadrature *s)
{
    if (!s) return;
    free(s->triangle);
    free(s->a);
    free(s->b);
    free(s->fraction);
    *s = (tobi_quadrature){0};
}

static tobi_status allocate_surface(tobi_quadrature *s, int64_t count, int dimension, tobi_error *err)
{
    size_t n = (size_t)count + 1;
    *s = (tobi_quadrature){.dimension = dimension, .count = count};
    s->triangle = malloc(n*sizeof *s->triangle);
    s->a = malloc(n*sizeof *s->a);
    if (dimension == 2) s->b = malloc(n*sizeof *s->b);
    else s->fraction = malloc(n*sizeof *s->fraction);
    if (s->triangle && s->a && (s->b || s->fraction)) return TOBI_OK;
    tobi_quadrature_free(s);
    return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld surface pieces", (long long)count);
}

static void place_point(double out[3], const double bary[3], const double *const x[3])
{
    for (int k = 0; k < 3; k++) out[k] = bary[0]*x[0][k] + bary[1]*x[1][k] + bary[2]*x[2][k];
}

/* Takes a piece of triangle t that is small enough. */
typedef void take_piece(void *user, int32_t t, const piece *p);

/* Cuts one triangle. */
static void cut_triangle(const double *const x[3], double spacing, int32_t t, take_piece *take, void *user)
{
    piece stack[64 + 1] = {{.corner = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, .fraction = 1}};
    int top = 1;
    while (top) {
        piece p = stack[--top];
        double corner[3][3], longest = -1;
        int k = 0;
        for (int i = 0; i < 3; i++) place_point(corner[i], p.corner[i], x);
        for (int i = 0; i < 3; i++) {
            double length2 = vec3_distance2(corner[i], corner[(i + 1) % 3]);
            if (length2 > longest) {
                longest = length2;
                k = i;
            }
        }
        if (longest <= spacing*spacing*(1 + 1e-12) || top + 2 > 64) {
            take(user, t, &p);
            continue;
        }
        piece half = p;
        half.fraction = p.fraction = 0.5*p.fraction;
        for (int i = 0; i < 3; i++)
            p.corner[(k + 1) % 3][i] = half.corner[k][i] =
                0.5 * (p.corner[k][i] + half.corner[(k + 1) % 3][i]);
        stack[top++] = half;
        stack[top++] = p;
    }
}

static void find_middle(const piece *p, double middle[3])
{
    for (int i = 0; i < 3; i++) middle[i] = (p->corner[0][i] + p->corner[1][i] + p->corner[2][i])/3;
}

/* Counts the pieces, and keeps them if there is where. */
typedef struct keeping { tobi_quadrature *out; int64_t count; } keeping;

static void keep_piece(void *user, int32_t t, const piece *p)
{
    keeping *k = user;
    if (k->out) {
        k->out->triangle[k->count] = t;
        k->out->fraction[k->count] = p->fraction;
        find_middle(p, k->out->a[k->count]);
    }
    k->count++;
}

static tobi_status build_triangles(const tobi_mesh *mesh, double spacing, tobi_quadrature *out,
                                   tobi_error *err)
{
    for (int pass = 0; pass < 2; pass++) {
        keeping k = { pass ? out : NULL, 0 };
        for (int64_t t = 0; t < mesh->triangle_count; t++) {
            const int32_t *v = mesh->triangles[t];
            const double *x[3] = {mesh->vertices[v[0]], mesh->vertices[v[1]], mesh->vertices[v[2]]};
            double longest2 = fmax(vec3_distance2(x[0], x[1]),
                                   fmax(vec3_distance2(x[1], x[2]), vec3_distance2(x[2], x[0])));
            if (!(longest2/(spacing*spacing) < (double)MAX_PIECES) || k.count > MAX_PIECES)
                return tobi_fail(err, TOBI_INVALID, "a surface in pieces of %g m needs more than %lld of "
                                 "them; allow larger ones", spacing, MAX_PIECES);
            cut_triangle(x, spacing, (int32_t)t, keep_piece, &k);
        }
        if (pass == 0) TOBI_TRY(allocate_surface(out, k.count, 3, err));
        out->spacing = spacing;
    }
    return TOBI_OK;
}

static int64_t count_parts(const tobi_section *s, int64_t i, double spacing)
{
    double length = hypot(s->to[i][0] - s->from[i][0], s->to[i][1] - s->from[i][1]);
    return length > 0 ? (int64_t)ceil(length/spacing*(1 - 1e-12)) : 0;
}

static tobi_status build_section(const tobi_mesh *mesh, double spacing, tobi_quadrature *out, tobi_error *err)
{
    tobi_section s;
    int64_t count = 0;
    TOBI_TRY(tobi_section_cut(mesh, &s, err));
    for (int64_t i = 0; i < s.count; i++) {
        count += count_parts(&s, i, spacing);
        if (count <= MAX_PIECES) continue;
        tobi_section_free(&s);
        return tobi_fail(err, TOBI_INVALID, "an outline in pieces of %g m needs more than %lld of them; "
                         "allow larger ones", spacing, MAX_PIECES);
    }
    tobi_status status = allocate_surface(out, count, 2, err);
    count = 0;
    for (int64_t i = 0; status == TOBI_OK && i < s.count; i++) {
        int64_t n = count_parts(&s, i, spacing);
        for (int64_t j = 0; j < n; j++, count++) {
            double p = (double)j/(double)n, q = (double)(j + 1)/(double)n;
            out->triangle[count] = s.triangle[i];
            for (int k = 0; k < 3; k++) {
                out->a[count][k] = (1 - p)*s.a[i][k] + p*s.b[i][k];
                out->b[count][k] = (1 - q)*s.a[i][k] + q*s.b[i][k];
            }
        }
    }
    tobi_section_free(&s);
    return status;
}

tobi_status tobi_quadrature_build(const tobi_mesh *mesh, double spacing, int dimension, tobi_quadrature *out,
                               tobi_error *err)
{
    *out = (tobi_quadrature){0};
    if (!(spacing > 0) || !isfinite(spacing))
        return tobi_fail(err, TOBI_INVALID, "surface spacing is %g m; it must be > 0", spacing);
    if (dimension != 2 && dimension != 3)
        return tobi_fail(err, TOBI_INVALID, "dimension is %d; allowed are 2 and 3", dimension);
    return dimension == 2 ? build_section(mesh, spacing, out, err)
                          : build_triangles(mesh, spacing, out, err);
}

/* Pieces come in the order of the cut; those that were left out are not looked at. */
typedef struct placing {
    const tobi_quadrature *s;
    const double (*vertices)[3];
    const int32_t (*triangles)[3];
    double (*corners)[3];
    int64_t next;
} placing;

static void place_piece(void *user, int32_t t, const piece *p)
{
    placing *q = user;
    double middle[3];
    find_middle(p, middle);
    if (q->next == q->s->count || q->s->triangle[q->next] != t ||
        memcmp(q->s->a[q->next], middle, sizeof middle) != 0)
        return;
    const int32_t *v = q->triangles[t];
    const double *x[3] = {q->vertices[v[0]], q->vertices[v[1]], q->vertices[v[2]]};
    for (int i = 0; i < 3; i++) place_point(q->corners[3*q->next + i], p->corner[i], x);
    q->next++;
}

void tobi_quadrature_corners(const tobi_quadrature *s, const tobi_mesh *mesh,
                             const double (*vertices)[3], double (*corners)[3])
{
    placing q = { s, vertices, (const int32_t (*)[3])mesh->triangles, corners, 0 };
    for (int64_t i = 0; s->dimension == 2 && i < s->count; i++) {
        const int32_t *v = mesh->triangles[s->triangle[i]];
        const double *x[3] = {vertices[v[0]], vertices[v[1]], vertices[v[2]]};
        place_point(corners[2*i], s->a[i], x);
        place_point(corners[2*i + 1], s->b[i], x);
    }
    for (int64_t t = 0; s->dimension == 3 && t < mesh->triangle_count; t++) {
        const int32_t *v = mesh->triangles[t];
        const double *x[3] = {mesh->vertices[v[0]], mesh->vertices[v[1]], mesh->vertices[v[2]]};
        cut_triangle(x, s->spacing, (int32_t)t, place_piece, &q);
    }
}

void tobi_quadrature_move(tobi_quadrature *s, int64_t from, int64_t to)
{
    s->triangle[to] = s->triangle[from];
    memmove(s->a[to], s->a[from], sizeof *s->a);
    if (s->b) memmove(s->b[to], s->b[from], sizeof *s->b);
    if (s->fraction) s->fraction[to] = s->fraction[from];
}

/* --- moving ------------------------------------------------------------------------------- */

/* Returns the triangle's area. */
static double find_plane(const double *const x[3], double normal[3])
{
    double ab[3], ac[3];
    vec3_sub(ab, x[1], x[0]);
    vec3_sub(ac, x[2], x[0]);
    vec3_cross(normal, ab, ac);
    const double area = 0.5*vec3_length(normal);
    vec3_normalize(normal);
    return area;
}

static void update_line(const tobi_quadrature *s, int64_t i, const double *const x[3], double middle[3],
                        double normal[3], double *length)
{
    double from[3], to[3];
    place_point(from, s->a[i], x);
    place_point(to, s->b[i], x);
    normal[0] = to[1] - from[1];
    normal[1] = from[0] - to[0];
    normal[2] = 0;
    *length = vec3_length(normal);
    vec3_normalize(normal);
    for (int k = 0; k < 2; k++) middle[k] = 0.5*(from[k] + to[k]);
    middle[2] = 0;
}

enum { FEW = 4096 };           /* parts that one thread updates sooner than several wake */

typedef struct moving {
    const tobi_quadrature *s;
    const double (*vertices)[3];       /* their places, or values to interpolate */
    const int32_t (*triangles)[3];
    double (*position)[3], (*normal)[3], *area;
} moving;

static void update_points(const void *view, int64_t begin, int64_t end)
{
    const moving *m = view;
    const tobi_quadrature *s = m->s;
    double n[3], all = 0;
    for (int64_t i = begin; i < end; i++) {
        const int32_t *t = m->triangles[s->triangle[i]];
        const double *x[3] = {m->vertices[t[0]], m->vertices[t[1]], m->vertices[t[2]]};
        double middle[3], weight;
        if (s->dimension == 2) {
            update_line(s, i, x, middle, n, &weight);
        } else {
            if (i == begin || s->triangle[i] != s->triangle[i - 1]) all = find_plane(x, n);
            weight = all*s->fraction[i];
            place_point(middle, s->a[i], x);
        }
        if (m->position) memcpy(m->position[i], middle, sizeof middle);
        if (m->normal) memcpy(m->normal[i], n, sizeof n);
        if (m->area) m->area[i] = weight;
    }
}

void tobi_quadrature_update(const tobi_quadrature *s, const double (*vertices)[3],
                            const int32_t (*triangles)[3],
                         double (*position)[3], double (*normal)[3], double *area)
{
    const moving view = {s, vertices, triangles, position, normal, area};
    tobi_loop(s->count > FEW ? 0 : 1, s->count, 0, update_points, &view);
}

static void interpolate_points(const void *view, int64_t begin, int64_t end)
{
    const moving *m = view;
    const tobi_quadrature *s = m->s;
    for (int64_t i = begin; i < end; i++) {
        const int32_t *t = m->triangles[s->triangle[i]];
        const double *x[3] = {m->vertices[t[0]], m->vertices[t[1]], m->vertices[t[2]]};
        double *out = m->position[i], last[3];
        place_point(out, s->a[i], x);
        if (s->dimension == 3) continue;
        place_point(last, s->b[i], x);
        for (int k = 0; k < 2; k++) out[k] = 0.5*(out[k] + last[k]);
        out[2] = 0;
    }
}

void tobi_quadrature_interpolate(const tobi_quadrature *s, const int32_t (*triangles)[3],
                              const double (*vertex_values)[3], double (*out)[3])
{
    const moving view = {s, vertex_values, triangles, out, NULL, NULL};
    tobi_loop(s->count > FEW ? 0 : 1, s->count, 0, interpolate_points, &view);
}
