/* The depth below both surfaces changes by at most a metre per metre; so a box of space whose middle is d
   deep holds nothing deeper than d and half its diagonal, and boxes that cannot hold more than is known are
   dropped, others halved. Corners, edges and faces play no part: coinciding faces, one body within another
   and bars that cross are all the same. Drawback: thin layers cost many boxes, hence a least depth and a
   largest number of boxes, which large plates close together reach. */
#include "rigid/overlap.h"
#include "geom/vec3.h"
#include <string.h>

enum { MOST_BOXES = 200000, STACK = 256 };

typedef struct search {
    const tobi_bvh *a, *b;
    double turn[3][3], shift[3];     /* from b's rest axes to a's */
    double best, least;              /* m, radii                  */
} search;

typedef struct space { double lower[3], upper[3]; } space;

/* How far below the surface x is; above it less than 0. */
static double find_depth(const tobi_bvh *bvh, const double x[3])
{
    tobi_bvh_hit hit;
    return tobi_bvh_closest(bvh, x, INFINITY, &hit) ? -hit.signed_distance : -INFINITY;
}

/* What b's box and a's box have in common, in b's axes and widened to them. 0 if no ball looked for fits. */
static int find_common(const search *s, int flat, space *out)
{
    double min[3], max[3], middle[3];
    tobi_bvh_box(s->a, min, max);
    tobi_bvh_box(s->b, out->lower, out->upper);
    for (int k = 0; k < 3; k++) middle[k] = 0.5*(min[k] + max[k]) - s->shift[k];
    for (int k = 0; k < 3; k++) {
        double centre = 0, half = 0;
        for (int i = 0; i < 3; i++) {
            centre += s->turn[i][k]*middle[i];
            half += fabs(s->turn[i][k])*0.5*(max[i] - min[i]);
        }
        out->lower[k] = fmax(out->lower[k], centre - half);
        out->upper[k] = fmin(out->upper[k], centre + half);
        if (k == 2 && flat) out->lower[k] = out->upper[k] = 0;
        else if (out->upper[k] - out->lower[k] <= 2*s->least) return 0;
    }
    return 1;
}

/* Looks at the middle of a box: is more than is known possible within? */
static int look(search *s, const space *box)
{
    double x[3], y[3], diagonal[3];
    for (int k = 0; k < 3; k++) x[k] = 0.5*(box->lower[k] + box->upper[k]);
    vec3_sub(diagonal, box->upper, box->lower);
    double radius = 0.5*vec3_length(diagonal), enough = fmax(s->least, 1.1*s->best);
    double depth = find_depth(s->b, x);
    if (depth + radius <= enough) return 0;
    for (int k = 0; k < 3; k++) y[k] = vec3_dot(s->turn[k], x) + s->shift[k];
    depth = fmin(depth, find_depth(s->a, y));
    s->best = fmax(s->best, depth);
    return depth + radius > fmax(s->least, 1.1*s->best) && radius > 0.05*s->least;
}

double tobi_overlap_depth(const tobi_body *a, const tobi_shape *sa, const tobi_body *b, const tobi_shape *sb,
                          double least, int *whole)
{
    search s = { .a = sa->facets.bvh, .b = sb->facets.bvh, .least = 0.5*least };
    space stack[STACK];
    int top = 1, dropped = 0;
    *whole = 1;
    tobi_rigid_between(tobi_shape_axes(sb, b), tobi_shape_axes(sa, a), s.turn, s.shift);
    if (!find_common(&s, sa->facets.flat, &stack[0])) return 0;
    for (int looked = 0; top > 0 && looked < MOST_BOXES; looked++) {
        space box = stack[--top];
        int axis = 0;
        if (!look(&s, &box)) continue;
        dropped |= top + 2 > STACK;
        if (top + 2 > STACK) continue;
        for (int k = 1; k < 3; k++)
            if (box.upper[k] - box.lower[k] > box.upper[axis] - box.lower[axis]) axis = k;
        stack[top] = stack[top + 1] = box;
        stack[top].upper[axis] = stack[top + 1].lower[axis] = 0.5*(box.lower[axis] + box.upper[axis]);
        top += 2;
    }
    *whole = top == 0 && !dropped;
    return s.best > s.least ? 2*s.best : 0;
}
