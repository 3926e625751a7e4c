/* Porous zones by an outline: what lies in a polygon and in two of them, by formulas; a rectangle against the
   box, bit for bit; layers with common slopes; what is refused; notes, screens, pictures. */
#include "calls.h"
#include "geom/polygon.h"
#include "tobiuo/drawing.h"
#include "tobiuo/scene.h"
#include "tobiuo/tobiuo.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define POLYGON(...) \
    (tobi_polygon){ (const double[][2]){ __VA_ARGS__ }, \
                    sizeof (double[][2]){ __VA_ARGS__ }/sizeof (double[2]) }

static void polygons_hold_what_is_inside(void **state)
{
    const tobi_polygon mound = POLYGON({ 0, 0 }, { 1, 1 }, { 2, 1 }, { 3, 0 });
    const tobi_polygon angle = POLYGON({ 0, 0 }, { 0, 2 }, { 1, 2 }, { 1, 1 }, { 2, 1 }, { 2, 0 });
    static const struct { double at[2]; int mound, angle; } points[] = {
        { { 0.5, 0.49 }, 1, 1 }, { { 0.5, 0.51 }, 0, 1 }, { { 2.6, 0.39 }, 1, 0 }, { { 2.6, 0.41 }, 0, 0 },
        { { 1.5, 1.5 }, 0, 0 },  { { 1.5, 0.99 }, 1, 1 }, { { 0.5, 1.5 }, 0, 1 },  { { 1.5, -0.1 }, 0, 0 },
        { { 1.5, 0 }, 1, 1 },    { { 1.5, 1 }, 0, 0 },    { { 0, 1 }, 0, 1 },      { { 2, 0.5 }, 1, 0 },
        { { 0.5, 0.5 }, 1, 1 },  { { 2.5, 0.5 }, 0, 0 },
    };
    (void)state;
    for (size_t k = 0; k < sizeof points/sizeof *points; k++)
        if (tobi_polygon_holds(mound, points[k].at) != points[k].mound ||
            tobi_polygon_holds(angle, points[k].at) != points[k].angle)
            fail_msg("(%g, %g)", points[k].at[0], points[k].at[1]);
}

/* A square in five parts with common corners: points of its edges, of its corners and any others. */
static void each_point_is_in_one_of_all(void **state)
{
    const double x = 1.0/3, y = 0.7;
    const tobi_polygon parts[] = {
        POLYGON({ 0, 0 }, { x, y }, { 0, 1 }), POLYGON({ 1, 0 }, { x, y }, { 0, 0 }),
        POLYGON({ 1, 0 }, { 1, 1 }, { 0.9, 0.95 }, { x, y }),
        POLYGON({ x, y }, { 0.9, 0.95 }, { 0.55, 1 }),
        POLYGON({ 1, 1 }, { 0.55, 1 }, { 0.9, 0.95 }), POLYGON({ 0, 1 }, { 0.55, 1 }, { x, y }),
    };
    enum { PARTS = sizeof parts/sizeof *parts };
    (void)state;
    srand(1);
    for (int k = 0; k < 200000; k++) {
        const tobi_polygon side = parts[k%PARTS];
        const double *a = side.at[k/PARTS%side.count], *b = side.at[(k/PARTS + 1)%side.count];
        const double t = k%2 ? rand()/(RAND_MAX + 1.0) : 0.0;
        double p[2];
        for (int n = 0; n < 2; n++) p[n] = k%3 ? a[n] + t*(b[n] - a[n]) : rand()/(RAND_MAX + 1.0);
        const int expected = p[0] >= 0 && p[0] < 1 && p[1] >= 0 && p[1] < 1;
        int count = 0;
        for (int n = 0; n < PARTS; n++) count += tobi_polygon_holds(parts[n], p);
        if (count != expected)
            fail_msg("(%.17g, %.17g) lies in %d parts, not in %d", p[0], p[1], count, expected);
    }
}

