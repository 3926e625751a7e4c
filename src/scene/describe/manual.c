/* The page about scenes. Only what no table knows is written here: conventions, the example, the
   words about editors. */
#define _GNU_SOURCE 1
#include "scene/describe/manual.h"
#include "scene/bind.h"
#include "scene/motions.h"
#include "scene/parts.h"
#include "base/param.h"
#include "tobiuo/tobiuo.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char head[] =
    "# Scenes\n"
    "\n"
    "<!-- Written by `tobiuo describe scene` from the tables that read scenes; do not edit. -->\n"
    "\n"
    "[日本語](scene.ja.md)\n"
    "\n"
    "A scene is one text file that says everything about a simulation: the box, the fluids or solids, the\n"
    "bodies, the output. `tobiuo check scene.json` finds every mistake at once, with line and column;\n"
    "`tobiuo run scene.json` runs it.\n"
    "\n"
    "## How it is written\n"
    "\n"
    "- JSON in UTF-8, with comments: `#` or `//` to the end of the line.\n"
    "- Units are SI (m, s, kg, N, Pa); angles are in degrees. Numbers are written without their unit.\n"
    "- A dot in a key below is an object inside an object: `domain.min` is\n"
    "  `\"domain\": { \"min\": [0, 0, 0] }`.\n"
    "- A vector is `[x, y, z]`. A 2-D scene (`\"dimension\": 2`) may write `[x, y]`.\n"
    "- `key[0]` and `key[1]` are the two entries of a list, lower and upper side; one word alone stands\n"
    "  for both: `\"walls\": { \"x\": \"periodic\", \"z\": [\"no-slip\", \"slip\"] }`.\n"
    "- Where a default is a word (`adaptive`, `all`), that word or a number may be written.\n"
    "- Relative paths of meshes, scripts and tables start at the scene's own folder.\n"
    "- Only plain files are read, no pipes and no devices: scenes of at most 16 MiB, scripts of 4 MiB,\n"
    "  keyframes of 1 GiB, meshes of 4 GiB.\n"
    "- A script runs in a process of its own, without files. A call may take 3 s of processor time (of\n"
    "  `deform` and `velocity`: 8192 points), and a script may hold 64 MiB.\n"
    "- `pairs` in a script goes through numbers, then texts, in rising order; `tostring` and\n"
    "  `string.format` show no addresses, and there is no `next`.\n"
    "- `centre`, `color` and `gray` may be written `center`, `colour` and `grey`.\n"
    "- Unknown keys are mistakes, and so are keys that the method or other keys leave unread. Nothing is\n"
    "  case-insensitive.\n"
    "\n"
    "## A complete example\n"
    "\n"
    "A tank of water, periodic along y, in which a box swings to and fro. The mesh, `box.obj`, is a cube\n"
    "with edges of 1 m:\n"
    "\n"
    "```\n"
    "v -0.5 -0.5 -0.5\nv  0.5 -0.5 -0.5\nv  0.5  0.5 -0.5\nv -0.5  0.5 -0.5\n"
    "v -0.5 -0.5  0.5\nv  0.5 -0.5  0.5\nv  0.5  0.5  0.5\nv -0.5  0.5  0.5\n"
    "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"
    "```\n"
    "\n"
    "The scene, `scene.json` beside it:\n"
    "\n"
    "```jsonc\n"
    "{\n"
    "  \"domain\": {\n"
    "    \"min\": [0, 0, 0],\n"
    "    \"max\": [0.4, 0.1, 0.3],\n"
    "    \"walls\": { \"y\": \"periodic\" }         // the other sides are slip walls\n"
    "  },\n"
    "  \"spacing\": 0.01,                        // m: 40 particles along the tank\n"
    "  \"end_time\": 1,                          // s\n"
    "  \"fluids\": [\n"
    "    {\n"
    "      \"name\": \"water\",\n"
    "      \"density\": 1000,                    // kg/m3\n"
    "      \"viscosity\": 1.0e-3,                // Pa s\n"
    "      \"fill\": [ { \"box\": { \"min\": [0, 0, 0], \"max\": [0.4, 0.1, 0.15] } } ]\n"
    "    }\n"
    "  ],\n"
    "  \"bodies\": [\n"
    "    {\n"
    "      \"name\": \"box\",\n"
    "      \"mesh\": \"box.obj\",\n"
    "      \"scale\": 0.05,                      // a cube of 5 cm\n"
    "      \"translation\": [0.2, 0.05, 0.08],\n"
    "      \"motion\": {\n"
    "        \"oscillation\": { \"direction\": [1, 0, 0], \"amplitude\": 0.05, \"frequency\": 2 }\n"
    "      }\n"
    "    }\n"
    "  ],\n"
    "  \"output\": { \"interval\": 0.02 }\n"
    "}\n"
    "```\n"
    "\n"
    "More scenes are in [scenes/](../scenes).\n"
    "\n"
    "Solids that deform, sand and snow are `solids`. Beside `fluids` they and the water press each other\n"
    "([water and solids](water_and_solids.md)). Without fluids they need `\"method\": \"mlsmpm\"`; a jelly\n"
    "that falls on a liquid of that method:\n"
    "\n"
    "```jsonc\n"
    "{\n"
    "  \"method\": \"mlsmpm\",\n"
    "  \"domain\": { \"min\": [0, 0, 0], \"max\": [0.5, 0.5, 0.6],\n"
    "              \"walls\": { \"x\": \"separate\", \"y\": \"separate\", \"z\": \"separate\" } },\n"
    "  \"spacing\": 0.02,                        // m: 8 particles per grid cell\n"
    "  \"end_time\": 0.5,\n"
    "  \"solids\": [\n"
    "    { \"name\": \"jelly\", \"density\": 800, \"youngs_modulus\": 5e4,\n"
    "      \"fill\": [ { \"sphere\": { \"centre\": [0.25, 0.25, 0.4], \"radius\": 0.1 } } ] },\n"
    "    { \"name\": \"water\", \"model\": \"liquid\", \"bulk_modulus\": 1e5,\n"
    "      \"fill\": [ { \"box\": { \"min\": [0, 0, 0], \"max\": [0.5, 0.5, 0.2] } } ] }\n"
    "  ],\n"
    "  \"output\": { \"interval\": 0.02, \"fields\": [\"usual\", \"stress\", \"J\"] }\n"
    "}\n"
    "```\n"
    "\n"
    "## Limits\n"
    "\n"
    "The tables below give the range of each number. Besides:\n"
    "\n"
    "- Nothing moves faster than 1e6 m/s: a body, a side or a start that does is refused, a particle that\n"
    "  gets there has diverged.\n"
    "- The domain is at most 2e5 spacings long for the SPH methods, 1e8 cells for mlsmpm.\n"
    "- A run has at most 1e9 steps. One whose steps get so short that its end lies farther away ends with\n"
    "  the outcome \"stalled\" in `summary.json`.\n"
    "\n"
    "## Changing a value for one run\n"
    "\n"
    "`--set PATH=VALUE`, as often as needed, for `check` and `run`. A path is made of keys and dots;\n"
    "entries of lists are named by number (`fill[0]` or `fill.0`) or by name. The value is JSON; what is\n"
    "not JSON is a text.\n"
    "\n"
    "```\n"
    "tobiuo run scene.json --set spacing=0.01 --set dfsph.support=3\n"
    "tobiuo run scene.json --set fluids.water.viscosity=0.1 --set 'fluids[0].density=998'\n"
    "tobiuo run scene.json --set 'domain.walls.y=[\"slip\", \"no-slip\"]' --set bodies=[]\n"
    "```\n"
    "\n"
    "## Editors\n"
    "\n"
    "[scene.schema.json](scene.schema.json) (`tobiuo describe schema`) tells an editor every key, its\n"
    "unit, range and default. Either name it in the scene,\n"
    "`\"$schema\": \"../../docs/scene.schema.json\"`, or put this into `.vscode/settings.json`, which also\n"
    "tells VS Code that scenes have comments:\n"
    "\n"
    "```json\n"
    "{\n"
    "  \"files.associations\": { \"scene.json\": \"jsonc\" },\n"
    "  \"json.schemas\": [ { \"fileMatch\": [\"scene.json\"], \"url\": \"./docs/scene.schema.json\" } ]\n"
    "}\n"
    "```\n"
    "\n"
    "Editors know `//` but not `#`: use `//` in scenes that you edit with one.\n"
    "\n"
    "An editor that reads schemas\n"
    "\n"
    "- completes keys with their defaults, and walls, motions, kernels and fields with their words;\n"
    "- shows sentence, unit, range and default of the key under the pointer;\n"
    "- marks unknown keys, wrong types and values out of range.\n"
    "\n"
    "The schema knows keys, types, ranges and words. What needs more than one value (corners, overlaps,\n"
    "names used twice, files, two components in a 3-D scene) only `tobiuo check` sees.\n";

