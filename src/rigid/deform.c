/* Surfaces that change their shape, as contact sees them (decision 0104). A body that forces move has its
   rigid velocities and a flow that is known; of a driven one the flow is what its mean rigid motion leaves
   out. Drawback: the flow is that of the last step. */
#include "rigid/touch.h"
#include "geom/vec3.h"
#include <string.h>

static const tobi_rigid DOMAIN_AXES = { .orientation = { 1, 0, 0, 0 } };

const tobi_rigid *tobi_shape_axes(const tobi_shape *s, const tobi_body *b)
{
    return s->deforms ? &DOMAIN_AXES : &b->rigid;
}

/* Of a vertex, over the last step. */
static void find_flow(const tobi_body *b, int64_t vertex, double flow[3])
{
    const tobi_rigid *r = &b->rigid;
    double arm[3], turning[3];
    memcpy(flow, b->vertex_before[vertex], 3*sizeof *flow);
    if (b->swimmer) return;
    vec3_sub(arm, b->vertex[vertex], r->position);
    vec3_cross(turning, r->angular_velocity, arm);
    for (int a = 0; a < 3; a++) flow[a] -= r->velocity[a] + turning[a];
}

static double find_turn(const tobi_shape *s, const tobi_body *b, int64_t triangle)
{
    const int32_t *v = s->facets.triangle[triangle];
    double flow[3][3], most = 0;
    for (int k = 0; k < 3; k++) find_flow(b, v[k], flow[k]);
    for (int k = 0; k < 3; k++) {
        const double length2 = vec3_distance2(b->vertex[v[k]], b->vertex[v[(k + 1)%3]]);
        if (length2 > 0) most = fmax(most, vec3_distance2(flow[k], flow[(k + 1)%3])/length2);
    }
    return sqrt(most);
}

void tobi_shape_follow(tobi_shape *s, const tobi_body *b)
{
    if (!s->deforms) return;
    s->facets.vertex = (const double (*)[3])b->vertex;
    s->facets.reach = s->flow_speed = s->flow_turn = 0;
    s->is_fresh = 0;
    if (b->is_absent) return;
    for (int64_t v = 0; v < b->mesh.vertex_count; v++) {
        double flow[3];
        find_flow(b, v, flow);
        s->facets.reach = fmax(s->facets.reach, sqrt(vec3_distance2(b->vertex[v], b->rigid.position)));
        s->flow_speed = fmax(s->flow_speed, vec3_length(flow));
    }
    for (int64_t t = 0; t < b->mesh.triangle_count; t++)
        s->flow_turn = fmax(s->flow_turn, find_turn(s, b, t));
}

void tobi_shape_refresh(tobi_shape *s)
{
    if (!s->deforms || s->is_fresh) return;
    tobi_facets_follow(&s->facets);
    s->is_fresh = 1;
}

void tobi_shape_add_flow(const tobi_shape *s, const tobi_body *b, const double x[3], int sign, double flow[3])
{
    tobi_bvh_hit hit;
    if (!s->deforms || !tobi_bvh_closest(s->facets.bvh, x, INFINITY, &hit)) return;
    for (int k = 0; k < 3; k++) {
        double corner[3];
        find_flow(b, s->facets.triangle[hit.triangle][k], corner);
        vec3_add_scaled(flow, flow, sign*hit.barycentric[k], corner);
    }
}
