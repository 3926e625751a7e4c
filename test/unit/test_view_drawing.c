/* From a moment to a picture: what is hidden, colours of kinds and pieces, which of them a field colours,
   bodies by name, paths. */
#include "view/draw.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "tobiuo/drawing.h"
#include "calls.h"

enum { N = 40 };

static double place[N][3], material[N], speed[3*N];
#define LOOK(...) { .core_color = { -1, -1, -1 }, __VA_ARGS__ }
static tobi_material_look looks_of[4] = {
    LOOK(.color = { -1, -1, -1 }, .visible = 1, .liquid = 1),
    LOOK(.color = { -1, -1, -1 }, .visible = 1, .liquid = 1),
    LOOK(.color = { -1, -1, -1 }, .visible = 1, .liquid = 1, .kind = 2),
    LOOK(.color = { 200, 0, 0 }, .kind = 3)
};
static tobi_body_look body = { .name = "a_box", .body = "a box", .color = { 255, 0, 0 }, .opacity = 0.25,
                               .visible = 1, .hollow = 1 };
static tobi_looks looks = { .dimension = 3, .box_max = { 1, 1, 1 }, .gravity = { 0, 0, -9.81 },
                            .spacing = 0.1,
                            .material_count = 4, .body_count = 1, .materials = looks_of, .bodies = &body };
static char field_name[] = "material", velocity_name[] = "velocity", box_name[] = "a_box";
static double corner[3][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } };
static int32_t side[1][3] = { { 0, 1, 2 } };
static tobi_moment_field fields[2] = { { field_name, 1, material }, { velocity_name, 3, speed } };
static tobi_moment_surface surface = { box_name, 3, 1, corner, side };
static tobi_moment moment = { .time = 0.5, .count = N, .positions = place, .field_count = 2,
                              .surface_count = 1, .fields = fields, .surfaces = &surface };

static tobi_view_def plain_view(void)
{
    return (tobi_view_def){ .width = 64, .height = 64, .samples = 1 };
}

static tobi_drawing *make(const tobi_view_def *view)
{
    tobi_error err = { 0 };
    tobi_drawing *d;
    for (int i = 0; i < N; i++) material[i] = i%4, place[i][0] = 0.01*i;
    if (tobi_drawing_make(&looks, &moment, view, &d, &err) != TOBI_OK) fail_msg("%s", err.text);
    return d;
}

static void materials_have_looks(void **state)
{
    (void)state;
    const tobi_view_def view = plain_view();
    tobi_drawing *d = make(&view);
    const tobi_picture *p = tobi_drawing_picture(d);
    assert_int_equal(p->particle_count, 3*N/4);                /* the last material is hidden */
    assert_non_null(p->palette);                               /* two kinds of liquid */
    assert_int_equal(p->group[0], p->group[1]);                /* equal fluids are one */
    assert_true(p->group[0] != p->group[2]);
    for (int k = 0; k < 3; k++)
        assert_true(p->palette[(int)p->values[0]][k] == p->palette[(int)p->values[1]][k]);
    assert_true(memcmp(p->palette[(int)p->values[0]], p->palette[(int)p->values[2]], 12) != 0);
    assert_string_equal(p->title, "t = 0.5000 s");
    tobi_drawing_free(d);
    tobi_drawing_free(NULL);
}

/* Air that is not to be seen leaves the water its own looks: in 2-D its speed. */
static void what_is_hidden_gives_no_colors(void **state)
{
    (void)state;
    const tobi_view_def view = plain_view();
    tobi_material_look two[2] = { LOOK(.color = { -1, -1, -1 }, .visible = 1, .liquid = 1),
                                  LOOK(.color = { -1, -1, -1 }, .liquid = 1, .kind = 1) };
    const tobi_looks before = looks;
    looks.materials = two;
    looks.material_count = 2;
    looks.dimension = 2;
    for (int seen = 0; seen < 2; seen++) {
        two[1].visible = seen;
        tobi_drawing *d = make(&view);
        assert_true((tobi_drawing_picture(d)->label != NULL) == !seen);
        tobi_drawing_free(d);
    }
    looks = before;
}

