#include "sph/multigrid.h"
#include <stdlib.h>
#include <string.h>

enum { THREADED = 8000 };      /* nodes from which a sweep is worth sharing */

static int64_t nodes_of(const sph_grid *g) { return (int64_t)g->n[0]*g->n[1]*g->n[2]; }

static int64_t cells_of(const sph_multigrid *m) { return (int64_t)m->cells[0]*m->cells[1]*m->cells[2]; }

/* Sizes of all levels; returns the number of nodes. */
static int64_t plan(sph_multigrid *m, const tobi_system *s)
{
    int64_t total = 0;
    memcpy(m->periodic, s->cells.periodic, sizeof m->periodic);
    m->dimension = s->box.dimension;
    for (int a = 0; a < 3; a++) {
        m->cells[a] = (s->cells.n[a] + 1)/2;
        m->per_metre[a] = 0.5*s->cells.inverse[a];
        m->grid[0].n[a] = a >= m->dimension ? 1 : m->cells[a] + !m->periodic[a];
    }
    for (m->levels = 1;; m->levels++) {
        const sph_grid *fine = &m->grid[m->levels - 1];
        total += nodes_of(fine);
        if (nodes_of(fine) <= 8 || m->levels == SPH_GRID_LEVELS) return total;
        for (int a = 0; a < 3; a++) m->grid[m->levels].n[a] = (fine->n[a] + 1)/2;
    }
}

tobi_status sph_multigrid_create(sph_multigrid *m, const tobi_system *s, tobi_error *err)
{
    memset(m, 0, sizeof *m);
    int64_t total = plan(m, s);
    m->memory = calloc((size_t)total*6, sizeof *m->memory);
    m->corner = calloc((size_t)cells_of(m), sizeof *m->corner);
    if (!m->memory || !m->corner) {
        sph_multigrid_free(m);
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a grid of %lld nodes", (long long)total);
    }
    float *at = m->memory;
    for (int l = 0; l < m->levels; l++) {
        sph_grid *g = &m->grid[l];
        float **array[] = {&g->value, &g->source, &g->face[0], &g->face[1], &g->face[2], &g->inverse};
        for (int k = 0; k < 6; k++, at += nodes_of(g)) *array[k] = at;
    }
    return TOBI_OK;
}

void sph_multigrid_free(sph_multigrid *m)
{
    free(m->memory);
    free(m->corner);
    memset(m, 0, sizeof *m);
}

/* Runs over the rows (y, z) of a grid on `threads`; needs size = the number of its nodes in scope. */
#define FOR_ROWS(ny, nz, y, z)                                                                             \
    _Pragma("omp parallel for num_threads(threads) schedule(static) if (size >= THREADED)")                 \
    for (int row_ = 0; row_ < (ny)*(nz); row_++)                                                            \
        for (int y = row_%(ny), z = row_/(ny), once_ = 1; once_; once_ = 0)
#define FOR_NODE_ROWS(y, z) const int64_t size = nodes_of(g); FOR_ROWS(g->n[1], g->n[2], y, z)

/* Offset to the node after and before number k along an axis; the ends wrap (with a face of 0 where they
   must not). */
static int64_t after(const sph_grid *g, int axis, int k, int64_t stride)
{
    return k + 1 < g->n[axis] ? stride : -(int64_t)(g->n[axis] - 1)*stride;
}
static int64_t before(const sph_grid *g, int axis, int k, int64_t stride)
{
    return k > 0 ? -stride : (int64_t)(g->n[axis] - 1)*stride;
}

/* Sum of face times value over the neighbours of node c. */
static float pull(const sph_grid *g, const int at[3], int64_t c)
{
    int64_t stride = 1;
    float sum = 0;
    for (int a = 0; a < 3; a++) {
        int64_t up = c + after(g, a, at[a], stride), down = c + before(g, a, at[a], stride);
        sum += g->face[a][c]*g->value[up] + g->face[a][down]*g->value[down];
        stride *= g->n[a];
    }
    return sum;
}

/* Gauss-Seidel over the nodes of one colour. */
static void sweep(const sph_grid *g, int colour, int threads)
{
    FOR_NODE_ROWS(y, z) {
        int64_t row = ((int64_t)z*g->n[1] + y)*g->n[0];
        for (int x = (y + z + colour) & 1; x < g->n[0]; x += 2)
            if (g->inverse[row + x] > 0)
                g->value[row + x] =
                    (g->source[row + x] + pull(g, (int[3]){x, y, z}, row + x))*g->inverse[row + x];
    }
}

