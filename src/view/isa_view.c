/* Turns kernels.def into loops, compiled once per instruction set. An item is work enough to be launched on
   its own. Drawback: the view is read through its pointer in each item. */
#include "view/kernels.h"
#include "view/surface/surface.k.h"

#define JOIN_(a, b) a##_##b
#define JOIN(a, b) JOIN_(a, b)

#define SURFACE(K, SUMS, MAXIMA, DOC)                                                               \
    static void run_##K(const void *view, int64_t begin, int64_t end, double *totals)               \
    {                                                                                               \
        for (int64_t i = begin; i < end; i++) K((const surface_view *)view, i, totals);             \
    }
#include "view/kernels.def"
#undef SURFACE

const tobi_view_kernels JOIN(tobi_view_kernels, TOBI_ISA) = {
#define SURFACE(K, SUMS, MAXIMA, DOC) .K = {run_##K, SUMS, MAXIMA},
#include "view/kernels.def"
#undef SURFACE
};
