#include "mpm/meet.h"
#include "geom/vec3.h"
#include "mpm/spline.h"
#include "tobiuo/types.h"
#include <math.h>
#include <string.h>

enum { GROUPS = 3 };                   /* that one node looks at                                   */

/* What the particles of one group say at one node. */
typedef struct voice {
    int    group;                      /* -1 = none                                                */
    double mass, towards[3];           /* kg, weighted; where its volume lies, m4                  */
    double friction;                   /* weighted by mass                                         */
    int    shape;                      /* 1: keeps its shape, so that its surface is known best    */
} voice;

int mpm_meet_group(const mpm_view *v, const mpm_block *b)
{
    int group = v->material[v->solid[b->begin]].group;
    for (int64_t i = b->begin + 1; i < b->end; i++)
        if (v->material[v->solid[i]].group != group) return MPM_MIXED;
    return group;
}

/* The nodes of a patch that a particle feels: the lowest, and ranges of the three along each axis. Returns 0
   if there are none. */
typedef struct reach {
    double x[3], w[3][3];
    int first[3], low[3], high[3];
} reach;

static int find_reach(const mpm_grid *g, const mpm_view *v, const mpm_patch *p, int64_t i, reach *r)
{
    *r = (reach){ .x = {v->position[i].x, v->position[i].y, v->position[i].z},
                  .w = {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}}, .first = {0, 0, -1} };
    for (int a = 0; a < 3; a++) {
        if (a < g->dimension) r->first[a] = (int)mpm_spline(r->x[a]*v->inverse_cell, r->w[a]) - p->corner[a];
        if (r->first[a] > 3 || r->first[a] < -2) return 0;
        r->low[a] = r->first[a] < 0 ? -r->first[a] : 0;
        r->high[a] = r->first[a] > 1 ? 3 - r->first[a] : 2;
    }
    return 1;
}

static int node_of(const mpm_grid *g, const reach *r, int a, int b, int c)
{
    const int at[3] = {r->first[0] + a, r->first[1] + b, r->first[2] + c};
    return g->dimension == 3 ? (at[0]*4 + at[1])*4 + at[2] : at[0]*4 + at[1];
}

/* From a node of the patch to the particle, m. */
static void look_from(const mpm_grid *g, const mpm_view *v, const mpm_patch *p, const reach *r,
                      const int o[3], double d[3])
{
    for (int a = 0; a < 3; a++)
        d[a] = a < g->dimension ? r->x[a] - (p->corner[a] + r->first[a] + o[a])/v->inverse_cell : 0;
}

static void add_voice(voice voices[GROUPS], const mpm_view *v, int64_t i, double w, const double d[3])
{
    const mpm_material *m = &v->material[v->solid[i]];
    int k = 0;
    while (k < GROUPS && voices[k].group >= 0 && voices[k].group != m->group) k++;
    if (k == GROUPS) return;
    voice *to = &voices[k];
    const double volume = v->strain[i].c[0].w, mass = w*v->strain[i].c[2].w;
    const double q = vec3_dot(d, d)*v->inverse_cell*v->inverse_cell/2.25, near = q < 0.99 ? 1 - q : 0.01;
    to->group = m->group;
    to->mass += mass;
    to->friction += mass*m->surface_friction;
    to->shape |= m->model != TOBI_LIQUID;
    for (int a = 0; a < 3; a++) to->towards[a] += volume*near*d[a];
}

static void hear(const mpm_grid *g, const mpm_view *v, const mpm_patch *p, voice voices[][GROUPS])
{
    for (int o = 0; o < 27; o++) {
        if (p->cover[o] < 0) continue;
        const mpm_block *b = &g->block[p->cover[o]];
        for (int64_t i = b->begin; i < b->end; i++) {
            reach r;
            if (!find_reach(g, v, p, i, &r)) continue;
            for (int a = r.low[0]; a <= r.high[0]; a++)
                for (int e = r.low[1]; e <= r.high[1]; e++)
                    for (int c = r.low[2]; c <= r.high[2]; c++) {
                        double d[3], w = r.w[0][a]*r.w[1][e]*r.w[2][c];
                        if (w == 0) continue;
                        look_from(g, v, p, &r, (const int[3]){a, e, c}, d);
                        add_voice(voices[node_of(g, &r, a, e, c)], v, i, w, d);
                    }
        }
    }
}

