/* Pressure, level and velocity at places: averages of the particles around, each method by its own
   walls. Drawback: a probe nearer than a support to a corner has few particles to ask. */
#include "sph/state.h"
#include "sph/boundary/boundary.h"
#include "sph/hydrostatic.h"
#include "sph/sensor/around.h"
#include "sph/sensor/probe.h"
#include <math.h>
#include <string.h>

#define RADIUS 3.0          /* of the fit, spacings */
#define NARROW 2.0          /* the same in the midst of liquid */
#define MOVED 1.0           /* spacings that particles may have gone since the last sort */
#define DRY 0.1             /* share of the kernel, a place with less before it is dry */
#define ON_WALL 0.5         /* a point nearer to a surface than this sits on it, spacings */
enum { BASIS = 4, SCALARS = 4, CHANGES = SCALARS + TOBI_SCALAR_LIMIT, VALUES = CHANGES + 3 };

/* Normal equations of the fit: basis 1, x, y, z in radii; right sides pressure, velocity, scalars and, where
   nests ask for them, changes of velocity in the last step. */
typedef struct fit {
    const tobi_system *s;
    double radius, matrix[BASIS][BASIS], right[BASIS][VALUES];
    int count;
} fit;

static void add_to_fit(void *user, int64_t i, const double d[3])
{
    fit *f = user;
    double q = sqrt(d[0]*d[0] + d[1]*d[1] + d[2]*d[2])/f->radius;
    if (q >= 1) return;
    double w = (1 - q)*(1 - q)*(1 - q)*(1 - q)*(1 + 4*q);
    const double basis[BASIS] = {1, d[0]/f->radius, d[1]/f->radius, d[2]/f->radius};
    const tobi_float4 *v = &f->s->particles.velocity[i];
    const sph_fields *own = sph_fields_of(&f->s->particles);
    const tobi_float4 *before = tobi_simulation_before(f->s->sim, f->s->particles.id[i]);
    const double value[VALUES] = {own->pressure[i], v->x, v->y, v->z, own->scalars ? own->scalars[i].x : 0,
                                  own->scalars ? own->scalars[i].y : 0, before ? v->x - before->x : 0,
                                  before ? v->y - before->y : 0, before ? v->z - before->z : 0};
    f->count++;
    for (int a = 0; a < BASIS; a++) {
        for (int b = 0; b < BASIS; b++) f->matrix[a][b] += w*basis[a]*basis[b];
        for (int k = 0; k < VALUES; k++) f->right[a][k] += w*basis[a]*value[k];
    }
}

/* Gauss elimination of the n leading rows without pivoting (the matrix is positive definite). 0 where the
   particles do not span the space: a pivot below a hundredth of its diagonal. */
static int eliminate(fit *f, int n)
{
    for (int p = 0; p < n; p++) {
        double whole = f->matrix[p][p];
        for (int a = 0; a < p; a++) whole -= f->matrix[p][a]*f->matrix[a][p]/f->matrix[a][a];
        if (!(whole > 1e-2*f->matrix[p][p]) || !(whole > 0)) return 0;
        f->matrix[p][p] = whole;
        for (int b = p + 1; b < n; b++)
            for (int a = 0; a < p; a++) f->matrix[p][b] -= f->matrix[p][a]*f->matrix[a][b]/f->matrix[a][a];
        for (int k = 0; k < VALUES; k++)
            for (int a = 0; a < p; a++) f->right[p][k] -= f->matrix[p][a]*f->right[a][k]/f->matrix[a][a];
        for (int b = p + 1; b < n; b++) f->matrix[b][p] = f->matrix[p][b];
    }
    return 1;
}

/* The value at the probe is the first coefficient. */
static void substitute(const fit *f, int n, double value[VALUES])
{
    for (int k = 0; k < VALUES; k++) {
        double c[BASIS] = {0};
        for (int p = n - 1; p >= 0; p--) {
            c[p] = f->right[p][k];
            for (int b = p + 1; b < n; b++) c[p] -= f->matrix[p][b]*c[b];
            c[p] /= f->matrix[p][p];
        }
        value[k] = c[0];
    }
}

/* A place on a surface and the traction of the fluid there: equations (6) and (8) per area, or, at mirrors,
   the pressure (12) of docs/theory/isph.md. */
typedef struct membrane {
    const tobi_system *s;
    const tobi_bvh *bvh;            /* of the body; NULL on a side of the domain */
    double foot[3], normal[3];      /* box coordinates; out of the wall          */
    double traction, weight;        /* weight: share of the kernel that sees particles */
} membrane;

