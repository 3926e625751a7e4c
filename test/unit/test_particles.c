/* Fields of particles: typed lists, rows that come and go, the order of ids. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdlib.h>
#include <string.h>
#include "mpm/particle_fields.h"
#include "sph/fields.h"
#include "world/methods.h"

static tobi_error err;

/* Type and components of every field of every method say what a row is, and no name stands twice. */
static void lists_tell_the_truth(void **state)
{
    (void)state;
    for (int m = 0; tobi_method_at(m); m++) {
        const tobi_field_list *list = tobi_method_at(m)->fields;
        for (int k = 0; list && k < list->count; k++) {
            const tobi_field *f = &list->field[k];
            assert_int_equal(f->bytes, tobi_type_size(f->type)*(size_t)f->components);
            assert_true(f->unit[0] && f->doc[0] && f->offset < list->size);
            for (int j = 0; j < k; j++) assert_string_not_equal(f->name, list->field[j].name);
        }
    }
}

static void optional_fields_are_there_if_needed(void **state)
{
    tobi_particles with, without;
    (void)state;
    assert_int_equal(tobi_particles_create(&with, &mpm_field_list, MPM_NEED_BLADES, 10, &err), TOBI_OK);
    assert_int_equal(tobi_particles_create(&without, &mpm_field_list, 0, 10, &err), TOBI_OK);
    assert_non_null(mpm_fields_of(&with)->cuts);
    assert_null(mpm_fields_of(&without)->cuts);
    assert_int_equal(tobi_particles_row_bytes(&mpm_field_list, MPM_NEED_BLADES),
                     tobi_particles_row_bytes(&mpm_field_list, 0) + (int64_t)sizeof(tobi_columns));
    assert_int_equal(tobi_particles_widest(&with), sizeof(tobi_columns));
    tobi_particles_free(&with);
    tobi_particles_free(&without);
}

static tobi_particles make(int64_t count)
{
    tobi_particles p;
    int64_t first;
    assert_int_equal(tobi_particles_create(&p, &sph_field_list, 0, count, &err), TOBI_OK);
    assert_int_equal(tobi_particles_insert(&p, count, &first, &err), TOBI_OK);
    assert_true(first == 0 && p.count == count && p.capacity == count && p.ghosts == 0);
    for (int64_t i = 0; i < count; i++) {
        p.position[i].x = (double)i;
        sph_fields_of(&p)->pressure[i] = (float)(10*i);
    }
    return p;
}

/* New rows are zero and have ids that nobody had, also after others have left. */
static void rows_come_and_go(void **state)
{
    tobi_particles p = make(100);
    int64_t first, kept = 0;
    (void)state;
    for (int64_t i = 0; i < p.count; i++)
        if (i%3) tobi_particles_copy(&p, i, kept++);
    p.count = kept;
    assert_int_equal(tobi_particles_insert(&p, 1000, &first, &err), TOBI_OK);
    assert_true(first == kept && p.count == kept + 1000 && p.capacity >= p.count);
    for (int64_t i = 0; i < first; i++) {
        assert_true(p.id[i]%3 && p.position[i].x == (double)p.id[i]);
        assert_true(sph_fields_of(&p)->pressure[i] == (float)(10*p.id[i]));
    }
    for (int64_t i = first; i < p.count; i++) {
        assert_int_equal(p.id[i], 100 + i - first);
        assert_true(p.position[i].x == 0 && sph_fields_of(&p)->pressure[i] == 0 && p.fluid[i] == 0);
        assert_true(sph_fields_of(&p)->density[i] == 0);
    }
    tobi_particles_free(&p);
}

static int compare(const void *p, const void *q)
{
    const int64_t x = *(const int64_t *)p, y = *(const int64_t *)q;
    return (x > y) - (x < y);
}

/* Ids far apart, in any order. */
static void rows_are_ordered_by_id(void **state)
{
    enum { COUNT = 5000 };
    static int32_t rows[COUNT], spare[COUNT];
    static int64_t sorted[COUNT];
    tobi_particles p = make(COUNT);
    (void)state;
    for (int64_t i = 0; i < COUNT; i++) sorted[i] = p.id[i] = (i*7919%COUNT)*123457;
    p.next_id = 123457ll*COUNT;
    qsort(sorted, COUNT, sizeof *sorted, compare);
    tobi_particles_order(&p, rows, spare);
    for (int64_t k = 0; k < COUNT; k++) assert_int_equal(p.id[rows[k]], sorted[k]);
    tobi_particles_free(&p);
}

enum { EARLY = 1, LATE = 2 };
typedef struct staged { double *first, *both, *last; float *wide; } staged;
#define STAGED(X) \
    X(double, TOBI_F64, 1, first, EARLY, 0, "1", "") \
    X(double, TOBI_F64, 1, both, EARLY | LATE, 0, "1", "") \
    X(double, TOBI_F64, 1, last, LATE, 0, "1", "") \
    X(float, TOBI_F32, 1, wide, TOBI_SCRATCH, 0, "1", "")
#define STAGED_ROW(...) TOBI_FIELD_ROW(staged, __VA_ARGS__)

/* A field has memory in its stages only, shared with those of other stages, and keeps its values through
   them, also when rows are added. */
static void fields_of_stages_share_memory(void **state)
{
    static const tobi_field fields[] = { STAGED(STAGED_ROW) };
    const tobi_field_list list = { fields, 4, sizeof(staged) };
    tobi_particles p;
    tobi_error err;
    int64_t first;
    (void)state;
    assert_int_equal(tobi_particles_row_bytes(&list, 0) - tobi_particles_row_bytes(NULL, 0), 8 + 8 + 4);
    assert_int_equal(tobi_particles_create(&p, &list, 0, 100, &err), TOBI_OK);
    p.count = 100;
    const staged *f = p.own;
    assert_true(!f->first && !f->both && !f->last && f->wide);
    tobi_particles_stage(&p, EARLY);
    assert_true(f->first && f->both && !f->last && f->first != f->both);
    const double *place = f->first;
    for (int i = 0; i < 100; i++) f->first[i] = f->both[i] = i;
    tobi_particles_stage(&p, LATE);
    assert_true(!f->first && f->last == place);
    for (int i = 0; i < 100; i++) f->last[i] = -i;
    for (int i = 0; i < 100; i++) assert_true(f->both[i] == i);
    assert_int_equal(tobi_particles_insert(&p, 50, &first, &err), TOBI_OK);
    assert_true(!f->both && !f->last);
    tobi_particles_stage(&p, LATE);
    for (int i = 0; i < 150; i++) f->last[i] = f->both[i] = i;
    tobi_particles_free(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lists_tell_the_truth),
        cmocka_unit_test(optional_fields_are_there_if_needed),
        cmocka_unit_test(fields_of_stages_share_memory),
        cmocka_unit_test(rows_come_and_go),
        cmocka_unit_test(rows_are_ordered_by_id),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
