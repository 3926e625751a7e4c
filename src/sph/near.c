/* Surface sums over the quadrature points a fluid particle sees (docs/theory/boundaries.md).
   A point counts when it faces the particle and no part of the body lies between. For a function f(s)
   of the distance to a plane, sum A W f(s_b)/sigma(s_b) with s_b the distance to the point's tangent
   plane gives f(s) exactly on a plane and its natural extension on curves and edges. */
#include "sph/state.h"
#include "sph/gap.h"
#include "core/system.h"
#include "sph/wall_law.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static double dot(const double a[3], const double b[3]) { return a[0]*b[0] + a[1]*b[1] + a[2]*b[2]; }

static double plane_value(const tobi_system *s, const float *table, double distance)
{
    double at = fmax(distance, 0)/s->smoothing.h*TOBI_PLANE_SAMPLES;
    if (at >= TOBI_PLANE_SAMPLES) return 0;
    int k = (int)at;
    return table[k] + (at - k)*((double)table[k + 1] - table[k]);
}

static tobi_status grow(void **p, int64_t *capacity, int64_t need, size_t size, tobi_error *err)
{
    if (need <= *capacity) return TOBI_OK;
    int64_t more = need + need/2 + 64;
    void *q = realloc(*p, (size_t)more*size);
    if (!q)
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld entries near bodies",
                         (long long)more);
    *p = q;
    *capacity = more;
    return TOBI_OK;
}

static int bin_along(const tobi_near_bodies *n, int a, double x)
{
    double k = floor((x - n->bin_lower[a])/n->bin_width);
    return k < 0 ? -1 : k >= n->bins[a] ? n->bins[a] : (int)k;
}

/* Sorts a body's points into cells of width h over its box. */
static tobi_status fill_bins(tobi_system *s, const tobi_body *b, tobi_error *err)
{
    tobi_near_bodies *n = &sph_of(s)->near;
    double lo[3], hi[3];
    tobi_bvh_box(b->bvh, lo, hi);
    int64_t total = 1;
    n->bin_width = s->smoothing.h;
    for (int a = 0; a < 3; a++) {
        n->bin_lower[a] = lo[a];
        n->bins[a] = a == 2 && s->box.dimension == 2
                         ? 1
                         : (int)fmin((hi[a] - lo[a]) / n->bin_width + 1, 4096);
        total *= n->bins[a];
    }
    if (s->box.dimension == 2) n->bin_lower[2] = -0.5*n->bin_width;
    void *start = n->bin_start, *item = n->bin_item;
    tobi_status status = grow(&start, &n->bin_capacity, total + 2, sizeof(int32_t), err);
    n->bin_start = start;
    TOBI_TRY(status);
    status = grow(&item, &n->item_capacity, b->point_count, sizeof(int32_t), err);
    n->bin_item = item;
    TOBI_TRY(status);
    memset(n->bin_start, 0, (size_t)(total + 2)*sizeof(int32_t));
    for (int pass = 0; pass < 2; pass++) {
        for (int64_t k = 0; k < b->point_count; k++) {
            int c[3];
            for (int a = 0; a < 3; a++) {
                c[a] = bin_along(n, a, b->point[k][a]);
                c[a] = c[a] < 0 ? 0 : c[a] >= n->bins[a] ? n->bins[a] - 1 : c[a];
            }
            int64_t bin = ((int64_t)c[2]*n->bins[1] + c[1])*n->bins[0] + c[0];
            if (pass == 0) n->bin_start[bin + 2]++;
            else n->bin_item[n->bin_start[bin + 1]++] = (int32_t)k;
        }
        if (pass == 0)
            for (int64_t c = 1; c <= total; c++) n->bin_start[c + 1] += n->bin_start[c];
    }
    return TOBI_OK;
}

