/* Walks an object by its table and writes members of a struct. Mistakes are collected with their
   places. Drawback: types of the table are all that JSON can say. */
#define _GNU_SOURCE 1
#include "scene/bind.h"
#include "scene/point_list.h"
#include "scene/describe/describe.h"
#include "scene/spelling.h"
#include "tobiuo/scene.h"
#include "base/param.h"
#include <assert.h>
#include <math.h>
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

/* Of the words of limits: pages of keys are English, mistakes in that of the user. */
typedef const char *(*translation)(const char *english);
static const char *keep_english(const char *english) { return english; }

/* "a, b or c" from "a|b|c". */
static void list_choices(const char *choices, translation say, char *text, size_t size)
{
    int count = tobi_choice_count(choices), length;
    size_t used = 0;
    text[0] = '\0';
    for (int i = 0; i < count && used < size; i++) {
        const char *word = tobi_choice_word(choices, i, &length);
        used += (size_t)snprintf(text + used, size - used, "%s%.*s",
                                 i == 0 ? "" : i == count - 1 ? say(TR(" or ")) : ", ", length, word);
    }
}

/* Powers of ten as 1e7 and 1e-7. */
static void write_limit(double v, char text[32])
{
    const int exponent = v != 0 ? (int)round(log10(fabs(v))) : 0, is_power = fabs(v) == pow(10, exponent);
    if (is_power && (exponent > 4 || exponent < -3)) snprintf(text, 32, "%s1e%d", v < 0 ? "-" : "", exponent);
    else snprintf(text, 32, "%.10g", v);
}

static void say_limits(const tobi_param *row, translation say, char *text, size_t size)
{
    const char *unit = row->unit && strcmp(row->unit, "1") != 0 ? row->unit : "";
    const char *gap = unit[0] ? " " : "";
    char numbers[TOBI_NOTE];
    if (row->type == TOBI_PARAM_CHOICE) {
        list_choices(row->choices, say, text, size);
        return;
    }
    if (row->type == TOBI_PARAM_BOOL || row->type == TOBI_PARAM_TEXT) {
        snprintf(text, size, "%s", row->type == TOBI_PARAM_BOOL ? say(TR("true or false")) : say(TR("any")));
        return;
    }
    if (row->positive && isnan(row->max))
        snprintf(numbers, sizeof numbers, say(TR("greater than 0%s%s")), gap, unit);
    else if (isnan(row->min) && isnan(row->max))
        snprintf(numbers, sizeof numbers, say(gap[0] ? TR("any number in%s%s") : TR("any number%s%s")), gap,
                 unit);
    else if (isnan(row->max))
        snprintf(numbers, sizeof numbers, say(TR("at least %.10g%s%s")), row->min, gap, unit);
    else if (isnan(row->min))
        snprintf(numbers, sizeof numbers, say(TR("at most %.10g%s%s")), row->max, gap, unit);
    else {
        char low[32], high[32];
        write_limit(row->min, low);
        write_limit(row->max, high);
        snprintf(numbers, sizeof numbers, say(TR("%s to %s%s%s")), low, high, gap, unit);
    }
    if (row->text) snprintf(text, size, say(TR("%s, or \"%s\"")), numbers, row->text);
    else snprintf(text, size, "%s", numbers);
}

void tobi_bind_limits(const tobi_param *row, char *text, size_t size)
{
    say_limits(row, keep_english, text, size);
}

void tobi_bind_say_limits(const tobi_param *row, char *text, size_t size)
{
    say_limits(row, tobi_text, text, size);
}

void tobi_bind_default(const tobi_param *row, char *text, size_t size)
{
    int length = 0;
    const char *word;
    if (row->required) snprintf(text, size, "required");
    else if (row->type == TOBI_PARAM_TEXT)
        snprintf(text, size, "%s", row->text ? row->text : "none");
    else if (row->type == TOBI_PARAM_BOOL)
        snprintf(text, size, "%s", row->def[0] != 0 ? "true" : "false");
    else if (row->type == TOBI_PARAM_CHOICE) {
        word = tobi_choice_word(row->choices, (int)row->def[0], &length);
        snprintf(text, size, "%.*s", length, word);
    } else if (row->type == TOBI_PARAM_VEC3 && row->text) snprintf(text, size, "%s", row->text);
    else if (row->type == TOBI_PARAM_VEC3)
        snprintf(text, size, "[%.10g, %.10g, %.10g]", row->def[0], row->def[1], row->def[2]);
    else if (row->text && row->def[0] == tobi_param_word(row)) snprintf(text, size, "%s", row->text);
    else snprintf(text, size, "%.10g", row->def[0]);
}

static int is_allowed(const tobi_param *row, double v)
{
    return isfinite(v) && !(row->positive && !(v > 0)) && !(v < row->min) && !(v > row->max);
}

/* What the binding of one value needs to know. */
typedef struct slot {
    const tobi_binder *binder;
    const tobi_param *row;
    const tobi_place *place;
    json_t *value;
    void *member;
} slot;

