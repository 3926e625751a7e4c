/* The pictures of `tobiuo plot`, as tables. */
#include "language.h"
#include "plot.h"
#include <string.h>

/* Three curves of a vector's parts. */
#define XYZ(column)                                   \
    { { "x", column "_x", NULL, CURVE_LINE, 1, NULL, NULL },  \
      { "y", column "_y", NULL, CURVE_LINE, 2, NULL, NULL },  \
      { "z", column "_z", NULL, CURVE_LINE, 0, NULL, NULL } }

/* Energies besides those of the particles' speed and height. */
static const char *const others[] = { "elastic_energy", "body_kinetic_energy", "body_potential_energy",
                                      "spring_energy", NULL };

const picture_row plot_history[] = {
    { "energies", TEXT("Energy of fluids, solids and bodies; change and work since the start"), 0, {
        { TEXT("kinetic energy"), "J", 0, 1, 0, 0, 0,
          { { TEXT("fluids and solids"), "kinetic_energy", NULL, CURVE_LINE, 0, NULL, NULL },
            { TEXT("bodies"), "body_kinetic_energy", NULL, CURVE_LINE, 1, "body_kinetic_energy",
              NULL } } },
        { TEXT("change"), "J", 0, 1, 0, 1, 0,
          { { TEXT("potential"), "potential_energy", NULL, CURVE_LINE, 2, NULL, NULL },
            { TEXT("kinetic"), "kinetic_energy", NULL, CURVE_LINE, 0, NULL, NULL },
            { TEXT("elastic"), "elastic_energy", NULL, CURVE_LINE, 1, "elastic_energy", NULL },
            { TEXT("lost by solids"), "energy_lost", NULL, CURVE_LINE, 3, "elastic_energy", NULL },
            { TEXT("bodies"), "body_kinetic_energy", "body_potential_energy", CURVE_LINE, 4,
              "body_potential_energy", NULL },
            { TEXT("springs"), "spring_energy", NULL, CURVE_LINE, 5, "spring_energy", NULL },
            { TEXT("sum of all"), "kinetic_energy", "potential_energy", CURVE_DASHED, 7, NULL,
              others } } },
        { TEXT("work"), "J", 0, 1, 0, 0, 0,
          { { TEXT("given by motions"), "motion_work", NULL, CURVE_LINE, 0, "motion_work", NULL },
            { TEXT("taken by joints"), "joint_work", NULL, CURVE_LINE, 1, "joint_work", NULL },
            { TEXT("taken by lines"), "line_work", NULL, CURVE_LINE, 2, "line_work", NULL },
            { TEXT("taken by porous zones"), "porous_work", NULL, CURVE_LINE, 4, "porous_work", NULL },
            { TEXT("given by buoyancy"), "buoyancy_work", NULL, CURVE_LINE, 5, "buoyancy_work", NULL },
            { TEXT("given by air resistance"), "air_work", NULL, CURVE_LINE, 6, "air_work", NULL },
            { TEXT("given by the frame"), "field_work", NULL, CURVE_LINE, 7, "field_work", NULL },
            { TEXT("given by nests"), "nest_work", NULL, CURVE_DASHED, 1, "nest_work", NULL },
            { TEXT("given by forces"), "force_work", NULL, CURVE_LINE, 3, "force_work", NULL } } } } },
    { "work", TEXT("Work on solids, and where it goes"), 1, {
        { TEXT("work"), "J", 0, 1, 0, 0, 0,
          { { TEXT("by bodies"), "work_bodies", NULL, CURVE_LINE, 7, "work_bodies", NULL },
            { TEXT("fracture"), "fracture_work", NULL, CURVE_LINE, 0, "fracture_work", NULL },
            { TEXT("friction"), "friction_work", NULL, CURVE_LINE, 1, "friction_work", NULL },
            { TEXT("damping"), "damping_work", NULL, CURVE_LINE, 4, "damping_work", NULL },
            { TEXT("plastic"), "plastic_work", NULL, CURVE_LINE, 5, "plastic_work", NULL },
            { TEXT("transfer"), "transfer_dissipation", NULL, CURVE_LINE, 2, "transfer_dissipation", NULL },
            { TEXT("lost in all"), "energy_lost", NULL, CURVE_DASHED, 3, "energy_lost", NULL } } },
        { TEXT("pieces"), "", 0, 0, 0, 0, 0,
          { { TEXT("pieces"), "pieces", NULL, CURVE_LINE, 0, "pieces", NULL } } } } },
    { "walls", TEXT("Force of the fluid on the walls of the domain"), 0, {
        { TEXT("force"), "N", 0, 1, 0, 0, 1, XYZ("wall_force") },
        { TEXT("force along gravity / weight"), "", 0, 0, 0, 0, 1,
          { { TEXT("1 = at rest"), "wall_force_ratio", NULL, CURVE_LINE, 0, NULL, NULL } } } } },
    { "incompressibility", TEXT("How incompressible the fluid stays"), 1, {
        { TEXT("density error"), "%", 100, 0, 1, 0, 0,
          { { TEXT("largest"), "density_error_max", NULL, CURVE_LINE, 1, "density_error_max", NULL },
            { TEXT("mean"), "density_error_mean", NULL, CURVE_LINE, 0, "density_error_mean", NULL } } },
        { TEXT("|divergence|"), "1/s", 0, 0, 1, 0, 1,
          { { TEXT("largest"), "divergence_max", NULL, CURVE_LINE, 1, "divergence_max", NULL },
            { TEXT("mean"), "divergence_mean", NULL, CURVE_LINE, 0, "divergence_mean", NULL } } } } },
    { "solver", TEXT("Work of the solver"), 0, {
        { TEXT("iterations per step"), "", 0, 0, 0, 0, 1,
          { { TEXT("density solve, mean"), "density_iterations_mean", NULL, CURVE_LINE, 0,
             "density_iterations_mean", NULL },
            { TEXT("divergence solve, mean"), "divergence_iterations_mean", NULL, CURVE_LINE, 1,
             "divergence_iterations_mean", NULL },
            { TEXT("steps not converged"), "unconverged_steps", NULL, CURVE_DASHED, 7,
              "unconverged_steps", NULL } } },
        { TEXT("time step"), "ms", 1e3, 0, 0, 0, 1,
          { { TEXT("time step"), "dt", NULL, CURVE_LINE, 2, NULL, NULL } } },
        { TEXT("speed"), "m/s", 0, 0, 0, 0, 0,
          { { TEXT("fastest particle"), "speed_max", NULL, CURVE_LINE, 3, NULL, NULL } } } } },
    { 0 }
};

