/* Who sees which body, and what the particles make of it: the search, the entries, and what the forces of a
   step read of them (docs/theory/boundaries.md). Rows of cells near each body's box are searched, not all
   particles for every body. Drawback: a particle near many bodies is looked at for each of them. */
#include "sph/boundary/boundary.h"
#include "sph/boundary/look.h"
#include "sph/state.h"
#include "sph/viscous_bodies.h"
#include "sph/wall_law.h"
#include <math.h>
#include <string.h>

static double dot(const double a[3], const double b[3]) { return a[0]*b[0] + a[1]*b[1] + a[2]*b[2]; }

tobi_status tobi_boundary_grow_rows(void **p, int64_t *capacity, int64_t need, size_t size, tobi_error *err)
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

/* Whether a particle at x sees one of the points. */
static int sees_any(const tobi_system *s, tobi_point_run run, const double x[3])
{
    const tobi_boundary_links *n = &sph_of(s)->links;
    const double h = s->smoothing.h;
    return n->loops->any(n->point_row, run.begin - n->point, run.end - n->point, x, h*h);
}

/* Whether x sees a point of the body: most likely one in its own or the nearest bin. */
static int sees_body(const tobi_system *s, int body, const double x[3])
{
    const tobi_boundary_links *n = &sph_of(s)->links;
    tobi_point_run run[TOBI_POINT_RUNS];
    if (sees_any(s, tobi_boundary_nearest_run(n, body, x), x)) return 1;
    for (int r = tobi_boundary_runs(n, body, x, run); r-- > 0;)
        if (sees_any(s, run[r], x)) return 1;
    return 0;
}

static int cell_along(const tobi_cells *c, int axis, double x)
{
    const double k = x*c->inverse[axis];
    return k < 0 ? 0 : k >= c->n[axis] ? c->n[axis] - 1 : (int)k;
}

static tobi_status add_row(tobi_system *s, int body, int64_t begin, int64_t end, int64_t *hits,
                           tobi_error *err)
{
    tobi_boundary_links *n = &sph_of(s)->links;
    if (begin == end) return TOBI_OK;
    TOBI_TRY(tobi_boundary_grow(&n->row, &n->row_capacity, n->row_count + 1, err));
    n->row[n->row_count++] = (tobi_boundary_row){body, (int32_t)begin, (int32_t)end, *hits};
    *hits += end - begin;
    return TOBI_OK;
}

