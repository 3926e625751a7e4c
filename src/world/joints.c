/* Joints between bodies: added by definition after the bodies that they hold, read by number; then those
   that bodies have of their own. Drawback: what a body's own hinge or guide leaves it may contradict a joint,
   which then gives way and is told as a gap. */
#include "base/error.h"
#include "base/param.h"
#include "core/constraint.h"
#include "geom/vec3.h"
#include "world/motors.h"
#include "world/names.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const kinds[] = { "hinge", "ball", "fixed", "slide" };

static tobi_status check_bodies(const tobi_world *w, const tobi_joint_def *def, tobi_constraint *j,
                                tobi_error *err)
{
    const char *names[2] = { def->body, def->to_body }, *const keys[2] = { "body", "to_body" };
    for (int side = 0; side < 2; side++) {
        j->body[side] = names[side] ? tobi_world_find_body(w, names[side]) : -1;
        if (names[side] && j->body[side] < 0)
            return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "joint '%s': there is no body '%s'",
                                              def->name, names[side]), "%s", keys[side]);
        const tobi_body *b = j->body[side] >= 0 ? &w->sim.bodies[j->body[side]] : NULL;
        if (b && b->deforms)
            return tobi_at_key(err, tobi_fail(err, TOBI_UNSUPPORTED, "joint '%s': body '%s' deforms; a joint "
                                              "holds rigid ones", def->name, names[side]), "%s", keys[side]);
        if (b && b->absent[0] > 0)
            return tobi_at_key(err, tobi_fail(err, TOBI_UNSUPPORTED, "joint '%s': body '%s' is absent at "
                                              "times; a joint holds bodies that stay", def->name,
                                              names[side]), "%s", keys[side]);
    }
    if (j->body[0] == j->body[1])
        return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "joint '%s': both sides are body '%s'",
                                          def->name, def->body), "to_body");
    if (def->kind == TOBI_BETWEEN_FIXED && j->body[1] >= 0 &&
        w->sim.bodies[j->body[1]].rigid.kind == TOBI_PRESCRIBED)
        return tobi_at_key(err, tobi_fail(err, TOBI_UNSUPPORTED, "joint '%s': body '%s' is prescribed; what "
                                          "is fixed to it has its motion: give '%s' the same, prescribed",
                                          def->name, def->to_body, def->body), "to_body");
    if (w->sim.bodies[j->body[0]].rigid.kind == TOBI_PRESCRIBED)
        return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "joint '%s': body '%s' is prescribed; a joint "
                                          "holds a free or controlled one, and may go to a prescribed one",
                                          def->name, def->body), "body");
    return TOBI_OK;
}

/* A ball joint has none of what acts about an axis or along it, nor one that is fixed. */
static tobi_status take_hinge(const tobi_joint_def *def, int dimension, tobi_constraint *j, tobi_error *err)
{
    const int slide = def->kind == TOBI_BETWEEN_SLIDE;
    const double unit = slide ? 1 : acos(-1)/180;
    const int acts = def->stiffness > 0 || def->damping > 0, stops = def->lower < 0 || def->upper > 0;
    const int acting = slide || def->kind == TOBI_BETWEEN_HINGE ||
                       (dimension == 2 && def->kind == TOBI_BETWEEN_BALL);
    if (!acting && (acts || stops))
        return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "joint '%s': a %s joint has no stops, spring "
                                          "or damper; a hinge or slide has", def->name, kinds[def->kind]),
                           "kind");
    if (!acting && tobi_motor_is_given(&def->motor))
        return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "joint '%s': a %s joint has no motor; a hinge "
                                          "or slide has", def->name, kinds[def->kind]), "motor");
    if (def->rest != 0 && !(def->stiffness > 0))
        return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "joint '%s': rest is of a spring, which needs "
                                          "a stiffness", def->name), "rest");
    j->lower = def->lower*unit;
    j->upper = def->upper*unit;
    j->stiffness = def->stiffness;
    j->rest = def->rest*unit;
    j->damping = def->damping;
    return TOBI_OK;
}

