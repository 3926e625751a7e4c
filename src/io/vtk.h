/* ParaView files: particles (VTU), surfaces (VTP, STL), grids (VTI); lists of them are in io/pvd.h.

   VTU, VTP and VTI hold appended raw binary with a UInt64 header, optionally compressed in blocks by
   zlib or LZ4, or ASCII. Source: the VTK XML file format as its own readers define it. Every file
   appears whole or not at all (base/file.h). Failures: TOBI_IO with path and reason, TOBI_INVALID for
   arguments that no file can hold. Arrays are borrowed for the call. Names and file names are UTF-8
   and may hold any character. */
#pragma once
#include "tobiuo/types.h"
#include "base/error.h"
#include "base/type.h"

/* Point data of 2 components named "texture_coordinates" are marked as those that pictures are put on by,
   those of 3 named "normals" as normals. */
typedef struct tobi_vtk_array {
    const char   *name;
    tobi_type type;
    int           components;   /* 1 = scalar, 3 = vector                      */
    const void   *data;         /* rows x components, row-major; may be NULL if there are no rows */
} tobi_vtk_array;

/* Particles: one vertex cell per point. points in m; every array has n rows; n = 0 is fine. */
tobi_status tobi_vtu_write(const char *path, tobi_compression compression, int64_t n,
                           const double (*points)[3],
                           const tobi_vtk_array *arrays, int array_count, tobi_error *err);

typedef struct tobi_vtk_surface {
    int64_t vertex_count;
    const double (*vertices)[3];            /* m                             */
    int64_t triangle_count;
    const int32_t (*triangles)[3];          /* indices into vertices         */
    const tobi_vtk_array *point_arrays;     /* vertex_count rows each        */
    int point_array_count;
    const tobi_vtk_array *cell_arrays;      /* triangle_count rows each      */
    int cell_array_count;
} tobi_vtk_surface;

/* Writes a surface as VTP, whole or not at all. TOBI_INVALID for arrays that no file could hold, TOBI_IO,
   TOBI_NO_MEMORY. */
tobi_status tobi_vtp_write(const char *path, tobi_compression compression, const tobi_vtk_surface *surface,
                           tobi_error *err);

/* Points, lines or triangles that share no point: cell k has the points corners*k and on. */
typedef struct tobi_vtk_cells {
    int corners;                            /* 1 to 3                        */
    int64_t count;                          /* cells                         */
    const double (*points)[3];              /* corners*count, m              */
    const tobi_vtk_array *arrays;           /* count rows each; of single points, or of cells */
    int array_count;
} tobi_vtk_cells;
tobi_status tobi_vtp_write_cells(const char *path, tobi_compression compression, const tobi_vtk_cells *cells,
                                 tobi_error *err);

/* Numbers at the points of a regular grid, x running fastest. */
typedef struct tobi_vtk_image {
    double origin[3], cell[3];              /* m, the first point, the distances of points */
    int64_t count[3];                       /* points along each axis        */
    const tobi_vtk_array *arrays;           /* a row for each point          */
    int array_count;
} tobi_vtk_image;
/* Writes it as VTI; the failures of tobi_vtp_write. */
tobi_status tobi_vti_write(const char *path, tobi_compression compression, const tobi_vtk_image *image,
                           tobi_error *err);

/* Binary STL: little-endian floats, normals by the right-hand rule. At most 2^32 - 1 triangles. */
tobi_status tobi_stl_write(const char *path, int64_t vertex_count, const double (*vertices)[3],
                           int64_t triangle_count, const int32_t (*triangles)[3], tobi_error *err);
