/* Calls that must succeed, and calls that must fail in words. `err` is the macros' own:
   OK(tobi_world_start(world, &err)). */
#pragma once
#include "base/error.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#define OK(call)                                                        \
    do {                                                                \
        tobi_error err = { 0 };                                         \
        if ((call) != TOBI_OK) fail_msg("%s: %s", #call, err.text);     \
    } while (0)

/* The call must return this status, and its text must hold these words. */
#define REFUSED(call, expected, words)                                          \
    do {                                                                        \
        tobi_error err = { 0 };                                                 \
        int got = (int)(call);                                                  \
        if (got != (int)(expected) || !strstr(err.text, words))                      \
            fail_msg("%s: status %d, '%s' without '%s'", #call, got, err.text, words); \
    } while (0)
