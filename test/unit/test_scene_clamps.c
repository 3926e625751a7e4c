/* Scenes whose solids are clamped to bodies that cannot hold them. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <string.h>
#include "mistakes.h"

static const char text[] =
    "{ \"method\": \"mlsmpm\", \"dimension\": 2, \"domain\": { \"min\": [0, 0], \"max\": [1, 1] },\n"
    "  \"spacing\": 0.02, \"end_time\": 1,\n"
    "  \"bodies\": [ { \"name\": \"plate\", \"box\": { \"min\": [0, 0], \"max\": [0.1, 0.1] } },\n"
    "    { \"name\": \"gate\", \"box\": { \"min\": [0, 0.2], \"max\": [0.1, 0.3] },\n"
    "      \"absent\": { \"from\": 1 } },\n"
    "    { \"name\": \"knife\", \"box\": { \"min\": [0, 0.4], \"max\": [0.1, 0.5] }, \"blade\": true } ],\n"
    "  \"solids\": [ { \"name\": \"a\", \"clamped_to\": \"plat\",\n"
    "      \"fill\": [ { \"box\": { \"min\": [0, 0.1], \"max\": [0.1, 0.2] } } ] },\n"
    "    { \"name\": \"b\", \"clamped_to\": \"gate\",\n"
    "      \"fill\": [ { \"box\": { \"min\": [0.2, 0.1], \"max\": [0.3, 0.2] } } ] },\n"
    "    { \"name\": \"c\", \"clamped_to\": \"knife\",\n"
    "      \"fill\": [ { \"box\": { \"min\": [0.4, 0.1], \"max\": [0.5, 0.2] } } ] },\n"
    "    { \"name\": \"d\", \"model\": \"liquid\", \"clamped_to\": \"plate\",\n"
    "      \"fill\": [ { \"box\": { \"min\": [0.6, 0.1], \"max\": [0.7, 0.2] } } ] },\n"
    "    { \"name\": \"e\", \"clamped_to\": [\"plate\", \"gates\", \"gate\", \"plate\"],\n"
    "      \"fill\": [ { \"box\": { \"min\": [0, 0.6], \"max\": [0.1, 0.7] } } ] },\n"
    "    { \"name\": \"f\", \"clamped_to\": [],\n"
    "      \"fill\": [ { \"box\": { \"min\": [0.2, 0.6], \"max\": [0.3, 0.7] } } ] },\n"
    "    { \"name\": \"g\", \"clamped_to\": 7,\n"
    "      \"fill\": [ { \"box\": { \"min\": [0.4, 0.6], \"max\": [0.5, 0.7] } } ] },\n"
    "    { \"name\": \"h\", \"clamped_to\": \"plate,gate\",\n"
    "      \"fill\": [ { \"box\": { \"min\": [0.6, 0.6], \"max\": [0.7, 0.7] } } ] } ] }";

static const char *const expected[] = {
    ":7:44: solids[0].clamped_to: \"plat\" is no body of the scene; did you mean \"plate\"?",
    ":9:34: solids[1].clamped_to: \"gate\" is absent for a time; such a body holds no solid",
    ":11:34: solids[2].clamped_to: \"knife\" is a blade, which cuts solids; such a body holds no solid",
    "solids[3].clamped_to: is nothing that this model knows",
    ":15:44: solids[4].clamped_to[1]: \"gates\" is no body of the scene; did you mean \"gate\"?",
    ":15:53: solids[4].clamped_to[2]: \"gate\" is absent for a time; such a body holds no solid",
    ":15:61: solids[4].clamped_to[3]: \"plate\" is named twice",
    ":17:34: solids[5].clamped_to: is empty, must be a name or a list of names",
    ":19:34: solids[6].clamped_to: is a number, must be a name or a list of names",
    ":21:34: solids[7].clamped_to: is not usable as a name",
};

static void every_mistake_is_told(void **state)
{
    (void)state;
    expect_mistakes(text, expected, sizeof expected/sizeof *expected);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(every_mistake_is_told) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
