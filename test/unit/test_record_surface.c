/* Surfaces of a run: a file for each output, in the lists, the same for any number of threads; mistakes. */
#include "record_rig.h"

static void test_files(void **state)
{
    (void)state;
    assert_non_null(mkdtemp(folder));
    const char *const names[] = { "cube", "surface" };
    write_file(at("cube.obj"), "v 0 0 0\nv 0.01 0 0\n"
               "v 0 0.01 0\nv 0 0 0.01\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    for (int threads = 1; threads <= 2; threads++) {
        tobi_world *world = make_world(2, names);
        tobi_output_def output = make_output();
        output.surface = 1;
        output.surface_fields = "usual,density,velocity,velocity_z,velocity_z";
        tobi_run *run = create(world, &output, at("%d", threads), 0);
        step_until(run, 0.008);
        tobi_run_free(run);
        tobi_world_destroy(world);
    }
    for (int k = 0; k < 3; k++) {
        const char *one = at("1/surface/surface_%06d.vtp", k), *two = at("2/surface/surface_%06d.vtp", k);
        assert_same_file(one, two);
        size_t n;
        char *text = read_file(one, &n);
        assert_true(strstr(text, "velocity") && strstr(text, "pressure"));
        assert_true(strstr(text, "Name=\"velocity\" NumberOfComponents=\"3\""));
        const char *part = strstr(text, "Name=\"velocity_z\"");
        assert_true(part && !strstr(part + 1, "Name=\"velocity_z\""));
        assert_true(strstr(text, "density") && strstr(text, "<PointData Normals=\"normals\">"));
        free(text);
    }
    size_t n;
    char *list = read_file(at("1/surface.pvd"), &n), *all = read_file(at("1/all.pvd"), &n);
    assert_non_null(strstr(list, "surface/surface_000002.vtp"));
    assert_non_null(strstr(all, "surface/surface_000002.vtp"));
    assert_true(exists(at("1/surface_2.pvd")));       /* of the body with that name */
    free(list);
    free(all);
    char command[600];
    snprintf(command, sizeof command, "rm -r %s", folder);
    assert_int_equal(system(command), 0);
}

/* A solid in two pieces. */
static tobi_world *make_cubes(void)
{
    tobi_error err = { 0 };
    tobi_world *world = NULL;
    tobi_world_def w = tobi_default_world_def();
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_fill_def fill[2] = { tobi_default_fill_def(), tobi_default_fill_def() };
    w.method = "mlsmpm", w.spacing = 0.05, w.threads = 1;
    for (int a = 0; a < 3; a++) {
        w.domain_min[a] = 0, w.domain_max[a] = 2;
        for (int k = 0; k < 2; k++) {
            fill[k].box_min[a] = a == 0 ? 0.5 + 0.6*k : 0.5;
            fill[k].box_max[a] = fill[k].box_min[a] + 0.3;
        }
    }
    solid.name = "cubes", solid.youngs_modulus = 1e5;
    if (tobi_world_create(&w, NULL, &world, &err) || tobi_world_add_solid(world, &solid, fill, 2, &err))
        fail_msg("%s", err.text);
    return world;
}

/* They are two surfaces, with numbers of their own. */
static void test_pieces(void **state)
{
    (void)state;
    char dir[] = "/tmp/tobiuo_pieces_XXXXXX", path[80], command[80];
    tobi_error err = { 0 };
    tobi_run *run = NULL;
    tobi_world *world = make_cubes();
    tobi_output_def output = make_output();
    assert_non_null(mkdtemp(dir));
    output.surface = 1, output.compression = TOBI_ASCII;
    if (tobi_run_create(world, &output, dir, 1, NULL, &run, &err)) fail_msg("%s", err.text);
    tobi_run_free(run);
    tobi_world_destroy(world);
    snprintf(path, sizeof path, "%s/surface/surface_000000.vtp", dir);
    size_t n;
    char *text = read_file(path, &n), *from = strstr(text, "Name=\"group\"");
    assert_non_null(from);
    int count[4] = { 0 };
    for (from = strchr(from, '>') + 1;;) {
        char *end;
        const long group = strtol(from, &end, 10);
        if (end == from) break;
        if (group < 0 || group > 3) fail_msg("group %ld", group);
        count[group]++;
        from = end;
    }
    assert_int_equal(count[0] + count[3], 0);       /* the one solid is 0, its pieces come behind */
    assert_true(count[1] > 100 && count[2] > 100);
    free(text);
    snprintf(command, sizeof command, "rm -r %s", dir);
    assert_int_equal(system(command), 0);
}

static void expect_refused(tobi_world *world, const tobi_output_def *output, const char *words)
{
    tobi_run *run = NULL;
    tobi_error err = { 0 };
    assert_int_equal(tobi_run_create(world, output, at("wrong"), 0, NULL, &run, &err), TOBI_INVALID);
    if (!strstr(err.text, words)) fail_msg("'%s' without '%s'", err.text, words);
}

static void test_mistakes(void **state)
{
    (void)state;
    tobi_output_def output = make_output();
    output.surface = 1;
    tobi_world *world = make_world(0, NULL);
    output.surface_fields = "velocity,sped";
    expect_refused(world, &output, "output.surface.fields: there is no field 'sped' of dfsph");
    output.surface_fields = "velocity_q";
    expect_refused(world, &output, "output.surface.fields: there is no field 'velocity_q' of dfsph");
    output.surface_fields = "velocity";
    output.surface_cell = 0.01;
    expect_refused(world, &output, "surface.cell");
    tobi_world_destroy(world);
    output = make_output();
    output.surface = 1;
    output.surface_fields = "position,position_x,position_y,position_z,velocity,velocity_x,velocity_y,"
        "velocity_z,deformation_gradient,deformation_gradient_xx,deformation_gradient_xy,"
        "deformation_gradient_xz,deformation_gradient_yx,deformation_gradient_yy,deformation_gradient_yz,"
        "deformation_gradient_zx,deformation_gradient_zy,deformation_gradient_zz,stress,stress_xx,stress_yy,"
        "stress_zz,stress_xy,stress_yz,stress_zx,stress_xz,density,pressure,object_id,particle_id,von_mises,"
        "material,part,piece";
    world = make_cubes();
    expect_refused(world, &output, "output.surface.fields: more than 32");
    tobi_world_destroy(world);
    tobi_world_def flat = tobi_default_world_def();
    tobi_error err = { 0 };
    flat.dimension = 2, flat.spacing = 0.1;
    for (int a = 0; a < 2; a++) flat.domain_min[a] = 0, flat.domain_max[a] = 1;
    assert_int_equal(tobi_world_create(&flat, NULL, &world, &err), TOBI_OK);
    output.surface_cell = 0.75;
    expect_refused(world, &output, "a world of 2 dimensions has no surface");
    tobi_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_files), cmocka_unit_test(test_pieces),
                                        cmocka_unit_test(test_mistakes) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
