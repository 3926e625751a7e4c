/* Fields at places: linear fields exactly and quadratic ones in second order, on particles that are off a
   lattice; which places are wet; sides that are periodic; means against plain sums; the same bits for any
   number of threads; mistakes in words. */
#define _GNU_SOURCE 1
#include "calls.h"
#include "tobiuo/sample.h"
#include <math.h>
#include <stdlib.h>
#include <unistd.h>

enum { MOST = 64000, PLACES = 4000 };

typedef struct rig {
    double x[MOST][3], linear[MOST], vector[MOST][3], places[PLACES][3], at[PLACES], vector_at[PLACES][3];
    uint8_t wet[PLACES];
    tobi_sample_field field[2];
    tobi_sample_def def;
} rig;

/* A number from -1 to 1 of a row: the fraction of multiples of irrational numbers (Kronecker). */
static double scatter(int64_t i, int a)
{
    static const double step[3] = { 0.8191725134, 0.6710436067, 0.5497004779 };
    const double p = (double)i*step[a];
    return 2*(p - floor(p)) - 1;
}

/* `side` particles along each axis of a unit box, filled up to `full` of them along the last, off their
   lattice by `off` spacings at most. */
static rig *make_rig(int dimension, int side, int full, double off)
{
    rig *r = calloc(1, sizeof *r);
    const double d = 1.0/side;
    int64_t n = 0;
    const int deep = dimension == 3 ? side : 1;
    for (int z = 0; z < (dimension == 3 ? full : 1); z++)
        for (int y = 0; y < (dimension == 3 ? deep : full); y++)
            for (int x = 0; x < side; x++, n++) {
                const int at[3] = { x, y, z };
                for (int a = 0; a < dimension; a++) r->x[n][a] = d*(at[a] + 0.5 + off*scatter(n, a));
            }
    r->def = tobi_default_sample();
    r->def.dimension = dimension, r->def.spacing = d, r->def.threads = 1;
    for (int a = 0; a < 3; a++) r->def.box_max[a] = 1;
    r->def.particle_count = n, r->def.positions = (const double (*)[3])r->x;
    r->def.place_count = PLACES, r->def.places = (const double (*)[3])r->places;
    r->field[0] = (tobi_sample_field){ 1, r->linear, r->at };
    r->field[1] = (tobi_sample_field){ 3, r->vector[0], r->vector_at[0] };
    r->def.fields = r->field, r->def.field_count = 2, r->def.wet = r->wet;
    for (int64_t i = 0; i < PLACES; i++)
        for (int a = 0; a < dimension; a++) r->places[i][a] = 0.5 + 0.5*scatter(i + 7, a);
    return r;
}

static double linear(const double x[3]) { return 3 + 2*x[0] - 5*x[1] + 7*x[2]; }
static double curved(const double x[3]) { return x[0]*x[0] - 2*x[0]*x[1] + x[1]*x[1]*0.5 + 1; }

static void set_fields(rig *r, double (*f)(const double x[3]))
{
    for (int64_t i = 0; i < r->def.particle_count; i++) {
        r->linear[i] = f(r->x[i]);
        for (int a = 0; a < 3; a++) r->vector[i][a] = (a + 1)*f(r->x[i]);
    }
}

/* Everywhere in the box, sides included; in a corner there may be too few for the fit, so a lattice there. */
static void test_linear(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++)
        for (int lattice = 0; lattice < 2; lattice++) {
            rig *r = make_rig(dimension, 20, 20, lattice ? 0 : 0.2);
            const double d = 1.0/20;
            int64_t met = 0;
            set_fields(r, linear);
            for (int64_t i = 0; i < 8; i++)         /* corners */
                for (int a = 0; a < dimension; a++) r->places[i][a] = i >> a & 1;
            OK(tobi_sample_make(&r->def, &err));
            for (int64_t i = 0; i < PLACES; i++) {
                int sides = 0;
                for (int a = 0; a < dimension; a++) sides += fabs(r->places[i][a] - 0.5) > 0.5 - 1.5*d;
                assert_int_equal(r->wet[i], 1);
                if (!lattice && sides > 1) continue;
                const double exact = linear(r->places[i]);
                if (fabs(r->at[i] - exact) > 1e-11)
                    fail_msg("%d-D: %.17g is not %.17g", dimension, r->at[i], exact);
                assert_true(fabs(r->vector_at[i][2] - 3*exact) < 1e-11);
                met++;
            }
            assert_true(met > PLACES/2);
            free(r);
        }
}

