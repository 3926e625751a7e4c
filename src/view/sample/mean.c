/* Means over outputs, updated output by output (Welford 1962), so that no output is kept and close numbers
   lose no digits. Drawback: outputs count the same however far apart they are. */
#include "view/sample/sample.h"
#include <inttypes.h>
#include <stdlib.h>

enum { MOST = 9 };

struct tobi_sample_mean {
    int64_t places, outputs;
    int components, products, threads;
    int32_t *wet;                /* outputs at which a place was wet        */
    double *average, *square;    /* square: sums of products of fluctuations */
};

tobi_status tobi_sample_mean_create(int64_t place_count, int components, int threads, tobi_sample_mean **mean,
                                    tobi_error *err)
{
    TOBI_NEED(mean, "the place for the means");
    *mean = NULL;
    if (components < 1 || components > MOST)
        return tobi_fail(err, TOBI_INVALID, "sample: means of %d components, allowed are 1 to %d", components,
                         MOST);
    if (place_count < 0 || place_count > INT32_MAX - 1)
        return tobi_fail(err, TOBI_INVALID, "sample: %" PRId64 " places, allowed are 0 to %d", place_count,
                         INT32_MAX - 1);
    tobi_exec exec;
    TOBI_TRY(tobi_exec_init(&exec, threads, err));
    tobi_sample_mean *m = calloc(1, sizeof *m);
    if (m) {
        *m = (tobi_sample_mean){ .places = place_count, .components = components, .threads = exec.threads,
                                 .products = components*(components + 1)/2 };
        m->wet = tobi_array_zero(place_count + 1, sizeof *m->wet);
        m->average = tobi_array_zero(place_count*components + 1, sizeof *m->average);
        m->square = tobi_array_zero(place_count*m->products + 1, sizeof *m->square);
    }
    tobi_exec_free(&exec);
    if (m && m->wet && m->average && m->square) return *mean = m, TOBI_OK;
    tobi_sample_mean_free(m);
    return tobi_fail(err, TOBI_NO_MEMORY, "sample: out of memory");
}

void tobi_sample_mean_free(tobi_sample_mean *m)
{
    if (!m) return;
    tobi_array_free(m->wet);
    tobi_array_free(m->average);
    tobi_array_free(m->square);
    free(m);
}

typedef struct mean_view {
    const tobi_sample_mean *m;
    const uint8_t *wet;
    const double *values;
    double *share, *average, *rms, *products;
} mean_view;

static void add_output(const void *view, int64_t begin, int64_t end)
{
    const mean_view *v = view;
    const tobi_sample_mean *m = v->m;
    const int n = m->components;
    for (int64_t i = begin; i < end; i++) {
        double from[MOST], *average = m->average + n*i, *square = m->square + m->products*i;
        const double *x = v->values + n*i;
        if (!v->wet[i]) continue;
        m->wet[i]++;
        for (int k = 0; k < n; k++) {
            from[k] = x[k] - average[k];
            average[k] += from[k]/m->wet[i];
        }
        for (int k = 0; k < n; k++)
            for (int l = k; l < n; l++) *square++ += from[k]*(x[l] - average[l]);
    }
}

tobi_status tobi_sample_mean_add(tobi_sample_mean *mean, const uint8_t *wet, const double *values,
                                 tobi_error *err)
{
    TOBI_NEED(mean, "the means");
    TOBI_NEED(wet, "wet");
    TOBI_NEED(values, "the values");
    const mean_view v = { .m = mean, .wet = wet, .values = values };
    tobi_loop(mean->threads, mean->places, 0, add_output, &v);
    mean->outputs++;
    return TOBI_OK;
}

static void read_places(const void *view, int64_t begin, int64_t end)
{
    const mean_view *v = view;
    const tobi_sample_mean *m = v->m;
    const int n = m->components;
    for (int64_t i = begin; i < end; i++) {
        const double *square = m->square + m->products*i, none = m->wet[i] ? 0 : NAN;
        const double count = m->wet[i] ? m->wet[i] : 1;
        if (v->share) v->share[i] = m->outputs ? m->wet[i]/(double)m->outputs : 0;
        for (int k = 0, p = 0; k < n; p += n - k, k++) {
            if (v->average) v->average[n*i + k] = m->average[n*i + k] + none;
            if (v->rms) v->rms[n*i + k] = sqrt(fmax(0, square[p])/count) + none;
        }
        for (int p = 0; v->products && p < m->products; p++)
            v->products[m->products*i + p] = square[p]/count + none;
    }
}

tobi_status tobi_sample_mean_read(const tobi_sample_mean *mean, double *share, double *average, double *rms,
                                  double *products, tobi_error *err)
{
    TOBI_NEED(mean, "the means");
    const mean_view v = { .m = mean, .share = share, .average = average, .rms = rms, .products = products };
    tobi_loop(mean->threads, mean->places, 0, read_places, &v);
    return TOBI_OK;
}
