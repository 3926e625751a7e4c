/* Parameters of the SPH methods. */
#include "base/param_rows.h"
#include "sph/dfsph.h"
#include "sph/isph/isph.h"
#include "sph/wcsph.h"

/* Of every SPH method. */
#define KERNELS "wendland-c2|cubic-spline|quartic-spline|quintic-spline|wendland-c4|wendland-c6"
#define SMOOTHING(type_)                                                              \
    { .key = "kernel", CHOICE(KERNELS, 6), AT(type_, kernel),                         \
      .doc = "Smoothing kernel. The first two are the fastest." },                    \
    { .key = "support", REAL, AT(type_, support), RANGE(2, 4), .unit = "spacings",      \
      .text = "automatic",                                                            \
      .doc = "Support radius of the kernel (CSML): 2 is fast, 3 to 4 is more accurate. Automatic is 2; "    \
             "dfsph takes 2.5 where liquid fills the domain and a body or a side moves, isph always; "      \
             "kernels that fall off sooner get up to 1.25 times that." }

static const tobi_param dfsph_rows[] = {
    SMOOTHING(tobi_dfsph_def),
    { .key = "density_tolerance", REAL, AT(tobi_dfsph_def, density_tolerance), .def = { 5e-4 },
      RANGE(1e-9, 0.1), .unit = "1",
      .doc = "Mean relative density error at which the density solve may stop." },
    { .key = "divergence_tolerance", REAL, AT(tobi_dfsph_def, divergence_tolerance),
      .def = { 1e-3 }, RANGE(1e-9, 1), .unit = "1",
      .doc = "Mean |div v| times the time step at which the divergence solve may stop." },
    { .key = "pressure_tolerance", REAL, AT(tobi_dfsph_def, pressure_tolerance), .def = { 0.05 },
      RANGE(1e-9, 1), .unit = "1",
      .doc = "Relative pressure residual that the divergence solve must reach as well." },
    { .key = "density_iterations_min", INT, AT(tobi_dfsph_def, density_iterations_min),
      .def = { 1 },
      RANGE(0, 1000000), .unit = "1", .doc = "Fewest iterations of the density solve in a step." },
    { .key = "density_iterations_max", INT, AT(tobi_dfsph_def, density_iterations_max),
      .def = { 1000 }, RANGE(1, 1000000), .unit = "1",
      .doc = "Most iterations of the density solve; a step that needs more is reported as not "
             "converged." },
    { .key = "divergence_iterations_min", INT, AT(tobi_dfsph_def, divergence_iterations_min),
      .def = { 1 }, RANGE(0, 1000000), .unit = "1",
      .doc = "Fewest iterations of the divergence solve in a step." },
    { .key = "divergence_iterations_max", INT, AT(tobi_dfsph_def, divergence_iterations_max),
      .def = { 200 },
      RANGE(0, 1000000), .unit = "1", .doc = "Most iterations of the divergence solve in a step." },
    { .key = "filter", REAL, AT(tobi_dfsph_def, filter), .def = { 1 }, RANGE(0, 1), .unit = "1",
      .text = "off",
      .doc = "Share of particle-scale motion taken out per step; longer waves are left alone. In full "
             "vessels, unless bodies move there by forces, what viscosity takes counts, and linear flows "
             "are left alone as well." },
    { .key = "shifting", REAL, AT(tobi_dfsph_def, shifting), .def = { 0.5 }, RANGE(0, 1),
      .unit = "1", .text = "off",
      .doc = "Strength of particle shifting in a vessel full of liquid, where without it cavities open "
             "behind moving bodies; off with a free surface, and with a support below 2.5." },
    { .key = "still_water", BOOL, AT(tobi_dfsph_def, still_water), .def = { 1 },
      .doc = "Take the pressure that water at rest has, some layers below the free surface, from gravity and "
             "solve for the rest: slow bodies and waves then lose far less to the disorder of particles." },
    { 0 }
};

const tobi_param_table tobi_dfsph_table = {
    "dfsph", "Divergence-free SPH (Bender & Koschier 2015, 2017) for incompressible liquids.",
    sizeof(tobi_dfsph_def), dfsph_rows };