/* Neither has a colour: a solid beside a liquid must not look like it, a solid alone shows its speed. */
static void solids_beside_liquids_have_colors(void **state)
{
    (void)state;
    tobi_material_look two[2] = { LOOK(.color = { -1, -1, -1 }, .visible = 1, .liquid = 1),
                                  LOOK(.color = { -1, -1, -1 }, .visible = 1) };
    const tobi_view_def view = plain_view();
    const tobi_looks before = looks;
    for (int count = 2; count > 0; count--) {
        looks.material_count = count;
        looks.materials = two + 2 - count;
        tobi_drawing *d = make(&view);
        const tobi_picture *p = tobi_drawing_picture(d);
        assert_int_equal(p->label == NULL, count == 2);
        if (count == 2)
            assert_memory_not_equal(p->palette[(int)p->values[0]], p->palette[(int)p->values[1]], 12);
        tobi_drawing_free(d);
    }
    looks = before;
}

/* Times of any length can be told apart; colours of speed end where the looks say. */
static void small_times_and_great_speeds(void **state)
{
    (void)state;
    static const struct { double t; const char *title; } times[] = {
        { 0, "t = 0.0000 s" }, { 12.5, "t = 12.5000 s" }, { 0.035, "t = 0.0350 s" },
        { 0.0021, "t = 0.00210 s" }, { 1e-5, "t = 0.0000100 s" }, { 2.5e-8, "t = 2.5e-08 s" }
    };
    const tobi_view_def view = plain_view();
    const tobi_looks before = looks;
    const double time = moment.time;
    for (size_t k = 0; k < sizeof times/sizeof *times; k++) {
        tobi_drawing *d;
        moment.time = times[k].t;
        d = make(&view);
        assert_string_equal(tobi_drawing_picture(d)->title, times[k].title);
        tobi_drawing_free(d);
    }
    moment.time = time;
    looks.material_count = 1;
    looks.dimension = 2;
    looks.speed = 30;
    tobi_drawing *d = make(&view);
    assert_float_equal(tobi_drawing_picture(d)->value_max, 30, 0);
    tobi_drawing_free(d);
    looks = before;
}

/* Far from the origin numbers differ in late digits. */
static void numbers_have_their_digits(void **state)
{
    (void)state;
    char text[32];
    view_write_tick(5000.5, 0.5, text);
    assert_string_equal(text, "5000.5");
    view_write_tick(0.1 + 0.1 + 0.1, 0.1, text);
    assert_string_equal(text, "0.3");
    view_write_tick(-1e-17, 0.2, text);
    assert_string_equal(text, "0");
}

/* Long numbers at the upright axis of a flat scene find room in the picture. */
static void numbers_at_axes_are_whole(void **state)
{
    (void)state;
    enum { W = 320, H = 180 };
    static uint8_t rgb[2][H][W][3];
    tobi_error err = { 0 };
    tobi_picture p = tobi_default_picture();
    int ink = 0;
    p.dimension = 2, p.width = W, p.height = H;
    p.box_max[0] = 6e-4, p.box_max[1] = 3e-4;
    for (p.axes = 0; p.axes < 2; p.axes++)
        if (tobi_picture_draw(&p, &rgb[p.axes][0][0][0], &err)) fail_msg("%s", err.text);
    for (int y = 0; y < H; y++) {
        assert_memory_equal(rgb[0][y][0], rgb[1][y][0], 3);
        for (int x = 0; x < W/4; x++) ink += rgb[1][y][x][1] + 30 < rgb[0][y][x][1];
    }
    assert_true(ink > 100);
}

enum { SIDE = 64, WIDE = 20, DEEP = 3, BLOCK = WIDE*WIDE*DEEP };

/* A liquid on the left with speeds of 0 to 1 m/s from below to above, a solid on the right with 2 to 3. */
static void make_halves(int dimension, tobi_moment *m)
{
    static double at[BLOCK][3], material_of[BLOCK], velocity[BLOCK][3];
    static tobi_moment_field two[2] = { { field_name, 1, material_of }, { velocity_name, 3, velocity[0] } };
    const int up = dimension == 2 ? 1 : 2;
    memset(at, 0, sizeof at);
    *m = (tobi_moment){ .count = dimension == 2 ? WIDE*WIDE : BLOCK, .positions = at, .field_count = 2,
                        .fields = two };
    for (int i = 0; i < m->count; i++) {
        const int x = i%WIDE, z = i/WIDE%WIDE;
        at[i][0] = (x + 0.5)/WIDE, at[i][up] = (z + 0.5)/WIDE;
        if (dimension == 3) at[i][1] = (i/WIDE/WIDE + 0.5)/WIDE;
        material_of[i] = x >= WIDE/2;
        velocity[i][0] = (double)z/(WIDE - 1) + 2*material_of[i];
    }
}

