/* What keys and mouse do. One table of keys makes the help too. Drawback: letters are those typed, so that a
   keyboard without Latin letters needs its other layout. */
#define _GNU_SOURCE 1
#include "viewer.h"
#include "keys.h"
#include "../tobiuo/app.h"
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

/* What the window has no letters for, such as an error in Japanese without a font, goes to the terminal. */
void viewer_note(viewer *v, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vsnprintf(v->note, sizeof v->note, window_text(v, format), args);
    va_end(args);
    if (!tobi_letters_have(v->letters, v->note) && v->screen) {
        complain("%s", v->note);
        snprintf(v->note, sizeof v->note, "%s", window_text(v, TEXT("told on the terminal")));
    }
    v->changed = 1;
}

double viewer_end(const viewer *v)
{
    const double last = v->outputs ? tobi_results_time(v->results, v->outputs - 1) : 0;
    return v->def.live ? fmax(last, live_time(v->def.live)) : last;
}

void time_line_place(const viewer *v, int *x, int *y, int *width, int *height)
{
    *x = 20;
    *y = v->height - 26;
    *width = v->width - 40 > 1 ? v->width - 40 : 1;
    *height = 12;
}

/* --- moments --- */

/* Of the liquids of the scene and its nests that which is drawn there. */
static int is_drawn(const viewer *v, const tobi_moment *m, int64_t i)
{
    return v->look.alone ? !m->nest || !m->nest[i] : tobi_moment_shows(m, i);
}

/* The range of the field grows with what was seen of it, so that colours keep their meaning. */
static void widen_range(viewer *v, int anew)
{
    const tobi_moment *m = v->moment ? moment_of(v->moment) : NULL;
    const tobi_moment_field *f = m ? find_field(m, v->look.field) : NULL;
    if (anew) v->look.low = INFINITY, v->look.high = -INFINITY;
    else if (v->flat) v->look.high = v->look.low;
    for (int64_t i = 0; f && i < m->count; i++) {
        const double value = tobi_drawing_value(&v->def.looks, f, i);
        if (!isfinite(value) || !is_drawn(v, m, i)) continue;
        v->look.low = fmin(v->look.low, value);
        v->look.high = fmax(v->look.high, value);
    }
    if (!(v->look.low <= v->look.high)) v->look.low = v->look.high = 0;
    v->flat = v->look.low == v->look.high;
    if (v->flat) v->look.high = v->look.low + (v->look.low != 0 ? 1e-6*fabs(v->look.low) : 1);
}

void viewer_adopt(viewer *v, shared_moment *m)
{
    if (!m) return;
    moment_drop(v->moment);
    v->moment = m;
    if (*v->look.field) widen_range(v, 0);
    v->dirty = v->changed = 1;
}

void viewer_show(viewer *v, int64_t output)
{
    tobi_moment m;
    tobi_error err = { 0 };
    const int64_t most = v->def.live ? v->outputs : v->outputs - 1;
    v->shown = output < 0 ? 0 : output > most ? most : output;
    v->changed = 1;
    if (v->shown == v->outputs) {
        if (v->def.live) live_ask(v->def.live, 1);
        return;
    }
    if (tobi_results_read(v->results, v->shown, &m, &err) != TOBI_OK) {
        viewer_note(v, "%.280s", err.text);
        return;
    }
    if (tobi_results_read_foam(v->results, v->shown, &m, &err) != TOBI_OK)
        viewer_note(v, "%.280s", err.text);
    add_nests(v->def.nests, &v->def.looks, &m);
    viewer_adopt(v, moment_share(&m));
}

static void scrub(viewer *v, double x)
{
    int left, top, width, height;
    time_line_place(v, &left, &top, &width, &height);
    const double time = viewer_end(v)*fmax(0, fmin(1, (x - left)/width));
    int64_t nearest = 0;
    for (int64_t k = 0; k < v->outputs; k++)
        if (fabs(tobi_results_time(v->results, k) - time) < fabs(tobi_results_time(v->results,
                nearest) - time))
            nearest = k;
    if (v->def.live && x >= left + width - 2) nearest = v->outputs;
    if (nearest != v->shown && (v->outputs || v->def.live)) viewer_show(v, nearest);
}

/* --- actions of keys --- */

static void do_help(viewer *v) { v->help = !v->help; }

static void do_home(viewer *v)
{
    camera_home(&v->look.camera, v->def.looks.dimension, v->def.looks.box_min, v->def.looks.box_max,
                v->def.up, v->def.eye, v->def.target, v->def.angle);
    v->dirty = 1;
}

