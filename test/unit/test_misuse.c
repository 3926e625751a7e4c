/* Programs that call wrongly: every public function with NULL, with numbers of nothing and with numbers that
   are none. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "calls.h"
#include "own_folder.h"
#include "tobiuo/drawing.h"
#include "tobiuo/motion.h"
#include "tobiuo/overlay.h"
#include "tobiuo/params.h"
#include "tobiuo/run.h"
#include "tobiuo/scene.h"

#define NULL_WORLD "world is NULL"

static tobi_world *make_world(const char *method)
{
    tobi_world_def def = tobi_default_world_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_world *world;
    def.method = method;
    for (int a = 0; a < 3; a++) def.domain_max[a] = fill.box_max[a] = 0.4;
    def.spacing = 0.1;
    def.threads = 1;
    OK(tobi_world_create(&def, NULL, &world, &err));
    if (strcmp(method, "mlsmpm") == 0) OK(tobi_world_add_solid(world, &solid, &fill, 1, &err));
    else OK(tobi_world_add_fluid(world, &fluid, &fill, 1, &err));
    return world;
}

static void no_world(void **state)
{
    (void)state;
    const tobi_fluid_def fluid = tobi_default_fluid_def();
    const tobi_solid_def solid = tobi_default_solid_def();
    const tobi_body_def body = tobi_default_body_def();
    const tobi_plane_def plane = tobi_default_plane_def();
    const tobi_probe_def probe = tobi_default_probe_def();
    tobi_probe_info seen;
    const tobi_grid *grid;
    const tobi_pieces *pieces;
    int64_t n;
    double v;
    REFUSED(tobi_world_add_fluid(NULL, &fluid, NULL, 0, &err), TOBI_INVALID,
            "tobi_world_add_fluid: world is NULL");
    REFUSED(tobi_world_add_solid(NULL, &solid, NULL, 0, &err), TOBI_INVALID, NULL_WORLD);
    REFUSED(tobi_world_add_body(NULL, &body, &err), TOBI_INVALID, NULL_WORLD);
    REFUSED(tobi_world_add_plane(NULL, &plane, &err), TOBI_INVALID, NULL_WORLD);
    REFUSED(tobi_world_add_probe(NULL, &probe, &err), TOBI_INVALID, NULL_WORLD);
    REFUSED(tobi_world_estimate(NULL, &n, &n, &n, &err), TOBI_INVALID, NULL_WORLD);
    REFUSED(tobi_world_start(NULL, &err), TOBI_INVALID, NULL_WORLD);
    REFUSED(tobi_world_step(NULL, 0, NULL, &err), TOBI_INVALID, NULL_WORLD);
    REFUSED(tobi_world_advance(NULL, 1, NULL, &err), TOBI_INVALID, NULL_WORLD);
    REFUSED(tobi_world_probe(NULL, 0, &seen, &err), TOBI_INVALID, NULL_WORLD);
    REFUSED(tobi_world_read(NULL, TOBI_FLUID, "velocity", &v, 1, &err), TOBI_INVALID, NULL_WORLD);
    REFUSED(tobi_world_write(NULL, "velocity", &v, 0, &err), TOBI_INVALID, NULL_WORLD);
    REFUSED(tobi_world_grid(NULL, &grid, &err), TOBI_INVALID, NULL_WORLD);
    REFUSED(tobi_world_pieces(NULL, &pieces, &err), TOBI_INVALID, NULL_WORLD);
    REFUSED(tobi_world_save(NULL, "x.h5", &err), TOBI_INVALID, NULL_WORLD);
    REFUSED(tobi_world_load(NULL, "x.h5", &err), TOBI_INVALID, NULL_WORLD);
    assert_int_equal(tobi_world_step(NULL, 0, NULL, NULL), TOBI_INVALID);
    tobi_world_set_stop(NULL, NULL, NULL);
    tobi_world_destroy(NULL);
}

/* Calls without a text: a status, or 0 and NULL. */
static void no_world_and_no_text(void **state)
{
    (void)state;
    tobi_world *w = make_world("dfsph");
    tobi_body_info body;
    tobi_solid_info solid;
    int64_t n;
    const double (*vertices)[3];
    const int32_t (*triangles)[3];
    assert_int_equal(tobi_world_body(NULL, 0, &body), TOBI_INVALID);
    assert_int_equal(tobi_world_body(w, 0, NULL), TOBI_INVALID);
    assert_int_equal(tobi_world_solid(NULL, 0, &solid), TOBI_INVALID);
    assert_int_equal(tobi_world_solid(w, 0, NULL), TOBI_INVALID);
    assert_int_equal(tobi_world_surface(NULL, 0, &n, &vertices, &n, &triangles), TOBI_INVALID);
    assert_int_equal(tobi_world_surface(w, 0, NULL, NULL, NULL, NULL), TOBI_INVALID);
    for (int k = -1; k < 3; k += 2) {
        assert_int_equal(tobi_world_body(w, k, &body), TOBI_NOT_FOUND);
        assert_int_equal(tobi_world_solid(w, k, &solid), TOBI_NOT_FOUND);
        assert_int_equal(tobi_world_surface(w, k, &n, &vertices, &n, &triangles), TOBI_NOT_FOUND);
        assert_null(tobi_world_body_name(w, k));
        assert_null(tobi_world_probe_name(w, k, NULL));
        assert_null(tobi_world_note(NULL, k));
        assert_null(tobi_world_stage(w, k, NULL));
        assert_null(tobi_world_memory(w, k < 0 ? k : 1000, NULL));
        assert_null(tobi_world_field_name(k < 0 ? k : 1000, NULL, NULL));
    }
    assert_true(tobi_world_time(NULL) == 0 && tobi_world_stable_step(NULL) == 0);
    assert_false(tobi_world_closed(NULL, NULL));
    assert_true(!tobi_world_info(NULL) && !tobi_world_note(NULL, 0) && !tobi_world_stage(NULL, 0, NULL) &&
                !tobi_world_memory(NULL, 0, NULL));
    assert_true(!tobi_world_body_name(NULL, 0) && !tobi_world_probe_name(NULL, 0, NULL));
    assert_int_equal(tobi_world_body_count(NULL) + tobi_world_solid_count(NULL) +
                        tobi_world_probe_count(NULL), 0);
    assert_int_equal(tobi_world_count(NULL, TOBI_FLUID) + tobi_world_bytes(NULL), 0);
    assert_int_equal(tobi_world_hash(NULL), 0);
    assert_non_null(tobi_status_text((tobi_status)1000));
    tobi_world_destroy(w);
}

