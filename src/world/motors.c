/* Motors of hinges and guides: what they are told is a function of time, a constant, a swing or rows of a
   file, so that restarts know it. A constant that grows is a swing of frequency 0 and phase 90 degrees.
   Drawback: a motor of a body's own joint is a constraint beside it. */
#include "world/motors.h"
#include "base/error.h"
#include "base/param.h"
#include "geom/vec3.h"
#include "rigid/keyframes.h"
#include "tobiuo/motion.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double SOON = 1e-9;         /* s, or share of the time: just before and after it           */
static const double JUMP = 1e-6;         /* in the unit of the motor: smaller, it is rounding           */
static const double KICK = 1e-3;         /* the same per second, of a difference over SOON              */

/* The words of a hinge, a guide and a slide. */
static const struct { const char *joint, *place, *unit, *load, *most, *has; } words[] = {
    { "hinge", "angle", "degrees", "torque", "torque_max",
      TR("hinge that it turns; a hinge has point and axis") },
    { "guide", "position", "m", "force", "force_max",
      TR("guide that it moves it along; a guide has an axis") },
    { "slide", "position", "m", "force", "force_max", NULL } };

struct tobi_motor_source {
    int joint, body;             /* as of tobi_motors_add; from the start on `joint` is a constraint      */
    int slides;                  /* 1: of a guide, 2: of a slide                                         */
    int kind;                    /* tobi_motor_kind                                                     */
    double most;                 /* N m, N                                                              */
    double start;                /* s: of the definition                                                */
    tobi_keyframes *rows;        /* NULL: no file                                                       */
    tobi_motion *motion;         /* its shift along x is the value; NULL: 0, or a file                  */
};

/* --- definitions -------------------------------------------------------------------------------- */

static int is_number(double v) { return v != TOBI_NOT_GIVEN; }

/* All of it 0 is none, too: joints of C programs that leave it out. */
int tobi_motor_is_given(const tobi_motor_def *def)
{
    static const tobi_motor_def zero;
    return is_number(def->speed) + is_number(def->angle) + is_number(def->torque) > 0
           ? memcmp(def, &zero, sizeof zero) != 0
           : def->file || def->amplitude != 0 || def->period != 0 || def->phase != 0 || def->start != 0 ||
             def->ramp != 0 || def->torque_max != 0;
}

static tobi_status refuse(tobi_error *err, const char *key, const char *what)
{
    return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "%s", what), "%s", key);
}

static tobi_status refuse_most(const tobi_motor_def *d, int slides, tobi_error *err)
{
    const char *most = words[slides].most;
    if (!(d->torque_max > 0)) return TOBI_OK;
    return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "%s is for a motor by speed or %s; this one has a "
                                      "%s", most, words[slides].place, words[slides].load), "%s", most);
}

static tobi_status check_keys(const tobi_motor_def *d, int slides, tobi_error *err)
{
    const char *load = words[slides].load;
    const int count = is_number(d->speed) + is_number(d->angle) + is_number(d->torque) + (d->file != NULL);
    if (count != 1)
        return tobi_fail(err, TOBI_INVALID, "a motor has one of speed, %s, %s and file; this one has %s",
                         words[slides].place, load, count ? tr("several") : tr("none"));
    if (d->file && (d->amplitude != 0 || d->period != 0 || d->phase != 0 || d->start != 0 || d->ramp != 0))
        return refuse(err, "file", tr("a motor with a file has no amplitude, period, phase, start and ramp: "
                      "the file says all"));
    if ((d->amplitude != 0) != (d->period > 0))
        return refuse(err, d->period > 0 ? "period" : "amplitude", tr("a motor that swings has an amplitude "
                                                                   "and a period; this one has one of them"));
    return is_number(d->torque) ? refuse_most(d, slides, err) : TOBI_OK;
}

/* Adds a swing to the parts, if it is one. */
static tobi_status add_swing(const tobi_motor_def *def, double amplitude, double frequency, double phase,
                             tobi_motion **part, int *count, tobi_error *err)
{
    static const double along[3] = { 1, 0, 0 };
    if (amplitude == 0) return TOBI_OK;
    TOBI_TRY(tobi_motion_oscillation(along, amplitude, frequency, phase, &part[*count], err));
    return tobi_motion_set_times(part[(*count)++], def->start, INFINITY, def->ramp, err);
}

