/* The angle of a joint between bodies, and what acts on it: springs, dampers and torques of motors at an
   instant, whose means over a step keep the energy like those of lines; stops; what is told. Drawback: stiff
   springs shorten the time step. */
#include "core/constraint.h"
#include "geom/vec3.h"
#include <math.h>
#include <string.h>

#define AT_STOP 1e-9                     /* rad */

/* w x y z of the body against the other since the start. */
static void find_turn(const tobi_constraint *j, const tobi_body *bodies, int next, double q[4])
{
    double to[4] = { 1, 0, 0, 0 }, back[4];
    const tobi_rigid *r = &bodies[j->body[0]].rigid;
    if (j->body[1] >= 0) {
        const tobi_rigid *other = &bodies[j->body[1]].rigid;
        const double *then = other->kind == TOBI_PRESCRIBED ? j->next_turn : other->next_orientation;
        memcpy(to, next ? then : other->orientation, sizeof to);
    }
    for (int a = 1; a < 4; a++) to[a] = -to[a];
    tobi_quaternion_product(to, next ? r->next_orientation : r->orientation, q);
    for (int a = 0; a < 4; a++) back[a] = a ? -j->start[a] : j->start[a];
    tobi_quaternion_product(q, back, q);
}

double tobi_constraint_angle(const tobi_constraint *j, const tobi_body *bodies, int next)
{
    double q[4];
    find_turn(j, bodies, next, q);
    return remainder(2*atan2(vec3_dot(q + 1, j->axis[1]), q[0]), 2*acos(-1));
}

/* Of the hinge, as the body holds it. */
static void find_axis(const tobi_constraint *j, const tobi_body *bodies, double axis[3])
{
    double m[3][3];
    tobi_quaternion_matrix(bodies[j->body[0]].rigid.orientation, m);
    for (int a = 0; a < 3; a++) axis[a] = vec3_dot(m[a], j->axis[0]);
}

double tobi_constraint_place(const tobi_constraint *j, const tobi_body *bodies, int next)
{
    const tobi_rigid *r = &bodies[j->body[0]].rigid;
    double way[3];
    if (!j->slides) return tobi_constraint_angle(j, bodies, next);
    vec3_sub(way, next ? r->next_position : r->position, r->joint.point);
    return vec3_dot(way, r->joint.axis);
}

double tobi_constraint_rate(const tobi_constraint *j, const tobi_body *bodies)
{
    double axis[3], rate;
    find_axis(j, bodies, axis);
    if (j->slides) return vec3_dot(axis, bodies[j->body[0]].rigid.velocity);
    rate = vec3_dot(axis, bodies[j->body[0]].rigid.angular_velocity);
    if (j->body[1] >= 0) rate -= vec3_dot(axis, bodies[j->body[1]].rigid.angular_velocity);
    return rate;
}

int tobi_constraint_at_stop(const tobi_constraint *j, double angle)
{
    return angle <= j->lower + AT_STOP ? -1 : angle >= j->upper - AT_STOP ? 1 : 0;
}

static int acts(const tobi_constraint *j)
{
    return j->stiffness > 0 || j->damping > 0 || j->motor.kind == TOBI_MOTOR_TORQUE;
}

/* rad: of its spring, from where it rests. */
static double find_turn_of_spring(const tobi_constraint *j, const tobi_body *bodies)
{
    return j->slides ? 0 : remainder(tobi_constraint_angle(j, bodies, 0) - j->rest, 2*acos(-1));
}

double tobi_constraint_energy(const tobi_constraint *j, const tobi_body *bodies)
{
    const double turn = j->stiffness > 0 ? find_turn_of_spring(j, bodies) : 0;
    return 0.5*j->stiffness*turn*turn;
}

