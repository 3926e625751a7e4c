/* Motors of hinges and guides. One by speed or angle is a row about the axis, like a stop, of a guide one
   along it: its impulse in a step has a bound of either sign, and beyond it the row is none. So it drives as
   strongly as it must, the pressure of a liquid knows it, and nothing is to be remembered: whether it was
   obeyed, speed or angle show (docs/decisions/0134-motors.md).
   Drawback: a liquid's pressure knows late that it meets it, and isph solves again. */
#include "core/constraint.h"
#include "geom/vec3.h"
#include <math.h>
#include <string.h>

#define OBEYED 1e-7              /* rad, rad/s, m, m/s or a share of the speed: it does what it is told   */
#define ROUNDING 1e-12           /* of the bound                                                         */

/* The stops of the hinge, with those of a body's own. */
static void find_stops(const tobi_constraint *j, const tobi_body *bodies, double *lower, double *upper)
{
    const tobi_joint *own = &bodies[j->body[0]].rigid.joint;
    *lower = j->kind == TOBI_BETWEEN_MOTOR ? own->lower : j->lower;
    *upper = j->kind == TOBI_BETWEEN_MOTOR ? own->upper : j->upper;
    if (*lower < *upper) return;
    *lower = -INFINITY;
    *upper = INFINITY;
}

/* From one place of the hinge to another, the short way round. */
static double find_difference(const tobi_constraint *j, double to, double from)
{
    return j->slides ? to - from : remainder(to - from, 2*acos(-1));
}

/* Which way it is to turn. */
static double find_way(const tobi_constraint *j, double angle)
{
    const tobi_motor *m = &j->motor;
    return m->kind == TOBI_MOTOR_SPEED ? m->value : find_difference(j, m->value, angle);
}

void tobi_motors_begin(tobi_constraints *c, tobi_body *bodies, double dt)
{
    c->dt = dt;
    for (int k = 0; k < c->count; k++) {
        tobi_constraint *j = &c->at[k];
        double lower, upper;
        j->rate_before = tobi_constraint_rate(j, bodies);
        j->motor.over = 0;
        if (j->kind != TOBI_BETWEEN_MOTOR || j->motor.kind == TOBI_MOTOR_TORQUE) continue;
        const double angle = tobi_constraint_place(j, bodies, 0), way = find_way(j, angle);
        find_stops(j, bodies, &lower, &upper);
        bodies[j->body[0]].rigid.joint.pulled = way < 0 ? angle > lower : way > 0 && angle < upper;
    }
}

/* Back to where it should be, no faster than it can brake: v^2 = a s, half of what its torque alone stops. */
static double find_rate(const tobi_constraint *j, double angle, double dt, double mobility)
{
    const tobi_motor *m = &j->motor;
    if (m->kind == TOBI_MOTOR_SPEED) return m->value;
    if (isinf(m->most)) return find_way(j, angle)/dt;
    const double lag = find_difference(j, m->before, angle);
    const double brake = sqrt(m->most*fmax(mobility, 0)*fabs(lag));
    return (m->value - m->before)/dt + copysign(fmin(fabs(lag)/dt, brake), lag);
}

/* Of a slide: its force acts at the place of the body. */
static void find_arms(tobi_constraint *j, const tobi_body *bodies)
{
    double point[3], axis[3];
    if (j->kind != TOBI_BETWEEN_SLIDE) return;
    tobi_constraint_end(j, 0, bodies, 0, point, axis);
    for (int side = 0; side < 2; side++)
        if (j->body[side] >= 0) vec3_sub(j->arm[side], point, bodies[j->body[side]].rigid.position);
}

void tobi_motor_aim(tobi_constraint *j, const tobi_body *bodies, double dt, double mobility)
{
    tobi_motor *m = &j->motor;
    double lower, upper, axis[3];
    tobi_constraint_axis(j, bodies, axis);
    find_arms(j, bodies);
    memset(m->guess, 0, sizeof m->guess);
    if (m->kind == TOBI_MOTOR_TORQUE) {
        vec3_add_scaled(m->guess, m->guess, 0.5*(m->before + m->value), axis);
        return;
    }
    const double angle = tobi_constraint_place(j, bodies, 0);
    find_stops(j, bodies, &lower, &upper);
    m->goal = fmin(fmax(angle + dt*find_rate(j, angle, dt, mobility), lower), upper);
    m->rate = (m->goal - angle)/dt;
    if (isinf(m->most) || tobi_motor_follows(j, bodies)) return;
    vec3_add_scaled(m->guess, m->guess, copysign(m->most, m->rate - j->rate_before), axis);
}

