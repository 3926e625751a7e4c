/* The world's parameters, and the list of all tables: one per definition struct. A member that is missing in
   it cannot be set by a scene, has no default and appears in no help text; a unit test checks that the tables
   cover the structs. */
#include "base/param_rows.h"
#include "mpm/mlsmpm.h"
#include "sph/dfsph.h"
#include "sph/isph/isph.h"
#include "sph/wcsph.h"
#include "tobiuo/tobiuo.h"
#include "world/methods.h"

#define WALL(key_, member_, axis_, doc_)                                              \
    { .key = key_, CHOICE("slip|no-slip|periodic|separate|open", 5),                                \
      .offset = offsetof(tobi_world_def, member_) + (axis_)*sizeof(int), .doc = doc_ }

#define WALL_VELOCITY(key_, member_, axis_, doc_)                                     \
    { .key = key_, VEC3, SPEED, .unit = "m/s",                                          \
      .offset = offsetof(tobi_world_def, member_) + (axis_)*3*sizeof(double),         \
      .doc = doc_ " Velocity along itself of a no-slip side: a lid, a belt." }

static const tobi_param world_rows[] = {
    { .key = "method", TEXT, AT(tobi_world_def, method), .unit = "method", .text = "dfsph",
      .doc = "The method that moves the particles." },
    { .key = "dimension", INT, AT(tobi_world_def, dimension), .def = { 3 }, RANGE(2, 3),
      .unit = "1",
      .doc = "3, or 2 for a flow in the x-y plane with masses and forces per metre of depth." },
    { .key = "domain.min", VEC3, AT(tobi_world_def, domain_min), PLACE, .unit = "m",
      .required = true, .doc = "Lower corner of the box that holds everything, of any sign." },
    { .key = "domain.max", VEC3, AT(tobi_world_def, domain_max), PLACE, .unit = "m",
      .required = true, .doc = "Upper corner of the box." },
    WALL("domain.walls.x[0]", wall_min, 0, "Side at the lower x; open lets the particles of mlsmpm out."),
    WALL("domain.walls.x[1]", wall_max, 0, "Side at the upper x; periodic comes in pairs. Liquid goes "
         "through, bodies and solids do not."),
    WALL("domain.walls.y[0]", wall_min, 1, "Side at the lower y."),
    WALL("domain.walls.y[1]", wall_max, 1, "Side at the upper y."),
    WALL("domain.walls.z[0]", wall_min, 2, "Side at the lower z."),
    WALL("domain.walls.z[1]", wall_max, 2, "Side at the upper z."),
    { .key = "domain.contact_angle", REAL, AT(tobi_world_def, contact_angle), .def = { 90 },
      RANGE(10, 170), .unit = "degrees",
      .doc = "Angle, measured in the liquid, at which a surface with tension meets the sides." },
    { .key = "domain.friction", REAL, AT(tobi_world_def, friction), FRICTION, .unit = "1",
      .text = "none", .doc = "Coulomb friction between solids and the \"separate\" sides." },
    WALL_VELOCITY("domain.wall_velocity.x[0]", wall_velocity_min, 0, "The side at the lower x."),
    WALL_VELOCITY("domain.wall_velocity.x[1]", wall_velocity_max, 0, "The side at the upper x."),
    WALL_VELOCITY("domain.wall_velocity.y[0]", wall_velocity_min, 1, "The side at the lower y."),
    WALL_VELOCITY("domain.wall_velocity.y[1]", wall_velocity_max, 1, "The side at the upper y."),
    WALL_VELOCITY("domain.wall_velocity.z[0]", wall_velocity_min, 2, "The side at the lower z."),
    WALL_VELOCITY("domain.wall_velocity.z[1]", wall_velocity_max, 2, "The side at the upper z."),
    { .key = "gravity", VEC3, AT(tobi_world_def, gravity), .def = { 0, 0, -9.81 },
      RANGE(-1e6, 1e6), .unit = "m/s2",
      .doc = "Acceleration of gravity, in any direction; a 2-D scene that gives none gets [0, "
             "-9.81]." },
    { .key = "spacing", REAL, AT(tobi_world_def, spacing), LENGTHS, .unit = "m", .required = true,
      .doc = "Distance between fluid particles: the resolution. Where layers do not fit into the boxes of "
             "fluid, it gives way by up to 5 %, so that the particles hold the boxes' volume exactly." },
    { .key = "end_time", REAL, AT(tobi_world_def, end_time), RANGE(0, 1e9), .unit = "s", .required = true,
      .doc = "Simulated time at which the run ends; 0: the start alone." },
    { .key = "time_step", REAL, AT(tobi_world_def, time_step), DURATION, .unit = "s",
      .text = "adaptive",
      .doc = "A fixed time step, but that the last eight before an output fit it; adaptive chooses each "
             "step from speeds, forces and viscosity." },
    { .key = "time_step_max", REAL, AT(tobi_world_def, time_step_max), DURATION, .unit = "s",
      .text = "none", .doc = "Longest step that the adaptive choice may take." },
    { .key = "cfl", REAL, AT(tobi_world_def, cfl), .def = { 0.4 },
      RANGE(1e-4, 1), .unit = "1",
      .doc = "Largest part of a spacing that the fastest particle moves in one adaptive step of the "
             "SPH methods; mlsmpm has its own." },
    { .key = "speed_limit", REAL, AT(tobi_world_def, speed_limit),
      RANGE(1e-9, TOBI_SPEED_LIMIT), .unit = "m/s",
      .text = "automatic",
      .doc = "A particle faster than this stops the run as diverged. Automatic goes by what fall, bodies, "
             "inlets and pressures of outlets explain, and slows single particles beyond it." },
    { .key = "implicit_viscosity", BOOL, AT(tobi_world_def, implicit_viscosity),
      .doc = "Whether the viscosity of liquids is solved for, so that it sets no bound on the time step: for "
             "honey, mud and lava. A free surface then feels no stress, as it should." },
    { .key = "threads", INT, AT(tobi_world_def, threads), RANGE(0, 4096), .unit = "1",
      .text = "all", .doc = "Processor cores to use, all: as OMP_NUM_THREADS says, or else those of the "
             "machine; the result is the same for any number." },
    { 0 }
};