/* One panel of a force or torque: its mean since the last output, its parts (unless the viscous one is
   0: then the sum is the pressure), and the last step's. */
#define SUM(label, when, noun, axis, style, colour)                                              \
    { label, when "pressure_" noun "_" axis, when "viscous_" noun "_" axis, style, colour, NULL, NULL }
#define PART(label, part, noun, axis, style, colour)                                             \
    { label, "mean_" part "_" noun "_" axis, NULL, style, colour, "mean_viscous_" noun "_" axis, NULL }
#define PARTS(noun, axis, unit, ...)                                                             \
    { axis, unit, 0, 1, 0, 0, 1,                                                                 \
      { SUM(TEXT("sum, last step"), "", noun, axis, CURVE_THIN, 6),                              \
        SUM(TEXT("sum, mean"), "mean_", noun, axis, CURVE_LINE, 7),                              \
        PART(TEXT("pressure, mean"), "pressure", noun, axis, CURVE_DASHED, 0),                   \
        PART(TEXT("viscous, mean"), "viscous", noun, axis, CURVE_LINE, 1), __VA_ARGS__ } }
/* What a blade's edge takes, a part of the pressure. */
#define EDGE(axis)                                                                               \
    { TEXT("edge, mean"), "mean_edge_force_" axis, NULL, CURVE_LINE, 3, "mean_edge_force_" axis, NULL }

/* One panel of what bodies and sides that touch a body do. */
#define MET(label, when, noun, axis, style, colour)                                              \
    { label, when "contact_" noun "_" axis, NULL, style, colour, "mean_contact_" noun "_" axis, NULL }
#define TOUCH(noun, axis, unit)                                                                  \
    { axis, unit, 0, 1, 0, 0, 1,                                                                 \
      { MET(TEXT("last step"), "", noun, axis, CURVE_THIN, 6),                                   \
        MET(TEXT("mean"), "mean_", noun, axis, CURVE_LINE, 7) } }

const picture_row plot_body[] = {
    { "motion", TEXT("Motion of %s"), 0, {
        { TEXT("shift since the start"), "m", 0, 0, 0, 1, 0, XYZ("position") },
        { TEXT("velocity"), "m/s", 0, 0, 0, 0, 0, XYZ("velocity") },
        { TEXT("angular velocity"), "rad/s", 0, 0, 0, 0, 0, XYZ("angular_velocity") } } },
    { "turn", TEXT("Turn of %s"), 1, {
        { TEXT("turn since the rest pose"), "degrees", 0, 0, 0, 0, 0,
          { { TEXT("roll"), "roll", NULL, CURVE_LINE, 0, "roll", NULL },
            { TEXT("pitch"), "pitch", NULL, CURVE_LINE, 1, "pitch", NULL },
            { TEXT("yaw"), "yaw", NULL, CURVE_LINE, 2, "yaw", NULL },
            { TEXT("angle"), "angle", NULL, CURVE_LINE, 0, "angle", NULL } } } } },
    { "force", TEXT("Force of the particles on %s"), 0, {
        PARTS("force", "x", "N", EDGE("x")), PARTS("force", "y", "N", EDGE("y")),
        PARTS("force", "z", "N", EDGE("z")) } },
    { "torque", TEXT("Torque of the particles about the centre of mass of %s"), 0, {
        PARTS("torque", "x", "N m", { 0 }), PARTS("torque", "y", "N m", { 0 }),
        PARTS("torque", "z", "N m", { 0 }) } },
    { "power", TEXT("Power of the motion of %s"), 1, {
        { TEXT("given to fluids and solids"), "W", 0, 1, 0, 0, 1,
          { { TEXT("mean"), "mean_motion_power", NULL, CURVE_LINE, 7, "mean_motion_power", NULL } } } } },
    { "contact_force", TEXT("Force of bodies and sides on %s"), 1, {
        TOUCH("force", "x", "N"), TOUCH("force", "y", "N"), TOUCH("force", "z", "N") } },
    { "contact_torque", TEXT("Torque of bodies and sides about the centre of mass of %s"), 1, {
        TOUCH("torque", "x", "N m"), TOUCH("torque", "y", "N m"), TOUCH("torque", "z", "N m") } },
    { 0 }
};