static void nothing_where_something_must_stand(void **state)
{
    (void)state;
    tobi_world *w = make_world("dfsph"), *none = w;
    const tobi_world_def def = tobi_default_world_def();
    const tobi_fluid_def fluid = tobi_default_fluid_def();
    const tobi_fill_def fill = tobi_default_fill_def();
    tobi_probe_def nameless = tobi_default_probe_def();
    double v = 0;
    nameless.name = NULL;
    REFUSED(tobi_world_create(&def, NULL, NULL, &err), TOBI_INVALID, "where the world goes is NULL");
    REFUSED(tobi_world_create(NULL, NULL, &none, &err), TOBI_INVALID, "the definition is NULL");
    assert_null(none);
    REFUSED(tobi_world_add_fluid(w, NULL, &fill, 1, &err), TOBI_INVALID, "the definition is NULL");
    REFUSED(tobi_world_add_fluid(w, &fluid, NULL, 2, &err), TOBI_INVALID,
            "fill_count is 2 and fills is NULL, allowed is 0 to 67327");
    REFUSED(tobi_world_add_fluid(w, &fluid, &fill, -1, &err), TOBI_INVALID, "fill_count is -1, allowed is");
    REFUSED(tobi_world_add_solid(w, NULL, &fill, 1, &err), TOBI_INVALID, "the definition is NULL");
    REFUSED(tobi_world_add_body(w, NULL, &err), TOBI_INVALID, "the definition is NULL");
    REFUSED(tobi_world_add_plane(w, NULL, &err), TOBI_INVALID, "the definition is NULL");
    REFUSED(tobi_world_add_probe(w, NULL, &err), TOBI_INVALID, "the definition is NULL");
    REFUSED(tobi_world_add_probe(w, &nameless, &err), TOBI_INVALID, "the name of the probe is NULL");
    REFUSED(tobi_world_probe(w, 0, NULL, &err), TOBI_INVALID, "where the values go is NULL");
    REFUSED(tobi_world_estimate(w, NULL, NULL, NULL, &err), TOBI_INVALID, "where a number goes is NULL");
    REFUSED(tobi_world_read(w, TOBI_FLUID, NULL, &v, 1, &err), TOBI_INVALID,
            "tobi_world_read: the field is NULL");
    REFUSED(tobi_world_read(w, TOBI_FLUID, "pressure", NULL, 64, &err), TOBI_INVALID, "the buffer is NULL");
    REFUSED(tobi_world_read(w, (tobi_set)7, "pressure", &v, 1, &err), TOBI_INVALID,
            "there is no set of particles 7");
    REFUSED(tobi_world_write(w, NULL, &v, 1, &err), TOBI_INVALID, "the field is NULL");
    REFUSED(tobi_world_grid(w, NULL, &err), TOBI_INVALID, "where the grid goes is NULL");
    REFUSED(tobi_world_pieces(w, NULL, &err), TOBI_INVALID, "where the pieces go is NULL");
    REFUSED(tobi_world_save(w, NULL, &err), TOBI_INVALID, "the path is NULL");
    REFUSED(tobi_world_save(w, "", &err), TOBI_INVALID, "cannot write a file: its path is empty");
    REFUSED(tobi_world_load(w, "", &err), TOBI_NOT_FOUND, "checkpoint: its path is empty");
    REFUSED(tobi_world_load(w, NULL, &err), TOBI_INVALID, "the path is NULL");
    tobi_world_destroy(w);
}

