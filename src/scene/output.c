/* The output of a scene: its table, and the list of further views. Drawback: a view takes nothing over from
   the output's own. */
#define _GNU_SOURCE 1
#include "scene/scene.h"
#include "scene/parts.h"
#include "scene/write.h"
#include "base/param.h"
#include "tobiuo/picture.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const tobi_place root = { 0 };

tobi_status tobi_output_bind(tobi_scene *scene, const tobi_binder *binder, const tobi_place *of)
{
    const char *also[TOBI_PARTS];
    tobi_part_keys("output", also);
    tobi_place place = { of, "output", 0 }, views = { &place, "views", 0 };
    json_t *value = json_object_get(scene->root, "output");
    scene->output = tobi_default_output_def();
    if (!value) return TOBI_OK;
    tobi_bind(binder, &tobi_output_table, value, &place, also, &scene->output);
    json_t *list = tobi_scene_list(binder, value, &views, "output");
    if (!list) return TOBI_OK;
    scene->views = calloc(json_array_size(list) + 1, sizeof *scene->views);
    if (!scene->views) return TOBI_NO_MEMORY;
    for (size_t i = 0; i < json_array_size(list); i++) {
        tobi_place entry = { &views, NULL, i };
        tobi_view_def *view = &scene->views[scene->output.view_count++];
        tobi_param_defaults(&tobi_view_table, view);
        tobi_bind(binder, &tobi_view_table, json_array_get(list, i), &entry, NULL, view);
    }
    scene->output.views = scene->views;
    return TOBI_OK;
}

json_t *tobi_output_write(const tobi_scene *scene)
{
    json_t *output = tobi_write_def(&tobi_output_table, &scene->output), *views = json_array();
    int failed = 0;
    for (int k = 0; k < scene->output.view_count; k++)
        failed |= json_array_append_new(views, tobi_write_def(&tobi_view_table, &scene->views[k]));
    if (scene->output.view_count) failed |= json_object_set(output, "views", views);
    json_decref(views);
    if (!failed) return output;
    json_decref(output);
    return NULL;
}

/* The scene has it, or it is no scalar. */
static int knows(const tobi_scene_tank *tank, const char *field)
{
    static const char *const scalar[] = { "temperature", "concentration" };
    int count = 0, scalars = 0;
    for (int k = 0; k < TOBI_SCALAR_LIMIT; k++) scalars |= strcmp(field, scalar[k]) == 0;
    for (int k = 0; k < tank->scalar_count; k++) count += strcmp(field, scalar[tank->scalars[k].field]) == 0;
    return count > 0 || !scalars;
}

/* Appends the fields of a method that are not there yet. */
static int list_fields(const tobi_scene *scene, const char *method, const char **names, int count, int most)
{
    const char *name;
    for (int k = 0; count < most && (name = tobi_method_field(method, k)); k++) {
        int there = !knows(&scene->tank, name);
        for (int n = 0; n < count; n++) there |= strcmp(names[n], name) == 0;
        if (!there) names[count++] = name;
    }
    return count;
}

static void check_field(const tobi_scene *scene, tobi_source *source, const tobi_place *place,
                        const char *field)
{
    enum { FIELDS = 32 };
    const char *names[FIELDS];
    int count = list_fields(scene, scene->world.method, names, 0, FIELDS);
    if (scene->solid_count > 0) count = list_fields(scene, "mlsmpm", names, count, FIELDS);
    char all[512] = "";
    if (strcmp(field, "usual") == 0) return;
    if (!knows(&scene->tank, field)) {
        tobi_source_mistake(source, place, "is \"%s\", and the scene has none; scalars are to have it",
                            field);
        return;
    }
    for (int k = 0; k < count; k++)
        if (strcmp(names[k], field) == 0) return;
    if (tobi_report_pass(source->report)) return;
    for (int k = 0; k < count; k++) {
        size_t used = strlen(all);
        snprintf(all + used, sizeof all - used, "%s%s", used ? ", " : "", names[k]);
    }
    const char *near = strcmp(field, "speed") == 0 ? "velocity" : tobi_suggest(field, names, (size_t)count);
    if (near)
        tobi_source_mistake(source, place, "there is no field \"%s\"; did you mean \"%s\"?", field,
                            near);
    else tobi_source_mistake(source, place, "there is no field \"%s\"; allowed are %s", field, all);
}

/* parts: components of fields are names too. */
static void check_names(const tobi_scene *scene, tobi_source *source, const tobi_place *place,
                        const char *names, int parts)
{
    char *copy = strdup(names ? names : ""), *next = copy;
    for (char *field; copy && (field = strsep(&next, ",")) != NULL;) {
        int component = -1;
        const char *whole = parts ? tobi_world_find_field(field, &component, NULL) : NULL;
        if (*field) check_field(scene, source, place, component < 0 ? field : whole);
    }
    free(copy);
}

/* Whether anything could show the field. */
static void check_field_of(const tobi_scene *scene, tobi_source *source, const tobi_place *place,
                           int field_of)
{
    const int liquids = field_of == TOBI_FIELD_OF_LIQUIDS;
    int count = liquids ? scene->fluid_count : 0;
    for (int k = 0; k < scene->solid_count; k++)
        count += (scene->solids[k].def.model == TOBI_LIQUID) == liquids;
    if (field_of != TOBI_FIELD_OF_ALL && count == 0)
        tobi_source_mistake(source, place, "is \"%s\", but the scene has none",
                            liquids ? "liquids" : "solids");
}

