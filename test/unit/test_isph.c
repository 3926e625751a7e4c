/* The passes of isph against sums over all pairs and explicit images, exactness for linear fields, walls and
   bodies that must be the same thing, and how a solve that fails is told. */
#include "sph/isph_passes.h"
#include "tobiuo/tobiuo.h"
#include "unit/poisson_rig.h"
#include "calls.h"
#include <stdio.h>
#include <cmocka.h>

static poisson pool;
static isph_view view;

enum { FLOATS = 6, DOUBLES = 4 };

/* A jittered pool, closed or with a surface, and a view of it with memory of its own. */
static void open_pool(int dimension, int closed)
{
    const int n[3] = {12, dimension == 2 ? 14 : 9, 10};
    OK(poisson_fill(&pool, dimension, n, closed, 2));
    const int64_t count = pool.p.count;
    tobi_smoothing_constants c;
    tobi_smoothing_init(&c, TOBI_SHAPE_WENDLAND, dimension, pool.d, 2.5);
    view = (isph_view){.count = count, .dimension = dimension, .shape = TOBI_SHAPE_WENDLAND, .open = !closed,
                       .spacing = pool.d, .h = pool.h, .volume = c.volume, .weight = c.weight,
                       .slope = c.slope, .full = 2*c.rate, .density = 1000, .dt = 1e-3, .motion_dt = 2e-3,
                       .volume_gain = 0.1, .shifting = 0.5};
    memcpy(view.size, pool.box.size, sizeof view.size);
    view.gravity[0] = 1;
    view.gravity[dimension - 1] = -9.81;
    view.position = pool.p.position;
    view.velocity = pool.p.velocity;
    view.list = pool.cells.list;
    view.list_start = pool.cells.list_start;
    view.list_groups = pool.cells.list_groups;
    float **real[FLOATS] = {&view.pressure, &view.trace, &view.gate, &view.scale, &view.filled,
                            &view.behind};
    for (int k = 0; k < FLOATS; k++) *real[k] = calloc((size_t)count, sizeof(float));
    view.entry = calloc((size_t)pool.cells.list_used, sizeof(float));
    double **wide[DOUBLES] = {&view.excess, &view.inverse_diagonal, &view.source, &view.out};
    for (int k = 0; k < DOUBLES; k++) *wide[k] = calloc((size_t)count, sizeof(double));
    view.in = calloc((size_t)count, sizeof(double));
    view.inverse = calloc((size_t)count, sizeof *view.inverse);
    view.lack = calloc((size_t)count, sizeof *view.lack);
    view.change = calloc((size_t)count, sizeof *view.change);
    for (int64_t i = 0; i < count; i++) {
        double *in = (double *)view.in;
        in[i] = poisson_random();
        view.pressure[i] = (float)(1000*poisson_random());
        for (int a = 0; a < dimension; a++) (&view.velocity[i].x)[a] = (float)poisson_random();
    }
}

static void close_pool(void)
{
    void *own[] = {view.pressure, view.trace, view.gate, view.scale, view.filled, view.behind, view.entry,
                   view.excess, view.inverse_diagonal, view.source, view.out, (void *)view.in,
                   view.inverse, view.lack, view.change};
    for (size_t k = 0; k < sizeof own/sizeof *own; k++) free(own[k]);
    poisson_drop(&pool);
}

static void run(tobi_kernel kernel, double *totals)
{
    tobi_launch(&pool.exec, kernel, &view, 0, view.count, totals);
}

/* Calls `visit` with every image of every particle that i can see, in 3^dim boxes; code of its own. */
typedef struct image { int64_t j; double x[3], r, at[3]; int flip[3]; int self; } image;
typedef void (*visit_fn)(int64_t i, const image *m, void *user);

static void visit_images(int64_t i, visit_fn visit, void *user)
{
    const int dim = view.dimension;
    for (int64_t j = 0; j < view.count; j++)
        for (int code = 0; code < (dim == 3 ? 27 : 9); code++) {
            image m = {.j = j, .self = i == j && code == 0};
            double r2 = 0;
            for (int a = 0, c = code; a < 3; a++, c /= 3) {
                const double y = (&view.position[j].x)[a];
                m.flip[a] = a < dim && c%3 != 0;
                m.at[a] = !m.flip[a] ? y : c%3 == 1 ? -y : 2*view.size[a] - y;
                m.x[a] = (&view.position[i].x)[a] - m.at[a];
                r2 += m.x[a]*m.x[a];
            }
            m.r = sqrt(r2);
            if (!m.self && m.r < view.h) visit(i, &m, user);
        }
}

static double gradient_scale(double r)
{
    const double t = 1 - r/view.h;
    return view.slope*t*t*t;
}

typedef struct sums { double trace, filled, lack[3], product, divergence, source, row, gradient[3]; } sums;

static double hydrostatic(const image *m)
{
    double sum = 0;
    for (int a = 0; a < view.dimension; a++)
        sum += view.density*view.gravity[a]*(m->at[a] - (&view.position[m->j].x)[a]);
    return sum;
}

