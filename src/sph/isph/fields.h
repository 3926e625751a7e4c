/* Fields for results that only isph has. */
#pragma once
#include "sph/isph/solve.h"
#include "sph/stages.h"

extern const tobi_output isph_outputs[];
/* 1: it is one that isph_fields_derive prepares. */
int isph_fields_know(const char *field);
/* Puts the field where isph_fields_read finds it; changes nothing that outlives it. After a refresh and
   isph_geometry, in the stage SPH_DERIVE. shared: the view of the kernels that all SPH methods have; the
   solver's view has the length of a step, s. */
void isph_fields_derive(isph_solver *m, tobi_system *s, const sph_view *shared, const char *field);
void isph_fields_read(const tobi_system *s, const char *field, int64_t i, double *out);
