/* The neighbour list against all pairs: walled and periodic boxes, near and far, every instruction set. */
#include "core/cells.h"
#include "sph/state.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

typedef struct cloud { int dimension, count; double size[3]; int periodic[3]; double h, origin; } cloud;

static uint64_t state_ = 5;
static double random_unit(void)
{
    state_ = state_*6364136223846793005u + 1442695040888963407u;
    return (double)(state_ >> 11)/9007199254740992.0;
}

typedef struct grid { tobi_exec exec; tobi_box box; tobi_particles p; tobi_cells cells; } grid;

static void place(grid *g, const cloud *c, int threads)
{
    double lower[3], upper[3];
    tobi_error err;
    memset(g, 0, sizeof *g);
    assert_int_equal(tobi_exec_init(&g->exec, threads, NULL), TOBI_OK);
    for (int a = 0; a < 3; a++) {
        lower[a] = c->origin;
        upper[a] = c->origin + c->size[a];
    }
    tobi_box_init(&g->box, c->dimension, lower, upper, c->periodic, c->h);
    assert_int_equal(tobi_particles_create(&g->p, &sph_field_list, 0, c->count, &err), TOBI_OK);
    assert_int_equal(tobi_cells_create(&g->cells, &g->box, c->h, &g->p, &g->exec, &err), TOBI_OK);
    state_ = 5;
    for (int i = 0; i < c->count; i++) {
        double *x = &g->p.position[i].x;
        for (int a = 0; a < c->dimension; a++) {
            x[a] = c->size[a]*random_unit();
            if (c->periodic[a] && i%7 == 0) x[a] += (i%2 ? 1 : -1)*c->size[a];   /* left over the side */
        }
        g->p.id[i] = i;
        sph_fields_of(&g->p)->pressure[i] = (float)i;
        g->p.velocity[i].x = (float)(2*i);
        g->p.fluid[i] = (uint8_t)(i%3);
    }
    g->p.count = c->count;
    tobi_cells_sort(&g->cells, &g->box, &g->p, sph_fields_of(&g->p)->pressure, &g->exec);
}

static void drop(grid *g)
{
    tobi_cells_free(&g->cells);
    tobi_particles_free(&g->p);
    tobi_exec_free(&g->exec);
}

static void list(grid *g, const cloud *c)
{
    tobi_error err;
    if (tobi_cells_list(&g->cells, &g->box, c->h, &g->p, &g->exec, &err)) fail_msg("%s", err.text);
}

static double distance(const grid *g, int i, int j)
{
    double r2 = 0;
    for (int a = 0; a < 3; a++) {
        double d = (&g->p.position[i].x)[a] - (&g->p.position[j].x)[a];
        if (g->box.periodic[a]) d -= g->box.size[a]*nearbyint(d/g->box.size[a]);
        r2 += d*d;
    }
    return sqrt(r2);
}

/* Every listed neighbour once, none missing; pairs within rounding of h may be either. */
static int64_t compare(const grid *g, const cloud *c)
{
    char *seen = malloc((size_t)c->count);
    int64_t pairs = 0;
    for (int i = 0; i < c->count; i++) {
        int32_t unpacked[TOBI_LIST_LIMIT];
        int count;
        const int32_t *list = tobi_cells_neighbors(&g->cells, i, &count, unpacked);
        memset(seen, 0, (size_t)c->count);
        for (int k = 0; k < count; k++) {
            assert_in_range(list[k], 0, c->count - 1);
            if (list[k] != i) assert_int_equal(seen[list[k]]++, 0);
        }
        for (int j = 0; j < c->count; j++) {
            double r = distance(g, i, j);
            if (j == i || fabs(r - c->h) < 1e-6*c->h) continue;
            if (seen[j] != (r < c->h))
                fail_msg("pair %d %d at %.9g, h %.9g: listed %d", i, j, r, c->h, seen[j]);
            pairs += seen[j];
        }
    }
    free(seen);
    return pairs;
}

static const cloud clouds[] = {
    {3, 1500, {1, 1, 1}, {0, 0, 0}, 0.15, 0},
    {3, 1500, {1, 0.7, 0.5}, {1, 1, 1}, 0.15, -4},
    {3, 1000, {0.46, 1.3, 0.46}, {1, 0, 1}, 0.15, 10000},
    {3, 900, {5, 0.2, 0.1}, {0, 0, 0}, 0.15, 0},          /* thinner than a cell            */
    {3, 500, {90, 80, 70}, {0, 0, 0}, 0.15, 0},           /* vast: cells wider than h       */
    {2, 1500, {1, 2, 0}, {0, 0, 0}, 0.08, 0},
    {2, 1500, {2, 1, 0}, {1, 1, 0}, 0.08, -1},
    {2, 1200, {9, 0.3, 0}, {1, 0, 0}, 0.08, 3},
    {3, 300, {0.05, 0.05, 0.05}, {0, 0, 0}, 0.15, 0},     /* everyone sees everyone: the list must grow */
};
enum { CLOUDS = sizeof clouds/sizeof *clouds };

static void list_holds_all_pairs(void **state)
{
    (void)state;
    for (int c = 0; c < CLOUDS; c++) {
        grid g;
        place(&g, &clouds[c], 2);
        int best = g.exec.isa;
        for (g.exec.isa = 2; g.exec.isa <= best; g.exec.isa++) {
            list(&g, &clouds[c]);
            int64_t pairs = compare(&g, &clouds[c]);
            if (clouds[c].size[0] < 50) assert_true(pairs > clouds[c].count);
        }
        drop(&g);
    }
}

