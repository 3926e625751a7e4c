/* Mistakes in the lines, openings and views of a scene, each with its place. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <string.h>
#include "mistakes.h"

#define PATCH "\"centre\": [0, 0, 0], \"normal\": [1, 0, 0] }"

static const char text[] =
    "{ \"domain\": { \"min\": [0, 0, 0], \"max\": [1, 1, 1] }, \"spacing\": 0.1, \"end_time\": 1,"
    "  \"fluids\": [ { \"name\": \"water\","
    "    \"fill\": [ { \"box\": { \"min\": [0, 0, 0], \"max\": [1, 1, 0.5] } } ] } ],"
    "  \"bodies\": [ { \"name\": \"pier\", \"box\": { \"min\": [0, 0, 0], \"max\": [0.2, 1, 1] } },"
    "    { \"name\": \"boat\", \"box\": { \"min\": [0.4, 0, 0], \"max\": [1, 1, 1] },"
    "      \"dynamics\": \"free\" } ],"
    "  \"lines\": [ { \"name\": \"a\", \"body\": \"pier\", \"to_body\": \"ship\","
    "      \"kind\": \"catenary\", \"damping\": 1, \"stiffness\": 1,"
    "      \"point\": [0, 0, 0], \"to\": [1, 1, 1] },"
    "    { \"name\": \"a\", \"body\": \"boat\", \"to_body\": \"boat\", \"weight\": 1, \"rests\": true,"
    "      \"stiffness\": 1, \"point\": [0, 0, 0], \"to\": [1, 1, 1] },"
    "    { \"name\": \"b\", \"body\": \"raft\", \"stiffness\": 1,"
    "      \"point\": [0, 0, 0], \"to\": [1, 1, 1] } ],"
    "  \"inlets\": [ { \"name\": \"a\", " PATCH ", { \"name\": \"b\", " PATCH ","
    "    { \"name\": \"b\", " PATCH " ],"
    "  \"outlets\": [ { \"name\": \"a\", " PATCH ", { \"name\": \"a\", " PATCH " ],"
    "  \"output\": { \"views\": [ { \"name\": \"frame\" },"
    "    { \"name\": \"v\", \"picture\": { \"field\": \"temperature\" } },"
    "    { \"name\": \"v\", \"picture\": { \"field_of\": \"solids\" } } ] } }";

static const char *const expected[] = {
    "inlets[2].name: \"b\" is already the name of inlets[1]",
    "outlets[1].name: \"a\" is already the name of outlets[0]",
    "lines[0].body: \"pier\" is prescribed; a line holds a free or controlled body",
    "lines[0].to_body: \"ship\" is no body of the scene",
    "lines[0].weight: is 0 N/m, a catenary has a weight",
    "lines[0].damping: is of springs and ropes",
    "lines[1].name: \"a\" is already the name of lines[0]",
    "lines[1].to_body: is the body at the other end too",
    "lines[1].weight: is of a catenary",
    "lines[1].rests: is of a catenary",
    "lines[2].body: \"raft\" is no body of the scene",
    "output.views[0].name: is \"frame\", the name of the output's own pictures",
    "output.views[1].picture.field: is \"temperature\", and the scene has none; scalars are to have it",
    "output.views[2].picture.field_of: is \"solids\", but the scene has none",
    "output.views[2].name: \"v\" is the name of views[1] too",
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
