/* Solids that a rigid body holds (decision 83): which body, and whether it can. Drawback: scenes say the same
   with line and column before the world is made. */
#include "base/error.h"
#include "mpm/clamp.h"
#include "world/world.h"

/* Why a body cannot hold a solid, NULL if it can. */
static const char *find_reason(const tobi_body *b)
{
    if (b->blade) return "is a blade, which cuts solids";
    if (b->swimmer || b->deforms) return "changes its shape";
    if (b->absent[0] > 0) return "is absent for a time";
    return NULL;
}

static tobi_status find_clamp(tobi_world *w, tobi_solid *solid, tobi_error *err)
{
    if (!solid->def.clamped_to) return TOBI_OK;
    solid->clamp = tobi_world_find_body(w, solid->clamped_to);
    if (solid->clamp < 0)
        return tobi_fail(err, TOBI_NOT_FOUND, "solid '%s' is clamped to '%s', which is no body",
                         solid->name, solid->clamped_to);
    if (!tobi_solid_uses(solid->def.model, "clamped_to"))
        return tobi_fail(err, TOBI_INVALID, "solid '%s' is clamped to '%s', but a solid of its model can not "
                         "be held; all others than liquid and stationary can", solid->name,
                         solid->clamped_to);
    const char *reason = find_reason(&w->sim.bodies[solid->clamp]);
    if (!reason) return TOBI_OK;
    return tobi_fail(err, TOBI_UNSUPPORTED, "solid '%s' is clamped to '%s', which %s; a rigid body holds a "
                     "solid", solid->name, solid->clamped_to, reason);
}

tobi_status tobi_world_find_clamps(tobi_world *w, tobi_error *err)
{
    tobi_system *s = tobi_world_solids(w);
    for (int k = 0; s && k < s->solid_count; k++) {
        const tobi_status status = find_clamp(w, &s->solids[k], err);
        TOBI_TRY(tobi_at_key(err, status, "solids[%d].clamped_to", k));
    }
    return TOBI_OK;
}

tobi_status tobi_world_check_clamps(const tobi_world *w, tobi_error *err)
{
    const tobi_system *s = tobi_world_solids(w);
    for (int k = 0; s && k < s->solid_count; k++) {
        int64_t held = 0;
        if (s->solids[k].clamp < 0) continue;
        for (int64_t i = 0; i < s->particles.count; i++)
            held += s->particles.fluid[i] == k && mpm_clamp_body(s, i) >= 0;
        if (held > 0) continue;
        const tobi_status status =
            tobi_fail(err, TOBI_INVALID, "solid '%s' is clamped to '%s', but none of its particles starts in "
                      "that body or nearer than a spacing, %.3g m, to it", s->solids[k].name,
                      s->solids[k].clamped_to, s->smoothing.spacing);
        return tobi_at_key(err, status, "solids[%d].clamped_to", k);
    }
    return TOBI_OK;
}
