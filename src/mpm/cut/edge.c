/* The edge of a blade: found in its mesh, or given as a straight line. */
#include "core/body.h"
#include "geom/vec3.h"
#include <stdlib.h>

/* From the domain's coordinates as the body starts to its rest axes, about the centre of mass. */
static void to_rest(const tobi_body *b, const double at[3], double out[3])
{
    double arm[3];
    vec3_sub(arm, at, b->centre);
    for (int k = 0; k < 3; k++) out[k] = vec3_dot(b->frame[k], arm);
}

static tobi_status check_near(const tobi_body *b, const char *key, const double at[3], int dimension,
                              tobi_error *err)
{
    double lower[3], upper[3];
    tobi_bvh_box(b->bvh, lower, upper);
    for (int a = 0; a < dimension; a++) {
        double size = upper[a] - lower[a];
        lower[a] += b->lower[a];
        upper[a] += b->lower[a];
        for (int k = 0; k < dimension; k++) size = fmax(size, upper[k] - lower[k]);
        if (at[a] < lower[a] - size || at[a] > upper[a] + size)
            return tobi_fail(err, TOBI_INVALID,
                             "body '%s': %s lies at %c = %g m, farther from the body (%g to %g m) than "
                             "its size of %g m; an edge belongs to its body",
                             b->name, key, "xyz"[a], at[a], lower[a], upper[a], size);
    }
    return TOBI_OK;
}

static tobi_status take_given(tobi_body *b, const tobi_body_def *def, int dimension, tobi_error *err)
{
    double ends[2][3];
    for (int a = 0; a < 3; a++) {
        int deep = dimension == 2;
        ends[0][a] = deep && a == 2 ? -0.5 : def->edge_start[a];
        ends[1][a] = !deep ? def->edge_end[a] : a == 2 ? 0.5 : def->edge_start[a];
    }
    TOBI_TRY(check_near(b, "edge_start", ends[0], dimension, err));
    if (dimension == 3) TOBI_TRY(check_near(b, "edge_end", ends[1], dimension, err));
    if (!(vec3_distance2(ends[0], ends[1]) > 0))
        return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "body '%s': edge_start and edge_end are the "
                                          "same point; an edge has a length", b->name), "edge_end");
    b->edge = calloc(1, sizeof *b->edge);
    if (!b->edge) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for an edge");
    b->edge_count = 1;
    to_rest(b, ends[0], b->edge->a);
    to_rest(b, ends[1], b->edge->b);
    return TOBI_OK;
}

static tobi_status look_for_edge(tobi_body *b, double degrees, int dimension, tobi_error *err)
{
    /* Twice the volume over the surface is the thickness of a plate, whatever its direction. */
    const double thickness = 2*b->rest.volume/b->rest.area;
    tobi_sharp found;
    TOBI_TRY(tobi_sharp_find(&b->mesh, degrees, 0.25*thickness, dimension == 2, &found, err));
    if (found.count == 0) {
        free(found.edge);
        return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "body '%s' is a blade without an edge: its "
                                          "faces meet at %.3g degrees at the sharpest, edge_angle allows "
                                          "%.3g; a sharper mesh, a larger edge_angle, or edge_start and "
                                          "edge_end give it one", b->name, found.sharpest, degrees), "blade");
    }
    double length = 0;
    for (int64_t i = 0; i < found.count; i++)
        length += sqrt(vec3_distance2(found.edge[i].a, found.edge[i].b));
    tobi_mesh_note(&b->mesh, tr("cuts with an edge of %.4g m, found in its mesh in %lld piece%s"), length,
                   (long long)found.count, found.count == 1 ? "" : "s");
    b->edge = found.edge;
    b->edge_count = found.count;
    for (int64_t i = 0; i < b->edge_count; i++) {
        vec3_sub(b->edge[i].a, b->edge[i].a, b->rest.centre);
        vec3_sub(b->edge[i].b, b->edge[i].b, b->rest.centre);
    }
    return TOBI_OK;
}

tobi_status tobi_body_find_edge(tobi_body *b, const tobi_body_def *def, int dimension, tobi_error *err)
{
    int given = 0;
    if (!def->blade) return TOBI_OK;
    if (b->deforms)
        return tobi_fail(err, TOBI_UNSUPPORTED,
                         "body '%s' is a blade, but its motion changes its shape; a blade is rigid",
                         b->name);
    for (int a = 0; a < dimension; a++) given |= def->edge_start[a] != 0 || def->edge_end[a] != 0;
    TOBI_TRY(given ? take_given(b, def, dimension, err) : look_for_edge(b, def->edge_angle, dimension, err));
    b->edge_now = calloc((size_t)b->edge_count, sizeof *b->edge_now);
    return b->edge_now ? TOBI_OK : tobi_fail(err, TOBI_NO_MEMORY, "no memory for an edge");
}
