/* The rows of a joint: which numbers it holds, how velocities change them, how far they are off at the next
   pose, and how fast a motion or a motor changes them. A slide holds what lies across its axis, at the place
   of the body. Drawback: the kinds are told apart in each function. */
#include "core/constraint.h"
#include "geom/vec3.h"
#include <math.h>
#include <string.h>

int tobi_constraint_row_count(const tobi_constraints *c, const tobi_constraint *j)
{
    const int fixed = j->kind == TOBI_BETWEEN_FIXED;
    if (j->kind == TOBI_BETWEEN_MOTOR) return 1;
    return (c->dimension == 2 ? 2 : j->kind == TOBI_BETWEEN_BALL ? 3 : 5) + (fixed || j->lower < j->upper) +
           (j->motor.kind != TOBI_MOTOR_NONE);
}

tobi_constraint_row *tobi_constraint_motor_row(const tobi_constraints *c, const tobi_constraint *j,
                                               tobi_constraint_row *row)
{
    return j->motor.kind ? row + tobi_constraint_row_count(c, j) - 1 - (j->lower < j->upper) : NULL;
}

void tobi_constraint_end(const tobi_constraint *j, int side, const tobi_body *bodies, int next,
                         double point[3], double axis[3])
{
    const int body = j->body[side];
    double m[3][3];
    memcpy(point, j->point[side], 3*sizeof *point);
    memcpy(axis, j->axis[side], 3*sizeof *axis);
    if (body < 0) return;
    const tobi_rigid *r = &bodies[body].rigid;
    if (next && r->kind == TOBI_PRESCRIBED) {
        memcpy(point, j->next_point, 3*sizeof *point);
        memcpy(axis, j->next_axis, 3*sizeof *axis);
        return;
    }
    tobi_quaternion_matrix(next ? r->next_orientation : r->orientation, m);
    for (int a = 0; a < 3; a++) {
        point[a] = (next ? r->next_position : r->position)[a] + vec3_dot(m[a], j->point[side]);
        axis[a] = vec3_dot(m[a], j->axis[side]);
    }
}

void tobi_constraint_way(const tobi_constraint *j, const tobi_body *bodies, int next, double way[3])
{
    double m[3][3];
    memcpy(way, j->way, 3*sizeof *way);
    if (j->body[1] < 0) return;
    const tobi_rigid *r = &bodies[j->body[1]].rigid;
    const double *then = r->kind == TOBI_PRESCRIBED ? j->next_turn : r->next_orientation;
    tobi_quaternion_matrix(next ? then : r->orientation, m);
    for (int a = 0; a < 3; a++) way[a] = vec3_dot(m[a], j->way);
}

/* Two directions across n, the same for the same n. */
static void make_tangents(const double n[3], double out[2][3])
{
    const int k = fabs(n[0]) < 0.6 ? 0 : fabs(n[1]) < 0.6 ? 1 : 2;
    const double e[3] = { k == 0, k == 1, k == 2 };
    vec3_cross(out[0], n, e);
    vec3_normalize(out[0]);
    vec3_cross(out[1], n, out[0]);
}

/* --- J ------------------------------------------------------------------------------------------ */

/* Where rows act on each side, and their directions. */
typedef struct frame {
    double point[2][3];                  /* m                                                           */
    double axis[3], across[2][3];        /* that the bodies turn about, or would, and two across it     */
    double way[3], aside[2][3];          /* of a slide, likewise                                        */
} frame;

static void find_frame(const tobi_constraints *c, const tobi_constraint *j, const tobi_body *bodies,
                       frame *f)
{
    double axis[2][3];
    for (int side = 0; side < 2; side++)
        tobi_constraint_end(j, side, bodies, 0, f->point[side], axis[side]);
    memcpy(f->axis, axis[0], sizeof f->axis);
    make_tangents(f->axis, f->across);
    if (j->kind != TOBI_BETWEEN_SLIDE) return;
    memcpy(f->point[1], f->point[0], sizeof f->point[1]);        /* both sides at the place of the body */
    tobi_constraint_way(j, bodies, 0, f->way);
    if (c->dimension == 3) make_tangents(f->way, f->aside);
    else vec3_cross(f->aside[0], f->axis, f->way);
}

