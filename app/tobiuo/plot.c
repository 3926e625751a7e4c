/* tobiuo plot DIR: the tables of a run as pictures, drawn by gnuplot. */
#define _GNU_SOURCE
#include "plot.h"
#include "app.h"
#include "digest.h"
#include "table.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct plot_options { const char *dir, *format, *scene; } plot_options;

enum { KEY_SCENE = KEY_OWN };

static const struct argp_option options[] = {
    { "format", 'f', "FORMAT", 0, "svg (default) or png", 0 },
    { "scene", KEY_SCENE, "SCENE", 0, "take the references of this scene, not those of the run", 0 },
    { 0 }
};

static error_t parse(int key, char *value, struct argp_state *state)
{
    plot_options *o = state->input;
    switch (key) {
    case 'f':
        if (strcmp(value, "svg") != 0 && strcmp(value, "png") != 0)
            usage_error(state, tr("--format: '%s' is neither svg nor png"), value);
        o->format = value;
        break;
    case KEY_SCENE: o->scene = value; break;
    default: return parse_argument(state, key, value, "DIR", &o->dir);
    }
    return 0;
}

/* Everything about one call. */
typedef struct plotter {
    const plot_options *options;
    char *folder;               /* DIR/plots                                          */
    FILE *script;
    tobi_scene *scene;          /* NULL: no references, 3-D                           */
    int dimension;
    int is_nest;                /* 1: bodies may lie outside of its box                */
    table history, bodies, solids, probes, lines, joints;   /* without columns if there is no such file */
    char **files;               /* names of the pictures                              */
    int file_count;
} plotter;

/* The rows of a table that belong to one body; name NULL = all rows. */
typedef struct rows { const table *table; const char *name; } rows;

static int is_row(const rows *r, size_t row)
{
    int column = r->name ? table_column(r->table, "name") : -1;
    return !r->name ||
           (column >= 0 &&
            strcmp(r->table->cells[row*(size_t)r->table->columns + (size_t)column], r->name) == 0);
}

/* Adds a curve to the panel; takes x and y over. */
static curve *add_curve(panel *a, const char *label, size_t room)
{
    curve *c = a->curves < CURVE_LIMIT ? &a->curve[a->curves] : NULL;
    if (!c) return NULL;
    *c = (curve){ .label = label, .x = calloc(room + 1, sizeof(double)),
                  .y = calloc(room + 1, sizeof(double)) };
    a->curves++;
    return c->x && c->y ? c : NULL;
}

/* Whether a column has a value other than 0 in these rows. */
static int has_values(const rows *r, int column)
{
    for (size_t i = 0; column >= 0 && i < r->table->rows; i++)
        if (is_row(r, i) && fabs(table_number(r->table, i, column)) > 0) return 1;
    return 0;
}

/* The sum of columns, those of -1 left out. */
static void fill_curve(curve *c, const rows *r, const int *columns, int count,
                       const panel_row *row)
{
    int time = table_column(r->table, "time");
    double first = NAN, scale = row && row->scale != 0 ? row->scale : 1;
    for (size_t i = 0; i < r->table->rows; i++) {
        if (!is_row(r, i) || (row && row->of_steps && table_number(r->table, i, time) == 0)) continue;
        double y = 0;
        for (int k = 0; k < count; k++)
            if (columns[k] >= 0) y += table_number(r->table, i, columns[k]);
        if (isnan(first)) first = y;
        c->x[c->count] = table_number(r->table, i, time);
        c->y[c->count++] = scale*(row && row->from_start ? y - first : y);
    }
}

/* In 2-D most vectors lack a component. */
static int is_component(const char *column)
{
    const size_t length = strlen(column);
    return length > 2 && column[length - 2] == '_' && strchr("xyz", column[length - 1]);
}

/* unit: "", or in English. */
static void write_y_label(panel *a, const char *quantity, const char *unit, int per_depth)
{
    char whole[40];
    snprintf(whole, sizeof whole, per_depth ? "%s per m" : "%s", unit);
    picture_label(a, quantity, whole);
}

