/* All smoothing kernels side by side: their integrals on lattices, W and dW/dr. */
#define _GNU_SOURCE
#include "kernel_tables.h"
#include "app.h"
#include "picture.h"
#include "tobiuo/inspect.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { INTERVALS = 200, KERNEL_LIMIT = CURVE_LIMIT };

static const int sides[] = { 5, 10, 15, 20, 25 };

/* The names of the kernels, at most KERNEL_LIMIT. */
static int list_kernels(char names[KERNEL_LIMIT][32])
{
    int count = 0;
    while (count < KERNEL_LIMIT && tobi_kernel_name(count, names[count], sizeof *names)) count++;
    return count;
}

/* The sum of W V over n points a side, V = (2 support/n)^dimension, from the corner of the cube around the
   support: the lattice of the ISPH program's test. */
static double integrate(int kernel, const kernel_options *o, int n)
{
    const double h = o->support, a = 2*h/n;
    double sum = 0;
    for (int k = 0; k < (o->dimension == 3 ? n : 1); k++)
        for (int j = 0; j < n; j++)
            for (int i = 0; i < n; i++) {
                const double x = i*a - h, y = j*a - h, z = o->dimension == 3 ? k*a - h : 0;
                sum += tobi_kernel_value(kernel, o->dimension, h, sqrt(x*x + y*y + z*z));
            }
    return sum*pow(a, o->dimension);
}

static FILE *open_table(const kernel_options *o, const char *name)
{
    char *path = clear_place(o->dir, name);
    FILE *file = path ? fopen(path, "wx") : NULL;
    if (path && !file) complain("cannot write %s: %s", path, tr(strerror(errno)));
    free(path);
    return file;
}

static int close_table(const kernel_options *o, const char *name, FILE *file)
{
    const int failed = ferror(file);
    if (fclose(file) == 0 && !failed) return 0;
    return complain("cannot write %s/%s: %s", o->dir, name, tr(strerror(errno)));
}

static int write_integrals(const kernel_options *o)
{
    char names[KERNEL_LIMIT][32];
    const int kernels = list_kernels(names);
    FILE *file = open_table(o, "kernel_integrals.csv");
    if (!file) return EXIT_ERROR;
    printf(tr("Integral of W on N^%d points, V = (2 support/N)^%d:\n"), o->dimension, o->dimension);
    printf("%5s %12s", "N",
           o->dimension == 3 ? "V, m3" : "V, m2");
    fprintf(file, "points_per_side,volume");
    for (int k = 0; k < kernels; k++) printf(" %14s", names[k]), fprintf(file, ",%s", names[k]);
    printf("\n");
    fprintf(file, "\n");
    for (size_t n = 0; n < sizeof sides/sizeof *sides; n++) {
        const double volume = pow(2*o->support/sides[n], o->dimension);
        printf("%5d %12.6g", sides[n], volume);
        fprintf(file, "%d,%.9g", sides[n], volume);
        for (int k = 0; k < kernels; k++) {
            const double sum = integrate(k, o, sides[n]);
            printf(" %14.6g", sum);
            fprintf(file, ",%.9g", sum);
        }
        printf("\n");
        fprintf(file, "\n");
    }
    return close_table(o, "kernel_integrals.csv", file);
}

static int write_curves(const kernel_options *o)
{
    char names[KERNEL_LIMIT][32];
    const int kernels = list_kernels(names);
    FILE *file = open_table(o, "kernel_curves.csv");
    if (!file) return EXIT_ERROR;
    fprintf(file, "r");
    for (int k = 0; k < kernels; k++) fprintf(file, ",%s_W", names[k]);
    for (int k = 0; k < kernels; k++) fprintf(file, ",%s_dW_dr", names[k]);
    for (int i = 0; i <= INTERVALS; i++) {
        const double r = o->support*i/INTERVALS;
        fprintf(file, "\n%.9g", r);
        for (int k = 0; k < kernels; k++)
            fprintf(file, ",%.9g", tobi_kernel_value(k, o->dimension, o->support, r));
        for (int k = 0; k < kernels; k++)
            fprintf(file, ",%.9g", tobi_kernel_slope(k, o->dimension, o->support, r));
    }
    fprintf(file, "\n");
    return close_table(o, "kernel_curves.csv", file);
}

typedef double kernel_function(int kernel, int dimension, double support, double r);

static int add_curves(const kernel_options *o, panel *a, kernel_function *f, char names[KERNEL_LIMIT][32])
{
    const int kernels = list_kernels(names);
    for (int k = 0; k < kernels; k++) {
        curve *c = &a->curve[a->curves++];
        *c = (curve){ .label = names[k], .colour = k, .style = k == o->kernel ? CURVE_LINE : CURVE_THIN,
                      .count = INTERVALS + 1, .x = calloc(INTERVALS + 1, sizeof *c->x),
                      .y = calloc(INTERVALS + 1, sizeof *c->y) };
        if (!c->x || !c->y) return complain("out of memory");
        for (int i = 0; i <= INTERVALS; i++) {
            c->x[i] = o->support*i/INTERVALS;
            c->y[i] = f(k, o->dimension, o->support, c->x[i]);
        }
    }
    return 0;
}

static int write_script(const kernel_options *o)
{
    char names[KERNEL_LIMIT][32], picture_file[32], unit[2][16];
    picture p = { .x_label = tr("r, m"), .end = o->support, .panels = 2 };
    FILE *file = open_table(o, "plots.gnuplot");
    if (!file) return EXIT_ERROR;
    snprintf(p.title, sizeof p.title, tr("Kernels, support %g m, %d-D"), o->support, o->dimension);
    for (int k = 0; k < 2; k++) {
        snprintf(unit[k], sizeof unit[k], "1/m%d", o->dimension + k);
        picture_label(&p.panel[k], k == 0 ? "W" : "dW/dr", unit[k]);
    }
    snprintf(picture_file, sizeof picture_file, "kernels.%s", o->format);
    int code = add_curves(o, &p.panel[0], tobi_kernel_value, names);
    if (code == 0) code = add_curves(o, &p.panel[1], tobi_kernel_slope, names);
    if (code == 0) {
        char *path = clear_place(o->dir, picture_file);
        code = path ? 0 : EXIT_ERROR;
        free(path);
        picture_begin_script(file, o->format);
        picture_write(file, &p, picture_file);
    }
    picture_free(&p);
    const int closed = close_table(o, "plots.gnuplot", file);
    return code ? code : closed;
}

int write_kernels(const kernel_options *o)
{
    int code = write_integrals(o);
    if (code == 0) code = write_curves(o);
    if (code == 0) code = write_script(o);
    return code ? code : run_gnuplot(o->dir);
}
