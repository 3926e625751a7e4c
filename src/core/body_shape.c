/* The mesh of a body: a file, or a shape by words. In 2-D a shape reaches far to both sides of the plane that
   cuts it. Drawback: facets of round bodies follow the spacing: a coarser scene has coarser bodies. */
#include "core/body.h"
#include "geom/outline.h"
#include "geom/shapes.h"
#include "geom/terrain.h"
#include "geom/vec3.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BOX, SPHERE, CYLINDER, CAPSULE, PLATE, KNIFE, OUTLINE, TERRAIN };

static tobi_status make_box(tobi_body *b, const tobi_body_def *def, int dimension, tobi_error *err)
{
    static const int32_t triangles[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                             {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                             {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    double corner[2][3], vertices[8][3];
    memcpy(corner[0], def->box_min, sizeof corner[0]);
    memcpy(corner[1], def->box_max, sizeof corner[1]);
    if (dimension == 2) {
        corner[1][2] = fmax(corner[1][0] - corner[0][0], corner[1][1] - corner[0][1]);
        corner[0][2] = -corner[1][2];
    }
    for (int a = 0; a < 3; a++)
        if (!(corner[1][a] > corner[0][a]))
            return tobi_fail(err, TOBI_INVALID,
                             "body '%s': has no mesh, and its box has max %g not above min %g along %c",
                             b->name, corner[1][a], corner[0][a], "xyz"[a]);
    for (int k = 0; k < 8; k++)
        for (int a = 0; a < 3; a++) vertices[k][a] = corner[k >> a & 1][a];
    return tobi_mesh_build(b->name, 8, (const double (*)[3])vertices, 12, triangles, &b->mesh, err);
}

/* Round about the axis; a sphere in 2-D is a cylinder that the plane cuts to a disc. */
static tobi_status make_round(tobi_body *b, const tobi_body_def *def, int kind, int dimension,
                              tobi_error *err)
{
    const double *start = kind == CYLINDER ? def->cylinder_start
                          : kind == CAPSULE ? def->capsule_start : def->sphere_centre;
    const double *end = kind == CYLINDER ? def->cylinder_end
                        : kind == CAPSULE ? def->capsule_end : def->sphere_centre;
    const int disc = kind == SPHERE && dimension == 2;
    tobi_round shape = { .radius = kind == CYLINDER ? def->cylinder_radius
                                   : kind == CAPSULE ? def->capsule_radius : def->sphere_radius,
                         .round_ends = kind != CYLINDER && !disc, .disc = disc };
    if (dimension == 2 && !disc)
        return tobi_fail(err, TOBI_UNSUPPORTED, "body '%s': a 2-D scene has no cylinders and capsules; a "
                         "sphere is a disc there", b->name);
    memcpy(shape.start, start, sizeof shape.start);
    memcpy(shape.end, end, sizeof shape.end);
    if (disc) shape.start[2] = -shape.radius, shape.end[2] = shape.radius;
    return tobi_mesh_round(b->name, &shape, b->spacing, &b->mesh, err);
}

static tobi_status make_plate(tobi_body *b, const tobi_body_def *def, int dimension, tobi_error *err)
{
    tobi_plate plate = { .length = def->plate_length, .width = def->plate_width,
                         .thickness = def->plate_thickness };
    memcpy(plate.centre, def->plate_centre, sizeof plate.centre);
    memcpy(plate.normal, def->plate_normal, sizeof plate.normal);
    memcpy(plate.along, def->plate_along, sizeof plate.along);
    if (dimension == 2) {
        plate.along[0] = -plate.normal[1];
        plate.along[1] = plate.normal[0];
        plate.normal[2] = plate.along[2] = 0;
        plate.width = 2*plate.length;
    }
    if (!(plate.length > 0) || !(plate.width > 0))
        return tobi_fail(err, TOBI_INVALID, "body '%s': its plate is %g m long and %g m wide; both must be "
                         "above 0", b->name, plate.length, plate.width);
    return tobi_mesh_plate(b->name, &plate, &b->mesh, err);
}

static tobi_status make_knife(tobi_body *b, const tobi_body_def *def, int dimension, tobi_error *err)
{
    tobi_knife knife = { .length = def->knife_length, .height = def->knife_height,
                         .thickness = def->knife_thickness, .angle = def->knife_angle };
    memcpy(knife.edge, def->knife_edge, sizeof knife.edge);
    memcpy(knife.direction, def->knife_direction, sizeof knife.direction);
    memcpy(knife.along, def->knife_along, sizeof knife.along);
    if (dimension == 2) {
        knife.edge[2] = knife.direction[2] = 0;
        if (knife.direction[0] == 0 && knife.direction[1] == 0) knife.direction[1] = -1;
        memcpy(knife.along, (double[3]){ 0, 0, 1 }, sizeof knife.along);
        knife.length = 2*knife.height;
    }
    if (!(knife.length > 0) || !(knife.height > 0))
        return tobi_fail(err, TOBI_INVALID, "body '%s': its knife is %g m long and %g m high; both must be "
                         "above 0", b->name, knife.length, knife.height);
    return tobi_mesh_knife(b->name, &knife, &b->mesh, err);
}

static tobi_status make_outline(tobi_body *b, const tobi_body_def *def, int dimension, tobi_error *err)
{
    char whose[120];
    snprintf(whose, sizeof whose, tr("body '%s'"), b->name);
    return tobi_mesh_outline(whose, &def->outline, dimension, &b->mesh, err);
}

/* The domain as a terrain lies in its file, before scale, rotation and translation; 0: it is no rectangle
   along the lines of the file. */
static int find_place(const tobi_body_def *def, const tobi_box *box, double lower[2], double upper[2])
{
    const double *axis = def->rotation_axis;
    const double turn = (axis[2] < 0 ? -1 : 1)*def->rotation_angle*acos(-1)/180;
    const int is_square = fabs(sin(2*turn)) < 1e-12;
    if (def->rotation_angle != 0 && (axis[0] != 0 || axis[1] != 0 || !is_square)) return 0;
    for (int a = 0; a < 2; a++) lower[a] = INFINITY, upper[a] = -INFINITY;
    for (int k = 0; k < 4; k++) {
        const double x = box->lower[0] + (k & 1 ? box->size[0] : 0) - def->translation[0];
        const double y = box->lower[1] + (k & 2 ? box->size[1] : 0) - def->translation[1];
        const double at[2] = { turn == 0 ? x : cos(turn)*x + sin(turn)*y,
                               turn == 0 ? y : cos(turn)*y - sin(turn)*x };
        for (int a = 0; a < 2; a++) {
            lower[a] = fmin(lower[a], at[a]/def->scale[a]);
            upper[a] = fmax(upper[a], at[a]/def->scale[a]);
        }
    }
    return 1;
}

/* A survey reaches farther, and is finer, than a scene needs it. One that moves stays as it is. */
static tobi_status fit_terrain(const tobi_body *b, const tobi_body_def *def, const tobi_box *box,
                               tobi_terrain *t, char *text, size_t room, tobi_error *err)
{
    const int64_t before[2] = { t->nx, t->ny };
    const double spacing[2] = { b->spacing/def->scale[0], b->spacing/def->scale[1] };
    double lower[2], upper[2];
    int64_t factor[2];
    int was_cut = 0;
    size_t used = 0;
    *text = '\0';
    if (!def->motion && def->dynamics == TOBI_PRESCRIBED && find_place(def, box, lower, upper)) {
        const tobi_status status = tobi_terrain_cut(t, lower, upper, &was_cut, err);
        if (status == TOBI_NOT_FOUND)
            return tobi_fail(err, TOBI_INVALID,
                             "body '%s': its terrain reaches from %g to %g m in x and from "
                             "%g to %g m in y of its file, the domain there from %g to %g m and from %g to "
                             "%g m", b->name, t->x[0], t->x[t->nx - 1], t->y[0], t->y[t->ny - 1], lower[0],
                             upper[0], lower[1], upper[1]);
        if (status != TOBI_OK) return status;
    }
    if (was_cut)
        used = (size_t)snprintf(text, room, tr("its terrain reaches beyond the domain: %lld x %lld of its "
                                               "%lld x %lld lines are used"), (long long)t->nx,
                                (long long)t->ny, (long long)before[0], (long long)before[1]);
    tobi_terrain_thin(t, spacing, factor);
    if (factor[0] > 1 || factor[1] > 1)
        snprintf(text + used, room - used,
                 tr("%sits terrain is finer than a quarter of the spacing: one line in %lld along x and in "
                    "%lld along y is kept, a mean around it"), used ? "; " : "", (long long)factor[0],
                 (long long)factor[1]);
    return TOBI_OK;
}

static tobi_status make_terrain(tobi_body *b, const tobi_body_def *def, const tobi_box *box, tobi_error *err)
{
    tobi_terrain t;
    tobi_error why = { 0 };
    char text[400] = "";
    if (box->dimension == 2)
        return tobi_fail(err, TOBI_UNSUPPORTED, "body '%s': a 2-D scene has no terrain; an outline with a "
                         "base is a bed there", b->name);
    tobi_status status = tobi_terrain_read(def->terrain_file, &t, &why);
    if (status != TOBI_OK) tobi_fail(err, status, "body '%s': its terrain: %s", b->name, why.text);
    else status = fit_terrain(b, def, box, &t, text, sizeof text, err);
    if (status == TOBI_OK) status = tobi_mesh_terrain(b->name, &t, def->terrain_base, &b->mesh, err);
    if (status == TOBI_OK && *text) tobi_mesh_note(&b->mesh, "%s", text);
    tobi_terrain_free(&t);
    return status;
}

static int find_kind(const tobi_body_def *def, int *shapes)
{
    const double size[] = { 0, def->sphere_radius, def->cylinder_radius, def->capsule_radius,
                            def->plate_thickness, def->knife_thickness,
                            tobi_outline_given(&def->outline), def->terrain_file != NULL };
    int kind = BOX;
    *shapes = def->mesh != NULL;
    for (int k = SPHERE; k <= TERRAIN; k++)
        if (size[k] > 0) ++*shapes, kind = k;
    return kind;
}

const char *tobi_body_shape_key(const tobi_body_def *def)
{
    static const char *const keys[] = { "box", "sphere", "cylinder", "capsule", "plate", "knife", "outline",
                                        "terrain" };
    int shapes;
    return def->mesh ? "mesh" : keys[find_kind(def, &shapes)];
}

tobi_status tobi_body_make_mesh(tobi_body *b, const tobi_body_def *def, const tobi_box *box, tobi_error *err)
{
    const int dimension = box->dimension;
    int shapes;
    const int kind = find_kind(def, &shapes);
    if (shapes > 1)
        return tobi_fail(err, TOBI_INVALID, "body '%s' has %d shapes; it may have one: a mesh, a box, a "
                         "sphere, a cylinder, a capsule, a plate, a knife, an outline or a terrain", b->name,
                         shapes);
    if (def->mesh) return tobi_at_key(err, tobi_mesh_read(def->mesh, &b->mesh, err), "mesh");
    const tobi_status status = kind == BOX     ? make_box(b, def, dimension, err)
                               : kind == PLATE ? make_plate(b, def, dimension, err)
                               : kind == KNIFE ? make_knife(b, def, dimension, err)
                               : kind == OUTLINE ? make_outline(b, def, dimension, err)
                               : kind == TERRAIN ? make_terrain(b, def, box, err)
                                               : make_round(b, def, kind, dimension, err);
    return tobi_at_key(err, status, "%s", tobi_body_shape_key(def));
}

void tobi_body_take_centre(tobi_body *b, const tobi_body_def *def, int dimension)
{
    const double *given = def->centre_of_mass;
    double min[3], max[3];
    int outside = 0;
    if (given[0] == TOBI_NO_PLACE) return;
    tobi_mesh_box(&b->mesh, min, max);
    for (int a = 0; a < dimension; a++) {
        b->middle[a] = b->rest.centre[a] - given[a];
        b->rest.centre[a] = given[a];
        outside |= !(given[a] >= min[a] && given[a] <= max[a]);
    }
    if (outside)
        tobi_mesh_note(&b->mesh, tr("its centre_of_mass, (%g, %g, %g) m, lies outside of it, (%g, %g, %g) to "
                       "(%g, %g, %g) m: it is a place in the domain, as the body starts"), given[0], given[1],
                       given[2], min[0], min[1], min[2], max[0], max[1], max[2]);
}

tobi_status tobi_body_build_rest(tobi_body *b, tobi_error *err)
{
    if (b->rest_bvh) return TOBI_OK;
    if (!b->rest_vertex) b->rest_vertex = malloc((size_t)(b->mesh.vertex_count + 1)*sizeof *b->rest_vertex);
    if (!b->rest_vertex)
        return tobi_fail(err, TOBI_NO_MEMORY, "body '%s': no memory for its rest pose", b->name);
    for (int64_t i = 0; i < b->mesh.vertex_count; i++)
        vec3_sub(b->rest_vertex[i], b->mesh.vertices[i], b->rest.centre);
    TOBI_TRY(tobi_bvh_build(b->mesh.vertex_count, (const double (*)[3])b->rest_vertex, b->mesh.triangle_count,
                            (const int32_t (*)[3])b->mesh.triangles, &b->rest_bvh, err));
    if (b->mesh.overlapping) tobi_bvh_use_winding(b->rest_bvh);
    return TOBI_OK;
}