static double find_error(int side)
{
    rig *r = make_rig(2, side, side, 0.2);
    double worst = 0;
    set_fields(r, curved);
    OK(tobi_sample_make(&r->def, &err));
    for (int64_t i = 0; i < PLACES; i++)
        if (fabs(r->places[i][0] - 0.5) < 0.4 && fabs(r->places[i][1] - 0.5) < 0.4)
            worst = fmax(worst, fabs(r->at[i] - curved(r->places[i])));
    free(r);
    return worst;
}

/* Half the spacing, a quarter of the error. The places lie otherwise among the particles: 3 to 5. */
static void test_curved(void **state)
{
    (void)state;
    const double coarse = find_error(20), fine = find_error(40);
    if (!(coarse/fine > 3 && coarse/fine < 5 && coarse < 0.01)) fail_msg("errors %g and %g", coarse, fine);
}

/* Where it is wet below a flat surface, beside sides, and outside of a body of points. */
static void test_wet(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        rig *r = make_rig(dimension, 20, 10, 0.1);
        const double d = 1.0/20;
        const int up = dimension - 1;
        OK(tobi_sample_make(&r->def, &err));
        for (int64_t i = 0; i < PLACES; i++) {
            const double above = (r->places[i][up] - 0.5)/d;
            if (above < -0.3) assert_int_equal(r->wet[i], 1);
            if (above > 0.3) assert_int_equal(r->wet[i], 0);
            assert_int_equal(isnan(r->at[i]) != 0, !r->wet[i]);
        }
        /* a column beside the side at x = 0 becomes a body */
        int64_t kept = 0, solid = 0;
        double (*solids)[3] = calloc(MOST, sizeof *solids);
        for (int64_t i = 0; i < r->def.particle_count; i++)
            memcpy(r->x[i][0] < 6*d ? solids[solid++] : r->x[kept++], r->x[i], sizeof *r->x);
        r->def.particle_count = kept, r->def.solid_count = solid, r->def.solids = (const double (*)[3])solids;
        for (int64_t i = 0; i < 100; i++)           /* where the surface meets it */
            r->places[i][0] = 6.05*d, r->places[i][up] = d*(9.45 - 0.01*(double)i);
        OK(tobi_sample_make(&r->def, &err));
        for (int64_t i = 0; i < PLACES; i++) {
            const double off = r->places[i][0]/d - 6, below = 10 - r->places[i][up]/d;
            if (off > (i < 100 ? 0 : 0.3) && below > 0.5) assert_int_equal(r->wet[i], 1);
            if (off < -0.4 || below < -0.5) assert_int_equal(r->wet[i], 0);
        }
        free(solids);
        free(r);
    }
}

/* A field with the period of the box, seen through its side; the sides of y are walls. */
static void test_periodic(void **state)
{
    (void)state;
    rig *r = make_rig(2, 40, 40, 0);
    r->def.periodic[0] = 1;
    for (int64_t i = 0; i < r->def.particle_count; i++) r->linear[i] = cos(2*M_PI*r->x[i][0]);
    for (int64_t i = 0; i < PLACES; i++) r->places[i][0] = 1e-3*(double)(i - PLACES/2);     /* -2 to 2 */
    OK(tobi_sample_make(&r->def, &err));
    for (int64_t i = 0; i < PLACES; i++) {
        assert_int_equal(r->wet[i], 1);
        /* the curvature times half the weighted mean of the square of the distance along x, d^2/4 of full
           liquid; on a square lattice 0.2594 d^2 at most, away from walls */
        const double bound = 0.2594/1600*4*M_PI*M_PI;
        if (fabs(r->places[i][1] - 0.5) > 0.45) continue;
        if (fabs(r->at[i] - cos(2*M_PI*r->places[i][0])) > bound)
            fail_msg("%g: %g", r->places[i][0], r->at[i]);
    }
    free(r);
}

