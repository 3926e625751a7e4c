/* Narrow phase. All of a pair is done in the axes where b's tree stands, those of its rest, or the domain's
   if b deforms; a's corners, edges and faces are brought there. A corner meets a face if its neighbours all
   lie behind it as seen from the face, and two edges meet if the normal across both lies between the faces
   at either (the Gauss map of a Minkowski sum); so no closest feature has to be guessed, and a stack of
   equal boxes has vertical normals only. */
#include "rigid/touch.h"
#include "geom/vec3.h"
#include <stdlib.h>
#include <string.h>

#define BEHIND 0.05        /* rad: a neighbour this far before the face still counts as behind it        */
#define BETWEEN 0.02       /* of the cosine: as far outside of the two faces of an edge still is between */
#define SKEW 0.004         /* sine of the angle between edges below which they count as parallel         */
#define EDGE_BAND 0.004    /* of the reach: how far beside a face a corner still rests on it; at SKEW two
                              equal faces overhang by half of that                                       */
#define SLOP 0.005         /* of the thickness                                                           */

enum { CORNER_FACE = 1, FACE_CORNER = 2, EDGE_EDGE = 3, BALL = 4, SIDE = 5, KIND_SHIFT = 60, HALF = 30 };

/* In 2-D a body stands for its section, which must be the same at every height. */
static int is_prism(const tobi_body *b)
{
    for (int64_t t = 0; t < b->mesh.triangle_count; t++) {
        double u[3], w[3], n[3];
        const int32_t *c = b->mesh.triangles[t];
        vec3_sub(u, b->mesh.vertices[c[1]], b->mesh.vertices[c[0]]);
        vec3_sub(w, b->mesh.vertices[c[2]], b->mesh.vertices[c[0]]);
        vec3_cross(n, u, w);
        vec3_normalize(n);
        if (fabs(n[2]) >= 1e-4 && fabs(n[2]) <= 1 - 1e-4) return 0;
    }
    return 1;
}

tobi_status tobi_shape_make(tobi_shape *s, tobi_body *b, int dimension, tobi_error *err)
{
    memset(s, 0, sizeof *s);
    s->thickness = 2*fabs(b->rest.volume)/b->rest.area;
    s->deforms = b->deforms;
    s->solid = dimension == 3 || is_prism(b);
    if (!s->solid && !s->deforms)
        return tobi_fail(err, TOBI_UNSUPPORTED,
                         "body '%s': in a 2-D scene with bodies that move by forces, a mesh must be a prism "
                         "or cylinder along z", b->name);
    if (!s->deforms) TOBI_TRY(tobi_body_build_rest(b, err));
    TOBI_TRY(tobi_facets_build(&s->facets, s->deforms ? b->bvh : b->rest_bvh,
                               (const double (*)[3])(s->deforms ? b->vertex : b->rest_vertex),
                               dimension == 2, err));
    if (s->deforms) s->facets.ball = 0;
    tobi_shape_follow(s, b);
    return TOBI_OK;
}

/* Rigid change of axes: y = turn x + shift. */
typedef struct frame { double turn[3][3], shift[3]; } frame;

typedef struct pair {
    const tobi_shape *a, *b;
    tobi_touch_list *out;
    frame to_b, to_world;          /* from a's rest axes to b's, from b's to the domain                */
    int64_t first;                 /* contact of this pair                                             */
    double margin, deepest, band, skin;
    double behind, between;        /* tolerances of the two tests, larger where bodies turn fast    */
    double around;                 /* the larger of margin and deepest: where to look              */
    int32_t ta;                    /* the triangle of a in work, and it in b's axes                    */
    double corner[3][3], normal[3];
} pair;

static void apply(const frame *f, const double x[3], double y[3])
{
    double r[3];
    for (int a = 0; a < 3; a++) r[a] = vec3_dot(f->turn[a], x) + f->shift[a];
    memcpy(y, r, sizeof r);
}

static void turn(const frame *f, const double x[3], double y[3])
{
    double r[3];
    for (int a = 0; a < 3; a++) r[a] = vec3_dot(f->turn[a], x);
    memcpy(y, r, sizeof r);
}

static void set_frames(pair *p, const tobi_rigid *a, const tobi_rigid *b)
{
    tobi_rigid_between(a, b, p->to_b.turn, p->to_b.shift);
    tobi_quaternion_matrix(b->orientation, p->to_world.turn);
    memcpy(p->to_world.shift, b->position, sizeof p->to_world.shift);
}

