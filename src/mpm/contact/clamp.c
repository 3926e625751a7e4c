/* A clamp is a spring and a damper at each held particle, as stiff as the step allows, on the nodes that the
   particle feels. The velocities of a body that moves by forces are unknowns of the same equations. Drawback:
   one thread puts the impulses on the nodes. */
#include "mpm/contact/clamp.h"
#include "base/error.h"
#include "geom/vec3.h"
#include "mpm/contact/contact.h"
#include "mpm/particle_fields.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of its way from its place a particle goes back by this share in the longest step, eq. (5). In shorter
   ones it is less, so that the stiffness is the same. */
static const double SHARE = 0.25;
/* Spacings from the surface within which a particle is held. */
static const double NEAR = 1 + 1e-6;

void mpm_clamp_free(mpm_clamp *c)
{
    free(c->held);
    free(c->node);
    free(c->weight);
    for (int k = 0; k < 3; k++) free(c->place[k]);
    free(c->first);
    free(c->velocity);
    memset(c, 0, sizeof *c);
}

static const tobi_float4 *place_of(const tobi_system *s, int64_t i)
{
    const mpm_fields *f = mpm_fields_of(&s->particles);
    return f->clamp ? &f->clamp[i] : NULL;
}

int mpm_clamp_body(const tobi_system *s, int64_t i)
{
    const tobi_float4 *place = place_of(s, i);
    return place && place->w != 0 ? (int)fabsf(place->w) - 1 : -1;
}

int mpm_clamp_hides(const tobi_system *s, int64_t i)
{
    const tobi_float4 *place = place_of(s, i);
    return place && place->w < 0;
}

/* Of the bodies that hold a solid the first that x lies in, else the first that it is near, else -1. */
static int find_holder(const tobi_system *s, const tobi_solid *solid, const double x[3], int *inside)
{
    tobi_bvh_hit hit;
    for (*inside = 1; *inside >= 0; --*inside)
        for (int k = 0; k < solid->clamp_count; k++) {
            const tobi_bvh *bvh = s->sim->bodies[solid->clamp[k]].bvh;
            if (*inside ? tobi_bvh_inside(bvh, x) : tobi_bvh_closest(bvh, x, NEAR*s->smoothing.spacing, &hit))
                return solid->clamp[k];
        }
    return -1;
}

void mpm_clamp_place(const tobi_system *s, int64_t i)
{
    const tobi_particles *p = &s->particles;
    tobi_float4 *place = mpm_fields_of(p)->clamp;
    if (!place) return;
    place[i] = (tobi_float4){0, 0, 0, 0};
    const double x[3] = {p->position[i].x, p->position[i].y, p->position[i].z};
    double arm[3], m[3][3];
    int inside;
    const int body = find_holder(s, &s->solids[p->fluid[i]], x, &inside);
    if (body < 0) return;
    const tobi_body *b = &s->sim->bodies[body];
    vec3_sub(arm, x, b->rigid.position);
    tobi_quaternion_matrix(b->rigid.orientation, m);
    for (int a = 0; a < 3; a++)
        (&place[i].x)[a] = (float)(m[0][a]*arm[0] + m[1][a]*arm[1] + m[2][a]*arm[2]);
    place[i].w = (float)(inside ? -1 - body : 1 + body);
}

/* Newton's method; eight rounds are plenty for what is a shape. */
enum { ROUNDS = 8 };
static const double EXACT = 1e-7, ARM = 1e-3;      /* spacings */

tobi_status mpm_clamp_find_rest(const tobi_system *s, int64_t i, double *stray, tobi_error *err)
{
    tobi_float4 *place = &mpm_fields_of(&s->particles)->clamp[i];
    const tobi_body *b = &s->sim->bodies[mpm_clamp_body(s, i)];
    const double *x = &s->particles.position[i].x, arm = ARM*s->smoothing.spacing;
    double rest[4][3], now[4][3], m[9], inverse[9], off[3];
    *stray = 0;
    if (!b->deforms) return TOBI_OK;
    for (int a = 0; a < 3; a++) rest[0][a] = x[a] + b->lower[a];
    for (int round = 0; round < ROUNDS; round++) {
        for (int k = 1; k < 4; k++)
            for (int a = 0; a < 3; a++) rest[k][a] = rest[0][a] + (a == k - 1 ? arm : 0);
        TOBI_TRY(tobi_body_locate(b, s->sim->time, 4, (const double (*)[3])rest, now, err));
        for (int a = 0; a < 3; a++) {
            off[a] = now[0][a] - b->lower[a] - x[a];
            for (int k = 0; k < 3; k++) m[3*a + k] = (now[1 + k][a] - now[0][a])/arm;
        }
        *stray = sqrt(vec3_dot(off, off));
        if (*stray < EXACT*s->smoothing.spacing || !tobi_rigid_invert(m, inverse)) break;
        for (int a = 0; a < 3; a++) rest[0][a] -= vec3_dot(inverse + 3*a, off);
    }
    for (int a = 0; a < 3; a++) (&place->x)[a] = (float)(rest[0][a] - b->rest.centre[a]);
    return TOBI_OK;
}

