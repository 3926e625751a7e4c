/* The recorder's insides, shared by record_*.c. See tobiuo/run.h for what it promises.

   An output is a snapshot, taken from the world by the caller's thread, and then files, written by a
   thread of the run. What a resumed run must know besides the world itself is in two tobi_tally and a
   few totals; record/state.c saves them beside each checkpoint. Everything else follows from the
   world's time.
 */
#pragma once
#include "base/error.h"
#include "io/csv.h"
#include "io/pvd.h"
#include "io/vtk.h"
#include "record/line_tube.h"
#include "tobiuo/drawing.h"
#include "tobiuo/run.h"
#include "tobiuo/surface.h"
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>

/* Sums over steps. */
typedef struct tobi_tally {
    int64_t steps;                        /* in the sums below                       */
    int64_t unconverged;                  /* steps in which a solver ran out of iterations */
    double density_iterations, divergence_iterations;   /* sums                      */
    double density_error_mean;            /* sum of the steps' means                 */
    double density_error_max;             /* largest                                 */
    double residual_max;                  /* largest pressure_residual               */
} tobi_tally;

/* Impulses of the fluid on one body since the last output: pressure force, viscous force, pressure torque,
   viscous torque, each times time, N s and N m s. */
enum { TOBI_BODY_FORCES = 7 };
typedef struct tobi_body_tally { double time, impulse[TOBI_BODY_FORCES][3]; } tobi_body_tally;
typedef struct tobi_solid_tally { double time, impulse[3]; } tobi_solid_tally;    /* of liquids */

/* Work since the start, J: of each body as tobi_body.power, taken by each joint, by all lines, by each porous
   zone, and what came through each wall of scalars; in 2-D how far each body has turned, rad. */
typedef struct tobi_works {
    double (*body)[TOBI_POWERS], *joint, lines, *angle, *porous, *scalar, buoyancy;
} tobi_works;

/* One field to write. */
typedef struct tobi_record_field {
    const char *name;                     /* of the world's list                     */
    int components;
    int type;                             /* tobi_type in files                  */
    int bodies;                           /* 1: of their particles too               */
} tobi_record_field;

enum { TOBI_RECORD_FIELD_LIMIT = 32 };

/* A picture of each output; the texts of def are not used after creation. */
typedef struct tobi_record_view {
    tobi_view_def def;
    char name[104];                       /* frames/NAME_000000.png                  */
    tobi_record_field field;              /* that colours it; name NULL = none       */
    int follow;                           /* body of the camera, or -1               */
} tobi_record_view;

/* A field of the surface, or one component of it. */
typedef struct tobi_record_surface_field {
    tobi_record_field of;
    int component;                        /* -1: all                                 */
    char name[40];
} tobi_record_surface_field;

/* What has particles or nodes in a file of its own: folder NAME, files NAME_000000.vtu. */
enum { TOBI_SET_FLUID, TOBI_SET_BODIES, TOBI_SET_GRID, TOBI_SETS };
typedef struct tobi_point_set {
    int64_t count;
    double (*position)[3];
    tobi_vtk_array array[TOBI_RECORD_FIELD_LIMIT];      /* data owned */
    int arrays;
} tobi_point_set;

/* All that the files of one output hold. */
typedef struct tobi_snapshot {
    int64_t number;                       /* of the output                           */
    tobi_point_set set[TOBI_SETS];
    double (**surface)[3];                /* vertices of each body; NULL: it is absent */
    int surfaces;
    tobi_line_tube *tube;                 /* of each line                            */
    int lines;
    tobi_moment moment;                   /* for pictures; surfaces and positions are those above */
    struct tobi_tractions *tractions;     /* of each body; NULL: not asked           */
    struct tobi_drawing *drawing[1 + TOBI_VIEW_LIMIT];      /* of each view; NULL: no picture */
    struct tobi_record_surface *skin;     /* NULL: no surface                        */
    tobi_csv_rows bodies, solids, history;
    int tables_written;                   /* of bodies and solids, so that a second try adds no row twice */
} tobi_snapshot;

