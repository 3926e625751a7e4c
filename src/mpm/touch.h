/* Contact of the material with bodies, on the grid: core/contact.h says what a contact asks for, this puts
   the impulses on the nodes that each particle feels, so that stress and motion know of them. */
#pragma once
#include "core/simulation.h"
#include "mpm/cut.h"

typedef struct mpm_touch {
    mpm_cut *cut;                      /* whose faces push at the same time, NULL = no blades: the caller's */
    int64_t count;                     /* entries: contacts times nodes each feels                */
    uint32_t *node;                    /* place in the nodes' array                               */
    float *weight;
    /* The entries by node, so that every node is changed by one thread, in one order. */
    uint32_t *touched;                 /* places of the nodes that have any                       */
    int64_t *begin;                    /* of the entries of each touched node                     */
    float *inverse;                    /* 1/kg, of its mass                                       */
    int32_t *owner;                    /* the contact of each, and its weight                     */
    float *share;
    int64_t touched_count, room;
    float *crowd;                      /* [nodes] sum of the contacts' weights over the mass, 1/kg */
    int32_t *slot;                     /* [nodes] scratch of the sort, else 0                     */
    int64_t node_room;
    uint32_t *key, *key_scratch;       /* scratch of the sort of many entries                     */
    int32_t *order, *order_scratch;
    int64_t *histogram, sort_room;
    tobi_blade_piece *piece;           /* of the present blade's edge                             */
    struct mpm_surroundings *around;   /* [pieces] and what is there; those in material first     */
    int64_t piece_room;
    double cell_mass;                  /* kg of a full cell: the caller's to set                  */
    int64_t edge_first;                /* the first contact of a blade's edge: they are the last  */
    tobi_contact_work work;            /* J, of the last step                                     */
    tobi_float4 *push;                 /* N s, what each contact changed last, close together     */
    int64_t push_room;
    double far;                        /* m, largest shift of a particle in the last step         */
} mpm_touch;

/* Changes the nodes' velocities, and particles' positions where they overlap a body. s->info.contacts: those
   that push; t->far: the largest shift, m. drift: as tobi_contact_begin wants it. */
tobi_status mpm_touch_bodies(mpm_touch *t, tobi_simulation *s, const mpm_grid *g, const mpm_view *v,
                             const tobi_contact_step *step, double drift, tobi_error *err);
void mpm_touch_free(mpm_touch *t);