static tobi_status reserve(mpm_clamp *c, int bodies, int64_t count, tobi_error *err)
{
    if (bodies != c->bodies) {
        free(c->first);
        free(c->velocity);
        c->first = calloc((size_t)bodies + 1, sizeof *c->first);
        c->velocity = calloc((size_t)bodies, sizeof *c->velocity);
        c->bodies = c->first && c->velocity ? bodies : 0;
        if (!c->bodies)
            return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the clamps of %d bodies", bodies);
    }
    if (count <= c->room) return TOBI_OK;
    free(c->held);
    free(c->node);
    free(c->weight);
    int failed = 0;
    for (int k = 0; k < 3; k++) {
        free(c->place[k]);
        c->place[k] = malloc((size_t)count*sizeof *c->place[k]);
        failed |= !c->place[k];
    }
    c->held = malloc((size_t)count*sizeof *c->held);
    c->node = malloc((size_t)count*MPM_FELT*sizeof *c->node);
    c->weight = malloc((size_t)count*MPM_FELT*sizeof *c->weight);
    c->room = !failed && c->held && c->node && c->weight ? count : 0;
    return c->room ? TOBI_OK
                   : tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld held particles", (long long)count);
}

/* The held particles as they are sorted now, by body. */
static tobi_status list_held(mpm_clamp *c, const tobi_system *s, tobi_error *err)
{
    const int bodies = s->sim->body_count;
    int64_t count = 0;
    for (int64_t i = 0; i < s->particles.count; i++) count += mpm_clamp_body(s, i) >= 0;
    c->count = 0;
    TOBI_TRY(reserve(c, bodies, count, err));
    memset(c->first, 0, ((size_t)bodies + 1)*sizeof *c->first);
    if (!count) return TOBI_OK;
    for (int64_t i = 0; i < s->particles.count; i++) {     /* how many of the body before */
        const int body = mpm_clamp_body(s, i);
        if (body >= 0 && body + 1 < bodies) c->first[body + 2]++;
    }
    for (int k = 2; k <= bodies; k++) c->first[k] += c->first[k - 1];
    for (int64_t i = 0; i < s->particles.count; i++) {     /* each body's begin moves to its end */
        const int body = mpm_clamp_body(s, i);
        if (body >= 0) c->held[c->first[body + 1]++].particle = (int32_t)i;
    }
    c->count = count;
    return TOBI_OK;
}

/* Where a body is now, and at the end of the step or substep: centre, and rest axes to the domain's. Where
   one that deforms has its held particles is in mpm_clamp.place. */
typedef struct poses { double centre[2][3], matrix[2][3][3]; int moves, deforms; } poses;

/* What the loop over the held particles of a body needs. */
typedef struct holding {
    mpm_clamp *c;
    const tobi_system *s;
    const mpm_grid *grid;
    const mpm_view *v;
    const poses *at;
    int64_t first;
    double share;                      /* of the way back in this step */
} holding;

static tobi_status find_poses(tobi_system *s, tobi_body *b, poses *at, tobi_error *err)
{
    tobi_rigid *r = &b->rigid;
    double position[3], orientation[4];
    at->moves = r->kind != TOBI_PRESCRIBED;
    at->deforms = b->deforms;
    memcpy(position, r->position, sizeof position);
    memcpy(orientation, r->orientation, sizeof orientation);
    memcpy(at->centre[0], r->position, sizeof position);
    tobi_quaternion_matrix(r->orientation, at->matrix[0]);
    if (!at->moves && !at->deforms)
        TOBI_TRY(tobi_body_place_within(b, s->sim->time, s->sim->way + s->dt, 0, err));
    memcpy(at->centre[1], r->position, sizeof position);
    tobi_quaternion_matrix(r->orientation, at->matrix[1]);
    memcpy(r->position, position, sizeof position);
    memcpy(r->orientation, orientation, sizeof orientation);
    return TOBI_OK;
}