static void common_areas_are_exact(void **state)
{
    const tobi_polygon square = POLYGON({ 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 });
    const tobi_polygon lying = POLYGON({ 0.5, 1.2 }, { 0.5, 0.5 }, { 1.5, 0.5 }, { 1.5, 1.2 });
    const tobi_polygon beside = POLYGON({ 1, 0 }, { 2, 0 }, { 2, 1 }, { 1, 1 });
    const tobi_polygon tip = POLYGON({ 0, 0.5 }, { 0.5, 0 }, { 1, 0.5 }, { 0.5, 1 });
    const tobi_polygon core = POLYGON({ 3.83, 0 }, { 4.55, 0.48 }, { 4.85, 0.48 }, { 5.57, 0 });
    const tobi_polygon armour = POLYGON({ 3.65, 0 }, { 4.55, 0.6 }, { 4.85, 0.6 }, { 5.75, 0 }, { 5.57, 0 },
                                        { 4.85, 0.48 }, { 4.55, 0.48 }, { 3.83, 0 });
    const tobi_polygon whole = POLYGON({ 3.65, 0 }, { 4.55, 0.6 }, { 4.85, 0.6 }, { 5.75, 0 });
    (void)state;
    assert_true(fabs(tobi_polygon_common(square, lying) - 0.25) < 1e-14);
    assert_true(fabs(tobi_polygon_common(lying, square) - 0.25) < 1e-14);
    assert_true(fabs(tobi_polygon_common(square, square) - 1) < 1e-14);
    assert_true(tobi_polygon_common(square, beside) < 1e-14);
    assert_true(fabs(tobi_polygon_common(square, tip) - 0.5) < 1e-14);
    assert_true(fabs(tobi_polygon_common(lying, tip) - 0.125) < 1e-14);
    assert_true(tobi_polygon_common(core, armour) < 1e-14);
    assert_true(fabs(tobi_polygon_common(core, whole) - 0.4896) < 1e-13);
    assert_true(fabs(tobi_polygon_common(armour, whole) - 0.2304) < 1e-13);
    assert_true(fabs(tobi_polygon_measure(armour).area - 0.2304) < 1e-14);
}

/* Full of water that moves; 0.2 m high, periodic along x. The lower corner is no round number. */
static tobi_world *make_channel(int dimension, double speed)
{
    tobi_world_def d = tobi_default_world_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_world *w = NULL;
    d.method = "isph";
    d.dimension = dimension;
    d.spacing = 0.025;
    d.threads = 1;
    d.end_time = 10;
    d.wall_min[0] = d.wall_max[0] = TOBI_WALL_PERIODIC;
    for (int a = 0; a < 3; a++) {
        d.domain_min[a] = fill.box_min[a] = a < dimension ? 0.1 : 0;
        d.domain_max[a] = fill.box_max[a] = a == 0 ? 1.1 : a < dimension ? 0.3 : 0;
        d.gravity[a] = 0;
    }
    fill.velocity[0] = speed;
    OK(tobi_world_create(&d, NULL, &w, &err));
    OK(tobi_world_add_fluid(w, &fluid, &fill, 1, &err));
    return w;
}

static tobi_porous_def make_zone(const char *name, const char *points)
{
    tobi_porous_def z = tobi_default_porous_def();
    z.name = name;
    z.outline.points = points;
    z.outline.from = 0;
    z.outline.to = 1;
    z.stone_size = 0.02;
    z.porosity = 0.4;
    return z;
}

static uint64_t hash_of(int dimension, const tobi_porous_def *z, double *force)
{
    tobi_world *w = make_channel(dimension, 1);
    tobi_porous_info info;
    OK(tobi_world_add_porous(w, z, &err));
    for (int k = 0; k < 5; k++) OK(tobi_world_step(w, 0, NULL, &err));
    const uint64_t hash = tobi_world_hash(w);
    tobi_world_porous(w, 0, &info);
    *force = info.force[0];
    tobi_world_destroy(w);
    return hash;
}

/* Its faces lie on the places of particles, so that edges count. */
static void a_rectangle_is_the_box(void **state)
{
    static const struct { int dimension, axis; const char *points; double from, to; } cases[] = {
        { 2, 0, "0.4125,0.1125 0.4125,0.2125 0.6125,0.2125 0.6125,0.1125", 0, 0 },
        { 3, 0, "0.4125,0.1125 0.6125,0.1125 0.6125,0.2125 0.4125,0.2125", 0.1375, 0.2375 },
        { 3, 1, "0.4125,0.1375 0.6125,0.1375 0.6125,0.2375 0.5,0.2375 0.4125,0.2375", 0.1125, 0.2125 },
        { 3, 2, "0.1375,0.1125 0.2375,0.1125 0.2375,0.2125 0.1375,0.2125", 0.4125, 0.6125 },
    };
    (void)state;
    for (size_t k = 0; k < sizeof cases/sizeof *cases; k++) {
        const int dimension = cases[k].dimension, up = dimension - 1;
        tobi_porous_def z = make_zone("zone", cases[k].points), box = make_zone("zone", NULL);
        double force[2];
        z.outline.axis = cases[k].axis;
        z.outline.from = cases[k].from;
        z.outline.to = cases[k].to;
        box.box_min[0] = 0.4125, box.box_max[0] = 0.6125;
        box.box_min[1] = 0.1375, box.box_max[1] = 0.2375;
        box.box_min[up] = 0.1125, box.box_max[up] = 0.2125;
        const uint64_t drawn = hash_of(dimension, &z, &force[0]), plain = hash_of(dimension, &box, &force[1]);
        if (drawn != plain || force[0] != force[1] || !(force[0] > 1e-3))
            fail_msg("case %zu: %g and %g N", k, force[0], force[1]);
    }
}

