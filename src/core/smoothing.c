/* Lattice normalisation. A kernel that integrates to one does not sum to one on a lattice (Wendland
   at 2 d sums to 1.034). Instead of changing the particle mass, which is exactly rho0 d^3, the kernel
   is normalised on the lattice: the sum of V W is 1 and a linear field has its exact gradient. */
#include "core/smoothing.h"
#define TOBI_SCALAR_LANES
#include "core/smoothing.k.h"
#include <math.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

/* Of a shape in 2-D and 3-D: W = a/(b pi h^dimension) shape; -dW/dr / r = W/shape steepness/h^powers
   falloff. wide: support over that of wendland-c2 at the same second moment in 3-D (Dehnen & Aly 2012). */
static const struct { double a[2], b[2], steepness; int powers; double wide; } table[TOBI_SHAPES] = {
    [TOBI_SHAPE_WENDLAND] = { { 7, 21 }, { 1, 2 }, 20, 2, 1 },
    [TOBI_SHAPE_CUBIC] = { { 40, 8 }, { 7, 1 }, 6, 1, 1 },
    [TOBI_SHAPE_QUARTIC] = { { 8625, 2875 }, { 1199, 256 }, 250/23.0, 1, 1.05 },
    [TOBI_SHAPE_QUINTIC] = { { 2079, 297 }, { 239, 20 }, 405/22.0, 1, 1.15 },
    [TOBI_SHAPE_WENDLAND_C4] = { { 9, 495 }, { 1, 32 }, 56/3.0, 2, 1.15 },
    [TOBI_SHAPE_WENDLAND_C6] = { { 78, 1365 }, { 7, 64 }, 22, 2, 1.25 },
};

/* Integral normalisation of the shape, 1/m^dim. */
static double norm(int shape, int dimension, double h)
{
    const double a = table[shape].a[dimension - 2], b = table[shape].b[dimension - 2];
    return dimension == 3 ? a/(b*PI*h*h*h) : a/(b*PI*h*h);
}

static double steepness(int shape, double h)
{
    return table[shape].steepness/(table[shape].powers == 2 ? h*h : h);
}

double tobi_smoothing_support(int shape, double support) { return table[shape].wide*support; }

static double positive(double x) { return x > 0 ? x : 0; }

/* W at q = r/h, by the norm n. */
static inline double value(int shape, double n, double q)
{
    const double t = 1 - q, u = positive(0.5 - q);
    if (q >= 1) return 0;
    switch (shape) {
    case TOBI_SHAPE_WENDLAND: return n*t*t*t*t*(1 + 4*q);
    case TOBI_SHAPE_CUBIC: return n*(2*t*t*t - 8*u*u*u);
    case TOBI_SHAPE_QUARTIC:
        return n*125/46*(pow(t, 4) - 5*pow(positive(0.6 - q), 4) + 10*pow(positive(0.2 - q), 4));
    case TOBI_SHAPE_QUINTIC:
        return n*81/22*(pow(t, 5) - 6*pow(positive(2/3.0 - q), 5) + 15*pow(positive(1/3.0 - q), 5));
    case TOBI_SHAPE_WENDLAND_C4: return n*pow(t, 6)*(1 + 6*q + 35/3.0*q*q);
    default: return n*pow(t, 8)*(1 + 8*q + 25*q*q + 32*q*q*q);
    }
}

double tobi_smoothing_w(int shape, int dimension, double h, double r)
{
    return value(shape, norm(shape, dimension, h), r/h);
}

void tobi_smoothing_weigh(int shape, int dimension, double h, int n, const double *square, double *w)
{
    const double scale = norm(shape, dimension, h);
    if (shape == TOBI_SHAPE_WENDLAND)       /* the default: without a switch the compiler takes two at once */
        for (int k = 0; k < n; k++) w[k] = value(TOBI_SHAPE_WENDLAND, scale, sqrt(square[k])/h);
    else
        for (int k = 0; k < n; k++) w[k] = value(shape, scale, sqrt(square[k])/h);
}

double tobi_smoothing_f(int shape, int dimension, double h, double r)
{
    const double q = r/h, t = 1 - q, u = positive(0.5 - q), n = norm(shape, dimension, h),
                 k = steepness(shape, h), over = r > 0 ? r : 1e-30;
    if (q >= 1) return 0;
    switch (shape) {
    case TOBI_SHAPE_WENDLAND: return n*20/(h*h)*t*t*t;
    case TOBI_SHAPE_CUBIC: return n*6/h*(t*t - 4*u*u)/over;
    case TOBI_SHAPE_QUARTIC:
        return n*k*(pow(t, 3) - 5*pow(positive(0.6 - q), 3) + 10*pow(positive(0.2 - q), 3))/over;
    case TOBI_SHAPE_QUINTIC:
        return n*k*(pow(t, 4) - 6*pow(positive(2/3.0 - q), 4) + 15*pow(positive(1/3.0 - q), 4))/over;
    case TOBI_SHAPE_WENDLAND_C4: return n*k*pow(t, 5)*(1 + 5*q);
    default: return n*k*pow(t, 7)*(1 + 7*q + 16*q*q);
    }
}

