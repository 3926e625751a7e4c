/* The runs of a sweep: each is this same program in a process of its own, its messages in NAME.log beside its
   folder. Drawback: the runs share nothing, not even the meshes that they read. */
#define _GNU_SOURCE
#include "sweep.h"
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

typedef struct job { pid_t child; int run; double begun; } job;

/* A run ends at its time but for the rounding of its sums. */
static const double ROUNDING = 1e-9;

static volatile sig_atomic_t stopped;
static void note_stop(int number) { stopped = number; }

static int is_outcome(const json_t *summary, const char *word)
{
    const char *outcome = json_string_value(json_object_get(summary, "outcome"));
    return outcome && strcmp(outcome, word) == 0;
}

/* Files that are no more what a run in dir has read. */
static int complain_changed(const tobi_scene *scene, const char *dir)
{
    const char *path;
    for (int k = 0; (path = tobi_scene_file(scene, k)); k++)
        if (tobi_scene_file_changed(scene, dir, k))
            return complain("%s has changed since %s read it; choose another --out, or remove that folder",
                            path, dir);
    return 0;
}

/* The scene of a run without its end and what does not change its results; *end: its end time, s. code is set
   if a file of it has changed since the run in dir. */
static json_t *expected_scene(const sweep *s, int run, const char *dir, double *end, int *code)
{
    overrides set = { 0 };
    if (s->until) overrides_add(&set, "end_time=%s", s->until);
    for (int k = 0; k < s->axis_count; k++)
        overrides_add(&set, "%s=%s", s->axes[k].path, sweep_value(s, run, k));
    tobi_scene *scene = load_scene(s->scene, &set);
    char *text = tobi_scene_resolved(scene);
    json_t *json = text ? json_loads(text, 0, NULL) : NULL;
    free(text);
    if (complain_changed(scene, dir)) *code = EXIT_ERROR;
    tobi_scene_free(scene);
    *end = json_number_value(json_object_get(json, "end_time"));
    json_object_del(json, "threads");
    json_object_del(json, "end_time");
    return json;
}

sweep_state sweep_look(const sweep *s, int run, double *end, int *code)
{
    char *name = sweep_name(s, run), *dir = sweep_path(s, "%s", name);
    char *path = sweep_path(s, "%s/resolved.json", name);
    json_t *there = json_load_file(path, 0, NULL);
    json_t *expected = there ? expected_scene(s, run, dir, end, code) : NULL;
    json_t *summary = sweep_summary(s, run);
    const double time = json_number_value(json_object_get(summary, "time"));
    const int whole = is_outcome(summary, "complete"), goes_on = whole || is_outcome(summary, "interrupted");
    sweep_state state = !there ? SWEEP_NEW
                      : summary && !goes_on ? SWEEP_FAILED
                      : whole && time >= *end*(1 - ROUNDING) ? SWEEP_DONE : SWEEP_BEGUN;
    json_object_del(there, "threads");
    json_object_del(there, "end_time");
    if (there && expected && !json_equal(there, expected))
        *code = complain("%s/%s holds results of another scene; choose another --out, or remove it", s->dir,
                         name);
    else if (expected && goes_on && time > *end*(1 + ROUNDING))
        *code = complain("%s/%s has run to %g s already, beyond %g s; choose another --out, or remove it",
                         s->dir, name, time, *end);
    json_decref(there);
    json_decref(expected);
    json_decref(summary);
    free(path);
    free(dir);
    free(name);
    return state;
}

