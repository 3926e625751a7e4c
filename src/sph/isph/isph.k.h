/* Kernels of isph, in the letters of docs/theory/isph.md: pair sums in float lanes, what is made of them in
   double. */
#pragma once
#include "sph/isph/images.k.h"
#include "sph/isph/phases.k.h"
#include "sph/isph/porous.k.h"
#include "sph/isph/soft.k.h"

/* Of the relative loss of neighbours, 1 - tr M/dim: where the gate begins to open, and is open. */
#define ISPH_GATE_BEGIN 0.10
#define ISPH_GATE_OPEN 0.20
/* The same of 1 less the least eigenvalue of M: 0.75 is the middle, as of Marrone et al. (2010). */
#define ISPH_EIGEN_BEGIN 0.20
#define ISPH_EIGEN_OPEN 0.30
/* What is missing towards a body is no free surface while the gap is narrow: distance of the particle from
   the body, in spacings, up to which the gate is shut, and from which it is free; the same of what is
   missing elsewhere, sum of V grad W times the spacing, and of the loss of neighbours, which drops have. */
#define ISPH_GAP_SHUT 1.75
#define ISPH_GAP_FREE 2.25
#define ISPH_GAP_GRADIENT_SHUT 0.15
#define ISPH_GAP_GRADIENT_FREE 0.25
#define ISPH_GAP_LOSS_SHUT 0.3
#define ISPH_GAP_LOSS_FREE 0.4
/* A gap that closes is air: how fast, over the largest speed, it may still be water, and is surely air. */
#define ISPH_GAP_CLOSING 0.1
#define ISPH_GAP_AIR 0.3
/* Least share of a row that is missing where the gate is open, per relative loss of neighbours: clusters
   whose rows are fuller than the lattice would float otherwise. */
#define ISPH_EXCESS_FLOOR 0.5
/* Of rows whose pressure is given, over the sum of a row on the lattice. */
#define ISPH_HELD_ROW 10.0
/* Most of kappa. */
#define ISPH_SCALE_MAX 1.3
/* Determinant of M up to which M^-1 has no use, as in drops, and from which it is taken whole: half a plane
   of neighbours has 0.4, half of space 0.3. */
#define ISPH_DETERMINANT_MIN 0.1
#define ISPH_DETERMINANT_FULL 0.2
/* Lack of volume that the source takes out at most, and in full vessels, where it fills cavities. */
#define ISPH_STRETCH_MAX 0.05
#define ISPH_CAVITY_MAX 0.5
/* Of the loss of neighbours: up to which that is whole, as of the row below a flat surface, and from which
   nothing pulls, as of drops that just touch. */
#define ISPH_STRETCH_WHOLE 0.03
#define ISPH_STRETCH_NONE 0.06
/* Error of volume that full vessels leave to the shift: what disorder makes, and the source would turn into
   motion. */
#define ISPH_VOLUME_LEFT 0.02
/* Of the loss of neighbours in full vessels: only particles next to alone in a cavity are a surface. */
#define ISPH_CAVITY_BEGIN 0.6
#define ISPH_CAVITY_OPEN 0.8
/* Loss of neighbours over that of a flat surface: up to which it is flat, and from which it is a tip. */
#define ISPH_FLAT 1.1
#define ISPH_TIP 1.2
/* Of tr M/dim: less are drops, which do not shift and know no gradient of the velocity; more are the bulk. */
#define ISPH_DROP 0.6
#define ISPH_BULK 0.95

/* Whether the pressure of a particle is no unknown: it lies in the buffer of an opening. */
TOBI_FN int isph_held(const isph_view *v, int64_t i) { return v->held && v->held[i].w != 0; }

TOBI_FN double isph_larger(double a, double b) { return a > b ? a : b; }
TOBI_FN double isph_clamp(double x, double low, double high) { return x < low ? low : x > high ? high : x; }

TOBI_FN double isph_length(const double x[3]) { return sqrt(x[0]*x[0] + x[1]*x[1] + x[2]*x[2]); }

TOBI_FN void isph_apply(const isph_tensor *t, const double x[3], double out[3])
{
    out[0] = t->xx*x[0] + t->xy*x[1] + t->zx*x[2];
    out[1] = t->xy*x[0] + t->yy*x[1] + t->yz*x[2];
    out[2] = t->zx*x[0] + t->yz*x[1] + t->zz*x[2];
}

