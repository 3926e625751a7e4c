/* The pressure equation of isph: entries in float beside the neighbour list, vectors in double, conjugate
   gradients with a cycle of the cell multigrid (decision 42). Drawback: entries take as much memory as the
   list, which a product that computes them anew would not. */
#include "sph/isph/solve.h"
#include "sph/fields.h"
#include "sph/isph/forces.h"
#include "sph/isph/pockets.h"
#include "sph/porous.k.h"
#include "sph/scalars.h"
#include "sph/isph/surface.h"
#include "sph/isph/sweeps.h"
#include "sph/openings.h"
#include "sph/soft.h"
#include <math.h>
#include <string.h>

/* Of the sweeps on the particles before and after the grid. */
static const double DAMPING = 0.7;

/* X(type, pointer): arrays of one value per particle. */
#define ARRAYS(X)                                                                                    \
    X(double, m->view.solution) X(double, m->scratch) X(double, m->view.excess)                           \
    X(double, m->view.inverse_diagonal) X(double, m->view.source) X(tobi_double3, m->work)           \
    X(tobi_float4, m->view.concentration_gradient) X(isph_tensor, m->view.inverse) X(float, m->view.trace) \
    X(float, m->view.gate) X(float, m->view.scale) X(float, m->view.concentration) \
    X(float, m->view.body_share) X(float, m->view.invariant) X(uint8_t, m->pocket)

static int64_t row_bytes(void)
{
    int64_t sum = 0;
#define X(type, pointer) sum += (int64_t)sizeof(type);
    ARRAYS(X)
#undef X
    return sum;
}

/* Nothing of it outlives a step. */
static tobi_status reserve_rows(isph_solver *m, const tobi_particles *p, tobi_error *err)
{
    if (p->capacity <= m->rows) return TOBI_OK;
    const int64_t n = p->capacity + TOBI_PAD_ROWS;
    tobi_array_free(m->memory);
    m->rows = 0;
    char *at = m->memory = tobi_array_zero(n, (size_t)row_bytes());
    if (!at) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the rows of %lld particles", (long long)n);
#define X(type, pointer) pointer = (void *)at; at += n*(int64_t)sizeof(type);
    ARRAYS(X)
#undef X
    m->view.shift_velocity = (tobi_float4 *)m->work; /* free between the solves */
    m->rows = p->capacity;
    return TOBI_OK;
}

static void take_choices(isph_view *v, const tobi_isph_def *def)
{
    v->volume_gain = def->volume_gain;
    v->own_pressure = def->pressure_gradient == TOBI_PLAIN_SUM ? 1
                    : def->pressure_gradient == TOBI_SYMMETRIC_SUM ? 2 : 0;
    v->as_summed = !def->renormalised;
    v->own_scale = def->laplacian == TOBI_LAPLACIAN_OWN;
    v->uniform_scale = def->laplacian == TOBI_LAPLACIAN_UNIFORM;
    v->volume_sum = def->volume_error != TOBI_VOLUME_CONTINUITY;
    v->volume_change = def->volume_error != TOBI_VOLUME_SUM;
    v->by_eigenvalue = def->surface_rule == TOBI_SURFACE_EIGENVALUE;
    v->by_mark = def->surface_rule == TOBI_SURFACE_CONE || def->surface_rule == TOBI_SURFACE_COUNT;
    v->by_count = def->surface_rule == TOBI_SURFACE_COUNT;
    v->xsph = (float)def->xsph;
    v->full_viscosity = def->viscosity_form == TOBI_VISCOSITY_FULL;
}

void isph_solver_begin(isph_solver *m, tobi_system *s, const tobi_isph_def *def)
{
    const tobi_smoothing_constants *c = &s->smoothing;
    isph_view *v = &m->view;
    m->exec = &s->sim->exec;
    m->def = def;
    v->dimension = c->dimension;
    v->shape = c->shape;
    m->kernel = sph_kernels_for(s->sim->exec.isa, c->shape);
    v->inverse_h = (float)(1/c->h);
    v->spacing = c->spacing;
    v->h = c->h;
    v->volume = c->volume;
    v->weight = c->weight;
    v->slope = c->slope;
    v->full = 2*c->rate;
    v->keep = 1;
    v->density = s->fluid[0].density;
    take_choices(v, def);
    isph_surface_measure(v, c, def->surface_height);
    memcpy(v->size, s->box.size, sizeof v->size);
    memcpy(v->periodic, s->box.periodic, sizeof v->periodic);
    memcpy(v->from_fixed, s->box.from_fixed, sizeof v->from_fixed);
    for (int a = 0; a < v->dimension; a++)
        for (int k = 0; k < 2 && !v->periodic[a]; k++)
            v->side[k][a] = (int32_t)lround((k*v->size[a] - s->box.centre[a])*s->box.to_fixed[a]);
}

