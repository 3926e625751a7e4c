/* What is written over the picture: time, colours, curves, particles, the time line, help. Drawback: sizes
   are in pixels, small on screens of very fine pixels. */
#define _GNU_SOURCE 1
#include "keys.h"
#include "tobiuo/overlay.h"
#include "tobiuo/tobiuo.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const uint8_t ink[3] = { 25, 32, 45 }, paper[3] = { 255, 255, 255 }, grey[3] = { 120, 130, 145 },
                     mark[3] = { 200, 30, 40 }, now[3] = { 0, 90, 180 };
static const uint8_t curve_colors[GRAPH_CURVES][3] = { { 0, 114, 178 }, { 213, 94, 0 }, { 0, 158, 115 } };
enum { SIZE = 9, LINE = 18, LEGEND_WIDTH = 300 };

typedef tobi_overlay canvas;

static const char *unit_of(const char *field)
{
    const char *unit;
    return tobi_world_find_field(field, NULL, &unit) && strcmp(unit, "1") != 0 ? unit : "";
}

static const char *state_of(const viewer *v)
{
    if (!v->def.live) return v->playing ? window_text(v, TEXT("plays")) : "";
    if (live_has_ended(v->def.live)) return window_text(v, TEXT("the run has ended"));
    if (v->shown < v->outputs) return window_text(v, TEXT("an earlier output; > shows the present"));
    return v->paused ? window_text(v, TEXT("paused")) : window_text(v, TEXT("runs"));
}

static void draw_head(const viewer *v, const canvas *c)
{
    char text[200];
    const look *l = &v->look;
    snprintf(text, sizeof text, "t = %.5g s", v->moment ? moment_of(v->moment)->time : 0);
    float x = 16 + tobi_overlay_text(c, 16, 28, 12, text, ink) + 16;
    x += tobi_overlay_text(c, x, 28, SIZE, state_of(v), grey) + 16;
    if (v->recording) tobi_overlay_text(c, x, 28, SIZE, window_text(v, TEXT("recording")), mark);
    if (l->clip_axis < 0) return;
    snprintf(text, sizeof text, window_text(v, TEXT("clip: %c %s %.4g m")), "xyz"[l->clip_axis],
             l->clip_below ? ">" : "<", l->clip);
    tobi_overlay_text(c, 16, 50, SIZE, text, ink);
}

static int64_t row_of(const tobi_moment *m, int64_t id)
{
    const tobi_moment_field *f = find_field(m, "particle_id");
    if (!f) return id < m->count ? id : -1;
    for (int64_t i = 0; i < m->count; i++)
        if ((int64_t)f->values[i] + (m->nest ? m->nest[i]*NEST_PICK : 0) == id) return i;
    return -1;
}

/* Where the box of the particles that are read ends; rows: of the moment, -1 = none. */
static int find_picks(const viewer *v, int64_t row[PICKS], int *count)
{
    const tobi_moment *m = v->moment ? moment_of(v->moment) : NULL;
    *count = 0;
    for (int k = 0; k < PICKS; k++) {
        row[k] = m && v->picks[k] >= 0 ? row_of(m, v->picks[k]) : -1;
        *count += row[k] >= 0;
    }
    return *count ? 20 + LINE*(*count*(m->field_count + 2) + (*count == 2)) : 0;
}

static void draw_colors(const viewer *v, const canvas *c)
{
    enum { HIGH = 240, WIDE = 16 };
    int64_t row[PICKS];
    int count, right = v->width, y = (v->height - HIGH)/2;
    const int picks_end = find_picks(v, row, &count);
    if (picks_end > y - 32) {      /* below the particles that are read, or beside them */
        if (picks_end + HIGH + 100 < v->height) y = picks_end + 48;
        else right -= LEGEND_WIDTH + 30;
    }
    const int x = right - 90;
    char text[160], label[160];
    if (!*v->look.field) return;
    tobi_field_label(v->look.field, label, sizeof label);
    const float left = fminf((float)x, (float)right - tobi_overlay_text_width(c, SIZE, label) - 8);
    tobi_overlay_box(c, (int)left - 8, y - 32, right - (int)left + 8, HIGH + 48, paper, 0.75f);
    for (int step = 0; step < HIGH; step++) {
        float color[3];
        uint8_t bytes[3];
        map_color(1 - (double)step/(HIGH - 1), color);
        for (int k = 0; k < 3; k++) bytes[k] = (uint8_t)(255*color[k] + 0.5f);
        tobi_overlay_box(c, x, y + step, WIDE, 1, bytes, 1);
    }
    for (int k = 0; k <= 4; k++) {
        const float at = (float)(y + HIGH - k*(HIGH - 1)/4);
        snprintf(text, sizeof text, "%.4g", v->look.low + k*(v->look.high - v->look.low)/4);
        tobi_overlay_line(c, (float)(x + WIDE), at, (float)(x + WIDE + 4), at, 1, ink);
        tobi_overlay_text(c, (float)(x + WIDE + 7), at + 4, SIZE, text, ink);
    }
    tobi_overlay_text(c, left, (float)y - 12, SIZE, label, ink);
}

