/* What lies in a buffer is no unknown of the pressure: it keeps the pressure that it is given before the
   solve, and goes as the profile or the free liquid beside it does (docs/decisions/0061-openings.md, 0086,
   0171). Drawback: the pressure at an inlet is that of the step before. */
#include "sph/openings.h"
#include "sph/nest.h"
#include "sph/state.h"
#include <math.h>

/* The free liquid gives way to the pressure of an inlet: all of its own in the next step would be too much,
   and from step to step it would swing. */
static const double CONTINUE = 0.5;
/* Spacings: a particle counts as that far before the plane of an outlet at least. */
static const double NEAREST = 0.5;
/* Share of a held neighbour in the velocity of an outlet, over that of a free one. */
static const double LATE = 0.1;

int sph_has_openings(const tobi_system *s) { return s->sim->opening_count > 0 || s->sim->nest.outer; }

static void mark_range(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const tobi_simulation *w = s->sim;
    tobi_float4 *held = sph_fields_of(&s->particles)->held;
    for (int64_t i = begin; i < end; i++) {
        const tobi_double3 *p = &s->particles.position[i];
        const double x[3] = { p->x, p->y, p->z };
        const int k = tobi_opening_find(w->openings, w->opening_count, x);
        const int outlet = k >= 0 && w->openings[k].outlet;
        held[i] = (tobi_float4){ 0, 0, 0, outlet ? -(float)(k + 1) : (float)(k + 1) };
        if (k < 0 || outlet) continue;
        const tobi_opening *o = &w->openings[k];
        double at[3];
        tobi_opening_locate(o, x, at);
        const double u = tobi_opening_speed(o, w->time, w->dt)*tobi_opening_factor(o, at[1], at[2]);
        for (int a = 0; a < 3; a++) (&held[i].x)[a] = (float)(u*o->normal[a]);
    }
}

/* From j to i, m; its square. */
static double find_arm(const tobi_system *s, int64_t i, int64_t j, double arm[3])
{
    const tobi_double3 *p = s->particles.position;
    double r2 = 0;
    arm[2] = 0;
    for (int a = 0; a < s->box.dimension; a++) {
        arm[a] = (&p[i].x)[a] - (&p[j].x)[a];
        if (s->box.periodic[a]) arm[a] -= s->box.size[a]*round(arm[a]/s->box.size[a]);
        r2 += arm[a]*arm[a];
    }
    return r2;
}

/* Pa, of liquid at rest, over that arm. */
static double find_still(const tobi_system *s, const double arm[3])
{
    double still = 0;
    for (int a = 0; a < s->box.dimension; a++) still += s->fluid[0].density*s->sim->def.gravity[a]*arm[a];
    return still;
}

/* What the neighbours of a held particle have: sums over them. */
typedef struct around { double free, velocity[3], pressure, held, before[3]; } around;

static around look_around(const tobi_system *s, int64_t i)
{
    const tobi_particles *p = &s->particles;
    const sph_fields *f = sph_fields_of(p);
    const tobi_smoothing_constants *c = &s->smoothing;
    int32_t unpacked[TOBI_LIST_LIMIT];
    int count;
    const int32_t *j = tobi_cells_neighbors(&s->cells, i, &count, unpacked);
    const double base = tobi_reference_pressure(&sph_of(s)->reference, &p->position[i].x);
    around sum = { 0 };
    for (int k = 0; k < count; k++) {
        if (j[k] == i) continue;
        double arm[3];
        const double w = tobi_smoothing_w(c->shape, c->dimension, c->h, sqrt(find_arm(s, i, j[k], arm)));
        if (f->held[j[k]].w != 0) {
            sum.held += w;
            for (int a = 0; a < 3; a++) sum.before[a] += w*(&f->held[j[k]].x)[a];
            continue;
        }
        sum.free += w;
        for (int a = 0; a < 3; a++) sum.velocity[a] += w*(&p->velocity[j[k]].x)[a];
        const double still = find_still(s, arm) - base +
                             tobi_reference_pressure(&sph_of(s)->reference, &p->position[j[k]].x);
        sum.pressure += w*(f->pressure[j[k]] + still);
    }
    return sum;
}

/* Of liquid at rest up to the level, or from the centre on, less what it takes to come in from there at a
   speed, Pa. */
