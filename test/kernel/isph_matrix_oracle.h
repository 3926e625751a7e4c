/* What the matrix and the gradient promise, for test_isph_oracle.c. */
#pragma once

static void the_matrix_is_symmetric(void **state)
{
    (void)state;
    for (int body = 0; body < 3; body++) {
        mixed = body == 2;
        open_pool(3, 0, TOBI_SHAPE_WENDLAND, body > 0);
        double forth = 0, back = 0;
        double *x = calloc((size_t)view.count, sizeof *x);
        const double *y = view.in;
        for (int n = 0; n < 6; n++) {
            prepare(n);
            run(kernel_at(kernel, n), NULL);
        }
        for (int64_t i = 0; i < view.count; i++) x[i] = poisson_random();
        run(kernel->isph_multiply, NULL);
        for (int64_t i = 0; i < view.count; i++) forth += x[i]*view.out[i];
        view.in = x;
        run(kernel->isph_multiply, NULL);
        for (int64_t i = 0; i < view.count; i++) back += y[i]*view.out[i];
        view.in = y;
        /* sides: to round-off of double; bodies: sums of images in another order */
        assert_true(fabs(forth - back) < (body ? 1e-7 : 1e-9)*view.full*(double)view.count);
        free(x);
        close_pool();
    }
    mixed = 0;
}

/* Water at rest under its own pressure feels no force at all, at walls and in corners as well. */
static void linear_pressures_are_exact(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        open_pool(2 + k, 1, TOBI_SHAPE_WENDLAND, 0);
        run(kernel->isph_geometry, NULL);
        for (int64_t i = 0; i < view.count; i++) {
            const double *x = &view.position[i].x;
            view.velocity[i] = (tobi_float4){ 0 };
            view.solution[i] = 0;
            for (int a = 0; a <= 1 + k; a++) view.solution[i] += view.density*view.gravity[a]*x[a];
        }
        double t[TOBI_TOTALS];
        run(kernel->isph_gravity, NULL);
        run(kernel->isph_store_pressure, NULL);
        run(kernel->isph_projection, t);
        for (int64_t i = 0; i < view.count; i++)
            for (int a = 0; a <= 1 + k; a++) assert_true(fabsf((&view.velocity[i].x)[a]) < 1e-4*view.dt*9.81);
        close_pool();
    }
}
