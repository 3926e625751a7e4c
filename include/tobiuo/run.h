/* Recording a run: steps a world and leaves its results in a directory.

   DIR/resolved.json            the scene with every default explicit (what the caller handed over)
   DIR/inputs.json              the files of its scene (tobi_scene_note_files)
   DIR/history.csv              one row per output: clock, solver, walls, energies, losses
   DIR/bodies.csv               one row per output and body: pose, rates, forces and torques
   DIR/probes.csv               one row per step: what the scene's probes measure, units in its header
   DIR/fluid.pvd, fluid/        the fluid's particles, VTU per output
   DIR/bodies.pvd, bodies/      the bodies' particles
   DIR/<body>.pvd, surfaces/    the body's moving surface, VTP and STL
   DIR/<body>_tractions.pvd, tractions/    pressure and shear on it, if asked
   DIR/grid.pvd, grid/          nodes of the grid of mlsmpm, if asked
   DIR/all.pvd                  the four above in one list: the same times, a part for each
   DIR/frames/                  pictures, if asked
   DIR/ply/, DIR/obj/           positions of the fluid, surfaces of the bodies, if asked
   DIR/checkpoints/             the last two states and the recorder's place in the files
   DIR/summary.json             totals

   Outputs happen at the multiples of the interval exactly, the first at 0; tobi_run_output_end makes one at
   the end besides, which stays when the run is resumed to a later end. Every file but the three tables
   appears whole or not at all; the tables grow by whole rows, and a resumed run cuts them back to
   its checkpoint. So a run that is killed at any moment can be resumed, and the files of run +
   resume equal those of one run, byte for byte, checkpoints too (except for the wall clock times in
   summary.json and beside the checkpoints).
   After a power cut the last checkpoint is whole, and so is all that was written before it; an output
   after it may be lost or empty until the run is resumed.

   DIR may be a link to a directory, but not the root of the file system. Inside DIR no link is followed
   and nothing but plain files is replaced: TOBI_INVALID. Somebody else must not change DIR meanwhile. */
#ifndef TOBIUO_RUN_H
#define TOBIUO_RUN_H
#include "tobiuo/tobiuo.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct tobi_run tobi_run;

/* What a run will write: an estimate, right within a factor of 1.5 where there are some thousand
   particles. */
typedef struct tobi_run_size {
    int64_t outputs;                /* from time 0 to the end, both included                    */
    double  files, bytes;           /* of all outputs and the last two checkpoints              */
    double  memory;                 /* bytes that taking an output needs, besides the world     */
} tobi_run_size;

/* Estimates a run from time 0 to `end` (s). Nothing is written or stepped; the particles of a world that
   has started are counted, of others estimated. Fails as tobi_run_create does for this output. */
TOBI_API tobi_status tobi_run_estimate(tobi_world *world, const tobi_output_def *output, double end,
                                       tobi_run_size *size, tobi_error *err);

/* TOBI_INVALID if dir holds results, which tobi_run_create does not replace without force. */
TOBI_API tobi_status tobi_run_check_directory(const char *dir, tobi_error *err);

/* Starts recording into dir, which is made with its parents if missing. Starts the world (see
   tobi_world_start) and writes the output at time 0. The world stays the caller's and must outlive
   the run; output is copied. resolved_json may be NULL (then no resolved.json and no resume by the
   command line). TOBI_INVALID if dir holds results and force is 0; with force, the files that a
   run writes are removed first, and nothing else. TOBI_INVALID for an unknown name in
   output->fields. TOBI_IO if dir cannot be written or another run is writing to it. */
TOBI_API tobi_status tobi_run_create(tobi_world *world, const tobi_output_def *output,
                                     const char *dir, int force, const char *resolved_json,
                                     tobi_run **run, tobi_error *err);

/* Goes on with the run in dir: loads its last whole checkpoint into the world (made by the same
   definitions, not started) and cuts the tables and series back to that time. Without any
   checkpoint the run begins again at time 0. TOBI_NOT_FOUND if dir holds no run, TOBI_DAMAGED if
   there are checkpoints and none is whole. */
TOBI_API tobi_status tobi_run_resume(tobi_world *world, const tobi_output_def *output,
                                     const char *dir, tobi_run **run, tobi_error *err);

/* What tobi_run_resume found worth telling ("resumed at ..."), "" if nothing. Owned by the run. */
TOBI_API const char *tobi_run_note(const tobi_run *run);

/* Pictures written so far, by the thread that writes, and the wall-clock seconds that it spent on them. */
TOBI_API int64_t tobi_run_pictures(const tobi_run *run, double *seconds);
/* What somebody has deleted of the results, "" if nothing is known: after tobi_run_resume what was
   missing then, after tobi_run_finish what is missing at the end. A run goes on without it: folders,
   tables and resolved.json are made again, lists leave out what is not there. Owned by the run. */
