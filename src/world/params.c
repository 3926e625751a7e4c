/* One table per definition struct. A member that is missing here cannot be set by a scene, has no
   default and appears in no help text; a unit test checks that the tables cover the structs. */
#include "world/params.h"
#include "tobiuo/tobiuo.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

#define AT(type, member_name) .offset = offsetof(type, member_name)
#define REAL     .type = TOBI_PARAM_REAL
#define INT      .type = TOBI_PARAM_INT
#define BOOL     .type = TOBI_PARAM_BOOL, .min = 0, .max = 1, .unit = "true or false"
#define VEC3     .type = TOBI_PARAM_VEC3
#define TEXT     .type = TOBI_PARAM_TEXT, .min = NAN, .max = NAN
#define ANY      .min = NAN, .max = NAN
#define FROM(a)  .min = (a), .max = NAN
#define RANGE(a, b) .min = (a), .max = (b)
#define POSITIVE .min = 0, .max = NAN, .positive = true
/* Red, green and blue; the word of the row stands for the default, which is no colour. */
#define COLOR .type = TOBI_PARAM_VEC3, .def = { -1, -1, -1 }, .min = 0, .max = 255, .unit = "RGB"
#define CHOICE(words, count) \
    .type = TOBI_PARAM_CHOICE, .min = 0, .max = (count) - 1, .choices = words, .unit = "word"

#define WALL(key_, member_, axis_, doc_)                                              \
    { .key = key_, CHOICE("slip|no-slip|periodic|separate|open", 5),                                \
      .offset = offsetof(tobi_world_def, member_) + (axis_)*sizeof(int), .doc = doc_ }

#define WALL_VELOCITY(key_, member_, axis_, doc_)                                     \
    { .key = key_, VEC3, ANY, .unit = "m/s",                                          \
      .offset = offsetof(tobi_world_def, member_) + (axis_)*3*sizeof(double),         \
      .doc = doc_ " Velocity along itself of a no-slip side: a lid, a belt." }

/* Of every SPH method. */
#define SMOOTHING(type_)                                                              \
    { .key = "kernel", CHOICE("wendland-c2|cubic-spline", 2), AT(type_, kernel),      \
      .doc = "Smoothing kernel." },                                                   \
    { .key = "support", REAL, AT(type_, support), RANGE(2, 4), .unit = "spacings",      \
      .text = "automatic",                                                            \
      .doc = "Support radius of the kernel: 2 is fast, 3 to 4 is more accurate. Automatic is 2; dfsph "      \
             "takes 2.5 where liquid fills the domain and a body or a side moves." }

static const tobi_param world_rows[] = {
    { .key = "method", TEXT, AT(tobi_world_def, method), .unit = "method", .text = "dfsph",
      .doc = "The method that moves the particles." },
    { .key = "dimension", INT, AT(tobi_world_def, dimension), .def = { 3 }, RANGE(2, 3),
      .unit = "1",
      .doc = "3, or 2 for a flow in the x-y plane with masses and forces per metre of depth." },
    { .key = "domain.min", VEC3, AT(tobi_world_def, domain_min), ANY, .unit = "m",
      .required = true, .doc = "Lower corner of the box that holds everything, of any sign." },
    { .key = "domain.max", VEC3, AT(tobi_world_def, domain_max), ANY, .unit = "m",
      .required = true, .doc = "Upper corner of the box." },
    WALL("domain.walls.x[0]", wall_min, 0, "Side at the lower x; open lets the particles of mlsmpm out."),
    WALL("domain.walls.x[1]", wall_max, 0, "Side at the upper x; periodic comes in pairs."),
    WALL("domain.walls.y[0]", wall_min, 1, "Side at the lower y."),
    WALL("domain.walls.y[1]", wall_max, 1, "Side at the upper y."),
    WALL("domain.walls.z[0]", wall_min, 2, "Side at the lower z."),
    WALL("domain.walls.z[1]", wall_max, 2, "Side at the upper z."),
    { .key = "domain.contact_angle", REAL, AT(tobi_world_def, contact_angle), .def = { 90 },
      RANGE(10, 170), .unit = "degrees",
      .doc = "Angle, measured in the liquid, at which a surface with tension meets the sides." },
    { .key = "domain.friction", REAL, AT(tobi_world_def, friction), FROM(0), .unit = "1",
      .text = "none", .doc = "Coulomb friction between solids and the \"separate\" sides." },
    WALL_VELOCITY("domain.wall_velocity.x[0]", wall_velocity_min, 0, "The side at the lower x."),
    WALL_VELOCITY("domain.wall_velocity.x[1]", wall_velocity_max, 0, "The side at the upper x."),
    WALL_VELOCITY("domain.wall_velocity.y[0]", wall_velocity_min, 1, "The side at the lower y."),
    WALL_VELOCITY("domain.wall_velocity.y[1]", wall_velocity_max, 1, "The side at the upper y."),
    WALL_VELOCITY("domain.wall_velocity.z[0]", wall_velocity_min, 2, "The side at the lower z."),
    WALL_VELOCITY("domain.wall_velocity.z[1]", wall_velocity_max, 2, "The side at the upper z."),
    { .key = "gravity", VEC3, AT(tobi_world_def, gravity), .def = { 0, 0, -9.81 }, ANY,
      .unit = "m/s2",
      .doc = "Acceleration of gravity, in any direction; a 2-D scene that gives none gets [0, "
             "-9.81]." },
    { .key = "spacing", REAL, AT(tobi_world_def, spacing), POSITIVE, .unit = "m", .required = true,
      .doc = "Distance between fluid particles: the resolution." },
    { .key = "end_time", REAL, AT(tobi_world_def, end_time), FROM(0), .unit = "s", .required = true,
      .doc = "Simulated time at which the run ends." },
    { .key = "time_step", REAL, AT(tobi_world_def, time_step), FROM(0), .unit = "s",
      .text = "adaptive",
      .doc = "A fixed time step; adaptive chooses each step from speeds, forces and viscosity." },
    { .key = "time_step_max", REAL, AT(tobi_world_def, time_step_max), FROM(0), .unit = "s",
      .text = "none", .doc = "Longest step that the adaptive choice may take." },
    { .key = "cfl", REAL, AT(tobi_world_def, cfl), .def = { 0.4 }, .min = 0, .max = 1,
      .positive = true, .unit = "1",
      .doc = "Largest part of a spacing that the fastest particle moves in one adaptive step of dfsph and "
             "wcsph; mlsmpm has its own." },
    { .key = "speed_limit", REAL, AT(tobi_world_def, speed_limit), FROM(0), .unit = "m/s",
      .text = "automatic", .doc = "A particle faster than this stops the run as diverged." },
    { .key = "threads", INT, AT(tobi_world_def, threads), RANGE(0, 4096), .unit = "1",
      .text = "all", .doc = "Processor cores to use; the result is the same for any number." },
    { 0 }
};

