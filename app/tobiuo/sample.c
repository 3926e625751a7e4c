/* tobiuo sample DIR: fields of a finished run at places, at each output, and their means (decision 147).
   Drawback: each output is read whole, for a few places too. */
#define _GNU_SOURCE
#include "sample.h"
#include <ctype.h>
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { KEY_LINE = KEY_OWN, KEY_POINTS, KEY_BOX, KEY_COUNT, KEY_CELL, KEY_FIELDS, KEY_FROM, KEY_END, KEY_MEAN,
       KEY_WITH, KEY_FLUID, KEY_SOLID, KEY_NAME, KEY_THREADS };

static const struct argp_option options[] = {
    { "line", KEY_LINE, "\"A to B\"", 0, "places along a line from X,Y[,Z] to X,Y[,Z], m; may be repeated",
      0 },
    { "count", KEY_COUNT, "N", 0, "places of a line (50)", 0 },
    { "points", KEY_POINTS, "FILE", 0, "places of a CSV table with columns x, y and, in 3-D, z, m", 0 },
    { "box", KEY_BOX, "\"A to B\"", 0, "a regular grid from corner to corner, for ParaView; with equal "
      "coordinates along an axis a plane", 0 },
    { "cell", KEY_CELL, "M", 0, "distance of its points, m (the spacing of the particles)", 0 },
    { "fields", KEY_FIELDS, "A,B,...", 0, "which fields, or components of them, like velocity_x (all of "
      "the files)", 0 },
    { "from", KEY_FROM, "S", 0, "use outputs from this time on, s (the start)", 0 },
    { "until", KEY_END, "S", 0, "and up to this time, s (the end)", 0 },
    { "mean", KEY_MEAN, NULL, 0, "and the means over these outputs, root mean squares of the fluctuations, "
      "Reynolds stresses, and the share of outputs at which a place is wet", 0 },
    { "with", KEY_WITH, "BODY", 0, "places move and turn with a body from where they are at the start; "
      "velocities are relative to it, vectors in its axes", 0 },
    { "fluid", KEY_FLUID, "NAME", 0, "of this fluid alone (all liquids together)", 0 },
    { "solid", KEY_SOLID, "NAME", 0, "of this solid instead", 0 },
    { "name", KEY_NAME, "NAME", 0, "of the files in DIR/sample (line, points or box)", 0 },
    { "format", 'f', "FORMAT", 0, "of the picture of a line: svg (default) or png", 0 },
    { "threads", KEY_THREADS, "N", 0, "threads (all cores)", 0 },
    { 0 }
};

static void check_name(struct argp_state *state, const char *name)
{
    int good = *name && strlen(name) <= 60;
    for (const char *c = name; *c; c++) good &= isalnum((unsigned char)*c) || strchr("-_", *c);
    if (!good) usage_error(state, tr("--name: '%s' is not of 1 to 60 letters, digits, - and _"), name);
}

static void check_whole(sample_options *o, struct argp_state *state)
{
    const int ways = (o->line_count > 0) + (o->points != NULL) + (o->box != NULL);
    if (ways != 1) usage_error(state, tr("%s of --line, --points, --box"), ways ? tr("only one")
                              : tr("where? one"));
    if (o->fluid && o->solid) usage_error(state, tr("--fluid or --solid, not both"));
    if (!(o->from <= o->until)) usage_error(state, tr("--from %g lies behind --until %g"), o->from, o->until);
    if (o->cell > 0 && !o->box) usage_error(state, tr("--cell is for --box"));
    if (o->count > 0 && !o->line_count) usage_error(state, tr("--count is for --line"));
    if (o->count == 0) o->count = 50;
    if (!o->name) o->name = o->line_count ? "line" : o->points ? "points" : "box";
}

static error_t parse_more(int key, char *value, struct argp_state *state, sample_options *o)
{
    char *end;
    switch (key) {
    case KEY_COUNT:
        o->count = (int)fmin(fmax((double)strtoll(value, &end, 10), -1), 2e9);
        if (end == value || *end || o->count < 2 || o->count > 1000000)
            usage_error(state, tr("--count: '%s' is not a whole number from 2 to 1000000"), value);
        return 0;
    case KEY_NAME: check_name(state, o->name = value); return 0;
    case KEY_THREADS: o->threads = parse_threads(state, value); return 0;
    case ARGP_KEY_END: check_whole(o, state); break;
    default: break;
    }
    return parse_argument(state, key, value, "DIR", &o->dir);
}

