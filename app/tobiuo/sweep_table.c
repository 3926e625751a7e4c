/* The table and the plot of a sweep: a row per run, in sweep.csv and, aligned, in sweep.txt and on the
   screen; one picture with a curve per run. Drawback: of many runs the plot shows the first CURVE_LIMIT. */
#define _GNU_SOURCE
#include "sweep.h"
#include "plot.h"
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Numbers of summary.json. */
static const struct { const char *key, *unit; } numbers[] = {
    { "time", "s" }, { "steps", "" }, { "fluid_particles", "" }, { "step_wall_s", "s" },
    { "density_iterations_mean", "" }, { "divergence_iterations_mean", "" }, { "density_error_mean", "" },
    { "unconverged_steps", "" }, { "particles_lost", "" },
};
enum { NUMBERS = sizeof numbers/sizeof *numbers };

/* A table of texts, row 0 its names, filled cell by cell. */
typedef struct grid { char **cell; int columns, rows, used; } grid;

static void add_cell(grid *g, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void add_cell(grid *g, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    char *text = NULL;
    if (vasprintf(&text, format, args) < 0) exit(complain("out of memory"));
    va_end(args);
    g->cell[g->used++] = text;
}

/* A table of all runs; empty where there is none. units: left in the names. */
static table *read_all(const sweep *s, const char *file, int units)
{
    table *list = calloc((size_t)s->runs, sizeof *list);
    if (!list) exit(complain("out of memory"));
    for (int run = 0; run < s->runs; run++) {
        char *name = sweep_name(s, run), *path = sweep_path(s, "%s/%s", name, file);
        if (access(path, F_OK) == 0) table_read(&list[run], path);
        if (!units) table_strip_units(&list[run]);
        free(path);
        free(name);
    }
    return list;
}

static void free_tables(table *list, int count)
{
    for (int k = 0; k < count; k++) table_free(&list[k]);
    free(list);
}

/* The table has the largest and the least value of such a column. body: of its rows; NULL: of all. */
typedef struct measure { int file; const char *body, *column; } measure;

enum { FILES = 6, BODIES = FILES - 1, MEASURES = 600, ALL = FILES*(1 + TOBI_NEST_LIMIT) };
static const char *const files[FILES] = { "probes.csv", "lines.csv", "joints.csv", "porous_zones.csv",
                                          "scalars.csv", "bodies.csv" };

/* FILES of the scene, then of each nest. */
typedef struct measures {
    table *of[ALL];
    char nest[TOBI_NEST_LIMIT][64];
    int nests;
    measure one[MEASURES];
    int count;
} measures;

/* What is read of a row: a column, or the sum of two. */
typedef struct reading { int first, second; } reading;

/* force_x of a body is the sum that `tobiuo plot` draws: pressure and friction. first -1: no such column. */
static reading find_reading(const table *t, const char *column)
{
    char part[2][64];
    reading r = { t->columns ? table_column(t, column) : -1, -1 };
    if (r.first >= 0 || !t->columns || strncmp(column, "force_", 6) != 0) return r;
    snprintf(part[0], sizeof part[0], "mean_pressure_%s", column);
    snprintf(part[1], sizeof part[1], "mean_viscous_%s", column);
    r = (reading){ table_column(t, part[0]), table_column(t, part[1]) };
    return r.second < 0 ? (reading){ -1, -1 } : r;
}

static double read_number(const table *t, size_t row, reading r)
{
    return table_number(t, row, r.first) + (r.second >= 0 ? table_number(t, row, r.second) : 0);
}

static int is_of(const table *t, size_t row, const char *body)
{
    const int name = body ? table_column(t, "name") : -1;
    return !body || (name >= 0 && strcmp(t->cells[row*(size_t)t->columns + (size_t)name], body) == 0);
}

/* sign 1: the largest; -1: the least. */
static double extreme(const table *t, const measure *m, double sign)
{
    const reading r = find_reading(t, m->column);
    double most = NAN;
    for (size_t i = 0; r.first >= 0 && i < t->rows; i++) {
        const double value = read_number(t, i, r);
        if (is_of(t, i, m->body) && !isnan(value) && !(sign*value < sign*most)) most = value;
    }
    return most;
}

/* The first table with columns: all runs of a sweep have the same sensors unless they are swept. */
static const table *first_table(const table *list, int count)
{
    for (int k = 0; k < count; k++)
        if (list[k].columns) return &list[k];
    return NULL;
}

static void add_measure(measures *m, int file, const char *body, const char *column)
{
    if (m->count < MEASURES) m->one[m->count++] = (measure){ file, body, column };
}

static void find_body_measures(const sweep *s, measures *m, int file)
{
    static const char *const of_body[] = { "position_x", "position_y", "position_z",
                                           "force_x", "force_y", "force_z" };
    const table *t = first_table(m->of[file], s->runs);
    const int name = t ? table_column(t, "name") : -1;
    for (size_t i = 0; name >= 0 && i < t->rows; i++) {
        const char *body = t->cells[i*(size_t)t->columns + (size_t)name];
        if (i > 0 && strcmp(body, t->cells[name]) == 0) return;      /* the second output begins */
        for (int a = 0; a < 6; a++) {
            const measure one = { file, body, of_body[a] };
            if (extreme(t, &one, 1) > extreme(t, &one, -1)) add_measure(m, file, body, of_body[a]);
        }
    }
}

/* That of the first run that has begun; the caller frees it. */
static json_t *read_scene(const sweep *s)
{
    json_t *scene = NULL;
    for (int run = 0; run < s->runs && !scene; run++) {
        char *name = sweep_name(s, run), *path = sweep_path(s, "%s/resolved.json", name);
        scene = json_load_file(path, 0, NULL);
        free(path);
        free(name);
    }
    return scene;
}

static void find_nests(const sweep *s, measures *m)
{
    json_t *scene = read_scene(s);
    const json_t *list = json_object_get(scene, "nests");
    for (size_t k = 0; k < json_array_size(list) && m->nests < TOBI_NEST_LIMIT; k++) {
        const char *name = json_string_value(json_object_get(json_array_get(list, k), "name"));
        if (name) snprintf(m->nest[m->nests++], sizeof m->nest[0], "%s", name);
    }
    json_decref(scene);
}

/* Sensors, lines, joints, the places of bodies that move, and the forces on bodies; then those of nests. */
static void find_measures(const sweep *s, measures *m)
{
    const table *t;
    find_nests(s, m);
    for (int f = 0; f < FILES*(1 + m->nests); f++) {
        char path[128];
        if (f < FILES) snprintf(path, sizeof path, "%s", files[f]);
        else snprintf(path, sizeof path, "nests/%s/%s", m->nest[f/FILES - 1], files[f%FILES]);
        m->of[f] = read_all(s, path, 1);
        if (f%FILES == BODIES) find_body_measures(s, m, f);
        else
            for (int k = 1; (t = first_table(m->of[f], s->runs)) && k < t->columns; k++)
                add_measure(m, f, NULL, t->names[k]);
    }
}

static int find_dimension(const sweep *s)
{
    json_t *scene = read_scene(s);
    const int dimension = json_integer_value(json_object_get(scene, "dimension")) == 2 ? 2 : 3;
    json_decref(scene);
    return dimension;
}

static void add_head(const sweep *s, grid *g, const measures *m)
{
    add_cell(g, "run");
    for (int k = 0; k < s->axis_count; k++) add_cell(g, "%s", s->axes[k].label);
    add_cell(g, "outcome");
    for (int k = 0; k < NUMBERS; k++) {
        const char *unit = numbers[k].unit;
        add_cell(g, "%s%s%s%s", numbers[k].key, *unit ? " [" : "", unit, *unit ? "]" : "");
    }
    const int dimension = find_dimension(s);
    for (int sign = 1; sign >= -1; sign -= 2)
        for (const measure *one = m->one; one < m->one + m->count; one++) {
            const char *extremum = sign > 0 ? "max" : "min";
            const char *nest = one->file < FILES ? "" : m->nest[one->file/FILES - 1];
            const char *slash = *nest ? "/" : "";
            if (!one->body) add_cell(g, "%s %s%s%s", extremum, nest, slash, one->column);
            else add_cell(g, "%s %s%s%s_%s [%s]", extremum, nest, slash, one->body, one->column,
                          plot_unit(one->column, dimension));
        }
}

static void add_row(const sweep *s, grid *g, int run, const measures *m)
{
    json_t *summary = sweep_summary(s, run);
    const char *outcome = json_string_value(json_object_get(summary, "outcome"));
    add_cell(g, "%d", run);
    for (int k = 0; k < s->axis_count; k++) add_cell(g, "%s", sweep_value(s, run, k));
    add_cell(g, "%s", outcome ? outcome : summary ? "" : "not run");
    for (int k = 0; k < NUMBERS; k++) {
        const json_t *value = json_object_get(summary, numbers[k].key);
        if (json_is_number(value)) add_cell(g, "%.6g", json_number_value(value));
        else add_cell(g, "%s", "");
    }
    for (int sign = 1; sign >= -1; sign -= 2)
        for (const measure *one = m->one; one < m->one + m->count; one++) {
            const double value = extreme(&m->of[one->file][run], one, sign);
            if (isnan(value)) add_cell(g, "%s", "");
            else add_cell(g, "%.6g", value);
        }
    json_decref(summary);
}

void sweep_put_cell(FILE *out, const char *text)
{
    if (!strpbrk(text, ",\"\n")) {
        fputs(text, out);
        return;
    }
    fputc('"', out);
    for (; *text; text++) fputs(*text == '"' ? "\"\"" : (char[]){ *text, '\0' }, out);
    fputc('"', out);
}

static int width_of(const grid *g, int column)
{
    int width = 0;
    for (int row = 0; row < g->rows; row++) {
        const int length = (int)strlen(g->cell[row*g->columns + column]);
        if (length > width) width = length;
    }
    return width;
}

static int write_grid(const sweep *s, const grid *g, const char *file, int aligned)
{
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    if (!out) exit(complain("out of memory"));
    for (int row = 0; row < g->rows; row++) {
        for (int k = 0; k < g->columns; k++) {
            const char *cell = g->cell[row*g->columns + k];
            if (aligned) fprintf(out, "%s%*s", k ? "  " : "", width_of(g, k), cell);
            else if (k) fputc(',', out);
            if (!aligned) sweep_put_cell(out, cell);
        }
        fputc('\n', out);
    }
    if (fclose(out) != 0) exit(complain("out of memory"));
    char *path = clear_place(s->dir, file);
    const int code = path ? write_new(path, text, size) : EXIT_ERROR;
    free(path);
    free(text);
    return code;
}

/* Most columns of a wide table stay off the screen: what was set, what came out, and the maxima. */
static void print_short(const sweep *s, const grid *g)
{
    const int first = s->axis_count + 2, time = first + 3;
    for (int row = 0; row < g->rows; row++) {
        for (int k = 0; k < g->columns; k++) {
            if (k >= first && k != time && k != first + 1) continue;
            printf("%s%*s", k ? "  " : "", width_of(g, k), g->cell[row*g->columns + k]);
        }
        putchar('\n');
    }
}

int sweep_write_table(const sweep *s)
{
    measures m = { 0 };
    find_measures(s, &m);
    grid g = { .columns = s->axis_count + 2 + NUMBERS + 2*m.count, .rows = s->runs + 1 };
    g.cell = calloc((size_t)g.columns*(size_t)g.rows + 1, sizeof *g.cell);
    if (!g.cell) exit(complain("out of memory"));
    add_head(s, &g, &m);
    for (int run = 0; run < s->runs; run++) add_row(s, &g, run, &m);
    int code = write_grid(s, &g, "sweep.csv", 0);
    if (!code) code = write_grid(s, &g, "sweep.txt", 1);
    if (!code) print_short(s, &g);
    if (!code) printf(tr("%s/sweep.csv and sweep.txt have all columns\n"), s->dir);
    for (int k = 0; k < g.columns*g.rows; k++) free(g.cell[k]);
    free(g.cell);
    for (int f = 0; f < FILES*(1 + m.nests); f++) free_tables(m.of[f], s->runs);
    return code;
}

/* --- the plot ------------------------------------------------------------------------------ */

static void add_point(curve *c, picture *p, double time, double value)
{
    c->x[c->count] = time;
    c->y[c->count++] = value;
    p->begin = fmin(p->begin, time);
    p->end = fmax(p->end, time);
}

/* The rest of "BODY_column", NULL if the text does not begin with this name. */
static const char *cut_name(const char *text, const char *name)
{
    const size_t length = strlen(name);
    return strncmp(text, name, length) == 0 && text[length] == '_' ? text + length + 1 : NULL;
}

/* The column of a table, or of a body in it, as a curve; 0 if it has none. */
static int add_curve(const table *t, const char *column, const char *label, int run, panel *a, picture *p)
{
    const int time = t->columns ? table_column(t, "time") : -1;
    const int name = time < 0 ? -1 : table_column(t, "name");
    curve c = { .label = label, .colour = run, .style = run < 8 ? CURVE_LINE : CURVE_DASHED };
    if (time < 0 || a->curves == CURVE_LIMIT) return 0;
    c.x = calloc(t->rows + 1, sizeof(double)), c.y = calloc(t->rows + 1, sizeof(double));
    if (!c.x || !c.y) exit(complain("out of memory"));
    for (size_t i = 0; i < t->rows; i++) {
        const char *rest = column;
        if (name >= 0) rest = cut_name(column, t->cells[i*(size_t)t->columns + (size_t)name]);
        const reading r = rest ? find_reading(t, rest) : (reading){ -1, -1 };
        if (r.first >= 0) add_point(&c, p, table_number(t, i, time), read_number(t, i, r));
    }
    if (c.count) a->curve[a->curves++] = c;
    else free(c.x), free(c.y);
    return c.count > 0;
}

/* The column of a run, or NEST/COLUMN, from the first of its tables that has it. */
static int add_run(const sweep *s, int run, const char *column, panel *a, picture *p, char **name)
{
    enum { TABLES = 7 };
    static const char *const from[TABLES] = { "probes.csv", "lines.csv", "joints.csv", "porous_zones.csv",
                                              "scalars.csv", "history.csv", "bodies.csv" };
    const char *slash = strchr(column, '/');
    const int length = slash ? (int)(slash - column) : 0;
    int found = 0;
    for (int f = 0; f < TABLES && !found; f++) {
        table t = { 0 };
        char *path = sweep_path(s, "%s%s%.*s/%s", *name, slash ? "/nests/" : "", length, column, from[f]);
        if (access(path, F_OK) != 0 || table_read(&t, path) != 0) t = (table){ 0 };
        table_strip_units(&t);
        found = add_curve(&t, slash ? slash + 1 : column, *name, run, a, p);
        table_free(&t);
        free(path);
    }
    return found;
}

/* What is drawn without --plot: the first sensors; kinetic energy and speed where there are none. */
static int choose_columns(const sweep *s, const char *column[PANEL_LIMIT], table **keep)
{
    int count = 0;
    *keep = read_all(s, "probes.csv", 0);
    if (s->plot) return column[0] = s->plot, 1;
    const table *probes = first_table(*keep, s->runs);
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

int sweep_draw(const sweep *s)
{
    picture p = { .begin = INFINITY, .end = -INFINITY };
    const char *column[PANEL_LIMIT];
    table *keep;
    const int columns = choose_columns(s, column, &keep);
    char **names = calloc((size_t)s->runs, sizeof *names), *script = NULL;
    if (!names) exit(complain("out of memory"));
    const int dimension = find_dimension(s);
    int drawn = 0, code = 0;
    snprintf(p.title, sizeof p.title, "%s", s->dir);
    for (int run = 0; run < s->runs; run++) names[run] = sweep_name(s, run);
    for (int k = 0; k < columns; k++) {
        panel *a = &p.panel[p.panels];
        const char *unit = plot_unit(column[k], dimension);
        snprintf(a->y_label, sizeof a->y_label, "%s%s%s", column[k], *unit ? ", " : "", unit);
        for (int run = 0; run < s->runs; run++) drawn += add_run(s, run, column[k], a, &p, &names[run]);
        p.panels += a->curves > 0;
    }
    if (!drawn && s->plot) code = complain_column(s);
    script = drawn ? clear_place(s->dir, "plots.gnuplot") : NULL;
    FILE *out = script ? fopen(script, "wx") : NULL;
    if (drawn && !out) code = complain("cannot write %s: %s", script ? script : s->dir, tr(strerror(errno)));
    if (out) {
        picture_begin_script(out, "svg");
        picture_write(out, &p, "sweep.svg");
        fclose(out);
        code = run_gnuplot(s->dir);
        if (!code) printf(tr("%s/sweep.svg shows %s of all runs\n"), s->dir, column[0]);
    }
    for (int run = 0; run < s->runs; run++) free(names[run]);
    picture_free(&p);
    free_tables(keep, s->runs);
    free(names);
    free(script);
    return code;
}
