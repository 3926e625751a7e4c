/* Particles, of water or of solids: splatted into depth, thickness and value, smoothed by smooth.c, and
   lit. */
#include "view/draw.h"
#include <stdlib.h>
#include <string.h>

typedef struct splat {
    float x, y, z, radius;   /* samples, m, samples; radius 0 = not drawn */
    float value;             /* 0 to 1 */
} splat;

/* In particle radii: neighbours' spheres overlap into a surface. */
static const float water_radius = 1.7f, grain_radius = 1.55f;

/* From deep blue over light blue to white. */
vec view_map_color(float value)
{
    static const float stop[5][3] = {
        { 0.02f, 0.16f, 0.42f }, { 0.04f, 0.36f, 0.70f }, { 0.22f, 0.60f, 0.87f }, { 0.62f, 0.85f, 0.96f },
        { 0.98f, 0.99f, 1.00f }
    };
    float t = clampf(value, 0, 1)*4;
    int i = t < 3 ? (int)t : 3;
    return vec_mix(linear_color(stop[i]), linear_color(stop[i + 1]), t - (float)i);
}

vec view_water_color(const canvas *c, float value)
{
    int last = c->palette_count - 1;
    if (!c->palette) return view_map_color(value);
    float t = clampf(value, 0, 1)*(float)last;
    int i = t < (float)last ? (int)t : last, next = i < last ? i + 1 : last;
    return vec_mix(linear_color(c->palette[i]), linear_color(c->palette[next]), t - (float)i);
}

static bool splat_rect(const void *items, int64_t i, int rect[4])
{
    const splat *s = &((const splat *)items)[i];
    if (!(s->radius > 0)) return false;
    rect[0] = (int)floorf(s->x - s->radius), rect[1] = (int)floorf(s->y - s->radius);
    rect[2] = (int)ceilf(s->x + s->radius), rect[3] = (int)ceilf(s->y + s->radius);
    return true;
}

enum { CELLS = 1 << 21 };

static uint32_t cell_of(const double p[3], double size, const int shift[3])
{
    uint64_t h = 0;
    for (int k = 0; k < 3; k++)
        h = (h ^ (uint64_t)((int64_t)floor(p[k]/size) + shift[k]))*0x9e3779b97f4a7c15ull, h ^= h >> 29;
    return (uint32_t)(h & (CELLS - 1));
}

static bool is_placed(const double p[3], double size)
{
    return fabs(p[0]) < 1e15*size && fabs(p[1]) < 1e15*size && fabs(p[2]) < 1e15*size;     /* also NaN */
}

typedef struct shrinking {
    const tobi_picture *f;
    splat *splats;
    const uint16_t *count;   /* particles in each cell */
    double size;             /* m, of a cell */
} shrinking;

static void shrink_splats(const void *view, int64_t begin, int64_t end)
{
    const shrinking *s = view;
    const float enough = 24, least = 0.5f;       /* a straight edge of water has 24 or more */
    for (int64_t i = begin; i < end; i++) {
        if (!(s->splats[i].radius > 0)) continue;
        float company = 0;
        for (int k = 0; k < 27 && company < enough; k++) {
            int n = (k + 13)%27;      /* the own cell first: inside the water the search ends early */
            int shift[3] = { n%3 - 1, n/3%3 - 1, n/9 - 1 };
            company += s->count[cell_of(s->f->positions[i], s->size, shift)];
        }
        s->splats[i].radius *= clampf(0.45f + 0.55f*company/enough, least, 1);
    }
}

/* Drops of spray would look like balls of the size of the smoothed water's spheres: a particle with
   little company within three cells of four radii is drawn smaller. Cells are hashed; a clash only
   adds company. */
static void shrink_spray(const tobi_picture *f, splat *splats)
{
    const double size = 4*f->radius;
    uint16_t *count = calloc(CELLS, sizeof *count);
    if (!count) return;
    for (int64_t i = 0; i < f->particle_count; i++) {
        if (!is_placed(f->positions[i], size)) continue;
        uint16_t *cell = &count[cell_of(f->positions[i], size, (int[3]){ 0, 0, 0 })];
        *cell += *cell < UINT16_MAX;
    }
    const shrinking view = { f, splats, count, size };
    tobi_loop(0, f->particle_count, 0, shrink_splats, &view);
    free(count);
}

