/* The world's probes: added by definition, read by number. One that sits on a body is turned and shifted with
   it. Drawback: bodies that deform have no pose that a probe could follow, and are refused. */
#include "base/error.h"
#include "sph/sensor/probe.h"
#include "sph/sensor/sensor.h"
#include "base/param.h"
#include "geom/vec3.h"
#include "world/names.h"
#include "world/world.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* So deep in a body a place of a patch is not on its surface, spacings: flat patches on round hulls dip. */
static const double BURIED = 0.4;

static int has_box(int kind)
{
    return kind == TOBI_PROBE_PATCH || kind == TOBI_PROBE_FLOW || kind == TOBI_PROBE_VOLUME;
}

static tobi_status check_place(const tobi_world *w, const tobi_probe_def *def, const double x[3],
                               tobi_error *err)
{
    const tobi_box *box = &w->system[0].box;
    for (int a = 0; a < box->dimension; a++)
        if (!(x[a] >= box->lower[a] && x[a] <= box->lower[a] + box->size[a]))
            return tobi_fail(err, TOBI_INVALID,
                             "probe '%s' sits outside the domain: %c = %g m, allowed is %g to %g m",
                             def->name, "xyz"[a], x[a], box->lower[a], box->lower[a] + box->size[a]);
    return TOBI_OK;
}

/* Unit axes: up from normal, along made square to it, and up x along. */
static void make_axes(const tobi_world *w, const tobi_probe_def *def, double axis[3][3])
{
    const int flat = w->sim.def.dimension == 2;
    double *along = axis[0], *across = axis[1], *up = axis[2];
    memcpy(up, def->normal, sizeof axis[2]);
    memcpy(along, def->along, sizeof axis[0]);
    if (vec3_length(up) == 0) up[flat ? 1 : 2] = 1;
    const double size = vec3_length(up);
    for (int a = 0; a < 3; a++) up[a] /= size;
    double square = vec3_dot(along, up);
    vec3_add_scaled(along, along, -square, up);
    if (!(vec3_length(along) > 1e-9*vec3_length(def->along))) {      /* zero, or along the normal */
        memset(along, 0, sizeof axis[0]);
        if (flat) along[0] = up[1], along[1] = -up[0];
        else along[fabs(up[0]) > 0.9] = 1;
        square = vec3_dot(along, up);
        vec3_add_scaled(along, along, -square, up);
    }
    const double length = vec3_length(along);
    for (int a = 0; a < 3; a++) along[a] /= length;
    vec3_cross(across, up, along);
}

/* Only what lies in the domain can be a wall: a patch that reaches out of it has a mean over less. */
static tobi_status check_patch(const tobi_world *w, const tobi_probe_def *def, tobi_error *err)
{
    const tobi_box *box = &w->system[0].box;
    const double slack = 1e-6*w->sim.def.spacing;
    double axis[3][3];
    if (def->kind != TOBI_PROBE_PATCH) return TOBI_OK;
    make_axes(w, def, axis);
    for (int a = 0; a < box->dimension; a++) {
        const double half = 0.5*(def->length*fabs(axis[0][a]) + (box->dimension == 3) *
                                 def->width*fabs(axis[1][a]));
        const double low = def->position[a] - half, high = def->position[a] + half;
        const double lower = box->lower[a], upper = box->lower[a] + box->size[a];
        if (low >= lower - slack && high <= upper + slack) continue;
        return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "probe '%s': the patch reaches from %.6g to "
                                          "%.6g m in %c, the domain from %.6g to %.6g m; its length is along "
                                          "(%g, %g, %g)", def->name, low, high, "xyz"[a], lower, upper,
                                          axis[0][0], axis[0][1], axis[0][2]), "length");
    }
    return TOBI_OK;
}

/* Length, width and height as far as the kind and the dimension need them. */
static tobi_status check_sizes(const tobi_world *w, const tobi_probe_def *def, tobi_error *err)
{
    const int flat = w->sim.def.dimension == 2;
    const double *normal = def->normal;
    if (!has_box(def->kind)) return TOBI_OK;
    if (!(def->length > 0) || (!flat && !(def->width > 0)) ||
        (def->kind == TOBI_PROBE_VOLUME && !(def->height > 0)))
        return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "probe '%s' needs length%s%s, greater than 0 m",
                                          def->name, flat ? "" : tr(", width"),
                                          def->kind == TOBI_PROBE_VOLUME ? tr(", height") : ""), "length");
    if (flat && (normal[2] != 0 || def->along[2] != 0))
        return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "probe '%s': normal and along have no z in 2-D",
                                          def->name), "%s", normal[2] != 0 ? "normal" : "along");
    return TOBI_OK;
}

