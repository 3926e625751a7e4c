/* What motions may answer in 2-D. */
#include "calls.h"
#include "tobiuo/tobiuo.h"
#include <math.h>

/* Up or along z at 1 m/s from 0.01 s on, or about x or z at 1 rad/s; turns hold for small angles alone. */
typedef struct way { int shift, turn; } way;

static tobi_status move(void *user, double t, int64_t n, const double (*rest)[3], double (*x)[3],
                        tobi_error *err)
{
    const way *w = user;
    const double since = fmax(t - 0.01, 0), c = cos(since), s = sin(since);
    (void)err;
    for (int64_t k = 0; k < n; k++) {
        memcpy(x[k], rest[k], sizeof *x);
        if (w->shift >= 0) x[k][w->shift] += since;
        if (w->turn < 0) continue;
        const int a = (w->turn + 1)%3, b = (w->turn + 2)%3;
        x[k][a] = c*rest[k][a] - s*rest[k][b];
        x[k][b] = s*rest[k][a] + c*rest[k][b];
    }
    return TOBI_OK;
}

static tobi_world *make_world(int dimension, way *w)
{
    tobi_world_def def = tobi_default_world_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_body_def b = tobi_default_body_def();
    tobi_world *world;
    def.dimension = dimension;
    def.spacing = 0.05;
    def.gravity[1] = -9.81;
    def.gravity[2] = 0;
    for (int a = 0; a < dimension; a++) {
        def.domain_max[a] = fill.box_max[a] = 1;
        b.box_min[a] = 0.4, b.box_max[a] = 0.6;
    }
    if (dimension == 2) def.domain_max[2] = fill.box_max[2] = 0;
    fill.box_max[1] = 0.2;
    fluid.name = "water";
    b.name = "plate";
    b.motion = move;
    b.motion_rigid = 1;
    b.motion_user = w;
    OK(tobi_world_create(&def, NULL, &world, &err));
    OK(tobi_world_add_fluid(world, &fluid, &fill, 1, &err));
    OK(tobi_world_add_body(world, &b, &err));
    return world;
}

static void nothing_leaves_the_plane(void **state)
{
    (void)state;
    way bad[] = { { 2, -1 }, { -1, 0 } }, good[] = { { 1, -1 }, { -1, 2 } };
    for (int k = 0; k < 2; k++) {
        tobi_world *w = make_world(2, &bad[k]);
        REFUSED(tobi_world_advance(w, 0.05, NULL, &err), TOBI_INVALID, "m along z at t = ");
        tobi_world_destroy(w);
        w = make_world(2, &good[k]);
        OK(tobi_world_advance(w, 0.05, NULL, &err));
        tobi_world_destroy(w);
        w = make_world(3, &bad[k]);
        OK(tobi_world_advance(w, 0.05, NULL, &err));
        tobi_world_destroy(w);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(nothing_leaves_the_plane) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