static error_t parse(int key, char *value, struct argp_state *state)
{
    sample_options *o = state->input;
    switch (key) {
    case KEY_LINE:
        if (o->line_count == SAMPLE_LINES) usage_error(state, tr("--line: at most %d times"), SAMPLE_LINES);
        o->line[o->line_count++] = value;
        break;
    case KEY_POINTS: o->points = value; break;
    case KEY_BOX: o->box = value; break;
    case KEY_CELL: o->cell = parse_positive(state, "--cell", value); break;
    case KEY_FIELDS: o->fields = value; break;
    case KEY_FROM: o->from = parse_time(state, "--from", value); break;
    case KEY_END: o->until = parse_time(state, "--until", value); break;
    case KEY_MEAN: o->mean = 1; break;
    case KEY_WITH: o->body = value; break;
    case KEY_FLUID: o->fluid = value; break;
    case KEY_SOLID: o->solid = value; break;
    case 'f':
        if (strcmp(value, "svg") != 0 && strcmp(value, "png") != 0)
            usage_error(state, tr("--format: '%s' is neither svg nor png"), value);
        o->format = value;
        break;
    default: return parse_more(key, value, state, o);
    }
    return 0;
}

/* --- what is asked for --- */

static int find_span(sample_run *s)
{
    const sample_options *o = s->options;
    const int64_t count = tobi_results_count(s->results);
    s->first = 0, s->end = count;
    while (s->first < count && tobi_results_time(s->results, s->first) < o->from*(1 - 1e-9)) s->first++;
    while (s->end > s->first && tobi_results_time(s->results, s->end - 1) > o->until*(1 + 1e-9)) s->end--;
    return s->end > s->first ? 0
        : complain("%s has no output in the time that is asked for; its outputs are from %g to %g s", o->dir,
                   tobi_results_time(s->results, 0), tobi_results_time(s->results, count - 1));
}

/* The number of a fluid or solid by its name: fluids first, as files number them. */
static int find_named(sample_run *s, const json_t *scene, const char *list, const char *name)
{
    const char *names[TOBI_SOLID_LIMIT];
    size_t count = 0;
    const size_t fluids = json_array_size(json_object_get(scene, "fluids"));
    const json_t *all = json_object_get(scene, list);
    for (size_t k = 0; k < json_array_size(all) && count < TOBI_SOLID_LIMIT; k++) {
        const char *own = json_string_value(json_object_get(json_array_get(all, k), "name"));
        names[count++] = own ? own : "";
        if (own && strcmp(own, name) == 0) s->material = (int)(k + (*list == 's' ? fluids : 0));
    }
    const char *near = s->material < 0 ? tobi_suggest(name, names, count) : NULL;
    return s->material >= 0 ? 0
        : complain("%s has no %s '%s'%s%s%s", s->options->dir, *list == 's' ? tr("solid") : tr("fluid"), name,
                   near ? tr("; did you mean ") : "", near ? near : "", near ? "?" : "");
}

/* Points of a body that gives its own spacing may lie closer than those of the liquid. */
static void compare_spacings(sample_run *s, const json_t *scene)
{
    const json_t *bodies = json_object_get(scene, "bodies");
    for (size_t k = 0; k < json_array_size(bodies); k++) {
        const json_t *own = json_object_get(json_array_get(bodies, k), "spacing");
        s->finer |= json_number_value(json_is_number(own) ? own : json_object_get(scene, "spacing")) <
                    0.99*s->spacing;
    }
}

