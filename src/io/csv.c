/* One write per row, numbers formatted by hand so that no locale matters. Drawback: rows are not
   buffered, so that tables of many rows per second cost system calls. */
#define _GNU_SOURCE 1
#include "io/csv.h"
#include "base/plain.h"
#include "base/file.h"
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { WAITING_LIMIT = 64 << 20 /* bytes */ };

struct tobi_csv {
    char    *path;
    int      fd;
    int      digits, columns;
    int      filled;         /* values in the row so far */
    int      lost;           /* rows are gone with a file that was deleted */
    tobi_csv_rows header;
    tobi_csv_rows row;       /* its text */
    int      no_memory;
    int      patient;
    tobi_csv_rows waiting;   /* refused by the disk */
    int64_t  dropped;        /* rows that had no room there */
    locale_t plain;          /* "C", for numbers */
};

static int append_text(tobi_csv_rows *rows, const char *text, size_t bytes)
{
    if (rows->length + bytes > rows->room) {
        size_t room = 2*(rows->length + bytes) + 256;
        char *more = realloc(rows->text, room);
        if (!more) return 0;
        rows->text = more;
        rows->room = room;
    }
    memcpy(rows->text + rows->length, text, bytes);
    rows->length += bytes;
    return 1;
}

static void append(tobi_csv *csv, const char *text, size_t bytes)
{
    if (!append_text(&csv->row, text, bytes)) csv->no_memory = 1;
}

static void append_value(tobi_csv *csv, const char *text, size_t bytes)
{
    if (csv->filled++ > 0) append(csv, ",", 1);
    append(csv, text, bytes);
}

/* A snprintf with a decimal point whatever the host program's locale. */
void tobi_csv_add_real(tobi_csv *csv, double value)
{
    char text[40];
    locale_t before = uselocale(csv->plain);
    int n = isnan(value) ? snprintf(text, sizeof text, "nan")
                         : snprintf(text, sizeof text, "%.*g", csv->filled == 0 ? 17 : csv->digits, value);
    uselocale(before);
    append_value(csv, text, (size_t)n);
}

void tobi_csv_add_int(tobi_csv *csv, int64_t value)
{
    char text[24];
    int n = snprintf(text, sizeof text, "%" PRId64, value);
    append_value(csv, text, (size_t)n);
}

void tobi_csv_add_text(tobi_csv *csv, const char *value)
{
    if (value[strcspn(value, ",\"\r\n")] == '\0') {
        append_value(csv, value, strlen(value));
        return;
    }
    append_value(csv, "\"", 1);
    for (const char *at = value; *at; at++) append(csv, *at == '"' ? "\"\"" : at, *at == '"' ? 2 : 1);
    append(csv, "\"", 1);
}

/* One write; after a failure the file is cut back to whole rows. */
static tobi_status write_text(tobi_csv *csv, const tobi_csv_rows *rows, tobi_error *err)
{
    off_t end = lseek(csv->fd, 0, SEEK_END);
    size_t done = 0;
    int code = end < 0 ? errno : 0;
    while (!code && done < rows->length) {
        ssize_t n = write(csv->fd, rows->text + done, rows->length - done);
        if (n > 0) done += (size_t)n;
        else if (n == 0) code = ENOSPC;
        else if (errno != EINTR) code = errno;
    }
    if (!code) return TOBI_OK;
    if (done > 0 && ftruncate(csv->fd, end) != 0) done = 0;   /* tobi_csv_open drops the torn line */
    return tobi_fail(err, TOBI_IO, "cannot write %s: %s", csv->path, tobi_reason(code));
}

int tobi_csv_is_gone(const tobi_csv *csv)
{
    struct stat ours, there;
    return fstat(csv->fd, &ours) != 0 || lstat(csv->path, &there) != 0 || ours.st_dev != there.st_dev ||
           ours.st_ino != there.st_ino;
}

int tobi_csv_has_lost(const tobi_csv *csv) { return csv->lost; }

