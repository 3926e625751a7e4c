/* A reader of literals and arithmetic, no interpreter: a parameter file cannot do anything. Drawback:
   a file that computes its values in functions is refused. */
#define _GNU_SOURCE 1
#include "scene/python.h"
#include <ctype.h>
#include <jansson.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef enum node_kind { NUMBER, TEXT, WORD, LIST, DICT } node_kind;

/* A value of the file. WORD: true, false or null, in `text`. Names given before share their value.
   */
typedef struct node {
    node_kind kind;
    size_t at;                 /* where it stands                         */
    double number;
    int whole;                 /* a number without a point                */
    char *text;                /* owned                                   */
    struct entry *first, *last;   /* of lists and dicts                   */
    struct node *made_before;  /* all nodes, for the end                  */
} node;

typedef struct entry {
    char *key;                 /* owned; NULL in lists                    */
    size_t at;
    node *value;
    struct entry *next, *made_before;
} entry;

typedef struct reader {
    const char *name;
    char *text;                /* wrapped tails of comments blanked       */
    size_t at;
    int depth;                 /* of brackets                             */
    int nested;                /* values within values                    */
    int failed, no_memory;
    node *nodes;
    entry *entries;
    node *file;                /* a dict: what has been assigned          */
    int names;                 /* in it                                   */
    tobi_report *report;
} reader;

enum { DEPTH_LIMIT = 30, NAME_LIMIT = 1000 };      /* names are looked up one by one */

static void refuse(reader *r, size_t at, const char *format, ...) __attribute__((format(printf, 3, 4)));

static void refuse(reader *r, size_t at, const char *format, ...)
{
    char what[200];
    int line = 1, column = 1;
    va_list args;
    va_start(args, format);
    vsnprintf(what, sizeof what, format, args);
    va_end(args);
    for (size_t i = 0; i < at; i++) {
        column = r->text[i] == '\n' ? 1 : column + (((unsigned char)r->text[i] & 0xC0) != 0x80);
        line += r->text[i] == '\n';
    }
    if (!r->failed) tobi_report_add(r->report, at, "%s:%d:%d: %s", r->name, line, column, what);
    r->failed = 1;
}

static node *make(reader *r, node_kind kind, size_t at)
{
    node *n = calloc(1, sizeof *n);
    if (!n) {
        r->no_memory = r->failed = 1;
        return NULL;
    }
    *n = (node){ .kind = kind, .at = at, .made_before = r->nodes };
    r->nodes = n;
    return n;
}

/* Appends to a list or dict; takes key over. */
static void append(reader *r, node *to, char *key, size_t at, node *value)
{
    entry *e = calloc(1, sizeof *e);
    if (!e) {
        free(key);
        r->no_memory = r->failed = 1;
        return;
    }
    *e = (entry){ .key = key, .at = at, .value = value, .made_before = r->entries };
    r->entries = e;
    if (to->last) to->last->next = e;
    else to->first = e;
    to->last = e;
}

/* --- blanks and comments ----------------------------------------------------------------- */

/* Where the comment of the line at `at` begins, or its end. foreign: it holds letters that Python
   has only in texts, and no quote, bracket or = that could make a statement of it. */
static size_t find_comment(const char *text, size_t at, int *foreign)
{
    char quote = 0;
    int letters = 0, structure = 0;
    for (; text[at] && text[at] != '\n' && (quote || text[at] != '#'); at++) {
        char c = text[at];
        if (quote && c == '\\' && text[at + 1] && text[at + 1] != '\n') at++;
        else if (quote) quote = c == quote ? 0 : quote;
        else if (c == '\'' || c == '"') quote = c;
        structure |= quote || strchr("[]{}()=", c) != NULL;
        letters |= (unsigned char)c >= 0x80;
    }
    *foreign = letters && !structure;
    return at;
}

