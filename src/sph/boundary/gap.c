/* A body that lies on the floor keeps particles out of a gap around the contact that is a spacing high: of a
   sphere 8 spacings across a third of the section. Water would fill it, at the pressure of still water (18).
   So points there are pressed by all the water above them: by as much of it as particles do not cover, and
   only what moves is missing. A body that no particle sees lies in the dry, though still water may stand
   higher elsewhere. So does a vessel on a side that only liquid within its box or above it sees. Drawback: a
   flat body that lies close has its full buoyancy too, as if it stood on grains. */
#include "sph/boundary/boundary.h"
#include "geom/vec3.h"
#include "sph/state.h"

static int sides_near(const tobi_system *s, const double x[3], const double *n, double reach)
{
    int near = 0;
    for (int a = 0; a < s->box.dimension; a++) {
        if (s->box.periodic[a]) continue;
        if ((!n || n[a] < -0.5) && x[a] < reach) near |= 1 << 2*a;
        if ((!n || n[a] > 0.5) && s->box.size[a] - x[a] < reach) near |= 2 << 2*a;
    }
    return near;
}

static int body_near(const tobi_system *s, int body, const double x[3], const double *n, double reach)
{
    tobi_tree_walk walk = {0, 0};
    for (int k; (k = tobi_body_tree_next(&sph_of(s)->links.tree, x, &walk)) >= 0;) {
        tobi_bvh_hit hit;
        if (k == body || !tobi_bvh_closest(s->sim->bodies[k].bvh, x, reach, &hit)) continue;
        if (!n || n[0]*hit.normal[0] + n[1]*hit.normal[1] + n[2]*hit.normal[2] < -0.5) return TOBI_NEAR_BODY;
    }
    return 0;
}

int tobi_boundary_near(const tobi_system *s, int body, const double x[3], const double *n, double reach)
{
    return sides_near(s, x, n, reach) | body_near(s, body, x, n, reach);
}

int tobi_boundary_covers(const tobi_system *s, const double x[3], const double n[3])
{
    const double reach = s->smoothing.spacing;
    tobi_tree_walk walk = {0, 0};
    for (int k; (k = tobi_body_tree_next(&sph_of(s)->links.tree, x, &walk)) >= 0;) {
        tobi_bvh_hit hit;
        double aside[3];
        if (!tobi_bvh_closest(s->sim->bodies[k].bvh, x, reach, &hit)) continue;
        for (int a = 0; a < 3; a++) aside[a] = x[a] - hit.point[a];
        const double away = vec3_dot(aside, hit.normal);
        for (int a = 0; a < 3; a++) aside[a] -= away*hit.normal[a];
        if (vec3_dot(n, hit.normal) < -0.5 && vec3_dot(aside, aside) < 1e-6*reach*reach) return 1;
    }
    return 0;
}

void tobi_boundary_find_neighbors(tobi_system *s)
{
    tobi_body_tree_build(&sph_of(s)->links.tree, s->sim->bodies, s->sim->body_count, s->smoothing.h,
                         s->box.dimension);
}

typedef struct beside { const tobi_system *s; double low[3], high[3], along; } beside;

/* totals[0]: particles that see a body from beside or below its box. */
static void count_beside(const void *view, int64_t begin, int64_t end, double *totals)
{
    const beside *v = view;
    const tobi_boundary_links *n = &sph_of(v->s)->links;
    const double *g = v->s->sim->def.gravity;
    for (int64_t q = begin; q < end; q++) {
        const double *x = &v->s->particles.position[n->link[q].particle].x;
        int out = 0;
        for (int a = 0; a < v->s->box.dimension; a++)
            out |= (x[a] < v->low[a] && g[a] <= v->along) || (x[a] > v->high[a] && g[a] >= -v->along);
        totals[0] += out;
    }
}

/* Whether no particle that sees a vessel is beside or below its box. */
static int is_dry_outside(const tobi_system *s, int k)
{
    const int64_t *first = sph_of(s)->links.first;
    const tobi_body *b = &s->sim->bodies[k];
    double t[TOBI_TOTALS];
    beside v = { s, .along = 0.5*vec3_length(s->sim->def.gravity) };
    if (!b->vessel) return 0;
    tobi_bvh_box(b->bvh, v.low, v.high);
    tobi_launch(&s->sim->exec, TOBI_HOST(count_beside, 1, 0), &v, first[k], first[k + 1], t);
    return t[0] == 0;
}

/* The body that the q-th of all points belongs to. */
static int body_of(const tobi_system *s, int64_t q)
{
    const tobi_boundary_bins *bins = sph_of(s)->links.bins;
    int low = 0, high = s->sim->body_count;
    while (high - low > 1) {
        const int middle = (low + high)/2;
        if (bins[middle].item <= q) low = middle;
        else high = middle;
    }
    return low;
}

static void wet_range(const void *view, int64_t begin, int64_t end, double *totals)
{
    const tobi_system *s = view;
    const sph_state *state = sph_of(s);
    const tobi_boundary_bins *bins = state->links.bins;
    int k = body_of(s, begin);
    (void)totals;
    for (int64_t all = begin; all < end; all++) {
        while (all >= bins[k + 1].item) k++;
        const tobi_body *b = &s->sim->bodies[k];
        const int64_t q = all - bins[k].item;
        const double *x = b->point[q], *n = b->normal[q];
        if (state->links.first[k] == state->links.first[k + 1]) continue;
        if (b->covered[q] >= TOBI_COVERED || b->wet[q] == TOBI_BURIED || b->is_absent || b->sealed)
            continue;
        if (!(tobi_reference_pressure(&state->reference, x) > 0)) continue;
        const int near = tobi_boundary_near(s, k, x, n, s->smoothing.h);
        if (near & (b->dry_outside ? TOBI_NEAR_BODY : ~0)) b->wet[q] = TOBI_WET_GAP;
    }
}

void tobi_boundary_fill_gaps(tobi_system *s)
{
    sph_state *state = sph_of(s);
    tobi_boundary_links *n = &state->links;
    const int bodies = s->sim->body_count;
    for (int k = 0; k < bodies; k++) s->sim->bodies[k].dry_outside = is_dry_outside(s, k);
    if (!(state->reference.push > 0)) return;
    tobi_boundary_find_neighbors(s);
    tobi_launch(&s->sim->exec, TOBI_HOST(wet_range, 0, 0), s, 0, n->bins[bodies].item, NULL);
}
