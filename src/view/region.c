/* In 2-D: the region that a group of particles fills. The kernel sum on the nodes of a grid, then what of
   each of its cells lies above a level (marching squares: Lorensen, Cline 1987, in the plane). At walls,
   bodies and solids the sum is divided by the share of the kernel that is free of them. The region ends in
   the wall, and behind bodies and solids, which are drawn before it. Particles alone become discs.
   Drawback: one grid over the extent of a group, in one thread. */
#include "view/isosurface.h"
#include "view/shade.h"
#include "view/skin.h"
#include <stdlib.h>
#include <string.h>

/* In cells, half a spacing each: of sums, and of colours, which stay sharp. */
enum { MOST_NODES = 1 << 24, REACH = 6, COLOR_REACH = 3, NEAR = 8 };

/* Of the kernel: what is more covered is within a body, or between two, where sums are errors of the grid. */
static const float least_room = 0.02f;

/* Of a solid: below this sum a particle is in a row, or alone, and becomes a disc. */
static const float in_solid = 0.3f;

typedef struct plane {
    const canvas *c;
    const surface_request *r;
    double low[2], edge;         /* m, the first node; m between nodes                      */
    int    size[2];              /* nodes                                                   */
    float  wall[2][2];           /* cells from the first node, of the domain                */
    float *node;                 /* sums: 1 inside                                          */
    float *others;               /* of other liquids; NULL: there are none                  */
    vec   *color;                /* of nodes; the mean of those around, the nearest counts  */
    float *weight;               /* most by far. NULL: one colour for all                   */
    float *count;                /* of particles: what each counts; NULL: 1                 */
    float *covered;              /* of nodes: share in bodies and solids; NULL: nowhere     */
    float *clear;                /* of nodes: share in what is seen through                 */
    uint8_t *near;               /* of blocks of nodes                                      */
    int32_t *vertex;             /* of nodes inside, or -1                                  */
    float  behind;               /* m, depth of what is drawn: after bodies and solids      */
    float  under;                /* m, likewise where another liquid is over it             */
} plane;

static int64_t node_at(const plane *p, int x, int y) { return (int64_t)y*p->size[0] + x; }

/* Nodes lie in the middle between walls and the next cells, as in 3-D. False: no particle is near the
   domain. */
static bool place_nodes(plane *p)
{
    const tobi_picture *f = p->r->f;
    double low[2] = { INFINITY, INFINITY }, high[2] = { -INFINITY, -INFINITY }, nodes = 1;
    for (int64_t i = 0; i < p->r->count; i++) {
        const double *x = f->positions[p->r->row[i]];
        for (int k = 0; k < 2; k++) {
            if (!(x[k] >= f->box_min[k] - 4*p->r->radius && x[k] <= f->box_max[k] + 4*p->r->radius)) continue;
            low[k] = fmin(low[k], x[k]);
            high[k] = fmax(high[k], x[k]);
        }
    }
    if (!(low[0] <= high[0] && low[1] <= high[1])) return false;
    p->edge = p->r->radius;
    for (int k = 0; k < 2; k++) nodes *= (high[k] - low[k])/p->edge + 2*REACH + 4;
    if (nodes > MOST_NODES) p->edge *= sqrt(nodes/MOST_NODES);
    for (int k = 0; k < 2; k++) {
        const double first = floor((low[k] - f->box_min[k])/p->edge) - REACH - 1 + 0.5;
        p->low[k] = f->box_min[k] + first*p->edge;
        p->size[k] = (int)((high[k] - p->low[k])/p->edge) + REACH + 3;
        p->wall[k][0] = (float)-first;
        p->wall[k][1] = (float)((f->box_max[k] - p->low[k])/p->edge);
    }
    return true;
}

