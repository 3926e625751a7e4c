/* Free bodies that fall on solids. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "tobiuo/tobiuo.h"

/* From a height of two spacings: who looks for contacts only where the body was at the start finds none. */
static void a_falling_box_is_caught(void **state)
{
    (void)state;
    tobi_world_def w = tobi_default_world_def();
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_body_def body = tobi_default_body_def();
    tobi_body_info info;
    tobi_world *world;
    tobi_error err = { 0 };
    w.method = "mlsmpm";
    w.spacing = 0.05;
    for (int a = 0; a < 3; a++) {
        w.domain_max[a] = a == 2 ? 0.6 : 0.4;
        fill.box_max[a] = a == 2 ? 0.2 : 0.4;
        body.box_min[a] = a == 2 ? 0.3 : 0.1;
        body.box_max[a] = a == 2 ? 0.5 : 0.3;
    }
    body.name = "box";
    body.dynamics = TOBI_FREE;
    assert_int_equal(tobi_world_create(&w, NULL, &world, NULL), TOBI_OK);
    assert_int_equal(tobi_world_add_solid(world, &solid, &fill, 1, NULL), TOBI_OK);
    if (tobi_world_add_body(world, &body, &err)) fail_msg("%s", err.text);
    if (tobi_world_advance(world, 0.4, NULL, &err)) fail_msg("%s", err.text);
    tobi_world_body(world, 0, &info);
    /* 8 kg on 0.04 m2 of 1e6 Pa: it sinks 0.4 mm and half a spacing is the gap's uncertainty. */
    if (!(info.position[2] > 0.27 && info.position[2] < 0.33)) fail_msg("it is at %g m", info.position[2]);
    tobi_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(a_falling_box_is_caught) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
