/* The columns of the tables that a run writes: as help texts and as docs/tables.md, from the lists that
   write them (record/columns.h). Drawback: only what no list knows, such as when a row is written,
   stands here and must be kept true by hand. */
#define _GNU_SOURCE 1
#include "scene/describe/describe.h"
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
    "## Which column\n"
    "\n"
    "| to know | file | column |\n"
    "|---|---|---|\n"
    "| force of liquids and solids on a body | `bodies.csv` | `mean_pressure_force_x`, `_y`, `_z` and "
    "`mean_viscous_force_x`, `_y`, `_z` |\n"
    "| where a body is, how it is turned | `bodies.csv` | `position_x`, `_y`, `_z`; in 2-D `angle`, in 3-D "
    "`roll`, `pitch`, `yaw` and `orientation_w`, `_x`, `_y`, `_z` |\n"
    "| torque of a stirrer, a propeller | `bodies.csv` | `mean_pressure_torque_z` + "
    "`mean_viscous_torque_z`; `motion_work` over the time is the power. "
    "`tobiuo plot` draws both, a [sweep](tanks.md#a-sweep) compares them |\n"
    "| force on a knife's edge | `bodies.csv` | `mean_edge_force_x`, `_y`, `_z` |\n"
    "| force of the liquids on a soft solid | `solids.csv` | `mean_liquid_force_x`, `_y`, `_z` |\n"
    "| pressure, level, flow at a sensor | `probes.csv` | `NAME_pressure`, `NAME_level`, `NAME_flow` |\n"
    "| velocity along a line, mean flow, Reynolds stresses | `sample/` | by [`tobiuo sample`](sample.md) |\n"
    "| significant height, spectrum, reflection of waves | `waves.csv`, `wave_spectra.csv`, "
    "`wave_groups.csv` | by [`tobiuo waves`](waves.md) |\n"
    "| response of a float or a mooring to waves (RAO) | `wave_responses.csv`, `wave_gains.csv` | by "
    "[`tobiuo waves --response`](waves.md#responses-of-floats-and-moorings) |\n"
    "| temperature, concentration; heat through a wall | `scalars.csv` | `temperature_mean`, "
    "`WALL_temperature_flow` |\n"
    "| force on a porous zone, what it takes | `porous_zones.csv`; all: `history.csv` | `NAME_force_x`, "
    "`NAME_work`; `porous_work` |\n"
    "| tension of a line, force in a joint | `lines.csv`, `joints.csv` | `NAME_tension`; "
    "`NAME_force_x`, `_y`, `_z` |\n"
    "| force of the liquids on the sides of the domain | `history.csv` | `wall_force_x`, `_y`, `_z` |\n"
    "| energy of fluids and solids | `history.csv` | `kinetic_energy`, `potential_energy`, "
    "`elastic_energy` |\n"
    "| energy of bodies, of springs | `history.csv`; each: `bodies.csv` | `body_kinetic_energy`, "
    "`body_potential_energy`, `spring_energy`; `kinetic_energy`, `potential_energy` |\n"
    "| what a wave maker, a motion, a swimmer gives | `history.csv`; each: `bodies.csv` | `motion_work` |\n"
    "| what a constant force or a control program gives | `bodies.csv`; all: `history.csv` | "
    "`force_work` |\n"
    "| what air resistance, a moving frame or a central force gives bodies | `bodies.csv`; all: "
    "`history.csv` | `air_work`; `field_work` |\n"
    "| what nests give bodies more than the scene's liquid | `bodies.csv`; all: `history.csv` | "
    "`nest_work` |\n"
    "| what a wave-energy converter takes | `joints.csv`; all: `history.csv` | `NAME_work`; "
    "`joint_work` |\n"
    "| liquid that came in and went out | `history.csv` | `mass_in`, `mass_out`, `mass_held` |\n"
    "| pieces of a solid that was cut | `history.csv` | `pieces`; each one: `piece_list` in "
    "`summary.json` |\n"
    "| whether to trust the run | `history.csv` | `density_error_mean`, `unconverged_steps`, "
    "`surface_share` |\n"
    "\n"
    "`tobiuo plot DIR` draws the tables. `tobiuo describe COLUMN` prints the meaning of a column. To "
    "read\n"
    "a table in Python, after `tobiuo run scenes/ball_drop`:\n"
    "\n"
    "```\n"
    "import csv\n"
    "for row in csv.DictReader(open(\"out/ball_drop/bodies.csv\")):\n"
    "    print(row[\"time\"], row[\"name\"], float(row[\"position_z\"]))\n"
    "```\n"
    "\n"
    "- Units are SI. In 2-D masses, forces, torques, energies and volumes are per metre of depth: the\n"
    "  header of a line is then `NAME_tension [N per m]`, that of a flow `NAME_flow [m2/s]`.\n"
    "- To see one body in a spreadsheet, filter the column `name`. `angle` of a body in 2-D counts whole\n"
    "  turns, too: 370 degrees is one turn and ten degrees.\n"
    "- Vectors are in axes of the domain. A force is positive towards the higher coordinate.\n"
    "- Columns `mean_...` are means over the time since the last output. Plot these. The others are of\n"
    "  the last step, and scatter from step to step.\n"
    "- Forces in `bodies.csv` are those of the liquids on the body and of the solids that touch it or are\n"
    "  `clamped_to` it. Torques are about its centre of mass.\n"
    "- Columns `elastic_energy` to `side_work` are of the method `mlsmpm`. Without it they are 0.\n"
    "- `kinetic_energy` + `potential_energy` + `body_kinetic_energy` + `body_potential_energy` +\n"
    "  `spring_energy` - `motion_work` + `joint_work` + `line_work` + `porous_work` - `force_work` -\n"
    "  `buoyancy_work` - `air_work` - `field_work` - `nest_work` falls by what a liquid loses else and by\n"
    "  contact. Inlets add to it, and so does what a frame or a central force gives liquids.\n"
    "- `motion_work`, `joint_work`, `line_work`, `porous_work`, `force_work`, `buoyancy_work`,\n"
    "  `air_work`, `field_work`, `nest_work`, `work` and `contact_work` know every step. They count on\n"
    "  over a resume.\n"
    "\n"
    "## Files of a run\n"
    "\n"
    "| file | content | written |\n"
    "|---|---|---|\n"
    "| `history.csv` | the whole run, a row per output | always |\n"
    "| `bodies.csv` | each body, a row per output and body | with bodies |\n"
    "| `solids.csv` | each solid, a row per output and solid | with solids |\n"
    "| `probes.csv` | sensors, a row per step or `output.probe_interval` | with probes |\n"
    "| `lines.csv`, `joints.csv` | lines; joints, hinges and guides; as many rows as `probes.csv` | with "
    "lines; with joints, hinges or guides |\n"
    "| `porous_zones.csv` | [porous zones](porous.md); as many rows as `probes.csv` | with porous zones |\n"
    "| `scalars.csv` | [temperature and concentration](scalars.md); as many rows as `probes.csv` | with "
    "`scalars` |\n"
    "| `fluid.pvd` | particles of the fluids and solids over time; `.vtu` in `fluid/` | with "
    "fluids or solids |\n"
    "| `bodies.pvd` | particles of the bodies over time; `.vtu` in `bodies/` | with bodies |\n"
    "| `all.pvd` | all of these in one list | always |\n"
    "| `BODY.pvd`, `line_LINE.pvd` | the surface of each body, each line; `.vtp` and `.stl` in "
    "`surfaces/` | unless `output.surfaces` is false |\n"
    "| `BODY_tractions.pvd` | pressure and shear on a body; `.vtp` in `tractions/` | with "
    "`output.tractions` |\n"
    "| `surface.pvd` | the surface of the liquids and of each piece; `.vtp` in `surface/` | with "
    "`output.surface.write`, or by `tobiuo surface` |\n"
    "| `foam.pvd` | [spray, foam and bubbles](foam.md); `.vtp` in `foam/` | by `tobiuo foam` |\n"
    "| `sample/` | [fields at places](sample.md): `.csv`, `.vti` with its `.pvd` | by `tobiuo sample` |\n"
    "| `waves.csv`, `wave_groups.csv`, `wave_spectra.csv`, `wave_responses.csv`, `wave_gains.csv` | "
    "[waves at gauges](waves.md) | by "
    "`tobiuo waves` |\n"
    "| `grid.pvd` | nodes of the grid of `mlsmpm`; in `grid/` | with `output.grid` |\n"
    "| `frames/` | a picture per output, `frame_000000.png`, and one of each view | with `--frames`, "
    "or by `tobiuo movie` |\n"
    "| `ply/`, `obj/` | positions of the fluid, surfaces of the bodies | with `output.ply`, "
    "`output.obj` |\n"
    "| `checkpoints/` | the state, for `tobiuo resume` | at the end, and every "
    "`output.checkpoint_interval` |\n"
    "| `resolved.json` | the scene with every default | always |\n"
    "| `inputs.json` | size and SHA-256 of each file that the scene names, and from which time on (s) the "
    "run has read it so | with such files |\n"
    "| `nests/NAME/` | the same files, of a [nest](nests.md) | with nests |\n"
    "| `summary.json` | see below | at the end |\n"
    "| `plots/`, `movie.mp4`, `picture.png`, `report.html` | curves, movie, picture, report | by "
    "`tobiuo plot`, `movie`, `picture`, `report` |\n"
    "\n"
    "| key of `summary.json` | meaning |\n"
    "|---|---|\n"
    "| `outcome` | `complete`, `interrupted`, `diverged`, `stalled` or `failed` |\n"
    "| `steps`, `time`, `wall_s`, `stages_s` | steps, simulated time (s), seconds that the run took, "
    "seconds of each stage |\n"
    "| `sensors` | least and largest value of each column of `probes.csv`, with their times (s) |\n"
    "| `pieces`, `piece_list` | number of pieces of the solids; mass (kg), volume (m3), centre (m) of "
    "each |\n"
    "| `state_hash` | equal for runs that end with the same bits |\n"
    "\n"
    "[ParaView](paraview.md) opens `.pvd`. The fields of the particles are those of `output.fields`.\n";

