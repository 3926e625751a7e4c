/* Stepping to the end. Ctrl-C (or SIGTERM) asks for a clean end: the step in work is given up where that is
   sooner, and the checkpoint has the step before. A second one ends the program at once, which costs nothing
   but the time since the last checkpoint. So does one before the first step. */
#include "app.h"
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>

static volatile sig_atomic_t caught;

static void note_signal(int number) { caught = number; }

static void catch_signals(void)
{
    struct sigaction action = { .sa_handler = note_signal, .sa_flags = (int)SA_RESETHAND };
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

int is_interrupted(void) { return caught != 0; }

static int is_caught(void *user)
{
    (void)user;
    return caught != 0;
}

/* What could not be written, once each. */
static void say_trouble(const tobi_run *run, progress *p)
{
    const char *text;
    for (; (text = tobi_run_trouble(run, p->troubles)); p->troubles++) {
        progress_end(p);
        complain("%s", text);
    }
}

static tobi_status step_to_end(tobi_world *world, tobi_run *run, const drive_options *o, progress *p,
                               watch *w, tobi_error *err)
{
    while (!caught && !tobi_run_done(run, o->end)) {
        tobi_step_info info = { 0 };
        if (o->between && o->between(o->user, world)) break;
        tobi_status status = tobi_run_step(run, o->end, &info, err);
        if (status == TOBI_STOPPED) break;
        if (status != TOBI_OK) return status;
        say_trouble(run, p);
        progress_step(p, world, &info, o->end);
        status = watch_step(w, world, &info, err);
        if (status != TOBI_OK) return status;
    }
    return TOBI_OK;
}

static void print_end(const drive_options *o, watch *w, const tobi_world *world, int done,
                      const char *lost, double wall)
{
    char text[32];
    watch_say(w, world);
    if (*lost && !(o->told && strcmp(lost, o->told) == 0)) complain("results in %s: %s", o->dir, lost);
    if (o->quiet) return;
    printf(done ? tr("done at t = %.9g s after %lld steps in %s; results in %s\n") :
                  tr("stopped at t = %.9g s after %lld steps in %s; results in %s\n"),
           tobi_world_time(world), (long long)w->steps, duration_text(wall, text), o->dir);
    char quoted[SHELL_WORD];
    if (!done) printf(tr("go on with: tobiuo resume %s\n"), shell_word(o->dir, quoted));
}

static int end_run(const tobi_world *world, tobi_run *run, const drive_options *o, watch *w,
                   progress *p)
{
    tobi_error err = { 0 };
    const int done = tobi_run_done(run, o->end);
    tobi_status status = done ? tobi_run_output_end(run, &err) : TOBI_OK;
    if (status == TOBI_OK) status = tobi_run_checkpoint(run, &err);
    if (status == TOBI_OK) status = tobi_run_finish(run, done ? "complete" : "interrupted", &err);
    say_trouble(run, p);
    if (status != TOBI_OK) return complain("%s", err.text);
    print_end(o, w, world, done, tobi_run_losses(run), wall_clock() - p->begun);
    return !done ? EXIT_INTERRUPTED : tobi_run_unwritten(run) ? EXIT_UNWRITTEN : 0;
}

/* The state at which it ended has an output too, for who wants to see why, if it is one: not after a disk or
   memory failed, and not of numbers that are none. */
static int end_failed_run(const tobi_world *world, tobi_run *run, const drive_options *o, tobi_status status,
                          tobi_error *err)
{
    tobi_error more;
    tobi_scene_place_error(o->scene, err);
    complain("%s", err->text);
    if (status != TOBI_NO_MEMORY && status != TOBI_IO && isfinite(tobi_world_info(world)->speed_max))
        tobi_run_output_end(run, &more);
    tobi_run_finish(run, status == TOBI_DIVERGED ? "diverged" : status == TOBI_STALLED ? "stalled" : "failed",
                    &more);
    return complain(tr("the results up to t = %.9g s are in %s"), tobi_world_time(world), o->dir);
}

int drive(tobi_world *world, tobi_run *run, const drive_options *o)
{
    progress p;
    watch w;
    tobi_error err = { 0 };
    catch_signals();
    tobi_world_set_stop(world, is_caught, NULL);
    watch_begin(&w, world);
    progress_begin(&p, world, o->quiet);
    p.run = run;
    tobi_run_go_on(run, 1);
    tobi_status status = step_to_end(world, run, o, &p, &w, &err);
    progress_end(&p);
    int code = status == TOBI_OK ? end_run(world, run, o, &w, &p)
                                 : end_failed_run(world, run, o, status, &err);
    watch_end(&w);
    return code;
}
