/* The kinds of motion behind one type. Four are formulas, evaluated here; others ask a script or rows of
   a file, or are several motions together. All rigid kinds end in one place: turn a point about a pivot, then
   shift it. Drawback: the library takes velocities from positions at the ends of a step. */
#include "rigid/keyframes.h"
#include "rigid/script.h"
#include "rigid/waves.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

typedef enum motion_kind {
    KIND_SCRIPT,
    KIND_TRANSLATION,
    KIND_ROTATION,
    KIND_OSCILLATION,
    KIND_SWING,
    KIND_KEYFRAMES,
    KIND_PISTON,
    KIND_FLAP,
    KIND_SUM
} motion_kind;

struct tobi_motion {
    motion_kind kind;
    tobi_script *script;    /* KIND_SCRIPT, owned                                          */
    tobi_keyframes *frames; /* KIND_KEYFRAMES, owned                                       */
    tobi_waves *waves;      /* KIND_PISTON, KIND_FLAP, owned                               */
    double arm;             /* m, of a flap: from its hinge to the still water             */
    double vector[3];       /* velocity m/s | unit axis | unit direction                   */
    double centre[3];       /* m, of what turns                                            */
    double amplitude;       /* m | degrees                                                 */
    double rate;            /* degrees/s | Hz                                              */
    double phase;           /* degrees                                                     */
    double start, stop;     /* s, of translation and rotation; oscillations: start alone   */
    double ramp;            /* s                                                           */
    tobi_motion **part;     /* KIND_SUM, owned                                             */
    int parts;
};

static tobi_status make(motion_kind kind, tobi_motion **out, tobi_error *err)
{
    *out = calloc(1, sizeof **out);
    if (!*out) return tobi_fail(err, TOBI_NO_MEMORY, "motion: out of memory");
    (*out)->kind = kind;
    (*out)->stop = INFINITY;
    return TOBI_OK;
}

static tobi_status check_finite(const char *what, const double *v, int n, tobi_error *err)
{
    for (int i = 0; i < n; i++)
        if (!isfinite(v[i])) return tobi_fail(err, TOBI_INVALID, "motion: %s must be finite", what);
    return TOBI_OK;
}

static tobi_status set_direction(const char *what, const double v[3], double out[3],
                                 tobi_error *err)
{
    TOBI_TRY(check_finite(what, v, 3, err));
    double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if (!(length > 0.0)) return tobi_fail(err, TOBI_INVALID, "motion: %s must not be zero", what);
    for (int a = 0; a < 3; a++) out[a] = v[a] / length;
    return TOBI_OK;
}

tobi_status tobi_motion_script(const char *path, const char *params_json, tobi_motion **out,
                               tobi_error *err)
{
    TOBI_NEED(out, "where the motion goes");
    *out = NULL;
    TOBI_NEED(path, "the path");
    tobi_script *script = NULL;
    TOBI_TRY(tobi_script_load(path, params_json, TOBI_MOTION_SCRIPT, &script, err));
    tobi_status status = make(KIND_SCRIPT, out, err);
    if (status == TOBI_OK) (*out)->script = script;
    else tobi_script_free(script);
    return status;
}

tobi_status tobi_motion_translation(const double velocity[3], tobi_motion **out, tobi_error *err)
{
    TOBI_NEED(out, "where the motion goes");
    *out = NULL;
    TOBI_NEED(velocity, "the velocity");
    TOBI_TRY(check_finite("velocity", velocity, 3, err));
    TOBI_TRY(make(KIND_TRANSLATION, out, err));
    for (int a = 0; a < 3; a++) (*out)->vector[a] = velocity[a];
    return TOBI_OK;
}

tobi_status tobi_motion_rotation(const double centre[3], const double axis[3],
                                 double rate_deg_per_s, tobi_motion **out, tobi_error *err)
{
    TOBI_NEED(out, "where the motion goes");
    *out = NULL;
    TOBI_NEED(centre && axis, "the centre or the axis");
    double unit[3];
    TOBI_TRY(check_finite("centre", centre, 3, err));
    TOBI_TRY(check_finite("rate", &rate_deg_per_s, 1, err));
    TOBI_TRY(set_direction("axis", axis, unit, err));
    TOBI_TRY(make(KIND_ROTATION, out, err));
    for (int a = 0; a < 3; a++) {
        (*out)->vector[a] = unit[a];
        (*out)->centre[a] = centre[a];
    }
    (*out)->rate = rate_deg_per_s;
    return TOBI_OK;
}

