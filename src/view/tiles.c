/* Which faces and balls touch which square of the canvas, by counting, so that each square belongs to one
   thread and the picture to no number of them. Drawback: an item is drawn once for each square it
   touches. */
#include "view/draw.h"
#include <stdlib.h>
#include <string.h>

/* Tiles {x0, y0, x1, y1} of what lies between these pixels; false if it is off the canvas. */
static bool find_tiles(const tiles *t, const canvas *c, float x0, float y0, float x1, float y1, int out[4])
{
    /* or NaN */
    if (!(x1 >= 0 && y1 >= 0 && x0 < (float)c->width && y0 < (float)c->height)) return false;
    out[0] = x0 < 0 ? 0 : (int)x0/TILE;
    out[1] = y0 < 0 ? 0 : (int)y0/TILE;
    out[2] = x1 < (float)c->width ? (int)x1/TILE : t->across - 1;
    out[3] = y1 < (float)c->height ? (int)y1/TILE : t->down - 1;
    return true;
}

static float least(float a, float b) { return a < b ? a : b; }
static float largest(float a, float b) { return a > b ? a : b; }

static bool face_tiles(const tiles *t, const canvas *c, const geometry *g, int64_t f, int out[4])
{
    const spot *a = &g->at[g->face[f][0]], *b = &g->at[g->face[f][1]], *d = &g->at[g->face[f][2]];
    const float x0 = least(a->x, least(b->x, d->x)), x1 = largest(a->x, largest(b->x, d->x));
    const float y0 = least(a->y, least(b->y, d->y)), y1 = largest(a->y, largest(b->y, d->y));
    if (!(a->x + b->x + d->x + a->y + b->y + d->y < INFINITY)) return false;      /* a NaN is in no tile */
    return find_tiles(t, c, x0, y0, x1, y1, out);
}

static bool ball_tiles(const tiles *t, const canvas *c, const geometry *g, int64_t i, int out[4])
{
    const ball *b = &g->balls[i];
    const spot at = project(&c->camera, b->place);
    const float r = b->radius*scale_at(&c->camera, b->place.z) + 1;
    if (!(b->place.z - b->radius > c->camera.near) || !(r < 1e4f)) return false;
    return find_tiles(t, c, at.x - r, at.y - r, at.x + r, at.y + r, out);
}

static bool item_tiles(const tiles *t, const canvas *c, const geometry *g, int64_t i, int out[4])
{
    return i < g->faces ? face_tiles(t, c, g, i, out) : ball_tiles(t, c, g, i - g->faces, out);
}

/* A counting sort: sizes, offsets, then the items in their order. */
tobi_status view_tiles_build(tiles *t, const canvas *c, const geometry *g, tobi_error *err)
{
    *t = (tiles){ .across = (c->width + TILE - 1)/TILE, .down = (c->height + TILE - 1)/TILE };
    const size_t count = (size_t)t->across*(size_t)t->down;
    const int64_t n = g->faces + g->ball_count;
    t->first = calloc(count + 1, sizeof *t->first);
    int64_t *next = calloc(count, sizeof *next);
    int r[4];
    if (t->first && next) {
        for (int64_t i = 0; i < n; i++) {
            if (!item_tiles(t, c, g, i, r)) continue;
            for (int y = r[1]; y <= r[3]; y++)
                for (int x = r[0]; x <= r[2]; x++) t->first[y*t->across + x + 1]++;
        }
        for (size_t k = 0; k < count; k++) t->first[k + 1] += t->first[k];
        memcpy(next, t->first, count*sizeof *next);
        t->item = malloc((size_t)(t->first[count] + 1)*sizeof *t->item);
    }
    if (!t->item) {
        free(next);
        view_tiles_free(t);
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a picture");
    }
    for (int64_t i = 0; i < n; i++) {
        if (!item_tiles(t, c, g, i, r)) continue;
        for (int y = r[1]; y <= r[3]; y++)
            for (int x = r[0]; x <= r[2]; x++) t->item[next[y*t->across + x]++] = (int32_t)i;
    }
    free(next);
    return TOBI_OK;
}

void view_tiles_free(tiles *t)
{
    free(t->first);
    free(t->item);
    t->first = NULL;
    t->item = NULL;
}

tobi_status view_paint(canvas *c, const geometry *g, tobi_range kernel, vec *out, tobi_error *err)
{
    tiles t;
    TOBI_TRY(view_tiles_build(&t, c, g, err));
    const painting view = { .c = c, .g = g, .t = &t, .out = out };
    tobi_loop(c->threads, (int64_t)t.across*t.down, 1, kernel, &view);
    view_tiles_free(&t);
    return TOBI_OK;
}

tobi_status view_paint_glass(canvas *c, const geometry *g, const geometry *water, bool over, float film,
                             tobi_error *err)
{
    tiles own = { 0 }, other = { 0 };
    tobi_status status = view_tiles_build(&own, c, g, err);
    if (status == TOBI_OK && water) status = view_tiles_build(&other, c, water, err);
    const painting view = { c, g, &own, c->color, water, &other, over, film };
    if (status == TOBI_OK)
        tobi_loop(c->threads, (int64_t)own.across*own.down, 1, c->kernels->glass_tiles, &view);
    view_tiles_free(&own);
    view_tiles_free(&other);
    return status;
}
