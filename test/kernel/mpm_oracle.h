/* The material point method again, in double, by loops over all particles and all nodes. Shares no code with
   src/mpm: polar decomposition and principal stretches come from a singular value decomposition by one-sided
   rotations, weights from the spline as a function of distance, stresses from the papers' formulas. */
#pragma once
#include <math.h>
#include <string.h>

enum { ORACLE_NODES = 18 };                  /* per axis, from node -4 */

typedef struct oracle_solid {
    int model;                               /* tobi_model */
    double E, nu, bulk, viscosity, yield, hardening, compression, stretch, cone, keep;
    double strength, last;                   /* 0: never breaks; crack strain at which nothing is left */
    double friction_rise, inertial_scale;             /* of sand: friction in flow; eq. (11c) */
} oracle_solid;

typedef struct oracle_particle {
    double x[3], v[3], F[3][3], C[3][3], volume, mass, state;
    int solid;
} oracle_particle;

/* A place is a float, good for 1e-7 of a cell, and so is a slope near the rim of a spline, where it goes to
   0: this part of a cell counts in full. */
static const double ORACLE_BLUR = 0.01;

/* bound: what the absolute values of all terms of the momentum sum up to, kg m/s. */
typedef struct oracle_node {
    double mass, momentum[3], unstressed[3], v[3], old[3], wave[3], kept[3], bound;
} oracle_node;

/* chequered: only nodes obey it whose coordinates have an odd sum, see oracle_obeys. */
typedef struct oracle_side {
    int axis, upper, kind, chequered;
    double at, friction, velocity[3];
} oracle_side;

static int oracle_obeys(const int place[3]) { return (place[0] + place[1] + place[2]) & 1; }

typedef struct oracle_grid {
    int dimension, affine, spline, sides;    /* spline: its gradient carries the stress, not MLS's */
    double h, dt, gravity[3];
    oracle_side side[6];
    oracle_node node[ORACLE_NODES*ORACLE_NODES*ORACLE_NODES];
} oracle_grid;

static void oracle_multiply(double A[3][3], double B[3][3], double out[3][3])
{
    double r[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) r[i][j] = A[i][0]*B[0][j] + A[i][1]*B[1][j] + A[i][2]*B[2][j];
    memcpy(out, r, sizeof r);
}

static double oracle_det(double A[3][3])
{
    return A[0][0]*(A[1][1]*A[2][2] - A[1][2]*A[2][1]) - A[0][1]*(A[1][0]*A[2][2] - A[1][2]*A[2][0]) +
           A[0][2]*(A[1][0]*A[2][1] - A[1][1]*A[2][0]);
}

/* F = U diag(s) V^T: rotations of columns until they are orthogonal (Hestenes 1958). det F > 0. */
static void oracle_svd(double F[3][3], double U[3][3], double s[3], double V[3][3])
{
    memcpy(U, F, sizeof(double[3][3]));
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) V[i][j] = i == j;
    for (int sweep = 0; sweep < 30; sweep++)
        for (int pair = 0; pair < 3; pair++) {
            int p = pair == 2, q = pair == 0 ? 1 : 2;
            double a = 0, b = 0, c = 0;
            for (int i = 0; i < 3; i++) {
                a += U[i][p]*U[i][p];
                b += U[i][q]*U[i][q];
                c += U[i][p]*U[i][q];
            }
            if (fabs(c) < 1e-300) continue;
            double angle = 0.5*atan2(2*c, a - b), co = cos(angle), si = sin(angle);
            for (int i = 0; i < 3; i++) {
                double u = U[i][p], w = V[i][p];
                U[i][p] = co*u + si*U[i][q];
                U[i][q] = -si*u + co*U[i][q];
                V[i][p] = co*w + si*V[i][q];
                V[i][q] = -si*w + co*V[i][q];
            }
        }
    for (int j = 0; j < 3; j++) {
        s[j] = sqrt(U[0][j]*U[0][j] + U[1][j]*U[1][j] + U[2][j]*U[2][j]);
        for (int i = 0; i < 3; i++) U[i][j] /= s[j];
    }
}

