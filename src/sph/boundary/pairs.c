/* Neighbours near bodies: pairs that a body separates leave the neighbour list, those that are one past a
   blunt edge stay, and particles near a body or next to one that is are marked. Most pairs are farther from
   bodies than from each other, or see each other past a convex body, and only the rest asks for the mesh,
   once for both ends (decision 94). Drawback: what one end found, the other looks for in the list of the
   first. */
#include "sph/boundary/boundary.h"
#include "sph/state.h"
#include <math.h>
#include <string.h>

/* Cosine between the normals of the two faces of an edge of 75 degrees. Past a blunter one, of a body that
   has no thin parts, particles stay neighbours: the way around it is little longer, and without them the
   sums miss what is neither body nor seen (decision 93). */
static const double BLUNT = -0.25;

static double dot(const double a[3], const double b[3]) { return a[0]*b[0] + a[1]*b[1] + a[2]*b[2]; }

/* From j to i, in fixed point. */
static void subtract(const tobi_system *s, int64_t i, int64_t j, int32_t d[3])
{
    const tobi_record *a = &s->cells.record[i], *b = &s->cells.record[j];
    d[0] = (int32_t)((uint32_t)a->x - (uint32_t)b->x);
    d[1] = (int32_t)((uint32_t)a->y - (uint32_t)b->y);
    d[2] = (int32_t)((uint32_t)a->z - (uint32_t)b->z);
}

/* Is a place above the plane across the way from the nearest point of a convex body to a particle? Then the
   two see each other. What rounding leaves of a way is none. */
static int is_above(const tobi_system *s, const tobi_boundary_entry *e, const double from_foot[3])
{
    const double clear = 0.01*s->smoothing.spacing;
    return e->distance > clear && dot(from_foot, e->offset) > clear*e->distance;
}

/* Whether a body that i sees may hide the place at x_i - d from it. */
static int may_hide(const tobi_system *s, int64_t i, const double d[3])
{
    const tobi_boundary_links *n = &sph_of(s)->links;
    const double size = 1.01*sqrt(dot(d, d));
    for (int32_t k = sph_fields_of(&s->particles)->last_link[i]; k >= 0; k = n->link[k].previous) {
        const tobi_boundary_entry *e = &n->entry[k];
        const double from_foot[3] = {e->offset[0] - d[0], e->offset[1] - d[1], e->offset[2] - d[2]};
        if (n->link[k].distance > size) continue;
        if (!s->sim->bodies[n->link[k].body].convex || !is_above(s, e, from_foot)) return 1;
    }
    return 0;
}

/* A body between two particles is not farther from both together than they are from each other. */
static int may_separate(const tobi_system *s, int64_t i, int64_t j)
{
    const float *body_distance = sph_fields_of(&s->particles)->body_distance;
    double square = 0, d[3];
    int32_t fixed[3];
    const double least = (double)body_distance[i] + body_distance[j];
    if (least > 1.001*s->smoothing.h) return 0;
    subtract(s, i, j, fixed);
    for (int a = 0; a < 3; a++) {
        d[a] = fixed[a]*(double)s->box.from_fixed[a];
        square += d[a]*d[a];
    }
    return least*least < 1.001*square && may_hide(s, i, d);
}

/* Does the body lie between x and to, as its entries of the particles there have it? */
static int lies_between(const tobi_system *s, const tobi_body *body, const tobi_boundary_entry *a,
                        const tobi_boundary_entry *b, const double x[3], const double d[3])
{
    double to[3], ra[3], rb[3];
    if (fabs(a->distance) + fabs(b->distance) >= sqrt(dot(d, d))) return 0;
    for (int c = 0; c < 3; c++) {
        to[c] = x[c] - d[c];
        ra[c] = to[c] - a->foot[c];
        rb[c] = to[c] + d[c] - b->foot[c];
    }
    if (dot(ra, a->foot_normal) >= 0 && dot(rb, b->foot_normal) >= 0) return 0;
    if (body->convex && (is_above(s, a, ra) || is_above(s, b, rb))) return 0;
    if (!body->thick || !sph_of(s)->past_edges) return tobi_bvh_segment_hits(body->bvh, x, to);
    return tobi_bvh_segment_passes(body->bvh, x, to, a->foot_normal, b->foot_normal, BLUNT);
}

/* Does a body lie between i and its neighbour at x_i - d? Both ends answer alike: the lower id asks, or
   rounding would let a segment through an edge pass one way only. */
