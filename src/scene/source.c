/* Comments become spaces, then jansson reads; places are found again by their path. Drawback: the text
   is scanned twice. */
#define _GNU_SOURCE 1
#include "scene/source.h"
#include "scene/python.h"
#include "scene/spelling.h"
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Comments and a byte-order mark become spaces, so that every position stays what it was. */
static void blank_comments(char *text, size_t size)
{
    if (size >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0) memset(text, ' ', 3);
    int in_string = 0;
    for (size_t i = 0; i < size; i++) {
        if (in_string) {
            if (text[i] == '\\') i++;
            else if (text[i] == '"' || text[i] == '\n') in_string = 0;
        } else if (text[i] == '"') {
            in_string = 1;
        } else if (text[i] == '#' || (text[i] == '/' && i + 1 < size && text[i + 1] == '/')) {
            while (i < size && text[i] != '\n') text[i++] = ' ';
        }
    }
}

/* One line of a text before its comments are blanked. */
typedef struct text_line {
    size_t end;              /* of its newline, or of the text                           */
    int has_comment;
    int is_foreign;          /* what stands before the comment cannot be JSON: no ASCII  */
    int is_blank;
} text_line;

static text_line read_line(const char *text, size_t size, size_t at)
{
    text_line line = { .is_blank = 1 };
    int in_string = 0, structure = 0, foreign = 0;
    for (; at < size && text[at] != '\n'; at++) {
        char c = text[at];
        if (line.has_comment) continue;
        if (in_string) {
            if (c == '\\' && at + 1 < size && text[at + 1] != '\n') at++;
            else if (c == '"') in_string = 0;
        } else if (c == '#' || (c == '/' && at + 1 < size && text[at + 1] == '/')) {
            line.has_comment = 1;
        } else {
            if (c == '"') in_string = 1;
            structure |= strchr("\"{}[]", c) != NULL && c != '\0';
            foreign |= (unsigned char)c >= 0x80;
            line.is_blank &= c == ' ' || c == '\t' || c == '\r';
        }
    }
    line.is_foreign = foreign && !structure;
    line.end = at;
    return line;
}

/* A comment copied from a page may have wrapped: its tail stands on a line of its own. Scenes of the Taichi
   program come like this. Such a line follows a comment and holds letters that no JSON has outside of
   strings, and no bracket or quote; anything less clear stays a mistake. */
static void blank_wrapped_tails(char *text, size_t size)
{
    int after_comment = 0;
    if (!memmem(text, size, "\"Configuration\"", 15)) return;
    for (size_t at = 0; at < size;) {
        text_line line = read_line(text, size, at);
        int tail = after_comment && line.is_foreign;
        if (tail) memset(text + at, ' ', line.end - at);
        if (!line.is_blank || line.has_comment) after_comment = line.has_comment || tail;
        at = line.end + 1;
    }
}

/* A hint for a line that looks like the tail of a comment. */
static const char *hint_at_line(const char *text, size_t size, int number)
{
    size_t at = 0;
    while (--number > 0 && at < size) at = read_line(text, size, at).end + 1;
    return at < size && read_line(text, size, at).is_foreign
        ? tr("; if this line belongs to the comment before it, put # in front") : "";
}

/* Whether the mistake is the bracket that ends at `end`, behind a comma. */
static int ends_with_comma(const char *text, size_t size, int end)
{
    size_t at = end > 0 && (size_t)end <= size ? (size_t)end - 1 : 0;
    if (at == 0 || (text[at] != '}' && text[at] != ']')) return 0;
    while (at > 0 && isspace((unsigned char)text[at - 1])) at--;
    return at > 0 && text[at - 1] == ',';
}

/* What to do about what jansson says. */
static const char *hint_at(const tobi_source *source, size_t size, const json_error_t *mistake)
{
    if (strstr(mistake->text, "unable to decode")) return tr("; a scene must be saved as UTF-8");
    if (ends_with_comma(source->text, size, mistake->position)) return tr("; remove the comma before it");
    return hint_at_line(source->text, size, mistake->line);
}

/* What jansson says in front of the piece of text that it names, for the catalogue. */
static const char *const json_faults[] __attribute__((unused)) = {
    TR("'}' expected"), TR("']' expected"), TR("':' expected"), TR("string or '}' expected"),
    TR("unexpected newline"), TR("premature end of input"), TR("invalid token"), TR("unexpected token"),
    TR("invalid escape"), TR("end of file expected"), TR("duplicate object key"), TR("too big integer"),
    TR("too big negative integer"), TR("real number overflow"), TR("maximum parsing depth reached"),
    TR("'[' or '{' expected"), TR("unable to decode byte")
};

