/* Wave makers: regular waves by Biesel's transfer function and Madsen's second order, solitary waves by
   Goring, sums of regular ones by rigid/wave_sums.c. Drawback: sums leave out what their components do to
   one another, so that long waves travel with their groups too free. */
#include "rigid/waves.h"
#include "rigid/wave_sums.h"
#include <math.h>
#include <stdlib.h>

#define PI 3.14159265358979323846
/* Heights over the depth and, after Miche, over the length times tanh kh at which waves break. */
static const double SOLITARY_BREAKS = 0.78, MICHE = 0.142;
/* H L^2/h^3 up to which the second order is no larger than it may be: no second crest (Madsen 1971). */
static const double MADSEN_LIMIT = 8*PI*PI/3;
/* Goring: the paddle moves while its argument is within so much, plus H/h, of the crest. */
static const double GORING_REACH = 3.8;
enum { EVANESCENT = 30 };
/* Of absorption. Depths in front of the piston: local waves have faded there to a half. Periods in which
   the piston comes back, and over which the mean level is taken; for long waves both by depths. */
static const double GAUGE = 0.25, BACK = 5, MEAN = 3, BACK_DEPTHS = 60;

struct tobi_waves {
    tobi_wave_maker_def def;
    tobi_wave *wave;            /* owned                                                                  */
    int count;
    double period;              /* s, theirs or that of the peak; 0: a solitary wave, or none              */
    double second;              /* m, of the second order                                                 */
    double bound;               /* m, amplitude of the second harmonic of regular waves (Stokes)           */
    double kappa, speed, span;  /* solitary: 1/m, m/s, s                                                   */
};

double tobi_waves_number(double gravity, double depth, double period)
{
    const double deep = 4*PI*PI/(period*period*gravity)*depth;      /* omega^2 h/g = kh tanh kh */
    double kh = deep/sqrt(tanh(deep));                              /* within 5 %, Eckart 1952 */
    for (int n = 0; n < 50; n++) {
        const double t = tanh(kh), step = (kh*t - deep)/(t + kh*(1 - t*t));
        kh -= step;
        if (fabs(step) <= 1e-15*kh) break;
    }
    return kh/depth;
}

/* Integral over the depth of the shape of the maker, 1 at the still water, with cosh kz, times k/cosh kh. */
static double shape_integral(double k, double h, double hinge)
{
    const double scale = cosh(k*h);
    if (isinf(hinge)) return tanh(k*h);
    const double low = fmax(hinge, 0), arm = h - hinge;
    return (arm*k*sinh(k*h) - cosh(k*h) - (low - hinge)*k*sinh(k*low) + cosh(k*low))/(k*arm*scale);
}

double tobi_waves_per_stroke(double k, double depth, double hinge)
{
    const double kh = k*depth, c = cosh(kh);
    return 4*sinh(kh)*shape_integral(k, depth, hinge)*c/(sinh(2*kh) + 2*kh);
}

/* The level so far in front of a piston of the local waves over its displacement: sum of
   4 sin^2/(sin 2kh + 2kh) exp(-kx) over the roots of omega^2 = -g k tan kh. */
static double local_level(double gravity, double depth, double omega, double distance)
{
    const double deep = omega*omega*depth/gravity;
    double sum = 0;
    for (int n = 1; n <= EVANESCENT; n++) {
        double low = (n - 0.5)*PI, high = n*PI;
        for (int i = 0; i < 60; i++) {
            const double kh = 0.5*(low + high);
            if (deep + kh*tan(kh) < 0) low = kh;
            else high = kh;
        }
        const double kh = 0.5*(low + high);
        sum += 4*sin(kh)*sin(kh)/(sin(2*kh) + 2*kh)*exp(-kh*distance/depth);
    }
    return sum;
}

/* --- checks ------------------------------------------------------------------------------------ */

static double breaking_height(const tobi_wave_maker_def *d, double k)
{
    return MICHE*2*PI/k*tanh(k*d->depth);
}

