/* Tables: exact text, quoting, resuming, torn lines, full disk. */
#define _GNU_SOURCE 1
#include "io/csv.h"
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>
#include <cmocka.h>

static char folder[] = "/tmp/tobi_io_csv_XXXXXX";
static char path[64];
static const tobi_csv_column columns[] = { { "time", "s" }, { "step", "1" }, { "force", "N" },
                                           { "body", NULL } };

static const char *content(void)
{
    static char text[4096];
    FILE *in = fopen(path, "rb");
    size_t n = in ? fread(text, 1, sizeof text - 1, in) : 0;
    text[n] = '\0';
    if (in) fclose(in);
    return text;
}

static void put(const char *text)
{
    FILE *out = fopen(path, "wb");
    fputs(text, out);
    fclose(out);
}

static tobi_status add(tobi_csv *csv, double time, int64_t step, double force, const char *body,
                       tobi_error *err)
{
    tobi_csv_add_real(csv, time);
    tobi_csv_add_int(csv, step);
    tobi_csv_add_real(csv, force);
    tobi_csv_add_text(csv, body);
    return tobi_csv_end_row(csv, err);
}

static void rows_are_written_at_once(void **state)
{
    (void)state;
    tobi_error err;
    tobi_csv *csv;
    assert_int_equal(tobi_csv_open(path, TOBI_CSV_NEW, 9, columns, 4, &csv, &err), 0);
    assert_string_equal(content(), "time [s],step,force [N],body\n");
    assert_int_equal(add(csv, 0.1, 7, 1.0/3, "fish", &err), 0);
    assert_string_equal(content(), "time [s],step,force [N],body\n0.10000000000000001,7,0.333333333,fish\n");
    assert_int_equal(add(csv, 0.2, INT64_MIN, -NAN, "a \"b\", c\nd", &err), 0);
    assert_int_equal(add(csv, 0.25, 0, -INFINITY, "", &err), 0);
    assert_non_null(strstr(content(), "\n0.20000000000000001,-9223372036854775808,nan,"
                           "\"a \"\"b\"\", c\nd\"\n0.25,0,-inf,\n"));
    tobi_csv_add_real(csv, 1);
    assert_int_equal(tobi_csv_end_row(csv, &err), TOBI_INVALID);
    assert_non_null(strstr(err.text, "1 values in a table of 4 columns"));
    assert_int_equal(add(csv, 0.5, 1, 2, "x", &err), 0);
    assert_non_null(strstr(content(), "\n0.5,1,2,x\n"));
    tobi_csv_close(csv);
    assert_int_equal(tobi_csv_open(path, TOBI_CSV_NEW, 17, columns, 4, &csv, &err), 0);
    assert_int_equal(add(csv, 0.5, 1, 0.1, "x", &err), 0);
    assert_string_equal(content(), "time [s],step,force [N],body\n0.5,1,0.10000000000000001,x\n");
    tobi_csv_close(csv);
    tobi_csv_close(NULL);
}

static void resuming_keeps_whole_rows(void **state)
{
    (void)state;
    tobi_error err;
    tobi_csv *csv;
    put("time [s],step,force [N],body\n0.5,1,2,\"x\ny\"\n0.6,2,");
    assert_int_equal(tobi_csv_open(path, TOBI_CSV_APPEND, 9, columns, 4, &csv, &err), 0);
    assert_int_equal(add(csv, 0.75, 2, 3, "z", &err), 0);
    tobi_csv_close(csv);
    assert_string_equal(content(), "time [s],step,force [N],body\n0.5,1,2,\"x\ny\"\n0.75,2,3,z\n");
    put("time [s],st");
    assert_int_equal(tobi_csv_open(path, TOBI_CSV_APPEND, 9, columns, 4, &csv, &err), 0);
    tobi_csv_close(csv);
    assert_string_equal(content(), "time [s],step,force [N],body\n");
    remove(path);
    assert_int_equal(tobi_csv_open(path, TOBI_CSV_APPEND, 9, columns, 4, &csv, &err), 0);
    tobi_csv_close(csv);
    assert_string_equal(content(), "time [s],step,force [N],body\n");
    put("time [s],other\n1,2\n");
    assert_int_equal(tobi_csv_open(path, TOBI_CSV_APPEND, 9, columns, 4, &csv, &err), TOBI_INVALID);
    assert_null(csv);
    assert_non_null(strstr(err.text, "other columns"));
    assert_null(strstr(err.text, "time [s],other"));      /* the file may be a foreign one */
    assert_string_equal(content(), "time [s],other\n1,2\n");
    assert_int_equal(tobi_csv_open("/no/such/t.csv", TOBI_CSV_NEW, 9, columns, 4, &csv, &err), TOBI_IO);
    assert_string_equal(err.text, "cannot write /no/such/t.csv: No such file or directory");
    assert_int_equal(tobi_csv_open(path, TOBI_CSV_NEW, 9, columns, 0, &csv, &err), TOBI_INVALID);
}

