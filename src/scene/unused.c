/* Keys that the scene's own method, or its other keys, leave unread: a number in a file that does nothing
   misleads. One list serves the check, which reports those that are given, and resolved.json, which leaves
   them out. The section of a method that is not chosen plainly waits for another run and is let be. */
#include "scene/scene.h"
#include "base/param.h"
#include <string.h>

typedef enum reader {
    SPH,             /* the methods of fluids                     */
    SOLIDS,          /* the method of solids                      */
    FORCES,          /* bodies that move by forces                */
    BLADE,           /* bodies that cut                           */
    VESSEL,          /* bodies that hold liquid                   */
    LIGHT,           /* bodies without a mass of their own        */
    RISE,            /* sand whose friction rises with its flow   */
    SLOPE,           /* solids that break; sand always has one    */
    FLIP, XPIC,      /* ways to the grid and back                 */
    GMRES,           /* the solver of isph                        */
    SWEEPS,          /* several of eisph: one is the same by both */
    REGULAR, IRREGULAR, PEAK, FOCUSED, FOCUSED_PEAK, RECORDED, RAMP, OWN      /* waves of a maker; OWN: any */
} reader;

#define NOT_REGULAR TR("is for regular waves, which have a regular.height")
#define NOT_IRREGULAR TR("is for irregular waves, which have an irregular.height")
#define NOT_FOCUSED TR("is for a focused group, which has a focused.height")
#define NOT_RECORDED TR("is for recorded waves, which have a recorded.file")
#define UNMOVED TR("is for free and controlled bodies, this one is prescribed")

static const struct {
    const char *table, *key;
    reader reader;
    const char *why;
} keys[] = {
    { "world", "cfl", SPH, TR("is for the SPH methods; mlsmpm has its own, mlsmpm.cfl") },
    { "world", "implicit_viscosity", SPH, TR("is for liquids of the SPH methods; liquids of mlsmpm have "
                                                     "their own viscosity") },
    { "world", "domain.contact_angle", SPH, TR("is for liquids of the SPH methods; mlsmpm has no "
                                                      "surface tension") },
    { "world", "domain.friction", SOLIDS, TR("is for solids of mlsmpm; what liquids do at a side say "
                                                    "domain.walls and their viscosity") },
    { "body", "friction", SPH, TR("is for liquids of the SPH methods; solids of mlsmpm rub by its "
                                         "friction_coefficient") },
    { "body", "contact_angle", SPH, TR("is for liquids of the SPH methods; mlsmpm has no surface "
                                              "tension") },
#define MOVED(key) { "body", key, FORCES, UNMOVED }
    MOVED("velocity"), MOVED("angular_velocity"), MOVED("force"), MOVED("torque"), MOVED("air_resistance"),
    MOVED("locked"), MOVED("hinge.point"), MOVED("hinge.axis"), MOVED("hinge.lower"), MOVED("hinge.upper"),
    MOVED("hinge.stiffness"), MOVED("hinge.damping"), MOVED("guide.axis"), MOVED("guide.lower"),
    MOVED("guide.upper"), MOVED("guide.stiffness"), MOVED("guide.damping"),
#undef MOVED
#define EDGE(key) { "body", key, BLADE, TR("is for a blade, which this body is not") }
    EDGE("edge_resistance"), EDGE("edge_angle"), EDGE("edge_start"), EDGE("edge_end"),
#undef EDGE
    { "body", "wall_thickness", VESSEL, TR("is for a vessel, which this body is not") },
    { "body", "density", LIGHT, TR("is given beside mass; one of them is enough") },
    { "body", "open_side", VESSEL, TR("is for a vessel, which this body is not") },
#define RISING(key) { "solid", key, RISE, TR("is for a friction_rise, which this solid has not") }
    RISING("grain_diameter"), RISING("inertial_number"),
#undef RISING
    { "solid", "friction_angle", SLOPE, TR("is for a strength, which this solid has not") },
    { "mlsmpm", "flip", FLIP, TR("is for \"transfer\": \"flip\"") },
    { "mlsmpm", "xpic_order", XPIC, TR("is for \"transfer\": \"xpic\"") },
    { "isph", "restart", GMRES, TR("is for \"solver\": \"gmres\"") },
    { "eisph", "iteration", SWEEPS, TR("is pseudo-time, and one sweep of that is one of jacobi; allowed "
                                    "with it are \"sweeps\": 2 or more, or 0") },
#define WAVES(maker) \
    { maker, "regular.period", REGULAR, NOT_REGULAR }, { maker, "regular.phase", REGULAR, NOT_REGULAR }, \
    { maker, "irregular.peak_period", IRREGULAR, NOT_IRREGULAR }, \
    { maker, "irregular.spectrum", IRREGULAR, NOT_IRREGULAR }, \
    { maker, "irregular.seed", IRREGULAR, NOT_IRREGULAR }, \
    { maker, "irregular.components", IRREGULAR, NOT_IRREGULAR }, \
    { maker, "irregular.peakedness", PEAK, TR("is for irregular waves of the spectrum jonswap") }, \
    { maker, "focused.distance", FOCUSED, NOT_FOCUSED }, { maker, "focused.time", FOCUSED, NOT_FOCUSED }, \
    { maker, "focused.peak_period", FOCUSED, NOT_FOCUSED }, \
    { maker, "focused.spectrum", FOCUSED, NOT_FOCUSED }, \
    { maker, "focused.components", FOCUSED, NOT_FOCUSED }, \
    { maker, "focused.peakedness", FOCUSED_PEAK, TR("is for a focused group of the spectrum jonswap") }, \
    { maker, "recorded.column", RECORDED, NOT_RECORDED }, \
    { maker, "recorded.distance", RECORDED, NOT_RECORDED }, \
    { maker, "recorded.longest_period", RECORDED, NOT_RECORDED }, \
    { maker, "recorded.shortest_period", RECORDED, NOT_RECORDED }, \
    { maker, "ramp", RAMP, TR("is for waves that go on; a solitary wave rises by itself") }
    WAVES("piston"), WAVES("flap"),
#undef WAVES
    { "piston", "regular.order", REGULAR, NOT_REGULAR },
    { "piston", "start", OWN, TR("is for waves of its own, which this piston does not make") },
};
enum { KEYS = sizeof keys/sizeof *keys };

