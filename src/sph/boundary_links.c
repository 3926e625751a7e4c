/* Surface sums over the quadrature points a fluid particle sees (docs/theory/boundaries.md).
   A point counts when it faces the particle and no part of the body lies between. For a function f(s)
   of the distance to a plane, sum A W f(s_b)/sigma(s_b) with s_b the distance to the point's tangent
   plane gives f(s) exactly on a plane and its natural extension on curves and edges. */
#include "sph/boundary.h"
#include "sph/hydrostatic.h"
#include "sph/state.h"
#include "sph/wall_law.h"
#include <math.h>
#include <string.h>

static double dot(const double a[3], const double b[3]) { return a[0]*b[0] + a[1]*b[1] + a[2]*b[2]; }

static double plane_value(const tobi_system *s, const float *table, double distance)
{
    double at = fmax(distance, 0)/s->smoothing.h*TOBI_PLANE_SAMPLES;
    if (at >= TOBI_PLANE_SAMPLES) return 0;
    int k = (int)at;
    return table[k] + (at - k)*((double)table[k + 1] - table[k]);
}

static tobi_status grow_rows(void **p, int64_t *capacity, int64_t need, size_t size, tobi_error *err)
{
    if (need <= *capacity) return TOBI_OK;
    int64_t more = need + need/2 + 64;
    void *q = tobi_array_grow(*p, *capacity, more, size);
    if (!q)
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld entries near bodies",
                         (long long)more);
    *p = q;
    *capacity = more;
    return TOBI_OK;
}

#define grow(array, capacity, need, err) grow_rows((void **)(array), capacity, need, sizeof **(array), err)

static int bin_along(const tobi_boundary_bins *c, double width, int a, double x)
{
    double k = floor((x - c->lower[a])/width);
    return k < 0 ? -1 : k >= c->n[a] ? c->n[a] : (int)k;
}

/* Lays the bins of all bodies out, cells of width h over the boxes. */
static tobi_status plan_bins(tobi_system *s, tobi_error *err)
{
    tobi_boundary_links *n = &sph_of(s)->links;
    const int bodies = s->sim->body_count;
    int64_t starts = 0, items = 0;
    TOBI_TRY(grow(&n->bins, &n->bins_capacity, bodies + 1, err));
    n->bin_width = s->smoothing.h;
    for (int k = 0; k < bodies; k++) {
        tobi_boundary_bins *c = &n->bins[k];
        double lo[3], hi[3];
        int64_t total = 1;
        tobi_bvh_box(s->sim->bodies[k].bvh, lo, hi);
        for (int a = 0; a < 3; a++) {
            c->lower[a] = lo[a];
            c->n[a] = a == 2 && s->box.dimension == 2
                          ? 1
                          : (int)fmin((hi[a] - lo[a]) / n->bin_width + 1, 4096);
            total *= c->n[a];
        }
        if (s->box.dimension == 2) c->lower[2] = -0.5*n->bin_width;
        c->start = starts;
        c->item = items;
        starts += total + 2;
        items += s->sim->bodies[k].point_count;
    }
    n->bins[bodies] = (tobi_boundary_bins){.start = starts, .item = items};
    TOBI_TRY(grow(&n->bin_start, &n->start_capacity, starts, err));
    return grow(&n->bin_item, &n->item_capacity, items, err);
}