static double find_pressure(const tobi_system *s, const tobi_opening *o, int64_t i, double in)
{
    const double density = s->fluid[0].density, *gravity = s->sim->def.gravity;
    double size = 0, along = 0;
    if (!o->gives) return 0;
    for (int a = 0; a < s->box.dimension; a++) {
        const double x = (&s->particles.position[i].x)[a];
        size += gravity[a]*gravity[a];
        along += gravity[a]*(o->gives == TOBI_GIVES_LEVEL ? x + s->box.lower[a] : x - o->centre[a]);
    }
    const double top = o->gives == TOBI_GIVES_LEVEL ? density*sqrt(size)*o->level : o->pressure;
    return fmax(top + density*(along - 0.5*in*in), 0);
}

double sph_openings_mean_pressure(const tobi_system *s)
{
    double sum = 0;
    int count = 0;
    for (int k = 0; k < s->sim->opening_count; k++) {
        if (s->sim->openings[k].gives != TOBI_GIVES_PRESSURE) continue;
        sum += s->sim->openings[k].pressure;
        count++;
    }
    return count > 0 ? sum/count : 0;
}

/* Whether liquid beyond an outlet is that of a pipe, which goes on: a buffer that takes or gives more than
   what is before it does is an error of the pressure. */
static int goes_on(const tobi_opening *o)
{
    return o->outlet && o->gives == TOBI_GIVES_PRESSURE;
}

static const tobi_opening *opening_of(const tobi_system *s, int64_t i)
{
    const float w = sph_fields_of(&s->particles)->held[i].w;
    return w != 0 && w != SPH_NEST_MARK ? &s->sim->openings[(int)fabsf(w) - 1] : NULL;
}

/* A step of the buffers: how fast liquid comes in through each outlet, on average, and by how much those gain
   speed in which liquid goes on, m/s. */
typedef struct driving {
    const tobi_system *s;
    double in[TOBI_OPENING_LIMIT], gain[TOBI_OPENING_LIMIT];
} driving;

/* Pressures of outlets, and the velocities that their particles came with. */
static void extend_range(const void *view, int64_t begin, int64_t end)
{
    const driving *d = view;
    const tobi_system *s = d->s;
    const sph_fields *f = sph_fields_of(&s->particles);
    for (int64_t i = begin; i < end; i++) {
        const tobi_opening *o = opening_of(s, i);
        if (!o || !o->outlet) continue;
        const double rest = tobi_reference_pressure(&sph_of(s)->reference, &s->particles.position[i].x);
        const double given = find_pressure(s, o, i, d->in[o - s->sim->openings]);
        f->pressure[i] = s->cells.record[i].w = (float)(given - rest);
        for (int a = 0; a < 3; a++) (&f->held[i].x)[a] = (&s->particles.velocity[i].x)[a];
    }
}

/* Reads pressures of free particles and writes those of inlets. */
typedef struct continuing { const tobi_system *s; double share; } continuing;

static void continue_range(const void *view, int64_t begin, int64_t end)
{
    const continuing *c = view;
    const sph_fields *f = sph_fields_of(&c->s->particles);
    for (int64_t i = begin; i < end; i++) {
        if (!(f->held[i].w > 0)) continue;
        const around sum = look_around(c->s, i);
        if (sum.free > 0) f->pressure[i] += (float)(c->share*(sum.pressure/sum.free - f->pressure[i]));
        c->s->cells.record[i].w = f->pressure[i];
    }
}

void sph_openings_continue(tobi_system *s, double share)
{
    const continuing c = { s, share };
    if (sph_has_openings(s)) tobi_loop(s->sim->exec.threads, s->particles.count, 512, continue_range, &c);
}

static double take_normal(const tobi_opening *o, const tobi_float4 *v)
{
    double out = 0;
    for (int a = 0; a < 3; a++) out += (&v->x)[a]*o->normal[a];
    return out;
}

/* Gives a velocity another part along the normal. */
static void set_normal(const tobi_opening *o, tobi_float4 *v, double out)
{
    const double more = out - take_normal(o, v);
    for (int a = 0; a < 3; a++) (&v->x)[a] += (float)(more*o->normal[a]);
}

/* Before and beyond a plane: sums of weights, and of weights times the speed along the normal, m/s. */
typedef struct meeting { const tobi_system *s; const tobi_opening *o; float mark; } meeting;

