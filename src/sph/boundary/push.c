/* Particles that bodies have caught (docs/theory/boundaries.md, push-out). Where a particle ended says that
   it is inside, but not through which side it came: of a wing thinner than the way of a step the nearest
   side may be the far one. So the way itself, as seen from the body, is looked at too. Drawback: a body that
   turns within the step is taken to turn about the point nearest to the particle. */
#include "sph/boundary/boundary.h"
#include "sph/state.h"
#include <math.h>
#include <string.h>

/* Of the spacing: positions nearer to a body are not left. */
static const double LEAST = 0.2;
/* Blocks with caught particles that are worth waking threads for. */
enum { WORTH = 4 };

static double dot(const double a[3], const double b[3]) { return a[0]*b[0] + a[1]*b[1] + a[2]*b[2]; }

/* What a walk over the caught particles does: COUNT and WEIGH move nothing, and sum up. */
typedef enum push_walk { PUSH, COUNT, WEIGH } push_walk;

/* share: of its speed into the body, that a particle loses. */
typedef struct pusher {
    tobi_system *s;
    const tobi_body *b;
    int body;
    tobi_tree_box box;          /* a spacing around the body */
    double share;
    push_walk walk;
} pusher;

/* Where the surface touched a particle, and where that puts it. */
typedef struct touch {
    tobi_bvh_hit hit;
    double target[3];
} touch;

static const tobi_boundary_entry *entry_of(const pusher *p, int64_t i)
{
    const tobi_boundary_links *n = &sph_of(p->s)->links;
    int32_t k = sph_fields_of(&p->s->particles)->last_link[i];
    while (k >= 0 && n->link[k].body != p->body) k = n->link[k].previous;
    return k >= 0 && n->entry[k].triangle >= 0 ? &n->entry[k] : NULL;
}

/* By how much the body has turned since the particles looked at it: of a unit vector, at most. */
static double turned(const pusher *p)
{
    const double *q = sph_of(p->s)->links.bins[p->body].orientation, *r = p->b->rigid.orientation;
    const double cosine = q[0]*r[0] + q[1]*r[1] + q[2]*r[2] + q[3]*r[3];
    return 2*sqrt(fmax(1 - cosine*cosine, 0)) + 1e-6;
}

/* Where a particle began the step, as seen from the body: as far from its nearest point as then. away: it is
   at least so far from a rigid body now, m. */
static int find_start(const pusher *p, int64_t i, const double x[3], double start[3], double *away)
{
    const tobi_boundary_entry *e = entry_of(p, i);
    *away = 0;
    if (!e || !(e->distance > 0)) return 0;
    const int32_t *tri = p->b->mesh.triangles[e->triangle];
    double way[3];
    for (int a = 0; a < 3; a++) {
        start[a] = e->offset[a];
        for (int c = 0; c < 3; c++) start[a] += e->barycentric[c]*p->b->vertex[tri[c]][a];
        way[a] = x[a] - start[a];
    }
    if (!p->b->deforms) *away = e->distance*(1 - turned(p)) - sqrt(dot(way, way));
    return 4*dot(way, way) > e->distance*e->distance;      /* else it cannot have reached the surface */
}

static void place_above(const pusher *p, const double x[3], touch *t)
{
    double rise = LEAST*p->s->smoothing.spacing;
    for (int a = 0; a < 3; a++)
        t->target[a] = a < p->s->box.dimension ? t->hit.point[a] + rise*t->hit.normal[a] : x[a];
}

/* The way from start to x ends at the surface: the last point in front of it, by bisection. */
static int stop_before(const pusher *p, const double start[3], const double x[3], touch *t)
{
    double from[3], to[3], middle[3];
    tobi_bvh_hit hit;
    memcpy(from, start, sizeof from);
    memcpy(to, x, sizeof to);
    for (int k = 0; k < 20; k++) {
        for (int a = 0; a < 3; a++) middle[a] = 0.5*(from[a] + to[a]);
        memcpy(tobi_bvh_segment_hits(p->b->bvh, start, middle) ? to : from, middle, sizeof middle);
    }
    if (!tobi_bvh_closest(p->b->bvh, from, p->s->smoothing.h, &hit) || hit.signed_distance < 0) return 0;
    t->hit = hit;
    place_above(p, x, t);
    return 1;
}

