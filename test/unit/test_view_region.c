/* Regions of particles in 2-D: where they end, their colours, and images on solids and on glass. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "tobiuo/drawing.h"
#include "tobiuo/run.h"
#include "stripes_rig.h"
#include "world/world.h"

enum { FLAT_SIDE = 200 };

/* A box with six stripes from x = 0 to 1 m, on all sides that are seen along z. */
static void write_plate(const char *path)
{
    static const int corner[6][4] = { { 1, 3, 7, 5 }, { 2, 6, 8, 4 }, { 1, 5, 6, 2 },
                                      { 3, 4, 8, 7 }, { 1, 2, 4, 3 }, { 5, 7, 8, 6 } };
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    for (int k = 0; k < 8; k++) fprintf(f, "v %d %d %g\n", k & 1, k >> 1 & 1, (k >> 2) - 0.5);
    for (int k = 0; k < 8; k++) fprintf(f, "vt %d %d\n", k & 1, k >> 1 & 1);
    for (int k = 0; k < 6; k++) {
        fprintf(f, "f");
        for (int c = 0; c < 4; c++) fprintf(f, " %d/%d", corner[k][c], corner[k][c]);
        fprintf(f, "\n");
    }
    fclose(f);
}

/* In 2-D, in a domain of 4 m: a plate of glass at 2.5 .. 3.5 m, a solid at 0.5 .. 1.5 m. */
static tobi_world *make_flat(int vessel, tobi_status expected, tobi_error *err)
{
    tobi_world_def def = tobi_default_world_def();
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_body_def body = tobi_default_body_def();
    tobi_world *w;
    write_stripes("stripes.png");
    write_plate("plate.obj");
    def.method = "mlsmpm";
    def.dimension = 2;
    def.spacing = 0.05;
    def.domain_max[0] = def.domain_max[1] = 4;
    assert_int_equal(tobi_world_create(&def, NULL, &w, err), TOBI_OK);
    solid.name = "sheet";
    solid.texture = body.texture = "stripes.png";
    for (int a = 0; a < 3; a++) fill.scale[a] = 1;
    fill.mesh = body.mesh = "plate.obj";
    fill.translation[0] = fill.translation[1] = body.translation[1] = 0.5;
    body.name = "pane";
    body.translation[0] = 2.5;
    body.opacity = 0.7;
    body.vessel = vessel;
    if (tobi_world_add_solid(w, &solid, &fill, 1, err)) fail_msg("%s", err->text);
    assert_int_equal(tobi_world_add_body(w, &body, err), expected);
    return w;
}


/* What stands in a picture in 2-D at a place. */
static int see_flat(const uint8_t rgb[FLAT_SIDE][FLAT_SIDE][3], double x, double y)
{
    const double scale = 0.92*FLAT_SIDE/4;
    return find_stripe(rgb[(int)(FLAT_SIDE/2 - scale*(y - 2))][(int)(FLAT_SIDE/2 + scale*(x - 2))]);
}

