/* The parameter tables: they cover the definition structs, agree with themselves and with the
 * enums. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "tobiuo/tobiuo.h"
#include "mpm/mlsmpm.h"
#include "sph/dfsph.h"
#include "sph/isph/isph.h"
#include "sph/wcsph.h"
#include "base/param.h"

static size_t member_size(const tobi_param *row)
{
    switch (row->type) {
    case TOBI_PARAM_REAL: return sizeof(double);
    case TOBI_PARAM_VEC3: return 3*sizeof(double);
    case TOBI_PARAM_TEXT: return sizeof(const char *);
    default: return sizeof(int);
    }
}

/* Bytes of the struct that no row covers; fails if two rows share a byte. */
static size_t count_uncovered(const tobi_param_table *table)
{
    unsigned char *covered = calloc(1, table->size);
    size_t uncovered = 0;
    for (const tobi_param *row = table->rows; row->key; row++) {
        assert_true(row->offset + member_size(row) <= table->size);
        for (size_t i = 0; i < member_size(row); i++) {
            assert_int_equal(covered[row->offset + i], 0);
            covered[row->offset + i] = 1;
        }
    }
    for (size_t i = 0; i < table->size; i++) uncovered += !covered[i];
    free(covered);
    return uncovered;
}

static void every_member_has_a_row(void **state)
{
    (void)state;
    size_t hole = sizeof(double) - sizeof(int);      /* an int before something of 8 bytes */
    size_t motion = sizeof(tobi_motion_fn) + sizeof(void *) + sizeof(int);
    size_t control = sizeof(tobi_control_fn) + sizeof(void *) + sizeof(tobi_steer_fn);
    assert_int_equal(count_uncovered(&tobi_world_table), hole);
    assert_int_equal(count_uncovered(&tobi_dfsph_table), 0);
    assert_int_equal(count_uncovered(&tobi_wcsph_table), 0);
    assert_int_equal(count_uncovered(&tobi_isph_table), 0);
    assert_int_equal(count_uncovered(&tobi_eisph_table), hole);
    assert_int_equal(count_uncovered(&tobi_fluid_table), hole);
    assert_int_equal(count_uncovered(&tobi_interface_table), 0);
    assert_int_equal(count_uncovered(&tobi_fill_table), sizeof(tobi_flow_fn) + sizeof(void *) + hole);
    assert_int_equal(count_uncovered(&tobi_body_table), motion + control + 4*hole);
    const size_t further = sizeof(tobi_view_def *) + sizeof(int), name = sizeof(const char *);
    assert_int_equal(count_uncovered(&tobi_output_table), name + further + 4*hole);
    assert_int_equal(count_uncovered(&tobi_view_table), 0);
    assert_int_equal(count_uncovered(&tobi_mlsmpm_table), hole);
    assert_int_equal(count_uncovered(&tobi_solid_table), 3*hole);
    assert_int_equal(count_uncovered(&tobi_plane_table), hole);
    assert_int_equal(count_uncovered(&tobi_inlet_table), hole);
    assert_int_equal(count_uncovered(&tobi_outlet_table), 0);
    assert_int_equal(count_uncovered(&tobi_reference_table), 0);
    assert_int_equal(count_uncovered(&tobi_gravity_table), 0);
    assert_int_equal(count_uncovered(&tobi_central_table), 0);
    assert_int_equal(count_uncovered(&tobi_damping_table), 0);
    assert_int_equal(count_uncovered(&tobi_porous_table), hole);
    assert_int_equal(count_uncovered(&tobi_scalar_table), 4);              /* behind the field */
    assert_int_equal(count_uncovered(&tobi_scalar_value_table), 0);
}

static void check_row(const tobi_param_table *table, const tobi_param *row)
{
    assert_non_null(row->unit);
    assert_true(strlen(row->doc) > 10);
    assert_true(row->doc[strlen(row->doc) - 1] == '.');
    assert_int_equal(row->choices != NULL, row->type == TOBI_PARAM_CHOICE);
    if (row->choices)
        assert_true(tobi_choice_count(row->choices) == (int)row->max + 1 && row->min == 0);
    for (const tobi_param *other = table->rows; other < row; other++)
        assert_string_not_equal(other->key, row->key);
    if (row->type == TOBI_PARAM_TEXT || row->required) return;
    if (row->type == TOBI_PARAM_VEC3 && row->text) return;      /* the word is the default */
    int components = row->type == TOBI_PARAM_VEC3 ? 3 : 1;
    for (int i = 0; i < components; i++) {
        assert_true(isfinite(row->def[i]));
        if (row->text && row->def[i] == tobi_param_word(row)) continue;
        assert_false(row->def[i] < row->min || row->def[i] > row->max);
        assert_false(row->positive && row->def[i] <= 0);
    }
}

