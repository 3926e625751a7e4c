/* What the public calls and the files below them refuse, each with its text: one case per message
   that no other test reaches. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#include "calls.h"
#include "own_folder.h"
#include "exec/exec.h"
#include "geom/mesh.h"
#include "geom/quadrature.h"
#include "io/store.h"
#include "io/vtk.h"
#include "rigid/script.h"
#include "tobiuo/run.h"
#include "world/world.h"

static const char box_mesh[] = TOBI_SOURCE_DIR "/test/meshes/box.obj";

static tobi_world_def make_def(void)
{
    tobi_world_def def = tobi_default_world_def();
    for (int a = 0; a < 3; a++) def.domain_max[a] = 1;
    def.spacing = 0.1;
    def.end_time = 1;
    def.threads = 1;
    return def;
}

static tobi_fill_def make_fill(double x0, double x1)
{
    tobi_fill_def fill = tobi_default_fill_def();
    fill.box_min[0] = x0;
    fill.box_max[0] = x1;
    fill.box_max[1] = 1;
    fill.box_max[2] = 0.3;
    return fill;
}

static tobi_world *make_world(const tobi_world_def *def, int filled)
{
    tobi_world *world;
    tobi_error err;
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def fill = make_fill(0, 0.5);
    assert_int_equal(tobi_world_create(def, NULL, &world, &err), TOBI_OK);
    if (filled) assert_int_equal(tobi_world_add_fluid(world, &fluid, &fill, 1, &err), TOBI_OK);
    return world;
}

static void worlds(void **state)
{
    (void)state;
    tobi_world *world;
    tobi_error err;
    tobi_world_def def = make_def();
    def.domain_max[1] = def.domain_min[1];
    REFUSED(tobi_world_create(&def, NULL, &world, &err), TOBI_INVALID,
            "domain.max[1]: is 0 in y, must be greater than domain.min there, 0");
    def = make_def();
    def.dimension = 4;                  /* what has no unit ends the sentence */
    assert_int_equal(tobi_world_create(&def, NULL, &world, &err), TOBI_INVALID);
    assert_string_equal(err.text, "world.dimension is 4, allowed is 2 to 3");
    def = make_def();
    def.wall_min[0] = 99;
    assert_int_equal(tobi_world_create(&def, NULL, &world, &err), TOBI_INVALID);
    assert_string_equal(err.text, "world.domain.walls.x[0] is 99, allowed is 0 to 4");
    def = make_def();
    def.wall_min[2] = TOBI_WALL_PERIODIC;
    REFUSED(tobi_world_create(&def, NULL, &world, &err), TOBI_INVALID,
            "domain.walls.z: is periodic on one side only");
    def = make_def();
    def.wall_velocity_max[2][0] = 1;
    REFUSED(tobi_world_create(&def, NULL, &world, &err), TOBI_INVALID,
            "domain.wall_velocity.z[1]: moves a side that is not no-slip");
    def.wall_max[2] = TOBI_WALL_NO_SLIP;
    def.wall_velocity_max[2][2] = 2;
    REFUSED(tobi_world_create(&def, NULL, &world, &err), TOBI_INVALID,
            "domain.wall_velocity.z[1]: is not along the side: z must be 0");
    tobi_dfsph_def method = tobi_default_dfsph_def();
    def = make_def();
    method.divergence_iterations_min = method.divergence_iterations_max + 1;
    REFUSED(tobi_world_create(&def, &method, &world, &err), TOBI_INVALID,
            "dfsph.divergence_iterations_min: is 201, must not be above divergence_iterations_max, 200");
    def.spacing = 1.5;
    REFUSED(tobi_world_create(&def, NULL, &world, &err), TOBI_INVALID,
            "spacing: is 1.5 m, the domain has only 1 m in x");
    def = make_def();
    def.method = "magic";
    REFUSED(tobi_world_create(&def, NULL, &world, &err), TOBI_INVALID,
            "there is no method 'magic'; known are dfsph, ");
    tobi_exec exec;
    REFUSED(tobi_exec_init(&exec, -1, &err), TOBI_INVALID, "threads is -1, allowed is 0 (all cores)");
    setenv("TOBIUO_ISA", "1", 1);
    REFUSED(tobi_exec_init(&exec, 1, &err), TOBI_INVALID, "TOBIUO_ISA is \"1\", allowed is 2, 3 or 4");
    unsetenv("TOBIUO_ISA");
}