static const tobi_param dfsph_rows[] = {
    SMOOTHING(tobi_dfsph_def),
    { .key = "density_tolerance", REAL, AT(tobi_dfsph_def, density_tolerance), .def = { 5e-4 },
      .min = 0, .max = 0.1, .positive = true, .unit = "1",
      .doc = "Mean relative density error at which the density solve may stop." },
    { .key = "divergence_tolerance", REAL, AT(tobi_dfsph_def, divergence_tolerance),
      .def = { 1e-3 }, .min = 0, .max = 1, .positive = true, .unit = "1",
      .doc = "Mean |div v| times the time step at which the divergence solve may stop." },
    { .key = "pressure_tolerance", REAL, AT(tobi_dfsph_def, pressure_tolerance), .def = { 0.05 },
      .min = 0, .max = 1, .positive = true, .unit = "1",
      .doc = "Relative pressure residual that both solves must reach as well." },
    { .key = "density_iterations_min", INT, AT(tobi_dfsph_def, density_iterations_min),
      .def = { 1 },
      RANGE(0, 1000000), .unit = "1", .doc = "Fewest iterations of the density solve in a step." },
    { .key = "density_iterations_max", INT, AT(tobi_dfsph_def, density_iterations_max),
      .def = { 1000 }, RANGE(1, 1000000), .unit = "1",
      .doc = "Most iterations of the density solve; a step that needs more is reported as not "
             "converged." },
    { .key = "divergence_iterations_min", INT, AT(tobi_dfsph_def, divergence_iterations_min),
      .def = { 1 }, RANGE(0, 1000000), .unit = "1",
      .doc = "Fewest iterations of the divergence solve in a step." },
    { .key = "divergence_iterations_max", INT, AT(tobi_dfsph_def, divergence_iterations_max),
      .def = { 200 },
      RANGE(0, 1000000), .unit = "1", .doc = "Most iterations of the divergence solve in a step." },
    { .key = "filter", REAL, AT(tobi_dfsph_def, filter), .def = { 1 }, RANGE(0, 1), .unit = "1",
      .text = "off",
      .doc = "Share of particle-scale motion taken out per step; longer waves are left alone. In full "
             "vessels, unless bodies move there by forces, what viscosity takes counts, and linear flows "
             "are left alone as well." },
    { .key = "shifting", REAL, AT(tobi_dfsph_def, shifting), .def = { 0.5 }, RANGE(0, 1),
      .unit = "1", .text = "off",
      .doc = "Strength of particle shifting in a vessel full of liquid, where without it cavities open "
             "behind moving bodies; off with a free surface, and with a support below 2.5." },
    { .key = "still_water", BOOL, AT(tobi_dfsph_def, still_water), .def = { 1 },
      .doc = "Take the pressure that water at rest has, some layers below the free surface, from gravity and "
             "solve for the rest: slow bodies and waves then lose far less to the disorder of particles." },
    { 0 }
};

