/* Places and speeds of openings. Profiles are products of a shape over the patch and a rate in time, so that
   one number says how far every column has gone. Drawback: a profile cannot change its shape in time. */
#include "core/opening.h"
#include "geom/vec3.h"
#include <math.h>

/* m, over the sides of the patch: rounding does not let go of particles. */
static const double SLACK = 1e-9;

void tobi_opening_locate(const tobi_opening *o, const double x[3], double at[3])
{
    double arm[3];
    vec3_sub(arm, x, o->centre);
    at[0] = vec3_dot(arm, o->normal);
    at[1] = vec3_dot(arm, o->along);
    at[2] = vec3_dot(arm, o->across);
}

int tobi_opening_faces(const tobi_opening *o, const double at[3])
{
    if (o->radius > 0) return at[1]*at[1] + at[2]*at[2] <= o->radius*o->radius + SLACK;
    return fabs(at[1]) <= o->half[0] + SLACK && fabs(at[2]) <= o->half[1] + SLACK;
}

double tobi_opening_area(const tobi_opening *o, int dimension)
{
    if (o->radius > 0) return acos(-1)*o->radius*o->radius;
    return dimension == 2 ? 2*o->half[0] : 4*o->half[0]*o->half[1];
}

int tobi_opening_find(const tobi_opening *o, int count, const double x[3])
{
    for (int k = 0; k < count; k++) {
        double at[3];
        tobi_opening_locate(&o[k], x, at);
        if (o[k].outlet ? at[0] < 0 : at[0] >= 0 || at[0] < -o[k].depth - o[k].step) continue;
        if (tobi_opening_faces(&o[k], at)) return k;
    }
    return -1;
}

double tobi_opening_way_at(const tobi_opening *o, double t)
{
    const tobi_flow_row *r = o->rows;
    int64_t low = 0, high = o->row_count - 1;
    if (t <= r[0].time) return r[0].way + (t - r[0].time)*r[0].speed;
    if (t >= r[high].time) return r[high].way + (t - r[high].time)*r[high].speed;
    while (high - low > 1) {
        const int64_t middle = (low + high)/2;
        if (r[middle].time <= t) low = middle;
        else high = middle;
    }
    const double s = t - r[low].time, h = r[high].time - r[low].time;
    return r[low].way + s*(r[low].speed + 0.5*(r[high].speed - r[low].speed)*s/h);
}

double tobi_opening_way(const tobi_opening *o, double t)
{
    if (o->rows) return t > 0 ? tobi_opening_way_at(o, t) : 0;
    const double since = (o->stop > 0 ? fmin(t, o->stop) : t) - o->start;
    if (!(since > 0)) return 0;
    return since < o->ramp ? 0.5*o->speed*since*since/o->ramp : o->speed*(since - 0.5*o->ramp);
}

double tobi_opening_speed(const tobi_opening *o, double t, double dt)
{
    return dt > 0 ? (tobi_opening_way(o, t + dt) - tobi_opening_way(o, t))/dt : 0;
}

/* Of a laminar flow between plates, or in a pipe; the product of two of the first in a rectangle. */
double tobi_opening_factor(const tobi_opening *o, double along, double across)
{
    const double r2 = o->radius*o->radius;
    if (!o->parabolic) return o->scale;
    if (r2 > 0) return 2*o->scale*fmax(1 - (along*along + across*across)/r2, 0);
    double f = 1.5*fmax(1 - along*along/(o->half[0]*o->half[0]), 0);
    if (o->half[1] > 0) f *= 1.5*fmax(1 - across*across/(o->half[1]*o->half[1]), 0);
    return o->scale*f;
}
