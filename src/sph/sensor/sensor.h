/* Sensors that look at more than a point: levels, run-ups, patches of walls, flows, volumes. Serial, between
   two steps; positions may have moved since the last sort by less than a spacing. `fluid` is the number of
   the one that counts, -1 for all. */
#pragma once
#include "core/system.h"

static inline int tobi_sensor_counts(const tobi_system *s, int fluid, int64_t i)
{
    return fluid < 0 || s->particles.fluid[i] == fluid;
}

/* A rectangle or box: middle (m, world coordinates), unit axes along, across and up, whole sizes along
   them (m;
   0 for a rectangle along up). In 2-D across is the z axis, and its size 1. */
typedef struct tobi_sensor_box { double middle[3], axis[3][3], size[3]; } tobi_sensor_box;

/* Kernel sum of the volumes of the particles around x (world coordinates) over the share that sides and
   bodies leave open: 0 in the air, 1 in the liquid, 1/2 on a free surface. *inside: 1 in a body. Here and in
   columns fluids that are heavier than `fluid` count as well: it stands on them. */
double tobi_sensor_occupancy(const tobi_system *s, int fluid, const double x[3], int *inside);

/* Distance from `from` along the unit vector `along`, at most `length`, at which the liquid that stands on
   `from`, a side or a body ends: where the occupancy falls through 1/2. Bodies in it are passed. -1
   where there
   is none; *floor is how far solids reach from `from` without a gap. */
double tobi_sensor_column(const tobi_system *s, int fluid, const double from[3], const double along[3],
                          double length, double *floor);

/* Height of that column on the plumb line through x: world coordinate along gravity, m (z, in 2-D y, without
   gravity); that of the floor where it is dry. */
double tobi_sensor_level(const tobi_system *s, int fluid, const double x[3]);
/* The axis that a level counts along, and the sign of up. */
int tobi_sensor_up(const tobi_system *s, double *sign);

/* Place k of a rectangle, from its middle, m: how many there are; 0: k is beyond the last. */
int tobi_sensor_place(const tobi_system *s, const tobi_sensor_box *box, int k, double arm[3]);
/* On a rectangle: mean pressure, Pa; force of the fluid on it, N, and moment about its middle, N m.
   Places on a
   side or a body (nearer than half a spacing) feel what the fluid exerts there, others its pressure
   along -up. */
void tobi_sensor_patch(const tobi_system *s, const tobi_sensor_box *box, double *pressure, double force[3],
                       double moment[3]);
/* Through a rectangle along up, m3/s, against one that moves with `velocity` and `spin` about `centre`. */
double tobi_sensor_flow(const tobi_system *s, int fluid, const tobi_sensor_box *box, const double velocity[3],
                        const double spin[3], const double centre[3]);
/* Volume of the particles in a box, each as a cube of a spacing along its axes, m3. */
double tobi_sensor_volume(const tobi_system *s, int fluid, const tobi_sensor_box *box);
