/* What a motion answers, checked. Drawback: a motion that is wrong later only is told when it gets there. */
#include "core/body.h"
#include "geom/vec3.h"
#include <math.h>

/* Spacings that rounding may move a point across the plane of a 2-D world. */
static const double ACROSS = 1e-6;

tobi_status tobi_body_ask_motion(const tobi_body *b, double t, int64_t n, const double (*rest)[3],
                                 double (*out)[3], tobi_error *err)
{
    const int flat = b->surface.dimension == 2;
    TOBI_TRY(b->motion(b->motion_user, t, n, rest, out, err));
    if (vec3_dot(b->shift, b->shift) > 0)
        for (int64_t i = 0; i < n; i++) vec3_add_scaled(out[i], out[i], 1, b->shift);
    for (int64_t i = 0; i < n; i++) {
        if (!isfinite(out[i][0] + out[i][1] + out[i][2]))
            return tobi_fail(err, TOBI_INVALID, "body '%s': its motion puts a point at (%g, %g, %g) m at "
                             "t = %.9g s; allowed are finite numbers", b->name, out[i][0], out[i][1],
                             out[i][2], t);
        if (flat && fabs(out[i][2] - rest[i][2]) > ACROSS*b->spacing)
            return tobi_fail(err, TOBI_INVALID, "body '%s': its motion shifts a point by %.3g m along z at "
                             "t = %.9g s; in 2-D bodies are shifted along x and y and turned about z",
                             b->name, out[i][2] - rest[i][2], t);
    }
    return TOBI_OK;
}
