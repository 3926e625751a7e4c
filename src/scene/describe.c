/* Help texts, made from the parameter tables alone. */
#define _GNU_SOURCE 1
#include "scene/bind.h"
#include "scene/controls.h"
#include "scene/manual.h"
#include "scene/motions.h"
#include "scene/parts.h"
#include "world/params.h"
#include "tobiuo/scene.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void describe_row(FILE *out, const tobi_param *row)
{
    char limits[200], def[200];
    tobi_bind_limits(row, limits, sizeof limits);
    tobi_bind_default(row, def, sizeof def);
    fprintf(out, "  %s\n      %s\n      ", row->key, row->doc);
    if (row->type == TOBI_PARAM_TEXT) fprintf(out, "%s; ", row->unit);
    else if (row->type == TOBI_PARAM_CHOICE || row->type == TOBI_PARAM_BOOL)
        fprintf(out, "%s; ", limits);
    else fprintf(out, "%s, unit %s; allowed: %s; ", tobi_manual_type(row), row->unit, limits);
    fprintf(out, row->required ? "%s\n" : "default: %s\n", def);
}

/* A key whose value has keys of its own; the topic that tells them is named. */
static void describe_part(FILE *out, const tobi_part *part)
{
    const char *topic = part->form == TOBI_PART_MOTION ? "motion" : part->table ? part->table->name : NULL;
    const char *kind = part->form == TOBI_PART_LIST ? "list of objects" :
                       part->form == TOBI_PART_EDITOR ? "text" : "object";
    fprintf(out, "  %s\n      %s\n      %s", part->key, part->doc, kind);
    if (topic) fprintf(out, ": tobiuo describe %s", topic);
    fprintf(out, part->least > 0 ? "; required\n" : "\n");
}

static void describe_table(FILE *out, const tobi_param_table *table)
{
    tobi_part part;
    fprintf(out, "%s: %s\n", table->name, table->doc);
    for (const tobi_param *row = table->rows; row->key; row++) describe_row(out, row);
    for (int i = 0; tobi_part_at(i, &part); i++)
        if (strcmp(part.owner, table->name) == 0) describe_part(out, &part);
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

static void list_topics(FILE *out)
{
    const tobi_param_table *table;
    fprintf(out, "Topics:\n");
    for (int i = 0; (table = table_at(i)); i++)
        fprintf(out, "  %-9s %s\n", table->name, table->doc);
    fprintf(out, "  %-9s %s\n", "motion", "The motion of a body: a script, or one by numbers.");
    fprintf(out, "  %-9s %s\n", "scene", "The whole page: every key of a scene, in Markdown.");
    fprintf(out, "  %-9s %s\n", "schema", "The JSON Schema of scenes, for editors.");
}

static const tobi_param_table *find_table(const char *topic)
{
    const tobi_param_table *table;
    for (int i = 0; (table = table_at(i)); i++)
        if (strcmp(table->name, topic) == 0) return table;
    return NULL;
}

char *tobi_scene_describe(const char *topic)
{
    if (topic && strcmp(topic, "scene") == 0) return tobi_scene_manual();
    if (topic && strcmp(topic, "schema") == 0) return tobi_scene_schema();
    char *text = NULL;
    size_t size = 0;
    int is_motion = topic && strcmp(topic, "motion") == 0;
    const tobi_param_table *table = topic ? find_table(topic) : NULL;
    if (topic && !table && !is_motion) return NULL;
    FILE *out = open_memstream(&text, &size);
    if (!out) return NULL;
    if (!topic) list_topics(out);
    else if (table) describe_table(out, table);
    for (int i = 0; is_motion && (table = tobi_motion_table(i)); i++) describe_table(out, table);
    fclose(out);
    return text;
}
