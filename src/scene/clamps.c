/* The bodies that solids of a scene are clamped to. Drawback: whether a particle is near, the world alone
   sees. */
#include "scene/scene.h"
#include <string.h>

/* Why a body of the scene cannot hold a solid, NULL if it can. */
static const char *find_reason(const tobi_scene_body *b)
{
    if (b->def.blade) return "is a blade, which cuts solids";
    if (b->motion && !b->def.motion_rigid) return "changes its shape";
    if (b->def.absent_from > 0) return "is absent for a time";
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
                        near ? "; did you mean \"" : "", near ? near : "", near ? "\"?" : "");
}

void tobi_clamps_check(const tobi_scene *scene, tobi_source *source)
{
    tobi_place root = { 0 }, list = { &root, "solids", 0 };
    for (int i = 0; i < scene->solid_count; i++) {
        tobi_place entry = { &list, NULL, (size_t)i }, key = { &entry, "clamped_to", 0 };
        const char *name = scene->solids[i].def.clamped_to, *reason = NULL;
        int found = 0;
        for (int k = 0; name && k < scene->body_count; k++) {
            const tobi_scene_body *b = &scene->bodies[k];
            if (!b->def.name || strcmp(b->def.name, name) != 0) continue;
            found = 1;
            reason = find_reason(b);
        }
        if (name && !found) suggest_body(scene, name, source, &key);
        if (reason)
            tobi_source_mistake(source, &key, "\"%s\" %s; a rigid body holds a solid", name, reason);
    }
}
