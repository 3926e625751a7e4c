/* Contact with bodies acts on the nodes of the grid, between forces and motion, so that stress feels
   it in the same step. Drawback: a sweep over all contacts several times per step. */
#include "mpm/contact/touch.h"
#include "base/error.h"
#include "geom/vec3.h"
#include "mpm/contact/clamp.h"
#include "mpm/contact/sides.h"
#include "mpm/feel.h"
#include "mpm/spline.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SWEEPS = 8 };
static const double ENOUGH = 4e-3;     /* of the largest impulse may still change: forces within 0.3 % */

void mpm_touch_free(mpm_touch *t)
{
    mpm_packs_free(&t->packs);
    tobi_contact_free(&t->contacts);
    free(t->node);
    free(t->weight);
    free(t->response);
    free(t->piece);
    free(t->around);
    free(t->push);
    free(t->moving);
    memset(t, 0, sizeof *t);
}

/* Places of all nodes, second velocities included. */
static int64_t count_nodes(const mpm_grid *g)
{
    return (g->patch_count + g->patch_twins)*(g->dimension == 3 ? MPM_NODES_3D : MPM_NODES_2D);
}

/* Entries of contact k begin here: one for each node that a particle feels; for an edge as many as a node may
   have velocities. */
static int64_t entry_of(const mpm_touch *t, int64_t k, int64_t each)
{
    return k < t->edge_first ? k*each : (t->edge_first + t->ways*(k - t->edge_first))*each;
}

static tobi_status reserve_entries(mpm_touch *t, int64_t count)
{
    if (count <= t->room) return TOBI_OK;
    free(t->node);
    free(t->weight);
    t->room = count + count/4 + 4096;
    t->node = malloc((size_t)t->room*sizeof *t->node);
    t->weight = malloc((size_t)t->room*2*sizeof *t->weight);
    if (t->node && t->weight) return TOBI_OK;
    t->room = 0;
    return TOBI_NO_MEMORY;
}

static tobi_status reserve_contacts(mpm_touch *t, int64_t count)
{
    if (count <= t->push_room) return TOBI_OK;
    free(t->push);
    free(t->moving);
    t->push_room = count + count/4 + 64;
    t->push = malloc((size_t)t->push_room*2*sizeof *t->push);
    t->moving = malloc((size_t)t->push_room*2*sizeof *t->moving);
    if (t->push && t->moving) return TOBI_OK;
    t->push_room = 0;
    return TOBI_NO_MEMORY;
}

static tobi_status reserve_nodes(mpm_touch *t, int64_t count)
{
    if (count <= t->node_room) return TOBI_OK;
    free(t->response);
    t->node_room = count + count/8;
    t->response = calloc((size_t)t->node_room, sizeof *t->response);
    if (t->response) return TOBI_OK;
    t->node_room = 0;
    return TOBI_NO_MEMORY;
}

static tobi_status reserve(mpm_touch *t, const mpm_grid *g, int64_t contacts, tobi_error *err)
{
    t->count = entry_of(t, contacts, mpm_nodes_each(g));
    if (reserve_entries(t, t->count) == TOBI_OK && reserve_contacts(t, contacts) == TOBI_OK &&
        reserve_nodes(t, count_nodes(g)) == TOBI_OK) return TOBI_OK;
    return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld contacts", (long long)contacts);
}

/* Threads for a loop over all entries. */
static int team_of(const mpm_touch *t, const tobi_exec *x) { return tobi_team(x, t->count, 16384); }

typedef struct spreading {
    mpm_touch *touch;
    const tobi_contacts *contacts;
    const mpm_grid *grid;
    const mpm_view *v;
} spreading;

