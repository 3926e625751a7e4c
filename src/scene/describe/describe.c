/* Help texts, made from the parameter tables alone. */
#define _GNU_SOURCE 1
#include "scene/bind.h"
#include "scene/controls.h"
#include "scene/describe/describe.h"
#include "scene/describe/manual.h"
#include "scene/motions.h"
#include "scene/parts.h"
#include "base/param.h"
#include "tobiuo/scene.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void tobi_describe_row(FILE *out, const tobi_param *row)
{
    char limits[TOBI_NOTE], def[200], room[TOBI_MEANING];
    tobi_bind_say_limits(row, limits, sizeof limits);
    tobi_bind_default(row, def, sizeof def);
    fprintf(out, "  %s\n      %s\n      ", row->key, tobi_meaning(row->doc, room));
    if (row->type == TOBI_PARAM_TEXT) fprintf(out, "%s; ", row->unit);
    else if (row->type == TOBI_PARAM_CHOICE || row->type == TOBI_PARAM_BOOL)
        fprintf(out, "%s; ", limits);
    else fprintf(out, tr("%s, unit %s; allowed: %s; "), tr(tobi_manual_type(row)), row->unit, limits);
    if (row->required) fprintf(out, "%s\n", tr("required"));
    else fprintf(out, tr("default: %s\n"), def);
}

/* A key whose value has keys of its own; the topic that tells them is named. */
void tobi_describe_part(FILE *out, const tobi_part *part)
{
    const char *topic = part->form == TOBI_PART_MOTION ? "motion" : part->table ? part->table->name : NULL;
    const char *kind = part->form == TOBI_PART_LIST ? tr("list of objects") :
                       part->form == TOBI_PART_EDITOR ? tr("text") : tr("object");
    char room[TOBI_MEANING];
    fprintf(out, "  %s\n      %s\n      %s", part->key, tobi_meaning(part->doc, room), kind);
    if (topic) fprintf(out, ": tobiuo describe %s", topic);
    fprintf(out, "%s\n", part->least > 0 ? tr("; required") : "");
}

static void describe_table(FILE *out, const tobi_param_table *table)
{
    tobi_part part;
    char room[TOBI_MEANING];
    fprintf(out, "%s: %s\n", table->name, tobi_meaning(table->doc, room));
    for (const tobi_param *row = table->rows; row->key; row++) tobi_describe_row(out, row);
    for (int i = 0; tobi_part_at(i, &part); i++)
        if (strcmp(part.owner, table->name) == 0) tobi_describe_part(out, &part);
}

/* The tables that are topics: those of the world, then those of the scripts that belong to scenes. */
static const tobi_param_table *table_at(int index)
{
    int worlds = 0;
    while (tobi_param_table_at(worlds)) worlds++;
    const tobi_param_table *scripts[] = { &tobi_flow_table, &tobi_control_table };
    if (index < worlds) return tobi_param_table_at(index);
    return index - worlds < 2 ? scripts[index - worlds] : NULL;
}

const tobi_param_table *tobi_describe_table_at(int index)
{
    int topics = 0;
    while (table_at(topics)) topics++;
    return index < topics ? table_at(index) : tobi_motion_table(index - topics);
}

/* Topics that are no single table of keys. */
static const struct { const char *name, *doc; } more[] = {
    { "motion", TR("The motion of a body: a script, or one by numbers.") },
    { "scene", TR("The whole page: every key of a scene, in Markdown.") },
    { "schema", TR("The JSON Schema of scenes, for editors.") },
};
enum { MORE = sizeof more/sizeof *more };

/* Topics by number with their sentence: tables of keys, the others, tables of results. */
static const char *topic_at(int index, const char **doc)
{
    const tobi_param_table *table;
    int count = 0;
    while ((table = table_at(count))) {
        if (count++ != index) continue;
        *doc = table->doc;
        return table->name;
    }
    index -= count;
    if (index >= MORE) return tobi_tables_topic(index - MORE, doc);
    *doc = more[index].doc;
    return more[index].name;
}

const char *tobi_describe_topic(int index)
{
    const char *doc;
    return topic_at(index, &doc);
}

static void list_topics(FILE *out)
{
    const char *name, *doc;
    char room[TOBI_MEANING];
    fprintf(out, "%s\n", tr("Topics:"));
    for (int i = 0; (name = topic_at(i, &doc)); i++)
        fprintf(out, "  %-9s %s\n", name, tobi_meaning(doc, room));
    fprintf(out, "%s\n", tr("Any key, field or column works as well, or a word of a sentence: tobiuo "
                            "describe shear"));
}

static const tobi_param_table *find_table(const char *topic)
{
    const tobi_param_table *table;
    for (int i = 0; (table = table_at(i)); i++)
        if (strcmp(table->name, topic) == 0) return table;
    return NULL;
}

/* Returns 0 if there is no such topic and no such key. */
static int write_topic(FILE *out, const char *topic)
{
    const tobi_param_table *table = find_table(topic);
    if (table) return describe_table(out, table), 1;
    if (strcmp(topic, "motion") != 0)
        return tobi_tables_describe(out, topic) || tobi_describe_find(out, topic);
    for (int i = 0; (table = tobi_motion_table(i)); i++) describe_table(out, table);
    return 1;
}

char *tobi_scene_describe(const char *topic)
{
    if (topic && strcmp(topic, "scene") == 0) return tobi_scene_manual();
    if (topic && strcmp(topic, "schema") == 0) return tobi_scene_schema();
    if (topic && strcmp(topic, "tables") == 0) return tobi_tables_manual();
    char *text = NULL;
    size_t size = 0;
    int found = 1;
    FILE *out = open_memstream(&text, &size);
    if (!out) return NULL;
    if (topic) found = write_topic(out, topic);
    else list_topics(out);
    fclose(out);
    if (found) return text;
    free(text);
    return NULL;
}
