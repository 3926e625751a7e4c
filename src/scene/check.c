/* The checks that need more than one value of a scene, or something outside of it. */
#define _GNU_SOURCE 1
#include "scene/scene.h"
#include "tobiuo/scene.h"
#include "base/param.h"
#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const char axis_name[3] = "xyz";
static const tobi_place root = { 0 };

static int is_zero(const double v[3]) { return v[0] == 0 && v[1] == 0 && v[2] == 0; }

static void check_method(const tobi_scene *scene, tobi_source *source)
{
    tobi_place place = { &root, "method", 0 };
    const char *names[16];
    size_t count = 0;
    for (; count < 16 && tobi_method_name((int)count); count++)
        names[count] = tobi_method_name((int)count);
    if (scene->method) return;
    const char *near = tobi_suggest(scene->world.method, names, count);
    tobi_source_mistake(source, &place, "there is no method \"%s\"; did you mean \"%s\"?",
                        scene->world.method, near ? near : names[0]);
}

int tobi_check_has_domain(const tobi_scene *scene)
{
    return tobi_bind_has(&tobi_world_table, scene->world_bound.good, "domain.min") &&
           tobi_bind_has(&tobi_world_table, scene->world_bound.good, "domain.max");
}

/* A rule of the world that the scene breaks, at its key. */
static void tell_rule(void *user, const char *path, const tobi_error *why)
{
    tobi_place chain[TOBI_PATH_STEPS];
    char text[TOBI_PATH_TEXT];
    tobi_source_mistake(user, tobi_place_read(path, chain, text), "%s", why->text);
}

static void check_rules(const tobi_scene *scene, tobi_source *source)
{
    const tobi_world_def *w = &scene->world;
    const tobi_rules rules = { .tell = tell_rule, .user = source, .corners = tobi_check_has_domain(scene),
                               .numbers = scene->world_bound.good == scene->world_bound.given };
    tobi_place gravity = { &root, "gravity", 0 };
    tobi_rules_world(&rules, w, scene->method_def);
    if (tobi_scene_has_both(scene)) tobi_rules_beside(&rules, w, &scene->solids_def);
    if (w->dimension == 2 && w->gravity[2] != 0)
        tobi_source_mistake(source, &gravity, "is %.10g m/s2 in z, must be 0 in a 2-D scene",
                            w->gravity[2]);
    if (w->dimension == 2 && (w->wall_min[2] != TOBI_WALL_SLIP || w->wall_max[2] != TOBI_WALL_SLIP)) {
        tobi_place domain = { &root, "domain", 0 }, walls = { &domain, "walls", 0 }, z = { &walls, "z", 0 };
        tobi_source_mistake(source, &z, "is of 3-D scenes; a 2-D scene has sides in x and y");
    }
}

/* A file that the scene names: reported here, with all other mistakes, and not at the start. */
void tobi_check_file(tobi_source *source, const tobi_place *place, const char *path)
{
    struct stat info;
    if (!path) return;
    if (stat(path, &info) != 0)
        tobi_source_mistake(source, place, "cannot find %s: %s", path, tobi_reason(errno));
    else if (!S_ISREG(info.st_mode))
        tobi_source_mistake(source, place, "%s is not a file", path);
}

/* Whether one of the first entries of a list has the name of `entry`, which is then told. */
static int tell_name(const tobi_scene *scene, tobi_source *source, const tobi_place *entry,
                     const char *list, size_t first)
{
    const json_t *own = json_array_get(json_object_get(scene->root, entry->up->key), entry->index);
    const json_t *others = json_object_get(scene->root, list);
    const char *name = json_string_value(json_object_get(own, "name"));
    const tobi_place place = { entry, "name", 0 };
    for (size_t k = 0; name && k < first && k < json_array_size(others); k++) {
        const char *other = json_string_value(json_object_get(json_array_get(others, k), "name"));
        if (!other || strcmp(other, name) != 0) continue;
        tobi_source_mistake(source, &place, "\"%s\" is already the name of %s[%zu]", name, list, k);
        return 1;
    }
    return 0;
}

void tobi_check_name(const tobi_scene *scene, tobi_source *source, const tobi_place *entry)
{
    tell_name(scene, source, entry, entry->up->key, entry->index);
}

