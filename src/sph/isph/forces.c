/* What the pressure of isph does to bodies, and how those that move by forces answer it within the solve. The
   force is linear in the pressures of the particles: its coefficients, the couplings, are found once per
   step. The answer spreads the flux of a surface that moves by the same coefficients, which keeps the matrix
   symmetric (decisions 49, 102). Drawback: that flux and the one of the mirrors are the same on average
   only. */
#include "sph/boundary/boundary.h"
#include "sph/isph/carry.h"
#include "sph/isph/forces.h"
#include "sph/isph/gaps.h"
#include "sph/isph/shape.h"
#include "sph/porous_carry.h"
#include "sph/state.h"
#include "geom/matrix6.h"
#include "geom/vec3.h"
#include <math.h>
#include <string.h>

/* Share of the kernel with particles in it below which a point of a body is dry. */
static const double DRY = 0.1;

/* A body's points, and the particles around them. */
typedef struct body_points {
    const tobi_system *s;
    const isph_view *v;
    int body;
    isph_point *point;               /* of the body                                                 */
    const isph_body *all;            /* bodies                                                      */
    int holds;                       /* 1: a body holds a solid, and points know their share `held` */
    double scale;                    /* m3, on W                                                    */
    double share[TOBI_MAX_FLUIDS];   /* 1: density of each fluid over that of the first             */
} body_points;

static const tobi_body *body_of(const body_points *q) { return &q->s->sim->bodies[q->body]; }

/* Particles before point k and the pressure that liquid at rest has there beyond theirs. Empties the list. */
static void add_particles(const body_points *q, int64_t k, const double pull[3], tobi_facing_points *l,
                          isph_point *sum)
{
    const isph_view *v = q->v;
    const double *from = body_of(q)->point[k];
    tobi_facing_weigh(l, &q->s->smoothing);
    for (int i = 0; i < l->count; i++) {
        const double *at = &v->position[l->index[i]].x;
        const double w = q->scale*l->weight[i], heavy = w*q->share[v->fluid[l->index[i]]];
        sum->weight += w;
        sum->distance += heavy*l->height[i];
        for (int a = 0; a < v->dimension; a++) sum->hydrostatic -= heavy*v->density*pull[a]*(at[a] - from[a]);
    }
    l->count = 0;
}

/* Rows of the cells around x: *first to *end of the particles; 0: the row is outside. */
static int find_row(const tobi_cells *c, const double x[3], int y, int z, int64_t *first, int64_t *end)
{
    const int at[3] = { (int)floor(x[0]*c->inverse[0]), (int)floor(x[1]*c->inverse[1]) + y,
                        (int)floor(x[2]*c->inverse[2]) + z };
    const int low = at[0] > 0 ? at[0] - 1 : 0, high = at[0] + 1 < c->n[0] ? at[0] + 1 : c->n[0] - 1;
    if (at[1] < 0 || at[1] >= c->n[1] || at[2] < 0 || at[2] >= c->n[2] || low > high) return 0;
    const int64_t row = tobi_cells_row(c, at[1], at[2]);
    *first = c->start[row + low];
    *end = c->start[row + high + 1];
    return 1;
}

static isph_point sum_particles(const body_points *q, int64_t k)
{
    const isph_view *v = q->v;
    const tobi_body *b = body_of(q);
    const tobi_look_loops *loops = sph_of(q->s)->links.loops;
    const int deep = v->dimension == 3;
    const double h = q->s->smoothing.h;
    double x[3] = { 0 }, pull[3] = { 0 };
    isph_point sum = { 0 };
    tobi_facing_points list;
    list.count = 0;
    for (int a = 0; a < v->dimension; a++) x[a] = b->point[k][a];
    if (v->acceleration.acts) tobi_acceleration_at(&v->acceleration, b->point[k], pull);
    for (int a = 0; a < 3; a++) pull[a] += v->gravity[a];
    for (int z = -deep; z <= deep; z++)
        for (int y = -1; y <= 1; y++) {
            int64_t i, end;
            if (!find_row(&q->s->cells, x, y, z, &i, &end)) continue;
            while (i < end) {
                const int64_t room = i + TOBI_FACING_MOST - list.count, stop = end < room ? end : room;
                loops->list_places(v->position, i, stop, b->point[k], b->normal[k], deep, h*h, &list);
                i = stop;
                if (list.count == TOBI_FACING_MOST) add_particles(q, k, pull, &list, &sum);
            }
        }
    add_particles(q, k, pull, &list, &sum);
    return sum;
}

