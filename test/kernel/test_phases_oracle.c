/* Kernels of several fluids (phases.k.h) against their equations in double over all pairs, in the order of a
   step: each sees what the kernel before it made. Then the same bits on every instruction set. */
#pragma GCC diagnostic ignored "-Wunused-function"     /* the rig has the oracles of all kernels */
#include "sph/phases.k.h"
#include "kernel/sph_rig.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <cmocka.h>

static const rig_case cases[] = {
    {3, TOBI_SHAPE_WENDLAND, 2.5, {0, 0, 0}, 0, 2, 0.2, 0, 0},
    {2, TOBI_SHAPE_CUBIC,    3.0, {1, 0, 0}, 0, 2, 0.2, 0, 0},
    {2, TOBI_SHAPE_QUINTIC,  2.6, {0, 0, 0}, 1, 2, 0.2, 5, 0},
};
enum { CASES = sizeof cases/sizeof *cases };

#define SIGMA 0.05

/* What one kernel makes of the fields: four numbers per particle. */
typedef double four[4];
typedef struct scene { rig g; row *in; tobi_float4 *phase, *interface; } scene;
typedef void (*oracle_fn)(const scene *s, int i, four out);

static const oracle *of(const scene *s) { return &s->g.o; }
static double mu_of(const scene *s, int i) { return of(s)->nu[of(s)->fluid[i]]*of(s)->rho0[of(s)->fluid[i]]; }
static int differ(const scene *s, int i, int j) { return of(s)->fluid[i] != of(s)->fluid[j]; }
static double sign(const scene *s, int i, int j) { return differ(s, i, j) ? -1 : 1; }

static void set(const scene *s, int i, four out)
{
    const int f = of(s)->fluid[i];
    out[0] = of(s)->rho0[f];
    out[1] = mu_of(s, i);
    out[2] = of(s)->h;
    out[3] = f;
}

/* Eq. (41). */
static void viscosity(const scene *s, int i, four out)
{
    const oracle *o = of(s);
    out[0] = out[1] = out[2] = out[3] = 0;
    const double own = mu_of(s, i), scale = 2*o->volume*o->g_scale*o->dt/o->rho0[o->fluid[i]];
    EACH_NEIGHBOUR(o, s->in, i, j, x, r) {
        const double mean = 2*own*mu_of(s, j)/(own + mu_of(s, j)), k = scale*oracle_f(o, r);
        double u[3], along = 0;
        for (int c = 0; c < 3; c++) {
            u[c] = s->in[j][VEL + c] - s->in[i][VEL + c];
            along += u[c]*x[c]/(r*r);
        }
        for (int c = 0; c < 3; c++) out[c] += k*((o->dimension + 2)*mean*along*x[c] - own*u[c]);
    }
}

/* Eq. (42); the distance is found by halving in the kernel's own table. */
static void depth(const scene *s, int i, four out)
{
    const oracle *o = of(s);
    double all = oracle_w(o, 0), other = 0, low = 0, high = TOBI_PLANE_SAMPLES;
    out[0] = out[1] = out[2] = 0;
    EACH_NEIGHBOUR(o, s->in, i, j, x, r) {
        all += oracle_w(o, r);
        if (!differ(s, i, j)) continue;
        other += oracle_w(o, r);
        for (int c = 0; c < 3; c++) out[c] -= o->volume*o->g_scale*oracle_f(o, r)*x[c];
    }
    const float *lambda = s->g.c.plane.lambda;
    for (int k = 0; k < 60; k++) {
        const double at = 0.5*(low + high);
        const int n = (int)at;
        if (lambda[n] + (at - n)*(lambda[n + 1] - lambda[n]) > other/all) low = at;
        else high = at;
    }
    out[3] = other > 0 ? fmax(low*o->h/TOBI_PLANE_SAMPLES, SPH_PHASE_LEAST*o->d) : o->h;
}

