/* Speeds that are no numbers any more, or that nothing in the scene explains, end the run, with a word about
   what may help. Drawback: the word is the likely cause, which is not looked for further. */
#include "world/runaway.h"
#include "world/limits.h"
#include "world/openings.h"
#include "base/error.h"
#include "geom/vec3.h"
#include <math.h>
#include <stdio.h>

/* Which key of the scene makes steps shorter, and its value. */
static const char *name_cfl(const tobi_system *s, double *value)
{
    const tobi_world_def *d = &s->sim->def;
    const int mpm = s->method->solids;
    *value = mpm ? ((const tobi_mlsmpm_def *)s->def)->cfl : d->time_step > 0 ? d->time_step : d->cfl;
    return mpm ? "mlsmpm.cfl" : d->time_step > 0 ? "time_step" : "cfl";
}

/* Spacings that the fastest particle goes while a body that has come back is still the likely cause. */
static const double RETURN_REACH = 20;
/* Share of the domain from which liquid that inlets bring has pockets without a free surface. */
static const double CROWDED = 0.8;

/* m/s, of its fastest corner, as it is after the step. */
static double find_speed(const tobi_body *b)
{
    const tobi_rigid *r = &b->rigid;
    const int moved = r->kind == TOBI_PRESCRIBED || b->swimmer;     /* with velocities of its corners */
    double most = 0;
    for (int64_t i = 0; i < b->mesh.vertex_count; i++) {
        double v[3], arm[3];
        vec3_sub(arm, b->vertex[i], r->position);
        vec3_cross(v, r->angular_velocity, arm);
        vec3_add_scaled(v, v, 1, r->velocity);
        const double *corner = moved ? b->vertex_velocity[i] : v;
        most = fmax(most, vec3_dot(corner, corner));
    }
    return sqrt(most);
}

/* What may help besides a smaller step. Liquid in a body that comes back lands in a layer beside it at once,
   crowded as it never is else: pressure throws it. */
static void name_remedy(const tobi_system *s, double limit, char text[TOBI_NOTE])
{
    const tobi_body *b = s->sim->bodies;
    for (int k = 0; k < s->sim->body_count; k++, b++) {
        const double since = s->sim->time - b->absent[1], speed = find_speed(b);
        if (speed > limit) {
            snprintf(text, TOBI_NOTE, tr(". Body '%s' moves at %.3g m/s: let its motion, motor or force "
                     "begin at 0 and grow over time"), b->name, speed);
            return;
        }
        if (!(b->absent[1] > 0 && since >= 0 && since*limit < RETURN_REACH*s->smoothing.spacing)) continue;
        snprintf(text, TOBI_NOTE, tr(". Body '%s' has just come back, and the liquid in it was pushed out at "
                 "once: let a thick body come into liquid by a motion"), b->name);
        return;
    }
    if (tobi_openings_share(s) > CROWDED)
        snprintf(text, TOBI_NOTE, tr(". The inlets have all but filled the domain: stop them before, add an "
                 "outlet, or make the domain larger"));
    else if (s->sim->def.speed_limit <= 0)
        snprintf(text, TOBI_NOTE, tr(", or a speed_limit, where liquid is meant to be that fast"));
}

tobi_status tobi_runaway_check(const tobi_system *s, tobi_error *err)
{
    double limit = s->sim->def.speed_limit, cfl;
    const char *key = name_cfl(s, &cfl);
    char remedy[TOBI_NOTE] = "";
    if (limit <= 0) {
        /* A few squeezed particles are slowed; when many are, or a number is no number, the run is lost. */
        const int64_t few = 20 + s->particles.count/200;
        if (s->info.speed_max < TOBI_SPEED_LIMIT && s->info.capped <= few) return TOBI_OK;
        limit = fmin(2.8*tobi_system_speed_scale(s), TOBI_SPEED_LIMIT);
    }
    if (s->info.speed_max < limit) return TOBI_OK;
    name_remedy(s, limit, remedy);
    for (int64_t i = 0; i < s->particles.count; i++) {
        tobi_float4 v = s->particles.velocity[i];
        tobi_double3 x = s->particles.position[i];
        double speed = sqrt((double)v.x*v.x + (double)v.y*v.y + (double)v.z*v.z);
        if (speed < limit || speed == 0) continue;   /* NaN goes on */
        if (!isfinite(speed))
            return tobi_fail(err, TOBI_DIVERGED,
                             "the simulation diverged at t = %.9g s, step %lld: the speed of particle %lld "
                             "at (%g, %g, %g) m is no number any more; a %s smaller than %g may help%s",
                             s->sim->time, (long long)s->sim->step, (long long)s->particles.id[i],
                             x.x + s->box.lower[0], x.y + s->box.lower[1], x.z + s->box.lower[2], key, cfl,
                             remedy);
        return tobi_fail(err, TOBI_DIVERGED,
                         "the simulation diverged at t = %.9g s, step %lld: particle %lld at (%g, "
                         "%g, %g) m moves at %g m/s, the limit is %g m/s; a %s smaller than %g may "
                         "help%s",
                         s->sim->time, (long long)s->sim->step, (long long)s->particles.id[i],
                         x.x + s->box.lower[0], x.y + s->box.lower[1], x.z + s->box.lower[2], speed,
                         limit, key, cfl, remedy);
    }
    return tobi_fail(err, TOBI_DIVERGED,
                     "the simulation diverged at t = %.9g s: a speed reached %g m/s; a %s smaller than %g "
                     "may help%s", s->sim->time, s->info.speed_max, key, cfl, remedy);
}
