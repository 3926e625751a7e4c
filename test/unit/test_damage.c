/* Solids that break: what one particle costs, what it does when broken, the same bits, bad input. */
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
#include "mpm/damage.h"
#include "mpm/fields.h"
#include "tobiuo/types.h"
#include "world/world.h"

enum { WIDE = 8, PULLS = 4000 };

/* One particle of 1 m3. */
typedef struct rig {
    tobi_columns strain[WIDE], affine[WIDE];
    mpm_material material;
    uint8_t solid[WIDE];
    mpm_view view;
} rig;

static void make(rig *r, int model, double strength, double last)
{
    memset(r, 0, sizeof *r);
    r->material = (mpm_material){ .model = model, .mu = 4e4f, .lambda = 6e4f, .friction = 0.8f, .keep = 1,
                                  .strength = (float)strength, .brittleness = (float)(1/last) };
    r->strain[0].c[0].w = 1;
    r->view = (mpm_view){ .strain = r->strain, .affine = r->affine, .solid = r->solid,
                          .material = &r->material };
}

/* Nominal stress at F = diag(1 + e, 1, 1); damage is kept. */
static double stretch(rig *r, double e)
{
    r->strain[0].c[0].x = (float)e;
    mpm_sample s = mpm_sample_particle(&r->view, 0);
    assert_true(s.damage >= r->strain[0].c[1].w && s.plastic == 0);
    r->strain[0].c[1].w = (float)s.damage;
    return s.stress[0]*s.ratio/(1 + e);
}

/* Work of stretching from 0 to e, J; the largest stress in *peak, the last in *at_end. */
static double pull(rig *r, double e, double *peak, double *at_end)
{
    double work = 0;
    *peak = *at_end = 0;
    for (int k = 1; k <= PULLS; k++) {
        double nominal = stretch(r, e*k/PULLS);
        work += 0.5*(nominal + *at_end)*e/PULLS;
        *at_end = nominal;
        *peak = fmax(*peak, nominal);
    }
    return work;
}

/* The work to break is half the strength times the last strain, eq. (19), whatever the shape of the elastic
   curve; what a stiffness that changes adds is below strength^2/E. */
static void breaking_costs_the_fracture_energy(void **state)
{
    (void)state;
    const double modulus = 2*4e4 + 6e4, strength = 0.01*modulus;
    for (int model = TOBI_NEO_HOOKEAN; model <= TOBI_COROTATED; model++)
        for (double last = 0.03; last < 3; last *= 2) {
            rig r;
            double peak, at_end;
            make(&r, model, strength, last);
            const double work = pull(&r, 2*last, &peak, &at_end), spent = mpm_damage_spent(&r.view, 0);
            assert_true(r.strain[0].c[1].w == 1 && at_end == 0);
            assert_true(mpm_sample_particle(&r.view, 0).energy == 0);
            assert_true(fabs(work - 0.5*strength*last) < 0.004*strength*last + 0.2*strength*strength/modulus);
            assert_true(fabs(spent - 0.5*strength*last) < 1e-5*strength*last);
            assert_true(peak < 1.0001*strength && peak > 0.96*strength);
        }
}

/* Half broken: what it stored and what it spent make up the work, and unloading goes straight back. */
static void work_is_stored_or_spent(void **state)
{
    (void)state;
    for (double e = 0.02; e < 0.18; e += 0.03) {
        rig r;
        double peak, at_end;
        make(&r, TOBI_COROTATED, 1400, 0.2);
        const double work = pull(&r, e, &peak, &at_end), damage = r.strain[0].c[1].w;
        const double sum = mpm_sample_particle(&r.view, 0).energy + mpm_damage_spent(&r.view, 0);
        assert_true(fabs(work - sum) < 0.005*work && damage > 0 && damage < 1);
        assert_true(fabs(stretch(&r, e/2) - at_end/2) < 1e-4*at_end && r.strain[0].c[1].w == (float)damage);
    }
}

