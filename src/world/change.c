/* What a program may change between steps: gravity, forces on bodies, their motions. All checks come
   before the first change. Drawback: a motion is a function, which no checkpoint holds; a flag there says
   that it must be set again. */
#include "world/change.h"
#include "base/error.h"
#include "rigid/dynamics.h"
#include "world/limits.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Spacings that a new motion may have a body off its place: what formulas and tables differ by. */
static const double JUMP = 0.1;

static tobi_status check_gravity(const tobi_world_def *d, tobi_error *err)
{
    tobi_error why = { 0 };
    const double most = 1e6;            /* m/s2, as in the table of the definition */
    for (int a = 0; a < 3; a++)
        if (!(fabs(d->gravity[a]) <= most))
            return tobi_fail(err, TOBI_INVALID, "gravity is (%g, %g, %g) m/s2; allowed are numbers from "
                             "%g to %g", d->gravity[0], d->gravity[1], d->gravity[2], -most, most);
    if (d->dimension == 2 && d->gravity[2] != 0)
        return tobi_fail(err, TOBI_INVALID, "gravity is %g m/s2 in z, must be 0 in a 2-D world",
                         d->gravity[2]);
    const tobi_status status = tobi_limits_gravity(d, &why);
    return status ? tobi_fail(err, status, "gravity %s", why.text) : TOBI_OK;
}

static void put_gravity(tobi_world *w, const double gravity[3])
{
    memcpy(w->sim.def.gravity, gravity, sizeof w->sim.def.gravity);
    for (int k = 0; k < w->system_count; k++) {
        tobi_system *s = &w->system[k];
        memcpy(s->gravity, gravity, sizeof s->gravity);
        if (w->started) s->start_head = tobi_world_start_head(w, s);
    }
    w->fresh = 0;
}

static void follow_gravity(tobi_world *w, int loaded)
{
    for (int k = 0; k < w->system_count; k++)
        if (w->system[k].state && w->system[k].method->follow_gravity)
            w->system[k].method->follow_gravity(&w->system[k], loaded);
}

tobi_status tobi_world_set_gravity(tobi_world *w, const double gravity[3], tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    TOBI_NEED(gravity, "the gravity");
    tobi_simulation *s = &w->sim;
    tobi_world_def def = s->def;
    memcpy(def.gravity, gravity, sizeof def.gravity);
    TOBI_TRY(check_gravity(&def, err));
    if (memcmp(def.gravity, s->def.gravity, sizeof def.gravity) == 0) return TOBI_OK;
    TOBI_TRY(tobi_world_check_whole(w, err));
    if (s->step > 0) TOBI_TRY(tobi_world_refresh(w, err));
    for (int k = 0; k < w->system_count && s->step > 0; k++)      /* what it has set in motion stays so */
        w->system[k].start_speed = fmax(w->system[k].start_speed, tobi_system_fall_speed(&w->system[k]));
    put_gravity(w, def.gravity);
    if (w->dynamics) tobi_rigid_set_gravity(w->dynamics, def.gravity);
    follow_gravity(w, 0);
    return TOBI_OK;
}

void tobi_world_restore_gravity(tobi_world *w, const double gravity[3])
{
    put_gravity(w, gravity);
    if (w->dynamics) tobi_rigid_restore_gravity(w->dynamics, gravity);
    follow_gravity(w, 1);
}

static tobi_status find_body(tobi_world *w, int body, tobi_body **b, tobi_error *err)
{
    *b = NULL;
    if (body < 0 || body >= w->sim.body_count)
        return tobi_fail(err, TOBI_NOT_FOUND, "there is no body %d; they count from 0, and the world has "
                         "%d", body, w->sim.body_count);
    *b = &w->sim.bodies[body];
    return TOBI_OK;
}

