/* Which triangles a box may touch: for contact between surfaces, a walk that measures nothing. */
#include "geom/bvh_tree.h"
#include <math.h>

void tobi_bvh_touching(const tobi_bvh *b, const double lower[3], const double upper[3],
                       tobi_bvh_visit_fn *visit, void *user)
{
    int32_t stack[BVH_STACK];
    float centre[3], half[3];
    int top = 0;
    for (int k = 0; k < 3; k++) {
        double middle = 0.5*(lower[k] + upper[k]) - b->origin[k];
        if (!(upper[k] >= b->min[k] && lower[k] <= b->max[k])) return;
        centre[k] = (float)middle;
        /* rounding of both numbers to float, from above */
        half[k] = (float)(0.5*(upper[k] - lower[k])*1.000001 + 1e-6*fabs(middle));
    }
    stack[top++] = 0;
    while (top) {
        const bvh_node *node = &b->nodes[stack[--top]];
        for (int lane = 0; lane < BVH_WIDTH; lane++) {
            int apart = node->child[lane] < 0;
            for (int k = 0; k < 3; k++)
                apart |= fabsf(node->centre[k][lane] - centre[k]) > node->half[k][lane] + half[k];
            if (apart) continue;
            if (node->count[lane] == 0) stack[top++] = node->child[lane];
            for (int32_t i = node->child[lane]; i < node->child[lane] + node->count[lane]; i++)
                visit(user, b->leaf_triangle[i]);
        }
    }
}
