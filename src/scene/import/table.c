/* What became of each key of an old scene: collected while it is translated, written as a table. */
#define _GNU_SOURCE 1
#include "base/language.h"
#include "scene/import/import.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static tobi_old_row *add_row(tobi_import *im)
{
    if (im->row_count == im->row_room) {
        int room = im->row_room ? 2*im->row_room : 64;
        tobi_old_row *more = realloc(im->rows, (size_t)room*sizeof *more);
        if (!more) {
            im->no_memory = 1;
            return NULL;
        }
        im->rows = more;
        im->row_room = room;
    }
    tobi_old_row *row = &im->rows[im->row_count++];
    *row = (tobi_old_row){ 0 };
    return row;
}

/* "0.002 m2/s"; NULL without memory. */
static char *value_text(const json_t *value, const char *unit)
{
    char *text = NULL;
    char *json = json_dumps(value, JSON_ENCODE_ANY | JSON_REAL_PRECISION(10));
    const int plain = !unit || strcmp(unit, "1") == 0 || strcmp(unit, "path") == 0 ||
                      strcmp(unit, "text") == 0;
    const char *behind = plain ? "" : unit;
    int length = json ? asprintf(&text, "%s%s%s", json, behind[0] ? " " : "", behind) : -1;
    free(json);
    return length < 0 ? NULL : text;
}

void tobi_import_note_key(tobi_import *im, const tobi_old_key *key, json_t *value,
                          const tobi_place *place, const char *native)
{
    char path[TOBI_PATH_TEXT];
    tobi_place at = { place, key->param.key, 0 };
    tobi_place_text(&at, path);
    tobi_old_row *row = add_row(im);
    if (!row) return;
    const char *remark = value ? key->param.doc : key->absent;
    row->from = strdup(path);
    row->value = value ? value_text(value, key->param.unit) : strdup(tr("(not given)"));
    row->path = native ? strdup(native) : NULL;
    row->unit = key->unit ? key->unit : key->param.unit;
    row->remark = strdup(remark ? tr(remark) : "");
    im->no_memory |= !row->from || !row->value || !row->remark || (native && !row->path);
    if (value && native) im->no_memory |= tobi_source_add_origin(im->source, native, &at) != TOBI_OK;
}

void tobi_import_note(tobi_import *im, const tobi_old_section *section, json_t *object,
                      const tobi_place *place, const char *entry, const char *fluid)
{
    im->no_memory |= tobi_source_add_origin(im->source, entry, place) != TOBI_OK;
    if (fluid[0]) im->no_memory |= tobi_source_add_origin(im->source, fluid, place) != TOBI_OK;
    for (const tobi_old_key *key = section->keys; key->param.key; key++) {
        json_t *value = json_object_get(object, key->param.key);
        const char *to = key->becomes;
        char native[TOBI_PATH_TEXT];
        if (!value && !key->absent) continue;
        if (to)
            snprintf(native, sizeof native, "%s%s%s", to[0] == '.' ? entry : to[0] == '^' ? fluid : "",
                     to[0] == '^' ? "." : "", to + (to[0] == '^'));
        tobi_import_note_key(im, key, value, place, to ? native : NULL);
    }
}

void tobi_import_note_others(tobi_import *im, const tobi_old_section *section, json_t *object,
                             const tobi_place *place, const tobi_place *shown, const tobi_old_others *others)
{
    enum { KEYS = 64 };
    const char *known[KEYS], *key;
    size_t count = 0;
    json_t *value;
    for (; section->keys[count].param.key && count < KEYS; count++)
        known[count] = section->keys[count].param.key;
    json_object_foreach(object, key, value) {
        size_t k = 0;
        while (k < count && strcmp(known[k], key) != 0) k++;
        if (k < count) continue;
        const char *remark = others->remark ? others->remark(key) : NULL;
        const char *near = remark ? NULL : tobi_suggest(key, known, count);
        tobi_place at = { place, key, 0 };
        if (near) tobi_source_mistake_at_key(im->source, &at, "unknown key; did you mean \"%s\"?", near);
        const tobi_old_key row = { .param.key = key, .param.doc = remark ? remark : others->unknown };
        tobi_import_note_key(im, &row, value, shown, NULL);
    }
}

