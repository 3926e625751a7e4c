/* Data that a scene names for comparison. The engine never opens it; `tobiuo plot` does. */
#define _GNU_SOURCE 1
#include "scene/scene.h"
#include "tobiuo/run.h"
#include "tobiuo/scene.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* "; did you mean "a"?", or nothing. */
static void suggest(const char *word, const char *const *names, int count, char text[TOBI_NOTE])
{
    const char *near = tobi_suggest(word, names, (size_t)count);
    text[0] = '\0';
    if (near) snprintf(text, TOBI_NOTE, tr("; did you mean \"%s\"?"), near);
}

static void check_column(tobi_source *source, const tobi_place *entry, tobi_table table,
                         const char *column)
{
    static const char *const where[] = {
        [TOBI_TABLE_HISTORY] = TR("history.csv (one of bodies.csv or probes.csv needs body or probe)"),
        [TOBI_TABLE_BODIES] = "bodies.csv", [TOBI_TABLE_POINT] = TR("a point of probes.csv"),
        [TOBI_TABLE_LEVEL] = TR("a level of probes.csv"), [TOBI_TABLE_PATCH] = TR("a patch of probes.csv"),
        [TOBI_TABLE_RUN_UP] = TR("a run-up of probes.csv"), [TOBI_TABLE_FLOW] = TR("a flow of probes.csv"),
        [TOBI_TABLE_VOLUME] = TR("a volume of probes.csv"), [TOBI_TABLE_SOLIDS] = "solids.csv" };
    enum { COLUMNS = 128 };
    const char *names[COLUMNS];
    char near[TOBI_NOTE];
    int count = 0;
    const tobi_column *c;
    tobi_place place = { entry, "column", 0 };
    for (; count < COLUMNS && (c = tobi_run_column(table, count)); count++)
        if (strcmp(names[count] = c->name, column) == 0) return;
    suggest(column, names, count, near);
    tobi_source_mistake(source, &place, "there is no column \"%s\" in %s%s", column, tr(where[table]),
                        near);
}

/* Finds `name` among the names of bodies or probes; -1 after reporting that it is not there. */
static int find_owner(const tobi_scene *scene, tobi_source *source, const tobi_place *entry,
                      const char *key, const char *name)
{
    enum { NAMES = 64 };
    const char *names[NAMES], *own;
    char near[TOBI_NOTE];
    tobi_place place = { entry, key, 0 };
    int bodies = strcmp(key, "body") == 0, count = bodies ? scene->body_count : scene->probe_count;
    for (int i = 0; i < count; i++) {
        own = bodies ? scene->bodies[i].def.name : scene->probes[i].name;
        if (strcmp(own, name) == 0) return i;
        if (i < NAMES) names[i] = own;
    }
    suggest(name, names, count < NAMES ? count : NAMES, near);
    tobi_source_mistake(source, &place, "there is no %s \"%s\"%s", key, name, near);
    return -1;
}

/* A column as probes.csv has it, such as "G1_level": 1 after telling its two keys. */
static int check_prefix(const tobi_scene *scene, tobi_source *source, const tobi_place *entry,
                        const char *column)
{
    tobi_place place = { entry, "column", 0 };
    const tobi_column *c;
    for (int i = 0; i < scene->probe_count; i++) {
        const char *name = scene->probes[i].name;
        const size_t length = name ? strlen(name) : 0;
        if (length == 0 || strncmp(column, name, length) != 0 || column[length] != '_') continue;
        const tobi_table table = (tobi_table)(TOBI_TABLE_POINT + scene->probes[i].kind);
        for (int k = 0; (c = tobi_run_column(table, k)); k++) {
            if (strcmp(column + length + 1, c->name) != 0) continue;
            tobi_source_mistake(source, &place, "\"%s\" is of a probe: write \"probe\": \"%s\", "
                                "\"column\": \"%s\"", column, name, c->name);
            return 1;
        }
    }
    return 0;
}

static void check_owner(const tobi_scene *scene, tobi_source *source, const tobi_place *entry,
                        const tobi_reference_def *def)
{
    tobi_table table = def->body ? TOBI_TABLE_BODIES : TOBI_TABLE_HISTORY;
    if (def->body && def->probe)
        tobi_source_mistake(source, entry, "has a body and a probe, must have at most one of them");
    if (def->body) find_owner(scene, source, entry, "body", def->body);
    if (def->probe) {
        int probe = find_owner(scene, source, entry, "probe", def->probe);
        if (probe < 0) return;
        table = (tobi_table)(TOBI_TABLE_POINT + scene->probes[probe].kind);
    }
    if (def->column && table == TOBI_TABLE_HISTORY && check_prefix(scene, source, entry, def->column)) return;
    if (def->column) check_column(source, entry, table, def->column);
}

void tobi_references_check(const tobi_scene *scene, tobi_source *source)
{
    tobi_place root = { 0 }, list = { &root, "references", 0 };
    for (int i = 0; i < scene->reference_count; i++) {
        const tobi_reference_def *def = &scene->references[i];
        tobi_place entry = { &list, NULL, (size_t)i }, file = { &entry, "file", 0 };
        check_owner(scene, source, &entry, def);
        tobi_check_file(source, &file, def->file);
    }
}

const tobi_reference_def *tobi_scene_reference(const tobi_scene *scene, int index)
{
    return scene && index >= 0 && index < scene->reference_count ? &scene->references[index] : NULL;
}