static const tobi_param wcsph_rows[] = {
    SMOOTHING(tobi_wcsph_def),
    { .key = "stiffness", REAL, AT(tobi_wcsph_def, stiffness), .def = { 50000 }, POSITIVE,
      .unit = "Pa",
      .doc = "B of the Tait equation p = B ((rho/rho0)^exponent - 1). The speed of sound is "
             "sqrt(exponent B/rho0); ten times the fastest flow keeps the density within 1 %." },
    { .key = "exponent", REAL, AT(tobi_wcsph_def, exponent), .def = { 7 }, RANGE(1, 20),
      .unit = "1", .doc = "Exponent of the Tait equation." },
    { .key = "damping", REAL, AT(tobi_wcsph_def, damping), .def = { 1 }, RANGE(0, 1), .unit = "1",
      .text = "off",
      .doc = "Damping of sound: a bulk viscosity of damping times density, speed of sound and "
             "spacing. Shear and slow flow do not feel it." },
    { .key = "filter", REAL, AT(tobi_wcsph_def, filter), .def = { 1 }, RANGE(0, 1), .unit = "1",
      .text = "off",
      .doc = "Share of particle-scale motion taken out per step of a tenth of the speed of sound; "
             "longer waves are left alone." },
    { .key = "still_water", BOOL, AT(tobi_wcsph_def, still_water), .def = { 1 },
      .doc = "Start with the pressure that water at rest has, and take it, some layers below the free "
             "surface, from gravity: the water does not ring, and slow bodies and waves lose far less to the "
             "disorder of particles." },
    { 0 }
};

static const tobi_param mlsmpm_rows[] = {
    { .key = "cell", REAL, AT(tobi_mlsmpm_def, cell), .def = { 2 }, RANGE(1, 8), .unit = "spacings",
      .doc = "Side of a grid cell: 2 puts 8 particles in a cell of a 3-D scene." },
    { .key = "transfer", CHOICE("apic|flip|xpic", 3), AT(tobi_mlsmpm_def, transfer),
      .doc = "How velocities go between particles and grid: apic keeps angular momentum, flip keeps "
             "the most energy, xpic filters noise." },
    { .key = "flip", REAL, AT(tobi_mlsmpm_def, flip), .def = { 0.99 }, RANGE(0, 1), .unit = "1",
      .doc = "Share of FLIP in its blend with PIC, if transfer is flip." },
    { .key = "xpic_order", INT, AT(tobi_mlsmpm_def, xpic_order), .def = { 2 }, RANGE(1, 5),
      .unit = "1", .doc = "Order of the filter, if transfer is xpic; 1 is PIC." },
    { .key = "gradient", CHOICE("automatic|spline|mls", 3), AT(tobi_mlsmpm_def, gradient),
      .doc = "How stress pushes the grid: by the gradient of the splines, or by that of moving least "
             "squares, with which slender solids that lean in the grid bend up to a tenth too easily and a "
             "step takes 4 % less time, without AVX-512 a fifth. Automatic is spline, and mls in scenes with "
             "blades or with a solid that has a strength." },
    { .key = "cfl", REAL, AT(tobi_mlsmpm_def, cfl), .def = { 0.4 }, .min = 0, .max = 0.5,
      .positive = true, .unit = "1",
      .doc = "Largest part of a cell that sound and particles together cross in a step." },
    { .key = "measure_transfer", BOOL, AT(tobi_mlsmpm_def, measure_transfer),
      .doc = "Sum up in every step what the way to the grid and back, time steps and plastic flow cost, for "
             "transfer_dissipation, step_work and plastic_work in history.csv, which are 0 without it; steps "
             "take up to 5 times as long, where material flows 20 times." },
    { .key = "leaving", CHOICE("keep|remove", 2), AT(tobi_mlsmpm_def, leaving),
      .doc = "What becomes of particles that get past a side: they are put back to it and counted (put_back "
             "in history.csv), or removed (particles_lost); those past an open side are removed." },
    { 0 }
};