static void report_kind(const slot *s, const char *must)
{
    char limits[TOBI_NOTE];
    tobi_bind_say_limits(s->row, limits, sizeof limits);
    const char *shown = json_string_value(s->value);
    if (s->row->type == TOBI_PARAM_BOOL)
        tobi_source_mistake(s->binder->source, s->place, "is %s, must be %s",
                            tobi_json_kind(s->value), must);
    else if (shown && strlen(shown) < 60)
        tobi_source_mistake(s->binder->source, s->place, "is the text \"%s\", must be %s (%s)",
                            shown, must, limits);
    else
        tobi_source_mistake(s->binder->source, s->place, "is %s, must be %s (%s)",
                            tobi_json_kind(s->value), must, limits);
}

static int check_range(const slot *s, const tobi_place *place, double v)
{
    if (is_allowed(s->row, v)) return 1;
    char limits[TOBI_NOTE];
    tobi_bind_say_limits(s->row, limits, sizeof limits);
    tobi_source_mistake(s->binder->source, place, "is %.10g, allowed is %s", v, limits);
    return 0;
}

/* A number, or the word that stands for one. */
static int read_number(const slot *s, double *v)
{
    const char *word = json_string_value(s->value);
    *v = json_is_number(s->value) ? json_number_value(s->value) : tobi_param_word(s->row);
    return json_is_number(s->value) || (word && s->row->text && strcmp(word, s->row->text) == 0);
}

static void bind_real(const slot *s)
{
    double v;
    if (!read_number(s, &v)) report_kind(s, tr("a number"));
    else if (json_is_string(s->value) || check_range(s, s->place, v)) memcpy(s->member, &v, sizeof v);
}

static void bind_int(const slot *s)
{
    double v;
    if (!read_number(s, &v) || v != floor(v)) {
        report_kind(s, tr("a whole number"));
    } else if (json_is_string(s->value) || check_range(s, s->place, v)) {
        int whole = (int)v;
        memcpy(s->member, &whole, sizeof whole);
    }
}

static void bind_bool(const slot *s)
{
    int on = json_is_true(s->value);
    if (!json_is_boolean(s->value)) report_kind(s, tr("true or false"));
    else memcpy(s->member, &on, sizeof on);
}

static void bind_vector(const slot *s)
{
    double v[3];
    memcpy(v, s->member, sizeof v);
    int scale = s->row->positive;
    int two = s->binder->dimension == 2 && (!s->row->text || strcmp(s->row->unit, "m") == 0);
    const char *word = json_string_value(s->value);
    if (word && s->row->text && strcmp(word, s->row->text) == 0) {
        memcpy(s->member, s->row->def, sizeof v);
        return;
    }
    if (scale && json_is_number(s->value)) {
        v[0] = v[1] = v[2] = json_number_value(s->value);
        if (check_range(s, s->place, v[0])) memcpy(s->member, v, sizeof v);
        return;
    }
    const char *must = two ? tr("a list of 2 numbers (x, y), or 3")
                       : scale ? tr("a number or a list of 3 numbers")
                       : s->row->text ? tr("a list of 3 numbers") : tr("a list of 3 numbers (x, y, z)");
    size_t n = json_array_size(s->value);
    if (!json_is_array(s->value)) {
        report_kind(s, must);
        return;
    }
    if (n != 3 && !(two && n == 2)) {
        tobi_source_mistake(s->binder->source, s->place, "has %zu entries, must be %s", n, must);
        return;
    }
    if (n == 2 && !scale) v[2] = 0;
    int good = 1;
    for (size_t i = 0; i < n; i++) {
        tobi_place entry = { s->place, NULL, i };
        slot one = { s->binder, s->row, &entry, json_array_get(s->value, i), NULL };
        v[i] = json_number_value(one.value);
        if (!json_is_number(one.value)) {
            report_kind(&one, tr("a number"));
            good = 0;
        } else if (!check_range(s, &entry, v[i])) {
            good = 0;
        }
    }
    if (good) memcpy(s->member, v, sizeof v);
}

static int is_word(const char *word, const char *choice, int length)
{
    return (int)strlen(word) == length && memcmp(word, choice, (size_t)length) == 0;
}

static void bind_choice(const slot *s)
{
    enum { MOST = 16 };
    const char *word = json_string_value(s->value);
    int count = tobi_choice_count(s->row->choices), length;
    char words[MOST][40], other[TOBI_SPELLING] = "";
    const char *list[MOST];
    if (word) tobi_spelling_other(word, other);
    for (int i = 0; i < count && i < MOST; i++) {
        const char *choice = tobi_choice_word(s->row->choices, i, &length);
        if (word && (is_word(word, choice, length) || is_word(other, choice, length))) {
            memcpy(s->member, &i, sizeof i);
            return;
        }
        snprintf(words[i], sizeof words[i], "%.*s", length, choice);
        list[i] = words[i];
    }
    char limits[TOBI_NOTE];
    tobi_bind_say_limits(s->row, limits, sizeof limits);
    const char *near =
        word ? tobi_suggest(word, list, (size_t)(count < MOST ? count : MOST)) : NULL;
    if (near)
        tobi_source_mistake(s->binder->source, s->place,
                            "is \"%s\", allowed is %s; did you mean \"%s\"?", word, limits, near);
    else if (word)
        tobi_source_mistake(s->binder->source, s->place, "is \"%s\", allowed is %s", word, limits);
    else
        tobi_source_mistake(s->binder->source, s->place, "is %s, allowed is %s",
                            tobi_json_kind(s->value), limits);
}