/* What refers to an object by its name must not meet two. */
static void names_that_are_taken(void **state)
{
    (void)state;
    tobi_world *w = make_world("dfsph");
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_body_def body = tobi_default_body_def();
    tobi_probe_def probe = tobi_default_probe_def();
    REFUSED(tobi_world_add_fluid(w, &fluid, NULL, 0, &err), TOBI_INVALID,
            "fluid 'fluid': fluid 0 has that name already");
    solid.name = "fluid";
    REFUSED(tobi_world_add_solid(w, &solid, NULL, 0, &err), TOBI_INVALID,
            "solid 'fluid': fluid 0 has that name already");
    solid.name = "block";
    OK(tobi_world_add_solid(w, &solid, NULL, 0, &err));
    body.name = "block";
    body.mesh = TOBI_SOURCE_DIR "/test/meshes/box.obj";
    for (int a = 0; a < 3; a++) {
        body.scale[a] = 0.05;
        body.translation[a] = 0.2;
    }
    REFUSED(tobi_world_add_body(w, &body, &err), TOBI_INVALID, "body 'block': solid 0 has that name already");
    body.name = "ball";
    OK(tobi_world_add_body(w, &body, &err));
    REFUSED(tobi_world_add_body(w, &body, &err), TOBI_INVALID, "body 'ball': body 0 has that name already");
    OK(tobi_world_add_probe(w, &probe, &err));
    REFUSED(tobi_world_add_probe(w, &probe, &err), TOBI_INVALID,
            "probe 'probe': probe 0 has that name already");
    tobi_inlet_def in = tobi_default_inlet_def();
    tobi_outlet_def out = tobi_default_outlet_def();
    in.speed = in.normal[0] = out.normal[0] = 1;
    in.width = in.height = out.width = out.height = in.centre[1] = in.centre[2] = 0.2;
    in.centre[0] = 0.4;
    out.centre[1] = out.centre[2] = 0.2;
    OK(tobi_world_add_inlet(w, &in, &err));
    OK(tobi_world_add_outlet(w, &out, &err));
    REFUSED(tobi_world_add_inlet(w, &in, &err), TOBI_INVALID, "inlet 'inlet': inlet 0 has that name already");
    REFUSED(tobi_world_add_outlet(w, &out, &err), TOBI_INVALID,
            "outlet 'outlet': outlet 0 has that name already");
    tobi_world_destroy(w);
}

