/* What the kernels of isph read and write: a flat struct of plain pointers and constants, and the mirror
   planes in which particles see bodies. */
#pragma once
#include "core/acceleration.h"
#include "core/smoothing.k.h"
#include "exec/pairs.h"
#include "sph/boundary/couple.k.h"
#include "sph/soft.k.h"
#include "sph/view.h"

/* Symmetric. */
typedef struct isph_tensor { float xx, yy, zz, xy, yz, zx; } isph_tensor;

/* Cosine of the angle between normals below which two faces of a body are two. */
#define ISPH_TWO_FACES 0.5

/* The plane in which a particle sees a body. */
typedef struct isph_mirror {
    int32_t body, previous;          /* previous: the particle's next plane, of another face of the body or
                                        of an earlier body, -1 = none                               */
    double offset[3];                /* m, from the closest point of the surface to the particle    */
    double normal[3];                /* of the surface there                                        */
    double share;                    /* 1: how much of the half space behind is body, 0 to 1        */
    double velocity[3];              /* m/s, of the surface there                                   */
    double velocity_change[3];       /* m/s, of that velocity since the step before                 */
} isph_mirror;

/* The same in short, two records of four: for a look at many. The first is that of no plane.  */
typedef struct isph_brief {
    float offset[3];
    int32_t body;                    /* -1: none                                                    */
    float normal[3];
    int32_t previous;                /* one more than that of the mirror                            */
} isph_brief;

/* Eight images of pairs of one particle at bodies. */
typedef struct isph_image_group {
    float x[3][8], displacement[3][8];       /* m, from the image to the particle, from j to its image */
    float normal[3][8], weight[8];   /* 1                                                           */
    float normal_velocity[8], velocity_change[8];    /* m/s                                         */
    int32_t neighbor[8];             /* of the particle's list, -1: itself                          */
    int32_t mirror[2][8];            /* of the two particles; -1: there is no image                 */
    int64_t next;                    /* group of the particle, -1: none                             */
    int sided, corners;              /* 1: some are images in sides too, in several planes. Then the next
                                        place has the rest of the group                             */
} isph_image_group;

/* Of images in sides, signs of velocities, -1 along mirrored axes; of those in several planes, m/s. */
typedef struct isph_image_rest { float sign[3][8], velocity[3][8], change[3][8]; } isph_image_rest;

typedef union isph_group_place { isph_image_group images; isph_image_rest rest; } isph_group_place;

/* Force and torque on a body, about its centre, by one pascal of a particle: m2, m3; eq. (13). */
typedef struct isph_coupling { double f[6]; } isph_coupling;