/* In 2-D it lies in the plane, and the bodies would turn about z. */
static tobi_status take_way(const tobi_joint_def *def, int dimension, tobi_constraint *j, double axis[3],
                            tobi_error *err)
{
    memcpy(axis, def->axis, sizeof def->axis);
    if (!(vec3_dot(axis, axis) > 0))
        return tobi_fail(err, TOBI_INVALID, "joint '%s': a slide has an axis", def->name);
    if (dimension == 2 && axis[2] != 0)
        return tobi_fail(err, TOBI_INVALID, "joint '%s': its axis is %g in z, must be 0 in 2-D", def->name,
                         axis[2]);
    vec3_normalize(axis);
    memcpy(j->way, axis, sizeof j->way);
    if (dimension == 2) memcpy(axis, (double[3]){ 0, 0, 1 }, sizeof j->way);
    return TOBI_OK;
}

static tobi_status check_axis(const tobi_joint_def *def, int dimension, tobi_constraint *j, double axis[3],
                              tobi_error *err)
{
    memcpy(axis, def->axis, sizeof def->axis);
    const int given = vec3_dot(axis, axis) > 0;
    j->kind = def->kind;
    j->slides = def->kind == TOBI_BETWEEN_SLIDE;
    if (j->slides) return take_way(def, dimension, j, axis, err);
    if (dimension == 2 && (axis[0] != 0 || axis[1] != 0))
        return tobi_fail(err, TOBI_INVALID, "joint '%s': its axis is along z in 2-D", def->name);
    if (dimension == 2 && !given) axis[2] = 1;
    if (dimension == 3 && def->kind == TOBI_BETWEEN_HINGE && !given)
        return tobi_fail(err, TOBI_INVALID, "joint '%s': a hinge has an axis", def->name);
    if (def->kind != TOBI_BETWEEN_HINGE && given)
        return tobi_fail(err, TOBI_INVALID, "joint '%s': a %s joint has no axis", def->name,
                         kinds[def->kind]);
    if (def->kind == TOBI_BETWEEN_FIXED) axis[2] = 1;            /* any */
    vec3_normalize(axis);
    return TOBI_OK;
}

/* A place and a direction at the start into rest axes about a body's centre, or from the lower corner. */
static void localize(const tobi_world *w, const double place[3], const double axis[3], int side,
                     tobi_constraint *j)
{
    double arm[3], turn[3][3];
    vec3_sub(arm, place, w->system[0].box.lower);
    memcpy(j->point[side], arm, sizeof arm);
    memcpy(j->axis[side], axis, 3*sizeof *axis);
    if (j->body[side] < 0) return;
    const tobi_rigid *r = &w->sim.bodies[j->body[side]].rigid;
    const double way[3] = { j->way[0], j->way[1], j->way[2] };
    vec3_sub(arm, arm, r->position);
    if (w->system[0].box.dimension == 2) arm[2] = 0;
    tobi_quaternion_matrix(r->orientation, turn);
    for (int a = 0; a < 3; a++) {
        j->point[side][a] = turn[0][a]*arm[0] + turn[1][a]*arm[1] + turn[2][a]*arm[2];
        j->axis[side][a] = turn[0][a]*axis[0] + turn[1][a]*axis[1] + turn[2][a]*axis[2];
        if (side) j->way[a] = turn[0][a]*way[0] + turn[1][a]*way[1] + turn[2][a]*way[2];
    }
}

/* at: from the lower corner. A place of the body's own axes, or in other units, is far away. */
static tobi_status note_place(tobi_world *w, const char *kind, const char *name, const char *key,
                              const double at[3], tobi_error *err)
{
    const tobi_box *box = &w->system[0].box;
    char text[TOBI_NOTE];
    int out = 0;
    for (int a = 0; a < box->dimension; a++) out |= !(at[a] >= 0 && at[a] <= box->size[a]);
    if (!out) return TOBI_OK;
    snprintf(text, sizeof text, tr("'%s', (%.4g, %.4g, %.4g) m, lies outside of the domain: it is a place in "
             "the domain, as the body starts\n"), key, at[0] + box->lower[0], at[1] + box->lower[1],
             box->dimension == 2 ? 0 : at[2] + box->lower[2]);
    return tobi_world_add_notes(w, kind, name, text, err);
}

