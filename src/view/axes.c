/* Axes with ticks along edges of the domain, and arrows of velocities: lines and letters over the
   finished picture. Drawback: an axis is drawn over what is in front of it. */
#define _GNU_SOURCE 1
#include "view/draw.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* An edge of the domain: where it begins, and along which axis it goes. */
typedef struct edge { double from[3]; int axis; spot a, b; bool seen; } edge;

static edge make_edge(const canvas *c, const tobi_picture *f, int axis, int which)
{
    edge e = { .axis = axis };
    double to[3];
    for (int k = 0, bit = 0; k < 3; k++) {
        const bool high = k != axis && which >> bit++ & 1;
        e.from[k] = f->dimension == 2 && k == 2 ? 0 : high ? f->box_max[k] : f->box_min[k];
        to[k] = k == axis ? f->box_max[k] : e.from[k];
    }
    const vec p = view_point(&c->camera, e.from), q = view_point(&c->camera, to);
    e.seen = p.z > c->camera.near && q.z > c->camera.near;
    e.a = project(&c->camera, p), e.b = project(&c->camera, q);
    return e;
}

/* The lowest edge of those along an axis; of the axis against gravity the leftmost. */
static edge choose_edge(const canvas *c, const tobi_picture *f, int axis)
{
    edge best = { .seen = false };
    float most = -INFINITY;
    int up = f->dimension - 1;
    for (int k = 0; k < f->dimension; k++)
        if (fabs(f->up[k]) > fabs(f->up[up])) up = k;
    for (int which = 0; which < (f->dimension == 2 ? 2 : 4); which++) {
        const edge e = make_edge(c, f, axis, which);
        const float rank = axis == up ? -(e.a.x + e.b.x) : e.a.y + e.b.y;
        if (e.seen && rank > most) best = e, most = rank;
    }
    return best;
}

/* Where names and numbers stand: left, top, right, bottom. */
typedef struct labels { float box[64][4]; int count; } labels;

/* What would stand in another, as at the corner of two axes, is left out. */
static bool has_room(labels *l, float x, float y, float wide, float unit)
{
    const float gap = 2*unit, own[4] = { x - gap, y - 8*unit, x + wide + gap, y };
    for (int k = 0; k < l->count; k++) {
        const float *b = l->box[k];
        if (own[0] < b[2] && own[2] > b[0] && own[1] < b[3] && own[3] > b[1]) return false;
    }
    if (l->count < 64) memcpy(l->box[l->count++], own, sizeof own);
    return true;
}

float view_axis_room(const canvas *c, const tobi_picture *f, int axis)
{
    const float unit = 0.8f*view_letter_unit(c);
    const double low = f->box_min[axis], high = f->box_max[axis], step = view_tick_step(high - low);
    float widest = 0;
    char text[32];
    for (double v = ceil(low/step - 1e-9)*step; v <= high + 1e-9*step; v += step) {
        view_write_tick(v, step, text);
        widest = fmaxf(widest, view_text_width(c, text, unit));
    }
    return widest + 8*unit;
}

static void draw_ticks(canvas *c, const tobi_picture *f, const edge *e, float way[2], labels *l)
{
    const int k = e->axis;
    const float unit = 0.8f*view_letter_unit(c);
    const double low = f->box_min[k], high = f->box_max[k], step = view_tick_step(high - low);
    const vec ink = { 0.02f, 0.03f, 0.05f };
    char text[32];
    for (double v = ceil(low/step - 1e-9)*step; v <= high + 1e-9*step; v += step) {
        double at[3] = { e->from[0], e->from[1], e->from[2] };
        at[k] = v;
        const spot s = project(&c->camera, view_point(&c->camera, at));
        const float to[2] = { s.x + 4*unit*way[0], s.y + 4*unit*way[1] };
        view_draw_stroke(c, (float[2]){ s.x, s.y }, to, 1.2f, ink);
        view_write_tick(v, step, text);
        const float wide = view_text_width(c, text, unit);
        const float beside = way[0] < -0.5f ? -wide - 2*unit : way[0] > 0.5f ? 2*unit : -0.5f*wide;
        const float x = clampf(to[0] + beside, 2, (float)c->width - wide);
        const float y = to[1] + (way[1] > 0.5f ? 9*unit : 3*unit);
        if (has_room(l, x, y, wide, unit)) view_draw_text(c, x, y, unit, text, ink);
    }
}

static void draw_name(canvas *c, const edge *e, const float way[2], labels *l)
{
    const float unit = 0.8f*view_letter_unit(c);
    const vec ink = { 0.02f, 0.03f, 0.05f };
    char text[8];
    snprintf(text, sizeof text, "%c [m]", "xyz"[e->axis]);
    const float wide = view_text_width(c, text, unit), lowest = (float)c->height - 2*unit;
    const float most = lowest - 25*unit*way[1] - 3*unit;
    /* Along the edge: its middle, or where numbers are rare if there is no room below them. */
    const float t = 0.5f*(e->a.y + e->b.y) > most ? 0.72f : 0.5f;
    const float x = e->a.x + t*(e->b.x - e->a.x), y = e->a.y + t*(e->b.y - e->a.y);
    const float left = clampf(x + 38*unit*way[0] - (way[0] < -0.5f ? wide : 0.5f*wide), 2,
                              (float)c->width - wide);
    const float base = clampf(y + 25*unit*way[1] + 3*unit, 8*unit, lowest);
    if (has_room(l, left, base, wide, unit)) view_draw_text(c, left, base, unit, text, ink);
}

