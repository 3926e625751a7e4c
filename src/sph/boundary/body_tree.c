/* A tree of bodies' boxes, halved at the middle body along the longest axis and built anew for every use: a
   thousand bodies take less time than one look at all particles. Its size depends on the number of bodies
   alone, so that building cannot fail. Drawback: long bodies that lie askew have large boxes. */
#include "sph/boundary/body_tree.h"
#include <math.h>
#include <string.h>

enum { LEAF = 4 };

tobi_status tobi_body_tree_reserve(tobi_body_tree *t, int bodies, tobi_error *err)
{
    if (bodies <= t->capacity) return TOBI_OK;
    tobi_body_tree_free(t);
    t->box = tobi_array_make(bodies, sizeof *t->box);
    t->node = tobi_array_make(2*bodies, sizeof *t->node);
    t->body = tobi_array_make(bodies, sizeof *t->body);
    t->capacity = bodies;
    if (t->box && t->node && t->body) return TOBI_OK;
    tobi_body_tree_free(t);
    return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the boxes of %d bodies", bodies);
}

void tobi_body_tree_free(tobi_body_tree *t)
{
    tobi_array_free(t->box);
    tobi_array_free(t->node);
    tobi_array_free(t->body);
    memset(t, 0, sizeof *t);
}

/* Twice the middle of a body's box. */
static double middle(const tobi_body_tree *t, int32_t item, int axis)
{
    const tobi_tree_box *box = &t->box[t->body[item]];
    return box->lower[axis] + box->upper[axis];
}

/* Puts those with lower middles than item k's before k, as sorting would (Hoare 1961). */
static void select_item(tobi_body_tree *t, int32_t first, int32_t last, int32_t k, int axis)
{
    while (first < last) {
        const double pivot = middle(t, (first + last)/2, axis);
        int32_t i = first, j = last;
        while (i <= j) {
            while (middle(t, i, axis) < pivot) i++;
            while (middle(t, j, axis) > pivot) j--;
            if (i > j) break;
            const int32_t swap = t->body[i];
            t->body[i++] = t->body[j];
            t->body[j--] = swap;
        }
        if (k <= j) last = j;
        else if (k >= i) first = i;
        else return;
    }
}

static tobi_tree_box unite(const tobi_body_tree *t, int32_t first, int32_t end)
{
    tobi_tree_box all = t->box[t->body[first]];
    for (int32_t k = first + 1; k < end; k++)
        for (int a = 0; a < 3; a++) {
            all.lower[a] = fmin(all.lower[a], t->box[t->body[k]].lower[a]);
            all.upper[a] = fmax(all.upper[a], t->box[t->body[k]].upper[a]);
        }
    return all;
}

static void split(tobi_body_tree *t, int32_t first, int32_t end)
{
    tobi_tree_node *n = &t->node[t->node_count++];
    int axis = 0;
    *n = (tobi_tree_node){.box = unite(t, first, end), .first = first};
    if (end - first <= LEAF) {
        n->count = end - first;
    } else {
        for (int a = 1; a < t->dimension; a++)
            if (n->box.upper[a] - n->box.lower[a] > n->box.upper[axis] - n->box.lower[axis]) axis = a;
        const int32_t half = (first + end)/2;
        select_item(t, first, end - 1, half, axis);
        split(t, first, half);
        split(t, half, end);
    }
    n->next = t->node_count;
}

void tobi_body_tree_build(tobi_body_tree *t, const tobi_body *bodies, int count, double margin,
                          int dimension)
{
    t->dimension = dimension;
    t->node_count = 0;
    for (int32_t k = 0; k < count; k++) {
        tobi_tree_box *box = &t->box[k];
        tobi_bvh_box(bodies[k].bvh, box->lower, box->upper);
        for (int a = 0; a < 3; a++) {
            box->lower[a] -= margin;
            box->upper[a] += margin;
        }
        t->body[k] = k;
    }
    if (count > 0) split(t, 0, count);
}
