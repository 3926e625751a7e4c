/* What a scene says about its tank as a whole: gravity in time, a central force, the frame that it is seen
   from, damping zones, porous zones, temperature and concentration. */
#include "scene/tank.h"
#include "scene/write.h"
#include "base/param.h"
#include "geom/outline.h"
#include <stdlib.h>

static void bind_gravity(tobi_scene_tank *t, const tobi_binder *binder, json_t *value,
                         const tobi_place *place)
{
    tobi_error why = { 0 };
    const tobi_bound bound = tobi_bind(binder, &tobi_gravity_table, value, place, NULL, &t->gravity);
    t->changes = 1;
    if (bound.given != bound.good || tobi_gravity_check(&t->gravity, &why) == TOBI_OK) return;
    tobi_source_mistake(binder->source, place, "%s", why.text);
}

static void bind_frame(tobi_scene_tank *t, const tobi_binder *binder, json_t *value, const tobi_place *root)
{
    const tobi_place place = { root, "frame", 0 };
    t->frame = tobi_motion_bind(binder, value, &place, t->frame_def);
    if (!t->frame || tobi_motion_is_rigid(t->frame)) return;
    tobi_source_mistake(binder->source, &place, "changes its shape; the motion of a frame is rigid");
}

/* A list of the scene into definitions of one size; their number. */
typedef struct listing { const char *key, *noun; const tobi_param_table *table; int limit; } listing;

static int bind_list(const listing *l, void *defs, const tobi_binder *binder, json_t *scene,
                     const tobi_place *root)
{
    const tobi_place place = { root, l->key, 0 };
    json_t *list = json_object_get(scene, l->key);
    if (!list) return 0;
    if (!json_is_array(list) || json_array_size(list) > (size_t)l->limit) {
        tobi_source_mistake(binder->source, &place, "must be a list [ { ... } ] of %d %s at most", l->limit,
                            tr(l->noun));
        return 0;
    }
    for (size_t i = 0; i < json_array_size(list); i++) {
        const tobi_place entry = { &place, NULL, i };
        void *def = (char *)defs + i*l->table->size;
        tobi_param_defaults(l->table, def);
        tobi_bind(binder, l->table, json_array_get(list, i), &entry, NULL, def);
    }
    return (int)json_array_size(list);
}

static int write_list(const listing *l, const void *defs, int count, json_t *root)
{
    json_t *list = json_array();
    int failed = !list;
    for (int k = 0; k < count; k++)
        failed |= json_array_append_new(list, tobi_write_def(l->table, (const char *)defs +
                                                                           (size_t)k*l->table->size));
    if (count) failed |= json_object_set(root, l->key, list);
    json_decref(list);
    return failed;
}

static const listing damping = { "damping_zones", TR("zones"), &tobi_damping_table, TOBI_ZONES },
                     porous = { "porous_zones", TR("zones"), &tobi_porous_table, TOBI_POROUS_LIMIT },
                     nests = { "nests", TR("nests"), &tobi_nest_table, TOBI_NEST_LIMIT },
                     scalars = { "scalars", TR("scalars"), &tobi_scalar_table, TOBI_SCALAR_LIMIT },
                     values = { "scalar_values", TR("values"), &tobi_scalar_value_table,
                                TOBI_SCALAR_VALUE_LIMIT };

void tobi_tank_bind(tobi_scene_tank *t, const tobi_binder *binder, json_t *scene, const tobi_place *root)
{
    const tobi_place gravity = { root, "gravity_in_time", 0 }, centre = { root, "central_force", 0 };
    json_t *changes = json_object_get(scene, "gravity_in_time"), *frame = json_object_get(scene, "frame");
    json_t *central = json_object_get(scene, "central_force");
    t->gravity = tobi_default_gravity_def();
    t->central = tobi_default_central_def();
    if (changes) bind_gravity(t, binder, changes, &gravity);
    if (central) tobi_bind(binder, &tobi_central_table, central, &centre, NULL, &t->central);
    if (frame) bind_frame(t, binder, frame, root);
    t->damping_count = bind_list(&damping, t->damping, binder, scene, root);
    t->porous_count = bind_list(&porous, t->porous, binder, scene, root);
    t->nest_count = bind_list(&nests, t->nests, binder, scene, root);
    t->scalar_count = bind_list(&scalars, t->scalars, binder, scene, root);
    t->value_count = bind_list(&values, t->values, binder, scene, root);
}

tobi_status tobi_tank_build(const tobi_scene_tank *t, tobi_world *world, tobi_error *err)
{
    if (t->changes) TOBI_TRY(tobi_world_set_gravity_in_time(world, &t->gravity, err));
    if (t->central.rate > 0) TOBI_TRY(tobi_world_set_central_force(world, &t->central, err));
    return t->frame ? tobi_world_set_frame(world, tobi_motion_positions, t->frame, err) : TOBI_OK;
}

/* A zone is written with what it has of box, outline and cylinder. */
static void drop_shapes(const tobi_scene_tank *t, json_t *zones)
{
    for (int k = 0; k < t->porous_count; k++) {
        json_t *zone = json_array_get(zones, (size_t)k);
        const int outline = tobi_outline_given(&t->porous[k].outline);
        const int round = t->porous[k].cylinder_radius > 0;
        if (outline || round) json_object_del(zone, "box");
        if (!outline) json_object_del(zone, "outline");
        if (!round) json_object_del(zone, "cylinder");
    }
}

/* So is a value that has a box or is elsewhere. */
static void drop_boxes(const tobi_scene_tank *t, json_t *values)
{
    for (int k = 0; k < t->value_count; k++) {
        const tobi_scalar_value_def *v = &t->values[k];
        if (v->fluid || v->inlet || v->body || v->side != TOBI_SIDE_NONE)
            json_object_del(json_array_get(values, (size_t)k), "box");
    }
}

int tobi_tank_write(const tobi_scene_tank *t, json_t *root)
{
    int failed = write_list(&damping, t->damping, t->damping_count, root) |
                 write_list(&porous, t->porous, t->porous_count, root) |
                 write_list(&nests, t->nests, t->nest_count, root) |
                 write_list(&scalars, t->scalars, t->scalar_count, root) |
                 write_list(&values, t->values, t->value_count, root);
    drop_shapes(t, json_object_get(root, "porous_zones"));
    drop_boxes(t, json_object_get(root, "scalar_values"));
    if (t->changes)
        failed |= json_object_set_new(root, "gravity_in_time",
                                      tobi_write_def(&tobi_gravity_table, &t->gravity));
    if (t->central.rate > 0)
        failed |= json_object_set_new(root, "central_force",
                                      tobi_write_def(&tobi_central_table, &t->central));
    if (t->frame) failed |= json_object_set_new(root, "frame", tobi_motion_write(t->frame_def));
    return failed;
}

void tobi_tank_free(tobi_scene_tank *t) { tobi_motion_free(t->frame); }
