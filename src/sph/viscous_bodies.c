/* Friction of bodies in the solve of implicit viscosity, and the bodies' answer to it (decision 109): the
   velocities of those that move by forces are unknowns beside the particles'. Drawback: six more sums over
   what particles see of bodies in each step, for the friction of each body with itself. */
#include "sph/viscous_bodies.h"
#include "sph/boundary/boundary.h"
#include "sph/state.h"
#include "sph/viscosity.k.h"
#include "geom/matrix6.h"
#include "geom/vec3.h"
#include <math.h>
#include <string.h>

static int moves(const tobi_system *s, int body)
{
    return s->sim->bodies[body].rigid.kind != TOBI_PRESCRIBED;
}

static double dot6(const double a[6], const double b[6])
{
    return vec3_dot(a, b) + vec3_dot(a + 3, b + 3);
}

/* Where a particle is, from the lower corner of the box. */
static void find_place(const tobi_boundary_entry *e, double place[3])
{
    vec3_add_scaled(place, e->foot, 1, e->offset);
}

static double reach(const tobi_system *s, const tobi_boundary_entry *e)
{
    return fmax(e->distance, 0.25*s->smoothing.spacing);
}

/* How the wall of an entry goes, continued to the particle: its velocity there, and its rotation. moving: 1
   the body goes as it does and its answer comes to that, 0 the answer is all. */
static void find_wall(const tobi_system *s, const tobi_boundary_entry *e, int moving, double velocity[3],
                      double spin[3])
{
    const tobi_boundary_links *n = &sph_of(s)->links;
    const int body = n->link[e - n->entry].body;
    const tobi_body *b = &s->sim->bodies[body];
    double place[3], turn[3];
    find_place(e, place);
    tobi_body_carry(b, place, n->answer[body], velocity);
    vec3_cross(turn, b->info.angular_velocity, e->offset);
    for (int c = 0; c < 3; c++) {
        spin[c] = n->answer[body][3 + c] + (moving ? b->info.angular_velocity[c] : 0);
        if (moving && e->drag > 0) velocity[c] += e->drag_velocity[c]/e->drag + turn[c];
    }
}

/* Pa s, at particle i. */
static double viscosity_at(const tobi_system *s, int64_t i)
{
    const tobi_float4 *apparent = sph_fields_of(&s->particles)->apparent;
    return apparent ? apparent[i].x : s->fluid[s->particles.fluid[i]].viscosity;
}

/* Friction of one entry on particle i at velocity w and rotation `spin` of its neighbourhood, eq. (3): m/s2,
   and the couple on the body that goes with it, m2/s2; NULL: not asked. */
static void entry_friction(const tobi_system *s, int64_t i, const tobi_boundary_entry *e, tobi_float4 w,
                           tobi_float4 spin, int moving, double out[3], double couple[3])
{
    const tobi_fluid *f = &s->fluid[s->particles.fluid[i]];
    const double r = sph_fields_of(&s->particles)->viscous_lack[i].z, *n = e->foot_normal, at = reach(s, e);
    const double rate = viscosity_at(s, i)/f->density*e->drag;
    double slip[3], turn[3], wall[3], swung[3], pulled[3];
    find_wall(s, e, moving, slip, wall);
    for (int c = 0; c < 3; c++) {
        slip[c] -= (&w.x)[c];
        turn[c] = (&spin.x)[c] - wall[c];
    }
    vec3_add_scaled(slip, slip, -vec3_dot(slip, n), n);
    vec3_add_scaled(turn, turn, -vec3_dot(turn, n), n);
    vec3_cross(swung, turn, n);
    vec3_cross(pulled, n, slip);
    for (int c = 0; c < 3; c++) out[c] = rate*((1 + 0.5*r)*slip[c] + r*at*swung[c]);
    for (int c = 0; c < 3 && couple; c++) couple[c] = rate*r*at*(pulled[c] + at*turn[c]);
}

/* What they add to the sums of sph_strain: a wall is a neighbour with the velocity of its foot. */
static void add_strains(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_fields *f = sph_fields_of(&s->particles);
    SPH_FOR_NEAR_PARTICLES(s, k, i, e) {
        const double *n = e->foot_normal, at = reach(s, e), sigma = 0.5*e->drag*at;
        const float *w = &s->particles.velocity[i].x;
        tobi_float4 *row[3] = { &f->viscous_direction[i], &f->viscous_product[i], &f->viscous_residual[i] };
        tobi_float4 *a = &f->viscous_turning[i], *b = &f->viscous_lack[i];
        if (!(e->drag > 0)) continue;
        a->x += (float)(sigma*at*n[0]*n[0]); a->y += (float)(sigma*at*n[1]*n[1]);
        a->z += (float)(sigma*at*n[2]*n[2]); a->w += (float)(sigma*at*n[0]*n[1]);
        b->x += (float)(sigma*at*n[1]*n[2]); b->y += (float)(sigma*at*n[2]*n[0]);
        for (int c = 0; c < 3; c++) {
            const double slip = sigma*(w[c] - e->drag_velocity[c]/e->drag);
            row[c]->x += (float)(slip*n[0]); row[c]->y += (float)(slip*n[1]); row[c]->z += (float)(slip*n[2]);
        }
    }
}

