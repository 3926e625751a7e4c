/* Inlets and outlets of a world: rows come and go between steps. */
#pragma once
#include "world/world.h"

/* Rows that the buffers of inlets have at the start. */
int64_t tobi_openings_count(const tobi_world *w);
/* Adds them behind the regions' particles, for which there must be room. TOBI_INVALID for an inlet in a body
   or in the buffer of another opening, an outlet that faces inwards. */
tobi_status tobi_openings_fill(tobi_world *w, tobi_error *err);
/* Whether a place belongs to an opening at the start: regions leave it out. */
int tobi_openings_cover(const tobi_simulation *s, const double x[3]);
/* After a step: what has gone out is removed, what follows in the buffers is added. */
tobi_status tobi_openings_pass(tobi_world *w, tobi_error *err);
/* Volume of the liquid over that of the domain, where inlets bring more and no outlet takes any; else 0. */
double tobi_openings_share(const tobi_system *s);
/* TOBI_DIVERGED, in words, where they have brought more than the domain holds. */
tobi_status tobi_openings_check_room(const tobi_world *w, tobi_error *err);
/* Rows that are wanted, in their order, into w->chosen. Errors: no memory. */
typedef int (*tobi_opening_wants)(const tobi_system *s, const void *o, int64_t i);
tobi_status tobi_openings_choose(tobi_world *w, tobi_opening_wants wants, const tobi_opening *o,
                                 int64_t *count, tobi_error *err);
tobi_status tobi_rows_choose(tobi_world *w, const tobi_system *s, tobi_opening_wants wants, const void *o,
                             int64_t *count, tobi_error *err);
/* backflow.c: fills the buffers of outlets whose pressure is given. */
tobi_status tobi_openings_give(tobi_world *w, tobi_error *err);
/* Whether a new particle may be placed there: a little away from sides, and outside of bodies. */
int tobi_openings_is_open(const tobi_system *s, const double x[3]);
/* How far beyond its plane an outlet keeps particles, m. */
double tobi_outlet_depth(const tobi_opening *o, const tobi_smoothing_constants *c);
/* Depths of its buffer: how far behind an inlet regions are cut out. */
#define TOBI_OPENING_BEHIND 3.0
/* A note for each inlet that begins in the middle of liquid. After the fill. */
tobi_status tobi_openings_note_pools(tobi_world *w, tobi_error *err);
/* A note for each outlet with a level or a pressure beyond whose plane no liquid is or comes, after the
   fill. */
tobi_status tobi_openings_note_dry(tobi_world *w, tobi_error *err);
/* A note where they leave no free surface, to a method that needs one. After the fill. */
tobi_status tobi_openings_note(tobi_world *w, tobi_error *err);
/* The fastest inlet at its fastest place, m/s. */
double tobi_openings_peak(const tobi_simulation *s);
void tobi_openings_free(tobi_world *w);

/* flow_table.c: reads the flow in time of an inlet with that area (m2; in 2-D m) into rows, which the opening
   owns, and its largest speed. TOBI_INVALID, TOBI_NOT_FOUND in words. */
tobi_status tobi_opening_load_flow(tobi_opening *o, const char *path, double area, tobi_error *err);

/* What survives a restart: a number per opening. */
void tobi_openings_get(const tobi_world *w, double way[TOBI_OPENING_LIMIT]);
void tobi_openings_set(tobi_world *w, const double way[TOBI_OPENING_LIMIT]);
