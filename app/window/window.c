/* The window's loop: events, orders to the painter, what lies over its pictures. While somebody moves the
   camera pictures are coarse, as coarse as it takes for some fifteen a second; when nothing moves the last
   is drawn whole. Drawback: three threads share the cores with the steps of a run. */
#define _GNU_SOURCE 1
#include "viewer.h"
#include "../tobiuo/app.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 1280, HEIGHT = 720, COARSEST = 6 };
static const double GOAL = 0.07, PERIOD = 0.02;        /* s of a coarse picture; between looks */

static void wake(void *user) { screen_wake(((viewer *)user)->screen); }

/* Pixels of a coarse picture, from the time that the last one took. */
static void choose_factor(viewer *v, const painting *p)
{
    const double whole = p->seconds*v->width*v->height/((double)p->look.width*p->look.height);
    v->factor = (int)fmax(1, fmin(COARSEST, ceil(sqrt(whole/GOAL))));
}

static void order_picture(viewer *v, int factor)
{
    v->look.width = v->width/factor < 16 ? 16 : v->width/factor;
    v->look.height = v->height/factor < 16 ? 16 : v->height/factor;
    painter_order(v->painter, v->moment, &v->look);
    v->dirty = 0;
}

static int is_whole(const viewer *v)
{
    return v->painting.rgb && v->painting.look.width == v->width && v->painting.look.height == v->height;
}

/* Nearest pixels of the picture, for those of the window. */
static void enlarge(viewer *v)
{
    const painting *p = &v->painting;
    memset(v->pixels, 200, (size_t)v->width*(size_t)v->height*3);
    if (!p->rgb) return;
    for (int y = 0; y < v->height; y++) {
        const unsigned char *row = p->rgb + 3*(size_t)(y*p->look.height/v->height)*(size_t)p->look.width;
        unsigned char *to = v->pixels + 3*(size_t)y*(size_t)v->width;
        for (int x = 0; x < v->width; x++) memcpy(to + 3*x, row + 3*(x*p->look.width/v->width), 3);
    }
}

static void fit_pixels(viewer *v)
{
    int width, height;
    screen_size(v->screen, &width, &height);
    if (v->pixels && width == v->width && height == v->height) return;
    free(v->pixels);
    v->width = width;
    v->height = height;
    v->pixels = malloc((size_t)width*(size_t)height*3);
    v->dirty = v->changed = 1;
}

static void show(viewer *v)
{
    if (!v->pixels) return;
    enlarge(v);
    draw_legend(v);
    screen_show(v->screen, v->pixels, v->width, v->height);
    v->changed = 0;
}

static void take_picture(viewer *v)
{
    painting p;
    if (!painter_take(v->painter, &p)) return;
    if (p.rgb) {
        choose_factor(v, &p);
        painting_free(&v->painting);
        v->painting = p;
        v->painted++;
    } else {
        viewer_note(v, TEXT("no picture: %s"), p.why);
        painting_free(&p);
    }
    v->changed = 1;
}

/* New outputs and moments of a run that goes on. */
static void follow_run(viewer *v)
{
    tobi_moment m;
    if (!v->def.live) return;
    if (live_take(v->def.live, &m)) {
        if (v->shown == v->outputs) viewer_adopt(v, moment_share(&m));
        else tobi_moment_free(&m);
        const int64_t before = v->outputs, present = v->shown == before;
        if (!v->results) tobi_results_open(v->def.dir, &v->results, NULL);
        else tobi_results_refresh(v->results, NULL);
        v->outputs = tobi_results_count(v->results);
        if (present) v->shown = v->outputs;
        if (v->outputs != before) graph_read(v);
    }
    /* a fast run would bring moments for ever, and none would be drawn whole */
    const int waits = (v->wants_shot || (v->keys && *v->keys)) && v->moment && !is_whole(v);
    if (v->shown == v->outputs && painter_is_idle(v->painter) && !waits) live_ask(v->def.live, 0);
}

