/* How wide and how thick a body is, so that it can be said how many spacings lie across it. Widths are taken
   along normals of its triangles, thicknesses along rays from them through the body. Drawback: some hundred
   triangles stand for all; a part with less than a tenth of the surface is not seen. */
#include "report.h"
#include <math.h>
#include <stdlib.h>

enum { SAMPLES = 300 };
static const double THIN_SHARE = 0.1;        /* of the surface */

typedef struct mesh {
    int64_t vertices, triangles;
    const double (*vertex)[3];
    const int32_t (*triangle)[3];
} mesh;
typedef struct ray { double area, thickness; } ray;

static void subtract(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; k++) out[k] = a[k] - b[k];
}
static double dot(const double a[3], const double b[3]) { return a[0]*b[0] + a[1]*b[1] + a[2]*b[2]; }
static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1]*b[2] - a[2]*b[1];
    out[1] = a[2]*b[0] - a[0]*b[2];
    out[2] = a[0]*b[1] - a[1]*b[0];
}

/* Unit normal (in 2-D in the plane) and centre of a triangle; its area, 0 where it has no normal. */
static double look_at(const mesh *m, int64_t t, int dimension, double normal[3], double centre[3])
{
    double u[3], v[3];
    const int32_t *corner = m->triangle[t];
    const double *a = m->vertex[corner[0]], *b = m->vertex[corner[1]], *c = m->vertex[corner[2]];
    subtract(b, a, u);
    subtract(c, a, v);
    cross(u, v, normal);
    const double area = 0.5*sqrt(dot(normal, normal));
    for (int k = 0; k < 3; k++) centre[k] = (a[k] + b[k] + c[k])/3;
    if (dimension == 2) normal[2] = 0;
    const double length = sqrt(dot(normal, normal));
    if (!(length > 0.2*area)) return 0;        /* in 2-D also: a lid of the body */
    for (int k = 0; k < 3; k++) normal[k] /= length;
    return area;
}

static double width_along(const mesh *m, const double way[3])
{
    double low = INFINITY, high = -INFINITY;
    for (int64_t i = 0; i < m->vertices; i++) {
        const double x = dot(m->vertex[i], way);
        low = fmin(low, x);
        high = fmax(high, x);
    }
    return high - low;
}

/* Distance from a point along a unit direction to a triangle (Moeller & Trumbore 1997); INFINITY: missed. */
static double hit(const mesh *m, int64_t t, const double from[3], const double way[3])
{
    double u[3], v[3], p[3], q[3], s[3];
    const double *a = m->vertex[m->triangle[t][0]];
    subtract(m->vertex[m->triangle[t][1]], a, u);
    subtract(m->vertex[m->triangle[t][2]], a, v);
    cross(way, v, p);
    const double det = dot(u, p);
    if (!(fabs(det) > 0)) return INFINITY;
    subtract(from, a, s);
    cross(s, u, q);
    const double b = dot(s, p)/det, c = dot(way, q)/det, far = dot(v, q)/det;
    return b >= 0 && c >= 0 && b + c <= 1 && far > 0 ? far : INFINITY;
}

static double thickness_at(const mesh *m, int64_t t, const double centre[3], const double normal[3])
{
    const double way[3] = { -normal[0], -normal[1], -normal[2] };
    double nearest = INFINITY;
    for (int64_t k = 0; k < m->triangles; k++)
        if (k != t) nearest = fmin(nearest, hit(m, k, centre, way));
    return nearest;
}

static int order_rays(const void *a, const void *b)
{
    const double x = ((const ray *)a)->thickness, y = ((const ray *)b)->thickness;
    return x < y ? -1 : x > y;
}

/* The thickness below which THIN_SHARE of the area of the rays lies. */
static double find_thin(ray *rays, int count)
{
    double area = 0, sum = 0;
    qsort(rays, (size_t)count, sizeof *rays, order_rays);
    for (int k = 0; k < count; k++) area += rays[k].area;
    for (int k = 0; k < count; k++)
        if ((sum += rays[k].area) >= THIN_SHARE*area) return rays[k].thickness;
    return INFINITY;
}

int measure_widths(const tobi_world *world, int body, int dimension, widths *w)
{
    mesh m;
    ray rays[SAMPLES];
    int count = 0;
    if (tobi_world_surface(world, body, &m.vertices, &m.vertex, &m.triangles, &m.triangle) != TOBI_OK ||
        m.triangles == 0)
        return -1;
    *w = (widths){ .narrow = INFINITY, .thin = INFINITY, .low = { INFINITY, INFINITY, INFINITY },
                   .high = { -INFINITY, -INFINITY, -INFINITY } };
    for (int64_t i = 0; i < m.vertices; i++)
        for (int a = 0; a < 3; a++) {
            w->low[a] = fmin(w->low[a], m.vertex[i][a]);
            w->high[a] = fmax(w->high[a], m.vertex[i][a]);
        }
    for (int a = 0; a < dimension; a++) w->narrow = fmin(w->narrow, w->high[a] - w->low[a]);
    for (int k = 0; k < SAMPLES && k < m.triangles; k++) {
        const int64_t t = m.triangles <= SAMPLES ? k : m.triangles*k/SAMPLES;
        double normal[3], centre[3];
        const double area = look_at(&m, t, dimension, normal, centre);
        if (!(area > 0)) continue;
        w->narrow = fmin(w->narrow, width_along(&m, normal));
        const double thickness = thickness_at(&m, t, centre, normal);
        if (isfinite(thickness)) rays[count++] = (ray){ area, thickness };
    }
    w->thin = fmin(find_thin(rays, count), w->narrow);
    return 0;
}