/* A solid that is refused leaves no region, no name and no method of solids. */
static void solids_that_are_refused(void **state)
{
    (void)state;
    tobi_world *w = make_world("dfsph");
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    for (int a = 0; a < 3; a++) fill.box_max[a] = 0.4;
    solid.texture = "none.png";
    REFUSED(tobi_world_add_solid(w, &solid, &fill, 1, &err), TOBI_INVALID, "has a texture, but no mesh");
    solid.texture = NULL;
    solid.strength = 1e3;
    solid.fracture_energy = 1e-9;
    solid.clamped_to = "wall";
    REFUSED(tobi_world_add_solid(w, &solid, &fill, 1, &err), TOBI_INVALID, "solid 'solid': ");
    assert_int_equal(tobi_world_solid_count(w), 0);
    OK(tobi_world_use_solids(w, NULL, &err));
    REFUSED(tobi_world_add_solid(w, &solid, &fill, 1, &err), TOBI_INVALID, "solid 'solid': ");
    assert_int_equal(tobi_world_solid_count(w), 0);
    OK(tobi_world_start(w, &err));
    assert_int_equal(tobi_world_count(w, TOBI_FLUID), 64);
    tobi_world_destroy(w);
}

/* A call that fails takes back its notes, too. */
static void notes_of_calls_that_fail(void **state)
{
    (void)state;
    tobi_world *w = make_world("dfsph");
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def fill[2] = { tobi_default_fill_def(), tobi_default_fill_def() };
    FILE *f = fopen("inside_out.obj", "w");
    assert_non_null(f);
    fputs("v 0 0 0\nv 0.3 0 0\nv 0 0.3 0\nv 0 0 0.3\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n", f);
    fclose(f);
    fluid.name = "ink";
    fill[0].mesh = "inside_out.obj";
    fill[1].mesh = "none.obj";
    REFUSED(tobi_world_add_fluid(w, &fluid, fill, 2, &err), TOBI_NOT_FOUND, "none.obj");
    assert_null(tobi_world_note(w, 0));
    OK(tobi_world_add_fluid(w, &fluid, fill, 1, &err));
    assert_non_null(strstr(tobi_world_note(w, 0), "fluid 'ink': 1 of 1 shells turned"));
    assert_null(tobi_world_note(w, 1));
    tobi_world_destroy(w);
}

/* So does a start, which may be tried again. */
static void notes_of_starts_that_fail(void **state)
{
    (void)state;
    tobi_world_def def = tobi_default_world_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_outlet_def out = tobi_default_outlet_def();
    tobi_world *w;
    def.method = "wcsph";
    def.spacing = 0.1;
    def.time_step = 1;
    for (int a = 0; a < 3; a++) def.domain_max[a] = 1, fill.box_max[a] = 0.8;
    OK(tobi_world_create(&def, NULL, &w, &err));
    OK(tobi_world_add_fluid(w, &fluid, &fill, 1, &err));
    out.centre[0] = 0.82;
    out.centre[1] = out.centre[2] = 0.4;
    out.radius = 0.2;
    out.normal[0] = -1;
    OK(tobi_world_add_outlet(w, &out, &err));
    for (int k = 0; k < 2; k++) {
        REFUSED(tobi_world_start(w, &err), TOBI_INVALID, "faces inwards");
        assert_null(tobi_world_note(w, 0));
    }
    tobi_world_destroy(w);
}