/* U diag(d) V^T */
static void oracle_compose(double U[3][3], const double d[3], double V[3][3], double out[3][3])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out[i][j] = U[i][0]*d[0]*V[j][0] + U[i][1]*d[1]*V[j][1] + U[i][2]*d[2]*V[j][2];
}

/* Fixed corotated: 2 mu (F - R) F^T + lambda (J - 1) J I with R = U V^T (Stomakhin et al. 2012). */
static void oracle_corotated(double mu, double lambda, double F[3][3], double tau[3][3])
{
    double U[3][3], V[3][3], s[3], R[3][3], D[3][3], T[3][3], one[3] = {1, 1, 1}, J = oracle_det(F);
    oracle_svd(F, U, s, V);
    oracle_compose(U, one, V, R);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            D[i][j] = 2*mu*(F[i][j] - R[i][j]);
            T[i][j] = F[j][i];
        }
    oracle_multiply(D, T, tau);
    for (int i = 0; i < 3; i++) tau[i][i] += lambda*(J - 1)*J;
}

/* Snow: singular values of the elastic part are clamped, J of the plastic part takes the rest and hardens. */
static void oracle_snow(const oracle_solid *m, double mu, double lambda, oracle_particle *p, double tau[3][3])
{
    double U[3][3], V[3][3], s[3], plastic = 1 + p->state;
    oracle_svd(p->F, U, s, V);
    for (int k = 0; k < 3; k++) {
        double kept = fmin(fmax(s[k], 1 - m->compression), 1 + m->stretch);
        plastic *= s[k]/kept;
        s[k] = kept;
    }
    oracle_compose(U, s, V, p->F);
    p->state = fmin(fmax(plastic, 0.6), 20) - 1;
    double harder = exp(fmin(-m->hardening*p->state, 2));
    oracle_corotated(mu*harder, lambda*harder, p->F, tau);
}

/* Deviatoric strain that sand in flow loses in dt, eq. (11c): the rate at which stress and friction agree. */
static double oracle_hurry(const oracle_solid *m, double mu, double pressure, double norm, double dt)
{
    double low = 0, high = sqrt(2)*norm/dt;
    for (int k = 0; k < 200; k++) {
        double rate = 0.5*(low + high), x = rate*mu/(m->inertial_scale*sqrt(pressure));
        double friction = 3*m->cone/sqrt(2) + m->friction_rise*x/(1 + x);
        if (sqrt(2)*mu*norm - mu*rate*dt > friction*pressure) low = rate;
        else high = rate;
    }
    return low*dt/sqrt(2);
}

/* Von Mises and sand: return mapping of Hencky strains, tau = U (2 mu h + lambda tr h) U^T. */
static void oracle_hencky(const oracle_solid *m, int sand, double mu, double lambda, double dt,
                          oracle_particle *p, double tau[3][3])
{
    double U[3][3], V[3][3], s[3], h[3], d[3], norm = 0, trace = 0;
    oracle_svd(p->F, U, s, V);
    for (int k = 0; k < 3; k++) {
        h[k] = log(s[k]) + (sand ? p->state/3 : 0);
        trace += h[k];
    }
    for (int k = 0; k < 3; k++) {
        d[k] = h[k] - trace/3;
        norm += d[k]*d[k];
    }
    norm = sqrt(norm);
    if (sand) {
        double over = norm + (3*lambda + 2*mu)/(2*mu)*trace*m->cone;
        if (m->friction_rise > 0 && over > 0 && trace < 0)
            over = oracle_hurry(m, mu, -(lambda + 2*mu/3)*trace, norm, dt);
        p->state = trace < 0 ? 0 : trace;
        for (int k = 0; k < 3; k++) {
            if (trace >= 0) h[k] = 0;
            else if (over > 0) h[k] -= over*d[k]/norm;
        }
    } else {
        double over = 2*mu*norm - sqrt(2.0/3)*(m->yield + m->hardening*p->state);
        double flow = over > 0 ? over/(2*mu + 2.0/3*m->hardening) : 0;
        for (int k = 0; k < 3 && flow > 0; k++) h[k] -= flow*d[k]/norm;
        p->state += sqrt(2.0/3)*flow;
    }
    double left[3], value[3], sum = h[0] + h[1] + h[2];
    for (int k = 0; k < 3; k++) {
        left[k] = exp(h[k]);
        value[k] = 2*mu*h[k] + lambda*sum;
    }
    oracle_compose(U, left, V, p->F);
    oracle_compose(U, value, U, tau);
}

