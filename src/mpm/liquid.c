/* Solids beside a liquid: every particle is a point that the liquid presses, and the impulse goes to that
   particle, so that nothing is lost on the way. A point answers with the mass of its particle alone, which is
   less than what moves with it, as the exchange needs (decision 64). Drawback: sheets of one or two particles
   let the liquid on both sides see each other. */
#include "mpm/liquid.h"
#include "base/error.h"
#include "mpm/contact/sides.h"
#include "mpm/fields.h"
#include "mpm/particle_fields.h"
#include <math.h>

/* Of the volume at the start: what points are taken for at least and at most. */
static const double LEAST = 0.25, MOST = 2;

static void find_sizes(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const mlsmpm *m = s->state;
    const mpm_view v = mpm_output_view(m);
    const mpm_fields *f = mpm_fields_of(&s->particles);
    for (int64_t i = begin; i < end; i++) {
        const int fixed = m->material[s->particles.fluid[i]].model == TOBI_STATIONARY;
        const double ratio = fmin(fmax(mpm_volume_ratio(&v, i), LEAST), MOST);
        m->size[i] = (tobi_soft_size){ mpm_clamp_hides(s, i) ? 0 : (float)(f->strain[i].c[0].w*ratio),
                                       fixed ? 0 : 1/f->strain[i].c[2].w,
                                       s->solids[s->particles.fluid[i]].def.liquid_friction == TOBI_NO_SLIP };
    }
}

tobi_status mpm_liquid_points(tobi_system *s, tobi_error *err)
{
    mlsmpm *m = s->state;
    tobi_soft *soft = &s->sim->soft;
    const int64_t n = s->particles.count;
    if (n > m->size_room) {
        tobi_soft_size *more = tobi_array_grow(m->size, 0, s->particles.capacity, sizeof *more);
        if (!more) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld points", (long long)n);
        m->size = more;
        m->size_room = s->particles.capacity;
    }
    tobi_loop(s->sim->exec.threads, n, 0, find_sizes, s);
    soft->count = n;
    soft->position = s->particles.position;
    soft->velocity = s->particles.velocity;
    soft->size = m->size;
    mpm_sides_find(s, &m->view, m->touched);
    soft->solid = s->particles.fluid;
    soft->push = mpm_fields_of(&s->particles)->push;
    return TOBI_OK;
}

static int is_pushed(const tobi_system *s, int64_t i)
{
    const tobi_float4 *push = &mpm_fields_of(&s->particles)->push[i];
    const mlsmpm *m = s->state;
    return (push->x != 0 || push->y != 0 || push->z != 0) &&
           m->material[s->particles.fluid[i]].model != TOBI_STATIONARY;
}

static void kick(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const mpm_fields *f = mpm_fields_of(&s->particles);
    for (int64_t i = begin; i < end; i++) {
        const float *push = &f->push[i].x;
        float *u = &s->particles.velocity[i].x;
        for (int a = 0; a < 3 && is_pushed(s, i); a++)
            u[a] = (float)((double)u[a] + s->dt*push[a]/f->strain[i].c[2].w);
    }
}

void mpm_liquid_kick(tobi_system *s)
{
    if (s->sim->soft.solids != s) return;
    tobi_loop(s->sim->exec.threads, s->particles.count, 0, kick, s);
}

/* totals: force times place, J. */
static void sum_reach(const void *view, int64_t begin, int64_t end, double *totals)
{
    const tobi_system *s = view;
    const mpm_fields *f = mpm_fields_of(&s->particles);
    for (int64_t i = begin; i < end; i++) {
        const double *x = &s->particles.position[i].x;
        const float *push = &f->push[i].x;
        for (int a = 0; a < 3 && is_pushed(s, i); a++) totals[0] += push[a]*x[a];
    }
}

double mpm_liquid_reach(const tobi_system *s)
{
    double t[TOBI_TOTALS];
    if (s->sim->soft.solids != s) return 0;
    tobi_launch(&s->sim->exec, TOBI_HOST(sum_reach, 1, 0), s, 0, s->particles.count, t);
    return t[0];
}
