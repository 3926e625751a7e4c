/* Everything an SPH kernel may read or write, as plain pointers and constants. */
#pragma once
#include "core/acceleration.h"
#include "core/scalar.h"
#include "core/wall_table.h"
#include "exec/portable.h"
#include "linear/grid.h"
#include "sph/reference_pressure.h"

enum { TOBI_MAX_FLUIDS = 8 };

/* A side of the domain seen from inside: distance = sign*(x[axis] - at); friction; velocity along itself. */
typedef struct tobi_plane { int axis; float sign; double at; int no_slip; float velocity[3]; } tobi_plane;

/* Of sph_view.surface: neighbours are missing on all sides alike, as in spray. */
enum { SPH_SPARSE = 2 };

/* Of temperature and concentration, scalars.k.h. */
typedef struct sph_scalar_constants {
    tobi_scalar_lift lift;
    float diffusivity[TOBI_SCALAR_LIMIT];                /* m2/s                                        */
    float per_eddy[TOBI_SCALAR_LIMIT];                   /* 1: of the eddy viscosity                    */
    float most_eddy;                                     /* m2/s: of it, in a step of this length       */
    int thins;                                           /* 1: `thinning` of any is not 0               */
    float thinning[TOBI_SCALAR_LIMIT];
    float lattice;                                       /* 1: of sigma, so that walls give their flux  */
    float gain[TOBI_SCALAR_LIMIT], loss[TOBI_SCALAR_LIMIT];      /* 1: of eq. (5)                      */
    float dt, way;                                       /* s: of diffusion; over which accel shifts    */
} sph_scalar_constants;

/* Of implicit viscosity, viscosity.k.h; NULL without it. */
typedef struct sph_viscous_fields {
    tobi_float4 *TOBI_RESTRICT x, *TOBI_RESTRICT expected, *TOBI_RESTRICT residual, *TOBI_RESTRICT direction,
                *TOBI_RESTRICT product, *TOBI_RESTRICT inverse, *TOBI_RESTRICT turning, *TOBI_RESTRICT lack,
                *TOBI_RESTRICT fit, *TOBI_RESTRICT fit_shear, *TOBI_RESTRICT spread, *TOBI_RESTRICT slant;
    const tobi_float4 *operand;      /* x or direction: what the sums are over     */
    float moving;                    /* 1: walls move as they do, 0: they rest     */
    tobi_float4 *TOBI_RESTRICT apparent;     /* x: Pa s, y: 1/s; NULL: all are Newtonian */
} sph_viscous_fields;

