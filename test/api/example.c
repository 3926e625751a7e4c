/* A box of water at rest, as a user's program would compute it: 20 steps, then time, the share of
   the water's weight that the walls carry, and the hash of the state.
   Build: cc example.c $(pkg-config --cflags --libs tobiuo) */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <tobiuo/tobiuo.h>

/* A closed tank of 0.2 x 0.2 x 0.2 m, half full of water. */
static tobi_status build(tobi_world **world, tobi_error *err)
{
    tobi_world_def def = tobi_default_world_def();
    tobi_fluid_def water = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    def.method = "dfsph";
    def.dimension = 3;
    def.spacing = 0.01;
    def.gravity[0] = def.gravity[1] = 0;
    def.gravity[2] = -9.81;
    for (int a = 0; a < 3; a++) {
        def.domain_min[a] = -0.1;
        def.domain_max[a] = 0.1;
        def.wall_min[a] = def.wall_max[a] = TOBI_WALL_SLIP;
        fill.box_min[a] = -0.1;
        fill.box_max[a] = a == 2 ? 0.0 : 0.1;
    }
    water.name = "water";
    water.density = 1000;
    water.viscosity = 1e-3;

    tobi_status status = tobi_world_create(&def, NULL, world, err);
    if (status == TOBI_OK) status = tobi_world_add_fluid(*world, &water, &fill, 1, err);
    return status;
}

int main(void)
{
    tobi_world *world = NULL;
    tobi_step_info info = {0};
    tobi_error err = {0};
    tobi_status status = build(&world, &err);
    for (int step = 0; status == TOBI_OK && step < 20; step++)
        status = tobi_world_step(world, 0, &info, &err);
    if (status != TOBI_OK) {
        fprintf(stderr, "example: %s: %s\n", tobi_status_text(status), err.text);
        tobi_world_destroy(world);
        return 1;
    }
    double share = -info.wall_force[2]/info.weight;
    printf("tobiuo %s: %" PRId64 " particles, %" PRId64 " steps, time %.6f s\n",
           tobi_version(), info.fluid_particles, info.step, tobi_world_time(world));
    printf("wall force / weight %.4f\n", share);
    printf("state hash %016" PRIx64 "\n", tobi_world_hash(world));
    tobi_world_destroy(world);

    /* 4000 = 20 x 20 x 10 lattice places; the walls must carry something like the weight. */
    int right = info.fluid_particles == 4000 && info.step == 20 && fabs(share - 1) < 0.2;
    if (!right) fprintf(stderr, "example: the result is not a box of water at rest\n");
    return right ? 0 : 1;
}
