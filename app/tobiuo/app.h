/* The program: one file per command, each a function of its own argc and argv that returns the exit
   code: 0, 1 for an error (told on stderr as "tobiuo: ..."), 2 for wrong usage, 3 for a run to its end
   of which files could not be written, 130 after Ctrl-C.
 */
#pragma once
#include "language.h"
#include "energy.h"
#include "tobiuo/drawing.h"
#include "tobiuo/run.h"
#include "tobiuo/scene.h"
#include <argp.h>
#include <stdio.h>

enum { EXIT_ERROR = 1, EXIT_USAGE = 2, EXIT_UNWRITTEN = 3, EXIT_INTERRUPTED = 130 };

/* The commands. Their options are tables, for argp, the man page and the completion of words alike. */
extern const struct argp run_argp, resume_argp, check_argp, import_argp, plot_argp, movie_argp, view_argp,
                         report_argp, describe_argp, bench_argp, info_argp, scenes_argp, new_argp,
                         inspect_argp, surface_argp, foam_argp, picture_argp, sweep_argp, waves_argp,
                         sample_argp;
int tobiuo_run(int argc, char **argv);
int tobiuo_resume(int argc, char **argv);
int tobiuo_plot(int argc, char **argv);
int tobiuo_movie(int argc, char **argv);
int tobiuo_inspect(int argc, char **argv);
int tobiuo_picture(int argc, char **argv);
int tobiuo_surface(int argc, char **argv);
int tobiuo_foam(int argc, char **argv);
int tobiuo_report(int argc, char **argv);
int tobiuo_view(int argc, char **argv);
int tobiuo_check(int argc, char **argv);
int tobiuo_import(int argc, char **argv);
int tobiuo_describe(int argc, char **argv);
int tobiuo_bench(int argc, char **argv);
int tobiuo_info(int argc, char **argv);
int tobiuo_scenes(int argc, char **argv);
int tobiuo_new(int argc, char **argv);
int tobiuo_sweep(int argc, char **argv);
int tobiuo_waves(int argc, char **argv);
int tobiuo_sample(int argc, char **argv);

typedef struct command {
    const char *name, *arguments, *doc;
    int (*run)(int argc, char **argv);
    const struct argp *argp;
} command;
/* main.c: by number, NULL past the end. */
const command *command_at(int index);
/* manual.c: made from the commands. */
void print_man_page(void);
void print_completion(void);

/* terminal.c */
#define BOLD  "\033[1m"
#define RED   "\033[1;31m"
#define GREEN "\033[32m"
#define PLAIN "\033[0m"
int has_colours(FILE *file);
/* The code where the file shows colours, or else "". */
const char *colour(FILE *file, const char *code);
/* Width of a terminal; 0: no terminal. */
int terminal_columns(FILE *file);

/* near.c: scenes by name. */
/* Names of scene files and folders with a scene, sorted. */
char **list_scenes(const char *folder, size_t *count);
void free_names(char **names, size_t count);
/* A new file, whole or not at all; 0, or EXIT_ERROR after a complaint. */
int write_new(const char *path, const char *text, size_t size);
/* A path seen from the current folder, if it lies below. Owned by the caller. */
char *relative_path(const char *path);
/* The scene that a path leading nowhere may mean; NULL if none is near. Owned by the caller. */
char *near_scene(const char *path);
/* The same for the folder of a run. */
char *near_run(const char *path);
/* Says that there is no run in dir, and which one may be meant. Returns EXIT_ERROR. */
/* A path as a shell takes it: itself, or between quotes in room. One that is too long stays as it is. */
enum { SHELL_WORD = 1000 };
const char *shell_word(const char *text, char room[SHELL_WORD]);
int complain_run(const char *dir, const char *what);

/* new.c: whether the arguments of `tobiuo new` name a family of scenes; its list; the scene. */
int wants_family(int argc, char **argv);
int list_families(void);
int write_family(int argc, char **argv);
/* The family that a misspelt name may mean, or NULL. */
const char *near_family(const char *name);

/* check.c: whether a run would take the scene: it is built, and started unless that takes long. */
tobi_status try_scene(tobi_scene *scene, tobi_error *err);