void sph_viscous_bodies_strain(tobi_system *s)
{
    if (s->sim->body_count > 0) tobi_boundary_visit_entries(s, add_strains);
}

/* sigma s n n of the bodies, for sph_viscous_close. */
static void add_shapes(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_fields *f = sph_fields_of(&s->particles);
    SPH_FOR_NEAR_PARTICLES(s, k, i, e) {
        const double *n = e->foot_normal, size = 0.5*e->drag*reach(s, e)*reach(s, e);
        tobi_float4 *a = &f->viscous_direction[i], *b = &f->viscous_product[i];
        a->x += (float)(size*n[0]*n[0]); a->y += (float)(size*n[1]*n[1]); a->z += (float)(size*n[2]*n[2]);
        b->x += (float)(size*n[0]*n[1]); b->y += (float)(size*n[1]*n[2]); b->z += (float)(size*n[2]*n[0]);
    }
}

void sph_viscous_bodies_shape(tobi_system *s)
{
    if (s->sim->body_count > 0) tobi_boundary_visit_entries(s, add_shapes);
}

typedef struct spinning { const tobi_system *s; const sph_view *v; int moving; } spinning;

/* What they add to the rotation around the particles, eq. (3b). */
static void add_spins(const void *view, int64_t begin, int64_t end)
{
    const spinning *q = view;
    const tobi_system *s = q->s;
    SPH_FOR_NEAR_PARTICLES(s, k, i, e) {
        const double at = reach(s, e), *n = e->foot_normal;
        const double b = 0.5*q->v->viscous.lack[i].z*e->drag*at;
        const float *w = &q->v->viscous.operand[i].x;
        double slip[3], wall[3], pulled[3];
        float turn[3];
        find_wall(s, e, q->moving, slip, wall);
        for (int c = 0; c < 3; c++) slip[c] -= w[c];
        vec3_cross(pulled, n, slip);
        for (int c = 0; c < 3; c++)
            turn[c] = (float)(b*(at*(wall[c] - vec3_dot(wall, n)*n[c]) - pulled[c]));
        const tobi_float4 more = sph_viscous_turned(q->v, i, (tobi_float4){turn[0], turn[1], turn[2], 0});
        tobi_float4 *spin = &q->v->accel[i];
        spin->x += more.x; spin->y += more.y; spin->z += more.z;
    }
}

static void add_rows(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_fields *f = sph_fields_of(&s->particles);
    SPH_FOR_NEAR_PARTICLES(s, k, i, e) {
        const tobi_fluid *liquid = &s->fluid[s->particles.fluid[i]];
        float *r = &f->viscous_residual[i].x, *inverse = &f->viscous_inverse[i].x;
        double add[3];
        const double rate = (1 + 0.5*f->viscous_lack[i].z)*viscosity_at(s, i)*e->drag;
        entry_friction(s, i, e, f->viscous_velocity[i], f->accel[i], 1, add, NULL);
        for (int c = 0; c < 3 && inverse[c] > 0; c++) {
            const double n = e->foot_normal[c];
            r[c] += (float)(s->dt*liquid->density*add[c]);
            inverse[c] = (float)(1/(1/inverse[c] + s->dt*rate*(1 - n*n)));
        }
    }
}

static void add_product(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_fields *f = sph_fields_of(&s->particles);
    SPH_FOR_NEAR_PARTICLES(s, k, i, e) {
        const double scale = s->dt*s->fluid[s->particles.fluid[i]].density;
        float *product = &f->viscous_product[i].x;
        double add[3];
        entry_friction(s, i, e, f->viscous_direction[i], f->accel[i], 0, add, NULL);
        for (int c = 0; c < 3 && f->viscous_inverse[i].x > 0; c++) product[c] -= (float)(scale*add[c]);
    }
}

