/* Stepping a world under the clock. */
#define _DEFAULT_SOURCE
#include "bench.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

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

int bench_begin(bench_run *run, tobi_world *world, int steps)
{
    memset(run, 0, sizeof *run);
    run->world = world;
    run->up = 2;
    if (steps > 0) run->step_seconds = calloc((size_t)steps, sizeof *run->step_seconds);
    if (steps > 0 && !run->step_seconds) return complain("out of memory");
    run->result.peak_rss = bench_peak_rss();
    read_stages(world, &run->before);
    return 0;
}

int bench_step(bench_run *run)
{
    tobi_error err = { 0 };
    bench_result *r = &run->result;
    double since = wall_clock();
    clock_t processor = clock();
    if (tobi_world_step(run->world, 0.0, NULL, &err) != TOBI_OK) return complain("%s", err.text);
    double seconds = wall_clock() - since;
    r->processor += (double)(clock() - processor) / CLOCKS_PER_SEC;
    r->seconds += seconds;
    if (run->step_seconds) run->step_seconds[r->steps] = seconds;
    const tobi_step_info *info = tobi_world_info(run->world);      /* sums energies: not part of a step */
    r->particles = info->fluid_particles;
    add_step(r, info, run->up);
    return 0;
}

void bench_end(bench_run *run)
{
    bench_result *r = &run->result;
    if (r->steps > 0) {
        if (run->step_seconds) {
            qsort(run->step_seconds, (size_t)r->steps, sizeof *run->step_seconds, compare);
            r->median = run->step_seconds[r->steps / 2];
        }
        read_stages(run->world, &run->stages);
        finish(r, &run->stages, &run->before);
    }
    free(run->step_seconds);
    run->step_seconds = NULL;
}

void bench_print(const bench_run *run, int threads)
{
    const bench_result *r = &run->result;
    double n = (double)r->particles, each = 1e6 / n;
    long cores = threads > 0 ? threads : sysconf(_SC_NPROCESSORS_ONLN);
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
    printf("processor time         %.4f us per particle and step and thread (without other "
           "programs: the cost)\n", r->processor / r->steps * each / (double)cores);
    printf("memory                 %.0f bytes per particle in arrays, %.0f of the whole process\n",
           (double)tobi_world_bytes(run->world) / n, r->peak_rss / n);
    bench_print_stages(run);
    bench_print_memory(run->world, n);
}

void bench_print_stages(const bench_run *run)
{
    const bench_result *r = &run->result;
    double each = 1e9 / ((double)r->particles * r->steps);
    printf("\n  stage                  ns per particle and step\n");
    for (int k = 0; k < run->stages.count; k++)
        printf("  %-22s %8.2f\n", run->stages.name[k], run->stages.seconds[k] * each);
    printf("\n");
}

void bench_print_memory(const tobi_world *world, double particles)
{
    const char *name;
    int64_t bytes;
    printf("  memory                           bytes per particle\n");
    for (int k = 0; (name = tobi_world_memory(world, k, &bytes)); k++)
        printf("  %-32s %8.1f\n", name, (double)bytes / particles);
    printf("\n");
}
