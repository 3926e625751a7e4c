/* A rigid motion by rows of a CSV file: time and where the body is then, against its rest pose.

   The first line that is no comment (#) and not empty names the columns, in any order, upper or lower case:

     time (or t)                       s, rising from row to row
     x, y, z                           m, shift from the rest pose; a missing one is 0
     and for the turn, one of
     qw, qx, qy, qz                    a quaternion of any length but 0
     ax, ay, az, angle                 an axis and degrees about it
     roll, pitch, yaw                  degrees: about x, then y, then z (fixed axes); a missing one is 0

   A name may bring its unit in brackets, as Tobiuo's own tables do: "time [s]" or [ms], "x [m]", [cm] or
   [mm], "yaw [degrees]", [deg] or [rad], "qw [1]"; other units are refused. Columns are parted by comma,
   semicolon or tab. Numbers and the rates from row to row are at most 1e30 in size. Position = pivot + shift
   + R (rest - pivot).

   Between rows shift and turn are cubic, with continuous rates: Hermite curves whose slope at a row is
   that of the parabola through it and its neighbours (for turns Kim, Kim & Shin, SIGGRAPH 1995). So rows of
   constant acceleration, or of a constant turn about one axis, are met exactly. Two rows alike stand for
   standing still between them. From row to row a turn goes the short way, below 180 degrees. Before the
   first and after the last row the body stays; it stops at once there if the rows end in motion. */
#pragma once
#include "base/error.h"

typedef struct tobi_keyframes tobi_keyframes;

/* Errors name file and line: TOBI_NOT_FOUND, TOBI_IO, TOBI_INVALID, TOBI_NO_MEMORY. */
tobi_status tobi_keyframes_load(const char *path, tobi_keyframes **out, tobi_error *err);
/* The same for gravity: columns time (s), x, y, z (m/s2), no turn; its "shift" is that of gravity. given:
   which of x, y, z there are. */
tobi_status tobi_keyframes_load_gravity(const char *path, int given[3], tobi_keyframes **out,
                                        tobi_error *err);
/* The same for an inlet: columns time (s) and one of speed (m/s) and flow_rate (m3/s), neither below 0, whose
   value is the "shift" along x. is_rate: which it is. */
tobi_status tobi_keyframes_load_flow(const char *path, int *is_rate, tobi_keyframes **out, tobi_error *err);
/* The same for a motor: columns time (s) and one of speed (degrees/s), angle (degrees) and torque (N m), of a
   guide (slides 1) of speed (m/s), position (m) and force (N), whose value is the "shift" along x. column: 0,
   1, 2, which it is. */
tobi_status tobi_keyframes_load_motor(const char *path, int slides, int *column, tobi_keyframes **out,
                                      tobi_error *err);
/* The same for recorded levels: columns time (s) and `name` (m), NULL or "" is "level", whose value is the
   "shift" along x; other columns may stand beside them. */
tobi_status tobi_keyframes_load_levels(const char *path, const char *name, tobi_keyframes **out,
                                       tobi_error *err);
/* Rows, and the time (s) and shift of one. */
int64_t tobi_keyframes_count(const tobi_keyframes *frames);
double tobi_keyframes_row(const tobi_keyframes *frames, int64_t row, double shift[3]);
void tobi_keyframes_free(tobi_keyframes *frames);

/* Shift (m) and rotation matrix at time t (s). */
void tobi_keyframes_pose(const tobi_keyframes *frames, double t, double shift[3], double turn[3][3]);
