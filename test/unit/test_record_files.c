/* The directory of a run: whose files are whose, where links lead, and what was deleted. */
#define _GNU_SOURCE 1
#include "record_rig.h"
#include <fcntl.h>

static void test_old_results_are_safe(void **state)
{
    (void)state;
    tobi_output_def output = make_output();
    tobi_world *world = make_world(0, NULL);
    tobi_run_free(create(world, &output, at("safe/deep/er"), 0));
    expect_failure(TOBI_INVALID, "holds the results", &output, at("safe/deep/er"));
    tobi_world_destroy(world);

    write_file(at("safe/deep/er/notes.txt"), "mine");
    write_file(at("safe/deep/er/fluid/fluid_000007.vtu"), "old");
    write_file(at("safe/deep/er/fluid/fluid_of_mine.vtu"), "mine");
    write_file(at("safe/deep/er/surfaces"), "mine");            /* a file where a folder could be */
    world = make_world(0, NULL);
    tobi_run *run = create(world, &output, at("safe/deep/er"), 1);
    assert_true(exists(at("safe/deep/er/notes.txt")));
    assert_true(exists(at("safe/deep/er/fluid/fluid_of_mine.vtu")));
    assert_false(exists(at("safe/deep/er/fluid/fluid_000007.vtu")));

    tobi_world *second = make_world(0, NULL);                   /* while the first still runs */
    tobi_run *other = NULL;
    tobi_error err = { 0 };
    assert_int_equal(tobi_run_create(second, &output, at("safe/deep/er"), 1, NULL, &other, &err),
                     TOBI_IO);
    assert_non_null(strstr(err.text, "another run"));
    tobi_world_destroy(second);
    tobi_run_free(run);
    tobi_world_destroy(world);

    output.fields = "velocity,presure";
    expect_failure(TOBI_INVALID, "'presure'", &output, at("fields"));
    output = make_output();
    output.interval = 0;
    expect_failure(TOBI_INVALID, "interval", &output, at("interval"));
    write_file(at("plain"), "a file");
    output = make_output();
    expect_failure(TOBI_IO, "plain", &output, at("plain"));
    expect_failure(TOBI_INVALID, "empty", &output, "");
}

/* In a folder that a stranger has prepared no link leads out of it, and the root is no folder of results. */
static void test_no_link_is_followed(void **state)
{
    (void)state;
    tobi_output_def output = make_output();
    tobi_error err = { 0 };
    tobi_run *run = NULL;
    assert_int_equal(mkdir(at("mine"), 0777), 0);
    write_file(at("mine/history.csv"), "dear");
    write_file(at("mine/fluid_000001.vtu"), "dear");
    assert_int_equal(mkdir(at("strange"), 0777), 0);
    assert_int_equal(symlink(at("mine"), at("strange/fluid")), 0);
    expect_failure(TOBI_INVALID, "strange/fluid is a symbolic link", &output, at("strange"));
    tobi_world *world = make_world(0, NULL);
    assert_int_equal(tobi_run_create(world, &output, at("strange"), 1, NULL, &run, &err), TOBI_INVALID);
    unlink(at("strange/fluid"));
    symlink(at("mine/history.csv"), at("strange/history.csv"));
    symlink(at("mine/history.csv"), at("strange/history.csv.part"));
    run = create(world, &output, at("strange"), 1);       /* force removes the links, not what is behind */
    tobi_run_free(run);
    tobi_world_destroy(world);

    world = make_world(0, NULL);
    symlink(at("mine/history.csv"), at("strange/fluid/fluid_000000.vtu.part"));
    rename(at("strange/history.csv"), at("strange/history"));
    symlink(at("mine/history.csv"), at("strange/history.csv"));
    assert_int_equal(tobi_run_resume(world, &output, at("strange"), &run, &err), TOBI_INVALID);
    if (!strstr(err.text, "history.csv: it is a symbolic link")) fail_msg("%s", err.text);
    tobi_world_destroy(world);
    size_t n;
    const char *const dear[] = { "mine/history.csv", "mine/fluid_000001.vtu" };
    for (int k = 0; k < 2; k++) {
        char *text = read_file(at("%s", dear[k]), &n);
        assert_string_equal(text, "dear");
        free(text);
    }
    symlink(at("strange"), at("by_link"));                      /* the directory itself may be one */
    expect_failure(TOBI_INVALID, "holds the results", &output, at("by_link"));
}

/* Who may write there gets a root of its own for the time of the call: a mistake must not fill the
   real one. */
static void test_the_root_is_no_folder_of_results(void **state)
{
    (void)state;
    tobi_output_def output = make_output();
    const char *const names[] = { "/", "/..", "." };
    int root = open("/", O_RDONLY | O_DIRECTORY), here = open(".", O_RDONLY | O_DIRECTORY);
    tobi_status status[3] = { 0 };
    tobi_error err[3] = { 0 };
    tobi_world *world = make_world(0, NULL);
    assert_int_equal(mkdir(at("root"), 0777), 0);
    const bool shut = geteuid() != 0 || chroot(at("root")) == 0;
    assert_true(shut && chdir("/") == 0);
    for (int k = 0; k < 3; k++) {
        tobi_run *run = NULL;
        status[k] = tobi_run_create(world, &output, names[k], 0, NULL, &run, &err[k]);
        tobi_run_free(run);
    }
    assert_int_equal(fchdir(root), 0);
    if (geteuid() == 0) assert_int_equal(chroot("."), 0);
    assert_int_equal(fchdir(here), 0);
    close(root);
    close(here);
    tobi_world_destroy(world);
    for (int k = 0; k < 3; k++) {
        assert_int_equal(status[k], TOBI_INVALID);
        assert_non_null(strstr(err[k].text, "is the root of the file system"));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_old_results_are_safe),
        cmocka_unit_test(test_no_link_is_followed),
        cmocka_unit_test(test_the_root_is_no_folder_of_results),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
