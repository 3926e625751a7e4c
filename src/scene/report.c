/* Mistakes are sorted by their place and shown up to a limit. Drawback: what lies beyond the limit
   shows after the first are mended. */
#define _GNU_SOURCE 1
#include "scene/report.h"
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct ranked { char *text; size_t rank; int order; } ranked;

struct tobi_report {
    ranked *lines;
    int count;             /* lines stored                    */
    int capacity;
    int64_t left_out;      /* counted, not stored             */
    int no_memory;         /* a line was lost                 */
};

tobi_report *tobi_report_create(void) { return calloc(1, sizeof(tobi_report)); }

int tobi_report_count(const tobi_report *report) { return report ? report->count : 0; }

const char *tobi_report_line(const tobi_report *report, int line)
{
    return report && line >= 0 && line < report->count ? report->lines[line].text : NULL;
}

void tobi_report_free(tobi_report *report)
{
    if (!report) return;
    for (int i = 0; i < report->count; i++) free(report->lines[i].text);
    free(report->lines);
    free(report);
}

int tobi_report_full(const tobi_report *report) { return report->count >= TOBI_REPORT_LIMIT; }

int tobi_report_pass(tobi_report *report)
{
    const int full = tobi_report_full(report);
    report->left_out += full;
    return full;
}

int64_t tobi_report_total(const tobi_report *report)
{
    return report->count + report->left_out + report->no_memory;
}

static void store_line(tobi_report *report, size_t rank, const char *format, va_list args)
{
    if (report->count == report->capacity) {
        int capacity = report->capacity ? 2*report->capacity : 16;
        ranked *lines = realloc(report->lines, (size_t)capacity*sizeof *lines);
        if (!lines) {
            report->no_memory = 1;
            return;
        }
        report->lines = lines;
        report->capacity = capacity;
    }
    char *line = NULL;
    if (vasprintf(&line, tobi_text(format), args) < 0) {
        report->no_memory = 1;
        return;
    }
    for (char *c = line; *c; c++)
        if (iscntrl((unsigned char)*c)) *c = '?';      /* no escape sequences on a terminal */
    report->lines[report->count] = (ranked){ line, rank, report->count };
    report->count++;
}

void tobi_report_add(tobi_report *report, size_t rank, const char *format, ...)
{
    if (tobi_report_full(report)) {
        report->left_out++;
        return;
    }
    va_list args;
    va_start(args, format);
    store_line(report, rank, format, args);
    va_end(args);
}

static void store_last(tobi_report *report, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    store_line(report, SIZE_MAX, format, args);
    va_end(args);
}

static int order_lines(const void *a, const void *b)
{
    const ranked *x = a, *y = b;
    if (x->rank != y->rank) return x->rank < y->rank ? -1 : 1;
    return x->order - y->order;
}

void tobi_report_close(tobi_report *report)
{
    if (report->count)
        qsort(report->lines, (size_t)report->count, sizeof *report->lines, order_lines);
    if (report->left_out)
        store_last(report, TR("... and %lld more mistakes"), (long long)report->left_out);
    report->left_out = 0;
}

tobi_status tobi_report_fail(const tobi_report *report, tobi_error *err)
{
    if (report->no_memory || report->count == 0)
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the report of a scene's mistakes");
    if (!err) return TOBI_INVALID;
    err->status = TOBI_INVALID;
    size_t used = 0, room = sizeof err->text - 40;     /* leaves place for the last line */
    int i = 0;
    for (; i < report->count; i++) {
        size_t length = strlen(report->lines[i].text);
        if (used + length + 1 > room) break;
        if (i) err->text[used++] = '\n';
        memcpy(err->text + used, report->lines[i].text, length);
        used += length;
    }
    err->text[used] = '\0';
    if (i < report->count)
        snprintf(err->text + used, sizeof err->text - used, tr("%s... and %d more lines"),
                 i ? "\n" : "", report->count - i);
    return TOBI_INVALID;
}
