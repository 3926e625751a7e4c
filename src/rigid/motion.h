/* Prescribed motion of a body: a user's Lua script, translation, rotation, oscillation, or keyframes from a
   CSV file.

   A motion is a pure function of time and rest position, so that rates by central difference, a
   restart and any order of evaluation give the same numbers. One motion belongs to one body; it is
   not safe to evaluate the same motion from two threads at once. */
#pragma once
#include "base/error.h"

typedef struct tobi_motion tobi_motion;

/* Loads a motion script (see script.h for what it may say). params_json is the text of a JSON
   object that the script sees as the table `params`; NULL means {}. On failure *out is NULL and err
   names file and line: TOBI_NOT_FOUND no such file, TOBI_IO unreadable, TOBI_INVALID broken
   params_json, TOBI_SCRIPT an error in the script itself. */
tobi_status tobi_motion_script(const char *path, const char *params_json, tobi_motion **out,
                               tobi_error *err);

/* position = rest + velocity t, velocity in m/s. */
tobi_status tobi_motion_translation(const double velocity[3], tobi_motion **out, tobi_error *err);

/* Turns about the line through centre (m) along axis (any length but zero) by rate t, degrees/s,
   right-handed. */
tobi_status tobi_motion_rotation(const double centre[3], const double axis[3],
                                 double rate_deg_per_s, tobi_motion **out, tobi_error *err);

/* position = rest + direction/|direction| amplitude sin(2 pi frequency t + phase). */
tobi_status tobi_motion_oscillation(const double direction[3], double amplitude_m,
                                    double frequency_hz, double phase_deg, tobi_motion **out,
                                    tobi_error *err);

/* Rows of a CSV file, see keyframes.h for its columns: position = pivot + shift + R (rest - pivot), cubic
   between the rows. Errors as in tobi_keyframes_load. */
tobi_status tobi_motion_keyframes(const char *path, const double pivot[3], tobi_motion **out,
                                  tobi_error *err);

/* Frees a motion; NULL is fine. */
void tobi_motion_free(tobi_motion *motion);

/* Positions (m) of n points at time t (s) from their rest positions (m). A tobi_motion_fn: `motion`
   is the tobi_motion. rest and position must not overlap. TOBI_SCRIPT when the script fails,
   answers nonsense or runs without end; position is then undefined. */
tobi_status tobi_motion_positions(void *motion, double t, int64_t n, const double (*rest)[3],
                                  double (*position)[3], tobi_error *err);

/* 1 when all points move by one rigid transform, 0 when the body deforms. */
int tobi_motion_is_rigid(const tobi_motion *motion);
