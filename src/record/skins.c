/* Images on bodies and solids, for pictures: of bodies the coordinates of all corners, of solids copies of
   the textures of the meshes that fill them, in which places at rest are looked up. Drawback: looks hold the
   coordinates of meshes once more. */
#include "geom/texture.h"
#include "record/record.h"
#include "world/world.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What a solid's meshes have. */
typedef struct skin_list { int count; tobi_texture *texture[]; } skin_list;

static void free_list(void *user)
{
    skin_list *list = user;
    for (int k = 0; list && k < list->count; k++) tobi_texture_free(list->texture[k]);
    free(list);
}

static double look(const void *user, const double x[3], float uv[2])
{
    const skin_list *list = user;
    double nearest = INFINITY;
    uv[0] = uv[1] = 0;
    for (int k = 0; k < list->count; k++) {
        float found[2];
        const double distance = tobi_texture_look(list->texture[k], x, found);
        if (!(distance < nearest)) continue;
        nearest = distance;
        uv[0] = found[0], uv[1] = found[1];
    }
    return nearest;
}

static void look_flat(const void *user, const double corner[3][3], float uv[3][2])
{
    const skin_list *list = user;
    double middle[3], nearest = INFINITY;
    int best = 0;
    for (int a = 0; a < 3; a++) middle[a] = (corner[0][a] + corner[1][a] + corner[2][a])/3;
    for (int k = 0; k < list->count && list->count > 1; k++) {
        float unused[2];
        const double distance = tobi_texture_look(list->texture[k], middle, unused);
        if (distance < nearest) nearest = distance, best = k;
    }
    tobi_texture_look_flat(list->texture[best], corner, uv);
}

static tobi_status add_texture(skin_list *list, const tobi_texture *texture, double *stretch, tobi_error *err)
{
    double own;
    TOBI_TRY(tobi_texture_stretch(texture, &own, err));
    TOBI_TRY(tobi_texture_copy(texture, &list->texture[list->count], err));
    list->count++;
    *stretch = fmax(*stretch, own);
    return TOBI_OK;
}

tobi_status tobi_skins_of_solid(const tobi_world *w, int solid, int material, tobi_looks *looks,
                                tobi_error *err)
{
    const double depth_in_spacings = 0.8;
    tobi_material_look *m = &looks->materials[material];
    tobi_picture_skin *skin = &m->skin;
    tobi_image *image = tobi_world_solid_image(w, solid);
    const tobi_system *s = tobi_world_solids(w);
    if (!image) return TOBI_OK;
    skin_list *list = calloc(1, sizeof *list + (size_t)w->region_count*sizeof *list->texture);
    if (!list) return tobi_fail(err, TOBI_NO_MEMORY, "picture: out of memory");
    m->skin_user = list;
    m->free_skin = free_list;
    for (int k = 0; k < w->region_count; k++) {
        const tobi_region *r = &w->regions[k];
        if (&w->system[r->system] != s || r->owner != s->fluid_count + solid || !r->shape.texture) continue;
        TOBI_TRY(add_texture(list, r->shape.texture, &skin->stretch, err));
    }
    if (list->count == 0) return TOBI_OK;
    skin->look = look;
    skin->look_flat = look_flat;
    skin->user = list;
    skin->depth = depth_in_spacings*m->spacing;
    skin->image = m->image = tobi_image_share(image);
    return TOBI_OK;
}

tobi_status tobi_skins_of_body(const tobi_world *w, int body, tobi_body_look *look, tobi_error *err)
{
    tobi_image *image = tobi_world_body_image(w, body);
    tobi_mesh mesh = w->sim.bodies[body].mesh;      /* borrowed */
    tobi_skin skin;
    tobi_texture *texture;
    if (!image || !mesh.texture) return TOBI_OK;
    TOBI_TRY(tobi_texture_copy(mesh.texture, &texture, err));
    mesh.texture = texture;
    tobi_status status = tobi_skin_build(&mesh, &skin, err);
    tobi_texture_free(texture);
    TOBI_TRY(status);
    look->uv = malloc(((size_t)mesh.triangle_count + 1)*sizeof *look->uv);
    for (int64_t t = 0; look->uv && t < mesh.triangle_count; t++)
        for (int k = 0; k < 3; k++)
            memcpy(look->uv[t][k], skin.uv[skin.triangles[t][k]], sizeof look->uv[t][k]);
    tobi_skin_free(&skin);
    if (!look->uv) return tobi_fail(err, TOBI_NO_MEMORY, "picture: out of memory");
    look->triangle_count = mesh.triangle_count;
    look->image = tobi_image_share(image);
    return TOBI_OK;
}
