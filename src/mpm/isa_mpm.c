/* Turns the transfers into loops, compiled once per instruction set. */
#include "mpm/kernels.h"
#include "mpm/filter.k.h"
#include "mpm/pack.k.h"

/* Kernels over blocks, as tobi_launch wants them. */
#define MPM_KERNEL(NAME, BODY, DIM)                                                                 \
    static void NAME(const void *view, int64_t begin, int64_t end, double *totals)                  \
    {                                                                                               \
        for (int64_t n = begin; n < end; n++) BODY((const mpm_view *)view, n, totals, DIM);         \
    }

#define JOIN_(a, b) a##_##b
#define JOIN(a, b) JOIN_(a, b)

MPM_KERNEL(scatter_2d, mpm_scatter, 2)
MPM_KERNEL(collect_2d, mpm_collect, 2)
MPM_KERNEL(gather_2d, mpm_gather, 2)
MPM_KERNEL(filter_2d, mpm_filter, 2)
MPM_KERNEL(filter_nodes_2d, mpm_filter_nodes, 2)
MPM_KERNEL(scatter_calm_2d, mpm_scatter_calm, 2)
MPM_KERNEL(energy_calm_2d, mpm_energy_calm, 2)
MPM_KERNEL(energy_nodes_2d, mpm_energy_nodes, 2)
MPM_KERNEL(scatter_3d, mpm_scatter, 3)
MPM_KERNEL(collect_3d, mpm_collect, 3)
MPM_KERNEL(gather_3d, mpm_gather, 3)
MPM_KERNEL(filter_3d, mpm_filter, 3)
MPM_KERNEL(filter_nodes_3d, mpm_filter_nodes, 3)
MPM_KERNEL(scatter_calm_3d, mpm_scatter_calm, 3)
MPM_KERNEL(energy_calm_3d, mpm_energy_calm, 3)
MPM_KERNEL(energy_nodes_3d, mpm_energy_nodes, 3)

const mpm_kernels JOIN(mpm_kernels, TOBI_ISA)[2] = {
    {scatter_2d, collect_2d, gather_2d, filter_2d, filter_nodes_2d,
     scatter_calm_2d, energy_calm_2d, energy_nodes_2d},
    {scatter_3d, collect_3d, gather_3d, filter_3d, filter_nodes_3d,
     scatter_calm_3d, energy_calm_3d, energy_nodes_3d},
};

MPM_PACK_KERNEL(pack_crowd, mpm_pack_crowd)
MPM_PACK_KERNEL(pack_answer, mpm_pack_answer)
MPM_PACK_KERNEL(pack_forget, mpm_pack_forget)
MPM_PACK_KERNEL(pack_read, mpm_pack_read)
MPM_PACK_KERNEL(pack_push, mpm_pack_push)

const mpm_pack_kernels JOIN(mpm_pack_kernels, TOBI_ISA) = {pack_crowd, pack_answer, pack_forget, pack_read,
                                                           pack_push};