static double oracle_elastic(int corotated, double mu, double lambda, double s, double J)
{
    return corotated ? 2*mu*(s*s - s) + lambda*(J - 1)*J : mu*(s*s - 1) + lambda*log(J);
}

/* Damage of an elastic solid: D from the largest stretch, a cracked share like sand without memory. */
static void oracle_break(const oracle_solid *m, double mu, double lambda, oracle_particle *p,
                         double tau[3][3])
{
    double U[3][3], V[3][3], s[3], h[3], loose[3], value[3], J = oracle_det(p->F), norm = 0, trace = log(J);
    int top = 0;
    oracle_svd(p->F, U, s, V);
    for (int k = 0; k < 3; k++) {
        if (s[k] > s[top]) top = k;
        h[k] = log(s[k]) - trace/3;
        norm += h[k]*h[k];
    }
    double pull = oracle_elastic(m->model, mu, lambda, s[top], J)/s[top], strain = s[top] - 1;
    if (pull > m->strength)
        p->state = fmax(p->state, strain >= m->last ? 1 :
                        (pull - m->strength)/(pull - m->strength*strain/m->last));
    norm = sqrt(norm);
    double most = -(3*lambda + 2*mu)/(2*mu)*trace*m->cone;
    for (int k = 0; k < 3; k++) {
        loose[k] = exp(trace < 0 ? trace/3 + h[k]*(norm > most ? most/norm : 1) : fmin(trace, 2)/3);
        value[k] = (1 - p->state)*oracle_elastic(m->model, mu, lambda, s[k], J);
        if (trace < 0) value[k] += p->state*oracle_elastic(m->model, mu, lambda, loose[k], J);
    }
    if (p->state >= 1) oracle_compose(U, loose, V, p->F);
    oracle_compose(U, value, U, tau);
}

static void oracle_liquid(const oracle_solid *m, oracle_particle *p, double tau[3][3])
{
    double J = oracle_det(p->F), trace = p->C[0][0] + p->C[1][1] + p->C[2][2];
    double pressure = m->bulk/7*(pow(J, -7) - 1);
    memset(p->F, 0, sizeof p->F);
    p->F[0][0] = J;
    p->F[1][1] = p->F[2][2] = 1;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            tau[i][j] = 2*m->viscosity*J*(0.5*(p->C[i][j] + p->C[j][i]) - (i == j ? trace/3 : 0)) -
                        (i == j ? pressure*J : 0);
}

/* Takes the last step's gradient into F, lets it flow; Kirchhoff stress. Models: neo-Hookean, corotated,
   liquid, von Mises, snow, sand, stationary in the order of the public list. */
static void oracle_stress(const oracle_solid *m, double strain_dt, oracle_particle *p, double tau[3][3])
{
    double G[3][3], mu = m->E/(2*(1 + m->nu)), lambda = m->E*m->nu/((1 + m->nu)*(1 - 2*m->nu));
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            G[i][j] = (i == j) + strain_dt*p->C[i][j];
            tau[i][j] = 0;
        }
    oracle_multiply(G, p->F, p->F);
    if (m->strength > 0) {
        oracle_break(m, mu, lambda, p, tau);
        return;
    }
    if (m->model == 0) {
        double J = oracle_det(p->F);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
                double b = p->F[i][0]*p->F[j][0] + p->F[i][1]*p->F[j][1] + p->F[i][2]*p->F[j][2];
                tau[i][j] = mu*(b - (i == j)) + (i == j ? lambda*log(J) : 0);
            }
    }
    if (m->model == 1) oracle_corotated(mu, lambda, p->F, tau);
    if (m->model == 2) oracle_liquid(m, p, tau);
    if (m->model == 3) oracle_hencky(m, 0, mu, lambda, strain_dt, p, tau);
    if (m->model == 4) oracle_snow(m, mu, lambda, p, tau);
    if (m->model == 5) oracle_hencky(m, 1, mu, lambda, strain_dt, p, tau);
}

