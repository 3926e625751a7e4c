/* Numbers are written with the fewest digits that read back to the same bits. Drawback: comments of
   the scene are lost. */
#define _GNU_SOURCE 1
#include "scene/write.h"
#include "scene/point_list.h"
#include "base/param.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static json_t *write_number(const tobi_param *row, const void *member)
{
    double real;
    int whole;
    if (row->type == TOBI_PARAM_REAL) {
        memcpy(&real, member, sizeof real);
        return row->text && real == tobi_param_word(row) ? json_string(row->text) : json_real(real);
    }
    memcpy(&whole, member, sizeof whole);
    return row->text && whole == tobi_param_word(row) ? json_string(row->text) : json_integer(whole);
}

/* A list of names, "a,b", as ["a", "b"]; one of a row that may be a list, and any other text, as it is. */
static json_t *make_text(const tobi_param *row, const char *names)
{
    const int is_list = strcmp(row->unit, "names") == 0 ||
                        (strcmp(row->unit, "name or names") == 0 && strchr(names, ','));
    if (strcmp(row->unit, "points") == 0) return tobi_point_list_write(names);
    if (!is_list) return json_string(names);
    json_t *list = json_array();
    int failed = !list;
    for (const char *c = names; *c;) {
        size_t length = strcspn(c, ",");
        failed |= json_array_append_new(list, json_stringn(c, length));
        c += length + (c[length] == ',');
    }
    if (!failed) return list;
    json_decref(list);
    return NULL;
}

json_t *tobi_write_member(const tobi_param *row, const void *def)
{
    const void *member = (const char *)def + row->offset;
    double v[3];
    const char *text;
    int whole, length;
    switch (row->type) {
    case TOBI_PARAM_VEC3:
        memcpy(v, member, sizeof v);
        if (row->text && memcmp(v, row->def, sizeof v) == 0) return json_string(row->text);
        return json_pack("[fff]", v[0], v[1], v[2]);
    case TOBI_PARAM_TEXT:
        memcpy(&text, member, sizeof text);
        return text ? make_text(row, text) : NULL;
    case TOBI_PARAM_CHOICE:
        memcpy(&whole, member, sizeof whole);
        text = tobi_choice_word(row->choices, whole, &length);
        return text ? json_stringn(text, (size_t)length) : NULL;
    case TOBI_PARAM_BOOL:
        memcpy(&whole, member, sizeof whole);
        return json_boolean(whole);
    default:
        return write_number(row, member);
    }
}

/* Goes down to the object that "a.b.c" belongs to, making what is missing; *last is "c". Or NULL. */
static json_t *descend(json_t *object, const char *key, const char **last)
{
    for (const char *dot; object && (dot = strchr(key, '.')); key = dot + 1) {
        char name[48];
        snprintf(name, sizeof name, "%.*s", (int)(dot - key), key);
        json_t *child = json_object_get(object, name);
        if (!child) {
            child = json_object();
            if (json_object_set_new(object, name, child)) child = NULL;
        }
        object = child;
    }
    *last = key;
    return object;
}

static int is_left_out(const tobi_param *row, const void *def)
{
    const char *text = "";
    if (row->type == TOBI_PARAM_TEXT) memcpy(&text, (const char *)def + row->offset, sizeof text);
    return !text;
}

/* 0, or -1 when out of memory; jansson's calls answer NULL arguments with -1. */
static int write_row(json_t *object, const tobi_param *row, const void *def)
{
    const char *last;
    json_t *parent = descend(object, row->key, &last);
    if (is_left_out(row, def)) return parent ? 0 : -1;
    json_t *value = tobi_write_member(row, def);
    if (!strchr(last, '[')) return json_object_set_new(parent, last, value);
    char name[48];
    snprintf(name, sizeof name, "%.*s", (int)strcspn(last, "["), last);
    if (!json_object_get(parent, name)) json_object_set_new(parent, name, json_array());
    return json_array_append_new(json_object_get(parent, name), value);
}

json_t *tobi_write_def(const tobi_param_table *table, const void *def)
{
    json_t *object = json_object();
    int failed = !object;
    for (const tobi_param *row = table->rows; !failed && row->key; row++)
        failed = write_row(object, row, def);
    if (!failed) return object;
    json_decref(object);
    return NULL;
}

/* The shortest decimal number that reads back to the same bits. Nonzero as write_text. */
static int write_real(FILE *out, double v)
{
    char text[40];
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, v);
        if (strtod(text, NULL) == v) break;
    }
    for (char *c = text; *c; c++)
        if (*c == ',') *c = '.';        /* a locale with decimal commas */
    return fputs(text, out) < 0 || (!strpbrk(text, ".e") && fputs(".0", out) < 0);
}

static int is_short(const json_t *list)
{
    size_t i;
    json_t *entry;
    if (json_array_size(list) > 16) return 0;
    json_array_foreach(list, i, entry)
        if (json_is_object(entry) || json_is_array(entry)) return 0;
    return 1;
}

static void write_indent(FILE *out, int depth) { fprintf(out, "\n%*s", 2*depth, ""); }

/* Nonzero when out of memory, as write_json. */
static int write_text(FILE *out, const json_t *value)
{
    char *text = json_dumps(value, JSON_ENCODE_ANY);
    const int failed = !text || fputs(text, out) < 0;
    free(text);
    return failed;
}

static int write_json(FILE *out, const json_t *value, int depth)
{
    int failed = 0;
    size_t i;
    const char *key;
    json_t *entry;
    if (json_is_object(value)) {
        const char *gap = "";
        fputc('{', out);
        json_object_foreach((json_t *)value, key, entry) {
            json_t *name = json_string(key);
            failed |= fputs(gap, out) < 0;
            write_indent(out, depth + 1);
            failed |= write_text(out, name);
            json_decref(name);
            failed |= fputs(": ", out) < 0;
            failed |= write_json(out, entry, depth + 1);
            gap = ",";
        }
        if (json_object_size(value)) write_indent(out, depth);
        fputc('}', out);
    } else if (json_is_array(value)) {
        int brief = is_short(value);
        fputc('[', out);
        json_array_foreach(value, i, entry) {
            if (i) failed |= fputs(brief ? ", " : ",", out) < 0;
            if (!brief) write_indent(out, depth + 1);
            failed |= write_json(out, entry, depth + 1);
        }
        if (!brief) write_indent(out, depth);
        fputc(']', out);
    } else if (json_is_real(value)) {
        failed = write_real(out, json_real_value(value));
    } else {
        failed = write_text(out, value);
    }
    return failed;
}

char *tobi_write_json(const json_t *value)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out) return NULL;
    int failed = write_json(out, value, 0);
    fputc('\n', out);
    failed |= ferror(out);
    if (fclose(out) != 0 || failed) {
        free(text);
        return NULL;
    }
    return text;
}
