/* Solids beside a liquid with periodic sides: the liquid goes through these, solids do not, so that a flap in
   a channel is possible and a leaf that drifts through is not (decision 79). Drawback: it is told when it
   happens, in the middle of a run. */
#include "world/beside.h"
#include "base/error.h"

tobi_status tobi_beside_check(const tobi_world *w, tobi_error *err)
{
    const tobi_system *liquid = &w->system[0], *s = w->sim.soft.solids;
    const double reach = liquid->smoothing.h;
    for (int a = 0; s && a < s->box.dimension; a++)
        for (int64_t i = 0; liquid->box.periodic[a] && i < s->particles.count; i++) {
            const double at = (&s->particles.position[i].x)[a], lower = s->box.lower[a];
            if (at >= reach && at <= s->box.size[a] - reach) continue;
            return tobi_fail(err, TOBI_UNSUPPORTED, "solid '%s' comes to %c = %.6g m; solids do not go "
                             "through periodic sides, and stay %.3g m away from them",
                             s->solids[s->particles.fluid[i]].name, "xyz"[a], at + lower, reach);
        }
    return TOBI_OK;
}