/* What a row of the solids hides of the points of the body that holds it, where it is outside the body. */
typedef struct hiding { body_points q; double volume; } hiding;

static void hide_points(void *user, tobi_facing_points *l)
{
    const hiding *g = user;
    tobi_facing_weigh(l, &g->q.s->smoothing);
    for (int i = 0; i < l->count; i++) {                /* whole numbers: the same sum in any order */
        const uint32_t more = (uint32_t)(2*g->volume*l->weight[i]*TOBI_COVERED);
        __atomic_fetch_add(&g->q.point[tobi_facing_point(l, i)->number].held, more, __ATOMIC_RELAXED);
    }
}

typedef struct held_view { const tobi_system *s; isph_solver *m; } held_view;

static void hide_held(const void *view, int64_t begin, int64_t end, double *totals)
{
    const held_view *u = view;
    const tobi_soft *soft = &u->s->sim->soft;
    const tobi_boundary_links *n = &sph_of(u->s)->links;
    (void)totals;
    for (int64_t k = begin; k < end; k++) {
        const tobi_solid *solid = &soft->solids->solids[soft->solids->particles.fluid[k]];
        const tobi_double3 *at = &soft->position[k];
        const double x[3] = { at->x, at->y, at->z };
        for (int c = 0; c < solid->clamp_count && soft->size[k].volume > 0; c++) {
            const int body = solid->clamp[c];
            hiding g = { { .s = u->s, .point = u->m->point + n->bins[body].item }, soft->size[k].volume };
            tobi_boundary_take_facing(n, body, x, u->s->smoothing.h, hide_points, &g);
        }
    }
}

static void clear_held(const void *view, int64_t begin, int64_t end, double *totals)
{
    const held_view *u = view;
    (void)totals;
    for (int64_t k = begin; k < end; k++) u->m->point[k].held = 0;
}

/* Where a body holds a solid, no water presses on it. Else body and solid together, which are closed, would
   feel a uniform pressure. Returns 1 where any does. */
static int find_held(isph_solver *m, tobi_system *s)
{
    const tobi_soft *soft = &s->sim->soft;
    const held_view u = { s, m };
    int any = 0;
    for (int k = 0; soft->solids && k < soft->solids->solid_count; k++)
        any |= soft->solids->solids[k].clamp_count > 0;
    if (!any) return 0;
    const int64_t points = sph_of(s)->links.bins[s->sim->body_count].item;
    tobi_launch(m->exec, TOBI_HOST(clear_held, 0, 0), &u, 0, points, NULL);
    tobi_launch(m->exec, TOBI_HOST(hide_held, 0, 0), &u, 0, soft->count, NULL);
    return 1;
}

/* totals: the force of what pressure the surface has beyond that of the particles: of water at rest, and of
   that which the surface of a driven body accelerates. Points that no particle sees are left out. */
static void weigh_points(const void *view, int64_t begin, int64_t end, double *totals)
{
    const body_points *q = view;
    const tobi_body *b = body_of(q);
    for (int64_t k = begin; k < end; k++) {
        isph_point *p = &q->point[k];
        const uint32_t hidden = q->holds ? p->held : 0;
        const double held = hidden/TOBI_COVERED;
        *p = b->area[k] > 0 && b->wet[k] ? sum_particles(q, k) : (isph_point){ 0 };
        p->held = hidden;
        p->weight = p->weight > 0 && p->weight + 0.5*held > DRY && held < 1 ? p->weight/(1 - held) : INFINITY;
        const double along = tobi_body_point_acceleration(b, k, q->v->dt);
        const double more = p->hydrostatic + q->v->density*p->distance*along;
        isph_bodies_push(b, k, -b->area[k]*more/p->weight, totals);
    }
}