void view_draw_axes(canvas *c, const tobi_picture *f)
{
    double middle[3] = { 0, 0, 0 };
    labels l = { .count = 0 };
    for (int k = 0; k < f->dimension; k++) middle[k] = 0.5*(f->box_min[k] + f->box_max[k]);
    const vec m = view_point(&c->camera, middle);
    const spot center = project(&c->camera, m);
    for (int numbers = 0; numbers < 2; numbers++)      /* after the names, which stay */
        for (int axis = 0; axis < f->dimension && m.z > c->camera.near; axis++) {
            const edge e = choose_edge(c, f, axis);
            const float dx = e.b.x - e.a.x, dy = e.b.y - e.a.y, length = sqrtf(dx*dx + dy*dy);
            if (!e.seen || !(length > 40) || !(length < 1e5f)) continue;
            float way[2] = { -dy/length, dx/length };      /* outwards, across the edge */
            const float x = 0.5f*(e.a.x + e.b.x) - center.x, y = 0.5f*(e.a.y + e.b.y) - center.y;
            if (way[0]*x + way[1]*y < 0) way[0] = -way[0], way[1] = -way[1];
            if (numbers) draw_ticks(c, f, &e, way, &l);
            else draw_name(c, &e, way, &l);
        }
}

enum { ARROW_SIDE = 30 };      /* pixels of a picture of 720 lines: one arrow for each square of it */

/* Dark with a pale rim, to be seen on any colour. */
static void draw_arrow(canvas *c, float x, float y, float dx, float dy)
{
    const vec ink[2] = { { 0.9f, 0.9f, 0.9f }, { 0.01f, 0.01f, 0.02f } };
    const float to[2] = { x + dx, y + dy };
    for (int pass = 0; pass < 2; pass++) {
        const float pen = (pass ? 0.6f : 1.4f)*view_letter_unit(c);
        view_draw_stroke(c, (float[2]){ x, y }, to, pen, ink[pass]);
        for (int side = -1; side <= 1; side += 2) {
            const float hx = -0.30f*dx - 0.18f*(float)side*dy, hy = -0.30f*dy + 0.18f*(float)side*dx;
            view_draw_stroke(c, to, (float[2]){ to[0] + hx, to[1] + hy }, pen, ink[pass]);
        }
    }
}

/* In each square of the canvas the nearest particle gets an arrow; the fastest of all has the longest. */
bool view_draw_arrows(canvas *c, const tobi_picture *f)
{
    const int side = ARROW_SIDE*(c->height > 720 ? c->height : 720)/720;
    const int across = c->width/side + 1, down = c->height/side + 1;
    int64_t *nearest = malloc((size_t)(across*down)*sizeof *nearest);
    float *depth = malloc((size_t)(across*down)*sizeof *depth), most = 0;
    if (nearest && depth) {
        for (int k = 0; k < across*down; k++) nearest[k] = -1, depth[k] = INFINITY;
        for (int64_t i = 0; i < f->particle_count; i++) {
            const vec p = view_point(&c->camera, f->positions[i]);
            const spot s = project(&c->camera, p);
            if (!view_is_shown(f, i) || !(p.z > c->camera.near)) continue;
            if (!(s.x >= 0 && s.y >= 0 && s.x < (float)c->width && s.y < (float)c->height)) continue;
            const double *v = f->velocities[i];
            const float speed = (float)sqrt(v[0]*v[0] + v[1]*v[1] + v[2]*v[2]);
            if (!(speed < 1e30f)) continue;
            most = speed > most ? speed : most;
            const int k = (int)s.y/side*across + (int)s.x/side;
            if (p.z < depth[k]) depth[k] = p.z, nearest[k] = i;
        }
        for (int k = 0; k < across*down && most > 0; k++) {
            if (nearest[k] < 0) continue;
            const double *v = f->velocities[nearest[k]];
            const camera *e = &c->camera;
            const float by = 1.3f*(float)side/most;
            const spot s = project(e, view_point(e, f->positions[nearest[k]]));
            const float dx = by*(float)(v[0]*e->right[0] + v[1]*e->right[1] + v[2]*e->right[2]);
            const float dy = -by*(float)(v[0]*e->up[0] + v[1]*e->up[1] + v[2]*e->up[2]);
            if (dx*dx + dy*dy > 4) draw_arrow(c, s.x, s.y, dx, dy);
        }
    }
    free(nearest);
    free(depth);
    return nearest && depth;
}