typedef struct placing {
    const canvas *c;
    const tobi_picture *f;
    splat *splats;
    float radius;            /* m */
    double low, high;        /* of the values */
    particle_kind what;
} placing;

static void place_splats(const void *view, int64_t begin, int64_t end)
{
    const placing *v = view;
    const canvas *c = v->c;
    const tobi_picture *f = v->f;
    for (int64_t i = begin; i < end; i++) {
        vec p = view_point(&c->camera, f->positions[i]);
        splat s = { 0 };
        bool left_out = f->opaque && v->what != DISCS && (v->what == GRAINS) != (f->opaque[i] != 0);
        bool near = is_placed(f->positions[i], f->radius) && fabsf(p.x) < 1e9f && fabsf(p.y) < 1e9f;
        if (near && !left_out && p.z > c->camera.near + v->radius) {
            spot at = project(&c->camera, p);
            float value = f->values ? (float)((f->values[i] - v->low)/(v->high - v->low)) : 0;
            value = value == value ? clampf(value, 0, 1) : 1;
            s = (splat){ at.x, at.y, at.z, v->radius*scale_at(&c->camera, at.z), value };
            if (!(fabsf(at.x) < 1e6f && fabsf(at.y) < 1e6f && s.radius < 1e4f)) s.radius = 0;
        }
        v->splats[i] = s;
    }
}

/* Particles in samples; what is behind the eye, far off the canvas or not finite has radius 0. */
static splat *make_splats(const canvas *c, const tobi_picture *f, float radius, const double range[2],
                          particle_kind what)
{
    splat *splats = malloc(((size_t)f->particle_count + 1)*sizeof *splats);
    if (!splats) return NULL;
    const placing view = { c, f, splats, radius, range[0], range[1], what };
    tobi_loop(0, f->particle_count, 0, place_splats, &view);
    return splats;
}

/* What a tile's loops need. */
typedef struct brush {
    canvas *c;
    particle_kind    what;
    float   radius;       /* m */
    float   weight;       /* of a sphere's chord as thickness */
    float   bright;       /* of discs */
} brush;

/* Clips a splat's row to the tile and the circle: samples [*x0, *x1). */
static bool clip_row(const splat *s, int y, const int tile[4], int *x0, int *x1)
{
    float dy = (float)y + 0.5f - s->y, rest = s->radius*s->radius - dy*dy;
    if (rest <= 0) return false;
    float half = sqrtf(rest);
    float a = ceilf(s->x - half - 0.5f), b = floorf(s->x + half - 0.5f) + 1;
    *x0 = a > (float)tile[0] ? (int)a : tile[0];
    *x1 = b < (float)tile[2] + 1 ? (int)b : tile[2] + 1;
    return *x0 < *x1;
}

static void clip_rows(const splat *s, const int tile[4], int *y0, int *y1)
{
    float a = floorf(s->y - s->radius), b = ceilf(s->y + s->radius);
    *y0 = a > (float)tile[1] ? (int)a : tile[1];
    *y1 = b < (float)tile[3] ? (int)b : tile[3];
}

static void splat_depth(const brush *b, const splat *s, const int tile[4])
{
    canvas *c = b->c;
    int y0, y1, x0, x1;
    float inverse = 1/(s->radius*s->radius);
    clip_rows(s, tile, &y0, &y1);
    for (int y = y0; y <= y1; y++) {
        if (!clip_row(s, y, tile, &x0, &x1)) continue;
        size_t row = (size_t)y*(size_t)c->width;
        const float *opaque = c->depth + row;
        float *surface = c->surface + row, *thickness = c->thickness + row;
        float dy = (float)y + 0.5f - s->y, sx = s->x - 0.5f, z = s->z;
        float high = s->radius/scale_at(&c->camera, z), weight = 2*high*b->weight;
        TOBI_SIMD
        for (int x = x0; x < x1; x++) {
            float dx = (float)x - sx, q = 1 - (dx*dx + dy*dy)*inverse;
            float h = sqrtf(q > 0 ? q : 0), front = z - high*h;
            float seen = front < opaque[x] ? 1.0f : 0.0f;
            surface[x] = seen != 0 && front < surface[x] ? front : surface[x];
            thickness[x] += seen*weight*h;
        }
    }
}

