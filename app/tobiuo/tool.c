/* Programs beside this one, as gnuplot and ffmpeg, and places for what they read. */
#define _GNU_SOURCE
#include "app.h"
#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

/* Reads to the end, so that the program never waits; keeps what has room of the first line. */
static void listen_to(int from, char said[TOOL_SAYS])
{
    char text[512];
    size_t kept = 0;
    int first = 1;
    for (ssize_t n; (n = read(from, text, sizeof text)) != 0;) {
        if (n < 0 && errno != EINTR) break;
        for (ssize_t k = 0; k < n; k++) {
            first &= text[k] != '\n';
            if (first && kept < TOOL_SAYS - 1) said[kept++] = text[k];
        }
    }
    said[kept] = '\0';
    close(from);
}

int run_tool(const char *folder, char *const arguments[], const char *does, const char *package, int quiet,
             char said[TOOL_SAYS])
{
    posix_spawn_file_actions_t actions;
    pid_t child;
    int state = 0, errors[2];
    if (said && pipe2(errors, O_CLOEXEC) != 0) return complain("%s: %s", arguments[0], tr(strerror(errno)));
    posix_spawn_file_actions_init(&actions);
    if (folder) posix_spawn_file_actions_addchdir_np(&actions, folder);
    if (quiet) posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    if (said) posix_spawn_file_actions_adddup2(&actions, errors[1], STDERR_FILENO);
    const int failed = posix_spawnp(&child, arguments[0], &actions, NULL, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (said) {
        close(errors[1]);
        listen_to(errors[0], said);
    }
    if (failed == ENOENT)
        return complain("%s is missing, and it %s. On Debian: apt-get install %s", arguments[0], does,
                        package);
    if (failed) return complain("%s does not start: %s", arguments[0], tr(strerror(failed)));
    while (waitpid(child, &state, 0) < 0)
        if (errno != EINTR) return complain("%s: %s", arguments[0], tr(strerror(errno)));
    return WIFEXITED(state) && WEXITSTATUS(state) == 0 ? 0 : -1;
}

int run_gnuplot(const char *folder)
{
    char *const arguments[] = { "gnuplot", "-d", "plots.gnuplot", NULL };
    setenv("LC_ALL", "C.UTF-8", 1);      /* without a locale, as in a container, it warns of degree signs */
    const int code = run_tool(folder, arguments, tr("draws the pictures"), "gnuplot-nox", 0, NULL);
    return code < 0 ? complain("gnuplot failed on %s/plots.gnuplot", folder) : code;
}

char *clear_place(const char *folder, const char *file)
{
    char *path = NULL;
    if (asprintf(&path, "%s/%s", folder, file) < 0) {
        complain("out of memory");
        return NULL;
    }
    if (unlink(path) == 0 || errno == ENOENT) return path;
    complain("cannot replace %s: %s", path, tr(strerror(errno)));
    free(path);
    return NULL;
}
