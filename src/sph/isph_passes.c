/* Passes of isph, in double over the pairs of the neighbour list: written once for 2-D and 3-D, with the
   images at walls made on the way. Drawback: one pair at a time and a root for each, where the lanes of
   sph.k.h take eight. */
#include "sph/isph_passes.h"
#include "exec/exec.h"
#include <string.h>

/* Of the relative loss of neighbours, 1 - tr M/dim: where the gate begins to open, and is open. */
static const double GATE_BEGIN = 0.05, GATE_OPEN = 0.15;
/* Least share of a row that is missing where the gate is open, per relative loss of neighbours: clusters
   whose rows are fuller than the lattice would float otherwise. */
static const double EXCESS_FLOOR = 0.5;
/* Most of kappa. */
static const double SCALE_MAX = 1.3;
/* Determinant below which M has no use. */
static const double DETERMINANT_MIN = 0.1;
/* Lack of volume that the source takes out at most. */
static const double STRETCH_MAX = 0.05;
/* Shift: pairs nearer than CORE spacings go apart by PUSH of the overlap each; SHIFT_MAX in spacings. */
static const double CORE = 0.8, PUSH = 0.25, SHIFT_MAX = 0.1;
/* Of tr M/dim: less are drops, which do not shift; less know no gradient of the velocity; more are the
   bulk. */
static const double DROP = 0.6, SPARSE = 0.75, BULK = 0.95;

static double clamp(double x, double low, double high) { return fmin(fmax(x, low), high); }

/* B = (1 - gamma) M^-1 + gamma. In 2-D zz = 1. */
static isph_tensor invert(const double m[6], double gate)
{
    const double a = m[0], b = m[1], c = m[2], d = m[3], e = m[4], f = m[5];
    const double xx = b*c - e*e, yy = a*c - f*f, zz = a*b - d*d, xy = e*f - d*c, yz = d*f - a*e,
                 zx = d*e - b*f, determinant = a*xx + d*xy + f*zx;
    if (!(determinant > DETERMINANT_MIN)) gate = 1;
    const double k = gate < 1 ? (1 - gate)/determinant : 0;
    return (isph_tensor){ (float)(k*xx + gate), (float)(k*yy + gate), (float)(k*zz + gate), (float)(k*xy),
                          (float)(k*yz), (float)(k*zx) };
}

static void measure(const isph_view *v, int64_t i)
{
    double m[6] = { 0 }, w = v->weight, g[3] = { 0 }, bodies = 0;
    ISPH_PAIRS(v, i, p) {
        const double f = isph_falloff(v, p), *x = p->x;
        for (int a = 0; a < 3; a++) {
            m[a] += f*x[a]*x[a];
            m[3 + a] += f*x[a]*x[(a + 1)%3];
            g[a] -= f*x[a];
        }
        w += isph_weight(v, p);
        if (p->body >= 0) bodies += f*p->r2;
    }
    /* one plane per body leaves gaps in its corners, which are no surface */
    const double sum = m[0] + m[1] + m[2], trace = fmax(sum, sum - bodies + v->dimension*v->behind[i]);
    const double loss = 1 - trace/v->dimension;
    const double gate = v->open ? clamp((loss - GATE_BEGIN)/(GATE_OPEN - GATE_BEGIN), 0, 1) : 0;
    if (v->dimension == 2) m[2] = 1;
    v->trace[i] = (float)trace;
    v->gate[i] = (float)gate;
    v->scale[i] = (float)fmin(SCALE_MAX, v->dimension/fmax(trace, BULK*v->dimension));
    v->filled[i] = (float)w;
    v->lack[i] = (tobi_float4){ (float)g[0], (float)g[1], (float)g[2], 0 };
    v->inverse[i] = invert(m, gate);
}

static void run_measure_geometry(const void *view, int64_t begin, int64_t end, double *totals)
{
    (void)totals;
    for (int64_t i = begin; i < end; i++) measure(view, i);
}

static void run_add_gravity(const void *view, int64_t begin, int64_t end, double *totals)
{
    const isph_view *v = view;
    (void)totals;
    for (int64_t i = begin; i < end; i++) {
        for (int a = 0; a < v->dimension; a++) (&v->velocity[i].x)[a] += (float)(v->dt*v->gravity[a]);
        v->velocity[i].w = 0;       /* eq. (6b) of boundaries.md: images leave nothing to make up */
    }
}

/* (u_j - u_i) . B grad W of one pair. */
static double diverge(const isph_view *v, int64_t i, const isph_pair *p, double f, double kick)
{
    const tobi_float4 *own = &v->velocity[i];
    double u[3], g[3];
    isph_velocity(v, p, kick, u);
    isph_apply(&v->inverse[i], p->x, g);
    return -f*((u[0] - own->x)*g[0] + (u[1] - own->y)*g[1] + (u[2] - own->z)*g[2]);
}

