/* Waves at the level sensors of a run, by crossings upwards of the mean level. Drawback: waves smaller than a
   fifth of a spacing count as rest; "tobiuo waves" has spectra, and the waves that come back. */
#include "report.h"
#include "wave_analysis.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Spacings: least height of a wave. */
static const double LEAST = 0.2;

/* The level less its mean over time, from `from` on, with its times; the number of rows. */
static size_t take_level(const table *t, int column, double from, double *time, double *eta)
{
    const int clock = table_column(t, "time");
    double sum = 0;
    size_t count = 0;
    for (size_t i = 0; i < t->rows; i++) {
        const double at = table_number(t, i, clock), level = table_number(t, i, column);
        if (!(at >= from) || isnan(level) || (count > 0 && !(at > time[count - 1]))) continue;
        if (count > 0) sum += 0.5*(at - time[count - 1])*(level + eta[count - 1]);
        time[count] = at;
        eta[count++] = level;
    }
    const double mean = count > 1 ? sum/(time[count - 1] - time[0]) : 0;
    for (size_t n = 0; n < count; n++) eta[n] -= mean;
    return count;
}

static wave_heights find_waves(const report *r, int column)
{
    wave_heights h = { 0 };
    double *time = malloc((r->probes.rows + 1)*sizeof *time), *eta = malloc((r->probes.rows + 1)*sizeof *eta);
    const size_t count = time && eta ? take_level(&r->probes, column, r->from, time, eta) : 0;
    if (!time || !eta || wave_find_heights(time, eta, count, 0.5*LEAST*r->spacing, &h) != 0)
        complain("out of memory");
    free(time);
    free(eta);
    return h;
}

static void write_head(const report *r)
{
    static const char *const heads[] = {
        TEXT("probe"), TEXT("number of waves"), TEXT("mean period, s"), TEXT("mean height, m"),
        TEXT("highest third, m"), TEXT("highest, m"), TEXT("lowest, m"), "", NULL };
    fprintf(r->file, "<h3>%s</h3>\n<div class=wide><table><tr>", tr("Waves at level sensors"));
    html_heads(r->file, heads);
    fputc('\n', r->file);
}

static void write_row(const report *r, const char *name, const wave_heights *h)
{
    fputs("<tr><td>", r->file);
    html_text(r->file, name);
    fprintf(r->file, "<td>%d<td>%.4g<td>%.4g<td>%.4g<td>%.4g<td>%.4g<td class=doc>\n", h->waves, h->period,
            h->mean, h->third, h->most, h->least);
}

void write_waves(const report *r)
{
    const json_t *probes = report_value(r, "probes"), *probe;
    char name[300];
    int begun = 0;
    for (size_t k = 0; r->probes.columns > 0 && (probe = json_array_get(probes, k)); k++) {
        const char *own = json_string_value(json_object_get(probe, "name"));
        const char *kind = json_string_value(json_object_get(probe, "kind"));
        if (!own || !kind || strcmp(kind, "level") != 0) continue;
        snprintf(name, sizeof name, "%s_level", own);
        const int column = table_column(&r->probes, name);
        const wave_heights h = column >= 0 ? find_waves(r, column) : (wave_heights){ 0 };
        if (h.waves < 2) continue;
        if (!begun++)
            write_head(r);
        write_row(r, own, &h);
    }
    if (begun)
        fprintf(r->file, "</table></div>\n<p>%s</p>\n",
                tr("A wave is from one rise of the level through its mean to the next; its height is from "
                   "trough to crest. <code>tobiuo waves</code> has spectra, and the waves that come back."));
}