/* For the list of the last search; the old ones are of no use, and the new ones take their place. */
static tobi_status reserve_entries(isph_solver *m, const tobi_cells *cells, tobi_error *err)
{
    if (cells->list_used <= m->entries) return TOBI_OK;
    const int64_t entries = cells->list_used + cells->list_used/64;
    tobi_array_free(m->view.entry);
    m->view.entry = tobi_array_make(entries, sizeof *m->view.entry);
    m->entries = m->view.entry ? entries : 0;
    return m->view.entry ? TOBI_OK : tobi_fail(err, TOBI_NO_MEMORY, "no memory for a matrix of %lld entries",
                                               (long long)entries);
}

static int64_t krylov_work(const tobi_isph_def *def, int64_t rows)
{
    return def->solver == TOBI_BICGSTAB ? tobi_bicgstab_work(rows)
         : def->solver == TOBI_GMRES ? tobi_gmres_work(rows, def->restart) : 0;
}

static tobi_status reserve_krylov(isph_solver *m, int64_t rows, tobi_error *err)
{
    const int64_t need = krylov_work(m->def, rows);
    if (need <= m->krylov_rows) return TOBI_OK;
    double *more = tobi_array_grow(m->krylov, 0, need, sizeof *more);
    if (!more)
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld numbers of the solver", (long long)need);
    m->krylov = more;
    m->krylov_rows = need;
    return TOBI_OK;
}

tobi_status isph_solver_bind(isph_solver *m, tobi_system *s, tobi_error *err)
{
    const tobi_particles *p = &s->particles;
    const sph_fields *f = sph_fields_of(p);
    isph_view *v = &m->view;
    TOBI_TRY(reserve_rows(m, p, err));
    if (!m->grid.memory) {
        const tobi_cell_points points = tobi_cells_points(&s->cells, &s->box, p);
        TOBI_TRY(tobi_multigrid_create(&m->grid, &points, 1, 2, err));
    }
    TOBI_TRY(reserve_entries(m, &s->cells, err));
    TOBI_TRY(reserve_krylov(m, p->capacity, err));
    v->count = p->count;
    v->position = p->position;
    v->record = s->cells.record;
    v->velocity = p->velocity;
    v->accel = f->accel;
    v->fluid = p->fluid;
    v->phase = f->phase;
    v->interface = f->interface;
    v->fluid_count = s->fluid_count;
    v->pressure = f->pressure;
    v->list = s->cells.list;
    v->list_far = s->cells.list_far;
    v->list_start = s->cells.list_start;
    v->list_groups = s->cells.list_groups;
    v->dt = s->dt;
    v->acceleration = s->sim->acceleration;
    v->scalars = f->scalars;
    v->lift = sph_scalars_lift(s);
    for (int a = 0; a < 3; a++) v->gravity[a] = a < v->dimension ? (float)s->gravity[a] : 0;
    return TOBI_OK;
}

/* The liquid's part. */
static void multiply(void *user, double *y, const double *x)
{
    isph_solver *m = user;
    m->view.in = x;
    m->view.out = y;
    tobi_launch(m->exec, m->kernel->isph_multiply, &m->view, 0, m->view.count, NULL);
}

static void apply(void *user, double *y, const double *x)
{
    multiply(user, y, x);
    isph_forces_add_answer(user, y, x);
    sph_soft_add_answer(((isph_solver *)user)->system, y, x);
}

static int ask_stop(void *user)
{
    isph_solver *m = user;
    return tobi_simulation_stops(m->system->sim);
}

