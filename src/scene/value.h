/* One value of a scene, by its row of a parameter table. */
#pragma once
#include "scene/bind.h"

/* What the binding of one value needs to know. */
typedef struct tobi_slot {
    const tobi_binder *binder;
    const tobi_param *row;
    const tobi_place *place;
    json_t *value;
    void *member;
} tobi_slot;

/* Writes the member, or leaves it and adds a mistake to the report of the binder's source. */
void tobi_bind_value(const tobi_slot *s);
