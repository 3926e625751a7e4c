/* What a scene says about its tank as a whole: gravity in time, a central force, the frame that it is seen
   from, damping zones, porous zones. */
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

static void bind_zones(tobi_scene_tank *t, const tobi_binder *binder, json_t *list, const tobi_place *root)
{
    const tobi_place place = { root, "damping_zones", 0 };
    if (!json_is_array(list) || json_array_size(list) > TOBI_ZONES) {
        tobi_source_mistake(binder->source, &place, "must be a list [ { ... } ] of %d zones at most",
                            TOBI_ZONES);
        return;
    }
    for (size_t i = 0; i < json_array_size(list); i++) {
        const tobi_place entry = { &place, NULL, i };
        t->damping[i] = tobi_default_damping_def();
        tobi_bind(binder, &tobi_damping_table, json_array_get(list, i), &entry, NULL, &t->damping[i]);
        t->damping_count++;
    }
}

static void bind_porous(tobi_scene_tank *t, const tobi_binder *binder, json_t *list, const tobi_place *root)
{
    const tobi_place place = { root, "porous_zones", 0 };
    if (!json_is_array(list) || json_array_size(list) > TOBI_POROUS_LIMIT) {
        tobi_source_mistake(binder->source, &place, "must be a list [ { ... } ] of %d zones at most",
                            TOBI_POROUS_LIMIT);
        return;
    }
    for (size_t i = 0; i < json_array_size(list); i++) {
        const tobi_place entry = { &place, NULL, i };
        t->porous[i] = tobi_default_porous_def();
        tobi_bind(binder, &tobi_porous_table, json_array_get(list, i), &entry, NULL, &t->porous[i]);
        t->porous_count++;
    }
}

void tobi_tank_bind(tobi_scene_tank *t, const tobi_binder *binder, json_t *scene, const tobi_place *root)
{
    const tobi_place gravity = { root, "gravity_in_time", 0 }, centre = { root, "central_force", 0 };
    json_t *changes = json_object_get(scene, "gravity_in_time"), *frame = json_object_get(scene, "frame");
    json_t *zones = json_object_get(scene, "damping_zones");
    json_t *porous = json_object_get(scene, "porous_zones");
    json_t *central = json_object_get(scene, "central_force");
    t->gravity = tobi_default_gravity_def();
    t->central = tobi_default_central_def();
    if (changes) bind_gravity(t, binder, changes, &gravity);
    if (central) tobi_bind(binder, &tobi_central_table, central, &centre, NULL, &t->central);
    if (frame) bind_frame(t, binder, frame, root);
    if (zones) bind_zones(t, binder, zones, root);
    if (porous) bind_porous(t, binder, porous, root);
}

tobi_status tobi_tank_build(const tobi_scene_tank *t, tobi_world *world, tobi_error *err)
{
    if (t->changes) TOBI_TRY(tobi_world_set_gravity_in_time(world, &t->gravity, err));
    if (t->central.rate > 0) TOBI_TRY(tobi_world_set_central_force(world, &t->central, err));
    return t->frame ? tobi_world_set_frame(world, tobi_motion_positions, t->frame, err) : TOBI_OK;
}

static int write_zones(const tobi_scene_tank *t, json_t *root)
{
    json_t *zones = json_array(), *porous = json_array();
    int failed = !zones || !porous;
    for (int k = 0; k < t->damping_count; k++)
        failed |= json_array_append_new(zones, tobi_write_def(&tobi_damping_table, &t->damping[k]));
    for (int k = 0; k < t->porous_count; k++) {
        json_t *zone = tobi_write_def(&tobi_porous_table, &t->porous[k]);
        const int outline = tobi_outline_given(&t->porous[k].outline);
        const int round = t->porous[k].cylinder_radius > 0;
        if (outline || round) json_object_del(zone, "box");
        if (!outline) json_object_del(zone, "outline");
        if (!round) json_object_del(zone, "cylinder");
        failed |= json_array_append_new(porous, zone);
    }
    if (t->damping_count) failed |= json_object_set(root, "damping_zones", zones);
    if (t->porous_count) failed |= json_object_set(root, "porous_zones", porous);
    json_decref(zones);
    json_decref(porous);
    return failed;
}

int tobi_tank_write(const tobi_scene_tank *t, json_t *root)
{
    int failed = write_zones(t, root);
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
