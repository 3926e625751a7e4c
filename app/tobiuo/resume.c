/* tobiuo resume DIR */
#define _GNU_SOURCE
#include "app.h"
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct resume_options {
    const char *dir;
    overrides set;
    int quiet;
} resume_options;

static const struct argp_option options[] = {
    { "until", KEY_UNTIL, "S", 0, "simulated time to stop at, s (that of the run before)", 0 },
    { "threads", 't', "N", 0, "threads (0 = all cores)", 0 },
    { "quiet", 'q', NULL, 0, "no progress line", 0 },
    { 0 }
};

static error_t parse(int key, char *value, struct argp_state *state)
{
    resume_options *o = state->input;
    switch (key) {
    case 't': overrides_add(&o->set, "threads=%d", parse_threads(state, value)); break;
    case 'q': o->quiet = 1; break;
    case KEY_UNTIL: overrides_add(&o->set, "end_time=%.17g", parse_positive(state, "--until", value)); break;
    default: return parse_argument(state, key, value, "DIR", &o->dir);
    }
    return 0;
}

static void tell_end(double time, double end)
{
    if (time > end) complain("the run is at %g s, beyond %g s: there is nothing to do", time, end);
    else complain("the run has reached its end, %g s; --until S takes it on", end);
}

static int resume_scene(tobi_scene *scene, const resume_options *o)
{
    tobi_error err = { 0 };
    tobi_world *world = NULL;
    tobi_run *run = NULL;
    tobi_nests *nests = NULL;
    if (tobi_scene_build(scene, &world, &err) != TOBI_OK) return complain("%s", err.text);
    int code;
    if (tobi_nests_create(scene, world, &nests, &err) != TOBI_OK) {
        code = complain("%s", err.text);
    } else if (tobi_nests_prepare(nests, o->dir, TOBI_NESTS_RESUME, &err) != TOBI_OK) {
        code = complain("%s", err.text);
    } else if (tobi_run_resume(world, tobi_scene_output_def(scene), o->dir, &run, &err) != TOBI_OK) {
        code = complain("%s", err.text);
    } else if (tobi_nests_record(nests, run, o->dir, TOBI_NESTS_RESUME, &err) != TOBI_OK) {
        code = complain("%s", err.text);
    } else if (tobi_scene_note_files(scene, o->dir, tobi_world_time(world), &err) != TOBI_OK) {
        code = complain("%s", err.text);
    } else {
        char *told = strdup(tobi_run_losses(run));
        drive_options d = { .scene = scene, .dir = o->dir, .told = told,
                            .end = tobi_scene_world_def(scene)->end_time, .quiet = o->quiet };
        if (!o->quiet) fprintf(stderr, "tobiuo: %s\n", tobi_run_note(run));
        if (*tobi_run_losses(run)) complain("results in %s: %s", o->dir, tobi_run_losses(run));
        if (!o->quiet && !(tobi_world_time(world) < d.end))
            tell_end(tobi_world_time(world), d.end);
        code = drive(world, run, &d);
        free(told);
    }
    tobi_run_free(run);
    tobi_nests_free(nests);
    tobi_world_destroy(world);
    return code;
}

/* Whether the scene in this file has a nest of the name. */
static int has_nest(const char *path, const char *name)
{
    json_t *scene = json_load_file(path, 0, NULL);
    const json_t *list = json_object_get(scene, "nests");
    int found = 0;
    for (size_t k = 0; k < json_array_size(list); k++) {
        const char *one = json_string_value(json_object_get(json_array_get(list, k), "name"));
        found |= one && strcmp(one, name) == 0;
    }
    json_decref(scene);
    return found;
}

char *find_outer(const char *dir)
{
    char *real = realpath(dir, NULL), *name = real ? strrchr(real, '/') : NULL, *path = NULL;
    if (name) *name++ = '\0';
    char *parent = name ? strrchr(real, '/') : NULL;
    int found = parent && strcmp(parent, "/nests") == 0;
    if (found) *parent = '\0';
    found = found && asprintf(&path, "%s/resolved.json", real) >= 0 && has_nest(path, name);
    free(path);
    if (found) return real;
    free(real);
    return NULL;
}

const struct argp resume_argp = { .options = options, .parser = parse, .args_doc = "DIR",
    .doc = "Go on with the run in DIR from its last whole checkpoint." };

int tobiuo_resume(int argc, char **argv)
{
    resume_options o = { 0 };
    parse_arguments(&resume_argp, argc, argv, &o);
    char *path = NULL;
    if (asprintf(&path, "%s/resolved.json", o.dir) < 0) return complain("out of memory");
    if (access(path, F_OK) != 0) {
        free(path);
        return complain_run(o.dir, tr("there is no run to resume (no resolved.json)"));
    }
    char *outer = find_outer(o.dir), quoted[SHELL_WORD];
    if (outer) {
        complain("%s is a nest, which goes on with the run around it: tobiuo resume %s", o.dir,
                 shell_word(outer, quoted));
        free(outer);
        free(path);
        return EXIT_ERROR;
    }
    tobi_scene *scene = load_scene(path, &o.set);
    /* What changed in a motion or a table holds from here on; what has been computed does not follow it. */
    if (scene) say_changed_files(scene, o.dir, tr("the run"));
    int code = scene ? resume_scene(scene, &o) : EXIT_ERROR;
    tobi_scene_free(scene);
    free(path);
    return code;
}
