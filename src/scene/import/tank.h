/* Settings of the tank program (an ISPH program of C++): setting.json names one file per object. What each
   key means was read in that program: https://github.com/tomoakihirakawa/cpp. */
#pragma once
#include "scene/import/import.h"

typedef struct tobi_tank_setting {
    double spacing, support, max_dt, end_time, level;
    int end_step, order;
    const char *directory;
} tobi_tank_setting;

typedef struct tobi_tank_object { const char *name, *type, *file; double location[3]; } tobi_tank_object;

/* tank_keys.c: the tables of keys. */
extern const tobi_old_section tobi_tank_setting_section, tobi_tank_object_section;
/* The remark on a key that the tank program passes over ("velocity", "density"), NULL if none is known. */
const char *tobi_tank_passed_over(const char *key);

/* What a mesh encloses, m. */
typedef struct tobi_tank_shape {
    double low[3], high[3];            /* of the whole mesh                                          */
    double cavity_low[3], cavity_high[3];
    int box;                           /* 1: its inside is the whole box                             */
    int tank;                          /* 1: a box less one box, the cavity                          */
    int open;                          /* 1: the cavity reaches the top                              */
} tobi_tank_shape;
/* tank_shape.c. Fails where the mesh cannot be read or is not closed. */
tobi_status tobi_tank_look(const char *mesh, tobi_tank_shape *shape, tobi_error *err);

/* tank_find.c: the absolute path of the mesh that `path`, of another machine, names; NULL if it is
   nowhere, and then *places lists where it was looked for (NULL: no memory). Both owned by the caller. */
char *tobi_tank_find(const char *directory, const char *path, char **places);
/* The path with slashes for the backslashes of Windows; owned by the caller, NULL without memory. */
char *tobi_tank_slashes(const char *path);
