/* A folder of its own for a test that writes: what it leaves goes with the folder, wherever the test was
   started. For cmocka_run_group_tests(tests, enter_own_folder, leave_own_folder). */
#pragma once
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static inline int enter_own_folder(void **state)
{
    static char folder[] = "/tmp/tobiuo_test_XXXXXX";
    *state = folder;
    /* tests that become another user for a call look in, too */
    return !mkdtemp(folder) || chmod(folder, 0755) || chdir(folder);
}

static inline int leave_own_folder(void **state)
{
    char command[100];
    snprintf(command, sizeof command, "rm -rf '%s'", (char *)*state);
    return chdir("/") || system(command);
}
