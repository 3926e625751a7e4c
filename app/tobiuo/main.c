/* tobiuo: picks the command. */
#include "app.h"
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const struct command {
    const char *name, *arguments, *doc;
    int (*run)(int argc, char **argv);
} commands[] = {
    { "run", "SCENE", "simulate a scene", tobiuo_run },
    { "resume", "DIR", "go on with a run that was stopped", tobiuo_resume },
    { "check", "SCENE", "say what a scene would do, and all its mistakes, without running",
      tobiuo_check },
    { "import", "SCENE", "translate a scene of the Taichi program into a native one", tobiuo_import },
    { "plot", "DIR", "draw the tables of a run as pictures", tobiuo_plot },
    { "describe", "[TOPIC]", "parameters with units, defaults and ranges", tobiuo_describe },
    { "bench", "[CASE]", "measure the speed of this machine", tobiuo_bench },
    { "info", "", "version, machine, libraries, methods", tobiuo_info },
};
enum { COMMAND_COUNT = sizeof commands / sizeof *commands };

static void print_usage(FILE *file)
{
    fprintf(file, "usage: tobiuo COMMAND [ARGUMENTS]\n\n");
    for (int k = 0; k < COMMAND_COUNT; k++)
        fprintf(file, "  %-8s %-8s %s\n", commands[k].name, commands[k].arguments, commands[k].doc);
    fprintf(file, "\n\"tobiuo COMMAND --help\" lists the options of a command.\n");
}

/* Threads that spin at a barrier steal the core from the one they wait for wherever cores are shared
   (measured: several times slower). The OpenMP runtime reads its policy before main, so the program
   starts itself once more with waiting threads asleep, unless the user has chosen a policy. */
static void wait_without_spinning(char **argv)
{
    if (getenv("OMP_WAIT_POLICY") || setenv("OMP_WAIT_POLICY", "passive", 1) != 0) return;
    char path[4096];
    ssize_t length = readlink("/proc/self/exe", path, sizeof path - 1);
    if (length <= 0) return;
    path[length] = 0;
    execv(path, argv);   /* returns only if it failed: then threads spin */
}

/* A file opened in the place of a closed stream would receive what is meant for that. */
static void open_closed_streams(void)
{
    for (int k = STDIN_FILENO; k <= STDERR_FILENO; k++)
        if (fcntl(k, F_GETFD) < 0 && open("/dev/null", O_RDWR) != k) _exit(EXIT_ERROR);
}

/* At every exit, those inside argp too: what could not be printed is no success. */
static void check_output(void)
{
    errno = 0;
    if (fflush(stdout) == 0 && !ferror(stdout)) return;
    complain("cannot write to standard output%s%s", errno ? ": " : "", errno ? strerror(errno) : "");
    _exit(EXIT_ERROR);
}

int main(int argc, char **argv)
{
    open_closed_streams();
    if (atexit(check_output) != 0) return EXIT_ERROR;
    wait_without_spinning(argv);
    argp_err_exit_status = EXIT_USAGE;
    if (argc < 2) {
        print_usage(stderr);
        return EXIT_USAGE;
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0 ||
        strcmp(argv[1], "help") == 0) {
        print_usage(stdout);
        return 0;
    }
    if (strcmp(argv[1], "--version") == 0 || strcmp(argv[1], "-V") == 0) {
        printf("tobiuo %s\n", tobi_version());
        return 0;
    }
    for (int k = 0; k < COMMAND_COUNT; k++) {
        if (strcmp(argv[1], commands[k].name) != 0) continue;
        char name[32];
        snprintf(name, sizeof name, "tobiuo %s", commands[k].name);
        argv[1] = name;                       /* argp's messages begin with it */
        return commands[k].run(argc - 1, argv + 1);
    }
    fprintf(stderr, "tobiuo: there is no command '%s'\n", argv[1]);
    print_usage(stderr);
    return EXIT_USAGE;
}
