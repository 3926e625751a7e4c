/* Parameters of the material point method. */
#include "base/param_rows.h"
#include "mpm/mlsmpm.h"

static const tobi_param mlsmpm_rows[] = {
    { .key = "cell", REAL, AT(tobi_mlsmpm_def, cell), .def = { 2 }, RANGE(1, 8), .unit = "spacings",
      .doc = "Side of a grid cell: 2 puts 8 particles in a cell of a 3-D scene." },
    { .key = "spacing", REAL, AT(tobi_mlsmpm_def, spacing), LENGTHS, .unit = "m", .text = "scene",
      .doc = "Distance of the particles of solids. Beside fluids at most theirs; thin solids want a finer "
             "one." },
    { .key = "transfer", CHOICE("apic|flip|xpic", 3), AT(tobi_mlsmpm_def, transfer),
      .doc = "How velocities go between particles and grid: apic keeps angular momentum, flip keeps "
             "the most energy, xpic filters noise." },
    { .key = "flip", REAL, AT(tobi_mlsmpm_def, flip), .def = { 0.99 }, RANGE(0, 1), .unit = "1",
      .doc = "Share of FLIP in its blend with PIC, if transfer is flip." },
    { .key = "xpic_order", INT, AT(tobi_mlsmpm_def, xpic_order), .def = { 2 }, RANGE(1, 5),
      .unit = "1", .doc = "Order of the filter, if transfer is xpic; 1 is PIC." },
    { .key = "gradient", CHOICE("automatic|spline|mls", 3), AT(tobi_mlsmpm_def, gradient),
      .doc = "How stress pushes the grid: by the gradient of the splines, or by that of moving least "
             "squares, with which slender solids that lean in the grid bend up to a tenth too easily and a "
             "step takes 4 % less time, without AVX-512 a fifth. Automatic is spline, and mls in scenes with "
             "blades or with a solid that has a strength." },
    { .key = "cfl", REAL, AT(tobi_mlsmpm_def, cfl), .def = { 0.4 }, RANGE(1e-4, 0.5),
      .unit = "1",
      .doc = "Largest part of a cell that sound and particles together cross in a step." },
    { .key = "measure_transfer", BOOL, AT(tobi_mlsmpm_def, measure_transfer),
      .doc = "Sum up in every step what the way to the grid and back, time steps and plastic flow cost, for "
             "transfer_dissipation, step_work and plastic_work in history.csv, which are 0 without it; steps "
             "take up to 5 times as long, where material flows 20 times." },
    { .key = "leaving", CHOICE("keep|remove", 2), AT(tobi_mlsmpm_def, leaving),
      .doc = "What becomes of particles that get past a side: they are put back to it and counted (put_back "
             "in history.csv), or removed (particles_lost); those past an open side are removed." },
    { 0 }
};

const tobi_param_table tobi_mlsmpm_table = {
    "mlsmpm", "The material point method (MLS-MPM, Hu et al. 2018) for solids that deform, sand, snow.",
    sizeof(tobi_mlsmpm_def), mlsmpm_rows };