/* Grains have the value of the one in front: a mean of materials would be a third one. */
static void splat_front(const brush *b, const splat *s, const int tile[4])
{
    canvas *c = b->c;
    int y0, y1, x0, x1;
    float inverse = 1/(s->radius*s->radius), high = s->radius/scale_at(&c->camera, s->z);
    clip_rows(s, tile, &y0, &y1);
    for (int y = y0; y <= y1; y++) {
        if (!clip_row(s, y, tile, &x0, &x1)) continue;
        size_t row = (size_t)y*(size_t)c->width;
        float dy = (float)y + 0.5f - s->y;
        for (int x = x0; x < x1; x++) {
            float dx = (float)x - (s->x - 0.5f), q = 1 - (dx*dx + dy*dy)*inverse;
            float front = s->z - high*sqrtf(q > 0 ? q : 0);
            if (front <= c->surface[row + (size_t)x]) c->value[row + (size_t)x] = s->value;
        }
    }
}

/* Mean value of the particles near the front; scratch holds the weights. */
static void splat_value(const brush *b, const splat *s, const int tile[4])
{
    canvas *c = b->c;
    int y0, y1, x0, x1;
    float inverse = 1/(s->radius*s->radius), reach = 2*b->radius;
    clip_rows(s, tile, &y0, &y1);
    for (int y = y0; y <= y1; y++) {
        if (!clip_row(s, y, tile, &x0, &x1)) continue;
        size_t row = (size_t)y*(size_t)c->width;
        const float *surface = c->surface + row;
        float *value = c->value + row, *sum = c->scratch + row;
        float dy = (float)y + 0.5f - s->y, z = s->z, own = s->value, sx = s->x - 0.5f;
        TOBI_SIMD
        for (int x = x0; x < x1; x++) {
            float dx = (float)x - sx, q = 1 - (dx*dx + dy*dy)*inverse;
            float behind = (z - surface[x])/reach, w = q*q*(1 - behind);
            w = q > 0 && behind > -2 && behind < 1 ? w : 0;      /* -inf where a body hides the water */
            value[x] += w*own;
            sum[x] += w;
        }
    }
}

static void splat_disc(const brush *b, const splat *s, const int tile[4])
{
    canvas *c = b->c;
    vec color = vec_scale(b->bright, view_water_color(c, s->value));
    int y0, y1, x0, x1;
    clip_rows(s, tile, &y0, &y1);
    for (int y = y0; y <= y1; y++) {
        if (!clip_row(s, y, tile, &x0, &x1)) continue;
        for (int x = x0; x < x1; x++) c->color[(size_t)y*(size_t)c->width + (size_t)x] = color;
    }
}

typedef struct painting { const brush *b; const tiles *t; const splat *splats; } painting;

/* Every tile: all its splats in their order. */
static void paint_tiles(const void *view, int64_t begin, int64_t end)
{
    const painting *p = view;
    const brush *b = p->b;
    const tiles *t = p->t;
    for (int64_t k = begin; k < end; k++) {
        int rect[4];
        view_tiles_rect(t, b->c, k, rect);
        for (int64_t i = t->first[k]; i < t->first[k + 1]; i++) {
            const splat *s = &p->splats[t->item[i]];
            if (b->what == DISCS) splat_disc(b, s, rect);
            else splat_depth(b, s, rect);
        }
        for (int64_t i = t->first[k]; i < t->first[k + 1] && b->what != DISCS; i++) {
            if (b->what == GRAINS && b->c->palette) splat_front(b, &p->splats[t->item[i]], rect);
            else splat_value(b, &p->splats[t->item[i]], rect);
        }
    }
}

static tobi_status splat_particles(canvas *c, const tobi_picture *f, float radius, const double range[2],
                                   particle_kind what, float bright, tobi_error *err)
{
    splat *splats = make_splats(c, f, radius, range, what);
    if (!splats)
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a picture of %lld particles",
                         (long long)f->particle_count);
    if (what != DISCS) shrink_spray(f, splats);
    tiles t;
    tobi_status status = view_tiles_build(&t, c, f->particle_count, splats, splat_rect, err);
    if (status == TOBI_OK) {
        /* Chords of spheres of radius R at one per (2 r)^3 add up to this much per metre of water. */
        float r = (float)f->radius, per_meter = 4.0f/3*(float)3.14159265*radius*radius*radius/(8*r*r*r);
        brush b = { c, what, radius, 1/per_meter, bright };
        const painting view = { &b, &t, splats };
        tobi_loop(0, (int64_t)t.across*t.down, 1, paint_tiles, &view);
        view_tiles_free(&t);
    }
    free(splats);
    return status;
}