/* Eq. (2b), (2c). */
static void spread_contacts(const void *view, int64_t begin, int64_t end)
{
    const spreading *s = view;
    const mpm_grid *g = s->grid;
    const mpm_view *v = s->v;
    const int dim = g->dimension, each = mpm_nodes_each(g), deep = dim == 3 ? 3 : 1;
    mpm_felt last = { 0 };
    for (int64_t k = begin; k < end; k++) {
        const tobi_contact *contact = &s->contacts->list[k];
        const int64_t i = contact->particle;
        const double reach = -4*contact->depth*v->inverse_cell;
        float *weight = s->touch->weight + 2*k*each;
        double w[3][3] = {{1}, {1}, {1}}, slope[3][3] = {{0}};
        int base[3];
        mpm_feel(g, v, i, &last, s->touch->node + k*each, w, base);
        for (int a = 0; a < dim; a++) {
            const double place = (&v->position[i].x)[a]*v->inverse_cell;
            for (int n = 0; n < 3; n++) slope[a][n] = (base[a] + n - place)*reach*contact->normal[a];
        }
        for (int m = 0; m < 9; m++)
            for (int l = 0; l < deep; l++) {
                const double all = w[0][m/3]*w[1][m%3]*w[2][l];
                float *to = weight + 2*(deep*m + l);
                to[0] = (float)all;
                to[1] = (float)(all*(1 + slope[0][m/3] + slope[1][m%3] + slope[2][l]));
            }
    }
}

static void find_nodes(mpm_touch *t, const tobi_contacts *c, const mpm_grid *g, const mpm_view *v,
                       tobi_exec *x)
{
    const spreading view = { t, c, g, v };
    tobi_loop(tobi_team(x, t->edge_first, 256), t->edge_first, 0, spread_contacts, &view);
}

/* The nodes around a place: of all velocities, with their weights. */
typedef struct mpm_surroundings {
    int first[3];                      /* the lowest node                                          */
    int64_t place[MPM_VELOCITIES][27]; /* -1 = none                                                */
    double mass[27];                   /* kg, of all velocities                                    */
    double weight[27];
    double full;                       /* kg, by these weights                                     */
} surroundings;

/* The blocks of nodes around one place, kept for the next, which mostly has the same. */
typedef struct region {
    int low[3], high[3];               /* blocks of the lowest node and of the highest             */
    int known, complete;               /* complete: 1 if all of them exist                         */
    int64_t patch[8];
} region;

/* The blocks of nodes that the 3 nodes from `first` along each axis lie in. */
static void find_region(const mpm_grid *g, const int first[3], region *r)
{
    int same = r->known;
    for (int a = 0; a < g->dimension; a++) {
        same &= r->low[a] == first[a] >> 2 && r->high[a] == (first[a] + 2) >> 2;
        r->low[a] = first[a] >> 2;
        r->high[a] = (first[a] + 2) >> 2;
    }
    if (same) return;
    r->known = r->complete = 1;
    for (int n = 0; n < 8 && r->complete; n++) {
        const int step[3] = {n >> 2, n >> 1 & 1, n & 1};
        int at[3] = {0, 0, 0}, from = n;
        for (int a = 0; a < 3; a++) {
            if (a < g->dimension) at[a] = 4*(step[a] ? r->high[a] : r->low[a]);
            if (step[a] && (a >= g->dimension || r->low[a] == r->high[a])) from = n & ~(4 >> a);
        }
        r->patch[n] = from < n ? r->patch[from] : mpm_grid_find_patch(g, at);
        r->complete = r->patch[n] >= 0;
    }
}

/* The nodes of s->first, as many velocities of each as `ways`. */
static void list_around(const mpm_grid *g, const region *r, int ways, surroundings *s)
{
    const int three = g->dimension == 3, nodes = three ? MPM_NODES_3D : MPM_NODES_2D;
    for (int n = 0; n < mpm_nodes_each(g); n++) {
        const int at[3] = {s->first[0] + (three ? n/9 : n/3), s->first[1] + (three ? n/3 : n)%3,
                           s->first[2] + (three ? n%3 : 0)};
        const int far = (at[0] >> 2 != r->low[0])*4 + (at[1] >> 2 != r->low[1])*2 +
                        (three && at[2] >> 2 != r->low[2]), row = (at[0] & 3)*4 + (at[1] & 3);
        const mpm_patch *p = &g->patch[r->patch[far]];
        s->mass[n] = 0;
        for (int m = 0; m < ways; m++) {
            const int64_t place = (m ? p->twin + m - 1 : r->patch[far])*nodes +
                                  (three ? row*4 + (at[2] & 3) : row);
            const int there = m < 1 << p->levels;
            s->place[m][n] = there ? place : -1;
            s->mass[n] += there ? g->node[place].w : 0;
        }
    }
}

