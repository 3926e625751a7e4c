/* Prisms over polygons: ears are cut off for both ends. Drawback: all pairs of sides are compared, so that
   there are at most 5000 corners. */
#include "geom/outline.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_CORNERS = 5000 };
static const double STRAIGHT = 1e-12;       /* of the squares of both sides: less area is none */

void tobi_outline_axes(int axis, int plane[2])
{
    plane[0] = axis == 0 ? 1 : 0;
    plane[1] = axis == 2 ? 1 : 2;
}

void tobi_outline_free(tobi_outline *o)
{
    free(o->at);
    *o = (tobi_outline){ 0 };
}

/* Twice the area of a triangle, above 0 where it turns counterclockwise. */
static double turn(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0])*(c[1] - a[1]) - (b[1] - a[1])*(c[0] - a[0]);
}

static double square(const double a[2], const double b[2])
{
    return (b[0] - a[0])*(b[0] - a[0]) + (b[1] - a[1])*(b[1] - a[1]);
}

static int is_straight(const double a[2], const double b[2], const double c[2])
{
    return fabs(turn(a, b, c)) <= STRAIGHT*(square(a, b) + square(b, c));
}

/* Without points that repeat the one before, and those on the line between their neighbours; nor spikes. */
static void simplify(tobi_outline *o)
{
    int64_t left = o->count + 1;
    while (left > o->count) {
        left = o->count;
        int64_t n = 0;
        for (int64_t k = 0; k < left; k++) {
            const double *before = n > 0 ? o->at[n - 1] : o->at[left - 1], *next = o->at[(k + 1)%left];
            if (left - (k - n) > 2 && is_straight(before, o->at[k], next)) continue;
            memmove(o->at[n++], o->at[k], sizeof *o->at);
        }
        o->count = n;
    }
}

static double find_area(const tobi_outline *o)
{
    double sum = 0;
    for (int64_t k = 1; k + 1 < o->count; k++) sum += 0.5*turn(o->at[0], o->at[k], o->at[k + 1]);
    return sum;
}

/* Whether two sides meet, ends included. */
static int meet(const double a[2], const double b[2], const double c[2], const double d[2])
{
    if (fmax(a[0], b[0]) < fmin(c[0], d[0]) || fmax(c[0], d[0]) < fmin(a[0], b[0]) ||
        fmax(a[1], b[1]) < fmin(c[1], d[1]) || fmax(c[1], d[1]) < fmin(a[1], b[1])) return 0;
    return turn(a, b, c)*turn(a, b, d) <= 0 && turn(c, d, a)*turn(c, d, b) <= 0;
}

static tobi_status check_sides(const char *whose, const tobi_outline *o, tobi_error *err)
{
    for (int64_t i = 0; i < o->count; i++)
        for (int64_t j = i + 2; j < o->count - (i == 0); j++) {
            const double *a = o->at[i], *b = o->at[i + 1], *c = o->at[j], *d = o->at[(j + 1)%o->count];
            if (meet(a, b, c, d))
                return tobi_fail(err, TOBI_INVALID, "%s: its outline crosses itself: the side from "
                                 "(%g, %g) to (%g, %g) m meets that from (%g, %g) to (%g, %g) m", whose, a[0],
                                 a[1], b[0], b[1], c[0], c[1], d[0], d[1]);
        }
    return TOBI_OK;
}

/* Corners that are left, in order. */
typedef struct ring { const tobi_outline *o; int32_t *corner; int64_t count; } ring;

static const double *at(const ring *r, int64_t k) { return r->o->at[r->corner[(k + r->count)%r->count]]; }

/* Nothing else lies in the triangle of corner k. */
static int is_ear(const ring *r, int64_t k)
{
    const double *a = at(r, k - 1), *b = at(r, k), *c = at(r, k + 1);
    if (!(turn(a, b, c) > 0)) return 0;
    for (int64_t n = 2; n < r->count - 1; n++) {
        const double *p = at(r, k + n);
        if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return 0;
    }
    return 1;
}

/* The polygon as count - 2 triangles. Ears are looked for behind the last one: a fan would make slivers. */
static int64_t cut_ears(const tobi_outline *o, int32_t *corner, int32_t (*triangle)[3])
{
    ring r = { o, corner, o->count };
    int64_t made = 0, k = 0, tried = 0;
    for (int64_t n = 0; n < o->count; n++) corner[n] = (int32_t)n;
    while (r.count > 3) {
        if (!is_ear(&r, k) && tried++ < r.count) {      /* by rounding there may be none: any will do */
            k = (k + 1)%r.count;
            continue;
        }
        tried = 0;
        const int64_t before = (k + r.count - 1)%r.count, next = (k + 1)%r.count;
        memcpy(triangle[made++], (int32_t[]){ corner[before], corner[k], corner[next] }, sizeof *triangle);
        memmove(corner + k, corner + k + 1, (size_t)(r.count - k - 1)*sizeof *corner);
        k = (k + 1)%--r.count;
    }
    memcpy(triangle[made++], (int32_t[]){ corner[0], corner[1], corner[2] }, sizeof *triangle);
    return made;
}

