/* The kernels' own stresses, one particle at a time: what is written is what was computed with. Energies are
   summed in double, since small strains make small differences. Equation numbers: docs/theory/mlsmpm.md. */
#define TOBI_SCALAR_LANES
#include "mpm/fields.h"
#include "mpm/particle.k.h"
#include <string.h>

static double square_sum(const double x[3]) { return x[0]*x[0] + x[1]*x[1] + x[2]*x[2]; }

/* Energy of principal stretches 1 + s, eqs. (8) to (11). */
static double stretched_energy(const mpm_material *m, const float e[9], double dilation, double plastic)
{
    float a[6], v[3][3];
    double s[3], h[3];
    mpm_finger(e, a);
    mpm_eigen(a, v);
    for (int k = 0; k < 3; k++) {
        double b = fmax(a[k], -0.999);
        s[k] = b/(1 + sqrt(1 + b));
        h[k] = 0.5*log1p(b);
    }
    if (m->model == TOBI_VON_MISES || m->model == TOBI_SAND) {
        double trace = h[0] + h[1] + h[2];
        return m->mu*square_sum(h) + 0.5*m->lambda*trace*trace;
    }
    double harder = m->model == TOBI_SNOW ? exp(fmin(-m->hardening*plastic, 2)) : 1;
    return harder*(m->mu*square_sum(s) + 0.5*m->lambda*dilation*dilation);
}

/* Elastic energy per volume at the start, J/m3, of which the stress is the derivative. */
static double energy_density(const mpm_material *m, const float e[9], double plastic)
{
    double d[9], trace, squares = 0;
    for (int k = 0; k < 9; k++) {
        d[k] = e[k];
        squares += d[k]*d[k];
    }
    trace = d[0] + d[4] + d[8];
    double minors = (d[0]*d[4] - d[1]*d[3]) + (d[4]*d[8] - d[5]*d[7]) + (d[0]*d[8] - d[2]*d[6]);
    double dilation = trace + minors + d[0]*(d[4]*d[8] - d[5]*d[7]) - d[1]*(d[3]*d[8] - d[5]*d[6]) +
                      d[2]*(d[3]*d[7] - d[4]*d[6]);
    dilation = fmax(dilation, -0.999);
    double log_j = log1p(dilation);
    switch (m->model) {
    case TOBI_STATIONARY: return 0;
    case TOBI_NEO_HOOKEAN: return m->mu*(trace + 0.5*squares - log_j) + 0.5*m->lambda*log_j*log_j;
    case TOBI_LIQUID: return m->bulk/7*(expm1(-6*log_j)/6 + dilation);
    default: return stretched_energy(m, e, dilation, plastic);
    }
}

/* Elastic energy of principal stretches 1 + s, eqs. (6) and (8). */
static double breakable_energy(const mpm_parameters *m, int model, const float s[3])
{
    const double x = s[0], y = s[1], z = s[2], sum = x + y + z, squares = x*x + y*y + z*z;
    const double dilation = sum + (x*y + y*z + z*x + x*y*z), log_j = log1p(fmax(dilation, -0.999));
    if (model == TOBI_COROTATED) return m->mu*squares + 0.5*m->lambda*dilation*dilation;
    return m->mu*(sum + 0.5*squares - log_j) + 0.5*m->lambda*log_j*log_j;
}

/* The same of a breakable particle, eq. (17); what is cracked and apart holds none. */
static double cracked_energy(const mpm_parameters *m, int32_t model, const float e[9], double damage)
{
    float a[6], v[3][3];
    mpm_crack c;
    mpm_finger(e, a);
    mpm_eigen(a, v);
    mpm_find_crack(m, model, a, &c);
    const int pressed = c.log[0] + c.log[1] + c.log[2] < 0;
    const double cracked = pressed ? breakable_energy(m, model, c.loose) : 0;
    return (1 - damage)*breakable_energy(m, model, c.s) + damage*cracked;
}

mpm_sample mpm_sample_particle(const mpm_view *v, int64_t i)
{
    mpm_parameters parameters;
    float gradient[9], e[9], other[3], unused[3], tau[6], keep;
    int32_t model;
    uint32_t present;
    mpm_sample s = { 0 };
    mpm_load_columns(v->affine + i, gradient, unused);
    mpm_load_columns(v->strain + i, e, other);
    mpm_gather_parameters(v, i, 1, &parameters, &keep, &model, &present);
    mpm_deform(v->strain_dt, gradient, e);
    mpm_find_stress(&parameters, model, present, gradient, e, &other[1], tau);
    if (present & MPM_BREAKS) s.damage = other[1];
    else s.plastic = other[1];
    s.ratio = 1 + (double)mpm_dilation(e);
    if (model == TOBI_SNOW) s.ratio *= 1 + s.plastic;
    if (model == TOBI_SAND) s.ratio *= exp(s.plastic);
    for (int k = 0; k < 9; k++) s.strain[k] = e[k];
    for (int k = 0; k < 6; k++) s.stress[k] = tau[k]/s.ratio;
    s.energy = other[0]*(present & MPM_BREAKS ? cracked_energy(&parameters, model, e, s.damage) :
                                                energy_density(&v->material[v->solid[i]], e, s.plastic));
    return s;
}

