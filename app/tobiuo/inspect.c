/* tobiuo inspect SCENE: the neighbour search of one particle at the start of a scene, as files for ParaView,
   and the kernels, as tables and a picture. */
#define _GNU_SOURCE
#include "tobiuo/inspect.h"
#include "app.h"
#include "language.h"
#include "kernel_tables.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct inspect_options {
    const char *scene, *out;
    overrides set;
    kernel_options kernels;
    double at[3];
    int has_at;
    long long id;                   /* -1: not given */
} inspect_options;

enum { KEY_AT = KEY_OWN, KEY_ID };

static const struct argp_option options[] = {
    { "out", 'o', "DIR", 0, "where the files go (out/<scene>/inspect)", 0 },
    { "at", KEY_AT, "X,Y[,Z]", 0, "look from the particle nearest to this place, m (the fluid's middle)", 0 },
    { "id", KEY_ID, "N", 0, "look from the particle of this particle_id", 0 },
    { "format", 'f', "FORMAT", 0, "of the picture: svg (default) or png", 0 },
    SCENE_OPTIONS,
    { 0 }
};

static void parse_place(struct argp_state *state, const char *text, double at[3])
{
    int end = 0, count = sscanf(text, "%lf,%lf%n,%lf%n", &at[0], &at[1], &end, &at[2], &end);
    if (count == 2) at[2] = 0;
    if (count < 2 || text[end] || !isfinite(at[0]) || !isfinite(at[1]) || !isfinite(at[2]))
        usage_error(state, tr("--at wants X,Y,Z (or X,Y), not '%s'"), text);
}

static error_t parse(int key, char *value, struct argp_state *state)
{
    inspect_options *o = state->input;
    char *end;
    switch (key) {
    case 'o':
        if (!*value) usage_error(state, tr("--out is empty"));
        o->out = value;
        break;
    case 'f':
        if (strcmp(value, "svg") != 0 && strcmp(value, "png") != 0)
            usage_error(state, tr("--format: '%s' is neither svg nor png"), value);
        o->kernels.format = value;
        break;
    case KEY_AT:
        parse_place(state, value, o->at);
        o->has_at = 1;
        break;
    case KEY_ID:
        o->id = strtoll(value, &end, 10);
        if (end == value || *end || o->id < 0) usage_error(state, tr("--id: '%s' is no particle_id"), value);
        break;
    default: return parse_scene_option(state, key, value, &o->set, &o->scene);
    }
    if (o->has_at && o->id >= 0) usage_error(state, tr("--at and --id: one of them"));
    return 0;
}

typedef struct fluid { int64_t count, *id; double (*place)[3]; } fluid;

static tobi_status read_fluid(tobi_world *world, fluid *f, tobi_error *err)
{
    tobi_search search;
    tobi_status status = tobi_world_search(world, &search, err);     /* starts the world */
    if (status != TOBI_OK) return status;
    f->count = search.particles;
    f->id = malloc((size_t)(tobi_world_count(world, TOBI_FLUID) + 1)*sizeof *f->id);
    f->place = malloc((size_t)(tobi_world_count(world, TOBI_FLUID) + 1)*sizeof *f->place);
    if (!f->id || !f->place) exit(complain("out of memory"));
    const int64_t room = tobi_world_count(world, TOBI_FLUID);
    status = tobi_world_read_ids(world, TOBI_FLUID, f->id, room, err);
    if (status != TOBI_OK) return status;
    return tobi_world_read(world, TOBI_FLUID, "position", f->place[0], room, err);
}

/* The row of the particle that is meant; -1 for an id that is not there. */
static int64_t find_particle(const inspect_options *o, const fluid *f)
{
    double at[3], low[3], high[3];
    for (int a = 0; a < 3; a++) low[a] = INFINITY, high[a] = -INFINITY;
    for (int64_t i = 0; i < f->count; i++)
        for (int a = 0; a < 3; a++) {
            low[a] = fmin(low[a], f->place[i][a]);
            high[a] = fmax(high[a], f->place[i][a]);
        }
    for (int a = 0; a < 3; a++) at[a] = o->has_at ? o->at[a] : 0.5*(low[a] + high[a]);
    int64_t best = -1;
    double nearest = INFINITY;
    for (int64_t i = 0; i < f->count; i++) {
        double square = 0;
        for (int a = 0; a < 3; a++) square += (f->place[i][a] - at[a])*(f->place[i][a] - at[a]);
        const int found = o->id >= 0 ? f->id[i] == o->id : square < nearest;
        if (found) best = i, nearest = square;
    }
    return best;
}

