/* Contact of the material with bodies, on the grid: core/contact.h says what a contact asks for, this puts
   the impulses on the nodes that each particle feels, so that stress and motion know of them. */
#pragma once
#include "core/simulation.h"
#include "mpm/grid.h"

typedef struct mpm_touch {
    int64_t *node;                     /* [contacts][nodes each]: place in the nodes' array       */
    float *weight;                     /* the same                                                */
    float *crowd;                      /* [nodes] sum of the contacts' weights                    */
    int64_t room, node_room;
    double far;                        /* m, largest shift of a particle in the last step         */
} mpm_touch;

/* Changes the nodes' velocities, and particles' positions where they overlap a body. s->info.contacts: those
   that push; t->far: the largest shift, m. */
tobi_status mpm_touch_bodies(mpm_touch *t, tobi_simulation *s, const mpm_grid *g, const mpm_view *v,
                             const tobi_contact_step *step, tobi_error *err);
void mpm_touch_free(mpm_touch *t);
