/* Parameters of bodies and planes. */
#include "base/param_rows.h"
#include "base/param.h"

/* What a motor of a hinge and one of a guide have alike; it acts on `place`, or with `load`. */
#define MOTOR_FILE(key_of, type, motor, place, load) \
    { .key = key_of "file", TEXT, AT(type, motor.file), .unit = "path", \
      .doc = "Or a CSV file: time (s) and one of speed, " place " and " load ", in these units. Cubic " \
             "between the rows; before the first and after the last it stays." }, \
    { .key = key_of "amplitude", REAL, AT(type, motor.amplitude), RANGE(-1e8, 1e8), .unit = "1", \
      .doc = "amplitude sin(2 pi t/period + phase) is added to speed, " place " or " load ", in its " \
             "unit." }, \
    { .key = key_of "period", REAL, AT(type, motor.period), DURATION, .unit = "s", .text = "none", \
      .doc = "Time of one cycle of that." }, \
    { .key = key_of "phase", REAL, AT(type, motor.phase), RANGE(-1e9, 1e9), .unit = "degrees", \
      .doc = "Phase at time 0." }, \
    { .key = key_of "start", REAL, AT(type, motor.start), RANGE(-1e9, 1e9), .unit = "s", \
      .doc = "Until then speed, " place " or " load " is 0; the sine counts from time 0 all the same." }, \
    { .key = key_of "ramp", REAL, AT(type, motor.ramp), RANGE(0, 1e9), .unit = "s", \
      .doc = "It grows like (1 - cos(pi s/ramp))/2 in so many seconds after start." }

#define MOTOR(key_of, type, motor) \
    { .key = key_of "speed", REAL, AT(type, motor.speed), .def = { TOBI_NOT_GIVEN }, RANGE(-1e6, 1e6), \
      .unit = "degrees/s", .text = "none", \
      .doc = "Of a motor: the speed that the hinge turns at, by the right-hand rule. A motor has one of " \
             "speed, angle, torque and file." }, \
    { .key = key_of "angle", REAL, AT(type, motor.angle), .def = { TOBI_NOT_GIVEN }, ANGLE, \
      .unit = "degrees", .text = "none", .doc = "Or the angle that it turns to, from the start." }, \
    { .key = key_of "torque", REAL, AT(type, motor.torque), .def = { TOBI_NOT_GIVEN }, RANGE(-1e8, 1e8), \
      .unit = "N m", .text = "none", .doc = "Or the torque about the axis on the body." }, \
    MOTOR_FILE(key_of, type, motor, "angle", "torque"), \
    { .key = key_of "torque_max", REAL, AT(type, motor.torque_max), RANGE(1e-15, 1e15), .unit = "N m", \
      .text = "unlimited", .doc = "Of a speed or an angle: the largest torque of the motor, of either sign." }

#define GUIDE_MOTOR(key_of, type, motor) \
    { .key = key_of "speed", REAL, AT(type, motor.speed), .def = { TOBI_NOT_GIVEN }, RANGE(-1e6, 1e6), \
      .unit = "m/s", .text = "none", \
      .doc = "Of a motor: the speed that the body slides at, along the axis. A motor has one of speed, " \
             "position, force and file." }, \
    { .key = key_of "position", REAL, AT(type, motor.position), .def = { TOBI_NOT_GIVEN }, PLACE, \
      .unit = "m", .text = "none", .doc = "Or the way from the start that it goes to." }, \
    { .key = key_of "force", REAL, AT(type, motor.force), .def = { TOBI_NOT_GIVEN }, RANGE(-1e8, 1e8), \
      .unit = "N", .text = "none", .doc = "Or the force along the axis on the body." }, \
    MOTOR_FILE(key_of, type, motor, "position", "force"), \
    { .key = key_of "force_max", REAL, AT(type, motor.force_max), RANGE(1e-15, 1e15), .unit = "N", \
      .text = "unlimited", \
      .doc = "Of a speed or a position: the largest force of the motor, of either sign." }

