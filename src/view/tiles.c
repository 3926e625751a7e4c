/* Which items touch which square of samples, by counting, so that each square belongs to one thread
   and the picture to no number of them. Drawback: an item is drawn once for each square it touches. */
#include "view/draw.h"
#include <stdlib.h>
#include <string.h>

/* Tiles {x0, y0, x1, y1} of item i; false if it is off the canvas. */
static bool find_tiles(const tiles *t, const canvas *c, const void *items, int64_t i, tile_rect rect,
                       int out[4])
{
    int r[4];
    if (!rect(items, i, r)) return false;
    if (r[2] < 0 || r[3] < 0 || r[0] >= c->width || r[1] >= c->height) return false;
    out[0] = r[0] < 0 ? 0 : r[0]/TILE;
    out[1] = r[1] < 0 ? 0 : r[1]/TILE;
    out[2] = r[2]/TILE < t->across ? r[2]/TILE : t->across - 1;
    out[3] = r[3]/TILE < t->down ? r[3]/TILE : t->down - 1;
    return true;
}

/* A counting sort: sizes, offsets, then the items in their order. */
tobi_status view_tiles_build(tiles *t, const canvas *c, int64_t n, const void *items, tile_rect rect,
                        tobi_error *err)
{
    *t = (tiles){ .across = (c->width + TILE - 1)/TILE, .down = (c->height + TILE - 1)/TILE };
    size_t count = (size_t)t->across*(size_t)t->down;
    t->first = calloc(count + 1, sizeof *t->first);
    int64_t *next = calloc(count, sizeof *next);
    int r[4];
    if (t->first && next) {
        for (int64_t i = 0; i < n; i++) {
            if (!find_tiles(t, c, items, i, rect, r)) continue;
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
        if (!find_tiles(t, c, items, i, rect, r)) continue;
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