/* A core and an armour layer: each particle of the mound belongs to one of both, and counts once. */
static void layers_share_their_slopes(void **state)
{
    const char *const core = "0.4,0.1 0.5,0.2 0.7,0.2 0.8,0.1";
    const char *const armour = "0.3,0.1 0.475,0.275 0.725,0.275 0.9,0.1 0.8,0.1 0.7,0.2 0.5,0.2 0.4,0.1";
    tobi_world *w = make_channel(2, 1), *one = make_channel(2, 1);
    tobi_porous_def z = make_zone("core", core);
    tobi_porous_info info[3];
    (void)state;
    OK(tobi_world_add_porous(w, &z, &err));
    z = make_zone("armour", armour);
    OK(tobi_world_add_porous(w, &z, &err));
    z = make_zone("whole", "0.3,0.1 0.475,0.275 0.725,0.275 0.9,0.1");
    OK(tobi_world_add_porous(one, &z, &err));
    OK(tobi_world_step(w, 0, NULL, &err));
    OK(tobi_world_step(one, 0, NULL, &err));
    assert_true(tobi_world_hash(w) == tobi_world_hash(one));
    for (int k = 0; k < 2; k++) tobi_world_porous(w, k, &info[k]);
    tobi_world_porous(one, 0, &info[2]);
    assert_true(info[0].volume > 0 && info[1].volume > 0);
    assert_true(fabs(info[0].volume + info[1].volume - info[2].volume) < 1e-12);
    assert_true(fabs(info[0].extent - 0.03) < 1e-12);
    assert_true(fabs(info[0].extent + info[1].extent - info[2].extent) < 1e-12);
    tobi_world_destroy(w);
    tobi_world_destroy(one);
}

static void refuse(tobi_world *w, const char *points, tobi_status status, const char *why)
{
    const tobi_porous_def z = make_zone("new", points);
    tobi_error error = { 0 };
    REFUSED(tobi_world_add_porous(w, &z, &err), status, why);
    assert_int_equal(tobi_world_add_porous(w, &z, &error), status);
    assert_string_equal(error.key, "outline");
}

static void zones_do_not_overlap(void **state)
{
    tobi_world *w = make_channel(2, 1), *deep = make_channel(3, 1);
    tobi_porous_def z = make_zone("mound", "0.4,0.1 0.5,0.2 0.7,0.2 0.8,0.1"), box = make_zone("block", NULL);
    (void)state;
    OK(tobi_world_add_porous(w, &z, &err));
    refuse(w, "0.5,0.12 0.6,0.12 0.6,0.15", TOBI_INVALID,
           "the section of porous zone 'new' overlaps that of 'mound' by 0.0015 m2: allowed are");
    refuse(w, "0.3,0.1 0.5,0.3 0.7,0.3 0.9,0.1", TOBI_INVALID, "by 0.03 m2");
    refuse(w, "0.75,0.1 0.75,0.2 0.95,0.2 0.95,0.1", TOBI_INVALID, "by 0.00125 m2");
    box.box_min[0] = 0.75, box.box_max[0] = 0.9;
    box.box_min[1] = 0, box.box_max[1] = 0.3;
    REFUSED(tobi_world_add_porous(w, &box, &err), TOBI_INVALID, "'block' overlaps that of 'mound' by 0.001");
    box.box_min[0] = 0.71, box.box_min[1] = 0.19;
    OK(tobi_world_add_porous(w, &box, &err));
    z = make_zone("rounded", "0.4001,0.1 0.5,0.2001 0.3,0.2 0.3,0.1");
    OK(tobi_world_add_porous(w, &z, &err));
    tobi_world_destroy(w);
    z = make_zone("mound", "0.4,0.1 0.5,0.2 0.7,0.2 0.8,0.1");
    z.outline.to = 0.2;
    OK(tobi_world_add_porous(deep, &z, &err));
    z.name = "behind";
    z.outline.from = 0.2, z.outline.to = 0.3;
    OK(tobi_world_add_porous(deep, &z, &err));
    tobi_world_destroy(deep);
}

