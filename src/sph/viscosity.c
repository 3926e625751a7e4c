/* Implicit viscosity (decisions 107, 109): conjugate gradients over the velocities, with the diagonal as
   preconditioner. Drawback: iterations grow as the root of the step over that of explicit viscosity. */
#include "sph/viscosity.h"
#include "linear/solve.h"
#include "sph/phases.h"
#include "sph/stages.h"
#include "sph/state.h"
#include "sph/viscous_bodies.h"
#include <float.h>
#include <math.h>
#include <string.h>

/* Of the residual over rho: of the first, but no less of the velocity than LEAST, and no more than MOST. */
static const double TOLERANCE = 1e-2, LEAST = 1e-6, MOST = 1e-4;
enum { ITERATIONS = 1000 };

typedef struct solve {
    tobi_system *s;
    sph_view *v;
    const sph_kernels *k;
    double rz, residual, goal;       /* residual: squares */
    int iterations;
} solve;

static void launch(const solve *q, tobi_kernel k, double *totals)
{
    tobi_launch(&q->s->sim->exec, k, q->v, 0, q->s->particles.count, totals);
}

static int ends(void *user)
{
    const solve *q = user;
    return q->residual <= q->goal || q->iterations >= ITERATIONS;
}

static double precondition(void *user) { return ((const solve *)user)->rz; }

static void turn(void *user, double beta)
{
    const solve *q = user;
    q->v->beta = (float)beta;
    launch(q, q->k->sph_viscous_turn, NULL);
    sph_viscous_bodies_turn(q->s, beta);
}

/* How neighbours and walls lie does not change in a solve. */
static void find_shapes(const solve *q)
{
    launch(q, q->k->sph_viscous_shape, NULL);
    sph_viscous_bodies_shape(q->s);
    launch(q, q->k->sph_viscous_close, NULL);
}

static void find_spins(const solve *q, const tobi_float4 *of, int moving)
{
    q->v->viscous.operand = of;
    q->v->viscous.moving = (float)moving;
    launch(q, q->k->sph_viscous_spin, NULL);
    sph_viscous_bodies_spin(q->s, q->v, moving);
}

static double apply(void *user)
{
    const solve *q = user;
    double t[TOBI_TOTALS];
    find_spins(q, q->v->viscous.direction, 0);
    launch(q, q->k->sph_viscous_product, NULL);
    const double bodies = sph_viscous_bodies_apply(q->s);
    launch(q, q->k->sph_viscous_curve, t);
    return t[0] + bodies;
}

static void keep(solve *q, const double *t)
{
    q->rz = t[0];
    q->residual = t[1];
    sph_viscous_bodies_measure(q->s, &q->rz, &q->residual);
}

static void advance(void *user, double alpha)
{
    solve *q = user;
    double t[TOBI_TOTALS];
    q->v->alpha = (float)alpha;
    launch(q, q->k->sph_viscous_advance, t);
    sph_viscous_bodies_advance(q->s, alpha);
    keep(q, t);
    q->iterations++;
}

/* The true residual, and squares of it and of the velocity before viscosity. */
static void find_residual(solve *q, double *t, int first)
{
    if (first) find_shapes(q);
    find_spins(q, q->v->viscous.x, 1);
    launch(q, q->k->sph_viscous_rows, NULL);
    sph_viscous_bodies_residual(q->s, first);
    launch(q, q->k->sph_viscous_measure, t);
    keep(q, t);
}

typedef struct copying { const tobi_float4 *from; tobi_float4 *to; } copying;

static void copy_range(const void *view, int64_t begin, int64_t end)
{
    const copying *c = view;
    memcpy(c->to + begin, c->from + begin, (size_t)(end - begin)*sizeof *c->to);
}

static void copy_velocities(const tobi_system *s, tobi_float4 *to)
{
    const copying c = { s->particles.velocity, to };
    tobi_loop(s->sim->exec.threads, s->particles.count, 0, copy_range, &c);
}

/* The viscosity at the rates of the velocities kept: eq. (6). */
static void find_apparent(tobi_system *s, sph_view *v, const sph_kernels *k)
{
    const solve q = { .s = s, .v = v, .k = k };
    if (!v->viscous.apparent) return;
    v->viscous.operand = v->viscous.x;
    launch(&q, k->sph_strain, NULL);
    sph_viscous_bodies_strain(s);
    launch(&q, k->sph_apparent, NULL);
}

