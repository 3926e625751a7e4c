/* Binary STL read whole, PLY headers read before the importer sees them.

   Single precision in a file stands for the decimal that somebody wrote: see tobi_shortest_decimal. */
#define _POSIX_C_SOURCE 200809L
#include "geom/file_checks.h"
#include "base/plain.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { STL_HEAD = 84, STL_ROW = 50, ROWS = 4096 };
#define PLY_HEADER_LIMIT 1000000     /* bytes */

static double shortest_by_text(float x)
{
    char text[32];
    for (int digits = 6; digits < 9; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, (double)x);
        if (strtof(text, NULL) == x) return strtod(text, NULL);
    }
    return x;
}

double tobi_shortest_decimal(float x)
{
    /* powers of ten and whole numbers below 2^53 are exact, so their quotient is the nearest double to
       the decimal, as strtod would have it */
    static const double ten[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    if (x == 0 || !isfinite(x)) return x;
    int exponent = (int)floor(log10(fabs((double)x)));
    if (exponent < -14 || exponent > 14) return shortest_by_text(x);
    for (int digits = 6; digits < 9; digits++) {
        int shift = digits - 1 - exponent;
        double near = shift >= 0 ? nearbyint((double)x*ten[shift])/ten[shift]
                                 : nearbyint((double)x/ten[-shift])*ten[-shift];
        if ((float)near == x) return near;
    }
    return x;
}

/* --- STL ---------------------------------------------------------------------------------- */

static uint32_t read_u32(const unsigned char *b)
{
    return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

static void place_rows(tobi_mesh *m, int64_t first, int64_t rows, const unsigned char *data)
{
    for (int64_t r = 0; r < rows; r++)
        for (int c = 0; c < 3; c++) {
            int64_t vertex = 3*(first + r) + c;
            for (int k = 0; k < 3; k++) {
                uint32_t bits = read_u32(data + STL_ROW*r + 12*(c + 1) + 4*k);
                float x;
                memcpy(&x, &bits, sizeof x);
                m->vertices[vertex][k] = tobi_shortest_decimal(x);
            }
            m->triangles[first + r][c] = (int32_t)vertex;
        }
}

static tobi_status read_rows(FILE *f, const char *path, int64_t n, tobi_mesh *out, tobi_error *err)
{
    unsigned char *data = malloc((size_t)ROWS*STL_ROW);
    tobi_mesh m = {.vertex_count = 3*n, .triangle_count = n};
    m.vertices = malloc((size_t)(3*n + 1)*sizeof *m.vertices);
    m.triangles = malloc((size_t)(n + 1)*sizeof *m.triangles);
    tobi_status status = TOBI_OK;
    if (!data || !m.vertices || !m.triangles)
        status = tobi_fail(err, TOBI_NO_MEMORY, "mesh '%s': no memory for %lld triangles", path,
                           (long long)n);
    for (int64_t first = 0; status == TOBI_OK && first < n; first += ROWS) {
        int64_t rows = n - first < ROWS ? n - first : ROWS;
        if (fread(data, STL_ROW, (size_t)rows, f) == (size_t)rows) place_rows(&m, first, rows, data);
        else status = tobi_fail(err, TOBI_IO, "mesh '%s' cannot be read to its end", path);
    }
    free(data);
    if (status == TOBI_OK) *out = m;
    else tobi_mesh_free(&m);
    return status;
}

/* Of a file that is no text: those begin with "solid", though some binary ones do, too. */
static tobi_status refuse_count(const char *path, const unsigned char *head, int64_t size, tobi_error *err)
{
    const int64_t count = read_u32(head + 80), most = (size - STL_HEAD)/STL_ROW;
    if (memcmp(head, "solid", 5) == 0 || !memchr(head, 0, STL_HEAD)) return TOBI_OK;
    return tobi_fail(err, TOBI_INVALID, "mesh '%s': a binary STL of %lld triangles has %lld bytes, this file "
                     "has %lld, room for %lld: it is cut off or its count is wrong", path, (long long)count,
                     (long long)(count*STL_ROW + STL_HEAD), (long long)size, (long long)most);
}

int tobi_stl_read_binary(const char *path, int64_t size, tobi_mesh *out, tobi_status *status,
                         tobi_error *err)
{
    unsigned char head[STL_HEAD];
    FILE *f = NULL;
    if (size > STL_HEAD) tobi_plain_open(path, tr("mesh"), 0, &f, NULL, NULL);
    const int whole = f && fread(head, 1, sizeof head, f) == sizeof head;
    const int mine = whole && (int64_t)read_u32(head + 80)*STL_ROW + STL_HEAD == size;
    *status = TOBI_OK;
    if (mine) *status = read_rows(f, path, (size - STL_HEAD)/STL_ROW, out, err);
    else if (whole) *status = refuse_count(path, head, size, err);
    if (f) fclose(f);
    return *status != TOBI_OK ? -1 : mine;
}

/* --- PLY ---------------------------------------------------------------------------------- */

typedef struct ply_header {
    int ascii, line;              /* format; present line                        */
    double vertices, faces;       /* counts, -1 = not named                      */
    double bytes;                 /* least that the rows need                    */
    double rows, row_bytes;       /* of the element in work                      */
} ply_header;

static int size_of_type(const char *name)
{
    static const struct { const char *name; int size; } types[] = {
        {"char", 1}, {"uchar", 1}, {"int8", 1}, {"uint8", 1}, {"short", 2}, {"ushort", 2},
        {"int16", 2}, {"uint16", 2}, {"int", 4}, {"uint", 4}, {"int32", 4}, {"uint32", 4},
        {"float", 4}, {"float32", 4}, {"double", 8}, {"float64", 8}};
    for (size_t i = 0; name && i < sizeof types/sizeof *types; i++)
        if (strcmp(name, types[i].name) == 0) return types[i].size;
    return 0;
}

static void end_element(ply_header *h)
{
    h->bytes += h->rows*h->row_bytes;
    h->rows = h->row_bytes = 0;
}

/* One header line in words; NULL when it is fine. */
static const char *read_word_line(ply_header *h, char *line)
{
    char *rest = NULL, *word[6] = {0};
    int n = 0;
    for (char *w = strtok_r(line, " \t\r\n", &rest); w && n < 6; w = strtok_r(NULL, " \t\r\n", &rest))
        word[n++] = w;
    if (n == 0 || !strcmp(word[0], "comment") || !strcmp(word[0], "obj_info")) return NULL;
    if (!strcmp(word[0], "format")) {
        h->ascii = n > 1 && !strcmp(word[1], "ascii");
        if (n > 1 && (h->ascii || !strcmp(word[1], "binary_little_endian") ||
                      !strcmp(word[1], "binary_big_endian"))) return NULL;
        return tr("allowed formats are ascii, binary_little_endian and binary_big_endian");
    }
    if (!strcmp(word[0], "element")) {
        char *end = NULL;
        end_element(h);
        h->rows = n > 2 ? strtod(word[2], &end) : -1;
        if (n < 3 || *end || !(h->rows >= 0 && h->rows <= 1e12) || h->rows != floor(h->rows))
            return tr("an element needs a name and a whole number of rows");
        if (!strcmp(word[1], "vertex")) h->vertices = h->rows;
        if (!strcmp(word[1], "face")) h->faces = h->rows;
        return NULL;
    }
    if (!strcmp(word[0], "property")) {
        int list = n > 1 && !strcmp(word[1], "list"), size = n > 1 ? size_of_type(word[list ? 2 : 1]) : 0;
        if (n != (list ? 5 : 3) || !size || (list && !size_of_type(word[3])))
            return tr("a property needs a type and a name, or list, two types and a name");
        h->row_bytes += h->ascii ? 2 : size;
        return NULL;
    }
    return tr("a header holds format, comment, obj_info, element and property lines");
}

static tobi_status judge_header(const char *path, const ply_header *h, double left, tobi_error *err)
{
    if (!(h->vertices > 0) || !(h->faces > 0))
        return tobi_fail(err, TOBI_INVALID, "mesh '%s' has no %s; its header must name both vertex and face "
                         "elements", path, h->vertices > 0 ? tr("faces") : tr("vertices"));
    /* the last row of a text file may lack its newline */
    if (h->bytes <= left + 1) return TOBI_OK;
    return tobi_fail(err, TOBI_INVALID, "mesh '%s' claims %.0f vertices and %.0f faces, at least %.0f bytes; "
                     "after the header there are %.0f", path, h->vertices, h->faces, h->bytes, left);
}

static tobi_status read_header(FILE *f, const char *path, int64_t size, char *line, tobi_error *err)
{
    enum { ROOM = 1000 };
    ply_header h = {.vertices = -1, .faces = -1};
    while (fgets(line, ROOM, f)) {
        size_t length = strlen(line);
        h.line++;
        if (h.line == 1 && strcmp(line, "ply\n") && strcmp(line, "ply\r\n"))
            return tobi_fail(err, TOBI_INVALID, "mesh '%s' does not begin with the line ply", path);
        if (h.line == 1) continue;
        if (!length || line[length - 1] != '\n' || ftell(f) > PLY_HEADER_LIMIT) break;
        if (!strcmp(line, "end_header\n") || !strcmp(line, "end_header\r\n")) {
            end_element(&h);
            return judge_header(path, &h, (double)size - (double)ftell(f), err);
        }
        const char *fault = read_word_line(&h, line);
        if (fault)
            return tobi_fail(err, TOBI_INVALID, "mesh '%s', line %d of the header: %s", path, h.line, fault);
    }
    return tobi_fail(err, TOBI_INVALID, "mesh '%s': the header has no end_header line (it breaks off in line "
                     "%d)", path, h.line);
}

tobi_status tobi_ply_check(const char *path, int64_t size, tobi_error *err)
{
    FILE *f;
    char line[1000];
    TOBI_TRY(tobi_plain_open(path, tr("mesh"), 0, &f, NULL, err));
    tobi_status status = read_header(f, path, size, line, err);
    fclose(f);
    return status;
}
