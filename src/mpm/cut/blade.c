/* The edge of a blade in its present pose, as segments with a direction in which they cut. Drawback: a
   search among all edges of the blade per point. */
#include "mpm/cut/blade.h"
#include "geom/vec3.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Where an edge cuts to, in rest axes. A tagged one cuts where it goes: 0 if it stands still. */
static int find_ahead(const tobi_body *b, const tobi_edge *e, const double along[3], double ahead[3])
{
    double turn[3][3], arm[3], speed[3];
    memcpy(ahead, e->ahead, 3*sizeof *ahead);
    if (vec3_dot(ahead, ahead) > 0) return 1;
    tobi_quaternion_matrix(b->rigid.orientation, turn);
    for (int i = 0; i < 3; i++) arm[i] = vec3_dot(turn[i], e->a);
    vec3_cross(speed, b->rigid.angular_velocity, arm);
    for (int i = 0; i < 3; i++) speed[i] += b->rigid.velocity[i];
    for (int i = 0; i < 3; i++) ahead[i] = turn[0][i]*speed[0] + turn[1][i]*speed[1] + turn[2][i]*speed[2];
    vec3_add_scaled(ahead, ahead, -vec3_dot(ahead, along), along);
    if (vec3_length(ahead) < 1e-9) return 0;
    vec3_normalize(ahead);
    return 1;
}

void tobi_blade_update(tobi_body *b, int dimension)
{
    for (int64_t k = 0; k < b->edge_count; k++) {
        const tobi_edge *e = &b->edge[k];
        tobi_blade_edge *now = &b->edge_now[k];
        memcpy(now->from, e->a, sizeof now->from);
        vec3_sub(now->along, e->b, e->a);
        if (dimension == 2) now->along[2] = now->along[2] < 0 ? -1 : 1;
        now->length = dimension == 2 ? 1 : vec3_length(now->along);
        vec3_normalize(now->along);
        now->cuts = find_ahead(b, e, now->along, now->ahead);
        vec3_cross(now->normal, now->along, now->ahead);
    }
}

int tobi_blade_locate(const tobi_body *b, int dimension, const double x[3], tobi_blade_place *out)
{
    const tobi_blade_edge *nearest = NULL;
    double least = INFINITY, any = INFINITY;
    for (const tobi_blade_edge *e = b->edge_now; e < b->edge_now + b->edge_count; e++) {
        double from[3];
        vec3_sub(from, x, e->from);
        if (dimension == 2) from[2] = 0;
        double way = dimension == 2 ? 0 : vec3_dot(from, e->along);
        double beyond = fmax(0, fmax(-way, way - e->length));
        any = fmin(any, vec3_dot(from, from) - way*way + beyond*beyond);
        if (!e->cuts) continue;
        double ahead = vec3_dot(from, e->ahead), aside = vec3_dot(from, e->normal);
        double far = beyond*beyond + ahead*ahead + aside*aside;
        if (far >= least) continue;
        least = far;
        nearest = e;
        out->beyond = beyond;
        out->ahead = ahead;
        out->aside = aside;
    }
    out->far = sqrt(fmax(0, any));
    if (nearest) memcpy(out->normal, nearest->normal, sizeof out->normal);
    return nearest != NULL;
}

int tobi_blade_locate_world(const tobi_body *b, int dimension, const double x[3], tobi_blade_place *out)
{
    double turn[3][3], from[3], local[3], normal[3];
    tobi_quaternion_matrix(b->rigid.orientation, turn);
    vec3_sub(from, x, b->rigid.position);
    for (int a = 0; a < 3; a++) local[a] = turn[0][a]*from[0] + turn[1][a]*from[1] + turn[2][a]*from[2];
    if (!tobi_blade_locate(b, dimension, local, out)) return 0;
    memcpy(normal, out->normal, sizeof normal);
    for (int a = 0; a < 3; a++) out->normal[a] = vec3_dot(turn[a], normal);
    return 1;
}

void tobi_blade_box(const tobi_body *b, double reach, double low[3], double high[3])
{
    double turn[3][3];
    tobi_quaternion_matrix(b->rigid.orientation, turn);
    for (int i = 0; i < 3; i++) {
        low[i] = INFINITY;
        high[i] = -INFINITY;
        for (int64_t k = 0; k < b->edge_count; k++)
            for (int end = 0; end < 2; end++) {
                const double *rest = end ? b->edge[k].b : b->edge[k].a;
                double at = b->rigid.position[i] + vec3_dot(turn[i], rest);
                low[i] = fmin(low[i], at - reach);
                high[i] = fmax(high[i], at + reach);
            }
    }
}

int64_t tobi_blade_pieces(const tobi_body *b, int dimension, double size, tobi_blade_piece *out, int64_t room)
{
    double turn[3][3];
    int64_t count = 0;
    tobi_quaternion_matrix(b->rigid.orientation, turn);
    for (int64_t k = 0; k < b->edge_count; k++) {
        const tobi_blade_edge *e = &b->edge_now[k];
        if (!e->cuts) continue;
        int64_t parts = dimension == 2 ? 1 : (int64_t)ceil(e->length/size*(1 - 1e-12));
        for (int64_t n = 0; n < parts; n++, count++) {
            if (count >= room) continue;
            tobi_blade_piece *p = &out[count];
            p->length = e->length/(double)parts;
            p->number = (int32_t)count;
            vec3_add_scaled(p->rest, e->from, dimension == 2 ? 0 : ((double)n + 0.5)*p->length, e->along);
            if (dimension == 2) p->rest[2] = 0;
            for (int a = 0; a < 3; a++) {
                p->middle[a] = b->rigid.position[a] + vec3_dot(turn[a], p->rest);
                p->ahead[a] = vec3_dot(turn[a], e->ahead);
                p->normal[a] = vec3_dot(turn[a], e->normal);
            }
        }
    }
    return count;
}

tobi_status tobi_blade_restore(tobi_body *b, int64_t count, tobi_error *err)
{
    if (count == b->piece_count) return TOBI_OK;
    free(b->edge_share);
    free(b->edge_foot);
    b->edge_share = calloc((size_t)count + 1, sizeof *b->edge_share);
    b->edge_foot = malloc((size_t)(count + 1)*sizeof *b->edge_foot);
    b->piece_count = b->edge_share && b->edge_foot ? count : 0;
    for (int64_t k = 0; k < b->piece_count; k++) b->edge_foot[k].triangle = -1;
    if (b->piece_count == count) return TOBI_OK;
    return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the edge of '%s'", b->name);
}