tobi_status tobi_motion_oscillation(const double direction[3], double amplitude_m,
                                    double frequency_hz, double phase_deg, tobi_motion **out,
                                    tobi_error *err)
{
    TOBI_NEED(out, "where the motion goes");
    *out = NULL;
    TOBI_NEED(direction, "the direction");
    double unit[3], numbers[3] = { amplitude_m, frequency_hz, phase_deg };
    TOBI_TRY(check_finite(tr("amplitude, frequency and phase"), numbers, 3, err));
    TOBI_TRY(set_direction("direction", direction, unit, err));
    TOBI_TRY(make(KIND_OSCILLATION, out, err));
    for (int a = 0; a < 3; a++) (*out)->vector[a] = unit[a];
    (*out)->amplitude = amplitude_m;
    (*out)->rate = frequency_hz;
    (*out)->phase = phase_deg;
    return TOBI_OK;
}

tobi_status tobi_motion_swing(const double centre[3], const double axis[3], double amplitude_deg,
                              double frequency_hz, double phase_deg, tobi_motion **out, tobi_error *err)
{
    TOBI_NEED(centre, "the centre");
    TOBI_TRY(check_finite("centre", centre, 3, err));
    TOBI_TRY(tobi_motion_oscillation(axis, amplitude_deg, frequency_hz, phase_deg, out, err));
    (*out)->kind = KIND_SWING;
    for (int a = 0; a < 3; a++) (*out)->centre[a] = centre[a];
    return TOBI_OK;
}

tobi_status tobi_motion_set_times(tobi_motion *motion, double start, double stop, double ramp,
                                  tobi_error *err)
{
    TOBI_NEED(motion, "the motion");
    const motion_kind kind = motion->kind;
    if (kind == KIND_SCRIPT || kind >= KIND_KEYFRAMES)
        return tobi_fail(err, TOBI_INVALID, "motion: times are for motions by numbers");
    const int swings = kind == KIND_OSCILLATION || kind == KIND_SWING;
    if (!isfinite(start) || isnan(stop) || !isfinite(ramp) || ramp < 0)
        return tobi_fail(err, TOBI_INVALID, "motion: start %g s, stop %g s, ramp %g s; start must be finite, "
                         "ramp 0 or more", start, stop, ramp);
    if (swings && isfinite(stop))
        return tobi_fail(err, TOBI_INVALID, "motion: an oscillation does not stop");
    if (!(stop - start >= 2*ramp) || !(stop > start))
        return tobi_fail(err, TOBI_INVALID, "motion: from start %g s to stop %g s there is no time for two "
                         "ramps of %g s", start, stop, ramp);
    motion->start = start;
    motion->stop = stop;
    motion->ramp = ramp;
    return TOBI_OK;
}

tobi_status tobi_motion_sum(tobi_motion *const *parts, int count, tobi_motion **out, tobi_error *err)
{
    TOBI_NEED(out, "where the motion goes");
    *out = NULL;
    TOBI_NEED(parts && count > 0, "the motions");
    for (int k = 0; k < count; k++) {
        TOBI_NEED(parts[k], "a motion");
        if (parts[k]->kind == KIND_SUM || (k > 0 && !tobi_motion_is_rigid(parts[k])))
            return tobi_fail(err, TOBI_INVALID, "motion: number %d %s", k + 1,
                             parts[k]->kind == KIND_SUM ? tr("is a sum already")
                                                        : tr("changes the shape; only the first may"));
    }
    tobi_motion **own = calloc((size_t)count, sizeof *own);
    if (!own) return tobi_fail(err, TOBI_NO_MEMORY, "motion: out of memory");
    tobi_status status = make(KIND_SUM, out, err);
    if (status != TOBI_OK) {
        free(own);
        return status;
    }
    for (int k = 0; k < count; k++) own[k] = parts[k];
    (*out)->part = own;
    (*out)->parts = count;
    return TOBI_OK;
}