/* Of what a pixel of the left or right half shows, low or high in it. */
static const uint8_t *see_half(const uint8_t rgb[SIDE][SIDE][3], int right, int high)
{
    return rgb[high ? SIDE*16/100 : SIDE*84/100][right ? SIDE*7/10 : SIDE*3/10];
}

/* view: of its colours and lines; the range of the colours is written to it. */
static void draw_halves(int dimension, tobi_view_def *view, uint8_t rgb[SIDE][SIDE][3])
{
    tobi_material_look two[2] = { LOOK(.color = { 0, 200, 0 }, .visible = 1, .liquid = 1),
                                  LOOK(.color = { 200, 0, 0 }, .visible = 1) };
    const tobi_looks halves = { .dimension = dimension, .box_max = { 1, 1, 1 }, .spacing = 1.0/WIDE,
                                .material_count = 2, .materials = two };
    tobi_error err = { 0 };
    tobi_moment m;
    tobi_drawing *d;
    make_halves(dimension, &m);
    view->width = view->height = SIDE;
    view->samples = 1;
    view->field = "velocity";
    view->position[0] = view->look_at[0] = view->position[2] = view->look_at[2] = 0.5;
    view->position[1] = -3;
    view->angle = 20;
    if (tobi_drawing_make(&halves, &m, view, &d, &err)) fail_msg("%s", err.text);
    tobi_picture *p = tobi_drawing_picture(d);
    p->title = p->label = NULL;
    if (tobi_picture_draw(p, &rgb[0][0][0], &err)) fail_msg("%s", err.text);
    view->min = p->value_min, view->max = p->value_max;
    tobi_drawing_free(d);
}

/* The kind that shows the field has purple below and yellow above, the ends of the map; the other one is red
   or green all over, as it is given. */
static void fields_of_one_kind(void **state)
{
    (void)state;
    static uint8_t rgb[SIDE][SIDE][3];
    for (int k = 0; k < 8; k++) {
        const int solids = k & 1;
        tobi_view_def view = { .look = 1 + (k >> 1 & 1),
                               .field_of = solids ? TOBI_FIELD_OF_SOLIDS : TOBI_FIELD_OF_LIQUIDS };
        draw_halves(2 + (k >> 2), &view, rgb);
        assert_true(view.min == 2*solids && view.max == 1 + 2*solids);
        for (int high = 0; high < 2; high++) {
            const uint8_t *by_field = see_half(rgb, solids, high), *own = see_half(rgb, !solids, high);
            const int r = by_field[0], g = by_field[1], b = by_field[2], most = own[solids];
            const int least = own[!solids];
            if (high ? r < 1.5*b || g < 1.5*b : r < 1.5*g || b < 1.5*g) fail_msg("%d: %d %d %d", k, r, g, b);
            if (most < 100 || most < 3*least || most < 3*own[2]) fail_msg("%d: %d of %d", k, least, most);
        }
    }
}

/* Between the values of the kind that does not show the field. */
static void isolines_of_one_kind(void **state)
{
    (void)state;
    static uint8_t lines[SIDE][SIDE][3], bare[SIDE][SIDE][3];
    for (int k = 0; k < 8; k++) {
        const int solids = k & 1, all = k >> 2;
        tobi_view_def view = { .look = TOBI_LOOK_SURFACE, .min = solids ? 0 : 2, .max = solids ? 1 : 3 };
        if (!all) view.field_of = solids ? TOBI_FIELD_OF_SOLIDS : TOBI_FIELD_OF_LIQUIDS;
        draw_halves(2 + (k >> 1 & 1), &view, bare);
        view.isolines = 3;
        draw_halves(2 + (k >> 1 & 1), &view, lines);
        assert_int_equal(memcmp(bare, lines, sizeof bare) != 0, all);
    }
}