/* Sums over lattice neighbours: kernel, that of those with x > 0, second moment xx, gradient of those with
   x > 0, V F, twice V F where i + j + k is odd; second moments xx, yy of those with x > 0. */
typedef struct lattice_sums {
    double w, behind, moment, slope_half, rate, shortest, along, across;
} lattice_sums;

static lattice_sums sum_lattice(int shape, int dimension, double d, double h)
{
    lattice_sums s = {0};
    int n = (int)ceil(h/d), nz = dimension == 3 ? n : 0;
    double v = dimension == 3 ? d*d*d : d*d;
    for (int k = -nz; k <= nz; k++)
        for (int j = -n; j <= n; j++)
            for (int i = -n; i <= n; i++) {
                double x = i*d, y = j*d, z = k*d, r2 = x*x + y*y + z*z, r = sqrt(r2);
                double w = v*tobi_smoothing_w(shape, dimension, h, r);
                s.w += w;
                if (i > 0) s.behind += w;
                if (r2 == 0) continue;
                double f = v*tobi_smoothing_f(shape, dimension, h, r);
                s.rate += f;
                s.shortest += (i + j + k)%2 ? 2*f : 0;
                s.moment += f*x*x;
                if (i <= 0) continue;
                s.slope_half += f*x;
                s.along += f*x*x;
                s.across += f*y*y;
            }
    return s;
}

/* Integral of the kernel over the plane at distance z (over a line in 2-D). */
static double integrate_plane(int shape, int dimension, double h, double z)
{
    enum { N = 200 };
    double end = sqrt(fmax(h*h - z*z, 0)), sum = 0, square[N], w[N];
    for (int i = 0; i < N; i++) {
        double a = (i + 0.5)*end/N;
        square[i] = a*a + z*z;
    }
    tobi_smoothing_weigh(shape, dimension, h, N, square, w);
    for (int i = 0; i < N; i++) sum += w[i]*(dimension == 3 ? 2*PI*((i + 0.5)*end/N) : 2);
    return sum*end/N;
}

static void fill_plane(tobi_smoothing_constants *c, double slope_half, double behind)
{
    enum { N = TOBI_PLANE_SAMPLES };
    double h = c->h, step = h/N, lambda = 0, sigma[N + 2];
    for (int k = 0; k <= N; k++) sigma[k] = integrate_plane(c->shape, c->dimension, h, k*step);
    memset(&c->plane, 0, sizeof c->plane);
    for (int k = N - 1; k >= 0; k--) {
        lambda += 0.5*step*(sigma[k] + sigma[k + 1]);
        c->plane.lambda[k] = (float)lambda;
        c->plane.sigma[k] = (float)sigma[k];
    }
    /* Scale sigma to what a lattice particle at s = d/2 needs against a uniform pressure, and lambda, in
       the density, to what it lacks. */
    double at = 0.5*c->spacing/step;
    int k = (int)at;
    double value = c->plane.sigma[k] + (at - k)*(c->plane.sigma[k + 1] - c->plane.sigma[k]);
    double share = c->plane.lambda[k] + (at - k)*(c->plane.lambda[k + 1] - c->plane.lambda[k]);
    c->wall_share = share;
    c->wall_lattice = behind;
    double scale = slope_half*c->slope_correction/value;
    c->plane_scale = scale;
    for (k = 0; k <= N; k++) c->plane.sigma[k] *= (float)scale;
}

void tobi_smoothing_init(tobi_smoothing_constants *c, int shape, int dimension, double spacing,
                         double support)
{
    double h = support*spacing;
    lattice_sums s = sum_lattice(shape, dimension, spacing, h);
    memset(c, 0, sizeof *c);
    c->shape = shape;
    c->dimension = dimension;
    c->spacing = spacing;
    c->h = h;
    c->volume = dimension == 3 ? spacing*spacing*spacing : spacing*spacing;
    c->weight_correction = 1/s.w;
    c->slope_correction = 1/s.moment;
    c->rate = s.rate*c->slope_correction;
    c->shortest = s.shortest*c->slope_correction;
    c->moment_lattice = (s.along + (dimension - 1)*s.across)/(s.along - s.across);
    double n = norm(shape, dimension, h)*c->volume;
    c->weight = n*c->weight_correction;
    c->slope = n*steepness(shape, h)*c->slope_correction;
    fill_plane(c, s.slope_half, s.behind*c->weight_correction);
}
