/* Nests without memory: the n-th allocation fails while they are made, recorded or stepped. Nothing leaks or
   crashes, and the failure is told. Under the address sanitizer no allocation fails. */
#include "calls.h"
#include "failing_memory.h"
#include "tobiuo/run.h"
#include "tobiuo/scene.h"
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static const char text[] =
    "{\"method\": \"%s\", \"dimension\": 2, \"domain\": {\"min\": [0, 0], \"max\": [0.3, 0.2]},"
    " \"spacing\": 0.02, \"end_time\": 1, \"threads\": 1, \"fluids\": [{\"name\": \"water\", \"fill\": "
    "[{\"box\": {\"min\": [0, 0], \"max\": [0.12, 0.16]}}]}],"
    " \"bodies\": [{\"name\": \"ball\", \"box\": {\"min\": [0.04, 0.04], \"max\": [0.1, 0.1]}, "
    "\"dynamics\": \"free\"}],"
    " \"nests\": [{\"name\": \"front\", \"box\": {\"min\": [0.1, 0], \"max\": [0.3, 0.2]},"
    "             \"feedback\": true}],"
    " \"output\": {\"interval\": 0.01}}";

static char folder[] = "/tmp/tobiuo_nests_XXXXXX";

typedef struct all { tobi_scene *scene; tobi_world *world; tobi_nests *nests; tobi_run *run; } all;

static all make(const char *method)
{
    char scene[2000];
    all a = { 0 };
    snprintf(scene, sizeof scene, text, method);
    OK(tobi_scene_parse("scene.json", scene, strlen(scene), NULL, &a.scene, NULL, &err));
    OK(tobi_scene_build(a.scene, &a.world, &err));
    return a;
}

static void drop(all *a)
{
    tobi_run_free(a->run);
    tobi_nests_free(a->nests);
    tobi_world_destroy(a->world);
    tobi_scene_free(a->scene);
}

static tobi_status record(all *a, tobi_error *err)
{
    TOBI_TRY(tobi_nests_create(a->scene, a->world, &a->nests, err));
    TOBI_TRY(tobi_nests_prepare(a->nests, folder, TOBI_NESTS_REPLACE, err));
    TOBI_TRY(tobi_run_create(a->world, tobi_scene_output_def(a->scene), folder, 1, NULL, &a->run, err));
    return tobi_nests_record(a->nests, a->run, folder, TOBI_NESTS_REPLACE, err);
}

static tobi_status step(all *a, tobi_error *err)
{
    for (int k = 0; k < 12; k++) {
        TOBI_TRY(tobi_world_step_to(a->world, 0.2, err));
        TOBI_TRY(tobi_nests_follow(a->nests, err));
    }
    return TOBI_OK;
}

/* Few steps between two that fail make a test of seconds. */
static void making(void **state)
{
    int left = 1;
    (void)state;
    for (long n = 1; left; n += 1 + n/40) {
        all a = make("isph");
        tobi_error why = { 0 };
        allocations = 0;
        fail_at = n;
        const tobi_status status = record(&a, &why);
        left = allocations >= n;
        fail_at = 0;
        if (status != TOBI_OK && !why.text[0]) fail_msg("allocation %ld: status %d, no word", n, (int)status);
        drop(&a);
    }
}

static void stepping(void **state)
{
    static const char *const methods[] = { "isph", "dfsph" };
    (void)state;
    for (int m = 0; m < 2; m++) {
        int left = 1, failed = 0;
        for (long n = 1; left; n += 1 + n/20) {
            all a = make(methods[m]);
            tobi_error why = { 0 };
            OK(tobi_nests_create(a.scene, a.world, &a.nests, &err));
            OK(tobi_nests_follow(a.nests, &err));
            allocations = 0;
            fail_at = n;
            const tobi_status status = step(&a, &why);
            left = allocations >= n;
            fail_at = 0;
            failed += status != TOBI_OK;
            if (status != TOBI_OK && status != TOBI_NO_MEMORY) fail_msg("allocation %ld: %s", n, why.text);
            drop(&a);
        }
        assert_true(!ALLOCATIONS_FAIL || failed > 3);
    }
}

static int enter(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

static int leave(void **state)
{
    char command[300];
    (void)state;
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return system(command);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(making), cmocka_unit_test(stepping) };
    return cmocka_run_group_tests(tests, enter, leave);
}
