/* The 256 cases of marching cubes, derived: in each face the inside corners that touch only across the face's
   diagonal stay apart, which both cubes at a face decide alike; the crossings of a case then form loops. A
   loop is cut into triangles without a diagonal between two crossings of one face, where the cube beyond
   could have the same edge. So the surface is closed and no edge has more than two triangles. Drawback:
   liquid that touches across an edge only is always parted. */
#include "view/surface/surface.h"
#include <string.h>

/* Corners x + 2 y + 4 z; edges 4 axis + place among the four of the axis, by the other two coordinates. */
static int edge_between(int a, int b)
{
    const int low = a < b ? a : b, axis = (a ^ b) >> 1;      /* 1, 2, 4 -> 0, 1, 2 */
    const int x = low & 1, y = low >> 1 & 1, z = low >> 2;
    return axis == 0 ? y + 2*z : axis == 1 ? 4 + x + 2*z : 8 + x + 2*y;
}

/* The corners of a face, counter-clockwise seen from outside. */
static void face_corners(int face, int corner[4])
{
    const int axis = face >> 1, high = face & 1, u = 1 << (axis + 1)%3, v = 1 << (axis + 2)%3;
    const int at = high << axis, ring[4] = { at, at + u, at + u + v, at + v };
    for (int k = 0; k < 4; k++) corner[k] = ring[high ? k : 3 - k];
}

static int faces_of(int edge)
{
    int faces = 0, corner[4];
    for (int f = 0; f < 6; f++) {
        face_corners(f, corner);
        for (int k = 0; k < 4; k++)
            if (edge_between(corner[k], corner[(k + 1)%4]) == edge) faces |= 1 << f;
    }
    return faces;
}

/* next[e]: the crossing that follows e in its loop, -1 = not crossed. */
static void link_crossings(int inside, int next[12])
{
    int corner[4];
    for (int e = 0; e < 12; e++) next[e] = -1;
    for (int f = 0; f < 6; f++) {
        face_corners(f, corner);
        for (int k = 0; k < 4; k++) {
            const int here = corner[k], before = corner[(k + 3)%4];
            if (!(inside >> here & 1) || (inside >> before & 1)) continue;
            int last = k;                    /* a run of inside corners begins at k */
            while (inside >> corner[(last + 1)%4] & 1) last++;
            next[edge_between(before, here)] = edge_between(corner[last%4], corner[(last + 1)%4]);
        }
    }
}

/* Cuts the loop into triangles, trying all ears; false = there is none without a diagonal in a face. */
static bool cut_loop(const int *loop, int n, const int *faces, uint8_t *out)
{
    if (n == 3) {
        for (int k = 0; k < 3; k++) out[k] = (uint8_t)loop[k];
        return true;
    }
    for (int k = 0; k < n; k++) {
        const int a = loop[(k + n - 1)%n], b = loop[k], c = loop[(k + 1)%n];
        if (faces[a] & faces[c]) continue;
        int rest[12], m = 0;
        for (int q = 0; q < n; q++)
            if (q != k) rest[m++] = loop[q];
        const int ear[3] = { a, b, c };
        for (int q = 0; q < 3; q++) out[q] = (uint8_t)ear[q];
        if (cut_loop(rest, m, faces, out + 3)) return true;
    }
    return false;
}

int surface_make_cases(surface_cases *cases)
{
    int faces[12], next[12];
    memset(cases, 0, sizeof *cases);
    for (int e = 0; e < 12; e++) faces[e] = faces_of(e);
    for (int c = 0; c < 256; c++) {
        link_crossings(c, next);
        for (int e = 0; e < 12; e++) {
            int loop[12], n = 0;
            for (int at = e; next[at] >= 0;) {
                loop[n++] = at;
                const int to = next[at];
                next[at] = -1;
                at = to;
            }
            if (n == 0) continue;
            if (!cut_loop(loop, n, faces, cases->edge[c] + 3*cases->count[c])) return 1 + c;
            cases->count[c] = (uint8_t)(cases->count[c] + n - 2);
        }
    }
    return 0;
}
