/* Where loops run: the only room that names OpenMP (tools/check_house.py). A kernel is a function over a
   range of particles; exec cuts [begin, end) into blocks of fixed size, runs them on threads in any order and
   combines the totals of the blocks in one fixed order: the result does not depend on the number of threads.
   A loop without totals goes to tobi_loop. */
#pragma once
#include "base/error.h"
#include "exec/portable.h"

enum { TOBI_BLOCK = 512 };

/* Address of one of the tables of kernels NAME_v2, NAME_v3, NAME_v4, as many as cmake/isa.cmake has made. */
#if TOBI_ISA_SETS == 3
#define TOBI_TABLE_OF(ISA, NAME) ((ISA) >= 4 ? &NAME##_v4 : (ISA) == 3 ? &NAME##_v3 : &NAME##_v2)
#else
#define TOBI_TABLE_OF(ISA, NAME) ((void)(ISA), &NAME##_v2)
#endif

/* A kernel: runs over [begin, end) of one block. totals[0] to [sums - 1] are summed over all blocks,
   totals[6] to [5 + maxima] are maxima (start at 0); all eight are zero on entry, and a kernel writes no
   others. The kernels.def of a room lists its kernels; its kernels.h has them by name, for one instruction
   set. */
typedef struct tobi_kernel {
    void (*run)(const void *view, int64_t begin, int64_t end, double *totals);
    int sums, maxima;
} tobi_kernel;

/* 1 if totals that were zero before the kernel are zero still, but for those that it makes. */
static inline int tobi_kernel_keeps(tobi_kernel kernel, const double *totals)
{
    for (int k = 0; k < TOBI_TOTALS; k++)
        if (totals[k] != 0 && (k < TOBI_SUMS ? k >= kernel.sums : k >= TOBI_SUMS + kernel.maxima)) return 0;
    return 1;
}

/* A loop with totals that stays on the host, as one of no list. */
#define TOBI_HOST(RUN, SUMS, MAXIMA) ((tobi_kernel){RUN, SUMS, MAXIMA})

typedef struct tobi_exec {
    int threads;             /* OpenMP threads of every launch          */
    int isa;                 /* 2, 3 or 4: x86-64 level of the kernels  */
    double *partial;         /* block totals, grown when needed         */
    int64_t partial_blocks;
} tobi_exec;

/* threads = 0 takes all cores, or as many as the environment variable OMP_NUM_THREADS says. */
tobi_status tobi_exec_init(tobi_exec *x, int threads, tobi_error *err);
void tobi_exec_free(tobi_exec *x);
/* Makes room for sums over n items, so that launches never allocate. */
tobi_status tobi_exec_reserve(tobi_exec *x, int64_t n, tobi_error *err);

/* Arrays that kernels reach live where exec keeps them: today in host memory, beginning on a cache line.
   `count` items of `size` bytes, undefined or zero; NULL without memory. Only tobi_array_free takes them. */
void *tobi_array_make(int64_t count, size_t size);
void *tobi_array_zero(int64_t count, size_t size);
/* A longer one in its place, with the first `kept` items; on failure NULL, and the old one stays. */
void *tobi_array_grow(void *array, int64_t kept, int64_t count, size_t size);
void tobi_array_free(void *array);

/* Threads for a loop (tobi_loop): waking one costs some 10 us, so each gets at least `worth` items.
   The result must not depend on them. */
static inline int tobi_team(const tobi_exec *x, int64_t items, int64_t worth)
{
    return items/worth >= x->threads ? x->threads : items < 2*worth ? 1 : (int)(items/worth);
}

/* Loops that the calling thread starts with 0 threads (those of io and geom) take so many. */
void tobi_exec_set_default(int threads);

/* Runs over [begin, end), one part of a loop. No item writes what another one reads; what all write (a mark,
   a count) is atomic and the same in any order. */
typedef void (*tobi_range)(const void *view, int64_t begin, int64_t end);

/* Runs over [0, count). chunk > 0: parts of so many items, each for the next thread that is free, for items
   of uneven work; chunk 0: one part per thread. threads 0: see above. One part, or one thread, runs in the
   caller. */
void tobi_loop(int threads, int64_t count, int64_t chunk, tobi_range range, const void *view);

/* Before a plain loop over floats whose items do not depend on one another: eight at once. */
#define TOBI_SIMD _Pragma("omp simd")

/* Runs kernel over [begin, end); totals (TOBI_TOTALS doubles) may be NULL. */
void tobi_launch(tobi_exec *x, tobi_kernel kernel, const void *view, int64_t begin, int64_t end,
                 double *totals);

/* The same for items that are work enough on their own: blocks of one. Reserve for TOBI_BLOCK times as
   many. */
void tobi_launch_each(tobi_exec *x, tobi_kernel kernel, const void *view, int64_t count, double *totals);

/* Totals of one block of a launch. */
typedef struct tobi_block_sum { int64_t block; double total[TOBI_TOTALS]; } tobi_block_sum;

/* Totals of a launch of which no other block has anything to add. Blocks ascend; the parts are spent. */
void tobi_combine_sums(tobi_block_sum *parts, int64_t count, double *totals);

/* Stable radix sort of keys (each < key_limit) with their indices 0..n-1. On return keys are sorted
   and order[k] is the old index of rank k. The three scratch arrays hold n entries each. */
void tobi_sort_by_key(tobi_exec *x, int64_t n, uint32_t key_limit, uint32_t *keys, int32_t *order,
                      uint32_t *key_scratch, int32_t *order_scratch, int64_t *histogram);
/* Entries of `histogram` for the above. */
int64_t tobi_sort_histogram_size(const tobi_exec *x);

/* Brings n entries of `size` bytes into an order: entry k was entry order[k]. `scratch` holds n entries. */
void tobi_permute(int threads, void *data, size_t size, const int32_t *order, int64_t n, void *scratch);

/* Exclusive prefix sum in place over n counts; returns the total. */
int64_t tobi_scan(tobi_exec *x, int64_t n, int64_t *counts);

/* Where runs of equal keys begin, their `bits` lowest bits aside; returns how many. begin NULL only
   counts. */
int64_t tobi_find_runs(tobi_exec *x, int64_t n, const uint32_t *keys, int bits, int64_t *begin);

/* Wall-clock seconds, for stage timers only. */
double tobi_clock(void);
