/* Pictures of a scene with nests: which liquid is drawn where, boxes that go along with a body, surfaces
   without a gap between them. */
#include "calls.h"
#include "failing_memory.h"
#include "tobiuo/drawing.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { N = 20, FINE = 2*N };

static tobi_material_look material = { .color = { -1, -1, -1 }, .core_color = { -1, -1, -1 }, .visible = 1,
                                       .liquid = 1 };
static tobi_body_look body = { .name = "a_box", .body = "a box", .middle = { 0.5, 0.5, 0 }, .visible = 1 };
static tobi_looks looks = { .dimension = 2, .box_max = { 1, 1, 0 }, .gravity = { 0, -9.81, 0 },
                            .spacing = 1.0/N, .rim = 0.2, .material_count = 1, .materials = &material,
                            .body_count = 1, .bodies = &body };
static const double right[2][3] = { { 0.5, -INFINITY, -INFINITY }, { INFINITY, INFINITY, INFINITY } };

/* Liquid all over the domain, side x side particles at a speed. */
static tobi_moment fill(int side, double speed)
{
    tobi_moment m = { .count = (int64_t)side*side, .field_count = 1 };
    m.positions = malloc((size_t)m.count*sizeof *m.positions);
    m.fields = calloc(1, sizeof *m.fields);
    m.fields[0] = (tobi_moment_field){ strdup("velocity"), 3, calloc(3*(size_t)m.count, sizeof(double)) };
    for (int i = 0; i < side*side; i++) {
        m.positions[i][0] = (i%side + 0.5)/side;
        m.positions[i][1] = (i/side + 0.5)/side;
        m.positions[i][2] = 0;
        m.fields[0].values[3*i] = speed;
    }
    return m;
}

static tobi_moment fill_both(void)
{
    tobi_moment m = fill(N, 1), own = fill(FINE, 2);
    OK(tobi_moment_add_nest(&m, &own, right, 1.0/FINE, &err));
    tobi_moment_free(&own);
    return m;
}

static void liquid_of_a_nest_is_shown_in_its_box(void **state)
{
    (void)state;
    tobi_moment m = fill_both();
    const int64_t added = m.count - N*N;
    assert_true(added > FINE*FINE/2 && added < FINE*FINE);      /* and some of the rim, for surfaces */
    for (int64_t i = 0; i < m.count; i++) {
        assert_int_equal(m.nest[i], i >= N*N);
        assert_float_equal(m.fields[0].values[3*i], i >= N*N ? 2 : 1, 0);
        assert_int_equal(tobi_moment_shows(&m, i), (m.positions[i][0] > 0.5) == (i >= N*N));
    }
    assert_int_equal(tobi_moment_shows(&m, m.count), 0);
    tobi_moment_free(&m);
}

static void fields_that_a_nest_lacks_have_no_values(void **state)
{
    (void)state;
    tobi_moment m = fill(N, 1), own = fill(FINE, 2);
    strcpy(own.fields[0].name, "x");
    OK(tobi_moment_add_nest(&m, &own, right, 1.0/FINE, &err));
    assert_true(isnan(m.fields[0].values[3*(m.count - 1)]));
    tobi_moment_free(&own);
    own = (tobi_moment){ 0 };                                   /* one that is dry */
    for (int k = 1; k < TOBI_NEST_LIMIT; k++)
        OK(tobi_moment_add_nest(&m, &own, right, 1.0/FINE, &err));
    REFUSED(tobi_moment_add_nest(&m, &own, right, 1.0/FINE, &err), TOBI_INVALID,
            "a moment has 4 nests or fewer");
    m.nest_count = 0;
    REFUSED(tobi_moment_add_nest(&m, &own, right, 0, &err), TOBI_INVALID, "a nest with a spacing of 0 m");
    tobi_moment_free(&m);
}

static tobi_drawing *draw(const tobi_moment *m, int look, int nests)
{
    static tobi_view_def view;
    tobi_drawing *d;
    view = (tobi_view_def){ .width = 200, .height = 200, .samples = 1, .look = look, .nests = nests };
    OK(tobi_drawing_make(&looks, m, &view, &d, &err));
    return d;
}

