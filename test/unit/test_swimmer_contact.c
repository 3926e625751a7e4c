/* Bodies that change their shape against bodies (decision 0104): nothing passes through, what one gains the
   other loses. Overlaps that are taken out cost a little angular momentum. A flap pushes a ball, with the
   same bits by any threads and after a restart; an eel on the floor comes to rest. */
#include "rigid_rig.h"
#include "run_to.h"
#include <unistd.h>

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

/* A plate that stands on the floor, its foot at z = 0, and bends once along x and back. */
static tobi_status bend(void *user, double t, int64_t n, const double (*rest)[3], double (*out)[3],
                        tobi_error *err)
{
    (void)user, (void)err;
    for (int64_t i = 0; i < n; i++) {
        memcpy(out[i], rest[i], sizeof out[i]);
        out[i][0] += rest[i][2]*rest[i][2]*(t < 0.8 ? 1 - cos(2*acos(-1)*t/0.8) : 0);
    }
    return TOBI_OK;
}

static const double RADIUS = 0.15;

static tobi_world *make_flap(int threads)
{
    tobi_world_def def = tobi_default_world_def();
    tobi_body_def flap = tobi_default_body_def(), ball = tobi_default_body_def();
    const double size[3] = { 2, 1, 1 }, lower[3] = { 0.35, 0.3, 0 }, upper[3] = { 0.4, 0.7, 0.5 },
                 at[3] = { 0.56, 0.52, RADIUS };
    tobi_world *w;
    def.method = "mlsmpm";
    def.spacing = 0.05;
    def.threads = threads;
    flap.name = "flap";
    flap.motion = bend;
    ball.name = "ball";
    ball.mesh = TOBI_SOURCE_DIR "/test/meshes/sphere.obj";
    ball.dynamics = TOBI_FREE;
    ball.density = 300;
    for (int a = 0; a < 3; a++) {
        def.domain_max[a] = size[a];
        flap.box_min[a] = lower[a];
        flap.box_max[a] = upper[a];
        ball.scale[a] = 2*RADIUS;
        ball.translation[a] = at[a];
    }
    OK(tobi_world_create(&def, NULL, &w, &err));
    OK(tobi_world_add_body(w, &flap, &err));
    OK(tobi_world_add_body(w, &ball, &err));
    return w;
}

/* m/s, along x, of the mesh of a body where it was hit. */
static double surface_speed(const tobi_body *b, const tobi_bvh_hit *hit)
{
    const int32_t *v = b->mesh.triangles[hit->triangle];
    double sum = 0;
    for (int k = 0; k < 3; k++) sum += hit->barycentric[k]*b->vertex_velocity[v[k]][0];
    return sum;
}

/* The ball's middle stays its radius away from the flap, and goes on when the flap is back. */
static void test_flap(void **state)
{
    tobi_world *w = make_flap(1);
    const tobi_body *flap = &w->sim.bodies[0], *ball = &w->sim.bodies[1];
    double deepest = 0, fastest = 0;
    int64_t touched = 0;
    (void)state;
    for (int k = 1; k <= 240; k++) {
        tobi_bvh_hit hit;
        run_to(w, 0.005*k);
        assert_true(tobi_bvh_closest(flap->bvh, ball->rigid.position, INFINITY, &hit));
        assert_true(hit.signed_distance > 0);
        deepest = fmax(deepest, RADIUS - hit.signed_distance);
        if (ball->info.contact_force[0] <= 0 || hit.signed_distance > 1.02*RADIUS) continue;
        touched++;
        fastest = fmax(fastest, surface_speed(flap, &hit));
    }
    print_message("a flap touches the ball at %d times of 240, up to %.2g m deep, where it has up to %.3g "
                  "m/s; the ball goes on at %.3g m/s, at %.3g m\n", (int)touched, deepest, fastest,
                  ball->rigid.velocity[0], ball->rigid.position[0]);
    assert_true(touched > 20 && deepest < 0.01*RADIUS && ball->rigid.position[0] > 0.8);
    assert_true(fabs(ball->rigid.velocity[0]/fastest - 1) < 0.02);
    tobi_world_destroy(w);
}

