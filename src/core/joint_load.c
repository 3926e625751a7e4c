/* The load of a body's own hinge or guide: what the balance of momentum over a step leaves when all other
   impulses are known (R.26). Drawback: an impact is spread over its step. */
#include "core/joint.h"
#include "core/rigid.h"
#include "geom/vec3.h"
#include <math.h>
#include <string.h>

/* m, to the body's centre at x from the point that moments are about: of a guide the centre itself. */
static void find_arm(const tobi_joint *j, const double x[3], double arm[3])
{
    memset(arm, 0, 3*sizeof *arm);
    if (j->kind == TOBI_JOINT_HINGE) vec3_sub(arm, x, j->point);
}

/* Adds `times` f, force and moment about the centre at x, to a sum about the point. */
static void add_at(const tobi_joint *j, const double x[3], double times, const double f[6], double sum[6])
{
    double arm[3], lever[3];
    find_arm(j, x, arm);
    vec3_cross(lever, arm, f);
    vec3_add_scaled(sum, sum, times, f);
    vec3_add_scaled(sum + 3, sum + 3, times, f + 3);
    vec3_add_scaled(sum + 3, sum + 3, times, lever);
}

static void add_pull(const tobi_rigid *r, const double x[3], double times, double sum[6])
{
    double f[6];
    for (int a = 0; a < 3; a++) {
        f[a] = r->mass*r->pull[a];
        f[3 + a] = r->pull_torque[a];
    }
    add_at(&r->joint, x, times, f, sum);
}

/* kg m/s, and kg m2/s about the point. */
static void find_momentum(const tobi_rigid *r, double out[6])
{
    double p[6];
    for (int a = 0; a < 3; a++) {
        p[a] = r->mass*r->velocity[a];
        p[3 + a] = r->momentum[a];
    }
    memset(out, 0, 6*sizeof *out);
    add_at(&r->joint, r->position, 1, p, out);
}

void tobi_joint_load_open(tobi_rigid *r)
{
    memcpy(r->joint.before, r->position, sizeof r->joint.before);
    find_momentum(r, r->joint.momentum);
}

void tobi_joint_load_begin(tobi_rigid *r, double dt)
{
    tobi_joint *j = &r->joint;
    j->stopped = 0;
    memset(j->other, 0, sizeof j->other);
    add_pull(r, j->before, dt*(j->driven ? 1 : j->held ? 0 : 0.5), j->other);
}

void tobi_joint_load_kick(tobi_rigid *r, double dt, const double impulse[6], const double damped[6])
{
    tobi_joint *j = &r->joint;
    add_pull(r, r->position, dt*(j->driven ? 0 : j->held ? 1 : 0.5), j->other);
    add_at(j, j->before, 1, impulse, j->other);
    add_at(j, r->position, dt, damped, j->other);
}

void tobi_joint_load_add(tobi_rigid *r, const double impulse[6])
{
    add_at(&r->joint, r->position, 1, impulse, r->joint.other);
}

/* Of what acts along the coordinate, spring and damper are not told: the stop alone. */
static void find_load(const tobi_rigid *r, double dt, double load[6])
{
    const tobi_joint *j = &r->joint;
    double now[6], *along = j->kind == TOBI_JOINT_HINGE ? load + 3 : load;
    find_momentum(r, now);
    for (int a = 0; a < 6; a++)
        load[a] = (now[a] - j->momentum[a] - j->other[a])/dt +
                  0.5*r->air_resistance*(now[a] + j->momentum[a]);
    vec3_add_scaled(along, along, j->stopped/dt - vec3_dot(along, j->axis), j->axis);
}

void tobi_joint_report(tobi_rigid *r, double dt)
{
    tobi_joint *j = &r->joint;
    double load[6] = { 0 };
    const double before = j->rate, now = tobi_joint_rate(r);
    if (dt > 0) find_load(r, dt, load);
    j->pulled = 0;
    j->info.power = dt > 0 ? 0.5*(before + now)*j->damped/dt : 0;
    memcpy(j->info.force, load, sizeof j->info.force);
    memcpy(j->info.moment, load + 3, sizeof j->info.moment);
    j->info.angle = j->kind == TOBI_JOINT_HINGE ? tobi_joint_position(r)*180/acos(-1) : 0;
}
