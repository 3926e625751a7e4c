/* What liquid and bodies feel besides the constant gravity, once a step at its middle: gravity in time, a
   force towards a place, and the frame of a tank that moves (decision 58). Drawback: derivatives of the frame
   are differences over a millisecond, which a motion by noisy keyframes makes noise of. */
#include "world/acceleration.h"
#include "base/error.h"
#include "base/param.h"
#include "rigid/keyframes.h"
#include "rigid/waves.h"
#include "tobiuo/motion.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* s, between the five poses; between the times at which the largest acceleration so far is looked for, which
   is so a function of time alone: steps are the same after a restart and whatever the end time. */
static const double STEP = 1e-3, SAMPLE = 0.01;
enum { SAMPLES = 1000 };
/* Times gravity: more is hardly meant. */
static const double HARD_FRAME = 3;

struct tobi_drive {
    tobi_keyframes *rows;       /* of gravity, NULL = constant                      */
    int given[3];               /* which of its components                          */
    tobi_motion *swing;         /* its shift is gravity, m/s2; NULL = none          */
    tobi_central_def central;   /* rate 0 = none                                    */
    int64_t sampled;            /* times that `sim.acceleration_most` knows         */
    tobi_motion_fn frame;       /* NULL = at rest                                   */
    void *frame_user;
};

static tobi_status need_drive(tobi_world *w, const char *what, tobi_error *err)
{
    if (w->started)
        return tobi_fail(err, TOBI_INVALID, "a started world takes no other %s", what);
    if (!w->drive) w->drive = calloc(1, sizeof *w->drive);
    return w->drive ? TOBI_OK : tobi_fail(err, TOBI_NO_MEMORY, "no memory for %s", what);
}

/* One oscillation for each component. */
static tobi_status make_swing(const tobi_gravity_def *def, tobi_motion **out, tobi_error *err)
{
    tobi_motion *part[3];
    int count = 0;
    tobi_status status = TOBI_OK;
    for (int a = 0; a < 3 && status == TOBI_OK; a++) {
        const double along[3] = { a == 0, a == 1, a == 2 };
        if (def->amplitude[a] == 0) continue;
        status = tobi_motion_oscillation(along, def->amplitude[a], 1/def->period, def->phase[a], &part[count],
                                         err);
        count += status == TOBI_OK;
        if (status == TOBI_OK)
            status = tobi_motion_set_times(part[count - 1], def->start, INFINITY, def->ramp, err);
    }
    if (status == TOBI_OK && count) status = tobi_motion_sum(part, count, out, err);
    for (int k = 0; k < count && status != TOBI_OK; k++) tobi_motion_free(part[k]);
    return status;
}

static int swings_by(const tobi_gravity_def *def)
{
    return def->amplitude[0] != 0 || def->amplitude[1] != 0 || def->amplitude[2] != 0;
}

static tobi_status make_gravity(const tobi_gravity_def *def, tobi_drive *d, tobi_error *err)
{
    const int swings = swings_by(def);
    TOBI_TRY(tobi_param_check(&tobi_gravity_table, def, err));
    if (!def->file && !swings)
        return tobi_fail(err, TOBI_INVALID, "gravity in time needs a file or an amplitude with its period");
    if (swings != (def->period > 0))
        return tobi_fail(err, TOBI_INVALID, "gravity in time has %s; a swing needs both",
                         swings ? tr("an amplitude without a period") : tr("a period without an amplitude"));
    if (def->file) TOBI_TRY(tobi_keyframes_load_gravity(def->file, d->given, &d->rows, err));
    return swings ? make_swing(def, &d->swing, err) : TOBI_OK;
}

static void free_gravity(tobi_drive *d)
{
    tobi_keyframes_free(d->rows);
    tobi_motion_free(d->swing);
    d->rows = NULL;
    d->swing = NULL;
}

void tobi_world_free_drive(tobi_world *w)
{
    if (!w->drive) return;
    free_gravity(w->drive);
    free(w->drive);
}