/* Markdown has no way to write a bar inside a cell. */
static void write_cell(FILE *out, const char *text)
{
    fputs(" ", out);
    for (const char *c = text; *c; c++) fprintf(out, *c == '|' ? "\\|" : "%c", *c);
    fputs(" |", out);
}

const char *tobi_manual_type(const tobi_param *row)
{
    switch (row->type) {
    case TOBI_PARAM_REAL: return TR("number");
    case TOBI_PARAM_INT: return TR("whole number");
    case TOBI_PARAM_VEC3: return row->positive ? TR("number or vector") : TR("vector");
    case TOBI_PARAM_BOOL: return TR("true or false");
    case TOBI_PARAM_CHOICE: return TR("word");
    default:
        return strcmp(row->unit, "names") == 0           ? "list of names"
               : strcmp(row->unit, "points") == 0        ? "list of points"
               : strcmp(row->unit, "name or names") == 0 ? "name or list of names"
                                                         : row->unit;
    }
}

static int is_number(const tobi_param *row)
{
    return row->type == TOBI_PARAM_REAL || row->type == TOBI_PARAM_INT ||
           row->type == TOBI_PARAM_VEC3;
}

static void write_row(FILE *out, const tobi_param *row)
{
    char key[80], limits[200], usual[200];
    snprintf(key, sizeof key, "`%s`", row->key);
    tobi_bind_limits(row, limits, sizeof limits);
    tobi_bind_default(row, usual, sizeof usual);
    fputs("|", out);
    write_cell(out, key);
    write_cell(out, tobi_manual_type(row));
    write_cell(out, is_number(row) ? row->unit : "");
    write_cell(out, row->required ? "**required**" : usual);
    write_cell(out, is_number(row) || row->type == TOBI_PARAM_CHOICE ? limits : "");
    write_cell(out, row->doc);
    fputs("\n", out);
}