static void keep_friction(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_fields *f = sph_fields_of(&s->particles);
    SPH_FOR_NEAR_PARTICLES(s, k, i, e) {
        tobi_boundary_entry *own = (tobi_boundary_entry *)e;
        if (f->viscous_inverse[i].x > 0)
            entry_friction(s, i, e, f->viscous_velocity[i], f->accel[i], 1, own->friction, own->couple);
    }
}

/* Over the entries of one body: what friction takes from it in the step, impulse and angular impulse. w:
   velocities of the particles; NULL: all rest, and nothing turns around them. */
typedef struct friction { const tobi_system *s; const tobi_float4 *w; int moving; } friction;

static void sum_friction(const void *view, int64_t begin, int64_t end, double *t)
{
    const friction *q = view;
    const tobi_system *s = q->s;
    const tobi_boundary_links *n = &sph_of(s)->links;
    const sph_fields *f = sph_fields_of(&s->particles);
    const tobi_body *b = &s->sim->bodies[n->link[begin].body];
    const tobi_float4 none = {0, 0, 0, 0};
    if (!moves(s, n->link[begin].body)) return;
    for (int64_t k = begin; k < end; k++) {
        const int64_t i = n->link[k].particle;
        const double scale = s->dt*s->fluid[s->particles.fluid[i]].density;
        double force[3], couple[3], place[3], arm[3], torque[3];
        if (!(f->viscous_inverse[i].x > 0)) continue;
        entry_friction(s, i, &n->entry[k], q->w ? q->w[i] : none, q->w ? f->accel[i] : none, q->moving, force,
                       couple);
        find_place(&n->entry[k], place);
        for (int a = 0; a < 3; a++) arm[a] = place[a] + b->lower[a] - b->centre[a];
        vec3_cross(torque, arm, force);
        for (int a = 0; a < 3; a++) {
            t[a] += scale*force[a];
            t[3 + a] += scale*(torque[a] - couple[a]);
        }
    }
}

/* Into links.total of each body. */
static void sum(tobi_system *s, const tobi_float4 *w, int moving)
{
    const friction q = {s, w, moving};
    tobi_boundary_sum(s, TOBI_HOST(sum_friction, 6, 0), &q, 1);
}

static void show_velocities(const tobi_system *s)
{
    const tobi_boundary_links *n = &sph_of(s)->links;
    for (int k = 0; k < s->sim->body_count; k++)
        for (int a = 0; a < 6; a++) n->answer[k][a] = n->viscous[k].expected[a] + n->viscous[k].change[a];
}

void sph_viscous_bodies_begin(tobi_system *s)
{
    const tobi_boundary_links *n = &sph_of(s)->links;
    for (int k = 0; k < s->sim->body_count; k++) {
        const tobi_body_info *last = &s->sim->bodies[k].info;
        double f[6];
        memcpy(f, last->pressure_force, sizeof last->pressure_force);
        memcpy(f + 3, last->pressure_torque, sizeof last->pressure_torque);
        tobi_couple_predict(s, k, f);
    }
    tobi_couple_join(s);
    tobi_couple_obey(s, 1);
    for (int k = 0; k < s->sim->body_count; k++) {
        n->viscous[k] = (sph_viscous_body){ .drag = {{0}} };
        memcpy(n->viscous[k].expected, n->answer[k], sizeof n->viscous[k].expected);
    }
}

void sph_viscous_bodies_rest(tobi_system *s)
{
    const tobi_boundary_links *n = &sph_of(s)->links;
    for (int k = 0; k < s->sim->body_count; k++) n->viscous[k] = (sph_viscous_body){ .drag = {{0}} };
}

/* W r, eq. (5), into links.answer of each body. */
static void answer_alone(tobi_system *s, int body, const double r[6])
{
    double impulse[6];
    for (int a = 0; a < 6; a++) impulse[a] = s->smoothing.volume*r[a];
    tobi_couple_answer(s, body, impulse);
}

static void find_drag(tobi_system *s)
{
    const tobi_boundary_links *n = &sph_of(s)->links;
    for (int j = 0; j < 6; j++) {
        for (int k = 0; k < s->sim->body_count; k++)
            for (int a = 0; a < 6; a++) n->answer[k][a] = a == j;
        sum(s, NULL, 0);
        for (int k = 0; k < s->sim->body_count; k++)
            for (int a = 0; a < 6; a++) n->viscous[k].drag[a][j] = n->total[k][a];
    }
}

static void find_factors(tobi_system *s)
{
    const tobi_boundary_links *n = &sph_of(s)->links;
    for (int k = 0; k < s->sim->body_count; k++) {
        sph_viscous_body *b = &n->viscous[k];
        double x[6][6];
        for (int j = 0; j < 6; j++) {
            double column[6];
            for (int i = 0; i < 6; i++) column[i] = b->drag[i][j];
            answer_alone(s, k, column);
            for (int i = 0; i < 6; i++) x[i][j] = n->answer[k][i] + (i == j);
        }
        matrix6_invert(x, b->factor);
    }
}