static const char sensors[] =
    "\n## probes.csv\n\n"
    "The first column is `time [s]`. The others begin with the name P of the [sensor](tanks.md#sensors),\n"
    "and end with the unit: `P_pressure [Pa]`. A cell is empty where a sensor with a `rate` of its own is\n"
    "not due.\n\n"
    "| kind | column | unit | meaning |\n|---|---|---|---|\n";

static const char joined[] =
    "\n## lines.csv and joints.csv\n\n"
    "The first column is `time [s]`. The others begin with the name of the\n"
    "[line](lines.md) or [joint](joints.md), or that of the body with the hinge or guide.\n\n"
    "| column | unit | meaning |\n|---|---|---|\n";

static const char *const zones =
    "\n## porous_zones.csv\n\n"
    "The first column is `time [s]`. The others begin with the name of the [zone](porous.md).\n\n"
    "| column | unit | meaning |\n|---|---|---|\n";

static const char *const scalars =
    "\n## scalars.csv\n\n"
    "The first column is `time [s]`. FIELD is `temperature` or `concentration`, WALL the name of a side\n"
    "or body with a [value or flux](scalars.md).\n\n"
    "| column | unit | meaning |\n|---|---|---|\n";

static const struct { const char *topic, *file, *doc; tobi_table table; } tables[] = {
    { "history", "history.csv", TR("The columns of history.csv: a row per output."), TOBI_TABLE_HISTORY },
    { "bodies", "bodies.csv", TR("The columns of bodies.csv: a row per output and body."),
     TOBI_TABLE_BODIES },
    { "solids", "solids.csv", TR("The columns of solids.csv: a row per output and solid."),
     TOBI_TABLE_SOLIDS },
    { "probes", "probes.csv", TR("The columns of probes.csv for a probe of kind point: NAME_pressure, ..."),
      TOBI_TABLE_POINT },
    { "probes", "probes.csv", TR("The columns of probes.csv for a probe of kind level: NAME_level."),
      TOBI_TABLE_LEVEL },
    { "probes", "probes.csv", TR("The columns of probes.csv for a probe of kind patch: NAME_pressure, ..."),
      TOBI_TABLE_PATCH },
    { "probes", "probes.csv", TR("The columns of probes.csv for a probe of kind run-up: NAME_run_up, ..."),
      TOBI_TABLE_RUN_UP },
    { "probes", "probes.csv", TR("The columns of probes.csv for a probe of kind flow: NAME_flow."),
      TOBI_TABLE_FLOW },
    { "probes", "probes.csv", TR("The columns of probes.csv for a probe of kind volume: NAME_volume."),
      TOBI_TABLE_VOLUME },
    { "lines", "lines.csv", TR("The columns of lines.csv for each line: NAME_tension, ..."),
     TOBI_TABLE_LINES },
    { "joints", "joints.csv", TR("The columns of joints.csv for each joint: NAME_force_x, ..."),
      TOBI_TABLE_JOINTS },
    { "zones", "porous_zones.csv", TR("The columns of porous_zones.csv for each zone: NAME_force_x, ..."),
      TOBI_TABLE_POROUS },
    { "scalars", "scalars.csv",
      TR("The columns of scalars.csv: temperature_min, ..., concentration_min, ..."),
      TOBI_TABLE_SCALARS },
    { "scalars", "scalars.csv",
      TR("The columns of scalars.csv for each side and body with a value or flux: "
         "NAME_temperature_flow, ..."),
      TOBI_TABLE_SCALAR_FLOWS },
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
    fprintf(out, "  %-27s %-7s %s\n", c->name, c->unit, is_above(c) ? tr("(as above)") : tr(c->doc));
}