/* Asks a motion where it has the held particles of a body that deforms. */
static tobi_status ask_places(mpm_clamp *c, const tobi_system *s, int body, tobi_error *err)
{
    const tobi_body *b = &s->sim->bodies[body];
    const mpm_fields *f = mpm_fields_of(&s->particles);
    const int64_t first = c->first[body], count = c->first[body + 1] - first;
    for (int64_t n = first; n < first + count; n++)
        for (int a = 0; a < 3; a++)
            c->place[0][n][a] = b->rest.centre[a] + (double)(&f->clamp[c->held[n].particle].x)[a];
    const double (*rest)[3] = (const double (*)[3])(c->place[0] + first);
    for (int end = 0; end < 2; end++) {
        double (*at)[3] = c->place[1 + end] + first;
        const double t = s->sim->time + s->sim->way + (end ? s->dt : 0);
        TOBI_TRY(end && b->swimmer ? tobi_swimmer_carry(b, t, count, rest, at, err)
                                   : tobi_body_locate(b, t, count, rest, at, err));
        for (int64_t n = 0; n < count; n++) vec3_sub(at[n], at[n], b->lower);
    }
    return TOBI_OK;
}

/* Where the body has the particle, now or at the end of the step. */
static double find_place(const holding *v, int64_t n, int end, int a)
{
    if (v->at->deforms) return v->c->place[1 + end][n][a];
    const tobi_float4 *rest = &mpm_fields_of(&v->s->particles)->clamp[v->c->held[n].particle];
    const double arm[3] = {rest->x, rest->y, rest->z};
    return v->at->centre[end][a] + vec3_dot(v->at->matrix[end][a], arm);
}

/* What it is to do, eq. (5). */
static void look(const holding *v, int64_t n)
{
    const tobi_system *s = v->s;
    const int64_t i = v->c->held[n].particle;
    const mpm_fields *f = mpm_fields_of(&s->particles);
    const tobi_double3 x = s->particles.position[i];
    const double at[3] = {x.x, x.y, x.z};
    mpm_held *h = &v->c->held[n];
    h->mass = f->strain[i].c[2].w;
    vec3_sub(h->arm, at, v->at->centre[0]);
    for (int a = 0; a < 3; a++) {
        const double now = find_place(v, n, 0, a), next = find_place(v, n, 1, a);
        h->aim[a] = a < s->box.dimension ? (next - now + v->share*(now - at[a]))/s->dt : 0;
    }
}

static void read_nodes(const holding *v, int64_t n, mpm_felt *last)
{
    const int deep = v->grid->dimension == 3 ? 3 : 1;
    mpm_held *h = &v->c->held[n];
    uint32_t *node = v->c->node + n*MPM_FELT;
    float *weight = v->c->weight + n*MPM_FELT;
    double w[3][3] = {{1}, {1}, {1}};
    int base[3];
    mpm_feel(v->grid, v->v, h->particle, last, node, w, base);
    memset(h->velocity, 0, sizeof h->velocity);
    for (int k = 0; k < 9*deep; k++) {
        const double all = w[0][k/deep/3]*w[1][k/deep%3]*w[2][k%deep];
        const tobi_float4 *at = &v->grid->node[node[k]];
        weight[k] = (float)all;
        for (int a = 0; a < v->grid->dimension; a++) h->velocity[a] += all*(double)(&at->x)[a];
    }
}

static void look_at_all(const void *view, int64_t begin, int64_t end)
{
    const holding *v = view;
    mpm_felt last = { 0 };
    for (int64_t n = v->first + begin; n < v->first + end; n++) {
        look(v, n);
        read_nodes(v, n, &last);
    }
}

/* The velocity at a held particle of six velocities of its body. */
static void find_turning(const mpm_held *h, const double velocity[6], double out[3])
{
    vec3_cross(out, velocity + 3, h->arm);
    for (int a = 0; a < 3; a++) out[a] += velocity[a];
}

/* m G^T G and m G^T (v - aim), where G takes the six velocities to the particle. */
static void add_held(const mpm_held *h, double matrix[6][6], double vector[6])
{
    const double *r = h->arm, m = h->mass;
    const double g[3][6] = {{1, 0, 0, 0, r[2], -r[1]}, {0, 1, 0, -r[2], 0, r[0]}, {0, 0, 1, r[1], -r[0], 0}};
    for (int a = 0; a < 3; a++)
        for (int i = 0; i < 6; i++) {
            for (int k = 0; k < 6; k++) matrix[i][k] += m*g[a][i]*g[a][k];
            vector[i] += m*g[a][i]*(h->velocity[a] - h->aim[a]);
        }
}

/* Velocities of the body without the clamp, as far as they are known: with this step's pull and what others
   have given it already. */
static void predict(const tobi_rigid *r, const double inverse[6][6], double dt, double velocity[6])
{
    double impulse[6];
    for (int a = 0; a < 3; a++) {
        impulse[a] = r->impulse[a] + dt*r->mass*r->pull[a];
        impulse[3 + a] = r->twist[a] + dt*r->pull_torque[a];
        velocity[a] = r->velocity[a];
        velocity[3 + a] = r->angular_velocity[a];
    }
    for (int i = 0; i < 6; i++)
        for (int k = 0; k < 6; k++) velocity[i] += inverse[i][k]*impulse[k];
}

