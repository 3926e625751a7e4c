/* Numbers are written with 17 digits, so that a scene that was written reads back the same bits. Drawback: a
   list of points is held twice while it is read. */
#define _GNU_SOURCE
#include "scene/point_list.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double FARTHEST = 1e7;         /* m, as of all places in a scene */

/* 1: a pair of coordinates; else a mistake. */
static int check_point(tobi_source *source, const tobi_place *place, const json_t *point, double at[2])
{
    for (int a = 0; a < 2; a++) {
        const json_t *number = json_array_get(point, (size_t)a);
        tobi_place coordinate = { place, NULL, (size_t)a };
        if (json_array_size(point) != 2 || !json_is_number(number))
            return tobi_source_mistake(source, place, "must be a point, a list of 2 numbers"), 0;
        at[a] = json_number_value(number);
        if (!(fabs(at[a]) <= FARTHEST))
            return tobi_source_mistake(source, &coordinate, "is %.10g, allowed is -%g to %g m", at[a],
                                       FARTHEST, FARTHEST), 0;
    }
    return 1;
}

int tobi_point_list_read(tobi_source *source, const tobi_place *place, json_t *value, char **text)
{
    size_t length, i;
    json_t *point;
    double at[2];
    int good = json_array_size(value) > 0;
    *text = NULL;
    if (!good) tobi_source_mistake(source, place, "must be a list of points, each a list of 2 numbers");
    FILE *out = good ? open_memstream(text, &length) : NULL;
    json_array_foreach(value, i, point) {
        tobi_place entry = { place, NULL, i };
        good &= check_point(source, &entry, point, at);
        if (out && good) fprintf(out, "%s%.17g,%.17g", i ? " " : "", at[0], at[1]);
    }
    if ((!out || fclose(out) != 0 || !good) && *text) {
        free(*text);
        *text = NULL;
    }
    return good;
}

json_t *tobi_point_list_write(const char *text)
{
    json_t *list = json_array();
    int failed = !list;
    while (*text && !failed) {
        char *end;
        const double u = strtod(text, &end), v = *end == ',' ? strtod(end + 1, &end) : 0;
        failed = json_array_append_new(list, json_pack("[ff]", u, v));
        text = end + (*end == ' ');
    }
    if (!failed) return list;
    json_decref(list);
    return NULL;
}
