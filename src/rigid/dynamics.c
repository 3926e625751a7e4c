/* One step of all bodies: forces, then contacts by impulses, at the time step of the world. Drawback:
   contacts between two steps are seen at the next. */
#include "rigid/dynamics.h"
#include "geom/vec3.h"
#include "rigid/control.h"
#include "rigid/dynamics_state.h"
#include <stdlib.h>
#include <string.h>

#define PLASTIC 3.0          /* times gravity and step: slower approaches do not bounce                 */
#define SAGITTA 0.3          /* of the least thickness: twice what a corner's arc may leave its chord     */
#define FLOW 0.3             /* of the least thickness: what a change of shape may move a surface by    */
#define LONGEST (1.0/60)     /* s: a step of small bodies                                               */
#define FALL 0.1             /* sqrt(thickness/g), of the thinnest: one of large bodies                 */
#define PLASTIC_LEAST 1e-3   /* m/s, the same without gravity                                           */

/* --- start and end ----------------------------------------------------------------------------- */

double tobi_rigid_step_limit(const tobi_dynamics_state *d)
{
    double g = vec3_length(d->world.gravity), limit = LONGEST;
    if (g > 0 && d->thinnest < INFINITY)             /* ships may take longer steps than their models */
        limit = fmax(limit, FALL*sqrt(d->thinnest/g));
    for (int k = 0; k < d->count; k++) {
        const tobi_rigid *r = &d->bodies[k].rigid;
        const double flow = d->shapes[k].solid ? d->shapes[k].flow_speed : 0;
        limit = fmin(limit, FLOW*d->thinnest/(flow + 1e-30));
        if (r->kind == TOBI_PRESCRIBED) continue;
        double turn = sqrt(SAGITTA*d->thinnest/d->shapes[k].facets.reach);
        limit = fmin(limit, fmin(turn, 0.5)/(vec3_length(r->angular_velocity) + 1e-9));
        if (g > 0) limit = fmin(limit, 0.25*sqrt(d->shapes[k].thickness/g));
        limit = fmin(limit, tobi_joint_step_limit(r));
    }
    limit = fmin(limit, tobi_constraints_step_limit(d->world.constraints, d->bodies));
    return fmin(limit, tobi_lines_step_limit(d->world.lines, d->world.line_count, d->bodies));
}

void tobi_rigid_free(tobi_dynamics_state *d)
{
    if (!d) return;
    for (int k = 0; d->part && k < d->world.threads; k++) free(d->part[k].at);
    free(d->part);
    for (int k = 0; k < d->count; k++) tobi_facets_free(&d->shapes[k].facets);
    free(d->shapes);
    tobi_broad_free(&d->broad);
    free(d->contacts.at);
    free(d->before.at);
    tobi_solver_free(&d->solver);
    free(d);
}

/* --- the kick ---------------------------------------------------------------------------------- */

void tobi_rigid_follow(tobi_dynamics_state *d)
{
    for (int k = 0; k < d->world.line_count; k++) tobi_line_update(&d->world.lines[k], d->bodies);
    tobi_constraints_update_springs(d->world.constraints, d->bodies);
    for (int k = 0; k < d->count; k++) tobi_shape_follow(&d->shapes[k], &d->bodies[k]);
}

/* Of lines, and of springs and dampers of joints. */
static void add_loads(const tobi_dynamics_state *d, int body, tobi_line_when when, tobi_line_load *load)
{
    const double now = when == TOBI_LINES_NOW ? 1 : when == TOBI_LINES_MEAN ? 0.5 : 0;
    tobi_lines_add(d->world.lines, d->world.line_count, body, when, load);
    tobi_constraints_add_springs(d->world.constraints, body, now, when == TOBI_LINES_MEAN ? 0.5 : 0,
                                 when != TOBI_LINES_NOW, load->force, load->torque);
}

/* Of a body with a joint: along its one coordinate. */
static void kick_joint(const tobi_dynamics_state *d, tobi_body *b, double dt, const double impulse[6])
{
    const double none[6] = { 0 };
    double damped[6];
    tobi_line_load damping = { 0 };
    add_loads(d, (int)(b - d->bodies), TOBI_LINES_DAMPING, &damping);
    memcpy(damped, damping.force, sizeof damping.force);
    memcpy(damped + 3, damping.torque, sizeof damping.torque);
    tobi_joint_kick(&b->rigid, dt, impulse, damped);
    tobi_joint_stop(&b->rigid, dt, PLASTIC, none);
}