/* The quadratic B-spline at a distance in cells. */
static double oracle_spline(double r)
{
    r = fabs(r);
    return r < 0.5 ? 0.75 - r*r : r < 1.5 ? 0.5*(1.5 - r)*(1.5 - r) : 0;
}

/* Its slope, and the gradient of a node's weight at a particle, 1/m, r: node - particle. */
static double oracle_slope(double r)
{
    return fabs(r) < 0.5 ? -2*r : fabs(r) < 1.5 ? copysign(1.5 - fabs(r), -r) : 0;
}

static void oracle_gradient(const oracle_grid *g, const double r[3], double out[3])
{
    for (int a = 0; a < 3; a++) {
        out[a] = a < g->dimension ? -oracle_slope(r[a]/g->h)/g->h : 0;
        for (int b = 0; b < g->dimension; b++) out[a] *= b == a ? 1 : oracle_spline(r[b]/g->h);
    }
}

static void oracle_place(int at, int place[3])
{
    place[0] = at/ORACLE_NODES/ORACLE_NODES - 4;
    place[1] = at/ORACLE_NODES%ORACLE_NODES - 4;
    place[2] = at%ORACLE_NODES - 4;
}

static oracle_node *oracle_at(oracle_grid *g, const int at[3])
{
    for (int a = 0; a < 3; a++) if (at[a] < -4 || at[a] >= ORACLE_NODES - 4) return NULL;
    return &g->node[((at[0] + 4)*ORACLE_NODES + at[1] + 4)*ORACLE_NODES + at[2] + 4];
}

/* Visits all nodes of the grid for one particle: weight and node - particle, m. */
#define ORACLE_EACH_NODE(g, p, w, r, n)                                                                      \
    for (int at_ = 0; at_ < ORACLE_NODES*ORACLE_NODES*ORACLE_NODES; at_++)                                   \
        for (double w = 1, r[3], *once_ = &w; once_; once_ = NULL)                                           \
            for (oracle_node *n = oracle_weigh(g, p, at_, &w, r); n; n = NULL)

static oracle_node *oracle_weigh(oracle_grid *g, const oracle_particle *p, int at, double *w, double r[3])
{
    int place[3];
    oracle_place(at, place);
    *w = 1;
    for (int a = 0; a < 3; a++) {
        r[a] = a < g->dimension ? place[a]*g->h - p->x[a] : 0;
        if (a >= g->dimension && place[a] != 0) return NULL;
        *w *= oracle_spline(r[a]/g->h);
        if (a >= g->dimension) *w /= 0.75;
    }
    return *w > 0 ? &g->node[at] : NULL;
}

static void oracle_to_grid(oracle_grid *g, const oracle_solid *solids, oracle_particle *p, long count,
                           double strain_dt)
{
    memset(g->node, 0, sizeof g->node);
    for (long i = 0; i < count; i++) {
        double tau[3][3];
        const oracle_solid *m = &solids[p[i].solid];
        oracle_stress(m, strain_dt, &p[i], tau);
        ORACLE_EACH_NODE(g, &p[i], w, r, n) {
            double slope[3];
            oracle_gradient(g, r, slope);
            for (int b = 0; b < 3 && !g->spline; b++) slope[b] = 4/(g->h*g->h)*w*r[b];
            n->mass += w*p[i].mass;
            for (int a = 0; a < 3; a++) {
                double own = p[i].mass*m->keep*p[i].v[a];
                n->momentum[a] += w*own;
                n->unstressed[a] += w*own;
                n->bound += w*fabs(own);
                for (int b = 0; b < 3; b++) {
                    double spin = g->affine ? p[i].mass*m->keep*p[i].C[a][b] : 0;
                    double push = -g->dt*p[i].volume*tau[a][b];
                    n->momentum[a] += w*spin*r[b] + push*slope[b];
                    n->bound += w*g->h*fabs(spin) + ((4*w + ORACLE_BLUR)/g->h + fabs(slope[b]))*fabs(push);
                }
            }
        }
    }
}