static int separated(const tobi_system *s, int64_t i, int64_t j)
{
    const tobi_particles *p = &s->particles;
    if (p->id[i] > p->id[j]) { int64_t swap = i; i = j; j = swap; }
    const int32_t *last_link = sph_fields_of(p)->last_link;
    const tobi_boundary_links *n = &sph_of(s)->links;
    const double x[3] = {p->position[i].x, p->position[i].y, p->position[i].z};
    int32_t fixed[3];
    double d[3];
    subtract(s, i, j, fixed);
    for (int c = 0; c < 3; c++) d[c] = fixed[c]/s->box.to_fixed[c];
    const float length = 1.001F*(float)sqrt(dot(d, d));
    for (int32_t a = last_link[i]; a >= 0; a = n->link[a].previous)
        for (int32_t b = last_link[j]; b >= 0; b = n->link[b].previous) {
            const int body = n->link[a].body;
            if (body != n->link[b].body || n->link[a].distance + n->link[b].distance > length) continue;
            if (lies_between(s, &s->sim->bodies[body], &n->entry[a], &n->entry[b], x, d)) return 1;
        }
    return 0;
}

static void find_distances(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_fields *f = sph_fields_of(&s->particles);
    const tobi_boundary_links *n = &sph_of(s)->links;
    for (int64_t i = begin; i < end; i++) {
        float least = INFINITY;
        for (int32_t k = f->last_link[i]; k >= 0; k = n->link[k].previous)
            least = fminf(least, n->link[k].distance);
        f->body_distance[i] = least;
    }
}

/* What a pair at that distance adds to the trace of the moments, by the dimension. */
static double trace_of_pair(const tobi_smoothing_constants *c, const int32_t fixed[3],
                            const double to_fixed[3])
{
    double square = 0;
    for (int a = 0; a < c->dimension; a++) {
        const double d = fixed[a]/to_fixed[a];
        square += d*d;
    }
    return c->volume*c->slope_correction*tobi_smoothing_f(c->shape, c->dimension, c->h, sqrt(square))*square/
           c->dimension;
}

/* Marks of pairs that a body separates, a bit for each place of the list of row i, a byte for each group. */
static uint8_t *marks_of(const tobi_system *s, int64_t i)
{
    return sph_of(s)->links.cut_mark + s->cells.list_start[i];
}

static int has_mark(const tobi_system *s, int64_t i, int k)
{
    return __atomic_load_n(&marks_of(s, i)[k/8], __ATOMIC_RELAXED) >> k%8 & 1;
}

/* Marks of a row are its own: others only read them. */
static void set_mark(const tobi_system *s, int64_t i, int k)
{
    uint8_t *mark = &marks_of(s, i)[k/8];
    __atomic_store_n(mark, (uint8_t)(*mark | 1 << k%8), __ATOMIC_RELAXED);
}

/* The particle's last link if k is that: particles are visited by their last links, once each. */
static tobi_boundary_link *last_of(const tobi_system *s, int64_t k)
{
    tobi_boundary_link *l = &sph_of(s)->links.link[k];
    return sph_fields_of(&s->particles)->last_link[l->particle] == k ? l : NULL;
}

/* What may hide neighbours from i; 0: more bodies than there is room for. */
static int find_hiding(const tobi_system *s, int64_t i, tobi_hiding *v)
{
    const tobi_boundary_links *n = &sph_of(s)->links;
    const double clear = 0.01*s->smoothing.spacing;
    v->bodies = 0;
    for (int32_t k = sph_fields_of(&s->particles)->last_link[i]; k >= 0; k = n->link[k].previous) {
        const tobi_boundary_entry *e = &n->entry[k];
        const int above = s->sim->bodies[n->link[k].body].convex && e->distance > clear;
        if (v->bodies == TOBI_HIDING_MOST) return 0;
        v->distance[v->bodies] = n->link[k].distance;
        for (int a = 0; a < 3; a++) v->offset[v->bodies][a] = (float)e->offset[a];
        v->least[v->bodies++] = above ? (float)(clear*e->distance) : INFINITY;
    }
    return 1;
}

/* Marks pairs that a body separates, where they stand in the list of the lower row. */
static void ask_pairs(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_fields *f = sph_fields_of(&s->particles);
    const tobi_look_loops *loops = sph_of(s)->links.loops;
    tobi_hiding v = { .record = s->cells.record, .from_fixed = s->box.from_fixed,
                      .body_distance = f->body_distance, .h = (float)s->smoothing.h };
    for (int64_t k = begin; k < end; k++) {
        tobi_boundary_link *own = last_of(s, k);
        if (!own) continue;
        const int32_t i = own->particle;
        int32_t unpacked[TOBI_LIST_LIMIT];
        int count;
        const int32_t *list = tobi_cells_neighbors(&s->cells, i, &count, unpacked);
        const int few = find_hiding(s, i, &v);
        memset(marks_of(s, i), 0, (size_t)count/8);
        for (int g = 0; g < count; g += 8)
            for (unsigned left = few ? loops->may_hide(&v, i, list + g) : 0xFF; left; left &= left - 1) {
                const int at = g + tobi_lowest_bit(left);
                const int32_t j = list[at];
                if (j <= i || !may_separate(s, i, j) || !separated(s, i, j)) continue;
                set_mark(s, i, at);
                __atomic_store_n(&own->cut, 1, __ATOMIC_RELAXED);
                __atomic_store_n(&sph_of(s)->links.link[f->last_link[j]].cut, 1, __ATOMIC_RELAXED);
            }
    }
}