static const tobi_param wcsph_rows[] = {
    SMOOTHING(tobi_wcsph_def),
    { .key = "stiffness", REAL, AT(tobi_wcsph_def, stiffness), .def = { 50000 }, STIFFNESS,
      .unit = "Pa",
      .doc = "B of the Tait equation p = B ((rho/rho0)^exponent - 1). The speed of sound is "
             "sqrt(exponent B/rho0); ten times the fastest flow keeps the density within 1 %." },
    { .key = "exponent", REAL, AT(tobi_wcsph_def, exponent), .def = { 7 }, RANGE(1, 20),
      .unit = "1", .doc = "Exponent of the Tait equation." },
    { .key = "damping", REAL, AT(tobi_wcsph_def, damping), .def = { 1 }, RANGE(0, 1), .unit = "1",
      .text = "off",
      .doc = "Damping of sound: a bulk viscosity of damping times density, speed of sound and "
             "spacing. Shear and slow flow do not feel it." },
    { .key = "filter", REAL, AT(tobi_wcsph_def, filter), .def = { 1 }, RANGE(0, 1), .unit = "1",
      .text = "off",
      .doc = "Share of particle-scale motion taken out per step of a tenth of the speed of sound; "
             "longer waves are left alone." },
    { .key = "still_water", BOOL, AT(tobi_wcsph_def, still_water), .def = { 1 },
      .doc = "Start with the pressure that water at rest has, and take it, some layers below the free "
             "surface, from gravity: the water does not ring, and slow bodies and waves lose far less to the "
             "disorder of particles." },
    { 0 }
};

const tobi_param_table tobi_wcsph_table = {
    "wcsph", "Weakly compressible SPH: pressure from density by the Tait equation, no solver.",
    sizeof(tobi_wcsph_def), wcsph_rows };

static const tobi_param isph_rows[] = {
    SMOOTHING(tobi_isph_def),
    { .key = "tolerance", REAL, AT(tobi_isph_def, tolerance), .def = { 1e-4 }, RANGE(1e-12, 0.1),
      .unit = "1",
      .doc = "Relative residual of the pressure equation, computed afresh from its answer, at which the "
             "solve may stop." },
    { .key = "iterations_max", INT, AT(tobi_isph_def, iterations_max), .def = { 200 },
      RANGE(1, 1000000), .unit = "1",
      .doc = "Most iterations of the pressure solve; a step that needs more is reported as not converged." },
    { .key = "solver", CHOICE("cg|bicgstab|gmres", 3), AT(tobi_isph_def, solver),
      .doc = "Krylov method of the pressure equation. Its matrix is symmetric: cg is the fastest, the others "
             "are for comparison." },
    { .key = "restart", INT, AT(tobi_isph_def, restart), .def = { 30 }, RANGE(1, 1000), .unit = "1",
      .doc = "Directions that gmres keeps before it starts again." },
    { .key = "preconditioner", CHOICE("multigrid|jacobi", 2), AT(tobi_isph_def, preconditioner),
      .doc = "multigrid takes as many iterations at any depth; those of jacobi grow with the depth." },
    { .key = "volume_gain", REAL, AT(tobi_isph_def, volume_gain), .def = { 0.1 }, RANGE(0, 1), .unit = "1",
      .text = "off",
      .doc = "Share of the error of volume that the pressure takes out in a step. Less is quieter and lets "
             "the volume drift further." },
    { .key = "shifting", REAL, AT(tobi_isph_def, shifting), .def = { 0.5 }, RANGE(0, 1), .unit = "1",
      .text = "off",
      .doc = "Strength of particle shifting, which keeps particles evenly spaced; at a free surface they "
             "shift along it only." },
    { .key = "pressure_gradient", CHOICE("difference|plain|symmetric", 3),
      AT(tobi_isph_def, pressure_gradient),
      .doc = "Gradient of the pressure, sums over p_j - p_i, p_j, or p_i/rho^2 + p_j/rho^2. The last asks "
             "for renormalised off and shorter steps; without a free surface and with shifting off it keeps "
             "momentum to rounding." },
    { .key = "renormalised", BOOL, AT(tobi_isph_def, renormalised), .def = { 1 },
      .doc = "Correct that gradient by the inverse of the moments (grad_corr_M): that of a linear pressure "
             "is then exact." },
    { .key = "laplacian", CHOICE("pair|own|uniform", 3), AT(tobi_isph_def, laplacian),
      .doc = "Scale of the Laplacian of the pressure by lost neighbours: mean of both particles (rho_i + "
             "rho_j), that of the row (rho_i), or none. With own the matrix is not symmetric: use bicgstab "
             "or gmres." },
    { .key = "viscosity_form", CHOICE("plain|gradient-corrected|full", 3), AT(tobi_isph_def, viscosity_form),
      .doc = "Laplacian of the velocity: plain, less the gradient of the velocity, or, besides, by the "
             "tensor of Fatehi and Manzari (laplacian_corr_M), which is exact for quadratic velocities." },
    { .key = "volume_error", CHOICE("kernel-sum|predicted|continuity", 3), AT(tobi_isph_def, volume_error),
      .doc = "Error of volume that volume_gain takes out (rho*): of the kernel sum, of that and its change "
             "in this step by the divergence, or of the change alone." },
    { .key = "surface_rule", CHOICE("loss|eigenvalue|cone|count", 4), AT(tobi_isph_def, surface_rule),
      .doc = "What makes a particle one of the free surface: the trace of its moments, their least "
             "eigenvalue, no neighbour within 45 degrees of the outward normal, or few neighbours. cone and "
             "count are 0 or nearly 0 or 1, the others fade." },
    { .key = "surface_height", REAL, AT(tobi_isph_def, surface_height), .def = { 0.5 }, RANGE(0, 2),
      .unit = "spacings",
      .doc = "Height above the outermost particles at which the pressure is 0; 0: at these particles, which "
             "is rough." },
    { .key = "filter", REAL, AT(tobi_isph_def, filter), .def = { 1 }, RANGE(0, 1), .unit = "1",
      .text = "off",
      .doc = "Share of particle-scale motion taken out per step, 1 is quietest; linear flows and longer "
             "waves are left alone. What viscosity takes counts in it. Nothing is taken where densities "
             "differ." },
    { .key = "xsph", REAL, AT(tobi_isph_def, xsph), RANGE(0, 1), .unit = "1", .text = "off",
      .doc = "XSPH: share of the neighbours' mean velocity in the velocity that moves a particle." },
    { .key = "time_order", INT, AT(tobi_isph_def, time_order), .def = { 2 }, RANGE(1, 2), .unit = "1",
      .doc = "Order of a step in time (RK_order): 2 solves for the pressure at the middle of the way, at "
             "about the cost of 1. Where bodies or solids move, or liquid comes and goes, the order is 1." },
    { 0 }
};

