/* How meshes float, against the formulas of naval architecture. */
#include "test_geom_solids.h"
#include "geom/flotation.h"
#include "tobiuo/matter.h"
#include "tobiuo/tobiuo.h"

/* A barge, L by B: draught T of the volume L B T, KB = T/2, waterplane L B^3/12. Upside down, too. */
static void a_barge(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        tobi_mesh mesh = make_box((double[3]){ 1000, 5, -1 }, (double[3]){ 1004, 7, 1 });
        tobi_flotation f;
        OK(tobi_flotation_find(&mesh, 3, 2, k ? -1 : 1, 4, &f, &err));
        NEAR(f.draught, 0.5, 1e-12);
        NEAR(f.buoyancy, 0.25, 1e-12);
        NEAR(f.lowest, k ? 1.0 : -1.0, 1e-12);
        NEAR(f.inertia[0], 4*2*2*2/12.0, 1e-10);
        NEAR(f.inertia[1], 2*4*4*4/12.0, 1e-10);
        assert_true(f.inertia[2] == 0);
        tobi_mesh_free(&mesh);
    }
}

/* In 2-D its section: area B T, waterline B^3/12. */
static void a_section(void **state)
{
    (void)state;
    tobi_mesh mesh = make_box((double[3]){ 3, 5, -1 }, (double[3]){ 5, 6, 1 });
    tobi_flotation f;
    OK(tobi_flotation_find(&mesh, 2, 1, 1, 0.5, &f, &err));
    NEAR(f.draught, 0.25, 1e-12);
    NEAR(f.buoyancy, 0.125, 1e-12);
    NEAR(f.inertia[2], 8/12.0, 1e-12);
    tobi_error err = { 0 };
    assert_int_equal(tobi_flotation_find(&mesh, 2, 1, 1, 5, &f, &err), TOBI_INVALID);
    assert_string_equal(err.text, "the mesh has less than 5 m3 to lie below a level");
    tobi_mesh_free(&mesh);
}

/* A wedge, its edge down, half as heavy as water: a level at 1/sqrt(2) of its height. */
static void a_wedge(void **state)
{
    (void)state;
    static const double v[6][3] = { { 0, 0, 0 }, { 2, 0, 0 }, { 0, 1, 1 }, { 2, 1, 1 }, { 0, -1, 1 },
                                    { 2, -1, 1 } };
    static const int32_t t[8][3] = { { 0, 1, 3 }, { 0, 3, 2 }, { 0, 4, 5 }, { 0, 5, 1 }, { 2, 3, 5 },
                                     { 2, 5, 4 }, { 0, 2, 4 }, { 1, 5, 3 } };
    const double h = sqrt(0.5);
    tobi_mesh mesh;
    tobi_flotation f;
    OK(tobi_mesh_build("wedge", 6, v, 8, t, &mesh, &err));
    OK(tobi_mesh_orient(&mesh, "wedge", &err));
    OK(tobi_flotation_find(&mesh, 3, 2, 1, 1, &f, &err));
    NEAR(f.draught, h, 1e-12);
    NEAR(f.buoyancy, 2*h/3, 1e-12);
    NEAR(f.inertia[0], 2*8*h*h*h/12, 1e-12);
    tobi_mesh_free(&mesh);
}

/* A body of a world: GM = I/V + KB - KG; none where there is no liquid, or a joint holds the body. */
static void a_hull_in_a_world(void **state)
{
    (void)state;
    for (int wet = 0; wet < 2; wet++) {
        tobi_world_def d = tobi_default_world_def();
        tobi_body_def b = tobi_default_body_def();
        tobi_fluid_def fluid = tobi_default_fluid_def();
        tobi_fill_def fill = tobi_default_fill_def();
        tobi_joint_def joint = tobi_default_joint_def();
        tobi_body_matter m;
        tobi_world *w;
        for (int a = 0; a < 3; a++) d.domain_max[a] = 4;
        d.spacing = 0.1;
        if (!wet) d.method = "mlsmpm";
        OK(tobi_world_create(&d, NULL, &w, &err));
        for (int a = 0; a < 3; a++) fill.box_max[a] = a < 2 ? 4 : 1;
        if (wet) OK(tobi_world_add_fluid(w, &fluid, &fill, 1, &err));
        memcpy(b.box_min, (double[3]){ 1, 1, 1 }, sizeof b.box_min);
        memcpy(b.box_max, (double[3]){ 3, 2, 1.8 }, sizeof b.box_max);
        memcpy(b.centre_of_mass, (double[3]){ 2, 1.5, 1.3 }, sizeof b.centre_of_mass);
        b.dynamics = TOBI_FREE;
        b.density = 500;
        OK(tobi_world_add_body(w, &b, &err));
        OK(tobi_world_body_matter(w, 0, &m));
        NEAR(m.mass, 800, 1e-12);
        NEAR(m.centre[2], 1.3, 1e-12);
        if (wet) NEAR(m.draught, 0.4, 1e-12);
        if (wet) NEAR(m.metacentre[0], 1/(12*0.4) + 0.2 - 0.3, 1e-10);
        if (wet) NEAR(m.metacentre[1], 4/(12*0.4) + 0.2 - 0.3, 1e-10);
        assert_true(wet || (m.draught == 0 && m.liquid == 0));
        assert_int_equal(tobi_world_body_matter(w, 1, &m), TOBI_NOT_FOUND);
        assert_int_equal(tobi_world_body_matter(w, 0, NULL), TOBI_INVALID);
        for (int held = 0; held < 2; held++) {
            tobi_solid_def solid = tobi_default_solid_def();
            tobi_fill_def part = tobi_default_fill_def();
            solid.name = held ? "keel" : "other";
            solid.clamped_to = held ? "plate,body" : "body_2";
            memcpy(part.box_min, (double[3]){ 1.5, 1, 0.5 }, sizeof part.box_min);
            memcpy(part.box_max, (double[3]){ 2.5, 2, 1.2 }, sizeof part.box_max);
            OK(tobi_world_add_solid(w, &solid, &part, 1, &err));
            OK(tobi_world_body_matter(w, 0, &m));
            assert_int_equal(m.solids, held);
            assert_true((m.draught > 0) == (wet && !held));
        }
        joint.name = "pin";
        joint.body = "body";
        joint.axis[1] = 1;
        OK(tobi_world_add_joint(w, &joint, &err));
        OK(tobi_world_body_matter(w, 0, &m));
        assert_true(m.draught == 0 && m.metacentre[0] == 0 && m.liquid == (wet ? 1000 : 0));
        tobi_world_destroy(w);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(a_barge), cmocka_unit_test(a_section),
                                        cmocka_unit_test(a_wedge), cmocka_unit_test(a_hull_in_a_world) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
