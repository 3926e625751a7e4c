/* Porous zones that bodies carry in the pressure equation of isph. Pressure pushes a body by sum z_i p_i over
   the particles in and beside its zones; its answer enters the rows by the same z, so that the matrix stays
   symmetric. Drawback: z comes from pairs, what the liquid loses from the gradient of the pressure; the
   difference is shared out after the solve. */
#include "sph/isph/carry.h"
#include "geom/matrix6.h"
#include "geom/vec3.h"
#include "sph/boundary/boundary.h"
#include "sph/isph/images.k.h"
#include "sph/porous.k.h"
#include "sph/porous_carry.h"
#include "sph/state.h"
#include <math.h>
#include <string.h>

static int acts(const tobi_system *s)
{
    if (!sph_of(s)->zones_answer) return 0;
    for (int k = 0; k < s->sim->body_count; k++)
        if (sph_porous_of(s, k)) return 1;
    return 0;
}

/* The zone of a particle, if a body carries it that moves by forces. */
static const tobi_porous *zone_of(const tobi_system *s, int64_t i)
{
    const float number = sph_fields_of(&s->particles)->porous_before[i].w;
    const tobi_porous *z = number > 0 ? &s->sim->porous[(int)number - 1] : NULL;
    return z && z->carrier && s->sim->bodies[z->carrier - 1].rigid.kind != TOBI_PRESCRIBED ? z : NULL;
}

typedef struct finding { const isph_solver *m; tobi_system *s; } finding;

/* The carrier whose zone a particle is in, or beside; 0: none. arm: m, from the carrier. */
static int find_carrier(const finding *q, int64_t i, double arm[3])
{
    const tobi_system *s = q->s;
    const tobi_porous *own = zone_of(s, i);
    int found = own ? own->carrier : 0;
    double least = q->m->view.h;
    if (own) sph_porous_arm(s, own, i, arm);
    for (int k = 0; k < s->sim->porous_count && !own; k++) {
        const tobi_porous *z = &s->sim->porous[k];
        double at[3], way[3];
        if (!z->carrier || s->sim->bodies[z->carrier - 1].rigid.kind == TOBI_PRESCRIBED) continue;
        sph_porous_arm(s, z, i, at);
        for (int a = 0; a < 3; a++) way[a] = at[a] - (z->pose.middle[a] - z->pose.centre[a]);
        const double off = vec3_length(way) - z->pose.reach;
        if (!(off < least)) continue;
        least = off;
        found = z->carrier;
        memcpy(arm, at, 3*sizeof *arm);
    }
    return found;
}

/* Half of N d of one particle of a pair, if that carrier has it. */
static void add_half(const tobi_system *s, int64_t i, int carrier, const float d[3], double inverse,
                     double out[3])
{
    const tobi_porous *z = zone_of(s, i);
    float part[3];
    if (!z || z->carrier != carrier) return;
    sph_porous_part(sph_fields_of(&s->particles)->porous[i], d, part);
    for (int a = 0; a < 3; a++) out[a] += 0.5*inverse*part[a];
}

/* What pair i, j adds: to z of i, and to the fall. */
static void add_pair(const finding *q, int64_t i, int32_t j, int carrier, const double arm[3], double z[6],
                     double fall[3])
{
    const isph_view *v = &q->m->view;
    const tobi_record *own = &v->record[i], *other = &v->record[j];
    const int32_t *x = &own->x, *y = &other->x;
    float d[3], g[3];
    double r2 = 0, taken[3] = { 0 }, middle[3], twist[3];
    for (int a = 0; a < 3; a++) {
        d[a] = (float)(int32_t)((uint32_t)x[a] - (uint32_t)y[a])*v->from_fixed[a];
        r2 += (double)d[a]*d[a];
    }
    if (j == i || !(r2 > 0 && r2 < v->h*v->h)) return;
    const float r = (float)sqrt(r2);
    const double f = lane_at(smoothing_falloff(v->shape, lane_set(r*v->inverse_h), lane_set(r)), 0),
                 k = v->volume*v->slope*f*(v->own_scale ? 2*v->scale[i] : v->scale[i] + v->scale[j]),
                 both = (double)sph_porous_drag(v->porous[i]) + sph_porous_drag(v->porous[j]),
                 inverse = 1/(1 + 0.5*both), density = v->phase ? v->phase[i].x : v->density;
    add_half(q->s, i, carrier, d, inverse, taken);
    add_half(q->s, j, carrier, d, inverse, taken);
    for (int a = 0; a < 3; a++) middle[a] = arm[a] - 0.5*d[a];
    vec3_cross(twist, middle, taken);
    isph_gravity_at(v, i, g);
    const double still = density*((double)g[0]*d[0] + (double)g[1]*d[1] + (double)g[2]*d[2]);
    for (int a = 0; a < 3; a++) {
        z[a] -= k*taken[a];
        z[3 + a] -= k*twist[a];
        fall[a] += 0.5*k*still*taken[a];
    }
}