/* Fluids, solids and bodies share their names. */
static void check_name(const tobi_scene *scene, tobi_source *source, const tobi_place *entry)
{
    static const char *const lists[] = { "fluids", "solids", "bodies" };
    for (int k = 0; k < 3; k++) {
        const int own = strcmp(lists[k], entry->up->key) == 0;
        if (tell_name(scene, source, entry, lists[k], own ? entry->index : SIZE_MAX) || own) return;
    }
}

static int is_empty(const tobi_scene *scene, const char *key)
{
    json_t *list = json_object_get(scene->root, key);
    return !list || (json_is_array(list) && json_array_size(list) == 0);
}

/* What the method moves must be there, and what it does not know must not. */
static void check_matter(const tobi_scene *scene, tobi_source *source)
{
    tobi_method_info method;
    tobi_place fluids = { &root, "fluids", 0 }, solids = { &root, "solids", 0 };
    tobi_place probes = { &root, "probes", 0 }, planes = { &root, "planes", 0 };
    if (!tobi_method_describe(scene->world.method, &method)) return;
    if (!method.planes && !is_empty(scene, "planes"))
        tobi_source_mistake(source, &planes, "are for solids and bodies of mlsmpm; %s knows sides of the "
                            "domain and bodies", method.name);
    if (!method.solids) {
        if (is_empty(scene, "fluids") && !is_empty(scene, "solids"))
            tobi_source_mistake(source, &fluids, "is missing or empty: %s needs at least one fluid; the "
                                "method of solids alone is mlsmpm", method.name);
        else if (is_empty(scene, "fluids"))
            tobi_source_mistake(source, &fluids, "is missing or empty: a scene needs at least one fluid");
        return;
    }
    if (!is_empty(scene, "fluids"))
        tobi_source_mistake(source, &fluids, "%s takes no fluids; write a solid of \"model\": \"liquid\" "
                            "into solids, or \"method\": \"dfsph\"", method.name);
    else if (is_empty(scene, "solids") && is_empty(scene, "bodies"))
        tobi_source_mistake(source, &solids, "is missing or empty: a scene of %s needs at least one solid or "
                            "body", method.name);
    if (!is_empty(scene, "probes"))
        tobi_source_mistake(source, &probes, "measure fluids of the SPH methods; %s has no probes",
                            method.name);
}

typedef struct spot { tobi_source *source; const tobi_place *entry; int told; } spot;

static void tell_entry(void *user, const char *key, const tobi_error *why)
{
    spot *at = user;
    tobi_place place = { at->entry, key, 0 };
    tobi_source_mistake_at_key(at->source, &place, "%s", why->text);
    at->told = 1;
}

/* What the method refuses of a fluid beside those before it: the first breach, others may follow from it. */
static void check_mixture(const tobi_scene *scene, tobi_source *source, const tobi_place *entry)
{
    const tobi_scene_fluid *fluid = &scene->fluids[entry->index];
    const int openings = !is_empty(scene, "inlets") || !is_empty(scene, "outlets");
    spot at = { source, entry, 0 };
    const tobi_rules rules = { .tell = tell_entry, .user = &at };
    if (fluid->bound.good == fluid->bound.given)
        tobi_rules_fluid(&rules, &scene->world, &fluid->def, NULL, openings);
    for (size_t k = 0; k < entry->index && !at.told; k++) {
        const tobi_scene_fluid *other = &scene->fluids[k];
        if (fluid->bound.good == fluid->bound.given && other->bound.good == other->bound.given)
            tobi_rules_fluid(&rules, &scene->world, &fluid->def, &other->def, openings);
    }
}

static void check_fluids(const tobi_scene *scene, tobi_source *source)
{
    tobi_place fluids = { &root, "fluids", 0 };
    for (int i = 0; i < scene->fluid_count && !tobi_report_full(source->report); i++) {
        tobi_place entry = { &fluids, NULL, (size_t)i };
        check_name(scene, source, &entry);
        if (i > 0) check_mixture(scene, source, &entry);
        tobi_check_fills(scene, source, &entry, scene->fluids[i].fills, scene->fluids[i].fill_count);
    }
}