void sph_viscosity_begin(tobi_system *s, sph_view *v, const sph_kernels *k)
{
    if (!v->implicit) return;
    copy_velocities(s, v->viscous.x);
    if (v->phase) sph_phases_set(s, v, k);
    find_apparent(s, v, k);
}

static void add_acceleration(const void *view, int64_t begin, int64_t end)
{
    const sph_view *v = view;
    for (int64_t i = begin; i < end; i++)
        for (int c = 0; c < 3; c++) (&v->velocity[i].x)[c] += v->dt*(&v->accel[i].x)[c];
}

static void expect_pressure(tobi_system *s, sph_view *v, const sph_kernels *k)
{
    sph_show_pressure(s);
    tobi_launch(&s->sim->exec, k->sph_pressure_accel, v, 0, s->particles.count, NULL);
    tobi_loop(s->sim->exec.threads, s->particles.count, 0, add_acceleration, v);
}

/* What float leaves of the residual, over the velocity, where a liquid hardly creeps: the diagonal over rho,
   times its rounding. */
static double find_rounding(const tobi_system *s)
{
    double most = 0;
    for (int f = 0; f < s->fluid_count; f++) {
        const tobi_fluid *q = &s->fluid[f];
        const double mu = q->viscosity*pow(q->creep_rate, q->flow_index - 1) + q->yield_stress/q->creep_rate;
        most = fmax(most, mu/q->density);
    }
    return FLT_EPSILON*s->dt*most*4*s->smoothing.rate;
}

void sph_viscosity_solve(tobi_system *s, sph_view *v, const sph_kernels *k, void (*expect)(tobi_system *s),
                         double *clock)
{
    static const tobi_cg_steps steps = { ends, precondition, turn, apply, advance };
    solve q = { .s = s, .v = v, .k = k };
    double t[TOBI_TOTALS];
    if (!v->implicit) return;
    copy_velocities(s, v->viscous.expected);
    if (expect) expect(s);
    else expect_pressure(s, v, k);
    launch(&q, k->sph_viscous_expect, NULL);
    sph_viscous_bodies_begin(s);
    find_residual(&q, t, 1);
    q.goal = fmin(MOST*MOST*t[2], fmax(TOLERANCE*TOLERANCE*q.residual, LEAST*LEAST*t[2]));
    tobi_cg_iterate(&steps, &q);
    find_residual(&q, t, 0);
    const double rounding = v->viscous.apparent ? find_rounding(s)*sqrt(t[2]) : 0;
    launch(&q, k->sph_viscous_finish, t);
    for (int a = 0; a < 3; a++) sph_of(s)->friction[a] = t[a]/s->dt;
    sph_viscous_bodies_keep(s);
    s->info.viscosity_iterations = q.iterations;
    /* the true residual, in float */
    s->info.viscosity_failed = !(q.residual <= 4*fmax(q.goal, rounding*rounding));
    tobi_stage_end(&s->sim->stages, "viscosity", clock);
}

typedef struct adding { const tobi_system *s; float share; } adding;

static void add_expected(const void *view, int64_t begin, int64_t end)
{
    const adding *q = view;
    const sph_fields *f = sph_fields_of(&q->s->particles);
    for (int64_t i = begin; i < end; i++)
        for (int c = 0; c < 3; c++)
            (&q->s->particles.velocity[i].x)[c] += q->share*(&f->viscous_expected[i].x)[c];
}

void sph_viscosity_expect(tobi_system *s, double share)
{
    const adding q = {s, (float)share};
    if (s->sim->def.implicit_viscosity)
        tobi_loop(s->sim->exec.threads, s->particles.count, 0, add_expected, &q);
}

void sph_viscosity_add(tobi_system *s, sph_view *v, const sph_kernels *k)
{
    solve q = { .s = s, .v = v, .k = k };
    double t[TOBI_TOTALS];
    if (!v->implicit) return;
    copy_velocities(s, v->viscous.expected);
    launch(&q, k->sph_viscous_expect, NULL);
    sph_viscous_bodies_rest(s);
    find_residual(&q, t, 1);
    launch(&q, k->sph_viscous_finish, t);
}

void sph_viscosity_load(tobi_system *s)
{
    if (!s->sim->def.implicit_viscosity) return;
    for (int a = 0; a < 3; a++) s->info.wall_force[a] += sph_of(s)->friction[a];
}
