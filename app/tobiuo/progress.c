/* The progress line: rewritten in place on a terminal, a line every few seconds elsewhere. */
#include "app.h"
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

#define TERMINAL_PERIOD 0.2    /* s */
#define FILE_PERIOD 5.0        /* s */

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

void progress_begin(progress *p, double time, int quiet)
{
    struct winsize size;
    *p = (progress){ .terminal = isatty(STDERR_FILENO), .begun = wall_clock(), .start_time = time };
    bool known = p->terminal && ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col;
    p->columns = known ? size.ws_col : 120;
    p->last = quiet ? -1.0 : p->begun;
}

static void print_line(progress *p, const tobi_step_info *info, double end, double rate)
{
    char line[256], left[32], solver[80] = "";
    double done = info->time - p->start_time, elapsed = wall_clock() - p->begun;
    duration_text(done > 0.0 ? elapsed * (end - info->time) / done : 0.0, left);
    bool converged = info->density_converged && info->divergence_converged;
    if (info->density_iterations + info->divergence_iterations > 0)    /* the method has a solver */
        snprintf(solver, sizeof solver, "iterations %d+%d%s  ", info->density_iterations,
                 info->divergence_iterations, converged ? "" : " (not converged)");
    snprintf(line, sizeof line, "t %.5f/%g s  step %lld  dt %.3g s  %s%.2f M particle-steps/s  left %s",
             info->time, end, (long long)info->step, info->dt, solver, rate*1e-6, left);
    if (p->terminal) fprintf(stderr, "\r%-*.*s", p->columns - 1, p->columns - 1, line);
    else fprintf(stderr, "%s\n", line);
    fflush(stderr);
    p->shown = 1;
}

void progress_step(progress *p, const tobi_step_info *info, double end)
{
    if (p->last < 0.0) return;
    p->particle_steps += (double)info->fluid_particles;
    double now = wall_clock();
    if (now - p->last < (p->terminal ? TERMINAL_PERIOD : FILE_PERIOD)) return;
    print_line(p, info, end, p->particle_steps / (now - p->last));
    p->last = now;
    p->particle_steps = 0.0;
}

void progress_end(progress *p)
{
    if (p->shown && p->terminal) fputc('\n', stderr);
    p->shown = 0;
}