/* Sorts a body's points into its bins. */
static void fill_bins(const tobi_boundary_links *n, int k, const tobi_body *b)
{
    const tobi_boundary_bins *bins = &n->bins[k];
    int32_t *start = n->bin_start + bins->start, *item = n->bin_item + bins->item;
    const int64_t total = bins[1].start - bins->start - 2;
    memset(start, 0, (size_t)(total + 2)*sizeof *start);
    for (int pass = 0; pass < 2; pass++) {
        for (int64_t q = 0; q < b->point_count; q++) {
            int c[3];
            for (int a = 0; a < 3; a++) {
                c[a] = bin_along(bins, n->bin_width, a, b->point[q][a]);
                c[a] = c[a] < 0 ? 0 : c[a] >= bins->n[a] ? bins->n[a] - 1 : c[a];
            }
            int64_t bin = ((int64_t)c[2]*bins->n[1] + c[1])*bins->n[0] + c[0];
            if (pass == 0) start[bin + 2]++;
            else item[start[bin + 1]++] = (int32_t)q;
        }
        if (pass == 0)
            for (int64_t c = 1; c <= total; c++) start[c + 1] += start[c];
    }
}

static void prepare_bodies(const void *view, int64_t begin, int64_t end, double *totals)
{
    const tobi_system *s = view;
    (void)totals;
    for (int64_t k = begin; k < end; k++) {
        const tobi_body *b = &s->sim->bodies[k];
        fill_bins(&sph_of(s)->links, (int)k, b);
        memset(b->wet, 0, (size_t)b->point_count);
        memset(b->covered, 0, (size_t)b->point_count*sizeof *b->covered);
    }
}

int tobi_boundary_visit(const tobi_boundary_links *n, int64_t body, const double x[3],
                        int (*visit)(void *user, int32_t point), void *user)
{
    const tobi_boundary_bins *bins = &n->bins[body];
    const int32_t *start = n->bin_start + bins->start, *item = n->bin_item + bins->item;
    int c[3];
    for (int a = 0; a < 3; a++) {
        c[a] = bin_along(bins, n->bin_width, a, x[a]);
        double beyond = c[a] < 0 ? bins->lower[a] - x[a]
                                 : x[a] - (bins->lower[a] + bins->n[a] * n->bin_width);
        if ((c[a] < 0 || c[a] >= bins->n[a]) && beyond > n->bin_width) return 0;
    }
    for (int z = c[2] - 1; z <= c[2] + 1; z++)
        for (int y = c[1] - 1; y <= c[1] + 1; y++)
            for (int q = c[0] - 1; q <= c[0] + 1; q++) {
                if (z < 0 || z >= bins->n[2] || y < 0 || y >= bins->n[1] || q < 0 ||
                    q >= bins->n[0])
                    continue;
                int64_t bin = ((int64_t)z*bins->n[1] + y)*bins->n[0] + q;
                for (int32_t k = start[bin]; k < start[bin + 1]; k++)
                    if (visit(user, item[k])) return 1;
            }
    return 0;
}

/* A particle's look at one body. */
typedef struct look {
    const tobi_system *s;
    const tobi_body *b;
    double x[3];
    double gravity[3];          /* m/s2, what the particle feels */
    tobi_boundary_link *link;
    tobi_boundary_entry *entry;
} look;

/* Distance to the tangent plane if the point is near and faces the particle, else -1. */
static double faces(const look *l, int32_t point, double r[3])
{
    for (int a = 0; a < 3; a++) r[a] = l->x[a] - l->b->point[point][a];
    double h = l->s->smoothing.h;
    if (dot(r, r) >= h*h || l->b->area[point] <= 0) return -1;
    return dot(r, l->b->normal[point]);
}

static int sees_any(void *user, int32_t point)
{
    double r[3];
    return faces(user, point, r) > 0;
}

/* Whether x sees a point of the body: most likely one in its own or the nearest bin. */
static int sees_body(look *l, int64_t body)
{
    const tobi_boundary_links *n = &sph_of(l->s)->links;
    const tobi_boundary_bins *bins = &n->bins[body];
    const int32_t *start = n->bin_start + bins->start, *item = n->bin_item + bins->item;
    int64_t bin = 0;
    for (int a = 2; a >= 0; a--) {
        const int c = bin_along(bins, n->bin_width, a, l->x[a]);
        bin = bin*bins->n[a] + (c < 0 ? 0 : c >= bins->n[a] ? bins->n[a] - 1 : c);
    }
    for (int32_t k = start[bin]; k < start[bin + 1]; k++)
        if (sees_any(l, item[k])) return 1;
    return tobi_boundary_visit(n, body, l->x, sees_any, l);
}

