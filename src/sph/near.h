/* The fluid particles near bodies and what they see of them. */
#pragma once
#include "core/body.h"
#include "core/cells.h"
#include "sph/couple.k.h"

typedef struct tobi_near_bodies {
    tobi_near_entry *entry;
    int64_t count, capacity;
    int64_t contacts;         /* particles pushed out in this step                                */
    int64_t cut_pairs;        /* fluid pairs cut because a body lies between                      */
    int64_t *block_count;     /* entries per block of particles, scratch of the search            */
    int64_t block_capacity;
    int32_t *bin_start, *bin_item;   /* points of one body by cell of width h                     */
    int64_t bin_capacity, item_capacity;
    double (*answer)[6];      /* of each body, sph/couple.k.h                                    */
    int64_t answer_capacity;
    int bins[3];
    double bin_lower[3], bin_width;
} tobi_near_bodies;

struct tobi_system;
/* Finds the entries at the bodies' present pose and velocities, writes particles.near. */
tobi_status tobi_near_find(struct tobi_system *s, tobi_error *err);
/* Replaces neighbours that lie behind a body by the particle itself in the list. */
void tobi_near_cut_pairs(struct tobi_system *s);
/* Writes particles.beside, if there is one. After cutting pairs. */
void tobi_near_mark_beside(struct tobi_system *s);
/* Adds gradients, wall fluxes and shares to particles.wall and particles.density (which hold the
 * planes' part). */
void tobi_near_add_gradients(struct tobi_system *s);
/* Adds dt times lift and no-slip friction of the bodies to the velocities. */
void tobi_near_add_forces(struct tobi_system *s);
/* Moves the particles with `beside` by dt^2 accel, a tenth of a spacing at most and not into bodies or sides;
 * velocities stay. */
void tobi_near_settle(struct tobi_system *s);
/* Turns the surface normals of particles nearer than 1.5 spacings to the bodies' angles of contact. */
void tobi_near_contact(struct tobi_system *s);
/* Force and torque on one body by lift, friction and surface tension: all that does not wait for pressure. */
void tobi_near_known_forces(struct tobi_system *s, int body, double force[6]);
/* Forces and torques on every body of the pressure and the friction of this step. */
void tobi_near_body_forces(struct tobi_system *s);
void tobi_near_free(tobi_near_bodies *near);