/* The newest row about `key`, NULL if there is none. */
static tobi_old_row *find_row(tobi_import *im, const char *key)
{
    for (int i = im->row_count - 1; i >= 0; i--) {
        const char *from = im->rows[i].from, *dot = from ? strrchr(from, '.') : NULL;   /* NULL: no memory */
        if (from && strcmp(dot ? dot + 1 : from, key) == 0) return &im->rows[i];
    }
    return NULL;
}

void tobi_import_tell(tobi_import *im, const char *key, char *paths)
{
    tobi_old_row *row = find_row(im, key);
    if (row) row->paths = paths;
    else free(paths);
}

void tobi_import_remark(tobi_import *im, const char *key, const char *format, ...)
{
    tobi_old_row *row = find_row(im, key);
    char *remark = NULL;
    va_list args;
    va_start(args, format);
    int length = row ? vasprintf(&remark, tr(format), args) : 0;
    va_end(args);
    im->no_memory |= length < 0;
    if (!row || length < 0) return;
    free(row->remark);
    row->remark = remark;
}

/* The value at "a[0].b" of a scene, NULL if there is none. */
static json_t *find_value(json_t *node, const char *path)
{
    while (node && *path) {
        char key[64];
        path += *path == '.';
        if (*path == '[') {
            char *end;
            node = json_array_get(node, (size_t)strtoul(path + 1, &end, 10));
            path = *end ? end + 1 : end;
            continue;
        }
        size_t n = strcspn(path, ".[");
        snprintf(key, sizeof key, "%.*s", (int)n, path);
        node = json_object_get(node, key);
        path += n;
    }
    return node;
}

static int limit(int length, int most) { return length > most ? most : length; }

/* Of a terminal; letters of Japanese take two. */
static int columns(const char *text)
{
    int count = 0;
    for (; *text; text++) {
        const unsigned char c = (unsigned char)*text;
        count += c >= 0xe3 ? 2 : c < 0x80 || c >= 0xc0;
    }
    return count;
}

/* 0 without memory. */
static int write_row(FILE *out, const tobi_import *im, const tobi_old_row *row, const int width[2])
{
    json_t *value = row->path ? find_value(im->native, row->path) : NULL;
    char *text = value ? value_text(value, json_is_string(value) ? NULL : row->unit) : NULL;
    for (int k = 0; k < 2; k++) {
        const char *cell = k == 0 ? row->from : row->value;
        const int blanks = width[k] - columns(cell);
        fprintf(out, "%s%*s  ", cell, blanks > 0 ? blanks : 0, "");
    }
    fprintf(out, "-> ");
    if (row->paths) fprintf(out, "%s\n", row->paths);
    else if (text) fprintf(out, "%s = %s\n", row->path, text);
    else fprintf(out, "%s\n", tr("nothing"));
    if (row->remark[0]) fprintf(out, "    %s\n", row->remark);
    free(text);
    return !value || text;
}

static char *write_table(const tobi_import *im)
{
    int width[2] = { 0, 0 };
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out) return NULL;
    for (int i = 0; i < im->row_count; i++) {
        const int from = limit(columns(im->rows[i].from), 44);
        const int value = limit(columns(im->rows[i].value), 24);
        if (from > width[0]) width[0] = from;
        if (value > width[1]) width[1] = value;
    }
    int whole = 1;
    for (int i = 0; i < im->row_count; i++) whole &= write_row(out, im, &im->rows[i], width);
    whole &= fputs(tr(im->closing), out) >= 0 && !ferror(out);     /* memory may be too small in between */
    whole &= fclose(out) == 0;
    if (whole) return text;
    free(text);
    return NULL;
}

tobi_status tobi_import_finish(tobi_import *im, char **table)
{
    *table = im->no_memory ? NULL : write_table(im);
    if (!*table) return TOBI_NO_MEMORY;
    json_decref(im->source->root);
    im->source->root = im->native;
    im->source->translated = 1;
    im->native = NULL;
    return TOBI_OK;
}

void tobi_import_clear(tobi_import *im)
{
    for (int i = 0; i < im->row_count; i++) {
        free(im->rows[i].from);
        free(im->rows[i].value);
        free(im->rows[i].path);
        free(im->rows[i].paths);
        free(im->rows[i].remark);
    }
    free(im->rows);
    json_decref(im->native);
}