static void fluids(void **state)
{
    (void)state;
    tobi_world_def def = make_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_world *world = make_world(&def, 0);
    REFUSED(tobi_world_start(world, &err), TOBI_INVALID,
            "no particles at all: the scene needs a region of a fluid or solid, or a body");
    tobi_fill_def fill = make_fill(0.5, 0.5);
    REFUSED(tobi_world_add_fluid(world, &fluid, &fill, 1, &err), TOBI_INVALID,
            "fluid 'fluid': box of fill[0]: max 0.5 is not above min 0.5 along x");
    fill = make_fill(2, 3);
    REFUSED(tobi_world_add_fluid(world, &fluid, &fill, 1, &err), TOBI_INVALID,
            "fluid 'fluid': fill[0], a box, reaches from 2 to 3 m along x and lies outside the domain, 0 to "
            "1 m");
    fill.mesh = TOBI_SOURCE_DIR "/test/meshes/sphere.obj";      /* smaller than a particle */
    for (int a = 0; a < 3; a++) {
        fill.scale[a] = 0.01;
        fill.translation[a] = 0.5;
    }
    REFUSED((tobi_world_add_fluid(world, &fluid, &fill, 1, &err), tobi_world_start(world, &err)),
            TOBI_INVALID, "no particles at all in fluid 'fluid': its regions are smaller than the distance");
    tobi_world_destroy(world);

    world = make_world(&def, 1);
    fluid.density = 80;
    fluid.name = "oil";
    REFUSED(tobi_world_add_fluid(world, &fluid, NULL, 0, &err), TOBI_UNSUPPORTED,
            "fluid 'oil': density is 80 kg/m3 and that of fluid 'fluid' is 1000 kg/m3: 1 : 12.5; dfsph ");
    fluid.density = 1000;
    REFUSED((world->system[0].fluid_count = TOBI_FLUID_LIMIT,
             tobi_world_add_fluid(world, &fluid, NULL, 0, &err)), TOBI_UNSUPPORTED, "more than 8 fluids");
    world->system[0].fluid_count = 1;
    tobi_body_def body = tobi_default_body_def();
    assert_int_equal(tobi_world_start(world, NULL), TOBI_OK);
    REFUSED(tobi_world_add_fluid(world, &fluid, NULL, 0, &err), TOBI_INVALID,
            "a started world takes no more fluids");
    REFUSED(tobi_world_add_body(world, &body, &err), TOBI_INVALID,
            "a started world takes no more bodies");
    tobi_world_destroy(world);
}

static void bodies_and_probes(void **state)
{
    (void)state;
    tobi_world_def def = make_def();
    tobi_body_def body = tobi_default_body_def();
    tobi_world *world = make_world(&def, 1);
    REFUSED(tobi_world_add_body(world, &body, &err), TOBI_INVALID,
            "body 'body': has no mesh, and its box has max 0 not above min 0 along x");
    body.mesh = box_mesh;
    REFUSED(tobi_world_add_body(world, &body, &err), TOBI_INVALID,
            "sticks out of the domain: a vertex is at x = -0.5 m, allowed is 0 to 1 m");
    for (int a = 0; a < 3; a++) body.scale[a] = 1000;
    REFUSED(tobi_world_add_body(world, &body, &err), TOBI_INVALID, "does not fit: the mesh is");
    for (int a = 0; a < 3; a++) body.scale[a] = 1;
    body.spacing = 1e-6;
    REFUSED(tobi_world_add_body(world, &body, &err), TOBI_NO_MEMORY, "surface points, about");
    world->sim.body_count = TOBI_BODY_LIMIT;
    REFUSED(tobi_world_add_body(world, &body, &err), TOBI_UNSUPPORTED, "more than 1024 bodies");
    world->sim.body_count = 0;
    tobi_probe_def probe = tobi_default_probe_def();
    world->probe_count = TOBI_PROBE_LIMIT;
    REFUSED(tobi_world_add_probe(world, &probe, &err), TOBI_UNSUPPORTED, "more than 1024 probes");
    world->probe_count = 0;
    tobi_world_destroy(world);
}