static int is_marked(const tobi_system *s, int32_t i, int32_t j)
{
    const int32_t k = sph_fields_of(&s->particles)->last_link[i];
    int32_t unpacked[TOBI_LIST_LIMIT];
    int count;
    if (k < 0 || !sph_of(s)->links.link[k].cut) return 0;
    const int32_t *list = tobi_cells_neighbors(&s->cells, i, &count, unpacked);
    for (int g = 0; g < count; g++)
        if (list[g] == j) return has_mark(s, i, g);
    return 0;
}

/* The list of the particle i whose last link is k, where there are pairs to cut; else of no length. */
static const int32_t *list_to_cut(const tobi_system *s, int64_t k, int32_t *i, int *count,
                                  int32_t unpacked[TOBI_LIST_LIMIT])
{
    const tobi_boundary_link *own = last_of(s, k);
    *count = 0;
    if (!own || !own->cut) return NULL;
    *i = own->particle;
    return tobi_cells_neighbors(&s->cells, *i, count, unpacked);
}

/* Marks them in the list of the higher row, too. */
static void answer_pairs(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    for (int64_t k = begin; k < end; k++) {
        int32_t i, unpacked[TOBI_LIST_LIMIT];
        int count;
        const int32_t *list = list_to_cut(s, k, &i, &count, unpacked);
        for (int g = 0; g < count; g++)
            if (list[g] < i && is_marked(s, list[g], i)) set_mark(s, i, g);
    }
}

static void cut_pairs(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    tobi_boundary_links *n = &sph_of(s)->links;
    int64_t cut = 0;
    for (int64_t k = begin; k < end; k++) {
        int32_t i, unpacked[TOBI_LIST_LIMIT];
        int count;
        const int32_t *list = list_to_cut(s, k, &i, &count, unpacked);
        for (int g = 0; g < count; g++) {
            if (!has_mark(s, i, g)) continue;
            int32_t fixed[3];
            subtract(s, i, list[g], fixed);
            n->entry[k].hidden += trace_of_pair(&s->smoothing, fixed, s->box.to_fixed);
            tobi_cells_cut(&s->cells, i, g);
            cut++;
        }
    }
    __atomic_fetch_add(&n->cut_pairs, cut, __ATOMIC_RELAXED);      /* whole: any order gives the same */
}

tobi_status tobi_boundary_cut_pairs(tobi_system *s, tobi_error *err)
{
    tobi_boundary_links *n = &sph_of(s)->links;
    const int threads = s->sim->exec.threads;
    TOBI_TRY(tobi_boundary_grow(&n->cut_mark, &n->mark_capacity, s->cells.list_used/8, err));
    tobi_loop(threads, s->particles.count, 0, find_distances, s);
    n->cut_pairs = 0;
    tobi_loop(threads, n->count, 64, ask_pairs, s);
    tobi_loop(threads, n->count, 512, answer_pairs, s);
    tobi_loop(threads, n->count, 512, cut_pairs, s);
    n->cut_pairs /= 2;      /* each was seen from both sides */
    return TOBI_OK;
}

static void mark_near_body(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    uint8_t *near_body = sph_fields_of(&s->particles)->near_body;
    for (int64_t k = begin; k < end; k++) {
        const tobi_boundary_link *own = last_of(s, k);
        if (!own) continue;
        int32_t unpacked[TOBI_LIST_LIMIT];
        int count;
        const int32_t *list = tobi_cells_neighbors(&s->cells, own->particle, &count, unpacked);
        for (int g = 0; g < count; g++) __atomic_store_n(&near_body[list[g]], 1, __ATOMIC_RELAXED);
        __atomic_store_n(&near_body[own->particle], 1, __ATOMIC_RELAXED);
    }
}

void tobi_boundary_mark_near_body(tobi_system *s)
{
    uint8_t *near_body = sph_fields_of(&s->particles)->near_body;
    if (!near_body) return;
    memset(near_body, 0, (size_t)s->particles.count);
    tobi_loop(s->sim->exec.threads, sph_of(s)->links.count, 0, mark_near_body, s);
}