/* g.source = the residual of the finer level, summed over groups of eight nodes. */
static void restrict_residual(const sph_grid *fine, const sph_grid *g, int threads)
{
    FOR_NODE_ROWS(y, z) {
        float *out = g->source + ((int64_t)z*g->n[1] + y)*g->n[0];
        memset(out, 0, (size_t)g->n[0]*sizeof *out);
        for (int zz = 2*z; zz < 2*z + 2 && zz < fine->n[2]; zz++)
            for (int yy = 2*y; yy < 2*y + 2 && yy < fine->n[1]; yy++)
                for (int x = 0; x < fine->n[0]; x++) {
                    int64_t c = ((int64_t)zz*fine->n[1] + yy)*fine->n[0] + x;
                    if (fine->inverse[c] > 0)
                        out[x/2] += fine->source[c] + pull(fine, (int[3]){x, yy, zz}, c) -
                                    fine->value[c]/fine->inverse[c];
                }
    }
}

static void prolong(const sph_grid *coarse, const sph_grid *g, int threads)
{
    FOR_NODE_ROWS(y, z) {
        const float *in = coarse->value + ((int64_t)(z/2)*coarse->n[1] + y/2)*coarse->n[0];
        int64_t row = ((int64_t)z*g->n[1] + y)*g->n[0];
        for (int x = 0; x < g->n[0]; x++)
            if (g->inverse[row + x] > 0) g->value[row + x] += in[x/2];
    }
}

static void cycle(sph_multigrid *m, int level, int threads)
{
    const sph_grid *g = &m->grid[level];
    int coarsest = level + 1 == m->levels, rounds = coarsest ? 8 : 1;
    memset(g->value, 0, (size_t)nodes_of(g)*sizeof *g->value);
    for (int k = 0; k < rounds; k++) {
        sweep(g, 0, threads);
        sweep(g, 1, threads);
    }
    if (!coarsest) {
        restrict_residual(g, &m->grid[level + 1], threads);
        cycle(m, level + 1, threads);
        prolong(&m->grid[level + 1], g, threads);
    }
    for (int k = 0; k < rounds; k++) {
        sweep(g, 1, threads);
        sweep(g, 0, threads);
    }
}

/* What a particle adds to the corners of its cell. */
typedef float (*share_fn)(const tobi_particles *p, int64_t i);
static float share_residual(const tobi_particles *p, int64_t i)
{
    return p->precondition[i] > 0 ? p->residual[i] : 0;
}
static float share_active(const tobi_particles *p, int64_t i) { return p->precondition[i] > 0; }
static float share_surface(const tobi_particles *p, int64_t i) { return p->surface[i]; }
static float share_one(const tobi_particles *p, int64_t i) { (void)p; (void)i; return 1; }

static void add_cell(const sph_multigrid *m, const tobi_system *s, int x, int y, int z, share_fn share)
{
    float sum[8] = {0};
    const int at[3] = {x, y, z};
    const tobi_cells *c = &s->cells;
    for (int zz = 2*z; zz < 2*z + 2 && zz < c->n[2]; zz++)
        for (int yy = 2*y; yy < 2*y + 2 && yy < c->n[1]; yy++) {
            int64_t row = tobi_cells_row(c, yy, zz);
            int64_t end = c->start[row + (2*x + 2 < c->n[0] ? 2*x + 2 : c->n[0])];
            for (int64_t i = c->start[row + 2*x]; i < end; i++) {
                const double *q = &s->particles.position[i].x;
                float v = share(&s->particles, i), w[3][2];
                for (int a = 0; a < 3; a++) {
                    w[a][1] = a < m->dimension ? (float)(q[a]*m->per_metre[a] - at[a]) : 0;
                    w[a][0] = 1 - w[a][1];
                }
                for (int k = 0; k < 8; k++) sum[k] += v*w[0][k & 1]*w[1][k >> 1 & 1]*w[2][k >> 2];
            }
        }
    memcpy(m->corner[((int64_t)z*m->cells[1] + y)*m->cells[0] + x], sum, sizeof sum);
}

/* The cell before (side 0) or after (side 1) node k along an axis, -1 = none. */
static int cell_beside(const sph_multigrid *m, int axis, int k, int side)
{
    int c = k - 1 + side;
    if (axis >= m->dimension) return side ? 0 : -1;
    if (c >= 0 && c < m->cells[axis]) return c;
    return m->periodic[axis] ? (c + m->cells[axis])%m->cells[axis] : -1;
}

/* out = P^T share: the corner sums of the cells around each node. */
static void gather(const sph_multigrid *m, const tobi_system *s, share_fn share, float *out)
{
    const sph_grid *g = &m->grid[0];
    int threads = s->sim->exec.threads;
    const int64_t size = nodes_of(g);
    FOR_ROWS(m->cells[1], m->cells[2], y, z)
        for (int x = 0; x < m->cells[0]; x++) add_cell(m, s, x, y, z, share);
    FOR_ROWS(g->n[1], g->n[2], y, z)
        for (int x = 0; x < g->n[0]; x++) {
            float sum = 0;
            for (int k = 0; k < 8; k++) {
                int cx = cell_beside(m, 0, x, k & 1), cy = cell_beside(m, 1, y, k >> 1 & 1),
                    cz = cell_beside(m, 2, z, k >> 2);
                if (cx < 0 || cy < 0 || cz < 0) continue;
                sum += m->corner[((int64_t)cz*m->cells[1] + cy)*m->cells[0] + cx][7 - k];
            }
            out[((int64_t)z*g->n[1] + y)*g->n[0] + x] = sum;
        }
}