static tobi_status make_value(const tobi_motor_def *def, double constant, tobi_motion **out, tobi_error *err)
{
    tobi_motion *part[2];
    int count = 0;
    tobi_status status = add_swing(def, constant, 0, 90, part, &count, err);
    if (status == TOBI_OK && def->amplitude != 0)
        status = add_swing(def, def->amplitude, 1/def->period, def->phase, part, &count, err);
    if (status == TOBI_OK && count) status = tobi_motion_sum(part, count, out, err);
    for (int k = 0; k < count && status != TOBI_OK; k++) tobi_motion_free(part[k]);
    return status;
}

static void free_source(tobi_motor_source *m)
{
    tobi_keyframes_free(m->rows);
    tobi_motion_free(m->motion);
}

/* In the unit of the definition. */
static tobi_status find_value(const tobi_motor_source *m, double t, double *value, tobi_error *err)
{
    const double rest[1][3] = { { 0, 0, 0 } };
    double shift[3] = { 0 }, turn[3][3];
    if (m->rows) tobi_keyframes_pose(m->rows, t, shift, turn);
    else if (m->motion) TOBI_TRY(tobi_motion_positions(m->motion, t, 1, rest, &shift, err));
    *value = shift[0];
    return TOBI_OK;
}

/* A place that is not where the hinge begins would be reached in one step. */
static tobi_status check_start(const tobi_motor_source *m, tobi_error *err)
{
    double start;
    TOBI_TRY(find_value(m, 0, &start, err));
    if (m->kind != TOBI_MOTOR_ANGLE || !isinf(m->most) || start == 0) return TOBI_OK;
    return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "the motor asks for %.10g %s at time 0, where the "
                                      "%s is at 0; allowed are 0, or a ramp or %s in which it gets there",
                                      start, words[m->slides].unit, words[m->slides].joint,
                                      words[m->slides].most),
                       "%s", m->rows ? "file" : words[m->slides].place);
}

/* With `slides` given. On failure nothing is left of it. */
static tobi_status make_source(const tobi_motor_def *d, tobi_motor_source *m, tobi_error *err)
{
    int column = is_number(d->speed) ? 0 : is_number(d->angle) ? 1 : 2;
    const double constant[] = { d->speed, d->angle, d->torque };
    TOBI_TRY(check_keys(d, m->slides, err));
    tobi_status status = TOBI_OK;
    if (d->file)
        status = tobi_at_key(err, tobi_keyframes_load_motor(d->file, m->slides != 0, &column, &m->rows,
                                                        err),
                             "file");
    else status = make_value(d, constant[column], &m->motion, err);
    m->kind = TOBI_MOTOR_SPEED + column;
    m->most = d->torque_max > 0 ? d->torque_max : INFINITY;
    m->start = d->start;
    if (status == TOBI_OK && m->kind == TOBI_MOTOR_TORQUE) status = refuse_most(d, m->slides, err);
    if (status == TOBI_OK) status = check_start(m, err);
    if (status != TOBI_OK) free_source(m);
    return status;
}

tobi_status tobi_motor_check(const tobi_motor_def *def, int slides, tobi_error *err)
{
    tobi_motor_source m = { .slides = slides > 1 ? 2 : slides != 0 };
    TOBI_NEED(def, "the definition");
    if (!tobi_motor_is_given(def)) return TOBI_OK;
    TOBI_TRY(make_source(def, &m, err));
    free_source(&m);
    return TOBI_OK;
}

/* --- of a world --------------------------------------------------------------------------------- */

/* A mistake has its key in the definition of the motor so far. */
static tobi_status place_error(tobi_error *err, tobi_status status, const char *key)
{
    char inner[sizeof err->key];
    if (!err || status == TOBI_OK) return status;
    memcpy(inner, err->key, sizeof inner);
    err->key[0] = '\0';
    return tobi_at_key(err, status, "%s%s%.24s", key, inner[0] ? "." : "", inner);
}

tobi_status tobi_motors_add(tobi_world *w, const tobi_motor_def *def, const char *key, int slides, int joint,
                            int body, tobi_error *err)
{
    tobi_motor_source m = { .joint = joint, .body = body, .slides = slides };
    if (!tobi_motor_is_given(def)) return TOBI_OK;
    const tobi_body *b = joint < 0 ? &w->sim.bodies[body] : NULL;
    if (b && b->rigid.joint.kind != (slides ? TOBI_JOINT_GUIDE : TOBI_JOINT_HINGE))
        return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "body '%s' has a motor and no %s", b->name,
                                          tr(words[slides].has)), "%s", key);
    TOBI_TRY(place_error(err, make_source(def, &m, err), key));
    tobi_motor_source *more = realloc(w->motors, (size_t)(w->motor_count + 1)*sizeof *more);
    if (!more) {
        free_source(&m);
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a motor");
    }
    w->motors = more;
    w->motors[w->motor_count++] = m;
    return TOBI_OK;
}

