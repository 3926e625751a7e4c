/* The interfaces of a scene, between two of its fluids. Drawback: a pair without an entry has no tension, and
   nothing says so. */
#include "scene/scene.h"
#include "scene/parts.h"
#include "scene/write.h"
#include "base/param.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

tobi_status tobi_interfaces_bind(tobi_scene *scene, const tobi_binder *binder, const tobi_place *of)
{
    tobi_place place = { of, "interfaces", 0 };
    json_t *list = tobi_scene_list(binder, scene->root, &place, "world");
    if (!list) return TOBI_OK;
    scene->interfaces = calloc(json_array_size(list) + 1, sizeof *scene->interfaces);
    if (!scene->interfaces) return TOBI_NO_MEMORY;
    for (size_t i = 0; i < json_array_size(list); i++) {
        tobi_place entry = { &place, NULL, i };
        tobi_interface_def *def = &scene->interfaces[scene->interface_count++];
        *def = tobi_default_interface_def();
        tobi_bind(binder, &tobi_interface_table, json_array_get(list, i), &entry, NULL, def);
    }
    return TOBI_OK;
}

static int is_fluid(const tobi_scene *scene, const char *name)
{
    for (int k = 0; k < scene->fluid_count; k++)
        if (scene->fluids[k].def.name && strcmp(scene->fluids[k].def.name, name) == 0) return 1;
    return 0;
}

/* What is allowed, as far as it fits. */
static void tell_fluids(const tobi_scene *scene, tobi_source *source, const tobi_place *place,
                        const char *name)
{
    char names[200] = "";
    for (int k = 0; k < scene->fluid_count; k++) {
        const size_t used = strlen(names);
        const char *one = scene->fluids[k].def.name;
        if (one) snprintf(names + used, sizeof names - used, "%s\"%s\"", used ? ", " : "", one);
    }
    tobi_source_mistake(source, place, "\"%s\" is no fluid of the scene; its fluids are %s", name, names);
}

static int joins(const tobi_interface_def *a, const char *fluid, const char *to)
{
    return a->fluid && a->to_fluid && strcmp(a->fluid, fluid) == 0 && strcmp(a->to_fluid, to) == 0;
}

void tobi_interfaces_check(const tobi_scene *scene, tobi_source *source)
{
    static const tobi_place root = { 0 };
    tobi_place list = { &root, "interfaces", 0 };
    for (int i = 0; i < scene->interface_count && !tobi_report_full(source->report); i++) {
        const tobi_interface_def *def = &scene->interfaces[i];
        tobi_place entry = { &list, NULL, (size_t)i }, one = { &entry, "fluid", 0 },
                   other = { &entry, "to_fluid", 0 };
        if (!def->fluid || !def->to_fluid) continue;             /* said already */
        if (!is_fluid(scene, def->fluid))
            tell_fluids(scene, source, &one, def->fluid);
        if (!is_fluid(scene, def->to_fluid))
            tell_fluids(scene, source, &other, def->to_fluid);
        else if (strcmp(def->fluid, def->to_fluid) == 0)
            tobi_source_mistake(source, &other, "is the fluid on the other side too");
        for (int k = 0; k < i; k++) {
            const tobi_interface_def *before = &scene->interfaces[k];
            if (joins(before, def->fluid, def->to_fluid) || joins(before, def->to_fluid, def->fluid))
                tobi_source_mistake(source, &entry, "is between the same fluids as interfaces[%d]", k);
        }
    }
}

int tobi_interfaces_write(const tobi_scene *scene, json_t *root)
{
    json_t *list = json_array();
    int failed = !list;
    for (int k = 0; k < scene->interface_count; k++)
        failed |= json_array_append_new(list, tobi_write_def(&tobi_interface_table, &scene->interfaces[k]));
    if (scene->interface_count) failed |= json_object_set(root, "interfaces", list);
    json_decref(list);
    return failed;
}