static int find_material(sample_run *s)
{
    const sample_options *o = s->options;
    char *path = join_path(o->dir, "resolved.json");
    json_error_t wrong;
    json_t *scene = json_load_file(path, 0, &wrong);
    int code = scene ? 0 : complain("%s: %s", path, wrong.text), chosen = -1;
    free(path);
    s->material = -1;
    if (!code && o->fluid) code = find_named(s, scene, "fluids", o->fluid);
    if (!code && o->solid) code = find_named(s, scene, "solids", o->solid);
    chosen = s->material;
    for (int k = 0; k < s->looks.material_count && chosen < 0; k++)
        if (s->looks.materials[k].liquid) chosen = k;
    if (!code && (chosen < 0 || chosen >= s->looks.material_count))
        code = complain("%s is a run without a liquid; --solid NAME takes a solid", o->dir);
    if (!code) s->spacing = 2*tobi_looks_radius(&s->looks, chosen);
    if (!code) compare_spacings(s, scene);
    json_decref(scene);
    return code;
}

static int complain_field(const sample_run *s, const tobi_moment *m, const char *name)
{
    const char *names[256];
    char list[900];
    size_t count = 0;
    for (int k = 0; k < m->field_count && count < 256; k++) names[count++] = m->fields[k].name;
    const char *near = tobi_suggest(name, names, count);
    list_moment_fields(m, list, sizeof list);
    if (near) return complain("%s has no field '%s'; did you mean %s?", s->options->dir, name, near);
    return complain("%s has no field '%s'; it has %s; output.fields of the scene adds others",
                    s->options->dir, name, list + (*list ? 2 : 0));
}

/* component: -1 of the whole field; `name` says which. */
static int add_field(sample_run *s, const tobi_moment_field *f, const char *name, int component)
{
    tobi_error err = { 0 };
    sample_field *own = &s->field[s->field_count];
    const size_t size = (size_t)s->places.count*sizeof(double);
    if (s->field_count == TOBI_SAMPLE_FIELD_LIMIT || f->components > 9 || f->components < 1) return 0;
    snprintf(s->names[s->field_count], sizeof *s->names, "%s", name);
    *own = (sample_field){ .name = s->names[s->field_count++], .unit = "", .component = component,
                           .components = component < 0 ? f->components : 1, .all = f->components };
    const char *unit, *source = tobi_world_find_field(own->name, NULL, &unit);
    own->source = source ? source : own->name;
    if (source && strcmp(unit, "1") != 0) own->unit = unit;
    own->read = malloc(size*(size_t)own->all + 1);
    own->at = component < 0 ? own->read : malloc(size + 1);
    if (!own->read || !own->at) return complain("out of memory");
    if (s->options->mean && tobi_sample_mean_create(s->places.count, own->components, s->options->threads,
                                                    &own->mean, &err) != TOBI_OK)
        return complain("%s", err.text);
    return 0;
}

/* The same column twice: by the same name, or by the whole field and a component of it. */
static int is_taken(const sample_run *s, const tobi_moment_field *f, int component)
{
    for (int k = 0; k < s->field_count; k++) {
        const sample_field *own = &s->field[k];
        if (strcmp(own->source, f->name) == 0 &&
            (own->component == component || own->component < 0 || component < 0)) return 1;
    }
    return 0;
}

/* Those between commas, or all that are not numbers of something. */
static int find_fields(sample_run *s, const tobi_moment *m)
{
    int code = 0;
    const char *list = s->options->fields;
    for (int k = 0; !list && k < m->field_count && !code; k++)
        if (!is_label_field(m->fields[k].name)) code = add_field(s, &m->fields[k], m->fields[k].name, -1);
    for (const char *at = list; at && !code; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL) {
        char name[64];
        int component;
        snprintf(name, sizeof name, "%.*s", (int)strcspn(at, ","), at);
        const tobi_moment_field *f = find_moment_part(m, name, &component);
        if (f && is_label_field(name))
            code = complain("--fields: '%s' numbers things and has no means", name);
        else if (f && is_taken(s, f, component))
            code = complain("--fields: '%s' is asked for twice", name);
        else if (f) code = add_field(s, f, name, component);
        else code = complain_field(s, m, name);
    }
    if (!code && s->field_count == 0) code = complain("the outputs of %s have no fields", s->options->dir);
    return code;
}

/* --- outputs --- */