/* 1 up to a, 0 from b. */
TOBI_FN double isph_fade(double x, double a, double b) { return isph_clamp((b - x)/(b - a), 0, 1); }

/* B of the velocity's gradient and divergence, eq. (4): M^-1, or 1 where that has no use. In 2-D zz = 1. */
TOBI_FN isph_tensor isph_invert(const double m[6])
{
    const double a = m[0], b = m[1], c = m[2], d = m[3], e = m[4], f = m[5];
    const double xx = b*c - e*e, yy = a*c - f*f, zz = a*b - d*d, xy = e*f - d*c, yz = d*f - a*e,
                 zx = d*e - b*f, determinant = a*xx + d*xy + f*zx;
    const double one = isph_fade(determinant, ISPH_DETERMINANT_MIN, ISPH_DETERMINANT_FULL),
                 k = one < 1 ? (1 - one)/determinant : 0;
    isph_tensor t = {(float)(k*xx + one), (float)(k*yy + one), (float)(k*zz + one), (float)(k*xy),
                     (float)(k*yz), (float)(k*zx)};
    return t;
}

/* M, the sums of V W and V grad W, and what bodies have of tr M; eq. (2) to (5). Where volume is kept, also
   those of the velocity's gradient, eq. (6b). totals: excess of the kernel sum away from a free surface, and
   the number of particles there. */
typedef struct isph_geometry_acc {
    lane xx, yy, zz, xy, yz, zx, w, gx, gy, gz, bodies, u[3], slope[9];
} isph_geometry_acc;

TOBI_FN void isph_geometry_start(const isph_view *v, int64_t i, isph_geometry_acc *a)
{
    double s[10] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    a->xx = a->yy = a->zz = a->xy = a->yz = a->zx = a->w = a->gx = a->gy = a->gz = a->bodies = lane_set(0);
    for (int c = 0; c < 3; c++) a->u[c] = lane_set((&v->velocity[i].x)[c]);
    for (int c = 0; c < 9; c++) a->slope[c] = lane_set(0);
    if (isph_soft_last(v, i) < 0) return;
    ISPH_SOFT_LINKS(v, i, k) {
        const sph_soft_link *l = &v->soft[k];
        const double g[3] = {l->gradient[0], l->gradient[1], l->gradient[2]}, f = 1/(v->slope*l->rate);
        for (int c = 0; c < 3; c++) {
            s[c] += f*g[c]*g[c];
            s[3 + c] += f*g[c]*g[(c + 1)%3];
            s[6 + c] -= g[c]/v->slope;
        }
        s[9] += l->share/v->weight;
    }
    a->xx = isph_first(s[0]); a->yy = isph_first(s[1]); a->zz = isph_first(s[2]);
    a->xy = isph_first(s[3]); a->yz = isph_first(s[4]); a->zx = isph_first(s[5]);
    a->gx = isph_first(s[6]); a->gy = isph_first(s[7]); a->gz = isph_first(s[8]);
    a->w = isph_first(s[9]);
}

TOBI_FN void isph_geometry_pair(const isph_view *v, int64_t i, const tobi_neighbors *n, const isph_image *m,
                                isph_geometry_acc *a, const int shape, const int kind)
{
    const lane f = isph_falloff(v, n, m, shape, kind), x = f*n->dx, y = f*n->dy, z = f*n->dz;
    (void)i;
    a->xx += x*n->dx; a->yy += y*n->dy; a->zz += z*n->dz;
    a->xy += x*n->dy; a->yz += y*n->dz; a->zx += z*n->dx;
    a->gx += x; a->gy += y; a->gz += z;
    a->w += isph_weight(v, n, m, shape, kind);
    if (kind == ISPH_BODY) a->bodies += f*n->r2;
    if (!v->keeps_volume) return;
    const lane at[3] = {n->dx, n->dy, n->dz};
    lane u[3];
    isph_velocity(v, n, m, kind, u);
    for (int b = 0; b < 3; b++) {
        u[b] = f*(u[b] - a->u[b]);
        for (int c = 0; c < 3; c++) a->slope[3*b + c] += u[b]*at[c];
    }
}

