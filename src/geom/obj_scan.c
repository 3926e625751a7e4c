/* A plain reading of the v and f lines only, run after the importer refused a file: it says that an
   index is wrong but not where. */
#define _POSIX_C_SOURCE 200809L
#include "geom/obj_scan.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

/* The first bad vertex index of a face line, or 0 and found = 0. Negative ones count back from the
   vertices read so far. */
static int64_t find_bad_index(char *text, int64_t so_far, int64_t total, int *found)
{
    char *rest = NULL;
    *found = 0;
    for (char *word = strtok_r(text, " \t\r\n", &rest); word; word = strtok_r(NULL, " \t\r\n", &rest)) {
        char *end;
        int64_t index = strtoll(word, &end, 10);
        if (end == word) continue;
        *found = index == 0 || index > total || index < -so_far;
        if (*found) return index;
    }
    return 0;
}

static int is_vertex(const char *line) { return line[0] == 'v' && (line[1] == ' ' || line[1] == '\t'); }
static int is_face(const char *line) { return line[0] == 'f' && (line[1] == ' ' || line[1] == '\t'); }

int tobi_obj_scan(const char *path, tobi_obj_fault *fault)
{
    FILE *f = fopen(path, "r");
    char *line = NULL;
    size_t room = 0;
    int found = 0;
    *fault = (tobi_obj_fault){0};
    if (!f) return 0;
    while (getline(&line, &room, f) > 0) fault->vertices += is_vertex(line);
    rewind(f);
    for (int64_t so_far = 0; !found && getline(&line, &room, f) > 0;) {
        fault->line++;
        so_far += is_vertex(line);
        if (is_face(line)) fault->index = find_bad_index(line + 2, so_far, fault->vertices, &found);
    }
    free(line);
    fclose(f);
    return found;
}
