/* Queries and refitting. Boxes are tested four at a time in float, triangles one at a time in
   double: the boxes only decide what is looked at, so float loses nothing but a few extra looks. */
#include "geom/bvh_tree.h"
#include "exec/exec.h"
#include "geom/vec3.h"
#include <string.h>

typedef float float4 __attribute__((vector_size(16)));
typedef int32_t int4 __attribute__((vector_size(16)));

#define BOX_PADDING 1e-6     /* of the whole box: far above float rounding of nearby points          */
#define FAR_SLACK 0.99999f   /* on squared box distances: float rounding of far points               */

/* --- refitting ---------------------------------------------------------------------------- */

enum { FEW = 4096 };     /* triangles or vertices that one thread measures sooner than several wake */

typedef struct measuring { tobi_bvh *b; const double (*vertices)[3]; } measuring;

static void measure_faces(const void *view, int64_t begin, int64_t end)
{
    tobi_bvh *b = ((const measuring *)view)->b;
    const double (*vertices)[3] = ((const measuring *)view)->vertices;
    for (int64_t t = begin; t < end; t++) {
        double e[3][3], n[3];    /* edges 01, 12, 20 */
        for (int k = 0; k < 3; k++)
            vec3_sub(e[k], vertices[b->triangles[t][(k + 1) % 3]], vertices[b->triangles[t][k]]);
        vec3_cross(n, e[0], e[1]);
        double twice_area = vec3_length(n);
        for (int k = 0; k < 3; k++) {
            /* corner k lies between edge k and the reverse of edge k - 1 */
            b->corner_angle[t][k] = atan2(twice_area, -vec3_dot(e[k], e[(k + 2) % 3]));
            b->face_normal[t][k] = n[k];
        }
        double longest2 = fmax(vec3_dot(e[0], e[0]), fmax(vec3_dot(e[1], e[1]), vec3_dot(e[2], e[2])));
        if (twice_area <= 1e-14*longest2) memset(b->face_normal[t], 0, sizeof b->face_normal[t]);
        vec3_normalize(b->face_normal[t]);
    }
}

static void measure_edges(const void *view, int64_t begin, int64_t end)
{
    tobi_bvh *b = ((const measuring *)view)->b;
    for (int64_t t = begin; t < end; t++)
        for (int k = 0; k < 3; k++) {
            static const double none[3] = {0, 0, 0};
            int32_t twin = b->opposite[t][k];
            const double *other = twin < 0 ? none : b->face_normal[twin/3];
            vec3_add_scaled(b->edge_normal[t][k], b->face_normal[t], 1, other);
            vec3_normalize(b->edge_normal[t][k]);
        }
}

static void measure_vertices(const void *view, int64_t begin, int64_t end)
{
    tobi_bvh *b = ((const measuring *)view)->b;
    for (int64_t v = begin; v < end; v++) {
        double n[3] = {0, 0, 0};
        for (int64_t i = b->corner_start[v]; i < b->corner_start[v + 1]; i++) {
            int32_t corner = b->corner_list[i];
            vec3_add_scaled(n, n, b->corner_angle[corner/3][corner % 3], b->face_normal[corner/3]);
        }
        vec3_normalize(n);
        memcpy(b->vertex_normal[v], n, sizeof n);
    }
}

static void place_corners(tobi_bvh *b, const double (*vertices)[3])
{
    for (int64_t i = 0; i < b->triangle_count; i++) {
        const int32_t *t = b->triangles[b->leaf_triangle[i]];
        memcpy(b->corners[i].a, vertices[t[0]], sizeof b->corners[i].a);
        memcpy(b->corners[i].b, vertices[t[1]], sizeof b->corners[i].b);
        memcpy(b->corners[i].c, vertices[t[2]], sizeof b->corners[i].c);
    }
}

