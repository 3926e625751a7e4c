/* Oracles of the kernels of isph that few scenes ask for; part of test_isph_oracle.c. */
#pragma once

static void add_choices(int64_t i, const image *m, const double u[3], double f, int plain, sums *s)
{
    const tobi_float4 *c = &view.concentration_gradient[i];
    const double size = sqrt((double)c->x*c->x + (double)c->y*c->y + (double)c->z*c->z);
    double along = 0;
    s->count += 1;
    for (int k = 0; k < 3; k++) {
        const double jump = u[k] - (&view.velocity[i].x)[k];
        along += m->x[k]*(&c->x)[k]/(size + 1e-30);
        s->mean[k] += weight(m->r)*jump;
        s->all[k] += 2*f*jump;
        if (plain) s->plain[k] += 2*f*jump;
    }
    s->cone += along > m->r*sqrt(0.5);
}

static void check_geometry_sums(check *c, const double *t)
{
    double excess = 0, inside = 0;
    for (int64_t i = 0; i < view.count; i++)
        if (!(view.gate[i] > 0)) {
            excess += view.concentration[i] - 1.0;
            inside++;
        }
    compare(c, t[0], excess, inside + 1);
    compare(c, t[1], inside, 1);
}

static void oracle_isph_mark(check *c, int64_t i, const sums *s)
{
    if (view.by_count) compare(c, view.gate[i], clip((0.85 - s->count/view.lattice_count)/0.1), 1);
    else compare(c, view.gate[i], s->cone == 0 && 1 - view.trace[i]/view.dimension > 0.1, 1);
}

static void oracle_isph_divergence(check *c, int64_t i, const sums *s)
{
    compare(c, (&view.accel[i].x)[0], s->divergence, 1/view.h);
}

/* accel was 0 but for the divergence. */
static void oracle_isph_xsph(check *c, int64_t i, const sums *s)
{
    for (int a = 0; a < view.dimension; a++)
        compare(c, ((&view.accel[i].x)[a] - (a == 0 ? s->divergence : 0))*view.way*view.way/view.dt,
                view.xsph*s->mean[a], 1);
}

/* The form less the gradient: 2 sum of V F (u_j - u_i + x_ij . grad u_i). */
static void oracle_isph_viscosity(check *c, int64_t i, const sums *s)
{
    const isph_tensor *b = &view.inverse[i];
    const double inverse[3][3] = {{b->xx, b->xy, b->zx}, {b->xy, b->yy, b->yz}, {b->zx, b->yz, b->zz}};
    const double share = alone(i)*(1 - view.gate[i])*view.dt*view.kinematic[fluids[i]];
    for (int a = 0; a < view.dimension; a++) {
        double corrected = s->all[a];
        for (int k = 0; k < 3; k++)
            for (int l = 0; l < 3; l++) corrected -= 2*s->slope[3*a + k]*inverse[k][l]*s->gradient_c[l];
        compare(c, (&view.shift_velocity[i].x)[a], share*(corrected - s->plain[a]), share*view.full + 1e-9);
    }
}

/* Viscosity on y^2, x y and x^2 in disorder, away from walls: the full form is exact. */
static void full_viscosity_is_exact(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        open_pool(dimension, 1, TOBI_SHAPE_WENDLAND, 0);
        view.full_viscosity = 1;
        run(kernel->isph_geometry, NULL);
        for (int64_t i = 0; i < view.count; i++) {
            const double *x = &view.position[i].x, y = x[dimension - 1];
            view.velocity[i].x = (float)(y*y - 3*x[0]*y + 2*x[1]);
            view.velocity[i].y = (float)(2*x[0]*x[0] - y);
            view.velocity[i].z = 0;
        }
        double worst = 0;
        int64_t inside = 0;
        for (int64_t i = 0; i < view.count; i++) {
            int deep = 1;
            for (int a = 0; a < dimension; a++)
                deep &= (&view.position[i].x)[a] > view.h && view.size[a] - (&view.position[i].x)[a] > view.h;
            if (!deep) continue;
            const sums s = sum_pairs(i);
            const double share = view.dt*view.kinematic[0];
            kernel->isph_viscosity.run(&view, i, i + 1, NULL);
            worst = fmax(worst, fabs((&view.shift_velocity[i].x)[0]/share + s.plain[0] - 2));
            worst = fmax(worst, fabs((&view.shift_velocity[i].x)[1]/share + s.plain[1] - 4));
            inside++;
        }
        printf("%d-D: full viscosity off by %.1e of 2 at %d particles\n", dimension, worst, (int)inside);
        assert_true(inside > 5 && worst < 0.01);
        close_pool();
    }
}

/* The gate by cones, and the least eigenvalue against the determinant of M - x. */
static void surfaces_are_marked(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        open_pool(dimension, 0, TOBI_SHAPE_WENDLAND, 0);
        check c = {"isph_mark", 0};
        int64_t open = 0;
        run(kernel->isph_geometry, NULL);
        view.by_count = 0;
        run(kernel->isph_mark, NULL);
        for (int64_t i = 0; i < view.count; i++) {
            const sums s = sum_pairs(i);
            oracle_isph_mark(&c, i, &s);
            open += view.gate[i] > 0;
            double m[6], x;
            for (int k = 0; k < 6; k++) m[k] = s.moment[k];
            x = isph_least(m, dimension);
            const double u = m[0] - x, v = m[1] - x, w = dimension == 3 ? m[2] - x : 1,
                         det = w*(u*v - m[3]*m[3]) - m[4]*(u*m[4] - m[3]*m[5]) + m[5]*(m[3]*m[4] - v*m[5]);
            assert_true(fabs(det) < 1e-6 && u > -1e-6 && v > -1e-6 && w > -1e-6);
        }
        assert_true(c.worst == 0 && open > 3 && open < view.count/3);
        close_pool();
    }
}

/* Divergence of a linear flow that no wall feels, away from walls. */
static void linear_flows_are_exact(void **state)
{
    (void)state;
    open_pool(2, 1, TOBI_SHAPE_WENDLAND, 0);
    run(kernel->isph_geometry, NULL);
    double worst = 0;
    int64_t inside = 0;
    for (int64_t i = 0; i < view.count; i++)
        view.velocity[i] = (tobi_float4){ (float)(2*view.position[i].x + 5*view.position[i].y),
                                          (float)(view.position[i].y - 3*view.position[i].x), 0, 0 };
    for (int64_t i = 0; i < view.count; i++) {
        double t[TOBI_TOTALS] = { 0 };
        const double x = view.position[i].x, y = view.position[i].y;
        if (fmin(fmin(x, y), fmin(view.size[0] - x, view.size[1] - y)) < view.h) continue;
        kernel->isph_shift.run(&view, i, i + 1, t);
        worst = fmax(worst, fabs(t[0] - 3));
        inside++;
    }
    assert_true(inside > 20);
    assert_true(worst < 1e-4);
    close_pool();
}
