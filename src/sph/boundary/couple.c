/* Bodies that move by forces are unknowns of the liquid's pressure: their answer to it is part of its
   operator, so that a body lighter than the water it displaces is stable. Drawback: contact between bodies
   is known a step late. */
#include "sph/boundary/boundary.h"
#include "core/joint_known.h"
#include "sph/hydrostatic.h"
#include "sph/kernels.h"
#include "sph/porous_carry.h"
#include "sph/state.h"
#include "geom/vec3.h"
#include <math.h>
#include <string.h>

static int moves(const tobi_body *b) { return b->rigid.kind != TOBI_PRESCRIBED; }

int tobi_couple_any(const tobi_system *s)
{
    for (int k = 0; k < s->sim->body_count; k++)
        if (moves(&s->sim->bodies[k])) return 1;
    return 0;
}

/* The same of a body with a joint: by what acts on its one coordinate. */
static void predict_joint(const tobi_system *s, tobi_rigid *r, const double f[6])
{
    const double keep = tobi_rigid_keep(r, s->dt);
    double load[6], change[6];
    for (int a = 0; a < 3; a++) {
        load[a] = r->mass*s->sim->def.gravity[a] + r->force[a];
        load[3 + a] = r->torque[a];
    }
    for (int a = 0; a < 6; a++) load[a] += r->inertial[a] + r->held[a] + f[a];
    tobi_joint_add_spring(r, load);
    tobi_joint_freedom(r, r->joint_mobility);
    memset(r->mobility, 0, sizeof r->mobility);
    memset(r->turn_mobility, 0, sizeof r->turn_mobility);
    tobi_rigid_answer(r, load, change);
    for (int a = 0; a < 3; a++) {
        r->predicted[a] = keep*(r->velocity[a] + s->dt*change[a]);
        r->predicted_spin[a] = keep*(r->angular_velocity[a] + s->dt*change[3 + a]);
    }
    for (int a = 0; a < 6; a++) r->joint_mobility[a] *= sqrt(keep);
}

/* Velocities at the end of the step, by force and torque f of the particles: (R.5) without control, and with
   what contact has held for two steps; the rest of contact the next step knows from its first velocities. */
static void predict(const tobi_system *s, tobi_body *b, const double known[6])
{
    tobi_rigid *r = &b->rigid;
    double shift[3], turn[3][3], momentum[3], f[6], keep = tobi_rigid_keep(r, s->dt);
    for (int a = 0; a < 6; a++) f[a] = known[a] + r->finer[a];
    tobi_motors_add_guess(&s->sim->constraints, (int)(b - s->sim->bodies), f);
    tobi_constraints_add_known(&s->sim->constraints, s->sim->bodies, (int)(b - s->sim->bodies), f);
    if (r->joint.kind) {
        predict_joint(s, r, f);
        return;
    }
    tobi_rigid_inverse(r, shift, turn);
    for (int a = 0; a < 3; a++) {
        double force = r->mass*s->sim->def.gravity[a] + r->force[a] + r->inertial[a] + r->held[a] + f[a];
        r->predicted[a] = keep*(r->velocity[a] + s->dt*shift[a]*force);
        momentum[a] = keep*(r->momentum[a] + s->dt*(r->torque[a] + r->inertial[3 + a] + r->held[3 + a] +
                                                    f[3 + a]));
        r->mobility[a] = keep*shift[a];
        for (int c = 0; c < 3; c++) r->turn_mobility[a][c] = keep*turn[a][c];
    }
    for (int a = 0; a < 3; a++) r->predicted_spin[a] = vec3_dot(turn[a], momentum);
}

void tobi_couple_predict(tobi_system *s, int k, const double f[6])
{
    tobi_body *b = &s->sim->bodies[k];
    double *answer = sph_of(s)->links.answer[k];
    memset(answer, 0, 6*sizeof *answer);
    if (!moves(b)) return;
    predict(s, b, f);
    vec3_sub(answer, b->rigid.predicted, b->rigid.velocity);
    vec3_sub(answer + 3, b->rigid.predicted_spin, b->rigid.angular_velocity);
}

