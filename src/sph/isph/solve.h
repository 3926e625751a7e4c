/* The pressure equation of isph: memory for its rows, and the solve. */
#pragma once
#include "core/system.h"
#include "linear/multigrid.h"
#include "sph/boundary/boundary.h"
#include "sph/isph/view.h"
#include "sph/kernels.h"

/* A point of a body's surface: sum of the weights of the particles before it (INFINITY: dry), and of those
   times the hydrostatic pressure from particle to point, Pa, and times the distance from the surface, m, and
   the density over that of the first fluid. */
typedef struct isph_point {
    double weight, hydrostatic, distance;
    uint32_t held;                   /* share of the half space before it with a solid that the body holds, in
                                        units of 1/TOBI_COVERED                                     */
    uint8_t gap, rim;                /* by tobi_boundary_near: what it faces in a gap, what else it is near */
} isph_point;

/* A gap between a body and a side, or other bodies: eq. (12c). */
typedef struct isph_gap {
    double rim;                      /* m2: area of the points around it; 0: there is no gap        */
    double push[6];                  /* m2, m3: force and torque of a pressure of -1 in it          */
} isph_gap;

/* What a body does with pressure: in the order of its velocities, then turns. */
typedef struct isph_body {
    double rest_force[6];            /* N, N m: what is not linear in the particles' pressures      */
    double explicit_change[6];       /* m/s, rad/s: what all but the pressure changes               */
    double expected[6];              /* m/s2, rad/s2: by the pressure of the last step              */
    double taken[6];                 /* m/s2, rad/s2: that the water at its surface was given; 0 of a
                                        body with a motion                                          */
    double added_mass[6][6];         /* kg: of the water between particles and surface              */
    double added_mass_factor[6][6];  /* 1: what of its own acceleration is left with that           */
    double mobility[6][6];           /* 1/kg: acceleration by a force on it, with that              */
    isph_gap gap[TOBI_NEAR_KINDS];
    int gaps;                        /* 1: it has any                                               */
    double gap_rest[3];              /* N: of rest_force, from gaps at sides along their normals    */
} isph_body;

/* What eisph does in place of the solve. */
typedef struct isph_sweeps {
    int count;                       /* 0: solve                                                    */
    int pseudo;                      /* 1: in pseudo-time, 0: Jacobi                                */
} isph_sweeps;

typedef struct isph_solver {
    isph_view view;
    const sph_kernels *kernel;
    tobi_exec *exec;
    tobi_system *system;             /* during a solve                                              */
    const tobi_isph_def *def;
    tobi_multigrid grid;
    void *memory;                    /* all arrays of the view but the entries, and those below     */
    double *scratch, *work;
    double *krylov;                  /* workspace of bicgstab and gmres; cg has `work`              */
    int64_t krylov_rows;             /* room for them                                               */
    int64_t rows;                    /* room for particles                                          */
    int64_t entries;                 /* room for them                                               */
    isph_mirror *mirror;             /* of s->links, see bodies.h                              */
    isph_brief *brief;               /* of each, behind one of none                                 */
    int64_t mirrors;                 /* room for them                                               */
    int64_t groups;                  /* of images, that are in use                                  */
    int corners;                     /* 1: those of corners, further faces, follow all of the entries */
    int pockets;                     /* 1: closed pockets were found once, each solve looks for them */
    uint8_t *pocket;                 /* of each row, see pockets.c                             */
    int64_t pocket_rows[TOBI_SUMS];  /* of each pocket                                              */
    isph_sweeps sweeps;
    int coupled;                     /* 1: bodies move by forces                                    */
    isph_coupling *coupling;         /* of s->links, see forces.h                              */
    isph_point *point;               /* of all bodies                                               */
    isph_body *body;
    int64_t couplings, points;       /* room for them                                               */
    int bodies;
} isph_solver;

/* The constants of the system; def must live as long. Memory is made when it is first bound. */
void isph_solver_begin(isph_solver *m, tobi_system *s, const tobi_isph_def *def);
/* Points the view at the particles and the list as they are now; makes room where there are more. */
tobi_status isph_solver_bind(isph_solver *m, tobi_system *s, tobi_error *err);
/* Assembles and solves as def says; particles.pressure is the start. May be called again. */
tobi_linear_report isph_solver_run(isph_solver *m, tobi_system *s);
/* Then: makes the solution the pressure of the particles; the scales in their records are lost. */
void isph_solver_store(isph_solver *m);
/* Bytes that will be allocated; def NULL: without room for other solvers than sweeps. What is. */
int64_t isph_solver_estimate(const tobi_isph_def *def, const tobi_system_plan *plan);
void isph_solver_account(const isph_solver *m, tobi_account *a);
void isph_solver_free(isph_solver *m);
