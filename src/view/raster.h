/* Triangles and balls into the samples of a tile. The edge functions of a side are computed from its ends
   in one order, whatever triangle it belongs to: each sample on a closed surface is in one front and one
   back face. */
#pragma once
#include "view/draw.h"
#include <float.h>

typedef struct square {
    float left, top;             /* pixels                                       */
    int   side;                  /* samples, a multiple of 8                     */
    float step;                  /* pixels from sample to sample                 */
} square;

typedef struct face_setup {
    float x[3], y[3];            /* of each side: where it begins,               */
    float dx[3], dy[3];          /* and goes; inside is dy (px - x) - dx (py - y) > least */
    float least[3];
    float x0, y0, nearness;      /* nearness is a plane through this point       */
    float by_x, by_y;
    float lowest, highest;       /* nearness of the corners                      */
    float left, top, right, bottom;
    float facing;                /* 1: its front is seen, -1: its back           */
} face_setup;

static inline bool set_up_face(face_setup *f, const spot *a, const spot *b, const spot *c)
{
    const spot *corner[3] = { a, b, c };
    const float ux = b->x - a->x, uy = b->y - a->y, vx = c->x - a->x, vy = c->y - a->y, area = ux*vy - uy*vx;
    if (!(fabsf(area) > 1e-9f)) return false;
    const float un = b->nearness - a->nearness, vn = c->nearness - a->nearness;
    f->by_x = (un*vy - vn*uy)/area, f->by_y = (ux*vn - vx*un)/area;
    f->x0 = a->x, f->y0 = a->y, f->nearness = a->nearness;
    f->facing = area < 0 ? 1.0f : -1.0f;      /* y goes down */
    f->left = f->right = a->x, f->top = f->bottom = a->y, f->lowest = f->highest = a->nearness;
    for (int k = 0; k < 3; k++) {
        const spot *p = corner[k], *q = corner[(k + 1)%3];
        const bool turned = p->x > q->x || (p->x == q->x && p->y > q->y);
        const bool positive = turned == (area > 0);
        const spot *from = turned ? q : p, *to = turned ? p : q;
        const float sign = positive ? 1.0f : -1.0f;
        f->x[k] = from->x, f->y[k] = from->y;
        f->dx[k] = sign*(to->x - from->x), f->dy[k] = sign*(to->y - from->y);
        f->least[k] = positive ? 0 : -FLT_MIN;
        f->left = p->x < f->left ? p->x : f->left, f->right = p->x > f->right ? p->x : f->right;
        f->top = p->y < f->top ? p->y : f->top, f->bottom = p->y > f->bottom ? p->y : f->bottom;
        f->lowest = p->nearness < f->lowest ? p->nearness : f->lowest;
        f->highest = p->nearness > f->highest ? p->nearness : f->highest;
    }
    return true;
}

/* First and last sample between two pixels, within the tile: first a multiple of 8 if `eights`. */
static inline bool sample_range(float low, float high, float origin, const square *q, int *first, int *last)
{
    const float a = (low - origin)/q->step - 0.5f, b = (high - origin)/q->step - 0.5f;
    *first = a > 0 ? (int)a : 0;
    *last = b < (float)q->side - 1 ? (int)b : q->side - 1;
    return b >= 0 && *first <= *last;
}

static inline void fill_face(const face_setup *f, const square *q, int32_t item, float *nearness,
                             int32_t *items)
{
    int x0, y0, x1, y1;
    if (!sample_range(f->left, f->right, q->left, q, &x0, &x1) ||
        !sample_range(f->top, f->bottom, q->top, q, &y0, &y1)) return;
    const float xa = f->x[0], xb = f->x[1], xc = f->x[2], ya = f->dy[0], yb = f->dy[1], yc = f->dy[2];
    const float la = f->least[0], lb = f->least[1], lc = f->least[2], step = q->step, left = q->left;
    const float by_x = f->by_x, start = f->x0, lowest = f->lowest, highest = f->highest;
    for (int y = y0; y <= y1; y++) {
        const float py = q->top + ((float)y + 0.5f)*step;
        const float ra = (py - f->y[0])*f->dx[0], rb = (py - f->y[1])*f->dx[1], rc = (py - f->y[2])*f->dx[2];
        const float base = f->nearness + (py - f->y0)*f->by_y;
        for (int x = x0 & ~7; x <= x1; x += 8) {
            float *n = nearness + y*q->side + x;
            int32_t *to = items + y*q->side + x;
            TOBI_SIMD
            for (int k = 0; k < 8; k++) {
                const float px = left + ((float)(x + k) + 0.5f)*step;
                float w = base + (px - start)*by_x;
                w = w < lowest ? lowest : w;
                w = w > highest ? highest : w;
                const int hit = ((px - xa)*ya - ra > la) & ((px - xb)*yb - rb > lb) & ((px - xc)*yc - rc > lc)
                    & (w > n[k]);
                n[k] = hit ? w : n[k];
                to[k] = hit ? item : to[k];
            }
        }
    }
}