tobi_touch *tobi_touch_reserve(tobi_touch_list *out, int64_t room)
{
    if (room <= out->capacity) return out->at;
    tobi_touch *more = realloc(out->at, (size_t)room*sizeof *more);
    if (!more) {
        out->failed = 1;
        return NULL;
    }
    out->at = more;
    out->capacity = room;
    return more;
}

tobi_touch *tobi_touch_add(tobi_touch_list *out)
{
    if (out->count == out->capacity && !tobi_touch_reserve(out, 2*out->capacity + 64)) return NULL;
    tobi_touch *c = &out->at[out->count++];
    memset(c, 0, sizeof *c);
    return c;
}

static int64_t key_of(int kind, int64_t i, int64_t j)
{
    return (int64_t)kind << KIND_SHIFT | i << HALF | j;
}

/* A contact whose point and normal are in b's axes. */
static void add(pair *p, int64_t key, const double point[3], const double normal[3], double gap)
{
    tobi_touch *c = tobi_touch_add(p->out);
    if (!c) return;
    c->key = key;
    c->gap = gap;
    apply(&p->to_world, point, c->point);
    turn(&p->to_world, normal, c->normal);
}

/* Of a corner over several faces of a convex body only the nearest counts, and of coplanar faces one. */
static int is_better(pair *p, int64_t corner_key, int convex, const double normal[3], double gap)
{
    double world[3];
    turn(&p->to_world, normal, world);
    for (int64_t k = p->first; k < p->out->count; k++) {
        tobi_touch *c = &p->out->at[k];
        if (c->key >> HALF != corner_key) continue;
        if (!convex && vec3_dot(c->normal, world) < 0.99) continue;
        if (gap <= c->gap + 1e-3*p->skin) return 0;      /* the first of equals, in every step */
        p->out->at[k] = p->out->at[--p->out->count];
        return 1;
    }
    return 1;
}

/* Do all neighbours of a corner lie behind it along n? n in the corner's own axes. */
static int is_behind(const tobi_facets *f, int32_t corner, const double n[3], double tolerance)
{
    for (int64_t k = f->ring_start[corner]; k < f->ring_start[corner + 1]; k++) {
        double d[3];
        vec3_sub(d, f->vertex[f->ring[k]], f->vertex[corner]);
        double along = vec3_dot(d, n);
        if (along < 0 && along*along > tolerance*tolerance*vec3_dot(d, d)) return 0;
    }
    return 1;
}

/* Is the foot of x on the triangle's plane within it, or beside it by less than the band? */
static int is_over(const double (*t)[3], const double n[3], const double x[3], double band)
{
    for (int k = 0; k < 3; k++) {
        double edge[3], out[3], d[3];
        vec3_sub(edge, t[(k + 1)%3], t[k]);
        vec3_cross(out, edge, n);
        vec3_sub(d, x, t[k]);
        double beside = vec3_dot(out, d);
        if (beside > 0 && beside*beside > band*band*vec3_dot(out, out)) return 0;
    }
    return 1;
}

/* From b's axes to those of the body whose corner it is. */
static void turn_to_owner(const pair *p, int side, const double n[3], double out[3])
{
    for (int a = 0; a < 3; a++)
        out[a] = side < 0 ? n[a]
                          : p->to_b.turn[0][a]*n[0] + p->to_b.turn[1][a]*n[1] + p->to_b.turn[2][a]*n[2];
}

/* A corner that meets a face this close below a sharp edge rides over the edge: else a box that slides over
   a row of tiles would run into the side of each, since contact lets it sink in by the slop. */
static int rides_over(const pair *p, int32_t v, const double x[3], const double (*t)[3], const double n[3],
                      int32_t triangle, int side)
{
    const tobi_facets *own = side > 0 ? &p->a->facets : &p->b->facets,
                      *other = side > 0 ? &p->b->facets : &p->a->facets;
    for (int k = 0; k < 3; k++) {
        double next[3], d[3], along[3], edge[3], bend[3];
        int32_t twin = other->opposite[triangle][k];
        if (twin < 0) continue;
        memcpy(next, other->normal[twin/3], sizeof next);
        if (side < 0) turn(&p->to_b, next, next);
        vec3_sub(d, x, t[k]);
        if (fabs(vec3_dot(d, next)) > p->skin || vec3_dot(n, next) > 0.87) continue;
        vec3_sub(edge, t[(k + 1)%3], t[k]);
        vec3_cross(bend, n, next);
        turn_to_owner(p, side, next, along);
        if (vec3_dot(bend, edge) > 0 && is_behind(own, v, along, BEHIND)) return 1;
    }
    return 0;
}

