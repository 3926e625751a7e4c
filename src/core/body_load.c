/* What the systems press a body with, and what of that and of its pose is told. Drawback: a body keeps room
   for every system, though most scenes have one. */
#include "core/body.h"
#include "geom/vec3.h"
#include <string.h>

static void keep_pose(tobi_swimmer *w, const tobi_rigid *r)
{
    memcpy(w->start.centre, w->centre, sizeof w->centre);
    memcpy(w->start.steer, w->steer, sizeof w->steer);
    memcpy(w->start.position, r->position, sizeof r->position);
    memcpy(w->start.orientation, r->orientation, sizeof r->orientation);
}

void tobi_body_clear_loads(tobi_body *b)
{
    if (b->swimmer) keep_pose(b->swimmer, &b->rigid);
    memset(b->load, 0, sizeof b->load);
    memcpy(b->start, b->rigid.velocity, sizeof b->rigid.velocity);
    memcpy(b->start + 3, b->rigid.angular_velocity, sizeof b->rigid.angular_velocity);
    memcpy(b->start + 6, b->rigid.momentum, sizeof b->rigid.momentum);
}

/* Of a swimmer the motion has none of the rigid velocities; of a driven body they are in it. */
static void leave_flow(const tobi_body *b, const double place[3], double velocity[3])
{
    double rigid[3];
    if (b->swimmer) return;
    tobi_body_carry(b, place, b->start, rigid);
    vec3_sub(velocity, velocity, rigid);
}

double tobi_body_point_acceleration(const tobi_body *b, int64_t point, double dt)
{
    const double (*now)[3] = (const double (*)[3])(b->swimmer ? b->swimmer->point_flow : b->point_velocity);
    double change[3];
    if (!b->motion) return 0;
    vec3_sub(change, now[point], b->point_before[point]);
    return vec3_dot(b->normal[point], change)/dt;
}

void tobi_body_point_flow(const tobi_body *b, int64_t point, double flow[3])
{
    memcpy(flow, b->swimmer ? b->swimmer->point_flow[point] : b->point_velocity[point], 3*sizeof *flow);
    leave_flow(b, b->point[point], flow);
}

void tobi_body_place_flow(const tobi_body *b, int32_t triangle, const double barycentric[3],
                          const double place[3], double flow[3])
{
    const double (*of)[3] = (const double (*)[3])(b->swimmer ? b->swimmer->flow : b->vertex_velocity);
    memset(flow, 0, 3*sizeof *flow);
    for (int c = 0; c < 3; c++)
        vec3_add_scaled(flow, flow, barycentric[c], of[b->mesh.triangles[triangle][c]]);
    leave_flow(b, place, flow);
}

void tobi_body_mean_velocity(const tobi_body *b, double u[6])
{
    const double share = b->rigid.kind == TOBI_PRESCRIBED ? 1 : 0.5;
    for (int a = 0; a < 3; a++) {
        u[a] = share*b->rigid.velocity[a] + (1 - share)*b->start[a];
        u[3 + a] = share*b->rigid.angular_velocity[a] + (1 - share)*b->start[3 + a];
    }
}

/* What a swimmer gives: to what it touches, and to its own turn, as it changes its inertia (R.29). */
static double find_swimming(const tobi_body *b, double shape, double dt)
{
    const tobi_rigid *r = &b->rigid;
    const double turn = vec3_dot(b->start + 6, r->angular_velocity) - vec3_dot(r->momentum, b->start + 3);
    return 0.5*turn/dt - shape - b->touch_power;
}

void tobi_body_find_power(tobi_body *b, double dt)
{
    const tobi_body_info *i = &b->info;
    const int driven = b->rigid.kind == TOBI_PRESCRIBED;
    double mean[6], shape = 0;
    tobi_body_mean_velocity(b, mean);
    const double *u = driven && b->deforms ? b->start : mean;
    for (int k = 0; b->deforms && k < TOBI_SYSTEM_LIMIT; k++) shape += b->load[k].shape;
    const double by_particles = vec3_dot(i->pressure_force, u) + vec3_dot(i->viscous_force, u) +
                                vec3_dot(i->pressure_torque, u + 3) + vec3_dot(i->viscous_torque, u + 3) +
                                shape;
    b->power[TOBI_BY_PARTICLES] = by_particles;
    b->power[TOBI_BY_CONTACT] = vec3_dot(i->contact_force, mean) + vec3_dot(i->contact_torque, mean + 3) +
                                b->touch_power;
    b->power[TOBI_BY_MOTION] = driven ? -by_particles : b->swimmer ? find_swimming(b, shape, dt) : 0;
    b->power[TOBI_BY_FORCE] = vec3_dot(b->rigid.given, mean) + vec3_dot(b->rigid.given + 3, mean + 3);
    b->power[TOBI_BY_AIR] = vec3_dot(b->rigid.air, mean) + vec3_dot(b->rigid.air + 3, mean + 3);
    b->power[TOBI_BY_NEST] = vec3_dot(b->rigid.finer, mean) + vec3_dot(b->rigid.finer + 3, mean + 3);
    b->power[TOBI_BY_FIELD] = vec3_dot(b->rigid.inertial, mean) + vec3_dot(b->rigid.inertial + 3, mean + 3);
}

/* What is rounding alone in 2-D: the force along z and the torques about x and y. */
static void flatten(double load[6])
{
    for (int a = 2; a < 5; a++) load[a] = 0;
}

void tobi_body_sum_loads(tobi_body *b)
{
    tobi_body_load sum = b->load[0];
    for (int k = 1; k < TOBI_SYSTEM_LIMIT; k++) {
        for (int a = 0; a < 6; a++) {
            sum.pressure[a] += b->load[k].pressure[a];
            sum.friction[a] += b->load[k].friction[a];
        }
        vec3_add_scaled(sum.edge, sum.edge, 1, b->load[k].edge);
    }
    if (b->surface.dimension == 2) {
        flatten(sum.pressure);
        flatten(sum.friction);
    }
    memcpy(b->info.pressure_force, sum.pressure, sizeof b->info.pressure_force);
    memcpy(b->info.pressure_torque, sum.pressure + 3, sizeof b->info.pressure_torque);
    memcpy(b->info.viscous_force, sum.friction, sizeof b->info.viscous_force);
    memcpy(b->info.viscous_torque, sum.friction + 3, sizeof b->info.viscous_torque);
    memcpy(b->info.edge_force, sum.edge, sizeof b->info.edge_force);
}

void tobi_body_report(tobi_body *b)
{
    const tobi_rigid *r = &b->rigid;
    vec3_add_scaled(b->centre, b->lower, 1, r->position);
    memcpy(b->info.position, b->centre, sizeof b->centre);
    memcpy(b->info.orientation, r->orientation, sizeof b->info.orientation);
    memcpy(b->info.velocity, r->velocity, sizeof b->info.velocity);
    memcpy(b->info.angular_velocity, r->angular_velocity, sizeof b->info.angular_velocity);
}

int tobi_body_any_free(const tobi_body *bodies, int count)
{
    for (int k = 0; k < count; k++)
        if (bodies[k].rigid.kind != TOBI_PRESCRIBED) return 1;
    return 0;
}

int tobi_body_any_deforms(const tobi_body *bodies, int count)
{
    for (int k = 0; k < count; k++)
        if (bodies[k].deforms) return 1;
    return 0;
}
