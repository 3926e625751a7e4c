/* Where two velocities of a node push and rub: those of the two sides of a cut, of two solids that meet, or
   any two where cuts cross. docs/theory/cutting.md. */
#pragma once
#include "mpm/view.h"

typedef struct mpm_cut_face {
    float normal[3];                   /* from the face of the first to that of the second        */
    float gap;                         /* m, between the faces                                     */
    float friction;                    /* 1, Coulomb                                               */
    int   fixed;                       /* 1: the first is of a stationary solid, 2: the second, 0: none */
    float push[3];                     /* N s, on the second in this step                          */
    int32_t first, second;             /* places of the two velocities in the nodes' array         */
} mpm_cut_face;

/* Faces between two pieces, of one level of the tree each. */
typedef struct mpm_face { float normal[3], gap; } mpm_face;

/* Two velocities of a node where cuts cross. */
typedef struct mpm_pair {
    mpm_cut_face cut_face;             /* normal and gap: of the face at which they touch in this step */
    mpm_face face[MPM_LEVELS];
    int count;                         /* of faces; 0: they do not touch                           */
} mpm_pair;

/* A node where cuts cross. mark, neighbor: of the tree, as the tiles of mpm_view.sides. */
typedef struct mpm_crossing {
    float   mark[MPM_VELOCITIES - 1], neighbor[MPM_NEIGHBORS][MPM_VELOCITIES - 1];
    int32_t node;                      /* place of its first velocity in the nodes' array          */
    int32_t levels;
    int64_t begin, end;                /* its pairs                                                */
    double  lost;                      /* J, of the last walk                                      */
} mpm_crossing;

/* What a walk over cut faces does: before a step's first sweep, and that sweep; another sweep; the gaps
   at the end. */
typedef enum mpm_visit { MPM_BEGIN, MPM_PRESS, MPM_FINISH } mpm_visit;

/* Each returns what the pushes have cost, J; only MPM_FINISH costs. */
double mpm_cut_faces_visit(mpm_cut_face *cut_face, int64_t begin, int64_t end, tobi_float4 *node, double dt,
                       mpm_visit what);
double mpm_pairs_visit(mpm_pair *pair, int64_t count, tobi_float4 *node, double dt, mpm_visit what);
