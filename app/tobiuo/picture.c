/* Curves as a script for gnuplot: the program writes commands and data, gnuplot draws. Drawback: a
   second program must be installed. */
#define _GNU_SOURCE
#include "picture.h"
#include "language.h"
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Colours that people with any colour vision tell apart (Okabe & Ito 2008). */
static const char *const palette[] = { "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00",
                                       "#56B4E9", "#999999", "#000000" };
static const int point_types[] = { 6, 4, 8, 10, 12, 2 };
enum { COLOURS = sizeof palette / sizeof *palette, POINTS = sizeof point_types / sizeof(int) };

/* A text of gnuplot. Whatever could end it or mean something inside it is written as a number; letters
   beyond ASCII pass as they are. */
static void write_text(FILE *script, const char *text)
{
    fputc('"', script);
    for (const char *c = text; *c; c++) {
        unsigned char code = (unsigned char)*c;
        if (code >= 128 || isalnum(code) || strchr(" .,:()|/+-=_", code)) fputc(code, script);
        else fprintf(script, "\\%03o", code < ' ' || code == 127 ? ' ' : code);
    }
    fputc('"', script);
}

void picture_label(panel *a, const char *quantity, const char *unit)
{
    snprintf(a->y_label, sizeof a->y_label, *unit ? tr("%s, %s") : "%s", quantity, tr(unit));
}

void picture_begin_script(FILE *script, const char *format)
{
    fputs("# Draws the pictures of this folder: gnuplot -d plots.gnuplot\n"
          "set encoding utf8\n", script);
    if (strcmp(format, "png") == 0)
        fputs("set terminal pngcairo noenhanced font 'Sans,11' size 1000,750\n", script);
    else
        fputs("set terminal svg noenhanced font 'sans-serif,14' size 800,640 "
              "background rgb 'white'\n", script);
    fputs("set datafile missing '?'\n"
          "set grid xtics ytics linetype 1 linewidth 0.5 linecolor rgb '#d0d0d0'\n"
          "set border 3 linecolor rgb '#444444'\n"
          "set tics nomirror\n"
          "set format y '%g'\n"
          "set lmargin 13\n"
          "set rmargin 3\n"
          "set key above left horizontal Left reverse samplen 2\n", script);
}

static int is_drawn(const picture *p, const curve *c, size_t i, int logarithmic)
{
    return isfinite(c->x[i]) && isfinite(c->y[i]) && c->x[i] >= p->begin && c->x[i] <= p->end &&
           (!logarithmic || c->y[i] > 0);
}

static size_t count_drawn(const picture *p, const curve *c, int logarithmic)
{
    size_t count = 0;
    for (size_t i = 0; i < c->count; i++) count += is_drawn(p, c, i, logarithmic) != 0;
    return count;
}

int panel_has_values(const picture *p, const panel *a)
{
    for (int k = 0; k < a->curves; k++)
        if (count_drawn(p, &a->curve[k], 0)) return 1;
    return 0;
}

typedef struct range { double low, high; } range;

/* Of all that is drawn from the row `first` of each curve on. */
static range find_range(const picture *p, const panel *a, int logarithmic, size_t first)
{
    range r = { INFINITY, -INFINITY };
    for (int k = 0; k < a->curves; k++) {
        const curve *c = &a->curve[k];
        for (size_t i = c->style == CURVE_POINTS ? 0 : first; i < c->count; i++) {
            if (!is_drawn(p, c, i, logarithmic)) continue;
            r.low = fmin(r.low, c->y[i]);
            r.high = fmax(r.high, c->y[i]);
        }
    }
    return r;
}

/* The y axis around everything drawn, with some air; gnuplot refuses an axis of no length. What the first
   rows alone would stretch the axis for leaves it: a force at a sudden start is an impulse over a step. */
