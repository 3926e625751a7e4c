/* Lines as thin tubes, for pictures. */
#pragma once
#include "rigid/lines.h"

enum { TOBI_TUBE_POINTS = 33, TOBI_TUBE_SIDES = 6, TOBI_TUBE_VERTICES = TOBI_TUBE_POINTS*TOBI_TUBE_SIDES,
       TOBI_TUBE_TRIANGLES = 2*(TOBI_TUBE_POINTS - 1)*TOBI_TUBE_SIDES };
typedef struct tobi_line_tube {
    double vertex[TOBI_TUBE_VERTICES][3];                  /* m */
    int32_t triangle[TOBI_TUBE_TRIANGLES][3];
} tobi_line_tube;

/* The tube around a line as it hangs now; radius in m. */
void tobi_line_draw(const tobi_line *line, double radius, tobi_line_tube *tube);