static void bodies_are_found_by_name(void **state)
{
    (void)state;
    tobi_view_def view = plain_view();
    tobi_error err = { 0 };
    const double at[2][3] = { { 0.1, 0.2, 0.3 }, { 0.4, 0.5, 0.6 } };
    for (int k = 0; k < 2; k++) assert_int_equal(tobi_track_add(&moment, "a box", at[k], &err), TOBI_OK);
    view.paths = 1;
    tobi_drawing *d = make(&view);
    const tobi_picture *p = tobi_drawing_picture(d);
    assert_int_equal(p->mesh_count, 1);
    assert_true(p->meshes[0].transparency == 0.75f && p->meshes[0].hollow && p->meshes[0].color[0] == 1);
    assert_int_equal(p->path_count, 1);
    assert_true(p->paths[0].count == 2 && p->paths[0].color[0] == 1);
    assert_true(p->paths[0].points[1][2] == (float)0.6);
    tobi_drawing_free(d);
    body.visible = 0;
    d = make(&view);
    assert_true(tobi_drawing_picture(d)->mesh_count == 0 && tobi_drawing_picture(d)->path_count == 0);
    tobi_drawing_free(d);
    free(moment.tracks[0].points);
    free(moment.tracks);
    moment.tracks = NULL, moment.track_count = 0;
}

/* Those of a scene of eight bodies can be told apart. */
static void bodies_have_colors_of_their_own(void **state)
{
    (void)state;
    enum { BODIES = 8 };
    const tobi_view_def view = plain_view();
    char names[BODIES][8];
    tobi_body_look each[BODIES];
    tobi_moment_surface surfaces[BODIES];
    tobi_looks own = looks;
    tobi_moment m = moment;
    tobi_drawing *d;
    tobi_error err = { 0 };
    for (int k = 0; k < BODIES; k++) {
        snprintf(names[k], sizeof names[k], "b%d", k);
        each[k] = (tobi_body_look){ .color = { -1, -1, -1 }, .opacity = 1, .visible = 1 };
        snprintf(each[k].name, sizeof each[k].name, "%s", names[k]);
        snprintf(each[k].body, sizeof each[k].body, "%s", names[k]);
        surfaces[k] = (tobi_moment_surface){ names[k], 3, 1, corner, side };
    }
    own.bodies = each, own.body_count = m.surface_count = BODIES, m.surfaces = surfaces;
    assert_int_equal(tobi_drawing_make(&own, &m, &view, &d, &err), TOBI_OK);
    const tobi_picture *p = tobi_drawing_picture(d);
    assert_int_equal(p->mesh_count, BODIES);
    for (int k = 0; k < BODIES; k++)
        for (int n = 0; n < k; n++)
            assert_memory_not_equal(p->meshes[k].color, p->meshes[n].color, sizeof p->meshes[k].color);
    tobi_drawing_free(d);
}

/* A table of two bodies; rows after the moment's time, and broken ones, do not count. */
static void tracks_are_read(void **state)
{
    (void)state;
    char folder[] = "/tmp/tobi_tracks_XXXXXX", path[64];
    tobi_moment m = { .time = 0.2 };
    tobi_error err = { 0 };
    assert_non_null(mkdtemp(folder));
    assert_int_equal(tobi_tracks_read(folder, &m, &err), TOBI_OK);
    assert_int_equal(m.track_count, 0);
    snprintf(path, sizeof path, "%s/bodies.csv", folder);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs("time [s],name,position_x [m],position_y [m],position_z [m]\n0,\"a \"\"b\"\", c\",1,2,3,9\n"
          "0,two,4,5,6\n0.2,\"a \"\"b\"\", c\",1.5,2,3\n0.2,two\nx,two,1,1,1\n0.3,two,7,7,7\n0.2", file);
    fclose(file);
    assert_int_equal(tobi_tracks_read(folder, &m, &err), TOBI_OK);
    assert_int_equal(m.track_count, 2);
    assert_string_equal(m.tracks[0].body, "a \"b\", c");
    assert_true(m.tracks[0].count == 2 && m.tracks[0].points[1][0] == 1.5);
    assert_true(m.tracks[1].count == 1 && m.tracks[1].points[0][2] == 6);
    tobi_moment_free(&m);
    unlink(path);
    rmdir(folder);
}

/* Tofu is cut into tofu: the faces are told apart and are no shadows. */
static void faces_of_pale_solids_stay_pale(void **state)
{
    (void)state;
    tobi_material_look pale[1] = { LOOK(.color = { 245, 240, 220 }, .visible = 1) };
    const tobi_looks of = { .dimension = 2, .material_count = 1, .materials = pale };
    float skin[4], face[4];
    tobi_looks_color(&of, 0, 0, skin);
    tobi_looks_color(&of, 0, 2, face);
    for (int k = 0; k < 3; k++) assert_true(face[k] < 0.95f*skin[k] && face[k] > 0.8f*skin[k]);
}

