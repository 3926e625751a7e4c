/* A body that lies on the floor keeps particles out of a gap around the contact that is a spacing high: of a
   sphere 8 spacings across a third of the section. Water would fill it, at the pressure of still water (18).
   So points there are pressed by all the water above them, and only what moves is missing. Drawback: a flat
   body that lies close has its full buoyancy too, as if it stood on grains. */
#include "sph/state.h"
#include "sph/gap.h"
#include "core/system.h"

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
    for (int k = 0; k < s->sim->body_count; k++) {
        tobi_bvh_hit hit;
        if (k == body || !tobi_bvh_closest(s->sim->bodies[k].bvh, x, s->smoothing.h, &hit)) continue;
        if (n[0]*hit.normal[0] + n[1]*hit.normal[1] + n[2]*hit.normal[2] < -0.5) return 1;
    }
    return 0;
}

typedef struct wetting { const tobi_system *s; int body; } wetting;

static void wet_points(const void *view, int64_t begin, int64_t end)
{
    const wetting *w = view;
    const tobi_system *s = w->s;
    const tobi_body *b = &s->sim->bodies[w->body];
    for (int64_t q = begin; q < end; q++) {
        const double *x = b->point[q], *n = b->normal[q];
        if (b->wet[q] || !(tobi_still_pressure(&sph_of(s)->still, x) > 0)) continue;
        if (faces_side(s, x, n) || faces_body(s, w->body, x, n)) b->wet[q] = TOBI_WET_GAP;
    }
}

void tobi_gap_wet(tobi_system *s)
{
    if (!(sph_of(s)->still.push > 0)) return;
    for (int k = 0; k < s->sim->body_count; k++) {
        const wetting view = {s, k};
        tobi_loop(s->sim->exec.threads, s->sim->bodies[k].point_count, 256, wet_points, &view);
    }
}
