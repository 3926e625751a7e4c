/* What the bodies keep from the key light: their depth seen from the light, once per picture. */
#include "view/draw.h"
#include <stdlib.h>

/* A block is wider than the reach of view_lit_at. */
enum { SIDE = 1024, BLOCK = 8, ACROSS = SIDE/BLOCK };

static vec turn(const shadow *s, vec p)
{
    p = vec_sub(p, s->center);
    return (vec){ vec_dot(p, s->right), vec_dot(p, s->up), vec_dot(p, s->forward) };
}

/* Camera of the light over the sphere around the box: orthographic, in world space. */
static camera light_camera(const camera *view, const shadow *s, double radius)
{
    camera c = { .orthographic = true, .focal = (float)(0.5*SIDE/radius), .center_x = 0.5f*SIDE,
                 .center_y = 0.5f*SIDE, .near = -INFINITY };
    for (int k = 0; k < 3; k++) {
        c.eye[k] = view->eye[k] + s->center.x*view->right[k] + s->center.y*view->up[k]
            + s->center.z*view->forward[k];
        c.right[k] = s->right.x*view->right[k] + s->right.y*view->up[k] + s->right.z*view->forward[k];
        c.up[k] = s->up.x*view->right[k] + s->up.y*view->up[k] + s->up.z*view->forward[k];
        c.forward[k] = s->forward.x * view->right[k] + s->forward.y * view->up[k] +
                       s->forward.z * view->forward[k];
    }
    return c;
}

/* Squares at the depth of the grains' middles: half a grain deep, so that none shades itself. */
static void cast_grains(canvas *light, const tobi_picture *frame)
{
    int half = (int)clampf(1.2f*(float)frame->radius*light->camera.focal, 1, 40);
    for (int64_t i = 0; i < frame->particle_count; i++) {
        if (!frame->opaque[i]) continue;
        spot at = project(&light->camera, view_point(&light->camera, frame->positions[i]));
        if (!(at.x > 0 && at.y > 0 && at.x < SIDE && at.y < SIDE)) continue;
        for (int y = (int)at.y - half; y <= (int)at.y + half; y++)
            for (int x = (int)at.x - half; x <= (int)at.x + half; x++) {
                if (x < 0 || y < 0 || x >= SIDE || y >= SIDE) continue;
                float *depth = &light->depth[(size_t)y*SIDE + (size_t)x];
                if (at.z < *depth) *depth = at.z;
            }
    }
}

/* The least and the largest depth of each block of samples and the eight around it. */
static void find_ranges(shadow *s)
{
    float low[ACROSS*ACROSS], high[ACROSS*ACROSS];
    for (int k = 0; k < ACROSS*ACROSS; k++) low[k] = INFINITY, high[k] = -INFINITY;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            int k = y/BLOCK*ACROSS + x/BLOCK;
            float depth = s->depth[(size_t)y*SIDE + (size_t)x];
            low[k] = depth < low[k] ? depth : low[k];
            high[k] = depth > high[k] ? depth : high[k];
        }
    for (int y = 0; y < ACROSS; y++)
        for (int x = 0; x < ACROSS; x++) {
            float *range = &s->range[2*(y*ACROSS + x)];
            range[0] = INFINITY, range[1] = -INFINITY;
            for (int k = 0; k < 9; k++) {
                int i = x + k%3 - 1, j = y + k/3 - 1;
                bool inside = i >= 0 && j >= 0 && i < ACROSS && j < ACROSS;      /* beyond all is lit */
                range[0] = fminf(range[0], inside ? low[j*ACROSS + i] : INFINITY);
                range[1] = fmaxf(range[1], inside ? high[j*ACROSS + i] : INFINITY);
            }
        }
}

tobi_status view_make_shadow(canvas *c, const tobi_picture *frame, tobi_error *err)
{
    if (frame->mesh_count == 0 && !frame->opaque) return TOBI_OK;
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
    canvas light = { .width = SIDE, .height = SIDE, .camera = light_camera(&c->camera, s, sqrt(size)) };
    s->depth = light.depth = malloc((size_t)SIDE*SIDE*sizeof(float));
    s->range = malloc((size_t)ACROSS*ACROSS*2*sizeof(float));
    if (!s->depth || !s->range) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a picture");
    for (size_t k = 0; k < (size_t)SIDE*SIDE; k++) light.depth[k] = INFINITY;
    s->focal = light.camera.focal;
    if (frame->opaque) cast_grains(&light, frame);
    TOBI_TRY(view_draw_meshes(&light, frame, err));
    find_ranges(s);
    return TOBI_OK;
}

/* Share of the light that reaches a view point: 16 samples around it, softer edges than the map's. */
float view_lit_at(const canvas *c, vec p)
{
    const shadow *s = &c->shadow;
    if (!s->depth) return 1;
    static const float ring[4][2] = {
        { 0.92f, 0.38f }, { -0.38f, 0.92f }, { -0.92f, -0.38f }, { 0.38f, -0.92f }
    };
    vec q = turn(s, p);
    float x = 0.5f*SIDE + s->focal*q.x, y = 0.5f*SIDE - s->focal*q.y, bias = 4/s->focal;
    int lit = 0;
    if (x >= 0 && y >= 0 && x < SIDE && y < SIDE) {      /* most points are far from every edge of a shadow */
        const float *range = &s->range[2*((int)y/BLOCK*ACROSS + (int)x/BLOCK)];
        if (q.z - bias < range[0]) return 1;
        if (q.z - bias >= range[1]) return 0;
    }
    for (int k = 0; k < 16; k++) {
        float r = 1 + 1.3f*(float)(k/4);
        float sx = x + r*ring[k%4][k/4%2], sy = y + r*ring[k%4][1 - k/4%2];
        if (!(sx >= 0 && sy >= 0 && sx < SIDE && sy < SIDE)) {
            lit++;
            continue;
        }
        lit += q.z - bias < s->depth[(size_t)sy*SIDE + (size_t)sx];
    }
    return (float)lit/16;
}