/* Ends the row in csv->row; after a failure it is empty. */
static tobi_status end_row(tobi_csv *csv, tobi_error *err)
{
    int filled = csv->filled;
    append(csv, "\n", 1);
    int no_memory = csv->no_memory;
    csv->filled = csv->no_memory = 0;
    if (no_memory || filled != csv->columns) csv->row.length = 0;
    if (filled != csv->columns)
        return tobi_fail(err, TOBI_INVALID, "%s: a row of %d values in a table of %d columns", csv->path,
                         filled, csv->columns);
    return no_memory ? tobi_fail(err, TOBI_NO_MEMORY, "no memory to write %s", csv->path) : TOBI_OK;
}

tobi_status tobi_csv_end_row(tobi_csv *csv, tobi_error *err)
{
    TOBI_TRY(end_row(csv, err));
    tobi_status status = tobi_csv_write_rows(csv, &csv->row, err);
    csv->row.length = 0;
    return status;
}

tobi_status tobi_csv_take_row(tobi_csv *csv, tobi_csv_rows *rows, tobi_error *err)
{
    TOBI_TRY(end_row(csv, err));
    int fits = append_text(rows, csv->row.text, csv->row.length);
    csv->row.length = 0;
    return fits ? TOBI_OK : tobi_fail(err, TOBI_NO_MEMORY, "no memory to write %s", csv->path);
}

static void add_header(tobi_csv *csv, const tobi_csv_column *columns)
{
    for (int i = 0; i < csv->columns; i++) {
        const char *unit = columns[i].unit;
        char text[256];
        if (unit && unit[0] && strcmp(unit, "1") != 0)
            snprintf(text, sizeof text, "%s [%s]", columns[i].name, unit);
        else snprintf(text, sizeof text, "%s", columns[i].name);
        tobi_csv_add_text(csv, text);
    }
}

/* Length of the line at text with its newline; 0 if it has no end. Newlines in quotes belong to it. */
static size_t line_length(const char *text, size_t bytes)
{
    int quoted = 0;
    for (size_t i = 0; i < bytes; i++) {
        if (text[i] == '"') quoted = !quoted;
        else if (text[i] == '\n' && !quoted) return i + 1;
    }
    return 0;
}

/* Compares the header and drops a torn last line. *empty: there is nothing to continue. */
static tobi_status continue_table(tobi_csv *csv, int *empty, tobi_error *err)
{
    char *text;
    size_t bytes, end = 0, n;
    TOBI_TRY(tobi_plain_read(csv->path, tr("table"), 0, &text, &bytes, err));
    size_t header = line_length(text, bytes);
    while ((n = line_length(text + end, bytes - end)) > 0) end += n;
    tobi_status status = TOBI_OK;
    if (header > 0 && (header != csv->header.length || memcmp(text, csv->header.text, header) != 0))
        status = tobi_fail(err, TOBI_INVALID, "%s has other columns than this run writes", csv->path);
    else if (end < bytes && ftruncate(csv->fd, (off_t)end) != 0)
        status = tobi_fail(err, TOBI_IO, "cannot write %s: %s", csv->path, tobi_reason(errno));
    *empty = header == 0;
    free(text);
    return status;
}

/* Opens the file; a new one, and one that is empty, gets the header. */
static tobi_status open_table(tobi_csv *csv, tobi_csv_mode mode, tobi_error *err)
{
    int empty = 1, flags = O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;
    TOBI_TRY(tobi_file_check_target(csv->path, err));
    csv->fd = open(csv->path, flags | (mode == TOBI_CSV_NEW ? O_TRUNC : 0), 0666);
    if (csv->fd < 0) return tobi_fail(err, TOBI_IO, "cannot write %s: %s", csv->path, tobi_reason(errno));
    if (mode == TOBI_CSV_APPEND) TOBI_TRY(continue_table(csv, &empty, err));
    csv->lost |= empty && mode == TOBI_CSV_APPEND;
    return empty ? write_text(csv, &csv->header, err) : TOBI_OK;
}

