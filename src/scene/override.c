/* Changes the JSON tree before it is bound, so that values from the command line pass the same checks.
   Drawback: a mistake is told by its path, without a line. */
#define _GNU_SOURCE 1
#include "scene/override.h"
#include "scene/parts.h"
#include "scene/spelling.h"
#include "tobiuo/scene.h"
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Splits "fluids[0].density" into ["fluids", 0, "density"]; NULL if it is not a path. */
static json_t *split_path(const char *path, size_t length)
{
    json_t *steps = json_array();
    const char *end = path + length;
    for (const char *c = path; c < end;) {
        if (*c == '[') {
            char *stop;
            long long index = strtoll(c + 1, &stop, 10);
            if (stop == c + 1 || *stop != ']' || index < 0 || index > TOBI_SOURCE_LIMIT) break;
            json_array_append_new(steps, json_integer(index));
            c = stop + 1;
        } else {
            if (*c == '.' && c > path) c++;
            size_t n = strcspn(c, ".[=");
            if (n == 0 || c + n > end) break;
            json_array_append_new(steps, json_stringn(c, n));
            c += n;
        }
        if (c == end && json_array_size(steps) > 0 && json_array_size(steps) < 16) return steps;
    }
    json_decref(steps);
    return NULL;
}

/* The value as JSON; a number written loosely (".008") counts, anything else is a text. */
static json_t *read_value(const char *text)
{
    json_t *value = json_loads(text, JSON_DECODE_ANY, NULL);
    if (value) return value;
    char *stop;
    double number = strtod(text, &stop);
    if (stop != text && *stop == '\0' && isfinite(number)) return json_real(number);
    return json_string(text);
}

/* Turns the name of a list's entry into its number. */
static int find_named(const json_t *list, const char *name)
{
    size_t i;
    json_t *entry;
    json_array_foreach(list, i, entry) {
        const char *its = json_string_value(json_object_get(entry, "name"));
        if (its && strcmp(its, name) == 0) return (int)i;
    }
    return -1;
}

/* "there are a, b, c", as many names as fit, or what there is instead. */
static void list_names(const json_t *list, char *text, size_t size)
{
    const size_t count = json_array_size(list);
    size_t i, named = 0, used = (size_t)snprintf(text, size, tr("there are"));
    json_t *entry;
    json_array_foreach(list, i, entry) {
        const char *its = json_string_value(json_object_get(entry, "name"));
        if (its && used + strlen(its) + 3 < size)
            used += (size_t)snprintf(text + used, size - used, "%s%s", named++ ? ", " : " ", its);
    }
    if (named) return;
    if (count == 0) snprintf(text, size, tr("the list is empty"));
    else if (count == 1) snprintf(text, size, tr("the only entry has no name, write [0]"));
    else snprintf(text, size, tr("the entries have no names, write [0] to [%zu]"), count - 1);
}

/* The entry meant by "2", where none has that name; -1 if it is no number. */
static long long read_index(const char *step)
{
    char *end;
    if (!isdigit((unsigned char)step[0])) return -1;
    const long long index = strtoll(step, &end, 10);
    return *end || index > TOBI_SOURCE_LIMIT ? -1 : index;
}

/* A key that the object has in the other spelling is meant. */
static void respell(const json_t *object, json_t *steps, size_t at)
{
    char other[TOBI_SPELLING];
    const char *key = json_string_value(json_array_get(steps, at));
    if (!json_object_get(object, key) && tobi_spelling_other(key, other) && json_object_get(object, other))
        json_array_set_new(steps, at, json_string(other));
}

/* Checks step `at` against the container `node` and makes it a number where node is a list. */
static int settle_step(tobi_source *source, const char *text, json_t *node, json_t *steps,
                       size_t at)
{
    json_t *step = json_array_get(steps, at);
    if (json_is_object(node)) {
        if (json_is_string(step)) {
            respell(node, steps, at);
            return 1;
        }
        tobi_report_add(source->report, 0, "--set %s: [%lld] stands where a key must stand", text,
                        (long long)json_integer_value(step));
        return 0;
    }
    if (!json_is_array(node)) {
        tobi_report_add(source->report, 0, "--set %s: there is nothing below this value to set",
                        text);
        return 0;
    }
    long long size = (long long)json_array_size(node), index = json_integer_value(step);
    if (json_is_string(step)) {
        index = find_named(node, json_string_value(step));
        if (index < 0) index = read_index(json_string_value(step));
        if (index < 0) {
            char names[160];
            list_names(node, names, sizeof names);
            tobi_report_add(source->report, 0, "--set %s: no entry is named \"%s\"; %s", text,
                            json_string_value(step), names);
            return 0;
        }
        json_array_set_new(steps, at, json_integer(index));
    }
    if (index < size) return 1;
    tobi_report_add(source->report, 0, "--set %s: there is no entry [%lld], the list has %lld",
                    text, index, size);
    return 0;
}

