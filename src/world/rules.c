/* Rules of what a world may not combine. Each is one function, which tells every breach and never stops at
   one. Drawback: rules of fluids, bodies and most of solids are still told by the calls that add
   them, and by scenes in their own words. */
#include "tobiuo/params.h"
#include "mpm/damage.h"
#include "mpm/mlsmpm.h"
#include "world/limits.h"
#include "world/methods.h"
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static const char axes[] = "xyz";

__attribute__((format(printf, 3, 4)))
static void tell(const tobi_rules *r, const tobi_error *why, const char *format, ...)
{
    char path[64];
    va_list args;
    va_start(args, format);
    vsnprintf(path, sizeof path, format, args);
    va_end(args);
    r->tell(r->user, path, why);
}

static void check_corners(const tobi_rules *r, const tobi_world_def *d, int a)
{
    tobi_error why = { 0 };
    const double length = d->domain_max[a] - d->domain_min[a];
    if (!r->corners) return;
    if (!(length > 0)) {
        tobi_fail(&why, TOBI_INVALID, "is %.10g in %c, must be greater than domain.min there, %.10g",
                  d->domain_max[a], axes[a], d->domain_min[a]);
        tell(r, &why, "domain.max[%d]", a);
    } else if (d->spacing > length) {
        tobi_fail(&why, TOBI_INVALID, "is %.10g m, the domain has only %.10g m in %c", d->spacing, length,
                  axes[a]);
        tell(r, &why, "spacing");
    }
}

static void check_walls(const tobi_rules *r, const tobi_world_def *d, const tobi_method *method, int a)
{
    tobi_error why = { 0 };
    const int periodic = d->wall_min[a] == TOBI_WALL_PERIODIC, mpm = method && method->solids;
    if (periodic != (d->wall_max[a] == TOBI_WALL_PERIODIC)) {
        tobi_fail(&why, TOBI_INVALID, "is periodic on one side only; write \"%c\": \"periodic\"", axes[a]);
        tell(r, &why, "domain.walls.%c", axes[a]);
    }
    if (periodic && mpm) {
        tobi_fail(&why, TOBI_UNSUPPORTED, "is periodic, which mlsmpm does not know; allowed are slip, "
                  "no-slip, separate and open");
        tell(r, &why, "domain.walls.%c", axes[a]);
    }
    if (method && !mpm && (d->wall_min[a] == TOBI_WALL_OPEN || d->wall_max[a] == TOBI_WALL_OPEN)) {
        tobi_fail(&why, TOBI_UNSUPPORTED, "is open, which only mlsmpm knows; allowed are slip, no-slip, "
                  "periodic and separate");
        tell(r, &why, "domain.walls.%c", axes[a]);
    }
}

/* A side moves along itself, and only where the fluid sticks to it. */
static void check_side(const tobi_rules *r, const tobi_world_def *d, int a, int upper)
{
    tobi_error why = { 0 };
    const double *v = upper ? d->wall_velocity_max[a] : d->wall_velocity_min[a];
    const int wall = upper ? d->wall_max[a] : d->wall_min[a];
    const int across = v[a] != 0 || (d->dimension == 2 && v[2] != 0);
    if (v[0] == 0 && v[1] == 0 && v[2] == 0) return;
    if (wall == TOBI_WALL_NO_SLIP && !across) return;
    if (wall != TOBI_WALL_NO_SLIP) tobi_fail(&why, TOBI_INVALID, "moves a side that is not no-slip");
    else
        tobi_fail(&why, TOBI_INVALID, "is not along the side: %c must be 0", v[a] != 0 ? axes[a] : 'z');
    tell(r, &why, "domain.wall_velocity.%c[%d]", axes[a], upper);
}

static void check_numbers(const tobi_rules *r, const tobi_world_def *d, const tobi_method *method)
{
    const char *key;
    tobi_error why = { 0 };
    if (!method || !r->corners || !r->numbers) return;
    const int sph = !method->solids;
    if (tobi_limits_check(d, sph, &key, &why) != TOBI_OK) tell(r, &why, "%s", key);
}

