/* Outputs are written beside the steps: what waits for what, and what becomes of a failure. */
#define _GNU_SOURCE 1
#include "record_rig.h"
#include "record/record.h"
#include <errno.h>
#include <fcntl.h>
#include <glob.h>
#include <stdatomic.h>
#include <sys/syscall.h>

/* These take the place of the C library's. The writer of a run waits in rename while `shut` (10 s at
   most), and fails where the name holds `refused`. What is synced is noted in the order of calls. */
static atomic_int shut, late;
static _Atomic(const char *) refused;
static atomic_bool full;
static char calls[400];

int syncfs(int fd)
{
    if (fd < 0 || (refused && strcmp(refused, "nothing") == 0)) return errno = EIO, -1;
    strcat(calls, "syncfs ");
    return 0;
}

int fsync(int fd)
{
    struct stat info;
    strcat(calls, fstat(fd, &info) == 0 && S_ISDIR(info.st_mode) ? "folder " : "file ");
    return 0;
}

int rename(const char *from, const char *to)
{
    const char *end = strrchr(to, '.');
    if (strstr(to, "checkpoint_")) strcat(strcat(calls, end + 1), " ");
    for (int k = 0; shut && k < 1000; k++) {
        usleep(10000);
        if (k < 999) continue;
        late = 1;
        shut = 0;
    }
    if (refused && strstr(to, refused)) {
        errno = ENOSPC;
        return -1;
    }
    return renameat(AT_FDCWD, from, AT_FDCWD, to);
}

/* Tables grow by write; full: none of their rows finds room. */
ssize_t write(int fd, const void *data, size_t bytes)
{
    char link[40], path[300] = "";
    snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
    if (full && readlink(link, path, sizeof path - 1) > 4 && strstr(path, ".csv")) return errno = ENOSPC, -1;
    return syscall(SYS_write, fd, data, bytes);
}

static int count_checkpoints(const char *run)
{
    char path[300];
    glob_t found;
    snprintf(path, sizeof path, "%s/checkpoints/*.h5", at("%s", run));
    const int code = glob(path, 0, NULL, &found), count = code ? 0 : (int)found.gl_pathc;
    if (!code) globfree(&found);
    return count;
}

static void make_whole(void)
{
    const char *const names[] = { "cube" };
    tobi_output_def output = make_output();
    tobi_world *world = make_world(1, names);
    tobi_run *run = create(world, &output, at("whole"), 1);
    step_until(run, 0.02);
    tobi_run_free(run);
    tobi_world_destroy(world);
}

/* Steps go on while one output is written and one waits. */
static void test_outputs_are_written_beside_the_steps(void **state)
{
    (void)state;
    const char *const names[] = { "cube" };
    tobi_output_def output = make_output();
    make_whole();
    tobi_error err = { 0 };
    tobi_world *world = make_world(1, names);
    tobi_run *run = create(world, &output, at("beside"), 0);
    shut = 1;
    while (tobi_world_time(world) < 0.008) assert_int_equal(tobi_run_step(run, 0.02, NULL, &err), TOBI_OK);
    assert_false(exists(at("beside/fluid/fluid_000001.vtu")));
    assert_int_equal(count_rows(at("beside/history.csv")), 1);
    shut = 0;
    assert_int_equal(tobi_run_wait(run, &err), TOBI_OK);
    assert_false(late);
    assert_true(exists(at("beside/fluid/fluid_000002.vtu")));
    step_until(run, 0.02);
    assert_same_file(at("whole/history.csv"), at("beside/history.csv"));
    assert_same_file(at("whole/all.pvd"), at("beside/all.pvd"));
    tobi_run_free(run);
    tobi_world_destroy(world);
}

