/* What lies in a buffer is no unknown of the pressure: it keeps the pressure that it is given before the
   solve, and accelerations by pressure are none (docs/decisions/0061-openings.md). Drawback: the pressure at
   an inlet is that of the step before. */
#include "sph/openings.h"
#include "sph/state.h"
#include <math.h>

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
        held[i] = (tobi_float4){ 0, 0, 0, (float)(k + 1) };
        if (k < 0 || w->openings[k].outlet) continue;
        const tobi_opening *o = &w->openings[k];
        double at[3];
        tobi_opening_locate(o, x, at);
        const double u = tobi_opening_speed(o, w->time + w->dt)*tobi_opening_factor(o, at[1], at[2]);
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
        if (f->held[j[k]].w > 0) continue;
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

/* Reads pressures of free particles and velocities as they were; writes held ones only. */
static void extend_range(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_fields *f = sph_fields_of(&s->particles);
    for (int64_t i = begin; i < end; i++) {
        const int k = (int)f->held[i].w - 1;
        if (k < 0) continue;
        const tobi_opening *o = &s->sim->openings[k];
        const around sum = look_around(s, i);
        if (!o->outlet) {
            if (sum.free > 0) f->pressure[i] = (float)(sum.pressure/sum.free);
            continue;
        }
        f->pressure[i] = (float)find_pressure(s, o, i);
        double out = 0, v[3];
        for (int a = 0; a < 3; a++) {
            v[a] = sum.weight > 0 ? sum.velocity[a]/sum.weight : (&s->particles.velocity[i].x)[a];
            out += v[a]*o->normal[a];
        }
        for (int a = 0; a < 3; a++) (&f->held[i].x)[a] = (float)(v[a] - fmin(out, 0)*o->normal[a]);
    }
}

static void hold_range(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_fields *f = sph_fields_of(&s->particles);
    for (int64_t i = begin; i < end; i++) {
        if (!(f->held[i].w > 0)) continue;
        s->particles.velocity[i] = (tobi_float4){ f->held[i].x, f->held[i].y, f->held[i].z, 0 };
        f->accel[i] = (tobi_float4){ 0, 0, 0, 0 };
    }
}

void sph_openings_mark(tobi_system *s, sph_view *v)
{
    const int64_t n = s->particles.count;
    if (!sph_has_openings(s)) return;
    tobi_loop(s->sim->exec.threads, n, 0, mark_range, s);
    tobi_loop(s->sim->exec.threads, n, 512, extend_range, s);
    sph_of(s)->marked = 1;
    v->held = sph_fields_of(&s->particles)->held;
    sph_openings_hold(s);
}

void sph_openings_hold(tobi_system *s)
{
    if (sph_has_openings(s) && sph_of(s)->marked)
        tobi_loop(s->sim->exec.threads, s->particles.count, 0, hold_range, s);
}
