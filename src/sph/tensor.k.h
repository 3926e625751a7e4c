/* T, what makes grad W of a particle exact where neighbours are in disorder, eq. (7c) of
   docs/theory/dfsph.md, or missing, eq. (7b) of boundaries.md. Symmetric; in 2-D zz = 1 and no shear. */
#pragma once
#include "exec/pairs.h"
#include "sph/view.h"

typedef struct sph_tensor { lane xx, yy, zz, xy, yz, zx; int due; } sph_tensor;

TOBI_FN int sph_tensor_due(const sph_view *v, int64_t i)
{
    return v->stretch && (v->full || v->near_body[i]);
}

TOBI_FN sph_tensor sph_tensor_of(const sph_view *v, int64_t i)
{
    sph_tensor t = {lane_set(1), lane_set(1), lane_set(1), lane_set(0), lane_set(0), lane_set(0),
                    sph_tensor_due(v, i)};
    if (!t.due) return t;
    tobi_float4 a = v->stretch[i], b = v->shear[i];
    t.xx = lane_set(a.x); t.yy = lane_set(a.y); t.zz = lane_set(a.z); t.xy = lane_set(a.w);
    t.yz = lane_set(b.x); t.zx = lane_set(b.y);
    return t;
}

/* p T + w T_j for the neighbours j. */
TOBI_FN sph_tensor sph_tensor_both(const sph_view *v, const sph_tensor *own, lane p, const tobi_neighbors *n)
{
    sph_tensor t, other;
    lane unused;
    lane_load_float4(v->stretch, n->j, &other.xx, &other.yy, &other.zz, &other.xy);
    t.due = 1;
    t.xx = p*own->xx + n->w*other.xx;
    t.yy = p*own->yy + n->w*other.yy;
    t.xy = p*own->xy + n->w*other.xy;
    t.zz = t.yz = t.zx = lane_set(0);
    if (v->dimension == 2) return t;
    lane_load_float4(v->shear, n->j, &other.yz, &other.zx, &unused, &unused);
    t.zz = p*own->zz + n->w*other.zz;
    t.yz = p*own->yz + n->w*other.yz;
    t.zx = p*own->zx + n->w*other.zx;
    return t;
}

TOBI_FN void sph_tensor_times(const sph_tensor *t, lane x, lane y, lane z, lane out[3])
{
    out[0] = t->xx*x + t->xy*y + t->zx*z;
    out[1] = t->xy*x + t->yy*y + t->yz*z;
    out[2] = t->zx*x + t->yz*y + t->zz*z;
}

/* Sums over neighbours of a weight times x x. */
typedef struct sph_moments { lane xx, yy, zz, xy, yz, zx; } sph_moments;

TOBI_FN void sph_moments_clear(sph_moments *m)
{
    m->xx = m->yy = m->zz = m->xy = m->yz = m->zx = lane_set(0);
}

TOBI_FN void sph_moments_add(sph_moments *m, lane f, const tobi_neighbors *n)
{
    lane x = f*n->dx, y = f*n->dy, z = f*n->dz;
    m->xx += x*n->dx; m->yy += y*n->dy; m->zz += z*n->dz;
    m->xy += x*n->dy; m->yz += y*n->dz; m->zx += z*n->dx;
}

/* A symmetric matrix of plain numbers, while T is made. */
typedef struct sph_matrix { float xx, yy, zz, xy, yz, zx; } sph_matrix;

TOBI_FN sph_matrix sph_moments_sum(const sph_moments *m, float k)
{
    sph_matrix out = {k*lane_sum(m->xx), k*lane_sum(m->yy), k*lane_sum(m->zz),
                      k*lane_sum(m->xy), k*lane_sum(m->yz), k*lane_sum(m->zx)};
    return out;
}

/* Sum of the squares of T x: that of T T with the moments. */
TOBI_FN float sph_matrix_squares(const sph_matrix *t, const sph_moments *m)
{
    sph_matrix q = sph_moments_sum(m, 1);
    float xx = t->xx*t->xx + t->xy*t->xy + t->zx*t->zx, yy = t->xy*t->xy + t->yy*t->yy + t->yz*t->yz,
          zz = t->zx*t->zx + t->yz*t->yz + t->zz*t->zz, xy = t->xx*t->xy + t->xy*t->yy + t->zx*t->yz,
          yz = t->xy*t->zx + t->yy*t->yz + t->yz*t->zz, zx = t->xx*t->zx + t->xy*t->yz + t->zx*t->zz;
    return xx*q.xx + yy*q.yy + zz*q.zz + 2*(xy*q.xy + yz*q.yz + zx*q.zx);
}

