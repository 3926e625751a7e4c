/* The exchange of a liquid with soft solids. A pair of a particle and a point has one force, which both get:
   2 p V_i V_b grad W with the particle's pressure mirrored at the point, its hydrostatic part, and friction.
   The points answer within the pressure solve; that they would stand still under the forces of the last step
   is what the solve takes for granted of their insides (decision 64). By isph particles are less even, and
   the pairs of each are balanced (decision 96). Drawback: pairs are made one at a time; points deep inside a
   solid are asked too. */
#include "sph/soft.h"
#include "exec/exec.h"
#include "sph/stages.h"
#include "sph/state.h"
#include <math.h>
#include <string.h>

static sph_soft *soft_of(const tobi_system *s) { return &sph_of(s)->soft; }
static const tobi_soft *solids_of(const tobi_system *s) { return &s->sim->soft; }
static int is_alone(const tobi_system *s) { return !s->sim->soft.solids; }

static tobi_status grow_rows(void **p, int64_t *room, int64_t need, size_t size, tobi_error *err)
{
    if (need <= *room) return TOBI_OK;
    const int64_t more = need + need/2 + 64;
    void *q = tobi_array_grow(*p, 0, more, size);
    if (!q)
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld points of solids", (long long)more);
    *p = q;
    *room = more;
    return TOBI_OK;
}

#define grow(array, room, need, err) grow_rows((void **)(array), room, need, sizeof **(array), err)

/* Rows of cells that may hold particles within `reach` cells of a place: first and one past the last. */
typedef struct cell_walk { const tobi_cells *c; int low[3], high[3], y, z; } cell_walk;

static cell_walk begin_walk(const tobi_system *s, const double *x, int reach)
{
    cell_walk w = { .c = &s->cells };
    for (int a = 0; a < 3; a++) {
        const int flat = a == 2 && s->box.dimension == 2, at = (int)floor(x[a]*w.c->inverse[a]);
        w.low[a] = flat || at - reach < 0 ? 0 : at - reach;
        w.high[a] = flat ? 0 : at + reach >= w.c->n[a] ? w.c->n[a] - 1 : at + reach;
    }
    w.y = w.low[1];
    w.z = w.low[2];
    return w;
}

static int next_row(cell_walk *w, int32_t *begin, int32_t *end)
{
    if (w->low[0] > w->high[0] || w->low[1] > w->high[1] || w->z > w->high[2]) return 0;
    const int32_t *start = w->c->start + tobi_cells_row(w->c, w->y, w->z);
    *begin = start[w->low[0]];
    *end = start[w->high[0] + 1];
    if (++w->y > w->high[1]) {
        w->y = w->low[1];
        w->z++;
    }
    return 1;
}

/* From the point to particle i; the square of its length. */
static double subtract(const tobi_system *s, int64_t i, const double *x, double r[3])
{
    double square = 0;
    for (int a = 0; a < 3; a++) {
        r[a] = a < s->box.dimension ? (&s->particles.position[i].x)[a] - x[a] : 0;
        square += r[a]*r[a];
    }
    return square;
}

/* Links of each row of the solids. totals: square of the fastest that has particles within two cells. */
static void count_links(const void *view, int64_t begin, int64_t end, double *totals)
{
    const tobi_system *s = view;
    const tobi_soft *q = solids_of(s);
    const double h2 = s->smoothing.h*s->smoothing.h;
    for (int64_t b = begin; b < end; b++) {
        const double *x = &q->position[b].x;
        int32_t from, to;
        int64_t found = 0, near = 0;
        double r[3];
        for (cell_walk w = begin_walk(s, x, 2); next_row(&w, &from, &to);) near += to - from;
        soft_of(s)->found[b] = 0;
        if (!near || q->size[b].volume == 0) continue;
        for (cell_walk w = begin_walk(s, x, 1); next_row(&w, &from, &to);)
            for (int32_t i = from; i < to; i++) found += subtract(s, i, x, r) < h2;
        soft_of(s)->found[b] = found;
        const tobi_float4 u = q->velocity[b];
        totals[6] = fmax(totals[6], (double)u.x*u.x + (double)u.y*u.y + (double)u.z*u.z);
    }
}

