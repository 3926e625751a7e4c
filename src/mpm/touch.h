/* Contact of the material with bodies, on the grid: core/contact.h says what a contact asks for, this puts the
   impulses on the nodes that each particle feels, so that stress and motion know of them. */
#pragma once
#include "core/contact.h"
#include "mpm/grid.h"

typedef struct mpm_touch {
    int64_t *node;                     /* [contacts][nodes each]: place in the nodes' array       */
    float *weight;                     /* the same                                                */
    float *crowd;                      /* [nodes] sum of the contacts' weights                    */
    int64_t room, node_room;
} mpm_touch;

/* Changes the nodes' velocities, and particles' positions where they overlap a body. *count: contacts that push;
   *far: the largest shift, m. */
tobi_status mpm_touch_bodies(mpm_touch *t, tobi_contacts *c, tobi_particles *p, tobi_body *bodies, int body_count,
                             const mpm_grid *g, const mpm_view *v, const tobi_contact_step *step, tobi_exec *x,
                             int64_t *count, double *far, tobi_error *err);
void mpm_touch_free(mpm_touch *t);
