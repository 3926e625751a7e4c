/* Sums over what the particles see of each body, for all bodies in one launch: a launch per body costs more
   than small bodies have to add. A block of entries holds those of a few bodies, each of which makes a part.
   Part g + b of body g and block b is nobody else's, because both ascend with the entries. */
#include "sph/boundary/boundary.h"
#include "sph/state.h"
#include "geom/vec3.h"
#include <assert.h>

typedef struct summing { tobi_boundary_links *n; tobi_kernel kernel; const void *view; int own; } summing;

static int64_t least(int64_t a, int64_t b) { return a < b ? a : b; }
static int64_t most(int64_t a, int64_t b) { return a > b ? a : b; }

static void sum_block(const void *view, int64_t begin, int64_t end, double *totals)
{
    const summing *q = view;
    const tobi_boundary_links *n = q->n;
    const int64_t block = begin/TOBI_BLOCK;
    (void)totals;
    for (int g = n->link[begin].body; g <= n->link[end - 1].body; g++) {
        const int64_t first = n->first[g], stop = n->first[g + 1], before = first/TOBI_BLOCK;
        const int64_t from = q->own ? first + (block - before)*TOBI_BLOCK : most(first, begin);
        const int64_t to = least(stop, q->own ? from + TOBI_BLOCK : end);
        tobi_block_sum *part = &n->part[block + g];
        if (from >= to) continue;
        *part = (tobi_block_sum){.block = q->own ? block - before : block};
        q->kernel.run(q->view, from, to, part->total);
        assert(tobi_kernel_keeps(q->kernel, part->total));
    }
}

static void combine_bodies(const void *view, int64_t begin, int64_t end, double *totals)
{
    const summing *q = view;
    const tobi_boundary_links *n = q->n;
    (void)totals;
    for (int64_t g = begin; g < end; g++) {
        const int64_t first = n->first[g], stop = n->first[g + 1], before = first/TOBI_BLOCK;
        int64_t parts = 0;
        if (stop > first && q->own) parts = (stop - first + TOBI_BLOCK - 1)/TOBI_BLOCK;
        else if (stop > first) parts = (stop - 1)/TOBI_BLOCK - before + 1;
        tobi_combine_sums(&n->part[before + g], parts, n->total[g]);
    }
}

void tobi_boundary_sum(tobi_system *s, tobi_kernel kernel, const void *view, int own)
{
    summing q = {&sph_of(s)->links, kernel, view, own};
    tobi_launch(&s->sim->exec, TOBI_HOST(sum_block, 0, 0), &q, 0, q.n->count, NULL);
    tobi_launch(&s->sim->exec, TOBI_HOST(combine_bodies, 0, 0), &q, 0, s->sim->body_count, NULL);
}

/* The Laplacian knows the traction mu dv/dn. A wall that turns at omega has mu (dv/dn + n x omega): the
   second part adds no force to a closed surface, but a torque, eq. (17). Implicit viscosity knows it. */
static void turning_traction(const tobi_system *s, const tobi_boundary_link *e, double force[3])
{
    const tobi_body *b = &s->sim->bodies[e->body];
    const double *w = b->info.angular_velocity;
    double share = b->friction == TOBI_NO_SLIP
                       ? 2*s->smoothing.volume*s->fluid[s->particles.fluid[e->particle]].viscosity : 0;
    for (int a = 0; a < 3; a++) {
        int p = (a + 1)%3, q = (a + 2)%3;
        force[a] = share*(w[p]*e->gradient[q] - w[q]*e->gradient[p]);
    }
}

/* Sums of the reactions on the bodies over the entries. */
typedef struct reaction { const tobi_system *s; int viscous, known; } reaction;

/* N, of one entry at its foot; returns what pushes along the gradient of the link, N m. */
static double find_force(const reaction *r, const tobi_boundary_link *l, const tobi_boundary_entry *e,
                         double force[3])
{
    const tobi_system *s = r->s;
    const sph_fields *f = sph_fields_of(&s->particles);
    const double mass = s->smoothing.volume*s->fluid[s->particles.fluid[l->particle]].density;
    const double *accel = r->viscous ? e->friction : e->hydrostatic;
    for (int a = 0; a < 3; a++) force[a] = -mass*accel[a];
    if (r->viscous) return 0;
    const float capillary = f->capillary ? f->capillary[l->particle] : 0;
    const float pressure = r->known ? 0 : f->pressure[l->particle];
    return 2*s->smoothing.volume*(pressure - capillary);
}