/* Particles of others and those that wait in inlets leave by their place. */
static void leave_out(const sample_run *s, tobi_moment *m)
{
    const tobi_moment_field *material = find_moment_field(m, "material");
    const tobi_looks *l = &s->looks;
    if (!material && l->inlet_count == 0) return;
    for (int64_t i = 0; i < m->count; i++) {
        const int k = material ? (int)material->values[i] : 0;
        const int is_ours = s->material >= 0 ? k == s->material
                                             : k < 0 || k >= l->material_count || l->materials[k].liquid;
        if (!is_ours || tobi_looks_hides(l, m->time, m->positions[i])) m->positions[i][0] = NAN;
    }
}

static int take_solids(sample_run *s, int64_t output, double (**points)[3], int64_t *count)
{
    tobi_error err = { 0 };
    if (s->finer) return take_body_points(s->results, output, s->spacing, &s->thinned, points, count);
    return tobi_results_read_bodies(s->results, output, points, count, &err) == TOBI_OK ? 0
        : complain("%s", err.text);
}

/* Of the fields of which one component is asked for. */
static void take_components(sample_run *s)
{
    for (int f = 0; f < s->field_count; f++) {
        sample_field *own = &s->field[f];
        for (int64_t i = 0; i < s->places.count && own->component >= 0; i++)
            own->at[i] = own->read[own->all*i + own->component];
    }
}

static int sample_moment(sample_run *s, int64_t output, const tobi_moment *m)
{
    tobi_sample_def d = tobi_default_sample();
    tobi_sample_field fields[TOBI_SAMPLE_FIELD_LIMIT];
    const tobi_world_def *world = tobi_scene_world_def(s->scene);
    tobi_error err = { 0 };
    double (*solids)[3];
    d.dimension = s->looks.dimension, d.spacing = s->spacing, d.threads = s->options->threads;
    for (int a = 0; a < 3; a++) {
        d.box_min[a] = s->looks.box_min[a], d.box_max[a] = s->looks.box_max[a];
        d.periodic[a] = world->wall_min[a] == TOBI_WALL_PERIODIC;
    }
    d.particle_count = m->count, d.positions = (const double (*)[3])m->positions;
    d.place_count = s->places.count;
    d.places = (const double (*)[3])(s->moved ? s->moved : s->places.x);
    d.fields = fields, d.field_count = s->field_count, d.wet = s->wet;
    for (int f = 0; f < s->field_count; f++) {
        const tobi_moment_field *field = find_moment_field(m, s->field[f].source);
        if (!field || field->components != s->field[f].all)
            return complain("%s: the output of %g s has no field '%s'", s->options->dir, m->time,
                            s->field[f].source);
        fields[f] = (tobi_sample_field){ field->components, field->values, s->field[f].read };
    }
    int code = take_solids(s, output, &solids, &d.solid_count);
    d.solids = (const double (*)[3])solids;
    if (!code && tobi_sample_make(&d, &err) != TOBI_OK) code = complain("%s", err.text);
    free(solids);
    if (!code) sample_turn_values(s);
    if (!code) take_components(s);
    for (int f = 0; f < s->field_count && s->options->mean && !code; f++)
        if (tobi_sample_mean_add(s->field[f].mean, s->wet, s->field[f].at, &err) != TOBI_OK)
            code = complain("%s", err.text);
    return code;
}

/* Some outputs are kept for the picture of a line: of means none, of several lines the last. */
static int keep_shown(sample_run *s, int64_t output, double time)
{
    const int64_t last = s->end - s->first - 1, k = output - s->first;
    const int64_t most = s->options->mean ? 0 : s->options->line_count > 1 ? 1 : SAMPLE_SHOWN;
    const int64_t wanted = s->shown_count;
    const int64_t number = last < most ? wanted : most == 1 ? last : wanted*last/(most > 1 ? most - 1 : 1);
    if (!s->options->line_count || wanted >= most || k != number) return 0;
    sample_shown *shown = &s->shown[s->shown_count++];
    const size_t places = (size_t)s->places.count;
    shown->time = time;
    for (int f = 0; f < s->field_count; f++) {
        const size_t size = places*(size_t)s->field[f].components*sizeof(double);
        if (!(shown->values[f] = malloc(size + 1))) return complain("out of memory");
        memcpy(shown->values[f], s->field[f].at, size);
    }
    return 0;
}

