/* Makes a Lua text answer for its loops: every place where control can come round again (loop
   bodies, function bodies, jumps) gets a call that counts and stops at a limit. */
#pragma once
#include "base/error.h"

/* Name of the counting function the guarded text calls; a script may not use it. */
#define TOBI_SCRIPT_TICK "tick__"

/* Returns the guarded copy of a Lua text (malloc, caller frees) with the same line numbers. NULL
   with err set when memory is short or the text uses the reserved name. */
char *tobi_script_guard(const char *text, size_t length, tobi_error *err);
