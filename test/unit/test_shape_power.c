/* The power of bodies that change their shape: that of a shift by script is force times speed, in every
   method; a swimmer that only pulsates gives what the same motion gives when it is prescribed; skaters, and
   bodies that stand up, by closed solutions; water gains what a swimmer gives. */
#include "calls.h"
#include "geom/vec3.h"
#include "tobiuo/tobiuo.h"
#include <math.h>

static const double PI = 3.14159265358979323846;

/* 0 before the start, then from rest to a swing of 1. */
static double swing(double t) { return (1 - cos(2*PI*t/0.2))/2; }

static tobi_status shift(void *user, double t, int64_t n, const double (*rest)[3], double (*out)[3],
                         tobi_error *err)
{
    const double *far = user;
    (void)err;
    for (int64_t i = 0; i < n; i++)
        for (int a = 0; a < 3; a++) out[i][a] = rest[i][a] + far[a]*swing(t);
    return TOBI_OK;
}

/* Longer along x and thinner along the next axis, about (0.5, middle, 0.5): the volume stays. */
typedef struct stretch { double middle, most; int from_foot; } stretch;

static tobi_status pulsate(void *user, double t, int64_t n, const double (*rest)[3], double (*out)[3],
                           tobi_error *err)
{
    const stretch *s = user;
    const double grown = 1 + s->most*swing(t);
    (void)err;
    for (int64_t i = 0; i < n; i++) {
        memcpy(out[i], rest[i], sizeof out[i]);
        out[i][0] = 0.5 + (rest[i][0] - 0.5)/grown;
        out[i][1] = s->middle + (rest[i][1] - s->middle)*grown;
    }
    return TOBI_OK;
}

/* 1 m by 1 m, and in 3-D 1 m deep; water up to `level`. */
static tobi_world *open_pool(const char *method, int dimension, double spacing, double level, double fall,
                             double viscosity, int implicit)
{
    tobi_world_def d = tobi_default_world_def();
    tobi_fluid_def water = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_world *w = NULL;
    d.method = method;
    d.dimension = dimension;
    d.spacing = spacing;
    d.threads = 1;
    d.implicit_viscosity = implicit;
    d.time_step_max = level == 0 ? 1e-4 : 1e-3;
    for (int a = 0; a < 3; a++) {
        d.domain_max[a] = fill.box_max[a] = a < dimension ? 1 : 0;
        d.gravity[a] = a == 1 ? -fall : 0;
    }
    fill.box_max[1] = level;
    water.name = "water";
    water.viscosity = viscosity;
    OK(tobi_world_create(&d, NULL, &w, &err));
    if (level == 0) return w;
    OK(tobi_world_add_fluid(w, &water, &fill, 1, &err));
    return w;
}

static tobi_body_def make_body(int dimension, double middle, double height, double spacing)
{
    tobi_body_def b = tobi_default_body_def();
    b.name = "fish";
    b.density = 1000;
    b.friction = TOBI_NO_SLIP;
    b.spacing = spacing;
    for (int a = 0; a < dimension; a++) {
        const double half = a == 1 ? height/2 : 0.12;
        b.box_min[a] = (a == 1 ? middle : 0.5) - half;
        b.box_max[a] = (a == 1 ? middle : 0.5) + half;
    }
    return b;
}

typedef struct totals { double work, contact, motion, kinetic, potential, worst, most; } totals;

/* Work since the start. far: of a shift; worst: of power against force times speed; most: of these. */
static totals run(tobi_world *w, double until, const double *far)
{
    totals s = { 0 };
    tobi_body_energy e;
    tobi_body_info i;
    OK(tobi_world_start(w, &err));
    while (tobi_world_time(w) < until - 1e-12) {
        tobi_step_info info;
        const double before = tobi_world_time(w);
        OK(tobi_world_step(w, until - before, &info, &err));
        OK(tobi_world_body_energy(w, 0, &e));
        OK(tobi_world_body(w, 0, &i));
        s.work += info.dt*e.power;
        s.contact += info.dt*e.contact_power;
        s.motion += info.dt*e.motion_power;
        const double pace = (swing(before + info.dt) - swing(before))/info.dt;
        double power = 0;
        for (int a = 0; far && a < 3; a++)
            power += (i.pressure_force[a] + i.viscous_force[a])*far[a]*pace;
        s.worst = fmax(s.worst, fabs(power - e.power));
        s.most = fmax(s.most, fabs(power));
    }
    s.kinetic = e.kinetic;
    s.potential = e.potential;
    return s;
}

