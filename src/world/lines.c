/* The world's lines: added by definition after the bodies that they hold, read by number. */
#include "base/error.h"
#include "base/param.h"
#include "geom/vec3.h"
#include "rigid/lines.h"
#include "world/names.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Of the step of a fall by a spacing; steps until the end: a line that asks for shorter and more is noted. */
static const double SHORT = 0.05, MANY = 1e4;

static tobi_status check_bodies(const tobi_world *w, const tobi_line_def *def, tobi_line *l, tobi_error *err)
{
    l->body = tobi_world_find_body(w, def->body);
    l->to_body = def->to_body ? tobi_world_find_body(w, def->to_body) : -1;
    if (l->body < 0)
        return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "line '%s': there is no body '%s'", def->name,
                                          def->body), "body");
    if (def->to_body && l->to_body < 0)
        return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "line '%s': there is no body '%s'", def->name,
                                          def->to_body), "to_body");
    if (l->body == l->to_body)
        return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "line '%s': both ends are at body '%s'",
                                          def->name, def->body), "to_body");
    if (w->sim.bodies[l->body].rigid.kind == TOBI_PRESCRIBED)
        return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "line '%s': body '%s' is prescribed; a line "
                                          "holds a free or controlled one, and may go to a prescribed one",
                                          def->name, def->body), "body");
    if (l->to_body >= 0 && w->sim.bodies[l->to_body].deforms)
        return tobi_at_key(err, tobi_fail(err, TOBI_UNSUPPORTED, "line '%s': body '%s' deforms; a line goes "
                                          "to a rigid one", def->name, def->to_body), "to_body");
    if (l->to_body >= 0 && w->sim.bodies[l->to_body].absent[0] > 0)
        return tobi_at_key(err, tobi_fail(err, TOBI_UNSUPPORTED, "line '%s': body '%s' is absent at times; a "
                                          "line goes to one that stays", def->name, def->to_body), "to_body");
    return TOBI_OK;
}

static tobi_status check_kind(const tobi_world *w, const tobi_line_def *def, const tobi_line *l,
                              tobi_error *err)
{
    const double fall = vec3_length(w->sim.def.gravity);
    if (!(l->length > 0))
        return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "line '%s': its ends are at one place and it "
                                          "has no length", def->name), "to");
    if (def->kind != TOBI_LINE_CATENARY)
        return def->weight > 0 || def->rests
            ? tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "line '%s': weight and rests are of a catenary",
                                         def->name), "%s", def->weight > 0 ? "weight" : "rests")
            : TOBI_OK;
    if (!(def->weight > 0))
        return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "line '%s': a catenary has a weight above 0 N/m",
                                          def->name), "weight");
    if (def->damping > 0)
        return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "line '%s': damping is of springs and ropes",
                                          def->name), "damping");
    return fall > 0 ? TOBI_OK
        : tobi_fail(err, TOBI_INVALID, "line '%s': a catenary hangs, and there is no gravity", def->name);
}

/* A place at the start into rest axes about the centre of a body, or from the lower corner of the domain. */
static void localize(const tobi_world *w, int body, const double place[3], double out[3])
{
    double from_corner[3], arm[3], turn[3][3];
    vec3_sub(from_corner, place, w->system[0].box.lower);
    memcpy(out, from_corner, sizeof from_corner);
    if (body < 0) return;
    const tobi_rigid *r = &w->sim.bodies[body].rigid;
    vec3_sub(arm, from_corner, r->position);
    tobi_quaternion_matrix(r->orientation, turn);
    for (int a = 0; a < 3; a++) out[a] = turn[0][a]*arm[0] + turn[1][a]*arm[1] + turn[2][a]*arm[2];
}