/* Columns that older runs lack are left out, and panels of what the method does not have. */
static int add_panel(picture *p, const rows *r, const panel_row *row, int dimension)
{
    panel *a = &p->panel[p->panels];
    write_y_label(a, tr(row->y_label), row->unit, dimension == 2 && row->per_depth);
    a->logarithmic = row->logarithmic;
    for (const curve_row *k = row->curves; k < row->curves + PLOT_CURVES && k->column; k++) {
        int columns[2 + PLOT_SUM] = { table_column(r->table, k->column),
                                      k->plus ? table_column(r->table, k->plus) : -1 };
        int count = 2;
        for (int n = 0; k->too && k->too[n]; n++) columns[count++] = table_column(r->table, k->too[n]);
        if (columns[0] < 0 || (k->plus && columns[1] < 0)) continue;
        if (dimension == 2 && is_component(k->column) && !has_values(r, columns[0]) &&
            !has_values(r, columns[1])) continue;
        if (k->needs && !has_values(r, table_column(r->table, k->needs))) continue;
        curve *c = add_curve(a, tr(k->label), r->table->rows);
        if (!c) return complain("out of memory");
        c->style = k->style;
        c->colour = k->colour;
        fill_curve(c, r, columns, count, row);
    }
    if (a->curves > 0) p->panels++;
    return 0;
}

static void set_time_axis(picture *p, const table *t)
{
    int time = table_column(t, "time");
    p->begin = INFINITY;
    p->end = -INFINITY;
    for (size_t i = 0; i < t->rows; i++) {
        p->begin = fmin(p->begin, table_number(t, i, time));
        p->end = fmax(p->end, table_number(t, i, time));
    }
}

/* Parts of file names come from tables that anybody may have edited. */
static void clean_name(char *name)
{
    for (char *c = name; *c; c++)
        if ((unsigned char)*c < ' ' || strchr("/\\:*?\"<>|,'", *c)) *c = '_';
}

/* Writes the picture's commands and remembers its file; frees the picture. */
static int finish_picture(plotter *plot, picture *p, const char *name)
{
    size_t count = (size_t)plot->file_count + 1;
    char *file = NULL, **files = reallocarray(plot->files, count, sizeof *files);
    int code = 0;
    if (files) plot->files = files;
    if (!files || asprintf(&file, "%s.%s", name, plot->options->format) < 0) {
        code = complain("out of memory");
    } else {
        clean_name(file);
        char *path = clear_place(plot->folder, file);
        code = path ? 0 : EXIT_ERROR;
        free(path);
        picture_write(plot->script, p, file);
        plot->files[plot->file_count++] = file;
    }
    picture_free(p);
    return code;
}

static int draw_rows(plotter *plot, const rows *r, const picture_row *list)
{
    int code = 0;
    for (const picture_row *row = list; row->file && code == 0; row++) {
        picture p = { 0 };
        char name[300];
        snprintf(p.title, sizeof p.title, tr(row->title), r->name);
        snprintf(name, sizeof name, "%s%s%s", r->name ? r->name : "", r->name ? "_" : "", row->file);
        set_time_axis(&p, r->table);
        int drawn = 0;
        for (int k = 0; k < PANEL_LIMIT && row->panels[k].y_label && code == 0; k++)
            code = add_panel(&p, r, &row->panels[k], plot->dimension);
        for (int k = 0; k < p.panels; k++) drawn += panel_has_values(&p, &p.panel[k]);
        if (!drawn && !row->optional && !(plot->is_nest && r->name) && code == 0)
            complain("note: %s has no values for the picture \"%s\"",
                    r->table->path, p.title);
        if (drawn && code == 0) code = finish_picture(plot, &p, name);
        picture_free(&p);
    }
    return code;
}

