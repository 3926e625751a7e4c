/* The checks that need more than one value of a scene, or something outside of it. */
#define _GNU_SOURCE 1
#include "scene/scene.h"
#include "scene/suggest.h"
#include "world/methods.h"
#include "world/params.h"
#include <errno.h>
#include <math.h>
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

static void check_dfsph(const tobi_scene *scene, tobi_source *source)
{
    if (scene->method != &tobi_dfsph_table) return;
    const tobi_dfsph_def *d = scene->method_def;
    tobi_place method = { &root, "dfsph", 0 };
    tobi_place density = { &method, "density_iterations_min", 0 };
    tobi_place divergence = { &method, "divergence_iterations_min", 0 };
    if (d->density_iterations_min > d->density_iterations_max)
        tobi_source_mistake(source, &density, "is %d, must not be above density_iterations_max, %d",
                            d->density_iterations_min, d->density_iterations_max);
    if (d->divergence_iterations_min > d->divergence_iterations_max)
        tobi_source_mistake(source, &divergence,
                            "is %d, must not be above divergence_iterations_max, %d",
                            d->divergence_iterations_min, d->divergence_iterations_max);
}

static int has_domain(const tobi_scene *scene)
{
    return tobi_bind_has(&tobi_world_table, scene->world_bound.good, "domain.min") &&
           tobi_bind_has(&tobi_world_table, scene->world_bound.good, "domain.max");
}

/* A side moves along itself, and only where the fluid sticks to it. */
static void check_sides(const tobi_scene *scene, tobi_source *source)
{
    const tobi_world_def *w = &scene->world;
    tobi_place domain = { &root, "domain", 0 }, velocity = { &domain, "wall_velocity", 0 };
    for (int a = 0; a < w->dimension; a++)
        for (size_t side = 0; side < 2; side++) {
            char name[2] = { axis_name[a], 0 };
            tobi_place axis = { &velocity, name, 0 }, entry = { &axis, NULL, side };
            const double *v = side ? w->wall_velocity_max[a] : w->wall_velocity_min[a];
            int wall = side ? w->wall_max[a] : w->wall_min[a];
            if (is_zero(v)) continue;
            if (wall != TOBI_WALL_NO_SLIP)
                tobi_source_mistake(source, &entry, "moves a side that is not no-slip");
            else if (v[a] != 0 || (w->dimension == 2 && v[2] != 0))
                tobi_source_mistake(source, &entry, "is not along the side: %s must be 0",
                                    v[a] != 0 ? name : "z");
        }
}

static void check_domain(const tobi_scene *scene, tobi_source *source)
{
    const tobi_world_def *w = &scene->world;
    tobi_place domain = { &root, "domain", 0 }, corner = { &domain, "max", 0 },
               walls = { &domain, "walls", 0 };
    tobi_place spacing = { &root, "spacing", 0 };
    for (int a = 0; a < w->dimension; a++) {
        char name[2] = { axis_name[a], 0 };
        tobi_place wall = { &walls, name, 0 };
        double length = w->domain_max[a] - w->domain_min[a];
        if ((w->wall_min[a] == TOBI_WALL_PERIODIC) != (w->wall_max[a] == TOBI_WALL_PERIODIC))
            tobi_source_mistake(source, &wall,
                                "is periodic on one side only; write \"%s\": \"periodic\"", name);
        if (!has_domain(scene)) continue;
        tobi_place entry = { &corner, NULL, (size_t)a };
        if (!(length > 0))
            tobi_source_mistake(source, &entry,
                                "is %.10g in %s, must be greater than domain.min there, %.10g",
                                w->domain_max[a], name, w->domain_min[a]);
        else if (w->spacing > length)
            tobi_source_mistake(source, &spacing, "is %.10g m, the domain has only %.10g m in %s",
                                w->spacing, length, name);
    }
    tobi_place gravity = { &root, "gravity", 0 };
    if (w->dimension == 2 && w->gravity[2] != 0)
        tobi_source_mistake(source, &gravity, "is %.10g m/s2 in z, must be 0 in a 2-D scene",
                            w->gravity[2]);
}

/* A region may touch the domain's sides; rounding of decimal numbers is forgiven. */
static double slack(const tobi_world_def *w, int axis)
{
    return 1e-9*(w->domain_max[axis] - w->domain_min[axis]);
}

