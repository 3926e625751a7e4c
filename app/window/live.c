/* A moment changes hands under a lock; the copy is made outside of it. Drawback: a step waits for the copy,
   some milliseconds for a million numbers, at most once per picture. */
#define _GNU_SOURCE 1
#include "live.h"
#include "tobiuo/drawing.h"
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

struct live {
    pthread_mutex_t lock;
    pthread_cond_t changed;
    int wanted, again, has_fresh, paused, steps, ended;
    live_end leave;
    tobi_moment fresh;
    double time, given;             /* s, of the last step; of the last moment */
    void (*wake)(void *user);
    void *user;
};

live *live_create(void)
{
    live *l = calloc(1, sizeof *l);
    if (!l) return NULL;
    pthread_mutex_init(&l->lock, NULL);
    pthread_cond_init(&l->changed, NULL);
    l->wanted = l->again = 1;
    return l;
}

void live_free(live *l)
{
    if (!l) return;
    tobi_moment_free(&l->fresh);
    pthread_cond_destroy(&l->changed);
    pthread_mutex_destroy(&l->lock);
    free(l);
}

static int is_wanted_field(const char *name, int components)
{
    static const char *const left_out[] = { "position", "piece", "cut_side", "texture_coordinates" };
    for (size_t k = 0; k < sizeof left_out/sizeof *left_out; k++)
        if (strcmp(name, left_out[k]) == 0) return 0;      /* costly, or no value to look at */
    return components == 1 || components == 3;
}

/* A field that cannot be read is left out: a window is no reason to fail. */
static void copy_field(tobi_world *world, const char *name, int components, tobi_moment *m)
{
    tobi_moment_field *fields = reallocarray(m->fields, (size_t)m->field_count + 1, sizeof *fields);
    if (!fields) return;
    m->fields = fields;
    tobi_moment_field f = { strdup(name), components,
                            malloc(((size_t)m->count*(size_t)components + 1)*sizeof(double)) };
    if (f.name && f.values && tobi_world_read(world, TOBI_FLUID, name, f.values, m->count, NULL) == TOBI_OK) {
        fields[m->field_count++] = f;
        return;
    }
    free(f.name);
    free(f.values);
}

static void copy_surface(tobi_world *world, int body, tobi_moment *m)
{
    const double (*vertices)[3];
    const int32_t (*triangles)[3];
    tobi_moment_surface *s = &m->surfaces[m->surface_count];
    if (tobi_world_surface(world, body, &s->vertex_count, &vertices, &s->triangle_count, &triangles) !=
        TOBI_OK)
        return;
    s->name = strdup(tobi_world_body_name(world, body));
    s->vertices = malloc(((size_t)s->vertex_count + 1)*sizeof *s->vertices);
    s->triangles = malloc(((size_t)s->triangle_count + 1)*sizeof *s->triangles);
    m->surface_count++;
    if (!s->name || !s->vertices || !s->triangles) {
        s->vertex_count = s->triangle_count = 0;
        return;
    }
    memcpy(s->vertices, vertices, (size_t)s->vertex_count*sizeof *s->vertices);
    memcpy(s->triangles, triangles, (size_t)s->triangle_count*sizeof *s->triangles);
}

static tobi_moment copy_particles(tobi_world *world)
{
    tobi_moment m = { .time = tobi_world_time(world), .count = tobi_world_count(world, TOBI_FLUID) };
    const char *name;
    int components;
    m.positions = malloc(((size_t)m.count + 1)*sizeof *m.positions);
    if (!m.positions ||
        tobi_world_read(world, TOBI_FLUID, "position", &m.positions[0][0], m.count, NULL) != TOBI_OK)
        m.count = 0;
    for (int k = 0; (name = tobi_world_field_name(k, &components, NULL)); k++)
        if (is_wanted_field(name, components)) copy_field(world, name, components, &m);
    return m;
}

/* Nests that have come to its time. One that cannot be copied is left out. */
static void copy_nests(const tobi_world *world, tobi_moment *m)
{
    tobi_world *nest;
    double box[2][3], spacing;
    for (int k = 0; (nest = tobi_world_nest_at(world, k)) != NULL; k++) {
        if (tobi_world_time(nest) != m->time || !tobi_world_nest_box(nest, box, &spacing)) continue;
        tobi_moment own = copy_particles(nest);
        tobi_moment_add_nest(m, &own, (const double (*)[3])box, spacing, NULL);
        tobi_moment_free(&own);
    }
}

