/* The bodies that solids of a scene are clamped to. Drawback: whether a particle is near, the world alone
   sees. */
#include "scene/scene.h"
#include <stdio.h>
#include <string.h>

/* Why a body of the scene cannot hold a solid, NULL if it can. */
static const char *find_reason(const tobi_scene_body *b)
{
    if (b->def.blade) return tr("is a blade, which cuts solids");
    if (b->def.absent_from > 0) return tr("is absent for a time");
    return NULL;
}

static void suggest_body(const tobi_scene *scene, const char *name, tobi_source *source,
                         const tobi_place *key)
{
    enum { NAMES = 64 };
    const char *names[NAMES];
    size_t count = 0;
    for (int k = 0; k < scene->body_count && count < NAMES; k++)
        if (scene->bodies[k].def.name) names[count++] = scene->bodies[k].def.name;
    const char *near = tobi_suggest(name, names, count);
    tobi_source_mistake(source, key, "\"%s\" is no body of the scene%s%s%s", name,
                        near ? tr("; did you mean \"") : "", near ? near : "", near ? "\"?" : "");
}

static void check_name(const tobi_scene *scene, const char *name, tobi_source *source, const tobi_place *key)
{
    for (int k = 0; k < scene->body_count; k++) {
        const tobi_scene_body *b = &scene->bodies[k];
        if (!b->def.name || strcmp(b->def.name, name) != 0) continue;
        const char *reason = find_reason(b);
        if (reason)
            tobi_source_mistake(source, key, "\"%s\" %s; such a body holds no solid", name, reason);
        return;
    }
    suggest_body(scene, name, source, key);
}

/* Whether a name stands in a list of names, with commas between, before `end`. */
static int is_before(const char *names, const char *end, const char *name)
{
    const size_t length = strlen(name);
    for (const char *at = names; at < end; at += strcspn(at, ",") + 1)
        if (strcspn(at, ",") == length && memcmp(at, name, length) == 0) return 1;
    return 0;
}

static void check_names(const tobi_scene *scene, const char *names, tobi_source *source,
                        const tobi_place *key)
{
    enum { MOST = 128 };
    char name[MOST];
    size_t length;
    tobi_place entry = { key, NULL, 0 };
    for (const char *at = names;; at += length + 1, entry.index++) {
        length = strcspn(at, ",");
        const int alone = at == names && !at[length];
        const tobi_place *place = alone ? key : &entry;
        snprintf(name, sizeof name, "%.*s", (int)length, at);
        if (is_before(names, at, name))
            tobi_source_mistake(source, place, "\"%s\" is named twice", name);
        else check_name(scene, name, source, place);
        if (!at[length]) return;
    }
}

void tobi_clamps_check(const tobi_scene *scene, tobi_source *source)
{
    tobi_place root = { 0 }, list = { &root, "solids", 0 };
    for (int i = 0; i < scene->solid_count; i++) {
        tobi_place entry = { &list, NULL, (size_t)i }, key = { &entry, "clamped_to", 0 };
        const char *names = scene->solids[i].def.clamped_to;
        if (names) check_names(scene, names, source, &key);
    }
}
