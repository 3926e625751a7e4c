/* Files that a user names: only plain ones are opened, by every reader of the library, and none waits. */
#include "base/plain.h"
#include "base/sha256.h"
#include "geom/mesh.h"
#include "io/csv.h"
#include "io/store.h"
#include "rigid/keyframes.h"
#include "rigid/script.h"
#include "tobiuo/scene.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>
#include <cmocka.h>

enum { SECONDS = 20 };      /* a reader that waits for a pipe ends by SIGALRM */

static char folder[64];

static const char *at(const char *name)
{
    static char path[128];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static int make_folder(void **state)
{
    (void)state;
    struct sockaddr_un address = { .sun_family = AF_UNIX };
    strcpy(folder, "/tmp/tobiuo_plain_XXXXXX");
    if (!mkdtemp(folder)) return 1;
    FILE *file = fopen(at("text"), "w");
    fputs("four", file);
    fclose(file);
    int fd = socket(AF_UNIX, SOCK_STREAM, 0);
    snprintf(address.sun_path, sizeof address.sun_path, "%s/socket", folder);
    int failed = bind(fd, (struct sockaddr *)&address, sizeof address) != 0;
    close(fd);
    alarm(SECONDS);
    return failed || mkfifo(at("pipe.obj"), 0600) != 0;
}

static int remove_folder(void **state)
{
    (void)state;
    alarm(0);
    unlink(at("text"));
    unlink(at("socket"));
    unlink(at("pipe.obj"));
    return rmdir(folder);
}

static void expect(const char *path, tobi_status wanted, const char *part)
{
    tobi_error err = { 0 };
    char *text = "";
    size_t size;
    assert_int_equal(tobi_plain_read(path, "notes", 3, &text, &size, &err), wanted);
    if (!strstr(err.text, part)) fail_msg("<%s>, expected <%s>", err.text, part);
    assert_memory_equal(err.text, "notes ", 6);
    assert_non_null(strstr(err.text, path));
    assert_null(text);
}

static void only_plain_files(void **state)
{
    (void)state;
    char *text;
    size_t size;
    FILE *file;
    int64_t bytes;
    expect(at("nothing"), TOBI_NOT_FOUND, ": No such file or directory");
    expect(at("text/below"), TOBI_NOT_FOUND, ": Not a directory");
    expect(at("pipe.obj"), TOBI_IO, ": is a pipe; only plain files are read");
    expect(at("socket"), TOBI_IO, ": is a socket; only plain files are read");
    expect(folder, TOBI_IO, ": is a directory; only plain files are read");
    expect("/dev/zero", TOBI_IO, ": is a device; only plain files are read");
    expect(at("text"), TOBI_INVALID, ": has 4 bytes; allowed are at most 3");
    assert_int_equal(tobi_plain_read(at("text"), "notes", 4, &text, &size, NULL), TOBI_OK);
    assert_int_equal(size, 4);
    assert_string_equal(text, "four");
    free(text);
    assert_int_equal(tobi_plain_open(at("text"), "notes", 0, &file, &bytes, NULL), TOBI_OK);
    assert_int_equal(bytes, 4);
    fclose(file);
}

/* What every reader makes of the path; the first letter tells which. */
static tobi_status read_by(char reader, const char *path, tobi_error *err)
{
    tobi_keyframes *frames;
    tobi_script *script;
    tobi_report *report;
    tobi_scene *scene;
    tobi_store *store;
    tobi_mesh mesh;
    switch (reader) {
    case 'k': return tobi_keyframes_load(path, &frames, err);
    case 'l': return tobi_script_load(path, NULL, TOBI_CONTROL_SCRIPT, &script, err);
    case 'm': return tobi_mesh_read(path, &mesh, err);
    case 'c': return tobi_store_open(path, &store, err);
    case 't': return tobi_csv_truncate(path, 1, err);
    }
    tobi_status status = tobi_scene_load(path, NULL, &scene, &report, err);
    tobi_report_free(report);
    return status;
}

static void every_reader(void **state)
{
    (void)state;
    static const struct { char reader; const char *what; } readers[] = {
        { 'k', "keyframes " }, { 'l', "control script " }, { 'm', "mesh " },
        { 'c', "checkpoint " }, { 't', "table " }, { 's', "scene " },
    };
    for (size_t k = 0; k < sizeof readers/sizeof *readers; k++) {
        tobi_error err = { 0 };
        assert_int_equal(read_by(readers[k].reader, at("pipe.obj"), &err), TOBI_IO);
        if (strncmp(err.text, readers[k].what, strlen(readers[k].what)) || !strstr(err.text, "is a pipe"))
            fail_msg("<%s>", err.text);
        assert_int_equal(read_by(readers[k].reader, "/dev/zero", &err), TOBI_IO);
        assert_non_null(strstr(err.text, "is a device"));
    }
}

static void sizes_have_limits(void **state)
{
    (void)state;
    static const struct { char reader; int64_t limit; } readers[] = {
        { 'k', (int64_t)1 << 30 }, { 'l', 4 << 20 }, { 'm', (int64_t)4 << 30 }, { 's', 16 << 20 },
    };
    for (size_t k = 0; k < sizeof readers/sizeof *readers; k++) {
        tobi_error err = { 0 };
        char text[64];
        assert_int_equal(truncate(at("text"), readers[k].limit + 1), 0);
        assert_int_equal(read_by(readers[k].reader, at("text"), &err), TOBI_INVALID);
        snprintf(text, sizeof text, ": has %lld bytes; allowed are at most %lld",
                 (long long)readers[k].limit + 1, (long long)readers[k].limit);
        if (!strstr(err.text, text)) fail_msg("<%s>", err.text);
    }
    assert_int_equal(truncate(at("text"), 4), 0);
}

static void excerpts_are_short(void **state)
{
    (void)state;
    assert_string_equal(tobi_excerpt("sixteen is enough").text, "sixteen is enoug...");
    assert_string_equal(tobi_excerpt("sixteen is enoug").text, "sixteen is enoug");
    assert_string_equal(tobi_excerpt("\x1b[2J\n\x7f").text, "?[2J??");
    assert_string_equal(tobi_excerpt("fifteen letters\xc3\xa4").text, "fifteen letters...");
    assert_string_equal(tobi_excerpt("").text, "");
}

/* The examples of FIPS 180-4, and no bytes at all. */
static void digests_are_those_of_the_standard(void **state)
{
    (void)state;
    static const struct { const char *text; int times; const char *digest; } examples[] = {
        { "", 1, "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855" },
        { "abc", 1, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad" },
        { "abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq", 1,
          "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1" },
        { "a", 1000000, "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0" } };
    for (size_t k = 0; k < sizeof examples/sizeof *examples; k++) {
        char digest[TOBI_SHA256_TEXT];
        int64_t size;
        tobi_error err;
        FILE *file = fopen(at("text"), "w");
        for (int n = 0; n < examples[k].times; n++) fputs(examples[k].text, file);
        fclose(file);
        assert_int_equal(tobi_sha256_file(at("text"), digest, &size, &err), TOBI_OK);
        assert_string_equal(digest, examples[k].digest);
        assert_int_equal(size, examples[k].times*strlen(examples[k].text));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(only_plain_files),
        cmocka_unit_test(every_reader),
        cmocka_unit_test(sizes_have_limits),
        cmocka_unit_test(excerpts_are_short),
        cmocka_unit_test(digests_are_those_of_the_standard),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
