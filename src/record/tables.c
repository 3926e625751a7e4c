/* history.csv, bodies.csv and solids.csv (probes.csv: record/probes.c): the columns are lists
   (record/columns.h), so that header, row and what is said of them cannot disagree. */
#include "base/plain.h"
#include "record/record.h"
#include "record/columns.h"
#include "world/world.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define DIGITS 9

static double mean(double sum, const tobi_tally *s)
{
    return s->steps ? sum / (double)s->steps : 0.0;
}

static double wall_ratio(const tobi_run *run, const tobi_step_info *i)
{
    const double *g = run->world->sim.def.gravity, *f = i->wall_force;
    double size = sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
    if (!(i->weight > 0.0)) return 0.0;
    return (f[0] * g[0] + f[1] * g[1] + f[2] * g[2]) / (size * i->weight);
}

void tobi_tally_add(tobi_tally *tally, const tobi_step_info *info)
{
    tally->steps++;
    tally->unconverged += !info->density_converged || !info->divergence_converged || info->viscosity_failed;
    tally->density_iterations += info->density_iterations;
    tally->divergence_iterations += info->divergence_iterations;
    tally->residual_max = fmax(tally->residual_max, info->pressure_residual);
    tally->density_error_mean += info->density_error_mean;
    tally->density_error_max = fmax(tally->density_error_max, info->density_error_max);
}

void tobi_tally_bodies(tobi_run *run, double dt)
{
    for (int k = 0; k < tobi_world_body_count(run->world); k++) {
        tobi_body_tally *t = &run->body_since[k];
        const tobi_body_info *b = &run->world->sim.bodies[k].info;
        const double *value[] = { b->pressure_force, b->viscous_force, b->pressure_torque,
                                  b->viscous_torque, b->contact_force, b->contact_torque,
                                  b->edge_force };
        t->time += dt;
        for (int v = 0; v < TOBI_BODY_FORCES; v++)
            for (int a = 0; a < 3; a++) t->impulse[v][a] += dt*value[v][a];
    }
}

void tobi_tally_solids(tobi_run *run, double dt)
{
    for (int k = 0; run->solids && k < tobi_world_solid_count(run->world); k++) {
        double force[3];
        tobi_world_liquid_force(run->world, k, force);
        run->solid_since[k].time += dt;
        for (int a = 0; a < 3; a++) run->solid_since[k].impulse[a] += dt*force[a];
    }
}

static tobi_body_tally mean_of_body(const tobi_body_tally *t)
{
    tobi_body_tally m = *t;
    for (int v = 0; v < TOBI_BODY_FORCES; v++)
        for (int a = 0; a < 3; a++) m.impulse[v][a] /= t->time > 0 ? t->time : 1;
    return m;
}

tobi_status tobi_table_open(const tobi_run *run, const char *name, bool continued, double time,
                            const tobi_csv_column *columns, int count, tobi_csv **csv, tobi_error *err)
{
    char *path = tobi_record_path(run->dir, "%s", name);
    if (!path) return tobi_fail(err, TOBI_NO_MEMORY, "run: out of memory");
    tobi_status status = TOBI_OK;
    if (continued) status = tobi_csv_truncate(path, time, err);
    if (status == TOBI_OK || status == TOBI_NOT_FOUND)
        status = tobi_csv_open(path, continued ? TOBI_CSV_APPEND : TOBI_CSV_NEW, DIGITS, columns,
                               count, csv, err);
    free(path);
    return status;
}

#define H(name, unit, kind, value, doc) { name, NULL },
static const tobi_csv_column history_columns[] = {
    HISTORY(H) HISTORY_POROUS(H) HISTORY_BUOYANCY(H) HISTORY_AIR(H) HISTORY_FIELD(H) HISTORY_NEST(H) };
enum { HISTORY_COLUMNS = sizeof history_columns/sizeof *history_columns };
#undef H
#define B(name, unit, value, doc) { name, NULL },
static const tobi_csv_column body_columns[] = {
    { "time", NULL }, { "name", NULL }, BODY(B) BODY_2D(B) BODY_3D(B) BODY_AIR(B)
    BODY_FIELD(B) BODY_NEST(B) };
enum { BODY_COLUMNS = sizeof body_columns/sizeof *body_columns };
#undef B

#define S(name, unit, value, doc) { name, NULL },
static const tobi_csv_column solid_columns[] = {
    { "time", NULL }, { "name", NULL }, SOLID(S) SOLID_LIQUID(S) };
enum { SOLID_COLUMNS = sizeof solid_columns/sizeof *solid_columns };
#undef S

#define H(name, unit, kind, value, doc) { name, unit, doc },
static const tobi_column history[] = {
    HISTORY(H) HISTORY_POROUS(H) HISTORY_BUOYANCY(H) HISTORY_AIR(H) HISTORY_FIELD(H) HISTORY_NEST(H) };
