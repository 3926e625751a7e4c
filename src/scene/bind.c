/* Walks an object by its table; value.c writes the members. Mistakes are collected with their places.
   Drawback: types of the table are all that JSON can say. */
#include "scene/bind.h"
#include "scene/value.h"
#include "scene/describe/describe.h"
#include "scene/spelling.h"
#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct tobi_text_node { struct tobi_text_node *next; char *text; };

char *tobi_texts_keep(tobi_texts *texts, char *text)
{
    struct tobi_text_node *node = text ? malloc(sizeof *node) : NULL;
    if (!node) {
        texts->failed = 1;
        free(text);
        return NULL;
    }
    *node = (struct tobi_text_node){ texts->first, text };
    texts->first = node;
    return text;
}

void tobi_texts_free(tobi_texts *texts)
{
    for (struct tobi_text_node *node = texts->first, *next; node; node = next) {
        next = node->next;
        free(node->text);
        free(node);
    }
    texts->first = NULL;
}

const char *tobi_json_kind(const json_t *value)
{
    switch (json_typeof(value)) {
    case JSON_OBJECT: return tr("an object");
    case JSON_ARRAY: return tr("a list");
    case JSON_STRING: return tr("a text");
    case JSON_INTEGER:
    case JSON_REAL: return tr("a number");
    case JSON_NULL: return "null";
    default: return tr("true or false");
    }
}

/* The state of binding one object and the objects nested in it. */
typedef struct pass {
    const tobi_binder *binder;
    const tobi_param_table *table;
    const char *const *also;
    char *def;
    tobi_bound bound;
} pass;

/* How a row's key continues after prefix and key: NULL if it does not begin with them. */
static const char *key_rest(const tobi_param *row, const char *prefix, const char *key)
{
    size_t n = strlen(prefix), m = strlen(key);
    if (m == 0 || strncmp(row->key, prefix, n) != 0 || strncmp(row->key + n, key, m) != 0)
        return NULL;
    const char *rest = row->key + n + m;
    return *rest == '\0' || *rest == '.' || *rest == '[' ? rest : NULL;
}

enum { CANDIDATES = 64 };

/* The keys allowed at one level, each once. */
static size_t list_keys(const pass *p, const char *prefix, char (*keys)[48])
{
    size_t count = 0, n = strlen(prefix);
    for (const tobi_param *row = p->table->rows; row->key; row++) {
        if (strncmp(row->key, prefix, n) != 0 || count == CANDIDATES) continue;
        char key[48];
        snprintf(key, sizeof key, "%.*s", (int)strcspn(row->key + n, ".["), row->key + n);
        if (count == 0 || strcmp(keys[count - 1], key) != 0) strcpy(keys[count++], key);
    }
    for (int i = 0; n == 0 && p->also && p->also[i] && count < CANDIDATES; i++)
        snprintf(keys[count++], sizeof keys[0], "%s", p->also[i]);
    return count;
}

static void report_unknown(const pass *p, const char *prefix, const tobi_place *place)
{
    char keys[CANDIDATES][48], all[1024] = "", owners[256];
    const char *list[CANDIDATES];
    if (tobi_report_pass(p->binder->source->report)) return;
    size_t count = list_keys(p, prefix, keys), used = 0;
    for (size_t i = 0; i < count; i++) list[i] = keys[i];
    const char *near = tobi_suggest(place->key, list, count);
    if (near) {
        tobi_source_mistake_at_key(p->binder->source, place, "unknown key; did you mean \"%s\"?",
                                   near);
        return;
    }
    for (size_t i = 0; i < count && used < sizeof all; i++)
        used += (size_t)snprintf(all + used, sizeof all - used, "%s%s", i ? ", " : "", keys[i]);
    const int owned = tobi_describe_owners(p->table, place->key, owners, sizeof owners) > 0;
    tobi_source_mistake_at_key(p->binder->source, place, "unknown key; %s%s%sallowed here: %s",
                               owned ? tr("it belongs to ") : "", owned ? owners : "", owned ? "; " : "",
                               all);
}

static void bind_row(pass *p, const tobi_param *row, json_t *value, const tobi_place *place)
{
    int64_t before = tobi_report_total(p->binder->source->report);
    const int64_t number = row - p->table->rows;
    const tobi_rows bit = (tobi_rows)1 << number;
    assert(number < 8*(int64_t)sizeof bit);
    tobi_bind_value(&(tobi_slot){ p->binder, row, place, value, p->def + row->offset });
    p->bound.given |= bit;
    if (tobi_report_total(p->binder->source->report) == before) p->bound.good |= bit;
}

/* Rows "key[0]", "key[1]": a list with one entry for each, or one value for all. */
static void bind_entries(pass *p, const char *prefix, const char *key, json_t *value,
                         const tobi_place *place)
{
    size_t count = 0, i = 0;
    const tobi_param *row;
    for (row = p->table->rows; row->key; row++) count += key_rest(row, prefix, key) != NULL;
    if (json_is_array(value) && json_array_size(value) != count) {
        tobi_source_mistake(p->binder->source, place,
                            "has %zu entries, must have %zu [lower, upper] or be one "
                            "value for both",
                            json_array_size(value), count);
        return;
    }
    for (row = p->table->rows; row->key; row++) {
        if (!key_rest(row, prefix, key)) continue;
        tobi_place entry = { place, NULL, i };
        if (json_is_array(value)) bind_row(p, row, json_array_get(value, i), &entry);
        else if (i == 0) bind_row(p, row, value, place);
        else memcpy(p->def + row->offset, p->def + row[-1].offset, sizeof(int));
        i++;
    }
}

