/* Parameters of fluids, solids and the regions that they fill. */
#include "base/param_rows.h"
#include "base/param.h"
#include <stdio.h>
#include <string.h>

static const tobi_param fluid_rows[] = {
    { .key = "name", TEXT, AT(tobi_fluid_def, name), .unit = "name", .text = "fluid",
      .required = true, .doc = "Name of the fluid, used once in a scene." },
    { .key = "density", REAL, AT(tobi_fluid_def, density), .def = { 1000 }, DENSITY,
      .unit = "kg/m3", .doc = "Rest density." },
    { .key = "viscosity", REAL, AT(tobi_fluid_def, viscosity), .def = { 1.0e-3 }, RANGE(0, 1e9),
      .unit = "Pa s",
      .doc = "Dynamic viscosity; water at 20 degrees C has 1.0e-3. With a flow_index n it is the "
             "consistency, Pa s^n." },
    { .key = "yield_stress", REAL, AT(tobi_fluid_def, yield_stress), RANGE(0, 1e9), .unit = "Pa",
      .text = "none",
      .doc = "Stress below which the liquid does not flow: fresh concrete has some 500, ketchup 30. It wants "
             "implicit_viscosity." },
    { .key = "flow_index", REAL, AT(tobi_fluid_def, flow_index), .def = { 1 }, RANGE(0.1, 1.8), .unit = "1",
      .doc = "Power n of the shear rate in the shear stress; below 1 the liquid is thinner the faster it is "
             "sheared. Other than 1 it wants implicit_viscosity." },
    { .key = "creep_rate", REAL, AT(tobi_fluid_def, creep_rate), .def = { 0.01 }, RANGE(1e-6, 1e6),
      .positive = true, .unit = "1/s",
      .doc = "Shear rate below which the viscosity grows no more: so fast a liquid creeps under 0.7 of its "
             "yield stress." },
    { .key = "smagorinsky", REAL, AT(tobi_fluid_def, smagorinsky), RANGE(0, 0.3), .unit = "1",
      .text = "none",
      .doc = "Smagorinsky constant of turbulence below the spacing, 0.1 to 0.17 in most flows: the viscosity "
             "grows with the shear rate and the spacing squared. It wants implicit_viscosity; in 2-D it is "
             "no model of turbulence." },
    { .key = "surface_tension", REAL, AT(tobi_fluid_def, surface_tension), RANGE(0, 1e6), .unit = "N/m",
      .text = "none",
      .doc = "Tension of the free surface; water at 20 degrees C has 0.0728. It wants a support of "
             "3." },
    { .key = "color", COLOR, AT(tobi_fluid_def, color), .text = "speed",
      .doc = "Colour in pictures, red, green and blue; speed shows how fast the fluid is." },
    { .key = "visible", BOOL, AT(tobi_fluid_def, visible), .def = { 1 },
      .doc = "Whether pictures show the fluid." },
    { 0 }
};

const tobi_param_table tobi_fluid_table = {
    "fluid", "An entry of fluids: one material.", sizeof(tobi_fluid_def), fluid_rows };

static const tobi_param interface_rows[] = {
    { .key = "fluid", TEXT, AT(tobi_interface_def, fluid), .unit = "name", .required = true,
      .doc = "Name of the fluid on one side." },
    { .key = "to_fluid", TEXT, AT(tobi_interface_def, to_fluid), .unit = "name",
      .required = true, .doc = "Name of the fluid on the other." },
    { .key = "tension", REAL, AT(tobi_interface_def, tension), RANGE(0, 1e6), .unit = "N/m", .text = "none",
      .doc = "Tension of the interface; oil on water has some 0.03. It wants a support of 2.5 to 3." },
    { 0 }
};

const tobi_param_table tobi_interface_table = {
    "interface", "An entry of interfaces: the tension between two fluids.", sizeof(tobi_interface_def),
    interface_rows };

