/* Spray, foam and bubbles as soft white points over the finished water. What they hide adds up in each pixel
   whatever their order is. Water before a point dims it. Drawback: points do not shade one another. */
#include "view/shade.h"
#include <stdlib.h>

/* Of a point: optical depth of its middle by kind; radius in spacings; least radius, pixels. */
static const float middle[] = { 0.5f, 0.6f, 0.35f }, size[] = { 0.10f, 0.14f, 0.11f };
#define LEAST_RADIUS 0.8f

/* What the points do to a pixel: optical depth, and that times their light. */
typedef struct foam_pixel { float depth, light; } foam_pixel;

/* How much of a point is seen in a pixel; z: its depth, m. p->over: water is opaque, too, and foam lies
   within p->film of its surface. */
static float find_share(const canvas *c, const painting *p, int64_t pixel, float z)
{
    if (c->camera.orthographic) return 1;      /* 2-D */
    if (z >= c->depth[pixel] + (p->over ? p->film : 0)) return 0;
    if (c->submerged) return fade(z/c->clarity);
    if (!c->front || !(z > c->front[pixel] + p->film)) return 1;
    return fade((z - c->front[pixel])/c->clarity);
}

static void add_point(const painting *p, const ball *b, int left, int top, foam_pixel *out)
{
    const canvas *c = p->c;
    const spot at = project(&c->camera, b->place);
    const float own = b->radius*scale_at(&c->camera, b->place.z), r = own > LEAST_RADIUS ? own : LEAST_RADIUS;
    const float strength = b->color.y*own*own/(r*r), inverse = 1/(r*r);
    const int right = left + TILE < c->width ? left + TILE : c->width;
    const int bottom = top + TILE < c->height ? top + TILE : c->height;
    const int x0 = at.x - r > (float)left ? (int)(at.x - r) : left;
    const int x1 = at.x + r < (float)right ? (int)(at.x + r) : right - 1;
    const int y0 = at.y - r > (float)top ? (int)(at.y - r) : top;
    const int y1 = at.y + r < (float)bottom ? (int)(at.y + r) : bottom - 1;
    for (int y = y0; y <= y1; y++)
        for (int x = x0; x <= x1; x++) {
            const float dx = (float)x + 0.5f - at.x, dy = (float)y + 0.5f - at.y;
            const float t = 1 - (dx*dx + dy*dy)*inverse;
            if (!(t > 0)) continue;
            const float share = find_share(c, p, (int64_t)y*c->width + x, b->place.z);
            foam_pixel *to = &out[(y - top)*TILE + x - left];
            to->depth += strength*share*t*t;
            to->light += strength*share*t*t*b->color.x;
        }
}

static void foam_tiles(const void *view, int64_t begin, int64_t end)
{
    const painting *p = view;
    const canvas *c = p->c;
    const vec white = { 0.90f, 0.94f, 0.97f };
    for (int64_t tile = begin; tile < end; tile++) {
        foam_pixel pixel[TILE*TILE] = { { 0, 0 } };
        const int left = (int)(tile%p->t->across)*TILE, top = (int)(tile/p->t->across)*TILE;
        for (int64_t i = p->t->first[tile]; i < p->t->first[tile + 1]; i++)
            add_point(p, &p->g->balls[p->t->item[i]], left, top, pixel);
        for (int k = 0; k < TILE*TILE; k++) {
            if (!(pixel[k].depth > 0)) continue;
            vec *to = &p->out[((int64_t)top + k/TILE)*c->width + left + k%TILE];
            *to = vec_mix(vec_scale(pixel[k].light/pixel[k].depth, white), *to, fade(pixel[k].depth));
        }
    }
}

/* Light of the sky, and the key light where nothing opaque is before it. */
static float light_at(const canvas *c, vec p)
{
    const shadow *s = &c->shadow;
    if (!s->depth) return 1;
    const vec from = vec_sub(p, s->center);
    const float x = SHADOW_SIDE/2 + s->focal*vec_dot(from, s->right);
    const float y = SHADOW_SIDE/2 - s->focal*vec_dot(from, s->up);
    return 0.6f + 0.4f*view_lit_at(s, x, y, vec_dot(from, s->forward) - 4/s->focal);
}

static bool add_balls(const canvas *c, const tobi_picture *f, geometry *g)
{
    if (!view_reserve(g, 0, 0, f->foam_count)) return false;
    for (int64_t i = 0; i < f->foam_count; i++) {
        const int kind = f->foam_kind && f->foam_kind[i] < 3 ? f->foam_kind[i] : 1;
        const vec p = view_point(&c->camera, f->foam[i]);
        if (!(fabsf(p.x) + fabsf(p.y) + fabsf(p.z) < 1e15f*(float)f->radius) ||
            (f->clip && view_beyond(f, f->foam[i], 0.5*f->slice) > 0)) continue;
        const vec look = { light_at(c, p), middle[kind], 0 };
        g->balls[g->ball_count++] = (ball){ p, 2*size[kind]*(float)f->radius, look };
    }
    return true;
}

tobi_status view_draw_foam(canvas *c, const tobi_picture *f, tobi_error *err)
{
    geometry g = { 0 };
    tiles t = { 0 };
    if (f->foam_count == 0 || !f->foam) return TOBI_OK;
    tobi_status status = add_balls(c, f, &g)
        ? TOBI_OK : tobi_fail(err, TOBI_NO_MEMORY, "no memory for a picture");
    if (status == TOBI_OK) status = view_tiles_build(&t, c, &g, err);
    const painting view = { .c = c, .g = &g, .t = &t, .out = c->color, .over = f->look != TOBI_LOOK_NATURAL,
                            .film = 2*(float)f->radius };
    if (status == TOBI_OK) tobi_loop(c->threads, (int64_t)t.across*t.down, 1, foam_tiles, &view);
    view_tiles_free(&t);
    view_geometry_free(&g);
    return status;
}
