/* What a wave maker does for the waves that are asked for: linear theory and beyond. Piston: all of the depth
   moves alike; flap: it turns about a hinge. */
#pragma once
#include "base/error.h"
#include "tobiuo/motion.h"

typedef struct tobi_waves tobi_waves;

/* TOBI_INVALID in words for waves that break or that the theory does not have. */
tobi_status tobi_waves_create(const tobi_wave_maker_def *def, tobi_waves **out, tobi_error *err);
void tobi_waves_free(tobi_waves *waves);
/* m: how far the maker is from rest at the height of still water. */
double tobi_waves_displacement(const tobi_waves *waves, double t);
/* m: the level at the front of a piston by the same theory, local waves included. */
double tobi_waves_level(const tobi_waves *waves, double t);

/* 1: the motion is a piston, or one of its parts is. */
int tobi_motion_is_piston(const tobi_motion *motion);

/* 1/m: k of omega^2 = g k tanh kh for a period (s) and a depth (m). */
double tobi_waves_number(double gravity, double depth, double period);
/* 1: height of the waves over the stroke of the maker at the still water (Biesel 1951). hinge: m above the
   bottom, negative below; INFINITY is a piston. */
double tobi_waves_per_stroke(double k, double depth, double hinge);