static const tobi_param body_rows[] = {
    { .key = "name", TEXT, AT(tobi_body_def, name), .unit = "name", .text = "body",
      .required = true,
      .doc = "Name of the body, used once in a scene and in the names of its files." },
    { .key = "mesh", TEXT, AT(tobi_body_def, mesh), .unit = "path",
      .doc = "The body's closed surface (OBJ, STL or PLY); a body has a mesh, a box or another shape." },
    { .key = "box.min", VEC3, AT(tobi_body_def, box_min), PLACE, .unit = "m",
      .doc = "Lower corner of a plain box, instead of a mesh." },
    { .key = "box.max", VEC3, AT(tobi_body_def, box_max), PLACE, .unit = "m",
      .doc = "Upper corner of the box; scale, rotation and translation apply to it as to a mesh." },
    { .key = "sphere.centre", VEC3, AT(tobi_body_def, sphere_centre), PLACE, .unit = "m",
      .doc = "Middle of a sphere, in 2-D of a disc." },
    { .key = "sphere.radius", REAL, AT(tobi_body_def, sphere_radius), LENGTHS, .unit = "m", .text = "none",
      .doc = "Its radius. Round bodies have facets of about the body's spacing, and the exact volume." },
    { .key = "cylinder.start", VEC3, AT(tobi_body_def, cylinder_start), PLACE, .unit = "m",
      .doc = "Middle of one end of a cylinder." },
    { .key = "cylinder.end", VEC3, AT(tobi_body_def, cylinder_end), PLACE, .unit = "m",
      .doc = "Middle of its other end." },
    { .key = "cylinder.radius", REAL, AT(tobi_body_def, cylinder_radius), LENGTHS, .unit = "m",
      .text = "none", .doc = "Its radius." },
    { .key = "capsule.start", VEC3, AT(tobi_body_def, capsule_start), PLACE, .unit = "m",
      .doc = "Centre of the half sphere at one end of a capsule." },
    { .key = "capsule.end", VEC3, AT(tobi_body_def, capsule_end), PLACE, .unit = "m",
      .doc = "Centre of the half sphere at the other." },
    { .key = "capsule.radius", REAL, AT(tobi_body_def, capsule_radius), LENGTHS, .unit = "m",
      .text = "none", .doc = "Its radius." },
    { .key = "plate.centre", VEC3, AT(tobi_body_def, plate_centre), PLACE, .unit = "m",
      .doc = "Middle of a plate." },
    { .key = "plate.normal", VEC3, AT(tobi_body_def, plate_normal), .def = { 0, 0, 1 }, DIRECTION,
      .unit = "1", .doc = "Direction across its thickness." },
    { .key = "plate.along", VEC3, AT(tobi_body_def, plate_along), DIRECTION, .unit = "1",
      .doc = "Direction of its length; zero takes any that is normal to normal." },
    { .key = "plate.length", REAL, AT(tobi_body_def, plate_length), LENGTHS, .unit = "m", .text = "none",
      .doc = "Its length." },
    { .key = "plate.width", REAL, AT(tobi_body_def, plate_width), LENGTHS, .unit = "m", .text = "none",
      .doc = "Its width, across the other two; in 2-D it is not read." },
    { .key = "plate.thickness", REAL, AT(tobi_body_def, plate_thickness), LENGTHS, .unit = "m",
      .text = "none", .doc = "Its thickness." },
    { .key = "knife.edge", VEC3, AT(tobi_body_def, knife_edge), PLACE, .unit = "m",
      .doc = "Middle of the edge of a knife: a plate with two faces that meet in a straight edge." },
    { .key = "knife.direction", VEC3, AT(tobi_body_def, knife_direction), .def = { 0, 0, -1 }, DIRECTION,
      .unit = "1", .doc = "Direction from its back to its edge; in 2-D without one it is that of -y." },
    { .key = "knife.along", VEC3, AT(tobi_body_def, knife_along), .def = { 0, 1, 0 }, DIRECTION,
      .unit = "1", .doc = "Direction of its edge; in 2-D it is not read." },
    { .key = "knife.length", REAL, AT(tobi_body_def, knife_length), LENGTHS, .unit = "m", .text = "none",
      .doc = "Length of its edge; in 2-D it is not read." },
    { .key = "knife.height", REAL, AT(tobi_body_def, knife_height), LENGTHS, .unit = "m", .text = "none",
      .doc = "From its edge to its back." },
    { .key = "knife.thickness", REAL, AT(tobi_body_def, knife_thickness), LENGTHS, .unit = "m",
      .text = "none", .doc = "Its thickness, at its back." },
    { .key = "knife.angle", REAL, AT(tobi_body_def, knife_angle), .def = { 20 }, RANGE(1, 120),
      .unit = "degrees", .doc = "Angle between its faces at the edge. With blade it cuts; above 60 degrees "
             "edge_angle must allow it." },
    OUTLINE_ROWS(tobi_body_def, outline),
    { .key = "terrain.file", TEXT, AT(tobi_body_def, terrain_file), .unit = "path",
      .doc = "Heights of a bed in 3-D: an ESRI ASCII grid, or a CSV table of x, y and z (as in z [m]) of all "
             "points of a lattice." },
    { .key = "terrain.base", REAL, AT(tobi_body_def, terrain_base), PLACE, .unit = "m",
      .doc = "The body reaches from the heights down to it." },
    { .key = "scale", VEC3, AT(tobi_body_def, scale), .def = { 1, 1, 1 }, FACTOR,
      .positive = true, .unit = "1",
      .doc = "Size factor, one number or one per axis, about the mesh's own origin, applied "
             "first." },
    { .key = "rotation.axis", VEC3, AT(tobi_body_def, rotation_axis), .def = { 0, 0, 1 }, DIRECTION,
      .unit = "1", .doc = "Direction of the axis through the origin of the mesh, of a box that "
      "of the domain, that it is turned about, applied second." },
    { .key = "rotation.angle", REAL, AT(tobi_body_def, rotation_angle), ANGLE, .unit = "degrees",
      .doc = "Angle of that turn, by the right-hand rule." },
    { .key = "translation", VEC3, AT(tobi_body_def, translation), PLACE, .unit = "m",
      .doc = "Where the origin of the mesh is put, applied last." },
    { .key = "vessel", BOOL, AT(tobi_body_def, vessel),
      .doc = "Whether the body is a vessel: its mesh has walls, or is the inner surface, open or closed." },
    { .key = "wall_thickness", REAL, AT(tobi_body_def, wall_thickness), LENGTHS, .unit = "m",
      .text = "automatic",
      .doc = "Thickness of a vessel's walls outside of the mesh; automatic takes the mesh's own walls, or 2 "
             "spacings where it has none." },
    { .key = "open_side", VEC3, AT(tobi_body_def, open_side), DIRECTION, .unit = "1",
      .doc = "Direction of the flat side, as the body starts, that a vessel of a box, a cylinder or a mesh "
             "without walls leaves open: [0, 0, 1] makes a cup of a box; zero leaves none open." },
    { .key = "density", REAL, AT(tobi_body_def, density), .def = { 1000 }, DENSITY,
      .unit = "kg/m3", .doc = "Density of the body, for its mass and inertia." },
    { .key = "spacing", REAL, AT(tobi_body_def, spacing), LENGTHS, .unit = "m", .text = "fluid",
      .doc = "Distance between the body's own particles, whatever the fluid's; fluid takes that of "
             "the fluid." },
    { .key = "friction", CHOICE("slip|no-slip", 2), AT(tobi_body_def, friction),
      .doc = "Whether the fluid slips along the body or sticks to it, rubbing as a turbulent layer where the "
             "spacing is too coarse for the layer at the surface." },
    { .key = "sealed", BOOL, AT(tobi_body_def, sealed),
      .doc = "Whether no liquid reaches the gap where the body lies on a side of the domain or another "
             "body: then nothing presses it there. Else the gap has the pressure around it. Faces of "
             "prescribed bodies that touch, or of joined ones, are sealed in any case." },
    { .key = "contact_angle", REAL, AT(tobi_body_def, contact_angle), .def = { 90 },
      RANGE(10, 170), .unit = "degrees",
      .doc = "Angle, measured in the liquid, at which a surface with tension meets the body." },
    { .key = "absent.from", REAL, AT(tobi_body_def, absent_from), DURATION, .unit = "s", .text = "never",
      .doc = "From then on a prescribed body is not there: a gate that is taken away at once." },
    { .key = "absent.until", REAL, AT(tobi_body_def, absent_until), DURATION, .unit = "s", .text = "the end",
      .doc = "Then it is there again, and liquid in it is pushed out; a solid in it is not." },
    { .key = "texture", TEXT, AT(tobi_body_def, texture), .unit = "path",
      .doc = "A PNG or JPEG image that pictures show on the body instead of its colour; its mesh needs "
             "texture coordinates (vt of an OBJ file). With an opacity below 1 it is like "
             "stained glass. A vessel in 2-D, drawn as an outline, takes none." },
    { .key = "visible", BOOL, AT(tobi_body_def, visible), .def = { 1 },
      .doc = "Whether pictures show the body." },
    { .key = "color", COLOR, AT(tobi_body_def, color), .text = "automatic",
      .doc = "Colour in pictures, red, green and blue; automatic goes by the number of the body, and is that "
             "of glass for a vessel of automatic opacity." },
    { .key = "opacity", REAL, AT(tobi_body_def, opacity), RANGE(0.01, 1), .positive = true, .unit = "1",
      .text = "automatic",
      .doc = "Share of the light that its surface keeps away in pictures; below 1 it looks like glass. "
             "Automatic is 1, of a vessel in 3-D 0.15." },
    { .key = "dynamics", CHOICE("prescribed|free|controlled", 3), AT(tobi_body_def, dynamics),
      .doc = "What moves the body: its motion, if it has one; the forces on it; or these and its control "
             "program. With forces a motion changes the shape alone: docs/swimmers.md." },
    { .key = "mass", REAL, AT(tobi_body_def, mass), MASS, .unit = "kg", .text = "by density",
      .doc = "Mass, per metre of depth in 2-D; by density takes density times the volume of the mesh." },
    { .key = "centre_of_mass", VEC3, AT(tobi_body_def, centre_of_mass),
      .def = { TOBI_NO_PLACE, TOBI_NO_PLACE, TOBI_NO_PLACE }, PLACE, .unit = "m", .text = "mesh",
      .doc = "Its centre of mass, as the body starts: a ship's centre of gravity. Torques of bodies.csv are "
             "about it. mesh takes the middle of the mesh's volume." },
    { .key = "inertia", VEC3, AT(tobi_body_def, inertia), RANGE(0, 1e30), .unit = "kg m2", .text = "mesh",
      .doc = "Entries xx, yy, zz of the inertia matrix about the centre of mass, in the axes of the domain "
             "as the body starts; no principal moment may be larger than the sum of the other two. mesh "
             "takes that of the mesh about its own middle, for the mass it has." },
    { .key = "inertia_products", VEC3, AT(tobi_body_def, inertia_products), RANGE(-1e30, 1e30),
      .unit = "kg m2", .doc = "Entries xy, xz, yz of a given inertia matrix." },
    { .key = "velocity", VEC3, AT(tobi_body_def, velocity), SPEED, .unit = "m/s",
      .doc = "Velocity of the centre of mass of a free or controlled body at the start." },
    { .key = "angular_velocity", VEC3, AT(tobi_body_def, angular_velocity), SPEED, .unit = "rad/s",
      .doc = "Its angular velocity at the start." },
    { .key = "force", VEC3, AT(tobi_body_def, force), PULL, .unit = "N",
      .doc = "Constant force on its centre of mass, besides gravity." },
    { .key = "torque", VEC3, AT(tobi_body_def, torque), PULL, .unit = "N m",
      .doc = "Constant torque on it." },
    { .key = "air_resistance", REAL, AT(tobi_body_def, air_resistance), RANGE(0, 1e6), .unit = "1/s",
      .text = "none", .doc = "Its velocity and its angular momentum decay like exp(-air_resistance t)." },
    { .key = "restitution", REAL, AT(tobi_body_def, restitution), RANGE(0, 1), .unit = "1",
      .doc = "Speed after over speed before a collision; of two bodies the larger value counts, against a "
             "side of the domain, a plane or a solid of mlsmpm the body's alone." },
    { .key = "friction_coefficient", REAL, AT(tobi_body_def, friction_coefficient), .def = { TOBI_NOT_GIVEN },
      FRICTION, .unit = "1", .text = "by the other",
      .doc = "Coulomb friction; of two bodies, and of a body with a separate plane, the square root of the "
             "product counts, against a side of the domain or a solid of mlsmpm the body's alone. By the "
             "other: that of the body it meets, if that gives one; else 0.5." },
    { .key = "blade", BOOL, AT(tobi_body_def, blade),
      .doc = "Whether the body's edge cuts solids of mlsmpm; what is cut stays cut." },
    { .key = "edge_resistance", REAL, AT(tobi_body_def, edge_resistance), RANGE(0, 1e12), .unit = "J/m2",
      .doc = "Energy that the edge of a blade takes for each square metre that it cuts; apple 250." },
    { .key = "edge_angle", REAL, AT(tobi_body_def, edge_angle), .def = { 60 }, RANGE(1, 120),
      .unit = "degrees",
      .doc = "The edge of a blade is where its faces meet at this angle or a sharper one; a rounding or flat "
             "up to a quarter of the blade's mean thickness counts as the edge." },
    { .key = "edge_start", VEC3, AT(tobi_body_def, edge_start), PLACE, .unit = "m",
      .doc = "One end of a straight edge that cuts in every direction, as the body starts, instead of the "
             "edge found in the mesh: for a wire. In 2-D the edge is this point." },
    { .key = "edge_end", VEC3, AT(tobi_body_def, edge_end), PLACE, .unit = "m",
      .doc = "The other end of that edge." },
    { .key = "locked", TEXT, AT(tobi_body_def, locked), .unit = "text",
      .doc = "Axes along which (x, y, z or shift for all) or about which (turn_x, turn_y, turn_z or turn) a "
             "free or controlled body does not move, with commas between: \"x,y,turn\"." },
    { .key = "hinge.point", VEC3, AT(tobi_body_def, hinge_point), PLACE, .unit = "m",
      .doc = "A point on the fixed axis that a free or controlled body turns about." },
    { .key = "hinge.axis", VEC3, AT(tobi_body_def, hinge_axis), DIRECTION, .unit = "1",
      .doc = "Direction of that axis; in 2-D it is along z." },
    { .key = "hinge.lower", REAL, AT(tobi_body_def, hinge_lower), RANGE(-180, 180), .unit = "degrees",
      .doc = "Stop: the least angle from the start, by the right-hand rule. Both stops 0: there are none." },
    { .key = "hinge.upper", REAL, AT(tobi_body_def, hinge_upper), RANGE(-180, 180), .unit = "degrees",
      .doc = "Stop: the largest angle. The body bounces off a stop by its restitution." },
    { .key = "hinge.stiffness", REAL, AT(tobi_body_def, hinge_stiffness), RANGE(0, 1e15), .unit = "N m/rad",
      .doc = "Of a spring that pulls the hinge back to where it starts." },
    { .key = "hinge.damping", REAL, AT(tobi_body_def, hinge_damping), RANGE(0, 1e15), .unit = "N m s/rad",
      .doc = "Of a damper at the hinge." },
    MOTOR("hinge.motor.", tobi_body_def, hinge_motor),
    { .key = "guide.axis", VEC3, AT(tobi_body_def, guide_axis), DIRECTION, .unit = "1",
      .doc = "Direction of the fixed axis that a free or controlled body slides along; it does not turn." },
    { .key = "guide.lower", REAL, AT(tobi_body_def, guide_lower), PLACE, .unit = "m",
      .doc = "Stop: the least way from the start. Both stops 0: there are none." },
    { .key = "guide.upper", REAL, AT(tobi_body_def, guide_upper), PLACE, .unit = "m",
      .doc = "Stop: the largest way." },
    { .key = "guide.stiffness", REAL, AT(tobi_body_def, guide_stiffness), RANGE(0, 1e15), .unit = "N/m",
      .doc = "Of a spring that pulls the body back to where it starts." },
    { .key = "guide.damping", REAL, AT(tobi_body_def, guide_damping), RANGE(0, 1e15), .unit = "N s/m",
      .doc = "Of a damper along the guide." },
    GUIDE_MOTOR("guide.motor.", tobi_body_def, guide_motor),
    { 0 }
};