static void draw_time_line(const viewer *v, const canvas *c)
{
    int x, y, width, height;
    time_line_place(v, &x, &y, &width, &height);
    const double end = viewer_end(v);
    const tobi_moment *m = v->moment ? moment_of(v->moment) : NULL;
    tobi_overlay_box(c, x, y + 4, width, 4, paper, 0.7f);
    if (!(end > 0)) return;
    for (int64_t k = 0; k < v->outputs && v->outputs < width; k++) {
        const float at = (float)(x + width*tobi_results_time(v->results, k)/end);
        tobi_overlay_line(c, at, (float)y + 2, at, (float)(y + height - 2), 1, grey);
    }
    if (m) tobi_overlay_box(c, x + (int)(width*m->time/end) - 3, y, 6, height, now, 1);
}

/* --- curves --- */

typedef struct frame { float x, y, wide, high; double end, low, top; } frame;

static frame frame_graph(const viewer *v)
{
    const graph *g = &v->graph;
    frame f = { .x = 70, .y = (float)v->height - 220, .wide = 250, .high = 140, .low = 0, .top = 0 };
    f.end = viewer_end(v);
    for (int k = 0; k < g->curves; k++)
        for (size_t i = 0; i < g->count; i++) {
            if (!isfinite(g->value[k][i])) continue;
            f.low = fmin(f.low, g->value[k][i]);
            f.top = fmax(f.top, g->value[k][i]);
        }
    if (!(f.top > f.low)) f.top = f.low + 1;
    return f;
}

static void draw_curve(const canvas *c, const graph *g, const frame *f, int k)
{
    float x0 = 0, y0 = 0;
    for (size_t i = 0; i < g->count; i++) {
        const float x = f->x + f->wide*(float)(g->time[i]/f->end);
        const float y = f->y + f->high*(float)((f->top - g->value[k][i])/(f->top - f->low));
        if (i > 0) tobi_overlay_line(c, x0, y0, x, y, 1.6f, curve_colors[k]);
        x0 = x;
        y0 = y;
    }
}

static void draw_graph(const viewer *v, const canvas *c)
{
    const graph *g = &v->graph;
    const frame f = frame_graph(v);
    char text[64];
    if (v->graph_number < 0 || g->count < 2 || !(f.end > 0)) return;
    tobi_overlay_box(c, (int)f.x - 54, (int)f.y - 32, (int)f.wide + 70, (int)f.high + 44, paper, 0.75f);
    float x = f.x + tobi_overlay_text(c, f.x, f.y - 14, SIZE, g->title, ink) + 12;
    for (int k = 0; k < g->curves; k++) {
        int any = 0;
        for (size_t i = 0; i < g->count && !any; i++) any = g->value[k][i] != 0;
        if (!any) continue;
        draw_curve(c, g, &f, k);
        x += tobi_overlay_text(c, x, f.y - 14, SIZE, g->label[k], curve_colors[k]) + 8;
    }
    for (int k = 0; k <= 2; k++) {
        const float y = f.y + f.high*(float)k/2;
        tobi_overlay_line(c, f.x, y, f.x + f.wide, y, 0.5f, grey);
        const double value = f.top - k*(f.top - f.low)/2;
        snprintf(text, sizeof text, "%.3g", fabs(value) < 1e-3*(f.top - f.low) ? 0 : value);
        tobi_overlay_text(c, f.x - 6 - tobi_overlay_text_width(c, 8, text), y + 4, 8, text, ink);
    }
    if (v->moment) {
        const float at = f.x + f.wide*(float)(moment_of(v->moment)->time/f.end);
        tobi_overlay_line(c, at, f.y, at, f.y + f.high, 1, now);
    }
}

/* --- particles --- */

static void mark_particle(const viewer *v, const canvas *c, const double point[3], int number)
{
    double pixel[3], scale;
    if (!camera_project(&v->look.camera, v->width, v->height, point, pixel, &scale)) return;
    const float x = (float)pixel[0], y = (float)pixel[1];
    tobi_overlay_line(c, x - 9, y, x + 9, y, 1.6f, mark);
    tobi_overlay_line(c, x, y - 9, x, y + 9, 1.6f, mark);
    tobi_overlay_text(c, x + 10, y - 4, SIZE, number == 0 ? "1" : "2", mark);
}