int tobi_tables_describe(FILE *out, const char *topic)
{
    int found = 0;
    for (int k = 0; k < TABLES; k++) {
        if (strcmp(tables[k].topic, topic) != 0) continue;
        fprintf(out, "%s%s\n", found++ ? "\n" : "", tr(tables[k].doc));
        for (int i = 0; tobi_run_column(tables[k].table, i); i++) print_column(out, tables[k].table, i);
    }
    return found;
}

int tobi_tables_find(FILE *out, const char *name, int in_sentences)
{
    const tobi_column *c;
    int found = 0;
    for (int k = 0; k < TABLES; k++)
        for (int i = 0; (c = tobi_run_column(tables[k].table, i)); i++) {
            if (in_sentences ? !tobi_describe_says(tr(c->doc), name) : strcmp(c->name, name) != 0) continue;
            fprintf(out, tr("%s: column of %s, unit %s\n      %s\n"), c->name, tables[k].file, c->unit,
                    tr(find_meaning(tables[k].table, i)));
            found++;
        }
    return found;
}

const char *tobi_tables_topic(int index, const char **doc)
{
    static const char *const names[] = { "history", "bodies", "solids", "probes", "lines", "joints", "zones",
                                         "scalars", "tables" };
    static const char *const docs[] = { TR("The columns of history.csv, with units."),
                                        TR("Those of bodies.csv."), TR("Those of solids.csv."),
                                        TR("Those of probes.csv."),
                                        TR("Those of lines.csv."), TR("Those of joints.csv."),
                                        TR("Those of porous_zones.csv."), TR("Those of scalars.csv."),
                                        TR("The page of all columns, in Markdown (docs/tables.md).") };
    if (index < 0 || index >= (int)(sizeof names/sizeof *names)) return NULL;
    *doc = docs[index];
    return names[index];
}

