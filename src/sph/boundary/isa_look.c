/* A particle's look at the points of a body, compiled once per instruction set: which points face it, and
   the sums over them (decision 94). Points are tested four at once, in double; sums run point by point, the
   axes side by side: their order is that of the points. Drawback: one step at a time through the table of a
   plane, which no register gathers everywhere. */
#include "sph/boundary/look_loops.h"
#include "exec/pairs.h"
#include <string.h>

#define JOIN_(a, b) a##_##b
#define JOIN(a, b) JOIN_(a, b)

typedef double four __attribute__((vector_size(32)));
typedef int64_t four_int __attribute__((vector_size(32)));
#pragma GCC diagnostic ignored "-Wpsabi"   /* every function of them is inlined */

static inline four load(const double *p)
{
    four a;
    memcpy(&a, p, sizeof a);
    return a;
}

static inline four three(const double p[3]) { return (four){p[0], p[1], p[2], 0}; }
static inline four turn(four a) { return __builtin_shufflevector(a, a, 1, 2, 0, 3); }
static inline four turn_back(four a) { return __builtin_shufflevector(a, a, 2, 0, 1, 3); }

/* Writes the elements whose bit is set to the end of the list. */
static inline void append(tobi_facing_points *l, int64_t first, unsigned m, four square, four height)
{
#if defined(__AVX512VL__)
    const __m128i index = _mm_add_epi32(_mm_set1_epi32((int32_t)first), _mm_setr_epi32(0, 1, 2, 3));
    _mm_storeu_si128((__m128i *)(void *)&l->index[l->count], _mm_maskz_compress_epi32((__mmask8)m, index));
    _mm256_storeu_pd(&l->square[l->count], _mm256_maskz_compress_pd((__mmask8)m, (__m256d)square));
    _mm256_storeu_pd(&l->height[l->count], _mm256_maskz_compress_pd((__mmask8)m, (__m256d)height));
    l->count += __builtin_popcount(m);
#else
    for (int k = 0; k < 4; k++) {
        l->index[l->count] = (int32_t)first + k;
        l->square[l->count] = square[k];
        l->height[l->count] = height[k];
        l->count += (int)(m >> k & 1);
    }
#endif
}

static inline unsigned bits(four_int m)
{
#if defined(__AVX__)
    return (unsigned)_mm256_movemask_pd((__m256d)m);
#else
    return (unsigned)((m[0] & 1) | (m[1] & 2) | (m[2] & 4) | (m[3] & 8));
#endif
}

/* The rows and the place, where the compiler sees that no list overwrites them. */
typedef struct field { const double *x, *y, *z, *nx, *ny, *nz; double at[3], reach2; } field;

static inline field open_field(double *const row[TOBI_POINT_ROWS], const double x[3], double reach2)
{
    return (field){row[0], row[1], row[2], row[3], row[4], row[5], {x[0], x[1], x[2]}, reach2};
}

/* Bit per point of k to k + 3, as many as lie before the end: it faces the place within reach. */
static inline unsigned test(const field *f, int64_t k, int64_t end, four *square, four *height)
{
    const four rx = f->at[0] - load(f->x + k), ry = f->at[1] - load(f->y + k), rz = f->at[2] - load(f->z + k);
    *height = rx*load(f->nx + k) + ry*load(f->ny + k) + rz*load(f->nz + k);
    *square = rx*rx + ry*ry + rz*rz;
    const unsigned m = bits((*square < f->reach2) & (*height > 0));
    return end - k < 4 ? m & ((1u << (end - k)) - 1) : m;
}

static void list_points(double *const row[TOBI_POINT_ROWS], int64_t begin, int64_t end, const double x[3],
                        double reach2, tobi_facing_points *list)
{
    const field f = open_field(row, x, reach2);
    four square, height;
    for (int64_t k = begin; k < end; k += 4) {
        const unsigned m = test(&f, k, end, &square, &height);
        if (m) append(list, k, m, square, height);
    }
}

