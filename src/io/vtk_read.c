/* The VTK XML files of this library, read back: the head is looked through for DataArray elements, whose
   numbers follow behind it or, in ASCII, inside. Every size is checked against the file. Drawback: files of
   other programs, and other orders of attributes' values, are refused as damaged. */
#define _GNU_SOURCE 1
#include "io/vtk_read.h"
#include "base/plain.h"
#include "base/type.h"
#include <lz4.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum { NAME = 128, LARGEST_BLOCK = 1 << 24 };

typedef struct reader {
    const char *path;
    char *text;                        /* the file, owned                                    */
    size_t size;
    const char *body;                  /* where appended data begin; NULL: ASCII             */
    enum { RAW, ZLIB, LZ4 } packing;
    int64_t points, polygons;
} reader;

/* A DataArray element. */
typedef struct element {
    char name[NAME], section[16];      /* "PointData", "Points", "Polys"                     */
    tobi_type type;
    int components, ascii;
    uint64_t offset;                   /* from the body                                      */
    const char *inside;                /* behind its ">"                                     */
} element;

static tobi_status fail_damaged(const reader *r, const char *why, tobi_error *err)
{
    return tobi_fail(err, TOBI_DAMAGED, "results %s: %s", r->path, why);
}

/* The value of an attribute in the tag that begins at `tag`, entities resolved. 0 if it is not there. */
static int find_attribute(const char *tag, const char *name, char out[NAME])
{
    static const struct { const char *entity; char letter; } entities[] = {
        { "&amp;", '&' }, { "&lt;", '<' }, { "&gt;", '>' }, { "&quot;", '"' }, { "&apos;", '\'' },
    };
    char key[32];
    snprintf(key, sizeof key, " %s=\"", name);
    const char *end = strchr(tag, '>'), *at = strstr(tag, key);
    size_t n = 0;
    if (!end || !at || at > end) return 0;
    for (at += strlen(key); *at && *at != '"' && n + 1 < NAME; at++) {
        char letter = *at;
        for (size_t k = 0; letter == '&' && k < sizeof entities/sizeof *entities; k++)
            if (strncmp(at, entities[k].entity, strlen(entities[k].entity)) == 0) {
                letter = entities[k].letter;
                at += strlen(entities[k].entity) - 1;
                break;
            }
        out[n++] = letter;
    }
    out[n] = '\0';
    return *at == '"';
}

static int64_t find_number(const char *tag, const char *name)
{
    char value[NAME], *end;
    if (!find_attribute(tag, name, value)) return -1;
    const long long number = strtoll(value, &end, 10);
    return *value && !*end ? number : -1;
}

static tobi_status open_reader(reader *r, const char *path, tobi_error *err)
{
    char value[NAME];
    *r = (reader){ .path = path };
    TOBI_TRY(tobi_plain_read(path, tr("results"), 0, &r->text, &r->size, err));
    const char *file = strstr(r->text, "<VTKFile"), *piece = strstr(r->text, "<Piece ");
    const char *appended = strstr(r->text, "<AppendedData encoding=\"raw\">");
    const char *underscore = appended ? strchr(appended, '_') : NULL;
    if (!file || !piece || !strchr(file, '>') || !strchr(piece, '>'))
        return fail_damaged(r, tr("is no VTK file of a run"), err);
    if (underscore) r->body = underscore + 1;
    if (find_attribute(file, "compressor", value)) r->packing = strstr(value, "LZ4") ? LZ4 : ZLIB;
    r->points = find_number(piece, "NumberOfPoints");
    r->polygons = find_number(piece, "NumberOfPolys");
    if (r->points < 0) return fail_damaged(r, tr("has no number of points"), err);
    return TOBI_OK;
}

/* The next DataArray behind *at; 0 past the last. A section's name is that of the last tag that opens one. */
static int next_element(const reader *r, const char **at, element *e)
{
    static const char *const sections[] = { "<PointData", "<CellData", "<Points>", "<Cells>", "<Verts>",
                                            "<Polys>" };
    static const char *const types[] = { "Float32", "Float64", "Int32", "Int64", "UInt8" };
    char value[NAME];
    const char *tag = strstr(*at, "<DataArray ");
    if (!tag || (r->body && tag > r->body)) return 0;
    for (const char *s = strchr(*at, '<'); s && s < tag; s = strchr(s + 1, '<'))
        for (size_t k = 0; k < sizeof sections/sizeof *sections; k++)
            if (strncmp(s, sections[k], strlen(sections[k])) == 0)
                snprintf(e->section, sizeof e->section, "%.*s", (int)strcspn(s + 1, "> "), s + 1);
    e->inside = strchr(tag, '>');
    if (!e->inside || !find_attribute(tag, "Name", e->name) || !find_attribute(tag, "type", value)) return 0;
    for (e->type = TOBI_F32; e->type <= TOBI_U8 && strcmp(value, types[e->type]) != 0; e->type++) {}
    e->components = (int)find_number(tag, "NumberOfComponents");
    e->ascii = find_attribute(tag, "format", value) && strcmp(value, "ascii") == 0;
    const int64_t offset = find_number(tag, "offset");
    e->offset = offset < 0 ? UINT64_MAX : (uint64_t)offset;
    *at = ++e->inside;
    return e->type <= TOBI_U8 && e->components >= 1 && e->components <= 16;
}