tobi_status tobi_motion_keyframes(const char *path, const double pivot[3], tobi_motion **out,
                                  tobi_error *err)
{
    TOBI_NEED(out, "where the motion goes");
    *out = NULL;
    TOBI_NEED(path && pivot, "the path or the pivot");
    tobi_keyframes *frames = NULL;
    TOBI_TRY(check_finite("pivot", pivot, 3, err));
    TOBI_TRY(tobi_keyframes_load(path, &frames, err));
    tobi_status status = make(KIND_KEYFRAMES, out, err);
    if (status != TOBI_OK) {
        tobi_keyframes_free(frames);
        return status;
    }
    for (int a = 0; a < 3; a++) (*out)->centre[a] = pivot[a];
    (*out)->frames = frames;
    return TOBI_OK;
}

/* The axis of a flap turns the upper end to where the waves go. */
tobi_status tobi_motion_wave_maker(const tobi_wave_maker_def *def, tobi_motion **out, tobi_error *err)
{
    double along[3], up[3], axis[3];
    tobi_waves *waves = NULL;
    TOBI_NEED(out, "where the motion goes");
    *out = NULL;
    TOBI_NEED(def, "the definition");
    const double numbers[] = { def->depth, def->gravity, def->height, def->period, def->phase,
                               def->solitary_height, def->significant_height, def->peak_period,
                               def->peakedness, def->hinge_height, def->start, def->ramp,
                               def->absorb_period, def->focused_height, def->focus_distance, def->focus_time,
                               def->record_distance, def->longest_period, def->shortest_period };
    TOBI_TRY(check_finite(tr("every number of a wave maker"), numbers, sizeof numbers/sizeof *numbers, err));
    TOBI_TRY(check_finite("hinge", def->hinge, 3, err));
    TOBI_TRY(set_direction("direction", def->direction, along, err));
    if (def->flap) {
        TOBI_TRY(set_direction("up", def->up, up, err));
        for (int a = 0; a < 3; a++)
            axis[a] = up[(a + 1)%3]*along[(a + 2)%3] - up[(a + 2)%3]*along[(a + 1)%3];
        TOBI_TRY(set_direction(tr("direction, across up,"), axis, axis, err));
    }
    TOBI_TRY(tobi_waves_create(def, &waves, err));
    const tobi_status status = make(def->flap ? KIND_FLAP : KIND_PISTON, out, err);
    if (status != TOBI_OK) {
        tobi_waves_free(waves);
        return status;
    }
    (*out)->waves = waves;
    (*out)->arm = def->depth - def->hinge_height;
    for (int a = 0; a < 3; a++) {
        (*out)->vector[a] = def->flap ? axis[a] : along[a];
        (*out)->centre[a] = def->hinge[a];
    }
    return TOBI_OK;
}

void tobi_motion_free(tobi_motion *motion)
{
    if (!motion) return;
    for (int k = 0; k < motion->parts; k++) tobi_motion_free(motion->part[k]);
    free(motion->part);
    tobi_keyframes_free(motion->frames);
    tobi_waves_free(motion->waves);
    tobi_script_free(motion->script);
    free(motion);
}

void tobi_motion_steer(void *user, const double steer[3])
{
    tobi_motion *motion = user;
    if (!motion || !steer || tobi_motion_is_rigid(motion)) return;
    tobi_script_steer(motion->kind == KIND_SUM ? motion->part[0]->script : motion->script, steer);
}

int tobi_motion_is_rigid(const tobi_motion *motion)
{
    if (!motion) return 0;
    if (motion->kind == KIND_SUM) return tobi_motion_is_rigid(motion->part[0]);
    return motion->kind != KIND_SCRIPT || tobi_script_is_rigid(motion->script);
}