/* What jansson says, "string or '}' expected near 'spacing'", in the user's language. */
static void say_fault(const char *said, char text[TOBI_NOTE])
{
    static const char near[] = " near ", byte[] = "unable to decode byte";
    char fault[TOBI_NOTE];
    const char *end = strstr(said, near);
    const int decodes = strncmp(said, byte, strlen(byte)) == 0;
    const int length = decodes ? (int)strlen(byte) : end ? (int)(end - said) : (int)strlen(said);
    snprintf(fault, sizeof fault, "%.*s", length, said);
    if (tr(fault) == fault || decodes || !end)
        snprintf(text, TOBI_NOTE, "%s%s", tr(fault), said + strlen(fault));
    else if (strcmp(end, " near end of file") == 0)
        snprintf(text, TOBI_NOTE, tr("%s near end of file"), tr(fault));
    else snprintf(text, TOBI_NOTE, tr("%s near %s"), tr(fault), end + strlen(near));
}

enum { DEPTH_LIMIT = 32 };

/* The steps of a place from the root down; deeper ones than the limit are dropped. */
static int list_steps(const tobi_place *place, const tobi_place *steps[DEPTH_LIMIT])
{
    int depth = 0, n = 0;
    for (const tobi_place *p = place; p && p->up; p = p->up) depth++;
    for (const tobi_place *p = place; p && p->up; p = p->up, n++)
        if (depth - 1 - n < DEPTH_LIMIT) steps[depth - 1 - n] = p;
    return depth < DEPTH_LIMIT ? depth : DEPTH_LIMIT;
}

/* A member by its key, in either spelling. */
static int find_member(tobi_source *source, tobi_spot in, const char *key, tobi_spot *found)
{
    char other[TOBI_SPELLING];
    return tobi_spots_member(&source->spots, in, key, found) ||
           (tobi_spelling_other(key, other) && tobi_spots_member(&source->spots, in, other, found));
}

/* Where a place is, or as deep on the way to it as the text goes. */
static tobi_spot locate(tobi_source *source, const tobi_place *place)
{
    const tobi_place *steps[DEPTH_LIMIT];
    int depth = list_steps(place, steps);
    tobi_spot at = tobi_spots_root(&source->spots);
    for (int i = 0; i < depth; i++)
        if (!(steps[i]->key ? find_member(source, at, steps[i]->key, &at)
                            : tobi_spots_entry(&source->spots, at, steps[i]->index, &at))) break;
    return at;
}

void tobi_place_text(const tobi_place *place, char *text)
{
    const tobi_place *steps[DEPTH_LIMIT];
    int depth = list_steps(place, steps);
    size_t used = 0;
    text[0] = '\0';
    for (int i = 0; i < depth && used < TOBI_PATH_TEXT; i++) {
        int n = steps[i]->key
            ? snprintf(text + used, TOBI_PATH_TEXT - used, "%s%s", i ? "." : "", steps[i]->key)
            : snprintf(text + used, TOBI_PATH_TEXT - used, "[%zu]", steps[i]->index);
        used += n > 0 ? (size_t)n : 0;
    }
}

static int override_covers(const tobi_override *override, const tobi_place *place)
{
    const tobi_place *steps[DEPTH_LIMIT];
    int depth = list_steps(place, steps);
    size_t count = json_array_size(override->steps);
    if (count > (size_t)depth) return 0;
    for (size_t i = 0; i < count; i++) {
        const json_t *step = json_array_get(override->steps, i);
        if (json_is_string(step)) {
            if (!steps[i]->key || strcmp(json_string_value(step), steps[i]->key) != 0) return 0;
        } else if (steps[i]->key || (size_t)json_integer_value(step) != steps[i]->index) {
            return 0;
        }
    }
    return 1;
}

static void add_mistake(tobi_source *source, size_t offset, const tobi_place *place,
                        const char *what)
{
    char path[TOBI_PATH_TEXT];
    int line, column;
    tobi_place_text(place, path);
    tobi_spots_line(&source->spots, offset, &line, &column);
    tobi_report_add(source->report, offset, "%s:%d:%d: %s%s%s", source->name, line, column, path,
                    path[0] ? ": " : "", what);
}

