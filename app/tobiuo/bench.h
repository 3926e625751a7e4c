/* What the files of `tobiuo bench` share. */
#pragma once
#include "app.h"

/* What a figure must be read with. */
typedef struct bench_machine {
    char processor[256];
    long cores, threads;
    int isa;                 /* n of x86-64-vn; 0 elsewhere                  */
    double load;             /* before the start; below 0: not known         */
} bench_machine;

typedef struct bench_options {
    const char *which;       /* the case                                     */
    const char *scene;       /* of the case fish                             */
    double spacing;          /* m; 0 = the case's own                        */
    double project;          /* s of simulated time to project to; 0 = 0.8   */
    int threads;             /* 0 = all cores                                */
    int steps, settle;       /* 0 = the case's own                           */
    int bodies;              /* of the case bodies_in_water; 0 = its own               */
    double size;             /* of a body of it, spacings; 0 = its own       */
    int fixed;               /* 1: they do not move                          */
    const char *method;      /* of bodies_in_water; NULL = dfsph             */
    const char *csv;         /* file that gets a row per measurement; NULL = none */
    bench_machine machine;
} bench_options;

enum { BENCH_STAGES = 16 };
/* Seconds per stage so far. */
typedef struct bench_stages {
    const char *name[BENCH_STAGES];
    double seconds[BENCH_STAGES];
    int count;
} bench_stages;

/* One measured stretch of steps. */
typedef struct bench_result {
    int64_t particles;
    int steps;
    double seconds, median;                   /* wall clock: of all steps, of the middle step */
    double processor;                         /* s of processor time of all threads           */
    double simulated, dt_least, dt_most;      /* s                                            */
    double density_iterations, divergence_iterations;
    double density_error, pressure_residual;  /* means over the steps                         */
    double peak_rss;                          /* bytes of the process when it began            */
    double solve_seconds;                     /* in the stages named "... solve"              */
    double force_least, force_mean, force_most;   /* wall force against gravity / weight      */
} bench_result;

/* bench_machine.c */
void bench_find_machine(int threads, bench_machine *machine);
void bench_print_machine(const bench_machine *machine);
/* Bytes of the process at its largest. */
double bench_peak_rss(void);

/* A world under the clock: begin, any number of steps, end. */
typedef struct bench_run {
    tobi_world *world;
    int up;                                   /* axis that gravity points against              */
    double *step_seconds;
    bench_stages before, stages;
    bench_result result;
} bench_run;

/* bench_measure.c. All return 0 or an exit code after a complaint; bench_end frees, always. steps: at most;
   0 = any number, and no median. */
int bench_settle(tobi_world *world, int steps);
int bench_begin(bench_run *run, tobi_world *world, int steps);
int bench_step(bench_run *run);
void bench_end(bench_run *run);
void bench_print(const bench_run *run, int threads);
void bench_print_stages(const bench_run *run);
/* Bytes per particle of each part of the world's memory. */
void bench_print_memory(const tobi_world *world, double particles);
/* bench_csv.c: appends the row of a measurement to o->csv, if there is one. */
int bench_write(const bench_options *o, const char *name, const bench_run *run);

/* bench_ball.c: the case of the material point method. */
int bench_ball(const bench_options *o);
/* bench_cut.c: a blade in a solid. */
int bench_cut(const bench_options *o);
/* bench_bodies.c: rigid bodies. */
int bench_bodies(const bench_options *o);
/* bench_bodies_in_water.c: what small bodies cost in water. */
int bench_bodies_in_water(const bench_options *o);
/* bench_frame.c: the processor time of a picture. */
int bench_frame(const bench_options *o);
int bench_surface(const bench_options *o);
