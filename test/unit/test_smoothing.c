/* Smoothing kernels: their integral is one on lattices as fine as the table everybody prints (points of
   a cube around the support, N intervals a side), and the lattice normalisation is exact. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include "core/smoothing.h"
#define TOBI_SCALAR_LANES
#include "core/smoothing.k.h"
#include "kernel/smoothing_oracle.h"

/* Sum of W a^dim over the points of a cube (square in 2-D) of side 2 h, a = 2 h/n apart, from its corner. */
static double integrate(int shape, int dimension, int n)
{
    double h = 0.013, a = 2*h/n, sum = 0;
    for (int k = 0; k < (dimension == 3 ? n : 1); k++)
        for (int j = 0; j < n; j++)
            for (int i = 0; i < n; i++) {
                double x = i*a - h, y = j*a - h;
                double z = dimension == 3 ? k*a - h : 0;
                sum += tobi_smoothing_w(shape, dimension, h, sqrt(x*x + y*y + z*z));
            }
    return sum*pow(a, dimension);
}

static const char *const NAME[TOBI_SHAPES] = {
    [TOBI_SHAPE_WENDLAND] = "wendland c2", [TOBI_SHAPE_CUBIC] = "cubic spline",
    [TOBI_SHAPE_QUARTIC] = "quartic spline", [TOBI_SHAPE_QUINTIC] = "quintic spline",
    [TOBI_SHAPE_WENDLAND_C4] = "wendland c4", [TOBI_SHAPE_WENDLAND_C6] = "wendland c6",
};

/* Published for the cubic and the quintic spline in 3-D, six digits. */
static const int N[] = {5, 10, 15, 20, 25};
static const double TABLE[TOBI_SHAPES][5] = {
    [TOBI_SHAPE_CUBIC] = {1.00527, 1.00011, 0.999972, 1, 1},
    [TOBI_SHAPE_QUINTIC] = {0.999206, 1.00005, 0.999999, 1, 1},
};

static void integrals_are_one(void **state)
{
    (void)state;
    static const double allowed[] = {0.02, 5e-4, 1e-4, 5e-5, 2e-5};
    for (int shape = 0; shape < TOBI_SHAPES; shape++)
        for (int dimension = 2; dimension <= 3; dimension++)
            for (int k = 0; k < 5; k++) {
                double sum = integrate(shape, dimension, N[k]);
                print_message("%s %d-D N = %2d: %.6f\n", NAME[shape], dimension, N[k], sum);
                assert_true(fabs(sum - 1) < allowed[k]);
                if (dimension == 3 && TABLE[shape][k] > 0)
                    assert_true(fabs(sum - TABLE[shape][k]) < 5e-6);
            }
}

/* As their papers write them. */
static void kernels_are_the_published(void **state)
{
    (void)state;
    for (int shape = 0; shape < TOBI_SHAPES; shape++)
        for (int dimension = 2; dimension <= 3; dimension++)
            for (double r = 0.01; r < 0.031; r += 0.001) {
                const double w = kernel_w(shape, dimension, 0.03, r), f = kernel_f(shape, dimension, 0.03, r);
                assert_true(fabs(tobi_smoothing_w(shape, dimension, 0.03, r) - w) <= 1e-12*w + 1e-9);
                assert_true(fabs(tobi_smoothing_f(shape, dimension, 0.03, r) - f) <= 1e-12*f + 1e-5);
            }
}

/* F = -W'/r against a central difference. */
static void slopes_are_derivatives(void **state)
{
    (void)state;
    for (int shape = 0; shape < TOBI_SHAPES; shape++)
        for (int dimension = 2; dimension <= 3; dimension++)
            for (double r = 0.05; r < 0.99; r += 0.07) {
                double e = 1e-5, slope = (tobi_smoothing_w(shape, dimension, 1, r + e) -
                                          tobi_smoothing_w(shape, dimension, 1, r - e))/(2*e);
                double f = tobi_smoothing_f(shape, dimension, 1, r);
                assert_true(fabs(-slope/r - f) < 1e-6*(1 + fabs(f)));
            }
}

/* With the constants the kernels use, the lattice sum is 1 and a linear field has its exact gradient. */
static void lattice_is_normalised(void **state)
{
    (void)state;
    double d = 0.004;
    for (int shape = 0; shape < TOBI_SHAPES; shape++)
        for (int dimension = 2; dimension <= 3; dimension++)
            for (double support = 2; support <= 4; support += 0.5) {
                tobi_smoothing_constants c;
                tobi_smoothing_init(&c, shape, dimension, d, support);
                int m = 4, mz = dimension == 3 ? m : 0;
                double sum = 0, gradient = 0;
                for (int k = -mz; k <= mz; k++)
                    for (int j = -m; j <= m; j++)
                        for (int i = -m; i <= m; i++) {
                            double r = d*sqrt(i*i + j*j + k*k);
                            if (r >= c.h) continue;
                            sum += c.weight*smoothing_shape(shape, (float)(r/c.h));
                            gradient += c.slope*smoothing_falloff(shape, (float)(r/c.h), (float)r)*i*d*i*d;
                        }
                assert_true(fabs(sum - 1) < 1e-5);
                assert_true(fabs(gradient - 1) < 1e-5);
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(integrals_are_one), cmocka_unit_test(kernels_are_the_published),
        cmocka_unit_test(slopes_are_derivatives),
        cmocka_unit_test(lattice_is_normalised),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