/* Rows travel whole, order follows the cells, periodic positions are wrapped. */
static void sort_keeps_rows_and_orders_cells(void **state)
{
    (void)state;
    for (int c = 0; c < CLOUDS; c++) {
        grid g;
        place(&g, &clouds[c], 3);
        char *seen = calloc((size_t)clouds[c].count, 1);
        for (int i = 0; i < clouds[c].count; i++) {
            int64_t id = g.p.id[i];
            assert_in_range(id, 0, clouds[c].count - 1);
            assert_int_equal(seen[id]++, 0);
            assert_true(sph_fields_of(&g.p)->pressure[i] == (float)id && g.p.velocity[i].x == (float)(2*id));
            assert_true(g.cells.record[i].w == (float)id);
            assert_int_equal(g.p.fluid[i], id%3);
            for (int a = 0; a < clouds[c].dimension; a++) {
                double x = (&g.p.position[i].x)[a];
                assert_true(x >= 0 && x <= g.box.size[a]);
            }
        }
        assert_int_equal(g.cells.start[0], 0);
        assert_int_equal(g.cells.start[g.cells.total], clouds[c].count);
        for (int64_t k = 0; k < g.cells.total; k++)
            assert_true(g.cells.start[k] <= g.cells.start[k + 1]);
        free(seen);
        drop(&g);
    }
}

/* The order, and with it every sum, is the same for any number of threads. */
static void order_does_not_depend_on_threads(void **state)
{
    (void)state;
    for (int c = 0; c < CLOUDS; c++) {
        grid one, more;
        place(&one, &clouds[c], 1);
        place(&more, &clouds[c], 4);
        assert_memory_equal(one.p.id, more.p.id, (size_t)clouds[c].count*sizeof *one.p.id);
        list(&one, &clouds[c]);
        list(&more, &clouds[c]);
        for (int i = 0; i < clouds[c].count; i++) {
            int32_t unpacked[2][TOBI_LIST_LIMIT];
            int count[2];
            const int32_t *mine = tobi_cells_neighbors(&one.cells, i, &count[0], unpacked[0]);
            const int32_t *other = tobi_cells_neighbors(&more.cells, i, &count[1], unpacked[1]);
            assert_int_equal(count[0], count[1]);
            assert_memory_equal(mine, other, (size_t)count[0]*sizeof *mine);
        }
        drop(&one);
        drop(&more);
    }
}

/* The list is the longest array: it has little room beyond what a search needs, however it grew. */
static void list_fits_what_it_holds(void **state)
{
    const cloud dense = {3, 4000, {1, 1, 1}, {0, 0, 0}, 0.24, 0};
    (void)state;
    grid g;
    place(&g, &dense, 2);
    list(&g, &dense);
    assert_true(g.cells.list_used > 4000*40 + 4096);              /* it has grown */
    assert_true((double)g.cells.list_bytes < 2.08*(double)g.cells.list_used);
    int64_t groups = 0;
    for (int i = 0; i < dense.count; i++) groups += g.cells.list_groups[i];
    assert_true((double)g.cells.list_used < 1.06*8*(double)groups);
    drop(&g);
}

/* Some lists against all pairs, where neighbours are thousands of rows away: in the next strip of cells, what
   16 bits still tell, and in layers so full that the list goes over to whole numbers. */
static void lists_reach_far(void **state)
{
    static const cloud far[] = {
        {3, 60000, {100, 20, 20}, {0, 0, 0}, 1.01, 0},
        {3, 60000, {100, 20, 20}, {0, 1, 0}, 1.01, 0},
        {3, 80000, {100, 8, 4}, {0, 0, 0}, 1.01, 0},
    };
    (void)state;
    for (int c = 0; c < 3; c++) {
        grid g;
        place(&g, &far[c], 2);
        list(&g, &far[c]);
        assert_int_equal(g.cells.wide, c == 2);
        assert_true((g.cells.list_far == NULL) == (c == 2));
        int beyond = 0;
        for (int i = 0; i < far[c].count; i += 211) {
            int32_t unpacked[TOBI_LIST_LIMIT];
            int count, pairs = 0, listed = 0;
            const int32_t *near = tobi_cells_neighbors(&g.cells, i, &count, unpacked);
            for (int k = 0; k < count; k++) {
                assert_true(near[k] == i || distance(&g, i, near[k]) < far[c].h*(1 + 1e-6));
                listed += near[k] != i;
                beyond += near[k] - i >= 16384 || i - near[k] > 16384;
            }
            for (int j = 0; j < far[c].count; j++) {
                const double dx = g.p.position[i].x - g.p.position[j].x;
                if (fabs(dx) < far[c].h && j != i) pairs += distance(&g, i, j) < far[c].h*(1 - 1e-6);
            }
            assert_in_range(listed, pairs, pairs + 1);
        }
        assert_true(beyond > 30);
        drop(&g);
    }
}

static void bad_boxes_are_refused(void **state)
{
    (void)state;
    const cloud c = {3, 2000, {0.1, 0.1, 0.1}, {0, 0, 0}, 0.15, 0};
    grid g;
    tobi_error err;
    place(&g, &c, 1);
    assert_int_equal(tobi_cells_list(&g.cells, &g.box, c.h, &g.p, &g.exec, &err), TOBI_DIVERGED);
    assert_non_null(strstr(err.text, "crowd"));
    g.box.periodic[1] = 1;
    tobi_cells_free(&g.cells);
    assert_int_equal(tobi_cells_create(&g.cells, &g.box, c.h, &g.p, &g.exec, &err), TOBI_INVALID);
    assert_non_null(strstr(err.text, "three support radii"));
    drop(&g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(list_holds_all_pairs),
        cmocka_unit_test(sort_keeps_rows_and_orders_cells),
        cmocka_unit_test(order_does_not_depend_on_threads),
        cmocka_unit_test(list_fits_what_it_holds),
        cmocka_unit_test(lists_reach_far),
        cmocka_unit_test(bad_boxes_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
