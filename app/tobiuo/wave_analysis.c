/* Spectra by direct sums, at whole multiples of one over the record: rows need not be a power of two, and
   only the frequencies of waves are summed. Drawback: the time grows as the square of the record. */
#include "wave_analysis.h"
#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double TURN = 6.283185307179586;
static const double BAND = 0.1;        /* of the peak frequency: over so much a spectrum is averaged    */
static const double GAIN_BAND = 0.2;   /* and a gain                                                     */
/* Of the peak frequency, what is split: twice the peak are crests, which move with their wave. */
static const double LOWEST = 0.5, HIGHEST = 1.8;
static const double FAINT = 0.05;      /* of the highest density of waves: below it no gain is told        */
static const int FEW = 3;              /* frequencies: of fewer the coherence is 1 whatever the records    */
static const double SEEN = 0.1;        /* least 1 - |sum e^2ikx|^2/n^2: of two gauges 0.05 to 0.45 lengths */

double wave_length(double frequency, double depth, double gravity)
{
    const double deep = TURN*TURN*frequency*frequency*depth/gravity;
    double kh = deep > 1 ? deep : sqrt(deep);
    for (int k = 0; k < 50; k++) {
        const double t = tanh(kh), slope = t + kh*(1 - t*t);
        kh -= (kh*t - deep)/slope;
    }
    return TURN*depth/kh;
}

/* The amplitude of a frequency: eta = Re(a e^(i 2 pi f t)). hann: weighted, against leaks to others. */
static double complex find_amplitude(const double *eta, size_t count, double turns, int hann)
{
    const double complex turn = cexp(-I*TURN*turns);
    double complex sum = 0, phase = 1;
    for (size_t n = 0; n < count; n++) {
        if (n%256 == 0) phase = cexp(-I*TURN*fmod(turns*(double)n, 1));
        sum += (hann ? 1 - cos(TURN*((double)n + 0.5)/(double)count) : 1)*eta[n]*phase;
        phase *= turn;
    }
    return 2*sum/(double)count;
}

/* Less its mean and its trend; returns the mean. */
static double level_out(double *eta, size_t count)
{
    const double middle = 0.5*((double)count - 1);
    double mean = 0, slope = 0, square = 0;
    for (size_t n = 0; n < count; n++) mean += eta[n]/(double)count;
    for (size_t n = 0; n < count; n++) {
        slope += ((double)n - middle)*(eta[n] - mean);
        square += ((double)n - middle)*((double)n - middle);
    }
    slope /= square > 0 ? square : 1;
    for (size_t n = 0; n < count; n++) eta[n] -= mean + slope*((double)n - middle);
    return mean;
}

static size_t count_crossings(const double *eta, size_t count)
{
    size_t crossings = 0;
    for (size_t n = 1; n < count; n++) crossings += eta[n - 1] < 0 && eta[n] >= 0;
    return crossings;
}

/* Of all gauges together, at a share of the frequency of the rows. */
static double find_power(const wave_set *s, double turns)
{
    double power = 0;
    for (int g = 0; g < s->gauges; g++) {
        const double size = cabs(find_amplitude(s->gauge[g].eta, s->count, turns, 1));
        power += size*size;
    }
    return power;
}

/* The frequency of the highest peak, in turns from row to row: first at all multiples of one over the record,
   then finer beside the best. */
static double find_peak(const wave_set *s)
{
    enum { FINE = 16 };
    const double bin = 1/(double)s->count;
    size_t best = 1;
    double most = -1, peak = bin;
    for (size_t k = 1; k <= s->bins; k++) {
        const double power = find_power(s, (double)k*bin);
        if (power > most) most = power, best = k;
    }
    most = -1;
    for (int n = -FINE; n <= FINE; n++) {
        const double turns = ((double)best + (double)n/FINE)*bin;
        const double power = turns > 0 ? find_power(s, turns) : -1;
        if (power > most) most = power, peak = turns;
    }
    const double before = find_power(s, peak - bin/FINE), after = find_power(s, peak + bin/FINE);
    const double bend = before - 2*most + after;      /* of the parabola through the best three */
    return bend < 0 ? peak + 0.5*bin/FINE*(before - after)/bend : peak;
}

static int fall(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return x > y ? -1 : x < y;
}

static void sum_up(double *height, int waves, double span, wave_heights *out)
{
    const int highest = waves >= 3 ? waves/3 : 1;
    double sum = 0, third = 0;
    *out = (wave_heights){ waves, NAN, NAN, NAN, NAN, NAN };
    if (waves == 0) return;
    qsort(height, (size_t)waves, sizeof *height, fall);
    for (int k = 0; k < waves; k++) sum += height[k], third += k < highest ? height[k] : 0;
    *out = (wave_heights){ waves, sum/waves, third/highest, height[0], height[waves - 1], span/waves };
}

