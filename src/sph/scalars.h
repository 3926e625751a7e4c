/* Temperature and concentration in a step of the SPH methods, docs/theory/scalars.md. */
#pragma once
#include "core/system.h"
#include "sph/kernels.h"

/* Whether the liquids have any. */
int sph_scalars_any(const tobi_system *s);
/* Whether they change viscosities. */
int sph_scalars_thin(const tobi_system *s);
/* How they change gravity. */
tobi_scalar_lift sph_scalars_lift(const tobi_system *s);
/* Adds that of a particle to g, m/s2. */
void sph_scalars_add_lift(const tobi_system *s, int64_t i, double g[3]);
/* Into the view; part of sph_bind_view. */
void sph_scalars_bind(const tobi_system *s, sph_view *v);
/* 0.8/(D rate): the longest step of their diffusion at a wall, s; without it INFINITY. */
double sph_scalars_dt(const tobi_system *s);
/* At the positions of the lists, before they move by v->dt: v->accel is the shift. Diffusion over s->dt, what
   walls give, and what the shift changes; the flow of each wall. Nothing without scalars. */
void sph_scalars_spread(tobi_system *s, sph_view *v, const sph_kernels *k);
