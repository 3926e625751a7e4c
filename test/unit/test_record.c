/* The recorder on a tiny tank: which files, which times, never over old results, and going on from
   any step as if nothing had happened. */
#define _GNU_SOURCE 1
#include "tobiuo/run.h"
#include <dirent.h>
#include <fcntl.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cmocka.h>

static char folder[] = "/tmp/tobiuo_record_XXXXXX";

/* A path below the test's folder, valid until the fourth call after. */
static const char *at(const char *format, ...) __attribute__((format(printf, 1, 2)));
static const char *at(const char *format, ...)
{
    static char paths[4][512];
    static int turn;
    char *path = paths[turn++ % 4];
    int n = snprintf(path, sizeof paths[0], "%s/", folder);
    va_list args;
    va_start(args, format);
    vsnprintf(path + n, sizeof paths[0] - (size_t)n, format, args);
    va_end(args);
    return path;
}

static bool exists(const char *path) { return access(path, F_OK) == 0; }

static void write_file(const char *path, const char *text)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

/* Whole file, ended by a zero; the caller frees. */
static char *read_file(const char *path, size_t *length)
{
    FILE *file = fopen(path, "rb");
    if (!file) fail_msg("%s is missing", path);
    char *text = calloc(1, 1 << 22);
    *length = fread(text, 1, (1 << 22) - 1, file);
    fclose(file);
    return text;
}

static void assert_same_file(const char *a, const char *b)
{
    size_t m, n;
    char *x = read_file(a, &m), *y = read_file(b, &n);
    if (m != n || memcmp(x, y, m) != 0) fail_msg("%s and %s differ", a, b);
    free(x);
    free(y);
}

static int count_rows(const char *path)
{
    size_t n;
    int rows = -1;      /* the header */
    char *text = read_file(path, &n);
    for (size_t k = 0; k < n; k++) rows += text[k] == '\n';
    free(text);
    return rows;
}

static tobi_status swing(void *user, double t, int64_t n, const double (*rest)[3],
                         double (*position)[3], tobi_error *err)
{
    (void)user;
    (void)err;
    for (int64_t i = 0; i < n; i++)
        for (int a = 0; a < 3; a++)
            position[i][a] = rest[i][a] + (a == 0 ? 0.01 * sin(20 * t) : 0.0);
    return TOBI_OK;
}

/* A tank of water with `bodies` cubes of the given names in it. */
static tobi_world *make_world(int bodies, const char *const *names)
{
    tobi_error err = { 0 };
    tobi_world *world = NULL;
    tobi_world_def w = tobi_default_world_def();
    const double low[3] = { -0.06, -0.04, 0.0 }, high[3] = { 0.06, 0.04, 0.1 },
                 g[3] = { 0, 0, -9.81 };
    memcpy(w.domain_min, low, sizeof low);
    memcpy(w.domain_max, high, sizeof high);
    memcpy(w.gravity, g, sizeof g);
    w.spacing = 0.01;
    w.threads = 1;
    if (tobi_world_create(&w, NULL, &world, &err)) fail_msg("%s", err.text);
    tobi_fluid_def water = tobi_default_fluid_def();
    water.name = "water";
    water.density = 1000;
    tobi_fill_def fill = tobi_default_fill_def();
    memcpy(fill.box_min, low, sizeof low);
    memcpy(fill.box_max, high, sizeof high);
    fill.box_max[2] = 0.06;
    if (tobi_world_add_fluid(world, &water, &fill, 1, &err)) fail_msg("%s", err.text);
    for (int k = 0; k < bodies; k++) {
        tobi_body_def body = tobi_default_body_def();
        body.name = names[k];
        body.mesh = at("cube.obj");
        body.translation[0] = -0.03 + 0.03 * k;
        body.translation[2] = 0.03;
        body.density = 1000;
        body.spacing = 0.002;
        body.motion = swing;
        body.motion_rigid = 1;
        if (tobi_world_add_body(world, &body, &err)) fail_msg("%s", err.text);
    }
    return world;
}

static tobi_output_def make_output(void)
{
    tobi_output_def output = tobi_default_output_def();
    output.interval = 0.004;
    return output;
}

static tobi_run *create(tobi_world *world, const tobi_output_def *output, const char *dir,
                        int force)
{
    tobi_run *run = NULL;
    tobi_error err = { 0 };
    if (tobi_run_create(world, output, dir, force, "{}\n", &run, &err)) fail_msg("%s", err.text);
    return run;
}

static void step_until(tobi_run *run, double end)
{
    tobi_error err = { 0 };
    while (!tobi_run_done(run, end))
        if (tobi_run_step(run, end, NULL, &err)) fail_msg("%s", err.text);
}

static void expect_failure(tobi_status expected, const char *part, const tobi_output_def *output,
                           const char *dir)
{
    tobi_world *world = make_world(0, NULL);
    tobi_run *run = NULL;
    tobi_error err = { 0 };
    assert_int_equal(tobi_run_create(world, output, dir, 0, NULL, &run, &err), expected);
    if (!strstr(err.text, part)) fail_msg("'%s' without '%s'", err.text, part);
    assert_null(run);
    tobi_world_destroy(world);
}

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
    step_until(run, 0.32); /* an end between outputs writes none */
    assert_true(fabs(tobi_world_time(world) - 0.32) < 1e-12);
    assert_int_equal(count_rows(at("multiples/history.csv")), 4);
    assert_false(exists(at("multiples/bodies.csv")));
    tobi_run_free(run);
    tobi_world_destroy(world);
}

/* However long the interval is, the run ends at its end and no earlier. */
static void test_long_intervals_do_not_end_a_run(void **state)
{
    (void)state;
    static const double intervals[] = { 1e7, 1e18, 1e300 };
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

/* Who may write there gets a root of his own for the time of the call: a mistake must not fill the real one. */
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

static int make_folder(void **state)
{
    (void)state;
    if (!mkdtemp(folder)) return -1;
    char text[600] = "";
    for (int k = 0; k < 8; k++) {
        const double h = 0.01;
        sprintf(text + strlen(text), "v %g %g %g\n", k & 1 ? h : -h, k & 2 ? h : -h,
                k & 4 ? h : -h);
    }
    strcat(text, "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n");
    write_file(at("cube.obj"), text);
    return 0;
}

static int remove_folder(void **state)
{
    (void)state;
    char command[600];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return system(command);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_outputs_are_multiples_of_the_interval),
        cmocka_unit_test(test_long_intervals_do_not_end_a_run),
        cmocka_unit_test(test_old_results_are_safe),
        cmocka_unit_test(test_no_link_is_followed),
        cmocka_unit_test(test_the_root_is_no_folder_of_results),
        cmocka_unit_test(test_body_names_become_file_names),
        cmocka_unit_test(test_bodies_and_the_list_of_all),
        cmocka_unit_test(test_going_on_equals_not_stopping),
        cmocka_unit_test(test_checkpoints),
        cmocka_unit_test(test_summary),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
