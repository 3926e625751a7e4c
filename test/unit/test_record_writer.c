/* Outputs are written beside the steps: what waits for what, and what becomes of a failure. */
#define _GNU_SOURCE 1
#include "record_rig.h"
#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>

/* These take the place of the C library's. The writer of a run waits in rename while `shut` (10 s at
   most), and fails where the name holds `refused`. What is synced is noted in the order of calls. */
static atomic_int shut, late;
static _Atomic(const char *) refused;
static char calls[400];

int syncfs(int fd)
{
    if (fd < 0 || refused) return errno = EIO, -1;
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_outputs_are_written_beside_the_steps),
        cmocka_unit_test(test_a_failure_is_told_and_nothing_is_lost),
        cmocka_unit_test(test_a_checkpoint_is_synced),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
