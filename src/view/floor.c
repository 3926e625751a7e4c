/* What is around everything: background, the domain's floor with its shadows, its edges. Lines have soft
   edges of their own. Drawback: lines are not seen bent through water. */
#include "view/draw.h"
#include "view/shade.h"
#include <stdlib.h>

typedef struct background { const canvas *c; vec top, bottom; } background;

static void clear_rows(const void *view, int64_t begin, int64_t end)
{
    const background *v = view;
    const canvas *c = v->c;
    for (int64_t y = begin; y < end; y++) {
        const vec color = vec_mix(v->top, v->bottom, (float)y/(float)c->height);
        for (int64_t k = y*c->width; k < (y + 1)*c->width; k++) {
            c->color[k] = color;
            c->depth[k] = INFINITY;
            if (c->front) c->front[k] = INFINITY;
        }
    }
}

void view_draw_background(canvas *c, const tobi_picture *f)
{
    const background view = { c, linear_color(f->background_top), linear_color(f->background_bottom) };
    tobi_loop(c->threads, c->height, 0, clear_rows, &view);
}

/* over_water: what is in front of water is drawn, else what is in front of all that is opaque. */
static void blend(canvas *c, int x, int y, float z, vec color, float alpha, bool over_water)
{
    const int64_t k = (int64_t)y*c->width + x;
    if (!(z <= c->depth[k])) return;
    if (over_water && !(z < c->front[k] && c->front[k] < INFINITY)) return;
    if (c->ink) c->ink[k] = fmaxf(c->ink[k], alpha);
    else c->color[k] = vec_mix(c->color[k], color, alpha);
}

/* A line of a width in pixels with soft edges, walked along its longer axis. */
void view_draw_line(canvas *c, vec p, vec q, float width, vec color, float alpha, bool over_water)
{
    float near = c->camera.near;
    if (p.z < near && q.z < near) return;
    if (p.z < near) p = vec_mix(p, q, (near - p.z)/(q.z - p.z));
    if (q.z < near) q = vec_mix(q, p, (near - q.z)/(p.z - q.z));
    spot a = project(&c->camera, p), b = project(&c->camera, q);
    float dx = b.x - a.x, dy = b.y - a.y, length = sqrtf(dx*dx + dy*dy);
    if (!(length > 0.01f) || length > 1e6f) return;
    bool steep = fabsf(dy) > fabsf(dx);
    float reach = 0.5f*width + 1, across = (steep ? fabsf(dy) : fabsf(dx))/length;
    float low = steep ? fminf(a.y, b.y) : fminf(a.x, b.x), high = steep ? fmaxf(a.y, b.y) : fmaxf(a.x, b.x);
    int limit = steep ? c->height : c->width, side = steep ? c->width : c->height;
    int begin = (int)clampf(low - reach, 0, (float)limit), end = (int)clampf(high + reach, 0, (float)limit);
    bool flat = c->camera.orthographic;
    for (int m = begin; m < end; m++) {
        float t = ((float)m + 0.5f - (steep ? a.y : a.x))/(steep ? dy : dx), s = clampf(t, 0, 1);
        float z = flat ? p.z : 1/((1 - s)*a.nearness + s*b.nearness),
            middle = steep ? a.x + t*dx : a.y + t*dy;
        if (!(fabsf(middle) < 1e6f)) continue;
        for (int o = (int)floorf(middle - reach/across); o <= (int)ceilf(middle + reach/across); o++) {
            if (o < 0 || o >= side) continue;
            float off = fabsf((float)o + 0.5f - middle) * across,
                  cover = clampf(0.5f * width + 0.5f - off, 0, 1);
            float over = fmaxf(t*length - length, -t*length);      /* beyond the ends */
            cover *= clampf(0.5f*width + 0.5f - over, 0, 1);
            if (cover > 0) blend(c, steep ? o : m, steep ? m : o, z*0.9995f, color, alpha*cover, over_water);
        }
    }
}

typedef struct inking { canvas *c; vec color; } inking;

static void put_ink(const void *view, int64_t begin, int64_t end)
{
    const inking *v = view;
    canvas *c = v->c;
    for (int64_t k = begin*c->width; k < end*c->width; k++)
        if (c->ink[k] > 0) c->color[k] = vec_mix(c->color[k], v->color, c->ink[k]);
}

bool view_draw_segments(canvas *c, const segments *s, float width, vec color, float alpha)
{
    const inking view = { c, color };
    if (s->count == 0) return true;
    c->ink = calloc((size_t)c->width*(size_t)c->height, sizeof *c->ink);
    if (!c->ink) return false;
    for (int64_t k = 0; k < s->count; k++)
        view_draw_line(c, s->end[k][0], s->end[k][1], width, color, alpha, false);
    tobi_loop(c->threads, c->height, 0, put_ink, &view);
    free(c->ink);
    c->ink = NULL;
    return true;
}

