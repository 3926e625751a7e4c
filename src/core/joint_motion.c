/* Joints to a prescribed body: where its motion takes their side in a step. Such a body has no W; its
   velocity is the pace of the rows. Drawback: a mean over the step, so that forces lag by half of one. */
#include "core/constraint.h"
#include "geom/vec3.h"
#include <string.h>

tobi_status tobi_constraint_follow(tobi_constraint *j, const tobi_body *bodies, double arm, double t,
                                   double dt, tobi_error *err)
{
    const tobi_body *b = &bodies[j->body[1]];
    double rest[2][3], now[2][3], centre[3], frame[3][3];
    vec3_add_scaled(rest[0], b->rest.centre, 1, j->point[1]);
    vec3_add_scaled(rest[1], rest[0], arm, j->axis[1]);
    memcpy(now, rest, sizeof now);
    memcpy(j->next_turn, b->rigid.orientation, sizeof j->next_turn);
    memset(j->spin, 0, sizeof j->spin);
    if (b->motion) {
        TOBI_TRY(tobi_body_ask_motion(b, t + dt, 2, (const double (*)[3])rest, now, err));
        TOBI_TRY(tobi_body_find_frame(b, t + dt, centre, frame, err));
        tobi_frame_quaternion((const double (*)[3])frame, j->next_turn);
        tobi_frame_rate((const double (*)[3])b->frame, (const double (*)[3])frame, dt, j->spin);
    }
    vec3_sub(j->next_point, now[0], b->lower);
    vec3_sub(j->next_axis, now[1], now[0]);
    vec3_normalize(j->next_axis);
    return TOBI_OK;
}