/* Both ends and the sides; the first n vertices are of the end that counterclockwise corners face. */
static void join_ends(int64_t n, int64_t ears, int32_t (*t)[3])
{
    for (int64_t k = 0; k < ears; k++)
        memcpy(t[ears + k], (int32_t[]){ (int32_t)(t[k][0] + n), (int32_t)(t[k][2] + n),
                                         (int32_t)(t[k][1] + n) }, sizeof *t);
    for (int64_t i = 0; i < n; i++) {
        const int32_t a = (int32_t)i, b = (int32_t)((i + 1)%n);
        const int32_t low = (int32_t)(a + n), next = (int32_t)(b + n);
        memcpy(t[2*ears + 2*i], (int32_t[]){ a, low, next }, sizeof *t);
        memcpy(t[2*ears + 2*i + 1], (int32_t[]){ a, next, b }, sizeof *t);
    }
}

static tobi_status make_prism(const char *whose, const tobi_outline *o, int axis, const double end[2],
                              tobi_mesh *out, tobi_error *err)
{
    const int64_t n = o->count;
    double (*x)[3] = malloc((size_t)(2*n)*sizeof *x);
    int32_t (*t)[3] = malloc((size_t)(4*n)*sizeof *t), *corner = malloc((size_t)n*sizeof *corner);
    tobi_status status = x && t && corner ? TOBI_OK : tobi_fail(err, TOBI_NO_MEMORY, "no memory for a shape");
    int plane[2];
    tobi_outline_axes(axis, plane);
    for (int64_t k = 0; k < 2*n && status == TOBI_OK; k++) {
        for (int a = 0; a < 2; a++) x[k][plane[a]] = o->at[k%n][a];
        x[k][axis] = end[(k < n) == (axis != 1)];        /* x, z is seen against y */
    }
    if (status == TOBI_OK) {
        const int64_t ears = cut_ears(o, corner, t);
        join_ends(n, ears, t);
        status = tobi_mesh_build(whose, 2*n, (const double (*)[3])x, 2*ears + 2*n, (const int32_t (*)[3])t,
                                 out, err);
    }
    free(x);
    free(t);
    free(corner);
    return status;
}

tobi_status tobi_outline_clean(const char *whose, const tobi_outline *given, tobi_outline *out,
                               tobi_error *err)
{
    *out = (tobi_outline){ 0 };
    if (given->count > MOST_CORNERS)
        return tobi_fail(err, TOBI_INVALID, "%s: its outline has %lld points; at most %d are allowed",
                         whose, (long long)given->count, MOST_CORNERS);
    if (given->count < 3)
        return tobi_fail(err, TOBI_INVALID, "%s: its outline has %lld points; at least 3 are needed",
                         whose, (long long)given->count);
    tobi_outline o = { malloc((size_t)given->count*sizeof *o.at), given->count };
    if (!o.at) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a shape");
    memcpy(o.at, given->at, (size_t)o.count*sizeof *o.at);
    simplify(&o);
    const double area = o.count > 2 ? find_area(&o) : 0;
    tobi_status status = check_sides(whose, &o, err);
    if (status == TOBI_OK && area == 0)
        status = tobi_fail(err, TOBI_INVALID, "%s: its outline has no area", whose);
    for (int64_t k = 0; area < 0 && 2*k + 1 < o.count; k++)
        for (int a = 0; a < 2; a++) {
            const double kept = o.at[k][a];
            o.at[k][a] = o.at[o.count - 1 - k][a];
            o.at[o.count - 1 - k][a] = kept;
        }
    if (status == TOBI_OK) *out = o;
    else tobi_outline_free(&o);
    return status;
}

tobi_status tobi_mesh_prism(const char *whose, const tobi_outline *given, int axis, double from, double to,
                            tobi_mesh *out, tobi_error *err)
{
    const double end[2] = { from, to };
    tobi_outline o;
    TOBI_TRY(tobi_outline_clean(whose, given, &o, err));
    const tobi_status status = make_prism(whose, &o, axis, end, out, err);
    tobi_outline_free(&o);
    return status;
}