static void fill_links(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_soft *q = soft_of(s);
    const tobi_smoothing_constants *c = &s->smoothing;
    for (int64_t k = begin; k < end; k++) {
        const double *x = &solids_of(s)->position[q->wet[k]].x, volume = solids_of(s)->size[q->wet[k]].volume;
        sph_soft_link *link = q->link + q->first[k];
        int32_t from, to;
        double r[3];
        for (cell_walk w = begin_walk(s, x, 1); next_row(&w, &from, &to);)
            for (int32_t i = from; i < to; i++) {
                const double r2 = subtract(s, i, x, r), size = sqrt(r2);
                if (!(r2 < c->h*c->h)) continue;
                const double f = volume*c->slope_correction*
                                 tobi_smoothing_f(c->shape, c->dimension, c->h, size);
                *link++ = (sph_soft_link){
                    .particle = i, .point = (int32_t)k, .rate = (float)f,
                    .share = (float)(volume*c->weight_correction*
                                     tobi_smoothing_w(c->shape, c->dimension, c->h, size)),
                    .gradient = { (float)(-f*r[0]), (float)(-f*r[1]), (float)(-f*r[2]) },
                    .push = { (float)(-f*r[0]), (float)(-f*r[1]), (float)(-f*r[2]) } };
            }
    }
}

/* sum of V rho V_b F (d . n)^2 over the particles at d from the point. */
static double find_layer(const tobi_system *s, int64_t k)
{
    const sph_soft *q = soft_of(s);
    double n[3] = { 0 }, sum = 0, square = 0;
    for (int64_t l = q->first[k]; l < q->first[k + 1]; l++)
        for (int a = 0; a < 3; a++) n[a] += q->link[l].gradient[a];
    for (int a = 0; a < 3; a++) square += n[a]*n[a];
    for (int64_t l = q->first[k]; l < q->first[k + 1] && square > 0; l++) {
        const double heavy = s->fluid[s->particles.fluid[q->link[l].particle]].density/s->fluid[0].density;
        double along = 0;
        for (int a = 0; a < 3; a++) along += q->link[l].gradient[a]*n[a];
        if (q->link[l].rate > 0) sum += heavy*along*along/(square*q->link[l].rate);
    }
    return s->smoothing.volume*s->fluid[0].density*sum;
}

static void begin_mirrors(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_soft *q = soft_of(s);
    for (int64_t k = begin; k < end; k++) {
        q->velocity[k] = solids_of(s)->velocity[q->wet[k]];
        q->layer[k] = find_layer(s, k);
        memset(q->change[k], 0, sizeof q->change[k]);
    }
}

/* 1/kg: of a point, with the liquid before it where that belongs to it. */
static double inverse_mass(const tobi_system *s, int64_t k)
{
    const double own = solids_of(s)->size[soft_of(s)->wet[k]].inverse_mass;
    return sph_of(s)->mirrors ? own/(1 + own*soft_of(s)->layer[k]) : own;
}

static void chain_links(const tobi_system *s)
{
    const sph_soft *q = soft_of(s);
    memset(q->last, 0xFF, (size_t)s->particles.count*sizeof *q->last);
    for (int64_t k = 0; k < q->count; k++) {
        q->link[k].previous = q->last[q->link[k].particle];
        q->last[q->link[k].particle] = (int32_t)k;
    }
}

/* Keeps the rows that have links, and where theirs begin. */
static tobi_status list_points(const tobi_system *s, tobi_error *err)
{
    sph_soft *q = soft_of(s);
    int64_t points = 0;
    q->count = 0;
    for (int64_t b = 0; b < solids_of(s)->count; b++) points += q->found[b] > 0;
    TOBI_TRY(grow(&q->wet, &q->wet_room, points, err));
    TOBI_TRY(grow(&q->first, &q->first_room, points + 1, err));
    TOBI_TRY(grow(&q->answer, &q->answer_room, points, err));
    TOBI_TRY(grow(&q->known, &q->known_room, points, err));
    if (sph_of(s)->mirrors) {
        TOBI_TRY(grow(&q->change, &q->change_room, points, err));
        TOBI_TRY(grow(&q->velocity, &q->velocity_room, points, err));
        TOBI_TRY(grow(&q->layer, &q->layer_room, points, err));
    }
    q->points = 0;
    for (int64_t b = 0; b < solids_of(s)->count; b++) {
        if (q->found[b] == 0) continue;
        q->wet[q->points] = (int32_t)b;
        q->first[q->points++] = q->count;
        q->count += q->found[b];
    }
    q->first[q->points] = q->count;
    return grow(&q->link, &q->link_room, q->count, err);
}

