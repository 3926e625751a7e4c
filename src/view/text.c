/* Texts of a picture: its title and its colour bar. */
#define _GNU_SOURCE 1
#include "view/draw.h"
#include <stdio.h>
#include <string.h>

/* The height of capitals, in units. */
static const float CAPITALS = 6;

float view_text_width(const canvas *i, const char *text, float unit)
{
    return view_walk_letters(i->letters, 0, 0, CAPITALS*unit, text, NULL, NULL);
}

void view_draw_stroke(canvas *i, const float a[2], const float b[2], float pen, vec color)
{
    float reach = 0.5f*pen + 1, d[2] = { b[0] - a[0], b[1] - a[1] }, square = d[0]*d[0] + d[1]*d[1];
    int x0 = (int)fmaxf(fminf(a[0], b[0]) - reach, 0);
    int y0 = (int)fmaxf(fminf(a[1], b[1]) - reach, 0);
    int x1 = (int)fminf(fmaxf(a[0], b[0]) + reach, (float)i->width - 1);
    int y1 = (int)fminf(fmaxf(a[1], b[1]) + reach, (float)i->height - 1);
    for (int y = y0; y <= y1; y++)
        for (int x = x0; x <= x1; x++) {
            float p[2] = { (float)x + 0.5f - a[0], (float)y + 0.5f - a[1] };
            float t = square > 0 ? clampf((p[0]*d[0] + p[1]*d[1])/square, 0, 1) : 0;
            float off = hypotf(p[0] - t*d[0], p[1] - t*d[1]);
            float cover = clampf(0.5f*pen + 0.5f - off, 0, 1);
            vec *at = &i->color[(size_t)y*(size_t)i->width + (size_t)x];
            *at = vec_mix(*at, color, cover);
        }
}

typedef struct brush { canvas *on; vec color; } brush;

static void mix_letter(void *user, int x, int y, float share)
{
    const brush *b = user;
    if (x < 0 || y < 0 || x >= b->on->width || y >= b->on->height) return;
    vec *at = &b->on->color[(size_t)y*(size_t)b->on->width + (size_t)x];
    *at = vec_mix(*at, b->color, share);
}

/* x, y: left end of the baseline. */
void view_draw_text(canvas *i, float x, float y, float unit, const char *text, vec color)
{
    brush b = { i, color };
    view_walk_letters(i->letters, x, y, CAPITALS*unit, text, mix_letter, &b);
}

static const vec ink = { 0.02f, 0.03f, 0.05f };

float view_letter_unit(const canvas *i)
{
    return fmaxf(fminf((float)i->height, (float)i->width)/300, 1);
}

void view_draw_title(canvas *i, const char *text)
{
    float unit = 1.15f*view_letter_unit(i);
    view_draw_text(i, 9*unit, 14*unit, unit, text, ink);
}

double view_tick_step(double range)
{
    double step = pow(10, floor(log10(range))), n = range/step;
    return n < 2 ? step/2 : n > 5 ? 2*step : step;
}

/* Ink does not show on dark water: where more than a tenth of a box is dark, the box is made lighter. */
static void lighten_dark(canvas *i, int x0, int y0, int x1, int y1)
{
    const vec paper = { 0.8f, 0.83f, 0.87f };
    int64_t dark = 0, all = 0;
    x0 = x0 > 0 ? x0 : 0, y0 = y0 > 0 ? y0 : 0;
    x1 = x1 < i->width ? x1 : i->width, y1 = y1 < i->height ? y1 : i->height;
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++, all++) {
            const vec c = i->color[(size_t)y*(size_t)i->width + (size_t)x];
            const int clear = i->alpha && i->alpha[(size_t)y*(size_t)i->width + (size_t)x] < 0.5f;
            dark += !clear && 0.2126f*c.x + 0.7152f*c.y + 0.0722f*c.z < 0.2f;
        }
    if (10*dark <= all) return;
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) {
            const size_t at = (size_t)y*(size_t)i->width + (size_t)x;
            i->color[at] = vec_mix(i->color[at], paper, 0.75f);
            if (i->alpha) i->alpha[at] = fmaxf(i->alpha[at], 0.75f);
        }
}

void view_write_tick(double v, double step, char text[32])
{
    snprintf(text, 32, "%.10g", fabs(v) < 1e-9*step ? 0 : v);
}

static float widest_tick(const canvas *i, double low, double high, double step, float unit)
{
    char text[32];
    float widest = 0;
    for (double v = ceil(low/step - 1e-9)*step; v <= high + 1e-9*step; v += step) {
        view_write_tick(v, step, text);
        widest = fmaxf(widest, view_text_width(i, text, unit));
    }
    return widest;
}

/* On the right: colours from low to high, ticks at round values. Numbers and label end before the picture
   does; a long label has smaller letters. */
void view_draw_color_bar(canvas *i, const tobi_picture *f, double low, double high)
{
    const double step = view_tick_step(high - low);
    float unit = 0.9f*view_letter_unit(i), width = 0.014f*(float)i->width, height = 0.40f*(float)i->height;
    const float room = 0.12f*(float)i->width, all = view_text_width(i, f->label, unit);
    if (all > room) unit = fmaxf(unit*room/all, 0.65f*unit);
    float right = (float)i->width - 4*unit, wide = view_text_width(i, f->label, unit);
    float x = fminf(0.935f*(float)i->width, right - widest_tick(i, low, high, step, unit) - 4*unit - width);
    float bottom = 0.5f*(float)i->height + 0.5f*height, left = fminf(x - 2*unit, right - wide);
    lighten_dark(i, (int)(left - 5*unit), (int)(bottom - height - 20*unit), i->width, (int)(bottom + 8*unit));
    for (int row = 0; row < (int)height; row++)
        for (int column = 0; column < (int)width; column++) {
            int px = (int)x + column, py = (int)bottom - 1 - row;
            bool edge = row == 0 || row == (int)height - 1 || column == 0 || column == (int)width - 1;
            vec color = edge ? ink : view_color_of(f, (float)row/(height - 1));
            i->color[(size_t)py*(size_t)i->width + (size_t)px] = color;
        }
    for (int k = 1; k <= f->isolines; k++) {
        const float y = bottom - height*(float)k/(float)(f->isolines + 1);
        view_draw_stroke(i, (float[2]){ x, y }, (float[2]){ x + width, y }, 1, ink);
    }
    for (double v = ceil(low/step - 1e-9)*step; v <= high + 1e-9*step; v += step) {
        char text[32];
        view_write_tick(v, step, text);
        float y = bottom - (float)((v - low)/(high - low))*height;
        view_draw_stroke(i, (float[2]){ x + width, y }, (float[2]){ x + width + 2*unit, y }, 1, ink);
        view_draw_text(i, x + width + 4*unit, y + 3*unit, unit, text, ink);
    }
    view_draw_text(i, left, bottom - height - 7*unit, unit, f->label, ink);
}
