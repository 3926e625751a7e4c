/* The speed that a liquid in two dimensions will have, guessed before the first step, so that the colours of
   the speed are the same in all pictures of a run. A pool that falls level turns its potential energy into
   motion; a body that moves takes water along. Drawback: bodies count as walls between pools only where they
   stand from below the liquid to above it, and take no room in them. */
#include "rigid/waves.h"
#include "world/world.h"
#include <math.h>
#include <stdlib.h>

enum { TIMES = 200, BODY_POINTS = 64 };
/* Largest speeds of dam_break_2d (0.9 of its particles are slower than 1.3), sloshing and wave_tank over the
   root mean square of all potential energy, and over that of the piston. */
static const double OVER_MEAN = 1.7, OVER_BODY = 1.5;
/* Of half a fall through the domain: a tank at rest keeps one colour. */
static const double LEAST = 0.1;

/* A rectangle of the domain in which liquid can become level. Potentials are from its lowest corner, J/kg. */
typedef struct pool {
    double lower[2], upper[2];          /* m                                                  */
    double across[2];                   /* J/kg, from side to side                            */
    double share;                       /* of the rectangle that liquid fills, 1              */
    double energy;                      /* of the liquid at the start, over all of the pool   */
    double level;                       /* J/kg, of the surface at rest                       */
} pool;

typedef struct mover { double lower[2], upper[2], least_top, most_bottom, speed; } mover;

static double potential(const tobi_world *w, const pool *p, int axis, double x)
{
    const double g = w->sim.def.gravity[axis];
    return fabs(g)*(g < 0 ? x - p->lower[axis] : p->upper[axis] - x);
}

/* Half the speed of a fall through the domain. */
static double fall_speed(const tobi_world *w)
{
    const tobi_world_def *d = &w->sim.def;
    double work = 0;
    for (int a = 0; a < d->dimension; a++) work += fabs(d->gravity[a])*(d->domain_max[a] - d->domain_min[a]);
    return 0.5*sqrt(2*work);
}

/* --- bodies that move by a motion without a program -------------------------------------------- */

static int is_mover(const tobi_body *b)
{
    return b->motion == tobi_motion_positions && tobi_motion_is_plain(b->motion_user);
}

/* Of some vertices; *next is later by `dt`, s. */
static void note_pose(mover *m, int up, int count, double (*now)[3], double (*next)[3], double dt)
{
    double top = -INFINITY, bottom = INFINITY;
    for (int k = 0; k < count; k++) {
        const double way[3] = { next[k][0] - now[k][0], next[k][1] - now[k][1], next[k][2] - now[k][2] };
        if (dt > 0) m->speed = fmax(m->speed, sqrt(way[0]*way[0] + way[1]*way[1] + way[2]*way[2])/dt);
        top = fmax(top, now[k][up]);
        bottom = fmin(bottom, now[k][up]);
    }
    m->least_top = fmin(m->least_top, top);
    m->most_bottom = fmax(m->most_bottom, bottom);
}

/* A motion that fails is told when the run comes to it. */
static mover watch_body(const tobi_world *w, const tobi_body *b, int up)
{
    enum { POINTS = 2*BODY_POINTS };
    mover m = { { INFINITY, INFINITY }, { -INFINITY, -INFINITY }, INFINITY, -INFINITY, 0 };
    const int64_t n = b->mesh.vertex_count, stride = n/BODY_POINTS + 1;
    const double step = w->sim.def.end_time/TIMES, dt = 0.01*step;
    double rest[POINTS][3], now[POINTS][3], next[POINTS][3];
    int count = 0;
    tobi_error err;
    for (int64_t i = 0; i < n; i++) {
        for (int a = 0; a < 3 && i % stride == 0; a++) rest[count][a] = b->mesh.vertices[i][a];
        count += i % stride == 0;
        for (int a = 0; a < 2; a++) {
            m.lower[a] = fmin(m.lower[a], b->mesh.vertices[i][a]);
            m.upper[a] = fmax(m.upper[a], b->mesh.vertices[i][a]);
        }
    }
    m.least_top = m.upper[up], m.most_bottom = m.lower[up];
    for (int k = 0; is_mover(b) && k <= TIMES; k++) {
        if (b->motion(b->motion_user, k*step, count, (const double (*)[3])rest, now, &err) != TOBI_OK) break;
        if (b->motion(b->motion_user, k*step + dt, count, (const double (*)[3])rest, next, &err)) break;
        note_pose(&m, up, count, now, next, dt);
    }
    return m;
}

