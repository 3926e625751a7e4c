/* The compartments of a vessel, as cells of a spacing that a flood from outside leaves dry. */
#pragma once
#include "world/world.h"

/* Coordinates are those of the box: from the domain's lower corner. */
typedef struct tobi_flood {
    const tobi_body *b;
    const tobi_body *wall;           /* whose walls part compartments: the vessel, or all bodies        */
    int walls;
    const tobi_body *without;        /* of them, this one does not count                                */
    double d, lower[3], up[3];
    int dimension, up_axis;          /* up_axis: the one that up follows, -1 = none                     */
    double level;                    /* m, along up                                                     */
    int64_t n[3], stride[3], cells;
    uint8_t *mark;
    int32_t *label, *stack;          /* label: compartment, 0 = none                                    */
    int compartments;
} tobi_flood;

/* Of a cell, in mark: other bodies hold it without the vessel. */
enum { TOBI_FLOOD_HELD = 32 };

/* Lays the cells over the vessel; b, wall, d, dimension, up and level are set. */
tobi_status tobi_flood_lay(tobi_flood *f, const tobi_world *w, tobi_error *err);
void tobi_flood_free(tobi_flood *f);
/* Labels the compartments below the level. */
void tobi_flood_find_compartments(tobi_flood *f);
/* The same with all bodies as walls: where the vessel alone does not hold liquid, a gate, a plug or a lid may
   close its holes. Cells that they hold without the vessel are marked. */
void tobi_flood_close_holes(tobi_flood *f, const tobi_world *w);
/* With a compartment found at the level, a cell on the way out of it when that rises by a cell; -1: none.
   wanted: its label, 0 of all. */
int64_t tobi_flood_leak(tobi_flood *f, int wanted);

/* The cell of a place, -1: none; the middle of a cell. */
int64_t tobi_flood_cell(const tobi_flood *f, const double x[3]);
void tobi_flood_place(const tobi_flood *f, int64_t c, double x[3]);
/* Of a place, along up. */
double tobi_flood_height(const tobi_flood *f, const double x[3]);
/* The box of a compartment, walls and level as they are. flat: without what lies beyond the plane that has
   half or more of its surface that way, such as a drain in the floor. */
void tobi_flood_box(tobi_flood *f, int label, int flat, double lower[3], double upper[3]);
/* Whether a point belongs to a compartment: a cell near it does, and no wall lies between. */
int tobi_flood_has(const tobi_flood *f, int label, const double x[3]);
/* No wall is nearer than margin, m. */
int tobi_flood_stands_free(const tobi_flood *f, const double x[3], double margin);
