/* One coordinate instead of constraints: all forces act on it by the body's velocity for a rate of 1, so that
   an axis never drifts and the pressure of a liquid sees the right inertia. Drawback: joints between two
   bodies that both move need constraints, and are in constraint.c. */
#include "core/joint.h"
#include "core/rigid.h"
#include "geom/vec3.h"
#include <math.h>
#include <string.h>

#define AT_STOP 1e-9                 /* rad, or share of the way between the stops */

/* --- from a definition ------------------------------------------------------------------------- */

static const char *const kinds[] = { "", "hinge", "guide" };

static tobi_status check_axis(const tobi_body_def *def, int kind, const double axis[3], int dimension,
                              tobi_error *err)
{
    const char *name = def->name ? def->name : "";
    if (dimension == 3) return TOBI_OK;
    if (kind == TOBI_JOINT_HINGE && (axis[0] != 0 || axis[1] != 0))
        return tobi_fail(err, TOBI_INVALID, "body '%s': the axis of a hinge is along z in 2-D", name);
    if (kind == TOBI_JOINT_GUIDE && axis[2] != 0)
        return tobi_fail(err, TOBI_INVALID, "body '%s': the axis of a guide has no z in 2-D", name);
    return TOBI_OK;
}

static tobi_status check_stops(const tobi_body_def *def, int kind, double lower, double upper,
                               tobi_error *err)
{
    if (lower == 0 && upper == 0) return TOBI_OK;
    if (lower <= 0 && upper >= 0 && lower < upper) return TOBI_OK;
    return tobi_fail(err, TOBI_INVALID, "body '%s': the stops of its %s are %g and %g; lower is 0 or below, "
                     "upper is 0 or above, as the body starts between them", def->name ? def->name : "",
                     kinds[kind], lower, upper);
}

static tobi_status check_body(const tobi_body_def *def, tobi_error *err)
{
    const char *name = def->name ? def->name : "";
    if (def->dynamics == TOBI_PRESCRIBED)
        return tobi_fail(err, TOBI_INVALID, "body '%s' is prescribed: hinges and guides are for free and "
                         "controlled bodies", name);
    if (vec3_dot(def->hinge_axis, def->hinge_axis) > 0 && vec3_dot(def->guide_axis, def->guide_axis) > 0)
        return tobi_fail(err, TOBI_INVALID, "body '%s' has a hinge and a guide; it may have one", name);
    if (def->locked && def->locked[0])
        return tobi_fail(err, TOBI_INVALID, "body '%s' has locked axes and a hinge or guide, which leaves it "
                         "one way to move", name);
    return TOBI_OK;
}

/* The moment of inertia about the axis of the joint, at the start. */
static double find_moment(const tobi_rigid *r, const tobi_joint *j)
{
    double sum = 0, lever[3];
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) sum += j->axis[a]*r->inertia[3*a + b]*j->axis[b];
    vec3_cross(lever, j->axis, j->arm);
    return sum + r->mass*vec3_dot(lever, lever);
}

/* A start that the joint does not allow would be dropped without a word. */
static tobi_status check_start(const tobi_body_def *def, int kind, const char *key, const double given[3],
                               const double has[3], tobi_error *err)
{
    const double size = vec3_dot(given, given);
    if (!(vec3_distance2(given, has) > 1e-12*size) || !(size > 0)) return TOBI_OK;
    return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "body '%s' cannot start with that %s: its %s leaves "
                                      "it %s alone", def->name ? def->name : "", key, kinds[kind],
                                      kind == TOBI_JOINT_HINGE ? tr("the turn about the axis, set off by "
                                      "angular_velocity,")
                                      : tr("the way along the axis, set off by velocity,")),
                       "%s", key);
}

tobi_status tobi_joint_init(tobi_rigid *r, const tobi_body_def *def, const double lower[3], int dimension,
                            tobi_error *err)
{
    const int hinge = vec3_dot(def->hinge_axis, def->hinge_axis) > 0;
    const double degree = acos(-1)/180, *axis = hinge ? def->hinge_axis : def->guide_axis;
    tobi_joint *j = &r->joint;
    if (!(vec3_dot(axis, axis) > 0)) return TOBI_OK;
    j->kind = hinge ? TOBI_JOINT_HINGE : TOBI_JOINT_GUIDE;
    TOBI_TRY(check_body(def, err));
    TOBI_TRY(check_axis(def, j->kind, axis, dimension, err));
    memcpy(j->axis, axis, sizeof j->axis);
    vec3_normalize(j->axis);
    memcpy(j->point, r->position, sizeof j->point);
    if (hinge) vec3_sub(j->point, def->hinge_point, lower);
    if (hinge && dimension == 2) j->point[2] = r->position[2];
    vec3_sub(j->arm, r->position, j->point);
    j->mass = hinge ? find_moment(r, j) : r->mass;
    j->lower = hinge ? def->hinge_lower*degree : def->guide_lower;
    j->upper = hinge ? def->hinge_upper*degree : def->guide_upper;
    j->stiffness = hinge ? def->hinge_stiffness : def->guide_stiffness;
    j->damping = hinge ? def->hinge_damping : def->guide_damping;
    TOBI_TRY(check_stops(def, j->kind, j->lower, j->upper, err));
    tobi_joint_set_rate(r, vec3_dot(j->axis, hinge ? def->angular_velocity : def->velocity));
    TOBI_TRY(check_start(def, j->kind, "velocity", def->velocity, r->velocity, err));
    return check_start(def, j->kind, "angular_velocity", def->angular_velocity, r->angular_velocity, err);
}