/* One set of pictures per name in bodies.csv or solids.csv. */
static int draw_named(plotter *plot, const table *t, const picture_row *list)
{
    int name = table_column(t, "name"), code = 0;
    for (size_t i = 0; i < t->rows && code == 0; i++) {
        const char *owner = t->cells[i*(size_t)t->columns + (size_t)name];
        int seen = 0;
        for (size_t j = 0; j < i && !seen; j++)
            seen = strcmp(t->cells[j*(size_t)t->columns + (size_t)name], owner) == 0;
        if (seen) break;           /* every output lists them once, in the same order */
        rows r = { t, owner };
        code = draw_rows(plot, &r, list);
    }
    return code;
}

/* All columns that end so, in one panel: at most CURVE_LIMIT of them. */
static int add_columns(picture *p, const table *t, const char *what, int dimension)
{
    panel *a = &p->panel[p->panels];
    const size_t length = strlen(what);
    int left_out = 0;
    write_y_label(a, tr(what), plot_unit(what, dimension), 0);
    for (int k = 0; k < t->columns; k++) {
        size_t size = strlen(t->names[k]);
        if (size <= length || t->names[k][size - length - 1] != '_' ||
            strcmp(t->names[k] + size - length, what) != 0) continue;
        if (a->curves == CURVE_LIMIT) {
            left_out++;
            continue;
        }
        curve *c = add_curve(a, t->names[k], t->rows);
        rows all = { t, NULL };
        if (!c) return complain("out of memory");
        fill_curve(c, &all, &k, 1, NULL);
        c->colour = a->curves - 1;
    }
    if (left_out)
        complain("note: %d more columns \"%s\" of %s are not drawn", left_out, what,
                t->path);
    if (a->curves > 0) p->panels++;
    return 0;
}

/* The pictures of a table that has a column for each name and measure. */
static int draw_columns(plotter *plot, const table *t, const columns_row *list)
{
    int code = 0;
    for (const columns_row *row = list; t->columns > 0 && row->file && code == 0; row++) {
        picture p = { 0 };
        snprintf(p.title, sizeof p.title, "%s", tr(row->title));
        for (int k = 0; k < PANEL_LIMIT && row->what[k] && code == 0; k++)
            code = add_columns(&p, t, row->what[k], plot->dimension);
        set_time_axis(&p, t);
        if (code == 0 && p.panels) code = finish_picture(plot, &p, row->file);
        picture_free(&p);
    }
    return code;
}

static const char *reference_label(const tobi_reference_def *def)
{
    const char *slash = strrchr(def->file, '/');
    return def->label ? def->label : slash ? slash + 1 : def->file;
}

/* Adds the points of one reference. A file that cannot serve is told, and the picture drawn without
   it: -1 only without memory. */
static int add_reference(picture *p, const tobi_reference_def *def)
{
    table t;
    const char *y_name = def->y ? def->y : def->column;
    panel *a = &p->panel[0];
    if (table_read(&t, def->file) != 0) return 0;
    int x = table_column(&t, def->x), y = table_column(&t, y_name), code = 0;
    if (x < 0 || y < 0) {
        char list[400];
        table_list_columns(&t, list, sizeof list);
        complain("%s has no column \"%s\"; its columns are %s", def->file, x < 0 ? def->x : y_name,
                 list);
    } else if (a->curves == CURVE_LIMIT) {
        complain("more than %d references for %s: %s is not drawn", CURVE_LIMIT - 1, def->column,
                 def->file);
    } else {
        curve *c = add_curve(a, reference_label(def), t.rows);
        code = c ? 0 : complain("out of memory");
        for (size_t i = 0; c && i < t.rows; i++) {
            c->x[c->count] = def->x_offset + def->x_scale*table_number(&t, i, x);
            c->y[c->count++] = def->y_offset + def->y_scale*table_number(&t, i, y);
        }
        if (c) {
            c->style = CURVE_POINTS;
            c->colour = a->curves - 1;
            panel alone = { .curves = 1, .curve = { *c } };
            if (!panel_has_values(p, &alone))
                complain("note: %s has no value between %g and %g s", def->file,
                        p->begin, p->end);
        }
    }
    table_free(&t);
    return code;
}