const tobi_param_table tobi_isph_table = {
    "isph", "Incompressible SPH: pressure by one Poisson equation per step, for forces and pressures.",
    sizeof(tobi_isph_def), isph_rows };

static const tobi_param eisph_rows[] = {
    SMOOTHING(tobi_eisph_def),
    { .key = "sweeps", INT, AT(tobi_eisph_def, sweeps), .def = { 1 }, RANGE(0, 1000), .unit = "1",
      .text = "automatic",
      .doc = "Sweeps of the pressure equation per step, from the last pressure. Fewer need shorter "
             "steps. Automatic (0) takes as many as the step of the motion needs." },
    { .key = "iteration", CHOICE("jacobi|pseudo-time", 2), AT(tobi_eisph_def, iteration),
      .doc = "jacobi: each pressure from those of its neighbours. pseudo-time: artificial "
             "compressibility, with sound that is damped as fast as it can be; n sweeps (2 or more, "
             "or automatic) allow 0.7 n times the step, those of jacobi sqrt(n) times." },
    { .key = "sound_speed", REAL, AT(tobi_eisph_def, sound_speed), RANGE(1e-6, TOBI_SPEED_LIMIT),
      .unit = "m/s", .text = "automatic",
      .doc = "Speed at which pressure spreads. Automatic is ten times the fastest flow, or fall over the "
             "depth of the liquid, which keeps the density within 1 %." },
    { .key = "volume_gain", REAL, AT(tobi_eisph_def, volume_gain), .def = { 0.1 }, RANGE(0, 0.5), .unit = "1",
      .text = "off",
      .doc = "Share of the error of volume that the pressure takes in per step of the motion. It forgets "
             "twice as much of itself." },
    { .key = "shifting", REAL, AT(tobi_eisph_def, shifting), .def = { 0.5 }, RANGE(0, 1), .unit = "1",
      .text = "off", .doc = "Strength of particle shifting, as of isph." },
    { 0 }
};

const tobi_param_table tobi_eisph_table = {
    "eisph", "Explicit incompressible SPH: sweeps of the pressure equation in place of a solve.",
    sizeof(tobi_eisph_def), eisph_rows };
