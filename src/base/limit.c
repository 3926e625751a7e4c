/* Limits of memory for child processes (mesh import, scripts).

   The kernel counts address space from zero and a child begins with its parent's, so the limit is put above
   what /proc says is there. Drawback: without /proc there is none. */
#include "base/limit.h"
#include <stdio.h>
#include <sys/resource.h>
#include <unistd.h>

void tobi_limit_memory(uint64_t bytes)
{
    (void)bytes;
    setrlimit(RLIMIT_CORE, &(struct rlimit){ 0, 0 });
#ifndef __SANITIZE_ADDRESS__       /* its shadow memory maps terabytes */
    FILE *file = fopen("/proc/self/statm", "r");
    unsigned long pages = 0;
    if (!file) return;
    if (fscanf(file, "%lu", &pages) == 1) {
        rlim_t limit = (rlim_t)pages*(rlim_t)sysconf(_SC_PAGESIZE) + bytes;
        setrlimit(RLIMIT_AS, &(struct rlimit){ limit, limit });
    }
    fclose(file);
#endif
}
