/* tobiuo surface DIR: the surfaces of fluids and solids of a finished run, from its particles: a file for
   each output, or one glTF with all of them as an animation. Drawback: colours of skins without an image
   are means of particles, so that their edges are a spacing wide. */
#define _GNU_SOURCE
#include "moment.h"
#include "tobiuo/results.h"
#include "tobiuo/surface.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct surface_options {
    const char *dir, *format, *field;
    double cell, slow;
    int smooth, threads, last;
    int images;         /* glb in the colours of things */
} surface_options;

enum { KEY_CELL = 256, KEY_SMOOTH, KEY_FIELD, KEY_THREADS, KEY_LAST, KEY_SLOW };

static const struct argp_option options[] = {
    { "format", 'f', "FORMAT", 0, "vtp (default), obj, ply, stl, or glb: one file, an animation", 0 },
    { "cell", KEY_CELL, "C", 0, "cell of the grid, spacings (0.75)", 0 },
    { "smooth", KEY_SMOOTH, "N", 0, "rounds of smoothing (20)", 0 },
    { "field", KEY_FIELD, "NAME", 0,
      "field of the vertices, or a component of one, like velocity_x; \"speed\" among them; in glb their "
      "colour; without it all, and the colours of the materials", 0 },
    { "slow", KEY_SLOW, "X", 0, "glb: so many times slower than the scene (1)", 0 },
    { "last", KEY_LAST, NULL, 0, "the last output only", 0 },
    { "threads", KEY_THREADS, "N", 0, "threads (all cores)", 0 },
    { 0 }
};

static const char *const formats[] = { "vtp", "obj", "ply", "stl", "glb" };

const char *surface_format(const char *name)
{
    for (size_t k = 0; k < sizeof formats/sizeof *formats; k++)
        if (strcmp(formats[k], name) == 0) return formats[k];
    return NULL;
}

static error_t parse(int key, char *value, struct argp_state *state)
{
    surface_options *o = state->input;
    char *end;
    switch (key) {
    case 'f':
        o->format = surface_format(value);
        if (!o->format) usage_error(state, tr("--format: '%s' is none of vtp, obj, ply, stl, glb"), value);
        break;
    case KEY_CELL:
        o->cell = parse_positive(state, "--cell", value);
        if (!(o->cell >= 0.1 && o->cell <= 2)) usage_error(state,
                                                          tr("--cell: %s is not from 0.1 to 2 spacings"),
                                                          value);
        break;
    case KEY_SMOOTH:
        o->smooth = (int)strtol(value, &end, 10);
        if (end == value || *end || o->smooth < 0 || o->smooth > 100)
            usage_error(state, tr("--smooth: '%s' is not a number from 0 to 100"), value);
        break;
    case KEY_FIELD: o->field = value; break;
    case KEY_SLOW: o->slow = parse_positive(state, "--slow", value); break;
    case KEY_LAST: o->last = 1; break;
    case KEY_THREADS: o->threads = parse_threads(state, value); break;
    default: return parse_argument(state, key, value, "DIR", &o->dir);
    }
    return 0;
}

/* What the arrays of an output become. */
typedef struct input {
    tobi_moment moment;
    tobi_surface_def def;
    tobi_surface_field field[TOBI_SURFACE_FIELD_LIMIT];
    double *speed, *part, *color, *spacing;      /* part: the component that was asked for */
    int32_t *group;
    tobi_looks looks;
    tobi_picture_skin *skins;          /* of materials with a texture, or NULL */
    int16_t *skin;
} input;

static int complain_field(const surface_options *o, const tobi_moment *m)
{
    char all[900];
    list_moment_fields(m, all, sizeof all);
    return complain("%s has no field '%s'; it has speed%s", o->dir, o->field, all);
}

static void free_input(input *in)
{
    tobi_moment_free(&in->moment);
    free(in->speed);
    free(in->part);
    free(in->color);
    free(in->group);
    free(in->spacing);
    free(in->skin);
    in->skin = NULL;
    in->speed = in->part = in->color = in->spacing = NULL;
    in->group = NULL;
}

/* A fluid or solid is one, each piece of a solid too, if the files know them. */
static int make_groups(input *in)
{
    enum { MATERIALS = 264, GROUPS = 1 << 20 };
    const tobi_moment *m = &in->moment;
    const tobi_moment_field *material = find_moment_field(m, "material");
    const tobi_moment_field *piece = find_moment_field(m, "piece");
    in->group = malloc((size_t)m->count*sizeof *in->group + 1);
    if (!in->group) return complain("out of memory");
    for (int64_t i = 0; i < m->count; i++) {
        const double p = piece ? piece->values[i] : -1, s = material ? material->values[i] : 0;
        in->group[i] = p >= 0 ? (int32_t)fmod(MATERIALS + p, GROUPS) : s >= 0 &&
            s < MATERIALS ? (int32_t)s : 0;
    }
    in->def.group = in->group;
    return 0;
}