/* before: of another place, NULL = none. 0 if no material is near. */
static int look_around(const mpm_grid *g, const double x[3], double inverse_cell, int ways, region *r,
                       const surroundings *before, surroundings *s)
{
    const int dim = g->dimension, deep = dim == 3 ? 3 : 1;
    double w[3][3] = {{1}, {1}, {1}};
    memset(s->first, 0, sizeof s->first);
    for (int a = 0; a < dim; a++) s->first[a] = (int)mpm_spline(x[a]*inverse_cell, w[a]);
    find_region(g, s->first, r);
    if (!r->complete) return 0;
    if (before && !memcmp(before->first, s->first, sizeof s->first)) {
        memcpy(s->place, before->place, (size_t)ways*sizeof *s->place);
        memcpy(s->mass, before->mass, sizeof s->mass);
    } else {
        list_around(g, r, ways, s);
    }
    s->full = 0;
    for (int m = 0, n = 0; m < 9; m++) {
        const double across = w[0][m/3]*w[1][m%3];
        for (int l = 0; l < deep; l++, n++) {
            s->weight[n] = across*w[2][l];
            s->full += s->weight[n]*s->mass[n];
        }
    }
    return 1;
}

/* Lists the pieces of a blade's edge that lie in material, and their surroundings in the same order. The
   share rises from 0 to 1 within half a cell across the surface. */
static tobi_status list_edges(mpm_touch *t, tobi_contacts *c, tobi_body *b, const mpm_grid *g,
                              const mpm_view *v, const tobi_contact_step *step, tobi_error *err)
{
    const double size = 2*step->radius;
    int64_t count = tobi_blade_pieces(b, g->dimension, size, t->piece, t->piece_room), listed = 0;
    if (count > t->piece_room) {
        free(t->piece);
        free(t->around);
        t->piece = malloc((size_t)count*sizeof *t->piece);
        t->around = malloc((size_t)count*sizeof *t->around);
        t->piece_room = t->piece && t->around ? count : 0;
        if (!t->piece_room) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the edge of '%s'", b->name);
        tobi_blade_pieces(b, g->dimension, size, t->piece, t->piece_room);
    }
    TOBI_TRY(tobi_blade_restore(b, count, err));
    region last = { .known = 0 };
    for (int64_t k = 0; k < count; k++) {
        surroundings *s = &t->around[listed];
        const surroundings *before = listed > 0 ? s - 1 : NULL;
        if (!look_around(g, t->piece[k].middle, v->inverse_cell, t->ways, &last, before, s)) continue;
        const double full = fmin(1, 2*s->full/t->cell_mass - 0.5);
        if (!(full > 0)) continue;
        TOBI_TRY(tobi_contact_add_edge(c, b, &t->piece[k], full, step, err));
        listed++;
    }
    return TOBI_OK;
}

/* A piece of an edge moves as the momentum around it says, eq. (4b): a node that hardly has mass neither
   moves it nor is thrown by it. */
static void find_edge_nodes(mpm_touch *t, const tobi_contacts *c, const mpm_grid *g)
{
    const int each = mpm_nodes_each(g);
    for (int64_t k = t->edge_first; k < c->count; k++) {
        const surroundings *s = &t->around[k - t->edge_first];
        uint32_t *node = t->node + entry_of(t, k, each);
        float *weight = t->weight + 2*entry_of(t, k, each);
        for (int n = 0; n < each; n++)
            for (int m = 0; m < t->ways; m++) {
                const int64_t place = s->place[m][n];
                const double mass = place < 0 ? 0 : g->node[place].w;
                const int at = t->ways*n + m;
                node[at] = (uint32_t)(mass > 0 ? place : s->place[0][n]);
                weight[2*at] = weight[2*at + 1] = (float)(s->weight[n]*mass/s->full);
            }
    }
}

