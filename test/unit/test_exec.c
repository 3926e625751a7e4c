/* Sorting, scanning and summing give what their serial definitions give, for any number of threads. */
#include "exec/exec.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

static uint64_t state_ = 99;
static uint32_t random_bits(void)
{
    state_ = state_*6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(state_ >> 33);
}

static tobi_exec start(int threads, int64_t n)
{
    tobi_exec x;
    assert_int_equal(tobi_exec_init(&x, threads, NULL), TOBI_OK);
    assert_int_equal(tobi_exec_reserve(&x, n, NULL), TOBI_OK);
    return x;
}

typedef struct item { uint32_t key; int32_t index; } item;
static int compare(const void *a, const void *b)
{
    const item *p = a, *q = b;
    if (p->key != q->key) return p->key < q->key ? -1 : 1;
    return p->index < q->index ? -1 : 1;
}

static void check_sort(int threads, int64_t n, uint32_t limit)
{
    tobi_exec x = start(threads, n);
    size_t m = (size_t)n + 1;
    uint32_t *key = malloc(m*4), *key2 = malloc(m*4);
    int32_t *order = malloc(m*4), *order2 = malloc(m*4);
    int64_t *histogram = malloc((size_t)tobi_sort_histogram_size(&x)*sizeof *histogram);
    item *expected = malloc(m*sizeof *expected);
    for (int64_t i = 0; i < n; i++) {
        key[i] = random_bits()%limit;
        expected[i] = (item){key[i], (int32_t)i};
    }
    qsort(expected, (size_t)n, sizeof *expected, compare);
    tobi_sort_by_key(&x, n, limit, key, order, key2, order2, histogram);
    for (int64_t i = 0; i < n; i++) {
        assert_int_equal(key[i], expected[i].key);
        assert_int_equal(order[i], expected[i].index);
    }
    free(key); free(key2); free(order); free(order2); free(histogram); free(expected);
    tobi_exec_free(&x);
}

static void sort_is_stable(void **state)
{
    static const uint32_t limit[] = {1, 2, 50, 2048, 2049, 1u << 22, (1u << 22) + 1, 2000000000u};
    (void)state;
    for (int t = 1; t <= 4; t++)
        for (size_t k = 0; k < sizeof limit/sizeof *limit; k++) {
            check_sort(t, 20011, limit[k]);
            check_sort(t, 3, limit[k]);
        }
    check_sort(2, 0, 7);
}

static void scan_is_the_running_sum(void **state)
{
    static const int64_t size[] = {0, 1, 4095, 4096, 4097, 100003};
    (void)state;
    for (int t = 1; t <= 4; t++)
        for (size_t k = 0; k < sizeof size/sizeof *size; k++) {
            int64_t n = size[k], sum = 0;
            tobi_exec x = start(t, n);
            int64_t *a = malloc(((size_t)n + 1)*8), *b = malloc(((size_t)n + 1)*8);
            for (int64_t i = 0; i < n; i++) {
                a[i] = (int64_t)random_bits()*4;
                b[i] = sum;
                sum += a[i];
            }
            assert_int_equal(tobi_scan(&x, n, a), sum);
            assert_memory_equal(a, b, (size_t)n*8);
            free(a);
            free(b);
            tobi_exec_free(&x);
        }
}

static void add_values(const void *view, int64_t begin, int64_t end, double *t)
{
    const double *v = view;
    for (int64_t i = begin; i < end; i++) {
        t[0] += v[i];
        t[5] += v[i]*v[i];
        if (v[i] > t[6]) t[6] = v[i];
    }
}