static void particles_have_the_size_of_their_spacing(void **state)
{
    (void)state;
    tobi_moment m = fill_both();
    tobi_drawing *d = draw(&m, TOBI_LOOK_PARTICLES, 1);
    const tobi_picture *p = tobi_drawing_picture(d);
    assert_int_equal(p->particle_count, N*N/2 + FINE*FINE/2);
    for (int64_t i = 0; i < p->particle_count; i++)
        assert_float_equal(p->radii[i], (p->positions[i][0] > 0.5 ? 0.25 : 0.5)/N, 1e-12);
    tobi_drawing_free(d);
    d = draw(&m, TOBI_LOOK_PARTICLES, 0);
    assert_int_equal(tobi_drawing_picture(d)->particle_count, N*N);      /* the scene alone */
    assert_null(tobi_drawing_picture(d)->nest);
    tobi_drawing_free(d);
    tobi_moment_free(&m);
}

/* Values of what is hidden do not count. */
static void colors_end_at_what_is_shown(void **state)
{
    (void)state;
    tobi_moment m = fill_both();
    for (int64_t i = 0; i < m.count; i++)
        if (!tobi_moment_shows(&m, i)) m.fields[0].values[3*i] = 50;
    tobi_drawing *d = draw(&m, TOBI_LOOK_SURFACE, 1);
    assert_float_equal(tobi_drawing_picture(d)->value_min, 1, 0);
    assert_float_equal(tobi_drawing_picture(d)->value_max, 2, 0);
    tobi_drawing_free(d);
    tobi_moment_free(&m);
}

/* Pixels within the domain that are as light as the background: none has the speed 1 or 2 then. */
static int count_gaps(tobi_drawing *d)
{
    static uint8_t rgb[200*200*3];
    tobi_picture *p = tobi_drawing_picture(d);
    int gaps = 0;
    p->title = p->label = NULL;
    p->value_min = 0, p->value_max = 2;
    p->palette = tobi_color_map("viridis", &p->palette_count);
    OK(tobi_picture_draw(p, rgb, &err));
    for (int k = 0; k < 200*200; k++) {
        const int x = k%200, y = k/200;
        gaps += x > 30 && x < 170 && y > 30 && y < 170 && rgb[3*k] > 180 && rgb[3*k + 2] > 180;
    }
    return gaps;
}

static void surfaces_meet_without_a_gap(void **state)
{
    (void)state;
    tobi_moment m = fill_both();
    tobi_drawing *d = draw(&m, TOBI_LOOK_SURFACE, 1);
    assert_int_equal(count_gaps(d), 0);
    tobi_drawing_free(d);
    for (int64_t i = 0; i < m.count; i++)
        if (i >= N*N) m.positions[i][0] = NAN;      /* without the nest its box is empty */
    d = draw(&m, TOBI_LOOK_SURFACE, 1);
    assert_true(count_gaps(d) > 140*140/3);
    tobi_drawing_free(d);
    tobi_moment_free(&m);
}

/* A pool, 8 layers deep and 16 wide, or twice as many. */
static tobi_moment fill_pool(int finer)
{
    const int wide = 16*finer, deep = 8*finer;
    tobi_moment m = { .count = (int64_t)wide*wide*deep };
    m.positions = malloc((size_t)m.count*sizeof *m.positions);
    for (int i = 0; i < m.count; i++)
        for (int a = 0; a < 3; a++)
            m.positions[i][a] = (i/(a == 0 ? 1 : a == 1 ? wide : wide*wide)%wide + 0.5)/wide;
    return m;
}

static void see_from_above(const tobi_moment *m, int nests, uint8_t *rgb)
{
    static const double up[3] = { 0, 1, 0 };
    tobi_drawing *d = draw(m, TOBI_LOOK_NATURAL, nests);
    tobi_picture *p = tobi_drawing_picture(d);
    p->dimension = 3, p->box_max[2] = 1, p->has_camera = 1, p->field_of_view = 30;
    for (int a = 0; a < 3; a++) p->eye[a] = a < 2 ? 0.5 : 2.5, p->target[a] = 0.5, p->up[a] = up[a];
    p->title = p->label = NULL, p->values = NULL, p->look = TOBI_LOOK_NATURAL;
    OK(tobi_picture_draw(p, rgb, &err));
    tobi_drawing_free(d);
}

