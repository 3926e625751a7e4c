/* Pictures in a thread of their own, by tobi_picture_draw. Drawback: a picture that was begun is finished,
   though the camera has moved on. */
#define _GNU_SOURCE 1
#include "painter.h"
#include "tobiuo/drawing.h"
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

struct shared_moment { tobi_moment moment; int holders; };

shared_moment *moment_share(tobi_moment *m)
{
    shared_moment *s = malloc(sizeof *s);
    if (!s) {
        tobi_moment_free(m);
        return NULL;
    }
    *s = (shared_moment){ *m, 1 };
    *m = (tobi_moment){ 0 };
    return s;
}

const tobi_moment *moment_of(const shared_moment *m) { return &m->moment; }

shared_moment *moment_hold(shared_moment *m)
{
    if (m) __atomic_add_fetch(&m->holders, 1, __ATOMIC_RELAXED);
    return m;
}

void moment_drop(shared_moment *m)
{
    if (!m || __atomic_sub_fetch(&m->holders, 1, __ATOMIC_ACQ_REL) > 0) return;
    tobi_moment_free(&m->moment);
    free(m);
}

struct painter {
    const tobi_looks *looks;
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t changed;
    int ends, busy, has_order, has_done;
    look order;
    shared_moment *moment;              /* of the order, held */
    painting done;
    void (*tell)(void *user);
    void *user;
};

/* --- what a picture is made of --- */

const tobi_moment_field *find_field(const tobi_moment *m, const char *name)
{
    for (int k = 0; k < m->field_count; k++)
        if (strcmp(m->fields[k].name, name) == 0) return &m->fields[k];
    return NULL;
}

/* Viridis, which grows evenly lighter and is told apart by any colour vision. */
void map_color(double share, float color[3])
{
    static const float knots[][3] = {
        { 0.267f, 0.005f, 0.329f }, { 0.283f, 0.141f, 0.458f }, { 0.254f, 0.265f, 0.530f },
        { 0.207f, 0.372f, 0.553f }, { 0.164f, 0.471f, 0.558f }, { 0.128f, 0.567f, 0.551f },
        { 0.135f, 0.659f, 0.518f }, { 0.267f, 0.749f, 0.441f }, { 0.478f, 0.821f, 0.318f },
        { 0.741f, 0.873f, 0.150f }, { 0.993f, 0.906f, 0.144f },
    };
    enum { LAST = sizeof knots/sizeof *knots - 1 };
    const double at = fmax(0, fmin(1, share))*LAST;
    const int k = at < LAST ? (int)at : LAST - 1;
    for (int c = 0; c < 3; c++) color[c] = knots[k][c] + (float)(at - k)*(knots[k + 1][c] - knots[k][c]);
}

int is_clipped(const look *l, const double point[3])
{
    if (l->clip_axis < 0) return 0;
    return l->clip_below ? point[l->clip_axis] < l->clip : point[l->clip_axis] > l->clip;
}

/* The camera and the clip plane of the window. */
static void set_view(const tobi_looks *s, const look *l, tobi_picture *f)
{
    const int flat = s->dimension == 2;
    f->title = f->label = NULL;
    if (flat) {
        memcpy(f->box_min, l->camera.low, sizeof f->box_min);
        memcpy(f->box_max, l->camera.high, sizeof f->box_max);
    }
    f->has_camera = !flat;
    camera_eye(&l->camera, f->eye);
    memcpy(f->target, l->camera.target, sizeof f->target);
    f->field_of_view = l->camera.angle;
    f->threads = 0;
    f->clip = l->clip_axis >= 0;
    if (!f->clip) return;
    f->clip_normal[l->clip_axis] = l->clip_below ? -1 : 1;
    f->clip_point[l->clip_axis] = l->clip;
}

static double clock_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9*(double)t.tv_nsec;
}

static void paint(const tobi_looks *s, const tobi_moment *m, painting *out)
{
    const double begun = clock_seconds();
    const look *l = &out->look;
    const tobi_view_def view = { .width = l->width, .height = l->height, .samples = 1, .foam = 1,
                                 .nests = !l->alone, .field = *l->field ? l->field : NULL, .min = l->low,
                                 .max = l->high };
    tobi_drawing *d = NULL;
    tobi_error err = { .text = "out of memory" };
    out->rgb = malloc((size_t)l->width*(size_t)l->height*3);
    tobi_status status = out->rgb ? tobi_drawing_make(s, m, &view, &d, &err) : TOBI_NO_MEMORY;
    if (status == TOBI_OK) {
        set_view(s, l, tobi_drawing_picture(d));
        status = tobi_picture_draw(tobi_drawing_picture(d), out->rgb, &err);
    }
    tobi_drawing_free(d);
    if (status != TOBI_OK) {
        snprintf(out->why, sizeof out->why, "%.*s", (int)sizeof out->why - 1, err.text);
        free(out->rgb);
        out->rgb = NULL;
    }
    out->seconds = clock_seconds() - begun;
}

/* --- the thread --- */

void painting_free(painting *p)
{
    free(p->rgb);
    moment_drop(p->moment);
    *p = (painting){ 0 };
}

static void *work(void *user)
{
    painter *p = user;
    pthread_mutex_lock(&p->lock);
    while (!p->ends) {
        if (!p->has_order) {
            pthread_cond_wait(&p->changed, &p->lock);
            continue;
        }
        painting one = { .look = p->order, .moment = p->moment };
        p->moment = NULL;
        p->has_order = 0;
        p->busy = 1;
        pthread_mutex_unlock(&p->lock);
        paint(p->looks, moment_of(one.moment), &one);
        pthread_mutex_lock(&p->lock);
        p->busy = 0;
        painting_free(&p->done);
        p->done = one;
        p->has_done = 1;
        if (!p->ends) p->tell(p->user);
    }
    pthread_mutex_unlock(&p->lock);
    return NULL;
}

painter *painter_create(const tobi_looks *s, void (*done)(void *user), void *user)
{
    painter *p = calloc(1, sizeof *p);
    if (!p) return NULL;
    p->looks = s;
    p->tell = done;
    p->user = user;
    pthread_mutex_init(&p->lock, NULL);
    pthread_cond_init(&p->changed, NULL);
    if (pthread_create(&p->thread, NULL, work, p) == 0) return p;
    free(p);
    return NULL;
}

void painter_order(painter *p, shared_moment *m, const look *l)
{
    pthread_mutex_lock(&p->lock);
    moment_drop(p->moment);
    p->moment = moment_hold(m);
    p->order = *l;
    p->has_order = 1;
    pthread_cond_signal(&p->changed);
    pthread_mutex_unlock(&p->lock);
}

int painter_is_idle(painter *p)
{
    pthread_mutex_lock(&p->lock);
    const int idle = !p->busy && !p->has_order && !p->has_done;
    pthread_mutex_unlock(&p->lock);
    return idle;
}

int painter_take(painter *p, painting *out)
{
    pthread_mutex_lock(&p->lock);
    const int has = p->has_done;
    if (has) *out = p->done;
    p->done = (painting){ 0 };
    p->has_done = 0;
    pthread_mutex_unlock(&p->lock);
    return has;
}

void painter_free(painter *p)
{
    if (!p) return;
    pthread_mutex_lock(&p->lock);
    p->ends = 1;
    pthread_cond_signal(&p->changed);
    pthread_mutex_unlock(&p->lock);
    pthread_join(p->thread, NULL);
    moment_drop(p->moment);
    painting_free(&p->done);
    pthread_mutex_destroy(&p->lock);
    pthread_cond_destroy(&p->changed);
    free(p);
}