const tobi_waves *tobi_motion_waves(const tobi_motion *motion)
{
    if (motion->kind == KIND_PISTON || motion->kind == KIND_FLAP) return motion->waves;
    const tobi_waves *waves = NULL;
    for (int k = 0; k < motion->parts && !waves; k++) waves = tobi_motion_waves(motion->part[k]);
    return waves;
}

double tobi_motion_wave_depth(const tobi_motion *motion)
{
    const tobi_waves *waves = tobi_motion_waves(motion);
    return waves ? tobi_waves_depth(waves) : 0;
}

int tobi_motion_is_plain(const tobi_motion *motion)
{
    int plain = motion->kind != KIND_SCRIPT;
    for (int k = 0; k < motion->parts; k++) plain &= tobi_motion_is_plain(motion->part[k]);
    return plain;
}

const tobi_waves *tobi_motion_absorber(const tobi_motion *motion, double direction[3])
{
    const tobi_waves *found = NULL;
    tobi_absorption how;
    if (motion->kind == KIND_PISTON && tobi_waves_absorption(motion->waves, &how)) {
        memcpy(direction, motion->vector, sizeof motion->vector);
        return motion->waves;
    }
    for (int k = 0; k < motion->parts && !found; k++)
        found = tobi_motion_absorber(motion->part[k], direction);
    return found;
}

/* Rodrigues' formula as a matrix; axis is a unit vector. The angle is brought to (-360, 360) first,
   which is exact, so that long spins lose nothing. */
static void fill_rotation(const double axis[3], double degrees, double m[3][3])
{
    double angle = fmod(degrees, 360.0) * (PI / 180.0);
    double c = cos(angle), s = sin(angle), k = 1.0 - c;
    double x = axis[0], y = axis[1], z = axis[2];
    double r[3][3] = { { c + k * x * x, k * x * y - s * z, k * x * z + s * y },
                       { k * y * x + s * z, c + k * y * y, k * y * z - s * x },
                       { k * z * x - s * y, k * z * y + s * x, c + k * z * z } };
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) m[a][b] = r[a][b];
}

/* position = pivot + shift + R (rest - pivot). */
static void turn_points(const double m[3][3], const double p[3], const double shift[3], int64_t n,
                        const double (*rest)[3], double (*position)[3])
{
    for (int64_t i = 0; i < n; i++) {
        double x = rest[i][0] - p[0], y = rest[i][1] - p[1], z = rest[i][2] - p[2];
        for (int a = 0; a < 3; a++)
            position[i][a] = p[a] + shift[a] + (m[a][0] * x + m[a][1] * y + m[a][2] * z);
    }
}

/* Pure shifts keep the points' shape to the last bit, so they skip the matrix. */
static void shift_points(const double shift[3], int64_t n, const double (*rest)[3],
                         double (*position)[3])
{
    for (int64_t i = 0; i < n; i++)
        for (int a = 0; a < 3; a++) position[i][a] = rest[i][a] + shift[a];
}

/* Share of the full speed or amplitude, `since` s after the start of a ramp: half a cosine. */
static double rise(double since, double ramp)
{
    return since <= 0 ? 0 : since >= ramp ? 1 : 0.5*(1 - cos(PI*since/ramp));
}

/* Its integral, s. */
static double risen(double since, double ramp)
{
    if (since <= 0) return 0;
    return since >= ramp ? since - 0.5*ramp : 0.5*(since - ramp*sin(PI*since/ramp)/PI);
}

/* The time that a translation or rotation at full speed would have taken to come as far, s. */
static double count_time(const tobi_motion *m, double t)
{
    const double since = t - m->start, left = m->stop - t;
    if (m->ramp == 0) return t >= m->stop ? m->stop - m->start : since > 0 ? since : 0;
    if (left >= m->ramp) return risen(since, m->ramp);
    return (m->stop - m->start - m->ramp) - risen(left, m->ramp);
}

static double swing(const tobi_motion *m, double t)
{
    double s = sin(2.0*PI*fmod(m->rate*t, 1.0) + m->phase*(PI/180.0));
    return m->ramp > 0 || m->start != 0 ? m->amplitude*rise(t - m->start, m->ramp)*s : m->amplitude*s;
}

