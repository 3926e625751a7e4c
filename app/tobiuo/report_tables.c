/* Tables of a report: what the CSV files of a run come to, with units and meanings from the library's lists.
   Drawback: an extreme between two outputs is not seen. */
#include "report.h"
#include "digest.h"
#include "plot.h"
#include "tobiuo/matter.h"
#include <math.h>
#include <string.h>

/* The rows of one body; name NULL: all rows. Extremes and means are of the time from `from` on. */
typedef struct part { const table *table; const char *name; double from; } part;

static void write_head(const report *r, const char *title)
{
    static const char *const heads[] = {
        TEXT("quantity"), TEXT("unit"), TEXT("at the end"), TEXT("mean"), TEXT("least"),
        TEXT("at, s"), TEXT("most"), TEXT("at, s"), NULL };
    fputs("<h3>", r->file);
    html_text(r->file, title);
    fputs("</h3>\n<div class=wide><table><tr>", r->file);
    html_heads(r->file, heads);
    fprintf(r->file, "<th class=doc>%s\n", tr("meaning"));
}

static void write_row(const report *r, const tobi_column *c, const char *doc, const digest *d)
{
    const char *unit = strcmp(c->unit, "1") == 0 ? "" : tobi_run_unit(c->unit, r->dimension);
    fputs("<tr><td>", r->file);
    html_text(r->file, c->name);
    fprintf(r->file, "<td>%s<td>%.5g<td>%.5g<td>%.5g<td>%.4g<td>%.5g<td>%.4g<td "
        "class=doc>", tr(unit), d->last, d->mean, d->low,
            d->low_time, d->high, d->high_time);
    html_text(r->file, tr(doc));
    fputc('\n', r->file);
}

/* Columns of 0 only say nothing, nor do values of steps whose mean is there. */
static int is_shown(const table *t, const char *name, const digest *d)
{
    char mean[420];
    snprintf(mean, sizeof mean, "mean_%s", name);
    if (strcmp(name, "orientation_w") == 0 && d->low == 1) return 0;       /* it does not turn */
    return d->rows > 0 && !(d->low == 0 && d->high == 0) && table_column(t, mean) < 0;
}

static void write_power(const report *r, const part *p)
{
    static const tobi_column power = { .name = "mean_motion_power", .unit = "W",
        .doc = TEXT("Given by its motion to fluids and solids, mean since the last output.") };
    const int column = table_column(p->table, power.name);
    if (column < 0) return;
    const digest d = digest_column(p->table, p->name, column, -1, p->from);
    if (is_shown(p->table, power.name, &d)) write_row(r, &power, power.doc, &d);
}

/* All columns of a part that the library knows, prefixed in the table as probes are. */
static void write_columns(const report *r, const part *p, tobi_table list, const char *prefix,
                          const char *title)
{
    const tobi_column *c;
    const char *doc = "", *said = "";
    char name[400];
    int begun = 0;
    for (int k = 0; (c = tobi_run_column(list, k)); k++) {
        if (*c->doc) doc = c->doc;              /* once for the components of a vector that are shown */
        snprintf(name, sizeof name, "%s%s", prefix, c->name);
        const int column = table_column(p->table, name);
        if (column < 0 || strcmp(c->unit, "text") == 0) continue;
        if (strcmp(name, "time") == 0 || strcmp(name, "step") == 0) continue;
        const digest d = digest_column(p->table, p->name, column, -1, p->from);
        if (!is_shown(p->table, name, &d)) continue;
        if (!begun++) write_head(r, title);
        write_row(r, c, doc == said ? "" : doc, &d);
        said = doc;
    }
    if (begun && list == TOBI_TABLE_BODIES) write_power(r, p);
    if (begun) fputs("</table></div>\n", r->file);
}

