/* Contact of the material with bodies, on the grid: contact.h says what a contact asks for, this puts
   the impulses on the nodes that each particle feels, so that stress and motion know of them. */
#pragma once
#include "core/system.h"
#include "mpm/contact/contact.h"
#include "mpm/cut/cut.h"
#include "mpm/contact/pack.h"

typedef struct mpm_touch {
    tobi_contacts contacts;            /* particles of solids that touch bodies                   */
    const struct mpm_clamp *clamp;     /* what has been done to bodies already: the caller's   */
    mpm_cut *cut;                      /* whose faces push at the same time, NULL = no blades: the caller's */
    int64_t count;                     /* entries: contacts times nodes each feels                */
    uint32_t *node;                    /* place in the nodes' array                               */
    float *weight;                     /* two of each: along the normal, along the surface         */
    int64_t room;
    mpm_packs packs;                   /* the contacts by their nodes                             */
    const mpm_pack_kernels *kernels;   /* the caller's to set                                     */
    mpm_response *response;            /* [nodes], the sums 0 outside of a step                   */
    int64_t node_room;
    tobi_blade_piece *piece;           /* of the present blade's edge                             */
    struct mpm_surroundings *around;   /* [pieces] and what is there; those in material first     */
    int64_t piece_room;
    double cell_mass;                  /* kg of a full cell: the caller's to set                  */
    int64_t edge_first;                /* the first contact of a blade's edge: they are the last  */
    int ways;                          /* velocities that a node may have: entries of an edge there */
    tobi_contact_work work;            /* J, of the last step                                     */
    tobi_float4 *push, *moving;        /* [contacts][2] see mpm_pack_view                         */
    int64_t push_room;
    double far;                        /* m, largest shift of a particle in the last step         */
} mpm_touch;

/* Changes the nodes' velocities, and particles' positions where they overlap a body. s->info.contacts: those
   that push; t->far: the largest shift, m. drift: as tobi_contact_begin wants it. */
tobi_status mpm_touch_bodies(mpm_touch *t, tobi_system *s, const mpm_grid *g, const mpm_view *v,
                             const tobi_contact_step *step, double drift, tobi_error *err);
void mpm_touch_free(mpm_touch *t);