/* Least eigenvalue of M, in 2-D of its upper left part. */
TOBI_FN double isph_least(const double m[6], int dimension)
{
    const double mean = (m[0] + m[1] + (dimension == 3 ? m[2] : 0))/dimension;
    const double a = m[0] - mean, b = m[1] - mean, c = dimension == 3 ? m[2] - mean : 0;
    const double off = m[3]*m[3] + (dimension == 3 ? m[4]*m[4] + m[5]*m[5] : 0);
    const double p = sqrt((a*a + b*b + c*c + 2*off)/(dimension == 3 ? 6 : 2));
    if (dimension == 2 || !(p > 1e-12)) return mean - p;
    /* bisection of the characteristic polynomial: below every eigenvalue it is positive */
    double low = mean - 2*p, high = mean;
    for (int k = 0; k < 30; k++) {
        const double x = 0.5*(low + high), u = m[0] - x, w = m[1] - x, z = m[2] - x;
        const double minor = u*w - m[3]*m[3],
                     whole = z*minor - m[4]*(u*m[4] - m[3]*m[5]) + m[5]*(m[3]*m[4] - w*m[5]);
        if (u > 0 && minor > 0 && whole > 0) low = x;
        else high = x;
    }
    return 0.5*(low + high);
}

/* kappa, eq. (5). */
TOBI_FN double isph_scale(int dimension, double trace)
{
    const double scale = dimension/isph_larger(trace, ISPH_BULK*dimension);
    return scale < ISPH_SCALE_MAX ? scale : ISPH_SCALE_MAX;
}

/* e of eq. (6), for a row of that sum. */
TOBI_FN double isph_excess(const isph_view *v, double loss, double sum, double gate)
{
    return 2*gate*v->surface_row*isph_larger(v->full - sum, ISPH_EXCESS_FLOOR*loss*v->full);
}

/* What the shift asks of a neighbour at the surface, eq. (10b): as w of `concentration_gradient`, which
   gives it a direction. */
TOBI_FN tobi_float4 isph_weigh_gradient(const isph_view *v, tobi_float4 c, double trace)
{
    const double size = sqrt((double)c.x*c.x + (double)c.y*c.y + (double)c.z*c.z);
    c.w = (float)(isph_larger(0, v->dimension - trace)/(size + 1e-30));
    return c;
}

/* How surely the loss of neighbours is a narrow gap between i and a body: 0 to 1. c: sum of V grad W, which
   points away from what is missing. */
TOBI_FN double isph_gap(const isph_view *v, int64_t i, const tobi_float4 *c, double loss)
{
    double gap = 0;
    for (int32_t k = v->last_link ? v->last_link[i] : -1; k >= 0; k = v->mirror[k].previous) {
        const isph_mirror *m = &v->mirror[k];
        double along = 0, s2 = 0, rest2 = 0, closing = 0;
        for (int a = 0; a < 3; a++) along += (&c->x)[a]*m->normal[a];
        for (int a = 0; a < 3; a++) closing += (m->velocity[a] - (&v->velocity[i].x)[a])*m->normal[a];
        along = isph_larger(along, 0);
        for (int a = 0; a < 3; a++) {
            const double rest = (&c->x)[a] - along*m->normal[a];
            rest2 += rest*rest;
            s2 += m->offset[a]*m->offset[a];
        }
        const double narrow = isph_fade(sqrt(s2)/v->spacing, ISPH_GAP_SHUT, ISPH_GAP_FREE);
        const double towards = isph_fade(sqrt(rest2)*v->spacing, ISPH_GAP_GRADIENT_SHUT,
                                         ISPH_GAP_GRADIENT_FREE);
        const double kept = isph_fade(closing/(v->gap_speed + 1e-30), ISPH_GAP_CLOSING, ISPH_GAP_AIR);
        gap = isph_larger(gap, isph_clamp(4*m->share - 2, 0, 1)*narrow*towards*kept);
    }
    return gap*isph_fade(loss, ISPH_GAP_LOSS_SHUT, ISPH_GAP_LOSS_FREE);
}

/* tr (grad v grad v), 1/s2, eq. (6b), once B and tr M are known. */
TOBI_FN double isph_invariant(const isph_view *v, int64_t i, const isph_geometry_acc *a)
{
    double g[9], sum = 0;
    if (v->trace[i] < ISPH_DROP*v->dimension || isph_soft_last(v, i) >= 0) return 0;
    for (int b = 0; b < 3; b++) {
        double raw[3];
        for (int c = 0; c < 3; c++) raw[c] = -v->slope*lane_sum(a->slope[3*b + c]);
        isph_apply(&v->inverse[i], raw, &g[3*b]);
    }
    for (int b = 0; b < v->dimension; b++)
        for (int c = 0; c < v->dimension; c++) sum += g[3*b + c]*g[3*c + b];
    return sum;
}

