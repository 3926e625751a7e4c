/* VTK XML files. The header is written first with room for each array's offset; arrays follow one by one,
   compressed in batches of blocks by all threads, so that the memory needed does not grow with the run.
   Index arrays of vertex cells are made block by block instead of being stored. */
#define _GNU_SOURCE 1
#include "io/vtk.h"
#include "exec/exec.h"
#include "base/file.h"
#include "io/xml.h"
#include <inttypes.h>
#include <lz4.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum { BLOCK = 65536, BATCH = 64, OFFSET_ROOM = 20, LINE = 9 };

/* Where an array's numbers come from: memory, a + b i, or (U8 and VTK_VERTEX) a constant. */
typedef struct source {
    const char   *name;
    tobi_type type;
    int           components;
    int64_t       rows;
    const void   *data;          /* NULL: first + step * index */
    int64_t       first, step;
    off_t         offset_at;     /* in the file, where the offset goes */
} source;

typedef struct document {
    tobi_file        file;
    tobi_compression compression;
    source          *sources;
    int              count;
} document;

static const char *const type_names[] = { "Float32", "Float64", "Int32", "Int64", "UInt8" };

/* Bytes [begin, begin + size) of the array: a pointer into its data, or made in scratch. */
static const void *read_source(const source *s, size_t begin, size_t size, void *scratch)
{
    if (s->data) return (const char *)s->data + begin;
    if (s->type == TOBI_U8) {
        memset(scratch, (int)s->first, size);
        return scratch;
    }
    int64_t *out = scratch;
    int64_t first = s->first + s->step*(int64_t)(begin/8);
    for (size_t i = 0; i < size/8; i++) out[i] = first + s->step*(int64_t)i;
    return scratch;
}

static size_t source_bytes(const source *s)
{
    return (size_t)s->rows*(size_t)s->components*tobi_type_size(s->type);
}

/* In real numbers little repeats, and zlib looks for that most of its time. Runs and the frequency of
   bytes make files as small (where much stands still up to 16 % larger) in half the time. */
static size_t deflate_block(int real, const void *in, size_t size, void *out, size_t room)
{
    z_stream z = { .next_in = (Bytef *)(uintptr_t)in, .avail_in = (uInt)size, .next_out = out,
                   .avail_out = (uInt)room };
    if (deflateInit2(&z, 1, Z_DEFLATED, MAX_WBITS, 8, real ? Z_RLE : Z_DEFAULT_STRATEGY) != Z_OK) return 0;
    int whole = deflate(&z, Z_FINISH) == Z_STREAM_END;
    deflateEnd(&z);
    return whole ? z.total_out : 0;
}

static size_t compress_block(const document *doc, const source *s, const void *in, size_t size, void *out,
                             size_t room)
{
    if (doc->compression != TOBI_COMPRESS_LZ4)
        return deflate_block(s->type == TOBI_F32 || s->type == TOBI_F64, in, size, out, room);
    int n = LZ4_compress_default(in, out, (int)size, (int)room);
    return n > 0 ? (size_t)n : 0;
}

static void write_raw(tobi_file *file, const source *s)
{
    uint64_t bytes = source_bytes(s);
    _Alignas(8) char scratch[BLOCK];
    tobi_file_write(file, &bytes, sizeof bytes);
    for (size_t at = 0; at < bytes && !file->error; at += BLOCK) {
        size_t size = bytes - at < BLOCK ? bytes - at : BLOCK;
        tobi_file_write(file, read_source(s, at, size, scratch), size);
    }
}

/* Blocks from `begin` on, each into a slot of its own. */
typedef struct packing {
    const document *doc;
    const source *s;
    size_t begin, bytes, room;
    uint64_t *header;
    char *packed, *scratch;
    int *failed;
} packing;

static void pack_blocks(const void *view, int64_t begin, int64_t end)
{
    const packing *p = view;
    for (size_t slot = (size_t)begin; slot < (size_t)end; slot++) {
        size_t b = p->begin + slot, size = p->bytes - b*BLOCK < BLOCK ? p->bytes - b*BLOCK : BLOCK;
        const void *in = read_source(p->s, b*BLOCK, size, p->scratch + slot*BLOCK);
        p->header[3 + b] = compress_block(p->doc, p->s, in, size, p->packed + slot*p->room, p->room);
        if (p->header[3 + b] == 0) __atomic_store_n(p->failed, 1, __ATOMIC_RELAXED);
    }
}

