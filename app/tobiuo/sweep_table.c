/* The table of a sweep: a row per run, in sweep.csv and, aligned, in sweep.txt and on the screen. Drawback:
   the measures are those of the first run that has begun; a sensor that later runs have alone is missing. */
#define _GNU_SOURCE
#include "sweep.h"
#include "digest.h"
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

table *sweep_read_all(const sweep *s, const char *file, int units)
{
    table *list = calloc((size_t)s->runs, sizeof *list);
    if (!list) exit(complain("out of memory"));
    for (int run = 0; run < s->runs; run++) {
        char *name = sweep_name(s, run), *path = sweep_path(s, "%s/%s", name, file);
        if (access(path, F_OK) == 0) table_read(&list[run], path);
        if (!units) table_strip_units(&list[run]);
        digest_add_power(&list[run]);
        free(path);
        free(name);
    }
    return list;
}

void sweep_free_tables(table *list, int count)
{
    for (int k = 0; k < count; k++) table_free(&list[k]);
    free(list);
}

/* The table has mean, largest and least value of such a column. body: of its rows; NULL: of all. */
typedef struct measure { int file; const char *body, *column; } measure;

enum { KINDS = 3 };
static const char *const kinds[KINDS] = { "mean", "max", "min" };

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

/* force_x and torque_x of a body are the sums that `tobiuo plot` draws: pressure and friction. */
sweep_reading sweep_find_reading(const table *t, const char *column)
{
    char part[2][64];
    sweep_reading r = { t->columns ? table_column(t, column) : -1, -1 };
    if (r.first >= 0 || !t->columns) return r;
    if (strcmp(column, "motion_power") == 0)
        return (sweep_reading){ table_column(t, "mean_motion_power"), -1 };
    if (strncmp(column, "force_", 6) != 0 && strncmp(column, "torque_", 7) != 0) return r;
    snprintf(part[0], sizeof part[0], "mean_pressure_%s", column);
    snprintf(part[1], sizeof part[1], "mean_viscous_%s", column);
    r = (sweep_reading){ table_column(t, part[0]), table_column(t, part[1]) };
    return r.second < 0 ? (sweep_reading){ -1, -1 } : r;
}

/* Without rows or without the column it is all NaN or infinite. */
static digest digest_measure(const table *t, const measure *m, double from)
{
    const sweep_reading r = sweep_find_reading(t, m->column);
    if (r.first >= 0) return digest_column(t, m->body, r.first, r.second, from);
    return (digest){ .last = NAN, .mean = NAN, .low = INFINITY, .high = -INFINITY };
}

const table *sweep_first_table(const table *list, int count)
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
    static const char *const of_body[] = { "position_x", "position_y", "position_z", "angle", "roll", "pitch",
                                           "yaw", "force_x", "force_y", "force_z", "torque_x",
                                           "torque_y", "torque_z", "motion_power" };
    const table *t = sweep_first_table(m->of[file], s->runs);
    const int name = t ? table_column(t, "name") : -1;
    for (size_t i = 0; name >= 0 && i < t->rows; i++) {
        const char *body = t->cells[i*(size_t)t->columns + (size_t)name];
        if (i > 0 && strcmp(body, t->cells[name]) == 0) return;      /* the second output begins */
        for (size_t a = 0; a < sizeof of_body/sizeof *of_body; a++) {
            const measure one = { file, body, of_body[a] };
            const digest d = digest_measure(t, &one, -INFINITY);
            if (d.high > d.low) add_measure(m, file, body, of_body[a]);
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
        m->of[f] = sweep_read_all(s, path, 1);
        if (f%FILES == BODIES) find_body_measures(s, m, f);
        else
            for (int k = 1; (t = sweep_first_table(m->of[f], s->runs)) && k < t->columns; k++)
                add_measure(m, f, NULL, t->names[k]);
    }
}

int sweep_dimension(const sweep *s)
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
    const int dimension = sweep_dimension(s);
    for (int k = 0; k < KINDS; k++)
        for (const measure *one = m->one; one < m->one + m->count; one++) {
            const char *nest = one->file < FILES ? "" : m->nest[one->file/FILES - 1];
            const char *slash = *nest ? "/" : "";
            if (!one->body) add_cell(g, "%s %s%s%s", kinds[k], nest, slash, one->column);
            else add_cell(g, "%s %s%s%s_%s [%s]", kinds[k], nest, slash, one->body, one->column,
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
    for (int k = 0; k < KINDS; k++)
        for (const measure *one = m->one; one < m->one + m->count; one++) {
            const digest d = digest_measure(&m->of[one->file][run], one, s->from);
            const double value = k == 0 ? d.mean : k == 1 ? d.high : d.low;
            if (d.rows == 0) add_cell(g, "%s", "");
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

/* --from may lie behind the end of all runs. */
static int check_from(const sweep *s, const grid *g, const measures *m)
{
    if (s->from == 0 || m->count == 0) return 0;
    for (int row = 1; row < g->rows; row++)
        for (int k = g->columns - KINDS*m->count; k < g->columns; k++)
            if (*g->cell[row*g->columns + k]) return 0;
    return complain("--from %g: no run has values from this time on", s->from);
}

int sweep_write_table(const sweep *s)
{
    measures m = { 0 };
    find_measures(s, &m);
    grid g = { .columns = s->axis_count + 2 + NUMBERS + KINDS*m.count, .rows = s->runs + 1 };
    g.cell = calloc((size_t)g.columns*(size_t)g.rows + 1, sizeof *g.cell);
    if (!g.cell) exit(complain("out of memory"));
    add_head(s, &g, &m);
    for (int run = 0; run < s->runs; run++) add_row(s, &g, run, &m);
    int code = write_grid(s, &g, "sweep.csv", 0);
    if (!code) code = write_grid(s, &g, "sweep.txt", 1);
    if (!code) print_short(s, &g);
    if (!code) printf(tr("%s/sweep.csv and sweep.txt have all columns\n"), s->dir);
    if (!code) code = check_from(s, &g, &m);
    for (int k = 0; k < g.columns*g.rows; k++) free(g.cell[k]);
    free(g.cell);
    for (int f = 0; f < FILES*(1 + m.nests); f++) sweep_free_tables(m.of[f], s->runs);
    return code;
}