TOBI_FN void isph_geometry_finish(const isph_view *v, int64_t i, isph_geometry_acc *a, double *totals)
{
    const double k = v->slope;
    const tobi_float4 main = lane_sum4(a->xx, a->yy, a->zz, a->w),
                      g = lane_sum4(a->gx, a->gy, a->gz, lane_set(0)),
                      off = lane_sum4(a->xy, a->yz, a->zx, a->bodies);
    double m[6] = {k*main.x, k*main.y, k*main.z, k*off.x, k*off.y, k*off.z};
    /* one plane per body leaves gaps in its corners, which are no surface */
    const double sum = m[0] + m[1] + m[2],
                 trace = isph_larger(sum, sum - k*off.w + v->dimension*v->body_share[i]);
    const double loss = 1 - trace/v->dimension;
    tobi_float4 gradient = {(float)(-k*g.x), (float)(-k*g.y), (float)(-k*g.z), 0};
    const double rule = v->by_mark ? v->gate[i]
                      : v->by_eigenvalue ? 1 - isph_fade(1 - isph_least(m, v->dimension), ISPH_EIGEN_BEGIN,
                                                         ISPH_EIGEN_OPEN)
                                         : 1 - isph_fade(loss, ISPH_GATE_BEGIN, ISPH_GATE_OPEN);
    const double gap = v->open && rule > 0 ? isph_gap(v, i, &gradient, loss) : 0;
    const double gate = v->open ? rule*(1 - gap) : 1 - isph_fade(loss, ISPH_CAVITY_BEGIN, ISPH_CAVITY_OPEN);
    const double around = v->weight*(1 + (double)main.w), filled = around + gap*isph_larger(1 - around, 0);
    if (!(gate > 0)) {
        totals[0] += filled - 1;
        totals[1] += 1;
    }
    if (v->dimension == 2) m[2] = 1;
    v->trace[i] = (float)trace;
    v->gate[i] = (float)gate;
    v->scale[i] = v->uniform_scale ? 1 : (float)isph_scale(v->dimension, trace);
    v->concentration[i] = (float)filled;
    v->concentration_gradient[i] = isph_weigh_gradient(v, gradient, trace);
    v->inverse[i] = isph_invert(m);
    if (v->keeps_volume) v->invariant[i] = (float)isph_invariant(v, i, a);
}

/* v += dt g, and what neighbours read while rows are made. */
TOBI_FN void isph_gravity(const isph_view *v, int64_t i, double *totals)
{
    float g[3], *u = &v->velocity[i].x;
    (void)totals;
    isph_gravity_at(v, i, g);
    if (v->acceleration.acts) {
        double turning[3];
        tobi_acceleration_by_velocity(&v->acceleration, u, turning);
        for (int a = 0; a < v->dimension; a++) u[a] += (float)(v->dt*turning[a]);
    }
    for (int a = 0; a < v->dimension; a++) u[a] += (float)v->dt*g[a];
    v->record[i].w = v->own_scale ? 0 : v->scale[i];
}

/* Pa/m2: what presses too dense liquid apart, and, in the bulk, pulls too thin liquid together, eq. (8). */
TOBI_FN double isph_volume_source(const isph_view *v, int64_t i, double divergence)
{
    const double loss = 1 - v->trace[i]/(double)v->dimension;
    const double least = v->gate[i] > 0 ? 0 : !v->open ? -ISPH_CAVITY_MAX
                       : -ISPH_STRETCH_MAX*isph_fade(loss, ISPH_STRETCH_WHOLE, ISPH_STRETCH_NONE);
    const tobi_float4 c = v->concentration_gradient[i];
    const double lack = v->surface_lack*v->spacing*sqrt((double)c.x*c.x + (double)c.y*c.y + (double)c.z*c.z),
                 error = v->volume_sum*(v->concentration[i] - 1 + lack) - v->volume_change*v->dt*divergence,
                 left = v->open ? 0 : ISPH_VOLUME_LEFT,
                 e = isph_larger(error - isph_clamp(error, -left, left), least);
    return v->density*v->volume_gain*e/(v->dt*v->volume_dt);
}