/* m3, of a square tube along z with the triangle below, along y. */
static double tube_with(double x, double from, double to)
{
    const double square[4][2] = { { x, 0.2 }, { x + 0.4, 0.2 }, { x + 0.4, 0.6 }, { x, 0.6 } };
    const double roof[3][2] = { { 0, 0 }, { 1, 0 }, { 0, 1 } };      /* x, z */
    const tobi_crossed tube = { { square, 4 }, 0, 0, 0.5 };          /* its y, where the roof is */
    const tobi_crossed prism = { { roof, 3 }, 0, from, to };         /* its z, where the tube is */
    const double one = tobi_polygon_crossed(&tube, &prism), other = tobi_polygon_crossed(&prism, &tube);
    assert_true(fabs(one - other) < 1e-14);
    return one;
}

/* Of y from 0.2 to 0.5 all counts; over x the roof is 1 - x high. */
static void prisms_that_cross_have_a_common_part(void **state)
{
    (void)state;
    assert_true(fabs(tube_with(0.1, 0, 2) - 0.3*0.4*(1 - 0.3)) < 1e-14);
    assert_true(fabs(tube_with(0.1, 0.2, 0.3) - 0.3*0.4*0.1) < 1e-14);
    assert_true(fabs(tube_with(0.8, 0, 2) - 0.3*0.5*0.2*0.2) < 1e-14);
    assert_true(fabs(tube_with(0.8, 0.1, 0.15) - 0.3*(0.05*0.05 + 0.5*0.05*0.05)) < 1e-14);
    assert_true(tube_with(0.8, 0.2, 2) < 1e-14);
    assert_true(tube_with(1, 0, 2) < 1e-14);
}

/* By their shapes, not by the boxes around them. */
static void zones_along_different_axes(void **state)
{
    tobi_world *w = make_channel(3, 1);
    tobi_porous_def z = make_zone("mound", "0.4,0.1 0.5,0.2 0.7,0.2 0.8,0.1");
    (void)state;
    z.outline.to = 0.2;
    OK(tobi_world_add_porous(w, &z, &err));
    z = make_zone("across", "0.4,0.12 0.46,0.18 0.4,0.18");
    z.outline.axis = 1;
    z.outline.from = 0.17, z.outline.to = 0.3;
    OK(tobi_world_add_porous(w, &z, &err));
    z.name = "lower";
    z.outline.from = 0.11, z.outline.to = 0.15;
    REFUSED(tobi_world_add_porous(w, &z, &err), TOBI_INVALID, "porous zone 'lower' overlaps 'mound' by ");
    z = make_zone("pile", NULL);
    z.cylinder_start[0] = z.cylinder_end[0] = 0.4, z.cylinder_start[1] = z.cylinder_end[1] = 0.15;
    z.cylinder_radius = 0.04, z.cylinder_start[2] = 0.15, z.cylinder_end[2] = 0.165;
    OK(tobi_world_add_porous(w, &z, &err));
    tobi_world_destroy(w);
}

static void wrong_outlines_are_refused(void **state)
{
    tobi_world *w = make_channel(2, 1), *deep = make_channel(3, 1);
    tobi_porous_def z = make_zone("new", "0.3,0.1 0.5,0.1 0.4,0.2");
    (void)state;
    refuse(w, "0.3,0.1 0.5,0.2", TOBI_INVALID, "porous zone 'new': its outline has 2 points; at least 3");
    refuse(w, "0.3,0.1 0.5,0.2 0.5,0.1 0.3,0.2", TOBI_INVALID, "'new': its outline crosses itself");
    refuse(w, "0.3,0.1 0.4,0.1 0.5,0.1", TOBI_INVALID, "has no area");
    refuse(w, "0.3,0.1 and so on", TOBI_INVALID, "is no point");
    refuse(w, "1.2,0.1 1.5,0.1 1.4,0.2", TOBI_INVALID, "lies from 1.2 to 1.5 m in x, outside of the domain");
    z.box_max[0] = 1;
    REFUSED(tobi_world_add_porous(w, &z, &err), TOBI_INVALID, "'new' has 2 shapes; it may have one");
    z = make_zone("new", NULL);
    z.outline.file = "missing.csv";
    REFUSED(tobi_world_add_porous(w, &z, &err), TOBI_NOT_FOUND, "missing.csv");
    z.outline.points = "0.3,0.1 0.5,0.1 0.4,0.2";
    REFUSED(tobi_world_add_porous(w, &z, &err), TOBI_INVALID, "has points and a file");
    z.outline.file = NULL;
    z.porosity = 0;
    REFUSED(tobi_world_add_porous(w, &z, &err), TOBI_INVALID, "stones have a size and a porosity");
    z = make_zone("new", "0.3,0.1 0.5,0.1 0.4,0.2");
    z.outline.to = 0;
    REFUSED(tobi_world_add_porous(deep, &z, &err), TOBI_INVALID, "to must be greater than from");
    tobi_world_destroy(w);
    tobi_world_destroy(deep);
}