#undef H
#define B(name, unit, value, doc) { name, unit, doc },
static const tobi_column body[] = {
    { "time", "s", "Simulated time." }, { "name", "text", "Name of the body." }, BODY(B)
    BODY_2D(B) BODY_3D(B) BODY_AIR(B) BODY_FIELD(B) BODY_NEST(B) };
#undef B
#define S(name, unit, value, doc) { name, unit, doc },
static const tobi_column solid[] = {
    { "time", "s", "Simulated time." }, { "name", "text", "Name of the solid." }, SOLID(S)
    SOLID_LIQUID(S) };
#undef S
#define P(name, unit, doc) { name, unit, doc },
static const tobi_column point[] = { POINT(P) }, level[] = { LEVEL(P) }, patch[] = { PATCH(P) },
    run_up[] = { RUN_UP(P) }, flow[] = { FLOW(P) }, volume[] = { VOLUME(P) };
#undef P
#define V(name, unit, value, doc) { name, unit, doc },
static const tobi_column line[] = { LINE(V) }, joint[] = { JOINT(V, V) }, porous[] = { POROUS(V) },
    scalar[] = { SCALAR(V) }, scalar_flow[] = { SCALAR_FLOW(V) };
#undef V

static const struct { const tobi_column *columns; int count; } tables[] = {
#define LIST(columns) { columns, (int)(sizeof columns / sizeof *columns) }
    [TOBI_TABLE_HISTORY] = LIST(history), [TOBI_TABLE_BODIES] = LIST(body),
    [TOBI_TABLE_POINT] = LIST(point), [TOBI_TABLE_LEVEL] = LIST(level), [TOBI_TABLE_PATCH] = LIST(patch),
    [TOBI_TABLE_RUN_UP] = LIST(run_up), [TOBI_TABLE_FLOW] = LIST(flow), [TOBI_TABLE_VOLUME] = LIST(volume),
    [TOBI_TABLE_SOLIDS] = LIST(solid), [TOBI_TABLE_LINES] = LIST(line), [TOBI_TABLE_JOINTS] = LIST(joint),
    [TOBI_TABLE_POROUS] = LIST(porous), [TOBI_TABLE_SCALARS] = LIST(scalar),
    [TOBI_TABLE_SCALAR_FLOWS] = LIST(scalar_flow),
#undef LIST
};

const tobi_column *tobi_run_column(tobi_table table, int index)
{
    if (table < 0 || table >= (int)(sizeof tables/sizeof *tables)) return NULL;
    return index >= 0 && index < tables[table].count ? &tables[table].columns[index] : NULL;
}

const char *tobi_run_unit(const char *unit, int dimension)
{
    static const char *const per_depth[][2] = {
        { "N", "N per m" }, { "N m", "N m per m" }, { "J", "J per m" }, { "W", "W per m" },
        { "kg", "kg per m" }, { "kg/s", "kg/s per m" }, { "kg m/s", "kg m/s per m" }, { "m3", "m2" },
        { "m3/s", "m2/s" } };
    for (size_t k = 0; dimension == 2 && k < sizeof per_depth/sizeof *per_depth; k++)
        if (strcmp(unit, per_depth[k][0]) == 0) return per_depth[k][1];
    return unit;
}

/* history.csv has a row per output. */
static int64_t count_missing(const tobi_run *run)
{
    char *path = tobi_record_path(run->dir, "history.csv"), *text = NULL;
    size_t bytes;
    int64_t rows = -1;      /* the header */
    if (path && tobi_plain_read(path, tr("table"), 0, &text, &bytes, NULL) == TOBI_OK)
        for (size_t k = 0; k < bytes; k++) rows += text[k] == '\n';
    free(text);
    free(path);
    return rows >= 0 ? run->outputs - rows : 0;
}

void tobi_tables_count_missing(tobi_run *run)
{
    run->history_missing = tobi_csv_has_lost(run->history) ? 0 : count_missing(run);
}

static bool has_zones(const tobi_run *run) { return run->world->sim.porous_count > 0; }

static bool has_buoyancy(const tobi_run *run)
{
    bool has = false;
    for (int k = 0; k < TOBI_SCALAR_LIMIT; k++) has |= run->world->sim.scalar[k].expansion != 0;
    return has;
}

static bool is_flat(const tobi_run *run) { return run->world->sim.def.dimension == 2; }

static bool is_solid(const tobi_run *run) { return !is_flat(run); }

static bool has_air(const tobi_run *run)
{
    bool has = false;
    for (int k = 0; k < tobi_world_body_count(run->world); k++) {
        const tobi_rigid *r = &run->world->sim.bodies[k].rigid;
        has |= r->kind != TOBI_PRESCRIBED && r->air_resistance > 0;
    }
    return has;
}

