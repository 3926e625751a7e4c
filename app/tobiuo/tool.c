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

int run_tool(const char *folder, char *const arguments[], const char *does, const char *package, int quiet)
{
    posix_spawn_file_actions_t actions;
    pid_t child;
    int state = 0;
    posix_spawn_file_actions_init(&actions);
    if (folder) posix_spawn_file_actions_addchdir_np(&actions, folder);
    if (quiet) posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    const int failed = posix_spawnp(&child, arguments[0], &actions, NULL, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failed == ENOENT)
        return complain("%s is missing, and it %s. On Debian: apt-get install %s", arguments[0], does,
                        package);
    if (failed) return complain("%s does not start: %s", arguments[0], strerror(failed));
    while (waitpid(child, &state, 0) < 0)
        if (errno != EINTR) return complain("%s: %s", arguments[0], strerror(errno));
    return WIFEXITED(state) && WEXITSTATUS(state) == 0 ? 0 : -1;
}

int run_gnuplot(const char *folder)
{
    char *const arguments[] = { "gnuplot", "-d", "plots.gnuplot", NULL };
    setenv("LC_ALL", "C.UTF-8", 1);      /* without a locale, as in a container, it warns of degree signs */
    const int code = run_tool(folder, arguments, "draws the pictures", "gnuplot-nox", 0);
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
    complain("cannot replace %s: %s", path, strerror(errno));
    free(path);
    return NULL;
}