/* Adds the k-th particle to the nodes within its reach. */
static void add_particle(plane *p, int64_t number)
{
    const int64_t i = p->r->row[number];
    const double *x = p->r->f->positions[i];
    const float count = p->count ? p->count[number] : 1;
    const vec own = p->color ? p->r->color[i] : p->r->plain;
    float at[2];
    int low[2], high[2];
    for (int k = 0; k < 2; k++) {
        at[k] = (float)((x[k] - p->low[k])/p->edge);
        if (!(at[k] >= 0 && at[k] <= (float)p->size[k] - 1)) return;
        low[k] = at[k] > REACH ? (int)at[k] - REACH + 1 : 0;
        high[k] = (int)at[k] + REACH < p->size[k] ? (int)at[k] + REACH : p->size[k] - 1;
    }
    for (int n = low[1]; n <= high[1]; n++)
        for (int m = low[0]; m <= high[0]; m++) {
            const float dx = (float)m - at[0], dy = (float)n - at[1];
            const float square = dx*dx + dy*dy, t = 1 - square/(REACH*REACH);
            const float s = above(1 - square/(COLOR_REACH*COLOR_REACH));
            const int64_t k = node_at(p, m, n);
            if (!(t > 0)) continue;
            p->node[k] += count*(t*t*t);
            if (!p->color) continue;
            const float w = power_16(s)*power_16(s) + 1e-9f*t;      /* the latter where nothing is near */
            p->color[k] = vec_add(p->color[k], vec_scale(w, own));
            p->weight[k] += w;
        }
}

/* Sums of the liquids that are not this one. False: no memory. */
static bool add_others(plane *p)
{
    const surface_request *r = p->r;
    surface_request one = *r;
    plane all = *p;
    if (!r->liquid || r->liquids == r->count) return true;
    all.node = p->others = calloc((size_t)p->size[0]*(size_t)p->size[1], sizeof *p->others);
    if (!p->others) return false;
    all.color = NULL;
    all.r = &one;
    one.row = r->liquid;
    for (int64_t i = 0; i < r->liquids; i++)
        if (!(r->liquid + i >= r->row && r->liquid + i < r->row + r->count)) add_particle(&all, i);
    return true;
}

/* Where liquids meet, each has what it fills more of: no gap is between them, however loose they lie. */
static void part_liquids(float *node, float others, float level)
{
    const float total = *node + others;
    if (others > 0) *node = level + fminf(total - level, *node/total - 0.5f);
}

static float sum_per_particle(const plane *p)
{
    const float spacings = (float)(REACH*p->edge/(2*p->r->radius));
    return 4/(spacings*spacings*3.14159265f);
}

/* Whether a node has cover within reach, by blocks of nodes. */
static uint8_t *near_at(const plane *p, int x, int y)
{
    return &p->near[(int64_t)(y/NEAR)*(p->size[0]/NEAR + 1) + x/NEAR];
}

/* Covers of the domain's nodes; false: no memory. */
static bool find_covers(plane *p)
{
    const segments *cover = p->r->cover;
    const size_t n = (size_t)p->size[0]*(size_t)p->size[1];
    const vec origin = view_point(&p->c->camera, (double[3]){ p->low[0], p->low[1], 0 });
    const cover_grid g = { { origin.x, origin.y }, (float)p->edge, { p->size[0], p->size[1] } };
    if (!cover || cover[COVER_CLEAR].count + cover[COVER_OPAQUE].count == 0) return true;
    p->near = calloc((size_t)(p->size[0]/NEAR + 1)*(size_t)(p->size[1]/NEAR + 1), 1);
    p->covered = malloc(n*sizeof *p->covered);
    p->clear = malloc(n*sizeof *p->clear);
    if (!p->near || !p->covered || !p->clear) return false;
    view_cover_nodes(&g, cover, COVERS, p->covered);
    view_cover_nodes(&g, &cover[COVER_CLEAR], 1, p->clear);
    for (int y = 0; y < p->size[1]; y++)
        for (int x = 0; x < p->size[0]; x++) {
            float *covered = &p->covered[node_at(p, x, y)];
            if ((float)x < p->wall[0][0] || (float)x > p->wall[0][1] || (float)y < p->wall[1][0]
                || (float)y > p->wall[1][1]) *covered = 0;
            for (int k = 0; *covered > 0 && k < 9; k++) {
                const int m = x + NEAR*(k%3 - 1), n = y + NEAR*(k/3 - 1);
                if (m >= 0 && n >= 0 && m < p->size[0] && n < p->size[1]) *near_at(p, m, n) = 1;
            }
        }
    return true;
}

