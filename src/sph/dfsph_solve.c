/* The pressure equations of dfsph: conjugate gradients on one symmetric matrix-free operator, in float, with
   the multigrid of cells before them. A free surface that pulls is held at no pressure, and the rest solved
   again. Drawback: that set of particles is chosen between two runs of the gradients, not during one. */
#include "sph/dfsph_solve.h"
#include "linear/solve.h"
#include "sph/boundary/boundary.h"
#include "sph/soft.h"
#include "sph/stages.h"
#include <math.h>
#include <string.h>

/* Share of all pressure that may pull at a free surface before the rest is solved for again. */
static const double PULL_TOLERANCE = 1e-3;

/* Mean pressure of full vessels with several densities, over what their difference weighs in the whole depth.
   Less lets particles crowd; more makes their lattice stiff. */
static const double BASE = 0.25;

void dfsph_launch(tobi_system *s, dfsph *m, tobi_kernel k, double *totals)
{
    tobi_launch(&s->sim->exec, k, &m->view, 0, s->particles.count, totals);
}

/* Pa: the mean pressure of a full vessel. Particles under negative pressure crowd: fluids of several
   densities, which feel what is left of gravity, stay above 0. */
static double base_pressure(const tobi_system *s)
{
    double depth = 0, least, most;
    for (int a = 0; a < s->box.dimension; a++)
        depth += fabs(s->sim->def.gravity[a] - s->gravity[a])*s->box.size[a];
    tobi_system_densities(s, &least, &most);
    return most > least ? BASE*(most - least)*depth : 0;
}

/* Without a free surface the constant pressure is left out: takes the mean from residual or product. */
static void center(tobi_system *s, dfsph *m, const dfsph_solve *q, tobi_kernel kernel, double sum, double *t)
{
    if (!q->constant_free) return;
    m->view.mean = (float)(sum/sph_rows(s));
    dfsph_launch(s, m, kernel, t);
}

/* |r|/|s| in the norm of the diagonal; a source of round-off size counts as a hundredth of what the
   tolerance lets pass. */
static double relative_residual(const tobi_system *s, const dfsph *m, const dfsph_solve *q, double rz)
{
    double small = 1e-2*q->tolerance/(s->dt*s->dt);
    double floor = (double)s->particles.count*small*small/fmax(m->diagonal, 1e-300);
    return sqrt(rz/fmax(fmax(q->source, floor), 1e-300));
}

/* The steps of conjugate gradients, in float. */
typedef struct cg_run { tobi_system *s; dfsph *m; dfsph_solve *q; double *t; } cg_run;

/* t: |r|^2/diagonal, |r|; largest |r|. */
static int ends(void *user)
{
    const cg_run *c = user;
    dfsph_solve *q = c->q;
    q->error = c->t[1]*c->s->dt*c->s->dt/sph_rows(c->s);
    q->worst = c->t[6];
    q->relative = relative_residual(c->s, c->m, q, c->t[0]);
    q->converged = q->error <= q->tolerance && q->relative <= q->relative_tolerance;
    return !(c->t[0] > 0) || q->iterations >= q->max || q->error <= q->nothing ||
           (q->converged && q->iterations >= q->min) || tobi_simulation_stops(c->s->sim);
}

static double precondition(void *user)
{
    const cg_run *c = user;
    const sph_fields *p = sph_fields_of(&c->s->particles);
    if (!c->q->grid) return c->t[0];
    return c->t[0] + tobi_multigrid_apply(&c->m->grid, &c->s->sim->exec, p->residual, p->precondition);
}

static void turn(void *user, double beta)
{
    const cg_run *c = user;
    c->m->view.beta = (float)beta;
    dfsph_launch(c->s, c->m, c->m->kernel->sph_cg_direction, c->t);
    center(c->s, c->m, c->q, c->m->kernel->sph_center_direction, c->t[0], NULL);
}

void dfsph_add_answers(tobi_system *s, double *t)
{
    tobi_couple_product(s, t);
    sph_soft_product(s, t);
}

static double apply(void *user)
{
    const cg_run *c = user;
    dfsph_launch(c->s, c->m, c->m->kernel->sph_pressure_accel, NULL);
    if (c->q->coupled) tobi_couple_press(c->s);
    dfsph_launch(c->s, c->m, c->m->kernel->sph_product, c->t);
    if (c->q->coupled) dfsph_add_answers(c->s, c->t);
    center(c->s, c->m, c->q, c->m->kernel->sph_center_product, c->t[1], c->t);
    return c->t[0];
}

static void advance(void *user, double alpha)
{
    const cg_run *c = user;
    c->m->view.alpha = (float)alpha;
    dfsph_launch(c->s, c->m, c->m->kernel->sph_cg_update, c->t);
    c->q->iterations++;
}

static void iterate(tobi_system *s, dfsph *m, dfsph_solve *q, double *t)
{
    static const tobi_cg_steps steps = { ends, precondition, turn, apply, advance };
    cg_run run = { s, m, q, t };
    tobi_cg_iterate(&steps, &run);
}

/* Particles of a free surface whose pressure came out pulling are held at none, and what the others lack
   without their pull is the new residual, at the price of an iteration; 0 if they are next to nothing. */
static int clamp_pressure(tobi_system *s, dfsph *m, dfsph_solve *q, double *t)
{
    double pull[TOBI_TOTALS];
    cg_run run = { s, m, q, t };
    if (m->memory.vessel == SPH_VESSEL_FULL || q->iterations >= q->max || s->sim->stopped) return 0;
    dfsph_launch(s, m, m->kernel->sph_clamp_pressure, pull);
    if (!(pull[0] > PULL_TOLERANCE*pull[1])) return 0;
    apply(&run);
    advance(&run, 1);
    return 1;
}

void dfsph_solve_pressure(tobi_system *s, dfsph *m, const double *start, dfsph_solve *q)
{
    const sph_kernels *k = m->kernel;
    double t[TOBI_TOTALS];
    memcpy(t, start, sizeof t);
    center(s, m, q, k->sph_center_residual, t[2], t);
    m->view.coarse = q->grid ? tobi_multigrid_values(&m->grid) : (tobi_grid_values){0};
    do iterate(s, m, q, t); while (clamp_pressure(s, m, q, t));
    dfsph_launch(s, m, k->sph_correct_pressure, t);
    const double base = q->grid ? base_pressure(s)*(double)s->particles.count : 0;
    center(s, m, q, k->sph_center_pressure, t[1] - base, NULL);
    q->head = 2*t[0]/sph_rows(s);
}