static void add_geometry(int64_t i, const image *m, void *user)
{
    sums *s = user;
    const double q = m->r/view.h, f = gradient_scale(m->r);
    (void)i;
    s->trace += f*m->r*m->r;
    s->filled += view.weight*pow(1 - q, 4)*(1 + 4*q);
    for (int a = 0; a < 3; a++) s->lack[a] -= f*m->x[a];
}

static void add_row(int64_t i, const image *m, void *user)
{
    sums *s = user;
    const isph_tensor *b = &view.inverse[i];
    const double f = gradient_scale(m->r), a = f*((double)view.scale[i] + view.scale[m->j]), *x = m->x;
    const double g[3] = {b->xx*x[0] + b->xy*x[1] + b->zx*x[2], b->xy*x[0] + b->yy*x[1] + b->yz*x[2],
                         b->zx*x[0] + b->yz*x[1] + b->zz*x[2]};
    s->product += a*(view.in[i] - view.in[m->j]);
    s->source += a*hydrostatic(m);
    s->row += a;
    for (int k = 0; k < view.dimension; k++) {
        double u = (&view.velocity[m->j].x)[k], kick = view.dt*view.gravity[k];
        if (m->flip[k]) u = -(u - kick) + kick;
        s->divergence -= (u - (&view.velocity[i].x)[k])*f*g[k];
        s->gradient[k] -= (view.pressure[m->j] + hydrostatic(m) - view.pressure[i])*f*g[k];
    }
}

static void passes_are_sums_over_all_pairs(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        open_pool(2 + k%2, k/2);
        double t[TOBI_TOTALS], worst = 0;
        run(isph_measure_geometry, NULL);
        run(isph_assemble_rows, t);
        run(isph_multiply, NULL);
        for (int64_t i = 0; i < view.count; i += 7) {
            sums s = {.filled = view.weight};
            visit_images(i, add_geometry, &s);
            worst = fmax(worst, fabs(s.trace - view.trace[i]) + fabs(s.filled - view.filled[i]));
            const tobi_float4 c = view.lack[i];
            worst = fmax(worst, (fabs(s.lack[0] - c.x) + fabs(s.lack[1] - c.y))*view.h);
            visit_images(i, add_row, &s);
            const double loss = 1 - s.trace/view.dimension, bulk = loss < 0.05 || !view.open,
                         e = fmax(s.filled - 1, bulk ? -0.05 : 0);
            const double source = s.source - view.density/view.dt*s.divergence +
                                  view.density*0.1*e/(view.dt*view.motion_dt);
            const double gate = view.open ? fmin(fmax((loss - 0.05)/0.1, 0), 1) : 0;
            const double excess = 2*gate*fmax(view.full - s.row, 0.5*loss*view.full);
            worst = fmax(worst, fabs(source - view.source[i])/(view.density/view.dt/view.dt));
            worst = fmax(worst, fabs(s.product + excess*view.in[i] - view.out[i])/view.full);
        }
        if (worst > 2e-5) fail_msg("%d-D, closed %d: worst deviation %g", view.dimension, k/2, worst);
        assert_true((t[0] > 0) == view.open);
        close_pool();
    }
}

static void the_matrix_is_symmetric(void **state)
{
    (void)state;
    open_pool(3, 0);
    double t[TOBI_TOTALS], forth = 0, back = 0;
    double *x = calloc((size_t)view.count, sizeof *x);
    const double *y = view.in;
    run(isph_measure_geometry, NULL);
    run(isph_assemble_rows, t);
    for (int64_t i = 0; i < view.count; i++) x[i] = poisson_random();
    run(isph_multiply, NULL);
    for (int64_t i = 0; i < view.count; i++) forth += x[i]*view.out[i];
    view.in = x;
    run(isph_multiply, NULL);
    for (int64_t i = 0; i < view.count; i++) back += y[i]*view.out[i];
    view.in = y;
    assert_true(fabs(forth - back) < 1e-12*view.full*(double)view.count);
    free(x);
    close_pool();
}

/* Water at rest under its own pressure feels no force at all, at walls and in corners as well. */
static void linear_pressures_are_exact(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        open_pool(2 + k, 1);
        run(isph_measure_geometry, NULL);
        for (int64_t i = 0; i < view.count; i++) {
            const double *x = &view.position[i].x;
            view.velocity[i] = (tobi_float4){ 0 };
            view.pressure[i] = 0;
            for (int a = 0; a <= 1 + k; a++)
                view.pressure[i] += (float)(view.density*view.gravity[a]*x[a]);
        }
        double t[TOBI_TOTALS];
        run(isph_add_gravity, NULL);
        run(isph_kick, t);
        for (int64_t i = 0; i < view.count; i++)
            for (int a = 0; a <= 1 + k; a++) assert_true(fabsf((&view.velocity[i].x)[a]) < 1e-4*view.dt*9.81);
        close_pool();
    }
}

