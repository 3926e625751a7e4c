/* Surfaces as one glTF 2.0 file: a JSON part, then a binary part (Khronos Group, glTF 2.0 Specification).
   Each frame is a node with a mesh of its own. Players cannot switch nodes on and off by time,
       but all of them
   play scales with steps: 1 in a frame's time, 0 before and after it. The binary part is written as frames
   come; the JSON part has its room before it, filled with blanks as the format allows, and is written at the
   end. Drawback: positions are floats, measured from the middle of the first frame. */
#define _GNU_SOURCE 1
#include "base/file.h"
#include "io/surface_files.h"
#include "tobiuo/surface.h"
#include <assert.h>
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <png.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { IMAGES = 16, CLASSES = 2 + IMAGES };        /* triangles: opaque, clear, with the first image ... */
enum { OPAQUE, CLEAR, SKIN };
enum { FRAME_ROOM = 2900 + 260*IMAGES, HEAD_ROOM = 2800 + 400*IMAGES };
/* of GLB and glTF */
enum { MAGIC = 0x46546c67, JSON_PART = 0x4e4f534a, BINARY_PART = 0x004e4942,
       FLOAT_NUMBERS = 5126, WORD_NUMBERS = 5125, BYTE_NUMBERS = 5121, VERTEX_DATA = 34962,
           INDEX_DATA = 34963 };

typedef struct frame {
    double time;
    int64_t vertices, triangles, of_class[CLASSES];
    int coordinates;             /* 1: vertices have a place in an image */
    uint64_t at;                 /* of its bytes in the binary part */
    float low[3], high[3];
} frame;

struct tobi_surface_movie {
    tobi_file file;
    char *path;
    frame *frame;
    int count, room;
    double up[3], middle[3];
    uint64_t bytes;              /* of the binary part so far */
    tobi_image *image[IMAGES];   /* owned */
    int images;
    uint64_t image_at[IMAGES], image_bytes[IMAGES];
    char *text;                  /* of the JSON part */
    size_t length, limit;
};

static uint64_t json_room(int frames) { return ((uint64_t)frames*FRAME_ROOM + HEAD_ROOM + 3)/4*4; }

tobi_status tobi_surface_movie_create(const char *path, int frames, const double up[3],
                                      tobi_surface_movie **movie, tobi_error *err)
{
    TOBI_NEED(movie, "movie");
    *movie = NULL;
    TOBI_NEED(path, "path");
    TOBI_NEED(up, "up");
    if (frames < 1 || frames > 100000)
        return tobi_fail(err, TOBI_INVALID, "%s: a movie of %d frames, allowed are 1 to 100000", path,
                         frames);
    const double size = sqrt(up[0]*up[0] + up[1]*up[1] + up[2]*up[2]);
    if (!(size > 0) || !isfinite(size))
        return tobi_fail(err, TOBI_INVALID, "%s: the direction upwards is %g %g %g", path, up[0], up[1],
                         up[2]);
    tobi_surface_movie *m = calloc(1, sizeof *m);
    if (!m) return tobi_fail(err, TOBI_NO_MEMORY, "%s: out of memory", path);
    m->room = frames;
    for (int a = 0; a < 3; a++) m->up[a] = up[a]/size;
    m->path = strdup(path);
    m->frame = calloc((size_t)frames, sizeof *m->frame);
    m->limit = json_room(frames);
    m->text = malloc(m->limit + 1);
    tobi_status status = m->path && m->frame && m->text
        ? TOBI_OK : tobi_fail(err, TOBI_NO_MEMORY, "%s: out of memory", path);
    if (status == TOBI_OK) status = tobi_file_open(&m->file, path, err);
    if (status != TOBI_OK) {
        tobi_surface_movie_free(m);
        return status;
    }
    memset(m->text, ' ', m->limit);
    const uint32_t head[5] = { MAGIC, 2, 0, (uint32_t)m->limit, JSON_PART };
    tobi_file_write(&m->file, head, sizeof head);
    tobi_file_write(&m->file, m->text, m->limit);
    tobi_file_write(&m->file, (const uint32_t[2]){ 0, BINARY_PART }, 8);
    *movie = m;
    return TOBI_OK;
}

