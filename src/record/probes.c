/* probes.csv: a row after each step in which a sensor is due, its cell empty where it is not. The low pass of
   a sensor sees each step, whatever its rate; its state and the extremes so far are kept in checkpoints.
   Drawback: a sensor with a filter is measured in every step. */
#include "record/record.h"
#include "world/world.h"
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 7 };       /* columns of a sensor */

static tobi_table table_of(int kind) { return (tobi_table)(TOBI_TABLE_POINT + kind); }

/* Column `index` of those that a sensor has in this run, and its number in the table; NULL past the last.
   Points have temperature and concentration where the liquids have them. */
static const tobi_column *find_column(const tobi_run *run, int kind, int index, int *number)
{
    const tobi_column *column;
    for (int v = 0; (column = tobi_run_column(table_of(kind), v)); v++) {
        const int scalar = kind == TOBI_PROBE_POINT ? v - 4 : -1;
        if (scalar >= 0 && !run->world->sim.scalar[scalar].given) continue;
        if (number) *number = v;
        if (index-- == 0) return column;
    }
    return NULL;
}

static int take_values(const tobi_run *run, const tobi_probe_info *i, int kind, double value[MOST])
{
    const double all[][MOST] = {
        [TOBI_PROBE_POINT] = { i->pressure, i->velocity[0], i->velocity[1], i->velocity[2], i->scalar[0],
                               i->scalar[1] },
        [TOBI_PROBE_LEVEL] = { i->level },
        [TOBI_PROBE_PATCH] = { i->pressure, i->force[0], i->force[1], i->force[2], i->moment[0], i->moment[1],
                               i->moment[2] },
        [TOBI_PROBE_RUN_UP] = { i->run_up, i->distance },
        [TOBI_PROBE_FLOW] = { i->flow }, [TOBI_PROBE_VOLUME] = { i->volume } };
    double row[MOST];
    int count = 0, number = 0;
    memcpy(row, all[kind], sizeof row);
    for (; find_column(run, kind, count, &number); count++) value[count] = row[number];
    return count;
}

tobi_status tobi_probes_open(tobi_run *run, bool continued, tobi_error *err)
{
    enum { NAME = 128 };
    const int probes = tobi_world_probe_count(run->world);
    int count = 1;
    if (probes == 0) return TOBI_OK;
    tobi_csv_column *columns = calloc((size_t)probes*MOST + 1, sizeof *columns);
    char (*names)[NAME] = calloc((size_t)probes*MOST + 1, sizeof *names);
    if (!run->sensor) run->sensor = calloc((size_t)probes*MOST, sizeof *run->sensor);
    const double now = tobi_world_time(run->world);
    if (columns) columns[0] = (tobi_csv_column){ "time", "s" };
    for (int k = 0; columns && names && k < probes; k++) {
        tobi_probe_kind kind;
        const char *name = tobi_world_probe_name(run->world, k, &kind);
        const tobi_column *column;
        for (int v = 0; (column = find_column(run, kind, v, NULL)); v++, count++) {
            snprintf(names[count], NAME, "%s_%s", name, column->name);
            columns[count] = (tobi_csv_column){ names[count],
                tobi_run_unit(column->unit, run->world->sim.def.dimension) };
        }
    }
    tobi_status status = columns && names && run->sensor
        ? tobi_table_open(run, "probes.csv", continued, now, columns, count, &run->probes, err)
        : tobi_fail(err, TOBI_NO_MEMORY, "run: out of memory");
    free(columns);
    free(names);
    return status;
}

/* --- filters ------------------------------------------------------------------------------- */

/* y' = a (x - y), x linear from `last` to x over dt: exact. */
static void pass_first(tobi_sensor_state *f, double a, double dt, double x)
{
    const double e = exp(-a*dt), rise = x - f->last;
    f->y = e*f->y + (1 - e)*f->last + rise*(1 - (1 - e)/(a*dt));
}

/* y'' + sqrt(2) w y' + w^2 y = w^2 x, x linear over dt: y = last + m t - sqrt(2) m/w plus a decaying turn. */
static void pass_second(tobi_sensor_state *f, double w, double dt, double x)
{
    const double c = w/sqrt(2), m = (x - f->last)/dt, lag = sqrt(2)*m/w;
    const double z = f->y - (f->last - lag), u = f->v - m, b = (u + c*z)/c;
    const double e = exp(-c*dt), cosine = cos(c*dt), sine = sin(c*dt);
    f->y = f->last + m*dt - lag + e*(z*cosine + b*sine);
    f->v = m + e*c*((b - z)*cosine - (b + z)*sine);
}

void tobi_sensor_pass(tobi_sensor_state *f, double cutoff, int order, double dt, double x)
{
    const double w = 2*acos(-1)*cutoff;
    if (!f->begun || !(cutoff > 0)) f->y = x, f->v = 0;
    else if (order == 0) pass_first(f, w, dt, x);
    else pass_second(f, w, dt, x);
    f->last = x;
    f->begun = 1;
}

