/* Kernels of the answer that bodies give to pressure, and what particles see of bodies. */
#pragma once
#include "exec/pairs.h"

/* One fluid particle sees one body: what solves read of it, in 64 bytes. sph_fields.last_link names the
   last of a particle. */
typedef struct tobi_boundary_link {
    int32_t particle;
    int16_t body;
    uint8_t cut;              /* of a particle's last link: 1: a body separates it from a neighbour */
    int32_t previous;         /* the particle's link to an earlier body, -1 = none                */
    float distance;           /* m, from the particle to the body's surface                       */
    double gradient[3];       /* G = -sum A W n, 1/m                                              */
    double torque_arm[3];     /* -sum A W (x_b - centre) x n                                      */
} tobi_boundary_link;

/* What else it sees; entry k goes with link k. */
typedef struct tobi_boundary_entry {
    double wall_flux;         /* -sum A W n . v_b, 1/s                                            */
    double share;             /* lambda: share of the kernel inside or behind the body            */
    double steady;            /* of share: points fade in, tobi_boundary_rise                      */
    double height;            /* sum A W s, s the height above each point's plane                 */
    double hidden;            /* sum V F r^2 over cut pairs, by the dimension; in a particle's last  */
    double hydrostatic[3];    /* acceleration by the hydrostatic part of the mirrored pressure    */
    double friction[3];       /* acceleration by no-slip friction in this step                    */
    double couple[3];         /* on the body, beside it, per mass, m2/s2: of implicit viscosity   */
    double drag;              /* no-slip friction rate, 1/m2: a = -nu drag (v - v_body)_t         */
    double drag_velocity[3];  /* drag times mean body velocity, 1/(m s)                           */
    double foot[3];           /* closest point on the body, relative to the box                   */
    double foot_normal[3];    /* outward                                                          */
    double distance;          /* signed distance to the body, m                                   */
    double offset[3];         /* from foot to the particle, m                                     */
    double barycentric[3];    /* of foot in its triangle                                          */
    int32_t triangle;
} tobi_boundary_entry;

typedef struct tobi_couple_view {
    const tobi_boundary_link *link;
    const double (*answer)[6];       /* of each body: velocities, or accelerations per pressure; 0: none */
    const int32_t *last_link;        /* a particle's last entry, -1 = none                               */
    const tobi_record *record;       /* w: the pressure                                                  */
    tobi_float4 *wall;
    float *product;
} tobi_couple_view;

/* What the bodies that a particle sees make of their answers: -sum A W n . (v + w x arm), 1/s. */
TOBI_FN double couple_sum(const tobi_couple_view *v, int64_t i)
{
    double sum = 0;
    for (int64_t k = v->last_link[i]; k >= 0; k = v->link[k].previous) {
        const tobi_boundary_link *e = &v->link[k];
        const double *u = v->answer[e->body];
        sum += (e->gradient[0]*u[0] + e->gradient[1]*u[1] + e->gradient[2]*u[2]) +
               (e->torque_arm[0]*u[3] + e->torque_arm[1]*u[4] + e->torque_arm[2]*u[5]);
    }
    return sum;
}

TOBI_FN void couple_flux(const tobi_couple_view *v, int64_t i, double *totals)
{
    (void)totals;
    if (v->last_link[i] >= 0) v->wall[i].w += (float)couple_sum(v, i);
}

/* Over entries. totals: force and torque of the pressures on a body, without the factor of two volumes. */
TOBI_FN void couple_pressure(const tobi_couple_view *v, int64_t k, double *totals)
{
    const tobi_boundary_link *e = &v->link[k];
    const double q = v->record[e->particle].w;
    for (int a = 0; a < 3; a++) {
        totals[a] += q*e->gradient[a];
        totals[3 + a] += q*e->torque_arm[a];
    }
}

/* product = A q gains 2 J M^-1 (2 V J^T q), J the flux of all particles by the six velocities: symmetric.
   totals: q times what is gained, and that. */
TOBI_FN void couple_product(const tobi_couple_view *v, int64_t i, double *totals)
{
    if (v->last_link[i] < 0) return;
    const float before = v->product[i], after = before + (float)(2*couple_sum(v, i));
    v->product[i] = after;
    totals[0] += ((double)after - before)*v->record[i].w;
    totals[1] += (double)after - before;
}