/* --- the coordinate ---------------------------------------------------------------------------- */

void tobi_joint_span(const tobi_rigid *r, double S[6])
{
    const tobi_joint *j = &r->joint;
    double arm[3];
    memset(S, 0, 6*sizeof *S);
    if (j->kind == TOBI_JOINT_GUIDE) memcpy(S, j->axis, sizeof j->axis);
    if (j->kind != TOBI_JOINT_HINGE) return;
    vec3_sub(arm, r->position, j->point);
    vec3_cross(S, j->axis, arm);
    memcpy(S + 3, j->axis, sizeof j->axis);
}

static double dot6(const double a[6], const double b[6])
{
    return vec3_dot(a, b) + vec3_dot(a + 3, b + 3);
}

double tobi_joint_position(const tobi_rigid *r)
{
    const tobi_joint *j = &r->joint;
    const double *q = r->orientation, pi = acos(-1);
    double way[3];
    if (j->kind == TOBI_JOINT_GUIDE) {
        vec3_sub(way, r->position, j->point);
        return vec3_dot(way, j->axis);
    }
    const double angle = 2*atan2(vec3_dot(q + 1, j->axis), q[0]);
    return angle > pi ? angle - 2*pi : angle <= -pi ? angle + 2*pi : angle;
}

double tobi_joint_rate(const tobi_rigid *r)
{
    return vec3_dot(r->joint.axis, r->joint.kind == TOBI_JOINT_HINGE ? r->angular_velocity : r->velocity);
}

void tobi_joint_set_rate(tobi_rigid *r, double rate)
{
    double S[6], m[3][3], local[3], turned[3] = { 0 };
    tobi_joint_span(r, S);
    tobi_quaternion_matrix(r->orientation, m);
    for (int a = 0; a < 3; a++) {
        r->velocity[a] = rate*S[a];
        r->angular_velocity[a] = rate*S[3 + a];
    }
    for (int a = 0; a < 3; a++) {
        local[a] = 0;
        for (int b = 0; b < 3; b++) local[a] += m[b][a]*r->angular_velocity[b];
    }
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) turned[a] += r->inertia[3*a + b]*local[b];
    for (int a = 0; a < 3; a++) r->momentum[a] = vec3_dot(m[a], turned);
}

static int has_stops(const tobi_joint *j) { return j->lower < j->upper; }

/* -1 at the lower stop, 1 at the upper. */
static int find_stop(const tobi_rigid *r)
{
    const tobi_joint *j = &r->joint;
    if (!has_stops(j)) return 0;
    const double q = tobi_joint_position(r), near = AT_STOP*(j->upper - j->lower);
    return q <= j->lower + near ? -1 : q >= j->upper - near ? 1 : 0;
}

void tobi_joint_freedom(const tobi_rigid *r, double s[6])
{
    memset(s, 0, 6*sizeof *s);
    if (!r->joint.kind || (!r->joint.pulled && tobi_joint_rate(r) == 0 && find_stop(r))) return;
    tobi_joint_span(r, s);
    for (int a = 0; a < 6; a++) s[a] /= sqrt(r->joint.mass);
}

void tobi_joint_place(tobi_rigid *r, double way)
{
    const tobi_joint *j = &r->joint;
    if (has_stops(j)) {
        const double q = tobi_joint_position(r);
        way = fmin(fmax(q + way, j->lower), j->upper) - q;
    }
    memcpy(r->next_orientation, r->orientation, sizeof r->orientation);
    vec3_add_scaled(r->next_position, r->position, way, j->axis);
    if (j->kind == TOBI_JOINT_GUIDE) return;
    double turn[4] = { cos(0.5*way) }, m[3][3], size = 0;
    for (int a = 0; a < 3; a++) turn[1 + a] = sin(0.5*way)*j->axis[a];
    tobi_quaternion_product(turn, r->orientation, r->next_orientation);
    for (int k = 0; k < 4; k++) size += r->next_orientation[k]*r->next_orientation[k];
    for (int k = 0; k < 4; k++) r->next_orientation[k] /= sqrt(size);
    tobi_quaternion_matrix(r->next_orientation, m);
    for (int a = 0; a < 3; a++) r->next_position[a] = j->point[a] + vec3_dot(m[a], j->arm);
}