/* A row of the pressure equation, eq. (6), and its source, eq. (8). The start of the solve is the last
   pressure. totals: excess, source. */
typedef struct isph_rows_acc {
    lane ux, uy, uz, scale, bxx, byy, bzz, bxy, byz, bzx, sum, self, difference, divergence;
    lane px, py, pz;                 /* Pa/m: of liquid at rest, away from a free surface           */
    lane whole;                      /* of several fluids: the sum as of one                        */
    isph_lack_porous lack;           /* with porous zones                                           */
    float bodies;                    /* of self, by bodies */
} isph_rows_acc;

/* Points of soft solids: their pressure is that of i and the difference, which is known. */
TOBI_FN void isph_rows_soft(const isph_view *v, int64_t i, isph_rows_acc *a)
{
    double n[3], along[3], sum = 0, difference = 0, divergence = 0;
    isph_soft_normal(v, i, n);
    isph_apply(&v->inverse[i], n, along);
    ISPH_SOFT_LINKS(v, i, k) {
        const sph_soft_link *l = &v->soft[k];
        const double entry = 2*(double)v->scale[i]*l->rate;
        sum += entry;
        difference += entry*isph_soft_difference(v, l, n);
        divergence -= isph_soft_speed(v, i, l, n)/v->slope*
                      (along[0]*l->gradient[0] + along[1]*l->gradient[1] + along[2]*l->gradient[2]);
    }
    a->sum = a->self = isph_first(sum);
    a->difference = isph_first(difference);
    a->divergence = isph_first(divergence);
}

/* Pa/m, of a share of gravity. Points of soft solids have a pressure difference of their own. */
TOBI_FN void isph_rest(const isph_view *v, int64_t i, double share, lane rest[3])
{
    const float rho = isph_soft_last(v, i) >= 0 ? 0 : (float)(share*v->density);
    float g[3];
    isph_gravity_at(v, i, g);
    for (int c = 0; c < 3; c++) rest[c] = lane_set(rho*g[c]);
}

TOBI_FN void isph_rows_start(const isph_view *v, int64_t i, isph_rows_acc *a)
{
    const tobi_float4 u = v->velocity[i];
    const isph_tensor b = v->inverse[i];
    a->ux = lane_set(u.x); a->uy = lane_set(u.y); a->uz = lane_set(u.z);
    a->bxx = lane_set(b.xx); a->byy = lane_set(b.yy); a->bzz = lane_set(b.zz);
    a->bxy = lane_set(b.xy); a->byz = lane_set(b.yz); a->bzx = lane_set(b.zx);
    a->scale = lane_set(v->own_scale ? 2*v->scale[i] : v->scale[i]);
    a->sum = a->self = a->difference = a->divergence = lane_set(0);
    const int soft = isph_soft_last(v, i) >= 0;
    lane rest[3];
    isph_rest(v, i, 1 - v->gate[i], rest);      /* away from a free surface */
    a->px = rest[0]; a->py = rest[1]; a->pz = rest[2];
    a->bodies = 0;
    if (soft) isph_rows_soft(v, i, a);
    a->whole = a->sum;
    isph_begin_lack(&a->lack);
}

/* Into the entries of the list: images add to those of their pairs. */
TOBI_FN void isph_rows_enter(const isph_view *v, const isph_image *m, lane a, const int kind)
{
    if (kind == ISPH_BODY) {
        for (int k = 0; k < TOBI_LANES; k++)
            if (m->entry[k] >= 0) v->entry[m->entry[k]] += lane_at(a, k);
        return;
    }
    if (kind == ISPH_SIDE && m->k >= 0) a += lane_load(&v->entry[m->k]);
    if (m->k >= 0) lane_store(&v->entry[m->k], a);
}