void tobi_surface_movie_free(tobi_surface_movie *m)
{
    if (!m) return;
    tobi_file_abandon(&m->file);
    for (int k = 0; k < m->images; k++) tobi_image_free(m->image[k]);
    free(m->path);
    free(m->frame);
    free(m->text);
    free(m);
}

static float to_linear(float s) { return s <= 0.04045f ? s/12.92f : powf((s + 0.055f)/1.055f, 2.4f); }

/* Linear RGB and opacity: of a field dark blue, blue, white; without one the surface's own colours, or those
   of groups one after the other. */
static void find_color(const tobi_surface *s, int64_t i, int field, double low, double high, uint8_t out[4])
{
    static const float ramp[4][3] = {
        { 0.005f, 0.03f, 0.12f }, { 0.01f, 0.14f, 0.45f }, { 0.10f, 0.55f, 0.85f }, { 0.95f, 0.97f, 1.0f } };
    static const float group[6][3] = {
        { 0.02f, 0.20f, 0.50f }, { 0.62f, 0.10f, 0.05f }, { 0.85f, 0.75f, 0.45f },
        { 0.10f, 0.35f, 0.10f }, { 0.60f, 0.30f, 0.03f }, { 0.25f, 0.12f, 0.40f } };
    const float *color = group[s->group[i]%6], *own = field < 0 ? tobi_surface_colors(s) : NULL;
    float mixed[3], opacity = own ? fminf(1, fmaxf(0, own[4*i + 3])) : 1;
    for (int c = 0; own && c < 3; c++) mixed[c] = to_linear(fminf(1, fmaxf(0, own[4*i + c])));
    if (own) color = mixed;
    if (field >= 0) {
        const int n = s->field_components[field];
        double square = 0, value = s->fields[field][i*n];
        for (int c = 0; c < n; c++) square += pow((double)s->fields[field][i*n + c], 2);
        if (n > 1) value = sqrt(square);
        const double share = high > low ? fmin(1, fmax(0, (value - low)/(high - low))) : 0;
        const int k = share < 1 ? (int)(3*share) : 2;
        const float part = (float)(3*share - k);
        for (int c = 0; c < 3; c++) mixed[c] = ramp[k][c] + part*(ramp[k + 1][c] - ramp[k][c]);
        color = mixed;
    }
    for (int c = 0; c < 3; c++) out[c] = (uint8_t)lrintf(255*color[c]);
    out[3] = (uint8_t)lrintf(255*opacity);
}

/* The number of an image, which the movie keeps from now on; -1: it has as many as it takes. */
static int find_image(tobi_surface_movie *m, const tobi_image *image)
{
    for (int k = 0; k < m->images; k++)
        if (m->image[k] == image) return k;
    if (m->images == IMAGES) return -1;
    m->image[m->images] = tobi_image_share((tobi_image *)image);
    return m->images++;
}

/* Particles of a group are of one material, so a triangle is opaque as its first vertex is. */
static int class_of(tobi_surface_movie *m, const tobi_surface *s, int64_t triangle, int field)
{
    const int64_t first = s->triangles[triangle][0];
    const float *own = field < 0 ? tobi_surface_colors(s) : NULL;
    const int skin = s->skin && field < 0 ? s->skin[first] : -1;
    const int image = skin >= 0 ? find_image(m, s->skins[skin].image) : -1;
    return image >= 0 ? SKIN + image : !own || own[4*first + 3] > 0.99f ? OPAQUE : CLEAR;
}

static void write_triangles(tobi_surface_movie *m, frame *f, const tobi_surface *s, int field)
{
    for (int64_t t = 0; t < s->triangle_count; t++) f->of_class[class_of(m, s, t, field)]++;
    for (int c = 0; c < CLASSES; c++)
        for (int64_t t = 0; t < s->triangle_count && f->of_class[c] > 0 && !m->file.error; t++)
            if (class_of(m, s, t, field) == c)
                tobi_file_write(&m->file, s->triangles[t], sizeof *s->triangles);
}

/* glTF counts rows from the top. */
static void write_coordinates(tobi_surface_movie *m, const tobi_surface *s)
{
    for (int64_t i = 0; i < s->vertex_count && !m->file.error; i++) {
        const float uv[2] = { s->uv[i][0], 1 - s->uv[i][1] };
        tobi_file_write(&m->file, uv, sizeof uv);
    }
}