/* Hidden if it lies behind the tangent plane of the nearest point and the body is in the way. */
static int hidden(const look *l, int32_t point)
{
    const tobi_boundary_entry *e = l->entry;
    double d = l->s->smoothing.spacing, to[3], from_foot[3];
    for (int a = 0; a < 3; a++) {
        to[a] = l->b->point[point][a] + 1e-3*d*l->b->normal[point][a];
        from_foot[a] = to[a] - e->foot[a];
    }
    return dot(from_foot, e->foot_normal) < -0.25*d && tobi_bvh_segment_hits(l->b->bvh, l->x, to);
}

static int add_point(void *user, int32_t k)
{
    look *l = user;
    const tobi_body *b = l->b;
    const tobi_smoothing_constants *c = &l->s->smoothing;
    tobi_boundary_entry *e = l->entry;
    double r[3], s = faces(l, k, r);
    if (!(s > 0) || hidden(l, k)) return 0;
    __atomic_store_n(&b->wet[k], TOBI_WET, __ATOMIC_RELAXED);
    const double *n = b->normal[k], *v = b->point_velocity[k], *g = l->gravity;
    const double w = c->plane_scale*tobi_smoothing_w(c->shape, c->dimension, c->h, sqrt(dot(r, r)));
    const double aw = b->area[k]*w;
    /* whole numbers: the same sum in any order */
    __atomic_fetch_add(&b->covered[k], (uint32_t)(2*c->volume*w*TOBI_COVERED), __ATOMIC_RELAXED);
    double sigma = plane_value(l->s, c->plane.sigma, s);
    double reach = sigma > 0 ? plane_value(l->s, c->plane.lambda, s)/sigma : 0;
    double arm[3], gn = g[0]*n[0] + g[1]*n[1] + (c->dimension == 3 ? g[2]*n[2] : 0);
    for (int a = 0; a < 3; a++) arm[a] = b->point[k][a] + b->lower[a] - b->centre[a];
    for (int a = 0; a < 3; a++) {
        int p = (a + 1)%3, q = (a + 2)%3;
        l->link->gradient[a] -= aw*n[a];
        l->link->torque_arm[a] -= aw*(arm[p]*n[q] - arm[q]*n[p]);
        e->hydrostatic[a] -= aw*gn*(s + reach)*n[a];
    }
    e->wall_flux -= aw*dot(n, v);
    e->share += aw*reach;
    if (b->friction == TOBI_NO_SLIP) {
        double rate = 2*aw/fmax(s, 0.25*c->spacing);
        e->drag += rate;
        for (int a = 0; a < 3; a++) e->drag_velocity[a] += rate*v[a];
    }
    return 0;
}

static int look_at(look *l, int32_t i, int body)
{
    tobi_boundary_entry *e = l->entry;
    tobi_bvh_hit hit;
    sph_gravity_at(l->s, l->x, l->s->particles.fluid[i], l->gravity);
    memset(e, 0, sizeof *e);
    *l->link = (tobi_boundary_link){.particle = i, .body = (int16_t)body};
    e->triangle = -1;
    if (!tobi_bvh_closest(l->b->bvh, l->x, 1.1*l->s->smoothing.h, &hit)) return 0;
    e->distance = hit.signed_distance;
    e->triangle = hit.triangle;
    memcpy(e->barycentric, hit.barycentric, sizeof e->barycentric);
    for (int a = 0; a < 3; a++) e->offset[a] = l->x[a] - hit.point[a];
    memcpy(e->foot, hit.point, sizeof e->foot);
    memcpy(e->foot_normal, hit.normal, sizeof e->foot_normal);
    tobi_boundary_visit(&sph_of(l->s)->links, body, l->x, add_point, l);
    e->share = fmin(e->share, 0.98);
    return 1;
}

