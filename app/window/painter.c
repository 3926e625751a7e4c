/* Pictures in a thread of their own, by tobi_picture_draw. Drawback: a picture that was begun is finished,
   though the camera has moved on. */
#define _GNU_SOURCE 1
#include "painter.h"
#include "tobiuo/picture.h"
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { COLOURS = 64 };

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
    stage stage;
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

double field_value(const tobi_moment_field *f, int64_t particle)
{
    if (!f) return 0;
    const double *v = f->values + particle*f->components;
    if (f->components == 1) return v[0];
    double square = 0;
    for (int k = 0; k < f->components; k++) square += v[k]*v[k];
    return sqrt(square);
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

/* Arrays of one picture. */
typedef struct props {
    double (*positions)[3];
    float *values;
    uint8_t *opaque;
    float palette[COLOURS][3];
    tobi_picture_mesh *meshes;
} props;

/* Half the speed of a fall through the domain, as pictures of a run have it. */
static double color_speed(const stage *s)
{
    double size = 0;
    for (int k = 0; k < s->dimension; k++) size += fabs(s->up[k])*(s->high[k] - s->low[k]);
    return 0.5*sqrt(2*size);
}

static void add_particles(const stage *s, const tobi_moment *m, const look *l, props *p, tobi_picture *f)
{
    const int plain = !*l->field;
    const tobi_moment_field *material = plain && s->materials ? find_field(m, "material") : NULL;
    const tobi_moment_field *field = material ? material : find_field(m, plain ? "velocity" : l->field);
    int64_t n = 0;
    for (int64_t i = 0; i < m->count; i++) {
        memcpy(p->positions[n], m->positions[i], sizeof *p->positions);
        p->values[n] = (float)field_value(field, i);
        p->opaque[n++] = (uint8_t)s->opaque;
    }
    f->particle_count = n;
    f->positions = (const double (*)[3])p->positions;
    f->values = p->values;
    if (s->opaque) f->opaque = p->opaque;
    f->value_max = material ? COLOURS - 1 : plain ? color_speed(s) : l->high;
    f->value_min = plain ? 0 : l->low;
    for (int k = 0; k < COLOURS; k++) {
        if (material) memcpy(p->palette[k], s->material[k < s->materials ? k : 0], sizeof p->palette[k]);
        else map_color((double)k/(COLOURS - 1), p->palette[k]);
    }
    if (plain && s->dimension == 3 && !material && !s->opaque) f->values = NULL;     /* looks like water */
    if (!plain || material) {
        f->palette = (const float (*)[3])p->palette;
        f->palette_count = COLOURS;
    }
}

static void add_meshes(const stage *s, const tobi_moment *m, props *p, tobi_picture *f)
{
    static const float colors[4][3] = { { 0.93f, 0.62f, 0.28f }, { 0.80f, 0.33f, 0.36f }, { 0.55f, 0.70f,
            0.35f },
                                        { 0.62f, 0.50f, 0.74f } };
    for (int b = 0; b < m->surface_count; b++) {
        const tobi_moment_surface *from = &m->surfaces[b];
        const int known = b < s->bodies;
        p->meshes[b] = (tobi_picture_mesh){ .vertex_count = from->vertex_count,
            .vertices = (const double (*)[3])from->vertices, .triangle_count = from->triangle_count,
            .triangles = (const int32_t (*)[3])from->triangles,
            .transparency = known ? s->transparency[b] : 0, .hollow = known && s->hollow[b] };
        memcpy(p->meshes[b].color, known && s->body[b][0] >= 0 ? s->body[b] : colors[b%4],
               sizeof p->meshes[b].color);
    }
    f->meshes = p->meshes;
    f->mesh_count = m->surface_count;
}

static void set_view(const stage *s, const look *l, tobi_picture *f)
{
    *f = tobi_default_picture();
    f->dimension = s->dimension;
    f->width = l->width;
    f->height = l->height;
    f->samples = 1;
    f->radius = 0.5*s->spacing;
    const int flat = s->dimension == 2;
    memcpy(f->box_min, flat ? l->camera.low : s->low, sizeof f->box_min);
    memcpy(f->box_max, flat ? l->camera.high : s->high, sizeof f->box_max);
    memcpy(f->up, s->up, sizeof f->up);
    f->has_camera = !flat;
    camera_eye(&l->camera, f->eye);
    memcpy(f->target, l->camera.target, sizeof f->target);
    f->field_of_view = l->camera.angle;
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

static void paint(const stage *s, const tobi_moment *m, painting *out)
{
    const double begun = clock_seconds();
    const size_t n = (size_t)m->count + 1, bodies = (size_t)m->surface_count + 1;
    props p = { .positions = malloc(n*sizeof *p.positions), .values = malloc(n*sizeof *p.values),
                .opaque = malloc(n), .meshes = calloc(bodies, sizeof *p.meshes) };
    tobi_picture f;
    tobi_error err = { .text = "out of memory" };
    out->rgb = malloc((size_t)out->look.width*(size_t)out->look.height*3);
    set_view(s, &out->look, &f);
    int good = out->rgb && p.positions && p.values && p.opaque && p.meshes;
    if (good) {
        add_particles(s, m, &out->look, &p, &f);
        add_meshes(s, m, &p, &f);
        good = tobi_picture_draw(&f, out->rgb, &err) == TOBI_OK;
    }
    if (!good) {
        snprintf(out->why, sizeof out->why, "%.*s", (int)sizeof out->why - 1, err.text);
        free(out->rgb);
        out->rgb = NULL;
    }
    free(p.positions);
    free(p.values);
    free(p.opaque);
    free(p.meshes);
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
        paint(&p->stage, moment_of(one.moment), &one);
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

painter *painter_create(const stage *s, void (*done)(void *user), void *user)
{
    painter *p = calloc(1, sizeof *p);
    if (!p) return NULL;
    p->stage = *s;
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