/* A comment copied from a page may have wrapped: its tail stands on a line of its own. */
static void blank_comments(char *text)
{
    int after_comment = 0;
    for (size_t at = 0; text[at];) {
        size_t begin = at + strspn(text + at, " \t\r");
        int foreign, blank = text[begin] == '\n' || !text[begin];
        size_t comment = find_comment(text, at, &foreign), end = comment + strcspn(text + comment, "\n");
        int tail = after_comment && foreign;
        for (size_t i = tail ? at : comment; i < end; i++) text[i] = ' ';
        if (!blank) after_comment = tail || comment < end;
        at = end + (text[end] == '\n');
    }
}

/* Within brackets a statement goes on over the end of its line. */
static void skip_blanks(reader *r)
{
    while (strchr(r->depth ? " \t\r\n" : " \t\r", r->text[r->at]) && r->text[r->at]) r->at++;
}

static int take(reader *r, char c)
{
    skip_blanks(r);
    if (r->failed || r->text[r->at] != c) return 0;
    r->at++;
    return 1;
}

/* --- values ------------------------------------------------------------------------------ */

static node *read_sum(reader *r);

static char *read_text(reader *r)
{
    char quote = r->text[r->at++], *out = malloc(strlen(r->text + r->at) + 1);
    size_t n = 0, begin = r->at - 1;
    if (!out) {
        r->no_memory = r->failed = 1;
        return NULL;
    }
    for (; r->text[r->at] && r->text[r->at] != '\n' && r->text[r->at] != quote; r->at++) {
        if (r->text[r->at] == '\\' && (!r->text[++r->at] || !strchr("\\'\"", r->text[r->at])))
            refuse(r, r->at - 1, tr("a \\ in a text is not read, but for \\\\, \\' and \\\""));
        if (r->failed) break;
        out[n++] = r->text[r->at];
    }
    out[n] = '\0';
    if (!r->failed && r->text[r->at] != quote) refuse(r, begin, tr("a text does not end in its line"));
    r->at += !r->failed;
    json_t *test = json_string(out);
    if (!test) refuse(r, begin, tr("a text is not UTF-8"));
    json_decref(test);
    return out;
}

static node *read_number(reader *r)
{
    node *n = make(r, NUMBER, r->at);
    char *end;
    double value = strtod(r->text + r->at, &end);
    size_t length = (size_t)(end - (r->text + r->at));
    if (!n) return NULL;
    n->number = value;
    n->whole = !memchr(r->text + r->at, '.', length) && !memchr(r->text + r->at, 'e', length) &&
               !memchr(r->text + r->at, 'E', length);
    if (memchr(r->text + r->at, 'x', length) || memchr(r->text + r->at, 'X', length))
        refuse(r, r->at, tr("numbers are decimal here"));
    r->at += length;
    if (isalnum((unsigned char)*end) || *end == '_' || *end == '.')
        refuse(r, n->at, tr("\"%.20s\" is no number"), r->text + n->at);
    if (!isfinite(value)) refuse(r, n->at, tr("the number is too large"));
    return n;
}

static node *find_name(const reader *r, const char *name)
{
    node *found = NULL;
    for (const entry *e = r->file->first; e; e = e->next)
        if (strcmp(e->key, name) == 0) found = e->value;
    return found;
}

static size_t name_length(const char *text)
{
    size_t n = 0;
    while (isalnum((unsigned char)text[n]) || text[n] == '_') n++;
    return n;
}

