/* Solids beside a liquid with periodic sides: the liquid goes through these, solids do not, so that a flap in
   a channel is possible and a leaf that drifts through is not (decision 79). Drawback: it is told when it
   happens, in the middle of a run. */
#include "world/beside.h"
#include "base/error.h"

typedef struct sides { const tobi_system *s; double reach; const int *periodic; } sides;

/* The axis along which a particle is too near to a periodic side; -1: none. */
static int near_side(const sides *v, int64_t i)
{
    for (int a = 0; a < v->s->box.dimension; a++) {
        const double at = (&v->s->particles.position[i].x)[a];
        if (v->periodic[a] && !(at >= v->reach && at <= v->s->box.size[a] - v->reach)) return a;
    }
    return -1;
}

static void count_near(const void *view, int64_t begin, int64_t end, double *totals)
{
    for (int64_t i = begin; i < end; i++) totals[0] += near_side(view, i) >= 0;
}

tobi_status tobi_beside_check(tobi_world *w, tobi_error *err)
{
    const tobi_system *liquid = &w->system[0], *s = w->sim.soft.solids;
    const int *periodic = liquid->box.periodic;
    const sides v = { s, liquid->smoothing.h, periodic };
    double t[TOBI_TOTALS] = { 0 };
    if (!s || !(periodic[0] || periodic[1] || periodic[2])) return TOBI_OK;
    tobi_launch(&w->sim.exec, TOBI_HOST(count_near, 1, 0), &v, 0, s->particles.count, t);
    for (int64_t i = 0; t[0] > 0 && i < s->particles.count; i++) {
        const int a = near_side(&v, i);
        if (a < 0) continue;
        return tobi_fail(err, TOBI_UNSUPPORTED, "solid '%s' comes to %c = %.6g m; solids do not go "
                         "through periodic sides, and stay %.3g m away from them",
                         s->solids[s->particles.fluid[i]].name, "xyz"[a],
                         (&s->particles.position[i].x)[a] + s->box.lower[a], v.reach);
    }
    return TOBI_OK;
}
