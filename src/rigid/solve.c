#include "rigid/solve.h"
#include "geom/vec3.h"
#include <stdlib.h>
#include <string.h>

enum { MOST_SWEEPS = 50, LEAST_SWEEPS = 4, PUSH_SWEEPS = 10 };
#define SETTLED 1e-6       /* of the fastest approach: a sweep that changes less is the last one         */
#define PUSH_SHARE 0.2     /* of an overlap beyond the slop, taken out per step                          */
#define PUSH_MOST 2        /* slops, at most, per step                                                   */

/* A body during the solve. */
struct tobi_solve_body {
    double shift[3], turn[3][3];     /* inverse mass and inertia, 0 where locked               */
    double push[6];                  /* m, rad: displacement so far                            */
};

struct tobi_solve_row {
    tobi_contact *contact;
    tobi_rigid *a, *b;               /* b NULL: a side                                         */
    tobi_solve_body *ma, *mb;
    double arm_a[3], arm_b[3];
    double axis[3][3];               /* the normal and two tangents                            */
    double turn_a[3][3], turn_b[3][3];         /* change of angular velocity per N s along them */
    double mass[3];                  /* kg, effective along the axes; 0 = nothing can move     */
    double target;                   /* m/s, the least speed apart                             */
    double friction;
    double along[2];                 /* N s of friction along the tangents                     */
    double was[3], way[3];           /* N s: before this sweep, and the direction of search    */
    double pushed;                   /* of the displacements                                   */
};

static void *grow(void *array, int64_t *capacity, int64_t count, size_t size)
{
    if (count <= *capacity) return array;
    void *more = realloc(array, (size_t)(2*count)*size);
    if (more) *capacity = 2*count;
    return more;
}

static tobi_status reserve(tobi_solver *s, int64_t rows, int64_t bodies, tobi_error *err)
{
    void *r = grow(s->rows, &s->row_capacity, rows + 1, sizeof *s->rows);
    if (r) s->rows = r;
    void *b = grow(s->bodies, &s->body_capacity, bodies + 1, sizeof *s->bodies);
    if (b) s->bodies = b;
    if (r && b) return TOBI_OK;
    return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld contacts", (long long)rows);
}

/* Two directions across n, the same for the same n. */
static void make_tangents(double axis[3][3])
{
    const double *n = axis[0];
    int k = fabs(n[0]) < 0.6 ? 0 : fabs(n[1]) < 0.6 ? 1 : 2;
    double e[3] = { k == 0, k == 1, k == 2 };
    vec3_cross(axis[1], n, e);
    vec3_normalize(axis[1]);
    vec3_cross(axis[2], n, axis[1]);
}

/* The response of one side to an impulse of 1 N s along an axis, m/s along that axis. */
static double respond(const tobi_solve_body *m, const double arm[3], const double axis[3], double spin[3])
{
    double lever[3], at[3], sum = 0;
    vec3_cross(lever, arm, axis);
    for (int i = 0; i < 3; i++) spin[i] = vec3_dot(m->turn[i], lever);
    vec3_cross(at, spin, arm);
    for (int i = 0; i < 3; i++) sum += axis[i]*axis[i]*m->shift[i] + axis[i]*at[i];
    return sum;
}

static double speed_along(const tobi_solve_row *r, int k)
{
    double at[3], v;
    vec3_cross(at, r->a->angular_velocity, r->arm_a);
    v = vec3_dot(r->axis[k], r->a->velocity) + vec3_dot(r->axis[k], at);
    if (!r->b) return v;
    vec3_cross(at, r->b->angular_velocity, r->arm_b);
    return v - vec3_dot(r->axis[k], r->b->velocity) - vec3_dot(r->axis[k], at);
}

static void push(tobi_solve_row *r, int k, double impulse)
{
    for (int i = 0; i < 3; i++) {
        double p = impulse*r->axis[k][i];
        r->a->velocity[i] += p*r->ma->shift[i];
        r->a->angular_velocity[i] += impulse*r->turn_a[k][i];
        if (!r->b) continue;
        r->b->velocity[i] -= p*r->mb->shift[i];
        r->b->angular_velocity[i] -= impulse*r->turn_b[k][i];
    }
}

/* Speed apart that a contact must reach (R.7): to bounce if it arrives in this step, or to close its gap
   and no more. */
static void set_target(tobi_solve_row *r, double dt, double bounce)
{
    double speed = speed_along(r, 0), open = fmax(r->contact->gap, 0);
    double e = r->b ? fmax(r->a->restitution, r->b->restitution) : r->a->restitution;
    r->target = -open/dt;
    if (speed < -bounce && -speed*dt > open) r->target = fmax(r->target, -e*speed);
}