/* A rate that no step can follow, and a filter that the rate would fold over. */
static tobi_status check_rate(const tobi_world *w, const tobi_probe_def *def, tobi_error *err)
{
    const double steps = w->sim.def.time_step > 0 ? 1/w->sim.def.time_step : INFINITY;
    const double rate = def->rate > 0 ? def->rate : steps;
    if (def->rate > steps*(1 + 1e-9))
        return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "probe '%s': a rate of %g Hz is more than a "
                                          "value per time step, %g Hz", def->name, def->rate, steps), "rate");
    if (def->cutoff > 0.5*rate)
        return tobi_at_key(err, tobi_fail(err, TOBI_INVALID,
                                          "probe '%s': a filter of %g Hz lets through what %g values per "
                                          "second cannot tell, allowed is up to %g Hz", def->name,
                                          def->cutoff, rate, 0.5*rate), "filter.cutoff");
    return TOBI_OK;
}

static tobi_status find_body(const tobi_world *w, const tobi_probe_def *def, int *body, tobi_error *err)
{
    *body = def->body ? tobi_world_find_body(w, def->body) : -1;
    if (!def->body) return TOBI_OK;
    if (*body < 0)
        return tobi_fail(err, TOBI_NOT_FOUND, "probe '%s' sits on the body '%s', which is not there",
                         def->name, def->body);
    if (def->kind == TOBI_PROBE_LEVEL)
        return tobi_fail(err, TOBI_INVALID, "probe '%s': a level stands still; use a run-up on a body",
                         def->name);
    if (w->sim.bodies[*body].deforms)
        return tobi_fail(err, TOBI_UNSUPPORTED,
                         "probe '%s' sits on the body '%s', which deforms: it would have "
                         "no place there", def->name, def->body);
    return TOBI_OK;
}

static tobi_status find_fluid(const tobi_world *w, const tobi_probe_def *def, int *fluid, tobi_error *err)
{
    const tobi_system *s = &w->system[0];
    *fluid = -1;
    if (!def->fluid) return TOBI_OK;
    if (def->kind == TOBI_PROBE_POINT || def->kind == TOBI_PROBE_PATCH)
        return tobi_fail(err, TOBI_INVALID, "probe '%s': a point or patch feels what is there; a fluid is "
                         "for a level, a run-up, a flow or a volume", def->name);
    for (int f = 0; f < s->fluid_count; f++)
        if (strcmp(s->fluid[f].name, def->fluid) == 0) *fluid = f;
    if (*fluid >= 0) return TOBI_OK;
    return tobi_fail(err, TOBI_NOT_FOUND, "probe '%s' is of the fluid '%s', which is not there", def->name,
                     def->fluid);
}

tobi_status tobi_world_add_probe(tobi_world *w, const tobi_probe_def *def, tobi_error *err)
{
    int body, fluid;
    TOBI_NEED_WORLD(w);
    TOBI_NEED(def, "the definition");
    TOBI_NEED(def->name, "the name of the probe");
    TOBI_TRY(tobi_param_check(&tobi_probe_table, def, err));
    TOBI_TRY(tobi_at_key(err, check_place(w, def, def->position, err), "position"));
    if (def->kind == TOBI_PROBE_RUN_UP) TOBI_TRY(tobi_at_key(err, check_place(w, def, def->end, err), "end"));
    if (def->kind == TOBI_PROBE_RUN_UP && vec3_distance2(def->end, def->position) == 0)
        return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "probe '%s': the run-up ends where it begins",
                                          def->name), "end");
    TOBI_TRY(check_sizes(w, def, err));
    TOBI_TRY(check_patch(w, def, err));
    TOBI_TRY(check_rate(w, def, err));
    TOBI_TRY(tobi_at_key(err, find_body(w, def, &body, err), "body"));
    TOBI_TRY(tobi_at_key(err, find_fluid(w, def, &fluid, err), "fluid"));
    if (w->probe_count == TOBI_PROBE_LIMIT)
        return tobi_fail(err, TOBI_UNSUPPORTED, "more than %d probes", TOBI_PROBE_LIMIT);
    TOBI_TRY(tobi_names_check_probe(w, def->name, err));
    tobi_probe *more = realloc(w->probes, (size_t)(w->probe_count + 1)*sizeof *more);
    if (!more) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a probe");
    w->probes = more;
    tobi_probe *p = &w->probes[w->probe_count++];
    *p = (tobi_probe){ .def = *def, .body = body, .fluid = fluid };
    p->def.name = p->def.body = p->def.fluid = NULL;
    snprintf(p->name, sizeof p->name, "%s", def->name);
    return TOBI_OK;
}