static void write_part(FILE *out, const tobi_part *part)
{
    static const char *const types[] = { "object", "list of objects", "object", "object", "text" };
    char key[80], count[80] = "";
    snprintf(key, sizeof key, "`%s`", part->key);
    if (part->form == TOBI_PART_LIST)
        snprintf(count, sizeof count, "%d to %d entries", part->least, part->most);
    fputs("|", out);
    write_cell(out, key);
    write_cell(out, types[part->form]);
    write_cell(out, "");
    write_cell(out, part->least > 0 ? "**required**" : "none");
    write_cell(out, count);
    write_cell(out, part->doc);
    fputs("\n", out);
}

static void write_table(FILE *out, const char *title, const tobi_param_table *table)
{
    tobi_part part;
    fprintf(out, "\n## %s\n\n%s\n\n", title, table->doc);
    fputs("| key | type | unit | default | allowed | meaning |\n"
          "|---|---|---|---|---|---|\n", out);
    for (const tobi_param *row = table->rows; row->key; row++) write_row(out, row);
    for (int i = 0; tobi_part_at(i, &part); i++)
        if (strcmp(part.owner, table->name) == 0) write_part(out, &part);
}

static void write_motions(FILE *out)
{
    const tobi_param_table *table;
    char title[100];
    for (int i = 0; (table = tobi_motion_table(i)); i++) {
        snprintf(title, sizeof title, i == 0 ? "`motion` by a %s" : "`motion.%s`", table->name);
        write_table(out, title, table);
    }
}

