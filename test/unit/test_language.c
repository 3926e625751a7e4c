/* The language of messages: of the whole process, looked up where a text is filled in. */
#include "mistakes.h"
#include "scene_text.h"
#include "tobiuo/motion.h"
#include "tobiuo/tobiuo.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static void choose(const char *name) { assert_int_equal(tobi_set_language(name, NULL), TOBI_OK); }

static void test_wrong_names_are_refused(void **state)
{
    (void)state;
    tobi_error err = { 0 };
    choose("ja");
    assert_int_equal(tobi_set_language("en_GB", &err), TOBI_INVALID);
    assert_string_equal(err.text, "言語'en_GB'はない。使えるのはenとjaである");
    choose("en");
    assert_int_equal(tobi_set_language("", &err), TOBI_INVALID);
    assert_string_equal(err.text, "there is no language ''; allowed are en and ja");
    assert_int_equal(tobi_set_language(NULL, &err), TOBI_INVALID);
}

/* The place and the values of a mistake are those of English. */
static void test_mistakes_of_a_scene(void **state)
{
    (void)state;
    static const char scene[] =
        "{ \"domain\": { \"min\": [0, 0, 0], \"max\": [1, 1, 1] }, \"spacing\": -1,\n"
        "  \"fluids\": [ { \"densty\": 1, \"fill\": [ { \"box\": { \"min\": [0, 0, 0], "
        "\"max\": [2, 1, 1] } } ] } ] }";
    static const char *const english[] = {
        "s.json:1:64: spacing: is -1, allowed is 1e-7 to 1e5 m",
        "s.json:2:17: fluids[0].densty: unknown key; did you mean \"density\"?",
        "s.json:2:49: fluids[0].fill[0].box: reaches from 0 to 2 m in x, the domain only from 0 to 1 m",
        "s.json:1:1: end_time: is missing (0 to 1e9 s): Simulated time",
        "s.json:2:15: fluids[0].name: is missing: Name of the fluid",
    };
    static const char *const japanese[] = {
        "s.json:1:64: spacing: -1である。許容範囲は1e-7～1e5 m",
        "s.json:2:17: fluids[0].densty: 未知のキーである。もしかして\"density\"？",
        "s.json:2:49: fluids[0].fill[0].box: x方向の範囲が0～2 mである。計算領域の範囲は0～1 m",
        "s.json:1:1: end_time: 指定がない（0～1e9 s）：計算を終える",
        "s.json:2:15: fluids[0].name: 指定がない：流体の名前",
    };
    expect_mistakes(scene, english, 5);
    choose("ja");
    expect_mistakes(scene, japanese, 5);
    choose("en");
    expect_mistakes(scene, english, 5);
}

static void test_errors_with_values_in_another_order(void **state)
{
    (void)state;
    tobi_error err;
    choose("ja");
    tobi_fail(&err, TOBI_INVALID, "the domain has %g cells along %c, allowed are 1e8", 2e9, 'x');
    assert_string_equal(err.text, "計算領域のx方向のセルが2e+09個である。許容範囲は1e8まで");
    tobi_fail(&err, TOBI_INVALID, "no Japanese for %d", 5);
    assert_string_equal(err.text, "no Japanese for 5");
    assert_string_equal(tobi_reason(ENOSPC), "ディスクに空きがない");
    choose("en");
    assert_string_equal(tobi_reason(ENOSPC), "No space left on device");
}