/* What a solid gives must mean something to its model. */
static void check_solid(const tobi_scene *scene, tobi_source *source, const tobi_place *entry)
{
    const tobi_scene_solid *solid = &scene->solids[entry->index];
    tobi_place mass = { entry, "mass", 0 };
    if (tobi_bind_has(&tobi_solid_table, solid->bound.given, "mass") &&
        tobi_bind_has(&tobi_solid_table, solid->bound.given, "density"))
        tobi_source_mistake_at_key(source, &mass, "is given beside density; one of them is enough");
    if (tobi_bind_has(&tobi_solid_table, solid->bound.given, "model") &&
        !tobi_bind_has(&tobi_solid_table, solid->bound.good, "model")) return;
    for (const tobi_param *row = tobi_solid_table.rows; row->key; row++) {
        tobi_place key = { entry, row->key, 0 };
        char used[200];
        if (!tobi_bind_has(&tobi_solid_table, solid->bound.given, row->key) ||
            tobi_solid_uses(solid->def.model, row->key)) continue;
        tobi_solid_list(solid->def.model, used, sizeof used);
        tobi_source_mistake_at_key(source, &key, "is nothing that this model knows; it has %s", used);
    }
}

/* What must fit the cells, as strength and fracture energy: where all numbers are known. */
static void check_cells(const tobi_scene *scene, tobi_source *source, const tobi_place *entry)
{
    const tobi_scene_solid *solid = &scene->solids[entry->index];
    spot at = { source, entry, 0 };
    const tobi_rules rules = { .tell = tell_entry, .user = &at };
    if (solid->bound.good != solid->bound.given ||
        !tobi_bind_has(&tobi_world_table, scene->world_bound.good, "spacing")) return;
    tobi_rules_solid(&rules, &scene->world, scene->method_def, &solid->def);
}

static void check_solids(const tobi_scene *scene, tobi_source *source)
{
    tobi_place solids = { &root, "solids", 0 };
    for (int i = 0; i < scene->solid_count && !tobi_report_full(source->report); i++) {
        tobi_place entry = { &solids, NULL, (size_t)i };
        check_name(scene, source, &entry);
        check_solid(scene, source, &entry);
        check_cells(scene, source, &entry);
        tobi_check_file(source, &(tobi_place){ &entry, "texture", 0 }, scene->solids[i].def.texture);
        tobi_check_fills(scene, source, &entry, scene->solids[i].fills, scene->solids[i].fill_count);
    }
}

static const char *const body_shapes[] = { "mesh", "box", "sphere", "cylinder", "capsule", "plate",
                                          "knife", "outline", "terrain" };

/* Which shapes an entry of bodies gives: how many, and the last. */
static int count_shapes(json_t *value, const char **last)
{
    int count = 0;
    for (size_t k = 0; k < sizeof body_shapes/sizeof *body_shapes; k++)
        if (json_object_get(value, body_shapes[k])) count++, *last = body_shapes[k];
    return count;
}

/* given: the object with the corners that are in lower and upper. */
static void check_corners(tobi_source *source, const tobi_place *box, const json_t *given,
                          const double lower[3], const double upper[3], int dimension)
{
    if (!json_is_array(json_object_get(given, "min")) || !json_is_array(json_object_get(given, "max"))) {
        tobi_source_mistake(source, box, "must have two corners, min and max");
        return;
    }
    for (int a = 0; a < dimension; a++)
        if (!(upper[a] > lower[a]))
            tobi_source_mistake(source, box, "min is %.10g and max is %.10g in %c, max must be greater",
                                lower[a], upper[a], axis_name[a]);
}

static void check_body_box(const tobi_scene *scene, tobi_source *source, int body, const tobi_place *entry)
{
    const tobi_body_def *def = &scene->bodies[body].def;
    json_t *value = json_array_get(json_object_get(scene->root, "bodies"), (size_t)body);
    tobi_place box = { entry, "box", 0 };
    check_corners(source, &box, json_object_get(value, "box"), def->box_min, def->box_max,
                  scene->world.dimension);
}

void tobi_check_outline(tobi_source *source, const tobi_place *outline, const tobi_outline_def *def,
                        int dimension)
{
    tobi_check_file(source, &(tobi_place){ outline, "file", 0 }, def->file);
    if (def->points && def->file)
        tobi_source_mistake(source, outline, "must have points or a file, not both");
    if (dimension == 3 && !(def->to > def->from))
        tobi_source_mistake(source, outline, "goes from %.10g to %.10g m along its axis; to must be greater "
                            "than from", def->from, def->to);
}

