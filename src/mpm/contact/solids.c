/* Where solids that are not bonded share a node, one of them has the second velocity there, and the
   two may part but not pass. Drawback: of three solids at one node two move as one. */
#include "mpm/contact/solids.h"
#include "geom/vec3.h"
#include "mpm/spline.h"
#include "tobiuo/types.h"
#include <math.h>
#include <string.h>

enum { GROUPS = 3 };                   /* that one node looks at                                   */
enum { SPAN = 6, CELLS = SPAN*SPAN*SPAN };     /* base nodes whose particles reach a patch         */

/* A patch and the particles around it. */
typedef struct scene {
    const mpm_grid *g;
    const mpm_view *v;
    const mpm_patch *p;
    int32_t near[27];                  /* blocks with particles that reach the patch               */
    int near_count;
    int16_t group[CELLS];              /* of the particles with this base node; EMPTY, MPM_MIXED   */
    char meets[CELLS];                 /* 1: such a particle feels a node where groups meet        */
} scene;

enum { EMPTY = -2, NORMALS = 4, WELL = 8 };     /* cells: more than any reach               */
#define MARGIN (2*MPM_SOLID_CONTACT_STALE)      /* the step in which it is exceeded included            */

/* What the particles of one group say at one node. */
typedef struct group_sums {
    int    group;                      /* -1 = none                                                */
    int    shaped;                     /* 1: keeps its shape, so that its surface is known best    */
    int    fixed;                      /* 1: is stationary                                         */
    double mass, friction;             /* kg; weighted by mass                                     */
    double towards[3];                 /* where its volume lies, m4                                */
    double place[3];                   /* kg m, from the node, weighted by mass                    */
    double reach[NORMALS];             /* m, along each normal, from WELL before the node          */
} group_sums;

static void mix(int16_t *to, int group)
{
    if (group == EMPTY) return;
    *to = (int16_t)(*to == EMPTY || *to == group ? group : MPM_MIXED);
}

typedef struct range { int low[3], high[3]; } range;

/* The base nodes of a particle, relative to the patch, wherever it moves by a tenth of a cell, cut to those
   that reach the patch; returns whether any do. */
static int find_range(const scene *s, int64_t i, range *r)
{
    const double *x = &s->v->position[i].x;
    r->low[2] = r->high[2] = -1;
    for (int a = 0; a < s->g->dimension; a++) {
        const double at = x[a]*s->v->inverse_cell + 3.5;       /* from -4: (int) is floor */
        r->low[a] = (int)(at - MARGIN) - 4 - s->p->corner[a];
        r->high[a] = (int)(at + MARGIN) - 4 - s->p->corner[a];
        if (r->low[a] > 3 || r->high[a] < -2) return 0;
        if (r->low[a] < -2) r->low[a] = -2;
        if (r->high[a] > 3) r->high[a] = 3;
    }
    return 1;
}

/* Place of a base node, relative to the patch, in the scene's lists. */
static int cell_of(int a, int b, int c) { return ((a + 2)*SPAN + b + 2)*SPAN + c + 2; }

/* A particle adds its group to its base nodes. */
static void stand(scene *s, const range *r, int group)
{
    for (int a = r->low[0]; a <= r->high[0]; a++)
        for (int b = r->low[1]; b <= r->high[1]; b++)
            for (int c = r->low[2]; c <= r->high[2]; c++) mix(&s->group[cell_of(a, b, c)], group);
}

static int is_near(const scene *s, const range *r)
{
    int near = 0;
    for (int a = r->low[0]; a <= r->high[0]; a++)
        for (int b = r->low[1]; b <= r->high[1]; b++)
            for (int c = r->low[2]; c <= r->high[2]; c++) near |= s->meets[cell_of(a, b, c)];
    return near;
}

mpm_extent mpm_solid_contact_look(const mpm_view *v, const mpm_block *b, int dimension)
{
    mpm_extent c = { .group = v->material[v->solid[b->begin]].group, .low = {1 << 30, 1 << 30, 1 << 30},
                    .high = {-(1 << 30), -(1 << 30), -(1 << 30)} };
    for (int64_t i = b->begin; i < b->end; i++) {
        if (v->material[v->solid[i]].group != c.group) c.group = MPM_MIXED;
        for (int a = 0; a < dimension; a++) {
            const int at = (int)floor((&v->position[i].x)[a]*v->inverse_cell - 0.5);
            if (at < c.low[a]) c.low[a] = at;
            if (at > c.high[a]) c.high[a] = at;
        }
    }
    return c;
}