/* What could not be written is told by a later call, kept, and tried again; no checkpoint counts it. */
static void test_a_failure_is_told_and_nothing_is_lost(void **state)
{
    (void)state;
    const char *const names[] = { "cube" };
    const char *const places[] = { "fluid_000002.vtu", "all.pvd", "cube_000003.stl" };
    tobi_output_def output = make_output();
    make_whole();
    for (int k = 0; k < 3; k++) {
        tobi_error err = { 0 };
        tobi_world *world = make_world(1, names);
        tobi_run *run = create(world, &output, at("failing_%d", k), 0);
        refused = places[k];
        tobi_status status = TOBI_OK;
        while (status == TOBI_OK && !tobi_run_done(run, 0.02)) status = tobi_run_step(run, 0.02, NULL, &err);
        assert_int_equal(status, TOBI_IO);
        if (!strstr(err.text, places[k]) || !strstr(err.text, "No space left")) fail_msg("%s", err.text);
        const int rows = count_rows(at("failing_%d/history.csv", k));
        assert_int_equal(rows, k == 0 ? 2 : k == 1 ? 1 : 3);
        assert_int_equal(tobi_run_checkpoint(run, &err), TOBI_IO);
        assert_int_equal(tobi_run_finish(run, "complete", &err), TOBI_IO);
        size_t n;
        char *summary = read_file(at("failing_%d/summary.json", k), &n), counted[40];
        snprintf(counted, sizeof counted, "\"outputs\": %d,", rows);
        assert_non_null(strstr(summary, "\"outcome\": \"failed\""));
        assert_non_null(strstr(summary, counted));
        free(summary);
        refused = NULL;
        tobi_run_wait(run, &err);                       /* the last failure may still be to be told */
        step_until(run, 0.02);
        assert_int_equal(tobi_run_checkpoint(run, &err), TOBI_OK);
        tobi_run_free(run);
        tobi_world_destroy(world);
        assert_same_file(at("whole/history.csv"), at("failing_%d/history.csv", k));
        assert_same_file(at("whole/bodies.csv"), at("failing_%d/bodies.csv", k));
        assert_same_file(at("whole/all.pvd"), at("failing_%d/all.pvd", k));
        assert_same_file(at("whole/fluid/fluid_000003.vtu"), at("failing_%d/fluid/fluid_000003.vtu", k));
    }
}

/* Before a checkpoint is there, all that it counts on is on the disk, and so is the file itself. */
static void test_a_checkpoint_is_synced(void **state)
{
    (void)state;
    tobi_output_def output = make_output();
    tobi_error err = { 0 };
    tobi_world *world = make_world(0, NULL);
    tobi_run *run = create(world, &output, at("synced"), 0);
    step_until(run, 0.004);
    calls[0] = '\0';
    refused = "";
    assert_int_equal(tobi_run_checkpoint(run, &err), TOBI_IO);
    refused = "nothing";
    assert_int_equal(tobi_run_checkpoint(run, &err), TOBI_IO);
    assert_non_null(strstr(err.text, "cannot write the results in"));
    assert_null(strstr(calls, "h5"));
    refused = NULL;
    calls[0] = '\0';
    assert_int_equal(tobi_run_checkpoint(run, &err), TOBI_OK);
    assert_string_equal(calls, "json syncfs file h5 folder ");
    tobi_run_free(run);
    tobi_world_destroy(world);
}

static int count(const char *path, const char *word)
{
    size_t n;
    int found = 0;
    char *text = read_file(path, &n);
    for (const char *p = text; (p = strstr(p, word)); p++) found++;
    free(text);
    return found;
}

/* As on the way to 0.02 s: no step ends at the time itself. */
static void step_past(tobi_run *run, double time)
{
    tobi_error err = { 0 };
    while (tobi_world_time(run->world) < time)
        assert_int_equal(tobi_run_step(run, 0.02, NULL, &err), TOBI_OK);
}

/* Outputs 2 and 3 meet a disk that is full for what is `refused`: the run goes on, says so once, and all else
   is that of a whole run. */
