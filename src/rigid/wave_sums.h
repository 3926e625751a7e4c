/* The regular waves that a wave maker's waves are the sum of. */
#pragma once
#include "base/error.h"
#include "tobiuo/motion.h"

/* The level is level cos(omega t + phase - k x), x from the maker; its displacement is stroke sin(omega t +
   phase). */
typedef struct tobi_wave { double omega, k, phase, stroke, level; } tobi_wave;       /* 1/s, 1/m, 1, m, m */

/* A regular wave of an amplitude (m), a period (s) and a phase (rad). */
tobi_wave tobi_wave_make(const tobi_wave_maker_def *def, double amplitude, double period, double phase);
/* The waves of def, none of a solitary wave. *waves is the caller's, to be freed. period: s, theirs or that
   of their peak; 0: none. The heights of def are checked before. Errors of a record name file and line. */
tobi_status tobi_wave_sum(const tobi_wave_maker_def *def, tobi_wave **waves, int *count, double *period,
                          tobi_error *err);