static const tobi_param solid_rows[] = {
    { .key = "name", TEXT, AT(tobi_solid_def, name), .unit = "name", .text = "solid", .required = true,
      .doc = "Name of the solid, used once in a scene." },
    { .key = "model", CHOICE("neo-hookean|corotated|liquid|von-mises|snow|sand|stationary", 7),
      AT(tobi_solid_def, model), .doc = "What its stress depends on." },
    { .key = "density", REAL, AT(tobi_solid_def, density), .def = { 1000 }, POSITIVE, .unit = "kg/m3",
      .doc = "Density at the start." },
    { .key = "mass", REAL, AT(tobi_solid_def, mass), POSITIVE, .unit = "kg", .text = "by density",
      .doc = "Mass of all regions together, instead of a density; per metre of depth in 2-D." },
    { .key = "youngs_modulus", REAL, AT(tobi_solid_def, youngs_modulus), .def = { 1e6 }, POSITIVE,
      .unit = "Pa", .doc = "Young's modulus of small strains; liquids have a bulk modulus instead." },
    { .key = "poissons_ratio", REAL, AT(tobi_solid_def, poissons_ratio), .def = { 0.3 },
      RANGE(-0.99, 0.495), .unit = "1", .doc = "Poisson's ratio of small strains." },
    { .key = "bulk_modulus", REAL, AT(tobi_solid_def, bulk_modulus), .def = { 1e5 }, POSITIVE,
      .unit = "Pa",
      .doc = "Stiffness of a liquid: density times the square of the speed of sound; ten times the "
             "fastest flow keeps the density within 1 %." },
    { .key = "viscosity", REAL, AT(tobi_solid_def, viscosity), FROM(0), .unit = "Pa s",
      .text = "none", .doc = "Dynamic viscosity of a liquid." },
    { .key = "yield_stress", REAL, AT(tobi_solid_def, yield_stress), .def = { 1e4 }, POSITIVE,
      .unit = "Pa", .doc = "Von Mises stress at which a von-mises solid begins to flow." },
    { .key = "hardening", REAL, AT(tobi_solid_def, hardening), FROM(0), .unit = "Pa or 1",
      .text = "none",
      .doc = "Of von-mises: rise of the yield stress per plastic strain, Pa; of snow: exponent by which "
             "compaction stiffens it." },
    { .key = "critical_compression", REAL, AT(tobi_solid_def, critical_compression), .def = { 0.025 },
      RANGE(0, 0.5), .unit = "1", .doc = "Compression at which snow yields." },
    { .key = "critical_stretch", REAL, AT(tobi_solid_def, critical_stretch), .def = { 0.0075 },
      RANGE(0, 0.5), .unit = "1", .doc = "Stretch at which snow breaks." },
    { .key = "friction_angle", REAL, AT(tobi_solid_def, friction_angle), .def = { 30 }, RANGE(0, 60),
      .unit = "degrees",
      .doc = "Slope at which sand comes to rest: sheared, it flows at its tangent times the pressure. Also "
             "of a neo-hookean or corotated solid where it is broken." },
    { .key = "friction_rise", REAL, AT(tobi_solid_def, friction_rise), FROM(0), .unit = "1", .text = "none",
      .doc = "By how much the friction of sand rises above the tangent of friction_angle in fast flow, by "
             "the law mu(I); 0.26 for glass beads (Jop et al. 2006)." },
    { .key = "grain_diameter", REAL, AT(tobi_solid_def, grain_diameter), .def = { 1e-3 }, POSITIVE,
      .unit = "m", .doc = "Of the grains of sand, for friction_rise." },
    { .key = "inertial_number", REAL, AT(tobi_solid_def, inertial_number), .def = { 0.279 }, POSITIVE,
      .unit = "1",
      .doc = "Rate of shear times grain_diameter over sqrt(pressure/density of a grain) at which half of "
             "friction_rise is there." },
    { .key = "strength", REAL, AT(tobi_solid_def, strength), FROM(0), .unit = "Pa", .text = "none",
      .doc = "Tension at which a neo-hookean or corotated solid begins to crack, force over area at the "
             "start; it needs a fracture_energy." },
    { .key = "fracture_energy", REAL, AT(tobi_solid_def, fracture_energy), FROM(0), .unit = "J/m2",
      .text = "none",
      .doc = "Energy that a crack takes per area; cells must be smaller than 4/3 youngs_modulus x "
             "fracture_energy/strength^2, and at least 1.2 fracture_energy/strength for all of it." },
    { .key = "cut_friction", REAL, AT(tobi_solid_def, cut_friction), .def = { 0.3 }, FROM(0), .unit = "1",
      .doc = "Coulomb friction between the faces of what a blade has cut." },
    { .key = "bonded", BOOL, AT(tobi_solid_def, bonded), .def = { 1 },
      .doc = "Whether it sticks to the other bonded solids that it touches; one that is not meets all "
             "others with contact and friction." },
    { .key = "surface_friction", REAL, AT(tobi_solid_def, surface_friction), .def = { 0.3 }, FROM(0),
      .unit = "1",
      .doc = "Coulomb friction where it meets solids that it is not bonded to; of two the square root "
             "of the product counts, and liquids have none." },
    { .key = "damping", REAL, AT(tobi_solid_def, damping), FROM(0), .unit = "1/s", .text = "none",
      .doc = "Its velocities decay like exp(-damping t); brings a solid to rest." },
    { .key = "seeding", CHOICE("regular|blue-noise", 2), AT(tobi_solid_def, seeding),
      .doc = "Whether its particles start on a lattice, or scattered at even distances." },
    { .key = "color", COLOR, AT(tobi_solid_def, color), .text = "speed",
      .doc = "Colour in pictures, red, green and blue; speed shows how fast the solid is." },
    { .key = "core_color", COLOR, AT(tobi_solid_def, core_color), .text = "color",
      .doc = "Colour in pictures of what lay deeper than 1.75 spacings below the surface of its region "
             "at the start: an apple is red outside and cream where it is cut." },
    { .key = "visible", BOOL, AT(tobi_solid_def, visible), .def = { 1 },
      .doc = "Whether pictures show the solid." },
    { 0 }
};

static const tobi_param fluid_rows[] = {
    { .key = "name", TEXT, AT(tobi_fluid_def, name), .unit = "name", .text = "fluid",
      .required = true, .doc = "Name of the fluid, used once in a scene." },
    { .key = "density", REAL, AT(tobi_fluid_def, density), .def = { 1000 }, POSITIVE,
      .unit = "kg/m3", .doc = "Rest density." },
    { .key = "viscosity", REAL, AT(tobi_fluid_def, viscosity), .def = { 1.0e-3 }, FROM(0),
      .unit = "Pa s", .doc = "Dynamic viscosity; water at 20 degrees C has 1.0e-3." },
    { .key = "surface_tension", REAL, AT(tobi_fluid_def, surface_tension), FROM(0), .unit = "N/m",
      .text = "none",
      .doc = "Tension of the free surface; water at 20 degrees C has 0.0728. It wants a support of "
             "2.5 to 3." },
    { .key = "color", COLOR, AT(tobi_fluid_def, color), .text = "speed",
      .doc = "Colour in pictures, red, green and blue; speed shows how fast the fluid is." },
    { .key = "visible", BOOL, AT(tobi_fluid_def, visible), .def = { 1 },
      .doc = "Whether pictures show the fluid." },
    { 0 }
};