/* Particles in one row have no fit: their mean lies between them. Without any, everything is dry. */
static void test_few(void **state)
{
    (void)state;
    rig *r = make_rig(2, 20, 1, 0);
    set_fields(r, linear);
    r->def.box_max[1] = 1.0/20;
    for (int64_t i = 0; i < PLACES; i++) r->places[i][1] = 1.0/40 + 0.4/20*scatter(i, 1);
    OK(tobi_sample_make(&r->def, &err));
    for (int64_t i = 0; i < PLACES; i++) {
        const double middle[3] = { r->places[i][0], 1.0/40, 0 };
        assert_int_equal(r->wet[i], 1);
        assert_true(fabs(r->at[i] - linear(middle)) < 2.0*2/20);      /* within its reach of two spacings */
    }
    r->def.particle_count = 0;
    OK(tobi_sample_make(&r->def, &err));
    for (int64_t i = 0; i < PLACES; i++) assert_true(!r->wet[i] && isnan(r->at[i]));
    free(r);
}

/* Places and particles that are no places: dry, left out. */
static void test_not_finite(void **state)
{
    (void)state;
    rig *r = make_rig(3, 12, 12, 0.2);
    set_fields(r, linear);
    r->places[0][1] = NAN, r->places[1][0] = INFINITY, r->places[2][2] = -0.01;
    for (int64_t i = 0; i < r->def.particle_count; i += 97) r->x[i][i%3] = NAN, r->linear[i] = NAN;
    OK(tobi_sample_make(&r->def, &err));
    assert_true(!r->wet[0] && !r->wet[1] && !r->wet[2]);
    for (int64_t i = 3; i < PLACES; i++) assert_true(!r->wet[i] || isfinite(r->at[i]));
    free(r);
}

static void test_threads(void **state)
{
    (void)state;
    rig *r = make_rig(3, 20, 12, 0.3);
    double *at = malloc(sizeof r->vector_at);
    set_fields(r, curved);
    OK(tobi_sample_make(&r->def, &err));
    memcpy(at, r->vector_at, sizeof r->vector_at);
    r->def.threads = 3;
    OK(tobi_sample_make(&r->def, &err));
    assert_memory_equal(at, r->vector_at, sizeof r->vector_at);
    free(at);
    free(r);
}

/* Three components at two places over five outputs, the second place wet at two of them. */
static void test_mean(void **state)
{
    (void)state;
    double values[5][2][3], share[2], mean[2][3], rms[2][3], products[2][6];
    const uint8_t wet[5][2] = { { 1, 0 }, { 1, 1 }, { 1, 0 }, { 1, 1 }, { 1, 0 } };
    tobi_sample_mean *m;
    OK(tobi_sample_mean_create(2, 3, 1, &m, &err));
    OK(tobi_sample_mean_read(m, share, mean[0], NULL, NULL, &err));
    assert_true(share[0] == 0 && isnan(mean[0][0]));
    for (int k = 0; k < 5; k++) {
        for (int i = 0; i < 6; i++) values[k][i/3][i%3] = wet[k][i/3] ? 1e6 + scatter(6*k + i, i%3) : NAN;
        OK(tobi_sample_mean_add(m, wet[k], values[k][0], &err));
    }
    OK(tobi_sample_mean_read(m, share, mean[0], rms[0], products[0], &err));
    assert_true(share[0] == 1 && share[1] == 0.4);
    for (int i = 0; i < 2; i++)
        for (int a = 0, p = 0; a < 3; a++) {
            double own = 0, n = i ? 2 : 5;
            for (int k = 0; k < 5; k++) own += wet[k][i] ? values[k][i][a]/n : 0;
            assert_true(fabs(mean[i][a] - own) < 1e-9);
            for (int b = a; b < 3; b++, p++) {
                double other = 0, product = 0;
                for (int k = 0; k < 5; k++) other += wet[k][i] ? values[k][i][b]/n : 0;
                for (int k = 0; k < 5; k++)
                    product += wet[k][i] ? (values[k][i][a] - own)*(values[k][i][b] - other)/n : 0;
                assert_true(fabs(products[i][p] - product) < 1e-8);
                if (a == b) assert_true(fabs(rms[i][a] - sqrt(product)) < 1e-8);
            }
        }
    tobi_sample_mean_free(m);
    tobi_sample_mean_free(NULL);
}

