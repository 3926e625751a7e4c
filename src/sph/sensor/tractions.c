/* Pressure and shear on a body, place by place: the sums of sph/boundary/links.c and sph/isph/forces.c, read
   from the side of the surface. Drawback: particles that the body hides from a place are not left out. */
#include "sph/sensor/tractions.h"
#include "sph/sensor/around.h"
#include "sph/hydrostatic.h"
#include "sph/state.h"
#include "sph/wall_law.h"
#include "geom/vec3.h"
#include <string.h>

/* Share of the kernel with particles in it below which a place of isph is dry. */
static const double DRY = 0.1;

typedef struct look {
    const tobi_system *s;
    const tobi_body *b;
    const sph_place *place;
    double gravity[3];              /* m/s2, less what still water holds                            */
    double pressure, weight, away;  /* sums; away: m, of the distances                              */
    double shear[3];
} look;

/* Of dfsph and wcsph: twice the particle's own pressure on the plane, and what liquid at rest adds. */
static void press(look *l, int64_t i, double w, double depth)
{
    const tobi_smoothing_constants *c = &l->s->smoothing;
    const sph_fields *f = sph_fields_of(&l->s->particles);
    const int k = (int)(depth/c->h*TOBI_PLANE_SAMPLES);
    const double sigma = c->plane.sigma[k], reach = sigma > 0 ? c->plane.lambda[k]/sigma : 0;
    const double rho = l->s->fluid[l->s->particles.fluid[i]].density;
    const double own = f->pressure[i] - (f->capillary ? f->capillary[i] : 0);
    l->pressure += w*(2*own - rho*vec3_dot(l->gravity, l->place->normal)*(depth + reach));
}

/* Of isph: as at rest from the particle to the place, a mean. */
static void carry(look *l, int64_t i, const double r[3], double w, double depth)
{
    const double rho = l->s->fluid[l->s->particles.fluid[i]].density;
    double p = sph_fields_of(&l->s->particles)->pressure[i];
    for (int a = 0; a < l->s->box.dimension; a++) p -= rho*l->gravity[a]*r[a];
    l->pressure += w*p;
    l->weight += w;
    l->away += w*(rho/l->s->fluid[0].density)*depth;
}

/* The reaction of the drag that the particle feels from here, along the surface. Implicit viscosity knows no
   turbulent layer, viscosity.md eq. (3). */
static void rub(look *l, int64_t i, double w, double depth)
{
    const double *n = l->place->normal, least = 0.25*l->s->smoothing.spacing, away = fmax(depth, least);
    const tobi_fluid *f = &l->s->fluid[l->s->particles.fluid[i]];
    const tobi_float4 *apparent = sph_fields_of(&l->s->particles)->apparent;
    const tobi_float4 *v = &l->s->particles.velocity[i];
    const double mu = apparent ? apparent[i].x : f->viscosity;
    const double *b = l->place->velocity;
    double u[3] = { v->x - b[0], v->y - b[1], v->z - b[2] };
    const double through = vec3_dot(u, n);
    for (int a = 0; a < 3; a++) u[a] -= through*n[a];
    const double speed = vec3_length(u), nu = mu/f->density;
    if (!(speed > 0) || !(nu > 0)) return;
    const double layer = l->s->sim->def.implicit_viscosity ? 1 : tobi_wall_law((float)(speed*away/nu));
    const double rate = 2*w*mu/away*layer;
    for (int a = 0; a < 3; a++) l->shear[a] += rate*u[a];
}

static void see(void *user, int64_t i, const double r[3])
{
    look *l = user;
    const tobi_smoothing_constants *c = &l->s->smoothing;
    const double r2 = vec3_dot(r, r), depth = vec3_dot(r, l->place->normal);
    if (!(r2 < c->h*c->h) || !(depth > 0)) return;
    const double w = c->volume*tobi_smoothing_w(c->shape, c->dimension, c->h, sqrt(r2));
    sph_gravity_at(l->s, l->place->x, l->s->particles.fluid[i], l->gravity);
    if (sph_of(l->s)->mirrors) carry(l, i, r, w*c->weight_correction, depth);
    else press(l, i, w*c->plane_scale, depth);
    if (l->b->friction == TOBI_NO_SLIP) rub(l, i, w*c->plane_scale, depth);
}

void sph_surface_look(const tobi_system *s, const tobi_body *b, const sph_place *place, double *pressure,
                      double shear[3])
{
    look l = { .s = s, .b = b, .place = place };
    *pressure = 0;
    memset(shear, 0, 3*sizeof *shear);
    if (s->step == 0) return;       /* no pressure has been found yet */
    const sph_range cells = sph_cells_around(s, place->x, s->smoothing.h);
    sph_visit(s, place->x, &cells, see, &l);
    *pressure = l.pressure;
    const double more = s->fluid[0].density*l.away;
    if (sph_of(s)->mirrors)
        *pressure = l.weight > DRY ? (l.pressure + more*tobi_body_point_acceleration(b, place->point, s->dt))
                                         /l.weight : 0;
    *pressure += sph_hydrostatic(s, place->x) - tobi_reference_pressure(&sph_of(s)->reference, place->x) +
                 sph_still_pressure(s, b, place->point, place->x);
    memcpy(shear, l.shear, sizeof l.shear);
}
