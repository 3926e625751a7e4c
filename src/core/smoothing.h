/* Constants of a smoothing kernel at one spacing: lattice normalisation and what a plane wall sees. */
#pragma once
#include "core/wall_table.h"

typedef struct tobi_smoothing_constants {
    int    shape;          /* TOBI_SHAPE_*                                                       */
    int    dimension;
    double spacing;        /* d, m                                                               */
    double h;              /* support radius, m                                                  */
    double volume;         /* V = d^dimension, m3 (m2 in 2-D: per metre depth)                   */
    double weight;         /* V W = weight shape(q); sum over the lattice = 1                    */
    double slope;          /* V grad W = -slope falloff(q) dx; linear fields exact on the lattice */
    double rate;           /* lattice sum of V F, 1/m2: the scale of particle-wise differences   */
    double shortest;       /* the same for the wave of two spacings along all axes: of V F (1 - wave)  */
    double weight_correction, slope_correction; /* against the integral norm */
    double wall_share, wall_lattice; /* at s = d/2: lambda, and what a lattice lacks there */
    double moment_lattice; /* there: what is lacking of the sum of V F x2, over what is lacking of it
                              along the wall's normal and not along the wall */
    double plane_scale;    /* sigma over the plain integral; also scales W at body points          */
    tobi_wall_table plane;
} tobi_smoothing_constants;

/* kernel: TOBI_SHAPE_*; support in spacings, 2 to 4. */
void tobi_smoothing_init(tobi_smoothing_constants *c, int shape, int dimension, double spacing,
                         double support);

/* W and -dW/dr / r in double with the integral normalisation (1/m^dim); the reference the tests use. */
double tobi_smoothing_w(int shape, int dimension, double h, double r);
/* The same W at n distances by their squares. */
void tobi_smoothing_weigh(int shape, int dimension, double h, int n, const double *square, double *w);
double tobi_smoothing_f(int shape, int dimension, double h, double r);

/* Support in spacings at which the kernel is as wide, by its second moment, as wendland-c2 is at `support`.
   The cubic spline is left at the same. */
double tobi_smoothing_support(int shape, double support);
