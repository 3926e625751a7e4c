/* The stages of a picture, shared by the files of this room. View space has x to the right, y up and z
   away from the eye; colours are linear RGB; x and y on the canvas are in pixels, whose middles are at
   halves. */
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
    float  focal;                /* pixels per unit of x/z; orthographic: pixels per m             */
    float  center_x, center_y;   /* of the canvas, pixels                                          */
    float  near;                 /* m                                                              */
    bool   orthographic;
} camera;

/* Depth of what is opaque seen from the key light; axes and centre in view space. */
typedef struct shadow {
    vec    center, right, up, forward;
    float  focal;                /* pixels of the map per m                                        */
    float *depth;                /* NULL = everything is lit                                       */
    float *range;                /* least and largest depth of each block and the eight around it  */
} shadow;

/* A point on the canvas. Nearness, 1/z or, for an orthographic camera, -z, is linear on flat surfaces. */
typedef struct spot {
    float x, y, nearness;
} spot;

typedef struct ball {
    vec   place;                 /* view space                                                     */
    float radius;                /* m                                                              */
    vec   color;
} ball;

/* Triangles and balls. The arrays of vertices are as long as each other. */
typedef struct geometry {
    vec    *place, *normal, *color;
    spot   *at;
    int64_t vertices, vertex_room;
    int32_t (*face)[3];          /* anticlockwise seen from outside                                */
    int64_t faces, face_room;
    int64_t filled;              /* the first so many faces are of bodies whose cut is filled      */
    ball   *balls;
    int64_t ball_count, ball_room;
} geometry;

/* The loops over a tile's samples and a block's nodes, for one instruction set: isa_tiles.c. */
typedef struct tile_kernels {
    tobi_range depth_tiles;      /* nearness of what is opaque, of a shadow's map                  */
    tobi_range opaque_tiles;
    tobi_range water_tiles;
    tobi_range drop_tiles;
    tobi_range glass_tiles;
    tobi_range sum_nodes;        /* of isosurface.c                                                */
    tobi_range sum_colors;
    tobi_range filter_rows;      /* of png.c                                                       */
} tile_kernels;
extern const tile_kernels tile_kernels_v2, tile_kernels_v3, tile_kernels_v4;

/* What is shown of view space: normal . p <= offset, for each plane. */
typedef struct cut {
    int   count;                 /* 0 to 2                                                         */
    vec   normal[2];
    float offset[2];             /* m                                                              */
    int   faced;                 /* 1 or 2: the plane that the eye is beyond; 0 = none             */
} cut;

typedef struct canvas {
    int     width, height;       /* pixels                                                         */
    int     samples;             /* per pixel and axis                                             */
    int     threads;
    const tile_kernels *kernels;
    camera  camera;
    cut     cut;
    vec     light, sky_up;       /* unit vectors in view space: to the key light, against gravity  */
    shadow  shadow;
    vec    *color;               /* of pixels                                                      */
    float  *alpha;               /* of pixels; NULL: the picture is opaque                         */
    float  *depth;               /* of pixels: of the nearest that is opaque, m; INFINITY = none   */
    float  *ink;                 /* of pixels: cover of the parts of lines until all are known, or NULL */
    float  *front;               /* of pixels: of the water; NULL: no water                        */
    float  *nearness;            /* of samples, tile by tile, of what is opaque; NULL: no water    */
    uint8_t *covered;            /* of tiles: 1 if nearness is set there, else nothing is opaque   */
    bool    submerged;           /* the eye is in the water                                        */
    const tobi_image **images;   /* of meshes, then of skins; NULL where there is none             */
    vec    *inside;              /* of things with an image: the colour of cuts                    */
    int     mesh_count;
    float   clarity;             /* m after which 1/e of the light is left in water                */
    struct tobi_letters *letters;   /* NULL: the picture has no text                               */
} canvas;

static inline vec view_point(const camera *c, const double p[3])
{
    double d[3] = { p[0] - c->eye[0], p[1] - c->eye[1], p[2] - c->eye[2] };
    return (vec){ (float)(d[0]*c->right[0] + d[1]*c->right[1] + d[2]*c->right[2]),
                  (float)(d[0]*c->up[0] + d[1]*c->up[1] + d[2]*c->up[2]),
                  (float)(d[0]*c->forward[0] + d[1]*c->forward[1] + d[2]*c->forward[2]) };
}

