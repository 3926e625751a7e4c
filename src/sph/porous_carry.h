/* Porous zones that bodies carry, within the step of a liquid (decision 167, docs/theory/porous.md). In the
   order of a step: sph_porous_brake; sph_porous_know; the bodies' velocities without this step's pressure,
   with the next three; sph_porous_join; the pressure; sph_porous_measure. */
#pragma once
#include "core/system.h"
#include "sph/kernels.h"

/* 1 where bodies carry zones. */
int sph_porous_carried(const tobi_system *s);
/* m: from the carrier of a zone to particle i. */
void sph_porous_arm(const tobi_system *s, const tobi_porous *z, int64_t i, double arm[3]);
/* m/s: of a rigid motion u at that arm. */
void sph_porous_carry(const double u[6], const double arm[3], double out[3]);
/* N x of a particle, eq. (6). */
void sph_porous_drag_by(tobi_float4 drag, const double x[3], double out[3]);

/* Sums over the particles of all zones of each body: D and S, eq. (6). */
void sph_porous_know(tobi_system *s);
/* The first zone of a body that answers in this solve; NULL: none. */
tobi_porous *sph_porous_of(const tobi_system *s, int body);
/* Adds D to force and torque on a body, N, N m. */
void sph_porous_add_known(const tobi_system *s, int body, double f[6]);
/* Into links.answer of a body that was predicted: its change of velocity with S, eq. (7). */
void sph_porous_answer(tobi_system *s, int body);
/* For a body that was predicted: its factor, which these two use. */
void sph_porous_factor(tobi_system *s, int body);
/* (1 + W S)^-1 of what a force alone makes of a body's velocity. */
void sph_porous_soften(const tobi_system *s, int body, double change[6]);
/* A particle in a zone gains that share of N of a rigid motion, m/s and rad/s. */
void sph_porous_gain(const tobi_system *s, const tobi_porous *z, int64_t i, const double moves[6],
                     double share);
/* The liquid in the zones takes N of the bodies' velocities: links.answer, or that of a motion. */
void sph_porous_join(tobi_system *s);
/* Adds what zones take from the accelerations of the liquid to links.total, N, N m; and gives the liquid N of
   the accelerations in links.answer. */
void sph_porous_sum_accelerations(tobi_system *s, int body, double f[6]);
void sph_porous_spread_accelerations(tobi_system *s);
/* N s, N m s: what the liquid has lost to the zones of a body. */
void sph_porous_lost(tobi_system *s, int body, double impulse[6]);
/* The zone that takes from a particle: its own, or the nearest; -1: none. */
int sph_porous_nearest(const tobi_system *s, int64_t i);
/* After all: what the liquid has lost is a load of the bodies. */
void sph_porous_load(tobi_system *s);
/* Whether liquid in its zones drags a body, in the last solve. */
int sph_porous_drags(const tobi_system *s, int body);

/* The last pass of a pressure; its totals go to t. Where bodies carry zones it runs without them, and what
   they and their bodies make of it follows. */
void sph_porous_kick(tobi_system *s, sph_view *v, const sph_kernels *kernel, double *t);
