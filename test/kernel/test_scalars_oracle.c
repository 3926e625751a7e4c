/* Kernels of temperature and concentration (scalars.k.h) against their equations in double over all pairs;
   the same bits on every instruction set; what pairs exchange is neither made nor lost. */
#pragma GCC diagnostic ignored "-Wunused-function"     /* the rig has the oracles of all kernels */
#include "sph/scalars.k.h"
#include "sph/yield.k.h"
#include "kernel/sph_rig.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <cmocka.h>

static const rig_case cases[] = {
    {3, TOBI_SHAPE_WENDLAND, 2.5, {0, 0, 0}, 0, 2, 0.2, 0, 0},
    {2, TOBI_SHAPE_CUBIC,    3.0, {1, 0, 0}, 0, 2, 0.2, 0, 0},
    {2, TOBI_SHAPE_QUINTIC,  2.6, {0, 0, 0}, 1, 1, 0.2, 5, 0},
    {3, TOBI_SHAPE_WENDLAND, 2.5, {1, 1, 1}, 1, 2, 0.2, 0, 0},
};
enum { CASES = sizeof cases/sizeof *cases };

static const double START[2] = {20, 0.03}, DIFFUSIVITY[2] = {1e-4, 3e-6}, PER_EDDY[2] = {1/0.85, 1/0.7};

/* Of a plane and a scalar: a value, one behind a layer, a flux, nothing. */
static tobi_scalar_wall make_wall(int plane, int k)
{
    return plane == 0 ? (tobi_scalar_wall){1, 3.0f + (float)k, 0, 0}
         : plane == 1 ? (tobi_scalar_wall){1, -2, 0, 0.01f}
         : plane == 2 ? (tobi_scalar_wall){0, 0, 5, 0} : (tobi_scalar_wall){0, 0, 0, 0};
}

typedef struct scene { rig g; row *in; tobi_float4 *now, *change; tobi_double2 *own; } scene;

/* Some of the first liquid have more. */
static double find_most_eddy(const scene *s) { return 28*s->g.view.eddy[0]/s->g.o.rho0[0]; }

static void open_scene(scene *s, const rig_case *c)
{
    tobi_error err;
    if (rig_create(&s->g, c, 2, &err)) fail_msg("%s", err.text);
    sph_view *v = &s->g.view;
    const sph_fields *f = sph_fields_of(&s->g.p);
    s->own = v->scalars = f->scalars;
    s->now = v->scalar_now = f->scalar_now;
    s->change = v->scalar_change = f->scalar_change;
    v->viscous.apparent = f->apparent;
    for (int k = 0; k < 2; k++) {
        v->scalar.lift.value[k] = START[k];
        v->scalar.diffusivity[k] = (float)DIFFUSIVITY[k];
        v->scalar.per_eddy[k] = (float)PER_EDDY[k];
    }
    v->scalar.lattice = 0.97f;
    v->scalar.dt = 2e-3f;
    v->scalar.way = 1e-3f;
    v->scalar.most_eddy = (float)find_most_eddy(s);
    for (int64_t i = 0; i < s->g.p.count; i++) {
        s->own[i] = (tobi_double2){ START[0] + 5*rig_random(), START[1] + 0.01*rig_random() };
        f->apparent[i] = (tobi_float4){ 1, (float)(20 + 20*rig_random()), 0, 0 };
        f->accel[i] = (tobi_float4){ (float)(600*rig_random()), (float)(600*rig_random()),
                                     c->dimension == 3 ? (float)(600*rig_random()) : 0, 0 };
    }
    s->in = calloc(s->g.p.count > 0 ? (size_t)s->g.p.count : 1, sizeof(row));
    rig_get(&s->g, s->in);
}

static void close_scene(scene *s)
{
    free(s->in);
    rig_free(&s->g);
}

static double difference(const scene *s, int k, int i) { return (k ? s->own[i].y : s->own[i].x) - START[k]; }
static double density(const scene *s, int i) { return s->g.o.rho0[s->g.o.fluid[i]]; }
static double eddy(const scene *s, int i)
{
    return fmin(s->g.view.eddy[s->g.o.fluid[i]]*s->in[i][SHEAR_RATE]/density(s, i), find_most_eddy(s));
}

