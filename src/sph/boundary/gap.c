/* A body that lies on the floor keeps particles out of a gap around the contact that is a spacing high: of a
   sphere 8 spacings across a third of the section. Water would fill it, at the pressure of still water (18).
   So points there are pressed by all the water above them: by as much of it as particles do not cover, and
   only what moves is missing. A body that no particle sees lies in the dry, though still water may stand
   higher elsewhere. Drawback: a flat body that lies close has its full buoyancy too, as if it stood on
   grains. */
#include "sph/boundary/boundary.h"
#include "sph/state.h"

static int faces_side(const tobi_system *s, const double x[3], const double n[3])
{
    for (int a = 0; a < s->box.dimension; a++) {
        if (s->box.periodic[a]) continue;
        if (n[a] < -0.5 && x[a] < s->smoothing.h) return 1;
        if (n[a] > 0.5 && s->box.size[a] - x[a] < s->smoothing.h) return 1;
    }
    return 0;
}

static int faces_body(const tobi_system *s, int body, const double x[3], const double n[3])
{
    tobi_tree_walk walk = {0, 0};
    for (int k; (k = tobi_body_tree_next(&sph_of(s)->links.tree, x, &walk)) >= 0;) {
        tobi_bvh_hit hit;
        if (k == body || !tobi_bvh_closest(s->sim->bodies[k].bvh, x, s->smoothing.h, &hit)) continue;
        if (n[0]*hit.normal[0] + n[1]*hit.normal[1] + n[2]*hit.normal[2] < -0.5) return 1;
    }
    return 0;
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
        if (b->covered[q] >= TOBI_COVERED || b->wet[q] == TOBI_BURIED || b->is_absent) continue;
        if (!(tobi_reference_pressure(&state->reference, x) > 0)) continue;
        if (faces_side(s, x, n) || faces_body(s, k, x, n)) b->wet[q] = TOBI_WET_GAP;
    }
}

void tobi_boundary_fill_gaps(tobi_system *s)
{
    sph_state *state = sph_of(s);
    tobi_boundary_links *n = &state->links;
    const int bodies = s->sim->body_count;
    if (!(state->reference.push > 0)) return;
    tobi_body_tree_build(&n->tree, s->sim->bodies, bodies, s->smoothing.h, s->box.dimension);
    tobi_launch(&s->sim->exec, TOBI_HOST(wet_range, 0, 0), s, 0, n->bins[bodies].item, NULL);
}
