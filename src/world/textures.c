/* Texture coordinates of particles: of where they started, on the meshes that fill their solid. */
#include "base/error.h"
#include "geom/texture.h"
#include "mpm/particle_fields.h"
#include "world/world.h"
#include <math.h>
#include <stdlib.h>

int tobi_world_has_textures(const tobi_world *w)
{
    int found = 0;
    for (int k = 0; k < w->region_count; k++) found |= w->regions[k].shape.texture != NULL;
    return found && tobi_world_solids(w) != NULL;
}

/* The nearest surface of all meshes that fill the particle's solid. */
static void look(const tobi_world *w, const tobi_system *s, int64_t i, float uv[2])
{
    const tobi_particles *p = &s->particles;
    const double *lower = s->box.lower;
    const tobi_float4 *rest = &mpm_fields_of(p)->rest[i];
    const double x[3] = {rest->x + lower[0], rest->y + lower[1], rest->z + lower[2]};
    double nearest = INFINITY;
    uv[0] = uv[1] = 0;
    for (int k = 0; k < w->region_count; k++) {
        const tobi_region *r = &w->regions[k];
        float found[2];
        if (&w->system[r->system] != s || r->owner != p->fluid[i] || !r->shape.texture) continue;
        double distance = tobi_texture_look(r->shape.texture, x, found);
        if (!(distance < nearest)) continue;
        nearest = distance;
        uv[0] = found[0];
        uv[1] = found[1];
    }
}

typedef struct looking { const tobi_world *w; const tobi_system *s; } looking;

static void look_range(const void *view, int64_t begin, int64_t end)
{
    const looking *l = view;
    for (int64_t i = begin; i < end; i++) look(l->w, l->s, i, l->w->texture[l->s->particles.id[i]]);
}

tobi_status tobi_world_find_texture(tobi_world *w, tobi_error *err)
{
    if (w->texture || !tobi_world_has_textures(w)) return TOBI_OK;
    const tobi_system *s = tobi_world_solids(w);
    const tobi_particles *p = &s->particles;
    for (int k = 0; k < w->region_count; k++)
        if (w->regions[k].shape.texture) TOBI_TRY(tobi_texture_prepare(w->regions[k].shape.texture, err));
    w->texture = calloc((size_t)p->next_id + 1, sizeof *w->texture);
    if (!w->texture)
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld texture coordinates", (long long)p->count);
    const looking view = { w, s };
    tobi_loop(w->sim.exec.threads, p->count, 0, look_range, &view);
    return TOBI_OK;
}
