/* The pictures of a sweep: sweep.svg has a curve in time per run, sweep_means.svg the means over a value that
   was swept. Drawback: of many runs they show the first CURVE_LIMIT curves. */
#define _GNU_SOURCE
#include "sweep.h"
#include "digest.h"
#include "plot.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A column of a run: its table, of which rows, and what of each row. */
typedef struct found { table table; const char *body; sweep_reading reading; } found;

/* The rest of "BODY_column", NULL if the text does not begin with this name. */
static const char *cut_name(const char *text, const char *name)
{
    const size_t length = strlen(name);
    return strncmp(text, name, length) == 0 && text[length] == '_' ? text + length + 1 : NULL;
}

static int look_into(found *one, const char *column)
{
    const table *t = &one->table;
    const int name = t->columns ? table_column(t, "name") : -1;
    one->reading = (sweep_reading){ -1, -1 };
    if (name < 0) one->reading = sweep_find_reading(t, column);
    for (size_t i = 0; name >= 0 && i < t->rows && one->reading.first < 0; i++) {
        one->body = t->cells[i*(size_t)t->columns + (size_t)name];
        const char *rest = cut_name(column, one->body);
        if (rest) one->reading = sweep_find_reading(t, rest);
    }
    return one->reading.first >= 0;
}

/* The column of a run, or NEST/COLUMN, in the first of its tables that has it. The caller frees the table. */
static int find_column(const sweep *s, int run, const char *column, found *one)
{
    enum { TABLES = 7 };
    static const char *const from[TABLES] = { "probes.csv", "lines.csv", "joints.csv", "porous_zones.csv",
                                              "scalars.csv", "history.csv", "bodies.csv" };
    const char *slash = strchr(column, '/');
    const int length = slash ? (int)(slash - column) : 0;
    char *name = sweep_name(s, run);
    int there = 0;
    for (int f = 0; f < TABLES && !there; f++) {
        char *path = sweep_path(s, "%s%s%.*s/%s", name, slash ? "/nests/" : "", length, column, from[f]);
        *one = (found){ 0 };
        if (access(path, F_OK) != 0 || table_read(&one->table, path) != 0) one->table = (table){ 0 };
        table_strip_units(&one->table);
        digest_add_power(&one->table);
        there = look_into(one, slash ? slash + 1 : column);
        if (!there) table_free(&one->table);
        free(path);
    }
    free(name);
    return there;
}

/* A curve with room for so many points, NULL where a panel is full. */
static curve *add_curve(panel *a, const char *label, size_t room)
{
    if (a->curves == CURVE_LIMIT) return NULL;
    curve *c = &a->curve[a->curves++];
    *c = (curve){ .label = label };
    c->x = calloc(room + 1, sizeof(double)), c->y = calloc(room + 1, sizeof(double));
    if (!c->x || !c->y) exit(complain("out of memory"));
    return c;
}

static void add_point(curve *c, picture *p, double x, double y)
{
    c->x[c->count] = x;
    c->y[c->count++] = y;
    p->begin = fmin(p->begin, x);
    p->end = fmax(p->end, x);
}

static void add_run(const sweep *s, int run, const char *column, const char *label, panel *a, picture *p)
{
    found one;
    if (!find_column(s, run, column, &one)) return;
    const table *t = &one.table;
    const int time = table_column(t, "time");
    const sweep_reading r = one.reading;
    curve *c = add_curve(a, label, t->rows);
    if (c) c->colour = run, c->style = run < 8 ? CURVE_LINE : CURVE_DASHED;
    for (size_t i = 0; c && i < t->rows; i++)
        if (digest_belongs(t, one.body, i))
            add_point(c, p, table_number(t, i, time),
                      table_number(t, i, r.first) + (r.second >= 0 ? table_number(t, i, r.second) : 0));
    table_free(&one.table);
}

/* The first axis with several values, all of them numbers; -1: there is none. */
static int find_number_axis(const sweep *s)
{
    for (int k = 0; k < s->axis_count; k++) {
        int numbers = s->axes[k].count > 1;
        for (int v = 0; v < s->axes[k].count && numbers; v++) {
            char *end;
            const double value = strtod(s->axes[k].value[v], &end);
            numbers = *end == '\0' && isfinite(value);
        }
        if (numbers) return k;
    }
    return -1;
}

/* Runs that differ in the axis alone share a curve, which the others' values name. The caller frees it. */
static char *name_without(const sweep *s, int run, int axis)
{
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    if (!out) exit(complain("out of memory"));
    for (int k = 0; k < s->axis_count; k++)
        if (k != axis && s->axes[k].count > 1)
            fprintf(out, "%s%s=%s", ftell(out) > 0 ? " " : "", s->axes[k].label, sweep_value(s, run, k));
    if (ftell(out) == 0) fputs(tr("mean"), out);
    if (fclose(out) != 0) exit(complain("out of memory"));
    return text;
}