/* Rises with 2 m/s from time 0 to 1 and knows no other times. */
static tobi_status rise(void *user, double t, int64_t n, const double (*rest)[3], double (*position)[3],
                        tobi_error *err)
{
    (void)user;
    if (t < 0 || t > 1) {
        if (err) snprintf(err->text, sizeof err->text, "no motion at %g s", t);
        return TOBI_SCRIPT;
    }
    for (int64_t i = 0; i < n; i++)
        for (int a = 0; a < 3; a++) position[i][a] = rest[i][a] + (a == 2 ? 2*t : 0);
    return TOBI_OK;
}

static void motions_of_few_times(void **state)
{
    (void)state;
    double velocity[3*64];
    tobi_world_def def = make_def();
    tobi_body_def body = tobi_default_body_def();
    tobi_world *world = make_world(&def, 0);
    for (int a = 0; a < 3; a++) body.box_max[a] = 0.4;
    body.motion = rise;
    body.motion_rigid = 1;
    assert_int_equal(tobi_world_add_body(world, &body, NULL), TOBI_OK);
    assert_int_equal(tobi_world_read(world, TOBI_BODIES, "velocity", velocity, 64, NULL), TOBI_OK);
    assert_true(velocity[2] > 1.999 && velocity[2] < 2.001);
    world->sim.time = 1;
    REFUSED(tobi_world_read(world, TOBI_BODIES, "velocity", velocity, 64, &err), TOBI_SCRIPT,
            "no motion at 1.00001 s");
    tobi_world_destroy(world);
}

static void particles_beyond_the_machine(void **state)
{
    (void)state;
    tobi_world_def def = make_def();
    def.spacing = 1e-3 * 0.6;          /* 7e8 particles; more than 0.95 of 128 GiB is refused */
    tobi_world *world = make_world(&def, 1);
    int64_t fluid, body, bytes;
    assert_int_equal(tobi_world_estimate(world, &fluid, &body, &bytes, NULL), TOBI_OK);
    double have = (double)sysconf(_SC_PHYS_PAGES)*(double)sysconf(_SC_PAGESIZE);
    if ((double)bytes > 0.95*have && fluid < 2000000000)
        REFUSED(tobi_world_start(world, &err), TOBI_NO_MEMORY, "A larger spacing needs less");
    tobi_world_destroy(world);
}

static void fields(void **state)
{
    (void)state;
    double buffer[3*150] = { 0 };
    tobi_world_def def = make_def();
    tobi_world *world = make_world(&def, 1);
    REFUSED(tobi_world_read(world, TOBI_FLUID, "magic", buffer, 150, &err), TOBI_NOT_FOUND,
            "there is no field 'magic'");
    REFUSED(tobi_world_read(world, TOBI_FLUID, "velocity", buffer, 1, &err), TOBI_INVALID,
            "field 'velocity' has 150 rows, room for 1 given");
    REFUSED(tobi_world_write(world, "density", buffer, 150, &err), TOBI_INVALID,
            "field 'density' cannot be set; allowed are velocity and pressure");
    REFUSED(tobi_world_write(world, "velocity", buffer, 1, &err), TOBI_INVALID,
            "field 'velocity' has 150 rows, 1 given");
    tobi_world_destroy(world);
}

static void divergence(void **state)
{
    (void)state;
    double fast[3*150] = { 0 };
    tobi_world_def def = make_def();
    def.speed_limit = 10;
    tobi_world *world = make_world(&def, 1);
    fast[4] = 50;
    assert_int_equal(tobi_world_write(world, "velocity", fast, 150, NULL), TOBI_OK);
    REFUSED(tobi_world_step(world, 1e-4, NULL, &err), TOBI_DIVERGED, "the limit is 10 m/s");
    REFUSED(tobi_world_step(world, 1e-4, NULL, &err), TOBI_DIVERGED, "cannot go on");
    tobi_world_destroy(world);
}