/* Corner x of one body (number v) over a triangle of the other, both in b's axes. side: 1 if the corner is
   a's, -1 if it is b's. */
static void meet_corner(pair *p, int32_t v, const double x[3], const double (*t)[3], const double n[3],
                        int32_t triangle, int side)
{
    const tobi_facets *own = side > 0 ? &p->a->facets : &p->b->facets,
                      *other = side > 0 ? &p->b->facets : &p->a->facets;
    double d[3], along[3], point[3], normal[3];
    if (other->flat && fabs(n[2]) > 0.5) return;
    vec3_sub(d, x, t[0]);
    double gap = vec3_dot(d, n);
    if (gap > p->margin || gap < -p->deepest || !is_over(t, n, x, p->band)) return;
    turn_to_owner(p, side, n, along);
    if (!is_behind(own, v, along, p->behind)) return;
    if (gap > -p->skin && rides_over(p, v, x, t, n, triangle, side)) return;
    vec3_add_scaled(point, x, -0.5*gap, n);
    for (int a = 0; a < 3; a++) normal[a] = side*n[a];
    int kind = side > 0 ? CORNER_FACE : FACE_CORNER;
    int64_t key = key_of(kind, v, triangle);
    if (is_better(p, key >> HALF, other->convex, normal, gap)) add(p, key, point, normal, gap);
}

/* Is w, which is at right angles to the edge, between the normals of its two faces? */
static int is_between(const double n1[3], const double n2[3], const double w[3], double tolerance)
{
    double middle[3];
    vec3_add_scaled(middle, n1, 1, n2);
    vec3_normalize(middle);
    return vec3_dot(middle, w) >= vec3_dot(middle, n1) - tolerance;
}

/* A normal that is nearly a face's is the face's: crossings of nearly flush edges are noisy. */
static void snap(double n[3], double sign, const double face[3])
{
    if (sign*vec3_dot(n, face) < 0.998) return;
    for (int a = 0; a < 3; a++) n[a] = sign*face[a];
}

static void meet_edges(pair *p, int ka, int32_t tb, int kb)
{
    const tobi_facets *fa = &p->a->facets, *fb = &p->b->facets;
    const double *pa = p->corner[ka], *pb = fb->vertex[fb->triangle[tb][kb]];
    double u[3], w[3], n[3], d[3], na2[3], neg[3], point[3];
    vec3_sub(u, p->corner[(ka + 1)%3], pa);
    vec3_sub(w, fb->vertex[fb->triangle[tb][(kb + 1)%3]], pb);
    vec3_cross(n, u, w);
    double uu = vec3_dot(u, u), ww = vec3_dot(w, w), uw = vec3_dot(u, w), nn = vec3_dot(n, n);
    if (nn < SKEW*SKEW*uu*ww) return;
    vec3_sub(d, pb, pa);
    double du = vec3_dot(d, u), dw = vec3_dot(d, w);
    double s = (du*ww - dw*uw)/nn, t = (du*uw - dw*uu)/nn;
    double end_s = p->skin/sqrt(uu), end_t = p->skin/sqrt(ww);
    if (s < end_s || s > 1 - end_s || t < end_t || t > 1 - end_t) return;
    const double *nb1 = fb->normal[tb], *nb2 = fb->normal[fb->opposite[tb][kb]/3];
    turn(&p->to_b, fa->normal[fa->opposite[p->ta][ka]/3], na2);
    double size = 1/sqrt(nn), way = vec3_dot(n, nb1) + vec3_dot(n, nb2) > 0 ? 1 : -1;
    for (int a = 0; a < 3; a++) {
        n[a] *= way*size;
        neg[a] = -n[a];
    }
    double gap = -vec3_dot(d, n);
    if (gap > p->margin || gap < -p->deepest) return;
    if (!is_between(nb1, nb2, n, p->between) || !is_between(p->normal, na2, neg, p->between)) return;
    snap(n, 1, nb1);
    snap(n, 1, nb2);
    snap(n, -1, p->normal);
    snap(n, -1, na2);
    for (int a = 0; a < 3; a++) point[a] = 0.5*(pa[a] + s*u[a] + pb[a] + t*w[a]);
    add(p, key_of(EDGE_EDGE, 3*(int64_t)p->ta + ka, 3*(int64_t)tb + kb), point, n, gap);
}