/* Of the kernel around a node, the share in covers. */
static float cover_around(const plane *p, int x, int y)
{
    float sum = 0;
    for (int n = y - REACH + 1; n < y + REACH; n++)
        for (int m = x - REACH + 1; m < x + REACH; m++) {
            const float t = 1 - (float)((m - x)*(m - x) + (n - y)*(n - y))/(REACH*REACH);
            if (t > 0 && m >= 0 && n >= 0 && m < p->size[0] && n < p->size[1])
                sum += t*t*t*p->covered[node_at(p, m, n)];
        }
    return 4/(REACH*REACH*3.14159265f)*sum;
}

/* Cells beyond where this liquid is shown. It goes on for one, so that no corner is missing between two. */
static float beyond_nests(const plane *p, const double x[3])
{
    const tobi_picture *f = p->r->f;
    return f->nest ? (float)(view_beyond_nests(f->nests, f->nest_count, p->r->nest, x)/p->edge) : -INFINITY;
}

/* Sums become 1 inside whatever wall or body is near; beyond walls and the clip plane, and in what is seen
   through, they fall through the level. */
static void limit_nodes(plane *p)
{
    const tobi_picture *f = p->r->f;
    const float per_particle = sum_per_particle(p), level = p->r->level;
    for (int n = 0; n < p->size[1]; n++)
        for (int m = 0; m < p->size[0]; m++) {
            float *node = &p->node[node_at(p, m, n)], most = INFINITY;
            const float at[2] = { (float)m, (float)n };
            const double x[3] = { p->low[0] + p->edge*m, p->low[1] + p->edge*n, 0 };
            float room = 1;
            for (int k = 0; k < 2; k++) {
                const float l = at[k] - p->wall[k][0], h = p->wall[k][1] - at[k];
                room *= share_inside(l/REACH)*share_inside(h/REACH);
                most = fminf(most, level + 0.5f*fminf(l, h));
            }
            if (p->near && *near_at(p, m, n) && *node > 0) room -= cover_around(p, m, n);
            *node *= per_particle/fmaxf(room, least_room);
            if (p->others)
                part_liquids(node, p->others[node_at(p, m, n)]*per_particle/fmaxf(room, least_room), level);
            if (p->clear) most = fminf(most, level + 0.5f - p->clear[node_at(p, m, n)]);
            if (f->clip) most = fminf(most, level - 0.5f*(float)(view_beyond(f, x, 0.5*f->slice)/p->edge));
            if (f->nest) most = fminf(most, level - 0.5f*(beyond_nests(p, x) - 1));
            *node = fminf(*node, most);
        }
}

static vec color_of(const plane *p, int64_t node)
{
    if (!p->color) return p->r->plain;
    const float w = p->weight[node];
    return w > 0 ? vec_scale(1/w, p->color[node]) : p->r->plain;
}

/* A normal of no length: the colour is not shaded. */
static int32_t add_vertex(const plane *p, geometry *g, double x, double y, vec color)
{
    const double at[3] = { p->low[0] + p->edge*x, p->low[1] + p->edge*y, 0 };
    g->place[g->vertices] = view_point(&p->c->camera, at);
    g->place[g->vertices].z = beyond_nests(p, at) > 0 ? p->under : p->behind;
    g->normal[g->vertices] = (vec){ 0, 0, 0 };
    g->color[g->vertices] = color;
    return (int32_t)g->vertices++;
}