/* A column of probes.csv: its low pass, and the extremes of what was written. */
typedef struct tobi_sensor_state {
    double y, v, last;                    /* filtered value, its rate, the last raw value */
    double max, max_time, min, min_time;
    int begun, noted;                     /* 1: there are values in the first, the second line */
} tobi_sensor_state;

/* Kinds of files, for what is said of those that cannot be written. */
typedef enum tobi_record_kind {
    TOBI_KIND_PARTICLES, TOBI_KIND_SURFACES, TOBI_KIND_COPIES, TOBI_KIND_PICTURES, TOBI_KIND_LISTS,
    TOBI_KIND_TABLES, TOBI_KIND_CHECKPOINTS, TOBI_KIND_SUMMARY, TOBI_KINDS
} tobi_record_kind;
typedef struct tobi_trouble {
    int64_t files, first, last;           /* not written; outputs, the first and the last */
    bool fails, told;                     /* the last of the kind failed; one was told    */
} tobi_trouble;

/* An output at no multiple of the interval: its number, the multiple that comes next, its time in s. */
typedef struct tobi_aside {
    int64_t number, beat;
    double time;
} tobi_aside;

struct tobi_run {
    tobi_world *world;
    tobi_output_def output;               /* fields is not used after creation       */
    char *dir;
    int lock;                             /* descriptor of dir, locked               */
    pthread_mutex_t dir_lock;             /* of the descriptor, and of making folders */
    char *resolved;                       /* text of resolved.json, NULL = there is none */
    int64_t history_missing;              /* rows that somebody cut out of history.csv, at a resume */
    char note[1024], losses[1536];        /* texts for the user                      */
    bool lost_dir;                        /* dir was deleted and made again          */
    tobi_record_field field[TOBI_RECORD_FIELD_LIMIT];
    int field_count;
    tobi_record_view view[1 + TOBI_VIEW_LIMIT];
    int view_count;
    int64_t pictures, picture_ns;         /* written; wall clock: atomic             */
    tobi_record_surface_field surface_field[TOBI_SURFACE_FIELD_LIMIT];
    int surface_fields;
    char (*body_file)[96];                /* names of the bodies' surface files      */
    char (*traction_file)[96];            /* of their tractions                      */
    char (*line_file)[96];                /* of the lines'                           */
    tobi_moment tracks;                   /* of the centres of bodies, if a view shows them  */
    tobi_looks looks;                     /* for pictures; its lists are empty before */
    struct tobi_skin *skin;               /* of bodies with a texture; NULL = none   */
    int skin_count;
    tobi_run **nest;                      /* runs of nests, the callers'             */
    int nest_count;
    tobi_run *outer;                      /* of a nest: guarded by trouble_lock      */
    struct tobi_writer *writer;
    tobi_pvd *list;                       /* of each series, then of all             */
    int series;
    int64_t listed, missing;              /* outputs in the lists; files that should be there */

    tobi_csv *history, *bodies, *solids, *probes, *lines, *joints, *porous, *scalars;   /* NULL: none */
    int64_t outputs;                      /* taken so far = number of the next       */
    pthread_mutex_t aside_lock;           /* of the next three, which the writer only reads */
    tobi_aside *aside;                    /* those at no multiple of the interval, in order */
    int64_t aside_count, aside_room;
    tobi_tally since, total;              /* since the last output; of the run       */
    tobi_body_tally *body_since;          /* one per body                            */
    tobi_solid_tally *solid_since;        /* one per solid                           */
    tobi_works works;
    tobi_sensor_state *sensor;            /* one per column of probes.csv; NULL = none */
    double wall, step_wall;               /* s, earlier sessions + this one          */
    double begun;                         /* s, monotonic clock at the start         */
    double particle_steps;                /* sum of fluid particles over steps       */
    bool goes_on;                         /* files that cannot be written are passed over */
    pthread_mutex_t trouble_lock;         /* of the next three                       */
    tobi_trouble trouble[TOBI_KINDS];
    char *told[TOBI_KINDS*(1 + TOBI_NEST_LIMIT)];    /* of this run and of its nests     */
    int told_count;                       /* atomic                                  */
    int64_t checkpoint_step;              /* of the last checkpoint, -1 = none       */
    int64_t checkpoint_outputs;           /* that it counts                          */
    double next_checkpoint;               /* s                                       */
};