tobi_status sph_soft_find(tobi_system *s, tobi_error *err)
{
    sph_soft *q = soft_of(s);
    tobi_soft *soft = &s->sim->soft;
    double t[TOBI_TOTALS];
    if (is_alone(s)) return TOBI_OK;
    TOBI_TRY(soft->solids->method->points(soft->solids, err));
    TOBI_TRY(grow(&q->found, &q->found_room, soft->count, err));
    TOBI_TRY(grow(&q->dry, &q->dry_room, soft->count, err));
    TOBI_TRY(grow(&q->last, &q->last_room, s->particles.count, err));
    TOBI_TRY(tobi_exec_reserve(&s->sim->exec, soft->count, err));
    tobi_launch(&s->sim->exec, TOBI_HOST(count_links, 0, 1), s, 0, soft->count, t);
    soft->speed = sqrt(t[6]);
    TOBI_TRY(list_points(s, err));
    tobi_loop(s->sim->exec.threads, q->points, 64, fill_links, s);
    if (q->points > 0) memset(q->known, 0, (size_t)q->points*sizeof *q->known);
    if (sph_of(s)->mirrors) tobi_loop(s->sim->exec.threads, q->points, 0, begin_mirrors, s);
    chain_links(s);
    return sph_soft_mark(s, err);
}

/* The share of the kernel of which sph_wall_density makes this sum over a lattice: its inverse. */
static double find_share(const tobi_smoothing_constants *c, double sum)
{
    const double at = c->wall_share, full = c->wall_lattice;
    if (sum <= full) return sum*at/full;
    return sum < 0.5 ? at + (sum - full)*(0.5 - at)/(0.5 - full) : fmin(sum, 0.98);
}

static void add_gradients(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_fields *f = sph_fields_of(&s->particles);
    const sph_soft *q = soft_of(s);
    for (int64_t i = begin; i < end; i++) {
        double sum[4] = { 0 };
        if (q->last[i] < 0) continue;
        for (int32_t k = q->last[i]; k >= 0; k = q->link[k].previous) {
            for (int a = 0; a < 3; a++) sum[a] += q->link[k].gradient[a];
            sum[3] += q->link[k].share;
        }
        for (int a = 0; a < 3; a++) (&f->wall[i].x)[a] += (float)sum[a];
        f->density[i] = 1 - (1 - f->density[i])*(1 - (float)find_share(&s->smoothing, sum[3]));
    }
}

void sph_soft_add_gradients(tobi_system *s)
{
    if (!is_alone(s)) tobi_loop(s->sim->exec.threads, s->particles.count, 0, add_gradients, s);
}

/* Acceleration of the link's particle by the hydrostatic part of the mirrored pressure and by friction; its
   mass times that is what the point gets less. Friction mirrors the velocity of the particle too. */
static void find_force(const tobi_system *s, const sph_soft_link *l, int hydrostatic, double out[3])
{
    const tobi_soft *q = solids_of(s);
    const int32_t b = soft_of(s)->wet[l->point];
    const tobi_fluid *fluid = &s->fluid[s->particles.fluid[l->particle]];
    const double nu = q->size[b].grip*fluid->viscosity/fluid->density;
    const float *u = &s->particles.velocity[l->particle].x, *w = &q->velocity[b].x;
    const tobi_reference *still = &soft_of(s)->still;
    const double held = still->push*tobi_reference_share(still, &q->position[b].x)/fluid->density;
    double r[3], fall = 0;
    subtract(s, l->particle, &q->position[b].x, r);
    for (int a = 0; a < s->box.dimension && hydrostatic; a++)
        fall -= (s->gravity[a] - held*still->down[a])*r[a];
    for (int a = 0; a < 3; a++)
        out[a] = -fall*l->push[a] + 4*nu*l->rate*((double)w[a] - u[a]);
}

/* Reactions on the points, before the velocities change. The pressures of isph have the still water that
   presses the points by itself, and leave it. */