tobi_status tobi_world_set_body_force(tobi_world *w, int body, const double force[3],
                                      const double torque[3], tobi_error *err)
{
    tobi_body *b;
    const double most = 1e15;           /* N, N m, as in the table of the definition */
    TOBI_NEED_WORLD(w);
    TOBI_NEED(force && torque, "the force or torque");
    TOBI_TRY(find_body(w, body, &b, err));
    if (b->rigid.kind == TOBI_PRESCRIBED)
        return tobi_fail(err, TOBI_INVALID, "body '%s' is prescribed; free and controlled bodies take "
                         "forces", b->name);
    for (int a = 0; a < 3; a++)
        if (!(fabs(force[a]) <= most && fabs(torque[a]) <= most))
            return tobi_fail(err, TOBI_INVALID, "body '%s': the force is (%g, %g, %g) N, the torque "
                             "(%g, %g, %g) N m; allowed are numbers from %g to %g", b->name, force[0],
                             force[1], force[2], torque[0], torque[1], torque[2], -most, most);
    if (w->sim.def.dimension == 2 && (force[2] != 0 || torque[0] != 0 || torque[1] != 0))
        return tobi_fail(err, TOBI_INVALID, "body '%s': the force is %g N in z, the torque (%g, %g) N m "
                         "about x and y; in a 2-D world these must be 0", b->name, force[2], torque[0],
                         torque[1]);
    TOBI_TRY(tobi_world_check_whole(w, err));
    if (w->dynamics) {
        tobi_rigid_set_force(w->dynamics, body, force, torque);
        return TOBI_OK;
    }
    memcpy(b->rigid.force, force, sizeof b->rigid.force);
    memcpy(b->rigid.torque, torque, sizeof b->rigid.torque);
    return TOBI_OK;
}

/* How far the motion has the body from where it is, m. */
static tobi_status find_jump(const tobi_world *w, const tobi_body *b, tobi_motion_fn motion, void *user,
                             double *jump, tobi_error *err)
{
    const int64_t n = b->mesh.vertex_count;
    double (*at)[3] = malloc((size_t)(n + 1)*sizeof *at), most = 0;
    if (!at) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the vertices of '%s'", b->name);
    if (b->swimmer && b->steer) b->steer(user, b->swimmer->steer);
    const tobi_status status = motion(user, w->sim.time, n, (const double (*)[3])b->mesh.vertices, at, err);
    if (status == TOBI_OK && b->swimmer) tobi_body_pose_shape(b, n, at);
    for (int64_t i = 0; status == TOBI_OK && i < n; i++)
        for (int a = 0; a < 3; a++) {
            const double way = fabs(at[i][a] - b->lower[a] - b->vertex[i][a]);
            if (!(way <= most)) most = way;        /* NaN stays */
        }
    free(at);
    *jump = most;
    return status;
}

tobi_status tobi_world_set_body_motion(tobi_world *w, int body, tobi_motion_fn motion, void *user,
                                       tobi_error *err)
{
    tobi_body *b;
    double jump = 0;
    TOBI_NEED_WORLD(w);
    TOBI_NEED(motion, "the motion");
    TOBI_TRY(find_body(w, body, &b, err));
    if (!b->motion)
        return tobi_fail(err, TOBI_INVALID, "body '%s' has no motion that could be replaced; give it one "
                         "in its definition, which may stand still", b->name);
    TOBI_TRY(tobi_world_check_whole(w, err));
    TOBI_TRY(find_jump(w, b, motion, user, &jump, err));
    if (!(jump <= JUMP*w->sim.def.spacing))
        return tobi_fail(err, TOBI_INVALID, "body '%s' would jump by %.3g m: its new motion has it "
                         "elsewhere at t = %.9g s; allowed are %.3g m, a tenth of the spacing", b->name, jump,
                         w->sim.time, JUMP*w->sim.def.spacing);
    b->motion = motion;
    b->motion_user = user;
    b->motion_set = 1;
    b->motion_due = 0;
    return TOBI_OK;
}

tobi_status tobi_world_check_motions(const tobi_world *w, tobi_error *err)
{
    for (int k = 0; k < w->sim.body_count; k++)
        if (w->sim.bodies[k].motion_due)
            return tobi_fail(err, TOBI_INVALID, "body '%s' had its motion set before the checkpoint was "
                             "written; set it again", w->sim.bodies[k].name);
    return TOBI_OK;
}
