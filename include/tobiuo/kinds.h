/* Kinds of sides, of materials and of joints: plain numbers, so that kernels may read them too. */
#ifndef TOBIUO_KINDS_H
#define TOBIUO_KINDS_H

/* Slip holds solids on the wall, separate lets them leave it with the domain's Coulomb friction; liquids of
   the SPH methods slip along both. Sticky and no-slip are the same. Nothing is at an open side: particles of
   mlsmpm and bodies pass it; the SPH methods refuse it. */
typedef enum tobi_wall {
    TOBI_WALL_SLIP,
    TOBI_WALL_NO_SLIP,
    TOBI_WALL_PERIODIC,
    TOBI_WALL_SEPARATE,
    TOBI_WALL_OPEN
} tobi_wall;

/* What a solid's stress depends on; docs/theory/mlsmpm.md. */
typedef enum tobi_model {
    TOBI_NEO_HOOKEAN,
    TOBI_COROTATED,
    TOBI_LIQUID,
    TOBI_VON_MISES,
    TOBI_SNOW,
    TOBI_SAND,
    TOBI_STATIONARY
} tobi_model;

/* How a joint holds two bodies; on a slide the body goes along an axis of the other one. */
typedef enum tobi_joint_between {
    TOBI_BETWEEN_HINGE,
    TOBI_BETWEEN_BALL,
    TOBI_BETWEEN_FIXED,
    TOBI_BETWEEN_SLIDE
} tobi_joint_between;

#endif