static tobi_status start_table(tobi_csv *csv, const tobi_csv_column *columns, tobi_csv_mode mode,
                               tobi_error *err)
{
    add_header(csv, columns);
    TOBI_TRY(tobi_csv_take_row(csv, &csv->header, err));
    return open_table(csv, mode, err);
}

static int64_t count_rows(const tobi_csv_rows *rows)
{
    int64_t count = 0;
    for (size_t at = 0, n; (n = line_length(rows->text + at, rows->length - at)) > 0; at += n) count++;
    return count;
}

void tobi_csv_set_patient(tobi_csv *csv, int patient) { csv->patient = patient; }

int64_t tobi_csv_waiting(const tobi_csv *csv) { return count_rows(&csv->waiting) + csv->dropped; }

tobi_status tobi_csv_flush(tobi_csv *csv, tobi_error *err)
{
    if (csv->waiting.length == 0) return TOBI_OK;
    TOBI_TRY(write_text(csv, &csv->waiting, err));
    csv->waiting.length = 0;
    return TOBI_OK;
}

static tobi_status write_rows(tobi_csv *csv, const tobi_csv_rows *rows, tobi_error *err)
{
    if (tobi_csv_is_gone(csv)) {
        if (csv->fd >= 0) close(csv->fd);
        TOBI_TRY(open_table(csv, TOBI_CSV_APPEND, err));
    }
    TOBI_TRY(tobi_csv_flush(csv, err));
    return write_text(csv, rows, err);
}

tobi_status tobi_csv_write_rows(tobi_csv *csv, const tobi_csv_rows *rows, tobi_error *err)
{
    const tobi_status status = write_rows(csv, rows, err);
    if (status != TOBI_IO || !csv->patient) return status;
    if (csv->waiting.length + rows->length > WAITING_LIMIT ||
        !append_text(&csv->waiting, rows->text, rows->length))
        csv->dropped += count_rows(rows);
    return TOBI_IO;
}

tobi_status tobi_csv_open(const char *path, tobi_csv_mode mode, int digits, const tobi_csv_column *columns,
                          int column_count, tobi_csv **csv, tobi_error *err)
{
    *csv = NULL;
    if (column_count < 1 || digits < 1 || digits > 17)
        return tobi_fail(err, TOBI_INVALID, "%s: a table of %d columns with %d digits", path, column_count,
                         digits);
    tobi_csv *c = calloc(1, sizeof *c);
    if (!c) return tobi_fail(err, TOBI_NO_MEMORY, "no memory to write %s", path);
    c->fd = -1;
    c->path = strdup(path);
    c->plain = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    c->digits = digits;
    c->columns = column_count;
    tobi_status status = !c->path || !c->plain
                             ? tobi_fail(err, TOBI_NO_MEMORY, "no memory to write %s", path)
                             : start_table(c, columns, mode, err);
    if (status == TOBI_OK) *csv = c;
    else tobi_csv_close(c);
    return status;
}

void tobi_csv_close(tobi_csv *csv)
{
    if (!csv) return;
    if (csv->fd >= 0) close(csv->fd);
    if (csv->plain) freelocale(csv->plain);
    free(csv->path);
    free(csv->row.text);
    free(csv->header.text);
    free(csv->waiting.text);
    free(csv);
}

/* Whether the row at text starts with a number that is at most time. */
static int keeps_row(const char *text, double time, locale_t plain)
{
    char *end;
    double value = strtod_l(text, &end, plain);
    return end != text && (*end == ',' || *end == '\n' || *end == '\r') && value <= time;
}

tobi_status tobi_csv_truncate(const char *path, double time, tobi_error *err)
{
    char *text;
    size_t bytes, n;
    TOBI_TRY(tobi_plain_read(path, tr("table"), 0, &text, &bytes, err));
    tobi_file file;
    tobi_status status = tobi_file_open(&file, path, err);
    if (status == TOBI_OK) {
        for (size_t at = 0; (n = line_length(text + at, bytes - at)) > 0; at += n)
            if (at == 0 || keeps_row(text + at, time, file.plain)) tobi_file_write(&file, text + at, n);
        status = tobi_file_commit(&file, err);
    }
    free(text);
    return status;
}