/* Every field of a world that has diverged can be read; what follows from neighbours is no number. */
static void diverged_worlds_are_readable(void **state)
{
    (void)state;
    static const char *const methods[] = { "dfsph", "wcsph", "isph", "eisph" };
    for (int k = 0; k < 4; k++) {
        double buffer[9*150] = { 0 }, fast[3*150] = { 0 };
        tobi_world_def def = make_def();
        def.method = methods[k];
        def.speed_limit = 10;
        tobi_world *world = make_world(&def, 1);
        tobi_scalar_def scalar = tobi_default_scalar_def();
        for (scalar.field = 0; scalar.field < 2; scalar.field++)
            assert_int_equal(tobi_world_add_scalar(world, &scalar, NULL), TOBI_OK);
        fast[4] = 50;
        assert_int_equal(tobi_world_write(world, "velocity", fast, 150, NULL), TOBI_OK);
        REFUSED(tobi_world_step(world, 1e-4, NULL, &err), TOBI_DIVERGED, "the limit is 10 m/s");
        const char *field;
        for (int n = 0; (field = tobi_method_field(methods[k], n)); n++)
            assert_int_equal(tobi_world_read(world, TOBI_FLUID, field, buffer, 9*150, NULL), TOBI_OK);
        assert_int_equal(tobi_world_read(world, TOBI_FLUID, "velocity", buffer, 9*150, NULL), TOBI_OK);
        assert_true(buffer[4] > 10);
        assert_int_equal(tobi_world_read(world, TOBI_FLUID, "pressure", buffer, 150, NULL), TOBI_OK);
        assert_true(isnan(buffer[0]));
        tobi_world_destroy(world);
    }
}

static void checkpoints_of_others(void **state)
{
    (void)state;
    tobi_world_def def = make_def();
    tobi_world *world = make_world(&def, 1);
    assert_int_equal(tobi_world_save(world, "other.h5", NULL), TOBI_OK);
    tobi_world_destroy(world);
    def.spacing = 0.05;
    world = make_world(&def, 1);
    REFUSED(tobi_world_load(world, "other.h5", &err), TOBI_INVALID,
            "the checkpoint is of another scene: its spacing is 0.1 m");
    tobi_world_destroy(world);

    tobi_body_def body = tobi_default_body_def();
    body.name = "box";
    for (int k = 0; k < 3; k++) body.box_min[k] = 0.8, body.box_max[k] = 0.9;
    def.spacing = 0.1;
    world = make_world(&def, 1);
    OK(tobi_world_add_body(world, &body, &err));
    REFUSED(tobi_world_load(world, "other.h5", &err), TOBI_INVALID, "it has 0 bodies, the scene 1");
    OK(tobi_world_save(world, "body.h5", &err));
    tobi_world_destroy(world);
    body.box_max[0] = 0.95;             /* its mesh was drawn anew meanwhile */
    world = make_world(&def, 1);
    OK(tobi_world_add_body(world, &body, &err));
    REFUSED(tobi_world_load(world, "body.h5", &err), TOBI_INVALID, "the checkpoint is of another scene: body "
            "'box' has 0.001 m3, 1 kg");
    tobi_world_destroy(world);
    remove("body.h5");

    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def small = make_fill(0, 0.2);
    world = make_world(&def, 0);
    assert_int_equal(tobi_world_add_fluid(world, &fluid, &small, 1, NULL), TOBI_OK);
    REFUSED(tobi_world_load(world, "other.h5", &err), TOBI_INVALID,
            "other.h5: is of another scene: that began with 150 particles, this one with 60");
    tobi_store *store;
    assert_int_equal(tobi_store_create("other.h5", &store, NULL), TOBI_OK);
    assert_int_equal(tobi_store_put_int(store, "format", 1000, NULL), TOBI_OK);
    assert_int_equal(tobi_store_commit(store, NULL), TOBI_OK);
    REFUSED(tobi_world_load(world, "other.h5", &err), TOBI_UNSUPPORTED,
            "other.h5: a checkpoint of format 1000, written by another version of tobiuo; this one goes on "
            "from format");
    tobi_world_destroy(world);
    remove("other.h5");
}

