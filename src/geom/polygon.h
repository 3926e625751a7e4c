/* Areas of polygons: what lies inside, what two have in common. Corners in order, of any sense of turn. */
#pragma once
#include <stdint.h>

typedef struct tobi_polygon { const double (*at)[2]; int64_t count; } tobi_polygon;

/* Both m; area above 0. */
typedef struct tobi_polygon_size { double area, perimeter, lower[2], upper[2]; } tobi_polygon_size;

/* 1: p lies inside. Of polygons that fill the plane with common sides, any p lies in exactly one: left and
   lower sides are inside, right and upper ones outside. */
int tobi_polygon_holds(tobi_polygon polygon, const double p[2]);
tobi_polygon_size tobi_polygon_measure(tobi_polygon polygon);
/* m2, of both. Sides may lie on each other. */
double tobi_polygon_common(tobi_polygon a, tobi_polygon b);
/* A prism that another one crosses: of its corners [up] goes along the axis that both lie across, and the
   other along the axis of the crossing one, which reaches there from `from` to `to`, m. */
typedef struct tobi_crossed { tobi_polygon polygon; int up; double from, to; } tobi_crossed;
/* m3, that two prisms along different axes have in common. */
double tobi_polygon_crossed(const tobi_crossed *a, const tobi_crossed *b);
/* Unit vector along its longest side. */
void tobi_polygon_longest(tobi_polygon polygon, double along[2]);
/* m, from its first to its last point along a unit vector. */
double tobi_polygon_extent(tobi_polygon polygon, const double along[2]);