static void check_box(const tobi_scene *scene, tobi_source *source, const tobi_fill_def *fill,
                      const tobi_place *place)
{
    const tobi_world_def *w = &scene->world;
    tobi_place box = { place, "box", 0 };
    for (int a = 0; a < w->dimension; a++) {
        if (!(fill->box_max[a] > fill->box_min[a])) {
            tobi_source_mistake(source, &box,
                                "min is %.10g and max is %.10g in %c, max must be greater",
                                fill->box_min[a], fill->box_max[a], axis_name[a]);
        } else if (has_domain(scene) && (fill->box_min[a] < w->domain_min[a] - slack(w, a) ||
                                         fill->box_max[a] > w->domain_max[a] + slack(w, a))) {
            tobi_source_mistake(source, &box,
                                "reaches from %.10g to %.10g m in %c, the domain only from %.10g "
                                "to %.10g m",
                                fill->box_min[a], fill->box_max[a], axis_name[a], w->domain_min[a],
                                w->domain_max[a]);
        }
    }
    if (w->dimension == 2 && fill->velocity[2] != 0)
        tobi_source_mistake(source, place, "moves in z, which a 2-D scene does not have");
}

/* A file that the scene names: reported here, with all other mistakes, and not at the start. */
static void check_file(tobi_source *source, const tobi_place *place, const char *path)
{
    struct stat info;
    if (!path) return;
    if (stat(path, &info) != 0)
        tobi_source_mistake(source, place, "cannot find %s: %s", path, strerror(errno));
    else if (!S_ISREG(info.st_mode))
        tobi_source_mistake(source, place, "%s is not a file", path);
}

static void check_fill(const tobi_scene *scene, tobi_source *source, const tobi_scene_fill *fill,
                       const tobi_place *place)
{
    const tobi_param_table *t = &tobi_fill_table;
    tobi_place mesh = { place, "mesh", 0 };
    int lower = tobi_bind_has(t, fill->bound.given, "box.min"),
        upper = tobi_bind_has(t, fill->bound.given, "box.max");
    int has_mesh = tobi_bind_has(t, fill->bound.given, "mesh"), has_box = lower || upper;
    if (has_box == has_mesh) {
        tobi_source_mistake(source, place, "must have either a box or a mesh, it has %s",
                            has_box ? "both" : "none");
    } else if (has_mesh) {
        check_file(source, &mesh, fill->def.mesh);
    } else if (!lower || !upper) {
        tobi_place box = { place, "box", 0 }, corner = { &box, lower ? "max" : "min", 0 };
        tobi_source_mistake(source, &corner, "is missing: a box has min and max");
    } else if (tobi_bind_has(t, fill->bound.good, "box.min") &&
               tobi_bind_has(t, fill->bound.good, "box.max")) {
        check_box(scene, source, &fill->def, place);
    }
    if (!has_mesh && (tobi_bind_has(t, fill->bound.given, "scale") ||
                      tobi_bind_has(t, fill->bound.given, "translation")))
        tobi_source_mistake(source, place, "scale and translation belong to a mesh, not to a box");
}

/* A filled box and where it stands in the scene. */
typedef struct region { const tobi_fill_def *fill; int fluid, index; } region;

static int do_overlap(const tobi_world_def *w, const tobi_fill_def *a, const tobi_fill_def *b)
{
    for (int k = 0; k < w->dimension; k++)
        if (fmin(a->box_max[k], b->box_max[k]) - fmax(a->box_min[k], b->box_min[k]) <= slack(w, k))
            return 0;
    return 1;
}

static int order_regions(const void *a, const void *b)
{
    const region *p = a, *q = b;
    double x = p->fill->box_min[0], y = q->fill->box_min[0];
    if (x != y) return x > y ? 1 : -1;
    return p->fluid != q->fluid ? p->fluid - q->fluid : p->index - q->index;
}

/* Two boxes in the same place would put particles on top of each other. Sorted along x, so that
   many boxes side by side cost little. */
static void check_overlaps(const tobi_scene *scene, tobi_source *source)
{
    size_t count = 0;
    for (int i = 0; i < scene->fluid_count; i++) count += (size_t)scene->fluids[i].fill_count;
    region *list = calloc(count + 1, sizeof *list);
    if (!list) return;
    count = 0;
    for (int i = 0; i < scene->fluid_count; i++)
        for (int j = 0; j < scene->fluids[i].fill_count; j++)
            if (!scene->fluids[i].fills[j].def.mesh)
                list[count++] = (region){ &scene->fluids[i].fills[j].def, i, j };
    qsort(list, count, sizeof *list, order_regions);
    for (size_t i = 0; i < count && !tobi_report_full(source->report); i++) {
        for (size_t j = i + 1; j < count && list[j].fill->box_min[0] < list[i].fill->box_max[0];
             j++) {
            if (!do_overlap(&scene->world, list[i].fill, list[j].fill)) continue;
            tobi_place fluids = { &root, "fluids", 0 },
                       fluid = { &fluids, NULL, (size_t)list[j].fluid };
            tobi_place fill = { &fluid, "fill", 0 }, entry = { &fill, NULL, (size_t)list[j].index };
            tobi_source_mistake(source, &entry, "overlaps the box fluids[%d].fill[%d]",
                                list[i].fluid, list[i].index);
        }
    }
    free(list);
}