static mpm_pack_view view_packs(const mpm_touch *t, const mpm_grid *g)
{
    return (mpm_pack_view){ .pack = t->packs.pack, .node = t->node, .weight = t->packs.weight,
                            .velocity = g->node, .response = t->response, .push = t->push,
                            .moving = t->moving };
}

static tobi_status pack_contacts(mpm_touch *t, const tobi_contacts *c, const mpm_grid *g, tobi_error *err)
{
    const mpm_pack_entries e = { .node = t->node, .weight = t->weight, .contacts = c->count,
                                 .edge_first = t->edge_first, .each = mpm_nodes_each(g),
                                 .edge_each = t->ways*mpm_nodes_each(g) };
    return mpm_packs_make(&t->packs, &e, &c->list->particle, sizeof *c->list, g, err);
}

static void find_mobility(mpm_touch *t, tobi_contacts *c, const mpm_grid *g, tobi_exec *x)
{
    const mpm_pack_view v = view_packs(t, g);
    const int team = team_of(t, x);
    mpm_packs_visit(&t->packs, t->kernels->load, &v, team);
    mpm_packs_visit(&t->packs, t->kernels->answer, &v, team);
    mpm_packs_visit(&t->packs, t->kernels->forget, &v, team);
    for (int64_t k = 0; k < c->count; k++)
        for (int m = 0; m < 2; m++) c->list[k].mobility[m] = t->moving[2*k + m].w;
}

static void read_velocities(const mpm_touch *t, tobi_contacts *c, const mpm_grid *g, tobi_exec *x)
{
    const mpm_pack_view v = view_packs(t, g);
    mpm_packs_visit(&t->packs, t->kernels->read, &v, team_of(t, x));
    for (int64_t k = 0; k < c->count; k++) {
        tobi_contact *one = &c->list[k];
        const float *inside = &t->moving[2*k].x, *edge = &t->moving[2*k + 1].x;
        double along = 0;
        for (int a = 0; a < 3; a++) along += one->normal[a]*((double)inside[a] - edge[a]);
        for (int a = 0; a < 3; a++) one->velocity[a] = edge[a] + along*one->normal[a];
    }
}

static void add_impulses(const mpm_touch *t, const tobi_contacts *c, const mpm_grid *g, tobi_exec *x)
{
    const mpm_pack_view v = view_packs(t, g);
    for (int64_t k = 0; k < c->count; k++) {
        const double *change = c->list[k].change, *normal = c->list[k].normal;
        const double along = vec3_dot(change, normal);
        double part[3];
        vec3_add_scaled(part, change, -along, normal);
        t->push[2*k] = (tobi_float4){(float)(along*normal[0]), (float)(along*normal[1]),
                                     (float)(along*normal[2]), 0};
        t->push[2*k + 1] = (tobi_float4){(float)part[0], (float)part[1], (float)part[2], 0};
    }
    mpm_packs_visit(&t->packs, t->kernels->push, &v, team_of(t, x));
}

/* How the body answers, and with what velocities if joints hold it. */
static void know_joints(tobi_contacts *c, tobi_system *s, const tobi_contact_step *step)
{
    tobi_simulation *sim = s->sim;
    double velocity[6];
    tobi_constraints_inverse(&sim->constraints, sim->bodies, step->body, c->inverse);
    if (!tobi_constraints_expect(&sim->constraints, sim->bodies, step->body, step->dt, velocity)) return;
    memcpy(c->velocity, velocity, sizeof c->velocity);
    memcpy(c->spin, velocity + 3, sizeof c->spin);
}

