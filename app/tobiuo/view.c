/* tobiuo view DIR, and the window of tobiuo run: what of a scene the window needs. Drawback: without
   resolved.json there is no domain to look at, so such results have no window. */
#define _GNU_SOURCE
#include "app.h"
#include "view.h"
#include <jansson.h>
#include <math.h>
#include <pthread.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct view_options { const char *dir, *keys; int width, height; } view_options;

enum { KEY_KEYS = KEY_OWN, KEY_SIZE };

static const struct argp_option options[] = {
    { "keys", KEY_KEYS, "LETTERS", 0, "keys typed at the start, one picture for each: \"ffsq\"", 0 },
    { "size", KEY_SIZE, "WxH", 0, "pixels of the window (1280x720)", 0 },
    { 0 }
};

static error_t parse(int key, char *value, struct argp_state *state)
{
    view_options *o = state->input;
    char end;
    if (key == KEY_KEYS) {
        o->keys = value;
    } else if (key == KEY_SIZE) {
        if (sscanf(value, "%dx%d%c", &o->width, &o->height, &end) != 2 || o->width < 100 || o->height < 100 ||
            o->width > 8192 || o->height > 8192)
            usage_error(state, tr("--size: '%s' is not like 1280x720, each from 100 to 8192"), value);
    } else {
        return parse_argument(state, key, value, "DIR", &o->dir);
    }
    return 0;
}

static window_def make_window(const tobi_scene *scene, const tobi_looks *looks, const char *dir,
                              const char *title)
{
    const tobi_output_def *out = tobi_scene_output_def(scene);
    window_def d = { .title = title, .dir = dir, .looks = *looks };
    for (int k = 0; k < 3; k++) {
        d.up[k] = -looks->gravity[k];
        d.eye[k] = out->view.position[k];
        d.target[k] = out->view.look_at[k];
    }
    d.alone = !out->view.nests;
    d.angle = looks->dimension == 3 ? out->view.angle : 0;
    return d;
}

/* --- a run and its window --- */

typedef struct steps {
    tobi_world *world;
    tobi_run *run;
    const drive_options *drive;
    live *live;
    int code;                   /* of the program */
} steps;

static int between(void *user, tobi_world *world) { return live_between(user, world, is_interrupted); }

static void *take_steps(void *user)
{
    steps *s = user;
    s->code = drive(s->world, s->run, s->drive);
    live_end_steps(s->live, s->world);
    return NULL;
}

int drive_with_window(tobi_world *world, tobi_run *run, const drive_options *o, const tobi_scene *scene,
                      const char *keys)
{
    drive_options with = *o;
    pthread_t thread;
    steps s = { world, run, &with, live_create(), EXIT_ERROR };
    if (!s.live) return complain("out of memory");
    with.between = between;
    with.user = s.live;
    tobi_looks looks;
    tobi_error err = { 0 };
    if (tobi_world_looks(world, &looks, &err) != TOBI_OK) {
        live_free(s.live);
        complain("there is no window: %s", err.text);
        return drive(world, run, o);
    }
    window_def d = make_window(scene, &looks, o->dir, tobi_scene_name(scene));
    d.live = s.live;
    d.keys = keys;
    d.nests = open_nests(scene, o->dir);
    if (pthread_create(&thread, NULL, take_steps, &s) != 0) {
        close_nests(d.nests);
        live_free(s.live);
        tobi_looks_free(&looks);
        complain("there is no window: no thread for it");
        return drive(world, run, o);
    }
    if (window_show(&d) != 0) live_leave(s.live, LIVE_GOES_ON);
    pthread_join(thread, NULL);
    close_nests(d.nests);
    live_free(s.live);
    tobi_looks_free(&looks);
    return s.code;
}

const struct argp view_argp = { .options = options, .parser = parse, .args_doc = "DIR",
    .doc = "Look at the results in DIR in a window; the key h lists its keys." };

int tobiuo_view(int argc, char **argv)
{
    view_options o = { 0 };
    overrides none = { 0 };
    parse_arguments(&view_argp, argc, argv, &o);
    char *path = NULL;
    if (asprintf(&path, "%s/resolved.json", o.dir) < 0) return complain("out of memory");
    if (access(path, F_OK) != 0) {
        free(path);
        return complain_run(o.dir, tr("there is no run to look at (no resolved.json)"));
    }
    free(path);
    tobi_scene *scene = NULL;
    tobi_looks looks = { 0 };
    int code = load_looks(o.dir, &none, &scene, &looks);
    if (code != 0) {
        tobi_scene_free(scene);
        return code;
    }
    nest_results *nests = open_nests(scene, o.dir);
    code = take_outer_colors(nests, &looks);
    window_def d = make_window(scene, &looks, o.dir, o.dir);
    d.nests = nests;
    d.keys = o.keys;
    d.width = o.width;
    d.height = o.height;
    if (code == 0 && window_show(&d) != 0) code = EXIT_ERROR;
    close_nests(nests);
    tobi_looks_free(&looks);
    tobi_scene_free(scene);
    return code;
}
