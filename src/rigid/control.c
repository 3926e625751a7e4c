/* Control programs: what they see of their body, and what they answer. Drawback: they see the speeds that the
   step began with, as forces come one body after the other. */
#include "rigid/control.h"
#include "geom/vec3.h"
#include "rigid/dynamics_state.h"
#include <math.h>
#include <string.h>

static const double DEGREE = 3.14159265358979323846/180;

/* A hinge or guide of the body, with its motor or NULL. */
static void add_joint(tobi_control_input *in, tobi_motor **motors, tobi_motor *motor, const char *name,
                      int slides, double place, double rate)
{
    const double unit = slides ? 1 : DEGREE;
    if (in->joint_count == TOBI_CONTROL_JOINTS) return;
    motors[in->joint_count] = motor;
    in->joints[in->joint_count++] = (tobi_control_joint){ name, { place/unit }, rate/unit, slides };
}

/* The joints between bodies that hold it, then its own. */
static void list_joints(const tobi_dynamics_state *d, const tobi_body *b, tobi_control_input *in,
                        tobi_motor **motors)
{
    const tobi_constraints *c = d->world.constraints;
    const tobi_joint *own = &b->rigid.joint;
    const int body = (int)(b - d->bodies);
    tobi_motor *motor = NULL;
    for (int k = 0; k < c->count; k++) {
        tobi_constraint *j = &c->at[k];
        if (j->body[0] != body && j->body[1] != body) continue;
        if (j->kind == TOBI_BETWEEN_MOTOR) motor = &j->motor;
        else if (j->slides || j->kind == TOBI_BETWEEN_HINGE ||
                 (c->dimension == 2 && j->kind == TOBI_BETWEEN_BALL))
            add_joint(in, motors, &j->motor, j->name, j->slides,
                      tobi_constraint_place(j, d->bodies, 0), j->rate_before);
    }
    if (!own->kind) return;
    add_joint(in, motors, motor, b->name, own->kind == TOBI_JOINT_GUIDE, tobi_joint_position(&b->rigid),
              tobi_joint_rate(&b->rigid));
}

/* What the program tells motors, from the next step on. */
static tobi_status set_motors(const tobi_body *b, const tobi_control_input *in,
                              const tobi_control_output *out, tobi_motor *const *motors, tobi_error *err)
{
    for (int k = 0; k < in->joint_count; k++) {
        const int own = strcmp(in->joints[k].name, b->name) == 0;        /* the others are between bodies */
        if (out->motor[k] == TOBI_NOT_GIVEN) continue;
        if (!motors[k] || motors[k]->kind == TOBI_MOTOR_NONE)
            return tobi_fail(err, TOBI_SCRIPT, "body '%s': its control program tells the motor of '%s', "
                             "which has none; a %s has one by the key motor", b->name, in->joints[k].name,
                             !in->joints[k].slides ? "hinge" : own ? "guide" : "slide");
        if (!(fabs(out->motor[k]) <= 1e8))
            return tobi_fail(err, TOBI_SCRIPT, "body '%s': its control program tells the motor of '%s' %g; "
                             "allowed is -1e8 to 1e8", b->name, in->joints[k].name, out->motor[k]);
        motors[k]->is_set = 1;
        const int plain = motors[k]->kind == TOBI_MOTOR_TORQUE || in->joints[k].slides;
        motors[k]->set = out->motor[k]*(plain ? 1 : DEGREE);
    }
    return TOBI_OK;
}

/* About the centre in axes of the domain: xx, yy, zz, xy, xz, yz. */
static void find_inertia(const tobi_rigid *r, double out[6])
{
    static const int row[6] = { 0, 1, 2, 0, 0, 1 }, column[6] = { 0, 1, 2, 1, 2, 2 };
    double m[3][3];
    tobi_quaternion_matrix(r->orientation, m);
    for (int k = 0; k < 6; k++) {
        out[k] = 0;
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) out[k] += m[row[k]][i]*r->inertia[3*i + j]*m[column[k]][j];
    }
}

tobi_status tobi_control_run(const tobi_dynamics_state *d, tobi_body *b, double t, double dt, double force[3],
                             double torque[3], double *bits, tobi_error *err)
{
    tobi_rigid *r = &b->rigid;
    tobi_control_input in = { .time = t, .mass = r->mass, .phase = (int)r->phase,
                              .phase_time = t - r->phase_start, .step = dt };
    tobi_control_output out = { .phase = in.phase };
    char unknown[32];
    vec3_add_scaled(in.position, b->lower, 1, r->position);
    memcpy(in.orientation, r->orientation, sizeof in.orientation);
    memcpy(in.velocity, r->velocity, sizeof in.velocity);
    memcpy(in.angular_velocity, r->angular_velocity, sizeof in.angular_velocity);
    memcpy(in.contact_force, r->contact_force, sizeof in.contact_force);
    memcpy(in.contact_torque, r->contact_torque, sizeof in.contact_torque);
    if (b->swimmer) memcpy(in.steer, b->swimmer->next_steer, sizeof in.steer);
    memcpy(out.steer, in.steer, sizeof out.steer);
    memcpy(in.state, r->memory, sizeof in.state);
    memcpy(out.state, in.state, sizeof out.state);
    find_inertia(r, in.inertia);
    tobi_motor *motors[TOBI_CONTROL_JOINTS] = { NULL };
    list_joints(d, b, &in, motors);
    for (int k = 0; k < TOBI_CONTROL_JOINTS; k++) out.motor[k] = TOBI_NOT_GIVEN;
    TOBI_TRY(r->control(r->control_user, &in, &out, err));
    int hold = tobi_rigid_axes(out.hold, unknown);
    if (hold < 0)
        return tobi_fail(err, TOBI_SCRIPT, "body '%s': its control program holds '%s', which is no axis; "
                         "allowed are x, y, z, turn_x, turn_y, turn_z, shift and turn", b->name, unknown);
    if (hold && r->joint.kind)
        return tobi_fail(err, TOBI_SCRIPT, "body '%s': its control program holds '%s'; nothing can be held "
                         "of a body on a hinge or guide", b->name, out.hold);
    int turns = (hold | r->locked) >> 3;
    if (turns == 1 || turns == 2 || turns == 4)
        return tobi_fail(err, TOBI_SCRIPT, "body '%s': its control program holds '%s', the turn about one "
                         "axis alone; allowed are none, two and three", b->name, out.hold);
    double sum = 0;
    for (int a = 0; a < 3; a++) sum += 0*out.force[a] + 0*out.torque[a];
    for (int a = 0; a < 3; a++) sum += 0*out.steer[a];
    for (int k = 0; k < TOBI_CONTROL_STATE; k++) sum += 0*out.state[k];
    if (sum != 0)      /* 0 times a number is 0 */
        return tobi_fail(err, TOBI_SCRIPT, "body '%s': its control program answered a force, torque, "
                         "steer or state that is not finite at t = %.9g s", b->name, t);
    if (b->swimmer) memcpy(b->swimmer->next_steer, out.steer, sizeof out.steer);
    TOBI_TRY(set_motors(b, &in, &out, motors, err));
    memcpy(r->memory, out.state, sizeof out.state);
    if (out.phase != in.phase) r->phase_start = t;
    r->phase = out.phase;
    *bits = hold;
    vec3_add_scaled(force, force, 1, out.force);
    vec3_add_scaled(torque, torque, 1, out.torque);
    return TOBI_OK;
}
