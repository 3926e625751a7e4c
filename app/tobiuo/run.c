/* tobiuo run SCENE */
#define _GNU_SOURCE
#include "app.h"
#include "view.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct run_options {
    const char *scene, *out, *movie, *surface, *keys;
    double slow;                /* 0: not given */
    overrides set;
    int force, quiet, window, foam;
} run_options;

enum { KEY_FORCE = KEY_OWN, KEY_FRAMES, KEY_MOVIE, KEY_SURFACE, KEY_SLOW, KEY_FOAM, KEY_WINDOW, KEY_KEYS };

static const struct argp_option options[] = {
    { "out", 'o', "DIR", 0, "where the results go (out/<scene>)", 0 },
    SCENE_OPTIONS,
    { "threads", 't', "N", 0, "threads (0 = all cores)", 0 },
    { "force", KEY_FORCE, NULL, 0, "replace the results that are in DIR, and write however much", 0 },
    { "frames", KEY_FRAMES, NULL, 0, "write a picture at each output", 0 },
    { "movie", KEY_MOVIE, "FILE", 0, "and a movie of them at the end: .mp4, .webm, .webp or .gif; one "
        "of each view", 0 },
    { "surface", KEY_SURFACE, "FORMAT", 0, "and the surfaces of fluids and solids at the end, as \"tobiuo "
        "surface\" makes them: vtp, obj, ply, stl or glb", 0 },
    { "foam", KEY_FOAM, NULL, 0, "and spray, foam and bubbles at the end, as \"tobiuo foam\" makes them, for "
        "pictures and movie", 0 },
    { "slow", KEY_SLOW, "N", 0, "with --movie, --surface=glb: N times slower than the scene is (1)", 0 },
    { "window", KEY_WINDOW, NULL, 0, "watch the run in a window; the key h lists its keys", 0 },
    { "keys", KEY_KEYS, "LETTERS", 0, "keys typed into the window at the start", 0 },
    { "quiet", 'q', NULL, 0, "no progress line", 0 },
    { 0 }
};

static error_t parse(int key, char *value, struct argp_state *state)
{
    run_options *o = state->input;
    switch (key) {
    case 'o':
        if (!*value) usage_error(state, tr("--out is empty"));
        o->out = value;
        break;
    case 't': overrides_add(&o->set, "threads=%d", parse_threads(state, value)); break;
    case 'q': o->quiet = 1; break;
    case KEY_FRAMES: overrides_add(&o->set, "output.frames=true"); break;
    case KEY_MOVIE:
        if (movie_objection(value)) usage_error(state, tr("--movie: '%s' %s"), value, movie_objection(value));
        overrides_add(&o->set, "output.frames=true");
        o->movie = value;
        break;
    case KEY_SURFACE:
        o->surface = surface_format(value);
        if (!o->surface) usage_error(state, tr("--surface: '%s' is none of vtp, obj, ply, stl, glb"), value);
        break;
    case KEY_SLOW: o->slow = parse_positive(state, "--slow", value); break;
    case KEY_FOAM: o->foam = 1; break;
    case KEY_FORCE: o->force = 1; break;
    case KEY_WINDOW: o->window = 1; break;
    case KEY_KEYS: o->keys = value; break;
    case ARGP_KEY_SUCCESS:
        if (o->slow > 0 && !o->movie && !o->surface) usage_error(state, tr("--slow needs --movie FILE"));
        break;
    default: return parse_scene_option(state, key, value, &o->set, &o->scene);
    }
    return 0;
}

char *results_path(const tobi_scene *scene, const char *out)
{
    char *dir = NULL;
    int length = out ? asprintf(&dir, "%s", out) : asprintf(&dir, "out/%s", tobi_scene_name(scene));
    return length < 0 ? NULL : dir;
}

/* Before anything is made. */
static int check_size(const tobi_scene *scene, tobi_world *world, tobi_nests *nests, const run_options *o,
                      const char *dir, tobi_run_size *size)
{
    tobi_error err = { 0 };
    const double end = tobi_scene_world_def(scene)->end_time;
    if (tobi_run_estimate(world, tobi_scene_output_def(scene), end, size, &err) != TOBI_OK ||
        tobi_nests_estimate(nests, end, size, &err) != TOBI_OK)
        return complain("%s", err.text);
    char *objection = o->force ? NULL : size_objection(size, dir);
    const int code = objection ? complain("%s", objection) : 0;
    free(objection);
    return code;
}

static void print_size(const tobi_run_size *size, const char *dir)
{
    char bytes[32];
    printf(tr("%lld outputs, about %s in %.7g files, go to %s\n"), (long long)size->outputs,
           bytes_text(size->bytes, bytes), size->files, dir);
}

/* What the scene's own world has not said. */
static void print_nest_notes(const tobi_nests *nests)
{
    const char *name;
    tobi_world *w;
    char head[200];
    for (int k = 0; (w = tobi_nests_world(nests, k, &name)) != NULL; k++) {
        snprintf(head, sizeof head, tr("tobiuo: note: nest '%.100s': "), name);
        print_notes(w, stderr, head);
    }
}