static tobi_status print_search(tobi_world *world, const fluid *f, int64_t row, tobi_error *err)
{
    tobi_search s;
    int64_t neighbours;
    char kernel[32];
    tobi_status status = tobi_world_search(world, &s, err);
    if (status == TOBI_OK) status = tobi_world_neighbours(world, f->id[row], NULL, 0, &neighbours, err);
    if (status != TOBI_OK) return status;
    tobi_kernel_name(s.kernel, kernel, sizeof kernel);
    print_label(tr("kernel"));
    printf(tr("%s, support %.6g m\n"), kernel, s.support);
    print_label(tr("cells"));
    printf(tr("%d x %d x %d of %.6g x %.6g x %.6g m\n"), s.cells[0], s.cells[1], s.cells[2],
           s.width[0], s.width[1], s.width[2]);
    print_label(tr("particles"));
    printf("%lld\n", (long long)s.particles);
    print_label(tr("particle"));
    printf(tr("%lld at %.6g %.6g %.6g m, %lld neighbours\n"), (long long)f->id[row],
           f->place[row][0], f->place[row][1], f->place[row][2], (long long)neighbours);
    return TOBI_OK;
}

static int write_files(tobi_scene *scene, tobi_world *world, const inspect_options *o, const char *dir)
{
    tobi_error err = { 0 };
    fluid f = { 0 };
    tobi_search search;
    int code = 0;
    tobi_status status = read_fluid(world, &f, &err);
    int64_t row = status == TOBI_OK ? find_particle(o, &f) : -1;
    if (status == TOBI_OK && row < 0) code = complain("the fluid has no particle %lld", o->id);
    if (status == TOBI_OK && row >= 0) status = print_search(world, &f, row, &err);
    if (status == TOBI_OK && row >= 0) status = tobi_world_write_search(world, f.id[row], dir, &err);
    if (status == TOBI_OK) status = tobi_world_search(world, &search, &err);
    if (status != TOBI_OK) code = complain("%s", err.text);
    if (code == 0) {
        const tobi_world_def *def = tobi_scene_world_def(scene);
        print_label(tr("files"));
        printf("%s\n\n", dir);
        code = write_kernels(&(kernel_options){ dir, o->kernels.format, search.kernel, def->dimension,
                                                search.support });
    }
    free(f.id);
    free(f.place);
    return code;
}

static int inspect_scene(tobi_scene *scene, const inspect_options *o)
{
    tobi_error err = { 0 };
    tobi_world *world = NULL;
    char *results = results_path(scene, NULL), *dir = NULL;
    if (!results || asprintf(&dir, o->out ? "%s" : "%s/inspect", o->out ? o->out : results) < 0)
        return complain("out of memory");
    int code = tobi_scene_build(scene, &world, &err) == TOBI_OK ? 0 : complain("%s", err.text);
    if (code == 0) code = write_files(scene, world, o, dir);
    tobi_world_destroy(world);
    free(results);
    free(dir);
    return code;
}

const struct argp inspect_argp = { .options = options, .parser = parse, .args_doc = "SCENE",
    .doc = "Write what the neighbour search of one particle finds at the start of a scene, as points for "
           "ParaView (VTP), and the kernels: W, dW/dr and their integrals, as CSV and as a picture." };

int tobiuo_inspect(int argc, char **argv)
{
    inspect_options o = { .id = -1, .kernels.format = "svg" };
    parse_arguments(&inspect_argp, argc, argv, &o);
    tobi_scene *scene = load_scene(o.scene, &o.set);
    int code = scene ? inspect_scene(scene, &o) : EXIT_ERROR;
    tobi_scene_free(scene);
    return code;
}