/* Eq. (1) without walls: unit/s. */
static double find_rate(const scene *s, int k, int i)
{
    const oracle *o = &s->g.o;
    double rate = 0;
    EACH_NEIGHBOUR(o, s->in, i, j, x, r) {
        const double rho = 2*density(s, j)/(density(s, i) + density(s, j)),
                     d = DIFFUSIVITY[k] + PER_EDDY[k]*(eddy(s, i) + eddy(s, j))/2;
        rate += 2*rho*d*o->volume*o->g_scale*oracle_f(o, r)*(difference(s, k, j) - difference(s, k, i));
        (void)x;
    }
    return rate;
}

/* Eq. (3), of one plane: unit/s. */
static double find_wall_rate(const scene *s, int k, int p, int i)
{
    const oracle *o = &s->g.o;
    const tobi_scalar_wall w = make_wall(p, k);
    const double away = wall_distance(o, s->in, i, p), at = fmax(away, 0.25*o->d),
                 d = DIFFUSIVITY[k] + PER_EDDY[k]*eddy(s, i), rho = density(s, i);
    if (away >= o->h) return 0;
    return 2*s->g.view.scalar.lattice*look_up(o, o->sigma, at)*
           (w.flux/rho + w.fixed*d*(w.value - difference(s, k, i))/(w.resistance*rho*d + at));
}

/* Eq. (4): the gradient by least squares, solved by elimination; kept within the differences around. */
static double find_moved(const scene *s, int k, int i)
{
    const oracle *o = &s->g.o;
    double m[3][4] = {{0}}, low = 0, high = 0, sum = 0;
    EACH_NEIGHBOUR(o, s->in, i, j, x, r) {
        const double f = o->volume*o->g_scale*oracle_f(o, r), c = difference(s, k, j) - difference(s, k, i);
        if (f > 0) low = fmin(low, c), high = fmax(high, c);
        for (int a = 0; a < 3; a++) {
            for (int b = 0; b < 3; b++) m[a][b] += f*x[a]*x[b];
            m[a][3] -= f*c*x[a];
        }
    }
    const int n = o->dimension;
    for (int p = 0; p < n; p++)
        for (int a = p + 1; a < n; a++) {
            const double share = m[a][p]/m[p][p];
            for (int b = p; b < 4; b++) m[a][b] -= share*m[p][b];
        }
    for (int p = n - 1; p >= 0; p--) {
        for (int b = p + 1; b < n; b++) m[p][3] -= m[p][b]*m[b][3];
        m[p][3] /= m[p][p];
        sum += m[p][3]*s->in[i][ACC + p]*pow(s->g.view.scalar.way, 2);
    }
    return fmax(low, fmin(high, sum));
}

static void launch(scene *s, tobi_kernel k, double *totals)
{
    tobi_launch(&s->g.exec, k, &s->g.view, 0, s->g.p.count, totals);
}

static void kernels_follow_the_equations(void **state)
{
    (void)state;
    for (int c = 0; c < CASES; c++) {
        scene s;
        double worst[4] = {0}, scale[4] = {0}, t[TOBI_TOTALS], sum[4] = {0};
        open_scene(&s, &cases[c]);
        const sph_kernels *k = sph_kernels_for(s.g.exec.isa, cases[c].shape);
        launch(&s, k->sph_scalar_look, NULL);
        launch(&s, k->sph_scalar_spread, t);
        for (int i = 0; i < s.g.p.count; i++)
            for (int n = 0; n < 4; n++) {
                const double e = n < 2 ? s.g.view.scalar.dt*find_rate(&s, n, i) : find_moved(&s, n - 2, i);
                scale[n] = fmax(scale[n], fabs(e));
                worst[n] = fmax(worst[n], fabs((&s.change[i].x)[n] - e));
                if (n >= 2) sum[n - 2 + (e < 0 ? 2 : 0)] += s.g.o.volume*density(&s, i)*fabs(e);
            }
        for (int n = 0; n < 4; n++)
            if (!(scale[n] > 0 && worst[n] <= 2e-5*scale[n]))
                fail_msg("case %d, number %d: off by %g of %g", c, n, worst[n], scale[n]);
        for (int n = 0; n < 4; n++) assert_true(fabs(t[n] - sum[n]) <= 1e-5*sum[n] && sum[n] > 0);
        close_scene(&s);
    }
}