/* Of isph: as at rest from the particle to the place. */
static void carry(membrane *m, int64_t i, const double r[3], const double gravity[3])
{
    const tobi_smoothing_constants *c = &m->s->smoothing;
    const double weight = c->volume*tobi_smoothing_w(c->shape, c->dimension, c->h,
                                                     sqrt(r[0]*r[0] + r[1]*r[1] + r[2]*r[2]));
    const double rho = m->s->fluid[m->s->particles.fluid[i]].density;
    double p = sph_fields_of(&m->s->particles)->pressure[i];
    for (int a = 0; a < c->dimension; a++) p -= rho*gravity[a]*r[a];
    m->traction += weight*p;
    m->weight += weight;
}

static void press(void *user, int64_t i, const double r[3])
{
    membrane *m = user;
    const tobi_smoothing_constants *c = &m->s->smoothing;
    double r2 = r[0]*r[0] + r[1]*r[1] + r[2]*r[2], depth = 0, along = 0;
    for (int a = 0; a < 3; a++) depth += r[a]*m->normal[a];
    if (!(r2 < c->h*c->h) || !(depth > 0)) return;
    const tobi_double3 *q = &m->s->particles.position[i];
    const double at[3] = { q->x, q->y, q->z };
    double gravity[3];
    sph_gravity_at(m->s, at, m->s->particles.fluid[i], gravity);
    for (int a = 0; a < 3; a++) along += gravity[a]*m->normal[a];
    if (sph_of(m->s)->mirrors) {
        carry(m, i, r, gravity);
        return;
    }
    int k = (int)(depth/c->h*TOBI_PLANE_SAMPLES);
    double sigma = c->plane.sigma[k], reach = sigma > 0 ? c->plane.lambda[k]/sigma : 0;
    double weight = c->volume*c->plane_scale*tobi_smoothing_w(c->shape, c->dimension, c->h, sqrt(r2));
    double rho = m->s->fluid[m->s->particles.fluid[i]].density;
    m->traction += weight*(2*sph_fields_of(&m->s->particles)->pressure[i] - rho*along*(depth + reach));
}

/* The nearest side or body within half a spacing of x. */
static int find_surface(const tobi_system *s, const double x[3], membrane *m)
{
    double nearest = ON_WALL*s->smoothing.spacing;
    int found = 0;
    *m = (membrane){.s = s};
    for (int a = 0; a < s->box.dimension; a++)
        for (int side = 0; side < 2 && !s->box.periodic[a]; side++) {
            double at = side ? s->box.size[a] : 0, away = fabs(x[a] - at);
            if (!(away <= nearest) || (found && away == nearest)) continue;
            nearest = away;
            memcpy(m->foot, x, sizeof m->foot);
            memset(m->normal, 0, sizeof m->normal);
            m->foot[a] = at;
            m->normal[a] = side ? -1 : 1;
            found = 1;
        }
    for (int k = 0; k < s->sim->body_count; k++) {
        tobi_bvh_hit hit;
        if (!tobi_bvh_closest(s->sim->bodies[k].bvh, x, nearest, &hit)) continue;
        if (found && fabs(hit.signed_distance) >= nearest) continue;      /* at its foot: the side */
        nearest = fabs(hit.signed_distance);
        m->bvh = s->sim->bodies[k].bvh;
        memcpy(m->foot, hit.point, sizeof m->foot);
        memcpy(m->normal, hit.normal, sizeof m->normal);
        found = 1;
    }
    return found;
}

/* Whether a place of the disc is still wall: inside the domain, on the body, and not under what stands on a
   side, where no liquid comes. */
static int is_on_wall(const membrane *m, const double y[3])
{
    tobi_bvh_hit hit;
    for (int a = 0; a < m->s->box.dimension; a++)
        if (!m->s->box.periodic[a] && (y[a] < 0 || y[a] > m->s->box.size[a])) return 0;
    return m->bvh ? tobi_bvh_closest(m->bvh, y, 0.1*m->s->smoothing.spacing, &hit)
                  : !tobi_boundary_covers(m->s, y, m->normal);
}

/* Share of the kernel around y that other sides of the domain leave to the fluid. */
static double open_share(const membrane *m, const double y[3])
{
    const tobi_smoothing_constants *c = &m->s->smoothing;
    double open = 1;
    for (int a = 0; a < m->s->box.dimension; a++)
        for (int side = 0; side < 2 && !m->s->box.periodic[a]; side++) {
            double away = side ? m->s->box.size[a] - y[a] : y[a];
            if (fabs(m->normal[a]) > 0.9 || !(away < c->h)) continue;
            open *= 1 - c->plane.lambda[(int)(away/c->h*TOBI_PLANE_SAMPLES)];
        }
    return open;
}

