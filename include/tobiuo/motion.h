/* Prescribed motion of a body: a user's Lua script, translation, rotation, oscillation, keyframes from a
   CSV file, or several of them together; and scripts that control a body or set a fluid in motion.
   docs/scripts.md says what a script may define, docs/scene.md which columns keyframes have.

   A motion is a pure function of time and rest position, so that rates by central difference, a
   restart and any order of evaluation give the same numbers. One motion belongs to one body; it is
   not safe to evaluate the same motion from two threads at once:

     tobi_motion_rotation(centre, axis, 90, &motion, &err);
     body.motion = tobi_motion_positions, body.motion_user = motion;
     body.motion_rigid = tobi_motion_is_rigid(motion);

   A script runs in a process of its own, so that a mistake in it is an error text here. Calls must come from
   the process that loaded it, from any of its threads, one at a time. */
#ifndef TOBIUO_MOTION_H
#define TOBIUO_MOTION_H
#include "tobiuo/types.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct tobi_motion tobi_motion;

/* Loads a motion script, which defines deform() or place(). params_json is the text of a JSON
   object that the script sees as the table `params`; NULL means {}. On failure *out is NULL and err
   names file and line: TOBI_NOT_FOUND no such file, TOBI_IO unreadable, TOBI_INVALID broken
   params_json, TOBI_SCRIPT an error in the script itself. */
TOBI_API tobi_status tobi_motion_script(const char *path, const char *params_json, tobi_motion **out,
                               tobi_error *err);

/* position = rest + velocity t, velocity in m/s. */
TOBI_API tobi_status tobi_motion_translation(const double velocity[3], tobi_motion **out, tobi_error *err);

/* Turns about the line through centre (m) along axis (any length but zero) by rate t, degrees/s,
   right-handed. */
TOBI_API tobi_status tobi_motion_rotation(const double centre[3], const double axis[3],
                                 double rate_deg_per_s, tobi_motion **out, tobi_error *err);

/* position = rest + direction/|direction| amplitude sin(2 pi frequency t + phase). */
TOBI_API tobi_status tobi_motion_oscillation(const double direction[3], double amplitude_m,
                                    double frequency_hz, double phase_deg, tobi_motion **out,
                                    tobi_error *err);

/* Turns to and fro about the line through centre (m) along axis, right-handed: by
   amplitude sin(2 pi frequency t + phase), degrees. */
TOBI_API tobi_status tobi_motion_swing(const double centre[3], const double axis[3], double amplitude_deg,
                                       double frequency_hz, double phase_deg, tobi_motion **out,
                                       tobi_error *err);

/* When a motion by numbers is under way, s. A translation or rotation rests until start. Then its speed
   rises by (1 - cos(pi s/ramp))/2 for `ramp` seconds and falls likewise in the last `ramp` seconds before
   stop; then it rests. stop may be INFINITY. The amplitude of an oscillation is 0 until start and rises so;
   its stop is INFINITY, and its sine counts from time 0. TOBI_INVALID for other kinds, and without time for
   both ramps. */
TOBI_API tobi_status tobi_motion_set_times(tobi_motion *motion, double start, double stop, double ramp,
                                           tobi_error *err);

/* Several motions of one body: turns one after the other, each about its own centre as given, then all shifts
   together. Only the first may be a script that deforms. On success the sum owns the parts, else the caller.
   TOBI_INVALID for parts that are sums. */
TOBI_API tobi_status tobi_motion_sum(tobi_motion *const *parts, int count, tobi_motion **out,
                                     tobi_error *err);

/* A wave maker: a piston shifts along a direction, a flap turns about a hinge. One kind of waves, by its
   height above 0: regular by linear theory (Biesel 1951) or, of a piston, second order (Madsen 1971);
   solitary, of a piston (Goring 1978); irregular, focused (Tromans et al. 1991) and those of a record_file,
   sums of regular ones. Members of the other kinds are not read. */
