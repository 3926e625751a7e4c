/* What solids show: stress as the derivative of the energy, fields against formulas, the grid's nodes, and
   runs that go on from a checkpoint with the same bits. */
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
#include "solid_rig.h"
#include "mpm/fields.h"
#include "mpm/material.h"
#include "tobiuo/run.h"
#include "tobiuo/types.h"
#include "world/world.h"

/* --- energy ---------------------------------------------------------------------------------------- */

enum { WIDE = 8 };

static const mpm_material hard = { .mu = 4e4f, .lambda = 6e4f, .bulk = 1e5f, .yield = 1e9f, .hardening = 10,
                                   .compression = 0.025f, .stretch = 0.0075f, .friction = 0.8f, .keep = 1 };

/* A particle of 1 m3 of the material that is deformed by F (rows). */
static mpm_sample look_into(const mpm_material *material, const double F[9], float plastic)
{
    tobi_columns strain[WIDE] = { 0 }, affine[WIDE] = { 0 };
    const uint8_t solid[WIDE] = { 0 };
    for (int c = 0; c < 3; c++)
        strain[0].c[c] = (tobi_float4){ (float)(F[c] - (c == 0)), (float)(F[3 + c] - (c == 1)),
                                        (float)(F[6 + c] - (c == 2)), 0 };
    strain[0].c[0].w = 1;
    strain[0].c[1].w = plastic;
    const mpm_view v = { .strain = strain, .affine = affine, .solid = solid, .material = material };
    return mpm_sample_particle(&v, 0);
}

static mpm_sample look_at(int model, const double F[9], float plastic)
{
    mpm_material material = hard;
    material.model = model;
    return look_into(&material, F, plastic);
}

static void multiply(const double a[9], const double b[9], double out[9])
{
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            out[3*r + c] = a[3*r]*b[c] + a[3*r + 1]*b[3 + c] + a[3*r + 2]*b[6 + c];
}

/* d psi/dh of F -> (I + h A) F is tau : A. Strains of about `size`; central differences in float state leave
   about 1e-4. */
static void check_energy(int model, double size, double squeeze, float plastic)
{
    static const double shape[9] = { 0.8, -0.5, 0.3, 0.2, -0.6, 0.7, -0.4, 0.1, 0.5 };
    static const double turn[9] = { 0.36, 0.48, -0.8, -0.8, 0.6, 0, 0.48, 0.64, 0.6 };
    static const int tensor[9] = { 0, 3, 5, 3, 1, 4, 5, 4, 2 };
    double S[9], F[9], tau[9], norm = 0;
    for (int k = 0; k < 9; k++) S[k] = size*shape[k] + (k%4 == 0 ? 1 + squeeze : 0);
    multiply(S, turn, F);
    const mpm_sample s = look_at(model, F, plastic);
    for (int k = 0; k < 9; k++) norm += pow(tau[k] = s.stress[tensor[k]]*s.ratio, 2);
    norm = sqrt(norm);
    assert_true(s.energy > 0 && norm > 0);
    for (int k = 0; k < 9; k++) {
        const double h = 0.02*size;
        double up[9] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 }, down[9] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 }, G[9];
        up[k] += h;
        down[k] -= h;
        multiply(up, F, G);
        double change = look_at(model, G, plastic).energy;
        multiply(down, F, G);
        change = (change - look_at(model, G, plastic).energy)/(2*h);
        if (fabs(change - tau[k]) > 2e-3*norm)
            fail_msg("model %d, component %d: energy says %g, stress %g, norm %g", model, k, change, tau[k],
                     norm);
    }
}

static void stress_is_the_derivative_of_energy(void **state)
{
    (void)state;
    check_energy(TOBI_NEO_HOOKEAN, 0.1, 0, 0);
    check_energy(TOBI_COROTATED, 0.1, 0, 0);
    check_energy(TOBI_VON_MISES, 0.1, 0, 0);
    check_energy(TOBI_LIQUID, 0.1, -0.05, 0);
    check_energy(TOBI_SNOW, 0.004, -0.008, 0);
    check_energy(TOBI_SNOW, 0.004, -0.008, -0.03f);          /* hardened by compaction */
    check_energy(TOBI_SAND, 0.01, -0.1, 0);
}