/* Along the axes of the domain the places do not part; about two axes across a hinge the bodies do not turn
   against each other, by a motor as it says about its axis, at a stop or fixed not about it: the last row. */
static void choose_turn(const tobi_constraints *c, const tobi_constraint *j, const frame *f, int i, int about,
                        tobi_constraint_row *r)
{
    const double along[3] = { i == 0, i == 1, i == 2 };
    r->turns = (about || i >= c->dimension) && !j->slides;
    memcpy(r->axis, about ? f->axis : r->turns ? f->across[i - c->dimension] : along, sizeof r->axis);
}

/* Across the way of a slide the places do not part, and the bodies do not turn against each other; motor and
   stop act along it. */
static void choose_slide(const tobi_constraints *c, const frame *f, int i, int along, tobi_constraint_row *r)
{
    const int turn = i - (c->dimension - 1);
    r->turns = !along && turn >= 0;
    memcpy(r->axis, along ? f->way : turn < 0 ? f->aside[i] : c->dimension == 2 || turn == 2 ? f->axis
                                                                                         : f->across[turn],
           sizeof r->axis);
}

void tobi_constraint_make_rows(const tobi_constraints *c, const tobi_constraint *j, const tobi_body *bodies,
                               tobi_constraint_row *row)
{
    const int count = tobi_constraint_row_count(c, j), fixed = j->kind == TOBI_BETWEEN_FIXED;
    const int last = fixed || j->lower < j->upper ? count - 1 : -1;
    const tobi_constraint_row *motor = tobi_constraint_motor_row(c, j, row);
    frame f;
    find_frame(c, j, bodies, &f);
    for (int i = 0; i < count; i++) {
        tobi_constraint_row *r = &row[i];
        const int about = i == last || r == motor;
        r->stop = i == last && !fixed;
        r->motor = r != motor ? 0 : j->motor.kind == TOBI_MOTOR_TORQUE ? -1 : 1;
        if (j->kind == TOBI_BETWEEN_SLIDE) choose_slide(c, &f, i, about, r);
        else choose_turn(c, j, &f, i, about, r);
        memset(r->jacobian, 0, sizeof r->jacobian);
        for (int side = 0; side < 2; side++) {
            double arm[3], lever[3];
            if (r->slot[side] < 0) continue;
            vec3_sub(arm, f.point[side], bodies[j->body[side]].rigid.position);
            vec3_cross(lever, arm, r->axis);
            for (int a = 0; a < 3; a++) {
                r->jacobian[side][a] = r->turns ? 0 : (side ? 1 : -1)*r->axis[a];
                r->jacobian[side][3 + a] = (side ? 1 : -1)*(r->turns ? r->axis[a] : lever[a]);
            }
        }
    }
}

/* --- gaps --------------------------------------------------------------------------------------- */

void tobi_constraint_part(const tobi_constraint *j, const tobi_body *bodies, int next, double apart[3])
{
    double point[2][3], axis[3], way[3];
    for (int side = 0; side < 2; side++) tobi_constraint_end(j, side, bodies, next, point[side], axis);
    vec3_sub(apart, point[1], point[0]);
    if (j->kind != TOBI_BETWEEN_SLIDE) return;
    tobi_constraint_way(j, bodies, next, way);
    vec3_add_scaled(apart, apart, -vec3_dot(apart, way), way);
}

