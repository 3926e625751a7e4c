/* The clip plane, or the two of a slice: triangles of bodies are cut along it, and the surface of particles
   ends in it. Where the eye looks into a body that is not hollow, its back faces are drawn in the plane
   (tiles of what is opaque), so that the cut is filled. Drawback: a mesh that is open is filled wrongly. */
#include "view/image.h"

/* In metres, of the normal's length 1. */
static double distance_of(const tobi_picture *f, const double p[3])
{
    const double *n = f->clip_normal, *q = f->clip_point;
    const double length = sqrt(n[0]*n[0] + n[1]*n[1] + n[2]*n[2]);
    return ((p[0] - q[0])*n[0] + (p[1] - q[1])*n[1] + (p[2] - q[2])*n[2])/length;
}

double view_beyond(const tobi_picture *f, const double p[3], double half)
{
    if (!f->clip) return -INFINITY;
    const double off = distance_of(f, p);
    return f->slice > 0 ? fabs(off) - half : off;
}

void view_find_cut(canvas *c, const tobi_picture *f)
{
    const camera *a = &c->camera;
    cut *cut = &c->cut;
    cut->count = !f->clip ? 0 : f->slice > 0 ? 2 : 1;
    if (!f->clip) return;
    const double *n = f->clip_normal, length = sqrt(n[0]*n[0] + n[1]*n[1] + n[2]*n[2]);
    const double to_eye = distance_of(f, a->eye);
    const vec normal = {
        (float)((n[0]*a->right[0] + n[1]*a->right[1] + n[2]*a->right[2])/length),
        (float)((n[0]*a->up[0] + n[1]*a->up[1] + n[2]*a->up[2])/length),
        (float)((n[0]*a->forward[0] + n[1]*a->forward[1] + n[2]*a->forward[2])/length)
    };
    for (int k = 0; k < cut->count; k++) {
        const float sign = k ? -1 : 1;
        cut->normal[k] = vec_scale(sign, normal);
        cut->offset[k] = (float)(0.5*f->slice - sign*to_eye);
        if (cut->offset[k] < 0 && !a->orthographic) cut->faced = k + 1;      /* the eye is beyond it */
    }
}

typedef struct corner { vec place, normal, color; } corner;

static corner mix_corners(const corner *a, const corner *b, float t)
{
    return (corner){ vec_mix(a->place, b->place, t), vec_mix(a->normal, b->normal, t),
                     is_image_mark(a->color.z) ? vec_mix(a->color, b->color, t) : a->color };
}

/* What of a polygon is on this side of a plane (Sutherland, Hodgman 1974); returns its corners. */
static int cut_polygon(const corner *in, int count, vec normal, float offset, corner *out)
{
    int n = 0;
    for (int k = 0; k < count; k++) {
        const corner *a = &in[k], *b = &in[(k + 1)%count];
        const float da = vec_dot(normal, a->place) - offset, db = vec_dot(normal, b->place) - offset;
        if (da <= 0) out[n++] = *a;
        if ((da <= 0) != (db <= 0)) out[n++] = mix_corners(a, b, da/(da - db));
    }
    return n;
}

void view_add_triangle(geometry *g, const cut *cut, const vec place[3], const vec normal[3],
                       const vec color[3])
{
    corner a[CUT_CORNERS], b[CUT_CORNERS];
    int n = 3;
    for (int k = 0; k < 3; k++) a[k] = (corner){ place[k], normal[k], color[k] };
    for (int k = 0; k < cut->count && n > 0; k++) {
        n = cut_polygon(a, n, cut->normal[k], cut->offset[k], b);
        for (int i = 0; i < n; i++) a[i] = b[i];
    }
    const int64_t first = g->vertices;
    for (int k = 0; k < n; k++) {
        const int64_t i = g->vertices++;
        g->place[i] = a[k].place, g->normal[i] = a[k].normal, g->color[i] = a[k].color;
    }
    for (int k = 2; k < n; k++) {
        int32_t *face = g->face[g->faces++];
        face[0] = (int32_t)first, face[1] = (int32_t)first + k - 1, face[2] = (int32_t)first + k;
    }
}
