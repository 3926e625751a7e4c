/* tobiuo: picks the command. */
#include "app.h"
#include <errno.h>
#include <fcntl.h>
#include <malloc.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const command commands[] = {
    { "run", "SCENE", "simulate a scene", tobiuo_run, &run_argp },
    { "resume", "DIR", "go on with a run that was stopped", tobiuo_resume, &resume_argp },
    { "check", "SCENE", "say what a scene would do, and all its mistakes, without running", tobiuo_check,
      &check_argp },
    { "scenes", "", "list the shipped scenes", tobiuo_scenes, &scenes_argp },
    { "new", "NAME [DIR]", "write a scene of a family, or copy a shipped one, to change it", tobiuo_new,
      &new_argp },
    { "sweep", "SCENE", "run a scene with all combinations of some values, and compare", tobiuo_sweep,
      &sweep_argp },
    { "import", "SCENE", "translate a scene of the Taichi or the tank program into a native one",
      tobiuo_import, &import_argp },
    { "plot", "DIR", "draw the tables of a run as pictures", tobiuo_plot, &plot_argp },
    { "waves", "DIR", "significant heights, spectra and reflection of the waves at the gauges of a run",
      tobiuo_waves, &waves_argp },
    { "movie", "DIR", "make a movie of the pictures of a run", tobiuo_movie, &movie_argp },
    { "view", "DIR", "look at the results of a run in a window", tobiuo_view, &view_argp },
    { "picture", "DIR", "draw a picture of an output of a run", tobiuo_picture, &picture_argp },
    { "surface", "DIR", "make the surfaces of a run, for ParaView, Blender and others", tobiuo_surface,
      &surface_argp },
    { "foam", "DIR", "make spray, foam and bubbles of a run, for its pictures", tobiuo_foam, &foam_argp },
    { "sample", "DIR", "fields of a run at places: profiles along lines, grids, means over time",
      tobiuo_sample, &sample_argp },
    { "report", "DIR", "write one page about a run: pictures, tables, what to trust", tobiuo_report,
      &report_argp },
    { "inspect", "SCENE", "write the neighbour search of a particle and the kernels as files", tobiuo_inspect,
      &inspect_argp },
    { "describe", "[WORD]", "tell any key, field, column or topic: unit, default, range", tobiuo_describe,
      &describe_argp },
    { "bench", "[CASE]", "measure the speed of this machine", tobiuo_bench, &bench_argp },
    { "info", "", "version, machine, libraries, methods", tobiuo_info, &info_argp },
};
enum { COMMAND_COUNT = sizeof commands / sizeof *commands };

const command *command_at(int index) { return index < COMMAND_COUNT ? &commands[index] : NULL; }

static int complain_command(const char *word)
{
    const char *names[COMMAND_COUNT];
    for (int k = 0; k < COMMAND_COUNT; k++) names[k] = commands[k].name;
    const char *near = tobi_suggest(word, names, COMMAND_COUNT);
    complain("there is no command '%s'%s%s%s", word, near ? tr("; did you mean ") : "", near ? near : "",
             near ? "?" : "");
    if (!near) print_usage(stderr);
    return EXIT_USAGE;
}

static int run_command(int argc, char **argv)
{
    for (int k = 0; k < COMMAND_COUNT; k++) {
        if (strcmp(argv[0], commands[k].name) != 0) continue;
        char name[32];
        snprintf(name, sizeof name, "tobiuo %s", commands[k].name);
        argv[0] = name;                       /* messages of usage begin with it */
        return commands[k].run(argc, argv);
    }
    return complain_command(argv[0]);
}

static int print_help(int argc, char **argv)
{
    static char help[] = "--help";
    if (argc > 1) return run_command(2, (char *[]){ argv[1], help, NULL });
    print_usage(stdout);
    return 0;
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
    complain("cannot write to standard output%s%s", errno ? ": " : "", errno ? tr(strerror(errno)) : "");
    _exit(EXIT_ERROR);
}

/* Memory that a picture or a surface gives back is kept for the next one: to ask the system for it each time
   takes a tenth of a picture's time. */
static void keep_memory(void)
{
    mallopt(M_MMAP_THRESHOLD, 32 << 20);
    mallopt(M_TRIM_THRESHOLD, 512 << 20);
}

int main(int argc, char **argv)
{
    keep_memory();
    signal(SIGXFSZ, SIG_IGN);       /* a file beyond a limit fails, then, as on a full disk */
    open_closed_streams();
    if (atexit(check_output) != 0) return EXIT_ERROR;
    wait_without_spinning(argv);
    argp_err_exit_status = EXIT_USAGE;
    choose_language(NULL);
    const int taken = take_language(argc, argv);
    if (taken < 0) return EXIT_USAGE;
    argc -= taken, argv += taken;
    if (argc < 2) {
        print_usage(stderr);
        return EXIT_USAGE;
    }
    const char *word = argv[1];
    if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0 || strcmp(word, "help") == 0)
        return print_help(argc - 1, argv + 1);
    if (strcmp(word, "--version") == 0 || strcmp(word, "-V") == 0) {
        printf("tobiuo %s\n", tobi_version());
        return 0;
    }
    if (strcmp(word, "--man") == 0) return print_man_page(), 0;              /* for the installation */
    if (strcmp(word, "--completion") == 0) return print_completion(), 0;
    return run_command(argc - 1, argv + 1);
}