static void place_look(look *l, int64_t i)
{
    tobi_double3 q = l->s->particles.position[i];
    l->x[0] = q.x; l->x[1] = q.y; l->x[2] = q.z;
}

static int cell_along(const tobi_cells *c, int axis, double x)
{
    double k = floor(x*c->inverse[axis]);
    return k < 0 ? 0 : k >= c->n[axis] ? c->n[axis] - 1 : (int)k;
}

static tobi_status add_row(tobi_system *s, int body, int64_t begin, int64_t end, int64_t *hits,
                           tobi_error *err)
{
    tobi_boundary_links *n = &sph_of(s)->links;
    if (begin == end) return TOBI_OK;
    TOBI_TRY(grow(&n->row, &n->row_capacity, n->row_count + 1, err));
    n->row[n->row_count++] = (tobi_boundary_row){body, (int32_t)begin, (int32_t)end, *hits};
    *hits += end - begin;
    return TOBI_OK;
}

/* Adds the rows of cells within h of the body's box, in the order of their particles. */
static tobi_status list_rows(tobi_system *s, int body, int64_t *hits, tobi_error *err)
{
    const tobi_cells *c = &s->cells;
    double lo[3], hi[3];
    int low[3], high[3];
    tobi_bvh_box(s->sim->bodies[body].bvh, lo, hi);
    for (int a = 0; a < 3; a++) {
        low[a] = cell_along(c, a, lo[a] - 1.001*s->smoothing.h);
        high[a] = cell_along(c, a, hi[a] + 1.001*s->smoothing.h);
    }
    for (int k = low[1]/c->strip; k <= high[1]/c->strip; k++)
        for (int z = low[2]; z <= high[2]; z++)
            for (int y = k*c->strip; y < (k + 1)*c->strip && y <= high[1]; y++) {
                if (y < low[1]) continue;
                const int32_t *start = c->start + tobi_cells_row(c, y, z);
                TOBI_TRY(add_row(s, body, start[low[0]], start[high[0] + 1], hits, err));
            }
    return TOBI_OK;
}

/* Whether x is too far from a box for a point in it to be within h. */
static int is_far(const tobi_system *s, const double lo[3], const double hi[3], const double x[3])
{
    double square = 0;
    for (int a = 0; a < s->box.dimension; a++) {
        const double beyond = x[a] < lo[a] ? lo[a] - x[a] : x[a] > hi[a] ? x[a] - hi[a] : 0;
        square += beyond*beyond;
    }
    return square > 1.001*s->smoothing.h*s->smoothing.h;
}

/* Finds the particles of rows that see the row's body. */
static void find_hits(const void *view, int64_t begin, int64_t end, double *totals)
{
    const tobi_system *s = view;
    const tobi_boundary_links *n = &sph_of(s)->links;
    (void)totals;
    for (int64_t r = begin; r < end; r++) {
        const tobi_boundary_row *row = &n->row[r];
        int32_t *hit = n->hit + row->hit;
        look l = {.s = s, .b = &s->sim->bodies[row->body]};
        int64_t found = 0;
        double lo[3], hi[3];
        tobi_bvh_box(l.b->bvh, lo, hi);
        for (int32_t i = row->begin; i < row->end; i++) {
            place_look(&l, i);
            if (is_far(s, lo, hi, l.x)) continue;
            if (sees_body(&l, row->body)) hit[found++] = i;
        }
        n->found[r] = found;
    }
}