static void times_that_are_none(void **state)
{
    (void)state;
    const double none[] = { NAN, INFINITY, -1 };
    tobi_world *w = make_world("dfsph");
    for (int k = 0; k < 3; k++)
        REFUSED(tobi_world_step(w, none[k], NULL, &err), TOBI_INVALID,
                "allowed are finite numbers from 0, no cap");
    for (int k = 0; k < 2; k++)
        REFUSED(tobi_world_advance(w, none[k], NULL, &err), TOBI_INVALID, "the time to advance to is ");
    assert_true(tobi_world_time(w) == 0);
    REFUSED(tobi_world_advance(w, -1, NULL, &err), TOBI_INVALID,
            "the time to advance to, -1 s, has passed: it is 0 s");
    OK(tobi_world_step(w, 0, NULL, &err));
    const double t = tobi_world_time(w);
    OK(tobi_world_advance(w, t*(1 - 1e-12), NULL, &err));
    REFUSED(tobi_world_advance(w, 0.5*t, NULL, &err), TOBI_INVALID, "not how long");
    assert_true(tobi_world_time(w) == t);
    tobi_world_destroy(w);
}

/* What cannot be is not taken over, not even in part. */
static void values_that_are_none(void **state)
{
    (void)state;
    double v[3*64] = { 0 };
    tobi_world *w = make_world("dfsph"), *solids = make_world("mlsmpm");
    const int64_t n = tobi_world_start(w, NULL) == TOBI_OK ? tobi_world_count(w, TOBI_FLUID) : 0;
    const uint64_t before = tobi_world_hash(w);
    assert_int_equal(n, 64);
    v[0] = 1;
    v[3*n - 1] = NAN;
    REFUSED(tobi_world_write(w, "velocity", v, n, &err), TOBI_INVALID,
            "row 63 of field 'velocity' holds nan; allowed is -1e+06 to 1e+06");
    v[3*n - 1] = 2e6;
    REFUSED(tobi_world_write(w, "velocity", v, n, &err), TOBI_INVALID,
            "row 63 of field 'velocity' holds 2e+06");
    v[n - 1] = INFINITY;
    REFUSED(tobi_world_write(w, "pressure", v, n, &err), TOBI_INVALID,
            "row 63 of field 'pressure' holds inf");
    assert_int_equal(tobi_world_hash(w), before);
    REFUSED(tobi_world_write(solids, "pressure", v, n, &err), TOBI_NOT_FOUND,
            "mlsmpm has no field 'pressure'");
    tobi_fill_def fill = tobi_default_fill_def();
    const tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_world_destroy(w);
    w = make_world("dfsph");
    fill.velocity[1] = NAN;
    REFUSED(tobi_world_add_fluid(w, &fluid, &fill, 1, &err), TOBI_INVALID,
            "fill.velocity is not a finite number");
    tobi_world_destroy(w);
    tobi_world_destroy(solids);
}

static void runs(void **state)
{
    (void)state;
    tobi_world *w = make_world("dfsph");
    tobi_output_def out = tobi_default_output_def();
    tobi_run *run = NULL;
    REFUSED(tobi_run_create(NULL, &out, "misuse", 1, NULL, &run, &err), TOBI_INVALID, NULL_WORLD);
    REFUSED(tobi_run_create(w, NULL, "misuse", 1, NULL, &run, &err), TOBI_INVALID,
            "tobi_run_create: the output is NULL");
    REFUSED(tobi_run_create(w, &out, NULL, 1, NULL, &run, &err), TOBI_INVALID, "the directory is NULL");
    REFUSED(tobi_run_create(w, &out, "misuse", 1, NULL, NULL, &err), TOBI_INVALID,
            "where the run goes is NULL");
    REFUSED(tobi_run_resume(w, &out, NULL, &run, &err), TOBI_INVALID, "the directory is NULL");
    REFUSED(tobi_run_resume(w, &out, "misuse", NULL, &err), TOBI_INVALID, "where the run goes is NULL");
    out.interval = NAN;
    REFUSED(tobi_run_create(w, &out, "misuse", 1, NULL, &run, &err), TOBI_INVALID,
            "output.interval is not a finite");
    assert_null(run);
    REFUSED(tobi_run_step(NULL, 1, NULL, &err), TOBI_INVALID, "run is NULL");
    REFUSED(tobi_run_output(NULL, &err), TOBI_INVALID, "run is NULL");
    REFUSED(tobi_run_output_end(NULL, &err), TOBI_INVALID, "run is NULL");
    REFUSED(tobi_run_checkpoint(NULL, &err), TOBI_INVALID, "run is NULL");
    REFUSED(tobi_run_finish(NULL, "complete", &err), TOBI_INVALID, "tobi_run_finish: run is NULL");
    assert_string_equal(tobi_run_note(NULL), "");
    assert_int_equal(tobi_run_done(NULL, 1), 1);
    tobi_run_free(NULL);
    out.interval = 1;
    OK(tobi_run_create(w, &out, "misuse", 1, NULL, &run, &err));
    REFUSED(tobi_run_step(run, NAN, NULL, &err), TOBI_INVALID, "the end of the run is nan s, not finite");
    REFUSED(tobi_run_step(run, INFINITY, NULL, &err), TOBI_INVALID,
            "the end of the run is inf s, not finite");
    assert_int_equal(tobi_run_done(run, NAN), 0);
    REFUSED(tobi_run_finish(run, NULL, &err), TOBI_INVALID, "tobi_run_finish: the outcome is NULL");
    tobi_run_free(run);
    tobi_world_destroy(w);
}