/* Whether what is missing at step `at` would be a list: the path has a number behind it, or the scene knows a
   list of that name. Lists are not made: their entries need more than one value. */
static int wants_list(const json_t *steps, size_t at)
{
    tobi_part part;
    if (json_is_integer(json_array_get(steps, at + 1))) return 1;
    for (int i = 0; at == 0 && tobi_part_at(i, &part); i++)
        if (part.form == TOBI_PART_LIST && strcmp(part.owner, "world") == 0 &&
            strcmp(part.key, json_string_value(json_array_get(steps, at))) == 0) return 1;
    return 0;
}

/* "there is no list "fluid"; did you mean "fluids"?", from the keys that are there. */
static void refuse_list(tobi_source *source, const char *text, json_t *object, const char *name)
{
    enum { KEYS = 64 };
    const char *keys[KEYS], *key;
    size_t count = 0;
    json_t *value;
    json_object_foreach(object, key, value)
        if (json_is_array(value) && count < KEYS) keys[count++] = key;
    const char *near = tobi_suggest(name, keys, count);
    tobi_report_add(source->report, 0, "--set %s: there is no list \"%s\"%s%s%s", text, name,
                    near ? tr("; did you mean \"") : "", near ? near : "", near ? "\"?" : "");
}

static json_t *get_child(json_t *node, const json_t *step)
{
    return json_is_object(node) ? json_object_get(node, json_string_value(step))
                                : json_array_get(node, (size_t)json_integer_value(step));
}

/* Forgets the steps behind `at`. */
static void cut_steps(json_t *steps, size_t at)
{
    while (json_array_size(steps) > at + 1) json_array_remove(steps, json_array_size(steps) - 1);
}

/* Puts {rest of the path: value} at the key `at` of an object that has none; takes the value over. 0 after a
   mistake. The steps then end with that key: all below it comes from here. */
static int make_objects(tobi_source *source, const char *text, json_t *object, json_t *steps, size_t at,
                        json_t *value)
{
    for (size_t i = at; i + 1 < json_array_size(steps); i++)
        if (wants_list(steps, i)) {
            refuse_list(source, text, i == at ? object : NULL, json_string_value(json_array_get(steps, i)));
            json_decref(value);
            return 0;
        }
    for (size_t i = json_array_size(steps) - 1; i > at; i--) {
        json_t *outer = json_object();
        json_object_set_new(outer, json_string_value(json_array_get(steps, i)), value);
        value = outer;
    }
    json_object_set_new(object, json_string_value(json_array_get(steps, at)), value);
    cut_steps(steps, at);
    return 1;
}

/* Puts value at the end of the path; takes the value over. */
static int put_value(tobi_source *source, const char *text, json_t *steps, json_t *value)
{
    json_t *node = source->root;
    size_t last = json_array_size(steps) - 1;
    for (size_t i = 0; i <= last; i++) {
        if (!settle_step(source, text, node, steps, i)) {
            json_decref(value);
            return 0;
        }
        json_t *step = json_array_get(steps, i);
        if (i == last) {
            if (json_is_object(node)) json_object_set_new(node, json_string_value(step), value);
            else json_array_set_new(node, (size_t)json_integer_value(step), value);
            break;
        }
        json_t *child = get_child(node, step);
        if (!child) return make_objects(source, text, node, steps, i, value);
        node = child;
    }
    return 1;
}

static tobi_status apply_one(tobi_source *source, const char *text)
{
    const char *equals = strchr(text, '=');
    json_t *steps = equals ? split_path(text, (size_t)(equals - text)) : NULL;
    if (!steps) {
        tobi_report_add(source->report, 0,
                        "--set %s: must be path=value, such as dfsph.support=3 or "
                        "fluids[0].viscosity=0.1",
                        text);
        return TOBI_OK;
    }
    json_t *value = read_value(equals + 1);
    if (!value) tobi_report_add(source->report, 0, "--set %s: the value is not UTF-8", text);
    if (!value || !put_value(source, text, steps, value)) {
        json_decref(steps);
        return TOBI_OK;
    }
    char *kept = strdup(text);
    if (kept) source->overrides[source->override_count++] = (tobi_override){ kept, steps };
    else json_decref(steps);
    return kept ? TOBI_OK : TOBI_NO_MEMORY;
}

tobi_status tobi_override_apply(tobi_source *source, const char *const *overrides, tobi_error *err)
{
    size_t count = 0;
    while (overrides && overrides[count]) count++;
    source->overrides = calloc(count + 1, sizeof *source->overrides);
    if (!source->overrides) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the scene");
    for (size_t i = 0; i < count; i++)
        if (apply_one(source, overrides[i]) != TOBI_OK)
            return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the scene");
    return TOBI_OK;
}