/* In 2-D the image of the side in front, on glass too; that of a solid turns with it. */
static void test_flat_pictures(void **state)
{
    (void)state;
    static uint8_t rgb[FLAT_SIDE][FLAT_SIDE][3];
    const tobi_view_def view = tobi_default_output_def().view;
    tobi_error err = { 0 };
    tobi_world *w = make_flat(0, TOBI_OK, &err);
    assert_int_equal(tobi_world_start(w, &err), TOBI_OK);
    for (int turned = 0; turned < 2; turned++) {
        tobi_looks looks;
        tobi_drawing *d;
        const double (*vertices)[3];
        const int32_t (*triangles)[3];
        char name[] = "pane";
        tobi_moment m = { .count = tobi_world_count(w, TOBI_FLUID) };
        tobi_moment_surface surface = { .name = name };
        m.fields = calloc(4, sizeof *m.fields);
        m.positions = calloc((size_t)m.count, sizeof *m.positions);
        add_field(w, &m, "material", 1);
        add_field(w, &m, "part", 1);
        add_field(w, &m, "rest_position", 3);
        const double (*rest)[3] = (const double (*)[3])m.fields[2].values;
        for (int64_t i = 0; i < m.count; i++) {
            const double x = rest[i][0] - 1, y = rest[i][1] - 1;
            m.positions[i][0] = 1 + (turned ? -y : x), m.positions[i][1] = 1 + (turned ? x : y);
        }
        assert_int_equal(tobi_world_surface(w, 0, &surface.vertex_count, &vertices, &surface.triangle_count,
                                            &triangles), TOBI_OK);
        surface.vertices = (double (*)[3])vertices, surface.triangles = (int32_t (*)[3])triangles;
        m.surfaces = &surface, m.surface_count = 1;
        assert_int_equal(tobi_world_looks(w, &looks, &err), TOBI_OK);
        if (tobi_drawing_make(&looks, &m, &view, &d, &err)) fail_msg("%s", err.text);
        tobi_picture *p = tobi_drawing_picture(d);
        p->width = p->height = FLAT_SIDE;
        p->title = p->label = NULL;
        if (tobi_picture_draw(p, &rgb[0][0][0], &err)) fail_msg("%s", err.text);
        for (int k = 0; k < 6; k++) {
            const double along = 0.5 + (k + 0.5)/6;
            assert_int_equal(see_flat(rgb, 2 + along, 1.2), k);
            assert_int_equal(turned ? see_flat(rgb, 0.8, along) : see_flat(rgb, along, 0.8), k);
        }
        assert_int_equal(see_flat(rgb, 2, 2), -1);      /* nothing is there */
        tobi_drawing_free(d);
        tobi_looks_free(&looks);
        m.surfaces = NULL, m.surface_count = 0;
        tobi_moment_free(&m);
    }
    tobi_world_destroy(w);
    w = make_flat(1, TOBI_UNSUPPORTED, &err);
    if (!strstr(err.text, "body 'pane' is a vessel in 2-D, which pictures show as an outline: it has no "
                "texture")) fail_msg("%s", err.text);
    tobi_world_destroy(w);
}

/* Water between walls on three sides, 0.6 m wide and 0.4 m high; one particle alone. */
enum { ACROSS = 60, UP = 40, MANY = ACROSS*UP + 1 };

/* m, between the halves, besides a spacing. */
static double apart = 0;

/* parts: each half is a group. */
static void draw_parts(int look, int clip, int isolines, int parts, uint8_t rgb[FLAT_SIDE][FLAT_SIDE][3])
{
    static double place[MANY][3];
    static float value[MANY];
    static int32_t group[MANY];
    static const float map[2][3] = { { 1, 0, 0 }, { 0, 0, 1 } };
    tobi_error err = { 0 };
    tobi_picture p = tobi_default_picture();
    for (int i = 0; i < MANY - 1; i++) {
        place[i][0] = 0.01*(i%ACROSS + 0.5), place[i][1] = 0.01*(i/ACROSS + 0.5);
        if (i%ACROSS >= ACROSS/2) place[i][0] += apart;
        value[i] = i%ACROSS >= ACROSS/2;
        group[i] = i%ACROSS >= ACROSS/2;
    }
    place[MANY - 1][0] = 0.3, place[MANY - 1][1] = 0.8;
    p.width = p.height = FLAT_SIDE;
    p.dimension = 2;
    p.box_max[0] = p.box_max[1] = 1;
    p.particle_count = MANY;
    p.positions = (const double (*)[3])place;
    p.values = value;
    p.group = parts ? group : NULL;
    p.isolines = isolines;
    p.palette = map, p.palette_count = 2;
    p.value_max = 1;
    p.radius = 0.005;
    p.look = look;
    p.clip = clip;
    p.clip_point[1] = 0.2, p.clip_normal[1] = 1;
    if (tobi_picture_draw(&p, &rgb[0][0][0], &err)) fail_msg("%s", err.text);
}

static void draw_water(int look, int clip, uint8_t rgb[FLAT_SIDE][FLAT_SIDE][3])
{
    draw_parts(look, clip, 0, 0, rgb);
}

/* 1: the colour of the lower value, 2: of the higher, 0: neither. */
static int value_at(const uint8_t *rgb)
{
    return rgb[0] > 240 && rgb[1] < 20 && rgb[2] < 20 ? 1 : rgb[2] > 240 && rgb[0] < 20 ? 2 : 0;
}

