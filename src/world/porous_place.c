/* Where porous zones lie: their boxes, outlines and cylinders, and that they do not overlap. Drawback:
   overlaps see cylinders as polygons. */
#include "base/error.h"
#include "geom/outline.h"
#include "world/world.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Of the smaller zone: outlines that users round overlap by slivers. */
static const double SLIVER = 0.01;
enum { FACETS = TOBI_POROUS_FACETS };

#define REFUSE(status, key, ...) \
    return tobi_at_key(err, tobi_fail(err, status, __VA_ARGS__), "%s", key)

static tobi_status lay_box(const tobi_box *box, const tobi_porous_def *def, tobi_porous *z, tobi_error *err)
{
    z->extent = 1;
    z->thickness = INFINITY;
    for (int a = 0; a < box->dimension; a++) {
        z->lower[a] = def->box_min[a] - box->lower[a];
        z->upper[a] = def->box_max[a] - box->lower[a];
        if (!(z->upper[a] > z->lower[a]))
            REFUSE(TOBI_INVALID, "box.max", tr("porous zone '%s' reaches from %g to %g m in %c: allowed are "
                   "upper corners above the lower ones"), def->name, def->box_min[a], def->box_max[a],
                   "xyz"[a]);
        z->extent *= z->upper[a] - z->lower[a];
        z->thickness = fmin(z->thickness, z->upper[a] - z->lower[a]);
    }
    return TOBI_OK;
}

/* m: the rectangle of the same area and perimeter has this as its lesser side. */
static double find_lesser_side(const tobi_polygon_size *s)
{
    const double half = 0.5*s->perimeter;
    return 0.5*(half - sqrt(fmax(0, half*half - 4*s->area)));
}

/* Corners stay as they are given, also on straight sides: zones with the same corners have the same sides. */
static tobi_status lay_outline(const tobi_box *box, const tobi_porous_def *def, tobi_porous *z,
                               tobi_error *err)
{
    char whose[TOBI_NOTE];
    tobi_outline given, clean = { 0 };
    snprintf(whose, sizeof whose, tr("porous zone '%s'"), def->name);
    tobi_status status = tobi_outline_load(whose, &def->outline, box->dimension, &z->axis, &given, err);
    if (status == TOBI_OK) status = tobi_outline_clean(whose, &given, &clean, err);
    tobi_outline_free(&clean);
    z->corners = given.at;
    z->corner_count = given.count;
    if (status != TOBI_OK) return status;
    tobi_outline_axes(z->axis, z->plane);
    for (int64_t k = 0; k < given.count; k++)
        for (int n = 0; n < 2; n++) given.at[k][n] -= box->lower[z->plane[n]];
    const tobi_polygon_size s = tobi_polygon_measure(tobi_porous_polygon(z));
    z->extent = s.area;
    z->thickness = find_lesser_side(&s);
    for (int n = 0; n < 2; n++) z->lower[z->plane[n]] = s.lower[n], z->upper[z->plane[n]] = s.upper[n];
    if (box->dimension == 2) return TOBI_OK;
    z->lower[z->axis] = def->outline.from - box->lower[z->axis];
    z->upper[z->axis] = def->outline.to - box->lower[z->axis];
    z->extent *= z->upper[z->axis] - z->lower[z->axis];
    z->thickness = fmin(z->thickness, z->upper[z->axis] - z->lower[z->axis]);
    return TOBI_OK;
}

/* About its section, for pictures and overlaps; a ring goes around outside and back inside. */
static tobi_status draw_circle(tobi_porous *z, tobi_error *err)
{
    const int rings = z->inner > 0 ? 2 : 1, points = rings == 2 ? FACETS + 1 : FACETS;
    z->corners = malloc((size_t)(rings*points)*sizeof *z->corners);
    if (!z->corners) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a shape");
    z->corner_count = rings*points;
    for (int k = 0; k < rings*points; k++) {
        const double turn = 2*M_PI*(k < points ? k : 2*points - 1 - k)/FACETS;
        const double r = k < points ? z->radius : z->inner;
        z->corners[k][0] = z->centre[0] + r*cos(turn);
        z->corners[k][1] = z->centre[1] + r*sin(turn);
    }
    return TOBI_OK;
}