void tobi_motors_add_guess(const tobi_constraints *c, int body, double load[6])
{
    for (int k = 0; k < c->count; k++) {
        const tobi_constraint *j = &c->at[k];
        if (!j->motor.kind || (j->body[0] != body && j->body[1] != body)) continue;
        const int side = j->body[0] != body;
        double *at = load + (j->slides ? 0 : 3), lever[3];
        vec3_add_scaled(at, at, side ? -1 : 1, j->motor.guess);
        if (!j->slides) continue;
        vec3_cross(lever, j->arm[side], j->motor.guess);
        vec3_add_scaled(load + 3, load + 3, side ? -1 : 1, lever);
    }
}

double tobi_motor_gap(const tobi_constraint *j, const tobi_body *bodies)
{
    return find_difference(j, j->motor.goal, tobi_constraint_place(j, bodies, 1));
}

int tobi_motor_follows(const tobi_constraint *j, const tobi_body *bodies)
{
    const tobi_motor *m = &j->motor;
    if (m->kind == TOBI_MOTOR_ANGLE)
        return fabs(find_difference(j, m->before, tobi_constraint_place(j, bodies, 0))) <= OBEYED;
    return fabs(m->before - tobi_constraint_rate(j, bodies)) <= OBEYED*(1 + fabs(m->before));
}

void tobi_motor_bound(const tobi_constraints *c, const tobi_constraint *j, tobi_constraint_row *row,
                      double share)
{
    row->most = c->dt > 0 ? share*c->dt*j->motor.most : 0;
    row->taken = -j->motor.impulse;
}

int tobi_motor_limit(tobi_constraints *c, int row)
{
    tobi_constraint_row *r = &c->row[row];
    const double sum = r->taken + c->impulse[row];
    if (!r->active || fabs(sum) <= r->most*(1 + ROUNDING)) return 0;
    tobi_constraints_change(c, row, copysign(r->most, sum) - sum);
    r->active = 0;
    r->released = 1;
    return 1;
}

int tobi_motor_engage(const tobi_constraints *c, tobi_constraint_row *row, double impulse)
{
    const double sum = row->taken + impulse;
    if (row->motor <= 0 || row->active || row->released || !(row->most > 0)) return 0;
    if (fabs(sum) >= row->most*(1 - ROUNDING)) {
        double error = row->pace;
        for (int side = 0; side < 2; side++)
            if (row->slot[side] >= 0)
                error += vec3_dot(row->jacobian[side], c->speed[row->slot[side]]) +
                         vec3_dot(row->jacobian[side] + 3, c->speed[row->slot[side]] + 3);
        if (!(error*sum > 0)) return 0;
    }
    row->active = 1;
    return 1;
}

/* Of motors the rows, one each in the order of the joints. */
static int next_row(const tobi_constraints *c, int row)
{
    while (row < c->rows && !c->row[row].motor) row++;
    return row;
}

void tobi_motors_know(tobi_constraints *c)
{
    for (int k = 0, row = 0; k < c->count; k++) {
        if (!c->at[k].motor.kind) continue;
        row = next_row(c, row);
        c->at[k].motor.known = c->impulse[row++];
    }
}

int tobi_motors_bounded(const tobi_constraints *c)
{
    for (int k = 0; k < c->count; k++) {
        const tobi_motor *m = &c->at[k].motor;
        if (m->kind && m->kind != TOBI_MOTOR_TORQUE && isfinite(m->most)) return 1;
    }
    return 0;
}

int tobi_motors_overrun(tobi_constraints *c, double dt)
{
    int any = 0;
    for (int k = 0, row = 0; k < c->count; k++) {
        tobi_motor *m = &c->at[k].motor;
        if (!m->kind) continue;
        row = next_row(c, row);
        const tobi_constraint_row *r = &c->row[row];
        const double sum = -(m->known + dt*c->impulse[row++]);
        if (!r->active || !(fabs(sum) > dt*m->most*(1 + ROUNDING))) continue;
        m->over = sum > 0 ? 1 : -1;
        for (int a = 0; a < 3; a++) m->guess[a] = m->over*m->most*r->axis[a];
        any = 1;
    }
    return any;
}

void tobi_motor_report(tobi_constraint *j, const tobi_body *bodies, double dt)
{
    tobi_motor *m = &j->motor;
    const double before = j->rate_before, now = tobi_constraint_rate(j, bodies);
    double torque = 0;
    m->last = m->value;
    if (m->kind == TOBI_MOTOR_TORQUE) torque = 0.5*(m->before + m->value);
    else if (m->kind) torque = m->impulse/dt;
    j->info.motor_torque = dt > 0 && !j->slides ? torque : 0;
    j->info.motor_force = dt > 0 && j->slides ? torque : 0;
    j->info.power = dt > 0 ? 0.5*(j->damping*before - torque)*(before + now) : 0;
}