/* One shape, with what makes it one. */
static void check_shape(const tobi_scene *scene, tobi_source *source, int body, const tobi_place *entry)
{
    json_t *value = json_array_get(json_object_get(scene->root, "bodies"), (size_t)body);
    const char *shape = NULL;
    const int count = count_shapes(value, &shape);
    if (!json_is_object(value)) return;
    if (count != 1) {
        tobi_source_mistake(source, entry, "must have one of mesh, box, sphere, cylinder, capsule, plate, "
                            "knife, outline and terrain; it has %s", count ? tr("several") : tr("none"));
        return;
    }
    tobi_check_file(source, &(tobi_place){ &(tobi_place){ entry, "terrain", 0 }, "file", 0 },
                    scene->bodies[body].def.terrain_file);
    const int flat = strcmp(shape, "plate") == 0 || strcmp(shape, "knife") == 0;
    const char *size = flat ? "thickness" : strcmp(shape, "terrain") == 0 ? "file" : "radius";
    tobi_place place = { entry, shape, 0 };
    if (strcmp(shape, "box") == 0) check_body_box(scene, source, body, entry);
    else if (strcmp(shape, "outline") == 0) {
        const json_t *given = json_object_get(value, shape);
        if (!json_object_get(given, "points") && !json_object_get(given, "file"))
            tobi_source_mistake(source, &place, "must have points or a file");
        tobi_check_outline(source, &place, &scene->bodies[body].def.outline, scene->world.dimension);
    }
    else if (strcmp(shape, "mesh") != 0 && !json_object_get(json_object_get(value, shape), size))
        tobi_source_mistake(source, &place, "must have a %s", size);
}

/* A body moves by a motion, or by forces; then a motion may change its shape. */
static void check_dynamics(const tobi_scene *scene, tobi_source *source, int i, const tobi_place *entry)
{
    const tobi_body_def *def = &scene->bodies[i].def;
    json_t *value = json_array_get(json_object_get(scene->root, "bodies"), (size_t)i);
    tobi_place motion = { entry, "motion", 0 }, second = { &motion, NULL, 1 };
    tobi_place control = { entry, "control", 0 };
    int controls = json_object_get(value, "control") != NULL, moves = def->dynamics != TOBI_PRESCRIBED;
    int added = json_array_size(json_object_get(value, "motion")) > 1;       /* to a script with deform */
    if (moves && def->motion && (def->motion_rigid || added))
        tobi_source_mistake(source, def->motion_rigid ? &motion : &second,
                            "is rigid, and this body is %s; a motion of a body that moves by forces changes "
                            "its shape: a script with deform",
                            def->dynamics == TOBI_FREE ? "free" : "controlled");
    if (controls && def->dynamics != TOBI_CONTROLLED)
        tobi_source_mistake(source, &control, "is for a body whose dynamics is \"controlled\"");
    if (!controls && def->dynamics == TOBI_CONTROLLED)
        tobi_source_mistake(source, &control, "is missing: a controlled body has a control program");
}

static void check_bodies(const tobi_scene *scene, tobi_source *source)
{
    tobi_place bodies = { &root, "bodies", 0 };
    for (int i = 0; i < scene->body_count && !tobi_report_full(source->report); i++) {
        const tobi_scene_body *body = &scene->bodies[i];
        tobi_place entry = { &bodies, NULL, (size_t)i }, mesh = { &entry, "mesh", 0 };
        tobi_place rotation = { &entry, "rotation", 0 }, axis = { &rotation, "axis", 0 };
        check_name(scene, source, &entry);
        tobi_check_file(source, &mesh, body->def.mesh);
        tobi_check_file(source, &(tobi_place){ &entry, "texture", 0 }, body->def.texture);
        check_shape(scene, source, i, &entry);
        check_dynamics(scene, source, i, &entry);
        tobi_joints_check(scene, source, i, &entry);
        if (is_zero(body->def.rotation_axis))
            tobi_source_mistake(source, &axis, "is zero, must have a direction");
    }
}

