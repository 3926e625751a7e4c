/* What the pressure of isph does to bodies, and how those that move by forces answer it within the solve. The
   force is linear in the pressures of the particles: its coefficients, the grips, are found once per step.
   The answer spreads the flux of a surface that moves by the same coefficients, which keeps the matrix
   symmetric (decision 49). Drawback: that flux and the one of the mirrors are the same on average only. */
#include "sph/boundary.h"
#include "sph/isph_forces.h"
#include "sph/state.h"
#include "geom/vec3.h"
#include <math.h>
#include <string.h>

/* Share of the kernel with particles in it below which a point of a body is dry. */
static const double DRY = 0.1;

/* A body's points, and the particles around them. */
typedef struct look {
    const tobi_system *s;
    const isph_view *v;
    int body;
    isph_point *point;               /* of the body                                                 */
    double scale;                    /* m3, on W                                                    */
} look;

static const tobi_body *body_of(const look *q) { return &q->s->sim->bodies[q->body]; }

/* What a particle at distance x from a point, which faces it, counts there; 0: nothing. */
static double weigh(const look *q, int64_t point, const double x[3])
{
    const tobi_smoothing_constants *c = &q->s->smoothing;
    const double r2 = vec3_dot(x, x);
    if (!(vec3_dot(x, body_of(q)->normal[point]) > 0) || r2 >= c->h*c->h) return 0;
    return q->scale*tobi_smoothing_w(c->shape, c->dimension, c->h, sqrt(r2));
}

/* From a point to a place. */
static void measure(const look *q, int64_t point, const tobi_double3 *at, double x[3])
{
    for (int a = 0; a < 3; a++) x[a] = a < q->v->dimension ? (&at->x)[a] - body_of(q)->point[point][a] : 0;
}

/* Particles before the point, and the pressure that liquid at rest has there beyond theirs. */
static void add_cell(const look *q, int64_t k, int64_t cell, isph_point *sum)
{
    const isph_view *v = q->v;
    for (int64_t i = q->s->cells.start[cell]; i < q->s->cells.start[cell + 1]; i++) {
        double x[3];
        measure(q, k, &v->position[i], x);
        const double w = weigh(q, k, x);
        sum->weight += w;
        for (int a = 0; a < v->dimension; a++) sum->rise -= w*v->density*v->gravity[a]*x[a];
    }
}

/* The cell at an offset from that of x; -1: there is none. */
static int64_t find_cell(const tobi_cells *c, const double x[3], const int offset[3])
{
    int at[3];
    for (int a = 0; a < 3; a++) {
        at[a] = (int)floor(x[a]*c->inverse[a]) + offset[a];
        if (at[a] < 0 || at[a] >= c->n[a]) return -1;
    }
    return tobi_cells_row(c, at[1], at[2]) + at[0];
}

static isph_point look_around(const look *q, int64_t k)
{
    const int deep = q->v->dimension == 3;
    double x[3] = { 0 };
    isph_point sum = { 0, 0 };
    for (int a = 0; a < q->v->dimension; a++) x[a] = body_of(q)->point[k][a];
    for (int z = -deep; z <= deep; z++)
        for (int y = -1; y <= 1; y++)
            for (int o = -1; o <= 1; o++) {
                const int64_t cell = find_cell(&q->s->cells, x, (int[3]){ o, y, z });
                if (cell >= 0) add_cell(q, k, cell, &sum);
            }
    return sum;
}

/* Force and torque by a push along the normal at a point. */
static void add_push(const tobi_body *b, int64_t k, double push, double f[6])
{
    const double *n = b->normal[k];
    double arm[3], turn[3];
    for (int a = 0; a < 3; a++) arm[a] = b->point[k][a] + b->lower[a] - b->centre[a];
    vec3_cross(turn, arm, n);
    for (int a = 0; a < 3; a++) {
        f[a] += push*n[a];
        f[3 + a] += push*turn[a];
    }
}

/* totals: the force of liquid at rest beyond the pressures of the particles. */
static void weigh_points(const void *view, int64_t begin, int64_t end, double *totals)
{
    const look *q = view;
    const tobi_body *b = body_of(q);
    for (int64_t k = begin; k < end; k++) {
        isph_point *p = &q->point[k];
        *p = b->area[k] > 0 ? look_around(q, k) : (isph_point){ 0, 0 };
        if (!(p->weight > DRY)) p->weight = INFINITY;
        add_push(b, k, -b->area[k]*p->rise/p->weight, totals);
    }
}

/* A particle's look at the points of one body. */
typedef struct gripping { look q; const tobi_double3 *at; isph_grips grip; } gripping;

static int grip_point(void *user, int32_t k)
{
    gripping *g = user;
    const tobi_body *b = body_of(&g->q);
    double x[3];
    measure(&g->q, k, g->at, x);
    const double w = b->area[k] > 0 ? weigh(&g->q, k, x) : 0;
    if (w > 0) add_push(b, k, -b->area[k]*w/g->q.point[k].weight, g->grip.f);
    return 0;
}

typedef struct all { const look *q; isph_solver *m; const tobi_boundary_links *n; } all;

