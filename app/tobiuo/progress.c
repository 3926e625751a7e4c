/* The progress line: rewritten in place on a terminal, with a bar; a line every few seconds elsewhere.
   Drawback: the time that is left follows from the mean of the run so far, and lags behind a flow that gets
   faster. */
#include "app.h"
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#define TERMINAL_PERIOD 0.2    /* s */
#define FILE_PERIOD 5.0        /* s */
enum { BAR = 20 };

double wall_clock(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

const char *duration_text(double seconds, char *buffer)
{
    long s = seconds < 0.0 ? 0 : seconds > 1e8 ? 100000000 : (long)(seconds + 0.5);
    if (s >= 3600) snprintf(buffer, 32, "%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
    else if (s >= 60) snprintf(buffer, 32, "%ld:%02ld", s / 60, s % 60);
    else snprintf(buffer, 32, "%ld s", s);
    return buffer;
}

/* "3:10 left, ends 14:32", with the day where that is not today. */
static void write_end(double left, char *buffer, size_t room)
{
    char duration[32], clock[32] = "";
    time_t now = time(NULL), end = now + (time_t)(left < 0 ? 0 : left > 1e8 ? 1e8 : left);
    struct tm today, then;
    if (localtime_r(&now, &today) && localtime_r(&end, &then))
        strftime(clock, sizeof clock, today.tm_yday == then.tm_yday && today.tm_year == then.tm_year
                                          ? "%H:%M" : "%Y-%m-%d %H:%M", &then);
    snprintf(buffer, room, tr("%s left, ends %s"), duration_text(left, duration), clock);
}

/* Seconds that the world has spent in steps. */
static double sum_stages(const tobi_world *world)
{
    double sum = 0, seconds;
    for (int k = 0; tobi_world_stage(world, k, &seconds); k++) sum += seconds;
    return sum;
}

/* s: of all nests of the world. */
static double sum_nests(const tobi_world *world)
{
    const tobi_world *nest;
    double sum = 0;
    for (int k = 0; (nest = tobi_world_nest_at(world, k)) != NULL; k++) sum += sum_stages(nest);
    return sum;
}

void progress_begin(progress *p, const tobi_world *world, int quiet)
{
    *p = (progress){ .columns = terminal_columns(stderr), .begun = wall_clock(),
                     .start_time = tobi_world_time(world), .in_steps = sum_stages(world),
                     .in_nests = sum_nests(world) };
    p->last = quiet ? -1.0 : p->begun;
}

/* What the terminal is wide enough for, the bar in colour. */
static void rewrite_line(const progress *p, double share, const char *line)
{
    char bar[BAR + 1];
    const int full = (int)(share*BAR + 0.5), text = p->columns - 1 - (BAR + 8);
    for (int k = 0; k < BAR; k++) bar[k] = k < full ? '#' : '-';
    bar[BAR] = '\0';
    if (text >= 20)
        fprintf(stderr, "\r%s[%s]%s%4.0f %% ", colour(stderr, GREEN), bar, colour(stderr, PLAIN), 100*share);
    else fputc('\r', stderr);
    print_columns(stderr, line, text >= 20 ? text : p->columns - 1);
}

static void print_line(progress *p, const tobi_world *world, const tobi_step_info *info, double end)
{
    char line[512], left[96], solver[80] = "", inside[32] = "", writing[32] = "", pictures[48] = "";
    const double now = wall_clock(), steps = sum_stages(world), spent = steps - p->in_steps;
    const double done = info->time - p->start_time, span = end - p->start_time;
    const double nests = sum_nests(world), nested = (nests - p->in_nests)/(now - p->last);
    const double outside = 1 - nested - spent/(now - p->last);
    write_end(done > 0.0 ? (now - p->begun)*(end - info->time)/done : 0.0, left, sizeof left);
    bool converged = info->density_converged && info->divergence_converged && !info->viscosity_failed;
    if (info->density_iterations + info->divergence_iterations > 0)    /* the method has a solver */
        snprintf(solver, sizeof solver, tr("  iterations %d+%d%s"), info->density_iterations,
                 info->divergence_iterations, converged ? "" : tr(" (not converged)"));
    double drawing = 0;
    const int64_t drawn = p->run ? tobi_run_pictures(p->run, &drawing) : 0;
    if (drawn > 0) snprintf(pictures, sizeof pictures, tr(", %.3g pictures/s beside"), (double)drawn/drawing);
    if (nested > 0.1) snprintf(inside, sizeof inside, tr(", nests %.0f %%"), 100*nested);
    if (outside > 0.1) snprintf(writing, sizeof writing, tr(", output %.0f %%"), 100*outside);
    snprintf(line, sizeof line, tr("t %.5f/%g s  %s  step %lld  dt %.3g s%s  %.2f M particle-steps/s%s%s%s"),
             info->time, end, left, (long long)info->step, info->dt, solver,
             spent > 0 ? p->particle_steps/spent*1e-6 : 0, inside, writing, pictures);
    if (p->columns) rewrite_line(p, span > 0 ? done/span : 1, line);
    else fprintf(stderr, "%s\n", line);
    fflush(stderr);
    p->shown = 1;
    p->in_steps = steps;
    p->in_nests = nests;
}

void progress_step(progress *p, const tobi_world *world, const tobi_step_info *info, double end)
{
    if (p->last < 0.0) return;
    p->particle_steps += (double)info->fluid_particles;
    double now = wall_clock();
    if (now - p->last < (p->columns ? TERMINAL_PERIOD : FILE_PERIOD)) return;
    print_line(p, world, info, end);
    p->last = now;
    p->particle_steps = 0.0;
}

void progress_end(progress *p)
{
    if (p->shown && p->columns) fputc('\n', stderr);
    p->shown = 0;
}