tobi_status tobi_gravity_check(const tobi_gravity_def *def, tobi_error *err)
{
    tobi_drive drive = { 0 };
    TOBI_NEED(def, "the definition");
    const tobi_status status = make_gravity(def, &drive, err);
    free_gravity(&drive);
    return status;
}

tobi_status tobi_world_set_gravity_in_time(tobi_world *w, const tobi_gravity_def *def, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    TOBI_NEED(def, "the definition");
    if (w->sim.def.dimension == 2 && def->amplitude[2] != 0)
        return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "gravity in time swings along z, which a 2-D "
                                          "world has not; allowed are x and y"), "gravity_in_time");
    TOBI_TRY(need_drive(w, tr("gravity in time"), err));
    free_gravity(w->drive);
    return make_gravity(def, w->drive, err);
}

tobi_status tobi_world_set_central_force(tobi_world *w, const tobi_central_def *def, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    TOBI_NEED(def, "the definition");
    TOBI_TRY(tobi_param_check(&tobi_central_table, def, err));
    TOBI_TRY(need_drive(w, tr("central force"), err));
    w->drive->central = *def;
    return TOBI_OK;
}

tobi_status tobi_world_set_frame(tobi_world *w, tobi_motion_fn motion, void *user, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    TOBI_NEED(motion, "the motion");
    TOBI_TRY(need_drive(w, tr("frame"), err));
    double direction[3];
    if (motion == tobi_motion_positions && tobi_motion_absorber(user, direction))
        return tobi_at_key(err, tobi_fail(err, TOBI_UNSUPPORTED, "a frame absorbs no waves; a body that "
                                          "moves by a piston does"), "frame");
    w->drive->frame = motion;
    w->drive->frame_user = user;
    return TOBI_OK;
}

/* --- the field -------------------------------------------------------------------------------- */

static tobi_status find_gravity(const tobi_world *w, double t, double g[3], tobi_error *err)
{
    const tobi_drive *d = w->drive;
    double turn[3][3], shift[3], at[1][3];
    const double rest[1][3] = { { 0, 0, 0 } };
    memcpy(g, w->sim.def.gravity, 3*sizeof *g);
    if (d->rows) {
        tobi_keyframes_pose(d->rows, t, shift, turn);
        for (int a = 0; a < w->sim.def.dimension; a++)
            if (d->given[a]) g[a] = shift[a];
    }
    if (!d->swing) return TOBI_OK;
    TOBI_TRY(tobi_motion_positions(d->swing, t, 1, rest, at, err));
    for (int a = 0; a < w->sim.def.dimension; a++) g[a] += at[0][a];
    return TOBI_OK;
}

/* Where the lower corner of the box is, and what its axes are turned to: columns of R. */
typedef struct pose { double s[3], R[3][3]; } pose;

static tobi_status find_pose(const tobi_world *w, double t, pose *p, tobi_error *err)
{
    const double *o = w->system[0].box.lower;
    double rest[4][3], at[4][3];
    for (int k = 0; k < 4; k++)
        for (int a = 0; a < 3; a++) rest[k][a] = o[a] + (k == a + 1);
    TOBI_TRY(w->drive->frame(w->drive->frame_user, t, 4, (const double (*)[3])rest, at, err));
    for (int a = 0; a < 3; a++) {
        p->s[a] = at[0][a];
        for (int k = 0; k < 3; k++) p->R[a][k] = at[k + 1][a] - at[0][a];
    }
    return TOBI_OK;
}

/* R^T of a vector. */
static void turn_back(const pose *p, const double v[3], double out[3])
{
    for (int a = 0; a < 3; a++) out[a] = p->R[0][a]*v[0] + p->R[1][a]*v[1] + p->R[2][a]*v[2];
}

