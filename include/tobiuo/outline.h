/* An outline, the shape of a body or of what a region is filled with: a type of tobiuo.h, which includes this
   file. */
#ifndef TOBIUO_OUTLINE_H
#define TOBIUO_OUTLINE_H

#define TOBI_NO_PLACE (-1e9)

/* A polygon, extruded in 3-D. */
typedef struct tobi_outline_def {
    const char *points;         /* "0,0 5,0.25 5,0", m, its corners; NULL = those of the file        */
    const char *file;           /* path: CSV of such corners; both NULL = no outline                 */
    int    axis;                /* of the extrusion in 3-D: 0 y (points are x, z), 1 z (x, y), 2 x (y, z) */
    double from, to;            /* m along that axis                                                 */
    double base;                /* m: points are the upper side of what reaches down to it; TOBI_NO_PLACE
                                   = a closed polygon                                                */
} tobi_outline_def;

#endif
