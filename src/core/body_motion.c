/* What a motion answers, checked, and the frame that it carries along. Drawback: a motion that is wrong later
   only is told when it gets there. */
#include "core/body.h"
#include "geom/vec3.h"
#include <math.h>
#include <string.h>

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

/* --- the frame ---------------------------------------------------------------------------------- */

/* Three short axes through the motion, made orthonormal. Exact for a rigid motion. */
tobi_status tobi_body_find_frame(const tobi_body *b, double t, double centre[3], double frame[3][3],
                                 tobi_error *err)
{
    double arm = 0.01*cbrt(fabs(b->rest.volume)), rest[4][3], now[4][3];
    for (int k = 0; k < 4; k++)
        for (int a = 0; a < 3; a++) rest[k][a] = b->rest.centre[a] + (k == a + 1 ? arm : 0);
    TOBI_TRY(tobi_body_locate(b, t, 4, (const double (*)[3])rest, now, err));
    memcpy(centre, now[0], sizeof now[0]);
    for (int k = 0; k < 3; k++) {
        for (int a = 0; a < 3; a++) frame[k][a] = now[k + 1][a] - now[0][a];
        for (int j = 0; j < k; j++) {
            double dot = 0;
            for (int a = 0; a < 3; a++) dot += frame[k][a]*frame[j][a];
            for (int a = 0; a < 3; a++) frame[k][a] -= dot*frame[j][a];
        }
        double size = sqrt(frame[k][0]*frame[k][0] + frame[k][1]*frame[k][1] + frame[k][2]*frame[k][2]);
        for (int a = 0; a < 3; a++) frame[k][a] = size > 0 ? frame[k][a]/size : (a == k);
    }
    return TOBI_OK;
}

/* By S. W. Shepperd, J. Guidance and Control 1 (1978) 223. */
void tobi_frame_quaternion(const double f[3][3], double q[4])
{
    double m[3][3], trace = f[0][0] + f[1][1] + f[2][2];
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) m[r][c] = f[c][r];
    if (trace > 0) {
        double s = 2*sqrt(1 + trace);
        q[0] = 0.25*s;
        q[1] = (m[2][1] - m[1][2])/s; q[2] = (m[0][2] - m[2][0])/s; q[3] = (m[1][0] - m[0][1])/s;
        return;
    }
    int i = m[0][0] > m[1][1] ? (m[0][0] > m[2][2] ? 0 : 2) : (m[1][1] > m[2][2] ? 1 : 2),
        j = (i + 1) % 3, k = (i + 2) % 3;
    double s = 2*sqrt(fmax(1 + m[i][i] - m[j][j] - m[k][k], 1e-300));
    q[0] = (m[k][j] - m[j][k])/s;
    q[1 + i] = 0.25*s;
    q[1 + j] = (m[j][i] + m[i][j])/s;
    q[1 + k] = (m[k][i] + m[i][k])/s;
}

/* Half the sum of axis cross products. */
void tobi_frame_rate(const double from[3][3], const double to[3][3], double dt, double omega[3])
{
    memset(omega, 0, 3*sizeof *omega);
    for (int k = 0; k < 3; k++)
        for (int a = 0; a < 3; a++) {
            int b = (a + 1)%3, c = (a + 2)%3;
            omega[a] += 0.5*(from[k][b]*to[k][c] - from[k][c]*to[k][b])/dt;
        }
}
