/* The recorder on a tiny tank: which files, which times, never over old results, and going on from
   any step as if nothing had happened. */
#include "record_rig.h"
#include <dirent.h>

static void test_outputs_are_multiples_of_the_interval(void **state)
{
    (void)state;
    /* 3 x 0.1 is 0.30000000000000004: an end of 0.3 must include that output, and no other after
     * it. */
    tobi_output_def output = make_output();
    output.interval = 0.1;
    output.fields = "velocity, velocity,pressure,position";
    tobi_world *world = make_world(0, NULL);
    tobi_run *run = create(world, &output, at("multiples"), 0);
    step_until(run, 0.3);
    assert_true(tobi_world_time(world) == 3 * 0.1);
    assert_int_equal(count_rows(at("multiples/history.csv")), 4);
    assert_true(exists(at("multiples/fluid/fluid_000003.vtu")));
    assert_false(exists(at("multiples/fluid/fluid_000004.vtu")));
    step_until(run, 0.32); /* a stretch that ends between outputs writes none */
    assert_true(fabs(tobi_world_time(world) - 0.32) < 1e-12);
    assert_int_equal(count_rows(at("multiples/history.csv")), 4);
    assert_false(exists(at("multiples/bodies.csv")));
    tobi_run_free(run);
    tobi_world_destroy(world);
}

/* The times in fluid.pvd. */
static void expect_times(const char *dir, int count, const double *times)
{
    size_t n;
    char *list = read_file(at("%s/fluid.pvd", dir), &n), *next = list;
    for (int k = 0; k < count; k++) {
        next = strstr(next, "timestep=\"");
        if (!next) fail_msg("%s has %d outputs, not %d", dir, k, count);
        next += strlen("timestep=\"");
        assert_float_equal(strtod(next, NULL), times[k], 1e-9);
    }
    assert_null(strstr(next, "timestep="));
    free(list);
    assert_int_equal(count_rows(at("%s/history.csv", dir)), count);
}

static tobi_run *resume(tobi_world *world, const tobi_output_def *output, const char *dir)
{
    tobi_run *run = NULL;
    tobi_error err = { 0 };
    if (tobi_run_resume(world, output, dir, &run, &err)) fail_msg("%s", err.text);
    return run;
}

static void end_well(tobi_world *world, tobi_run *run)
{
    tobi_error err = { 0 };
    assert_int_equal(tobi_run_output_end(run, &err), TOBI_OK);
    assert_int_equal(tobi_run_checkpoint(run, &err), TOBI_OK);
    assert_int_equal(tobi_run_finish(run, "complete", &err), TOBI_OK);
    tobi_run_free(run);
    tobi_world_destroy(world);
}

/* The end of a run has an output, once; it stays when the run goes on, and the multiples stay even. */
static void test_the_end_has_an_output(void **state)
{
    (void)state;
    static const double times[] = { 0, 0.004, 0.008, 0.009, 0.012, 0.013, 0.0135, 0.016 };
    static const double ends[] = { 0.009, 0.009, 0.013, 0.0135, 0.016 };
    static const int counts[] = { 4, 4, 6, 7, 8 };
    tobi_output_def output = make_output();
    for (int k = 0; k < 5; k++) {
        tobi_world *world = make_world(0, NULL);
        tobi_run *run = k == 0 ? create(world, &output, at("ends"), 0) : resume(world, &output, at("ends"));
        step_until(run, ends[k]);
        end_well(world, run);
        expect_times("ends", counts[k], times);
    }
    tobi_run_size size;
    tobi_error err;
    tobi_world *world = make_world(0, NULL);
    assert_int_equal(tobi_run_estimate(world, &output, 0.009, &size, &err), TOBI_OK);
    assert_int_equal(size.outputs, 4);
    assert_int_equal(tobi_run_estimate(world, &output, 0.008, &size, &err), TOBI_OK);
    assert_int_equal(size.outputs, 3);
    tobi_world_destroy(world);
}

/* A run of an earlier version has none at its end: resumed, it gets one, and once. */
static void test_an_end_without_output_gets_it(void **state)
{
    (void)state;
    static const double times[] = { 0, 0.004, 0.006 };
    tobi_output_def output = make_output();
    tobi_error err = { 0 };
    tobi_world *world = make_world(0, NULL);
    tobi_run *run = create(world, &output, at("older"), 0);
    step_until(run, 0.006);
    assert_int_equal(tobi_run_checkpoint(run, &err), TOBI_OK);
    tobi_run_free(run);
    tobi_world_destroy(world);
    for (int k = 0; k < 2; k++) {
        world = make_world(0, NULL);
        run = resume(world, &output, at("older"));
        step_until(run, 0.006);
        end_well(world, run);
        expect_times("older", 3, times);
    }
}

