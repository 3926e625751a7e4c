/* Checks of what fills a scene at the start: boxes, spheres, meshes. */
#include "scene/scene.h"
#include "base/param.h"
#include "geom/outline.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char axis_name[3] = "xyz";

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
        } else if (tobi_check_has_domain(scene) && (fill->box_min[a] < w->domain_min[a] - slack(w, a) ||
                                         fill->box_max[a] > w->domain_max[a] + slack(w, a))) {
            tobi_source_mistake(source, &box,
                                "reaches from %.10g to %.10g m in %c, the domain only from %.10g "
                                "to %.10g m",
                                fill->box_min[a], fill->box_max[a], axis_name[a], w->domain_min[a],
                                w->domain_max[a]);
        }
    }
}

static void check_sphere(const tobi_scene *scene, tobi_source *source, const tobi_fill_def *fill,
                         const tobi_place *place)
{
    const tobi_world_def *w = &scene->world;
    tobi_place sphere = { place, "sphere", 0 }, radius = { &sphere, "radius", 0 };
    if (!(fill->radius > 0)) {
        tobi_source_mistake(source, &radius, "is %.10g m, must be greater than 0 m", fill->radius);
        return;
    }
    for (int a = 0; tobi_check_has_domain(scene) && a < w->dimension; a++) {
        double low = fill->centre[a] - fill->radius, high = fill->centre[a] + fill->radius;
        if (low < w->domain_min[a] - slack(w, a) || high > w->domain_max[a] + slack(w, a))
            tobi_source_mistake(source, &sphere,
                                "reaches from %.10g to %.10g m in %c, the domain only from %.10g "
                                "to %.10g m", low, high, axis_name[a], w->domain_min[a], w->domain_max[a]);
    }
}

/* Both members of a box or sphere must be there, and right: then 1. */
static int check_pair(tobi_source *source, const tobi_place *place, const tobi_bound *bound,
                      const char *shape, const char *first, const char *second)
{
    const tobi_param_table *t = &tobi_fill_table;
    char key[2][40];
    snprintf(key[0], sizeof key[0], "%s.%s", shape, first);
    snprintf(key[1], sizeof key[1], "%s.%s", shape, second);
    for (int k = 0; k < 2; k++) {
        tobi_place outer = { place, shape, 0 }, inner = { &outer, k ? second : first, 0 };
        if (!tobi_bind_has(t, bound->given, key[k]))
            tobi_source_mistake(source, &inner, "is missing: a %s has %s and %s", shape, first, second);
    }
    return tobi_bind_has(t, bound->good, key[0]) && tobi_bind_has(t, bound->good, key[1]);
}

static void check_motion(const tobi_scene *scene, tobi_source *source, const tobi_fill_def *fill,
                         const tobi_place *place)
{
    tobi_place spin = { place, "spin", 0 };
    if (scene->world.dimension != 2) return;
    if (fill->velocity[2] != 0)
        tobi_source_mistake(source, place, "moves in z, which a 2-D scene does not have");
    if (fill->spin[0] != 0 || fill->spin[1] != 0)
        tobi_source_mistake(source, &spin, "must be about z in a 2-D scene: [0, 0, spin]");
}

static void check_vessel(const tobi_scene *scene, tobi_source *source, const tobi_scene_fill *fill,
                         const tobi_place *place)
{
    tobi_place vessel = { place, "vessel", 0 }, level = { place, "level", 0 };
    const char *name = fill->def.vessel;
    if (!tobi_bind_has(&tobi_fill_table, fill->bound.given, "level"))
        tobi_source_mistake(source, &level, "is missing: a vessel is filled up to a level");
    for (int k = 0; name && k < scene->body_count; k++) {
        const tobi_body_def *body = &scene->bodies[k].def;
        if (!body->name || strcmp(body->name, name) != 0) continue;
        if (!body->vessel)
            tobi_source_mistake(source, &vessel, "\"%s\" is no vessel: bodies[%d] needs \"vessel\": true",
                                name, k);
        return;
    }
    if (name) tobi_source_mistake(source, &vessel, "\"%s\" is no body of the scene", name);
}