static int sample_output(sample_run *s, int64_t output, sample_table *t)
{
    tobi_moment m = { 0 };
    tobi_error err = { 0 };
    int code = tobi_results_read(s->results, output, &m, &err) == TOBI_OK ? 0 : complain("%s", err.text);
    if (!code && s->field_count == 0) code = find_fields(s, &m);
    if (!code && !s->places.is_grid && !t->path) code = sample_begin_table(s, t);
    if (!code) code = sample_move_places(s, m.time);
    if (!code) leave_out(s, &m);
    if (!code) code = sample_moment(s, output, &m);
    if (!code) code = s->places.is_grid ? sample_write_grid(s, output) : sample_write_rows(s, m.time, t);
    if (!code) code = keep_shown(s, output, m.time);
    tobi_moment_free(&m);
    return code;
}

static int sample_outputs(sample_run *s)
{
    const sample_options *o = s->options;
    sample_table t = { 0 };
    int64_t wet = 0;
    const double begun = wall_clock();
    char *folder = join_path(o->dir, "sample");
    int code = make_series_folder(folder);
    for (int64_t k = s->first; k < s->end && !code; k++) {
        code = sample_output(s, k, &t);
        for (int64_t i = 0; i < s->places.count && !code; i++) wet += s->wet[i];
    }
    code = sample_end_table(&t, code);
    const series list = { folder, "", s->name, "vti", s->first, s->end };
    if (!code && s->places.is_grid) code = write_list(&list, s->results);
    if (!code && o->mean) code = sample_write_means(s);
    const double places = (double)s->places.count*(double)(s->end - s->first);
    if (!code)
        printf(tr("sample: %s/%s.%s, %lld outputs, %lld places, %.3g %% wet, in %.3g s\n"), folder, s->name,
               s->places.is_grid ? "pvd" : "csv", (long long)(s->end - s->first), (long long)s->places.count,
               100*(double)wet/places, wall_clock() - begun);
    if (!code && o->mean)
        printf(tr("means: %s/%s_mean.%s\n"), folder, s->name, s->places.is_grid ? "vti" : "csv");
    free(folder);
    return code;
}

static int make(sample_run *s)
{
    const sample_options *o = s->options;
    const overrides none = { 0 };
    tobi_error err = { 0 };
    int code = load_looks(o->dir, &none, &s->scene, &s->looks);
    if (!code && tobi_results_open(o->dir, &s->results, &err) != TOBI_OK) code = complain("%s", err.text);
    if (!code) code = find_span(s);
    if (!code) code = find_material(s);
    if (!code) code = sample_find_body(s);
    if (!code) code = sample_find_places(s);
    if (code) return code;
    s->wet = malloc((size_t)s->places.count + 1);
    s->moved = o->body ? malloc((size_t)s->places.count*sizeof *s->moved + 1) : NULL;
    if (!s->wet || (o->body && !s->moved)) return complain("out of memory");
    code = sample_outputs(s);
    return code || !o->line_count ? code : sample_draw(s);
}

static void free_run(sample_run *s)
{
    for (int k = 0; k < s->shown_count; k++)
        for (int f = 0; f < s->field_count; f++) free(s->shown[k].values[f]);
    for (int f = 0; f < s->field_count; f++) {
        if (s->field[f].at != s->field[f].read) free(s->field[f].at);
        free(s->field[f].read);
        tobi_sample_mean_free(s->field[f].mean);
    }
    free(s->places.x);
    free(s->places.way);
    free(s->places.line);
    free(s->wet);
    free(s->moved);
    free(s->thinned.row);
    table_free(&s->bodies);
    tobi_results_free(s->results);
    tobi_looks_free(&s->looks);
    tobi_scene_free(s->scene);
}

const struct argp sample_argp = { .options = options, .parser = parse, .args_doc = "DIR",
    .doc = "Interpolate fields of the run in DIR at places: along lines, at points of a table, or on a grid "
           "for ParaView, at each output. A place in a body or in air is dry: its fields are empty, in a "
           "grid not a number. Files are in DIR/sample. Gnuplot draws the profiles of lines." };

int tobiuo_sample(int argc, char **argv)
{
    sample_options o = { .format = "svg", .until = INFINITY };
    parse_arguments(&sample_argp, argc, argv, &o);
    sample_run s = { .options = &o, .name = o.name };
    const int code = make(&s);
    free_run(&s);
    return code;
}