/* Half a spacing away from the sides of the domain; 1: that moved it. A face of a body that lies on a side
   has no liquid before it. */
static int move_inside(const tobi_world *w, double deep, double x[3])
{
    const tobi_box *box = &w->system[0].box;
    int moved = 0;
    for (int a = 0; a < box->dimension; a++) {
        const double within = fmin(fmax(x[a], deep), box->size[a] - deep);
        if (box->periodic[a] || within == x[a]) continue;
        x[a] = within;
        moved = 1;
    }
    return moved;
}

int tobi_world_probe_count(const tobi_world *w) { return w ? w->probe_count : 0; }

const char *tobi_world_probe_name(const tobi_world *w, int probe, tobi_probe_kind *kind)
{
    if (!w || probe < 0 || probe >= w->probe_count) return NULL;
    if (kind) *kind = (tobi_probe_kind)w->probes[probe].def.kind;
    return w->probes[probe].name;
}

/* A direction of the scene as the body has turned it. */
static void turn(const tobi_body *b, double v[3])
{
    double out[3] = { 0 };
    for (int k = 0; b && k < 3; k++) vec3_add_scaled(out, out, v[k], b->frame[k]);
    if (b) memcpy(v, out, sizeof out);
}

/* A place of the scene as the body has carried it. */
static void carry(const tobi_body *b, double x[3])
{
    double arm[3];
    if (!b) return;
    vec3_sub(arm, x, b->rest.centre);
    turn(b, arm);
    for (int a = 0; a < 3; a++) x[a] = b->centre[a] + arm[a];
}

static void make_box(const tobi_world *w, const tobi_probe *p, const tobi_body *b, tobi_sensor_box *box)
{
    const tobi_probe_def *def = &p->def;
    memcpy(box->middle, def->position, sizeof box->middle);
    make_axes(w, def, box->axis);
    carry(b, box->middle);
    for (int k = 0; k < 3; k++) turn(b, box->axis[k]);
    box->size[0] = def->length;
    box->size[1] = w->sim.def.dimension == 2 ? 1 : def->width;
    box->size[2] = def->kind == TOBI_PROBE_VOLUME ? def->height : 0;
}

static tobi_status note_point(tobi_world *w, const tobi_probe *p, tobi_error *err)
{
    const double deep = 0.5*w->sim.def.spacing;
    double x[3];
    tobi_bvh_hit hit;
    char text[TOBI_NOTE];
    for (int a = 0; a < 3; a++)
        x[a] = a < w->sim.def.dimension ? p->def.position[a] - w->system[0].box.lower[a] : 0;
    const int moved = move_inside(w, deep, x);
    for (int b = 0; b < w->sim.body_count; b++) {
        const tobi_bvh *bvh = w->sim.bodies[b].bvh;
        if (!tobi_bvh_inside(bvh, x) || tobi_bvh_closest(bvh, x, (moved ? 0.98 : 1)*deep, &hit)) continue;
        snprintf(text, sizeof text, moved ?
                 tr("lies between a side of the domain and body '%s' at the start, where there is no "
                    "liquid, so that its pressure is 0: let it lie on a surface that liquid reaches\n") :
                 tr("lies deep in body '%s' at the start, where there is no liquid: let it lie on the "
                    "surface\n"), w->sim.bodies[b].name);
        TOBI_TRY(tobi_world_add_notes(w, "probe", p->name, text, err));
    }
    return TOBI_OK;
}

