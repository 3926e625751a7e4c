/* Sides of the domain that particles of solids touch themselves, as they touch bodies. Nodes that obey a side
   stop what is a cell away from it: beside a liquid that is a layer of liquid which nothing holds there
   (decision 113). Drawback: one side is either touched or obeyed by nodes, for all solids. */
#include "mpm/contact/sides.h"
#include "exec/exec.h"
#include "mpm/particle_fields.h"
#include <math.h>
#include <string.h>

/* Friction of a side that holds what it touches. */
static const double HOLDS = 1e3;

static int kind_of(const tobi_system *s, int side)
{
    return side%2 ? s->sim->def.wall_max[side/2] : s->sim->def.wall_min[side/2];
}

/* totals[2 axis + side]: particles that started nearer than a spacing to that side. */
static void find_started(const void *view, int64_t begin, int64_t end, double *totals)
{
    const tobi_system *s = view;
    const mpm_fields *f = mpm_fields_of(&s->particles);
    for (int64_t i = begin; i < end; i++)
        for (int a = 0; a < s->box.dimension; a++) {
            const double x = (&f->rest[i].x)[a];
            totals[2*a] += x < s->smoothing.spacing;
            totals[2*a + 1] += s->box.size[a] - x < s->smoothing.spacing;
        }
}

int mpm_sides_find(const tobi_system *s)
{
    double started[TOBI_TOTALS];
    int touched = 0;
    if (s->sim->soft.solids != s) return 0;
    tobi_launch(&s->sim->exec, TOBI_HOST(find_started, 6, 0), s, 0, s->particles.count, started);
    for (int k = 0; k < 2*s->box.dimension; k++) {
        const int kind = kind_of(s, k);
        touched |= (kind != TOBI_WALL_OPEN && kind != TOBI_WALL_PERIODIC && started[k] == 0) << k;
    }
    return touched;
}

/* A side is a body that stands still, or moves along itself. */
static void describe(const tobi_system *s, int side, tobi_body *b, double velocity[3])
{
    const tobi_world_def *def = &s->sim->def;
    const int kind = kind_of(s, side), a = side/2;
    *b = (tobi_body){ .rigid.kind = TOBI_PRESCRIBED, .rigid.mass = 1 };
    b->rigid.friction = kind == TOBI_WALL_SEPARATE ? def->friction : kind == TOBI_WALL_NO_SLIP ? HOLDS : 0;
    memcpy(velocity, side%2 ? def->wall_velocity_max[a] : def->wall_velocity_min[a], 3*sizeof *velocity);
}

tobi_status mpm_sides_list(tobi_contacts *c, const tobi_system *s, int side, const tobi_contact_step *step,
                           tobi_body *b, tobi_error *err)
{
    const tobi_particles *p = &s->particles;
    const int a = side/2, upper = side%2;
    const double far = step->radius + step->margin, size = s->box.size[a];
    describe(s, side, b, c->velocity);
    memset(c->spin, 0, sizeof c->spin);
    c->count = 0;
    for (int64_t chunk = 0; chunk*TOBI_BLOCK < p->count; chunk++) {
        const double *box = c->chunk_box[chunk];
        if ((upper ? size - box[3 + a] : box[a]) - c->drift > far) continue;
        TOBI_TRY(tobi_contact_reserve(c, c->count + TOBI_BLOCK, err));
        for (int64_t i = chunk*TOBI_BLOCK; i < (chunk + 1)*TOBI_BLOCK && i < p->count; i++) {
            const double *x = &p->position[i].x, height = upper ? size - x[a] : x[a];
            if (height > far) continue;
            tobi_contact *k = &c->list[c->count++];
            *k = (tobi_contact){ .particle = (int32_t)i, .depth = step->radius,
                                 .gap = height - step->radius };
            k->normal[a] = upper ? -1 : 1;
            k->change[a] = k->normal[a]*fmax(0, -p->velocity[i].w)*step->dt;
            memcpy(k->arm, x, sizeof k->arm);
            k->arm[a] -= k->depth*k->normal[a];
        }
    }
    return TOBI_OK;
}