/* However long the interval is, the run ends at its end and no earlier. */
static void test_long_intervals_do_not_end_a_run(void **state)
{
    (void)state;
    static const double intervals[] = { 1e7, 1e8, 1e9 };
    for (int k = 0; k < 3; k++) {
        tobi_output_def output = make_output();
        output.interval = intervals[k];
        tobi_world *world = make_world(0, NULL);
        tobi_run *run = create(world, &output, at("long_%d", k), 0);
        assert_false(tobi_run_done(run, 1e-6));
        step_until(run, 0.005);
        assert_true(tobi_world_time(world) == 0.005);
        assert_int_equal(count_rows(at("long_%d/history.csv", k)), 1);
        tobi_run_free(run);
        tobi_world_destroy(world);
    }
}

static void test_body_names_become_file_names(void **state)
{
    (void)state;
    const char *const names[] = { "all", "a/b c", "a_b_c" };
    tobi_output_def output = make_output();
    tobi_world *world = make_world(3, names);
    tobi_run *run = create(world, &output, at("names"), 0);
    assert_true(exists(at("names/all_2.pvd")) && exists(at("names/all.pvd")));
    assert_true(exists(at("names/surfaces/all_2_000000.vtp")));
    assert_true(exists(at("names/a_b_c.pvd")) && exists(at("names/a_b_c_2.pvd")));
    assert_int_equal(count_rows(at("names/bodies.csv")), 3);
    tobi_run_free(run);
    tobi_world_destroy(world);
    /* A body that is named as the tractions of another. */
    const char *const near[] = { "b_tractions", "b", "a" };
    output.tractions = 1;
    world = make_world(3, near);
    run = create(world, &output, at("tractions"), 0);
    assert_true(exists(at("tractions/a_tractions.pvd")) && exists(at("tractions/b_tractions.pvd")));
    assert_true(exists(at("tractions/b_2.pvd")) && exists(at("tractions/b_2_tractions.pvd")));
    assert_true(exists(at("tractions/tractions/b_2_tractions_000000.vtp")));
    tobi_run_free(run);
    tobi_world_destroy(world);
}

static void test_names_of_any_script_stay(void **state)
{
    (void)state;
    const char *const names[] = { "船 1", "舟 1" };
    tobi_output_def output = make_output();
    tobi_world *world = make_world(2, names);
    tobi_run *run = create(world, &output, at("scripts"), 0);
    assert_true(exists(at("scripts/船_1.pvd")) && exists(at("scripts/舟_1.pvd")));
    tobi_run_free(run);
    tobi_world_destroy(world);
}

/* Particles of bodies have their own fields only, and one list has every file under the times of all. */
static void test_bodies_and_the_list_of_all(void **state)
{
    (void)state;
    const char *const names[] = { "cube" };
    const char *const of_water[] = { "pressure", "vorticity" }, *const of_both[] = { "density", "object_id" };
    tobi_output_def output = make_output();
    output.fields = "usual,vorticity";
    output.compression = TOBI_ASCII;
    tobi_world *world = make_world(1, names);
    tobi_run *run = create(world, &output, at("every"), 0);
    step_until(run, 0.008);
    size_t n;
    char *water = read_file(at("every/fluid/fluid_000001.vtu"), &n), key[60];
    char *cube = read_file(at("every/bodies/bodies_000001.vtu"), &n);
    for (int k = 0; k < 2; k++) {
        snprintf(key, sizeof key, "Name=\"%s\"", of_water[k]);
        assert_true(strstr(water, key) && !strstr(cube, key));
        snprintf(key, sizeof key, "Name=\"%s\"", of_both[k]);
        assert_true(strstr(water, key) && strstr(cube, key));
    }
    free(water);
    free(cube);
    const char *const files[] = { "fluid/fluid", "bodies/bodies", "surfaces/cube" };
    char *list = read_file(at("every/all.pvd"), &n), *next = list, line[200];
    for (int k = 0; k < 9; k++) {
        snprintf(line, sizeof line, "<DataSet timestep=\"%.17g\" group=\"\" part=\"%d\" name=\"%s\" "
                 "file=\"%s_%06d.", k/3*output.interval, k%3, strchr(files[k%3], '/') + 1, files[k%3], k/3);
        next = strstr(next, line);
        if (!next) fail_msg("all.pvd lacks, or not in order: %s", line);
    }
    assert_null(strstr(next + 1, "<DataSet"));
    free(list);
    tobi_run_free(run);
    tobi_world_destroy(world);
}

/* Stops after `steps` steps with a checkpoint, in the middle of an interval, and goes on in a new
   world; everything must equal the run that was not stopped. */
