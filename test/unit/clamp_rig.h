/* A soft solid that a body holds, for tests of clamps: the two definitions, and the world of them. */
#pragma once
#include "solid_rig.h"

typedef struct setup { solid_setup solid; tobi_body_def body; } setup;

static inline tobi_world *make_world(const setup *s)
{
    tobi_world *world = solid_world(&s->solid);
    OK(tobi_world_add_body(world, &s->body, &err));
    OK(tobi_world_start(world, &err));
    return world;
}
