/* Loops, sums and sorts on OpenMP threads. Parts of a loop go to the threads in any order; all sums are taken
   in an order that only the number of items decides. Drawback: a loop without totals is not checked for items
   that depend on one another. */
#include "exec/exec.h"
#include <assert.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { RADIX_BITS = 11, RADIX = 1 << RADIX_BITS };

static int find_isa(void)
{
#if TOBI_ISA_SETS == 3
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512cd")) return 4;
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2") &&
        __builtin_cpu_supports("fma"))
        return 3;
#endif
    return 2;
}

void tobi_exec_set_default(int threads) { omp_set_num_threads(threads); }

tobi_status tobi_exec_init(tobi_exec *x, int threads, tobi_error *err)
{
    memset(x, 0, sizeof *x);
    if (threads < 0)
        return tobi_fail(err, TOBI_INVALID, "threads is %d, allowed is 0 (all cores) or more",
                         threads);
    x->threads = threads > 0 ? threads : omp_get_max_threads();    /* heeds OMP_NUM_THREADS */
    x->isa = find_isa();
    const char *wish = getenv("TOBIUO_ISA");   /* tests compare instruction sets with this */
    if (wish && !wish[0]) wish = NULL;
    if (wish && (wish[0] < '2' || wish[0] > '4' || wish[1]))
        return tobi_fail(err, TOBI_INVALID, "the environment variable TOBIUO_ISA is \"%.20s\", allowed is 2, "
                         "3 or 4: the instructions of x86-64-v2, -v3 and -v4", wish);
    if (wish && wish[0] - '0' < x->isa) x->isa = wish[0] - '0';
    return tobi_exec_reserve(x, TOBI_BLOCK, err);
}

void tobi_exec_free(tobi_exec *x)
{
    free(x->partial);
    x->partial = NULL;
    x->partial_blocks = 0;
}

static size_t bytes_of(int64_t count, size_t size) { return ((size_t)count*size + 127)/64*64; }

void *tobi_array_make(int64_t count, size_t size) { return aligned_alloc(64, bytes_of(count, size)); }

void *tobi_array_zero(int64_t count, size_t size)
{
    void *array = tobi_array_make(count, size);
    if (array) memset(array, 0, bytes_of(count, size));
    return array;
}

void *tobi_array_grow(void *array, int64_t kept, int64_t count, size_t size)
{
    void *more = tobi_array_make(count, size);
    if (!more) return NULL;
    if (array) memcpy(more, array, (size_t)kept*size);
    free(array);
    return more;
}

void tobi_array_free(void *array) { free(array); }

tobi_status tobi_exec_reserve(tobi_exec *x, int64_t n, tobi_error *err)
{
    int64_t blocks = (n + TOBI_BLOCK - 1)/TOBI_BLOCK + 1;
    if (blocks <= x->partial_blocks) return TOBI_OK;
    double *p = realloc(x->partial, (size_t)blocks*TOBI_TOTALS*sizeof *p);
    if (!p) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the sums of %lld particles", (long long)n);
    x->partial = p;
    x->partial_blocks = blocks;
    return TOBI_OK;
}

static void add_totals(int sums, int maxima, double *a, const double *c)
{
    for (int k = 0; k < sums; k++) a[k] += c[k];
    for (int k = TOBI_SUMS; k < TOBI_SUMS + maxima; k++) if (c[k] > a[k]) a[k] = c[k];
}

/* Pairwise over blocks: error grows with log n, order fixed by n alone. */
static void combine(tobi_kernel kernel, double *p, int64_t blocks, double *totals)
{
    for (int64_t step = 1; step < blocks; step *= 2)
        for (int64_t b = 0; b + step < blocks; b += 2*step)
            add_totals(kernel.sums, kernel.maxima, p + b*TOBI_TOTALS, p + (b + step)*TOBI_TOTALS);
    memcpy(totals, p, TOBI_TOTALS*sizeof *totals);
}