/* Weights are 0 at the plane and a support radius from it, so that their sum over a column hardly depends on
   where its particles are: else what crosses the plane would give the buffer a push. */
static void meet_range(const void *view, int64_t begin, int64_t end, double *totals)
{
    const meeting *m = view;
    const tobi_particles *p = &m->s->particles;
    const tobi_float4 *held = sph_fields_of(p)->held;
    for (int64_t i = begin; i < end; i++) {
        const double x[3] = { p->position[i].x, p->position[i].y, p->position[i].z };
        double at[3];
        if (held[i].w != 0 && held[i].w != m->mark) continue;
        tobi_opening_locate(m->o, x, at);
        const double far = fabs(at[0])/m->s->smoothing.h, weight = far*(1 - far);
        if (far > 1 || !tobi_opening_faces(m->o, at)) continue;
        totals[held[i].w != 0] += weight;
        totals[2 + (held[i].w != 0)] += weight*take_normal(m->o, &p->velocity[i]);
    }
}

static void meet(const tobi_system *s, int k, double t[TOBI_TOTALS])
{
    const meeting m = { s, &s->sim->openings[k], -(float)(k + 1) };
    tobi_launch(&s->sim->exec, TOBI_HOST(meet_range, 4, 0), &m, 0, s->particles.count, t);
}

static void find_inflows(const tobi_system *s, double in[TOBI_OPENING_LIMIT])
{
    for (int k = 0; k < s->sim->opening_count; k++) {
        double t[TOBI_TOTALS];
        in[k] = 0;
        if (!s->sim->openings[k].gives) continue;
        meet(s, k, t);
        in[k] = t[1] > 0 ? fmax(-t[3]/t[1], 0) : 0;
    }
}

static void find_gains(const tobi_system *s, double gain[TOBI_OPENING_LIMIT])
{
    for (int k = 0; k < s->sim->opening_count; k++) {
        double t[TOBI_TOTALS];
        gain[k] = 0;
        if (!goes_on(&s->sim->openings[k])) continue;
        meet(s, k, t);
        if (t[0] > 0 && t[1] > 0) gain[k] = t[2]/t[0] - t[3]/t[1];
    }
}

/* A velocity of an outlet's particle: the mean of the free ones around; where there are few, of those held,
   as they were before the step, and `more`. */
static void follow(const tobi_system *s, const tobi_opening *o, int64_t i, const double more[3])
{
    const around sum = look_around(s, i);
    const double weight = sum.free + LATE*sum.held;
    tobi_float4 *v = &s->particles.velocity[i];
    if (weight > 0)
        for (int a = 0; a < s->box.dimension; a++)
            (&v->x)[a] = (float)((sum.velocity[a] + LATE*(sum.before[a] + sum.held*more[a]))/weight);
    const double out = take_normal(o, v);
    if (o->gives) return;
    for (int a = 0; a < 3 && out < 0; a++) (&v->x)[a] -= (float)(out*o->normal[a]);
}

/* In isph an outlet's particles are predicted as the free ones around them are. In the other methods they
   keep their velocities: the operator gives them an acceleration by pressure along the normal alone, which
   would not balance gravity across it. Where liquid goes on they feel, along the normal, the forces besides
   pressure, by all methods: with what the whole buffer gains they keep a profile as it was, in a pipe that of
   friction. */
static void hold_range(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    tobi_float4 *held = sph_fields_of(&s->particles)->held;
    double pull[3];
    for (int a = 0; a < 3; a++) pull[a] = s->dt*s->sim->def.gravity[a];
    for (int64_t i = begin; i < end; i++) {
        const tobi_opening *o = opening_of(s, i);
        if (!o) continue;
        tobi_float4 *v = &s->particles.velocity[i];
        const int on = goes_on(o);
        if (on) set_normal(o, &held[i], take_normal(o, v));
        if (o->outlet && sph_of(s)->mirrors) follow(s, o, i, pull);
        else *v = (tobi_float4){ held[i].x, held[i].y, held[i].z, 0 };
        if (on) set_normal(o, v, take_normal(o, &held[i]));
    }
}

/* m/s along the normal, where liquid goes on: the mean of the column that a particle stands in. Columns that
   are not as fast everywhere are stretched, and gaps in them are no liquid. */
