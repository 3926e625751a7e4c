/* What turns strength and fracture energy of a solid into the law of its particles (damage.k.h). */
#include "mpm/damage.h"
#include <math.h>
#include <stdio.h>

/* Width of the band that a crack spreads over, in cells: BAND while its opening is small, less when it comes
   near the size of a cell, since the particles on its faces then lose sight of each other. Both fit bars that
   were pulled apart at four places of the lattice in the grid (2-D, nu = 0, 4 particles in a cell): cells
   1.55, 1.29, 1.00 and 0.70 at a crack strain of 0.05, 0.2, 0.8 and 2. Eq. (20), validation/fracture.md. */
static const double BAND = 1.5, NARROWING = 0.66;
/* Openings of more cells than this cannot be followed to the end. */
static const double MOST_CELLS = 1.3;

/* How far a crack opens until nothing is left, m. */
static double find_opening(const tobi_solid_def *d) { return 2*d->fracture_energy/d->strength; }

static tobi_status check_keys(const tobi_solid_def *def, const char **key, tobi_error *err)
{
    const int breaks = def->strength > 0, costs = def->fracture_energy > 0;
    *key = breaks ? "strength" : "fracture_energy";
    if (breaks && def->model != TOBI_NEO_HOOKEAN && def->model != TOBI_COROTATED)
        return tobi_fail(err, TOBI_UNSUPPORTED, "is for the models neo-hookean and corotated");
    if (breaks && !costs) return tobi_fail(err, TOBI_INVALID, "needs a fracture_energy greater than 0 J/m2");
    if (costs && !breaks) return tobi_fail(err, TOBI_INVALID, "needs a strength greater than 0 Pa");
    return TOBI_OK;
}

tobi_status mpm_damage_check(const tobi_solid_def *def, double cell, const char **key, char note[TOBI_NOTE],
                             tobi_error *err)
{
    note[0] = 0;
    TOBI_TRY(check_keys(def, key, err));
    if (!(def->strength > 0)) return TOBI_OK;
    const double opening = find_opening(def);
    const double most = opening*(def->youngs_modulus/def->strength + NARROWING)/BAND;
    if (!(cell < most))
        return tobi_fail(err, TOBI_INVALID, "needs cells smaller than %.4g m, they have %.4g m; larger ones "
                         "hold more elastic energy than a crack of this fracture_energy takes", most, cell);
    if (opening > MOST_CELLS*cell)
        snprintf(note, TOBI_NOTE, tr("cracks open by %.3g m until they are through; cells of %.3g m lose "
                 "sight of their faces before, and the energy stays below fracture_energy; cells larger than "
                 "%.3g m follow them\n"), opening, cell, opening/MOST_CELLS);
    return TOBI_OK;
}

void mpm_damage_describe(const tobi_solid_def *def, double cell, mpm_material *material)
{
    material->strength = (float)def->strength;
    material->brittleness = 0;
    if (def->strength > 0)
        material->brittleness = (float)(BAND/fmin(find_opening(def)/cell, MOST_CELLS) - NARROWING);
}

/* Nominal stress over strain e of a bar that is stretched and cannot narrow: as in a band that its
   neighbours hold. */
static double find_secant(const mpm_material *m, double e)
{
    const double s = 1 + e;
    if (m->model == TOBI_COROTATED) return 2.0*m->mu + m->lambda;
    return (m->mu*(s + 1) + m->lambda*log1p(e)/e)/s;
}

double mpm_damage_spent(const mpm_view *v, int64_t i)
{
    const mpm_material *m = &v->material[v->solid[i]];
    const double strength = m->strength, damage = v->strain[i].c[1].w;
    if (!(strength > 0 && damage > 0)) return 0;
    double strain = strength/(2.0*m->mu + m->lambda);
    for (int k = 0; k < 40; k++) {                   /* e of eq. (18) for this D */
        const double onset = strength/find_secant(m, strain);
        strain = onset/(1 - damage*(1 - onset*m->brittleness));
    }
    return v->strain[i].c[0].w*0.5*strength*damage*strain;
}
