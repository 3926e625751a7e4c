/* The help of the program and of its commands, and what is said of options that a command does not know. The
   texts are those of argp's tables, in the language of the user. argp prints such things itself, but breaks
   lines between words only, which Japanese does not separate, and speaks by the locale of the C library.
   Drawback: argp's groups and hidden options are not known here. */
#include "app.h"
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

enum { NAMES = 28, LEAST_COLUMNS = 60, MOST_COLUMNS = 100 };
enum { KEY_HELP = 'h', KEY_QUESTION = '?', KEY_USAGE = 0x1000 };

static const struct argp_option common[] = {
    { "language", KEY_LANGUAGE, "LANGUAGE", 0,
      "ja (Japanese) or en (English); by default as LC_ALL, LC_MESSAGES or LANG says", 0 },
    { "help", KEY_HELP, NULL, 0, "print this help", 0 },
    { NULL, KEY_QUESTION, NULL, OPTION_ALIAS | OPTION_HIDDEN, NULL, 0 },
    { "usage", KEY_USAGE, NULL, 0, "print the first line of it", 0 },
    { 0 }
};
const struct argp_option *common_options(void) { return common; }

/* --- lines ---------------------------------------------------------------------------------- */

/* Columns of so many bytes of UTF-8: the letters of Japanese take two. */
static int count_columns(const char *text, size_t bytes)
{
    int columns = 0;
    for (size_t k = 0; k < bytes && text[k]; k++) {
        const unsigned char c = (unsigned char)text[k];
        columns += c >= 0xe3 ? 2 : c < 0x80 || c >= 0xc0;
    }
    return columns;
}

static size_t letter_bytes(const char *c)
{
    const unsigned char first = (unsigned char)*c;
    size_t bytes = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : first >= 0xc0 ? 2 : 1, k = 1;
    while (k < bytes && c[k]) k++;
    return first ? k : 0;
}

static int is_among(const char *letters, const char *c)
{
    const size_t bytes = letter_bytes(c);
    for (const char *l = letters; *l; l += letter_bytes(l))
        if (letter_bytes(l) == bytes && strncmp(l, c, bytes) == 0) return 1;
    return 0;
}

size_t piece_bytes(const char *text)
{
    const char *c = text;
    while (*c && is_among("（「", c)) c += letter_bytes(c);
    if ((unsigned char)*c >= 0xe3) c += letter_bytes(c);
    else while (*c && *c != ' ' && *c != '\n' && (unsigned char)*c < 0xe3) c += letter_bytes(c);
    while (*c && is_among("、。，．・：；？！）」ーぁぃぅぇぉっゃゅょァィゥェォッャュョ", c)) c += letter_bytes(c);
    return (size_t)(c - text);
}

static int line_columns(FILE *file)
{
    const int columns = terminal_columns(file);
    if (columns == 0) return 80;
    return columns < LEAST_COLUMNS ? LEAST_COLUMNS : columns > MOST_COLUMNS ? MOST_COLUMNS : columns;
}

/* In lines that begin at column `indent`, where the first one has begun already. What follows '\n' has lines
   of its own. */
static void print_lines(FILE *file, const char *text, int indent)
{
    const int end = line_columns(file) - 1;
    int at = indent;
    while (*text && *text != '\n') {
        const size_t blanks = strspn(text, " "), bytes = piece_bytes(text + blanks);
        const int columns = count_columns(text + blanks, bytes);
        if (at > indent && at + (int)blanks + columns > end) {
            fprintf(file, "\n%*s", indent, "");
            at = indent;
        } else {
            fprintf(file, "%*s", (int)blanks, "");
            at += (int)blanks;
        }
        fwrite(text + blanks, 1, bytes, file);
        at += columns;
        text += blanks + bytes;
    }
    fputc('\n', file);
    if (*text) fprintf(file, "\n%s\n", text + 1);
}

/* --- the program ---------------------------------------------------------------------------- */

void print_usage(FILE *file)
{
    const command *c;
    fprintf(file, tr("usage: tobiuo COMMAND [ARGUMENTS]\n\n"));
    for (int k = 0; (c = command_at(k)); k++) {
        fprintf(file, "  %s%-8s%s %-10s ", colour(file, BOLD), c->name, colour(file, PLAIN), c->arguments);
        print_lines(file, tr(c->doc), 22);
    }
    fprintf(file, tr("\n\"tobiuo help COMMAND\" lists the options of a command. Begin with:\n"
                     "  tobiuo new dam_break my_dam && tobiuo run my_dam\n"));
}

/* --- a command ------------------------------------------------------------------------------ */

