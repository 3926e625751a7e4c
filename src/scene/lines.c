/* The lines of a scene. Drawback: what depends on where bodies start, the world alone sees. */
#include "scene/scene.h"
#include "scene/parts.h"
#include "scene/write.h"
#include "base/param.h"
#include <stdlib.h>
#include <string.h>

tobi_status tobi_lines_bind(tobi_scene *scene, const tobi_binder *binder, const tobi_place *of)
{
    tobi_place place = { of, "lines", 0 };
    json_t *list = tobi_scene_list(binder, scene->root, &place, "world");
    if (!list) return TOBI_OK;
    scene->lines = calloc(json_array_size(list) + 1, sizeof *scene->lines);
    if (!scene->lines) return TOBI_NO_MEMORY;
    for (size_t i = 0; i < json_array_size(list); i++) {
        tobi_place entry = { &place, NULL, i };
        tobi_line_def *line = &scene->lines[scene->line_count++];
        *line = tobi_default_line_def();
        tobi_bind(binder, &tobi_line_table, json_array_get(list, i), &entry, NULL, line);
    }
    return TOBI_OK;
}

static void check_ends(const tobi_scene *scene, tobi_source *source, const tobi_line_def *line,
                       const tobi_place *entry)
{
    tobi_place body = { entry, "body", 0 }, to_body = { entry, "to_body", 0 };
    const tobi_body_def *held = line->body ? tobi_scene_find_body(scene, line->body) : NULL;
    if (line->body && !held)
        tobi_source_mistake(source, &body, "\"%s\" is no body of the scene", line->body);
    if (held && held->dynamics == TOBI_PRESCRIBED)
        tobi_source_mistake(source, &body, "\"%s\" is prescribed; a line holds a free or controlled body, "
                            "and may go to a prescribed one", line->body);
    if (!line->to_body) return;
    if (!tobi_scene_find_body(scene, line->to_body))
        tobi_source_mistake(source, &to_body, "\"%s\" is no body of the scene", line->to_body);
    else if (line->body && strcmp(line->body, line->to_body) == 0)
        tobi_source_mistake(source, &to_body, "is the body at the other end too");
}

static void check_keys(tobi_source *source, const tobi_line_def *line, const tobi_place *entry)
{
    tobi_place weight = { entry, "weight", 0 }, damping = { entry, "damping", 0 };
    tobi_place rests = { entry, "rests", 0 };
    const int hangs = line->kind == TOBI_LINE_CATENARY;
    if (hangs && !(line->weight > 0))
        tobi_source_mistake(source, &weight, "is 0 N/m, a catenary has a weight");
    if (hangs && line->damping > 0) tobi_source_mistake(source, &damping, "is of springs and ropes");
    if (!hangs && line->weight > 0) tobi_source_mistake(source, &weight, "is of a catenary");
    if (!hangs && line->rests) tobi_source_mistake(source, &rests, "is of a catenary");
}

void tobi_lines_check(const tobi_scene *scene, tobi_source *source)
{
    static const tobi_place root = { 0 };
    tobi_place lines = { &root, "lines", 0 };
    for (int i = 0; i < scene->line_count && !tobi_report_full(source->report); i++) {
        const tobi_line_def *line = &scene->lines[i];
        tobi_place entry = { &lines, NULL, (size_t)i };
        tobi_check_name(scene, source, &entry);
        check_ends(scene, source, line, &entry);
        check_keys(source, line, &entry);
    }
}

json_t *tobi_lines_write_json(const tobi_scene *scene)
{
    json_t *list = json_array();
    int failed = 0;
    for (int k = 0; k < scene->line_count; k++)
        failed |= json_array_append_new(list, tobi_write_def(&tobi_line_table, &scene->lines[k]));
    if (!failed) return list;
    json_decref(list);
    return NULL;
}