static void truncating_drops_later_rows(void **state)
{
    (void)state;
    tobi_error err;
    tobi_csv *csv;
    /* Times that 9 digits would round up: the row of the checkpoint itself must stay. */
    double times[] = { 0, 0.1 + 0.2, 1.0/3, 2.0/3, 2.0/3 + 1e-15, 1 };
    assert_int_equal(tobi_csv_open(path, TOBI_CSV_NEW, 9, columns, 4, &csv, &err), 0);
    for (int i = 0; i < 6; i++) assert_int_equal(add(csv, times[i], i, i, "a,\nb", &err), 0);
    tobi_csv_close(csv);
    assert_int_equal(tobi_csv_truncate(path, 2.0/3, &err), 0);
    const char *text = content();
    int rows = 0;
    for (const char *at = text; (at = strstr(at, "\"a,\nb\"\n")); at++) rows++;
    assert_int_equal(rows, 4);
    put("time [s],x\n0,1\n\0junk");
    assert_int_equal(tobi_csv_truncate(path, -1, &err), 0);
    assert_string_equal(content(), "time [s],x\n");
    put("t,x\n1,1\nnan,2\nrubbish,3\n2;4\n1.5,5\n2,6\n1.25,to");
    assert_int_equal(tobi_csv_truncate(path, 1.5, &err), 0);
    assert_string_equal(content(), "t,x\n1,1\n1.5,5\n");
    assert_int_equal(tobi_csv_truncate("/no/such/t.csv", 1, &err), TOBI_NOT_FOUND);
}

static void full_disk_keeps_whole_rows(void **state)
{
    (void)state;
    signal(SIGXFSZ, SIG_IGN);
    tobi_error err;
    tobi_csv *csv;
    struct rlimit before;
    getrlimit(RLIMIT_FSIZE, &before);
    for (rlim_t size = 0; size < 120; size++) {
        struct rlimit limit = { size, before.rlim_max };
        remove(path);
        setrlimit(RLIMIT_FSIZE, &limit);
        tobi_status status = tobi_csv_open(path, TOBI_CSV_NEW, 9, columns, 4, &csv, &err);
        for (int i = 0; i < 10 && !status; i++) status = add(csv, i, 10, 0.5, "fish", &err);
        setrlimit(RLIMIT_FSIZE, &before);
        assert_int_equal(status, TOBI_IO);
        assert_non_null(strstr(err.text, "t.csv: File too large"));
        tobi_csv_close(csv);
        size_t n = strlen(content());
        assert_true(n <= size && (n == 0 || content()[n - 1] == '\n'));
    }
    put("t\n1\n2\n3\n");
    struct rlimit limit = { 3, before.rlim_max };
    setrlimit(RLIMIT_FSIZE, &limit);
    tobi_status status = tobi_csv_truncate(path, 2, &err);
    setrlimit(RLIMIT_FSIZE, &before);
    assert_int_equal(status, TOBI_IO);
    assert_string_equal(content(), "t\n1\n2\n3\n");
}

static int set_up(void **state)
{
    (void)state;
    if (!mkdtemp(folder)) return -1;
    snprintf(path, sizeof path, "%s/t.csv", folder);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    remove(path);
    return rmdir(folder);     /* fails if a .part file was left */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_are_written_at_once), cmocka_unit_test(resuming_keeps_whole_rows),
        cmocka_unit_test(truncating_drops_later_rows), cmocka_unit_test(full_disk_keeps_whole_rows)
    };
    return cmocka_run_group_tests_name("io/csv", tests, set_up, tear_down);
}