/* Still water looks the same with a nest in its midst, but for a faint line. */
static void water_shows_no_groove_around_a_nest(void **state)
{
    static uint8_t with[200*200*3], without[200*200*3];
    const double box[2][3] = { { 0.3, 0.3, -INFINITY }, { 0.7, 0.7, INFINITY } };
    int most = 0;
    (void)state;
    looks.box_max[2] = 1, looks.spacing = 1.0/16, looks.dimension = 3;
    tobi_moment m = fill_pool(1), own = fill_pool(2);
    OK(tobi_moment_add_nest(&m, &own, box, 1.0/32, &err));
    see_from_above(&m, 1, with);
    see_from_above(&m, 0, without);
    for (int k = 0; k < 200*200*3; k++) {
        const int differs = abs(with[k] - without[k]);
        most = differs > most ? differs : most;
    }
    assert_in_range(most, 1, 60);      /* a groove differs by 135 */
    looks.box_max[2] = 0, looks.spacing = 1.0/N, looks.dimension = 2;
    tobi_moment_free(&own);
    tobi_moment_free(&m);
}

static void boxes_go_along_with_bodies(void **state)
{
    (void)state;
    char name[] = "a_box";
    double corner[3][3] = { { 0.5, 0.4, 0 }, { 0.7, 0.4, 0 }, { 0.5, 0.6, 0 } }, box[2][3];
    tobi_moment_surface surface = { name, 3, 0, corner, NULL };
    tobi_moment m = { .surfaces = &surface };
    tobi_nest_def def = { .box_min = { 0.4, 0.05, 0 }, .box_max = { 0.6, 0.95, 0 }, .refinement = 2 };
    assert_int_equal(tobi_nest_box(&looks, &def, &m, box), 1);
    assert_float_equal(box[0][0], 0.4, 1e-12);
    assert_true(isinf(box[0][1]) && isinf(box[1][1]));      /* where the rim has no room */
    def.follow = "a box";
    assert_int_equal(tobi_nest_box(&looks, &def, &m, box), 0);      /* there is no surface */
    m.surface_count = 1;
    assert_int_equal(tobi_nest_box(&looks, &def, &m, box), 1);
    assert_float_equal(box[0][0], 0.5, 1e-12);
    assert_float_equal(box[1][0], 0.7, 1e-12);
    def.follow = "another";
    assert_int_equal(tobi_nest_box(&looks, &def, &m, box), 0);
}

static void without_memory_nothing_is_added(void **state)
{
    (void)state;
    tobi_moment own = fill(FINE, 2);
    int failed = 0;
    for (int n = 1; n < 6; n++) {
        tobi_moment m = fill(N, 1);
        tobi_error err = { 0 };
        allocations = 0, fail_at = n;
        const tobi_status status = tobi_moment_add_nest(&m, &own, right, 1.0/FINE, &err);
        fail_at = 0;
        failed += status == TOBI_NO_MEMORY;
        if (status != TOBI_OK) assert_true(m.count == N*N && m.nest_count == 0);
        tobi_moment_free(&m);
    }
    assert_true(failed == 4);
    tobi_moment_free(&own);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(liquid_of_a_nest_is_shown_in_its_box),
        cmocka_unit_test(fields_that_a_nest_lacks_have_no_values),
        cmocka_unit_test(particles_have_the_size_of_their_spacing),
        cmocka_unit_test(colors_end_at_what_is_shown),
        cmocka_unit_test(surfaces_meet_without_a_gap),
        cmocka_unit_test(water_shows_no_groove_around_a_nest),
        cmocka_unit_test(boxes_go_along_with_bodies), cmocka_unit_test(without_memory_nothing_is_added),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