static void stop_and_go_on(int steps, bool write_more_first)
{
    const char *const names[] = { "cube" };
    tobi_output_def output = make_output();
    tobi_error err = { 0 };
    tobi_run *run = NULL;
    tobi_world *world = make_world(1, names);
    run = create(world, &output, at("stopped_%d", steps), 0);
    for (int k = 0; k < steps; k++) assert_int_equal(tobi_run_step(run, 0.02, NULL, &err), TOBI_OK);
    assert_int_equal(tobi_run_checkpoint(run, &err), TOBI_OK);
    /* As after a kill: rows and files beyond the checkpoint, and one unfinished. */
    if (write_more_first) step_until(run, 0.016);
    write_file(at("stopped_%d/fluid/fluid_000009.vtu.part", steps), "half a f");
    tobi_run_free(run);
    tobi_world_destroy(world);

    world = make_world(1, names);
    if (tobi_run_resume(world, &output, at("stopped_%d", steps), &run, &err))
        fail_msg("%s", err.text);
    assert_non_null(strstr(tobi_run_note(run), "resumed at"));
    assert_false(exists(at("stopped_%d/fluid/fluid_000009.vtu.part", steps)));
    step_until(run, 0.02);
    tobi_run_free(run);
    tobi_world_destroy(world);
    assert_same_file(at("whole/history.csv"), at("stopped_%d/history.csv", steps));
    assert_same_file(at("whole/bodies.csv"), at("stopped_%d/bodies.csv", steps));
    assert_same_file(at("whole/fluid.pvd"), at("stopped_%d/fluid.pvd", steps));
    assert_same_file(at("whole/all.pvd"), at("stopped_%d/all.pvd", steps));
    assert_same_file(at("whole/fluid/fluid_000005.vtu"),
                     at("stopped_%d/fluid/fluid_000005.vtu", steps));
    assert_same_file(at("whole/cube.pvd"), at("stopped_%d/cube.pvd", steps));
}

static void test_going_on_equals_not_stopping(void **state)
{
    (void)state;
    const char *const names[] = { "cube" };
    tobi_output_def output = make_output();
    tobi_world *world = make_world(1, names);
    tobi_run *run = create(world, &output, at("whole"), 0);
    step_until(run, 0.02);
    assert_int_equal(count_rows(at("whole/history.csv")), 6);
    tobi_run_free(run);
    tobi_world_destroy(world);
    for (int steps = 1; steps < 8; steps += 3) stop_and_go_on(steps, steps == 4);
}

static void test_checkpoints(void **state)
{
    (void)state;
    tobi_output_def output = make_output();
    output.checkpoint_interval = 0.004;
    tobi_error err = { 0 };
    tobi_world *world = make_world(0, NULL);
    tobi_run *run = create(world, &output, at("points"), 0);
    step_until(run, 0.016);
    tobi_run_free(run);
    tobi_world_destroy(world);
    DIR *list = opendir(at("points/checkpoints"));
    int count = 0;
    char newest[300] = "";
    for (const struct dirent *e; (e = readdir(list));) {
        count += e->d_name[0] != '.';
        if (strstr(e->d_name, ".h5") && strcmp(e->d_name, newest) > 0)
            snprintf(newest, sizeof newest, "%s", e->d_name);
    }
    closedir(list);
    assert_int_equal(count, 4);                                 /* two, with their companions */

    write_file(at("points/checkpoints/%s", newest), "nonsense");
    world = make_world(0, NULL);
    if (tobi_run_resume(world, &output, at("points"), &run, &err)) fail_msg("%s", err.text);
    assert_non_null(strstr(tobi_run_note(run), "is damaged"));
    assert_true(fabs(tobi_world_time(world) - 0.012) < 1e-3);
    tobi_run_free(run);
    tobi_world_destroy(world);
    assert_int_equal(count_rows(at("points/history.csv")), 4);

    world = make_world(0, NULL);
    assert_int_equal(tobi_run_resume(world, &output, at("nothing"), &run, &err), TOBI_NOT_FOUND);
    assert_null(run);
    tobi_world_destroy(world);
}

static void test_summary(void **state)
{
    (void)state;
    static const char *const keys[] = { "\"steps\"",
                                        "\"time\"",
                                        "\"wall_s\"",
                                        "\"fluid_particles\"",
                                        "\"body_particles\"",
                                        "\"particle_steps_per_s\"",
                                        "\"density_iterations_mean\"",
                                        "\"divergence_iterations_mean\"",
                                        "\"density_error_mean\"",
                                        "\"density_error_max\"",
                                        "\"particles_lost\"",
                                        "\"put_back\": 0",
                                        "\"peak_rss_bytes\"",
                                        "\"threads\": 1",
                                        "\"version\"",
                                        "\"outcome\": \"complete\"" };
    tobi_output_def output = make_output();
    tobi_error err = { 0 };
    tobi_world *world = make_world(0, NULL);
    tobi_run *run = create(world, &output, at("summary"), 0);
    step_until(run, 0.004);
    assert_int_equal(tobi_run_finish(run, "complete", &err), TOBI_OK);
    size_t n;
    char *text = read_file(at("summary/summary.json"), &n);
    for (size_t k = 0; k < sizeof keys / sizeof *keys; k++)
        if (!strstr(text, keys[k])) fail_msg("summary.json lacks %s", keys[k]);
    free(text);
    tobi_run_free(run);
    tobi_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_outputs_are_multiples_of_the_interval),
        cmocka_unit_test(test_the_end_has_an_output),
        cmocka_unit_test(test_an_end_without_output_gets_it),
        cmocka_unit_test(test_long_intervals_do_not_end_a_run),
        cmocka_unit_test(test_body_names_become_file_names),
        cmocka_unit_test(test_names_of_any_script_stay),
        cmocka_unit_test(test_bodies_and_the_list_of_all),
        cmocka_unit_test(test_going_on_equals_not_stopping),
        cmocka_unit_test(test_checkpoints),
        cmocka_unit_test(test_summary),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
