/* The world's damping zones. Drawback: their boxes lie along the axes. */
#include "base/error.h"
#include "base/param.h"
#include "world/world.h"
#include <math.h>

/* From where along the direction, and over how much, the box reaches. */
static void measure(tobi_damping *z, const double direction[3], double size, int dimension)
{
    for (int a = 0; a < dimension; a++) {
        z->direction[a] = direction[a]/size;
        z->begin += fmin(z->direction[a]*z->lower[a], z->direction[a]*z->upper[a]);
        z->length += fabs(z->direction[a])*(z->upper[a] - z->lower[a]);
    }
}

tobi_status tobi_world_add_damping(tobi_world *w, const tobi_damping_def *def, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    TOBI_NEED(def, "the definition");
    const tobi_box *box = &w->system[0].box;
    tobi_damping zone = { .rate = def->rate };
    double size = 0;
    if (w->started) return tobi_fail(err, TOBI_INVALID, "a started world takes no more damping zones");
    TOBI_TRY(tobi_param_check(&tobi_damping_table, def, err));
    if (w->system[0].method->solids)
        return tobi_fail(err, TOBI_UNSUPPORTED, "%s knows no damping zones; its solids have a damping of "
                         "their own", w->system[0].method->name);
    if (w->sim.damping_count == TOBI_DAMPING_LIMIT)
        return tobi_fail(err, TOBI_UNSUPPORTED, "more than %d damping zones", TOBI_DAMPING_LIMIT);
    for (int a = 0; a < box->dimension; a++) {
        size = hypot(size, def->direction[a]);
        zone.lower[a] = def->box_min[a] - box->lower[a];
        zone.upper[a] = def->box_max[a] - box->lower[a];
        if (!(zone.upper[a] > zone.lower[a]))
            return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "the box of a damping zone reaches from %g "
                                              "to %g m in %c: allowed are upper corners above the lower ones",
                                              def->box_min[a], def->box_max[a], "xyz"[a]), "box.max");
    }
    for (int a = 0; a < box->dimension; a++)
        if (!(zone.lower[a] < box->size[a] && zone.upper[a] > 0))
            return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "a damping zone lies from %g to %g m in %c, "
                                              "outside of the domain", def->box_min[a], def->box_max[a],
                                              "xyz"[a]), "box");
    if (!(size > 0))
        return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "the direction of a damping zone has no length"),
                           "direction");
    measure(&zone, def->direction, size, box->dimension);
    if (def->length > 0) zone.length = def->length;
    w->sim.damping[w->sim.damping_count++] = zone;
    return TOBI_OK;
}
