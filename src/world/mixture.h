/* Several fluids in one world: what a method refuses. */
#pragma once
#include "tobiuo/params.h"
#include "world/world.h"

/* The largest ratio of densities that any method computes. */
#define TOBI_DENSITY_RATIO 1000.0

/* TOBI_UNSUPPORTED, with words that follow "density", where two fluids are too far apart for the method, or
   differ at all beside openings. */
tobi_status tobi_mixture_check(const tobi_method *m, const tobi_fluid_def *fluid, const tobi_fluid_def *other,
                               int openings, tobi_error *err);
/* TOBI_UNSUPPORTED, with words that follow the key answered, where the viscosity of the fluid depends on the
   flow and is not solved for. NULL: nothing is refused. */
const char *tobi_mixture_check_flow(int implicit_viscosity, const tobi_fluid_def *fluid, tobi_error *err);
/* A fluid that is to join those of the world, before what stands beside them is known. */
tobi_status tobi_mixture_add(const tobi_world *w, const tobi_fluid_def *def, tobi_error *err);
/* All fluids, with all that stands beside them. */
tobi_status tobi_mixture_start(const tobi_world *w, tobi_error *err);
