/* Particles near the surface and outside of it: those that touch the water, or each other, count more, so
   that the surface is around them; those of solids, so that its volume is right; those that are alone become
   balls. Drawback: where a body keeps water away, the sum is too small, as at a free surface. */
#include "view/isosurface.h"
#include <stdlib.h>

static float node_at(const grid *s, int x, int y, int z)
{
    const int64_t b = *block_at(s, x/BLOCK_EDGE, y/BLOCK_EDGE, z/BLOCK_EDGE);
    return s->node[b*BLOCK_NODES + (z%BLOCK_EDGE*BLOCK_EDGE + y%BLOCK_EDGE)*BLOCK_EDGE + x%BLOCK_EDGE];
}

/* The sum at a particle, from the eight nodes around it. */
float view_sum_at(const grid *s, const float place[3])
{
    float sum = 0, t[3];
    int low[3];
    for (int k = 0; k < 3; k++) low[k] = (int)place[k], t[k] = place[k] - (float)low[k];
    for (int n = 0; n < 8; n++) {
        const float share = (n & 1 ? t[0] : 1 - t[0])*(n & 2 ? t[1] : 1 - t[1])*(n & 4 ? t[2] : 1 - t[2]);
        sum += share*node_at(s, low[0] + (n & 1), low[1] + (n >> 1 & 1), low[2] + (n >> 2));
    }
    return sum;
}

/* Sums at particles: of one that is alone 0.10 to 0.20, 0.15 on average; of one in the uppermost layer of
   water at rest 0.65. */
static const float touching = 0.22f, within = 0.5f, extra_per_sum = 10;

/* Of solids. At particles of a lattice the sum is 0.28 in a row, 0.38 in the side of a single layer. */
static const float in_solid = 0.33f, deep = 0.97f;

/* Before sums are limited: of a place that is half a cell within the walls at least. */
static float sum_between_walls(const grid *s, const float place[3])
{
    float sum = s->per_particle*view_sum_at(s, place);
    for (int k = 0; k < 3; k++)
        sum /= share_inside((place[k] - s->wall[k][0])/s->reach)
            *share_inside((s->wall[k][1] - place[k])/s->reach);
    return sum;
}

/* By how much more a particle counts; -1: it is well within. */
static float find_extra(const surface_request *r, float sum)
{
    if (r->evens) return sum > (r->joins ? touching : in_solid) && sum < 1 ? 1/sqrtf(sum*sqrtf(sum)) - 1 : 0;
    return sum > within ? -1 : sum > touching ? extra_per_sum*(within - sum) : 0;
}

bool view_weigh_particles(grid *s, const surface_request *r)
{
    const float enough = r->evens ? deep : 0.8f;

    reached b = { .count = 0 };
    s->extra = malloc(((size_t)r->count + 1)*sizeof *s->extra);
    s->touched = calloc((size_t)s->blocks + 1, 1);
    for (int64_t i = 0; s->extra && s->touched && i < r->count; i++) {
        const float *p = s->place[i];
        float place[3];
        s->extra[i] = 0;
        if (p[0] < 0) continue;
        for (int k = 0; k < 3; k++) place[k] = clampf(p[k], s->wall[k][0] + 0.5f, s->wall[k][1] - 0.5f);
        const float near = node_at(s, (int)(place[0] + 0.5f), (int)(place[1] + 0.5f), (int)(place[2] + 0.5f));
        s->extra[i] = find_extra(r, near*s->per_particle > enough ? 1 : sum_between_walls(s, place));
        if (!(s->extra[i] > 0)) continue;
        view_find_blocks(s, p, s->reach, &b);
        for (int k = 0; k < b.count; k++) s->touched[s->at[b.at[k]]] = 1;
    }
    return s->extra && s->touched;
}

/* Particles outside of the surface: the smaller the less alone they are. */
bool view_add_drops(const grid *s, const surface_request *r, geometry *g)
{
    if (!view_reserve(g, 0, 0, r->count)) return false;
    for (int64_t i = 0; i < r->count; i++) {
        const double *p = r->f->positions[r->row[i]];
        if (s->extra && s->extra[i] < 0) continue;
        if (!(fabs(p[0]) + fabs(p[1]) + fabs(p[2]) < 1e15*r->drop)) continue;
        if (!view_is_shown(r->f, r->row[i])) continue;
        float place[3] = { 0, 0, 0 };
        const bool inside = s->place && s->place[i][0] >= 0;
        for (int k = 0; k < 3 && inside; k++)      /* half a cell from walls, beyond which there is nothing */
            place[k] = clampf(s->place[i][k], s->wall[k][0] + 0.5f, s->wall[k][1] - 0.5f);
        if (inside && node_at(s, (int)(place[0] + 0.5f), (int)(place[1] + 0.5f),
                              (int)(place[2] + 0.5f)) > 0.8f)
            continue;
        const float sum = inside ? view_sum_at(s, place) : 0;
        if (sum > 0.8f*r->level) continue;
        g->balls[g->ball_count++] = (ball){ view_point(&s->c->camera, p),
                                            r->drop*clampf(1.5f - 1.25f*sum/r->level, 0.5f, 1),
                                            !r->color ? r->plain
                                            : r->skin ? view_skin_color(r, r->row[i])
                                            : r->scale ? view_scaled(r->scale, r->color[r->row[i]].x)
                                            : r->color[r->row[i]] };
    }
    return true;
}