void tobi_constraints_update_springs(tobi_constraints *c, const tobi_body *bodies)
{
    for (int k = 0; k < c->count; k++) {
        tobi_constraint *j = &c->at[k];
        double axis[3];
        if (!acts(j)) continue;
        find_axis(j, bodies, axis);
        memcpy(j->before, j->torque, sizeof j->before);
        const double turn = find_turn_of_spring(j, bodies), rate = tobi_constraint_rate(j, bodies);
        const double driven = j->motor.kind == TOBI_MOTOR_TORQUE ? j->motor.value : 0;
        for (int a = 0; a < 3; a++) {
            j->torque[a] = (driven - j->stiffness*turn)*axis[a];
            j->damped[a] = -j->damping*rate*axis[a];
        }
    }
}

void tobi_constraints_add_springs(const tobi_constraints *c, int body, double now, double before,
                                  double damped, double force[3], double torque[3])
{
    for (int k = 0; k < c->count; k++) {
        const tobi_constraint *j = &c->at[k];
        if (!acts(j) || (j->body[0] != body && j->body[1] != body)) continue;
        const double side = j->body[0] == body ? 1 : -1;
        double *load = j->slides ? force : torque;
        vec3_add_scaled(load, load, side*now, j->torque);
        vec3_add_scaled(load, load, side*before, j->before);
        vec3_add_scaled(load, load, side*damped, j->damped);
    }
}

/* 1/(kg m2): how fast both bodies turn about the axis by a torque about it, free; joined they are slower. */
static double mobility(const tobi_constraint *j, const tobi_body *bodies)
{
    double axis[3], sum = 0;
    find_axis(j, bodies, axis);
    for (int side = 0; side < 2; side++) {
        double w[6][6];
        if (j->body[side] < 0 || bodies[j->body[side]].rigid.kind == TOBI_PRESCRIBED) continue;
        tobi_constraint_inverse(&bodies[j->body[side]].rigid, w);
        for (int a = 0; a < 3; a++) sum += axis[a]*vec3_dot(&w[3 + a][3], axis);
    }
    return sum;
}

double tobi_constraints_step_limit(const tobi_constraints *c, const tobi_body *bodies)
{
    double limit = INFINITY;
    for (int k = 0; k < c->count; k++) {
        const tobi_constraint *j = &c->at[k];
        const double m = acts(j) ? mobility(j, bodies) : 0;
        if (!(m > 0)) continue;
        if (j->stiffness > 0) limit = fmin(limit, 1/(3*sqrt(j->stiffness*m)));
        if (j->damping > 0) limit = fmin(limit, 1/(3*j->damping*m));
    }
    return limit;
}

/* --- what is told ------------------------------------------------------------------------------- */

/* Of a ball joint, or one that is fixed, about any axis. */
static double find_ball_angle(const tobi_constraint *j, const tobi_body *bodies)
{
    double q[4];
    find_turn(j, bodies, 0, q);
    return remainder(2*atan2(vec3_length(q + 1), q[0]), 2*acos(-1));
}

void tobi_constraints_report(tobi_constraints *c, const tobi_body *bodies, double dt)
{
    const double degree = acos(-1)/180;
    for (int k = 0; k < c->count; k++) {
        tobi_constraint *j = &c->at[k];
        double point[2][3], axis[2][3];
        for (int side = 0; side < 2; side++) tobi_constraint_end(j, side, bodies, 0, point[side], axis[side]);
        for (int a = 0; a < 3; a++) {
            j->info.force[a] = dt > 0 ? j->impulse[a]/dt : 0;
            j->info.moment[a] = dt > 0 ? j->impulse[3 + a]/dt : 0;
        }
        tobi_motor_report(j, bodies, dt);
        j->info.gap = sqrt(vec3_distance2(point[0], point[1]));
        const int hinge = c->dimension == 2 || j->kind == TOBI_BETWEEN_HINGE;
        j->info.angle = (hinge ? tobi_constraint_angle(j, bodies, 0) : find_ball_angle(j, bodies))/degree;
    }
}