/* As many pixels have a colour as the particles' area is worth, in their own halves, up to the walls. */
static void test_regions(void **state)
{
    (void)state;
    static uint8_t rgb[FLAT_SIDE][FLAT_SIDE][3], discs[FLAT_SIDE][FLAT_SIDE][3];
    const double pixels = 0.92*FLAT_SIDE*0.92*FLAT_SIDE;      /* of a square metre */
    for (int clip = 0; clip < 2; clip++) {
        double sum[3] = { 0, 0, 0 };
        draw_water(TOBI_LOOK_NATURAL, clip, rgb);
        for (int y = 0; y < FLAT_SIDE; y++)
            for (int x = 0; x < FLAT_SIDE; x++) {
                const int v = value_at(rgb[y][x]);
                const double at = (x + 0.5 - 0.5*FLAT_SIDE)/(0.92*FLAT_SIDE) + 0.5;
                sum[v]++;
                if (v && fabs(at - 0.3) > 0.01) assert_int_equal(v, at < 0.3 ? 1 : 2);
            }
        print_message("%g and %g of %g pixels\n", sum[1], sum[2], 0.12*pixels/(1 + clip));
        for (int k = 1; k < 3; k++)      /* but for lines of the box and pixels of two colours */
            assert_true(fabs(sum[k]*(1 + clip)/(0.12*pixels) - 0.96) < 0.05);
    }
    draw_water(TOBI_LOOK_NATURAL, 0, rgb);
    const int low = (int)(FLAT_SIDE*(0.5 + 0.92*0.5)) - 3, left = (int)(FLAT_SIDE*(0.5 - 0.92*0.5)) + 2;
    assert_int_equal(value_at(rgb[low - 10][left]), 1);
    assert_int_equal(value_at(rgb[low][left + 20]), 1);
    const int drop = (int)(FLAT_SIDE*(0.5 - 0.92*0.3)), across = (int)(FLAT_SIDE*(0.5 - 0.92*0.2));
    assert_int_not_equal(rgb[drop][across][0], rgb[drop - 20][across][0]);      /* a disc */
    draw_water(TOBI_LOOK_PARTICLES, 0, discs);
    assert_memory_not_equal(rgb, discs, sizeof rgb);
}

/* Two liquids that lie loosely: nothing of the background is seen between them. */
static void test_no_gap_between_liquids(void **state)
{
    (void)state;
    static uint8_t rgb[FLAT_SIDE][FLAT_SIDE][3];
    const int middle = (int)(FLAT_SIDE*(0.5 + 0.92*0.3));
    int ends[2] = { 0, 0 };
    apart = 0.01;
    draw_parts(TOBI_LOOK_NATURAL, 0, 0, 1, rgb);
    apart = 0;
    for (int x = (int)(FLAT_SIDE*(0.5 - 0.92*0.45)); x < (int)(FLAT_SIDE*(0.5 + 0.92*0.05)); x++) {
        const int value = value_at(rgb[middle][x]);
        if (rgb[middle][x][1] > 60) fail_msg("background at pixel %d", x);
        if (value) ends[value - 1]++;
    }
    assert_true(abs(ends[0] - ends[1]) < 0.1*FLAT_SIDE);      /* each in its half */
}

/* Isolines stand where a value changes in one liquid, not between two that have a value each. */
static void test_isolines_of_groups(void **state)
{
    (void)state;
    static uint8_t bare[FLAT_SIDE][FLAT_SIDE][3], lines[FLAT_SIDE][FLAT_SIDE][3];
    for (int look = TOBI_LOOK_NATURAL; look <= TOBI_LOOK_PARTICLES; look += TOBI_LOOK_PARTICLES)
        for (int parts = 0; parts < 2; parts++) {
            draw_parts(look, 0, 0, parts, bare);
            draw_parts(look, 0, 3, parts, lines);
            int changed = 0;
            for (int y = 0; y < FLAT_SIDE; y++)
                for (int x = 0; x < FLAT_SIDE; x++) changed += memcmp(bare[y][x], lines[y][x], 3) != 0;
            if (parts ? changed > 0 : changed < FLAT_SIDE/4) fail_msg("%d pixels, parts: %d", changed, parts);
        }
}