static const tobi_param fill_rows[] = {
    { .key = "box.min", VEC3, AT(tobi_fill_def, box_min), ANY, .unit = "m",
      .doc = "Lower corner of the filled box; a box has both corners." },
    { .key = "box.max", VEC3, AT(tobi_fill_def, box_max), ANY, .unit = "m",
      .doc = "Upper corner of the filled box." },
    { .key = "sphere.centre", VEC3, AT(tobi_fill_def, centre), ANY, .unit = "m",
      .doc = "Centre of a sphere, in 2-D a disc, instead of a box." },
    { .key = "sphere.radius", REAL, AT(tobi_fill_def, radius), FROM(0), .unit = "m",
      .doc = "Its radius." },
    { .key = "mesh", TEXT, AT(tobi_fill_def, mesh), .unit = "path",
      .doc = "A closed mesh (OBJ, STL or PLY) whose inside is filled, instead of a box." },
    { .key = "scale", VEC3, AT(tobi_fill_def, scale), .def = { 1, 1, 1 }, POSITIVE, .unit = "1",
      .doc = "Size factor of the mesh, one number or one per axis, applied first." },
    { .key = "translation", VEC3, AT(tobi_fill_def, translation), ANY, .unit = "m",
      .doc = "Where the origin of the mesh is put." },
    { .key = "rotation.axis", VEC3, AT(tobi_fill_def, rotation_axis), .def = { 0, 0, 1 }, ANY,
      .unit = "1", .doc = "Direction that the mesh is turned about, after the scale." },
    { .key = "rotation.angle", REAL, AT(tobi_fill_def, rotation_angle), ANY, .unit = "degrees",
      .doc = "Angle of that turn, by the right-hand rule." },
    { .key = "velocity", VEC3, AT(tobi_fill_def, velocity), ANY, .unit = "m/s",
      .doc = "Velocity at the start." },
    { .key = "spin", VEC3, AT(tobi_fill_def, spin), ANY, .unit = "rad/s",
      .doc = "Angular velocity at the start, about the middle of the region." },
    { 0 }
};