static void choose_field(viewer *v, int by)
{
    const tobi_moment *m = v->moment ? moment_of(v->moment) : NULL;
    if (!m) return;
    int now = -1;
    for (int k = 0; k < m->field_count; k++)
        if (strcmp(m->fields[k].name, v->look.field) == 0) now = k;
    now = (now + 1 + by + m->field_count + 1)%(m->field_count + 1) - 1;
    snprintf(v->look.field, sizeof v->look.field, "%s", now < 0 ? "" : m->fields[now].name);
    if (now >= 0) widen_range(v, 1);
    v->dirty = 1;
}
static void do_field(viewer *v) { choose_field(v, 1); }
static void do_field_back(viewer *v) { choose_field(v, -1); }

static void do_range(viewer *v)
{
    widen_range(v, 1);
    v->dirty = 1;
}

static void do_clip(viewer *v)
{
    const int most = v->def.looks.dimension;
    v->look.clip_axis = v->look.clip_axis + 1 < most ? v->look.clip_axis + 1 : -1;
    if (v->look.clip_axis >= 0)
        v->look.clip = 0.5*(v->def.looks.box_min[v->look.clip_axis]
                            + v->def.looks.box_max[v->look.clip_axis]);
    v->dirty = 1;
}

static void do_clip_side(viewer *v)
{
    v->look.clip_below = !v->look.clip_below;
    v->dirty = 1;
}

static void move_clip(viewer *v, double share)
{
    const int a = v->look.clip_axis;
    if (a < 0) return;
    v->look.clip += share*(v->def.looks.box_max[a] - v->def.looks.box_min[a]);
    v->dirty = 1;
}
static void do_clip_back(viewer *v) { move_clip(v, -0.025); }
static void do_clip_on(viewer *v) { move_clip(v, 0.025); }

static void do_nests(viewer *v)
{
    v->look.alone = !v->look.alone;
    v->dirty = 1;
}

static void do_pause(viewer *v)
{
    if (!v->def.live) {
        v->playing = !v->playing;
        return;
    }
    v->paused = !v->paused;
    live_pause(v->def.live, v->paused);
}

static void do_step(viewer *v)
{
    if (!v->def.live || v->shown < v->outputs) {
        viewer_show(v, v->shown + 1);
        return;
    }
    if (!v->paused) do_pause(v);
    live_step(v->def.live);
    live_ask(v->def.live, 0);
}
static void do_back(viewer *v) { viewer_show(v, v->shown - 1); }
static void do_first(viewer *v) { viewer_show(v, 0); }
static void do_last(viewer *v) { viewer_show(v, v->outputs); }

static void do_graph(viewer *v)
{
    v->graph_number++;
    graph_read(v);
}

static void do_forget(viewer *v) { v->picks[0] = v->picks[1] = -1; }
static void do_shot(viewer *v) { v->wants_shot = 1; }

static void orbit(viewer *v, double yaw, double pitch)
{
    if (v->def.looks.dimension == 2) camera_pan(&v->look.camera, 400*yaw, 400*pitch, v->height);
    else camera_orbit(&v->look.camera, yaw, pitch);
    v->dirty = 1;
}
static void do_left(viewer *v) { orbit(v, 0.1, 0); }
static void do_right(viewer *v) { orbit(v, -0.1, 0); }
static void do_up(viewer *v) { orbit(v, 0, 0.1); }
static void do_down(viewer *v) { orbit(v, 0, -0.1); }

static void zoom(viewer *v, double factor)
{
    camera_zoom(&v->look.camera, factor);
    v->dirty = 1;
}
static void do_near(viewer *v) { zoom(v, 0.9); }
static void do_far(viewer *v) { zoom(v, 1/0.9); }

/* A run goes on or stops when its window closes: the user is asked. */
static void do_close(viewer *v)
{
    if (!v->def.live || live_has_ended(v->def.live)) v->ends = 1;
    else v->asks = 1;
}

const key_row key_rows[] = {
    { 'h', "h", TEXT("this help"), do_help }, { KEY_F1, NULL, NULL, do_help },
    { 0, TEXT("drag, arrows"), TEXT("turn; in 2-D move"), NULL },
    { KEY_LEFT, NULL, NULL, do_left }, { KEY_RIGHT, NULL, NULL, do_right },
    { KEY_UP, NULL, NULL, do_up }, { KEY_DOWN, NULL, NULL, do_down },
    { 0, TEXT("right drag"), TEXT("move; also shift and drag"), NULL },
    { 0, TEXT("wheel, + -"), TEXT("nearer, farther"), NULL },
    { '+', NULL, NULL, do_near }, { '=', NULL, NULL, do_near }, { '-', NULL, NULL, do_far },
    { '0', "0", TEXT("first view again"), do_home }, { KEY_HOME, NULL, NULL, do_home },
    { 'f', "f F", TEXT("next field, field before"), do_field }, { 'F', NULL, NULL, do_field_back },
    { 'r', "r", TEXT("colours from least to most of now"), do_range },
    { 'c', "c", TEXT("clip plane: x, y, z, none"), do_clip },
    { '[', "[ ] C", TEXT("move it, its other side"), do_clip_back }, { ']', NULL, NULL, do_clip_on },
    { 'C', NULL, NULL, do_clip_side },
    { 'o', "o", TEXT("nests, or the scene alone"), do_nests },
    { ' ', TEXT("space"), TEXT("play, or pause a run"), do_pause },
    { 'n', "n", TEXT("next output, or one step of a run"), do_step },
    { 'b', "b", TEXT("output before"), do_back },
    { '<', "< >", TEXT("first and last output"), do_first }, { '>', NULL, NULL, do_last },
    { KEY_END, NULL, NULL, do_last },
    { 'g', "g", TEXT("next curves: whole, bodies, none"), do_graph },
    { 0, TEXT("click"), TEXT("read a particle; two: distance"), NULL },
    { 'x', "x", TEXT("forget the particles"), do_forget },
    { 's', "s", TEXT("screenshot"), do_shot },
    { 'm', "m", TEXT("begin and end a movie"), toggle_recording },
    { 'q', "q, Esc", TEXT("close"), do_close }, { KEY_ESCAPE, NULL, NULL, do_close },
    { -1, NULL, NULL, NULL },
};