/* Pixels per metre at a depth. */
static inline float scale_at(const camera *c, float z) { return c->orthographic ? c->focal : c->focal/z; }

static inline float depth_of(const camera *c, float nearness)
{
    return c->orthographic ? -nearness : 1/nearness;
}

static inline spot project(const camera *c, vec p)
{
    float s = scale_at(c, p.z);
    return (spot){ c->center_x + s*p.x, c->center_y - s*p.y, c->orthographic ? -p.z : 1/p.z };
}

/* The view point seen at a point of the canvas and a depth. */
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

/* picture.c */
const tile_kernels *tile_kernels_for(int isa);

/* camera.c */
tobi_status view_aim(canvas *v, const char *path, const tobi_picture *f, tobi_error *err);

/* geometry.c: NULL without memory, or the first of `count` new items, undefined. */
bool view_reserve(geometry *g, int64_t vertices, int64_t faces, int64_t balls);
void view_geometry_free(geometry *g);
/* Places all vertices on the canvas; faces that reach behind the eye are cut there. */
tobi_status view_project(geometry *g, const camera *c, int threads, tobi_error *err);
/* fills: its cut is filled; depth: optical, of glass, else 1. */
bool view_add_mesh(geometry *g, const canvas *c, const tobi_picture_mesh *m, int number, bool fills,
                   float depth);
/* In 2-D: the section z = 0 of its surface, as lines. */
bool view_add_outline(geometry *g, const canvas *c, const tobi_picture_mesh *m, float width);
/* Where a triangle crosses the plane z = 0; the inside of its mesh is to the left. False: nowhere. */
bool view_cross_triangle(const tobi_picture_mesh *m, const int32_t v[3], double end[2][3]);

/* cut.c */
enum { CUT_CORNERS = 8 };        /* of a triangle that two planes have cut: more than it can have */
void view_find_cut(canvas *c, const tobi_picture *f);
/* Adds what the planes leave of a triangle; there is room for CUT_CORNERS vertices and faces. */
void view_add_triangle(geometry *g, const cut *cut, const vec place[3], const vec normal[3],
                       const vec color[3]);
/* m beyond the plane, or beyond `half` a slice; -INFINITY without a plane. */
double view_beyond(const tobi_picture *f, const double p[3], double half);

/* nests.c: m beyond where the liquid of a nest, 0: of the scene, is shown; below 0: within. Of the particle i
   of a picture. */
double view_beyond_nests(const double (*boxes)[2][3], int count, int nest, const double x[3]);
static inline int view_nest_of(const tobi_picture *f, int64_t i) { return f->nest ? f->nest[i] : 0; }
static inline bool view_is_in_nest(const tobi_picture *f, int64_t i)
{
    return !f->nest || view_beyond_nests(f->nests, f->nest_count, f->nest[i], f->positions[i]) <= 0;
}

/* tiles.c: which faces and balls touch which square of the canvas, so that each square is one thread's. */
enum { TILE = 32, MOST_SAMPLES = 4, MOST_SIDE = TILE*MOST_SAMPLES };     /* pixels; samples */
typedef struct tiles {
    int      across, down;
    int64_t *first;              /* across*down + 1 offsets into item                              */
    int32_t *item;               /* a face, or the number of faces and a ball                      */
} tiles;
tobi_status view_tiles_build(tiles *t, const canvas *c, const geometry *g, tobi_error *err);
void view_tiles_free(tiles *t);

/* What the kernels over tiles need. */
typedef struct painting {
    canvas *c;
    const geometry *g;
    const tiles *t;
    vec    *out;                 /* pixels; water reads the canvas's where light is bent           */
    const geometry *water;       /* of glass: what may be before or behind it, or NULL             */
    const tiles *water_tiles;
    bool    over;                /* of glass: only what is before the water, else only behind it   */
    float   film;                /* m, of glass: so little behind water is before it: the surface of water
                                    at a wall goes in and out of the wall                          */
} painting;
tobi_status view_paint(canvas *c, const geometry *g, tobi_range kernel, vec *out, tobi_error *err);
tobi_status view_paint_glass(canvas *c, const geometry *g, const geometry *water, bool over, float film,
                             tobi_error *err);

/* Straight lines in view space. */
typedef struct segments { vec (*end)[2]; int64_t count, room; } segments;
/* Closed lines, around what is seen through and around what hides the liquid behind it. */
enum { COVER_CLEAR, COVER_OPAQUE, COVERS };
/* foam_points.c: over the finished water. */
tobi_status view_draw_foam(canvas *c, const tobi_picture *f, tobi_error *err);