static node *read_name(reader *r)
{
    static const char *const words[][2] = { { "True", "true" }, { "False", "false" }, { "None", "null" } };
    size_t at = r->at, length = name_length(r->text + at);
    char name[64];
    snprintf(name, sizeof name, "%.*s", (int)length, r->text + at);
    r->at += length;
    for (int i = 0; i < 3; i++) {
        node *n = strcmp(name, words[i][0]) == 0 ? make(r, WORD, at) : NULL;
        if (!n) continue;
        n->text = strdup(words[i][1]);
        r->no_memory |= !n->text;
        return n;
    }
    node *known = find_name(r, name);
    skip_blanks(r);
    if (r->text[r->at] == '(' || r->text[r->at] == '.' || r->text[r->at] == '[')
        refuse(r, at, tr("%s%c..: calls, members and entries are not read; write the number"), name,
               r->text[r->at]);
    if (!known) refuse(r, at, tr("the name \"%s\" is given nowhere above"), name);
    else if (known->kind == LIST || known->kind == DICT)
        refuse(r, at, tr("%s is a list or dict; values refer to numbers and texts only"), name);
    return known;
}

/* ( ... ) around one value is that value, a list otherwise; [ ... ] is a list. */
static node *read_list(reader *r, char open)
{
    char close = open == '(' ? ')' : ']';
    node *list = make(r, LIST, r->at++);
    int commas = 0;
    r->depth++;
    while (!r->failed && !take(r, close)) {
        node *value = read_sum(r);
        if (r->failed) break;
        append(r, list, NULL, value->at, value);
        if (take(r, ',')) commas++;
        else if (skip_blanks(r), r->text[r->at] != close) refuse(r, r->at, tr("expected , or %c"), close);
    }
    r->depth--;
    return !r->failed && open == '(' && !commas && list->first ? list->first->value : list;
}

static node *read_dict(reader *r)
{
    node *dict = make(r, DICT, r->at++);
    r->depth++;
    while (!r->failed && !take(r, '}')) {
        skip_blanks(r);
        size_t at = r->at;
        if (r->text[at] != '"' && r->text[at] != '\'') {
            refuse(r, at, tr("expected a key, a text in quotes, or }"));
            break;
        }
        char *key = read_text(r);
        if (!r->failed && !take(r, ':')) refuse(r, r->at, tr("expected : behind the key \"%s\""), key);
        node *value = r->failed ? NULL : read_sum(r);
        if (r->failed) free(key);
        else append(r, dict, key, at, value);
        if (!take(r, ',') && (skip_blanks(r), r->text[r->at] != '}'))
            refuse(r, r->at, tr("expected , or } in the dict"));
    }
    r->depth--;
    return dict;
}

static node *read_value(reader *r)
{
    skip_blanks(r);
    char c = r->text[r->at];
    if (r->failed) return NULL;
    if (c == '(' || c == '[') return read_list(r, c);
    if (c == '{') return read_dict(r);
    if (isdigit((unsigned char)c) || c == '.') return read_number(r);
    if (isalpha((unsigned char)c) || c == '_') return read_name(r);
    if (c == '"' || c == '\'') {
        node *n = make(r, TEXT, r->at);
        char *text = read_text(r);
        if (n) n->text = text;
        else free(text);
        return n;
    }
    refuse(r, r->at, tr("expected a value: a number, a text, ( ), [ ], { } or a name given above"));
    return NULL;
}

static node *operate(reader *r, size_t at, char op, const node *a, const node *b)
{
    if (r->failed) return NULL;
    if (a->kind != NUMBER || b->kind != NUMBER) refuse(r, at, tr("%c is read between numbers only"), op);
    node *n = make(r, NUMBER, a->at);
    if (!n) return NULL;
    double x = a->number, y = b->number;
    n->number = op == '+' ? x + y : op == '-' ? x - y : op == '*' ? x*y : op == '/' ? x/y : pow(x, y);
    n->whole = a->whole && b->whole && op != '/' && n->number == floor(n->number);
    if (!r->failed && !isfinite(n->number)) refuse(r, at, tr("the result is no finite number"));
    return n;
}

