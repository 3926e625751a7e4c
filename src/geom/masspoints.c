/* The inside of a mesh as columns: along the axis in which the mesh is thinnest, each triangle spans a prism
   with the middle plane, of positive or negative volume, with Gauss points in it (docs/decisions/0069).
   Drawback: of a body that is not convex some columns, and so some points, lie outside of it, in pairs that
   take each other away as well as the motion is smooth there. */
#include "geom/masspoints.h"
#include "base/error.h"
#include "geom/section.h"
#include "geom/vec3.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A rule of degree 3 on a triangle (Strang & Fix 1973) and two Gauss points on a line. */
enum { ON_TRIANGLE = 4, ON_LINE = 2 };
static const double weight[ON_TRIANGLE] = { -27.0/48, 25.0/48, 25.0/48, 25.0/48 };
static const double share[ON_TRIANGLE][3] = { { 1.0/3, 1.0/3, 1.0/3 }, { 0.6, 0.2, 0.2 }, { 0.2, 0.6, 0.2 },
                                              { 0.2, 0.2, 0.6 } };
#define GAUSS 0.21132486540518711775      /* (1 - 1/sqrt 3)/2 */

void tobi_mass_points_free(tobi_mass_points *p)
{
    free(p->at);
    free(p->volume);
    *p = (tobi_mass_points){ 0 };
}

static tobi_status reserve(tobi_mass_points *p, int64_t count, tobi_error *err)
{
    p->at = malloc((size_t)(count + 1)*sizeof *p->at);
    p->volume = malloc((size_t)(count + 1)*sizeof *p->volume);
    if (p->at && p->volume) return TOBI_OK;
    tobi_mass_points_free(p);
    return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld mass points", (long long)count);
}

/* The points of a column from the plane at `middle` to x, over an area across the axis, m2 or m. */
static void add_column(tobi_mass_points *p, const double x[3], int axis, double middle, double area)
{
    const double length = x[axis] - middle;
    for (int k = 0; k < ON_LINE; k++) {
        double *at = p->at[p->count];
        memcpy(at, x, 3*sizeof *x);
        at[axis] = middle + length*(k ? 1 - GAUSS : GAUSS);
        p->volume[p->count++] = 0.5*length*area;
    }
}

static void fill_volume(const tobi_mesh *mesh, int axis, double middle, tobi_mass_points *out)
{
    for (int64_t t = 0; t < mesh->triangle_count; t++) {
        const double *corner[3];
        double u[3], v[3], n[3];
        for (int c = 0; c < 3; c++) corner[c] = mesh->vertices[mesh->triangles[t][c]];
        vec3_sub(u, corner[1], corner[0]);
        vec3_sub(v, corner[2], corner[0]);
        vec3_cross(n, u, v);
        for (int k = 0; k < ON_TRIANGLE; k++) {
            double x[3] = { 0 };
            for (int c = 0; c < 3; c++) vec3_add_scaled(x, x, share[k][c], corner[c]);
            add_column(out, x, axis, middle, 0.5*n[axis]*weight[k]);
        }
    }
}

/* The inside is on the left of a piece: its outward normal times its length is (dy, -dx). */
static void fill_section(const tobi_section *s, int axis, double middle, tobi_mass_points *out)
{
    for (int64_t i = 0; i < s->count; i++) {
        const double *a = s->from[i], *b = s->to[i];
        const double across = axis == 0 ? b[1] - a[1] : a[0] - b[0];
        for (int k = 0; k < ON_LINE; k++) {
            const double part = k ? 1 - GAUSS : GAUSS;
            const double x[3] = { a[0] + part*(b[0] - a[0]), a[1] + part*(b[1] - a[1]), 0 };
            add_column(out, x, axis, middle, 0.5*across);
        }
    }
}

tobi_status tobi_mass_points_make(const tobi_mesh *mesh, int dimension, tobi_mass_points *out,
                                  tobi_error *err)
{
    double low[3], high[3];
    int axis = 0;
    *out = (tobi_mass_points){ 0 };
    tobi_mesh_box(mesh, low, high);
    for (int a = 1; a < dimension; a++)
        if (high[a] - low[a] < high[axis] - low[axis]) axis = a;
    const double middle = 0.5*(low[axis] + high[axis]);
    if (dimension == 3) {
        TOBI_TRY(reserve(out, ON_TRIANGLE*ON_LINE*mesh->triangle_count, err));
        fill_volume(mesh, axis, middle, out);
        return TOBI_OK;
    }
    tobi_section section;
    TOBI_TRY(tobi_section_cut(mesh, &section, err));
    const tobi_status status = reserve(out, ON_LINE*ON_LINE*section.count, err);
    if (status == TOBI_OK) fill_section(&section, axis, middle, out);
    tobi_section_free(&section);
    return status;
}
