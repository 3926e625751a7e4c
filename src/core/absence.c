/* Bodies that are not there for a while: a gate that is taken away at once. Nothing that looks for bodies has
   to know: the vertices of an absent body lie so far away that nothing sees them, and move there as they
   would here. Drawback: a body goes and comes at the beginning of a step, up to a step late. */
#include "core/body.h"
#include <math.h>

/* How far nothing sees a body: sides of periodic axes would bring it near again. */
static const double AWAY = 1000;

tobi_status tobi_body_plan_absence(tobi_body *b, const tobi_body_def *def, const tobi_box *box,
                                   tobi_error *err)
{
    int axis = 0;
    if (!(def->absent_from > 0) && def->absent_until > 0)
        return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "body '%s' is absent until %g s, and "
                                          "absent.from does not say from when; it is there at the start",
                                          b->name, def->absent_until), "absent.until");
    if (!(def->absent_from > 0)) return TOBI_OK;
    if (def->dynamics != TOBI_PRESCRIBED)
        return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "body '%s': only a prescribed body can be "
                                          "absent", b->name), "absent");
    if (def->absent_until > 0 && !(def->absent_until > def->absent_from))
        return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "body '%s' is absent from %g s until %g s; the "
                                          "second must be later", b->name, def->absent_from,
                                          def->absent_until), "absent.until");
    while (axis < box->dimension && box->periodic[axis]) axis++;
    if (axis == box->dimension)
        return tobi_fail(err, TOBI_UNSUPPORTED, "body '%s': no body can be absent in a domain that is "
                         "periodic along all axes", b->name);
    for (int a = 0; a < 3; a++) b->away[axis] = fmin(b->away[axis], -AWAY*box->size[a]);
    b->absent[0] = def->absent_from;
    b->absent[1] = def->absent_until;
    return TOBI_OK;
}

void tobi_body_follow_absence(tobi_body *b, double t)
{
    const double *when = b->absent;
    const int absent = when[0] > 0 && t >= when[0] && !(when[1] > 0 && t >= when[1]);
    if (absent == b->is_absent) return;
    b->is_absent = absent;
    if (!absent && !b->motion) {     /* to the last bit where a load puts it; it cannot fail */
        tobi_body_place(b, t, NULL);
        return;
    }
    for (int64_t i = 0; i < b->mesh.vertex_count; i++)
        for (int a = 0; a < 3; a++) b->vertex[i][a] += absent ? b->away[a] : -b->away[a];
    tobi_body_update_surface(b);
}

void tobi_body_find_absence(tobi_body *b)
{
    b->is_absent = 0;
    for (int a = 0; a < 3; a++) b->is_absent |= b->away[a] < 0 && b->vertex[0][a] < 0.5*b->away[a];
}