static void models_flow_as_they_should(void **state)
{
    (void)state;
    const double apart[9] = { 1.1, 0, 0, 0, 1.1, 0, 0, 0, 1.1 }, bent[9] = { 1, 0.3, 0, 0, 1, 0, 0, 0, 1 };
    mpm_sample s = look_at(TOBI_SAND, apart, 0);             /* loose sand carries nothing, and remembers */
    assert_true(fabs(s.stress[0]) < 1 && s.energy < 1e-3 && fabs(s.ratio - 1.331) < 1e-4);
    assert_true(fabs(s.plastic - 3*log(1.1)) < 1e-4);
    s = look_at(TOBI_STATIONARY, bent, 0);
    assert_true(s.stress[3] == 0 && s.energy == 0);
    s = look_at(TOBI_SNOW, apart, 0);                        /* torn: stretches at their limit */
    assert_true(fabs(s.strain[0] - 0.0075) < 1e-5 && fabs(s.ratio - 1.331) < 1e-4);
    s = look_at(TOBI_LIQUID, bent, 0);                       /* sheared water resists nothing */
    assert_true(fabs(s.stress[3]) < 1e-3 && fabs(s.ratio - 1) < 1e-6);
}

/* Pressed and sheared in the plane without change of volume: shear over pressure is tan phi, so that the
   principal stresses have (s1 - s3)/(s1 + s3) = tan phi, and the one across the plane is their mean. */
static void sheared_sand_flows_at_its_angle(void **state)
{
    (void)state;
    for (double angle = 20; angle <= 40; angle += 10) {
        const double slope = tan(angle*acos(-1)/180), F[9] = { 0.999, 0.02, 0, 0, 0.999, 0, 0, 0, 0.999 };
        tobi_solid_def d = tobi_default_solid_def();
        double sound;
        d.model = TOBI_SAND;
        d.friction_angle = angle;
        const mpm_material sand = mpm_material_describe(&d, &sound);
        const mpm_sample seen = look_into(&sand, F, 0);
        const double *s = seen.stress;
        const double pressure = -0.5*(s[0] + s[1]), radius = hypot(0.5*(s[0] - s[1]), s[3]);
        if (!(pressure > 0 && fabs(radius/pressure - slope) < 2e-3*slope &&
              fabs(s[3]/pressure - slope) < 2e-2*slope && fabs(-s[2]/pressure - 1) < 1e-2))
            fail_msg("%g degrees: %g and %g for %g; across %g", angle, radius/pressure, s[3]/pressure, slope,
                     -s[2]/pressure);
    }
}

/* --- fields ---------------------------------------------------------------------------------------- */

/* A ball of each model in a box, falling and turning. */
static tobi_world *make_world(int dimension, int transfer, int threads)
{
    tobi_world *world;
    tobi_world_def w = tobi_default_world_def();
    tobi_mlsmpm_def m = tobi_default_mlsmpm_def();
    m.transfer = transfer;
    w.method = "mlsmpm";
    w.dimension = dimension;
    w.spacing = 0.05;
    w.threads = threads;
    w.friction = 0.3;
    for (int a = 0; a < dimension; a++) {
        w.domain_min[a] = a == 0 ? -3 : -0.5;
        w.domain_max[a] = a == 0 ? 1 : 0.5;
        w.wall_min[a] = w.wall_max[a] = TOBI_WALL_SEPARATE;
    }
    if (dimension == 2) {
        w.gravity[1] = -9.81;
        w.gravity[2] = 0;
    }
    OK(tobi_world_create(&w, &m, &world, &err));
    for (int model = TOBI_NEO_HOOKEAN; model <= TOBI_SAND; model++) {
        tobi_solid_def solid = tobi_default_solid_def();
        tobi_fill_def fill = tobi_default_fill_def();
        solid.name = (const char *[]){ "a", "b", "c", "d", "e", "f", "g", "h" }[model];
        solid.model = model;
        solid.density = 1000 + 100*model;
        solid.youngs_modulus = 1e5;
        solid.yield_stress = 2000;
        solid.viscosity = 0.1;
        fill.centre[0] = -2.6 + 0.6*model;
        fill.radius = 0.25;
        fill.velocity[dimension - 1] = -1;
        fill.spin[2] = 3;
        OK(tobi_world_add_solid(world, &solid, &fill, 1, &err));
    }
    return world;
}

