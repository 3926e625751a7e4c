/* The level below which water counts as still follows the lowest part of the free surface: down at
   once, up slowly. Drawback: one level for the whole vessel. */
#include "sph/state.h"
#include "sph/sensor/around.h"
#include "sph/hydrostatic.h"
#include "sph/reference.h"
#include "geom/vec3.h"
#include <math.h>

/* In support radii. COVER keeps clear of kernels that a surface cuts. The pressure of REST stays with the
   solve: pressures that fluctuate about zero order no particles, and a tank then never rests. */
static const double COVER = 1, RAMP = 3, REST = 0.5;
/* Of gravity: what acts besides it in water that is still at rest. */
static const double DRIVEN = 0.3;
/* Support radii that a look along an axis goes before it looks up. Spacings beside it within which a particle
   ends it. */
static const double LOOK = 3, ASIDE = 0.75;
enum { DROPS = 1024 };
/* Spacings: a drop at most, however high the domain is. */
static const double DROP_MOST = 0.25;

tobi_reference sph_reference_make(const tobi_system *s, double low)
{
    double g2 = 0, h = s->smoothing.h, least, most;
    tobi_reference w = {.cover = COVER*h, .ramp = RAMP*h, .rest = REST*h};
    w.level = low - 0.5*s->smoothing.spacing;
    for (int a = 0; a < s->box.dimension; a++)
        if (!s->box.periodic[a]) g2 += s->gravity[a]*s->gravity[a];
    if (!(g2 > 0)) return w;
    tobi_system_densities(s, &least, &most);
    for (int a = 0; a < s->box.dimension; a++) {
        if (s->box.periodic[a]) continue;
        w.down[a] = s->gravity[a]/sqrt(g2);
        w.corner[a] = w.down[a] > 0 ? 0 : s->box.size[a];
    }
    w.push = low > 0 ? least*sqrt(g2) : 0;
    return w;
}

void sph_reference_set(tobi_system *s, double low)
{
    sph_of(s)->reference = sph_reference_make(s, low);
    if (!sph_of(s)->mirrors) sph_of(s)->soft.still = sph_of(s)->reference;
}

/* Depths from top on, and those above as if there; scale: drops per metre. hidden: what has a number there
   does not count; or NULL. */
typedef struct counting {
    const float *surface_depth;
    const int32_t *hidden;
    double top, scale;
    int64_t *n;
} counting;

static void count_drops(const void *view, int64_t begin, int64_t end)
{
    const counting *c = view;
    int64_t n[DROPS] = {0};
    for (int64_t i = begin; i < end; i++) {
        const double depth = c->hidden && c->hidden[i] >= 0 ? 0 : (double)c->surface_depth[i];
        if (depth > 0) n[(int)fmax(0, (depth - c->top)*c->scale)]++;
    }
    for (int k = 0; k < DROPS; k++)
        if (n[k]) __atomic_fetch_add(&c->n[k], n[k], __ATOMIC_RELAXED);
}

/* The depth below the top in the middle of all that are counted, m. */
static double find_middle(const int64_t n[DROPS], double scale)
{
    int64_t all = 0, upper = 0;
    int k = 0;
    for (int i = 0; i < DROPS; i++) all += n[i];
    for (; k < DROPS - 1 && 2*(upper += n[k]) < all; k++);
    return (k + 0.5)/scale;
}

/* The depth of all but the few deepest of `count` places, 0 in those that do not count; *middle: the median
   of all, m. */
static double find_depth(const tobi_system *s, const float *depth, const int32_t *hidden, int64_t count,
                         double deepest, double *middle)
{
    int64_t n[DROPS] = {0};
    const double all = 1.0001*deepest, range = fmin(all, DROPS*DROP_MOST*s->smoothing.spacing);
    const double top = all - range, scale = DROPS/range;
    const counting view = { depth, hidden, top, scale, n };
    if (!(deepest > 0)) return 0;
    tobi_loop(s->sim->exec.threads, count, 0, count_drops, &view);
    *middle = top + find_middle(n, scale);
    double few = 1 + 0.02*(s->box.dimension == 3 ? cbrt((double)count*(double)count) : sqrt((double)count));
    int k = DROPS - 1;
    for (int64_t deeper = n[k]; k > 0 && (double)deeper <= few; deeper += n[k]) k--;
    return top + k/scale;
}