/* A bed of plants by its profile; a layer that is thin on its slope; one above the water. */
static void notes_know_outlines(void **state)
{
    tobi_world *w = make_channel(2, 1);
    tobi_porous_def z = make_zone("thin", "0.3,0.1 0.4,0.2 0.45,0.2 0.35,0.1");
    char all[4000] = "";
    const char *note;
    (void)state;
    OK(tobi_world_add_porous(w, &z, &err));
    z = make_zone("bed", "0.5,0.2 0.7,0.25 0.9,0.2");
    z.outline.base = 0.1;
    OK(tobi_world_add_porous(w, &z, &err));
    z = make_zone("dry", "0.5,0.2999 0.9,0.2999 0.9,0.5");
    OK(tobi_world_add_porous(w, &z, &err));
    OK(tobi_world_start(w, &err));
    for (int k = 0; (note = tobi_world_note(w, k)); k++)
        snprintf(all + strlen(all), sizeof all - strlen(all), "%s", note);
    assert_non_null(strstr(all, "porous zone 'thin': is 0.0312"));
    assert_null(strstr(all, "'bed': is"));
    assert_null(strstr(all, "'bed': has no liquid"));
    assert_non_null(strstr(all, "porous zone 'dry': has no liquid in it at the start"));
    tobi_world_destroy(w);
}

/* K/(2 L), L across the sheet; in 3-D a sheet may be thinner along its extrusion. */
static void screens_lie_along_their_outline(void **state)
{
    tobi_world *w = make_channel(2, 1), *deep = make_channel(3, 1);
    tobi_porous_def z = make_zone("net", "0.3,0.2 0.36,0.12 0.4,0.15 0.34,0.23");      /* 0.1 m by 0.05 m */
    tobi_porous_info info;
    (void)state;
    z.stone_size = z.porosity = 0;
    z.screen_loss = 2;
    OK(tobi_world_add_porous(w, &z, &err));
    tobi_world_porous(w, 0, &info);
    assert_true(fabs(info.quadratic - 20) < 1e-9 && info.along);
    assert_true(fabs(fabs(info.direction[0]*0.8 + info.direction[1]*0.6) - 1) < 1e-12);
    z.outline.from = 0.1, z.outline.to = 0.3;
    OK(tobi_world_add_porous(deep, &z, &err));
    tobi_world_porous(deep, 0, &info);
    assert_true(fabs(info.quadratic - 20) < 1e-9 && fabs(info.extent - 0.001) < 1e-12);
    assert_true(fabs(fabs(info.direction[0]*0.8 + info.direction[2]*0.6) - 1) < 1e-12);
    z = make_zone("sheet", "0.6,0.1 0.8,0.1 0.8,0.3 0.6,0.3");
    z.stone_size = z.porosity = 0;
    z.screen_loss = 2;
    z.outline.from = 0.1, z.outline.to = 0.14;
    OK(tobi_world_add_porous(deep, &z, &err));
    tobi_world_porous(deep, 1, &info);
    assert_true(fabs(info.quadratic - 25) < 1e-9 && info.direction[1] == 1);
    z = make_zone("oblique", "0.85,0.1 0.95,0.1 0.95,0.3 0.85,0.3");
    z.stone_size = z.porosity = 0;
    z.screen_loss = 2;
    z.direction[0] = 3, z.direction[2] = 4;
    OK(tobi_world_add_porous(deep, &z, &err));
    tobi_world_porous(deep, 2, &info);      /* 0.02 m2 over the 0.2 0.6 + 0.1 0.8 m across the way */
    assert_true(fabs(info.quadratic - 10) < 1e-9);
    tobi_world_destroy(w);
    tobi_world_destroy(deep);
}

