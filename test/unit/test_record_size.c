/* What a run is told to write against what it writes. */
#define _GNU_SOURCE 1
#include "record_rig.h"
#include "tobiuo/scene.h"
#include <ftw.h>

static double bytes_found;
static int files_found;

static int count_file(const char *path, const struct stat *info, int kind, struct FTW *place)
{
    (void)path;
    (void)place;
    if (kind != FTW_F) return 0;
    files_found++;
    bytes_found += (double)info->st_size;
    return 0;
}

/* Runs to `end` and compares. */
static void expect_size(tobi_world *world, const tobi_output_def *output, double end, const char *name)
{
    tobi_run_size size;
    tobi_error err = { 0 };
    assert_int_equal(tobi_run_estimate(world, output, end, &size, &err), TOBI_OK);
    tobi_run *run = create(world, output, at("%s", name), 0);
    step_until(run, end);
    assert_int_equal(tobi_run_checkpoint(run, &err), TOBI_OK);
    assert_int_equal(tobi_run_finish(run, "complete", &err), TOBI_OK);
    tobi_run_free(run);
    bytes_found = files_found = 0;
    assert_int_equal(nftw(at("%s", name), count_file, 8, FTW_PHYS), 0);
    const double ratio = size.bytes / bytes_found;
    if (size.files != files_found) fail_msg("%s: %d files, not %g", name, files_found, size.files);
    if (!(ratio > 1 / 1.5 && ratio < 1.5))
        fail_msg("%s: %g bytes, not %g", name, bytes_found, size.bytes);
}

/* A shipped scene, coarsely, with ten outputs after the first. */
static void expect_scene(const char *name, const char *change, double spacing, double end)
{
    char path[512], width[64], until[64], every[64], dir[128];
    tobi_scene *scene;
    tobi_world *world;
    tobi_error err = { 0 };
    if (SANITIZED) end /= 4;
    snprintf(path, sizeof path, "%s/scenes/%s/scene.json", TOBI_SOURCE_DIR, name);
    snprintf(width, sizeof width, "spacing=%g", spacing);
    snprintf(until, sizeof until, "end_time=%g", end);
    snprintf(every, sizeof every, "output.interval=%g", end / 10);
    snprintf(dir, sizeof dir, "%s %s", name, change);
    const char *overrides[] = { width, until, every, change, "threads=1", NULL };
    if (tobi_scene_load(path, overrides, &scene, NULL, &err) || tobi_scene_build(scene, &world, &err))
        fail_msg("%s: %s", name, err.text);
    expect_size(world, tobi_scene_output_def(scene), end, dir);
    tobi_world_destroy(world);
    tobi_scene_free(scene);
}

static void test_shipped_scenes_take_what_is_told(void **state)
{
    (void)state;
    expect_scene("dam_break", "output.compression=zlib", 0.0125, 0.2);
    expect_scene("dam_break", "output.compression=lz4", 0.0125, 0.1);
    expect_scene("dam_break", "output.compression=ascii", 0.0125, 0.1);
    expect_scene("cheese_wire", "output.fields=usual", 0.005, 0.05);
    expect_scene("floating_cube", "output.grid=true", 0.025, 0.1);
}

static void test_every_kind_of_file_is_told(void **state)
{
    (void)state;
    const char *const names[] = { "left", "right" };
    tobi_world *world = make_world(2, names);
    tobi_output_def output = make_output();
    tobi_error err = { 0 };
    tobi_probe_def probe = tobi_default_probe_def();
    probe.name = "P";
    assert_int_equal(tobi_world_add_probe(world, &probe, &err), TOBI_OK);
    output.compression = TOBI_COMPRESS_NONE;
    output.ply = output.obj = output.frames = 1;
    output.checkpoint_interval = 0.004;
    expect_size(world, &output, 0.008, "every kind");
    tobi_world_destroy(world);
}

static void test_mistakes_are_those_of_a_run(void **state)
{
    (void)state;
    tobi_world *world = make_world(0, NULL);
    tobi_output_def output = make_output();
    tobi_run_size size;
    tobi_error err = { 0 };
    output.interval = NAN;
    assert_int_equal(tobi_run_estimate(world, &output, 1, &size, &err), TOBI_INVALID);
    assert_non_null(strstr(err.text, "output.interval is not a finite number"));
    output = make_output();
    output.fields = "presure";
    assert_int_equal(tobi_run_estimate(world, &output, 1, &size, &err), TOBI_INVALID);
    assert_non_null(strstr(err.text, "there is no field 'presure'"));
    output = make_output();
    output.interval = 1e-12;
    assert_int_equal(tobi_run_estimate(world, &output, 1e9, &size, &err), TOBI_OK);
    assert_true(size.outputs > 0 && isfinite(size.bytes) && size.bytes > 1e18);
    tobi_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shipped_scenes_take_what_is_told),
        cmocka_unit_test(test_every_kind_of_file_is_told),
        cmocka_unit_test(test_mistakes_are_those_of_a_run),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
