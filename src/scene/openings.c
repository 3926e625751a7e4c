/* The lists "inlets" and "outlets" of a scene, by their tables. Drawback: what needs the domain or bodies is
   checked where the world takes them, one mistake at a time. */
#include "scene/openings.h"
#include "scene/parts.h"
#include "scene/write.h"
#include "base/param.h"
#include <stdlib.h>

/* One of the two lists, its entries by their table. */
typedef struct opening_list {
    const char *key;
    const tobi_param_table *table;
    int limit;
} opening_list;

static const opening_list inlets = { "inlets", &tobi_inlet_table, TOBI_INLET_LIMIT };
static const opening_list outlets = { "outlets", &tobi_outlet_table, TOBI_OUTLET_LIMIT };

static tobi_status read_list(const tobi_scene *scene, const tobi_binder *binder, const opening_list *l,
                             const tobi_place *at, void **defs, int *count)
{
    tobi_place place = { at, l->key, 0 };
    json_t *list = json_object_get(scene->root, l->key);
    if (!list) return TOBI_OK;
    if (!json_is_array(list)) {
        tobi_source_mistake(binder->source, &place, "is %s, must be a list [ { ... } ]",
                            tobi_json_kind(list));
        return TOBI_OK;
    }
    if (json_array_size(list) > (size_t)l->limit) {
        tobi_source_mistake(binder->source, &place, "has %zu entries, allowed are %d", json_array_size(list),
                            l->limit);
        return TOBI_OK;
    }
    char *out = calloc(json_array_size(list) + 1, l->table->size);
    if (!out) return TOBI_NO_MEMORY;
    for (size_t i = 0; i < json_array_size(list); i++) {
        tobi_place entry = { &place, NULL, i };
        void *def = out + i*l->table->size;
        tobi_param_defaults(l->table, def);
        tobi_bind(binder, l->table, json_array_get(list, i), &entry, NULL, def);
        tobi_check_name(scene, binder->source, &entry);
        tobi_place file = { &entry, "file", 0 };
        if (l == &inlets) tobi_check_file(binder->source, &file, ((const tobi_inlet_def *)def)->file);
        *count = (int)i + 1;
    }
    *defs = out;
    return TOBI_OK;
}

tobi_status tobi_openings_read(tobi_scene *scene, const tobi_binder *binder, const tobi_place *root)
{
    void *defs = NULL;
    TOBI_TRY(read_list(scene, binder, &inlets, root, &defs, &scene->inlet_count));
    scene->inlets = defs;
    defs = NULL;
    TOBI_TRY(read_list(scene, binder, &outlets, root, &defs, &scene->outlet_count));
    scene->outlets = defs;
    return TOBI_OK;
}

int tobi_openings_write(const tobi_scene *scene, json_t *root)
{
    json_t *in = json_array(), *out = json_array();
    int failed = 0;
    for (int i = 0; i < scene->inlet_count; i++)
        failed |= json_array_append_new(in, tobi_write_def(&tobi_inlet_table, &scene->inlets[i]));
    for (int i = 0; i < scene->outlet_count; i++)
        failed |= json_array_append_new(out, tobi_write_def(&tobi_outlet_table, &scene->outlets[i]));
    if (scene->inlet_count) failed |= json_object_set(root, "inlets", in);
    if (scene->outlet_count) failed |= json_object_set(root, "outlets", out);
    json_decref(in);
    json_decref(out);
    return failed;
}

void tobi_openings_clear(tobi_scene *scene)
{
    free(scene->inlets);
    free(scene->outlets);
}
