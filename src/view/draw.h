/* The stages of a picture, shared by the files of this room. A canvas holds samples, several per pixel; view
   space has x to the right, y up and z away from the eye; colours are linear RGB. */
#pragma once
#include "base/error.h"
#include "exec/exec.h"
#include "tobiuo/picture.h"
#include <math.h>
#include <stdbool.h>

typedef struct vec {
    float x, y, z;
} vec;

static inline vec vec_add(vec a, vec b) { return (vec){ a.x + b.x, a.y + b.y, a.z + b.z }; }
static inline vec vec_sub(vec a, vec b) { return (vec){ a.x - b.x, a.y - b.y, a.z - b.z }; }
static inline vec vec_mul(vec a, vec b) { return (vec){ a.x*b.x, a.y*b.y, a.z*b.z }; }
static inline vec vec_scale(float s, vec a) { return (vec){ s*a.x, s*a.y, s*a.z }; }
static inline vec vec_mix(vec a, vec b, float t) { return vec_add(vec_scale(1 - t, a), vec_scale(t, b)); }
static inline float vec_dot(vec a, vec b) { return a.x*b.x + a.y*b.y + a.z*b.z; }
static inline vec vec_cross(vec a, vec b)
{
    return (vec){ a.y*b.z - a.z*b.y, a.z*b.x - a.x*b.z, a.x*b.y - a.y*b.x };
}
static inline vec vec_unit(vec a)
{
    float n = sqrtf(vec_dot(a, a));
    return n > 0 ? vec_scale(1/n, a) : (vec){ 0, 0, -1 };
}
static inline float clampf(float x, float low, float high) { return x < low ? low : x > high ? high : x; }

/* The eye. Positions become view coordinates in double, then float: the scene may be far from the
 * origin. */
typedef struct camera {
    double eye[3], right[3], up[3], forward[3];
    float  focal;                /* samples per unit of x/z; orthographic: samples per m           */
    float  center_x, center_y;   /* of the canvas, samples                                         */
    float  near;                 /* m                                                              */
    bool   orthographic;
} camera;

/* Depth of the bodies seen from the key light; axes and centre in view space. */
typedef struct shadow {
    vec    center, right, up, forward;
    float  focal;                /* samples of the map per m                                       */
    float *depth;                /* NULL = everything is lit                                       */
    float *range;                /* least and largest depth of each block and the eight around it  */
} shadow;

typedef struct canvas {
    int     width, height;       /* samples                                                        */
    camera  camera;
    vec     light, sky_up;       /* unit vectors in view space: to the key light, against gravity  */
    shadow  shadow;
    const float (*palette)[3];   /* sRGB; NULL = the usual map                                     */
    int     palette_count;
    vec    *color;               /* NULL: only depth is drawn                                      */
    float  *depth;               /* of what is opaque, m; INFINITY = background                    */
    float  *surface;             /* of the water's front, m; INFINITY = none                       */
    float  *thickness;           /* of the water, m                                                */
    float *value; /* of the water at its front, 0 to 1; once lit: the light it lets through */
    float  *scratch;
} canvas;

/* A point in samples with its depth. */
typedef struct spot {
    float x, y, z;
} spot;

static inline vec view_point(const camera *c, const double p[3])
{
    double d[3] = { p[0] - c->eye[0], p[1] - c->eye[1], p[2] - c->eye[2] };
    return (vec){ (float)(d[0]*c->right[0] + d[1]*c->right[1] + d[2]*c->right[2]),
                  (float)(d[0]*c->up[0] + d[1]*c->up[1] + d[2]*c->up[2]),
                  (float)(d[0]*c->forward[0] + d[1]*c->forward[1] + d[2]*c->forward[2]) };
}

/* Samples per metre at a depth. */
static inline float scale_at(const camera *c, float z) { return c->orthographic ? c->focal : c->focal/z; }