/* Isolines reach the surface of the liquid and end there. */
static void test_isolines_end(void **state)
{
    (void)state;
    enum { WIDE = 12, HIGH = 8, SIDE = 400 };
    static double place[WIDE*HIGH][3];
    static float value[WIDE*HIGH];
    static uint8_t bare[SIDE][SIDE][3], lines[SIDE][SIDE][3];
    static const float map[2][3] = { { 1, 0, 0 }, { 0, 0, 1 } };
    tobi_error err = { 0 };
    tobi_picture p = tobi_default_picture();
    int inside = 0;
    for (int i = 0; i < WIDE*HIGH; i++) {
        place[i][0] = 0.05*(i%WIDE + 0.5), place[i][1] = 0.05*(i/WIDE + 0.1);
        value[i] = (float)(i%WIDE)/(WIDE - 1);
    }
    p.width = p.height = SIDE;
    p.dimension = 2;
    p.box_max[0] = p.box_max[1] = 0.75;
    p.particle_count = WIDE*HIGH;
    p.positions = (const double (*)[3])place;
    p.values = value;
    p.palette = map, p.palette_count = 2;
    p.value_max = 1;
    p.radius = 0.025;
    if (tobi_picture_draw(&p, &bare[0][0][0], &err)) fail_msg("%s", err.text);
    p.isolines = 5;
    if (tobi_picture_draw(&p, &lines[0][0][0], &err)) fail_msg("%s", err.text);
    const int surface = (int)(SIDE*(0.5 + 0.92*0.5) - 0.92*SIDE*0.38/0.75);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            const int differs = memcmp(bare[y][x], lines[y][x], 3) != 0;
            if (differs && y < surface - 4) fail_msg("a line in the air at pixel %d, %d", x, y);
            inside += differs && y < surface + 8;
        }
    assert_true(inside >= 5*8);      /* all reach the surface */
}

/* An isoline is as dark at the ends of its parts as between them. */
static void test_even_lines(void **state)
{
    (void)state;
    static uint8_t bare[FLAT_SIDE][FLAT_SIDE][3], lines[FLAT_SIDE][FLAT_SIDE][3];
    int least = 1000, most = 0;
    draw_parts(TOBI_LOOK_PARTICLES, 0, 0, 0, bare);
    draw_parts(TOBI_LOOK_PARTICLES, 0, 1, 0, lines);
    for (int y = FLAT_SIDE*7/10; y < FLAT_SIDE*9/10; y++) {
        int ink = 0;      /* across the line, which is upright, in the middle of two colours */
        for (int x = 0; x < FLAT_SIDE; x++)
            for (int c = 0; c < 3; c++) ink += bare[y][x][c] > 128 ? bare[y][x][c] - lines[y][x][c] : 0;
        least = ink < least ? ink : least;
        most = ink > most ? ink : most;
    }
    if (least < 100 || most > 1.1*least) fail_msg("%d to %d", least, most);
}

/* Water of 0.4 m, whose particles end 0.8 spacings before what stands at 0.3 .. 0.5 m, 0.5 m high, and a
   drop three spacings above that. */
enum { TALL_SIDE = 1000, STANDING_BODY = 1, STANDING_GLASS, STANDING_SOLID };

static bool is_taken(double x, double y, double margin)
{
    return x > 0.3 - margin && x < 0.5 + margin && y < 0.5 + margin;
}