typedef struct isph_view {
    int64_t count;
    int dimension;
    int shape;                       /* TOBI_SHAPE_*                                                */
    int open;                        /* 1: there may be a free surface                              */
    double spacing, h, volume;       /* m, m, m3                                                    */
    double weight, slope;            /* core/smoothing.h                                            */
    double full;                     /* 1/m2: the sum of a row of the Laplacian on the lattice      */
    double surface_row, surface_force;     /* 1: of what is missing at a surface, surface.h      */
    double surface_loss;             /* 1: of neighbours, of the top row of a flat surface          */
    double surface_lack;             /* 1: lack of volume of the second row, over d |sum V grad W|  */
    double size[3];                  /* m                                                           */
    int periodic[3];
    float inverse_h;                 /* 1/m                                                         */
    float from_fixed[3];             /* m per unit of the records                                   */
    int32_t side[2][3];              /* lower and upper sides of the domain, units of the records   */
    float gravity[3];                /* m/s2                                                        */
    tobi_acceleration acceleration;  /* besides gravity                                             */
    tobi_scalar_lift lift;           /* likewise, by temperature and concentration                  */
    const tobi_double2 *TOBI_RESTRICT scalars;
    float gravity_dt;                /* s: dt while velocities hold the step's gravity, else 0      */
    double density;                  /* kg/m3                                                       */
    double dt, volume_dt;            /* s; volume_dt: the step that errors of volume are corrected by */
    double way;                      /* s: of the motion after the pressure: dt, or dt/2            */
    int fades;                       /* 1: the shift loses its part along n below a surface         */
    int second_order;                /* 1: the list is that of the middle of the step               */
    int keeps_volume;                /* 1: the source has eq. (6b)                                  */
    double volume_gain, shifting;    /* parameters                                                  */
    double gap_speed;                /* m/s: of the fastest particle or body, or of rest            */
    double shift_damping;            /* 1: the factor of eq. (10a)                                  */
    double keep;                     /* 1: share of the last pressure that a solve starts from       */
    double base;                     /* Pa: what it takes in place of the rest                       */
    double mean, carry, gain;        /* Pa/m2, 1, 1: of a sweep, eisph.k.h                           */
    double source_mean;              /* Pa/m2                                                       */
    /* choices, docs/isph_choices.md; zero is the usual one but where 1 is told */
    double own_pressure;             /* p_i in sums of p_j - p_i: 0, of p_j: 1, of p_j + p_i: 2     */
    int as_summed;                   /* 1: the gradient of the pressure goes without B              */
    int own_scale, uniform_scale;    /* 1: kappa of the row alone; kappa = 1                        */
    double volume_sum, volume_change;      /* 1, 0: shares of the kernel sum, of its change, in the error */
    int by_eigenvalue, by_mark;      /* 1: the gate is that of the least eigenvalue; is made beforehand */
    int by_count;                    /* 1: marks by counts, 0: by cones                             */
    double lattice_count;            /* neighbours on the lattice                                   */
    float xsph;                      /* share of the mean velocity in that of positions             */
    int full_viscosity;              /* 1: by the tensor of Fatehi and Manzari                      */
    const float *kinematic;          /* m2/s, by fluid                                              */
    const uint8_t *fluid;
    /* several fluids, sph/phases.k.h; NULL with one, and the last without tension */
    int fluid_count;
    const tobi_float4 *phase, *interface;
    const float (*interface_tension)[TOBI_MAX_FLUIDS];     /* N/m                                       */
    const float *capillary;          /* Pa: outside of a free surface with tension; NULL: none has it */
    const tobi_float4 *porous;       /* drag of porous zones, sph/porous.k.h; NULL: none acts            */
    const tobi_float4 *held;         /* w > 0: in an inlet, < 0: in an outlet; NULL: there is none   */
    /* particle arrays */
    tobi_double3 *position;
    tobi_record *record;             /* w: scale while rows are made, then the pressure, Pa         */
    tobi_float4 *velocity, *accel;
    float *pressure;                 /* Pa                                                          */
    const void *list;                /* exec/list.h                                                 */
    const int32_t *list_far;
    const uint32_t *list_start;
    const uint16_t *list_groups;
    const int32_t *last_link;        /* last mirror of each particle, < 0: none; NULL: no bodies    */
    const isph_mirror *mirror;
    const isph_brief *brief;         /* of mirror k at k + 1                                        */
    isph_group_place *group;         /* images at bodies                                            */
    int64_t *group_count, group_room;
    int64_t *first_group;            /* of the particle that has this as its last link              */
    const tobi_boundary_link *link;  /* which particle sees which body; mirror and coupling go with it */
    const isph_coupling *coupling;
    const double (*answer)[6];       /* of each body: accelerations, m/s2 and rad/s2                */
    const int32_t *soft_last;        /* last link of each particle to a soft solid; NULL: no solids */
    const sph_soft_link *soft;
    const tobi_float4 *soft_velocity;      /* m/s, of each point before the step                    */
    const double (*soft_change)[3];  /* m/s, of each point in this step                             */
    float *body_share;               /* 1: share of the trace of (2) in and behind bodies           */
    /* the method's own: geometry, eq. (2) to (5) */
    isph_tensor *inverse;            /* 1: B, of the gradient of the velocity                       */
    float *trace;                    /* 1: tr M                                                     */
    float *gate;                     /* 1: gamma, 0 in the bulk, 1 at a free surface                */
    float *scale;                    /* 1: kappa                                                    */
    float *concentration;            /* 1: kernel sum, 1 on the lattice                             */
    tobi_float4 *concentration_gradient; /* 1/m: sum of V grad W; w: eq. (10b)                      */
    float *invariant;                /* 1/s2: tr (grad v grad v), eq. (6b)                          */
    /* the matrix */
    float *entry;                    /* 1/m2: a of each entry of the list                           */
    double *excess, *inverse_diagonal;     /* 1/m2, m2                                              */
    double *source;                  /* Pa/m2                                                       */
    double *solution;                /* Pa                                                          */
    const double *in;                /* of the product at hand                                      */
    double *out;
    tobi_float4 *shift_velocity;     /* m/s: of the velocity, with the shift                        */
} isph_view;
