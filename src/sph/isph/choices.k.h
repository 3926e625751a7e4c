/* Kernels of isph that only some of its parameters ask for: marks of the free surface, the corrected
   viscosity, XSPH. Drawback: they look at the smoothing kernel's name in the loop, a few per cent of time. */
#pragma once
#include "sph/isph/isph.k.h"

/* cos 45 degrees. */
#define ISPH_CONE 0.70710678f
/* Share of the lattice's neighbours below which the gate begins to open, and is open. */
#define ISPH_COUNT_BEGIN 0.85
#define ISPH_COUNT_OPEN 0.75
/* Pivot below which the tensor of the viscosity has no use; on the lattice it is 0.4 or more. */
#define ISPH_PIVOT_MIN 0.05

/* The gate by the number of neighbours, or open where none is within 45 degrees of the outward normal. */
typedef struct isph_mark_acc { lane x, y, z, count, cone; } isph_mark_acc;

TOBI_FN void isph_mark_start(const isph_view *v, int64_t i, isph_mark_acc *a)
{
    const tobi_float4 c = v->concentration_gradient[i];
    const float size = sqrtf(c.x*c.x + c.y*c.y + c.z*c.z) + 1e-20f;
    a->x = lane_set(c.x/size); a->y = lane_set(c.y/size); a->z = lane_set(c.z/size);
    a->count = a->cone = lane_set(0);
}

TOBI_FN void isph_mark_pair(const isph_view *v, int64_t i, const tobi_neighbors *n, const isph_image *m,
                            isph_mark_acc *a, const int shape, const int kind)
{
    const lane seen = lane_where_less(n->r2, lane_set((float)(v->h*v->h)), lane_set(1), lane_set(0)),
               within = kind == ISPH_BODY ? seen*m->weight : seen,
               along = n->dx*a->x + n->dy*a->y + n->dz*a->z;
    (void)i; (void)shape;
    a->count += within;
    a->cone += lane_where_less(ISPH_CONE*lane_sqrt(n->r2), along, within, lane_set(0));
}

TOBI_FN void isph_mark_finish(const isph_view *v, int64_t i, isph_mark_acc *a, double *totals)
{
    const double loss = 1 - v->trace[i]/(double)v->dimension;
    (void)totals;
    if (v->by_count) v->gate[i] = (float)isph_fade(lane_sum(a->count)/v->lattice_count, ISPH_COUNT_OPEN,
                                                   ISPH_COUNT_BEGIN);
    else v->gate[i] = lane_sum(a->cone) < 0.5f && loss > ISPH_GATE_BEGIN;
}

/* div v, for output, as x of accel. */
typedef struct isph_divergence_acc {
    lane ux, uy, uz, bxx, byy, bzz, bxy, byz, bzx, sum;
} isph_divergence_acc;

TOBI_FN void isph_divergence_start(const isph_view *v, int64_t i, isph_divergence_acc *a)
{
    const tobi_float4 u = v->velocity[i];
    const isph_tensor b = v->inverse[i];
    a->ux = lane_set(u.x); a->uy = lane_set(u.y); a->uz = lane_set(u.z);
    a->bxx = lane_set(b.xx); a->byy = lane_set(b.yy); a->bzz = lane_set(b.zz);
    a->bxy = lane_set(b.xy); a->byz = lane_set(b.yz); a->bzx = lane_set(b.zx);
    a->sum = lane_set(0);
}

TOBI_FN void isph_divergence_pair(const isph_view *v, int64_t i, const tobi_neighbors *n, const isph_image *m,
                                  isph_divergence_acc *a, const int shape, const int kind)
{
    const lane f = isph_falloff(v, n, m, shape, kind), x = a->bxx*n->dx + a->bxy*n->dy + a->bzx*n->dz,
               y = a->bxy*n->dx + a->byy*n->dy + a->byz*n->dz,
               z = a->bzx*n->dx + a->byz*n->dy + a->bzz*n->dz;
    lane u[3];
    (void)i;
    isph_velocity(v, n, m, kind, u);
    a->sum += f*((u[0] - a->ux)*x + (u[1] - a->uy)*y + (u[2] - a->uz)*z);
}

TOBI_FN void isph_divergence_finish(const isph_view *v, int64_t i, isph_divergence_acc *a, double *totals)
{
    const tobi_float4 out = {(float)(-v->slope*lane_sum(a->sum)), 0, 0, 0};
    (void)totals;
    v->accel[i] = out;
}

/* XSPH: positions move with v + xsph sum of V W (v_j - v), as an acceleration in accel. */
typedef struct isph_xsph_acc { lane ux, uy, uz, x, y, z; } isph_xsph_acc;

