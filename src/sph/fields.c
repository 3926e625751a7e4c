/* The fields of the SPH methods and what of them is shown in results. Drawback: dfsph and wcsph have the same
   list, though wcsph needs less of it. */
#include "base/language.h"
#include "sph/state.h"
#include "sph/hydrostatic.h"
#include "sph/openings.h"
#include "sph/scalars.h"
#include <string.h>

#define ROW(...) TOBI_FIELD_ROW(sph_fields, __VA_ARGS__)
static const tobi_field fields[] = { SPH_FIELDS(ROW) };
const tobi_field_list sph_field_list = { fields, sizeof fields/sizeof *fields, sizeof(sph_fields) };

const tobi_output sph_outputs[] = {
    { TR("acceleration"), 3, "m/s2", 1 }, { TR("vorticity"), 3, "1/s", 1 },
    { TR("surface"), 1, "1", 0 }, { TR("apparent_viscosity"), 1, "Pa s", 1 },
    { TR("material"), 1, "1", 0 }, { TR("temperature"), 1, "degC", 0 },
    { TR("concentration"), 1, "1", 0 }, { NULL, 0, NULL, 0 }
};

unsigned sph_needs(const tobi_system *s, int full)
{
    unsigned needs = s->sim->body_count > 0 || full ? SPH_NEED_WETTED : 0;
    for (int f = 0; f < s->fluid_count; f++)
        if (s->fluid[f].tension > 0) needs |= SPH_NEED_TENSION;
    if (tobi_system_is_mixed(s)) needs |= SPH_NEED_PHASES;
    if (sph_has_openings(s)) needs |= SPH_NEED_OPENINGS;
    if (s->sim->def.implicit_viscosity) needs |= SPH_NEED_IMPLICIT;
    for (int f = 0; f < s->fluid_count && s->sim->def.implicit_viscosity; f++)
        if (!tobi_fluid_is_newtonian(&s->fluid[f]) || sph_scalars_thin(s)) needs |= SPH_NEED_APPARENT;
    if (s->sim->porous_count > 0) needs |= SPH_NEED_POROUS;
    if (sph_scalars_any(s)) needs |= SPH_NEED_SCALARS;
    return needs;
}

void sph_read(const tobi_system *s, const char *name, int64_t i, double *out)
{
    const tobi_particles *p = &s->particles;
    const sph_fields *f = sph_fields_of(&s->particles);
    if (!strcmp(name, "acceleration") || !strcmp(name, "vorticity")) {
        const tobi_float4 *v = &f->accel[i];
        out[0] = v->x; out[1] = v->y; out[2] = v->z;
    } else if (!strcmp(name, "pressure")) {
        const double x[3] = {p->position[i].x, p->position[i].y, p->position[i].z};
        /* that of isph is smooth as it is; an average would be one-sided at walls and surfaces */
        out[0] = (sph_of(s)->mirrors ? f->pressure[i] : f->mean[i]) + sph_hydrostatic(s, x);
    } else if (!strcmp(name, "apparent_viscosity")) {
        out[0] = f->apparent ? f->apparent[i].x : s->fluid[p->fluid[i]].viscosity;
    } else if (!strcmp(name, "temperature")) {
        out[0] = f->scalars ? f->scalars[i].x : 0;
    } else if (!strcmp(name, "concentration")) {
        out[0] = f->scalars ? f->scalars[i].y : 0;
    } else if (!strcmp(name, "density")) {
        out[0] = f->density[i]*s->fluid[p->fluid[i]].density;
    } else {
        out[0] = f->surface[i] != 0;
    }
}

void sph_account(const tobi_system *s, tobi_account *a)
{
    tobi_account_add(a, "particles beside bodies", tobi_boundary_links_bytes(&sph_of(s)->links));
    tobi_account_add(a, "liquid beside solids", sph_soft_bytes(&sph_of(s)->soft));
}
