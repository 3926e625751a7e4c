/* From the text of a scene to its definitions, and from the definitions to a world. */
#define _GNU_SOURCE 1
#include "scene/scene.h"
#include "base/plain.h"
#include "scene/import/import.h"
#include "scene/openings.h"
#include "scene/override.h"
#include "scene/parts.h"
#include "scene/write.h"
#include "base/param.h"
#include <limits.h>
#include <stdio.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

json_t *tobi_scene_list(const tobi_binder *binder, json_t *object, const tobi_place *place, const char *owner)
{
    int limit = tobi_part_find(owner, place->key).most;
    json_t *list = json_object_get(object, place->key);
    if (!list) return NULL;
    if (!json_is_array(list)) {
        tobi_source_mistake(binder->source, place, "is %s, must be a list [ { ... } ]",
                            tobi_json_kind(list));
        return NULL;
    }
    if (json_array_size(list) <= (size_t)limit) return list;
    tobi_source_mistake(binder->source, place, "has %zu entries, allowed are %d",
                        json_array_size(list), limit);
    return NULL;
}

const tobi_body_def *tobi_scene_find_body(const tobi_scene *scene, const char *name)
{
    for (int b = 0; b < scene->body_count; b++)
        if (scene->bodies[b].def.name && strcmp(scene->bodies[b].def.name, name) == 0)
            return &scene->bodies[b].def;
    return NULL;
}

/* The regions of an entry of fluids or solids, `owner` is "fluid" or "solid". */
static tobi_status read_fills(const tobi_binder *binder, json_t *value, const tobi_place *place,
                              const char *owner, int needed, tobi_scene_fill **fills, int *count)
{
    tobi_place fill = { place, "fill", 0 };
    json_t *list = tobi_scene_list(binder, value, &fill, owner);
    if (json_array_size(list) == 0) {
        if (needed && json_is_object(value) && (list || !json_object_get(value, "fill")))
            tobi_source_mistake(binder->source, &fill,
                                "is missing or empty: a list of the regions this %s "
                                "fills, [ { \"box\": { \"min\": [..], \"max\": [..] } } ]", owner);
        return TOBI_OK;
    }
    *fills = calloc(json_array_size(list), sizeof **fills);
    if (!*fills) return TOBI_NO_MEMORY;
    const char *also[TOBI_PARTS];
    tobi_part_keys("fill", also);
    for (size_t i = 0; i < json_array_size(list); i++) {
        tobi_place entry = { &fill, NULL, i }, flow = { &entry, "flow", 0 };
        json_t *region = json_array_get(list, i), *flows = json_object_get(region, "flow");
        tobi_scene_fill *f = &(*fills)[(*count)++];
        f->def = tobi_default_fill_def();
        f->bound = tobi_bind(binder, &tobi_fill_table, region, &entry, also, &f->def);
        if (!flows) continue;
        f->flow = tobi_control_bind(binder, TOBI_FLOW_SCRIPT, flows, &flow, &f->flow_def);
        f->def.flow = f->flow ? tobi_script_flow : NULL;
        f->def.flow_user = f->flow;
    }
    return TOBI_OK;
}

static tobi_status read_fluid(const tobi_binder *binder, json_t *value, const tobi_place *place, int needed,
                              tobi_scene_fluid *fluid)
{
    const char *also[TOBI_PARTS];
    tobi_part_keys("fluid", also);
    fluid->def = tobi_default_fluid_def();
    fluid->bound = tobi_bind(binder, &tobi_fluid_table, value, place, also, &fluid->def);
    return read_fills(binder, value, place, "fluid", needed, &fluid->fills, &fluid->fill_count);
}

