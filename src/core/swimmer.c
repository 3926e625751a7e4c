/* Mass of a body that changes its shape, by points that move with it (docs/decisions/0069-swimmers.md). The
   sums over points are the body's centre, inertia and inner momenta, so that what is taken out of the motion
   is what the points have. Drawback: the motion is asked for each mass point too, some eight for each
   triangle. */
#include "core/body.h"
#include "base/error.h"
#include "geom/masspoints.h"
#include "geom/vec3.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of the volume at rest: a shape with less is squeezed to nothing. */
static const double LEAST = 1e-2;
/* Of the sum of the moments of inertia at rest: less is what rounding leaves. */
static const double LEAST_INERTIA = 1e-9;

void tobi_swimmer_free(tobi_swimmer *w)
{
    if (!w) return;
    free(w->rest); free(w->mass); free(w->now); free(w->next);
    free(w->shape); free(w->flow); free(w->point_flow);
    free(w);
}

static tobi_status allocate(tobi_body *b, const tobi_mass_points *p, tobi_error *err)
{
    tobi_swimmer *w = b->swimmer;
    const size_t n = (size_t)p->count, v = (size_t)b->mesh.vertex_count, q = (size_t)b->surface.count;
    w->count = p->count;
    w->rest = calloc(n + 1, sizeof *w->rest);
    w->mass = calloc(n + 1, sizeof *w->mass);
    w->now = calloc(n + 1, sizeof *w->now);
    w->next = calloc(n + 1, sizeof *w->next);
    w->shape = calloc(v + 1, sizeof *w->shape);
    w->flow = calloc(v + 1, sizeof *w->flow);
    w->point_flow = calloc(q + 1, sizeof *w->point_flow);
    if (w->rest && w->mass && w->now && w->next && w->shape && w->flow && w->point_flow) return TOBI_OK;
    return tobi_fail(err, TOBI_NO_MEMORY, "body '%s': no memory for %zu mass points", b->name, n);
}

/* Volume of the shape that the vertices make; 2-D: the mean over the depth of a prism. */
static double measure_volume(const tobi_body *b, const double (*vertex)[3])
{
    double volume = 0;
    const double *origin = vertex[0];
    for (int64_t t = 0; t < b->mesh.triangle_count; t++) {
        double e[3][3], n[3];
        for (int c = 0; c < 3; c++) vec3_sub(e[c], vertex[b->mesh.triangles[t][c]], origin);
        vec3_cross(n, e[1], e[2]);
        volume += vec3_dot(e[0], n)/6;
    }
    return volume;
}

static tobi_status check_shape(const tobi_body *b, double t, tobi_error *err)
{
    const double rest = measure_volume(b, (const double (*)[3])b->mesh.vertices);
    const double now = measure_volume(b, (const double (*)[3])b->swimmer->shape);
    if (now > LEAST*rest) return TOBI_OK;
    return tobi_fail(err, TOBI_INVALID, "body '%s': its motion %s at t = %.9g s, to %.3g of its volume at "
                     "rest; allowed is %g and more", b->name,
                     now < 0 ? tr("turns it inside out") : tr("squeezes it"), t, now/rest, LEAST);
}

static tobi_status ask(const tobi_body *b, double t, int64_t n, const double (*rest)[3], double (*out)[3],
                       tobi_error *err)
{
    if (b->steer) b->steer(b->motion_user, b->swimmer->next_steer);
    return tobi_body_ask_motion(b, t, n, rest, out, err);
}

int tobi_swimmer_inertia(const tobi_swimmer *w, const double (*at)[3], double inertia[9], double inverse[9])
{
    double m[3][3] = { { 0 } };
    for (int64_t i = 0; i < w->count; i++)
        for (int a = 0; a < 3; a++)
            for (int c = a; c < 3; c++) m[a][c] += w->mass[i]*at[i][a]*at[i][c];
    const double trace = m[0][0] + m[1][1] + m[2][2];
    for (int a = 0; a < 3; a++)
        for (int c = 0; c < 3; c++)
            inertia[3*a + c] = (a == c ? trace : 0) - (a < c ? m[a][c] : m[c][a]);
    if (w->dimension == 2) return inertia[8] > w->least_inertia;
    return inertia[0] > w->least_inertia && inertia[0]*inertia[4] > inertia[1]*inertia[1] &&
           tobi_rigid_invert(inertia, inverse);
}

