/* Round shapes are a profile turned about an axis; the polygons of the turn are widened until their areas are
   those of circles, then all is scaled to the exact volume. Drawback: facets get narrow at the poles. */
#include "geom/shapes.h"
#include "geom/vec3.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846;
enum { LEAST_SECTORS = 24, MOST_SECTORS = 256, MOST_PARTS = 4096 };

/* Places along the axis (m from the start) and distances from it; the first and the last are on it. */
typedef struct profile { double (*at)[2]; int64_t count; } profile;

static int count_parts(double length, double edge)
{
    const double parts = ceil(length/edge);
    return parts < 1 ? 1 : parts > MOST_PARTS ? MOST_PARTS : (int)parts;
}

static void add_line(profile *p, double s, double r, double edge, int disc)
{
    const double *from = p->at[p->count - 1], begin[2] = { from[0], from[1] };
    int parts = count_parts(hypot(s - begin[0], r - begin[1]), edge);
    if (disc) parts = s > begin[0] && parts%2 == 0 ? 2 : 1;       /* a ring lies in the middle, or none */
    for (int k = 1; k <= parts; k++, p->count++) {
        const double q = (double)k/parts;
        p->at[p->count][0] = begin[0] + q*(s - begin[0]);
        p->at[p->count][1] = begin[1] + q*(r - begin[1]);
    }
}

/* A quarter of a circle about a place on the axis, from one angle to another. */
static void add_arc(profile *p, double s, double radius, double from, double to, int parts)
{
    for (int k = 1; k <= parts; k++, p->count++) {
        const double angle = from + (to - from)*k/parts;
        p->at[p->count][0] = s - radius*cos(angle);
        p->at[p->count][1] = radius*sin(angle);
    }
}

static tobi_status make_profile(const tobi_round *shape, double length, double edge, int sectors, profile *p,
                                tobi_error *err)
{
    const double r = shape->radius;
    *p = (profile){ malloc((size_t)(3*MOST_PARTS + MOST_SECTORS)*sizeof *p->at), 1 };
    if (!p->at) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a shape");
    p->at[0][0] = shape->round_ends ? -r : 0;
    p->at[0][1] = 0;
    if (shape->round_ends) add_arc(p, 0, r, 0, 0.5*PI, sectors/4);
    else add_line(p, 0, r, edge, shape->disc);
    if (length > 0) add_line(p, length, r, edge, shape->disc);
    if (shape->round_ends) add_arc(p, length, r, 0.5*PI, PI, sectors/4);
    else add_line(p, length, 0, edge, shape->disc);
    p->at[p->count - 1][1] = 0;
    return TOBI_OK;
}

/* Unit vectors u, v, w, right-handed, from w. */
static void find_frame(const double w[3], double u[3], double v[3])
{
    int least = 0;
    double out[3] = { 0 };
    for (int a = 1; a < 3; a++)
        if (fabs(w[a]) < fabs(w[least])) least = a;
    out[least] = 1;
    vec3_cross(u, out, w);
    vec3_normalize(u);
    vec3_cross(v, w, u);
}

static double find_volume(int64_t triangles, const int32_t (*t)[3], const double (*x)[3])
{
    double sum = 0, normal[3];
    for (int64_t k = 0; k < triangles; k++) {
        vec3_cross(normal, x[t[k][1]], x[t[k][2]]);
        sum += vec3_dot(x[t[k][0]], normal)/6;
    }
    return sum;
}

/* Vertices about the middle of the axis: the two poles, then the rings. */
static void place_vertices(const profile *p, double length, const double axis[3], int sectors, double (*x)[3])
{
    const double wide = sqrt(2*PI/sectors/sin(2*PI/sectors));
    double u[3], v[3];
    find_frame(axis, u, v);
    for (int64_t i = 0; i < p->count; i++)
        for (int j = 0; j < sectors; j++) {
            const int pole = i == 0 ? 0 : i == p->count - 1 ? 1 : -1;
            const double angle = 2*PI*j/sectors, r = wide*p->at[i][1], s = p->at[i][0] - 0.5*length;
            double *out = x[pole >= 0 ? pole : 2 + (i - 1)*sectors + j];
            for (int a = 0; a < 3; a++) out[a] = s*axis[a] + r*(cos(angle)*u[a] + sin(angle)*v[a]);
        }
}

