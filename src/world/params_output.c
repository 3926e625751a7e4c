/* Parameters of what a run measures and writes, and of what it is compared with. */
#include "base/param_rows.h"
#include "base/param.h"

static const tobi_param probe_rows[] = {
    { .key = "name", TEXT, AT(tobi_probe_def, name), .unit = "name", .text = "probe", .required = true,
      .doc = "Name of the probe, used once in a scene and in the columns of probes.csv." },
    { .key = "kind", CHOICE("point|level|patch|run-up|flow|volume", 6), AT(tobi_probe_def, kind),
      .doc = "A point measures pressure and velocity; a level the height of the surface above or below it; a "
             "patch mean pressure, force and moment on a rectangle of a wall; a run-up how far water reaches "
             "along a line; a flow what passes a rectangle; a volume the liquid in a box." },
    { .key = "position", VEC3, AT(tobi_probe_def, position), PLACE, .unit = "m", .required = true,
      .doc = "Where it sits: for a level any point of its plumb line, the middle of a patch, a flow or a "
             "volume, the wet end of a run-up." },
    { .key = "end", VEC3, AT(tobi_probe_def, end), PLACE, .unit = "m", .doc = "The other end of a run-up." },
    { .key = "normal", VEC3, AT(tobi_probe_def, normal), DIRECTION, .unit = "1",
      .doc = "Direction across a patch (into the water), of a flow (where it counts as positive), or of the "
             "height of a volume; zero is up." },
    { .key = "along", VEC3, AT(tobi_probe_def, along), DIRECTION, .unit = "1",
      .doc = "Direction of its length, which normal makes square; zero takes x, or y where normal is x." },
    { .key = "length", REAL, AT(tobi_probe_def, length), LENGTHS, .unit = "m",
      .text = "none", .doc = "Length of a patch, flow or volume." },
    { .key = "width", REAL, AT(tobi_probe_def, width), LENGTHS, .unit = "m", .text = "none",
      .doc = "Its width, across along and normal; in 2-D there is none." },
    { .key = "height", REAL, AT(tobi_probe_def, height), LENGTHS, .unit = "m",
      .text = "none", .doc = "Height of a volume, along normal." },
    { .key = "body", TEXT, AT(tobi_probe_def, body), .unit = "name",
      .doc = "Name of the body that it sits on and moves with, from where the scene places the body." },
    { .key = "fluid", TEXT, AT(tobi_probe_def, fluid), .unit = "name",
      .doc = "Name of the fluid that a level, run-up, flow or volume is of, as the water under air or oil; "
             "else of all fluids together. A level or run-up counts heavier fluids as well, on which "
             "this one stands: oil on water has its surface." },
    { .key = "rate", REAL, AT(tobi_probe_def, rate), RANGE(1e-9, 1e12), .unit = "Hz",
      .text = "output", .doc = "Its values per second, each of the first step that is due; output goes by "
                               "output.probe_interval." },
    { .key = "filter.cutoff", REAL, AT(tobi_probe_def, cutoff), RANGE(1e-9, 1e12),
      .unit = "Hz", .text = "none", .doc = "Frequency of a low pass that sees its value of every step." },
    { .key = "filter.order", CHOICE("first|butterworth", 2), AT(tobi_probe_def, order),
      .doc = "A low pass of first order, or one of second order without a peak (Butterworth)." },
    { 0 }
};

const tobi_param_table tobi_probe_table = {
    "probe", "An entry of probes: a sensor in the domain.", sizeof(tobi_probe_def), probe_rows };

