/* Parameters of what a tank has: gravity in time, a central force, damping zones. */
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

static const tobi_param central_rows[] = {
    { .key = "centre", VEC3, AT(tobi_central_def, centre), PLACE, .unit = "m", .required = true,
      .doc = "Place that the force points to." },
    { .key = "rate", REAL, AT(tobi_central_def, rate), RANGE(1e-9, 1e6), .unit = "1/s", .required = true,
      .doc = "The acceleration is rate^2 times the distance from centre: 2 pi/rate is the period of a "
             "particle alone." },
    { 0 }
};

const tobi_param_table tobi_central_table = {
    "central_force", "A force towards a place, which grows with the distance, besides gravity.",
    sizeof(tobi_central_def), central_rows };

static const tobi_param damping_rows[] = {
    { .key = "box.min", VEC3, AT(tobi_damping_def, box_min), PLACE, .unit = "m", .required = true,
      .doc = "Lower corner of the zone." },
    { .key = "box.max", VEC3, AT(tobi_damping_def, box_max), PLACE, .unit = "m", .required = true,
      .doc = "Upper corner of the zone." },
    { .key = "rate", REAL, AT(tobi_damping_def, rate), RANGE(0, 1e6), .unit = "1/s", .required = true,
      .doc = "How fast velocities decay at its end. Some 10 over the period of the waves is a beach." },
    { .key = "direction", VEC3, AT(tobi_damping_def, direction), .def = { 1, 0, 0 }, DIRECTION, .unit = "1",
      .doc = "Where the rate grows, as the square of the way: where the waves go." },
    { .key = "length", REAL, AT(tobi_damping_def, length), LENGTHS, .unit = "m", .text = "the box",
      .doc = "Over how much it grows; from there on it stays. A wave length and more is a beach." },
    { 0 }
};

const tobi_param_table tobi_damping_table = {
    "damping_zone", "A box in which the velocities of liquids decay: a beach.", sizeof(tobi_damping_def),
    damping_rows };
