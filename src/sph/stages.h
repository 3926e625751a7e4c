/* Stages that the steps of all SPH methods share. v is the method's view, k its kernels. */
#pragma once
#include "core/system.h"
#include "sph/kernels.h"

/* Spacings; with an isph.surface_height below it the outermost particles themselves have no pressure. */
#define SPH_LEAST_HEIGHT 0.1

/* A vessel that is full at the start stays full: voids that disorder opens are then no free surface.
   Pockets: an open one in which isph has met closed pockets. */
enum { SPH_VESSEL_UNKNOWN, SPH_VESSEL_OPEN, SPH_VESSEL_FULL, SPH_VESSEL_POCKETS };

/* Everything of a view that does not belong to one method; after each sort. vessel: SPH_VESSEL_*. */
void sph_bind_view(const tobi_system *s, sph_view *v, double vessel);
/* Begins a stage (sph/fields.h): its fields into v. What v had of others is gone. */
void sph_stage(tobi_system *s, sph_view *v, int stage);
/* 0.25 sqrt(d/g): the longest step that gravity allows, s. */
double sph_gravity_dt(const tobi_system *s);
/* 0.8/(nu rate): the longest step of explicit viscosity at a no-slip wall, s; without it INFINITY. */
double sph_viscous_dt(const tobi_system *s);
/* 0.4 sqrt(rho d^3/(2 pi sigma)): the longest step of explicit surface tension, s; without it INFINITY. */
double sph_tension_dt(const tobi_system *s);
/* The least of those two and of the diffusion of scalars; implicit viscosity sets no bound. */
double sph_force_dt(const tobi_system *s);
/* The step at hand, s->dt, into v. */
void sph_use_dt(const tobi_system *s, sph_view *v);

/* Sorts the particles and lists their neighbours; the view is to be bound again. */
tobi_status sph_find_neighbors(tobi_system *s, double *clock, tobi_error *err);
/* Planes and bodies: wall gradients, shares, pairs that a body separates. */
tobi_status sph_find_boundaries(tobi_system *s, sph_view *v, const sph_kernels *k, double *clock,
                          tobi_error *err);
/* Unless *vessel is known: full if fewer particles see a free surface than a tenth of a cube's face has.
   The view is to be bound again. */
tobi_status sph_classify_vessel(tobi_system *s, sph_view *v, const sph_kernels *k, double *vessel,
                                 double *clock, tobi_error *err);
/* Density, its error, and the share `smooth` of the kernel average in the pressure; returns the mean
   diagonal of the pressure operator, m/kg. */
double sph_measure_density(tobi_system *s, sph_view *v, const sph_kernels *k, double smooth,
                           double *clock);
/* Gives the points of bodies the velocities that were predicted for this step. */
void sph_set_body_velocities(tobi_system *s, double *clock);
/* In a step, m2/s2: the most of twice the mean pressure over the density that depth, tension and bodies
   explain: their speed, that of the liquid that they push, and their acceleration across the domain. The
   pressure of a sudden change grows as 1/dt. */
double sph_explained_head(const tobi_system *s);
/* The pressure of the last solve for neighbours to read. */
void sph_show_pressure(tobi_system *s);
/* Share of the shortest wave that the least viscous fluid damps away in dt, s. */
double sph_viscous_share(const tobi_system *s, const sph_view *v, double dt);
/* v += dt (surface tension, gravity, viscosity, filter, friction, lift); v->filter is set. Viscosity and
   friction wait where they are implicit. */
void sph_apply_forces(tobi_system *s, sph_view *v, const sph_kernels *k, double *clock);
/* Forces on walls and bodies by particles.pressure and the friction of this step. */
void sph_measure_forces(tobi_system *s, sph_view *v, const sph_kernels *k, double *clock);
/* New positions, accel holding the shift; returns the largest speed, m/s, that of lone drops times 0.4. */
double sph_move_particles(tobi_system *s, sph_view *v, const sph_kernels *k, double *clock);
/* After the bodies have moved: their surface, particles that they caught, their impulses. */
void sph_finish(tobi_system *s);

/* A derived field into accel after a refresh: "vorticity", or "acceleration" by all forces but the
   filter. */
void sph_derive(tobi_system *s, sph_view *v, const sph_kernels *k, const char *field);
