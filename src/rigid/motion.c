/* The kinds of motion behind one type. Three are formulas, evaluated here; others ask a script or rows of
   a file. All rigid kinds end in one place: pose a point about a pivot. */
#include "rigid/keyframes.h"
#include "rigid/script.h"
#include <math.h>
#include <stdlib.h>

#define PI 3.14159265358979323846

typedef enum motion_kind {
    KIND_SCRIPT,
    KIND_TRANSLATION,
    KIND_ROTATION,
    KIND_OSCILLATION,
    KIND_KEYFRAMES
} motion_kind;

struct tobi_motion {
    motion_kind kind;
    tobi_script *script;    /* KIND_SCRIPT, owned                                          */
    tobi_keyframes *frames; /* KIND_KEYFRAMES, owned                                       */
    double vector[3];       /* velocity m/s | unit axis | unit direction                   */
    double centre[3];       /* m, KIND_ROTATION and KIND_KEYFRAMES                         */
    double amplitude;       /* m                                                           */
    double rate;            /* degrees/s | Hz                                              */
    double phase;           /* degrees                                                     */
};

static tobi_status make(motion_kind kind, tobi_motion **out, tobi_error *err)
{
    *out = calloc(1, sizeof **out);
    if (!*out) return tobi_fail(err, TOBI_NO_MEMORY, "motion: out of memory");
    (*out)->kind = kind;
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
    TOBI_TRY(check_finite("amplitude, frequency and phase", numbers, 3, err));
    TOBI_TRY(set_direction("direction", direction, unit, err));
    TOBI_TRY(make(KIND_OSCILLATION, out, err));
    for (int a = 0; a < 3; a++) (*out)->vector[a] = unit[a];
    (*out)->amplitude = amplitude_m;
    (*out)->rate = frequency_hz;
    (*out)->phase = phase_deg;
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

void tobi_motion_free(tobi_motion *motion)
{
    if (!motion) return;
    tobi_keyframes_free(motion->frames);
    tobi_script_free(motion->script);
    free(motion);
}

int tobi_motion_is_rigid(const tobi_motion *motion)
{
    return motion && (motion->kind != KIND_SCRIPT || tobi_script_is_rigid(motion->script));
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

static void pose_points(const tobi_pose *pose, int64_t n, const double (*rest)[3],
                        double (*position)[3])
{
    double m[3][3];
    fill_rotation(pose->axis, pose->degrees, m);
    turn_points((const double (*)[3])m, pose->pivot, pose->shift, n, rest, position);
}

/* Pure shifts keep the points' shape to the last bit, so they skip the matrix. */
static void shift_points(const double shift[3], int64_t n, const double (*rest)[3],
                         double (*position)[3])
{
    for (int64_t i = 0; i < n; i++)
        for (int a = 0; a < 3; a++) position[i][a] = rest[i][a] + shift[a];
}

static void move_points(const tobi_pose *pose, int64_t n, const double (*rest)[3],
                        double (*position)[3])
{
    if (pose->degrees == 0.0) shift_points(pose->shift, n, rest, position);
    else pose_points(pose, n, rest, position);
}

tobi_status tobi_motion_positions(void *user, double t, int64_t n, const double (*rest)[3],
                                  double (*position)[3], tobi_error *err)
{
    TOBI_NEED(user, "the motion");
    const tobi_motion *motion = user;
    tobi_pose pose = { .axis = { 0.0, 0.0, 1.0 } };
    switch (motion->kind) {
    case KIND_SCRIPT:
        if (!tobi_script_is_rigid(motion->script))
            return tobi_script_deform(motion->script, t, n, rest, position, err);
        TOBI_TRY(tobi_script_place(motion->script, t, &pose, err));
        break;
    case KIND_TRANSLATION:
        for (int a = 0; a < 3; a++) pose.shift[a] = motion->vector[a] * t;
        break;
    case KIND_ROTATION:
        for (int a = 0; a < 3; a++) {
            pose.axis[a] = motion->vector[a];
            pose.pivot[a] = motion->centre[a];
        }
        pose.degrees = motion->rate * t;
        break;
    case KIND_OSCILLATION: {
        double s = sin(2.0 * PI * fmod(motion->rate * t, 1.0) + motion->phase * (PI / 180.0));
        for (int a = 0; a < 3; a++) pose.shift[a] = motion->vector[a] * motion->amplitude * s;
        break;
    }
    case KIND_KEYFRAMES: {
        double m[3][3];
        tobi_keyframes_pose(motion->frames, t, pose.shift, m);
        turn_points((const double (*)[3])m, motion->centre, pose.shift, n, rest, position);
        return TOBI_OK;
    }
    }
    move_points(&pose, n, rest, position);
    return TOBI_OK;
}