/* In 2-D counterclockwise is above 0 and 0 in the middle of the colours; in 3-D it is a length. */
static void vorticity_has_a_sign_in_the_plane(void **state)
{
    (void)state;
    char name[] = "vorticity";
    tobi_view_def view = plain_view();
    tobi_moment_field turn[2] = { { field_name, 1, material }, { name, 3, speed } };
    tobi_moment m = moment;
    m.fields = turn;
    view.field = name;
    for (int dimension = 2; dimension <= 3; dimension++) {
        tobi_looks of = looks;
        of.dimension = dimension;
        for (int i = 0; i < N; i++) material[i] = 0, speed[3*i + 2] = i - 30;
        tobi_drawing *d;
        assert_int_equal(tobi_drawing_make(&of, &m, &view, &d, NULL), TOBI_OK);
        const tobi_picture *p = tobi_drawing_picture(d);
        assert_true(p->values[0] == (dimension == 2 ? -30 : 30));
        assert_true(p->value_min == (dimension == 2 ? -30 : 0) && p->value_max == 30);
        tobi_drawing_free(d);
    }
    memset(speed, 0, sizeof speed);
}

static void a_component_has_its_sign(void **state)
{
    (void)state;
    tobi_view_def view = plain_view();
    view.field = "velocity_z";
    for (int i = 0; i < N; i++) material[i] = 0, speed[3*i] = 100, speed[3*i + 2] = i - 30;
    tobi_drawing *d;
    assert_int_equal(tobi_drawing_make(&looks, &moment, &view, &d, NULL), TOBI_OK);
    const tobi_picture *p = tobi_drawing_picture(d);
    assert_true(p->values[0] == -30 && p->value_min == -30 && p->value_max == N - 31);
    assert_string_equal(p->label, "velocity_z [m/s]");
    tobi_drawing_free(d);
    while (strcmp(tobi_color_map_name(view.map), "coolwarm") != 0) view.map++;        /* whose middle is 0 */
    assert_int_equal(tobi_drawing_make(&looks, &moment, &view, &d, NULL), TOBI_OK);
    p = tobi_drawing_picture(d);
    assert_true(p->value_max == fmax(30, N - 31) && p->value_min == -p->value_max);
    tobi_drawing_free(d);
    memset(speed, 0, sizeof speed);
}

/* The range of 2000 values, 0 to 1 but for `strays` of them. */
static void find_range(int strays, double stray, double other, double range[2])
{
    enum { MANY = 2000 };
    static double values[3*MANY], many[MANY], places[MANY][3];
    tobi_moment_field of[2] = { { field_name, 1, many }, { velocity_name, 3, values } };
    tobi_view_def view = plain_view();
    tobi_moment m = moment;
    tobi_drawing *d;
    m.fields = of;
    m.count = MANY;
    m.positions = places;
    view.field = "velocity_z";
    for (int i = 0; i < MANY; i++)
        values[3*i + 2] = i%(MANY/2) < strays ? (i < MANY/2 ? stray : other) : i/(MANY - 1.0);
    assert_int_equal(tobi_drawing_make(&looks, &m, &view, &d, NULL), TOBI_OK);
    range[0] = tobi_drawing_picture(d)->value_min;
    range[1] = tobi_drawing_picture(d)->value_max;
    tobi_drawing_free(d);
}

/* Few values far off do not take the colours from the rest; many do, and few that are next to the rest. */
static void strays_do_not_stretch_the_colours(void **state)
{
    (void)state;
    static const struct { int strays; double at, other, low, high; } cases[] = {
        { 2, 100, 100, 0.001, 1 }, { 2, -1e30, 1e30, 0.001, 1 }, { 2, 50, 1e6, 0.001, 1 },
        { 10, 100, 100, 0.005, 100 }, { 2, 1.5, 1.5, 0.001, 1.5 }
    };
    for (size_t k = 0; k < sizeof cases/sizeof *cases; k++) {
        double range[2];
        find_range(cases[k].strays, cases[k].at, cases[k].other, range);
        assert_float_equal(range[0], cases[k].low, 1e-3*cases[k].high);
        assert_float_equal(range[1], cases[k].high, 2e-3*cases[k].high);
    }
    double range[2];
    find_range(998, 0, 0, range);                   /* all the same but four: these have a colour too */
    assert_true(range[0] == 0 && range[1] == 1);
}