static void box_leaf(const tobi_bvh *b, int32_t first, int32_t count, double box[6])
{
    for (int k = 0; k < 3; k++) {
        box[k] = INFINITY;
        box[3 + k] = -INFINITY;
        for (int32_t i = first; i < first + count; i++) {
            const bvh_corners *t = &b->corners[i];
            double low = t->a[k] < t->b[k] ? t->a[k] : t->b[k];
            double high = t->a[k] < t->b[k] ? t->b[k] : t->a[k];
            if (t->c[k] < low) low = t->c[k];
            if (t->c[k] > high) high = t->c[k];
            if (low < box[k]) box[k] = low;
            if (high > box[3 + k]) box[3 + k] = high;
        }
    }
}

/* Writes one lane's float box around a double one. */
static void set_lane(const tobi_bvh *b, bvh_node *node, int lane, const double box[6], double padding)
{
    for (int k = 0; k < 3; k++) {
        node->centre[k][lane] = (float)(0.5*(box[k] + box[3 + k]) - b->origin[k]);
        node->half[k][lane] = (float)(0.5*(box[3 + k] - box[k]) + padding);
    }
}

void tobi_bvh_refit(tobi_bvh *b, const double (*vertices)[3])
{
    double box[6], size = 0;
    place_corners(b, vertices);
    const measuring view = {b, vertices};
    const int threads = b->triangle_count > FEW ? 0 : 1;
    tobi_loop(threads, b->triangle_count, 0, measure_faces, &view);
    tobi_loop(threads, b->triangle_count, 0, measure_edges, &view);
    tobi_loop(b->vertex_count > FEW ? 0 : 1, b->vertex_count, 0, measure_vertices, &view);
    box_leaf(b, 0, (int32_t)b->triangle_count, box);
    for (int k = 0; k < 3; k++) {
        b->min[k] = box[k];
        b->max[k] = box[3 + k];
        b->origin[k] = 0.5*(box[k] + box[3 + k]);
        size = fmax(size, box[3 + k] - box[k]);
    }
    for (int64_t i = b->node_count - 1; i >= 0; i--) {
        bvh_node *node = &b->nodes[i];
        double *whole = b->node_box[i];
        for (int k = 0; k < 6; k++) whole[k] = k < 3 ? INFINITY : -INFINITY;
        for (int lane = 0; lane < BVH_WIDTH; lane++) {
            if (node->child[lane] < 0) {
                for (int k = 0; k < 3; k++) {
                    node->centre[k][lane] = 0;
                    node->half[k][lane] = -INFINITY;
                }
                continue;
            }
            if (node->count[lane]) box_leaf(b, node->child[lane], node->count[lane], box);
            else memcpy(box, b->node_box[node->child[lane]], sizeof box);
            set_lane(b, node, lane, box, BOX_PADDING*size);
            for (int k = 0; k < 3; k++) {
                whole[k] = fmin(whole[k], box[k]);
                whole[3 + k] = fmax(whole[3 + k], box[3 + k]);
            }
        }
    }
}

void tobi_bvh_box(const tobi_bvh *b, double min[3], double max[3])
{
    memcpy(min, b->min, sizeof b->min);
    memcpy(max, b->max, sizeof b->max);
}

/* --- closest point ------------------------------------------------------------------------ */

enum feature { ON_FACE = 0, ON_EDGE = 1, ON_CORNER = 4 };   /* + edge or corner 0 to 2 */

typedef struct nearest {
    double distance2, v, w;     /* barycentrics of corners b and c */
    double others2;             /* of the nearest of all other triangles that were looked at */
    int32_t slot;
    int feature;
} nearest;

/* The nearest point of a triangle by the Voronoi regions of its features (Ericson, Real-Time
   Collision Detection, 5.1.5). */
