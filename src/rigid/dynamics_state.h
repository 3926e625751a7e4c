/* The inside of what moves the bodies, shared by dynamics.c, notes.c and warm.c. */
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

/* Notes for tobi_rigid_start. TOBI_INVALID in words where overlaps are deeper than contact sees. notes.c */
tobi_status tobi_dynamics_note(tobi_dynamics_state *d, char *notes, size_t room, tobi_error *err);
/* Adds the contacts of a body with sides and planes. */
void tobi_dynamics_touch_planes(const tobi_dynamics_state *d, int body, double margin, tobi_touch_list *out);