/* --- pools -------------------------------------------------------------------------------------- */

/* Mean over a rectangle of (c - potential)^p/p! below the level c, p = 0 or 1; s: potentials across it. */
static double mean_below(double c, const double s[2], int p)
{
    const double at[4] = { c, c - s[0], c - s[1], c - s[0] - s[1] };
    double sum = 0;
    for (int k = 0; k < 4; k++) {
        const double x = fmax(at[k], 0);
        sum += (k == 0 || k == 3 ? 1 : -1)*(p ? x*x*x/6 : x*x/2);
    }
    return sum/(s[0]*s[1]);
}

/* Adds the liquid of a region that starts in the pool; returns the potential under it, or 0. */
static double add_region(const tobi_world *w, const tobi_region *r, int side, pool *p)
{
    const double low = fmax(r->lower[side], p->lower[side]), high = fmin(r->upper[side], p->upper[side]);
    double middle = 0, under = 0, area = 1;
    if (!(high > low)) return 0;
    for (int a = 0; a < 2; a++) {
        const double from = a == side ? low : r->lower[a], to = a == side ? high : r->upper[a];
        const double one = potential(w, p, a, from), other = potential(w, p, a, to);
        middle += 0.5*(one + other);
        under += fmin(one, other);
        area *= p->upper[a] - p->lower[a];
    }
    const double share = r->volume*(high - low)/(r->upper[side] - r->lower[side])/area;
    p->share += share;
    p->energy += share*middle;
    return under;
}

/* What liquid and free bodies fall by before they reach the level, J/kg. */
static double find_drop(const tobi_world *w, const pool *p, const mover *bodies, double under)
{
    double drop = fmax(under - p->level, 0);
    for (int k = 0; k < w->sim.body_count; k++) {
        if (w->sim.bodies[k].rigid.kind == TOBI_PRESCRIBED) continue;
        double low = 0;
        for (int a = 0; a < 2; a++)
            low += fmin(potential(w, p, a, bodies[k].lower[a]), potential(w, p, a, bodies[k].upper[a]));
        drop = fmax(drop, low - p->level);
    }
    return drop;
}

/* The energy that a pool gives when it becomes level, over its area, J/kg. *share: of liquid; *drop: see
   find_drop. */
static double level_pool(const tobi_world *w, pool *p, int side, const mover *bodies, double *drop)
{
    double under = 0;
    for (int k = 0; k < w->region_count; k++)
        under = fmax(under, add_region(w, &w->regions[k], side, p));
    if (!(p->share > 0)) return 0;
    for (int a = 0; a < 2; a++) p->across[a] = fabs(w->sim.def.gravity[a])*(p->upper[a] - p->lower[a]);
    const double most = p->across[0] + p->across[1], share = fmin(p->share, 1);
    for (int a = 0; a < 2; a++) p->across[a] = fmax(p->across[a], 1e-6*most);       /* no division by 0 */
    double low = 0, high = p->across[0] + p->across[1];
    for (int k = 0; k < 60; k++) {
        p->level = 0.5*(low + high);
        *(mean_below(p->level, p->across, 0) < share ? &low : &high) = p->level;
    }
    *drop = fmax(*drop, find_drop(w, p, bodies, under));
    return fmax(p->energy - (p->level*share - mean_below(p->level, p->across, 1)), 0);
}