/* Pa/m2: what presses too dense liquid apart, and, in the bulk, pulls too thin liquid together, eq. (8). */
static double volume_source(const isph_view *v, int64_t i)
{
    const int bulk = v->trace[i] > BULK*v->dimension || !v->open;
    const double e = fmax(v->filled[i] - 1.0, bulk ? -STRETCH_MAX : 0);
    return v->density*v->volume_gain*e/(v->dt*v->motion_dt);
}

static double assemble(const isph_view *v, int64_t i)
{
    const double rate = v->density/v->dt;
    double sum = 0, self = 0, source = volume_source(v, i);
    for (int64_t k = 8*(int64_t)v->list_start[i], end = k + 8*(int64_t)v->list_groups[i]; k < end; k++)
        v->entry[k] = 0;
    ISPH_PAIRS(v, i, p) {
        const double f = isph_falloff(v, p), a = f*((double)v->scale[i] + v->scale[p->j]);
        source += a*isph_lift(v, p) - rate*diverge(v, i, p, f, v->dt);
        sum += a;
        if (p->k < 0) self += a;
        else v->entry[p->k] += (float)a;
    }
    const double loss = 1 - v->trace[i]/v->dimension;
    const double excess = 2*v->gate[i]*fmax(v->full - sum, EXCESS_FLOOR*loss*v->full);
    const double diagonal = sum - self + excess;
    v->source[i] = source;
    v->excess[i] = excess;
    v->inverse_diagonal[i] = diagonal > 0 ? 1/diagonal : 0;
    return excess;
}

static void run_assemble_rows(const void *view, int64_t begin, int64_t end, double *totals)
{
    for (int64_t i = begin; i < end; i++) totals[0] += assemble(view, i);
}

static void run_multiply(const void *view, int64_t begin, int64_t end, double *totals)
{
    const isph_view *v = view;
    (void)totals;
    for (int64_t i = begin; i < end; i++) {
        const double own = v->in[i];
        double sum = v->excess[i]*own;
        for (int64_t k = 8*(int64_t)v->list_start[i], stop = k + 8*(int64_t)v->list_groups[i]; k < stop; k++)
            sum += v->entry[k]*(own - v->in[v->list[k]]);
        v->out[i] = sum;
    }
}

/* The difference form, with B, in the bulk; the plain sum, with -p_i in place of missing neighbours, at a
   free surface; eq. (9). */
static void find_gradient(const isph_view *v, int64_t i, double out[3])
{
    const double own = v->pressure[i], mean = 2*v->gate[i]*own;
    double g[3] = { 0 };
    ISPH_PAIRS(v, i, p) {
        const double f = isph_falloff(v, p), q = v->pressure[p->j] + isph_lift(v, p) - own;
        for (int a = 0; a < 3; a++) g[a] -= q*f*p->x[a];
    }
    isph_apply(&v->inverse[i], g, out);
    for (int a = 0; a < 3; a++) out[a] += mean*(&v->lack[i].x)[a];
}

static void run_kick(const void *view, int64_t begin, int64_t end, double *totals)
{
    const isph_view *v = view;
    for (int64_t i = begin; i < end; i++) {
        double g[3];
        find_gradient(v, i, g);
        totals[0] += sqrt(g[0]*g[0] + g[1]*g[1] + g[2]*g[2]);
        for (int a = 0; a < v->dimension; a++) (&v->velocity[i].x)[a] -= (float)(v->dt/v->density*g[a]);
    }
}

static int has_images(const isph_view *v, int64_t i)
{
    const double *x = isph_place(v, i);
    for (int a = 0; a < v->dimension; a++)
        if (!v->periodic[a] && fmin(x[a], v->size[a] - x[a]) < v->h) return 1;
    return 0;
}

static void run_press_walls(const void *view, int64_t begin, int64_t end, double *totals)
{
    const isph_view *v = view;
    for (int64_t i = begin; i < end; i++) {
        const double own = v->pressure[i];
        if (!has_images(v, i)) continue;
        ISPH_PAIRS(v, i, p) {
            if (!p->image || p->body >= 0) continue;
            const double both = v->volume*(own + v->pressure[p->j] + isph_lift(v, p)), f = isph_falloff(v, p);
            for (int a = 0; a < v->dimension; a++) totals[a] -= both*f*p->x[a];
        }
    }
}

