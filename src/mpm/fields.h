/* What a particle of the material point method shows: stress, deformation, energy. */
#pragma once
#include "mpm/view.h"

/* State of one particle at the present time. Nothing of the view is changed. */
typedef struct mpm_sample {
    double strain[9];                  /* F - I by rows, after plastic flow                        */
    double stress[6];                  /* Pa, Cauchy: xx, yy, zz, xy, yz, zx                        */
    double ratio;                      /* J: volume over that at the start, plastic part included  */
    double plastic;                    /* materials.k.h: plastic strain, J - 1 or expansion         */
    double damage;                     /* D of a solid that breaks                                  */
    double energy;                     /* J, elastic                                                */
} mpm_sample;

/* v->strain_dt: the gradients that strain lacks, s. */
mpm_sample mpm_sample_particle(const mpm_view *v, int64_t i);
/* Its volume over that at the start. */
double mpm_volume_ratio(const mpm_view *v, int64_t i);
/* Kinetic energy of one particle, J, that of the affine motion of APIC included. */
double mpm_kinetic(const mpm_view *v, int64_t i);
/* totals[0]: what plastic flow and viscosity take from the energy when the gradient that strain lacks is put
   into it, J, over particles. */
void mpm_sum_flow(const void *view, int64_t begin, int64_t end, double *totals);
/* One of the fields of world/read.c that the stress or the strain makes; density: at the start, kg/m3. */
void mpm_read_field(const mpm_view *v, double density, const char *field, int64_t i, double *out);
