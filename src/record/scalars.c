/* scalars.csv: temperature and concentration of the liquids, and what comes through sides and bodies, as
   often as the probes are read. */
#include "record/columns.h"
#include "record/record.h"
#include "world/world.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define V(name, unit, value, doc) { name, unit },
static const tobi_csv_column of_all[] = { SCALAR(V) }, of_flow[] = { SCALAR_FLOW(V) };
#undef V
enum { OF_ALL = sizeof of_all/sizeof *of_all, OF_FLOW = sizeof of_flow/sizeof *of_flow, NAME = 160 };

typedef struct header { tobi_csv_column *columns; char (*names)[NAME]; int count, dimension; } header;

/* Of a column of a scalar whose values are in `own`: amounts are in kg where it has no heat capacity. */
static const char *find_unit(const char *unit, const char *own)
{
    if (strcmp(unit, "degC") == 0) return own;
    if (strcmp(own, "degC") == 0) return unit;
    return strcmp(unit, "W") == 0 ? "kg/s" : "kg";
}

/* wall: its name, "" of all liquid. */
static void add(header *h, const char *wall, const char *field, const tobi_csv_column *column,
                const char *own)
{
    char *name = h->names[h->count];
    snprintf(name, NAME, "%s%s%s_%s", wall, *wall ? "_" : "", field, column->name);
    h->columns[h->count++] = (tobi_csv_column){ name, tobi_run_unit(find_unit(column->unit, own),
                                                                    h->dimension) };
}

/* Walls that keep their value have no column of it. */
static int is_there(const tobi_scalar_flow *f, const char *column)
{
    return f->stores || strcmp(column, "value") != 0;
}

static void list_columns(const tobi_world *w, header *h)
{
    tobi_scalar_info i;
    tobi_scalar_flow f;
    const char *name;
    h->columns[h->count++] = (tobi_csv_column){ "time", "s" };
    for (int k = 0; tobi_world_scalar(w, k, &i); k++)
        for (int v = 0; v < OF_ALL; v++) add(h, "", i.field, &of_all[v], i.unit);
    for (int k = 0; (name = tobi_world_scalar_flow(w, k, &f)); k++)
        for (int v = 0; v < OF_FLOW; v++)
            if (is_there(&f, of_flow[v].name)) add(h, name, f.field, &of_flow[v], f.unit);
}

tobi_status tobi_scalars_open(tobi_run *run, bool continued, tobi_error *err)
{
    const tobi_world *w = run->world;
    const size_t most = 1 + TOBI_SCALAR_LIMIT*OF_ALL + TOBI_SCALAR_VALUE_LIMIT*OF_FLOW;
    header h = { .dimension = w->sim.def.dimension };
    if (!tobi_world_scalar(w, 0, NULL)) return TOBI_OK;
    h.columns = calloc(most, sizeof *h.columns);
    h.names = calloc(most, sizeof *h.names);
    tobi_status status = h.columns && h.names ? TOBI_OK
                                              : tobi_fail(err, TOBI_NO_MEMORY, "run: out of memory");
    if (status == TOBI_OK) list_columns(w, &h);
    if (status == TOBI_OK)
        status = tobi_table_open(run, "scalars.csv", continued, tobi_world_time(w), h.columns, h.count,
                                 &run->scalars, err);
    free(h.columns);
    free(h.names);
    return status;
}

tobi_status tobi_scalars_write(tobi_run *run, double before, tobi_error *err)
{
    const double now = tobi_world_time(run->world);
    tobi_scalar_info i;
    tobi_scalar_flow f;
    if (!run->scalars || !tobi_record_is_due(run->output.probe_interval, before, now)) return TOBI_OK;
    if (tobi_csv_is_gone(run->scalars))
        TOBI_TRY(tobi_trouble_pass(run, TOBI_KIND_TABLES, run->outputs, tobi_record_keep_dir(run, err), err));
    tobi_csv_add_real(run->scalars, now);
#define V(name, unit, value, doc) tobi_csv_add_real(run->scalars, value);
    for (int k = 0; tobi_world_scalar(run->world, k, &i); k++) { SCALAR(V) }
#undef V
#define V(name, unit, value, doc) if (is_there(&f, name)) tobi_csv_add_real(run->scalars, value);
    for (int k = 0; tobi_world_scalar_flow(run->world, k, &f); k++) { SCALAR_FLOW(V) }
#undef V
    return tobi_trouble_pass(run, TOBI_KIND_TABLES, run->outputs, tobi_csv_end_row(run->scalars, err), err);
}