/* What of a cell is above the level; false: no memory. */
static bool add_cell(const plane *p, geometry *g, int x, int y)
{
    static const int turn[4][2] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
    int32_t corner[8], edge[4];
    int corners = 0, inside = 0, edges = 0;
    for (int k = 0; k < 4; k++) inside += p->node[node_at(p, x + turn[k][0], y + turn[k][1])] >= p->r->level;
    if (inside == 0) return true;
    if (!view_reserve(g, 8, 6, 0)) return false;
    for (int k = 0; k < 4; k++) {
        const int *a = turn[k], *b = turn[(k + 1)%4];
        const int64_t i = node_at(p, x + a[0], y + a[1]), j = node_at(p, x + b[0], y + b[1]);
        const float from = p->node[i], to = p->node[j];
        if (from >= p->r->level) {
            if (p->vertex[i] < 0) p->vertex[i] = add_vertex(p, g, x + a[0], y + a[1], color_of(p, i));
            corner[corners++] = p->vertex[i];
        }
        if ((from >= p->r->level) == (to >= p->r->level)) continue;
        const float t = (p->r->level - from)/(to - from);
        corner[corners++] = edge[edges++] = add_vertex(p, g, x + a[0] + (double)t*(b[0] - a[0]),
                                                       y + a[1] + (double)t*(b[1] - a[1]),
                                                       color_of(p, from >= to ? i : j));
    }
    /* Of two lines in a cell each begins where the region is left. */
    const int first = p->node[node_at(p, x, y)] >= p->r->level ? 0 : 1;
    const double middle[3] = { p->low[0] + p->edge*(x + 0.5), p->low[1] + p->edge*(y + 0.5), 0 };
    if (beyond_nests(p, middle) > 0) edges = 0;      /* the other has the outline */
    for (int k = 0; k < edges; k += 2) {
        vec from = g->place[edge[(first + k)%edges]], to = g->place[edge[(first + k + 1)%edges]];
        from.z = to.z = p->behind;
        if (!view_add_segment(p->r->outline, from, to)) return false;
    }
    for (int k = 2; k < corners; k++) {
        int32_t *face = g->face[g->faces++];
        face[0] = corner[0], face[1] = corner[k - 1], face[2] = corner[k];
    }
    return true;
}

/* Half a cell from walls, beyond which there is nothing; false: no node is near. */
static bool find_place(const plane *p, const double x[3], double at[2])
{
    for (int k = 0; k < 2; k++)
        at[k] = fmin(fmax((x[k] - p->low[k])/p->edge, (double)p->wall[k][0] + 0.5),
                     (double)p->wall[k][1] - 0.5);
    return p->node && at[0] >= 0 && at[1] >= 0 && at[0] < p->size[0] - 1 && at[1] < p->size[1] - 1;
}

static float sum_between_nodes(const plane *p, const double at[2])
{
    float sum = 0;
    for (int k = 0; k < 4; k++) {
        const int m = (int)at[0] + (k & 1), n = (int)at[1] + (k >> 1);
        sum += (float)((1 - fabs(m - at[0]))*(1 - fabs(n - at[1])))*p->node[node_at(p, m, n)];
    }
    return sum;
}

