/* tobiuo report DIR: one page about a run that holds all it shows, without a script. What a part of it lacks
   (a program, a file) is said in its place. Drawback: pictures are in it at one size only. */
#define _GNU_SOURCE
#include "report.h"
#include "digest.h"
#include "plot.h"
#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct report_options { const char *dir, *out; double from; int force; } report_options;

enum { KEY_FORCE = KEY_OWN, KEY_FROM };

static const struct argp_option options[] = {
    { "out", 'o', "FILE", 0, "the page (DIR/report.html)", 0 },
    { "from", KEY_FROM, "S", 0, "means, least and most of the tables begin at this time, s (0)", 0 },
    { "force", KEY_FORCE, NULL, 0, "replace FILE", 0 },
    { 0 }
};

static error_t parse(int key, char *value, struct argp_state *state)
{
    report_options *o = state->input;
    switch (key) {
    case 'o':
        if (!*value) usage_error(state, tr("--out is empty"));
        o->out = value;
        break;
    case KEY_FROM: o->from = parse_time(state, "--from", value); break;
    case KEY_FORCE: o->force = 1; break;
    default: return parse_argument(state, key, value, "DIR", &o->dir);
    }
    return 0;
}

static const char head[] =
    "<meta charset=utf-8>\n"
    "<meta http-equiv=Content-Security-Policy content=\"default-src 'none'; img-src data:; media-src "
    "data:; "
    "style-src 'unsafe-inline'\">\n"
    "<meta name=viewport content=\"width=device-width, initial-scale=1\">\n"
    "<style>\n"
    "body{font:16px/1.5 sans-serif;color:#223;background:#fff;max-width:1100px;margin:0 "
    "auto;padding:24px}\n"
    "h1{font-size:30px;margin:0}h2{margin:40px 0 8px;border-bottom:1px solid #ccd;padding-bottom:4px}\n"
    "h3{margin:24px 0 4px}p{margin:6px 0}img,video{max-width:100%;display:block;border:1px solid #dde}\n"
    ".plots{display:grid;grid-template-columns:repeat(auto-fill,minmax(480px,1fr));gap:12px}\n"
    ".wide{overflow-x:auto}table{border-collapse:collapse;font-size:14px}\n"
    "th,td{text-align:right;padding:3px 10px;border-bottom:1px solid #e4e8ee;vertical-align:top}\n"
    "td{white-space:nowrap}td.doc{white-space:normal;min-width:240px}"
    "th{color:#567;font-weight:600;white-space:nowrap}"
    "th:first-child,td:first-child,.facts td,.trust td,.doc{text-align:left}\n"
    "td{font-variant-numeric:tabular-nums}td.doc{color:#567}.facts td:first-child{color:#567}\n"
    ".mark{color:#fff;border-radius:3px;padding:1px 8px;font-size:13px}.good{background:#1a7f4b}\n"
    ".look{background:#a86400}.wrong{background:#b3261e}.bar{background:#4a90c2;height:12px;margin-top:5px}\n"
    "pre{background:#f5f7fa;padding:12px;overflow-x:auto;font-size:13px}.sub{color:#567}\n"
    "</style>\n";

const json_t *report_value(const report *r, const char *path)
{
    const json_t *at = r->scene;
    char key[64];
    while (at && *path) {
        const size_t length = strcspn(path, ".");
        snprintf(key, sizeof key, "%.*s", (int)length, path);
        at = json_object_get(at, key);
        path += length + (path[length] == '.');
    }
    return at;
}

static char *join(const char *dir, const char *name)
{
    char *path = NULL;
    if (asprintf(&path, "%s/%s", dir, name) < 0) exit(complain("out of memory"));
    return path;
}

/* --- what the page is made of --- */

