/* The program: one file per command, each a function of its own argc and argv that returns the exit
   code: 0, 1 for an error (told on stderr as "tobiuo: ..."), 2 for wrong usage, 130 after Ctrl-C.
 */
#pragma once
#include "tobiuo/run.h"
#include "tobiuo/scene.h"
#include <argp.h>
#include <stdio.h>

enum { EXIT_ERROR = 1, EXIT_USAGE = 2, EXIT_INTERRUPTED = 130 };

int tobiuo_run(int argc, char **argv);
int tobiuo_resume(int argc, char **argv);
int tobiuo_plot(int argc, char **argv);
int tobiuo_check(int argc, char **argv);
int tobiuo_import(int argc, char **argv);
int tobiuo_describe(int argc, char **argv);
int tobiuo_bench(int argc, char **argv);
int tobiuo_info(int argc, char **argv);

/* complain.c: "tobiuo: ..." on stderr, one line; returns EXIT_ERROR. */
int complain(const char *format, ...) __attribute__((format(printf, 1, 2)));
/* A scene's mistakes, or the error's text; frees the report. Returns EXIT_ERROR. */
int complain_scene(tobi_report *report, const tobi_error *err);

/* Prints the world's notes on its meshes, a line each after `head`. */
void print_notes(const tobi_world *world, FILE *file, const char *head);

/* overrides.c: "path=value" texts for tobi_scene_load, ended by NULL. */
typedef struct overrides { char **text; int count; } overrides;
/* Exits with a message when memory is short. */
void overrides_add(overrides *o, const char *format, ...) __attribute__((format(printf, 2, 3)));
void overrides_free(overrides *o);

/* load.c. The scene file meant by a path: a directory stands for its scene.json. Owned by the caller. */
char *scene_path(const char *path);
/* The scene at such a path with the overrides, which are freed; NULL after a complaint. */
tobi_scene *load_scene(const char *path, overrides *set);

/* options.c: parsing of values; a usage error ends the program as argp does. */
double parse_positive(struct argp_state *state, const char *option, const char *text);
int parse_threads(struct argp_state *state, const char *text);
/* For all keys that a command does not know itself: takes its one argument, called SCENE or DIR. */
error_t parse_argument(struct argp_state *state, int key, const char *value, const char *name,
                       const char **argument);
/* The options of run and check that change the scene, and their parser, which takes an argument SCENE too. */
enum { KEY_UNTIL = 256, KEY_SPACING, KEY_SET, KEY_OWN };
#define SCENE_OPTIONS \
    { "until", KEY_UNTIL, "S", 0, "simulated time to stop at, s", 0 }, \
    { "spacing", KEY_SPACING, "M", 0, "particle spacing of the fluid, m", 0 }, \
    { "set", KEY_SET, "PATH=VALUE", 0, \
      "change any value of the scene, e.g. fluids[0].viscosity=0.1", 0 }
error_t parse_scene_option(struct argp_state *state, int key, const char *value, overrides *set,
                           const char **scene);

/* drive.c: steps a run to its end with progress and Ctrl-C. */
typedef struct drive_options {
    const char *dir;      /* where the results go, for messages  */
    double end;           /* s                                   */
    int quiet;            /* 1: no progress line                 */
} drive_options;
/* Catches Ctrl-C and SIGTERM from here on. Returns the exit code; the run is finished, not freed. */
int drive(tobi_world *world, tobi_run *run, const drive_options *options);

/* watch.c: what is said at the end of a run. */
typedef struct body_watch { double last[3], before[3], noise, force; int64_t steps; } body_watch;
typedef struct watch {
    int64_t steps, unconverged;
    double surface_start;
    tobi_step_info last;
    body_watch *body;
    int body_count;
} watch;
void watch_begin(watch *w, const tobi_world *world);
void watch_step(watch *w, const tobi_world *world, const tobi_step_info *info);
/* Says on stderr what did not go well. */
void watch_say(const watch *w, const tobi_world *world);
void watch_end(watch *w);
/* cost.c */
/* "123 MB" or "1.2 GB"; buffer of 32. */
const char *bytes_text(double bytes, char *buffer);
/* Why results of this size in dir need --force; NULL if they do not. The caller frees. */
char *size_objection(const tobi_run_size *size, const char *dir);
/* Steps the world from its start for about a second: wall clock per step and step, both s, without the
   first. *steps that were taken; below 2 nothing is known. */
tobi_status measure_steps(tobi_world *world, double end, int *steps, double *wall, double *step,
                          tobi_error *err);

/* run.c: where the results go without and with --out; the caller frees, NULL without memory. */
char *results_path(const tobi_scene *scene, const char *out);

/* progress.c */
typedef struct progress {
    int shown, terminal, columns;    /* is there a line; is stderr a terminal; its width       */
    double begun, start_time;        /* s of wall clock; s of simulated time                   */
    double last;                     /* s of wall clock of the last line                       */
    double particle_steps;           /* since the last line                                    */
} progress;
void progress_begin(progress *p, double time, int quiet);
void progress_step(progress *p, const tobi_step_info *info, double end);
/* Ends the rewritten line, so that other text can follow. */
void progress_end(progress *p);
double wall_clock(void);
/* "1:02:03", "2:03" or "4 s"; buffer of 32. */
const char *duration_text(double seconds, char *buffer);