static tobi_status read_fluids(tobi_scene *scene, const tobi_binder *binder, const tobi_place *root)
{
    tobi_place place = { root, "fluids", 0 };
    json_t *list = tobi_scene_list(binder, scene->root, &place, "world");
    if (!list) return TOBI_OK;
    scene->fluids = calloc(json_array_size(list) + 1, sizeof *scene->fluids);
    if (!scene->fluids) return TOBI_NO_MEMORY;
    for (size_t i = 0; i < json_array_size(list); i++) {
        tobi_place entry = { &place, NULL, i };
        TOBI_TRY(read_fluid(binder, json_array_get(list, i), &entry, !json_object_get(scene->root, "inlets"),
                            &scene->fluids[scene->fluid_count++]));
    }
    return TOBI_OK;
}

static tobi_status read_solids(tobi_scene *scene, const tobi_binder *binder, const tobi_place *root)
{
    const char *also[TOBI_PARTS];
    tobi_part_keys("solid", also);
    tobi_place place = { root, "solids", 0 };
    json_t *list = tobi_scene_list(binder, scene->root, &place, "world");
    if (!list) return TOBI_OK;
    scene->solids = calloc(json_array_size(list) + 1, sizeof *scene->solids);
    if (!scene->solids) return TOBI_NO_MEMORY;
    for (size_t i = 0; i < json_array_size(list); i++) {
        tobi_place entry = { &place, NULL, i };
        json_t *value = json_array_get(list, i);
        tobi_scene_solid *solid = &scene->solids[scene->solid_count++];
        solid->def = tobi_default_solid_def();
        solid->bound = tobi_bind(binder, &tobi_solid_table, value, &entry, also, &solid->def);
        TOBI_TRY(read_fills(binder, value, &entry, "solid", 1, &solid->fills, &solid->fill_count));
    }
    return TOBI_OK;
}

static tobi_status read_bodies(tobi_scene *scene, const tobi_binder *binder, const tobi_place *root)
{
    const char *also[TOBI_PARTS];
    tobi_part_keys("body", also);
    tobi_place place = { root, "bodies", 0 };
    json_t *list = tobi_scene_list(binder, scene->root, &place, "world");
    if (!list) return TOBI_OK;
    scene->bodies = calloc(json_array_size(list) + 1, sizeof *scene->bodies);
    if (!scene->bodies) return TOBI_NO_MEMORY;
    for (size_t i = 0; i < json_array_size(list); i++) {
        json_t *value = json_array_get(list, i);
        tobi_place entry = { &place, NULL, i }, motion = { &entry, "motion", 0 };
        tobi_scene_body *body = &scene->bodies[scene->body_count++];
        body->def = tobi_default_body_def();
        body->bound = tobi_bind(binder, &tobi_body_table, value, &entry, also, &body->def);
        tobi_joints_complete(value, binder->dimension, &body->def);
        json_t *moves = json_object_get(value, "motion"), *controls = json_object_get(value, "control");
        if (controls) {
            tobi_place control = { &entry, "control", 0 };
            body->control =
                tobi_control_bind(binder, TOBI_CONTROL_SCRIPT, controls, &control, &body->control_def);
            body->def.control = body->control ? tobi_script_control : NULL;
            body->def.control_user = body->control;
        }
        if (!moves) continue;
        body->motion = tobi_motion_bind(binder, moves, &motion, body->motion_def);
        if (!body->motion) continue;
        body->def.motion = tobi_motion_positions;
        body->def.motion_user = body->motion;
        body->def.motion_steer = tobi_motion_steer;
        body->def.motion_rigid = tobi_motion_is_rigid(body->motion);
    }
    return TOBI_OK;
}

static tobi_status read_planes(tobi_scene *scene, const tobi_binder *binder, const tobi_place *root)
{
    tobi_place place = { root, "planes", 0 };
    json_t *list = tobi_scene_list(binder, scene->root, &place, "world");
    if (!list) return TOBI_OK;
    scene->planes = calloc(json_array_size(list) + 1, sizeof *scene->planes);
    scene->planes_bound = calloc(json_array_size(list) + 1, sizeof *scene->planes_bound);
    if (!scene->planes || !scene->planes_bound) return TOBI_NO_MEMORY;
    for (size_t i = 0; i < json_array_size(list); i++) {
        tobi_place entry = { &place, NULL, i };
        tobi_plane_def *plane = &scene->planes[scene->plane_count];
        *plane = tobi_default_plane_def();
        scene->planes_bound[scene->plane_count++] =
            tobi_bind(binder, &tobi_plane_table, json_array_get(list, i), &entry, NULL, plane);
    }
    return TOBI_OK;
}