/* Of materials with a spacing of their own. */
static int make_spacing(input *in)
{
    const tobi_moment *m = &in->moment;
    const tobi_moment_field *material = find_moment_field(m, "material");
    if (!material || !tobi_looks_differ(&in->looks)) return 0;
    in->spacing = malloc((size_t)m->count*sizeof *in->spacing + 1);
    if (!in->spacing) return complain("out of memory");
    for (int64_t i = 0; i < m->count; i++)
        in->spacing[i] = 2*tobi_looks_radius(&in->looks, (int)material->values[i]);
    in->def.spacings = in->spacing;
    return 0;
}

static int make_speed(input *in)
{
    const tobi_moment *m = &in->moment;
    const tobi_moment_field *v = find_moment_field(m, "velocity");
    in->speed = v ? malloc((size_t)m->count*sizeof *in->speed + 1) : NULL;
    if (v && !in->speed) return complain("out of memory");
    for (int64_t i = 0; v && i < m->count; i++) {
        const double *u = v->values + 3*i;
        in->speed[i] = sqrt(u[0]*u[0] + u[1]*u[1] + u[2]*u[2]);
    }
    return 0;
}

/* Of each particle red, green, blue and opacity of its material: skin, core, face of a cut. */
static int make_color(input *in)
{
    const tobi_moment *m = &in->moment;
    const tobi_moment_field *material = find_moment_field(m, "material");
    const tobi_moment_field *part = find_moment_field(m, "part");
    in->color = malloc(4*(size_t)m->count*sizeof *in->color + 1);
    if (!in->color) return complain("out of memory");
    for (int64_t i = 0; i < m->count; i++) {
        float color[4];
        tobi_looks_color(&in->looks, material ? (int)material->values[i] : 0, part ? (int)part->values[i] : 0,
                         color);
        for (int k = 0; k < 4; k++) in->color[4*i + k] = (double)color[k];
    }
    return 0;
}

/* One component of a field that was asked for. */
static int take_component(const surface_options *o, input *in, const tobi_moment_field *f, int component)
{
    const int64_t count = in->moment.count;
    in->part = malloc((size_t)count*sizeof *in->part + 1);
    if (!in->part) return complain("out of memory");
    for (int64_t i = 0; i < count; i++) in->part[i] = f->values[f->components*i + component];
    in->field[0] = (tobi_surface_field){ o->field, 1, in->part };
    return 0;
}

/* The field that was asked for, or all that are not numbers of something. */
static int take_fields(const surface_options *o, input *in)
{
    const tobi_moment *m = &in->moment;
    int n = 0, component = -1;
    const tobi_moment_field *of = o->field ? find_moment_part(m, o->field, &component) : NULL;
    int code = make_speed(in);
    if (code == 0 && !o->field) code = make_color(in);
    if (code == 0 && of && component >= 0) code = take_component(o, in, of, component), n = 1;
    if (code != 0) return code;
    if (!o->field) in->field[n++] = (tobi_surface_field){ "color", 4, in->color };
    if (in->speed && (!o->field || strcmp(o->field, "speed") == 0))
        in->field[n++] = (tobi_surface_field){ "speed", 1, in->speed };
    for (int k = 0; k < m->field_count && n < TOBI_SURFACE_FIELD_LIMIT; k++) {
        const tobi_moment_field *f = &m->fields[k];
        if (o->field ? strcmp(o->field, f->name) == 0 : !is_label_field(f->name))
            in->field[n++] = (tobi_surface_field){ f->name, f->components, f->values };
    }
    if (o->field && n == 0) return complain_field(o, m);
    in->def.fields = in->field;
    in->def.field_count = n;
    return 0;
}

static int read_input(const surface_options *o, const tobi_results *results, int64_t k, input *in)
{
    tobi_error err = { 0 };
    if (tobi_results_read(results, k, &in->moment, &err) != TOBI_OK) return complain("%s", err.text);
    for (int64_t i = 0; i < in->moment.count; i++)
        if (tobi_looks_hides(&in->looks, in->moment.time, in->moment.positions[i]))
            in->moment.positions[i][0] = NAN;      /* out of the surface */
    in->def.particle_count = in->moment.count;
    in->def.positions = (const double (*)[3])in->moment.positions;
    int code = make_groups(in);
    if (code == 0) code = make_spacing(in);
    return code == 0 ? take_fields(o, in) : code;
}

