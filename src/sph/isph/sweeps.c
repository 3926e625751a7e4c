/* Sweeps of the pressure equation: Jacobi's, or those of artificial compressibility in pseudo-time, whose
   steps are Chebyshev's. Their number is fixed, so that a step costs the same whatever the flow does.
   Drawback: what they leave of the equation is sound; only a small step keeps it faint (decision 51). */
#include "sph/isph/sweeps.h"
#include "sph/isph/forces.h"
#include <math.h>

/* Every eigenvalue of D^-1 A is below; rows of A sum up to no less than 0. What bodies answer adds to it. */
static const double LARGEST = 2;
/* Polynomial of the sweeps in pseudo-time: 1 at 0, at most 1/DAMP in size above its lowest eigenvalue. Values
   below -1/3 would amplify (eq. E.5). */
static const double DAMP = 4;

/* Eigenvalues that the polynomial of that many sweeps damps: middle, half of the width, and their ratio. */
typedef struct band { double middle, half, ratio; } band;

static band find_band(int count, double largest)
{
    const double s = cosh(acosh(DAMP)/count);
    return (band){ largest*s/(s + 1), largest/(s + 1), s };
}

double isph_sweeps_reach(int count, int pseudo)
{
    if (!pseudo || count == 1) return count;
    const band b = find_band(count, LARGEST);
    return count*sqrt(1 - 1/(DAMP*DAMP))/(b.half*sqrt(b.ratio*b.ratio - 1));
}

static double launch(isph_solver *m, tobi_kernel k)
{
    double t[TOBI_TOTALS] = { 0 };
    tobi_launch(m->exec, k, &m->view, 0, m->view.count, t);
    return t[0];
}

/* The operator of a solve: the liquid, and bodies that move by forces (eq. 15b of docs/theory/isph.md). */
static void multiply(isph_solver *m, double *out, const double *in)
{
    m->view.in = in;
    m->view.out = out;
    launch(m, m->kernel->isph_multiply);
    isph_forces_add_answer(m, out, in);
}

tobi_linear_report isph_sweep_all(isph_solver *m, int singular)
{
    isph_view *v = &m->view;
    const int64_t n = v->count;
    const int pseudo = m->sweeps.pseudo && m->sweeps.count > 1;
    const double largest = LARGEST + isph_forces_answer_bound(m), one = largest/LARGEST;
    const band b = pseudo ? find_band(m->sweeps.count, largest) : (band){ one, one, 1 };
    double t[TOBI_TOTALS] = { 0 }, *change[2] = { m->work, m->scratch }, share = 1/b.ratio;
    multiply(m, m->scratch, v->solution);
    tobi_launch(m->exec, m->kernel->eisph_residual, v, 0, n, t);
    v->mean = singular && n > 0 ? t[0]/(double)n : 0;
    v->gain = 1/b.middle;
    v->carry = 0;
    v->out = change[0];
    double left = launch(m, m->kernel->eisph_begin);
    for (int k = 1; k < m->sweeps.count; k++) {
        const double next = 1/(2*b.ratio - share);
        if (pseudo) v->carry = next*share;
        if (pseudo) v->gain = 2*next/b.half;
        share = next;
        multiply(m, change[k%2], change[(k + 1)%2]);
        left = launch(m, m->kernel->eisph_sweep);
    }
    return (tobi_linear_report){ .status = TOBI_LINEAR_CONVERGED, .iterations = m->sweeps.count,
                                 .residual = t[1] > 0 ? sqrt(left/t[1]) : 0 };
}