static void keep_reactions(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_soft *q = soft_of(s);
    for (int64_t k = begin; k < end; k++) {
        double force[3], sum[3] = { 0 };
        for (int64_t n = q->first[k]; n < q->first[k + 1]; n++) {
            const double mass = s->smoothing.volume*s->fluid[s->particles.fluid[q->link[n].particle]].density;
            find_force(s, &q->link[n], 1, force);
            const double *x = &s->particles.position[q->link[n].particle].x,
                         still = sph_of(s)->mirrors ? tobi_reference_pressure(&q->still, x) : 0;
            for (int a = 0; a < 3; a++)
                sum[a] -= mass*force[a] + 2*s->smoothing.volume*still*q->link[n].push[a];
        }
        memcpy(q->known[k], sum, sizeof sum);
    }
}

static void find_forces(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_soft *q = soft_of(s);
    for (int64_t i = begin; i < end; i++) {
        double force[3], sum[3] = { 0 };
        if (q->last[i] < 0) continue;
        for (int32_t k = q->last[i]; k >= 0; k = q->link[k].previous) {
            find_force(s, &q->link[k], !sph_of(s)->mirrors, force);     /* isph has it in its images */
            for (int a = 0; a < 3; a++) sum[a] += force[a];
        }
        for (int a = 0; a < 3; a++) (&s->particles.velocity[i].x)[a] += (float)(s->dt*sum[a]);
    }
}

void sph_soft_add_forces(tobi_system *s)
{
    if (is_alone(s)) return;
    tobi_loop(s->sim->exec.threads, soft_of(s)->points, 0, keep_reactions, s);
    tobi_loop(s->sim->exec.threads, s->particles.count, 0, find_forces, s);
}

/* Where no solve follows, the points keep their velocities. */
static void predict(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const tobi_soft *soft = solids_of(s);
    const sph_soft *q = soft_of(s);
    for (int64_t k = begin; k < end; k++) {
        const int32_t b = q->wet[k];
        const double dt = q->solved ? s->dt*inverse_mass(s, k) : 0;
        double still[3];
        sph_soft_still_force(s, b, still);
        for (int a = 0; a < 3; a++)
            q->answer[k][a] = (&soft->velocity[b].x)[a] +
                              dt*(q->known[k][a] + still[a] - (&soft->push[b].x)[a]);
    }
}

typedef struct balance { const tobi_system *s; const tobi_float4 *lack; const float *gate; } balance;

/* What particle i lacks towards the solids goes to its links, by their shares. */
static void balance_particle(const balance *e, int64_t i)
{
    const sph_soft *q = soft_of(e->s);
    const float *lack = &e->lack[i].x;
    double share = 0, n[3] = { 0 }, along = 0, square = 0;
    for (int32_t k = q->last[i]; k >= 0; k = q->link[k].previous) {
        share += q->link[k].share;
        for (int a = 0; a < 3; a++) n[a] += q->link[k].gradient[a];
    }
    for (int a = 0; a < 3; a++) {
        along += n[a]*lack[a];
        square += n[a]*n[a];
    }
    if (!(share > 0 && square > 0)) return;
    const double part = (1 - e->gate[i])*along/(square*share);
    for (int32_t k = q->last[i]; k >= 0; k = q->link[k].previous)
        for (int a = 0; a < 3; a++) q->link[k].push[a] -= (float)(part*q->link[k].share*n[a]);
}

static void balance_links(const void *view, int64_t begin, int64_t end)
{
    const balance *e = view;
    for (int64_t i = begin; i < end; i++) balance_particle(e, i);
}

void sph_soft_balance(tobi_system *s, const tobi_float4 *lack, const float *gate)
{
    const balance e = { s, lack, gate };
    if (!is_alone(s)) tobi_loop(s->sim->exec.threads, s->particles.count, 0, balance_links, &e);
}

static double sum_answers(const sph_soft *q, int64_t i)
{
    double sum = 0;
    for (int32_t k = q->last[i]; k >= 0; k = q->link[k].previous) {
        const sph_soft_link *l = &q->link[k];
        const double *u = q->answer[l->point];
        sum += l->push[0]*u[0] + l->push[1]*u[1] + l->push[2]*u[2];
    }
    return sum;
}

static void add_flux(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_soft *q = soft_of(s);
    for (int64_t i = begin; i < end; i++)
        if (q->last[i] >= 0) sph_fields_of(&s->particles)->wall[i].w += (float)sum_answers(q, i);
}

void sph_soft_begin(tobi_system *s, int solved)
{
    if (is_alone(s)) return;
    soft_of(s)->solved = solved;
    tobi_loop(s->sim->exec.threads, soft_of(s)->points, 0, predict, s);
    tobi_loop(s->sim->exec.threads, s->particles.count, 0, add_flux, s);
}