static tobi_status check_height(const tobi_wave_maker_def *d, const char *what, double height, double period,
                                tobi_error *err)
{
    if (!(period > 0))
        return tobi_fail(err, TOBI_INVALID, "%s waves of a height of %g m have no period", what, height);
    const double most = breaking_height(d, tobi_waves_number(d->gravity, d->depth, period));
    if (height <= most) return TOBI_OK;
    return tobi_fail(err, TOBI_INVALID, "%s waves %g m high with a period of %g s break on water %g m deep: "
                     "allowed are up to %.4g m, 0.142 L tanh kh (Miche)", what, height, period, d->depth,
                     most);
}

static tobi_status check_second_order(const tobi_wave_maker_def *d, tobi_error *err)
{
    const double length = 2*PI/tobi_waves_number(d->gravity, d->depth, d->period);
    const double most = MADSEN_LIMIT*d->depth*d->depth*d->depth/(length*length);
    if (d->order < 2) return TOBI_OK;
    if (d->flap) return tobi_fail(err, TOBI_UNSUPPORTED, "order 2 is for pistons; a flap has order 1");
    if (d->height <= most) return TOBI_OK;
    return tobi_fail(err, TOBI_INVALID, "waves %g m high and %.4g m long are too long for order 2 on %g m of "
                     "water: allowed are up to %.4g m, H L^2/h^3 <= 8 pi^2/3 (Madsen); take order 1",
                     d->height, length, d->depth, most);
}

/* s: how long waves of a period need from the maker to the focus. */
static double travel(const tobi_wave_maker_def *d, double period)
{
    const double k = tobi_waves_number(d->gravity, d->depth, period), kh = k*d->depth;
    const double speed = PI/(period*k)*(1 + 2*kh/sinh(2*kh));
    return d->focus_distance/speed;
}

static tobi_status check_focus(const tobi_wave_maker_def *d, tobi_error *err)
{
    if (!(d->peak_period > 0) || !(d->focus_distance > 0))
        return tobi_fail(err, TOBI_INVALID, "a focused group needs a peak_period and a distance, both "
                         "greater than 0; given are %g s and %g m", d->peak_period, d->focus_distance);
    const double most = 0.5*breaking_height(d, tobi_waves_number(d->gravity, d->depth, d->peak_period));
    if (d->focused_height > most)
        return tobi_fail(err, TOBI_INVALID, "a focused crest %g m high with a peak period of %g s breaks on "
                         "water %g m deep: allowed are up to %.4g m, 0.071 L tanh kh (Miche)",
                         d->focused_height, d->peak_period, d->depth, most);
    const double least = d->start + travel(d, d->peak_period);
    if (d->focus_time >= least) return TOBI_OK;
    return tobi_fail(err, TOBI_INVALID, "waves of the peak period are at the focus, %g m away, at %.4g s at "
                     "the earliest; time is %g s", d->focus_distance, least, d->focus_time);
}

static tobi_status check_record(const tobi_wave_maker_def *d, tobi_error *err)
{
    if (!(d->record_distance >= 0) || !(d->longest_period >= 0) || !(d->shortest_period >= 0))
        return tobi_fail(err, TOBI_INVALID, "distance, longest_period and shortest_period of a record "
                         "must not be below 0; given are %g m, %g s and %g s", d->record_distance,
                         d->longest_period, d->shortest_period);
    if (!(d->longest_period > 0) || d->longest_period > d->shortest_period) return TOBI_OK;
    return tobi_fail(err, TOBI_INVALID, "longest_period, %g s, is not greater than shortest_period, %g s",
                     d->longest_period, d->shortest_period);
}