/* Header {blocks, block size, size of a partial last block, compressed sizes...}, then the blocks. */
static tobi_status write_compressed(document *doc, const source *s, tobi_error *err)
{
    size_t bytes = source_bytes(s), blocks = (bytes + BLOCK - 1)/BLOCK;
    size_t room = compressBound(BLOCK) > (uLong)LZ4_compressBound(BLOCK) ? compressBound(BLOCK)
                                                                        : (size_t)LZ4_compressBound(BLOCK);
    size_t slots = blocks < BATCH ? blocks : BATCH;
    uint64_t *header = calloc(blocks + 3, sizeof *header);
    char *packed = malloc(slots*room + 1), *scratch = malloc(slots*BLOCK + 8);
    int failed = 0;
    if (header && packed && scratch) {
        header[0] = blocks;
        header[1] = BLOCK;
        header[2] = bytes%BLOCK;
        off_t header_at = tobi_file_tell(&doc->file);
        tobi_file_write(&doc->file, header, (blocks + 3)*sizeof *header);
        for (size_t begin = 0; begin < blocks && !doc->file.error; begin += BATCH) {
            size_t end = blocks - begin < BATCH ? blocks : begin + BATCH;
            const packing view = { doc, s, begin, bytes, room, header, packed, scratch, &failed };
            tobi_loop(0, (int64_t)(end - begin), 1, pack_blocks, &view);
            for (size_t b = begin; b < end; b++)
                tobi_file_write(&doc->file, packed + (b - begin)*room, header[3 + b]);
        }
        tobi_file_patch(&doc->file, header_at, header, (blocks + 3)*sizeof *header);
    }
    tobi_status status = TOBI_OK;
    if (!header || !packed || !scratch || failed)
        status = tobi_fail(err, TOBI_NO_MEMORY, "no memory to compress %s of %s", s->name, doc->file.path);
    free(header);
    free(packed);
    free(scratch);
    return status;
}

/* Numbers as text, a few per line. The format has no text for NaN and infinity: those are refused. */
static tobi_status write_ascii(document *doc, const source *s, tobi_error *err)
{
    tobi_file *file = &doc->file;
    int64_t count = s->rows*s->components;
    for (int64_t i = 0; i < count && !file->error; i++) {
        double real = s->type == TOBI_F32 ? (double)((const float *)s->data)[i]
                    : s->type == TOBI_F64 ? ((const double *)s->data)[i] : 0;
        if (!isfinite(real))
            return tobi_fail(err, TOBI_INVALID,
                             "%s: row %" PRId64 " of %s is not finite, which an ASCII file cannot hold; "
                             "use a binary format", file->path, i/s->components, s->name);
        const char *gap = i%LINE == LINE - 1 || i == count - 1 ? "\n" : " ";
        int64_t whole = !s->data ? s->first + s->step*i
                      : s->type == TOBI_I32 ? ((const int32_t *)s->data)[i]
                      : s->type == TOBI_I64 ? ((const int64_t *)s->data)[i]
                      : s->type == TOBI_U8 ? ((const uint8_t *)s->data)[i] : 0;
        if (s->type == TOBI_F32 || s->type == TOBI_F64)
            tobi_file_print(file, s->type == TOBI_F32 ? "%.9g%s" : "%.17g%s", real, gap);
        else
            tobi_file_print(file, "%" PRId64 "%s", whole, gap);
    }
    return TOBI_OK;
}

/* The DataArray element: complete in ASCII, else with room for an offset to be filled in later. */
static tobi_status add_source(document *doc, source s, tobi_error *err)
{
    tobi_file *file = &doc->file;
    char *name = tobi_xml_escape(s.name);
    if (!name) return tobi_fail(err, TOBI_NO_MEMORY, "no memory to write %s", file->path);
    tobi_file_print(file, "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" ", type_names[s.type],
                    name, s.components);
    free(name);
    if (doc->compression == TOBI_ASCII) {
        tobi_file_print(file, "format=\"ascii\">\n");
        TOBI_TRY(write_ascii(doc, &s, err));
        tobi_file_print(file, "</DataArray>\n");
        return TOBI_OK;
    }
    tobi_file_print(file, "format=\"appended\" offset=");
    s.offset_at = tobi_file_tell(file);
    tobi_file_print(file, "%*s/>\n", OFFSET_ROOM + 2, "");
    doc->sources[doc->count++] = s;
    return TOBI_OK;
}

