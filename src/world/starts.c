/* Notes on the start of a liquid: bodies that set off at full speed, liquid that begins beside a wall instead
   of at it. The scene says so, but its author seldom means it. Drawback: motions that jump later are not
   found. */
#include "base/error.h"
#include "world/world.h"
#include <math.h>
#include <stdio.h>

/* Of the speed of a fall from the liquid's height; slower starts press less than the liquid at rest. */
static const double JERK = 0.05;
/* s, over which a motion is looked at. */
static const double SOON = 1e-4;
/* Spacings between liquid and wall that count as a gap, not as a place of its own. */
static const double GAP_LEAST = 0.6, GAP_MOST = 4;

static tobi_status note_jerk(tobi_world *w, tobi_body *b, tobi_error *err)
{
    double after = 0, twice = 0;
    char text[240];
    TOBI_TRY(tobi_body_predict(b, 0, 2*SOON, &twice, err));
    TOBI_TRY(tobi_body_predict(b, 0, SOON, &after, err));
    const double speed = 2*after - twice;            /* at once: an acceleration adds to the means */
    if (b->rigid.kind != TOBI_PRESCRIBED || w->system[0].start_speed > 0) return TOBI_OK;
    if (!(speed > fmax(JERK*sqrt(2*w->system[0].start_head), JERK*after))) return TOBI_OK;
    snprintf(text, sizeof text, "sets off at %.3g m/s: the force of the first step is an impulse over "
             "the time step; let the motion begin at rest\n", speed);
    return tobi_world_add_notes(w, "body", b->name, text, err);
}

static tobi_status note_gap(tobi_world *w, const tobi_region *r, tobi_error *err)
{
    const tobi_box *box = &w->system[0].box;
    const double d = w->system[0].smoothing.spacing;
    if (r->system != 0) return TOBI_OK;                /* a solid's                                */
    if (r->in_vessel) return TOBI_OK;                  /* its walls are no sides of the domain     */
    for (int side = 0; side < 2*box->dimension; side++) {
        const int a = side/2, upper = side%2;
        const double gap = upper ? box->lower[a] + box->size[a] - r->upper[a] : r->lower[a] - box->lower[a];
        char text[240];
        if (box->periodic[a] || !(gap > GAP_LEAST*d && gap < GAP_MOST*d)) continue;
        if (w->sim.def.gravity[a]*(upper ? -1 : 1) > 0) continue;    /* the free surface, or a ceiling */
        snprintf(text, sizeof text, "fill[%d] begins %.3g m from the side at the %s %c: it falls there, "
                 "traps voids and stays too high; let it begin at the side\n",
                 r->number, gap, upper ? "upper" : "lower", "xyz"[a]);
        return tobi_world_add_notes(w, "fluid", w->system[0].fluid[r->owner].name, text, err);
    }
    return TOBI_OK;
}

tobi_status tobi_world_note_starts(tobi_world *w, tobi_error *err)
{
    if (w->system[0].fluid_count == 0) return TOBI_OK;
    for (int k = 0; k < w->sim.body_count; k++) TOBI_TRY(note_jerk(w, &w->sim.bodies[k], err));
    for (int k = 0; k < w->region_count; k++) TOBI_TRY(note_gap(w, &w->regions[k], err));
    return TOBI_OK;
}