static const tobi_param body_rows[] = {
    { .key = "name", TEXT, AT(tobi_body_def, name), .unit = "name", .text = "body",
      .required = true,
      .doc = "Name of the body, used once in a scene and in the names of its files." },
    { .key = "mesh", TEXT, AT(tobi_body_def, mesh), .unit = "path",
      .doc = "The body's closed surface (OBJ, STL or PLY); a body has either a mesh or a box." },
    { .key = "box.min", VEC3, AT(tobi_body_def, box_min), ANY, .unit = "m",
      .doc = "Lower corner of a plain box, instead of a mesh." },
    { .key = "box.max", VEC3, AT(tobi_body_def, box_max), ANY, .unit = "m",
      .doc = "Upper corner of the box; scale, rotation and translation apply to it as to a mesh." },
    { .key = "scale", VEC3, AT(tobi_body_def, scale), .def = { 1, 1, 1 }, POSITIVE, .unit = "1",
      .doc = "Size factor, one number or one per axis, about the mesh's own origin, applied "
             "first." },
    { .key = "rotation.axis", VEC3, AT(tobi_body_def, rotation_axis), .def = { 0, 0, 1 }, ANY,
      .unit = "1", .doc = "Direction that the mesh is turned about, applied second." },
    { .key = "rotation.angle", REAL, AT(tobi_body_def, rotation_angle), ANY, .unit = "degrees",
      .doc = "Angle of that turn, by the right-hand rule." },
    { .key = "translation", VEC3, AT(tobi_body_def, translation), ANY, .unit = "m",
      .doc = "Where the origin of the mesh is put, applied last." },
    { .key = "density", REAL, AT(tobi_body_def, density), .def = { 1000 }, POSITIVE,
      .unit = "kg/m3", .doc = "Density of the body, for its mass and inertia." },
    { .key = "spacing", REAL, AT(tobi_body_def, spacing), FROM(0), .unit = "m", .text = "fluid",
      .doc = "Distance between the body's own particles, whatever the fluid's; fluid takes that of "
             "the fluid." },
    { .key = "friction", CHOICE("slip|no-slip", 2), AT(tobi_body_def, friction),
      .doc = "Whether the fluid slips along the body or sticks to it, rubbing as a turbulent layer where the "
             "spacing is too coarse for the layer at the surface." },
    { .key = "contact_angle", REAL, AT(tobi_body_def, contact_angle), .def = { 90 },
      RANGE(10, 170), .unit = "degrees",
      .doc = "Angle, measured in the liquid, at which a surface with tension meets the body." },
    { .key = "visible", BOOL, AT(tobi_body_def, visible), .def = { 1 },
      .doc = "Whether pictures show the body." },
    { .key = "color", COLOR, AT(tobi_body_def, color), .text = "automatic",
      .doc = "Colour in pictures, red, green and blue; automatic goes by the number of the body." },
    { .key = "dynamics", CHOICE("prescribed|free|controlled", 3), AT(tobi_body_def, dynamics),
      .doc = "What moves the body: its motion, if it has one; the forces on it; or these and its control "
             "program." },
    { .key = "mass", REAL, AT(tobi_body_def, mass), POSITIVE, .unit = "kg", .text = "by density",
      .doc = "Mass, per metre of depth in 2-D; by density takes density times the volume of the mesh." },
    { .key = "inertia", VEC3, AT(tobi_body_def, inertia), FROM(0), .unit = "kg m2", .text = "mesh",
      .doc = "Entries xx, yy, zz of the inertia matrix about the centre of mass, in the axes of the domain "
             "as the body starts; no principal moment may be larger than the sum of the other two. mesh "
             "takes that of the mesh, for the mass it has." },
    { .key = "inertia_products", VEC3, AT(tobi_body_def, inertia_products), ANY, .unit = "kg m2",
      .doc = "Entries xy, xz, yz of a given inertia matrix." },
    { .key = "velocity", VEC3, AT(tobi_body_def, velocity), ANY, .unit = "m/s",
      .doc = "Velocity of the centre of mass of a free or controlled body at the start." },
    { .key = "angular_velocity", VEC3, AT(tobi_body_def, angular_velocity), ANY, .unit = "rad/s",
      .doc = "Its angular velocity at the start." },
    { .key = "force", VEC3, AT(tobi_body_def, force), ANY, .unit = "N",
      .doc = "Constant force on its centre of mass, besides gravity." },
    { .key = "torque", VEC3, AT(tobi_body_def, torque), ANY, .unit = "N m",
      .doc = "Constant torque on it." },
    { .key = "air_resistance", REAL, AT(tobi_body_def, air_resistance), FROM(0), .unit = "1/s",
      .text = "none", .doc = "Its velocity and its angular momentum decay like exp(-air_resistance t)." },
    { .key = "restitution", REAL, AT(tobi_body_def, restitution), RANGE(0, 1), .unit = "1",
      .doc = "Speed after over speed before a collision; of two bodies the larger value counts, against a "
             "side of the domain, a plane or a solid of mlsmpm the body's alone." },
    { .key = "friction_coefficient", REAL, AT(tobi_body_def, friction_coefficient), .def = { 0.5 }, FROM(0),
      .unit = "1",
      .doc = "Coulomb friction; of two bodies, and of a body with a separate plane, the square root of the "
             "product counts, against a side of the domain or a solid of mlsmpm the body's alone." },
    { .key = "blade", BOOL, AT(tobi_body_def, blade),
      .doc = "Whether the body's edge cuts solids of mlsmpm; what is cut stays cut." },
    { .key = "edge_resistance", REAL, AT(tobi_body_def, edge_resistance), FROM(0), .unit = "J/m2",
      .doc = "Energy that the edge of a blade takes for each square metre that it cuts; apple 250." },
    { .key = "edge_angle", REAL, AT(tobi_body_def, edge_angle), .def = { 60 }, RANGE(1, 120),
      .unit = "degrees",
      .doc = "The edge of a blade is where its faces meet at this angle or a sharper one; a rounding or flat "
             "up to a quarter of the blade's mean thickness counts as the edge." },
    { .key = "edge_start", VEC3, AT(tobi_body_def, edge_start), ANY, .unit = "m",
      .doc = "One end of a straight edge that cuts in every direction, as the body starts, instead of the "
             "edge found in the mesh: for a wire. In 2-D the edge is this point." },
    { .key = "edge_end", VEC3, AT(tobi_body_def, edge_end), ANY, .unit = "m",
      .doc = "The other end of that edge." },
    { .key = "locked", TEXT, AT(tobi_body_def, locked), .unit = "text",
      .doc = "Axes along which (x, y, z or shift for all) or about which (turn_x, turn_y, turn_z or turn) a "
             "free or controlled body does not move, with commas between: \"x,y,turn\"." },
    { 0 }
};

static const tobi_param plane_rows[] = {
    { .key = "point", VEC3, AT(tobi_plane_def, point), ANY, .unit = "m", .required = true,
      .doc = "Any point of the plane, in the domain." },
    { .key = "normal", VEC3, AT(tobi_plane_def, normal), ANY, .unit = "1", .required = true,
      .doc = "Direction out of the plane, of any length; what lies behind is closed to solids and bodies." },
    { .key = "kind", CHOICE("separate|slip|no-slip", 3), AT(tobi_plane_def, kind),
      .doc = "What solids may do at it: separate and slide with friction, slip along it, stick to it. Bodies "
             "always separate; slip is without friction for them, no-slip has theirs." },
    { .key = "friction", REAL, AT(tobi_plane_def, friction), FROM(0), .unit = "1", .text = "none",
      .doc = "Coulomb friction of a \"separate\" plane; with a body the square root of the product counts." },
    { 0 }
};

static const tobi_param probe_rows[] = {
    { .key = "name", TEXT, AT(tobi_probe_def, name), .unit = "name", .text = "probe", .required = true,
      .doc = "Name of the probe, used once in a scene and in the columns of probes.csv." },
    { .key = "kind", CHOICE("point|level", 2), AT(tobi_probe_def, kind),
      .doc = "A point measures pressure and velocity, a level the height of the surface above or below it." },
    { .key = "position", VEC3, AT(tobi_probe_def, position), ANY, .unit = "m", .required = true,
      .doc = "Where it sits; for a level any point of its plumb line." },
    { 0 }
};