tobi_status tobi_source_add_origin(tobi_source *source, const char *native, const tobi_place *old)
{
    char path[TOBI_PATH_TEXT];
    tobi_origin *more =
        realloc(source->origins, (size_t)(source->origin_count + 1)*sizeof *source->origins);
    if (!more) return TOBI_NO_MEMORY;
    source->origins = more;
    tobi_place_text(old, path);
    tobi_origin *o = &more[source->origin_count];
    *o = (tobi_origin){ strdup(native), strdup(path), locate(source, old).value };
    source->origin_count++;
    return o->native && o->old ? TOBI_OK : TOBI_NO_MEMORY;
}

/* The origin that says most about a native path: the longest that it begins with. */
static const tobi_origin *find_origin(const tobi_source *source, const char *path)
{
    const tobi_origin *best = &source->origins[0];
    size_t longest = 0;
    for (int i = 0; i < source->origin_count; i++) {
        const tobi_origin *o = &source->origins[i];
        size_t n = o->native ? strlen(o->native) : 0;
        if (n <= longest || strncmp(path, o->native, n) != 0 || !strchr(".[", path[n])) continue;
        best = o;
        longest = n;
    }
    return best;
}

static void tell_origin(tobi_source *source, const tobi_place *place, const char *what)
{
    char path[TOBI_PATH_TEXT];
    int line, column;
    tobi_place_text(place, path);
    const tobi_origin *o = find_origin(source, path);
    tobi_spots_line(&source->spots, o->offset, &line, &column);
    tobi_report_add(source->report, o->offset, "%s:%d:%d: %s (here %s): %s", source->name, line,
                    column, o->old ? o->old : "", path[0] ? path : tr("the scene"), what);
}

static void tell(tobi_source *source, const tobi_place *place, int at_key, const char *what)
{
    for (int i = source->override_count - 1; i >= 0; i--) {
        if (!override_covers(&source->overrides[i], place)) continue;
        char path[TOBI_PATH_TEXT];
        tobi_place_text(place, path);
        tobi_report_add(source->report, 0, "--set %s: %s: %s", source->overrides[i].text, path,
                        what);
        return;
    }
    if (source->translated && source->origin_count) {
        tell_origin(source, place, what);
        return;
    }
    tobi_spot at = locate(source, place);
    add_mistake(source, at_key ? at.key : at.value, place, what);
}

#define TELL(at_key)                                                     \
    char *what = NULL;                                                   \
    va_list args;                                                        \
    if (tobi_report_pass(source->report)) return;                        \
    va_start(args, format);                                              \
    int length = vasprintf(&what, tobi_text(format), args);                        \
    va_end(args);                                                        \
    tell(source, place, at_key, length < 0 ? tr("out of memory") : what);    \
    if (length >= 0) free(what)

const tobi_place *tobi_place_read(const char *path, tobi_place chain[TOBI_PATH_STEPS],
                                  char text[TOBI_PATH_TEXT])
{
    tobi_place *last = &chain[0];
    *last = (tobi_place){ 0 };
    snprintf(text, TOBI_PATH_TEXT, "%s", path);
    for (char *at = text; *at && last < &chain[TOBI_PATH_STEPS - 1];) {
        char *end = at + strcspn(at, ".[]");
        const char stop = *end;
        last[1] = (tobi_place){ last, at, 0 };
        if (stop == ']') last[1] = (tobi_place){ last, NULL, strtoul(at, NULL, 10) };
        last++;
        *end = '\0';
        at = stop ? end + 1 : end;
        if (stop == ']' && *at == '.') at++;
    }
    return last;
}

void tobi_source_mistake(tobi_source *source, const tobi_place *place, const char *format, ...)
{
    TELL(0);
}

void tobi_source_mistake_at_key(tobi_source *source, const tobi_place *place, const char *format,
                                ...)
{
    TELL(1);
}

/* A key of an object, for finding equal ones by sorting. */
typedef struct seen_key { char *key; size_t at; } seen_key;

static int order_keys(const void *a, const void *b)
{
    const seen_key *x = a, *y = b;
    int order = strcmp(x->key, y->key);
    return order ? order : (x->at > y->at) - (x->at < y->at);
}

static void report_equal_keys(tobi_source *source, const tobi_place *place, seen_key *keys,
                              size_t n)
{
    if (n > 1) qsort(keys, n, sizeof *keys, order_keys);
    for (size_t i = 1; i < n; i++) {
        if (strcmp(keys[i].key, keys[i - 1].key) != 0) continue;
        if (tobi_report_pass(source->report)) continue;
        int line, column;
        char what[64];
        tobi_spots_line(&source->spots, keys[i - 1].at, &line, &column);
        snprintf(what, sizeof what, tr("duplicate key, already given in line %d"), line);
        tobi_place twin = { place, keys[i].key, 0 };
        add_mistake(source, keys[i].at, &twin, what);
    }
}