static int is_same(const char *a, const char *b)
{
    return a && b ? strcmp(a, b) == 0 : a == b;
}

static int is_same_column(const tobi_reference_def *a, const tobi_reference_def *b)
{
    return is_same(a->column, b->column) && is_same(a->body, b->body) && is_same(a->probe, b->probe);
}

/* The run's column and every reference for it in one picture. */
static int draw_comparison(plotter *plot, int index)
{
    const tobi_reference_def *def = tobi_scene_reference(plot->scene, index), *other;
    for (int k = 0; k < index; k++)
        if (is_same_column(tobi_scene_reference(plot->scene, k), def)) return 0;
    rows r = { def->body ? &plot->bodies : def->probe ? &plot->probes : &plot->history, def->body };
    const char *owner = def->body ? def->body : def->probe ? def->probe : "";
    char name[300], full[300];
    snprintf(full, sizeof full, "%s%s%s", owner, owner[0] ? "_" : "", def->column);
    int column = table_column(r.table, def->probe ? full : def->column);
    if (column < 0) {
        complain("the run has no column \"%s\" to compare with %s", full, def->file);
        return 0;
    }
    picture p = { .panels = 1 };
    snprintf(p.title, sizeof p.title, "%s%s%s", owner, owner[0] ? ": " : "", def->column);
    write_y_label(&p.panel[0], tr(def->column), plot_unit(def->column, plot->dimension), 0);
    snprintf(name, sizeof name, "compare_%.280s", full);
    set_time_axis(&p, r.table);
    curve *c = add_curve(&p.panel[0], tr("this run"), r.table->rows);
    int code = c ? 0 : complain("out of memory");
    if (c) fill_curve(c, &r, &column, 1, NULL);
    for (int k = index; code == 0 && (other = tobi_scene_reference(plot->scene, k)); k++)
        if (is_same_column(other, def)) code = add_reference(&p, other);
    if (code == 0) code = finish_picture(plot, &p, name);
    picture_free(&p);
    return code;
}

static int write_script(plotter *plot)
{
    char *path = clear_place(plot->folder, "plots.gnuplot");
    if (!path) return EXIT_ERROR;
    plot->script = fopen(path, "wx");
    int code = plot->script ? 0 : complain("cannot write %s: %s", path, tr(strerror(errno)));
    if (code == 0) {
        rows all = { &plot->history, NULL };
        picture_begin_script(plot->script, plot->options->format);
        code = draw_rows(plot, &all, plot_history);
        if (code == 0) code = draw_named(plot, &plot->bodies, plot_body);
        if (code == 0) code = draw_named(plot, &plot->solids, plot_solid);
        if (code == 0) code = draw_columns(plot, &plot->probes, plot_probes);
        if (code == 0) code = draw_columns(plot, &plot->lines, plot_lines);
        if (code == 0) code = draw_columns(plot, &plot->joints, plot_joints);
        for (int k = 0; code == 0 && plot->scene && tobi_scene_reference(plot->scene, k); k++)
            code = draw_comparison(plot, k);
        int failed = ferror(plot->script);
        if ((fclose(plot->script) != 0 || failed) && code == 0)
            code = complain("cannot write %s: %s", path, tr(strerror(errno)));
    }
    free(path);
    return code;
}

static int read_table(table *t, const char *dir, const char *name, const char *key)
{
    char *path = NULL;
    if (asprintf(&path, "%s/%s", dir, name) < 0) return complain("out of memory");
    int code = table_read(t, path) == 0 ? 0 : EXIT_ERROR;
    table_strip_units(t);
    digest_add_power(t);
    if (code == 0 && (table_column(t, "time") < 0 || table_column(t, key) < 0))
        code = complain("%s has no column \"%s\": it is not a table of a run", path,
                        table_column(t, "time") < 0 ? "time" : key);
    else if (code == 0 && t->rows == 0) code = complain("%s has no rows yet", path);
    free(path);
    return code;
}

