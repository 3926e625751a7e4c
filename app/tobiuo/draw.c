/* Pictures of outputs of a finished run, with the settings of its scene, each of which can be changed: one
   by tobiuo picture DIR, or those that a movie lacks (decision 91). Drawback: the world of the scene is made
   anew for its colours, in some tenths of a second. */
#define _GNU_SOURCE
#include "app.h"
#include "tobiuo/drawing.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

typedef struct draw_options {
    const char *dir, *out, *view;
    int64_t output;                    /* -1: the last, or that nearest to the time, s */
    double time;                       /* below 0: none given */
    overrides set;
} draw_options;

enum { KEY_OUTPUT = KEY_OWN, KEY_TIME, KEY_VALUE, KEY_VIEW };

static const struct argp_option options[] = {
    { "out", 'o', "FILE", 0, "the picture (DIR/picture.png)", 0 },
    { "output", KEY_OUTPUT, "N", 0, "number of the output, from 0 (the last)", 0 },
    { "time", KEY_TIME, "S", 0, "the output nearest to this simulated time, s", 0 },
    { "view", KEY_VIEW, "NAME", 0, "as this entry of output.views of the scene", 0 },
    { "set", KEY_VALUE, "PATH=VALUE", 0, "change a value of the scene, e.g. output.picture.field=pressure",
      0 },
    { 0 }
};

static error_t parse(int key, char *value, struct argp_state *state)
{
    draw_options *o = state->input;
    char *end;
    switch (key) {
    case 'o':
        if (!is_png(value))
            usage_error(state, tr("--out: '%s' is no picture that can be made: its name ends in .png"),
                        value);
        o->out = value;
        break;
    case KEY_OUTPUT:
        o->output = strtoll(value, &end, 10);
        if (end == value || *end || o->output < 0)
            usage_error(state, tr("--output: '%s' is not a number from 0 on"), value);
        break;
    case KEY_TIME:
        o->time = strtod(value, &end);
        if (end == value || *end || !(o->time >= 0))
            usage_error(state, tr("--time: '%s' is not a number from 0 on"), value);
        break;
    case KEY_VIEW: o->view = value; break;
    case KEY_VALUE: overrides_add(&o->set, "%s", value); break;
    default: return parse_argument(state, key, value, "DIR", &o->dir);
    }
    return 0;
}

/* All that the picture is made of. */
typedef struct source {
    tobi_scene *scene;
    const tobi_view_def *view;         /* of the scene */
    tobi_looks looks;
    tobi_results *results;
    nest_results *nests;
    tobi_moment moment;
    tobi_drawing *drawing;
} source;

static void free_source(source *s)
{
    tobi_drawing_free(s->drawing);
    tobi_moment_free(&s->moment);
    tobi_results_free(s->results);
    close_nests(s->nests);
    tobi_looks_free(&s->looks);
    tobi_scene_free(s->scene);
}

/* The output that is asked for: by its number, by its time, or the last. */
static int64_t find_output(const draw_options *o, const tobi_results *results)
{
    const int64_t count = tobi_results_count(results);
    int64_t best = count - 1;
    if (o->output >= 0) return o->output;
    for (int64_t k = 0; o->time >= 0 && k < count; k++)
        if (fabs(tobi_results_time(results, k) - o->time) < fabs(tobi_results_time(results, best) - o->time))
            best = k;
    return best;
}

static int find_view(source *s, const char *dir, const char *name)
{
    const tobi_output_def *output = tobi_scene_output_def(s->scene);
    s->view = name ? NULL : &output->view;
    for (int k = 0; !s->view && k < output->view_count; k++)
        if (strcmp(output->views[k].name, name) == 0) s->view = &output->views[k];
    return s->view ? 0 : complain("the scene of %s has no view '%s'", dir, name);
}