/* complain.c: "tobiuo: ..." on stderr, one line; returns EXIT_ERROR. */
int complain(const char *format, ...) __attribute__((format(printf, 1, 2)));
/* A scene's mistakes, or the error's text; frees the report. Returns EXIT_ERROR. */
int complain_scene(tobi_report *report, const tobi_error *err);

/* What fits of the text, filled up with blanks, as wide as a terminal shows it. */
void print_columns(FILE *file, const char *text, int columns);
/* The same as the head of a line of a list. */
enum { LABEL = 17 };
void print_label(const char *text);
/* Prints the world's notes on its meshes, a line each after `head`. */
void print_notes(const tobi_world *world, FILE *file, const char *head);

/* overrides.c: "path=value" texts for tobi_scene_load, ended by NULL. */
typedef struct overrides { char **text; int count; } overrides;
/* Exits with a message when memory is short. */
void overrides_add(overrides *o, const char *format, ...) __attribute__((format(printf, 2, 3)));
void overrides_free(overrides *o);

/* load.c. The scene file meant by a path: a directory stands for its scene.json, or else its setting.json of
   the tank program. Owned by the caller. */
char *scene_path(const char *path);
/* The same, but setting.json goes first. */
char *import_path(const char *path);
/* looks.c: what pictures need of the world of a scene, or of that of the run in dir with overrides; 0, or an
   exit code after a complaint. Both are the caller's then. Files that have changed are said. */
int find_looks(tobi_scene *scene, tobi_looks *looks);
int load_looks(const char *dir, const overrides *set, tobi_scene **scene, tobi_looks *looks);
/* The scene at such a path with the overrides, which are freed; NULL after a complaint. */
tobi_scene *load_scene(const char *path, overrides *set);
/* Says which files of the scene are not as the run in dir has read them, and that `what` goes on. */
void say_changed_files(const tobi_scene *scene, const char *dir, const char *what);

/* help.c */
void print_usage(FILE *file);
/* "tobiuo run: ..." on stderr; ends the program with EXIT_USAGE. The format is looked up by the caller. */
void usage_error(const struct argp_state *state, const char *format, ...)
    __attribute__((format(printf, 2, 3), noreturn));
/* Options of all commands, and their parser. */
const struct argp_option *common_options(void);
error_t parse_common(int key, char *value, struct argp_state *state);
/* Bytes of the text that stay on one line: a word, or a letter of Japanese with the marks at it. */
size_t piece_bytes(const char *text);

/* options.c: parsing of values; a usage error ends the program. */
/* argp_parse, with the options of all commands. It may run out of memory before it has looked at anything:
   then the program ends. */
void parse_arguments(const struct argp *argp, int argc, char **argv, void *input);
double parse_positive(struct argp_state *state, const char *option, const char *text);
/* The same, and 0: a time. */
double parse_time(struct argp_state *state, const char *option, const char *text);
int parse_threads(struct argp_state *state, const char *text);
/* For all keys that a command does not know itself: takes its one argument, called SCENE or DIR. */
error_t parse_argument(struct argp_state *state, int key, const char *value, const char *name,
                       const char **argument);
/* The options of run and check that change the scene, and their parser, which takes an argument SCENE too. */
enum { KEY_UNTIL = 256, KEY_SPACING, KEY_SET, KEY_LANGUAGE, KEY_OWN };
#define SCENE_OPTIONS \
    { "until", KEY_UNTIL, "S", 0, "simulated time to stop at, s", 0 }, \
    { "spacing", KEY_SPACING, "M", 0, "particle spacing of the fluid, m", 0 }, \
    { "set", KEY_SET, "PATH=VALUE", 0, \
      "change any value of the scene, e.g. fluids[0].viscosity=0.1", 0 }
void parse_language(struct argp_state *state, const char *value);
/* Of "--language ja" at argv[1], without argp: how many words that is; -1 after a complaint. */
int take_language(int argc, char **argv);
error_t parse_scene_option(struct argp_state *state, int key, const char *value, overrides *set,
                           const char **scene);

