/* Irregular waves, focused groups and recorded levels as sums of regular waves (decision 164). Drawback: of
   the first order, so that what components do to one another is left out. */
#include "rigid/wave_sums.h"
#include "rigid/keyframes.h"
#include "rigid/waves.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#define PI 3.14159265358979323846
/* Of the peak frequency: the band that waves have. */
static const double BAND_LOW = 0.5, BAND_HIGH = 3;
/* kh of the shortest waves of a record, where the peak is looked for. */
static const double SHORTEST = 12;
/* Of the frequency: half the width that a spectrum is smoothed over before its peak is taken. */
static const double SMOOTH = 0.05;
/* Of the mean: a level that moves less does not move. */
static const double ROUNDING = 1e-12;
/* Values of a record per period of its shortest wave, in between straight lines. */
enum { VALUES = 16, MOST_WAVES = 10000 };

tobi_wave tobi_wave_make(const tobi_wave_maker_def *d, double amplitude, double period, double phase)
{
    const double k = tobi_waves_number(d->gravity, d->depth, period), omega = 2*PI/period;
    tobi_wave w = { .omega = omega, .k = k, .phase = phase, .level = amplitude };
    w.stroke = amplitude/tobi_waves_per_stroke(k, d->depth, d->flap ? d->hinge_height : INFINITY);
    return w;
}

static tobi_status make_room(tobi_wave **waves, int64_t count, tobi_error *err)
{
    *waves = calloc((size_t)count + 1, sizeof **waves);
    return *waves ? TOBI_OK : tobi_fail(err, TOBI_NO_MEMORY, "no memory for waves");
}

/* --- spectra ----------------------------------------------------------------------------------- */

static uint64_t shuffle(uint64_t *state)        /* splitmix64, Steele et al. 2014 */
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30))*0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27))*0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static double random_share(uint64_t *state) { return (double)(shuffle(state) >> 11)*0x1p-53; }

/* Of JONSWAP, Hasselmann et al. 1973, but for its scale; peakedness 1: Pierson-Moskowitz. */
static double density(const tobi_wave_maker_def *d, double f)
{
    const double r = f/(1/d->peak_period), width = r <= 1 ? 0.07 : 0.09, x = (r - 1)/width;
    const double peakedness = d->spectrum == TOBI_JONSWAP ? d->peakedness : 1;
    return pow(r, -5)*exp(-1.25*pow(r, -4))*pow(peakedness, exp(-0.5*x*x));
}

/* Of each of equal parts of the band, and the middle of one, Hz. */
static double part_width(const tobi_wave_maker_def *d)
{
    return (BAND_HIGH - BAND_LOW)*(1/d->peak_period)/d->components;
}

static double part_middle(const tobi_wave_maker_def *d, int n)
{
    return BAND_LOW*(1/d->peak_period) + (n + 0.5)*part_width(d);
}

/* The integral of the density. */
static double moment(const tobi_wave_maker_def *d)
{
    double sum = 0;
    for (int n = 0; n < d->components; n++) sum += part_width(d)*density(d, part_middle(d, n));
    return sum;
}

/* One component anywhere in each part: the sum does not repeat itself. The scale is that of the significant
   height, 4 sqrt(m0). */
static void make_irregular(const tobi_wave_maker_def *d, tobi_wave *waves)
{
    const double width = part_width(d), scale = d->significant_height*d->significant_height/(16*moment(d));
    uint64_t state = (uint64_t)d->seed;
    for (int n = 0; n < d->components; n++) {
        const double middle = part_middle(d, n), f = middle + (random_share(&state) - 0.5)*width;
        const double amplitude = sqrt(2*scale*width*density(d, middle));
        waves[n] = tobi_wave_make(d, amplitude, 1/f, 2*PI*random_share(&state));
    }
}

/* NewWave, Tromans et al. 1991: amplitudes as the density; all crests meet. */
static void make_focused(const tobi_wave_maker_def *d, tobi_wave *waves)
{
    const double scale = d->focused_height*part_width(d)/moment(d);
    for (int n = 0; n < d->components; n++) {
        const double f = part_middle(d, n);
        waves[n] = tobi_wave_make(d, scale*density(d, f), 1/f, 0);
        waves[n].phase = waves[n].k*d->focus_distance - waves[n].omega*d->focus_time;
    }
}

/* --- records ----------------------------------------------------------------------------------- */

/* The level at equal steps of time, its mean taken out. */
typedef struct record {
    double *level;              /* owned, m */
    int64_t count;
    double start, span;         /* s */
    int lines;                  /* of the Fourier sum: frequencies n/span, n to there */
} record;

static tobi_status size_record(const tobi_wave_maker_def *d, const tobi_keyframes *rows, record *r,
                               tobi_error *err)
{
    double level[3];
    const int64_t last = tobi_keyframes_count(rows) - 1;
    const double k = SHORTEST/d->depth, highest = sqrt(d->gravity*k*tanh(SHORTEST))/(2*PI);
    const double most = d->shortest_period > 0 ? 1/d->shortest_period : highest;
    r->start = tobi_keyframes_row(rows, 0, level);
    r->span = tobi_keyframes_row(rows, last, level) - r->start;
    if (!(r->span*most >= 2))
        return tobi_fail(err, TOBI_INVALID, "%s: its %g s are less than two periods of the shortest "
                         "wave, %.3g s", d->record_file, r->span, 1/most);
    if (r->span*most > MOST_WAVES)
        return tobi_fail(err, TOBI_INVALID, "%s: its %g s have more than %d regular waves down to a period "
                         "of %.3g s; give a greater shortest_period, or a part of the record", d->record_file,
                         r->span, MOST_WAVES, 1/most);
    r->lines = (int)(r->span*most);
    r->count = (int64_t)VALUES*r->lines;
    return TOBI_OK;
}