/* Both say how a vessel is filled; beside another shape they would do nothing. */
static void check_unfilled(tobi_source *source, const tobi_scene_fill *fill, const tobi_place *place)
{
    static const char *const of_vessel[] = { "level", "seed" };
    const int given[] = { fill->def.level != 0, fill->def.seed[0] > -1e9 };
    for (int k = 0; k < 2; k++) {
        const tobi_place key = { place, of_vessel[k], 0 };
        if (given[k]) tobi_source_mistake_at_key(source, &key, "is for a vessel; this region has its shape");
    }
}

static void check_fill(const tobi_scene *scene, tobi_source *source, const tobi_scene_fill *fill,
                       const tobi_place *place)
{
    static const char *const of_mesh[] = { "scale", "translation", "rotation.axis", "rotation.angle" };
    const tobi_param_table *t = &tobi_fill_table;
    const tobi_rows given = fill->bound.given;
    tobi_place mesh = { place, "mesh", 0 };
    tobi_place rotation = { place, "rotation", 0 }, axis = { &rotation, "axis", 0 };
    int has_box = tobi_bind_has(t, given, "box.min") || tobi_bind_has(t, given, "box.max");
    int has_sphere = tobi_bind_has(t, given, "sphere.centre") || tobi_bind_has(t, given, "sphere.radius");
    int has_mesh = tobi_bind_has(t, given, "mesh"), has_vessel = tobi_bind_has(t, given, "vessel");
    int has_outline = tobi_bind_has(t, given, "outline.points") || tobi_bind_has(t, given, "outline.file");
    int shapes = has_box + has_sphere + has_mesh + has_outline + has_vessel;
    if (shapes != 1)
        tobi_source_mistake(source, place, "must have one of box, sphere, mesh, outline and vessel, it "
                            "has %s", shapes ? tr("several") : tr("none"));
    else if (has_outline) tobi_check_outline(source, &(tobi_place){ place, "outline", 0 }, &fill->def.outline,
                                             scene->world.dimension);
    else if (has_vessel) check_vessel(scene, source, fill, place);
    else if (has_mesh) tobi_check_file(source, &mesh, fill->def.mesh);
    else if (has_box && check_pair(source, place, &fill->bound, "box", "min", "max"))
        check_box(scene, source, &fill->def, place);
    else if (has_sphere && check_pair(source, place, &fill->bound, "sphere", "centre", "radius"))
        check_sphere(scene, source, &fill->def, place);
    if (shapes == 1 && !has_vessel) check_unfilled(source, fill, place);
    for (int k = 0; k < 4 && !has_mesh && !has_outline; k++) {
        if (!tobi_bind_has(t, given, of_mesh[k])) continue;
        tobi_source_mistake(source, place, "scale, rotation and translation belong to a mesh or an outline");
        break;
    }
    const double *a = fill->def.rotation_axis;
    if ((has_mesh || has_outline) && a[0] == 0 && a[1] == 0 && a[2] == 0)
        tobi_source_mistake(source, &axis, "is zero, must have a direction");
    check_motion(scene, source, &fill->def, place);
}

void tobi_check_fills(const tobi_scene *scene, tobi_source *source, const tobi_place *owner,
                      const tobi_scene_fill *fills, int count)
{
    tobi_place fill = { owner, "fill", 0 };
    for (int j = 0; j < count; j++) {
        tobi_place entry = { &fill, NULL, (size_t)j };
        check_fill(scene, source, &fills[j], &entry);
    }
}

/* A filled box or sphere, by its box, and where it stands in the scene. */
typedef struct region {
    const char *list;              /* "fluids" or "solids" */
    int owner, index;
    double lower[3], upper[3], radius;
} region;

static int do_overlap(const tobi_world_def *w, const region *a, const region *b)
{
    double apart = 0, reach = a->radius + b->radius;
    if (strcmp(a->list, b->list) != 0) return 0;     /* fluids are cut out of solids */
    if (a->owner != b->owner && strcmp(a->list, "fluids") == 0) return 0;   /* the later takes the place */
    for (int k = 0; k < w->dimension; k++) {
        if (fmin(a->upper[k], b->upper[k]) - fmax(a->lower[k], b->lower[k]) <= slack(w, k)) return 0;
        /* From a sphere's centre to the other's nearest point: its centre, or its box. */
        double p = 0.5*(a->lower[k] + a->upper[k]), q = 0.5*(b->lower[k] + b->upper[k]);
        if (b->radius == 0) q = fmin(fmax(p, b->lower[k]), b->upper[k]);
        if (a->radius == 0) p = fmin(fmax(q, a->lower[k]), a->upper[k]);
        apart += (p - q)*(p - q);
    }
    return reach == 0 || sqrt(apart) < reach*(1 - 1e-9);
}

