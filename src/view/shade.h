/* Light: how points of solids and of water look, many at once. Elementary operations alone, so that every
   instruction set gives the same bits; no minima or maxima of the library, which are calls. */
#pragma once
#include "view/draw.h"

static inline float power_16(float x)
{
    const float x2 = x*x, x4 = x2*x2, x8 = x4*x4;
    return x8*x8;
}

/* e to the power of -x, x at least 0; the relative error is below 0.003 where the value is above 0.02. */
static inline float fade(float x)
{
    const float y = 0.0625f*x;
    return 1/power_16(1 + y*(1 + y*(0.5f + y*0.16666667f)));
}

static inline float power_64(float x)
{
    const float x2 = x*x;
    return power_16(x2*x2);
}

enum { BATCH = 256 };

/* Points of surfaces, with room for what happens on the way to their light. */
typedef struct batch {
    int     count;
    int32_t pixel[BATCH];
    float   weight[BATCH];                              /* share of the pixel                    */
    float   x[BATCH], y[BATCH], z[BATCH];               /* view space                            */
    float   nx[BATCH], ny[BATCH], nz[BATCH];            /* normals; their length does not matter */
    float   r[BATCH], g[BATCH], b[BATCH];               /* albedo                                */
    float   thickness[BATCH];                           /* m of water behind                     */
    float   lit[BATCH];                                 /* share of the key light                */
    float   to_x[BATCH], to_y[BATCH];                   /* pixels, where a ray leaves the water  */
    float   under_r[BATCH], under_g[BATCH], under_b[BATCH];
    uint8_t plain[BATCH];                               /* 1: the albedo is the colour           */
} batch;

/* Light from above and from around, for the cosine to the zenith. */
static inline vec sky_color(float up)
{
    const float t = clampf(0.5f + 0.5f*up, 0, 1), low = clampf(t*2.2f - 0.1f, 0, 1), high = clampf(2*t - 1,
                                                                                                   0, 1);
    const vec ground = { 0.30f, 0.29f, 0.27f }, horizon = { 0.88f, 0.92f, 0.95f }, zenith = { 0.30f, 0.48f,
                                                                                              0.74f };
    return vec_mix(vec_mix(ground, horizon, low), zenith, high);
}

/* keep: 1, or 0 for an orthographic camera. */
static inline vec eye_from(float keep, vec p)
{
    const float n = -keep/sqrtf(p.x*p.x + p.y*p.y + p.z*p.z + 1e-30f);
    return (vec){ n*p.x, n*p.y, n*p.z + keep - 1 };
}

/* A unit normal on the side of the eye. */
static inline vec face_eye(vec n, vec eye)
{
    const float length = sqrtf(vec_dot(n, n)), by = (vec_dot(n,
                                                             eye) < 0 ? -1.0f
                                                                 : 1.0f)/(length > 0 ? length : 1);
    return vec_scale(by, n);
}

static inline float above(float x) { return x > 0 ? x : 0; }

static inline void add_light(vec *out, const batch *b, int i, vec color, bool plain)
{
    if (plain) color = (vec){ b->r[i], b->g[i], b->b[i] };
    vec *to = &out[b->pixel[i]];
    to->x += b->weight[i]*(color.x < 1 ? color.x : 1);      /* what is brighter than white must not spread */
    to->y += b->weight[i]*(color.y < 1 ? color.y : 1);
    to->z += b->weight[i]*(color.z < 1 ? color.z : 1);
}

/* The share of the key light at each point, `lift` m along its normal. */
static inline void find_light(const canvas *c, batch *b, float lift)
{
    const shadow s = c->shadow;
    const int n_points = b->count;
    const float middle = 0.5f*SHADOW_SIDE, bias = 4/s.focal;
    float x[BATCH], y[BATCH], depth[BATCH];
    for (int i = 0; i < n_points; i++) b->lit[i] = 1;
    if (!s.depth) return;
    TOBI_SIMD
    for (int i = 0; i < n_points; i++) {
        const vec p = { b->x[i], b->y[i], b->z[i] }, n = { b->nx[i], b->ny[i], b->nz[i] };
        const vec q = vec_sub(vec_add(p, vec_scale(lift, n)), s.center);
        x[i] = middle + s.focal*vec_dot(q, s.right), y[i] = middle - s.focal*vec_dot(q, s.up);
        depth[i] = vec_dot(q, s.forward) - bias;
    }
    for (int i = 0; i < n_points; i++) b->lit[i] = view_lit_at(&c->shadow, x[i], y[i], depth[i]);
}

