/* Mistakes in the joints between bodies of a scene, each with its place. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <string.h>
#include "mistakes.h"

static const char text[] =
    "{ \"domain\": { \"min\": [0, 0, 0], \"max\": [1, 1, 1] }, \"spacing\": 0.1, \"end_time\": 1,"
    "  \"fluids\": [ { \"name\": \"water\","
    "    \"fill\": [ { \"box\": { \"min\": [0, 0, 0], \"max\": [1, 1, 0.5] } } ] } ],"
    "  \"bodies\": [ { \"name\": \"pier\", \"box\": { \"min\": [0, 0, 0], \"max\": [0.2, 1, 1] } },"
    "    { \"name\": \"gate\", \"box\": { \"min\": [0.2, 0, 0], \"max\": [0.3, 1, 1] },"
    "      \"absent\": { \"from\": 0.5 } },\n"
    "    { \"name\": \"boat\", \"box\": { \"min\": [0.4, 0, 0], \"max\": [1, 1, 1] },"
    "      \"dynamics\": \"free\" } ],\n"
    "  \"joints\": [ { \"name\": \"a\", \"body\": \"pier\", \"to_body\": \"ship\","
    "      \"point\": [0, 0, 0], \"axis\": [1, 1, 1] },\n"
    "    { \"name\": \"a\", \"body\": \"boat\", \"to_body\": \"boat\", \"kind\": \"ball\","
    "      \"point\": [0, 0, 0], \"axis\": [1, 1, 1], \"damping\": 1, \"rest\": 5 },\n"
    "    { \"name\": \"b\", \"body\": \"raft\", \"point\": [0, 0, 0] },\n"
    "    { \"name\": \"c\", \"body\": \"boat\", \"to_body\": \"gate\", \"kind\": \"slyde\","
    "      \"point\": [0, 0, 0] },\n"
    "    { \"name\": \"d\", \"to_body\": \"pier\", \"axes\": [0, 0, 1] } ] }";

static const char *const expected[] = {
    ":3:38: joints[0].body: \"pier\" is prescribed; a joint holds a free or controlled body, and may go to a",
    "joints[0].to_body: \"ship\" is no body of the scene",
    "joints[1].name: \"a\" is already the name of joints[0]",
    "joints[1].to_body: is the body at the other side too",
    "joints[1].axis: is of a hinge or slide, a ball joint has none",
    "joints[1].damping: is of a hinge or slide, a ball joint has none",
    "joints[1].rest: is of a spring, which needs a stiffness",
    "joints[2].body: \"raft\" is no body of the scene",
    ":5:5: joints[2]: must have an axis, or be of kind ball",
    "joints[3].to_body: \"gate\" is absent at times; a joint holds bodies that stay",
    "joints[3].kind: ",
    "joints[3]: must have an axis",
    "joints[4].body: is missing",
    "joints[4].point: is missing",
    "joints[4].axes: ",
    "joints[4]: must have an axis",
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