static void prepare(tobi_solver *s, tobi_solve_row *r, tobi_contact *c, tobi_body *bodies)
{
    memset(r, 0, sizeof *r);
    r->contact = c;
    r->a = &bodies[c->a].rigid;
    r->ma = &s->bodies[c->a];
    vec3_sub(r->arm_a, c->point, r->a->position);
    r->friction = r->a->friction;
    if (c->b >= 0) {
        r->b = &bodies[c->b].rigid;
        r->mb = &s->bodies[c->b];
        vec3_sub(r->arm_b, c->point, r->b->position);
        r->friction = sqrt(r->a->friction*r->b->friction);
    }
    memcpy(r->axis[0], c->normal, sizeof r->axis[0]);
    make_tangents(r->axis);
    for (int k = 0; k < 3; k++) {
        double sum = respond(r->ma, r->arm_a, r->axis[k], r->turn_a[k]);
        if (r->b) sum += respond(r->mb, r->arm_b, r->axis[k], r->turn_b[k]);
        r->mass[k] = sum > 0 ? 1/sum : 0;
    }
}

static void warm_start(tobi_solve_row *r)
{
    for (int k = 0; k < 2; k++) r->along[k] = vec3_dot(r->axis[1 + k], r->contact->slide);
    if (r->mass[0] == 0) r->contact->impulse = 0;
    for (int k = 0; k < 2; k++) {
        if (r->mass[1 + k] == 0) r->along[k] = 0;
        push(r, 1 + k, r->along[k]);
    }
    push(r, 0, r->contact->impulse);
}

/* One contact: friction within Coulomb's cone, then the normal. Returns the largest change, m/s. */
static double solve_row(tobi_solve_row *r)
{
    double want[2], limit = r->friction*fmax(0, r->contact->impulse), change = 0;
    for (int k = 0; k < 2; k++) want[k] = r->along[k] - r->mass[1 + k]*speed_along(r, 1 + k);
    double size = sqrt(want[0]*want[0] + want[1]*want[1]), keep = size > limit ? limit/size : 1;
    for (int k = 0; k < 2; k++) {
        double more = keep*want[k] - r->along[k];
        if (r->mass[1 + k] == 0) continue;
        r->along[k] += more;
        push(r, 1 + k, more);
        change = fmax(change, fabs(more)/r->mass[1 + k]);
    }
    if (r->mass[0] == 0) return change;
    double sum = fmax(0, r->contact->impulse + r->mass[0]*(r->target - speed_along(r, 0)));
    double more = sum - r->contact->impulse;
    r->contact->impulse = sum;
    push(r, 0, more);
    return fmax(change, fabs(more)/r->mass[0]);
}

/* To and fro, so that no end of a stack is last. Returns the largest change, m/s. */
static double sweep(tobi_solver *s, int64_t count)
{
    double change = 0;
    for (int64_t k = 0; k < count; k++) change = fmax(change, solve_row(&s->rows[k]));
    for (int64_t k = count; k-- > 0;) change = fmax(change, solve_row(&s->rows[k]));
    s->sweeps += 2;
    return change;
}

static double *impulse_of(tobi_solve_row *r, int k) { return k ? &r->along[k - 1] : &r->contact->impulse; }

/* What the last sweep changed, squared, in units of energy. */
static double measure_change(tobi_solver *s, int64_t count)
{
    double sum = 0;
    for (int64_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) {
            tobi_solve_row *r = &s->rows[i];
            double d = *impulse_of(r, k) - r->was[k];
            if (r->mass[k] > 0) sum += d*d/r->mass[k];
        }
    return sum;
}

/* Goes on along the direction of search by beta, which then holds what the sweep changed, too. */
static void go_on(tobi_solver *s, int64_t count, double beta)
{
    for (int64_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) {
            tobi_solve_row *r = &s->rows[i];
            double step = beta*r->way[k];
            r->way[k] = step + *impulse_of(r, k) - r->was[k];
            if (step == 0 || r->mass[k] == 0) continue;
            *impulse_of(r, k) += step;
            push(r, k, step);
        }
}

/* Sweeps, accelerated by conjugate gradients (Silcowitz-Hansen, Niebe & Erleben 2010): a tower of ten
   needs tens of sweeps, not thousands. The last thing is always a sweep, which obeys all limits. */
