/* Sides of the domain that particles of solids touch themselves, as they touch bodies. Nodes that obey a side
   stop what is a cell away from it: beside a liquid that is a layer of liquid which nothing holds there
   (decisions 113 and 120). Drawback: where a solid that touches a side lies beside one that started there,
   nodes of both stop it. */
#include "mpm/contact/sides.h"
#include "mpm/contact/clamp.h"
#include "exec/exec.h"
#include "mpm/feel.h"
#include "mpm/particle_fields.h"
#include <math.h>
#include <string.h>

enum { THERE = 1 << 6 };
_Static_assert(THERE >> 2*3 == 1, "above the bits of six sides");

/* Friction of a side that holds what it touches. */
static const double HOLDS = 1e3;

static int kind_of(const tobi_system *s, int side)
{
    return side%2 ? s->sim->def.wall_max[side/2] : s->sim->def.wall_min[side/2];
}

typedef struct starting {
    const tobi_system *s;
    unsigned char *started;              /* [solids] bit 2 axis + side: starts there; THERE: has particles */
} starting;

/* Nearer than a spacing is at the side. */
static void find_started(const void *view, int64_t begin, int64_t end)
{
    const starting *v = view;
    const tobi_system *s = v->s;
    const mpm_fields *f = mpm_fields_of(&s->particles);
    for (int64_t i = begin; i < end; i++) {
        unsigned char *all = &v->started[s->particles.fluid[i]], own = THERE;
        for (int a = 0; a < s->box.dimension; a++) {
            const double x = (&f->rest[i].x)[a];
            own |= (x < s->smoothing.spacing) << 2*a;
            own |= (s->box.size[a] - x < s->smoothing.spacing) << (2*a + 1);
        }
        if (own & ~__atomic_load_n(all, __ATOMIC_RELAXED)) __atomic_fetch_or(all, own, __ATOMIC_RELAXED);
    }
}

void mpm_sides_find(const tobi_system *s, mpm_view *v, uint8_t touched[])
{
    unsigned char started[TOBI_SOLID_LIMIT + 1] = { 0 };
    const starting view = { s, started };
    int walls = 0;
    for (int k = 0; k < 2*s->box.dimension; k++)
        walls |= (kind_of(s, k) != TOBI_WALL_OPEN && kind_of(s, k) != TOBI_WALL_PERIODIC) << k;
    v->touched = 0;
    v->obeyed = walls;
    v->limited = mpm_fields_of(&s->particles)->clamp ? walls : 0;
    if (s->sim->soft.solids != s) return;
    const int64_t count = s->particles.count;
    tobi_loop(tobi_team(&s->sim->exec, count, 32768), count, 0, find_started, &view);
    v->obeyed = 0;
    for (int k = 0; k < s->solid_count; k++) {
        touched[k] = started[k] ? (uint8_t)(walls & ~started[k]) : 0;
        v->touched |= touched[k];
        v->obeyed |= walls & started[k];
    }
    v->limited |= v->touched;
    s->sim->soft.touched = touched;
}

/* --- nodes ------------------------------------------------------------------------------------------ */

/* held: of particles that a clamp holds, which take marks away. */
typedef struct marking { const tobi_system *s; mpm_grid *g; const mpm_view *v; int held; } marking;

static void forget_marks(const void *view, int64_t begin, int64_t end)
{
    const marking *m = view;
    for (int64_t k = begin; k < end; k++) memset(m->g->patch[k].obey, 0, sizeof m->g->patch[k].obey);
}

/* The nodes that particle i feels obey sides of axis a, or do not. */
static void mark_nodes(const marking *m, int64_t i, int a, mpm_felt *last, uint32_t *node)
{
    const int nodes = m->g->dimension == 3 ? MPM_NODES_3D : MPM_NODES_2D;
    double weight[3][3];
    int base[3];
    mpm_feel(m->g, m->v, i, last, node, weight, base);
    for (int n = 0; n < mpm_nodes_each(m->g); n++) {
        const uint64_t bit = UINT64_C(1) << node[n]%nodes;
        uint64_t *all = &m->g->patch[node[n]/nodes].obey[a];
        const int marked = (__atomic_load_n(all, __ATOMIC_RELAXED) & bit) != 0;
        if (m->held && marked) __atomic_fetch_and(all, ~bit, __ATOMIC_RELAXED);
        if (!m->held && !marked) __atomic_fetch_or(all, bit, __ATOMIC_RELAXED);
    }
}