static inline void visit_triangle(const bvh_corners *t, const double p[3], int32_t slot, nearest *best)
{
    double ab[3], ac[3], ap[3], bp[3], cp[3], v, w;
    int feature;
    vec3_sub(ab, t->b, t->a);
    vec3_sub(ac, t->c, t->a);
    vec3_sub(ap, p, t->a);
    double d1 = vec3_dot(ab, ap), d2 = vec3_dot(ac, ap);
    vec3_sub(bp, p, t->b);
    double d3 = vec3_dot(ab, bp), d4 = vec3_dot(ac, bp);
    vec3_sub(cp, p, t->c);
    double d5 = vec3_dot(ab, cp), d6 = vec3_dot(ac, cp);
    double va = d3*d6 - d5*d4, vb = d5*d2 - d1*d6, vc = d1*d4 - d3*d2;
    if (d1 <= 0 && d2 <= 0) {
        v = w = 0;
        feature = ON_CORNER;
    } else if (d3 >= 0 && d4 <= d3) {
        v = 1;
        w = 0;
        feature = ON_CORNER + 1;
    } else if (d6 >= 0 && d5 <= d6) {
        v = 0;
        w = 1;
        feature = ON_CORNER + 2;
    } else if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        v = d1/(d1 - d3);
        w = 0;
        feature = ON_EDGE;
    } else if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        v = 0;
        w = d2/(d2 - d6);
        feature = ON_EDGE + 2;
    } else if (va <= 0 && d4 >= d3 && d5 >= d6) {
        w = (d4 - d3)/((d4 - d3) + (d5 - d6));
        v = 1 - w;
        feature = ON_EDGE + 1;
    } else {
        double scale = 1/(va + vb + vc);
        v = vb*scale;
        w = vc*scale;
        feature = ON_FACE;
    }
    double q[3] = {ap[0] - v*ab[0] - w*ac[0], ap[1] - v*ab[1] - w*ac[1], ap[2] - v*ab[2] - w*ac[2]};
    double distance2 = vec3_dot(q, q);
    if (distance2 < best->distance2)
        *best = (nearest){distance2, v, w, best->distance2, slot, feature};
    else if (distance2 < best->others2) best->others2 = distance2;
}

typedef struct stacked {
    float distance2;
    int32_t child, count;
} stacked;

static inline float4 load4(const float *x)
{
    float4 v;
    memcpy(&v, x, sizeof v);
    return v;
}

static inline float4 magnitude(float4 x)
{
    return (float4)((int4)x & (int4){INT32_MAX, INT32_MAX, INT32_MAX, INT32_MAX});
}

/* Squared distances from p (relative to the origin) to the four boxes; from below. */
static inline void measure_boxes(const bvh_node *node, const float p[3], float out[BVH_WIDTH])
{
    float4 sum = {0, 0, 0, 0};
    for (int k = 0; k < 3; k++) {
        float4 d = magnitude(p[k] - load4(node->centre[k])) - load4(node->half[k]);
        d = d + magnitude(d);       /* twice the positive part */
        sum += d*d;
    }
    sum *= 0.25f*FAR_SLACK;
    memcpy(out, &sum, sizeof sum);
}

/* Pushes the children nearer than limit2, the nearest on top. */
static inline int push_children(const bvh_node *node, const float p[3], double limit2, stacked *stack,
                                int top)
{
    float d2[BVH_WIDTH];
    measure_boxes(node, p, d2);
    int base = top;
    for (int i = 0; i < BVH_WIDTH; i++) {
        if (!(d2[i] < limit2)) continue;
        int j = top++;
        for (; j > base && stack[j - 1].distance2 < d2[i]; j--) stack[j] = stack[j - 1];
        stack[j] = (stacked){d2[i], node->child[i], node->count[i]};
    }
    return top;
}

