/* The drag of porous zones: implicit, with the quadratic part linearised about the velocity before the step
   (decision 148). Drawback: zones are looked for by all particles, one after the other. */
#include "sph/porous.h"
#include "sph/porous.k.h"
#include "sph/porous_carry.h"
#include "sph/state.h"
#include <math.h>
#include <string.h>

/* start: where the particle would be, had the zone not moved. */
static const tobi_porous *find_zone(const tobi_system *s, int64_t i, int *number, double start[3])
{
    for (int k = 0; k < s->sim->porous_count; k++) {
        const tobi_porous *z = &s->sim->porous[k];
        double arm[3];
        memcpy(start, &s->particles.position[i].x, 3*sizeof *start);
        if (z->carrier) sph_porous_arm(s, z, i, arm);
        if (z->carrier && (z->pose.away || !tobi_porous_recall(z, arm, start))) continue;
        if (!tobi_porous_holds(z, s->box.dimension, start)) continue;
        *number = k;
        return z;
    }
    return NULL;
}

/* Less the velocity of the body that carries the zone. */
static void make_relative(const tobi_system *s, const tobi_porous *z, int64_t i, double u[3])
{
    double arm[3], carried[3];
    if (!z->carrier) return;
    sph_porous_arm(s, z, i, arm);
    sph_porous_carry(z->pose.speed, arm, carried);
    for (int a = 0; a < 3; a++) u[a] -= carried[a];
}

/* Along stems or across a screen at a place; n is a unit vector. */
static void find_normal(const tobi_porous *z, const double *x, double n[3])
{
    double start[3];
    for (int a = 0; a < 3; a++) n[a] = z->radial ? 0 : z->direction[a];
    if (z->radial) {
        const double u = x[z->plane[0]] - z->centre[0], v = x[z->plane[1]] - z->centre[1], r = hypot(u, v);
        n[z->plane[0]] = u/r, n[z->plane[1]] = v/r;   /* a ring, so that r is above 0 */
    }
    if (!z->carrier) return;
    memcpy(start, n, sizeof start);
    tobi_porous_turn(z, start, n);
}

/* The same as at the begin of the step, though the particle has moved. */
static void recall_normal(const tobi_porous *z, tobi_float4 drag, double n[3])
{
    const double length = sqrt((double)drag.x*drag.x + (double)drag.y*drag.y + (double)drag.z*drag.z);
    const double by = length > 0 ? 1/length : 0, given[3] = { by*drag.x, by*drag.y, by*drag.z };
    if (z->carrier && !z->radial) tobi_porous_turn(z, z->direction, n);
    else
        for (int a = 0; a < 3; a++) n[a] = z->radial ? given[a] : z->direction[a];
}

/* P u, into out; returns its size. */
static double take_part(const tobi_porous *z, const double n[3], const double u[3], double out[3])
{
    double along = 0, size2 = 0;
    for (int a = 0; a < 3; a++) along += n[a]*u[a];
    for (int a = 0; a < 3; a++) {
        const double part = along*n[a];
        out[a] = z->kind == TOBI_POROUS_ALL ? u[a] : z->kind == TOBI_POROUS_ALONG ? part : u[a] - part;
        size2 += out[a]*out[a];
    }
    return sqrt(size2);
}

static double find_linear(const tobi_system *s, const tobi_porous *z, int64_t i)
{
    const tobi_fluid *f = &s->fluid[s->particles.fluid[i]];
    return z->linear + z->per_viscosity*f->viscosity/f->density;
}

static tobi_float4 encode(const tobi_porous *z, const double n[3], double c)
{
    const double root = z->kind == TOBI_POROUS_ALL ? 0 : sqrt(c);
    return (tobi_float4){ (float)(root*n[0]), (float)(root*n[1]), (float)(root*n[2]),
                          z->kind == TOBI_POROUS_ALONG ? 0 : (float)c };
}

/* Of c: in isph and eisph what the drag takes of a steep pressure in a zone is no sure force on a body; far
   above this light bodies were shaken. */
static const double MOST_CARRIED = 8;

/* 1: share of the drag that acts, where c would be that. */
static double find_share(const tobi_system *s, const tobi_porous *z, double c)
{
    const int limited = sph_of(s)->mirrors && z->carrier && c > MOST_CARRIED &&
                        s->sim->bodies[z->carrier - 1].rigid.kind != TOBI_PRESCRIBED;
    return limited ? MOST_CARRIED/c : 1;
}

