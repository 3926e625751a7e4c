/* Boxes of bodies, in a tree: which bodies may be near a point. */
#pragma once
#include "core/body.h"

typedef struct tobi_tree_box { double lower[3], upper[3]; } tobi_tree_box;

/* Followed by its children, unless it is a leaf. */
typedef struct tobi_tree_node {
    tobi_tree_box box;
    int32_t first, count;     /* bodies, of a leaf                                                */
    int32_t next;             /* the node after all below                                         */
} tobi_tree_node;

typedef struct tobi_body_tree {
    tobi_tree_box *box;       /* [bodies]                                                         */
    tobi_tree_node *node;
    int32_t *body;            /* [bodies] in the order of the leaves                              */
    int32_t node_count, capacity;
    int dimension;
} tobi_body_tree;

/* Room for so many bodies: then building never allocates. */
tobi_status tobi_body_tree_reserve(tobi_body_tree *t, int bodies, tobi_error *err);
/* The present boxes, wider by `margin` (m) on all sides. */
void tobi_body_tree_build(tobi_body_tree *t, const tobi_body *bodies, int count, double margin,
                          int dimension);
void tobi_body_tree_free(tobi_body_tree *t);

typedef struct tobi_tree_walk { int32_t node, item; } tobi_tree_walk;

static inline int tobi_tree_holds(const tobi_body_tree *t, const tobi_tree_box *box, const double x[3])
{
    for (int a = 0; a < t->dimension; a++)
        if (x[a] < box->lower[a] || x[a] > box->upper[a]) return 0;
    return 1;
}

/* The next body in whose box x lies, in any order, or -1. The walk starts with zeros. */
static inline int32_t tobi_body_tree_next(const tobi_body_tree *t, const double x[3], tobi_tree_walk *w)
{
    while (w->node < t->node_count) {
        const tobi_tree_node *n = &t->node[w->node];
        const int inside = w->item > 0 || tobi_tree_holds(t, &n->box, x);
        while (inside && w->item < n->count) {
            const int32_t body = t->body[n->first + w->item++];
            if (tobi_tree_holds(t, &t->box[body], x)) return body;
        }
        w->item = 0;
        w->node = inside ? w->node + 1 : n->next;
    }
    return -1;
}
