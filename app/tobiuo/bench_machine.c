/* The machine a measurement was made on. */
#define _DEFAULT_SOURCE
#include "bench.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

/* As src/exec chooses; TOBIUO_ISA can only lower it. */
static int instruction_set(void)
{
    int isa = 2;
#ifdef __x86_64__
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2") &&
        __builtin_cpu_supports("fma")) isa = 3;
    if (__builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512cd")) isa = 4;
#endif
    const char *wish = getenv("TOBIUO_ISA");
    int level = wish ? atoi(wish) : isa;
    return level >= 2 && level < isa ? level : isa;
}

static void print_processor(void)
{
    FILE *file = fopen("/proc/cpuinfo", "r");
    char line[256], model[256] = "unknown\n";
    while (file && fgets(line, sizeof line, file)) {
        const char *colon = strchr(line, ':');
        if (strncmp(line, "model name", 10) != 0 || !colon) continue;
        snprintf(model, sizeof model, "%s", colon + 2);
        break;
    }
    if (file) fclose(file);
    printf("processor              %s", model);
}

void bench_print_machine(int threads)
{
    double load[1] = { 0 };
    long cores = sysconf(_SC_NPROCESSORS_ONLN);
    print_processor();
    printf("threads                %ld of %ld cores\n", threads > 0 ? (long)threads : cores, cores);
#ifdef __x86_64__
    printf("instructions           x86-64-v%d\n", instruction_set());
#endif
    printf("version                %s\n", tobi_version());
    if (getloadavg(load, 1) == 1)
        printf("load before the start  %.1f%s\n", load[0],
               load[0] > 0.3 ? "  (other programs are running: the times are too long)" : "");
    fflush(stdout);
}

double bench_peak_rss(void)
{
    struct rusage use;
    return getrusage(RUSAGE_SELF, &use) == 0 ? 1024.0 * (double)use.ru_maxrss : 0.0;
}