static void write_frame(tobi_surface_movie *m, frame *f, const tobi_surface *s, int field, double low,
                        double high)
{
    for (int a = 0; a < 3; a++) f->low[a] = INFINITY, f->high[a] = -INFINITY;
    for (int64_t i = 0; i < s->vertex_count && !m->file.error; i++) {
        float p[3];
        for (int a = 0; a < 3; a++) {
            p[a] = (float)(s->vertices[i][a] - m->middle[a]);
            f->low[a] = fminf(f->low[a], p[a]);
            f->high[a] = fmaxf(f->high[a], p[a]);
        }
        tobi_file_write(&m->file, p, sizeof p);
    }
    tobi_file_write(&m->file, s->normals, (size_t)s->vertex_count*sizeof *s->normals);
    for (int64_t i = 0; i < s->vertex_count && !m->file.error; i++) {
        uint8_t color[4];
        find_color(s, i, field, low, high, color);
        tobi_file_write(&m->file, color, sizeof color);
    }
    if (f->coordinates) write_coordinates(m, s);
    write_triangles(m, f, s, field);
}

static tobi_status check_frame(const tobi_surface_movie *m, double time, const tobi_surface *s, int field,
                               tobi_error *err)
{
    if (m->count == m->room)
        return tobi_fail(err, TOBI_INVALID, "%s: more than the %d frames that were announced", m->path,
                         m->room);
    if (!isfinite(time) || (m->count > 0 && !(time > m->frame[m->count - 1].time)))
        return tobi_fail(err, TOBI_INVALID, "%s: frame %d is at %g s, not after the one before it", m->path,
                         m->count,
                         time);
    if (field < -1 || field >= s->field_count)
        return tobi_fail(err, TOBI_INVALID, "%s: the surface has no field %d, but %d", m->path, field,
                         s->field_count);
    const uint64_t bytes = m->bytes + (uint64_t)s->vertex_count*36 + (uint64_t)s->triangle_count*12;
    if (bytes + m->limit + 28 > UINT32_MAX)
        return tobi_fail(err, TOBI_INVALID,
                         "%s: more than 4 GB at %g s, which a .glb cannot hold; a larger cell "
                         "or fewer frames take less", m->path, time);
    return TOBI_OK;
}

tobi_status tobi_surface_movie_add(tobi_surface_movie *m, double time, const tobi_surface *s, int field,
                                   double low, double high, tobi_error *err)
{
    TOBI_NEED(m, "movie");
    TOBI_NEED(s, "surface");
    TOBI_TRY(check_frame(m, time, s, field, err));
    for (int a = 0; a < 3 && m->bytes == 0 && s->vertex_count > 0; a++) m->middle[a] = s->vertices[0][a];
    frame *f = &m->frame[m->count++];
    *f = (frame){ .time = time, .vertices = s->vertex_count, .triangles = s->triangle_count, .at = m->bytes,
                  .coordinates = s->uv && field < 0 && s->triangle_count > 0 };
    write_frame(m, f, s, field, low, high);
    m->bytes += (uint64_t)s->vertex_count*(f->coordinates ? 36 : 28) + (uint64_t)s->triangle_count*12;
    return TOBI_OK;
}