static double find_column_speed(const tobi_system *s, const tobi_opening *o, int64_t i)
{
    const sph_fields *f = sph_fields_of(&s->particles);
    const double most = 0.25*s->smoothing.spacing*s->smoothing.spacing;
    int32_t unpacked[TOBI_LIST_LIMIT];
    int count;
    double sum = take_normal(o, &f->held[i]), rows = 1;
    const int32_t *j = tobi_cells_neighbors(&s->cells, i, &count, unpacked);
    for (int k = 0; k < count; k++) {
        double arm[3], along = 0;
        if (j[k] == i || f->held[j[k]].w != f->held[i].w) continue;
        const double r2 = find_arm(s, i, j[k], arm);
        for (int a = 0; a < 3; a++) along += arm[a]*o->normal[a];
        if (r2 - along*along > most) continue;
        sum += take_normal(o, &f->held[j[k]]);
        rows += 1;
    }
    return sum/rows;
}

/* Outlets get the velocity of what is around; inlets their own. */
static void drive_range(const void *view, int64_t begin, int64_t end)
{
    static const double none[3] = { 0 };
    const tobi_system *s = view;
    const sph_fields *f = sph_fields_of(&s->particles);
    for (int64_t i = begin; i < end; i++) {
        const tobi_opening *o = opening_of(s, i);
        if (!o) continue;
        if (goes_on(o)) set_normal(o, &s->particles.velocity[i], find_column_speed(s, o, i));
        else if (o->outlet) follow(s, o, i, none);
        if (o->outlet) continue;
        f->accel[i] = (tobi_float4){ 0, 0, 0, 0 };
        s->particles.velocity[i] = (tobi_float4){ f->held[i].x, f->held[i].y, f->held[i].z, 0 };
    }
}

/* Where liquid goes on, it goes along the normal alone: a parallel flow neither crowds nor becomes sparse,
   and needs no shift; in dfsph that corrects the density as well. */
static void gain_range(const void *view, int64_t begin, int64_t end)
{
    const driving *d = view;
    const tobi_system *s = d->s;
    const sph_fields *f = sph_fields_of(&s->particles);
    for (int64_t i = begin; i < end; i++) {
        const tobi_opening *o = opening_of(s, i);
        if (!o || !goes_on(o)) continue;
        tobi_float4 *v = &s->particles.velocity[i];
        const double out = take_normal(o, v) + d->gain[o - s->sim->openings];
        *v = (tobi_float4){ 0, 0, 0, 0 };
        set_normal(o, v, out);
        if (sph_of(s)->mirrors) f->accel[i] = (tobi_float4){ 0, 0, 0, 0 };
    }
}

/* m, before its plane. */
static double distance_before(const tobi_system *s, const tobi_opening *o, int64_t i)
{
    const tobi_double3 *p = &s->particles.position[i];
    double at[3];
    tobi_opening_locate(o, (double[3]){ p->x, p->y, p->z }, at);
    return -at[0];
}

/* Of a neighbour at one spacing: so little says nothing of a slope. */
static const double FADE = 0.02;

/* Pa/m: how fast the pressure of the free liquid around rises before the plane, over that at rest. */
static double find_slope(const tobi_system *s, const tobi_opening *o, int64_t i)
{
    const sph_fields *f = sph_fields_of(&s->particles);
    const tobi_smoothing_constants *c = &s->smoothing;
    int32_t unpacked[TOBI_LIST_LIMIT];
    int count;
    double up = 0, square = FADE*tobi_smoothing_w(c->shape, c->dimension, c->h, 0)*c->spacing*c->spacing;
    const int32_t *j = tobi_cells_neighbors(&s->cells, i, &count, unpacked);
    for (int k = 0; k < count; k++) {
        double arm[3];
        if (j[k] == i || f->held[j[k]].w != 0) continue;
        const double before = distance_before(s, o, j[k]), r2 = find_arm(s, i, j[k], arm);
        if (!(before > 0)) continue;
        const double w = before*tobi_smoothing_w(c->shape, c->dimension, c->h, sqrt(r2));
        up += w*(f->pressure[j[k]] + find_still(s, arm) - f->pressure[i]);
        square += w*before;
    }
    return up/square;
}