/* A particle's look at the points of one body. */
typedef struct coupling_sum { body_points q; isph_coupling coupling; } coupling_sum;

static void add_coupling(void *user, tobi_facing_points *l)
{
    coupling_sum *g = user;
    const tobi_body *b = body_of(&g->q);
    tobi_facing_weigh(l, &g->q.s->smoothing);
    for (int i = 0; i < l->count; i++) {
        const int32_t k = tobi_facing_point(l, i)->number;
        const double w = g->q.scale*l->weight[i], all = g->q.point[k].weight;
        double push[6] = { 0 };
        if (!(w > 0 && all < INFINITY)) continue;
        isph_bodies_push(b, k, -b->area[k]*w/all, g->coupling.f);
        isph_gaps_add(&g->q.all[g->q.body], b, g->q.point, k, push);
        for (int a = 0; a < 6; a++) g->coupling.f[a] -= push[a]*w/all;
    }
}

typedef struct coupling_view {
    const body_points *q;
    isph_solver *m;
    const tobi_boundary_links *n;
} coupling_view;

static void find_couplings(const void *view, int64_t begin, int64_t end, double *totals)
{
    const coupling_view *u = view;
    (void)totals;
    for (int64_t k = begin; k < end; k++) {
        const tobi_boundary_link *l = &u->n->link[k];
        const tobi_double3 *at = &u->q->v->position[l->particle];
        const double x[3] = { at->x, at->y, at->z };
        coupling_sum g = { .q = *u->q };
        g.q.body = l->body;
        g.q.point = u->m->point + u->n->bins[l->body].item;
        tobi_boundary_take_facing(u->n, l->body, x, g.q.s->smoothing.h, add_coupling, &g);
        u->m->coupling[k] = g.coupling;
    }
}

/* A particle's look at the rims of the gaps between one body and the sides. */
typedef struct gap_sum { body_points q; double force[3]; } gap_sum;

static void add_gaps(void *user, tobi_facing_points *l)
{
    gap_sum *g = user;
    const isph_body *body = &g->q.all[g->q.body];
    tobi_facing_weigh(l, &g->q.s->smoothing);
    for (int i = 0; i < l->count; i++) {
        const int32_t k = tobi_facing_point(l, i)->number;
        const isph_point *p = &g->q.point[k];
        if (p->weight < INFINITY)
            isph_gaps_add_side(body, body_of(&g->q), p, k, g->q.scale*l->weight[i]/p->weight, g->force);
    }
}

/* totals: force of the pressure in gaps on what closes them, as far as it comes from the particles. */
static void sum_gaps(const void *view, int64_t begin, int64_t end, double *totals)
{
    const coupling_view *u = view;
    for (int64_t k = begin; k < end; k++) {
        const tobi_boundary_link *l = &u->n->link[k];
        const tobi_double3 *at = &u->q->v->position[l->particle];
        const double x[3] = { at->x, at->y, at->z }, p = u->q->v->pressure[l->particle];
        gap_sum g = { .q = *u->q };
        if (!u->m->body[l->body].gaps) continue;
        g.q.body = l->body;
        g.q.point = u->m->point + u->n->bins[l->body].item;
        tobi_boundary_take_facing(u->n, l->body, x, g.q.s->smoothing.h, add_gaps, &g);
        for (int a = 0; a < 3; a++) totals[a] += g.force[a]*p;
    }
}

