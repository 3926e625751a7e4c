/* Oracles of the sweeps of eisph, for test_isph_oracle.c, which has the view, the sums and compare(). */
#pragma once

/* Of the row at hand, before the kernel; out: the product, which the caller has made. */
typedef struct sweep { double source, solution, out; } sweep;
static sweep *last;
static double size_of_source(void) { return view.density/view.dt/view.dt; }

/* Two maxima over all particles: check_extent. */
static void oracle_eisph_extent(check *c, int64_t i, const sums *s)
{
    (void)c; (void)i; (void)s;
}

static void check_extent(check *c, const double *t)
{
    double low = 1e30, high = -1e30, size = 0;
    for (int64_t i = 0; i < view.count; i++) {
        const tobi_double3 *x = &view.position[i];
        const double g = view.dimension == 2 ? view.gravity[1] : view.gravity[2];
        const double last_axis = view.dimension == 2 ? x->y : x->z;
        const double along = (x->x*view.gravity[0] + last_axis*g)/hypot(view.gravity[0], g);
        low = fmin(low, along);
        high = fmax(high, along);
    }
    for (int a = 0; a < view.dimension; a++) size += view.size[a]*view.size[a];
    compare(c, t[6], sqrt(size) + high, 1);
    compare(c, t[7], sqrt(size) - low, 1);
}

static void oracle_eisph_residual(check *c, int64_t i, const sums *s)
{
    (void)s;
    compare(c, view.source[i], last[i].source - last[i].out, size_of_source());
    compare(c, view.solution[i], last[i].solution, 1000);
}

static void oracle_eisph_begin(check *c, int64_t i, const sums *s)
{
    const double change = 0.7*(last[i].source - 3)*view.inverse_diagonal[i];
    (void)s;
    compare(c, view.source[i], last[i].source - 3, size_of_source());
    compare(c, view.out[i], change, size_of_source()/view.full);
    compare(c, view.solution[i], last[i].solution + change, size_of_source()/view.full);
}

static void oracle_eisph_sweep(check *c, int64_t i, const sums *s)
{
    (void)s;
    const double r = last[i].source - last[i].out,
                 change = 0.4*view.in[i] + 0.7*r*view.inverse_diagonal[i];
    compare(c, view.source[i], r, size_of_source());
    compare(c, view.out[i], change, size_of_source()/view.full);
    compare(c, view.solution[i], last[i].solution + change, size_of_source()/view.full);
}