const tobi_param_table tobi_world_table = {
    "world", "The box, the fluid resolution and the clock: keys at the top of a scene.",
    sizeof(tobi_world_def), world_rows };

/* The world's, the methods', all others. */
const tobi_param_table *tobi_param_table_at(int index)
{
    static const tobi_param_table *const others[] = {
        &tobi_fluid_table, &tobi_interface_table, &tobi_solid_table, &tobi_fill_table, &tobi_body_table,
        &tobi_plane_table, &tobi_inlet_table, &tobi_outlet_table, &tobi_probe_table, &tobi_line_table,
        &tobi_joint_table, &tobi_output_table, &tobi_view_table, &tobi_reference_table, &tobi_gravity_table,
        &tobi_central_table, &tobi_damping_table, &tobi_porous_table, &tobi_nest_table,
        &tobi_scalar_table, &tobi_scalar_value_table
    };
    if (index == 0) return &tobi_world_table;
    for (int m = 0; index > 0 && tobi_method_at(m); m++)
        if (--index == 0) return tobi_method_at(m)->params;
    return index > 0 && index <= (int)(sizeof others/sizeof others[0]) ? others[index - 1] : NULL;
}

const char *tobi_method_name(int index)
{
    return tobi_method_at(index) ? tobi_method_at(index)->name : NULL;
}

int tobi_method_describe(const char *method, tobi_method_info *info)
{
    const tobi_method *m = tobi_method_find(method);
    if (info) *info = (tobi_method_info){ 0 };
    if (info && m) *info = (tobi_method_info){ m->name, m->doc, m->solids, m->planes, m->nodes != NULL };
    return m != NULL;
}

const tobi_param_table *tobi_method_table(const char *method)
{
    const tobi_method *m = tobi_method_find(method);
    return m ? m->params : NULL;
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
DEFAULT(isph)
DEFAULT(eisph)
DEFAULT(mlsmpm)
DEFAULT(fluid)
DEFAULT(solid)
DEFAULT(fill)
DEFAULT(body)
DEFAULT(plane)
DEFAULT(inlet)
DEFAULT(outlet)
DEFAULT(interface)
DEFAULT(probe)
DEFAULT(line)
DEFAULT(joint)
DEFAULT(output)
DEFAULT(reference)
DEFAULT(gravity)
DEFAULT(central)
DEFAULT(damping)
DEFAULT(porous)
DEFAULT(nest)
DEFAULT(scalar)
DEFAULT(scalar_value)
