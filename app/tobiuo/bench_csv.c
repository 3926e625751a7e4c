/* Rows of measurements, for docs/benchmarks: a file per machine and commit, which its name tells. Times are
   per step, so that cases without particles have the same columns. Drawback: stages are not in it. */
#include "bench.h"
#include <errno.h>
#include <stdio.h>
#include <string.h>

int bench_write(const bench_options *o, const char *name, const bench_run *run)
{
    const bench_machine *m = &o->machine;
    const bench_result *r = &run->result;
    if (!o->csv) return 0;
    FILE *file = fopen(o->csv, "a");
    if (!file) return complain("%s: %s", o->csv, tr(strerror(errno)));
    int failed = fseek(file, 0, SEEK_END) != 0;
    if (!failed && ftell(file) == 0)
        failed = fprintf(file, "case,version,processor,cores,threads,isa,load,particles,steps,step_ms,"
                         "median_ms,processor_ms,bytes,density_iterations,divergence_iterations,state\n") < 0;
    if (!failed)
        failed = fprintf(file, "%s,%s,\"%s\",%ld,%ld,%d,%.1f,%lld,%d,%.5g,%.5g,%.5g,%.0f,%.3f,%.3f,%016llx\n",
                         name, tobi_version(), m->processor, m->cores, m->threads, m->isa, m->load,
                         (long long)r->particles, r->steps, 1e3 * r->seconds / r->steps, 1e3 * r->median,
                         1e3 * r->processor / r->steps, (double)tobi_world_bytes(run->world),
                         r->density_iterations, r->divergence_iterations,
                         (unsigned long long)tobi_world_hash(run->world)) < 0;
    failed |= fclose(file) != 0;
    return failed ? complain("%s: %s", o->csv, tr(strerror(errno))) : 0;
}
