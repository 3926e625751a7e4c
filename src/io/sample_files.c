/* Values on a grid of points as VTK's image data. */
#include "io/vtk.h"
#include "tobiuo/sample.h"
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

static tobi_status check_grid(const char *path, const tobi_sample_grid *g, tobi_error *err)
{
    double points = 1;
    for (int a = 0; a < 3; a++) {
        if (g->count[a] < 1 || g->count[a] > INT32_MAX)
            return tobi_fail(err, TOBI_INVALID, "%s: %" PRId64 " points along %c, allowed are 1 to %d", path,
                             g->count[a], "xyz"[a], INT32_MAX);
        if (!(g->cell[a] > 0) || !isfinite(g->cell[a]) || !isfinite(g->origin[a]))
            return tobi_fail(err, TOBI_INVALID, "%s: the cells along %c have no width", path, "xyz"[a]);
        points *= (double)g->count[a];
    }
    return points <= 1e12 ? TOBI_OK
        : tobi_fail(err, TOBI_INVALID, "%s: %g points are too many", path, points);
}

tobi_status tobi_sample_write(const char *path, const tobi_sample_grid *g, tobi_error *err)
{
    TOBI_NEED(path, "the path");
    TOBI_NEED(g, "the grid");
    TOBI_TRY(check_grid(path, g, err));
    if (g->array_count > 0) TOBI_NEED(g->arrays, "the arrays");
    const int count = g->array_count > 0 ? g->array_count : 0;
    tobi_vtk_array *arrays = calloc((size_t)count + 1, sizeof *arrays);
    if (!arrays) return tobi_fail(err, TOBI_NO_MEMORY, "no memory to write %s", path);
    int n = 0;
    if (g->wet) arrays[n++] = (tobi_vtk_array){ "wet", TOBI_U8, 1, g->wet };
    for (int k = 0; k < count; k++)
        arrays[n++] = (tobi_vtk_array){ g->arrays[k].name, TOBI_F64, g->arrays[k].components,
                                        g->arrays[k].values };
    tobi_vtk_image image = { .arrays = arrays, .array_count = n };
    for (int a = 0; a < 3; a++)
        image.origin[a] = g->origin[a], image.cell[a] = g->cell[a], image.count[a] = g->count[a];
    const tobi_status status = tobi_vti_write(path, TOBI_COMPRESS_ZLIB, &image, err);
    free(arrays);
    return status;
}