/* Of the liquid alone: the answer of a light body is no small change of the matrix, but of low rank. */
static void precondition(void *user, double *z, const double *r)
{
    isph_solver *m = user;
    const tobi_linear_system system = { .rows = m->view.count, .user = m, .apply = multiply };
    tobi_multigrid_cycle(&m->grid, m->exec, &system, m->view.inverse_diagonal, DAMPING, m->scratch, z, r);
}

static void precondition_by_diagonal(void *user, double *z, const double *r)
{
    isph_solver *m = user;
    m->view.in = r;
    m->view.out = z;
    tobi_launch(m->exec, m->kernel->isph_diagonal, &m->view, 0, m->view.count, NULL);
}

typedef struct lightness { const isph_view *v; double least, *share; } lightness;

/* Least density over that of each particle, less what porous zones resist. */
static void share_range(const void *view, int64_t begin, int64_t end, double *totals)
{
    const lightness *l = view;
    const isph_view *v = l->v;
    (void)totals;
    for (int64_t i = begin; i < end; i++) {
        l->share[i] = v->phase ? l->least/v->phase[i].x : 1;
        if (v->porous) l->share[i] *= sph_porous_mean(v->porous[i], v->dimension);
    }
}

/* 1/rho over that of the first liquid, which varies from point to point: at most that of the lightest. The
   shares lie in scratch, which is free until a cycle. */
static double set_shares(isph_solver *m, const tobi_system *s)
{
    lightness l = { &m->view, INFINITY, m->scratch };
    for (int f = 0; f < s->fluid_count; f++) l.least = fmin(l.least, s->fluid[f].density);
    tobi_launch(m->exec, TOBI_HOST(share_range, 0, 0), &l, 0, m->view.count, NULL);
    return m->view.density/l.least;
}

static void set_grid(isph_solver *m, tobi_system *s)
{
    const tobi_cell_points points = tobi_cells_points(&s->cells, &s->box, &s->particles);
    tobi_grid_weights w = { .strength = 1, .volume = m->view.volume, .excess = m->view.excess };
    if (m->view.phase || m->view.porous) {
        w.strength = set_shares(m, s);
        w.share = m->scratch;
    }
    tobi_multigrid_set(&m->grid, m->exec, &points, &w);
}

static tobi_linear_report run(isph_solver *m, const tobi_linear_system *a)
{
    const tobi_isph_def *d = m->def;
    const tobi_linear_settings how = { d->tolerance, d->iterations_max, d->restart };
    const double *b = m->view.source;
    double *x = m->view.solution;
    if (d->solver == TOBI_BICGSTAB) return tobi_bicgstab(m->exec, a, &how, b, x, m->krylov);
    if (d->solver == TOBI_GMRES) return tobi_gmres(m->exec, a, &how, b, x, m->krylov);
    return tobi_cg(m->exec, a, &how, b, x, m->work);
}

/* A closed pocket is known by a solve that fails, and from then on looked for. One in a body that moves by
   forces lets it converge, to pressures without a meaning: it is looked for at the start. */
static tobi_linear_report run_with_pockets(isph_solver *m, const tobi_linear_system *a)
{
    const int looks = m->pockets || (m->coupled && m->system->step == 0 && !a->singular);
    tobi_linear_system centered = *a;
    tobi_linear_report report = { .status = TOBI_LINEAR_LIMIT };
    centered.center = isph_pockets_center;
    if (!looks) report = run(m, a);
    if (report.status == TOBI_LINEAR_CONVERGED || report.status == TOBI_LINEAR_STOPPED ||
        (a->singular && !looks))
        return report;
    const int found = isph_pockets_find(m, a), again = found > 0 || looks;
    m->pockets |= found > 0;
    return again ? run(m, found > 0 ? &centered : a) : report;
}

/* Neighbours in buffers. Those of an outlet have a given pressure, which goes to the source. Where that is
   the pressure of a plane, it goes on beyond it along the line between both, so that the row has it at the
   plane: were it that of the whole buffer, the plane would be some spacings beyond. Those of an inlet do not
   move by pressure, so that nothing passes between them and a row. */
