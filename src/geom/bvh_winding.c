/* Winding numbers of closed surfaces by the crossings of a line: exact, and unlike the sign of the
   nearest feature right where parts of the surface lie inside others. The line runs along z; the rule
   of lines.c decides about edges and vertices, so nothing is counted twice. */
#include "geom/bvh_tree.h"

/* 1 if the line through p along z meets the triangle above p; *turn is -1 where it leaves. */
static int meets_above(const tobi_bvh *b, int32_t slot, const double p[3], int *turn)
{
    const bvh_corners *t = &b->corners[slot];
    const int32_t *v = b->triangles[b->leaf_triangle[slot]];
    const double *corner[3] = {t->a, t->b, t->c};
    double side[2][2] = {{0}};                   /* x and z where the row leaves by a rising, falling edge */
    int found = 0;
    for (int k = 0; k < 3; k++) {
        int next = (k + 1) % 3;
        int up = corner[k][1] <= p[1] && corner[next][1] > p[1],
            down = corner[next][1] <= p[1] && corner[k][1] > p[1];
        if (!up && !down) continue;
        const double *from = corner[v[k] < v[next] ? k : next], *to = corner[v[k] < v[next] ? next : k];
        double s = (p[1] - from[1])/(to[1] - from[1]);
        side[down][0] = from[0] + s*(to[0] - from[0]);
        side[down][1] = from[2] + s*(to[2] - from[2]);
        found++;
    }
    if (found != 2 || side[0][0] == side[1][0]) return 0;
    *turn = side[0][0] > side[1][0] ? -1 : 1;
    const double *left = side[*turn < 0], *right = side[*turn > 0];
    if (p[0] < left[0] || p[0] >= right[0]) return 0;
    return left[1] + (p[0] - left[0])/(right[0] - left[0])*(right[1] - left[1]) > p[2];
}

void tobi_bvh_look_up(const tobi_bvh *b, const double p[3], tobi_bvh_crossing_fn *visit, void *user)
{
    int32_t stack[BVH_STACK];
    int top = 0;
    float local[3];
    for (int k = 0; k < 3; k++) {
        if (!(p[k] <= b->max[k]) || (k < 2 && !(p[k] >= b->min[k]))) return;
        local[k] = (float)(p[k] - b->origin[k]);
    }
    stack[top++] = 0;
    while (top) {
        const bvh_node *node = &b->nodes[stack[--top]];
        for (int lane = 0; lane < BVH_WIDTH; lane++) {
            if (!(__builtin_fabsf(local[0] - node->centre[0][lane]) <= node->half[0][lane]) ||
                !(__builtin_fabsf(local[1] - node->centre[1][lane]) <= node->half[1][lane]) ||
                !(local[2] - node->centre[2][lane] <= node->half[2][lane]) || node->child[lane] < 0)
                continue;
            if (node->count[lane] == 0) stack[top++] = node->child[lane];
            for (int32_t i = node->child[lane]; i < node->child[lane] + node->count[lane]; i++) {
                int turn;
                if (meets_above(b, i, p, &turn)) visit(user, b->leaf_triangle[i], turn);
            }
        }
    }
}

static void add_turn(void *user, int32_t triangle, int turn)
{
    (void)triangle;
    *(int *)user -= turn;
}

int tobi_bvh_winding(const tobi_bvh *b, const double p[3])
{
    int wound = 0;
    tobi_bvh_look_up(b, p, add_turn, &wound);
    return wound;
}

void tobi_bvh_use_winding(tobi_bvh *b) { b->by_winding = 1; }
