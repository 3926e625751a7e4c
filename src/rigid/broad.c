/* Sort along one axis and sweep. Drawback: many bodies above one another along that axis are
   quadratic. */
#include "rigid/broad.h"
#include "geom/vec3.h"
#include <stdlib.h>
#include <string.h>

#define REST_MARGIN 0.01     /* of the thickness: contacts are known before they touch */

struct tobi_broad_entry {
    double lower[3], upper[3];
    int32_t body;
    int moves;                   /* by forces */
};


double tobi_broad_margin(const tobi_broad *b, int body) { return b->margin[body]; }

void tobi_broad_turn_back(const tobi_rigid *r, double x[3])
{
    double m[3][3], y[3];
    tobi_quaternion_matrix(r->orientation, m);
    for (int a = 0; a < 3; a++) y[a] = m[0][a]*x[0] + m[1][a]*x[1] + m[2][a]*x[2];
    memcpy(x, y, sizeof y);
}

static void box_body(tobi_broad *b, int k, const tobi_body *body, const tobi_shape *shape, double dt)
{
    const tobi_rigid *r = &body->rigid, *axes = tobi_shape_axes(shape, body);
    tobi_broad_entry *e = &b->entries[k];
    double m[3][3], min[3], max[3];
    double speed = vec3_length(r->velocity) + vec3_length(r->angular_velocity)*shape->facets.reach;
    speed += shape->flow_speed;
    b->margin[k] = REST_MARGIN*shape->thickness + 1.2*dt*(speed + 0.5*dt*vec3_length(r->pull));
    e->body = k;
    e->moves = r->kind != TOBI_PRESCRIBED;
    if (!shape->solid) return;
    if (shape->facets.ball > 0)
        for (int a = 0; a < 3; a++) min[a] = -(max[a] = shape->facets.ball);
    else tobi_bvh_box(shape->facets.bvh, min, max);
    tobi_quaternion_matrix(axes->orientation, m);
    for (int a = 0; a < 3; a++) {
        double middle = axes->position[a], half = b->margin[k];
        for (int i = 0; i < 3; i++) {
            middle += m[a][i]*0.5*(min[i] + max[i]);
            half += (shape->facets.ball > 0 ? a == i : fabs(m[a][i]))*0.5*(max[i] - min[i]);
        }
        e->lower[a] = middle - half;
        e->upper[a] = middle + half;
    }
}

static int compare_entries(const void *p, const void *q)
{
    const tobi_broad_entry *x = p, *y = q;
    for (int a = 0; a < 3; a++)
        if (x->lower[a] != y->lower[a]) return x->lower[a] < y->lower[a] ? -1 : 1;
    return x->body - y->body;
}

static int compare_pairs(const void *p, const void *q)
{
    const tobi_pair *x = p, *y = q;
    return x->a != y->a ? x->a - y->a : x->b - y->b;
}

static int add_pair(tobi_broad *b, int32_t i, int32_t j)
{
    if (b->pair_count == b->pair_capacity) {
        int64_t capacity = 2*b->pair_capacity + 64;
        tobi_pair *more = realloc(b->pairs, (size_t)capacity*sizeof *more);
        if (!more) return 0;
        b->pairs = more;
        b->pair_capacity = capacity;
    }
    b->pairs[b->pair_count++] = i < j ? (tobi_pair){ i, j } : (tobi_pair){ j, i };
    return 1;
}

/* The axis along which the middles of the boxes spread most comes first: the others follow in turn. */
static void rotate_axes(tobi_broad *b, int n)
{
    double spread[3];
    for (int a = 0; a < 3; a++) {
        double low = INFINITY, high = -INFINITY;
        for (int k = 0; k < n; k++) {
            low = fmin(low, b->entries[k].lower[a] + b->entries[k].upper[a]);
            high = fmax(high, b->entries[k].lower[a] + b->entries[k].upper[a]);
        }
        spread[a] = high - low;
    }
    int first = spread[0] >= spread[1] && spread[0] >= spread[2] ? 0 : spread[1] >= spread[2] ? 1 : 2;
    for (int k = 0; k < n && first > 0; k++)
        for (int turns = 0; turns < first; turns++)
            for (double *v = b->entries[k].lower;; v = b->entries[k].upper) {
                double x = v[0];
                v[0] = v[1];
                v[1] = v[2];
                v[2] = x;
                if (v == b->entries[k].upper) break;
            }
}

static tobi_status reserve(tobi_broad *b, int count, tobi_error *err)
{
    if (count < b->capacity) return TOBI_OK;
    free(b->entries);
    free(b->margin);
    b->entries = malloc((size_t)(count + 1)*sizeof *b->entries);
    b->margin = malloc((size_t)(count + 1)*sizeof *b->margin);
    b->capacity = b->entries && b->margin ? count + 1 : 0;
    return b->capacity ? TOBI_OK : tobi_fail(err, TOBI_NO_MEMORY, "no memory for %d bodies", count);
}

tobi_status tobi_broad_find(tobi_broad *b, const tobi_body *bodies, const tobi_shape *shapes, int count,
                            double dt, tobi_error *err)
{
    int n = 0;
    TOBI_TRY(reserve(b, count, err));
    b->pair_count = 0;
    for (int k = 0; k < count; k++) box_body(b, k, &bodies[k], &shapes[k], dt);
    for (int k = 0; k < count; k++)
        if (shapes[k].solid && !bodies[k].is_absent) b->entries[n++] = b->entries[k];
    rotate_axes(b, n);
    qsort(b->entries, (size_t)n, sizeof *b->entries, compare_entries);
    for (int i = 0; i < n; i++) {
        const tobi_broad_entry *x = &b->entries[i];
        for (int j = i + 1; j < n && b->entries[j].lower[0] <= x->upper[0]; j++) {
            const tobi_broad_entry *y = &b->entries[j];
            if (!x->moves && !y->moves) continue;
            if (y->lower[1] > x->upper[1] || x->lower[1] > y->upper[1]) continue;
            if (y->lower[2] > x->upper[2] || x->lower[2] > y->upper[2]) continue;
            if (!add_pair(b, x->body, y->body)) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for pairs");
        }
    }
    if (b->pair_count > 0) qsort(b->pairs, (size_t)b->pair_count, sizeof *b->pairs, compare_pairs);
    return TOBI_OK;
}

void tobi_broad_free(tobi_broad *b)
{
    free(b->entries);
    free(b->margin);
    free(b->pairs);
    memset(b, 0, sizeof *b);
}
