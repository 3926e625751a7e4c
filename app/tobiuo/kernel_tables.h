/* Tables and a picture of the smoothing kernels. */
#pragma once

typedef struct kernel_options {
    const char *dir;             /* is there */
    const char *format;          /* of the picture, "svg" or "png" */
    int kernel;                  /* the one that is drawn thick */
    int dimension;
    double support;              /* m */
} kernel_options;

/* Writes kernel_integrals.csv and kernel_curves.csv, prints the first, and draws the second as kernels.svg
   with gnuplot where there is one. Returns the exit code. */
int write_kernels(const kernel_options *o);