/* Velocities after all forces but contact (R.5). Air resistance acts on what the other forces made. Liquid
   and solids pushed a body that was held as one that cannot give way: let go now, it does not take their
   impulse, or the weight of all that it carried would throw it. */
static tobi_status kick(tobi_dynamics_state *d, tobi_body *b, double t, double dt, tobi_error *err)
{
    tobi_rigid *r = &b->rigid;
    double force[3], torque[3], keep = tobi_rigid_keep(r, dt), span = r->span > 0 ? r->span : dt;
    double hold = r->hold;
    memcpy(force, r->force, sizeof force);
    memcpy(torque, r->torque, sizeof torque);
    if (r->control) TOBI_TRY(tobi_control_run(d, b, t, dt, force, torque, &hold, err));
    memcpy(r->given, force, sizeof force);
    memcpy(r->given + 3, torque, sizeof torque);
    vec3_add_scaled(force, force, 1, r->inertial);
    vec3_add_scaled(torque, torque, 1, r->inertial + 3);
    vec3_add_scaled(force, force, 1, r->finer);
    vec3_add_scaled(torque, torque, 1, r->finer + 3);
    tobi_line_load now = { 0 }, mean = { 0 };
    double impulse[6];
    const int body = (int)(b - d->bodies);
    if (r->joint.kind) tobi_joint_load_begin(r, dt);
    add_loads(d, body, TOBI_LINES_NOW, &now);
    add_loads(d, body, TOBI_LINES_MEAN, &mean);
    for (int a = 0; a < 3; a++) {
        impulse[a] = r->impulse[a] + r->constraint[a];
        impulse[3 + a] = r->twist[a] + r->constraint[3 + a];
    }
    for (int a = 0; a < 3; a++) {
        double dv = dt*(d->world.gravity[a] + (force[a] + mean.force[a])/r->mass) + impulse[a]/r->mass;
        if (!r->joint.kind) {
            const double momentum = r->momentum[a] + dt*(torque[a] + mean.torque[a]) + impulse[3 + a];
            r->air[a] = dt > 0 ? (keep - 1)*r->mass*(r->velocity[a] + dv)/dt : 0;
            r->air[3 + a] = dt > 0 ? (keep - 1)*momentum/dt : 0;
            r->velocity[a] = keep*(r->velocity[a] + dv);
            r->momentum[a] = keep*momentum;
        }
        r->contact_force[a] = r->impulse[a]/span;
        r->contact_torque[a] = r->twist[a]/span;
        r->impulse[a] = r->twist[a] = r->constraint[a] = r->constraint[3 + a] = 0;
        r->pull[a] = d->world.gravity[a] + (force[a] + now.force[a])/r->mass;
        r->pull_torque[a] = torque[a] + now.torque[a];
    }
    r->span = 0;
    if (r->joint.kind) kick_joint(d, b, dt, impulse);
    else tobi_rigid_apply_locks(r);
    if (hold == r->hold) return TOBI_OK;
    r->hold = hold;
    tobi_rigid_apply_locks(r);
    return TOBI_OK;
}

/* --- contact ----------------------------------------------------------------------------------- */

static int compare_contacts(const void *p, const void *q)
{
    const tobi_touch *x = p, *y = q;
    if (x->a != y->a) return x->a < y->a ? -1 : 1;
    if (x->b != y->b) return x->b < y->b ? -1 : 1;
    return x->key < y->key ? -1 : x->key > y->key;
}

/* A side as a plane with the body's own friction; 0 if there is none. */
static int make_side(const tobi_rigid_world *w, int side, double friction, tobi_fixed_plane *p)
{
    int axis = side/2, upper = side%2;
    if (axis >= w->dimension || !(w->wall[axis] >> upper & 1)) return 0;
    *p = (tobi_fixed_plane){ .offset = upper ? -w->size[axis] : 0, .friction = friction };
    p->normal[axis] = upper ? -1 : 1;
    return 1;
}