/* Sides under a gap feel the opposite of the body: no particle is there to press them. */
static void load_sides(isph_solver *m, tobi_system *s)
{
    const tobi_boundary_links *n = &sph_of(s)->links;
    const body_points q = { .s = s, .v = &m->view, .all = m->body,
                            .scale = s->smoothing.volume*s->smoothing.weight_correction };
    const coupling_view u = { &q, m, n };
    double t[TOBI_TOTALS] = { 0 };
    int gaps = 0;
    for (int k = 0; k < s->sim->body_count; k++) {
        gaps |= m->body[k].gaps;
        for (int a = 0; a < 3; a++) s->info.wall_force[a] -= m->body[k].gap_rest[a];
    }
    if (!gaps) return;
    tobi_launch(m->exec, TOBI_HOST(sum_gaps, 3, 0), &u, 0, n->count, t);
    for (int a = 0; a < 3; a++) s->info.wall_force[a] -= t[a];
}

static tobi_status reserve(isph_solver *m, const tobi_boundary_links *n, int bodies, tobi_error *err)
{
    const int64_t links = n->count, points = n->bins[bodies].item;
    if (links > m->couplings) {
        isph_coupling *more = tobi_array_grow(m->coupling, 0, links + links/2 + 64, sizeof *more);
        if (!more) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld couplings", (long long)links);
        m->coupling = more;
        m->couplings = links + links/2 + 64;
    }
    if (points > m->points) {
        isph_point *more = tobi_array_grow(m->point, 0, points, sizeof *more);
        if (!more) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld points", (long long)points);
        m->point = more;
        m->points = points;
    }
    if (bodies > m->bodies) {
        isph_body *more = tobi_array_grow(m->body, 0, bodies, sizeof *more);
        if (!more) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %d bodies", bodies);
        m->body = more;
        m->bodies = bodies;
    }
    return TOBI_OK;
}

tobi_status isph_forces_find_coupling(isph_solver *m, tobi_system *s, tobi_error *err)
{
    const tobi_boundary_links *n = &sph_of(s)->links;
    const tobi_smoothing_constants *c = &s->smoothing;
    const int bodies = s->sim->body_count;
    if (bodies == 0) return TOBI_OK;
    TOBI_TRY(reserve(m, n, bodies, err));
    body_points q = { .s = s, .v = &m->view, .all = m->body, .holds = find_held(m, s),
                      .scale = c->volume*c->weight_correction };
    for (int f = 0; f < s->fluid_count; f++) q.share[f] = s->fluid[f].density/m->view.density;
    tobi_boundary_find_neighbors(s);
    for (q.body = 0; q.body < bodies; q.body++) {
        double t[TOBI_TOTALS] = { 0 };
        q.point = m->point + n->bins[q.body].item;
        if (n->first[q.body] < n->first[q.body + 1] || s->sim->soft.solids)
            tobi_launch(m->exec, TOBI_HOST(weigh_points, 6, 0), &q, 0, body_of(&q)->point_count, t);
        isph_gaps_find(m, s, q.body, q.point, t);
        memcpy(m->body[q.body].rest_force, t, sizeof m->body->rest_force);
    }
    const coupling_view u = { &q, m, n };
    tobi_launch(m->exec, TOBI_HOST(find_couplings, 0, 0), &u, 0, n->count, NULL);
    m->view.link = n->link;
    m->view.coupling = m->coupling;
    m->view.answer = (const double (*)[6])n->answer;
    return TOBI_OK;
}

/* coupling^T p of each body into links.total. */
static void sum_body_forces(isph_solver *m, tobi_system *s, const double *pressure)
{
    isph_view v = m->view;
    v.in = pressure;
    tobi_boundary_sum(s, m->kernel->isph_body_force, &v, 1);
}

/* A column of the inertia of the water between particles and surface, eq. (14). */
typedef struct column { body_points q; int number; } column;

static void sum_column(const void *view, int64_t begin, int64_t end, double *totals)
{
    const column *c = view;
    const tobi_body *b = body_of(&c->q);
    for (int64_t k = begin; k < end; k++) {
        const isph_point *p = &c->q.point[k];
        double lever[6];
        isph_bodies_lever(b, k, lever);
        const double mass = c->q.v->density*b->area[k]*p->distance/p->weight*lever[c->number];
        for (int a = 0; a < 6; a++) totals[a] += mass*lever[a];
    }
}

