/* Joints between bodies: all of them in one dense factor, so that a chain is solved exactly, without sweeps.
   Closed at both ends of a step like RATTLE (H. C. Andersen, J. Comput. Phys. 52 (1983) 24), they keep the
   energy. Stops are rows that come and go by the sign of their impulse. Drawback: rows that others determine
   (closed loops, locked axes) are found by a small pivot. */
#include "core/constraint.h"
#include "base/error.h"
#include "geom/vec3.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define DEPENDENT 1e-11          /* of a diagonal entry: a pivot below it is rounding                  */
#define CLOSED 1e-13             /* of `reach`, or rad: gaps that are as good as none                  */
#define AT_REST 1e-7             /* rad/s: slower, a body at a stop rests on it                        */
#define NOTHING 1e-12            /* of the largest impulse: no pull of a stop                          */
enum { MOST_ROUNDS = 40, MOST_CHANGES = 12 };

/* --- from definitions ------------------------------------------------------------------------- */

static int moves(const tobi_body *bodies, int body)
{
    return body >= 0 && bodies[body].rigid.kind != TOBI_PRESCRIBED;
}

static int find_slot(tobi_constraints *c, const tobi_body *bodies, int body)
{
    if (!moves(bodies, body)) return -1;
    const int slot = tobi_constraints_slot(c, body);
    if (slot >= 0) return slot;
    c->body[c->slots] = body;
    return c->slots++;
}

/* w x y z of the body against the other. */
static void find_turn(const tobi_constraint *j, const tobi_body *bodies, double q[4])
{
    double to[4] = { 1, 0, 0, 0 };
    if (j->body[1] >= 0) memcpy(to, bodies[j->body[1]].rigid.orientation, sizeof to);
    for (int a = 1; a < 4; a++) to[a] = -to[a];
    tobi_quaternion_product(to, bodies[j->body[0]].rigid.orientation, q);
}

static void free_work(tobi_constraints *c)
{
    free(c->body);
    free(c->row);
    free(c->inverse);
    free(c->speed);
    free(c->factor);
    free(c->impulse);
    free(c->change);
    *c = (tobi_constraints){ .at = c->at, .count = c->count };
}

static tobi_status allocate(tobi_constraints *c, tobi_error *err)
{
    const size_t rows = (size_t)c->rows, slots = (size_t)c->slots;
    c->inverse = calloc(slots + 1, sizeof *c->inverse);
    c->speed = calloc(slots + 1, sizeof *c->speed);
    c->factor = calloc(rows*rows + 1, sizeof *c->factor);
    c->impulse = calloc(rows + 1, sizeof *c->impulse);
    c->change = calloc(rows + 1, sizeof *c->change);
    if (c->inverse && c->speed && c->factor && c->impulse && c->change) return TOBI_OK;
    return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %d joints", c->count);
}

tobi_status tobi_constraints_start(tobi_constraints *c, const tobi_body *bodies, int dimension,
                                   tobi_error *err)
{
    const size_t most = (size_t)c->count*TOBI_CONSTRAINT_ROWS;
    free_work(c);                                /* of a start that failed later */
    if (c->count == 0) return TOBI_OK;
    c->dimension = dimension;
    c->body = calloc(2*(size_t)c->count, sizeof *c->body);
    c->row = calloc(most, sizeof *c->row);
    if (!c->body || !c->row) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %d joints", c->count);
    for (int k = 0; k < c->count; k++) {
        tobi_constraint *j = &c->at[k];
        for (int i = tobi_constraint_row_count(c, j); i > 0; i--, c->rows++)
            for (int side = 0; side < 2; side++)
                c->row[c->rows].slot[side] = find_slot(c, bodies, j->body[side]);
        find_turn(j, bodies, j->start);
        for (int side = 0; side < 2; side++) c->reach = fmax(c->reach, vec3_length(j->point[side]));
    }
    for (int k = 0; k < c->slots; k++)
        c->reach = fmax(c->reach, vec3_length(bodies[c->body[k]].rigid.position));
    return allocate(c, err);
}