/* A particle that a body has caught: where, and its speed along the normal against the body's. */
static int find_caught(const pusher *p, int64_t i, touch *t, double *along)
{
    const tobi_system *s = p->s;
    tobi_double3 q = s->particles.position[i];
    double x[3] = {q.x, q.y, q.z}, start[3], away;
    const int came = find_start(p, i, x, start, &away);
    if (away > LEAST*s->smoothing.spacing) return 0;
    int caught = tobi_bvh_closest(p->b->bvh, x, s->smoothing.h, &t->hit) &&
                 t->hit.signed_distance < LEAST*s->smoothing.spacing;
    if (caught) place_above(p, x, t);
    if (came && tobi_bvh_segment_hits(p->b->bvh, start, caught ? t->target : x))
        caught |= stop_before(p, start, caught ? t->target : x, t);
    if (!caught) return 0;
    const int32_t *tri = p->b->mesh.triangles[t->hit.triangle];
    const tobi_float4 *v = &s->particles.velocity[i];
    *along = 0;
    for (int a = 0; a < 3; a++) {
        double u = (&v->x)[a];
        for (int c = 0; c < 3; c++) u -= t->hit.barycentric[c]*p->b->vertex_velocity[tri[c]][a];
        *along += u*t->hit.normal[a];
    }
    return 1;
}

/* Counts a caught particle that would push a free body in t[0]; t[6]: by how much an impulse of its mass
   times 1 m/s changes the body's speed at that point. */
static void count_push(const pusher *p, int64_t i, const double normal[3], const double twist[3], double *t)
{
    const tobi_system *s = p->s;
    double shift[3], turn[3][3], joint[6], answer = 0;
    tobi_rigid_inverse(&p->b->rigid, shift, turn);
    tobi_joint_freedom(&p->b->rigid, joint);
    for (int a = 0; a < 3; a++) answer += shift[a]*normal[a]*normal[a] + twist[a]*dot(turn[a], twist);
    const double along = dot(joint, normal) + dot(joint + 3, twist);
    answer += along*along;
    answer *= s->smoothing.volume*s->fluid[s->particles.fluid[i]].density;
    t[0] += 1;
    t[6] = fmax(t[6], answer);
}

/* J, into t[0]: what the impulse does by a change of shape. */
static void weigh_push(const pusher *p, int64_t i, const tobi_bvh_hit *hit, double into, double *t)
{
    const tobi_system *s = p->s;
    const double mass = s->smoothing.volume*s->fluid[s->particles.fluid[i]].density;
    double flow[3];
    tobi_body_place_flow(p->b, (int32_t)hit->triangle, hit->barycentric, hit->point, flow);
    t[0] += mass*p->share*into*dot(hit->normal, flow);
}

/* Puts one particle outside; the impulse it loses goes to t[0..5]. */
static int push_particle(const pusher *p, int64_t i, double *t)
{
    touch c;
    tobi_system *s = p->s;
    double arm[3], twist[3], into;
    if (!find_caught(p, i, &c, &into)) return 0;
    for (int a = 0; a < 3; a++) arm[a] = c.hit.point[a] + p->b->lower[a] - p->b->centre[a];
    for (int a = 0; a < 3; a++) {
        int l = (a + 1)%3, r = (a + 2)%3;
        twist[a] = arm[l]*c.hit.normal[r] - arm[r]*c.hit.normal[l];
    }
    if (into < 0 && p->walk == COUNT) count_push(p, i, c.hit.normal, twist, t);
    if (into < 0 && p->walk == WEIGH) weigh_push(p, i, &c.hit, into, t);
    if (p->walk != PUSH) return 0;
    memcpy(&s->particles.position[i].x, c.target, sizeof c.target);
    if (into >= 0) return 1;
    into *= p->share;
    double mass = s->smoothing.volume*s->fluid[s->particles.fluid[i]].density;
    for (int a = 0; a < 3; a++) {
        (&s->particles.velocity[i].x)[a] -= (float)(into*c.hit.normal[a]);
        t[a] += mass*into*c.hit.normal[a];
        t[3 + a] += mass*into*twist[a];
    }
    return 1;
}

static void widen(tobi_caught_block *b, const double x[3])
{
    for (int a = 0; a < 3; a++) {
        b->lower[a] = fmin(b->lower[a], x[a]);
        b->upper[a] = fmax(b->upper[a], x[a]);
    }
}

/* Lists the particles that bodies have caught where they are: no other moves, so no other is caught later. */
static void list_caught(const void *view, int64_t begin, int64_t end, double *totals)
{
    const tobi_system *s = view;
    const tobi_boundary_links *n = &sph_of(s)->links;
    int32_t *list = n->caught + begin;
    tobi_caught_block *found = &n->caught_block[begin/TOBI_BLOCK];
    *found = (tobi_caught_block){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, -1, 0};
    (void)totals;
    for (int64_t i = begin; i < end; i++) {
        const tobi_double3 *at = &s->particles.position[i];
        const double x[3] = {at->x, at->y, at->z};
        tobi_tree_walk walk = {0, 0};
        touch c;
        double into;
        for (int k, caught = 0; !caught && (k = tobi_body_tree_next(&n->tree, x, &walk)) >= 0;) {
            const pusher p = {.b = &s->sim->bodies[k], .s = (tobi_system *)s, .body = k};
            caught = find_caught(&p, i, &c, &into);
            if (!caught) continue;
            widen(found, x);
            list[found->count++] = (int32_t)i;
        }
    }
}