TOBI_FN void isph_rows_pair(const isph_view *v, int64_t i, const tobi_neighbors *n, const isph_image *m,
                            isph_rows_acc *c, const int shape, const int kind)
{
    const lane f = isph_falloff(v, n, m, shape, kind);
    lane u[3], a = (float)v->slope*f*(c->scale + n->w);
    isph_velocity(v, n, m, kind, u);
    const lane x = c->bxx*n->dx + c->bxy*n->dy + c->bzx*n->dz, y = c->bxy*n->dx + c->byy*n->dy + c->byz*n->dz,
               z = c->bzx*n->dx + c->byz*n->dy + c->bzz*n->dz;
    c->divergence += f*((u[0] - c->ux)*x + (u[1] - c->uy)*y + (u[2] - c->uz)*z);
    lane rest = c->px*n->dx + c->py*n->dy + c->pz*n->dz, image = isph_pressure_difference(v, m, kind);
    if (v->phase) {
        const isph_pair_phase phase = isph_see_phase(v, i, n, kind);
        c->whole += a;
        a = a/phase.face;
        image = image*phase.image + phase.jump;
        rest = rest*phase.face;
    }
    if (v->porous) {
        const tobi_float4 g = v->concentration_gradient[i];
        const lane share = isph_see_porous(v, i, n).share;
        isph_add_lack(&c->lack, -a*(g.x*n->dx + g.y*n->dy + g.z*n->dz), share);
        if (!v->phase) c->whole += a;
        a = a*share;
    }
    c->difference += a*(image + rest);
    c->sum += a;
    if (kind == ISPH_SIDE && m->k < 0) c->self += a;
    if (kind == ISPH_BODY)
        for (int k = 0; k < TOBI_LANES; k++)
            if (m->entry[k] < 0) c->bodies += lane_at(a, k);
    isph_rows_enter(v, m, a, kind);
}

/* The row of a particle whose pressure is given: the unknown is 0 there, what neighbours make of the pressure
   stands in their sources (solve.c). */
TOBI_FN void isph_rows_hold(const isph_view *v, int64_t i, double *totals)
{
    const int64_t first = 8*(int64_t)v->list_start[i];
    for (int k = 0; k < 8*v->list_groups[i]; k++) v->entry[first + k] = 0;
    v->excess[i] = ISPH_HELD_ROW*v->full;
    v->inverse_diagonal[i] = 1/v->excess[i];
    v->solution[i] = v->source[i] = 0;
    totals[0] += v->excess[i];
}

TOBI_FN void isph_rows_finish(const isph_view *v, int64_t i, isph_rows_acc *a, double *totals)
{
    if (isph_held(v, i)) {
        isph_rows_hold(v, i, totals);
        return;
    }
    const tobi_float4 t = lane_sum4(a->sum, a->self, a->difference, a->divergence);
    const double loss = 1 - v->trace[i]/v->dimension;
    const double whole = v->phase || v->porous ? lane_sum(a->whole) : t.x,
                 open = isph_open(v, i, &a->lack);
    const double others = t.x - t.y - a->bodies;     /* rounding, of a drop that solids close in */
    const double excess = others > 1e-6*open*v->full
                        ? open*isph_excess(v, loss, whole, v->gate[i])/isph_density_of(v, i) : v->full;
    const double diagonal = others + excess;
    v->source[i] = isph_volume_source(v, i, -v->slope*t.w) + t.z + v->density/v->dt*v->slope*t.w;
    if (v->keeps_volume) v->source[i] += 0.5*v->density*v->invariant[i];
    if (v->capillary) v->source[i] += excess*v->capillary[i];
    v->excess[i] = excess;
    v->inverse_diagonal[i] = diagonal > 0 ? 1/diagonal : 0;
    v->solution[i] = v->keep*v->pressure[i] + (1 - v->keep)*v->base;
    totals[0] += excess;
    totals[1] += v->source[i];
}

/* A full vessel keeps its volume: its sources add up to nothing, or the rows of a cavity drain the rest. */
TOBI_FN void isph_balance(const isph_view *v, int64_t i, double *totals)
{
    (void)totals;
    v->source[i] -= v->source_mean;
}

/* out = A in. Eight sums, one tree. */
TOBI_FN void isph_multiply(const isph_view *v, int64_t i, double *totals)
{
    const double own = v->in[i];
    const int64_t first = 8*(int64_t)v->list_start[i];
    const int count = 8*v->list_groups[i];
    int32_t unpacked[TOBI_LIST_LIMIT];
    const int32_t *j = tobi_list_load(v->list, v->list_far, i, first, count, unpacked);
    const float *a = v->entry + first;
    double s[8] = {0, 0, 0, 0, 0, 0, 0, 0};
    (void)totals;
    for (int g = 0; g < count; g += 8)
        for (int k = 0; k < 8; k++) s[k] += a[g + k]*(own - v->in[j[g + k]]);
    v->out[i] = v->excess[i]*own + (((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7])));
}