/* drive.c: steps a run to its end with progress and Ctrl-C. */
typedef struct drive_options {
    tobi_scene *scene;    /* for the places of what its run refuses */
    const char *dir;      /* where the results go, for messages  */
    const char *told;     /* losses that the start has told; or NULL */
    double end;           /* s                                   */
    int quiet;            /* 1: no progress line                 */
    int (*between)(void *user, tobi_world *world);      /* before each step, 1: stop; or NULL */
    void *user;
} drive_options;
/* Catches Ctrl-C and SIGTERM from here on. Returns the exit code; the run is finished, not freed. */
int drive(tobi_world *world, tobi_run *run, const drive_options *options);
/* 1 after Ctrl-C or SIGTERM. */
int is_interrupted(void);

/* watch.c: what is said at the end of a run. */
typedef struct body_watch { double last[3], before[3], noise, force; int64_t steps; } body_watch;
typedef struct watch {
    int64_t steps, unconverged;
    double surface_start;
    tobi_step_info last, worst;      /* worst: the step with the largest residual that did not converge */
    energy_watch energy;
    body_watch *body;
    int body_count;
} watch;
void watch_begin(watch *w, const tobi_world *world);
/* TOBI_DIVERGED, in words, when liquid and solids have more energy than there ever was. */
tobi_status watch_step(watch *w, const tobi_world *world, const tobi_step_info *info, tobi_error *err);
/* Says on stderr what did not go well. */
void watch_say(watch *w, const tobi_world *world);
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

/* tool.c: runs a program, found by the PATH, in a folder (NULL: here) without a shell. 0; -1 if it failed;
   after a complaint EXIT_ERROR. does, package: what it is for, and what to install, for that. quiet: without
   its standard output. said: gets the first line of its errors, which then appear nowhere; or NULL. */
enum { TOOL_SAYS = 300 };
int run_tool(const char *folder, char *const arguments[], const char *does, const char *package, int quiet,
             char said[TOOL_SAYS]);
/* Draws plots.gnuplot in the folder, without the user's settings. Returns the exit code. */
int run_gnuplot(const char *folder);
/* The path of a file in the folder, whatever stood there removed: nothing is written through a link.
   NULL after a complaint; the caller frees. */
char *clear_place(const char *folder, const char *file);

/* series.c: DIR/NAME; the caller frees, without memory the program ends. */
char *join_path(const char *dir, const char *name);
/* Makes a folder for a file of each output, which must be no link. 0, or EXIT_ERROR after a complaint. */
int make_series_folder(const char *path);
/* DIR/NAME.pvd, ParaView's list of DIR/NAME/NAME_000000.vtp, from output `first` on. The same codes. */
int write_series_list(const char *dir, const char *name, const tobi_results *results, int64_t first);
/* DIR/NAME.pvd of files FOLDERNAME_000000.ENDING, with FOLDER seen from DIR as "" or "foam/", of the outputs
   from first to end - 1. The same codes. */
typedef struct series { const char *dir, *folder, *name, *ending; int64_t first, end; } series;
int write_list(const series *s, const tobi_results *results);

/* surface.c: the name of a format, or NULL; the surfaces of each output, as tobiuo surface makes them, whose
   exit code is returned. */
const char *surface_format(const char *name);
int make_surfaces(const char *dir, const char *format, double slow);

/* movie.c */
/* Why a path is not that of a movie, to stand behind its name; NULL if it is. */
const char *movie_objection(const char *path);
int is_png(const char *path);        /* by its name */
/* 0 if no file is in the way, or else EXIT_ERROR after a complaint. */
int prepare_movie(const char *out, int force);
/* 0 if there is a program that makes movies, or else EXIT_ERROR after a complaint. */
int check_encoder(void);
/* Makes a movie of a run's pictures, `slow` times slower than the scene. Returns the exit code.
   view: an entry of output.views, NULL for the output's own pictures, here and below. */
