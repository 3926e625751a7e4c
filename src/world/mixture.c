/* What several fluids in one world may not be: densities further apart than the method can compute, and
   different beside inlets and outlets, which know one density only. Drawback: that is told at the second
   fluid, not at the opening that is too much. */
#include "world/mixture.h"
#include "base/error.h"
#include "base/param.h"
#include "world/methods.h"
#include <math.h>
#include <string.h>

tobi_status tobi_mixture_check(const tobi_method *m, const tobi_fluid_def *fluid, const tobi_fluid_def *other,
                               int openings, tobi_error *err)
{
    const double ratio = fmax(fluid->density, other->density)/fmin(fluid->density, other->density);
    const char *name = other->name ? other->name : "";
    if (!(ratio > 1)) return TOBI_OK;
    if (ratio > m->density_ratio*(1 + 1e-9))
        return tobi_fail(err, TOBI_UNSUPPORTED, "is %.10g kg/m3 and that of fluid '%s' is %.10g kg/m3: 1 : "
                         "%.6g; %s computes fluids up to 1 : %g%s", fluid->density, name, other->density,
                         ratio, m->name, m->density_ratio,
                         m->density_ratio < TOBI_DENSITY_RATIO ? tr(", isph up to 1 : 1000") : "");
    if (!openings) return TOBI_OK;
    return tobi_fail(err, TOBI_UNSUPPORTED, "is %.10g kg/m3 and that of fluid '%s' is %.10g kg/m3; beside "
                     "inlets or outlets %s takes fluids of one density; a liquid that is some per cent "
                     "lighter or heavier is a concentration with an expansion (scalars)", fluid->density,
                     name, other->density, m->name);
}

const char *tobi_mixture_check_flow(int implicit_viscosity, const tobi_fluid_def *fluid, tobi_error *err)
{
    const struct { const char *key, *unit; double given, allowed; } all[] = {
        { "yield_stress", " Pa", fluid->yield_stress, 0 },
        { "flow_index", "", fluid->flow_index, 1 },
        { "smagorinsky", "", fluid->smagorinsky, 0 },
    };
    for (size_t k = 0; k < sizeof all/sizeof *all && !implicit_viscosity; k++) {
        if (all[k].given == all[k].allowed) continue;
        tobi_fail(err, TOBI_UNSUPPORTED, "is %.10g%s, and implicit_viscosity is false; allowed without it is "
                  "%g", all[k].given, all[k].unit, all[k].allowed);
        return all[k].key;
    }
    return NULL;
}

void tobi_rules_fluid(const tobi_rules *r, const tobi_world_def *d, const tobi_fluid_def *fluid,
                      const tobi_fluid_def *other, int openings)
{
    tobi_error why = { 0 };
    const tobi_method *m = tobi_method_find(d ? d->method : NULL);
    if (!r || !fluid || !m || m->solids) return;
    const char *key = other ? NULL : tobi_mixture_check_flow(d->implicit_viscosity, fluid, &why);
    if (key) r->tell(r->user, key, &why);
    if (other && tobi_mixture_check(m, fluid, other, openings, &why) != TOBI_OK)
        r->tell(r->user, "density", &why);
}

static tobi_fluid_def describe(const tobi_fluid *f)
{
    return (tobi_fluid_def){ .name = f->name, .density = f->density, .viscosity = f->viscosity };
}

tobi_status tobi_mixture_add(const tobi_world *w, const tobi_fluid_def *def, tobi_error *err)
{
    const tobi_system *s = &w->system[0];
    tobi_error flow = { 0 };
    const char *key = tobi_mixture_check_flow(w->sim.def.implicit_viscosity, def, &flow);
    if (key)
        return tobi_at_key(err, tobi_fail(err, flow.status, "fluid '%s': %s %s", def->name ? def->name : "",
                                          key, flow.text), key);
    for (int k = 0; k < s->fluid_count; k++) {
        const tobi_fluid_def other = describe(&s->fluid[k]);
        tobi_error why = { 0 };
        if (tobi_mixture_check(s->method, def, &other, 0, &why) != TOBI_OK)
            return tobi_at_key(err, tobi_fail(err, why.status, "fluid '%s': density %s",
                                              def->name ? def->name : "", why.text), "density");
    }
    return TOBI_OK;
}

tobi_status tobi_mixture_start(const tobi_world *w, tobi_error *err)
{
    const tobi_system *s = tobi_world_fluids(w);
    for (int k = 1; s && k < s->fluid_count; k++) {
        const tobi_fluid_def fluid = describe(&s->fluid[k]), other = describe(&s->fluid[0]);
        tobi_error why = { 0 };
        if (tobi_mixture_check(s->method, &fluid, &other, w->sim.opening_count > 0, &why) != TOBI_OK)
            return tobi_fail(err, why.status, "fluid '%s': density %s", s->fluid[k].name, why.text);
    }
    return TOBI_OK;
}

/* The fluid of this name, -1: there is none. */
static int find_fluid(const tobi_system *s, const char *name)
{
    for (int k = 0; k < s->fluid_count; k++)
        if (strcmp(s->fluid[k].name, name) == 0) return k;
    return -1;
}

tobi_status tobi_world_add_interface(tobi_world *w, const tobi_interface_def *def, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    TOBI_NEED(def, "the definition");
    TOBI_NEED(def->fluid && def->to_fluid, "the name of a fluid");
    TOBI_TRY(tobi_param_check(&tobi_interface_table, def, err));
    if (w->started) return tobi_fail(err, TOBI_INVALID, "a started world takes no more interfaces");
    tobi_system *s = &w->system[0];
    const int a = find_fluid(s, def->fluid), b = find_fluid(s, def->to_fluid);
    if (a < 0 || b < 0)
        return tobi_fail(err, TOBI_INVALID, "interface: '%s' is no fluid of the world",
                         a < 0 ? def->fluid : def->to_fluid);
    if (a == b) return tobi_fail(err, TOBI_INVALID, "interface: '%s' is on both sides", def->fluid);
    s->fluid[a].interface_tension[b] = s->fluid[b].interface_tension[a] = def->tension;
    return TOBI_OK;
}
