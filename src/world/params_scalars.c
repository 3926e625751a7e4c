/* Parameters of temperature and concentration. */
#include "base/param_rows.h"
#include "base/param.h"

#define FIELDS "temperature|concentration"

static const tobi_param scalar_rows[] = {
    { .key = "field", CHOICE(FIELDS, 2), AT(tobi_scalar_def, field), .required = true,
      .doc = "temperature, in degrees Celsius, or concentration, in a unit of yours. Each is given once." },
    { .key = "value", REAL, AT(tobi_scalar_def, value), RANGE(-1e6, 1e6), .unit = "degC or yours",
      .doc = "Its value in all liquid at the start, and where liquids have the densities that they are "
             "given." },
    { .key = "diffusivity", REAL, AT(tobi_scalar_def, diffusivity), RANGE(0, 1e3), .unit = "m2/s",
      .doc = "How fast it spreads. Heat: conductivity/(density capacity), 1.4e-7 in water; salt 1.5e-9." },
    { .key = "expansion", REAL, AT(tobi_scalar_def, expansion), RANGE(-10, 10), .unit = "1/unit",
      .doc = "Share of its weight that liquid loses per unit above value: 2.1e-4 for water of 20 degC. Salt "
             "adds weight: it is below 0." },
    { .key = "capacity", REAL, AT(tobi_scalar_def, capacity), .def = { 1 }, RANGE(1e-6, 1e9),
      .unit = "J/(kg K)",
      .doc = "Heat capacity: 4182 for water. Then flows are in W. 1 for a concentration per mass: in kg/s." },
    { .key = "turbulent_number", REAL, AT(tobi_scalar_def, turbulent_number), .def = { 0.85 },
      RANGE(0.01, 100), .unit = "1",
      .doc = "Prandtl or Schmidt number of eddies below the spacing: their viscosity (smagorinsky of a "
             "fluid) over their diffusivity." },
    { .key = "thinning", REAL, AT(tobi_scalar_def, thinning), RANGE(-100, 100), .unit = "1/unit",
      .doc = "Viscosities of the liquids go as exp(-thinning (c - value)): 0.02 for water, some 0.1 for "
             "honey. Needs implicit_viscosity." },
    { 0 }
};

const tobi_param_table tobi_scalar_table = {
    "scalar", "Temperature or concentration, which liquids carry and which diffuses in them.",
    sizeof(tobi_scalar_def), scalar_rows };

static const tobi_param value_rows[] = {
    { .key = "field", CHOICE(FIELDS, 2), AT(tobi_scalar_value_def, field), .required = true,
      .doc = "Which of the scalars." },
    { .key = "name", TEXT, AT(tobi_scalar_value_def, name), .unit = "name",
      .doc = "Name in the columns of scalars.csv." },
    { .key = "box.min", VEC3, AT(tobi_scalar_value_def, box_min), PLACE, .unit = "m",
      .doc = "Liquid in this box starts with the value: lower corner." },
    { .key = "box.max", VEC3, AT(tobi_scalar_value_def, box_max), PLACE, .unit = "m",
      .doc = "Upper corner." },
    { .key = "fluid", TEXT, AT(tobi_scalar_value_def, fluid), .unit = "name",
      .doc = "Or this fluid starts with it." },
    { .key = "inlet", TEXT, AT(tobi_scalar_value_def, inlet), .unit = "name",
      .doc = "Or what this inlet lets in has it." },
    { .key = "side", CHOICE("none|x_min|x_max|y_min|y_max|z_min|z_max", 7),
      AT(tobi_scalar_value_def, side), .doc = "Or this side of the domain has the value or the flux." },
    { .key = "body", TEXT, AT(tobi_scalar_value_def, body), .unit = "name",
      .doc = "Or this body. Through other sides and bodies nothing passes." },
    { .key = "value", REAL, AT(tobi_scalar_value_def, value), .def = { TOBI_NO_VALUE }, RANGE(-1e6, 1e6),
      .unit = "degC or yours", .text = "none", .doc = "The value there." },
    { .key = "flux", REAL, AT(tobi_scalar_value_def, flux), RANGE(-1e12, 1e12), .unit = "W/m2",
      .doc = "Instead of it, of a side or body: what goes into the liquid per area." },
    { .key = "transfer", REAL, AT(tobi_scalar_value_def, transfer), RANGE(1e-12, 1e12), .unit = "W/(m2 K)",
      .text = "perfect", .doc = "Heat transfer between the value and the liquid on the side or body: through "
                                "a wall, or a layer. Perfect: liquid on it has the value." },
    { .key = "heat_capacity", REAL, AT(tobi_scalar_value_def, heat_capacity), RANGE(1e-12, 1e15),
      .unit = "J/K", .text = "unlimited",
      .doc = "Of all of the side or body, in 2-D per metre: its value begins as given and falls as heat "
             "leaves it. Unlimited: it keeps its value." },
    { .key = "power", REAL, AT(tobi_scalar_value_def, power), RANGE(-1e12, 1e12), .unit = "W",
      .doc = "Heat that a side or body with a heat capacity gets, as of a heater; in 2-D per metre." },
    { 0 }
};

const tobi_param_table tobi_scalar_value_table = {
    "scalar_value", "Where temperature or concentration is another: one of box, fluid, inlet, side and body.",
    sizeof(tobi_scalar_value_def), value_rows };
