/* Potentials of the water at an output (Ihmsen et al. 2012, section 3): how fast neighbours close in on one
   another, whether the surface is a crest that moves outwards, and kinetic energy, each as a share from 0 to
   1 between two limits. Air comes in near the surface only. Drawback: sums are taken twice, for the crests
   need the normals of all. */
#include "view/foam/foam.h"

/* Limits: velocity differences in sqrt(g d), energies in g d per mass, curvatures 1 - cos of mean angles. */
#define CLOSE_LOW 0.3
#define CLOSE_HIGH 1.5
#define ENERGY_LOW 3.0
#define ENERGY_HIGH 15.0
#define CREST_LOW 0.06
#define CREST_HIGH 0.30
#define CREST_SHARE 0.5          /* of a crest, beside air that is closed in */
#define RATE 30.0                /* new ones of a particle in a time sqrt(d/g) */

typedef struct potential_view { tobi_foam *f; foam_water *w; } potential_view;

/* What is around a particle of water. */
typedef struct around { float weight, water, closing, away[3]; } around;

static void add_pair(around *a, tobi_float4 p, tobi_float4 u, tobi_float4 q, tobi_float4 v, float inverse)
{
    const float d[3] = { p.x - q.x, p.y - q.y, p.z - q.z }, e[3] = { u.x - v.x, u.y - v.y, u.z - v.z };
    const float r = sqrtf(d[0]*d[0] + d[1]*d[1] + d[2]*d[2]), w = 1 - r*inverse;
    if (!(w > 0) || !(r > 0)) return;
    const float speed = sqrtf(e[0]*e[0] + e[1]*e[1] + e[2]*e[2]);
    a->weight += w;
    for (int k = 0; k < 3; k++) a->away[k] += w*d[k]/r;
    if (q.w >= FOAM_SOLID) return;
    a->water += w;
    a->closing += w*(speed - (e[0]*d[0] + e[1]*d[1] + e[2]*d[2])/r);
}

/* Normal, fullness, velocity differences. */
static void find_normals(const void *view, int64_t begin, int64_t end)
{
    const potential_view *v = view;
    const foam_cells *c = &v->f->cells;
    const float inverse = (float)(1/c->reach);
    for (int64_t k = begin; k < end; k++) {
        const tobi_float4 p = c->place[k], u = c->move[k];
        around a = { 0 };
        int64_t from, to;
        if (c->of[k] < 0 || c->of[k] >= v->w->count) continue;
        foam_runs r = foam_first_run(c, (const float[3]){ p.x, p.y, p.z });
        while (foam_next_run(c, &r, &from, &to))
            for (int64_t j = from; j < to; j++)
                if (j != k) add_pair(&a, p, u, c->place[j], c->move[j], inverse);
        float *n = v->f->normal[c->of[k]];
        const float length = sqrtf(a.away[0]*a.away[0] + a.away[1]*a.away[1] + a.away[2]*a.away[2]);
        for (int m = 0; m < 3; m++) n[m] = length > 0 ? a.away[m]/length : 0;
        n[3] = (1 + a.weight)/v->f->full;
        v->w->spread[c->of[k]] = a.water > 0 ? a.closing/(2*a.water) : 0;
    }
}

/* Of the surface around a particle: how far normals turn away on its convex side; whether it is near. */
static float find_crest(const tobi_foam *f, int64_t k, const float *n, bool *near)
{
    const foam_cells *c = &f->cells;
    const tobi_float4 p = c->place[k];
    const float inverse = (float)(1/c->reach);
    float sum = 0, weight = 0;
    int64_t from, to;
    foam_runs r = foam_first_run(c, (const float[3]){ p.x, p.y, p.z });
    *near = n[3] < FOAM_SURFACE;
    while (foam_next_run(c, &r, &from, &to))
        for (int64_t j = from; j < to; j++) {
            const tobi_float4 q = c->place[j];
            if (q.w >= FOAM_SOLID) continue;
            const int64_t row = c->of[j] < 0 ? -1 - c->of[j] : c->of[j];
            const float *m = f->normal[row], d[3] = { q.x - p.x, q.y - p.y, q.z - p.z };
            const float distance = sqrtf(d[0]*d[0] + d[1]*d[1] + d[2]*d[2]), w = 1 - distance*inverse;
            const int mirrors = (int)q.w;
            if (j == k || !(w > 0) || !(m[3] < FOAM_SURFACE)) continue;
            *near = true;
            float turn = 1;
            for (int a = 0; a < 3; a++) turn -= mirrors >> a & 1 ? -n[a]*m[a] : n[a]*m[a];
            weight += w;
            if (d[0]*n[0] + d[1]*n[1] + d[2]*n[2] < 0) sum += w*turn;
        }
    return n[3] < FOAM_SURFACE && weight > 0 ? sum/weight : 0;
}

static void find_rates(const void *view, int64_t begin, int64_t end)
{
    const potential_view *v = view;
    const tobi_foam *f = v->f;
    const foam_cells *c = &f->cells;
    const double energy = f->pull*f->def.spacing, most = f->def.amount*RATE*f->pull/f->scale;
    for (int64_t k = begin; k < end; k++) {
        const int64_t i = c->of[k];
        if (i < 0 || i >= v->w->count) continue;
        const tobi_float4 u = c->move[k];
        const float *n = f->normal[i];
        const double square = (double)(u.x*u.x + u.y*u.y + u.z*u.z);
        const float moves = foam_ramp(0.5*square, ENERGY_LOW*energy, ENERGY_HIGH*energy);
        bool near;
        v->w->rate[i] = 0;
        if (moves == 0) continue;
        const float crest = find_crest(f, k, n, &near);
        const double out = (double)(u.x*n[0] + u.y*n[1] + u.z*n[2]);
        float share = near ? foam_ramp((double)v->w->spread[i], CLOSE_LOW*f->scale, CLOSE_HIGH*f->scale) : 0;
        if (out > 0.6*sqrt(square))
            share += (float)CREST_SHARE*foam_ramp((double)crest, CREST_LOW, CREST_HIGH);
        v->w->rate[i] = (float)most*moves*share;
    }
}

static void clear_rates(const void *view, int64_t begin, int64_t end)
{
    const potential_view *v = view;
    for (int64_t i = begin; i < end; i++) v->w->rate[i] = v->w->spread[i] = v->f->normal[i][3] = 0;
}

tobi_status foam_find_potentials(tobi_foam *f, foam_water *w, tobi_error *err)
{
    const potential_view v = { f, w };
    TOBI_TRY(foam_fill_cells(f, w, NULL, 0, err));
    if (!foam_room(&f->normal, &f->normal_room, w->count + 1, sizeof *f->normal)) return foam_no_memory(err);
    tobi_loop(f->exec.threads, w->count, 0, clear_rates, &v);
    tobi_loop(f->exec.threads, f->cells.count, 1024, find_normals, &v);
    tobi_loop(f->exec.threads, f->cells.count, 1024, find_rates, &v);
    return TOBI_OK;
}