/* A particle nearer than 1.5 cells to a side feels nodes on it. */
static void mark_blocks(const void *view, int64_t begin, int64_t end)
{
    const marking *m = view;
    const tobi_system *s = m->s;
    for (int64_t k = begin; k < end; k++) {
        const mpm_block *b = &m->g->block[k];
        mpm_felt last = { .block = NULL };
        uint32_t node[2][MPM_FELT];      /* of this particle and of the one before */
        for (int side = 0; side < 2*s->box.dimension; side++) {
            const int a = side/2;
            const double size = s->box.size[a];
            if (!(m->v->limited & m->v->obeyed & 1 << side)) continue;
            if (side%2 ? (b->corner[a] + 7)*(double)m->v->cell < size : b->corner[a] > 2) continue;
            for (int64_t i = b->begin; i < b->end; i++) {
                const double x = (&s->particles.position[i].x)[a];
                if (m->v->touched && s->sim->soft.touched[s->particles.fluid[i]] >> side & 1) continue;
                if ((mpm_clamp_body(s, i) >= 0) != m->held) continue;
                if ((side%2 ? size - x : x) >= 1.5*(double)m->v->cell) continue;
                mark_nodes(m, i, a, &last, node[last.node == node[0]]);
            }
        }
    }
}

void mpm_sides_mark(const tobi_system *s, mpm_grid *g, const mpm_view *v)
{
    marking view = { s, g, v, 0 };
    if (!(v->limited & v->obeyed)) return;
    tobi_loop(s->sim->exec.threads, g->patch_count + g->patch_twins, 0, forget_marks, &view);
    tobi_loop(s->sim->exec.threads, g->block_count, 4, mark_blocks, &view);
    view.held = 1;
    if (mpm_fields_of(&s->particles)->clamp)
        tobi_loop(s->sim->exec.threads, g->block_count, 4, mark_blocks, &view);
}

/* --- particles -------------------------------------------------------------------------------------- */

/* A side is a body that stands still, or moves along itself. */
static void describe(const tobi_system *s, int side, tobi_body *b, double velocity[3])
{
    const tobi_world_def *def = &s->sim->def;
    const int kind = kind_of(s, side), a = side/2;
    *b = (tobi_body){ .rigid.kind = TOBI_PRESCRIBED, .rigid.mass = 1 };
    b->rigid.friction = kind == TOBI_WALL_SEPARATE ? def->friction : kind == TOBI_WALL_NO_SLIP ? HOLDS : 0;
    memcpy(velocity, side%2 ? def->wall_velocity_max[a] : def->wall_velocity_min[a], 3*sizeof *velocity);
}

typedef struct listing {
    tobi_contacts *c;
    const tobi_system *s;
    const tobi_contact_step *step;
    int side;
} listing;

/* Contacts of one chunk of particles, into out unless it is NULL; returns how many. */
static int64_t list_chunk(const listing *l, int64_t chunk, tobi_contact *out)
{
    const tobi_particles *p = &l->s->particles;
    const tobi_contact_step *step = l->step;
    const int a = l->side/2, upper = l->side%2;
    const double far = step->radius + step->margin, size = l->s->box.size[a], *box = l->c->chunk_box[chunk];
    int64_t n = 0;
    if ((upper ? size - box[3 + a] : box[a]) - l->c->drift > far) return 0;
    for (int64_t i = chunk*TOBI_BLOCK; i < (chunk + 1)*TOBI_BLOCK && i < p->count; i++) {
        const double *x = &p->position[i].x, height = upper ? size - x[a] : x[a];
        if (height > far || !(l->s->sim->soft.touched[p->fluid[i]] >> l->side & 1)) continue;
        n++;
        if (!out) continue;
        tobi_contact *k = out + n - 1;
        *k = (tobi_contact){ .particle = (int32_t)i, .depth = step->radius, .gap = height - step->radius };
        k->normal[a] = upper ? -1 : 1;
        k->change[a] = k->normal[a]*fmax(0, -p->velocity[i].w)*step->dt;
        memcpy(k->arm, x, sizeof k->arm);
        k->arm[a] -= k->depth*k->normal[a];
    }
    return n;
}

static void count_chunks(const void *view, int64_t begin, int64_t end)
{
    const listing *l = view;
    for (int64_t k = begin; k < end; k++) l->c->first[k] = list_chunk(l, k, NULL);
}

static void list_chunks(const void *view, int64_t begin, int64_t end)
{
    const listing *l = view;
    for (int64_t k = begin; k < end; k++) list_chunk(l, k, l->c->list + l->c->first[k]);
}

tobi_status mpm_sides_list(tobi_contacts *c, const tobi_system *s, int side, const tobi_contact_step *step,
                           tobi_body *b, tobi_error *err)
{
    const listing view = { c, s, step, side };
    const int64_t chunks = (s->particles.count + TOBI_BLOCK - 1)/TOBI_BLOCK;
    const int team = tobi_team(&s->sim->exec, chunks, 64);
    describe(s, side, b, c->velocity);
    memset(c->spin, 0, sizeof c->spin);
    tobi_loop(team, chunks, 0, count_chunks, &view);
    c->count = tobi_scan(&s->sim->exec, chunks, c->first);
    TOBI_TRY(tobi_contact_reserve(c, c->count, err));
    tobi_loop(team, chunks, 0, list_chunks, &view);
    return TOBI_OK;
}