static tobi_status read_probes(tobi_scene *scene, const tobi_binder *binder, const tobi_place *root)
{
    tobi_place place = { root, "probes", 0 };
    json_t *list = tobi_scene_list(binder, scene->root, &place, "world");
    if (!list) return TOBI_OK;
    scene->probes = calloc(json_array_size(list) + 1, sizeof *scene->probes);
    scene->probes_bound = calloc(json_array_size(list) + 1, sizeof *scene->probes_bound);
    if (!scene->probes || !scene->probes_bound) return TOBI_NO_MEMORY;
    for (size_t i = 0; i < json_array_size(list); i++) {
        tobi_place entry = { &place, NULL, i };
        tobi_probe_def *probe = &scene->probes[scene->probe_count];
        *probe = tobi_default_probe_def();
        scene->probes_bound[scene->probe_count++] =
            tobi_bind(binder, &tobi_probe_table, json_array_get(list, i), &entry, NULL, probe);
    }
    return TOBI_OK;
}

static tobi_status read_references(tobi_scene *scene, const tobi_binder *binder,
                                   const tobi_place *root)
{
    tobi_place place = { root, "references", 0 };
    json_t *list = tobi_scene_list(binder, scene->root, &place, "world");
    if (!list) return TOBI_OK;
    scene->references = calloc(json_array_size(list) + 1, sizeof *scene->references);
    if (!scene->references) return TOBI_NO_MEMORY;
    for (size_t i = 0; i < json_array_size(list); i++) {
        tobi_place entry = { &place, NULL, i };
        tobi_reference_def *def = &scene->references[scene->reference_count++];
        *def = tobi_default_reference_def();
        tobi_bind(binder, &tobi_reference_table, json_array_get(list, i), &entry, NULL, def);
    }
    return TOBI_OK;
}

/* Parameters of methods that are not chosen are checked too. */
static tobi_status read_method(tobi_scene *scene, const tobi_binder *binder, const tobi_place *root)
{
    const char *name;
    scene->method = tobi_method_table(scene->world.method);        /* NULL: the check reports it */
    for (int i = 0; (name = tobi_method_name(i)); i++) {
        const tobi_param_table *table = tobi_method_table(name);
        json_t *value = json_object_get(scene->root, name);
        tobi_place place = { root, name, 0 };
        void *def = malloc(table->size);
        if (!def) return TOBI_NO_MEMORY;
        tobi_param_defaults(table, def);
        tobi_bound bound = { 0 };
        if (value) bound = tobi_bind(binder, table, value, &place, NULL, def);
        if (table != scene->method) {
            if (strcmp(name, TOBI_METHOD_OF_SOLIDS) == 0) scene->solids_def = *(const tobi_mlsmpm_def *)def;
            free(def);
            continue;
        }
        scene->method_def = def;
        scene->method_bound = bound;
    }
    return TOBI_OK;
}

/* A plane flow lies in z = 0 and falls along y unless it is told otherwise. */
static void flatten_world(tobi_scene *scene)
{
    tobi_world_def *w = &scene->world;
    if (w->dimension != 2) return;
    w->domain_min[2] = w->domain_max[2] = 0;
    if (tobi_bind_has(&tobi_world_table, scene->world_bound.good, "gravity")) return;
    w->gravity[0] = w->gravity[2] = 0;
    w->gravity[1] = -9.81;
}

/* Along an axis exactly the number of the scene. */
static double size_of(const double v[3]) { return hypot(hypot(v[0], v[1]), v[2]); }

