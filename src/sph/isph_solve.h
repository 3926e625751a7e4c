/* The pressure equation of isph: memory for its rows, and the solve. */
#pragma once
#include "core/system.h"
#include "linear/multigrid.h"
#include "sph/isph_pairs.h"

typedef struct isph_solver {
    isph_view view;
    tobi_exec *exec;
    tobi_simulation *sim;            /* asked whether to stop                                       */
    tobi_multigrid grid;
    void *memory;                    /* all arrays of the view but the entries, and those below     */
    double *pressure, *scratch, *work;
    int64_t entries;                 /* room for them                                               */
    isph_mirror *mirror;             /* of s->near, see isph_bodies.h                               */
    int64_t mirrors;                 /* room for them                                               */
} isph_solver;

/* Room for the system's particles; the grid is made with the first list. */
tobi_status isph_solver_create(isph_solver *m, tobi_system *s, tobi_error *err);
/* Points the view at the particles and the list as they are now. */
tobi_status isph_solver_bind(isph_solver *m, tobi_system *s, tobi_error *err);
/* Assembles and solves; particles.pressure is the start and receives the answer. */
tobi_linear_report isph_solver_run(isph_solver *m, tobi_system *s, const tobi_linear_settings *settings);
/* Bytes allocated. */
int64_t isph_solver_bytes(const isph_solver *m, int64_t particles);
void isph_solver_free(isph_solver *m);
