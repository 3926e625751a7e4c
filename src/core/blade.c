#include "core/blade.h"
#include "geom/vec3.h"
#include <math.h>
#include <string.h>

/* An edge in world axes. A tagged one cuts where it goes: 0 if it stands still. */
typedef struct edge_now { double a[3], along[3], length, ahead[3], normal[3]; } edge_now;

static int place_edge(const tobi_body *b, const double turn[3][3], const tobi_edge *e, int dimension,
                      edge_now *out)
{
    double end[3], turning[3], arm[3];
    for (int i = 0; i < 3; i++) {
        out->a[i] = b->rigid.position[i] + vec3_dot(turn[i], e->a);
        end[i] = b->rigid.position[i] + vec3_dot(turn[i], e->b);
        out->ahead[i] = vec3_dot(turn[i], e->ahead);
    }
    if (dimension == 2) {                      /* a point that stands for a metre of depth */
        out->a[2] = b->rigid.position[2];
        end[2] = out->a[2] + (e->b[2] < e->a[2] ? -1 : 1);
    }
    vec3_sub(out->along, end, out->a);
    out->length = vec3_length(out->along);
    vec3_normalize(out->along);
    if (vec3_length(e->ahead) == 0) {
        vec3_sub(arm, out->a, b->rigid.position);
        vec3_cross(turning, b->rigid.angular_velocity, arm);
        for (int i = 0; i < 3; i++) out->ahead[i] = b->rigid.velocity[i] + turning[i];
        vec3_add_scaled(out->ahead, out->ahead, -vec3_dot(out->ahead, out->along), out->along);
        if (vec3_length(out->ahead) < 1e-9) return 0;
        vec3_normalize(out->ahead);
    }
    vec3_cross(out->normal, out->along, out->ahead);
    return 1;
}

int tobi_blade_locate(const tobi_body *b, int dimension, const double x[3], tobi_blade_place *out)
{
    double turn[3][3], nearest = INFINITY;
    tobi_quaternion_matrix(b->rigid.orientation, turn);
    for (int64_t k = 0; k < b->edge_count; k++) {
        edge_now e;
        double from[3], way, beyond;
        if (!place_edge(b, turn, &b->edge[k], dimension, &e)) continue;
        vec3_sub(from, x, e.a);
        way = dimension == 2 ? 0 : vec3_dot(from, e.along);
        if (dimension == 2) from[2] = 0;
        beyond = fmax(0, fmax(-way, way - e.length));
        double ahead = vec3_dot(from, e.ahead), aside = vec3_dot(from, e.normal);
        double far = beyond*beyond + ahead*ahead + aside*aside;
        if (far >= nearest) continue;
        nearest = far;
        *out = (tobi_blade_place){ beyond, ahead, aside, {e.normal[0], e.normal[1], e.normal[2]} };
    }
    return nearest < INFINITY;
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
        edge_now e;
        if (!place_edge(b, turn, &b->edge[k], dimension, &e)) continue;
        int64_t parts = dimension == 2 ? 1 : (int64_t)ceil(e.length/size*(1 - 1e-12));
        for (int64_t n = 0; n < parts; n++, count++) {
            if (count >= room) continue;
            tobi_blade_piece *p = &out[count];
            p->length = e.length/(double)parts;
            vec3_add_scaled(p->middle, e.a, dimension == 2 ? 0 : (n + 0.5)*p->length, e.along);
            memcpy(p->ahead, e.ahead, sizeof p->ahead);
            memcpy(p->normal, e.normal, sizeof p->normal);
        }
    }
    return count;
}