static tobi_status check(const tobi_wave_maker_def *d, tobi_error *err)
{
    const int kinds = (d->height > 0) + (d->solitary_height > 0) + (d->significant_height > 0) +
                      (d->focused_height > 0) + (d->record_file != NULL);
    if (!(d->depth > 0) || !(d->gravity > 0))
        return tobi_fail(err, TOBI_INVALID, "a wave maker needs the depth of the water and gravity, both "
                         "greater than 0; given are %g m and %g m/s2", d->depth, d->gravity);
    if (d->absorb && d->flap)
        return tobi_fail(err, TOBI_UNSUPPORTED, "a flap does not absorb; a piston does");
    if (d->absorb_period > 0 && !d->absorb)
        return tobi_fail(err, TOBI_INVALID, "absorb_period is for a piston that absorbs; absorb is "
                         "false");
    if (d->absorb && kinds == 0) return TOBI_OK;
    if (kinds != 1)
        return tobi_fail(err, TOBI_INVALID, "a wave maker makes one kind of waves: regular, solitary, "
                         "irregular or focused ones, by their height, or those of a record; given are %d",
                         kinds);
    if ((d->significant_height > 0 || d->focused_height > 0) && (d->components < 1 || !(d->peakedness >= 1)))
        return tobi_fail(err, TOBI_INVALID, "the waves have %d components and the peakedness %g; allowed are "
                         "1 and more of both", d->components, d->peakedness);
    if (d->flap && !(d->hinge_height < d->depth))
        return tobi_fail(err, TOBI_INVALID, "the hinge is %g m above the bottom, not below the still water, "
                         "%g m", d->hinge_height, d->depth);
    if (d->flap && d->solitary_height > 0)
        return tobi_fail(err, TOBI_UNSUPPORTED, "a flap makes no solitary waves; a piston does");
    if (d->solitary_height > SOLITARY_BREAKS*d->depth)
        return tobi_fail(err, TOBI_INVALID, "a solitary wave %g m high breaks on water %g m deep: allowed "
                         "are up to %.4g m, 0.78 of the depth", d->solitary_height, d->depth,
                         SOLITARY_BREAKS*d->depth);
    if (d->height > 0) {
        TOBI_TRY(check_height(d, "regular", d->height, d->period, err));
        return check_second_order(d, err);
    }
    if (d->significant_height > 0)
        return check_height(d, "irregular", d->significant_height, d->peak_period, err);
    return d->focused_height > 0 ? check_focus(d, err) : d->record_file ? check_record(d, err) : TOBI_OK;
}

/* --- making ------------------------------------------------------------------------------------ */

/* Of the piston at 2 omega, which takes away the free second harmonic (Madsen 1971, eq. 30). */
static double second_order(const tobi_wave_maker_def *d)
{
    const double k = tobi_waves_number(d->gravity, d->depth, d->period), kh = k*d->depth, s = sinh(kh);
    return d->height*d->height/(32*d->depth)*
           (3*cosh(kh)/(s*s*s) - 2/tobi_waves_per_stroke(k, d->depth, INFINITY));
}

/* H^2 k/16 cosh kh (2 + cosh 2kh)/sinh^3 kh. */
static double bound_harmonic(const tobi_wave_maker_def *d)
{
    const double k = tobi_waves_number(d->gravity, d->depth, d->period), kh = k*d->depth, s = sinh(kh);
    return d->height*d->height*k/16*cosh(kh)*(2 + cosh(2*kh))/(s*s*s);
}

static void make_solitary(tobi_waves *w)
{
    const double H = w->def.solitary_height, h = w->def.depth;
    w->kappa = sqrt(0.75*H/h)/h;
    w->speed = sqrt(w->def.gravity*(h + H));
    w->span = 2*(GORING_REACH + H/h)/(w->kappa*w->speed);
}

tobi_status tobi_waves_create(const tobi_wave_maker_def *def, tobi_waves **out, tobi_error *err)
{
    *out = NULL;
    TOBI_TRY(check(def, err));
    tobi_waves *w = calloc(1, sizeof *w);
    if (!w) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for waves");
    w->def = *def;
    const tobi_status status = tobi_wave_sum(def, &w->wave, &w->count, &w->period, err);
    if (status != TOBI_OK) {
        free(w);
        return status;
    }
    if (def->solitary_height > 0) make_solitary(w);
    if (def->height > 0) w->bound = bound_harmonic(def);
    if (def->height > 0 && def->order == 2) w->second = second_order(def);
    *out = w;
    return TOBI_OK;
}

double tobi_waves_depth(const tobi_waves *w) { return w->def.depth; }

