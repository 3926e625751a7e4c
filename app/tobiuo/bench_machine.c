/* The machine a measurement was made on. */
#define _DEFAULT_SOURCE
#include "bench.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#ifdef __x86_64__
/* As src/exec chooses; TOBIUO_ISA can only lower it. */
static int instruction_set(void)
{
    int isa = 2;
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2") &&
        __builtin_cpu_supports("fma")) isa = 3;
    if (__builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512cd")) isa = 4;
    const char *wish = getenv("TOBIUO_ISA");
    int level = wish ? atoi(wish) : isa;
    return level >= 2 && level < isa ? level : isa;
}
#endif

static void find_processor(char *model, size_t size)
{
    FILE *file = fopen("/proc/cpuinfo", "r");
    char line[256];
    snprintf(model, size, "unknown");
    while (file && fgets(line, sizeof line, file)) {
        const char *colon = strchr(line, ':');
        if (strncmp(line, "model name", 10) != 0 || !colon) continue;
        snprintf(model, size, "%s", colon + 2);
        model[strcspn(model, "\n")] = '\0';
        break;
    }
    if (file) fclose(file);
}

void bench_find_machine(int threads, bench_machine *machine)
{
    find_processor(machine->processor, sizeof machine->processor);
    machine->cores = sysconf(_SC_NPROCESSORS_ONLN);
    machine->threads = threads > 0 ? threads : machine->cores;
#ifdef __x86_64__
    machine->isa = instruction_set();
#endif
    if (getloadavg(&machine->load, 1) != 1) machine->load = -1.0;
}

void bench_print_machine(const bench_machine *machine)
{
    printf("processor              %s\n", machine->processor);
    printf("threads                %ld of %ld cores\n", machine->threads, machine->cores);
    if (machine->isa) printf("instructions           x86-64-v%d\n", machine->isa);
    printf("version                %s\n", tobi_version());
    if (machine->load >= 0.0)
        printf("load before the start  %.1f%s\n", machine->load,
               machine->load > 0.3 ? "  (other programs are running: the times are too long)" : "");
    fflush(stdout);
}

double bench_peak_rss(void)
{
    struct rusage use;
    return getrusage(RUSAGE_SELF, &use) == 0 ? 1024.0 * (double)use.ru_maxrss : 0.0;
}
