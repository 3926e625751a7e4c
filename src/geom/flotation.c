/* Volume, its moment and the waterplane as sums over the surface below the level, by Gauss's theorem: there
   is no need for the waterline. All are of second order in the coordinates, so that few points of a piece
   are exact. Drawback: parts of a mesh that overlap would count twice, callers leave those out. */
#include "geom/flotation.h"
#include "geom/section.h"
#include "geom/vec3.h"
#include <math.h>
#include <string.h>

enum { ROUNDS = 100 };

typedef struct sums {
    int up;
    double sign, level, origin[3];       /* m; heights count from the lowest place, others from the middle */
    double volume, moment, area;         /* m3, m4 of heights, m2 of the waterplane */
    double first[3], second[3];          /* m3, m4 of the waterplane                */
} sums;

/* A place of the surface, with the part of n dA that points upwards. */
static void add_point(sums *s, const double x[3], double part)
{
    const double z = s->sign*(x[s->up] - s->origin[s->up]);
    s->volume += (z - s->level)*part;
    s->moment += 0.5*(z*z - s->level*s->level)*part;
    s->area -= part;
    for (int a = 0; a < 3; a++) {
        const double beside = x[a] - s->origin[a];
        s->first[a] -= beside*part;
        s->second[a] -= beside*beside*part;
    }
}

/* Keeps of a line of corners, closed or not, what lies below the level. */
static int clip(const sums *s, const double (*corner)[3], int count, int closed, double (*out)[3])
{
    int kept = 0;
    for (int k = 0; k < count; k++) {
        const double *p = corner[k], *q = corner[(k + 1)%count];
        const double hp = s->sign*(p[s->up] - s->origin[s->up]) - s->level,
                     hq = s->sign*(q[s->up] - s->origin[s->up]) - s->level;
        if (hp <= 0) memcpy(out[kept++], p, sizeof *out);
        if ((hp <= 0) == (hq <= 0) || (!closed && k == count - 1)) continue;
        for (int a = 0; a < 3; a++) out[kept][a] = p[a] + hp/(hp - hq)*(q[a] - p[a]);
        kept++;
    }
    return kept;
}

static void add_triangle(sums *s, const double *a, const double *b, const double *c)
{
    const double *corner[3] = { a, b, c };
    double u[3], v[3], n[3];
    vec3_sub(u, b, a);
    vec3_sub(v, c, a);
    vec3_cross(n, u, v);
    for (int k = 0; k < 3; k++) {
        double middle[3];
        for (int i = 0; i < 3; i++) middle[i] = 0.5*(corner[k][i] + corner[(k + 1)%3][i]);
        add_point(s, middle, s->sign*n[s->up]/6);
    }
}

/* In 2-D; the inside is on the left. */
static void add_piece(sums *s, const double a[3], const double b[3])
{
    const double part = s->sign*(s->up ? a[0] - b[0] : b[1] - a[1])/6;
    double middle[3];
    for (int i = 0; i < 3; i++) middle[i] = 0.5*(a[i] + b[i]);
    add_point(s, a, part);
    add_point(s, middle, 4*part);
    add_point(s, b, part);
}

static void add_all(sums *s, const tobi_mesh *mesh, const tobi_section *section)
{
    double corner[3][3] = { { 0 } }, kept[4][3];
    for (int64_t i = 0; section && i < section->count; i++) {
        memcpy(corner[0], section->from[i], sizeof section->from[i]);
        memcpy(corner[1], section->to[i], sizeof section->to[i]);
        if (clip(s, (const double (*)[3])corner, 2, 0, kept) == 2) add_piece(s, kept[0], kept[1]);
    }
    for (int64_t t = 0; !section && t < mesh->triangle_count; t++) {
        for (int k = 0; k < 3; k++) memcpy(corner[k], mesh->vertices[mesh->triangles[t][k]], sizeof *corner);
        const int count = clip(s, (const double (*)[3])corner, 3, 1, kept);
        for (int k = 2; k < count; k++) add_triangle(s, kept[0], kept[k - 1], kept[k]);
    }
}

/* Newton's method for the level, within what is known to be too low and too high. */
static void find_level(sums *s, const tobi_mesh *mesh, const tobi_section *section, double high,
                       double volume)
{
    const sums none = *s;
    double low = 0, level = 0.5*high;
    for (int k = 0; k < ROUNDS; k++) {
        *s = none;
        s->level = level;
        add_all(s, mesh, section);
        if (fabs(s->volume - volume) <= 1e-13*volume) return;
        if (s->volume < volume) low = level;
        else high = level;
        const double next = level - (s->volume - volume)/s->area;
        level = next > low && next < high ? next : 0.5*(low + high);
    }
}

tobi_status tobi_flotation_find(const tobi_mesh *mesh, int dimension, int up, int sign, double volume,
                                tobi_flotation *out, tobi_error *err)
{
    tobi_section section = { 0 };
    double min[3], max[3];
    sums s = { .up = up, .sign = sign };
    memset(out, 0, sizeof *out);
    if (dimension == 2) TOBI_TRY(tobi_section_cut(mesh, &section, err));
    tobi_mesh_box(mesh, min, max);
    for (int a = 0; a < 3; a++) s.origin[a] = 0.5*(min[a] + max[a]);
    s.origin[up] = sign > 0 ? min[up] : max[up];
    find_level(&s, mesh, dimension == 2 ? &section : NULL, max[up] - min[up], volume);
    tobi_section_free(&section);
    if (!(fabs(s.volume - volume) <= 1e-6*volume) || !(s.area > 0))
        return tobi_fail(err, TOBI_INVALID, "the mesh has less than %g m3 to lie below a level", volume);
    out->draught = s.level;
    out->lowest = s.origin[up];
    out->buoyancy = s.moment/s.volume;
    for (int a = 0; a < dimension; a++) {
        if (a == up) continue;
        const double inertia = s.second[a] - s.first[a]*s.first[a]/s.area;
        out->inertia[dimension == 2 ? 2 : 3 - up - a] = inertia;
    }
    return TOBI_OK;
}
