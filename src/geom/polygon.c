/* Polygons by sums over their sides: no triangles, no clipping. Drawback: each question walks all sides. */
#include "geom/polygon.h"
#include <math.h>

static const double *next_of(tobi_polygon p, int64_t k) { return p.at[k + 1 < p.count ? k + 1 : 0]; }

/* Crossings of the ray to the right. A side is taken from its lower end, so that it is the same for both
   polygons of a common side; of its heights it holds the lower end alone. */
int tobi_polygon_holds(tobi_polygon polygon, const double p[2])
{
    int inside = 0;
    for (int64_t k = 0; k < polygon.count; k++) {
        const double *a = polygon.at[k], *b = next_of(polygon, k);
        const double *low = a[1] < b[1] ? a : b, *high = a[1] < b[1] ? b : a;
        if (!(p[1] >= low[1] && p[1] < high[1])) continue;
        inside ^= (p[0] - low[0])*(high[1] - low[1]) < (p[1] - low[1])*(high[0] - low[0]);
    }
    return inside;
}

tobi_polygon_size tobi_polygon_measure(tobi_polygon p)
{
    tobi_polygon_size s = { 0, 0, { INFINITY, INFINITY }, { -INFINITY, -INFINITY } };
    for (int64_t k = 0; k < p.count; k++) {
        const double *a = p.at[k], *b = next_of(p, k), *o = p.at[0];
        s.area += 0.5*((a[0] - o[0])*(b[1] - o[1]) - (b[0] - o[0])*(a[1] - o[1]));
        s.perimeter += hypot(b[0] - a[0], b[1] - a[1]);
        for (int n = 0; n < 2; n++) s.lower[n] = fmin(s.lower[n], a[n]), s.upper[n] = fmax(s.upper[n], a[n]);
    }
    s.area = fabs(s.area);
    return s;
}

static double height(const double a[2], const double b[2], double x, double base)
{
    return a[1] - base + (b[1] - a[1])*((x - a[0])/(b[0] - a[0]));
}

/* The area between the base and the lower of two sides, where both lie over it; below 0 if they go opposite
   ways. */
static double common_below(const double *a, const double *b, const double *c, const double *d, double base)
{
    const double from = fmax(fmin(a[0], b[0]), fmin(c[0], d[0]));
    const double to = fmin(fmax(a[0], b[0]), fmax(c[0], d[0]));
    const double sign = (b[0] > a[0]) == (d[0] > c[0]) ? 1 : -1;
    if (!(to > from)) return 0;
    const double f[2] = { height(a, b, from, base), height(a, b, to, base) };
    const double g[2] = { height(c, d, from, base), height(c, d, to, base) };
    const double first = fmin(f[0], g[0]), last = fmin(f[1], g[1]), gap = f[0] - g[0];
    if (gap*(f[1] - g[1]) >= 0) return 0.5*sign*(to - from)*(first + last);
    const double way = gap/(gap - (f[1] - g[1])), middle = f[0] + way*(f[1] - f[0]);      /* they cross */
    return 0.5*sign*(to - from)*(way*(first + middle) + (1 - way)*(middle + last));
}

double tobi_polygon_common(tobi_polygon p, tobi_polygon q)
{
    double sum = 0, base = INFINITY;
    for (int64_t k = 0; k < p.count; k++) base = fmin(base, p.at[k][1]);
    for (int64_t k = 0; k < q.count; k++) base = fmin(base, q.at[k][1]);
    for (int64_t i = 0; i < p.count; i++)
        for (int64_t j = 0; j < q.count; j++)
            sum += common_below(p.at[i], next_of(p, i), q.at[j], next_of(q, j), base);
    return fabs(sum);
}

/* A side of a prism: where it lies at a height, from `from` on and up to `to` alone. */
typedef struct side { const double *a, *b; int up; double from, to; } side;

static double place(const side *s, double z)
{
    const int x = 1 - s->up;
    const double share = (z - s->a[s->up])/(s->b[s->up] - s->a[s->up]);
    return fmin(fmax(s->a[x] + share*(s->b[x] - s->a[x]), s->from), s->to) - s->from;
}

/* The height at which it comes to a limit, if that lies within; else one of these. */
static double find_height(const side *s, double limit, double from, double to)
{
    const int x = 1 - s->up;
    const double way = s->b[x] - s->a[x];
    if (way == 0) return from;
    return fmin(fmax(s->a[s->up] + (limit - s->a[x])/way*(s->b[s->up] - s->a[s->up]), from), to);
}

/* The integral of the product of two places over the heights of both sides, below 0 if they go opposite ways:
   between its kinks it is a parabola. */
static double sweep(const side *p, const side *q)
{
    const double from = fmax(fmin(p->a[p->up], p->b[p->up]), fmin(q->a[q->up], q->b[q->up]));
    const double to = fmin(fmax(p->a[p->up], p->b[p->up]), fmax(q->a[q->up], q->b[q->up]));
    const double sign = (p->b[p->up] > p->a[p->up]) == (q->b[q->up] > q->a[q->up]) ? 1 : -1;
    double at[6] = { from, to, from, from, from, from }, sum = 0;
    if (!(to > from)) return 0;
    for (int k = 0; k < 4; k++) {
        const side *s = k < 2 ? p : q;
        at[2 + k] = find_height(s, k % 2 ? s->to : s->from, from, to);
    }
    for (int i = 1; i < 6; i++)
        for (int j = i; j > 0 && at[j] < at[j - 1]; j--) {
            const double other = at[j];
            at[j] = at[j - 1], at[j - 1] = other;
        }
    for (int k = 0; k < 5; k++) {
        const double low = at[k], high = at[k + 1], middle = 0.5*(low + high);
        sum += (high - low)/6*(place(p, low)*place(q, low) + 4*place(p, middle)*place(q, middle) +
                               place(p, high)*place(q, high));
    }
    return sign*sum;
}

double tobi_polygon_crossed(const tobi_crossed *a, const tobi_crossed *b)
{
    double sum = 0;
    for (int64_t i = 0; i < a->polygon.count; i++)
        for (int64_t j = 0; j < b->polygon.count; j++) {
            const side p = { a->polygon.at[i], next_of(a->polygon, i), a->up, a->from, a->to };
            const side q = { b->polygon.at[j], next_of(b->polygon, j), b->up, b->from, b->to };
            sum += sweep(&p, &q);
        }
    return fabs(sum);
}

void tobi_polygon_longest(tobi_polygon p, double along[2])
{
    double most = 0;
    along[0] = 1, along[1] = 0;
    for (int64_t k = 0; k < p.count; k++) {
        const double *a = p.at[k], *b = next_of(p, k), length = hypot(b[0] - a[0], b[1] - a[1]);
        if (!(length > most)) continue;
        most = length;
        for (int n = 0; n < 2; n++) along[n] = (b[n] - a[n])/length;
    }
}

double tobi_polygon_extent(tobi_polygon p, const double along[2])
{
    double least = INFINITY, most = -INFINITY;
    for (int64_t k = 0; k < p.count; k++) {
        const double way = p.at[k][0]*along[0] + p.at[k][1]*along[1];
        least = fmin(least, way), most = fmax(most, way);
    }
    return most - least;
}