/* V = V0 + M^-1 (sum of m G^T (v - aim) - sum of m G^T G V), eq. (6). */
static void solve_body(mpm_clamp *c, int body, tobi_simulation *sim, double dt)
{
    double inverse[6][6], matrix[6][6] = {{0}}, vector[6] = {0}, a[6][6], *velocity = c->velocity[body];
    tobi_rigid *r = &sim->bodies[body].rigid;
    r->is_clamped = 1;
    tobi_constraints_inverse(&sim->constraints, sim->bodies, body, inverse);
    if (!tobi_constraints_expect(&sim->constraints, sim->bodies, body, dt, velocity))
        predict(r, (const double (*)[6])inverse, dt, velocity);
    for (int64_t n = c->first[body]; n < c->first[body + 1]; n++) add_held(&c->held[n], matrix, vector);
    for (int i = 0; i < 6; i++) {
        for (int k = 0; k < 6; k++) a[i][k] = i == k;
        for (int j = 0; j < 6; j++) {
            for (int k = 0; k < 6; k++) a[i][k] += inverse[i][j]*matrix[j][k];
            velocity[i] += inverse[i][j]*vector[j];
        }
    }
    tobi_contact_eliminate(a, velocity);
}

/* Puts an impulse on the nodes that a particle feels; those without mass have no particle. */
static void push_nodes(const mpm_clamp *c, int64_t n, const mpm_grid *g, const double impulse[3])
{
    const uint32_t *node = c->node + n*MPM_FELT;
    const float *weight = c->weight + n*MPM_FELT;
    for (int k = 0; k < mpm_nodes_each(g); k++) {
        tobi_float4 *at = &g->node[node[k]];
        if (!(at->w > 0)) continue;
        for (int a = 0; a < g->dimension; a++) (&at->x)[a] += weight[k]*(float)impulse[a]/at->w;
    }
}

static void push(mpm_clamp *c, tobi_system *s, int body, const mpm_grid *g)
{
    tobi_body *b = &s->sim->bodies[body];
    const int moves = b->rigid.kind != TOBI_PRESCRIBED;
    double sum[6] = {0};
    for (int64_t n = c->first[body]; n < c->first[body + 1]; n++) {
        const mpm_held *h = &c->held[n];
        double own[3] = {0}, impulse[3], twist[3];
        if (moves) find_turning(h, c->velocity[body], own);
        for (int a = 0; a < 3; a++)
            impulse[a] = a < g->dimension ? h->mass*(own[a] + h->aim[a] - h->velocity[a]) : 0;
        push_nodes(c, n, g, impulse);
        vec3_cross(twist, h->arm, impulse);
        for (int a = 0; a < 3; a++) {
            sum[a] -= impulse[a];
            sum[3 + a] -= twist[a];
            c->work += impulse[a]*(own[a] + h->aim[a]);
        }
    }
    for (int a = 0; a < 3; a++) {
        b->rigid.impulse[a] += sum[a];
        b->rigid.twist[a] += sum[3 + a];
    }
    for (int a = 0; a < 6; a++) b->load[s->number].pressure[a] += sum[a]/s->sim->dt;
}

tobi_status mpm_clamp_hold(mpm_clamp *c, tobi_system *s, const mpm_grid *g, const mpm_view *v, int fresh,
                           tobi_error *err)
{
    c->work = 0;
    if (!mpm_fields_of(&s->particles)->clamp) return TOBI_OK;
    if (fresh) TOBI_TRY(list_held(c, s, err));
    for (int k = 0; k < c->bodies; k++) {
        const int64_t count = c->first[k + 1] - c->first[k];
        tobi_body *b = &s->sim->bodies[k];
        poses at;
        const double shorter = fmin(s->dt/c->longest, 1);
        const holding view = { .c = c, .s = s, .grid = g, .v = v, .at = &at, .first = c->first[k],
                               .share = SHARE*shorter*shorter };
        if (count == 0) continue;
        TOBI_TRY(find_poses(s, b, &at, err));
        if (b->deforms) TOBI_TRY(ask_places(c, s, k, err));
        tobi_loop(tobi_team(&s->sim->exec, count, 1024), count, 0, look_at_all, &view);
        if (at.moves) {
            solve_body(c, k, s->sim, s->dt);
            tobi_body_correct(b, c->velocity[k], c->velocity[k] + 3, s->dt);
        }
        push(c, s, k, g);
    }
    return TOBI_OK;
}

int mpm_clamp_velocity(const mpm_clamp *c, int body, double velocity[3], double spin[3])
{
    if (body >= c->bodies || c->first[body + 1] == c->first[body]) return 0;
    memcpy(velocity, c->velocity[body], 3*sizeof *velocity);
    memcpy(spin, c->velocity[body] + 3, 3*sizeof *spin);
    return 1;
}
