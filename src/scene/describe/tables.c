/* The columns of the tables that a run writes: as help texts and as docs/tables.md, from the lists that
   write them (record/columns.h). Drawback: only what no list knows, such as when a row is written,
   stands here and must be kept true by hand. */
#define _GNU_SOURCE 1
#include "scene/describe/manual.h"
#include "tobiuo/run.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char head[] =
    "# Tables of a run\n"
    "\n"
    "<!-- Written by `tobiuo describe tables` from the lists that write the tables; do not edit. -->\n"
    "\n"
    "[日本語](tables.ja.md)\n"
    "\n"
    "## Files of a run\n"
    "\n"
    "| file | content |\n"
    "|---|---|\n"
    "| `fluid.pvd`, `bodies.pvd` | particles of the fluid (or solids) and of the "
    "bodies over time; `.vtu` in folders beside |\n"
    "| `all.pvd` | everything in one list with one time base |\n"
    "| `grid.pvd` | nodes of the grid of mlsmpm, with `output.grid` |\n"
    "| `surface.pvd` | the surface of fluids and pieces of solids, with `output.surface.write` |\n"
    "| `BODY.pvd` | the moving surface of each body: `.vtp` and `.stl` in `surfaces/` |\n"
    "| `BODY_tractions.pvd` | pressure and shear on it, in `tractions/`, with `output.tractions` |\n"
    "| `frames/` | a picture per output, with `--frames` |\n"
    "| `ply/`, `obj/` | positions of the fluid, surfaces of the bodies, with `output.ply`, `output.obj` |\n"
    "| `history.csv`, `bodies.csv`, `solids.csv`, `probes.csv` | the tables below |\n"
    "| `movie.mp4` | those pictures as a movie, after `tobiuo movie` |\n"
    "| `report.html` | one page: what to trust, pictures, plots, tables, times; after `tobiuo report` |\n"
    "| `plots/` | the tables as pictures, after `tobiuo plot` |\n"
    "| `checkpoints/` | what `tobiuo resume` goes on from |\n"
    "| `resolved.json` | the scene with every default explicit; gives the same bits again |\n"
    "| `summary.json` | totals; of solids the number of `pieces`, and mass (kg), volume (m3), "
    "centre (m) of each |\n"
    "\n"
    "## The tables\n"
    "\n"
    "A run leaves its tables in its folder. They are CSV files: a row of names, then numbers\n"
    "with a decimal point and commas between.\n"
    "\n"
    "| file | a row for | in the folder |\n"
    "|---|---|---|\n"
    "| `history.csv` | each output | always |\n"
    "| `bodies.csv` | each output and body | where the scene has bodies |\n"
    "| `solids.csv` | each output and solid | where the scene has solids beside fluids |\n"
    "| `lines.csv` | each step, or each `output.probe_interval`: `NAME_tension [N]`, "
    "`NAME_distance [m]` | where the scene has lines |\n"
    "| `joints.csv` | the same: `NAME_force_x [N]` ..., `NAME_moment_x [N m]` ..., "
    "`NAME_angle [degrees]`, `NAME_gap [m]` | where the scene has joints |\n"
    "| `probes.csv` | each step, or each `output.probe_interval` | where the scene has probes |\n"
    "\n"
    "- Units are SI. In 2-D masses, forces, torques and energies are per metre of depth.\n"
    "- Vectors are in axes of the domain. A force is positive towards the higher coordinate.\n"
    "- Forces and torques in `bodies.csv` act on the body, torques about its centre of mass.\n"
    "- `solids.csv` has the force of the fluids on each solid. What holds the solid, `clamped_to`, is in\n"
    "  `bodies.csv`: the force on a body is that of the fluids and that of the solids on it.\n"
    "- Columns `mean_...` are means over the time since the last output. Plot these. Other values are of\n"
    "  the last step, and scatter from step to step.\n"
    "- Energies and works of solids are of `mlsmpm`; of the other methods they are 0.\n"
    "- `tobiuo plot DIR` draws the tables; `tobiuo describe COLUMN` tells what a column is.\n";