static void oracle_meet_side(const oracle_side *s, double v[3])
{
    double sign = s->upper ? -1 : 1, slide = 0, along = sign*(v[s->axis] - s->velocity[s->axis]);
    if (s->kind == 1) memcpy(v, s->velocity, 3*sizeof *v);                  /* no-slip */
    if (s->kind == 1 || (s->kind == 3 && along >= 0)) return;
    v[s->axis] = s->velocity[s->axis];
    if (s->kind != 3) return;                                               /* slip */
    for (int a = 0; a < 3; a++) slide += (v[a] - s->velocity[a])*(v[a] - s->velocity[a]);
    double left = fmax(0, 1 - s->friction*-along/fmax(sqrt(slide), 1e-300));
    for (int a = 0; a < 3; a++) v[a] = s->velocity[a] + left*(v[a] - s->velocity[a]);
}

static void oracle_solve_grid(oracle_grid *g)
{
    for (int at = 0; at < ORACLE_NODES*ORACLE_NODES*ORACLE_NODES; at++) {
        oracle_node *n = &g->node[at];
        int place[3];
        oracle_place(at, place);
        if (!(n->mass > 0)) continue;
        for (int a = 0; a < 3; a++) {
            n->old[a] = n->unstressed[a]/n->mass;
            n->v[a] = n->momentum[a]/n->mass + g->dt*g->gravity[a];
        }
        for (int k = 0; k < g->sides; k++) {
            const oracle_side *s = &g->side[k];
            double x = place[s->axis]*g->h;
            if (s->chequered && !oracle_obeys(place)) continue;
            if (s->upper ? x >= s->at - 1e-6*g->h : x <= s->at + 1e-6*g->h) oracle_meet_side(s, n->v);
        }
    }
}

/* XPIC: kept = sum over k of (-1)^(k+1) (order over k) (S+ S)^(k-1) old. */
static void oracle_filter(oracle_grid *g, const oracle_particle *p, long count, int order)
{
    const int nodes = ORACLE_NODES*ORACLE_NODES*ORACLE_NODES;
    double share = order;
    for (int at = 0; at < nodes; at++)
        for (int a = 0; a < 3; a++) {
            g->node[at].wave[a] = g->node[at].old[a];
            g->node[at].kept[a] = share*g->node[at].old[a];
        }
    for (int k = 2; k <= order; k++) {
        share *= -(order - k + 1.0)/k;
        for (int at = 0; at < nodes; at++) memset(g->node[at].unstressed, 0, sizeof g->node[at].unstressed);
        for (long i = 0; i < count; i++) {
            double u[3] = {0};
            ORACLE_EACH_NODE(g, &p[i], w, r, n) for (int a = 0; a < 3; a++) u[a] += w*n->wave[a];
            ORACLE_EACH_NODE(g, &p[i], w, r, n)
                for (int a = 0; a < 3; a++) n->unstressed[a] += w*p[i].mass*u[a];
        }
        for (int at = 0; at < nodes; at++)
            for (int a = 0; a < 3 && g->node[at].mass > 0; a++) {
                g->node[at].wave[a] = g->node[at].unstressed[a]/g->node[at].mass;
                g->node[at].kept[a] += share*g->node[at].wave[a];
            }
    }
}

/* Velocity, gradient, position; transfer: 0 APIC, 1 FLIP, 2 XPIC; *bound: what the absolute values of all
   terms of v sum up to, m/s. */
static void oracle_to_particle(oracle_grid *g, const oracle_solid *m, int transfer, double flip,
                               oracle_particle *p, double *bound)
{
    double v[3] = {0}, old[3] = {0}, kept[3] = {0}, C[3][3] = {{0}};
    *bound = 0;
    if (m->model == 6) return;                                              /* stationary */
    ORACLE_EACH_NODE(g, p, w, r, n) {
        *bound += n->mass > 0 ? w*n->bound/n->mass : 0;
        for (int a = 0; a < 3; a++) {
            v[a] += w*n->v[a];
            old[a] += w*n->old[a];
            kept[a] += w*n->kept[a];
            for (int b = 0; b < 3; b++) C[a][b] += 4/(g->h*g->h)*w*n->v[a]*r[b];
        }
    }
    for (int a = 0; a < 3; a++) {
        p->x[a] += g->dt*v[a];
        if (transfer == 1) p->v[a] = v[a] + flip*(m->keep*p->v[a] - old[a]);
        else p->v[a] = v[a] + (transfer == 2 ? kept[a] - old[a] : 0);
    }
    memcpy(p->C, C, sizeof C);
}
