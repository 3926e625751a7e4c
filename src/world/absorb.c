/* A piston moves by its own motion and by a shift besides it, which follows the error of the level in front
   of it. The error is measured after a step and acts in the next. Drawback: one gauge on the middle of the
   piston; waves that come back at an angle are absorbed in part. */
#include "world/absorb.h"
#include "base/error.h"
#include "geom/vec3.h"
#include "rigid/waves.h"
#include "sph/sensor/sensor.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct absorber {
    int body;
    const tobi_waves *waves;         /* of its motion                                                    */
    double direction[3];             /* where its waves go                                               */
    tobi_absorption how;
    double lower, upper;             /* m, along the direction: where the domain ends                    */
    double state[TOBI_ABSORB_DOUBLES];     /* m, m/s, m, m, m: way and speed of the shift, error of the level
                                              and its mean, the level after the first step               */
    double next[2];                  /* way and speed after the step                                     */
} absorber;

struct tobi_absorbers { absorber *at; int count; };

/* How far the body reaches along the direction, from the domain's lower corner. */
static double find_end(const tobi_body *b, const double direction[3], double sign)
{
    double most = -INFINITY;
    for (int64_t i = 0; i < b->mesh.vertex_count; i++)
        most = fmax(most, sign*vec3_dot(b->vertex[i], direction));
    return sign*most;
}

static double measure_level(const tobi_world *w, const absorber *a)
{
    const tobi_body *b = &w->sim.bodies[a->body];
    double x[3], middle[3];
    vec3_sub(middle, b->centre, b->lower);
    const double front = find_end(b, a->direction, 1) + a->how.distance;
    vec3_add_scaled(x, b->centre, front - vec3_dot(middle, a->direction), a->direction);
    return tobi_sensor_level(tobi_world_fluids(w), -1, x);
}

/* Where the domain ends along the direction, as seen from inside. */
static void find_room(const tobi_world *w, absorber *a)
{
    const tobi_box *box = &w->system[0].box;
    a->lower = a->upper = 0;
    for (int c = 0; c < box->dimension; c++) {
        const double end = a->direction[c]*box->size[c];
        a->lower += fmin(end, 0);
        a->upper += fmax(end, 0);
    }
}

static tobi_status add(tobi_world *w, int body, tobi_error *err)
{
    absorber a = { .body = body };
    const tobi_body *b = &w->sim.bodies[body];
    if (b->motion != tobi_motion_positions) return TOBI_OK;
    a.waves = tobi_motion_absorber(b->motion_user, a.direction);
    if (!a.waves) return TOBI_OK;
    if (!tobi_world_fluids(w))
        return tobi_fail(err, TOBI_UNSUPPORTED, "body '%s' absorbs waves, which the method %s does not know; "
                         "the SPH methods do", b->name, w->system[0].method->name);
    tobi_waves_absorption(a.waves, &a.how);
    find_room(w, &a);
    absorber *more = realloc(w->absorbers->at, (size_t)(w->absorbers->count + 1)*sizeof *more);
    if (!more) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a piston");
    w->absorbers->at = more;
    more[w->absorbers->count++] = a;
    return TOBI_OK;
}

tobi_status tobi_absorb_start(tobi_world *w, tobi_error *err)
{
    if (!w->absorbers) w->absorbers = calloc(1, sizeof *w->absorbers);
    if (!w->absorbers) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for pistons");
    w->absorbers->count = 0;
    for (int k = 0; k < w->sim.body_count; k++) TOBI_TRY(add(w, k, err));
    return TOBI_OK;
}

void tobi_absorb_free(tobi_world *w)
{
    if (w->absorbers) free(w->absorbers->at);
    free(w->absorbers);
    w->absorbers = NULL;
}

static void shift_body(tobi_body *b, const absorber *a, double way)
{
    for (int c = 0; c < 3; c++) b->shift[c] = way*a->direction[c];
}

/* The body must stay in the domain, whatever comes back. */
static double limit_way(const tobi_world *w, const absorber *a, double way)
{
    const tobi_body *b = &w->sim.bodies[a->body];
    const double own = tobi_waves_displacement(a->waves, w->sim.time + w->sim.dt) -
                       tobi_waves_displacement(a->waves, w->sim.time);
    const double back = find_end(b, a->direction, -1), front = find_end(b, a->direction, 1);
    const double least = a->lower - (back + own - a->state[0]), most = a->upper - (front + own - a->state[0]);
    return fmin(fmax(way, least), most);
}

void tobi_absorb_predict(tobi_world *w)
{
    const double dt = w->sim.dt;
    for (int k = 0; k < w->absorbers->count; k++) {
        absorber *a = &w->absorbers->at[k];
        const double keep = exp(-dt/a->how.lag);
        a->next[1] = keep*a->state[1] - (1 - keep)*a->how.gain*(a->state[2] - a->state[3]);
        a->next[0] = limit_way(w, a, exp(-dt/a->how.leak)*a->state[0] + dt*a->next[1]);
        shift_body(&w->sim.bodies[a->body], a, a->next[0]);
    }
}

void tobi_absorb_finish(tobi_world *w)
{
    for (int k = 0; k < w->absorbers->count; k++) {
        absorber *a = &w->absorbers->at[k];
        memcpy(a->state, a->next, sizeof a->next);
        const double level = measure_level(w, a) - tobi_waves_level(a->waves, w->sim.time, a->how.distance);
        if (w->sim.step == 1) a->state[4] = level;
        a->state[2] = level - a->state[4];
        a->state[3] += (1 - exp(-w->sim.dt/a->how.mean))*(a->state[2] - a->state[3]);
    }
}

double *tobi_absorb_state(const tobi_world *w, int body)
{
    for (int k = 0; k < w->absorbers->count; k++)
        if (w->absorbers->at[k].body == body) return w->absorbers->at[k].state;
    return NULL;
}

void tobi_absorb_restore(tobi_world *w)
{
    for (int k = 0; k < w->absorbers->count; k++) {
        const absorber *a = &w->absorbers->at[k];
        shift_body(&w->sim.bodies[a->body], a, a->state[0]);
    }
}