/* Within the domain: the toe outside of it is not drawn. */
static void pictures_have_the_edges(void **state)
{
    tobi_world *w = make_channel(2, 1), *deep = make_channel(3, 1);
    tobi_porous_def z = make_zone("mound", "0,0 0.3,0.3 0.5,0.3 0.8,0");
    tobi_looks looks;
    (void)state;
    OK(tobi_world_add_porous(w, &z, &err));
    OK(tobi_world_looks(w, &looks, &err));
    assert_int_equal(looks.zone_count, 0);
    assert_int_equal(looks.edge_count, 3);
    for (int64_t k = 0; k < looks.edge_count; k++)
        for (int end = 0; end < 2; end++)
            assert_true(looks.edges[k][end][1] > 0.1 - 1e-12 && looks.edges[k][end][1] < 0.3 + 1e-12);
    assert_true(fabs(looks.edges[0][0][0] - 0.1) < 1e-12 && fabs(looks.edges[0][1][0] - 0.3) < 1e-12);
    tobi_looks_free(&looks);
    z.outline.from = 0.1, z.outline.to = 0.2;
    OK(tobi_world_add_porous(deep, &z, &err));
    OK(tobi_world_looks(deep, &looks, &err));
    assert_int_equal(looks.edge_count, 8);
    tobi_looks_free(&looks);
    tobi_world_destroy(w);
    tobi_world_destroy(deep);
}

static void scene_says(const char *zone, const char *why)
{
    char text[1000];
    tobi_scene *scene = NULL;
    tobi_report *report = NULL;
    tobi_error error = { 0 };
    snprintf(text, sizeof text, "{ \"dimension\": 2, \"domain\": { \"min\": [0, 0], \"max\": [1, 1] }, "
             "\"spacing\": 0.1, \"end_time\": 1, \"fluids\": [ { \"name\": \"w\", \"fill\": [ { \"box\": "
             "{ \"min\": [0, 0], \"max\": [1, 0.5] } } ] } ], \"porous_zones\": [ { \"name\": \"a\", "
             "\"stones\": { \"size\": 0.1, \"porosity\": 0.4 }%s } ] }", zone);
    const tobi_status status = tobi_scene_parse("s.json", text, strlen(text), NULL, &scene, &report, &error);
    if (!why) {
        assert_int_equal(status, TOBI_OK);
        char *resolved = tobi_scene_resolved(scene);
        assert_non_null(strstr(resolved, "\"porous_zones\""));
        assert_non_null(strstr(strstr(resolved, "\"porous_zones\""), "\"points\""));
        assert_null(strstr(strstr(resolved, "\"porous_zones\""), "\"box\""));
        free(resolved);
        tobi_scene_free(scene);
        return;
    }
    assert_int_not_equal(status, TOBI_OK);
    if (!strstr(tobi_report_line(report, 0), why)) fail_msg("%s: not '%s'", tobi_report_line(report, 0), why);
    tobi_report_free(report);
}

static void scenes_say_it(void **state)
{
    (void)state;
    scene_says("", "porous_zones[0]: must have one of box, outline and cylinder, it has none");
    scene_says(", \"box\": { \"min\": [0, 0], \"max\": [1, 1] }, \"outline\": { \"points\": [[0, 0], [1, 0], "
               "[0, 1]] }", "must have one of box, outline and cylinder, it has several");
    scene_says(", \"box\": { \"min\": [0, 0] }", "porous_zones[0].box: must have two corners, min and max");
    scene_says(", \"outline\": { \"base\": 0 }", "porous_zones[0].outline: must have points or a file");
    scene_says(", \"outline\": { \"file\": \"none.csv\" }", "porous_zones[0].outline.file: cannot find ");
    scene_says(", \"outline\": { \"points\": [[0, 0], [1, 0], [0, 1]] }", NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(polygons_hold_what_is_inside), cmocka_unit_test(each_point_is_in_one_of_all),
        cmocka_unit_test(common_areas_are_exact), cmocka_unit_test(a_rectangle_is_the_box),
        cmocka_unit_test(layers_share_their_slopes), cmocka_unit_test(zones_do_not_overlap),
        cmocka_unit_test(zones_along_different_axes),
        cmocka_unit_test(prisms_that_cross_have_a_common_part),
        cmocka_unit_test(wrong_outlines_are_refused), cmocka_unit_test(notes_know_outlines),
        cmocka_unit_test(screens_lie_along_their_outline), cmocka_unit_test(pictures_have_the_edges),
        cmocka_unit_test(scenes_say_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
