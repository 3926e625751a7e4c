/* porous_zones.csv: of each porous zone of the scene force, power, work and liquid, as often as the probes
   are read. */
#include "record/columns.h"
#include "record/record.h"
#include "world/world.h"
#include <stdio.h>
#include <stdlib.h>

#define V(name, unit, value, doc) { name, unit },
static const tobi_csv_column values[] = { POROUS(V) };
#undef V
enum { VALUES = sizeof values/sizeof *values };

tobi_status tobi_porous_open(tobi_run *run, bool continued, tobi_error *err)
{
    enum { NAME = 128 };
    const int zones = run->world->sim.porous_count;
    int count = 1;
    if (zones == 0) return TOBI_OK;
    tobi_csv_column *columns = calloc((size_t)zones*VALUES + 1, sizeof *columns);
    char (*names)[NAME] = calloc((size_t)zones*VALUES + 1, sizeof *names);
    tobi_status status = columns && names ? TOBI_OK : tobi_fail(err, TOBI_NO_MEMORY, "run: out of memory");
    for (int k = 0; status == TOBI_OK && k < zones; k++)
        for (int v = 0; v < VALUES; v++, count++) {
            snprintf(names[count], NAME, "%s_%s", tobi_world_porous(run->world, k, NULL), values[v].name);
            columns[count] = (tobi_csv_column){ names[count],
                tobi_run_unit(values[v].unit, run->world->sim.def.dimension) };
        }
    const double now = tobi_world_time(run->world);
    if (status == TOBI_OK) columns[0] = (tobi_csv_column){ "time", "s" };
    if (status == TOBI_OK)
        status = tobi_table_open(run, "porous_zones.csv", continued, now, columns, count, &run->porous, err);
    free(columns);
    free(names);
    return status;
}

tobi_status tobi_porous_write(tobi_run *run, double before, tobi_error *err)
{
    const double now = tobi_world_time(run->world);
    if (!run->porous || !tobi_record_is_due(run->output.probe_interval, before, now)) return TOBI_OK;
    if (tobi_csv_is_gone(run->porous))
        TOBI_TRY(tobi_trouble_pass(run, TOBI_KIND_TABLES, run->outputs, tobi_record_keep_dir(run, err), err));
    tobi_csv_add_real(run->porous, now);
    for (int k = 0; k < run->world->sim.porous_count; k++) {
        tobi_porous_info i;
        tobi_world_porous(run->world, k, &i);
#define V(name, unit, value, doc) tobi_csv_add_real(run->porous, value);
        POROUS(V)
#undef V
    }
    return tobi_trouble_pass(run, TOBI_KIND_TABLES, run->outputs, tobi_csv_end_row(run->porous, err), err);
}