/* out = in over the diagonal of the matrix. */
TOBI_FN void isph_diagonal(const isph_view *v, int64_t i, double *totals)
{
    (void)totals;
    v->out[i] = v->inverse_diagonal[i]*v->in[i];
}

/* Over entries of what particles see of bodies: eq. (13). */
TOBI_FN void isph_body_force(const isph_view *v, int64_t k, double *totals)
{
    const double p = v->in[v->link[k].particle];
    for (int a = 0; a < 6; a++) totals[a] += v->coupling[k].f[a]*p;
}

/* The row of the accelerations that bodies answer with, eq. (15b). */
TOBI_FN void isph_add_answer(const isph_view *v, int64_t i, double *totals)
{
    double sum = 0;
    (void)totals;
    for (int32_t k = v->last_link[i]; k >= 0; k = v->link[k].previous)
        for (int a = 0; a < 6; a++) sum += v->coupling[k].f[a]*v->answer[v->link[k].body][a];
    if (v->last_link[i] >= 0) v->out[i] += v->density/v->volume*sum;
}

/* The answer of the solve, for neighbours to read. */
TOBI_FN void isph_store_pressure(const isph_view *v, int64_t i, double *totals)
{
    (void)totals;
    if (!isph_held(v, i)) v->pressure[i] = (float)v->solution[i];
    v->record[i].w = v->pressure[i];
}

/* v -= dt/rho grad p, eq. (9): the difference form, with M^-1, in the bulk; the plain sum, with -p_i in place
   of missing neighbours, at a free surface: corrected there, it would throw particles out. Along a flat
   surface the difference form stays: else the top row slides (decision 103). totals: |grad p|. */
typedef struct isph_projection_acc {
    lane p, x, y, z;
    lane rest[3], fall[3];           /* Pa/m: rho g; what zones take of it, by pairs                */
    isph_lack_porous lack;
} isph_projection_acc;

TOBI_FN void isph_projection_start(const isph_view *v, int64_t i, isph_projection_acc *a)
{
    a->p = lane_set(v->pressure[i]);
    a->x = a->y = a->z = a->rest[0] = a->rest[1] = a->rest[2] = lane_set(0);
    a->fall[0] = a->fall[1] = a->fall[2] = lane_set(0);
    isph_begin_lack(&a->lack);
    if (v->porous) isph_rest(v, i, 1, a->rest);
    if (isph_soft_last(v, i) < 0) return;
    double n[3], s[3] = {0, 0, 0};
    isph_soft_normal(v, i, n);
    ISPH_SOFT_LINKS(v, i, k)
        for (int c = 0; c < 3; c++)
            s[c] -= isph_soft_difference(v, &v->soft[k], n)/v->slope*v->soft[k].gradient[c];
    a->x = isph_first(s[0]); a->y = isph_first(s[1]); a->z = isph_first(s[2]);
}

/* How the drag of a pair stands for that of what is missing. */
TOBI_FN void isph_see_lack(const isph_view *v, int64_t i, const tobi_neighbors *n, lane f,
                           const isph_pair_porous *porous, isph_lack_porous *lack)
{
    const tobi_float4 c = v->concentration_gradient[i];
    const lane along = c.x*n->dx + c.y*n->dy + c.z*n->dz, weight = f*along*along;
    float g[3];
    isph_gravity_at(v, i, g);
    isph_add_lack(lack, weight, porous->share);
    isph_add_taken(v, i, n, porous->inverse, weight, g, lack->taken);
}

TOBI_FN void isph_projection_pair(const isph_view *v, int64_t i, const tobi_neighbors *n, const isph_image *m,
                            isph_projection_acc *a, const int shape, const int kind)
{
    const lane f = isph_falloff(v, n, m, shape, kind), image = isph_pressure_difference(v, m, kind);
    lane q = f*(n->w + image - a->p);
    if (v->phase) {
        const isph_pair_phase phase = isph_see_phase(v, i, n, kind);
        q = f*(n->w + image*phase.image + phase.jump - a->p)/phase.face;
    }
    a->x += q*n->dx; a->y += q*n->dy; a->z += q*n->dz;
    if (!v->porous) return;
    const isph_pair_porous porous = isph_see_porous(v, i, n);
    const lane less = porous.inverse*q,
               fall = porous.inverse*f*(a->rest[0]*n->dx + a->rest[1]*n->dy + a->rest[2]*n->dz);
    a->x -= less*porous.part[0]; a->y -= less*porous.part[1]; a->z -= less*porous.part[2];
    for (int c = 0; c < 3; c++) a->fall[c] += fall*porous.part[c];
    if (v->gate[i] > 0) isph_see_lack(v, i, n, f, &porous, &a->lack);
}

