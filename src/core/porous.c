/* Porous zones that go along with bodies: from where they started to where they are. Drawback: the pose is
   that of the begin of a step, in all of it. */
#include "core/body.h"
#include "core/porous.h"
#include "geom/vec3.h"
#include <math.h>

/* Of a body that moves by forces by its state alone, which a restart knows to the last bit. */
static void find_pose(const tobi_body *b, double centre[3], double frame[3][3])
{
    double m[3][3];
    const int moves = b->rigid.kind != TOBI_PRESCRIBED;
    tobi_quaternion_matrix(b->rigid.orientation, m);
    for (int a = 0; a < 3; a++) {
        centre[a] = moves ? b->rigid.position[a] : b->centre[a] - b->lower[a];
        for (int k = 0; k < 3; k++) frame[k][a] = moves ? m[a][k] : b->frame[k][a];
    }
}

void tobi_porous_attach(tobi_porous *z, const tobi_body *b)
{
    tobi_porous_pose *p = &z->pose;
    double half[3], centre[3];
    find_pose(b, centre, p->frame);
    for (int a = 0; a < 3; a++) {
        p->start[a] = 0.5*(z->lower[a] + z->upper[a]);
        half[a] = 0.5*(z->upper[a] - z->lower[a]);
        p->arm[a] = p->start[a] - centre[a];
    }
    p->reach = vec3_length(half)*(1 + 1e-9);
    tobi_porous_follow(z, b);
}

void tobi_porous_turn(const tobi_porous *z, const double start[3], double now[3])
{
    for (int a = 0; a < 3; a++) now[a] = vec3_dot(z->pose.turn[a], start);
}

void tobi_porous_move(const tobi_porous *z, const double start[3], double now[3])
{
    double from[3];
    vec3_sub(from, start, z->pose.start);
    tobi_porous_turn(z, from, now);
    vec3_add_scaled(now, now, 1, z->pose.middle);
}

void tobi_porous_follow(tobi_porous *z, const tobi_body *b)
{
    tobi_porous_pose *p = &z->pose;
    double arm[3], frame[3][3];
    find_pose(b, p->centre, frame);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            p->turn[i][j] = 0;
            for (int k = 0; k < 3; k++) p->turn[i][j] += frame[k][i]*p->frame[k][j];
        }
    tobi_porous_turn(z, p->arm, arm);
    for (int a = 0; a < 3; a++) {
        p->middle[a] = p->centre[a] + arm[a];
        p->speed[a] = b->rigid.velocity[a];
        p->speed[3 + a] = b->rigid.angular_velocity[a];
    }
    p->away = b->is_absent;
}

void tobi_porous_arm(const tobi_porous *z, const double x[3], const double size[3], double arm[3])
{
    const tobi_porous_pose *p = &z->pose;
    for (int a = 0; a < 3; a++) {
        double way = x[a] - p->middle[a];
        if (size[a] > 0) way -= size[a]*nearbyint(way/size[a]);
        arm[a] = way + (p->middle[a] - p->centre[a]);
    }
}

int tobi_porous_recall(const tobi_porous *z, const double arm[3], double start[3])
{
    const tobi_porous_pose *p = &z->pose;
    double way[3];
    for (int a = 0; a < 3; a++) way[a] = arm[a] - (p->middle[a] - p->centre[a]);
    for (int a = 0; a < 3; a++)
        start[a] = p->start[a] + p->turn[0][a]*way[0] + p->turn[1][a]*way[1] + p->turn[2][a]*way[2];
    return vec3_dot(way, way) <= p->reach*p->reach;
}