static const tobi_param output_rows[] = {
    { .key = "interval", REAL, AT(tobi_output_def, interval), .def = { 0.01 }, POSITIVE,
      .unit = "s", .doc = "Simulated time between outputs, hit exactly." },
    { .key = "checkpoint_interval", REAL, AT(tobi_output_def, checkpoint_interval), FROM(0),
      .unit = "s", .text = "end",
      .doc = "Simulated time between checkpoints; end writes one when the run ends." },
    { .key = "probe_interval", REAL, AT(tobi_output_def, probe_interval), FROM(0), .unit = "s",
      .text = "step", .doc = "Simulated time between rows of probes.csv, at least; step writes every step." },
    { .key = "compression", CHOICE("none|zlib|lz4|ascii", 4), AT(tobi_output_def, compression),
      .def = { TOBI_COMPRESS_ZLIB }, .doc = "Form of the VTU and VTP files." },
    { .key = "fields", TEXT, AT(tobi_output_def, fields), .unit = "names",
      .text = "usual",
      .doc = "Fields to write for every particle. usual, alone or among others, stands for velocity, "
             "pressure, density, object_id and particle_id, for mlsmpm von_mises and material too, where "
             "there is a blade piece and cut_side, and texture_coordinates if a solid's mesh has them." },
    { .key = "surfaces", BOOL, AT(tobi_output_def, surfaces), .def = { 1 },
      .doc = "Write the moving surface of each body as VTP and STL." },
    { .key = "frames", BOOL, AT(tobi_output_def, frames),
      .doc = "Write a PNG picture at each output." },
    { .key = "grid", BOOL, AT(tobi_output_def, grid),
      .doc = "Write the nodes of the grid of mlsmpm with velocity, mass and stress." },
    { .key = "ply", BOOL, AT(tobi_output_def, ply),
      .doc = "Write the positions of the fluid's particles as PLY, for other programs." },
    { .key = "obj", BOOL, AT(tobi_output_def, obj),
      .doc = "Write the moving surface of each body as OBJ, for other programs." },
    { .key = "camera.position", VEC3, AT(tobi_output_def, camera_position), ANY, .unit = "m",
      .doc = "Where the pictures of a 3-D scene are taken from, if camera.angle is given." },
    { .key = "camera.look_at", VEC3, AT(tobi_output_def, camera_look_at), ANY, .unit = "m",
      .doc = "The point in the middle of the pictures." },
    { .key = "camera.angle", REAL, AT(tobi_output_def, camera_angle), RANGE(0, 150),
      .unit = "degrees", .text = "fit",
      .doc = "Vertical field of view; fit shows the whole domain from where it looks best." },
    { 0 }
};

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
      .doc = "Name of the probe, for a column of probes.csv: pressure, velocity_x .. z or level." },
    { .key = "x", TEXT, AT(tobi_reference_def, x), .unit = "text", .text = "time",
      .doc = "Column of the file with the times." },
    { .key = "y", TEXT, AT(tobi_reference_def, y), .unit = "text",
      .doc = "Column of the file with the values; without it the one that is named like column." },
    { .key = "x_scale", REAL, AT(tobi_reference_def, x_scale), .def = { 1 }, POSITIVE, .unit = "1",
      .doc = "Factor that turns x into seconds of the run." },
    { .key = "y_scale", REAL, AT(tobi_reference_def, y_scale), .def = { 1 }, ANY, .unit = "1",
      .doc = "Factor that turns y into the unit of column." },
    { .key = "label", TEXT, AT(tobi_reference_def, label), .unit = "text",
      .doc = "Name in the picture, such as the publication; without it the name of the file." },
    { 0 }
};

const tobi_param_table tobi_world_table = {
    "world", "The box, the fluid resolution and the clock: keys at the top of a scene.",
    sizeof(tobi_world_def), world_rows };
const tobi_param_table tobi_dfsph_table = {
    "dfsph", "Divergence-free SPH (Bender & Koschier 2015, 2017) for incompressible liquids.",
    sizeof(tobi_dfsph_def), dfsph_rows };
const tobi_param_table tobi_wcsph_table = {
    "wcsph", "Weakly compressible SPH: pressure from density by the Tait equation, no solver.",
    sizeof(tobi_wcsph_def), wcsph_rows };
const tobi_param_table tobi_mlsmpm_table = {
    "mlsmpm", "The material point method (MLS-MPM, Hu et al. 2018) for solids that deform, sand, snow.",
    sizeof(tobi_mlsmpm_def), mlsmpm_rows };
const tobi_param_table tobi_solid_table = {
    "solid", "An entry of solids: one material of the method mlsmpm.", sizeof(tobi_solid_def),
    solid_rows };
const tobi_param_table tobi_fluid_table = {
    "fluid", "An entry of fluids: one material.", sizeof(tobi_fluid_def), fluid_rows };
const tobi_param_table tobi_fill_table = {
    "fill", "An entry of fill: one region that a fluid or solid fills at the start: box, sphere or mesh.",
    sizeof(tobi_fill_def), fill_rows };
const tobi_param_table tobi_body_table = {
    "body", "An entry of bodies: the inside of a closed mesh, at rest or moved by a motion.",
    sizeof(tobi_body_def), body_rows };
