/* What may not be combined in a world, said once: for tobi_world_create, which tells the first breach, and
   for scenes, which tell all, each at its key. */
#pragma once
#include "base/error.h"
#include "tobiuo/types.h"

typedef struct tobi_rules {
    /* path: the key in a scene, "domain.walls.x"; why: a status, and what is wrong with its value. */
    void (*tell)(void *user, const char *path, const tobi_error *why);
    void *user;
    int corners;       /* 1: the corners of the domain are numbers to rely on                  */
    int numbers;       /* 1: so are all others                                                  */
} tobi_rules;

/* method_def: the parameters of d->method, NULL = not known; rules that need a method do nothing where there
   is none of that name. */
void tobi_rules_world(const tobi_rules *r, const tobi_world_def *d, const void *method_def);