static bool has_moving(const tobi_run *run)
{
    return tobi_body_any_free(run->world->sim.bodies, run->world->sim.body_count);
}

static bool has_field(const tobi_run *run) { return run->world->drive && has_moving(run); }

static bool has_nests(const tobi_run *run)
{
    return tobi_world_nest_at(run->world, 0) && run->world->system[0].method->nests > 1 && has_moving(run);
}

static bool has_liquids(const tobi_run *run) { return run->world->sim.soft.solids != NULL; }

/* The last columns are of worlds that have what they tell. */
typedef struct of_some { bool (*has)(const tobi_run *run); int columns; } of_some;
static const of_some history_of_some[] = {
    { has_zones, 1 }, { has_buoyancy, 1 }, { has_air, 1 }, { has_field, 1 }, { has_nests, 1 } };
static const of_some body_of_some[] = {
    { is_flat, 1 }, { is_solid, 3 }, { has_air, 1 }, { has_field, 1 }, { has_nests, 7 } };
static const of_some solid_of_some[] = { { has_liquids, 6 } };

static int choose_columns(const tobi_run *run, const tobi_csv_column *all, int count, const of_some *some,
                          int kinds, tobi_csv_column *out)
{
    int chosen = count, at;
    for (int k = 0; k < kinds; k++) chosen -= some[k].columns;
    at = chosen;
    memcpy(out, all, (size_t)chosen*sizeof *out);
    for (int k = 0; k < kinds; at += some[k++].columns)
        for (int c = 0; c < some[k].columns && some[k].has(run); c++) out[chosen++] = all[at + c];
    return chosen;
}

tobi_status tobi_tables_open(tobi_run *run, bool continued, tobi_error *err)
{
    const double last = continued ? tobi_record_time(run, run->outputs - 1) : 0;
    tobi_csv_column of_run[HISTORY_COLUMNS], of_bodies[BODY_COLUMNS], of_solids[SOLID_COLUMNS];
    const int of_history = choose_columns(run, history_columns, HISTORY_COLUMNS, history_of_some,
                                          sizeof history_of_some/sizeof *history_of_some, of_run);
    const int each = choose_columns(run, body_columns, BODY_COLUMNS, body_of_some,
                                    sizeof body_of_some/sizeof *body_of_some, of_bodies);
    const int of_solid = choose_columns(run, solid_columns, SOLID_COLUMNS, solid_of_some, 1, of_solids);
    TOBI_TRY(tobi_table_open(run, "history.csv", continued, last, of_run, of_history, &run->history, err));
    if (tobi_world_body_count(run->world) > 0)
        TOBI_TRY(tobi_table_open(run, "bodies.csv", continued, last, of_bodies, each, &run->bodies, err));
    if (tobi_world_solid_count(run->world) > 0)
        TOBI_TRY(tobi_table_open(run, "solids.csv", continued, last, of_solids, of_solid, &run->solids, err));
    TOBI_TRY(tobi_lines_open(run, continued, err));
    TOBI_TRY(tobi_joints_open(run, continued, err));
    TOBI_TRY(tobi_porous_open(run, continued, err));
    TOBI_TRY(tobi_scalars_open(run, continued, err));
    return tobi_probes_open(run, continued, err);
}

/* The angles, degrees, about x, then y, then z, of a unit quaternion. At a pitch of 90 degrees, where only
   the sum or difference of the others counts, all of it may be in either. */
static void find_turns(const double q[4], double turn[3])
{
    const double degrees = 180/acos(-1), s = 2*(q[0]*q[2] - q[1]*q[3]);
    turn[0] = degrees*atan2(2*(q[0]*q[1] + q[2]*q[3]), 1 - 2*(q[1]*q[1] + q[2]*q[2]));
    turn[1] = degrees*asin(s > 1 ? 1 : s < -1 ? -1 : s);
    turn[2] = degrees*atan2(2*(q[0]*q[3] + q[1]*q[2]), 1 - 2*(q[2]*q[2] + q[3]*q[3]));
}

