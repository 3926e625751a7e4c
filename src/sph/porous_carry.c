/* The drag of porous zones that bodies carry: what it makes of the bodies, and what they make of the liquid.
   Drawback: each sum over the particles of a body's zones walks over all particles. */
#include "sph/porous_carry.h"
#include "geom/matrix6.h"
#include "geom/vec3.h"
#include "sph/boundary/boundary.h"
#include "sph/porous.k.h"
#include "sph/state.h"
#include <math.h>
#include <string.h>

int sph_porous_carried(const tobi_system *s)
{
    for (int k = 0; k < s->sim->porous_count; k++)
        if (s->sim->porous[k].carrier) return 1;
    return 0;
}

void sph_porous_arm(const tobi_system *s, const tobi_porous *z, int64_t i, double arm[3])
{
    const tobi_double3 at = s->particles.position[i];
    const double x[3] = { at.x, at.y, at.z };
    double size[3];
    for (int a = 0; a < 3; a++) size[a] = s->box.periodic[a] ? s->box.size[a] : 0;
    tobi_porous_arm(z, x, size, arm);
}

void sph_porous_carry(const double u[6], const double arm[3], double out[3])
{
    vec3_cross(out, u + 3, arm);
    for (int a = 0; a < 3; a++) out[a] += u[a];
}

void sph_porous_drag_by(tobi_float4 d, const double x[3], double out[3])
{
    const float in[3] = { (float)x[0], (float)x[1], (float)x[2] };
    float part[3];
    sph_porous_part(d, in, part);
    for (int a = 0; a < 3; a++) out[a] = (double)part[a]/(1 + (double)sph_porous_drag(d));
}

/* The zone of a particle, if a body carries it. */
static const tobi_porous *find_carried(const tobi_system *s, int64_t i)
{
    const float number = sph_fields_of(&s->particles)->porous_before[i].w;
    if (!(number > 0)) return NULL;
    const tobi_porous *z = &s->sim->porous[(int)number - 1];
    return z->carrier ? z : NULL;
}

int sph_porous_nearest(const tobi_system *s, int64_t i)
{
    const int own = (int)sph_fields_of(&s->particles)->porous_before[i].w;
    double least = INFINITY;
    int found = own - 1;
    for (int k = 0; k < s->sim->porous_count && own == 0; k++) {
        const tobi_porous *z = &s->sim->porous[k];
        double square = 0, x[3], arm[3];
        memcpy(x, &s->particles.position[i].x, sizeof x);
        if (z->carrier) sph_porous_arm(s, z, i, arm);
        if (z->carrier) tobi_porous_recall(z, arm, x);
        for (int a = 0; a < s->box.dimension; a++) {
            const double off = fmax(fmax(z->lower[a] - x[a], x[a] - z->upper[a]), 0);
            square += off*off;
        }
        if (square < least) least = square, found = k;
    }
    return found;
}

/* In isph pairs share the drag, and zones take from particles beside them. */
static const tobi_porous *find_taker(const tobi_system *s, int64_t i)
{
    const float *taken = &sph_fields_of(&s->particles)->porous_taken[i].x;
    const float own = sph_fields_of(&s->particles)->porous_before[i].w;
    if (own != 0 || !sph_of(s)->mirrors) return find_carried(s, i);
    if (taken[0] == 0 && taken[1] == 0 && taken[2] == 0) return NULL;
    const tobi_porous *z = &s->sim->porous[sph_porous_nearest(s, i)];
    return z->carrier ? z : NULL;
}

static double mass_of(const tobi_system *s, int64_t i)
{
    return s->smoothing.volume*s->fluid[s->particles.fluid[i]].density;
}

static void add_load(const double arm[3], double mass, const double x[3], double t[6])
{
    double twist[3];
    vec3_cross(twist, arm, x);
    for (int a = 0; a < 3; a++) {
        t[a] += mass*x[a];
        t[3 + a] += mass*twist[a];
    }
}

/* --- sums over the zones of a body --------------------------------------------------------------- */

/* What of the liquid counts: what the brake has taken, what it has lost in all, a column of S, or its
   accelerations by pressure. */
typedef struct counting {
    const tobi_system *s;
    int carrier;
    enum { BRAKED, LOST, COLUMN, PRESSED } what;
    double column[6];
} counting;

static void count_range(const void *view, int64_t begin, int64_t end, double *totals)
{
    const counting *c = view;
    const tobi_system *s = c->s;
    const sph_fields *f = sph_fields_of(&s->particles);
    for (int64_t i = begin; i < end; i++) {
        const tobi_porous *z = c->what == LOST ? find_taker(s, i) : find_carried(s, i);
        double arm[3], x[3], lost[3];
        if (!z || z->carrier != c->carrier) continue;
        sph_porous_arm(s, z, i, arm);
        if (c->what == LOST || c->what == BRAKED)
            for (int a = 0; a < 3; a++) lost[a] = (&f->porous_taken[i].x)[a];
        else if (c->what == COLUMN) {
            sph_porous_carry(c->column, arm, x);
            sph_porous_drag_by(f->porous[i], x, lost);
        } else {                                     /* N a of M a: c P of it */
            const float by[3] = { f->accel[i].x, f->accel[i].y, f->accel[i].z };
            float part[3];
            sph_porous_part(f->porous[i], by, part);
            for (int a = 0; a < 3; a++) lost[a] = part[a];
        }
        add_load(arm, mass_of(s, i), lost, totals);
    }
}