int wave_find_heights(const double *time, const double *eta, size_t count, double half, wave_heights *out)
{
    double *height = calloc(count_crossings(eta, count) + 1, sizeof *height);
    double first = NAN, last = NAN, crossing = NAN, high = -INFINITY, low = INFINITY;
    int waves = 0, below = 0;
    if (!height) return -1;
    for (size_t n = 1; n < count; n++) {
        const double t0 = time ? time[n - 1] : (double)n - 1, t1 = time ? time[n] : (double)n;
        if (eta[n - 1] < 0 && eta[n] >= 0) crossing = t0 + (t1 - t0)*eta[n - 1]/(eta[n - 1] - eta[n]);
        high = fmax(high, eta[n]), low = fmin(low, eta[n]);
        below |= eta[n] < -half;
        if (!below || isnan(crossing) || !(eta[n] > half)) continue;
        last = crossing;
        if (isnan(first)) first = last;
        else height[waves++] = high - low;
        below = 0;
        high = low = eta[n];
    }
    sum_up(height, waves, last - first, out);
    free(height);
    return 0;
}

/* Ripples of a hundredth of the waves do not make two of one. */
static int measure_heights(wave_gauge *g, size_t count, double step)
{
    wave_heights h;
    if (wave_find_heights(NULL, g->eta, count, 0.01*g->height_m0, &h) != 0) return -1;
    g->waves = h.waves;
    g->height_max = h.waves > 2 ? h.most : NAN;
    g->height_third = h.waves > 2 ? h.third : NAN;
    g->mean_period = step*h.period;
    return 0;
}

/* Frequencies on each side of one that are averaged. */
static size_t half_band(const wave_set *s, double band)
{
    return (size_t)fmax(0, 0.5*(band*s->peak*(double)s->count*s->step - 1));
}

/* The spectrum, averaged over BAND, and its periods. */
static int measure_spectrum(const wave_set *s, wave_gauge *g)
{
    const double bin = 1/((double)s->count*s->step);
    const size_t half = half_band(s, BAND);
    double *raw = calloc(s->bins + 1, sizeof *raw), most = -1, sum = 0, over = 0;
    g->density = calloc(s->bins + 1, sizeof *g->density);
    if (!raw || !g->density) return free(raw), -1;
    for (size_t k = 1; k <= s->bins; k++) {
        const double size = cabs(find_amplitude(g->eta, s->count, (double)k/(double)s->count, 0));
        raw[k] = 0.5*size*size/bin;
        if ((double)k*bin < 0.3*s->peak) continue;
        sum += raw[k];
        over += raw[k]/((double)k*bin);
    }
    for (size_t k = 1; k <= s->bins; k++) {
        const size_t from = k > half ? k - half : 1, to = k + half < s->bins ? k + half : s->bins;
        double mean = 0;
        for (size_t n = from; n <= to; n++) mean += raw[n]/(double)(to - from + 1);
        g->density[k - 1] = mean;
        if (mean > most) most = mean, g->peak_period = 1/((double)k*bin);
    }
    g->energy_period = sum > 0 ? over/sum : NAN;
    free(raw);
    return 0;
}

/* Frequencies up to five times that of the crossings, or half of that of the rows. */
static void set_bins(wave_set *s)
{
    size_t waves = 0;
    for (int g = 0; g < s->gauges; g++) {
        const size_t of = count_crossings(s->gauge[g].eta, s->count);
        if (of > waves) waves = of;
    }
    s->bins = 5*waves < s->count/2 ? 5*waves : s->count/2;
}

int wave_measure_record(const wave_set *s, wave_gauge *g)
{
    double square = 0;
    g->mean += level_out(g->eta, s->count);
    for (size_t n = 0; n < s->count; n++) square += g->eta[n]*g->eta[n]/(double)s->count;
    g->height_m0 = 4*sqrt(square);
    return measure_heights(g, s->count, s->step) != 0 || measure_spectrum(s, g) != 0 ? -1 : 0;
}

int wave_measure(wave_set *s)
{
    for (int g = 0; g < s->gauges; g++) s->gauge[g].mean = level_out(s->gauge[g].eta, s->count);
    set_bins(s);
    if (s->bins == 0) return 1;
    const double turns = find_peak(s);
    const size_t whole = (size_t)(floor((double)s->count*turns + 1e-6)/turns + 0.5);
    if (whole < 4 || whole > s->count) return 1;
    const size_t cut = s->count - whole;
    s->begin += (double)cut*s->step;
    s->count = whole;
    s->peak = turns/s->step;
    set_bins(s);
    for (int k = 0; k < s->gauges; k++) {
        wave_gauge *g = &s->gauge[k];
        memmove(g->eta, g->eta + cut, whole*sizeof *g->eta);
        if (wave_measure_record(s, g) != 0) return -1;
    }
    return 0;
}

/* Amplitudes at the first gauge of both waves of one frequency, and the mean square at the gauges; 0: the
   gauges cannot tell them apart. */