static void draw_line(canvas *c, const double from[3], const double to[3], float width, vec color,
                      float alpha, bool over_water)
{
    view_draw_line(c, view_point(&c->camera, from), view_point(&c->camera, to), width, color, alpha,
                   over_water);
}

static double grid_step(double size)
{
    double step = pow(10, floor(log10(size/4)));
    return size/step > 40 ? 5*step : size/step > 16 ? 2*step : step;
}

/* The side of the box that faces down: the axis nearest to up. Returns the axis; *level is its
 * coordinate. */
static int find_floor(const tobi_picture *f, double *level)
{
    int axis = 2;
    if (f->up[0] != 0 || f->up[1] != 0 || f->up[2] != 0)
        for (int k = 0; k < 3; k++)
            if (fabs(f->up[k]) > fabs(f->up[axis])) axis = k;
    *level = f->up[axis] < 0 ? f->box_max[axis] : f->box_min[axis];
    return axis;
}

/* A quadrangle in a plane: its sides on the canvas, and the plane. */
typedef struct flooring {
    canvas *c;
    float a[4][3];               /* a x + b y + c: pixels from each side, positive inside */
    vec   point, normal;
    int   x0, x1;
} flooring;

enum { STRIP = 64 };             /* pixels of a row that are looked at together */

/* Where the rays through the pixels of a strip meet the floor, on the map of shadows. */
static void find_floor_shadows(const flooring *f, const float px[STRIP], float py, float x[STRIP],
                               float y[STRIP], float depth[STRIP])
{
    const camera *c = &f->c->camera;
    const shadow s = f->c->shadow;
    const vec point = f->point, normal = f->normal;
    const float distance = vec_dot(point, normal), middle = 0.5f*SHADOW_SIDE, bias = 4/s.focal;
    const float across = 1/c->focal, up = (c->center_y - py)*across, center = c->center_x;
    TOBI_SIMD
    for (int k = 0; k < STRIP; k++) {
        const vec ray = { (px[k] - center)*across, up, 1 };
        const vec q = vec_sub(vec_scale(distance/vec_dot(ray, normal), ray), s.center);
        x[k] = middle + s.focal*vec_dot(q, s.right), y[k] = middle - s.focal*vec_dot(q, s.up);
        depth[k] = vec_dot(q, s.forward) - bias;
    }
}

/* How much of each pixel is in the quadrangle. */
static bool cover_strip(const flooring *f, const float px[STRIP], float py, float cover[STRIP])
{
    float most = 0;
    for (int k = 0; k < STRIP; k++) cover[k] = 1;
    for (int i = 0; i < 4; i++) {
        const float a = f->a[i][0], rest = f->a[i][1]*py + f->a[i][2] + 0.5f;
        TOBI_SIMD
        for (int k = 0; k < STRIP; k++) {
            const float inside = a*px[k] + rest;
            cover[k] = inside < cover[k] ? inside : cover[k];
        }
    }
    for (int k = 0; k < STRIP; k++) most = cover[k] > most ? cover[k] : most;
    return most > 0;
}

static void fill_floor_rows(const void *view, int64_t begin, int64_t end)
{
    const flooring *f = view;
    canvas *c = f->c;
    const vec plain = { 0.80f, 0.82f, 0.83f };
    const bool shadows = c->shadow.depth && !c->camera.orthographic;
    float px[STRIP], cover[STRIP], x[STRIP], y[STRIP], depth[STRIP];
    for (int row = (int)begin; row < end; row++)
        for (int from = f->x0; from < f->x1; from += STRIP) {
            const float py = (float)row + 0.5f;
            for (int k = 0; k < STRIP; k++) px[k] = (float)(from + k) + 0.5f;
            if (!cover_strip(f, px, py, cover)) continue;
            if (shadows) find_floor_shadows(f, px, py, x, y, depth);
            for (int k = 0; k < STRIP && from + k < f->x1; k++) {
                if (!(cover[k] > 0)) continue;
                const float lit = shadows ? view_lit_at(&c->shadow, x[k], y[k], depth[k]) : 1;
                blend(c, from + k, row, -INFINITY, vec_scale(0.45f + 0.55f*lit, plain), 0.6f*cover[k],
                      false);
            }
        }
}

/* Fills the quadrangle of the four view points. */
static void fill_floor(canvas *c, const vec p[4])
{
    flooring view = { .c = c, .point = p[0],
                      .normal = vec_unit(vec_cross(vec_sub(p[1], p[0]), vec_sub(p[3], p[0]))) };
    spot s[4];
    float area = 0, low = INFINITY, high = -INFINITY;
    for (int i = 0; i < 4; i++) {
        s[i] = project(&c->camera, p[i]);
        low = fminf(low, s[i].x), high = fmaxf(high, s[i].x);
    }
    for (int i = 0; i < 4; i++) area += s[i].x*s[(i + 1)%4].y - s[i].y*s[(i + 1)%4].x;
    for (int i = 0; i < 4; i++) {
        const spot *a = &s[i], *b = &s[(i + 1)%4];
        const float dx = b->x - a->x, dy = b->y - a->y, length = sqrtf(dx*dx + dy*dy);
        if (!(length > 0) || !(length < 1e7f)) return;
        const float by = (area > 0 ? 1.0f : -1.0f)/length;
        view.a[i][0] = -dy*by, view.a[i][1] = dx*by, view.a[i][2] = (dy*a->x - dx*a->y)*by;
    }
    view.x0 = (int)clampf(low - 1, 0, (float)c->width), view.x1 = (int)clampf(high + 2, 0, (float)c->width);
    tobi_loop(c->threads, c->height, 8, fill_floor_rows, &view);
}