static void fill_entries(const void *view, int64_t begin, int64_t end, double *totals)
{
    const tobi_system *s = view;
    const tobi_boundary_links *n = &sph_of(s)->links;
    (void)totals;
    for (int64_t r = begin; r < end; r++) {
        const tobi_boundary_row *row = &n->row[r];
        const int64_t stop = r + 1 < n->row_count ? n->found[r + 1] : n->count;
        const int32_t *hit = n->hit + row->hit;
        for (int64_t k = n->found[r]; k < stop; k++, hit++) {
            look l = {.s = s, .b = &s->sim->bodies[row->body], .link = &n->link[k], .entry = &n->entry[k]};
            place_look(&l, *hit);
            if (!look_at(&l, *hit, row->body)) l.entry->distance = s->smoothing.h;
        }
    }
}

static void chain_entries(tobi_system *s)
{
    const tobi_boundary_links *n = &sph_of(s)->links;
    int32_t *last_link = sph_fields_of(&s->particles)->last_link;
    memset(last_link, 0xFF, (size_t)s->particles.count*sizeof *last_link);
    for (int64_t k = 0; k < n->count; k++) {
        tobi_boundary_link *e = &n->link[k];
        e->previous = last_link[e->particle];
        last_link[e->particle] = (int32_t)k;
    }
}

/* Room for what is done with the entries before the next search. */
static tobi_status reserve(tobi_system *s, tobi_error *err)
{
    tobi_boundary_links *n = &sph_of(s)->links;
    const int64_t bodies = s->sim->body_count, blocks = s->particles.count/TOBI_BLOCK + 1;
    const int64_t parts = n->count/TOBI_BLOCK + 1 + bodies;
    TOBI_TRY(grow(&n->total, &n->total_capacity, bodies, err));
    TOBI_TRY(grow(&n->answer, &n->answer_capacity, bodies, err));
    TOBI_TRY(grow(&n->part, &n->part_capacity, parts > blocks ? parts : blocks, err));
    TOBI_TRY(grow(&n->caught, &n->caught_capacity, blocks*TOBI_BLOCK, err));
    return grow(&n->caught_block, &n->blocks_capacity, blocks, err);
}

/* Rows near each body are searched, not all particles for every body. */
tobi_status tobi_boundary_search(tobi_system *s, tobi_error *err)
{
    tobi_boundary_links *n = &sph_of(s)->links;
    tobi_exec *x = &s->sim->exec;
    const int bodies = s->sim->body_count;
    int64_t hits = 0;
    n->row_count = 0;
    TOBI_TRY(plan_bins(s, err));
    tobi_launch_each(x, TOBI_HOST(prepare_bodies, 0, 0), s, bodies, NULL);
    TOBI_TRY(grow(&n->first, &n->first_capacity, bodies + 1, err));
    for (int k = 0; k < bodies; k++) {
        n->first[k] = n->row_count;
        TOBI_TRY(list_rows(s, k, &hits, err));
    }
    TOBI_TRY(grow(&n->found, &n->found_capacity, n->row_count, err));
    TOBI_TRY(grow(&n->hit, &n->hit_capacity, hits, err));
    TOBI_TRY(tobi_exec_reserve(x, n->row_count, err));
    tobi_launch_each(x, TOBI_HOST(find_hits, 0, 0), s, n->row_count, NULL);
    n->count = tobi_scan(x, n->row_count, n->found);
    for (int k = 0; k < bodies; k++)
        n->first[k] = n->first[k] < n->row_count ? n->found[n->first[k]] : n->count;
    n->first[bodies] = n->count;
    return TOBI_OK;
}

tobi_status tobi_boundary_measure(tobi_system *s, tobi_error *err)
{
    tobi_boundary_links *n = &sph_of(s)->links;
    TOBI_TRY(grow(&n->link, &n->link_capacity, n->count, err));
    TOBI_TRY(grow(&n->entry, &n->capacity, n->count, err));
    tobi_launch_each(&s->sim->exec, TOBI_HOST(fill_entries, 0, 0), s, n->row_count, NULL);
    chain_entries(s);
    TOBI_TRY(reserve(s, err));
    TOBI_TRY(tobi_body_tree_reserve(&n->tree, s->sim->body_count, err));
    tobi_boundary_fill_gaps(s);
    return TOBI_OK;
}