/* A name must be the only one of its kind in fluids and bodies. */
static void check_name(const tobi_scene *scene, tobi_source *source, const tobi_place *entry,
                       int fluid, int body)
{
    tobi_place place = { entry, "name", 0 };
    const char *name = fluid >= 0 ? scene->fluids[fluid].def.name : scene->bodies[body].def.name;
    json_t *list = json_object_get(scene->root, fluid >= 0 ? "fluids" : "bodies");
    json_t *entry_value = json_array_get(list, (size_t)(fluid >= 0 ? fluid : body));
    if (!json_is_string(json_object_get(entry_value, "name"))) return; /* missing: already told */
    for (int i = 0; i < (fluid >= 0 ? fluid : scene->fluid_count); i++)
        if (strcmp(scene->fluids[i].def.name, name) == 0) {
            tobi_source_mistake(source, &place, "\"%s\" is already the name of fluids[%d]", name,
                                i);
            return;
        }
    for (int i = 0; i < body; i++)
        if (strcmp(scene->bodies[i].def.name, name) == 0) {
            tobi_source_mistake(source, &place, "\"%s\" is already the name of bodies[%d]", name,
                                i);
            return;
        }
}

static void check_fluids(const tobi_scene *scene, tobi_source *source)
{
    tobi_place fluids = { &root, "fluids", 0 };
    json_t *given = json_object_get(scene->root, "fluids");
    const tobi_method *method = scene->method ? tobi_method_find(scene->method->name) : NULL;
    int optional = method && method->free_bodies;
    if (!optional && (!given || (json_is_array(given) && json_array_size(given) == 0)))
        tobi_source_mistake(source, &fluids,
                            "is missing or empty: a scene needs at least one fluid");
    for (int i = 0; i < scene->fluid_count && !tobi_report_full(source->report); i++) {
        tobi_place entry = { &fluids, NULL, (size_t)i }, fill = { &entry, "fill", 0 };
        check_name(scene, source, &entry, i, -1);
        for (int j = 0; j < scene->fluids[i].fill_count; j++) {
            tobi_place region_place = { &fill, NULL, (size_t)j };
            check_fill(scene, source, &scene->fluids[i].fills[j], &region_place);
        }
    }
    check_overlaps(scene, source);
}

static void check_body_box(const tobi_scene *scene, tobi_source *source, int body,
                           const tobi_place *entry)
{
    const tobi_body_def *def = &scene->bodies[body].def;
    json_t *value = json_array_get(json_object_get(scene->root, "bodies"), (size_t)body);
    json_t *given = json_object_get(value, "box");
    int mesh = json_object_get(value, "mesh") != NULL, good = json_is_array(json_object_get(given, "min")) &&
                                                              json_is_array(json_object_get(given, "max"));
    tobi_place box = { entry, "box", 0 };
    if (!json_is_object(value)) return;
    if (mesh == (given != NULL))
        tobi_source_mistake(source, entry, "must have either a mesh or a box, it has %s",
                            mesh ? "both" : "none");
    else if (given && !good)
        tobi_source_mistake(source, &box, "must have two corners, min and max");
    for (int a = 0; good && !mesh && a < scene->world.dimension; a++)
        if (!(def->box_max[a] > def->box_min[a]))
            tobi_source_mistake(source, &box,
                                "min is %.10g and max is %.10g in %c, max must be greater",
                                def->box_min[a], def->box_max[a], axis_name[a]);
}

