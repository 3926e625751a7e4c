/* Temperature and concentration of the particles of a system that has them; calls do nothing to others. */
#pragma once
#include "core/system.h"
#include "io/store.h"

struct tobi_world;

/* The state field of both; NULL without. */
tobi_double2 *tobi_scalars_of(const tobi_particles *p);
/* Gives all particles the values that they start with, inlets apart. */
void tobi_scalars_start(tobi_system *s);
/* Those of a new particle, which has its place and fluid; inlet: opening that lets it in, -1: none. */
void tobi_scalars_place(tobi_system *s, int64_t i, int inlet);
/* Those of particle `of` of a system with the same scalars. */
void tobi_scalars_repeat(tobi_system *s, int64_t i, const tobi_system *other, int64_t of);
/* What the sides and bodies with a heat capacity store, into a checkpoint and from one: by their places,
   those of others from the scene. TOBI_DAMAGED for what is no number. */
tobi_status tobi_scalars_put(const struct tobi_world *w, tobi_store *f, tobi_error *err);
tobi_status tobi_scalars_get(const struct tobi_world *w, tobi_store *f, const char *path, double *stored,
                             tobi_error *err);
/* TOBI_NOT_FOUND for the field of a scalar that the world does not have; other fields pass. */
tobi_status tobi_scalars_know(const struct tobi_world *w, const char *field, tobi_error *err);
/* Adds a note for each value that changes the weight of the liquid much, and for those that do nothing. */
tobi_status tobi_world_note_scalars(struct tobi_world *w, tobi_error *err);