/* Of a view, output.picture and output.camera are its own. */
static overrides sets_of_view(const overrides *set, const char *view)
{
    static const char *const keys[] = { "output.picture", "output.camera" };
    overrides own = { 0 };
    for (int k = 0; k < set->count; k++) {
        const char *text = set->text[k];
        int is_own = 0;
        for (int n = 0; view && n < 2; n++) {
            const size_t length = strlen(keys[n]);
            is_own |= strncmp(text, keys[n], length) == 0 && text[length] && strchr(".=", text[length]);
        }
        if (is_own) overrides_add(&own, "output.views.%s.%s", view, text + strlen("output."));
        else overrides_add(&own, "%s", text);
    }
    return own;
}

static int open_source(source *s, const char *dir, const char *view, const overrides *set)
{
    tobi_error err = { 0 };
    overrides own = sets_of_view(set, view);
    int code = load_looks(dir, &own, &s->scene, &s->looks);
    overrides_free(&own);
    if (code == 0) code = find_view(s, dir, view);
    if (code == 0 && tobi_results_open(dir, &s->results, &err) != TOBI_OK) code = complain("%s", err.text);
    if (code == 0 && s->view->nests) s->nests = open_nests(s->scene, dir);
    if (code == 0) code = take_outer_colors(s->nests, &s->looks);
    return code;
}

/* The drawing of an output; that before is gone. */
static tobi_status draw_output(source *s, const char *dir, int64_t output, tobi_error *err)
{
    tobi_drawing_free(s->drawing);
    s->drawing = NULL;
    tobi_moment_free(&s->moment);
    tobi_status status = tobi_results_read(s->results, output, &s->moment, err);
    if (status == TOBI_OK && s->view->foam)
        status = tobi_results_read_foam(s->results, output, &s->moment, err);
    if (status == TOBI_OK) add_nests(s->nests, &s->looks, &s->moment);
    if (status == TOBI_OK && s->view->paths) status = tobi_tracks_read(dir, &s->moment, err);
    if (status == TOBI_OK) status = tobi_drawing_make(&s->looks, &s->moment, s->view, &s->drawing, err);
    return status;
}

static int write_drawing(const source *s, const char *out)
{
    tobi_error err = { 0 };
    return tobi_picture_write(out, tobi_drawing_picture(s->drawing), &err) == TOBI_OK
        ? 0 : complain("%s", err.text);
}

/* The nearest output to a time that the run has not come to is its last. */
static void note_end(const draw_options *o, const tobi_results *results)
{
    const int64_t last = tobi_results_count(results) - 1;
    const double end = last >= 0 ? tobi_results_time(results, last) : 0;
    const double step = last > 0 ? end - tobi_results_time(results, last - 1) : 0;
    if (o->output < 0 && o->time > end + step)
        complain("note: the results of %s end at %g s", o->dir, end);
}

static void note_camera(const source *s)
{
    const char *body = tobi_drawing_body_around(s->drawing);
    if (body)
        complain("note: the camera is inside of the body '%s', which hides all else", body);
}

static int draw(const draw_options *o, source *s)
{
    char *path = NULL;
    tobi_error err = { 0 };
    int code = open_source(s, o->dir, o->view, &o->set);
    if (code == 0) note_end(o, s->results);
    if (code == 0 && draw_output(s, o->dir, find_output(o, s->results), &err) != TOBI_OK)
        code = complain("%s", err.text);
    if (code != 0) return code;
    const tobi_picture *p = tobi_drawing_picture(s->drawing);
    if (asprintf(&path, "%s/picture.png", o->dir) < 0) return complain("out of memory");
    const char *out = o->out ? o->out : path;
    note_camera(s);
    code = write_drawing(s, out);
    if (code == 0) printf(tr("picture: %s, %d x %d, %s\n"), out, p->width, p->height, p->title);
    free(path);
    return code;
}

/* The number of the first picture from `k` on that is not there. */
static int64_t find_gap(const char *folder, const char *view, int64_t k)
{
    while (is_picture(folder, view, k)) k++;
    return k;
}

