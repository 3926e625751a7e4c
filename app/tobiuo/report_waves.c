/* Waves at the level sensors of a run, by zero up-crossings of the level about its mean. Drawback: waves
   smaller than a fifth of a spacing count as rest. */
#include "report.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Spacings: least height of a wave. */
static const double LEAST = 0.2;

/* height: owned; first, last: s, when the first began and the last ended. */
typedef struct wave_sum { size_t count, room; double *height; double first, last; } wave_sum;

static int compare_down(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x < y) - (x > y);
}

static double mean_level(const table *t, int time, int level, double from)
{
    double sum = 0, span = 0;
    for (size_t i = 1; i < t->rows; i++) {
        const double now = table_number(t, i, time), dt = now - table_number(t, i - 1, time);
        const double both = 0.5*(table_number(t, i, level) + table_number(t, i - 1, level));
        if (table_number(t, i - 1, time) < from || !(dt > 0) || isnan(both)) continue;
        sum += dt*both;
        span += dt;
    }
    return span > 0 ? sum/span : NAN;
}

static int add_wave(wave_sum *w, double end, double height)
{
    if (w->count == w->room) {
        double *more = realloc(w->height, (2*w->room + 64)*sizeof *more);
        if (!more) return 0;
        w->height = more;
        w->room = 2*w->room + 64;
    }
    w->height[w->count++] = height;
    w->last = end;
    return 1;
}

/* Whole waves from `from` on. A crossing is where the line between two rows is; it counts when the level has
   been as far below the mean as above it, `half`. */
static wave_sum find_waves(const table *t, int time, int level, double from, double half)
{
    wave_sum w = { .first = NAN };
    const double mean = mean_level(t, time, level, from);
    double low = INFINITY, high = -INFINITY, crossing = NAN;
    int below = 0;
    for (size_t i = 1; i < t->rows; i++) {
        const double t0 = table_number(t, i - 1, time), t1 = table_number(t, i, time);
        const double a = table_number(t, i - 1, level) - mean, b = table_number(t, i, level) - mean;
        if (!(t0 >= from) || isnan(a) || isnan(b)) continue;
        if (a < 0 && b >= 0) crossing = t0 + (t1 - t0)*a/(a - b);
        low = fmin(low, b), high = fmax(high, b);
        below |= b < -half;
        if (!(b > half) || !below || isnan(crossing)) continue;
        if (isnan(w.first)) w.first = crossing;
        else if (!add_wave(&w, crossing, high - low)) return w;
        below = 0;
        low = high = b;
    }
    return w;
}

static void write_row(const report *r, const char *name, wave_sum *w)
{
    double sum = 0, third = 0;
    const size_t highest = (w->count + 2)/3;
    qsort(w->height, w->count, sizeof *w->height, compare_down);
    for (size_t k = 0; k < w->count; k++) {
        sum += w->height[k];
        if (k < highest) third += w->height[k];
    }
    fputs("<tr><td>", r->file);
    html_text(r->file, name);
    fprintf(r->file, "<td>%zu<td>%.4g<td>%.4g<td>%.4g<td>%.4g<td>%.4g<td class=doc>\n", w->count,
            (w->last - w->first)/(double)w->count, sum/(double)w->count, third/(double)highest,
            w->height[0], w->height[w->count - 1]);
}

void write_waves(const report *r)
{
    const json_t *probes = report_value(r, "probes"), *probe;
    const int time = table_column(&r->probes, "time");
    char column[300];
    int begun = 0;
    for (size_t k = 0; time >= 0 && (probe = json_array_get(probes, k)); k++) {
        const char *name = json_string_value(json_object_get(probe, "name"));
        const char *kind = json_string_value(json_object_get(probe, "kind"));
        if (!name || !kind || strcmp(kind, "level") != 0) continue;
        snprintf(column, sizeof column, "%s_level", name);
        const int level = table_column(&r->probes, column);
        if (level < 0) continue;
        wave_sum w = find_waves(&r->probes, time, level, r->from, 0.5*LEAST*r->spacing);
        if (w.count > 1 && !begun++)
            fputs("<h3>Waves at level sensors</h3>\n<div class=wide><table><tr><th>probe<th>waves"
                  "<th>mean period, s<th>mean height, m<th>highest third, m<th>highest, m<th>lowest, m"
                  "<th class=doc>\n", r->file);
        if (w.count > 1) write_row(r, name, &w);
        free(w.height);
    }
    if (begun) fputs("</table></div>\n<p>A wave is from one rise of the level through its mean to the next; "
                     "its height is from trough to crest.</p>\n", r->file);
}
