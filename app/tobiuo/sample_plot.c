/* tobiuo sample: profiles along lines as a picture: some outputs of one line, the last output of several, or
   means with what fluctuates around them. Drawback: a picture has room for three quantities. */
#define _GNU_SOURCE
#include "picture.h"
#include "sample.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A component of a field and where its numbers stand. */
typedef struct quantity { int field, part; } quantity;

/* The numbers of all places of a field, of the caller. */
static double *copy_values(const sample_run *s, int field, int shown, double **rms)
{
    const size_t size = (size_t)s->places.count*(size_t)s->field[field].components*sizeof(double) + 1;
    tobi_error err = { 0 };
    double *values = malloc(size);
    *rms = malloc(size);
    if (!values || !*rms) exit(complain("out of memory"));
    if (shown >= 0) memcpy(values, s->shown[shown].values[field], size - 1);
    else if (tobi_sample_mean_read(s->field[field].mean, NULL, values, *rms, NULL, &err) != TOBI_OK)
        exit(complain("%s", err.text));
    return values;
}

static void add_curve(const sample_run *s, panel *a, const curve *like, const quantity *q, int line,
                      const double *values, const double *more, double times)
{
    const int n = s->field[q->field].components, count = s->options->count;
    if (a->curves == CURVE_LIMIT) return;
    curve *c = &a->curve[a->curves++];
    *c = *like;
    c->count = (size_t)count;
    c->x = malloc((size_t)count*sizeof *c->x);
    c->y = malloc((size_t)count*sizeof *c->y);
    if (!c->x || !c->y) exit(complain("out of memory"));
    for (int k = 0; k < count; k++) {
        const int64_t i = (int64_t)line*count + k;
        c->x[k] = s->places.way[i];
        c->y[k] = values[n*i + q->part] + (more ? times*more[n*i + q->part] : 0);
    }
}

static void fill_panel(const sample_run *s, const quantity *q, char labels[][48], panel *a)
{
    const sample_field *f = &s->field[q->field];
    const char *part = sample_component(f->components, q->part);
    const int mean = s->options->mean, lines = s->options->line_count;
    char name[80];
    snprintf(name, sizeof name, "%.60s%s%s", f->name, *part ? "_" : "", part);
    picture_label(a, tr(name), f->unit);
    for (int k = 0; k < (mean ? 1 : s->shown_count); k++) {
        double *rms, *values = copy_values(s, q->field, mean ? -1 : k, &rms);
        for (int l = 0; l < lines; l++) {
            const int number = lines > 1 ? l : k;
            const curve like = { .label = labels[number], .colour = number };
            curve band = { .label = tr("mean +- rms"), .style = CURVE_DASHED, .colour = 6 };
            add_curve(s, a, &like, q, l, values, NULL, 0);
            for (int side = -1; mean && lines == 1 && side <= 1; side += 2, band.label = "")
                add_curve(s, a, &band, q, l, values, rms, side);
        }
        free(values);
        free(rms);
    }
}

/* What a picture shows first: components that are not zero throughout. */
static int is_shown(const sample_run *s, const quantity *q)
{
    int found = 0;
    const int n = s->field[q->field].components;
    for (int k = 0; k < (s->options->mean ? 1 : s->shown_count) && !found; k++) {
        double *rms, *values = copy_values(s, q->field, s->options->mean ? -1 : k, &rms);
        for (int64_t i = 0; i < s->places.count; i++)
            found |= isfinite(values[n*i + q->part]) && values[n*i + q->part] != 0;
        free(values);
        free(rms);
    }
    return found;
}

static void make_labels(const sample_run *s, char labels[][48])
{
    const sample_options *o = s->options;
    for (int k = 0; k < CURVE_LIMIT; k++) {
        if (o->line_count > 1)
            snprintf(labels[k], sizeof *labels, "%.47s", k < o->line_count ? o->line[k] : "");
        else if (o->mean) snprintf(labels[k], sizeof *labels, "%s", tr("mean"));
        else snprintf(labels[k], sizeof *labels, "%.4g s", k < s->shown_count ? s->shown[k].time : 0);
    }
}

static void fill_picture(const sample_run *s, char labels[][48], picture *p)
{
    const sample_options *o = s->options;
    const double from = tobi_results_time(s->results, s->first);
    const double to = tobi_results_time(s->results, s->end - 1);
    make_labels(s, labels);
    if (o->mean) snprintf(p->title, sizeof p->title, tr("%s, means from %.4g to %.4g s"), s->name, from, to);
    else if (o->line_count > 1) snprintf(p->title, sizeof p->title, tr("%s at %.4g s"), s->name, to);
    else snprintf(p->title, sizeof p->title, tr("%s from %.48s"), s->name, o->line[0]);
    for (int64_t i = 0; i < s->places.count; i++) p->end = fmax(p->end, s->places.way[i]);
    for (int f = 0; f < s->field_count; f++)
        for (int part = 0; part < s->field[f].components && p->panels < PANEL_LIMIT; part++) {
            const quantity q = { f, part };
            if (is_shown(s, &q)) fill_panel(s, &q, labels, &p->panel[p->panels++]);
        }
}

int sample_draw(const sample_run *s)
{
    picture *p = calloc(1, sizeof *p);
    char labels[CURVE_LIMIT][48], name[96];
    char *folder = join_path(s->options->dir, "plots");
    int code = p ? make_series_folder(folder) : complain("out of memory");
    char *script = code ? NULL : clear_place(folder, "plots.gnuplot");
    FILE *out = script ? fopen(script, "wx") : NULL;
    if (!code && !out) code = complain("cannot write %s/plots.gnuplot: %s", folder, tr(strerror(errno)));
    if (out) {
        snprintf(name, sizeof name, "sample_%s.%s", s->name, s->options->format);
        p->x_label = tr("way along the line, m");
        fill_picture(s, labels, p);
        picture_begin_script(out, s->options->format);
        if (p->panels) picture_write(out, p, name);
        if (fclose(out) != 0) code = complain("cannot write %s: %s", script, tr(strerror(errno)));
        if (!code && p->panels) code = run_gnuplot(folder);
        if (!code && p->panels) printf(tr("picture: %s/%s\n"), folder, name);
        picture_free(p);
    }
    free(p);
    free(script);
    free(folder);
    return code;
}