/* Returns their number. */
static int64_t place_triangles(const profile *p, int sectors, int32_t (*t)[3])
{
    const int64_t rings = p->count - 2;
    int64_t n = 0;
    for (int j = 0; j < sectors; j++) {
        const int32_t k = (int32_t)((j + 1)%sectors), last = (int32_t)(2 + (rings - 1)*sectors);
        memcpy(t[n++], (int32_t[]){ 0, 2 + k, 2 + (int32_t)j }, sizeof *t);
        memcpy(t[n++], (int32_t[]){ 1, last + (int32_t)j, last + k }, sizeof *t);
        for (int64_t i = 0; i < rings - 1; i++) {
            const int32_t low = (int32_t)(2 + i*sectors), high = low + (int32_t)sectors;
            memcpy(t[n++], (int32_t[]){ low + (int32_t)j, low + k, high + k }, sizeof *t);
            memcpy(t[n++], (int32_t[]){ low + (int32_t)j, high + k, high + (int32_t)j }, sizeof *t);
        }
    }
    return n;
}

static tobi_status turn_profile(const char *name, const tobi_round *shape, const profile *p, int sectors,
                                tobi_mesh *out, tobi_error *err)
{
    const int64_t vertices = 2 + (p->count - 2)*sectors, room = 2*(p->count - 1)*sectors;
    const double r = shape->radius;
    double (*x)[3] = malloc((size_t)vertices*sizeof *x), axis[3];
    int32_t (*t)[3] = malloc((size_t)room*sizeof *t);
    tobi_status status = TOBI_OK;
    vec3_sub(axis, shape->end, shape->start);
    const double length = vec3_length(axis);
    const double exact = PI*r*r*length + (shape->round_ends ? 4*PI*r*r*r/3 : 0);
    if (length > 0) vec3_normalize(axis);
    else axis[2] = 1;
    if (x && t) {
        place_vertices(p, length, axis, sectors, x);
        const int64_t triangles = place_triangles(p, sectors, t);
        const double volume = find_volume(triangles, (const int32_t (*)[3])t, (const double (*)[3])x);
        const double scale = cbrt(exact/volume);
        for (int64_t i = 0; i < vertices; i++)
            for (int a = 0; a < 3; a++)
                x[i][a] = 0.5*(shape->start[a] + shape->end[a]) + scale*x[i][a];
        status = tobi_mesh_build(name, vertices, (const double (*)[3])x, triangles,
                                 (const int32_t (*)[3])t, out, err);
    } else
        status = tobi_fail(err, TOBI_NO_MEMORY, "no memory for a shape of %lld triangles", (long long)room);
    free(x);
    free(t);
    return status;
}

tobi_status tobi_mesh_round(const char *name, const tobi_round *shape, double edge, tobi_mesh *out,
                            tobi_error *err)
{
    profile p;
    const double length = sqrt(vec3_distance2(shape->start, shape->end));
    if (!shape->round_ends && !(length > 0))
        return tobi_fail(err, TOBI_INVALID, "body '%s': its cylinder has no length", name);
    const double around = ceil(2*PI*shape->radius/edge/4)*4;
    const int sectors = (int)fmin(fmax(around, LEAST_SECTORS), MOST_SECTORS);
    const double step = fmax(edge, 2*PI*shape->radius/sectors);
    tobi_status status = make_profile(shape, length, step, sectors, &p, err);
    if (status == TOBI_OK) status = turn_profile(name, shape, &p, sectors, out, err);
    free(p.at);
    return status;
}

