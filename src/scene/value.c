/* Reads one value by the type and the limits of its row. A mistake is collected with its place, and leaves
   the member as it was. Drawback: text rows are told apart by the names in their unit (path, names). */
#define _GNU_SOURCE 1
#include "scene/value.h"
#include "scene/point_list.h"
#include "scene/spelling.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int is_allowed(const tobi_param *row, double v)
{
    return isfinite(v) && !(row->positive && !(v > 0)) && !(v < row->min) && !(v > row->max);
}

static void report_kind(const tobi_slot *s, const char *must)
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

static int check_range(const tobi_slot *s, const tobi_place *place, double v)
{
    if (is_allowed(s->row, v)) return 1;
    char limits[TOBI_NOTE];
    tobi_bind_say_limits(s->row, limits, sizeof limits);
    tobi_source_mistake(s->binder->source, place, "is %.10g, allowed is %s", v, limits);
    return 0;
}

/* A number, or the word that stands for one. */
static int read_number(const tobi_slot *s, double *v)
{
    const char *word = json_string_value(s->value);
    *v = json_is_number(s->value) ? json_number_value(s->value) : tobi_param_word(s->row);
    return json_is_number(s->value) || (word && s->row->text && strcmp(word, s->row->text) == 0);
}

static void bind_real(const tobi_slot *s)
{
    double v;
    if (!read_number(s, &v)) report_kind(s, tr("a number"));
    else if (json_is_string(s->value) || check_range(s, s->place, v)) memcpy(s->member, &v, sizeof v);
}

static void bind_int(const tobi_slot *s)
{
    double v;
    if (!read_number(s, &v) || v != floor(v)) {
        report_kind(s, tr("a whole number"));
    } else if (json_is_string(s->value) || check_range(s, s->place, v)) {
        int whole = (int)v;
        memcpy(s->member, &whole, sizeof whole);
    }
}

static void bind_bool(const tobi_slot *s)
{
    int on = json_is_true(s->value);
    if (!json_is_boolean(s->value)) report_kind(s, tr("true or false"));
    else memcpy(s->member, &on, sizeof on);
}

static void bind_vector(const tobi_slot *s)
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
        tobi_slot one = { s->binder, s->row, &entry, json_array_get(s->value, i), NULL };
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

static void bind_choice(const tobi_slot *s)
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
static char *join_names(const tobi_slot *s)
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

static void bind_text(const tobi_slot *s)
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

void tobi_bind_value(const tobi_slot *s)
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