/* two: 1 looks for the second nearest as well. */
static inline int find_nearest(const tobi_bvh *b, const double p[3], double max_distance, int two,
                               nearest *best)
{
    stacked stack[BVH_STACK];
    float local[3];
    const double *limit2 = two ? &best->others2 : &best->distance2;
    *best = (nearest){.distance2 = max_distance*max_distance, .slot = -1};
    best->others2 = best->distance2;
    for (int k = 0; k < 3; k++) local[k] = (float)(p[k] - b->origin[k]);
    int top = push_children(&b->nodes[0], local, *limit2, stack, 0);
    while (top) {
        stacked next = stack[--top];
        if (next.distance2 >= *limit2) continue;
        if (next.count == 0) {
            top = push_children(&b->nodes[next.child], local, *limit2, stack, top);
            continue;
        }
        for (int32_t i = next.child; i < next.child + next.count; i++)
            visit_triangle(&b->corners[i], p, i, best);
    }
    return best->slot >= 0;
}

static const double *feature_normal(const tobi_bvh *b, int32_t triangle, int feature)
{
    if (feature >= ON_CORNER) return b->vertex_normal[b->triangles[triangle][feature - ON_CORNER]];
    if (feature >= ON_EDGE) return b->edge_normal[triangle][feature - ON_EDGE];
    return b->face_normal[triangle];
}

static void describe(const tobi_bvh *b, const double p[3], const nearest *best, tobi_bvh_hit *hit)
{
    double away[3];
    const bvh_corners *t = &b->corners[best->slot];
    double u = 1 - best->v - best->w;
    hit->slot = best->slot;
    hit->triangle = b->leaf_triangle[best->slot];
    for (int k = 0; k < 3; k++) hit->point[k] = u*t->a[k] + best->v*t->b[k] + best->w*t->c[k];
    memcpy(hit->barycentric, (double[3]){u, best->v, best->w}, sizeof hit->barycentric);
    memcpy(hit->normal, feature_normal(b, hit->triangle, best->feature), sizeof hit->normal);
    hit->distance = sqrt(best->distance2);
    vec3_sub(away, p, hit->point);
    int inside = b->by_winding ? tobi_bvh_winding(b, p) > 0 : vec3_dot(away, hit->normal) < 0;
    hit->signed_distance = inside ? -hit->distance : hit->distance;
}

int tobi_bvh_closest(const tobi_bvh *b, const double p[3], double max_distance, tobi_bvh_hit *hit)
{
    nearest best;
    if (!find_nearest(b, p, max_distance, 0, &best)) return 0;
    describe(b, p, &best, hit);
    return 1;
}

int tobi_bvh_closest_two(const tobi_bvh *b, const double p[3], double max_distance, tobi_bvh_hit *hit,
                         double *others)
{
    nearest best;
    if (!find_nearest(b, p, max_distance, 1, &best)) return 0;
    describe(b, p, &best, hit);
    *others = sqrt(best.others2);
    return 1;
}

void tobi_bvh_closest_again(const tobi_bvh *b, const double p[3], tobi_bvh_hit *hit)
{
    nearest best = {.distance2 = INFINITY};
    visit_triangle(&b->corners[hit->slot], p, hit->slot, &best);
    describe(b, p, &best, hit);
}

int tobi_bvh_inside(const tobi_bvh *b, const double p[3])
{
    for (int k = 0; k < 3; k++)
        if (!(p[k] >= b->min[k] && p[k] <= b->max[k])) return 0;
    if (b->by_winding) return tobi_bvh_winding(b, p) > 0;
    tobi_bvh_hit hit;
    return tobi_bvh_closest(b, p, INFINITY, &hit) && hit.signed_distance < 0;
}

/* --- crossing ----------------------------------------------------------------------------- */

/* A segment seen along itself: axis[2] is the longest component of its direction, shear what the
   other two gain per unit of it. */
typedef struct sight {
    const double *from, *to;
    double shear[2];
    int axis[3];
} sight;