static inline void shade_solids(const canvas *c, vec *out, batch *b)
{
    const float keep = c->camera.orthographic ? 0 : 1;
    const int n_points = b->count;
    TOBI_SIMD
    for (int i = 0; i < n_points; i++) {
        const vec p = { b->x[i], b->y[i], b->z[i] }, eye = eye_from(keep, p);
        const vec n = face_eye((vec){ b->nx[i], b->ny[i], b->nz[i] }, eye);
        b->nx[i] = n.x, b->ny[i] = n.y, b->nz[i] = n.z;
    }
    find_light(c, b, 2/c->shadow.focal);
    const vec light = c->light, up = c->sky_up;
    TOBI_SIMD
    for (int i = 0; i < n_points; i++) {
        const vec p = { b->x[i], b->y[i], b->z[i] }, n = { b->nx[i], b->ny[i], b->nz[i] };
        const vec eye = eye_from(keep, p), sum = vec_add(light, eye);
        const float between = above(vec_dot(n, sum))/sqrtf(vec_dot(sum, sum) + 1e-20f);
        const float away = 1 - clampf(vec_dot(n, eye), 0, 1), rim = 0.10f*away*away*away*away;
        const float cosine = vec_dot(n, up), fill = 0.5f + 0.5f*cosine,
            lambert = 0.85f*b->lit[i]*above(vec_dot(n, light));
        const float shine = b->lit[i]*0.22f*power_64(clampf(between, 0, 1));
        const vec sky = sky_color(cosine);
        b->under_r[i] = b->r[i]*(0.20f + 0.22f*fill + lambert) + shine + rim*sky.x;
        b->under_g[i] = b->g[i]*(0.19f + 0.27f*fill + 0.97f*lambert) + shine + rim*sky.y;
        b->under_b[i] = b->b[i]*(0.19f + 0.33f*fill + 0.92f*lambert) + shine + rim*sky.z;
    }
    for (int i = 0; i < n_points; i++)
        add_light(out, b, i, (vec){ b->under_r[i], b->under_g[i], b->under_b[i] }, b->plain[i]);
    b->count = 0;
}

/* A colour between the four pixels around a point of the canvas. */
static inline vec color_between(const canvas *c, const vec *pixels, float x, float y)
{
    x = clampf(x - 0.5f, 0, (float)c->width - 1.001f), y = clampf(y - 0.5f, 0, (float)c->height - 1.001f);
    const int i = (int)x, j = (int)y;
    const float s = x - (float)i, t = y - (float)j;
    const vec *a = pixels + (int64_t)j*c->width + i, *b = a + c->width;
    return vec_mix(vec_mix(a[0], a[1], s), vec_mix(b[0], b[1], s), t);
}

/* Snell's law: where on the canvas the ray through each point leaves the water. */
static inline void bend_rays(const canvas *c, batch *b)
{
    const float keep = c->camera.orthographic ? 0 : 1;
    const int n_points = b->count;
    const float ratio = 1/1.333f, most = 0.8f*c->clarity, focal = c->camera.focal;
    const float cx = c->camera.center_x, cy = c->camera.center_y;
    TOBI_SIMD
    for (int i = 0; i < n_points; i++) {
        const vec p = { b->x[i], b->y[i], b->z[i] }, eye = eye_from(keep, p);
        const vec n = face_eye((vec){ b->nx[i], b->ny[i], b->nz[i] }, eye);
        const float facing = clampf(vec_dot(n, eye), 0, 1), k = 1 - ratio*ratio*(1 - facing*facing);
        const float way = b->thickness[i] < most ? b->thickness[i] : most, along = ratio*facing - sqrtf(k);
        const vec q = vec_add(p, vec_scale(way, vec_add(vec_scale(-ratio, eye), vec_scale(along, n))));
        const float scale = focal/(keep*q.z + 1 - keep);
        b->nx[i] = n.x, b->ny[i] = n.y, b->nz[i] = n.z;
        b->to_x[i] = cx + scale*q.x, b->to_y[i] = cy - scale*q.y;
    }
}

/* What is seen there, unless it is in front of the water, or behind something that the unbent ray meets:
   the way through the water is that of the unbent ray. */
static inline void look_under(const canvas *c, batch *b)
{
    for (int i = 0; i < b->count; i++) {
        float x = b->to_x[i], y = b->to_y[i];
        const int px = (int)clampf(x, 0, (float)c->width - 1), py = (int)clampf(y, 0, (float)c->height - 1);
        const float there = c->depth[(int64_t)py*c->width + px], here = c->depth[b->pixel[i]];
        if (!(there > b->z[i]) || there > 1.05f*here) {
            x = (float)(b->pixel[i]%c->width) + 0.5f;
            y = (float)(b->pixel[i]/c->width) + 0.5f;
        }
        const vec color = color_between(c, c->color, x, y);
        b->under_r[i] = color.x, b->under_g[i] = color.y, b->under_b[i] = color.z;
    }
}

