/* A scene with all that it resolves to: every key with its value, as resolved.json has it. Only what
   counts is written, so that a scene read from it is the same. */
#include "scene/scene.h"
#include "scene/controls.h"
#include "scene/motions.h"
#include "scene/openings.h"
#include "scene/write.h"
#include "base/param.h"
#include "geom/outline.h"
#include <stdlib.h>

/* jansson's calls answer a NULL argument or a lack of memory with -1, so that one flag gathers all. */
static json_t *whole(json_t *value, int failed)
{
    if (!failed) return value;
    json_decref(value);
    return NULL;
}

/* The regions of an object, each with the keys of its own shape alone. */
static json_t *write_fills(json_t *object, const tobi_scene_fill *fills, int count)
{
    json_t *list = json_array();
    int failed = 0;
    for (int i = 0; i < count; i++) {
        const tobi_fill_def *def = &fills[i].def;
        json_t *fill = tobi_write_def(&tobi_fill_table, def);
        const int outline = tobi_outline_given(&def->outline), shaped = def->mesh || outline;
        if (shaped || def->vessel || def->radius > 0) json_object_del(fill, "box");
        if (shaped || !(def->radius > 0)) json_object_del(fill, "sphere");
        if (!outline) json_object_del(fill, "outline");
        for (int k = 0; !shaped && k < 3; k++)
            json_object_del(fill, (const char *[]){ "scale", "translation", "rotation" }[k]);
        json_t *flow = fills[i].flow ? tobi_control_write(TOBI_FLOW_SCRIPT, &fills[i].flow_def) : NULL;
        if (fills[i].flow) failed |= json_object_set_new(fill, "flow", flow);
        failed |= json_array_append_new(list, fill);
    }
    failed |= json_object_set_new(object, "fill", list);
    return whole(object, failed);
}

static json_t *write_fluid(const tobi_scene_fluid *fluid)
{
    return write_fills(tobi_write_def(&tobi_fluid_table, &fluid->def), fluid->fills, fluid->fill_count);
}

/* What counts: density or mass, and the constants of its model. */
static json_t *write_solid(const tobi_scene *scene, const tobi_scene_solid *solid)
{
    json_t *object = tobi_write_def(&tobi_solid_table, &solid->def);
    tobi_unused_drop(scene, &tobi_solid_table, &solid->def, object);
    json_object_del(object, solid->def.mass > 0 ? "density" : "mass");
    for (const tobi_param *row = tobi_solid_table.rows; row->key; row++)
        if (!tobi_solid_uses(solid->def.model, row->key)) json_object_del(object, row->key);
    return write_fills(object, solid->fills, solid->fill_count);
}

/* Of the shapes only the body's own is written. */
static void drop_shapes(const tobi_body_def *def, json_t *object)
{
    const struct { const char *key; int has; } shapes[] = {
        { "mesh", def->mesh != NULL }, { "sphere", def->sphere_radius > 0 },
        { "cylinder", def->cylinder_radius > 0 }, { "capsule", def->capsule_radius > 0 },
        { "plate", def->plate_thickness > 0 }, { "knife", def->knife_thickness > 0 },
        { "outline", tobi_outline_given(&def->outline) }, { "terrain", def->terrain_file != NULL } };
    int box = 1;
    for (size_t k = 0; k < sizeof shapes/sizeof *shapes; k++) {
        if (!shapes[k].has) json_object_del(object, shapes[k].key);
        box &= !shapes[k].has;
    }
    if (!box) json_object_del(object, "box");
}

static int is_zero(const double v[3]) { return v[0] == 0 && v[1] == 0 && v[2] == 0; }