static void add_mean(const sweep *s, int run, int axis, const char *column, char *label, panel *a, picture *p)
{
    found one;
    curve *c = NULL;
    if (!find_column(s, run, column, &one)) return;
    const digest d = digest_column(&one.table, one.body, one.reading.first, one.reading.second, s->from);
    for (int k = 0; k < a->curves; k++)
        if (strcmp(a->curve[k].label, label) == 0) c = &a->curve[k];
    if (!c && d.rows > 0 && (c = add_curve(a, label, (size_t)s->axes[axis].count)))
        c->colour = a->curves - 1, c->style = CURVE_POINTS;
    if (c && d.rows > 0) add_point(c, p, strtod(sweep_value(s, run, axis), NULL), d.mean);
    table_free(&one.table);
}

/* What is drawn without --plot: the first sensors; kinetic energy and speed where there are none. */
static int choose_columns(const sweep *s, const char *column[PANEL_LIMIT], table **keep)
{
    int count = 0;
    *keep = sweep_read_all(s, "probes.csv", 0);
    if (s->plot) return column[0] = s->plot, 1;
    const table *probes = sweep_first_table(*keep, s->runs);
    for (int k = 1; probes && k < probes->columns && count < PANEL_LIMIT; k++)
        if (!strstr(probes->names[k], "_velocity_")) column[count++] = probes->names[k];
    if (count) return count;
    column[0] = "kinetic_energy";
    column[1] = "speed_max";
    return 2;
}

static int complain_column(const sweep *s)
{
    complain("no run has a column \"%s\" in probes.csv, lines.csv, joints.csv, porous_zones.csv, "
             "scalars.csv, history.csv, nor is it one of bodies.csv behind the name of a body, as in "
             "BODY_position_x; nothing is drawn", s->plot);
    return EXIT_ERROR;
}

/* axis -1: curves in time. Returns how many curves there are. */
static int fill_picture(const sweep *s, picture *p, int axis, const char *const column[], int columns,
                        char **label)
{
    const int dimension = sweep_dimension(s);
    int curves = 0;
    *p = (picture){ .begin = INFINITY, .end = -INFINITY, .x_label = axis < 0 ? NULL : s->axes[axis].label };
    snprintf(p->title, sizeof p->title, "%s", s->dir);
    for (int k = 0; k < columns; k++) {
        panel *a = &p->panel[p->panels];
        char what[80];
        snprintf(what, sizeof what, "%s%.60s", axis < 0 ? "" : tr("mean "), column[k]);
        picture_label(a, what, plot_unit(column[k], dimension));
        for (int run = 0; run < s->runs; run++)
            if (axis < 0) add_run(s, run, column[k], label[run], a, p);
            else add_mean(s, run, axis, column[k], label[run], a, p);
        curves += a->curves;
        p->panels += a->curves > 0;
    }
    const double margin = axis < 0 ? 0 : 0.05*(p->end - p->begin);      /* points of means are not cut */
    p->begin -= margin;
    p->end += margin;
    return curves;
}

/* Both pictures, by one script. */
static int draw_pictures(const sweep *s, const picture *of_time, const picture *of_means)
{
    char *script = clear_place(s->dir, "plots.gnuplot");
    FILE *out = script ? fopen(script, "wx") : NULL;
    if (!out) {
        const int code = complain("cannot write %s: %s", script ? script : s->dir, tr(strerror(errno)));
        free(script);
        return code;
    }
    free(script);
    picture_begin_script(out, "svg");
    picture_write(out, of_time, "sweep.svg");
    if (of_means->panels) picture_write(out, of_means, "sweep_means.svg");
    fclose(out);
    return run_gnuplot(s->dir);
}

int sweep_draw(const sweep *s)
{
    picture of_time, of_means = { 0 };
    const char *column[PANEL_LIMIT];
    table *keep;
    const int columns = choose_columns(s, column, &keep), axis = find_number_axis(s);
    char **names = calloc((size_t)s->runs, sizeof *names), **rest = calloc((size_t)s->runs, sizeof *rest);
    int code = 0;
    if (!names || !rest) exit(complain("out of memory"));
    for (int run = 0; run < s->runs; run++) {
        names[run] = sweep_name(s, run);
        if (axis >= 0) rest[run] = name_without(s, run, axis);
    }
    const int drawn = fill_picture(s, &of_time, -1, column, columns, names);
    const int means = axis >= 0 && drawn ? fill_picture(s, &of_means, axis, column, columns, rest) : 0;
    if (!drawn && s->plot) code = complain_column(s);
    if (drawn) code = draw_pictures(s, &of_time, &of_means);
    if (drawn && !code) printf(tr("%s/sweep.svg shows %s of all runs\n"), s->dir, column[0]);
    if (means && !code)
        printf(tr("%s/sweep_means.svg shows its mean over %s\n"), s->dir, s->axes[axis].label);
    for (int run = 0; run < s->runs; run++) free(names[run]), free(rest[run]);
    picture_free(&of_time);
    picture_free(&of_means);
    sweep_free_tables(keep, s->runs);
    free(names);
    free(rest);
    return code;
}