void tobi_couple_answer(tobi_system *s, int k, const double f[6])
{
    const tobi_rigid *r = &s->sim->bodies[k].rigid;
    double *answer = sph_of(s)->links.answer[k];
    memset(answer, 0, 6*sizeof *answer);
    if (moves(&s->sim->bodies[k])) tobi_rigid_answer(r, f, answer);
}

void tobi_couple_join(tobi_system *s)
{
    tobi_constraints *c = &s->sim->constraints;
    for (int k = 0; k < c->slots; k++)
        for (int j = 0; j < 6; j++) {
            double force[6] = { 0 }, moved[6];
            force[j] = 1;
            tobi_rigid_answer(&s->sim->bodies[c->body[k]].rigid, force, moved);
            sph_porous_soften(s, c->body[k], moved);
            for (int i = 0; i < 6; i++) c->inverse[k][i][j] = moved[i];
        }
    if (c->count) tobi_constraints_factor(c, s->sim->bodies);
}

void tobi_couple_obey(tobi_system *s, int moving)
{
    tobi_constraints *c = &s->sim->constraints;
    double now[6] = { 0 };
    if (c->count == 0) return;
    for (int step = 0; step < 2; step++) {
        for (int k = 0; k < c->slots; k++) {
            const tobi_rigid *r = &s->sim->bodies[c->body[k]].rigid;
            double *answer = sph_of(s)->links.answer[c->body[k]];
            for (int a = 0; a < 3 && moving; a++) {
                now[a] = r->velocity[a];
                now[3 + a] = r->angular_velocity[a];
            }
            for (int a = 0; a < 6; a++)
                if (step == 0) c->speed[k][a] = now[a] + answer[a];
                else answer[a] = c->speed[k][a] - now[a];
        }
        if (step == 0) tobi_constraints_project(c, moving);
    }
}

static tobi_couple_view see_entries(const tobi_system *s)
{
    const tobi_boundary_links *links = &sph_of(s)->links;
    const sph_fields *f = sph_fields_of(&s->particles);
    return (tobi_couple_view){ .link = links->link, .answer = (const double (*)[6])links->answer,
                               .last_link = f->last_link, .record = s->cells.record, .wall = f->wall,
                               .product = f->product };
}

/* The same for all smoothing kernels. */
static const sph_kernels *kernels_of(const tobi_system *s)
{
    return sph_kernels_for(s->sim->exec.isa, 0);
}

/* Into the answers, which are free until then. */
static void sum_known_forces(tobi_system *s)
{
    const tobi_boundary_links *n = &sph_of(s)->links;
    for (int viscous = 0; viscous < 2; viscous++) {
        tobi_boundary_known_forces(s, viscous);
        for (int k = 0; k < s->sim->body_count; k++)
            for (int a = 0; a < 6; a++) n->answer[k][a] = (viscous ? n->answer[k][a] : 0) + n->total[k][a];
    }
}

static void predict_in_zones(tobi_system *s, int k, double f[6])
{
    sph_porous_add_known(s, k, f);
    tobi_couple_predict(s, k, f);
    sph_porous_answer(s, k);
}

static void begin(tobi_system *s)
{
    const tobi_couple_view v = see_entries(s);
    sum_known_forces(s);
    for (int k = 0; k < s->sim->body_count; k++) {
        double f[6];
        memcpy(f, sph_of(s)->links.answer[k], sizeof f);
        if (moves(&s->sim->bodies[k])) sph_body_hydrostatic(s, k, f);
        predict_in_zones(s, k, f);
    }
    tobi_couple_join(s);
    tobi_couple_obey(s, 1);
    tobi_launch(&s->sim->exec, kernels_of(s)->couple_flux, &v, 0, s->particles.count, NULL);
}

void tobi_couple_begin(tobi_system *s)
{
    if (tobi_couple_any(s)) begin(s);
    sph_porous_join(s);
}

static void expect(tobi_system *s)
{
    double (*sum)[6] = sph_of(s)->links.answer;
    for (int viscous = 0; viscous < 2; viscous++) {
        tobi_boundary_forces(s, viscous);
        for (int k = 0; k < s->sim->body_count; k++)
            for (int a = 0; a < 6; a++) sum[k][a] = (viscous ? sum[k][a] : 0) + sph_of(s)->links.total[k][a];
    }
    for (int k = 0; k < s->sim->body_count; k++) {
        double f[6];
        memcpy(f, sum[k], sizeof f);
        if (moves(&s->sim->bodies[k])) sph_body_hydrostatic(s, k, f);
        predict_in_zones(s, k, f);
    }
    tobi_couple_join(s);
    tobi_couple_obey(s, 1);
}

