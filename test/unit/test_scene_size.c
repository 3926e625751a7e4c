/* Scenes as large as they may be are read, or refused, in seconds: nothing is searched once per mistake, per
   block or per pair. */
#define _GNU_SOURCE 1
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include "calls.h"
#include "scene/scene.h"

/* s of processor time; each case takes 0.3 to 1.5, and took 10 or more when it was quadratic. */
#ifdef __SANITIZE_ADDRESS__
static const double LIMIT = 60;
#else
static const double LIMIT = 6;
#endif

enum { MANY = SANITIZED ? 10000 : 300000 };

typedef void (*part_fn)(FILE *out, int i);

/* head, n parts with commas between them, tail. */
static char *write_text(const char *head, int n, const char *comma, part_fn part, const char *tail)
{
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    fputs(head, out);
    for (int i = 0; i < n; i++) {
        if (i) fputs(comma, out);
        part(out, i);
    }
    fputs(tail, out);
    fclose(out);
    return text;
}

/* Takes the text over. Returns line `line` of the report, kept until the next call; "" for a good scene. */
static const char *read_text(const char *name, char *text, int line)
{
    static char kept[600];
    tobi_scene *scene = NULL;
    tobi_report *report = NULL;
    tobi_error err = { 0 };
    const clock_t begin = clock();
    const tobi_status status = tobi_scene_parse(name, text, strlen(text), NULL, &scene, &report, &err);
    const double seconds = (double)(clock() - begin)/CLOCKS_PER_SEC;
    if (seconds > LIMIT) fail_msg("%s took %.1f s", name, seconds);
    snprintf(kept, sizeof kept, "%s", status == TOBI_OK ? "" : tobi_report_line(report, line));
    tobi_report_free(report);
    tobi_scene_free(scene);
    free(text);
    return kept;
}

#define HEAD                                                                                              \
    "{ \"domain\": { \"min\": [0, 0, 0], \"max\": [1, 1, 1] }, \"spacing\": 0.1, \"end_time\": 1,\n"      \
    "\"fluids\": [ { \"name\": \"w\", \"fill\": [ { \"box\": { \"min\": [0, 0, 0],"                      \
    " \"max\": [1, 1, 0.5] } } ] } ],\n"

static void put_key(FILE *out, int i) { fprintf(out, "\"key_%d\": 1", i); }

static void unknown_keys(void **state)
{
    (void)state;
    const int n = MANY;
    char rest[40];
    const char *line = read_text("s.json", write_text(HEAD, n, ",\n", put_key, " }"), 199);
    if (!strstr(line, "s.json:202:1: key_199: unknown key; allowed here: ")) fail_msg("%s", line);
    line = read_text("s.json", write_text(HEAD, n, ", ", put_key, " }"), 200);
    snprintf(rest, sizeof rest, "... and %d more mistakes", n - 200);
    assert_string_equal(line, rest);
}

/* The second half repeats the first in another order. */
static void put_twin(FILE *out, int i)
{
    enum { N = MANY/2, PRIME = 7919 };
    fprintf(out, "\"key_%d\": 1", i < N ? i : (int)((int64_t)i*PRIME%N));
}

static void keys_given_twice(void **state)
{
    (void)state;
    const char *line = read_text("s.json", write_text(HEAD, MANY, ", ", put_twin, " }"), 0);
    if (!strstr(line, "duplicate key, already given in line 3")) fail_msg("%s", line);
}

static void put_field(FILE *out, int i) { fprintf(out, "\"velocty%d\"", i); }

static void unknown_fields(void **state)
{
    (void)state;
    char *text = write_text(HEAD "\"output\": { \"fields\": [", MANY, ",", put_field, "] } }");
    const char *line = read_text("s.json", text, 0);
    if (!strstr(line, "output.fields: there is no field \"velocty0\"; did you mean \"velocity\"?"))
        fail_msg("%s", line);
}

/* One above the other. */
static void put_block(FILE *out, int i)
{
    fprintf(out, "{ \"start\": [0, 0, %d], \"end\": [1, 1, %d], \"a\": 1, \"b\": 2 }", i, i + 1);
}

static void put_wrong_block(FILE *out, int i)
{
    (void)i;
    fprintf(out, "{ \"start\": [0, 0, 0], \"end\": [1, 1, 0.5], \"density\": \"heavy\", \"b\": 2 }");
}

static const char old_head[] = "{ \"Configuration\": { \"domainEnd\": [1, 1, 256], \"particleRadius\": 0.05,"
                               " \"gravitation\": [0, 0, -9.81] }, \"FluidBlocks\": [\n";