/* Adds the depth of back faces to, and takes that of front faces from, the thickness of pixels. */
static inline void add_face_depth(const face_setup *f, const square *q, bool orthographic, const float *solid,
                                  float *thickness)
{
    int x0, y0, x1, y1;
    if (!sample_range(f->left, f->right, q->left, q, &x0, &x1) ||
        !sample_range(f->top, f->bottom, q->top, q, &y0, &y1)) return;
    const float xa = f->x[0], xb = f->x[1], xc = f->x[2], ya = f->dy[0], yb = f->dy[1], yc = f->dy[2];
    const float la = f->least[0], lb = f->least[1], lc = f->least[2], left = q->left;
    const float by_x = f->by_x, start = f->x0, lowest = f->lowest, highest = f->highest, sign = -f->facing;
    for (int y = y0; y <= y1; y++) {
        const float py = q->top + ((float)y + 0.5f);
        const float ra = (py - f->y[0])*f->dx[0], rb = (py - f->y[1])*f->dx[1], rc = (py - f->y[2])*f->dx[2];
        const float base = f->nearness + (py - f->y0)*f->by_y;
        for (int x = x0 & ~7; x <= x1; x += 8) {
            float *to = thickness + y*q->side + x;
            const float *most = solid + y*q->side + x;
            TOBI_SIMD
            for (int k = 0; k < 8; k++) {
                const float px = left + ((float)(x + k) + 0.5f);
                float w = base + (px - start)*by_x;
                w = w < lowest ? lowest : w;
                w = w > highest ? highest : w;
                const float z = orthographic ? -w : 1/w, depth = z < most[k] ? z : most[k];
                const int hit = ((px - xa)*ya - ra > la) & ((px - xb)*yb - rb > lb)
                    & ((px - xc)*yc - rc > lc);
                to[k] += hit ? sign*depth : 0;
            }
        }
    }
}

static inline void fill_ball(const camera *c, const ball *b, const square *q, int32_t item, float *nearness,
                             int32_t *items)
{
    int x0, y0, x1, y1;
    const spot at = project(c, b->place);
    const float r = b->radius*scale_at(c, b->place.z), inverse = 1/(r*r), step = q->step, left = q->left;
    if (!sample_range(at.x - r, at.x + r, q->left, q, &x0, &x1) ||
        !sample_range(at.y - r, at.y + r, q->top, q, &y0, &y1)) return;
    const float z = b->place.z, high = b->radius, ax = at.x;
    const bool flat = c->orthographic;
    for (int y = y0; y <= y1; y++) {
        const float dy = q->top + ((float)y + 0.5f)*step - at.y, rest = 1 - dy*dy*inverse;
        for (int x = x0 & ~7; x <= x1; x += 8) {
            float *n = nearness + y*q->side + x;
            int32_t *to = items + y*q->side + x;
            TOBI_SIMD
            for (int k = 0; k < 8; k++) {
                const float dx = left + ((float)(x + k) + 0.5f)*step - ax, t = rest - dx*dx*inverse;
                const float depth = z - high*sqrtf(t > 0 ? t : 0), w = flat ? -depth : 1/depth;
                const int hit = (t > 0) & (w > n[k]);
                n[k] = hit ? w : n[k];
                to[k] = hit ? item : to[k];
            }
        }
    }
}