/* Is a triangle as a whole too far before or behind another one's plane for any contact? */
static int is_apart(const pair *p, const double (*t)[3], const double n[3], const double (*other)[3])
{
    int before = 0, behind = 0;
    for (int k = 0; k < 3; k++) {
        double d[3];
        vec3_sub(d, other[k], t[0]);
        double height = vec3_dot(d, n);
        before += height > p->margin;
        behind += height < -p->deepest;
    }
    return before == 3 || behind == 3;
}

static void meet_triangle(void *user, int32_t tb)
{
    pair *p = user;
    const tobi_facets *fa = &p->a->facets, *fb = &p->b->facets;
    const int32_t *ia = fa->triangle[p->ta], *ib = fb->triangle[tb];
    double other[3][3];
    for (int k = 0; k < 3; k++) memcpy(other[k], fb->vertex[ib[k]], sizeof other[k]);
    int mine = fa->owned[p->ta], theirs = fb->owned[tb];
    if (is_apart(p, (const double (*)[3])p->corner, p->normal, (const double (*)[3])other)) return;
    if (is_apart(p, (const double (*)[3])other, fb->normal[tb], (const double (*)[3])p->corner)) return;
    for (int k = 0; k < 3; k++) {
        if (mine >> k & 1)
            meet_corner(p, ia[k], p->corner[k], (const double (*)[3])other, fb->normal[tb], tb, 1);
        if (theirs >> k & 1)
            meet_corner(p, ib[k], other[k], (const double (*)[3])p->corner, p->normal, p->ta, -1);
    }
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 3; j++)
            if ((mine >> (3 + k) & 1) && (theirs >> (3 + j) & 1)) meet_edges(p, k, tb, j);
}

/* A triangle of a that lies where b may be. */
static void visit_own(void *user, int32_t ta)
{
    pair *p = user;
    const tobi_facets *f = &p->a->facets;
    double lower[3] = { INFINITY, INFINITY, INFINITY }, upper[3] = { -INFINITY, -INFINITY, -INFINITY };
    p->ta = ta;
    turn(&p->to_b, f->normal[ta], p->normal);
    for (int k = 0; k < 3; k++) {
        apply(&p->to_b, f->vertex[f->triangle[ta][k]], p->corner[k]);
        for (int a = 0; a < 3; a++) {
            lower[a] = fmin(lower[a], p->corner[k][a] - p->around);
            upper[a] = fmax(upper[a], p->corner[k][a] + p->around);
        }
    }
    tobi_bvh_touching(p->b->facets.bvh, lower, upper, meet_triangle, p);
}

/* Is a's box, turned into b's axes, beside b's box? */
static int are_beside(const pair *p)
{
    double min[3], max[3], other_min[3], other_max[3];
    tobi_bvh_box(p->a->facets.bvh, min, max);
    tobi_bvh_box(p->b->facets.bvh, other_min, other_max);
    for (int a = 0; a < 3; a++) {
        double middle = p->to_b.shift[a], half = p->margin;
        for (int b = 0; b < 3; b++) {
            middle += p->to_b.turn[a][b]*0.5*(min[b] + max[b]);
            half += fabs(p->to_b.turn[a][b])*0.5*(max[b] - min[b]);
        }
        if (middle - half > other_max[a] || middle + half < other_min[a]) return 1;
    }
    return 0;
}

/* Where b's box is in a's axes. */
static void meet_surfaces(pair *p)
{
    double min[3], max[3], lower[3], upper[3];
    if (are_beside(p)) return;
    tobi_bvh_box(p->b->facets.bvh, min, max);
    for (int a = 0; a < 3; a++) {
        double middle = 0, half = 0;
        for (int b = 0; b < 3; b++) {
            middle += p->to_b.turn[b][a]*(0.5*(min[b] + max[b]) - p->to_b.shift[b]);
            half += fabs(p->to_b.turn[b][a])*0.5*(max[b] - min[b]);
        }
        lower[a] = middle - half - p->around;
        upper[a] = middle + half + p->around;
    }
    tobi_bvh_touching(p->a->facets.bvh, lower, upper, visit_own, p);
}

/* --- balls ------------------------------------------------------------------------------------- */

