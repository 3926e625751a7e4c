/* The kernels of isph: in lanes and as scalars (what CUDA compiles) against sums over all pairs and explicit
   images in double, and the same bits on every instruction set. Then what the matrix and the operators
   promise. */
#include "sph/kernels.h"
#include "sph/isph/isph.k.h"
#include "sph/isph/body_pairs.k.h"
#include "core/smoothing.h"
#include "kernel/smoothing_oracle.h"
#include "unit/poisson_rig.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <cmocka.h>

static poisson pool;
static isph_view view;
extern const sph_kernels sph_kernels_scalar[SPH_TABLES];      /* sph_scalar.c */
static const sph_kernels *kernel;
static int shape;
static tobi_smoothing_constants scaled;

/* The arrays of the view that kernels write, or that this test fills. */
#define ARRAYS(X)                                                                                   \
    X(pressure) X(trace) X(gate) X(scale) X(concentration) X(body_share) X(excess) X(inverse_diagonal)    \
    X(source) X(solution) X(out) X(inverse) X(concentration_gradient) X(shift_velocity) X(accel) X(velocity) \
    X(invariant)

/* In cases with a body its face is where the lower side along x was; that is FAR supports further down. */
enum { FAR = 10, GROUPS = 20000 };
static const double FLOW = 0.7, CHANGE = 0.2;      /* m/s, of the face along x, and since the last step */
static int bodies;
static tobi_double3 *shifted;
static int32_t *near_body;
static isph_mirror *mirror;
static isph_brief *brief;
static tobi_boundary_link *links;
static isph_coupling *couplings;
static int64_t groups;               /* of images at the body */
static const double answers[1][6] = {{0.3, -0.2, 0.1, 0.7, -0.4, 0.2}};
#include "kernel/isph_phases_oracle.h"

static void put_body(void)
{
    const double away = FAR*view.h;
    int32_t count = 0;
    brief[0] = (isph_brief){.body = -1};
    for (int64_t i = 0; i < view.count; i++) {
        shifted[i] = pool.p.position[i];
        near_body[i] = -1;
        links[i] = (tobi_boundary_link){.particle = (int32_t)i, .body = 0, .previous = -1};
        for (int a = 0; a < 6; a++) couplings[i].f[a] = poisson_random();
        if (!bodies) continue;
        shifted[i].x += away;
        if (pool.p.position[i].x >= view.h) continue;
        near_body[i] = count;
        links[count].particle = (int32_t)i;
        mirror[count++] = (isph_mirror){.body = 0, .previous = -1, .share = 1, .normal = {1, 0, 0},
                                        .offset = {pool.p.position[i].x, 0, 0},
                                        .velocity = {FLOW, 0.3, 0}, .velocity_change = {CHANGE, 0.1, 0}};
        isph_make_brief(&mirror[count - 1], &brief[count]);
    }
    view.size[0] = pool.box.size[0] + (bodies ? away : 0);
    view.last_link = bodies ? near_body : NULL;
}