int make_movie(const char *dir, const char *view, const char *out, double slow, int force);
/* "out_side.mp4" from "out.mp4"; NULL: no memory. The caller frees. */
char *movie_of_view(const char *out, const char *view);
/* The same, 640 pixels wide and at least 4 s long: *slow is how much slower it is than the scene. */
int make_small_movie(const char *dir, const char *out, double *slow);
/* A movie of DIR/frames with so many pictures per second; whatever is there is replaced. */
int encode_pictures(const char *dir, const char *out, double rate);
/* pictures.c: the numbers of those in DIR/frames: first to end - 1, of which count are there. */
typedef struct pictures { int64_t first, end, count; } pictures;
pictures find_pictures(const char *dir, const char *view);
int is_picture(const char *dir, const char *view, int64_t number);
/* NULL: no memory. The caller frees. */
char *frame_path(const char *dir, const char *view, int64_t number);
/* The one that stands for a number: itself or the last before it. */
int64_t shown_picture(const char *dir, const char *view, const pictures *p, int64_t number);
/* "3 to 5, 8", the missing ones between first and end. NULL: no memory. The caller frees. */
char *list_gaps(const char *dir, const char *view, const pictures *p);
/* Makes the folder, whose name ends in XXXXXX, with links to what is shown, numbered from 0. Returns the exit
   code. */
int link_pictures(const char *dir, const char *view, const pictures *p, char *folder);
/* Those of the folder, and it. */
void clear_pictures(const char *folder, const char *view);
/* resume.c: RUN of RUN/nests/NAME, if that has such a nest; else NULL. The caller frees it. */
char *find_outer(const char *dir);
/* nest_pictures.c: results of the nests of the run in dir; both outlive them. Ends without memory. Adds what
   they have at its time to a moment of the run, and says what they lack. Of a run that is a nest itself a
   moment gets its box. NULL is fine. */
typedef struct nest_results nest_results;
nest_results *open_nests(const tobi_scene *scene, const char *dir);
void add_nests(nest_results *nests, const tobi_looks *looks, tobi_moment *moment);
void close_nests(nest_results *nests);
/* A nest has the colours of the run around it. 0, or an exit code after a complaint. */
int take_outer_colors(const nest_results *nests, tobi_looks *looks);
/* draw.c: draws from the results of the run in dir, with values of its scene changed, the pictures that
   folder/frames lacks. Returns the exit code. */
int draw_missing(const char *dir, const char *view, const overrides *set, const char *folder);
/* Draws those of DIR/frames that are there anew, if they show foam, and those that are missing, if the scene
   asks for pictures. Returns the exit code. */
int draw_again(const char *dir, const char *view);
/* foam.c: foam of the run in dir, as `tobiuo foam` makes it, and its pictures anew. Returns the exit code. */
int make_foam(const char *dir, int quiet);
/* Why a run could make none, to stand behind "--foam: "; NULL: it can. */
const char *foam_objection(const tobi_scene *scene, const tobi_world *world);
/* 1: pictures of the run can be drawn of its files, when there is foam. */
int can_draw_later(const tobi_scene *scene);
/* The path of the first that cannot be read to its end; NULL: none, or no memory. The caller frees. */
char *find_damaged(const char *dir, const char *view);
/* sheet.c: whether the PNG has an alpha channel; whether it cannot be read to its end. */
int is_transparent(const char *path);
int is_damaged(const char *path);
/* A dozen of them in one PNG. Returns the exit code. */
int make_sheet(const char *dir, const char *view, const char *out);

/* progress.c */
typedef struct progress {
    int shown, columns;              /* is there a line; width of the terminal, 0: none        */
    double begun, start_time;        /* s of wall clock; s of simulated time                   */
    double last;                     /* s of wall clock of the last line                       */
    double in_steps, in_nests;       /* s that the world, and all its nests, had spent in steps then */
    double particle_steps;           /* since the last line                                    */
    const tobi_run *run;             /* whose pictures count, or NULL                          */
    int troubles;                    /* of them said                                           */
} progress;
void progress_begin(progress *p, const tobi_world *world, int quiet);
void progress_step(progress *p, const tobi_world *world, const tobi_step_info *info, double end);
/* Ends the rewritten line, so that other text can follow. */
void progress_end(progress *p);
double wall_clock(void);
/* "1:02:03", "2:03" or "4 s"; buffer of 32. */
const char *duration_text(double seconds, char *buffer);