/* "run SCENE --quiet --out DIR/NAME --set ...", or "resume DIR/NAME --quiet --until END". */
static int start(const sweep *s, int run, sweep_state state, double end, job *j)
{
    char *name = sweep_name(s, run), *dir = sweep_path(s, "%s", name), *log = sweep_path(s, "%s.log", name);
    const long cores = sysconf(_SC_NPROCESSORS_ONLN), share = cores/s->jobs;
    overrides a = { 0 };
    overrides_add(&a, "tobiuo");
    overrides_add(&a, "%s", state == SWEEP_BEGUN ? "resume" : "run");
    overrides_add(&a, "%s", state == SWEEP_BEGUN ? dir : s->scene);
    overrides_add(&a, "--quiet");
    if (s->jobs > 1) overrides_add(&a, "--threads=%ld", share > 1 ? share : 1);
    if (state == SWEEP_BEGUN) overrides_add(&a, "--until=%.17g", end);
    else {
        overrides_add(&a, "--out=%s", dir);
        if (s->until) overrides_add(&a, "--until=%s", s->until);
        for (int k = 0; k < s->axis_count; k++)
            overrides_add(&a, "--set=%s=%s", s->axes[k].path, sweep_value(s, run, k));
    }
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    const int failed = posix_spawn(&j->child, "/proc/self/exe", &actions, NULL, a.text, environ);
    posix_spawn_file_actions_destroy(&actions);
    overrides_free(&a);
    free(name);
    free(dir);
    free(log);
    j->run = run;
    j->begun = wall_clock();
    return failed ? complain("the program does not start itself: %s", tr(strerror(failed))) : 0;
}

/* The last line that a run has said. One that failed in silence had no room for its log, or was killed. */
static void tell_failure(const sweep *s, const char *name, int state)
{
    char *path = sweep_path(s, "%s.log", name), line[400] = "", last[400] = "";
    FILE *file = fopen(path, "r");
    while (file && fgets(line, sizeof line, file))
        if (line[0] != '\n') strcpy(last, line);
    if (file) fclose(file);
    last[strcspn(last, "\n")] = '\0';
    if (last[0]) complain("%s: %s", name, last);
    else if (WIFSIGNALED(state)) complain("%s: the run was ended by a signal: %s", name,
                                          strsignal(WTERMSIG(state)));
    else complain("%s: the run failed, and could not write the reason to %s; is the disk full?", name, path);
    free(path);
}

static int finish(const sweep *s, const job *j, int state, int done, int todo)
{
    char *name = sweep_name(s, j->run), text[32];
    const int code = WIFEXITED(state) ? WEXITSTATUS(state) : EXIT_ERROR;
    if (code == 0)
        printf(tr("[%d/%d] %s: done in %s\n"), done, todo, name, duration_text(wall_clock() - j->begun,
                                                                               text));
    else if (code != EXIT_INTERRUPTED) tell_failure(s, name, state);
    fflush(stdout);
    free(name);
    return code;
}

/* Waits for one of the jobs; *slot is free then. */
static int wait_for_one(const sweep *s, job *jobs, int *slot, int done, int todo)
{
    int state = 0;
    pid_t child;
    while ((child = waitpid(-1, &state, 0)) < 0 && errno == EINTR) { }
    for (*slot = 0; *slot < s->jobs - 1 && jobs[*slot].child != child; ++*slot) { }
    const int code = finish(s, &jobs[*slot], state, done, todo);
    jobs[*slot].child = 0;
    return code;
}

static void catch_stops(void)
{
    struct sigaction action = { .sa_handler = note_stop };
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);         /* the runs get it as well, and end with a checkpoint */
    sigaction(SIGTERM, &action, NULL);
}

/* Passes a stop on to runs that have not got it: SIGTERM reaches this process alone. */
static void stop_jobs(const job *jobs, int count)
{
    for (int k = 0; k < count; k++)
        if (stopped == SIGTERM && jobs[k].child > 0) kill(jobs[k].child, SIGTERM);
}