/* A wall, or a piston: liquid stays on its side. */
static int parts_pools(const tobi_world *w, const tobi_body *b, const mover *m, int up)
{
    const double slack = 0.5*w->sim.def.spacing;
    double top = -INFINITY, bottom = INFINITY;
    if (b->rigid.kind != TOBI_PRESCRIBED || b->absent[0] > 0 || b->absent[1] > 0) return 0;
    if (b->motion && !is_mover(b)) return 0;
    for (int k = 0; k < w->region_count; k++) {
        top = fmax(top, w->regions[k].upper[up]);
        bottom = fmin(bottom, w->regions[k].lower[up]);
    }
    return m->least_top > top - slack && m->most_bottom < bottom + slack;
}

/* Where the pool that begins at `from` ends, and the next begins. */
static double end_pool(const tobi_world *w, const mover *bodies, int side, int up, double from, double *next)
{
    double end = *next = w->sim.def.domain_max[side];
    for (int k = 0; k < w->sim.body_count; k++) {
        const mover *m = &bodies[k];
        if (!parts_pools(w, &w->sim.bodies[k], m, up) || m->upper[side] <= from || m->lower[side] >= end)
            continue;
        end = fmax(m->lower[side], from);
        *next = m->upper[side];
    }
    return end;
}

/* Of all pools: the mean energy of the liquid, J/kg. */
static double level_all(const tobi_world *w, const mover *bodies, int up, double *drop)
{
    const tobi_world_def *d = &w->sim.def;
    const int side = 1 - up;
    double energy = 0, liquid = 0, next = d->domain_min[side];
    for (int k = 0; k <= w->sim.body_count && next < d->domain_max[side]; k++) {
        pool p = { .lower = { d->domain_min[0], d->domain_min[1] },
                   .upper = { d->domain_max[0], d->domain_max[1] } };
        p.lower[side] = next;
        p.upper[side] = end_pool(w, bodies, side, up, next, &next);
        const double width = p.upper[side] - p.lower[side];
        if (!(width > 0)) continue;
        energy += width*level_pool(w, &p, side, bodies, drop);
        liquid += width*p.share;
    }
    return liquid > 0 ? energy/liquid : 0;
}

/* --- the speed ---------------------------------------------------------------------------------- */

/* A world whose liquid falls level, and of whose forces nothing else is to be known. */
static int is_pool(const tobi_world *w)
{
    const tobi_world_def *d = &w->sim.def;
    for (int a = 0; a < 2; a++)
        if (d->gravity[a] != 0 && d->wall_min[a] == TOBI_WALL_PERIODIC) return 0;
    for (int k = 0; k < w->sim.body_count; k++)
        if (w->sim.bodies[k].vessel) return 0;
    return !w->drive && w->sim.opening_count == 0 && !tobi_world_solids(w);
}

/* Upwards to two digits: the numbers at the scale are short. */
static double round_up(double x)
{
    if (!(x > 0)) return 0;
    const double unit = pow(10, floor(log10(x)) - 1);
    return ceil(x/unit - 1e-6)*unit;
}

tobi_status tobi_world_expected_speed(const tobi_world *w, double *speed, tobi_error *err)
{
    const double given = fmax(tobi_world_given_speed(w), w->sim.wall_speed), fall = fall_speed(w);
    const int up = fabs(w->sim.def.gravity[0]) > fabs(w->sim.def.gravity[1]) ? 0 : 1;
    double drop = 0;
    *speed = fall > 0 ? fmax(fall, given) : 0;
    if (w->sim.def.dimension != 2) return TOBI_OK;
    mover *bodies = malloc(((size_t)w->sim.body_count + 1)*sizeof *bodies);
    if (!bodies) return tobi_fail(err, TOBI_NO_MEMORY, "picture: out of memory");
    if (is_pool(w)) *speed = fmax(given, LEAST*fall);
    for (int k = 0; k < w->sim.body_count; k++) {
        bodies[k] = watch_body(w, &w->sim.bodies[k], up);
        *speed = fmax(*speed, OVER_BODY*bodies[k].speed);
    }
    if (is_pool(w) && fall > 0) *speed = fmax(*speed, OVER_MEAN*sqrt(2*level_all(w, bodies, up, &drop)));
    if (is_pool(w) || *speed > fmax(fall, given)) *speed = round_up(fmax(*speed, sqrt(2*drop)));
    free(bodies);
    return TOBI_OK;
}