static const tobi_param fill_rows[] = {
    { .key = "box.min", VEC3, AT(tobi_fill_def, box_min), PLACE, .unit = "m",
      .doc = "Lower corner of the filled box; a box has both corners." },
    { .key = "box.max", VEC3, AT(tobi_fill_def, box_max), PLACE, .unit = "m",
      .doc = "Upper corner of the filled box." },
    { .key = "sphere.centre", VEC3, AT(tobi_fill_def, centre), PLACE, .unit = "m",
      .doc = "Centre of a sphere, in 2-D a disc, instead of a box." },
    { .key = "sphere.radius", REAL, AT(tobi_fill_def, radius), RANGE(0, 1e7), .unit = "m",
      .doc = "Its radius." },
    { .key = "mesh", TEXT, AT(tobi_fill_def, mesh), .unit = "path",
      .doc = "A closed mesh (OBJ, STL or PLY) whose inside is filled, instead of a box." },
    OUTLINE_ROWS(tobi_fill_def, outline),
    { .key = "vessel", TEXT, AT(tobi_fill_def, vessel), .unit = "name",
      .doc = "A body with \"vessel\": true that is filled up to level, instead of a box." },
    { .key = "level", REAL, AT(tobi_fill_def, level), PLACE, .unit = "m",
      .doc = "Where the surface of what fills the vessel lies: its coordinate upwards, against gravity." },
    { .key = "seed", VEC3, AT(tobi_fill_def, seed), .def = { -1e9, -1e9, -1e9 }, PLACE, .unit = "m",
      .text = "all",
      .doc = "A place in the one compartment of the vessel that is filled; all fills every one." },
    { .key = "scale", VEC3, AT(tobi_fill_def, scale), .def = { 1, 1, 1 }, FACTOR,
      .positive = true, .unit = "1",
      .doc = "Size factor of the mesh, one number or one per axis, applied first." },
    { .key = "translation", VEC3, AT(tobi_fill_def, translation), PLACE, .unit = "m",
      .doc = "Where the origin of the mesh is put." },
    { .key = "rotation.axis", VEC3, AT(tobi_fill_def, rotation_axis), .def = { 0, 0, 1 }, DIRECTION,
      .unit = "1", .doc = "Direction of the axis through the origin of the mesh that it is turned "
      "about, after the scale." },
    { .key = "rotation.angle", REAL, AT(tobi_fill_def, rotation_angle), ANGLE, .unit = "degrees",
      .doc = "Angle of that turn, by the right-hand rule." },
    { .key = "velocity", VEC3, AT(tobi_fill_def, velocity), SPEED, .unit = "m/s",
      .doc = "Velocity at the start." },
    { .key = "spin", VEC3, AT(tobi_fill_def, spin), SPEED, .unit = "rad/s",
      .doc = "Angular velocity at the start, about the middle of the region." },
    { 0 }
};

const tobi_param_table tobi_fill_table = {
    "fill", "An entry of fill: a region that is filled at the start: box, sphere, mesh, outline or "
    "vessel.",
    sizeof(tobi_fill_def), fill_rows };

