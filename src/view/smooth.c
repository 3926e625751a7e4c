/* The surface that particles were splatted into becomes smooth: its depth, thickness and value, filtered in
   screen space. Only the patch of the picture that has a surface is looked at. */
#include "view/draw.h"
#include <stdlib.h>
#include <string.h>

enum { REACH_MAX = 40 };     /* samples, of the filters to one side; blurs of value reach up to 60 */

/* One row of the narrow-range filter. Neighbours in front by more than `narrow` are other water and do not
   count (nor does their mirror image, so that slopes stay); those behind count as `narrow` behind. */
static void smooth_row(const float *in, float *out, int n, float reach_at_1m, bool flat, float narrow,
                       float (*gauss)[REACH_MAX + 1])
{
    for (int x = 0; x < n; x++) {
        float z = in[x];
        out[x] = z;
        if (!(z < INFINITY)) continue;
        int reach = (int)(flat ? reach_at_1m : reach_at_1m/z);
        if (reach > REACH_MAX) reach = REACH_MAX;
        if (reach > x) reach = x;
        if (reach > n - 1 - x) reach = n - 1 - x;
        const float *g = gauss[reach];
        float sum = 0, weight = 1;
        for (int k = 1; k <= reach; k++) {
            float l = in[x - k] - z, r = in[x + k] - z;
            float w = l < -narrow || r < -narrow ? 0 : g[k];
            sum += w*((l > narrow ? narrow : l) + (r > narrow ? narrow : r));
            weight += 2*w;
        }
        out[x] = z + sum/weight;
    }
}

static void blur_row(const float *in, float *out, int n, int reach)
{
    double sum = 0;
    for (int x = -reach; x < n; x++) {
        if (x + reach < n) sum += in[x + reach];
        if (x - reach - 1 >= 0) sum -= in[x - reach - 1];
        if (x >= 0) out[x] = (float)(sum/(2*reach + 1));
    }
}

/* A plane of samples and what becomes of it. */
typedef struct plane { const float *in; float *out; int width, height; } plane;

enum { STRIP = 32 };         /* rows */

static void transpose_strips(const void *view, int64_t begin, int64_t end)
{
    const plane *p = view;
    const int width = p->width, height = p->height;
    for (int y0 = (int)begin*STRIP; y0 < end*STRIP && y0 < height; y0 += STRIP)
        for (int x0 = 0; x0 < width; x0 += STRIP)
            for (int y = y0; y < y0 + STRIP && y < height; y++)
                for (int x = x0; x < x0 + STRIP && x < width; x++)
                    p->out[(size_t)x*(size_t)height + (size_t)y] = p->in[(size_t)y*(size_t)width + (size_t)x];
}

static void transpose(const float *in, float *out, int width, int height)
{
    const plane view = { in, out, width, height };
    tobi_loop(0, (height + STRIP - 1)/STRIP, 0, transpose_strips, &view);
}

typedef struct filter {
    float reach;             /* samples at 1 m, or anywhere if flat; of a blur: samples */
    float narrow;            /* m; 0 = plain blur                                       */
    bool  flat;
    float gauss[REACH_MAX + 1][REACH_MAX + 1];
} filter;

typedef struct filtering { filter *f; plane p; } filtering;

static void filter_range(const void *view, int64_t begin, int64_t end)
{
    const filtering *v = view;
    filter *f = v->f;
    for (int64_t y = begin; y < end; y++) {
        const float *in = v->p.in + y*v->p.width;
        float *out = v->p.out + y*v->p.width;
        if (f->narrow > 0) smooth_row(in, out, v->p.width, f->reach, f->flat, f->narrow, f->gauss);
        else blur_row(in, out, v->p.width, (int)f->reach);
    }
}

static void filter_rows(filter *f, const float *in, float *out, int width, int height)
{
    const filtering view = { f, { in, out, width, height } };
    tobi_loop(0, height, 16, filter_range, &view);
}

typedef struct copying { const patch *p; float *plane; int pitch; float *packed; bool back; } copying;

static void copy_rows(const void *view, int64_t begin, int64_t end)
{
    const copying *c = view;
    const patch *p = c->p;
    for (int64_t y = begin; y < end; y++) {
        float *there = c->plane + (p->y + y)*c->pitch + p->x, *here = c->packed + y*p->width;
        memcpy(c->back ? there : here, c->back ? here : there, (size_t)p->width*sizeof *here);
    }
}

static void copy_patch(const patch *p, float *plane, int pitch, float *packed, bool back)
{
    const copying view = { p, plane, pitch, packed, back };
    tobi_loop(0, p->height, 0, copy_rows, &view);
}