static void find_added_mass(isph_solver *m, tobi_system *s, int k)
{
    const tobi_boundary_links *n = &sph_of(s)->links;
    column c = { { .s = s, .v = &m->view, .body = k, .point = m->point + n->bins[k].item }, 0 };
    double t[TOBI_TOTALS] = { 0 };
    for (; c.number < 6; c.number++) {
        if (n->first[k] < n->first[k + 1])
            tobi_launch(m->exec, TOBI_HOST(sum_column, 6, 0), &c, 0, s->sim->bodies[k].point_count, t);
        for (int a = 0; a < 6; a++) m->body[k].added_mass[a][c.number] = t[a];
    }
}

/* added_mass_factor = (1 + M^-1 (K + S))^-1, S the drag of zones that the body carries, NULL: none. */
static void find_added_mass_factor(const tobi_rigid *r, const tobi_porous *zone, isph_body *b)
{
    double x[6][6];
    for (int j = 0; j < 6; j++) {
        double column[6], moved[6];
        for (int i = 0; i < 6; i++) column[i] = b->added_mass[i][j] + (zone ? zone->answer.drag[i][j] : 0);
        tobi_rigid_answer(r, column, moved);
        for (int i = 0; i < 6; i++) x[i][j] = moved[i] + (i == j);
    }
    matrix6_invert(x, b->added_mass_factor);
}

static void find_mobility(const tobi_rigid *r, isph_body *b)
{
    for (int j = 0; j < 6; j++) {
        double force[6] = { 0 }, moved[6];
        force[j] = 1;
        tobi_rigid_answer(r, force, moved);
        matrix6_multiply((const double (*)[6])b->added_mass_factor, moved);
        for (int i = 0; i < 6; i++) b->mobility[i][j] = moved[i];
    }
}

/* What the body would change without the water at its surface, as an acceleration from the last step's
   velocities on, less what that water takes of it. */
static void predict(isph_solver *m, tobi_system *s, int k)
{
    const tobi_rigid *r = &s->sim->bodies[k].rigid;
    isph_body *b = &m->body[k];
    double f[6], *answer = sph_of(s)->links.answer[k];
    for (int a = 0; a < 6; a++) f[a] = sph_of(s)->links.total[k][a] + b->rest_force[a];
    isph_carry_add_known(m, s, k, f);
    tobi_couple_predict(s, k, f);
    if (r->kind == TOBI_PRESCRIBED) return;
    find_added_mass(m, s, k);
    find_added_mass_factor(r, sph_porous_of(s, k), b);
    for (int a = 0; a < 6; a++) {
        const double now = a < 3 ? r->velocity[a] : r->angular_velocity[a - 3];
        f[a] = now + answer[a] - r->before[a];
        b->explicit_change[a] = r->before[a] - now;
    }
    matrix6_multiply((const double (*)[6])b->added_mass_factor, f);
    for (int a = 0; a < 6; a++) answer[a] = b->explicit_change[a] += f[a];
}

/* Joints between bodies: W is (M + K)^-1. */
static void join(isph_solver *m, tobi_system *s)
{
    tobi_constraints *c = &s->sim->constraints;
    if (c->count == 0) return;
    for (int k = 0; k < c->slots; k++) {
        isph_body *b = &m->body[c->body[k]];
        find_mobility(&s->sim->bodies[c->body[k]].rigid, b);
        memcpy(c->inverse[k], b->mobility, sizeof b->mobility);
    }
    tobi_constraints_factor(c, s->sim->bodies);
    memset(c->impulse, 0, (size_t)c->rows*sizeof *c->impulse);
    tobi_couple_obey(s, 1);
    tobi_motors_know(c);
    for (int k = 0; k < c->slots; k++)
        memcpy(m->body[c->body[k]].explicit_change, sph_of(s)->links.answer[c->body[k]],
               sizeof m->body->explicit_change);
}

