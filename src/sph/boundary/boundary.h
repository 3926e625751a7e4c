/* Bodies as a liquid meets them (docs/decisions/0044-boundary.md). In the order of a step: search,
   measure, cut pairs; the forces of the particles; tobi_couple_begin; the pressure; tobi_boundary_load,
   tobi_couple_correct; the bodies move; tobi_push_out, tobi_couple_finish. Sides of the domain are planes in
   the kernels (sph_walls, docs/theory/boundaries.md). */
#pragma once
#include "base/error.h"
#include "exec/exec.h"

struct tobi_system;

/* --- who sees which body, and what of it ------------------------------------------------------ */

/* Finds which particles see which body at the bodies' present pose. */
tobi_status tobi_boundary_search(struct tobi_system *s, tobi_error *err);
/* After the search: fills the entries, at the bodies' present velocities, and particles.last_link. */
tobi_status tobi_boundary_measure(struct tobi_system *s, tobi_error *err);
/* Marks with TOBI_WET_GAP the points of bodies below the level of still water that no particle sees and that
   face a side of the domain or another body within a support radius. Part of measuring. */
void tobi_boundary_fill_gaps(struct tobi_system *s);
/* What is nearer to x than reach (m, a support radius at most): 1 << 2a and 2 << 2a for the lower and the
   upper side of axis a, TOBI_NEAR_BODY for another body. n: only what it points at; or NULL. Others are found
   after tobi_boundary_find_neighbors at their present pose. */
enum { TOBI_NEAR_BODY = 64, TOBI_NEAR_KINDS = 7 };
int tobi_boundary_near(const struct tobi_system *s, int body, const double x[3], const double *n,
                       double reach);
void tobi_boundary_find_neighbors(struct tobi_system *s);
/* 1 where a body stands on a place of a side with the inner normal n, or a gap narrower than a spacing before
   it. */
int tobi_boundary_covers(const struct tobi_system *s, const double x[3], const double n[3]);
/* Replaces neighbours that lie behind a body by the particle itself in the list. */
tobi_status tobi_boundary_cut_pairs(struct tobi_system *s, tobi_error *err);
/* Writes particles.near_body, if there is one. After cutting pairs. */
void tobi_boundary_mark_near_body(struct tobi_system *s);

/* --- what bodies do to particles -------------------------------------------------------------- */

/* Adds gradients, wall fluxes and shares to particles.wall and particles.density (which hold the planes'
   part). */
void tobi_boundary_add_gradients(struct tobi_system *s);
/* Adds dt times hydrostatic pressure of mirrors and no-slip friction of the bodies to the velocities. */
void tobi_boundary_add_forces(struct tobi_system *s);
/* Runs visit over ranges of entries, with the system as its view. */
void tobi_boundary_visit_entries(struct tobi_system *s, tobi_range visit);
/* Turns the surface normals of particles nearer than 1.5 spacings to the bodies' angles of contact. */
void tobi_boundary_turn_normals(struct tobi_system *s);
/* Moves the particles with `near_body` by dt^2 accel, a tenth of a spacing at most and not into bodies or
   sides; velocities stay. */
void tobi_boundary_relax(struct tobi_system *s);
/* Puts particles outside again that the bodies' new poses have caught, that came nearer than 0.2 d, or that
   went through a body within the step, however thin it is. Their speed into the body is taken, the impulse
   counts as pressure of this system's load. After measuring and the motion of particles and bodies; counts in
   s->links.contacts. */
void tobi_push_out(struct tobi_system *s);

/* --- what particles do to bodies -------------------------------------------------------------- */

/* Runs kernel over the entries of each body apart; the totals go to links.total. own: blocks begin with each
   body, else with the first entry of all: where they are cut decides the last bits. */
void tobi_boundary_sum(struct tobi_system *s, tobi_kernel kernel, const void *view, int own);
/* Forces and torques on all bodies by hydrostatic pressure of mirrors and surface tension, or by friction,
   all that does not wait for pressure: into the first six of links.total. */
void tobi_boundary_known_forces(struct tobi_system *s, int viscous);
/* The same by all of the pressure, or of the friction, of this step. */
void tobi_boundary_forces(struct tobi_system *s, int viscous);
/* Adds force and torque of the pressure and the friction of this step to this system's load on each body. */
void tobi_boundary_load(struct tobi_system *s);

/* --- how bodies that move by forces answer (docs/theory/rigid.md, R.11 to R.14) --------------- */

/* A solve for the pressure has tobi_couple_press before and
   tobi_couple_product after each product; an equation of state has it known from
   tobi_couple_begin, and the step bounded by tobi_couple_compliance (docs/theory/wcsph.md, eq. 25). */

/* Whether any body moves by forces. */
int tobi_couple_any(const struct tobi_system *s);
/* Into links.answer of a body: by how much force and torque f (N, N m), with gravity and what else it feels,
   change its velocities in this step; 0 for a body that does not move by forces. */
void tobi_couple_predict(struct tobi_system *s, int body, const double f[6]);
/* Into links.answer of a body that was predicted: its accelerations by f alone. */
void tobi_couple_answer(struct tobi_system *s, int body, const double f[6]);
/* After those calls for all bodies: lets the answers obey the joints between bodies (P W f, symmetric). join:
   first, at each pose, by the mobilities of the bodies. moving: of tobi_couple_predict. */
void tobi_couple_join(struct tobi_system *s);
void tobi_couple_obey(struct tobi_system *s, int moving);
/* The bodies' velocities by all forces but this step's pressure, and the flux of the walls that they are,
   into particles.wall. */
void tobi_couple_begin(struct tobi_system *s);
/* The same with the pressure, for a liquid whose pressure has acted; walls stay as they are. */
void tobi_couple_expect(struct tobi_system *s);
/* Accelerations of the bodies by the pressures in the particles' records, and in zones that bodies carry by
   those of the liquid, which get those of the bodies: before their divergence. */
void tobi_couple_press(struct tobi_system *s);
/* Adds to particles.product how the bodies answer the pressures, by tobi_couple_press. totals (or NULL):
   [0] and [1] receive what this adds to record.w times product and to the sum of products. */
void tobi_couple_product(struct tobi_system *s, double *totals);
/* Lets the bodies drift by the velocities that this system's load makes, not by those of the step's
   start: the liquid was solved for these. Bodies that no particle sees fall freely. */
void tobi_couple_correct(struct tobi_system *s);
/* Impulse and twist of this step for tobi_rigid_step, from this system's load on the bodies. */
void tobi_couple_finish(struct tobi_system *s);
/* The longest step for the explicit friction between bodies and liquid, s; INFINITY without. */
double tobi_couple_dt(const struct tobi_system *s);
/* How fast a layer of water around a moving body would move it, were the layer a spring: the largest
   eigenvalue of the inverse mass and inertia times the integral of (n, r x n) (n, r x n)^T over the surface,
   of the worst body, up to 6 % too much; m2/kg, 0 without such bodies. At the bodies' present pose. */
double tobi_couple_compliance(const struct tobi_system *s);