/* isolines.c; false: no memory. In 2-D, of a group, at f->isolines values between low and high. */
typedef struct surface_request surface_request;
bool view_add_segment(segments *s, vec from, vec to);
bool view_find_isolines(const canvas *c, const surface_request *r, double low, double high, segments *out);

/* cover.c. The section z = 0 of a mesh as closed lines around its inside, nothing if they are open; false: no
   memory. Of nodes, the share in such lines of the square around each. */
bool view_add_section(segments *out, const canvas *c, const tobi_picture_mesh *m);
typedef struct cover_grid { float low[2], edge; int size[2]; } cover_grid;      /* view space; nodes */
void view_cover_nodes(const cover_grid *g, const segments *lines, int lists, float *out);

/* skin.c: colours that are what view_fit_rest finds become marks of images, from a vertex and a face on;
   false: no memory. The colour of one place. */
bool view_put_skin(const canvas *c, const surface_request *r, geometry *g, int64_t vertex, int64_t face);
vec view_skin_color(const surface_request *r, int64_t particle);

/* isosurface.c */
struct surface_request {
    const tobi_picture *f;
    const int32_t *row;          /* particles that the surface is around                           */
    int64_t count;
    const vec *color;            /* linear, of all particles; NULL = one colour for all            */
    const vec *scale;            /* not NULL: x of a colour is a value, 0 to 1, on this scale      */
    segments *isolines;           /* gets lines at f->isolines values; NULL = none                  */
    segments *outline;           /* of regions: gets where they end                                */
    const int32_t *liquid;       /* of regions: rows of all liquids, which part them; or NULL      */
    int64_t liquids;
    const segments *cover;       /* of regions: what else is there, see COVERS; or NULL            */
    const tobi_picture_skin *skin;      /* not NULL: colours are what view_fit_rest finds      */
    const struct rest_map *map;  /* with a skin                                                    */
    int     skin_number;         /* of its image                                                   */
    vec     plain;
    float   level;               /* of the kernel sum, 1 inside                                    */
    double  radius;              /* m, half the spacing of these particles                         */
    float   drop;                /* m, radius of a ball for a particle of its own; 0 = none        */
    bool    joins;               /* particles that touch others are within the surface             */
    int     nest;                /* of these particles, see tobi_picture                           */
    bool    evens;               /* particles count the more the fewer are around: nothing shrinks */
};
/* Particles outside of the surface become balls of drops. *around: 1 if the eye is inside of it. */
tobi_status view_add_surface(geometry *g, geometry *drops, const canvas *c, const surface_request *r,
                             bool *around,
                             tobi_error *err);

/* Where a lattice that `evens` ends half a spacing beyond its last layer, so that its volume is right. */
static inline float view_even_level(int dimension) { return dimension == 2 ? 0.57f : 0.575f; }

/* region.c, of 2-D: its faces lie behind bodies. */
tobi_status view_add_region(geometry *g, const canvas *c, const surface_request *r, tobi_error *err);

enum { BLOCK_EDGE = 8, BLOCK_NODES = BLOCK_EDGE*BLOCK_EDGE*BLOCK_EDGE };
/* What the kernels over blocks of nodes need. Lengths are in cells. */
typedef struct node_view {
    const int32_t (*block)[3];   /* of each block its place, in blocks                             */
    const int64_t *first;        /* of each block its particles, as offsets into entry             */
    const int32_t *entry;
    const float (*place)[3];     /* of particles                                                   */
    const vec *color;            /* of particles                                                   */
    float *node;                 /* BLOCK_NODES for each block                                     */
    float *colors;               /* 4 BLOCK_NODES for each that has a surface: sums and weight     */
    const int32_t *colored;      /* of each block, or -1: its place there                          */
    float reach;                 /* of a particle                                                  */
    const float *extra;          /* of particles: what is added to sums, times this; NULL: all new */
    const uint8_t *touched;      /* of blocks: something is added; or NULL                         */
} node_view;

/* floor.c */
void view_draw_background(canvas *c, const tobi_picture *f);
void view_draw_floor(canvas *c, const tobi_picture *f);
/* Lines behind what is opaque are hidden; over_water: only those in front of water are drawn. */
void view_draw_box(canvas *c, const tobi_picture *f, bool over_water);
void view_draw_zones(canvas *c, const tobi_picture *f);
/* A line of view space, `width` pixels wide. */
void view_draw_line(canvas *c, vec p, vec q, float width, vec color, float alpha, bool over_water);
/* Lines of one colour, whose parts and crossings are no darker than the rest; false: no memory. */
bool view_draw_segments(canvas *c, const segments *s, float width, vec color, float alpha);

