/* Stepping to the end. Ctrl-C (or SIGTERM) asks for a clean end: the step in work is given up where that is
   sooner, and the checkpoint has the step before. A second one ends the program at once, which costs nothing
   but the time since the last checkpoint. So does one before the first step. */
#include "app.h"
#include <signal.h>
#include <stdio.h>

static volatile sig_atomic_t caught;

static void note_signal(int number) { caught = number; }

static void catch_signals(void)
{
    struct sigaction action = { .sa_handler = note_signal, .sa_flags = (int)SA_RESETHAND };
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

static int is_caught(void *user)
{
    (void)user;
    return caught != 0;
}

/* Mean density error of a liquid that is not one any more; 0.002 is seen where all is well. */
static const double WRONG_DENSITY = 0.02;

typedef struct counts { int64_t steps, unconverged; tobi_step_info last; } counts;

static tobi_status step_to_end(tobi_run *run, const drive_options *o, progress *p, counts *c,
                               tobi_error *err)
{
    while (!caught && !tobi_run_done(run, o->end)) {
        tobi_step_info info = { 0 };
        tobi_status status = tobi_run_step(run, o->end, &info, err);
        if (status == TOBI_STOPPED) break;
        if (status != TOBI_OK) return status;
        c->steps++;
        c->unconverged += !info.density_converged || !info.divergence_converged;
        c->last = info;
        progress_step(p, &info, o->end);
    }
    return TOBI_OK;
}

static void print_end(const drive_options *o, const counts *c, int done, const char *lost, double time,
                      double wall)
{
    char text[32];
    if (c->unconverged)
        complain("the solver did not converge in %lld of %lld steps", (long long)c->unconverged,
                 (long long)c->steps);
    if (c->last.density_error_mean > WRONG_DENSITY)
        complain("at the end the density of particles is off by %.1f %% on average (density_error_mean in "
                 "history.csv): the liquid has cavities or is compressed, or its layers did not "
                 "fit (tobiuo check)",
                 100*c->last.density_error_mean);
    if (*lost) complain("results in %s: %s", o->dir, lost);
    if (c->last.particles_lost)
        complain("%lld particles left the domain", (long long)c->last.particles_lost);
    if (c->last.put_back)
        complain("particles got past a side of the domain and were put back to it %lld times (put_back in "
                 "history.csv); mlsmpm.leaving says what becomes of them",
                 (long long)c->last.put_back);
    if (o->quiet) return;
    printf("%s at t = %.9g s after %lld steps in %s; results in %s\n", done ? "done" : "stopped",
           time, (long long)c->steps, duration_text(wall, text), o->dir);
    if (!done) printf("go on with: tobiuo resume %s\n", o->dir);
}

int drive(tobi_world *world, tobi_run *run, const drive_options *o)
{
    progress p;
    counts c = { 0 };
    tobi_error err = { 0 }, more;
    catch_signals();
    tobi_world_set_stop(world, is_caught, NULL);
    progress_begin(&p, tobi_world_time(world), o->quiet);
    tobi_status status = step_to_end(run, o, &p, &c, &err);
    progress_end(&p);
    if (status != TOBI_OK) {
        complain("%s", err.text);
        tobi_run_finish(run, status == TOBI_DIVERGED ? "diverged" : status == TOBI_STALLED ? "stalled" :
                                                                                             "failed", &more);
        return complain("the results up to t = %.9g s are in %s", tobi_world_time(world), o->dir);
    }
    const int done = tobi_run_done(run, o->end);
    status = tobi_run_checkpoint(run, &err);
    if (status == TOBI_OK) status = tobi_run_finish(run, done ? "complete" : "interrupted", &err);
    if (status != TOBI_OK) return complain("%s", err.text);
    print_end(o, &c, done, tobi_run_losses(run), tobi_world_time(world), wall_clock() - p.begun);
    return done ? 0 : EXIT_INTERRUPTED;
}
