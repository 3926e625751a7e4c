/* Matrices of six by six on plain double[6][6]: what forces and torques make of velocities and turns. */
#pragma once
#include <string.h>

/* y = x y. */
static inline void matrix6_multiply(const double x[6][6], double y[6])
{
    double out[6] = { 0 };
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++) out[i] += x[i][j]*y[j];
    memcpy(y, out, sizeof out);
}

/* out = x^-1; x is overwritten. Without a search for pivots: those of 1 + M^-1 K with K >= 0 are 1 or
   more. */
static inline void matrix6_invert(double x[6][6], double out[6][6])
{
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++) out[i][j] = i == j;
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++) {
            const double share = x[j][i]/x[i][i];
            for (int k = 0; k < 6 && j != i; k++) {
                x[j][k] -= share*x[i][k];
                out[j][k] -= share*out[i][k];
            }
        }
    for (int i = 0; i < 6; i++)
        for (int k = 0; k < 6; k++) out[i][k] /= x[i][i];
}