static void note_extremes(tobi_sensor_state *f, double time)
{
    if (!f->noted || f->y > f->max) f->max = f->y, f->max_time = time;
    if (!f->noted || f->y < f->min) f->min = f->y, f->min_time = time;
    f->noted = 1;
}

/* --- rows ---------------------------------------------------------------------------------- */

bool tobi_record_is_due(double every, double before, double now)
{
    return !(every > 0) || floor(now/every) > floor(before/every);
}

static bool probe_is_due(const tobi_run *run, const tobi_probe_def *def, double before, double now)
{
    return tobi_record_is_due(def->rate > 0 ? 1/def->rate : run->output.probe_interval, before, now);
}

static void add_cells(tobi_run *run, int count, tobi_sensor_state *state, bool due)
{
    for (int v = 0; v < count; v++) {
        if (due) tobi_csv_add_real(run->probes, state[v].y);
        else tobi_csv_add_text(run->probes, "");
        if (due) note_extremes(&state[v], tobi_world_time(run->world));
    }
}

/* A sensor's signal is followed step by step: at impacts nothing less will do. */
tobi_status tobi_tables_write_probes(tobi_run *run, double before, tobi_error *err)
{
    const double now = tobi_world_time(run->world);
    const int probes = tobi_world_probe_count(run->world);
    tobi_sensor_state *state = run->sensor;
    bool row = false;
    if (!run->probes) return TOBI_OK;
    for (int k = 0; k < probes; k++) row |= probe_is_due(run, &run->world->probes[k].def, before, now);
    if (row && tobi_csv_is_gone(run->probes))
        TOBI_TRY(tobi_trouble_pass(run, TOBI_KIND_TABLES, run->outputs, tobi_record_keep_dir(run, err), err));
    if (row) tobi_csv_add_real(run->probes, now);
    for (int k = 0; k < probes; k++) {
        const tobi_probe_def *def = &run->world->probes[k].def;
        const bool due = probe_is_due(run, def, before, now);
        tobi_probe_info info = { 0 };
        double value[MOST];
        if (due || def->cutoff > 0) tobi_world_measure_probe(run->world, k, &info);
        const int count = take_values(run, &info, def->kind, value);
        for (int v = 0; v < count && (due || def->cutoff > 0); v++)
            tobi_sensor_pass(&state[v], def->cutoff, def->order, now - before, value[v]);
        if (row) add_cells(run, count, state, due);
        state += count;
    }
    if (!row) return TOBI_OK;
    return tobi_trouble_pass(run, TOBI_KIND_TABLES, run->outputs, tobi_csv_end_row(run->probes, err), err);
}

/* --- checkpoints and summary --------------------------------------------------------------- */

static int count_columns(const tobi_run *run)
{
    int count = 0;
    for (int k = 0; k < tobi_world_probe_count(run->world); k++)
        for (int v = 0; find_column(run, run->world->probes[k].def.kind, v, NULL); v++) count++;
    return count;
}

json_t *tobi_probes_to_json(const tobi_run *run)
{
    json_t *list = json_array();
    for (int k = 0; run->sensor && k < count_columns(run); k++) {
        const tobi_sensor_state *s = &run->sensor[k];
        json_array_append_new(list, json_pack("[f, f, f, f, f, f, f, b, b]", s->y, s->v, s->last, s->max,
                                              s->max_time, s->min, s->min_time, s->begun, s->noted));
    }
    return list;
}

bool tobi_probes_from_json(json_t *list, tobi_run *run)
{
    const int count = count_columns(run);
    if (count == 0 || !list) return true;
    if (!run->sensor) run->sensor = calloc((size_t)count, sizeof *run->sensor);
    if (!run->sensor || (int)json_array_size(list) != count) return false;
    for (int k = 0; k < count; k++) {
        tobi_sensor_state *s = &run->sensor[k];
        if (json_unpack(json_array_get(list, (size_t)k), "[F, F, F, F, F, F, F, b, b]", &s->y, &s->v,
                        &s->last,
                        &s->max, &s->max_time, &s->min, &s->min_time, &s->begun, &s->noted) != 0)
            return false;
    }
    return true;
}

static json_t *number(double value) { return isfinite(value) ? json_real(value) : json_null(); }

/* name_column: extremes of what probes.csv holds, and when. */
json_t *tobi_probes_sum_up(const tobi_run *run)
{
    json_t *all = json_object();
    const tobi_sensor_state *s = run->sensor;
    for (int k = 0; s && k < tobi_world_probe_count(run->world); k++) {
        tobi_probe_kind kind;
        const char *name = tobi_world_probe_name(run->world, k, &kind);
        const tobi_column *column;
        for (int v = 0; (column = find_column(run, kind, v, NULL)); v++, s++) {
            char key[160];
            snprintf(key, sizeof key, "%s_%s", name, column->name);
            if (s->noted)
                json_object_set_new(all, key, json_pack("{s:s, s:o, s:o, s:o, s:o}", "unit",
                                    tobi_run_unit(column->unit, run->world->sim.def.dimension), "max",
                                    number(s->max), "max_time", number(s->max_time), "min", number(s->min),
                                    "min_time", number(s->min_time)));
        }
    }
    return all;
}
