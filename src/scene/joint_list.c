/* The joints between bodies of a scene. Drawback: which bodies deform, the world alone sees. */
#include "scene/scene.h"
#include "scene/parts.h"
#include "scene/write.h"
#include "base/param.h"
#include <stdlib.h>
#include <string.h>

tobi_status tobi_joint_list_bind(tobi_scene *scene, const tobi_binder *binder, const tobi_place *of)
{
    tobi_place place = { of, "joints", 0 };
    json_t *list = tobi_scene_list(binder, scene->root, &place, "world");
    if (!list) return TOBI_OK;
    scene->joints = calloc(json_array_size(list) + 1, sizeof *scene->joints);
    if (!scene->joints) return TOBI_NO_MEMORY;
    for (size_t i = 0; i < json_array_size(list); i++) {
        tobi_place entry = { &place, NULL, i };
        tobi_joint_def *joint = &scene->joints[scene->joint_count++];
        *joint = tobi_default_joint_def();
        tobi_bind(binder, &tobi_joint_table, json_array_get(list, i), &entry, NULL, joint);
    }
    return TOBI_OK;
}

static void check_bodies(const tobi_scene *scene, tobi_source *source, const tobi_joint_def *joint,
                         const tobi_place *entry)
{
    tobi_place body = { entry, "body", 0 }, to_body = { entry, "to_body", 0 };
    const tobi_body_def *held = joint->body ? tobi_scene_find_body(scene, joint->body) : NULL;
    const tobi_body_def *other = joint->to_body ? tobi_scene_find_body(scene, joint->to_body) : NULL;
    if (joint->body && !held)
        tobi_source_mistake(source, &body, "\"%s\" is no body of the scene", joint->body);
    if (held && held->dynamics == TOBI_PRESCRIBED)
        tobi_source_mistake(source, &body, "\"%s\" is prescribed; a joint holds a free or controlled body, "
                            "and may go to a prescribed one", joint->body);
    if (joint->to_body && !other)
        tobi_source_mistake(source, &to_body, "\"%s\" is no body of the scene", joint->to_body);
    else if (joint->to_body && joint->body && strcmp(joint->body, joint->to_body) == 0)
        tobi_source_mistake(source, &to_body, "is the body at the other side too");
    if (other && other->absent_from > 0)
        tobi_source_mistake(source, &to_body, "\"%s\" is absent at times; a joint holds bodies that stay",
                            joint->to_body);
}

static const char *const kinds[] = { "hinge", "ball", "fixed", "slide" };

static void check_axis(const tobi_scene *scene, tobi_source *source, const tobi_joint_def *joint,
                       const tobi_place *entry)
{
    tobi_place axis = { entry, "axis", 0 };
    const double *a = joint->axis;
    const int given = a[0] != 0 || a[1] != 0 || a[2] != 0;
    if (joint->kind == TOBI_BETWEEN_SLIDE && !given)
        tobi_source_mistake(source, entry, "must have an axis, along which the body slides");
    else if (joint->kind == TOBI_BETWEEN_SLIDE && scene->world.dimension == 2 && a[2] != 0)
        tobi_source_mistake(source, &axis, "is %.10g in z, must be 0 in a 2-D scene", a[2]);
    else if (joint->kind == TOBI_BETWEEN_SLIDE) return;
    else if (joint->kind != TOBI_BETWEEN_HINGE && given)
        tobi_source_mistake(source, &axis, "is of a hinge or slide, a %s joint has none", kinds[joint->kind]);
    else if (scene->world.dimension == 2 && (a[0] != 0 || a[1] != 0))
        tobi_source_mistake(source, &axis, "must be along z in a 2-D scene");
    else if (scene->world.dimension == 3 && joint->kind == TOBI_BETWEEN_HINGE && !given)
        tobi_source_mistake(source, entry, "must have an axis, or be of kind ball");
}