/* Where the key is wrong, the corners tell which other values are right. */
static int find_dimension(const json_t *scene)
{
    const json_t *given = json_object_get(scene, "dimension");
    const json_t *corner = json_object_get(json_object_get(scene, "domain"), "max");
    const json_int_t value = json_integer_value(given);
    if (!given || value == 2 || value == 3) return value == 2 ? 2 : 3;
    return json_array_size(corner) == 2 ? 2 : 3;
}

static tobi_status read_scene(tobi_scene *scene, tobi_source *source)
{
    const char *also[TOBI_PARTS];
    tobi_part_keys("world", also);
    tobi_place root = { 0 };

    tobi_binder binder = { source, &scene->texts, scene->directory, 3, 0 };
    binder.dimension = find_dimension(scene->root);
    scene->world = tobi_default_world_def();
    scene->world_bound =
        tobi_bind(&binder, &tobi_world_table, scene->root, &root, also, &scene->world);
    scene->world.dimension = binder.dimension;
    flatten_world(scene);
    binder.gravity = size_of(scene->world.gravity);
    TOBI_TRY(read_method(scene, &binder, &root));
    TOBI_TRY(read_fluids(scene, &binder, &root));
    TOBI_TRY(tobi_interfaces_bind(scene, &binder, &root));
    TOBI_TRY(read_solids(scene, &binder, &root));
    TOBI_TRY(read_bodies(scene, &binder, &root));
    tobi_tank_bind(&scene->tank, &binder, scene->root, &root);
    TOBI_TRY(read_planes(scene, &binder, &root));
    TOBI_TRY(tobi_openings_read(scene, &binder, &root));
    TOBI_TRY(tobi_lines_bind(scene, &binder, &root));
    TOBI_TRY(tobi_joint_list_bind(scene, &binder, &root));
    TOBI_TRY(read_probes(scene, &binder, &root));
    TOBI_TRY(tobi_output_bind(scene, &binder, &root));
    TOBI_TRY(read_references(scene, &binder, &root));
    if (scene->texts.failed) return TOBI_NO_MEMORY;
    tobi_scene_check(scene, source);
    return tobi_report_total(source->report) ? TOBI_INVALID : TOBI_OK;
}

/* The directory's own name for a scene.json or setting.json, or else the file's without its extension. */
static char *name_scene(const char *directory, const char *path)
{
    const char *slash = strrchr(path, '/'), *file = slash ? slash + 1 : path;
    if (strcmp(file, "scene.json") == 0 || strcmp(file, "setting.json") == 0) {
        slash = strrchr(directory, '/');
        if (slash && slash[1]) return strdup(slash + 1);
    }
    const char *dot = strrchr(file, '.');
    return strndup(file, dot && dot > file ? (size_t)(dot - file) : strlen(file));
}

char *tobi_scene_find_directory(const char *path)
{
    const char *slash = strrchr(path, '/');
    char *directory = slash == path ? strdup("/")
                      : slash       ? strndup(path, (size_t)(slash - path))
                                    : strdup(".");
    char *absolute = directory ? realpath(directory, NULL) : NULL;
    if (absolute) free(directory);
    return absolute ? absolute : directory;
}

static tobi_status parse_source(tobi_scene *scene, tobi_source *source,
                                const char *const *overrides, tobi_error *err)
{
    tobi_status status = TOBI_OK;
    const int tank = tobi_import_tank_applies(source->root);
    if (source->python)
        status = tobi_import_translate_cut(source, &scene->texts, scene->directory, &scene->import_table);
    else if (tobi_import_applies(source->root))
        status = tobi_import_translate(source, &scene->texts, scene->directory, &scene->import_table,
                                       &scene->stand_ins);
    else if (tank)
        status = tobi_import_translate_tank(source, &scene->texts, scene->directory, &scene->import_table,
                                            &scene->object_files);
    scene->import_program = tank ? TR("the tank program") : TR("the Taichi program");
    scene->root = json_incref(source->root);
    if (status == TOBI_OK) TOBI_TRY(tobi_override_apply(source, overrides, err));
    if (status == TOBI_OK) status = read_scene(scene, source);
    return status == TOBI_NO_MEMORY ? tobi_fail(err, status, "no memory for the scene") : status;
}

