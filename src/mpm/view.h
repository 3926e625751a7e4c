/* What the kernels of the material point method see. The grid exists only around the particles: blocks of
   4x4x4 nodes (2-D: 4x4). Particles are sorted by the block of their base node, the lowest of the 3 nodes per
   axis that feel them, and may stray one cell before they are sorted again. So a block's particles reach the
   nodes -1 .. 6 of its own counting: its tile of 8x8x8 nodes.

   Fields of a particle beside those of every method (core/particles.h):
     strain   columns of F - I;  w: volume at the start (m3), plastic state or damage (materials.k.h,
              damage.k.h), mass (kg)
     affine   columns of the velocity gradient, 1/s
   F lags behind: the gradient of the last step is put into it by the next one (docs/theory/mlsmpm.md). */
#pragma once
#include "exec/portable.h"
#include "tobiuo/kinds.h"

enum { MPM_TILE_3D = 512, MPM_TILE_2D = 64, MPM_NODES_3D = 64, MPM_NODES_2D = 16, MPM_PLANES = 32,
       MPM_SIDES = MPM_TILE_3D + 8, MPM_HIDDEN = (1 << 27) - 1 };

/* Cuts that part one node, one after the other, and the velocities it then has (docs/theory/cutting.md). */
enum { MPM_LEVELS = 3, MPM_VELOCITIES = 1 << MPM_LEVELS, MPM_NEIGHBORS = 2 };

typedef struct mpm_material {
    int   model;                       /* tobi_model                                              */
    float mu, lambda;                  /* Pa, Lame's                                              */
    float bulk, viscosity;             /* Pa, Pa s; of liquids                                    */
    float yield, hardening;            /* Pa, and Pa or 1                                         */
    float compression, stretch;        /* 1, limits of snow                                       */
    float friction;                    /* 1, alpha of Drucker and Prager                          */
    float friction_rise, inertial_scale; /* 1 and sqrt(Pa)/s, of sand in flow, eq. (11c)          */
    float cut_friction;                /* 1, Coulomb, between the faces of a cut                  */
    float surface_friction;            /* 1, Coulomb, where it meets solids it is not bonded to   */
    int   group;                       /* solids of one group share their velocity where they meet */
    float strength, brittleness;       /* Pa, 0: never breaks; 1/(crack strain at which nothing is left) */
    float keep;                        /* share of the velocity kept in this step, by damping     */
} mpm_material;

/* The side of a node whose second velocity is that of a group of solids (mpm_material.group): beyond the
   numbers of cuts, in steps that float still tells apart. */
TOBI_FN float mpm_side_of(int group) { return 33554432.0f + 4.0f*(float)group; }

/* Particles of one block, and the 27 (2-D: 9) blocks of nodes around it. Where cuts are, a node has two
   velocities, where they cross 2^levels: blocks of particles and of nodes have 2^levels - 1 twins for the
   others, which follow one another behind all blocks. A twin block has the tile of its velocity, no
   particles, and around it twins of node blocks where there are any. */
typedef struct mpm_block {
    int32_t corner[3];                 /* cells from the domain's lower corner                    */
    int64_t begin, end;                /* particles                                               */
    int32_t around[27];                /* index of the node block at offset (x + 1)*9 + (y + 1)*3 + z + 1 */
    int32_t twin, levels;              /* index of the first twin block, -1 = none                */
    int32_t sides;                     /* of a block with a twin: number of its first tile of sides */
} mpm_block;

/* Nodes of one block, and the particle blocks (of a twin: twins) whose tiles reach it, -1 = none. */
typedef struct mpm_patch {
    int32_t corner[3];
    int32_t planes;                    /* 1: a plane may reach it                                 */
    int32_t cover[27];
    int32_t twin, levels;              /* index of the first twin, -1 = none                      */
    uint64_t obey[3];                  /* of an axis with sides that only some solids touch: nodes that a
                                          solid feels which does not, by bits                     */
} mpm_patch;

