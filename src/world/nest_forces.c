/* A nest moves the bodies of the outer world: those that move by forces feel in the next outer step what its
   liquid pressed them with more than the outer liquid (docs/decisions/0158-nests-move-bodies.md). Drawback:
   it comes some steps late. */
#include "world/nest.h"
#include "base/error.h"
#include "geom/vec3.h"
#include "rigid/dynamics.h"
#include "world/bodies.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of the difference, taken over in each step: the outer answer to a force is partly a step late, and with all
   of it a light plate would swing ever more. */
static const double SHARE = 0.2;

/* N, N m about the centre: of the liquid in the last step. */
static void find_press(const tobi_body *b, double press[6])
{
    vec3_add_scaled(press, b->info.pressure_force, 1, b->info.viscous_force);
    vec3_add_scaled(press + 3, b->info.pressure_torque, 1, b->info.viscous_torque);
}

/* From the centre that the nest knows of a body that deforms to its centre of mass. */
static void move_torque(const tobi_world *w, int k, double press[6])
{
    const tobi_simulation *outer = w->sim.nest.outer->sim;
    const tobi_rigid *r = &outer->bodies[k].rigid;
    double arm[3], more[3];
    vec3_sub(arm, w->sim.bodies[k].rigid.position, r->position);
    vec3_add_scaled(arm, arm, outer->time - w->sim.time, r->velocity);
    vec3_cross(more, arm, press);
    vec3_add_scaled(press + 3, press + 3, 1, more);
}

tobi_status tobi_nest_tally(tobi_world *w, tobi_error *err)
{
    const tobi_simulation *s = &w->sim;
    if (!s->nest.outer || s->body_count == 0 || w->system[0].method->nests < 2) return TOBI_OK;
    if (!w->pressed) w->pressed = calloc((size_t)s->body_count, sizeof *w->pressed);
    if (!w->pressed) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a nest");
    for (int k = 0; k < s->body_count; k++) {
        double press[6];
        find_press(&s->bodies[k], press);
        if (s->bodies[k].deforms) move_torque(w, k, press);
        for (int a = 0; a < 6; a++) w->pressed[k][a] += s->dt*press[a];
    }
    w->pressed_for += s->dt;
    return TOBI_OK;
}

/* Liquid all around it is that of the nest. */
static int is_within(const tobi_nest *n, int dimension, const tobi_body *b)
{
    if (b->is_absent) return 0;
    for (int64_t v = 0; v < b->mesh.vertex_count; v++)
        if (tobi_nest_outside(n, dimension, b->vertex[v]) > 0) return 0;
    return 1;
}

/* The finest nest around a body moves it; of two as fine, the one that does so already. */
static int gives_way(const tobi_world *nest, const tobi_world *outer, const tobi_rigid *r)
{
    const tobi_world *by = tobi_nest_numbered(outer, r->finer_by);
    return by && by != nest && by->system[0].smoothing.spacing <= nest->system[0].smoothing.spacing;
}

void tobi_nest_let_go(tobi_world *nest)
{
    static const double none[6] = { 0 };
    tobi_world *outer = nest->outer;
    for (int k = 0; k < outer->sim.body_count; k++) {
        tobi_rigid *r = &outer->sim.bodies[k].rigid;
        if (r->finer_by != nest->sim.nest.number) continue;
        tobi_rigid_set_finer(outer->dynamics, k, none);
        r->finer_by = 0;
    }
}

void tobi_nest_press(tobi_world *nest, tobi_world *outer)
{
    const tobi_nest *n = &nest->sim.nest;
    const double t = nest->pressed_for;
    if (!(t > 0)) return;
    for (int k = 0; k < outer->sim.body_count && k < nest->sim.body_count; k++) {
        tobi_body *b = &outer->sim.bodies[k];
        tobi_rigid *r = &b->rigid;
        double finer[6] = { 0 }, here[6];
        if (r->kind == TOBI_PRESCRIBED || gives_way(nest, outer, r)) continue;
        const int within = is_within(n, nest->sim.def.dimension, b);
        if (!within && r->finer_by != n->number) continue;
        find_press(b, here);
        for (int a = 0; a < 6 && within; a++)
            finer[a] = r->finer[a] + SHARE*(nest->pressed[k][a]/t - here[a] - r->finer[a]);
        tobi_rigid_set_finer(outer->dynamics, k, finer);
        r->finer_by = within ? n->number : 0;
    }
    memset(nest->pressed, 0, (size_t)nest->sim.body_count*sizeof *nest->pressed);
    nest->pressed_for = 0;
}