/* A jittered pool, closed or with a surface, and a view of it with memory of its own. */
static void open_pool(int dimension, int closed, int smoothing, int body)
{
    const int n[3] = {12, dimension == 2 ? 14 : 9, 10};
    if (poisson_fill(&pool, dimension, n, closed, 2) != TOBI_OK) fail();
    const int64_t count = pool.p.count;
    const tobi_smoothing_constants *c = &scaled;
    shape = smoothing;
    bodies = body;
    tobi_smoothing_init(&scaled, shape, dimension, pool.d, 2.5);
    kernel = sph_kernels_for(pool.exec.isa, shape);
    view = (isph_view){.count = count, .dimension = dimension, .open = !closed, .fades = !closed,
                       .gap_speed = 4, .spacing = pool.d, .h = pool.h, .volume = c->volume,
                       .weight = c->weight, .slope = c->slope, .shape = shape, .full = 2*c->rate,
                       .inverse_h = (float)(1/pool.h), .density = 1000, .dt = 1e-3, .volume_dt = 2e-3,
                       .way = 5e-4, .second_order = 1, .keeps_volume = 1, .shift_damping = 2,
                       .surface_row = 1.2, .surface_force = 1.1, .surface_loss = 0.3,
                       .surface_lack = 0.2,
                       .volume_gain = 0.1, .shifting = 0.5,
                       .keep = 0.9, .mean = 3, .carry = 0.4, .gain = 0.7,
                       .volume_sum = 1, .by_count = 1, .lattice_count = dimension == 3 ? 56 : 20,
                       .xsph = 0.3f, .kinematic = viscosities, .fluid = fluids,
                       .group_count = &groups, .group_room = GROUPS};
    memcpy(view.size, pool.box.size, sizeof view.size);
    memcpy(view.from_fixed, pool.box.from_fixed, sizeof view.from_fixed);
    for (int a = 0; a < dimension; a++)
        for (int k = 0; k < 2; k++)
            view.side[k][a] =
                (int32_t)lround((k*pool.box.size[a] - pool.box.centre[a])*pool.box.to_fixed[a]);
    view.gravity[0] = 1;
    view.gravity[dimension - 1] = -9.81f;
#define X(name) view.name = calloc((size_t)count, sizeof *view.name);
    ARRAYS(X)
#undef X
    view.entry = calloc((size_t)pool.cells.list_used, sizeof(float));
    view.in = calloc((size_t)count, sizeof(double));
    view.mirror = mirror = calloc((size_t)count, sizeof *mirror);
    view.brief = brief = calloc((size_t)count + 1, sizeof *brief);
    view.position = shifted = calloc((size_t)count, sizeof *shifted);
    near_body = calloc((size_t)count, sizeof *near_body);
    view.group = calloc(GROUPS, sizeof *view.group);
    view.first_group = calloc((size_t)count, sizeof *view.first_group);
    view.link = links = calloc((size_t)count, sizeof *links);
    view.coupling = couplings = calloc((size_t)count, sizeof *couplings);
    view.answer = answers;
    view.record = pool.cells.record;
    view.list = pool.cells.list;
    view.list_far = pool.cells.list_far;
    view.list_start = pool.cells.list_start;
    view.list_groups = pool.cells.list_groups;
    put_body();
    mix(&view);
    for (int64_t i = 0; i < count; i++) {
        ((double *)view.in)[i] = poisson_random();
        view.pressure[i] = (float)(1000*poisson_random());
        for (int a = 0; a < dimension; a++) (&view.velocity[i].x)[a] = (float)poisson_random();
    }
}

static void close_pool(void)
{
#define X(name) free(view.name);
    ARRAYS(X)
#undef X
    free(view.entry);
    free((void *)view.in);
    free(mirror);
    free(brief);
    free(shifted);
    free(near_body);
    free(view.group);
    free(view.first_group);
    free(links);
    free(couplings);
    poisson_drop(&pool);
}

static void run(tobi_kernel k, double *totals)
{
    tobi_launch(&pool.exec, k, &view, 0, view.count, totals);
}

/* Every image of every particle that i can see, in 3^dim boxes; code of its own. */
typedef struct image { int64_t j; double x[3], r, displacement[3]; int flip[3]; int self; } image;
typedef struct sums {
    double moment[6], concentration, gradient_c[3], product, divergence, difference, rest, row,
           gradient[3], core[3], normal[3], slope[9], bend[3], low[3], high[3], count, cone, mean[3], all[3],
           plain[3], in_face;
} sums;
static void add_choices(int64_t i, const image *m, const double u[3], double f, int plain, sums *s);

/* As scaled on the lattice. */
static double falloff(double r)
{
    return view.volume*scaled.slope_correction*kernel_f(shape, view.dimension, view.h, r + 1e-30);
}

