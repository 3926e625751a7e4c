/* Sums over rectangles and boxes. A particle counts as a cube of a spacing along the axes of the sensor: its
   share of an interval is exact for a lattice at any offset. Beside a wall the cube touches it. Drawback: the
   cubes smear edges by half a spacing. */
#include "sph/sensor/sensor.h"
#include "geom/vec3.h"
#include "sph/sensor/around.h"
#include "sph/sensor/probe.h"
#include <math.h>
#include <string.h>

enum { PLACES = 64 };       /* of a patch along one side, at most */
#define LAYER 2.0           /* half the layer that a flow looks at, spacings: a whole number makes it exact */

typedef struct sums {
    const tobi_system *s;
    const tobi_sensor_box *box;
    int fluid;                     /* -1: all */
    const double *velocity, *spin;
    double arm[3];                 /* from the middle back to the centre of the turn, m */
    double total;
} sums;

static double pick(const double axis[3], const double d[3]) { return vec3_dot(axis, d); }

/* Part of the interval of a spacing around x that lies within size/2 of 0. */
static double part(double x, double size, double spacing)
{
    const double low = fmax(x - 0.5*spacing, -0.5*size), high = fmin(x + 0.5*spacing, 0.5*size);
    return high > low ? (high - low)/spacing : 0;
}

/* Liquid fills all that walls leave: the cube of a particle nearer than half a spacing is moved off them. */
static void leave_walls(const tobi_system *s, int64_t i, double d[3])
{
    const double deep = 0.5*s->smoothing.spacing, *p = &s->particles.position[i].x;
    double x[3] = { 0 };
    tobi_bvh_hit hit;
    for (int a = 0; a < s->box.dimension; a++)
        x[a] = s->box.periodic[a] ? p[a] : fmin(fmax(p[a], deep), s->box.size[a] - deep);
    for (int b = 0; b < s->sim->body_count; b++)
        for (int face = 0; face < s->box.dimension; face++) {                 /* of the corner of a vessel */
            if (s->sim->bodies[b].is_absent || !tobi_bvh_closest(s->sim->bodies[b].bvh, x, deep, &hit)) break;
            vec3_add_scaled(x, x, deep - hit.signed_distance, hit.normal);
        }
    for (int a = 0; a < s->box.dimension; a++) d[a] += x[a] - p[a];
}

/* Share of particle i at d along the first `axes` axes; across counts in 3-D alone. */
static double share_of(const sums *a, int64_t i, const double d[3], int axes)
{
    const double spacing = a->s->smoothing.spacing;
    double share = 1, at[3] = { d[0], d[1], d[2] };
    int near = 0;
    for (int k = 0; k < axes; k++) {
        if (k == 1 && a->s->box.dimension == 2) continue;
        const double beyond = fabs(pick(a->box->axis[k], d)) - 0.5*a->box->size[k];
        if (beyond >= spacing) return 0;
        near |= beyond > -spacing;
    }
    if (!near) return 1;
    leave_walls(a->s, i, at);
    for (int k = 0; k < axes; k++)
        if (k != 1 || a->s->box.dimension == 3)
            share *= part(pick(a->box->axis[k], at), a->box->size[k], spacing);
    return share;
}

static void add_volume(void *user, int64_t i, const double d[3])
{
    sums *a = user;
    if (tobi_sensor_counts(a->s, a->fluid, i)) a->total += share_of(a, i, d, 3)*a->s->smoothing.volume;
}

static void add_flow(void *user, int64_t i, const double d[3])
{
    sums *a = user;
    const double reach = LAYER*a->s->smoothing.spacing, away = fabs(pick(a->box->axis[2], d));
    if (away >= reach || !tobi_sensor_counts(a->s, a->fluid, i)) return;
    const tobi_float4 *v = &a->s->particles.velocity[i];
    double r[3], turn[3];
    for (int k = 0; k < 3; k++) r[k] = d[k] + a->arm[k];
    vec3_cross(turn, a->spin, r);
    const double u[3] = { v->x - a->velocity[0] - turn[0], v->y - a->velocity[1] - turn[1],
                          v->z - a->velocity[2] - turn[2] };
    a->total += share_of(a, i, d, 2)*a->s->smoothing.volume*pick(a->box->axis[2], u)*(1 - away/reach)/reach;
}

