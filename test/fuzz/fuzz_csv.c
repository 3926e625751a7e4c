/* Tables that a run continues: any file may stand where a table was. The first byte is the time of
   truncation; afterwards the file holds whole rows only, and appending adds exactly one. */
#include "target.h"
#include "io/csv.h"
#include <math.h>
#include <sys/stat.h>

static const tobi_csv_column columns[] = { { "time", "s" }, { "x", NULL }, { "name", "1" } };

static const char *folder(void)
{
    static char name[] = "fuzz_csv_XXXXXX";
    static int made;
    if (!made) PROMISE(mkdtemp(name));
    made = 1;
    return name;
}

static void remove_folder(void) { rmdir(folder()); }

static size_t read_file(const char *path, char *text, size_t room)
{
    FILE *file = fopen(path, "rb");
    PROMISE(file);
    size_t n = fread(text, 1, room, file);
    fclose(file);
    return n;
}

static void append_row(const char *path, const char *before, size_t size)
{
    tobi_csv *csv = NULL;
    tobi_error err = { 0 };
    if (!passed(tobi_csv_open(path, TOBI_CSV_APPEND, 9, columns, 3, &csv, &err), &err)) return;
    tobi_csv_add_real(csv, NAN);
    tobi_csv_add_int(csv, INT64_MIN);
    tobi_csv_add_text(csv, "a,\"b\"\n");
    PROMISE(tobi_csv_end_row(csv, &err) == TOBI_OK);
    tobi_csv_close(csv);
    static const char header[] = "time [s],x,name\n", row[] = "nan,-9223372036854775808,\"a,\"\"b\"\"\n\"\n";
    size_t start = size ? size : sizeof header - 1, length = start + sizeof row - 1;
    char *after = malloc(length + 1);
    PROMISE(after && read_file(path, after, length + 1) == length);
    PROMISE(memcmp(after, size ? before : header, start) == 0);
    PROMISE(memcmp(after + start, row, sizeof row - 1) == 0);
    free(after);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static int cleaned;
    if (!cleaned++) atexit(remove_folder);
    char path[64];
    reader r = { data, size };
    double time = (int8_t)take_byte(&r)*0.25;
    snprintf(path, sizeof path, "%s/table.csv", folder());
    FILE *file = fopen(path, "wb");
    PROMISE(file && (r.left == 0 || fwrite(r.data, 1, r.left, file) == r.left));
    fclose(file);

    tobi_error err = { 0 };
    PROMISE(passed(tobi_csv_truncate(path, time, &err), &err));
    char *before = malloc(size + 1);
    PROMISE(before);
    size_t kept = read_file(path, before, size + 1);
    PROMISE(kept <= r.left && (kept == 0 || before[kept - 1] == '\n'));
    append_row(path, before, kept);
    unlink(path);
    free(before);
    return 0;
}