static void blocks_of_old_scenes(void **state)
{
    (void)state;
    const char *line = read_text("o.json", write_text(old_head, 100000, ",\n", put_block, "] }"), 0);
    assert_string_equal(line, "o.json:1:119: FluidBlocks: has 100000 entries, allowed are 2048");
    assert_string_equal(read_text("o.json", write_text(old_head, 256, ",\n", put_block, "] }"), 0), "");
    line = read_text("o.json", write_text(old_head, 2000, ",\n", put_wrong_block, "] }"), 199);
    if (!strstr(line, "o.json:201:54: FluidBlocks[199].density: ")) fail_msg("%s", line);
}

/* Side by side in y and z, all over the same x. */
static void put_solid(FILE *out, int i)
{
    fprintf(out, "{ \"name\": \"s%d\", \"fill\": [", i);
    for (int k = 0; k < 255; k++)
        fprintf(out, "%s{ \"box\": { \"min\": [0, %d, %d], \"max\": [1, %d, %d] } }", k ? ",\n" : "", k, i,
                k + 1, i + 1);
    fprintf(out, "] }");
}

/* The same box again and again. */
static void put_same(FILE *out, int i)
{
    fprintf(out, "{ \"name\": \"s%d\", \"fill\": [", i);
    for (int k = 0; k < 255; k++)
        fprintf(out, "%s{ \"box\": { \"min\": [0, 0, 0], \"max\": [1, 1, 1] } }", k ? ",\n" : "");
    fprintf(out, "] }");
}

static void regions_side_by_side(void **state)
{
    (void)state;
    static const char head[] = "{ \"method\": \"mlsmpm\", \"spacing\": 0.01, \"end_time\": 1,"
                               " \"domain\": { \"min\": [0, 0, 0], \"max\": [1, 255, 255] }, \"solids\": [";
    assert_string_equal(read_text("s.json", write_text(head, 255, ",\n", put_solid, "] }"), 0), "");
    const char *line = read_text("s.json", write_text(head, 255, ",\n", put_same, "] }"), 0);
    if (!strstr(line, "solids[0].fill[1]: overlaps the box solids[0].fill[0]")) fail_msg("%s", line);
}

/* A row of squares of one particle each. */
static void put_row(FILE *out, int i)
{
    fprintf(out, "{ \"name\": \"s%d\", \"fill\": [", i);
    for (int k = 0; k < TOBI_FILL_LIMIT; k++)
        fprintf(out, "%s{ \"box\": { \"min\": [%d, %d], \"max\": [%d, %d] } }", k ? ",\n" : "", k, i, k + 1,
                i + 1);
    fprintf(out, "] }");
}

/* A world takes as many regions as its scene may have. */
static void as_many_regions_as_allowed(void **state)
{
    (void)state;
    static const char head[] = "{ \"method\": \"mlsmpm\", \"dimension\": 2, \"spacing\": 1, \"end_time\": 1,"
                               " \"domain\": { \"min\": [0, 0], \"max\": [256, 255] }, \"solids\": [";
    char *text = write_text(head, TOBI_SOLID_LIMIT, ",\n", put_row, "] }");
    tobi_scene *scene = NULL;
    tobi_world *w = NULL;
    tobi_report *report = NULL;
    int64_t particles, bodies, bytes;
    OK(tobi_scene_parse("s.json", text, strlen(text), NULL, &scene, &report, &err));
    OK(tobi_scene_build(scene, &w, &err));
    OK(tobi_world_estimate(w, &particles, &bodies, &bytes, &err));
    assert_int_equal(particles, TOBI_SOLID_LIMIT*TOBI_FILL_LIMIT);
    tobi_world_destroy(w);
    tobi_report_free(report);
    tobi_scene_free(scene);
    free(text);
}

static void put_name(FILE *out, int i) { fprintf(out, "k%d = %s%d", i + 1, i ? "k" : "", i); }

static void names_of_parameters(void **state)
{
    (void)state;
    const char *line = read_text("p.py", write_text("", 100000, "\n", put_name, "\n"), 0);
    assert_string_equal(line, "p.py:1001:1: is one name too many; allowed are 1000");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(unknown_keys),         cmocka_unit_test(keys_given_twice),
        cmocka_unit_test(unknown_fields),       cmocka_unit_test(blocks_of_old_scenes),
        cmocka_unit_test(regions_side_by_side), cmocka_unit_test(names_of_parameters),
        cmocka_unit_test(as_many_regions_as_allowed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
