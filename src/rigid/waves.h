/* What a wave maker does for the waves that are asked for: linear theory and beyond. Piston: all of the depth
   moves alike; flap: it turns about a hinge. */
#pragma once
#include "base/error.h"
#include "tobiuo/motion.h"

typedef struct tobi_waves tobi_waves;

/* TOBI_INVALID in words for waves that break or that the theory does not have. */
tobi_status tobi_waves_create(const tobi_wave_maker_def *def, tobi_waves **out, tobi_error *err);
void tobi_waves_free(tobi_waves *waves);
double tobi_waves_depth(const tobi_waves *waves);
/* m: how far the maker is from rest at the height of still water. */
double tobi_waves_displacement(const tobi_waves *waves, double t);
/* m: the level by the same theory, so far in front of a piston, local waves and the bound second harmonic of
   regular waves included. */
double tobi_waves_level(const tobi_waves *waves, double t, double distance);

/* How a piston absorbs waves that come back: T u' = -u - gain (e - mean), with the error e of the level (m,
   measured less its own waves') so far in front of it; the way decays in leak. After Schaeffer and Klopman
   2000 in the first order: gain = omega over the height per stroke, sqrt(g/h) for long waves. T, the lag,
   makes up for the way of the waves from the gauge to the piston, for the local waves, for mean and leak. */
typedef struct tobi_absorption {
    double gain, lag, leak;      /* 1/s, s, s                                                 */
    double mean;                 /* s, over which the mean of the error is taken, that is left out    */
    double distance;             /* m, of the gauge from the front                            */
} tobi_absorption;
/* 0 if it does not absorb. */
int tobi_waves_absorption(const tobi_waves *waves, tobi_absorption *out);
/* The piston of a motion or of one of its parts that absorbs, and where its waves go (unit vector); NULL. */
const tobi_waves *tobi_motion_absorber(const tobi_motion *motion, double direction[3]);

/* s: the period, for irregular waves that of the peak, if the strokes do not rise over half of it or more; 0:
   they do, or it is a solitary wave, which rises by itself. */
double tobi_waves_sudden(const tobi_waves *waves);
/* s: when waves of half the peak period are at the focus of a group, if they are late for it; else 0. */
double tobi_waves_late(const tobi_waves *waves);
/* The waves of a piston or flap, or of one among the parts of the motion; NULL. */
const tobi_waves *tobi_motion_waves(const tobi_motion *motion);
/* m: the depth that a piston or flap, or one among the parts of the motion, is made for; 0: there is none. */
double tobi_motion_wave_depth(const tobi_motion *motion);
/* 1: no part of the motion is a script, so that it may be asked for any time in any order. */
int tobi_motion_is_plain(const tobi_motion *motion);

/* 1/m: k of omega^2 = g k tanh kh for a period (s) and a depth (m). */
double tobi_waves_number(double gravity, double depth, double period);
/* 1: height of the waves over the stroke of the maker at the still water (Biesel 1951). hinge: m above the
   bottom, negative below; INFINITY is a piston. */
double tobi_waves_per_stroke(double k, double depth, double hinge);
