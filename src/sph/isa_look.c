/* A particle's look at the points of a body, compiled once per instruction set: which points face it, and
   the sums over them (decision 94). Points are tested four at once, in double; sums run point by point, the
   axes side by side: their order is that of the points. Drawback: one step at a time through the table of a
   plane, which no register gathers everywhere. */
#include "sph/look_loops.h"
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

static void list_points(double *const row[TOBI_POINT_ROWS], int64_t begin, int64_t end, const double x[3],
                        double reach2, tobi_facing_points *list)
{
    for (int64_t k = begin; k < end; k += 4) {
        const four rx = x[0] - load(row[0] + k), ry = x[1] - load(row[1] + k), rz = x[2] - load(row[2] + k);
        const four height = rx*load(row[3] + k) + ry*load(row[4] + k) + rz*load(row[5] + k);
        const four square = rx*rx + ry*ry + rz*rz;
        unsigned m = bits((square < reach2) & (height > 0));
        if (end - k < 4) m &= (1u << (end - k)) - 1;
        if (m) append(list, k, m, square, height);
    }
}

/* The mean depth of the body behind each point's plane. */
static void find_reach(const tobi_smoothing_constants *c, const tobi_facing_points *q, double *reach)
{
    for (int i = 0; i < q->count; i++) {
        const double at = q->height[i]/c->h*TOBI_PLANE_SAMPLES;
        const double sigma = tobi_wall_table_at(c->plane.sigma, at);
        reach[i] = sigma > 0 ? tobi_wall_table_at(c->plane.lambda, at)/sigma : 0;
    }
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
    double reach[TOBI_FACING_MOST];
    find_reach(c, q, reach);
    for (int i = 0; i < q->count; i++) {
        const tobi_boundary_point *p = tobi_facing_point(q, i);
        const int32_t k = p->number;
        const double s = q->height[i], w = q->weight[i], aw = p->area*w;
        const double *n = p->normal, *v = b->point_velocity[k];
        const four normal = three(n), arm = three(p->at) + lower - centre;
        const double gn = g[0]*n[0] + g[1]*n[1] + (c->dimension == 3 ? g[2]*n[2] : 0);
        __atomic_store_n(&b->wet[k], TOBI_WET, __ATOMIC_RELAXED);
        /* whole numbers: the same sum in any order */
        __atomic_fetch_add(&b->covered[k], (uint32_t)(2*c->volume*w*TOBI_COVERED), __ATOMIC_RELAXED);
        gradient -= aw*normal;
        torque_arm -= aw*(turn(arm)*turn_back(normal) - turn_back(arm)*turn(normal));
        hydrostatic -= aw*gn*(s + reach[i])*normal;
        flux -= aw*(n[0]*v[0] + n[1]*v[1] + n[2]*v[2]);
        share += aw*reach[i];
        steady += aw*reach[i]*tobi_boundary_rise(s, e->distance, c->spacing);
        height += aw*s;
        if (b->friction != TOBI_NO_SLIP) continue;
        const double rate = 2*aw/(s > 0.25*c->spacing ? s : 0.25*c->spacing);
        drag += rate;
        drag_velocity += rate*three(v);
    }
    for (int a = 0; a < 3; a++) {
        link->gradient[a] = gradient[a];
        link->torque_arm[a] = torque_arm[a];
        e->hydrostatic[a] = hydrostatic[a];
        e->drag_velocity[a] = drag_velocity[a];
    }
    e->wall_flux = flux, e->share = share, e->steady = steady, e->height = height, e->drag = drag;
}

const tobi_look_loops JOIN(tobi_look_loops, TOBI_ISA) = {list_points, sum_points};