/* Traction at one place of the wall. */
static double measure_place(membrane *m, const double y[3])
{
    const tobi_system *s = m->s;
    const sph_range cells = sph_cells_around(s, y, s->smoothing.h + s->smoothing.spacing);
    m->traction = m->weight = 0;
    sph_visit(s, y, &cells, press, m);
    if (!sph_of(s)->mirrors) return m->traction/open_share(m, y);
    return m->weight > DRY ? m->traction/m->weight : 0;
}

/* Mean traction over the part of a disc that is wall: rings of equal area. */
static double measure_wall(membrane *m)
{
    enum { RINGS = 3, SPOKES = 8 };
    const tobi_system *s = m->s;
    double sum = 0, d = s->smoothing.spacing, u[3] = {0}, v[3];
    int used = 0, least = fabs(m->normal[0]) < fabs(m->normal[1]) ? 0 : 1;
    if (fabs(m->normal[2]) < fabs(m->normal[least])) least = 2;
    if (s->box.dimension == 2) least = 2;
    for (int a = 0; a < 3; a++) u[a] = (a == least) - m->normal[least]*m->normal[a];
    double length = sqrt(u[0]*u[0] + u[1]*u[1] + u[2]*u[2]);
    for (int a = 0; a < 3; a++) u[a] /= length;
    for (int a = 0; a < 3; a++) v[a] = m->normal[(a + 1)%3]*u[(a + 2)%3] - m->normal[(a + 2)%3]*u[(a + 1)%3];
    for (int ring = 0; ring < RINGS; ring++)
        for (int spoke = 0; spoke < SPOKES; spoke++) {
            double r = d*sqrt((ring + 0.5)/RINGS), turn = 2*M_PI*(spoke + 0.5*ring)/SPOKES, y[3];
            for (int a = 0; a < 3; a++) y[a] = m->foot[a] + r*(cos(turn)*u[a] + sin(turn)*v[a]);
            if (s->box.dimension == 2) y[2] = 0;
            if (!is_on_wall(m, y)) continue;
            sum += measure_place(m, y);
            used++;
        }
    return used > 0 ? sum/used : 0;
}

/* Pressure and velocity at a place in box coordinates; the number of particles that were used. */
static int fit_values(const tobi_system *s, const double local[3], double radius, double value[VALUES])
{
    fit f = {.s = s, .radius = radius*s->smoothing.spacing};
    int n = 1 + s->box.dimension;
    memset(value, 0, VALUES*sizeof *value);
    sph_range r = sph_cells_around(s, local, f.radius + MOVED*s->smoothing.spacing);
    sph_visit(s, local, &r, add_to_fit, &f);
    fit full = f;
    if (f.count >= 2*n && eliminate(&full, n)) substitute(&full, n, value);
    else if (f.count > 0)
        for (int k = 0; k < VALUES; k++) value[k] = f.right[0][k]/f.matrix[0][0];
    return f.count;
}

static void find_local(const tobi_system *s, const double x[3], double local[3])
{
    for (int a = 0; a < 3; a++) local[a] = a < s->box.dimension ? x[a] - s->box.lower[a] : 0;
}

int tobi_probe_point(const tobi_system *s, const double x[3], double *pressure, double velocity[3],
                     double scalar[TOBI_SCALAR_LIMIT])
{
    double local[3], value[VALUES];
    membrane wall;
    find_local(s, x, local);
    const int count = fit_values(s, local, RADIUS, value);
    *pressure = value[0];
    memcpy(velocity, value + 1, 3*sizeof *velocity);
    memcpy(scalar, value + SCALARS, TOBI_SCALAR_LIMIT*sizeof *scalar);
    if (count > 0 && find_surface(s, local, &wall)) *pressure = measure_wall(&wall);
    if (count > 0) *pressure += sph_hydrostatic(s, local);
    return count;
}

int tobi_probe_liquid(const tobi_system *s, const double local[3], double *pressure, double velocity[3],
                      double acceleration[3], double scalar[TOBI_SCALAR_LIMIT])
{
    double value[VALUES];
    const int count = fit_values(s, local, NARROW, value);
    *pressure = value[0] + (count > 0 ? sph_hydrostatic(s, local) : 0);
    memcpy(velocity, value + 1, 3*sizeof *velocity);
    memcpy(scalar, value + SCALARS, TOBI_SCALAR_LIMIT*sizeof *scalar);
    for (int a = 0; a < 3; a++) acceleration[a] = s->dt > 0 ? value[CHANGES + a]/s->dt : 0;
    return count;
}

double tobi_probe_place(const tobi_system *s, const double x[3], double normal[3])
{
    double local[3], value[VALUES];
    membrane wall;
    find_local(s, x, local);
    const int count = fit_values(s, local, RADIUS, value);
    if (count == 0) return 0;
    if (!find_surface(s, local, &wall)) return value[0] + sph_hydrostatic(s, local);
    memcpy(normal, wall.normal, sizeof wall.normal);
    return measure_place(&wall, wall.foot) + sph_hydrostatic(s, local);
}