/* Shape and inertia at t into next and shape. */
static tobi_status take_shape(tobi_body *b, double t, tobi_error *err)
{
    tobi_swimmer *w = b->swimmer;
    double sum[3] = { 0 };
    TOBI_TRY(ask(b, t, b->mesh.vertex_count, (const double (*)[3])b->mesh.vertices, w->shape, err));
    TOBI_TRY(check_shape(b, t, err));
    TOBI_TRY(ask(b, t, w->count, (const double (*)[3])w->rest, w->next, err));
    /* Twice: what rounding leaves of the centre far from the origin would be inner momentum. */
    memset(w->next_centre, 0, sizeof w->next_centre);
    for (int round = 0; round < 2; round++) {
        memset(sum, 0, sizeof sum);
        for (int64_t i = 0; i < w->count; i++)
            vec3_add_scaled(sum, sum, w->mass[i]/b->rigid.mass, w->next[i]);
        for (int64_t i = 0; i < w->count; i++) vec3_sub(w->next[i], w->next[i], sum);
        vec3_add_scaled(w->next_centre, w->next_centre, 1, sum);
    }
    const double (*at)[3] = (const double (*)[3])w->next;
    if (tobi_swimmer_inertia(w, at, w->next_inertia, w->next_inverse)) return TOBI_OK;
    return tobi_fail(err, TOBI_INVALID, "body '%s': its motion gives it the inertia (%g, %g, %g) kg m2 at "
                     "t = %.9g s, which no body has", b->name, w->next_inertia[0], w->next_inertia[4],
                     w->next_inertia[8], t);
}

static void swap_shapes(tobi_body *b)
{
    tobi_swimmer *w = b->swimmer;
    double (*swap)[3] = w->now;
    w->now = w->next;
    w->next = swap;
    memcpy(w->centre, w->next_centre, sizeof w->centre);
    memcpy(w->steer, w->next_steer, sizeof w->steer);
    memcpy(b->rigid.inertia, w->next_inertia, sizeof w->next_inertia);
    if (w->dimension == 3) memcpy(b->rigid.inverse, w->next_inverse, sizeof w->next_inverse);
    memcpy(b->info.inertia, w->next_inertia, sizeof b->info.inertia);
}

tobi_status tobi_swimmer_create(tobi_body *b, int dimension, tobi_error *err)
{
    tobi_mass_points p;
    double volume = 0;
    if (b->rigid.kind == TOBI_PRESCRIBED || !b->motion) return TOBI_OK;
    b->swimmer = calloc(1, sizeof *b->swimmer);
    if (!b->swimmer) return tobi_fail(err, TOBI_NO_MEMORY, "body '%s': no memory for a swimmer", b->name);
    b->swimmer->dimension = dimension;
    TOBI_TRY(tobi_mass_points_make(&b->mesh, dimension, &p, err));
    const tobi_status status = allocate(b, &p, err);
    for (int64_t i = 0; i < p.count; i++) volume += p.volume[i];
    for (int64_t i = 0; status == TOBI_OK && i < p.count; i++) {
        memcpy(b->swimmer->rest[i], p.at[i], sizeof p.at[i]);
        b->swimmer->mass[i] = b->rigid.mass*p.volume[i]/volume;
    }
    tobi_mass_points_free(&p);
    TOBI_TRY(status);
    const double *rest = b->rigid.inertia;
    b->swimmer->least_inertia = LEAST_INERTIA*(rest[0] + rest[4] + rest[8]);
    double angular[3];
    memcpy(angular, b->rigid.angular_velocity, sizeof angular);
    TOBI_TRY(take_shape(b, 0, err));
    swap_shapes(b);
    vec3_sub(b->rigid.position, b->swimmer->centre, b->lower);
    memcpy(b->rigid.next_position, b->rigid.position, sizeof b->rigid.position);
    for (int a = 0; a < 3; a++) b->rigid.momentum[a] = vec3_dot(&b->rigid.inertia[3*a], angular);
    tobi_rigid_apply_locks(&b->rigid);
    return TOBI_OK;
}