tobi_status tobi_world_note_hinges(tobi_world *w, tobi_error *err)
{
    for (int k = 0; k < w->sim.body_count; k++) {
        const tobi_body *b = &w->sim.bodies[k];
        if (b->rigid.joint.kind == TOBI_JOINT_HINGE)
            TOBI_TRY(note_place(w, "body", b->name, "hinge.point", b->rigid.joint.point, err));
    }
    return TOBI_OK;
}

tobi_status tobi_world_add_joint(tobi_world *w, const tobi_joint_def *def, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    TOBI_NEED(def, "the definition");
    TOBI_TRY(tobi_param_check(&tobi_joint_table, def, err));
    TOBI_NEED(def->name, "the name of the joint");
    TOBI_NEED(def->body, "the body of the joint");
    tobi_constraints *c = &w->sim.constraints;
    tobi_constraint j = { 0 };
    double axis[3];
    if (w->started) return tobi_fail(err, TOBI_INVALID, "a started world takes no more joints");
    if (c->count == TOBI_JOINT_LIMIT)
        return tobi_fail(err, TOBI_UNSUPPORTED, "more than %d joints", TOBI_JOINT_LIMIT);
    TOBI_TRY(tobi_names_check_joint(w, def->name, err));
    TOBI_TRY(check_bodies(w, def, &j, err));
    TOBI_TRY(tobi_at_key(err, check_axis(def, w->system[0].box.dimension, &j, axis, err), "axis"));
    TOBI_TRY(take_hinge(def, w->system[0].box.dimension, &j, err));
    snprintf(j.name, sizeof j.name, "%s", def->name);
    for (int side = 0; side < 2; side++) localize(w, def->point, axis, side, &j);
    double at[3];
    vec3_sub(at, def->point, w->system[0].box.lower);
    TOBI_TRY(note_place(w, "joint", def->name, "point", at, err));
    tobi_constraint *more = realloc(c->at, (size_t)(c->count + 1)*sizeof *more);
    if (!more) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a joint");
    c->at = more;
    TOBI_TRY(tobi_motors_add(w, &def->motor, "motor", j.slides ? 2 : 0, c->count, -1, err));
    c->at[c->count++] = j;
    return TOBI_OK;
}

int tobi_world_joint_count(const tobi_world *w)
{
    int count = w ? tobi_motors_joint_count(w) : 0;
    for (int k = 0; w && k < w->sim.body_count; k++) count += w->sim.bodies[k].rigid.joint.kind != 0;
    return count;
}

/* The joint of its own of some body, by number; NULL past the end. */
static const char *find_own(const tobi_world *w, int number, tobi_joint_info *info)
{
    for (int k = 0; k < w->sim.body_count; k++) {
        const tobi_body *b = &w->sim.bodies[k];
        if (!b->rigid.joint.kind || number-- > 0) continue;
        if (info) *info = b->rigid.joint.info;
        const tobi_constraint *motor = tobi_motors_of_body(w, k);
        if (info && motor) info->motor_torque = motor->info.motor_torque;
        if (info && motor) info->motor_force = motor->info.motor_force;
        if (info && motor) info->power += motor->info.power;
        if (info) info->has_motor = motor != NULL;
        if (info) info->slides = b->rigid.joint.kind == TOBI_JOINT_GUIDE;
        if (info) info->position = info->slides ? tobi_joint_position(&b->rigid) : 0;
        if (info) info->has_power = motor || b->rigid.joint.damping > 0;
        return b->name;
    }
    return NULL;
}

const char *tobi_world_joint(const tobi_world *w, int joint, tobi_joint_info *info)
{
    if (!w || joint < 0) return NULL;
    const tobi_constraints *c = &w->sim.constraints;
    const int count = tobi_motors_joint_count(w);
    if (joint >= count) return find_own(w, joint - count, info);
    if (info) *info = c->at[joint].info;
    if (info) info->slides = c->at[joint].slides;
    if (info) info->has_motor = c->at[joint].motor.kind != TOBI_MOTOR_NONE;
    if (info) info->has_power = info->has_motor || c->at[joint].damping > 0;
    return c->at[joint].name;
}