/* A plane of the scene, with the friction that it and the body have together. */
static void make_plane(const tobi_rigid_world *w, int plane, double friction, tobi_fixed_plane *p)
{
    *p = w->planes[plane];
    p->friction = p->kind == TOBI_PLANE_SEPARATE ? sqrt(friction*p->friction) :
                  p->kind == TOBI_PLANE_SLIP     ? 0 : friction;
}

void tobi_dynamics_touch_planes(const tobi_dynamics_state *d, int k, double margin, tobi_touch_list *out)
{
    double friction = d->bodies[k].rigid.friction;
    if (d->bodies[k].rigid.kind == TOBI_PRESCRIBED) return;
    for (int number = 0; number < TOBI_SIDES + d->world.plane_count; number++) {
        int64_t first = out->count;
        tobi_fixed_plane p;
        if (number >= TOBI_SIDES) make_plane(&d->world, number - TOBI_SIDES, friction, &p);
        else if (!make_side(&d->world, number, friction, &p)) continue;
        tobi_touch_plane(&d->bodies[k], &d->shapes[k], &p, number, margin, out);
        for (int64_t i = first; i < out->count; i++) {
            tobi_touch *c = &out->at[i];
            c->a = k;
            c->b = -1 - number;
            tobi_shape_add_flow(&d->shapes[k], &d->bodies[k], c->point, 1, c->flow);
        }
    }
}

static void touch_pair(const tobi_dynamics_state *d, tobi_pair p, double dt, tobi_touch_list *out)
{
    int64_t first = out->count;
    double turn[3];
    if (tobi_constraints_join(d->world.constraints, p.a, p.b)) return;
    tobi_touch_look look = { tobi_broad_margin(&d->broad, p.a) + tobi_broad_margin(&d->broad, p.b), 0 };
    vec3_sub(turn, d->bodies[p.a].rigid.angular_velocity, d->bodies[p.b].rigid.angular_velocity);
    look.turn = 1.2*dt*(vec3_length(turn) + (d->shapes[p.a].flow_turn + d->shapes[p.b].flow_turn));
    tobi_touch_bodies(&d->bodies[p.a], &d->shapes[p.a], &d->bodies[p.b], &d->shapes[p.b], look, out);
    for (int64_t i = first; i < out->count; i++) {
        tobi_touch *c = &out->at[i];
        c->a = p.a;
        c->b = p.b;
        tobi_shape_add_flow(&d->shapes[p.a], &d->bodies[p.a], c->point, 1, c->flow);
        tobi_shape_add_flow(&d->shapes[p.b], &d->bodies[p.b], c->point, -1, c->flow);
    }
}

/* The threads' contacts in one list, sorted, so that nothing depends on who found which. Each list has room
   for all of them and those not kept: next time one thread may find them all. */
static tobi_status gather_contacts(tobi_dynamics_state *d, tobi_error *err)
{
    int64_t all = 0;
    int failed = 0;
    for (int i = 0; i < d->world.threads; i++) all += d->part[i].count;
    const int64_t room = all > 0 ? 2*all + 64 : 0;
    for (int i = 0; i < d->world.threads; i++) {
        tobi_touch_reserve(&d->part[i], room);
        for (int64_t k = 0; k < d->part[i].count; k++) {
            tobi_touch *c = tobi_touch_add(&d->contacts);
            if (c) *c = d->part[i].at[k];
        }
        failed |= d->part[i].failed;
    }
    tobi_touch_reserve(&d->before, room);
    if (failed || d->contacts.failed || d->before.failed)
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for contacts");
    if (d->contacts.count > 0)
        qsort(d->contacts.at, (size_t)d->contacts.count, sizeof *d->contacts.at, compare_contacts);
    return TOBI_OK;
}

/* What the parts of the search share. An item is a body with the planes, or a pair. */
typedef struct touching {
    tobi_dynamics_state *d;
    double dt;
    int64_t *next;               /* the first item that nobody has taken */
} touching;