static double determinant(const double F[9])
{
    return F[0]*(F[4]*F[8] - F[5]*F[7]) - F[1]*(F[3]*F[8] - F[5]*F[6]) + F[2]*(F[3]*F[7] - F[4]*F[6]);
}

/* Cauchy stress of a neo-Hookean particle, in double, from F alone. */
static void neo_hookean(const double F[9], double out[6])
{
    const double mu = 1e5/2.6, lambda = 1e5*0.3/(1.3*0.4), J = determinant(F);
    static const int row[6] = { 0, 1, 2, 0, 1, 2 }, column[6] = { 0, 1, 2, 1, 2, 0 };
    for (int k = 0; k < 6; k++) {
        const double *a = F + 3*row[k], *b = F + 3*column[k];
        double one = row[k] == column[k];
        out[k] = (mu*(a[0]*b[0] + a[1]*b[1] + a[2]*b[2] - one) + lambda*log(J)*one)/J;
    }
}

static void check_fields(int dimension)
{
    tobi_world *world = make_world(dimension, TOBI_APIC, 2);
    assert_int_equal(tobi_world_start(world, NULL), TOBI_OK);
    double *first = solid_read(world, "position", 3);
    solid_step(world, 150);
    int64_t n = tobi_world_count(world, TOBI_FLUID);
    double *F = solid_read(world, "deformation_gradient", 9), *J = solid_read(world, "J", 1);
    double *rho = solid_read(world, "density", 1);
    double *s = solid_read(world, "stress", 6), *p = solid_read(world, "pressure", 1);
    double *mises = solid_read(world, "von_mises", 1);
    double *rest = solid_read(world, "rest_position", 3), *material = solid_read(world, "material", 1);
    double *plastic = solid_read(world, "plastic", 1), largest = 0, most_plastic = 0;
    for (int64_t i = 0; i < n; i++) {
        const double *t = s + 6*i;
        double trace = t[0] + t[1] + t[2], m2 = 0, scale = 1;
        for (int k = 0; k < 6; k++) scale = fmax(scale, fabs(t[k]));
        for (int k = 0; k < 3; k++) m2 += 1.5*pow(t[k] - trace/3, 2) + 3*t[3 + k]*t[3 + k];
        assert_true(fabs(p[i] + trace/3) < 1e-9*scale && fabs(mises[i] - sqrt(m2)) < 1e-9*scale);
        assert_true(fabs(rho[i]*J[i] - (1000 + 100*material[i])) < 1e-9*rho[i]);
        for (int a = 0; a < dimension; a++) assert_true(fabs(rest[3*i + a] - first[3*i + a]) < 1e-6);
        if (material[i] == TOBI_VON_MISES) {
            most_plastic = fmax(most_plastic, plastic[i]);
            assert_true(mises[i]*J[i] < 2000*1.001);
        }
        if (material[i] != TOBI_NEO_HOOKEAN) continue;
        double expected[6];
        neo_hookean(F + 9*i, expected);
        assert_true(fabs(J[i] - determinant(F + 9*i)) < 1e-6);
        for (int k = 0; k < 6; k++) {
            assert_true(fabs(t[k] - expected[k]) < 0.1 + 1e-5*scale);
            largest = fmax(largest, fabs(t[k]));
        }
    }
    assert_true(largest > 1000 && most_plastic > 0.001);     /* they did hit the floor */
    double *all[] = { first, F, J, rho, s, p, mises, rest, material, plastic };
    for (size_t k = 0; k < sizeof all/sizeof *all; k++) free(all[k]);
    tobi_world_destroy(world);
}

static void fields_agree_with_formulas(void **state)
{
    (void)state;
    check_fields(3);
    check_fields(2);
}

