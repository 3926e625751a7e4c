/* Messages on stderr. */
#include "app.h"
#include "language.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int complain(const char *format, ...)
{
    va_list args;
    fprintf(stderr, "%stobiuo:%s ", colour(stderr, RED), colour(stderr, PLAIN));
    va_start(args, format);
    vfprintf(stderr, tr(format), args);
    va_end(args);
    fputc('\n', stderr);
    return EXIT_ERROR;
}

void print_notes(const tobi_world *world, FILE *file, const char *head)
{
    const char *text;
    for (int k = 0; (text = tobi_world_note(world, k)); k++) fprintf(file, "%s%s\n", head, text);
}

void print_columns(FILE *file, const char *text, int columns)
{
    for (; *text; text++) {
        const unsigned char c = (unsigned char)*text;
        const int wide = c >= 0xe3 ? 2 : c < 0x80 || c >= 0xc0;       /* letters of Japanese are wide */
        if (wide > columns) break;
        columns -= wide;
        fputc(c, file);
    }
    fprintf(file, "%*s", columns, "");
}

void print_label(const char *text) { print_columns(stdout, text, LABEL); }

int complain_scene(tobi_report *report, const tobi_error *err)
{
    int count = tobi_report_count(report);
    for (int k = 0; k < count; k++) complain("%s", tobi_report_line(report, k));
    if (count > 1) complain("%d mistakes", count);
    if (count == 0) complain("%s", err->text);
    tobi_report_free(report);
    return EXIT_ERROR;
}

int complain_run(const char *dir, const char *what)
{
    char *sweep = join_path(dir, "sweep.csv");
    const int is_sweep = access(sweep, F_OK) == 0;
    free(sweep);
    if (is_sweep)
        return complain("%s is a sweep: its runs are the folders in it, sweep.txt and sweep.svg compare them",
                        dir);
    char *near = near_run(dir);
    complain("%s: %s%s%s%s", dir, what, near ? tr("; did you mean ") : "", near ? near : "", near ? "?" : "");
    free(near);
    return EXIT_ERROR;
}

const char *shell_word(const char *text, char room[SHELL_WORD])
{
    const char *safe = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./+,:@%=";
    size_t used = 1;
    const char *c = text;
    while (*c && ((unsigned char)*c >= 0x80 || strchr(safe, *c))) c++;
    if (*text && !*c) return text;
    room[0] = '\'';
    for (c = text; *c; c++) {
        if (used + 6 > SHELL_WORD) return text;
        used += (size_t)sprintf(room + used, *c == '\'' ? "'\\''" : "%c", *c);
    }
    strcpy(room + used, "'");
    return room;
}
