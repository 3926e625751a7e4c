/* Points of an outline: from a text, from a table, and the line above a base. Drawback: a point beyond the
   65536th is refused here, and one beyond the 5000th by the prism. */
#include "geom/outline.h"
#include "geom/points.h"
#include "base/plain.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_POINTS = 65536 };

static tobi_status add_point(tobi_outline *o, double u, double v, tobi_error *err)
{
    tobi_points p = { (double *)o->at, o->count, 2 };
    const tobi_status status = tobi_points_add(&p, (double[]){ u, v }, MOST_POINTS, err);
    *o = (tobi_outline){ (double (*)[2])p.at, p.count };
    return status;
}

tobi_status tobi_outline_parse(const char *text, tobi_outline *out, tobi_error *err)
{
    *out = (tobi_outline){ 0 };
    for (const char *c = text; *c;) {
        char *comma, *end;
        const double u = strtod(c, &comma), v = *comma == ',' ? strtod(comma + 1, &end) : NAN;
        if (!isfinite(u) || !isfinite(v) || comma == c || end == comma + 1 || (*end && *end != ' '))
            return tobi_fail(err, TOBI_INVALID, "\"%s\" is no point; points are like \"0,0 5,0.25 5,0\"",
                             tobi_excerpt(c).text);
        TOBI_TRY(add_point(out, u, v, err));
        c = end + strspn(end, " ");
    }
    return TOBI_OK;
}

tobi_status tobi_outline_read(const char *path, const int plane[2], tobi_outline *out, tobi_error *err)
{
    const char names[3] = { "xyz"[plane[0]], "xyz"[plane[1]], '\0' };
    tobi_points p;
    const tobi_status status = tobi_points_read(path, names, MOST_POINTS, &p, err);
    *out = (tobi_outline){ (double (*)[2])p.at, p.count };
    return status;
}

tobi_status tobi_outline_fill(tobi_outline *o, double base, tobi_error *err)
{
    for (int64_t k = 0; k < o->count; k++) {
        const double *p = o->at[k];
        if (k > 0 && !(p[0] > o->at[k - 1][0]))
            return tobi_fail(err, TOBI_INVALID, "with a base points go to the right, but (%g, %g) m follows "
                             "(%g, %g) m", p[0], p[1], o->at[k - 1][0], o->at[k - 1][1]);
        if (!(p[1] >= base))
            return tobi_fail(err, TOBI_INVALID, "the point (%g, %g) m lies below the base, %g m", p[0], p[1],
                             base);
    }
    if (o->count < 2)
        return tobi_fail(err, TOBI_INVALID, "%lld points; a line above a base has at least 2",
                         (long long)o->count);
    const double left = o->at[0][0], right = o->at[o->count - 1][0];
    TOBI_TRY(add_point(o, right, base, err));
    return add_point(o, left, base, err);
}

int tobi_outline_given(const tobi_outline_def *def) { return def->points || def->file; }

/* Points from the text or the file, and the base below them. */
static tobi_status read_outline(const char *whose, const tobi_outline_def *def, int axis, tobi_outline *o,
                                tobi_error *err)
{
    int plane[2];
    tobi_outline_axes(axis, plane);
    tobi_error why = { 0 };
    tobi_status status = def->points ? tobi_outline_parse(def->points, o, &why)
                                     : tobi_outline_read(def->file, plane, o, &why);
    if (status == TOBI_OK && def->base != TOBI_NO_PLACE)
        status = tobi_outline_fill(o, def->base, &why);
    return status == TOBI_OK ? status
                             : tobi_fail(err, status, "%s: its outline: %s", whose, why.text);
}

tobi_status tobi_outline_load(const char *whose, const tobi_outline_def *def, int dimension, int *axis,
                              tobi_outline *out, tobi_error *err)
{
    *out = (tobi_outline){ 0 };
    *axis = dimension == 2 || def->axis == 1 ? 2 : def->axis == 0 ? 1 : 0;
    if (def->points && def->file)
        return tobi_fail(err, TOBI_INVALID, "%s: its outline has points and a file; it may have "
                         "one", whose);
    if (dimension == 3 && !(def->to > def->from))
        return tobi_fail(err, TOBI_INVALID, "%s: its outline goes from %g to %g m along %c; to must "
                         "be greater than from", whose, def->from, def->to, "xyz"[*axis]);
    return read_outline(whose, def, *axis, out, err);
}

tobi_status tobi_mesh_outline(const char *whose, const tobi_outline_def *def, int dimension, tobi_mesh *out,
                              tobi_error *err)
{
    double from = def->from, to = def->to;
    int axis;
    tobi_outline o;
    tobi_status status = tobi_outline_load(whose, def, dimension, &axis, &o, err);
    for (int64_t k = 0; k < o.count && dimension == 2 && status == TOBI_OK; k++) {
        const double way = fmax(fabs(o.at[k][0] - o.at[0][0]), fabs(o.at[k][1] - o.at[0][1]));
        to = k == 0 ? way : fmax(to, way), from = -to;
    }
    if (status == TOBI_OK) status = tobi_mesh_prism(whose, &o, axis, from, to, out, err);
    tobi_outline_free(&o);
    return status;
}
