/* tobiuo picture DIR: a picture of an output of a finished run, with the settings of its scene, each of
   which can be changed. Drawback: the files do not know the colours that solids and bodies have in the
   scene. */
#define _GNU_SOURCE
#include "app.h"
#include "tobiuo/picture.h"
#include "tobiuo/results.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct draw_options {
    const char *dir, *out, *view;
    int64_t output;                    /* -1: the last */
    overrides set;
} draw_options;

enum { KEY_OUTPUT = KEY_OWN, KEY_VALUE, KEY_VIEW };

static const struct argp_option options[] = {
    { "out", 'o', "FILE", 0, "the picture (DIR/picture.png)", 0 },
    { "output", KEY_OUTPUT, "N", 0, "number of the output, from 0 (the last)", 0 },
    { "view", KEY_VIEW, "NAME", 0, "as this entry of output.views of the scene", 0 },
    { "set", KEY_VALUE, "PATH=VALUE", 0, "change a value of the scene, e.g. output.picture.field=pressure",
      0 },
    { 0 }
};

static error_t parse(int key, char *value, struct argp_state *state)
{
    draw_options *o = state->input;
    char *end;
    switch (key) {
    case 'o': o->out = value; break;
    case KEY_OUTPUT:
        o->output = strtoll(value, &end, 10);
        if (end == value || *end || o->output < 0)
            argp_error(state, "--output: '%s' is not a number from 0 on", value);
        break;
    case KEY_VIEW: o->view = value; break;
    case KEY_VALUE: overrides_add(&o->set, "%s", value); break;
    default: return parse_argument(state, key, value, "DIR", &o->dir);
    }
    return 0;
}

/* All that the picture points to. */
typedef struct drawing {
    tobi_scene *scene;
    const tobi_view_def *view;         /* of the scene */
    tobi_moment moment;
    tobi_picture p;
    float *values;
    uint8_t *opaque;
    int32_t *group;
    tobi_picture_mesh *meshes;
    char title[64], label[160];
} drawing;

static void free_drawing(drawing *d)
{
    tobi_scene_free(d->scene);
    tobi_moment_free(&d->moment);
    free(d->values);
    free(d->opaque);
    free(d->group);
    free(d->meshes);
}

static const tobi_moment_field *find_field(const tobi_moment *m, const char *name)
{
    for (int k = 0; k < m->field_count; k++)
        if (strcmp(m->fields[k].name, name) == 0) return &m->fields[k];
    return NULL;
}

static int load(const draw_options *o, drawing *d)
{
    tobi_results *results = NULL;
    tobi_report *mistakes = NULL;
    tobi_error err = { 0 };
    char *path = NULL;
    if (asprintf(&path, "%s/resolved.json", o->dir) < 0) return complain("out of memory");
    if (access(path, F_OK) != 0) {
        free(path);
        return complain_run(o->dir, "there are no results of a run (no resolved.json)");
    }
    const char *const *set = (const char *const *)o->set.text;
    tobi_status status = tobi_scene_load(path, set, &d->scene, &mistakes, &err);
    free(path);
    if (status != TOBI_OK) return complain_scene(mistakes, &err);
    tobi_report_free(mistakes);
    status = tobi_results_open(o->dir, &results, &err);
    const int64_t last = status == TOBI_OK ? tobi_results_count(results) - 1 : 0;
    if (status == TOBI_OK)
        status = tobi_results_read(results, o->output >= 0 ? o->output : last, &d->moment, &err);
    tobi_results_free(results);
    return status == TOBI_OK ? 0 : complain("%s", err.text);
}

/* The colours of a field, over the range that the scene gives or that of the values. */
static int set_values(drawing *d)
{
    const char *name = d->view->field ? d->view->field : "velocity", *unit = NULL, *known;
    const tobi_moment_field *f = find_field(&d->moment, name);
    const int64_t n = d->moment.count;
    int components;
    if (!f) return complain("the output has no field '%s'; output.fields of the scene writes it", name);
    d->values = malloc((size_t)n*sizeof *d->values + 1);
    if (!d->values) return complain("out of memory");
    d->p.value_min = INFINITY, d->p.value_max = -INFINITY;
    for (int64_t i = 0; i < n; i++) {
        double square = 0;
        const double *v = f->values + i*f->components;
        for (int c = 0; c < f->components; c++) square += v[c]*v[c];
        d->values[i] = (float)(f->components > 1 ? sqrt(square) : *v);
        d->p.value_min = fmin(d->p.value_min, d->values[i]);
        d->p.value_max = fmax(d->p.value_max, d->values[i]);
    }
    if (d->view->min < d->view->max) d->p.value_min = d->view->min, d->p.value_max = d->view->max;
    if (!(d->p.value_min < d->p.value_max)) d->p.value_max = d->p.value_min + 1e-6;
    for (int k = 0; (known = tobi_world_field_name(k, &components, &unit)) && strcmp(known,
                                                                                     name) != 0; k++) { }
    snprintf(d->label, sizeof d->label, unit && strcmp(unit, "1") != 0 ? "%s [%s]" : "%s", name, unit);
    d->p.label = d->label;
    d->p.values = d->values;
    d->p.palette = tobi_color_map(tobi_color_map_name(d->view->map), &d->p.palette_count);
    if (d->p.look == TOBI_LOOK_NATURAL) d->p.look = TOBI_LOOK_SURFACE;
    return 0;
}

