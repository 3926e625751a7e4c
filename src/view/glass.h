/* Bodies that let light through: each of their surfaces keeps a share of it away, and mirrors the sky where
   it is seen at an angle. Layers of a pixel are kept apart by their nearness and looked through from the far
   one to the near one. Drawback: where there are more than GLASS_LAYERS, those next to each other mix. */
#pragma once
#include "view/raster.h"
#include "view/shade.h"

enum { GLASS_LAYERS = 8 };

/* A side of a body in a pixel: all of its faces that meet there. */
typedef struct glass_layer {
    float nearness, facing;
    float depth;                 /* optical                                            */
    vec   color;                 /* of the faces, times their optical depth            */
    float shine;                 /* reflections of lights                              */
} glass_layer;

/* Of the pixels of a tile; layers stay where they are while points of them wait in a batch. */
typedef struct glass_tile {
    uint8_t count[TILE*TILE];
    glass_layer layer[TILE*TILE*GLASS_LAYERS];
} glass_tile;

/* The place of the layer that a face belongs to, of those of a pixel. A face that is as near as another,
   within what its slope does in a pixel, is of the same surface. */
static inline int32_t find_layer(glass_tile *t, int pixel, const face_setup *f, float nearness)
{
    glass_layer *all = t->layer + pixel*GLASS_LAYERS;
    const float slope = fabsf(f->by_x) + fabsf(f->by_y) + 1e-6f*fabsf(nearness);
    int closest = 0;
    float least = INFINITY;
    for (int n = 0; n < t->count[pixel]; n++) {
        const float off = fabsf(all[n].nearness - nearness);
        if (off <= slope && all[n].facing == f->facing) return pixel*GLASS_LAYERS + n;
        if (off < least) least = off, closest = n;
    }
    if (t->count[pixel] == GLASS_LAYERS) return pixel*GLASS_LAYERS + closest;
    all[t->count[pixel]] = (glass_layer){ .nearness = nearness, .facing = f->facing };
    return pixel*GLASS_LAYERS + t->count[pixel]++;
}

/* Share of a pixel's samples that are in a face. */
static inline float cover_pixel(const face_setup *f, float left, float top, int samples)
{
    const float step = 1/(float)samples;
    int hits = 0;
    for (int j = 0; j < samples; j++)
        for (int i = 0; i < samples; i++) {
            const float x = left + ((float)i + 0.5f)*step, y = top + ((float)j + 0.5f)*step;
            int hit = 1;
            for (int k = 0; k < 3; k++)
                hit &= (x - f->x[k])*f->dy[k] - (y - f->y[k])*f->dx[k] > f->least[k];
            hits += hit;
        }
    return (float)hits*step*step;
}

/* The nearness of a face at a point of the canvas. */
static inline float nearness_at(const face_setup *f, float x, float y)
{
    const float w = f->nearness + (x - f->x0)*f->by_x + (y - f->y0)*f->by_y;
    return clampf(w, f->lowest, f->highest);
}

/* Adds the light of points of glass, whose pixels are layers of the tile. Their normals are as long as their
   surface is optically deep. */
static inline void shade_glass(const canvas *c, glass_tile *t, batch *b)
{
    const float keep = c->camera.orthographic ? 0 : 1;
    const vec window = vec_unit(vec_add(vec_scale(0.45f, c->sky_up), (vec){ 0.25f, 0, 0.9f }));
    for (int i = 0; i < b->count; i++) {
        const vec p = { b->x[i], b->y[i], b->z[i] }, eye = eye_from(keep, p);
        const vec across = { b->nx[i], b->ny[i], b->nz[i] }, n = face_eye(across, eye);
        const vec sum = vec_add(c->light, eye), back = vec_add(window, eye);
        const float facing = clampf(vec_dot(n, eye), 0, 1), away = 1 - facing, away2 = away*away;
        const float own = sqrtf(vec_dot(across, across))*(1 + 1.5f*away2), mirror = 0.8f*away2*away2;
        const float fill = 0.55f + 0.35f*vec_dot(n, c->sky_up) + 0.35f*above(vec_dot(n, c->light));
        const vec sky = sky_color(2*facing*vec_dot(n, c->sky_up) - vec_dot(eye, c->sky_up));
        const vec color = vec_scale(own*fill, (vec){ b->r[i], b->g[i], b->b[i] });
        const float between = clampf(vec_dot(n, sum)/sqrtf(vec_dot(sum, sum) + 1e-20f), 0, 1);
        const float behind = clampf(vec_dot(n, back)/sqrtf(vec_dot(back, back) + 1e-20f), 0, 1);
        glass_layer *l = &t->layer[b->pixel[i]];
        l->depth += b->weight[i]*(own + mirror);
        l->color = vec_add(l->color, vec_scale(b->weight[i], vec_add(color, vec_scale(mirror, sky))));
        l->shine += b->weight[i]*(0.5f*power_64(between) + 0.12f*power_16(behind));
    }
    b->count = 0;
}

/* What is behind a pixel, dimmed, and the layers' own light, from the far one on. */
static inline vec see_through(glass_tile *t, int pixel, vec behind)
{
    glass_layer *all = t->layer + pixel*GLASS_LAYERS;
    for (int n = 1; n < t->count[pixel]; n++) {
        const glass_layer own = all[n];
        int k = n;
        for (; k > 0 && all[k - 1].nearness > own.nearness; k--) all[k] = all[k - 1];
        all[k] = own;
    }
    for (int n = 0; n < t->count[pixel]; n++) {
        const glass_layer *l = &all[n];
        const float through = fade(l->depth), share = (1 - through)/(l->depth > 0 ? l->depth : 1);
        const vec color = vec_add(vec_scale(through, behind), vec_scale(share, l->color));
        behind = vec_mix(color, (vec){ 1, 1, 1 }, l->shine < 1 ? l->shine : 1);
    }
    return behind;
}