static void test_bits(void **state)
{
    static const int threads[] = { 1, 2, 4, 1 };
    uint64_t whole = 0;
    (void)state;
    for (int k = 0; k < 4; k++) {
        tobi_world *w = make_flap(threads[k]);
        if (k < 3) run_to(w, 0.15);
        if (k == 0) OK(tobi_world_save(w, "flap.h5", &err));
        if (k == 3) OK(tobi_world_load(w, "flap.h5", &err));
        assert_true(k > 0 || w->sim.bodies[1].rigid.velocity[0] > 0.1);      /* they touch */
        const uint64_t hash = run_to(w, 0.5);
        if (k == 0) whole = hash;
        if (hash != whole) fail_msg("%d threads%s: other bits", threads[k], k == 3 ? ", a restart" : "");
        tobi_world_destroy(w);
    }
    remove("flap.h5");
}

/* A wave of 0.03 m, 0.5 m long, 2 a second, across the floor; between 0 and 2 s. */
static const double HIGH = 0.03, WAVE = 0.5, OFTEN = 2, STOPS = 2;

static tobi_status wriggle(void *user, double t, int64_t n, const double (*rest)[3], double (*out)[3],
                           tobi_error *err)
{
    const double turn = 2*acos(-1), part = fmin(fmax(fmin(t, STOPS - t)/0.5, 0), 1),
                 grown = part*part*(3 - 2*part);
    (void)user, (void)err;
    for (int64_t i = 0; i < n; i++) {
        memcpy(out[i], rest[i], sizeof out[i]);
        out[i][2] += HIGH*grown*sin(turn*(rest[i][0]/WAVE - OFTEN*t));
    }
    return TOBI_OK;
}

/* The shape has at most the speed of the wave: what the floor gives the rigid part has so, too. */
static void test_eel(void **state)
{
    const double gravity[3] = { 0, 0, -9.81 }, thick = 0.08, shape = HIGH*2*acos(-1)*OFTEN;
    tobi_body_def def = rig_def();
    double lowest = 0, most = 0, highest = 0, after = 0;
    rig g;
    (void)state;
    rig_open(&g, 4, gravity);
    def.spacing = 0.02;
    def.motion = wriggle;
    const tobi_body *eel = rig_box(&g, def, (double[3]){ 1, 0.15, thick }, (double[3]){ 2, 2, 0.5*thick });
    rig_start(&g);
    const double mass = eel->rigid.mass;
    while (g.time < 3) {
        rig_advance(&g, 0.01);
        double bottom = INFINITY;
        for (int64_t i = 0; i < eel->mesh.vertex_count; i++) bottom = fmin(bottom, eel->vertex[i][2]);
        lowest = fmin(lowest, bottom);
        highest = fmax(highest, bottom);
        most = fmax(most, rig_energy(&g));
        if (g.time > STOPS + 0.5) after = fmax(after, rig_energy(&g));
    }
    print_message("an eel on the floor sinks by up to %.2g of its thickness, rises by up to %.3g m, has "
                  "up to %.3g of the energy at its wave's speed, and %.2g after; it went %.2g m\n",
                  -lowest/thick, highest, most/(0.5*mass*shape*shape), after/(0.5*mass*shape*shape),
                  eel->rigid.position[0] - 2);
    assert_true(-lowest < 0.01*thick && highest < 0.02*thick);
    assert_true(most > 0 && most < 0.5*mass*shape*shape && after < 1e-12*most);
    rig_close(&g);
}

int main(void)
{
    char folder[] = "/tmp/tobiuo_contact_XXXXXX";
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_two_swimmers), cmocka_unit_test(test_box), cmocka_unit_test(test_flap),
        cmocka_unit_test(test_bits), cmocka_unit_test(test_eel),
    };
    if (!mkdtemp(folder) || chdir(folder) != 0) return 1;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    if (chdir("/") == 0) rmdir(folder);
    return failed;
}
