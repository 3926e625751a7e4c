/* An index of the text, made when the first place is asked for: a scene without mistakes needs none.
   Members of objects are sorted by their object and the hash of their key, so that each of two hundred
   mistakes among a million keys costs a search and no walk. Entries of lists are found in the same way where
   they are containers. Drawback: scalars of lists are walked to. */
#include "scene/spots.h"
#include <jansson.h>
#include <stdlib.h>
#include <string.h>

/* name: hash of a key, or number of an entry. */
typedef struct tobi_spot_node { uint32_t in, name, key, value; } tobi_spot_node;
typedef struct tobi_spot_mark { int line, column; } tobi_spot_mark;

enum { MARK_BYTES = 1 << 16 };

static size_t skip_space(const char *text, size_t at)
{
    while (text[at] == ' ' || text[at] == '\t' || text[at] == '\n' || text[at] == '\r') at++;
    return at;
}

static size_t skip_string(const char *text, size_t at)
{
    for (at++; text[at] && text[at] != '"'; at++)
        if (text[at] == '\\' && text[at + 1]) at++;
    return text[at] ? at + 1 : at;
}

size_t tobi_spots_skip(const char *text, size_t at)
{
    int depth = 0;
    do {
        at = skip_space(text, at);
        char c = text[at];
        if (!c) break;
        if (c == '"') at = skip_string(text, at);
        else if (c == '{' || c == '[') { depth++; at++; }
        else if (c == '}' || c == ']') { depth--; at++; }
        else if (c == ',' || c == ':') at++;
        else while (text[at] && !strchr(",:]} \t\r\n", text[at])) at++;
    } while (depth > 0);
    return at;
}

char *tobi_spots_key(const char *text, size_t at)
{
    size_t length = skip_string(text, at) - at;
    if (!memchr(text + at, '\\', length)) return strndup(text + at + 1, length - 2);
    json_t *key = json_loadb(text + at, length, JSON_DECODE_ANY, NULL);
    char *copy = key ? strdup(json_string_value(key)) : NULL;
    json_decref(key);
    return copy;
}

size_t tobi_spots_enter(const char *text, size_t at) { return skip_space(text, at + 1); }

size_t tobi_spots_go_on(const char *text, size_t at)
{
    at = skip_space(text, at);
    return text[at] == ',' ? skip_space(text, at + 1) : at;
}

size_t tobi_spots_value(const char *text, size_t at)
{
    at = skip_space(text, skip_string(text, at));
    return skip_space(text, at + 1);
}

static uint32_t hash(const char *key, size_t length)
{
    uint32_t h = 2166136261u;
    for (size_t k = 0; k < length; k++) h = (h ^ (unsigned char)key[k])*16777619u;      /* FNV-1a */
    return h;
}

/* Of the key at `at`, its escapes undone. */
static uint32_t hash_at(const char *text, size_t at)
{
    size_t length = skip_string(text, at) - at;
    if (!memchr(text + at, '\\', length)) return hash(text + at + 1, length - 2);
    char *key = tobi_spots_key(text, at);
    uint32_t h = key ? hash(key, strlen(key)) : 0;
    free(key);
    return h;
}

static int add_node(tobi_spots *s, size_t in, uint32_t name, size_t key, size_t value)
{
    if (s->count == s->room) {
        size_t room = s->room ? 2*s->room : 256;
        tobi_spot_node *more = realloc(s->node, room*sizeof *more);
        if (!more) return 0;
        s->node = more;
        s->room = room;
    }
    s->node[s->count++] = (tobi_spot_node){ (uint32_t)in, name, (uint32_t)key, (uint32_t)value };
    return 1;
}

static int is_open(char c) { return c == '{' || c == '['; }

/* Adds what the container at `at` holds, and what that holds; returns the offset behind it. jansson has
   bounded the depth. */
static size_t list_nodes(tobi_spots *s, size_t at)
{
    const char *text = s->text;
    const size_t in = at;
    uint32_t index = 0;
    const int object = text[at] == '{';
    for (at = tobi_spots_enter(text, at); text[at] && text[at] != (object ? '}' : ']'); index++) {
        size_t value = object ? tobi_spots_value(text, at) : at;
        if (object || is_open(text[value])) add_node(s, in, object ? hash_at(text, at) : index, at, value);
        value = is_open(text[value]) ? list_nodes(s, value) : tobi_spots_skip(text, value);
        at = tobi_spots_go_on(text, value);
    }
    return at + (text[at] != '\0');
}