static void meshes(void **state)
{
    (void)state;
    static const double corner[4][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
    static const int32_t face[4][3] = { { 0, 2, 1 }, { 0, 1, 3 }, { 1, 2, 3 }, { 0, 3, 2 } };
    tobi_mesh mesh, empty = { 0 };
    REFUSED(tobi_mesh_build("m", INT64_C(1) << 40, corner, 4, face, &mesh, &err), TOBI_INVALID,
            "1099511627776 vertices and 4 triangles; allowed are at most");
    REFUSED(tobi_mesh_orient(&empty, "m", &err), TOBI_INVALID, "no triangles; a closed surface");
    assert_int_equal(tobi_mesh_build("m", 4, corner, 4, face, &mesh, NULL), TOBI_OK);
    tobi_quadrature surface;
    for (int i = 0; i < mesh.vertex_count; i++) mesh.vertices[i][2] -= 0.25;   /* across z = 0 */
    REFUSED(tobi_quadrature_build(&mesh, 1e-12, 2, &surface, &err), TOBI_INVALID,
            "an outline in pieces of 1e-12 m needs more than");
    tobi_mesh_free(&mesh);

    struct rlimit limit, less;
    int next = dup(0);
    assert_true(next > 0);
    close(next);
    assert_int_equal(getrlimit(RLIMIT_NOFILE, &limit), 0);
    less = limit;
    less.rlim_cur = (rlim_t)next + 1;      /* one more file, but no pipe */
    assert_int_equal(setrlimit(RLIMIT_NOFILE, &less), 0);
    tobi_error err = { 0 };
    tobi_status status = tobi_mesh_read(box_mesh, &mesh, &err);
    assert_int_equal(setrlimit(RLIMIT_NOFILE, &limit), 0);
    assert_int_equal(status, TOBI_IO);
    assert_non_null(strstr(err.text, "no pipe for the importer: "));
}

static void files(void **state)
{
    (void)state;
    tobi_store *store;
    assert_int_equal(tobi_store_create("store.h5", &store, NULL), TOBI_OK);
    REFUSED(tobi_store_put(store, "a", TOBI_F64, 1, 0, &store, &err), TOBI_INVALID,
            "array 'a' of 1 rows x 0, type");
    tobi_store_close(store);
    REFUSED(tobi_stl_write("s.stl", -1, NULL, 0, NULL, &err), TOBI_INVALID,
            "a negative number of vertices or triangles");
    REFUSED(tobi_vtu_write("p.vtu", TOBI_COMPRESS_NONE, 3, NULL, NULL, 0, &err), TOBI_INVALID,
            "p.vtu: no points");

    tobi_script *script;
    FILE *file = fopen("long.lua", "wb");
    assert_int_equal(fseek(file, 4 << 20, SEEK_SET), 0);
    fputc('\n', file);
    fclose(file);
    REFUSED(tobi_script_load("long.lua", NULL, TOBI_MOTION_SCRIPT, &script, &err), TOBI_INVALID,
            "has 4194305 bytes; allowed are at most 4194304");
    remove("long.lua");
}

/* A checkpoint's two files belong together, and to their scene. */
static void checkpoints_of_runs(void **state)
{
    (void)state;
    tobi_world_def def = make_def();
    tobi_output_def output = tobi_default_output_def();
    tobi_run *run;
    tobi_world *world = make_world(&def, 1);
    glob_t found;
    assert_int_equal(tobi_run_create(world, &output, "swapped", 1, NULL, &run, NULL), TOBI_OK);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(tobi_run_step(run, 1, NULL, NULL), TOBI_OK);
        assert_int_equal(tobi_run_checkpoint(run, NULL), TOBI_OK);
    }
    tobi_run_free(run);
    tobi_world_destroy(world);

    def.spacing = 0.05;
    world = make_world(&def, 1);
    REFUSED(tobi_run_resume(world, &output, "swapped", &run, &err), TOBI_INVALID,
            "the checkpoint is of another scene: its spacing is 0.1 m");
    tobi_world_destroy(world);

    assert_int_equal(glob("swapped/checkpoints/*.json", 0, NULL, &found), 0);
    assert_int_equal(found.gl_pathc, 2);
    assert_int_equal(rename(found.gl_pathv[0], "kept.json"), 0);
    assert_int_equal(rename(found.gl_pathv[1], found.gl_pathv[0]), 0);
    assert_int_equal(rename("kept.json", found.gl_pathv[1]), 0);
    def.spacing = 0.1;
    world = make_world(&def, 1);
    REFUSED(tobi_run_resume(world, &output, "swapped", &run, &err), TOBI_DAMAGED,
            "does not belong to its checkpoint");
    tobi_world_destroy(world);

    for (size_t i = 0; i < found.gl_pathc; i++) remove(found.gl_pathv[i]);
    globfree(&found);
    world = make_world(&def, 1);
    REFUSED(tobi_run_resume(world, &output, "swapped", &run, &err), TOBI_DAMAGED,
            "json: damaged or missing");
    tobi_world_destroy(world);
}