/* Calls that answer with a number or nothing answer 0 or NULL, and change nothing. */
static void no_object_and_no_text(void **state)
{
    (void)state;
    const double at[3] = { 0 };
    const tobi_overlay nowhere = { 0 };
    const uint8_t black[3] = { 0 };
    float color[4] = { 7 };
    double seconds = 1;
    int width = 1;
    tobi_world *w = make_world("dfsph");
    tobi_run_size size;
    tobi_moment moment = { 0 };
    REFUSED(tobi_run_estimate(w, NULL, 1, &size, &err), TOBI_INVALID, "the output is NULL");
    REFUSED(tobi_run_wait(NULL, &err), TOBI_INVALID, "run is NULL");
    REFUSED(tobi_track_add(&moment, NULL, at, &err), TOBI_INVALID, "the body is NULL");
    REFUSED(tobi_track_add(NULL, "a", at, &err), TOBI_INVALID, "the moment is NULL");
    REFUSED(tobi_track_add(&moment, "a", NULL, &err), TOBI_INVALID, "the point is NULL");
    tobi_motion *motion;
    OK(tobi_motion_translation(at, &motion, &err));
    REFUSED(tobi_motion_positions(motion, 0, 1, &at, NULL, &err), TOBI_INVALID,
            "a list of positions is NULL");
    tobi_motion_free(motion);
    tobi_run_go_on(NULL, 1);
    assert_true(tobi_run_pictures(NULL, &seconds) == 0 && seconds == 0);
    assert_true(!tobi_run_column((tobi_table)-1, 0) && !tobi_run_column(TOBI_TABLE_SCALAR_FLOWS + 1, 0));
    assert_true(!tobi_scene_suggest(NULL) && !tobi_suggest(NULL, NULL, 1) && !tobi_suggest("a", NULL, 1));
    assert_int_equal(tobi_solid_uses(0, NULL), 1);
    tobi_solid_list(0, NULL, 10);
    assert_true(!tobi_looks_hides(NULL, 0, at) && !tobi_looks_differ(NULL));
    assert_true(tobi_looks_radius(NULL, 0) == 0);
    tobi_looks_color(NULL, 0, 0, color);
    assert_true(color[0] == 0.5f && !tobi_drawing_body_around(NULL));
    tobi_picture_set_view(NULL, NULL);
    tobi_image_size(NULL, &width, NULL, NULL);
    tobi_image_color(NULL, NULL, NULL);
    assert_int_equal(width, 0);
    tobi_overlay_box(NULL, 0, 0, 9, 9, black, 1);
    tobi_overlay_line(&nowhere, 0, 0, 9, 9, 1, NULL);
    assert_true(tobi_overlay_text(NULL, 0, 0, 9, NULL, black) == 0);
    assert_true(tobi_overlay_text_width(NULL, 9, NULL) == 0);
    assert_true(tobi_letters_have(NULL, NULL) == 0 && tobi_letters_font(NULL) == NULL);
    tobi_letters_close(NULL);
    tobi_world_destroy(w);
}

