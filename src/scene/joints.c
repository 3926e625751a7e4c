/* Hinges and guides of bodies in a scene. Drawback: their rules are said twice, here with line and column,
   and for C programs where a body is made (core/joint.c). */
#include "scene/scene.h"
#include "base/param.h"
#include <string.h>

static int is_zero(const double v[3]) { return v[0] == 0 && v[1] == 0 && v[2] == 0; }

void tobi_joints_complete(const json_t *body, int dimension, tobi_body_def *def)
{
    const json_t *hinge = json_object_get(body, "hinge");
    if (dimension == 2 && hinge && !json_object_get(hinge, "axis")) def->hinge_axis[2] = 1;
}

static void check_axis(tobi_source *source, const tobi_place *joint, const json_t *given,
                       const double axis[3])
{
    tobi_place place = { joint, "axis", 0 };
    if (!json_object_get(given, "axis")) tobi_source_mistake(source, joint, "must have an axis");
    else if (is_zero(axis)) tobi_source_mistake(source, &place, "is zero, must have a direction");
}

static void check_stops(tobi_source *source, const tobi_place *joint, double lower, double upper)
{
    tobi_place low = { joint, "lower", 0 }, high = { joint, "upper", 0 };
    if (lower > 0)
        tobi_source_mistake(source, &low, "is %.10g, must be 0 or below: the body starts at 0", lower);
    if (upper < 0)
        tobi_source_mistake(source, &high, "is %.10g, must be 0 or above: the body starts at 0", upper);
}

void tobi_joints_check_motor(tobi_source *source, const tobi_motor_def *def, int slides,
                             const tobi_place *motor)
{
    tobi_error why = { 0 };
    if (tobi_motor_check(def, slides, &why) == TOBI_OK) return;
    tobi_place key = { motor, why.key, 0 };
    if (why.key[0]) tobi_source_mistake_at_key(source, &key, "%s", why.text);
    else tobi_source_mistake(source, motor, "%s", why.text);
}

static void check_hinge(const tobi_scene *scene, tobi_source *source, const tobi_body_def *def,
                        const json_t *given, const tobi_place *hinge)
{
    tobi_place axis = { hinge, "axis", 0 };
    if (!json_object_get(given, "point")) tobi_source_mistake(source, hinge, "must have a point on its axis");
    if (scene->world.dimension == 3) check_axis(source, hinge, given, def->hinge_axis);
    else if (def->hinge_axis[0] != 0 || def->hinge_axis[1] != 0 || def->hinge_axis[2] == 0)
        tobi_source_mistake(source, &axis, "must be along z in a 2-D scene");
    check_stops(source, hinge, def->hinge_lower, def->hinge_upper);
    tobi_place motor = { hinge, "motor", 0 };
    tobi_joints_check_motor(source, &def->hinge_motor, 0, &motor);
}

static void check_guide(const tobi_scene *scene, tobi_source *source, const tobi_body_def *def,
                        const json_t *given, const tobi_place *guide)
{
    tobi_place axis = { guide, "axis", 0 };
    check_axis(source, guide, given, def->guide_axis);
    if (scene->world.dimension == 2 && def->guide_axis[2] != 0)
        tobi_source_mistake(source, &axis, "is %.10g in z, must be 0 in a 2-D scene", def->guide_axis[2]);
    check_stops(source, guide, def->guide_lower, def->guide_upper);
    tobi_place motor = { guide, "motor", 0 };
    tobi_joints_check_motor(source, &def->guide_motor, 1, &motor);
}

void tobi_joints_check(const tobi_scene *scene, tobi_source *source, int body, const tobi_place *entry)
{
    const tobi_body_def *def = &scene->bodies[body].def;
    const json_t *value = json_array_get(json_object_get(scene->root, "bodies"), (size_t)body);
    const json_t *hinge = json_object_get(value, "hinge"), *guide = json_object_get(value, "guide");
    tobi_place at_hinge = { entry, "hinge", 0 }, at_guide = { entry, "guide", 0 };
    tobi_place locked = { entry, "locked", 0 };
    if ((!hinge && !guide) || def->dynamics == TOBI_PRESCRIBED) return;         /* unused.c tells */
    if (hinge && guide) tobi_source_mistake(source, &at_guide, "and hinge exclude each other");
    if (def->locked && def->locked[0])
        tobi_source_mistake(source, &locked, "is for bodies without a hinge or guide, which leaves one way "
                            "to move");
    if (json_is_object(hinge)) check_hinge(scene, source, def, hinge, &at_hinge);
    if (json_is_object(guide)) check_guide(scene, source, def, guide, &at_guide);
}