/* How surely the surface at i is flat: 0 to 1. */
TOBI_FN double isph_flatness(const isph_view *v, int64_t i)
{
    const double loss = 1 - v->trace[i]/v->dimension;
    return isph_fade(loss, ISPH_FLAT*v->surface_loss, ISPH_TIP*v->surface_loss);
}

/* Takes that share of the part of x across n out. */
TOBI_FN void isph_keep_along(double x[3], tobi_float4 n, double share)
{
    const double n2 = (double)n.x*n.x + (double)n.y*n.y + (double)n.z*n.z;
    if (!(n2 > 1e-24)) return;
    const double along = share*(x[0]*n.x + x[1]*n.y + x[2]*n.z)/n2;
    x[0] = (1 - share)*x[0] + along*n.x;
    x[1] = (1 - share)*x[1] + along*n.y;
    x[2] = (1 - share)*x[2] + along*n.z;
}

/* What zones take from gravity: by pairs, as from the pressure; at a free surface, across it, as they take it
   from the pressure there. Drops have no pairs. */
TOBI_FN void isph_brake_fall(const isph_view *v, int64_t i, const isph_projection_acc *a, double gradient[3])
{
    const double all = lane_sum(a->lack.all),
                 own = all > 0 ? 0 : v->gate[i]*v->density/(1 + sph_porous_drag(v->porous[i]));
    const tobi_float4 n = v->concentration_gradient[i];
    const double n2 = (double)n.x*n.x + (double)n.y*n.y + (double)n.z*n.z;
    double raw[3], taken[3], more = 0;
    float g[3], part[3];
    for (int c = 0; c < 3; c++) raw[c] = v->slope*lane_sum(a->fall[c]);
    isph_apply(&v->inverse[i], raw, taken);
    isph_gravity_at(v, i, g);
    sph_porous_part(v->porous[i], g, part);
    for (int c = 0; c < 3 && all > 0; c++)
        more += v->gate[i]*(v->density*lane_sum(a->lack.taken[c])/all - taken[c])*(&n.x)[c];
    for (int c = 0; c < v->dimension; c++)
        gradient[c] += taken[c] + more/(n2 + 1e-30)*(&n.x)[c] + own*part[c];
}

TOBI_FN void isph_projection_finish(const isph_view *v, int64_t i, isph_projection_acc *a, double *totals)
{
    const tobi_float4 s = lane_sum4(a->x, a->y, a->z, lane_set(0));
    const double open = isph_open(v, i, &a->lack), own = open*v->pressure[i]/isph_density_of(v, i),
                 outside = v->capillary ? open*v->capillary[i]/isph_density_of(v, i) : 0,
                 mean = 2*v->gate[i]*v->surface_force*(own - outside),
                 k = -v->slope;
    double x[3] = {k*s.x, k*s.y, k*s.z};
    double g[3], lack[3];
    if (v->own_pressure > 0)
        for (int c = 0; c < 3; c++)
            x[c] += v->own_pressure*(1 - v->gate[i])*own*(&v->concentration_gradient[i].x)[c];
    isph_apply(&v->inverse[i], x, g);
    if (v->as_summed)
        for (int c = 0; c < 3; c++) g[c] = x[c];
    for (int c = 0; c < 3; c++)
        lack[c] = v->gate[i]*(x[c] - g[c]) + mean*(&v->concentration_gradient[i].x)[c];
    isph_keep_along(lack, v->concentration_gradient[i], isph_flatness(v, i));
    for (int c = 0; c < 3; c++) g[c] += lack[c];
    if (v->porous) isph_brake_fall(v, i, a, g);
    totals[0] += sqrt(g[0]*g[0] + g[1]*g[1] + g[2]*g[2]);
    for (int c = 0; c < v->dimension; c++) (&v->velocity[i].x)[c] -= (float)(v->dt/v->density*g[c]);
}