double mpm_kinetic(const mpm_view *v, int64_t i)
{
    double square = 0, affine = 0;
    for (int a = 0; a < 3; a++) {
        const tobi_float4 *c = &v->affine[i].c[a];
        affine += (double)c->x*c->x + (double)c->y*c->y + (double)c->z*c->z;
        square += (double)(&v->velocity[i].x)[a]*(&v->velocity[i].x)[a];
    }
    if (v->affine_momentum) square += 0.25*(double)v->cell*v->cell*affine;
    return 0.5*v->strain[i].c[2].w*square;
}

double mpm_volume_ratio(const mpm_view *v, int64_t i)
{
    const int model = v->material[v->solid[i]].model;
    float gradient[9], e[9], other[3], unused[3];
    mpm_load_columns(v->affine + i, gradient, unused);
    mpm_load_columns(v->strain + i, e, other);
    mpm_deform(v->strain_dt, gradient, e);
    const double ratio = 1 + (double)mpm_dilation(e);
    return model == TOBI_SNOW ? ratio*(1 + other[1]) : model == TOBI_SAND ? ratio*exp(other[1]) : ratio;
}

/* Power of a symmetric stress along a velocity gradient. */
static double stress_power(const float tau[6], const float c[9])
{
    return (double)tau[MPM_XX]*c[0] + (double)tau[MPM_YY]*c[4] + (double)tau[MPM_ZZ]*c[8] +
           (double)tau[MPM_XY]*(c[1] + c[3]) + (double)tau[MPM_YZ]*(c[5] + c[7]) +
           (double)tau[MPM_ZX]*(c[2] + c[6]);
}

/* Work of the stress, mean of before and after, less what is stored. */
static double flow_work(const mpm_view *v, int64_t i)
{
    const mpm_material *m = &v->material[v->solid[i]];
    mpm_parameters parameters;
    float gradient[9], e[9], other[3], unused[3], before[6], after[6], keep;
    int32_t model;
    uint32_t present;
    mpm_load_columns(v->affine + i, gradient, unused);
    mpm_load_columns(v->strain + i, e, other);
    mpm_gather_parameters(v, i, 1, &parameters, &keep, &model, &present);
    const double stored = energy_density(m, e, other[1]);
    mpm_parameters still = parameters;                     /* no time goes by */
    still.inertial_scale = 0;
    mpm_find_stress(&still, model, present, gradient, e, &other[1], before);
    mpm_load_columns(v->strain + i, e, other);
    mpm_deform(v->strain_dt, gradient, e);
    mpm_find_stress(&parameters, model, present, gradient, e, &other[1], after);
    const double power = 0.5*(stress_power(before, gradient) + stress_power(after, gradient));
    return other[0]*(v->strain_dt*power - (energy_density(m, e, other[1]) - stored));
}

void mpm_sum_flow(const void *view, int64_t begin, int64_t end, double *totals)
{
    const mpm_view *v = view;
    for (int64_t i = begin; i < end; i++) {
        const int model = v->material[v->solid[i]].model;
        if (model != TOBI_NEO_HOOKEAN && model != TOBI_COROTATED && model != TOBI_STATIONARY)
            totals[0] += flow_work(v, i);
    }
}

static double von_mises(const double s[6])
{
    double x = s[MPM_XX] - s[MPM_YY], y = s[MPM_YY] - s[MPM_ZZ], z = s[MPM_ZZ] - s[MPM_XX];
    double shear = s[MPM_XY]*s[MPM_XY] + s[MPM_YZ]*s[MPM_YZ] + s[MPM_ZX]*s[MPM_ZX];
    return sqrt(0.5*(x*x + y*y + z*z) + 3*shear);
}

void mpm_read_field(const mpm_view *v, double density, const char *field, int64_t i, double *out)
{
    const mpm_sample s = mpm_sample_particle(v, i);
    if (!strcmp(field, "density")) {
        out[0] = density/s.ratio;
    } else if (!strcmp(field, "J")) {
        out[0] = s.ratio;
    } else if (!strcmp(field, "pressure")) {
        out[0] = -(s.stress[MPM_XX] + s.stress[MPM_YY] + s.stress[MPM_ZZ])/3;
    } else if (!strcmp(field, "von_mises")) {
        out[0] = von_mises(s.stress);
    } else if (!strcmp(field, "plastic")) {
        out[0] = s.plastic;
    } else if (!strcmp(field, "damage")) {
        out[0] = s.damage;
    } else if (!strcmp(field, "stress")) {
        memcpy(out, s.stress, sizeof s.stress);
    } else {
        for (int k = 0; k < 9; k++) out[k] = s.strain[k] + (k%4 == 0);
    }
}
