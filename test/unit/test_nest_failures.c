/* Nests without memory: the n-th allocation fails while they are made, recorded, drawn or stepped. Nothing
   crashes, and the failure is told; the address sanitizer finds what a failure leaves. */
#include "calls.h"
#include "failing_memory.h"
#include "nest_rig.h"
#include "own_folder.h"

static const char text[] =
    "{\"method\": \"%s\", \"dimension\": 2, \"domain\": {\"min\": [0, 0], \"max\": [0.3, 0.2]},"
    " \"spacing\": 0.02, \"end_time\": 1, \"threads\": 1, \"fluids\": [{\"name\": \"water\", \"fill\": "
    "[{\"box\": {\"min\": [0, 0], \"max\": [0.12, 0.16]}}]}],"
    " \"bodies\": [{\"name\": \"ball\", \"box\": {\"min\": [0.04, 0.04], \"max\": [0.1, 0.1]}, "
    "\"dynamics\": \"free\"}],"
    " \"nests\": [{\"name\": \"front\", \"box\": {\"min\": [0.1, 0], \"max\": [0.3, 0.2]},"
    "             \"feedback\": true}],"
    " \"output\": {\"interval\": 0.01, \"frames\": true, \"picture\": {\"width\": 16, \"height\": 16, "
    "\"samples\": 1}}}";

static nest_rig make(const char *method)
{
    char scene[2000];
    nest_rig a;
    snprintf(scene, sizeof scene, text, method);
    OK(nest_rig_build(scene, &a, &err));
    return a;
}

static tobi_status record(nest_rig *a, tobi_error *err)
{
    TOBI_TRY(tobi_nests_create(a->scene, a->world, &a->nests, err));
    TOBI_TRY(tobi_nests_prepare(a->nests, "run", TOBI_NESTS_REPLACE, err));
    TOBI_TRY(tobi_run_create(a->world, tobi_scene_output_def(a->scene), "run", 1, NULL, &a->run, err));
    return tobi_nests_record(a->nests, a->run, "run", TOBI_NESTS_REPLACE, err);
}

static tobi_status step(nest_rig *a, tobi_error *err)
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
        nest_rig a = make("isph");
        tobi_error why = { 0 };
        allocations = 0;
        fail_at = n;
        const tobi_status status = record(&a, &why);
        left = allocations >= n;
        fail_at = 0;
        if (status != TOBI_OK && !why.text[0]) fail_msg("allocation %ld: status %d, no word", n, (int)status);
        nest_rig_drop(&a);
    }
}

static void stepping(void **state)
{
    static const char *const methods[] = { "isph", "dfsph" };
    (void)state;
    for (int m = 0; m < 2; m++) {
        int left = 1, failed = 0;
        for (long n = 1; left; n += 1 + n/20) {
            nest_rig a = make(methods[m]);
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
            nest_rig_drop(&a);
        }
        assert_true(failed > 3);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(making), cmocka_unit_test(stepping) };
    return cmocka_run_group_tests(tests, enter_own_folder, leave_own_folder);
}
