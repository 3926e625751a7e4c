/* Checkpoints: the world's state in checkpoint_<step>.h5, the recorder's in checkpoint_<step>.json.

   The small file is written first, so that a state file always has its companion; both appear whole
   or not at all. The two newest are kept, because the newest may turn out damaged.

   After a power cut a checkpoint is worth what it can go on from: before it appears, all that the
   run has written so far is on the disk, by one call for the whole file system (syncfs). Drawback:
   that waits for what other programs have written there, too; but outputs never wait. */
#define _GNU_SOURCE 1
#include "base/plain.h"
#include "base/file.h"
#include "record/record.h"
#include "world/world.h"
#include <errno.h>
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { KEEP = 2, LIMIT = 256, COMPANION_LIMIT = 64 << 20 /* bytes */ };

static char *checkpoint_path(const tobi_run *run, int64_t step, const char *extension)
{
    return tobi_record_path(run->dir, "checkpoints/checkpoint_%08lld.%s", (long long)step,
                            extension);
}

static json_t *tally_to_json(const tobi_tally *t)
{
    return json_pack("{s:I, s:I, s:f, s:f, s:f, s:f, s:f}", "steps", (json_int_t)t->steps, "unconverged",
                     (json_int_t)t->unconverged, "density_iterations", t->density_iterations,
                     "divergence_iterations", t->divergence_iterations, "density_error_mean",
                     t->density_error_mean, "density_error_max", t->density_error_max, "residual_max",
                     t->residual_max);
}

static bool tally_from_json(json_t *json, tobi_tally *t)
{
    json_int_t steps = 0, unconverged = 0;
    int answer =
        json_unpack(json, "{s:I, s:I, s:F, s:F, s:F, s:F, s?F}", "steps", &steps, "unconverged",
                    &unconverged, "density_iterations", &t->density_iterations,
                    "divergence_iterations", &t->divergence_iterations, "density_error_mean",
                    &t->density_error_mean, "density_error_max", &t->density_error_max, "residual_max",
                    &t->residual_max);
    t->steps = steps;
    t->unconverged = unconverged;
    return answer == 0;
}

static json_t *bodies_to_json(const tobi_run *run)
{
    json_t *list = json_array();
    for (int k = 0; k < tobi_world_body_count(run->world); k++) {
        const tobi_body_tally *t = &run->body_since[k];
        json_t *row = json_array();
        json_array_append_new(row, json_real(t->time));
        for (int v = 0; v < 3*TOBI_BODY_FORCES; v++)
            json_array_append_new(row, json_real(t->impulse[v/3][v%3]));
        json_array_append_new(list, row);
    }
    return list;
}

static bool bodies_from_json(json_t *list, tobi_run *run)
{
    int bodies = tobi_world_body_count(run->world);
    if ((int)json_array_size(list) != bodies) return false;
    for (int k = 0; k < bodies; k++) {
        json_t *row = json_array_get(list, (size_t)k);
        if (json_array_size(row) != 1 + 3*TOBI_BODY_FORCES) return false;
        run->body_since[k].time = json_number_value(json_array_get(row, 0));
        for (int v = 0; v < 3*TOBI_BODY_FORCES; v++)
            run->body_since[k].impulse[v/3][v%3] = json_number_value(json_array_get(row, (size_t)v + 1));
    }
    return true;
}

static json_t *solids_to_json(const tobi_run *run)
{
    json_t *list = json_array();
    for (int k = 0; k < tobi_world_solid_count(run->world); k++) {
        const tobi_solid_tally *t = &run->solid_since[k];
        json_array_append_new(list, json_pack("[f, f, f, f]", t->time, t->impulse[0], t->impulse[1],
                                              t->impulse[2]));
    }
    return list;
}

static bool solids_from_json(json_t *list, tobi_run *run)
{
    const int solids = list ? tobi_world_solid_count(run->world) : 0;        /* none in older ones */
    if ((int)json_array_size(list) != solids) return false;
    for (int k = 0; k < solids; k++) {
        tobi_solid_tally *t = &run->solid_since[k];
        if (json_unpack(json_array_get(list, (size_t)k), "[F, F, F, F]", &t->time, &t->impulse[0],
                        &t->impulse[1], &t->impulse[2]) != 0)
            return false;
    }
    return true;
}

