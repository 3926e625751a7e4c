/* Oracle of the shift of positions and of the velocity that goes with it, and what repeated shifts make of a
   velocity; a part of test_isph_oracle.c. */
#pragma once

static void oracle_isph_shift(check *c, int64_t i, const sums *s)
{
    const double full = 1 - loss_of(s), d = view.spacing;
    double x[3], along[3], size = 0, n2 = 0, at = 0;
    const int surface = view.gate[i] > 0, fades = view.fades && !(view.last_link && view.last_link[i] >= 0);
    for (int a = 0; a < 3; a++) x[a] = surface && full < 0.6 ? 0 : -view.shifting*d*d*s->gradient_c[a];
    for (int a = 0; a < 3; a++) { n2 += s->normal[a]*s->normal[a]; at += x[a]*s->normal[a]; }
    for (int a = 0; a < 3; a++) {
        const double lost = surface ? full >= 0.6 : fades ? clip((sqrt(n2) - 0.3)/0.5) : 0;
        if (n2 > 1e-24) x[a] -= lost*at/n2*s->normal[a];
        x[a] = a < view.dimension ? x[a] + s->core[a] : 0;
        size += x[a]*x[a];
    }
    const double keep = size > 0.01*d*d ? 0.1*d/sqrt(size) : 1;
    isph_apply(&view.inverse[i], x, along);
    const double square = along[0]*along[0] + along[1]*along[1] + along[2]*along[2];
    for (int a = 0; a < 3; a++) {
        double change = 2*keep*square*s->bend[a];
        for (int b = 0; b < 3; b++) change += s->slope[3*a + b]*along[b];
        compare(c, (&view.accel[i].x)[a]*view.way*view.way, keep*x[a], d);
        const int none = a >= view.dimension || (view.open && full < 0.6);
        const double limited = fmin(fmax(keep*change, s->low[a]), s->high[a]);
        compare(c, (&view.shift_velocity[i].x)[a], none ? 0 : limited, 1);
    }
}

/* sum gains part of the velocity's change, by a share of the shift and over that share. A small share leaves
   out what (10a) adds, which grows with the square. */
static void add_change(tobi_float4 *sum, double share, double part)
{
    const double whole = view.shifting;
    view.shifting *= share;
    run(kernel->isph_shift, NULL);
    view.shifting = whole;
    for (int64_t i = 0; i < view.count; i++)
        for (int a = 0; a < view.dimension; a++)
            (&sum[i].x)[a] += (float)(part/share*(&view.shift_velocity[i].x)[a]);
}

/* How much a random velocity grows by 1000 shifts of a twentieth of a spacing, to and fro, in many ways, on
   disordered particles, with this part of (10a). */
static double grow(double part)
{
    double before = 0, after = 0;
    open_pool(2, 1, TOBI_SHAPE_WENDLAND, 0);
    tobi_float4 *sum = calloc((size_t)view.count, sizeof *sum);
    run(kernel->isph_geometry, NULL);
    view.spacing = 0.6*pool.d;                       /* no pair is nearer than the core */
    for (int64_t i = 0; i < view.count; i++)
        for (int a = 0; a < 2; a++) before += (&view.velocity[i].x)[a]*(&view.velocity[i].x)[a];
    view.shifting = 0.05*pool.d/(view.spacing*view.spacing);
    for (int n = 0; n < 1000; n++) {
        const float sign = n%2 ? -1 : 1, angle = (float)(n/2);
        for (int64_t i = 0; i < view.count; i++)
            view.concentration_gradient[i] = (tobi_float4){sign*cosf(angle), sign*sinf(angle), 0, 0};
        memset(sum, 0, (size_t)view.count*sizeof *sum);
        add_change(sum, 1, part);
        add_change(sum, 1e-3, 1 - part);
        for (int64_t i = 0; i < view.count; i++)
            for (int a = 0; a < 2; a++) (&view.velocity[i].x)[a] += (&sum[i].x)[a];
    }
    for (int64_t i = 0; i < view.count; i++)
        for (int a = 0; a < 2; a++) after += (&view.velocity[i].x)[a]*(&view.velocity[i].x)[a];
    free(sum);
    close_pool();
    return sqrt(after/before);
}

/* 2 is what isph adds, 1 what Lax and Wendroff do. */
static void shifts_do_not_amplify(void **state)
{
    (void)state;
    const double none = grow(0), half = grow(0.5), whole = grow(1);
    printf("a random velocity after 1000 shifts: %.3g times as large; half of (10a): %.3g, all: %.3g\n",
           none, half, whole);
    assert_true(none > half && half > whole);
    assert_true(whole < 1);
}
