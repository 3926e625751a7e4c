/* joints.csv: of each joint between bodies the force and moment on its body, the angle or position and the
   gap, as often as the probes are read. Drawback: a mean over one step each, so that impacts scatter. */
#include "record/columns.h"
#include "record/record.h"
#include "world/world.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define V(name, unit, value, doc) { name, unit, 0 },
#define SOLID_V(name, unit, value, doc) { name, unit, 1 },
static const struct { const char *name, *unit; int solid; } values[] = { JOINT(V, SOLID_V) };
#undef V
#undef SOLID_V
enum { VALUES = sizeof values/sizeof *values };

/* In 2-D a joint has no force along z, and a moment about z alone. Motors and dampers some have. */
static int is_told(const tobi_run *run, const tobi_joint_info *i, int value)
{
    if (strcmp(values[value].name, "angle") == 0) return !i->slides;
    if (strcmp(values[value].name, "position") == 0) return i->slides;
    if (strcmp(values[value].name, "motor_torque") == 0) return i->has_motor && !i->slides;
    if (strcmp(values[value].name, "motor_force") == 0) return i->has_motor && i->slides;
    if (strcmp(values[value].name, "power") == 0) return i->has_power;
    if (strcmp(values[value].name, "work") == 0) return i->has_power;
    return !values[value].solid || run->world->sim.def.dimension == 3;
}

tobi_status tobi_joints_open(tobi_run *run, bool continued, tobi_error *err)
{
    enum { NAME = 128 };
    const int joints = tobi_world_joint_count(run->world);
    int count = 1;
    if (joints == 0) return TOBI_OK;
    tobi_csv_column *columns = calloc((size_t)joints*VALUES + 1, sizeof *columns);
    char (*names)[NAME] = calloc((size_t)joints*VALUES + 1, sizeof *names);
    tobi_status status = columns && names ? TOBI_OK : tobi_fail(err, TOBI_NO_MEMORY, "run: out of memory");
    for (int k = 0; status == TOBI_OK && k < joints; k++) {
        tobi_joint_info info;
        const char *name = tobi_world_joint(run->world, k, &info);
        for (int v = 0; v < VALUES; v++) {
            if (!is_told(run, &info, v)) continue;
            snprintf(names[count], NAME, "%s_%s", name, values[v].name);
            columns[count] = (tobi_csv_column){ names[count],
                tobi_run_unit(values[v].unit, run->world->sim.def.dimension) };
            count++;
        }
    }
    const double now = tobi_world_time(run->world);
    if (status == TOBI_OK) columns[0] = (tobi_csv_column){ "time", "s" };
    if (status == TOBI_OK)
        status = tobi_table_open(run, "joints.csv", continued, now, columns, count, &run->joints, err);
    free(columns);
    free(names);
    return status;
}

tobi_status tobi_joints_write(tobi_run *run, double before, tobi_error *err)
{
    const double now = tobi_world_time(run->world);
    if (!run->joints || !tobi_record_is_due(run->output.probe_interval, before, now)) return TOBI_OK;
    if (tobi_csv_is_gone(run->joints))
        TOBI_TRY(tobi_trouble_pass(run, TOBI_KIND_TABLES, run->outputs, tobi_record_keep_dir(run, err), err));
    tobi_csv_add_real(run->joints, now);
    for (int k = 0; k < tobi_world_joint_count(run->world); k++) {
        tobi_joint_info i;
        tobi_world_joint(run->world, k, &i);
#define V(name, unit, value, doc) value,
        const double row[VALUES] = { JOINT(V, V) };
#undef V
        for (int v = 0; v < VALUES; v++)
            if (is_told(run, &i, v)) tobi_csv_add_real(run->joints, row[v]);
    }
    return tobi_trouble_pass(run, TOBI_KIND_TABLES, run->outputs, tobi_csv_end_row(run->joints, err), err);
}