tobi_status view_draw_discs(canvas *c, const tobi_picture *f, double low, double high, tobi_error *err)
{
    /* A darker ground that closes the gaps, then the particles. */
    TOBI_TRY(splat_particles(c, f, 1.45f*(float)f->radius, (double[2]){ low, high }, DISCS, 0.8f,
                             err));
    return splat_particles(c, f, 0.95f*(float)f->radius, (double[2]){ low, high }, DISCS, 1, err);
}

/* Difference of the surface's view points along one axis, taken on the side where the depth changes
 * less. */
static vec slope(const canvas *c, int x, int y, int dx, int dy)
{
    size_t k = (size_t)y*(size_t)c->width + (size_t)x;
    int64_t step = (int64_t)dy*c->width + dx;
    float z = c->surface[k];
    bool first = dx ? x == 0 : y == 0, last = dx ? x == c->width - 1 : y == c->height - 1;
    float before = first ? INFINITY : c->surface[(int64_t)k - step];
    float after = last ? INFINITY : c->surface[(int64_t)k + step];
    vec p = unproject(&c->camera, (float)x + 0.5f, (float)y + 0.5f, z);
    if (!(before < INFINITY) && !(after < INFINITY)) return (vec){ 0, 0, 0 };
    if (fabsf(after - z) <= fabsf(before - z))
        return vec_sub(unproject(&c->camera, (float)(x + dx) + 0.5f, (float)(y + dy) + 0.5f, after), p);
    return vec_sub(p, unproject(&c->camera, (float)(x - dx) + 0.5f, (float)(y - dy) + 0.5f, before));
}

static vec surface_normal(const canvas *c, int x, int y, vec eye)
{
    vec n = vec_cross(slope(c, x, y, 0, 1), slope(c, x, y, 1, 0));
    if (!(vec_dot(n, n) > 0)) return eye;
    n = vec_unit(n);
    return vec_dot(n, eye) < 0 ? vec_scale(-1, n) : n;
}

/* Which sample lies behind the water: the picture shifted by the surface's tilt, the less the thinner the
   water is, here or there, so that a body near the surface is not seen twice. */
static size_t find_behind(const canvas *c, int x, int y, vec n)
{
    size_t k = (size_t)y*(size_t)c->width + (size_t)x, s = k;
    float bend = 0.12f*scale_at(&c->camera, c->surface[k]), most = 0.012f*(float)c->width, shift = most;
    for (int round = 0; round < 3; round++) {
        shift = fminf(shift, bend*fmaxf(c->thickness[s], 0));
        int sx = (int)clampf((float)x - n.x*shift, 0, (float)c->width - 1);
        int sy = (int)clampf((float)y + n.y*shift, 0, (float)c->height - 1);
        s = (size_t)sy*(size_t)c->width + (size_t)sx;
    }
    return c->depth[s] > c->surface[k] ? s : k;
}

/* Light through, scattered in and mirrored by the water at one sample; *through: how much passes. */
static vec shade_water(const canvas *c, const vec *back, int x, int y, float clarity, float *through)
{
    size_t k = (size_t)y*(size_t)c->width + (size_t)x;
    vec p = unproject(&c->camera, (float)x + 0.5f, (float)y + 0.5f, c->surface[k]);
    vec eye = to_eye(&c->camera, p), n = surface_normal(c, x, y, eye);
    size_t seen = find_behind(c, x, y, n);
    float thickness = fmaxf(c->thickness[seen], 0), facing = clampf(vec_dot(n, eye), 0, 1);
    float value = c->value[k];
    float foam = c->palette ? 0.25f : 0.75f*value*value;      /* hides */
    float path = thickness/clarity, veil = 0.18f + foam;
    vec pass = { expf(-1.5f*path), expf(-1.0f*path), expf(-0.85f*path) };
    pass = vec_scale(1 - veil, pass);
    float lit = view_lit_at(c, p), wrap = lit*clampf(0.35f + 0.65f*vec_dot(n, c->light), 0, 1);
    float fill = 0.5f + 0.5f*vec_dot(n, c->sky_up);
    vec light = vec_add(vec_scale(0.75f*wrap, (vec){ 1, 0.98f, 0.94f }),
                        vec_scale(0.20f + 0.30f*fill, (vec){ 0.85f, 0.95f, 1 }));
    vec scatter = vec_mul(view_water_color(c, value), light);
    vec color = vec_add(vec_mul(pass, back[seen]), vec_mul(vec_sub((vec){ 1, 1, 1 }, pass), scatter));
    /* Schlick 1994, water. */
    float mirror = 0.02f + 0.98f*powf(1 - facing, 5);
    vec r = vec_sub(vec_scale(2*vec_dot(n, eye), n), eye), half = vec_unit(vec_add(c->light, eye));
    color = vec_mix(color, view_sky_color(c, r), 0.75f*mirror);
    float shine = lit*powf(clampf(vec_dot(n, half), 0, 1), 140);
    *through = (pass.x + pass.y + pass.z)/3;
    return vec_add(color, vec_scale(0.55f*shine, (vec){ 1, 1, 1 }));
}

