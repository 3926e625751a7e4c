/* tobiuo waves DIR: what the gauges of a run tell about its waves (decision 143). Drawback: waves are
   long-crested and those of linear theory. */
#define _GNU_SOURCE
#include "app.h"
#include "picture.h"
#include "table.h"
#include "waves.h"
#include <errno.h>
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { RECORD_LIMIT = 20000 };
static const double MUCH_BACK = 1.5;   /* of the waves that go on: a wall sends back no more than all */

enum { KEY_FROM = KEY_OWN, KEY_END, KEY_DEPTH };

static const struct argp_option options[] = {
    { "gauges", 'g', "A,B,...", 0, "sensors in line, from the side that waves come from: tell the "
      "waves that go on and those that come back; may be repeated, behind a breakwater", 0 },
    { "response", 'r', "NAME", 0, "how a body, or a column of probes.csv, lines.csv or joints.csv, follows "
      "the waves: significant value, gain, phase; may be repeated", 0 },
    { "from", KEY_FROM, "S", 0, "use levels from this time on, s (the start)", 0 },
    { "until", KEY_END, "S", 0, "and up to this time, s (the end)", 0 },
    { "depth", KEY_DEPTH, "M", 0, "of the water at the gauges, m (from the floor of the domain)", 0 },
    { "format", 'f', "FORMAT", 0, "of the picture: svg (default) or png", 0 },
    { 0 }
};

static error_t parse(int key, char *value, struct argp_state *state)
{
    wave_options *o = state->input;
    switch (key) {
    case 'g':
        if (o->group_count == GROUPS) usage_error(state, tr("--gauges: at most %d times"), GROUPS);
        o->groups[o->group_count++] = value;
        break;
    case 'r':
        if (o->response_count == RESPONSES) usage_error(state, tr("--response: at most %d times"), RESPONSES);
        o->responses[o->response_count++] = value;
        break;
    case 'f':
        if (strcmp(value, "svg") != 0 && strcmp(value, "png") != 0)
            usage_error(state, tr("--format: '%s' is neither svg nor png"), value);
        o->format = value;
        break;
    case KEY_FROM: o->from = parse_time(state, "--from", value); break;
    case KEY_END: o->until = parse_time(state, "--until", value); break;
    case KEY_DEPTH: o->depth = parse_positive(state, "--depth", value); break;
    default: return parse_argument(state, key, value, "DIR", &o->dir);
    }
    return 0;
}

/* --- reading --- */

static double item(const json_t *list, int k) { return json_number_value(json_array_get(list, (size_t)k)); }

static int read_scene(wave_run *w)
{
    char *path = join_path(w->options->dir, "resolved.json");
    json_error_t err;
    w->scene = json_load_file(path, 0, &err);
    const int code = w->scene ? 0 : complain("%s: %s", path, err.text);
    free(path);
    if (code) return code;
    const json_t *gravity = json_object_get(w->scene, "gravity");
    w->dimension = json_integer_value(json_object_get(w->scene, "dimension")) == 2 ? 2 : 3;
    for (int a = 0; a < 3; a++)
        if (fabs(item(gravity, a)) > fabs(item(gravity, w->up))) w->up = a;
    w->set.gravity = fabs(item(gravity, w->up));
    return w->set.gravity > 0 ? 0 : complain("%s: there are no waves without gravity", w->options->dir);
}

/* The place of a sensor; 0: the scene has none of this name. */
static int find_place(const wave_run *w, const char *name, double place[3])
{
    const json_t *probes = json_object_get(w->scene, "probes");
    for (size_t k = 0; k < json_array_size(probes); k++) {
        const json_t *probe = json_array_get(probes, k);
        const char *own = json_string_value(json_object_get(probe, "name"));
        if (!own || strcmp(own, name) != 0) continue;
        for (int a = 0; a < 3; a++) place[a] = item(json_object_get(probe, "position"), a);
        return 1;
    }
    return 0;
}

/* The gauges among the columns, which get the names of their sensors; without records. */
static int find_gauges(wave_run *w)
{
    wave_set *s = &w->set;
    s->gauge = calloc((size_t)w->levels.columns + 1, sizeof *s->gauge);
    if (!s->gauge) return complain("out of memory");
    for (int k = 0; k < w->levels.columns; k++) {
        char *end = strrchr(w->levels.names[k], '_');
        wave_gauge g = { .name = w->levels.names[k], .column = k };
        if (!end || strcmp(end, "_level") != 0) continue;
        *end = '\0';
        if (find_place(w, g.name, g.place)) s->gauge[s->gauges++] = g;
    }
    return s->gauges ? 0 : complain("%s has no sensors of the kind level", w->options->dir);
}