double tobi_waves_sudden(const tobi_waves *w)
{
    return w->def.ramp < 0.5*w->period ? w->period : 0;
}

double tobi_waves_late(const tobi_waves *w)
{
    const tobi_wave_maker_def *d = &w->def;
    const double least = d->focused_height > 0 ? d->start + travel(d, 0.5*d->peak_period) : 0;
    return d->focus_time < least ? least : 0;
}

void tobi_waves_free(tobi_waves *w)
{
    if (!w) return;
    free(w->wave);
    free(w);
}

/* --- at a time --------------------------------------------------------------------------------- */

/* Goring 1978: x = H/(kappa h) tanh kappa (c t - x), by Newton, from the middle of the stroke. */
static double solitary_place(const tobi_waves *w, double t)
{
    const double reach = w->def.solitary_height/(w->kappa*w->def.depth);
    double x = 0;
    for (int n = 0; n < 60; n++) {
        const double s = tanh(w->kappa*(w->speed*t - x)), slope = 1 + reach*w->kappa*(1 - s*s);
        const double step = (x - reach*s)/slope;
        x -= step;
        if (fabs(step) <= 1e-14*reach) break;
    }
    return x;
}

static double rise(const tobi_waves *w, double t)
{
    const double since = t - w->def.start, ramp = w->def.ramp;
    return since <= 0 ? 0 : since >= ramp ? 1 : 0.5*(1 - cos(PI*since/ramp));
}

double tobi_waves_displacement(const tobi_waves *w, double t)
{
    if (w->def.solitary_height > 0) {
        const double since = fmin(fmax(t - w->def.start, 0), w->span);
        return solitary_place(w, since - 0.5*w->span) - solitary_place(w, -0.5*w->span);
    }
    double sum = 0;
    for (int n = 0; n < w->count; n++) sum += w->wave[n].stroke*sin(w->wave[n].omega*t + w->wave[n].phase);
    if (w->second != 0) sum += w->second*sin(2*(w->wave[0].omega*t + w->wave[0].phase));
    return rise(w, t)*sum;
}

double tobi_waves_level(const tobi_waves *w, double t, double distance)
{
    const tobi_wave_maker_def *d = &w->def;
    if (d->solitary_height > 0) {
        const double at = t - d->start - 0.5*w->span, x = solitary_place(w, at) + distance;
        const double c = cosh(w->kappa*(w->speed*at - x));
        return fabs(at) <= 0.5*w->span || distance > 0 ? d->solitary_height/(c*c) : 0;
    }
    double sum = 0;
    for (int n = 0; n < w->count; n++) {
        const tobi_wave *one = &w->wave[n];
        const double angle = one->omega*t + one->phase, local =
            d->flap ? 0 : one->stroke*local_level(d->gravity, d->depth, one->omega, distance);
        sum += one->level*cos(angle - one->k*distance) + local*sin(angle);
        if (w->bound != 0) sum += w->bound*cos(2*(angle - one->k*distance));
    }
    return rise(w, t)*sum;
}

/* --- absorption -------------------------------------------------------------------------------- */

int tobi_waves_absorption(const tobi_waves *w, tobi_absorption *out)
{
    const tobi_wave_maker_def *d = &w->def;
    const double period = d->absorb_period > 0 ? d->absorb_period : w->period, h = d->depth;
    *out = (tobi_absorption){ .distance = GAUGE*h };
    if (!d->absorb) return 0;
    if (!(period > 0)) {
        const double speed = sqrt(d->gravity*h);
        out->gain = speed/h;
        out->lag = out->distance/speed;
        out->leak = out->mean = BACK_DEPTHS*h/speed;
        return 1;
    }
    const double k = tobi_waves_number(d->gravity, h, period), omega = 2*PI/period;
    const double height = tobi_waves_per_stroke(k, h, INFINITY);
    out->gain = omega/height;
    out->leak = BACK*period;
    out->mean = MEAN*period;
    const double ahead = (1/out->leak + 1/out->mean)/omega;           /* rad, by both */
    out->lag = (local_level(d->gravity, h, omega, out->distance)/height + k*out->distance + ahead)/omega;
    return 1;
}
