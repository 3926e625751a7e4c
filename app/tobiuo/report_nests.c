/* The nests of a run: their pages, and a table of them with links. Drawback: a page that is written elsewhere
   (--out) has no links. */
#define _GNU_SOURCE
#include "report.h"
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The name of a nest, which is that of a folder; NULL past the end. "": it would lead elsewhere. */
static const char *name_of(const report *r, size_t k)
{
    const json_t *one = json_array_get(report_value(r, "nests"), k);
    const char *name = json_string_value(json_object_get(one, "name"));
    if (!one) return NULL;
    return tobi_nest_name_fits(name) ? name : "";
}

static char *path_of(const report *r, const char *nest, const char *file)
{
    char *path = NULL;
    if (asprintf(&path, "%s/nests/%s%s%s", r->dir, nest, *file ? "/" : "", file) < 0)
        exit(complain("out of memory"));
    return path;
}

static int is_there(const report *r, const char *nest, const char *file)
{
    char *path = path_of(r, nest, file);
    const int there = access(path, F_OK) == 0;
    free(path);
    return there;
}

int report_nests(const report *r, int (*make)(const char *dir, double from, int force), int force)
{
    const char *name;
    int code = 0;
    for (size_t k = 0; (name = name_of(r, k)) != NULL; k++) {
        char *dir = path_of(r, name, "");
        if (*name && is_there(r, name, "history.csv") && make(dir, r->from, force) != 0) code = EXIT_ERROR;
        free(dir);
    }
    return code;
}

static json_t *read_file(const report *r, const char *nest, const char *file)
{
    char *path = path_of(r, nest, file);
    json_t *json = json_load_file(path, 0, NULL);
    free(path);
    return json;
}

static void write_name(const report *r, const char *name)
{
    const int linked = r->has_links && is_there(r, name, "report.html");
    if (linked) fprintf(r->file, "<a href=\"nests/%s/report.html\">", name);
    html_text(r->file, name);
    if (linked) fputs("</a>", r->file);
}

static void write_row(const report *r, const char *name)
{
    json_t *scene = read_file(r, name, "resolved.json"), *summary = read_file(r, name, "summary.json");
    const char *outcome = json_string_value(json_object_get(summary, "outcome"));
    fputs("<tr><td>", r->file);
    write_name(r, name);
    if (!scene) fprintf(r->file, "<td>%s<td><td><td>\n", tr("deleted"));
    else {
        fprintf(r->file, "<td>%g<td>", json_number_value(json_object_get(scene, "spacing")));
        if (summary)
            fprintf(r->file, "%lld<td>%.6g<td>",
                    (long long)json_integer_value(json_object_get(summary, "fluid_particles")),
                    json_number_value(json_object_get(summary, "time")));
        else fputs("<td><td>", r->file);
        html_text(r->file, outcome ? outcome : tr("not ended"));
        fputc('\n', r->file);
    }
    json_decref(scene);
    json_decref(summary);
}

void write_nests(const report *r)
{
    static const char *const heads[] = { TEXT("nest"), TEXT("spacing, m"), TEXT("particles"), TEXT("time, s"),
                                         TEXT("outcome"), NULL };
    const char *name = name_of(r, 0);
    if (!name) return;
    fprintf(r->file, "<h2>%s</h2>\n<div class=wide><table>\n<tr>", tr("Nests"));
    html_heads(r->file, heads);
    fputc('\n', r->file);
    for (size_t k = 0; (name = name_of(r, k)) != NULL; k++)
        if (*name) write_row(r, name);
    fputs("</table></div>\n", r->file);
}
