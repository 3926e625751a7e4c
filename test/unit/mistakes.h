/* Scenes with mistakes: each is told once, and nothing else. */
#pragma once
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <string.h>
#include "tobiuo/scene.h"

/* Each of `count` texts stands in one line of the scene's report, which has no other lines. */
static inline void expect_mistakes(const char *scene_text, const char *const *texts, int count)
{
    tobi_scene *scene;
    tobi_report *report;
    tobi_error err = { 0 };
    assert_int_equal(tobi_scene_parse("s.json", scene_text, strlen(scene_text), NULL, &scene, &report, &err),
                     TOBI_INVALID);
    for (int k = 0; k < count; k++) {
        int found = 0;
        for (int i = 0; i < tobi_report_count(report); i++)
            found += strstr(tobi_report_line(report, i), texts[k]) != NULL;
        if (found != 1) fail_msg("told %d times: %s", found, texts[k]);
    }
    assert_int_equal(tobi_report_count(report), count);
    tobi_report_free(report);
}
