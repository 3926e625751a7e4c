/* The grammar as a list of rows. Drawback: what depends on two parts at once is checked elsewhere
   (scene/check.c). */
#include "scene/parts.h"
#include "scene/controls.h"
#include "base/param.h"
#include <assert.h>
#include <string.h>

static const tobi_part parts[] = {
    { "world", "fluids", TOBI_PART_LIST, &tobi_fluid_table, 0, TOBI_FLUID_LIMIT,
      "The fluids of the methods dfsph, wcsph, isph and eisph, which need at least one." },
    { "world", "interfaces", TOBI_PART_LIST, &tobi_interface_table, 0, TOBI_INTERFACE_LIMIT,
      "Tensions between fluids, if any." },
    { "world", "solids", TOBI_PART_LIST, &tobi_solid_table, 0, TOBI_SOLID_LIMIT,
      "The solids, sands, snows and liquids of the method mlsmpm." },
    { "world", "bodies", TOBI_PART_LIST, &tobi_body_table, 0, TOBI_BODY_LIMIT,
      "The bodies, if any." },
    { "world", "planes", TOBI_PART_LIST, &tobi_plane_table, 0, TOBI_PLANE_LIMIT,
      "Fixed planes in the domain of mlsmpm, beside its sides, if any." },
    { "world", "inlets", TOBI_PART_LIST, &tobi_inlet_table, 0, TOBI_INLET_LIMIT,
      "Where liquid comes in, if anywhere." },
    { "world", "outlets", TOBI_PART_LIST, &tobi_outlet_table, 0, TOBI_OUTLET_LIMIT,
      "Where liquid goes out, if anywhere." },
    { "world", "lines", TOBI_PART_LIST, &tobi_line_table, 0, TOBI_LINE_LIMIT,
      "Springs, ropes and mooring lines of free bodies, if any." },
    { "world", "joints", TOBI_PART_LIST, &tobi_joint_table, 0, TOBI_JOINT_LIMIT,
      "Hinges, slides and ball joints between two bodies, if any." },
    { "world", "probes", TOBI_PART_LIST, &tobi_probe_table, 0, TOBI_PROBE_LIMIT,
      "The sensors, if any." },
    { "world", "references", TOBI_PART_LIST, &tobi_reference_table, 0, 64,
      "Data that `tobiuo plot` draws beside the run's, if any." },
    { "world", "gravity_in_time", TOBI_PART_OBJECT, &tobi_gravity_table, 0, 0,
      "Gravity that changes with time." },
    { "world", "central_force", TOBI_PART_OBJECT, &tobi_central_table, 0, 0,
      "A force towards a place, if any." },
    { "world", "damping_zones", TOBI_PART_LIST, &tobi_damping_table, 0, 16,
      "Where liquids are damped, if anywhere: beaches." },
    { "world", "porous_zones", TOBI_PART_LIST, &tobi_porous_table, 0, TOBI_POROUS_LIMIT,
      "Where stones, stems or screens resist liquids, if anywhere." },
    { "world", "nests", TOBI_PART_LIST, &tobi_nest_table, 0, TOBI_NEST_LIMIT,
      "Boxes in which liquid is computed again with a smaller spacing, if any." },
    { "world", "scalars", TOBI_PART_LIST, &tobi_scalar_table, 0, TOBI_SCALAR_LIMIT,
      "Temperature and concentration of the liquids, if any." },
    { "world", "scalar_values", TOBI_PART_LIST, &tobi_scalar_value_table, 0, TOBI_SCALAR_VALUE_LIMIT,
      "Where they have other values: at the start, at walls, bodies and inlets." },
    { "world", "frame", TOBI_PART_MOTION, NULL, 0, 0,
      "How the tank moves that all is seen from: one motion, or a list of them, as of a body." },
    { "world", "output", TOBI_PART_OBJECT, &tobi_output_table, 0, 0, "The files of a run." },
    { "output", "views", TOBI_PART_LIST, &tobi_view_table, 0, TOBI_VIEW_LIMIT,
      "Further pictures of each output, frames/NAME_000000.png." },
    { "world", "$schema", TOBI_PART_EDITOR, NULL, 0, 0,
      "Where an editor finds the JSON Schema of scenes; Tobiuo passes over it." },
    { "fluid", "fill", TOBI_PART_LIST, &tobi_fill_table, 0, TOBI_FILL_LIMIT,
      "The regions that the fluid fills at the start; needed unless inlets let it in." },
    { "solid", "fill", TOBI_PART_LIST, &tobi_fill_table, 1, TOBI_FILL_LIMIT,
      "The regions that the solid fills at the start." },
    { "fill", "flow", TOBI_PART_OBJECT, &tobi_flow_table, 0, 0,
      "How what fills the region moves at the start, from place to place." },
    { "body", "motion", TOBI_PART_MOTION, NULL, 0, 0,
      "How the body moves: one kind, or a list of them; without it the body is fixed." },
    { "body", "control", TOBI_PART_OBJECT, &tobi_control_table, 0, 0,
      "The program of a controlled body." },
    { "control", "params", TOBI_PART_FREE, NULL, 0, 0,
      "Any values, handed to the script as its global table `params`." },
    { "flow", "params", TOBI_PART_FREE, NULL, 0, 0,
      "Any values, handed to the script as its global table `params`." },
    { "script", "params", TOBI_PART_FREE, NULL, 0, 0,
      "Any values, handed to the script as its global table `params`." }
};
enum { FIXED = sizeof parts / sizeof parts[0] };

bool tobi_part_at(int index, tobi_part *part)
{
    if (index < 0) return false;
    if (index < FIXED) {
        *part = parts[index];
        return true;
    }
    const char *method = tobi_method_name(index - FIXED);
    if (!method) return false;
    const tobi_param_table *table = tobi_method_table(method);
    *part = (tobi_part){ "world", method, TOBI_PART_OBJECT, table, 0, 0, table->doc };
    return true;
}

tobi_part tobi_part_find(const char *owner, const char *key)
{
    tobi_part part = { 0 };
    for (int i = 0; tobi_part_at(i, &part); i++)
        if (strcmp(part.owner, owner) == 0 && strcmp(part.key, key) == 0) return part;
    assert(!"no such part");
    return part;
}

void tobi_part_keys(const char *owner, const char *keys[TOBI_PARTS])
{
    tobi_part part;
    int count = 0;
    for (int i = 0; tobi_part_at(i, &part); i++)
        if (strcmp(part.owner, owner) == 0 && count < TOBI_PARTS - 1) keys[count++] = part.key;
    keys[count] = NULL;
}
