/* lines.csv: of each line of the scene tension and distance of its ends, as often as the probes are read. */
#include "record/columns.h"
#include "record/record.h"
#include "world/world.h"
#include <stdio.h>
#include <stdlib.h>

#define V(name, unit, value, doc) { name, unit },
static const tobi_csv_column values[] = { LINE(V) };
#undef V
enum { VALUES = sizeof values/sizeof *values };

tobi_status tobi_lines_open(tobi_run *run, bool continued, tobi_error *err)
{
    enum { NAME = 128 };
    const int lines = tobi_world_line_count(run->world);
    int count = 1;
    if (lines == 0) return TOBI_OK;
    tobi_csv_column *columns = calloc((size_t)lines*VALUES + 1, sizeof *columns);
    char (*names)[NAME] = calloc((size_t)lines*VALUES + 1, sizeof *names);
    tobi_status status = columns && names ? TOBI_OK : tobi_fail(err, TOBI_NO_MEMORY, "run: out of memory");
    for (int k = 0; status == TOBI_OK && k < lines; k++)
        for (int v = 0; v < VALUES; v++, count++) {
            snprintf(names[count], NAME, "%s_%s", tobi_world_line(run->world, k, NULL), values[v].name);
            columns[count] = (tobi_csv_column){ names[count],
                tobi_run_unit(values[v].unit, run->world->sim.def.dimension) };
        }
    const double now = tobi_world_time(run->world);
    if (status == TOBI_OK) columns[0] = (tobi_csv_column){ "time", "s" };
    if (status == TOBI_OK)
        status = tobi_table_open(run, "lines.csv", continued, now, columns, count, &run->lines, err);
    free(columns);
    free(names);
    return status;
}

tobi_status tobi_lines_write(tobi_run *run, double before, tobi_error *err)
{
    const double now = tobi_world_time(run->world);
    if (!run->lines || !tobi_record_is_due(run->output.probe_interval, before, now)) return TOBI_OK;
    if (tobi_csv_is_gone(run->lines))
        TOBI_TRY(tobi_trouble_pass(run, TOBI_KIND_TABLES, run->outputs, tobi_record_keep_dir(run, err), err));
    tobi_csv_add_real(run->lines, now);
    for (int k = 0; k < tobi_world_line_count(run->world); k++) {
        tobi_line_info i;
        tobi_world_line(run->world, k, &i);
#define V(name, unit, value, doc) tobi_csv_add_real(run->lines, value);
        LINE(V)
#undef V
    }
    return tobi_trouble_pass(run, TOBI_KIND_TABLES, run->outputs, tobi_csv_end_row(run->lines, err), err);
}
