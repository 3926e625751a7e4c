/* The life of a run: create or resume, step, output, finish. The files are made in record_*.c. */
#include "base/plain.h"
#include "base/file.h"
#include "base/param.h"
#include "record/record.h"
#include "world/world.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

double tobi_record_clock(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static double next_checkpoint_after(const tobi_run *run, double t)
{
    return tobi_record_next_after(run->output.checkpoint_interval, t);
}

/* What create and resume share: a run with its directory locked and the world started. */
static tobi_status open_run(tobi_world *world, const tobi_output_def *output, const char *dir,
                            tobi_run **out, tobi_error *err)
{
    tobi_run *run = calloc(1, sizeof *run);
    *out = run;
    if (run) {
        run->world = world;
        run->dir = strdup(dir);
        run->body_since = calloc((size_t)tobi_world_body_count(world) + 1, sizeof *run->body_since);
        run->solid_since = calloc((size_t)tobi_world_solid_count(world) + 1, sizeof *run->solid_since);
    }
    if (!run || !run->dir || !run->body_since || !run->solid_since || !tobi_works_open(run)) {
        if (run) {
            tobi_works_free(run);
            free(run->dir);
            free(run->body_since);
            free(run->solid_since);
        }
        free(run);
        *out = NULL;
        return tobi_fail(err, TOBI_NO_MEMORY, "run: out of memory");
    }
    run->output = *output;
    run->lock = -1;
    run->dir_lock = run->trouble_lock = run->aside_lock = (pthread_mutex_t)PTHREAD_MUTEX_INITIALIZER;
    run->checkpoint_step = -1;
    run->begun = tobi_record_clock();
    TOBI_TRY(tobi_series_fields(run, err));
    return tobi_record_open_dir(dir, &run->lock, err);
}

static tobi_status write_text(const char *dir, const char *name, const char *text, tobi_error *err)
{
    char *path = tobi_record_path(dir, "%s", name);
    if (!path) return tobi_fail(err, TOBI_NO_MEMORY, "run: out of memory");
    tobi_file file;
    tobi_status status = tobi_file_open(&file, path, err);
    if (status == TOBI_OK) {
        tobi_file_write(&file, text, strlen(text));
        status = tobi_file_commit(&file, err);
    }
    free(path);
    return status;
}

/* The text of resolved.json into run->resolved, NULL if it is not there. */
static tobi_status read_scene(tobi_run *run, tobi_error *err)
{
    size_t size;
    char *path = tobi_record_path(run->dir, "resolved.json");
    tobi_status status = path ? tobi_plain_read(path, tr("scene"), 0, &run->resolved, &size, err)
                              : tobi_fail(err, TOBI_NO_MEMORY, "run: out of memory");
    free(path);
    return status == TOBI_NOT_FOUND ? TOBI_OK : status;
}

/* resolved.json, if it is not there: without it a run cannot be resumed. */
static tobi_status keep_scene(const tobi_run *run, tobi_error *err)
{
    char *path = run->resolved ? tobi_record_path(run->dir, "resolved.json") : NULL;
    if (run->resolved && !path) return tobi_fail(err, TOBI_NO_MEMORY, "run: out of memory");
    const bool there = !path || access(path, F_OK) == 0;
    free(path);
    return there ? TOBI_OK : write_text(run->dir, "resolved.json", run->resolved, err);
}

/* Sums up what was deleted. The writer has nothing to do meanwhile. */
static void tell_losses(tobi_run *run)
{
    const struct { const tobi_csv *csv; const char *name; } tables[] = {
        { run->history, "history.csv" }, { run->bodies, "bodies.csv" },
        { run->solids, "solids.csv" }, { run->probes, "probes.csv" },
        { run->lines, "lines.csv" }, { run->joints, "joints.csv" },
        { run->porous, "porous_zones.csv" }, { run->scalars, "scalars.csv" } };
    char *at = run->losses, *end = at + sizeof run->losses;
    *at = '\0';
    if (run->lost_dir) at += snprintf(at, (size_t)(end - at),
                                      tr("the directory was deleted and made again; "));
    for (size_t k = 0; k < sizeof tables/sizeof *tables; k++)
        if (tables[k].csv && tobi_csv_has_lost(tables[k].csv))
            at += snprintf(at, (size_t)(end - at), tr("%s was deleted and begins anew; "), tables[k].name);
    if (run->history_missing > 0)
        at += snprintf(at, (size_t)(end - at), tr("history.csv lacks rows of earlier outputs: %lld; "),
                       (long long)run->history_missing);
    at += tobi_trouble_write(run, at, (size_t)(end - at));
    const int64_t missing = run->missing - run->trouble[TOBI_KIND_PARTICLES].files -
                            run->trouble[TOBI_KIND_SURFACES].files;      /* said already */
    if (missing > 0)
        at += snprintf(at, (size_t)(end - at),
                       tr("missing files of earlier outputs: %lld (the lists, *.pvd, leave them out); "),
                       (long long)missing);
    if (at > run->losses) at[-2] = '\0';
}

static const char *name_of(const tobi_run *nest)
{
    const char *slash = strrchr(nest->dir, '/');
    return slash ? slash + 1 : nest->dir;
}

/* Behind the losses of the run itself. */
static void tell_nest_losses(tobi_run *run, const tobi_run *nest)
{
    const size_t used = strlen(run->losses);
    if (*nest->losses)
        snprintf(run->losses + used, sizeof run->losses - used, tr("%snest %s: %s"), used ? "; " : "",
                 name_of(nest), nest->losses);
}

/* From a started world in a directory without results to output 0. */
static tobi_status begin(tobi_run *run, tobi_error *err)
{
    TOBI_TRY(tobi_series_prepare(run, err));
    TOBI_TRY(tobi_tables_open(run, false, err));
    run->next_checkpoint = next_checkpoint_after(run, 0.0);
    TOBI_TRY(tobi_writer_start(run, err));
    TOBI_TRY(tobi_run_output(run, err));
    return tobi_writer_wait(run->writer, err);
}

tobi_status tobi_run_check_directory(const char *dir, tobi_error *err)
{
    bool found;
    TOBI_NEED(dir, "the directory");
    TOBI_TRY(tobi_record_find_results(dir, &found, err));
    if (!found) return TOBI_OK;
    return tobi_fail(err, TOBI_INVALID, "%s: holds the results of a run; nothing was changed"
                     " (choose another directory, or --force to replace them)", dir);
}

static tobi_status create(tobi_run *run, int force, const char *resolved, tobi_error *err)
{
    if (!force) TOBI_TRY(tobi_run_check_directory(run->dir, err));
    /* A world that cannot start must not cost the old results. */
    TOBI_TRY(tobi_world_start(run->world, err));
    read_scene(run, NULL);                          /* one that cannot be read names no nests */
    TOBI_TRY(tobi_record_clear_nests(run->dir, run->resolved, err));
    free(run->resolved);
    run->resolved = NULL;
    TOBI_TRY(tobi_record_clear(run->dir, false, err));
    if (resolved && !(run->resolved = strdup(resolved)))
        return tobi_fail(err, TOBI_NO_MEMORY, "run: out of memory");
    TOBI_TRY(keep_scene(run, err));
    return begin(run, err);
}

tobi_status tobi_run_create(tobi_world *world, const tobi_output_def *output, const char *dir,
                            int force, const char *resolved_json, tobi_run **out, tobi_error *err)
{
    TOBI_NEED(out, "where the run goes");
    *out = NULL;
    TOBI_NEED_WORLD(world);
    TOBI_NEED(output, "the output");
    TOBI_NEED(dir, "the directory");
    TOBI_TRY(tobi_param_check(&tobi_output_table, output, err));
    tobi_run *run = NULL;
    tobi_status status = open_run(world, output, dir, &run, err);
    if (status == TOBI_OK) status = create(run, force, resolved_json, err);
    if (status != TOBI_OK) {
        tobi_run_free(run);
        run = NULL;
    }
    *out = run;
    return status;
}

static tobi_status resume(tobi_run *run, tobi_error *err)
{
    bool found = false;
    TOBI_TRY(tobi_record_clear(run->dir, true, err));
    TOBI_TRY(read_scene(run, err));
    TOBI_TRY(tobi_state_load(run, &found, err));
    if (!found) {
        snprintf(run->note, sizeof run->note, tr("no checkpoint in %s: beginning again at t = 0"),
                 run->dir);
        TOBI_TRY(tobi_world_start(run->world, err));
        return begin(run, err);
    }
    TOBI_TRY(tobi_series_prepare(run, err));
    TOBI_TRY(tobi_tables_open(run, true, err));
    tobi_tables_count_missing(run);
    run->next_checkpoint = next_checkpoint_after(run, tobi_world_time(run->world));
    TOBI_TRY(tobi_series_lists(run, err));
    tell_losses(run);
    return tobi_writer_start(run, err);
}

tobi_status tobi_run_resume(tobi_world *world, const tobi_output_def *output, const char *dir,
                            tobi_run **out, tobi_error *err)
{
    TOBI_NEED(out, "where the run goes");
    *out = NULL;
    TOBI_NEED_WORLD(world);
    TOBI_NEED(output, "the output");
    TOBI_NEED(dir, "the directory");
    TOBI_TRY(tobi_param_check(&tobi_output_table, output, err));
    bool found = false;
    TOBI_TRY(tobi_record_find_results(dir, &found, err));
    if (!found)
        return tobi_fail(err, TOBI_NOT_FOUND, "%s: there is no run to resume", dir);
    tobi_run *run = NULL;
    tobi_status status = open_run(world, output, dir, &run, err);
    if (status == TOBI_OK) status = resume(run, err);
    if (status != TOBI_OK) {
        tobi_run_free(run);
        run = NULL;
    }
    *out = run;
    return status;
}

const char *tobi_run_note(const tobi_run *run) { return run ? run->note : ""; }

const char *tobi_run_losses(const tobi_run *run) { return run->losses; }

static double snap_end(const tobi_run *run, double end)
{
    return tobi_record_snap(run->output.interval, end);
}

static bool reached(const tobi_run *run, double t)
{
    return tobi_record_reaches(tobi_world_time(run->world), t);
}

int tobi_run_done(const tobi_run *run, double end)
{
    return !run || (isfinite(end) && reached(run, snap_end(run, end)) &&
                    !reached(run, tobi_record_time(run, run->outputs)));
}

/* Takes the step's own numbers from inside: tobi_world_info would add up energies in every step. */
static tobi_status step_towards(tobi_run *run, double target, double end, tobi_error *err)
{
    tobi_simulation *sim = &run->world->sim;
    double before = tobi_record_clock(), start = sim->time;
    TOBI_TRY(tobi_world_step_towards(run->world, target, end, err));
    run->step_wall += tobi_record_clock() - before;
    run->particle_steps += (double)sim->info.fluid_particles;
    tobi_tally_add(&run->since, &sim->info);
    tobi_tally_bodies(run, sim->info.dt);
    tobi_tally_solids(run, sim->info.dt);
    tobi_tally_add(&run->total, &sim->info);
    tobi_works_add(run, sim->info.dt);
    TOBI_TRY(tobi_lines_write(run, start, err));
    TOBI_TRY(tobi_joints_write(run, start, err));
    TOBI_TRY(tobi_porous_write(run, start, err));
    TOBI_TRY(tobi_scalars_write(run, start, err));
    return tobi_tables_write_probes(run, start, err);
}

tobi_status tobi_run_add_nest(tobi_run *run, tobi_run *nest, tobi_error *err)
{
    TOBI_NEED(run, "run");
    TOBI_NEED(nest, "the run of a nest");
    if (run->nest_count == TOBI_NEST_LIMIT)
        return tobi_fail(err, TOBI_INVALID, "a run has %d nests or fewer", TOBI_NEST_LIMIT);
    tobi_run **more = realloc(run->nest, (size_t)(run->nest_count + 1)*sizeof *more);
    if (!more) return tobi_fail(err, TOBI_NO_MEMORY, "run: out of memory");
    run->nest = more;
    more[run->nest_count++] = nest;
    nest->outer = run;
    tell_nest_losses(run, nest);
    return TOBI_OK;
}

/* Whose failure it is. A stop is none. */
static tobi_status tell_nest(const tobi_run *nest, tobi_status status, tobi_error *err)
{
    if (status == TOBI_OK || status == TOBI_STOPPED || !err) return status;
    const tobi_error why = *err;
    tobi_fail(err, status, "nest '%s': %s", name_of(nest), why.text);
    return tobi_at_key(err, status, "%s", why.key);
}

/* A nest to the time of the outer world. */
static tobi_status follow(tobi_run *nest, double t, double end, tobi_error *err)
{
    while (tobi_world_time(nest->world) < t) {
        const double next = tobi_record_time(nest, nest->outputs);
        TOBI_TRY(step_towards(nest, fmin(next, t), end, err));
        if (reached(nest, next)) TOBI_TRY(tobi_run_output(nest, err));
    }
    return TOBI_OK;
}

/* Nests are behind after a step of the outer world, or a stop of their own since. */
static tobi_status catch_up(tobi_run *run, double end, int may_stop, tobi_error *err)
{
    const double t = tobi_world_time(run->world);
    for (int k = 0; k < run->nest_count; k++) {
        tobi_world *w = run->nest[k]->world;
        tobi_world_set_stop(w, may_stop ? run->world->sim.stop : NULL, run->world->sim.stop_user);
        if (tobi_world_time(w) >= t) continue;
        TOBI_TRY(tell_nest(run->nest[k], follow(run->nest[k], t, end, err), err));
        TOBI_TRY(tobi_world_feed(w, err));
    }
    return TOBI_OK;
}

tobi_status tobi_run_step(tobi_run *run, double end, tobi_step_info *info, tobi_error *err)
{
    TOBI_NEED(run, "run");
    if (!isfinite(end)) return tobi_fail(err, TOBI_INVALID, "the end of the run is %g s, not finite", end);
    double next = tobi_record_time(run, run->outputs);
    double target = fmin(next, snap_end(run, end));
    TOBI_TRY(tobi_writer_check(run->writer, err));
    TOBI_TRY(catch_up(run, end, 1, err));
    if (!reached(run, target)) {
        TOBI_TRY(step_towards(run, target, end, err));
        TOBI_TRY(catch_up(run, end, 1, err));
    } else if (!reached(run, next)) return tobi_writer_wait(run->writer, err);
    if (info) *info = run->world->sim.info;
    if (reached(run, next)) TOBI_TRY(tobi_run_output(run, err));
    if (tobi_world_time(run->world) >= run->next_checkpoint)
        TOBI_TRY(tobi_run_checkpoint(run, err));
    return tobi_run_done(run, end) ? tobi_writer_wait(run->writer, err) : TOBI_OK;
}

tobi_status tobi_run_output(tobi_run *run, tobi_error *err)
{
    TOBI_NEED(run, "run");
    tobi_snapshot *snapshot;
    TOBI_TRY(tobi_snapshot_take(run, &snapshot, err));
    tobi_status status = tobi_record_note_time(run, tobi_world_time(run->world), err);
    if (status == TOBI_OK) status = tobi_writer_put(run->writer, snapshot, err);
    if (status != TOBI_OK) {
        tobi_snapshot_free(snapshot);
        return status;
    }
    run->outputs++;
    run->since = (tobi_tally){ 0 };
    memset(run->body_since, 0, (size_t)tobi_world_body_count(run->world)*sizeof *run->body_since);
    memset(run->solid_since, 0, (size_t)tobi_world_solid_count(run->world)*sizeof *run->solid_since);
    return TOBI_OK;
}

tobi_status tobi_run_output_end(tobi_run *run, tobi_error *err)
{
    TOBI_NEED(run, "run");
    const double last = tobi_record_time(run, run->outputs - 1);
    for (int k = 0; k < run->nest_count; k++)
        if (isfinite(tobi_world_info(run->nest[k]->world)->speed_max))      /* not after it diverged */
            TOBI_TRY(tobi_run_output_end(run->nest[k], err));
    return tobi_record_reaches(last, tobi_world_time(run->world)) ? TOBI_OK : tobi_run_output(run, err);
}

tobi_status tobi_run_wait(tobi_run *run, tobi_error *err)
{
    TOBI_NEED(run, "run");
    return tobi_writer_wait(run->writer, err);
}

/* A checkpoint counts on the rows: a resumed run cuts the tables back to it, and cannot make any. */
static tobi_status save(tobi_run *run, tobi_error *err)
{
    TOBI_TRY(tobi_record_keep_dir(run, err));
    TOBI_TRY(keep_scene(run, err));
    TOBI_TRY(tobi_tables_flush(run, err));
    return tobi_state_save(run, err);
}

/* A checkpoint counts the outputs: they must be on the disk before it is. Nests that were stopped come to the
   time of the outer world, whose step they need in memory. */
tobi_status tobi_run_checkpoint(tobi_run *run, tobi_error *err)
{
    TOBI_NEED(run, "run");
    TOBI_TRY(catch_up(run, tobi_world_time(run->world), 0, err));
    for (int k = 0; k < run->nest_count; k++) TOBI_TRY(tobi_run_checkpoint(run->nest[k], err));
    TOBI_TRY(tobi_writer_wait(run->writer, err));
    if (run->world->sim.step == run->checkpoint_step && run->outputs == run->checkpoint_outputs)
        return TOBI_OK;
    TOBI_TRY(tobi_trouble_pass(run, TOBI_KIND_CHECKPOINTS, run->outputs, save(run, err), err));
    run->next_checkpoint = next_checkpoint_after(run, tobi_world_time(run->world));
    return TOBI_OK;
}

static tobi_status end_files(tobi_run *run, tobi_error *err)
{
    const int64_t last = run->outputs - 1;
    tobi_status status = tobi_record_keep_dir(run, err);
    if (status == TOBI_OK) status = tobi_series_lists(run, err);
    TOBI_TRY(tobi_trouble_pass(run, TOBI_KIND_LISTS, last, status, err));
    return tobi_trouble_pass(run, TOBI_KIND_TABLES, last, tobi_tables_flush(run, err), err);
}

static tobi_status finish_nests(tobi_run *run, const char *outcome, tobi_error *err)
{
    tobi_status status = TOBI_OK;
    for (int k = 0; k < run->nest_count; k++) {
        const tobi_status ended = tobi_run_finish(run->nest[k], outcome, status == TOBI_OK ? err : NULL);
        if (status == TOBI_OK) status = ended;
    }
    return status;
}

/* The summary is written after a failure too, but then it says so. */
tobi_status tobi_run_finish(tobi_run *run, const char *outcome, tobi_error *err)
{
    TOBI_NEED(run, "run");
    TOBI_NEED(outcome, "the outcome");
    const tobi_status nests = finish_nests(run, outcome, err);
    if (nests != TOBI_OK) err = NULL;      /* the first failure is told, and the rest is ended all the same */
    tobi_status status = tobi_writer_wait(run->writer, err);
    if (status == TOBI_OK) status = end_files(run, err);
    if (status != TOBI_OK) err = NULL;
    if (nests != TOBI_OK) status = nests;
    tobi_status written = tobi_summary_write(run, status == TOBI_OK ? outcome : "failed", err);
    written = tobi_trouble_pass(run, TOBI_KIND_SUMMARY, run->outputs, written, err);
    tell_losses(run);
    for (int k = 0; k < run->nest_count; k++) tell_nest_losses(run, run->nest[k]);
    return status != TOBI_OK ? status : written;
}

void tobi_run_free(tobi_run *run)
{
    if (!run) return;
    for (int k = 0; k < run->nest_count; k++) {
        pthread_mutex_lock(&run->nest[k]->trouble_lock);
        run->nest[k]->outer = NULL;
        pthread_mutex_unlock(&run->nest[k]->trouble_lock);
    }
    tobi_writer_free(run->writer);
    tobi_csv_close(run->history);
    tobi_csv_close(run->bodies);
    tobi_csv_close(run->solids);
    tobi_csv_close(run->probes);
    tobi_csv_close(run->lines);
    tobi_csv_close(run->joints);
    tobi_csv_close(run->porous);
    tobi_csv_close(run->scalars);
    if (run->lock >= 0) close(run->lock);
    tobi_series_free(run);
    tobi_snapshot_free_skins(run);
    tobi_trouble_free(run);
    free(run->body_since);
    free(run->solid_since);
    tobi_works_free(run);
    free(run->aside);
    free(run->nest);
    free(run->sensor);
    free(run->resolved);
    free(run->dir);
    free(run);
}