/* A rigid motion at a time: what turns, if anything, then shifts. */
typedef struct placing { double turn[3][3], pivot[3], shift[3]; int turns; } placing;

static tobi_status find_pose(const tobi_motion *m, double t, tobi_pose *pose, tobi_error *err)
{
    *pose = (tobi_pose){ .axis = { 0.0, 0.0, 1.0 } };
    if (m->kind == KIND_SCRIPT) return tobi_script_place(m->script, t, pose, err);
    const int turns = m->kind == KIND_ROTATION || m->kind == KIND_SWING || m->kind == KIND_FLAP;
    const double way = m->waves ? tobi_waves_displacement(m->waves, t) : 0;
    for (int a = 0; a < 3; a++) {
        if (turns) pose->axis[a] = m->vector[a];
        if (turns) pose->pivot[a] = m->centre[a];
        if (m->kind == KIND_TRANSLATION) pose->shift[a] = m->vector[a]*count_time(m, t);
        if (m->kind == KIND_PISTON) pose->shift[a] = m->vector[a]*way;
        if (m->kind == KIND_OSCILLATION) pose->shift[a] = m->vector[a]*swing(m, t);
    }
    if (m->kind == KIND_ROTATION) pose->degrees = m->rate*count_time(m, t);
    if (m->kind == KIND_SWING) pose->degrees = swing(m, t);
    if (m->kind == KIND_FLAP) pose->degrees = atan(way/m->arm)*(180/PI);
    return TOBI_OK;
}

static tobi_status find_placing(const tobi_motion *m, double t, placing *p, tobi_error *err)
{
    tobi_pose pose;
    *p = (placing){ .turns = m->kind == KIND_KEYFRAMES };
    memcpy(p->pivot, m->centre, sizeof p->pivot);
    if (m->kind == KIND_KEYFRAMES) {
        tobi_keyframes_pose(m->frames, t, p->shift, p->turn);
        return TOBI_OK;
    }
    TOBI_TRY(find_pose(m, t, &pose, err));
    memcpy(p->shift, pose.shift, sizeof p->shift);
    memcpy(p->pivot, pose.pivot, sizeof p->pivot);
    p->turns = pose.degrees != 0.0;
    if (p->turns) fill_rotation(pose.axis, pose.degrees, p->turn);
    return TOBI_OK;
}

/* Turns in the order of the parts, each about its own centre; then all shifts together. */
static tobi_status move_by_sum(const tobi_motion *m, double t, int64_t n, const double (*rest)[3],
                               double (*position)[3], tobi_error *err)
{
    static const double none[3] = { 0 };
    double shift[3] = { 0 };
    const int deforms = !tobi_motion_is_rigid(m->part[0]);
    if (deforms) TOBI_TRY(tobi_script_deform(m->part[0]->script, t, n, rest, position, err));
    else memcpy(position, rest, (size_t)n*sizeof *rest);
    for (int k = deforms; k < m->parts; k++) {
        placing p;
        TOBI_TRY(find_placing(m->part[k], t, &p, err));
        for (int a = 0; a < 3; a++) shift[a] += p.shift[a];
        if (!p.turns) continue;
        turn_points((const double (*)[3])p.turn, p.pivot, none, n, (const double (*)[3])position, position);
    }
    shift_points(shift, n, (const double (*)[3])position, position);
    return TOBI_OK;
}

tobi_status tobi_motion_positions(void *user, double t, int64_t n, const double (*rest)[3],
                                  double (*position)[3], tobi_error *err)
{
    TOBI_NEED(user, "the motion");
    TOBI_NEED(n <= 0 || (rest && position), "a list of positions");
    const tobi_motion *motion = user;
    placing p;
    if (motion->kind == KIND_SUM) return move_by_sum(motion, t, n, rest, position, err);
    if (!tobi_motion_is_rigid(motion))
        return tobi_script_deform(motion->script, t, n, rest, position, err);
    TOBI_TRY(find_placing(motion, t, &p, err));
    if (p.turns) turn_points((const double (*)[3])p.turn, p.pivot, p.shift, n, rest, position);
    else shift_points(p.shift, n, rest, position);
    return TOBI_OK;
}