/* Of all materials, once. */
static int make_skins(input *in)
{
    int images = 0;
    for (int k = 0; k < in->looks.material_count; k++) images += in->looks.materials[k].image != NULL;
    if (images == 0) return 0;
    in->skins = calloc((size_t)in->looks.material_count, sizeof *in->skins);
    for (int k = 0; in->skins && k < in->looks.material_count; k++) {
        float color[4];
        in->skins[k] = in->looks.materials[k].skin;
        tobi_looks_color(&in->looks, k, 1, color);      /* of the core */
        memcpy(in->skins[k].inside, color, sizeof in->skins[k].inside);
    }
    return in->skins ? 0 : complain("out of memory");
}

/* With images, if there are any and the output says where particles were at rest. */
static tobi_status make_surface(input *in, tobi_surface **s, tobi_error *err)
{
    const tobi_moment *m = &in->moment;
    const tobi_moment_field *material = find_moment_field(m, "material");
    const tobi_moment_field *rest = find_moment_field(m, "rest_position");
    if (!in->skins || !rest || rest->components != 3) return tobi_surface_make(&in->def, s, err);
    in->skin = malloc((size_t)m->count*sizeof *in->skin + 1);
    if (!in->skin) {
        snprintf(err->text, sizeof err->text, "out of memory");
        return err->status = TOBI_NO_MEMORY;
    }
    for (int64_t i = 0; i < m->count; i++) {
        const double number = material ? material->values[i] : 0;
        const int known = number >= 0 && number < in->looks.material_count;
        in->skin[i] = (int16_t)(known && in->skins[(int)number].image ? number : -1);
    }
    const tobi_surface_skins skins = { in->skins, in->looks.material_count, in->skin,
                                       (const double (*)[3])rest->values };
    return tobi_surface_make_skinned(&in->def, &skins, s, err);
}

static tobi_surface *make_one(const surface_options *o, const tobi_results *results, int64_t k, input *in)
{
    tobi_surface *s = NULL;
    tobi_error err = { 0 };
    if (read_input(o, results, k, in) != 0) return NULL;
    if ((o->images ? make_surface(in, &s, &err) : tobi_surface_make(&in->def, &s, &err)) != TOBI_OK)
        complain("%s", err.text);
    return s;
}

/* Least and largest value of the one field, sizes of vectors, over all outputs. */
static int find_range(const surface_options *o, const tobi_results *results, int64_t first, input *in,
                      double range[2])
{
    range[0] = INFINITY, range[1] = -INFINITY;
    for (int64_t k = first; k < tobi_results_count(results); k++) {
        const int code = read_input(o, results, k, in);
        for (int64_t i = 0; code == 0 && i < in->moment.count; i++) {
            const int n = in->field[0].components;
            const double *v = in->field[0].values + n*i;
            double square = 0;
            for (int c = 0; c < n; c++) square += v[c]*v[c];
            const double value = n == 1 ? *v : sqrt(square);
            range[0] = fmin(range[0], value);
            range[1] = fmax(range[1], value);
        }
        free_input(in);
        if (code != 0) return code;
    }
    return 0;
}

typedef struct totals { int64_t files, vertices, triangles; double particles, seconds; } totals;

static void add_totals(totals *t, const input *in, const tobi_surface *s)
{
    t->files++;
    t->vertices += s->vertex_count;
    t->triangles += s->triangle_count;
    t->particles += (double)in->moment.count;
}

static int write_movie(const surface_options *o, const tobi_results *results, const double up[3],
                       int64_t first,
                       input *in, totals *t)
{
    double range[2] = { 0, 1 };
    tobi_surface_movie *movie = NULL;
    tobi_error err = { 0 };
    const int64_t last = tobi_results_count(results);
    char *path = join_path(o->dir, "surface.glb");
    int code = o->field ? find_range(o, results, first, in, range) : 0;
    if (code == 0 && tobi_surface_movie_create(path, (int)(last - first), up, &movie, &err) != TOBI_OK)
        code = complain("%s", err.text);
    for (int64_t k = first; code == 0 && k < last; k++) {
        tobi_surface *s = make_one(o, results, k, in);
        const double time = o->slow*tobi_results_time(results, k);
        if (!s) code = EXIT_ERROR;
        else if (tobi_surface_movie_add(movie, time, s, o->field ? 0 : -1, range[0], range[1],
                                        &err) != TOBI_OK)
            code = complain("%s", err.text);
        else add_totals(t, in, s);
        tobi_surface_free(s);
        free_input(in);
    }
    if (code == 0 && tobi_surface_movie_finish(movie, &err) != TOBI_OK) code = complain("%s", err.text);
    tobi_surface_movie_free(movie);
    if (code == 0)
        printf(tr("surface: %s, %lld frame%s"), path, (long long)t->files, t->files == 1 ? "" : "s");
    free(path);
    return code;
}