tobi_status tobi_world_add_line(tobi_world *w, const tobi_line_def *def, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    TOBI_NEED(def, "the definition");
    TOBI_TRY(tobi_param_check(&tobi_line_table, def, err));
    TOBI_NEED(def->name, "the name of the line");
    TOBI_NEED(def->body, "the body of the line");
    tobi_line l = { .kind = def->kind, .stiffness = def->stiffness, .damping = def->damping,
                    .weight = def->weight, .rests = def->rests };
    if (w->started) return tobi_fail(err, TOBI_INVALID, "a started world takes no more lines");
    if (w->line_count == TOBI_LINE_LIMIT)
        return tobi_fail(err, TOBI_UNSUPPORTED, "more than %d lines", TOBI_LINE_LIMIT);
    TOBI_TRY(tobi_names_check_line(w, def->name, err));
    TOBI_TRY(check_bodies(w, def, &l, err));
    l.length = def->length > 0 ? def->length : sqrt(vec3_distance2(def->point, def->to));
    TOBI_TRY(check_kind(w, def, &l, err));
    snprintf(l.name, sizeof l.name, "%s", def->name);
    localize(w, l.body, def->point, l.point);
    localize(w, l.to_body, def->to, l.to);
    vec3_sub(l.up, l.up, w->sim.def.gravity);
    vec3_normalize(l.up);
    tobi_line *more = realloc(w->lines, (size_t)(w->line_count + 1)*sizeof *more);
    if (!more) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a line");
    w->lines = more;
    w->lines[w->line_count++] = l;
    return TOBI_OK;
}

int tobi_world_line_count(const tobi_world *w) { return w ? w->line_count : 0; }

const char *tobi_world_line(const tobi_world *w, int line, tobi_line_info *info)
{
    if (!w || line < 0 || line >= w->line_count) return NULL;
    if (info) *info = w->lines[line].info;
    return w->lines[line].name;
}

/* m, from a place of the world to the box around a body; *across: the longest edge of that box. */
static double find_distance(const tobi_body *b, const double place[3], int dimension, double *across)
{
    double square = 0;
    *across = 0;
    for (int a = 0; a < dimension; a++) {
        double least = INFINITY, most = -INFINITY;
        for (int64_t i = 0; i < b->mesh.vertex_count; i++) {
            least = fmin(least, b->vertex[i][a] + b->lower[a]);
            most = fmax(most, b->vertex[i][a] + b->lower[a]);
        }
        const double out = fmax(0, fmax(least - place[a], place[a] - most));
        square += out*out;
        *across = fmax(*across, most - least);
    }
    return sqrt(square);
}

/* A place that is farther from its body than the body is large is seldom meant. */
static tobi_status note_end(tobi_world *w, const tobi_line *l, int body, const double place[3],
                            const char *key, tobi_error *err)
{
    char text[TOBI_NOTE];
    double across;
    if (body < 0) return TOBI_OK;
    const double away = find_distance(&w->sim.bodies[body], place, w->sim.def.dimension, &across);
    if (!(away > across)) return TOBI_OK;
    snprintf(text, sizeof text, tr("'%s' is %.3g m away from body '%s', which is %.3g m across: it is a "
             "place in the domain, as the body starts\n"), key, away, w->sim.bodies[body].name, across);
    return tobi_world_add_notes(w, "line", l->name, text, err);
}

/* A stiffness in other units, or that of steel, makes a run a hundred times as long. */
static tobi_status note_stiffness(tobi_world *w, const tobi_line *l, tobi_error *err)
{
    const double step = tobi_lines_step_limit(l, 1, w->sim.bodies), g = vec3_length(w->sim.def.gravity),
                 fall = 0.25*sqrt(w->sim.def.spacing/fmax(g, 1e-12)), end = w->sim.def.end_time;
    char text[TOBI_NOTE];
    if (!(step < SHORT*fall && end/step > MANY)) return TOBI_OK;
    snprintf(text, sizeof text, tr("its stiffness, %.4g N/m, allows steps of %.2g s, %.0f of them until %g "
             "s; a hundredth of it makes them ten times as long\n"), l->stiffness, step, end/step, end);
    return tobi_world_add_notes(w, "line", l->name, text, err);
}

tobi_status tobi_world_note_lines(tobi_world *w, tobi_error *err)
{
    for (int k = 0; k < w->line_count; k++) {
        const tobi_line *l = &w->lines[k];
        char text[TOBI_NOTE];
        TOBI_TRY(note_end(w, l, l->body, l->info.point, "point", err));
        TOBI_TRY(note_end(w, l, l->to_body, l->info.to, "to", err));
        TOBI_TRY(note_stiffness(w, l, err));
        if (l->kind != TOBI_LINE_CATENARY || l->length > l->info.distance) continue;
        snprintf(text, sizeof text, tr("is %.4g m long, and its ends are %.4g m apart: it starts taut, with "
                 "%.4g %s\n"), l->length, l->info.distance, l->info.tension,
                 w->sim.def.dimension == 2 ? "N per m" : "N");
        TOBI_TRY(tobi_world_add_notes(w, "line", l->name, text, err));
    }
    return TOBI_OK;
}