static mpm_sample look_at(double strength, const double F[9])
{
    rig r;
    make(&r, TOBI_NEO_HOOKEAN, strength, 1);
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < 3; k++) (&r.strain[0].c[c].x)[k] = (float)(F[3*k + c] - (k == c));
    r.strain[0].c[1].w = strength > 0;
    return mpm_sample_particle(&r.view, 0);
}

/* A closed crack presses as before, an open one carries nothing and keeps its volume, rubble that is sheared
   has only the friction that its pressure allows. */
static void cracks_press_but_do_not_pull(void **state)
{
    (void)state;
    const double shut[9] = { 0.95, 0, 0, 0, 0.95, 0, 0, 0, 0.95 }, open[9] = { 1.8, 0, 0, 0, 1, 0, 0, 0, 1 };
    const double far[9] = { 40, 0, 0, 0, 1, 0, 0, 0, 1 }, sheared[9] = { 1.01, 2, 0, 0, 1, 0, 0, 0, 1 };
    const double rubbed[9] = { 0.98, 0.5, 0, 0, 1, 0, 0, 0, 1 };
    mpm_sample whole = look_at(0, shut), broken = look_at(1e3, shut);
    assert_true(whole.damage == 0 && broken.damage == 1);
    for (int k = 0; k < 6; k++)
        assert_true(fabs(whole.stress[k] - broken.stress[k]) < 1e-4*fabs(whole.stress[0]));
    assert_true(whole.stress[0] < 0 && fabs(whole.energy - broken.energy) < 1e-4*whole.energy);
    broken = look_at(1e3, open);
    for (int k = 0; k < 6; k++) assert_true(broken.stress[k] == 0);
    assert_true(broken.energy == 0 && fabs(broken.ratio - 1.8) < 1e-5);
    broken = look_at(1e3, far);
    assert_true(fabs(broken.ratio - exp(2)) < 1e-3);
    broken = look_at(1e3, sheared);
    assert_true(broken.stress[3] == 0 && fabs(broken.ratio - 1.01) < 1e-5);
    broken = look_at(1e3, rubbed);
    double p = -(broken.stress[0] + broken.stress[1] + broken.stress[2])/3, square = 0;
    for (int k = 0; k < 3; k++)
        square += pow(broken.stress[k] + p, 2) + 2*pow(broken.stress[3 + k], 2);
    /* |s| = 3 alpha p in Hencky's law, of which the neo-Hookean one differs by the order of the strain. */
    assert_true(p > 1000 && fabs(sqrt(square)/(3*0.8*p) - 1) < 0.05);
}

/* --- the same bits --------------------------------------------------------------------------------- */

/* A block that flies apart, beside one of the same kind that does not. */
static tobi_world *make_world(int dimension, int model, int threads)
{
    tobi_world *world;
    tobi_world_def w = tobi_default_world_def();
    tobi_solid_def solid = tobi_default_solid_def();
    w.method = "mlsmpm";
    w.dimension = dimension;
    w.spacing = 0.05;
    w.threads = threads;
    w.gravity[2] = 0;
    for (int a = 0; a < dimension; a++) w.domain_max[a] = a ? 1 : 3;
    OK(tobi_world_create(&w, NULL, &world, &err));
    solid.model = model;
    for (int breaks = 0; breaks < 2; breaks++) {
        tobi_fill_def fill[2] = { tobi_default_fill_def(), tobi_default_fill_def() };
        solid.name = breaks ? "brittle" : "whole";
        solid.strength = breaks ? 2e4 : 0;
        solid.fracture_energy = breaks ? 200 : 0;
        for (int side = 0; side < 2; side++) {
            for (int a = 1; a < dimension; a++) {
                fill[side].box_min[a] = breaks ? 0.6 : 0.1;
                fill[side].box_max[a] = breaks ? 0.9 : 0.4;
            }
            fill[side].box_min[0] = 1 + 0.5*side;
            fill[side].box_max[0] = 1.5 + 0.5*side;
            fill[side].velocity[0] = side ? 2 : -2;
        }
        OK(tobi_world_add_solid(world, &solid, fill, 2, &err));
    }
    return world;
}