/* What the shape does without momentum: the velocities of a step from rest. */
static void find_flow(tobi_body *b, double dt)
{
    tobi_swimmer *w = b->swimmer;
    tobi_rigid rest = b->rigid;
    double (*m)[3] = w->still, arm[3];
    memset(rest.momentum, 0, sizeof rest.momentum);
    memset(rest.velocity, 0, sizeof rest.velocity);
    memset(rest.angular_velocity, 0, sizeof rest.angular_velocity);
    memset(rest.push, 0, sizeof rest.push);
    memset(rest.turn, 0, sizeof rest.turn);
    tobi_rigid_drift_freely(&rest, dt);
    tobi_quaternion_matrix(rest.next_orientation, m);
    for (int64_t i = 0; i < b->mesh.vertex_count; i++) {
        vec3_sub(arm, w->shape[i], w->next_centre);
        for (int a = 0; a < 3; a++)
            w->flow[i][a] = (vec3_dot(m[a], arm) - (b->vertex[i][a] - rest.position[a]))/dt;
    }
}

tobi_status tobi_swimmer_predict(tobi_body *b, double t, double dt, tobi_error *err)
{
    tobi_swimmer *w = b->swimmer;
    double (*moments)[3] = b->rigid.moments;
    TOBI_TRY(take_shape(b, t + dt, err));
    memset(moments, 0, sizeof b->rigid.moments);
    for (int64_t i = 0; i < w->count; i++)
        for (int a = 0; a < 3; a++)
            vec3_add_scaled(moments[a], moments[a], w->mass[i]*w->now[i][a], w->next[i]);
    find_flow(b, dt);
    return TOBI_OK;
}

tobi_status tobi_swimmer_carry(const tobi_body *b, double t, int64_t n, const double (*rest)[3],
                               double (*out)[3], tobi_error *err)
{
    const tobi_swimmer *w = b->swimmer;
    TOBI_TRY(ask(b, t, n, rest, out, err));
    for (int64_t i = 0; i < n; i++) {
        double arm[3];
        vec3_sub(arm, out[i], w->next_centre);
        for (int a = 0; a < 3; a++)
            out[i][a] = b->lower[a] + (b->rigid.position[a] + vec3_dot(w->still[a], arm));
    }
    return TOBI_OK;
}

void tobi_swimmer_advance(tobi_body *b)
{
    memcpy(b->vertex_before, b->swimmer->flow, (size_t)b->mesh.vertex_count*sizeof *b->vertex_before);
    swap_shapes(b);
    tobi_rigid_apply_locks(&b->rigid);
}

void tobi_swimmer_save(const tobi_swimmer *w, double (*rows)[3])
{
    memcpy(rows, w->now, (size_t)w->count*sizeof *rows);
    memcpy(rows[w->count], w->centre, sizeof w->centre);
    memcpy(rows[w->count + 1], w->steer, sizeof w->steer);
    memcpy(rows[w->count + 2], w->next_steer, sizeof w->next_steer);
}

void tobi_swimmer_restore(tobi_body *b, const double (*rows)[3])
{
    tobi_swimmer *w = b->swimmer;
    tobi_swimmer_inertia(w, rows, w->next_inertia, w->next_inverse);
    memcpy(w->next, rows, (size_t)w->count*sizeof *rows);
    memcpy(w->next_centre, rows[w->count], sizeof w->next_centre);
    memcpy(w->next_steer, rows[w->count + 1], sizeof w->next_steer);
    swap_shapes(b);
    memcpy(w->next_steer, rows[w->count + 2], sizeof w->next_steer);
}