void tobi_couple_expect(tobi_system *s)
{
    if (!sph_of(s)->zones_answer) return;
    if (tobi_couple_any(s)) expect(s);
    sph_porous_join(s);
}

typedef struct pressing { const tobi_system *s; tobi_kernel kernel; const tobi_couple_view *view; } pressing;

/* Of bodies that move alone, and of one at a time. */
static void sum_pressure(const void *view, int64_t begin, int64_t end, double *t)
{
    const pressing *p = view;
    if (moves(&p->s->sim->bodies[p->view->link[begin].body])) p->kernel.run(p->view, begin, end, t);
}

void tobi_couple_press(tobi_system *s)
{
    const tobi_boundary_links *n = &sph_of(s)->links;
    const tobi_couple_view v = see_entries(s);
    const pressing p = {s, kernels_of(s)->couple_pressure, &v};
    double t[TOBI_TOTALS];
    if (!tobi_couple_any(s)) return;
    tobi_boundary_sum(s, TOBI_HOST(sum_pressure, p.kernel.sums, p.kernel.maxima), &p, 1);
    for (int k = 0; k < s->sim->body_count; k++) {
        memcpy(t, n->total[k], sizeof t);
        for (int a = 0; a < TOBI_SUMS; a++) t[a] *= 2*s->smoothing.volume;
        sph_porous_sum_accelerations(s, k, t);
        tobi_couple_answer(s, k, t);
        sph_porous_soften(s, k, n->answer[k]);
    }
    tobi_couple_obey(s, 0);
    sph_porous_spread_accelerations(s);
}

void tobi_couple_product(tobi_system *s, double *totals)
{
    const tobi_couple_view v = see_entries(s);
    double t[TOBI_TOTALS];
    if (!tobi_couple_any(s)) return;
    tobi_launch(&s->sim->exec, kernels_of(s)->couple_product, &v, 0, s->particles.count, t);
    if (!totals) return;
    totals[0] += t[0];
    totals[1] += t[1];
}

static void collect_forces(const tobi_system *s, const tobi_body *b, double f[6])
{
    const tobi_body_load *load = &b->load[s->number];
    for (int a = 0; a < 6; a++) f[a] = load->pressure[a] + load->friction[a];
}

/* Joined bodies, if particles see any of them. */
static void correct_joined(tobi_system *s)
{
    tobi_constraints *c = &s->sim->constraints;
    const int64_t *first = sph_of(s)->links.first;
    int seen = 0;
    for (int k = 0; k < c->slots; k++)
        seen |= first[c->body[k]] != first[c->body[k] + 1] || sph_porous_drags(s, c->body[k]);
    if (!seen) return;
    for (int k = 0; k < c->slots; k++) {
        tobi_body *b = &s->sim->bodies[c->body[k]];
        double f[6];
        collect_forces(s, b, f);
        predict(s, b, f);
        memcpy(c->speed[k], b->rigid.predicted, sizeof b->rigid.predicted);
        memcpy(c->speed[k] + 3, b->rigid.predicted_spin, sizeof b->rigid.predicted_spin);
    }
    tobi_couple_join(s);
    c->driven = 1;
    tobi_constraints_drive(c, s->sim->bodies, s->sim->dt);
    for (int k = 0; k < c->slots; k++)
        tobi_body_set_velocity(&s->sim->bodies[c->body[k]], c->speed[k], c->speed[k] + 3);
}

void tobi_couple_correct(tobi_system *s)
{
    const int64_t *first = sph_of(s)->links.first;
    correct_joined(s);
    for (int k = 0; k < s->sim->body_count; k++) {
        tobi_body *b = &s->sim->bodies[k];
        double f[6];
        if (!moves(b) || (first[k] == first[k + 1] && !sph_porous_drags(s, k))) continue;
        if (tobi_constraints_slot(&s->sim->constraints, k) >= 0) continue;
        collect_forces(s, b, f);
        predict(s, b, f);
        tobi_body_correct(b, b->rigid.predicted, b->rigid.predicted_spin, s->dt);
        tobi_body_set_velocity(b, b->rigid.predicted, b->rigid.predicted_spin);
    }
}