static void sum_reaction(const void *view, int64_t begin, int64_t end, double *t)
{
    const reaction *r = view;
    const tobi_system *s = r->s;
    const tobi_boundary_links *links = &sph_of(s)->links;
    for (int64_t k = begin; k < end; k++) {
        const tobi_boundary_link *l = &links->link[k];
        const tobi_boundary_entry *e = &links->entry[k];
        const tobi_body *b = &s->sim->bodies[l->body];
        double mass = s->smoothing.volume * s->fluid[s->particles.fluid[l->particle]].density,
               force[3], arm[3], turning[3] = {0, 0, 0};
        const int stress = r->viscous && s->sim->def.implicit_viscosity;      /* it acts at the particle */
        const double push = find_force(r, l, e, force);
        for (int a = 0; a < 3; a++)
            arm[a] = e->foot[a] + (stress ? e->offset[a] : 0) + b->lower[a] - b->centre[a];
        if (r->viscous && !stress) turning_traction(s, l, turning);
        for (int a = 0; a < 3; a++) {
            int p = (a + 1)%3, q = (a + 2)%3;
            t[a] += force[a] + push*l->gradient[a];
            t[3 + a] += arm[p]*(force[q] + turning[q]) - arm[q]*(force[p] + turning[p]) +
                        push*l->torque_arm[a] + (stress ? mass*e->couple[a] : 0);
        }
    }
}

void tobi_boundary_known_forces(tobi_system *s, int viscous)
{
    const reaction r = {s, viscous, 1};
    tobi_boundary_sum(s, TOBI_HOST(sum_reaction, 6, 0), &r, 0);
}

void tobi_boundary_forces(tobi_system *s, int viscous)
{
    const reaction r = {s, viscous, 0};
    tobi_boundary_sum(s, TOBI_HOST(sum_reaction, 6, 0), &r, 0);
}

/* totals[0]: W of the same reactions, by changes of shape. */
static void sum_shape(const void *view, int64_t begin, int64_t end, double *t)
{
    const reaction *r = view;
    const tobi_boundary_links *links = &sph_of(r->s)->links;
    for (int64_t k = begin; k < end; k++) {
        const tobi_boundary_link *l = &links->link[k];
        const tobi_boundary_entry *e = &links->entry[k];
        const tobi_body *b = &r->s->sim->bodies[l->body];
        const double *u = b->start;
        double force[3], flow[3];
        if (!b->deforms) continue;
        const double push = find_force(r, l, e, force);
        tobi_body_place_flow(b, e->triangle, e->barycentric, e->foot, flow);
        t[0] += vec3_dot(force, flow) +
                push*(e->wall_flux - vec3_dot(l->gradient, u) - vec3_dot(l->torque_arm, u + 3));
    }
}

/* isph finds what its pressure does by itself. */
static void load_shapes(tobi_system *s)
{
    const int any = tobi_body_any_deforms(s->sim->bodies, s->sim->body_count);
    for (int viscous = sph_of(s)->mirrors != 0; any && viscous < 2; viscous++) {
        const reaction r = {s, viscous, 0};
        tobi_boundary_sum(s, TOBI_HOST(sum_shape, 1, 0), &r, 0);
        for (int k = 0; k < s->sim->body_count; k++)
            s->sim->bodies[k].load[s->number].shape += sph_of(s)->links.total[k][0];
    }
}

void tobi_boundary_load(tobi_system *s)
{
    for (int viscous = 0; viscous < 2; viscous++) {
        tobi_boundary_forces(s, viscous);
        for (int k = 0; k < s->sim->body_count; k++) {
            tobi_body_load *load = &s->sim->bodies[k].load[s->number];
            double *sum = viscous ? load->friction : load->pressure;
            for (int a = 0; a < 6; a++) sum[a] += sph_of(s)->links.total[k][a];
        }
    }
    load_shapes(s);
}