/* Rows of a tile, bit 8 x + y, in which a node carries something: of the nodes 4 to 6, 0 to 3 and -1 along z,
   which belong to the node blocks after, of and before the tile's; in 2-D, where they lie along nothing, of
   all. The other rows of a tile are not written. frame: the velocity from which the tile's momentum is
   counted, m/s, and 0: V of eqs. (24) to (26). */
typedef struct mpm_reach { uint64_t rows[3]; tobi_float4 frame; } mpm_reach;

/* A half space that material may not enter: n . x < offset. x from the domain's lower corner. */
typedef struct mpm_plane {
    double normal[3], offset;          /* 1, m                                                    */
    int    kind;                       /* tobi_wall                                               */
    int    limited;                    /* 1 + axis: to nodes of mpm_patch.obey of this axis; 0: not at all */
    float  friction;                   /* 1, Coulomb                                              */
    float  velocity[3];                /* m/s                                                     */
} mpm_plane;

typedef struct mpm_view {
    tobi_double3 *TOBI_RESTRICT position;
    tobi_float4 *TOBI_RESTRICT velocity;
    tobi_columns *TOBI_RESTRICT strain, *TOBI_RESTRICT affine;
    const uint8_t *TOBI_RESTRICT solid;
    const mpm_material *TOBI_RESTRICT material;
    const mpm_block *TOBI_RESTRICT block;
    const mpm_patch *TOBI_RESTRICT patch;
    const tobi_columns *TOBI_RESTRICT cuts;   /* mpm/cut/cuts.h; NULL in scenes without blades        */
    const float *TOBI_RESTRICT sides;  /* tiles of MPM_SIDES, around blocks with a twin: number of the cut at
                                          a node, with the sign of the side its first velocity belongs to;
                                          mpm_side_of; 0 = one velocity. One for each twin, by level of the
                                          tree and branch: 2^level - 1 + branch; where there are several
                                          levels, MPM_NEIGHBORS times as many with the sides whose particles
                                          go across, if they do not know the cut                   */
    uint32_t *hidden[MPM_LEVELS];      /* of particles in blocks with a twin: bits (x*3 + y)*3 + z, 2-D
                                          x*3 + y, for the nodes that feel it: 1 across the cut of this level;
                                          in [0], above MPM_HIDDEN, for which base node that was found, 0 =
                                          never                                                    */
    tobi_float4 *TOBI_RESTRICT tile;   /* [blocks][tile]: momentum and mass of one block's particles */
    tobi_float4 *TOBI_RESTRICT unstressed;   /* the same without stress; NULL with APIC                  */
    mpm_reach *TOBI_RESTRICT reach;    /* [blocks] of their tiles                                  */
    tobi_float4 *TOBI_RESTRICT node;   /* [patches][nodes]: velocity and mass                      */
    tobi_float4 *TOBI_RESTRICT old;    /* what of the particle's own is replaced, m/s; NULL: APIC  */
    tobi_float4 *TOBI_RESTRICT wave;   /* XPIC: the velocity filtered once more, m/s                */
    double inverse_cell;               /* 1/m                                                      */
    float  cell;                       /* m                                                        */
    float  dt, strain_dt;              /* s, of this step and of the gradients that strain lacks    */
    int    damped;                     /* 1: a material is damped                                  */
    int    apart;                      /* 1: there are several groups of solids                    */
    int    affine_momentum;            /* 1: APIC                                                  */
    int    bent;                       /* 1: stress pushes nodes by the splines' own gradients, (3b) */
    float  flip;                       /* share of FLIP; 1 with XPIC                               */
    float  own;                        /* 1 if the particle's own velocity goes on: FLIP           */
    float  order;                      /* m of XPIC, and in its sweeps the share of this one       */
    float  gravity[3];
    float  fall[3];                    /* what gravity adds in this step, m/s                      */
    int    plane_count;
    mpm_plane plane[MPM_PLANES];
    double size[3];                    /* m, of the domain                                         */
    int    limited;                    /* bit 2 axis + side: only some nodes obey that side, mpm_patch.obey */
    int    touched, obeyed;            /* bit 2 axis + side: particles of some solid touch that side; nodes
                                          of some solid obey it                                    */
    int    held;                       /* bit 2 axis + side: that side keeps particles inside      */
} mpm_view;
