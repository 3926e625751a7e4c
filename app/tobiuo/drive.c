/* Stepping to the end. Ctrl-C (or SIGTERM) asks for a clean end after the step in work; a second
   one ends the program at once, which costs nothing but the time since the last checkpoint. */
#include "app.h"
#include <signal.h>
#include <stdio.h>

static volatile sig_atomic_t caught;

static void note_signal(int number) { caught = number; }

void drive_catch_signals(void)
{
    struct sigaction action = { .sa_handler = note_signal, .sa_flags = (int)SA_RESETHAND };
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

static tobi_status step_to_end(const tobi_world *world, tobi_run *run, const drive_options *o, progress *p,
                               watch *w, tobi_error *err)
{
    while (!caught && !tobi_run_done(run, o->end)) {
        tobi_step_info info = { 0 };
        tobi_status status = tobi_run_step(run, o->end, &info, err);
        if (status != TOBI_OK) return status;
        watch_step(w, world, &info);
        progress_step(p, &info, o->end);
    }
    return TOBI_OK;
}

static void print_end(const drive_options *o, const watch *w, const tobi_world *world, double wall)
{
    char text[32];
    watch_say(w, world);
    if (o->quiet) return;
    printf("%s at t = %.9g s after %lld steps in %s; results in %s\n", caught ? "stopped" : "done",
           tobi_world_time(world), (long long)w->steps, duration_text(wall, text), o->dir);
    if (caught) printf("go on with: tobiuo resume %s\n", o->dir);
}

int drive(tobi_world *world, tobi_run *run, const drive_options *o)
{
    progress p;
    watch w;
    tobi_error err = { 0 }, more;
    watch_begin(&w, world);
    progress_begin(&p, tobi_world_time(world), o->quiet);
    tobi_status status = step_to_end(world, run, o, &p, &w, &err);
    progress_end(&p);
    if (status != TOBI_OK) {
        complain("%s", err.text);
        tobi_run_finish(run, status == TOBI_DIVERGED ? "diverged" : "failed", &more);
        return complain("the results up to t = %.9g s are in %s", tobi_world_time(world), o->dir);
    }
    status = tobi_run_checkpoint(run, &err);
    if (status == TOBI_OK) status = tobi_run_finish(run, caught ? "interrupted" : "complete", &err);
    if (status != TOBI_OK) return complain("%s", err.text);
    print_end(o, &w, world, wall_clock() - p.begun);
    watch_end(&w);
    return caught ? EXIT_INTERRUPTED : 0;
}