/* Pictures with foam are drawn once, when there is foam: the run itself draws none. */
static int record(tobi_scene *scene, tobi_world *world, tobi_nests *nests, const run_options *o,
                  const char *dir, const tobi_run_size *size)
{
    tobi_error err = { 0 };
    tobi_run *run = NULL;
    char quoted[SHELL_WORD];
    tobi_output_def output = *tobi_scene_output_def(scene);
    const int waits = o->foam && output.frames && can_draw_later(scene);
    if (waits) output.frames = 0;
    char *resolved = tobi_scene_resolved(scene);
    if (!resolved) return complain("out of memory");
    const int how = o->force ? TOBI_NESTS_REPLACE : TOBI_NESTS_CREATE;
    tobi_status status = tobi_nests_prepare(nests, dir, how, &err);
    if (status == TOBI_OK)
        status = tobi_run_create(world, &output, dir, o->force, resolved, &run, &err);
    free(resolved);
    if (status == TOBI_OK) status = tobi_nests_record(nests, run, dir, how, &err);
    if (status == TOBI_OK) status = tobi_scene_note_files(scene, dir, 0, &err);
    if (!o->quiet && status == TOBI_OK) print_size(size, dir);
    if (!o->quiet) print_notes(world, stderr, tr("tobiuo: note: "));
    if (!o->quiet) print_nest_notes(nests);
    tobi_scene_place_error(scene, &err);
    if (status != TOBI_OK) {
        tobi_run_free(run);
        return complain("%s", err.text);
    }
    drive_options d = { .scene = scene, .dir = dir, .end = tobi_scene_world_def(scene)->end_time,
                        .quiet = o->quiet };
    int code = o->window ? drive_with_window(world, run, &d, scene, o->keys) : drive(world, run, &d);
    if (waits && code != 0 && code != EXIT_UNWRITTEN)
        fprintf(stderr, tr("tobiuo: note: its pictures have waited for the foam; both, now: tobiuo foam "
                "%s\n"), shell_word(dir, quoted));
    tobi_run_free(run);
    return code;
}

enum { PREPARE, MAKE };

/* The movies of the output's own pictures and of its views: asked for, or made. */
static int handle_movies(const tobi_scene *scene, const run_options *o, const char *dir, int stage)
{
    const tobi_output_def *output = tobi_scene_output_def(scene);
    const double slow = o->slow > 0 ? o->slow : 1;
    int code = stage == MAKE ? make_movie(dir, NULL, o->movie, slow, o->force)
                             : prepare_movie(o->movie, o->force);
    for (int k = 0; code == 0 && k < output->view_count; k++) {
        char *path = movie_of_view(o->movie, output->views[k].name);
        code = !path ? complain("out of memory")
             : stage == MAKE ? make_movie(dir, output->views[k].name, path, slow, o->force)
                             : prepare_movie(path, o->force);
        free(path);
    }
    return code;
}

static int run_scene(tobi_scene *scene, const run_options *o)
{
    tobi_error err = { 0 };
    tobi_world *world = NULL;
    tobi_nests *nests = NULL;
    tobi_run_size size = { 0 };
    if (tobi_scene_build(scene, &world, &err) != TOBI_OK) return complain("%s", err.text);
    if (tobi_nests_create(scene, world, &nests, &err) != TOBI_OK) {
        tobi_world_destroy(world);
        return complain("%s", err.text);
    }
    char *dir = results_path(scene, o->out);
    if (tobi_scene_import_table(scene) && !o->quiet)
        printf(tr("a scene of %s; \"tobiuo check\" lists what became of each of its keys\n"),
               tr(tobi_scene_import_program(scene)));
    int code = dir ? check_size(scene, world, nests, o, dir, &size) : complain("out of memory");
    if (code == 0 && o->surface && tobi_scene_world_def(scene)->dimension != 3)
        code = complain("--surface: a run in 2-D has no surface");
    if (code == 0 && o->foam && foam_objection(scene, world))
        code = complain("--foam: %s", foam_objection(scene, world));
    if (code == 0 && o->movie) code = handle_movies(scene, o, dir, PREPARE);
    const int no_movie = code == 0 && o->movie ? check_encoder() : 0;
    char quoted[SHELL_WORD];
    if (no_movie)
        complain("the run goes on and keeps its pictures; later: tobiuo movie %s", shell_word(dir, quoted));
    if (code == 0) code = record(scene, world, nests, o, dir, &size);
    if ((code == 0 || code == EXIT_UNWRITTEN) && o->foam) {
        const int made = make_foam(dir, o->quiet);
        if (code == 0) code = made;
    }
    if ((code == 0 || code == EXIT_UNWRITTEN) && o->movie) {      /* of the pictures that there are */
        const int made = no_movie ? no_movie : handle_movies(scene, o, dir, MAKE);
        if (code == 0) code = made;
    }
    if ((code == 0 || code == EXIT_UNWRITTEN) && o->surface) {
        const int made = make_surfaces(dir, o->surface, o->slow > 0 ? o->slow : 1);
        if (code == 0) code = made;
    }
    free(dir);
    tobi_nests_free(nests);
    tobi_world_destroy(world);
    return code;
}

const struct argp run_argp = { .options = options, .parser = parse, .args_doc = "SCENE",
    .doc = "Simulate a scene: a JSON file, or a directory with a scene.json." };

int tobiuo_run(int argc, char **argv)
{
    run_options o = { 0 };
    parse_arguments(&run_argp, argc, argv, &o);
    tobi_scene *scene = load_scene(o.scene, &o.set);
    int code = scene ? run_scene(scene, &o) : EXIT_ERROR;
    tobi_scene_free(scene);
    return code;
}