/* The poses at t, their rates and second derivatives: central differences of fourth order. */
static tobi_status differentiate(const tobi_world *w, double t, pose *now, pose *rate, pose *second,
                                 tobi_error *err)
{
    static const double first[5] = { 1, -8, 0, 8, -1 }, twice[5] = { -1, 16, -30, 16, -1 };
    *rate = *second = (pose){ 0 };
    for (int k = 0; k < 5; k++) {
        pose p;
        TOBI_TRY(find_pose(w, t + (k - 2)*STEP, &p, err));
        if (k == 2) *now = p;
        const double *from = &p.s[0];
        double *one = &rate->s[0], *two = &second->s[0];
        for (int n = 0; n < 12; n++) {
            one[n] += first[k]*from[n]/(12*STEP);
            two[n] += twice[k]*from[n]/(12*STEP*STEP);
        }
    }
    return TOBI_OK;
}

/* u1 = u0 + dt C (u0 + u1)/2 with the antisymmetric C = -2 R^T R': its change over dt, for a = dt/2 times the
   axial vector of C, is 2/(1 + a^2) (A + A^2) u0 with A u = a x u. */
static void set_turning(const double C[3][3], double dt, double turning[3][3])
{
    const double a[3] = { 0.25*dt*(C[2][1] - C[1][2]), 0.25*dt*(C[0][2] - C[2][0]),
                          0.25*dt*(C[1][0] - C[0][1]) };
    const double a2 = a[0]*a[0] + a[1]*a[1] + a[2]*a[2], scale = dt > 0 ? 2/(dt*(1 + a2)) : 0;
    const double A[3][3] = { { 0, -a[2], a[1] }, { a[2], 0, -a[0] }, { -a[1], a[0], 0 } };
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) turning[i][j] = scale*(A[i][j] + a[i]*a[j] - (i == j ? a2 : 0));
}

/* In 2-D nothing of z. */
static void flatten(tobi_acceleration *f, int dimension)
{
    for (int a = dimension; a < 3; a++) {
        f->uniform[a] = 0;
        for (int k = 0; k < 3; k++) {
            f->gradient[a][k] = f->gradient[k][a] = 0;
            f->turning[a][k] = f->turning[k][a] = 0;
        }
    }
}

/* Gravity in time and the frame at a time, of a step dt. */
static tobi_status find_drive(const tobi_world *w, double t, double dt, tobi_acceleration *f, tobi_error *err)
{
    pose now, rate, second;
    double g[3], C[3][3];
    *f = (tobi_acceleration){ .acts = 1 };
    TOBI_TRY(find_gravity(w, t, g, err));
    if (w->drive->frame) {
        TOBI_TRY(differentiate(w, t, &now, &rate, &second, err));
        for (int a = 0; a < 3; a++) g[a] -= second.s[a];
        const double total[3] = { g[0], g[1], g[2] };
        turn_back(&now, total, g);
        for (int k = 0; k < 3; k++)
            for (int a = 0; a < 3; a++)
                for (int c = 0; c < 3; c++) {
                    f->gradient[a][k] -= now.R[c][a]*second.R[c][k];
                    C[a][k] = (c ? C[a][k] : 0) - 2*now.R[c][a]*rate.R[c][k];
                }
        set_turning((const double (*)[3])C, dt, f->turning);
    }
    for (int a = 0; a < 3; a++) f->uniform[a] = g[a] - w->sim.def.gravity[a];
    flatten(f, w->sim.def.dimension);
    return TOBI_OK;
}

/* The whole field. */
static tobi_status find_field(const tobi_world *w, double t, double dt, tobi_acceleration *f, tobi_error *err)
{
    const tobi_central_def *c = &w->drive->central;
    TOBI_TRY(find_drive(w, t, dt, f, err));
    for (int a = 0; a < w->sim.def.dimension; a++) {
        f->gradient[a][a] -= c->rate*c->rate;
        f->uniform[a] += c->rate*c->rate*(c->centre[a] - w->system[0].box.lower[a]);
    }
    return TOBI_OK;
}