/* Lists the blocks whose particles reach the patch; returns whether there is more than one group. */
static int list_blocks(scene *s, const mpm_extent *extent)
{
    int seen = EMPTY, meets = 0;
    s->near_count = 0;
    for (int o = 0; o < 27; o++) {
        int reaches = s->p->cover[o] >= 0;
        for (int a = 0; a < s->g->dimension && reaches; a++) {
            const mpm_extent *c = &extent[s->p->cover[o]];
            reaches = c->low[a] <= s->p->corner[a] + 4 && c->high[a] >= s->p->corner[a] - 3;
        }
        if (!reaches) continue;
        const int here = extent[s->p->cover[o]].group;
        meets |= here == MPM_MIXED || (seen != EMPTY && seen != here);
        seen = here;
        s->near[s->near_count++] = s->p->cover[o];
    }
    return meets;
}

/* Which base nodes have particles that feel a node without a side where groups meet. Returns if any. */
static int find_meetings(scene *s, const float *side)
{
    const int three = s->g->dimension == 3, nodes = three ? MPM_NODES_3D : MPM_NODES_2D;
    int any = 0;
    for (int k = 0; k < CELLS; k++) s->group[k] = EMPTY;
    memset(s->meets, 0, sizeof s->meets);
    for (int k = 0; k < s->near_count; k++) {
        const mpm_block *b = &s->g->block[s->near[k]];
        for (int64_t i = b->begin; i < b->end; i++) {
            range r;
            if (find_range(s, i, &r)) stand(s, &r, s->v->material[s->v->solid[i]].group);
        }
    }
    for (int n = 0; n < nodes; n++) {
        const int at[3] = {three ? n/16 : n/4, three ? n/4%4 : n%4, three ? n%4 : 0};
        int16_t here = EMPTY;
        if (side[n] != 0) continue;
        for (int pass = 0; pass < 2; pass++)
            for (int k = 0; k < 27; k++) {
                const int base = cell_of(at[0] - k/9, at[1] - k/3%3, three ? at[2] - k%3 : -1);
                if (pass == 0) mix(&here, s->group[base]);
                else s->meets[base] |= here == MPM_MIXED;
            }
        any |= here == MPM_MIXED;
    }
    return any;
}

/* What is said at one node. */
typedef struct meeting {
    group_sums sums[GROUPS];
    int   first, second;               /* whose velocities it has; first < 0: not decided, or one */
    double normal[NORMALS][3];         /* that are tried, from the first to the second            */
} meeting;

static void add_mass(const scene *s, int64_t i, double w, const double d[3], meeting *m)
{
    const mpm_material *of = &s->v->material[s->v->solid[i]];
    const double volume = s->v->strain[i].c[0].w, mass = (w + 1e-6)*s->v->strain[i].c[2].w;
    const double q = vec3_dot(d, d)*s->v->inverse_cell*s->v->inverse_cell/2.25;
    const double near = q < 0.99 ? 1 - q : 0.01;
    int k = 0;
    while (k < GROUPS && m->sums[k].group >= 0 && m->sums[k].group != of->group) k++;
    if (k == GROUPS) return;
    group_sums *to = &m->sums[k];
    to->group = of->group;
    to->mass += mass;
    to->friction += mass*of->surface_friction;
    to->shaped |= of->model != TOBI_LIQUID;
    to->fixed |= of->model == TOBI_STATIONARY;
    for (int a = 0; a < 3; a++) {
        to->towards[a] += volume*near*d[a];
        to->place[a] += mass*d[a];
    }
}

/* radius: m, half a spacing, which a particle fills. */
static void add_reach(const scene *s, int64_t i, double radius, const double d[3], meeting *m)
{
    const int second = s->v->material[s->v->solid[i]].group == m->sums[m->second].group;
    double *reach = m->sums[second ? m->second : m->first].reach;
    for (int k = 0; k < NORMALS; k++) {
        const double along = vec3_dot(d, m->normal[k]);
        reach[k] = fmax(reach[k], (second ? -along : along) + radius + WELL*s->v->cell);
    }
}

/* Adds a particle to the nodes that feel it, or soon may: what it is or, once it is decided who meets,
   how far it reaches. */