/* record/files.c: the directory. */
/* dir/format..., owned by the caller; NULL without memory. */
char *tobi_record_path(const char *dir, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
/* Makes dir and its parents, tells whether it holds results, locks it against other runs. */
tobi_status tobi_record_open_dir(const char *dir, int *lock, tobi_error *err);
tobi_status tobi_record_find_results(const char *dir, bool *found, tobi_error *err);
/* Removes the files a run writes, with `only_parts` only unfinished ones. */
tobi_status tobi_record_clear(const char *dir, bool only_parts, tobi_error *err);
/* Likewise of the nests that the scene in this text has; NULL, or no scene, is fine. */
tobi_status tobi_record_clear_nests(const char *dir, const char *resolved, tobi_error *err);
tobi_status tobi_record_make_dir(const char *dir, const char *name, tobi_error *err);
/* Makes what was deleted of the run's directory and its folders again. */
tobi_status tobi_record_keep_dir(tobi_run *run, tobi_error *err);
/* Whether somebody has deleted a folder since it was looked for. */
bool tobi_record_is_folder_gone(const tobi_run *run);
/* Steps of the checkpoints in dir, newest first; at most limit. -1: they cannot be listed. */
int tobi_record_checkpoints(const char *dir, int64_t *steps, int limit);

/* record/trouble.c: what could not be written of a run that goes on. */
/* TOBI_IO becomes TOBI_OK and is noted, if the run goes on; TOBI_OK ends the trouble of a kind that is no
   file per output. Any thread. */
tobi_status tobi_trouble_pass(tobi_run *run, tobi_record_kind kind, int64_t output, tobi_status status,
                              const tobi_error *err);
/* Whether the last file of the kind failed. */
bool tobi_trouble_lasts(tobi_run *run, tobi_record_kind kind);
/* "pictures not written: 3, of outputs 4 to 6; ": its length. */
int tobi_trouble_write(tobi_run *run, char *text, size_t room);
void tobi_trouble_free(tobi_run *run);

/* record/tables.c: history.csv, bodies.csv and probes.csv. */
/* Opens them: new, or continued after the rows up to the last output, or up to the world's time. */
tobi_status tobi_tables_open(tobi_run *run, bool continued, tobi_error *err);
/* Of a run that is resumed, once they are open: run->history_missing. */
void tobi_tables_count_missing(tobi_run *run);
/* The rows of an output: made, and written. */
tobi_status tobi_tables_take(tobi_run *run, tobi_snapshot *snapshot, tobi_error *err);
tobi_status tobi_tables_write(tobi_run *run, tobi_snapshot *snapshot, tobi_error *err);
/* record/probes.c: whether a multiple of `every`, s, lies in (before, now]; 0: it does in each step. */
bool tobi_record_is_due(double every, double before, double now);
/* record/lines.c: lines.csv, as often as probes.csv. */
tobi_status tobi_lines_open(tobi_run *run, bool continued, tobi_error *err);
tobi_status tobi_lines_write(tobi_run *run, double before, tobi_error *err);
/* record/joints.c: joints.csv, likewise. */
tobi_status tobi_joints_open(tobi_run *run, bool continued, tobi_error *err);
tobi_status tobi_joints_write(tobi_run *run, double before, tobi_error *err);
/* record/porous.c: porous_zones.csv, likewise. */
tobi_status tobi_porous_open(tobi_run *run, bool continued, tobi_error *err);
tobi_status tobi_porous_write(tobi_run *run, double before, tobi_error *err);
/* record/scalars.c: scalars.csv, likewise. */
tobi_status tobi_scalars_open(tobi_run *run, bool continued, tobi_error *err);
tobi_status tobi_scalars_write(tobi_run *run, double before, tobi_error *err);
/* A table of the run: new, or continued after the rows up to `time`. */
tobi_status tobi_table_open(const tobi_run *run, const char *name, bool continued, double time,
                            const tobi_csv_column *columns, int count, tobi_csv **csv, tobi_error *err);
enum { TOBI_TABLES = 8 };
/* All tables, NULL where there is none. */
void tobi_tables_list(const tobi_run *run, tobi_csv *tables[TOBI_TABLES]);
/* Tries to write rows that wait; how many do. */
tobi_status tobi_tables_flush(tobi_run *run, tobi_error *err);
int64_t tobi_tables_waiting(const tobi_run *run);
void tobi_tally_add(tobi_tally *tally, const tobi_step_info *info);
void tobi_tally_bodies(tobi_run *run, double dt);
void tobi_tally_solids(tobi_run *run, double dt);
/* works.c: room for them; 0: there is no memory. What a step did; the work on all bodies by
   one of TOBI_BY_PARTICLES ..., and of all joints. */
bool tobi_works_open(tobi_run *run);
void tobi_works_free(tobi_run *run);
void tobi_works_add(tobi_run *run, double dt);
double tobi_works_bodies(const tobi_run *run, int by);
double tobi_works_joints(const tobi_run *run);
double tobi_works_porous(const tobi_run *run);
/* For checkpoints; older ones have none: json NULL, works count from there on. */
struct json_t *tobi_works_to_json(const tobi_run *run);
bool tobi_works_from_json(const struct json_t *json, tobi_run *run);

/* record_probes.c: probes.csv. */
tobi_status tobi_probes_open(tobi_run *run, bool continued, tobi_error *err);
/* The row that is due after the step from `before`, if any. */
tobi_status tobi_tables_write_probes(tobi_run *run, double before, tobi_error *err);
/* A low pass of first (order 0) or second order (Butterworth), cutoff in Hz, 0 = none; x: the raw value
   after a
   step of dt, s. f->y is the filtered one. */
void tobi_sensor_pass(tobi_sensor_state *f, double cutoff, int order, double dt, double x);
/* The state of all columns in a checkpoint, and the extremes in summary.json. */
struct json_t *tobi_probes_to_json(const tobi_run *run);
bool tobi_probes_from_json(struct json_t *list, tobi_run *run);
struct json_t *tobi_probes_sum_up(const tobi_run *run);

/* record/snapshot.c: what an output holds, from the world. */
tobi_status tobi_snapshot_take(tobi_run *run, tobi_snapshot **snapshot, tobi_error *err);
/* NULL is fine. */
void tobi_snapshot_free(tobi_snapshot *snapshot);
/* What the surfaces needed. */
void tobi_snapshot_free_skins(tobi_run *run);

/* record/series.c: VTU, VTP, STL, PNG and PVD. */
/* Reads "velocity,pressure" of output.fields into run->field. */
tobi_status tobi_series_fields(tobi_run *run, tobi_error *err);
/* Names, folders and empty lists. */
/* A field of the world's methods; key: of the scene, for the message. */
tobi_status tobi_record_find_field(const tobi_run *run, const char *key, const char *name, size_t length,
                                   tobi_record_field *field, tobi_error *err);
tobi_status tobi_series_prepare(tobi_run *run, tobi_error *err);
tobi_status tobi_series_folders(const tobi_run *run, tobi_error *err);
/* The files of an output, then the lists including it. */
tobi_status tobi_series_write(tobi_run *run, const tobi_snapshot *snapshot, tobi_error *err);
/* The lists anew, of what is there of outputs 0 .. run->outputs - 1; the rest is run->missing. */
tobi_status tobi_series_lists(tobi_run *run, tobi_error *err);
void tobi_series_free(tobi_run *run);

/* record/tractions.c: pressure and shear on the surface of each body, in pieces. */
tobi_status tobi_tractions_take(tobi_run *run, tobi_snapshot *snapshot, tobi_error *err);
/* Those of one body. */
tobi_status tobi_tractions_write(tobi_run *run, const tobi_snapshot *snapshot, int body, tobi_error *err);
void tobi_tractions_free(tobi_snapshot *snapshot);

/* record/names.c: names of the files of bodies, of their tractions and of lines; the caller frees them. */
typedef char tobi_record_name[96];
tobi_status tobi_record_name_bodies(const tobi_world *world, tobi_record_name **body,
                                    tobi_record_name **traction, tobi_record_name **line, tobi_error *err);
/* Whether there are fluids that differ, be it in colour alone. */
bool tobi_record_has_kinds(const tobi_world *world);
/* run->looks, which are found once. */
tobi_status tobi_record_find_looks(tobi_run *run, tobi_error *err);
/* Whether a blade or a crack may part a solid. */
bool tobi_record_has_pieces(const tobi_world *world);

/* record/frames.c: the pictures of an output, which has its particles and surfaces already. */
/* The views of run->output, with what they name. */
tobi_status tobi_frames_prepare(tobi_run *run, tobi_error *err);
tobi_status tobi_frames_take(tobi_run *run, tobi_snapshot *snapshot, tobi_error *err);
/* That of one view. */
tobi_status tobi_frames_write(tobi_run *run, const tobi_snapshot *snapshot, int view, tobi_error *err);
void tobi_frames_free(tobi_snapshot *snapshot);

/* record/skins.c: the image and coordinates of a solid or body, if it has a texture. On failure the looks are
   still to be freed. */
tobi_status tobi_skins_of_solid(const tobi_world *world, int solid, int material, tobi_looks *looks,
                                tobi_error *err);
tobi_status tobi_skins_of_body(const tobi_world *world, int body, tobi_body_look *look, tobi_error *err);

/* record/surface.c: the surface of fluids and solids of an output, which has its particles already. */
/* Reads output.surface_fields. */
tobi_status tobi_record_surface_fields(tobi_run *run, tobi_error *err);
tobi_status tobi_record_take_surface(tobi_run *run, tobi_snapshot *snapshot, tobi_error *err);
tobi_status tobi_record_write_surface(tobi_run *run, const tobi_snapshot *snapshot, int unused,
                                      tobi_error *err);
void tobi_record_free_surface(struct tobi_record_surface *surface);

/* record/writer.c: the thread. */
tobi_status tobi_writer_start(tobi_run *run, tobi_error *err);
/* A snapshot to write, owned by the writer after TOBI_OK. Waits while it has two. */
tobi_status tobi_writer_put(struct tobi_writer *writer, tobi_snapshot *snapshot, tobi_error *err);
/* What has failed since the last call of put, check or wait; it is tried again after that. */
tobi_status tobi_writer_check(struct tobi_writer *writer, tobi_error *err);
/* Waits until all is written, or something fails. */
tobi_status tobi_writer_wait(struct tobi_writer *writer, tobi_error *err);
/* Snapshots that are not written. */
int tobi_writer_pending(struct tobi_writer *writer);
/* Writes what can be written and ends the thread; NULL is fine. */
void tobi_writer_free(struct tobi_writer *writer);

/* record/state.c: checkpoints. */
tobi_status tobi_state_save(tobi_run *run, tobi_error *err);
/* Loads the newest whole checkpoint; *found = false if there is none at all. */
tobi_status tobi_state_load(tobi_run *run, bool *found, tobi_error *err);

/* record/summary.c */
tobi_status tobi_summary_write(tobi_run *run, const char *outcome, tobi_error *err);

/* Seconds of a clock that never jumps. */
double tobi_record_clock(void);

/* record/times.c: when outputs are. */
/* Whether t is `time` or later, to within rounding. */
bool tobi_record_reaches(double t, double time);
/* The first multiple of `every` after t; 0: never. */
double tobi_record_next_after(double every, double t);
/* Outputs from time 0 to end, both included. */
int64_t tobi_record_count(double interval, double end);
/* The end, moved onto the output time that it means: 3 x 0.1 is not 0.3. */
double tobi_record_snap(double interval, double end);
/* Time of output k, of the next one too; of one that is taken, on the writer's thread. */
double tobi_record_time(const tobi_run *run, int64_t k);
double tobi_record_time_taken(tobi_run *run, int64_t k);
/* Output run->outputs is taken at time t; said again, if that fails. */
tobi_status tobi_record_note_time(tobi_run *run, double t, tobi_error *err);
struct json_t *tobi_record_times_to_json(const tobi_run *run);
bool tobi_record_times_from_json(struct json_t *list, tobi_run *run);