static int order_regions(const region *p, const region *q, int axis)
{
    if (p->lower[axis] != q->lower[axis]) return p->lower[axis] > q->lower[axis] ? 1 : -1;
    return p->owner != q->owner ? p->owner - q->owner : p->index - q->index;
}

static int order_x(const void *a, const void *b) { return order_regions(a, b, 0); }
static int order_y(const void *a, const void *b) { return order_regions(a, b, 1); }
static int order_z(const void *a, const void *b) { return order_regions(a, b, 2); }

/* Sorts along an axis; returns how many pairs overlap along it. */
static double sort_regions(region *list, size_t count, int axis)
{
    static int (*const orders[3])(const void *, const void *) = { order_x, order_y, order_z };
    double pairs = 0;
    qsort(list, count, sizeof *list, orders[axis]);
    for (size_t i = 0; i < count; i++) {
        size_t low = i + 1, high = count;
        while (low < high) {
            const size_t middle = (low + high)/2;
            if (list[middle].lower[axis] < list[i].upper[axis]) low = middle + 1;
            else high = middle;
        }
        pairs += (double)(low - i - 1);
    }
    return pairs;
}

static size_t list_regions(region *list, size_t count, const char *name, int owner,
                           const tobi_scene_fill *fills, int fill_count)
{
    for (int j = 0; j < fill_count; j++) {
        const tobi_fill_def *f = &fills[j].def;
        region *r = &list[count];
        if (f->mesh || tobi_outline_given(&f->outline) || f->vessel) continue;
        count++;
        *r = (region){ .list = name, .owner = owner, .index = j, .radius = f->radius };
        for (int a = 0; a < 3; a++) {
            r->lower[a] = f->radius > 0 ? f->centre[a] - f->radius : f->box_min[a];
            r->upper[a] = f->radius > 0 ? f->centre[a] + f->radius : f->box_max[a];
        }
    }
    return count;
}

static void report_overlap(tobi_source *source, const region *first, const region *second)
{
    tobi_place root = { 0 }, list = { &root, second->list, 0 };
    tobi_place owner = { &list, NULL, (size_t)second->owner };
    tobi_place fill = { &owner, "fill", 0 }, entry = { &fill, NULL, (size_t)second->index };
    tobi_source_mistake(source, &entry, "overlaps the %s %s[%d].fill[%d]",
                        first->radius > 0 ? "sphere" : "box", first->list, first->owner, first->index);
}

/* Sorted along the axis on which fewest meet, so that many regions side by side cost little. */
void tobi_check_overlaps(const tobi_scene *scene, tobi_source *source)
{
    size_t count = 0;
    for (int i = 0; i < scene->fluid_count; i++) count += (size_t)scene->fluids[i].fill_count;
    for (int i = 0; i < scene->solid_count; i++) count += (size_t)scene->solids[i].fill_count;
    region *list = calloc(count + 1, sizeof *list);
    if (!list) return;
    count = 0;
    for (int i = 0; i < scene->fluid_count; i++)
        count = list_regions(list, count, "fluids", i, scene->fluids[i].fills, scene->fluids[i].fill_count);
    for (int i = 0; i < scene->solid_count; i++)
        count = list_regions(list, count, "solids", i, scene->solids[i].fills, scene->solids[i].fill_count);
    int best = 0;
    double least = INFINITY;
    for (int a = 0; a < scene->world.dimension; a++) {
        const double pairs = sort_regions(list, count, a);
        if (pairs < least) best = a, least = pairs;
    }
    sort_regions(list, count, best);
    for (size_t i = 0; i < count; i++)
        for (size_t j = i + 1; j < count && list[j].lower[best] < list[i].upper[best] &&
             !tobi_report_full(source->report); j++)
            if (do_overlap(&scene->world, &list[i], &list[j])) report_overlap(source, &list[i], &list[j]);
    free(list);
}