/* Adds the rows of cells within h of the body's box, in the order of their particles. */
static tobi_status list_rows(tobi_system *s, int body, int64_t *hits, tobi_error *err)
{
    const tobi_cells *c = &s->cells;
    const tobi_boundary_bins *box = &sph_of(s)->links.bins[body];
    int low[3], high[3];
    for (int a = 0; a < 3; a++) {
        low[a] = cell_along(c, a, box->lower[a] - 1.001*s->smoothing.h);
        high[a] = cell_along(c, a, box->upper[a] + 1.001*s->smoothing.h);
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
static int is_far(const tobi_system *s, const tobi_boundary_bins *box, const double x[3])
{
    const double *lo = box->lower, *hi = box->upper;
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
        int64_t found = 0;
        for (int32_t i = row->begin; i < row->end; i++) {
            const tobi_double3 at = s->particles.position[i];
            const double x[3] = {at.x, at.y, at.z};
            if (!is_far(s, &n->bins[row->body], x) && sees_body(s, row->body, x)) hit[found++] = i;
        }
        n->found[r] = found;
    }
}

static void fill_row(const tobi_system *s, int64_t r, int alone)
{
    const tobi_boundary_links *n = &sph_of(s)->links;
    const tobi_boundary_row *row = &n->row[r];
    const int64_t stop = r + 1 < n->row_count ? n->found[r + 1] : n->count;
    const int32_t *hit = n->hit + row->hit;
    for (int64_t k = n->found[r]; k < stop; k++)
        tobi_boundary_look(s, *hit++, row->body, alone, &n->link[k], &n->entry[k]);
}

/* The rows of a body that few particles see are one piece of work, that of its first row: its points then
   need no locked sums. */
static void fill_entries(const void *view, int64_t begin, int64_t end, double *totals)
{
    enum { FEW = 4*TOBI_BLOCK };
    const tobi_system *s = view;
    const tobi_boundary_links *n = &sph_of(s)->links;
    (void)totals;
    for (int64_t r = begin; r < end; r++) {
        const int32_t body = n->row[r].body;
        const int alone = n->first[body + 1] - n->first[body] <= FEW;
        if (!alone) fill_row(s, r, 0);
        else if (r == 0 || n->row[r - 1].body != body)
            for (int64_t k = r; k < n->row_count && n->row[k].body == body; k++) fill_row(s, k, 1);
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
    TOBI_TRY(tobi_boundary_grow(&n->total, &n->total_capacity, bodies, err));
    TOBI_TRY(tobi_boundary_grow(&n->answer, &n->answer_capacity, bodies, err));
    TOBI_TRY(tobi_boundary_grow(&n->viscous, &n->viscous_capacity, bodies, err));
    TOBI_TRY(tobi_boundary_grow(&n->part, &n->part_capacity, parts > blocks ? parts : blocks, err));
    TOBI_TRY(tobi_boundary_grow(&n->caught, &n->caught_capacity, blocks*TOBI_BLOCK, err));
    return tobi_boundary_grow(&n->caught_block, &n->blocks_capacity, blocks, err);
}

tobi_status tobi_boundary_search(tobi_system *s, tobi_error *err)
{
    tobi_boundary_links *n = &sph_of(s)->links;
    tobi_exec *x = &s->sim->exec;
    const int bodies = s->sim->body_count;
    int64_t hits = 0;
    n->row_count = 0;
    TOBI_TRY(tobi_boundary_place_points(s, err));
    TOBI_TRY(tobi_boundary_grow(&n->first, &n->first_capacity, bodies + 1, err));
    for (int k = 0; k < bodies; k++) {
        n->first[k] = n->row_count;
        TOBI_TRY(list_rows(s, k, &hits, err));
    }
    TOBI_TRY(tobi_boundary_grow(&n->found, &n->found_capacity, n->row_count, err));
    TOBI_TRY(tobi_boundary_grow(&n->hit, &n->hit_capacity, hits, err));
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
    TOBI_TRY(tobi_boundary_grow(&n->link, &n->link_capacity, n->count, err));
    TOBI_TRY(tobi_boundary_grow(&n->entry, &n->capacity, n->count, err));
    tobi_launch_each(&s->sim->exec, TOBI_HOST(fill_entries, 0, 0), s, n->row_count, NULL);
    chain_entries(s);
    TOBI_TRY(reserve(s, err));
    TOBI_TRY(tobi_body_tree_reserve(&n->tree, s->sim->body_count, err));
    tobi_boundary_fill_gaps(s);
    return TOBI_OK;
}

void tobi_boundary_visit_entries(tobi_system *s, tobi_range visit)
{
    tobi_loop(s->sim->exec.threads, sph_of(s)->links.count, 0, visit, s);
}

static void add_gradients(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_fields *f = sph_fields_of(&s->particles);
    const tobi_boundary_links *n = &sph_of(s)->links;
    SPH_FOR_NEAR_PARTICLES(s, k, i, e) {
        tobi_float4 *w = &f->wall[i];
        const double *g = n->link[e - n->entry].gradient;
        w->x += (float)g[0]; w->y += (float)g[1]; w->z += (float)g[2];
        w->w += (float)e->wall_flux;
        f->density[i] = 1 - (1 - f->density[i])*(1 - (float)e->share);
    }
}

void tobi_boundary_add_gradients(tobi_system *s) { tobi_boundary_visit_entries(s, add_gradients); }

/* Acceleration by hydrostatic pressure of mirrors and friction of one entry, for velocity u; implicit
   viscosity finds friction later. */
static void entry_accel(const tobi_system *s, int64_t i, const tobi_boundary_entry *e, const double u[3],
                        double hydrostatic[3], double drag[3])
{
    const tobi_fluid *f = &s->fluid[s->particles.fluid[i]];
    double nu = f->viscosity/f->density, a[3];
    for (int c = 0; c < 3; c++) {
        hydrostatic[c] = e->hydrostatic[c];
        a[c] = nu*(e->drag_velocity[c] - e->drag*u[c]);
    }
    memset(drag, 0, 3*sizeof *drag);
    if (s->sim->def.implicit_viscosity) return;
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
    SPH_FOR_NEAR_PARTICLES(s, k, i, e) {
        tobi_float4 *v = &s->particles.velocity[i];
        double u[3] = {v->x, v->y, v->z}, hydrostatic[3], drag[3];
        entry_accel(s, i, e, u, hydrostatic, drag);
        tobi_boundary_entry *own = (tobi_boundary_entry *)e;   /* kept for the reaction */
        memcpy(own->hydrostatic, hydrostatic, sizeof hydrostatic);
        memcpy(own->friction, drag, sizeof drag);
        memset(own->couple, 0, sizeof own->couple);
        v->x += (float)(s->dt*(hydrostatic[0] + drag[0]));
        v->y += (float)(s->dt*(hydrostatic[1] + drag[1]));
        v->z += (float)(s->dt*(hydrostatic[2] + drag[2]));
    }
}

void tobi_boundary_add_forces(tobi_system *s) { tobi_boundary_visit_entries(s, add_forces); }

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
    SPH_FOR_NEAR_PARTICLES(s, k, i, e) {
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

void tobi_boundary_turn_normals(tobi_system *s) { tobi_boundary_visit_entries(s, turn_normals); }

int64_t tobi_boundary_links_bytes(const tobi_boundary_links *n)
{
    return n->link_capacity*(int64_t)sizeof *n->link + n->capacity*(int64_t)sizeof *n->entry +
           n->first_capacity*(int64_t)sizeof *n->first +
           n->total_capacity*(int64_t)sizeof *n->total + n->answer_capacity*(int64_t)sizeof *n->answer +
           n->viscous_capacity*(int64_t)sizeof *n->viscous +
           n->part_capacity*(int64_t)sizeof *n->part + n->caught_capacity*(int64_t)sizeof *n->caught +
           n->blocks_capacity*(int64_t)sizeof *n->caught_block +
           n->bins_capacity*(int64_t)sizeof *n->bins + n->start_capacity*(int64_t)sizeof *n->bin_start +
           n->point_capacity*(int64_t)(sizeof *n->point + TOBI_POINT_ROWS*sizeof **n->point_row) +
           n->row_capacity*(int64_t)sizeof *n->row +
           n->found_capacity*(int64_t)sizeof *n->found + n->hit_capacity*(int64_t)sizeof *n->hit +
           n->mark_capacity;
}

void tobi_boundary_links_free(tobi_boundary_links *n)
{
    tobi_array_free(n->link);
    tobi_array_free(n->entry);
    tobi_array_free(n->first);
    tobi_array_free(n->total);
    tobi_array_free(n->answer);
    tobi_array_free(n->viscous);
    tobi_array_free(n->part);
    tobi_array_free(n->caught);
    tobi_array_free(n->caught_block);
    tobi_array_free(n->bins);
    tobi_array_free(n->bin_start);
    tobi_array_free(n->point);
    for (int r = 0; r < TOBI_POINT_ROWS; r++) tobi_array_free(n->point_row[r]);
    tobi_array_free(n->row);
    tobi_array_free(n->found);
    tobi_array_free(n->hit);
    tobi_array_free(n->cut_mark);
    tobi_body_tree_free(&n->tree);
    memset(n, 0, sizeof *n);
}