static tobi_status add_arrays(document *doc, const tobi_vtk_array *arrays, int count, int64_t rows,
                              tobi_error *err)
{
    for (int i = 0; i < count; i++) {
        const tobi_vtk_array *a = &arrays[i];
        TOBI_TRY(add_source(doc, (source){ .name = a->name, .type = a->type, .components = a->components,
                                           .rows = rows, .data = a->data }, err));
    }
    return TOBI_OK;
}

static tobi_status check_arrays(const char *path, const tobi_vtk_array *arrays, int count, int64_t rows,
                                tobi_error *err)
{
    if (rows < 0 || count < 0)
        return tobi_fail(err, TOBI_INVALID, "%s: a negative number of rows or arrays", path);
    for (int i = 0; i < count; i++) {
        const tobi_vtk_array *a = &arrays[i];
        if (!a->name || !a->name[0])
            return tobi_fail(err, TOBI_INVALID, "%s: array %d has no name", path, i);
        if (tobi_type_size(a->type) == 0)
            return tobi_fail(err, TOBI_INVALID, "%s: array %s has an unknown type", path, a->name);
        if (a->components < 1)
            return tobi_fail(err, TOBI_INVALID,
                             "%s: array %s has %d components, at least 1 is needed", path, a->name,
                             a->components);
        if (!a->data && rows > 0)
            return tobi_fail(err, TOBI_INVALID, "%s: array %s has no data", path, a->name);
    }
    return TOBI_OK;
}

static tobi_status check_triangles(const char *path, int64_t vertex_count, int64_t triangle_count,
                                   const int32_t (*triangles)[3], tobi_error *err)
{
    if (vertex_count < 0 || triangle_count < 0)
        return tobi_fail(err, TOBI_INVALID, "%s: a negative number of vertices or triangles", path);
    for (int64_t t = 0; t < triangle_count; t++)
        for (int k = 0; k < 3; k++)
            if (triangles[t][k] < 0 || triangles[t][k] >= vertex_count)
                return tobi_fail(err, TOBI_INVALID, "%s: triangle %" PRId64 " uses vertex %d of %" PRId64,
                                 path, t,
                                 (int)triangles[t][k], vertex_count);
    return TOBI_OK;
}

/* attributes: of the element that is named as the type, as " Origin=...", or "". */
static tobi_status open_document(document *doc, const char *path, tobi_compression compression,
                                 const char *type, const char *attributes, int array_room, tobi_error *err)
{
    *doc = (document){ .compression = compression };
    if ((unsigned)compression > TOBI_ASCII)
        return tobi_fail(err, TOBI_INVALID, "%s: unknown compression %d", path, (int)compression);
    doc->sources = calloc((size_t)array_room, sizeof *doc->sources);
    if (!doc->sources) return tobi_fail(err, TOBI_NO_MEMORY, "no memory to write %s", path);
    tobi_status status = tobi_file_open(&doc->file, path, err);
    if (status != TOBI_OK) {
        free(doc->sources);
        return status;
    }
    const char *compressor = compression == TOBI_COMPRESS_ZLIB ? " compressor=\"vtkZLibDataCompressor\""
                           : compression == TOBI_COMPRESS_LZ4 ? " compressor=\"vtkLZ4DataCompressor\"" : "";
    tobi_file_print(
        &doc->file,
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<VTKFile type=\"%s\" version=\"1.0\" "
        "byte_order=\"LittleEndian\" header_type=\"UInt64\"%s>\n<%s%s>\n",
        type, compressor, type, attributes);
    return TOBI_OK;
}

