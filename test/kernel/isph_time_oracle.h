/* Oracles of what steps of second order in time add; a part of test_isph_oracle.c. */
#pragma once

static void check_invariant(check *c, int64_t i, const sums *s)
{
    double g[3][3], trace = 0;
    for (int a = 0; a < 3; a++) isph_apply(&view.inverse[i], &s->slope[3*a], g[a]);
    for (int a = 0; a < view.dimension; a++)
        for (int b = 0; b < view.dimension; b++) trace += g[a][b]*g[b][a];
    compare(c, view.invariant[i], loss_of(s) > 0.4 ? 0 : trace, 10/(view.h*view.h));
}

/* The last kernel: those before it see the positions of the pool. Sides are a fifth of a spacing away. */
static void oracle_isph_drift(check *c, int64_t i, const sums *s)
{
    (void)s;
    for (int a = 0; a < view.dimension; a++) {
        const double start = (&pool.p.position[i].x)[a] + (bodies && a == 0 ? FAR*view.h : 0);
        const double x = start + 5e-4*(&view.velocity[i].x)[a], least = 0.2*view.spacing;
        compare(c, (&view.position[i].x)[a], fmin(fmax(x, least), view.size[a] - least), view.spacing);
    }
}