static void add_particle(const scene *s, int64_t i, const range *r, const float *side, meeting *meetings,
                         int decided)
{
    const int three = s->g->dimension == 3;
    const double cell = s->v->cell, volume = s->v->strain[i].c[0].w, *x = &s->v->position[i].x;
    const double radius = !decided ? 0 : 0.5*(three ? cbrt(volume) : sqrt(volume));
    int low[3], high[3];
    for (int a = 0; a < 3; a++) {
        low[a] = a == 2 && !three ? 0 : r->low[a] < 0 ? 0 : r->low[a];
        high[a] = a == 2 && !three ? 0 : r->high[a] > 1 ? 3 : r->high[a] + 2;
    }
    for (int a = low[0]; a <= high[0]; a++)
        for (int b = low[1]; b <= high[1]; b++)
            for (int c = low[2]; c <= high[2]; c++) {
                const int n = three ? (a*4 + b)*4 + c : a*4 + b;
                if (decided ? meetings[n].first < 0 : side[n] != 0) continue;
                const double d[3] = {x[0] - (s->p->corner[0] + a)*cell, x[1] - (s->p->corner[1] + b)*cell,
                                     three ? x[2] - (s->p->corner[2] + c)*cell : 0};
                if (decided) {
                    add_reach(s, i, radius, d, &meetings[n]);
                    continue;
                }
                double w = 1;
                for (int k = 0; k < s->g->dimension; k++) w *= mpm_spline_at(d[k]*s->v->inverse_cell);
                add_mass(s, i, w, d, &meetings[n]);
            }
}

static void add_particles(const scene *s, const float *side, meeting *meetings, int decided)
{
    for (int k = 0; k < s->near_count; k++) {
        const mpm_block *b = &s->g->block[s->near[k]];
        for (int64_t i = b->begin; i < b->end; i++) {
            range r;
            if (find_range(s, i, &r) && is_near(s, &r)) add_particle(s, i, &r, side, meetings, decided);
        }
    }
}

/* The heaviest group has the first velocity, the next the second; a third joins the first. Normals are tried
   from the volume of either, of both, and from one's mean place to the other's; where only one keeps its
   shape, from that. */
static void decide(meeting *m)
{
    int first = 0, second = -1;
    for (int k = 1; k < GROUPS && m->sums[k].group >= 0; k++) {
        if (m->sums[k].mass > m->sums[first].mass) { second = first; first = k; }
        else if (second < 0 || m->sums[k].mass > m->sums[second].mass) second = k;
    }
    if (second < 0) return;
    const group_sums *f = &m->sums[first], *s = &m->sums[second];
    for (int k = 0; k < NORMALS; k++) {
        const int use_first = f->shaped == s->shaped ? k != 1 : f->shaped;
        const int use_second = f->shaped == s->shaped ? k != 0 : s->shaped;
        for (int a = 0; a < 3; a++)
            m->normal[k][a] = k == 3 && f->shaped == s->shaped
                                  ? s->place[a]/s->mass - f->place[a]/f->mass
                                  : use_second*s->towards[a] - use_first*f->towards[a];
        vec3_normalize(m->normal[k]);
    }
    m->first = first;
    m->second = second;
}

/* The normal with the widest gap parts the two best: at the corner of a block on a floor, the floor's. */
static void write_cut_face(const meeting *m, double cell, float *side, mpm_cut_face *cut_face)
{
    const group_sums *first = &m->sums[m->first], *second = &m->sums[m->second];
    int best = 2;
    for (int k = 0; k < NORMALS; k++)
        if (first->reach[k] + second->reach[k] < first->reach[best] + second->reach[best]) best = k;
    *side = mpm_side_of(second->group);
    for (int a = 0; a < 3; a++) cut_face->normal[a] = (float)m->normal[best][a];
    cut_face->gap = (float)(2*WELL*cell - first->reach[best] - second->reach[best]);
    cut_face->fixed = first->fixed ? 1 : second->fixed ? 2 : 0;
    cut_face->friction = (float)sqrt(first->friction/first->mass*second->friction/second->mass);
}

int mpm_solid_contact_find(const mpm_grid *g, const mpm_view *v, const mpm_extent *extent, const mpm_patch *p,
                  float *side, mpm_cut_face *cut_face)
{
    const int nodes = g->dimension == 3 ? MPM_NODES_3D : MPM_NODES_2D;
    scene s = { .g = g, .v = v, .p = p };
    meeting meetings[MPM_NODES_3D];
    int any = 0;
    if (!list_blocks(&s, extent) || !find_meetings(&s, side)) return 0;
    for (int n = 0; n < nodes; n++) {
        meetings[n] = (meeting){ .first = -1, .second = -1 };
        for (int k = 0; k < GROUPS; k++) meetings[n].sums[k] = (group_sums){ .group = -1 };
    }
    add_particles(&s, side, meetings, 0);
    for (int n = 0; n < nodes; n++)
        if (side[n] == 0) decide(&meetings[n]);
    add_particles(&s, side, meetings, 1);
    for (int n = 0; n < nodes; n++) {
        if (meetings[n].first < 0) continue;
        write_cut_face(&meetings[n], v->cell, &side[n], &cut_face[n]);
        any = 1;
    }
    return any;
}