TOBI_FN void isph_xsph_start(const isph_view *v, int64_t i, isph_xsph_acc *a)
{
    const tobi_float4 u = v->velocity[i];
    a->ux = lane_set(u.x); a->uy = lane_set(u.y); a->uz = lane_set(u.z);
    a->x = a->y = a->z = lane_set(0);
}

TOBI_FN void isph_xsph_pair(const isph_view *v, int64_t i, const tobi_neighbors *n, const isph_image *m,
                            isph_xsph_acc *a, const int shape, const int kind)
{
    const lane w = isph_weight(v, n, m, shape, kind);
    lane u[3];
    (void)i;
    isph_velocity(v, n, m, kind, u);
    a->x += w*(u[0] - a->ux); a->y += w*(u[1] - a->uy); a->z += w*(u[2] - a->uz);
}

TOBI_FN void isph_xsph_finish(const isph_view *v, int64_t i, isph_xsph_acc *a, double *totals)
{
    const tobi_float4 s = lane_sum4(a->x, a->y, a->z, lane_set(0));
    const float k = (float)(v->xsph*v->weight*v->dt/(v->way*v->way));
    (void)totals;
    v->accel[i].x += k*s.x;
    v->accel[i].y += k*s.y;
    if (v->dimension == 3) v->accel[i].z += k*s.z;
}

/* Sums of V F over slope times products of x_ij: second and higher moments, over r^2 or not; products with
   u_j - u_i. Pairs of axes: xx, yy, xy, zz, yz, zx; the first three in 2-D. */
typedef struct isph_viscosity_acc {
    lane ux, uy, uz, plain[3], all[3], slope[9];
    lane fourth[21], over[10], third[10], pair[18];
} isph_viscosity_acc;

TOBI_FN void isph_viscosity_start(const isph_view *v, int64_t i, isph_viscosity_acc *a)
{
    const tobi_float4 u = v->velocity[i];
    a->ux = lane_set(u.x); a->uy = lane_set(u.y); a->uz = lane_set(u.z);
    for (int k = 0; k < 3; k++) a->plain[k] = a->all[k] = lane_set(0);
    for (int k = 0; k < 9; k++) a->slope[k] = lane_set(0);
    for (int k = 0; k < 21; k++) a->fourth[k] = lane_set(0);
    for (int k = 0; k < 10; k++) a->over[k] = a->third[k] = lane_set(0);
    for (int k = 0; k < 18; k++) a->pair[k] = lane_set(0);
}

/* at: f, x, r2, u. A function of its own: three copies of it would take a minute to compile. */
TOBI_RARE_FN void isph_viscosity_add(isph_viscosity_acc *a, const lane at[8])
{
    const lane f = at[0], *x = at + 1, *u = at + 5;
    const lane w = f/(at[4] + 1e-30f);
    const lane p[6] = {x[0]*x[0], x[1]*x[1], x[0]*x[1], x[2]*x[2], x[1]*x[2], x[2]*x[0]};
    const lane cube[10] = {p[0]*x[0], p[0]*x[1], p[0]*x[2], p[2]*x[1], p[2]*x[2],
                           p[3]*x[0], p[1]*x[1], p[1]*x[2], p[3]*x[1], p[3]*x[2]};
    int n = 0;
    for (int k = 0; k < 10; k++) {
        a->third[k] += f*cube[k];
        a->over[k] += w*cube[k];
    }
    for (int k = 0; k < 6; k++)
        for (int l = k; l < 6; l++) a->fourth[n++] += w*(p[k]*p[l]);
    for (int k = 0; k < 6; k++)
        for (int c = 0; c < 3; c++) a->pair[3*k + c] += w*p[k]*u[c];
}

TOBI_FN void isph_viscosity_pair(const isph_view *v, int64_t i, const tobi_neighbors *n, const isph_image *m,
                                 isph_viscosity_acc *a, const int shape, const int kind)
{
    const lane f = isph_falloff(v, n, m, shape, kind), x[3] = {n->dx, n->dy, n->dz};
    lane u[3];
    (void)i;
    isph_velocity(v, n, m, kind, u);
    u[0] -= a->ux; u[1] -= a->uy; u[2] -= a->uz;
    for (int b = 0; b < 3; b++) {
        if (kind == ISPH_PLAIN) a->plain[b] += f*u[b];
        a->all[b] += f*u[b];
        for (int c = 0; c < 3; c++) a->slope[3*b + c] += f*u[b]*x[c];
    }
    const lane at[8] = {f, x[0], x[1], x[2], n->r2, u[0], u[1], u[2]};
    if (v->full_viscosity) isph_viscosity_add(a, at);
}

/* Of three axes, their place among the ten cubes. */
TOBI_FN int isph_cube(int a, int b, int c)
{
    const int place[4][4] = {{0, 2, 5, 9}, {1, 4, 8, 0}, {3, 7, 0, 0}, {6, 0, 0, 0}};      /* of y, z */
    const int y = (a == 1) + (b == 1) + (c == 1), z = (a == 2) + (b == 2) + (c == 2);
    return place[y][z];
}