int tobi_constraints_slot(const tobi_constraints *c, int body)
{
    int k = 0;
    while (k < c->slots && c->body[k] != body) k++;
    return k < c->slots ? k : -1;
}

void tobi_constraints_free(tobi_constraints *c)
{
    free_work(c);
    free(c->at);
    memset(c, 0, sizeof *c);
}

int tobi_constraints_join(const tobi_constraints *c, int a, int b)
{
    for (int k = 0; k < c->count; k++) {
        const int *body = c->at[k].body;
        if ((body[0] == a && body[1] == b) || (body[0] == b && body[1] == a)) return 1;
    }
    return 0;
}

/* --- the equation ----------------------------------------------------------------------------- */

static double dot6(const double a[6], const double b[6])
{
    return vec3_dot(a, b) + vec3_dot(a + 3, b + 3);
}

void tobi_constraint_inverse(const tobi_rigid *r, double w[6][6])
{
    double shift[3], turn[3][3], s[6];
    tobi_rigid_inverse(r, shift, turn);
    tobi_joint_freedom(r, s);
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++) w[i][j] = r->joint.kind ? s[i]*s[j] : 0;
    for (int i = 0; i < 3; i++) {
        w[i][i] += shift[i];
        for (int j = 0; j < 3; j++) w[3 + i][3 + j] += turn[i][j];
    }
}

void tobi_constraints_take_inverse(tobi_constraints *c, const tobi_body *bodies)
{
    for (int k = 0; k < c->slots; k++) tobi_constraint_inverse(&bodies[c->body[k]].rigid, c->inverse[k]);
}

/* J W J^T of two rows. */
static double couple(const tobi_constraint_row *p, const tobi_constraint_row *q)
{
    double sum = 0;
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 2; k++)
            if (p->slot[i] >= 0 && p->slot[i] == q->slot[k]) sum += dot6(p->jacobian[i], q->answer[k]);
    return sum;
}

/* Cholesky's, by rows; of a chain most of it is zero and left out. */
static void factorize(tobi_constraints *c)
{
    const int n = c->rows;
    for (int i = 0; i < n; i++) {
        double *a = c->factor + (size_t)i*(size_t)n;
        tobi_constraint_row *p = &c->row[i];
        p->first = i;
        for (int j = i; j-- > 0;) {
            a[j] = couple(p, &c->row[j]);
            if (a[j] != 0) p->first = j;
        }
        const double whole = couple(p, p);
        double left = whole;
        for (int j = p->first; j < i; j++) {
            const double *b = c->factor + (size_t)j*(size_t)n;
            const int first = p->first > c->row[j].first ? p->first : c->row[j].first;
            for (int k = first; k < j; k++) a[j] -= a[k]*b[k];
            a[j] *= c->row[j].inverse;
            left -= a[j]*a[j];
        }
        p->mobility = left;
        p->inverse = left > DEPENDENT*whole && (!(p->stop || p->motor) || p->active) ? 1/sqrt(left) : 0;
    }
}

/* A stop at rest holds; those that a body runs into or leaves are found when velocities or gaps show it. */
static void set_stop(const tobi_constraint *j, const tobi_body *bodies, tobi_constraint_row *row)
{
    if (!row->stop) return;
    row->active = row->released = 0;
    const int stop = tobi_constraint_at_stop(j, tobi_constraint_place(j, bodies, 0));
    row->active = fabs(tobi_constraint_rate(j, bodies)) <= AT_REST ? stop : 0;
}

/* A motor that is obeyed holds; whether one drives that is not, velocities and gaps show. */
static void set_motor(const tobi_constraints *c, const tobi_constraint *j, const tobi_body *bodies,
                      tobi_constraint_row *row)
{
    if (!row) return;
    row->released = 0;
    row->active = row->motor > 0 && c->dt > 0 && !j->motor.over &&
                  (isinf(j->motor.most) || tobi_motor_follows(j, bodies));
}