static void runs(void **state)
{
    (void)state;
    tobi_world_def def = make_def();
    tobi_output_def output = tobi_default_output_def();
    tobi_run *run;
    tobi_world *world = make_world(&def, 1);
    REFUSED(tobi_run_create(world, &output, "/proc/tobiuo", 0, NULL, &run, &err), TOBI_IO,
            "cannot make the directory /proc/tobiuo: ");
    rmdir("locked");
    mkdir("locked", 0555);
    uid_t user = geteuid();
    if (user == 0) assert_int_equal(seteuid(65534), 0);      /* root may write anywhere */
    tobi_error denied = { 0 };
    tobi_status status = tobi_run_create(world, &output, "locked", 0, NULL, &run, &denied);
    assert_int_equal(seteuid(user), 0);
    assert_int_equal(status, TOBI_IO);
    assert_non_null(strstr(denied.text, "cannot write to the directory locked: "));
    rmdir("locked");
    mkdir("stuck", 0700);
    mkdir("stuck/fluid", 0700);
    mkdir("stuck/fluid/fluid_000000.vtu", 0700);             /* a folder where a result should be */
    REFUSED(tobi_run_create(world, &output, "stuck", 1, NULL, &run, &err), TOBI_IO,
            "cannot remove stuck/fluid/fluid_000000.vtu: ");
    rmdir("stuck/fluid/fluid_000000.vtu");
    rmdir("stuck/fluid");
    rmdir("stuck");
    tobi_world_destroy(world);
}

/* Tension is told what it needs, and only a fluid that has it pays for its fields. */
static void surface_tension(void **state)
{
    (void)state;
    int64_t fluid, body, bytes[2];
    for (int k = 0; k < 3; k++) {
        tobi_world_def def = make_def();
        tobi_dfsph_def method = tobi_default_dfsph_def();
        tobi_fluid_def water = tobi_default_fluid_def();
        tobi_fill_def fill = make_fill(0, 0.5);
        tobi_world *world;
        tobi_error err = { 0 };
        method.support = k == 2 ? 2.5 : 2;
        water.surface_tension = k > 0 ? 0.0728 : 0;
        assert_int_equal(tobi_world_create(&def, &method, &world, &err), TOBI_OK);
        assert_int_equal(tobi_world_add_fluid(world, &water, &fill, 1, &err), TOBI_OK);
        assert_int_equal(!tobi_world_note(world, 0), k == 0);
        if (k > 0) assert_non_null(strstr(tobi_world_note(world, 0), "needs a support of 2.5 or more"));
        if (k < 2) tobi_world_estimate(world, &fluid, &body, &bytes[k], &err);
        tobi_world_destroy(world);
    }
    assert_int_equal(bytes[1] - bytes[0], 20*fluid);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(worlds),
        cmocka_unit_test(fluids),
        cmocka_unit_test(surface_tension),
        cmocka_unit_test(bodies_and_probes),
        cmocka_unit_test(motions_of_few_times),
        cmocka_unit_test(particles_beyond_the_machine),
        cmocka_unit_test(fields),
        cmocka_unit_test(divergence), cmocka_unit_test(diverged_worlds_are_readable),
        cmocka_unit_test(checkpoints_of_others),
        cmocka_unit_test(meshes),
        cmocka_unit_test(files),
        cmocka_unit_test(checkpoints_of_runs),
        cmocka_unit_test(runs),
    };
    return cmocka_run_group_tests(tests, enter_own_folder, leave_own_folder);
}