/* The impulses of all contacts in the list, onto the nodes. */
static tobi_status answer_contacts(mpm_touch *t, tobi_system *s, tobi_body *b, const mpm_grid *g,
                                   const mpm_view *v, const tobi_contact_step *step, tobi_error *err)
{
    tobi_contacts *c = &t->contacts;
    if (c->count == 0) return TOBI_OK;
    TOBI_TRY(reserve(t, g, c->count, err));
    find_nodes(t, c, g, v, &s->sim->exec);
    find_edge_nodes(t, c, g);
    TOBI_TRY(pack_contacts(t, c, g, err));
    find_mobility(t, c, g, &s->sim->exec);
    read_velocities(t, c, g, &s->sim->exec);
    tobi_contact_aim(c, b, step, &s->sim->exec);
    for (int sweep = 0; sweep <= SWEEPS; sweep++) {
        double moved = tobi_contact_sweep(c, b, step, sweep == 0, &s->sim->exec);
        add_impulses(t, c, g, &s->sim->exec);
        if (t->cut) mpm_cut_sweep(t->cut, &s->sim->exec, g, step->dt);
        read_velocities(t, c, g, &s->sim->exec);
        if (sweep > 0 && moved < ENOUGH) break;
    }
    return TOBI_OK;
}

static tobi_status touch_body(mpm_touch *t, tobi_system *s, tobi_body *b, const mpm_grid *g,
                              const mpm_view *v, const tobi_contact_step *step, tobi_error *err)
{
    tobi_contacts *c = &t->contacts;
    TOBI_TRY(tobi_contact_find(c, &s->particles, b, step, &s->sim->exec, err));
    if (b->rigid.kind != TOBI_PRESCRIBED) mpm_clamp_velocity(t->clamp, step->body, c->velocity, c->spin);
    if (c->count > 0 || b->blade) know_joints(c, s, step);
    t->edge_first = c->count;
    t->ways = g->levels > 1 ? 1 << g->levels : 2;
    if (b->blade && b->edge_resistance > 0 && b->rigid.cut > 0)
        TOBI_TRY(list_edges(t, c, b, g, v, step, err));
    return answer_contacts(t, s, b, g, v, step, err);
}

static tobi_status touch_side(mpm_touch *t, tobi_system *s, int side, const mpm_grid *g, const mpm_view *v,
                              const tobi_contact_step *step, tobi_error *err)
{
    tobi_contacts *c = &t->contacts;
    tobi_body b;
    TOBI_TRY(mpm_sides_list(c, s, side, step, &b, err));
    t->edge_first = c->count;
    TOBI_TRY(answer_contacts(t, s, &b, g, v, step, err));
    s->info.contacts += tobi_contact_finish(c, &s->particles, &b, step, &t->far, &t->work, &s->sim->exec);
    for (int a = 0; a < 3; a++) s->info.wall_force[a] += b.rigid.impulse[a]/step->dt;
    return TOBI_OK;
}

tobi_status mpm_touch_bodies(mpm_touch *t, tobi_system *s, const mpm_grid *g, const mpm_view *v,
                             const tobi_contact_step *step, double drift, tobi_error *err)
{
    t->far = 0;
    t->work = (tobi_contact_work){ 0 };
    s->info.contacts = 0;
    if (s->sim->body_count == 0 && !v->touched) return TOBI_OK;
    TOBI_TRY(tobi_contact_begin(&t->contacts, &s->particles, drift, &s->sim->exec, err));
    for (int k = 0; k < 2*g->dimension; k++)
        if (v->touched >> k & 1) TOBI_TRY(touch_side(t, s, k, g, v, step, err));
    for (int k = 0; k < s->sim->body_count; k++) {
        if (s->sim->bodies[k].is_absent) continue;
        tobi_contact_step own = *step;
        own.body = k;
        TOBI_TRY(touch_body(t, s, &s->sim->bodies[k], g, v, &own, err));
        s->info.contacts += tobi_contact_finish(&t->contacts, &s->particles, &s->sim->bodies[k], step,
                                                &t->far, &t->work, &s->sim->exec);
    }
    return TOBI_OK;
}