static void check_planes(const tobi_scene *scene, tobi_source *source)
{
    const tobi_world_def *w = &scene->world;
    tobi_place planes = { &root, "planes", 0 };
    for (int i = 0; i < scene->plane_count && !tobi_report_full(source->report); i++) {
        const tobi_plane_def *plane = &scene->planes[i];
        const tobi_rows good = scene->planes_bound[i].good;
        tobi_place entry = { &planes, NULL, (size_t)i }, point = { &entry, "point", 0 },
                   normal = { &entry, "normal", 0 };
        const double *n = plane->normal;
        if (tobi_bind_has(&tobi_plane_table, good, "normal") && w->dimension == 2 && n[2] != 0)
            tobi_source_mistake(source, &normal, "is %.10g in z, must be 0 in a 2-D scene", n[2]);
        else if (tobi_bind_has(&tobi_plane_table, good, "normal") && is_zero(n))
            tobi_source_mistake(source, &normal, "is zero, must have a direction");
        if (!tobi_check_has_domain(scene) || !tobi_bind_has(&tobi_plane_table, good, "point")) continue;
        for (int a = 0; a < w->dimension; a++)
            if (plane->point[a] < w->domain_min[a] || plane->point[a] > w->domain_max[a])
                tobi_source_mistake(source, &point, "is %.10g m in %c, the domain reaches from %.10g to "
                                    "%.10g m", plane->point[a], axis_name[a], w->domain_min[a],
                                    w->domain_max[a]);
    }
}

/* A zone is a box with both corners, an outline or a cylinder. */
static void check_porous(const tobi_scene *scene, tobi_source *source)
{
    const tobi_place zones = { &root, "porous_zones", 0 };
    for (int i = 0; i < scene->tank.porous_count && !tobi_report_full(source->report); i++) {
        const tobi_place entry = { &zones, NULL, (size_t)i }, at_box = { &entry, "box", 0 };
        const tobi_place at_outline = { &entry, "outline", 0 }, at_cylinder = { &entry, "cylinder", 0 };
        const json_t *zone = json_array_get(json_object_get(scene->root, zones.key), (size_t)i);
        const json_t *box = json_object_get(zone, "box"), *outline = json_object_get(zone, "outline");
        const json_t *cylinder = json_object_get(zone, "cylinder");
        const int shapes = !!box + !!outline + !!cylinder;
        if (!json_is_object(zone)) continue;
        if (shapes != 1)
            tobi_source_mistake(source, &entry, "must have one of box, outline and cylinder, it has %s",
                                shapes ? tr("several") : tr("none"));
        else if (box && !(json_object_get(box, "min") && json_object_get(box, "max")))
            tobi_source_mistake(source, &at_box, "must have two corners, min and max");
        else if (outline && !json_object_get(outline, "points") && !json_object_get(outline, "file"))
            tobi_source_mistake(source, &at_outline, "must have points or a file");
        else if (cylinder && !json_object_get(cylinder, "radius"))
            tobi_source_mistake(source, &at_cylinder, "must have a radius");
        else if (outline)
            tobi_check_outline(source, &at_outline, &scene->tank.porous[i].outline, scene->world.dimension);
    }
}

/* A box with both corners at 0 would be none. */
static void check_values(const tobi_scene *scene, tobi_source *source)
{
    const tobi_place values = { &root, "scalar_values", 0 };
    for (int i = 0; i < scene->tank.value_count && !tobi_report_full(source->report); i++) {
        const tobi_place entry = { &values, NULL, (size_t)i }, at_box = { &entry, "box", 0 };
        const tobi_scalar_value_def *def = &scene->tank.values[i];
        const json_t *value = json_array_get(json_object_get(scene->root, values.key), (size_t)i);
        const json_t *box = json_object_get(value, at_box.key);
        if (box) check_corners(source, &at_box, box, def->box_min, def->box_max, scene->world.dimension);
    }
}

void tobi_scene_check(const tobi_scene *scene, tobi_source *source)
{
    check_method(scene, source);
    check_rules(scene, source);
    check_matter(scene, source);
    check_fluids(scene, source);
    tobi_interfaces_check(scene, source);
    check_solids(scene, source);
    tobi_check_overlaps(scene, source);
    check_bodies(scene, source);
    check_planes(scene, source);
    check_porous(scene, source);
    check_values(scene, source);
    tobi_unused_check(scene, source);
    tobi_check_probes(scene, source);
    tobi_nests_check(scene, source);
    tobi_lines_check(scene, source);
    tobi_joint_list_check(scene, source);
    tobi_clamps_check(scene, source);
    tobi_output_check(scene, source);
    tobi_references_check(scene, source);
}