static void write_matter_head(const report *r)
{
    static const char *const heads[2][9] = {
        { TEXT("body"), TEXT("mass, kg"), TEXT("volume, m3"), TEXT("of the liquid's density"),
          TEXT("centre of mass, m"), TEXT("inertia, kg m2"), TEXT("draught, m"),
          TEXT("GM about x, y, z, m"), NULL },
        { TEXT("body"), TEXT("mass, kg/m"), TEXT("volume, m3/m"), TEXT("of the liquid's density"),
          TEXT("centre of mass, m"), TEXT("inertia, kg m2/m"), TEXT("draught, m"), TEXT("GM, m"), NULL } };
    fprintf(r->file, "<h3>%s</h3>\n<div class=wide><table><tr>",
            tr("Bodies that move by forces, at the start"));
    html_heads(r->file, heads[r->dimension == 2]);
    fputs("<th class=doc>\n", r->file);
}

/* Of bodies that move by forces, as they start; `tobiuo check` tells the same. */
static void write_body_matter(const report *r)
{
    tobi_body_matter m;
    int begun = 0;
    for (int k = 0; r->world && tobi_world_body_matter(r->world, k, &m) == TOBI_OK; k++) {
        if (m.dynamics == TOBI_PRESCRIBED) continue;
        if (!begun++)
            write_matter_head(r);
        fputs("<tr><td>", r->file);
        html_text(r->file, tobi_world_body_name(r->world, k));
        fprintf(r->file, "<td>%.5g<td>%.5g<td>", m.mass, m.volume);
        if (m.liquid > 0) fprintf(r->file, "%.4g", m.mass/m.volume/m.liquid);
        fprintf(r->file, "<td>%.4g %.4g", m.centre[0], m.centre[1]);
        if (r->dimension == 3)
            fprintf(r->file, " %.4g<td>%.4g %.4g ", m.centre[2], m.inertia[0], m.inertia[4]);
        else fputs("<td>", r->file);
        fprintf(r->file, "%.4g<td>", m.inertia[8]);
        if (m.draught > 0) fprintf(r->file, "%.4g", m.draught);
        fputs("<td>", r->file);
        if (m.draught > 0 && r->dimension == 3)
            fprintf(r->file, "%.4g %.4g ", m.metacentre[0], m.metacentre[1]);
        if (m.draught > 0) fprintf(r->file, "%.4g", m.metacentre[2]);
        fprintf(r->file, "<td class=doc>%s\n",
                m.solids > 0 ? tr("without the solids that it holds") : "");
    }
    if (begun) fputs("</table></div>\n", r->file);
}

static void write_bodies(const report *r)
{
    const table *t = &r->bodies;
    const int name = table_column(t, "name");
    char title[300];
    for (size_t i = 0; name >= 0 && i < t->rows; i++) {
        const char *body = t->cells[i*(size_t)t->columns + (size_t)name];
        const part p = { t, body, r->from };
        if (i > 0 && strcmp(body, t->cells[(size_t)name]) == 0) break;      /* the second output begins */
        snprintf(title, sizeof title, tr("Body %s"), body);
        write_columns(r, &p, TOBI_TABLE_BODIES, "", title);
    }
}

static void write_probes(const report *r)
{
    static const char *const kinds[] = { "point", "level", "patch", "run-up", "flow", "volume" };
    const part p = { &r->probes, NULL, r->from };
    const json_t *probes = report_value(r, "probes"), *probe;
    char prefix[200], title[300];
    for (size_t k = 0; (probe = json_array_get(probes, k)); k++) {
        const char *name = json_string_value(json_object_get(probe, "name"));
        const char *kind = json_string_value(json_object_get(probe, "kind"));
        if (!name || !kind) continue;
        snprintf(prefix, sizeof prefix, "%s_", name);
        snprintf(title, sizeof title, tr("Probe %s"), name);
        for (int t = 0; t < 6; t++)
            if (strcmp(kind, kinds[t]) == 0)
                write_columns(r, &p, (tobi_table)(TOBI_TABLE_POINT + t), prefix, title);
    }
}

/* A table for each line, joint, hinge, guide, zone, scalar and wall of a scalar: their names are what stands
   before a column of their own. */