static int is_native(const tobi_source *source)
{
    return !source->python && !tobi_import_applies(source->root) && !tobi_import_tank_applies(source->root);
}

/* foreign: 1 takes only scenes of other programs. */
static tobi_status parse(const char *path, const char *text, size_t size, const char *const *overrides,
                         int foreign, tobi_scene **out, tobi_report **report_out, tobi_error *err)
{
    *out = NULL;
    if (report_out) *report_out = NULL;
    if (size > TOBI_SOURCE_LIMIT)
        return tobi_fail(err, TOBI_INVALID, "%s: %zu bytes of scene, allowed are %d", path, size,
                         (int)TOBI_SOURCE_LIMIT);
    tobi_scene *scene = calloc(1, sizeof *scene);
    tobi_report *report = tobi_report_create();
    if (scene) scene->directory = tobi_scene_find_directory(path);
    if (scene && scene->directory) scene->name = name_scene(scene->directory, path);
    tobi_status status = TOBI_NO_MEMORY;
    if (!scene || !report || !scene->name) tobi_fail(err, status, "no memory for the scene");
    else status = tobi_source_parse(&scene->source, path, text, size, report, err);
    if (status == TOBI_OK && foreign && is_native(&scene->source)) {
        tobi_report_add(report, 0, "%s is a native scene already, or none: it has neither Configuration nor "
                        "input_files, the marks of those that can be imported", path);
        status = TOBI_INVALID;
    }
    if (status == TOBI_OK) status = parse_source(scene, &scene->source, overrides, err);
    if (status == TOBI_INVALID) {
        tobi_report_close(report);
        status = tobi_report_fail(report, err);
    }
    if (scene) scene->source.report = NULL;
    if (status == TOBI_INVALID && report_out) {
        *report_out = report;
        report = NULL;
    }
    tobi_report_free(report);
    if (status == TOBI_OK) *out = scene;
    else tobi_scene_free(scene);
    return status;
}

tobi_status tobi_scene_parse(const char *name, const char *text, size_t size, const char *const *overrides,
                             tobi_scene **scene, tobi_report **report, tobi_error *err)
{
    TOBI_NEED(scene, "where the scene goes");
    *scene = NULL;
    if (report) *report = NULL;
    TOBI_NEED(name, "the name");
    TOBI_NEED(text || size == 0, "the text");
    return parse(name, text, size, overrides, 0, scene, report, err);
}

static tobi_status load(const char *path, const char *const *overrides, int foreign, tobi_scene **scene,
                        tobi_report **report, tobi_error *err)
{
    char *text;
    size_t size;
    *scene = NULL;
    if (report) *report = NULL;
    TOBI_TRY(tobi_plain_read(path, tr("scene"), TOBI_SOURCE_LIMIT, &text, &size, err));
    tobi_status status = parse(path, text, size, overrides, foreign, scene, report, err);
    free(text);
    return status;
}

tobi_status tobi_scene_load(const char *path, const char *const *overrides, tobi_scene **scene,
                            tobi_report **report, tobi_error *err)
{
    TOBI_NEED(scene, "where the scene goes");
    *scene = NULL;
    TOBI_NEED(path, "the path");
    return load(path, overrides, 0, scene, report, err);
}

tobi_status tobi_scene_load_foreign(const char *path, tobi_scene **scene, tobi_report **report,
                                    tobi_error *err)
{
    return load(path, NULL, 1, scene, report, err);
}

static void free_fills(tobi_scene_fill *fills, int count)
{
    for (int i = 0; i < count; i++) tobi_script_free(fills[i].flow);
    free(fills);
}

