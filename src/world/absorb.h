/* Pistons that absorb waves that come back (docs/decisions/0072-absorption.md). */
#pragma once
#include "world/world.h"

enum { TOBI_ABSORB_DOUBLES = 5 };

/* Finds them, when the world starts. */
tobi_status tobi_absorb_start(tobi_world *w, tobi_error *err);
/* Before bodies are predicted: where they will be besides their motion. Nothing is kept if the step fails. */
void tobi_absorb_predict(tobi_world *w);
/* After a step: takes that over, and measures the level. */
void tobi_absorb_finish(tobi_world *w);
void tobi_absorb_free(tobi_world *w);

/* What survives a restart, of one body: its state, or NULL if it does not absorb. */
double *tobi_absorb_state(const tobi_world *w, int body);
/* After a restart has set the states. */
void tobi_absorb_restore(tobi_world *w);
