/* The angle or way of a joint between bodies, and what acts on it: springs, dampers, torques and forces of
   motors at an instant, whose means over a step keep the energy like those of lines; stops; what is told.
   Drawback: stiff springs shorten the time step. */
#include "core/joint_known.h"
#include "geom/vec3.h"
#include <math.h>
#include <string.h>

#define AT_STOP 1e-9                     /* rad, m */

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

void tobi_constraint_axis(const tobi_constraint *j, const tobi_body *bodies, double axis[3])
{
    double m[3][3];
    if (j->kind == TOBI_BETWEEN_SLIDE) {
        tobi_constraint_way(j, bodies, 0, axis);
        return;
    }
    tobi_quaternion_matrix(bodies[j->body[0]].rigid.orientation, m);     /* as the body holds it */
    for (int a = 0; a < 3; a++) axis[a] = vec3_dot(m[a], j->axis[0]);
}

/* m, of the place of the body from that of the other side. */
static void find_shift(const tobi_constraint *j, const tobi_body *bodies, int next, double shift[3])
{
    double point[2][3], axis[3];
    for (int side = 0; side < 2; side++) tobi_constraint_end(j, side, bodies, next, point[side], axis);
    vec3_sub(shift, point[0], point[1]);
}

double tobi_constraint_place(const tobi_constraint *j, const tobi_body *bodies, int next)
{
    const tobi_rigid *r = &bodies[j->body[0]].rigid;
    double shift[3], way[3];
    if (!j->slides) return tobi_constraint_angle(j, bodies, next);
    if (j->kind == TOBI_BETWEEN_SLIDE) {
        find_shift(j, bodies, next, shift);
        tobi_constraint_way(j, bodies, next, way);
        return vec3_dot(shift, way);
    }
    vec3_sub(shift, next ? r->next_position : r->position, r->joint.point);
    return vec3_dot(shift, r->joint.axis);
}

/* Force and moment about the centre of the body of a side, N and N m, where spring, damper or motor give 1 N
   or 1 N m on the body: of a slide at the place of the body. */
static void find_unit(const tobi_constraint *j, const tobi_body *bodies, int side, double unit[6])
{
    double axis[3], point[3], other[3], arm[3];
    memset(unit, 0, 6*sizeof *unit);
    if (j->body[side] < 0) return;
    tobi_constraint_axis(j, bodies, axis);
    for (int a = 0; a < 3; a++) unit[a + (j->slides ? 0 : 3)] = side ? -axis[a] : axis[a];
    if (j->kind != TOBI_BETWEEN_SLIDE) return;
    tobi_constraint_end(j, 0, bodies, 0, point, other);
    vec3_sub(arm, point, bodies[j->body[side]].rigid.position);
    vec3_cross(unit + 3, arm, unit);
}

double tobi_constraint_rate(const tobi_constraint *j, const tobi_body *bodies)
{
    double axis[3], rate = 0;
    for (int side = 0; j->kind == TOBI_BETWEEN_SLIDE && side < 2; side++) {
        double unit[6];
        if (j->body[side] < 0) continue;
        find_unit(j, bodies, side, unit);
        const tobi_rigid *r = &bodies[j->body[side]].rigid;
        rate += vec3_dot(unit, r->velocity) + vec3_dot(unit + 3, r->angular_velocity);
    }
    if (j->kind == TOBI_BETWEEN_SLIDE) return rate;
    tobi_constraint_axis(j, bodies, axis);
    if (j->slides) return vec3_dot(axis, bodies[j->body[0]].rigid.velocity);
    rate = vec3_dot(axis, bodies[j->body[0]].rigid.angular_velocity);
    if (j->body[1] >= 0) rate -= vec3_dot(axis, bodies[j->body[1]].rigid.angular_velocity);
    return rate;
}

int tobi_constraint_at_stop(const tobi_constraint *j, double place)
{
    return place <= j->lower + AT_STOP ? -1 : place >= j->upper - AT_STOP ? 1 : 0;
}

static int acts(const tobi_constraint *j)
{
    return j->stiffness > 0 || j->damping > 0 || j->motor.kind == TOBI_MOTOR_TORQUE;
}

/* rad, m: of its spring, from where it rests. */
static double find_stretch(const tobi_constraint *j, const tobi_body *bodies)
{
    const double from_rest = tobi_constraint_place(j, bodies, 0) - j->rest;
    return j->slides ? from_rest : remainder(from_rest, 2*acos(-1));
}