/* The method puts a step's gradient into F in the next step; what is read has it already. */
static void strain_is_that_of_now(void **state)
{
    (void)state;
    tobi_step_info info;
    solid_setup s = solid_default(3, 0.05, 1);
    s.world.gravity[2] = 0;
    for (int a = 0; a < 3; a++) {
        s.fill.box_min[a] = 0.1;
        s.fill.box_max[a] = 0.9;
    }
    s.solid.youngs_modulus = 1e-3;
    tobi_world *world = solid_world(&s);
    OK(tobi_world_start(world, &err));
    int64_t n = tobi_world_count(world, TOBI_FLUID);
    double *x = solid_read(world, "position", 3), *v = malloc((size_t)n*3*sizeof *v);
    for (int64_t i = 0; i < n; i++) {
        v[3*i] = 0.5*(x[3*i] - 0.5);
        v[3*i + 1] = 0.2*(x[3*i] - 0.5);
        v[3*i + 2] = -0.3*(x[3*i + 2] - 0.5);
    }
    assert_int_equal(tobi_world_write(world, "velocity", v, n, NULL), TOBI_OK);
    assert_int_equal(tobi_world_step(world, 0, &info, NULL), TOBI_OK);
    double *F = solid_read(world, "deformation_gradient", 9);
    int inner = 0;
    for (int64_t i = 0; i < n; i++) {
        const double *p = x + 3*i, dt = info.dt;
        /* Three cells inside, where nothing knows of the surface. */
        if (fabs(p[0] - 0.5) > 0.1 || fabs(p[1] - 0.5) > 0.1 || fabs(p[2] - 0.5) > 0.1) continue;
        const double expected[9] = { 1 + 0.5*dt, 0, 0, 0.2*dt, 1, 0, 0, 0, 1 - 0.3*dt };
        for (int k = 0; k < 9; k++)
            if (fabs(F[9*i + k] - expected[k]) > 1e-4*dt)
                fail_msg("component %d is %.9g, not %.9g, at dt %g", k, F[9*i + k], expected[k], dt);
        inner++;
    }
    assert_true(inner == 64 && info.dt > 1e-3);
    free(x);
    free(v);
    free(F);
    tobi_world_destroy(world);
}

static void reading_changes_nothing(void **state)
{
    (void)state;
    tobi_world *quiet = make_world(3, TOBI_APIC, 1), *watched = make_world(3, TOBI_APIC, 1);
    const tobi_grid *grid;
    tobi_error err = { 0 };
    for (int k = 0; k < 12; k++) {
        solid_step(quiet, 10);
        solid_step(watched, 10);
        free(solid_read(watched, "stress", 6));
        assert_true(tobi_world_info(watched)->elastic_energy >= 0);
        assert_int_equal(tobi_world_grid(watched, &grid, &err), TOBI_OK);
    }
    assert_true(tobi_world_hash(quiet) == tobi_world_hash(watched));
    tobi_world_destroy(quiet);
    tobi_world_destroy(watched);
}

static void nodes_have_the_particles_momentum(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        tobi_world *world = make_world(dimension, TOBI_APIC, 1);
        const tobi_grid *g;
        tobi_error err = { 0 };
        for (int steps = 0; steps <= 60; steps += 60) {
            solid_step(world, steps);
            assert_int_equal(tobi_world_grid(world, &g, &err), TOBI_OK);
            const tobi_step_info *info = tobi_world_info(world);
            double mass = 0, sum[3] = { 0 }, expected = info->weight/9.81;
            for (int64_t k = 0; k < g->count; k++) {
                mass += g->mass[k];
                for (int a = 0; a < 3; a++) sum[a] += g->mass[k]*g->velocity[k][a];
                for (int a = 0; a < dimension; a++) {        /* on the grid from the domain's corner */
                    double cell = (g->position[k][a] - (a == 0 ? -3 : -0.5))/0.1;
                    assert_true(fabs(cell - round(cell)) < 1e-9);
                }
            }
            assert_true(g->count > 100 && fabs(mass - expected) < 1e-5*expected);
            for (int a = 0; a < 3; a++) assert_true(fabs(sum[a] - info->momentum[a]) < 1e-5*expected);
        }
        tobi_world_destroy(world);
    }
}