static double weight(double r)
{
    return view.volume*scaled.weight_correction*kernel_w(shape, view.dimension, view.h, r);
}

/* Velocity of an image: its part across a wall is mirrored, less what gravity gave and its wall took. */
static void image_velocity(const image *m, double u[3])
{
    for (int a = 0; a < 3; a++) {
        const int face = bodies && a == 0 && m->flip[a] == 1;
        const double change = face && view.gravity_dt > 0 ? CHANGE : 0,
                     given = (double)view.gravity_dt*view.gravity[a] - change;
        u[a] = (&view.velocity[m->j].x)[a];
        if (m->flip[a]) u[a] = -(u[a] - given) + given + (face ? 2*FLOW : 0);
    }
}

static void add_pair(int64_t i, const image *m, sums *s)
{
    const isph_tensor *b = &view.inverse[i];
    const double f = falloff(m->r), *x = m->x, a = f*((double)view.scale[i] + view.scale[m->j]);
    const double g[3] = {b->xx*x[0] + b->xy*x[1] + b->zx*x[2], b->xy*x[0] + b->yy*x[1] + b->yz*x[2],
                         b->zx*x[0] + b->yz*x[1] + b->zz*x[2]};
    const int side = m->flip[0] > (bodies ? 1 : 0) || m->flip[1] || m->flip[2],
              image = side || m->flip[0], face = bodies && m->flip[0] == 1;
    const double path = between(i, m->j), density = view.density*(face ? path : relative(m->j));
    double u[3], lift = jump_of(i, m->j);
    for (int k = 0; k < view.dimension; k++) lift += density*view.gravity[k]*m->displacement[k];
    if (face) lift -= density/view.dt*CHANGE*m->displacement[0];
    image_velocity(m, u);
    s->in_face += face;
    s->concentration += weight(m->r);
    add_choices(i, m, u, f, !image, s);
    s->product += a/path*(view.in[i] - view.in[m->j]);
    s->difference += a/path*lift;
    for (int k = 0; k < view.dimension; k++) s->rest += a*view.density*view.gravity[k]*x[k];
    s->row += a;
    for (int k = 0; k < 3; k++) {
        const double jump = u[k] - (&view.velocity[i].x)[k], p = view.pressure[m->j] + lift,
                     own = view.pressure[i];
        s->moment[k] += f*x[k]*x[k];
        s->moment[3 + k] += f*x[k]*x[(k + 1)%3];
        s->gradient_c[k] -= f*x[k];
        s->divergence -= jump*f*g[k];
        s->gradient[k] -= (p - own)/path*f*x[k];
        if (m->r < 0.8*view.spacing) s->core[k] += 0.25*(0.8*view.spacing - m->r)*x[k]/m->r;
        s->bend[k] += jump*f;
        s->low[k] = fmin(s->low[k], jump);
        s->high[k] = fmax(s->high[k], jump);
        for (int c = 0; c < 3; c++) s->slope[3*k + c] -= jump*f*x[c];
        const tobi_float4 *of = &view.concentration_gradient[m->j];
        if (!image) s->normal[k] += (double)of->w*(&of->x)[k];
    }
}

/* 0 if no image of j can be within the support of i: along one axis all are too far. */
static int may_reach(int64_t i, int64_t j)
{
    for (int a = 0; a < view.dimension; a++) {
        const double x = (&pool.p.position[i].x)[a], y = (&pool.p.position[j].x)[a];
        const double below = fabs(x + y), above = fabs(x + y - 2*pool.box.size[a]);
        if (fmin(fabs(x - y), fmin(below, above)) > view.h) return 0;
    }
    return 1;
}