static void refuse_defs(rig *r)
{
    tobi_sample_def d = r->def;
    REFUSED(tobi_sample_make(NULL, &err), TOBI_INVALID, "def");
    d.dimension = 4;
    REFUSED(tobi_sample_make(&d, &err), TOBI_INVALID, "sample: dimension 4, allowed are 2 and 3");
    d = r->def, d.spacing = 0;
    REFUSED(tobi_sample_make(&d, &err), TOBI_INVALID, "sample: a spacing of 0 m, must be greater than 0");
    d = r->def, d.box_max[1] = d.box_min[1];
    REFUSED(tobi_sample_make(&d, &err), TOBI_INVALID, "sample: the box is empty along y");
    d = r->def, d.place_count = -1;
    REFUSED(tobi_sample_make(&d, &err), TOBI_INVALID, "sample: -1 places, allowed are 0 to");
    d = r->def, d.field_count = 33;
    REFUSED(tobi_sample_make(&d, &err), TOBI_INVALID, "sample: 33 fields, allowed are 0 to 32");
    d = r->def, d.places = NULL;
    REFUSED(tobi_sample_make(&d, &err), TOBI_INVALID, "the places");
    r->field[1].components = 10;
    REFUSED(tobi_sample_make(&r->def, &err), TOBI_INVALID,
            "sample: field 1 has 10 components, allowed are 1 to 9");
    r->field[1].components = 3, r->field[1].at = NULL;
    REFUSED(tobi_sample_make(&r->def, &err), TOBI_INVALID, "the values of a field");
}

static void test_mistakes(void **state)
{
    (void)state;
    rig *r = make_rig(2, 4, 4, 0);
    tobi_sample_mean *m;
    const double value = 1;
    const tobi_sample_array array = { "value", 1, &value };
    tobi_sample_grid g = { .cell = { 1, 1, 1 }, .count = { 1, 1, 1 }, .arrays = &array, .array_count = 1 };
    refuse_defs(r);
    REFUSED(tobi_sample_mean_create(1, 0, 1, &m, &err), TOBI_INVALID,
            "sample: means of 0 components, allowed are 1 to 9");
    REFUSED(tobi_sample_mean_create(-1, 1, 1, &m, &err), TOBI_INVALID, "sample: -1 places, allowed are 0 to");
    REFUSED(tobi_sample_mean_add(NULL, NULL, NULL, &err), TOBI_INVALID, "the means");
    OK(tobi_sample_write("one.vti", &g, &err));
    assert_int_equal(unlink("one.vti"), 0);
    g.count[2] = 0;
    REFUSED(tobi_sample_write("no.vti", &g, &err), TOBI_INVALID,
            "no.vti: 0 points along z, allowed are 1 to");
    g.count[2] = 1, g.cell[0] = 0;
    REFUSED(tobi_sample_write("no.vti", &g, &err), TOBI_INVALID, "no.vti: the cells along x have no width");
    g.cell[0] = 1, g.count[0] = g.count[1] = 2000000;
    REFUSED(tobi_sample_write("no.vti", &g, &err), TOBI_INVALID, "no.vti: 4e+12 points are too many");
    g.count[0] = g.count[1] = 1;
    REFUSED(tobi_sample_write("nowhere/no.vti", &g, &err), TOBI_IO, "nowhere/no.vti");
    free(r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_linear), cmocka_unit_test(test_curved), cmocka_unit_test(test_wet),
        cmocka_unit_test(test_periodic), cmocka_unit_test(test_few), cmocka_unit_test(test_not_finite),
        cmocka_unit_test(test_threads), cmocka_unit_test(test_mean), cmocka_unit_test(test_mistakes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