/* The parameters of a method, NULL if the scene has another one. */
static const void *find_def(const tobi_scene *scene, const char *method)
{
    return scene->method && strcmp(scene->method->name, method) == 0 ? scene->method_def : NULL;
}

static int makes(const tobi_wave_maker_def *waves, reader who)
{
    const int regular = waves->height > 0, irregular = waves->significant_height > 0;
    const int focused = waves->focused_height > 0, recorded = waves->record_file != NULL;
    const int jonswap = waves->spectrum == TOBI_JONSWAP, any = regular || irregular || focused || recorded;
    switch (who) {
    case REGULAR: return regular;
    case IRREGULAR: return irregular;
    case PEAK: return irregular && jonswap;
    case FOCUSED: return focused;
    case FOCUSED_PEAK: return focused && jonswap;
    case RECORDED: return recorded;
    case RAMP: return any;
    default: return any || waves->solitary_height > 0;
    }
}

/* def: of the body, solid or wave maker whose keys are asked for, else NULL. */
static int is_there(const tobi_scene *scene, const void *def, reader who)
{
    if (who >= REGULAR) return makes(def, who);
    const tobi_body_def *body = def;
    const tobi_solid_def *solid = def;
    const tobi_mlsmpm_def *solids = find_def(scene, "mlsmpm");
    const tobi_isph_def *isph = find_def(scene, "isph");
    const tobi_eisph_def *eisph = find_def(scene, "eisph");
    tobi_method_info method;
    tobi_method_describe(scene->world.method, &method);
    switch (who) {
    case SPH: return !method.solids;
    case SOLIDS: return method.solids || scene->solid_count > 0;
    case FORCES: return body->dynamics != TOBI_PRESCRIBED;
    case BLADE: return body->blade;
    case VESSEL: return body->vessel || (!(body->wall_thickness > 0) && !body->open_side[0] &&
                                         !body->open_side[1] && !body->open_side[2]);
    case LIGHT: return !(body->mass > 0);
    case RISE: return !tobi_solid_uses(solid->model, "friction_rise") || solid->friction_rise > 0;
    case SLOPE: return !tobi_solid_uses(solid->model, "strength") || solid->strength > 0;
    case FLIP: return !solids || solids->transfer == TOBI_FLIP;
    case XPIC: return !solids || solids->transfer == TOBI_XPIC;
    case GMRES: return !isph || isph->solver == TOBI_GMRES;
    default: return !eisph || eisph->iteration != TOBI_ITERATION_PSEUDO_TIME || eisph->sweeps != 1;
    }
}