/* sum of 2 V p V_b grad W: N per unit of the records' payload, or of `pressure`. */
static void sum_pressure(const tobi_system *s, int64_t k, const float *pressure, double f[3])
{
    const sph_soft *q = soft_of(s);
    f[0] = f[1] = f[2] = 0;
    for (int64_t n = q->first[k]; n < q->first[k + 1]; n++) {
        const sph_soft_link *l = &q->link[n];
        const double p = pressure ? pressure[l->particle] : s->cells.record[l->particle].w;
        for (int a = 0; a < 3; a++) f[a] += p*l->push[a];
    }
    for (int a = 0; a < 3; a++) f[a] *= 2*s->smoothing.volume;
}

static void find_answers(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_soft *q = soft_of(s);
    for (int64_t k = begin; k < end; k++) {
        sum_pressure(s, k, NULL, q->answer[k]);
        for (int a = 0; a < 3; a++) q->answer[k][a] *= inverse_mass(s, k);
    }
}

/* totals: the record's payload times what the product gains, and that. */
static void add_product(const void *view, int64_t begin, int64_t end, double *totals)
{
    const tobi_system *s = view;
    const sph_soft *q = soft_of(s);
    float *product = sph_fields_of(&s->particles)->product;
    for (int64_t i = begin; i < end; i++) {
        if (q->last[i] < 0) continue;
        const float before = product[i], after = before + (float)(2*sum_answers(q, i));
        product[i] = after;
        totals[0] += ((double)after - before)*s->cells.record[i].w;
        totals[1] += (double)after - before;
    }
}

void sph_soft_product(tobi_system *s, double *totals)
{
    double t[TOBI_TOTALS];
    if (is_alone(s)) return;
    tobi_loop(s->sim->exec.threads, soft_of(s)->points, 0, find_answers, s);
    tobi_launch(&s->sim->exec, TOBI_HOST(add_product, 2, 0), s, 0, s->particles.count, t);
    if (!totals) return;
    totals[0] += t[0];
    totals[1] += t[1];
}

typedef struct answering { const tobi_system *s; const double *in; double *out; } answering;

/* By pressures in double: accelerations. */
static void answer_points(const void *view, int64_t begin, int64_t end)
{
    const answering *w = view;
    const sph_soft *q = soft_of(w->s);
    for (int64_t k = begin; k < end; k++) {
        double sum[3] = { 0 };
        for (int64_t n = q->first[k]; n < q->first[k + 1]; n++)
            for (int a = 0; a < 3; a++) sum[a] += w->in[q->link[n].particle]*q->link[n].push[a];
        for (int a = 0; a < 3; a++)
            q->answer[k][a] = 2*w->s->smoothing.volume*sum[a]*inverse_mass(w->s, k);
    }
}

static void add_answer(const void *view, int64_t begin, int64_t end)
{
    const answering *w = view;
    const sph_soft *q = soft_of(w->s);
    for (int64_t i = begin; i < end; i++)
        if (q->last[i] >= 0) w->out[i] += 2*w->s->fluid[0].density*sum_answers(q, i);
}

void sph_soft_add_answer(tobi_system *s, double *out, const double *in)
{
    const answering view = { s, in, out };
    if (is_alone(s)) return;
    tobi_loop(s->sim->exec.threads, soft_of(s)->points, 0, answer_points, &view);
    tobi_loop(s->sim->exec.threads, s->particles.count, 0, add_answer, &view);
}

void sph_soft_predict(tobi_system *s, int solved)
{
    sph_soft *q = soft_of(s);
    if (is_alone(s)) return;
    q->solved = solved;
    tobi_loop(s->sim->exec.threads, q->points, 0, predict, s);
    for (int64_t k = 0; k < q->points; k++)
        for (int a = 0; a < 3; a++) q->change[k][a] = q->answer[k][a] - (&q->velocity[k].x)[a];
}

void sph_soft_correct(tobi_system *s, const double *in)
{
    const answering view = { s, in, NULL };
    const sph_soft *q = soft_of(s);
    if (is_alone(s) || !q->solved) return;
    tobi_loop(s->sim->exec.threads, q->points, 0, answer_points, &view);
    for (int64_t k = 0; k < q->points; k++)
        for (int a = 0; a < 3; a++) q->change[k][a] += s->dt*q->answer[k][a];
}