typedef struct lighting { canvas *c; const vec *back; float clarity; } lighting;

static void light_rows(const void *view, int64_t begin, int64_t end)
{
    const lighting *l = view;
    canvas *c = l->c;
    for (int y = (int)begin; y < end; y++)
        for (int x = 0; x < c->width; x++) {
            size_t k = (size_t)y*(size_t)c->width + (size_t)x;
            if (c->surface[k] < INFINITY)
                c->color[k] = shade_water(c, l->back, x, y, l->clarity, &c->value[k]);
        }
}

static tobi_status light_water(canvas *c, float clarity, tobi_error *err)
{
    size_t n = (size_t)c->width*(size_t)c->height;
    vec *back = malloc(n*sizeof *back);
    if (!back) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a picture");
    memcpy(back, c->color, n*sizeof *back);
    const lighting view = { c, back, clarity };
    tobi_loop(0, c->height, 8, light_rows, &view);
    free(back);
    return TOBI_OK;
}

static void light_grain_rows(const void *view, int64_t begin, int64_t end)
{
    canvas *c = ((const lighting *)view)->c;
    for (int y = (int)begin; y < end; y++)
        for (int x = 0; x < c->width; x++) {
            size_t k = (size_t)y*(size_t)c->width + (size_t)x;
            if (!(c->surface[k] < INFINITY)) continue;
            vec p = unproject(&c->camera, (float)x + 0.5f, (float)y + 0.5f, c->surface[k]);
            vec n = surface_normal(c, x, y, to_eye(&c->camera, p));
            c->color[k] = view_shade_solid(c, p, n, view_water_color(c, c->value[k]));
        }
}

static void harden_samples(const void *view, int64_t begin, int64_t end)
{
    canvas *c = ((const lighting *)view)->c;
    for (int64_t k = begin; k < end; k++) {
        if (c->surface[k] < INFINITY) c->depth[k] = c->surface[k];
        c->surface[k] = INFINITY;
        c->thickness[k] = c->value[k] = c->scratch[k] = 0;
    }
}

/* The surface of the grains becomes opaque, and the planes are empty for the water. */
static void light_grains(canvas *c)
{
    const lighting view = { .c = c };
    tobi_loop(0, c->height, 8, light_grain_rows, &view);
    tobi_loop(0, (int64_t)c->width*c->height, 0, harden_samples, &view);
}

tobi_status view_draw_grains(canvas *c, const tobi_picture *f, double low, double high, tobi_error *err)
{
    float radius = grain_radius*(float)f->radius;
    TOBI_TRY(splat_particles(c, f, radius, (double[2]){ low, high }, GRAINS, 1, err));
    patch p;
    TOBI_TRY(view_smooth_surface(c, radius, GRAINS, &p, err));
    if (p.width > 0) light_grains(c);
    return TOBI_OK;
}

tobi_status view_draw_water(canvas *c, const tobi_picture *f, double low, double high, tobi_error *err)
{
    float radius = water_radius*(float)f->radius;
    TOBI_TRY(splat_particles(c, f, radius, (double[2]){ low, high }, WATER, 1, err));
    patch p;
    TOBI_TRY(view_smooth_surface(c, radius, WATER, &p, err));
    if (p.width == 0) return TOBI_OK;
    double size = 0;
    for (int k = 0; k < 3; k++) size += (f->box_max[k] - f->box_min[k])*(f->box_max[k] - f->box_min[k]);
    return light_water(c, f->clarity > 0 ? (float)f->clarity : (float)(0.18*sqrt(size)), err);
}