static sums sum_pairs(int64_t i)
{
    const int dim = view.dimension;
    sums s = {.concentration = weight(0)};
    for (int64_t j = 0; j < view.count; j++) {
        if (!may_reach(i, j)) continue;
        for (int code = 0; code < (dim == 3 ? 27 : 9); code++) {
            image m = {.j = j, .self = i == j && code == 0};
            double r2 = 0;
            for (int a = 0, c = code; a < 3; a++, c /= 3) {
                const double y = (&pool.p.position[j].x)[a];
                m.flip[a] = a < dim ? c%3 : 0;
                const double at = !m.flip[a] ? y : m.flip[a] == 1 ? -y : 2*pool.box.size[a] - y;
                m.x[a] = (&pool.p.position[i].x)[a] - at;
                m.displacement[a] = at - y;
                r2 += m.x[a]*m.x[a];
            }
            m.r = sqrt(r2);
            if (!m.self && m.r < view.h) add_pair(i, &m, &s);
        }
    }
    return s;
}

/* The rows i of all arrays that a kernel may write: what an oracle answers, and what it is measured by. */
typedef struct check { const char *name; double worst; } check;
static void compare(check *c, double made, double expected, double scale)
{
    const double e = fabs(made - expected)/scale;
    if (!(e <= c->worst)) c->worst = e;
}

static double loss_of(const sums *s)
{
    return 1 - (s->moment[0] + s->moment[1] + s->moment[2])/view.dimension;
}
static double clip(double x) { return fmin(fmax(x, 0), 1); }

#include "kernel/isph_body_oracle.h"
#include "kernel/isph_time_oracle.h"

static double gate_of(int64_t i, const sums *s)
{
    return view.open ? clip((loss_of(s) - 0.1)/0.1)*(1 - gap_of(i, s)) : clip((loss_of(s) - 0.6)/0.2);
}

static void oracle_isph_geometry(check *c, int64_t i, const sums *s)
{
    const double trace = view.dimension*(1 - loss_of(s)), gate = gate_of(i, s);
    const isph_tensor b = view.inverse[i];
    const double made[6] = {b.xx, b.yy, b.zz, b.xy, b.yz, b.zx}, *grad = s->gradient_c;
    double m[6], missing = sqrt(grad[0]*grad[0] + grad[1]*grad[1] + grad[2]*grad[2]);
    compare(c, view.trace[i], trace, 1);
    compare(c, view.gate[i], gate, 10);
    compare(c, view.scale[i], fmin(1.3, view.dimension/fmax(trace, 0.95*view.dimension)), 1);
    compare(c, view.concentration[i],
            s->concentration + gap_of(i, s)*fmax(1 - s->concentration, 0), 1);
    for (int a = 0; a < 3; a++) compare(c, (&view.concentration_gradient[i].x)[a], grad[a], 1/view.h);
    compare(c, view.concentration_gradient[i].w*missing, fmax(0, view.dimension - trace), 1);
    /* B M = 1, or M where the determinant is small */
    for (int k = 0; k < 6; k++) m[k] = k == 2 && view.dimension == 2 ? 1 : s->moment[k];
    const double full[3][3] = {{m[0], m[3], m[5]}, {m[3], m[1], m[4]}, {m[5], m[4], m[2]}};
    const double inverse[3][3] = {{made[0], made[3], made[5]}, {made[3], made[1], made[4]},
                                  {made[5], made[4], made[2]}};
    const double one = clip((0.2 - determinant_of(full))/0.1);
    for (int a = 0; a < 3; a++)
        for (int k = 0; k < 3; k++) {
            double sum = 0;
            for (int e = 0; e < 3; e++) sum += inverse[a][e]*full[e][k];
            compare(c, sum, (1 - one)*(a == k) + one*full[a][k], 10);
        }
    check_invariant(c, i, s);
}

static tobi_float4 before;           /* velocity of the row at hand, before the kernel */

static void oracle_isph_gravity(check *c, int64_t i, const sums *s)
{
    (void)s;
    for (int a = 0; a < 3; a++)
        compare(c, (&view.velocity[i].x)[a],
                (&before.x)[a] + (a < view.dimension ? view.dt*view.gravity[a] : 0), 1);
    compare(c, view.record[i].w, view.scale[i], 1);
}