/* A gap beside a soft solid is no surface: whether there is air the solid tells, sph_soft_find_dry. */
static double find_low(const tobi_system *s, double *middle)
{
    return find_depth(s, sph_fields_of(&s->particles)->surface_depth,
                      s->sim->soft.solids ? sph_of(s)->soft.last : NULL, s->particles.count,
                      sph_of(s)->lowest, middle);
}

double sph_reference_surface(tobi_system *s) { return find_low(s, &sph_of(s)->middle); }

double sph_reference_below_air(tobi_system *s, double low)
{
    double middle;
    const double dry = low > 0 ? sph_soft_find_dry(s, low) : 0;
    return fmax(low, find_depth(s, sph_of(s)->soft.dry, NULL, s->sim->soft.count, dry, &middle));
}

double sph_reference_low(tobi_system *s) { return sph_reference_below_air(s, sph_reference_surface(s)); }

/* --- surfaces that open in the depth --------------------------------------------------------------- */

/* A line along an axis, of a length below 0 the way back: whether particles are on it. */
typedef struct look { int axis; double length, aside; int met; } look;

static void meet(void *user, int64_t i, const double d[3])
{
    look *l = user;
    const double along = l->length > 0 ? d[l->axis] : -d[l->axis];
    const double across = vec3_dot(d, d) - along*along;
    (void)i;
    if (along > 0 && along < fabs(l->length) && across < l->aside*l->aside) l->met = 1;
}

static int meets_body(const tobi_system *s, const double from[3], const double to[3])
{
    for (int k = 0; k < s->sim->body_count; k++) {
        const tobi_body *b = &s->sim->bodies[k];
        if (!b->is_absent && tobi_bvh_segment_hits(b->bvh, from, to)) return 1;
    }
    return 0;
}

/* Whether the line from x on is free of particles, bodies and soft solids. */
static int is_free(const tobi_system *s, const double x[3], int axis, double length)
{
    look l = { .axis = axis, .length = length, .aside = ASIDE*s->smoothing.spacing };
    double to[3] = { x[0], x[1], x[2] };
    to[axis] += length;
    sph_range cells = sph_cells_around(s, x, l.aside);
    const sph_range end = sph_cells_around(s, to, l.aside);
    if (length > 0) cells.last[axis] = end.last[axis];
    else cells.first[axis] = end.first[axis];
    sph_visit(s, x, &cells, meet, &l);
    return !l.met && !meets_body(s, x, to) && !sph_soft_meets(s, x, to);
}

/* Whether the air above is to be seen from a particle: along one of the axes, and from there straight up. */
static int looks_out(const tobi_system *s, int64_t i)
{
    const tobi_double3 *p = &s->particles.position[i];
    const double *down = sph_of(s)->reference.down, length = LOOK*s->smoothing.h;
    int up = 0;
    for (int a = 1; a < s->box.dimension; a++)
        if (fabs(down[a]) > fabs(down[up])) up = a;
    for (int way = 0; way < 2*s->box.dimension; way++) {
        const int a = way/2;
        const double step = way%2 ? -length : length, from = s->box.periodic[a] ? 0 : (&p->x)[a],
                     room = step > 0 ? s->box.size[a] - from : s->box.periodic[a] ? s->box.size[a] : from;
        double x[3] = { p->x, p->y, p->z };
        for (int k = 1; k*length <= room && is_free(s, x, a, step); k++) {
            x[a] += step;
            if (is_free(s, x, up, (down[up] < 0 ? s->box.size[up] : 0) - x[up])) return 1;
        }
    }
    return 0;
}

/* Still water presses below. */
static double pressed_from(const tobi_reference *w) { return w->level + w->cover; }

static void keep_open(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const sph_fields *f = sph_fields_of(&s->particles);
    const double least = pressed_from(&sph_of(s)->reference);
    for (int64_t i = begin; i < end; i++)
        if (f->surface_depth[i] > least && looks_out(s, i)) f->surface[i] = 1;
        else f->surface_depth[i] = 0;
}

double sph_reference_open(tobi_system *s)
{
    const tobi_reference *w = &sph_of(s)->reference;
    double middle;
    if (!(w->push > 0 && sph_of(s)->lowest > pressed_from(w))) return 0;
    tobi_loop(s->sim->exec.threads, s->particles.count, 0, keep_open, s);
    return find_low(s, &middle);
}