static void a_shift_by_script_takes_force_times_speed(void **state)
{
    (void)state;
    static const char *const methods[] = { "dfsph", "isph", "eisph", "wcsph" };
    double far[3] = { 0.04, 0.02, 0 };
    for (int n = 0; n < 9; n++) {
        const int dimension = n == 8 ? 3 : 2;
        const double spacing = dimension == 3 ? 0.05 : 0.02;
        tobi_world *w = open_pool(methods[n%4], dimension, spacing, 0.6, 9.81, 0.5, n/4%2);
        tobi_body_def b = make_body(dimension, 0.3, 0.16, spacing);
        b.motion = shift;
        b.motion_user = far;
        OK(tobi_world_add_body(w, &b, &err));
        const totals s = run(w, 0.05, far);
        print_message("%d-D, %s: power is off by %.2g of %.3g W/m\n", dimension, methods[n%4], s.worst,
                      s.most);
        assert_true(s.most > 1 && s.motion == -s.work && s.kinetic == 0);
        if (!(s.worst < 1e-6*s.most)) fail_msg("%s: off by %g of %g W", methods[n%4], s.worst, s.most);
        tobi_world_destroy(w);
    }
}

/* A block of jelly that a stamp presses and drags along. */
static void a_stamp_takes_it_from_jelly_too(void **state)
{
    (void)state;
    double far[3] = { 0.02, -0.06, 0 };
    tobi_world *w = open_pool("mlsmpm", 2, 0.02, 0, 0, 0, 0);
    tobi_solid_def jelly = tobi_default_solid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_body_def b = make_body(2, 0.3, 0.1, 0.02);
    jelly.name = "jelly";
    fill.box_min[0] = 0.3;
    fill.box_max[0] = 0.7;
    fill.box_max[1] = 0.24;
    OK(tobi_world_add_solid(w, &jelly, &fill, 1, &err));
    b.motion = shift;
    b.motion_user = far;
    OK(tobi_world_add_body(w, &b, &err));
    const totals s = run(w, 0.1, far);
    print_message("jelly: power is off by %.2g of %.3g W/m\n", s.worst, s.most);
    assert_true(s.most > 1 && s.motion == -s.work);
    if (!(s.worst < 1e-6*s.most)) fail_msg("jelly: off by %g of %g W", s.worst, s.most);
    tobi_world_destroy(w);
}

/* A disc in an open pool, at its fastest and when it is longest: the water has what it gave, and gives it
   back. The level of a pool filled around a disc rises a little at first, so height is left out. */
static void water_has_what_a_swimmer_gives(void **state)
{
    (void)state;
    stretch how = { 0.3, 0.4, 0 };
    double gave[2], moves[2];
    for (int n = 0; n < 2; n++) {
        tobi_world *w = open_pool("isph", 2, 0.0125, 0.6, 9.81, 1e-3, 0);
        tobi_body_def b = make_body(2, 0.3, 0.24, 0.0125);
        memset(b.box_max, 0, sizeof b.box_max);
        memset(b.box_min, 0, sizeof b.box_min);
        b.sphere_radius = 0.12;
        b.sphere_centre[0] = 0.5;
        b.sphere_centre[1] = 0.3;
        b.motion = pulsate;
        b.motion_user = &how;
        b.dynamics = TOBI_FREE;
        b.friction = TOBI_SLIP;
        OK(tobi_world_add_body(w, &b, &err));
        gave[n] = run(w, 0.05*(1 + n), NULL).motion;
        moves[n] = tobi_world_info(w)->kinetic_energy;
        tobi_world_destroy(w);
    }
    print_message("given %.4g and %.4g J, the water moves by %.4g and %.4g J\n", gave[0], gave[1], moves[0],
                  moves[1]);
    assert_true(moves[0] > 3 && moves[1] < 0.1*moves[0]);
    if (fabs(gave[0] - moves[0]) > 0.1*moves[0] || !(gave[1] < 0.2*gave[0]))
        fail_msg("given %g and %g J, the water moves by %g and %g J", gave[0], gave[1], moves[0], moves[1]);
}