static void draw_standing(int kind, bool water, uint8_t (*rgb)[TALL_SIDE][3])
{
    static double place[5000][3];
    static float value[5000];
    static int32_t group[5000];
    static uint8_t opaque[5000];
    static const float map[1][3] = { { 1, 0, 0 } };
    static const int32_t quad[6][4] = { { 0, 2, 6, 4 }, { 1, 5, 7, 3 }, { 0, 4, 5, 1 },
                                        { 2, 3, 7, 6 }, { 0, 1, 3, 2 }, { 4, 6, 7, 5 } };
    double corner[8][3];
    int32_t triangle[12][3];
    tobi_error err = { 0 };
    tobi_picture p = tobi_default_picture();
    tobi_picture_mesh mesh = { .vertices = (const double (*)[3])corner, .vertex_count = 8,
                               .triangles = (const int32_t (*)[3])triangle, .triangle_count = 12,
                               .color = { 0, 0, 1 }, .transparency = kind == STANDING_GLASS ? 0.5f : 0 };
    for (int k = 0; k < 8; k++)
        corner[k][0] = k & 1 ? 0.5 : 0.3, corner[k][1] = k & 2 ? 0.5 : 0, corner[k][2] = k & 4 ? 1 : -1;
    for (int k = 0; k < 12; k++)
        for (int c = 0; c < 3; c++) triangle[k][c] = quad[k/2][c ? k%2 + c : 0];
    for (int i = 0; i < 10000; i++) {
        const double y = 0.01*(i/100 + 0.5);
        const bool taken = is_taken(0.01*(i%100 + 0.5), y, 0);
        const double x = 0.01*(i%100) + (taken ? 0.005 : 0.002);
        const bool drop = fabs(x - 0.4) < 0.03 && y > 0.53 && y < 0.58;
        const bool below = y < 0.4 && !is_taken(x, y, 0.00799);
        if (taken ? kind != STANDING_SOLID : !water || !(below || drop)) continue;
        memcpy(place[p.particle_count], (double[3]){ x, y, 0 }, sizeof *place);
        opaque[p.particle_count] = (uint8_t)taken;
        group[p.particle_count++] = taken;
    }
    p.width = p.height = TALL_SIDE;
    p.dimension = 2;
    p.box_max[0] = p.box_max[1] = 1;
    p.positions = (const double (*)[3])place;
    p.values = value, p.value_max = 1;
    p.group = group, p.opaque = opaque;
    p.palette = map, p.palette_count = 1;
    p.radius = 0.005;
    p.meshes = &mesh, p.mesh_count = kind == STANDING_SOLID ? 0 : 1;
    if (tobi_picture_draw(&p, &rgb[0][0][0], &err)) fail_msg("%s", err.text);
}

static int pixel_at(double x) { return (int)(TALL_SIDE*(0.5 + 0.92*(x - 0.5))); }

/* Water reaches up to bodies and solids, and not where there is air between, nor below glass. */
static void test_standing_in_water(void **state)
{
    (void)state;
    static uint8_t wet[TALL_SIDE][TALL_SIDE][3], dry[TALL_SIDE][TALL_SIDE][3];
    for (int kind = STANDING_BODY; kind <= STANDING_SOLID; kind++) {
        draw_standing(kind, true, wet);
        draw_standing(kind, false, dry);
        for (int y = pixel_at(1 - 0.38); y < pixel_at(1 - 0.02); y++)
            for (int x = pixel_at(0.01); x < pixel_at(0.99); x++) {
                const bool water = memcmp(wet[y][x], dry[y][x], 3) != 0;
                if (x < pixel_at(0.3) - 1 || x > pixel_at(0.5) + 1) assert_true(water);
                else if (x > pixel_at(0.3) + 1 && x < pixel_at(0.5) - 1) assert_false(water);
            }
        for (int x = pixel_at(0.31); x < pixel_at(0.49); x++)
            for (int y = pixel_at(1 - 0.522); y < pixel_at(1 - 0.49); y++)
                assert_memory_equal(wet[y][x], dry[y][x], 3);
        const int drop = pixel_at(1 - 0.55), middle = pixel_at(0.4);
        assert_memory_not_equal(wet[drop][middle], dry[drop][middle], 3);
    }
}