/* Each part takes four items at a time, as long as there are any, and has a list of its own. */
static void touch_parts(const void *view, int64_t begin, int64_t end)
{
    const touching *v = view;
    const tobi_dynamics_state *d = v->d;
    const int64_t all = d->count + d->broad.pair_count;
    int64_t first;
    for (int64_t t = begin; t < end; t++)
        while ((first = __atomic_fetch_add(v->next, 4, __ATOMIC_RELAXED)) < all)
            for (int64_t k = first; k < first + 4 && k < all; k++)
                if (k < d->count)
                    tobi_dynamics_touch_planes(d, (int)k, tobi_broad_margin(&d->broad, (int)k), &d->part[t]);
                else touch_pair(d, d->broad.pairs[k - d->count], v->dt, &d->part[t]);
}

static tobi_status find_contacts(tobi_dynamics_state *d, double dt, tobi_error *err)
{
    tobi_touch_list swap = d->before;
    d->before = d->contacts;
    d->contacts = swap;
    d->contacts.count = 0;
    TOBI_TRY(tobi_broad_find(&d->broad, d->bodies, d->shapes, d->count, dt, err));
    for (int64_t k = 0; k < d->broad.pair_count; k++) {
        tobi_shape_refresh(&d->shapes[d->broad.pairs[k].a]);
        tobi_shape_refresh(&d->shapes[d->broad.pairs[k].b]);
    }
    int64_t next = 0;
    const touching view = { d, dt, &next };
    for (int t = 0; t < d->world.threads; t++) d->part[t].count = 0;
    tobi_loop(d->world.threads, d->world.threads, 0, touch_parts, &view);
    return gather_contacts(d, err);
}

/* Contacts of the step before that are still there start from their impulses. */
static void keep_impulses(tobi_dynamics_state *d)
{
    int64_t k = 0;
    for (int64_t i = 0; i < d->contacts.count; i++) {
        tobi_touch *c = &d->contacts.at[i];
        while (k < d->before.count && compare_contacts(&d->before.at[k], c) < 0) k++;
        if (k == d->before.count || compare_contacts(&d->before.at[k], c) != 0) continue;
        c->impulse = d->before.at[k].impulse;
        memcpy(c->slide, d->before.at[k].slide, sizeof c->slide);
    }
}

/* Adds to sum[0] by how much the next drift opens the contact without the pull, m, to sum[1] what the pull
   adds; sign: 1 for the body a, -1 for b. */
static void predict(const tobi_rigid *r, const tobi_touch *c, int sign, double dt, double sum[2])
{
    double arm[3], lever[3], shift[3], turn[3][3], joint[6];
    vec3_sub(arm, c->point, r->position);
    vec3_cross(lever, arm, c->normal);
    tobi_rigid_inverse(r, shift, turn);
    tobi_joint_freedom(r, joint);
    for (int a = 0; a < 3; a++) {
        sum[0] += sign*(c->normal[a]*(dt*r->velocity[a] + r->push[a]) +
                        lever[a]*(dt*r->angular_velocity[a] + r->turn[a]));
        if (r->kind == TOBI_PRESCRIBED) continue;
        sum[1] += sign*0.5*dt*dt*((shift[a] > 0)*c->normal[a]*r->pull[a] +
                                  lever[a]*vec3_dot(turn[a], r->pull_torque));
    }
    if (r->joint.kind)
        sum[1] += sign*0.5*dt*dt*(vec3_dot(joint, c->normal) + vec3_dot(joint + 3, lever))*
                  sqrt(r->joint.mass)*tobi_joint_pull(r);
}

/* The velocities are such that nothing comes nearer than touching, the pull is not yet answered: a body that
   it would draw into another one, or a side, drifts by its velocities alone (R.16), or a stack would creep
   by half of g dt^2 in every step. A body held may hold others, hence the rounds. */
static void hold_bodies(tobi_dynamics_state *d, double dt)
{
    const double level = 1e-9;       /* of dt^2 pull: what rounding leaves of a pull along a surface */
    for (int again = 1; again;) {
        again = 0;
        for (int64_t k = 0; k < d->contacts.count; k++) {
            const tobi_touch *c = &d->contacts.at[k];
            tobi_rigid *a = &d->bodies[c->a].rigid, *b = c->b >= 0 ? &d->bodies[c->b].rigid : NULL;
            double sum[2] = { c->gap + dt*vec3_dot(c->normal, c->flow), 0 };
            predict(a, c, 1, dt, sum);
            if (b) predict(b, c, -1, dt, sum);
            double size = vec3_length(a->pull) + (b ? vec3_length(b->pull) : 0);
            if (sum[1] >= -level*dt*dt*size || sum[0] + sum[1] >= 0) continue;
            again |= tobi_rigid_drop_pull(a);
            if (b) again |= tobi_rigid_drop_pull(b);
        }
    }
    tobi_constraints_hold(d->world.constraints, d->bodies);
}

