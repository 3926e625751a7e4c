/* Two triangles per cell, sides down to the base, and a fan about its middle below. Drawback: the surface is
   not thinned where it is flat. */
#include "geom/terrain.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

void tobi_terrain_free(tobi_terrain *t)
{
    free(t->x);
    free(t->y);
    free(t->z);
    *t = (tobi_terrain){ 0 };
}

/* Vertices of the rim, counterclockwise from the lowest x and y. */
static void list_rim(const tobi_terrain *t, int32_t *rim)
{
    int64_t n = 0;
    for (int64_t i = 0; i < t->nx - 1; i++) rim[n++] = (int32_t)i;
    for (int64_t j = 0; j < t->ny - 1; j++) rim[n++] = (int32_t)(j*t->nx + t->nx - 1);
    for (int64_t i = t->nx - 1; i > 0; i--) rim[n++] = (int32_t)((t->ny - 1)*t->nx + i);
    for (int64_t j = t->ny - 1; j > 0; j--) rim[n++] = (int32_t)(j*t->nx);
}

static int64_t place_triangles(const tobi_terrain *t, const int32_t *rim, int64_t around, int32_t (*out)[3])
{
    const int32_t below = (int32_t)(t->nx*t->ny), middle = (int32_t)(below + around);
    int64_t n = 0;
    for (int64_t j = 0; j + 1 < t->ny; j++)
        for (int64_t i = 0; i + 1 < t->nx; i++) {
            const int32_t a = (int32_t)(j*t->nx + i), b = (int32_t)(a + t->nx);
            memcpy(out[n++], (int32_t[]){ a, a + 1, b + 1 }, sizeof *out);
            memcpy(out[n++], (int32_t[]){ a, b + 1, b }, sizeof *out);
        }
    for (int64_t k = 0; k < around; k++) {
        const int32_t next = (int32_t)((k + 1)%around), low = (int32_t)(below + k), far = below + next;
        memcpy(out[n++], (int32_t[]){ rim[k], low, far }, sizeof *out);
        memcpy(out[n++], (int32_t[]){ rim[k], far, rim[next] }, sizeof *out);
        memcpy(out[n++], (int32_t[]){ middle, far, low }, sizeof *out);
    }
    return n;
}

static tobi_status check_heights(const char *name, const tobi_terrain *t, double base, tobi_error *err)
{
    for (int64_t k = 0; k < t->nx*t->ny; k++)
        if (!(t->z[k] > base))
            return tobi_fail(err, TOBI_INVALID, "body '%s': its terrain is %g m high at x = %g, y = %g m, "
                             "which is not above its base, %g m", name, t->z[k], t->x[k%t->nx],
                             t->y[k/t->nx], base);
    return TOBI_OK;
}

tobi_status tobi_mesh_terrain(const char *name, const tobi_terrain *t, double base, tobi_mesh *out,
                              tobi_error *err)
{
    const int64_t top = t->nx*t->ny, around = 2*(t->nx + t->ny) - 4, vertices = top + around + 1;
    const int64_t triangles = 2*(t->nx - 1)*(t->ny - 1) + 3*around;
    TOBI_TRY(check_heights(name, t, base, err));
    double (*x)[3] = malloc((size_t)vertices*sizeof *x);
    int32_t (*corner)[3] = malloc((size_t)triangles*sizeof *corner);
    int32_t *rim = malloc((size_t)around*sizeof *rim);
    tobi_status status = x && corner && rim ? TOBI_OK
                                            : tobi_fail(err, TOBI_NO_MEMORY, "no memory for a terrain");
    if (status == TOBI_OK) {
        list_rim(t, rim);
        for (int64_t k = 0; k < top; k++)
            x[k][0] = t->x[k%t->nx], x[k][1] = t->y[k/t->nx], x[k][2] = t->z[k];
        for (int64_t k = 0; k < around; k++)
            x[top + k][0] = x[rim[k]][0], x[top + k][1] = x[rim[k]][1], x[top + k][2] = base;
        x[vertices - 1][0] = 0.5*(t->x[0] + t->x[t->nx - 1]);
        x[vertices - 1][1] = 0.5*(t->y[0] + t->y[t->ny - 1]);
        x[vertices - 1][2] = base;
        place_triangles(t, rim, around, corner);
        status = tobi_mesh_build(name, vertices, (const double (*)[3])x, triangles,
                                 (const int32_t (*)[3])corner, out, err);
    }
    free(x);
    free(corner);
    free(rim);
    return status;
}