void tobi_couple_finish(tobi_system *s)
{
    for (int k = 0; k < s->sim->body_count; k++) {
        tobi_body *b = &s->sim->bodies[k];
        double f[6];
        if (!moves(b)) continue;
        collect_forces(s, b, f);
        vec3_add_scaled(b->rigid.impulse, b->rigid.impulse, s->dt, f);
        vec3_add_scaled(b->rigid.twist, b->rigid.twist, s->dt, f + 3);
    }
}

/* The integral of (n, r x n) (n, r x n)^T over the whole surface, m2. */
static void sum_surface(const tobi_body *b, double sum[6][6])
{
    memset(sum, 0, 36*sizeof(double));
    for (int64_t k = 0; k < b->point_count; k++) {
        double arm[3], row[6];
        memcpy(row, b->normal[k], sizeof b->normal[k]);
        vec3_sub(arm, b->point[k], b->rigid.position);
        vec3_cross(row + 3, arm, b->normal[k]);
        for (int i = 0; i < 6; i++)
            for (int j = 0; j < 6; j++) sum[i][j] += b->area[k]*row[i]*row[j];
    }
}

/* The largest eigenvalue of a product of two positive matrices: the 32nd root of the trace of its 32nd power
   is that or up to 6 % more. */
static double largest_eigenvalue(double x[6][6])
{
    double root = 1;
    for (int k = 0;; k++) {
        double trace = 0, y[6][6] = {{0}};
        for (int i = 0; i < 6; i++) trace += x[i][i];
        if (!(trace > 0)) return 0;
        root *= pow(trace, 1.0/(1 << k));
        if (k == 5) return root;
        for (int i = 0; i < 6; i++)
            for (int j = 0; j < 6; j++)
                for (int l = 0; l < 6; l++) y[i][j] += x[i][l]*x[l][j]/(trace*trace);
        memcpy(x, y, sizeof y);
    }
}

/* Locked shifts count as free ones: how much of the surface lies across the others changes with the pose. */
double tobi_couple_compliance(const tobi_system *s)
{
    double most = 0;
    for (int k = 0; k < s->sim->body_count; k++) {
        const tobi_body *b = &s->sim->bodies[k];
        double sum[6][6], x[6][6] = {{0}}, shift[3], turn[3][3], joint[6];
        if (!moves(b)) continue;
        sum_surface(b, sum);
        tobi_rigid_inverse(&b->rigid, shift, turn);
        for (int a = 0; a < 3; a++)
            for (int j = 0; j < 6; j++) {
                x[a][j] = b->rigid.joint.kind ? 0 : sum[a][j]/b->rigid.mass;
                for (int c = 0; c < 3; c++) x[3 + a][j] += turn[a][c]*sum[3 + c][j];
            }
        tobi_joint_freedom(&b->rigid, joint);
        for (int i = 0; i < 6 && b->rigid.joint.kind; i++)
            for (int j = 0; j < 6; j++)
                for (int c = 0; c < 6; c++) x[i][j] += joint[i]*joint[c]*sum[c][j];
        most = fmax(most, largest_eigenvalue(x));
    }
    return most;
}

/* Explicit friction: the two layers of particles at a no-slip surface of area S brake a body at some
   4 mu S/(d m); its turns have a smaller inertia: three times that, as those of a ball. */
double tobi_couple_dt(const tobi_system *s)
{
    double viscosity = 0, dt = INFINITY;
    const int explicit = !s->sim->def.implicit_viscosity;
    for (int f = 0; f < s->fluid_count; f++) viscosity = fmax(viscosity, s->fluid[f].viscosity);
    for (int k = 0; k < s->sim->body_count && explicit; k++) {
        const tobi_body *b = &s->sim->bodies[k];
        if (!moves(b) || b->friction != TOBI_NO_SLIP || !(viscosity > 0)) continue;
        dt = fmin(dt, 0.8*b->rigid.mass*s->smoothing.spacing/(12*viscosity*b->rest.area));
    }
    return fmin(dt, sph_soft_dt(s));
}
