/* Whether a camera is inside of a body, by how often a ray from it meets the body's surface. Drawback: a mesh
   that is open may be wrong. */
#include "view/drawing.h"
#include <stddef.h>

static double determinant(const double a[3], const double b[3], const double c[3])
{
    return a[0]*(b[1]*c[2] - b[2]*c[1]) - a[1]*(b[0]*c[2] - b[2]*c[0]) + a[2]*(b[0]*c[1] - b[1]*c[0]);
}

/* A ray in a direction that no edge of a model has (Moeller, Trumbore 1997, by Cramer's rule). */
static int meets(const double from[3], const double (*vertices)[3], const int32_t corner[3])
{
    static const double way[3] = { 0.5313, 0.2917, 0.7954 };
    const double back[3] = { -way[0], -way[1], -way[2] };
    double e[3], f[3], s[3];
    for (int k = 0; k < 3; k++) {
        e[k] = vertices[corner[1]][k] - vertices[corner[0]][k];
        f[k] = vertices[corner[2]][k] - vertices[corner[0]][k];
        s[k] = from[k] - vertices[corner[0]][k];
    }
    const double all = determinant(e, f, back);
    const double u = determinant(s, f, back)/all, v = determinant(e, s, back)/all;
    return u >= 0 && v >= 0 && u + v < 1 && determinant(e, f, s)/all > 0;
}

const char *tobi_drawing_body_around(const tobi_drawing *d)
{
    if (!d) return NULL;
    const tobi_picture *p = &d->picture;
    for (int k = 0; p->has_camera && p->dimension == 3 && k < d->moment->surface_count; k++) {
        const tobi_moment_surface *s = &d->moment->surfaces[k];
        const int b = tobi_drawing_find_body(d->looks, s->name);
        int crossings = 0;
        if (b >= 0 && (!d->looks->bodies[b].visible || d->looks->bodies[b].is_line)) continue;
        for (int64_t t = 0; t < s->triangle_count; t++)
            crossings += meets(p->eye, (const double (*)[3])s->vertices, s->triangles[t]);
        if (crossings%2) return b >= 0 ? d->looks->bodies[b].body : s->name;
    }
    return NULL;
}