/* Down with the surface, but not faster than anything moves: a void that opens in the depth, as behind a
   body that sets off, is no part of it, where it does not look out. Up slowly; but a surface in the depth
   that only the first step has, where a slope cuts the lattice, is forgotten at once. */
static double follow(const tobi_system *s, double before, double low, double speed)
{
    double g = 0;
    if (!(low > 0) || !(before > 0)) return low;
    for (int a = 0; a < 3; a++) g += sph_of(s)->reference.down[a]*s->gravity[a];
    double rise = 0.1*sqrt(g*s->smoothing.spacing)*s->dt;
    if (s->step <= 2 && before - low > s->smoothing.h) return low;
    return fmin(fmax(low, before - rise), before + speed*s->dt);
}

/* Whether a body has just gone or come back: water that leaned on it is at rest no more, though no particle
   has moved yet. For the time of a fall by half a spacing, of which steps take a part. */
static int has_lost_support(const tobi_system *s)
{
    double g = 0;
    for (int a = 0; a < 3; a++) g += s->sim->def.gravity[a]*s->sim->def.gravity[a];
    const double lasting = sqrt(s->smoothing.spacing/sqrt(g));
    for (int k = 0; k < s->sim->body_count; k++)
        for (int i = 0; i < 2; i++) {
            const double since = s->sim->time - s->sim->bodies[k].absent[i];
            if (s->sim->bodies[k].absent[i] > 0 && since >= 0 && since < lasting) return 1;
        }
    return 0;
}

/* Whether what acts besides gravity is no small part of it: then no water is at rest. For good, since to
   give still water up and to take it again stirs the water. */
static int is_driven(const tobi_system *s)
{
    double g2 = 0;
    for (int a = 0; a < 3; a++) g2 += s->sim->def.gravity[a]*s->sim->def.gravity[a];
    return s->sim->acceleration_change > DRIVEN*sqrt(g2);
}

int sph_reference_begins(const tobi_system *s)
{
    const double *g = s->sim->def.gravity, *more = s->sim->acceleration.uniform;
    return vec3_dot(more, more) <= DRIVEN*DRIVEN*vec3_dot(g, g);
}

void sph_reference_move(tobi_system *s, tobi_reference *before, double low, double open, double speed,
                        double *level)
{
    sph_reference_set(s, *level);
    *before = sph_of(s)->reference;
    *level = has_lost_support(s) || is_driven(s) ? 0 : fmax(follow(s, *level, low, speed), open);
}

typedef struct referring { const tobi_system *s; int sign; } referring;

static void add_range(const void *view, int64_t begin, int64_t end, double *totals)
{
    const referring *r = view;
    const tobi_particles *p = &r->s->particles;
    const sph_fields *f = sph_fields_of(&r->s->particles);
    (void)totals;
    for (int64_t i = begin; i < end; i++) {
        const double x[3] = { p->position[i].x, p->position[i].y, p->position[i].z };
        f->pressure[i] += (float)(r->sign*tobi_reference_pressure(&sph_of(r->s)->reference, x));
    }
}

/* Adds the reference to all pressures, or takes it from them. */
static void add_reference(tobi_system *s, int sign)
{
    const referring r = { s, sign };
    if (sph_of(s)->reference.push > 0)
        tobi_launch(&s->sim->exec, TOBI_HOST(add_range, 0, 0), &r, 0, s->particles.count, NULL);
}

static void bind(tobi_system *s, sph_view *v, const sph_surface *f)
{
    sph_bind_view(s, v, *f->vessel);
    sph_reference_set(s, *f->level);
    v->reference = sph_of(s)->reference;
}

void sph_reference_follow(tobi_system *s, sph_view *v, const sph_kernels *k, const sph_surface *f)
{
    const tobi_step_info kept = s->info;
    double clock = tobi_clock();
    if (s->step > 0) add_reference(s, 1);
    *f->low = *f->level = 0;
    if (s->step == 0) *f->vessel = SPH_VESSEL_UNKNOWN;
    if (*f->vessel == SPH_VESSEL_FULL) sph_remove_gravity(s);
    if (*f->vessel != SPH_VESSEL_OPEN) return;
    bind(s, v, f);
    sph_measure_density(s, v, k, 0, &clock);
    s->info = kept;
    *f->low = f->find(s);
    if (f->rests) *f->level = *f->low;
    bind(s, v, f);
    add_reference(s, -1);
}
