/* Solids that rigid bodies hold (decisions 83, 97): which bodies, and whether they can. Drawback: scenes say
   the same with line and column before the world is made. */
#include "base/error.h"
#include "mpm/contact/clamp.h"
#include "world/world.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Why a body cannot hold a solid, NULL if it can. */
static const char *find_reason(const tobi_body *b)
{
    if (b->blade) return tr("is a blade, which cuts solids");
    if (b->absent[0] > 0) return tr("is absent for a time");
    return NULL;
}

static tobi_status find_clamp(const tobi_world *w, tobi_solid *solid, const char *name, tobi_error *err)
{
    const int body = tobi_world_find_body(w, name);
    if (body < 0)
        return tobi_fail(err, TOBI_NOT_FOUND, "solid '%s' is clamped to '%s', which is no body", solid->name,
                         name);
    if (!tobi_solid_uses(solid->def.model, "clamped_to"))
        return tobi_fail(err, TOBI_INVALID, "solid '%s' is clamped to '%s', but a solid of its model can not "
                         "be held; all others than liquid and stationary can", solid->name, name);
    if (tobi_solid_is_clamped(solid, body))
        return tobi_fail(err, TOBI_INVALID, "solid '%s' is clamped to '%s' twice", solid->name, name);
    const char *reason = find_reason(&w->sim.bodies[body]);
    if (reason)
        return tobi_fail(err, TOBI_UNSUPPORTED, "solid '%s' is clamped to '%s', which %s; such a body holds "
                         "no solid", solid->name, name, reason);
    solid->clamp[solid->clamp_count++] = body;
    return TOBI_OK;
}

/* Where the solid names its body number n. */
static tobi_status at_name(const tobi_solid *solid, int number, int n, tobi_status status, tobi_error *err)
{
    if (!strchr(solid->clamped_to, ',')) return tobi_at_key(err, status, "solids[%d].clamped_to", number);
    return tobi_at_key(err, status, "solids[%d].clamped_to[%d]", number, n);
}

static tobi_status find_clamps(const tobi_world *w, tobi_solid *solid, int number, tobi_error *err)
{
    char name[128];
    size_t length, most = 1;
    free(solid->clamp);
    solid->clamp = NULL;
    solid->clamp_count = 0;
    if (!solid->clamped_to) return TOBI_OK;
    for (const char *c = solid->clamped_to; *c; c++) most += *c == ',';
    solid->clamp = malloc(most*sizeof *solid->clamp);
    if (!solid->clamp) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %zu clamps", most);
    for (const char *at = solid->clamped_to;; at += length + 1) {
        length = strcspn(at, ",");
        snprintf(name, sizeof name, "%.*s", (int)length, at);
        TOBI_TRY(at_name(solid, number, solid->clamp_count, find_clamp(w, solid, name, err), err));
        if (!at[length]) return TOBI_OK;
    }
}

tobi_status tobi_world_find_clamps(tobi_world *w, tobi_error *err)
{
    tobi_system *s = tobi_world_solids(w);
    for (int k = 0; s && k < s->solid_count; k++) TOBI_TRY(find_clamps(w, &s->solids[k], k, err));
    return TOBI_OK;
}

/* Of a spacing: farther from where the motion has it at the start no particle is. */
static const double STRAY = 0.01;

static tobi_status find_rest(const tobi_world *w, const tobi_solid *d, int64_t i, tobi_error *err)
{
    const tobi_system *s = tobi_world_solids(w);
    const tobi_double3 x = s->particles.position[i];
    double stray;
    TOBI_TRY(mpm_clamp_find_rest(s, i, &stray, err));
    if (stray <= STRAY*s->smoothing.spacing) return TOBI_OK;
    return tobi_fail(err, TOBI_INVALID, "solid '%s': the motion of body '%s' takes no place to (%g, %g, %g) "
                     "m, where a particle that it holds starts", d->name,
                     w->sim.bodies[mpm_clamp_body(s, i)].name, x.x + s->box.lower[0], x.y + s->box.lower[1],
                     x.z + s->box.lower[2]);
}

/* Completes the clamps of a body, number n of those that the solid names; refuses one that holds none of its
   particles. */
static tobi_status start_clamp(const tobi_world *w, int solid, int n, tobi_error *err)
{
    const tobi_system *s = tobi_world_solids(w);
    const tobi_solid *d = &s->solids[solid];
    int64_t held = 0;
    for (int64_t i = 0; i < s->particles.count; i++) {
        if (s->particles.fluid[i] != solid || mpm_clamp_body(s, i) != d->clamp[n]) continue;
        TOBI_TRY(at_name(d, solid, n, find_rest(w, d, i, err), err));
        held++;
    }
    if (held > 0) return TOBI_OK;
    const tobi_status status =
        tobi_fail(err, TOBI_INVALID, "solid '%s' is clamped to '%s', but none of its particles starts in "
                  "that body or nearer than a spacing, %.3g m, to it%s", d->name,
                  w->sim.bodies[d->clamp[n]].name, s->smoothing.spacing,
                  n > 0 ? tr(", and belongs to no body named before") : "");
    return at_name(d, solid, n, status, err);
}

/* Pressure on the section between a body and a solid does not cancel to rounding: one that nothing else holds
   sets off in water at rest. */
static tobi_status note_push(tobi_world *w, const tobi_solid *d, const tobi_body *b, tobi_error *err)
{
    const tobi_method *m = w->system[0].method;
    char text[TOBI_NOTE];
    if (!m->rough_forces || b->rigid.kind == TOBI_PRESCRIBED) return TOBI_OK;
    snprintf(text, sizeof text, tr("by %s the pressure on the section between it and body '%s' does not "
             "cancel: under water both are pushed while all is at rest; dfsph does not do that\n"), m->name,
             b->name);
    return tobi_world_add_notes(w, "solid", d->name, text, err);
}

tobi_status tobi_world_start_clamps(tobi_world *w, tobi_error *err)
{
    const tobi_system *s = tobi_world_solids(w);
    for (int k = 0; s && k < s->solid_count; k++)
        for (int n = 0; n < s->solids[k].clamp_count; n++) {
            const tobi_solid *d = &s->solids[k];
            TOBI_TRY(start_clamp(w, k, n, err));
            TOBI_TRY(note_push(w, d, &w->sim.bodies[d->clamp[n]], err));
        }
    return TOBI_OK;
}