static double excess_of(int64_t i, const sums *s)
{
    return 2*view.gate[i]*1.2*fmax(view.full - s->row, 0.5*loss_of(s)*view.full)/relative(i);
}

static double source_of(int64_t i, const sums *s)
{
    const float *n = &view.concentration_gradient[i].x;
    const double size = sqrt((double)n[0]*n[0] + (double)n[1]*n[1] + (double)n[2]*n[2]);
    const double error = view.concentration[i] - 1 + 0.2*view.spacing*size;
    const double left = view.open ? 0 : fmax(fmin(error, 0.02), -0.02);
    const double pull = view.open ? 0.05*clip((0.06 - loss_of(s))/0.03) : 0.5;
    const double e = fmax(error - left, view.gate[i] > 0 ? 0 : -pull);
    return s->difference + (1 - view.gate[i])*s->rest + 0.5*view.density*view.invariant[i] -
           view.density/view.dt*s->divergence + view.density*0.1*e/(view.dt*view.volume_dt);
}

static void oracle_isph_rows(check *c, int64_t i, const sums *s)
{
    compare(c, view.source[i], source_of(i, s), view.density/view.dt/view.dt);
    compare(c, view.excess[i], excess_of(i, s), 10*view.full);
    compare(c, view.solution[i], 0.9*view.pressure[i], 1000);
    assert_true(view.inverse_diagonal[i] > 0);
}

#include "kernel/eisph_oracle.h"
static const double MEAN = 3e5;      /* Pa/m2, what isph_balance takes out */

static void oracle_isph_balance(check *c, int64_t i, const sums *s)
{
    compare(c, view.source[i] + MEAN, source_of(i, s), view.density/view.dt/view.dt);
}

static void oracle_isph_multiply(check *c, int64_t i, const sums *s)
{
    compare(c, view.out[i], s->product + view.excess[i]*view.in[i], view.full);
}

static void oracle_isph_store_pressure(check *c, int64_t i, const sums *s)
{
    (void)s;
    compare(c, view.pressure[i], view.solution[i], 1000);
    compare(c, view.record[i].w, view.pressure[i], 1000);
}

static void oracle_isph_projection(check *c, int64_t i, const sums *s)
{
    const float *n = &view.concentration_gradient[i].x;
    const double loss = 1 - view.trace[i]/view.dimension, flat = fmin(fmax((0.36 - loss)/0.03, 0), 1);
    double g[3], lack[3], along = 0, square = 0;
    isph_apply(&view.inverse[i], s->gradient, g);
    for (int a = 0; a < 3; a++) {
        lack[a] = view.gate[i]*(s->gradient[a] - g[a] + 2*1.1*view.pressure[i]/relative(i)*n[a]);
        along += lack[a]*n[a];
        square += n[a]*n[a];
    }
    for (int a = 0; a < view.dimension; a++) {
        g[a] += flat*along*n[a]/square + (1 - flat)*lack[a];
        compare(c, (&view.velocity[i].x)[a], (&before.x)[a] - view.dt/view.density*g[a],
                view.dt/view.density*1000/view.h);
    }
}

static void oracle_isph_add_shift_velocity(check *c, int64_t i, const sums *s)
{
    (void)s;
    for (int a = 0; a < 3; a++)
        compare(c, (&view.velocity[i].x)[a], (&before.x)[a] + (&view.shift_velocity[i].x)[a], 1);
}

static void oracle_isph_diagonal(check *c, int64_t i, const sums *s)
{
    (void)s;
    compare(c, view.out[i], view.in[i]*view.inverse_diagonal[i], 1/view.full);
}

/* One sum over all entries: check_body_force. */
static void oracle_isph_body_force(check *c, int64_t i, const sums *s)
{
    (void)c; (void)i; (void)s;
}