static void grip_bodies(const void *view, int64_t begin, int64_t end, double *totals)
{
    const all *u = view;
    (void)totals;
    for (int64_t k = begin; k < end; k++) {
        const tobi_boundary_link *l = &u->n->link[k];
        gripping g = { .q = *u->q, .at = &u->q->v->position[l->particle] };
        const double x[3] = { g.at->x, g.at->y, g.at->z };
        g.q.body = l->body;
        g.q.point = u->m->point + u->n->bins[l->body].item;
        tobi_boundary_visit(u->n, l->body, x, grip_point, &g);
        u->m->grip[k] = g.grip;
    }
}

static tobi_status reserve(isph_solver *m, const tobi_boundary_links *n, int bodies, tobi_error *err)
{
    const int64_t links = n->count, points = n->bins[bodies].item;
    if (links > m->grips) {
        isph_grips *more = tobi_array_grow(m->grip, 0, links + links/2 + 64, sizeof *more);
        if (!more) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld grips", (long long)links);
        m->grip = more;
        m->grips = links + links/2 + 64;
    }
    if (points > m->points) {
        isph_point *more = tobi_array_grow(m->point, 0, points, sizeof *more);
        if (!more) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld points", (long long)points);
        m->point = more;
        m->points = points;
    }
    if (bodies > m->bodies) {
        isph_grips *more = tobi_array_grow(m->still, 0, bodies, sizeof *more);
        if (!more) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %d bodies", bodies);
        m->still = more;
        m->bodies = bodies;
    }
    return TOBI_OK;
}

tobi_status isph_forces_see(isph_solver *m, tobi_system *s, tobi_error *err)
{
    const tobi_boundary_links *n = &sph_of(s)->near;
    const tobi_smoothing_constants *c = &s->smoothing;
    const int bodies = s->sim->body_count;
    if (bodies == 0) return TOBI_OK;
    TOBI_TRY(reserve(m, n, bodies, err));
    look q = { .s = s, .v = &m->view, .scale = c->volume*c->weight_correction };
    for (q.body = 0; q.body < bodies; q.body++) {
        double t[TOBI_TOTALS] = { 0 };
        q.point = m->point + n->bins[q.body].item;
        if (n->first[q.body] < n->first[q.body + 1])
            tobi_launch(m->exec, TOBI_HOST(weigh_points, 6, 0), &q, 0, body_of(&q)->point_count, t);
        memcpy(m->still[q.body].f, t, sizeof m->still->f);
    }
    const all u = { &q, m, n };
    tobi_launch(m->exec, TOBI_HOST(grip_bodies, 0, 0), &u, 0, n->count, NULL);
    m->view.link = n->link;
    m->view.grip = m->grip;
    m->view.answer = (const double (*)[6])n->answer;
    return TOBI_OK;
}

/* grip^T p of each body into near.total. */
static void sum_grips(isph_solver *m, tobi_system *s, const double *pressure)
{
    isph_view v = m->view;
    v.in = pressure;
    tobi_boundary_sum(s, m->kernel->isph_grip, &v, 1);
}

void isph_forces_foresee(isph_solver *m, tobi_system *s)
{
    if (!m->coupled) return;
    tobi_boundary_known_forces(s, 1);
    for (int k = 0; k < s->sim->body_count; k++) {
        double f[6];
        for (int a = 0; a < 6; a++) f[a] = sph_of(s)->near.total[k][a] + m->still[k].f[a];
        tobi_couple_foresee(s, k, f);
    }
    isph_bodies_push(m, s, 1);
}

/* Accelerations of the bodies by the pressures of the particles, into near.answer. */
static void answer(isph_solver *m, tobi_system *s, const double *pressure)
{
    sum_grips(m, s, pressure);
    for (int k = 0; k < s->sim->body_count; k++) tobi_couple_answer(s, k, sph_of(s)->near.total[k]);
}

void isph_forces_yield(isph_solver *m, double *product, const double *pressure)
{
    if (!m->coupled) return;
    answer(m, m->system, pressure);
    isph_view v = m->view;
    v.out = product;
    tobi_launch(m->exec, m->kernel->isph_yield, &v, 0, v.count, NULL);
}

void isph_forces_follow(isph_solver *m, tobi_system *s)
{
    if (!m->coupled) return;
    answer(m, s, m->view.solution);
    isph_bodies_push(m, s, s->dt);
}

void isph_forces_press(isph_solver *m, tobi_system *s)
{
    if (s->sim->body_count == 0) return;
    sum_grips(m, s, m->view.solution);
    for (int k = 0; k < s->sim->body_count; k++)
        for (int a = 0; a < 6; a++)
            s->sim->bodies[k].load[s->number].pressure[a] =
                sph_of(s)->near.total[k][a] + m->still[k].f[a];
}

int64_t isph_forces_bytes(const isph_solver *m)
{
    return m->grips*(int64_t)sizeof *m->grip + m->points*(int64_t)sizeof *m->point +
           m->bodies*(int64_t)sizeof *m->still;
}

void isph_forces_free(isph_solver *m)
{
    tobi_array_free(m->grip);
    tobi_array_free(m->point);
    tobi_array_free(m->still);
}