/* The same pairs as above: where one side is missing it is zero. */
void tobi_combine_sums(tobi_block_sum *p, int64_t count, double *totals)
{
    memset(totals, 0, TOBI_TOTALS*sizeof *totals);
    while (count > 1) {
        int64_t kept = 0;
        for (int64_t k = 0; k < count; k++) {
            const int64_t pair = p[k].block/2;
            if (kept > 0 && p[kept - 1].block == pair) {
                add_totals(TOBI_SUMS, TOBI_TOTALS - TOBI_SUMS, p[kept - 1].total, p[k].total);
                continue;
            }
            p[kept] = p[k];
            p[kept++].block = pair;
        }
        count = kept;
    }
    if (count) memcpy(totals, p[0].total, TOBI_TOTALS*sizeof *totals);
}

/* Cuts [begin, end) into blocks of `grain`. */
static void run_blocks(tobi_exec *x, tobi_kernel kernel, const void *view, int64_t begin, int64_t end,
                       int64_t grain, double *totals)
{
    int64_t blocks = (end - begin + grain - 1)/grain;
    if (totals) memset(totals, 0, TOBI_TOTALS*sizeof *totals);
    if (blocks <= 0) return;
    double *partial = x->partial;
    assert(!totals || blocks <= x->partial_blocks);
    #pragma omp parallel for schedule(dynamic, 4) num_threads(x->threads) if (blocks > 1)
    for (int64_t b = 0; b < blocks; b++) {
        double sums[TOBI_TOTALS] = {0};
        int64_t first = begin + b*grain, last = first + grain;
        kernel.run(view, first, last < end ? last : end, sums);
        assert(tobi_kernel_keeps(kernel, sums));
        if (totals) memcpy(partial + b*TOBI_TOTALS, sums, sizeof sums);
    }
    if (totals) combine(kernel, partial, blocks, totals);
}

void tobi_launch(tobi_exec *x, tobi_kernel kernel, const void *view, int64_t begin, int64_t end,
                 double *totals)
{
    run_blocks(x, kernel, view, begin, end, TOBI_BLOCK, totals);
}

void tobi_launch_each(tobi_exec *x, tobi_kernel kernel, const void *view, int64_t count, double *totals)
{
    run_blocks(x, kernel, view, 0, count, 1, totals);
}

void tobi_loop(int threads, int64_t count, int64_t chunk, tobi_range range, const void *view)
{
    if (threads <= 0) threads = omp_get_max_threads();
    const int64_t parts = chunk > 0 ? (count + chunk - 1)/chunk : count < threads ? count : threads;
    if (count <= 0) return;
    if (threads == 1 || parts == 1) {
        range(view, 0, count);
    } else if (chunk > 0) {
        #pragma omp parallel for num_threads(threads) schedule(dynamic, 1)
        for (int64_t q = 0; q < parts; q++)
            range(view, q*chunk, q < parts - 1 ? (q + 1)*chunk : count);
    } else {
        #pragma omp parallel for num_threads(threads) schedule(static, 1)
        for (int64_t q = 0; q < parts; q++) range(view, count*q/parts, count*(q + 1)/parts);
    }
}

int64_t tobi_sort_histogram_size(const tobi_exec *x) { return (int64_t)x->threads*RADIX; }

/* One stable pass on RADIX_BITS bits: every thread counts and moves its own contiguous part. */
static void sort_pass(tobi_exec *x, int64_t n, int shift, const uint32_t *key_in, const int32_t *index_in,
                      uint32_t *key_out, int32_t *index_out, int64_t *histogram)
{
    #pragma omp parallel num_threads(x->threads)
    {
        int t = omp_get_thread_num(), count = omp_get_num_threads();
        int64_t first = n*t/count, last = n*(t + 1)/count;
        int64_t *mine = histogram + (int64_t)t*RADIX;
        memset(mine, 0, RADIX*sizeof *mine);
        for (int64_t i = first; i < last; i++) mine[((uint64_t)key_in[i] >> shift) & (RADIX - 1)]++;
        #pragma omp barrier
        #pragma omp single
        {
            int64_t sum = 0;
            for (int d = 0; d < RADIX; d++)
                for (int s = 0; s < count; s++) {
                    int64_t c = histogram[(int64_t)s*RADIX + d];
                    histogram[(int64_t)s*RADIX + d] = sum;
                    sum += c;
                }
        }
        for (int64_t i = first; i < last; i++) {
            int64_t at = mine[((uint64_t)key_in[i] >> shift) & (RADIX - 1)]++;
            key_out[at] = key_in[i];
            index_out[at] = index_in ? index_in[i] : (int32_t)i;
        }
    }
}

