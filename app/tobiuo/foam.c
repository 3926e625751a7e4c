/* tobiuo foam DIR: spray, foam and bubbles of the liquids of a finished run, a file for each output.
   Drawback: what is between two outputs is guessed, so that outputs far apart make poor foam. */
#define _GNU_SOURCE
#include "moment.h"
#include "tobiuo/foam.h"
#include "tobiuo/results.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct foam_options {
    const char *dir;
    double amount, lifetime;
    int64_t most;
    int threads, quiet;
} foam_options;

enum { KEY_AMOUNT = 256, KEY_LIFETIME, KEY_MOST, KEY_THREADS };

static const struct argp_option options[] = {
    { "amount", KEY_AMOUNT, "X", 0, "times as many particles as usual (1)", 0 },
    { "lifetime", KEY_LIFETIME, "S", 0, "mean life of foam, s (60 sqrt(spacing/g))", 0 },
    { "most", KEY_MOST, "N", 0, "most particles at a time (4000000)", 0 },
    { "threads", KEY_THREADS, "N", 0, "threads (all cores)", 0 },
    { 0 }
};

static error_t parse(int key, char *value, struct argp_state *state)
{
    foam_options *o = state->input;
    char *end;
    switch (key) {
    case KEY_AMOUNT:
        o->amount = parse_positive(state, "--amount", value);
        if (o->amount > 1000) usage_error(state, tr("--amount: %s is not above 0 to 1000"), value);
        break;
    case KEY_LIFETIME: o->lifetime = parse_positive(state, "--lifetime", value); break;
    case KEY_MOST:
        o->most = strtoll(value, &end, 10);
        if (end == value || *end || o->most < 1 || o->most > 1 << 30)
            usage_error(state, tr("--most: '%s' is not a number from 1 to %d"), value, 1 << 30);
        break;
    case KEY_THREADS: o->threads = parse_threads(state, value); break;
    default: return parse_argument(state, key, value, "DIR", &o->dir);
    }
    return 0;
}

/* The liquid of an output. */
typedef struct liquid {
    tobi_moment moment;
    tobi_foam_water water;
    double (*x)[3], (*v)[3], (*solid)[3];
    int64_t *id;
} liquid;

static void free_liquid(liquid *l)
{
    tobi_moment_free(&l->moment);
    free(l->x);
    free(l->v);
    free(l->solid);
    free(l->id);
    *l = (liquid){ 0 };
}

/* Of particles those of liquids, but for what waits in inlets. */
static int take_liquid(const foam_options *o, const tobi_looks *looks, liquid *l)
{
    const tobi_moment *m = &l->moment;
    const tobi_moment_field *v = find_moment_field(m, "velocity");
    const tobi_moment_field *id = find_moment_field(m, "particle_id");
    const tobi_moment_field *material = find_moment_field(m, "material");
    const size_t room = (size_t)m->count + 1;
    if (!v || v->components != 3)
        return complain("the output of %s has no field 'velocity', which foam needs; output.fields of the "
                        "scene writes it", o->dir);
    l->x = malloc(room*sizeof *l->x);
    l->v = malloc(room*sizeof *l->v);
    l->id = id ? malloc(room*sizeof *l->id) : NULL;
    if (!l->x || !l->v || (id && !l->id)) return complain("out of memory");
    int64_t n = 0;
    for (int64_t i = 0; i < m->count; i++) {
        const int k = material ? (int)material->values[i] : 0;
        if (k >= 0 && k < looks->material_count && !looks->materials[k].liquid) continue;
        if (tobi_looks_hides(looks, m->time, m->positions[i])) continue;
        memcpy(l->x[n], m->positions[i], sizeof l->x[n]);
        memcpy(l->v[n], v->values + 3*i, sizeof l->v[n]);
        if (id) l->id[n] = (int64_t)id->values[i];
        n++;
    }
    l->water = (tobi_foam_water){ .time = m->time, .count = n, .positions = (const double (*)[3])l->x,
                                  .velocities = (const double (*)[3])l->v, .ids = l->id };
    return 0;
}

