/* Names of the objects of a world. Drawback: every new one is compared with all before it. */
#include "world/names.h"
#include "base/error.h"
#include "core/constraint.h"
#include "rigid/lines.h"
#include <string.h>

/* For the catalogue of texts: they come through variables. */
static const char *const kinds[] __attribute__((unused)) = {
    TR("fluid"), TR("solid"), TR("body"), TR("probe"), TR("line"), TR("joint"), TR("inlet"), TR("outlet"),
    TR("porous zone"), TR("world"), TR("camera of"), TR("contact_angle of"), TR("temperature"),
    TR("concentration")
};

static tobi_status refuse(const char *kind, const char *other, int number, const char *name, tobi_error *err)
{
    return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "%s '%s': %s %d has that name already", tr(kind),
                                      name,
                                      tr(other), number), "name");
}

tobi_status tobi_names_check_matter(const tobi_world *w, const char *kind, const char *name, tobi_error *err)
{
    for (int k = 0; k < w->system_count; k++) {
        const tobi_system *s = &w->system[k];
        for (int i = 0; i < s->fluid_count; i++)
            if (strcmp(s->fluid[i].name, name) == 0) return refuse(kind, "fluid", i, name, err);
        for (int i = 0; i < s->solid_count; i++)
            if (strcmp(s->solids[i].name, name) == 0) return refuse(kind, "solid", i, name, err);
    }
    const int body = tobi_world_find_body(w, name);
    return body >= 0 ? refuse(kind, "body", body, name, err) : TOBI_OK;
}

tobi_status tobi_names_check_probe(const tobi_world *w, const char *name, tobi_error *err)
{
    for (int k = 0; k < w->probe_count; k++)
        if (strcmp(w->probes[k].name, name) == 0) return refuse("probe", "probe", k, name, err);
    return TOBI_OK;
}

tobi_status tobi_names_check_line(const tobi_world *w, const char *name, tobi_error *err)
{
    for (int k = 0; k < w->line_count; k++)
        if (strcmp(w->lines[k].name, name) == 0) return refuse("line", "line", k, name, err);
    return TOBI_OK;
}

tobi_status tobi_names_check_joint(const tobi_world *w, const char *name, tobi_error *err)
{
    const tobi_constraints *c = &w->sim.constraints;
    for (int k = 0; k < c->count; k++)
        if (strcmp(c->at[k].name, name) == 0) return refuse("joint", "joint", k, name, err);
    const int body = tobi_world_find_body(w, name);
    if (body >= 0 && w->sim.bodies[body].rigid.joint.kind)      /* both in joints.csv */
        return refuse("joint", "body", body, name, err);
    return TOBI_OK;
}

tobi_status tobi_names_check_porous(const tobi_world *w, const char *name, tobi_error *err)
{
    for (int k = 0; k < w->sim.porous_count; k++)
        if (strcmp(w->sim.porous[k].name, name) == 0)
            return refuse("porous zone", "porous zone", k, name, err);
    return TOBI_OK;
}

tobi_status tobi_names_check_opening(const tobi_world *w, int outlet, const char *name, tobi_error *err)
{
    const char *kind = outlet ? "outlet" : "inlet";
    int number = 0;
    for (int k = 0; k < w->sim.opening_count; k++) {
        if (w->sim.openings[k].outlet != outlet) continue;
        if (strcmp(w->sim.openings[k].name, name) == 0) return refuse(kind, kind, number, name, err);
        number++;
    }
    return TOBI_OK;
}