int sweep_run(const sweep *s)
{
    job jobs[256] = { { 0 } };
    int code = 0, running = 0, done = 0, slot = 0, worst = 0;
    const int first = s->only >= 0 ? s->only : 0, end = s->only >= 0 ? s->only + 1 : s->runs;
    catch_stops();
    for (int run = first; run < end && !stopped; run++) {
        double ends = 0;
        const sweep_state state = sweep_look(s, run, &ends, &code);
        done += state == SWEEP_DONE;
        if (state == SWEEP_DONE) continue;
        if (state == SWEEP_FAILED) {
            char *name = sweep_name(s, run);
            worst = complain("%s has failed before; remove %s/%s to try again", name, s->dir, name);
            free(name);
            continue;
        }
        for (slot = 0; slot < s->jobs && jobs[slot].child; slot++) { }
        if (slot == s->jobs) {
            const int ended = wait_for_one(s, jobs, &slot, ++done, end - first);
            if (ended) worst = ended;
            running--;
        }
        code = stopped ? 0 : start(s, run, state, ends, &jobs[slot]);
        if (code) jobs[slot].child = 0;
        running += jobs[slot].child > 0;
        if (code) break;
    }
    for (; running > 0; running--) {
        stop_jobs(jobs, s->jobs);
        const int ended = wait_for_one(s, jobs, &slot, ++done, end - first);
        if (ended) worst = ended;
    }
    if (stopped) complain("stopped; the same command goes on");
    return stopped ? EXIT_INTERRUPTED : code ? code : worst;
}

/* --- SLURM --------------------------------------------------------------------------------- */

/* A text between the quotes of a shell. */
static void put_safe(FILE *out, const char *text)
{
    for (; *text; text++) fputs(*text == '\'' ? "'\\''" : (char[]){ *text, '\0' }, out);
}

static void put_quoted(FILE *out, const char *text)
{
    fputs(" '", out);
    put_safe(out, text);
    fputc('\'', out);
}

static void put_axis(FILE *out, const sweep_axis *a)
{
    fputs(" --set '", out);
    put_safe(out, a->path);
    for (int v = 0; v < a->count; v++) {
        fputc(v ? ',' : '=', out);
        put_safe(out, a->value[v]);
    }
    fputc('\'', out);
}

static void put_command(const sweep *s, FILE *out)
{
    char exe[4096];
    const ssize_t length = readlink("/proc/self/exe", exe, sizeof exe - 1);
    exe[length > 0 ? length : 0] = '\0';
    put_quoted(out, length > 0 ? exe : "tobiuo");
    fputs(" sweep", out);
    put_quoted(out, s->scene);
    for (int k = 0; k < s->axis_count; k++) put_axis(out, &s->axes[k]);
    if (s->until) fprintf(out, " --until %s", s->until);
    fputs(" --out", out);
    put_quoted(out, s->dir);
    if (s->waves) fputs(" --waves", out), put_quoted(out, s->waves);
}

int sweep_write_slurm(const sweep *s)
{
    char *path = sweep_path(s, "sweep.slurm"), *here = getcwd(NULL, 0);
    FILE *out = fopen(path, "w");
    int code = out && here ? 0 : complain("cannot write %s: %s", path, tr(strerror(errno)));
    if (!code) {
        fprintf(out, "#!/bin/sh\n# %d runs of a sweep as an array job. Hand it in: sbatch %s\n"
                     "# Cores, memory and time are the site's: change the lines below.\n"
                     "#SBATCH --job-name=tobiuo_sweep\n#SBATCH --array=0-%d", s->runs, path, s->runs - 1);
        if (s->jobs > 1) fprintf(out, "%%%d", s->jobs);
        fprintf(out, "\n#SBATCH --cpus-per-task=8\n#SBATCH --time=24:00:00\n"
                     "#SBATCH --output=\"%s/slurm_%%a.txt\"\ncd", s->dir);
        put_quoted(out, here);
        fputs(" || exit 1\nexec", out);
        put_command(s, out);
        fputs(" --only \"$SLURM_ARRAY_TASK_ID\"\n# When all have ended:", out);
        put_command(s, out);
        fputs(" --table\n", out);
        if (ferror(out)) code = complain("cannot write %s: %s", path, tr(strerror(errno)));
    }
    if (out && fclose(out) != 0 && !code) code = complain("cannot write %s: %s", path, tr(strerror(errno)));
    if (!code) printf(tr("%s is an array job of %d runs: sbatch %s\n"), path, s->runs, path);
    free(path);
    free(here);
    return code;
}