static int is_in(const wave_run *w, size_t row, int column)
{
    const double time = table_number(&w->levels, row, table_column(&w->levels, "time"));
    return isfinite(table_number(&w->levels, row, column)) && time >= w->options->from &&
           time <= w->options->until;
}

/* The span of time that all gauges have, and its rows: as many as the gauge with the fewest has. */
static int find_span(wave_run *w)
{
    wave_set *s = &w->set;
    double begin = -INFINITY, end = INFINITY;
    size_t rows = RECORD_LIMIT;
    for (int g = 0; g < s->gauges; g++) {
        const int column = s->gauge[g].column;
        double first = INFINITY, last = -INFINITY;
        size_t count = 0;
        for (size_t i = 0; i < w->levels.rows; i++) {
            if (!is_in(w, i, column)) continue;
            last = table_number(&w->levels, i, table_column(&w->levels, "time"));
            if (count++ == 0) first = last;
        }
        begin = fmax(begin, first);
        end = fmin(end, last);
        if (count < rows) rows = count;
    }
    if (rows < 8 || !(end > begin))
        return complain("%s/probes.csv has fewer than 8 levels in the time that is asked for",
                        w->options->dir);
    s->begin = begin;
    s->count = rows;
    s->step = (end - begin)/(double)(rows - 1);
    return 0;
}

/* Linear between the rows. */
static int read_record(wave_run *w, wave_gauge *g)
{
    const int time = table_column(&w->levels, "time");
    const double slack = 1e-9*w->set.step;
    double before = NAN, was = NAN;
    size_t n = 0;
    g->eta = calloc(w->set.count, sizeof *g->eta);
    if (!g->eta) return complain("out of memory");
    for (size_t i = 0; i < w->levels.rows && n < w->set.count; i++) {
        const double t = table_number(&w->levels, i, time), level = table_number(&w->levels, i, g->column);
        if (!isfinite(level)) continue;
        for (; n < w->set.count; n++) {
            const double at = w->set.begin + (double)n*w->set.step;
            if (at > t + slack) break;
            g->eta[n] = isnan(before) || t <= before ? level : was + (level - was)*(at - before)/(t - before);
        }
        before = t, was = level;
    }
    for (; n < w->set.count; n++) g->eta[n] = was;      /* the last, by rounding */
    return 0;
}

static int read_levels(wave_run *w)
{
    char *path = join_path(w->options->dir, "probes.csv");
    const int missing = access(path, F_OK) != 0;
    int code = missing ? complain_run(w->options->dir, tr("there are no sensors (no probes.csv)"))
        : table_read(&w->levels, path) != 0 ? EXIT_ERROR : 0;
    free(path);
    table_strip_units(&w->levels);
    if (!code && table_column(&w->levels, "time") < 0)
        code = complain("%s/probes.csv has no column \"time\"", w->options->dir);
    if (!code) code = read_scene(w);
    if (!code) code = find_gauges(w);
    if (!code) code = find_span(w);
    for (int g = 0; g < w->set.gauges && !code; g++) code = read_record(w, &w->set.gauge[g]);
    return code;
}

/* --- groups --- */

static int find_gauge(const wave_run *w, const char *name, size_t length)
{
    for (int g = 0; g < w->set.gauges; g++) {
        const char *own = w->set.gauge[g].name;
        if (strlen(own) == length && strncmp(own, name, length) == 0) return g;
    }
    return -1;
}

static int read_group(wave_run *w, int group)
{
    const char *text = w->options->groups[group];
    for (const char *name = text; name; name = strchr(name, ',') ? strchr(name, ',') + 1 : NULL) {
        const size_t length = strcspn(name, ",");
        const int g = find_gauge(w, name, length);
        if (g < 0)
            return complain("--gauges %s: there is no sensor '%.*s' of the kind level", text, (int)length,
                            name);
        for (int k = 0; k < w->members[group]; k++)
            if (w->group[group][k] == g)
                return complain("--gauges %s: '%.*s' is there twice", text, (int)length, name);
        if (w->members[group] == MEMBERS) return complain("--gauges %s: at most %d gauges", text, MEMBERS);
        w->group[group][w->members[group]++] = g;
    }
    return w->members[group] > 1 ? 0 : complain("--gauges %s: at least two gauges", text);
}