static void visit_entries(tobi_system *s, tobi_range visit)
{
    tobi_loop(s->sim->exec.threads, sph_of(s)->links.count, 0, visit, s);
}

/* Runs over entries; those of one particle are handled together, where the first of them stands. */
#define FOR_NEAR_PARTICLES(s, k, i, e)                                                                     \
    for (int64_t k = begin; k < end; k++)                                                                  \
        for (int64_t i = sph_of(s)->links.link[k].particle,                                                \
                     once = sph_fields_of(&s->particles)->last_link[i] == k; once; once = 0)               \
            for (const tobi_boundary_entry *e = &sph_of(s)->links.entry[k]; e;                             \
                 e = tobi_boundary_next(&sph_of(s)->links, e))

static void add_gradients(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_fields *f = sph_fields_of(&s->particles);
    const tobi_boundary_links *n = &sph_of(s)->links;
    FOR_NEAR_PARTICLES(s, k, i, e) {
        tobi_float4 *w = &f->wall[i];
        const double *g = n->link[e - n->entry].gradient;
        w->x += (float)g[0]; w->y += (float)g[1]; w->z += (float)g[2];
        w->w += (float)e->wall_flux;
        f->density[i] = 1 - (1 - f->density[i])*(1 - (float)e->share);
    }
}

void tobi_boundary_add_gradients(tobi_system *s) { visit_entries(s, add_gradients); }

/* Acceleration by hydrostatic pressure of mirrors and friction of one entry, for velocity u. */
static void entry_accel(const tobi_system *s, int64_t i, const tobi_boundary_entry *e, const double u[3],
                        double hydrostatic[3], double drag[3])
{
    const tobi_fluid *f = &s->fluid[s->particles.fluid[i]];
    double nu = f->viscosity/f->density, a[3];
    for (int c = 0; c < 3; c++) {
        hydrostatic[c] = e->hydrostatic[c];
        a[c] = nu*(e->drag_velocity[c] - e->drag*u[c]);
    }
    double normal = dot(a, e->foot_normal), square = 0;
    for (int c = 0; c < 3; c++) {
        drag[c] = a[c] - normal*e->foot_normal[c];
        square += drag[c]*drag[c];
    }
    if (!(square > 0)) return;
    const double speed = sqrt(square)/(nu*e->drag), away = fmax(e->distance, 0.25*s->smoothing.spacing),
                 law = tobi_wall_law((float)(speed*away/nu));
    for (int c = 0; c < 3; c++) drag[c] *= law;
}

static void add_forces(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    FOR_NEAR_PARTICLES(s, k, i, e) {
        tobi_float4 *v = &s->particles.velocity[i];
        double u[3] = {v->x, v->y, v->z}, hydrostatic[3], drag[3];
        entry_accel(s, i, e, u, hydrostatic, drag);
        tobi_boundary_entry *own = (tobi_boundary_entry *)e;   /* kept for the reaction */
        memcpy(own->hydrostatic, hydrostatic, sizeof hydrostatic);
        memcpy(own->friction, drag, sizeof drag);
        v->x += (float)(s->dt*(hydrostatic[0] + drag[0]));
        v->y += (float)(s->dt*(hydrostatic[1] + drag[1]));
        v->z += (float)(s->dt*(hydrostatic[2] + drag[2]));
    }
}

void tobi_boundary_add_forces(tobi_system *s) { visit_entries(s, add_forces); }

/* Keeps the place x + way of particle i at least that far from the bodies it sees. */
static void keep_away(const tobi_system *s, int64_t i, double least, double way[3])
{
    const tobi_boundary_links *n = &sph_of(s)->links;
    int32_t k = sph_fields_of(&s->particles)->last_link[i];
    for (const tobi_boundary_entry *e = k >= 0 ? &n->entry[k] : NULL; e; e = tobi_boundary_next(n, e)) {
        double lack = least - e->distance - dot(way, e->foot_normal);
        for (int a = 0; a < 3 && lack > 0; a++) way[a] += lack*e->foot_normal[a];
    }
}