static void write_range(FILE *script, const picture *p, const panel *a, int logarithmic)
{
    enum { FIRST = 2 };
    static const double STRETCH = 4;
    range all = find_range(p, a, logarithmic, 0), later = find_range(p, a, logarithmic, FIRST);
    const double span = later.high - later.low;
    const int stretched = !logarithmic && span > 0 && all.high - all.low > STRETCH*span;
    double low = stretched ? later.low : all.low, high = stretched ? later.high : all.high;
    if (logarithmic) {
        fprintf(script, "set logscale y\nset yrange [%.9g:%.9g]\n", low/1.5,
                high*1.5);
        return;
    }
    if (low > high) low = high = 0;
    double air = 0.06*(high - low);
    if (!(air > 1e-9*fmax(fabs(low), fabs(high)))) air = low == 0 ? 1 : 0.1*fabs(low);
    fprintf(script, "unset logscale y\nset yrange [%.9g:%.9g]\n", low - air,
            high + air);
}

static void write_data(FILE *script, const picture *p, const panel *a, int logarithmic)
{
    for (int k = 0; k < a->curves; k++) {
        const curve *c = &a->curve[k];
        fprintf(script, "$curve%d << END\n", k);
        for (size_t i = 0; i < c->count; i++) {
            if (is_drawn(p, c, i, logarithmic)) fprintf(script, "%.9g %.9g\n", c->x[i], c->y[i]);
            else if (c->style != CURVE_POINTS) fputs("NaN NaN\n", script);   /* a gap, which "?" is not */
        }
        fputs("END\n", script);
    }
}

static void write_style(FILE *script, const curve *c)
{
    const char *colour = palette[c->colour % COLOURS];
    if (c->style == CURVE_POINTS)
        fprintf(script, "linespoints pointtype %d pointsize 0.8 linewidth 0.8 linecolor rgb '%s'",
                point_types[c->colour % POINTS], colour);
    else
        fprintf(script, "lines linewidth %s dashtype %s linecolor rgb '%s'",
                c->style == CURVE_THIN ? "1" : "2", c->style == CURVE_DASHED ? "(8,5)" : "1", colour);
}

static void write_panel(FILE *script, const picture *p, const panel *a)
{
    int logarithmic = 0, drawn = 0;
    for (int k = 0; a->logarithmic && k < a->curves; k++)
        logarithmic = logarithmic || count_drawn(p, &a->curve[k], 1) > 0;
    write_data(script, p, a, logarithmic);
    fputs("set ylabel ", script);
    write_text(script, a->y_label);
    fputc('\n', script);
    write_range(script, p, a, logarithmic);
    for (int k = 0; k < a->curves; k++) {
        if (!count_drawn(p, &a->curve[k], logarithmic)) continue;
        fprintf(script, "%s$curve%d using 1:2 with ", drawn++ ? ", \\\n    " : "plot ", k);
        write_style(script, &a->curve[k]);
        fputs(" title ", script);
        write_text(script, a->curve[k].label);
    }
    fputs(drawn ? "\n" : "plot NaN notitle\n", script);
}

void picture_write(FILE *script, const picture *p, const char *file)
{
    fputs("\nset output ", script);
    write_text(script, file);
    double air = p->end > p->begin ? 0 : 0.5;
    fprintf(script, "\nset xrange [%.9g:%.9g]\nset multiplot layout %d,1 title ", p->begin - air,
            p->end + air, p->panels);
    write_text(script, p->title);
    fputc('\n', script);
    for (int k = 0; k < p->panels; k++) {
        fputs(k == p->panels - 1 ? "set xlabel " : "unset xlabel", script);
        if (k == p->panels - 1) write_text(script, p->x_label ? p->x_label : tr("time, s"));
        fputc('\n', script);
        write_panel(script, p, &p->panel[k]);
    }
    fputs("unset multiplot\nunset output\n", script);
}

void picture_free(picture *p)
{
    for (int k = 0; k < p->panels; k++)
        for (int i = 0; i < p->panel[k].curves; i++) {
            free(p->panel[k].curve[i].x);
            free(p->panel[k].curve[i].y);
        }
    *p = (picture){ 0 };
}