/* A world keeps 63 bytes of a name; one that it would cut is not taken. Some names must be there. */
static void names_that_are_none(void **state)
{
    (void)state;
    char name[65];
    tobi_world *w = make_world("dfsph");
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_body_def body = tobi_default_body_def();
    tobi_probe_def probe = tobi_default_probe_def();
    tobi_line_def line = tobi_default_line_def();
    tobi_joint_def joint = tobi_default_joint_def();
    tobi_inlet_def inlet = tobi_default_inlet_def();
    tobi_outlet_def outlet = tobi_default_outlet_def();
    tobi_porous_def zone = tobi_default_porous_def();
    memset(name, 'a', 64);
    name[64] = '\0';
    fluid.name = solid.name = body.name = probe.name = line.name = joint.name = name;
    inlet.name = outlet.name = zone.name = name;
    const char *const long_name = ".name has 64 bytes, allowed are up to 63";
    REFUSED(tobi_world_add_fluid(w, &fluid, NULL, 0, &err), TOBI_INVALID, long_name);
    REFUSED(tobi_world_add_solid(w, &solid, NULL, 0, &err), TOBI_INVALID, long_name);
    REFUSED(tobi_world_add_body(w, &body, &err), TOBI_INVALID, long_name);
    REFUSED(tobi_world_add_probe(w, &probe, &err), TOBI_INVALID, long_name);
    REFUSED(tobi_world_add_line(w, &line, &err), TOBI_INVALID, long_name);
    REFUSED(tobi_world_add_joint(w, &joint, &err), TOBI_INVALID, long_name);
    REFUSED(tobi_world_add_inlet(w, &inlet, &err), TOBI_INVALID, long_name);
    REFUSED(tobi_world_add_outlet(w, &outlet, &err), TOBI_INVALID, long_name);
    REFUSED(tobi_world_add_porous(w, &zone, &err), TOBI_INVALID, long_name);
    static const char *const odd[] = { "a,b", "a\nb", "a\"b", "a\177b" };       /* no cells of a table */
    for (size_t k = 0; k < sizeof odd/sizeof *odd; k++) {
        fluid.name = body.name = probe.name = odd[k];
        REFUSED(tobi_world_add_fluid(w, &fluid, NULL, 0, &err), TOBI_INVALID,
                "fluid.name has a comma, a quote or a control character at byte 1");
        REFUSED(tobi_world_add_body(w, &body, &err), TOBI_INVALID, "body.name has a comma");
        REFUSED(tobi_world_add_probe(w, &probe, &err), TOBI_INVALID, "probe.name has a comma");
    }
    name[63] = '\0';
    probe.name = name;
    OK(tobi_world_add_probe(w, &probe, &err));
    assert_string_equal(tobi_world_probe_name(w, 0, NULL), name);
    body.name = joint.to_body = line.to_body = "box";
    joint.name = line.name = "held";
    line.stiffness = 1;
    for (int a = 0; a < 3; a++) body.box_max[a] = 0.1;
    OK(tobi_world_add_body(w, &body, &err));
    REFUSED(tobi_world_add_joint(w, &joint, &err), TOBI_INVALID, "the body of the joint is NULL");
    REFUSED(tobi_world_add_line(w, &line, &err), TOBI_INVALID, "the body of the line is NULL");
    tobi_world_destroy(w);
}

