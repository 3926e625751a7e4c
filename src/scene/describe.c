/* Help texts, made from the parameter tables alone. */
#define _GNU_SOURCE 1
#include "scene/bind.h"
#include "scene/manual.h"
#include "scene/motions.h"
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

static void describe_table(FILE *out, const tobi_param_table *table)
{
    fprintf(out, "%s: %s\n", table->name, table->doc);
    for (const tobi_param *row = table->rows; row->key; row++) describe_row(out, row);
}

static void list_topics(FILE *out)
{
    const tobi_param_table *table;
    fprintf(out, "Topics:\n");
    for (int i = 0; (table = tobi_param_table_at(i)); i++)
        fprintf(out, "  %-9s %s\n", table->name, table->doc);
    fprintf(out, "  %-9s %s\n", "motion", "The motion of a body: a script, or one by numbers.");
    fprintf(out, "  %-9s %s\n", "scene", "The whole page: every key of a scene, in Markdown.");
    fprintf(out, "  %-9s %s\n", "schema", "The JSON Schema of scenes, for editors.");
}

static const tobi_param_table *find_table(const char *topic)
{
    const tobi_param_table *table;
    for (int i = 0; (table = tobi_param_table_at(i)); i++)
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
