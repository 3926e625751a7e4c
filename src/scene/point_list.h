/* Points of a plane: lists of pairs in a scene, texts as "0,0 5,0.25" in a definition. */
#pragma once
#include "scene/source.h"
#include <jansson.h>

/* 0 after a mistake. text: owned by the caller; NULL without memory. */
int tobi_point_list_read(tobi_source *source, const tobi_place *place, json_t *value, char **text);
/* A new list; NULL without memory. */
json_t *tobi_point_list_write(const char *text);
