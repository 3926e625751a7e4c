/* What lies in a buffer is no unknown of the pressure: it keeps the pressure that it is given before the
   solve, and goes as the profile or the free liquid beside it does (docs/decisions/0061-openings.md, 0086).
   Drawback: the pressure at an inlet is that of the step before. */
#include "sph/openings.h"
#include "sph/nest.h"
#include "sph/state.h"
#include <math.h>

/* The free liquid gives way to the pressure of an inlet: all of its own in the next step would be too much,
   and from step to step it would swing. */
static const double CONTINUE = 0.5;
/* Share of a held neighbour in the velocity of an outlet, over that of a free one. */
static const double LATE = 0.1;

int sph_has_openings(const tobi_system *s) { return s->sim->opening_count > 0 || s->sim->nest.outer; }

static void mark_range(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const tobi_simulation *w = s->sim;
    tobi_float4 *held = sph_fields_of(&s->particles)->held;
    for (int64_t i = begin; i < end; i++) {
        const tobi_double3 *p = &s->particles.position[i];
        const double x[3] = { p->x, p->y, p->z };
        const int k = tobi_opening_find(w->openings, w->opening_count, x);
        const int outlet = k >= 0 && w->openings[k].outlet;
        held[i] = (tobi_float4){ 0, 0, 0, outlet ? -(float)(k + 1) : (float)(k + 1) };
        if (k < 0 || outlet) continue;
        const tobi_opening *o = &w->openings[k];
        double at[3];
        tobi_opening_locate(o, x, at);
        const double u = tobi_opening_speed(o, w->time, w->dt)*tobi_opening_factor(o, at[1], at[2]);
        for (int a = 0; a < 3; a++) (&held[i].x)[a] = (float)(u*o->normal[a]);
    }
}

/* What the neighbours of a held particle have: sums over them. */
typedef struct around { double free, velocity[3], pressure, held, before[3]; } around;

static around look_around(const tobi_system *s, int64_t i)
{
    const tobi_particles *p = &s->particles;
    const sph_fields *f = sph_fields_of(p);
    const tobi_smoothing_constants *c = &s->smoothing;
    int32_t unpacked[TOBI_LIST_LIMIT];
    int count;
    const int32_t *j = tobi_cells_neighbors(&s->cells, i, &count, unpacked);
    const double base = tobi_reference_pressure(&sph_of(s)->reference, &p->position[i].x);
    around sum = { 0 };
    for (int k = 0; k < count; k++) {
        if (j[k] == i) continue;
        double still = 0, r2 = 0;
        for (int a = 0; a < c->dimension; a++) {
            double d = (&p->position[i].x)[a] - (&p->position[j[k]].x)[a];
            if (s->box.periodic[a]) d -= s->box.size[a]*round(d/s->box.size[a]);
            r2 += d*d;
            still += d*s->fluid[0].density*s->sim->def.gravity[a];
        }
        const double w = tobi_smoothing_w(c->shape, c->dimension, c->h, sqrt(r2));
        if (f->held[j[k]].w != 0) {
            sum.held += w;
            for (int a = 0; a < 3; a++) sum.before[a] += w*(&f->held[j[k]].x)[a];
            continue;
        }
        sum.free += w;
        for (int a = 0; a < 3; a++) sum.velocity[a] += w*(&p->velocity[j[k]].x)[a];
        still += tobi_reference_pressure(&sph_of(s)->reference, &p->position[j[k]].x) - base;
        sum.pressure += w*(f->pressure[j[k]] + still);
    }
    return sum;
}

/* Of liquid at rest up to the level, or from the centre on, less what it takes to come in from there, Pa. */
static double find_pressure(const tobi_system *s, const tobi_opening *o, int64_t i)
{
    const double density = s->fluid[0].density, *gravity = s->sim->def.gravity;
    double size = 0, along = 0, in = 0;
    if (!o->gives) return 0;
    for (int a = 0; a < s->box.dimension; a++) {
        const double x = (&s->particles.position[i].x)[a];
        size += gravity[a]*gravity[a];
        along += gravity[a]*(o->gives == TOBI_GIVES_LEVEL ? x + s->box.lower[a] : x - o->centre[a]);
        in -= (&s->particles.velocity[i].x)[a]*o->normal[a];
    }
    in = fmax(in, 0);
    const double top = o->gives == TOBI_GIVES_LEVEL ? density*sqrt(size)*o->level : o->pressure;
    return fmax(top + density*(along - 0.5*in*in), 0);
}

double sph_openings_mean_pressure(const tobi_system *s)
{
    double sum = 0;
    int count = 0;
    for (int k = 0; k < s->sim->opening_count; k++) {
        if (s->sim->openings[k].gives != TOBI_GIVES_PRESSURE) continue;
        sum += s->sim->openings[k].pressure;
        count++;
    }
    return count > 0 ? sum/count : 0;
}

/* Whether liquid goes on beyond an outlet as it came, as in a pipe. Where sound carries the pressure, a
   buffer that takes more or less than comes is an error of the pressure. */