void tobi_scene_free(tobi_scene *scene)
{
    if (!scene) return;
    for (int i = 0; i < scene->fluid_count; i++)
        free_fills(scene->fluids[i].fills, scene->fluids[i].fill_count);
    for (int i = 0; i < scene->solid_count; i++)
        free_fills(scene->solids[i].fills, scene->solids[i].fill_count);
    for (int i = 0; i < scene->body_count; i++) {
        tobi_motion_free(scene->bodies[i].motion);
        tobi_script_free(scene->bodies[i].control);
    }
    tobi_tank_free(&scene->tank);
    free(scene->fluids);
    free(scene->solids);
    free(scene->bodies);
    free(scene->planes);
    free(scene->planes_bound);
    free(scene->interfaces);
    free(scene->lines);
    free(scene->joints);
    free(scene->probes);
    free(scene->probes_bound);
    tobi_openings_clear(scene);
    free(scene->references);
    free(scene->views);
    free(scene->method_def);
    tobi_texts_free(&scene->texts);
    json_decref(scene->stand_ins);
    json_decref(scene->object_files);
    json_decref(scene->root);
    tobi_source_clear(&scene->source);
    free(scene->directory);
    free(scene->import_table);
    free(scene->name);
    free(scene);
}

/* The plain definitions of regions; owned by the caller, NULL without memory. */
static tobi_fill_def *copy_fills(const tobi_scene_fill *fills, int count)
{
    tobi_fill_def *copy = malloc((size_t)count*sizeof *copy + 1);
    for (int i = 0; copy && i < count; i++) copy[i] = fills[i].def;
    return copy;
}

static tobi_status add_fluid(tobi_world *world, const tobi_scene_fluid *fluid, tobi_error *err)
{
    tobi_fill_def *fills = copy_fills(fluid->fills, fluid->fill_count);
    if (!fills) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the scene");
    tobi_status status = tobi_world_add_fluid(world, &fluid->def, fills, fluid->fill_count, err);
    free(fills);
    return status;
}

static tobi_status add_solid(tobi_world *world, const tobi_scene_solid *solid, tobi_error *err)
{
    tobi_fill_def *fills = copy_fills(solid->fills, solid->fill_count);
    if (!fills) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the scene");
    tobi_status status = tobi_world_add_solid(world, &solid->def, fills, solid->fill_count, err);
    free(fills);
    return status;
}

/* A body, and a note if its mesh is not the one that an old scene names; --set may have put that right. */
static tobi_status add_body(const tobi_scene *scene, tobi_world *world, const tobi_body_def *def,
                            tobi_error *err)
{
    const char *named = json_string_value(json_object_get(scene->stand_ins, def->name));
    TOBI_TRY(tobi_world_add_body(world, def, err));
    if (!named || !def->mesh || !strstr(def->mesh, TOBI_STAND_IN)) return TOBI_OK;
    char text[TOBI_NOTE];
    snprintf(text, sizeof text, tr("body '%.150s': there is no mesh %.300s, so the fish that comes with "
             "Tobiuo is taken"), def->name, named);
    return tobi_world_add_note(world, text, err);
}

/* Solids beside the fluids of the scene's method. */
int tobi_scene_has_both(const tobi_scene *scene)
{
    return scene->solid_count > 0 && scene->method && strcmp(scene->method->name, TOBI_METHOD_OF_SOLIDS) != 0;
}

void tobi_scene_place_error(tobi_scene *scene, tobi_error *err)
{
    tobi_place chain[TOBI_PATH_STEPS];
    char text[TOBI_PATH_TEXT];
    tobi_report *report = scene && err && err->key[0] ? tobi_report_create() : NULL;
    if (!report) return;
    scene->source.report = report;
    tobi_source_mistake_at_key(&scene->source, tobi_place_read(err->key, chain, text), "%s", err->text);
    scene->source.report = NULL;
    const char *told = tobi_report_line(report, 0);
    if (told) snprintf(err->text, sizeof err->text, "%s", told);
    err->key[0] = '\0';
    tobi_report_free(report);
}