/* Where a camera would stand, in views that fit the domain. The place 0 0 0 says nothing. */
static void check_camera(tobi_source *source, const tobi_view_def *view, const tobi_place *camera)
{
    static const double nowhere[3] = { 0 };
    tobi_place position = { camera, "position", 0 }, target = { camera, "look_at", 0 };
    const tobi_place *unread = memcmp(view->position, nowhere, sizeof nowhere) != 0 ? &position
                             : memcmp(view->look_at, nowhere, sizeof nowhere) != 0 ? &target : NULL;
    if (view->angle > 0 || !unread) return;
    tobi_source_mistake_at_key(source, unread, "is for a camera.angle; without one the view fits the domain");
}

/* Of the clip plane and the ends of the colours: what would not be used. */
static void check_picture(const tobi_scene *scene, tobi_source *source, const tobi_view_def *view,
                          const tobi_place *picture)
{
    static const double nowhere[3] = { 0 };
    const double *n = view->clip_normal;
    tobi_place normal = { picture, "clip_normal", 0 }, point = { picture, "clip_point", 0 };
    tobi_place slice = { picture, "slice", 0 }, min = { picture, "min", 0 }, max = { picture, "max", 0 };
    const tobi_place *unread = view->slice > 0 ? &slice
                             : memcmp(view->clip_point, nowhere, sizeof nowhere) != 0 ? &point : NULL;
    if (unread && n[0] == 0 && n[1] == 0 && n[2] == 0)
        tobi_source_mistake_at_key(source, unread,
                                   "is for a picture.clip_normal; without one nothing is cut off");
    if (scene->world.dimension == 2 && n[2] != 0 && n[0] == 0 && n[1] == 0)
        tobi_source_mistake(source, &normal,
                            "points out of the plane of the 2-D scene: nothing would be cut off");
    if (view->max <= view->min && (view->min != 0 || view->max != 0))
        tobi_source_mistake(source, view->min != 0 ? &min : &max,
                            "picture.min %g is not below picture.max %g; without both each picture has the "
                            "range of its own values", view->min, view->max);
}

/* place: of the object that has camera and picture. */
static void check_view(const tobi_scene *scene, tobi_source *source, const tobi_view_def *view,
                       const tobi_place *place)
{
    tobi_place picture = { place, "picture", 0 }, follow = { &picture, "follow", 0 };
    tobi_place field = { &picture, "field", 0 }, field_of = { &picture, "field_of", 0 };
    tobi_place camera = { place, "camera", 0 }, angle = { &camera, "angle", 0 };
    if (view->angle > 0 && scene->world.dimension == 3 &&
        memcmp(view->position, view->look_at, sizeof view->look_at) == 0)
        tobi_source_mistake(source, &angle, "needs a camera.position that is not camera.look_at");
    check_camera(source, view, &camera);
    check_picture(scene, source, view, &picture);
    if (view->field) check_names(scene, source, &field, view->field, 1);
    check_field_of(scene, source, &field_of, view->field_of);
    if (view->follow && !tobi_scene_find_body(scene, view->follow))
        tobi_source_mistake(source, &follow, "\"%s\" is no body of the scene", view->follow);
}

static void check_views(const tobi_scene *scene, tobi_source *source, const tobi_place *output)
{
    check_view(scene, source, &scene->output.view, output);
    for (int k = 0; k < scene->output.view_count; k++) {
        tobi_place views = { output, "views", 0 }, entry = { &views, NULL, (size_t)k };
        tobi_place name = { &entry, "name", 0 };
        const tobi_view_def *view = &scene->views[k];
        check_view(scene, source, view, &entry);
        if (!view->name) continue;
        if (strcmp(view->name, "frame") == 0)
            tobi_source_mistake(source, &name, "is \"frame\", the name of the output's own pictures");
        for (int j = 0; j < k; j++)
            if (scene->views[j].name && strcmp(scene->views[j].name, view->name) == 0)
                tobi_source_mistake(source, &name, "\"%s\" is the name of views[%d] too", view->name, j);
    }
}

void tobi_output_check(const tobi_scene *scene, tobi_source *source)
{
    enum { MOST_OUTPUTS = 1000000 };
    tobi_place output = { &root, "output", 0 }, interval = { &output, "interval", 0 };
    tobi_place fields = { &output, "fields", 0 };
    if (scene->world.end_time/scene->output.interval > MOST_OUTPUTS)
        tobi_source_mistake(source, &interval,
                            "is %.10g s and makes more than %d outputs until end_time, %.10g s",
                            scene->output.interval, MOST_OUTPUTS, scene->world.end_time);
    tobi_method_info method;
    tobi_place grid = { &output, "grid", 0 };
    if (scene->output.grid && tobi_method_describe(scene->world.method, &method) && !method.grid)
        tobi_source_mistake(source, &grid, "%s has no grid; mlsmpm has one", method.name);
    tobi_place surface = { &output, "surface", 0 }, of_surface = { &surface, "fields", 0 };
    if (scene->output.surface && scene->world.dimension == 2)
        tobi_source_mistake(source, &surface, "is of 3-D scenes only");
    tobi_place tractions = { &output, "tractions", 0 };
    if (scene->output.tractions && tobi_method_describe(scene->world.method, &method) && method.solids)
        tobi_source_mistake(source, &tractions, "%s has no fluid that presses on bodies", method.name);
    check_views(scene, source, &output);
    check_names(scene, source, &fields, scene->output.fields, 0);
    check_names(scene, source, &of_surface, scene->output.surface_fields, 1);
}
