/* Turns kernels.def into loops, compiled once per instruction set. */
#include "sph/kernels.h"
#include "sph/boundary/couple.k.h"
#include "sph/filter.k.h"
#include "sph/isph/eisph.k.h"
#include "sph/isph/choices.k.h"
#include "sph/isph/loop.h"
#include "sph/isph/shift.k.h"
#include "sph/isph/time.k.h"
#include "sph/phases.k.h"
#include "sph/pressure.k.h"
#include "sph/scalars.k.h"
#include "sph/sph.k.h"
#include "sph/tait.k.h"
#include "sph/tension.k.h"
#include "sph/viscosity.k.h"
#include "sph/yield.k.h"

#define JOIN_(a, b) a##_##b
#define JOIN(a, b) JOIN_(a, b)

/* The pair functions take the smoothing shape as a constant, so that each loop is compiled for one: two
   shapes have loops of their own, the others share one and are told apart in it, eight pairs at a time. */
#define PAIR_OF(K, NAME, SHAPE)                                                                     \
    typedef K##_acc K##_##NAME##_acc;                                                               \
    TOBI_FN void K##_##NAME##_start(const sph_view *v, int64_t i, K##_acc *a) { K##_start(v, i, a); } \
    TOBI_FN void K##_##NAME##_pair(const sph_view *v, int64_t i, const tobi_neighbors *n, K##_acc *a)    \
    { K##_pair(v, i, n, a, SHAPE); }                                                                \
    TOBI_FN void K##_##NAME##_finish(const sph_view *v, int64_t i, K##_acc *a, double *t)           \
    { K##_finish(v, i, a, t); }                                                                     \
    TOBI_PAIR_LOOP(K##_##NAME, sph_view, run_##K##_##NAME)
#define PAIR(K, SUMS, MAXIMA, DOC)                                                                  \
    PAIR_OF(K, wendland, TOBI_SHAPE_WENDLAND)                                                       \
    PAIR_OF(K, cubic, TOBI_SHAPE_CUBIC)                                                             \
    PAIR_OF(K, other, v->shape)
#define FOR(K, SUMS, MAXIMA, DOC) TOBI_FOR_LOOP(K, sph_view, run_##K)
#define PHASES PAIR
#define PHASE FOR
#define SCALARS PAIR
#define SCALAR FOR
#define COUPLE(K, SUMS, MAXIMA, DOC) TOBI_FOR_LOOP(K, tobi_couple_view, run_##K)
#define IMAGE(K, SUMS, MAXIMA, DOC)                                                                 \
    ISPH_LOOP(K, TOBI_SHAPE_WENDLAND, run_##K##_wendland)                                           \
    ISPH_LOOP(K, TOBI_SHAPE_CUBIC, run_##K##_cubic)                                                 \
    ISPH_LOOP(K, v->shape, run_##K##_other)
#define RARE(K, SUMS, MAXIMA, DOC) ISPH_LOOP(K, v->shape, run_##K)
#define ISPH(K, SUMS, MAXIMA, DOC) TOBI_FOR_LOOP(K, isph_view, run_##K)
#include "sph/kernels.def"
#undef PAIR
#undef FOR
#undef COUPLE
#undef PHASES
#undef PHASE
#undef SCALARS
#undef SCALAR
#undef IMAGE
#undef RARE
#undef ISPH

const sph_kernels JOIN(sph_kernels, TOBI_ISA)[SPH_TABLES] = {
    {
#define PAIR(K, SUMS, MAXIMA, DOC) .K = {run_##K##_wendland, SUMS, MAXIMA},
#define FOR(K, SUMS, MAXIMA, DOC) .K = {run_##K, SUMS, MAXIMA},
#define COUPLE FOR
#define PHASES PAIR
#define PHASE FOR
#define SCALARS PAIR
#define SCALAR FOR
#define IMAGE PAIR
#define RARE FOR
#define ISPH FOR
#include "sph/kernels.def"
#undef PAIR
    },
    {
#define PAIR(K, SUMS, MAXIMA, DOC) .K = {run_##K##_cubic, SUMS, MAXIMA},
#include "sph/kernels.def"
#undef PAIR
    },
    {
#define PAIR(K, SUMS, MAXIMA, DOC) .K = {run_##K##_other, SUMS, MAXIMA},
#include "sph/kernels.def"
#undef PAIR
#undef FOR
#undef COUPLE
#undef PHASES
#undef PHASE
#undef SCALARS
#undef SCALAR
#undef IMAGE
#undef RARE
#undef ISPH
    },
};
