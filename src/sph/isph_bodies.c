/* Bodies as mirrors of isph: a plane per particle and body, through the closest point of its surface. How
   much of the half space behind the plane is body tells edges and tips from faces. Forces are those of the
   pressure at the surface: sums over images would not cancel under a uniform pressure. Drawback: a particle
   in a concave corner of one body mirrors at one of its faces only. */
#include "sph/isph_bodies.h"
#include "sph/state.h"
#include <math.h>
#include <string.h>

/* Share of the kernel with particles in it below which a point of a body is dry. */
static const double DRY = 0.1;

static double behind_plane(const tobi_smoothing_constants *c, double distance)
{
    const double at = fmax(distance, 0)/c->h*TOBI_PLANE_SAMPLES;
    if (at >= TOBI_PLANE_SAMPLES) return 0;
    const int k = (int)at;
    return c->plane.lambda[k] + (at - k)*((double)c->plane.lambda[k + 1] - c->plane.lambda[k]);
}

static void move_foot(const tobi_body *b, const tobi_boundary_entry *e, double velocity[3])
{
    const int32_t *t = b->mesh.triangles[e->triangle];
    for (int a = 0; a < 3; a++) {
        velocity[a] = 0;
        for (int c = 0; c < 3; c++) velocity[a] += e->barycentric[c]*b->vertex_velocity[t[c]][a];
    }
}

static isph_mirror make_mirror(const tobi_system *s, const tobi_boundary_link *link,
                               const tobi_boundary_entry *e)
{
    isph_mirror m = { .body = link->body, .previous = link->previous };
    const tobi_smoothing_constants *c = &s->smoothing;
    const double lambda = behind_plane(c, e->distance);
    /* beside an edge the plane faces the particle */
    const int faces = e->distance > 0.05*c->spacing;
    if (e->triangle < 0) return m;
    m.share = lambda > 1e-6 ? fmin(e->share/lambda, 1) : 0;
    memcpy(m.offset, e->offset, sizeof m.offset);
    for (int a = 0; a < 3; a++) m.normal[a] = faces ? e->offset[a]/e->distance : e->foot_normal[a];
    move_foot(&s->sim->bodies[link->body], e, m.velocity);
    return m;
}

tobi_status isph_bodies_see(isph_solver *m, tobi_system *s, tobi_error *err)
{
    const tobi_boundary_links *n = &sph_of(s)->near;
    isph_view *v = &m->view;
    memset(v->behind, 0, (size_t)s->particles.count*sizeof *v->behind);
    v->near = s->sim->body_count ? sph_fields_of(&s->particles)->near : NULL;
    if (!v->near) return TOBI_OK;
    if (n->count > m->mirrors) {
        const int64_t room = n->count + n->count/2 + 64;
        isph_mirror *more = tobi_array_grow(m->mirror, 0, room, sizeof *more);
        if (!more) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld mirrors", (long long)room);
        m->mirror = more;
        m->mirrors = room;
    }
    v->mirror = m->mirror;
    for (int64_t k = 0; k < n->count; k++) {
        m->mirror[k] = make_mirror(s, &n->link[k], &n->entry[k]);
        float *behind = &v->behind[n->link[k].particle];
        *behind = 1 - (1 - *behind)*(1 - (float)n->entry[k].share);
    }
    return TOBI_OK;
}

/* Particles may have several entries: not shared among threads. */
void isph_bodies_unlift(tobi_system *s)
{
    const tobi_boundary_links *n = &sph_of(s)->near;
    for (int64_t k = 0; k < n->count; k++) {
        const tobi_boundary_entry *e = &n->entry[k];
        for (int a = 0; a < 3; a++)
            (&s->particles.velocity[n->link[k].particle].x)[a] -= (float)(s->dt*e->lift[a]);
    }
}

/* A body's points, and the particles around them. */
typedef struct pressing {
    const isph_view *v;
    const tobi_cells *cells;
    const tobi_body *b;
    int shape;                       /* TOBI_SHAPE_*                                                */
    double scale;                    /* m3, on W                                                    */
} pressing;

typedef struct point_sums { double weight, pressure; } point_sums;

/* Particles before the point, with the pressure that liquid at rest would have at its height. */
static void add_cell(const pressing *q, int64_t k, int64_t cell, point_sums *s)
{
    const isph_view *v = q->v;
    for (int64_t i = q->cells->start[cell]; i < q->cells->start[cell + 1]; i++) {
        double ahead = 0, rise = 0, r2 = 0;
        for (int a = 0; a < v->dimension; a++) {
            double x = (&v->position[i].x)[a] - q->b->point[k][a];
            if (v->periodic[a]) x -= v->size[a]*round(x/v->size[a]);
            r2 += x*x;
            ahead += x*q->b->normal[k][a];
            rise -= v->density*v->gravity[a]*x;
        }
        if (!(ahead > 0) || r2 >= v->h*v->h) continue;
        const double w = q->scale*tobi_smoothing_w(q->shape, v->dimension, v->h, sqrt(r2));
        s->weight += w;
        s->pressure += w*(v->pressure[i] + rise);
    }
}

/* The cell at an offset from that of x; -1: there is none. */
static int64_t find_cell(const tobi_cells *c, const double x[3], const int offset[3])
{
    int at[3];
    for (int a = 0; a < 3; a++) {
        at[a] = (int)floor(x[a]*c->inverse[a]) + offset[a];
        if (c->periodic[a]) at[a] = (at[a] + c->n[a])%c->n[a];
        if (at[a] < 0 || at[a] >= c->n[a]) return -1;
    }
    return tobi_cells_row(c, at[1], at[2]) + at[0];
}

static double press_point(const pressing *q, int64_t k)
{
    const int deep = q->v->dimension == 3;
    double x[3] = { 0 };
    point_sums s = { 0, 0 };
    for (int a = 0; a < q->v->dimension; a++) x[a] = q->b->point[k][a];
    for (int z = -deep; z <= deep; z++)
        for (int y = -1; y <= 1; y++)
            for (int o = -1; o <= 1; o++) {
                const int64_t cell = find_cell(q->cells, x, (int[3]){ o, y, z });
                if (cell >= 0) add_cell(q, k, cell, &s);
            }
    return s.weight > DRY ? s.pressure/s.weight : 0;
}

static void press_points(const void *view, int64_t begin, int64_t end, double *totals)
{
    const pressing *q = view;
    const tobi_body *b = q->b;
    for (int64_t k = begin; k < end; k++) {
        const double push = b->area[k] > 0 ? -b->area[k]*press_point(q, k) : 0, *n = b->normal[k];
        double arm[3];
        for (int a = 0; a < 3; a++) {
            arm[a] = b->point[k][a] + b->lower[a] - b->centre[a];
            totals[a] += push*n[a];
        }
        for (int a = 0; a < 3; a++) {
            const int c = (a + 1)%3, d = (a + 2)%3;
            totals[3 + a] += push*(arm[c]*n[d] - arm[d]*n[c]);
        }
    }
}

void isph_bodies_press(isph_solver *m, tobi_system *s)
{
    for (int k = 0; k < s->sim->body_count; k++) {
        tobi_body *b = &s->sim->bodies[k];
        const tobi_smoothing_constants *c = &s->smoothing;
        const pressing view = { &m->view, &s->cells, b, c->shape, c->volume*c->weight_correction };
        double t[TOBI_TOTALS];
        tobi_launch(m->exec, TOBI_HOST(press_points, 6, 0), &view, 0, b->point_count, t);
        memcpy(b->load[s->number].pressure, t, 6*sizeof *t);
    }
}