void tobi_constraints_factor(tobi_constraints *c, const tobi_body *bodies)
{
    tobi_constraint_row *row = c->row;
    for (int k = 0; k < c->count; row += tobi_constraint_row_count(c, &c->at[k]), k++) {
        tobi_constraint_make_rows(c, &c->at[k], bodies, row);
        set_motor(c, &c->at[k], bodies, tobi_constraint_motor_row(c, &c->at[k], row));
        set_stop(&c->at[k], bodies, &row[tobi_constraint_row_count(c, &c->at[k]) - 1]);
        tobi_constraint_turn_pace(c, &c->at[k], bodies, row);
    }
    for (int i = 0; i < c->rows; i++)
        for (int side = 0; side < 2; side++) {
            tobi_constraint_row *r = &c->row[i];
            for (int a = 0; a < 6 && r->slot[side] >= 0; a++)
                r->answer[side][a] = dot6(c->inverse[r->slot[side]][a], r->jacobian[side]);
        }
    factorize(c);
}

/* x = (J W J^T)^-1 x */
static void solve(const tobi_constraints *c, double *x)
{
    const int n = c->rows;
    for (int i = 0; i < n; i++) {
        const double *a = c->factor + (size_t)i*(size_t)n;
        for (int j = c->row[i].first; j < i; j++) x[i] -= a[j]*x[j];
        x[i] *= c->row[i].inverse;
    }
    for (int i = n; i-- > 0;) {
        const double *a = c->factor + (size_t)i*(size_t)n;
        x[i] *= c->row[i].inverse;
        for (int j = c->row[i].first; j < i; j++) x[j] -= a[j]*x[i];
    }
}

/* Impulses c->change act on the speeds and count. */
static void apply_change(tobi_constraints *c)
{
    for (int i = 0; i < c->rows; i++) {
        const tobi_constraint_row *r = &c->row[i];
        c->impulse[i] += c->change[i];
        for (int side = 0; side < 2; side++)
            for (int a = 0; a < 6 && r->slot[side] >= 0; a++)
                c->speed[r->slot[side]][a] += c->change[i]*r->answer[side][a];
    }
}

void tobi_constraints_project(tobi_constraints *c, int moving)
{
    for (int i = 0; i < c->rows; i++) {
        const tobi_constraint_row *r = &c->row[i];
        c->change[i] = moving ? -r->pace : 0;
        for (int side = 0; side < 2; side++)
            if (r->slot[side] >= 0) c->change[i] -= dot6(r->jacobian[side], c->speed[r->slot[side]]);
    }
    solve(c, c->change);
    apply_change(c);
}

void tobi_constraints_change(tobi_constraints *c, int row, double change)
{
    memset(c->change, 0, (size_t)c->rows*sizeof *c->change);
    c->change[row] = change;
    apply_change(c);
}

/* Whether the impulse of a stop pulls: then the stop lets go, and gives it back; that of a motor has a bound
   of either sign. */
static int release(tobi_constraints *c, int i)
{
    tobi_constraint_row *r = &c->row[i];
    double most = 0;
    if (r->motor > 0) return tobi_motor_limit(c, i);
    if (!r->stop || !r->active) return 0;
    for (int k = 0; k < c->rows; k++) most = fmax(most, fabs(c->impulse[k]));
    if (!(c->impulse[i]*r->active < -NOTHING*most)) return 0;
    tobi_constraints_change(c, i, -c->impulse[i]);
    r->active = 0;
    r->released = 1;
    return 1;
}

/* Whether a body at a stop runs into it: then the stop holds. */
static int meet(tobi_constraints *c, const tobi_constraint *j, const tobi_body *bodies,
                tobi_constraint_row *r)
{
    double rate = r->pace;               /* of the gap: the angle falls as it grows */
    if (!r->stop || r->active || r->released) return 0;
    const int stop = tobi_constraint_at_stop(j, tobi_constraint_place(j, bodies, 0));
    for (int side = 0; side < 2; side++)
        if (r->slot[side] >= 0) rate += dot6(r->jacobian[side], c->speed[r->slot[side]]);
    if (!stop || !(rate*stop < 0)) return 0;
    r->active = stop;
    return 1;
}