static void check_body_force(check *c, const double *t)
{
    for (int a = 0; a < 6; a++) {
        double force = 0;
        for (int64_t k = 0; k < view.count; k++) force += couplings[k].f[a]*view.in[links[k].particle];
        compare(c, t[a], force, 1);
    }
}

/* Adds to what isph_multiply made. */
static void oracle_isph_add_answer(check *c, int64_t i, const sums *s)
{
    double flux = 0;
    if (near_body[i] >= 0)
        for (int a = 0; a < 6; a++) flux += couplings[near_body[i]].f[a]*answers[0][a];
    compare(c, view.out[i], s->product + view.excess[i]*view.in[i] + view.density/view.volume*flux,
            view.full + view.density/view.volume);
}

#include "kernel/isph_choices_oracle.h"
#include "kernel/isph_shift_oracle.h"

typedef struct entry {
    const char *name;
    size_t offset;
    void (*oracle)(check *c, int64_t i, const sums *s);
} entry;

/* A kernel without an oracle does not compile: the list is the production list. */
static const entry kernels[] = {
#define PAIR(K, SUMS, MAXIMA, DOC)        /* see test_sph_oracle.c */
#define FOR PAIR
#define COUPLE PAIR
#define PHASES PAIR
#define PHASE PAIR
#define SCALARS PAIR
#define SCALAR PAIR
#define IMAGE(K, SUMS, MAXIMA, DOC) {#K, offsetof(sph_kernels, K), oracle_##K},
#define RARE IMAGE
#define ISPH IMAGE
#include "sph/kernels.def"
};
enum { KERNELS = sizeof kernels/sizeof *kernels };

static tobi_kernel kernel_at(const sph_kernels *table, int k)
{
    return *(const tobi_kernel *)((const char *)table + kernels[k].offset);
}

/* Before a kernel: what the solver does between them. */
static void prepare(int k)
{
    view.gravity_dt = !strcmp(kernels[k].name, "isph_rows") || !strcmp(kernels[k].name, "isph_balance")
                          ? (float)view.dt : 0;
    view.source_mean = MEAN;
    prepare_images(kernels[k].name);
    view.last_link = bodies || !strcmp(kernels[k].name, "isph_add_answer") ? near_body : NULL;
    if (!strcmp(kernels[k].name, "isph_store_pressure"))
        for (int64_t i = 0; i < view.count; i++) view.solution[i] *= 0.9;
}

static void follow_the_equations(int scalar)
{
    for (int k = 0; k < 12*TOBI_SHAPES; k++) {
        const int smoothing = k/4%TOBI_SHAPES, body = k/4/TOBI_SHAPES > 0;
        mixed = k/4/TOBI_SHAPES > 1;
        if (smoothing > 1 && (k/2%2 || body)) continue;      /* shapes differ in their falloff only */
        if (smoothing > 0 && mixed) continue;
        open_pool(2 + k%2, k/2%2, smoothing, body);
        if (scalar) kernel = &sph_kernels_scalar[sph_table_of(shape)];
        for (int n = 0; n < KERNELS; n++) {
            double t[TOBI_TOTALS], div = 0;
            check c = {kernels[n].name, 0};
            tobi_float4 *old = malloc((size_t)view.count*sizeof *old);
            memcpy(old, view.velocity, (size_t)view.count*sizeof *old);
            last = malloc((size_t)view.count*sizeof *last);
            for (int64_t i = 0; i < view.count; i++)
                last[i] = (sweep){view.source[i], view.solution[i], view.out[i]};
            prepare(n);
            run(kernel_at(kernel, n), t);
            const int all = !strcmp(kernels[n].name, "isph_projection") ||
                            !strcmp(kernels[n].name, "isph_shift");
            const int some = !strncmp(kernels[n].name, "eisph", 5) ? 29 : 7;
            for (int64_t i = 0; i < view.count; i += all ? 1 : some) {
                before = old[i];
                sums s = sum_pairs(i);
                if (!(view.gate[i] > 0)) div += fabs(s.divergence);
                kernels[n].oracle(&c, i, &s);
            }
            if (!strcmp(kernels[n].name, "isph_shift")) compare(&c, t[0], div, div + 1);
            if (!strcmp(kernels[n].name, "isph_body_force")) check_body_force(&c, t);
            if (!strcmp(kernels[n].name, "eisph_extent")) check_extent(&c, t);
            if (!strcmp(kernels[n].name, "isph_geometry")) check_geometry_sums(&c, t);
            if (!strcmp(kernels[n].name, "isph_rows")) assert_true((t[0] > 0) == view.open);
            if (!(c.worst < 2e-5)) fail_msg("case %d, %s: off by %g", k, c.name, c.worst);
            free(old);
            free(last);
        }
        close_pool();
    }
    mixed = 0;
}

