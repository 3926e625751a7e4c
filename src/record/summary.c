/* summary.json: the totals of a run, over all its sessions. */
#include "base/file.h"
#include "record/record.h"
#include "world/world.h"
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

static double mean(double sum, const tobi_tally *t)
{
    return t->steps ? sum / (double)t->steps : 0.0;
}

/* JSON has no NaN; a diverged run may have some. */
static json_t *number(double value) { return isfinite(value) ? json_real(value) : json_null(); }

static json_int_t peak_rss(void)
{
    struct rusage usage;
    return getrusage(RUSAGE_SELF, &usage) == 0 ? (json_int_t)usage.ru_maxrss * 1024 : 0;
}

static json_t *make_stages(const tobi_run *run)
{
    json_t *stages = json_object();
    const char *name;
    double seconds;
    for (int k = 0; (name = tobi_world_stage(run->world, k, &seconds)); k++)
        json_object_set_new(stages, name, json_real(seconds));
    return stages;
}

enum { PIECES_LISTED = 64 };

/* Pieces [begin, end) as one entry. */
static json_t *sum_up(const tobi_pieces *p, int64_t begin, int64_t end)
{
    int64_t particles = 0;
    double mass = 0, volume = 0;
    for (int64_t k = begin; k < end; k++) {
        particles += p->piece[k].particles;
        mass += p->piece[k].mass;
        volume += p->piece[k].volume;
    }
    return json_pack("{s:I, s:I, s:o, s:o}", "count", (json_int_t)(end - begin), "particles",
                     (json_int_t)particles, "mass", number(mass), "volume", number(volume));
}

/* pieces: those that a person would count. piece_list: the heaviest of them; piece_rest: the others,
   fragments: debris of a few particles, both summed up. piece_mass: the sum of all three. */
static tobi_status add_pieces(const tobi_run *run, json_t *json, tobi_error *err)
{
    const tobi_pieces *p;
    const tobi_system *s = tobi_world_solids(run->world);
    if (!s || s->solid_count == 0) return TOBI_OK;
    TOBI_TRY(tobi_world_pieces(run->world, &p, err));
    int64_t listed = p->count < PIECES_LISTED ? p->count : PIECES_LISTED;
    json_t *list = json_array();
    for (int64_t k = 0; k < listed; k++) {
        const tobi_piece *a = &p->piece[k];
        json_array_append_new(list, json_pack("{s:s, s:I, s:o, s:o, s:[o,o,o]}",
            "solid", s->solids[a->solid].name, "particles", (json_int_t)a->particles,
            "mass", number(a->mass), "volume", number(a->volume),
            "centre", number(a->centre[0]), number(a->centre[1]), number(a->centre[2])));
    }
    json_object_set_new(json, "pieces", json_integer((json_int_t)p->count));
    json_object_set_new(json, "piece_mass", number(p->mass));
    json_object_set_new(json, "piece_list", list);
    json_object_set_new(json, "piece_rest", sum_up(p, listed, p->count));
    json_object_set_new(json, "fragments", sum_up(p, p->count, p->count + p->fragments));
    return TOBI_OK;
}

/* density_error_mean: mean over steps and particles; density_error_max: largest of any step.
   particle_steps_per_s counts the time in steps, wall_s everything including files. */
static json_t *make_summary(tobi_run *run, const char *outcome)
{
    const tobi_tally *t = &run->total;
    const tobi_step_info *info = tobi_world_info(run->world);
    char hash[32];
    snprintf(hash, sizeof hash, "%016llx", (unsigned long long)tobi_world_hash(run->world));
    double rate = run->step_wall > 0.0 ? run->particle_steps / run->step_wall : 0.0;
    json_t *json = json_pack("{s:s, s:s, s:I, s:o, s:o, s:o, s:I, s:I, s:o}",
        "version", tobi_version(), "outcome", outcome, "steps", (json_int_t)t->steps,
        "time", number(tobi_world_time(run->world)),
        "wall_s", number(run->wall + tobi_record_clock() - run->begun),
        "step_wall_s", number(run->step_wall),
        "fluid_particles", (json_int_t)tobi_world_count(run->world, TOBI_FLUID),
        "body_particles", (json_int_t)tobi_world_count(run->world, TOBI_BODIES),
        "particle_steps_per_s", number(rate));
    json_t *more = json_pack("{s:o, s:o, s:o, s:o, s:I, s:I, s:I, s:I, s:I, s:i, s:I, s:s, s:o}",
        "density_iterations_mean", number(mean(t->density_iterations, t)),
        "divergence_iterations_mean", number(mean(t->divergence_iterations, t)),
        "density_error_mean", number(mean(t->density_error_mean, t)),
        "density_error_max", number(t->density_error_max),
        "unconverged_steps", (json_int_t)t->unconverged,
        "particles_lost", (json_int_t)info->particles_lost, "put_back", (json_int_t)info->put_back,
        "world_bytes", (json_int_t)tobi_world_bytes(run->world), "peak_rss_bytes", peak_rss(),
        "threads", run->world->sim.exec.threads, "outputs",
        (json_int_t)(run->outputs - tobi_writer_pending(run->writer)), "state_hash", hash,
        "stages_s", make_stages(run));
    if (json && more) json_object_update(json, more);
    if (json && tobi_world_probe_count(run->world)) json_object_set_new(json, "sensors",
        tobi_probes_sum_up(run));
    double nests = 0;
    for (int k = 0; k < run->nest_count; k++) nests += run->nest[k]->step_wall;
    if (json && run->nest_count) json_object_set_new(json, "nests_wall_s", number(nests));
    const int64_t unwritten = tobi_run_unwritten(run);
    if (json && unwritten)
        json_object_set_new(json, "files_not_written", json_integer((json_int_t)unwritten));
    json_decref(more);
    return json;
}

tobi_status tobi_summary_write(tobi_run *run, const char *outcome, tobi_error *err)
{
    json_t *json = make_summary(run, outcome);
    tobi_status status = json ? add_pieces(run, json, err) : TOBI_OK;
    char *text = json ? json_dumps(json, JSON_INDENT(2) | JSON_REAL_PRECISION(12)) : NULL;
    char *path = tobi_record_path(run->dir, "summary.json");
    if (status == TOBI_OK && !(text && path))
        status = tobi_fail(err, TOBI_NO_MEMORY, "summary: out of memory");
    tobi_file file;
    if (status == TOBI_OK) status = tobi_file_open(&file, path, err);
    if (status == TOBI_OK) {
        tobi_file_write(&file, text, strlen(text));
        tobi_file_write(&file, "\n", 1);
        status = tobi_file_commit(&file, err);
    }
    json_decref(json);
    free(text);
    free(path);
    return status;
}