/* Reports duplicate keys in the value at `at` and below; returns the offset behind it. */
static size_t find_duplicates(tobi_source *source, const tobi_place *place, size_t at)
{
    const char *text = source->text;
    if (text[at] == '[') {
        size_t index = 0;
        for (at = tobi_spots_enter(text, at); text[at] && text[at] != ']'; index++) {
            tobi_place entry = { place, NULL, index };
            at = tobi_spots_go_on(text, find_duplicates(source, &entry, at));
        }
        return at + (text[at] == ']');
    }
    if (text[at] != '{') return tobi_spots_skip(text, at);
    seen_key *keys = NULL;
    size_t count = 0, capacity = 0;
    for (at = tobi_spots_enter(text, at); text[at] == '"';) {
        if (count == capacity) {
            capacity = capacity ? 2*capacity : 8;
            seen_key *more = realloc(keys, capacity*sizeof *keys);
            if (!more) break;
            keys = more;
        }
        char *key = tobi_spots_key(text, at);
        if (!key) break;
        keys[count++] = (seen_key){ key, at };
        tobi_place member = { place, key, 0 };
        at = tobi_spots_go_on(text, find_duplicates(source, &member, tobi_spots_value(text, at)));
    }
    report_equal_keys(source, place, keys, count);
    for (size_t i = 0; i < count; i++) free(keys[i].key);
    free(keys);
    return at + (text[at] == '}');
}

/* Windows editors call it "Unicode"; with its mark, or a first letter of two bytes without one. */
static int is_utf16(const char *text, size_t size)
{
    if (size < 2) return 0;
    return memcmp(text, "\xFF\xFE", 2) == 0 || memcmp(text, "\xFE\xFF", 2) == 0 || (!text[0] != !text[1]);
}

/* The text as plain JSON. */
static tobi_status take_text(tobi_source *source, const char *text, size_t size, tobi_error *err)
{
    if (source->python) {
        TOBI_TRY(tobi_python_to_json(source->name, text, size, &source->text, source->report, err));
        source->size = strlen(source->text);
        return TOBI_OK;
    }
    source->text = malloc(size + 1);
    if (!source->text) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the scene");
    memcpy(source->text, text, size);
    source->text[size] = '\0';
    source->size = size;
    blank_wrapped_tails(source->text, size);
    blank_comments(source->text, size);
    return TOBI_OK;
}

tobi_status tobi_source_parse(tobi_source *source, const char *name, const char *text, size_t size,
                              tobi_report *report, tobi_error *err)
{
    *source = (tobi_source){ .report = report, .python = tobi_python_applies(name) };
    source->name = strdup(name);
    if (!source->name) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the scene");
    if (is_utf16(text, size)) {
        tobi_report_add(report, 0, "%s:1:1: the file is in UTF-16; a scene must be saved as UTF-8", name);
        return TOBI_INVALID;
    }
    TOBI_TRY(take_text(source, text, size, err));
    size = source->size;
    source->spots.text = source->text;

    json_error_t mistake;
    source->root = json_loadb(source->text, size, 0, &mistake);
    if (!source->root) {
        char fault[TOBI_NOTE];
        say_fault(mistake.text, fault);
        tobi_report_add(report, 0, "%s:%d:%d: not valid JSON: %s%s", name,
                        mistake.line > 0 ? mistake.line : 1,
                        mistake.column > 0 ? mistake.column : 1, fault,
                        hint_at(source, size, &mistake));
        return TOBI_INVALID;
    }
    tobi_place root = { 0 };
    if (!json_is_object(source->root)) {
        tobi_source_mistake(source, &root, "a scene must be an object: { ... }");
        return TOBI_INVALID;
    }
    find_duplicates(source, &root, tobi_spots_root(&source->spots).value);
    return TOBI_OK;
}

void tobi_source_clear(tobi_source *source)
{
    for (int i = 0; i < source->override_count; i++) {
        json_decref(source->overrides[i].steps);
        free(source->overrides[i].text);
    }
    for (int i = 0; i < source->origin_count; i++) {
        free(source->origins[i].native);
        free(source->origins[i].old);
    }
    free(source->overrides);
    free(source->origins);
    tobi_spots_clear(&source->spots);
    json_decref(source->root);
    free(source->text);
    free(source->name);
    *source = (tobi_source){ 0 };
}
