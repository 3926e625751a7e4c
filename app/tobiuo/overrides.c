/* The list of "path=value" texts that options turn into. */
#define _GNU_SOURCE
#include "app.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

void overrides_add(overrides *o, const char *format, ...)
{
    va_list args;
    char *text = NULL;
    va_start(args, format);
    int length = vasprintf(&text, format, args);
    va_end(args);
    char **more = length < 0 ? NULL : realloc(o->text, (size_t)(o->count + 2) * sizeof *more);
    if (!more) exit(complain("out of memory"));
    more[o->count++] = text;
    more[o->count] = NULL;
    o->text = more;
}

void overrides_free(overrides *o)
{
    for (int k = 0; k < o->count; k++) free(o->text[k]);
    free(o->text);
}
