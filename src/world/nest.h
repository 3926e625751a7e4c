/* Nests: worlds with a smaller spacing in a box of another world (core/nest.h). */
#pragma once
#include "io/store.h"
#include "world/world.h"

/* m: how far the rim of a nest that is this system reaches. */
double tobi_nest_rim(const tobi_system *s);
/* m, from the lower corner of the domain: the middle of a body now. */
void tobi_nest_middle(const tobi_simulation *outer, int body, double middle[3]);
/* nest_list.c: w becomes the last of the nests of its outer world, or none of them. */
void tobi_nest_join(tobi_world *w);
void tobi_nest_leave(tobi_world *w);
int tobi_nest_count(const tobi_world *outer);
/* The nest that has this number (core/nest.h), or NULL. */
tobi_world *tobi_nest_numbered(const tobi_world *outer, int number);
/* Whether a region of the system begins there: everywhere but outside of a nest. */
int tobi_nest_takes(const tobi_system *s, const double x[3]);
/* How many particles a nest may begin with, of so many that its regions have in the whole domain. */
int64_t tobi_nest_share(const tobi_world *w, int64_t particles);
/* Before a step of a world with nests: keeps the velocities. */
tobi_status tobi_nest_remember(tobi_world *w, tobi_error *err);
/* Before a step of a nest: its box goes along with a body; pistons are where they are in the outer world. */
void tobi_nest_follow(tobi_world *w);
/* After it, nest_forces.c: adds up what its liquid presses bodies with. TOBI_NO_MEMORY. */
tobi_status tobi_nest_tally(tobi_world *w, tobi_error *err);
/* When it has caught up with the outer world: what moves by forces there feels in the steps to come what the
   nest pressed it with more, if all of it is in the box. */
void tobi_nest_press(tobi_world *nest, tobi_world *outer);
/* The bodies that it moved are the outer world's alone. */
void tobi_nest_let_go(tobi_world *nest);
/* After a step, nest_rim.c: liquid beyond the rim is removed, and the rim is filled where the outer world has
   liquid and the nest has none. */
tobi_status tobi_nest_pass(tobi_world *w, tobi_error *err);
/* What survives a restart: which outer particles, by id, the nest has seen. After tobi_nest_get `seen` is the
   caller's, or NULL; tobi_nest_take owns it. TOBI_INVALID: one of the two is a nest, the other is none. */
tobi_status tobi_nest_put(const tobi_world *w, tobi_store *f, tobi_error *err);
tobi_status tobi_nest_get(const tobi_world *w, tobi_store *f, const char *path, uint8_t **seen, int64_t *ids,
                          tobi_error *err);
void tobi_nest_take(tobi_world *w, uint8_t *seen, int64_t ids);
