/* Words with two spellings: either is read, resolved.json has the one of the reference; both in one object
   are refused, and --set finds the one that the scene has. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "scene/spelling.h"
#include "tobiuo/scene.h"

/* A drop of water, beginning in line 3, and the picture of it in line 4. */
static tobi_status parse(const char *fluid, const char *picture, const char *const *overrides,
                         tobi_scene **scene, tobi_report **report)
{
    char text[1000];
    tobi_error err = { 0 };
    snprintf(text, sizeof text, "{ \"domain\": { \"min\": [0, 0, 0], \"max\": [1, 1, 1] },\n"
             "\"spacing\": 0.1, \"end_time\": 1, \"fluids\": [ { \"name\": \"water\",\n"
             "%s } ],\n%s\n}", fluid, picture);
    return tobi_scene_parse("s.json", text, strlen(text), overrides, scene, report, &err);
}

#define DROP(color, centre) "\"" color "\": [1, 2, 3], \"fill\": [ { \"sphere\": { " \
                            "\"" centre "\": [0.5, 0.5, 0.5], \"radius\": 0.2 } } ]"
#define LOOK(map) "\"output\": { \"picture\": { \"field\": \"velocity\", \"map\": \"" map "\" } }"

static char *resolve(const char *fluid, const char *picture, const char *const *overrides)
{
    tobi_scene *scene;
    assert_int_equal(parse(fluid, picture, overrides, &scene, NULL), TOBI_OK);
    char *text = tobi_scene_resolved(scene);
    tobi_scene_free(scene);
    return text;
}

static void either_is_read(void **state)
{
    (void)state;
    const char *const set[] = { "fluids.water.color=[1, 2, 3]", "output.picture.map=grey", NULL };
    char *mine = resolve(DROP("color", "centre"), LOOK("gray"), NULL);
    char *other = resolve(DROP("colour", "center"), LOOK("grey"), NULL);
    char *changed = resolve(DROP("colour", "centre"), LOOK("magma"), set);
    assert_non_null(strstr(mine, "\"color\""));
    assert_non_null(strstr(mine, "\"centre\""));
    assert_non_null(strstr(mine, "\"gray\""));
    assert_string_equal(mine, other);
    assert_string_equal(mine, changed);
    free(mine);
    free(other);
    free(changed);
}

static void check_mistake(const char *fluid, const char *begin)
{
    tobi_scene *scene;
    tobi_report *report;
    assert_int_equal(parse(fluid, LOOK("gray"), NULL, &scene, &report), TOBI_INVALID);
    assert_int_equal(tobi_report_count(report), 1);
    const char *line = tobi_report_line(report, 0);
    if (strncmp(line, begin, strlen(begin)) != 0) fail_msg("%s\ndoes not begin with\n%s", line, begin);
    tobi_report_free(report);
}

static void mistakes_have_their_place(void **state)
{
    (void)state;
    check_mistake("\"colour\": [1, 2, 3],\n" DROP("color", "centre"),
                  "s.json:3:1: fluids[0].colour: is another spelling of \"color\", which is given too");
    check_mistake(DROP("color", "centre") ",\n\"colour\": 3",
                  "s.json:4:1: fluids[0].colour: is another spelling of \"color\", which is given too");
    check_mistake("\"colour\": [1, 2, 300],\n"
                  "\"fill\": [ { \"box\": { \"min\": [0, 0, 0], \"max\": [1, 1, 1] } } ]",
                  "s.json:3:18: fluids[0].colour[2]: is 300, allowed is 0 to 255");
}

static void words_have_one_other_spelling(void **state)
{
    (void)state;
    char other[TOBI_SPELLING];
    assert_int_equal(tobi_spelling_other("core_color", other), 1);
    assert_string_equal(other, "core_colour");
    assert_int_equal(tobi_spelling_other("speed", other), 0);
    char longest[200] = "grey";
    memset(longest + 4, 'x', 100);
    assert_int_equal(tobi_spelling_other(longest, other), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(either_is_read),
        cmocka_unit_test(mistakes_have_their_place),
        cmocka_unit_test(words_have_one_other_spelling),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
