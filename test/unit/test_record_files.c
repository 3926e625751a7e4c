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

static tobi_run *resume(tobi_world *world, const tobi_output_def *output, const char *dir)
{
    tobi_run *run = NULL;
    tobi_error err = { 0 };
    if (tobi_run_resume(world, output, dir, &run, &err)) fail_msg("%s", err.text);
    return run;
}

static void expect_loss(const tobi_run *run, const char *part)
{
    if (!strstr(tobi_run_losses(run), part)) fail_msg("'%s' without '%s'", tobi_run_losses(run), part);
}

/* Entries of a list; each names a file that is there. */
static int count_listed(const char *dir, const char *list)
{
    size_t n;
    int count = 0;
    char *text = read_file(at("%s/%s", dir, list), &n);
    for (char *p = text; (p = strstr(p, " file=\"")); count++) {
        p += 7;
        *strchr(p, '"') = '\0';
        if (!exists(at("%s/%s", dir, p))) fail_msg("%s names %s, which is missing", list, p);
        p += strlen(p) + 1;
    }
    free(text);
    return count;
}

static void remove_dir(const char *dir)
{
    char command[600];
    snprintf(command, sizeof command, "rm -rf '%s'", dir);
    assert_int_equal(system(command), 0);
}

/* A run goes on without what is deleted meanwhile, makes it again where it can, and says so at its end. */
static void test_what_is_deleted_during_a_run_is_missed(void **state)
{
    (void)state;
    const char *const names[] = { "cube" };
    tobi_output_def output = make_output();
    tobi_error err = { 0 };
    for (int all = 0; all < 2; all++) {
        const char *dir = all ? "gone" : "thinned";
        tobi_world *world = make_world(1, names);
        tobi_probe_def probe = tobi_default_probe_def();
        probe.name = "P";
        probe.position[2] = 0.02;
        assert_int_equal(tobi_world_add_probe(world, &probe, &err), TOBI_OK);
        tobi_run *run = create(world, &output, at("%s", dir), 0);
        step_until(run, 0.008);
        assert_string_equal(tobi_run_losses(run), "");
        if (all) remove_dir(at("%s", dir));
        unlink(at("thinned/history.csv"));
        unlink(at("thinned/fluid/fluid_000001.vtu"));
        unlink(at("thinned/resolved.json"));
        remove_dir(at("thinned/surfaces"));
        step_until(run, 0.02);
        assert_int_equal(tobi_run_checkpoint(run, &err), TOBI_OK);
        assert_int_equal(tobi_run_finish(run, "complete", &err), TOBI_OK);
        expect_loss(run, "history.csv was deleted and begins anew");
        expect_loss(run, "missing files of earlier outputs: ");
        expect_loss(run, all ? "outputs: 9 " : "outputs: 4 ");
        assert_true(all == !!strstr(tobi_run_losses(run), "the directory was deleted and made again"));
        assert_true(all == !!strstr(tobi_run_losses(run), "probes.csv was deleted"));
        assert_int_equal(count_rows(at("%s/history.csv", dir)), 3);
        assert_int_equal(count_listed(dir, "fluid.pvd"), all ? 3 : 5);
        assert_int_equal(count_listed(dir, "all.pvd"), all ? 9 : 14);
        tobi_run_free(run);
        tobi_world_destroy(world);

        world = make_world(1, names);                       /* and the state is not lost */
        run = resume(world, &output, at("%s", dir));
        assert_true(exists(at("%s/resolved.json", dir)));
        assert_true(tobi_world_time(world) == 5 * output.interval);
        tobi_run_free(run);
        tobi_world_destroy(world);
    }
}

static void test_what_was_deleted_before_a_resume_is_missed(void **state)
{
    (void)state;
    const char *const names[] = { "cube" };
    tobi_output_def output = make_output();
    tobi_error err = { 0 };
    tobi_world *world = make_world(1, names);
    tobi_run *run = create(world, &output, at("missed"), 0);
    step_until(run, 0.008);
    assert_int_equal(tobi_run_checkpoint(run, &err), TOBI_OK);
    tobi_run_free(run);
    tobi_world_destroy(world);
    const char *const deleted[] = { "bodies.csv", "fluid/fluid_000000.vtu", "surfaces/cube_000002.vtp",
                                    "all.pvd" };
    for (int k = 0; k < 4; k++) assert_int_equal(unlink(at("missed/%s", deleted[k])), 0);

    world = make_world(1, names);
    run = resume(world, &output, at("missed"));
    expect_loss(run, "bodies.csv was deleted and begins anew; missing files of earlier outputs: 2 ");
    assert_null(strstr(tobi_run_losses(run), "history.csv"));
    assert_int_equal(count_listed("missed", "all.pvd"), 7);
    step_until(run, 0.02);
    assert_int_equal(tobi_run_finish(run, "complete", &err), TOBI_OK);
    assert_int_equal(count_listed("missed", "fluid.pvd"), 5);
    assert_int_equal(count_listed("missed", "cube.pvd"), 5);
    assert_int_equal(count_listed("missed", "all.pvd"), 16);
    assert_int_equal(count_rows(at("missed/bodies.csv")), 3);
    assert_int_equal(count_rows(at("missed/history.csv")), 6);
    tobi_run_free(run);
    tobi_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_old_results_are_safe),
        cmocka_unit_test(test_no_link_is_followed),
        cmocka_unit_test(test_the_root_is_no_folder_of_results),
        cmocka_unit_test(test_what_is_deleted_during_a_run_is_missed),
        cmocka_unit_test(test_what_was_deleted_before_a_resume_is_missed),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
