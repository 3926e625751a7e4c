/* Impulses by sweeps over all contacts, in a fixed order, until a sweep changes little. Drawback: tall
   piles converge slowly, and the sweep is serial. */
#include "rigid/solve.h"
#include "geom/vec3.h"
#include <stdlib.h>
#include <string.h>

enum { LEAST_SWEEPS = 4, PUSH_SWEEPS = 10 };
/* At most so many rows per step, between so many sweeps: few bodies are solved to the end, piles on time. */
enum { ROWS = 40000, FEWEST_SWEEPS = 40, MOST_SWEEPS = 400 };
#define SETTLED 1e-6       /* of the fastest approach: a sweep that changes less is the last one         */
#define PUSH_SHARE 0.2     /* of an overlap beyond the slop, taken out per step                          */
#define PUSH_MOST 2        /* slops, at most, per step                                                   */

/* A body during the solve; the first stands for the sides. */
struct tobi_solve_body {
    double speed[6];                 /* m/s, rad/s                                             */
    double push[6];                  /* m, rad: displacement so far                            */
    double shift[3], turn[3][3];     /* inverse mass and inertia, 0 where locked               */
    double joint[6];                 /* of a body with a joint, M^-1 = s s^T; else 0           */
};

struct tobi_solve_row {
    tobi_touch *contact;
    tobi_solve_body *a, *b;
    double axis[3][3];               /* the normal and two tangents                            */
    double lever_a[3][3], lever_b[3][3];       /* arm x axis                                   */
    double spin_a[3][3], spin_b[3][3];         /* change of angular velocity per N s           */
    double mass[3];                  /* kg, effective along the axes; 0 = nothing can move     */
    double sum[3];                   /* N s so far                                             */
    double was[3], way[3];           /* N s: before this sweep, and the direction of search    */
    double flow[3];                  /* m/s, what changes of shape add to the speeds apart     */
    double target;                   /* m/s, the least speed apart                             */
    double friction;
    double pushed;                   /* of the displacements                                   */
    double early;                    /* m, what bouncing before the gap has closed puts too far */
    int jointed;                     /* one of the two has a joint                             */
    double along_a[3], along_b[3];   /* change along a joint per N s, in units of its s        */
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
    void *b = grow(s->bodies, &s->body_capacity, bodies + 2, sizeof *s->bodies);
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
static double respond(const tobi_solve_body *m, const double axis[3], const double lever[3], double spin[3],
                      double *along)
{
    double sum = 0;
    *along = vec3_dot(m->joint, axis) + vec3_dot(m->joint + 3, lever);
    for (int i = 0; i < 3; i++) {
        spin[i] = vec3_dot(m->turn[i], lever);
        sum += axis[i]*axis[i]*m->shift[i];
    }
    return sum + vec3_dot(spin, lever) + *along**along;
}

/* Of a six-vector, velocities or displacements: how fast the surfaces part along an axis. */
static inline double part(const tobi_solve_row *r, int k, const double *a, const double *b)
{
    double d[3];
    vec3_sub(d, a, b);
    return vec3_dot(r->axis[k], d) + vec3_dot(r->lever_a[k], a + 3) - vec3_dot(r->lever_b[k], b + 3);
}

static inline double speed_along(const tobi_solve_row *r, int k)
{
    return part(r, k, r->a->speed, r->b->speed) + r->flow[k];
}

/* Out of line: few contacts have a body with a joint, and this is the inner loop of every sweep. */
static __attribute__((noinline)) void drive_joints(const tobi_solve_row *r, int k, double impulse, double *a,
                                                   double *b)
{
    for (int i = 0; i < 6; i++) {
        a[i] += impulse*r->along_a[k]*r->a->joint[i];
        b[i] -= impulse*r->along_b[k]*r->b->joint[i];
    }
}

static inline void drive(const tobi_solve_row *r, int k, double impulse, double *a, double *b)
{
    for (int i = 0; i < 3; i++) {
        double p = impulse*r->axis[k][i];
        a[i] += p*r->a->shift[i];
        a[3 + i] += impulse*r->spin_a[k][i];
        b[i] -= p*r->b->shift[i];
        b[3 + i] -= impulse*r->spin_b[k][i];
    }
    if (r->jointed) drive_joints(r, k, impulse, a, b);
}

static inline void push(tobi_solve_row *r, int k, double impulse)
{
    r->sum[k] += impulse;
    drive(r, k, impulse, r->a->speed, r->b->speed);
}

/* --- joints between bodies --------------------------------------------------------------------- */

static void begin_joints(tobi_constraints *c, const tobi_body *bodies)
{
    tobi_constraints_take_inverse(c, bodies);
    tobi_constraints_factor(c, bodies);
    memset(c->impulse, 0, (size_t)c->rows*sizeof *c->impulse);
}

static void obey_joints(tobi_solver *s)
{
    tobi_constraints *c = s->joints;
    if (c->count == 0) return;
    for (int k = 0; k < c->slots; k++) memcpy(c->speed[k], s->bodies[1 + c->body[k]].speed, sizeof *c->speed);
    tobi_constraints_obey(c, s->owners);
    for (int k = 0; k < c->slots; k++) memcpy(s->bodies[1 + c->body[k]].speed, c->speed[k], sizeof *c->speed);
}

/* Angular momentum: of velocities the bodies have been told. */
static void finish_joints(tobi_constraints *c, tobi_body *bodies)
{
    for (int k = 0; k < c->slots; k++) {
        double f[6] = { 0 };
        tobi_constraints_add_load(c, k, f);
        tobi_rigid *r = &bodies[c->body[k]].rigid;
        vec3_add_scaled(r->momentum, r->momentum, 1, f + 3);
        if (r->joint.kind) tobi_joint_load_add(r, f);
    }
    tobi_constraints_count(c);
}

void tobi_solve_joints(tobi_body *bodies, tobi_constraints *c)
{
    if (c->count == 0) return;
    begin_joints(c, bodies);
    for (int k = 0; k < c->slots; k++) {
        const tobi_rigid *r = &bodies[c->body[k]].rigid;
        memcpy(c->speed[k], r->velocity, sizeof r->velocity);
        memcpy(c->speed[k] + 3, r->angular_velocity, sizeof r->angular_velocity);
    }
    tobi_constraints_obey(c, bodies);
    finish_joints(c, bodies);
    for (int k = 0; k < c->slots; k++) {
        tobi_rigid *r = &bodies[c->body[k]].rigid;
        memcpy(r->velocity, c->speed[k], sizeof r->velocity);
        memcpy(r->angular_velocity, c->speed[k] + 3, sizeof r->angular_velocity);
        tobi_rigid_apply_locks(r);
    }
}

/* --- contacts ---------------------------------------------------------------------------------- */

static int is_fixed(const tobi_solve_body *b)
{
    return b->shift[0] + b->shift[1] + b->shift[2] == 0 &&
           vec3_dot(b->joint, b->joint) + vec3_dot(b->joint + 3, b->joint + 3) == 0;
}

/* Speed apart that a contact must reach (R.7): to bounce if it arrives in this step, or to close its gap
   and no more. */
static void set_target(tobi_solve_row *r, double restitution, double dt, double bounce)
{
    double speed = speed_along(r, 0), open = fmax(r->contact->gap, 0);
    r->target = -open/dt;
    if (!(speed < -bounce && -speed*dt > open && -restitution*speed > r->target)) return;
    r->target = -restitution*speed;
    if (is_fixed(r->a) || is_fixed(r->b)) r->early = (1 + restitution)*open;
}

static void prepare(tobi_solver *s, tobi_solve_row *r, tobi_touch *c, const tobi_body *bodies)
{
    const tobi_rigid *a = &bodies[c->a].rigid, *b = c->b >= 0 ? &bodies[c->b].rigid : NULL;
    double arm_a[3], arm_b[3] = { 0, 0, 0 };
    memset(r, 0, sizeof *r);
    r->contact = c;
    r->a = &s->bodies[1 + c->a];
    r->b = b ? &s->bodies[1 + c->b] : &s->bodies[0];
    r->friction = b ? tobi_rigid_friction(a, b) : c->friction;
    vec3_sub(arm_a, c->point, a->position);
    if (b) vec3_sub(arm_b, c->point, b->position);
    memcpy(r->axis[0], c->normal, sizeof r->axis[0]);
    make_tangents(r->axis);
    for (int k = 0; k < 3; k++) {
        vec3_cross(r->lever_a[k], arm_a, r->axis[k]);
        vec3_cross(r->lever_b[k], arm_b, r->axis[k]);
        double sum = respond(r->a, r->axis[k], r->lever_a[k], r->spin_a[k], &r->along_a[k]) +
                     respond(r->b, r->axis[k], r->lever_b[k], r->spin_b[k], &r->along_b[k]);
        r->mass[k] = sum > 0 ? 1/sum : 0;
        r->flow[k] = vec3_dot(r->axis[k], c->flow);
        r->jointed |= r->along_a[k] != 0 || r->along_b[k] != 0;
    }
}

static void warm_start(tobi_solve_row *r)
{
    double before[3] = { r->contact->impulse, vec3_dot(r->axis[1], r->contact->slide),
                         vec3_dot(r->axis[2], r->contact->slide) };
    for (int k = 0; k < 3; k++)
        if (r->mass[k] > 0) push(r, k, before[k]);
}

/* One contact: friction within Coulomb's cone, then the normal. Returns the largest change, m/s. */
static double solve_row(tobi_solve_row *r)
{
    double want[3], limit = r->friction*fmax(0, r->sum[0]), change = 0;
    for (int k = 1; k < 3; k++) want[k] = r->sum[k] - r->mass[k]*speed_along(r, k);
    double size2 = want[1]*want[1] + want[2]*want[2];
    double keep = size2 > limit*limit ? limit/sqrt(size2) : 1;
    for (int k = 1; k < 3; k++) {
        double more = keep*want[k] - r->sum[k];
        if (r->mass[k] == 0) continue;
        push(r, k, more);
        change = fmax(change, fabs(more)/r->mass[k]);
    }
    if (r->mass[0] == 0) return change;
    double more = fmax(-r->sum[0], r->mass[0]*(r->target - speed_along(r, 0)));
    push(r, 0, more);
    return fmax(change, fabs(more)/r->mass[0]);
}

/* To and fro, so that no end of a stack is last. Returns the largest change, m/s. */
static double sweep(tobi_solver *s, int64_t count)
{
    double change = 0;
    for (int64_t k = 0; k < count; k++) change = fmax(change, solve_row(&s->rows[k]));
    for (int64_t k = count; k-- > 0;) change = fmax(change, solve_row(&s->rows[k]));
    obey_joints(s);
    s->sweeps += 2;
    return change;
}

/* What the last sweep changed, squared, in units of energy. */
static double measure_change(tobi_solver *s, int64_t count)
{
    double sum = 0;
    for (int64_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) {
            tobi_solve_row *r = &s->rows[i];
            double d = r->sum[k] - r->was[k];
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
            r->way[k] = step + r->sum[k] - r->was[k];
            if (step != 0 && r->mass[k] > 0) push(r, k, step);
        }
}

/* Sweeps, accelerated by conjugate gradients (Silcowitz-Hansen, Niebe & Erleben 2010): a tower of ten
   needs tens of sweeps, not thousands. The last thing is always a sweep, which obeys all limits. */
static void sweep_all(tobi_solver *s, int64_t count, double scale)
{
    double before = 0;
    int64_t most = ROWS/(count + 1);
    most = most < FEWEST_SWEEPS ? FEWEST_SWEEPS : most > MOST_SWEEPS ? MOST_SWEEPS : most;
    s->sweeps = 0;
    for (;;) {
        for (int64_t i = 0; i < count; i++) memcpy(s->rows[i].was, s->rows[i].sum, sizeof s->rows[i].was);
        double change = sweep(s, count);
        if (s->sweeps >= most || (s->sweeps >= LEAST_SWEEPS && change <= SETTLED*scale)) return;
        double now = measure_change(s, count), beta = before > 0 ? now/before : 0;
        go_on(s, count, beta < 1 ? beta : 0);
        before = now;
    }
}

/* Overlaps (R.10): the same sweeps for displacements along the normals. A bounce, which comes up to a step
   early, is put where it would be had it met the surface; not between two bodies that move, whose angular
   momentum about any point that would change. */
static void push_out(tobi_solver *s, int64_t count)
{
    for (int sweep = 0; sweep < PUSH_SWEEPS; sweep++)
        for (int64_t k = 0; k < count; k++) {
            tobi_solve_row *r = &s->rows[k];
            double over = -r->contact->gap - r->contact->slop;
            double target = over > 0 ? fmin(PUSH_SHARE*over, PUSH_MOST*r->contact->slop) : over;
            int bounced = r->early > 0 && r->sum[0] > 0;
            if (bounced) target = -r->early;
            double more = r->mass[0]*(target - part(r, 0, r->a->push, r->b->push));
            if (!bounced) more = fmax(-r->pushed, more);
            r->pushed += more;
            if (more != 0) drive(r, 0, more, r->a->push, r->b->push);
        }
}

/* What the impulses do by changes of shape; two bodies that both change theirs have a half each. */
static void share_flow(const tobi_solve_row *r, tobi_body *bodies, double dt)
{
    const tobi_touch *c = r->contact;
    tobi_body *a = &bodies[c->a], *b = c->b >= 0 ? &bodies[c->b] : NULL;
    const int both = a->deforms && b && b->deforms;
    const double power = vec3_dot(r->sum, r->flow)/dt;
    if (a->deforms) a->touch_power += both ? 0.5*power : power;
    if (b && b->deforms) b->touch_power += both ? 0.5*power : power;
}

/* Leaves impulses with the contact, and momentum and force with the bodies. */
static void finish(tobi_solve_row *r, tobi_body *bodies, double dt)
{
    tobi_touch *c = r->contact;
    c->impulse = r->sum[0];
    for (int i = 0; i < 3; i++) c->slide[i] = r->sum[1]*r->axis[1][i] + r->sum[2]*r->axis[2][i];
    share_flow(r, bodies, dt);
    for (int side = 0; side < 2; side++) {
        int body = side ? c->b : c->a;
        if (body < 0) continue;
        tobi_rigid *b = &bodies[body].rigid;
        tobi_body_info *info = &bodies[body].info;
        for (int k = 0; k < 3; k++) {
            double p = side ? -r->sum[k] : r->sum[k];
            const double *lever = side ? r->lever_b[k] : r->lever_a[k];
            vec3_add_scaled(info->contact_force, info->contact_force, p/dt, r->axis[k]);
            vec3_add_scaled(info->contact_torque, info->contact_torque, p/dt, lever);
            if (b->kind == TOBI_PRESCRIBED) continue;
            vec3_add_scaled(b->momentum, b->momentum, p, lever);
            vec3_add_scaled(b->contact_force, b->contact_force, p/dt, r->axis[k]);
            vec3_add_scaled(b->contact_torque, b->contact_torque, p/dt, lever);
        }
    }
}

static void take_bodies(tobi_solver *s, const tobi_body *bodies, int count)
{
    memset(s->bodies, 0, (size_t)(count + 1)*sizeof *s->bodies);
    for (int k = 0; k < count; k++) {
        tobi_solve_body *b = &s->bodies[1 + k];
        memcpy(b->speed, bodies[k].rigid.velocity, 3*sizeof(double));
        memcpy(b->speed + 3, bodies[k].rigid.angular_velocity, 3*sizeof(double));
        tobi_rigid_inverse(&bodies[k].rigid, b->shift, b->turn);
        tobi_joint_freedom(&bodies[k].rigid, b->joint);
    }
}

static void give_bodies(const tobi_solver *s, tobi_body *bodies, int count)
{
    for (int k = 0; k < count; k++) {
        const tobi_solve_body *b = &s->bodies[1 + k];
        tobi_rigid *r = &bodies[k].rigid;
        if (r->kind == TOBI_PRESCRIBED) continue;
        memcpy(r->velocity, b->speed, sizeof r->velocity);
        if (r->joint.kind) memcpy(r->angular_velocity, b->speed + 3, sizeof r->angular_velocity);
        memcpy(r->push, b->push, sizeof r->push);
        memcpy(r->turn, b->push + 3, sizeof r->turn);
        tobi_rigid_apply_locks(r);
    }
}

static double restitution_of(const tobi_touch *c, const tobi_body *bodies)
{
    double e = bodies[c->a].rigid.restitution;
    return c->b >= 0 ? fmax(e, bodies[c->b].rigid.restitution) : e;
}

tobi_status tobi_solve(tobi_solver *s, tobi_body *bodies, int body_count, tobi_touch_list *contacts,
                       tobi_constraints *joints, double dt, double bounce, tobi_error *err)
{
    int64_t count = contacts->count;
    double fastest = 0;
    TOBI_TRY(reserve(s, count, body_count, err));
    take_bodies(s, bodies, body_count);
    s->joints = joints;
    s->owners = bodies;
    if (joints->count) begin_joints(joints, bodies);
    obey_joints(s);
    for (int64_t k = 0; k < count; k++) {
        tobi_solve_row *r = &s->rows[k];
        prepare(s, r, &contacts->at[k], bodies);
        set_target(r, restitution_of(r->contact, bodies), dt, bounce);
        fastest = fmax(fastest, fmax(0, r->target - speed_along(r, 0)));
    }
    for (int64_t k = 0; k < count; k++) warm_start(&s->rows[k]);
    sweep_all(s, count, fastest);
    push_out(s, count);
    for (int64_t k = 0; k < count; k++) finish(&s->rows[k], bodies, dt);
    if (joints->count) finish_joints(joints, bodies);
    give_bodies(s, bodies, body_count);
    return TOBI_OK;
}

void tobi_solver_free(tobi_solver *s)
{
    free(s->rows);
    free(s->bodies);
    memset(s, 0, sizeof *s);
}
