/* Loop guards by rewriting the text, token by token, before it is compiled.

   LuaJIT's count hooks do not fire in compiled code, and timers are neither deterministic nor
   allowed in a library. A call that counts works in both modes, costs about a nanosecond once
   compiled and stops at the same place every time. Drawback: this file must know Lua's tokens (not
   its grammar). The calls go on the same line, so line numbers in messages stay true. */
#include "rigid/script_guard.h"
#include <ctype.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define CALL " " TOBI_SCRIPT_TICK "(); "

typedef struct scanner {
    const char *p, *end;      /* rest of the text                       */
    char *out;                /* guarded text                           */
    size_t used, room;
    bool failed;              /* memory ran out                         */
} scanner;

static void emit(scanner *s, const char *text, size_t length)
{
    if (s->failed) return;
    if (s->used + length + 1 > s->room) {
        size_t room = 2 * (s->used + length + 1);
        char *bigger = realloc(s->out, room);
        if (!bigger) {
            s->failed = true;
            return;
        }
        s->out = bigger;
        s->room = room;
    }
    memcpy(s->out + s->used, text, length);
    s->used += length;
    s->out[s->used] = '\0';
}

/* Length of a long bracket's opening `[==[` at p, 0 if there is none. */
static size_t open_bracket(const char *p, const char *end)
{
    const char *q = p + 1;
    if (p >= end || *p != '[') return 0;
    while (q < end && *q == '=') q++;
    return q < end && *q == '[' ? (size_t)(q - p + 1) : 0;
}

/* First character after the long bracket whose opening has the given length. */
static const char *skip_bracket(const char *p, const char *end, size_t open)
{
    for (p += open; p < end; p++) {
        if (*p != ']' || (size_t)(end - p) < open || p[open - 1] != ']') continue;
        size_t level = 1;
        while (level < open - 1 && p[level] == '=') level++;
        if (level == open - 1) return p + open;
    }
    return end;
}

static const char *skip_quoted(const char *p, const char *end)
{
    char quote = *p++;
    while (p < end && *p != quote && *p != '\n') p += *p == '\\' && p + 1 < end ? 2 : 1;
    return p < end ? p + 1 : end;
}

static bool is_word_start(char c) { return isalpha((unsigned char)c) || c == '_' || (c & 0x80); }
static bool is_word(char c) { return is_word_start(c) || isdigit((unsigned char)c); }

/* End of the token, blank run or comment at p. */
static const char *skip_token(const char *p, const char *end)
{
    size_t open = open_bracket(p, end);
    if (open) return skip_bracket(p, end, open);
    if (end - p >= 2 && p[0] == '-' && p[1] == '-') {
        open = open_bracket(p + 2, end);
        if (open) return skip_bracket(p + 2, end, open);
        while (p < end && *p != '\n') p++;
        return p;
    }
    if (*p == '"' || *p == '\'') return skip_quoted(p, end);
    if (isdigit((unsigned char)*p)) {
        while (p < end && (is_word(*p) || *p == '.')) p++;
        return p;
    }
    if (!is_word_start(*p)) return p + 1;
    while (p < end && is_word(*p)) p++;
    return p;
}

static bool is_blank(const char *p, const char *end)
{
    return isspace((unsigned char)*p) || (end - p >= 2 && p[0] == '-' && p[1] == '-');
}

/* First character at or after p that is neither blank nor comment. */
static const char *skip_blanks(const char *p, const char *end)
{
    while (p < end && is_blank(p, end)) p = skip_token(p, end);
    return p;
}

static bool equals(const char *p, size_t length, const char *word)
{
    return strlen(word) == length && memcmp(p, word, length) == 0;
}

/* `goto` is a jump only before a name; elsewhere LuaJIT reads it as an ordinary name. */
static bool is_jump(const char *after, const char *end)
{
    const char *next = skip_blanks(after, end);
    return next > after && next < end && is_word_start(*next);
}

/* Copies one word with the guard it needs. */
static void guard_word(scanner *s, const char *word, size_t length, bool *in_header)
{
    const char *after = word + length;
    if (equals(word, length, "goto") && is_jump(after, s->end)) {
        emit(s, CALL, sizeof CALL - 1);
        emit(s, word, length);
        return;
    }
    emit(s, word, length);
    if (equals(word, length, "do") || equals(word, length, "repeat"))
        emit(s, CALL, sizeof CALL - 1);
    if (equals(word, length, "function")) *in_header = true;
}

char *tobi_script_guard(const char *text, size_t length, tobi_error *err)
{
    scanner s = { .p = text, .end = text + length };
    bool in_header = false;      /* between `function` and the `)` of its parameters */
    int line = 1;
    emit(&s, "", 0);
    while (s.p < s.end && !s.failed) {
        const char *from = s.p;
        s.p = skip_token(from, s.end);
        size_t n = (size_t)(s.p - from);
        if (is_word_start(*from) && equals(from, n, TOBI_SCRIPT_TICK)) {
            free(s.out);
            tobi_fail(err, TOBI_SCRIPT, "line %d: the name '%s' is reserved", line,
                      TOBI_SCRIPT_TICK);
            return NULL;
        }
        for (const char *q = from; q < s.p; q++) line += *q == '\n';
        if (is_word_start(*from)) {
            guard_word(&s, from, n, &in_header);
            continue;
        }
        emit(&s, from, n);
        if (in_header && *from == ')') {
            emit(&s, CALL, sizeof CALL - 1);
            in_header = false;
        }
    }
    if (!s.failed) return s.out;
    free(s.out);
    tobi_fail(err, TOBI_NO_MEMORY, "motion script: out of memory");
    return NULL;
}