void tobi_motors_free(tobi_world *w)
{
    for (int k = 0; k < w->motor_count; k++) free_source(&w->motors[k]);
    free(w->motors);
}

int tobi_motors_joint_count(const tobi_world *w)
{
    const tobi_constraints *c = &w->sim.constraints;
    int count = c->count;
    while (count > 0 && c->at[count - 1].kind == TOBI_BETWEEN_MOTOR) count--;
    return count;
}

const tobi_constraint *tobi_motors_of_body(const tobi_world *w, int body)
{
    const tobi_constraints *c = &w->sim.constraints;
    for (int k = tobi_motors_joint_count(w); k < c->count; k++)
        if (c->at[k].body[0] == body) return &c->at[k];
    return NULL;
}

/* About the axis that the body's joint has, as the body holds it, or along it. */
static void make_own(const tobi_world *w, int body, tobi_constraint *j)
{
    const tobi_rigid *r = &w->sim.bodies[body].rigid;
    double turn[3][3];
    *j = (tobi_constraint){ .kind = TOBI_BETWEEN_MOTOR, .body = { body, -1 },
                            .slides = r->joint.kind == TOBI_JOINT_GUIDE };
    snprintf(j->name, sizeof j->name, "%s", w->sim.bodies[body].name);
    tobi_quaternion_matrix(r->orientation, turn);
    memcpy(j->axis[1], r->joint.axis, sizeof j->axis[1]);
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) j->axis[0][a] += turn[b][a]*r->joint.axis[b];
}

tobi_status tobi_motors_start(tobi_world *w, tobi_error *err)
{
    tobi_constraints *c = &w->sim.constraints;
    c->count = tobi_motors_joint_count(w);               /* of a start that failed later */
    tobi_constraint *more = realloc(c->at, (size_t)(c->count + w->motor_count + 1)*sizeof *more);
    if (!more) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for motors");
    c->at = more;
    for (int k = 0; k < w->motor_count; k++) {
        tobi_motor_source *m = &w->motors[k];
        if (m->body >= 0) {
            m->joint = c->count;
            make_own(w, m->body, &c->at[c->count++]);
        }
        c->at[m->joint].motor = (tobi_motor){ .kind = m->kind, .most = m->most };
    }
    return tobi_motors_tell(w, 0, 0, err);
}

/* Of a place just after t, or just before it with `soon` below 0: in its unit per second. A parabola, so that
   a short ramp has none. */
static tobi_status find_rate(const tobi_motor_source *m, double t, double soon, double *rate, tobi_error *err)
{
    double at[3];
    for (int k = 0; k < 3; k++) TOBI_TRY(find_value(m, t + (k + 1)*soon, &at[k], err));
    *rate = (-5*at[0] + 8*at[1] - 3*at[2])/(2*soon);
    return TOBI_OK;
}

/* At time t a motor that is as strong as it must be asks at once for a place, or for a speed. */
static tobi_status note_asked(tobi_world *w, const tobi_motor_source *m, double t, double asked, int speed,
                              tobi_error *err)
{
    char text[TOBI_NOTE];
    snprintf(text, sizeof text, tr("its motor asks for %.4g %s%s at %.4g s: the body %s that in one step, by "
             "as large a %s as it takes; %s, or a %s, lets it get there in time\n"), asked,
             words[m->slides].unit,
             speed ? "/s" : "", t, speed ? tr("has") : tr("goes"), words[m->slides].load,
             m->rows ? tr("a file that begins where the body is") : tr("a ramp"), words[m->slides].most);
    return tobi_world_add_notes(w, m->body < 0 ? "joint" : "body", w->sim.constraints.at[m->joint].name, text,
                                err);
}