static int write_row(const viewer *v, const canvas *c, int line, const char *text)
{
    tobi_overlay_text(c, (float)(v->width - LEGEND_WIDTH - 10), (float)(40 + LINE*line), SIZE, text, ink);
    return line + 1;
}

static int write_particle(const viewer *v, const canvas *c, const tobi_moment *m, int64_t i, int number,
                          int line)
{
    char text[200];
    const double *p = m->positions[i];
    snprintf(text, sizeof text, window_text(v, TEXT("%d  particle %lld")), number + 1,
             (long long)(v->picks[number]%NEST_PICK));
    line = write_row(v, c, line, text);
    snprintf(text, sizeof text, window_text(v, TEXT("position %.5g %.5g %.5g m")), p[0], p[1], p[2]);
    line = write_row(v, c, line, text);
    for (int k = 0; k < m->field_count; k++) {
        const tobi_moment_field *f = &m->fields[k];
        const double *value = f->values + i*f->components;
        if (strcmp(f->name, "particle_id") == 0 || (f->components != 1 && f->components != 3)) continue;
        if (f->components == 3)
            snprintf(text, sizeof text, "%.60s %.4g %.4g %.4g %s", f->name, value[0], value[1], value[2],
                     unit_of(f->name));
        else snprintf(text, sizeof text, "%.60s %.6g %s", f->name, value[0], unit_of(f->name));
        line = write_row(v, c, line, text);
    }
    return line;
}

static void draw_picks(const viewer *v, const canvas *c)
{
    const tobi_moment *m = v->moment ? moment_of(v->moment) : NULL;
    int64_t row[PICKS];
    int line = 0, count;
    const int end = find_picks(v, row, &count);
    if (!count) return;
    tobi_overlay_box(c, v->width - LEGEND_WIDTH - 22, 20, LEGEND_WIDTH + 12, end - 20, paper, 0.75f);
    for (int k = 0; k < PICKS; k++) {
        if (row[k] < 0) continue;
        mark_particle(v, c, m->positions[row[k]], k);
        line = write_particle(v, c, m, row[k], k, line);
    }
    if (count < 2) return;
    const double *a = m->positions[row[0]], *b = m->positions[row[1]];
    char text[120];
    snprintf(text, sizeof text, window_text(v, TEXT("distance %.6g m")),
             sqrt((a[0] - b[0])*(a[0] - b[0]) + (a[1] - b[1])*(a[1] - b[1]) +
                                                        (a[2] - b[2])*(a[2] - b[2])));
    write_row(v, c, line, text);
}

/* --- help and questions --- */

static void draw_help(const viewer *v, const canvas *c)
{
    int rows = 0, line = 0;
    for (const key_row *k = key_rows; k->key >= 0; k++) rows += k->name != NULL;
    const int high = LINE*rows + 28, x = (v->width - 450)/2, y = (v->height - high)/2;
    tobi_overlay_box(c, x, y, 450, high, paper, 0.92f);
    for (const key_row *k = key_rows; k->key >= 0; k++) {
        if (!k->name) continue;
        const float at = (float)(y + 28 + LINE*line++);
        tobi_overlay_text(c, (float)x + 20, at, SIZE, window_text(v, k->name), now);
        tobi_overlay_text(c, (float)x + 150, at, SIZE, window_text(v, k->does), ink);
    }
}

static void draw_question(const viewer *v, const canvas *c)
{
    const int x = (v->width - 520)/2, y = v->height/2 - 30;
    tobi_overlay_box(c, x, y, 520, 60, paper, 0.95f);
    const float left = (float)x + 20;
    tobi_overlay_text(c, left, (float)y + 25, SIZE + 1, window_text(v, TEXT("Close. And the run?")), ink);
    tobi_overlay_text(c, left, (float)y + 46, SIZE,
                      window_text(v, TEXT("Enter or g: it goes on.  s: it stops.  another key: back")),
                      now);
}

void draw_legend(viewer *v)
{
    const canvas c = { v->pixels, v->width, v->height, v->letters };
    draw_head(v, &c);
    draw_colors(v, &c);
    draw_time_line(v, &c);
    draw_graph(v, &c);
    draw_picks(v, &c);
    tobi_overlay_text(&c, 20, (float)v->height - 38, SIZE, v->note, grey);
    if (v->help) draw_help(v, &c);
    if (v->asks) draw_question(v, &c);
}