/* As many particles as on the lattice, all apart, no two in a row. */
static void blue_noise_is_even(void **state)
{
    (void)state;
    tobi_world *world[2];
    solid_setup s = solid_default(3, 0.1, 1);
    s.solid.seeding = TOBI_SEED_BLUE_NOISE;
    for (int k = 0; k < 2; k++) {
        world[k] = solid_world(&s);
        OK(tobi_world_start(world[k], &err));
    }
    assert_true(tobi_world_hash(world[0]) == tobi_world_hash(world[1]));
    assert_int_equal(tobi_world_count(world[0], TOBI_FLUID), 1000);
    assert_true(fabs(tobi_world_info(world[0])->weight - 9810) < 0.01);
    double *x = solid_read(world[0], "position", 3), mean = 0, least = 1;
    int rows = 0;
    for (int i = 0; i < 1000; i++) {
        double nearest = 1;
        const double *p = x + 3*i;
        for (int j = 0; j < 1000; j++) {
            const double *q = x + 3*j;
            if (i == j) continue;
            nearest = fmin(nearest, sqrt(pow(p[0] - q[0], 2) + pow(p[1] - q[1], 2) + pow(p[2] - q[2], 2)));
            rows += fabs(p[0] - q[0]) < 1e-9 && fabs(p[1] - q[1]) < 1e-9;
        }
        mean += nearest/1000;
        least = fmin(least, nearest);
    }
    /* Seen: 0.95 spacings on average, 0.75 at least; one random point per cell has 0.67 and 0.12. */
    assert_true(rows == 0 && mean > 0.09 && least > 0.065);
    free(x);
    tobi_world_destroy(world[0]);
    tobi_world_destroy(world[1]);
}

/* --- the same bits --------------------------------------------------------------------------------- */

static void check_bits(int dimension, int transfer)
{
    tobi_world *one = make_world(dimension, transfer, 1), *four = make_world(dimension, transfer, 4);
    tobi_world *later = make_world(dimension, transfer, 2);
    solid_check_bits(one, four, later);
    const tobi_step_info *a = tobi_world_info(one), *b = tobi_world_info(later);
    assert_true(a->elastic_energy == b->elastic_energy && a->energy_lost == b->energy_lost);
    tobi_world_destroy(one);
    tobi_world_destroy(four);
    tobi_world_destroy(later);
}

static void runs_go_on_with_the_same_bits(void **state)
{
    (void)state;
    check_bits(3, TOBI_APIC);
    check_bits(3, TOBI_FLIP);
    check_bits(2, TOBI_APIC);
    check_bits(2, TOBI_XPIC);
}

/* --- what is refused ------------------------------------------------------------------------------- */

static void calls_are_refused_in_words(void **state)
{
    (void)state;
    tobi_world_def def = tobi_default_world_def();
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_output_def output = tobi_default_output_def();
    tobi_world *world = make_world(3, TOBI_APIC, 1), *water;
    const tobi_grid *grid;
    tobi_run *run;
    double number[1];
    for (int a = 0; a < 3; a++) def.domain_max[a] = fill.box_max[a] = 1;
    def.spacing = 0.2;
    assert_int_equal(tobi_world_create(&def, NULL, &water, NULL), TOBI_OK);
    REFUSED(tobi_world_add_fluid(world, &fluid, &fill, 1, &err), TOBI_UNSUPPORTED,
            "mlsmpm takes solids, not fluids; a solid of model liquid is one");
    REFUSED(tobi_world_grid(water, &grid, &err), TOBI_UNSUPPORTED, "dfsph has no grid");
    REFUSED(tobi_world_read(water, TOBI_FLUID, "von_mises", number, 1, &err), TOBI_NOT_FOUND,
            "dfsph has no field 'von_mises'");
    REFUSED(tobi_world_read(world, TOBI_FLUID, "vorticity", number, 1, &err), TOBI_NOT_FOUND,
            "mlsmpm has no field 'vorticity'");
    REFUSED(tobi_world_read(world, TOBI_BODIES, "stress", number, 1, &err), TOBI_NOT_FOUND,
            "bodies have no field 'stress'");
    output.grid = 1;
    REFUSED(tobi_run_create(water, &output, "no_run", 0, NULL, &run, &err), TOBI_INVALID,
            "output.grid: dfsph has no grid");
    output = tobi_default_output_def();
    output.tractions = 1;
    REFUSED(tobi_run_create(world, &output, "no_run", 0, NULL, &run, &err), TOBI_INVALID,
            "output.tractions: mlsmpm has no fluid that presses on bodies");
    solid_step(world, 1);
    REFUSED(tobi_world_add_solid(world, &solid, &fill, 1, &err), TOBI_INVALID,
            "a started world takes no more solids");
    tobi_world_destroy(world);
    tobi_world_destroy(water);
}