static void check_iterations(const tobi_rules *r, const char *solve, int least, int most)
{
    tobi_error why = { 0 };
    if (least <= most) return;
    tobi_fail(&why, TOBI_INVALID, "is %d, must not be above %s_iterations_max, %d", least, solve, most);
    tell(r, &why, "dfsph.%s_iterations_min", solve);
}

static void check_isph(const tobi_rules *r, const tobi_world_def *d, const tobi_isph_def *m)
{
    tobi_error why = { 0 };
    if (d->implicit_viscosity && m->viscosity_form != TOBI_VISCOSITY_PLAIN) {
        tobi_fail(&why, TOBI_INVALID, "is a form of explicit viscosity, and implicit_viscosity is true; "
                  "allowed with it is plain");
        tell(r, &why, "isph.viscosity_form");
    }
    if (m->laplacian == TOBI_LAPLACIAN_OWN && m->solver == TOBI_CG) {
        tobi_fail(&why, TOBI_INVALID, "is own, which makes the matrix unsymmetric, and isph.solver is cg, "
                  "which needs a symmetric one; allowed are bicgstab and gmres");
        tell(r, &why, "isph.laplacian");
    }
    if (m->volume_error != TOBI_VOLUME_SUM && m->volume_gain == 0) {
        tobi_fail(&why, TOBI_INVALID, "says which error of volume is corrected, and isph.volume_gain is 0, "
                  "which corrects none");
        tell(r, &why, "isph.volume_error");
    }
    if (m->pressure_gradient == TOBI_SYMMETRIC_SUM && m->renormalised) {
        tobi_fail(&why, TOBI_INVALID, "is symmetric, so that forces of pairs are opposite, and "
                  "isph.renormalised undoes that; allowed with it are difference and plain");
        tell(r, &why, "isph.pressure_gradient");
    }
}

void tobi_rules_beside(const tobi_rules *r, const tobi_world_def *d, const tobi_mlsmpm_def *m)
{
    tobi_error why = { 0 };
    if (!r || !d || !m || !(m->spacing > d->spacing*(1 + 1e-9)) || !r->numbers) return;
    tobi_fail(&why, TOBI_INVALID, "is %.10g m, must not be above the spacing of the fluids, %.10g m: they "
              "would see holes between the particles", m->spacing, d->spacing);
    tell(r, &why, "mlsmpm.spacing");
}

void tobi_rules_solid(const tobi_rules *r, const tobi_world_def *d, const void *method_def,
                      const tobi_solid_def *solid)
{
    const tobi_mlsmpm_def *m = method_def;
    const char *key;
    char note[TOBI_NOTE];
    tobi_error why = { 0 };
    if (!r || !d || !solid || !m || tobi_method_find(d->method) != &tobi_mlsmpm ||
        !tobi_solid_uses(solid->model, "strength")) return;
    if (mpm_damage_check(solid, m->cell*mpm_spacing(m, d->spacing), &key, note, &why) != TOBI_OK)
        tell(r, &why, "%s", key);
}

void tobi_rules_world(const tobi_rules *r, const tobi_world_def *d, const void *method_def)
{
    const tobi_method *method = tobi_method_find(d ? d->method : NULL);
    const tobi_dfsph_def *m = method_def;
    if (!r || !d) return;
    if (method && m && strcmp(method->name, "dfsph") == 0) {
        check_iterations(r, "density", m->density_iterations_min, m->density_iterations_max);
        check_iterations(r, "divergence", m->divergence_iterations_min, m->divergence_iterations_max);
    }
    if (method && method_def && strcmp(method->name, "isph") == 0) check_isph(r, d, method_def);
    for (int a = 0; a < d->dimension; a++) {
        check_walls(r, d, method, a);
        check_corners(r, d, a);
    }
    check_numbers(r, d, method);
    for (int a = 0; a < d->dimension; a++)
        for (int upper = 0; upper < 2; upper++) check_side(r, d, a, upper);
}