static tobi_status write_json(const char *path, const json_t *json, tobi_error *err)
{
    char *text = json ? json_dumps(json, JSON_INDENT(2)) : NULL;
    if (!text || !path) {
        free(text);
        return tobi_fail(err, TOBI_NO_MEMORY, "checkpoint: out of memory");
    }
    tobi_file file;
    tobi_status status = tobi_file_open(&file, path, err);
    if (status == TOBI_OK) {
        tobi_file_write(&file, text, strlen(text));
        tobi_file_write(&file, "\n", 1);
        status = tobi_file_commit(&file, err);
    }
    free(text);
    return status;
}

static void remove_checkpoint(const tobi_run *run, int64_t step)
{
    static const char *const extensions[] = { "h5", "json" };
    for (int k = 0; k < 2; k++) {
        char *path = checkpoint_path(run, step, extensions[k]);
        if (path) unlink(path);
        free(path);
    }
}

static void drop_old(const tobi_run *run, int64_t newest)
{
    int64_t steps[LIMIT];
    int count = tobi_record_checkpoints(run->dir, steps, LIMIT), kept = 0;
    for (int k = 0; k < count; k++) {
        /* Steps beyond this one are left from a run that went further before it was cut back. */
        bool keep = steps[k] <= newest && kept < KEEP;
        if (keep) kept++;
        else remove_checkpoint(run, steps[k]);
    }
}

static tobi_status sync_files(const tobi_run *run, tobi_error *err)
{
    if (syncfs(run->lock) == 0) return TOBI_OK;
    return tobi_fail(err, TOBI_IO, "cannot write the results in %s: %s", run->dir, tobi_reason(errno));
}

tobi_status tobi_state_save(tobi_run *run, tobi_error *err)
{
    int64_t step = tobi_world_info(run->world)->step;
    json_t *json =
        json_pack("{s:I, s:f, s:I, s:o, s:f, s:f, s:f, s:o, s:o, s:o, s:o, s:o, s:o}", "step",
                  (json_int_t)step, "time", tobi_world_time(run->world), "outputs",
                  (json_int_t)run->outputs, "outputs_aside", tobi_record_times_to_json(run), "wall_s",
                  run->wall + tobi_record_clock() - run->begun, "step_wall_s", run->step_wall,
                  "particle_steps", run->particle_steps, "since_output", tally_to_json(&run->since),
                  "total", tally_to_json(&run->total), "bodies_since_output", bodies_to_json(run),
                  "solids_since_output", solids_to_json(run), "sensors", tobi_probes_to_json(run), "works",
                  tobi_works_to_json(run));
    char *companion = checkpoint_path(run, step, "json"), *state = checkpoint_path(run, step, "h5");
    tobi_status status = write_json(companion, json, err);
    if (status == TOBI_OK) status = sync_files(run, err);
    if (status == TOBI_OK)
        status = state ? tobi_world_save(run->world, state, err)
                       : tobi_fail(err, TOBI_NO_MEMORY, "checkpoint: out of memory");
    json_decref(json);
    free(companion);
    free(state);
    if (status != TOBI_OK) remove_checkpoint(run, step);      /* the small file of none */
    if (status != TOBI_OK) return status;
    run->checkpoint_step = step;
    run->checkpoint_outputs = run->outputs;
    drop_old(run, step);
    return TOBI_OK;
}

