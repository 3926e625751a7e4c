/* Waves at gauges: heights, periods, spectra; and of a group of gauges the waves that go on and those that
   come back. Records are evenly spaced in time and about their mean. */
#pragma once
#include <complex.h>
#include <stddef.h>

typedef struct wave_gauge {
    const char *name;               /* borrowed                                                  */
    int    column;                  /* of the caller's table                                     */
    double place[3];                /* m                                                         */
    double *eta;                    /* owned, m: level less its mean and trend                   */
    double mean;                    /* m, of the level                                           */
    double height_m0;               /* m: 4 standard deviations                                  */
    double height_third, height_max;        /* m, between crossings upwards of the mean; NaN: fewer than 3 */
    double peak_period, mean_period, energy_period;     /* s: of the spectrum, of the crossings, m-1/m0   */
    int    waves;                   /* whole ones                                                */
    double *density;                /* owned, m2/Hz, of wave_set.bins frequencies                */
} wave_gauge;

/* All gauges of a run in one span of time, which holds whole periods of the highest peak. */
typedef struct wave_set {
    wave_gauge *gauge;              /* owned                                                     */
    int    gauges;
    size_t count, bins;             /* values of a record; frequencies k/(count*step), k from 1  */
    double begin, step;             /* s                                                         */
    double peak;                    /* Hz, of all gauges together                                */
    double gravity, depth;          /* m/s2, m                                                   */
} wave_set;

/* What goes on from the first gauge towards the last, and what comes back. */
typedef struct wave_group {
    double forward, back;           /* m: 4 standard deviations; what is not resolved is shared alike */
    double resolved;                /* share of the variance that the gauges can tell apart      */
} wave_group;

/* Waves from crossing upwards to crossing upwards of 0; heights in the unit of eta. */
typedef struct wave_heights {
    int    waves;                   /* whole ones; without one the rest is NaN                   */
    double mean, third, most, least;        /* of all, of the highest third, one at least        */
    double period;                  /* mean time                                                 */
} wave_heights;

/* time: rises; NULL: rows are 1 apart. A crossing counts when the level has been below -half before it and
   above half after it. -1: no memory. */
int wave_find_heights(const double *time, const double *eta, size_t count, double half, wave_heights *out);
/* Cuts the start of the records to whole periods, takes mean and trend out, and measures each gauge. eta
   holds levels before. -1: no memory; 1: there is less than one wave. */
int wave_measure(wave_set *s);
/* Least squares at each frequency (Mansard & Funke 1980, Zelt & Skjelbreia 1992; of two gauges Goda & Suzuki
   1976). at: ways of the gauges along the waves, m. 1: the gauges tell waves of no frequency apart. */
int wave_split(const wave_set *s, const int *gauges, const double *at, int count, wave_group *out);
/* How a record follows the waves at one frequency; NaN: the waves are too low there, or not told apart. */
typedef struct wave_gain {
    double gain;                    /* unit of the record per m                                  */
    double phase;                   /* degrees before the crest                                  */
    double coherence;               /* 0 to 1: share that is linear in the waves; NaN: of a short record */
} wave_gain;

/* A record of another thing than a level, in any unit, at the times of the set after wave_measure. -1: no
   memory. */
int wave_measure_record(const wave_set *s, wave_gauge *record);
/* Amplitudes a of the waves that go on, Re(a e^(i 2 pi f t)) at the first gauge, of wave_set.bins
   frequencies; NaN where the gauges do not tell them. One gauge: what it has. */
void wave_find_incident(const wave_set *s, const int *gauges, const double *at, int count,
                        double complex *amplitude);
/* gain: of wave_set.bins frequencies. way: m behind the first gauge, where the phase is taken.
   -1: no memory. */
int wave_find_gains(const wave_set *s, const wave_gauge *record, const double complex *waves, double way,
                    wave_gain *gain);
/* The length, m, of long-crested waves of a frequency, Hz. */
double wave_length(double frequency, double depth, double gravity);
void wave_set_free(wave_set *s);