/* Keys of the motor of a guide at a hinge, or those of a hinge at a slide: each pair is one number. */
static int check_motor_keys(const tobi_scene *scene, tobi_source *source, const tobi_joint_def *joint,
                            int number, const tobi_place *motor)
{
    static const char *const keys[2][3] = { { "angle", "torque", "torque_max" },
                                            { "position", "force", "force_max" } };
    const json_t *list = json_object_get(scene->root, "joints");
    const json_t *given = json_object_get(json_array_get(list, (size_t)number), "motor");
    const int slides = joint->kind == TOBI_BETWEEN_SLIDE;
    int good = 1;
    for (int k = 0; k < 3; k++) {
        tobi_place place = { motor, keys[!slides][k], 0 };
        if (!json_object_get(given, keys[!slides][k])) continue;
        tobi_source_mistake_at_key(source, &place, "is of a %s, a %s has %s", slides ? "hinge" : "slide",
                                   slides ? "slide" : "hinge", keys[slides][k]);
        good = 0;
    }
    return good;
}

/* A motor that cannot be one, or where none can be. */
static void check_motor(const tobi_scene *scene, tobi_source *source, const tobi_joint_def *joint,
                        int number, const tobi_place *entry)
{
    const int slides = joint->kind == TOBI_BETWEEN_SLIDE;
    const int acts = slides || joint->kind == TOBI_BETWEEN_HINGE ||
                      (joint->kind == TOBI_BETWEEN_BALL && scene->world.dimension == 2);
    tobi_place motor = { entry, "motor", 0 };
    if (!acts && tobi_motor_is_given(&joint->motor))
        tobi_source_mistake_at_key(source, &motor, "is of a hinge or slide, a %s joint has none",
                                   kinds[joint->kind]);
    else if (check_motor_keys(scene, source, joint, number, &motor))
        tobi_joints_check_motor(source, &joint->motor, slides ? 2 : 0, &motor);
}

static void check_hinge(const tobi_scene *scene, tobi_source *source, const tobi_joint_def *joint,
                        const tobi_place *entry)
{
    static const char *const keys[] = { "lower", "upper", "stiffness", "damping" };
    const double values[] = { joint->lower, joint->upper, joint->stiffness, joint->damping };
    for (int k = 0; k < 4; k++) {
        tobi_place place = { entry, keys[k], 0 };
        const int ball = scene->world.dimension == 3 && joint->kind == TOBI_BETWEEN_BALL;
        if ((ball || joint->kind == TOBI_BETWEEN_FIXED) && values[k] != 0)
            tobi_source_mistake(source, &place, "is of a hinge or slide, a %s joint has none",
                                kinds[joint->kind]);
    }
    tobi_place rest = { entry, "rest", 0 };
    if (joint->rest != 0 && !(joint->stiffness > 0))
        tobi_source_mistake(source, &rest, "is of a spring, which needs a stiffness");
}

void tobi_joint_list_check(const tobi_scene *scene, tobi_source *source)
{
    static const tobi_place root = { 0 };
    tobi_place joints = { &root, "joints", 0 };
    for (int i = 0; i < scene->joint_count && !tobi_report_full(source->report); i++) {
        const tobi_joint_def *joint = &scene->joints[i];
        tobi_place entry = { &joints, NULL, (size_t)i };
        tobi_check_name(scene, source, &entry);
        check_bodies(scene, source, joint, &entry);
        check_axis(scene, source, joint, &entry);
        check_hinge(scene, source, joint, &entry);
        check_motor(scene, source, joint, i, &entry);
    }
}

json_t *tobi_joint_list_write_json(const tobi_scene *scene)
{
    json_t *list = json_array();
    int failed = 0;
    for (int k = 0; k < scene->joint_count; k++) {
        json_t *joint = tobi_write_def(&tobi_joint_table, &scene->joints[k]);
        json_t *motor = json_object_get(joint, "motor");
        const int slides = scene->joints[k].kind == TOBI_BETWEEN_SLIDE;
        json_object_del(motor, slides ? "angle" : "position");           /* both names of one number */
        json_object_del(motor, slides ? "torque" : "force");
        json_object_del(motor, slides ? "torque_max" : "force_max");
        if (!tobi_motor_is_given(&scene->joints[k].motor)) json_object_del(joint, "motor");
        failed |= json_array_append_new(list, joint);
    }
    if (!failed) return list;
    json_decref(list);
    return NULL;
}