typedef enum tobi_spectrum { TOBI_JONSWAP, TOBI_PIERSON_MOSKOWITZ } tobi_spectrum;
typedef struct tobi_wave_maker_def {
    int    flap;                  /* 1: it turns, 0: a piston                                        */
    double direction[3];          /* of any length, level: where the waves go                        */
    double up[3];                 /* of any length, against gravity; of a flap                       */
    double hinge[3];              /* m, a point of the axis of a flap                                */
    double hinge_height;          /* m above the bottom, negative below; of a flap                   */
    double depth;                 /* m, of still water                                               */
    double gravity;               /* m/s2                                                            */
    double height, period, phase; /* m from trough to crest, s, degrees: regular waves               */
    int    order;                 /* 1 or 2                                                          */
    double solitary_height;       /* m                                                               */
    double significant_height;    /* m, 4 sqrt(m0): irregular waves                                  */
    double focused_height;        /* m, of the crest above still water: a focused group              */
    double focus_distance;        /* m, in front of the maker at rest                                */
    double focus_time;            /* s                                                               */
    double peak_period;           /* s, of irregular waves and focused groups, and so are the next   */
    int    spectrum;              /* tobi_spectrum                                                   */
    double peakedness;            /* 1, gamma of JONSWAP                                             */
    int    seed, components;      /* of the phases; how many regular waves                           */
    const char *record_file;      /* CSV with the time (s) and the level (m) of waves to make; NULL: none */
    const char *record_column;    /* the name of the level there, NULL: "level"                      */
    double record_distance;       /* m, where it was measured, in front of the maker at rest         */
    double longest_period, shortest_period;   /* s, of the record that count; 0: 2 and 1/3 of its peak's */
    int    absorb;                /* 1: a piston that goes along with waves that come back; it may make
                                     none itself                                                     */
    double absorb_period;         /* s, of the waves that it absorbs best; 0 = its own, or long ones  */
    double start, ramp;           /* s: at rest until then; displacements rise as (1 - cos)/2, but of
                                     a solitary wave                                                 */
} tobi_wave_maker_def;

/* TOBI_INVALID, with what is allowed, for waves that break (Miche; 0.78 of the depth), a focus that waves do
   not reach in time and numbers out of range; TOBI_UNSUPPORTED for what a flap cannot. Of a record also
   TOBI_NOT_FOUND and TOBI_IO, with file and line. */
TOBI_API tobi_status tobi_motion_wave_maker(const tobi_wave_maker_def *def, tobi_motion **out,
                                            tobi_error *err);

/* Rows of a CSV file: position = pivot + shift + R (rest - pivot), cubic
   between the rows. Errors name file and line:
   TOBI_NOT_FOUND, TOBI_IO, TOBI_INVALID, TOBI_NO_MEMORY. */
TOBI_API tobi_status tobi_motion_keyframes(const char *path, const double pivot[3], tobi_motion **out,
                                  tobi_error *err);

/* Frees a motion; NULL is fine. */
TOBI_API void tobi_motion_free(tobi_motion *motion);

/* Positions (m) of n points at time t (s) from their rest positions (m). A tobi_motion_fn: `motion`
   is the tobi_motion. rest and position must not overlap. TOBI_SCRIPT when the script fails,
   answers nonsense or runs without end; position is then undefined. */
TOBI_API tobi_status tobi_motion_positions(void *motion, double t, int64_t n, const double (*rest)[3],
                                  double (*position)[3], tobi_error *err);

/* The numbers that deform() gets as its last argument from now on: a tobi_steer_fn, `motion` is the
   tobi_motion. Rigid motions have no use for them. */
TOBI_API void tobi_motion_steer(void *motion, const double steer[3]);

/* 1 when all points move by one rigid transform, 0 when the body deforms. */
TOBI_API int tobi_motion_is_rigid(const tobi_motion *motion);

typedef struct tobi_script tobi_script;
/* The function that a script must define: deform() or place(), control(), velocity(). */
typedef enum tobi_script_role { TOBI_MOTION_SCRIPT, TOBI_CONTROL_SCRIPT, TOBI_FLOW_SCRIPT } tobi_script_role;

/* Loads a script of control or flow, and runs the file once. Errors as in tobi_motion_script; TOBI_IO too
   where no process can be started. */
TOBI_API tobi_status tobi_script_load(const char *path, const char *params_json, tobi_script_role role,
                                      tobi_script **out, tobi_error *err);
/* NULL is fine. */
TOBI_API void tobi_script_free(tobi_script *script);
/* Calls control(): a tobi_control_fn, `script` is the tobi_script. TOBI_SCRIPT when it fails or answers
   nonsense. */
TOBI_API tobi_status tobi_script_control(void *script, const tobi_control_input *in, tobi_control_output *out,
                                         tobi_error *err);
/* Calls velocity() for n places: a tobi_flow_fn. */
TOBI_API tobi_status tobi_script_flow(void *script, int64_t n, const double (*place)[3],
                                      double (*velocity)[3], tobi_error *err);

#ifdef __cplusplus
}
#endif
#endif
