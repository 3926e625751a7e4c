/* Texture coordinates of particles: of where they started, on the meshes that fill their solid. And images on
   bodies and solids. Drawback: an image that two bodies have is read twice. */
#include "base/error.h"
#include "geom/texture.h"
#include "mpm/particle_fields.h"
#include "tobiuo/picture.h"
#include "world/world.h"
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

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

tobi_status tobi_world_read_image(tobi_world *w, const char *kind, const char *name, const char *path,
                                  const struct tobi_texture *coordinates, tobi_error *err)
{
    const tobi_system *solids = tobi_world_solids(w);
    const bool body = strcmp(kind, "body") == 0;
    struct tobi_image ***list = body ? &w->body_image : &w->solid_image;
    int *room = body ? &w->body_images : &w->solid_images;
    const int number = body ? w->sim.body_count : solids ? solids->solid_count : 0;
    if (!path) return TOBI_OK;
    if (body && w->sim.def.dimension == 2 && w->sim.bodies[number].vessel)
        return tobi_at_key(err, tobi_fail(err, TOBI_UNSUPPORTED, "body '%s' is a vessel in 2-D, which "
                                          "pictures show as an outline: it has no texture", name), "texture");
    if (!coordinates)
        return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "%s '%s' has a texture, but no mesh with "
                                          "texture coordinates (vt of an OBJ file)", tr(kind), name),
                                          "texture");
    if (number >= *room) {
        struct tobi_image **more = realloc(*list, (size_t)(number + 1)*sizeof *more);
        if (!more) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the texture of '%s'", name);
        for (*list = more; *room <= number;) more[(*room)++] = NULL;
    }
    return tobi_at_key(err, tobi_image_read(path, &(*list)[number], err), "texture");
}

struct tobi_image *tobi_world_body_image(const tobi_world *w, int body)
{
    return body < w->body_images ? w->body_image[body] : NULL;
}

struct tobi_image *tobi_world_solid_image(const tobi_world *w, int solid)
{
    return solid < w->solid_images ? w->solid_image[solid] : NULL;
}

void tobi_world_free_images(tobi_world *w)
{
    for (int k = 0; k < w->body_images; k++) tobi_image_free(w->body_image[k]);
    for (int k = 0; k < w->solid_images; k++) tobi_image_free(w->solid_image[k]);
    free(w->body_image);
    free(w->solid_image);
}
