/* Bodies that change their shape against bodies (decision 0104): nothing passes through, what one gains the
   other loses. Overlaps that are taken out cost a little angular momentum. */
#include "rigid_rig.h"

static const double NONE[3] = { 0, 0, 0 };

/* Beats its length in y about a middle, from rest: how = x of the middle, 1/m, rad/s. */
static tobi_status beat(void *user, double t, int64_t n, const double (*rest)[3], double (*out)[3],
                        tobi_error *err)
{
    const double *how = user, grown = t < 1 ? t*t*(3 - 2*t) : 1;
    (void)err;
    for (int64_t i = 0; i < n; i++) {
        const double s = rest[i][0] - how[0];
        memcpy(out[i], rest[i], sizeof out[i]);
        out[i][1] += how[1]*s*s*grown*sin(how[2]*t);
    }
    return TOBI_OK;
}

static tobi_body *add_swimmer(rig *g, double how[3], const double middle[3], double speed)
{
    tobi_body_def def = rig_def();
    def.spacing = 0.05;
    def.motion = beat;
    def.motion_user = how;
    def.velocity[0] = speed;
    return rig_box(g, def, (double[3]){ 1, 0.2, 0.3 }, middle);
}

typedef struct sums { double momentum[3], angular[3], size; } sums;

static sums add_up(const rig *g)
{
    sums s = { { 0 }, { 0 }, 0 };
    for (int k = 0; k < g->count; k++) {
        const tobi_rigid *r = &g->bodies[k].rigid;
        double turn[3];
        vec3_cross(turn, r->position, r->velocity);
        for (int a = 0; a < 3; a++) {
            s.momentum[a] += r->mass*r->velocity[a];
            s.angular[a] += r->mass*turn[a] + r->momentum[a];
        }
        s.size += r->mass*vec3_length(r->velocity);
    }
    return s;
}

/* How deep the vertices of one are in the other, m. */
static double depth(tobi_body *a, tobi_body *b)
{
    double most = 0;
    for (int64_t i = 0; i < a->mesh.vertex_count; i++) {
        tobi_bvh_hit hit;
        if (tobi_bvh_closest(b->bvh, a->vertex[i], INFINITY, &hit)) most = fmax(most, -hit.signed_distance);
    }
    return most;
}

/* In free flight: momenta of both together, per the momentum that each brings (and a metre). */
static void fly(rig *g, double dt, int steps, const char *what)
{
    double worst[2] = { 0 }, deepest = 0;
    int64_t touched = 0;
    rig_start(g);
    const sums start = add_up(g);
    const double first = g->bodies[0].rigid.velocity[0];
    for (int k = 0; k < steps; k++) {
        int64_t touching;
        int sweeps;
        double d[3];
        rig_step(g, dt);
        const sums s = add_up(g);
        vec3_sub(d, s.momentum, start.momentum);
        worst[0] = fmax(worst[0], vec3_length(d)/start.size);
        vec3_sub(d, s.angular, start.angular);
        worst[1] = fmax(worst[1], vec3_length(d)/start.size);
        for (int b = 0; b < 2; b++) tobi_body_update_surface(&g->bodies[b]);
        deepest = fmax(deepest, depth(&g->bodies[0], &g->bodies[1]));
        deepest = fmax(deepest, depth(&g->bodies[1], &g->bodies[0]));
        tobi_rigid_count(g->state, &touching, &sweeps);
        touched += touching > 0;
    }
    print_message("%s: %.2g of the momentum and %.2g m of the angular momentum is lost, they touch in %d "
                  "steps and overlap by up to %.2g m, speed %.3g to %.3g m/s\n", what, worst[0], worst[1],
                  (int)touched, deepest, first, g->bodies[0].rigid.velocity[0]);
    assert_true(touched > 0 && deepest < 0.01);
    assert_true(worst[0] < 1e-12 && worst[1] < 2e-5);
    assert_true(g->bodies[0].rigid.position[0] < g->bodies[1].rigid.position[0]);
}

static void test_two_swimmers(void **state)
{
    double how[2][3] = { { 4.4, 0.3, 8 }, { 5.6, -0.2, 6 } };
    rig g;
    (void)state;
    rig_open(&g, 10, NONE);
    add_swimmer(&g, how[0], (double[3]){ 4.4, 5, 5 }, 0.5);
    add_swimmer(&g, how[1], (double[3]){ 5.6, 5.05, 5.02 }, -0.5);
    fly(&g, 0.004, 500, "two swimmers");
    rig_close(&g);
}

static void test_box(void **state)
{
    double how[3] = { 4.4, 0.4, 8 };
    tobi_body_def def = rig_def();
    rig g;
    (void)state;
    rig_open(&g, 10, NONE);
    add_swimmer(&g, how, (double[3]){ 4.4, 5, 5 }, 0.5);
    def.density = 300;
    rig_box(&g, def, (double[3]){ 0.3, 0.4, 0.3 }, (double[3]){ 5.3, 5.1, 5.03 });
    fly(&g, 0.004, 500, "a box");
    rig_close(&g);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_two_swimmers), cmocka_unit_test(test_box) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