static void check_bits(int dimension, int model)
{
    tobi_world *one = make_world(dimension, model, 1), *four = make_world(dimension, model, 4);
    tobi_world *later = make_world(dimension, model, 2);
    solid_check_bits(one, four, later);
    const int64_t n = tobi_world_count(one, TOBI_FLUID);
    double *damage = solid_read(one, "damage", 1), *solid = solid_read(one, "material", 1);
    int broken = 0, hurt = 0;
    for (int64_t i = 0; i < n; i++) {
        assert_true(damage[i] >= 0 && damage[i] <= solid[i]);        /* solid 0 knows no damage */
        broken += damage[i] == 1;
        hurt += damage[i] > 0 && damage[i] < 1;
    }
    assert_true(broken > 10 && hurt > 0 && broken < n/4);
    free(damage);
    free(solid);
    tobi_world_destroy(one);
    tobi_world_destroy(four);
    tobi_world_destroy(later);
}

static void runs_go_on_with_the_same_bits(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++)
        for (int model = TOBI_NEO_HOOKEAN; model <= TOBI_COROTATED; model++) check_bits(dimension, model);
}

/* --- what is refused ------------------------------------------------------------------------------- */

/* Adds a solid with cells of 0.1 m, E = 1 MPa; "" = accepted, with *note (NULL: none). */
static const char *add(int model, double strength, double energy, const char **note)
{
    static tobi_error err;
    static char kept[300];
    solid_setup s = solid_default(3, 0.05, 1);
    tobi_world *world;
    memset(&err, 0, sizeof err);
    s.solid.name = "plate";
    s.solid.model = model;
    s.solid.strength = strength;
    s.solid.fracture_energy = energy;
    assert_int_equal(tobi_world_create(&s.world, NULL, &world, NULL), TOBI_OK);
    tobi_status status = tobi_world_add_solid(world, &s.solid, &s.fill, 1, &err);
    assert_int_equal(status == TOBI_OK, err.text[0] == 0);
    snprintf(kept, sizeof kept, "%s", tobi_world_note(world, 0) ? tobi_world_note(world, 0) : "");
    if (note) *note = kept;
    tobi_world_destroy(world);
    return err.text;
}

#define SAYS(text, part)                                                          \
    do {                                                                          \
        const char *got = (text);                                                 \
        if (!strstr(got, part)) fail_msg("'%s' without '%s'", got, part);         \
    } while (0)

static void odd_strengths_are_refused_in_words(void **state)
{
    (void)state;
    const char *note;
    assert_string_equal(add(TOBI_COROTATED, 1e4, 600, &note), "");
    assert_string_equal(note, "");
    SAYS(add(TOBI_NEO_HOOKEAN, 1e4, 0, NULL), "solid 'plate': strength needs a fracture_energy greater");
    SAYS(add(TOBI_NEO_HOOKEAN, 0, 10, NULL), "solid 'plate': fracture_energy needs a strength greater");
    SAYS(add(TOBI_SAND, 1e4, 600, NULL), "strength is for the models neo-hookean and corotated");
    /* 2 G/f (E/f + 0.66)/1.5 = 1e-3 x 100.66/1.5 */
    SAYS(add(TOBI_NEO_HOOKEAN, 1e4, 5, NULL), "strength needs cells smaller than 0.06711 m, they have 0.1 m");
    SAYS(add(TOBI_NEO_HOOKEAN, -1, 10, NULL), "strength");
    assert_string_equal(add(TOBI_NEO_HOOKEAN, 1e4, 1000, &note), "");
    SAYS(note, "solid 'plate': cracks open by 0.2 m until they are through; cells of 0.1 m lose sight");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(breaking_costs_the_fracture_energy),
        cmocka_unit_test(work_is_stored_or_spent),
        cmocka_unit_test(cracks_press_but_do_not_pull),
        cmocka_unit_test(runs_go_on_with_the_same_bits),
        cmocka_unit_test(odd_strengths_are_refused_in_words),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