/* walled: T makes up for a wall. */
TOBI_FN void sph_tensor_store(const sph_view *v, int64_t i, const sph_matrix *t, int walled)
{
    tobi_float4 a = {t->xx, t->yy, t->zz, t->xy}, b = {t->yz, t->zx, (float)walled, 0};
    v->stretch[i] = a;
    v->shear[i] = b;
}

TOBI_FN int sph_walled(const sph_view *v, int64_t i) { return sph_tensor_due(v, i) && v->shear[i].z > 0; }

TOBI_FN tobi_float4 sph_unit(tobi_float4 g)
{
    float size2 = g.x*g.x + g.y*g.y + g.z*g.z, unit = size2 > 0 ? 1/sqrtf(size2) : 0;
    tobi_float4 n = {unit*g.x, unit*g.y, unit*g.z, 0};
    return n;
}

/* n n^T + (I - n n^T)/(1 - L), eq. (7b): n the wall's normal, L the share that a lattice lacks, at most that
   of a particle almost on the wall: edges have more. */
TOBI_FN sph_matrix sph_along_wall(tobi_float4 gradient, float lack, int dimension)
{
    tobi_float4 n = sph_unit(gradient);
    lack = lack < 0.45f ? lack : 0.45f;
    float w = lack/(1 - lack), one = 1 + w;
    sph_matrix t = {one - w*n.x*n.x, one - w*n.y*n.y, one - w*n.z*n.z,
                    -w*n.x*n.y, -w*n.y*n.z, -w*n.z*n.x};
    if (dimension == 2) t.zz = 1;
    return t;
}

/* M^-1, M with the sums of V F x x. 0 where the neighbours lie on one side or in a plane. */
TOBI_FN int sph_invert(const sph_matrix *m, sph_matrix *out)
{
    float a = m->yy*m->zz - m->yz*m->yz, d = m->zx*m->yz - m->xy*m->zz, e = m->xy*m->yz - m->zx*m->yy;
    float det = m->xx*a + m->xy*d + m->zx*e;
    if (!(det > 1e-3f)) return 0;
    float k = 1/det;
    sph_matrix b = {k*a, k*(m->xx*m->zz - m->zx*m->zx), k*(m->xx*m->yy - m->xy*m->xy),
                    k*d, k*(m->xy*m->zx - m->xx*m->yz), k*e};
    *out = b;
    return 1;
}

TOBI_FN tobi_float4 sph_matrix_times(const sph_matrix *m, tobi_float4 x)
{
    tobi_float4 out = {m->xx*x.x + m->xy*x.y + m->zx*x.z, m->xy*x.x + m->yy*x.y + m->yz*x.z,
                       m->zx*x.x + m->yz*x.y + m->zz*x.z, 0};
    return out;
}

/* m^-1, m positive: in double, as m may be close to singular. */
TOBI_FN sph_matrix sph_inverse(const sph_matrix *m)
{
    const double xx = m->xx, yy = m->yy, zz = m->zz, xy = m->xy, yz = m->yz, zx = m->zx;
    const double a = yy*zz - yz*yz, d = zx*yz - xy*zz, e = xy*yz - zx*yy, k = 1/(xx*a + xy*d + zx*e);
    return (sph_matrix){(float)(k*a), (float)(k*(xx*zz - zx*zx)), (float)(k*(xx*yy - xy*xy)), (float)(k*d),
                        (float)(k*(xy*zx - xx*yz)), (float)(k*e)};
}

/* The symmetric part of (I - w n n^T) M^-1, eq. (7c), with w what M lacks along the wall's normal; b = M^-1.
   0 where that is none to use. */
TOBI_FN int sph_tilt(const sph_matrix *m, const sph_matrix *b, tobi_float4 gradient, float share,
                     sph_matrix *t)
{
    tobi_float4 n = sph_unit(gradient), mn = sph_matrix_times(m, n), bn = sph_matrix_times(b, n);
    float fade = share < 0.02f ? 50*share : 1, half = 0.5f*fade*(1 - (n.x*mn.x + n.y*mn.y + n.z*mn.z));
    float x = half*bn.x, y = half*bn.y, z = half*bn.z;
    t->xx = b->xx - 2*n.x*x;
    t->yy = b->yy - 2*n.y*y;
    t->zz = b->zz - 2*n.z*z;
    t->xy = b->xy - (n.x*y + n.y*x);
    t->yz = b->yz - (n.y*z + n.z*y);
    t->zx = b->zx - (n.z*x + n.x*z);
    return t->xx > 0 && t->yy > 0 && t->zz > 0 && t->xx < 20 && t->yy < 20 && t->zz < 20;
}
