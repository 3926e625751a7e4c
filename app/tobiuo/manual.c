/* The man page, in the language of the user, and the completion of words for bash. They are made from the
   commands and their options, so that neither can lag behind the program. Drawback: argp's groups are not
   known here. */
#define _GNU_SOURCE
#include "app.h"
#include <stdlib.h>
#include <string.h>

static void print_letter(char c)
{
    if (c == '\\') fputs("\\e", stdout);
    else if (c == '-') fputs("\\-", stdout);
    else putchar(c);
}

/* Lines for troff: a leading dot or quote would be a request, a backslash an escape, "-" a hyphen. Troff
   breaks lines of Japanese where "\:" allows it. What follows '\n' has lines of its own. */
static void print_text(const char *text)
{
    const char *own = strchr(text, '\n');
    for (size_t bytes; *text && text != own; text += bytes) {
        bytes = *text == ' ' ? 1 : piece_bytes(text);
        for (size_t k = 0; k < bytes; k++) print_letter(text[k]);
        const unsigned char last = (unsigned char)text[bytes - 1], next = (unsigned char)text[bytes];
        const int is_break = (next >= 0xe3 && last != ' ') || (last >= 0x80 && next && next != ' ');
        if (is_break) fputs("\\:", stdout);
    }
    putchar('\n');
    if (!own) return;
    puts(".nf");
    for (const char *c = own + 1; *c; c++) {
        if (*c == '\n') putchar('\n');
        else print_letter(*c);
    }
    puts("\n.fi");
}

static void print_option(const struct argp_option *o)
{
    printf(".TP\n.B ");
    if (o->key > 0 && o->key < 256) printf("\\-%c, ", o->key);
    printf("\\-\\-%s", o->name);
    if (o->arg) printf("\\fR=\\fI%s\\fR", o->arg);
    putchar('\n');
    print_text(tr(o->doc));
}

static void print_options(const struct argp_option *options)
{
    for (const struct argp_option *o = options; o && o->key; o++)
        if (o->name) print_option(o);
}

/* A term in bold or italics, and its meaning. */
static void print_term(const char *font, const char *term, const char *meaning)
{
    printf(".TP\n.%s %s\n", font, term);
    print_text(meaning);
}

static void print_section(const char *title) { printf(".SH \"%s\"\n", title); }

void print_man_page(void)
{
    const command *c;
    printf(".TH TOBIUO 1 \"\" \"tobiuo %s\" \"%s\"\n", tobi_version(), tr("User Commands"));
    if (strcmp(language_name(), "ja") == 0) puts(".ad l");        /* no blanks between words to widen */
    print_section(tr("NAME"));
    fputs("tobiuo \\- ", stdout);
    print_text(tr("water, soft solids and rigid bodies by particle methods"));
    print_section(tr("SYNOPSIS"));
    puts(".B tobiuo\n.I COMMAND\n[ARGUMENTS]");
    print_section(tr("COMMANDS"));
    for (int k = 0; (c = command_at(k)); k++) {
        printf(".SS tobiuo %s", c->name);
        if (*c->arguments) printf(" %s", c->arguments);
        putchar('\n');
        print_text(tr(c->argp->doc));
        print_options(c->argp->options);
    }
    print_section(tr("OPTIONS OF ALL COMMANDS"));
    print_options(common_options());
    print_section(tr("ENVIRONMENT"));
    print_term("B", "LC_ALL, LC_MESSAGES, LANG",
               tr("the language is Japanese, if the first of these that is set and not empty begins with "
                  "ja"));
    print_term("B", "NO_COLOR", tr("no colours, if set and not empty"));
    print_term("B", "OMP_WAIT_POLICY", tr("what waiting threads do; passive if not set"));
    print_section(tr("EXIT STATUS"));
    print_text(tr("0: done; 1: an error, told on standard error; 2: wrong usage; 3: a run to its end, of "
                  "which files could not be written; 130: stopped by Ctrl-C, with a checkpoint."));
    print_section(tr("FILES"));
    print_term("I", "scene.json", tr("a scene: \"tobiuo describe\" tells its keys"));
    print_term("I", "out/SCENE", tr("the results, if --out says nothing else"));
}

void print_completion(void)
{
    const command *c;
    printf("# bash completion of tobiuo, made by \"tobiuo --completion\"\n"
           "_tobiuo()\n{\n    local word=${COMP_WORDS[COMP_CWORD]} options= words=\n"
           "    if [ \"$COMP_CWORD\" = 1 ]; then\n        COMPREPLY=($(compgen -W \"");
    for (int k = 0; (c = command_at(k)); k++) printf("%s ", c->name);
    printf("help\" -- \"$word\"))\n        return\n    fi\n    case ${COMP_WORDS[1]} in\n");
    for (int k = 0; (c = command_at(k)); k++) {
        printf("    %s) options=\"", c->name);
        for (const struct argp_option *o = c->argp->options; o && o->name; o++) printf("--%s ", o->name);
        printf("--language --help\" ;;\n");
    }
    printf("    esac\n"
           "    case ${COMP_WORDS[1]} in\n"
           "    new) words=$(tobiuo scenes 2> /dev/null | sed -n 's/^  \\([a-z0-9_]*\\)  .*/\\1/p') ;;\n"
           "    describe) words=$(tobiuo describe 2> /dev/null | sed -n 's/^  \\([a-z]*\\) .*/\\1/p') ;;\n"
           "    esac\n"
           "    if [[ $word == -* ]]; then COMPREPLY=($(compgen -W \"$options\" -- \"$word\"))\n"
           "    else COMPREPLY=($(compgen -W \"$words\" -- \"$word\") $(compgen -f -- \"$word\")); fi\n"
           "}\ncomplete -o filenames -F _tobiuo tobiuo\n");
}
