/* Parameters of the methods, one struct each; see types.h for how definitions are used. */
#ifndef TOBIUO_METHODS_H
#define TOBIUO_METHODS_H

#ifdef __cplusplus
extern "C" {
#endif

/* Parameters of the DFSPH method. */
typedef struct tobi_dfsph_def {
    int    kernel;                    /* tobi_smoothing                                               */
    int    still_water;               /* 1: the pressure that water at rest has is not solved for     */
    double support;                   /* support radius in spacings, 2 to 4; 0 = automatic            */
    double density_tolerance;         /* 1, mean |density error| at which the density solve may stop  */
    double divergence_tolerance;      /* 1, mean |div v| dt at which the divergence solve may stop    */
    double pressure_tolerance;        /* 1, relative residual the divergence solve must reach as well */
    int    density_iterations_min, density_iterations_max;
    int    divergence_iterations_min, divergence_iterations_max;
    double filter;                    /* 1, share of the particle-scale motion taken out per step     */
    double shifting;                  /* 1, strength of particle shifting in flows without a surface  */
} tobi_dfsph_def;

/* Parameters of the WCSPH method. */
typedef struct tobi_wcsph_def {
    int    kernel;                    /* tobi_smoothing                                               */
    int    still_water;               /* 1: water begins at rest, and what rest explains is no pressure */
    double support;                   /* support radius in spacings, 2 to 4; 0 = automatic            */
    double stiffness;                 /* Pa, B of p = B ((rho/rho0)^exponent - 1)                     */
    double exponent;                  /* 1                                                            */
    double damping;                   /* 1, bulk viscosity over density, speed of sound and spacing   */
    double filter;                    /* 1, share of the particle-scale motion taken out per step     */
} tobi_wcsph_def;

/* Choices of isph; docs/isph_choices.md says what each is. */
typedef enum tobi_pressure_gradient {
    TOBI_DIFFERENCE, TOBI_PLAIN_SUM, TOBI_SYMMETRIC_SUM
} tobi_pressure_gradient;
typedef enum tobi_laplacian {
    TOBI_LAPLACIAN_PAIR, TOBI_LAPLACIAN_OWN, TOBI_LAPLACIAN_UNIFORM
} tobi_laplacian;
typedef enum tobi_viscosity_form {
    TOBI_VISCOSITY_PLAIN, TOBI_VISCOSITY_GRADIENT, TOBI_VISCOSITY_FULL
} tobi_viscosity_form;
typedef enum tobi_volume_error {
    TOBI_VOLUME_SUM, TOBI_VOLUME_PREDICTED, TOBI_VOLUME_CONTINUITY
} tobi_volume_error;
typedef enum tobi_surface_rule {
    TOBI_SURFACE_LOSS, TOBI_SURFACE_EIGENVALUE, TOBI_SURFACE_CONE, TOBI_SURFACE_COUNT
} tobi_surface_rule;

/* Parameters of the ISPH method. */
typedef struct tobi_isph_def {
    int    kernel;                    /* tobi_smoothing                                               */
    int    iterations_max;            /* of the pressure solve                                        */
    int    solver;                    /* tobi_krylov                                                  */
    int    restart;                   /* directions that gmres keeps                                  */
    int    preconditioner;            /* tobi_preconditioner                                          */
    int    time_order;                /* of a step, 1 or 2                                            */
    double support;                   /* support radius in spacings, 2 to 4; 0 = automatic            */
    double tolerance;                 /* 1, true relative residual of the pressure equation           */
    double volume_gain;               /* 1, share of the error of volume in the source of pressure    */
    double shifting;                  /* 1, strength of particle shifting                             */
    int    pressure_gradient;         /* tobi_pressure_gradient                                       */
    int    renormalised;              /* 1: gradients of linear pressures are exact                   */
    int    laplacian;                 /* tobi_laplacian, of the pressure                              */
    int    viscosity_form;            /* tobi_viscosity_form                                          */
    int    volume_error;              /* tobi_volume_error: what volume_gain corrects                 */
    int    surface_rule;              /* tobi_surface_rule                                            */
    double surface_height;            /* spacings from the outermost particles up to where p = 0      */
    double filter;                    /* 1, share of the particle-scale motion taken out per step     */
    double xsph;                      /* 1, share of the mean velocity in that of positions           */
} tobi_isph_def;

typedef enum tobi_iteration { TOBI_ITERATION_JACOBI, TOBI_ITERATION_PSEUDO_TIME } tobi_iteration;

typedef struct tobi_eisph_def {
    int    kernel;                    /* tobi_smoothing                                               */
    int    sweeps;                    /* per step; 0 = as many as the step needs                      */
    int    iteration;                 /* tobi_iteration                                               */
    double support;                   /* support radius in spacings, 2 to 4; 0 = automatic            */
    double sound_speed;               /* m/s; 0 = ten times the fastest flow                          */
    double volume_gain;               /* 1, share of the error of volume in the source of pressure    */
    double shifting;                  /* 1, strength of particle shifting                             */
} tobi_eisph_def;

/* Parameters of the MLS-MPM method. */
typedef struct tobi_mlsmpm_def {
    double cell;                      /* grid cell in particle spacings: 2 = 8 particles per cell in 3-D */
    int    transfer;                  /* tobi_transfer                                                */
    double flip;                      /* 1, share of FLIP in the blend with PIC                       */
    int    xpic_order;                /* order m of XPIC(m)                                           */
    int    leaving;                   /* tobi_leaving                                                 */
    double cfl;                       /* 1, dt <= cfl cell/(speed of sound + |v|)                     */
    int    gradient;                  /* tobi_gradient                                                */
    int    measure_transfer;          /* 1: sum up the energy that transfers cost, in every step      */
    double spacing;                   /* m, of particles of solids; 0 = that of the world             */
} tobi_mlsmpm_def;

#ifdef __cplusplus
}
#endif
#endif