/* Components of a vector share a row: `position_x`, `_y`, `_z`. Of sensors, the kind stands in front. prefix:
   of the columns, "P_". */
static void write_rows(FILE *out, tobi_table table, const char *kind, const char *prefix)
{
    const tobi_column *c, *next;
    for (int i = 0; (c = tobi_run_column(table, i)); i++) {
        const char *doc = c->doc;
        if (kind) fprintf(out, "| `%s` ", kind);
        fprintf(out, "| `%s%s`", prefix, c->name);
        while ((next = tobi_run_column(table, i + 1)) && !*next->doc) {
            fprintf(out, ", `%s`", strrchr(next->name, '_'));
            i++;
        }
        fprintf(out, " | %s | %s |\n", c->unit, doc);
    }
}

static void write_table(FILE *out, const char *file, tobi_table table)
{
    fprintf(out, "\n## %s\n\n| column | unit | meaning |\n|---|---|---|\n", file);
    write_rows(out, table, NULL, "");
}

char *tobi_tables_manual(void)
{
    static const char *const kinds[] = { "point", "level", "patch", "run-up", "flow", "volume" };
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out) return NULL;
    fputs(head, out);
    write_table(out, "history.csv", TOBI_TABLE_HISTORY);
    write_table(out, "bodies.csv", TOBI_TABLE_BODIES);
    write_table(out, "solids.csv", TOBI_TABLE_SOLIDS);
    fputs(sensors, out);
    for (int k = 0; k < 6; k++) write_rows(out, (tobi_table)(TOBI_TABLE_POINT + k), kinds[k], "P_");
    fputs(joined, out);
    write_rows(out, TOBI_TABLE_LINES, NULL, "LINE_");
    write_rows(out, TOBI_TABLE_JOINTS, NULL, "JOINT_");
    fputs(zones, out);
    write_rows(out, TOBI_TABLE_POROUS, NULL, "ZONE_");
    fputs(scalars, out);
    write_rows(out, TOBI_TABLE_SCALARS, NULL, "FIELD_");
    write_rows(out, TOBI_TABLE_SCALAR_FLOWS, NULL, "WALL_FIELD_");
    int failed = ferror(out);
    if (fclose(out) == 0 && !failed) return text;
    free(text);
    return NULL;
}