static void meet_balls(pair *p)
{
    double n[3], point[3], ra = p->a->facets.ball, rb = p->b->facets.ball;
    memcpy(n, p->to_b.shift, sizeof n);
    double apart = vec3_length(n), gap = apart - ra - rb;
    if (gap > p->margin) return;
    if (apart > 0) vec3_normalize(n);
    else n[0] = 1;
    for (int a = 0; a < 3; a++) point[a] = (rb + 0.5*gap)*n[a];
    add(p, key_of(BALL, 0, 0), point, n, gap);
}

/* The ball is a; one triangle of b near it. */
static void meet_ball(void *user, int32_t tb)
{
    pair *p = user;
    const tobi_facets *f = &p->b->facets;
    const double *centre = p->to_b.shift, *n = f->normal[tb];
    double t[3][3], d[3], point[3];
    if (f->flat && fabs(n[2]) > 0.5) return;
    for (int k = 0; k < 3; k++) memcpy(t[k], f->vertex[f->triangle[tb][k]], sizeof t[k]);
    vec3_sub(d, centre, t[0]);
    double height = vec3_dot(d, n), gap = height - p->a->facets.ball;
    if (gap > p->margin || height < -p->deepest || !is_over((const double (*)[3])t, n, centre, 0)) return;
    vec3_add_scaled(point, centre, -(height - 0.5*gap), n);
    int64_t key = key_of(BALL, 0, tb);
    if (is_better(p, key >> HALF, 0, n, gap)) add(p, key, point, n, gap);
}

/* The nearest place of b's surface, when that is an edge or a corner that the ball meets. */
static void meet_ball_edge(pair *p)
{
    tobi_bvh_hit hit;
    double n[3], point[3], r = p->a->facets.ball;
    if (!tobi_bvh_closest(p->b->facets.bvh, p->to_b.shift, r + p->margin, &hit)) return;
    if (hit.signed_distance <= 0) return;
    vec3_sub(n, p->to_b.shift, hit.point);
    const tobi_facets *f = &p->b->facets;
    for (int k = 0; k < 4; k++) {      /* it rolls on one of the faces there and over their edge */
        int32_t half = k < 3 ? f->opposite[hit.triangle][k] : 3*hit.triangle, twin = half/3;
        if (half >= 0 && vec3_dot(n, f->normal[twin]) >= r - p->skin) return;
    }
    vec3_normalize(n);
    double gap = hit.distance - r;
    int64_t key = key_of(BALL, 1, 0);
    for (int64_t k = p->first; k < p->out->count; k++)
        if (p->out->at[k].gap <= gap + 1e-9*r) return;     /* a face is as near: it has been met */
    vec3_add_scaled(point, hit.point, 0.5*gap, n);
    add(p, key, point, n, gap);
}

static void meet_ball_surface(pair *p)
{
    double reach = p->a->facets.ball + p->margin, lower[3], upper[3];
    for (int a = 0; a < 3; a++) {
        lower[a] = p->to_b.shift[a] - reach;
        upper[a] = p->to_b.shift[a] + reach;
    }
    tobi_bvh_touching(p->b->facets.bvh, lower, upper, meet_ball, p);
    meet_ball_edge(p);
}

/* --- one pair ---------------------------------------------------------------------------------- */

static double squared(double x) { return x*x; }

/* Of many contacts the deepest, and then always the one that is farthest from those kept; those nearly as
   deep come first, since a ring on the floor stands on them and not on what is wider and higher. */
void tobi_touch_thin(tobi_touch_list *out, int64_t first)
{
    enum { MOST = 16 };
    int64_t n = out->count - first;
    tobi_touch *c = out->at + first;
    double deep = INFINITY;
    if (n <= MOST) return;
    for (int64_t i = 0; i < n; i++) deep = fmin(deep, c[i].gap + 4*c[i].slop);
    for (int64_t kept = 0; kept < MOST; kept++) {
        int64_t best = kept;
        double most = -INFINITY;
        for (int64_t i = kept; i < n; i++) {
            double worth = -c[i].gap;
            if (c[i].gap > deep && c[best].gap <= deep) continue;
            if (c[i].gap <= deep && c[best].gap > deep) most = -INFINITY;
            for (int64_t k = 0; k < kept; k++) {
                double d2 = vec3_distance2(c[i].point, c[k].point);
                d2 += squared(c[i].slop)*vec3_distance2(c[i].normal, c[k].normal);
                worth = k == 0 || d2 < worth ? d2 : worth;
            }
            if (worth <= most) continue;
            most = worth;
            best = i;
        }
        tobi_touch swap = c[kept];
        c[kept] = c[best];
        c[best] = swap;
    }
    out->count = first + MOST;
}

