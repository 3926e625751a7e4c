/* The list of methods. A test adds one of its own by a list that includes this one (TOBI_METHODS). */
#include "world/methods.h"
#include <string.h>

#ifndef TOBI_METHODS
#define TOBI_METHODS "world/methods.def"
#endif

#define METHOD(name) extern const tobi_method tobi_##name;
#include TOBI_METHODS
#undef METHOD

static const tobi_method *const methods[] = {
#define METHOD(name) &tobi_##name,
#include TOBI_METHODS
#undef METHOD
};

const tobi_method *tobi_method_at(int index)
{
    return index >= 0 && index < (int)(sizeof methods/sizeof *methods) ? methods[index] : NULL;
}

const tobi_method *tobi_method_find(const char *name)
{
    for (size_t k = 0; name && k < sizeof methods/sizeof *methods; k++)
        if (strcmp(methods[k]->name, name) == 0) return methods[k];
    return NULL;
}
