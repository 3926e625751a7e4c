/* What stands for the missing neighbours of a particle at a free surface, scaled so that a flat surface of
   the lattice, a given height above its top row, carries hydrostatic pressure exactly: in the row of the
   pressure equation and in the force. Drawback: second rows, where the gate is nearly shut, keep an error of
   some hundredths of a spacing. */
#include "sph/isph/isph.k.h"
#include "sph/isph/surface.h"
#include "sph/stages.h"
#include <math.h>

enum { REACH = 5 };      /* spacings, more than the widest support */

/* V F of a lattice pair, 0 beyond the support. */
static double fall_off(const tobi_smoothing_constants *c, const int at[3])
{
    const double d = c->spacing, r = d*sqrt(at[0]*at[0] + at[1]*at[1] + at[2]*at[2]);
    if (!(r > 0 && r < c->h)) return 0;
    return c->volume*c->slope_correction*tobi_smoothing_f(c->shape, c->dimension, c->h, r);
}

/* V W, the same. */
static double weight(const tobi_smoothing_constants *c, const int at[3])
{
    const double r = c->spacing*sqrt(at[0]*at[0] + at[1]*at[1] + at[2]*at[2]);
    return r < c->h ? c->volume*c->weight_correction*tobi_smoothing_w(c->shape, c->dimension, c->h, r) : 0;
}

typedef struct row_sums {
    double trace, count, weight, difference, gradient, concentration, concentration_gradient;
} row_sums;

/* Over the neighbours of a particle in layer `layer` below a flat surface; scale: kappa by layer, or NULL. */
static row_sums sum_row(const tobi_smoothing_constants *c, int layer, const double *scale)
{
    const int wide = c->dimension == 3 ? REACH : 0;
    row_sums s = { 0 };
    for (int down = -layer; down <= REACH; down++)
        for (int y = -wide; y <= wide; y++)
            for (int x = -REACH; x <= REACH; x++) {
                const double f = fall_off(c, (int[3]){ x, y, down });
                const double a = scale ? f*(scale[layer] + scale[layer + down]) : 0;
                s.count += f > 0;
                s.concentration += weight(c, (int[3]){ x, y, down });
                s.trace += f*c->spacing*c->spacing*(x*x + y*y + down*down);
                s.weight += a;
                s.difference += a*down;
                s.gradient += f*down*down;
                s.concentration_gradient += f*down;
            }
    return s;
}

/* Times as stiff are the rows of particles without pressure. */
static const double AT_ROW = 1e3;

void isph_surface_measure(isph_view *v, const tobi_smoothing_constants *c, double height)
{
    double scale[2*REACH + 1];
    const double d = c->spacing;
    for (int k = 0; k <= 2*REACH; k++)
        scale[k] = v->uniform_scale ? 1
                 : isph_scale(c->dimension, sum_row(c, v->own_scale ? 0 : k, NULL).trace);
    const row_sums top = sum_row(c, 0, scale), second = sum_row(c, 1, scale);
    v->surface_loss = 1 - top.trace/c->dimension;
    const double slope = d*d*fabs(second.concentration_gradient);
    v->surface_lack = slope > 1e-6 ? (1 - second.concentration)/slope : 0;
    v->lattice_count = sum_row(c, REACH, NULL).count;
    /* p = rho g d (height + layer): sum a (p_i - p_j) + e p_i = 0, and dp/dz = -rho g. The gate is open. */
    v->surface_row = 1;
    v->surface_row = top.difference/(height*isph_excess(v, v->surface_loss, top.weight, 1));
    v->surface_force = (1/(d*d) - top.gradient)/(2*height*top.concentration_gradient);
    if (height >= SPH_LEAST_HEIGHT) return;
    v->surface_row = AT_ROW;
    v->surface_force = 1;
}
