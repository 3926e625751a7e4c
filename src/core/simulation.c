/* The clock of the world: the length of steps, the caller who stops them, the timers of their stages. */
#include "core/simulation.h"
#include "base/error.h"
#include <math.h>
#include <string.h>

void tobi_stage_end(tobi_stages *st, const char *name, double *since)
{
    double now = tobi_clock();
    int k = 0;
    while (k < st->count && strcmp(st->name[k], name) != 0) k++;
    if (k == st->count) {
        if (k == TOBI_STAGE_LIMIT) return;
        st->name[k] = name;
        st->seconds[k] = 0;
        st->count++;
    }
    st->seconds[k] += now - *since;
    *since = now;
}

double tobi_simulation_pull(const tobi_simulation *s, int axis)
{
    return fmax(fabs(s->def.gravity[axis]), s->acceleration_most[axis]);
}

double tobi_simulation_pull_size(const tobi_simulation *s)
{
    double sum = 0;
    for (int a = 0; a < s->def.dimension; a++) sum += tobi_simulation_pull(s, a)*tobi_simulation_pull(s, a);
    return sqrt(sum);
}

int tobi_simulation_stops(tobi_simulation *s)
{
    if (!s->stopped && s->stop) s->stopped = s->stop(s->stop_user) != 0;
    return s->stopped;
}

tobi_status tobi_simulation_check_stop(tobi_simulation *s, tobi_error *err)
{
    if (!tobi_simulation_stops(s)) return TOBI_OK;
    return tobi_fail(err, TOBI_STOPPED, "stopped on request at t = %.9g s, after step %lld", s->time,
                     (long long)s->step);
}

/* So many steps to a time, or fewer, are equal. */
static const double EQUAL_STEPS = 8;

double tobi_simulation_fit_dt(double dt, double max_dt)
{
    const double steps = fmax(ceil(max_dt/dt*(1 - 1e-9)), 1);       /* a fixed step fits but for rounding */
    return max_dt > 0 && steps <= EQUAL_STEPS ? max_dt/steps : dt;
}