static void take_held(const void *view, int64_t begin, int64_t end, double *totals)
{
    const isph_solver *m = view;
    const isph_view *v = &m->view;
    (void)totals;
    for (int64_t i = begin; i < end; i++) {
        const int64_t first = 8*(int64_t)v->list_start[i];
        double sum = 0, more = 0;
        for (int k = 0; k < 8*v->list_groups[i]; k++) {
            const int32_t j = tobi_list_at(v->list, v->list_far, i, first + k);
            float *a = &v->entry[first + k];
            if (v->held[j].w < 0 && *a != 0) {
                double still = 0;
                const double part = v->gate[i] > 0 ? 0 : *a*sph_openings_stretch(m->system, i, j, &still);
                sum += *a*(double)v->pressure[j] + part*(v->pressure[j] + still);
                v->excess[i] += part;
                more += part;
            }
            if (!(v->held[j].w > 0)) continue;
            more -= *a;
            *a = 0;
        }
        v->source[i] += sum;
        if (more == 0 || !(v->inverse_diagonal[i] > 0)) continue;
        const double left = 1/v->inverse_diagonal[i] + more;
        v->inverse_diagonal[i] = left > 1e-6*v->full ? 1/left : 0;
    }
}

tobi_linear_report isph_solver_run(isph_solver *m, tobi_system *s)
{
    double t[TOBI_TOTALS];
    const int64_t n = m->view.count;
    m->system = s;
    m->view.gravity_dt = (float)m->view.dt;
    tobi_launch(m->exec, m->kernel->isph_rows, &m->view, 0, n, t);
    isph_forces_add_expected(m);
    if (m->view.held) tobi_launch(m->exec, TOBI_HOST(take_held, 0, 0), m, 0, n, NULL);
    m->view.source_mean = t[1]/(double)n;
    if (!m->view.open && t[0] > 0) tobi_launch(m->exec, m->kernel->isph_balance, &m->view, 0, n, NULL);
    const int grid = m->def->preconditioner == TOBI_MULTIGRID && m->sweeps.count == 0;
    if (grid) set_grid(m, s);
    const tobi_linear_system system = { .rows = n, .singular = !(t[0] > 0), .user = m, .apply = apply,
                                        .precondition = grid ? precondition : precondition_by_diagonal,
                                        .stop = ask_stop };
    const tobi_linear_report report =
        m->sweeps.count > 0 ? isph_sweep_all(m, system.singular) : run_with_pockets(m, &system);
    m->view.gravity_dt = 0;
    return report;
}

void isph_solver_store(isph_solver *m)
{
    tobi_launch(m->exec, m->kernel->isph_store_pressure, &m->view, 0, m->view.count, NULL);
}

int64_t isph_solver_estimate(const tobi_isph_def *def, const tobi_system_plan *plan)
{
    const int64_t entries = (int64_t)(plan->entries*(double)plan->particles),
                  krylov = def ? krylov_work(def, plan->particles) : 0;
    return plan->particles*row_bytes() + entries*(int64_t)sizeof(float) + krylov*(int64_t)sizeof(double) +
           tobi_multigrid_plan_bytes(&plan->cells, 1);
}

void isph_solver_account(const isph_solver *m, tobi_account *a)
{
    tobi_account_add(a, "rows of the matrix", (m->rows + TOBI_PAD_ROWS)*row_bytes());
    tobi_account_add(a, "entries of the matrix", m->entries*(int64_t)sizeof *m->view.entry);
    tobi_account_add(a, "vectors of the solver", m->krylov_rows*(int64_t)sizeof *m->krylov);
    tobi_account_add(a, "grid of the solver", tobi_multigrid_bytes(&m->grid));
    tobi_account_add(a, "images at bodies", m->view.group_room*(int64_t)sizeof *m->view.group);
    tobi_account_add(a, "images at bodies",
                     m->mirrors*(int64_t)(sizeof *m->mirror + sizeof *m->brief +
                                          sizeof *m->view.first_group));
    tobi_account_add(a, "particles beside bodies", isph_forces_bytes(m));
}

void isph_solver_free(isph_solver *m)
{
    tobi_multigrid_free(&m->grid);
    tobi_array_free(m->view.entry);
    tobi_array_free(m->krylov);
    isph_forces_free(m);
    tobi_array_free(m->mirror);
    tobi_array_free(m->brief);
    tobi_array_free(m->view.first_group);
    tobi_array_free(m->view.group);
    tobi_array_free(m->memory);
}