/* What other libraries say: of JSON by what they can say, of Lua by our own side of it. */
static void test_other_languages(void **state)
{
    (void)state;
    static const char *const wrong[][2] = {
        { "{ \"spacing\": 0.1, \"cfl\" 0.2 }", "s.json:1:27: JSONとして正しくない：':'が必要である（'0.2'の付近）" },
        { "{ \"spacing\": 0.1, }", "s.json:1:19: JSONとして正しくない：文字列または'}'が必要である（'}'の付近）。"
          "その前のコンマを取り除く" },
        { "{ \"spacing\": 0.1", "s.json:1:16: JSONとして正しくない：'}'が必要である（ファイルの終わり）" },
    };
    choose("ja");
    for (size_t k = 0; k < sizeof wrong/sizeof *wrong; k++) expect_mistakes(wrong[k][0], &wrong[k][1], 1);
    tobi_motion *motion = NULL;
    tobi_error err;
    FILE *file = fopen("wrong.lua", "w");
    assert_non_null(file);
    fputs("function place(t)\n    return foldd, 0, 0\nend\n", file);
    fclose(file);
    assert_int_equal(tobi_motion_script("wrong.lua", NULL, &motion, &err), TOBI_OK);
    unlink("wrong.lua");
    const double x[1][3] = { { 0, 0, 0 } };
    double moved[1][3];
    assert_int_equal(tobi_motion_positions(motion, 0, 1, x, moved, &err), TOBI_SCRIPT);
    assert_non_null(strstr(err.text, "wrong.lua:2: 未知の名前'foldd'である"));
    tobi_motion_free(motion);
    choose("en");
}

static void test_notes(void **state)
{
    (void)state;
    static const char scene[] =
        "{ \"dimension\": 2, \"domain\": { \"min\": [0, 0], \"max\": [1, 1] },\n"
        "  \"spacing\": 0.1, \"end_time\": 1,\n"
        "  \"fluids\": [ { \"name\": \"water\", \"density\": 1, \"viscosity\": 0,\n"
        "    \"fill\": [ { \"box\": { \"min\": [0, 0], \"max\": [1, 0.5] } } ] } ] }";
    tobi_world *w;
    tobi_error err;
    choose("ja");
    assert_int_equal(start_scene(scene, &w, &err), TOBI_OK);
    assert_string_equal(tobi_world_note(w, 0),
                        "流体 'water': 密度が1 kg/m3で、気体の密度である。水は1000 kg/m3である");
    choose("en");
    assert_non_null(strstr(tobi_world_note(w, 0), "流体"));        /* what was said stays */
    tobi_world_destroy(w);
}

/* Meanings of keys are those of the page of scenes, without what is for a page alone. */
static void test_meanings(void **state)
{
    (void)state;
    char room[TOBI_MEANING];
    static const char name[] = "Name of the fluid, used once in a scene.";
    assert_ptr_equal(tobi_meaning(name, room), name);
    choose("ja");
    assert_string_equal(tobi_meaning(name, room), "流体の名前。シーンの中で重複できない");
    assert_string_equal(tobi_meaning("fluid", room), "流体");              /* of the messages */
    char *topic = tobi_scene_describe("control");
    assert_non_null(topic);
    assert_non_null(strstr(topic, "（スクリプト）"));
    assert_null(strstr(topic, "scripts.ja.md"));
    free(topic);
    choose("en");
}

/* A text that is longer than its room ends with a whole letter. */
static void test_cut_letters(void **state)
{
    (void)state;
    static const char *const cut[][2] = {
        { "", "" }, { "ab", "ab" }, { "a\xe6\xb0\xb4", "a\xe6\xb0\xb4" },
        { "a\xe6\xb0", "a" }, { "a\xe6", "a" }, { "\xe6\xb0", "" }, { "\xc3\xa9", "\xc3\xa9" },
        { "x\xc3", "x" },
        { "\xf0\x9f\x90\x9f", "\xf0\x9f\x90\x9f" }, { "\xf0\x9f\x90", "" } };
    for (size_t k = 0; k < sizeof cut/sizeof *cut; k++) {
        char text[8];
        strcpy(text, cut[k][0]);
        tobi_text_mend(text);
        assert_string_equal(text, cut[k][1]);
    }
    tobi_error err;
    char longer[2100];
    memset(longer, '-', sizeof longer);
    memcpy(longer + sizeof err.text - 3, "\xe6\xb0\xb4", 4);
    tobi_fail(&err, TOBI_INVALID, "%s", longer);
    assert_int_equal(strlen(err.text), sizeof err.text - 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_wrong_names_are_refused),
        cmocka_unit_test(test_mistakes_of_a_scene),
        cmocka_unit_test(test_errors_with_values_in_another_order),
        cmocka_unit_test(test_other_languages),
        cmocka_unit_test(test_notes),
        cmocka_unit_test(test_meanings),
        cmocka_unit_test(test_cut_letters),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