static inline spot project(const camera *c, vec p)
{
    float s = scale_at(c, p.z);
    return (spot){ c->center_x + s*p.x, c->center_y - s*p.y, p.z };
}

/* The view point seen at a sample and a depth. */
static inline vec unproject(const camera *c, float x, float y, float z)
{
    float s = 1/scale_at(c, z);
    return (vec){ (x - c->center_x)*s, (c->center_y - y)*s, z };
}

/* From a view point to the eye. */
static inline vec to_eye(const camera *c, vec p)
{
    return c->orthographic ? (vec){ 0, 0, -1 } : vec_unit(vec_scale(-1, p));
}

static inline float to_linear(float s)
{
    return s <= 0.04045f ? s / 12.92f : powf((s + 0.055f) / 1.055f, 2.4f);
}
static inline vec linear_color(const float srgb[3])
{
    return (vec){ to_linear(srgb[0]), to_linear(srgb[1]), to_linear(srgb[2]) };
}

/* tiles.c: which items touch which square of samples, so that each square is one thread's. */
enum { TILE = 64 };
typedef struct tiles {
    int      across, down;
    int64_t *first;              /* across*down + 1 offsets into item */
    int32_t *item;
} tiles;
/* Samples that item i touches: {x0, y0, x1, y1}, both ends included; false = none. */
typedef bool (*tile_rect)(const void *items, int64_t i, int rect[4]);
tobi_status view_tiles_build(tiles *t, const canvas *c, int64_t n, const void *items, tile_rect rect,
                        tobi_error *err);
void view_tiles_free(tiles *t);
/* The samples of tile k: {x0, y0, x1, y1}, both ends included. */
static inline void view_tiles_rect(const tiles *t, const canvas *c, int64_t k, int rect[4])
{
    rect[0] = (int)(k%t->across)*TILE, rect[1] = (int)(k/t->across)*TILE;
    rect[2] = rect[0] + TILE <= c->width ? rect[0] + TILE - 1 : c->width - 1;
    rect[3] = rect[1] + TILE <= c->height ? rect[1] + TILE - 1 : c->height - 1;
}

/* solid.c */
tobi_status view_draw_meshes(canvas *c, const tobi_picture *frame, tobi_error *err);
void view_draw_floor(canvas *c, const tobi_picture *frame);
void view_draw_box(canvas *c, const tobi_picture *frame);
vec  view_sky_color(const canvas *c, vec direction);
vec  view_shade_solid(const canvas *c, vec p, vec n, vec albedo);

/* shadow.c */
tobi_status view_make_shadow(canvas *c, const tobi_picture *frame, tobi_error *err);
float view_lit_at(const canvas *c, vec point);

/* smooth.c: after particles were splatted. */
typedef enum particle_kind { WATER, GRAINS, DISCS } particle_kind;     /* what the particles of a pass are */
typedef struct patch {
    int x, y, width, height; /* samples; width 0 = none */
} patch;
/* *p: what is around the surface; nothing beyond it was changed. */
tobi_status view_smooth_surface(canvas *c, float radius, particle_kind what, patch *p, tobi_error *err);

/* water.c. Solids first: they become part of what is opaque. */
tobi_status view_draw_grains(canvas *c, const tobi_picture *frame, double value_min, double value_max,
                        tobi_error *err);
tobi_status view_draw_water(canvas *c, const tobi_picture *frame, double value_min, double value_max,
                       tobi_error *err);
tobi_status view_draw_discs(canvas *c, const tobi_picture *frame, double value_min, double value_max,
                       tobi_error *err);
/* The usual map, and the canvas's own. */
vec  view_map_color(float value);
vec  view_water_color(const canvas *c, float value);

/* text.c: pixels, after the samples have been averaged. */
typedef struct image {
    int  width, height;
    vec *color;
} image;
void view_draw_title(image *i, const char *text);
void view_draw_color_bar(image *i, const char *label, double value_min, double value_max);

/* png.c */
tobi_status view_write_png(const char *path, const image *i, tobi_error *err);