/* Names become parts of file names and cells of tables: a program that opens a table takes a cell
   that begins with + - = or @ for a formula and computes it. */
static int is_name(const char *name)
{
    if (!name[0] || strchr(".+-=@", name[0]) || strlen(name) > TOBI_NAME_BYTES) return 0;
    for (const char *c = name; *c; c++)
        if ((unsigned char)*c < ' ' || *c == 127 || strchr("/\\:*?\"<>|,", *c)) return 0;
    return 1;
}

static int is_line(const char *text)
{
    for (const char *c = text; *c; c++)
        if ((unsigned char)*c < ' ' || *c == 127) return 0;
    return text[0] && strlen(text) <= 200;
}

static char *join_path(const char *directory, const char *path)
{
    char *joined;
    if (path[0] == '/') return strdup(path);
    return asprintf(&joined, "%s/%s", strcmp(directory, "/") == 0 ? "" : directory, path) < 0
               ? NULL
               : joined;
}

/* A list of texts as one text with commas. */
static char *join_names(const slot *s)
{
    char *joined = NULL;
    size_t length = 0, i;
    json_t *entry;
    FILE *out = open_memstream(&joined, &length);
    if (!out) return NULL;
    json_array_foreach(s->value, i, entry) {
        tobi_place place = { s->place, NULL, i };
        const char *name = json_string_value(entry);
        if (!name || !name[0] || strchr(name, ','))
            tobi_source_mistake(s->binder->source, &place, "is %s, must be a name",
                                name ? tr("not one name") : tobi_json_kind(entry));
        else fprintf(out, "%s%s", ftell(out) > 0 ? "," : "", name);
    }
    fclose(out);
    return joined;
}

static void bind_text(const slot *s)
{
    const char *given = json_string_value(s->value), *kept = given;
    int is_path = strcmp(s->row->unit, "path") == 0, is_list = strcmp(s->row->unit, "names") == 0;
    if (strcmp(s->row->unit, "points") == 0) {
        char *points;
        if (!tobi_point_list_read(s->binder->source, s->place, s->value, &points)) return;
        kept = tobi_texts_keep(s->binder->texts, points);
        memcpy(s->member, &kept, sizeof kept);
        return;
    }
    int is_free = strcmp(s->row->unit, "text") == 0, is_either = strcmp(s->row->unit, "name or names") == 0;
    if (!given && !((is_list || is_either) && json_is_array(s->value))) {
        tobi_source_mistake(s->binder->source, s->place, "is %s, must be %s",
                            tobi_json_kind(s->value),
                            is_path   ? tr("the path of a file")
                            : is_list ? tr("a list of names")
                            : is_free ? tr("a text")
                            : is_either ? tr("a name or a list of names")
                                        : tr("a name"));
        return;
    }
    if (is_path) {
        if (!given[0]) {
            tobi_source_mistake(s->binder->source, s->place,
                                "is empty, must be the path of a file");
            return;
        }
        kept = tobi_texts_keep(s->binder->texts, join_path(s->binder->directory, given));
    } else if (is_either && json_is_array(s->value) && json_array_size(s->value) == 0) {
        tobi_source_mistake(s->binder->source, s->place, "is empty, must be a name or a list of names");
        return;
    } else if (!given) {
        kept = tobi_texts_keep(s->binder->texts, join_names(s));
    } else if (is_free) {
        if (!is_line(given)) {
            tobi_source_mistake(s->binder->source, s->place,
                                "must be 1 to 200 characters in one line");
            return;
        }
    } else if (!is_list && !is_name(given)) {
        tobi_source_mistake(s->binder->source, s->place,
                            "is not usable as a name: 1 to 63 letters, or 21 Japanese ones, none of "
                            ". + - = @ in front and none of / \\ : * ? \" < > | ,");
        return;
    }
    memcpy(s->member, &kept, sizeof kept);
}

static void bind_value(const slot *s)
{
    switch (s->row->type) {
    case TOBI_PARAM_REAL: bind_real(s); break;
    case TOBI_PARAM_INT: bind_int(s); break;
    case TOBI_PARAM_BOOL: bind_bool(s); break;
    case TOBI_PARAM_VEC3: bind_vector(s); break;
    case TOBI_PARAM_CHOICE: bind_choice(s); break;
    case TOBI_PARAM_TEXT: bind_text(s); break;
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
    bind_value(&(slot){ p->binder, row, place, value, p->def + row->offset });
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