/* Discs for particles outside of the region, or in a thread of it. */
static bool add_discs(const plane *p, geometry *g)
{
    const surface_request *r = p->r;
    const float least = 0.75f*r->level;
    if (!view_reserve(g, 0, 0, 2*r->count)) return false;
    for (int64_t i = 0; i < r->count; i++) {
        const double *x = r->f->positions[r->row[i]];
        double at[2];
        if (!view_is_shown(r->f, r->row[i]) || !(fabs(x[0]) + fabs(x[1]) < 1e9)) continue;
        if (find_place(p, x, at) && sum_between_nodes(p, at) > least) continue;
        vec place = view_point(&p->c->camera, x);
        const vec color = r->skin ? view_skin_color(r, r->row[i]) : r->color ? r->color[r->row[i]] : r->plain;
        for (int rim = 0; rim < 2; rim++) {
            place.z = (rim ? 1.1f : 1)*p->behind;
            g->balls[g->ball_count++] = (ball){ place, (rim ? 1.2f : 0.9f)*(float)r->radius,
                                                vec_scale(rim ? 0.5f : 1, color) };
        }
    }
    return true;
}

/* Of sums that are not limited yet. */
static bool find_counts(plane *p)
{
    const float per_particle = sum_per_particle(p);
    p->count = malloc(((size_t)p->r->count + 1)*sizeof *p->count);
    for (int64_t i = 0; p->count && i < p->r->count; i++) {
        double at[2];
        p->count[i] = 1;
        if (!find_place(p, p->r->f->positions[p->r->row[i]], at)) continue;
        float sum = per_particle*sum_between_nodes(p, at);
        for (int k = 0; k < 2; k++)
            sum /= share_inside(((float)at[k] - p->wall[k][0])/REACH)
                *share_inside((p->wall[k][1] - (float)at[k])/REACH);
        if (sum > in_solid && sum < 1) p->count[i] = 1/sqrtf(sum);
    }
    return p->count != NULL;
}

static bool make_region(plane *p, geometry *g)
{
    const size_t n = (size_t)p->size[0]*(size_t)p->size[1];
    p->node = calloc(n, sizeof *p->node);
    p->vertex = malloc(n*sizeof *p->vertex);
    if (p->r->color) p->color = calloc(n, sizeof *p->color);
    if (p->r->color) p->weight = calloc(n, sizeof *p->weight);
    bool enough = p->node && p->vertex && (!p->r->color || (p->color && p->weight));
    for (int64_t i = 0; enough && i < p->r->count; i++) add_particle(p, i);
    if (enough && p->r->evens) {
        enough = find_counts(p);
        if (enough) memset(p->node, 0, n*sizeof *p->node);
        if (enough && p->color) {
            memset(p->color, 0, n*sizeof *p->color);
            memset(p->weight, 0, n*sizeof *p->weight);
        }
        for (int64_t i = 0; enough && i < p->r->count; i++) add_particle(p, i);
    }
    enough = enough && add_others(p) && find_covers(p);
    if (enough) limit_nodes(p);
    for (size_t k = 0; enough && k < n; k++) p->vertex[k] = -1;
    for (int y = 0; enough && y + 1 < p->size[1]; y++)
        for (int x = 0; enough && x + 1 < p->size[0]; x++) enough = add_cell(p, g, x, y);
    return enough;
}

tobi_status view_add_region(geometry *g, const canvas *c, const surface_request *r, tobi_error *err)
{
    const tobi_picture *f = r->f;
    const int64_t vertex = g->vertices, face = g->faces;
    plane p = { .c = c, .r = r };
    p.behind = (r->cover ? 10 : 8)*(float)(f->box_max[0] - f->box_min[0] + f->box_max[1] - f->box_min[1]);
    p.under = 1.001f*p.behind;
    bool enough = !place_nodes(&p) || make_region(&p, g);
    if (enough && r->skin) enough = view_put_skin(c, r, g, vertex, face);
    for (int64_t i = vertex; i < g->vertices; i++)
        if (g->place[i].z != p.under) g->place[i].z = p.behind;
    if (enough) enough = add_discs(&p, g);
    free(p.node);
    free(p.others);
    free(p.count);
    free(p.covered);
    free(p.clear);
    free(p.near);
    free(p.color);
    free(p.weight);
    free(p.vertex);
    return enough ? TOBI_OK : tobi_fail(err, TOBI_NO_MEMORY, "no memory for a picture");
}
