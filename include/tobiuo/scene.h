/* Scenes: a whole simulation in one JSON text, in a file or in memory; docs/scene.md has every key. A scene
   can do no more than a C program can: building one calls only tobiuo.h.

   The format: JSON in UTF-8 with comments (# or // to the end of the line), SI units, angles in
   degrees. Relative paths are looked up beside the scene file. */
#ifndef TOBIUO_SCENE_H
#define TOBIUO_SCENE_H
#include "tobiuo/tobiuo.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct tobi_scene tobi_scene;

/* Everything that is wrong with a scene, one line each:
   `file:line:column: path: what is wrong, what is allowed, did you mean`. */
typedef struct tobi_report tobi_report;
TOBI_API int         tobi_report_count(const tobi_report *report);          /* NULL: 0 */
TOBI_API const char *tobi_report_line(const tobi_report *report, int line); /* NULL past the end */
TOBI_API void        tobi_report_free(tobi_report *report);                 /* NULL is fine */

/* Reads and checks a scene, without creating a world.
   overrides: "path=value" texts ended by NULL, or NULL; applied in order before the check, for
   example "spacing=0.008", "dfsph.support=3", "fluids[0].viscosity=0.1" or
   "fluids.water.viscosity=0.1" (entries of a list by number or by name). The value is JSON;
   anything that is not JSON is a text. On success *scene is owned by the caller and *report is
   NULL. On failure *scene is NULL; TOBI_INVALID comes with all mistakes in *report (owned by the
   caller; report may be NULL) and as many of them as fit in err; TOBI_NOT_FOUND, TOBI_IO and
   TOBI_NO_MEMORY with a text in err.
   Each Lua script of the scene runs in a child process until the scene is freed. It is forked here, so a
   scene is best loaded before the process holds much memory, and only the process that loaded it can
   step its world; which of its threads do so does not matter. */
TOBI_API tobi_status tobi_scene_load(const char *path, const char *const *overrides,
                                     tobi_scene **scene, tobi_report **report, tobi_error *err);
/* The same from `size` bytes of text in memory, which the call does not keep; no 0 need end them. name is the
   path that the text would have: it stands in messages, names the scene, and relative paths are looked up
   beside it. No such file need exist; if it ends in .py, the text is Python's, of the Taichi program.
   TOBI_INVALID for texts above 16 MiB. */
TOBI_API tobi_status tobi_scene_parse(const char *name, const char *text, size_t size,
                                      const char *const *overrides, tobi_scene **scene, tobi_report **report,
                                      tobi_error *err);
/* NULL is fine. Frees the motions too, so a world built from the scene must be destroyed before. */
TOBI_API void tobi_scene_free(tobi_scene *scene);

/* Creates the world of the scene with its fluids, bodies and motions. On failure *world is NULL. */
TOBI_API tobi_status tobi_scene_build(tobi_scene *scene, tobi_world **world, tobi_error *err);

/* Puts file, line and column of err->key in front of a text: for what tobi_world_start or tobi_run_create
   refuses of a world that was built from the scene. Without a key nothing changes. */
TOBI_API void tobi_scene_place_error(tobi_scene *scene, tobi_error *err);

/* Owned by the scene. The name is that of the scene's directory if the file is scene.json, or else
   the file's name without its extension. */
TOBI_API const char *tobi_scene_name(const tobi_scene *scene);
TOBI_API const tobi_world_def  *tobi_scene_world_def(const tobi_scene *scene);
TOBI_API const tobi_output_def *tobi_scene_output_def(const tobi_scene *scene);
/* The data that the scene names for comparison, NULL past the end. Only their files' existence was
   checked. */
TOBI_API const tobi_reference_def *tobi_scene_reference(const tobi_scene *scene, int index);

/* The absolute path of a file that the scene is computed from or drawn with: a mesh, picture, script or table
   (motions, inlets, gravity). NULL past the end; a file named twice comes twice. Owned by the scene. */
TOBI_API const char *tobi_scene_file(const tobi_scene *scene, int index);
/* Writes DIR/inputs.json: path, size and SHA-256 of each of these files, and the time, s, from which on the
   run in dir has read it so. Call it with time 0 after tobi_run_create, and with the time of the world after
   tobi_run_resume; a file that has changed gets a second entry then. Without such files nothing is written.
   TOBI_NOT_FOUND, TOBI_IO: a file cannot be read, or the list not be written. */
TOBI_API tobi_status tobi_scene_note_files(const tobi_scene *scene, const char *dir, double time,
                                           tobi_error *err);
/* 1 if the last entry of this file in DIR/inputs.json is of another content, 0 if not or if there is none. */
TOBI_API int tobi_scene_file_changed(const tobi_scene *scene, const char *dir, int index);

/* Scenes of the Taichi program (SPH_Taichi and its relatives; they have a key `Configuration`) are loaded
   like any other: translated first, so overrides are those of the native scene. This is what became of each
   of their keys, as a table for people with units and remarks; NULL for a native scene. Owned by it. */
TOBI_API const char *tobi_scene_import_table(const tobi_scene *scene);
/* The program whose scene it was, "the Taichi program" or "the tank program" (setting.json and the object
   files that it names, read in the same way); NULL for a native scene. */