/* Numbers of the colour bar and its label end before the picture does. */
static void test_color_bar(void **state)
{
    (void)state;
    static uint8_t rgb[FLAT_SIDE][FLAT_SIDE][3];
    static const double top[] = { 33000, 1.5, 123.456, 1e-5 };
    for (int k = 0; k < 4; k++) {
        tobi_error err = { 0 };
        tobi_picture p = tobi_default_picture();
        int drawn = 0;
        p.width = p.height = FLAT_SIDE;
        p.dimension = 2;
        p.box_max[0] = p.box_max[1] = 1;
        p.value_max = top[k];
        p.label = k%2 ? "acceleration of all [m/s2]" : "pressure [Pa]";
        if (tobi_picture_draw(&p, &rgb[0][0][0], &err)) fail_msg("%s", err.text);
        for (int y = 0; y < FLAT_SIDE; y++) {
            assert_memory_equal(rgb[y][FLAT_SIDE - 1], rgb[y][0], 3);
            assert_memory_equal(rgb[y][FLAT_SIDE - 2], rgb[y][0], 3);
            drawn += memcmp(rgb[y][FLAT_SIDE - 8], rgb[y][0], 3) != 0;
        }
        assert_true(drawn > 3);
    }
}

/* A bar that tapers, a prism of stations with four corners each: its face to the eye is flat. */
static void test_flat_bodies(void **state)
{
    (void)state;
    enum { STATIONS = 9 };
    static double corner[4*STATIONS][3];
    static int32_t faces[8*(STATIONS - 1)][3];
    static uint8_t rgb[FLAT_SIDE][FLAT_SIDE][3];
    for (int i = 0; i < STATIONS; i++)
        for (int k = 0; k < 4; k++) {
            const double half = 0.2 - 0.023*i;
            corner[4*i + k][0] = 0.4 + 0.4*i;
            corner[4*i + k][1] = 2 + (k == 0 || k == 3 ? -half : half);
            corner[4*i + k][2] = k < 2 ? -0.2 : 0.2;
        }
    for (int i = 0; i + 1 < STATIONS; i++)
        for (int32_t k = 0; k < 4; k++) {
            const int32_t a = 4*i + k, b = 4*i + (k + 1)%4;
            memcpy(faces[8*i + 2*k], (int32_t[3]){ a, b, b + 4 }, sizeof *faces);
            memcpy(faces[8*i + 2*k + 1], (int32_t[3]){ a, b + 4, a + 4 }, sizeof *faces);
        }
    const tobi_picture_mesh bar = {
        .vertex_count = 4*STATIONS, .vertices = (const double (*)[3])corner, .color = { 0.9f, 0.1f, 0.1f },
        .triangle_count = 8*(STATIONS - 1), .triangles = (const int32_t (*)[3])faces };
    tobi_picture p = tobi_default_picture();
    tobi_error err = { 0 };
    p.width = p.height = FLAT_SIDE;
    p.dimension = 2;
    p.box_max[0] = p.box_max[1] = 4;
    p.mesh_count = 1, p.meshes = &bar;
    if (tobi_picture_draw(&p, &rgb[0][0][0], &err)) fail_msg("%s", err.text);
    const double scale = 0.92*FLAT_SIDE/4, middle = FLAT_SIDE/2;
    const uint8_t *first = rgb[FLAT_SIDE/2][(int)(FLAT_SIDE/2 - 1.4*scale)];
    assert_true(first[0] > 2*first[1]);
    for (int i = 0; i < 13; i++)
        for (int side = -1; side < 2; side++) {
            const double x = 0.6 + 0.2*i, half = 0.2 - 0.023*(x - 0.4)/0.4;
            const uint8_t *at = rgb[(int)(middle + 0.7*side*half*scale)][(int)(middle + scale*(x - 2))];
            for (int c = 0; c < 3; c++) assert_true(abs(at[c] - first[c]) < 3);
        }
}

int main(void)
{
    char folder[] = "/tmp/tobiuo_region_XXXXXX", command[100];
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_regions), cmocka_unit_test(test_flat_pictures),
                                        cmocka_unit_test(test_no_gap_between_liquids),
                                        cmocka_unit_test(test_color_bar),
                                        cmocka_unit_test(test_isolines_of_groups),
                                        cmocka_unit_test(test_isolines_end),
                                        cmocka_unit_test(test_standing_in_water),
                                        cmocka_unit_test(test_even_lines),
                                        cmocka_unit_test(test_flat_bodies) };
    if (!mkdtemp(folder) || chdir(folder) != 0) return 1;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    if (chdir("/") == 0) snprintf(command, sizeof command, "rm -r %s", folder);
    return system(command) != 0 || failed;
}