/* The face between two nodes is as wet as the drier one; `mass` counts particles per node. */
static void set_faces(const sph_multigrid *m, const float *mass, double volume, double conductance,
                      int threads)
{
    const sph_grid *g = &m->grid[0];
    double full = 1/volume;
    int64_t stride = 1;
    for (int a = 0; a < m->dimension; a++) full /= m->per_metre[a];
    for (int a = 0; a < m->dimension; a++) {
        float face = (float)(conductance*full*volume*m->per_metre[a]*m->per_metre[a]);
        FOR_NODE_ROWS(y, z)
            for (int x = 0; x < g->n[0]; x++) {
                int64_t c = ((int64_t)z*g->n[1] + y)*g->n[0] + x;
                int k = a == 0 ? x : a == 1 ? y : z;
                /* no wrap over an odd number of nodes: its ends have one colour */
                int end = k + 1 == g->n[a] && (!m->periodic[a] || g->n[a]%2);
                float wet = fminf(mass[c], mass[c + after(g, a, k, stride)])/(float)full;
                g->face[a][c] = end ? 0 : face*fminf(wet, 1);
            }
        stride *= g->n[a];
    }
}

/* inverse = 1/(sum of faces + what holds the pressure down at a surface) where something is solved. */
static void set_diagonal(const sph_grid *g, const float *hold, int threads)
{
    FOR_NODE_ROWS(y, z)
        for (int x = 0; x < g->n[0]; x++) {
            int64_t c = ((int64_t)z*g->n[1] + y)*g->n[0] + x, stride = 1;
            int at[3] = {x, y, z};
            float sum = hold[c];
            for (int a = 0; a < 3; a++) {
                sum += g->face[a][c] + g->face[a][c + before(g, a, at[a], stride)];
                stride *= g->n[a];
            }
            g->inverse[c] = g->source[c] > 0 && sum > 0 ? 1/sum : 0;
        }
}

/* The next level: faces halve (twice the distance), what holds and what is solved adds up. */
static void coarsen(const sph_multigrid *m, int level, int threads)
{
    const sph_grid *f = &m->grid[level], *g = &m->grid[level + 1];
    FOR_NODE_ROWS(y, z)
        for (int x = 0; x < g->n[0]; x++) {
            int64_t c = ((int64_t)z*g->n[1] + y)*g->n[0] + x;
            const int own[3] = {x, y, z};
            float face[3] = {0, 0, 0}, hold = 0, solved = 0;
            for (int k = 0; k < 8; k++) {
                int at[3] = {2*x + (k & 1), 2*y + (k >> 1 & 1), 2*z + (k >> 2)};
                if (at[0] >= f->n[0] || at[1] >= f->n[1] || at[2] >= f->n[2]) continue;
                int64_t i = ((int64_t)at[2]*f->n[1] + at[1])*f->n[0] + at[0];
                for (int a = 0; a < 3; a++)
                    if (at[a]%2 == 1 || at[a] + 1 == f->n[a]) face[a] += 0.5f*f->face[a][i];
                hold += f->value[i];
                solved += f->source[i];
            }
            for (int a = 0; a < 3; a++) {
                int end = own[a] + 1 == g->n[a] && g->n[a]%2;
                g->face[a][c] = end ? 0 : face[a];
            }
            g->value[c] = hold;
            g->source[c] = solved;
        }
}

void sph_multigrid_set(sph_multigrid *m, const tobi_system *s, double conductance)
{
    const sph_grid *g = &m->grid[0];
    int threads = s->sim->exec.threads;
    double d = s->smoothing.spacing;
    gather(m, s, share_one, g->value);
    set_faces(m, g->value, s->smoothing.volume, conductance, threads);
    gather(m, s, share_active, g->source);
    gather(m, s, share_surface, g->value);
    /* a surface particle has pressure 0 about a spacing outside, over its share of the surface */
    float hold = (float)(conductance*s->smoothing.volume/(d*d));
    for (int64_t c = 0; c < nodes_of(g); c++) g->value[c] *= hold;
    for (int l = 0; l < m->levels; l++) {
        if (l + 1 < m->levels) coarsen(m, l, threads);
        set_diagonal(&m->grid[l], m->grid[l].value, threads);
    }
}

double sph_multigrid_apply(sph_multigrid *m, const tobi_system *s)
{
    const sph_grid *g = &m->grid[0];
    double dot = 0;
    gather(m, s, share_residual, g->source);
    cycle(m, 0, s->sim->exec.threads);
    for (int64_t c = 0; c < nodes_of(g); c++) dot += (double)g->source[c]*g->value[c];
    return dot;
}
