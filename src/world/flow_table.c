/* The flow of an inlet by a table: rows with the way that the flow has gone, so that what comes in is a
   function of time alone. Drawback: between rows it is linear, as a smooth curve could fall below 0. */
#include "world/openings.h"
#include "base/error.h"
#include "rigid/keyframes.h"
#include <math.h>
#include <stdlib.h>

/* The integral, 0 at time 0. */
static void find_ways(tobi_opening *o)
{
    for (int64_t k = 1; k < o->row_count; k++) {
        const tobi_flow_row *before = &o->rows[k - 1];
        tobi_flow_row *now = &o->rows[k];
        now->way = before->way + 0.5*(now->time - before->time)*(now->speed + before->speed);
    }
    const double start = tobi_opening_way_at(o, 0);
    for (int64_t k = 0; k < o->row_count; k++) o->rows[k].way -= start;
}

tobi_status tobi_opening_load_flow(tobi_opening *o, const char *path, double area, tobi_error *err)
{
    tobi_keyframes *frames;
    int is_rate;
    TOBI_TRY(tobi_keyframes_load_flow(path, &is_rate, &frames, err));
    o->row_count = tobi_keyframes_count(frames);
    o->rows = calloc((size_t)o->row_count, sizeof *o->rows);
    for (int64_t k = 0; o->rows && k < o->row_count; k++) {
        double value[3];
        o->rows[k].time = tobi_keyframes_row(frames, k, value);
        o->rows[k].speed = is_rate ? value[0]/area : value[0];
        o->speed = fmax(o->speed, o->rows[k].speed);
    }
    tobi_keyframes_free(frames);
    if (!o->rows) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the flow of inlet '%s'", o->name);
    find_ways(o);
    return TOBI_OK;
}