static tobi_status write_appended(document *doc, tobi_error *err)
{
    tobi_file *file = &doc->file;
    tobi_file_print(file, "<AppendedData encoding=\"raw\">\n_");
    off_t origin = tobi_file_tell(file);
    for (int i = 0; i < doc->count; i++) {
        source *s = &doc->sources[i];
        char offset[OFFSET_ROOM + 3];
        int n = snprintf(offset, sizeof offset, "\"%" PRId64 "\"",
                         (int64_t)(tobi_file_tell(file) - origin));
        tobi_file_patch(file, s->offset_at, offset, (size_t)n);
        if (doc->compression == TOBI_COMPRESS_NONE) write_raw(file, s);
        else TOBI_TRY(write_compressed(doc, s, err));
    }
    tobi_file_print(file, "\n</AppendedData>\n");
    return TOBI_OK;
}

/* Ends the element and the file; status is how the writing went so far. */
static tobi_status close_document(document *doc, const char *type, tobi_status status, tobi_error *err)
{
    if (status == TOBI_OK) {
        tobi_file_print(&doc->file, "</Piece>\n</%s>\n", type);
        if (doc->compression != TOBI_ASCII) status = write_appended(doc, err);
        tobi_file_print(&doc->file, "</VTKFile>\n");
    }
    free(doc->sources);
    if (status == TOBI_OK) return tobi_file_commit(&doc->file, err);
    tobi_file_abandon(&doc->file);
    return status;
}

static tobi_status write_points(document *doc, int64_t n, const double (*points)[3], tobi_error *err)
{
    tobi_file_print(&doc->file, "<Points>\n");
    TOBI_TRY(add_source(doc, (source){ .name = "Points", .type = TOBI_F64, .components = 3, .rows = n,
                                       .data = points }, err));
    tobi_file_print(&doc->file, "</Points>\n");
    return TOBI_OK;
}

static tobi_status write_vertex_cells(document *doc, int64_t n, tobi_error *err)
{
    tobi_file_print(&doc->file, "<Cells>\n");
    TOBI_TRY(add_source(doc, (source){ "connectivity", TOBI_I64, 1, n, NULL, 0, 1, 0 }, err));
    TOBI_TRY(add_source(doc, (source){ "offsets", TOBI_I64, 1, n, NULL, 1, 1, 0 }, err));
    TOBI_TRY(add_source(doc, (source){ "types", TOBI_U8, 1, n, NULL, 1, 0, 0 }, err));
    tobi_file_print(&doc->file, "</Cells>\n");
    return TOBI_OK;
}

static void begin_point_data(tobi_file *file, const tobi_vtk_array *arrays, int count)
{
    tobi_file_print(file, "<PointData");
    for (int i = 0; i < count; i++) {
        if (arrays[i].components == 2 && strcmp(arrays[i].name, "texture_coordinates") == 0)
            tobi_file_print(file, " TCoords=\"texture_coordinates\"");
        if (arrays[i].components == 3 && strcmp(arrays[i].name, "normals") == 0)
            tobi_file_print(file, " Normals=\"normals\"");
    }
    tobi_file_print(file, ">\n");
}

static tobi_status write_particles(document *doc, int64_t n, const double (*points)[3],
                                   const tobi_vtk_array *arrays, int array_count, tobi_error *err)
{
    tobi_file_print(&doc->file,
                    "<Piece NumberOfPoints=\"%" PRId64 "\" NumberOfCells=\"%" PRId64 "\">\n", n, n);
    begin_point_data(&doc->file, arrays, array_count);
    TOBI_TRY(add_arrays(doc, arrays, array_count, n, err));
    tobi_file_print(&doc->file, "</PointData>\n<CellData/>\n");
    TOBI_TRY(write_points(doc, n, points, err));
    return write_vertex_cells(doc, n, err);
}

tobi_status tobi_vtu_write(const char *path, tobi_compression compression, int64_t n,
                           const double (*points)[3],
                           const tobi_vtk_array *arrays, int array_count, tobi_error *err)
{
    TOBI_TRY(check_arrays(path, arrays, array_count, n, err));
    if (n > 0 && !points) return tobi_fail(err, TOBI_INVALID, "%s: no points", path);
    document doc;
    TOBI_TRY(open_document(&doc, path, compression, "UnstructuredGrid", "", array_count + 4, err));
    tobi_status status = write_particles(&doc, n, points, arrays, array_count, err);
    return close_document(&doc, "UnstructuredGrid", status, err);
}