static void kernels_follow_the_equations(void **state)
{
    (void)state;
    follow_the_equations(0);
}

/* What CUDA compiles. */
static void scalar_lanes_follow_them_too(void **state)
{
    (void)state;
    follow_the_equations(1);
}

static int64_t pack(float *to)
{
    int64_t n = 0;
#define X(name)                                                                                     \
    memcpy(to + n, view.name, (size_t)view.count*sizeof *view.name);                                \
    n += view.count*(int64_t)sizeof *view.name/4;
    ARRAYS(X)
#undef X
    memcpy(to + n, view.entry, (size_t)pool.cells.list_used*sizeof *view.entry);
    return n + pool.cells.list_used;
}

static void unpack(const float *from)
{
    int64_t n = 0;
#define X(name)                                                                                     \
    memcpy(view.name, from + n, (size_t)view.count*sizeof *view.name);                              \
    n += view.count*(int64_t)sizeof *view.name/4;
    ARRAYS(X)
#undef X
    memcpy(view.entry, from + n, (size_t)pool.cells.list_used*sizeof *view.entry);
}

/* Each kernel by both tables, from the same arrays. */
static void walk(const sph_kernels *other)
{
    const size_t most = (size_t)(view.count*60 + pool.cells.list_used);
    float *in = calloc(most, sizeof *in), *a = calloc(most, sizeof *a), *b = calloc(most, sizeof *b);
    for (int k = 0; k < KERNELS; k++) {
        double t[TOBI_TOTALS], u[TOBI_TOTALS];
        prepare(k);
        pack(in);
        run(kernel_at(other, k), t);
        const int64_t n = pack(a);
        unpack(in);
        run(kernel_at(kernel, k), u);
        pack(b);
        if (memcmp(a, b, (size_t)n*sizeof *a) || memcmp(t, u, sizeof t))
            fail_msg("%s: bits differ", kernels[k].name);
    }
    free(in);
    free(a);
    free(b);
}

static void instruction_sets_give_the_same_bits(void **state)
{
    (void)state;
    for (int k = 0; k < 4*TOBI_SHAPES; k++) {
        open_pool(2 + k%2, 0, k/2%TOBI_SHAPES, k/2/TOBI_SHAPES);
        for (int isa = 2; isa < pool.exec.isa; isa++) walk(sph_kernels_for(isa, shape));
        close_pool();
    }
}

#include "kernel/isph_matrix_oracle.h"

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kernels_follow_the_equations), cmocka_unit_test(scalar_lanes_follow_them_too),
        cmocka_unit_test(instruction_sets_give_the_same_bits), cmocka_unit_test(the_matrix_is_symmetric),
        cmocka_unit_test(linear_pressures_are_exact), cmocka_unit_test(linear_flows_are_exact),
        cmocka_unit_test(full_viscosity_is_exact), cmocka_unit_test(surfaces_are_marked),
        cmocka_unit_test(shifts_do_not_amplify),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
