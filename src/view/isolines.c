/* Isolines of a picture in 2-D, of each group of particles: values on the nodes of a grid, a mean by the
   kernel, then lines in the two triangles of each cell. So values of a liquid and of a solid beside it do not
   mix. Drawback: lines end half a cell before the water does. */
#include "view/draw.h"
#include <stdlib.h>

enum { MOST_NODES = 1 << 24 };

typedef struct plane {
    double low[2], edge;         /* m, the first node; m between nodes                 */
    int    size[2];              /* nodes                                              */
    float *sum, *weight;         /* of each node                                       */
} plane;

static int64_t node_at(const plane *p, int x, int y) { return (int64_t)y*p->size[0] + x; }

/* Adds the value of a particle to the nodes within two cells of it. */
static void add_value(const plane *p, const double position[3], float value)
{
    double at[2];
    int low[2], high[2];
    for (int k = 0; k < 2; k++) {
        at[k] = (position[k] - p->low[k])/p->edge;
        if (!(at[k] >= 0 && at[k] <= p->size[k] - 1)) return;
        low[k] = at[k] > 2 ? (int)(at[k] - 1) : 0;
        high[k] = at[k] < p->size[k] - 3 ? (int)(at[k] + 2) : p->size[k] - 1;
    }
    for (int y = low[1]; y <= high[1]; y++)
        for (int x = low[0]; x <= high[0]; x++) {
            const double dx = x - at[0], dy = y - at[1];
            const float t = (float)(1 - 0.25*(dx*dx + dy*dy));
            if (!(t > 0)) continue;
            p->sum[node_at(p, x, y)] += t*t*t*value;
            p->weight[node_at(p, x, y)] += t*t*t;
        }
}

bool view_add_segment(segments *s, vec from, vec to)
{
    if (s->count == s->room) {
        const int64_t room = 2*s->room + 1024;
        vec (*longer)[2] = realloc(s->end, (size_t)room*sizeof *longer);
        if (!longer) return false;
        s->end = longer, s->room = room;
    }
    s->end[s->count][0] = from, s->end[s->count++][1] = to;
    return true;
}

/* The part of a level in a triangle of nodes; false: no memory. */
static bool add_segment(const canvas *c, const plane *p, const int (*node)[2], float level, segments *out)
{
    vec end[3], place[3];
    float value[3];
    int ends = 0;
    for (int k = 0; k < 3; k++) {
        const int64_t n = node_at(p, node[k][0], node[k][1]);
        const double at[3] = { p->low[0] + p->edge*node[k][0], p->low[1] + p->edge*node[k][1], 0 };
        value[k] = p->sum[n]/p->weight[n];
        place[k] = view_point(&c->camera, at);
    }
    for (int k = 0; k < 3; k++) {
        const float a = value[k], b = value[(k + 1)%3];
        if ((a < level) != (b < level))
            end[ends++] = vec_mix(place[k], place[(k + 1)%3], (level - a)/(b - a));
    }
    return ends != 2 || view_add_segment(out, end[0], end[1]);
}

/* Of one cell whose four corners are in the water. */
static bool add_cell(const canvas *c, const plane *p, int x, int y, int levels, segments *out)
{
    static const int corner[2][3][2] = { { { 0, 0 }, { 1, 0 }, { 1, 1 } }, { { 0, 0 }, { 1, 1 }, { 0, 1 } } };
    static const float least = 0.5f;      /* weight; about 3 within the water */
    for (int k = 0; k < 4; k++)
        if (p->weight[node_at(p, x + (k & 1), y + k/2)] < least) return true;
    for (int n = 1; n <= levels; n++)
        for (int t = 0; t < 2; t++) {
            int node[3][2];
            for (int k = 0; k < 3; k++) node[k][0] = x + corner[t][k][0], node[k][1] = y + corner[t][k][1];
            if (!add_segment(c, p, (const int (*)[2])node, (float)n/(float)(levels + 1), out)) return false;
        }
    return true;
}

/* Nodes around a group, cells as from the domain's corner; false: no particle is in the domain. */
static bool place_nodes(plane *p, const surface_request *r)
{
    const tobi_picture *f = r->f;
    double nodes = 1;
    p->edge = 2*r->radius;
    for (int k = 0; k < 2; k++) nodes *= (f->box_max[k] - f->box_min[k])/p->edge + 2;
    if (nodes > MOST_NODES) p->edge *= sqrt(nodes/MOST_NODES);
    for (int k = 0; k < 2; k++) {
        const int most = (int)((f->box_max[k] - f->box_min[k])/p->edge) + 1;
        double low = INFINITY, high = -INFINITY;
        for (int64_t i = 0; i < r->count; i++) {
            const double at = (f->positions[r->row[i]][k] - f->box_min[k])/p->edge;
            if (at >= 0 && at <= most) low = fmin(low, at), high = fmax(high, at);
        }
        if (!(low <= high)) return false;
        const int first = low > 2 ? (int)low - 2 : 0, last = high + 3 < most ? (int)high + 3 : most;
        p->low[k] = f->box_min[k] + first*p->edge;
        p->size[k] = last - first + 1;
    }
    return true;
}

bool view_find_isolines(const canvas *c, const surface_request *r, double low, double high, segments *out)
{
    const tobi_picture *f = r->f;
    plane p = { .sum = NULL };
    if (!place_nodes(&p, r)) return true;
    const size_t n = (size_t)p.size[0]*(size_t)p.size[1];
    p.sum = calloc(n, sizeof *p.sum);
    p.weight = calloc(n, sizeof *p.weight);
    bool enough = p.sum && p.weight;
    for (int64_t k = 0; enough && k < r->count; k++) {
        const int32_t i = r->row[k];
        if (view_is_shown(f, i) && isfinite(f->values[i]))
            add_value(&p, f->positions[i], (float)((f->values[i] - low)/(high - low)));
    }
    for (int y = 0; enough && y + 1 < p.size[1]; y++)
        for (int x = 0; enough && x + 1 < p.size[0]; x++) enough = add_cell(c, &p, x, y, f->isolines, out);
    free(p.sum);
    free(p.weight);
    return enough;
}