static void touch_ordered(pair *p, const tobi_body *a, const tobi_body *b)
{
    set_frames(p, tobi_shape_axes(p->a, a), tobi_shape_axes(p->b, b));
    double thickness = fmin(p->a->thickness, p->b->thickness);
    p->deepest = TOBI_TOUCH_DEEPEST*thickness;
    p->around = fmax(p->margin, p->deepest);
    p->skin = 2*SLOP*thickness;
    p->band = fmax(EDGE_BAND*fmin(p->a->facets.reach, p->b->facets.reach), p->skin);
    if (p->a->facets.ball > 0 && p->b->facets.ball > 0) meet_balls(p);
    else if (p->a->facets.ball > 0) meet_ball_surface(p);
    else meet_surfaces(p);
    for (int64_t k = p->first; k < p->out->count; k++) p->out->at[k].slop = SLOP*thickness;
    tobi_touch_thin(p->out, p->first);
}

void tobi_touch_bodies(const tobi_body *a, const tobi_shape *sa, const tobi_body *b, const tobi_shape *sb,
                       tobi_touch_look look, tobi_touch_list *out)
{
    pair p = { .a = sa, .b = sb, .out = out, .first = out->count, .margin = look.margin };
    p.behind = sin(fmin(BEHIND + look.turn, 0.8));
    p.between = BETWEEN + p.behind*p.behind;
    if (!(sb->facets.ball > 0) || sa->facets.ball > 0) {
        touch_ordered(&p, a, b);
        return;
    }
    p.a = sb;
    p.b = sa;
    touch_ordered(&p, b, a);
    for (int64_t k = p.first; k < out->count; k++)
        for (int i = 0; i < 3; i++) out->at[k].normal[i] *= -1;
}

/* Of a swimmer: all its vertices as they are now. */
static void touch_vertices(const tobi_body *a, const tobi_shape *sa, const tobi_fixed_plane *plane,
                           int number, double margin, tobi_touch_list *out)
{
    const double height = tobi_plane_height(plane, a->rigid.position);
    const int64_t first = out->count;
    for (int64_t k = 0; k < a->mesh.vertex_count; k++) {
        double arm[3];
        vec3_sub(arm, a->vertex[k], a->rigid.position);
        const double gap = height + vec3_dot(plane->normal, arm);
        tobi_touch *c = gap > margin ? NULL : tobi_touch_add(out);
        if (!c) continue;
        c->key = key_of(SIDE, number, (int32_t)k);
        c->gap = gap;
        c->slop = SLOP*sa->thickness;
        c->friction = plane->friction;
        vec3_add_scaled(c->point, a->vertex[k], -0.5*gap, plane->normal);
        memcpy(c->normal, plane->normal, sizeof c->normal);
    }
    tobi_touch_thin(out, first);
}

void tobi_touch_plane(const tobi_body *a, const tobi_shape *sa, const tobi_fixed_plane *plane, int number,
                      double margin, tobi_touch_list *out)
{
    const tobi_rigid *r = &a->rigid;
    const tobi_facets *f = &sa->facets;
    const double *n = plane->normal;
    int64_t first = out->count;
    if (a->swimmer) {
        touch_vertices(a, sa, plane, number, margin, out);
        return;
    }
    double m[3][3], height = tobi_plane_height(plane, r->position);
    if (height > f->reach + margin) return;
    tobi_quaternion_matrix(r->orientation, m);
    for (int64_t k = 0; k < (f->ball > 0 ? 1 : f->corner_count); k++) {
        double arm[3];
        for (int i = 0; i < 3; i++)
            arm[i] = f->ball > 0 ? -f->ball*n[i] : vec3_dot(m[i], f->vertex[f->corner[k]]);
        double gap = height + vec3_dot(n, arm);
        if (gap > margin) continue;
        tobi_touch *c = tobi_touch_add(out);
        if (!c) return;
        c->key = key_of(SIDE, number, f->ball > 0 ? 0 : f->corner[k]);
        c->gap = gap;
        c->slop = SLOP*sa->thickness;
        c->friction = plane->friction;
        vec3_add_scaled(c->point, r->position, 1, arm);
        vec3_add_scaled(c->point, c->point, -0.5*gap, n);
        memcpy(c->normal, n, sizeof c->normal);
    }
    tobi_touch_thin(out, first);
}