/* Water at points of its front: what lies below, bent and dimmed, the colour of the water itself, the sky
   that it mirrors, the light's glint. */
static inline void shade_waters(const canvas *c, vec *out, batch *b)
{
    const float keep = c->camera.orthographic ? 0 : 1;
    const int n_points = b->count;
    const float inverse = 1/c->clarity;
    const vec light = c->light, up = c->sky_up;
    /* A second, wider light beyond the water, whose reflection shows its waves. */
    const vec window = vec_unit(vec_add(vec_scale(0.45f, up), (vec){ 0.25f, 0, 0.9f }));
    bend_rays(c, b);
    look_under(c, b);
    find_light(c, b, 0);
    TOBI_SIMD
    for (int i = 0; i < n_points; i++) {
        const vec p = { b->x[i], b->y[i], b->z[i] }, n = { b->nx[i], b->ny[i], b->nz[i] };
        const vec eye = eye_from(keep, p), sum = vec_add(light, eye), back = vec_add(window, eye);
        const float path = b->thickness[i]*inverse + 0.10f, lit = b->lit[i], fill = 0.5f + 0.5f*vec_dot(n,
                                                                                                        up);
        const float wrap = 0.60f*lit*clampf(0.35f + 0.65f*vec_dot(n, light), 0, 1),
            around = 0.25f + 0.35f*fill;
        const float facing = clampf(vec_dot(n, eye), 0, 1), away = 1 - facing;
        const float mirror = 0.02f + 0.98f*away*away*away*away*away;      /* Schlick 1994 */
        const float between = clampf(vec_dot(n, sum)/sqrtf(vec_dot(sum, sum) + 1e-20f), 0, 1);
        const float behind = clampf(vec_dot(n, back)/sqrtf(vec_dot(back, back) + 1e-20f), 0, 1);
        const float shine = 1.2f*lit*power_16(power_16(between)) + 0.55f*power_64(behind)*(0.3f + 0.7f*away);
        const vec sky = sky_color(2*facing*vec_dot(n, up) - vec_dot(eye, up));
        const float pr = fade(1.9f*path), pg = fade(0.85f*path), pb = fade(0.60f*path);
        const float r = pr*b->under_r[i] + (1 - pr)*b->r[i]*(wrap + 0.85f*around);
        const float g = pg*b->under_g[i] + (1 - pg)*b->g[i]*(0.98f*wrap + 0.95f*around);
        const float l = pb*b->under_b[i] + (1 - pb)*b->b[i]*(0.94f*wrap + around);
        b->under_r[i] = r + mirror*(sky.x - r) + shine;
        b->under_g[i] = g + mirror*(sky.y - g) + shine;
        b->under_b[i] = l + mirror*(sky.z - l) + shine;
    }
    for (int i = 0; i < n_points; i++)
        add_light(out, b, i, (vec){ b->under_r[i], b->under_g[i], b->under_b[i] }, false);
    b->count = 0;
}

/* Drops, small balls of water: an upside-down view of what is around, dim at the rim, and the light's
   glint. */
static inline void shade_drops(const canvas *c, vec *out, batch *b)
{
    const float keep = c->camera.orthographic ? 0 : 1;
    const vec light = c->light, sky_up = c->sky_up;
    const int n_points = b->count;
    TOBI_SIMD
    for (int i = 0; i < n_points; i++) {
        const vec p = { b->x[i], b->y[i], b->z[i] }, eye = eye_from(keep, p), sum = vec_add(light, eye);
        const vec n = face_eye((vec){ b->nx[i], b->ny[i], b->nz[i] }, eye);
        const vec under = { b->under_r[i], b->under_g[i], b->under_b[i] };
        const float up = vec_dot(n, sky_up), facing = clampf(vec_dot(n, eye), 0, 1), away = 1 - facing;
        const float mirror = 0.02f + 0.98f*away*away*away*away*away;
        const vec through = vec_mix(sky_color(0.25f - 0.6f*up), under, 0.35f + 0.35f*facing*facing);
        const vec tint = { 1 - 0.2f*facing, 1 - 0.07f*facing, 1 - 0.03f*facing };
        const vec color = vec_mix(vec_mul(through, tint), sky_color(2*facing*up - vec_dot(eye, sky_up)),
                                  mirror);
        const float between = clampf(vec_dot(n, sum)/sqrtf(vec_dot(sum, sum) + 1e-20f), 0, 1);
        const float shine = 1.5f*power_64(between);
        b->under_r[i] = 0.88f*color.x + shine;
        b->under_g[i] = 0.88f*color.y + shine;
        b->under_b[i] = 0.88f*color.z + shine;
    }
    for (int i = 0; i < n_points; i++)
        add_light(out, b, i, (vec){ b->under_r[i], b->under_g[i], b->under_b[i] }, false);
    b->count = 0;
}