static void walls_follow_the_equation(void **state)
{
    (void)state;
    for (int c = 0; c < CASES; c++) {
        scene s;
        double worst = 0, scale = 0;
        open_scene(&s, &cases[c]);
        const sph_view *v = &s.g.view;
        launch(&s, sph_kernels_for(s.g.exec.isa, cases[c].shape)->sph_scalar_look, NULL);
        for (int i = 0; i < s.g.p.count; i++)
            for (int p = 0; p < v->plane_count; p++)
                for (int k = 0; k < 2; k++) {
                    const tobi_scalar_wall w = make_wall(p, k);
                    const float away = sph_plane_distance(v, p, i),
                                at = away > 0.25f*v->spacing ? away : 0.25f*v->spacing,
                                d = v->scalar.diffusivity[k] + v->scalar.per_eddy[k]*s.now[i].z;
                    const double e = find_wall_rate(&s, k, p, i),
                                 made = away < v->h ? sph_scalar_wall_rate(v, &w, d,
                                            sph_plane_value(v, v->table->sigma, at), at, (&s.now[i].x)[k],
                                            s.now[i].w) : 0;
                    scale = fmax(scale, fabs(e));
                    worst = fmax(worst, fabs(made - e));
                }
        if (!(worst <= 2e-5*scale && (scale > 0 || v->plane_count == 0)))
            fail_msg("case %d: off by %g of %g", c, worst, scale);
        close_scene(&s);
    }
}

/* Without walls neither diffusion nor the shift makes any. */
static void amounts_stay(void **state)
{
    scene s;
    double t[TOBI_TOTALS], before[2] = {0}, after[2] = {0}, moved[2] = {0};
    (void)state;
    open_scene(&s, &cases[3]);
    const sph_kernels *k = sph_kernels_for(s.g.exec.isa, cases[3].shape);
    for (int i = 0; i < s.g.p.count; i++)
        for (int n = 0; n < 2; n++) before[n] += density(&s, i)*difference(&s, n, i);
    launch(&s, k->sph_scalar_look, NULL);
    launch(&s, k->sph_scalar_spread, t);
    for (int n = 0; n < 2; n++) {
        s.g.view.scalar.gain[n] = (float)fmin(t[2 + n]/t[n], 1);
        s.g.view.scalar.loss[n] = (float)fmin(t[n]/t[2 + n], 1);
    }
    launch(&s, k->sph_scalar_take, NULL);
    for (int i = 0; i < s.g.p.count; i++)
        for (int n = 0; n < 2; n++) {
            after[n] += density(&s, i)*difference(&s, n, i);
            moved[n] += density(&s, i)*fabs((&s.change[i].x)[n]);
        }
    for (int n = 0; n < 2; n++)
        if (!(fabs(after[n] - before[n]) <= 1e-6*moved[n] && moved[n] > 0))
            fail_msg("scalar %d: %g became %g, while %g went over", n, before[n], after[n], moved[n]);
    close_scene(&s);
}

static void viscosity_falls_as_it_should(void **state)
{
    scene s;
    (void)state;
    open_scene(&s, &cases[0]);
    s.g.view.scalar.thinning[0] = 0.3f;
    s.g.view.scalar.thinning[1] = -20;
    for (int i = 0; i < s.g.p.count; i++) {
        const double expected = exp(-0.3*difference(&s, 0, i) + 20*difference(&s, 1, i));
        assert_true(fabs(sph_thinner(&s.g.view, i)/expected - 1) < 1e-5);
    }
    close_scene(&s);
}

static uint64_t run_all(const rig_case *c, const sph_kernels *k)
{
    scene s;
    uint64_t hash = 1469598103934665603u;
    open_scene(&s, c);
    launch(&s, k->sph_scalar_look, NULL);
    launch(&s, k->sph_scalar_spread, NULL);
    launch(&s, k->sph_scalar_take, NULL);
    for (size_t b = 0; b < (size_t)s.g.p.count*sizeof *s.own; b++)
        hash = (hash ^ ((const unsigned char *)s.own)[b])*1099511628211u;
    close_scene(&s);
    return hash;
}

static void instruction_sets_give_the_same_bits(void **state)
{
    (void)state;
    tobi_exec x;
    assert_int_equal(tobi_exec_init(&x, 1, NULL), TOBI_OK);
    for (int c = 0; c < CASES; c++)
        for (int isa = 2; isa < x.isa; isa++)
            assert_true(run_all(&cases[c], sph_kernels_for(isa, cases[c].shape)) ==
                        run_all(&cases[c], sph_kernels_for(x.isa, cases[c].shape)));
    tobi_exec_free(&x);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kernels_follow_the_equations),
        cmocka_unit_test(walls_follow_the_equation),
        cmocka_unit_test(amounts_stay),
        cmocka_unit_test(viscosity_falls_as_it_should),
        cmocka_unit_test(instruction_sets_give_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
