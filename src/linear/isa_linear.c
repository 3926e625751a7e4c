/* Turns kernels.def into loops, compiled once per instruction set. Sums are kept in registers: added to
   memory they would wait for each other. Drawback: one running sum per block, which no compiler may
   vectorize, for the sake of the same bits everywhere. */
#include "linear/kernels.h"
#include "linear/grid.k.h"
#include "linear/vectors.k.h"

#define JOIN_(a, b) a##_##b
#define JOIN(a, b) JOIN_(a, b)

#define LOOP(K, V)                                                                                  \
    static void run_##K(const void *view, int64_t begin, int64_t end, double *totals)               \
    {                                                                                               \
        const V v = *(const V *)view;                                                               \
        double t[TOBI_TOTALS] = {0};                                                                \
        for (int64_t i = begin; i < end; i++) K(&v, i, t);                                          \
        for (int k = 0; k < TOBI_TOTALS; k++) totals[k] = t[k];                                     \
    }
#define VECTOR(K, SUMS, MAXIMA, DOC) LOOP(K, tobi_vectors_view)
#define GRID(K, SUMS, MAXIMA, DOC) LOOP(K, tobi_grid_view)
#include "linear/kernels.def"
#undef VECTOR
#undef GRID

const tobi_linear_kernels JOIN(tobi_linear_kernels, TOBI_ISA) = {
#define VECTOR(K, SUMS, MAXIMA, DOC) .K = {run_##K, SUMS, MAXIMA},
#define GRID(K, SUMS, MAXIMA, DOC) .K = {run_##K, SUMS, MAXIMA},
#include "linear/kernels.def"
#undef VECTOR
#undef GRID
};
