/* Values of options. */
#define _GNU_SOURCE
#include "app.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

double parse_positive(struct argp_state *state, const char *option, const char *text)
{
    char *end;
    double value = strtod(text, &end);
    if (end == text || *end != '\0' || !isfinite(value) || value <= 0.0)
        argp_error(state, "%s: '%s' is not a positive number", option, text);
    return value;
}

int parse_threads(struct argp_state *state, const char *text)
{
    char *end;
    long value = strtol(text, &end, 10);
    if (end == text || *end != '\0' || value < 0 || value > 4096)
        argp_error(state, "--threads: '%s' is not a number from 0 (all cores) to 4096", text);
    return (int)value;
}

char *scene_path(const char *path)
{
    struct stat st;
    char *file = NULL;
    int directory = stat(path, &st) == 0 && S_ISDIR(st.st_mode);
    if (asprintf(&file, "%s%s", path, directory ? "/scene.json" : "") < 0)
        exit(complain("out of memory"));
    return file;
}