static void bound_motors(tobi_constraints *c, double share)
{
    tobi_constraint_row *row = c->row;
    for (int k = 0; k < c->count; row += tobi_constraint_row_count(c, &c->at[k]), k++)
        if (c->at[k].motor.kind)
            tobi_motor_bound(c, &c->at[k], tobi_constraint_motor_row(c, &c->at[k], row), share);
}

void tobi_constraints_obey(tobi_constraints *c, const tobi_body *bodies)
{
    for (int i = 0; i < c->rows; i++) c->row[i].released = 0;
    bound_motors(c, 1);
    for (int n = 0, again = 1; again; n++) {
        tobi_constraint_row *row = c->row;
        again = 0;
        tobi_constraints_project(c, 1);
        for (int k = 0; k < c->count && n < MOST_CHANGES; k++) {
            tobi_constraint_row *motor = tobi_constraint_motor_row(c, &c->at[k], row);
            row += tobi_constraint_row_count(c, &c->at[k]);
            if (motor) {
                again |= release(c, (int)(motor - c->row));
                again |= tobi_motor_engage(c, motor, c->impulse[motor - c->row]);
            }
            again |= release(c, (int)(row - c->row) - 1);
            again |= meet(c, &c->at[k], bodies, row - 1);
        }
        if (again) factorize(c);
    }
}

void tobi_constraints_add_load(const tobi_constraints *c, int slot, double f[6])
{
    for (int i = 0; i < c->rows; i++)
        for (int side = 0; side < 2; side++)
            for (int a = 0; a < 6 && c->row[i].slot[side] == slot; a++)
                f[a] += c->impulse[i]*c->row[i].jacobian[side][a];
}

/* --- poses -------------------------------------------------------------------------------------- */

/* The largest gap at the next pose, in units of CLOSED. */
static double find_gaps(tobi_constraints *c, const tobi_body *bodies)
{
    tobi_constraint_row *row = c->row;
    double most = 0;
    for (int k = 0; k < c->count; row += tobi_constraint_row_count(c, &c->at[k]), k++)
        tobi_constraint_find_gap(c, &c->at[k], bodies, row);
    for (int i = 0; i < c->rows; i++) most = fmax(most, fabs(c->row[i].gap)/(c->row[i].turns ? 1 : c->reach));
    return most/CLOSED;
}

/* The next poses by the impulses so far. driven: by velocities in `speed`, which have them. */
static void drift(const tobi_constraints *c, tobi_body *bodies, double dt, int driven)
{
    for (int k = 0; k < c->slots; k++) {
        tobi_rigid *r = &bodies[c->body[k]].rigid;
        memset(r->constraint, 0, sizeof r->constraint);
        tobi_constraints_add_load(c, k, r->constraint);
        if (driven) tobi_rigid_drift_by(r, c->speed[k], c->speed[k] + 3, dt);
        else tobi_rigid_drift(r, dt);
    }
}

/* Stops that the next pose is beyond; motors that drive. */
static int hold_stops(tobi_constraints *c)
{
    int met = 0;
    for (int i = 0; i < c->rows; i++) {
        tobi_constraint_row *r = &c->row[i];
        met |= tobi_motor_engage(c, r, c->impulse[i]);
        if (!r->stop || r->active || r->gap == 0) continue;
        r->active = r->gap < 0 ? 1 : -1;
        met = 1;
    }
    if (met) factorize(c);
    return met;
}

static int release_stops(tobi_constraints *c)
{
    int any = 0;
    for (int i = 0; i < c->rows; i++) any |= release(c, i);
    if (any) factorize(c);
    return any;
}

/* Newton's method with the matrix of the present pose: each round leaves a share of the gaps that is of the
   order of the angle turned in the step. It ends where rounding does. */
