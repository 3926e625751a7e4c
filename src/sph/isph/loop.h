/* The pair loop of isph: the neighbours of a particle, and the images of them and of itself at the sides of
   the domain and at bodies. A kernel K with accumulator K##_acc has
     K##_start(v, i, &acc)
     K##_pair(v, i, &near, &image, &acc, shape, kind)     eight pairs; kind: a constant of ISPH_*
     K##_finish(v, i, &acc, totals) */
#pragma once
#include "sph/isph/body_images.k.h"

/* Calls K##_pair for each group of each reflection at the sides. */
#define ISPH_SIDES(K, SHAPE)                                                                        \
    const isph_reflections reflections = isph_find_reflections(v, i);                               \
    for (int f = 1; f < reflections.total; f++) {                                                   \
        int side[3];                                                                                \
        isph_choose_sides(&reflections, f, side);                                                   \
        for (int g = -TOBI_LANES; g < groups; g += TOBI_LANES) {                                    \
            isph_load(v, i, g < 0 ? self : j + g, &near);                                           \
            image.k = g < 0 ? -1 : first + g;                                                       \
            isph_reflect(v, i, side, &near, &image);                                                \
            K##_pair(v, i, &near, &image, &acc, SHAPE, ISPH_SIDE);                                  \
        }                                                                                           \
    }

/* The same for pairs at bodies. */
#define ISPH_AT_BODIES(K, SHAPE)                                                                    \
    for (int64_t g = isph_first_group(v, i); g >= 0; g = v->group[g].images.next) {                 \
        isph_load_group(v, i, first, g, &near, &image);                                             \
        K##_pair(v, i, &near, &image, &acc, SHAPE, ISPH_BODY);                                      \
    }

#define ISPH_LOOP(K, SHAPE, NAME)                                                                   \
    static void NAME(const void *view, int64_t begin, int64_t end, double *totals)                  \
    {                                                                                               \
        const isph_view *v = (const isph_view *)view;                                               \
        for (int64_t i = begin; i < end; i++) {                                                     \
            const int64_t first = 8*(int64_t)v->list_start[i];                                      \
            const int groups = 8*v->list_groups[i];                                                 \
            int32_t self[8], unpacked[TOBI_LIST_LIMIT];                                             \
            const int32_t *j = tobi_list_load(v->list, v->list_far, i, first, groups, unpacked);    \
            K##_acc acc;                                                                            \
            tobi_neighbors near;                                                                    \
            isph_image image;                                                                       \
            isph_gravity_at(v, i, image.gravity);                                                   \
            for (int k = 0; k < 8; k++) self[k] = (int32_t)i;                                       \
            K##_start(v, i, &acc);                                                                  \
            for (int g = 0; g < groups; g += TOBI_LANES) {                                          \
                isph_load(v, i, j + g, &near);                                                      \
                image.k = first + g;                                                                \
                K##_pair(v, i, &near, &image, &acc, SHAPE, ISPH_PLAIN);                             \
            }                                                                                       \
            ISPH_SIDES(K, SHAPE)                                                                    \
            ISPH_AT_BODIES(K, SHAPE)                                                                \
            K##_finish(v, i, &acc, totals);                                                         \
        }                                                                                           \
    }
