/* Files made after a run, one for each output in a folder of its own, and ParaView's list of them.
   Drawback: a list names files by their numbers, whether they are there or not. */
#define _GNU_SOURCE
#include "app.h"
#include "tobiuo/results.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

char *join_path(const char *dir, const char *name)
{
    char *path = NULL;
    if (asprintf(&path, "%s/%s", dir, name) < 0) exit(complain("out of memory"));
    return path;
}

int make_series_folder(const char *path)
{
    struct stat st;
    if (mkdir(path, 0777) != 0 && errno != EEXIST) return complain("cannot make %s: %s", path,
                                                                   tr(strerror(errno)));
    if (lstat(path, &st) != 0 || !S_ISDIR(st.st_mode)) return complain("%s is no folder", path);
    return 0;
}

int write_series_list(const char *dir, const char *name, const tobi_results *results, int64_t first)
{
    char *before = NULL;
    if (asprintf(&before, "%s/", name) < 0) exit(complain("out of memory"));
    const series s = { dir, before, name, "vtp", first, tobi_results_count(results) };
    const int code = write_list(&s, results);
    free(before);
    return code;
}

int write_list(const series *s, const tobi_results *results)
{
    char *path = NULL, *part = NULL;
    if (asprintf(&path, "%s/%s.pvd", s->dir, s->name) < 0 || asprintf(&part, "%s.part", path) < 0)
        exit(complain("out of memory"));
    unlink(part);
    FILE *file = fopen(part, "wx");
    if (file)
        fputs("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n", file);
    for (int64_t k = s->first; file && k < s->end; k++)
        fprintf(file, "<DataSet timestep=\"%.17g\" name=\"%s\" file=\"%s%s_%06lld.%s\"/>\n",
                tobi_results_time(results, k), s->name, s->folder, s->name, (long long)k, s->ending);
    if (file) fputs("</Collection>\n</VTKFile>\n", file);
    const int bad = !file || ferror(file);
    int code = (file && fclose(file) != 0) || bad || rename(part, path) != 0
        ? complain("cannot write %s: %s", path, tr(strerror(errno))) : 0;
    free(path);
    free(part);
    return code;
}