/* NULL: there is none, or it is damaged, which is said and counted. */
static json_t *read_json(report *r, const char *name)
{
    char *path = join(r->dir, name);
    json_error_t why;
    const int there = access(path, F_OK) == 0;
    json_t *json = there ? json_load_file(path, 0, &why) : NULL;
    if (json && !json_is_object(json) && !json_is_array(json)) {
        json_decref(json);
        json = NULL;
        snprintf(why.text, sizeof why.text, "no object");
    }
    if (there && !json) {
        complain("%s is damaged, and the report does without it: line %d: %s", path, why.line, why.text);
        snprintf(r->damaged + strlen(r->damaged), sizeof r->damaged - strlen(r->damaged), "%s%s",
                 *r->damaged ? ", " : "", name);
    }
    free(path);
    return json;
}

static int read_one(table *t, const char *dir, const char *name)
{
    char *path = join(dir, name);
    const int there = access(path, F_OK) == 0, code = there && table_read(t, path) != 0 ? EXIT_ERROR : 0;
    free(path);
    table_strip_units(t);
    digest_add_power(t);
    if (code == 0 && there && table_column(t, "time") < 0)
        return complain("%s has no column \"time\": it is not a table of a run", t->path);
    return code;
}

/* The meshes of the bodies; a run that was moved away from them has none. */
static void build_world(report *r)
{
    tobi_error err = { 0 };
    tobi_report *mistakes = NULL;
    char *path = join(r->dir, "resolved.json");
    tobi_status status = r->scene ? tobi_scene_load(path, NULL, &r->loaded, &mistakes, &err) : TOBI_NOT_FOUND;
    if (!r->scene) snprintf(err.text, sizeof err.text, "%s", tr("there is no whole resolved.json"));
    if (status == TOBI_OK) tobi_scene_build(r->loaded, &r->world, &err);
    snprintf(r->why, sizeof r->why, "%.*s", (int)sizeof r->why - 1, err.text);
    tobi_report_free(mistakes);
    free(path);
}

static int read_run(report *r)
{
    char *history = join(r->dir, "history.csv");
    const int there = access(history, F_OK) == 0;
    free(history);
    if (!there) return complain_run(r->dir, tr("there is no run to report on (no history.csv)"));
    int code = read_one(&r->history, r->dir, "history.csv");
    if (code == 0) code = read_one(&r->bodies, r->dir, "bodies.csv");
    if (code == 0) code = read_one(&r->probes, r->dir, "probes.csv");
    if (code == 0) code = read_one(&r->lines, r->dir, "lines.csv");
    if (code == 0) code = read_one(&r->joints, r->dir, "joints.csv");
    if (code == 0) code = read_one(&r->zones, r->dir, "porous_zones.csv");
    if (code == 0) code = read_one(&r->scalars, r->dir, "scalars.csv");
    if (code != 0) return code;
    const int time = table_column(&r->history, "time");
    const double end = r->history.rows ? table_number(&r->history, r->history.rows - 1, time) : 0;
    if (r->from > 0 && !(r->from < end)) return complain("--from %g: the run ends at %g s", r->from, end);
    r->scene = read_json(r, "resolved.json");
    r->summary = read_json(r, "summary.json");
    r->inputs = read_json(r, "inputs.json");
    const char *method = json_string_value(report_value(r, "method"));
    r->method = method ? method : "";
    r->dimension = json_integer_value(report_value(r, "dimension")) == 2 ? 2 : 3;
    r->spacing = json_number_value(report_value(r, "spacing"));
    build_world(r);
    return 0;
}

static void free_run(report *r)
{
    table_free(&r->history);
    table_free(&r->bodies);
    table_free(&r->probes);
    table_free(&r->lines);
    table_free(&r->joints);
    table_free(&r->zones);
    table_free(&r->scalars);
    tobi_world_destroy(r->world);
    tobi_scene_free(r->loaded);
    json_decref(r->scene);
    json_decref(r->summary);
    json_decref(r->inputs);
}

/* --- its sections --- */

