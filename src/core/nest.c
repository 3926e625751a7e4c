/* Where the liquid of a nest is free. */
#include "core/nest.h"
#include "tobiuo/tobiuo.h"
#include <math.h>

double tobi_nest_outside(const tobi_nest *n, int dimension, const double x[3])
{
    double out = -INFINITY;
    for (int a = 0; a < dimension; a++) out = fmax(out, fmax(n->lower[a] - x[a], x[a] - n->upper[a]));
    return out;
}

void tobi_nest_open_sides(double box[2][3], const double domain[2][3], double rim, int dimension)
{
    for (int a = 0; a < 3; a++) {
        if (a >= dimension || box[0][a] < domain[0][a] + rim) box[0][a] = -INFINITY;
        if (a >= dimension || box[1][a] > domain[1][a] - rim) box[1][a] = INFINITY;
    }
}

int tobi_nest_covers(const tobi_nest *n, int dimension, const double x[3])
{
    return tobi_nest_outside(n, dimension, x) <= n->rim;
}