static int take_bodies(const tobi_results *results, int64_t k, double spacing, thinned *t, liquid *l)
{
    const int code = take_body_points(results, k, spacing, t, &l->solid, &l->water.solid_count);
    l->water.solids = (const double (*)[3])l->solid;
    return code;
}

/* Spacing of the liquids: that of the first. */
static double find_spacing(const tobi_looks *looks)
{
    for (int k = 0; k < looks->material_count; k++)
        if (looks->materials[k].liquid) return 2*tobi_looks_radius(looks, k);
    return 0;
}

static int create_foam(const foam_options *o, const tobi_looks *looks, tobi_foam **foam)
{
    tobi_error err = { 0 };
    tobi_foam_def d = tobi_default_foam();
    d.dimension = looks->dimension;
    d.spacing = find_spacing(looks);
    d.amount = o->amount, d.lifetime = o->lifetime, d.threads = o->threads;
    if (o->most) d.most = o->most;
    for (int a = 0; a < 3; a++) {
        d.gravity[a] = looks->gravity[a];
        d.box_min[a] = looks->box_min[a], d.box_max[a] = looks->box_max[a];
    }
    if (!(d.spacing > 0)) return complain("%s is a run without a liquid, which makes no foam", o->dir);
    return tobi_foam_create(&d, foam, &err) == TOBI_OK ? 0 : complain("%s", err.text);
}

typedef struct totals { int64_t files, most; double particles, left_out, since; } totals;

static int write_one(const char *folder, int64_t k, tobi_foam *foam, double time,
                     totals *t)
{
    tobi_foam_particles p;
    tobi_error err = { 0 };
    char name[64];
    snprintf(name, sizeof name, "foam_%06lld.vtp", (long long)k);
    char *path = join_path(folder, name);
    tobi_status status = tobi_foam_read(foam, &p, &err);
    if (status == TOBI_OK) status = tobi_foam_write(path, &p, &err);
    free(path);
    if (status != TOBI_OK) return complain("%s", err.text);
    t->files++;
    t->most = p.count > t->most ? p.count : t->most;
    if (p.left_out > 0 && t->left_out == 0) t->since = time;
    t->left_out = p.left_out;
    return 0;
}

static int write_files(const foam_options *o, const tobi_results *results, const tobi_looks *looks,
                       tobi_foam *foam, totals *t)
{
    char *folder = join_path(o->dir, "foam");
    int code = make_series_folder(folder);
    thinned bodies = { 0 };
    for (int64_t k = 0; code == 0 && k < tobi_results_count(results); k++) {
        liquid l = { 0 };
        tobi_error err = { 0 };
        if (tobi_results_read(results, k, &l.moment, &err) != TOBI_OK) code = complain("%s", err.text);
        if (code == 0) code = take_liquid(o, looks, &l);
        if (code == 0) code = take_bodies(results, k, find_spacing(looks), &bodies, &l);
        if (code == 0 && tobi_foam_advance(foam, &l.water, &err) != TOBI_OK) code = complain("%s", err.text);
        if (code == 0) code = write_one(folder, k, foam, l.water.time, t);
        t->particles += (double)l.water.count;
        free_liquid(&l);
    }
    if (code == 0) code = write_series_list(o->dir, "foam", results, 0);
    free(bodies.row);
    free(folder);
    return code;
}

/* The pictures that the run has drawn lack it; others have waited for it. */
static int draw_pictures(const char *dir, const tobi_scene *scene)
{
    const tobi_output_def *output = tobi_scene_output_def(scene);
    int code = draw_again(dir, NULL);
    for (int k = 0; code == 0 && k < output->view_count; k++) code = draw_again(dir, output->views[k].name);
    return code;
}

