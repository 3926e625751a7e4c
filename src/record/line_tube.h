/* Lines as thin tubes, for pictures. */
#pragma once
#include "rigid/lines.h"
#include "tobiuo/picture.h"

enum { TOBI_TUBE_POINTS = 33, TOBI_TUBE_SIDES = 6 };
typedef struct tobi_line_tube {
    double vertex[TOBI_TUBE_POINTS*TOBI_TUBE_SIDES][3];
    int32_t triangle[2*(TOBI_TUBE_POINTS - 1)*TOBI_TUBE_SIDES][3];
} tobi_line_tube;

/* The mesh of a line, m; its arrays are those of the tube. */
tobi_picture_mesh tobi_line_draw(const tobi_line *line, double radius, tobi_line_tube *tube);
