/* One transfer of the particles to the grid for output, eq. (3) without the stress. It changes nothing and
   needs no blocks, so that it works before the first step and after a restart. The nodes live in a hash
   table; the drawback is that one core does it. */
#include "mpm/nodes.h"
#include "mpm/fields.h"
#include "mpm/spline.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct node {
    int64_t key;                       /* -1 = free */
    double  mass, volume;              /* kg, m3    */
    double  momentum[3], stress[6];    /* kg m/s, J */
} node;

typedef struct table {
    int64_t low[3];                    /* lowest node of all                            */
    node   *slot;
    int64_t room, count;               /* room: a power of two */
    int     failed;
} table;

enum { BITS = 21, SPAN = 1 << BITS };  /* nodes per axis, from low */

static int64_t make_key(const table *t, const int64_t at[3])
{
    int64_t key = 0;
    for (int a = 0; a < 3; a++) key = key << BITS | ((at[a] - t->low[a]) & (SPAN - 1));
    return key;
}

static node *find_slot(node *slots, int64_t room, int64_t key)
{
    uint64_t h = (uint64_t)key*UINT64_C(0x9e3779b97f4a7c15);
    int64_t k = (int64_t)(h >> 20) & (room - 1);
    while (slots[k].key >= 0 && slots[k].key != key) k = (k + 1) & (room - 1);
    return &slots[k];
}

static node *make_slots(int64_t room)
{
    node *slots = calloc((size_t)room, sizeof *slots);
    for (int64_t k = 0; slots && k < room; k++) slots[k].key = -1;
    return slots;
}

/* At most half full. NULL without memory. */
static node *open_node(table *t, int64_t key)
{
    if (2*(t->count + 1) > t->room) {
        node *more = make_slots(2*t->room);
        if (!more) return NULL;
        for (int64_t k = 0; k < t->room; k++)
            if (t->slot[k].key >= 0) *find_slot(more, 2*t->room, t->slot[k].key) = t->slot[k];
        free(t->slot);
        t->slot = more;
        t->room *= 2;
    }
    node *n = find_slot(t->slot, t->room, key);
    if (n->key < 0) t->count++;
    n->key = key;
    return n;
}

/* What one particle gives to its nodes. */
static void add_particle(const mpm_view *v, int64_t i, int dimension, table *t)
{
    const double x[3] = {v->position[i].x, v->position[i].y, v->position[i].z};
    const tobi_float4 u = v->velocity[i];
    const tobi_columns *c = &v->affine[i];
    const mpm_sample s = mpm_sample_particle(v, i);
    double w[3][3] = {{1}, {1}, {1}}, f[3] = {0}, mass = v->strain[i].c[2].w;
    double volume = v->strain[i].c[0].w*s.ratio;
    int64_t first[3] = {0};
    for (int a = 0; a < dimension; a++) {
        first[a] = mpm_spline(x[a]*v->inverse_cell, w[a]);
        f[a] = x[a]*v->inverse_cell - (double)first[a];
    }
    for (int k = 0; k < (dimension == 3 ? 27 : 9); k++) {
        const int n[3] = {k%3, k/3%3, k/9};
        int64_t at[3] = {first[0] + n[0], first[1] + n[1], first[2] + n[2]};
        double weight = w[0][n[0]]*w[1][n[1]]*w[2][n[2]], d[3] = {0};
        node *to = open_node(t, make_key(t, at));
        if (!to) {
            t->failed = 1;
            return;
        }
        for (int a = 0; a < dimension && v->affine_momentum; a++) d[a] = (n[a] - f[a])/v->inverse_cell;
        const double speed[3] = {u.x + c->c[0].x*d[0] + c->c[1].x*d[1] + c->c[2].x*d[2],
                                 u.y + c->c[0].y*d[0] + c->c[1].y*d[1] + c->c[2].y*d[2],
                                 u.z + c->c[0].z*d[0] + c->c[1].z*d[1] + c->c[2].z*d[2]};
        to->mass += weight*mass;
        to->volume += weight*volume;
        for (int a = 0; a < 3; a++) to->momentum[a] += weight*mass*speed[a];
        for (int a = 0; a < 6; a++) to->stress[a] += weight*volume*s.stress[a];
    }
}

static int compare(const void *a, const void *b)
{
    int64_t p = ((const node *)a)->key, q = ((const node *)b)->key;
    return (p > q) - (p < q);
}

static void write_node(const mpm_view *v, const table *t, const node *n, tobi_grid *g, int64_t k)
{
    int64_t key = n->key;
    for (int a = 2; a >= 0; a--, key >>= BITS)
        g->position[k][a] = (double)((key & (SPAN - 1)) + t->low[a])/v->inverse_cell;
    g->mass[k] = n->mass;
    for (int a = 0; a < 3; a++) g->velocity[k][a] = n->momentum[a]/n->mass;
    for (int a = 0; a < 6; a++) g->stress[k][a] = n->stress[a]/n->volume;
}

/* Nodes with mass, in order. */
static tobi_status write_nodes(const mpm_view *v, table *t, int dimension, tobi_grid *g, tobi_error *err)
{
    int64_t count = 0;
    for (int64_t k = 0; k < t->room; k++)
        if (t->slot[k].key >= 0 && t->slot[k].mass > 0) t->slot[count++] = t->slot[k];
    qsort(t->slot, (size_t)count, sizeof *t->slot, compare);
    size_t room = (size_t)count + 1;
    *g = (tobi_grid){ .count = count, .position = malloc(room*sizeof *g->position),
                      .velocity = malloc(room*sizeof *g->velocity), .mass = malloc(room*sizeof *g->mass),
                      .stress = malloc(room*sizeof *g->stress) };
    if (!g->position || !g->velocity || !g->mass || !g->stress)
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld nodes of the grid", (long long)count);
    for (int64_t k = 0; k < count; k++) {
        write_node(v, t, &t->slot[k], g, k);
        if (dimension == 2) g->position[k][2] = 0;
    }
    return TOBI_OK;
}

static tobi_status find_low(const mpm_view *v, int64_t count, int dimension, table *t, tobi_error *err)
{
    for (int a = 0; a < dimension && count > 0; a++) {
        double low = INFINITY, high = -INFINITY;
        for (int64_t i = 0; i < count; i++) {
            double x = (&v->position[i].x)[a]*v->inverse_cell;
            low = fmin(low, x);
            high = fmax(high, x);
        }
        if (!(high - low < SPAN - 4))
            return tobi_fail(err, TOBI_UNSUPPORTED, "the material reaches over %g cells along %c; nodes are "
                             "written for at most %d", high - low, "xyz"[a], SPAN);
        t->low[a] = (int64_t)floor(low - 0.5);
    }
    return TOBI_OK;
}

tobi_status mpm_nodes_find(const mpm_view *v, int64_t count, int dimension, tobi_grid *grid, tobi_error *err)
{
    table t = { .room = 1 << 12 };
    *grid = (tobi_grid){ 0 };
    TOBI_TRY(find_low(v, count, dimension, &t, err));
    t.slot = make_slots(t.room);
    t.failed = !t.slot;
    for (int64_t i = 0; i < count && !t.failed; i++) add_particle(v, i, dimension, &t);
    tobi_status status = t.failed ? tobi_fail(err, TOBI_NO_MEMORY, "no memory for the nodes of the grid")
                                  : write_nodes(v, &t, dimension, grid, err);
    free(t.slot);
    return status;
}
