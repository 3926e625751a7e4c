/* A closed pocket: rows that no chain of neighbours joins to a free surface. Its pressure is free by a
   constant, so that its sources must add up to nothing, as those of a full vessel do. Sources of liquid that
   is a little too dense do not, and conjugate gradients then run away in the constant. So the mean of each
   pocket is taken out of source and pressure. A body around a pocket, or in it, gives way to a constant by
   the error of its quadrature only, which the matrix is not to see. Drawback: a flood over the list on one
   thread in each step of a world that had a pocket once, and no more than six pockets. */
#include "sph/isph/pockets.h"
#include "geom/vec3.h"
#include "sph/soft.h"
#include "sph/state.h"
#include <math.h>
#include <string.h>

/* Marks of rows: 0, joined to a surface, then the pockets. */
enum { OPEN = 0, POCKETS = TOBI_SUMS, UNKNOWN = 255 };

/* Over the largest row: what the matrix makes of a constant by rounding. */
static const double ROUNDING = 1e-9;
/* Over the sum of its pushes: what a uniform pressure makes of a surface that is closed, by few particles. */
static const double CLOSED = 0.1;

/* From the rows of the queue to all that entries join to them. */
static void flood(const isph_solver *m, int32_t *queue, int64_t count, uint8_t mark)
{
    const isph_view *v = &m->view;
    for (int64_t at = 0; at < count; at++) {
        const int64_t i = queue[at], first = 8*(int64_t)v->list_start[i];
        for (int64_t k = first; k < first + 8*v->list_groups[i]; k++) {
            const int32_t j = tobi_list_at(v->list, v->list_far, i, k);
            if (!(v->entry[k] > 0) || m->pocket[j] != UNKNOWN) continue;
            m->pocket[j] = mark;
            queue[count++] = j;
        }
    }
}

/* Rows of no surface, connected: how many there are. */
static int mark_rows(isph_solver *m)
{
    const int64_t n = m->view.count;
    int32_t *queue = (int32_t *)m->work;                    /* free between the solves */
    int64_t surface = 0;
    int count = 0;
    for (int64_t i = 0; i < n; i++) {
        const int open = m->view.excess[i] > 0;
        m->pocket[i] = open ? OPEN : UNKNOWN;
        if (open) queue[surface++] = (int32_t)i;
    }
    flood(m, queue, surface, OPEN);
    for (int64_t i = 0; i < n; i++) {
        if (m->pocket[i] != UNKNOWN) continue;
        m->pocket[i] = (uint8_t)(count < POCKETS ? ++count : OPEN);
        queue[0] = (int32_t)i;
        flood(m, queue, 1, m->pocket[i]);
    }
    return count;
}

static int exceeds_rounding(const isph_solver *m, const double *y)
{
    double most = 0;
    for (int64_t i = 0; i < m->view.count; i++) most = fmax(most, fabs(y[i]));
    return most > ROUNDING*m->view.full;
}

/* Whether a uniform pressure in a pocket pushes a body that moves by forces: one that it goes all around, or
   that goes around it, it does not. */
static int pushes_body(const isph_solver *m, int mark)
{
    const tobi_system *s = m->system;
    const tobi_boundary_links *n = &sph_of(s)->links;
    for (int b = 0; m->coupled && b < s->sim->body_count; b++) {
        double force[3] = { 0 }, all = 0;
        if (s->sim->bodies[b].rigid.kind == TOBI_PRESCRIBED) continue;
        for (int64_t k = n->first[b]; k < n->first[b + 1]; k++) {
            const double *push = m->coupling[k].f;
            if (m->pocket[n->link[k].particle] != mark) continue;
            for (int a = 0; a < 3; a++) force[a] += push[a];
            all += sqrt(vec3_dot(push, push));
        }
        if (sqrt(vec3_dot(force, force)) > CLOSED*all) return 1;
    }
    return 0;
}

/* Whether the matrix sees a constant in a pocket: a body or solid that moves gives way to it. */
static int is_seen(isph_solver *m, const tobi_linear_system *system, int mark)
{
    double *x = (double *)m->work, *y = m->scratch;
    for (int64_t i = 0; i < m->view.count; i++) x[i] = m->pocket[i] == mark;
    system->apply(system->user, y, x);
    if (!exceeds_rounding(m, y)) return 0;
    if (pushes_body(m, mark)) return 1;
    memset(y, 0, (size_t)m->view.count*sizeof *y);
    sph_soft_add_answer(m->system, y, x);
    return exceeds_rounding(m, y);
}

int isph_pockets_find(isph_solver *m, const tobi_linear_system *system)
{
    const isph_view *v = &m->view;
    const int count = mark_rows(m);
    int left = 0;
    memset(m->pocket_rows, 0, sizeof m->pocket_rows);
    for (int k = 1; k <= count; k++) {
        const int seen = is_seen(m, system, k);
        for (int64_t i = 0; i < v->count; i++) {
            if (m->pocket[i] != k) continue;
            if (seen) m->pocket[i] = OPEN;
            else m->pocket_rows[k - 1]++;
        }
        left += !seen;
    }
    for (int64_t i = 0; left > 0 && i < v->count; i++)
        v->solution[i] = v->held && v->held[i].w != 0 ? 0 : v->pressure[i];
    return left;
}

typedef struct pocket_view { const uint8_t *pocket; double *y, mean[POCKETS]; } pocket_view;

static void sum_range(const void *view, int64_t begin, int64_t end, double *totals)
{
    const pocket_view *p = view;
    for (int64_t i = begin; i < end; i++)
        if (p->pocket[i] != OPEN) totals[p->pocket[i] - 1] += p->y[i];
}

static void shift_range(const void *view, int64_t begin, int64_t end, double *totals)
{
    const pocket_view *p = view;
    (void)totals;
    for (int64_t i = begin; i < end; i++)
        if (p->pocket[i] != OPEN) p->y[i] -= p->mean[p->pocket[i] - 1];
}

void isph_pockets_center(void *user, double *y)
{
    const isph_solver *m = user;
    pocket_view p = { m->pocket, y, { 0 } };
    double t[TOBI_TOTALS];
    tobi_launch(m->exec, TOBI_HOST(sum_range, POCKETS, 0), &p, 0, m->view.count, t);
    for (int k = 0; k < POCKETS; k++) p.mean[k] = m->pocket_rows[k] > 0 ? t[k]/(double)m->pocket_rows[k] : 0;
    tobi_launch(m->exec, TOBI_HOST(shift_range, 0, 0), &p, 0, m->view.count, NULL);
}
