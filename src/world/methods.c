#include "world/methods.h"
#include "mpm/mlsmpm.h"
#include "sph/dfsph.h"
#include "sph/isph.h"
#include "sph/wcsph.h"
#include <string.h>

static const tobi_method *const methods[] = {
    &tobi_dfsph,
    &tobi_wcsph,
    &tobi_isph,
    &tobi_mlsmpm,
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
