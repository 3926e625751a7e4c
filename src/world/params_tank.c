/* Parameters of what a tank has: gravity in time. */
#include "base/param_rows.h"
#include "base/param.h"

static const tobi_param gravity_rows[] = {
    { .key = "file", TEXT, AT(tobi_gravity_def, file), .unit = "path",
      .doc = "A CSV file whose first line names its columns: time (s), x, y, z (m/s2). It gives all of "
             "gravity; a missing column is as in the key gravity. Cubic between the rows; before the first "
             "and after the last it stays." },
    { .key = "amplitude", VEC3, AT(tobi_gravity_def, amplitude), RANGE(-1e6, 1e6), .unit = "m/s2",
      .doc = "Amplitude of a swing, for each component: amplitude sin(2 pi t/period + phase) is added." },
    { .key = "period", REAL, AT(tobi_gravity_def, period), DURATION, .unit = "s", .text = "none",
      .doc = "Time of one cycle of the swing." },
    { .key = "phase", VEC3, AT(tobi_gravity_def, phase), RANGE(-1e9, 1e9), .unit = "degrees",
      .doc = "Its phase at time 0, for each component." },
    { .key = "start", REAL, AT(tobi_gravity_def, start), RANGE(-1e9, 1e9), .unit = "s",
      .doc = "Until then there is no swing; the sine counts from time 0 all the same." },
    { .key = "ramp", REAL, AT(tobi_gravity_def, ramp), RANGE(0, 1e9), .unit = "s",
      .doc = "The amplitude rises like (1 - cos(pi s/ramp))/2 in so many seconds after start." },
    { 0 }
};

const tobi_param_table tobi_gravity_table = {
    "gravity_in_time", "Gravity by a table, by a swing of each component, or both. "
    "The key gravity stays.",
    sizeof(tobi_gravity_def), gravity_rows };
