/* The list of methods: adding one is a file and a line here. */
#pragma once
#include "core/system.h"

/* Methods by index, NULL past the end; by name, NULL if there is none. */
const tobi_method *tobi_method_at(int index);
const tobi_method *tobi_method_find(const char *name);
