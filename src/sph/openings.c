/* What lies in a buffer is no unknown of the pressure: it keeps the pressure that it is given before the
   solve, and accelerations by pressure are none (docs/decisions/0061-openings.md). Drawback: the pressure at
   an inlet is that of the step before. */
#include "sph/openings.h"
#include "sph/state.h"
#include <math.h>

/* The free liquid gives way to the pressure of an inlet: all of its own in the next step would be too much,
   and from step to step it would swing. */
static const double CONTINUE = 0.5;

int sph_has_openings(const tobi_system *s) { return s->sim->opening_count > 0; }

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

/* What the neighbours of a held particle have: means over them. */
typedef struct around { double weight, free, velocity[3], pressure; } around;

static around look_around(const tobi_system *s, int64_t i)
{
    const tobi_particles *p = &s->particles;
    const sph_fields *f = sph_fields_of(p);
    const tobi_smoothing_constants *c = &s->smoothing;
    const int32_t *j = s->cells.list + 8*(int64_t)s->cells.list_start[i];
    around sum = { 0 };
    for (int k = 0; k < 8*s->cells.list_groups[i]; k++) {
        if (j[k] == i) continue;
        double still = 0, r2 = 0;
        for (int a = 0; a < c->dimension; a++) {
            double d = (&p->position[i].x)[a] - (&p->position[j[k]].x)[a];
            if (s->box.periodic[a]) d -= s->box.size[a]*round(d/s->box.size[a]);
            r2 += d*d;
            still += d*s->fluid[0].density*s->sim->def.gravity[a];
        }
        const double w = tobi_smoothing_w(c->shape, c->dimension, c->h, sqrt(r2));
        sum.weight += w;
        for (int a = 0; a < 3; a++) sum.velocity[a] += w*(&p->velocity[j[k]].x)[a];
        if (f->held[j[k]].w != 0) continue;
        sum.free += w;
        sum.pressure += w*(f->pressure[j[k]] + still);
    }
    return sum;
}

/* Of the level, Pa. */
static double find_pressure(const tobi_system *s, const tobi_opening *o, int64_t i)
{
    double g = 0, along = 0;
    if (!o->has_level) return 0;
    for (int a = 0; a < s->box.dimension; a++) {
        g += s->sim->def.gravity[a]*s->sim->def.gravity[a];
        along += s->sim->def.gravity[a]*((&s->particles.position[i].x)[a] + s->box.lower[a]);
    }
    return fmax(s->fluid[0].density*(sqrt(g)*o->level + along), 0);
}

static const tobi_opening *opening_of(const tobi_system *s, int64_t i)
{
    const float w = sph_fields_of(&s->particles)->held[i].w;
    return w != 0 ? &s->sim->openings[(int)fabsf(w) - 1] : NULL;
}

/* Velocities and pressures of outlets. */
static void extend_range(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_fields *f = sph_fields_of(&s->particles);
    for (int64_t i = begin; i < end; i++) {
        const tobi_opening *o = opening_of(s, i);
        if (!o || !o->outlet) continue;
        const around sum = look_around(s, i);
        double out = 0, v[3];
        f->pressure[i] = (float)find_pressure(s, o, i);
        for (int a = 0; a < 3; a++) {
            v[a] = sum.weight > 0 ? sum.velocity[a]/sum.weight : (&s->particles.velocity[i].x)[a];
            out += v[a]*o->normal[a];
        }
        for (int a = 0; a < 3; a++) (&f->held[i].x)[a] = (float)(v[a] - fmin(out, 0)*o->normal[a]);
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

static void hold_range(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const tobi_float4 *held = sph_fields_of(&s->particles)->held;
    for (int64_t i = begin; i < end; i++)
        if (held[i].w != 0) s->particles.velocity[i] = (tobi_float4){ held[i].x, held[i].y, held[i].z, 0 };
}

static void drive_range(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_fields *f = sph_fields_of(&s->particles);
    for (int64_t i = begin; i < end; i++) {
        const tobi_opening *o = opening_of(s, i);
        tobi_float4 *v = &s->particles.velocity[i];
        double out = 0;
        if (!o) continue;
        f->accel[i] = (tobi_float4){ 0, 0, 0, 0 };
        if (!o->outlet) *v = (tobi_float4){ f->held[i].x, f->held[i].y, f->held[i].z, 0 };
        for (int a = 0; a < 3; a++) out += (&v->x)[a]*o->normal[a];
        for (int a = 0; a < 3 && out < 0; a++) (&v->x)[a] -= (float)(out*o->normal[a]);
    }
}

void sph_openings_mark(tobi_system *s, sph_view *v)
{
    const int64_t n = s->particles.count;
    if (!sph_has_openings(s)) return;
    tobi_loop(s->sim->exec.threads, n, 0, mark_range, s);
    tobi_loop(s->sim->exec.threads, n, 512, extend_range, s);
    sph_openings_continue(s, CONTINUE);
    sph_of(s)->marked = 1;
    v->held = sph_fields_of(&s->particles)->held;
    sph_openings_hold(s);
}

void sph_openings_hold(tobi_system *s)
{
    if (sph_has_openings(s) && sph_of(s)->marked)
        tobi_loop(s->sim->exec.threads, s->particles.count, 0, hold_range, s);
}

void sph_openings_drive(tobi_system *s)
{
    if (sph_has_openings(s) && sph_of(s)->marked)
        tobi_loop(s->sim->exec.threads, s->particles.count, 0, drive_range, s);
}