static int order_nodes(const void *a, const void *b)
{
    const tobi_spot_node *x = a, *y = b;
    if (x->in != y->in) return x->in < y->in ? -1 : 1;
    if (x->name != y->name) return x->name < y->name ? -1 : 1;
    return x->key < y->key ? -1 : x->key > y->key;
}

static void count_on(const char *text, size_t from, size_t to, int *line, int *column)
{
    for (size_t i = from; i < to; i++) {
        if (text[i] == '\n') {
            ++*line;
            *column = 1;
        } else if (((unsigned char)text[i] & 0xC0) != 0x80) {
            ++*column;
        }
    }
}

static void make_marks(tobi_spots *s)
{
    size_t size = strlen(s->text);
    int line = 1, column = 1;
    s->mark = malloc((size/MARK_BYTES + 1)*sizeof *s->mark);
    for (size_t k = 0; s->mark && k <= size/MARK_BYTES; k++) {
        s->mark[k] = (tobi_spot_mark){ line, column };
        if (k < size/MARK_BYTES) count_on(s->text, k*MARK_BYTES, (k + 1)*MARK_BYTES, &line, &column);
    }
}

/* Without memory places are found as deep as the index goes, and lines from the start. */
static void make_ready(tobi_spots *s)
{
    if (s->ready) return;
    s->ready = 1;
    make_marks(s);
    size_t root = tobi_spots_root(s).value;
    if (is_open(s->text[root])) list_nodes(s, root);
    if (s->count > 1) qsort(s->node, s->count, sizeof *s->node, order_nodes);
}

tobi_spot tobi_spots_root(const tobi_spots *s)
{
    size_t at = skip_space(s->text, 0);
    return (tobi_spot){ at, at };
}

/* The first node behind all of this container and name. */
static size_t find_end(const tobi_spots *s, size_t in, uint32_t name)
{
    size_t low = 0, high = s->count;
    while (low < high) {
        size_t middle = (low + high)/2;
        const tobi_spot_node *n = &s->node[middle];
        if (n->in < in || (n->in == in && n->name <= name)) low = middle + 1;
        else high = middle;
    }
    return low;
}

int tobi_spots_member(tobi_spots *s, tobi_spot in, const char *key, tobi_spot *found)
{
    make_ready(s);
    const uint32_t name = hash(key, strlen(key));
    if (s->text[in.value] != '{') return 0;
    for (size_t k = find_end(s, in.value, name); k > 0; k--) {
        const tobi_spot_node *n = &s->node[k - 1];
        if (n->in != in.value || n->name != name) break;
        char *its = tobi_spots_key(s->text, n->key);
        const int same = its && strcmp(its, key) == 0;
        free(its);
        if (!same) continue;
        *found = (tobi_spot){ n->key, n->value };
        return 1;
    }
    return 0;
}

int tobi_spots_entry(tobi_spots *s, tobi_spot in, size_t index, tobi_spot *found)
{
    make_ready(s);
    if (s->text[in.value] != '[') return 0;
    const size_t k = find_end(s, in.value, (uint32_t)index);
    if (k > 0 && s->node[k - 1].in == in.value && s->node[k - 1].name == index) {
        *found = (tobi_spot){ s->node[k - 1].value, s->node[k - 1].value };
        return 1;
    }
    for (size_t at = tobi_spots_enter(s->text, in.value); s->text[at] && s->text[at] != ']'; index--) {
        if (index == 0) {
            *found = (tobi_spot){ at, at };
            return 1;
        }
        at = tobi_spots_go_on(s->text, tobi_spots_skip(s->text, at));
    }
    return 0;
}

void tobi_spots_line(tobi_spots *s, size_t offset, int *line, int *column)
{
    make_ready(s);
    const size_t k = s->mark ? offset/MARK_BYTES : 0;
    *line = s->mark ? s->mark[k].line : 1;
    *column = s->mark ? s->mark[k].column : 1;
    count_on(s->text, k*MARK_BYTES, offset, line, column);
}

void tobi_spots_clear(tobi_spots *s)
{
    free(s->node);
    free(s->mark);
    *s = (tobi_spots){ 0 };
}