/* A side of the domain as a lattice of places; items are pieces of its rows, as many whatever its length.
   low, high, m: no particle is near places outside of them. */
typedef struct side {
    const tobi_system *s;
    int axis, other, end;
    int64_t rows, columns;
    double low[3], high[3];
} side;

static int64_t find_index(double x, double length, int64_t count)
{
    return (int64_t)fmin(fmax(floor(x/length*(double)count), 0), (double)count);
}

/* Cuts *first, *stop to the places of an axis that are near particles. */
static void cut_to_liquid(const side *w, int axis, int64_t count, int64_t *first, int64_t *stop)
{
    const double size = w->s->box.size[axis];
    const int64_t low = find_index(w->low[axis], size, count);
    const int64_t high = find_index(w->high[axis], size, count) + 1;
    if (*first < low) *first = low;
    if (*stop > high) *stop = high;
}

static void press_pieces(const void *view, int64_t begin, int64_t end, double *totals)
{
    const side *w = view;
    const double *size = w->s->box.size;
    const int along = 3 - w->axis - w->other;
    int64_t first = w->rows*begin/TOBI_PROBE_PIECES, stop = w->rows*end/TOBI_PROBE_PIECES;
    int64_t left = 0, right = w->columns;
    cut_to_liquid(w, w->other, w->rows, &first, &stop);
    if (w->s->box.dimension == 3) cut_to_liquid(w, along, w->columns, &left, &right);
    membrane m = { .s = w->s };
    m.normal[w->axis] = w->end ? -1 : 1;
    for (int64_t i = first; i < stop; i++)
        for (int64_t k = left; k < right; k++) {
            double y[3] = { 0 };
            y[w->axis] = w->end ? size[w->axis] : 0;
            y[w->other] = ((double)i + 0.5)*size[w->other]/(double)w->rows;
            if (w->s->box.dimension == 3) y[along] = ((double)k + 0.5)*size[along]/(double)w->columns;
            if (tobi_boundary_covers(w->s, y, m.normal)) continue;
            totals[0] -= measure_place(&m, y)*m.normal[w->axis];
        }
}

/* Places farther from all particles than a search reaches have no pressure. */
static const double REACH = 8;      /* spacings */

static double press_side(tobi_system *s, int axis, int end, const double low[3], const double high[3])
{
    const double *size = s->box.size, d = s->smoothing.spacing;
    const int dimension = s->box.dimension, other = (axis + 1) % dimension;
    const double length = size[other], width = dimension == 3 ? size[3 - axis - other] : 1;
    side w = { s, axis, other, end, (int64_t)ceil(length/d - 1e-6),
               dimension == 3 ? (int64_t)ceil(width/d - 1e-6) : 1, { 0 }, { 0 } };
    for (int a = 0; a < 3; a++) {
        w.low[a] = s->box.periodic[a] ? 0 : low[a] - REACH*d;
        w.high[a] = s->box.periodic[a] ? size[a] : high[a] + REACH*d;
    }
    double t[TOBI_TOTALS];
    tobi_launch_each(&s->sim->exec, TOBI_HOST(press_pieces, 1, 0), &w, TOBI_PROBE_PIECES, t);
    return t[0]*length*width/(double)(w.rows*w.columns);
}

typedef struct extent { const tobi_system *s; int axis; } extent;

/* Along an axis, m: totals[6]: from the lowest particle to the upper side; totals[7]: the highest. */
static void find_extent(const void *view, int64_t begin, int64_t end, double *totals)
{
    const extent *e = view;
    for (int64_t i = begin; i < end; i++) {
        const double x = (&e->s->particles.position[i].x)[e->axis];
        totals[6] = fmax(totals[6], e->s->box.size[e->axis] - x);
        totals[7] = fmax(totals[7], x);
    }
}

void tobi_probe_sides(tobi_system *s, double force[3])
{
    double low[3] = { 0 }, high[3] = { 0 };
    tobi_boundary_find_neighbors(s);
    for (int a = 0; a < s->box.dimension; a++) {
        const extent e = { s, a };
        double t[TOBI_TOTALS];
        tobi_launch(&s->sim->exec, TOBI_HOST(find_extent, 0, 2), &e, 0, s->particles.count, t);
        low[a] = s->box.size[a] - t[6];
        high[a] = t[7];
    }
    for (int a = 0; a < 3; a++) {
        force[a] = 0;
        for (int end = 0; a < s->box.dimension && end < 2 && !s->box.periodic[a]; end++)
            force[a] += press_side(s, a, end, low, high);
    }
}
