/* Limits that need more than one number. The parameter tables hold the range of each number alone.
   Drawback: the limits are wide, so that they stop slips of the pen and no run that is merely unwise. */
#include "world/limits.h"
#include <math.h>

/* Spacings along an axis: fixed-point positions of SPH then still resolve 1/5000 of a spacing. */
static const double SPACINGS = 2e5;
/* Spacings from the origin: doubles then still resolve 1/1000 of a spacing. */
static const double DISTANCE = 1e12;
/* A machine makes some thousand steps a second: more would take weeks. */
static const double STEPS = 1e9;
/* s: the squares of shorter ones are lost in single precision. */
static const double LEAST_TIME = 1e-12;

enum { PATIENCE = 100 };                  /* steps: a short one now and then is none of our business */

static tobi_status check_box(const tobi_world_def *d, int sph, tobi_error *err)
{
    for (int a = 0; a < d->dimension; a++) {
        const double across = (d->domain_max[a] - d->domain_min[a])/d->spacing;
        const double far = fmax(fabs(d->domain_min[a]), fabs(d->domain_max[a]))/d->spacing;
        if (sph && across > SPACINGS)
            return tobi_fail(err, TOBI_INVALID, "is %g m and goes %.4g times into the domain along %c; %s "
                             "allows up to %g times", d->spacing, across, "xyz"[a], d->method, SPACINGS);
        if (far > DISTANCE)
            return tobi_fail(err, TOBI_INVALID, "is %g m, and the domain lies up to %.4g times that from the "
                             "origin along %c; allowed are up to %g times", d->spacing, far, "xyz"[a],
                             DISTANCE);
    }
    return TOBI_OK;
}

static tobi_status check_end(const tobi_world_def *d, tobi_error *err)
{
    if (d->end_time == 0 || d->end_time >= LEAST_TIME) return TOBI_OK;
    return tobi_fail(err, TOBI_INVALID, "is %g s; allowed are 0, the start alone, and %g s and more",
                     d->end_time, LEAST_TIME);
}

static tobi_status check_steps(const tobi_world_def *d, double step, tobi_error *err)
{
    if (!(step > 0) || d->end_time/step <= STEPS) return TOBI_OK;
    return tobi_fail(err, TOBI_INVALID, "is %g s and makes %.3g steps until end_time, %g s; allowed are up "
                     "to %g steps", step, d->end_time/step, d->end_time, STEPS);
}

tobi_status tobi_limits_gravity(const tobi_world_def *d, tobi_error *err)
{
    double work = 0;
    for (int a = 0; a < d->dimension; a++)
        work += fabs(d->gravity[a])*(d->domain_max[a] - d->domain_min[a]);
    if (!(sqrt(2*work) > TOBI_SPEED_LIMIT)) return TOBI_OK;
    return tobi_fail(err, TOBI_INVALID, "makes what falls through the domain %.3g m/s fast; allowed are up "
                     "to %g m/s", sqrt(2*work), TOBI_SPEED_LIMIT);
}

tobi_status tobi_limits_check(const tobi_world_def *d, int sph, const char **key, tobi_error *err)
{
    *key = "spacing";
    TOBI_TRY(check_box(d, sph, err));
    *key = "end_time";
    TOBI_TRY(check_end(d, err));
    *key = "time_step";
    TOBI_TRY(check_steps(d, d->time_step, err));
    *key = "time_step_max";
    TOBI_TRY(check_steps(d, d->time_step_max, err));
    *key = "gravity";
    return tobi_limits_gravity(d, err);
}

tobi_status tobi_limits_progress(const tobi_simulation *s, double before, double max_dt, double left,
                                 int *steps, tobi_error *err)
{
    if (!(s->time > before))
        return tobi_fail(err, TOBI_STALLED, "the simulation stands still at t = %.9g s, step %lld: its time "
                         "step is %g s, too short to change the time", s->time, (long long)s->step, s->dt);
    const int cut = max_dt > 0 && s->dt >= max_dt;        /* to end where the caller wants */
    if (cut || left <= STEPS*s->dt) {
        *steps = 0;
        return TOBI_OK;
    }
    if (++*steps < PATIENCE) return TOBI_OK;
    *steps = 0;
    return tobi_fail(err, TOBI_STALLED, "the simulation gets nowhere: at t = %.9g s, step %lld, its time "
                     "step is %.3g s, and the end lies %.3g steps away; fast particles and stiff or viscous "
                     "matter make steps short", s->time, (long long)s->step, s->dt, left/s->dt);
}
