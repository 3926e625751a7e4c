/* The files that a scene is read from besides its own: meshes, pictures, scripts, tables, objects
   of the tank program. The parameter tables say which members are paths. Drawback: each call walks there. */
#include "scene/scene.h"
#include "base/param.h"
#include <string.h>

typedef struct search { int left; const char *found; } search;

static void look_at(search *s, const char *path)
{
    if (path && path[0] && s->left-- == 0) s->found = path;
}

static void look_in(search *s, const tobi_param_table *table, const void *def)
{
    for (const tobi_param *row = table->rows; row->key; row++) {
        const char *path;
        if (row->type != TOBI_PARAM_TEXT || strcmp(row->unit, "path") != 0) continue;
        memcpy(&path, (const char *)def + row->offset, sizeof path);
        look_at(s, path);
    }
}

static void look_in_motion(search *s, const tobi_motion_def *def)
{
    for (int k = 0; k < TOBI_MOTION_LIMIT && def[k].table; k++) look_in(s, def[k].table, &def[k].as);
}

static void look_in_fills(search *s, const tobi_scene_fill *fills, int count)
{
    for (int k = 0; k < count; k++) {
        look_in(s, &tobi_fill_table, &fills[k].def);
        look_at(s, fills[k].flow_def.script);
    }
}

const char *tobi_scene_file(const tobi_scene *scene, int index)
{
    search s = { index, NULL };
    if (!scene || index < 0) return NULL;
    for (size_t k = 0; k < json_array_size(scene->object_files); k++)
        look_at(&s, json_string_value(json_array_get(scene->object_files, k)));
    for (int k = 0; k < scene->body_count; k++) {
        const tobi_scene_body *body = &scene->bodies[k];
        look_in(&s, &tobi_body_table, &body->def);
        look_in_motion(&s, body->motion_def);
        look_at(&s, body->control_def.script);
    }
    for (int k = 0; k < scene->fluid_count; k++)
        look_in_fills(&s, scene->fluids[k].fills, scene->fluids[k].fill_count);
    for (int k = 0; k < scene->solid_count; k++) {
        look_in(&s, &tobi_solid_table, &scene->solids[k].def);
        look_in_fills(&s, scene->solids[k].fills, scene->solids[k].fill_count);
    }
    for (int k = 0; k < scene->joint_count; k++) look_in(&s, &tobi_joint_table, &scene->joints[k]);
    for (int k = 0; k < scene->inlet_count; k++) look_in(&s, &tobi_inlet_table, &scene->inlets[k]);
    if (scene->tank.changes) look_in(&s, &tobi_gravity_table, &scene->tank.gravity);
    for (int k = 0; k < scene->tank.porous_count; k++)
        look_in(&s, &tobi_porous_table, &scene->tank.porous[k]);
    look_in_motion(&s, scene->tank.frame_def);
    return s.found;
}