/* - and + in front bind weaker than **, as in Python. */
static node *read_factor(reader *r)
{
    if (++r->nested > DEPTH_LIMIT) refuse(r, r->at, tr("more than %d values within each other"), DEPTH_LIMIT);
    skip_blanks(r);
    const size_t at = r->at;
    const node minus = { .kind = NUMBER, .number = -1, .whole = 1, .at = at };
    int negative = take(r, '-');
    if (!negative) take(r, '+');
    node *base = read_value(r);
    skip_blanks(r);
    if (!r->failed && strncmp(r->text + r->at, "**", 2) == 0) {
        r->at += 2;
        base = operate(r, at, '^', base, read_factor(r));
    }
    r->nested--;
    return negative ? operate(r, at, '*', &minus, base) : base;
}

/* Operands with these operators between them, from the left. */
static node *read_row(reader *r, const char *operators, node *(*read_operand)(reader *))
{
    node *left = read_operand(r);
    for (;;) {
        skip_blanks(r);
        const char op = r->text[r->at];
        if (r->failed || !op || !strchr(operators, op)) return left;
        const size_t at = r->at++;
        if (strchr("*/", op) && r->text[r->at] == op) refuse(r, r->at, tr("the operators are + - * / **"));
        node *right = read_operand(r);
        left = operate(r, at, op, left, right);
    }
}

static node *read_product(reader *r) { return read_row(r, "*/", read_factor); }

static node *read_sum(reader *r) { return read_row(r, "+-", read_product); }

/* --- statements -------------------------------------------------------------------------- */

/* a, b, c without brackets is a tuple. */
static node *read_right_side(reader *r)
{
    node *value = read_sum(r), *list = NULL;
    while (take(r, ',')) {
        if (!list && !(list = make(r, LIST, value->at))) break;
        if (!list->first) append(r, list, NULL, value->at, value);
        skip_blanks(r);
        if (strchr("\n", r->text[r->at])) break;
        node *more = read_sum(r);
        if (more) append(r, list, NULL, more->at, more);
    }
    return list ? list : value;
}

static void read_statement(reader *r)
{
    size_t at = r->at, length = name_length(r->text + at);
    char *name = strndup(r->text + at, length);
    int import = length && (strcmp(name, "import") == 0 || strcmp(name, "from") == 0);
    if (!name) r->no_memory = r->failed = 1;
    else if (import) r->at = at + strcspn(r->text + at, "\n");
    else {
        r->at = at + length;
        if (!length || isdigit((unsigned char)name[0]) || !take(r, '=') || r->text[r->at] == '=')
            refuse(r, at, tr("is not read; a parameter file has lines NAME = VALUE, and import lines"));
        if (r->names++ >= NAME_LIMIT) refuse(r, at, tr("is one name too many; allowed are %d"), NAME_LIMIT);
        node *value = r->failed ? NULL : read_right_side(r);
        if (!r->failed) {
            append(r, r->file, name, at, value);
            name = NULL;
        }
        skip_blanks(r);
        if (!r->failed && r->text[r->at] && r->text[r->at] != '\n' && r->text[r->at] != ';')
            refuse(r, r->at, tr("expected the end of the line"));
    }
    free(name);
}

/* After a mistake reading goes on at the next line that begins like a statement. */
static void skip_statement(reader *r)
{
    do {
        r->at += strcspn(r->text + r->at, "\n");
        r->at += r->text[r->at] == '\n';
    } while (r->text[r->at] && !isalpha((unsigned char)r->text[r->at]));
}

static int read_file(reader *r)
{
    int mistakes = 0;
    while (r->text[r->at]) {
        int new_line = r->at == 0 || r->text[r->at - 1] == '\n';
        size_t indent = strspn(r->text + r->at, " \t\r");
        r->at += indent;
        if (!r->text[r->at]) break;
        if (r->text[r->at] == '\n' || r->text[r->at] == ';') {
            r->at++;
            continue;
        }
        if (new_line && indent) refuse(r, r->at, tr("is indented; a parameter file has no blocks"));
        else read_statement(r);
        if (!r->failed) continue;
        mistakes++;
        if (r->no_memory || tobi_report_full(r->report)) return mistakes;
        r->failed = r->depth = r->nested = 0;
        skip_statement(r);
    }
    return mistakes;
}

