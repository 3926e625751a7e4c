/* What is opaque keeps the key light from others: its depth seen from the light, once per picture.
   Drawback: water keeps no light away. */
#include "view/draw.h"
#include <stdlib.h>

/* A block is wider than the reach of view_lit_around. */
enum { SIDE = SHADOW_SIDE, BLOCK = SHADOW_BLOCK, ACROSS = SHADOW_ACROSS };

static vec turn(const shadow *s, vec p)
{
    p = vec_sub(p, s->center);
    return (vec){ vec_dot(p, s->right), vec_dot(p, s->up), vec_dot(p, s->forward) };
}

/* What the light sees: the same faces and balls, turned. */
static bool turn_geometry(const shadow *s, const geometry *g, geometry *out)
{
    *out = (geometry){ 0 };
    if (!view_reserve(out, g->vertices, 0, g->ball_count)) return false;
    out->face = g->face, out->faces = g->faces, out->vertices = g->vertices, out->ball_count = g->ball_count;
    for (int64_t i = 0; i < g->vertices; i++) out->place[i] = turn(s, g->place[i]);
    for (int64_t i = 0; i < g->ball_count; i++) {
        out->balls[i] = g->balls[i];
        out->balls[i].place = turn(s, g->balls[i].place);
    }
    return true;
}

static void find_block_ranges(const void *view, int64_t begin, int64_t end)
{
    const shadow *s = view;
    float *block = s->range + 2*ACROSS*ACROSS;
    for (int64_t j = begin; j < end; j++)
        for (int i = 0; i < ACROSS; i++) {
            float low = INFINITY, high = -INFINITY;
            for (int y = 0; y < BLOCK; y++) {
                const float *row = s->depth + (j*BLOCK + y)*SIDE + (int64_t)i*BLOCK;
                for (int x = 0; x < BLOCK; x++) {
                    low = row[x] < low ? row[x] : low;
                    high = row[x] > high ? row[x] : high;
                }
            }
            block[2*(j*ACROSS + i)] = low, block[2*(j*ACROSS + i) + 1] = high;
        }
}

/* The least and the largest depth of each block of samples and the eight around it; beyond the map all is
   lit. */
static void spread_ranges(const void *view, int64_t begin, int64_t end)
{
    const shadow *s = view;
    const float *block = s->range + 2*ACROSS*ACROSS;
    for (int y = (int)begin; y < end; y++)
        for (int x = 0; x < ACROSS; x++) {
            float *range = &s->range[2*(y*ACROSS + x)];
            range[0] = INFINITY, range[1] = -INFINITY;
            for (int k = 0; k < 9; k++) {
                const int i = x + k%3 - 1, j = y + k/3 - 1;
                const bool inside = i >= 0 && j >= 0 && i < ACROSS && j < ACROSS;
                const float low = inside ? block[2*(j*ACROSS + i)] : INFINITY;
                const float high = inside ? block[2*(j*ACROSS + i) + 1] : INFINITY;
                range[0] = low < range[0] ? low : range[0];
                range[1] = high > range[1] ? high : range[1];
            }
        }
}

static tobi_status draw_map(const canvas *c, const geometry *g, tobi_error *err)
{
    const shadow *s = &c->shadow;
    geometry turned;
    canvas light = { .width = SIDE, .height = SIDE, .samples = 1, .threads = c->threads,
                     .kernels = c->kernels,
                     .depth = s->depth };
    light.camera = (camera){ .orthographic = true, .focal = s->focal, .center_x = 0.5f*SIDE,
                             .center_y = 0.5f*SIDE, .near = -INFINITY };
    tobi_status status = turn_geometry(s, g, &turned) ? view_project(&turned, &light.camera, c->threads, err)
        : tobi_fail(err, TOBI_NO_MEMORY, "no memory for a picture");
    if (status == TOBI_OK) status = view_paint(&light, &turned, c->kernels->depth_tiles, NULL, err);
    turned.face = NULL;      /* the caller's */
    view_geometry_free(&turned);
    return status;
}

tobi_status view_make_shadow(canvas *c, const tobi_picture *frame, const geometry *g, tobi_error *err)
{
    if (g->faces == 0 && g->ball_count == 0) return TOBI_OK;
    double middle[3], size = 0;
    for (int k = 0; k < 3; k++) {
        middle[k] = 0.5*(frame->box_min[k] + frame->box_max[k]);
        size += 0.25*(frame->box_max[k] - frame->box_min[k])*(frame->box_max[k] - frame->box_min[k]);
    }
    shadow *s = &c->shadow;
    s->center = view_point(&c->camera, middle);
    s->forward = vec_scale(-1, c->light);
    vec aside = fabsf(s->forward.x) < 0.8f ? (vec){ 1, 0, 0 } : (vec){ 0, 1, 0 };
    s->right = vec_unit(vec_cross(s->forward, aside));
    s->up = vec_cross(s->right, s->forward);
    s->focal = (float)(0.5*SIDE/sqrt(size));
    s->depth = malloc((size_t)SIDE*SIDE*sizeof(float));
    s->range = malloc((size_t)ACROSS*ACROSS*4*sizeof(float));
    if (!s->depth || !s->range) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a picture");
    TOBI_TRY(draw_map(c, g, err));
    tobi_loop(c->threads, ACROSS, 0, find_block_ranges, s);
    tobi_loop(c->threads, ACROSS, 0, spread_ranges, s);
    return TOBI_OK;
}

/* 16 samples around the point: softer edges than the map's. */
float view_lit_around(const shadow *s, float x, float y, float depth)
{
    static const float ring[4][2] = {
        { 0.92f, 0.38f }, { -0.38f, 0.92f }, { -0.92f, -0.38f }, { 0.38f, -0.92f }
    };
    int lit = 0;
    for (int k = 0; k < 16; k++) {
        float r = 1 + 1.3f*(float)(k/4);
        float sx = x + r*ring[k%4][k/4%2], sy = y + r*ring[k%4][1 - k/4%2];
        if (!(sx >= 0 && sy >= 0 && sx < SIDE && sy < SIDE)) {
            lit++;
            continue;
        }
        lit += depth < s->depth[(size_t)sy*SIDE + (size_t)sx];
    }
    return (float)lit/16;
}