static const struct { const char *topic, *file, *doc; tobi_table table; } tables[] = {
    { "history", "history.csv", "The columns of history.csv: a row per output.", TOBI_TABLE_HISTORY },
    { "bodies", "bodies.csv", "The columns of bodies.csv: a row per output and body.", TOBI_TABLE_BODIES },
    { "solids", "solids.csv", "The columns of solids.csv: a row per output and solid.", TOBI_TABLE_SOLIDS },
    { "probes", "probes.csv", "The columns of probes.csv for a probe of kind point: NAME_pressure, ...",
      TOBI_TABLE_POINT },
    { "probes", "probes.csv", "The columns of probes.csv for a probe of kind level: NAME_level.",
      TOBI_TABLE_LEVEL },
    { "probes", "probes.csv", "The columns of probes.csv for a probe of kind patch: NAME_pressure, ...",
      TOBI_TABLE_PATCH },
    { "probes", "probes.csv", "The columns of probes.csv for a probe of kind run-up: NAME_run_up, ...",
      TOBI_TABLE_RUN_UP },
    { "probes", "probes.csv", "The columns of probes.csv for a probe of kind flow: NAME_flow.",
      TOBI_TABLE_FLOW },
    { "probes", "probes.csv", "The columns of probes.csv for a probe of kind volume: NAME_volume.",
      TOBI_TABLE_VOLUME },
};
enum { TABLES = sizeof tables/sizeof *tables };

/* The meaning of a column stands once for the components of a vector. */
static const char *find_meaning(tobi_table table, int index)
{
    while (index > 0 && !*tobi_run_column(table, index)->doc) index--;
    return tobi_run_column(table, index)->doc;
}

static int is_above(const tobi_column *c) { return !*c->doc; }

static void print_column(FILE *out, tobi_table table, int index)
{
    const tobi_column *c = tobi_run_column(table, index);
    fprintf(out, "  %-27s %-7s %s\n", c->name, c->unit, is_above(c) ? "(as above)" : c->doc);
}

int tobi_tables_describe(FILE *out, const char *topic)
{
    int found = 0;
    for (int k = 0; k < TABLES; k++) {
        if (strcmp(tables[k].topic, topic) != 0) continue;
        fprintf(out, "%s%s\n", found++ ? "\n" : "", tables[k].doc);
        for (int i = 0; tobi_run_column(tables[k].table, i); i++) print_column(out, tables[k].table, i);
    }
    return found;
}

int tobi_tables_find(FILE *out, const char *name)
{
    const tobi_column *c;
    int found = 0;
    for (int k = 0; k < TABLES; k++)
        for (int i = 0; (c = tobi_run_column(tables[k].table, i)); i++) {
            if (strcmp(c->name, name) != 0) continue;
            fprintf(out, "%s: column of %s, unit %s\n      %s\n", name, tables[k].file, c->unit,
                    find_meaning(tables[k].table, i));
            found++;
        }
    return found;
}

const char *tobi_tables_topic(int index, const char **doc)
{
    static const char *const names[] = { "history", "bodies", "solids", "probes", "tables" };
    static const char *const docs[] = { "The columns of history.csv, with units.", "Those of bodies.csv.",
                                        "Those of solids.csv.",
                                        "Those of probes.csv.",
                                        "The page of all columns, in Markdown (docs/tables.md)." };
    if (index < 0 || index >= 5) return NULL;
    *doc = docs[index];
    return names[index];
}

/* Components of a vector share a row: `position_x`, `_y`, `_z`. */
static void write_rows(FILE *out, tobi_table table)
{
    const tobi_column *c, *next;
    fputs("| column | unit | meaning |\n|---|---|---|\n", out);
    for (int i = 0; (c = tobi_run_column(table, i)); i++) {
        const char *doc = c->doc;
        fprintf(out, "| `%s`", c->name);
        while ((next = tobi_run_column(table, i + 1)) && !*next->doc) {
            fprintf(out, ", `%s`", strrchr(next->name, '_'));
            i++;
        }
        fprintf(out, " | %s | %s |\n", c->unit, doc);
    }
}

char *tobi_tables_manual(void)
{
    static const char *const kinds[] = { "point", "level", "patch", "run-up", "flow", "volume" };
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out) return NULL;
    fputs(head, out);
    fputs("\n## history.csv\n\n", out);
    write_rows(out, TOBI_TABLE_HISTORY);
    fputs("\n## bodies.csv\n\n", out);
    write_rows(out, TOBI_TABLE_BODIES);
    fputs("\n## solids.csv\n\n", out);
    write_rows(out, TOBI_TABLE_SOLIDS);
    fputs("\n## probes.csv\n\nThe header names each column with its unit, `P_pressure [Pa]`. The first is\n"
          "`time [s]`. Where a sensor with a rate of its own is not due, its cells are empty.\n"
          "`summary.json` has the extremes of each column (`sensors`).\n", out);
    for (int k = 0; k < 6; k++) {
        fprintf(out, "\nFor each probe P of kind %s, after P and `_`:\n\n", kinds[k]);
        write_rows(out, (tobi_table)(TOBI_TABLE_POINT + k));
    }
    int failed = ferror(out);
    if (fclose(out) == 0 && !failed) return text;
    free(text);
    return NULL;
}