static void count(tobi_system *s, counting c, double out[6])
{
    double t[TOBI_TOTALS];
    tobi_launch(&s->sim->exec, TOBI_HOST(count_range, 6, 0), &c, 0, s->particles.count, t);
    memcpy(out, t, 6*sizeof *out);
    if (s->box.dimension == 2)
        for (int a = 2; a < 5; a++) out[a] = 0;
}

void sph_porous_know(tobi_system *s)
{
    sph_of(s)->zones_answer = sph_porous_carried(s);
    for (int k = 0; k < s->sim->porous_count; k++) {
        tobi_porous *z = &s->sim->porous[k];
        tobi_porous_answer *n = &z->answer;
        if (!n->leads) continue;
        memset(n->drag, 0, sizeof n->drag);
        if (s->sim->bodies[z->carrier - 1].rigid.kind == TOBI_PRESCRIBED) continue;
        count(s, (counting){ s, z->carrier, BRAKED, { 0 } }, n->known);
        for (int j = 0; j < 6; j++) {
            counting c = { s, z->carrier, COLUMN, { 0 } };
            double column[6];
            if (s->box.dimension == 2 && j >= 2 && j < 5) continue;
            c.column[j] = 1;
            count(s, c, column);
            for (int i = 0; i < 6; i++) n->drag[i][j] = column[i];
        }
        for (int i = 0; i < 6; i++)                  /* symmetric but for rounding */
            for (int j = 0; j < i; j++) n->drag[i][j] = n->drag[j][i] = 0.5*(n->drag[i][j] + n->drag[j][i]);
    }
}

/* --- the answer of bodies -------------------------------------------------------------------------- */

static tobi_porous *find_lead(const tobi_system *s, int body)
{
    for (int k = 0; k < s->sim->porous_count; k++) {
        tobi_porous *z = &s->sim->porous[k];
        if (z->answer.leads && z->carrier == body + 1) return z;
    }
    return NULL;
}

tobi_porous *sph_porous_of(const tobi_system *s, int body)
{
    if (!sph_of(s)->zones_answer || s->sim->bodies[body].rigid.kind == TOBI_PRESCRIBED) return NULL;
    return find_lead(s, body);
}

int sph_porous_drags(const tobi_system *s, int body)
{
    const tobi_porous *z = find_lead(s, body);
    double most = 0;
    for (int a = 0; a < 6 && z; a++) most = fmax(most, z->answer.drag[a][a]);
    return most > 0;
}

void sph_porous_add_known(const tobi_system *s, int body, double f[6])
{
    const tobi_porous *z = sph_porous_of(s, body);
    for (int a = 0; a < 6 && z; a++) f[a] += z->answer.known[a]/s->dt;
}

void sph_porous_soften(const tobi_system *s, int body, double change[6])
{
    const tobi_porous *z = sph_porous_of(s, body);
    if (z) matrix6_multiply((const double (*)[6])z->answer.factor, change);
}

void sph_porous_factor(tobi_system *s, int body)
{
    const tobi_rigid *r = &s->sim->bodies[body].rigid;
    tobi_porous *z = sph_porous_of(s, body);
    double x[6][6];
    if (!z) return;
    for (int j = 0; j < 6; j++) {
        double column[6], moved[6];
        for (int i = 0; i < 6; i++) column[i] = z->answer.drag[i][j];
        tobi_rigid_answer(r, column, moved);
        for (int i = 0; i < 6; i++) x[i][j] = moved[i] + (i == j);
    }
    matrix6_invert(x, z->answer.factor);
}

static void add_velocity(double answer[6], const tobi_rigid *r, double share)
{
    for (int a = 0; a < 3; a++) {
        answer[a] += share*r->velocity[a];
        answer[3 + a] += share*r->angular_velocity[a];
    }
}

void sph_porous_answer(tobi_system *s, int body)
{
    const tobi_rigid *r = &s->sim->bodies[body].rigid;
    tobi_porous *z = sph_porous_of(s, body);
    double *answer = sph_of(s)->links.answer[body];
    if (!z) return;
    sph_porous_factor(s, body);
    add_velocity(answer, r, 1);
    matrix6_multiply((const double (*)[6])z->answer.factor, answer);
    add_velocity(answer, r, -1);
}

/* --- what the liquid of the zones gets from them --------------------------------------------------- */

void sph_porous_gain(const tobi_system *s, const tobi_porous *z, int64_t i, const double moves[6],
                     double share)
{
    const sph_fields *f = sph_fields_of(&s->particles);
    float *u = &s->particles.velocity[i].x, *taken = &f->porous_taken[i].x;
    double arm[3], x[3], gained[3];
    sph_porous_arm(s, z, i, arm);
    sph_porous_carry(moves, arm, x);
    sph_porous_drag_by(f->porous[i], x, gained);
    for (int a = 0; a < s->box.dimension; a++) {
        const float before = u[a];
        u[a] = (float)(u[a] + share*gained[a]);
        taken[a] += before - u[a];
    }
}