/* The normal before it is levelled at walls; only its direction is compared away from them. */
static void normal(const scene *s, int i, four out)
{
    const oracle *o = of(s);
    double n[3], size = 0;
    for (int c = 0; c < 3; c++) n[c] = oracle_w(o, 0)*s->in[i][BAND]*s->in[i][ACC + c];
    EACH_NEIGHBOUR(o, s->in, i, j, x, r) {
        for (int c = 0; c < 3; c++) n[c] += sign(s, i, j)*oracle_w(o, r)*s->in[j][BAND]*s->in[j][ACC + c];
        (void)x;
    }
    for (int c = 0; c < 3; c++) size += n[c]*n[c];
    for (int c = 0; c < 3; c++) n[c] = size > 0 ? n[c]/sqrt(size) : 0;
    for (int k = 0; k < o->plane_count && size > 0; k++) {
        const int axis = o->plane[k].axis;
        const double along = 1 - n[axis]*n[axis];
        if (wall_distance(o, s->in, i, k) >= 1.5*o->d || along <= 1e-6) continue;
        n[axis] = 0;
        for (int c = 0; c < 3; c++) n[c] /= sqrt(along);
    }
    for (int c = 0; c < 3; c++) out[c] = n[c];
    out[3] = s->in[i][BAND];
}

/* Eq. (34), (44). */
static void curvature(const scene *s, int i, four out)
{
    const oracle *o = of(s);
    double turn = 0, area = 0, weight = 0, deep = 0, kappa = 0;
    EACH_NEIGHBOUR(o, s->in, i, j, x, r) {
        const float *a = &s->interface[i].x, *b = &s->interface[j].x;
        double own = 0, other = 0;
        const double w = s->interface[j].w*oracle_f(o, r);
        for (int c = 0; c < 3; c++) {
            own += a[c]*x[c];
            other += sign(s, i, j)*b[c]*x[c];
        }
        turn += w*(own - other);
        area += w*(r*r - pow((own + other)/2, 2));
        deep += w*(own + other)/2;
        weight += w;
    }
    if (area > 0 && s->interface[i].w > 0) {
        kappa = fmax(fmin(turn/area, 0.7/o->d), -0.7/o->d);
        kappa *= (o->dimension - 1)/(1 + kappa*(s->phase[i].z + deep/weight/2));
    }
    out[0] = kappa;
    out[1] = out[2] = out[3] = 0;
}

/* Eq. (45). */
static void even(const scene *s, int i, four out)
{
    const oracle *o = of(s);
    double weight = oracle_w(o, 0)*s->interface[i].w, sum = weight*s->in[i][PAYLOAD];
    EACH_NEIGHBOUR(o, s->in, i, j, x, r) {
        const double w = oracle_w(o, r)*s->interface[j].w;
        weight += w;
        sum += w*sign(s, i, j)*s->in[j][PAYLOAD];
        (void)x;
    }
    out[0] = weight > 0 ? sum/weight : 0;
    out[1] = out[2] = out[3] = 0;
}

/* Eq. (46). */
static void tension(const scene *s, int i, four out)
{
    const oracle *o = of(s);
    for (int c = 0; c < 3; c++) out[c] = s->in[i][VEL + c];
    out[3] = 0;
    EACH_NEIGHBOUR(o, s->in, i, j, x, r) {
        const double kappa = 0.5*((double)s->interface[i].w - (double)s->interface[j].w);
        const double k = differ(s, i, j) ? SIGMA*kappa*o->dt/o->rho0[o->fluid[i]] : 0;
        for (int c = 0; c < 3; c++) out[c] += k*o->volume*o->g_scale*oracle_f(o, r)*x[c];
    }
}

static void compare(const scene *s, oracle_fn expected, const tobi_float4 *made, int numbers,
                    const char *what)
{
    double scale[4] = {0}, worst[4] = {0};
    int where[4] = {0};
    for (int i = 0; i < of(s)->count; i++) {
        four e;
        expected(s, i, e);
        for (int c = 0; c < numbers; c++) {
            const double off = fabs((&made[i].x)[c] - e[c]);
            scale[c] = fmax(scale[c], fabs(e[c]));
            if (!(off <= worst[c])) worst[c] = off, where[c] = i;
        }
    }
    for (int c = 1; c < 3 && numbers >= 3; c++) scale[0] = scale[c] = fmax(scale[0], scale[c]);
    /* where plane shares fall off, their table tells distances to some 1e-3 of the support */
    for (int c = 0; c < numbers; c++)
        if (!(worst[c] <= 2e-4*scale[c]))
            fail_msg("%s, number %d of particle %d: off by %.3g of %.3g", what, c, where[c], worst[c],
                     scale[c]);
}

