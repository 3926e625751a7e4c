/* Solids that start in pieces are told, with what would help; those that should are not. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>
#include "solid_rig.h"

static const char path[] = "pieces.obj";

/* A prism over a polygon of n corners, given counter-clockwise, and over the triangles that make it up; z
   goes from 0 to 1. */
static void add_prism(FILE *out, int *vertices, int n, const double (*corner)[2], int triangles,
                      const int (*triangle)[3])
{
    const int first = *vertices + 1;
    for (int z = 0; z < 2; z++)
        for (int k = 0; k < n; k++) fprintf(out, "v %g %g %d\n", corner[k][0], corner[k][1], z);
    for (int t = 0; t < triangles; t++) {
        const int *c = triangle[t];
        fprintf(out, "f %d %d %d\n", first + c[0], first + c[2], first + c[1]);
        fprintf(out, "f %d %d %d\n", first + n + c[0], first + n + c[1], first + n + c[2]);
    }
    for (int k = 0; k < n; k++) {
        const int next = (k + 1)%n;
        fprintf(out, "f %d %d %d\n", first + k, first + next, first + n + next);
        fprintf(out, "f %d %d %d\n", first + k, first + n + next, first + n + k);
    }
    *vertices += 2*n;
}

/* Two cubes of 1 m, 1 m apart, with a bar of this thickness between them; without one for 0. */
static void write_dumbbell(double thick)
{
    FILE *out = fopen(path, "w");
    int vertices = 0;
    assert_non_null(out);
    const double low = 0.47 - 0.5*thick, high = 0.47 + 0.5*thick;
    const double all[12][2] = { { 0, 0 }, { 1, 0 }, { 1, low }, { 2, low }, { 2, 0 }, { 3, 0 },
                                { 3, 1 }, { 2, 1 }, { 2, high }, { 1, high }, { 1, 1 }, { 0, 1 } };
    const int of_all[10][3] = { { 0, 1, 2 }, { 0, 2, 9 }, { 0, 9, 11 }, { 9, 10, 11 }, { 2, 3, 8 },
                                { 2, 8, 9 }, { 3, 4, 5 }, { 3, 5, 6 }, { 3, 6, 8 }, { 6, 7, 8 } };
    const double left[4][2] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } },
                 right[4][2] = { { 2, 0 }, { 3, 0 }, { 3, 1 }, { 2, 1 } };
    const int of_one[2][3] = { { 0, 1, 2 }, { 0, 2, 3 } };
    if (thick > 0) {
        add_prism(out, &vertices, 12, all, 10, of_all);
    } else {
        add_prism(out, &vertices, 4, left, 2, of_one);
        add_prism(out, &vertices, 4, right, 2, of_one);
    }
    fclose(out);
}

/* The first note of a world with the dumbbell at this spacing, "" without one. */
static const char *read_note(double thick, double spacing, int model)
{
    static char note[600];
    solid_setup s = solid_default(3, spacing, 4);
    write_dumbbell(thick);
    s.solid.name = "dumbbell";
    s.solid.model = model;
    s.fill.mesh = path;
    tobi_world *world = solid_world(&s);
    OK(tobi_world_start(world, &err));
    snprintf(note, sizeof note, "%s", tobi_world_note(world, 0) ? tobi_world_note(world, 0) : "");
    tobi_world_destroy(world);
    unlink(path);
    return note;
}

static void thin_parts_are_told(void **state)
{
    (void)state;
    assert_string_equal(read_note(0.1, 0.25, TOBI_NEO_HOOKEAN),
        "solid 'dumbbell': fill[0] starts in 2 pieces (1050, 1050 kg): parts of its mesh are thinner "
        "than the spacing, 0.25 m; at 0.2 m it is whole");
    assert_string_equal(read_note(1e-4, 0.25, TOBI_NEO_HOOKEAN) + strlen("solid 'dumbbell': "),
        "fill[0] starts in 2 pieces (1000, 1000 kg): parts of its mesh are far thinner than the spacing, "
        "0.25 m, or do not touch; at 0.01374 m it is not whole either");
}

static void what_is_whole_or_meant_is_not(void **state)
{
    (void)state;
    assert_string_equal(read_note(0.3, 0.25, TOBI_NEO_HOOKEAN), "");
    assert_string_equal(read_note(0, 0.25, TOBI_NEO_HOOKEAN), "");        /* the mesh has two parts */
    assert_string_equal(read_note(0.1, 0.25, TOBI_SAND), "");             /* heaps are no pieces */
}

/* Two fills apart are two pieces that the scene asks for; a body through one of them makes a third. */
static void regions_by_themselves(void **state)
{
    (void)state;
    for (int body = 0; body < 2; body++) {
        solid_setup s = solid_default(3, 0.25, 4);
        tobi_fill_def fill[2] = { s.fill, s.fill };
        tobi_body_def wall = tobi_default_body_def();
        tobi_world *world;
        for (int k = 0; k < 2; k++) {
            fill[k].box_min[0] = 2*k;
            fill[k].box_max[0] = 2*k + 1.5;
        }
        wall.box_min[1] = 1.5;
        wall.box_max[0] = 1.75;
        wall.box_max[1] = 2.5;
        wall.box_max[2] = 4;
        OK(tobi_world_create(&s.world, &s.method, &world, &err));
        OK(tobi_world_add_solid(world, &s.solid, fill, 2, &err));
        if (body) OK(tobi_world_add_body(world, &wall, &err));
        OK(tobi_world_start(world, &err));
        int told = 0;
        const char *note;
        for (int k = 0; (note = tobi_world_note(world, k)); k++)
            told += strstr(note, "fill[0] starts in 2 pieces (9000, 9000 kg): parts of it are thinner than "
                                 "the spacing, 0.25 m, or bodies, planes and sides part it") != NULL;
        assert_int_equal(told, body);
        tobi_world_destroy(world);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(thin_parts_are_told),
        cmocka_unit_test(what_is_whole_or_meant_is_not),
        cmocka_unit_test(regions_by_themselves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