static tobi_status check_central(const tobi_world *w, tobi_error *err)
{
    const tobi_box *box = &w->system[0].box;
    if (!(w->drive->central.rate > 0)) return TOBI_OK;
    for (int k = 0; k < w->system_count; k++)
        if (w->system[k].method->solids)
            return tobi_fail(err, TOBI_UNSUPPORTED, "%s does not know a central force",
                             w->system[k].method->name);
    for (int a = 0; a < box->dimension; a++)
        if (box->periodic[a])
            return tobi_fail(err, TOBI_INVALID, "the domain is periodic along %c, where a central force "
                             "would jump", "xyz"[a]);
    return TOBI_OK;
}

static int turns(const tobi_acceleration *f)
{
    double sum = 0;
    for (int a = 0; a < 3; a++)
        for (int k = 0; k < 3; k++) sum += fabs(f->gradient[a][k]) + fabs(f->turning[a][k]);
    return sum > 1e-6;
}

/* Along a periodic axis all places are alike, and with them what the frame does there. */
static tobi_status check_turn(const tobi_world *w, const tobi_acceleration *f, tobi_error *err)
{
    const tobi_box *box = &w->system[0].box;
    if (!turns(f)) return TOBI_OK;
    for (int k = 0; k < w->system_count; k++)
        if (w->system[k].method->solids)
            return tobi_fail(err, TOBI_UNSUPPORTED, "the frame turns, which %s does not know; allowed are "
                             "frames that shift", w->system[k].method->name);
    for (int a = 0; a < box->dimension; a++)
        if (box->periodic[a] && fabs(f->gradient[0][a]) + fabs(f->gradient[1][a]) +
                                fabs(f->gradient[2][a]) > 1e-6)
            return tobi_fail(err, TOBI_INVALID, "the frame turns the axis %c, along which the domain is "
                             "periodic: its forces would jump there; allowed are frames that shift, or "
                             "turn about that axis", "xyz"[a]);
    return TOBI_OK;
}

/* Of the liquid of the start at a corner of its box: bits of `corner` choose the upper end. */
static double change_at(const tobi_world *w, const tobi_acceleration *f, int corner)
{
    double x[3] = { 0 }, out[3], sum = 0;
    for (int a = 0; a < w->sim.def.dimension; a++) {
        const int upper = corner >> a & 1;
        for (int k = 0; k < w->region_count; k++) {
            const double end = (upper ? w->regions[k].upper[a] : w->regions[k].lower[a]) -
                               w->system[0].box.lower[a];
            x[a] = k == 0 ? end : upper ? fmax(x[a], end) : fmin(x[a], end);
        }
    }
    tobi_acceleration_at(f, x, out);
    for (int a = 0; a < 3; a++) sum += out[a]*out[a];
    return sqrt(sum);
}

static void keep_largest(tobi_world *w, const tobi_acceleration *f)
{
    tobi_simulation *s = &w->sim;
    for (int a = 0; a < s->def.dimension; a++) {
        double most = fabs(s->def.gravity[a] + f->uniform[a]);
        for (int k = 0; k < 3; k++) most += fabs(f->gradient[a][k])*w->system[0].box.size[k];
        s->acceleration_most[a] = fmax(s->acceleration_most[a], most);
    }
    for (int corner = 0; corner < 8; corner++)
        s->acceleration_change = fmax(s->acceleration_change, change_at(w, f, corner));
}

tobi_status tobi_world_sample_drive(tobi_world *w, double until, tobi_error *err)
{
    if (!w->drive) return TOBI_OK;
    for (; (double)w->drive->sampled*SAMPLE <= until; w->drive->sampled++) {
        tobi_acceleration f;
        TOBI_TRY(find_field(w, (double)w->drive->sampled*SAMPLE, STEP, &f, err));
        keep_largest(w, &f);
    }
    return TOBI_OK;
}

static int is_finite(const tobi_acceleration *f)
{
    double sum = 0;
    for (int a = 0; a < 3; a++) {
        sum += f->uniform[a];
        for (int k = 0; k < 3; k++) sum += f->gradient[a][k];
    }
    return isfinite(sum);
}