/* All particles near a box, with reach beyond it along each axis of the domain. */
static void visit_box(const tobi_system *s, const tobi_sensor_box *box, double reach, sph_visitor see,
                      void *user)
{
    double local[3] = { 0 };
    sph_range r = { .first = { 0 } };
    for (int a = 0; a < 3; a++) {
        double half = reach;
        for (int k = 0; k < 3; k++) half += 0.5*fabs(box->axis[k][a])*box->size[k];
        local[a] = a < s->box.dimension ? box->middle[a] - s->box.lower[a] : 0;
        const double at[3] = { local[a], local[a], local[a] };
        const sph_range wide = sph_cells_around(s, at, half);
        r.first[a] = wide.first[a];
        r.last[a] = wide.last[a];
    }
    sph_visit(s, local, &r, see, user);
}

double tobi_sensor_volume(const tobi_system *s, int fluid, const tobi_sensor_box *box)
{
    sums a = { .s = s, .box = box, .fluid = fluid };
    visit_box(s, box, 2*s->smoothing.spacing, add_volume, &a);
    return a.total;
}

double tobi_sensor_flow(const tobi_system *s, int fluid, const tobi_sensor_box *box, const double velocity[3],
                        const double spin[3], const double centre[3])
{
    sums a = { .s = s, .box = box, .fluid = fluid, .velocity = velocity, .spin = spin };
    vec3_sub(a.arm, box->middle, centre);
    visit_box(s, box, (LAYER + 2)*s->smoothing.spacing, add_flow, &a);
    return a.total;
}

static int count_places(double size, double spacing)
{
    return (int)fmin(fmax(ceil(size/spacing - 1e-9), 1), PLACES);
}

int tobi_sensor_place(const tobi_system *s, const tobi_sensor_box *box, int k, double arm[3])
{
    const double d = s->smoothing.spacing;
    const int flat = s->box.dimension == 2, n = count_places(box->size[0], d);
    const int m = flat ? 1 : count_places(box->size[1], d);
    if (k >= n*m) return 0;
    const double a = ((k/m + 0.5)/n - 0.5)*box->size[0];
    const double b = flat ? 0 : ((k%m + 0.5)/m - 0.5)*box->size[1];
    for (int c = 0; c < 3; c++) arm[c] = a*box->axis[0][c] + b*box->axis[1][c];
    return n*m;
}

void tobi_sensor_patch(const tobi_system *s, const tobi_sensor_box *box, double *pressure, double force[3],
                       double moment[3])
{
    double sum = 0, x[3], arm[3], normal[3], push[3], turn[3];
    int places = 1;
    memset(force, 0, 3*sizeof *force);
    memset(moment, 0, 3*sizeof *moment);
    for (int k = 0, n; (n = tobi_sensor_place(s, box, k, arm)) > 0; k++) {
        const double area = box->size[0]*(s->box.dimension == 2 ? 1 : box->size[1])/(double)n;
        for (int c = 0; c < 3; c++) {
            x[c] = box->middle[c] + arm[c];
            normal[c] = box->axis[2][c];
        }
        const double p = tobi_probe_place(s, x, normal);
        sum += p;
        for (int c = 0; c < 3; c++) push[c] = -p*area*normal[c];
        vec3_cross(turn, arm, push);
        for (int c = 0; c < 3; c++) {
            force[c] += push[c];
            moment[c] += turn[c];
        }
        places = n;
    }
    *pressure = sum/(double)places;
}
