/* Lines and letters over 8-bit pixels. Colours are mixed in sRGB, which is quick; edges look a little
   heavier than those of text.c, which draws into linear light. */
#define _GNU_SOURCE 1
#include "tobiuo/overlay.h"
#include "view/draw.h"
#include <math.h>

/* Capitals are six steps of the grid high. */
static const float CAPITALS = 6;

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

static float draw_letter(const tobi_overlay *o, float x, float y, float unit, char letter,
                         const uint8_t color[3])
{
    float last[2] = { 0, 0 };
    int points = 0;
    for (const char *s = view_letter_strokes(letter); *s; s += *s == ' ' ? 1 : 2) {
        if (*s == ' ') {
            points = 0;
            continue;
        }
        const float at[2] = { x + (float)(s[0] - '0')*unit, y - (float)(s[1] - '0' - 2)*unit };
        if (points++ > 0) tobi_overlay_line(o, last[0], last[1], at[0], at[1], 0.85f*unit, color);
        last[0] = at[0];
        last[1] = at[1];
    }
    return x + (float)view_letter_advance(letter)*unit;
}

float tobi_overlay_text(const tobi_overlay *o, float x, float y, float size, const char *text,
                        const uint8_t color[3])
{
    const float from = x, unit = size/CAPITALS;
    for (; text && *text; text++) x = draw_letter(o, x, y, unit, *text, color);
    return x - from;
}

float tobi_overlay_text_width(float size, const char *text)
{
    float width = 0;
    for (; text && *text; text++) width += (float)view_letter_advance(*text)*size/CAPITALS;
    return width;
}
