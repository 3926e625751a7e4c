/* Contact of faces at the nodes. A seam is solved exactly in one sweep; where cuts cross, the pairs of a
   node share velocities and are solved in turn until their impulses stand. */
#include "mpm/seam.h"
#include "geom/vec3.h"
#include <math.h>
#include <string.h>

/* A seam and the two velocities it couples. */
typedef struct joint {
    double along, u[3], n[3];          /* m/s, of the second relative to the first                 */
} joint;

static joint look_at(const mpm_seam *seam, const tobi_float4 *first, const tobi_float4 *second)
{
    joint j;
    for (int a = 0; a < 3; a++) {
        j.n[a] = seam->normal[a];
        j.u[a] = (double)(&second->x)[a] - (&first->x)[a];
    }
    j.along = vec3_dot(j.u, j.n);
    return j;
}

/* One sweep of contact between the faces, eq. (3): the sum of its impulses pushes and obeys friction;
   momentum is kept. Returns the square of the impulse's change. */
static double press(mpm_seam *seam, tobi_float4 *first, tobi_float4 *second, double dt)
{
    const joint j = look_at(seam, first, second);
    const double lack = -fmax(seam->gap, 0)/dt - j.along;
    double was[3] = {seam->push[0], seam->push[1], seam->push[2]}, slide[3], square = 0;
    if (lack <= 0 && was[0] == 0 && was[1] == 0 && was[2] == 0) return 0;
    const double mass = seam->fixed == 1   ? second->w
                        : seam->fixed == 2 ? first->w
                                           : (double)first->w*second->w/((double)first->w + second->w);
    double normal = fmax(0, vec3_dot(was, j.n) + mass*lack);
    for (int a = 0; a < 3; a++) slide[a] = was[a] - mass*(j.u[a] - j.along*j.n[a]);
    vec3_add_scaled(slide, slide, -vec3_dot(slide, j.n), j.n);
    double size = vec3_length(slide), grip = seam->friction*normal, keep = size > grip ? grip/size : 1;
    for (int a = 0; a < 3; a++) {
        double push = normal*j.n[a] + keep*slide[a], change = push - was[a];
        if (seam->fixed != 1) (&first->x)[a] -= (float)(change/first->w);
        if (seam->fixed != 2) (&second->x)[a] += (float)(change/second->w);
        seam->push[a] = (float)push;
        square += change*change;
    }
    return square;
}

/* The gap at the end of the step; returns what the push has cost, J. */
static double settle_seam(mpm_seam *seam, const tobi_float4 *first, const tobi_float4 *second, double dt)
{
    const joint j = look_at(seam, first, second);
    seam->gap += (float)(j.along*dt);
    return -(seam->push[0]*j.u[0] + seam->push[1]*j.u[1] + seam->push[2]*j.u[2]);
}

/* What is stationary does not even fall. */
static void begin_seam(mpm_seam *seam, tobi_float4 *first, tobi_float4 *second)
{
    tobi_float4 *fixed = seam->fixed == 1 ? first : second;
    if (seam->fixed) fixed->x = fixed->y = fixed->z = 0;
    memset(seam->push, 0, sizeof seam->push);
}

double mpm_seams_visit(mpm_seam *seams, int64_t begin, int64_t end, tobi_float4 *node, double dt,
                       mpm_visit what)
{
    double lost = 0;
    for (int64_t k = begin; k < end; k++) {
        mpm_seam *seam = &seams[k];
        tobi_float4 *first = &node[seam->first], *second = &node[seam->second];
        if (!(first->w > 0) || !(second->w > 0)) continue;
        if (what == MPM_BEGIN) begin_seam(seam, first, second);
        if (what == MPM_SETTLE) lost += settle_seam(seam, first, second, dt);
        else press(seam, first, second, dt);
    }
    return lost;
}

static double speed_along(const mpm_face *f, const tobi_float4 *first, const tobi_float4 *second)
{
    double along = 0;
    for (int a = 0; a < 3; a++) along += f->normal[a]*((double)(&second->x)[a] - (&first->x)[a]);
    return along;
}

/* Bodies with corners are apart as long as one plane parts them: they touch at the face whose gap would be
   widest at the end of the step. */
static void choose_face(mpm_pair *p, const tobi_float4 *first, const tobi_float4 *second, double dt)
{
    double widest = -INFINITY;
    for (int k = 0; k < p->count; k++) {
        const double gap = p->face[k].gap + dt*speed_along(&p->face[k], first, second);
        if (!(gap > widest)) continue;
        widest = gap;
        memcpy(p->seam.normal, p->face[k].normal, sizeof p->seam.normal);
        p->seam.gap = p->face[k].gap;
    }
    memset(p->seam.push, 0, sizeof p->seam.push);
}

static double settle_pair(mpm_pair *p, const tobi_float4 *first, const tobi_float4 *second, double dt)
{
    for (int k = 0; k < p->count; k++)
        p->face[k].gap += (float)(dt*speed_along(&p->face[k], first, second));
    return settle_seam(&p->seam, first, second, dt);
}

enum { ROUNDS = 30 };
static const double STILL = 1e-3;      /* of the largest impulse may still change                  */

double mpm_pairs_visit(mpm_pair *pairs, int64_t count, tobi_float4 *node, double dt, mpm_visit what)
{
    double lost = 0, change = INFINITY, largest = 0;
    for (int round = 0; round < (what == MPM_PRESS ? ROUNDS : 1) && change > STILL*STILL*largest; round++) {
        change = largest = 0;
        for (int64_t k = 0; k < count; k++) {
            mpm_pair *p = &pairs[k];
            tobi_float4 *first = &node[p->seam.first], *second = &node[p->seam.second];
            if (p->count == 0 || !(first->w > 0) || !(second->w > 0)) continue;
            if (what == MPM_BEGIN) choose_face(p, first, second, dt);
            if (what == MPM_SETTLE) lost += settle_pair(p, first, second, dt);
            if (what != MPM_PRESS) continue;
            const float *push = p->seam.push;
            change = fmax(change, press(&p->seam, first, second, dt));
            largest = fmax(largest, (double)push[0]*push[0] + (double)push[1]*push[1] +
                                        (double)push[2]*push[2]);
        }
    }
    return lost;
}