static int is_outside(const pusher *p, int64_t i)
{
    const double *x = &p->s->particles.position[i].x;
    for (int a = 0; a < p->s->box.dimension; a++)
        if (x[a] < p->box.lower[a] || x[a] > p->box.upper[a]) return 1;
    return 0;
}

static int is_apart(const pusher *p, const tobi_caught_block *b)
{
    for (int a = 0; a < p->s->box.dimension; a++)
        if (b->upper[a] < p->box.lower[a] || b->lower[a] > p->box.upper[a]) return 1;
    return 0;
}

static void push_parts(const void *view, int64_t begin, int64_t end, double *totals)
{
    const pusher *p = view;
    tobi_boundary_links *n = &sph_of(p->s)->links;
    (void)totals;
    for (int64_t k = begin; k < end; k++) {
        tobi_block_sum *part = &n->part[k];
        tobi_caught_block *block = &n->caught_block[part->block];
        const int32_t *list = n->caught + part->block*TOBI_BLOCK;
        for (int32_t c = 0; c < block->count; c++) {
            const tobi_double3 *at = &p->s->particles.position[list[c]];
            if (is_outside(p, list[c]) || !push_particle(p, list[c], part->total)) continue;
            widen(block, (double[3]){at->x, at->y, at->z});
            /* All sums are taken; whole numbers add up the same in any order. */
            __atomic_fetch_add(&n->contacts, 1, __ATOMIC_RELAXED);
        }
    }
}

/* Chains the blocks in which bodies have caught particles: most have none, and each body asks for them. */
static void chain_blocks(tobi_system *s)
{
    tobi_boundary_links *n = &sph_of(s)->links;
    int64_t *link = &n->first_caught;
    for (int64_t b = 0; b*TOBI_BLOCK < s->particles.count; b++) {
        if (n->caught_block[b].count == 0) continue;
        *link = b;
        link = &n->caught_block[b].next;
    }
    *link = -1;
}

/* The totals of a launch over all particles. */
static void push_all(const pusher *p, double *t)
{
    tobi_system *s = p->s;
    tobi_boundary_links *n = &sph_of(s)->links;
    int64_t parts = 0;
    for (int64_t b = n->first_caught; b >= 0; b = n->caught_block[b].next) {
        const int32_t *list = n->caught + b*TOBI_BLOCK;
        int32_t k = is_apart(p, &n->caught_block[b]) ? n->caught_block[b].count : 0;
        while (k < n->caught_block[b].count && is_outside(p, list[k])) k++;
        if (k < n->caught_block[b].count) n->part[parts++] = (tobi_block_sum){.block = b};
    }
    if (parts < WORTH) push_parts(p, 0, parts, NULL);
    else tobi_launch_each(&s->sim->exec, TOBI_HOST(push_parts, 0, 0), p, parts, NULL);
    tobi_combine_sums(n->part, parts, t);
}

void tobi_push_out(tobi_system *s)
{
    tobi_boundary_links *n = &sph_of(s)->links;
    n->contacts = 0;
    tobi_body_tree_build(&n->tree, s->sim->bodies, s->sim->body_count, s->smoothing.spacing,
                         s->box.dimension);
    tobi_launch(&s->sim->exec, TOBI_HOST(list_caught, 0, 0), s, 0, s->particles.count, NULL);
    chain_blocks(s);
    for (int k = 0; k < s->sim->body_count; k++) {
        double t[TOBI_TOTALS];
        pusher p = {.s = s, .b = &s->sim->bodies[k], .body = k, .box = n->tree.box[k], .share = 1};
        if (p.b->rigid.kind != TOBI_PRESCRIBED) {
            p.walk = COUNT;
            push_all(&p, t);
            p.share = 1/(1 + t[0]*t[6]);     /* together they stop the body at most, never turn it round */
        }
        tobi_body_load *load = &s->sim->bodies[k].load[s->number];
        if (p.b->deforms) {
            p.walk = WEIGH;
            push_all(&p, t);
            load->shape += t[0]/s->dt;
        }
        p.walk = PUSH;
        push_all(&p, t);
        for (int a = 0; a < 6; a++) load->pressure[a] += t[a]/s->dt;
    }
}