static tobi_status lay_cylinder(const tobi_box *box, const tobi_porous_def *def, tobi_porous *z,
                                tobi_error *err)
{
    const double *a = def->cylinder_start, *b = def->cylinder_end;
    int ways = 0;
    z->axis = 2;
    for (int n = 0; n < box->dimension && box->dimension == 3; n++)
        if (a[n] != b[n]) ways++, z->axis = n;
    if (box->dimension == 3 && ways != 1)
        return tobi_fail(err, TOBI_INVALID, "porous zone '%s': its cylinder goes from (%g, %g, %g) to "
                         "(%g, %g, %g) m: allowed are cylinders along x, y or z", def->name, a[0], a[1], a[2],
                         b[0], b[1], b[2]);
    if (!(def->cylinder_inner < def->cylinder_radius))
        return tobi_fail(err, TOBI_INVALID, "porous zone '%s': its inner radius is %g m, its radius %g m; "
                         "allowed are smaller inner ones", def->name, def->cylinder_inner,
                         def->cylinder_radius);
    tobi_outline_axes(z->axis, z->plane);
    z->radius = def->cylinder_radius;
    z->inner = def->cylinder_inner;
    z->extent = M_PI*(z->radius*z->radius - z->inner*z->inner);
    z->thickness = z->inner > 0 ? z->radius - z->inner : 2*z->radius;
    for (int n = 0; n < 2; n++) {
        z->centre[n] = a[z->plane[n]] - box->lower[z->plane[n]];
        z->lower[z->plane[n]] = z->centre[n] - z->radius;
        z->upper[z->plane[n]] = z->centre[n] + z->radius;
    }
    if (box->dimension == 3) {
        z->lower[z->axis] = fmin(a[z->axis], b[z->axis]) - box->lower[z->axis];
        z->upper[z->axis] = fmax(a[z->axis], b[z->axis]) - box->lower[z->axis];
        z->extent *= z->upper[z->axis] - z->lower[z->axis];
        z->thickness = fmin(z->thickness, z->upper[z->axis] - z->lower[z->axis]);
    }
    return draw_circle(z, err);
}

static int boxes_overlap(const tobi_porous *a, const tobi_porous *b, int dimension)
{
    int apart = 0;
    for (int n = 0; n < dimension; n++) apart |= a->lower[n] >= b->upper[n] || a->upper[n] <= b->lower[n];
    return !apart;
}

/* The section of a zone across an axis: of a box into `room`. */
static tobi_polygon cut(const tobi_porous *z, const int plane[2], double room[4][2])
{
    if (z->corners) return tobi_porous_polygon(z);
    for (int k = 0; k < 4; k++) {
        room[k][0] = (k == 1 || k == 2 ? z->upper : z->lower)[plane[0]];
        room[k][1] = (k >= 2 ? z->upper : z->lower)[plane[1]];
    }
    return (tobi_polygon){ (const double (*)[2])room, 4 };
}

/* As another one sees it that goes along a different axis. */
static tobi_crossed cross(const tobi_porous *z, const tobi_porous *other)
{
    return (tobi_crossed){ tobi_porous_polygon(z), z->plane[0] == other->axis,
                           other->lower[other->axis], other->upper[other->axis] };
}

static tobi_status check_crossed(const tobi_porous *z, const tobi_porous *other, const char *name,
                                 const char *key, tobi_error *err)
{
    const tobi_crossed a = cross(z, other), b = cross(other, z);
    const double common = tobi_polygon_crossed(&a, &b);
    if (common <= SLIVER*fmin(z->extent, other->extent)) return TOBI_OK;
    REFUSE(TOBI_INVALID, key, tr("porous zone '%s' overlaps '%s' by %.3g m3: allowed are zones that touch, "
           "and slivers up to %g of the smaller one"), name, other->name, common, SLIVER);
}

static tobi_status check_overlap(const tobi_porous *z, const tobi_porous *other, const char *name,
                                 int dimension, tobi_error *err)
{
    const tobi_porous *drawn = z->corners ? z : other;
    double room[2][4][2];
    if (!boxes_overlap(z, other, dimension)) return TOBI_OK;
    if (!z->corners && !other->corners)
        REFUSE(TOBI_INVALID, "box",
               tr("porous zone '%s' overlaps '%s': allowed are boxes that touch at most"),
               name, other->name);
    const char *key = z->radius > 0 ? "cylinder" : z->corners ? "outline" : "box";
    if (z->corners && other->corners && z->axis != other->axis)
        return check_crossed(z, other, name, key, err);
    const tobi_polygon a = cut(z, drawn->plane, room[0]), b = cut(other, drawn->plane, room[1]);
    const double least = fmin(tobi_polygon_measure(a).area, tobi_polygon_measure(b).area);
    const double common = tobi_polygon_common(a, b);
    if (common <= SLIVER*least) return TOBI_OK;
    REFUSE(TOBI_INVALID, key, tr("the section of porous zone '%s' overlaps that of '%s' by %.3g m2: allowed "
           "are zones that touch, and slivers up to %g of the smaller one"), name, other->name, common,
           SLIVER);
}