tobi_status tobi_scene_place_entry(tobi_scene *scene, const char *list, int i, tobi_status status,
                                   tobi_error *err)
{
    static const tobi_place root = { 0 };
    tobi_place all = { &root, list, 0 }, entry = { &all, NULL, (size_t)i };
    char path[TOBI_PATH_TEXT + sizeof err->key];
    if (status == TOBI_OK || !err) return status;
    tobi_place_text(&entry, path);
    const size_t used = strlen(path);
    if (err->key[0]) snprintf(path + used, sizeof path - used, ".%s", err->key);
    snprintf(err->key, sizeof err->key, "%.*s", (int)sizeof err->key - 1, path);
    tobi_scene_place_error(scene, err);
    return status;
}

/* Adds the entries of a list until one is refused. */
#define ADD(list, count, call)                                         \
    for (int i = 0; i < scene->count && status == TOBI_OK; i++)        \
    status = tobi_scene_place_entry(scene, list, i, call, err)

tobi_status tobi_scene_build(tobi_scene *scene, tobi_world **out, tobi_error *err)
{
    tobi_world *world;
    TOBI_NEED(out, "where the world goes");
    *out = NULL;
    TOBI_NEED(scene, "scene");
    TOBI_TRY(tobi_world_create(&scene->world, scene->method_def, &world, err));
    tobi_status status = TOBI_OK;
    if (tobi_scene_has_both(scene)) status = tobi_world_use_solids(world, &scene->solids_def, err);
    ADD("bodies", body_count, add_body(scene, world, &scene->bodies[i].def, err));
    ADD("fluids", fluid_count, add_fluid(world, &scene->fluids[i], err));
    ADD("interfaces", interface_count, tobi_world_add_interface(world, &scene->interfaces[i], err));
    ADD("solids", solid_count, add_solid(world, &scene->solids[i], err));
    ADD("planes", plane_count, tobi_world_add_plane(world, &scene->planes[i], err));
    ADD("inlets", inlet_count, tobi_world_add_inlet(world, &scene->inlets[i], err));
    ADD("outlets", outlet_count, tobi_world_add_outlet(world, &scene->outlets[i], err));
    ADD("lines", line_count, tobi_world_add_line(world, &scene->lines[i], err));
    ADD("joints", joint_count, tobi_world_add_joint(world, &scene->joints[i], err));
    ADD("probes", probe_count, tobi_world_add_probe(world, &scene->probes[i], err));
    ADD("damping_zones", tank.damping_count, tobi_world_add_damping(world, &scene->tank.damping[i], err));
    ADD("porous_zones", tank.porous_count, tobi_world_add_porous(world, &scene->tank.porous[i], err));
    ADD("scalars", tank.scalar_count, tobi_world_add_scalar(world, &scene->tank.scalars[i], err));
    ADD("scalar_values", tank.value_count, tobi_world_add_scalar_value(world, &scene->tank.values[i], err));
    if (status == TOBI_OK) status = tobi_tank_build(&scene->tank, world, err);
    if (status == TOBI_OK) *out = world;
    else tobi_world_destroy(world);
    return status;
}

const char *tobi_scene_name(const tobi_scene *scene) { return scene ? scene->name : NULL; }
const tobi_world_def *tobi_scene_world_def(const tobi_scene *scene) { return scene ? &scene->world : NULL; }
const tobi_output_def *tobi_scene_output_def(const tobi_scene *scene)
{
    return scene ? &scene->output : NULL;
}
const char *tobi_scene_import_table(const tobi_scene *scene) { return scene ? scene->import_table : NULL; }
const char *tobi_scene_import_program(const tobi_scene *scene)
{
    return scene && scene->import_table ? scene->import_program : NULL;
}