static tobi_moment copy_world(tobi_world *world)
{
    const int bodies = tobi_world_body_count(world);
    tobi_moment m = copy_particles(world);
    copy_nests(world, &m);
    m.surfaces = calloc((size_t)bodies + 1, sizeof *m.surfaces);
    for (int b = 0; m.surfaces && b < bodies; b++) copy_surface(world, b, &m);
    return m;
}

/* Gives a moment if one is wanted. Called with the lock held, which is given away for the copy. */
static void give(live *l, tobi_world *world)
{
    l->time = tobi_world_time(world);
    if (!l->wanted || l->has_fresh || (l->time == l->given && !l->again)) return;
    l->wanted = l->again = 0;
    l->given = l->time;
    pthread_mutex_unlock(&l->lock);
    tobi_moment m = copy_world(world);
    pthread_mutex_lock(&l->lock);
    l->fresh = m;
    l->has_fresh = 1;
    if (l->wake) l->wake(l->user);
}

int live_between(live *l, tobi_world *world, int (*is_stopped)(void))
{
    pthread_mutex_lock(&l->lock);
    give(l, world);
    while (l->paused && l->steps == 0 && l->leave == LIVE_STAYS && !is_stopped()) {
        struct timespec until;
        clock_gettime(CLOCK_REALTIME, &until);
        until.tv_nsec += 100000000;                 /* a signal is seen within a tenth of a second */
        if (until.tv_nsec >= 1000000000) until.tv_sec++, until.tv_nsec -= 1000000000;
        pthread_cond_timedwait(&l->changed, &l->lock, &until);
        give(l, world);
    }
    if (l->steps > 0) l->steps--;
    const int stops = l->leave == LIVE_STOPS;
    pthread_mutex_unlock(&l->lock);
    return stops;
}

void live_end_steps(live *l, tobi_world *world)
{
    pthread_mutex_lock(&l->lock);
    l->wanted = l->again = 1;
    if (l->has_fresh) tobi_moment_free(&l->fresh);
    l->has_fresh = 0;
    give(l, world);
    l->ended = 1;
    if (l->wake) l->wake(l->user);
    pthread_mutex_unlock(&l->lock);
}

void live_ask(live *l, int again)
{
    pthread_mutex_lock(&l->lock);
    l->wanted = 1;
    l->again |= again;
    pthread_cond_signal(&l->changed);
    pthread_mutex_unlock(&l->lock);
}

int live_take(live *l, tobi_moment *moment)
{
    pthread_mutex_lock(&l->lock);
    const int has = l->has_fresh;
    if (has) *moment = l->fresh;
    l->fresh = (tobi_moment){ 0 };
    l->has_fresh = 0;
    pthread_mutex_unlock(&l->lock);
    return has;
}

static void set(live *l, int *what, int value)
{
    pthread_mutex_lock(&l->lock);
    *what = value;
    pthread_cond_signal(&l->changed);
    pthread_mutex_unlock(&l->lock);
}

void live_pause(live *l, int paused) { set(l, &l->paused, paused); }
void live_step(live *l) { set(l, &l->steps, 1); }

void live_leave(live *l, live_end how)
{
    pthread_mutex_lock(&l->lock);
    l->leave = how;
    l->wake = NULL;
    pthread_cond_signal(&l->changed);
    pthread_mutex_unlock(&l->lock);
}

int live_has_ended(live *l)
{
    pthread_mutex_lock(&l->lock);
    const int ended = l->ended;
    pthread_mutex_unlock(&l->lock);
    return ended;
}

double live_time(live *l)
{
    pthread_mutex_lock(&l->lock);
    const double time = l->time;
    pthread_mutex_unlock(&l->lock);
    return time;
}

void live_set_wake(live *l, void (*wake)(void *user), void *user)
{
    pthread_mutex_lock(&l->lock);
    l->wake = wake;
    l->user = user;
    pthread_mutex_unlock(&l->lock);
}