/* Calls visit for every point of the cells around x; stops early when it answers nonzero. */
typedef int (*visit_fn)(void *user, int32_t point);
static int visit_points(const tobi_near_bodies *n, const double x[3], visit_fn visit, void *user)
{
    int c[3];
    for (int a = 0; a < 3; a++) {
        c[a] = bin_along(n, a, x[a]);
        double beyond = c[a] < 0 ? n->bin_lower[a] - x[a]
                                 : x[a] - (n->bin_lower[a] + n->bins[a] * n->bin_width);
        if ((c[a] < 0 || c[a] >= n->bins[a]) && beyond > n->bin_width) return 0;
    }
    for (int z = c[2] - 1; z <= c[2] + 1; z++)
        for (int y = c[1] - 1; y <= c[1] + 1; y++)
            for (int q = c[0] - 1; q <= c[0] + 1; q++) {
                if (z < 0 || z >= n->bins[2] || y < 0 || y >= n->bins[1] || q < 0 ||
                    q >= n->bins[0])
                    continue;
                int64_t bin = ((int64_t)z*n->bins[1] + y)*n->bins[0] + q;
                for (int32_t k = n->bin_start[bin]; k < n->bin_start[bin + 1]; k++)
                    if (visit(user, n->bin_item[k])) return 1;
            }
    return 0;
}