int waves_line_up(const wave_run *w, int group, double at[MEMBERS], double way[3])
{
    const int *g = w->group[group], count = w->members[group];
    const double *first = w->set.gauge[g[0]].place, *last = w->set.gauge[g[count - 1]].place;
    double length = 0, off = 0;
    for (int a = 0; a < 3; a++) way[a] = a == w->up ? 0 : last[a] - first[a], length += way[a]*way[a];
    length = sqrt(length);
    if (!(length > 0))
        return complain("--gauges %s: the first and the last stand at one place", w->options->groups[group]);
    for (int a = 0; a < 3; a++) way[a] /= length;
    for (int k = 0; k < count; k++) {
        double square = 0;
        at[k] = 0;
        for (int a = 0; a < 3; a++) {
            const double arm = a == w->up ? 0 : w->set.gauge[g[k]].place[a] - first[a];
            at[k] += arm*way[a];
            square += arm*arm;
        }
        off = fmax(off, sqrt(fmax(0, square - at[k]*at[k])));
    }
    return off <= 0.02*length ? 0
        : complain("--gauges %s: they do not stand in a line; one is %.3g m off", w->options->groups[group],
                   off);
}

static int split_group(wave_run *w, int group)
{
    double at[MEMBERS], way[3];
    int code = waves_line_up(w, group, at, way);
    if (code) return code;
    if (wave_split(&w->set, w->group[group], at, w->members[group], &w->result[group]) != 0)
        return complain("--gauges %s: they cannot tell waves of %.3g s, %.3g m long, apart; two of "
                        "them must be 0.05 to 0.45 wave lengths apart", w->options->groups[group],
                        1/w->set.peak, wave_length(w->set.peak, w->set.depth, w->set.gravity));
    if (w->result[group].resolved < 0.8)
        fprintf(stderr, tr("tobiuo: note: --gauges %s: only %.0f %% of the energy is of frequencies that "
                "they tell apart\n"), w->options->groups[group], 100*w->result[group].resolved);
    if (w->result[group].back > MUCH_BACK*w->result[group].forward)
        fprintf(stderr, tr("tobiuo: note: --gauges %s: more comes back than goes on; name the gauges in the "
                "direction of the waves that arrive\n"), w->options->groups[group]);
    return 0;
}

/* --- what is told --- */

/* Waves that are still growing make all figures too small. */
static void note_growth(const wave_run *w)
{
    const wave_set *s = &w->set;
    for (int g = 0; g < s->gauges; g++) {
        double early = 0, late = 0;
        for (size_t n = 0; n < s->count; n++) {
            const double square = s->gauge[g].eta[n]*s->gauge[g].eta[n];
            if (4*n < s->count) early += square/((double)s->count/4);
            else late += square/((double)s->count*3/4);
        }
        if (early >= 0.36*late) continue;
        fprintf(stderr, tr("tobiuo: note: waves at %s are %.2g times as high in the first quarter of the "
                "time as later; --from leaves it out\n"), s->gauge[g].name, sqrt(early/late));
        return;
    }
}

/* Of so few periods the waves that come back are not told from those that go on: a tank's 0.2 became 0.5. */
static const double FEW_PERIODS = 4;

static void note_shortness(const wave_run *w)
{
    const double periods = w->set.peak*(double)w->set.count*w->set.step;
    if (w->options->group_count > 0 && periods < FEW_PERIODS)
        fprintf(stderr, tr("tobiuo: note: --gauges: %.3g periods of the waves; reflection and transmission "
                "of fewer than %g are rough\n"), periods, FEW_PERIODS);
}

/* Columns of both tables. */
static const struct gauge_column { const char *name, *unit; size_t offset; } columns[] = {
    { "H_m0", "m", offsetof(wave_gauge, height_m0) }, { "H_third", "m", offsetof(wave_gauge, height_third) },
    { "H_max", "m", offsetof(wave_gauge, height_max) }, { "T_p", "s", offsetof(wave_gauge, peak_period) },
    { "T_mean", "s", offsetof(wave_gauge, mean_period) },
    { "T_energy", "s", offsetof(wave_gauge, energy_period) },
    { "mean_level", "m", offsetof(wave_gauge, mean) },
};
enum { COLUMNS = sizeof columns/sizeof *columns };

