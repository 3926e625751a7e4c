/* Finds keys of scenes, fields and columns by a part of their path: "camera", "output.camera", "viscosity";
   or, where none has it, by a word of their sentences: "shear", "discharge". Drawback: a word that many
   places use, such as "name", lists them all. */
#define _GNU_SOURCE 1
#include "scene/describe/describe.h"
#include "scene/describe/manual.h"
#include "scene/parts.h"
#include "scene/spelling.h"
#include "tobiuo/run.h"
#include "tobiuo/scene.h"
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

static int ends_word(char c) { return c == '\0' || c == '.' || c == '['; }

/* How long path is up to the end of the words of `part` in it, beside each other: "output.camera.angle" has
   "camera"; 0: it has them not. */
static int find_words(const char *path, const char *part)
{
    const size_t length = strlen(part);
    for (const char *p = path; length > 0 && (p = strstr(p, part)); p++)
        if ((p == path || p[-1] == '.') && ends_word(p[length])) return (int)(p - path) + (int)length;
    return 0;
}

int tobi_describe_says(const char *sentence, const char *word)
{
    const size_t length = strlen(word);
    for (const char *p = sentence; length > 0 && (p = strcasestr(p, word)); p++)
        if ((p == sentence || !isalnum((unsigned char)p[-1])) && !isalnum((unsigned char)p[length])) return 1;
    return 0;
}

/* What is looked for, in paths or in sentences. */
typedef struct query { const char *word; int in_sentences; } query;

static int matches(const tobi_param_table *table, const char *key, const char *doc, const query *q)
{
    char path[160], room[TOBI_MEANING];
    snprintf(path, sizeof path, "%s.%s", table->name, key);
    return q->in_sentences ? tobi_describe_says(tobi_meaning(doc, room), q->word)
                           : find_words(path, q->word) > 0;
}

static void print_head(FILE *out, const tobi_param_table *table, int found, char room[TOBI_MEANING])
{
    fprintf(out, "%s%s: %s\n", found ? "\n" : "", table->name, tobi_meaning(table->doc, room));
}

static int find_in_table(FILE *out, const tobi_param_table *table, const query *q, int found)
{
    tobi_part part;
    char room[TOBI_MEANING];
    int here = 0;
    for (const tobi_param *row = table->rows; row->key; row++) {
        if (!matches(table, row->key, row->doc, q)) continue;
        if (here++ == 0) print_head(out, table, found, room);
        tobi_describe_row(out, row);
    }
    for (int i = 0; tobi_part_at(i, &part); i++) {
        if (strcmp(part.owner, table->name) != 0 || !matches(table, part.key, part.doc, q)) continue;
        if (here++ == 0) print_head(out, table, found, room);
        tobi_describe_part(out, &part);
    }
    return here;
}

static int find_field(FILE *out, const char *word)
{
    const char *name, *unit;
    int components;
    for (int i = 0; (name = tobi_world_field_name(i, &components, &unit)); i++) {
        if (strcmp(name, word) != 0) continue;
        fprintf(out, tr("%s: field of particles for output.fields, %d component%s, unit %s\n"), name,
                components,
                components == 1 ? "" : "s", unit);
        return 1;
    }
    return 0;
}

static int find_word(FILE *out, const char *word, int in_sentences)
{
    const query q = { word, in_sentences };
    const tobi_param_table *table;
    int found = 0;
    for (int i = 0; (table = tobi_describe_table_at(i)); i++) found += find_in_table(out, table, &q, found);
    if (!in_sentences) found += find_field(out, word);
    return found + tobi_tables_find(out, word, in_sentences);
}

int tobi_describe_find(FILE *out, const char *word)
{
    char other[TOBI_SPELLING];
    const char *spellings[] = { word, tobi_spelling_other(word, other) ? other : NULL };
    int found = 0;
    for (int in_sentences = 0; in_sentences < 2; in_sentences++)
        for (int k = 0; k < 2 && !found; k++)
            if (spellings[k]) found = find_word(out, spellings[k], in_sentences);
    return found;
}

/* --- where a key belongs ------------------------------------------------------------------ */

static int is_method(const tobi_param_table *table) { return tobi_method_table(table->name) == table; }

/* methods: of methods alone. */
static int find_owners(const char *word, int methods, char *text, size_t size)
{
    enum { MOST = 3 };
    const tobi_param_table *table;
    int found = 0;
    size_t used = 0;
    *text = '\0';
    for (int i = 0; (table = tobi_describe_table_at(i)); i++) {
        const char *owner = strcmp(table->name, "world") == 0 ? "the top level" : table->name;
        char path[160], last[160] = "";
        if (methods && !is_method(table)) continue;
        for (const tobi_param *row = table->rows; row->key; row++) {
            snprintf(path, sizeof path, "%.*s", find_words(row->key, word), row->key);
            if (!*path || strcmp(path, last) == 0) continue;
            if (++found > MOST) return 0;
            strcpy(last, path);
            used += (size_t)snprintf(text + used, size - used, "%s%s (%s)", found > 1 ? ", " : "", owner,
                                     path);
            if (used >= size) return 0;
        }
    }
    return found;
}

int tobi_describe_owners(const tobi_param_table *in, const char *word, char *text, size_t size)
{
    const int found = is_method(in) ? find_owners(word, 1, text, size) : 0;
    return found ? found : find_owners(word, 0, text, size);
}

/* --- did you mean ------------------------------------------------------------------------- */

typedef struct words { char *text; size_t size; FILE *out; int count; } words;

/* "domain.walls.x[0]": domain, walls and x. */
static void add_words(words *w, const char *path)
{
    for (const char *p = path; *p; p++) {
        if (*p == '[') break;             /* only an index comes after it */
        fputc(*p == '.' ? '\0' : *p, w->out);
        w->count += *p == '.';
    }
    fputc('\0', w->out);
    w->count++;
}

static void add_all(words *w)
{
    const tobi_param_table *table;
    const char *name, *unit;
    tobi_part part;
    int components;
    for (int i = 0; (name = tobi_describe_topic(i)); i++) add_words(w, name);
    for (int i = 0; (table = tobi_describe_table_at(i)); i++)
        for (const tobi_param *row = table->rows; row->key; row++) add_words(w, row->key);
    for (int i = 0; tobi_part_at(i, &part); i++) add_words(w, part.key);
    for (int i = 0; (name = tobi_world_field_name(i, &components, &unit)); i++) add_words(w, name);
    const tobi_column *c;
    for (tobi_table t = TOBI_TABLE_HISTORY; t <= TOBI_TABLE_SCALAR_FLOWS; t++)
        for (int i = 0; (c = tobi_run_column(t, i)); i++) add_words(w, c->name);
}

char *tobi_scene_suggest(const char *word)
{
    words w = { 0 };
    if (!word || !(w.out = open_memstream(&w.text, &w.size))) return NULL;
    add_all(&w);
    fclose(w.out);
    const char **list = calloc((size_t)w.count + 1, sizeof *list), *near = NULL;
    const char *p = w.text;
    for (int k = 0; list && p && k < w.count; k++, p += strlen(p) + 1) list[k] = p;
    if (list && p) near = tobi_suggest(word, list, (size_t)w.count);
    char *copy = near ? strdup(near) : NULL;
    free(list);
    free(w.text);
    return copy;
}
