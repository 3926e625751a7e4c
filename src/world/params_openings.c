/* Parameters of inlets and outlets. */
#include "base/param_rows.h"
#include "base/param.h"

#define PATCH(type)                                                                                  \
    { .key = "centre", VEC3, AT(type, centre), PLACE, .unit = "m", .required = true,                 \
      .doc = "Middle of the patch." },                                                               \
    { .key = "normal", VEC3, AT(type, normal), DIRECTION, .unit = "1", .required = true,             \
      .doc = "The way that the liquid goes, of any length." },                                       \
    { .key = "along", VEC3, AT(type, along), DIRECTION, .unit = "1",                                 \
      .doc = "Direction of the width; zero takes one that is normal to normal." },                   \
    { .key = "width", REAL, AT(type, width), LENGTHS, .unit = "m", .text = "none",                   \
      .doc = "Width of a rectangle; in 2-D the length of the line." },                               \
    { .key = "height", REAL, AT(type, height), LENGTHS, .unit = "m", .text = "none",                 \
      .doc = "Height of the rectangle, across the width; in 2-D it is not read." },                  \
    { .key = "radius", REAL, AT(type, radius), LENGTHS, .unit = "m", .text = "none",                 \
      .doc = "Radius of a disc, instead of width and height." }

static const tobi_param inlet_rows[] = {
    { .key = "name", TEXT, AT(tobi_inlet_def, name), .unit = "name", .text = "inlet", .required = true,
      .doc = "Name of the inlet, used once among inlets." },
    { .key = "fluid", TEXT, AT(tobi_inlet_def, fluid), .unit = "name",
      .doc = "Name of the fluid that comes in; none takes the first." },
    PATCH(tobi_inlet_def),
    { .key = "speed", REAL, AT(tobi_inlet_def, speed), RANGE(0, TOBI_SPEED_LIMIT), .unit = "m/s",
      .text = "by flow_rate", .doc = "Mean speed over the patch." },
    { .key = "flow_rate", REAL, AT(tobi_inlet_def, flow_rate), RANGE(0, 1e9), .unit = "m3/s",
      .text = "by speed",
      .doc = "Discharge, volume per time, instead of a speed; in 2-D per metre of depth." },
    { .key = "file", TEXT, AT(tobi_inlet_def, file), .unit = "path",
      .doc = "A CSV file of a hydrograph, instead of both: its first line names the columns time (s) and "
             "speed (m/s) or flow_rate (m3/s). Linear between the rows; before the first and after the last "
             "it stays." },
    { .key = "profile", CHOICE("uniform|parabolic", 2), AT(tobi_inlet_def, profile),
      .doc = "How the speed is spread over the patch: evenly, or as of a laminar flow." },
    { .key = "start", REAL, AT(tobi_inlet_def, start), RANGE(0, 1e9), .unit = "s",
      .doc = "Time at which the flow begins." },
    { .key = "stop", REAL, AT(tobi_inlet_def, stop), RANGE(0, 1e9), .unit = "s", .text = "never",
      .doc = "Time at which it ends." },
    { .key = "ramp", REAL, AT(tobi_inlet_def, ramp), RANGE(0, 1e9), .unit = "s", .text = "none",
      .doc = "Time in which the speed rises from 0." },
    { 0 }
};

const tobi_param_table tobi_inlet_table = {
    "inlet", "An entry of inlets: a patch through which liquid comes in.", sizeof(tobi_inlet_def),
    inlet_rows };

static const tobi_param outlet_rows[] = {
    { .key = "name", TEXT, AT(tobi_outlet_def, name), .unit = "name", .text = "outlet", .required = true,
      .doc = "Name of the outlet, used once among outlets." },
    PATCH(tobi_outlet_def),
    { .key = "level", REAL, AT(tobi_outlet_def, level), .def = { TOBI_NO_LEVEL }, PLACE, .unit = "m",
      .text = "none",
      .doc = "Level of liquid at rest beyond the outlet, whose pressure holds there: a coordinate upwards; "
             "without one there is no pressure. Liquid comes back where it is higher than that inside." },
    { .key = "pressure", REAL, AT(tobi_outlet_def, pressure), .def = { -1 }, RANGE(0, 1e12), .unit = "Pa",
      .text = "none",
      .doc = "Instead of a level: pressure at the centre, and that of liquid at rest above and below it. "
             "Liquid comes back where it is higher than that inside." },
    { 0 }
};

const tobi_param_table tobi_outlet_table = {
    "outlet", "An entry of outlets: a patch through which liquid goes out.", sizeof(tobi_outlet_def),
    outlet_rows };