/* Accelerations of the bodies by the pressures of the particles, into links.answer. */
static void answer(isph_solver *m, tobi_system *s, const double *pressure)
{
    sum_body_forces(m, s, pressure);
    for (int k = 0; k < s->sim->body_count; k++) {
        isph_carry_press(m, s, k, pressure, sph_of(s)->links.total[k]);
        tobi_couple_answer(s, k, sph_of(s)->links.total[k]);
        if (s->sim->bodies[k].rigid.kind != TOBI_PRESCRIBED)
            matrix6_multiply((const double (*)[6])m->body[k].added_mass_factor, sph_of(s)->links.answer[k]);
    }
    tobi_couple_obey(s, 0);
}

static void take_last_pressure(const void *view, int64_t begin, int64_t end, double *totals)
{
    const isph_view *v = view;
    (void)totals;
    for (int64_t i = begin; i < end; i++)
        v->solution[i] = v->held && v->held[i].w != 0 ? 0 : v->pressure[i];
}

/* Mirrors, and the liquid in zones, move on with the bodies by a share of links.answer. */
static void move_on(isph_solver *m, tobi_system *s, double share)
{
    isph_bodies_accelerate(m, s, share);
    isph_carry_move(s, share);
}

/* Mirrors move as the pressure of the last step lets the bodies move. The solve answers the rest, so that the
   couplings spread little of the flux (decision 102). */
void isph_forces_predict(isph_solver *m, tobi_system *s)
{
    if (!m->coupled) return;
    tobi_boundary_known_forces(s, 1);
    for (int k = 0; k < s->sim->body_count; k++) predict(m, s, k);
    join(m, s);
    move_on(m, s, 1);
    tobi_launch(m->exec, TOBI_HOST(take_last_pressure, 0, 0), &m->view, 0, m->view.count, NULL);
    answer(m, s, m->view.solution);
    for (int k = 0; k < s->sim->body_count; k++)
        memcpy(m->body[k].expected, sph_of(s)->links.answer[k], sizeof m->body->expected);
    move_on(m, s, s->dt);
    isph_bodies_refresh_images(m);
}

/* What isph_forces_predict gave the mirrors is taken back. */
int isph_forces_overrun(isph_solver *m, tobi_system *s)
{
    tobi_constraints *c = &s->sim->constraints;
    double (*now)[6] = sph_of(s)->links.answer;
    if (!m->coupled || !tobi_motors_bounded(c)) return 0;
    memset(c->impulse, 0, (size_t)c->rows*sizeof *c->impulse);
    answer(m, s, m->view.solution);
    if (!tobi_motors_overrun(c, s->dt)) return 0;
    for (int k = 0; k < s->sim->body_count; k++) memcpy(now[k], m->body[k].explicit_change, sizeof now[k]);
    move_on(m, s, -1);
    for (int k = 0; k < s->sim->body_count; k++) memcpy(now[k], m->body[k].expected, sizeof now[k]);
    move_on(m, s, -s->dt);
    return 1;
}

static void add_spread(isph_solver *m, double *rows)
{
    isph_view v = m->view;
    v.out = rows;
    tobi_launch(m->exec, m->kernel->isph_add_answer, &v, 0, v.count, NULL);
    isph_carry_spread(m, m->system, rows);
}

void isph_forces_add_expected(isph_solver *m)
{
    const tobi_system *s = m->system;
    if (!m->coupled) return;
    for (int k = 0; k < s->sim->body_count; k++)
        memcpy(sph_of(s)->links.answer[k], m->body[k].expected, sizeof m->body->expected);
    add_spread(m, m->view.source);
}

void isph_forces_add_answer(isph_solver *m, double *product, const double *pressure)
{
    if (!m->coupled) return;
    answer(m, m->system, pressure);
    add_spread(m, product);
}

