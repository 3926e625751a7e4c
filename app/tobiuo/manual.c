/* The man page and the completion of words for bash, made from the commands and their options, so that
   neither can lag behind the program. Drawback: argp's groups and hidden options are not known here. */
#define _GNU_SOURCE
#include "app.h"
#include <stdlib.h>
#include <string.h>

/* Lines for troff: a leading dot or quote would be a request, a backslash an escape, "-" a hyphen. */
static void print_text(const char *text)
{
    for (const char *c = text; *c; c++) {
        if (*c == '\\') fputs("\\e", stdout);
        else if (*c == '-') fputs("\\-", stdout);
        else if (*c == '\v') fputs("\n.nf\n", stdout);
        else putchar(*c);
    }
    putchar('\n');
    if (strchr(text, '\v')) puts(".fi");
}

static void print_option(const struct argp_option *o)
{
    printf(".TP\n.B ");
    if (o->key > 0 && o->key < 256) printf("\\-%c, ", o->key);
    printf("\\-\\-%s", o->name);
    if (o->arg) printf("\\fR=\\fI%s\\fR", o->arg);
    putchar('\n');
    print_text(o->doc);
}

void print_man_page(void)
{
    const command *c;
    printf(".TH TOBIUO 1 \"\" \"tobiuo %s\" \"User Commands\"\n.SH NAME\n"
           "tobiuo \\- water, soft solids and rigid bodies by particle methods\n"
           ".SH SYNOPSIS\n.B tobiuo\n.I COMMAND\n[ARGUMENTS]\n.SH COMMANDS\n", tobi_version());
    for (int k = 0; (c = command_at(k)); k++) {
        printf(".SS tobiuo %s", c->name);
        if (*c->arguments) printf(" %s", c->arguments);
        putchar('\n');
        print_text(c->argp->doc);
        for (const struct argp_option *o = c->argp->options; o && o->name; o++) print_option(o);
    }
    puts(".SH ENVIRONMENT\n.TP\n.B NO_COLOR\nno colours, if set and not empty\n"
         ".TP\n.B OMP_WAIT_POLICY\nwhat waiting threads do; passive if not set\n"
         ".SH EXIT STATUS\n0: done; 1: an error, told on standard error; 2: wrong usage; 130: stopped by "
         "Ctrl\\-C, with a checkpoint.\n"
         ".SH FILES\n.TP\n.I scene.json\na scene: \"tobiuo describe\" tells its keys\n"
         ".TP\n.I out/SCENE\nthe results, if \\-\\-out says nothing else");
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
        printf("--help\" ;;\n");
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