static void relax_particles(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const tobi_particles *p = &s->particles;
    const sph_fields *f = sph_fields_of(&s->particles);
    const double d = s->smoothing.spacing, most = 0.1*d, least = 0.2*d;
    for (int64_t i = begin; i < end; i++) {
        if (!f->near_body[i]) continue;
        double way[3] = {f->accel[i].x, f->accel[i].y, f->accel[i].z}, size = sqrt(dot(way, way)),
               scale = s->dt*s->dt, *x = &p->position[i].x;
        if (size*scale > most) scale = most/size;
        for (int a = 0; a < 3; a++) way[a] *= scale;
        keep_away(s, i, least, way);
        for (int a = 0; a < s->box.dimension; a++) {
            x[a] += way[a];
            if (!s->box.periodic[a]) x[a] = fmin(fmax(x[a], least), s->box.size[a] - least);
        }
    }
}

void tobi_boundary_relax(tobi_system *s)
{
    tobi_loop(s->sim->exec.threads, s->particles.count, 0, relax_particles, s);
}

static void turn_normals(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const tobi_boundary_links *links = &sph_of(s)->links;
    FOR_NEAR_PARTICLES(s, k, i, e) {
        tobi_float4 *n = &sph_fields_of(&s->particles)->normal[i];
        double u[3] = {n->x, n->y, n->z}, across = dot(u, e->foot_normal), size = 0;
        for (int c = 0; c < 3; c++) {
            u[c] -= across*e->foot_normal[c];
            size += u[c]*u[c];
        }
        if (e->distance >= 1.5*s->smoothing.spacing || !(size > 1e-6)) continue;
        const tobi_body *body = &s->sim->bodies[links->link[e - links->entry].body];
        double cosine = body->contact_cosine, scale = sqrt((1 - cosine*cosine)/size);
        for (int c = 0; c < 3; c++) (&n->x)[c] = (float)(scale*u[c] + cosine*e->foot_normal[c]);
    }
}

void tobi_boundary_turn_normals(tobi_system *s) { visit_entries(s, turn_normals); }

int64_t tobi_boundary_links_bytes(const tobi_boundary_links *n)
{
    return n->link_capacity*(int64_t)sizeof *n->link + n->capacity*(int64_t)sizeof *n->entry +
           n->first_capacity*(int64_t)sizeof *n->first +
           n->total_capacity*(int64_t)sizeof *n->total + n->answer_capacity*(int64_t)sizeof *n->answer +
           n->part_capacity*(int64_t)sizeof *n->part + n->caught_capacity*(int64_t)sizeof *n->caught +
           n->blocks_capacity*(int64_t)sizeof *n->caught_block +
           n->bins_capacity*(int64_t)sizeof *n->bins + n->start_capacity*(int64_t)sizeof *n->bin_start +
           n->item_capacity*(int64_t)sizeof *n->bin_item + n->row_capacity*(int64_t)sizeof *n->row +
           n->found_capacity*(int64_t)sizeof *n->found + n->hit_capacity*(int64_t)sizeof *n->hit;
}

void tobi_boundary_links_free(tobi_boundary_links *n)
{
    tobi_array_free(n->link);
    tobi_array_free(n->entry);
    tobi_array_free(n->first);
    tobi_array_free(n->total);
    tobi_array_free(n->answer);
    tobi_array_free(n->part);
    tobi_array_free(n->caught);
    tobi_array_free(n->caught_block);
    tobi_array_free(n->bins);
    tobi_array_free(n->bin_start);
    tobi_array_free(n->bin_item);
    tobi_array_free(n->row);
    tobi_array_free(n->found);
    tobi_array_free(n->hit);
    tobi_body_tree_free(&n->tree);
    memset(n, 0, sizeof *n);
}