/* Adds to the JSON part; what has no room is seen at the end. */
static void put(tobi_surface_movie *m, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void put(tobi_surface_movie *m, const char *format, ...)
{
    char line[700];
    va_list arguments;
    const locale_t before = uselocale(m->file.plain);
    va_start(arguments, format);
    const int n = vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    uselocale(before);
    if (n > 0 && n < (int)sizeof line && m->length + (size_t)n <= m->limit)
        memcpy(m->text + m->length, line, (size_t)n);
    m->length += (size_t)n;
}

static bool is_empty(const frame *f) { return f->triangles == 0; }

/* Positions, normals, colours, places in images; triangles by class. */
static int count_views(const frame *f) { return is_empty(f) ? 0 : 4 + f->coordinates; }

static int count_accessors(const frame *f)
{
    int n = count_views(f) - 1;
    for (int c = 0; c < CLASSES && !is_empty(f); c++) n += f->of_class[c] > 0;
    return is_empty(f) ? 0 : n;
}

/* Turns up to y, and moves the frames back to where they are. */
static void put_root(tobi_surface_movie *m)
{
    const double *u = m->up, *p = m->middle;
    double q[4] = { -u[2], 0, u[0], 1 + u[1] };       /* up x y, and 1 + up . y */
    const double size = sqrt(q[0]*q[0] + q[2]*q[2] + q[3]*q[3]);
    if (size < 1e-9) q[0] = 1, q[3] = 0;
    else for (int k = 0; k < 4; k++) q[k] /= size;
    put(m, "{\"name\":\"run\",\"rotation\":[%.9g,%.9g,%.9g,%.9g],\"children\":[1]},"
        "{\"name\":\"place\",\"translation\":[%.9g,%.9g,%.9g],\"children\":[", q[0], q[1], q[2], q[3],
        p[0], p[1], p[2]);
    for (int k = 0; k < m->count; k++) put(m, "%s%d", k ? "," : "", k + 2);
    put(m, "]}");
}

static void put_nodes(tobi_surface_movie *m)
{
    int mesh = 0;
    put_root(m);
    for (int k = 0; k < m->count; k++) {
        const char *scale = k == 0 ? "" : ",\"scale\":[0,0,0]";
        if (is_empty(&m->frame[k])) put(m, ",{\"name\":\"frame_%06d\"%s}", k, scale);
        else put(m, ",{\"name\":\"frame_%06d\",\"mesh\":%d%s}", k, mesh++, scale);
    }
}

static void put_meshes(tobi_surface_movie *m)
{
    int n = 0;
    for (int k = 0; k < m->count; k++) {
        const frame *f = &m->frame[k];
        if (is_empty(f)) continue;
        put(m, "%s{\"name\":\"surface_%06d\",\"primitives\":[", n ? "," : "", k);
        const int first = count_views(f) - 1;
        for (int c = 0, i = first; c < CLASSES; c++) {
            if (f->of_class[c] == 0) continue;
            put(m, "%s{\"attributes\":{\"POSITION\":%d,\"NORMAL\":%d,\"COLOR_0\":%d", i > first ? "," : "", n,
                n + 1, n + 2);
            if (f->coordinates) put(m, ",\"TEXCOORD_0\":%d", n + 3);
            put(m, "},\"indices\":%d,\"material\":%d}", n + i++, c);
        }
        put(m, "]}");
        n += count_accessors(f);
    }
}

static void put_indices(tobi_surface_movie *m, int view, int64_t first, int64_t count)
{
    if (count == 0) return;
    put(m, ",{\"bufferView\":%d,\"byteOffset\":%" PRId64 ",\"componentType\":%d,\"count\":%" PRId64
        ",\"type\":\"SCALAR\"}", view, 12*first, WORD_NUMBERS, 3*count);
}

static void put_accessors(tobi_surface_movie *m)
{
    int n = 0;       /* views */
    for (int k = 0; k < m->count; k++) {
        const frame *f = &m->frame[k];
        if (is_empty(f)) continue;
        put(m, "%s{\"bufferView\":%d,\"componentType\":%d,\"count\":%" PRId64 ",\"type\":\"VEC3\","
            "\"min\":[%.9g,%.9g,%.9g],\"max\":[%.9g,%.9g,%.9g]}", n ? "," : "", n, FLOAT_NUMBERS, f->vertices,
            (double)f->low[0], (double)f->low[1], (double)f->low[2], (double)f->high[0], (double)f->high[1],
            (double)f->high[2]);
        put(m, ",{\"bufferView\":%d,\"componentType\":%d,\"count\":%" PRId64 ",\"type\":\"VEC3\"}", n + 1,
            FLOAT_NUMBERS, f->vertices);
        put(m, ",{\"bufferView\":%d,\"componentType\":%d,\"normalized\":true,\"count\":%" PRId64
            ",\"type\":\"VEC4\"}", n + 2, BYTE_NUMBERS, f->vertices);
        if (f->coordinates)
            put(m, ",{\"bufferView\":%d,\"componentType\":%d,\"count\":%" PRId64 ",\"type\":\"VEC2\"}", n + 3,
                FLOAT_NUMBERS, f->vertices);
        n += count_views(f);
        int64_t first = 0;
        for (int c = 0; c < CLASSES; first += f->of_class[c++]) put_indices(m, n - 1, first, f->of_class[c]);
    }
}

/* The views of each frame; behind them the times and scales of the animation. */
static void put_views(tobi_surface_movie *m)
{
    int n = 0;
    for (int k = 0; k < m->count; k++) {
        const frame *f = &m->frame[k];
        const uint64_t v = (uint64_t)f->vertices, indices = 12*(uint64_t)f->triangles;
        const uint64_t size[5] = { 12*v, 12*v, 4*v, f->coordinates ? 8*v : indices, indices };
        uint64_t at = f->at;
        for (int q = 0; q < count_views(f); q++, n++) {
            put(m, "%s{\"buffer\":0,\"byteOffset\":%" PRIu64 ",\"byteLength\":%" PRIu64 ",\"target\":%d}",
                n ? "," : "", at, size[q], q == count_views(f) - 1 ? INDEX_DATA : VERTEX_DATA);
            at += size[q];
        }
    }
}

/* Times and scales of a frame: shown from its own time to that of the next. */
static int list_keys(const tobi_surface_movie *m, int k, float time[3], float scale[3][3])
{
    const double first = m->frame[0].time, last = m->frame[m->count - 1].time;
    const double step = m->count > 1 ? (last - first)/(m->count - 1) : 1;
    const double begin = m->frame[k].time - first;
    const double end = k + 1 < m->count ? m->frame[k + 1].time - first : begin + step;
    int n = 0;
    if (k > 0) time[n++] = 0;
    time[n++] = (float)begin;
    time[n++] = (float)end;
    for (int q = 0; q < n; q++)
        for (int a = 0; a < 3; a++) scale[q][a] = q == n - 2 || (k + 1 == m->count && q == n - 1) ? 1 : 0;
    return n;
}

static void put_animation(tobi_surface_movie *m, int accessors)
{
    put(m, "],\"animations\":[{\"name\":\"frames\",\"channels\":[");
    for (int k = 0; k < m->count; k++)
        put(m, "%s{\"sampler\":%d,\"target\":{\"node\":%d,\"path\":\"scale\"}}", k ? "," : "", k, k + 2);
    put(m, "],\"samplers\":[");
    for (int k = 0; k < m->count; k++)
        put(m, "%s{\"input\":%d,\"output\":%d,\"interpolation\":\"STEP\"}", k ? "," : "", accessors + 2*k,
            accessors + 2*k + 1);
    put(m, "]}");
}

static void write_animation(tobi_surface_movie *m, int accessors, int views)
{
    uint64_t at = m->bytes;
    for (int k = 0; k < m->count; k++) {
        float time[3], scale[3][3];
        const int n = list_keys(m, k, time, scale);
        tobi_file_write(&m->file, time, (size_t)n*sizeof *time);
        tobi_file_write(&m->file, scale, (size_t)n*sizeof *scale);
        put(m, "%s{\"bufferView\":%d,\"componentType\":%d,\"count\":%d,\"type\":\"SCALAR\",\"min\":[%.9g],"
            "\"max\":[%.9g]},{\"bufferView\":%d,\"componentType\":%d,\"count\":%d,\"type\":\"VEC3\"}",
            accessors + k ? "," : "", views + 2*k, FLOAT_NUMBERS, n, (double)time[0], (double)time[n - 1],
            views + 2*k + 1, FLOAT_NUMBERS, n);
        m->bytes += (uint64_t)n*16;
    }
    put(m, "],\"bufferViews\":[");
    put_views(m);
    for (int k = 0; k < m->count; k++) {
        const uint64_t n = k > 0 ? 3 : 2;
        put(m, "%s{\"buffer\":0,\"byteOffset\":%" PRIu64 ",\"byteLength\":%" PRIu64 "},{\"buffer\":0,"
            "\"byteOffset\":%" PRIu64 ",\"byteLength\":%" PRIu64 "}", accessors + k ? "," : "", at, 4*n,
            at + 4*n, 12*n);
        at += 16*n;
    }
    for (int k = 0; k < m->images; k++)
        put(m, ",{\"buffer\":0,\"byteOffset\":%" PRIu64 ",\"byteLength\":%" PRIu64 "}", m->image_at[k],
            m->image_bytes[k]);
}

/* PNG files, in whole words. */
static tobi_status write_images(tobi_surface_movie *m, tobi_error *err)
{
    for (int k = 0; k < m->images; k++) {
        png_image png = { .version = PNG_IMAGE_VERSION, .format = PNG_FORMAT_RGB };
        const uint8_t *rgb;
        int width, height;
        tobi_image_size(m->image[k], &width, &height, &rgb);
        png.width = (png_uint_32)width, png.height = (png_uint_32)height;
        png_alloc_size_t bytes = PNG_IMAGE_PNG_SIZE_MAX(png), padded;
        uint8_t *data = calloc(bytes + 4, 1);
        const int good = data && png_image_write_to_memory(&png, data, &bytes, 0, rgb, 0, NULL);
        padded = (bytes + 3)/4*4;
        m->image_at[k] = m->bytes, m->image_bytes[k] = bytes;
        if (good) tobi_file_write(&m->file, data, padded);
        free(data);
        if (!good) return tobi_fail(err, TOBI_NO_MEMORY, "%s: no memory for an image", m->path);
        m->bytes += padded;
        if (m->bytes + m->limit + 28 > UINT32_MAX) m->file.error = EFBIG;
    }
    return TOBI_OK;
}

static void put_images(tobi_surface_movie *m, int views)
{
    if (m->images == 0) return;
    put(m, ",\"images\":[");
    for (int k = 0; k < m->images; k++)
        put(m, "%s{\"bufferView\":%d,\"mimeType\":\"image/png\"}", k ? "," : "", views + k);
    put(m, "],\"textures\":[");
    for (int k = 0; k < m->images; k++) put(m, "%s{\"source\":%d}", k ? "," : "", k);
    put(m, "]");
}

tobi_status tobi_surface_movie_finish(tobi_surface_movie *m, tobi_error *err)
{
    TOBI_NEED(m, "movie");
    if (m->count == 0) return tobi_fail(err, TOBI_INVALID, "%s: a movie without a frame", m->path);
    int accessors = 0, views = 0;
    TOBI_TRY(write_images(m, err));
    for (int k = 0; k < m->count; k++) {
        accessors += count_accessors(&m->frame[k]);
        views += count_views(&m->frame[k]);
    }
    put(m, "{\"asset\":{\"version\":\"2.0\",\"generator\":\"tobiuo %s\"},\"scene\":0,"
        "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[", TOBI_VERSION);
    put_nodes(m);
    put(m, "],\"materials\":[{\"name\":\"surface\",\"pbrMetallicRoughness\":{\"metallicFactor\":0,"
        "\"roughnessFactor\":0.15}},{\"name\":\"liquid\",\"alphaMode\":\"BLEND\","
        "\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0.05}}");
    for (int k = 0; k < m->images; k++)
        put(m, ",{\"name\":\"skin_%d\",\"pbrMetallicRoughness\":{\"metallicFactor\":0,"
            "\"roughnessFactor\":0.4,\"baseColorTexture\":{\"index\":%d}}}", k, k);
    put(m, "]");
    put_images(m, views + 2*m->count);
    if (accessors > 0) {
        put(m, ",\"meshes\":[");
        put_meshes(m);
        put(m, "]");
    }
    put(m, ",\"accessors\":[");
    put_accessors(m);
    write_animation(m, accessors, views);
    put_animation(m, accessors);
    put(m, "],\"buffers\":[{\"byteLength\":%" PRIu64 "}]}", m->bytes);
    assert(m->length <= m->limit);                   /* FRAME_ROOM is enough */
    if (m->length > m->limit) m->file.error = EFBIG;
    tobi_file_patch(&m->file, 8, &(uint32_t){ (uint32_t)(28 + m->limit + m->bytes) }, 4);
    tobi_file_patch(&m->file, 20, m->text, m->limit);
    tobi_file_patch(&m->file, (off_t)(20 + m->limit), &(uint32_t){ (uint32_t)m->bytes }, 4);
    return tobi_file_commit(&m->file, err);
}