/* shadow.c */
tobi_status view_make_shadow(canvas *c, const tobi_picture *frame, const geometry *g, tobi_error *err);
enum { SHADOW_SIDE = 1024, SHADOW_BLOCK = 8, SHADOW_ACROSS = SHADOW_SIDE/SHADOW_BLOCK };
float view_lit_around(const shadow *s, float x, float y, float depth);
/* Share of the light that reaches a depth, m, at a point of the map; most are far from every edge of a
   shadow. */
static inline float view_lit_at(const shadow *s, float x, float y, float depth)
{
    if (x >= 0 && y >= 0 && x < SHADOW_SIDE && y < SHADOW_SIDE) {
        const float *range = &s->range[2*((int)y/SHADOW_BLOCK*SHADOW_ACROSS + (int)x/SHADOW_BLOCK)];
        if (depth < range[0]) return 1;
        if (depth >= range[1]) return 0;
    }
    return view_lit_around(s, x, y, depth);
}

/* colors.c: of a value from 0 to 1 by the picture's map; of all particles, NULL without memory. */
vec  view_color_of(const tobi_picture *f, float value);
void view_find_range(const tobi_picture *f, double *low, double *high);
vec *view_color_particles(const tobi_picture *f, double low, double high);
/* Values as x of colours, from 0 at low to 1 at high, or own colours; and the colours of such values. */
vec *view_scale_particles(const tobi_picture *f, double low, double high);
enum { SCALE_STEPS = 1024 };
void view_make_scale(const tobi_picture *f, vec scale[SCALE_STEPS + 1]);
static inline vec view_scaled(const vec *scale, float t)
{
    return scale[(int)(clampf(t, 0, 1)*SCALE_STEPS + 0.5f)];
}

/* letters.c: false: no memory. NULL letters: the system has no font. */
bool view_open_letters(struct tobi_letters **letters);
/* Paints the covered pixels of a text (UTF-8), each with the share that is covered, and returns its
   width. x, y: left end of the baseline; size: height of capitals. paint NULL: measures only. */
typedef void view_paint_pixel(void *user, int x, int y, float share);
float view_walk_letters(struct tobi_letters *l, float x, float y, float size, const char *text,
                        view_paint_pixel *paint, void *user);

/* text.c */
float view_letter_unit(const canvas *c);                 /* pixels of a sixth of a capital's height */
float view_text_width(const canvas *c, const char *text, float unit);
void view_draw_stroke(canvas *c, const float a[2], const float b[2], float pen, vec color);
void view_draw_text(canvas *c, float x, float y, float unit, const char *text, vec color);
double view_tick_step(double range);
/* The number at a tick, with all digits that tell it from the next. */
void view_write_tick(double v, double step, char text[32]);
/* Pixels that the numbers at an upright axis take beside the domain. */
float view_axis_room(const canvas *c, const tobi_picture *f, int axis);
void view_draw_title(canvas *c, const char *text);
void view_draw_color_bar(canvas *c, const tobi_picture *f, double value_min, double value_max);

/* axes.c; false: no memory. */
void view_draw_axes(canvas *c, const tobi_picture *f);
bool view_draw_arrows(canvas *c, const tobi_picture *f);

/* The particle has a colour of its own, whatever its value. */
static inline bool view_has_own(const tobi_picture *f, int64_t i) { return f->own && f->own[i][0] >= 0; }

/* On this side of the clip plane, or in the slice; where its liquid counts. */
static inline bool view_is_shown(const tobi_picture *f, int64_t i)
{
    return (!f->clip || view_beyond(f, f->positions[i], 0.5*f->slice) <= 0) && view_is_in_nest(f, i);
}

/* What the filter of PNG needs: rows, each of which gets a byte in front. */
typedef struct filtering {
    const uint8_t *from;
    uint8_t *to;
    int64_t row;                 /* bytes                                                          */
    int     channels;
} filtering;

/* png.c: width x height x channels bytes, sRGB; of 4 channels the last is alpha. */
void view_encode_colors(const canvas *c, int channels, unsigned char *bytes);
tobi_status view_write_png(const char *path, const canvas *c, tobi_error *err);
