/* The inside of what moves the bodies, shared by dynamics.c and warm.c. */
#pragma once
#include "rigid/broad.h"
#include "rigid/dynamics.h"

struct tobi_dynamics_state {
    tobi_body *bodies;
    int count;
    tobi_rigid_world world;
    tobi_shape *shapes;
    tobi_broad broad;
    double thinnest;             /* m, the least thickness of all bodies that can be touched */
    tobi_touch_list contacts, before;
    tobi_touch_list *part;     /* [threads] */
    tobi_solver solver;
};