static void play(viewer *v)
{
    if (!v->playing || wall_clock() < v->play_at || !painter_is_idle(v->painter)) return;
    v->play_at = wall_clock() + 1.0/30;
    viewer_show(v, v->shown + 1 < v->outputs ? v->shown + 1 : 0);
}

/* Keys of the definition wait for the whole picture of the key before. */
static void type_keys(viewer *v)
{
    if (!v->keys || !*v->keys || v->dirty || v->wants_shot || !is_whole(v)
        || !painter_is_idle(v->painter)) return;
    viewer_event(v, &(event){ .kind = EVENT_KEY, .key = (unsigned char)*v->keys++ });
}

static void turn(viewer *v)
{
    for (event e = screen_next(v->screen, PERIOD); e.kind != EVENT_NONE; e = screen_next(v->screen, 0)) {
        if (e.kind == EVENT_REDRAW) v->changed = 1;
        else viewer_event(v, &e);
    }
    fit_pixels(v);
    take_picture(v);
    follow_run(v);
    play(v);
    const int moves = v->drag == 1 || v->drag == 2 || v->playing;
    if (v->moment && painter_is_idle(v->painter)) {
        if (v->dirty) order_picture(v, v->recording || !(moves || v->def.live) ? 1 : v->factor);
        else if (!is_whole(v) && !moves && !v->changed) order_picture(v, 1);
    }
    if (v->changed) show(v);
    if (is_whole(v) && !v->dirty && painter_is_idle(v->painter)) {
        if (v->recording) record_picture(v);
        if (v->wants_shot) take_shot(v);
    }
    type_keys(v);
}

static int open_results(viewer *v)
{
    tobi_error err = { 0 };
    if (v->def.live) return 0;
    if (tobi_results_open(v->def.dir, &v->results, &err) != TOBI_OK) {
        complain("%s", err.text);
        return -1;
    }
    v->outputs = tobi_results_count(v->results);
    viewer_show(v, 0);
    if (v->moment) return 0;
    complain("%s", v->note);
    return -1;
}

static int open_viewer(viewer *v)
{
    char why[200];
    camera_home(&v->look.camera, v->def.looks.dimension, v->def.looks.box_min, v->def.looks.box_max,
                v->def.up, v->def.eye, v->def.target, v->def.angle);
    if (open_results(v) != 0) return -1;
    v->screen = screen_open(v->def.width ? v->def.width : WIDTH, v->def.height ? v->def.height : HEIGHT,
                            v->def.title, why);
    if (!v->screen) {
        complain("there is no window: %s", why);
        return -1;
    }
    v->painter = painter_create(&v->def.looks, wake, v);
    if (!v->painter) {
        complain("there is no window: out of memory");
        return -1;
    }
    if (v->def.live) live_set_wake(v->def.live, wake, v);
    graph_read(v);
    return 0;
}

static void close_viewer(viewer *v)
{
    if (v->def.live) live_set_wake(v->def.live, NULL, NULL);
    if (v->recording) toggle_recording(v);
    painter_free(v->painter);
    painting_free(&v->painting);
    moment_drop(v->moment);
    tobi_results_free(v->results);
    graph_free(&v->graph);
    free(v->pixels);
    if (v->screen) screen_close(v->screen);
}

const char *window_text(const viewer *v, const char *english)
{
    const char *text = tr(english);
    return tobi_letters_have(v->letters, text) ? text : english;
}

/* A run that Ctrl-C or SIGTERM stopped takes its window with it. */
static int is_stopped(const viewer *v)
{
    return v->def.live && is_interrupted() && live_has_ended(v->def.live);
}

int window_show(const window_def *def)
{
    viewer v = { .def = *def, .factor = 4, .dirty = 1, .changed = 1, .keys = def->keys, .graph_number = 0,
                 .letters = tobi_letters_open(), .picks = { -1, -1 },
                 .look = { .clip_axis = -1, .alone = def->alone } };
    const int code = open_viewer(&v);
    if (code == 0) viewer_note(&v, TEXT("h: keys"));
    while (code == 0 && !v.ends && !is_stopped(&v)) turn(&v);
    close_viewer(&v);
    tobi_letters_close(v.letters);
    return code;
}