const picture_row plot_solid[] = {
    { "solid_motion", TEXT("Motion of %s"), 0, {
        { TEXT("position"), "m", 0, 0, 0, 0, 0, XYZ("position") },
        { TEXT("velocity"), "m/s", 0, 0, 0, 0, 0, XYZ("velocity") } } },
    { "liquid_force", TEXT("Force of the liquids on %s"), 1, {
        { TEXT("mean force"), "N", 0, 1, 0, 0, 1, XYZ("mean_liquid_force") } } },
    { 0 }
};

/* Ends of the names of columns; axes tell them in the language of the user. */
const columns_row plot_probes[] = {
    { "probes_pressure", TEXT("Pressure at the probes"), { TEXT("pressure") } },
    { "probes_velocity", TEXT("Velocity at the probes"),
      { TEXT("velocity_x"), TEXT("velocity_y"), TEXT("velocity_z") } },
    { "probes_force", TEXT("Force on the probes"), { TEXT("force_x"), TEXT("force_y"), TEXT("force_z") } },
    { "probes_moment", TEXT("Moment on the probes"),
      { TEXT("moment_x"), TEXT("moment_y"), TEXT("moment_z") } },
    { "probes_level", TEXT("Level of the fluid at the probes"), { TEXT("level") } },
    { "probes_run_up", TEXT("Run-up at the probes"), { TEXT("run_up") } },
    { "probes_flow", TEXT("Flow through the probes"), { TEXT("flow") } },
    { "probes_volume", TEXT("Volume in the probes"), { TEXT("volume") } },
    { 0 }
};

const columns_row plot_lines[] = {
    { "lines", TEXT("Lines"), { TEXT("tension"), TEXT("distance") } },
    { 0 }
};

const columns_row plot_joints[] = {
    { "joints_force", TEXT("Force of the joints"), { TEXT("force_x"), TEXT("force_y"), TEXT("force_z") } },
    { "joints_moment", TEXT("Moment of the joints"),
      { TEXT("moment_x"), TEXT("moment_y"), TEXT("moment_z") } },
    { "joints_angle", TEXT("Angle, position and gap of the joints"),
      { TEXT("angle"), TEXT("position"), TEXT("gap") } },
    { "joints_power", TEXT("Motors and dampers of the joints"),
      { TEXT("motor_torque"), TEXT("motor_force"), TEXT("power") } },
    { 0 }
};

const char *plot_unit(const char *column, int dimension)
{
    static const struct { const char *part, *unit, *unit_2d; } units[] = {
        { "iterations", "", "" }, { "residual", "", "" }, { "ratio", "", "" }, { "density_error", "", "" },
        { "divergence", "1/s", "1/s" }, { "angular_velocity", "rad/s", "rad/s" },
        { "velocity", "m/s", "m/s" }, { "speed", "m/s", "m/s" }, { "position", "m", "m" },
        { "torque", "N m", "N m per m" }, { "force", "N", "N per m" }, { "weight", "N", "N per m" },
        { "pressure", "Pa", "Pa" }, { "level", "m", "m" }, { "run_up", "m", "m" }, { "distance", "m", "m" },
        { "moment_", "N m", "N m per m" }, { "flow", "m3/s", "m2/s" }, { "volume_drift", "", "" },
        { "volume", "m3", "m2" },
        { "power", "W", "W per m" },
        { "energy", "J", "J per m" }, { "work", "J", "J per m" }, { "dissipation", "J", "J per m" },
        { "momentum", "kg m/s", "kg m/s per m" }, { "tension", "N", "N per m" },
        { "angle", "degrees", "degrees" }, { "gap", "m", "m" },
        { "roll", "degrees", "degrees" }, { "pitch", "degrees", "degrees" }, { "yaw", "degrees", "degrees" },
    };
    const char *unit = "", *end = column;      /* names of bodies and sensors stand before the quantity */
    if (strcmp(column, "dt") == 0 || strcmp(column, "time") == 0) return "s";
    for (size_t k = 0; k < sizeof units / sizeof *units; k++)
        for (const char *at = column; (at = strstr(at, units[k].part)); at++)
            if (at + strlen(units[k].part) > end) {
                end = at + strlen(units[k].part);
                unit = dimension == 2 ? units[k].unit_2d : units[k].unit;
            }
    return unit;
}