TOBI_API const char *tobi_run_losses(const tobi_run *run);

/* on = 1: from now on a file that cannot be written, because a disk is full, say, does not end the run and is
   no failure of the calls below. Files of an output are left out, rows of tables wait for room, the
   checkpoint of before stays; the next output tries again. */
TOBI_API void tobi_run_go_on(tobi_run *run, int on);
/* What could not be written: a sentence per kind of file, of its first failure, by index; NULL past the
   end. Owned by the run. May be called between steps; new sentences come last. */
TOBI_API const char *tobi_run_trouble(const tobi_run *run, int index);
/* Files that are missing by now for that reason, and rows of tables that wait; tobi_run_losses says which
   after tobi_run_finish. Files of outputs stay missing, when others are written again, too. */
TOBI_API int64_t tobi_run_unwritten(tobi_run *run);

/* One time step, not beyond `end` (s), then the output and the checkpoint that are due. info may be
   NULL; its energies, momentum and weight are those of the last output. When `end` is a multiple of
   the interval to within rounding, that multiple is the end.
   A thread of the run writes the output while the next steps are taken, and a step waits only while
   two outputs are not written; the step that reaches the end waits for all. TOBI_IO: an output could
   not be written, maybe an earlier one; the next call tries again. tobi_run_go_on changes that. */
TOBI_API tobi_status tobi_run_step(tobi_run *run, double end, tobi_step_info *info,
                                   tobi_error *err);
/* 1 when the world has reached `end` and no output is due. */
TOBI_API int tobi_run_done(const tobi_run *run, double end);

/* From now on the run steps a run of a nest of its world to the same times, saves its checkpoints with its
   own and ends it. The run of the nest stays the caller's and must outlive the last step of this one.
   TOBI_NO_MEMORY. */
TOBI_API tobi_status tobi_run_add_nest(tobi_run *run, tobi_run *nest, tobi_error *err);

/* Waits until every output so far is on the disk or one has failed, and tells that. */
TOBI_API tobi_status tobi_run_wait(tobi_run *run, tobi_error *err);

/* Writes an output of the present state, beside the steps. tobi_run_step does it when it is due; call
   it when stepping the world without tobi_run_step, at the times k interval. At another time it is one more,
   and the lists have its time; those at the multiples stay. */
TOBI_API tobi_status tobi_run_output(tobi_run *run, tobi_error *err);
/* The same, if the last output is of an earlier time: at the end of a run, before the last checkpoint. */
TOBI_API tobi_status tobi_run_output_end(tobi_run *run, tobi_error *err);
/* Waits for the outputs and writes a checkpoint; the two newest are kept. None is written if the last
   one is of this step. */
TOBI_API tobi_status tobi_run_checkpoint(tobi_run *run, tobi_error *err);

/* Waits for the outputs and writes summary.json. outcome: "complete", "interrupted", "diverged",
   "stalled", "failed" (a script, memory) or another word; "failed" in any case if an output could not be
   written, and then its failure is told. */
TOBI_API tobi_status tobi_run_finish(tobi_run *run, const char *outcome, tobi_error *err);

/* Waits for the outputs and closes the files; NULL is fine. A run that was not finished stays
   resumable. */
TOBI_API void tobi_run_free(tobi_run *run);

/* The tables of a run; probes.csv has columns by the kinds of its sensors, lines.csv, joints.csv and
   porous_zones.csv for each line, joint and zone, scalars.csv for each scalar and each wall that has one. */
typedef enum tobi_table {
    TOBI_TABLE_HISTORY, TOBI_TABLE_BODIES, TOBI_TABLE_POINT, TOBI_TABLE_LEVEL, TOBI_TABLE_PATCH,
    TOBI_TABLE_RUN_UP, TOBI_TABLE_FLOW, TOBI_TABLE_VOLUME,     /* in the order of tobi_probe_kind */
    TOBI_TABLE_SOLIDS, TOBI_TABLE_LINES, TOBI_TABLE_JOINTS, TOBI_TABLE_POROUS,
    TOBI_TABLE_SCALARS, TOBI_TABLE_SCALAR_FLOWS
} tobi_table;
typedef struct tobi_column {
    const char *name, *unit;        /* "1": without a unit                                      */
    const char *doc;                /* "": as the column before                                 */
} tobi_column;
/* The columns of a table by index, NULL past the end. In tables of probes, lines, joints and zones the names
   follow that of the probe, line, joint or zone and "_". */
TOBI_API const tobi_column *tobi_run_column(tobi_table table, int index);
/* The unit of a column's values in a world of 2 or 3 dimensions: in 2-D "N" is "N per m", "m3" is "m2". */
TOBI_API const char *tobi_run_unit(const char *unit, int dimension);

#ifdef __cplusplus
}
#endif
#endif
