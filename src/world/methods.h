/* The list of methods (methods.def): adding one is a room or a file, and a line there. */
#pragma once
#include "core/system.h"

/* Methods by index, NULL past the end; by name, NULL if there is none. */
const tobi_method *tobi_method_at(int index);
const tobi_method *tobi_method_find(const char *name);