/* A resting contact is there in the next step as well; an impact is not. */
static void keep_contact_force(tobi_body *b)
{
    tobi_rigid *r = &b->rigid;
    for (int a = 0; a < 6; a++) {
        const double now = a < 3 ? b->info.contact_force[a] : b->info.contact_torque[a - 3],
                     last = r->contact_before[a];
        r->held[a] = now*last > 0 ? copysign(fmin(fabs(now), fabs(last)), now) : 0;
        r->contact_before[a] = now;
    }
}

/* After contact, which saw a body that rests at a stop as fixed. */
static void stop_joint(tobi_body *b, double dt)
{
    double impulse[6];
    for (int a = 0; a < 3; a++) {
        impulse[a] = dt*b->info.contact_force[a];
        impulse[3 + a] = dt*b->info.contact_torque[a];
    }
    tobi_joint_load_add(&b->rigid, impulse);
    tobi_joint_stop(&b->rigid, dt, PLASTIC, impulse);
    tobi_joint_report(&b->rigid, dt);
}

tobi_status tobi_rigid_step(tobi_dynamics_state *d, double t, double dt, tobi_error *err)
{
    double g = vec3_length(d->world.gravity);
    tobi_rigid_follow(d);
    for (int k = 0; k < d->count; k++) {
        tobi_body_info *info = &d->bodies[k].info;
        memset(info->contact_force, 0, sizeof info->contact_force);
        memset(info->contact_torque, 0, sizeof info->contact_torque);
        d->bodies[k].touch_power = 0;
        if (d->bodies[k].rigid.kind != TOBI_PRESCRIBED) TOBI_TRY(kick(d, &d->bodies[k], t, dt, err));
    }
    TOBI_TRY(find_contacts(d, dt, err));
    keep_impulses(d);
    TOBI_TRY(tobi_solve(&d->solver, d->bodies, d->count, &d->contacts, d->world.constraints, dt,
                        fmax(PLASTIC*g*dt, PLASTIC_LEAST), err));
    hold_bodies(d, dt);
    tobi_constraints_report(d->world.constraints, d->bodies, dt);
    for (int k = 0; k < d->count; k++) {
        tobi_body *b = &d->bodies[k];
        const tobi_rigid *r = &b->rigid;
        if (r->kind == TOBI_PRESCRIBED) continue;
        if (r->joint.kind) stop_joint(b, dt);
        keep_contact_force(b);
        if (!isfinite(vec3_dot(r->velocity, r->velocity) + vec3_dot(r->momentum, r->momentum)))
            return tobi_fail(err, TOBI_DIVERGED, "the simulation diverged at t = %.9g s: body '%s' has a "
                             "velocity that is no number", t, b->name);
        tobi_body_report(b);
    }
    return TOBI_OK;
}

/* Before the first step, which has no kick behind it. */
static tobi_status begin_pull(tobi_dynamics_state *d, tobi_error *err)
{
    double dt = tobi_rigid_step_limit(d);
    tobi_rigid_follow(d);
    tobi_solve_joints(d->bodies, d->world.constraints);
    for (int k = 0; k < d->count; k++) {
        tobi_rigid *r = &d->bodies[k].rigid;
        tobi_line_load load = { 0 };
        if (r->kind == TOBI_PRESCRIBED) continue;
        add_loads(d, k, TOBI_LINES_NOW, &load);
        for (int a = 0; a < 3; a++) {
            r->pull[a] = d->world.gravity[a] + 1/r->mass*(r->force[a] + load.force[a]);
            r->pull_torque[a] = r->torque[a] + load.torque[a];
        }
    }
    TOBI_TRY(find_contacts(d, dt, err));
    hold_bodies(d, dt);
    d->contacts.count = 0;
    return TOBI_OK;
}

