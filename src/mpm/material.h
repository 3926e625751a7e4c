/* Constants of a material for the kernels, and how long a step it allows. */
#pragma once
#include "core/system.h"
#include "mpm/view.h"

/* *sound: how fast sound is in it at rest, m/s. */
mpm_material mpm_material_describe(const tobi_solid_def *d, double *sound);
/* The longest step that viscosity allows, s; infinite without. */
double mpm_material_viscous_dt(const tobi_solid_def *d, double cell);
/* The longest step, s, with sound and particles as fast as that, m/s. */
double mpm_material_dt(const tobi_system *s, const tobi_mlsmpm_def *def, double sound, double speed);
/* The fastest sound in liquids as they are squeezed or stretched after the last step, m/s, eq. (15b). */
double mpm_material_squeezed_sound(tobi_system *s, const mpm_view *v);
/* Whether stress pushes by the splines' gradient, eq. (3). gradient: tobi_gradient. */
int mpm_takes_spline(const tobi_system *s, int gradient);
