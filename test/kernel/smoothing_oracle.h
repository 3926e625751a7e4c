/* The smoothing kernels once more, in double and as their papers write them. */
#pragma once
#include "core/smoothing.k.h"
#include <math.h>

/* max(x, 0)^n */
static double oracle_power(double x, int n) { return x > 0 ? pow(x, n) : 0; }

/* B-splines as Price (2012) writes them, over x = k q, where the support is k of their own lengths. */
static double oracle_spline(int order, double x)
{
    if (order == 4)
        return oracle_power(2.5 - x, 4) - 5*oracle_power(1.5 - x, 4) + 10*oracle_power(0.5 - x, 4);
    return oracle_power(3 - x, 5) - 6*oracle_power(2 - x, 5) + 15*oracle_power(1 - x, 5);
}

static double oracle_spline_slope(int order, double x)
{
    if (order == 4)
        return -4*oracle_power(2.5 - x, 3) + 20*oracle_power(1.5 - x, 3) - 40*oracle_power(0.5 - x, 3);
    return -5*oracle_power(3 - x, 4) + 30*oracle_power(2 - x, 4) - 75*oracle_power(1 - x, 4);
}

/* W, and -W'(r)/r, of a smoothing kernel with support h and integral 1: Wendland (1995) C2, C4, C6, the cubic
   spline of Monaghan (1992), the quartic and quintic of Price (2012). */
static double kernel_w(int shape, int dimension, double h, double r)
{
    const double q = r/h, pi = acos(-1), size = dimension == 3 ? h*h*h : h*h;
    const int deep = dimension == 3;
    if (q >= 1) return 0;
    switch (shape) {
    case TOBI_SHAPE_WENDLAND: return (deep ? 21/(2*pi) : 7/pi)/size*pow(1 - q, 4)*(1 + 4*q);
    case TOBI_SHAPE_CUBIC:
        return (deep ? 8/pi : 40/(7*pi))/size*(q <= 0.5 ? 6*(q*q*q - q*q) + 1 : 2*pow(1 - q, 3));
    case TOBI_SHAPE_QUARTIC:
        return (deep ? pow(2.5, 3)/(20*pi) : 96*pow(2.5, 2)/(1199*pi))/size*oracle_spline(4, 2.5*q);
    case TOBI_SHAPE_QUINTIC:
        return (deep ? 27/(120*pi) : 7*9/(478*pi))/size*oracle_spline(5, 3*q);
    case TOBI_SHAPE_WENDLAND_C4:
        return (deep ? 495/(32*pi) : 9/pi)/size*pow(1 - q, 6)*(35*q*q + 18*q + 3)/3;
    default:
        return (deep ? 1365/(64*pi) : 78/(7*pi))/size*pow(1 - q, 8)*(32*q*q*q + 25*q*q + 8*q + 1);
    }
}

static double kernel_f(int shape, int dimension, double h, double r)
{
    const double q = r/h, pi = acos(-1), size = (dimension == 3 ? h*h*h : h*h)*h*r;
    const int deep = dimension == 3;
    if (q >= 1) return 0;
    switch (shape) {
    case TOBI_SHAPE_WENDLAND: return (deep ? 21/(2*pi) : 7/pi)/size*20*q*pow(1 - q, 3);
    case TOBI_SHAPE_CUBIC:
        return (deep ? 8/pi : 40/(7*pi))/size*(q <= 0.5 ? 6*q*(2 - 3*q) : 6*(1 - q)*(1 - q));
    case TOBI_SHAPE_QUARTIC:
        return -(deep ? pow(2.5, 4)/(20*pi) : 96*pow(2.5, 3)/(1199*pi))/size*oracle_spline_slope(4, 2.5*q);
    case TOBI_SHAPE_QUINTIC:
        return -(deep ? 81/(120*pi) : 7*27/(478*pi))/size*oracle_spline_slope(5, 3*q);
    case TOBI_SHAPE_WENDLAND_C4: return (deep ? 495/(32*pi) : 9/pi)/size*56/3*q*pow(1 - q, 5)*(5*q + 1);
    default:
        return (deep ? 1365/(64*pi) : 78/(7*pi))/size*22*q*pow(1 - q, 7)*(16*q*q + 7*q + 1);
    }
}

/* Of a symmetric matrix. */
static inline double determinant_of(const double m[3][3])
{
    return m[0][0]*(m[1][1]*m[2][2] - m[1][2]*m[1][2]) - m[0][1]*(m[0][1]*m[2][2] - m[1][2]*m[0][2]) +
           m[0][2]*(m[0][1]*m[1][2] - m[1][1]*m[0][2]);
}