static void press_all(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    for (int64_t b = begin; b < end; b++) {
        double still[3];
        sph_soft_still_force(s, b, still);
        s->sim->soft.push[b] = (tobi_float4){ (float)still[0], (float)still[1], (float)still[2], 0 };
    }
}

/* N: what the liquid between particles and point takes to be accelerated with it. */
static double take_layer(const tobi_system *s, int64_t k, int axis)
{
    const sph_soft *q = soft_of(s);
    return sph_of(s)->mirrors && q->solved ? q->layer[k]*q->change[k][axis]/s->dt : 0;
}

static void press_points(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_soft *q = soft_of(s);
    const sph_fields *f = sph_fields_of(&s->particles);
    for (int64_t k = begin; k < end; k++) {
        double pressure[3], capillary[3] = { 0 };
        sum_pressure(s, k, f->pressure, pressure);
        if (f->capillary) sum_pressure(s, k, f->capillary, capillary);
        for (int a = 0; a < 3; a++)
            (&solids_of(s)->push[q->wet[k]].x)[a] +=
                (float)(pressure[a] - capillary[a] + q->known[k][a] - take_layer(s, k, a));
    }
}

void sph_soft_load(tobi_system *s)
{
    if (is_alone(s)) return;
    tobi_loop(s->sim->exec.threads, solids_of(s)->count, 0, press_all, s);
    tobi_loop(s->sim->exec.threads, soft_of(s)->points, 0, press_points, s);
}

double sph_soft_compliance(const tobi_system *s)
{
    const tobi_system *solids = solids_of(s)->solids;
    double least = INFINITY;
    if (is_alone(s)) return 0;
    for (int k = 0; k < solids->solid_count; k++) least = fmin(least, solids->solids[k].def.density);
    return 1/(least*solids->smoothing.spacing);
}

/* Half the limit of the liquid, whose pairs rub half as much, by the mass of the lightest. */
double sph_soft_dt(const tobi_system *s)
{
    const tobi_system *solids = solids_of(s)->solids;
    double dt = INFINITY, light, heavy;
    if (is_alone(s)) return dt;
    tobi_system_densities(s, &light, &heavy);
    for (int k = 0; k < solids->solid_count; k++) {
        const tobi_solid_def *d = &solids->solids[k].def;
        if (d->liquid_friction == TOBI_NO_SLIP)
            dt = fmin(dt, 0.5*sph_viscous_dt(s)*fmin(d->density/heavy, 1));
    }
    return dt;
}

double sph_soft_wave_speed(const tobi_system *s)
{
    const tobi_system *solids = solids_of(s)->solids;
    double square = 0;
    for (int k = 0; solids && k < solids->solid_count; k++) {
        const tobi_solid_def *d = &solids->solids[k].def;
        const double nu = d->poissons_ratio,
                     modulus = d->model == TOBI_LIQUID ? d->bulk_modulus : d->youngs_modulus/(1 - nu*nu);
        if (d->model != TOBI_STATIONARY) square = fmax(square, modulus/d->density);
    }
    return sqrt(square);
}

int64_t sph_soft_bytes(const sph_soft *q)
{
    return q->link_room*(int64_t)sizeof *q->link + q->wet_room*(int64_t)sizeof *q->wet +
           q->first_room*(int64_t)sizeof *q->first + q->answer_room*(int64_t)sizeof *q->answer +
           q->known_room*(int64_t)sizeof *q->known +
           q->change_room*(int64_t)sizeof *q->change + q->velocity_room*(int64_t)sizeof *q->velocity +
           q->layer_room*(int64_t)sizeof *q->layer + q->dry_room*(int64_t)sizeof *q->dry + q->marks.room +
           q->last_room*(int64_t)sizeof *q->last +
           q->found_room*(int64_t)sizeof *q->found;
}

void sph_soft_free(sph_soft *q)
{
    tobi_array_free(q->link);
    tobi_array_free(q->wet);
    tobi_array_free(q->first);
    tobi_array_free(q->answer);
    tobi_array_free(q->known);
    tobi_array_free(q->change);
    tobi_array_free(q->velocity);
    tobi_array_free(q->layer);
    tobi_array_free(q->last);
    tobi_array_free(q->found);
    tobi_array_free(q->dry);
    tobi_array_free(q->marks.taken);
    memset(q, 0, sizeof *q);
}
