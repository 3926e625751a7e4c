/* Moduli, cones and wave speeds of a material, once, before the first step. Drawback: the speed is
   that of the material at rest, larger strains are left to a reserve. */
#include "mpm/material.h"
#include "mpm/particle_fields.h"
#include "tobiuo/types.h"
#include <math.h>

/* Slope of Drucker and Prager's cone, eqs. (11), (11b): what is sheared without change of volume, down a
   slope or in a collapse, flows at shear over pressure = tan phi, in 2-D and 3-D alike. */
static double find_cone(const tobi_solid_def *d)
{
    return sqrt(2.0)/3*tan(d->friction_angle*acos(-1)/180);
}

/* Shear modulus times I_0/(d sqrt(rho_s)) of eq. (11c): grains fill 0.6 of what they lie in. */
static double find_inertial_scale(const tobi_solid_def *d, double mu)
{
    return mu*d->inertial_number/(d->grain_diameter*sqrt(d->density/0.6));
}

mpm_material mpm_material_describe(const tobi_solid_def *d, double *sound)
{
    double mu = d->youngs_modulus/(2*(1 + d->poissons_ratio));
    double lambda = d->youngs_modulus*d->poissons_ratio/((1 + d->poissons_ratio)*(1 - 2*d->poissons_ratio));
    double stiffness = d->model == TOBI_LIQUID ? d->bulk_modulus : lambda + 2*mu;
    /* Hardened snow is up to e^2 times as stiff. */
    if (d->model == TOBI_SNOW && d->hardening > 0) stiffness *= exp(2);
    *sound = d->model == TOBI_STATIONARY ? 0 : sqrt(stiffness/d->density);
    return (mpm_material){
        .model = d->model, .mu = (float)mu, .lambda = (float)lambda, .bulk = (float)d->bulk_modulus,
        .viscosity = (float)d->viscosity, .yield = (float)d->yield_stress, .hardening = (float)d->hardening,
        .compression = (float)d->critical_compression, .stretch = (float)d->critical_stretch,
        .friction = (float)find_cone(d), .friction_rise = (float)d->friction_rise,
        .inertial_scale = (float)find_inertial_scale(d, mu), .cut_friction = (float)d->cut_friction,
        .surface_friction = d->model == TOBI_LIQUID ? 0 : (float)d->surface_friction, .keep = 1 };
}

double mpm_material_viscous_dt(const tobi_solid_def *d, double cell)
{
    int viscous = d->model == TOBI_LIQUID && d->viscosity > 0;
    return viscous ? 0.1*cell*cell*d->density/d->viscosity : INFINITY;
}

/* Eq. (15); a body at rest does not fall further than half a cell in one step either. */
double mpm_material_dt(const tobi_system *s, const tobi_mlsmpm_def *def, double sound, double speed)
{
    const double cell = def->cell*s->smoothing.spacing;
    double g = 0;
    for (int a = 0; a < s->box.dimension; a++) g += s->sim->def.gravity[a]*s->sim->def.gravity[a];
    return fmin(def->cfl*cell/(sound + speed + 1e-30), 0.5*sqrt(cell/(sqrt(g) + 1e-30)));
}

/* J of a liquid after the gradient that its strain lacks, eq. (4); not below what float can raise to -7. */
static double find_volume(const mpm_view *v, int64_t i)
{
    const tobi_columns *f = &v->strain[i], *c = &v->affine[i];
    const double dt = v->strain_dt, a[3] = {1 + dt*c->c[0].x, dt*c->c[0].y, dt*c->c[0].z},
                 b[3] = {dt*c->c[1].x, 1 + dt*c->c[1].y, dt*c->c[1].z},
                 d[3] = {dt*c->c[2].x, dt*c->c[2].y, 1 + dt*c->c[2].z};
    const double change = a[0]*(b[1]*d[2] - b[2]*d[1]) - a[1]*(b[0]*d[2] - b[2]*d[0]) +
                          a[2]*(b[0]*d[1] - b[1]*d[0]);
    return fmax(change*(1 + f->c[0].x), 1e-2);
}

/* maxima: 6 speed of sound, m/s, as nodes feel it, eq. (15b). */
static void find_squeezed(const void *view, int64_t begin, int64_t end, double *totals)
{
    const mpm_view *v = view;
    for (int64_t i = begin; i < end; i++) {
        const mpm_material *m = &v->material[v->solid[i]];
        if (m->model != TOBI_LIQUID) continue;
        const double J = find_volume(v, i), rest = v->strain[i].c[0].w/v->strain[i].c[2].w;
        const double sound = sqrt(m->bulk*rest/7*(J + 6*pow(J, -6)));
        if (sound > totals[6]) totals[6] = sound;
    }
}

double mpm_material_squeezed_sound(tobi_system *s, const mpm_view *v)
{
    double t[TOBI_TOTALS];
    tobi_launch(&s->sim->exec, TOBI_HOST(find_squeezed, 0, 1), v, 0, s->particles.count, t);
    return t[6];
}

/* Crack bands, eq. (20), are measured with mls. Edges of blades ask nodes that hold next to no mass, where
   only mls leaves no wild velocity. */
int mpm_takes_spline(const tobi_system *s, int gradient)
{
    int measured = mpm_fields_of(&s->particles)->cuts != NULL;
    for (int k = 0; k < s->solid_count; k++) measured |= s->solids[k].def.strength > 0;
    return gradient == TOBI_GRADIENT_SPLINE || (gradient == TOBI_GRADIENT_AUTOMATIC && !measured);
}