static tobi_status take_bodies(tobi_run *run, tobi_csv_rows *rows, tobi_error *err)
{
    for (int k = 0; k < tobi_world_body_count(run->world); k++) {
        tobi_body_info b;
        TOBI_TRY(tobi_world_body(run->world, k, &b));
        const tobi_body_tally m = mean_of_body(&run->body_since[k]);
        const double *work = run->works.body[k], *finer = run->world->sim.bodies[k].rigid.finer;
        double turn[3];
        find_turns(b.orientation, turn);
        tobi_body_energy e;
        TOBI_TRY(tobi_world_body_energy(run->world, k, &e));
        tobi_csv_add_real(run->bodies, tobi_world_time(run->world));
        tobi_csv_add_text(run->bodies, tobi_world_body_name(run->world, k));
#define B(name, unit, value, doc) tobi_csv_add_real(run->bodies, value);
        BODY(B)
        if (is_flat(run)) { BODY_2D(B) }
        else { BODY_3D(B) }
        if (has_air(run)) { BODY_AIR(B) }
        if (has_field(run)) { BODY_FIELD(B) }
        if (has_nests(run)) { BODY_NEST(B) }
#undef B
        TOBI_TRY(tobi_csv_take_row(run->bodies, rows, err));
    }
    return TOBI_OK;
}

static tobi_status take_solids(tobi_run *run, tobi_csv_rows *rows, tobi_error *err)
{
    for (int k = 0; run->solids && k < tobi_world_solid_count(run->world); k++) {
        const tobi_solid_tally *t = &run->solid_since[k];
        tobi_solid_info i;
        double m[3];
        TOBI_TRY(tobi_world_solid(run->world, k, &i));
        for (int a = 0; a < 3; a++) m[a] = t->impulse[a]/(t->time > 0 ? t->time : 1);
        tobi_csv_add_real(run->solids, tobi_world_time(run->world));
        tobi_csv_add_text(run->solids, i.name);
#define S(name, unit, value, doc) tobi_csv_add_real(run->solids, value);
        SOLID(S)
        if (has_liquids(run)) { SOLID_LIQUID(S) }
#undef S
        TOBI_TRY(tobi_csv_take_row(run->solids, rows, err));
    }
    return TOBI_OK;
}

tobi_status tobi_tables_take(tobi_run *run, tobi_snapshot *snapshot, tobi_error *err)
{
    const tobi_step_info *i = tobi_world_info(run->world);
    const tobi_tally *s = &run->since;
    tobi_energy energy, *e = &energy;
    const tobi_pieces none = { 0 }, *pieces = &none;
    if (tobi_world_solid_count(run->world) > 0) TOBI_TRY(tobi_world_pieces(run->world, &pieces, err));
    TOBI_TRY(tobi_world_energy(run->world, e));
    TOBI_TRY(take_bodies(run, &snapshot->bodies, err));
    TOBI_TRY(take_solids(run, &snapshot->solids, err));
#define H(name, unit, kind, value, doc) tobi_csv_add_##kind(run->history, value);
    HISTORY(H)
    if (has_zones(run)) { HISTORY_POROUS(H) }
    if (has_buoyancy(run)) { HISTORY_BUOYANCY(H) }
    if (has_air(run)) { HISTORY_AIR(H) }
    if (has_field(run)) { HISTORY_FIELD(H) }
    if (has_nests(run)) { HISTORY_NEST(H) }
#undef H
    return tobi_csv_take_row(run->history, &snapshot->history, err);
}

tobi_status tobi_tables_write(tobi_run *run, tobi_snapshot *snapshot, tobi_error *err)
{
    tobi_csv *const table[] = { run->bodies, run->solids, run->history };
    tobi_csv_rows *const rows[] = { &snapshot->bodies, &snapshot->solids, &snapshot->history };
    enum { ALL = sizeof table/sizeof *table };
    for (int k = snapshot->tables_written; k < ALL; k++) {
        const tobi_status status = table[k] ? tobi_csv_write_rows(table[k], rows[k], err) : TOBI_OK;
        TOBI_TRY(tobi_trouble_pass(run, TOBI_KIND_TABLES, snapshot->number, status, err));
        if (k + 1 < ALL) snapshot->tables_written = k + 1;
    }
    return TOBI_OK;
}

void tobi_tables_list(const tobi_run *run, tobi_csv *tables[TOBI_TABLES])
{
    tobi_csv *const all[TOBI_TABLES] = { run->history, run->bodies, run->solids, run->probes,
                                          run->lines, run->joints, run->porous, run->scalars };
    for (int k = 0; k < TOBI_TABLES; k++) tables[k] = all[k];
}

tobi_status tobi_tables_flush(tobi_run *run, tobi_error *err)
{
    tobi_csv *all[TOBI_TABLES];
    tobi_tables_list(run, all);
    for (int k = 0; k < TOBI_TABLES; k++)
        if (all[k]) TOBI_TRY(tobi_csv_flush(all[k], err));
    return TOBI_OK;
}

int64_t tobi_tables_waiting(const tobi_run *run)
{
    tobi_csv *all[TOBI_TABLES];
    int64_t sum = 0;
    tobi_tables_list(run, all);
    for (int k = 0; k < TOBI_TABLES; k++) sum += all[k] ? tobi_csv_waiting(all[k]) : 0;
    return sum;
}
