/* The world's probes: added by definition, read by number. */
#include "base/error.h"
#include "sph/probe.h"
#include "base/param.h"
#include "world/world.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

tobi_status tobi_world_add_probe(tobi_world *w, const tobi_probe_def *def, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    TOBI_NEED(def, "the definition");
    TOBI_NEED(def->name, "the name of the probe");
    const tobi_box *box = &w->system[0].box;
    TOBI_TRY(tobi_param_check(&tobi_probe_table, def, err));
    for (int a = 0; a < box->dimension; a++)
        if (!(def->position[a] >= box->lower[a] && def->position[a] <= box->lower[a] + box->size[a]))
            return tobi_fail(err, TOBI_INVALID,
                             "probe '%s' sits outside the domain: %c = %g m, allowed is %g to %g m",
                             def->name, "xyz"[a], def->position[a], box->lower[a],
                             box->lower[a] + box->size[a]);
    if (w->probe_count == TOBI_PROBE_LIMIT)
        return tobi_fail(err, TOBI_UNSUPPORTED, "more than %d probes", TOBI_PROBE_LIMIT);
    tobi_probe *more = realloc(w->probes, (size_t)(w->probe_count + 1)*sizeof *more);
    if (!more) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a probe");
    w->probes = more;
    tobi_probe *p = &w->probes[w->probe_count++];
    *p = (tobi_probe){ .kind = def->kind };
    snprintf(p->name, sizeof p->name, "%s", def->name);
    memcpy(p->position, def->position, sizeof p->position);
    return TOBI_OK;
}

int tobi_world_probe_count(const tobi_world *w) { return w ? w->probe_count : 0; }

const char *tobi_world_probe_name(const tobi_world *w, int probe, tobi_probe_kind *kind)
{
    if (!w || probe < 0 || probe >= w->probe_count) return NULL;
    if (kind) *kind = (tobi_probe_kind)w->probes[probe].kind;
    return w->probes[probe].name;
}

void tobi_world_measure_probe(const tobi_world *w, int probe, tobi_probe_info *info)
{
    const tobi_probe *p = &w->probes[probe];
    memset(info, 0, sizeof *info);
    if (p->kind == TOBI_PROBE_LEVEL) info->level = tobi_probe_level(&w->system[0], p->position);
    else tobi_probe_point(&w->system[0], p->position, &info->pressure, info->velocity);
}

tobi_status tobi_world_probe(tobi_world *w, int probe, tobi_probe_info *info, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    TOBI_NEED(info, "where the values go");
    if (probe < 0 || probe >= w->probe_count)
        return tobi_fail(err, TOBI_NOT_FOUND, "there is no probe %d", probe);
    TOBI_TRY(tobi_world_refresh(w, err));
    tobi_world_measure_probe(w, probe, info);
    return TOBI_OK;
}