/* Rows of one picture, in a struct of this type at this member. */
#define VIEW_ROWS(type, in) \
    { .key = "camera.position", VEC3, AT(type, in position), PLACE, .unit = "m", \
      .doc = "Where the pictures of a 3-D scene are taken from, if camera.angle is given." }, \
    { .key = "camera.look_at", VEC3, AT(type, in look_at), PLACE, .unit = "m", \
      .doc = "The point in the middle of the pictures, if camera.angle is given." }, \
    { .key = "camera.angle", REAL, AT(type, in angle), RANGE(1, 150), \
      .unit = "degrees", .text = "fit", \
      .doc = "Vertical field of view; fit shows the whole domain from where it looks best." }, \
    { .key = "picture.look", CHOICE("natural|surface|particles", 3), AT(type, in look), \
      .doc = "What pictures show: water and solids as they look, or, in the colours of picture.field, " \
             "their surface or each particle. With a field, natural is surface. Surfaces in 2-D are " \
             "regions." }, \
    { .key = "picture.field", TEXT, AT(type, in field), .unit = "name", \
      .doc = "The field that colours the pictures, as in fields, or one component: velocity_x, stress_xy. " \
             "Of a vector its length, of the vorticity in 2-D that about z, counterclockwise positive. " \
             "Without it a 2-D scene of one liquid or solid, in no color of its own, shows the speed." }, \
    { .key = "picture.field_of", CHOICE("all|liquids|solids", 3), AT(type, in field_of), \
      .doc = "Which particles picture.field colours. Those of the other kind have their own colours, and " \
             "do not count for the range of the colours." }, \
    { .key = "picture.map", CHOICE("viridis|magma|cividis|coolwarm|gray", 5), AT(type, in map), \
      .doc = "The colours of picture.field, from its least value to its largest; in the middle of coolwarm " \
             "is 0 if there are both signs." }, \
    { .key = "picture.min", REAL, AT(type, in min), RANGE(-1e30, 1e30), \
      .unit = "that of the field", .doc = "Value at the lower end of the colours." }, \
    { .key = "picture.max", REAL, AT(type, in max), RANGE(-1e30, 1e30), \
      .unit = "that of the field", \
      .doc = "Value at the upper end; without min and max each picture has the range of its own values." }, \
    { .key = "picture.width", INT, AT(type, in width), RANGE(16, 8192), .unit = "pixels", .text = "fit", \
      .doc = "Width of the pictures; fit: by their height, without one 1280 in 3-D, and in 2-D such that " \
             "the domain fills them." }, \
    { .key = "picture.height", INT, AT(type, in height), RANGE(16, 8192), .unit = "pixels", .text = "fit", \
      .doc = "Height of the pictures; fit: in 3-D 9/16 of their width, in 2-D as the domain is, from 1/4 " \
             "to 4/3 of their width." }, \
    { .key = "picture.samples", INT, AT(type, in samples), .def = { 2 }, RANGE(1, 4), \
      .unit = "1", .doc = "Samples per pixel and axis: more make finer edges and take longer." }, \
    { .key = "picture.follow", TEXT, AT(type, in follow), .unit = "name", \
      .doc = "Name of the body that the camera moves with; camera.position and look_at are those at the " \
             "start." }, \
    { .key = "picture.clip_point", VEC3, AT(type, in clip_point), PLACE, .unit = "m", \
      .doc = "A point of the plane that cuts off water, solids and bodies, if there is a clip_normal." }, \
    { .key = "picture.clip_normal", VEC3, AT(type, in clip_normal), DIRECTION, .unit = "1", \
      .doc = "Direction from the plane to what is not shown; 0 is no plane." }, \
    { .key = "picture.slice", REAL, AT(type, in slice), RANGE(0, 1e7), .unit = "m", \
      .doc = "Above 0 only what is within half of this from the plane is shown." }, \
    { .key = "picture.arrows", BOOL, AT(type, in arrows), \
      .doc = "Draw velocities as arrows, the longest for the fastest." }, \
    { .key = "picture.isolines", INT, AT(type, in isolines), RANGE(0, 100), .unit = "1", \
      .doc = "How many lines of equal value to draw, in 3-D on surfaces in the colours of " \
             "picture.field, at equal steps between the ends of the colours." }, \
    { .key = "picture.streamlines", INT, AT(type, in streamlines), RANGE(0, 200), .unit = "1", \
      .doc = "How many lines along the velocity of liquids have room side by side on the longest edge of " \
             "the domain; with a clip_normal they lie in its plane." }, \
    { .key = "picture.paths", BOOL, AT(type, in paths), \
      .doc = "Draw where the centre of mass of each body has been, from output to output." }, \
    { .key = "picture.axes", BOOL, AT(type, in axes), \
      .doc = "Draw ticks with numbers along edges of the domain." }, \
    { .key = "picture.transparent", BOOL, AT(type, in transparent), \
      .doc = "Leave the background of the pictures transparent." }, \
    { .key = "picture.nests", BOOL, AT(type, in nests), .def = { 1 }, \
      .doc = "Draw in the box of each nest its liquid instead of the scene's." }, \
    { .key = "picture.foam", BOOL, AT(type, in foam), .def = { 1 }, \
      .doc = "Draw spray, foam and bubbles in pictures made after tobiuo foam." },