static void many_solids_and_odd_domains(void **state)
{
    (void)state;
    solid_setup s = solid_default(3, 0.2, 1);
    tobi_world *world = solid_world(&s);
    char name[16];
    s.solid.name = name;
    for (int k = 1; k < TOBI_SOLID_LIMIT; k++) {
        snprintf(name, sizeof name, "%d", k);
        OK(tobi_world_add_solid(world, &s.solid, &s.fill, 0, &err));
    }
    s.solid.name = "last";
    REFUSED(tobi_world_add_solid(world, &s.solid, &s.fill, 0, &err), TOBI_UNSUPPORTED,
            "more than 255 solids");
    tobi_world_destroy(world);
    s.world.wall_min[1] = s.world.wall_max[1] = TOBI_WALL_PERIODIC;
    REFUSED(tobi_world_create(&s.world, &s.method, &world, &err), TOBI_UNSUPPORTED,
            "domain.walls.y: is periodic, which mlsmpm does not know");
    s.world.wall_min[1] = s.world.wall_max[1] = TOBI_WALL_SLIP;
    s.world.domain_max[0] = 1e7;
    s.world.spacing = 0.04;
    world = solid_world(&s);
    REFUSED(tobi_world_start(world, &err), TOBI_UNSUPPORTED, "cells along x, allowed are 1e8");
    tobi_world_destroy(world);
}

/* Two small balls in opposite corners of a domain of this size, 4 particles across each. */
static tobi_world *make_pair(double size, double spacing)
{
    tobi_world_def def = tobi_default_world_def();
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_fill_def fill[2] = { tobi_default_fill_def(), tobi_default_fill_def() };
    tobi_world *world;
    def.method = "mlsmpm";
    def.spacing = spacing;
    for (int a = 0; a < 3; a++) {
        def.domain_max[a] = size;
        fill[0].centre[a] = 4*spacing;
        fill[1].centre[a] = size - 4*spacing;
    }
    fill[0].radius = fill[1].radius = 2*spacing;
    assert_int_equal(tobi_world_create(&def, NULL, &world, NULL), TOBI_OK);
    assert_int_equal(tobi_world_add_solid(world, &solid, fill, 2, NULL), TOBI_OK);
    return world;
}

static void material_lies_too_far_apart(void **state)
{
    (void)state;
    const tobi_grid *grid;
    tobi_world *world = make_pair(400, 0.05);
    REFUSED(tobi_world_step(world, 0, NULL, &err), TOBI_UNSUPPORTED, "the solids reach over");
    tobi_world_destroy(world);
    world = make_pair(300, 5e-5);
    REFUSED(tobi_world_grid(world, &grid, &err), TOBI_UNSUPPORTED, "the material reaches over");
    tobi_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stress_is_the_derivative_of_energy),
        cmocka_unit_test(models_flow_as_they_should),
        cmocka_unit_test(sheared_sand_flows_at_its_angle),
        cmocka_unit_test(fields_agree_with_formulas),
        cmocka_unit_test(strain_is_that_of_now),
        cmocka_unit_test(reading_changes_nothing),
        cmocka_unit_test(nodes_have_the_particles_momentum),
        cmocka_unit_test(blue_noise_is_even),
        cmocka_unit_test(runs_go_on_with_the_same_bits),
        cmocka_unit_test(calls_are_refused_in_words),
        cmocka_unit_test(many_solids_and_odd_domains),
        cmocka_unit_test(material_lies_too_far_apart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