static void write_held(const report *r, const table *t, tobi_table list, const char *last, const char *kind)
{
    const part p = { t, NULL, r->from };
    char prefix[400], title[440];
    const size_t length = strlen(last);
    for (int k = 0; k < t->columns; k++) {
        const size_t size = strlen(t->names[k]);
        if (size <= length || strcmp(t->names[k] + size - length, last) != 0) continue;
        snprintf(prefix, sizeof prefix, "%.*s_", (int)(size - length), t->names[k]);
        snprintf(title, sizeof title, "%s %.*s", tr(kind), (int)(size - length), t->names[k]);
        write_columns(r, &p, list, prefix, title);
    }
}

void write_tables(const report *r)
{
    const part all = { &r->history, NULL, r->from };
    fprintf(r->file, "<h2>%s</h2>\n<p>%s\n", tr("Tables"),
            tr("Means are over time. Of forces the means over outputs are shown. "
               "Quantities that are 0 throughout are left out."));
    if (r->from > 0)
        fprintf(r->file, tr("Means, least and most are of the time from %g s on."), r->from);
    fputs("</p>\n", r->file);
    write_body_matter(r);
    write_bodies(r);
    write_held(r, &r->lines, TOBI_TABLE_LINES, "_tension", TEXT("Line"));
    write_held(r, &r->joints, TOBI_TABLE_JOINTS, "_gap", TEXT("Joint"));
    write_held(r, &r->zones, TOBI_TABLE_POROUS, "_volume", TEXT("Porous zone"));
    write_held(r, &r->scalars, TOBI_TABLE_SCALARS, "_mean", TEXT("Liquid:"));
    write_held(r, &r->scalars, TOBI_TABLE_SCALAR_FLOWS, "_passed", TEXT("Wall"));
    if (r->probes.columns > 0) write_probes(r);
    write_waves(r);
    write_columns(r, &all, TOBI_TABLE_HISTORY, "", tr("The whole"));
}

static double number_of(const json_t *json, const char *key)
{
    const json_t *value = json_object_get(json, key);
    return json_is_number(value) ? json_number_value(value) : NAN;
}

static void write_totals(const report *r)
{
    char steps[32], nests[32], rest[32], memory[32];
    const double wall = number_of(r->summary, "wall_s"), in_steps = number_of(r->summary, "step_wall_s"),
                 in_nests = number_of(r->summary, "nests_wall_s");
    const double more = wall - in_steps - (in_nests > 0 ? in_nests : 0);
    fputs("<p>", r->file);
    fprintf(r->file, tr("%.0f steps took %s"), number_of(r->summary, "steps"),
            duration_text(in_steps, steps));
    if (in_nests > 0) fprintf(r->file, tr(", those of nests %s"), duration_text(in_nests, nests));
    if (more > 0)
        fprintf(r->file, tr(", files and pictures that steps did not hide %s"), duration_text(more, rest));
    fprintf(r->file, tr(". %.3g million particle-steps per second on %.0f threads; the program held "
                        "%s at most."),
            1e-6*number_of(r->summary, "particle_steps_per_s"), number_of(r->summary, "threads"),
            bytes_text(number_of(r->summary, "peak_rss_bytes"), memory));
    fputs("</p>\n", r->file);
}

void write_times(const report *r)
{
    static const char *const heads[] = { TEXT("stage of a step"), "s", TEXT("share"), "", NULL };
    json_t *stages = json_object_get(r->summary, "stages_s"), *value;
    const char *name;
    double sum = 0;
    if (!stages) return;
    fprintf(r->file, "<h2>%s</h2>\n", tr("Time"));
    write_totals(r);
    json_object_foreach(stages, name, value) sum += json_number_value(value);
    fputs("<table><tr>", r->file);
    html_heads(r->file, heads);
    fputc('\n', r->file);
    json_object_foreach(stages, name, value) {
        const double share = sum > 0 ? json_number_value(value)/sum : 0;
        fputs("<tr><td>", r->file);
        html_text(r->file, tr(name));
        fprintf(r->file, "<td>%.3g<td>%.1f %%<td class=doc><div class=bar style=\"width:%.0fpx\"></div>\n",
                json_number_value(value), 100*share, 240*share);
    }
    fputs("</table>\n", r->file);
}
