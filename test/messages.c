/* Linked into every unit test: notes which error messages the tests provoke, so that
   tools/check_messages.py can tell those that none does. The linker hands the calls over
   (--wrap); the library knows nothing of it. The formats go to the file $TOBIUO_MESSAGES, each
   ended by a zero. */
#include "base/error.h"
#include "scene/report.h"
#include "scene/source.h"
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

tobi_status __real_tobi_fail(tobi_error *err, tobi_status status, const char *format, ...);
void __real_tobi_report_add(tobi_report *report, size_t rank, const char *format, ...);
void __real_tobi_source_mistake(tobi_source *source, const tobi_place *place, const char *format, ...);
void __real_tobi_source_mistake_at_key(tobi_source *source, const tobi_place *place,
                                       const char *format, ...);

static int notes = -1;      /* opened before main, so that children and threads share it */

__attribute__((constructor)) static void open_notes(void)
{
    const char *path = getenv("TOBIUO_MESSAGES");
    if (path) notes = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0644);
}

static void note(const char *format)
{
    ssize_t written = notes >= 0 ? write(notes, format, strlen(format) + 1) : 0;
    (void)written;
}

/* What the caller meant to say, on the stack: tests of failing allocations pass here too. */
#define TELL(text)                                \
    char text[8192];                              \
    va_list args;                                 \
    note(format);                                 \
    va_start(args, format);                       \
    vsnprintf(text, sizeof text, tobi_text(format), args);   \
    va_end(args)

tobi_status __wrap_tobi_fail(tobi_error *err, tobi_status status, const char *format, ...);
tobi_status __wrap_tobi_fail(tobi_error *err, tobi_status status, const char *format, ...)
{
    TELL(text);
    return __real_tobi_fail(err, status, "%s", text);
}

void __wrap_tobi_report_add(tobi_report *report, size_t rank, const char *format, ...);
void __wrap_tobi_report_add(tobi_report *report, size_t rank, const char *format, ...)
{
    TELL(text);
    __real_tobi_report_add(report, rank, "%s", text);
}

void __wrap_tobi_source_mistake(tobi_source *source, const tobi_place *place, const char *format, ...);
void __wrap_tobi_source_mistake(tobi_source *source, const tobi_place *place, const char *format, ...)
{
    TELL(text);
    __real_tobi_source_mistake(source, place, "%s", text);
}

void __wrap_tobi_source_mistake_at_key(tobi_source *source, const tobi_place *place,
                                       const char *format, ...);
void __wrap_tobi_source_mistake_at_key(tobi_source *source, const tobi_place *place,
                                       const char *format, ...)
{
    TELL(text);
    __real_tobi_source_mistake_at_key(source, place, "%s", text);
}