/* Lines on the floor at round coordinates: across[0] and across[1] are its axes. */
static void draw_grid(canvas *c, const tobi_picture *f, int axis, double level, const int across[2])
{
    const vec mark = { 0.40f, 0.44f, 0.48f };
    double size = 0;
    for (int k = 0; k < 2; k++) size = fmax(size, f->box_max[across[k]] - f->box_min[across[k]]);
    double step = grid_step(size);
    for (int way = 0; way < 2; way++) {
        int fixed = across[way], along = across[1 - way];
        double start = ceil(f->box_min[fixed]/step)*step;
        for (int i = 0; i < 100 && start + i*step < f->box_max[fixed]; i++) {
            double a[3], b[3];
            a[axis] = b[axis] = level;
            a[fixed] = b[fixed] = start + i*step;
            a[along] = f->box_min[along];
            b[along] = f->box_max[along];
            draw_line(c, a, b, 1.2f, mark, 0.35f, false);
        }
    }
}

/* 2-D: the box's area, a little lighter. 3-D: the box's bottom with a grid. */
void view_draw_floor(canvas *c, const tobi_picture *f)
{
    double level = 0, at[3];
    int axis = f->dimension == 2 ? 2 : find_floor(f, &level), across[2] = { (axis + 1)%3, (axis + 2)%3 };
    vec p[4];
    for (int i = 0; i < 4; i++) {
        at[axis] = level;
        at[across[0]] = i == 1 || i == 2 ? f->box_max[across[0]] : f->box_min[across[0]];
        at[across[1]] = i >= 2 ? f->box_max[across[1]] : f->box_min[across[1]];
        p[i] = view_point(&c->camera, at);
        if (p[i].z < c->camera.near) return;      /* the eye is over the floor: no floor then */
    }
    fill_floor(c, p);
    if (f->dimension == 3) draw_grid(c, f, axis, level, across);
}

/* lift: m towards the eye in 2-D. */
static void draw_edges(canvas *c, int dimension, const double low[3], const double high[3], double lift,
                       float width, vec color, bool over_water)
{
    const int corners = dimension == 2 ? 4 : 8;
    for (int i = 0; i < corners; i++)
        for (int k = 0; k < dimension; k++) {
            if (i >> k & 1) continue;
            double a[3] = { 0, 0, lift }, b[3] = { 0, 0, lift };
            for (int m = 0; m < dimension; m++) a[m] = b[m] = i >> m & 1 ? high[m] : low[m];
            b[k] = high[k];
            draw_line(c, a, b, width, color, 0.75f, over_water);
        }
}

void view_draw_box(canvas *c, const tobi_picture *f, bool over_water)
{
    const vec color = { 0.05f, 0.07f, 0.10f };
    draw_edges(c, f->dimension, f->box_min, f->box_max, 0, 1.3f, color, over_water);
}

/* The boxes of nests among their particles, as far as the domain goes. */
static void draw_nests(canvas *c, const tobi_picture *f, double lift)
{
    const vec color = { 0.05f, 0.07f, 0.10f };
    for (int k = 0; k < f->nest_count; k++) {
        double low[3] = { 0, 0, 0 }, high[3] = { 0, 0, 0 };
        int there = 1;
        for (int a = 0; a < f->dimension; a++) {
            low[a] = fmax(f->nests[k][0][a], f->box_min[a]);
            high[a] = fmin(f->nests[k][1][a], f->box_max[a]);
            there &= low[a] < high[a];
        }
        if (there) draw_edges(c, f->dimension, low, high, lift, 1.3f, color, false);
    }
}

/* Through water, and in 2-D over all. */
void view_draw_zones(canvas *c, const tobi_picture *f)
{
    const vec color = { 0.45f, 0.13f, 0.02f };
    const double lift = f->dimension == 2 ? 4*f->radius : 0;
    if (f->look == TOBI_LOOK_PARTICLES) draw_nests(c, f, lift);
    for (int k = 0; k < f->zone_count; k++)
        draw_edges(c, f->dimension, f->zones[k][0], f->zones[k][1], lift, 2, color, false);
    for (int64_t k = 0; k < f->edge_count; k++) {
        double end[2][3];
        for (int n = 0; n < 2; n++)
            for (int a = 0; a < 3; a++) end[n][a] = a < f->dimension ? f->edges[k][n][a] : lift;
        draw_line(c, end[0], end[1], 2, color, 0.75f, false);
    }
}