/* totals[0]: trace of what a body adds to the equation, over its diagonal. */
static void trace_answer(const void *view, int64_t begin, int64_t end, double *totals)
{
    const isph_solver *m = view;
    const isph_view *v = &m->view;
    for (int64_t k = begin; k < end; k++) {
        const double *c = m->coupling[k].f;
        double moved[6];
        if (m->system->sim->bodies[v->link[k].body].rigid.kind == TOBI_PRESCRIBED) continue;
        memcpy(moved, c, sizeof moved);
        matrix6_multiply((const double (*)[6])m->body[v->link[k].body].mobility, moved);
        for (int a = 0; a < 6; a++)
            totals[0] += v->density/v->volume*v->inverse_diagonal[v->link[k].particle]*c[a]*moved[a];
    }
}

double isph_forces_answer_bound(isph_solver *m)
{
    tobi_system *s = m->system;
    double most = 0;
    if (!m->coupled) return 0;
    for (int k = 0; k < s->sim->body_count; k++) {
        const tobi_rigid *r = &s->sim->bodies[k].rigid;
        if (r->kind != TOBI_PRESCRIBED) find_mobility(r, &m->body[k]);
    }
    tobi_boundary_sum(s, TOBI_HOST(trace_answer, 1, 0), m, 1);
    for (int k = 0; k < s->sim->body_count; k++)
        most = fmax(most, sph_of(s)->links.total[k][0] + isph_carry_trace(m, s, k));
    return most;
}

/* Mirrors have the expected part already. */
void isph_forces_correct(isph_solver *m, tobi_system *s)
{
    if (!m->coupled) return;
    answer(m, s, m->view.solution);
    double (*now)[6] = sph_of(s)->links.answer;
    for (int k = 0; k < s->sim->body_count; k++)
        for (int a = 0; a < 6; a++) now[k][a] -= m->body[k].expected[a];
    move_on(m, s, s->dt);
    isph_bodies_refresh_images(m);
    for (int k = 0; k < s->sim->body_count; k++)
        for (int a = 0; a < 6; a++) now[k][a] += m->body[k].expected[a];
}

/* Less what the water at the surface of a body takes that moves by forces: eq. (14). */
static void remove_added_mass(const isph_solver *m, const tobi_system *s, int k, double f[6])
{
    const tobi_rigid *r = &s->sim->bodies[k].rigid;
    isph_body *b = &m->body[k];
    double a[6];
    memset(b->taken, 0, sizeof b->taken);
    if (r->kind == TOBI_PRESCRIBED) return;
    for (int i = 0; i < 6; i++) {
        const double now = i < 3 ? r->velocity[i] : r->angular_velocity[i - 3];
        a[i] = (now + b->explicit_change[i] - r->before[i])/s->dt + sph_of(s)->links.answer[k][i];
    }
    memcpy(b->taken, a, sizeof a);
    matrix6_multiply((const double (*)[6])b->added_mass, a);
    for (int i = 0; i < 6; i++) f[i] -= a[i];
}

void isph_forces_load(isph_solver *m, tobi_system *s)
{
    if (s->sim->body_count == 0) return;
    sum_body_forces(m, s, m->view.solution);
    for (int k = 0; k < s->sim->body_count; k++) {
        double *f = s->sim->bodies[k].load[s->number].pressure;
        for (int a = 0; a < 6; a++) f[a] = sph_of(s)->links.total[k][a] + m->body[k].rest_force[a];
        remove_added_mass(m, s, k, f);
    }
    load_sides(m, s);
    isph_shape_load(m, s);
}

int64_t isph_forces_bytes(const isph_solver *m)
{
    return m->couplings*(int64_t)sizeof *m->coupling + m->points*(int64_t)sizeof *m->point +
           m->bodies*(int64_t)sizeof *m->body;
}

void isph_forces_free(isph_solver *m)
{
    tobi_array_free(m->coupling);
    tobi_array_free(m->point);
    tobi_array_free(m->body);
}