static void join_range(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    for (int64_t i = begin; i < end; i++) {
        const tobi_porous *z = find_carried(s, i);
        if (z) sph_porous_gain(s, z, i, z->pose.now, 1);
    }
}

void sph_porous_join(tobi_system *s)
{
    if (!sph_of(s)->zones_answer) return;
    for (int k = 0; k < s->sim->porous_count; k++) {
        tobi_porous *z = &s->sim->porous[k];
        if (!z->carrier || s->sim->bodies[z->carrier - 1].rigid.kind == TOBI_PRESCRIBED) continue;
        const tobi_rigid *r = &s->sim->bodies[z->carrier - 1].rigid;
        const double *answer = sph_of(s)->links.answer[z->carrier - 1];
        for (int a = 0; a < 6; a++)
            z->pose.now[a] = answer[a] + (a < 3 ? r->velocity[a] : r->angular_velocity[a - 3]);
    }
    tobi_loop(s->sim->exec.threads, s->particles.count, 0, join_range, s);
}

void sph_porous_sum_accelerations(tobi_system *s, int body, double f[6])
{
    double t[6];
    if (!sph_porous_of(s, body)) return;
    count(s, (counting){ s, body + 1, PRESSED, { 0 } }, t);
    for (int a = 0; a < 6; a++) f[a] += t[a];
}

static void spread_range(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_fields *f = sph_fields_of(&s->particles);
    for (int64_t i = begin; i < end; i++) {
        const tobi_porous *z = find_carried(s, i);
        double arm[3], x[3], gained[3];
        if (!z) continue;
        sph_porous_arm(s, z, i, arm);
        sph_porous_carry(sph_of(s)->links.answer[z->carrier - 1], arm, x);
        sph_porous_drag_by(f->porous[i], x, gained);
        for (int a = 0; a < s->box.dimension; a++) (&f->accel[i].x)[a] += (float)gained[a];
    }
}

void sph_porous_spread_accelerations(tobi_system *s)
{
    if (sph_of(s)->zones_answer) tobi_loop(s->sim->exec.threads, s->particles.count, 0, spread_range, s);
}

void sph_porous_lost(tobi_system *s, int body, double impulse[6])
{
    count(s, (counting){ s, body + 1, LOST, { 0 } }, impulse);
}

void sph_porous_load(tobi_system *s)
{
    for (int k = 0; k < s->sim->porous_count; k++) {
        const tobi_porous *z = &s->sim->porous[k];
        double t[6];
        if (!z->answer.leads) continue;
        sph_porous_lost(s, z->carrier - 1, t);
        for (int a = 0; a < 6; a++)
            s->sim->bodies[z->carrier - 1].load[s->number].friction[a] += t[a]/s->dt;
    }
    sph_of(s)->zones_answer = 0;
}

/* --- the last pass of a pressure --------------------------------------------------------------------- */

static void keep_range(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_fields *f = sph_fields_of(&s->particles);
    for (int64_t i = begin; i < end; i++) f->porous_kept[i] = s->particles.velocity[i];
}

/* M of what the pressure gave, as an acceleration. */
static void brake_gain(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_fields *f = sph_fields_of(&s->particles);
    for (int64_t i = begin; i < end; i++) {
        const float *u = &s->particles.velocity[i].x, *kept = &f->porous_kept[i].x;
        float a[3];
        for (int c = 0; c < 3; c++) a[c] = (float)(((double)u[c] - kept[c])/s->dt);
        sph_porous_yield(f->porous[i], a);
        f->accel[i] = (tobi_float4){ a[0], a[1], a[2], 0 };
    }
}

static void take_gain(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_fields *f = sph_fields_of(&s->particles);
    for (int64_t i = begin; i < end; i++) {
        float *u = &s->particles.velocity[i].x, *taken = &f->porous_taken[i].x;
        if (!(f->porous_before[i].w > 0)) continue;
        for (int c = 0; c < s->box.dimension; c++) {
            const float free = u[c];
            u[c] = (float)((&f->porous_kept[i].x)[c] + s->dt*(&f->accel[i].x)[c]);
            taken[c] += free - u[c];
        }
    }
}

void sph_porous_kick(tobi_system *s, sph_view *v, const sph_kernels *kernel, double *t)
{
    const tobi_float4 *porous = v->porous;
    const int carried = porous && sph_of(s)->zones_answer, threads = s->sim->exec.threads;
    if (carried) tobi_loop(threads, s->particles.count, 0, keep_range, s);
    if (carried) v->porous = NULL;
    tobi_launch(&s->sim->exec, kernel->sph_pressure_kick, v, 0, s->particles.count, t);
    v->porous = porous;
    if (!carried) return;
    tobi_loop(threads, s->particles.count, 0, brake_gain, s);
    tobi_couple_press(s);
    tobi_loop(threads, s->particles.count, 0, take_gain, s);
}
