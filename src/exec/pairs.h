/* The pair loop: walks the neighbour list of a range of particles, eight neighbours at a time, and
   hands each group to three inline functions of a kernel K with accumulator type K##_acc:
     K##_start(v, i, &acc)               before the neighbours
     K##_pair(v, i, &near, &acc)         eight neighbours: near.dx/dy/dz = x_i - x_j, r2, index, payload
     K##_finish(v, i, &acc, totals)      after them; the only place that writes
   v is a view with members record, list, list_far, list_start, list_groups, from_fixed. */
#pragma once
#include "exec/list.h"

typedef struct tobi_neighbors {
    lane dx, dy, dz, r2, w;      /* w: payload of the neighbour's record */
    lane_int index;
    const int32_t *j;            /* the neighbours' indices in memory    */
} tobi_neighbors;

#define TOBI_PAIR_LOOP(K, V, NAME)                                                               \
    static void NAME(const void *view, int64_t begin, int64_t end, double *totals)               \
    {                                                                                            \
        const V *v = (const V *)view;                                                            \
        for (int64_t i = begin; i < end; i++) {                                                  \
            K##_acc acc;                                                                         \
            const tobi_record own = v->record[i];                                                \
            const int count = 8*v->list_groups[i];                                               \
            int32_t unpacked[TOBI_LIST_LIMIT];                                                   \
            const int32_t *j = tobi_list_load(v->list, v->list_far, i, 8*(int64_t)v->list_start[i], count, \
                                              unpacked);                                         \
            K##_start(v, i, &acc);                                                               \
            for (int g = 0; g < count; g += TOBI_LANES) {                                        \
                tobi_neighbors near;                                                             \
                lane_int x, y, z;                                                                \
                near.j = j + g;                                                                  \
                near.index = lane_load_index(near.j);                                            \
                lane_load_record(v->record, near.j, &x, &y, &z, &near.w);                        \
                near.dx = lane_from_int(lane_sub_wrap(own.x, x))*v->from_fixed[0];               \
                near.dy = lane_from_int(lane_sub_wrap(own.y, y))*v->from_fixed[1];               \
                near.dz = lane_from_int(lane_sub_wrap(own.z, z))*v->from_fixed[2];               \
                near.r2 = near.dx*near.dx + near.dy*near.dy + near.dz*near.dz;                   \
                K##_pair(v, i, &near, &acc);                                                     \
            }                                                                                    \
            K##_finish(v, i, &acc, totals);                                                      \
        }                                                                                        \
    }

/* A kernel that looks at one particle only: K(v, i, totals). */
#define TOBI_FOR_LOOP(K, V, NAME)                                                                \
    static void NAME(const void *view, int64_t begin, int64_t end, double *totals)               \
    {                                                                                            \
        const V *v = (const V *)view;                                                            \
        for (int64_t i = begin; i < end; i++) K(v, i, totals);                                   \
    }
