/* Scene text: JSON with comments, checked against the tables. What follows a NUL byte is an override
   as on the command line. A scene that passes must write itself so that it reads back the same. */
#include "target.h"
#include "scene/scene.h"

static char *copy_text(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1);
    PROMISE(text);
    if (size) memcpy(text, data, size);
    text[size] = '\0';
    return text;
}

/* Any world that is small enough is built and started, too. */
static void build_small(tobi_scene *scene)
{
    tobi_error err = { 0 };
    tobi_world *world = NULL;
    int64_t fluid, body, bytes;
    if (!passed(tobi_scene_build(scene, &world, &err), &err)) return;
    if (passed(tobi_world_estimate(world, &fluid, &body, &bytes, &err), &err) &&
        fluid + body < 3000 && bytes < 1 << 26 && passed(tobi_world_start(world, &err), &err))
        passed(tobi_world_step(world, 1e-3, NULL, &err), &err);
    tobi_world_destroy(world);
}

static void read_back(const tobi_scene *scene)
{
    tobi_error err = { 0 };
    tobi_scene *again = NULL;
    char *text = tobi_scene_resolved(scene);
    PROMISE(text);
    tobi_status status = tobi_scene_parse("scene.json", text, strlen(text), NULL, &again, NULL, &err);
    if (status != TOBI_OK) fprintf(stderr, "%s\n%s\n", err.text, text);
    PROMISE(status == TOBI_OK);
    char *twice = tobi_scene_resolved(again);
    PROMISE(twice);
    if (strcmp(text, twice) != 0) fprintf(stderr, "%s\n%s\n", text, twice);
    PROMISE(strcmp(text, twice) == 0);
    free(twice);
    free(text);
    tobi_scene_free(again);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const uint8_t *cut = size ? memchr(data, 0, size) : NULL;
    size_t scene_size = cut ? (size_t)(cut - data) : size;
    char *text = copy_text(data, scene_size);
    char *set = cut ? copy_text(cut + 1, size - scene_size - 1) : NULL;
    const char *overrides[] = { set, NULL };
    tobi_scene *scene = NULL;
    tobi_report *report = NULL;
    tobi_error err = { 0 };
    tobi_status status = tobi_scene_parse("scene.json", text, scene_size, set ? overrides : NULL, &scene,
                                          &report, &err);
    PROMISE(!scene == !passed(status, &err));
    if (status == TOBI_INVALID) PROMISE(tobi_report_count(report) > 0);
    for (int k = 0; k < tobi_report_count(report); k++) PROMISE(tobi_report_line(report, k)[0]);
    if (scene) {
        read_back(scene);
        build_small(scene);
    }
    tobi_report_free(report);
    tobi_scene_free(scene);
    free(set);
    free(text);
    return 0;
}