static int goes_on(const tobi_system *s, const tobi_opening *o)
{
    return o->outlet && o->gives == TOBI_GIVES_PRESSURE && s->method->sound;
}

static const tobi_opening *opening_of(const tobi_system *s, int64_t i)
{
    const float w = sph_fields_of(&s->particles)->held[i].w;
    return w != 0 && w != SPH_NEST_MARK ? &s->sim->openings[(int)fabsf(w) - 1] : NULL;
}

/* Pressures of outlets, and the velocities that their particles came with. */
static void extend_range(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_fields *f = sph_fields_of(&s->particles);
    for (int64_t i = begin; i < end; i++) {
        const tobi_opening *o = opening_of(s, i);
        if (!o || !o->outlet) continue;
        const double rest = tobi_reference_pressure(&sph_of(s)->reference, &s->particles.position[i].x);
        f->pressure[i] = s->cells.record[i].w = (float)(find_pressure(s, o, i) - rest);
        for (int a = 0; a < 3; a++) (&f->held[i].x)[a] = (&s->particles.velocity[i].x)[a];
    }
}

/* Reads pressures of free particles and writes those of inlets. */
typedef struct continuing { const tobi_system *s; double share; } continuing;

static void continue_range(const void *view, int64_t begin, int64_t end)
{
    const continuing *c = view;
    const sph_fields *f = sph_fields_of(&c->s->particles);
    for (int64_t i = begin; i < end; i++) {
        if (!(f->held[i].w > 0)) continue;
        const around sum = look_around(c->s, i);
        if (sum.free > 0) f->pressure[i] += (float)(c->share*(sum.pressure/sum.free - f->pressure[i]));
        c->s->cells.record[i].w = f->pressure[i];
    }
}

void sph_openings_continue(tobi_system *s, double share)
{
    const continuing c = { s, share };
    if (sph_has_openings(s)) tobi_loop(s->sim->exec.threads, s->particles.count, 512, continue_range, &c);
}

static double take_normal(const tobi_opening *o, const tobi_float4 *v)
{
    double out = 0;
    for (int a = 0; a < 3; a++) out += (&v->x)[a]*o->normal[a];
    return out;
}

/* Gives a velocity another part along the normal. */
static void set_normal(const tobi_opening *o, tobi_float4 *v, double out)
{
    const double more = out - take_normal(o, v);
    for (int a = 0; a < 3; a++) (&v->x)[a] += (float)(more*o->normal[a]);
}

/* Where liquid goes on: sums that tell how much faster the free liquid before the buffer is. */
typedef struct meeting { const tobi_system *s; const tobi_opening *o; float mark; } meeting;

static void meet_range(const void *view, int64_t begin, int64_t end, double *totals)
{
    const meeting *m = view;
    const tobi_particles *p = &m->s->particles;
    const tobi_float4 *held = sph_fields_of(p)->held;
    for (int64_t i = begin; i < end; i++) {
        const double x[3] = { p->position[i].x, p->position[i].y, p->position[i].z };
        double at[3];
        if (held[i].w != 0 && held[i].w != m->mark) continue;
        tobi_opening_locate(m->o, x, at);
        if (!tobi_opening_faces(m->o, at) || fabs(at[0]) > m->s->smoothing.h) continue;
        totals[held[i].w != 0] += 1;
        totals[2 + (held[i].w != 0)] += take_normal(m->o, held[i].w != 0 ? &held[i] : &p->velocity[i]);
    }
}

/* A step of the buffers, and by how much those gain speed in which liquid goes on, m/s. */
typedef struct driving { const tobi_system *s; double gain[TOBI_OPENING_LIMIT]; } driving;

static void find_gains(const tobi_system *s, double gain[TOBI_OPENING_LIMIT])
{
    for (int k = 0; k < s->sim->opening_count; k++) {
        const meeting m = { s, &s->sim->openings[k], -(float)(k + 1) };
        double t[TOBI_TOTALS];
        gain[k] = 0;
        if (!goes_on(s, m.o)) continue;
        tobi_launch(&s->sim->exec, TOBI_HOST(meet_range, 4, 0), &m, 0, s->particles.count, t);
        if (t[0] > 0 && t[1] > 0) gain[k] = t[2]/t[0] - t[3]/t[1];
    }
}

/* A velocity of an outlet's particle: the mean of the free ones around; where there are few, of those held,
   as they were before the step, and `more`. */
static void follow(const tobi_system *s, const tobi_opening *o, int64_t i, const double more[3])
{
    const around sum = look_around(s, i);
    const double weight = sum.free + LATE*sum.held;
    tobi_float4 *v = &s->particles.velocity[i];
    if (weight > 0)
        for (int a = 0; a < s->box.dimension; a++)
            (&v->x)[a] = (float)((sum.velocity[a] + LATE*(sum.before[a] + sum.held*more[a]))/weight);
    const double out = take_normal(o, v);
    if (o->gives) return;
    for (int a = 0; a < 3 && out < 0; a++) (&v->x)[a] -= (float)(out*o->normal[a]);
}