const tobi_param_table tobi_body_table = {
    "body", "An entry of bodies: the inside of a closed mesh, at rest or moved by a motion.",
    sizeof(tobi_body_def), body_rows };

static const tobi_param line_rows[] = {
    { .key = "name", TEXT, AT(tobi_line_def, name), .unit = "name", .text = "line", .required = true,
      .doc = "Name of the line, used once in a scene and in the columns of lines.csv." },
    { .key = "kind", CHOICE("spring|rope|catenary", 3), AT(tobi_line_def, kind),
      .doc = "A spring pulls and pushes, a rope pulls when it is taut, a catenary is a mooring line that "
             "hangs by its weight." },
    { .key = "body", TEXT, AT(tobi_line_def, body), .unit = "name", .required = true,
      .doc = "Name of the free or controlled body that it holds." },
    { .key = "point", VEC3, AT(tobi_line_def, point), PLACE, .unit = "m", .required = true,
      .doc = "Where it holds the body, as the body starts." },
    { .key = "to_body", TEXT, AT(tobi_line_def, to_body), .unit = "name",
      .doc = "Name of the body at its other end, which may be prescribed; without it that end is fixed." },
    { .key = "to", VEC3, AT(tobi_line_def, to), PLACE, .unit = "m", .required = true,
      .doc = "The other end at the start." },
    { .key = "length", REAL, AT(tobi_line_def, length), RANGE(1e-7, 1e7), .unit = "m", .text = "as placed",
      .doc = "Length without force; as placed takes the distance of the ends at the start." },
    { .key = "stiffness", REAL, AT(tobi_line_def, stiffness), RANGE(1e-9, 1e12), .unit = "N/m",
      .required = true,
      .doc = "Force per stretch; of a catenary its EA over its length. Stiff lines shorten the time step." },
    { .key = "damping", REAL, AT(tobi_line_def, damping), RANGE(0, 1e12), .unit = "N s/m",
      .doc = "Force per speed at which a spring or a taut rope grows." },
    { .key = "weight", REAL, AT(tobi_line_def, weight), RANGE(0, 1e9), .unit = "N/m",
      .doc = "Of a catenary: weight per length less buoyancy." },
    { .key = "rests", BOOL, AT(tobi_line_def, rests),
      .doc = "Whether a catenary may lie on a floor at the height of its lower end." },
    { 0 }
};

