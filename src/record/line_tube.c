/* Rings around points of the line, each across it. Drawback: the ends are open. */
#include "record/line_tube.h"
#include "geom/vec3.h"
#include <math.h>

/* Around p, across the way from a to b. */
static void make_ring(const double a[3], const double b[3], const double p[3], double radius,
                      double (*ring)[3])
{
    double along[3], across[3], third[3];
    vec3_sub(along, b, a);
    vec3_normalize(along);
    const double e[3] = { fabs(along[0]) < 0.6, fabs(along[0]) >= 0.6, 0 };
    vec3_cross(across, along, e);
    vec3_normalize(across);
    vec3_cross(third, along, across);
    for (int s = 0; s < TOBI_TUBE_SIDES; s++) {
        const double angle = 2*acos(-1)*s/TOBI_TUBE_SIDES;
        for (int k = 0; k < 3; k++)
            ring[s][k] = p[k] + radius*(cos(angle)*across[k] + sin(angle)*third[k]);
    }
}

void tobi_line_draw(const tobi_line *line, double radius, tobi_line_tube *tube)
{
    enum { N = TOBI_TUBE_POINTS, SIDES = TOBI_TUBE_SIDES };
    double p[N][3];
    int count = 0;
    tobi_line_shape(line, N, p);
    for (int k = 0; k < N; k++)
        make_ring(p[k > 0 ? k - 1 : 0], p[k < N - 1 ? k + 1 : k], p[k], radius, &tube->vertex[k*SIDES]);
    for (int k = 0; k < N - 1; k++)
        for (int s = 0; s < SIDES; s++) {
            const int32_t a = k*SIDES + s, b = k*SIDES + (s + 1)%SIDES;
            const int32_t corner[2][3] = { { a, b, a + SIDES }, { b, b + SIDES, a + SIDES } };
            for (int t = 0; t < 2; t++, count++)
                for (int c = 0; c < 3; c++) tube->triangle[count][c] = corner[t][c];
        }
}
