/* Lines and letters over 8-bit pixels. Colours are mixed in sRGB, which is quick; edges look a little
   heavier than those of text.c, which draws into linear light. */
#define _GNU_SOURCE 1
#include "tobiuo/overlay.h"
#include "view/draw.h"
#include <math.h>

static void mix_pixel(const tobi_overlay *o, int x, int y, const uint8_t color[3], float share)
{
    uint8_t *at = o->rgb + 3*((size_t)y*(size_t)o->width + (size_t)x);
    for (int k = 0; k < 3; k++) at[k] =
            (uint8_t)((float)at[k] + share*((float)color[k] - (float)at[k]) + 0.5f);
}

void tobi_overlay_box(const tobi_overlay *o, int x, int y, int width, int height, const uint8_t color[3],
                      float share)
{
    if (!o || !color) return;
    const int right = x + width < o->width ? x + width : o->width, left = x > 0 ? x : 0;
    const int bottom = y + height < o->height ? y + height : o->height, top = y > 0 ? y : 0;
    for (int v = top; v < bottom; v++)
        for (int u = left; u < right; u++) mix_pixel(o, u, v, color, share);
}

void tobi_overlay_line(const tobi_overlay *o, float x0, float y0, float x1, float y1, float thickness,
                       const uint8_t color[3])
{
    const float reach = 0.5f*thickness + 1, dx = x1 - x0, dy = y1 - y0, square = dx*dx + dy*dy;
    if (!o || !color || !isfinite(square)) return;
    const int left = (int)fmaxf(fminf(x0, x1) - reach, 0), top = (int)fmaxf(fminf(y0, y1) - reach, 0);
    const int right = (int)fminf(fmaxf(x0, x1) + reach, (float)o->width - 1);
    const int bottom = (int)fminf(fmaxf(y0, y1) + reach, (float)o->height - 1);
    for (int y = top; y <= bottom; y++)
        for (int x = left; x <= right; x++) {
            const float px = (float)x + 0.5f - x0, py = (float)y + 0.5f - y0;
            const float t = square > 0 ? clampf((px*dx + py*dy)/square, 0, 1) : 0;
            const float cover = clampf(0.5f*thickness + 0.5f - hypotf(px - t*dx, py - t*dy), 0, 1);
            if (cover > 0) mix_pixel(o, x, y, color, cover);
        }
}

typedef struct brush { const tobi_overlay *o; const uint8_t *color; } brush;

static void mix_letter(void *user, int x, int y, float share)
{
    const brush *b = user;
    tobi_overlay_box(b->o, x, y, 1, 1, b->color, share);
}

float tobi_overlay_text(const tobi_overlay *o, float x, float y, float size, const char *text,
                        const uint8_t color[3])
{
    brush b = { o, color };
    if (!o || !color) return 0;
    return view_walk_letters(o->letters, x, y, size, text, mix_letter, &b);
}

float tobi_overlay_text_width(const tobi_overlay *o, float size, const char *text)
{
    return !o ? 0 : view_walk_letters(o->letters, 0, 0, size, text, NULL, NULL);
}
