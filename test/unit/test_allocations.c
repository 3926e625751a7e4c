/* A step allocates nothing once the arrays have grown: the scenes of test/golden, which reach every method.
   Something new may happen at any time and make them grow, so steps are made twice, from a checkpoint, and
   counted the second time. The linker hands the library's calls over (--wrap). Those inside other libraries
   are not seen, and what a user's script allocates is its own. */
#include "calls.h"
#include "tobiuo/scene.h"
#include "world/methods.h"
#include <glob.h>
#include <lua.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { WARM_UP = 20, STEPS = 30 };

static long calls;
static _Thread_local int in_script;

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *old, size_t size);
void *__real_aligned_alloc(size_t alignment, size_t size);
int __real_lua_pcall(lua_State *lua, int arguments, int results, int handler);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *old, size_t size);
void *__wrap_aligned_alloc(size_t alignment, size_t size);
int __wrap_lua_pcall(lua_State *lua, int arguments, int results, int handler);

static void count_call(void) { if (!in_script) __atomic_add_fetch(&calls, 1, __ATOMIC_RELAXED); }
void *__wrap_malloc(size_t size) { count_call(); return __real_malloc(size); }
void *__wrap_calloc(size_t count, size_t size) { count_call(); return __real_calloc(count, size); }
void *__wrap_realloc(void *old, size_t size) { count_call(); return __real_realloc(old, size); }

void *__wrap_aligned_alloc(size_t alignment, size_t size)
{
    count_call();
    return __real_aligned_alloc(alignment, size);
}

int __wrap_lua_pcall(lua_State *lua, int arguments, int results, int handler)
{
    in_script++;
    const int status = __real_lua_pcall(lua, arguments, results, handler);
    in_script--;
    return status;
}

static tobi_world *build(const char *path, tobi_scene **scene)
{
    tobi_world *world;
    OK(tobi_scene_load(path, NULL, scene, NULL, &err));
    OK(tobi_scene_build(*scene, &world, &err));
    OK(tobi_world_start(world, &err));
    return world;
}

static void step(tobi_world *world, int steps)
{
    for (int k = 0; k < steps; k++) OK(tobi_world_step(world, 0, NULL, &err));
}

/* How many calls the steps after the warm-up make. */
static long count_scene(const char *path, int *method)
{
    tobi_scene *scene;
    tobi_world *world = build(path, &scene);
    for (int k = 0; tobi_method_at(k); k++)
        if (strcmp(tobi_method_at(k)->name, tobi_scene_world_def(scene)->method) == 0) method[k]++;
    step(world, WARM_UP);
    OK(tobi_world_save(world, "allocations.h5", &err));
    step(world, STEPS);
    OK(tobi_world_load(world, "allocations.h5", &err));
    remove("allocations.h5");
    step(world, 1);                        /* what has changed since the file was written is made anew */
    const long before = calls;
    step(world, STEPS - 1);
    const long made = calls - before;
    tobi_world_destroy(world);
    tobi_scene_free(scene);
    return made;
}

static void steps_allocate_nothing(void **state)
{
    int method[16] = { 0 };
    long all = 0;
    glob_t found;
    (void)state;
    assert_int_equal(glob(TOBI_SOURCE_DIR "/test/golden/*.json", 0, NULL, &found), 0);
    for (size_t k = 0; k < found.gl_pathc; k++) {
        const long made = count_scene(found.gl_pathv[k], method);
        if (made) print_message("%s: %ld allocations in %d steps\n", found.gl_pathv[k], made, STEPS);
        all += made;
    }
    globfree(&found);
    assert_int_equal(all, 0);
    for (int k = 0; tobi_method_at(k); k++) assert_true(method[k] > 0);
}

static void calls_are_seen(void **state)
{
    (void)state;
    const long before = calls;
    tobi_scene *scene;
    tobi_world *world = build(TOBI_SOURCE_DIR "/test/golden/rigid_pile.json", &scene);
    assert_true(calls > before + 10);
    tobi_world_destroy(world);
    tobi_scene_free(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(calls_are_seen),
        cmocka_unit_test(steps_allocate_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