static void rows_agree_with_themselves(void **state)
{
    (void)state;
    const tobi_param_table *table;
    int rows = 0, tables = 0;
    for (; (table = tobi_param_table_at(tables)); tables++) {
        const tobi_param *row = table->rows;
        for (; row->key; row++, rows++) check_row(table, row);
        assert_true(row - table->rows <= 128);        /* the binder keeps one bit per row */
    }
    assert_int_equal(tables, 27);
    assert_true(rows > 45);
    assert_null(tobi_param_table_at(-1));
}

static int word_is(const char *choices, int i, const char *expected)
{
    int length;
    const char *word = tobi_choice_word(choices, i, &length);
    return word && (int)strlen(expected) == length && strncmp(word, expected, (size_t)length) == 0;
}

static const tobi_param *find_row(const tobi_param_table *table, const char *key)
{
    const tobi_param *row = table->rows;
    while (row->key && strcmp(row->key, key) != 0) row++;
    assert_non_null(row->key);
    return row;
}

static void words_follow_the_enums(void **state)
{
    (void)state;
    const char *walls = find_row(&tobi_world_table, "domain.walls.y[1]")->choices;
    assert_true(word_is(walls, TOBI_WALL_SLIP, "slip") &&
                word_is(walls, TOBI_WALL_NO_SLIP, "no-slip"));
    assert_true(word_is(walls, TOBI_WALL_PERIODIC, "periodic"));
    const char *kernels = find_row(&tobi_dfsph_table, "kernel")->choices;
    assert_true(word_is(kernels, TOBI_KERNEL_WENDLAND_C2, "wendland-c2"));
    assert_true(word_is(kernels, TOBI_KERNEL_CUBIC_SPLINE, "cubic-spline"));
    const char *solvers = find_row(&tobi_isph_table, "solver")->choices;
    assert_true(word_is(solvers, TOBI_CG, "cg") && word_is(solvers, TOBI_BICGSTAB, "bicgstab") &&
                word_is(solvers, TOBI_GMRES, "gmres"));
    const char *preconditioners = find_row(&tobi_isph_table, "preconditioner")->choices;
    assert_true(word_is(preconditioners, TOBI_MULTIGRID, "multigrid") &&
                word_is(preconditioners, TOBI_JACOBI, "jacobi"));
    const char *iterations = find_row(&tobi_eisph_table, "iteration")->choices;
    assert_true(word_is(iterations, TOBI_ITERATION_JACOBI, "jacobi") &&
                word_is(iterations, TOBI_ITERATION_PSEUDO_TIME, "pseudo-time"));
    const char *friction = find_row(&tobi_body_table, "friction")->choices;
    assert_true(word_is(friction, TOBI_SLIP, "slip") && word_is(friction, TOBI_NO_SLIP, "no-slip"));
    const char *forms = find_row(&tobi_output_table, "compression")->choices;
    assert_true(word_is(forms, TOBI_COMPRESS_NONE, "none") &&
                word_is(forms, TOBI_COMPRESS_ZLIB, "zlib"));
    assert_true(word_is(forms, TOBI_COMPRESS_LZ4, "lz4") && word_is(forms, TOBI_ASCII, "ascii"));
    const char *models = find_row(&tobi_solid_table, "model")->choices;
    assert_true(word_is(models, TOBI_NEO_HOOKEAN, "neo-hookean") && word_is(models, TOBI_SAND, "sand") &&
                word_is(models, TOBI_LIQUID, "liquid") && word_is(models, TOBI_STATIONARY, "stationary"));
    assert_true(word_is(walls, TOBI_WALL_SEPARATE, "separate"));
    assert_true(word_is(walls, TOBI_WALL_OPEN, "open"));
    const char *planes = find_row(&tobi_plane_table, "kind")->choices;
    assert_true(word_is(planes, TOBI_PLANE_SEPARATE, "separate") &&
                word_is(planes, TOBI_PLANE_SLIP, "slip") && word_is(planes, TOBI_PLANE_NO_SLIP, "no-slip"));
    int length;
    assert_null(tobi_choice_word(forms, 4, &length));
}