static uint64_t load_u64(const char *at)
{
    uint64_t value;
    memcpy(&value, at, sizeof value);
    return value;
}

static int unpack_block(const reader *r, const char *in, size_t packed, char *out, size_t size)
{
    uLongf got = size;
    if (r->packing == LZ4) return LZ4_decompress_safe(in, out, (int)packed, (int)size) == (int)size;
    return uncompress((Bytef *)out, &got, (const Bytef *)in, packed) == Z_OK && got == size;
}

/* The bytes of an appended array, `bytes` of them as the head says. */
static tobi_status read_bytes(const reader *r, const element *e, char *out, size_t bytes, tobi_error *err)
{
    const char *cut = tr("ends too early");
    const size_t room = r->body ? r->size - (size_t)(r->body - r->text) : 0;
    if (e->offset > room || room - e->offset < 8) return fail_damaged(r, cut, err);
    const char *at = r->body + e->offset;
    size_t left = room - e->offset, done = 0;
    if (r->packing == RAW) {
        if (load_u64(at) != bytes || left - 8 < bytes) return fail_damaged(r, cut, err);
        memcpy(out, at + 8, bytes);
        return TOBI_OK;
    }
    const uint64_t blocks = load_u64(at);
    if (left < 24 || blocks > (left - 24)/8) return fail_damaged(r, cut, err);
    const uint64_t size = load_u64(at + 8), partial = load_u64(at + 16);
    const char *sizes = at + 24, *data = sizes + 8*blocks;
    left -= 24 + 8*blocks;
    for (uint64_t b = 0; b < blocks; b++) {
        const uint64_t packed = load_u64(sizes + 8*b), whole = b + 1 == blocks && partial ? partial : size;
        if (packed > left || packed > LARGEST_BLOCK || whole > LARGEST_BLOCK || whole > bytes - done)
            return fail_damaged(r, cut, err);
        if (!unpack_block(r, data, packed, out + done, whole))
            return fail_damaged(r, tr("holds a block that cannot be unpacked"), err);
        data += packed;
        left -= packed;
        done += whole;
    }
    return done == bytes ? TOBI_OK : fail_damaged(r, cut, err);
}

static double number_at(const char *bytes, tobi_type type, size_t k)
{
    union { float f; double d; int32_t i; int64_t l; } v;
    memcpy(&v, bytes + k*tobi_type_size(type), tobi_type_size(type));
    switch (type) {
    case TOBI_F32: return (double)v.f;
    case TOBI_F64: return v.d;
    case TOBI_I32: return v.i;
    case TOBI_I64: return (double)v.l;
    default: return (unsigned char)bytes[k];
    }
}

static tobi_status read_ascii(const reader *r, const element *e, double *out, size_t count, tobi_error *err)
{
    const char *at = e->inside;
    for (size_t k = 0; k < count; k++) {
        char *end;
        out[k] = strtod(at, &end);
        if (end == at) return fail_damaged(r, tr("has fewer numbers than rows"), err);
        at = end;
    }
    return TOBI_OK;
}

/* rows x components numbers, owned by the caller. More rows than bytes of the file are never made room for,
   unless they were packed, and then by at most a thousand, which zlib cannot exceed. */
static tobi_status read_numbers(const reader *r, const element *e, int64_t rows, double **out,
                                tobi_error *err)
{
    const uint64_t most = (uint64_t)r->size*1100;
    *out = NULL;
    if ((uint64_t)rows > most/(uint64_t)e->components)
        return fail_damaged(r, tr("says it has more rows than it can hold"), err);
    const size_t count = (size_t)rows*(size_t)e->components, bytes = count*tobi_type_size(e->type);
    char *raw = e->ascii ? NULL : malloc(bytes + 1);
    double *numbers = malloc((count + 1)*sizeof *numbers);
    tobi_status status = numbers && (raw || e->ascii)
        ? TOBI_OK : tobi_fail(err, TOBI_NO_MEMORY, "results %s: out of memory", r->path);
    if (status == TOBI_OK)
        status = e->ascii ? read_ascii(r, e, numbers, count, err) : read_bytes(r, e, raw, bytes, err);
    for (size_t k = 0; status == TOBI_OK && !e->ascii && k < count; k++) numbers[k] = number_at(raw,
            e->type, k);
    free(raw);
    if (status == TOBI_OK) *out = numbers;
    else free(numbers);
    return status;
}