static void sweep_all(tobi_solver *s, int64_t count, double scale)
{
    double before = 0;
    s->sweeps = 0;
    for (int64_t i = 0; i < count; i++) memset(s->rows[i].way, 0, sizeof s->rows[i].way);
    for (;;) {
        for (int64_t i = 0; i < count; i++)
            for (int k = 0; k < 3; k++) s->rows[i].was[k] = *impulse_of(&s->rows[i], k);
        double change = sweep(s, count);
        if (s->sweeps >= MOST_SWEEPS || (s->sweeps >= LEAST_SWEEPS && change <= SETTLED*scale)) return;
        double now = measure_change(s, count), beta = before > 0 ? now/before : 0;
        go_on(s, count, beta < 1 ? beta : 0);
        before = now;
    }
}

/* Overlaps (R.10): the same sweeps for displacements along the normals. */
static void push_out(tobi_solver *s, int64_t count)
{
    for (int sweep = 0; sweep < PUSH_SWEEPS; sweep++)
        for (int64_t k = 0; k < count; k++) {
            tobi_solve_row *r = &s->rows[k];
            double over = -r->contact->gap - r->contact->slop, at[3];
            double target = over > 0 ? fmin(PUSH_SHARE*over, PUSH_MOST*r->contact->slop) : over;
            vec3_cross(at, r->ma->push + 3, r->arm_a);
            double now = vec3_dot(r->axis[0], r->ma->push) + vec3_dot(r->axis[0], at);
            if (r->b) {
                vec3_cross(at, r->mb->push + 3, r->arm_b);
                now -= vec3_dot(r->axis[0], r->mb->push) + vec3_dot(r->axis[0], at);
            }
            double sum = fmax(0, r->pushed + r->mass[0]*(target - now)), more = sum - r->pushed;
            r->pushed = sum;
            for (int i = 0; i < 3; i++) {
                r->ma->push[i] += more*r->axis[0][i]*r->ma->shift[i];
                r->ma->push[3 + i] += more*r->turn_a[0][i];
                if (!r->b) continue;
                r->mb->push[i] -= more*r->axis[0][i]*r->mb->shift[i];
                r->mb->push[3 + i] -= more*r->turn_b[0][i];
            }
        }
}

/* Leaves impulses with the contact, and momentum and force with the bodies. */
static void finish(tobi_solve_row *r, double dt)
{
    tobi_contact *c = r->contact;
    double p[3], spin[3];
    for (int i = 0; i < 3; i++) {
        c->slide[i] = r->along[0]*r->axis[1][i] + r->along[1]*r->axis[2][i];
        p[i] = c->impulse*c->normal[i] + c->slide[i];
    }
    for (int side = 0; side < 2; side++) {
        tobi_rigid *body = side ? r->b : r->a;
        if (!body) continue;
        vec3_cross(spin, side ? r->arm_b : r->arm_a, p);
        vec3_add_scaled(body->momentum, body->momentum, side ? -1 : 1, spin);
        vec3_add_scaled(body->contact_force, body->contact_force, (side ? -1 : 1)/dt, p);
        vec3_add_scaled(body->contact_torque, body->contact_torque, (side ? -1 : 1)/dt, spin);
    }
}

tobi_status tobi_solve(tobi_solver *s, tobi_body *bodies, int body_count, tobi_contact_list *contacts,
                       double dt, double bounce, tobi_error *err)
{
    int64_t count = contacts->count;
    double fastest = 0;
    TOBI_TRY(reserve(s, count, body_count, err));
    for (int k = 0; k < body_count; k++) {
        memset(&s->bodies[k], 0, sizeof s->bodies[k]);
        tobi_rigid_inverse(&bodies[k].rigid, s->bodies[k].shift, s->bodies[k].turn);
    }
    for (int64_t k = 0; k < count; k++) {
        prepare(s, &s->rows[k], &contacts->at[k], bodies);
        set_target(&s->rows[k], dt, bounce);
        fastest = fmax(fastest, fmax(0, s->rows[k].target - speed_along(&s->rows[k], 0)));
    }
    for (int64_t k = 0; k < count; k++) warm_start(&s->rows[k]);
    sweep_all(s, count, fastest);
    push_out(s, count);
    for (int64_t k = 0; k < count; k++) finish(&s->rows[k], dt);
    for (int k = 0; k < body_count; k++) {
        tobi_rigid *r = &bodies[k].rigid;
        if (r->kind == TOBI_PRESCRIBED) continue;
        memcpy(r->push, s->bodies[k].push, sizeof r->push);
        memcpy(r->turn, s->bodies[k].push + 3, sizeof r->turn);
        tobi_rigid_settle(r);
    }
    return TOBI_OK;
}

void tobi_solver_free(tobi_solver *s)
{
    free(s->rows);
    free(s->bodies);
    memset(s, 0, sizeof *s);
}
