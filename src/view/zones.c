/* Porous zones that bodies carry, in pictures: their edges move with three vertices of the body's surface, so
   that pictures of files need no more than the files. Drawback: files round the vertices. */
#include "base/error.h"
#include "view/drawing.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static double dot(const double a[3], const double b[3]) { return a[0]*b[0] + a[1]*b[1] + a[2]*b[2]; }

static void subtract(double out[3], const double a[3], const double b[3])
{
    for (int c = 0; c < 3; c++) out[c] = a[c] - b[c];
}

static void cross(double out[3], const double a[3], const double b[3])
{
    for (int c = 0; c < 3; c++) out[c] = a[(c + 1)%3]*b[(c + 2)%3] - a[(c + 2)%3]*b[(c + 1)%3];
}

static void normalize(double a[3])
{
    const double size = sqrt(dot(a, a));
    for (int c = 0; c < 3 && size > 0; c++) a[c] /= size;
}

static void add_scaled(double to[3], double share, const double way[3])
{
    for (int c = 0; c < 3; c++) to[c] += share*way[c];
}

/* Rows: unit vectors along the way from the first of three places to the second, and two across it. */
static void find_axes(const double at[3][3], int dimension, double axes[3][3])
{
    double side[3];
    memset(axes, 0, 9*sizeof(double));
    subtract(axes[0], at[1], at[0]);
    subtract(side, at[2], at[0]);
    if (dimension == 2) {
        axes[0][2] = 0;
        side[0] = -axes[0][1], side[1] = axes[0][0], side[2] = 0;
    }
    cross(axes[2], axes[0], side);
    normalize(axes[0]);
    normalize(axes[2]);
    cross(axes[1], axes[2], axes[0]);
}

static const tobi_moment_surface *find_surface(const tobi_drawing *d, int body)
{
    for (int k = 0; k < d->moment->surface_count; k++)
        if (tobi_drawing_find_body(d->looks, d->moment->surfaces[k].name) == body)
            return &d->moment->surfaces[k];
    return NULL;
}

/* Where the anchors of a body are now; 0: the moment has no such surface. */
static int find_anchors(const tobi_drawing *d, int body, double now[3][3])
{
    const tobi_moment_surface *s = find_surface(d, body);
    for (int k = 0; k < 3; k++) {
        const int64_t i = d->looks->bodies[body].anchor[k];
        if (!s || i >= s->vertex_count) return 0;
        memcpy(now[k], s->vertices[i], 3*sizeof(double));
    }
    return 1;
}

/* The part of it within the domain; 0: there is none. */
static int clip(const tobi_looks *looks, double end[2][3])
{
    double part[2] = { 0, 1 }, from[3], way[3];
    memcpy(from, end[0], sizeof from);
    subtract(way, end[1], end[0]);
    for (int a = 0; a < looks->dimension; a++) {
        const double low = looks->box_min[a] - from[a], high = looks->box_max[a] - from[a];
        if (way[a] == 0 && (low > 0 || high < 0)) return 0;
        if (way[a] == 0) continue;
        part[0] = fmax(part[0], fmin(low/way[a], high/way[a]));
        part[1] = fmin(part[1], fmax(low/way[a], high/way[a]));
    }
    for (int n = 0; n < 2; n++) {
        memcpy(end[n], from, sizeof from);
        add_scaled(end[n], part[n], way);
    }
    return part[1] > part[0];
}

tobi_status view_take_zones(tobi_drawing *d, tobi_error *err)
{
    const tobi_looks *looks = d->looks;
    int64_t count = looks->edge_count;
    if (looks->carried_count == 0) return TOBI_OK;
    d->edges = malloc((size_t)(looks->edge_count + looks->carried_count)*sizeof *d->edges);
    if (!d->edges) return tobi_fail(err, TOBI_NO_MEMORY, "picture: out of memory");
    if (count > 0) memcpy(d->edges, looks->edges, (size_t)count*sizeof *d->edges);
    for (int64_t k = 0; k < looks->carried_count; k++) {
        const tobi_zone_edge *e = &looks->carried[k];
        const double (*start)[3] = (const double (*)[3])looks->bodies[e->body].anchor_start;
        double now[3][3], old[3][3], axes[3][3];
        if (!find_anchors(d, e->body, now)) continue;
        find_axes(start, looks->dimension, old);
        find_axes((const double (*)[3])now, looks->dimension, axes);
        for (int n = 0; n < 2; n++) {
            double way[3];
            subtract(way, e->end[n], start[0]);
            memcpy(d->edges[count][n], now[0], 3*sizeof(double));
            for (int a = 0; a < 3; a++)
                add_scaled(d->edges[count][n], dot(old[a], way), axes[a]);
        }
        count += clip(looks, d->edges[count]);
    }
    d->picture.edges = (const double (*)[2][3])d->edges;
    d->picture.edge_count = count;
    return TOBI_OK;
}