/* m/s2: the most that liquid at rest feels at a corner of the domain. */
static double felt_size(const tobi_world *w, const tobi_acceleration *f)
{
    double most = 0;
    for (int corner = 0; corner < 1 << w->sim.def.dimension; corner++) {
        double x[3] = { 0 }, out[3], sum = 0;
        for (int a = 0; a < w->sim.def.dimension; a++)
            x[a] = corner >> a & 1 ? w->system[0].box.size[a] : 0;
        tobi_acceleration_at(f, x, out);
        for (int a = 0; a < w->sim.def.dimension; a++) {
            const double felt = w->sim.def.gravity[a] + out[a];
            sum += felt*felt;
        }
        most = fmax(most, sqrt(sum));
    }
    return most;
}

/* Millimetres or degrees that are taken for metres or radians make a frame that no tank bears. */
static tobi_status note_frame(tobi_world *w, double most, double when, tobi_error *err)
{
    const double *g = w->sim.def.gravity, weight = sqrt(g[0]*g[0] + g[1]*g[1] + g[2]*g[2]);
    char text[TOBI_NOTE];
    if (!w->drive->frame || !(weight > 0) || most <= HARD_FRAME*weight) return TOBI_OK;
    snprintf(text, sizeof text, tr("presses the liquid with up to %.3g m/s2, %.2g times gravity, at t = %.3g "
             "s; if that is not meant, check the units of its motion, and let it begin and end at rest\n"),
             most, most/weight, when);
    return tobi_world_add_notes(w, "frame", NULL, text, err);
}

tobi_status tobi_world_start_drive(tobi_world *w, tobi_error *err)
{
    const double end = w->sim.def.end_time;
    double most = 0, when = 0;
    if (!w->drive) return TOBI_OK;
    TOBI_TRY(tobi_at_key(err, check_central(w, err), "central_force"));
    for (int n = 0; n <= SAMPLES; n++) {
        tobi_acceleration f;
        TOBI_TRY(find_drive(w, end*n/SAMPLES, STEP, &f, err));
        if (!is_finite(&f))
            return tobi_fail(err, TOBI_INVALID, "at t = %.9g s the acceleration of the frame is no number",
                             end*n/SAMPLES);
        TOBI_TRY(tobi_at_key(err, check_turn(w, &f, err), "frame"));
        const double felt = felt_size(w, &f);
        if (felt > most) most = felt, when = end*n/SAMPLES;
    }
    TOBI_TRY(note_frame(w, most, when, err));
    TOBI_TRY(tobi_world_sample_drive(w, w->sim.time, err));
    return find_field(w, 0, STEP, &w->sim.acceleration, err);
}

tobi_status tobi_world_find_pull(const tobi_world *w, double step, double *pull, tobi_error *err)
{
    const tobi_simulation *s = &w->sim;
    *pull = tobi_simulation_pull_size(s);
    for (int n = 0; w->drive && n < TOBI_LOOKS; n++) {
        tobi_acceleration f;
        double sum = 0;
        TOBI_TRY(find_drive(w, s->time + TOBI_LOOK[n]*step, step, &f, err));
        for (int a = 0; a < s->def.dimension; a++) {
            const double one = s->def.gravity[a] + f.uniform[a];
            sum += one*one;
        }
        *pull = fmax(*pull, sqrt(sum));
    }
    return TOBI_OK;
}

tobi_status tobi_world_drive(tobi_world *w, tobi_error *err)
{
    tobi_simulation *s = &w->sim;
    if (!w->drive) return TOBI_OK;
    TOBI_TRY(find_field(w, s->time + 0.5*s->dt, s->dt, &s->acceleration, err));
    for (int k = 0; k < s->body_count; k++)
        if (s->bodies[k].rigid.kind != TOBI_PRESCRIBED)
            tobi_rigid_feel(&s->bodies[k].rigid, &s->acceleration);
    return TOBI_OK;
}