const tobi_param_table tobi_plane_table = {
    "plane", "An entry of planes: a fixed plane in the domain, for solids of mlsmpm and for bodies.",
    sizeof(tobi_plane_def), plane_rows };
const tobi_param_table tobi_probe_table = {
    "probe", "An entry of probes: a sensor in the domain.", sizeof(tobi_probe_def), probe_rows };
const tobi_param_table tobi_output_table = {
    "output", "The files of a run.", sizeof(tobi_output_def), output_rows };
const tobi_param_table tobi_reference_table = {
    "reference", "An entry of references: data that `tobiuo plot` draws beside the run's.",
    sizeof(tobi_reference_def), reference_rows };

static const tobi_param_table *const methods[] = { &tobi_dfsph_table, &tobi_wcsph_table,
                                                 &tobi_mlsmpm_table };
enum { METHOD_COUNT = sizeof methods / sizeof methods[0] };

const tobi_param_table *tobi_param_table_at(int index)
{
    static const tobi_param_table *const tables[] = {
        &tobi_world_table, &tobi_dfsph_table,  &tobi_wcsph_table, &tobi_mlsmpm_table,
        &tobi_fluid_table, &tobi_solid_table,  &tobi_fill_table,  &tobi_body_table,
        &tobi_plane_table, &tobi_probe_table,  &tobi_output_table, &tobi_reference_table
    };
    return index >= 0 && index < (int)(sizeof tables / sizeof tables[0]) ? tables[index] : NULL;
}

const char *tobi_method_name(int index)
{
    return index >= 0 && index < METHOD_COUNT ? methods[index]->name : NULL;
}

const tobi_param_table *tobi_method_table(const char *method)
{
    for (int i = 0; method && i < METHOD_COUNT; i++)
        if (strcmp(methods[i]->name, method) == 0) return methods[i];
    return NULL;
}

const char *tobi_choice_word(const char *choices, int i, int *length)
{
    for (const char *word = choices; word; i--) {
        const char *bar = strchr(word, '|');
        *length = (int)(bar ? (size_t)(bar - word) : strlen(word));
        if (i == 0) return word;
        word = bar ? bar + 1 : NULL;
    }
    return NULL;
}

/* Material constants and who reads them; rows of the solid table that are not here belong to all. */
static const struct { const char *key; uint32_t models; } constants[] = {
#define OF(model) (UINT32_C(1) << (model))
#define ELASTIC ~(OF(TOBI_LIQUID) | OF(TOBI_STATIONARY))
#define BREAKABLE (OF(TOBI_NEO_HOOKEAN) | OF(TOBI_COROTATED))
    { "youngs_modulus", ELASTIC },          { "poissons_ratio", ELASTIC },
    { "bulk_modulus", OF(TOBI_LIQUID) },    { "viscosity", OF(TOBI_LIQUID) },
    { "yield_stress", OF(TOBI_VON_MISES) }, { "hardening", OF(TOBI_VON_MISES) | OF(TOBI_SNOW) },
    { "critical_compression", OF(TOBI_SNOW) }, { "critical_stretch", OF(TOBI_SNOW) },
    { "friction_angle", OF(TOBI_SAND) | BREAKABLE }, { "friction_rise", OF(TOBI_SAND) },
    { "grain_diameter", OF(TOBI_SAND) },    { "inertial_number", OF(TOBI_SAND) },
    { "strength", BREAKABLE },              { "fracture_energy", BREAKABLE },
    { "damping", ~OF(TOBI_STATIONARY) },
    { "cut_friction", ~(OF(TOBI_STATIONARY) | OF(TOBI_LIQUID) | OF(TOBI_SAND)) },
    { "surface_friction", ~OF(TOBI_LIQUID) },
#undef BREAKABLE
#undef ELASTIC
};
enum { CONSTANT_COUNT = sizeof constants/sizeof constants[0] };

int tobi_solid_uses(int model, const char *key)
{
    for (int k = 0; k < CONSTANT_COUNT; k++)
        if (strcmp(constants[k].key, key) == 0) return (constants[k].models & OF(model)) != 0;
    return 1;
}

void tobi_solid_list(int model, char *text, size_t size)
{
    size_t used = (size_t)snprintf(text, size, "density or mass");
    for (int k = 0; k < CONSTANT_COUNT && used < size; k++)
        if (constants[k].models & OF(model))
            used += (size_t)snprintf(text + used, size - used, ", %s", constants[k].key);
}
#undef OF

int tobi_choice_count(const char *choices)
{
    int count = 1;
    for (const char *c = choices; *c; c++) count += *c == '|';
    return count;
}

#define DEFAULT(noun)                                        \
    tobi_##noun##_def tobi_default_##noun##_def(void)        \
    {                                                        \
        tobi_##noun##_def def;                               \
        tobi_param_defaults(&tobi_##noun##_table, &def);     \
        return def;                                          \
    }
DEFAULT(world)
DEFAULT(dfsph)
DEFAULT(wcsph)
DEFAULT(mlsmpm)
DEFAULT(fluid)
DEFAULT(solid)
DEFAULT(fill)
DEFAULT(body)
DEFAULT(plane)
DEFAULT(probe)
DEFAULT(output)
DEFAULT(reference)