/* Rows, then columns of the patch, several times. room: two planes. */
static void filter_patch(filter *f, const canvas *c, const patch *p, float *plane, float *room, int rounds)
{
    float *data = room, *scratch = room + (size_t)p->width*(size_t)p->height;
    copy_patch(p, plane, c->width, data, false);
    for (int i = 0; i < rounds; i++) {
        filter_rows(f, data, scratch, p->width, p->height);
        transpose(scratch, data, p->width, p->height);
        filter_rows(f, data, scratch, p->height, p->width);
        transpose(scratch, data, p->height, p->width);
    }
    copy_patch(p, plane, c->width, data, true);
}

/* What the loops over the rows of a patch, from its first on, need. */
typedef struct row_view {
    const canvas *c;
    const patch *p;
    const float *in;
    float *out;
    int reach;               /* samples */
    float narrow;            /* m; of a blur: depths that differ less are one solid */
    int dx, dy;
} row_view;

static void filter_square_rows(const void *view, int64_t begin, int64_t end)
{
    const row_view *v = view;
    const canvas *c = v->c;
    const patch *p = v->p;
    const int64_t width = c->width;
    const int reach = v->reach;
    for (int y = p->y + (int)begin; y < p->y + end; y++)
        for (int x = p->x; x < p->x + p->width; x++) {
            if (y < reach || x < reach || y >= c->height - reach || x >= c->width - reach) continue;
            const float *in = v->in + y*width + x;
            float z = *in, sum = 0, weight = 0;
            if (!(z < INFINITY)) continue;
            for (int j = -reach; j <= reach; j++)
                for (int i = -reach; i <= reach; i++) {
                    float d = in[j*width + i] - z, w = fabsf(d) < v->narrow ? 1.0f : 0.0f;
                    sum += w > 0 ? d : 0;
                    weight += w;
                }
            v->out[y*width + x] = z + sum/weight;
        }
}

/* The rows-then-columns filter leaves streaks along the axes where water is ragged; a small square one
   takes them away. */
static void filter_square(const canvas *c, const patch *p, float *data, float *scratch, int reach,
                          float narrow)
{
    const int64_t width = c->width;
    const size_t begin = (size_t)p->y*(size_t)width, end = begin + (size_t)p->height*(size_t)width;
    memcpy(scratch + begin, data + begin, (end - begin)*sizeof *data);
    const row_view view = { .c = c, .p = p, .in = scratch, .out = data, .reach = reach, .narrow = narrow };
    tobi_loop(0, p->height, 16, filter_square_rows, &view);
}

static void blur_rows(const void *view, int64_t begin, int64_t end)
{
    const row_view *v = view;
    const canvas *c = v->c;
    const patch *p = v->p;
    const float *in = v->in;
    const int dx = v->dx, dy = v->dy, reach = v->reach;
    for (int y = p->y + (int)begin; y < p->y + end; y++) {
        int low = dy && y < reach ? -y : -reach;
        int high = dy && y + reach >= c->height ? c->height - 1 - y : reach;
        const float *solid = c->depth + (size_t)y*(size_t)c->width;
        for (int x = p->x; x < p->x + p->width; x++) {
            int first = dx && x < reach ? -x : low;
            int last = dx && x + reach >= c->width ? c->width - 1 - x : high;
            int64_t step = dx + (int64_t)dy*c->width, k = (int64_t)y*c->width + x;
            float sum = 0, weight = 0, here = solid[x];
            if (in[k] <= 0 && !(c->surface[k] < INFINITY)) {
                v->out[k] = 0;
                continue;
            }
            for (int i = first; i <= last; i++) {
                float there = c->depth[k + i*step];
                float w = there == here || fabsf(there - here) < v->narrow ? 1.0f : 0.0f;
                sum += w*in[k + i*step];
                weight += w;
            }
            v->out[k] = sum/weight;
        }
    }
}

/* One direction of a blur of the thickness: neighbours over another solid (or none) do not count, or bodies
   under water would glow around their edges. */
static void blur_along(const canvas *c, const patch *p, const float *in, float *out, int dx, int dy,
                       int reach, float same)
{
    const row_view view = { c, p, in, out, reach, same, dx, dy };
    tobi_loop(0, p->height, 0, blur_rows, &view);
}

static void divide_rows(const void *view, int64_t begin, int64_t end)
{
    const canvas *c = ((const row_view *)view)->c;
    const patch *p = ((const row_view *)view)->p;
    for (int y = p->y + (int)begin; y < p->y + end; y++)
        for (int x = p->x; x < p->x + p->width; x++) {
            size_t k = (size_t)y*(size_t)c->width + (size_t)x;
            c->value[k] = c->scratch[k] > 1e-6f ? clampf(c->value[k]/c->scratch[k], 0, 1) : 0;
        }
}