static int split_bin(const wave_set *s, const int *gauges, const double *at, int count, size_t bin,
                     double complex both[2], double *square)
{
    const double frequency = (double)bin/((double)s->count*s->step);
    const double k = TURN/wave_length(frequency, s->depth, s->gravity), n = count;
    double complex twice = 0, forward = 0, back = 0;
    *square = 0;
    for (int g = 0; g < count; g++) {
        const double complex a = find_amplitude(s->gauge[gauges[g]].eta, s->count,
                                                (double)bin/(double)s->count, 0);
        twice += cexp(2*I*k*at[g]);
        forward += a*cexp(I*k*at[g]);
        back += a*cexp(-I*k*at[g]);
        *square += cabs(a)*cabs(a)/n;
    }
    const double det = n*n - cabs(twice)*cabs(twice);
    if (det < SEEN*n*n) return 0;
    both[0] = (n*forward - twice*back)/det;
    both[1] = (n*back - conj(twice)*forward)/det;
    return 1;
}

static int is_split(const wave_set *s, size_t bin)
{
    const double frequency = (double)bin/((double)s->count*s->step);
    return frequency >= LOWEST*s->peak && frequency <= HIGHEST*s->peak;
}

int wave_split(const wave_set *s, const int *gauges, const double *at, int count, wave_group *out)
{
    double sum[3] = { 0 }, all = 0, square;
    double complex both[2];
    for (size_t k = 1; k <= s->bins; k++) {
        if (!is_split(s, k) || !split_bin(s, gauges, at, count, k, both, &square)) continue;
        for (int n = 0; n < 2; n++) sum[n] += 0.5*cabs(both[n])*cabs(both[n]);
        sum[2] += 0.5*square;
    }
    for (int g = 0; g < count; g++) all += pow(s->gauge[gauges[g]].height_m0/4, 2)/count;
    if (!(sum[2] > 0 && all > 0)) return 1;
    out->resolved = sum[2]/all;
    out->forward = 4*sqrt(sum[0]/out->resolved);
    out->back = 4*sqrt(sum[1]/out->resolved);
    return 0;
}

void wave_find_incident(const wave_set *s, const int *gauges, const double *at, int count,
                        double complex *amplitude)
{
    double complex both[2];
    double square;
    for (size_t k = 1; k <= s->bins; k++) {
        amplitude[k - 1] = NAN;
        if (!is_split(s, k)) continue;
        if (count == 1)
            amplitude[k - 1] = find_amplitude(s->gauge[gauges[0]].eta, s->count,
                                              (double)k/(double)s->count, 0);
        else if (split_bin(s, gauges, at, count, k, both, &square))
            amplitude[k - 1] = both[0];
    }
}

/* Sums over the frequencies beside one. */
typedef struct band_sums {
    double waves, record;
    double complex both;
    int count;
} band_sums;

static band_sums sum_band(const wave_set *s, size_t bin, const double complex *waves,
                          const double complex *record)
{
    const size_t half = half_band(s, GAIN_BAND), from = bin > half ? bin - half : 1;
    band_sums b = { 0, 0, 0, 0 };
    for (size_t n = from; n <= bin + half && n <= s->bins; n++) {
        const double complex f = waves[n - 1], r = record[n - 1];
        if (isnan(creal(f))) continue;
        b.waves += creal(f*conj(f));
        b.record += creal(r*conj(r));
        b.both += r*conj(f);
        b.count++;
    }
    return b;
}

int wave_find_gains(const wave_set *s, const wave_gauge *record, const double complex *waves, double way,
                    wave_gain *gain)
{
    double complex *own = calloc(2*(s->bins + 1), sizeof *own), *there = own ? own + s->bins : NULL;
    double most = 0;
    if (!own) return -1;
    for (size_t k = 1; k <= s->bins; k++) {
        const double length = wave_length((double)k/((double)s->count*s->step), s->depth, s->gravity);
        own[k - 1] = find_amplitude(record->eta, s->count, (double)k/(double)s->count, 0);
        there[k - 1] = waves[k - 1]*cexp(-I*TURN*way/length);
    }
    for (size_t k = 1; k <= s->bins; k++) most = fmax(most, sum_band(s, k, there, own).waves);
    for (size_t k = 1; k <= s->bins; k++) {
        const band_sums b = sum_band(s, k, there, own);
        gain[k - 1] = (wave_gain){ NAN, NAN, NAN };
        if (isnan(creal(waves[k - 1])) || !(b.waves > FAINT*most)) continue;
        gain[k - 1].gain = sqrt(b.record/b.waves);
        if (!(b.record > 0)) continue;
        gain[k - 1].phase = 360/TURN*carg(b.both);
        if (b.count >= FEW) gain[k - 1].coherence = creal(b.both*conj(b.both))/(b.waves*b.record);
    }
    free(own);
    return 0;
}

void wave_set_free(wave_set *s)
{
    for (int g = 0; s->gauge && g < s->gauges; g++) {
        free(s->gauge[g].eta);
        free(s->gauge[g].density);
    }
    free(s->gauge);
    *s = (wave_set){ 0 };
}