static int has_file(const char *dir, const char *name)
{
    char *path = NULL;
    if (asprintf(&path, "%s/%s", dir, name) < 0) return 0;
    int found = access(path, F_OK) == 0;
    free(path);
    return found;
}

/* The references and the dimension. A run that was moved away from its meshes is still drawn; a scene
   that was asked for must be right. */
static int read_scene(plotter *plot)
{
    const plot_options *o = plot->options;
    char *path = NULL;
    tobi_error err = { 0 };
    tobi_report *report = NULL;
    if (!o->scene && !has_file(o->dir, "resolved.json")) return 0;
    if (o->scene) path = scene_path(o->scene);
    else if (asprintf(&path, "%s/resolved.json", o->dir) < 0) return complain("out of memory");
    tobi_status status = tobi_scene_load(path, NULL, &plot->scene, &report, &err);
    free(path);
    if (status == TOBI_OK) plot->dimension = tobi_scene_world_def(plot->scene)->dimension;
    else if (o->scene) return complain_scene(report, &err);
    else complain("note: drawn without reference data, because of %s", err.text);
    tobi_report_free(report);
    return 0;
}

static int draw_all(plotter *plot)
{
    const char *dir = plot->options->dir;
    if (!has_file(dir, "history.csv"))
        return complain_run(dir, tr("there is no run to draw (no history.csv)"));
    const struct { table *t; const char *file, *key; } others[] = {
        { &plot->bodies, "bodies.csv", "name" }, { &plot->solids, "solids.csv", "name" },
        { &plot->probes, "probes.csv", "time" }, { &plot->lines, "lines.csv", "time" },
        { &plot->joints, "joints.csv", "time" } };
    int code = read_table(&plot->history, dir, "history.csv", "step");
    for (size_t k = 0; k < sizeof others/sizeof *others && code == 0; k++)
        if (has_file(dir, others[k].file)) code = read_table(others[k].t, dir, others[k].file, others[k].key);
    if (code != 0) return code;
    if (asprintf(&plot->folder, "%s/plots", dir) < 0) return complain("out of memory");
    struct stat st;
    if (mkdir(plot->folder, 0777) != 0 && errno != EEXIST)
        return complain("cannot make %s: %s", plot->folder, tr(strerror(errno)));
    if (lstat(plot->folder, &st) != 0 || !S_ISDIR(st.st_mode))
        return complain("%s is no folder (a link is not followed)", plot->folder);
    char *outer = find_outer(dir);
    plot->is_nest = outer != NULL;
    free(outer);
    code = read_scene(plot);
    if (code == 0) code = write_script(plot);
    if (code == 0) code = run_gnuplot(plot->folder);
    return code;
}

int draw_plots(const char *dir, const char *scene, const char *format, plot_files *files)
{
    const plot_options o = { dir, format, scene };
    plotter plot = { .options = &o, .dimension = 3 };
    const int code = draw_all(&plot);
    *files = (plot_files){ plot.folder, plot.files, plot.file_count };
    table *const tables[] = { &plot.history, &plot.bodies, &plot.solids, &plot.probes, &plot.lines,
                              &plot.joints };
    for (size_t k = 0; k < sizeof tables/sizeof *tables; k++) table_free(tables[k]);
    tobi_scene_free(plot.scene);
    return code;
}

void plot_files_free(plot_files *files)
{
    for (int k = 0; k < files->count; k++) free(files->name[k]);
    free(files->name);
    free(files->folder);
    *files = (plot_files){ 0 };
}

const struct argp plot_argp = { .options = options, .parser = parse, .args_doc = "DIR",
    .doc = "Draw the tables of the run in DIR as pictures in DIR/plots, with gnuplot." };

int tobiuo_plot(int argc, char **argv)
{
    plot_options o = { .format = "svg" };
    plot_files files;
    parse_arguments(&plot_argp, argc, argv, &o);
    const int code = draw_plots(o.dir, o.scene, o.format, &files);
    for (int k = 0; k < files.count && code == 0; k++) printf("%s/%s\n", files.folder, files.name[k]);
    plot_files_free(&files);
    return code;
}
