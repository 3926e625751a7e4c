/* Several fluids in one system: stages of a step that one fluid does not have. v is the method's view, k its
   kernels; where the fluids do not differ (tobi_system_is_mixed), each does nothing. */
#pragma once
#include "core/system.h"
#include "sph/kernels.h"

/* Constants and numbers of the fluids into v. */
void sph_phases_bind(const tobi_system *s, sph_view *v);
/* Constants, distance from the interface and, where it has tension, normal and curvature of all particles;
   the payload of the records and accel are gone. After the view is bound, before forces act. */
void sph_phases_find(tobi_system *s, sph_view *v, const sph_kernels *k);
/* The constants of each particle's fluid, into `phase`. */
void sph_phases_set(tobi_system *s, sph_view *v, const sph_kernels *k);
/* What the viscosity of pairs of different fluids gives beyond that of i, into `interface`; and v += that. */
void sph_phases_rub(tobi_system *s, sph_view *v, const sph_kernels *k);
void sph_phases_kick(tobi_system *s, sph_view *v, const sph_kernels *k);
/* v += dt (tension of the interfaces), as an acceleration. */
void sph_phases_pull(tobi_system *s, sph_view *v, const sph_kernels *k);
/* Whether the fluids differ in viscosity. */
int sph_phases_differ(const tobi_system *s);
/* Whether an interface of two fluids has tension. */
int sph_phases_have_tension(const tobi_system *s);
/* The longest step of the interfaces' tension, s; without one INFINITY. */
double sph_phases_dt(const tobi_system *s);