static void find_range(const void *view, int64_t begin, int64_t end, double *totals)
{
    const finding *q = view;
    const isph_view *v = &q->m->view;
    const sph_fields *f = sph_fields_of(&q->s->particles);
    (void)totals;
    for (int64_t i = begin; i < end; i++) {
        double arm[3], z[6] = { 0 }, fall[3] = { 0 };
        const int carrier = find_carrier(q, i, arm);
        const int64_t first = 8*(int64_t)v->list_start[i];
        for (int k = 0; k < 8*v->list_groups[i] && carrier; k++)
            add_pair(q, i, tobi_list_at(v->list, v->list_far, i, first + k), carrier, arm, z, fall);
        f->zone_push[i] = (tobi_float4){ (float)z[0], (float)z[1], (float)z[2], (float)carrier };
        f->zone_turn[i] = (tobi_float4){ (float)z[3], (float)z[4], (float)z[5], 0 };
        f->zone_fall[i] = (tobi_float4){ (float)fall[0], (float)fall[1], (float)fall[2], 0 };
    }
}

void isph_carry_find(isph_solver *m, tobi_system *s)
{
    const finding q = { m, s };
    if (acts(s)) tobi_launch(m->exec, TOBI_HOST(find_range, 0, 0), &q, 0, s->particles.count, NULL);
}

/* --- sums ------------------------------------------------------------------------------------------ */

typedef struct summing {
    finding q;
    int carrier;
    const double *pressure;          /* NULL: the fall                                              */
    double mobility[6][6];           /* of the trace                                                */
    int trace;
} summing;

static void get_push(const sph_fields *f, int64_t i, double z[6])
{
    for (int a = 0; a < 3; a++) {
        z[a] = (&f->zone_push[i].x)[a];
        z[3 + a] = (&f->zone_turn[i].x)[a];
    }
}

static double find_trace(const summing *u, int64_t i, const double z[6])
{
    const isph_view *v = &u->q.m->view;
    double moved[6], sum = 0;
    memcpy(moved, z, sizeof moved);
    matrix6_multiply((const double (*)[6])u->mobility, moved);
    for (int a = 0; a < 6; a++) sum += v->density/v->volume*v->inverse_diagonal[i]*z[a]*moved[a];
    return sum;
}

static void sum_range(const void *view, int64_t begin, int64_t end, double *totals)
{
    const summing *u = view;
    const sph_fields *f = sph_fields_of(&u->q.s->particles);
    for (int64_t i = begin; i < end; i++) {
        double z[6], arm[3], twist[3], fall[3];
        if ((int)f->zone_push[i].w != u->carrier) continue;
        get_push(f, i, z);
        if (u->trace) totals[0] += find_trace(u, i, z);
        for (int a = 0; a < 6 && u->pressure && !u->trace; a++) totals[a] += z[a]*u->pressure[i];
        if (u->pressure || u->trace) continue;
        find_carrier(&u->q, i, arm);
        for (int a = 0; a < 3; a++) fall[a] = (&f->zone_fall[i].x)[a];
        vec3_cross(twist, arm, fall);
        for (int a = 0; a < 3; a++) {
            totals[a] += fall[a];
            totals[3 + a] += twist[a];
        }
    }
}

static void sum(const summing *u, double f[6])
{
    const tobi_system *s = u->q.s;
    double t[TOBI_TOTALS];
    tobi_launch(u->q.m->exec, TOBI_HOST(sum_range, 6, 0), u, 0, s->particles.count, t);
    for (int a = 0; a < 6; a++)
        if (s->box.dimension == 3 || a < 2 || a == 5) f[a] += t[a];
}

void isph_carry_press(const isph_solver *m, tobi_system *s, int body, const double *pressure, double f[6])
{
    const summing u = { { m, s }, body + 1, pressure, { { 0 } }, 0 };
    if (sph_porous_of(s, body)) sum(&u, f);
}

