/* Taking back a step that the caller stops within: what it may have changed by then, as it was before. */
#pragma once
#include "core/system.h"
#include "sph/reference_pressure.h"

enum { SPH_UNDO_MEMORY = 8, SPH_UNDO_FIELDS = 8 };

typedef struct sph_undo {
    double memory[SPH_UNDO_MEMORY];             /* of the method                                        */
    double dt, gravity[3], body_speed;
    tobi_reference reference;
    tobi_step_info info;
    struct sph_undo_body *body;                 /* [body_count], owned                                  */
    int64_t rows;                               /* that the copies have room for                        */
    void *field[SPH_UNDO_FIELDS];               /* copies of particle fields, owned; NULL = not changed */
    int kept;                                   /* 1: they are of this step                             */
} sph_undo;

/* Before anything changes. memory: n doubles of the method. Without a tobi_stop_fn nothing is kept. */
tobi_status sph_undo_begin(sph_undo *u, const tobi_system *s, const double *memory, int n,
                           tobi_error *err);
/* After the first sort of the step, which changes the order of particles and nothing else. all: every
   field of the state, for steps that move particles before they are sure to end. */
tobi_status sph_undo_keep(sph_undo *u, tobi_system *s, int all, tobi_error *err);
/* Takes the step back; not after positions have advanced, unless all was kept. */
void sph_undo_restore(const sph_undo *u, tobi_system *s, double *memory, int n);
/* Of a particle in the first step, when it keeps most; before there is a state. */
int64_t sph_undo_row_bytes(const tobi_system *s);
/* Allocated. */
int64_t sph_undo_bytes(const sph_undo *u, const tobi_system *s);
void sph_undo_free(sph_undo *u);