static void print_option(const struct argp_option *o)
{
    char names[80];
    snprintf(names, sizeof names, o->key > 0 && o->key < 256 ? "  -%c, --%s%s%s" : "  %4.0d--%s%s%s",
             o->key > 0 && o->key < 256 ? o->key : 0, o->name, o->arg ? "=" : "", o->arg ? o->arg : "");
    const int columns = count_columns(names, sizeof names);
    if (columns < NAMES) printf("%-*s ", NAMES, names);
    else printf("%s\n%*s", names, NAMES + 1, "");
    print_lines(stdout, tr(o->doc), NAMES + 1);
}

static void print_head(const struct argp_state *state)
{
    const char *arguments = state->root_argp->args_doc;
    printf(tr("Usage: %s [OPTION...]%s%s\n"), state->name, arguments ? " " : "", arguments ? arguments : "");
}

static void print_help(const struct argp_state *state)
{
    print_head(state);
    print_lines(stdout, tr(state->root_argp->doc), 0);
    putchar('\n');
    for (const struct argp_option *o = state->root_argp->options; o && o->name; o++) print_option(o);
    for (const struct argp_option *o = common; o->key; o++)
        if (o->name) print_option(o);
}

/* --- wrong usage ---------------------------------------------------------------------------- */

void usage_error(const struct argp_state *state, const char *format, ...)
{
    va_list args;
    fprintf(stderr, "%s: ", state->name);
    va_start(args, format);
    vfprintf(stderr, format, args);
    va_end(args);
    fprintf(stderr, tr("\n\"%s --help\" lists the options.\n"), state->name);
    exit(EXIT_USAGE);
}

/* The options of a command, then those of all commands. */
static const struct argp_option *option_at(const struct argp_state *state, int index)
{
    const struct argp_option *own = state->root_argp->options;
    int count = 0;
    while (own && own[count].key) count++;
    if (index < count) return &own[index];
    return common[index - count].key ? &common[index - count] : NULL;
}

static void refuse_name(const struct argp_state *state, const char *word, size_t length)
{
    enum { MOST = 64 };
    const char *names[MOST], *near;
    const struct argp_option *o;
    char name[64];
    size_t count = 0;
    for (int k = 0; (o = option_at(state, k)) && count < MOST; k++)
        if (o->name) names[count++] = o->name;
    snprintf(name, sizeof name, "%.*s", (int)length - 2, word + 2);
    near = tobi_suggest(name, names, count);
    usage_error(state, tr("unrecognized option '%.*s'%s%s%s"), (int)length, word,
                near ? tr("; did you mean --") : "", near ? near : "", near ? "?" : "");
}

/* The option that "--word" means, whole or by its beginning. */
static const struct argp_option *find_long(const struct argp_state *state, const char *word)
{
    const size_t length = strcspn(word, "=");
    const struct argp_option *o, *found = NULL;
    int count = 0;
    for (int k = 0; (o = option_at(state, k)); k++) {
        if (!o->name || strncmp(o->name, word + 2, length - 2) != 0) continue;
        found = o, count++;
        if (strlen(o->name) == length - 2) { count = 1; break; }
    }
    if (count == 0) refuse_name(state, word, length);
    if (count > 1) usage_error(state, tr("option '%s' is ambiguous"), word);
    if (!found->arg && word[length]) usage_error(state, tr("option '--%s' takes no value"), found->name);
    return found;
}

/* -abc, where the last may have a value. Whether that is the next word. */
static int check_letters(const struct argp_state *state, const char *word, int is_last)
{
    for (const char *c = word + 1; *c; c++) {
        const struct argp_option *o;
        int k = 0;
        while ((o = option_at(state, k)) && o->key != (unsigned char)*c) k++;
        if (!o) usage_error(state, tr("unrecognized option '-%.*s'"), (int)letter_bytes(c), c);
        if (!o->arg) continue;
        if (!c[1] && is_last) usage_error(state, tr("option '-%c' wants a value"), *c);
        return !c[1];
    }
    return 0;
}

/* Finds what getopt did not take: that is silent, as it would speak by the locale. */
static void refuse_options(const struct argp_state *state)
{
    for (int k = 1; k < state->argc && strcmp(state->argv[k], "--") != 0; k++) {
        const char *word = state->argv[k];
        const int is_last = k + 1 == state->argc;
        if (strncmp(word, "--", 2) == 0) {
            const struct argp_option *o = find_long(state, word);
            if (!o->arg || strchr(word, '=')) continue;
            if (is_last) usage_error(state, tr("option '--%s' wants a value"), o->name);
            k++;
        } else if (word[0] == '-' && word[1]) {
            k += check_letters(state, word, is_last);
        }
    }
}

error_t parse_common(int key, char *value, struct argp_state *state)
{
    switch (key) {
    case KEY_HELP:
    case KEY_QUESTION: print_help(state); exit(0);
    case KEY_USAGE: print_head(state); exit(0);
    case KEY_LANGUAGE: parse_language(state, value); return 0;
    case ARGP_KEY_ARG: usage_error(state, tr("one argument too many: '%s'"), value); return 0;
    case ARGP_KEY_ERROR: refuse_options(state); return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}