void isph_carry_add_known(const isph_solver *m, tobi_system *s, int body, double f[6])
{
    const tobi_porous *z = sph_porous_of(s, body);
    const summing u = { { m, s }, body + 1, NULL, { { 0 } }, 0 };
    double moved[6];
    if (!z) return;
    sum(&u, f);
    memcpy(moved, s->sim->bodies[body].rigid.before, sizeof moved);
    matrix6_multiply((const double (*)[6])z->answer.drag, moved);
    for (int a = 0; a < 6; a++) f[a] += (z->answer.known[a] - moved[a])/s->dt;
}

double isph_carry_trace(const isph_solver *m, tobi_system *s, int body)
{
    summing u = { { m, s }, body + 1, NULL, { { 0 } }, 1 };
    double t[6] = { 0 };
    if (!sph_porous_of(s, body)) return 0;
    memcpy(u.mobility, m->body[body].mobility, sizeof u.mobility);
    sum(&u, t);
    return t[0];
}

/* --- what the liquid gets --------------------------------------------------------------------------- */

typedef struct spreading { const isph_solver *m; tobi_system *s; double *rows, share; } spreading;

static void spread_range(const void *view, int64_t begin, int64_t end)
{
    const spreading *u = view;
    const isph_view *v = &u->m->view;
    const sph_fields *f = sph_fields_of(&u->s->particles);
    for (int64_t i = begin; i < end; i++) {
        const int carrier = (int)f->zone_push[i].w;
        double z[6], gained = 0;
        if (!carrier || (v->held && v->held[i].w != 0)) continue;
        get_push(f, i, z);
        for (int a = 0; a < 6; a++) gained += z[a]*sph_of(u->s)->links.answer[carrier - 1][a];
        u->rows[i] += v->density/v->volume*gained;
    }
}

void isph_carry_spread(const isph_solver *m, tobi_system *s, double *rows)
{
    const spreading u = { m, s, rows, 0 };
    if (acts(s)) tobi_loop(m->exec->threads, s->particles.count, 0, spread_range, &u);
}

static void move_range(const void *view, int64_t begin, int64_t end)
{
    const spreading *u = view;
    const tobi_system *s = u->s;
    for (int64_t i = begin; i < end; i++) {
        const tobi_porous *z = zone_of(s, i);
        if (z) sph_porous_gain(s, z, i, sph_of(s)->links.answer[z->carrier - 1], u->share);
    }
}

void isph_carry_move(tobi_system *s, double share)
{
    const spreading u = { NULL, s, NULL, share };
    if (acts(s)) tobi_loop(s->sim->exec.threads, s->particles.count, 0, move_range, &u);
}

/* What differs from eq. (8), as a change of the body, into its answer. */
static void find_rest(const isph_solver *m, tobi_system *s, int body)
{
    const tobi_rigid *r = &s->sim->bodies[body].rigid;
    const tobi_porous *z = sph_porous_of(s, body);
    double f[6], fall[6] = { 0 }, *answer = sph_of(s)->links.answer[body], speed[6];
    memcpy(speed, r->velocity, sizeof r->velocity);
    memcpy(speed + 3, r->angular_velocity, sizeof r->angular_velocity);
    for (int a = 0; a < 6; a++) speed[a] += m->body[body].explicit_change[a] + s->dt*answer[a];
    matrix6_multiply((const double (*)[6])z->answer.drag, speed);
    isph_carry_press(m, s, body, m->view.solution, fall);
    const summing u = { { m, s }, body + 1, NULL, { { 0 } }, 0 };
    sum(&u, fall);
    sph_porous_lost(s, body, f);
    for (int a = 0; a < 6; a++) f[a] -= z->answer.known[a] - speed[a] + s->dt*fall[a];
    sph_porous_factor(s, body);
    tobi_couple_answer(s, body, f);
    sph_porous_soften(s, body, answer);
}

void isph_carry_settle(const isph_solver *m, tobi_system *s)
{
    double (*answer)[6] = sph_of(s)->links.answer;
    double kept[TOBI_POROUS_LIMIT][6];
    if (!acts(s)) return;
    for (int k = 0, n = 0; k < s->sim->body_count; k++) {
        const int carries = sph_porous_of(s, k) != NULL;
        if (carries) memcpy(kept[n++], answer[k], sizeof kept[0]);
        if (carries) find_rest(m, s, k);
    }
    isph_carry_move(s, 1);
    for (int k = 0, n = 0; k < s->sim->body_count; k++)
        if (sph_porous_of(s, k)) memcpy(answer[k], kept[n++], sizeof kept[0]);
}