/* The heaviest group has the first velocity, the next the second. A third joins the first. */
static int decide(const voice voices[GROUPS], float *side, mpm_seam *seam)
{
    const voice *first = &voices[0], *second = NULL;
    double n[3];
    for (int k = 1; k < GROUPS && voices[k].group >= 0; k++) {
        if (voices[k].mass > first->mass) { second = first; first = &voices[k]; }
        else if (!second || voices[k].mass > second->mass) second = &voices[k];
    }
    if (!second || !(second->mass > 0)) return 0;
    const int both = first->shape == second->shape;
    for (int a = 0; a < 3; a++)
        n[a] = (both || second->shape)*second->towards[a] - (both || first->shape)*first->towards[a];
    vec3_normalize(n);
    for (int a = 0; a < 3; a++) seam->normal[a] = (float)n[a];
    seam->friction = (float)sqrt(first->friction/first->mass*second->friction/second->mass);
    *side = mpm_side_of(second->group);
    return 1;
}

/* How far the two groups reach along the normal. */
typedef struct span { double first, second; } span;

static void measure(const mpm_grid *g, const mpm_view *v, const mpm_patch *p, const float *side,
                    const mpm_seam *seam, const char *fresh, span *spans)
{
    for (int o = 0; o < 27; o++) {
        if (p->cover[o] < 0) continue;
        const mpm_block *b = &g->block[p->cover[o]];
        for (int64_t i = b->begin; i < b->end; i++) {
            reach r;
            if (!find_reach(g, v, p, i, &r)) continue;
            const double volume = v->strain[i].c[0].w;
            const double radius = 0.5*(g->dimension == 3 ? cbrt(volume) : sqrt(volume));
            const float own = mpm_side_of(v->material[v->solid[i]].group);
            for (int a = r.low[0]; a <= r.high[0]; a++)
                for (int e = r.low[1]; e <= r.high[1]; e++)
                    for (int c = r.low[2]; c <= r.high[2]; c++) {
                        const int n = node_of(g, &r, a, e, c);
                        double d[3], m[3], far;
                        if (!fresh[n]) continue;
                        look_from(g, v, p, &r, (const int[3]){a, e, c}, d);
                        for (int k = 0; k < 3; k++) m[k] = seam[n].normal[k];
                        far = vec3_dot(d, m);
                        if (side[n] == own) spans[n].second = fmin(spans[n].second, far - radius);
                        else spans[n].first = fmax(spans[n].first, far + radius);
                    }
        }
    }
}

int mpm_meet_find(const mpm_grid *g, const mpm_view *v, const int16_t *group, const mpm_patch *p, float *side,
                  mpm_seam *seam)
{
    const int nodes = g->dimension == 3 ? MPM_NODES_3D : MPM_NODES_2D;
    voice voices[MPM_NODES_3D][GROUPS];
    span spans[MPM_NODES_3D];
    char fresh[MPM_NODES_3D];
    int seen = MPM_MIXED - 1, meets = 0;
    for (int o = 0; o < 27; o++) {
        if (p->cover[o] < 0) continue;
        const int here = group[p->cover[o]];
        meets |= here == MPM_MIXED || (seen >= 0 && seen != here);
        seen = here;
    }
    if (!meets) return 0;
    memset(voices, 0, sizeof voices);
    for (int n = 0; n < nodes; n++)
        for (int k = 0; k < GROUPS; k++) voices[n][k].group = -1;
    hear(g, v, p, voices);
    meets = 0;
    for (int n = 0; n < nodes; n++) {
        spans[n] = (span){-INFINITY, INFINITY};
        fresh[n] = (char)(side[n] == 0 && decide(voices[n], &side[n], &seam[n]));
        meets |= fresh[n];
    }
    if (!meets) return 0;
    measure(g, v, p, side, seam, fresh, spans);
    for (int n = 0; n < nodes; n++)
        if (fresh[n]) seam[n].gap = (float)(spans[n].second - spans[n].first);
    return 1;
}