static double number_of(const wave_gauge *g, int column)
{
    return *(const double *)((const char *)g + columns[column].offset);
}

static int width_of(int column)
{
    const int length = (int)strlen(columns[column].name) + 2;
    return length > 9 ? length : 9;
}

static void print_tables(const wave_run *w)
{
    enum { GAUGES = 24 };
    const wave_set *s = &w->set;
    printf(tr("waves from %.4g to %.4g s, %.3g m deep, %.3g s and %.3g m long at the peak\n"), s->begin,
           s->begin + ((double)s->count - 1)*s->step, s->depth, 1/s->peak,
           wave_length(s->peak, s->depth, s->gravity));
    print_columns(stdout, tr("gauge"), 12);
    for (int k = 0; k < COLUMNS; k++) printf("  %*s %s", width_of(k) - 2, columns[k].name, columns[k].unit);
    printf("  %s\n", tr("waves"));
    for (int g = 0; g < s->gauges; g++) {
        printf("%-12s", s->gauge[g].name);
        for (int k = 0; k < COLUMNS; k++) printf("  %*.4g", width_of(k), number_of(&s->gauge[g], k));
        printf("  %5d\n", s->gauge[g].waves);
    }
    if (w->options->group_count == 0) {
        printf(tr("--gauges A,B,C tells the waves that go on from A to C, and those that come back\n"));
        return;
    }
    print_columns(stdout, tr("gauges"), GAUGES);
    printf("  ");
    puts(tr("on, H_m0 m  back, H_m0 m  reflection  transmission"));
    for (int k = 0; k < w->options->group_count; k++) {
        const wave_group *r = &w->result[k];
        printf("%-*s  %10.4g  %12.4g  %10.3g", GAUGES, w->options->groups[k], r->forward, r->back,
               r->back/r->forward);
        if (k > 0) printf("  %12.3g", r->forward/w->result[0].forward);
        putchar('\n');
    }
}

static void write_gauges(FILE *out, const void *what)
{
    const wave_run *w = what;
    fputs("gauge,x [m],y [m],z [m]", out);
    for (int k = 0; k < COLUMNS; k++) fprintf(out, ",%s [%s]", columns[k].name, columns[k].unit);
    fputs(",waves\n", out);
    for (const wave_gauge *g = w->set.gauge; g < w->set.gauge + w->set.gauges; g++) {
        fprintf(out, "%s,%.9g,%.9g,%.9g", g->name, g->place[0], g->place[1], g->place[2]);
        for (int k = 0; k < COLUMNS; k++) {
            if (isfinite(number_of(g, k))) fprintf(out, ",%.9g", number_of(g, k));
            else fputc(',', out);
        }
        fprintf(out, ",%d\n", g->waves);
    }
}

static void write_groups(FILE *out, const void *what)
{
    const wave_run *w = what;
    fputs("gauges,H_m0_on [m],H_m0_back [m],reflection,transmission,resolved\n", out);
    for (int k = 0; k < w->options->group_count; k++) {
        const wave_group *r = &w->result[k];
        for (int n = 0; n < w->members[k]; n++)
            fprintf(out, "%s%s", n ? " " : "", w->set.gauge[w->group[k][n]].name);
        fprintf(out, ",%.9g,%.9g,%.9g,%.9g,%.9g\n", r->forward, r->back, r->back/r->forward,
                r->forward/w->result[0].forward, r->resolved);
    }
}

static void write_spectra(FILE *out, const void *what)
{
    const wave_run *w = what;
    const wave_set *s = &w->set;
    fputs("frequency [Hz]", out);
    for (int g = 0; g < s->gauges; g++) fprintf(out, ",%s_density [m2/Hz]", s->gauge[g].name);
    for (size_t k = 0; k < s->bins; k++) {
        fprintf(out, "\n%.9g", (double)(k + 1)/((double)s->count*s->step));
        for (int g = 0; g < s->gauges; g++) fprintf(out, ",%.9g", s->gauge[g].density[k]);
    }
    fputc('\n', out);
}

int waves_write_table(const wave_run *w, const char *name, wave_table_writer *write,
                      const void *what)
{
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    if (!out) return complain("out of memory");
    write(out, what);
    if (fclose(out) != 0) return complain("out of memory");
    char *path = clear_place(w->options->dir, name);
    const int code = path ? write_new(path, text, size) : EXIT_ERROR;
    if (!code) printf("%s\n", path);
    free(path);
    free(text);
    return code;
}