static void run_measure_divergence(const void *view, int64_t begin, int64_t end, double *totals)
{
    const isph_view *v = view;
    for (int64_t i = begin; i < end; i++) {
        double sum = 0;
        if (v->gate[i] > 0) continue;
        ISPH_PAIRS(v, i, p) sum += diverge(v, i, p, isph_falloff(v, p), 0);
        totals[0] += fabs(sum);
        totals[6] = fmax(totals[6], fabs(sum));
    }
}

/* Takes the part of x along n out. */
static void take_normal(double x[3], const double n[3])
{
    const double n2 = n[0]*n[0] + n[1]*n[1] + n[2]*n[2];
    if (!(n2 > 1e-24)) return;
    const double along = (x[0]*n[0] + x[1]*n[1] + x[2]*n[2])/n2;
    for (int a = 0; a < 3; a++) x[a] -= along*n[a];
}

/* Of the neighbours at the surface, images aside: what they lack, as directions. */
static void add_normal(const isph_view *v, const isph_pair *p, double normal[3])
{
    const float *c = &v->lack[p->j].x;
    const double weight = fmax(0, v->dimension - (double)v->trace[p->j]),
                 size = sqrt((double)c[0]*c[0] + (double)c[1]*c[1] + (double)c[2]*c[2]);
    for (int a = 0; a < 3; a++) normal[a] += weight*c[a]/(size + 1e-30);
}

typedef struct shift_sums { double core[3], normal[3], slope[3][3]; } shift_sums;

static void add_pair(const isph_view *v, int64_t i, const isph_pair *p, shift_sums *s)
{
    const double f = isph_falloff(v, p), r = sqrt(p->r2), overlap = CORE*v->spacing - r;
    double u[3];
    if (overlap > 0 && r > 0)
        for (int a = 0; a < 3; a++) s->core[a] += PUSH*overlap*p->x[a]/r;
    if (!p->image) add_normal(v, p, s->normal);
    isph_velocity(v, p, 0, u);
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) s->slope[a][b] -= (u[a] - (&v->velocity[i].x)[a])*f*p->x[b];
}

static void shift(const isph_view *v, int64_t i)
{
    const double full = v->trace[i]/(double)v->dimension, d = v->spacing;
    shift_sums s = { { 0 }, { 0 }, { { 0 } } };
    double x[3], size = 0;
    ISPH_PAIRS(v, i, p) add_pair(v, i, p, &s);
    for (int a = 0; a < 3; a++) x[a] = -v->shifting*d*d*(&v->lack[i].x)[a];
    if (v->open && full < DROP) memset(x, 0, sizeof x);
    else if (v->open && full < BULK) take_normal(x, s.normal);
    for (int a = 0; a < 3; a++) {
        x[a] = a < v->dimension ? x[a] + s.core[a] : 0;
        size += x[a]*x[a];
    }
    const double keep = size > SHIFT_MAX*SHIFT_MAX*d*d ? SHIFT_MAX*d/sqrt(size) : 1;
    const double part = v->open && full < SPARSE ? 0 : keep;
    double along[3];
    isph_apply(&v->inverse[i], x, along);
    for (int a = 0; a < 3; a++) {
        (&v->change[i].x)[a] =
            part*(s.slope[a][0]*along[0] + s.slope[a][1]*along[1] + s.slope[a][2]*along[2]);
        (&v->accel[i].x)[a] = (float)(keep*x[a]/(v->dt*v->dt));
    }
}

static void run_find_shift(const void *view, int64_t begin, int64_t end, double *totals)
{
    (void)totals;
    for (int64_t i = begin; i < end; i++) shift(view, i);
}

static void run_use_change(const void *view, int64_t begin, int64_t end, double *totals)
{
    const isph_view *v = view;
    (void)totals;
    for (int64_t i = begin; i < end; i++)
        for (int a = 0; a < v->dimension; a++) (&v->velocity[i].x)[a] += (float)(&v->change[i].x)[a];
}

const tobi_kernel isph_measure_geometry = { run_measure_geometry, 0, 0 };
const tobi_kernel isph_add_gravity = { run_add_gravity, 0, 0 };
const tobi_kernel isph_assemble_rows = { run_assemble_rows, 1, 0 };
const tobi_kernel isph_multiply = { run_multiply, 0, 0 };
const tobi_kernel isph_kick = { run_kick, 1, 0 };
const tobi_kernel isph_press_walls = { run_press_walls, 3, 0 };
const tobi_kernel isph_measure_divergence = { run_measure_divergence, 1, 1 };
const tobi_kernel isph_find_shift = { run_find_shift, 0, 0 };
const tobi_kernel isph_use_change = { run_use_change, 0, 0 };