/* In isph an outlet's particles are predicted as the free ones around them are. In the other methods they
   keep their velocities: the operator gives them an acceleration by pressure along the normal alone, which
   would not balance gravity across it. Where liquid goes on they feel, along the normal, the forces besides
   pressure: with what the whole buffer gains they keep a profile as it was, in a pipe that of friction. */
static void hold_range(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    tobi_float4 *held = sph_fields_of(&s->particles)->held;
    double pull[3];
    for (int a = 0; a < 3; a++) pull[a] = s->dt*s->sim->def.gravity[a];
    for (int64_t i = begin; i < end; i++) {
        const tobi_opening *o = opening_of(s, i);
        if (o && goes_on(s, o)) set_normal(o, &held[i], take_normal(o, &s->particles.velocity[i]));
        if (o && o->outlet && sph_of(s)->mirrors) follow(s, o, i, pull);
        else if (o) s->particles.velocity[i] = (tobi_float4){ held[i].x, held[i].y, held[i].z, 0 };
    }
}

static void drive_range(const void *view, int64_t begin, int64_t end)
{
    static const double none[3] = { 0 };
    const driving *d = view;
    const tobi_system *s = d->s;
    const sph_fields *f = sph_fields_of(&s->particles);
    for (int64_t i = begin; i < end; i++) {
        const tobi_opening *o = opening_of(s, i);
        if (!o) continue;
        if (o->outlet) {
            follow(s, o, i, none);
            if (goes_on(s, o))
                set_normal(o, &s->particles.velocity[i],
                           take_normal(o, &f->held[i]) + d->gain[o - s->sim->openings]);
            continue;
        }
        f->accel[i] = (tobi_float4){ 0, 0, 0, 0 };
        s->particles.velocity[i] = (tobi_float4){ f->held[i].x, f->held[i].y, f->held[i].z, 0 };
    }
}

void sph_openings_mark(tobi_system *s, sph_view *v)
{
    const int64_t n = s->particles.count;
    if (!sph_has_openings(s)) return;
    for (int k = 0; k < s->sim->opening_count; k++)
        for (int a = 0; a < 4; a++)
            (&sph_of(s)->normal[k].x)[a] = a < 3 ? (float)s->sim->openings[k].normal[a]
                                                 : (float)goes_on(s, &s->sim->openings[k]);
    tobi_loop(s->sim->exec.threads, n, 0, mark_range, s);
    sph_nest_mark(s);
    tobi_loop(s->sim->exec.threads, n, 512, extend_range, s);
    sph_openings_continue(s, CONTINUE);
    sph_of(s)->marked = 1;
    v->held = sph_fields_of(&s->particles)->held;
    sph_openings_hold(s);
}

void sph_openings_hold(tobi_system *s)
{
    if (sph_has_openings(s) && sph_of(s)->marked)
        tobi_loop(s->sim->exec.threads, s->particles.count, 512, hold_range, s);
    if (sph_of(s)->marked && !sph_of(s)->mirrors) sph_nest_hold(s);
}

void sph_openings_drive(tobi_system *s)
{
    driving d = { .s = s };
    if (!sph_has_openings(s) || !sph_of(s)->marked) return;
    find_gains(s, d.gain);
    tobi_loop(s->sim->exec.threads, s->particles.count, 512, drive_range, &d);
    sph_nest_hold(s);
}

static void hide_range(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_fields *f = sph_fields_of(&s->particles);
    for (int64_t i = begin; i < end; i++) {
        const tobi_double3 *p = &s->particles.position[i];
        const double x[3] = { p->x, p->y, p->z };
        if (!(f->surface_depth[i] > 0)) continue;
        if (tobi_opening_find(s->sim->openings, s->sim->opening_count, x) >= 0 ||
            (s->sim->nest.outer && tobi_nest_outside(&s->sim->nest, s->box.dimension, x) > 0))
            f->surface_depth[i] = 0;
    }
}

void sph_openings_hide_surface(tobi_system *s)
{
    if (sph_has_openings(s)) tobi_loop(s->sim->exec.threads, s->particles.count, 0, hide_range, s);
}

static void start_range(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_fields *f = sph_fields_of(&s->particles);
    for (int64_t i = begin; i < end; i++) {
        double sum = 0;
        int count = 0;
        for (int k = 0; k < s->sim->opening_count; k++) {
            if (s->sim->openings[k].gives != TOBI_GIVES_PRESSURE) continue;
            sum += find_pressure(s, &s->sim->openings[k], i);
            count++;
        }
        if (count > 0) f->pressure[i] = s->cells.record[i].w = (float)(sum/count);
    }
}

void sph_openings_start(tobi_system *s)
{
    if (sph_has_openings(s)) tobi_loop(s->sim->exec.threads, s->particles.count, 0, start_range, s);
}
