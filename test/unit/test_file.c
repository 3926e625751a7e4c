/* Files that appear whole or not at all: only plain files are replaced, and no link is followed. */
#define _GNU_SOURCE 1
#include "base/file.h"
#include "own_folder.h"
#include "io/csv.h"
#include "io/store.h"
#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>
#include <cmocka.h>


static tobi_status write_text(const char *path, const char *text, int synced, tobi_error *err)
{
    tobi_file file;
    TOBI_TRY(tobi_file_open(&file, path, err));
    tobi_file_write(&file, text, strlen(text));
    if (synced) tobi_file_sync(&file);
    return tobi_file_commit(&file, err);
}

static void assert_content(const char *path, const char *text)
{
    char content[100] = "";
    FILE *f = fopen(path, "rb");
    assert_non_null(f);
    content[fread(content, 1, sizeof content - 1, f)] = '\0';
    fclose(f);
    assert_string_equal(content, text);
}

static void only_plain_files_are_replaced(void **state)
{
    (void)state;
    static const struct { const char *name, *kind; } others[] = {
        { "folder", "a folder" }, { "fifo", "a FIFO" }, { "link", "a symbolic link" },
        { "dangling", "a symbolic link" }, { "device", "a device" },
    };
    tobi_error err = { 0 };
    tobi_store *store;
    tobi_csv *csv;
    const tobi_csv_column column = { "time", "s" };
    assert_int_equal(write_text("dear", "dear", 0, &err), TOBI_OK);
    mkdir("folder", 0777);
    mkfifo("fifo", 0666);
    symlink("dear", "link");
    symlink("nowhere", "dangling");
    const size_t last = mknod("device", S_IFCHR | 0666, makedev(1, 3)) == 0;       /* root only */
    for (size_t k = 0; k < 4 + last; k++) {
        assert_int_equal(write_text(others[k].name, "new", 0, &err), TOBI_INVALID);
        if (!strstr(err.text, others[k].kind)) fail_msg("%s: %s", others[k].name, err.text);
        assert_int_equal(tobi_store_create(others[k].name, &store, &err), TOBI_INVALID);
        assert_int_equal(tobi_csv_open(others[k].name, TOBI_CSV_APPEND, 9, &column, 1, &csv, &err),
                         TOBI_INVALID);
    }
    assert_content("dear", "dear");
    assert_int_not_equal(access("nowhere", F_OK), 0);
    assert_int_equal(write_text("dear", "new", 0, &err), TOBI_OK);
    assert_content("dear", "new");
}

/* The unfinished file of an earlier program, or what a stranger has put in its place. */
static void what_stands_in_the_way_is_removed(void **state)
{
    (void)state;
    tobi_error err = { 0 };
    struct stat info;
    assert_int_equal(write_text("dear", "dear", 0, &err), TOBI_OK);
    assert_int_equal(write_text("own.part", "half a f", 0, &err), TOBI_OK);
    assert_int_equal(write_text("own", "own", 0, &err), TOBI_OK);
    assert_content("own", "own");
    symlink("dear", "own.part");
    assert_int_equal(write_text("own", "again", 1, &err), TOBI_OK);
    assert_content("own", "again");
    assert_content("dear", "dear");
    assert_int_not_equal(lstat("own.part", &info), 0);
    mkfifo("own.part", 0666);
    assert_int_equal(write_text("own", "third", 1, &err), TOBI_OK);
    assert_content("own", "third");
    mkdir("own.part", 0777);
    assert_int_equal(write_text("own", "no", 0, &err), TOBI_IO);
    assert_content("own", "third");
    rmdir("own.part");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(only_plain_files_are_replaced),
        cmocka_unit_test(what_stands_in_the_way_is_removed),
    };
    return cmocka_run_group_tests_name("base/file", tests, enter_own_folder, leave_own_folder);
}