static void scenes(void **state)
{
    (void)state;
    tobi_scene *scene;
    tobi_world *w = NULL;
    char *table;
    REFUSED(tobi_scene_load(NULL, NULL, &scene, NULL, &err), TOBI_INVALID, "the path is NULL");
    REFUSED(tobi_scene_load("x.json", NULL, NULL, NULL, &err), TOBI_INVALID,
            "where the scene goes is NULL");
    REFUSED(tobi_scene_parse(NULL, "", 0, NULL, &scene, NULL, &err), TOBI_INVALID, "the name is NULL");
    REFUSED(tobi_scene_parse("x.json", NULL, 3, NULL, &scene, NULL, &err), TOBI_INVALID, "the text is NULL");
    REFUSED(tobi_scene_parse("x.json", "", 0, NULL, NULL, NULL, &err), TOBI_INVALID,
            "where the scene goes is NULL");
    REFUSED(tobi_scene_parse("x.json", "", 16777217, NULL, &scene, NULL, &err), TOBI_INVALID,
            "x.json: 16777217 bytes of scene, allowed are 16777216");
    REFUSED(tobi_scene_build(NULL, &w, &err), TOBI_INVALID, "scene is NULL");
    REFUSED(tobi_scene_build(NULL, NULL, &err), TOBI_INVALID, "where the world goes is NULL");
    REFUSED(tobi_scene_import(NULL, "x", 0, &table, NULL, &err), TOBI_INVALID, "a path is NULL");
    REFUSED(tobi_scene_import("x", "y", 0, NULL, NULL, &err), TOBI_INVALID, "where the table goes is NULL");
    assert_true(!tobi_scene_name(NULL) && !tobi_scene_world_def(NULL) && !tobi_scene_output_def(NULL));
    assert_true(!tobi_scene_reference(NULL, 0) && !tobi_scene_import_table(NULL) &&
                !tobi_scene_resolved(NULL));
    assert_true(tobi_report_count(NULL) == 0 && !tobi_report_line(NULL, 0) &&
                !tobi_scene_describe("nonesuch"));
    tobi_report_free(NULL);
    tobi_scene_free(NULL);
}

/* A text of so many bytes, with nothing behind them, for a file that is not there. */
static void scenes_in_memory(void **state)
{
    (void)state;
    static const char text[] = "{\"domain\": {\"min\": [0, 0, 0], \"max\": [1, 1, 1]}, \"spacing\": 0.1, "
        "\"end_time\": 1, \"fluids\": [{\"name\": \"water\", \"density\": 1000, \"viscosity\": 0.001, "
        "\"fill\": [{\"box\": {\"min\": [0, 0, 0], \"max\": [1, 1, 0.5]}}]}]}";
    tobi_scene *scene;
    tobi_report *report;
    tobi_world *world;
    tobi_error err = { 0 };
    for (size_t size = sizeof text - 4; size < sizeof text; size++) {
        char *exact = malloc(size);
        assert_non_null(exact);
        memcpy(exact, text, size);
        const tobi_status status =
            tobi_scene_parse("nowhere/tank.json", exact, size, NULL, &scene, &report, &err);
        free(exact);
        if (size < sizeof text - 1) {
            assert_int_equal(status, TOBI_INVALID);
            assert_null(scene);
            assert_int_equal(tobi_report_count(report), 1);
            assert_non_null(strstr(tobi_report_line(report, 0), "nowhere/tank.json:1:"));
            tobi_report_free(report);
            continue;
        }
        assert_int_equal(status, TOBI_OK);
        assert_string_equal(tobi_scene_name(scene), "tank");
        OK(tobi_scene_build(scene, &world, &err));
        OK(tobi_world_step(world, 0, NULL, &err));
        tobi_world_destroy(world);
        tobi_scene_free(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_world),
        cmocka_unit_test(no_world_and_no_text),
        cmocka_unit_test(nothing_where_something_must_stand),
        cmocka_unit_test(names_that_are_taken),
        cmocka_unit_test(solids_that_are_refused),
        cmocka_unit_test(notes_of_calls_that_fail),
        cmocka_unit_test(notes_of_starts_that_fail),
        cmocka_unit_test(times_that_are_none),
        cmocka_unit_test(values_that_are_none),
        cmocka_unit_test(runs),
        cmocka_unit_test(no_object_and_no_text),
        cmocka_unit_test(names_that_are_none),
        cmocka_unit_test(scenes),
        cmocka_unit_test(scenes_in_memory),
    };
    return cmocka_run_group_tests(tests, enter_own_folder, leave_own_folder);
}