TOBI_API const char *tobi_scene_import_program(const tobi_scene *scene);
/* Translates such a scene into the file new_path, which appears whole or not at all: the native scene, with
   the table in front as comments. Loading it gives the same scene bit for bit. Paths of files are relative
   to new_path where they lie below its folder, absolute elsewhere. *table (owned by the caller, free()) is
   the table; NULL after a failure, as for tobi_scene_load, or TOBI_INVALID if the scene is native already
   or, with force 0, if new_path exists. */
TOBI_API tobi_status tobi_scene_import(const char *old_path, const char *new_path, int force, char **table,
                                       tobi_report **report, tobi_error *err);

/* A nest as the scene has it; NULL past the end. Owned by the scene. */
TOBI_API const tobi_nest_def *tobi_scene_nest_def(const tobi_scene *scene, int index);
/* The nests of a scene, each a world of its own (tobi_world_nest); none is fine. The scene and the outer
   world must outlive them. Fails as tobi_scene_build and tobi_world_nest do. */
typedef struct tobi_nests tobi_nests;
enum { TOBI_NESTS_CREATE, TOBI_NESTS_REPLACE, TOBI_NESTS_RESUME };
struct tobi_run;
struct tobi_run_size;
TOBI_API tobi_status tobi_nests_create(tobi_scene *scene, tobi_world *outer, tobi_nests **nests,
                                       tobi_error *err);
/* 0 for NULL. */
TOBI_API int tobi_nests_count(const tobi_nests *nests);
/* The world of a nest and, if name is not NULL, its name; NULL past the end. Both owned by the nests. */
TOBI_API tobi_world *tobi_nests_world(const tobi_nests *nests, int nest, const char **name);
/* m: of its particles; 0 past the end. */
TOBI_API double tobi_nests_spacing(const tobi_nests *nests, int nest);
/* Steps each to the time of the outer world, and feeds that: before the first and after each step of it
   (tobi_world_step_to), without a run. Fails as tobi_world_step does; called again, it goes on. */
TOBI_API tobi_status tobi_nests_follow(tobi_nests *nests, tobi_error *err);
/* Before the run of the outer world is made in dir: starts it and them, and looks whether tobi_nests_record
   could do its part there, so that a mistake costs no results. Fails as that and tobi_world_start do. */
TOBI_API tobi_status tobi_nests_prepare(tobi_nests *nests, const char *dir, int how, tobi_error *err);
/* Adds files and bytes of their runs up to `end`, s, as tobi_run_estimate finds them, and the memory. */
TOBI_API tobi_status tobi_nests_estimate(tobi_nests *nests, double end, struct tobi_run_size *size,
                                         tobi_error *err);
/* Records each in the folder nests/NAME of dir, where `run` records the outer world: from then on `run` steps
   them. Fails as tobi_run_create and tobi_run_resume do. */
TOBI_API tobi_status tobi_nests_record(tobi_nests *nests, struct tobi_run *run, const char *dir, int how,
                                       tobi_error *err);
/* Frees their runs; the worlds stay. After the run of the outer world; NULL is fine. */
TOBI_API void tobi_nests_close(tobi_nests *nests);
/* After the run of the outer world; NULL is fine. */
TOBI_API void tobi_nests_free(tobi_nests *nests);

/* The scene as JSON with every default made explicit and paths of files made absolute, so that it
   can be kept in any directory of the same machine; loading it gives the same scene bit for bit.
   Owned by the caller (free()). NULL when out of memory. */
TOBI_API char *tobi_scene_resolved(const tobi_scene *scene);

/* A file that comes with Tobiuo, "flying_fish/scene.json", or with "." the folder of all scenes, by its
   absolute path: beside the library (share/tobiuo/scenes of an installation, scenes of the source tree).
   Owned by the caller (free()); NULL if it cannot be found. */
TOBI_API char *tobi_scene_shipped(const char *name);

/* Parameters, units, defaults and ranges of a topic, as text: a method ("dfsph"), "world", "fluid",
   "fill", "body", "motion", "output" or "reference"; "history", "bodies" or "probes" are the columns of the
   tables of a run. "scene" is the page of all keys in Markdown (docs/scene.md), "tables" that of all columns
   (docs/tables.md), "schema" a JSON Schema (draft-07) for editors; NULL lists the topics. Any other word is
   looked for in all keys, fields and columns: "camera", "output.camera"; if none is called so, in the
   sentences of keys and columns: "shear". Owned by the caller (free()). NULL if there is nothing of it. */
TOBI_API char *tobi_scene_describe(const char *topic);
/* The topic, key, field or column that a misspelt word may mean; owned by the caller (free()), NULL if none
   is near. */
TOBI_API char *tobi_scene_suggest(const char *word);
/* The candidate nearest to word by edit distance, if it is near enough to be a slip of the pen, or else NULL.
   Case, '-' and '_' do not count. */
TOBI_API const char *tobi_suggest(const char *word, const char *const *candidates, size_t count);

#ifdef __cplusplus
}
#endif
#endif
