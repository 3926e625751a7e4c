/* Stepping a world under the clock. */
#include "bench.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

int bench_settle(tobi_world *world, int steps)
{
    tobi_error err = { 0 };
    for (int k = 0; k < steps; k++)
        if (tobi_world_step(world, 0.0, NULL, &err) != TOBI_OK) return complain("%s", err.text);
    return 0;
}

static void read_stages(const tobi_world *world, bench_stages *s)
{
    s->count = 0;
    while (s->count < BENCH_STAGES) {
        const char *name = tobi_world_stage(world, s->count, &s->seconds[s->count]);
        if (!name) break;
        s->name[s->count++] = name;
    }
}

static int is_solve(const char *name)
{
    size_t n = strlen(name);
    return n >= 5 && strcmp(name + n - 5, "solve") == 0;
}

static int compare(const void *a, const void *b)
{
    double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

static void add_step(bench_result *r, const tobi_step_info *i, int up)
{
    double ratio = i->weight > 0.0 ? -i->wall_force[up] / i->weight : 0.0;
    int first = r->steps++ == 0;
    r->simulated += i->dt;
    r->dt_least = first ? i->dt : fmin(r->dt_least, i->dt);
    r->dt_most = fmax(r->dt_most, i->dt);
    r->density_iterations += i->density_iterations;
    r->divergence_iterations += i->divergence_iterations;
    r->density_error += i->density_error_mean;
    r->pressure_residual += i->pressure_residual;
    r->force_least = first ? ratio : fmin(r->force_least, ratio);
    r->force_most = first ? ratio : fmax(r->force_most, ratio);
    r->force_mean += ratio;
}

/* Sums become means; stages become what this stretch took. */
static void finish(bench_result *r, bench_stages *now, const bench_stages *before)
{
    double n = r->steps;
    r->density_iterations /= n;
    r->divergence_iterations /= n;
    r->density_error /= n;
    r->pressure_residual /= n;
    r->force_mean /= n;
    for (int k = 0; k < now->count; k++) {
        if (k < before->count) now->seconds[k] -= before->seconds[k];
        if (is_solve(now->name[k])) r->solve_seconds += now->seconds[k];
    }
}

int bench_measure(tobi_world *world, int steps, int up, bench_result *r, bench_stages *stages)
{
    tobi_error err = { 0 };
    tobi_step_info info;
    bench_stages before;
    double *seconds = malloc((size_t)steps * sizeof *seconds);
    if (!seconds) return complain("out of memory");
    memset(r, 0, sizeof *r);
    read_stages(world, &before);
    double begun = wall_clock();
    clock_t processor = clock();
    for (int k = 0; k < steps; k++) {
        double since = wall_clock();
        if (tobi_world_step(world, 0.0, &info, &err) != TOBI_OK) {
            free(seconds);
            return complain("%s", err.text);
        }
        seconds[k] = wall_clock() - since;
        add_step(r, &info, up);
    }
    r->seconds = wall_clock() - begun;
    r->processor = (double)(clock() - processor) / CLOCKS_PER_SEC;
    r->particles = info.fluid_particles;
    qsort(seconds, (size_t)steps, sizeof *seconds, compare);
    r->median = seconds[steps / 2];
    free(seconds);
    read_stages(world, stages);
    finish(r, stages, &before);
    return 0;
}

void bench_print_result(const tobi_world *world, const bench_result *r, const bench_stages *stages)
{
    double n = (double)r->particles, each = 1e6 / n;
    printf("fluid particles        %lld\n", (long long)r->particles);
    printf("measured               %d steps, %.3g s simulated, %.1f s of wall clock\n", r->steps,
           r->simulated, r->seconds);
    printf("time step              %.3g to %.3g s\n", r->dt_least, r->dt_most);
    printf("iterations per step    %.2f density, %.2f divergence\n", r->density_iterations,
           r->divergence_iterations);
    printf("density error          %.3f %% mean\n", 100.0 * r->density_error);
    printf("pressure residual      %.2e relative\n", r->pressure_residual);
    printf("cost                   %.4f us per particle and step (mean), %.4f (median step)\n",
           r->seconds / r->steps * each, r->median * each);
    printf("processor time         %.4f us per particle and step, all threads together\n",
           r->processor / r->steps * each);
    printf("memory                 %.0f bytes per particle in arrays, %.0f of the whole process\n",
           (double)tobi_world_bytes(world) / n, bench_peak_rss() / n);
    printf("\n  stage                  ns per particle and step\n");
    for (int k = 0; k < stages->count; k++)
        printf("  %-22s %8.2f\n", stages->name[k], 1e3 * stages->seconds[k] / r->steps * each);
    printf("\n");
}