static void names_of_components(void **state)
{
    (void)state;
    static const struct { const char *name, *whole; int component; } cases[] = {
        { "velocity", "velocity", -1 }, { "velocity_y", "velocity", 1 }, { "stress_xy", "stress", 3 },
        { "stress_zx", "stress", 5 }, { "stress_xz", "stress", 5 }, { "velocity_xx", NULL, -1 },
        { "pressure_x", NULL, -1 }, { "velocity_", NULL, -1 }, { "", NULL, -1 }, { NULL, NULL, -1 },
    };
    for (size_t k = 0; k < sizeof cases/sizeof *cases; k++) {
        int component = -1;
        const char *unit = NULL, *whole = tobi_world_find_field(cases[k].name, &component, &unit);
        assert_true((whole != NULL) == (cases[k].whole != NULL) && (unit != NULL) == (whole != NULL));
        if (whole) assert_string_equal(whole, cases[k].whole);
        assert_int_equal(component, cases[k].component);
    }
}

static void wrong_calls_are_refused(void **state)
{
    (void)state;
    tobi_view_def view = plain_view();
    tobi_drawing *d;
    REFUSED(tobi_drawing_make(NULL, &moment, &view, &d, &err), TOBI_INVALID, "the looks is NULL");
    REFUSED(tobi_drawing_make(&looks, NULL, &view, &d, &err), TOBI_INVALID, "the moment is NULL");
    REFUSED(tobi_drawing_make(&looks, &moment, NULL, &d, &err), TOBI_INVALID, "the view is NULL");
    view.field = "vorticity";
    REFUSED(tobi_drawing_make(&looks, &moment, &view, &d, &err), TOBI_NOT_FOUND,
            "the output has no field 'vorticity'; a run writes it with \"fields\": [\"usual\", "
            "\"vorticity\"] in output of the scene");
    assert_null(d);
}

static void check_size(int dimension, double wide, double high, int given[2], int width, int height)
{
    const tobi_view_def v = { .width = given[0], .height = given[1], .samples = 1 };
    tobi_picture f = tobi_default_picture();
    f.dimension = dimension;
    f.box_max[0] = f.box_min[0] + wide, f.box_max[1] = f.box_min[1] + high;
    tobi_picture_set_view(&f, &v);
    if (f.width != width || f.height != height)
        fail_msg("%d-D, %g x %g m: %d x %d pixels, not %d x %d", dimension, wide, high, f.width, f.height,
                 width, height);
}

/* Pixels: 1280 x 720 in all, as long as the box and a colour bar, from 3 : 4 to 4 : 1. */
static void sizes_fit(void **state)
{
    (void)state;
    check_size(3, 9, 1, (int[2]){ 0, 0 }, 1280, 720);
    check_size(3, 9, 1, (int[2]){ 3840, 0 }, 3840, 2160);
    check_size(3, 9, 1, (int[2]){ 0, 180 }, 320, 180);
    check_size(2, 1, 1, (int[2]){ 0, 0 }, 980, 942);
    check_size(2, 9, 1, (int[2]){ 0, 0 }, 1920, 480);
    check_size(2, 1, 9, (int[2]){ 0, 0 }, 832, 1110);
    check_size(2, 2, 1, (int[2]){ 1040, 0 }, 1040, 500);
    check_size(2, 9, 1, (int[2]){ 0, 8192 }, 8192, 8192);
    check_size(2, 9, 1, (int[2]){ 101, 77 }, 101, 77);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sizes_fit), cmocka_unit_test(materials_have_looks),
        cmocka_unit_test(what_is_hidden_gives_no_colors),
        cmocka_unit_test(small_times_and_great_speeds),
        cmocka_unit_test(numbers_have_their_digits), cmocka_unit_test(numbers_at_axes_are_whole),
        cmocka_unit_test(solids_beside_liquids_have_colors), cmocka_unit_test(bodies_are_found_by_name),
        cmocka_unit_test(fields_of_one_kind), cmocka_unit_test(isolines_of_one_kind),
        cmocka_unit_test(bodies_have_colors_of_their_own),
        cmocka_unit_test(tracks_are_read), cmocka_unit_test(vorticity_has_a_sign_in_the_plane),
        cmocka_unit_test(a_component_has_its_sign),
        cmocka_unit_test(strays_do_not_stretch_the_colours), cmocka_unit_test(names_of_components),
        cmocka_unit_test(faces_of_pale_solids_stay_pale), cmocka_unit_test(wrong_calls_are_refused)
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
