/* Bodies by words: closed surfaces of a sphere, a cylinder, a capsule, a plate, a knife. */
#pragma once
#include "geom/mesh.h"

/* A sphere has start = end. ends: round of a sphere and a capsule, else flat. disc: a cylinder of which only
   the section through its middle counts, which has the pieces that it has of a whole one. */
typedef struct tobi_round { double start[3], end[3], radius; int round_ends, disc; } tobi_round;

/* A surface of revolution in facets of about `edge`, m, 24 to 256 around. Its volume is that of the shape to
   rounding; its moments of inertia are within 0.2 %. TOBI_INVALID, with name: a cylinder without length. */
tobi_status tobi_mesh_round(const char *name, const tobi_round *shape, double edge, tobi_mesh *out,
                            tobi_error *err);

/* A box about a centre: along, across and through. along need not be normal to `normal`; zero: any direction
   that is. TOBI_INVALID, with name: no direction. */
typedef struct tobi_plate { double centre[3], normal[3], along[3], length, width, thickness; } tobi_plate;
tobi_status tobi_mesh_plate(const char *name, const tobi_plate *plate, tobi_mesh *out, tobi_error *err);

/* A plate whose two faces meet in an edge at `angle`, degrees. edge: its middle; along: its direction, which
   need not be normal to `direction`, from the back to the edge. TOBI_INVALID, with name: no direction; too
   low for that angle. */
typedef struct tobi_knife {
    double edge[3], direction[3], along[3], length, height, thickness, angle;
} tobi_knife;
tobi_status tobi_mesh_knife(const char *name, const tobi_knife *knife, tobi_mesh *out, tobi_error *err);