static json_t *write_body(const tobi_scene *scene, const tobi_scene_body *body)
{
    json_t *object = tobi_write_def(&tobi_body_table, &body->def);
    int failed = 0;
    tobi_unused_drop(scene, &tobi_body_table, &body->def, object);
    drop_shapes(&body->def, object);
    if (!tobi_motor_is_given(&body->def.hinge_motor))
        json_object_del(json_object_get(object, "hinge"), "motor");
    if (!tobi_motor_is_given(&body->def.guide_motor))
        json_object_del(json_object_get(object, "guide"), "motor");
    if (is_zero(body->def.hinge_axis)) json_object_del(object, "hinge");
    if (is_zero(body->def.guide_axis)) json_object_del(object, "guide");
    if (body->motion_def[0].table)
        failed = json_object_set_new(object, "motion", tobi_motion_write(body->motion_def));
    if (body->control)
        failed |= json_object_set_new(object, "control",
                                      tobi_control_write(TOBI_CONTROL_SCRIPT, &body->control_def));
    return whole(object, failed);
}

char *tobi_scene_resolved(const tobi_scene *scene)
{
    if (!scene) return NULL;
    json_t *root = tobi_write_def(&tobi_world_table, &scene->world);
    json_t *method = tobi_write_def(scene->method, scene->method_def);
    tobi_unused_drop(scene, &tobi_world_table, NULL, root);
    tobi_unused_drop(scene, scene->method, NULL, method);
    json_t *fluids = json_array(), *solids = json_array(), *bodies = json_array(), *planes = json_array(),
           *probes = json_array(), *references = json_array();
    int failed = json_object_set_new(root, scene->method->name, method);
    const int both = tobi_scene_has_both(scene);
    const tobi_param_table *of_solids = tobi_method_table(TOBI_METHOD_OF_SOLIDS);
    json_t *beside = both ? tobi_write_def(of_solids, &scene->solids_def) : NULL;
    if (both) failed |= json_object_set_new(root, TOBI_METHOD_OF_SOLIDS, beside);
    for (int i = 0; i < scene->fluid_count; i++)
        failed |= json_array_append_new(fluids, write_fluid(&scene->fluids[i]));
    for (int i = 0; i < scene->solid_count; i++)
        failed |= json_array_append_new(solids, write_solid(scene, &scene->solids[i]));
    for (int i = 0; i < scene->body_count; i++)
        failed |= json_array_append_new(bodies, write_body(scene, &scene->bodies[i]));
    for (int i = 0; i < scene->plane_count; i++)
        failed |= json_array_append_new(planes, tobi_write_def(&tobi_plane_table, &scene->planes[i]));
    for (int i = 0; i < scene->probe_count; i++) {
        json_t *probe = tobi_write_def(&tobi_probe_table, &scene->probes[i]);
        tobi_probe_drop_unread(&scene->probes[i], probe);
        failed |= json_array_append_new(probes, probe);
    }
    for (int i = 0; i < scene->reference_count; i++)
        failed |= json_array_append_new(
            references, tobi_write_def(&tobi_reference_table, &scene->references[i]));
    if (scene->fluid_count) failed |= json_object_set(root, "fluids", fluids);
    if (scene->solid_count) failed |= json_object_set(root, "solids", solids);
    failed |= json_object_set_new(root, "bodies", bodies);
    failed |= tobi_tank_write(&scene->tank, root);
    if (scene->plane_count) failed |= json_object_set(root, "planes", planes);
    failed |= tobi_interfaces_write(scene, root) | tobi_openings_write(scene, root);
    if (scene->line_count) failed |= json_object_set_new(root, "lines", tobi_lines_write_json(scene));
    if (scene->joint_count) failed |= json_object_set_new(root, "joints", tobi_joint_list_write_json(scene));
    if (scene->probe_count) failed |= json_object_set(root, "probes", probes);
    failed |= json_object_set_new(root, "output", tobi_output_write(scene));
    if (scene->reference_count) failed |= json_object_set(root, "references", references);
    json_decref(fluids);
    json_decref(solids);
    json_decref(planes);
    json_decref(probes);
    json_decref(references);
    root = whole(root, failed);
    char *text = root ? tobi_write_json(root) : NULL;
    json_decref(root);
    return text;
}