/* --- forces ------------------------------------------------------------------------------------ */

void tobi_joint_add_spring(const tobi_rigid *r, double load[6])
{
    const tobi_joint *j = &r->joint;
    if (!(j->stiffness > 0)) return;
    double *at = load + (j->kind == TOBI_JOINT_HINGE ? 3 : 0);
    vec3_add_scaled(at, at, -j->stiffness*tobi_joint_position(r), j->axis);
}

double tobi_joint_pull(const tobi_rigid *r)
{
    double S[6], load[6];
    for (int a = 0; a < 3; a++) {
        load[a] = r->mass*r->pull[a];
        load[3 + a] = r->pull_torque[a];
    }
    tobi_joint_add_spring(r, load);
    tobi_joint_span(r, S);
    return dot6(S, load)/r->joint.mass;
}

void tobi_joint_drift(tobi_rigid *r, double dt)
{
    tobi_joint *j = &r->joint;
    const double keep = tobi_rigid_keep(r, dt), rate = j->rate = tobi_joint_rate(r);
    const double *push = j->kind == TOBI_JOINT_HINGE ? r->turn : r->push;
    double s[6];
    tobi_joint_load_open(r);
    tobi_joint_span(r, j->freedom);
    tobi_joint_freedom(r, s);
    j->held = vec3_dot(r->pull, r->pull) + vec3_dot(r->pull_torque, r->pull_torque) == 0;
    j->driven = 0;
    j->pull = tobi_joint_pull(r);
    const int rests = dot6(s, s) == 0;
    const double pull = rests || j->held ? 0 : j->pull;
    const double joined = rests ? 0 : dot6(j->freedom, r->constraint)/j->mass;
    tobi_joint_place(r, 0.5*dt*(rate + keep*(rate + dt*pull)) + dt*joined + vec3_dot(j->axis, push));
}

/* A load along the coordinate: a force on a guide, a torque on a hinge. */
static void feel_air(tobi_rigid *r, double load, const double S[6])
{
    const int hinge = r->joint.kind == TOBI_JOINT_HINGE;
    for (int a = 0; a < 6; a++) r->air[a] = hinge == (a >= 3) ? load*S[a] : 0;
}

/* Velocity Verlet alone; a liquid's drift took the pull where it began, and contact has none. */
void tobi_joint_kick(tobi_rigid *r, double dt, const double impulse[6], const double damped[6])
{
    tobi_joint *j = &r->joint;
    const double now = tobi_joint_pull(r), pull = j->driven ? j->pull : j->held ? now : 0.5*(j->pull + now);
    double S[6];
    tobi_joint_load_kick(r, dt, impulse, damped);
    tobi_joint_span(r, S);
    const double change = dt*pull + (dot6(j->freedom, impulse) + dt*dot6(S, damped))/j->mass,
                 rate = tobi_joint_rate(r) + change, keep = tobi_rigid_keep(r, dt);
    const double share = j->damping > 0 ? j->damping/(j->damping + j->mass*r->air_resistance) : 0;
    j->damped = share*j->mass*(1 - keep)*rate;
    feel_air(r, dt > 0 ? -(1 - share)*j->mass*(1 - keep)*rate/dt : 0, S);
    tobi_joint_set_rate(r, keep*rate);
}

void tobi_joint_stop(tobi_rigid *r, double dt, double bounce, const double impulse[6])
{
    const int stop = find_stop(r);
    double S[6], s[6], rate = tobi_joint_rate(r);
    if (!stop) return;
    tobi_joint_span(r, S);
    tobi_joint_freedom(r, s);
    if (dot6(s, s) == 0) rate += dot6(S, impulse)/r->joint.mass;
    r->joint.stopped -= r->joint.mass*rate;
    if (rate*stop > 0)
        rate = rate*stop > bounce*fabs(tobi_joint_pull(r))*dt ? -r->restitution*rate : 0;
    r->joint.stopped += r->joint.mass*rate;
    tobi_joint_set_rate(r, rate);
}

double tobi_joint_energy(const tobi_rigid *r)
{
    const double stiffness = r->joint.stiffness, q = stiffness > 0 ? tobi_joint_position(r) : 0;
    return 0.5*stiffness*q*q;
}

double tobi_joint_step_limit(const tobi_rigid *r)
{
    const tobi_joint *j = &r->joint;
    return j->kind && j->stiffness > 0 ? sqrt(j->mass/j->stiffness)/3 : INFINITY;
}