static void launch(scene *s, tobi_kernel k)
{
    tobi_launch(&s->g.exec, k, &s->g.view, 0, s->g.p.count, NULL);
}

static void open_scene(scene *s, const rig_case *c)
{
    tobi_error err;
    if (rig_create(&s->g, c, 2, &err)) fail_msg("%s", err.text);
    sph_view *v = &s->g.view;
    s->phase = v->phase = sph_fields_of(&s->g.p)->phase;
    s->interface = v->interface = sph_fields_of(&s->g.p)->interface;
    v->fluid_count = 2;
    v->interface_tension[0][1] = v->interface_tension[1][0] = SIGMA;
    s->in = calloc((size_t)s->g.p.count, sizeof(row));
    rig_get(&s->g, s->in);
}

static void close_scene(scene *s)
{
    free(s->in);
    rig_free(&s->g);
}

/* Payloads of the records as rows of four. */
static tobi_float4 *payloads(const scene *s)
{
    tobi_float4 *p = calloc((size_t)s->g.p.count, sizeof *p);
    for (int64_t i = 0; i < s->g.p.count; i++) p[i].x = s->g.cells.record[i].w;
    return p;
}

static void kernels_follow_the_equations(void **state)
{
    (void)state;
    for (int c = 0; c < CASES; c++) {
        scene s;
        open_scene(&s, &cases[c]);
        const sph_kernels *k = sph_kernels_for(s.g.exec.isa, cases[c].shape);
        const sph_fields *f = sph_fields_of(&s.g.p);
        launch(&s, k->sph_phase_set);
        compare(&s, set, s.phase, 4, "constants");
        launch(&s, k->sph_phase_viscosity);
        compare(&s, viscosity, s.interface, 3, "viscosity");
        launch(&s, k->sph_phase_kick);
        for (int64_t i = 0; i < s.g.p.count; i++)
            assert_true(s.g.p.velocity[i].x == (float)s.in[i][VEL] + s.interface[i].x);
        launch(&s, k->sph_phase_depth);
        compare(&s, depth, f->accel, 4, "distance");
        launch(&s, k->sph_phase_place);
        rig_get(&s.g, s.in);
        launch(&s, k->sph_phase_normal);
        compare(&s, normal, s.interface, 4, "normal");
        launch(&s, k->sph_phase_curvature);
        tobi_float4 *p = payloads(&s);
        compare(&s, curvature, p, 1, "curvature");
        free(p);
        rig_get(&s.g, s.in);
        launch(&s, k->sph_phase_even);
        compare(&s, even, f->accel, 1, "mean curvature");
        launch(&s, k->sph_phase_bend);
        for (int64_t i = 0; i < s.g.p.count; i++) assert_true(s.interface[i].w == f->accel[i].x);
        rig_get(&s.g, s.in);
        launch(&s, k->sph_phase_tension);
        compare(&s, tension, s.g.p.velocity, 3, "tension");
        close_scene(&s);
    }
}

/* All kernels in their order; the bits of what they leave. */
static uint64_t run_all(const rig_case *c, const sph_kernels *k)
{
    scene s;
    uint64_t hash = 1469598103934665603u;
    open_scene(&s, c);
    const tobi_kernel all[] = { k->sph_phase_set, k->sph_phase_viscosity, k->sph_phase_kick,
                                k->sph_phase_depth, k->sph_phase_place, k->sph_phase_normal,
                                k->sph_phase_curvature, k->sph_phase_even, k->sph_phase_bend,
                                k->sph_phase_tension };
    for (size_t n = 0; n < sizeof all/sizeof *all; n++) launch(&s, all[n]);
    const void *const left[] = { s.phase, s.interface, s.g.p.velocity };
    for (int n = 0; n < 3; n++)
        for (size_t b = 0; b < (size_t)s.g.p.count*sizeof(tobi_float4); b++)
            hash = (hash ^ ((const unsigned char *)left[n])[b])*1099511628211u;
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
        cmocka_unit_test(instruction_sets_give_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