/* Divergence of a linear flow that no wall feels, away from walls. */
static void linear_flows_are_exact(void **state)
{
    (void)state;
    open_pool(2, 1);
    view.gravity[0] = view.gravity[1] = 0;
    run(isph_measure_geometry, NULL);
    double sum = 0;
    int64_t inside = 0;
    for (int64_t i = 0; i < view.count; i++)
        view.velocity[i] = (tobi_float4){ (float)(2*view.position[i].x + 5*view.position[i].y),
                                          (float)(view.position[i].y - 3*view.position[i].x), 0, 0 };
    for (int64_t i = 0; i < view.count; i++) {
        double t[TOBI_TOTALS] = { 0 };
        const double x = view.position[i].x, y = view.position[i].y, r = 2*view.h;
        if (fmin(fmin(x, y), fmin(view.size[0] - x, view.size[1] - y)) < r/2) continue;
        isph_measure_divergence.run(&view, i, i + 1, t);
        sum = fmax(sum, fabs(t[0] - 3));
        inside++;
    }
    assert_true(inside > 20);
    assert_true(sum < 1e-4);
    close_pool();
}

static tobi_world_def make_def(double width)
{
    tobi_world_def w = tobi_default_world_def();
    w.method = "isph";
    w.dimension = 2;
    w.gravity[1] = -9.81;
    w.gravity[2] = 0;
    w.domain_max[0] = width;
    w.domain_max[1] = 0.3;
    w.spacing = 0.01;
    w.end_time = 1;
    return w;
}

static void add_water(tobi_world *world)
{
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    fill.box_max[0] = 0.3;
    fill.box_max[1] = 0.15;
    OK(tobi_world_add_fluid(world, &fluid, &fill, 1, &err));
}

static tobi_status add_box(tobi_world *world, double left, double right, int dynamics, tobi_error *err)
{
    tobi_body_def body = tobi_default_body_def();
    body.name = "box";
    body.box_min[0] = left;
    body.box_max[0] = right;
    body.box_max[1] = 0.3;
    body.dynamics = dynamics;
    return tobi_world_add_body(world, &body, err);
}

/* A wave between two sides, and the same with a box in the place of the second side. */
static void a_body_mirrors_as_a_side_does(void **state)
{
    (void)state;
    double x[2][3*1000];
    for (int k = 0; k < 2; k++) {
        tobi_world *world;
        tobi_world_def w = make_def(k ? 0.6 : 0.3);
        w.gravity[0] = 2;
        w.time_step = 1e-3;
        OK(tobi_world_create(&w, NULL, &world, &err));
        add_water(world);
        if (k) OK(add_box(world, 0.3, 0.5, TOBI_PRESCRIBED, &err));
        for (int step = 0; step < 20; step++) OK(tobi_world_step(world, 0, NULL, &err));
        OK(tobi_world_read(world, TOBI_FLUID, "position", x[k], 450, &err));
        tobi_world_destroy(world);
    }
    double worst = 0;
    for (int i = 0; i < 3*450; i++) worst = fmax(worst, fabs(x[0][i] - x[1][i]));
    if (worst > 2e-4) fail_msg("particles differ by %g m", worst);     /* a fiftieth of a spacing */
}

static void refusals(void **state)
{
    (void)state;
    tobi_world *world;
    tobi_world_def w = make_def(0.6);
    OK(tobi_world_create(&w, NULL, &world, &err));
    add_water(world);
    OK(add_box(world, 0.4, 0.5, TOBI_FREE, &err));
    REFUSED(tobi_world_start(world, &err), TOBI_UNSUPPORTED, "isph does not move bodies by forces yet");
    tobi_world_destroy(world);
}

/* One iteration does not do: the step says so, with the residual, and uses what it has. */
static void a_failed_solve_is_told(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        tobi_world *world;
        tobi_step_info info;
        double p[450], most = 0;
        tobi_world_def w = make_def(0.3);
        tobi_isph_def m = tobi_default_isph_def();
        m.iterations_max = k ? 200 : 1;
        OK(tobi_world_create(&w, &m, &world, &err));
        add_water(world);
        OK(tobi_world_step(world, 0, &info, &err));
        assert_int_equal(info.divergence_converged, k);
        assert_true(k ? info.pressure_residual <= m.tolerance : info.pressure_residual > m.tolerance);
        assert_true(info.divergence_iterations > 0);
        OK(tobi_world_read(world, TOBI_FLUID, "pressure", p, 450, &err));
        for (int i = 0; i < 450; i++) most = fmax(most, p[i]);
        assert_true(most > 300);
        for (int step = 1; step < 50 && !k; step++) OK(tobi_world_step(world, 0, NULL, &err));
        if (!k)
            REFUSED(tobi_world_step(world, 0, NULL, &err), TOBI_DIVERGED,
                    "the pressure equation did not converge in 51 steps in a row");
        tobi_world_destroy(world);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(passes_are_sums_over_all_pairs), cmocka_unit_test(the_matrix_is_symmetric),
        cmocka_unit_test(linear_pressures_are_exact),     cmocka_unit_test(linear_flows_are_exact),
        cmocka_unit_test(a_body_mirrors_as_a_side_does),  cmocka_unit_test(refusals),
        cmocka_unit_test(a_failed_solve_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
