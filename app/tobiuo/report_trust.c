/* What of a run to trust: its own counters, the spacings across its bodies, and the weaknesses of its method
   that the scene meets. The sentences are those of README and docs/which_method.md. Drawback: they stand here
   once more. */
#define _GNU_SOURCE
#include "report.h"
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

typedef enum grade { GOOD, LOOK, WRONG } grade;

static void say(const report *r, grade g, const char *what, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

static void say(const report *r, grade g, const char *what, const char *format, ...)
{
    static const char *const word[] = { TEXT("good"), TEXT("look"), TEXT("wrong") };
    char *text = NULL;
    va_list args;
    va_start(args, format);
    if (vasprintf(&text, format, args) < 0) exit(complain("out of memory"));
    va_end(args);
    fprintf(r->file, "<tr><td><span class=\"mark %s\">%s</span><td>", word[g], tr(word[g]));
    html_text(r->file, what);
    fputs("<td class=doc>", r->file);
    html_text(r->file, text);
    fputc('\n', r->file);
    free(text);
}

static double total(const report *r, const char *key)
{
    const json_t *value = json_object_get(r->summary, key);
    return json_is_number(value) ? json_number_value(value) : 0;
}

static double at_end(const report *r, const char *column, int first)
{
    const int k = r->history.rows ? table_column(&r->history, column) : -1;
    return k < 0 ? NAN : table_number(&r->history, first ? 0 : r->history.rows - 1, k);
}

static int is_liquid(const report *r)
{
    return strcmp(r->method, "mlsmpm") != 0 && *r->method;
}

/* --- what the run counted --- */

static void judge_outcome(const report *r)
{
    const char *outcome = json_string_value(json_object_get(r->summary, "outcome"));
    if (*r->damaged)
        say(r, WRONG, tr("files"),
            tr("Damaged, and left out: %s. The lines that need them are missing."), r->damaged);
    if (strstr(r->damaged, "summary.json")) return;
    if (!outcome)
        say(r, LOOK, tr("end"),
            tr("The run has not ended: there is no summary.json. Tables go as far as it got."));
    else if (strcmp(outcome, "complete") == 0)
        say(r, GOOD, tr("end"), tr("The run reached its end."));
    else if (strcmp(outcome, "interrupted") == 0)
        say(r, LOOK, tr("end"), tr("The run was stopped before its end."));
    else
        say(r, WRONG, tr("end"), tr("The run ended as \"%s\" at %.6g s."), outcome,
            total(r, "time"));
}

/* A second entry of a path is of a later time. */
static void judge_inputs(const report *r)
{
    for (size_t k = 0; k < json_array_size(r->inputs); k++) {
        const json_t *one = json_array_get(r->inputs, k);
        const double time = json_number_value(json_object_get(one, "time"));
        const char *path = json_string_value(json_object_get(one, "path"));
        if (time > 0 && path)
            say(r, LOOK, tr("files"),
                tr("From %.6g s on, the run has read %s in another state than before."), time,
                path);
    }
}

static void judge_solver(const report *r)
{
    const double steps = total(r, "steps"), bad = total(r, "unconverged_steps");
    if (total(r, "density_iterations_mean") + total(r, "divergence_iterations_mean") <= 0) return;
    say(r, bad == 0 ? GOOD : bad < 0.01*steps ? LOOK : WRONG, tr("solver"),
        bad == 0 ? tr("It converged in all of %.0f steps.") :
                   tr("It stopped short of its tolerance in some of %.0f steps: %.0f. See "
                      "unconverged_steps for when."), steps, bad);
}

static void judge_density(const report *r)
{
    const double error = total(r, "density_error_mean");
    if (!is_liquid(r) || !r->summary) return;
    say(r, error < 0.005 ? GOOD : error < 0.02 ? LOOK : WRONG, tr("density"),
        tr("Particles are off the rest density by %.2g %% in the mean over the run; above 2 %% "
           "the liquid is none any more."), 100*error);
}

static void judge_surface(const report *r)
{
    const double end = at_end(r, "surface_share", 0), start = at_end(r, "surface_share", 1);
    if (is_liquid(r) && end > 0.5 && end > 2*start)
        say(r, LOOK, tr("spray"),
            tr("At the end %.0f %% of the particles are at a free surface (%.0f %% at the "
               "start): drops and films that the spacing does not resolve."), 100*end, 100*start);
}

static void judge_losses(const report *r)
{
    const double lost = total(r, "particles_lost"), back = total(r, "put_back");
    if (lost > 0)
        say(r, LOOK, tr("losses"), tr("%.0f particles left the domain."), lost);
    if (back > 0)
        say(r, LOOK, tr("losses"),
            tr("Particles got past a side of the domain and were put back %.0f times."), back);
}

static void judge_energy(const report *r)
{
    const table *t = &r->history;
    const int time = table_column(t, "time"), kinetic = table_column(t, "kinetic_energy"),
              potential = table_column(t, "potential_energy"), elastic = table_column(t, "elastic_energy");
    energy_watch e = { 0 };
    if (!r->world || time < 0 || kinetic < 0 || potential < 0 || elastic < 0) return;
    for (size_t k = 0; k < t->rows; k++) {
        const double one[] = { table_number(t, k, kinetic), table_number(t, k, potential),
                               table_number(t, k, elastic) };
        if (k == 0) energy_begin(&e, r->world, one[0], one[1], one[2]);
        energy_look(&e, table_number(t, k, time), one[0], one[1], one[2]);
    }
    if (energy_gained(&e))
        say(r, WRONG, tr("energy"),
            tr("By t = %g s liquid and solids have gained %.3g J from nothing, beside %.3g J "
               "that they had at the start. Shorter time steps (cfl, time_step) may help."), e.time,
            e.gain, e.start);
    else if (e.closed)
        say(r, GOOD, tr("energy"),
            tr("Nothing drives the scene. The most that liquid and solids have gained is %.2g "
               "%% of their energy."), 100*e.gain/e.start);
}

/* --- how fine the bodies are --- */

/* The liquid is inside: its walls are no fins. */
static int is_vessel(const report *r, int b)
{
    const json_t *bodies = report_value(r, "bodies");
    return json_is_true(json_object_get(json_array_get(bodies, (size_t)b), "vessel"));
}

static int is_off(const report *r, double face, double side) { return fabs(face - side) > 0.5*r->spacing; }

/* A piston or a bulkhead: but for one axis it reaches from side to side. */
static int fills_section(const report *r, const widths *w)
{
    const tobi_world_def *d = tobi_scene_world_def(r->loaded);
    int open = 0;
    for (int a = 0; a < r->dimension; a++) open += is_off(r, w->low[a], d->domain_min[a]) ||
                                                   is_off(r, w->high[a], d->domain_max[a]);
    return open <= 1;
}

/* A sea wall: it stands on a side, and liquid that does not flow around it does not drag. */
static int stands_on_side(const report *r, const widths *w)
{
    const tobi_world_def *d = tobi_scene_world_def(r->loaded);
    for (int a = 0; a < r->dimension; a++)
        if (!is_off(r, w->low[a], d->domain_min[a]) || !is_off(r, w->high[a], d->domain_max[a])) return 1;
    return 0;
}

static void judge_body(const report *r, int b)
{
    widths w;
    char what[200];
    if (measure_widths(r->world, b, r->dimension, &w) != 0 || !(r->spacing > 0)) return;
    const double narrow = w.narrow/r->spacing, thin = w.thin/r->spacing;
    snprintf(what, sizeof what, tr("body %s"), tobi_world_body_name(r->world, b));
    if (!is_liquid(r)) {
        say(r, GOOD, what,
            tr("Narrowest %.4g m, %.1f spacings. Forces act over a cell of the grid, 2 spacings."),
            w.narrow, narrow);
        return;
    }
    if (is_vessel(r, b)) {
        say(r, GOOD, what,
            tr("A vessel, at least %.0f spacings wide. Its walls stand outside of the liquid."),
            narrow);
        return;
    }
    if (fills_section(r, &w))
        say(r, GOOD, what,
            tr("It closes the whole section of the domain: no liquid flows around it."));
    else if (narrow >= 16)
        say(r, GOOD, what, tr("Narrowest %.4g m, %.0f spacings: enough for drag."), w.narrow,
            narrow);
    else if (stands_on_side(r, &w))
        say(r, LOOK, what,
            tr("Narrowest %.4g m, %.1f spacings, and it stands on a side of the domain. Where "
               "liquid flows around it, drag is 15 %% too large at 8 spacings across, and more "
               "below."), w.narrow, narrow);
    else
        say(r, narrow < 7.95 ? WRONG : LOOK, what,
            tr("Narrowest %.4g m, %.1f spacings. Small bodies have too much drag: 15 %% at 8 "
               "spacings across, more below. Use 16."), w.narrow, narrow);
    if (thin < 10 && thin < 0.8*narrow)
        say(r, thin < 4 ? WRONG : LOOK, what,
            tr("A tenth of its surface is thinner than %.4g m, %.1f spacings. Fins and plates "
               "act one spacing too wide; at four spacings a force is 25 %% too large. Use ten."),
            w.thin, thin);
    for (int a = 0; a < r->dimension; a++) {
        const tobi_world_def *d = tobi_scene_world_def(r->loaded);
        if (w.low[a] < d->domain_min[a] - 1e-6*r->spacing || w.high[a] > d->domain_max[a] + 1e-6*r->spacing)
            say(r, LOOK, what,
                tr("It reaches out of the domain along %c. A body cut by a plane of symmetry "
                   "sinks 5 %% too fast at 8 spacings across. Compute the whole."), "xyz"[a]);
    }
}

/* --- weaknesses of the method --- */

static double corner(const json_t *box, const char *key, size_t a)
{
    const json_t *value = json_array_get(json_object_get(box, key), a);
    return json_is_number(value) ? json_number_value(value) : NAN;
}

/* A gate that is drawn up, or taken away, lets a front go. */
static int stays_down(const report *r, int b)
{
    const table *t = &r->bodies;
    const json_t *absent = json_object_get(json_array_get(report_value(r, "bodies"), (size_t)b), "absent");
    const int name = table_column(t, "name");
    const int up = table_column(t, r->dimension == 2 ? "position_y" : "position_z");
    double low = INFINITY, high = -INFINITY;
    if (json_is_number(json_object_get(absent, "from"))) return 0;
    for (size_t i = 0; name >= 0 && up >= 0 && i < t->rows; i++) {
        const double at = table_number(t, i, up);
        const char *body = t->cells[i*(size_t)t->columns + (size_t)name];
        if (strcmp(body, tobi_world_body_name(r->world, b)) != 0) continue;
        low = fmin(low, at), high = fmax(high, at);
    }
    return high - low < r->spacing;
}

/* Whether liquid comes in or goes out there, along axis a. */
static int is_opening(const report *r, int a, double at)
{
    static const char *const lists[] = { "inlets", "outlets" };
    const json_t *one;
    for (int l = 0; l < 2; l++)
        for (size_t k = 0; (one = json_array_get(report_value(r, lists[l]), k)); k++)
            if (fabs(corner(one, "centre", (size_t)a) - at) < 2*r->spacing &&
                fabs(corner(one, "normal", (size_t)a)) > 0) return 1;
    return 0;
}

/* Whether a piston, a wall or an opening ends the liquid there, along axis a. */
static int is_closed(const report *r, int a, double at)
{
    widths w;
    if (is_opening(r, a, at)) return 1;
    for (int b = 0; r->world && b < tobi_world_body_count(r->world); b++)
        if (measure_widths(r->world, b, r->dimension, &w) == 0 && fills_section(r, &w) && stays_down(r, b) &&
            (fabs(w.low[a] - at) < 2*r->spacing || fabs(w.high[a] - at) < 2*r->spacing)) return 1;
    return 0;
}

/* What boxes of fluid leave free beside them, over both sides of the horizontal axes. */
typedef struct gaps { int begins_beside, stands_free; } gaps;

static gaps look_at_fills(const report *r)
{
    gaps g = { 0, 0 };
    const json_t *fluids = report_value(r, "fluids"), *fluid, *fill;
    const json_t *domain = report_value(r, "domain");
    for (size_t k = 0; (fluid = json_array_get(fluids, k)); k++)
        for (size_t n = 0; (fill = json_array_get(json_object_get(fluid, "fill"), n)); n++)
            for (size_t a = 0; a + 1 < (size_t)r->dimension; a++) {
                const json_t *box = json_object_get(fill, "box");
                const double low = corner(box, "min", a) - corner(domain, "min", a),
                             high = corner(domain, "max", a) - corner(box, "max", a);
                const double tiny = 0.01*r->spacing;
                g.begins_beside |= (low > tiny && low <= r->spacing) || (high > tiny && high <= r->spacing);
                g.stands_free |= low > 2*r->spacing && !is_closed(r, (int)a, corner(box, "min", a));
                g.stands_free |= high > 2*r->spacing && !is_closed(r, (int)a, corner(box, "max", a));
            }
    return g;
}

/* A body that a motion moves and that liquid sticks to, in a domain with a free surface: there dfsph has the
   support that the scene says. */
static int is_sheared(const report *r)
{
    const json_t *bodies = report_value(r, "bodies"), *body;
    const int share = table_column(&r->history, "surface_share");
    int rubs = 0, open = 0;
    for (size_t k = 0; (body = json_array_get(bodies, k)); k++) {
        const char *friction = json_string_value(json_object_get(body, "friction"));
        rubs |= friction && strcmp(friction, "no-slip") == 0 && json_object_get(body, "motion");
    }
    for (size_t i = 0; share >= 0 && i < r->history.rows; i++)
        open |= table_number(&r->history, i, share) > 0;
    return rubs && open;
}

static int falls(const report *r)
{
    double sum = 0;
    for (size_t a = 0; a < (size_t)r->dimension; a++)
        sum += fabs(json_number_value(json_array_get(report_value(r, "gravity"), a)));
    return sum > 0;
}

static void warn_of_liquids(const report *r)
{
    const json_t *support = report_value(r, "dfsph.support");
    const gaps g = look_at_fills(r);
    if (strcmp(r->method, "dfsph") == 0 && !(json_is_number(support) && json_number_value(support) >= 3))
        say(r, LOOK, tr("waves"),
            tr("Waves are 1 to 2 %% too fast. Set dfsph.support to 3 where the period counts, "
               "or use isph."));
    if (strcmp(r->method, "dfsph") == 0 && is_sheared(r) &&
        !(json_is_number(support) && json_number_value(support) >= 2.5))
        say(r, LOOK, tr("friction"),
            tr("Where liquid is sheared beside a no-slip body, its friction and torque come out a third too "
               "large or more. Set dfsph.support to 2.5 or more, or use isph."));
    if (strcmp(r->method, "isph") != 0 && json_array_size(report_value(r, "bodies")) > 0)
        say(r, LOOK, tr("forces"),
            tr("Forces of single steps scatter. Use the columns mean_... of bodies.csv; with "
               "sudden motions set cfl to 0.1."));
    if (g.begins_beside)
        say(r, LOOK, tr("fill"),
            tr("A fill begins beside a wall, not at it: the water stays 3 to 4 %% too high "
               "there. Begin each fill at the wall."));
    if (g.stands_free && falls(r))
        say(r, LOOK, tr("fronts"),
            tr("Water stands beside free floor: its front runs ahead of experiments, as "
               "potential flow does."));
}

static void warn_of_solids(const report *r)
{
    const json_t *solids = report_value(r, "solids"), *solid;
    int bonded = 0, liquid = 0;
    for (size_t k = 0; (solid = json_array_get(solids, k)); k++) {
        const char *model = json_string_value(json_object_get(solid, "model"));
        bonded |= json_is_true(json_object_get(solid, "bonded"));
        liquid |= model && strcmp(model, "liquid") == 0;
    }
    if (bonded && json_array_size(solids) > 1)
        say(r, LOOK, tr("contact"),
            tr("Solids stick to each other. Set \"bonded\": false where they may part."));
    if (liquid)
        say(r, LOOK, tr("liquid"),
            tr("Water of mlsmpm keeps small slopes. Use dfsph for water without solids."));
    if (solids)
        say(r, LOOK, tr("fineness"),
            tr("Bending is 3 %% off at 16 spacings through the height, drafts of soft bodies "
               "2.4 %% at 16 spacings across."));
}

void write_trust(const report *r)
{
    fprintf(r->file, "<h2>%s</h2>\n<table class=trust>\n", tr("What to trust"));
    judge_outcome(r);
    judge_inputs(r);
    judge_solver(r);
    judge_density(r);
    judge_surface(r);
    judge_losses(r);
    judge_energy(r);
    for (int b = 0; r->world && b < tobi_world_body_count(r->world); b++) judge_body(r, b);
    if (!r->world && json_array_size(report_value(r, "bodies")) > 0)
        say(r, LOOK, tr("bodies"), tr("Spacings across bodies are not known: %s"), r->why);
    if (is_liquid(r)) warn_of_liquids(r);
    if (report_value(r, "solids")) warn_of_solids(r);
    fprintf(r->file, "</table>\n<p>%s</p>\n",
            tr("Run at two spacings before you trust a figure (<code>--spacing</code>): the difference is "
               "the error that is left, or more."));
}
