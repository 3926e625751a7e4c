/* Contact of faces at the nodes. A cut face is solved exactly in one sweep; where cuts cross, the pairs of a
   node share velocities and are solved in turn until their impulses stand. */
#include "mpm/cut/face.h"
#include "geom/vec3.h"
#include <math.h>
#include <string.h>

/* A cut face and the two velocities it couples. */
typedef struct joint {
    double along, u[3], n[3];          /* m/s, of the second relative to the first                 */
} joint;

static joint look_at(const mpm_cut_face *cut_face, const tobi_float4 *first, const tobi_float4 *second)
{
    joint j;
    for (int a = 0; a < 3; a++) {
        j.n[a] = cut_face->normal[a];
        j.u[a] = (double)(&second->x)[a] - (&first->x)[a];
    }
    j.along = vec3_dot(j.u, j.n);
    return j;
}

/* One sweep of contact between the faces, eq. (3): the sum of its impulses pushes and obeys friction;
   momentum is kept. Returns the square of the impulse's change. */
static double press(mpm_cut_face *cut_face, tobi_float4 *first, tobi_float4 *second, double dt)
{
    const joint j = look_at(cut_face, first, second);
    const double lack = -fmax(cut_face->gap, 0)/dt - j.along;
    double was[3] = {cut_face->push[0], cut_face->push[1], cut_face->push[2]}, slide[3], square = 0;
    if (lack <= 0 && was[0] == 0 && was[1] == 0 && was[2] == 0) return 0;
    const double mass = cut_face->fixed == 1   ? second->w
                        : cut_face->fixed == 2 ? first->w
                                           : (double)first->w*second->w/((double)first->w + second->w);
    double normal = fmax(0, vec3_dot(was, j.n) + mass*lack);
    for (int a = 0; a < 3; a++) slide[a] = was[a] - mass*(j.u[a] - j.along*j.n[a]);
    vec3_add_scaled(slide, slide, -vec3_dot(slide, j.n), j.n);
    double size = vec3_length(slide), limit = cut_face->friction*normal, keep = size > limit ? limit/size : 1;
    for (int a = 0; a < 3; a++) {
        double push = normal*j.n[a] + keep*slide[a], change = push - was[a];
        if (cut_face->fixed != 1) (&first->x)[a] -= (float)(change/first->w);
        if (cut_face->fixed != 2) (&second->x)[a] += (float)(change/second->w);
        cut_face->push[a] = (float)push;
        square += change*change;
    }
    return square;
}

/* The gap at the end of the step; returns what the push has cost, J. */
static double finish_cut_face(mpm_cut_face *cut_face, const tobi_float4 *first, const tobi_float4 *second,
                              double dt)
{
    const joint j = look_at(cut_face, first, second);
    cut_face->gap += (float)(j.along*dt);
    return -(cut_face->push[0]*j.u[0] + cut_face->push[1]*j.u[1] + cut_face->push[2]*j.u[2]);
}

/* What is stationary does not even fall. */
static void begin_cut_face(mpm_cut_face *cut_face, tobi_float4 *first, tobi_float4 *second)
{
    tobi_float4 *fixed = cut_face->fixed == 1 ? first : second;
    if (cut_face->fixed) fixed->x = fixed->y = fixed->z = 0;
    memset(cut_face->push, 0, sizeof cut_face->push);
}

double mpm_cut_faces_visit(mpm_cut_face *cut_faces, int64_t begin, int64_t end, tobi_float4 *node, double dt,
                       mpm_visit what)
{
    double lost = 0;
    for (int64_t k = begin; k < end; k++) {
        mpm_cut_face *cut_face = &cut_faces[k];
        tobi_float4 *first = &node[cut_face->first], *second = &node[cut_face->second];
        if (!(first->w > 0) || !(second->w > 0)) continue;
        if (what == MPM_BEGIN) begin_cut_face(cut_face, first, second);
        if (what == MPM_FINISH) lost += finish_cut_face(cut_face, first, second, dt);
        else press(cut_face, first, second, dt);
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
        memcpy(p->cut_face.normal, p->face[k].normal, sizeof p->cut_face.normal);
        p->cut_face.gap = p->face[k].gap;
    }
    memset(p->cut_face.push, 0, sizeof p->cut_face.push);
}

static double finish_pair(mpm_pair *p, const tobi_float4 *first, const tobi_float4 *second, double dt)
{
    for (int k = 0; k < p->count; k++)
        p->face[k].gap += (float)(dt*speed_along(&p->face[k], first, second));
    return finish_cut_face(&p->cut_face, first, second, dt);
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
            tobi_float4 *first = &node[p->cut_face.first], *second = &node[p->cut_face.second];
            if (p->count == 0 || !(first->w > 0) || !(second->w > 0)) continue;
            if (what == MPM_BEGIN) choose_face(p, first, second, dt);
            if (what == MPM_FINISH) lost += finish_pair(p, first, second, dt);
            if (what != MPM_PRESS) continue;
            const float *push = p->cut_face.push;
            change = fmax(change, press(&p->cut_face, first, second, dt));
            largest = fmax(largest, (double)push[0]*push[0] + (double)push[1]*push[1] +
                                        (double)push[2]*push[2]);
        }
    }
    return lost;
}