/* --- the mouse --- */

/* The particle in front at these pixels; -1: none. */
static int64_t find_particle(const viewer *v, double x, double y)
{
    const tobi_moment *m = v->moment ? moment_of(v->moment) : NULL;
    int64_t found = -1;
    double nearest = INFINITY;
    const tobi_moment_field *material = m ? find_field(m, "material") : NULL;
    for (int64_t i = 0; m && i < m->count; i++) {
        double pixel[3], scale;
        if (is_clipped(&v->look, m->positions[i]) || !is_drawn(v, m, i)) continue;
        if (tobi_looks_hides(&v->def.looks, m->time, m->positions[i])) continue;
        if (!camera_project(&v->look.camera, v->width, v->height, m->positions[i], pixel, &scale)) continue;
        const double own = tobi_looks_radius(&v->def.looks, material ? (int)material->values[i] : 0);
        const double off = hypot(pixel[0] - x, pixel[1] - y), radius = fmax(3, 1.2*scale*own);
        const double depth = pixel[2] + (v->def.looks.dimension == 2 ? off : 0);
        if (off > radius || depth >= nearest) continue;
        nearest = depth;
        found = i;
    }
    return found;
}

static void pick(viewer *v, double x, double y)
{
    const int64_t i = find_particle(v, x, y);
    if (i < 0) return;
    const tobi_moment *m = moment_of(v->moment);
    const tobi_moment_field *id = find_field(m, "particle_id");
    v->picks[1] = v->picks[0];
    v->picks[0] = id ? (int64_t)id->values[i] + (m->nest ? m->nest[i]*NEST_PICK : 0) : i;
}

static void press(viewer *v, const event *e)
{
    int left, top, width, height;
    time_line_place(v, &left, &top, &width, &height);
    v->drag = e->button || e->shift || v->def.looks.dimension == 2 ? 2 : 1;
    if (e->y >= top - 6) {
        v->drag = 3;
        scrub(v, e->x);
    }
    v->drag_x = e->x;
    v->drag_y = e->y;
    v->moved = 0;
}

static void move(viewer *v, const event *e)
{
    const double x = e->x - v->drag_x, y = e->y - v->drag_y;
    if (!v->drag) return;
    v->moved += fabs(x) + fabs(y);
    if (v->drag == 3) scrub(v, e->x);
    else if (v->drag == 2) camera_pan(&v->look.camera, x, y, v->height);
    else camera_orbit(&v->look.camera, -0.008*x, 0.008*y);
    v->dirty |= v->drag != 3;
    v->drag_x = e->x;
    v->drag_y = e->y;
}

static void release(viewer *v, const event *e)
{
    if (v->drag && v->drag != 3 && v->moved < 4) pick(v, e->x, e->y);
    v->drag = 0;
}

static void answer(viewer *v, int key)
{
    if (key == KEY_ENTER || key == 'g' || key == 's') {
        live_leave(v->def.live, key == 's' ? LIVE_STOPS : LIVE_GOES_ON);
        v->ends = 1;
    }
    v->asks = 0;
}

static void press_key(viewer *v, int key)
{
    if (v->asks) {
        answer(v, key);
        return;
    }
    for (const key_row *k = key_rows; k->key >= 0; k++)
        if (k->key == key && k->act) {
            k->act(v);
            return;
        }
}

void viewer_event(viewer *v, const event *e)
{
    v->changed = 1;
    switch (e->kind) {
    case EVENT_KEY: press_key(v, e->key); break;
    case EVENT_PRESS: press(v, e); break;
    case EVENT_MOVE: move(v, e); break;
    case EVENT_RELEASE: release(v, e); break;
    case EVENT_SCROLL: zoom(v, pow(0.9, e->amount)); break;
    case EVENT_CLOSE:
        if (v->def.live) live_leave(v->def.live, LIVE_GOES_ON);
        v->ends = 1;
        break;
    default: break;
    }
}
