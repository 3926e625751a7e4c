/* Which pairs of particles may have an image at a body: most have none within reach. Eight pairs are asked at
   once, in float, with room for its rounding; what is left is decided in double (body_images.k.h).
   Drawback: a second, short copy of each mirror. */
#pragma once
#include "sph/isph/images.k.h"

/* Of the square of the support: what is farther is out of reach whatever doubles, or floats, round. */
#define ISPH_REACH 1.0001
#define ISPH_ROUGH_REACH 1.002f

enum { ISPH_SEEN = 4 };              /* planes of a particle that are asked for; of more, each pair is left */

/* What is found of eight pairs. */
typedef struct isph_answer {
    unsigned single, several;        /* bit per pair: its images are in one plane each; may be in several,
                                        or were not asked for                                       */
    int32_t hit[8];                  /* of single ones: bit per plane of i and of the neighbour     */
    int32_t other[ISPH_SEEN][8];             /* the mirrors of the neighbours                               */
} isph_answer;

/* What a particle asks of its pairs. */
typedef struct isph_asking {
    int planes;
    isph_brief plane[ISPH_SEEN];
    int32_t own[ISPH_SEEN];          /* the mirror of each                                          */
    int beside;                      /* 1: there are images in sides                                */
    int sides;                       /* within reach                                                */
    int axis[6], side[6];            /* of each: lower, upper                                       */
} isph_asking;

TOBI_FN void isph_make_brief(const isph_mirror *m, isph_brief *b)
{
    for (int a = 0; a < 3; a++) {
        b->offset[a] = (float)m->offset[a];
        b->normal[a] = (float)m->normal[a];
    }
    b->body = m->body;
    b->previous = m->previous + 1;
}

TOBI_FN void isph_ask_begin(const isph_view *v, int64_t i, const isph_reflections *f, isph_asking *q)
{
    q->planes = q->sides = 0;
    q->beside = f->total > 1;
    for (int32_t k = v->last_link[i] + 1; k > 0; k = v->brief[k].previous)
        if (q->planes++ < ISPH_SEEN) {
            q->plane[q->planes - 1] = v->brief[k];
            q->own[q->planes - 1] = k - 1;
        }
    for (int a = 0; a < 3; a++)
        for (int k = 1; k < f->count[a]; k++) {
            q->axis[q->sides] = a;
            q->side[q->sides++] = f->side[a][k];
        }
}

/* 1: the pair may have an image in a side. In more sides it is farther. */
TOBI_FN lane isph_near_sides(const isph_view *v, int64_t i, const isph_asking *q, const tobi_neighbors *n)
{
    lane_int at[3];
    lane w, found = lane_set(0);
    const lane d[3] = { n->dx, n->dy, n->dz };
    lane_load_record(v->record, n->j, &at[0], &at[1], &at[2], &w);
    for (int s = 0; s < q->sides; s++) {
        const int a = q->axis[s];
        const int32_t wall = v->side[q->side[s]][a];
        const lane both = (lane_from_int(lane_sub_wrap(wall, at[a])) + (float)(wall - (&v->record[i].x)[a]))*
                          v->from_fixed[a];
        found = lane_where_less(n->r2 - d[a]*d[a] + both*both, lane_set(ISPH_ROUGH_REACH*(float)(v->h*v->h)),
                                lane_set(1), found);
    }
    return found;
}

/* A plane of i and one of each neighbour: 1 where the image in their mean may be within reach; adds 1 to meet
   where one in several planes may be. */
TOBI_FN lane isph_ask_plane(const isph_asking *q, const isph_brief *own, const tobi_neighbors *n,
                            const lane o[3], const lane m[3], lane_int body, lane near_sides, float h,
                            lane *meet)
{
    const lane d[3] = { n->dx, n->dy, n->dz };
    const lane zero = lane_set(0), one = lane_set(1), before = lane_set(-1e-4f*h);
    lane size = zero, from = zero, to = zero;
    for (int a = 0; a < 3; a++) {
        const lane normal = m[a] + own->normal[a], sum = o[a] + own->offset[a];
        size += normal*normal;
        from += (sum + d[a])*normal;
        to += (sum - d[a])*normal;
    }
    const float far2 = ISPH_ROUGH_REACH*h*h;
    const lane same = lane_where_equal(body, lane_set_int(own->body),
                                       lane_where_less(lane_set(0.999f), size, one, zero), zero);
    const lane apart = lane_where_less(before, from, lane_where_less(before, to, same, zero), zero);
    const lane single = lane_where_less(zero, (n->r2 - far2)*size + from*to, zero, apart);
    const lane both = 0.5f*(from + to);
    *meet += q->beside ? same : lane_where_less(both*both, far2*size, apart, zero);
    return q->beside ? lane_where_less(zero, near_sides, same, single) : single;
}

/* Pairs of i and j[0] to j[7] that may have images. */
TOBI_FN void isph_ask_pairs(const isph_view *v, int64_t i, const isph_asking *q, const int32_t *j,
                            isph_answer *found)
{
    const tobi_float4 *rows = (const tobi_float4 *)(const void *)v->brief;
    int32_t at[TOBI_LANES], first[TOBI_LANES], second[TOBI_LANES], any = 0;
    const lane zero = lane_set(0);
    lane hit = zero, meet = zero, near_sides = zero, o[3], m[3], body, previous;
    tobi_neighbors n;
    found->single = found->several = 0;
    for (int k = 0; k < TOBI_LANES; k++) any |= at[k] = j[k] == i ? 0 : v->last_link[j[k]] + 1;
    if (!any) return;
    for (int k = 0; k < TOBI_LANES; k++) found->several |= (unsigned)(at[k] > 0) << k;
    if (q->planes > ISPH_SEEN) return;
    isph_load(v, i, j, &n);
    if (q->sides) near_sides = isph_near_sides(v, i, q, &n);
    for (int step = 0; any; step++) {
        if (step == ISPH_SEEN) return;
        for (int k = 0; k < TOBI_LANES; k++) {
            second[k] = (first[k] = 2*at[k]) + 1;
            found->other[step][k] = at[k] - 1;
        }
        lane_load_float4(rows, first, &o[0], &o[1], &o[2], &body);
        lane_load_float4(rows, second, &m[0], &m[1], &m[2], &previous);
        for (int p = 0; p < q->planes; p++)          /* 16 bits: a float holds them */
            hit += isph_ask_plane(q, &q->plane[p], &n, o, m, lane_bits(body), near_sides, (float)v->h, &meet)*
                   (float)(1 << (ISPH_SEEN*p + step));
        any = 0;
        for (int k = 0; k < TOBI_LANES; k++) any |= at[k] = lane_int_at(lane_bits(previous), k);
    }
    found->several = lane_mask_less(lane_set(1.5f), meet);
    found->single = lane_mask_less(zero, hit) & ~found->several;
    for (int k = 0; k < TOBI_LANES; k++) found->hit[k] = (int32_t)lane_at(hit, k);
}