/* The mean values: sums and weights are blurred apart, so that nothing bleeds in from beyond the water. */
static void average_values(canvas *c, filter *f, const patch *p, float *room)
{
    filter_patch(f, c, p, c->value, room, 1);
    filter_patch(f, c, p, c->scratch, room, 1);
    const row_view view = { .c = c, .p = p };
    tobi_loop(0, p->height, 0, divide_rows, &view);
}

enum { BOX_PARTS = 64 };
typedef struct boxing { const canvas *c; int (*box)[4]; } boxing;

/* The samples that have a surface, of parts of the rows: {x0, y0, x1, y1}. */
static void box_parts(const void *view, int64_t begin, int64_t end)
{
    const canvas *c = ((const boxing *)view)->c;
    for (int64_t q = begin; q < end; q++) {
        int *box = ((const boxing *)view)->box[q];
        box[0] = c->width, box[1] = c->height, box[2] = box[3] = -1;
        for (int y = (int)(c->height*q/BOX_PARTS); y < c->height*(q + 1)/BOX_PARTS; y++) {
            const float *row = c->surface + (size_t)y*(size_t)c->width;
            int first = 0, last = c->width - 1;
            while (first <= last && !(row[first] < INFINITY)) first++;
            while (last > first && !(row[last] < INFINITY)) last--;
            if (first > last) continue;
            box[0] = first < box[0] ? first : box[0], box[2] = last > box[2] ? last : box[2];
            box[1] = y < box[1] ? y : box[1], box[3] = y;
        }
    }
}

/* The samples that have a surface and REACH_MAX around them: nothing beyond changes or counts. */
static patch find_patch(const canvas *c)
{
    int x0 = c->width, y0 = c->height, x1 = -1, y1 = -1;
    int box[BOX_PARTS][4];
    const boxing view = { c, box };
    tobi_loop(0, BOX_PARTS, 0, box_parts, &view);
    for (int q = 0; q < BOX_PARTS; q++) {
        x0 = box[q][0] < x0 ? box[q][0] : x0, x1 = box[q][2] > x1 ? box[q][2] : x1;
        y0 = box[q][1] < y0 ? box[q][1] : y0, y1 = box[q][3] > y1 ? box[q][3] : y1;
    }
    if (x1 < 0) return (patch){ 0, 0, 0, 0 };
    x0 = x0 > REACH_MAX ? x0 - REACH_MAX : 0, y0 = y0 > REACH_MAX ? y0 - REACH_MAX : 0;
    x1 = x1 + REACH_MAX < c->width ? x1 + REACH_MAX : c->width - 1;
    y1 = y1 + REACH_MAX < c->height ? y1 + REACH_MAX : c->height - 1;
    return (patch){ x0, y0, x1 - x0 + 1, y1 - y0 + 1 };
}

/* Width of a particle in the middle of the water, samples: blurs are as wide. */
static float find_size(const canvas *c, float radius)
{
    double sum = 0;
    int64_t n = 0;
    for (size_t k = 0; k < (size_t)c->width*(size_t)c->height; k += 61)
        if (c->surface[k] < INFINITY) sum += c->surface[k], n++;
    return n ? radius*scale_at(&c->camera, (float)(sum/(double)n)) : 1;
}

static void smooth_patch(canvas *c, filter *f, float radius, particle_kind what, const patch *p, float *room)
{
    const float size = find_size(c, radius);
    f->reach = clampf(0.5f*size, 1, 60);
    if (what == WATER || !c->palette) average_values(c, f, p, room);
    int reach = (int)clampf(0.6f*size, 1, REACH_MAX);
    for (int i = 0; i < 2 && what == WATER; i++) {
        blur_along(c, p, c->thickness, room, 1, 0, reach, 4*radius);
        blur_along(c, p, room, c->thickness, 0, 1, reach, 4*radius);
    }
    f->flat = c->camera.orthographic;
    f->reach = 2.4f*radius*c->camera.focal;
    f->narrow = 3.0f*radius;
    filter_patch(f, c, p, c->surface, room, 3);
    filter_square(c, p, c->surface, room, (int)clampf(0.35f*size, 1, 5), 0.6f*radius);
}

tobi_status view_smooth_surface(canvas *c, float radius, particle_kind what, patch *p, tobi_error *err)
{
    *p = find_patch(c);
    if (p->width == 0) return TOBI_OK;
    filter *f = calloc(1, sizeof *f);
    float *room = malloc(2*(size_t)c->width*(size_t)c->height*sizeof *room);
    tobi_status status = TOBI_OK;
    if (f && room) {
        for (int r = 1; r <= REACH_MAX; r++)
            for (int k = 0; k <= r; k++) f->gauss[r][k] = expf(-3.0f*(float)(k*k)/(float)(r*r));
        smooth_patch(c, f, radius, what, p, room);
    } else {
        status = tobi_fail(err, TOBI_NO_MEMORY, "no memory for a picture");
    }
    free(f);
    free(room);
    return status;
}