/* 0 if the segment has no length. */
static int aim(sight *s, const double from[3], const double to[3])
{
    double d[3];
    vec3_sub(d, to, from);
    int k = fabs(d[0]) > fabs(d[1]) ? 0 : 1;
    if (fabs(d[2]) > fabs(d[k])) k = 2;
    *s = (sight){from, to, {d[(k + 1) % 3]/d[k], d[(k + 2) % 3]/d[k]}, {(k + 1) % 3, (k + 2) % 3, k}};
    return d[k] != 0;
}

/* Where a vertex is in the plane across the line of sight; the same numbers whichever triangle asks. */
static inline void project(const sight *s, const double vertex[3], double out[2])
{
    double depth = vertex[s->axis[2]] - s->from[s->axis[2]];
    out[0] = vertex[s->axis[0]] - s->from[s->axis[0]] - s->shear[0]*depth;
    out[1] = vertex[s->axis[1]] - s->from[s->axis[1]] - s->shear[1]*depth;
}

/* The line meets the triangle, edges included, if it lies on one side of all three projected edges
   (Woop, Benthin & Wald, JCGT 2 (2013)). Rounding is monotonic, so the difference of two products
   has the right sign or is 0, and 0 counts as met: nothing slips between neighbours. Needs products
   that are not contracted into fused operations. 1 where the segment enters, -1 where it leaves, 0 else. */
static int crosses(const bvh_corners *t, const sight *s)
{
    double a[2], b[2], c[2], ab[3], ac[3], n[3], u[3], v[3];
    project(s, t->a, a);
    project(s, t->b, b);
    project(s, t->c, c);
    double e0 = b[0]*c[1] - b[1]*c[0], e1 = c[0]*a[1] - c[1]*a[0], e2 = a[0]*b[1] - a[1]*b[0];
    if (!((e0 >= 0 && e1 >= 0 && e2 >= 0) || (e0 <= 0 && e1 <= 0 && e2 <= 0))) return 0;
    vec3_sub(ab, t->b, t->a);
    vec3_sub(ac, t->c, t->a);
    vec3_cross(n, ab, ac);
    vec3_sub(u, t->a, s->from);
    vec3_sub(v, t->a, s->to);
    double before = vec3_dot(n, u), behind = vec3_dot(n, v);
    return (before < 0 && behind > 0) - (before > 0 && behind < 0);
}

/* Bit per lane: may the segment with middle m, half vector h and |h| touch the box? Separating axes:
   the three coordinate axes and the three cross products with the segment. */
static inline int touch_boxes(const bvh_node *node, const float m[3], const float h[3], const float size[3])
{
    float4 c[3], e[3];
    int4 apart = {0, 0, 0, 0};
    for (int k = 0; k < 3; k++) {
        c[k] = m[k] - load4(node->centre[k]);
        e[k] = load4(node->half[k]);
        apart |= magnitude(c[k]) > e[k] + size[k];
    }
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        /* widened: the left side may lose digits when the terms cancel */
        float4 bound = e[i]*size[j] + e[j]*size[i];
        float4 noise = (magnitude(c[i])*size[j] + magnitude(c[j])*size[i])*1e-6f;
        apart |= magnitude(c[i]*h[j] - c[j]*h[i]) > bound + noise;
    }
    return (apart[0] ? 0 : 1) | (apart[1] ? 0 : 2) | (apart[2] ? 0 : 4) | (apart[3] ? 0 : 8);
}

/* What a segment that meets a triangle makes of it, turn as from crosses; nonzero ends the walk. */
typedef int crossing_fn(void *user, int32_t triangle, int turn);

