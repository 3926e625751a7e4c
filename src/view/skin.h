/* Places at rest and the skin there, for the two surfaces of solids: that of pictures and that of files. */
#pragma once
#include "view/draw.h"

/* From now to rest, fitted to the particles of a group: rest = to + by (x - from), m. */
typedef struct rest_map { double from[3], to[3], by[3][3]; } rest_map;

/* Fits the map; *off: what each of these particles differs from it, m, in the order of all particles. */
void view_fit_rest(const double (*positions)[3], const double (*rest)[3], const int32_t *row, int64_t count,
                   rest_map *map, vec *off);
void view_apply_map(const rest_map *map, const double x[3], double out[3]);
/* The coordinates of a face from those of its corners, which were at rest at `at` and so deep below the skin;
   false: the face is of the inside. */
bool view_skin_face(const tobi_picture_skin *skin, const double at[3][3], const float depth[3],
                    float uv[3][2]);