double tobi_constraint_energy(const tobi_constraint *j, const tobi_body *bodies)
{
    const double stretch = j->stiffness > 0 ? find_stretch(j, bodies) : 0;
    return 0.5*j->stiffness*stretch*stretch;
}

void tobi_constraints_update_springs(tobi_constraints *c, const tobi_body *bodies)
{
    for (int k = 0; k < c->count; k++) {
        tobi_constraint *j = &c->at[k];
        if (!acts(j)) continue;
        memcpy(j->before, j->load, sizeof j->before);
        const double stretch = j->stiffness > 0 ? find_stretch(j, bodies) : 0;
        const double rate = tobi_constraint_rate(j, bodies);
        const double driven = j->motor.kind == TOBI_MOTOR_TORQUE ? j->motor.value : 0;
        for (int side = 0; side < 2; side++) {
            double unit[6];
            find_unit(j, bodies, side, unit);
            for (int a = 0; a < 6; a++) {
                j->load[side][a] = (driven - j->stiffness*stretch)*unit[a];
                j->damped[side][a] = -j->damping*rate*unit[a];
            }
        }
    }
}

void tobi_constraints_add_known(const tobi_constraints *c, const tobi_body *bodies, int body, double load[6])
{
    for (int k = 0; k < c->count; k++) {
        const tobi_constraint *j = &c->at[k];
        double unit[6];
        if (!(j->stiffness > 0 || j->damping > 0) || (j->body[0] != body && j->body[1] != body)) continue;
        find_unit(j, bodies, j->body[0] != body, unit);
        const double stretch = j->stiffness > 0 ? find_stretch(j, bodies) : 0;
        const double pull = j->stiffness*stretch + j->damping*tobi_constraint_rate(j, bodies);
        for (int a = 0; a < 6; a++) load[a] -= pull*unit[a];
    }
}

/* Where a liquid has set the drift, by the springs that it began with, the kick takes these alone. */
void tobi_constraints_add_springs(const tobi_constraints *c, int body, double now, double before,
                                  double damped, double force[3], double torque[3])
{
    for (int k = 0; k < c->count; k++) {
        const tobi_constraint *j = &c->at[k];
        if (!acts(j) || (j->body[0] != body && j->body[1] != body)) continue;
        const int side = j->body[0] != body, known = c->driven && j->stiffness > 0 && before > 0;
        const double first = known ? now + before : before, last = known ? 0 : now;
        for (int turns = 0; turns < 2; turns++) {
            double *sum = turns ? torque : force;
            vec3_add_scaled(sum, sum, last, j->load[side] + 3*turns);
            vec3_add_scaled(sum, sum, first, j->before[side] + 3*turns);
            vec3_add_scaled(sum, sum, damped, j->damped[side] + 3*turns);
        }
    }
}

/* 1/(kg m2), 1/kg: how fast both bodies turn or slide by that load, free; joined they are slower. */
static double mobility(const tobi_constraint *j, const tobi_body *bodies)
{
    double sum = 0;
    for (int side = 0; side < 2; side++) {
        double w[6][6], unit[6];
        if (j->body[side] < 0 || bodies[j->body[side]].rigid.kind == TOBI_PRESCRIBED) continue;
        tobi_constraint_inverse(&bodies[j->body[side]].rigid, w);
        find_unit(j, bodies, side, unit);
        for (int a = 0; a < 6; a++) sum += unit[a]*(vec3_dot(w[a], unit) + vec3_dot(&w[a][3], unit + 3));
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
        double apart[3];
        tobi_constraint_part(j, bodies, 0, apart);
        for (int a = 0; a < 3; a++) {
            j->info.force[a] = dt > 0 ? j->impulse[a]/dt : 0;
            j->info.moment[a] = dt > 0 ? j->impulse[3 + a]/dt : 0;
        }
        tobi_motor_report(j, bodies, dt);
        j->info.gap = vec3_length(apart);
        const int hinge = c->dimension == 2 || j->kind == TOBI_BETWEEN_HINGE;
        j->info.position = j->slides ? tobi_constraint_place(j, bodies, 0) : 0;
        const double angle = hinge ? tobi_constraint_angle(j, bodies, 0) : find_ball_angle(j, bodies);
        j->info.angle = j->slides ? 0 : angle/degree;
    }
}