static int any_point(double *const row[TOBI_POINT_ROWS], int64_t begin, int64_t end, const double x[3],
                     double reach2)
{
    const field f = open_field(row, x, reach2);
    four square, height;
    for (int64_t k = begin; k < end; k += 4)
        if (test(&f, k, end, &square, &height)) return 1;
    return 0;
}

/* x, y, z of four places that follow one another. */
static inline void load_places(const tobi_double3 *place, four out[3])
{
    const double *p = &place->x;
    const four a = load(p), b = load(p + 4), c = load(p + 8);
    const four low = __builtin_shufflevector(a, b, 0, 3, 6, 5);
    out[0] = __builtin_shufflevector(low, c, 0, 1, 2, 5);
    out[1] = __builtin_shufflevector(__builtin_shufflevector(a, b, 1, 4, 7, 7), c, 0, 1, 2, 6);
    out[2] = __builtin_shufflevector(__builtin_shufflevector(a, b, 2, 5, 2, 2), c, 0, 1, 4, 7);
}

static void list_places(const tobi_double3 *place, int64_t begin, int64_t end, const double x[3],
                        const double normal[3], int deep, double reach2, tobi_facing_points *list)
{
    const double from[3] = {x[0], x[1], x[2]}, n[3] = {normal[0], normal[1], normal[2]};
    for (int64_t k = begin; k < end; k += 4) {
        four r[3];
        load_places(place + k, r);
        for (int a = 0; a < 3; a++) r[a] = r[a] - from[a];
        if (!deep) r[2] = (four){0, 0, 0, 0};
        const four height = r[0]*n[0] + r[1]*n[1] + r[2]*n[2], square = r[0]*r[0] + r[1]*r[1] + r[2]*r[2];
        unsigned m = bits((square < reach2) & (height > 0));
        if (end - k < 4) m &= (1u << (end - k)) - 1;
        if (m) append(list, k, m, square, height);
    }
}

/* Of each listed point, what divisions make: several at once, before the sums. */
typedef struct shares {
    double area_weight[TOBI_FACING_MOST];
    double reach[TOBI_FACING_MOST];     /* m, lambda/sigma: the mean depth of the body behind its plane */
    double rise[TOBI_FACING_MOST];      /* tobi_boundary_rise                                           */
    double rate[TOBI_FACING_MOST];      /* 1/m2, of no-slip friction                                    */
} shares;

static void find_shares(const tobi_smoothing_constants *c, const tobi_facing_points *q, double distance,
                        shares *out)
{
    const double nearest = 0.25*c->spacing;
    double at[TOBI_FACING_MOST], sigma[TOBI_FACING_MOST];
    for (int i = 0; i < q->count; i++) at[i] = q->height[i]/c->h*TOBI_PLANE_SAMPLES;
    for (int i = 0; i < q->count; i++) {
        sigma[i] = tobi_wall_table_at(c->plane.sigma, at[i]);
        out->reach[i] = tobi_wall_table_at(c->plane.lambda, at[i]);
        out->area_weight[i] = tobi_facing_point(q, i)->area*q->weight[i];
    }
    for (int i = 0; i < q->count; i++) {
        const double s = q->height[i], share = out->reach[i]/sigma[i];
        out->reach[i] = sigma[i] > 0 ? share : 0;
        out->rise[i] = tobi_boundary_rise(s, distance, c->spacing);
        out->rate[i] = 2*out->area_weight[i]/(s > nearest ? s : nearest);
    }
}

/* Whole numbers: the same sum in any order. A locked addition takes as long as half of the other sums. */
static inline void cover(const tobi_look_view *v, int32_t point, uint32_t more)
{
    if (v->alone) v->body->covered[point] += more;
    else __atomic_fetch_add(&v->body->covered[point], more, __ATOMIC_RELAXED);
}

