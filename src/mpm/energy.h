/* Where the energy of solids is and what took it, the columns of history.csv: docs/theory/mlsmpm.md,
   "Energy". */
#pragma once
#include "mpm/state.h"

/* Of all solids now, elastic, kinetic and potential, J. */
double mpm_energy_find(tobi_system *s, const mlsmpm *m);
/* Takes the energy that all solids have at the start. */
void mpm_energy_start(tobi_system *s, mlsmpm *m);
/* Particle i leaves the domain and takes its energy with it. v: from mpm_output_view. */
void mpm_energy_drop(mlsmpm *m, const mpm_view *v, int64_t i);

/* In every step, with measure_transfer only: after the way to the grid, what it takes from kinetic energy,
   stress aside, and what the way back of the last step took: nodes have what they have, particles what
   arrives; */
void mpm_energy_add_transfer(tobi_system *s, mlsmpm *m);
/* before the way back, the nodes' kinetic energy and the sums of eq. (23); */
void mpm_energy_add_nodes(tobi_system *s, mlsmpm *m);
/* after it, what flow takes, eq. (22). */
void mpm_energy_add_flow(tobi_system *s, mlsmpm *m);

/* Fills the energies of tobi_step_info. state: mlsmpm. */
void mpm_energy_report(tobi_system *s);