static void begin_range(const void *view, int64_t begin, int64_t end, double *totals)
{
    const tobi_system *s = view;
    const sph_fields *f = sph_fields_of(&s->particles);
    const tobi_float4 none = { 0, 0, 0, 0 };
    (void)totals;
    for (int64_t i = begin; i < end; i++) {
        const tobi_float4 v = s->particles.velocity[i];
        double u[3] = { v.x, v.y, v.z }, part[3], n[3], start[3];
        int k = 0;
        const int held = sph_of(s)->marked && f->held && f->held[i].w != 0;
        const tobi_porous *z = held ? NULL : find_zone(s, i, &k, start);
        f->porous[i] = none;
        f->porous_before[i] = (tobi_float4){ v.x, v.y, v.z, held ? -1 : 0 };
        if (!z) continue;
        find_normal(z, start, n);
        make_relative(s, z, i, u);
        const double speed = take_part(z, n, u, part);
        const double c = s->dt*(find_linear(s, z, i) + 2*z->quadratic*speed);
        f->porous[i] = encode(z, n, find_share(s, z, c)*c);
        f->porous_before[i] = (tobi_float4){ v.x, v.y, v.z, (float)(k + 1) };
    }
}

void sph_porous_begin(tobi_system *s)
{
    if (s->sim->porous_count > 0)
        tobi_launch(&s->sim->exec, TOBI_HOST(begin_range, 0, 0), s, 0, s->particles.count, NULL);
}

static void brake_range(const void *view, int64_t begin, int64_t end, double *totals)
{
    const tobi_system *s = view;
    const sph_fields *f = sph_fields_of(&s->particles);
    (void)totals;
    for (int64_t i = begin; i < end; i++) {
        if (!(f->porous_before[i].w > 0)) continue;
        const tobi_porous *z = &s->sim->porous[(int)f->porous_before[i].w - 1];
        double before[3] = { f->porous_before[i].x, f->porous_before[i].y, f->porous_before[i].z };
        double part[3], n[3];
        float x[3], *u = &s->particles.velocity[i].x;
        make_relative(s, z, i, before);
        recall_normal(z, f->porous[i], n);
        const double speed = take_part(z, n, before, part), b = z->quadratic,
                     share = find_share(s, z, s->dt*(find_linear(s, z, i) + 2*b*speed)),
                     push = s->dt*b*share*speed;
        for (int a = 0; a < 3; a++) x[a] = (float)(u[a] + push*part[a]);
        sph_porous_yield(f->porous[i], x);
        for (int a = 0; a < s->box.dimension; a++) {
            if (z->carrier) (&f->porous_taken[i].x)[a] = u[a] - x[a];
            u[a] = x[a];
        }
    }
}

void sph_porous_brake(tobi_system *s)
{
    if (s->sim->porous_count == 0) return;
    tobi_launch(&s->sim->exec, TOBI_HOST(brake_range, 0, 0), s, 0, s->particles.count, NULL);
    sph_porous_know(s);
}

typedef struct look { const tobi_system *s; int zone; } look;

/* By the formula; of a zone that a body carries what the liquid has lost. */
static void find_force(const tobi_system *s, const tobi_porous *z, int64_t i, double force[3])
{
    const sph_fields *f = sph_fields_of(&s->particles);
    const double before[3] = { f->porous_before[i].x, f->porous_before[i].y, f->porous_before[i].z };
    const double mass = s->smoothing.volume*s->fluid[s->particles.fluid[i]].density;
    const tobi_float4 v = s->particles.velocity[i];
    const float u[3] = { v.x, v.y, v.z };
    double was[3], n[3];
    float part[3];
    if (z->carrier) {
        for (int a = 0; a < 3; a++) force[a] = mass*(&f->porous_taken[i].x)[a]/s->dt;
        return;
    }
    recall_normal(z, f->porous[i], n);
    const double push = s->dt*z->quadratic*take_part(z, n, before, was);
    sph_porous_part(f->porous[i], u, part);
    for (int a = 0; a < 3; a++) force[a] = mass*(part[a] - push*was[a])/s->dt;
}

/* totals: force, power, volume. */
static void measure_range(const void *view, int64_t begin, int64_t end, double *totals)
{
    const look *l = view;
    const tobi_system *s = l->s;
    const sph_fields *f = sph_fields_of(&s->particles);
    for (int64_t i = begin; i < end; i++) {
        double force[3];
        if ((int)f->porous_before[i].w - 1 != l->zone) continue;
        find_force(s, &s->sim->porous[l->zone], i, force);
        for (int a = 0; a < s->box.dimension; a++) {
            totals[a] += force[a];
            totals[3] += 0.5*force[a]*((double)(&f->porous_before[i].x)[a] +
                                       (&s->particles.velocity[i].x)[a]);
        }
        totals[4] += s->smoothing.volume;
    }
}

void sph_porous_measure(tobi_system *s)
{
    for (int k = 0; k < s->sim->porous_count; k++) {
        tobi_porous *z = &s->sim->porous[k];
        const look l = { s, k };
        double t[TOBI_TOTALS];
        tobi_launch(&s->sim->exec, TOBI_HOST(measure_range, 5, 0), &l, 0, s->particles.count, t);
        for (int a = 0; a < 3; a++) z->force[a] = t[a];
        z->power = t[3];
        z->volume = t[4];
    }
    sph_porous_load(s);
}