static const tobi_param output_rows[] = {
    { .key = "interval", REAL, AT(tobi_output_def, interval), .def = { 0.01 }, DURATION,
      .unit = "s", .doc = "Simulated time between outputs, hit exactly. The end of the run has one, too, "
                          "if it is no multiple." },
    { .key = "checkpoint_interval", REAL, AT(tobi_output_def, checkpoint_interval), DURATION,
      .unit = "s", .text = "end",
      .doc = "Simulated time between checkpoints; end writes one when the run ends." },
    { .key = "probe_interval", REAL, AT(tobi_output_def, probe_interval), DURATION, .unit = "s",
      .text = "step", .doc = "Simulated time between rows of probes.csv, at least; step writes every step." },
    { .key = "compression", CHOICE("none|zlib|lz4|ascii", 4), AT(tobi_output_def, compression),
      .def = { TOBI_COMPRESS_ZLIB }, .doc = "Form of the VTU and VTP files." },
    { .key = "fields", TEXT, AT(tobi_output_def, fields), .unit = "names",
      .text = "usual",
      .doc = "Fields to write for every particle. usual, alone or among others, stands for velocity, "
             "pressure, density, object_id and particle_id, for mlsmpm von_mises, material and part too, "
             "for fluids that differ material, where a solid can part piece and cut_side, and "
             "texture_coordinates if a solid's mesh has them." },
    { .key = "surfaces", BOOL, AT(tobi_output_def, surfaces), .def = { 1 },
      .doc = "Write the moving surface of each body as VTP and STL." },
    { .key = "tractions", BOOL, AT(tobi_output_def, tractions),
      .doc = "Write the pressure and the shear of the fluid on each body's surface, Pa, in pieces of at "
             "most half a spacing, as VTP. Not of mlsmpm." },
    { .key = "frames", BOOL, AT(tobi_output_def, frames),
      .doc = "Write a PNG picture at each output." },
    { .key = "grid", BOOL, AT(tobi_output_def, grid),
      .doc = "Write the nodes of the grid of mlsmpm with velocity, mass and stress." },
    { .key = "ply", BOOL, AT(tobi_output_def, ply),
      .doc = "Write the positions of the fluid's particles as PLY, for other programs." },
    { .key = "obj", BOOL, AT(tobi_output_def, obj),
      .doc = "Write the moving surface of each body as OBJ, for other programs." },
    { .key = "surface.write", BOOL, AT(tobi_output_def, surface),
      .doc = "Write the surface of all fluids and of each piece of solids as VTP, in 3-D." },
    { .key = "surface.cell", REAL, AT(tobi_output_def, surface_cell), .def = { 0.75 }, RANGE(0.1, 2),
      .unit = "spacings", .doc = "Cell of the surface's grid; half of it makes four times the triangles." },
    { .key = "surface.smoothing", INT, AT(tobi_output_def, surface_smoothing), .def = { 20 }, RANGE(0, 100),
      .unit = "rounds", .doc = "Rounds of smoothing; drops and threads are left as they are." },
    { .key = "surface.fields", TEXT, AT(tobi_output_def, surface_fields), .unit = "names",
      .text = "usual",
      .doc = "Fields of the surface's vertices, means of the particles around, or components of them such as "
             "velocity_x. usual, alone or among others, stands for velocity and pressure." },
    VIEW_ROWS(tobi_output_def, view.)
    { 0 }
};

const tobi_param_table tobi_output_table = {
    "output", "The files of a run.", sizeof(tobi_output_def), output_rows };

static const tobi_param view_rows[] = {
    { .key = "name", TEXT, AT(tobi_view_def, name), .unit = "name", .text = "view", .required = true,
      .doc = "Name of the view, used once in a scene and in the names of its pictures." },
    VIEW_ROWS(tobi_view_def, )
    { 0 }
};

const tobi_param_table tobi_view_table = {
    "view", "An entry of output.views: one more picture of each output.", sizeof(tobi_view_def), view_rows };

static const tobi_param reference_rows[] = {
    { .key = "file", TEXT, AT(tobi_reference_def, file), .unit = "path", .required = true,
      .doc = "CSV file: a row with the names of its columns, then numbers; lines with # in front "
             "are comments." },
    { .key = "column", TEXT, AT(tobi_reference_def, column), .unit = "name", .required = true,
      .doc = "Column of history.csv that the values belong to, or of bodies.csv with body, or what a "
             "probe measures." },
    { .key = "body", TEXT, AT(tobi_reference_def, body), .unit = "name",
      .doc = "Name of the body, for a column of bodies.csv." },
    { .key = "probe", TEXT, AT(tobi_reference_def, probe), .unit = "name",
      .doc = "Name of the probe, for a column of probes.csv: pressure, velocity_x .. z, level, flow ..." },
    { .key = "x", TEXT, AT(tobi_reference_def, x), .unit = "text", .text = "time",
      .doc = "Column of the file with the times." },
    { .key = "y", TEXT, AT(tobi_reference_def, y), .unit = "text",
      .doc = "Column of the file with the values; without it the one that is named like column." },
    { .key = "x_scale", REAL, AT(tobi_reference_def, x_scale), .def = { 1 }, RANGE(1e-30, 1e30), .unit = "1",
      .doc = "Factor that turns x into seconds of the run." },
    { .key = "y_scale", REAL, AT(tobi_reference_def, y_scale), .def = { 1 }, RANGE(-1e30, 1e30), .unit = "1",
      .doc = "Factor that turns y into the unit of column." },
    { .key = "x_offset", REAL, AT(tobi_reference_def, x_offset), RANGE(-1e30, 1e30), .unit = "s",
      .doc = "Added to x after x_scale: the time of the run at which the file's clock begins." },
    { .key = "y_offset", REAL, AT(tobi_reference_def, y_offset), RANGE(-1e30, 1e30), .unit = "1",
      .doc = "Added to y after y_scale, in the unit of column: the height of the still water for a gauge "
             "that measures from it." },
    { .key = "label", TEXT, AT(tobi_reference_def, label), .unit = "text",
      .doc = "Name in the picture, such as the publication; without it the name of the file." },
    { 0 }
};

const tobi_param_table tobi_reference_table = {
    "reference", "An entry of references: data that `tobiuo plot` draws beside the run's.",
    sizeof(tobi_reference_def), reference_rows };