void waves_add_curve(const wave_run *w, panel *a, const char *label, const double *value, size_t stride)
{
    const wave_set *s = &w->set;
    if (a->curves == CURVE_LIMIT) return;
    const int colour = a->curves++;
    curve *c = &a->curve[colour];
    *c = (curve){ .label = label, .colour = colour, .style = colour < 7 ? CURVE_LINE : CURVE_DASHED,
                  .count = s->bins, .x = calloc(s->bins, sizeof(double)),
                  .y = calloc(s->bins, sizeof(double)) };
    if (!c->x || !c->y) exit(complain("out of memory"));
    for (size_t k = 0; k < s->bins; k++)
        c->x[k] = (double)(k + 1)/((double)s->count*s->step), c->y[k] = value[k*stride];
}

int waves_draw(const wave_run *w, const picture *p, const char *name)
{
    char *folder = join_path(w->options->dir, "plots"), file[64];
    int code = make_series_folder(folder);
    char *script = code ? NULL : clear_place(folder, "plots.gnuplot");
    FILE *out = script ? fopen(script, "wx") : NULL;
    snprintf(file, sizeof file, "%s.%s", name, w->options->format);
    if (out) {
        picture_begin_script(out, w->options->format);
        picture_write(out, p, file);
        if (fclose(out) != 0) code = complain("cannot write %s: %s", script, tr(strerror(errno)));
        if (!code) code = run_gnuplot(folder);
        if (!code) printf("%s/%s\n", folder, file);
    } else if (!code) code = complain("cannot write %s/plots.gnuplot: %s", folder, tr(strerror(errno)));
    free(script);
    free(folder);
    return code;
}

/* Spectra, up to three times the peak. */
static int draw_spectra(const wave_run *w)
{
    const wave_set *s = &w->set;
    picture p = { .panels = 1, .x_label = tr("frequency, Hz"), .end = 3*s->peak };
    snprintf(p.title, sizeof p.title, "%s", tr("Spectra of the waves"));
    snprintf(p.panel[0].y_label, sizeof p.panel[0].y_label, "%s", tr("density, m2/Hz"));
    for (int g = 0; g < s->gauges; g++)
        waves_add_curve(w, &p.panel[0], s->gauge[g].name, s->gauge[g].density, 1);
    const int code = waves_draw(w, &p, "wave_spectra");
    picture_free(&p);
    return code;
}

static int analyse(wave_run *w)
{
    const wave_options *o = w->options;
    int code = read_levels(w);
    for (int k = 0; k < o->group_count && !code; k++) code = read_group(w, k);
    if (code) return code;
    const int found = wave_measure(&w->set);
    if (found < 0) return complain("out of memory");
    if (found > 0) return complain("%s: there is no whole wave in the time that is asked for", o->dir);
    double mean = 0;
    for (int g = 0; g < w->set.gauges; g++) mean += w->set.gauge[g].mean/w->set.gauges;
    const json_t *floor = json_object_get(json_object_get(w->scene, "domain"), "min");
    w->set.depth = o->depth > 0 ? o->depth : mean - item(floor, w->up);
    if (!(w->set.depth > 0))
        return complain("%s: the water has no depth at the gauges; give --depth", o->dir);
    note_growth(w);
    note_shortness(w);
    for (int k = 0; k < o->group_count && !code; k++) code = split_group(w, k);
    if (code) return code;
    print_tables(w);
    code = waves_write_table(w, "waves.csv", write_gauges, w);
    if (!code && o->group_count) code = waves_write_table(w, "wave_groups.csv", write_groups, w);
    if (!code) code = waves_write_table(w, "wave_spectra.csv", write_spectra, w);
    if (!code) code = draw_spectra(w);
    return code ? code : tell_responses(w);
}

const struct argp waves_argp = { .options = options, .parser = parse, .args_doc = "DIR",
    .doc = "Analyse the levels of the run in DIR: significant heights, periods and spectra of its waves, and "
           "the waves that come back from a wall or go on behind a breakwater, and how bodies and moorings "
           "follow them. Gnuplot draws spectra and gains." };

int tobiuo_waves(int argc, char **argv)
{
    wave_options o = { .format = "svg", .until = INFINITY };
    parse_arguments(&waves_argp, argc, argv, &o);
    wave_run w = { .options = &o };
    const int code = analyse(&w);
    wave_set_free(&w.set);
    table_free(&w.levels);
    json_decref(w.scene);
    return code;
}