void tobi_sort_by_key(tobi_exec *x, int64_t n, uint32_t key_limit, uint32_t *keys, int32_t *order,
                      uint32_t *key_scratch, int32_t *order_scratch, int64_t *histogram)
{
    /* An even number of passes ends in the caller's arrays. */
    int passes = 2;
    while (passes*RADIX_BITS < 32 && (key_limit >> (passes*RADIX_BITS)) != 0) passes += 2;
    for (int p = 0; p < passes; p += 2) {
        sort_pass(x, n, p*RADIX_BITS, keys, p ? order : NULL, key_scratch, order_scratch, histogram);
        sort_pass(x, n, (p + 1)*RADIX_BITS, key_scratch, order_scratch, keys, order, histogram);
    }
}

/* Inlined for each size, so that an entry is a move or two. */
static inline __attribute__((always_inline)) void gather(const char *from, size_t size, const int32_t *order,
                                                         int64_t begin, int64_t end, char *to)
{
    for (int64_t k = begin; k < end; k++) memcpy(to + (size_t)k*size, from + (size_t)order[k]*size, size);
}

static void gather_rows(const char *from, size_t size, const int32_t *order, int64_t begin, int64_t end,
                        char *to)
{
    switch (size) {
    case 1: gather(from, 1, order, begin, end, to); break;
    case 4: gather(from, 4, order, begin, end, to); break;
    case 8: gather(from, 8, order, begin, end, to); break;
    case 16: gather(from, 16, order, begin, end, to); break;
    case 24: gather(from, 24, order, begin, end, to); break;
    case 48: gather(from, 48, order, begin, end, to); break;
    default: gather(from, size, order, begin, end, to);
    }
}

void tobi_permute(int threads, void *data, size_t size, const int32_t *order, int64_t n, void *scratch)
{
    #pragma omp parallel num_threads(threads)
    {
        int t = omp_get_thread_num(), count = omp_get_num_threads();
        int64_t first = n*t/count, last = n*(t + 1)/count;
        gather_rows(data, size, order, first, last, scratch);
        #pragma omp barrier
        memcpy((char *)data + (size_t)first*size, (char *)scratch + (size_t)first*size,
               (size_t)(last - first)*size);
    }
}

/* One int64 per 4096 counts fits into the block totals, which hold 8 doubles per 512 items. */
int64_t tobi_scan(tobi_exec *x, int64_t n, int64_t *counts)
{
    enum { PART = 4096 };
    int64_t parts = (n + PART - 1)/PART, total = 0;
    int64_t *base = (int64_t *)x->partial;
    #pragma omp parallel for num_threads(x->threads)
    for (int64_t p = 0; p < parts; p++) {
        int64_t s = 0;
        for (int64_t i = p*PART; i < n && i < (p + 1)*PART; i++) s += counts[i];
        base[p] = s;
    }
    for (int64_t p = 0; p < parts; p++) {
        int64_t s = base[p];
        base[p] = total;
        total += s;
    }
    #pragma omp parallel for num_threads(x->threads)
    for (int64_t p = 0; p < parts; p++) {
        int64_t s = base[p];
        for (int64_t i = p*PART; i < n && i < (p + 1)*PART; i++) {
            int64_t c = counts[i];
            counts[i] = s;
            s += c;
        }
    }
    return total;
}

int64_t tobi_find_runs(tobi_exec *x, int64_t n, const uint32_t *keys, int bits, int64_t *begin)
{
    int64_t counts[256] = {0}, total = 0;
    int parts = x->threads < 256 ? x->threads : 256;
    for (int pass = 0; pass < (begin ? 2 : 1); pass++) {
        #pragma omp parallel for num_threads(parts) schedule(static, 1)
        for (int t = 0; t < parts; t++) {
            int64_t found = pass ? counts[t] : 0;
            for (int64_t i = n*t/parts; i < n*(t + 1)/parts; i++)
                if (i == 0 || keys[i] >> bits != keys[i - 1] >> bits) {
                    if (pass) begin[found] = i;
                    found++;
                }
            if (!pass) counts[t] = found;
        }
        if (pass) break;
        for (int t = 0; t < parts; t++) {
            int64_t c = counts[t];
            counts[t] = total;
            total += c;
        }
    }
    return total;
}

double tobi_clock(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9*(double)t.tv_nsec;
}