static void close_gaps(tobi_constraints *c, tobi_body *bodies, double dt, int driven)
{
    double before = INFINITY;
    bound_motors(c, driven ? 1 : 0.5);
    for (int round = 0; round < MOST_ROUNDS; round++) {
        drift(c, bodies, dt, driven);
        const double now = find_gaps(c, bodies);
        const int met = hold_stops(c);
        if (!met && (now <= 1e-2 || (now <= 1 && now > 0.5*before))) {
            if (!release_stops(c)) break;
            before = INFINITY;
            continue;
        }
        before = met ? INFINITY : now;
        for (int i = 0; i < c->rows; i++) c->change[i] = -c->row[i].gap/dt;
        solve(c, c->change);
        apply_change(c);
    }
    for (int k = 0; k < c->slots; k++) tobi_body_place_next(&bodies[c->body[k]]);
}

static void forget_impulses(tobi_constraints *c)
{
    for (int k = 0; k < c->count; k++) {
        memset(c->at[k].impulse, 0, sizeof c->at[k].impulse);
        c->at[k].motor.impulse = 0;
    }
    memset(c->impulse, 0, (size_t)c->rows*sizeof *c->impulse);
}

tobi_status tobi_constraints_close(tobi_constraints *c, tobi_body *bodies, double t, double dt,
                                   tobi_error *err)
{
    tobi_constraint_row *row = c->row;
    c->driven = 0;
    if (c->count == 0) return TOBI_OK;
    tobi_motors_begin(c, bodies, dt);
    tobi_constraints_take_inverse(c, bodies);
    tobi_constraints_factor(c, bodies);
    for (int k = 0; k < c->count; row += tobi_constraint_row_count(c, &c->at[k]), k++)
        TOBI_TRY(tobi_constraint_set_pace(c, &c->at[k], bodies, t, dt, row, err));
    forget_impulses(c);
    close_gaps(c, bodies, dt, 0);
    tobi_constraints_count(c);
    return TOBI_OK;
}

/* The velocities that a liquid predicted have what motors at their bound give. */
static void begin_motors(tobi_constraints *c, double dt)
{
    tobi_constraint_row *row = c->row;
    for (int k = 0; k < c->count; row += tobi_constraint_row_count(c, &c->at[k]), k++) {
        const tobi_constraint_row *motor = tobi_constraint_motor_row(c, &c->at[k], row);
        if (motor && motor->motor > 0)
            c->impulse[motor - c->row] = -dt*vec3_dot(motor->axis, c->at[k].motor.guess);
    }
}

void tobi_constraints_drive(tobi_constraints *c, tobi_body *bodies, double dt)
{
    forget_impulses(c);
    begin_motors(c, dt);
    tobi_constraints_obey(c, bodies);
    close_gaps(c, bodies, dt, 1);
    tobi_constraints_count(c);
}

void tobi_constraints_hold(const tobi_constraints *c, tobi_body *bodies)
{
    for (int again = 1; again;) {
        again = 0;
        for (int k = 0; k < c->count; k++) {
            const int *body = c->at[k].body;
            if (!moves(bodies, body[0]) || !moves(bodies, body[1])) continue;
            tobi_rigid *a = &bodies[body[0]].rigid, *b = &bodies[body[1]].rigid;
            if (tobi_rigid_has_pull(a) == tobi_rigid_has_pull(b)) continue;
            tobi_rigid_drop_pull(a);
            tobi_rigid_drop_pull(b);
            again = 1;
        }
    }
}

/* --- what is told ------------------------------------------------------------------------------- */

void tobi_constraints_count(tobi_constraints *c)
{
    const double *impulse = c->impulse;
    const tobi_constraint_row *row = c->row;
    for (int k = 0; k < c->count; k++)
        for (int i = tobi_constraint_row_count(c, &c->at[k]); i > 0; i--, row++, impulse++)
            if (row->motor) c->at[k].motor.impulse -= *impulse;
            else vec3_add_scaled(c->at[k].impulse + 3*row->turns, c->at[k].impulse + 3*row->turns, -*impulse,
                                 row->axis);
}