/* Values over 16 decades: any other order of sums changes the last bits. */
static void sums_do_not_depend_on_threads(void **state)
{
    enum { N = 123457 };
    (void)state;
    double *v = malloc(N*sizeof *v), first[TOBI_TOTALS] = {0}, t[TOBI_TOTALS];
    long double exact = 0, size = 0;
    for (int i = 0; i < N; i++) {
        v[i] = ((double)random_bits()/2147483648.0 - 0.5)*pow(10, random_bits()%16);
        exact += v[i];
        size += fabs(v[i]);
    }
    for (int threads = 1; threads <= 4; threads++) {
        tobi_exec x = start(threads, N);
        for (int again = 0; again < 5; again++) {
            tobi_launch(&x, TOBI_HOST(add_values, 6, 1), v, 0, N, t);
            if (threads == 1 && again == 0) memcpy(first, t, sizeof t);
            assert_memory_equal(t, first, sizeof t);
        }
        tobi_exec_free(&x);
    }
    assert_true(fabsl(first[0] - exact) < 1e-14L*size);
    double most = 0;
    for (int i = 0; i < N; i++) most = fmax(most, v[i]);
    assert_true(first[6] == most);
    free(v);
}

/* A range that begins and ends inside blocks. */
static void ranges_are_half_open(void **state)
{
    (void)state;
    double v[2000], t[TOBI_TOTALS];
    for (int i = 0; i < 2000; i++) v[i] = 1;
    tobi_exec x = start(3, 2000);
    tobi_launch(&x, TOBI_HOST(add_values, 6, 1), v, 700, 1999, t);
    assert_true(t[0] == 1299);
    tobi_launch(&x, TOBI_HOST(add_values, 6, 1), v, 5, 5, t);
    assert_true(t[0] == 0 && t[6] == 0);
    tobi_exec_free(&x);
}

typedef struct visits { int64_t count, chunk; int *times, *parts, *wrong; } visits;

static void note_visits(const void *view, int64_t begin, int64_t end)
{
    const visits *v = view;
    __atomic_fetch_add(v->parts, 1, __ATOMIC_RELAXED);
    if (begin >= end || begin < 0 || end > v->count) __atomic_store_n(v->wrong, 1, __ATOMIC_RELAXED);
    for (int64_t i = begin; i < end; i++) __atomic_fetch_add(&v->times[i], 1, __ATOMIC_RELAXED);
}

/* Each item once, in no empty part, and in as many parts as were asked for. */
static void loops_visit_each_item_once(void **state)
{
    static const int64_t count[] = {0, 1, 2, 3, 255, 256, 257, 5003}, chunk[] = {0, 1, 4, 256};
    (void)state;
    for (int threads = 0; threads <= 5; threads++)
        for (size_t c = 0; c < sizeof count/sizeof *count; c++)
            for (size_t k = 0; k < sizeof chunk/sizeof *chunk; k++) {
                int times[5003] = {0}, parts = 0, wrong = 0;
                const int64_t n = count[c], size = chunk[k], cut = size ? (n + size - 1)/size : threads;
                const visits view = {n, size, times, &parts, &wrong};
                tobi_loop(threads, n, size, note_visits, &view);
                assert_false(wrong);
                for (int64_t i = 0; i < n; i++) assert_int_equal(times[i], 1);
                if (threads == 0) continue;
                const int64_t most = cut < n ? cut : n;
                assert_int_equal(parts, threads == 1 ? n > 0 : most);
            }
}

static void permute_brings_into_order(void **state)
{
    static const size_t size[] = {1, 4, 8, 16, 24, 48, 12};
    enum { N = 1009 };
    (void)state;
    int32_t order[N];
    for (int k = 0; k < N; k++) order[k] = (int32_t)(k*(int64_t)37%N);
    for (int threads = 1; threads <= 4; threads++)
        for (size_t s = 0; s < sizeof size/sizeof *size; s++) {
            unsigned char data[48*N], was[48*N], scratch[48*N];
            for (size_t b = 0; b < size[s]*N; b++) data[b] = was[b] = (unsigned char)random_bits();
            tobi_permute(threads, data, size[s], order, N, scratch);
            for (int k = 0; k < N; k++)
                assert_memory_equal(data + (size_t)k*size[s], was + (size_t)order[k]*size[s], size[s]);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sort_is_stable),
        cmocka_unit_test(scan_is_the_running_sum),
        cmocka_unit_test(sums_do_not_depend_on_threads),
        cmocka_unit_test(ranges_are_half_open),
        cmocka_unit_test(loops_visit_each_item_once),
        cmocka_unit_test(permute_brings_into_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