/* Solves m x = b, n at most 6, in place; 0: a pivot is too small. */
TOBI_FN int isph_eliminate(double m[6][7], int n)
{
    for (int k = 0; k < n; k++) {
        int best = k;
        for (int r = k + 1; r < n; r++)
            if (m[r][k]*m[r][k] > m[best][k]*m[best][k]) best = r;
        if (!(m[best][k]*m[best][k] > ISPH_PIVOT_MIN*ISPH_PIVOT_MIN)) return 0;
        for (int c = k; c < 7; c++) {
            const double t = m[k][c];
            m[k][c] = m[best][c];
            m[best][c] = t;
        }
        for (int r = 0; r < n; r++) {
            const double share = r == k ? 0 : m[r][k]/m[k][k];
            for (int c = k; c < 7; c++) m[r][c] -= share*m[k][c];
        }
    }
    for (int k = 0; k < n; k++) m[k][6] /= m[k][k];
    return 1;
}

/* The Laplacian of Fatehi & Manzari (2011), from the gradient g of the velocity; 0: keep the simpler one. */
TOBI_FN int isph_viscosity_full(const isph_view *v, int64_t i, const isph_viscosity_acc *a, const double g[9],
                                double out[3])
{
    const int first[6] = {0, 1, 0, 2, 1, 2}, second[6] = {0, 1, 1, 2, 2, 0};
    const int pairs = v->dimension == 3 ? 6 : 3;
    const isph_tensor *b = &v->inverse[i];
    const double inverse[3][3] = {{b->xx, b->xy, b->zx}, {b->xy, b->yy, b->yz}, {b->zx, b->yz, b->zz}};
    double third[10], over[10], fourth[6][6], m[6][7];
    int n = 0;
    for (int k = 0; k < 10; k++) {
        third[k] = v->slope*lane_sum(a->third[k]);
        over[k] = v->slope*lane_sum(a->over[k]);
    }
    for (int k = 0; k < 6; k++)
        for (int l = k; l < 6; l++) fourth[k][l] = fourth[l][k] = v->slope*lane_sum(a->fourth[n++]);
    for (int r = 0; r < pairs; r++) {
        m[r][6] = first[r] == second[r];
        for (int c = 0; c < pairs; c++) {
            double sum = fourth[c][r];
            for (int e = 0; e < v->dimension; e++)
                for (int f = 0; f < v->dimension; f++)
                    sum -= over[isph_cube(first[c], second[c], e)]*inverse[e][f]*
                           third[isph_cube(f, first[r], second[r])];
            m[r][c] = (first[c] == second[c] ? 1 : 2)*sum;
        }
    }
    if (!isph_eliminate(m, pairs)) return 0;
    for (int x = 0; x < v->dimension; x++) {
        out[x] = 0;
        for (int c = 0; c < pairs; c++) {
            double sum = v->slope*lane_sum(a->pair[3*c + x]);
            for (int e = 0; e < v->dimension; e++) sum += over[isph_cube(first[c], second[c], e)]*g[3*x + e];
            out[x] += 2*(first[c] == second[c] ? 1 : 2)*m[c][6]*sum;
        }
    }
    return 1;
}

/* What viscosity gives in this step beyond the plain sum over neighbours, into shift_velocity; away from a
   free surface. */
TOBI_FN void isph_viscosity_finish(const isph_view *v, int64_t i, isph_viscosity_acc *a, double *totals)
{
    const int meets = v->phase && v->phase[i].z < (float)v->h;     /* sums below know one viscosity only */
    const double share = meets ? 0 : (1 - v->gate[i])*v->dt*v->kinematic[v->fluid[i]];
    double g[9], out[3] = {0, 0, 0};
    (void)totals;
    for (int x = 0; x < 3; x++) {
        double raw[3];
        for (int c = 0; c < 3; c++) raw[c] = -v->slope*lane_sum(a->slope[3*x + c]);
        isph_apply(&v->inverse[i], raw, &g[3*x]);
    }
    if (!v->full_viscosity || !isph_viscosity_full(v, i, a, g, out))
        for (int x = 0; x < 3; x++) {
            out[x] = 2*v->slope*lane_sum(a->all[x]);
            for (int c = 0; c < 3; c++) out[x] -= 2*g[3*x + c]*(&v->concentration_gradient[i].x)[c];
        }
    for (int x = 0; x < 3; x++)
        (&v->shift_velocity[i].x)[x] =
            x < v->dimension ? (float)(share*(out[x] - 2*v->slope*lane_sum(a->plain[x]))) : 0;
}