const tobi_param_table tobi_line_table = {
    "line", "An entry of lines: a spring, a rope or a mooring line.", sizeof(tobi_line_def), line_rows };

static const tobi_param joint_rows[] = {
    { .key = "name", TEXT, AT(tobi_joint_def, name), .unit = "name", .text = "joint", .required = true,
      .doc = "Name of the joint, used once in a scene and in the columns of joints.csv." },
    { .key = "kind", CHOICE("hinge|ball|fixed|slide", 4), AT(tobi_joint_def, kind),
      .doc = "A hinge lets the bodies turn against each other about its axis, a ball joint about its point; "
             "fixed, they are one. On a slide the body goes along its axis and does not turn against the "
             "other. In 2-D a ball joint is a hinge." },
    { .key = "body", TEXT, AT(tobi_joint_def, body), .unit = "name", .required = true,
      .doc = "Name of the free or controlled body that it holds." },
    { .key = "to_body", TEXT, AT(tobi_joint_def, to_body), .unit = "name",
      .doc = "Name of the body that it is joined to, which may be prescribed; without it, the domain." },
    { .key = "point", VEC3, AT(tobi_joint_def, point), PLACE, .unit = "m", .required = true,
      .doc = "Where they are joined, as the bodies start." },
    { .key = "axis", VEC3, AT(tobi_joint_def, axis), DIRECTION, .unit = "1",
      .doc = "Direction of the axis of a hinge, as the bodies start, in 2-D along z; or of a slide, along "
             "which the body goes. That of a slide moves with to_body." },
    { .key = "lower", REAL, AT(tobi_joint_def, lower), RANGE(-179, 0), .unit = "degrees or m",
      .doc = "Stop of a hinge, the least angle of the body against the other, degrees, or of a slide, the "
             "least way from the start, m; both stops 0 mean none." },
    { .key = "upper", REAL, AT(tobi_joint_def, upper), RANGE(0, 179), .unit = "degrees or m",
      .doc = "The other stop, the greatest angle or way. Bodies do not bounce off stops." },
    { .key = "stiffness", REAL, AT(tobi_joint_def, stiffness), RANGE(0, 1e12), .unit = "N m/rad or N/m",
      .doc = "Of a spring in a hinge or slide. Stiff springs shorten the time step." },
    { .key = "rest", REAL, AT(tobi_joint_def, rest), RANGE(-180, 180), .unit = "degrees or m",
      .doc = "Angle or way at which the spring is without load; the bodies start at 0." },
    { .key = "damping", REAL, AT(tobi_joint_def, damping), RANGE(0, 1e12), .unit = "N m s/rad or N s/m",
      .doc = "Of a damper in a hinge or slide." },
    { .key = "motor.speed", REAL, AT(tobi_joint_def, motor.speed), .def = { TOBI_NOT_GIVEN },
      RANGE(-1e6, 1e6), .unit = "degrees/s or m/s", .text = "none",
      .doc = "Of a motor: the speed that the hinge turns at, by the right-hand rule, or that the body slides "
             "at. A motor has one of speed, angle or position, torque or force, and file." },
    { .key = "motor.angle", REAL, AT(tobi_joint_def, motor.angle), .def = { TOBI_NOT_GIVEN }, ANGLE,
      .unit = "degrees", .text = "none", .doc = "Or the angle that a hinge turns to, from the start." },
    { .key = "motor.position", REAL, AT(tobi_joint_def, motor.position), .def = { TOBI_NOT_GIVEN }, ANGLE,
      .unit = "m", .text = "none", .doc = "Or the way from the start that it slides to." },
    { .key = "motor.torque", REAL, AT(tobi_joint_def, motor.torque), .def = { TOBI_NOT_GIVEN },
      RANGE(-1e8, 1e8), .unit = "N m", .text = "none",
      .doc = "Or the torque about the axis of a hinge on the body." },
    { .key = "motor.force", REAL, AT(tobi_joint_def, motor.force), .def = { TOBI_NOT_GIVEN },
      RANGE(-1e8, 1e8), .unit = "N", .text = "none",
      .doc = "Or the force along the axis of a slide on the body." },
    MOTOR_FILE("motor.", tobi_joint_def, motor, "angle, position, torque", "force"),
    { .key = "motor.torque_max", REAL, AT(tobi_joint_def, motor.torque_max), RANGE(1e-15, 1e15),
      .unit = "N m", .text = "unlimited",
      .doc = "Of a speed or an angle: the largest torque of the motor, of either sign." },
    { .key = "motor.force_max", REAL, AT(tobi_joint_def, motor.force_max), RANGE(1e-15, 1e15), .unit = "N",
      .text = "unlimited",
      .doc = "Of a speed or a position: the largest force of the motor, of either sign." },
    { 0 }
};