static void defaults_are_water_on_earth(void **state)
{
    (void)state;
    tobi_world_def w = tobi_default_world_def();
    assert_string_equal(w.method, "dfsph");
    assert_true(w.dimension == 3 && w.gravity[2] == -9.81 && w.cfl == 0.4 && w.time_step == 0);
    assert_true(w.wall_min[0] == TOBI_WALL_SLIP && w.wall_max[2] == TOBI_WALL_SLIP &&
                w.threads == 0);
    tobi_dfsph_def d = tobi_default_dfsph_def();
    assert_true(d.kernel == TOBI_KERNEL_WENDLAND_C2 && d.support == 0 &&
                d.density_tolerance == 5e-4);
    assert_true(d.density_iterations_min == 1 && d.divergence_iterations_min == 1 &&
                d.filter == 1);
    tobi_fluid_def f = tobi_default_fluid_def();
    assert_true(f.density == 1000 && f.viscosity == 1.0e-3);
    tobi_fill_def fill = tobi_default_fill_def();
    assert_true(fill.scale[0] == 1 && fill.mesh == NULL && fill.velocity[1] == 0);
    tobi_body_def b = tobi_default_body_def();
    assert_true(b.scale[2] == 1 && b.density == 1000 && b.spacing == 0 && b.motion == NULL);
    tobi_output_def o = tobi_default_output_def();
    assert_true(o.interval == 0.01 && o.compression == TOBI_COMPRESS_ZLIB && o.surfaces == 1 &&
                o.frames == 0);
    assert_string_equal(o.fields, "usual");
    tobi_mlsmpm_def m = tobi_default_mlsmpm_def();
    assert_true(m.cell == 2 && m.transfer == TOBI_APIC && m.cfl == 0.4);
    tobi_solid_def s = tobi_default_solid_def();
    assert_true(s.model == TOBI_NEO_HOOKEAN && s.density == 1000 && s.youngs_modulus == 1e6 &&
                s.poissons_ratio == 0.3 && s.mass == 0 && s.damping == 0 && s.visible);
}

static void ranges_are_enforced(void **state)
{
    (void)state;
    tobi_error err;
    tobi_dfsph_def d = tobi_default_dfsph_def();
    assert_int_equal(tobi_param_check(&tobi_dfsph_table, &d, &err), TOBI_OK);
    d.support = 4.5;
    assert_int_equal(tobi_param_check(&tobi_dfsph_table, &d, &err), TOBI_INVALID);
    assert_non_null(strstr(err.text, "support"));
    d = tobi_default_dfsph_def();
    d.density_tolerance = 0;
    assert_int_equal(tobi_param_check(&tobi_dfsph_table, &d, &err), TOBI_INVALID);
    tobi_fluid_def f = tobi_default_fluid_def();
    f.viscosity = -1e-3;
    assert_int_equal(tobi_param_check(&tobi_fluid_table, &f, &err), TOBI_INVALID);
    f.viscosity = NAN;
    assert_int_equal(tobi_param_check(&tobi_fluid_table, &f, &err), TOBI_INVALID);
    tobi_world_def w = tobi_default_world_def();
    assert_int_equal(tobi_param_check(&tobi_world_table, &w, &err),
                     TOBI_INVALID); /* spacing is 0 */
    w.spacing = 0.01;
    assert_int_equal(tobi_param_check(&tobi_world_table, &w, &err), TOBI_OK);
    w.wall_max[1] = 5;
    assert_int_equal(tobi_param_check(&tobi_world_table, &w, &err), TOBI_INVALID);
}

/* Elastic constants belong to what is elastic, those of liquids to liquids; the rest to all. */
static void models_know_their_constants(void **state)
{
    (void)state;
    char text[200];
    for (int model = TOBI_NEO_HOOKEAN; model <= TOBI_STATIONARY; model++) {
        int elastic = model != TOBI_LIQUID && model != TOBI_STATIONARY;
        assert_int_equal(tobi_solid_uses(model, "youngs_modulus"), elastic);
        assert_int_equal(tobi_solid_uses(model, "bulk_modulus"), model == TOBI_LIQUID);
        assert_true(tobi_solid_uses(model, "density") && tobi_solid_uses(model, "color"));
    }
    tobi_solid_list(TOBI_SAND, text, sizeof text);
    assert_string_equal(text, "density or mass, youngs_modulus, poissons_ratio, friction_angle, "
                        "friction_rise, grain_diameter, inertial_number, damping, surface_friction, "
                        "clamped_to");
}

static void methods_are_found_by_name(void **state)
{
    (void)state;
    assert_ptr_equal(tobi_method_table("dfsph"), &tobi_dfsph_table);
    assert_null(tobi_method_table("dfsp"));
    assert_null(tobi_method_table(NULL));
    assert_ptr_equal(tobi_method_table("wcsph"), &tobi_wcsph_table);
    assert_string_equal(tobi_method_name(0), "dfsph");
    assert_string_equal(tobi_method_name(1), "wcsph");
    assert_string_equal(tobi_method_name(2), "isph");
    assert_string_equal(tobi_method_name(3), "eisph");
    assert_string_equal(tobi_method_name(4), "mlsmpm");
    assert_null(tobi_method_name(5));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_member_has_a_row),
        cmocka_unit_test(rows_agree_with_themselves),
        cmocka_unit_test(words_follow_the_enums),
        cmocka_unit_test(defaults_are_water_on_earth),
        cmocka_unit_test(ranges_are_enforced),
        cmocka_unit_test(models_know_their_constants),
        cmocka_unit_test(methods_are_found_by_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