void tobi_constraint_find_gap(const tobi_constraints *c, const tobi_constraint *j, const tobi_body *bodies,
                              tobi_constraint_row *row)
{
    const int count = tobi_constraint_row_count(c, j), slide = j->kind == TOBI_BETWEEN_SLIDE;
    tobi_constraint_row *motor = tobi_constraint_motor_row(c, j, row), *last = &row[count - 1];
    double point[3], axis[2][3], apart[3], turned[3];
    for (int side = 0; side < 2; side++) tobi_constraint_end(j, side, bodies, 1, point, axis[side]);
    tobi_constraint_part(j, bodies, 1, apart);
    vec3_cross(turned, axis[0], axis[1]);
    for (int i = 0; i < count; i++) row[i].gap = vec3_dot(row[i].axis, row[i].turns ? turned : apart);
    if (motor) motor->gap = motor->motor < 0 || motor->released ? 0 : tobi_motor_gap(j, bodies);
    if (j->kind == TOBI_BETWEEN_FIXED) last->gap = -tobi_constraint_angle(j, bodies, 1);
    if (slide) row[c->dimension == 2 ? 1 : 4].gap = -tobi_constraint_angle(j, bodies, 1);
    if (!last->stop) return;
    if (motor && motor->active) {                /* it turns to where the stops allow */
        last->gap = 0;
        return;
    }
    const double place = tobi_constraint_place(j, bodies, 1);
    last->gap = (last->active < 0 ? j->lower : j->upper) - place;
    if (!last->active) last->gap = last->released ? 0 : fmin(j->upper - place, 0) + fmax(j->lower - place, 0);
}

/* --- paces -------------------------------------------------------------------------------------- */

tobi_status tobi_constraint_set_pace(const tobi_constraints *c, tobi_constraint *j, const tobi_body *bodies,
                                     double t, double dt, tobi_constraint_row *row, tobi_error *err)
{
    const int count = tobi_constraint_row_count(c, j);
    double point[3], axis[3], shift[3], turned[3];
    for (int i = 0; i < count; i++) row[i].pace = 0;
    if (j->motor.kind) {
        tobi_motor_aim(j, bodies, dt, tobi_constraint_motor_row(c, j, row)->mobility);
        tobi_constraint_motor_row(c, j, row)->pace = j->motor.rate;
    }
    if (j->body[1] >= 0 && bodies[j->body[1]].rigid.kind == TOBI_PRESCRIBED) {
        TOBI_TRY(tobi_constraint_follow(j, bodies, c->reach, t, dt, err));
        tobi_constraint_end(j, 1, bodies, 0, point, axis);
        vec3_sub(shift, j->next_point, point);
        for (int a = 0; a < 3; a++) j->velocity[a] = shift[a]/dt;
        vec3_cross(turned, axis, j->next_axis);
        for (int i = 0; i < count; i++)
            row[i].pace += row[i].stop || row[i].motor ? vec3_dot(row[i].axis, j->spin)
                                                       : vec3_dot(row[i].axis,
                                                                  row[i].turns ? turned : shift)/dt;
    }
    tobi_constraint_turn_pace(c, j, bodies, row);
    return TOBI_OK;
}

void tobi_constraint_turn_pace(const tobi_constraints *c, const tobi_constraint *j, const tobi_body *bodies,
                               tobi_constraint_row *row)
{
    const tobi_constraint_row *motor = tobi_constraint_motor_row(c, j, row);
    double point[2][3], axis[3], arm[3], flow[3];
    if (j->kind != TOBI_BETWEEN_SLIDE) return;
    for (int side = 0; side < 2; side++) tobi_constraint_end(j, side, bodies, 0, point[side], axis);
    vec3_sub(arm, point[0], point[1]);
    vec3_cross(flow, j->spin, arm);
    vec3_add_scaled(flow, flow, 1, j->velocity);
    for (int i = 0; i < tobi_constraint_row_count(c, j); i++)
        row[i].pace = vec3_dot(row[i].axis, row[i].turns ? j->spin : flow) +
                      (&row[i] == motor ? j->motor.rate : 0);
}
