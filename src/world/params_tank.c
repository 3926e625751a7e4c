/* Parameters of what a tank has: gravity in time, a central force, damping and porous zones, nests. */
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

static const tobi_param porous_rows[] = {
    { .key = "name", TEXT, AT(tobi_porous_def, name), .unit = "name", .text = "zone", .required = true,
      .doc = "Name of the zone, used once in a scene and in the columns of porous_zones.csv." },
    { .key = "box.min", VEC3, AT(tobi_porous_def, box_min), PLACE, .unit = "m",
      .doc = "Lower corner of the zone." },
    { .key = "box.max", VEC3, AT(tobi_porous_def, box_max), PLACE, .unit = "m",
      .doc = "Upper corner of the zone." },
    OUTLINE_ROWS(tobi_porous_def, outline),
    { .key = "cylinder.start", VEC3, AT(tobi_porous_def, cylinder_start), PLACE, .unit = "m",
      .doc = "Middle of one end of a cylinder along x, y or z; in 2-D of a disc." },
    { .key = "cylinder.end", VEC3, AT(tobi_porous_def, cylinder_end), PLACE, .unit = "m",
      .doc = "Middle of its other end; in 2-D it is not read." },
    { .key = "cylinder.radius", REAL, AT(tobi_porous_def, cylinder_radius), LENGTHS, .unit = "m",
      .text = "none", .doc = "Its radius." },
    { .key = "cylinder.inner_radius", REAL, AT(tobi_porous_def, cylinder_inner), LENGTHS, .unit = "m",
      .text = "none", .doc = "Within it there is no zone: a ring, as the net of a cage." },
    { .key = "stones.size", REAL, AT(tobi_porous_def, stone_size), RANGE(1e-6, 1e3), .unit = "m",
      .text = "none", .doc = "Median diameter D of stones, by which they resist after van Gent (1995)." },
    { .key = "stones.porosity", REAL, AT(tobi_porous_def, porosity), RANGE(0.01, 0.99), .unit = "1",
      .text = "none", .doc = "Share n of the zone that is no stone; a rubble mound has some 0.4." },
    { .key = "stones.linear_coefficient", REAL, AT(tobi_porous_def, linear_coefficient), .def = { 1000 },
      RANGE(0, 1e6), .unit = "1", .doc = "alpha of a = alpha (1 - n)^2/n^3 nu/D^2." },
    { .key = "stones.quadratic_coefficient", REAL, AT(tobi_porous_def, quadratic_coefficient),
      .def = { 1.1 }, RANGE(0, 1e3), .unit = "1", .doc = "beta of b = beta (1 - n)/(n^3 D)." },
    { .key = "stems.number", REAL, AT(tobi_porous_def, stem_number), RANGE(1e-6, 1e9), .unit = "1/m2",
      .text = "none", .doc = "Stems per area across them. They resist what flows across them." },
    { .key = "stems.diameter", REAL, AT(tobi_porous_def, stem_diameter), RANGE(1e-6, 1e3), .unit = "m",
      .text = "none", .doc = "Their diameter, or their width across the flow." },
    { .key = "stems.drag", REAL, AT(tobi_porous_def, stem_drag), .def = { 1 }, RANGE(0, 100), .unit = "1",
      .doc = "Their drag coefficient C: b = C number diameter/2." },
    { .key = "screen.loss", REAL, AT(tobi_porous_def, screen_loss), RANGE(1e-6, 1e6), .unit = "1",
      .text = "none", .doc = "A net or a perforated wall: K of the pressure loss K rho u^2/2 across it." },
    { .key = "resistance.linear", REAL, AT(tobi_porous_def, linear), RANGE(0, 1e6), .unit = "1/s",
      .doc = "a of rho (a u + b |u| u), the pressure that is lost per metre, given directly." },
    { .key = "resistance.quadratic", REAL, AT(tobi_porous_def, quadratic), RANGE(0, 1e6), .unit = "1/m",
      .doc = "b of that formula." },
    { .key = "direction", VEC3, AT(tobi_porous_def, direction), DIRECTION, .unit = "1",
      .doc = "Along stems, or across a screen. 0: stems stand upwards, a screen lies across the thinnest "
             "side of its box, along the longest side of its outline, or around its ring." },
    { .key = "body", TEXT, AT(tobi_porous_def, body), .unit = "name",
      .doc = "Name of the body that carries the zone, as both are placed at the start. The drag acts on the "
             "velocity against it, and on it." },
    { 0 }
};

const tobi_param_table tobi_porous_table = {
    "porous_zone", "A shape whose contents resist liquids: one of stones, stems, screen and resistance.",
    sizeof(tobi_porous_def), porous_rows };

static const tobi_param nest_rows[] = {
    { .key = "name", TEXT, AT(tobi_nest_def, name), .unit = "name", .text = "nest", .required = true,
      .doc = "Name of the nest, used once among nests: its results go to the folder nests/NAME." },
    { .key = "box.min", VEC3, AT(tobi_nest_def, box_min), PLACE, .unit = "m", .required = true,
      .doc = "Lower corner of the box in which liquid is computed again." },
    { .key = "box.max", VEC3, AT(tobi_nest_def, box_max), PLACE, .unit = "m", .required = true,
      .doc = "Upper corner of the box." },
    { .key = "refinement", INT, AT(tobi_nest_def, refinement), .def = { 2 }, RANGE(2, TOBI_REFINEMENT_LIMIT),
      .unit = "1", .doc = "How many times smaller than the scene's its spacing is." },
    { .key = "feedback", BOOL, AT(tobi_nest_def, feedback),
      .doc = "Whether the scene's own liquid takes the nest's velocity in the box, so that it flows around "
             "what only the nest sees well." },
    { .key = "follow", TEXT, AT(tobi_nest_def, follow), .unit = "name",
      .doc = "Name of the body that the box goes along with; none: it stays." },
    { 0 }
};

const tobi_param_table tobi_nest_table = {
    "nest", "An entry of nests: a box in which the liquid is computed again with a smaller spacing.",
    sizeof(tobi_nest_def), nest_rows };