static void test_a_run_goes_on(void **state)
{
    (void)state;
    static const struct { const char *refused, *list, *says, *lost; int listed; int64_t files; } cases[] = {
        { "fluid_00000", "fluid.pvd", "fluid_000002.vtu: No space", "files of particles not written: 2, of "
          "outputs 2 to 3", 4, 2 },
        { "cube_000002.stl", "fluid.pvd", "cube_000002.stl: No space",
          "STL, PLY and OBJ files not written: 1", 6, 1 },
        { ".pvd", "fluid.pvd", "fluid.pvd: No space", "", 6, 0 },
        { "checkpoint_", "fluid.pvd", ".json: No space left on device; the checkpoint of before stays", "", 6,
          0 },
    };
    const char *const names[] = { "cube" };
    tobi_output_def output = make_output();
    make_whole();
    for (int k = 0; k < 4; k++) {
        tobi_error err = { 0 };
        tobi_world *world = make_world(1, names);
        tobi_run *run = create(world, &output, at("going_%d", k), 0);
        tobi_run_go_on(run, 1);
        step_past(run, 0.006);
        assert_int_equal(tobi_run_wait(run, &err), TOBI_OK);
        assert_int_equal(tobi_run_checkpoint(run, &err), TOBI_OK);
        assert_null(tobi_run_trouble(run, 0));
        refused = cases[k].refused;
        step_past(run, 0.014);
        assert_int_equal(tobi_run_wait(run, &err), TOBI_OK);
        assert_int_equal(tobi_run_checkpoint(run, &err), TOBI_OK);
        const char *said = tobi_run_trouble(run, 0);
        if (!said || !strstr(said, cases[k].says)) fail_msg("%s", said ? said : "nothing is said");
        if (tobi_run_trouble(run, 1)) fail_msg("%s", tobi_run_trouble(run, 1));
        assert_true(tobi_run_unwritten(run) > 0);
        if (k == 3) assert_int_equal(count_checkpoints("going_3"), 1);
        refused = NULL;
        step_until(run, 0.02);
        assert_int_equal(tobi_run_checkpoint(run, &err), TOBI_OK);
        assert_int_equal(tobi_run_finish(run, "complete", &err), TOBI_OK);
        assert_int_equal(tobi_run_unwritten(run), cases[k].files);
        if (!strstr(tobi_run_losses(run), cases[k].lost)) fail_msg("%s", tobi_run_losses(run));
        if (!cases[k].files) assert_string_equal(tobi_run_losses(run), "");
        assert_int_equal(count(at("going_%d/fluid.pvd", k), "<DataSet"), cases[k].listed);
        assert_int_equal(count(at("going_%d/summary.json", k), "files_not_written"), cases[k].files > 0);
        assert_same_file(at("whole/history.csv"), at("going_%d/history.csv", k));
        assert_same_file(at("whole/fluid/fluid_000005.vtu"), at("going_%d/fluid/fluid_000005.vtu", k));
        if (!cases[k].files) assert_same_file(at("whole/all.pvd"), at("going_%d/all.pvd", k));
        tobi_run_free(run);
        tobi_world_destroy(world);
    }
}

/* Rows wait while their file refuses them, and no checkpoint counts on them meanwhile. */
static void test_rows_wait(void **state)
{
    (void)state;
    const char *const names[] = { "cube" };
    tobi_output_def output = make_output();
    tobi_error err = { 0 };
    make_whole();
    tobi_world *world = make_world(1, names);
    tobi_run *run = create(world, &output, at("rows"), 0);
    tobi_run_go_on(run, 1);
    step_past(run, 0.006);
    assert_int_equal(tobi_run_wait(run, &err), TOBI_OK);
    full = true;
    step_past(run, 0.014);
    assert_int_equal(tobi_run_wait(run, &err), TOBI_OK);
    assert_int_equal(tobi_run_checkpoint(run, &err), TOBI_OK);
    assert_non_null(strstr(tobi_run_trouble(run, 0), "bodies.csv: No space left on device; its rows wait"));
    assert_non_null(strstr(tobi_run_trouble(run, 1), "the checkpoint of before stays"));
    assert_int_equal(count_checkpoints("rows"), 0);
    assert_int_equal(count_rows(at("rows/history.csv")), 2);
    assert_int_equal(tobi_run_unwritten(run), 5);       /* four rows and a checkpoint */
    full = false;
    assert_int_equal(tobi_run_checkpoint(run, &err), TOBI_OK);
    assert_int_equal(count_checkpoints("rows"), 1);
    assert_int_equal(count_rows(at("rows/history.csv")), 4);
    step_until(run, 0.02);
    assert_int_equal(tobi_run_finish(run, "complete", &err), TOBI_OK);
    assert_int_equal(tobi_run_unwritten(run), 0);
    assert_same_file(at("whole/history.csv"), at("rows/history.csv"));
    assert_same_file(at("whole/bodies.csv"), at("rows/bodies.csv"));
    tobi_run_free(run);
    tobi_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_outputs_are_written_beside_the_steps),
        cmocka_unit_test(test_a_failure_is_told_and_nothing_is_lost),
        cmocka_unit_test(test_a_checkpoint_is_synced),
        cmocka_unit_test(test_a_run_goes_on),
        cmocka_unit_test(test_rows_wait),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