tobi_status tobi_porous_place(const tobi_world *w, const tobi_porous_def *def, tobi_porous *z,
                              tobi_error *err)
{
    const tobi_box *box = &w->system[0].box;
    const int outline = tobi_outline_given(&def->outline), cylinder = def->cylinder_radius > 0;
    const char *key = outline ? "outline" : cylinder ? "cylinder" : "box";
    int boxed = 0;
    for (int a = 0; a < box->dimension; a++) boxed |= def->box_min[a] != 0 || def->box_max[a] != 0;
    if (outline + cylinder + boxed > 1)
        return tobi_fail(err, TOBI_INVALID, "porous zone '%s' has %d shapes; it may have one: a box, an "
                         "outline or a cylinder", def->name, outline + cylinder + boxed);
    TOBI_TRY(tobi_at_key(err, outline ? lay_outline(box, def, z, err)
                              : cylinder ? lay_cylinder(box, def, z, err)
                                         : lay_box(box, def, z, err), "%s", key));
    for (int a = 0; a < box->dimension; a++)
        if (!(z->lower[a] < box->size[a] && z->upper[a] > 0))
            REFUSE(TOBI_INVALID, key, tr("porous zone '%s' lies from %g to %g m in %c, "
                   "outside of the domain"), def->name, z->lower[a] + box->lower[a],
                   z->upper[a] + box->lower[a], "xyz"[a]);
    for (int k = 0; k < w->sim.porous_count; k++)
        TOBI_TRY(check_overlap(z, &w->sim.porous[k], def->name, box->dimension, err));
    return TOBI_OK;
}

/* Across the longest side of its section, or along its extrusion where it is thinner. */
static void find_thin_direction(const tobi_porous *z, int dimension, double direction[3])
{
    double along[2];
    const tobi_polygon p = tobi_porous_polygon(z);
    tobi_polygon_longest(p, along);
    const double across = tobi_polygon_measure(p).area/tobi_polygon_extent(p, along);
    if (dimension == 3 && z->upper[z->axis] - z->lower[z->axis] < across) {
        direction[z->axis] = 1;
        return;
    }
    direction[z->plane[0]] = -along[1];
    direction[z->plane[1]] = along[0];
}

void tobi_porous_thin_direction(tobi_porous *z, int dimension, double direction[3])
{
    int thinnest = 0;
    for (int a = 0; a < 3; a++) direction[a] = 0;
    if (z->radius > 0) {
        const double length = dimension == 3 ? z->upper[z->axis] - z->lower[z->axis] : INFINITY;
        const double wide = z->inner > 0 ? z->radius - z->inner : 2*z->radius;
        if (length < wide) direction[z->axis] = 1;
        else z->radial = z->inner > 0;
        return;
    }
    if (z->corners) {
        find_thin_direction(z, dimension, direction);
        return;
    }
    for (int a = 1; a < dimension; a++)
        if (z->upper[a] - z->lower[a] < z->upper[thinnest] - z->lower[thinnest]) thinnest = a;
    direction[thinnest] = 1;
}

double tobi_porous_thickness(const tobi_porous *z, int dimension)
{
    const double *d = z->direction;
    double least = INFINITY;
    if (z->radial) return z->radius - z->inner;
    for (int a = 0; a < dimension; a++)
        if (fabs(d[a]) > 0 && (!z->corners || a == z->axis))
            least = fmin(least, (z->upper[a] - z->lower[a])/fabs(d[a]));
    if (!z->corners) return least;
    const double u = d[z->plane[0]], v = d[z->plane[1]], part = hypot(u, v);
    const tobi_polygon p = tobi_porous_polygon(z);
    if (!(part > 0)) return least;
    const double across = tobi_polygon_extent(p, (double[]){ -v/part, u/part });
    return fmin(least, tobi_polygon_measure(p).area/across/part);
}
