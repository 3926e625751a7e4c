/* Force and power of porous zones in isph: what the liquid loses to them, by comparison with the same
   pressure without zones. Pairs share the drag of both particles there, so that eq. (5) of
   docs/theory/porous.md, the drag of each alone, would count too much at the face of a strong zone.
   Drawback: one more pass over the pairs, in runs with zones. */
#include "sph/isph/porous.h"
#include "sph/isph/carry.h"
#include "sph/isph/solve.h"
#include "sph/porous_carry.h"
#include "sph/state.h"
#include <string.h>

typedef enum stage { KEEP, BRAKED, FREE, DONE } stage;

typedef struct look { tobi_system *s; stage at; } look;

/* taken gathers what is lost: by the brake and, of the pressure, without zones less with them. */
static void gather_range(const void *view, int64_t begin, int64_t end)
{
    const look *l = view;
    const sph_fields *f = sph_fields_of(&l->s->particles);
    for (int64_t i = begin; i < end; i++) {
        float *u = &l->s->particles.velocity[i].x, *taken = &f->porous_taken[i].x;
        float *kept = &f->porous_kept[i].x;
        for (int a = 0; a < 3; a++) {
            if (l->at == KEEP) kept[a] = u[a];
            else if (l->at == BRAKED) taken[a] = kept[a] - u[a];
            else if (l->at == FREE) taken[a] += u[a], u[a] = kept[a];
            else taken[a] -= u[a];
        }
    }
}

static void gather(tobi_system *s, stage at)
{
    tobi_loop(s->sim->exec.threads, s->particles.count, 0, gather_range, &(look){ s, at });
}

void isph_porous_brake(tobi_system *s)
{
    if (s->sim->porous_count == 0) return;
    gather(s, KEEP);
    sph_porous_brake(s);
    gather(s, BRAKED);
    if (!sph_porous_carried(s)) return;
    memset(sph_of(s)->links.answer, 0, (size_t)s->sim->body_count*sizeof *sph_of(s)->links.answer);
    sph_porous_join(s);              /* with the velocities that bodies have until they are predicted */
}

void isph_porous_compare(isph_solver *m, tobi_system *s)
{
    if (s->sim->porous_count == 0) return;
    const tobi_float4 *porous = m->view.porous;
    double unused[TOBI_TOTALS];
    gather(s, KEEP);
    m->view.porous = NULL;
    tobi_launch(m->exec, m->kernel->isph_projection, &m->view, 0, m->view.count, unused);
    m->view.porous = porous;
    gather(s, FREE);
}

typedef struct share { const tobi_system *s; int zone; } share;

/* totals: force, power, volume. */
static void measure_range(const void *view, int64_t begin, int64_t end, double *totals)
{
    const share *l = view;
    const tobi_system *s = l->s;
    const sph_fields *f = sph_fields_of(&s->particles);
    for (int64_t i = begin; i < end; i++) {
        const float *before = &f->porous_before[i].x, *taken = &f->porous_taken[i].x,
                    *u = &s->particles.velocity[i].x;
        const int any = taken[0] != 0 || taken[1] != 0 || taken[2] != 0, own = (int)before[3];
        if (own < 0 || (own == 0 && !any) || sph_porous_nearest(s, i) != l->zone) continue;
        const double mass = s->smoothing.volume*s->fluid[s->particles.fluid[i]].density;
        for (int a = 0; a < s->box.dimension; a++) {
            const double force = mass*taken[a]/s->dt;
            totals[a] += force;
            totals[3] += 0.5*force*((double)before[a] + u[a]);
        }
        if (own > 0) totals[4] += s->smoothing.volume;
    }
}

void isph_porous_measure(const isph_solver *m, tobi_system *s)
{
    if (s->sim->porous_count > 0) gather(s, DONE);
    isph_carry_settle(m, s);
    for (int k = 0; k < s->sim->porous_count; k++) {
        tobi_porous *z = &s->sim->porous[k];
        const share l = { s, k };
        double t[TOBI_TOTALS];
        tobi_launch(&s->sim->exec, TOBI_HOST(measure_range, 5, 0), &l, 0, s->particles.count, t);
        for (int a = 0; a < 3; a++) z->force[a] = t[a];
        z->power = t[3];
        z->volume = t[4];
    }
    sph_porous_load(s);
}