/* The picture of an output into folder/frames. *lost counts those that cannot be drawn, because results are
   missing; the first is said. A picture that cannot be written ends all. */
static int draw_into(source *s, const char *dir, const char *view, const char *folder, int64_t k,
                     long long *lost)
{
    tobi_error err = { 0 };
    if (draw_output(s, dir, k, &err) != TOBI_OK) {
        if ((*lost)++ == 0) complain("%s", err.text);
        return 0;
    }
    char *path = frame_path(folder, view, k);
    const int code = path ? write_drawing(s, path) : complain("out of memory");
    free(path);
    return code;
}

static int say_lost(long long lost)
{
    if (lost > 1) complain("so %lld pictures cannot be drawn", lost);
    return lost > 0 ? EXIT_ERROR : 0;
}

/* Those between others that are there, too. */
static int draw_gaps(source *s, const char *dir, const char *view, const char *folder)
{
    const int64_t count = tobi_results_count(s->results);
    long long missing = 0, lost = 0;
    int code = 0;
    for (int64_t k = 0; (k = find_gap(folder, view, k)) < count; k++) missing++;
    if (missing > 0) complain("note: draws %lld picture%s into %s/frames", missing,
                             missing > 1 ? "s" : "", folder);
    for (int64_t k = 0; code == 0 && (k = find_gap(folder, view, k)) < count; k++) {
        code = draw_into(s, dir, view, folder, k, &lost);
        if (code == 0 && k == 0 && s->drawing) note_camera(s);
    }
    return code == 0 ? say_lost(lost) : code;
}

/* Those that are there. */
static int draw_anew(source *s, const char *dir, const char *view)
{
    const int64_t count = tobi_results_count(s->results);
    long long there = 0, lost = 0;
    int code = 0;
    for (int64_t k = 0; k < count; k++) there += is_picture(dir, view, k);
    if (there > 0)
        complain("note: draws %lld picture%s in %s/frames anew", there, there > 1 ? "s" : "",
                dir);
    for (int64_t k = 0; code == 0 && k < count; k++)
        if (is_picture(dir, view, k)) code = draw_into(s, dir, view, dir, k, &lost);
    return code == 0 ? say_lost(lost) : code;
}

int draw_again(const char *dir, const char *view)
{
    const overrides none = { 0 };
    source s = { 0 };
    int code = open_source(&s, dir, view, &none);
    if (code == 0 && s.view->foam) code = draw_anew(&s, dir, view);
    const int lacks = code == 0 && tobi_scene_output_def(s.scene)->frames;
    free_source(&s);
    return lacks ? draw_missing(dir, view, &none, dir) : code;
}

int draw_missing(const char *dir, const char *view, const overrides *set, const char *folder)
{
    source s = { 0 };
    char *frames = NULL;
    if (asprintf(&frames, "%s/frames", folder) < 0) return complain("out of memory");
    int code = open_source(&s, dir, view, set);
    if (code == 0 && mkdir(frames, 0777) != 0 && errno != EEXIST)
        code = complain("cannot make the folder %s: %s", frames, tr(strerror(errno)));
    if (code == 0) code = draw_gaps(&s, dir, view, folder);
    free_source(&s);
    free(frames);
    return code;
}

const struct argp picture_argp = { .options = options, .parser = parse, .args_doc = "DIR",
    .doc = "Draw a picture of an output of the run in DIR: water as it looks or the colours of a field, with "
           "arrows, axes, a clip plane. Everything under output.picture and output.camera can be set, of a "
           "view too." };

int tobiuo_picture(int argc, char **argv)
{
    draw_options o = { .output = -1, .time = -1 };
    source s = { 0 };
    parse_arguments(&picture_argp, argc, argv, &o);
    const int code = draw(&o, &s);
    free_source(&s);
    overrides_free(&o.set);
    return code;
}