static tobi_status read_record(const tobi_wave_maker_def *d, record *r, tobi_error *err)
{
    tobi_keyframes *rows;
    double mean = 0, most = 0, turn[3][3];
    TOBI_TRY(tobi_keyframes_load_levels(d->record_file, d->record_column, &rows, err));
    tobi_status status = size_record(d, rows, r, err);
    if (status == TOBI_OK) r->level = calloc((size_t)r->count, sizeof *r->level);
    if (status == TOBI_OK && !r->level) status = tobi_fail(err, TOBI_NO_MEMORY, "no memory for waves");
    for (int64_t i = 0; status == TOBI_OK && i < r->count; i++) {
        double level[3];
        tobi_keyframes_pose(rows, r->start + r->span*(double)i/(double)r->count, level, turn);
        r->level[i] = level[0];
        mean += level[0]/(double)r->count;
    }
    for (int64_t i = 0; status == TOBI_OK && i < r->count; i++) {
        r->level[i] -= mean;
        most = fmax(most, fabs(r->level[i]));
    }
    tobi_keyframes_free(rows);
    if (status != TOBI_OK || most > ROUNDING*fabs(mean)) return status;
    return tobi_fail(err, TOBI_INVALID, "%s: its level does not change", d->record_file);
}

/* Amplitude and phase of a line at time 0: level = a cos(omega t + phase). */
static void analyse_line(const record *r, int n, double *amplitude, double *phase)
{
    const double step = 2*PI*n/(double)r->count, turn[2] = { cos(step), sin(step) };
    double c = 1, s = 0, even = 0, odd = 0;
    for (int64_t i = 0; i < r->count; i++) {
        even += r->level[i]*c;
        odd += r->level[i]*s;
        const double next = c*turn[0] - s*turn[1];
        s = s*turn[0] + c*turn[1];
        c = next;
    }
    *amplitude = 2*hypot(even, odd)/(double)r->count;
    *phase = atan2(-odd, even) - 2*PI*n*r->start/r->span;
}

/* Of the spectrum smoothed over a tenth. */
static int find_peak(const double *amplitude, int lines)
{
    double most = 0;
    int peak = 1;
    for (int n = 1; n <= lines; n++) {
        double sum = 0;
        const int reach = (int)(SMOOTH*n);
        for (int m = n - reach; m <= n + reach && m <= lines; m++) sum += amplitude[m]*amplitude[m];
        sum /= 2*reach + 1;
        if (sum > most) most = sum, peak = n;
    }
    return peak;
}

static tobi_status choose_waves(const tobi_wave_maker_def *d, const record *r, const double *amplitude,
                                const double *phase, tobi_wave **waves, int *count, double *period,
                                tobi_error *err)
{
    const int peak = find_peak(amplitude, r->lines);
    const double low = d->longest_period > 0 ? 1/d->longest_period : BAND_LOW*peak/r->span;
    const double high = d->shortest_period > 0 ? 1/d->shortest_period : BAND_HIGH*peak/r->span;
    TOBI_TRY(make_room(waves, r->lines, err));
    for (int n = 1; n <= r->lines; n++) {
        const double f = n/r->span;
        if (f < low*(1 - 1e-9) || f > high*(1 + 1e-9)) continue;
        tobi_wave *w = &(*waves)[(*count)++];
        *w = tobi_wave_make(d, amplitude[n], 1/f, phase[n]);
        w->phase += w->k*d->record_distance;
    }
    *period = r->span/peak;
    if (*count) return TOBI_OK;
    return tobi_fail(err, TOBI_INVALID, "%s: no wave of its %g s has a period between shortest_period, "
                     "%.4g s, and longest_period, %.4g s", d->record_file, r->span, 1/high, 1/low);
}

static tobi_status make_recorded(const tobi_wave_maker_def *d, tobi_wave **waves, int *count, double *period,
                                 tobi_error *err)
{
    record r = { 0 };
    tobi_status status = read_record(d, &r, err);
    double *amplitude = status == TOBI_OK ? calloc(2*((size_t)r.lines + 1), sizeof *amplitude) : NULL;
    if (status == TOBI_OK && !amplitude) status = tobi_fail(err, TOBI_NO_MEMORY, "no memory for waves");
    if (status == TOBI_OK) {
        double *phase = amplitude + r.lines + 1;
        for (int n = 1; n <= r.lines; n++) analyse_line(&r, n, &amplitude[n], &phase[n]);
        status = choose_waves(d, &r, amplitude, phase, waves, count, period, err);
    }
    free(amplitude);
    free(r.level);
    return status;
}

tobi_status tobi_wave_sum(const tobi_wave_maker_def *d, tobi_wave **waves, int *count, double *period,
                          tobi_error *err)
{
    *waves = NULL;
    *count = 0;
    *period = d->height > 0 ? d->period : 0;
    if (d->record_file) {
        const tobi_status status = make_recorded(d, waves, count, period, err);
        if (status == TOBI_OK) return TOBI_OK;
        free(*waves);
        *waves = NULL;
        return status;
    }
    const int several = d->significant_height > 0 || d->focused_height > 0;
    if (several) *period = d->peak_period;
    TOBI_TRY(make_room(waves, several ? d->components : d->height > 0, err));
    *count = several ? d->components : d->height > 0;
    if (d->significant_height > 0) make_irregular(d, *waves);
    else if (d->focused_height > 0) make_focused(d, *waves);
    else if (*count) **waves = tobi_wave_make(d, 0.5*d->height, d->period, d->phase*(PI/180));
    return TOBI_OK;
}
