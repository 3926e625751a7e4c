/* What the importer does not do: it says that an index is wrong but not where, and it knows neither .5 nor a
   byte order mark. */
#define _POSIX_C_SOURCE 200809L
#include "geom/obj_scan.h"
#include "base/plain.h"
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

/* A byte order mark, which editors of Windows put in front, is no part of the first line. */
static int has_mark(const char *text, size_t size)
{
    return size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0;
}

static void go_to_start(FILE *f)
{
    char mark[3];
    rewind(f);
    if (!has_mark(mark, fread(mark, 1, sizeof mark, f))) rewind(f);
}

static int is_vertex(const char *line) { return line[0] == 'v' && (line[1] == ' ' || line[1] == '\t'); }
static int is_face(const char *line) { return line[0] == 'f' && (line[1] == ' ' || line[1] == '\t'); }

int tobi_obj_scan(const char *path, tobi_obj_fault *fault)
{
    FILE *f;
    char *line = NULL;
    size_t room = 0;
    int found = 0;
    *fault = (tobi_obj_fault){0};
    if (tobi_plain_open(path, tr("mesh"), 0, &f, NULL, NULL) != TOBI_OK) return 0;
    go_to_start(f);
    while (getline(&line, &room, f) > 0) fault->vertices += is_vertex(line);
    go_to_start(f);
    for (int64_t so_far = 0; !found && getline(&line, &room, f) > 0;) {
        fault->line++;
        so_far += is_vertex(line);
        if (is_face(line)) fault->index = find_bad_index(line + 2, so_far, fault->vertices, &found);
    }
    free(line);
    fclose(f);
    return found;
}

static int is_blank(char c) { return c == ' ' || c == '\t'; }

/* Is text[i] the point of a number without digits before it? */
static int lacks_zero(const char *text, size_t i, size_t size)
{
    if (text[i] != '.' || i == 0 || i + 1 == size || text[i + 1] < '0' || text[i + 1] > '9') return 0;
    int sign = text[i - 1] == '-' || text[i - 1] == '+';
    return is_blank(text[i - 1]) || (sign && i > 1 && is_blank(text[i - 2]));
}

int tobi_obj_add_zeros(const char *path, char **text, size_t *size)
{
    size_t length, lacking = 0, at = 0, mark;
    char *old;
    *text = NULL;
    if (tobi_plain_read(path, tr("mesh"), 0, &old, &length, NULL) != TOBI_OK) return -1;
    for (size_t i = 0; i < length; i++) lacking += (size_t)lacks_zero(old, i, length);
    mark = has_mark(old, length) ? 3 : 0;
    *size = length + lacking - mark;
    if (lacking || mark) *text = malloc(*size + 1);
    for (size_t i = mark; *text && i < length; i++) {
        if (lacks_zero(old, i, length)) (*text)[at++] = '0';
        (*text)[at++] = old[i];
    }
    free(old);
    return !lacking && !mark ? 0 : *text ? 1 : -1;
}
