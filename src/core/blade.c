#include "core/blade.h"
#include "geom/vec3.h"
#include <math.h>
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

/* The direction of an edge, its length, m, and where it cuts to, in rest axes; in 2-D it is a point that
   stands for a metre of depth. */
static int describe_edge(const tobi_body *b, const tobi_edge *e, int dimension, double along[3],
                         double *length, double ahead[3])
{
    vec3_sub(along, e->b, e->a);
    if (dimension == 2) along[2] = along[2] < 0 ? -1 : 1;
    *length = dimension == 2 ? 1 : vec3_length(along);
    vec3_normalize(along);
    return find_ahead(b, e, along, ahead);
}

int tobi_blade_locate(const tobi_body *b, int dimension, const double x[3], tobi_blade_place *out)
{
    double nearest = INFINITY;
    for (int64_t k = 0; k < b->edge_count; k++) {
        double along[3], ahead[3], normal[3], from[3], length;
        if (!describe_edge(b, &b->edge[k], dimension, along, &length, ahead)) continue;
        vec3_cross(normal, along, ahead);
        vec3_sub(from, x, b->edge[k].a);
        if (dimension == 2) from[2] = 0;
        double way = dimension == 2 ? 0 : vec3_dot(from, along);
        double beyond = fmax(0, fmax(-way, way - length));
        double before = vec3_dot(from, ahead), aside = vec3_dot(from, normal);
        double far = beyond*beyond + before*before + aside*aside;
        if (far >= nearest) continue;
        nearest = far;
        *out = (tobi_blade_place){ beyond, before, aside, {normal[0], normal[1], normal[2]} };
    }
    return nearest < INFINITY;
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
        double along[3], ahead[3], normal[3], length, middle[3];
        if (!describe_edge(b, &b->edge[k], dimension, along, &length, ahead)) continue;
        vec3_cross(normal, along, ahead);
        int64_t parts = dimension == 2 ? 1 : (int64_t)ceil(length/size*(1 - 1e-12));
        for (int64_t n = 0; n < parts; n++, count++) {
            if (count >= room) continue;
            tobi_blade_piece *p = &out[count];
            p->length = length/(double)parts;
            vec3_add_scaled(middle, b->edge[k].a, dimension == 2 ? 0 : ((double)n + 0.5)*p->length, along);
            if (dimension == 2) middle[2] = 0;
            for (int a = 0; a < 3; a++) {
                p->middle[a] = b->rigid.position[a] + vec3_dot(turn[a], middle);
                p->ahead[a] = vec3_dot(turn[a], ahead);
                p->normal[a] = vec3_dot(turn[a], normal);
            }
        }
    }
    return count;
}