static const tobi_param solid_rows[] = {
    { .key = "name", TEXT, AT(tobi_solid_def, name), .unit = "name", .text = "solid", .required = true,
      .doc = "Name of the solid, used once in a scene." },
    { .key = "model", CHOICE("neo-hookean|corotated|liquid|von-mises|snow|sand|stationary", 7),
      AT(tobi_solid_def, model), .doc = "What its stress depends on." },
    { .key = "density", REAL, AT(tobi_solid_def, density), .def = { 1000 }, DENSITY, .unit = "kg/m3",
      .doc = "Density at the start." },
    { .key = "mass", REAL, AT(tobi_solid_def, mass), MASS, .unit = "kg", .text = "by density",
      .doc = "Mass of all regions together, instead of a density; per metre of depth in 2-D." },
    { .key = "youngs_modulus", REAL, AT(tobi_solid_def, youngs_modulus), .def = { 1e6 }, STIFFNESS,
      .unit = "Pa", .doc = "Young's modulus of small strains; liquids have a bulk modulus instead." },
    { .key = "poissons_ratio", REAL, AT(tobi_solid_def, poissons_ratio), .def = { 0.3 },
      RANGE(-0.99, 0.495), .unit = "1", .doc = "Poisson's ratio of small strains." },
    { .key = "bulk_modulus", REAL, AT(tobi_solid_def, bulk_modulus), .def = { 1e5 }, STIFFNESS,
      .unit = "Pa",
      .doc = "Stiffness of a liquid: density times the square of the speed of sound; ten times the "
             "fastest flow keeps the density within 1 %." },
    { .key = "viscosity", REAL, AT(tobi_solid_def, viscosity), RANGE(0, 1e9), .unit = "Pa s",
      .text = "none", .doc = "Dynamic viscosity of a liquid." },
    { .key = "yield_stress", REAL, AT(tobi_solid_def, yield_stress), .def = { 1e4 }, STIFFNESS,
      .unit = "Pa", .doc = "Von Mises stress at which a von-mises solid begins to flow." },
    { .key = "hardening", REAL, AT(tobi_solid_def, hardening), RANGE(0, 1e15), .unit = "Pa or 1",
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
    { .key = "friction_rise", REAL, AT(tobi_solid_def, friction_rise), FRICTION, .unit = "1", .text = "none",
      .doc = "By how much the friction of sand rises above the tangent of friction_angle in fast flow, by "
             "the law mu(I); 0.26 for glass beads (Jop et al. 2006)." },
    { .key = "grain_diameter", REAL, AT(tobi_solid_def, grain_diameter), .def = { 1e-3 }, LENGTHS,
      .unit = "m", .doc = "Of the grains of sand, for friction_rise." },
    { .key = "inertial_number", REAL, AT(tobi_solid_def, inertial_number), .def = { 0.279 }, FACTOR,
      .unit = "1",
      .doc = "Rate of shear times grain_diameter over sqrt(pressure/density of a grain) at which half of "
             "friction_rise is there." },
    { .key = "strength", REAL, AT(tobi_solid_def, strength), STIFFNESS, .unit = "Pa", .text = "none",
      .doc = "Tension at which a neo-hookean or corotated solid begins to crack, force over area at the "
             "start; it needs a fracture_energy." },
    { .key = "fracture_energy", REAL, AT(tobi_solid_def, fracture_energy), RANGE(1e-9, 1e12), .unit = "J/m2",
      .text = "none",
      .doc = "Energy that a crack takes per area; cells must be smaller than 4/3 youngs_modulus x "
             "fracture_energy/strength^2, and at least 1.2 fracture_energy/strength for all of it." },
    { .key = "cut_friction", REAL, AT(tobi_solid_def, cut_friction), .def = { 0.3 }, FRICTION, .unit = "1",
      .doc = "Coulomb friction between the faces of what a blade has cut." },
    { .key = "bonded", BOOL, AT(tobi_solid_def, bonded), .def = { 1 },
      .doc = "Whether it sticks to the other bonded solids that it touches; one that is not meets all "
             "others with contact and friction." },
    { .key = "clamped_to", TEXT, AT(tobi_solid_def, clamped_to), .unit = "name or names",
      .doc = "Body or list of bodies that hold the solid: its particles that start in a body, or nearer than "
             "a spacing to it, go with it, and it feels their force. Of several bodies the first named "
             "holds a particle; one that it starts in goes before one that it is near." },
    { .key = "surface_friction", REAL, AT(tobi_solid_def, surface_friction), .def = { 0.3 }, FRICTION,
      .unit = "1",
      .doc = "Coulomb friction where it meets solids that it is not bonded to; of two the square root "
             "of the product counts, and liquids have none." },
    { .key = "liquid_friction", CHOICE("slip|no-slip", 2), AT(tobi_solid_def, liquid_friction),
      .doc = "Whether fluids in the same scene slip along it or stick to it." },
    { .key = "damping", REAL, AT(tobi_solid_def, damping), RANGE(0, 1e6), .unit = "1/s", .text = "none",
      .doc = "Its velocities decay like exp(-damping t); brings a solid to rest." },
    { .key = "seeding", CHOICE("regular|blue-noise", 2), AT(tobi_solid_def, seeding),
      .doc = "Whether its particles start on a lattice, or scattered at even distances." },
    { .key = "color", COLOR, AT(tobi_solid_def, color), .text = "speed",
      .doc = "Colour in pictures, red, green and blue; speed shows how fast the solid is, if no liquid "
             "is in the scene. Pieces that a blade or a crack has parted are tinted, faces of cuts paler." },
    { .key = "core_color", COLOR, AT(tobi_solid_def, core_color), .text = "color",
      .doc = "Colour in pictures of what lay deeper than 1.75 spacings below the surface of its region "
             "at the start, and of the faces of cuts: an apple is red outside and cream where it is cut." },
    { .key = "texture", TEXT, AT(tobi_solid_def, texture), .unit = "path",
      .doc = "A PNG or JPEG image on its skin in pictures; a mesh that fills it needs texture "
             "coordinates (vt of an OBJ file). Inside it has its core_color; in 2-D all of it has the "
             "image of the side that faces +z." },
    { .key = "visible", BOOL, AT(tobi_solid_def, visible), .def = { 1 },
      .doc = "Whether pictures show the solid." },
    { 0 }
};

const tobi_param_table tobi_solid_table = {
    "solid", "An entry of solids: one material of the method mlsmpm.", sizeof(tobi_solid_def),
    solid_rows };

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
    { "surface_friction", ~OF(TOBI_LIQUID) }, { "clamped_to", ~(OF(TOBI_LIQUID) | OF(TOBI_STATIONARY)) },
#undef BREAKABLE
#undef ELASTIC
};
enum { CONSTANT_COUNT = sizeof constants/sizeof constants[0] };

int tobi_solid_uses(int model, const char *key)
{
    for (int k = 0; key && k < CONSTANT_COUNT; k++)
        if (strcmp(constants[k].key, key) == 0) return (constants[k].models & OF(model)) != 0;
    return 1;
}

void tobi_solid_list(int model, char *text, size_t size)
{
    size_t used = text ? (size_t)snprintf(text, size, "density or mass") : size;
    for (int k = 0; k < CONSTANT_COUNT && used < size; k++)
        if (constants[k].models & OF(model))
            used += (size_t)snprintf(text + used, size - used, ", %s", constants[k].key);
}
#undef OF