void sph_viscous_bodies_spin(tobi_system *s, const sph_view *v, int moving)
{
    const tobi_boundary_links *n = &sph_of(s)->links;
    const spinning q = {s, v, moving};
    if (s->sim->body_count == 0) return;
    for (int k = 0; k < s->sim->body_count && !moving; k++)
        memcpy(n->answer[k], n->viscous[k].direction, sizeof n->answer[k]);
    if (moving) show_velocities(s);
    tobi_loop(s->sim->exec.threads, n->count, 0, add_spins, &q);
}

void sph_viscous_bodies_residual(tobi_system *s, int first)
{
    const tobi_boundary_links *n = &sph_of(s)->links;
    if (s->sim->body_count == 0) return;
    tobi_boundary_visit_entries(s, add_rows);
    if (!tobi_couple_any(s)) return;
    sum(s, sph_fields_of(&s->particles)->viscous_velocity, 1);
    for (int k = 0; k < s->sim->body_count; k++)
        for (int a = 0; a < 6; a++) n->viscous[k].residual[a] = -n->viscous[k].impulse[a] - n->total[k][a];
    if (!first) return;
    find_drag(s);
    find_factors(s);
}

/* Bodies alone: P = (W^-1 + S)^-1 = (1 + W S)^-1 W, and W^-1 P r = r - S P r. Joined ones: P = W, which
   joints make singular; so impulses are kept beside velocities. */
void sph_viscous_bodies_measure(tobi_system *s, double *rz, double *square)
{
    const tobi_boundary_links *n = &sph_of(s)->links;
    if (!tobi_couple_any(s)) return;
    for (int k = 0; k < s->sim->body_count; k++) answer_alone(s, k, n->viscous[k].residual);
    tobi_couple_obey(s, 0);
    for (int k = 0; k < s->sim->body_count; k++) {
        sph_viscous_body *b = &n->viscous[k];
        *square += dot6(b->residual, n->answer[k])/s->fluid[0].density;
        memcpy(b->z, n->answer[k], sizeof b->z);
        memcpy(b->z_impulse, b->residual, sizeof b->z_impulse);
        if (tobi_constraints_slot(&s->sim->constraints, k) < 0) {
            double braked[6];
            matrix6_multiply((const double (*)[6])b->factor, b->z);
            memcpy(braked, b->z, sizeof braked);
            matrix6_multiply((const double (*)[6])b->drag, braked);
            for (int a = 0; a < 6; a++) b->z_impulse[a] -= braked[a];
        }
        *rz += dot6(b->residual, b->z);
    }
}

void sph_viscous_bodies_turn(tobi_system *s, double beta)
{
    for (int k = 0; k < s->sim->body_count; k++) {
        sph_viscous_body *b = &sph_of(s)->links.viscous[k];
        for (int a = 0; a < 6; a++) {
            b->direction[a] = b->z[a] + beta*b->direction[a];
            b->direction_impulse[a] = b->z_impulse[a] + beta*b->direction_impulse[a];
        }
    }
}

double sph_viscous_bodies_apply(tobi_system *s)
{
    const tobi_boundary_links *n = &sph_of(s)->links;
    double curve = 0;
    if (s->sim->body_count == 0) return 0;
    tobi_boundary_visit_entries(s, add_product);
    if (!tobi_couple_any(s)) return 0;
    sum(s, sph_fields_of(&s->particles)->viscous_direction, 0);
    for (int k = 0; k < s->sim->body_count; k++) {
        sph_viscous_body *b = &n->viscous[k];
        for (int a = 0; a < 6; a++) b->product[a] = b->direction_impulse[a] + n->total[k][a];
        curve += dot6(b->direction, b->product);
    }
    return curve;
}

void sph_viscous_bodies_advance(tobi_system *s, double alpha)
{
    for (int k = 0; k < s->sim->body_count; k++) {
        sph_viscous_body *b = &sph_of(s)->links.viscous[k];
        for (int a = 0; a < 6; a++) {
            b->change[a] += alpha*b->direction[a];
            b->impulse[a] += alpha*b->direction_impulse[a];
            b->residual[a] -= alpha*b->product[a];
        }
    }
}

void sph_viscous_bodies_keep(tobi_system *s)
{
    if (s->sim->body_count == 0) return;
    show_velocities(s);
    tobi_boundary_visit_entries(s, keep_friction);
}