tobi_status tobi_rigid_start(tobi_body *bodies, int count, const tobi_rigid_world *world, char *notes,
                             size_t room, tobi_dynamics_state **out, tobi_error *err)
{
    tobi_dynamics_state *d = calloc(1, sizeof *d);
    *out = NULL;
    notes[0] = '\0';
    if (d) d->shapes = calloc((size_t)count + 1, sizeof *d->shapes);
    if (d) d->part = calloc((size_t)world->threads + 1, sizeof *d->part);
    if (!d || !d->shapes || !d->part) {
        tobi_rigid_free(d);
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %d bodies", count);
    }
    d->bodies = bodies;
    d->count = count;
    d->world = *world;
    d->thinnest = INFINITY;
    tobi_status status = TOBI_OK;
    for (int k = 0; k < count && status == TOBI_OK; k++)
        status = tobi_shape_make(&d->shapes[k], &bodies[k], world->dimension, err);
    for (int k = 0; k < count; k++)
        if (d->shapes[k].solid) d->thinnest = fmin(d->thinnest, d->shapes[k].thickness);
    if (status == TOBI_OK) status = tobi_dynamics_note(d, notes, room, err);
    if (status == TOBI_OK) status = begin_pull(d, err);
    if (status == TOBI_OK) *out = d;
    else tobi_rigid_free(d);
    return status;
}

void tobi_rigid_count(const tobi_dynamics_state *d, int64_t *touching, int *sweeps)
{
    *touching = 0;
    *sweeps = d->solver.sweeps;
    for (int64_t k = 0; k < d->contacts.count; k++) *touching += d->contacts.at[k].impulse > 0;
}

/* --- what callers change between steps --------------------------------------------------------- */

/* Whether contact has dropped the pull that gravity and the constant force would make. */
static int is_held(const tobi_dynamics_state *d, const tobi_rigid *r)
{
    double due[3];
    vec3_add_scaled(due, d->world.gravity, 1/r->mass, r->force);
    return !tobi_rigid_has_pull(r) && vec3_dot(due, due) + vec3_dot(r->torque, r->torque) > 0;
}

/* The pull of the next drift. What lines and a control program add to it stays. */
static void change_pull(const tobi_dynamics_state *d, tobi_rigid *r, const double gravity[3],
                        const double force[3], const double torque[3])
{
    const int more = r->control || d->world.line_count > 0;
    if (r->kind == TOBI_PRESCRIBED || is_held(d, r)) return;
    for (int a = 0; a < 3; a++) {
        const double now = gravity[a] + force[a]/r->mass;
        const double added = more ? r->pull[a] - (d->world.gravity[a] + r->force[a]/r->mass) : 0;
        r->pull[a] = now + added;
        r->pull_torque[a] = torque[a] + (more ? r->pull_torque[a] - r->torque[a] : 0);
    }
}

void tobi_rigid_set_gravity(tobi_dynamics_state *d, const double gravity[3])
{
    for (int k = 0; k < d->count; k++) {
        tobi_rigid *r = &d->bodies[k].rigid;
        change_pull(d, r, gravity, r->force, r->torque);
    }
    memcpy(d->world.gravity, gravity, sizeof d->world.gravity);
}

void tobi_rigid_restore_gravity(tobi_dynamics_state *d, const double gravity[3])
{
    memcpy(d->world.gravity, gravity, sizeof d->world.gravity);
}

void tobi_rigid_set_force(tobi_dynamics_state *d, int body, const double force[3], const double torque[3])
{
    tobi_rigid *r = &d->bodies[body].rigid;
    change_pull(d, r, d->world.gravity, force, torque);
    memcpy(r->force, force, sizeof r->force);
    memcpy(r->torque, torque, sizeof r->torque);
}

void tobi_rigid_set_finer(tobi_dynamics_state *d, int body, const double finer[6])
{
    tobi_rigid *r = &d->bodies[body].rigid;
    const int held = is_held(d, r);
    for (int a = 0; a < 3 && !held; a++) {
        r->pull[a] += (finer[a] - r->finer[a])/r->mass;
        r->pull_torque[a] += finer[3 + a] - r->finer[3 + a];
    }
    memcpy(r->finer, finer, sizeof r->finer);
}