/* A patch that is longer than its wall, or that lies across it, has a mean over places without liquid. */
static tobi_status note_patch(tobi_world *w, const tobi_probe *p, tobi_error *err)
{
    const tobi_system *s = &w->system[0];
    double x[3], arm[3];
    tobi_bvh_hit hit;
    char text[TOBI_NOTE];
    tobi_sensor_box box;
    make_box(w, p, NULL, &box);
    for (int b = 0; b < w->sim.body_count; b++) {
        const tobi_bvh *bvh = w->sim.bodies[b].bvh;
        int buried = 0, places = 0;
        for (int k = 0, n; (n = tobi_sensor_place(s, &box, k, arm)) > 0; k++, places = n) {
            for (int a = 0; a < 3; a++)
                x[a] = a < s->box.dimension ? box.middle[a] + arm[a] - s->box.lower[a] : 0;
            buried += tobi_bvh_inside(bvh, x) && !tobi_bvh_closest(bvh, x, BURIED*s->smoothing.spacing, &hit);
        }
        if (buried == 0) continue;
        snprintf(text, sizeof text, tr("%d of its %d places lie in body '%s' at the start, where there is no "
                                       "liquid: its length is along (%g, %g, %g)\n"), buried, places,
                 w->sim.bodies[b].name, box.axis[0][0], box.axis[0][1], box.axis[0][2]);
        TOBI_TRY(tobi_world_add_notes(w, "probe", p->name, text, err));
    }
    return TOBI_OK;
}

/* What lies in a body has no liquid: its values are those of what the kernels reach, or 0. */
tobi_status tobi_world_note_probes(tobi_world *w, tobi_error *err)
{
    for (int k = 0; k < w->probe_count; k++) {
        const tobi_probe *p = &w->probes[k];
        if (p->def.kind == TOBI_PROBE_POINT) TOBI_TRY(note_point(w, p, err));
        if (p->def.kind == TOBI_PROBE_PATCH) TOBI_TRY(note_patch(w, p, err));
    }
    return TOBI_OK;
}

static void measure_run_up(const tobi_world *w, const tobi_probe *p, const tobi_body *b,
                           tobi_probe_info *info)
{
    double from[3], to[3], along[3], floor_at, sign;
    memcpy(from, p->def.position, sizeof from);
    memcpy(to, p->def.end, sizeof to);
    carry(b, from);
    carry(b, to);
    vec3_sub(along, to, from);
    const double length = vec3_length(along);
    for (int a = 0; a < 3; a++) along[a] /= length;
    const double reach = tobi_sensor_column(&w->system[0], p->fluid, from, along, length, &floor_at);
    const int axis = tobi_sensor_up(&w->system[0], &sign);
    info->distance = reach > 0 ? reach : 0;
    info->run_up = from[axis] + info->distance*along[axis];
}

void tobi_world_measure_probe(const tobi_world *w, int probe, tobi_probe_info *info)
{
    static const double still[3];
    const tobi_probe *p = &w->probes[probe];
    const tobi_system *s = &w->system[0];
    const tobi_body *b = p->body >= 0 ? &w->sim.bodies[p->body] : NULL;
    double place[3];
    tobi_sensor_box box;
    memset(info, 0, sizeof *info);
    if (b && b->is_absent) return;
    if (has_box(p->def.kind)) make_box(w, p, b, &box);
    switch (p->def.kind) {
    case TOBI_PROBE_LEVEL: info->level = tobi_sensor_level(s, p->fluid, p->def.position); break;
    case TOBI_PROBE_RUN_UP: measure_run_up(w, p, b, info); break;
    case TOBI_PROBE_PATCH: tobi_sensor_patch(s, &box, &info->pressure, info->force, info->moment); break;
    case TOBI_PROBE_VOLUME: info->volume = tobi_sensor_volume(s, p->fluid, &box); break;
    case TOBI_PROBE_FLOW:
        info->flow = tobi_sensor_flow(s, p->fluid, &box, b ? b->rigid.velocity : still,
                                      b ? b->rigid.angular_velocity : still,
                                      b ? b->centre : box.middle);
        break;
    default:
        memcpy(place, p->def.position, sizeof place);
        carry(b, place);
        tobi_probe_point(s, place, &info->pressure, info->velocity, info->scalar);
    }
}

tobi_status tobi_world_probe(tobi_world *w, int probe, tobi_probe_info *info, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    TOBI_NEED(info, "where the values go");
    if (probe < 0 || probe >= w->probe_count)
        return tobi_fail(err, TOBI_NOT_FOUND, "there is no probe %d", probe);
    TOBI_TRY(tobi_world_refresh(w, err));
    tobi_world_measure_probe(w, probe, info);
    return TOBI_OK;
}
