/* Diffuse particles as VTP: a vertex for each. */
#include "io/vtk.h"
#include "tobiuo/foam.h"

tobi_status tobi_foam_write(const char *path, const tobi_foam_particles *p, tobi_error *err)
{
    TOBI_NEED(path, "the path");
    TOBI_NEED(p, "the particles");
    const tobi_vtk_array array[] = {
        { "velocity", TOBI_F32, 3, p->velocities }, { "kind", TOBI_U8, 1, p->kind },
        { "age", TOBI_F32, 1, p->age }, { "life", TOBI_F32, 1, p->life }, { "id", TOBI_I64, 1, p->ids }
    };
    const tobi_vtk_cells cells = { .corners = 1, .count = p->count, .points = p->positions, .arrays = array,
                                   .array_count = sizeof array/sizeof *array };
    return tobi_vtp_write_cells(path, TOBI_COMPRESS_ZLIB, &cells, err);
}
