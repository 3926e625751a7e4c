/* The world's fixed planes. */
#include "base/error.h"
#include "base/param.h"
#include "world/world.h"
#include <math.h>

static tobi_status check_place(const tobi_box *box, const tobi_plane_def *def, tobi_error *err)
{
    for (int a = 0; a < box->dimension; a++)
        if (!(def->point[a] >= box->lower[a] && def->point[a] <= box->lower[a] + box->size[a]))
            return tobi_fail(err, TOBI_INVALID,
                             "the point of a plane lies outside the domain: %c = %g m, allowed is %g to %g m",
                             "xyz"[a], def->point[a], box->lower[a], box->lower[a] + box->size[a]);
    return TOBI_OK;
}

tobi_status tobi_world_add_plane(tobi_world *w, const tobi_plane_def *def, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    TOBI_NEED(def, "the definition");
    tobi_system *s = &w->system[0];
    double size = 0;
    if (w->started) return tobi_fail(err, TOBI_INVALID, "a started world takes no more planes");
    TOBI_TRY(tobi_param_check(&tobi_plane_table, def, err));
    if (!w->system[0].method->planes)
        return tobi_fail(err, TOBI_UNSUPPORTED,
                         "%s knows no planes; allowed are sides of the domain and bodies",
                         w->system[0].method->name);
    TOBI_TRY(tobi_at_key(err, check_place(&s->box, def, err), "point"));
    for (int a = 0; a < s->box.dimension; a++) size = hypot(size, def->normal[a]);
    if (s->box.dimension == 2 && def->normal[2] != 0)
        return tobi_fail(err, TOBI_INVALID, "the normal of a plane has %g in z, must be 0 in 2-D",
                         def->normal[2]);
    if (!(size > 0 && isfinite(size)))
        return tobi_fail(err, TOBI_INVALID, "the normal of a plane (%g, %g, %g) has no direction",
                         def->normal[0], def->normal[1], def->normal[2]);
    if (s->sim->plane_count == TOBI_PLANE_LIMIT)
        return tobi_fail(err, TOBI_UNSUPPORTED, "more than %d planes", TOBI_PLANE_LIMIT);
    tobi_fixed_plane *p = &s->sim->plane[s->sim->plane_count++];
    *p = (tobi_fixed_plane){ .kind = def->kind, .friction = def->friction };
    for (int a = 0; a < s->box.dimension; a++) {
        p->normal[a] = def->normal[a]/size;
        p->offset += p->normal[a]*(def->point[a] - s->box.lower[a]);
    }
    return TOBI_OK;
}