/* A jump of a speed at time t; of a place, or else of its rate. At the start from what the joint has. */
static tobi_status note_jump(tobi_world *w, const tobi_motor_source *m, double t, tobi_error *err)
{
    const tobi_constraint *j = &w->sim.constraints.at[m->joint];
    const double soon = SOON*(1 + t);
    const double own = tobi_constraint_rate(j, w->sim.bodies)*(m->slides ? 1 : 180/acos(-1));
    double before, after, slope, rate = 0;
    TOBI_TRY(find_value(m, t > 0 ? t - soon : 0, &before, err));
    TOBI_TRY(find_value(m, t + soon, &after, err));
    if (m->kind == TOBI_MOTOR_SPEED) {
        const double jump = after - (t > 0 ? before : own);
        return fabs(jump) > JUMP ? note_asked(w, m, t, after, 1, err) : TOBI_OK;
    }
    if (t > 0) TOBI_TRY(find_rate(m, t, -soon, &rate, err));
    TOBI_TRY(find_rate(m, t, soon, &slope, err));
    if (fabs(after - before - soon*(rate + slope)) > JUMP) return note_asked(w, m, t, after, 0, err);
    if (t == 0) rate = own;
    return fabs(slope - rate) > KICK ? note_asked(w, m, t, slope, 1, err) : TOBI_OK;
}

tobi_status tobi_motors_note(tobi_world *w, tobi_error *err)
{
    for (int k = 0; k < w->motor_count; k++) {
        const tobi_motor_source *m = &w->motors[k];
        if (m->kind == TOBI_MOTOR_TORQUE || !isinf(m->most)) continue;
        TOBI_TRY(note_jump(w, m, 0, err));
        if (m->start > 0) TOBI_TRY(note_jump(w, m, m->start, err));
    }
    return TOBI_OK;
}

tobi_status tobi_motors_tell(tobi_world *w, double t, double dt, tobi_error *err)
{
    const double degree = acos(-1)/180;
    for (int k = 0; k < w->motor_count; k++) {
        tobi_motor_source *m = &w->motors[k];
        tobi_motor *motor = &w->sim.constraints.at[m->joint].motor;
        const double unit = m->slides || m->kind == TOBI_MOTOR_TORQUE ? 1 : degree;
        double before, value;
        if (motor->is_set) {                     /* by a control program */
            motor->before = motor->last;
            motor->value = dt > 0 ? motor->set : motor->last;
            continue;
        }
        TOBI_TRY(find_value(m, t, &before, err));
        TOBI_TRY(find_value(m, t + dt, &value, err));
        motor->before = unit*before;
        motor->value = unit*value;
    }
    return TOBI_OK;
}

/* --- checkpoints ---------------------------------------------------------------------------------- */

tobi_status tobi_motors_put(const tobi_world *w, tobi_store *f, tobi_error *err)
{
    double (*rows)[TOBI_MOTOR_DOUBLES] = malloc((size_t)(w->motor_count + 1)*sizeof *rows);
    int any = 0;
    if (!rows) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for motors");
    for (int k = 0; k < w->motor_count; k++) {
        const tobi_motor *m = &w->sim.constraints.at[w->motors[k].joint].motor;
        memcpy(rows[k], (double[]){ m->is_set, m->set, m->last }, sizeof *rows);
        any |= m->is_set;
    }
    const tobi_status status = any ? tobi_store_put(f, "motors", TOBI_F64, w->motor_count, TOBI_MOTOR_DOUBLES,
                                                    rows, err) : TOBI_OK;
    free(rows);
    return status;
}

tobi_status tobi_motors_read(const tobi_world *w, tobi_store *f, double (**rows)[TOBI_MOTOR_DOUBLES],
                             tobi_error *err)
{
    *rows = calloc((size_t)w->motor_count + 1, sizeof **rows);
    if (!*rows) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for motors");
    if (w->motor_count == 0 || !tobi_store_has(f, "motors")) return TOBI_OK;
    TOBI_TRY(tobi_store_get(f, "motors", TOBI_F64, w->motor_count, TOBI_MOTOR_DOUBLES, *rows, err));
    for (int k = 0; k < w->motor_count; k++)
        for (int n = 0; n < TOBI_MOTOR_DOUBLES; n++)
            if (!isfinite((*rows)[k][n]))
                return tobi_fail(err, TOBI_DAMAGED, "the checkpoint's motors are told what is no number");
    return TOBI_OK;
}

void tobi_motors_take(tobi_world *w, const double (*rows)[TOBI_MOTOR_DOUBLES])
{
    for (int k = 0; k < w->motor_count; k++) {
        tobi_motor *m = &w->sim.constraints.at[w->motors[k].joint].motor;
        m->is_set = rows[k][0] != 0;
        m->set = rows[k][1];
        m->last = rows[k][2];
    }
}