static void write_fact(const report *r, const char *name, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static void write_fact(const report *r, const char *name, const char *format, ...)
{
    char text[500];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    fprintf(r->file, "<tr><td>%s<td>", name);
    html_text(r->file, text);
    fputc('\n', r->file);
}

static double value_at(const json_t *list, size_t k) { return json_number_value(json_array_get(list, k)); }

static void write_matter(const report *r, const char *list, const char *name)
{
    const json_t *one;
    for (size_t k = 0; (one = json_array_get(report_value(r, list), k)); k++) {
        const char *title = json_string_value(json_object_get(one, "name"));
        const char *model = json_string_value(json_object_get(one, "model"));
        const char *way = json_string_value(json_object_get(one, "dynamics"));
        const json_t *viscosity = json_object_get(one, "viscosity");
        const json_t *young = json_object_get(one, "youngs_modulus");
        char more[160] = "";
        if (json_is_number(viscosity)) snprintf(more, sizeof more, ", %g Pa "
            "s", json_number_value(viscosity));
        if (json_is_number(young)) snprintf(more, sizeof more, ", E = %g Pa", json_number_value(young));
        write_fact(r, name, "%s: %s%s%g kg/m3%s", title ? title : "", model ? model : way ? way : "",
                   model || way ? ", " : "", json_number_value(json_object_get(one, "density")), more);
    }
}

static void write_facts(const report *r)
{
    const json_t *low = report_value(r, "domain.min"), *high = report_value(r, "domain.max");
    const int time = table_column(&r->history, "time");
    fputs("<table class=facts>\n", r->file);
    write_fact(r, tr("method"), tr("%s, %d-D"), r->method, r->dimension);
    write_fact(r, tr("spacing"), tr("%g m between particles"), r->spacing);
    if (r->dimension == 2)
        write_fact(r, tr("domain"), "%g x %g m", value_at(high, 0) - value_at(low, 0),
                   value_at(high, 1) - value_at(low, 1));
    else
        write_fact(r, tr("domain"), "%g x %g x %g m", value_at(high, 0) - value_at(low, 0),
                   value_at(high, 1) - value_at(low, 1), value_at(high, 2) - value_at(low, 2));
    if (r->history.rows)
        write_fact(r, tr("time"), tr("%g s in %zu outputs"),
                   table_number(&r->history, r->history.rows - 1, time), r->history.rows);
    if (r->summary)
        write_fact(r, tr("particles"), tr("%lld, and %lld of bodies"),
                   (long long)json_integer_value(json_object_get(r->summary, "fluid_particles")),
                   (long long)json_integer_value(json_object_get(r->summary, "body_particles")));
    write_matter(r, "fluids", tr("fluid"));
    write_matter(r, "solids", tr("solid"));
    write_matter(r, "bodies", tr("body"));
    fputs("</table>\n", r->file);
}

/* An <img> or <video> of a file; a sentence in its place if that cannot be. */
static void embed(const report *r, const char *before, const char *type, const char *path, const char *after)
{
    fputs(before, r->file);
    if (html_data(r->file, type, path) != 0) complain("%s cannot be part of the page, and is left "
        "out", path);
    fputs(after, r->file);
}

static void write_paragraph(const report *r, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

static void write_paragraph(const report *r, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    fputs("<p>", r->file);
    vfprintf(r->file, format, args);
    fputs("</p>\n", r->file);
    va_end(args);
}

/* Pictures that were deleted or damaged, or that an older end of the run left out. */
static void write_gap(const report *r)
{
    const pictures p = find_pictures(r->dir, NULL);
    const int64_t missing = (int64_t)r->history.rows - p.count;
    if (missing > 0)
        write_paragraph(r, missing > 1 ?
            tr("Of the pictures %lld are missing; the one before is shown in their place. "
               "<code>tobiuo movie</code> draws what is missing.") :
            tr("Of the pictures %lld is missing; the one before is shown in its place. "
               "<code>tobiuo movie</code> draws what is missing."), (long long)missing);
}

static void write_no_movie(const report *r)
{
    char *damaged = find_damaged(r->dir, NULL);
    if (!damaged) write_paragraph(r, "%s", tr("There is no movie: it needs ffmpeg."));
    else {
        fprintf(r->file, "<p>%s <code>", tr("There is no movie, as this picture is damaged:"));
        html_text(r->file, damaged);
        fprintf(r->file, "</code>. %s</p>\n",
                tr("Delete it, and <code>tobiuo movie</code> draws it anew."));
    }
    free(damaged);
}

static void write_pictures(const report *r)
{
    char *sheet = join(r->dir, "report_sheet.png"), *movie = join(r->dir, "report_movie.mp4");
    double slow = 1;
    fprintf(r->file, "<h2>%s</h2>\n", tr("Pictures"));
    if (find_pictures(r->dir, NULL).count == 0) {
        write_paragraph(r, "%s",
            tr("There are none: the scene was run without <code>--frames</code>. "
               "<code>tobiuo movie</code> draws them."));
    } else {
        write_gap(r);
        if (make_sheet(r->dir, NULL, sheet) == 0) {
            fprintf(r->file, "<img alt=\"%s\" src=\"", tr("moments of the run"));
            embed(r, "", "image/png", sheet, "\">\n");
        }
        if (find_pictures(r->dir, NULL).count > 1) {
            if (make_small_movie(r->dir, movie, &slow) == 0) {
                fprintf(r->file, "<h3>%s</h3>", tr("Movie"));
                write_paragraph(r, slow > 1 ? tr("%g times slower than the scene.") :
                                              tr("As fast as the scene, x%g."), slow);
                embed(r, "<video controls loop muted src=\"", "video/mp4", movie, "\"></video>\n");
            } else {
                write_no_movie(r);
            }
        }
    }
    unlink(sheet);
    unlink(movie);
    free(sheet);
    free(movie);
}

static void write_plots(const report *r)
{
    enum { LIMIT = 3000000 };       /* bytes of a plot: every step of a long run may be in it */
    plot_files files = { 0 };
    fprintf(r->file, "<h2>%s</h2>\n", tr("Plots"));
    const int drawn = draw_plots(r->dir, NULL, "svg", &files) == 0;
    if (drawn) fputs("<div class=plots>\n", r->file);
    else write_paragraph(r, "%s", tr("There are none: they need gnuplot."));
    for (int k = 0; drawn && k < files.count; k++) {
        char *path = join(files.folder, files.name[k]);
        FILE *file = fopen(path, "rb");
        const int fits = file && fseek(file, 0, SEEK_END) == 0 && ftell(file) <= LIMIT;
        if (file) fclose(file);
        if (fits) embed(r, "<img alt=\"\" src=\"", "image/svg+xml", path, "\">\n");
        else complain("%s has more than %d MB and is left out of the page", path, LIMIT/1000000);
        free(path);
    }
    if (drawn) fputs("</div>\n", r->file);
    plot_files_free(&files);
}

static void write_scene(const report *r)
{
    char *text = r->scene ? json_dumps(r->scene, JSON_INDENT(2) | JSON_REAL_PRECISION(9)) : NULL;
    if (!text) return;
    fprintf(r->file, "<h2>%s</h2>\n<details><summary>%s</summary><pre>", tr("Scene"),
            tr("with every default explicit (resolved.json)"));
    html_text(r->file, text);
    fputs("</pre></details>\n", r->file);
    free(text);
}

/* The files that the scene names, as the run read them. */
static void write_inputs(const report *r)
{
    if (!json_array_size(r->inputs)) return;
    static const char *const heads[] = { TEXT("file"), TEXT("from, s"), TEXT("bytes"), "SHA-256",
                                         NULL };
    fprintf(r->file, "<h2>%s</h2>\n<div class=wide><table>\n<tr>", tr("Files of the scene"));
    html_heads(r->file, heads);
    fputc('\n', r->file);
    for (size_t k = 0; k < json_array_size(r->inputs); k++) {
        const json_t *one = json_array_get(r->inputs, k);
        const char *path = json_string_value(json_object_get(one, "path"));
        const char *digest = json_string_value(json_object_get(one, "sha256"));
        fputs("<tr><td>", r->file);
        html_text(r->file, path ? path : "");
        fprintf(r->file, "<td>%.6g<td>%lld<td><code>", json_number_value(json_object_get(one, "time")),
                (long long)json_integer_value(json_object_get(one, "bytes")));
        html_text(r->file, digest ? digest : "");
        fputs("</code>\n", r->file);
    }
    fputs("</table></div>\n", r->file);
}

/* The last part of the folder's path. */
static void write_name(const report *r)
{
    char *real = realpath(r->dir, NULL);
    const char *slash = real ? strrchr(real, '/') : NULL;
    html_text(r->file, slash && slash[1] ? slash + 1 : r->dir);
    free(real);
}

static void write_page(const report *r)
{
    const char *version = json_string_value(json_object_get(r->summary, "version"));
    fprintf(r->file, "<!DOCTYPE html>\n<html lang=%s>\n<head>\n<title>", language_name());
    write_name(r);
    fprintf(r->file, "</title>\n%s</head>\n<body>\n<h1>", head);
    write_name(r);
    fputs("</h1>\n<p class=sub>", r->file);
    fprintf(r->file, tr("A run of Tobiuo %s"), version ? version : tobi_version());
    fputs("</p>\n", r->file);
    write_facts(r);
    write_trust(r);
    write_nests(r);
    write_pictures(r);
    write_plots(r);
    write_tables(r);
    write_times(r);
    write_inputs(r);
    write_scene(r);
    fputs("</body>\n</html>\n", r->file);
}

/* The page is there whole or not at all. */
static int write_file(report *r, const char *out)
{
    char *part = NULL;
    if (asprintf(&part, "%s.part", out) < 0) return complain("out of memory");
    unlink(part);                                   /* nothing is written through a link */
    r->file = fopen(part, "wx");
    int code = r->file ? 0 : complain("cannot write %s: %s", out, tr(strerror(errno)));
    if (code == 0) {
        write_page(r);
        const int failed = ferror(r->file);
        if (fclose(r->file) != 0 || failed || rename(part, out) != 0) {
            code = complain("cannot write %s: %s", out, tr(strerror(errno)));
            unlink(part);
        }
    }
    free(part);
    return code;
}

/* name NULL: DIR/report.html. make: of pages of its nests; NULL: a nest has none. */
static int make_report(const char *dir, const char *name, double from, int force,
                       int (*make)(const char *dir, double from, int force))
{
    report r = { .dir = dir, .from = from, .has_links = !name };
    char *out = name ? strdup(name) : join(dir, "report.html");
    int code = out ? read_run(&r) : complain("out of memory"), inner = 0;
    if (code == 0 && !force && access(out, F_OK) == 0) code = complain("%s exists; --force replaces it", out);
    if (code == 0 && !name && make) inner = report_nests(&r, make, force);
    if (code == 0) code = write_file(&r, out);
    if (code == 0) printf(tr("report: %s\n"), out);
    free_run(&r);
    free(out);
    return code ? code : inner;
}

static int make_inner(const char *dir, double from, int force)
{
    return make_report(dir, NULL, from, force, NULL);
}

const struct argp report_argp = { .options = options, .parser = parse, .args_doc = "DIR",
    .doc = "Write one page about the run in DIR, for any browser: what to trust, pictures, movie, "
        "plots, tables, "
           "times, and a page of each nest. Plots need gnuplot, the movie ffmpeg." };

int tobiuo_report(int argc, char **argv)
{
    report_options o = { 0 };
    parse_arguments(&report_argp, argc, argv, &o);
    return make_report(o.dir, o.out, o.from, o.force, make_inner);
}