/* Particles of mlsmpm are solids: a surface around each material and each piece. */
static int set_groups(drawing *d)
{
    const tobi_moment *m = &d->moment;
    const tobi_moment_field *material = find_field(m, "material"), *piece = find_field(m, "piece");
    d->opaque = malloc((size_t)m->count + 1);
    d->group = malloc((size_t)m->count*sizeof *d->group + 1);
    if (!d->opaque || !d->group) return complain("out of memory");
    memset(d->opaque, 1, (size_t)m->count);
    for (int64_t i = 0; i < m->count; i++) {
        const double p = piece ? piece->values[i] : -1, s = material ? material->values[i] : 0;
        d->group[i] = p >= 0 && p < 1e9 ? 1 + (int32_t)p : s >= 0 && s < 1e9 ? -(int32_t)s : 0;
    }
    d->p.opaque = d->opaque;
    d->p.group = d->group;
    return 0;
}

static int set_meshes(drawing *d)
{
    static const float colors[][3] = { { 0.93f, 0.62f, 0.28f }, { 0.80f, 0.33f, 0.36f },
                                       { 0.55f, 0.70f, 0.35f }, { 0.62f, 0.50f, 0.74f } };
    const tobi_moment *m = &d->moment;
    d->meshes = calloc((size_t)m->surface_count + 1, sizeof *d->meshes);
    if (!d->meshes) return complain("out of memory");
    for (int k = 0; k < m->surface_count; k++) {
        const tobi_moment_surface *s = &m->surfaces[k];
        d->meshes[k] = (tobi_picture_mesh){ s->vertex_count, (const double (*)[3])s->vertices,
                                            s->triangle_count,
                                            (const int32_t (*)[3])s->triangles, { 0 }, 0, 0 };
        memcpy(d->meshes[k].color, colors[k % 4], sizeof colors[0]);
    }
    d->p.meshes = d->meshes;
    d->p.mesh_count = m->surface_count;
    return 0;
}

static void set_view(drawing *d)
{
    const tobi_world_def *w = tobi_scene_world_def(d->scene);
    tobi_picture *p = &d->p;
    *p = tobi_default_picture();
    p->dimension = w->dimension;
    p->radius = 0.5*w->spacing;
    for (int a = 0; a < 3; a++) {
        p->box_min[a] = w->domain_min[a], p->box_max[a] = w->domain_max[a];
        p->up[a] = -w->gravity[a];
    }
    tobi_picture_set_view(p, d->view);
    p->particle_count = d->moment.count;
    p->positions = (const double (*)[3])d->moment.positions;
    snprintf(d->title, sizeof d->title, "t = %.4f s", d->moment.time);
    p->title = d->title;
}

static int find_view(const draw_options *o, drawing *d)
{
    const tobi_output_def *output = tobi_scene_output_def(d->scene);
    d->view = o->view ? NULL : &output->view;
    for (int k = 0; !d->view && k < output->view_count; k++)
        if (strcmp(output->views[k].name, o->view) == 0) d->view = &output->views[k];
    return d->view ? 0 : complain("the scene of %s has no view '%s'", o->dir, o->view);
}

static int draw(const draw_options *o, drawing *d)
{
    tobi_error err = { 0 };
    char *path = NULL;
    int code = load(o, d);
    if (code != 0) return code;
    const tobi_world_def *w = tobi_scene_world_def(d->scene);
    const tobi_moment_field *velocity = find_field(&d->moment, "velocity");
    code = find_view(o, d);
    if (code != 0) return code;
    set_view(d);
    code = set_meshes(d);
    if (code == 0 && strcmp(w->method, "mlsmpm") == 0) code = set_groups(d);
    if (code == 0 && (d->view->field || d->view->look || w->dimension == 2))
        code = set_values(d);
    if (code == 0 && d->view->arrows && velocity)
        d->p.velocities = (const double (*)[3])(const void *)velocity->values;
    if (code != 0) return code;
    if (asprintf(&path, "%s/picture.png", o->dir) < 0) return complain("out of memory");
    const char *out = o->out ? o->out : path;
    if (tobi_picture_write(out, &d->p, &err) != TOBI_OK) code = complain("%s", err.text);
    else printf("picture: %s, %d x %d, %s\n", out, d->p.width, d->p.height, d->title);
    free(path);
    return code;
}

const struct argp picture_argp = { .options = options, .parser = parse, .args_doc = "DIR",
    .doc = "Draw a picture of an output of the run in DIR: water as it looks or the colours of a field, with "
           "arrows, axes, a clip plane. Everything under output.picture and output.camera can be set." };

int tobiuo_picture(int argc, char **argv)
{
    draw_options o = { .output = -1 };
    drawing d = { 0 };
    parse_arguments(&picture_argp, argc, argv, &o);
    const int code = draw(&o, &d);
    free_drawing(&d);
    overrides_free(&o.set);
    return code;
}