static void write_fields(FILE *out)
{
    const char *name, *unit;
    int components;
    fputs("\nFields that `fields` may list:\n\n"
          "| field | components | unit | of |\n|---|---|---|---|\n", out);
    for (int i = 0; (name = tobi_world_field_name(i, &components, &unit)); i++) {
        fprintf(out, "| `%s` | %d | %s |", name, components, unit);
        const char *method, *known;
        for (int m = 0; (method = tobi_method_name(m)); m++)
            for (int k = 0; (known = tobi_method_field(method, k)); k++)
                if (known == name) fprintf(out, " %s", method);
        fputs(tobi_body_has_field(i) ? " bodies |\n" : " |\n", out);
    }
    fputs("\n`bodies` are the particles in `bodies.pvd`, which has only fields of theirs. Their `density`\n"
          "is the scene's; `object_id` is 0 in fluids and solids and from 1 in bodies.\n\n"
          "Six components are xx, yy, zz, xy, yz, zx of a symmetric tensor, nine are a matrix by rows.\n"
          "`stress` is Cauchy's, `pressure` of a solid a third of minus its trace, `J` the volume over that\n"
          "at the start, `density` the density at the start over J. `deformation_gradient` is the elastic\n"
          "part where a model flows, and of a liquid only its determinant means something. `plastic` is the\n"
          "plastic strain of von-mises, the plastic part of J less 1 of snow, and the logarithm of the\n"
          "volume that loose sand has gained. `damage` of a solid with a strength goes from 0 to 1, where\n"
          "it is broken. `material` is the number of the solid, from 0.\n"
          "`part` is 0 at the surface of the start, 1 below it, 2 at the face of a cut.\n"
          "`piece` is the number of the connected piece of a solid, 0 = the heaviest, -1 in a liquid;\n"
          "`cut_side` the number of the latest cut near a particle, negative on one side, 0 = none.\n"
          "`texture_coordinates` are those that the mesh of the solid has (`vt` of an OBJ file) nearest to\n"
          "where the particle started, 0 without; a body's `.vtp` has those of its mesh.\n", out);
}

/* The parts of an owner and theirs, each under its path: "fluids[].fill[]". */
static void write_parts(FILE *out, const char *owner, const char *path)
{
    tobi_part part;
    for (int i = 0; tobi_part_at(i, &part); i++) {
        char inner[100], title[108];
        if (strcmp(part.owner, owner) != 0) continue;
        snprintf(inner, sizeof inner, "%s%s%s%s", path, path[0] ? "." : "", part.key,
                 part.form == TOBI_PART_LIST ? "[]" : "");
        snprintf(title, sizeof title, "`%s`", inner);
        if (part.table) write_table(out, title, part.table);
        if (part.table == &tobi_output_table) write_fields(out);
        if (part.form == TOBI_PART_MOTION && strcmp(owner, "body") == 0) write_motions(out);
        if (part.table) write_parts(out, part.table->name, inner);
    }
}

char *tobi_scene_manual(void)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out) return NULL;
    fputs(head, out);
    write_table(out, "The scene itself", &tobi_world_table);
    write_parts(out, tobi_world_table.name, "");
    int failed = ferror(out);
    if (fclose(out) == 0 && !failed) return text;
    free(text);
    return NULL;
}
