/* When outputs are: at the multiples of the interval, and where somebody asks for one besides. Only the times
   of the latter are kept; what follows each counts on from it. */
#include "record/record.h"
#include <jansson.h>
#include <math.h>
#include <stdlib.h>

/* What times may be off by, as a part of the time: far more than rounding, far less than the mean step
   of any run that ends. */
#define ROUNDING 1e-12

bool tobi_record_reaches(double t, double time) { return t >= time*(1.0 - ROUNDING); }

double tobi_record_next_after(double every, double t)
{
    return every > 0.0 ? (floor(t/every*(1.0 + ROUNDING)) + 1.0)*every : INFINITY;
}

int64_t tobi_record_count(double interval, double end)
{
    const double beats = fmin(fmax(floor(end/interval*(1.0 + ROUNDING)), 0.0), 1e18);
    return (int64_t)beats + 1 + !tobi_record_reaches(beats*interval, end);
}

double tobi_record_snap(double interval, double end)
{
    const double nearest = round(end/interval)*interval;
    return fabs(nearest - end) <= ROUNDING*end ? nearest : end;
}

static int64_t find_beat(const tobi_run *run, int64_t k, double *time)
{
    for (int64_t n = run->aside_count - 1; n >= 0; n--) {
        const tobi_aside *a = &run->aside[n];
        if (a->number > k) continue;
        if (a->number == k) *time = a->time;
        return a->beat + k - a->number - 1;
    }
    return k;
}

double tobi_record_time(const tobi_run *run, int64_t k)
{
    double time = NAN;
    const int64_t beat = find_beat(run, k, &time);
    return isnan(time) ? (double)beat*run->output.interval : time;
}

double tobi_record_time_taken(tobi_run *run, int64_t k)
{
    pthread_mutex_lock(&run->aside_lock);
    const double time = tobi_record_time(run, k);
    pthread_mutex_unlock(&run->aside_lock);
    return time;
}

static tobi_status put(tobi_run *run, tobi_aside aside, tobi_error *err)
{
    const int64_t count = run->aside_count;
    if (count > 0 && run->aside[count - 1].number == aside.number) run->aside_count--;
    if (run->aside_count == run->aside_room) {
        const int64_t room = 2*run->aside_room + 4;
        tobi_aside *list = realloc(run->aside, (size_t)room*sizeof *list);
        if (!list) return tobi_fail(err, TOBI_NO_MEMORY, "output: out of memory");
        run->aside = list;
        run->aside_room = room;
    }
    run->aside[run->aside_count++] = aside;
    return TOBI_OK;
}

static tobi_status add(tobi_run *run, tobi_aside aside, tobi_error *err)
{
    pthread_mutex_lock(&run->aside_lock);
    const tobi_status status = put(run, aside, err);
    pthread_mutex_unlock(&run->aside_lock);
    return status;
}

tobi_status tobi_record_note_time(tobi_run *run, double t, tobi_error *err)
{
    const double due = tobi_record_time(run, run->outputs), every = run->output.interval;
    if (tobi_record_reaches(t, due) && tobi_record_reaches(due, t)) return TOBI_OK;
    const double next = fmax(due, tobi_record_next_after(every, t));
    return add(run, (tobi_aside){ run->outputs, llround(next/every), t }, err);
}

json_t *tobi_record_times_to_json(const tobi_run *run)
{
    json_t *list = json_array();
    for (int64_t n = 0; n < run->aside_count; n++) {
        const tobi_aside *a = &run->aside[n];
        json_array_append_new(list, json_pack("[I, I, f]", (json_int_t)a->number, (json_int_t)a->beat,
                                              a->time));
    }
    return list;
}

bool tobi_record_times_from_json(json_t *list, tobi_run *run)
{
    run->aside_count = 0;
    for (size_t n = 0; n < json_array_size(list); n++) {         /* no list in older ones */
        json_int_t number, beat;
        tobi_aside a = { 0 };
        if (json_unpack(json_array_get(list, n), "[I, I, F]", &number, &beat, &a.time) != 0) return false;
        a.number = number;
        a.beat = beat;
        if (add(run, a, NULL) != TOBI_OK) return false;
    }
    return true;
}
