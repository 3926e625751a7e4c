/* The drag of porous zones per particle against plain matrices (test_sph_oracle.c has the operator). */
#include "sph/porous.k.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <cmocka.h>

/* c P of stones, of stems along n and of a screen across it, as zones encode it. */
static tobi_float4 encode(int kind, double c, const double n[3])
{
    const double root = kind == 0 ? 0 : sqrt(c);
    return (tobi_float4){ (float)(root*n[0]), (float)(root*n[1]), (float)(root*n[2]),
                          kind == 2 ? 0 : (float)c };
}

/* M = (1 + c P)^-1 = 1 - c/(1 + c) P. */
static void fill(int kind, double c, const double n[3], double m[3][3])
{
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            const double nn = n[a]*n[b], p = kind == 0 ? a == b : kind == 1 ? (a == b) - nn : nn;
            m[a][b] = (a == b) - c/(1 + c)*p;
        }
}

static double random_number(void)
{
    static uint64_t state = 7;
    state = state*6364136223846793005u + 1442695040888963407u;
    return (double)(state >> 33)/2147483648.0 - 0.5;
}

static void drag_is_the_matrix_it_stands_for(void **state)
{
    static const double drags[] = { 0, 1e-3, 0.3, 5, 1e4 };
    (void)state;
    for (int kind = 0; kind < 3; kind++)
        for (int k = 0; k < 5; k++) {
            double n[3] = { random_number() + 0.1, random_number(), random_number() - 0.3 }, m[3][3],
                   mean = 0;
            const double size = sqrt(n[0]*n[0] + n[1]*n[1] + n[2]*n[2]);
            for (int a = 0; a < 3; a++) n[a] /= size;
            const tobi_float4 d = encode(kind, drags[k], n);
            float x[3];
            for (int a = 0; a < 3; a++) x[a] = (float)random_number();
            const float in[3] = { x[0], x[1], x[2] };
            fill(kind, drags[k], n, m);
            sph_porous_yield(d, x);
            for (int a = 0; a < 3; a++) {
                const double expected = m[a][0]*in[0] + m[a][1]*in[1] + m[a][2]*in[2];
                if (!(fabs(x[a] - expected) < 2e-6))
                    fail_msg("kind %d, c %g: %g, not %g", kind, drags[k], x[a], expected);
                mean += m[a][a]/3;
            }
            assert_true(fabs(sph_porous_mean(d, 3) - mean) < 2e-6);
            assert_true(fabs(sph_porous_drag(d) - drags[k]) <= 1e-5*drags[k]);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(drag_is_the_matrix_it_stands_for),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
