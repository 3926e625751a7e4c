/* The sharp edges of a closed surface: where a blade cuts. docs/theory/edges.md says how they are
   found. */
#pragma once
#include "geom/mesh.h"

/* A straight piece of an edge. The normal of what it cuts is (b - a) x ahead; it points the same
   way all along a chain of pieces, and to the same side in all chains. */
typedef struct tobi_edge {
    double a[3], b[3];   /* m, its ends                                                         */
    double ahead[3];     /* unit vector out of the solid, perpendicular to the piece, in the
                            bisecting plane of its two faces; 0: it cuts whichever way it moves  */
} tobi_edge;

typedef struct tobi_sharp {
    tobi_edge *edge;     /* owned                                                               */
    int64_t count;
    double width;        /* m, of the bluntness that was bridged; 0: the faces meet             */
    double sharpest;     /* degrees, the smallest angle between two faces anywhere              */
} tobi_sharp;

/* Finds the chains of edges at which the solid is at most `degrees` sharp. A rounding, a flat or a
   double edge up to `width` (m) across counts as the edge, if edges without it make no chain as
   long. Chains shorter than a fifth of the longest are left out. flat: 1 if the surface is a prism
   along z that stands for its section (2-D): then the pieces run along z through z = 0 and are 1 m
   long. Needs a mesh that passed tobi_mesh_orient. No edge is no error: count is 0. Errors:
   TOBI_NO_MEMORY. The caller frees `edge`. */
tobi_status tobi_sharp_find(const tobi_mesh *mesh, double degrees, double width, int flat, tobi_sharp *out,
                            tobi_error *err);

/* --- between sharp.c and sharp_chain.c --- */

/* An edge of the mesh between two vertices, and how wide the strip about it is that is sharp
   enough. */
typedef struct tobi_ridge {
    int32_t from, to;
    double width, length;
    double low;              /* m, how far its middle lies below the tip of the strip              */
    double ahead[3];         /* 0: only leads from one ridge to another                            */
} tobi_ridge;

typedef struct tobi_ridges {
    const double (*vertex)[3];
    int64_t vertex_count;
    tobi_ridge *ridge;
    int64_t count, room;
} tobi_ridges;

/* The chains of the ridges at most `width` wide, simplified within `tolerance` (m); out->edge is
   new. *longest: m, of the longest chain. Errors: TOBI_NO_MEMORY. */
tobi_status tobi_sharp_chains(const tobi_ridges *r, double width, double tolerance, tobi_sharp *out,
                              double *longest, tobi_error *err);
