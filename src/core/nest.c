/* Where the liquid of a nest is free. */
#include "core/nest.h"
#include <math.h>

double tobi_nest_outside(const tobi_nest *n, int dimension, const double x[3])
{
    double out = -INFINITY;
    for (int a = 0; a < dimension; a++) out = fmax(out, fmax(n->lower[a] - x[a], x[a] - n->upper[a]));
    return out;
}

int tobi_nest_covers(const tobi_nest *n, int dimension, const double x[3])
{
    return tobi_nest_outside(n, dimension, x) <= n->rim;
}