/* A body moves by a motion or by forces, and forces need a method that knows them. */
static void check_dynamics(const tobi_scene *scene, tobi_source *source, int i, const tobi_place *entry)
{
    const tobi_body_def *def = &scene->bodies[i].def;
    const tobi_method *method = scene->method ? tobi_method_find(scene->method->name) : NULL;
    json_t *value = json_array_get(json_object_get(scene->root, "bodies"), (size_t)i);
    tobi_place dynamics = { entry, "dynamics", 0 }, motion = { entry, "motion", 0 },
               control = { entry, "control", 0 };
    int controls = json_object_get(value, "control") != NULL, moves = def->dynamics != TOBI_PRESCRIBED;
    if (moves && method && !method->free_bodies)
        tobi_source_mistake(source, &dynamics, "must be prescribed: bodies that move by forces need the method "
                            "\"mlsmpm\", %s does not know them yet", method->name);
    if (moves && json_object_get(value, "motion"))
        tobi_source_mistake(source, &motion, "is for prescribed bodies, this one is %s",
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
        check_name(scene, source, &entry, -1, i);
        check_file(source, &mesh, body->def.mesh);
        check_body_box(scene, source, i, &entry);
        check_dynamics(scene, source, i, &entry);
        if (is_zero(body->def.rotation_axis))
            tobi_source_mistake(source, &axis, "is zero, must have a direction");
    }
}

static void check_probes(const tobi_scene *scene, tobi_source *source)
{
    const tobi_world_def *w = &scene->world;
    tobi_place probes = { &root, "probes", 0 };
    for (int i = 0; i < scene->probe_count && !tobi_report_full(source->report); i++) {
        const tobi_probe_def *probe = &scene->probes[i];
        tobi_place entry = { &probes, NULL, (size_t)i }, name = { &entry, "name", 0 },
                   position = { &entry, "position", 0 };
        for (int j = 0; j < i; j++)
            if (probe->name && scene->probes[j].name && strcmp(probe->name, scene->probes[j].name) == 0)
                tobi_source_mistake(source, &name, "\"%s\" is already the name of probes[%d]",
                                    probe->name, j);
        for (int a = 0; has_domain(scene) && a < w->dimension; a++) {
            double at = probe->position[a];
            if (at < w->domain_min[a] || at > w->domain_max[a])
                tobi_source_mistake(source, &position, "is %.10g m in %c, the domain reaches from %.10g to "
                                    "%.10g m", at, axis_name[a], w->domain_min[a], w->domain_max[a]);
        }
    }
}

static void check_field(tobi_source *source, const tobi_place *place, const char *field)
{
    enum { FIELDS = 64 };
    const char *names[FIELDS], *unit;
    int components;
    size_t count = 0;
    char all[512] = "";
    for (; count < FIELDS; count++) {
        names[count] = tobi_world_field_name((int)count, &components, &unit);
        if (!names[count]) break;
        if (strcmp(names[count], field) == 0) return;
        size_t used = strlen(all);
        snprintf(all + used, sizeof all - used, "%s%s", used ? ", " : "", names[count]);
    }
    const char *near = tobi_suggest(field, names, count);
    if (near)
        tobi_source_mistake(source, place, "there is no field \"%s\"; did you mean \"%s\"?", field,
                            near);
    else tobi_source_mistake(source, place, "there is no field \"%s\"; allowed are %s", field, all);
}

static void check_output(const tobi_scene *scene, tobi_source *source)
{
    enum { MOST_OUTPUTS = 1000000 };
    tobi_place output = { &root, "output", 0 }, interval = { &output, "interval", 0 };
    tobi_place fields = { &output, "fields", 0 };
    if (scene->world.end_time/scene->output.interval > MOST_OUTPUTS)
        tobi_source_mistake(source, &interval,
                            "is %.10g s and makes more than %d outputs until end_time, %.10g s",
                            scene->output.interval, MOST_OUTPUTS, scene->world.end_time);
    tobi_place camera = { &output, "camera", 0 }, target = { &camera, "look_at", 0 };
    if (scene->output.camera_angle > 0 && scene->world.dimension == 3 &&
        memcmp(scene->output.camera_position, scene->output.camera_look_at, 3*sizeof(double)) == 0)
        tobi_source_mistake(source, &target, "is the camera's own position");
    char *copy = strdup(scene->output.fields ? scene->output.fields : ""), *next = copy;
    for (char *field; copy && (field = strsep(&next, ",")) != NULL;)
        if (*field) check_field(source, &fields, field);
    free(copy);
}

void tobi_scene_check(const tobi_scene *scene, tobi_source *source)
{
    check_method(scene, source);
    check_dfsph(scene, source);
    check_domain(scene, source);
    check_sides(scene, source);
    check_fluids(scene, source);
    check_bodies(scene, source);
    check_probes(scene, source);
    check_output(scene, source);
    tobi_references_check(scene, source);
}
