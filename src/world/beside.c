/* Bodies, and solids beside a liquid, with periodic sides: the liquid goes through these, bodies and solids
   do not, so that a flap in a channel is possible and a leaf that drifts through is not (decision 79).
   Drawback: whether one comes there is known when it happens, in the middle of a run. */
#include "world/beside.h"
#include "base/error.h"
#include "rigid/lines.h"
#include <stdio.h>

typedef struct sides { const tobi_system *s; double reach; const int *periodic; } sides;

/* The axis along which a particle is too near to a periodic side; -1: none. */
static int near_side(const sides *v, int64_t i)
{
    for (int a = 0; a < v->s->box.dimension; a++) {
        const double at = (&v->s->particles.position[i].x)[a];
        if (v->periodic[a] && !(at >= v->reach && at <= v->s->box.size[a] - v->reach)) return a;
    }
    return -1;
}

static void count_near(const void *view, int64_t begin, int64_t end, double *totals)
{
    for (int64_t i = begin; i < end; i++) totals[0] += near_side(view, i) >= 0;
}

/* A line or a joint leads nowhere far. */
static bool is_held(const tobi_world *w, int body)
{
    bool held = false;
    for (int k = 0; k < w->line_count; k++) held |= w->lines[k].body == body || w->lines[k].to_body == body;
    for (int k = 0; k < w->sim.constraints.count; k++) {
        const int *of = w->sim.constraints.at[k].body;
        held |= of[0] == body || of[1] == body;
    }
    return held;
}

tobi_status tobi_beside_note(tobi_world *w, tobi_error *err)
{
    const tobi_box *box = &w->system[0].box;
    const double spacing = w->system[0].smoothing.spacing;
    for (int k = 0; k < w->sim.body_count; k++) {
        const tobi_body *b = &w->sim.bodies[k];
        double low[3], high[3];
        char text[TOBI_NOTE], axes[8] = "";
        int length = 0;
        if (b->rigid.kind == TOBI_PRESCRIBED || is_held(w, k)) continue;
        tobi_bvh_box(b->bvh, low, high);
        for (int a = 0; a < box->dimension; a++) {
            if (!box->periodic[a] || b->rigid.locked >> a & 1) continue;
            if (low[a] < spacing && high[a] > box->size[a] - spacing) continue;
            if (length) axes[length++] = ',';
            axes[length++] = "xyz"[a];
        }
        if (!length) continue;
        snprintf(text, sizeof text, tr("does not go through the periodic sides along %s: the run ends where "
                 "it comes to one; \"locked\": \"%s\", or a larger domain, keeps it from there\n"), axes,
                 axes);
        TOBI_TRY(tobi_world_add_notes(w, "body", b->name, text, err));
    }
    return TOBI_OK;
}

/* Liquid beyond a side does not see what sticks out there: a raft that drifts through would sink. One that
   reaches from side to side is a wall, and may stick out. */
static tobi_status check_bodies(const tobi_world *w, tobi_error *err)
{
    const tobi_box *box = &w->system[0].box;
    const double spacing = w->system[0].smoothing.spacing, slack = 1e-6*spacing;
    for (int k = 0; k < w->sim.body_count; k++) {
        const tobi_body *b = &w->sim.bodies[k];
        double low[3], high[3];
        if (b->is_absent) continue;
        tobi_bvh_box(b->bvh, low, high);
        for (int a = 0; a < box->dimension; a++) {
            const double size = box->size[a], lower = box->lower[a];
            if (!box->periodic[a] || (low[a] >= -slack && high[a] <= size + slack)) continue;
            if (low[a] < spacing && high[a] > size - spacing) continue;
            return tobi_fail(err, TOBI_UNSUPPORTED, "body '%s' reaches from %c = %.6g to %.6g m; bodies do "
                             "not go through periodic sides, here at %g and %g m, unless they reach from "
                             "side to side; keep it there with \"locked\": \"%c\", or lengthen the domain",
                             b->name, "xyz"[a], low[a] + lower, high[a] + lower, lower, lower + size,
                             "xyz"[a]);
        }
    }
    return TOBI_OK;
}

tobi_status tobi_beside_check(tobi_world *w, tobi_error *err)
{
    const tobi_system *liquid = &w->system[0], *s = w->sim.soft.solids;
    const int *periodic = liquid->box.periodic;
    const sides v = { s, liquid->smoothing.h, periodic };
    double t[TOBI_TOTALS] = { 0 };
    if (!(periodic[0] || periodic[1] || periodic[2])) return TOBI_OK;
    TOBI_TRY(check_bodies(w, err));
    if (!s) return TOBI_OK;
    TOBI_TRY(tobi_exec_reserve(&w->sim.exec, s->particles.count, err));      /* the systems start later */
    tobi_launch(&w->sim.exec, TOBI_HOST(count_near, 1, 0), &v, 0, s->particles.count, t);
    for (int64_t i = 0; t[0] > 0 && i < s->particles.count; i++) {
        const int a = near_side(&v, i);
        if (a < 0) continue;
        return tobi_fail(err, TOBI_UNSUPPORTED, "solid '%s' comes to %c = %.6g m; solids do not go "
                         "through periodic sides, and stay %.3g m away from them",
                         s->solids[s->particles.fluid[i]].name, "xyz"[a],
                         (&s->particles.position[i].x)[a] + s->box.lower[a], v.reach);
    }
    return TOBI_OK;
}
