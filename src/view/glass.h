/* Bodies that let light through: each of their surfaces keeps a share of it away, and mirrors the sky where
   it is seen at an angle. Layers add up in any order: optical depths, and colours weighted with them.
   Drawback: which of two layers is nearer does not show. */
#pragma once
#include "view/raster.h"
#include "view/shade.h"

/* Of the pixels of a tile. */
typedef struct glass_layer {
    float depth[TILE*TILE];      /* optical                                            */
    vec   color[TILE*TILE];      /* of the layers, times their optical depth           */
    float shine[TILE*TILE];      /* reflections of lights                              */
} glass_layer;

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

/* Adds the light of points of glass, whose pixels are those of the tile. Their normals are as long as their
   surface is optically deep. */
static inline void shade_glass(const canvas *c, glass_layer *l, batch *b)
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
        const int k = b->pixel[i];
        l->depth[k] += b->weight[i]*(own + mirror);
        l->color[k] = vec_add(l->color[k], vec_scale(b->weight[i], vec_add(color, vec_scale(mirror, sky))));
        l->shine[k] += b->weight[i]*(0.5f*power_64(between) + 0.12f*power_16(behind));
    }
    b->count = 0;
}

/* What is behind, dimmed, and the layers' own light. */
static inline vec see_through(const glass_layer *l, int k, vec behind)
{
    const float through = fade(l->depth[k]), share = (1 - through)/(l->depth[k] > 0 ? l->depth[k] : 1);
    const vec color = vec_add(vec_scale(through, behind), vec_scale(share, l->color[k]));
    const float shine = l->shine[k] < 1 ? l->shine[k] : 1;
    return vec_mix(color, (vec){ 1, 1, 1 }, shine);
}