static inline int walk_segment(const tobi_bvh *b, const double p[3], const double q[3], crossing_fn *visit,
                               void *user)
{
    int32_t stack[BVH_STACK];
    int top = 0;
    sight line;
    float m[3], h[3], size[3];
    if (!aim(&line, p, q)) return 0;
    for (int k = 0; k < 3; k++) {
        m[k] = (float)(0.5*(p[k] + q[k]) - b->origin[k]);
        h[k] = (float)(0.5*(q[k] - p[k]));
        size[k] = fabsf(h[k])*1.00001f + fabsf(m[k])*1e-6f;
    }
    stack[top++] = 0;
    while (top) {
        const bvh_node *node = &b->nodes[stack[--top]];
        int mask = touch_boxes(node, m, h, size);
        for (int lane = 0; lane < BVH_WIDTH; lane++) {
            if (!(mask >> lane & 1) || node->child[lane] < 0) continue;
            if (node->count[lane] == 0) stack[top++] = node->child[lane];
            for (int32_t i = node->child[lane]; i < node->child[lane] + node->count[lane]; i++) {
                const int turn = crosses(&b->corners[i], &line);
                if (turn && visit(user, b->leaf_triangle[i], turn)) return 1;
            }
        }
    }
    return 0;
}

static int stop_at_first(void *user, int32_t triangle, int turn)
{
    (void)user;
    (void)triangle;
    (void)turn;
    return 1;
}

int tobi_bvh_segment_hits(const tobi_bvh *b, const double p[3], const double q[3])
{
    return walk_segment(b, p, q, stop_at_first, NULL);
}

/* The faces that a segment enters and leaves by. */
enum { MOST_FACES = 8 };
typedef struct passage {
    const tobi_bvh *b;
    double cosine;
    int count[2];
    const double *normal[2][MOST_FACES];
} passage;

/* Stops at two faces that look away from each other, and where there are more than can be kept. */
static int add_face(void *user, int32_t triangle, int turn)
{
    passage *p = user;
    const int leaves = turn < 0;
    const double *n = p->b->face_normal[triangle];
    for (int k = 0; k < p->count[!leaves]; k++)
        if (vec3_dot(n, p->normal[!leaves][k]) < p->cosine) return 1;
    if (p->count[leaves] == MOST_FACES) return 1;
    p->normal[leaves][p->count[leaves]++] = n;
    return 0;
}

int tobi_bvh_segment_passes(const tobi_bvh *b, const double p[3], const double q[3],
                            const double normal_p[3], const double normal_q[3], double cosine)
{
    passage faces = {.b = b, .cosine = cosine};
    if (walk_segment(b, p, q, add_face, &faces)) return 1;
    if ((faces.count[0] > 0) == (faces.count[1] > 0)) return 0;
    const int leaves = faces.count[1] > 0;
    const double *end = leaves ? normal_p : normal_q;
    for (int k = 0; k < faces.count[leaves]; k++)
        if (vec3_dot(end, faces.normal[leaves][k]) < cosine) return 1;
    return 0;
}

/* --- outline ------------------------------------------------------------------------------ */

/* How far the corners of a triangle rise above the plane at most. */
static double rise_of(const bvh_corners *t, const double p[3], const double n[3])
{
    const double *x[3] = {t->a, t->b, t->c};
    double most = -INFINITY, r[3];
    for (int k = 0; k < 3; k++) {
        vec3_sub(r, x[k], p);
        most = fmax(most, vec3_dot(r, n));
    }
    return most;
}

int tobi_bvh_rises_above(const tobi_bvh *b, const double p[3], const double n[3], double height)
{
    int32_t stack[BVH_STACK];
    int top = 0;
    stack[top++] = 0;
    while (top) {
        const bvh_node *node = &b->nodes[stack[--top]];
        for (int lane = 0; lane < BVH_WIDTH; lane++) {
            double rise = 0;
            if (node->child[lane] < 0) continue;
            for (int k = 0; k < 3; k++)
                rise += n[k]*(node->centre[k][lane] + b->origin[k] - p[k]) + fabs(n[k])*node->half[k][lane];
            if (!(rise > height)) continue;
            if (node->count[lane] == 0) stack[top++] = node->child[lane];
            for (int32_t i = node->child[lane]; i < node->child[lane] + node->count[lane]; i++)
                if (rise_of(&b->corners[i], p, n) > height) return 1;
        }
    }
    return 0;
}