typedef struct sph_view {
    int64_t count;
    /* particle arrays, see core/particles.h */
    tobi_double3 *TOBI_RESTRICT position;
    tobi_record *TOBI_RESTRICT record;
    tobi_float4 *TOBI_RESTRICT velocity, *TOBI_RESTRICT accel, *TOBI_RESTRICT wall,
                *TOBI_RESTRICT normal;
    tobi_float4 *TOBI_RESTRICT stretch, *TOBI_RESTRICT shear;   /* T, eq. (7b), (7c); they and near_body: */
    const uint8_t *TOBI_RESTRICT near_body;                     /* NULL without it     */
    const int32_t *TOBI_RESTRICT last_link;   /* < 0: sees no body; NULL: there is none    */
    float *TOBI_RESTRICT density, *TOBI_RESTRICT diagonal;
    /* of stages, see sph/fields.h; NULL in others */
    float *TOBI_RESTRICT mean_pressure, *TOBI_RESTRICT surface_depth, *TOBI_RESTRICT wetness;
    float *TOBI_RESTRICT damped;
    float *TOBI_RESTRICT precondition, *TOBI_RESTRICT residual, *TOBI_RESTRICT product, *TOBI_RESTRICT delta;
    float *TOBI_RESTRICT target_divergence;   /* with `exact`; moment with `blind`                    */
    tobi_float4 *TOBI_RESTRICT moment;
    tobi_float4 *TOBI_RESTRICT roughness;     /* R, eq. (13b) */
    sph_viscous_fields viscous;
    tobi_float4 *TOBI_RESTRICT phase, *TOBI_RESTRICT interface;   /* NULL with one fluid, phases.k.h */
    float *TOBI_RESTRICT capillary;           /* it and normal: NULL without surface tension */
    int jumps;                                /* 1: tension is known by `capillary`, and no force */
    float *TOBI_RESTRICT pressure;            /* of the solve at hand; NULL for walls: none */
    uint8_t *TOBI_RESTRICT surface;           /* 1 at a free surface, SPH_SPARSE, or 0 */
    const uint8_t *TOBI_RESTRICT fluid;
    const tobi_float4 *TOBI_RESTRICT held;    /* w > 0: in an inlet, < 0: in an outlet; NULL: there is none */
    const tobi_float4 *TOBI_RESTRICT porous;  /* drag, porous.k.h; NULL: none acts in the pass at hand */
    tobi_double2 *TOBI_RESTRICT scalars;                 /* NULL: there are none                         */
    tobi_float4 *TOBI_RESTRICT scalar_now, *TOBI_RESTRICT scalar_change;
    const tobi_float4 *outlet_normal;         /* of each opening, by |w| - 1; w = 1: sph_carried */
    /* neighbour list */
    const void *TOBI_RESTRICT list;
    const int32_t *TOBI_RESTRICT list_far;
    const uint32_t *TOBI_RESTRICT list_start;
    const uint16_t *TOBI_RESTRICT list_groups;
    /* constants of the discretisation */
    float from_fixed[3];
    float h, inverse_h, weight, slope;        /* see core/smoothing.h */
    int   shape;                              /* TOBI_SHAPE_*                                */
    float wall_share, wall_lattice;           /* eq. (5b) */
    float moment_lattice;                     /* b of viscosity.md, eq. (2c) */
    float spacing, volume;
    float inverse_rate;                       /* m2: 1/sum of V F on the lattice             */
    int   dimension;
    int   full;                               /* 1: a vessel without a free surface          */
    int   exact;                              /* 1: eq. (7c), (10d): linear flows are exact        */
    int   blind;                              /* 1: eq. (13b), a filter that is blind to them      */
    float open_limit;                         /* div x below this: neighbours are missing       */
    float surface_limit;                      /* the same, but never in a full vessel           */
    float sheet_limit;                        /* below this a surface beyond doubt     */
    float surface_gradient;                   /* 1/m: so does a gradient of this size  */
    /* fluids, by index */
    float inverse_density[TOBI_MAX_FLUIDS];   /* m3/kg   */
    float kinematic[TOBI_MAX_FLUIDS];         /* m2/s    */
    float dynamic;                            /* Pa s, of the first */
    float yield_stress[TOBI_MAX_FLUIDS], flow_index[TOBI_MAX_FLUIDS];     /* Pa, 1: viscosity.md, eq. (6) */
    float creep_rate[TOBI_MAX_FLUIDS], creep_viscosity[TOBI_MAX_FLUIDS];  /* 1/s; Pa s at it, of K alone */
    float eddy[TOBI_MAX_FLUIDS];              /* kg/m, of turbulence: Pa s per shear rate */
    int   implicit;                           /* 1: viscosity and friction wait for viscosity.k.h */
    float tension[TOBI_MAX_FLUIDS];           /* N/m     */
    float interface_tension[TOBI_MAX_FLUIDS][TOBI_MAX_FLUIDS];    /* N/m, symmetric, 0 on the diagonal */
    int fluid_count;
    float band_depth;                         /* m, mean depth of the band below the surface */
    float contact_cosine;                     /* of the angle of contact at planes   */
    /* walls */
    int plane_count;
    tobi_plane plane[6];
    const tobi_wall_table *TOBI_RESTRICT table;
    /* the step and the solve at hand */
    sph_scalar_constants scalar;
    float dt, inverse_dt;
    float gravity[3];
    tobi_acceleration acceleration;           /* besides gravity                             */
    float removed_gravity[3];                 /* m/s2, what a full vessel takes from gravity    */
    tobi_reference reference, reference_before;           /* the second: what `pressure` still refers to    */
    float speed_cap;                          /* m/s */
    float smooth;                             /* share of the averaged pressure in the warm start */
    float filter;                             /* of (13), m4/s; while (13b) acts of that, m6/s   */
    float mean;                               /* of residual, product, direction or result    */
    float isolated;                           /* m/kg: a smaller diagonal carries no pressure   */
    float core;                               /* m: pairs nearer than this are pushed apart     */
    float push;                               /* share of their overlap taken per step and side */
    float background;                         /* Pa, uniform pressure that shifts particles     */
    tobi_grid_values coarse;                  /* Pa, of the preconditioner; value NULL = none   */
    float stiffness, exponent;                /* Pa, 1: of the Tait equation            */
    float damping;                            /* Pa s, of sound: pressure per rate of compression */
    float relaxation;                         /* share of the density error shifted away per step */
    float recovery, recovery_pressure;        /* 1/s; Pa, at which no error is asked for: eq. (21d) */
    float alpha, beta;                        /* conjugate gradient coefficients       */
} sph_view;

/* Whether the pressure of a particle is given: it lies in the buffer of an opening; and its velocity: of an
   inlet. An outlet leaves the part of x along its normal. */
TOBI_FN int sph_held(const sph_view *v, int64_t i) { return v->held && v->held[i].w != 0; }
TOBI_FN int sph_driven(const sph_view *v, int64_t i) { return v->held && v->held[i].w > 0; }
/* Whether nothing but its velocity moves it: in an inlet, or where liquid leaves as it came. */
TOBI_FN int sph_carried(const sph_view *v, int64_t i)
{
    if (!sph_held(v, i)) return 0;
    return sph_driven(v, i) || v->outlet_normal[(int)(-v->held[i].w) - 1].w > 0;
}
TOBI_FN tobi_float4 sph_take_normal(const sph_view *v, int64_t i, tobi_float4 x)
{
    const tobi_float4 n = v->outlet_normal[(int)(-v->held[i].w) - 1];
    const float along = x.x*n.x + x.y*n.y + x.z*n.z;
    const tobi_float4 out = {along*n.x, along*n.y, along*n.z, 0};
    return out;
}

/* Surface tension times curvature, Pa; 0 where no fluid has tension. */
TOBI_FN float sph_capillary(const sph_view *v, int64_t i) { return v->capillary ? v->capillary[i] : 0; }