static int write_files(const surface_options *o, const tobi_results *results, int64_t first, input *in,
                       totals *t)
{
    char *folder = join_path(o->dir, "surface"), name[64];
    int code = make_series_folder(folder);
    for (int64_t k = first; code == 0 && k < tobi_results_count(results); k++) {
        tobi_error err = { 0 };
        snprintf(name, sizeof name, "surface_%06lld.%s", (long long)k, o->format);
        char *path = join_path(folder, name);
        tobi_surface *s = make_one(o, results, k, in);
        if (!s) code = EXIT_ERROR;
        else if (tobi_surface_write(path, s, &err) != TOBI_OK) code = complain("%s", err.text);
        else add_totals(t, in, s);
        tobi_surface_free(s);
        free_input(in);
        free(path);
    }
    if (code == 0 && strcmp(o->format, "vtp") == 0)
        code = write_series_list(o->dir, "surface", results, first);
    if (code == 0)
        printf(tr("surface: %s, %lld file%s"), folder, (long long)t->files, t->files == 1 ? "" : "s");
    free(folder);
    return code;
}

/* Spacing and domain. */
static int read_scene(const surface_options *o, input *in, double up[3])
{
    tobi_scene *scene = NULL;
    const overrides none = { 0 };
    const int code = load_looks(o->dir, &none, &scene, &in->looks), dimension = in->looks.dimension;
    double weight = 0;
    if (code == 0) {
        in->def = tobi_default_surface();
        in->def.spacing = in->looks.spacing;
        in->def.cell = o->cell;
        in->def.smoothing = o->smooth;
        in->def.threads = o->threads;
    }
    for (int a = 0; code == 0 && a < 3; a++) {
        in->def.box_min[a] = in->looks.box_min[a], in->def.box_max[a] = in->looks.box_max[a];
        in->def.flat_min[a] = in->def.flat_max[a] = 1;
        up[a] = -in->looks.gravity[a];
        weight += up[a]*up[a];
    }
    if (!(weight > 0)) up[2] = 1;
    tobi_scene_free(scene);
    if (code != 0 || dimension != 3) tobi_looks_free(&in->looks);
    return code != 0 || dimension == 3 ? code : complain("%s is a run in 2-D, which has no surface", o->dir);
}

const struct argp surface_argp = { .options = options, .parser = parse, .args_doc = "DIR",
    .doc = "Make the surfaces of the fluids and of each piece of the solids of the run in DIR from its "
           "particles: closed meshes in DIR/surface, for each output, or DIR/surface.glb, for Blender." };

static int make(surface_options *o)
{
    tobi_results *results = NULL;
    tobi_error err = { 0 };
    input in = { 0 };
    totals t = { 0 };
    double up[3];
    int code = read_scene(o, &in, up);
    if (code != 0) return code;
    if (tobi_results_open(o->dir, &results, &err) != TOBI_OK) return complain("%s", err.text);
    o->images = strcmp(o->format, "glb") == 0 && !o->field;
    if (o->images) code = make_skins(&in);
    if (code != 0) return code;
    const double begun = wall_clock();
    const int64_t first = o->last ? tobi_results_count(results) - 1 : 0;
    code = strcmp(o->format, "glb") == 0 ? write_movie(o, results, up, first, &in, &t)
                                         : write_files(o, results, first, &in, &t);
    if (code == 0)
        printf(tr(", %.3g million triangles, %.3g million particles in %.3g s\n"), 1e-6*(double)t.triangles,
               1e-6*t.particles, wall_clock() - begun);
    free_input(&in);
    free(in.skins);
    tobi_looks_free(&in.looks);
    tobi_results_free(results);
    return code;
}

static const surface_options usual = { .format = "vtp", .cell = 0.75, .slow = 1, .smooth = 20 };

int make_surfaces(const char *dir, const char *format, double slow)
{
    surface_options o = usual;
    o.dir = dir, o.format = format, o.slow = slow;
    return make(&o);
}

int tobiuo_surface(int argc, char **argv)
{
    surface_options o = usual;
    parse_arguments(&surface_argp, argc, argv, &o);
    return make(&o);
}