static tobi_status add_field(const reader *r, const element *e, tobi_moment *m, tobi_error *err)
{
    const size_t count = (size_t)m->field_count + 1;
    tobi_moment_field *fields = reallocarray(m->fields, count, sizeof *fields);
    if (!fields) return tobi_fail(err, TOBI_NO_MEMORY, "results %s: out of memory", r->path);
    m->fields = fields;
    tobi_moment_field *f = &fields[m->field_count];
    *f = (tobi_moment_field){ .name = strdup(e->name), .components = e->components };
    m->field_count++;
    if (!f->name) return tobi_fail(err, TOBI_NO_MEMORY, "results %s: out of memory", r->path);
    return read_numbers(r, e, m->count, &f->values, err);
}

static tobi_status read_points(const reader *r, const element *e, double (**points)[3], tobi_error *err)
{
    double *numbers;
    if (e->components != 3 || *points) return fail_damaged(r, tr("has points that are none"), err);
    TOBI_TRY(read_numbers(r, e, r->points, &numbers, err));
    *points = (double (*)[3])(void *)numbers;
    return TOBI_OK;
}

static tobi_status read_particles(const reader *r, tobi_moment *m, tobi_error *err)
{
    const char *at = r->text;
    element e = { .section = "" };
    m->count = r->points;
    while (next_element(r, &at, &e)) {
        if (strcmp(e.section, "Points") == 0) TOBI_TRY(read_points(r, &e, &m->positions, err));
        if (strcmp(e.section, "PointData") == 0) TOBI_TRY(add_field(r, &e, m, err));
    }
    return m->positions ? TOBI_OK : fail_damaged(r, tr("has no points"), err);
}

tobi_status tobi_vtu_read(const char *path, tobi_moment *moment, tobi_error *err)
{
    reader r;
    tobi_status status = open_reader(&r, path, err);
    if (status == TOBI_OK) status = read_particles(&r, moment, err);
    free(r.text);
    return status;
}

static tobi_status read_triangles(const reader *r, const element *e, tobi_moment_surface *s, tobi_error *err)
{
    double *numbers;
    if (s->triangles || r->polygons < 0 || r->polygons > INT64_MAX/3 || e->components != 1)
        return fail_damaged(r, tr("has triangles that are none"), err);
    TOBI_TRY(read_numbers(r, e, 3*r->polygons, &numbers, err));
    s->triangles = malloc(((size_t)r->polygons + 1)*sizeof *s->triangles);
    if (!s->triangles) {
        free(numbers);
        return tobi_fail(err, TOBI_NO_MEMORY, "results %s: out of memory", r->path);
    }
    int good = 1;
    for (int64_t k = 0; k < 3*r->polygons; k++) {
        const int fits = numbers[k] >= 0 && numbers[k] < (double)r->points;
        good = good && fits;
        s->triangles[k/3][k%3] = fits ? (int32_t)numbers[k] : 0;
    }
    free(numbers);
    s->triangle_count = r->polygons;
    return good ? TOBI_OK : fail_damaged(r, tr("has a triangle of vertices that are none"), err);
}

static tobi_status read_surface(const reader *r, tobi_moment_surface *s, tobi_error *err)
{
    const char *at = r->text;
    element e = { .section = "" };
    s->vertex_count = r->points;
    while (next_element(r, &at, &e)) {
        if (strcmp(e.section, "Points") == 0) TOBI_TRY(read_points(r, &e, &s->vertices, err));
        if (strcmp(e.section, "Polys") == 0 && strcmp(e.name, "connectivity") == 0)
            TOBI_TRY(read_triangles(r, &e, s, err));
    }
    return s->vertices && s->triangles ? TOBI_OK : fail_damaged(r, tr("has no surface"), err);
}

tobi_status tobi_vtp_read(const char *path, tobi_moment_surface *surface, tobi_error *err)
{
    reader r;
    tobi_status status = open_reader(&r, path, err);
    if (status == TOBI_OK) status = read_surface(&r, surface, err);
    free(r.text);
    return status;
}