static void sum_points(const tobi_look_view *view, const tobi_facing_points *q, tobi_boundary_link *link,
                       tobi_boundary_entry *e)
{
    const tobi_body *b = view->body;
    const tobi_smoothing_constants *c = view->smoothing;
    const double *g = view->gravity;
    const four lower = three(b->lower), centre = three(b->centre);
    four gradient = three(link->gradient), torque_arm = three(link->torque_arm);
    four hydrostatic = three(e->hydrostatic), drag_velocity = three(e->drag_velocity);
    double flux = e->wall_flux, share = e->share, steady = e->steady, height = e->height, drag = e->drag;
    shares of;
    find_shares(c, q, e->distance, &of);
    for (int i = 0; i < q->count; i++) {
        const tobi_boundary_point *p = tobi_facing_point(q, i);
        const int32_t k = p->number;
        const double s = q->height[i], aw = of.area_weight[i], reach = of.reach[i];
        const double *n = p->normal, *v = b->point_velocity[k];
        const four normal = three(n), arm = three(p->at) + lower - centre;
        const double gn = g[0]*n[0] + g[1]*n[1] + (c->dimension == 3 ? g[2]*n[2] : 0);
        __atomic_store_n(&b->wet[k], TOBI_WET, __ATOMIC_RELAXED);
        cover(view, k, (uint32_t)(2*c->volume*q->weight[i]*TOBI_COVERED));
        gradient -= aw*normal;
        torque_arm -= aw*(turn(arm)*turn_back(normal) - turn_back(arm)*turn(normal));
        hydrostatic -= aw*gn*(s + reach)*normal;
        flux -= aw*(n[0]*v[0] + n[1]*v[1] + n[2]*v[2]);
        share += aw*reach;
        steady += aw*reach*of.rise[i];
        height += aw*s;
        if (b->friction != TOBI_NO_SLIP) continue;
        drag += of.rate[i];
        drag_velocity += of.rate[i]*three(v);
    }
    for (int a = 0; a < 3; a++) {
        link->gradient[a] = gradient[a];
        link->torque_arm[a] = torque_arm[a];
        e->hydrostatic[a] = hydrostatic[a];
        e->drag_velocity[a] = drag_velocity[a];
    }
    e->wall_flux = flux, e->share = share, e->steady = steady, e->height = height, e->drag = drag;
}

/* The tests of pairs.c, with room for rounding. */
static unsigned may_hide(const tobi_hiding *v, int32_t i, const int32_t j[8])
{
    const tobi_record own = v->record[i];
    const lane zero = lane_set(0), one = lane_set(1);
    float beyond[8];
    lane_int at[3];
    lane w, d[3], square = zero, found = zero;
    for (int k = 0; k < 8; k++) beyond[k] = v->body_distance[j[k]];
    const lane both = lane_load(beyond) + v->body_distance[i];
    lane_load_record(v->record, j, &at[0], &at[1], &at[2], &w);
    for (int a = 0; a < 3; a++) {
        d[a] = lane_from_int(lane_sub_wrap((&own.x)[a], at[a]))*v->from_fixed[a];
        square += d[a]*d[a];
    }
    const lane reach = 1.0202f*square, edge = lane_set(1e-5f*v->h*v->h);
    const lane apart = lane_where_less(both*both, 1.0011f*square, one, zero);
    for (int b = 0; b < v->bodies; b++) {
        const float *o = v->offset[b], distance = v->distance[b];
        const lane along = (o[0] - d[0])*o[0] + (o[1] - d[1])*o[1] + (o[2] - d[2])*o[2];
        const lane hides = lane_where_less(v->least[b] + edge, along, zero, one);
        found = lane_where_less(reach, lane_set(distance*distance), found, found + hides);
    }
    return lane_mask_less(zero, found*apart);
}

const tobi_look_loops JOIN(tobi_look_loops, TOBI_ISA) = {list_points, any_point, list_places, sum_points,
                                                       may_hide};