static int make(const foam_options *o)
{
    const overrides none = { 0 };
    tobi_scene *scene = NULL;
    tobi_looks looks = { 0 };
    tobi_results *results = NULL;
    tobi_foam *foam = NULL;
    tobi_error err = { 0 };
    totals t = { 0 };
    const double begun = wall_clock();
    int code = load_looks(o->dir, &none, &scene, &looks);
    if (code == 0) code = create_foam(o, &looks, &foam);
    if (code == 0 && tobi_results_open(o->dir, &results, &err) != TOBI_OK) code = complain("%s", err.text);
    if (code == 0 && tobi_results_count(results) < 2)
        code = complain("%s has one output only; foam is made between two", o->dir);
    if (code == 0) code = write_files(o, results, &looks, foam, &t);
    const double seconds = wall_clock() - begun;
    if (code == 0 && !o->quiet)
        printf(tr("foam: %s/foam, %lld files, up to %.3g particles at a time, %.3g million particles of "
               "water in %.3g s\n"), o->dir, (long long)t.files, (double)t.most, 1e-6*t.particles, seconds);
    if (code == 0 && t.left_out > 0)
        fprintf(stderr, tr("tobiuo: note: from %g s on there was no room for %.3g particles; --most takes "
                "more, --amount makes fewer\n"), t.since, t.left_out);
    tobi_foam_free(foam);
    tobi_results_free(results);
    if (code == 0) code = draw_pictures(o->dir, scene);
    tobi_looks_free(&looks);
    tobi_scene_free(scene);
    return code;
}

int make_foam(const char *dir, int quiet)
{
    const foam_options o = { .dir = dir, .amount = 1, .quiet = quiet };
    return make(&o);
}

/* 1: one of the names between commas. */
static int is_listed(const char *names, const char *name)
{
    const size_t length = strlen(name);
    for (const char *at = names; *at; at += strcspn(at, ","), at += *at == ',') {
        at += strspn(at, " ");
        if (strncmp(at, name, length) == 0 && (!at[length] || strchr(", ", at[length]))) return 1;
    }
    return 0;
}

const char *foam_objection(const tobi_scene *scene, const tobi_world *world)
{
    const char *fields = tobi_scene_output_def(scene)->fields;
    tobi_looks looks = { 0 };
    tobi_error err = { 0 };
    if (fields && !is_listed(fields, "velocity") && !is_listed(fields, "usual"))
        return tr("needs the field velocity; add it to output.fields");
    const int liquid = tobi_world_looks(world, &looks, &err) == TOBI_OK ? find_spacing(&looks) > 0 : 1;
    tobi_looks_free(&looks);
    return liquid ? NULL : tr("a run without a liquid makes none");
}

/* 1: an output has it. */
static int has_field(const char *fields, const char *name)
{
    static const char *const usual[] = { "velocity", "pressure", "density" };
    int is_usual = 0;
    for (size_t k = 0; k < sizeof usual/sizeof *usual; k++) is_usual |= strcmp(name, usual[k]) == 0;
    return is_listed(fields, name) || (is_usual && is_listed(fields, "usual"));
}

int can_draw_later(const tobi_scene *scene)
{
    const tobi_output_def *output = tobi_scene_output_def(scene);
    for (int k = -1; k < output->view_count; k++) {
        const char *field = k < 0 ? output->view.field : output->views[k].field;
        const char *whole = field ? tobi_world_find_field(field, NULL, NULL) : NULL;
        if (field && !has_field(output->fields ? output->fields : "usual", whole ? whole : field)) return 0;
    }
    return 1;
}

const struct argp foam_argp = { .options = options, .parser = parse, .args_doc = "DIR",
    .doc = "Make spray, foam and bubbles of the liquids of the run in DIR, for its pictures: points in "
           "DIR/foam, for each output. The water does not feel them. Pictures that the run has drawn are "
           "drawn anew with it, and those that its scene asks for and that are missing are drawn." };

int tobiuo_foam(int argc, char **argv)
{
    foam_options o = { .amount = 1 };
    parse_arguments(&foam_argp, argc, argv, &o);
    return make(&o);
}