static void bind_members(pass *p, const char *prefix, json_t *object, const tobi_place *place);

static int is_listed(const char *const *list, const char *key)
{
    for (int i = 0; list && list[i]; i++)
        if (strcmp(list[i], key) == 0) return 1;
    return 0;
}

/* A value where keys belong, with those keys. */
static void report_no_object(const pass *p, const char *prefix, const char *key, const json_t *value,
                             const tobi_place *place)
{
    char longer[64], keys[CANDIDATES][48], all[512] = "";
    snprintf(longer, sizeof longer, "%s%s.", prefix, key);
    const size_t count = list_keys(p, longer, keys);
    for (size_t i = 0, used = 0; i < count && used < sizeof all; i++)
        used += (size_t)snprintf(all + used, sizeof all - used, "%s%s", i ? ", " : "", keys[i]);
    tobi_source_mistake(p->binder->source, place, "is %s, must be an object { ... } with %s",
                        tobi_json_kind(value), all);
}

/* A key of the object in the spelling of the table. Both spellings in one object are a mistake. */
static const char *spell_key(const pass *p, const char *prefix, json_t *object, const tobi_place *place,
                             char other[TOBI_SPELLING])
{
    int has_mine = 0, has_other = 0;
    if (!tobi_spelling_other(place->key, other)) return place->key;
    for (const tobi_param *row = p->table->rows; row->key; row++) {
        has_mine |= key_rest(row, prefix, place->key) != NULL;
        has_other |= key_rest(row, prefix, other) != NULL;
    }
    if (has_mine || !has_other) return place->key;
    if (!json_object_get(object, other)) return other;
    tobi_source_mistake_at_key(p->binder->source, place, "is another spelling of \"%s\", which is given too; "
                               "one of them is enough", other);
    return NULL;
}

static void bind_member(pass *p, const char *prefix, json_t *object, json_t *value, const tobi_place *place)
{
    char other[TOBI_SPELLING];
    const char *key = spell_key(p, prefix, object, place, other);
    for (const tobi_param *row = p->table->rows; key && row->key; row++) {
        const char *rest = key_rest(row, prefix, key);
        if (!rest || strpbrk(key, ".[")) continue;
        if (*rest == '\0') {
            bind_row(p, row, value, place);
        } else if (*rest == '[') {
            bind_entries(p, prefix, key, value, place);
        } else if (!json_is_object(value)) {
            report_no_object(p, prefix, key, value, place);
        } else {
            char longer[128];
            snprintf(longer, sizeof longer, "%s%s.", prefix, key);
            bind_members(p, longer, value, place);
        }
        return;
    }
    if (key && (prefix[0] || !is_listed(p->also, key))) report_unknown(p, prefix, place);
}

static void bind_members(pass *p, const char *prefix, json_t *object, const tobi_place *place)
{
    const char *key;
    json_t *value;
    json_object_foreach(object, key, value) {
        tobi_place member = { place, key, 0 };
        bind_member(p, prefix, object, value, &member);
    }
}

/* Reports a required row that is not there, at the place of the object that lacks it. */
static void report_missing(const tobi_binder *binder, const tobi_param *row,
                           const tobi_place *place)
{
    char first[48] = "", limits[TOBI_NOTE];
    const char *dot = strchr(row->key, '.');
    snprintf(first, sizeof first, "%.*s", (int)(dot ? dot - row->key : 0), row->key);
    tobi_place outer = { place, first, 0 };
    tobi_place inner = { dot ? &outer : place, dot ? dot + 1 : row->key, 0 };
    tobi_bind_say_limits(row, limits, sizeof limits);
    if (row->type == TOBI_PARAM_TEXT)
        tobi_source_mistake(binder->source, &inner, "is missing: %s", tr(row->doc));
    else
        tobi_source_mistake(binder->source, &inner, "is missing (%s): %s", limits, tr(row->doc));
}

tobi_bound tobi_bind(const tobi_binder *binder, const tobi_param_table *table, json_t *object,
                   const tobi_place *place, const char *const *also, void *def)
{
    pass p = { binder, table, also, def, { 0, 0 } };
    if (!json_is_object(object)) {
        tobi_source_mistake(binder->source, place, "is %s, must be an object { ... }",
                            tobi_json_kind(object));
        return p.bound;
    }
    bind_members(&p, "", object, place);
    for (const tobi_param *row = table->rows; row->key; row++)
        if (row->required && !(p.bound.given >> (row - table->rows) & 1))
            report_missing(binder, row, place);
    return p.bound;
}

int tobi_bind_has(const tobi_param_table *table, tobi_rows rows, const char *key)
{
    for (const tobi_param *row = table->rows; row->key; row++)
        if (strcmp(row->key, key) == 0) return rows >> (row - table->rows) & 1;
    return 0;
}