/* The object that a key with a dot belongs to, and the key there. */
static void split(const char *key, char outer[32], const char **inner)
{
    const char *dot = strchr(key, '.');
    snprintf(outer, 32, "%.*s", dot ? (int)(dot - key) : 0, key);
    *inner = dot ? dot + 1 : key;
}

void tobi_unused_drop(const tobi_scene *scene, const tobi_param_table *table, const void *def,
                      json_t *object)
{
    char outer[32];
    const char *inner;
    for (int k = 0; k < KEYS; k++) {
        if (strcmp(keys[k].table, table->name) != 0 || is_there(scene, def, keys[k].reader)) continue;
        split(keys[k].key, outer, &inner);
        json_object_del(outer[0] ? json_object_get(object, outer) : object, inner);
    }
}

/* Where some value is wrong, a key may be for what the value was to say: one mistake after the other. */
static void check(const tobi_scene *scene, tobi_source *source, const tobi_param_table *table,
                  const tobi_place *place, const void *def, tobi_bound bound)
{
    char outer[32];
    const char *inner;
    for (int k = 0; bound.given == bound.good && k < KEYS; k++) {
        if (strcmp(keys[k].table, table->name) != 0 || !tobi_bind_has(table, bound.given, keys[k].key) ||
            is_there(scene, def, keys[k].reader)) continue;
        split(keys[k].key, outer, &inner);
        tobi_place middle = { place, outer, 0 }, key = { outer[0] ? &middle : place, inner, 0 };
        tobi_source_mistake_at_key(source, &key, "%s", tr(keys[k].why));
    }
}

/* Whether some side of the domain lets solids separate from it. */
static int has_separate_side(const tobi_world_def *w)
{
    int has = 0;
    for (int a = 0; a < w->dimension; a++)
        has |= w->wall_min[a] == TOBI_WALL_SEPARATE || w->wall_max[a] == TOBI_WALL_SEPARATE;
    return has;
}

/* Friction where nothing separates. */
static void check_friction(const tobi_scene *scene, tobi_source *source, const tobi_place *root)
{
    tobi_place domain = { root, "domain", 0 }, friction = { &domain, "friction", 0 };
    tobi_place planes = { root, "planes", 0 };
    if (!find_def(scene, "mlsmpm")) return;
    if (scene->world.friction > 0 && !has_separate_side(&scene->world))
        tobi_source_mistake_at_key(source, &friction, "is for \"separate\" sides, and no side in "
                                   "domain.walls is one");
    for (int i = 0; i < scene->plane_count && !tobi_report_full(source->report); i++) {
        tobi_place entry = { &planes, NULL, (size_t)i }, rub = { &entry, "friction", 0 };
        const tobi_plane_def *plane = &scene->planes[i];
        if (plane->friction > 0 && plane->kind != TOBI_PLANE_SEPARATE)
            tobi_source_mistake_at_key(source, &rub, "is for planes of the kind separate, this one is %s",
                                       plane->kind == TOBI_PLANE_SLIP ? "slip" : "no-slip");
    }
}

void tobi_unused_check_motion(tobi_source *source, const tobi_param_table *table, const tobi_place *place,
                              const void *def, tobi_bound bound)
{
    check(NULL, source, table, place, def, bound);
}

void tobi_unused_check(const tobi_scene *scene, tobi_source *source)
{
    tobi_place root = { 0 }, bodies = { &root, "bodies", 0 }, solids = { &root, "solids", 0 };
    if (!scene->method) return;
    tobi_place method = { &root, scene->method->name, 0 };
    check(scene, source, &tobi_world_table, &root, NULL, scene->world_bound);
    check(scene, source, scene->method, &method, NULL, scene->method_bound);
    check_friction(scene, source, &root);
    for (int i = 0; i < scene->solid_count && !tobi_report_full(source->report); i++) {
        tobi_place entry = { &solids, NULL, (size_t)i };
        const tobi_scene_solid *solid = &scene->solids[i];
        check(scene, source, &tobi_solid_table, &entry, &solid->def, solid->bound);
    }
    for (int i = 0; i < scene->body_count && !tobi_report_full(source->report); i++) {
        tobi_place entry = { &bodies, NULL, (size_t)i };
        const tobi_scene_body *body = &scene->bodies[i];
        check(scene, source, &tobi_body_table, &entry, &body->def, body->bound);
    }
}
