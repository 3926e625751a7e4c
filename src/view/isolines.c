/* Isolines of a picture in 2-D, of each group of particles: values on the nodes of a grid, a mean by the
   kernel, then lines in the two triangles of each cell, as far as particles fill half of the kernel. So
   values of a liquid and of a solid beside it do not mix. Drawback: a drop of few particles has no lines. */
#include "view/draw.h"
#include "view/isosurface.h"
#include <stdlib.h>

enum { MOST_NODES = 1 << 24 };

typedef struct plane {
    double low[2], edge;         /* m, the first node; m between nodes                 */
    int    size[2];              /* nodes                                              */
    float *sum, *weight;         /* of each node                                       */
    float *inside;               /* of nodes: 1 within the group, 0.5 where it ends    */
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

/* The share of the kernel in the domain that particles fill; where the domain ends, at most 0.5. */
static void find_inside(plane *p, const surface_request *r)
{
    const double cells = p->edge/(2*r->radius), full = acos(-1.0)*cells*cells;
    for (int y = 0; y < p->size[1]; y++)
        for (int x = 0; x < p->size[0]; x++) {
            const int node[2] = { x, y };
            float room = 1, most = INFINITY;
            for (int k = 0; k < 2; k++) {
                const double at = p->low[k] + p->edge*node[k];
                const float low = (float)((at - r->f->box_min[k])/p->edge);
                const float high = (float)((r->f->box_max[k] - at)/p->edge);
                room *= share_inside(low/2)*share_inside(high/2);
                most = fminf(most, 0.5f + fminf(low, high));
            }
            const int64_t n = node_at(p, x, y);
            p->inside[n] = fminf(p->weight[n]/((float)full*fmaxf(room, 0.02f)), most);
        }
}

/* What of a line lies within the group; false: no memory. */
static bool add_inside(segments *out, const vec end[3], const float inside[3])
{
    const float from = inside[0] - 0.5f, to = inside[1] - 0.5f;
    if (from < 0 && to < 0) return true;
    const vec edge = from < 0 || to < 0 ? vec_mix(end[0], end[1], from/(from - to)) : end[0];
    return view_add_segment(out, from < 0 ? edge : end[0], to < 0 ? edge : end[1]);
}

/* The part of a level in a triangle of nodes; false: no memory. */
static bool add_segment(const canvas *c, const plane *p, const int (*node)[2], float level, segments *out)
{
    vec end[3], place[3];
    float value[3], inside[3], in[3];
    int ends = 0;
    for (int k = 0; k < 3; k++) {
        const int64_t n = node_at(p, node[k][0], node[k][1]);
        const double at[3] = { p->low[0] + p->edge*node[k][0], p->low[1] + p->edge*node[k][1], 0 };
        if (!(p->weight[n] > 0)) return true;
        value[k] = p->sum[n]/p->weight[n];
        in[k] = p->inside[n];
        place[k] = view_point(&c->camera, at);
    }
    for (int k = 0; k < 3; k++) {
        const float a = value[k], b = value[(k + 1)%3], t = (level - a)/(b - a);
        if ((a < level) == (b < level)) continue;
        inside[ends] = in[k] + t*(in[(k + 1)%3] - in[k]);
        end[ends++] = vec_mix(place[k], place[(k + 1)%3], t);
    }
    return ends != 2 || add_inside(out, end, inside);
}

/* Of one cell; false: no memory. */
static bool add_cell(const canvas *c, const plane *p, int x, int y, int levels, segments *out)
{
    static const int corner[2][3][2] = { { { 0, 0 }, { 1, 0 }, { 1, 1 } }, { { 0, 0 }, { 1, 1 }, { 0, 1 } } };
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
    p.inside = calloc(n, sizeof *p.inside);
    bool enough = p.sum && p.weight && p.inside;
    for (int64_t k = 0; enough && k < r->count; k++) {
        const int32_t i = r->row[k];
        if (view_is_shown(f, i) && isfinite(f->values[i]))
            add_value(&p, f->positions[i], (float)((f->values[i] - low)/(high - low)));
    }
    if (enough) find_inside(&p, r);
    for (int y = 0; enough && y + 1 < p.size[1]; y++)
        for (int x = 0; enough && x + 1 < p.size[0]; x++) enough = add_cell(c, &p, x, y, f->isolines, out);
    free(p.sum);
    free(p.weight);
    free(p.inside);
    return enough;
}