/* A particle's look at one body. */
typedef struct look {
    const tobi_system *s;
    const tobi_body *b;
    double x[3];
    double gravity[3];          /* m/s2, what the particle feels */
    tobi_near_entry *entry;
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

/* Hidden if it lies behind the tangent plane of the nearest point and the body is in the way. */
static int hidden(const look *l, int32_t point)
{
    const tobi_near_entry *e = l->entry;
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
    tobi_near_entry *e = l->entry;
    double r[3], s = faces(l, k, r);
    if (!(s > 0) || hidden(l, k)) return 0;
    __atomic_store_n(&b->wet[k], TOBI_WET, __ATOMIC_RELAXED);
    const double *n = b->normal[k], *v = b->point_velocity[k], *g = l->gravity;
    double aw = b->area[k]*c->plane_scale*tobi_smoothing_w(c->shape, c->dimension, c->h, sqrt(dot(r, r)));
    double sigma = plane_value(l->s, c->plane.sigma, s);
    double reach = sigma > 0 ? plane_value(l->s, c->plane.lambda, s)/sigma : 0;
    double arm[3], gn = g[0]*n[0] + g[1]*n[1] + (c->dimension == 3 ? g[2]*n[2] : 0);
    for (int a = 0; a < 3; a++) arm[a] = b->point[k][a] + b->lower[a] - b->centre[a];
    for (int a = 0; a < 3; a++) {
        int p = (a + 1)%3, q = (a + 2)%3;
        e->gradient[a] -= aw*n[a];
        e->torque_arm[a] -= aw*(arm[p]*n[q] - arm[q]*n[p]);
        e->lift[a] -= aw*gn*(s + reach)*n[a];
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

/* Gravity less what still water holds; fluids have one density then. */
static void feel_gravity(look *l)
{
    const tobi_system *s = l->s;
    sph_state *state = sph_of(s);
    double held = tobi_still_share(&state->still, l->x)*state->still.push/s->fluid[0].density;
    for (int a = 0; a < 3; a++) l->gravity[a] = s->gravity[a] - held*state->still.down[a];
}

static int look_at(look *l, int32_t i, int body)
{
    tobi_near_entry *e = l->entry;
    tobi_bvh_hit hit;
    feel_gravity(l);
    memset(e, 0, sizeof *e);
    e->particle = i;
    e->body = (int16_t)body;
    e->triangle = -1;
    if (!tobi_bvh_closest(l->b->bvh, l->x, 1.1*l->s->smoothing.h, &hit)) return 0;
    e->distance = hit.signed_distance;
    e->triangle = hit.triangle;
    memcpy(e->barycentric, hit.barycentric, sizeof e->barycentric);
    for (int a = 0; a < 3; a++) e->offset[a] = l->x[a] - hit.point[a];
    memcpy(e->foot, hit.point, sizeof e->foot);
    memcpy(e->foot_normal, hit.normal, sizeof e->foot_normal);
    visit_points(&sph_of(l->s)->near, l->x, add_point, l);
    e->share = fmin(e->share, 0.98);
    return 1;
}

static void place_look(look *l, int64_t i)
{
    tobi_double3 q = l->s->particles.position[i];
    l->x[0] = q.x; l->x[1] = q.y; l->x[2] = q.z;
}

/* What the loops below need. */
typedef struct looking {
    tobi_system *s;
    int body;
    int64_t first;                     /* entry of the body                             */
    int64_t *cut;                      /* pairs that a body parts, seen from both sides */
} looking;

/* Marks the particles that see the body in `delta` (free at this time) and counts them per block. */
static void count_near(const void *view, int64_t begin, int64_t end)
{
    const looking *v = view;
    tobi_system *s = v->s;
    sph_state *state = sph_of(s);
    for (int64_t block = begin; block < end; block++) {
        int64_t last = (block + 1)*TOBI_BLOCK, found = 0;
        for (int64_t i = block*TOBI_BLOCK; i < last && i < s->particles.count; i++) {
            look l = {.s = s, .b = &s->sim->bodies[v->body]};
            place_look(&l, i);
            int near = visit_points(&state->near, l.x, sees_any, &l);
            sph_fields_of(&s->particles)->delta[i] = (float)near;
            found += near;
        }
        state->near.block_count[block] = found;
    }
}

static void fill_near(const void *view, int64_t begin, int64_t end)
{
    const looking *v = view;
    tobi_system *s = v->s;
    sph_state *state = sph_of(s);
    const sph_fields *f = sph_fields_of(&s->particles);
    for (int64_t block = begin; block < end; block++) {
        int64_t last = (block + 1)*TOBI_BLOCK, at = v->first + state->near.block_count[block];
        for (int64_t i = block*TOBI_BLOCK; i < last && i < s->particles.count; i++) {
            if (f->delta[i] == 0) continue;
            look l = {.s = s, .b = &s->sim->bodies[v->body], .entry = &state->near.entry[at]};
            place_look(&l, i);
            if (!look_at(&l, (int32_t)i, v->body)) l.entry->distance = s->smoothing.h;
            l.entry->previous = f->near[i];
            f->near[i] = (int32_t)at++;
        }
    }
}

tobi_status tobi_near_find(tobi_system *s, tobi_error *err)
{
    tobi_near_bodies *n = &sph_of(s)->near;
    int64_t blocks = (s->particles.count + TOBI_BLOCK - 1)/TOBI_BLOCK;
    n->count = 0;
    void *p = n->block_count;
    tobi_status status = grow(&p, &n->block_capacity, blocks + 1, sizeof *n->block_count, err);
    n->block_count = p;
    TOBI_TRY(status);
    p = n->answer;
    status = grow(&p, &n->answer_capacity, s->sim->body_count, sizeof *n->answer, err);
    n->answer = p;
    TOBI_TRY(status);
    memset(sph_fields_of(&s->particles)->near, 0xFF, (size_t)s->particles.count*sizeof(int32_t));
    for (int k = 0; k < s->sim->body_count; k++) {
        TOBI_TRY(fill_bins(s, &s->sim->bodies[k], err));
        memset(s->sim->bodies[k].wet, 0, (size_t)s->sim->bodies[k].point_count);
        const looking view = {.s = s, .body = k, .first = n->count};
        tobi_loop(s->sim->exec.threads, blocks, 4, count_near, &view);
        int64_t found = tobi_scan(&s->sim->exec, blocks, n->block_count);
        p = n->entry;
        status = grow(&p, &n->capacity, n->count + found, sizeof *n->entry, err);
        n->entry = p;
        TOBI_TRY(status);
        tobi_loop(s->sim->exec.threads, blocks, 4, fill_near, &view);
        n->count += found;
    }
    tobi_gap_wet(s);
    return TOBI_OK;
}

static const tobi_near_entry *next_entry(const tobi_system *s, const tobi_near_entry *e)
{
    return e->previous >= 0 ? &sph_of(s)->near.entry[e->previous] : NULL;
}

/* Does a body lie between i and its neighbour at x_i - d? Both ends answer alike: the lower id asks, or
   rounding would let a segment through an edge pass one way only. */
static int separated(const tobi_system *s, int64_t i, int64_t j)
{
    sph_state *state = sph_of(s);
    const tobi_particles *p = &s->particles;
    const sph_fields *f = sph_fields_of(&s->particles);
    if (p->id[i] > p->id[j]) { int64_t swap = i; i = j; j = swap; }
    const tobi_near_entry *a = &state->near.entry[f->near[i]], *b;
    const tobi_record *from = &s->cells.record[i], *to = &s->cells.record[j];
    const double d[3] = {(int32_t)((uint32_t)from->x - (uint32_t)to->x)/s->box.to_fixed[0],
                         (int32_t)((uint32_t)from->y - (uint32_t)to->y)/s->box.to_fixed[1],
                         (int32_t)((uint32_t)from->z - (uint32_t)to->z)/s->box.to_fixed[2]};
    double length = sqrt(dot(d, d)), x[3] = {p->position[i].x, p->position[i].y, p->position[i].z};
    for (; a; a = next_entry(s, a))
        for (b = &state->near.entry[f->near[j]]; b; b = next_entry(s, b)) {
            if (a->body != b->body || fabs(a->distance) + fabs(b->distance) >= length) continue;
            double to[3], ra[3], rb[3];
            for (int c = 0; c < 3; c++) {
                to[c] = x[c] - d[c];
                ra[c] = to[c] - a->foot[c];
                rb[c] = to[c] + d[c] - b->foot[c];
            }
            if (dot(ra, a->foot_normal) >= 0 && dot(rb, b->foot_normal) >= 0) continue;
            const tobi_bvh *tree = s->sim->bodies[a->body].bvh;
            if (tobi_bvh_segment_hits(tree, x, to)) return 1;
        }
    return 0;
}

static void cut_pairs(const void *view, int64_t begin, int64_t end)
{
    const looking *v = view;
    const tobi_system *s = v->s;
    const sph_fields *p = sph_fields_of(&s->particles);
    int64_t cut = 0;
    for (int64_t k = begin; k < end; k++) {
        int64_t i = sph_of(s)->near.entry[k].particle;
        if (p->near[i] != k) continue;      /* once per particle */
        int32_t *list = s->cells.list + 8*(int64_t)s->cells.list_start[i];
        for (int g = 0; g < 8*s->cells.list_groups[i]; g++) {
            int32_t j = list[g];
            if (j == i || p->near[j] < 0 || !separated(s, i, j)) continue;
            list[g] = (int32_t)i;
            cut++;
        }
    }
    __atomic_fetch_add(v->cut, cut, __ATOMIC_RELAXED);      /* whole numbers: any order gives the same */
}

void tobi_near_cut_pairs(tobi_system *s)
{
    sph_state *state = sph_of(s);
    int64_t cut = 0;
    const looking view = {.s = s, .cut = &cut};
    tobi_loop(s->sim->exec.threads, state->near.count, 64, cut_pairs, &view);
    state->near.cut_pairs = cut/2;
}

static void visit_entries(tobi_system *s, tobi_range visit)
{
    const looking view = {.s = s};
    tobi_loop(s->sim->exec.threads, sph_of(s)->near.count, 0, visit, &view);
}

/* Runs over entries; those of one particle are handled together, where the first of them stands. */
#define FOR_NEAR_PARTICLES(s, k, i, e)                                                                     \
    for (int64_t k = begin; k < end; k++)                                                                  \
        for (int64_t i = sph_of(s)->near.entry[k].particle,                                                \
                     once = sph_fields_of(&s->particles)->near[i] == k; once; once = 0)                    \
            for (const tobi_near_entry *e = &sph_of(s)->near.entry[k]; e; e = next_entry((s), e))

static void mark_beside(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = ((const looking *)view)->s;
    const sph_fields *p = sph_fields_of(&s->particles);
    for (int64_t k = begin; k < end; k++) {
        int64_t i = sph_of(s)->near.entry[k].particle;
        const int32_t *list = s->cells.list + 8*(int64_t)s->cells.list_start[i];
        for (int g = 0; g < 8*s->cells.list_groups[i]; g++)
            __atomic_store_n(&p->beside[list[g]], 1, __ATOMIC_RELAXED);
        __atomic_store_n(&p->beside[i], 1, __ATOMIC_RELAXED);
    }
}

void tobi_near_mark_beside(tobi_system *s)
{
    const sph_fields *f = sph_fields_of(&s->particles);
    if (!f->beside) return;
    memset(f->beside, 0, (size_t)s->particles.count);
    visit_entries(s, mark_beside);
}

static void add_gradients(const void *view, int64_t begin, int64_t end)
{
    tobi_system *s = ((const looking *)view)->s;
    const sph_fields *f = sph_fields_of(&s->particles);
    FOR_NEAR_PARTICLES(s, k, i, e) {
        tobi_float4 *w = &f->wall[i];
        w->x += (float)e->gradient[0]; w->y += (float)e->gradient[1]; w->z += (float)e->gradient[2];
        w->w += (float)e->wall_flux;
        f->density[i] = 1 - (1 - f->density[i])*(1 - (float)e->share);
    }
}

void tobi_near_add_gradients(tobi_system *s) { visit_entries(s, add_gradients); }

/* Acceleration by lift and friction of one entry, for velocity u. */
static void entry_accel(const tobi_system *s, const tobi_near_entry *e, const double u[3],
                        double lift[3], double drag[3])
{
    const tobi_fluid *f = &s->fluid[s->particles.fluid[e->particle]];
    double nu = f->viscosity/f->density, a[3];
    for (int c = 0; c < 3; c++) {
        lift[c] = e->lift[c];
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
    tobi_system *s = ((const looking *)view)->s;
    FOR_NEAR_PARTICLES(s, k, i, e) {
        tobi_float4 *v = &s->particles.velocity[i];
        double u[3] = {v->x, v->y, v->z}, lift[3], drag[3];
        entry_accel(s, e, u, lift, drag);
        tobi_near_entry *own = (tobi_near_entry *)e;   /* kept for the reaction */
        memcpy(own->lift, lift, sizeof lift);
        memcpy(own->friction, drag, sizeof drag);
        v->x += (float)(s->dt*(lift[0] + drag[0]));
        v->y += (float)(s->dt*(lift[1] + drag[1]));
        v->z += (float)(s->dt*(lift[2] + drag[2]));
    }
}

void tobi_near_add_forces(tobi_system *s) { visit_entries(s, add_forces); }

/* Keeps the place x + way of particle i at least that far from the bodies it sees. */
static void keep_away(const tobi_system *s, int64_t i, double least, double way[3])
{
    int32_t k = sph_fields_of(&s->particles)->near[i];
    for (const tobi_near_entry *e = k >= 0 ? &sph_of(s)->near.entry[k] : NULL; e; e = next_entry(s, e)) {
        double lack = least - e->distance - dot(way, e->foot_normal);
        for (int a = 0; a < 3 && lack > 0; a++) way[a] += lack*e->foot_normal[a];
    }
}

static void settle_particles(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = ((const looking *)view)->s;
    const tobi_particles *p = &s->particles;
    const sph_fields *f = sph_fields_of(&s->particles);
    const double d = s->smoothing.spacing, most = 0.1*d, least = 0.2*d;
    for (int64_t i = begin; i < end; i++) {
        if (!f->beside[i]) continue;
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

void tobi_near_settle(tobi_system *s)
{
    const looking view = {.s = s};
    tobi_loop(s->sim->exec.threads, s->particles.count, 0, settle_particles, &view);
}

static void bend_normals(const void *view, int64_t begin, int64_t end)
{
    tobi_system *s = ((const looking *)view)->s;
    FOR_NEAR_PARTICLES(s, k, i, e) {
        tobi_float4 *n = &sph_fields_of(&s->particles)->normal[i];
        double u[3] = {n->x, n->y, n->z}, across = dot(u, e->foot_normal), size = 0;
        for (int c = 0; c < 3; c++) {
            u[c] -= across*e->foot_normal[c];
            size += u[c]*u[c];
        }
        if (e->distance >= 1.5*s->smoothing.spacing || !(size > 1e-6)) continue;
        double cosine = s->sim->bodies[e->body].contact_cosine, scale = sqrt((1 - cosine*cosine)/size);
        for (int c = 0; c < 3; c++) (&n->x)[c] = (float)(scale*u[c] + cosine*e->foot_normal[c]);
    }
}

void tobi_near_contact(tobi_system *s) { visit_entries(s, bend_normals); }

/* The Laplacian knows the traction mu dv/dn. A wall that turns at omega has mu (dv/dn + n x omega): the
   second part adds no force to a closed surface, but a torque, eq. (17). */
static void turning_traction(const tobi_system *s, const tobi_near_entry *e, double force[3])
{
    const tobi_body *b = &s->sim->bodies[e->body];
    const double *w = b->info.angular_velocity;
    double share = b->friction == TOBI_NO_SLIP
                       ? 2*s->smoothing.volume*s->fluid[s->particles.fluid[e->particle]].viscosity : 0;
    for (int a = 0; a < 3; a++) {
        int p = (a + 1)%3, q = (a + 2)%3;
        force[a] = share*(w[p]*e->gradient[q] - w[q]*e->gradient[p]);
    }
}

/* Sums of the reactions on one body over the entries. */
typedef struct reaction { const tobi_system *s; int body; int viscous, known; } reaction;

static void sum_reaction(const void *view, int64_t begin, int64_t end, double *t)
{
    const reaction *r = view;
    const tobi_system *s = r->s;
    const sph_fields *f = sph_fields_of(&s->particles);
    for (int64_t k = begin; k < end; k++) {
        const tobi_near_entry *e = &sph_of(s)->near.entry[k];
        if (e->body != r->body) continue;
        const tobi_body *b = &s->sim->bodies[e->body];
        double mass = s->smoothing.volume * s->fluid[s->particles.fluid[e->particle]].density,
               force[3], arm[3], turning[3] = {0, 0, 0};
        const double *accel = r->viscous ? e->friction : e->lift;
        for (int a = 0; a < 3; a++) {
            force[a] = -mass*accel[a];
            arm[a] = e->foot[a] + b->lower[a] - b->centre[a];
        }
        if (r->viscous) turning_traction(s, e, turning);
        float capillary = f->capillary ? f->capillary[e->particle] : 0;
        float pressure = r->known ? 0 : f->pressure[e->particle];
        double push = r->viscous ? 0 : 2*s->smoothing.volume*(pressure - capillary);
        for (int a = 0; a < 3; a++) {
            int p = (a + 1)%3, q = (a + 2)%3;
            t[a] += force[a] + push*e->gradient[a];
            t[3 + a] += arm[p]*(force[q] + turning[q]) - arm[q]*(force[p] + turning[p]) +
                        push*e->torque_arm[a];
        }
    }
}

void tobi_near_known_forces(tobi_system *s, int body, double force[6])
{
    memset(force, 0, 6*sizeof *force);
    for (int viscous = 0; viscous < 2; viscous++) {
        double t[TOBI_TOTALS];
        reaction r = {s, body, viscous, 1};
        tobi_launch(&s->sim->exec, TOBI_HOST(sum_reaction, 6, 0), &r, 0, sph_of(s)->near.count, t);
        for (int a = 0; a < 6; a++) force[a] += t[a];
    }
}

void tobi_near_body_forces(tobi_system *s)
{
    sph_state *state = sph_of(s);
    for (int k = 0; k < s->sim->body_count; k++) {
        tobi_body_info *info = &s->sim->bodies[k].info;
        double t[TOBI_TOTALS];
        reaction r = {s, k, 0, 0};
        tobi_launch(&s->sim->exec, TOBI_HOST(sum_reaction, 6, 0), &r, 0, state->near.count, t);
        memcpy(info->pressure_force, t, 3*sizeof *t);
        memcpy(info->pressure_torque, t + 3, 3*sizeof *t);
        r.viscous = 1;
        tobi_launch(&s->sim->exec, TOBI_HOST(sum_reaction, 6, 0), &r, 0, state->near.count, t);
        memcpy(info->viscous_force, t, 3*sizeof *t);
        memcpy(info->viscous_torque, t + 3, 3*sizeof *t);
    }
}

void tobi_near_free(tobi_near_bodies *n)
{
    free(n->entry);
    free(n->block_count);
    free(n->bin_start);
    free(n->bin_item);
    free(n->answer);
    memset(n, 0, sizeof *n);
}
