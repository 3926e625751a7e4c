/* Letters as strokes on a small grid, drawn with round pens; a title and a colour bar. */
#define _GNU_SOURCE 1
#include "view/draw.h"
#include <stdio.h>
#include <string.h>

/* Points are two digits, x to the right and y up: baseline 2, small letters to 6, capitals to 8,
   tails to 0. A space lifts the pen. */
static const char *const strokes[128] = {
    ['0'] = "123243473818070312", ['1'] = "172822 1232", ['2'] = "07183847460242",
    ['3'] = "07183847463515 354443321203", ['4'] = "32380444", ['5'] = "480805354443321203",
    ['6'] = "473818070312324344351504", ['7'] = "084812",
    ['8'] = "15060718384746351504031232434435", ['9'] = "031232434738180706153546",
    ['a'] = "4332120305163645 4642", ['b'] = "0802 0312324345361605", ['c'] = "4536160503123243",
    ['d'] = "4842 4332120305163645", ['e'] = "04444536160503123243", ['f'] = "38281712 0636",
    ['g'] = "4332120305163645 46413010", ['h'] = "0802 0516364542", ['i'] = "0602 0808",
    ['j'] = "161100 1818", ['k'] = "0802 3603 1432", ['l'] = "0802",
    ['m'] = "0602 0516263532 3546566562", ['n'] = "0602 0516364542", ['o'] = "123243453616050312",
    ['p'] = "0600 0312324345361605", ['q'] = "4640 4332120305163645", ['r'] = "0602 051636",
    ['s'] = "45361605143443321203", ['t'] = "18132232 0636", ['u'] = "0603123243 4642",
    ['v'] = "062246", ['w'] = "0612355266", ['x'] = "0642 4602", ['y'] = "0622 4610",
    ['z'] = "06460242", ['A'] = "022842 1434", ['B'] = "02083847463505 3544433202",
    ['C'] = "4738180703123243", ['D'] = "02082846442202", ['E'] = "48080242 0535",
    ['F'] = "480802 0535", ['G'] = "47381807031232434525", ['H'] = "0208 4248 0545", ['I'] = "0208",
    ['J'] = "3833221203", ['K'] = "0208 4804 1542", ['L'] = "080242", ['M'] = "0208346862",
    ['N'] = "02084248", ['O'] = "123243473818070312", ['P'] = "02083847463505",
    ['Q'] = "123243473818070312 2442", ['R'] = "02083847463505 2542",
    ['S'] = "473818070615354443321203", ['T'] = "0848 2822", ['U'] = "080312324348",
    ['V'] = "082248", ['W'] = "0812365268", ['X'] = "0842 4802", ['Y'] = "082548 2522",
    ['Z'] = "08480242", ['.'] = "0202", [','] = "1201", [':'] = "0202 0505", [';'] = "1201 1515",
    ['-'] = "0535", ['+'] = "0545 2723", ['='] = "0444 0646", ['/'] = "0148", ['('] = "28060321",
    [')'] = "08262301", ['['] = "28080121", [']'] = "08282101", ['^'] = "062846", ['_'] = "0141",
    ['*'] = "2723 0644 0446", ['%'] = "0248 0707 4343", ['<'] = "470543", ['>'] = "074503",
    ['|'] = "0901", ['\''] = "0807", ['"'] = "0807 2827", ['!'] = "0804 0202", ['~'] = "05163445",
    ['?'] = "07183847462524 2222", [' '] = ""
};

const char *view_letter_strokes(char letter)
{
    const char *s = letter > 0 ? strokes[(int)letter] : NULL;
    return s ? s : "0242480802";       /* an empty box for what has no glyph */
}

/* Grid units to the next letter. Digits are equally wide, so that numbers stand still in a film. */
int view_letter_advance(char letter)
{
    int widest = letter == ' ' ? 2 : 0;
    if (letter >= '0' && letter <= '9') return 6;
    for (const char *s = view_letter_strokes(letter); *s; s += *s == ' ' ? 1 : 2)
        if (*s != ' ' && *s - '0' > widest) widest = *s - '0';
    return widest + 2;
}

float view_text_width(const char *text, float unit)
{
    float width = 0;
    for (; *text; text++) width += (float)view_letter_advance(*text);
    return width > 0 ? (width - 2)*unit : 0;
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

/* x, y: left end of the baseline; unit: pixels of a grid step. */
void view_draw_text(canvas *i, float x, float y, float unit, const char *text, vec color)
{
    for (; *text; text++) {
        const char *s = view_letter_strokes(*text);
        float last[2] = { 0, 0 };
        int points = 0;
        for (; *s; s += *s == ' ' ? 1 : 2) {
            if (*s == ' ') {
                points = 0;
                continue;
            }
            float at[2] = { x + (float)(s[0] - '0')*unit, y - (float)(s[1] - '0' - 2)*unit };
            if (points++ > 0) view_draw_stroke(i, last, at, 0.85f*unit, color);
            memcpy(last, at, sizeof last);
        }
        x += (float)view_letter_advance(*text)*unit;
    }
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

static float widest_tick(double low, double high, double step, float unit)
{
    char text[32];
    float widest = 0;
    for (double v = ceil(low/step - 1e-9)*step; v <= high + 1e-9*step; v += step) {
        view_write_tick(v, step, text);
        widest = fmaxf(widest, view_text_width(text, unit));
    }
    return widest;
}

/* On the right: colours from low to high, ticks at round values. Numbers and label end before the picture
   does; a long label has smaller letters. */
void view_draw_color_bar(canvas *i, const tobi_picture *f, double low, double high)
{
    const double step = view_tick_step(high - low);
    float unit = 0.9f*view_letter_unit(i), width = 0.014f*(float)i->width, height = 0.40f*(float)i->height;
    const float room = 0.12f*(float)i->width, all = view_text_width(f->label, unit);
    if (all > room) unit = fmaxf(unit*room/all, 0.65f*unit);
    float right = (float)i->width - 4*unit, wide = view_text_width(f->label, unit);
    float x = fminf(0.935f*(float)i->width, right - widest_tick(low, high, step, unit) - 4*unit - width);
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