/* --- JSON -------------------------------------------------------------------------------- */

typedef struct writer { FILE *out; const char *text; size_t at; int line, column, want_line, want_column; }
    writer;

/* Moves on to the line of offset `at`, and to its column if that is still ahead. Offsets only rise,
   but for values of names given before. */
static void reach(writer *w, size_t at)
{
    if (at < w->at) return;
    for (; w->at < at; w->at++) {
        int end = w->text[w->at] == '\n';
        w->want_column = end ? 1 : w->want_column + (((unsigned char)w->text[w->at] & 0xC0) != 0x80);
        w->want_line += end;
    }
    for (; w->line < w->want_line; w->line++, w->column = 1) fputc('\n', w->out);
    for (; w->column < w->want_column; w->column++) fputc(' ', w->out);
}

static void put(writer *w, const char *text)
{
    fputs(text, w->out);
    for (; *text; text++) w->column += ((unsigned char)*text & 0xC0) != 0x80;
}

static void put_text(writer *w, const char *text)
{
    json_t *value = json_string(text);
    char *dump = value ? json_dumps(value, JSON_ENCODE_ANY) : NULL;
    put(w, dump ? dump : "null");
    free(dump);
    json_decref(value);
}

static void write_node(writer *w, const node *n)
{
    char number[40];
    reach(w, n->at);
    if (n->kind == NUMBER) {
        snprintf(number, sizeof number, n->whole && fabs(n->number) < 1e15 ? "%.0f" : "%.17g", n->number);
        put(w, number);
    } else if (n->kind == TEXT) {
        put_text(w, n->text);
    } else if (n->kind == WORD) {
        put(w, n->text);
    } else {
        put(w, n->kind == LIST ? "[" : "{");
        for (const entry *e = n->first; e; e = e->next) {
            reach(w, e->at);
            if (e->key) put_text(w, e->key);
            if (e->key) put(w, ":");
            write_node(w, e->value);
            if (e->next) put(w, ",");
        }
        put(w, n->kind == LIST ? "]" : "}");
    }
}

static tobi_status write_json(const reader *r, char **json)
{
    size_t size = 0;
    writer w = { .out = open_memstream(json, &size), .text = r->text, .line = 1, .column = 1, .want_line = 1,
                 .want_column = 1 };
    if (!w.out) return TOBI_NO_MEMORY;
    write_node(&w, r->file);
    return fclose(w.out) == 0 ? TOBI_OK : TOBI_NO_MEMORY;
}

int tobi_python_applies(const char *name)
{
    size_t n = strlen(name);
    return n > 3 && strcmp(name + n - 3, ".py") == 0;
}

static void clear(reader *r)
{
    for (node *n = r->nodes, *before; n; n = before) {
        before = n->made_before;
        free(n->text);
        free(n);
    }
    for (entry *e = r->entries, *before; e; e = before) {
        before = e->made_before;
        free(e->key);
        free(e);
    }
    free(r->text);
}

tobi_status tobi_python_to_json(const char *name, const char *text, size_t size, char **json,
                                tobi_report *report, tobi_error *err)
{
    reader r = { .name = name, .report = report, .text = strndup(text, size) };
    tobi_status status = TOBI_OK;
    *json = NULL;
    if (r.text && strncmp(r.text, "\xEF\xBB\xBF", 3) == 0) r.at = 3;       /* a byte-order mark */
    if (r.text) r.file = make(&r, DICT, 0);
    if (r.file) {
        blank_comments(r.text);
        if (read_file(&r)) status = TOBI_INVALID;
    }
    if (!r.file || r.no_memory) status = TOBI_NO_MEMORY;
    if (status == TOBI_OK) status = write_json(&r, json);
    clear(&r);
    return status == TOBI_NO_MEMORY ? tobi_fail(err, status, "no memory for the scene") : status;
}