/* The recorder's part; it must fit the world's, which is loaded already. */
static tobi_status read_companion(tobi_run *run, const char *path, tobi_error *err)
{
    char *text;
    size_t size;
    tobi_plain_read(path, tr("checkpoint"), COMPANION_LIMIT, &text, &size, NULL);
    json_t *json = text ? json_loadb(text, size, 0, NULL) : NULL;
    json_t *since = NULL, *total = NULL, *bodies = NULL, *solids = NULL, *sensors = NULL, *aside = NULL,
           *works = NULL;
    json_int_t outputs = 0;
    double time = NAN;
    bool good =
        json_unpack(json, "{s:F, s:I, s?o, s:F, s:F, s:F, s:o, s:o, s:o, s?o, s?o, s?o}", "time", &time,
                    "outputs", &outputs, "outputs_aside", &aside, "wall_s", &run->wall, "step_wall_s",
                    &run->step_wall, "particle_steps", &run->particle_steps, "since_output", &since, "total",
                    &total, "bodies_since_output", &bodies, "solids_since_output", &solids, "sensors",
                    &sensors, "works", &works) == 0;
    good = good && tally_from_json(since, &run->since) && tally_from_json(total, &run->total) &&
           bodies_from_json(bodies, run) && solids_from_json(solids, run) &&
           tobi_record_times_from_json(aside, run) && tobi_works_from_json(works, run) &&
           tobi_probes_from_json(sensors, run);
    run->outputs = outputs;
    json_decref(json);
    free(text);
    if (!good) return tobi_fail(err, TOBI_DAMAGED, "%s: damaged or missing", path);
    if (time != tobi_world_time(run->world) || outputs < 1)
        return tobi_fail(err, TOBI_DAMAGED, "%s: does not belong to its checkpoint", path);
    return TOBI_OK;
}

static tobi_status load_one(tobi_run *run, int64_t step, tobi_error *err)
{
    char *companion = checkpoint_path(run, step, "json"), *state = checkpoint_path(run, step, "h5");
    tobi_status status =
        companion && state ? TOBI_OK : tobi_fail(err, TOBI_NO_MEMORY, "checkpoint: out of memory");
    if (status == TOBI_OK) status = tobi_world_load(run->world, state, err);
    if (status == TOBI_OK) status = read_companion(run, companion, err);
    free(companion);
    free(state);
    return status;
}

/* A nest is saved before the world around it: after a power cut between them its last but one counts. */
static bool is_ahead(const tobi_run *run)
{
    const tobi_world *outer = run->world->outer;
    return outer && tobi_world_time(run->world) > tobi_world_time(outer);
}

/* One that is behind the world around it would see nothing of what came between. */
static tobi_status check_gap(const tobi_run *run, tobi_error *err)
{
    const tobi_world *outer = run->world->outer;
    const double time = tobi_world_time(run->world), then = tobi_world_time(outer);
    if (!outer || time >= then) return TOBI_OK;
    return tobi_fail(err, TOBI_DAMAGED, "the nest in %s has a checkpoint of %.9g s, the run around it one of "
                     "%.9g s: remove that, for an earlier one", run->dir, time, then);
}

tobi_status tobi_state_load(tobi_run *run, bool *found, tobi_error *err)
{
    int64_t steps[LIMIT];
    int count = tobi_record_checkpoints(run->dir, steps, LIMIT);
    tobi_error first = { 0 }, why;
    *found = count > 0;
    if (count < 0)
        return tobi_fail(err, TOBI_IO, "cannot list the checkpoints in %s", run->dir);
    for (int k = 0; k < count; k++) {
        tobi_status status = load_one(run, steps[k], &why);
        if (k == 0 && status != TOBI_OK) first = why;
        if (status != TOBI_OK && status != TOBI_DAMAGED)
            return tobi_fail(err, status, "%s", why.text);
        if (status != TOBI_OK || is_ahead(run)) continue;
        TOBI_TRY(check_gap(run, err));
        run->checkpoint_step = steps[k];
        run->checkpoint_outputs = run->outputs;
        snprintf(run->note, sizeof run->note, tr("resumed at t = %.9g s, step %lld%s%.800s"),
                 tobi_world_time(run->world), (long long)steps[k],
                 *first.text ? tr("; a newer checkpoint is damaged: ") : "", first.text);
        return TOBI_OK;
    }
    if (count == 0) return TOBI_OK;
    if (!*first.text)
        return tobi_fail(err, TOBI_DAMAGED, "the nest in %s has no checkpoint that is as early as that of "
                         "the run around it, of %.9g s", run->dir, tobi_world_time(run->world->outer));
    return tobi_fail(err, TOBI_DAMAGED, "no whole checkpoint is left: %.1900s", first.text);
}