static tobi_status write_surface(document *doc, const tobi_vtk_surface *s, tobi_error *err)
{
    tobi_file_print(&doc->file,
                    "<Piece NumberOfPoints=\"%" PRId64 "\" NumberOfVerts=\"0\" NumberOfLines=\"0\" "
                    "NumberOfStrips=\"0\" NumberOfPolys=\"%" PRId64 "\">\n",
                    s->vertex_count, s->triangle_count);
    begin_point_data(&doc->file, s->point_arrays, s->point_array_count);
    TOBI_TRY(add_arrays(doc, s->point_arrays, s->point_array_count, s->vertex_count, err));
    tobi_file_print(&doc->file, "</PointData>\n<CellData>\n");
    TOBI_TRY(add_arrays(doc, s->cell_arrays, s->cell_array_count, s->triangle_count, err));
    tobi_file_print(&doc->file, "</CellData>\n");
    TOBI_TRY(write_points(doc, s->vertex_count, s->vertices, err));
    tobi_file_print(&doc->file, "<Polys>\n");
    TOBI_TRY(add_source(doc, (source){ .name = "connectivity", .type = TOBI_I32, .components = 1,
                                       .rows = 3*s->triangle_count, .data = s->triangles }, err));
    TOBI_TRY(add_source(doc, (source){ "offsets", TOBI_I64, 1, s->triangle_count, NULL, 3, 3, 0 }, err));
    tobi_file_print(&doc->file, "</Polys>\n");
    return TOBI_OK;
}

tobi_status tobi_vtp_write(const char *path, tobi_compression compression, const tobi_vtk_surface *surface,
                           tobi_error *err)
{
    const tobi_vtk_surface *s = surface;
    TOBI_TRY(check_arrays(path, s->point_arrays, s->point_array_count, s->vertex_count, err));
    TOBI_TRY(check_arrays(path, s->cell_arrays, s->cell_array_count, s->triangle_count, err));
    TOBI_TRY(check_triangles(path, s->vertex_count, s->triangle_count, s->triangles, err));
    document doc;
    int arrays = s->point_array_count + s->cell_array_count + 3;
    TOBI_TRY(open_document(&doc, path, compression, "PolyData", "", arrays, err));
    tobi_status status = write_surface(&doc, s, err);
    return close_document(&doc, "PolyData", status, err);
}

/* Cells of one, two or three points that no other cell has. Arrays of single points are theirs. */
static tobi_status write_cells(document *doc, const tobi_vtk_cells *s, tobi_error *err)
{
    static const char *const kinds[] = { "Verts", "Lines", "Polys" };
    const int n = s->corners;
    const char *home = n == 1 ? "Point" : "Cell";
    tobi_file_print(&doc->file,
                    "<Piece NumberOfPoints=\"%" PRId64 "\" NumberOfVerts=\"%" PRId64 "\" NumberOfLines=\"%"
                    PRId64 "\" NumberOfStrips=\"0\" NumberOfPolys=\"%" PRId64 "\">\n%s<%sData>\n",
                    n*s->count, n == 1 ? s->count : 0, n == 2 ? s->count : 0, n == 3 ? s->count : 0,
                    n == 1 ? "" : "<PointData/>\n", home);
    TOBI_TRY(add_arrays(doc, s->arrays, s->array_count, s->count, err));
    tobi_file_print(&doc->file, "</%sData>\n%s", home, n == 1 ? "<CellData/>\n" : "");
    TOBI_TRY(write_points(doc, n*s->count, s->points, err));
    tobi_file_print(&doc->file, "<%s>\n", kinds[n - 1]);
    TOBI_TRY(add_source(doc, (source){ "connectivity", TOBI_I64, 1, n*s->count, NULL, 0, 1, 0 }, err));
    TOBI_TRY(add_source(doc, (source){ "offsets", TOBI_I64, 1, s->count, NULL, n, n, 0 }, err));
    tobi_file_print(&doc->file, "</%s>\n", kinds[n - 1]);
    return TOBI_OK;
}