const tobi_param_table tobi_joint_table = {
    "joint", "An entry of joints: joins a body to another one, or to the domain.", sizeof(tobi_joint_def),
    joint_rows };

static const tobi_param plane_rows[] = {
    { .key = "point", VEC3, AT(tobi_plane_def, point), PLACE, .unit = "m", .required = true,
      .doc = "Any point of the plane, in the domain." },
    { .key = "normal", VEC3, AT(tobi_plane_def, normal), DIRECTION, .unit = "1", .required = true,
      .doc = "Direction out of the plane, of any length; what lies behind is closed to solids and bodies." },
    { .key = "kind", CHOICE("separate|slip|no-slip", 3), AT(tobi_plane_def, kind),
      .doc = "What solids may do at it: separate and slide with friction, slip along it, stick to it. Bodies "
             "always separate; slip is without friction for them, no-slip has theirs." },
    { .key = "friction", REAL, AT(tobi_plane_def, friction), FRICTION, .unit = "1", .text = "none",
      .doc = "Coulomb friction of a \"separate\" plane; with a body the square root of the product counts." },
    { 0 }
};

const tobi_param_table tobi_plane_table = {
    "plane", "An entry of planes: a fixed plane in the domain, for solids of mlsmpm and for bodies.",
    sizeof(tobi_plane_def), plane_rows };