tobi_status tobi_mesh_plate(const char *name, const tobi_plate *plate, tobi_mesh *out, tobi_error *err)
{
    static const int32_t triangles[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                             {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                             {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    double axis[3][3], x[8][3];              /* along, across, through */
    memcpy(axis[2], plate->normal, sizeof axis[2]);
    if (!(vec3_length(axis[2]) > 0))
        return tobi_fail(err, TOBI_INVALID, "body '%s': the normal of its plate has no direction", name);
    vec3_normalize(axis[2]);
    find_frame(axis[2], axis[0], axis[1]);
    if (vec3_length(plate->along) > 0) {
        vec3_add_scaled(axis[0], plate->along, -vec3_dot(plate->along, axis[2]), axis[2]);
        if (!(vec3_length(axis[0]) > 1e-9*vec3_length(plate->along)))
            return tobi_fail(err, TOBI_INVALID, "body '%s': along and normal of its plate are parallel",
                             name);
        vec3_normalize(axis[0]);
        vec3_cross(axis[1], axis[2], axis[0]);
    }
    const double half[3] = { 0.5*plate->length, 0.5*plate->width, 0.5*plate->thickness };
    for (int k = 0; k < 8; k++)
        for (int a = 0; a < 3; a++) {
            x[k][a] = plate->centre[a];
            for (int c = 0; c < 3; c++) x[k][a] += (k >> c & 1 ? half[c] : -half[c])*axis[c][a];
        }
    return tobi_mesh_build(name, 8, (const double (*)[3])x, 12, triangles, out, err);
}

tobi_status tobi_mesh_knife(const char *name, const tobi_knife *knife, tobi_mesh *out, tobi_error *err)
{
    enum { CORNERS = 5 };
    int32_t triangles[4*CORNERS - 4][3];
    double axis[3][3], x[2*CORNERS][3];      /* along, across, from the edge to the back */
    int count = 0;
    for (int a = 0; a < 3; a++) axis[2][a] = -knife->direction[a];
    if (!(vec3_length(axis[2]) > 0))
        return tobi_fail(err, TOBI_INVALID, "body '%s': the direction of its knife has none", name);
    vec3_normalize(axis[2]);
    vec3_add_scaled(axis[0], knife->along, -vec3_dot(knife->along, axis[2]), axis[2]);
    if (!(vec3_length(axis[0]) > 1e-9*vec3_length(knife->along)))
        return tobi_fail(err, TOBI_INVALID, "body '%s': along and direction of its knife are parallel", name);
    vec3_normalize(axis[0]);
    vec3_cross(axis[1], axis[2], axis[0]);
    const double half = 0.5*knife->thickness, bevel = half/tan(knife->angle*PI/360);
    if (!(bevel < knife->height))
        return tobi_fail(err, TOBI_INVALID, "body '%s': its knife of %g m is %g m high; with faces at %g "
                         "degrees it must be higher than %.4g m", name, knife->thickness, knife->height,
                         knife->angle, bevel);
    const double corner[CORNERS][2] = { { 0, 0 }, { half, bevel }, { half, knife->height },
                                        { -half, knife->height }, { -half, bevel } };
    for (int k = 0; k < 2*CORNERS; k++)
        for (int a = 0; a < 3; a++)
            x[k][a] = knife->edge[a] + (k < CORNERS ? -0.5 : 0.5)*knife->length*axis[0][a] +
                      corner[k%CORNERS][0]*axis[1][a] + corner[k%CORNERS][1]*axis[2][a];
    for (int k = 0; k < CORNERS; k++) {      /* the sides, then both ends */
        const int next = (k + 1)%CORNERS;
        memcpy(triangles[count++], (int32_t[3]){ k, next, k + CORNERS }, sizeof *triangles);
        memcpy(triangles[count++], (int32_t[3]){ next, next + CORNERS, k + CORNERS }, sizeof *triangles);
        if (k == 0 || next == 0) continue;
        memcpy(triangles[count++], (int32_t[3]){ 0, next, k }, sizeof *triangles);
        memcpy(triangles[count++], (int32_t[3]){ CORNERS, k + CORNERS, next + CORNERS }, sizeof *triangles);
    }
    return tobi_mesh_build(name, 2*CORNERS, (const double (*)[3])x, count, (const int32_t (*)[3])triangles,
                           out, err);
}