tobi_status tobi_vtp_write_cells(const char *path, tobi_compression compression, const tobi_vtk_cells *s,
                                 tobi_error *err)
{
    TOBI_TRY(check_arrays(path, s->arrays, s->array_count, s->count, err));
    if (s->corners < 1 || s->corners > 3)
        return tobi_fail(err, TOBI_INVALID, "%s: cells of %d points; allowed are 1 to 3", path, s->corners);
    if (s->count > 0 && !s->points) return tobi_fail(err, TOBI_INVALID, "%s: no points", path);
    document doc;
    TOBI_TRY(open_document(&doc, path, compression, "PolyData", "", s->array_count + 3, err));
    tobi_status status = write_cells(&doc, s, err);
    return close_document(&doc, "PolyData", status, err);
}

static tobi_status write_image(document *doc, const tobi_vtk_image *s, const char *extent, int64_t rows,
                               tobi_error *err)
{
    tobi_file_print(&doc->file, "<Piece Extent=\"%s\">\n", extent);
    begin_point_data(&doc->file, s->arrays, s->array_count);
    TOBI_TRY(add_arrays(doc, s->arrays, s->array_count, rows, err));
    tobi_file_print(&doc->file, "</PointData>\n<CellData/>\n");
    return TOBI_OK;
}

/* Numbers in the element itself are written here, without a locale's decimal mark: VTK reads a point. */
static void print_triple(char *text, size_t room, const double v[3])
{
    snprintf(text, room, "%.17g %.17g %.17g", v[0], v[1], v[2]);
    for (char *c = text; *c; c++)
        if (*c == ',') *c = '.';
}

tobi_status tobi_vti_write(const char *path, tobi_compression compression, const tobi_vtk_image *s,
                           tobi_error *err)
{
    char extent[128], origin[96], cell[96], attributes[400];
    const int64_t rows = s->count[0]*s->count[1]*s->count[2];
    TOBI_TRY(check_arrays(path, s->arrays, s->array_count, rows, err));
    snprintf(extent, sizeof extent, "0 %" PRId64 " 0 %" PRId64 " 0 %" PRId64, s->count[0] - 1,
             s->count[1] - 1, s->count[2] - 1);
    print_triple(origin, sizeof origin, s->origin);
    print_triple(cell, sizeof cell, s->cell);
    snprintf(attributes, sizeof attributes, " WholeExtent=\"%s\" Origin=\"%s\" Spacing=\"%s\"", extent,
             origin, cell);
    document doc;
    TOBI_TRY(open_document(&doc, path, compression, "ImageData", attributes, s->array_count + 1, err));
    const tobi_status status = write_image(&doc, s, extent, rows, err);
    return close_document(&doc, "ImageData", status, err);
}

tobi_status tobi_stl_write(const char *path, int64_t vertex_count, const double (*vertices)[3],
                           int64_t triangle_count, const int32_t (*triangles)[3], tobi_error *err)
{
    TOBI_TRY(check_triangles(path, vertex_count, triangle_count, triangles, err));
    if (triangle_count > UINT32_MAX)
        return tobi_fail(err, TOBI_INVALID, "%s: STL holds at most %u triangles", path, UINT32_MAX);
    tobi_file file;
    TOBI_TRY(tobi_file_open(&file, path, err));
    /* Not starting with "solid", by which readers recognise the text form. */
    char title[80] = "binary STL, metres";
    uint32_t count = (uint32_t)triangle_count;
    tobi_file_write(&file, title, sizeof title);
    tobi_file_write(&file, &count, sizeof count);
    for (int64_t t = 0; t < triangle_count && !file.error; t++) {
        const int32_t *i = triangles[t];
        const double *a = vertices[i[0]], *b = vertices[i[1]], *c = vertices[i[2]];
        double u[3], v[3];
        for (int k = 0; k < 3; k++) u[k] = b[k] - a[k], v[k] = c[k] - a[k];
        double normal[3] = { u[1]*v[2] - u[2]*v[1], u[2]*v[0] - u[0]*v[2], u[0]*v[1] - u[1]*v[0] };
        double length = sqrt(normal[0]*normal[0] + normal[1]*normal[1] + normal[2]*normal[2]);
        float record[12];
        for (int k = 0; k < 3; k++) {
            record[k] = (float)(length > 0 ? normal[k]/length : 0);
            record[3 + k] = (float)a[k], record[6 + k] = (float)b[k], record[9 + k] = (float)c[k];
        }
        tobi_file_write(&file, record, sizeof record);
        tobi_file_write(&file, "\0", 2);
    }
    return tobi_file_commit(&file, err);
}
