/* tobiuo sweep --waves: tobiuo waves of each run that is complete, and its tables of all runs in one.
   Drawback: the words of --waves are parted at spaces, so that none may hold one. */
#define _GNU_SOURCE
#include "sweep.h"
#include "waves.h"
#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

/* In the folder of a run; the sweep's have "sweep_" before the name. */
static const char *const files[] = { "waves.csv", "wave_groups.csv", "wave_responses.csv" };
enum { FILES = sizeof files/sizeof *files };

static char *path_of(const sweep *s, int run, const char *file)
{
    char *name = sweep_name(s, run), *path = sweep_path(s, "%s/%s", name, file);
    free(name);
    return path;
}

static int is_complete(const sweep *s, int run)
{
    json_t *summary = sweep_summary(s, run);
    const char *outcome = json_string_value(json_object_get(summary, "outcome"));
    const int whole = outcome && strcmp(outcome, "complete") == 0;
    json_decref(summary);
    return whole;
}

/* What the program says of a run, a line each behind the run's name, until it closes its end. */
static void tell(const sweep *s, int run, int from)
{
    FILE *in = fdopen(from, "r");
    char *line = NULL, *name = sweep_name(s, run);
    size_t room = 0;
    if (!in) exit(complain("out of memory"));
    while (getline(&line, &room, in) > 0) fprintf(stderr, "%s: %s", name, line);
    fclose(in);
    free(line);
    free(name);
}

/* The program itself: what it finds is in files, what it complains of is told. */
static int analyse(const sweep *s, int run)
{
    char *words = strdup(s->waves), *rest = words, *word, *dir = path_of(s, run, "");
    overrides a = { 0 };
    posix_spawn_file_actions_t actions;
    pid_t child;
    int state = 0, ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0)
        return complain("the program does not start itself: %s", tr(strerror(errno)));
    if (!words) exit(complain("out of memory"));
    for (int k = 0; k < FILES; k++) {        /* of an earlier call with other words */
        char *old = path_of(s, run, files[k]);
        unlink(old);
        free(old);
    }
    overrides_add(&a, "tobiuo");
    overrides_add(&a, "waves");
    overrides_add(&a, "%s", dir);
    while ((word = strsep(&rest, " "))) if (*word) overrides_add(&a, "%s", word);
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
    const int failed = posix_spawn(&child, "/proc/self/exe", &actions, NULL, a.text, environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    tell(s, run, ends[0]);
    while (!failed && waitpid(child, &state, 0) < 0 && errno == EINTR) { }
    overrides_free(&a);
    free(words);
    free(dir);
    if (failed) return complain("the program does not start itself: %s", tr(strerror(failed)));
    return WIFEXITED(state) ? WEXITSTATUS(state) : EXIT_ERROR;
}

/* Rows of a run behind the values that it has; the first table names the columns. */
static void write_rows(const sweep *s, FILE *out, int run, const table *t, int begun)
{
    if (!begun) {
        fputs("run", out);
        for (int k = 0; k < s->axis_count; k++) fprintf(out, ",%s", s->axes[k].label);
        for (int k = 0; k < t->columns; k++) fputc(',', out), sweep_put_cell(out, t->names[k]);
        fputc('\n', out);
    }
    for (size_t i = 0; i < t->rows; i++) {
        fprintf(out, "%d", run);
        for (int k = 0; k < s->axis_count; k++) fputc(',', out), sweep_put_cell(out, sweep_value(s, run, k));
        for (int k = 0; k < t->columns; k++)
            fputc(',', out), sweep_put_cell(out, t->cells[i*(size_t)t->columns + (size_t)k]);
        fputc('\n', out);
    }
}

static int collect(const sweep *s, const char *file)
{
    char *text = NULL, name[64];
    size_t size;
    FILE *out = open_memstream(&text, &size);
    int begun = 0, code = 0;
    if (!out) exit(complain("out of memory"));
    for (int run = 0; run < s->runs; run++) {
        table t = { 0 };
        char *path = path_of(s, run, file);
        if (is_complete(s, run) && access(path, F_OK) == 0 && table_read(&t, path) == 0)
            write_rows(s, out, run, &t, begun++);
        table_free(&t);
        free(path);
    }
    if (fclose(out) != 0) exit(complain("out of memory"));
    snprintf(name, sizeof name, "sweep_%s", file);
    char *path = clear_place(s->dir, name);
    if (!path) code = EXIT_ERROR;
    else if (begun) code = write_new(path, text, size);
    if (!code && begun) printf("%s\n", path);
    free(path);
    free(text);
    return code;
}

static int has_level(const json_t *scene, const char *name, size_t length)
{
    size_t k;
    const json_t *probe;
    json_array_foreach(json_object_get(scene, "probes"), k, probe) {
        const char *own = json_string_value(json_object_get(probe, "name")),
                   *kind = json_string_value(json_object_get(probe, "kind"));
        if (own && kind && strlen(own) == length && strncmp(own, name, length) == 0 &&
            strcmp(kind, "level") == 0) return 1;
    }
    return 0;
}

static int check_gauges(const wave_options *o, const json_t *scene)
{
    for (int k = 0; k < o->group_count; k++)
        for (const char *at = o->groups[k];; at++) {
            const size_t length = strcspn(at, ",");
            if (!has_level(scene, at, length))
                return complain("--gauges %s: there is no sensor '%.*s' of the kind level", o->groups[k],
                                (int)length, at);
            at += length;
            if (!*at) break;
        }
    return 0;
}

int sweep_check_waves(const sweep *s, const tobi_scene *scene)
{
    char *words = strdup(s->waves), *rest = words, *word, *text = tobi_scene_resolved(scene);
    wave_options o = { .format = "svg" };
    overrides a = { 0 };
    if (!words || !text) exit(complain("out of memory"));
    overrides_add(&a, "tobiuo waves");
    while ((word = strsep(&rest, " "))) if (*word) overrides_add(&a, "%s", word);
    overrides_add(&a, "%s", s->dir);
    parse_arguments(&waves_argp, (int)a.count, a.text, &o);
    json_t *json = json_loads(text, 0, NULL);
    const int code = json ? check_gauges(&o, json) : 0;
    json_decref(json);
    overrides_free(&a);
    free(text);
    free(words);
    return code;
}

int sweep_analyse_waves(const sweep *s)
{
    int worst = 0;
    for (int run = 0; run < s->runs; run++) {
        const int code = is_complete(s, run) ? analyse(s, run) : 0;
        char *name = sweep_name(s, run);
        if (code) worst = complain("--waves '%s': %s/%s could not be analysed", s->waves, s->dir, name);
        free(name);
    }
    for (int k = 0; k < FILES; k++)
        if (collect(s, files[k]) != 0) worst = EXIT_ERROR;
    return worst;
}