/* By symmetry it stays. */
static void a_swimmer_that_only_pulsates_gives_what_the_motion_gives(void **state)
{
    (void)state;
    static const struct { const char *method; double apart; } cases[] =
        /* Of a free body, particles that it catches lose less of their speed; dfsph has some. */
        { { "dfsph", 0.15 }, { "isph", 0.01 }, { "wcsph", 0.03 } };
    stretch how = { 0.5, 0.3, 0 };
    for (int n = 0; n < 3; n++) {
        totals s[2];
        for (int free = 0; free < 2; free++) {
            tobi_world *w = open_pool(cases[n].method, 2, 0.025, 1, 0, 0.5, 1);
            tobi_body_def b = make_body(2, 0.5, 0.24, 0.025);
            b.motion = pulsate;
            b.motion_user = &how;
            b.dynamics = free ? TOBI_FREE : TOBI_PRESCRIBED;
            OK(tobi_world_add_body(w, &b, &err));
            s[free] = run(w, 0.1, NULL);
            tobi_world_destroy(w);
        }
        print_message("%s: prescribed %.5g J, a swimmer %.5g J\n", cases[n].method, s[0].motion, s[1].motion);
        assert_true(s[0].motion > 1);
        if (fabs(s[1].motion/s[0].motion - 1) > cases[n].apart)
            fail_msg("%s: prescribed %g J, a swimmer %g J", cases[n].method, s[0].motion, s[1].motion);
    }
}

/* Its angular momentum stays, so it has L^2/2I, and draws in its mass against that. */
static void a_skater_gives_the_energy_of_its_turn(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        tobi_world *w = open_pool("dfsph", dimension, 0.05, 0, 0, 0, 0);
        stretch how = { 0.5, 0.5, 0 };
        tobi_body_def b = make_body(dimension, 0.5, 0.4, 0.05);
        tobi_body_energy first;
        b.motion = pulsate;
        b.motion_user = &how;
        b.dynamics = TOBI_FREE;
        b.angular_velocity[2] = 4;
        OK(tobi_world_add_body(w, &b, &err));
        OK(tobi_world_start(w, &err));
        OK(tobi_world_body_energy(w, 0, &first));
        const totals s = run(w, 0.1, NULL);
        const double a = 0.24*0.24, c = 0.4*0.4, ratio = (a + c)/(a/2.25 + 2.25*c);
        assert_true(fabs(s.kinetic/first.kinetic/ratio - 1) < 1e-9 && ratio < 0.6);
        if (fabs(s.kinetic - first.kinetic - s.motion) > 1e-9*first.kinetic)
            fail_msg("%d-D: gained %g J, gave %g", dimension, s.kinetic - first.kinetic, s.motion);
        assert_true(s.work == 0 && s.contact == 0);
        tobi_world_destroy(w);
    }
}

/* It grows on the floor: the floor does no work, its own shape lifts its centre. */
static void what_stands_up_lifts_its_own_weight(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        tobi_world *w = open_pool("dfsph", dimension, 0.05, 0, 10, 0, 0);
        stretch how = { 0, 0.5, 1 };
        tobi_body_def b = make_body(dimension, 0.1, 0.2, 0.05);
        tobi_body_energy first;
        tobi_body_info i;
        b.motion = pulsate;
        b.motion_user = &how;
        b.dynamics = TOBI_FREE;
        b.friction_coefficient = 0;
        OK(tobi_world_add_body(w, &b, &err));
        OK(tobi_world_start(w, &err));
        OK(tobi_world_body_energy(w, 0, &first));
        OK(tobi_world_body(w, 0, &i));
        const totals s = run(w, 0.05, NULL);
        const double gained = s.kinetic + s.potential - first.potential, half = i.mass*10*0.025;
        print_message("%d-D: gained %.4g J, gave %.4g, the floor %.2g\n", dimension, gained, s.motion,
                      s.contact);
        assert_true(s.potential - first.potential > 0.9*half);
        assert_true(fabs(s.contact) < 0.01*gained);
        if (fabs(gained - s.contact - s.motion) > 0.01*gained)
            fail_msg("%d-D: gained %g J, gave %g", dimension, gained, s.motion);
        tobi_world_destroy(w);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_shift_by_script_takes_force_times_speed),
        cmocka_unit_test(a_stamp_takes_it_from_jelly_too),
        cmocka_unit_test(water_has_what_a_swimmer_gives),
        cmocka_unit_test(a_swimmer_that_only_pulsates_gives_what_the_motion_gives),
        cmocka_unit_test(a_skater_gives_the_energy_of_its_turn),
        cmocka_unit_test(what_stands_up_lifts_its_own_weight),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
