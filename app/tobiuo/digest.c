/* What a column of a table comes to: its mean over time, its extremes, its end. Reports and sweeps tell them.
   Drawback: an extreme between two rows is not seen. */
#include "digest.h"
#include "app.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

int digest_belongs(const table *t, const char *name, size_t row)
{
    const int column = name ? table_column(t, "name") : -1;
    return !name || (column >= 0 && strcmp(t->cells[row*(size_t)t->columns + (size_t)column], name) == 0);
}

static int find_time(const table *t)
{
    const int column = table_column(t, "time");
    return column >= 0 ? column : table_column(t, "time [s]");
}

/* The mean is over time: by trapezia, or for columns that are means since the row before, by that time. */
digest digest_column(const table *t, const char *name, int first, int second, double from)
{
    digest d = { .last = NAN, .mean = NAN, .low = INFINITY, .high = -INFINITY };
    const int time = find_time(t), of_outputs = strncmp(t->names[first], "mean_", 5) == 0;
    double sum = 0, span = 0, before = NAN, value_before = NAN;
    for (size_t i = 0; i < t->rows; i++) {
        const double at = table_number(t, i, time);
        const double value = table_number(t, i, first) + (second >= 0 ? table_number(t, i, second) : 0);
        if (!digest_belongs(t, name, i) || isnan(at) || isnan(value)) continue;
        d.last = value;
        if (at < from) continue;
        if (value < d.low) d.low = value, d.low_time = at;
        if (value > d.high) d.high = value, d.high_time = at;
        if (at > before) {
            sum += (at - before)*(of_outputs ? value : 0.5*(value + value_before));
            span += at - before;
        }
        before = at;
        value_before = value;
        d.rows++;
    }
    d.mean = span > 0 ? sum/span : d.last;
    return d;
}

void digest_add_power(table *t)
{
    const int work = table_column(t, "motion_work"), name = table_column(t, "name");
    if (work < 0 || name < 0) return;
    const int time = find_time(t);
    double *power = calloc(t->rows + 1, sizeof *power);
    if (!power) exit(complain("out of memory"));
    size_t bodies = 1;                      /* rows of an output, the bodies in the same order in each */
    while (bodies < t->rows && !digest_belongs(t, t->cells[name], bodies)) bodies++;
    for (size_t i = bodies; i < t->rows; i++) {
        const double span = table_number(t, i, time) - table_number(t, i - bodies, time);
        if (span > 0) power[i] = (table_number(t, i, work) - table_number(t, i - bodies, work))/span;
    }
    table_add_column(t, "mean_motion_power", power);
    free(power);
}
