/* What the material point method keeps between steps. */
#pragma once
#include "mpm/contact/clamp.h"
#include "mpm/cut/cut.h"
#include "mpm/grid.h"
#include "mpm/kernels.h"
#include "mpm/contact/touch.h"

/* What a restart needs besides the particles: doubles only, in the order of checkpoints. Energies are sums
   over the run, J (2-D: J/m). */
typedef struct mpm_memory {
    double speed;                      /* m/s, of the fastest particle                             */
    double strain_dt;                  /* s, of the last step, by which strain lags                */
    double drift;                      /* m, that particles may have gone since the sort           */
    double age;                        /* steps since the sort, -1 = never sorted                  */
    double start_energy;               /* of all particles at the start, less what left            */
    double body_work;                  /* of bodies on the solids                                  */
    double node_energy;                /* kinetic, of the nodes at the end of the step             */
    double transfer;                   /* lost on the way to the grid and back                     */
    double cuts;                       /* numbers of cuts given so far                             */
    double fracture, friction, damping, sides;   /* taken by edges, rubbing, damping, sides        */
    double steps;                      /* sums of eq. (23)                                         */
    double flow;                       /* eq. (22)                                                 */
    double moved;                      /* m, by particles and bodies since sides of cuts were found */
    double squeezed;                   /* m/s, speed of sound of squeezed liquids, eq. (15b)       */
} mpm_memory;

typedef struct mlsmpm {
    tobi_mlsmpm_def def;
    mpm_view view;
    mpm_grid grid;
    mpm_clamp clamp;
    mpm_touch touch;
    mpm_cut cut;
    const mpm_kernels *kernels;
    mpm_material material[TOBI_SOLID_LIMIT + 1];
    double damping[TOBI_SOLID_LIMIT + 1];
    uint8_t touched[TOBI_SOLID_LIMIT + 1];   /* bit 2 axis + side: its particles touch that side   */
    double sound;                      /* m/s, the fastest of the materials                        */
    double liquid_sound;               /* m/s, the slowest of the liquids; infinite: there are none */
    double viscous_dt;                 /* s                                                        */
    double reach;                      /* J, mpm_liquid_reach before the move                      */
    double cell;                       /* m                                                        */
    mpm_memory memory;
    tobi_soft_size *size;              /* [size_room] of the particles, for a liquid               */
    int64_t size_room;
    int built;                         /* blocks fit the particles                                 */
    int fresh;                         /* 1: they were built in this step                          */
    int blades;                        /* 1: nodes may have two velocities                         */
} mlsmpm;

/* Blocks of nodes, those of second velocities included. */
static inline int64_t mpm_count_patches(const mlsmpm *m) { return m->grid.patch_count + m->grid.patch_twins; }

/* The view of reading: strain lags by the last step. */
static inline mpm_view mpm_output_view(const mlsmpm *m)
{
    mpm_view v = m->view;
    v.strain_dt = (float)m->memory.strain_dt;
    return v;
}