/* Reads pressures of free particles and writes those of outlets. */
static void slope_range(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_fields *f = sph_fields_of(&s->particles);
    for (int64_t i = begin; i < end; i++) {
        const tobi_opening *o = opening_of(s, i);
        if (!o || !o->gives) continue;
        f->pressure[i] += (float)(distance_before(s, o, i)*find_slope(s, o, i));
        s->cells.record[i].w = f->pressure[i];
    }
}

void sph_openings_slope(tobi_system *s)
{
    if (sph_has_openings(s)) tobi_loop(s->sim->exec.threads, s->particles.count, 512, slope_range, s);
}

void sph_openings_mark(tobi_system *s, sph_view *v)
{
    const int64_t n = s->particles.count;
    driving d = { .s = s };
    if (!sph_has_openings(s)) return;
    for (int k = 0; k < s->sim->opening_count; k++)
        for (int a = 0; a < 4; a++)
            (&sph_of(s)->normal[k].x)[a] = a < 3 ? (float)s->sim->openings[k].normal[a]
                                                 : (float)goes_on(&s->sim->openings[k]);
    tobi_loop(s->sim->exec.threads, n, 0, mark_range, s);
    sph_nest_mark(s);
    find_inflows(s, d.in);
    tobi_loop(s->sim->exec.threads, n, 512, extend_range, &d);
    if (!sph_of(s)->mirrors) sph_openings_slope(s);         /* isph knows that in its rows */
    sph_openings_continue(s, CONTINUE);
    sph_of(s)->marked = 1;
    v->held = sph_fields_of(&s->particles)->held;
    sph_openings_hold(s);
}

void sph_openings_hold(tobi_system *s)
{
    if (sph_has_openings(s) && sph_of(s)->marked)
        tobi_loop(s->sim->exec.threads, s->particles.count, 512, hold_range, s);
    if (sph_of(s)->marked && !sph_of(s)->mirrors) sph_nest_hold(s);
}

void sph_openings_drive(tobi_system *s)
{
    driving d = { .s = s };
    if (!sph_has_openings(s) || !sph_of(s)->marked) return;
    tobi_loop(s->sim->exec.threads, s->particles.count, 512, drive_range, s);
    find_gains(s, d.gain);
    tobi_loop(s->sim->exec.threads, s->particles.count, 512, gain_range, &d);
    sph_nest_hold(s);
}

double sph_openings_stretch(const tobi_system *s, int64_t i, int64_t held, double *still)
{
    const tobi_opening *o = opening_of(s, held);
    double arm[3];
    if (!o || !o->gives) return 0;
    const double before = distance_before(s, o, i), beyond = -distance_before(s, o, held);
    find_arm(s, i, held, arm);
    *still = find_still(s, arm);
    return before > 0 ? beyond/fmax(before, NEAREST*s->smoothing.spacing) : 0;
}

static void hide_range(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_fields *f = sph_fields_of(&s->particles);
    for (int64_t i = begin; i < end; i++) {
        const tobi_double3 *p = &s->particles.position[i];
        const double x[3] = { p->x, p->y, p->z };
        if (!(f->surface_depth[i] > 0)) continue;
        if (tobi_opening_find(s->sim->openings, s->sim->opening_count, x) >= 0 ||
            (s->sim->nest.outer && tobi_nest_outside(&s->sim->nest, s->box.dimension, x) > 0))
            f->surface_depth[i] = 0;
    }
}

void sph_openings_hide_surface(tobi_system *s)
{
    if (sph_has_openings(s)) tobi_loop(s->sim->exec.threads, s->particles.count, 0, hide_range, s);
}

static void start_range(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_fields *f = sph_fields_of(&s->particles);
    for (int64_t i = begin; i < end; i++) {
        double sum = 0;
        int count = 0;
        for (int k = 0; k < s->sim->opening_count; k++) {
            if (s->sim->openings[k].gives != TOBI_GIVES_PRESSURE) continue;
            sum += find_pressure(s, &s->sim->openings[k], i, 0);
            count++;
        }
        if (count > 0) f->pressure[i] = s->cells.record[i].w = (float)(sum/count);
    }
}

void sph_openings_start(tobi_system *s)
{
    if (sph_has_openings(s)) tobi_loop(s->sim->exec.threads, s->particles.count, 0, start_range, s);
}
