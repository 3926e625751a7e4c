/* A world becomes a nest: what it takes, where its box is (docs/decisions/0157-nests.md). Drawback: bodies
   outside of the box are moved in the nest too. */
#include "world/nest.h"
#include "base/error.h"
#include "base/param.h"
#include "geom/vec3.h"
#include "sph/nest.h"
#include "world/openings.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Largest over least density: pressures that are given beside a light fluid are too much for the solve. */
static const double DENSITY_RATIO = 2;
/* Outer spacings: the shortest side of a box. */
static const double LEAST = 4;

double tobi_nest_rim(const tobi_system *s)
{
    static const double RIM = 2;      /* support radii */
    return RIM*s->smoothing.h;
}

int tobi_nest_takes(const tobi_system *s, const double x[3])
{
    return !s->sim->nest.outer || tobi_nest_covers(&s->sim->nest, s->box.dimension, x);
}

int64_t tobi_nest_share(const tobi_world *w, int64_t particles)
{
    const tobi_nest *n = &w->sim.nest;
    const tobi_system *s = &w->system[0];
    double most = 1;
    if (!n->outer) return particles;
    for (int a = 0; a < s->box.dimension; a++) {
        const double low = fmax(n->lower[a] - n->rim, 0), high = fmin(n->upper[a] + n->rim, s->box.size[a]);
        most *= fmax(high - low, 0)/s->smoothing.spacing + 2*(w->region_count + 1);
    }
    return (int64_t)fmin((double)particles, most);
}

static tobi_status refuse(const char *key, const tobi_nest_def *def, const char *why, tobi_error *err)
{
    return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "nest '%s': %s", def->name, why), "%s", key);
}

int tobi_nest_name_fits(const char *name)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
    return name && *name && strlen(name) <= 63 && strspn(name, letters) == strlen(name);
}

static tobi_status check_box(const tobi_world *outer, const tobi_nest_def *def, tobi_error *err)
{
    const tobi_box *box = &outer->system[0].box;
    char why[200];
    for (int a = 0; a < box->dimension; a++) {
        const double low = box->lower[a], high = low + box->size[a], slack = 1e-9*box->size[a];
        const double side = def->box_max[a] - def->box_min[a], d = outer->sim.def.spacing;
        if (def->box_min[a] < low - slack || def->box_max[a] > high + slack) {
            snprintf(why, sizeof why, tr("the box reaches from %.6g to %.6g m in %c, the domain from %.6g to "
                     "%.6g m"), def->box_min[a], def->box_max[a], "xyz"[a], low, high);
            return refuse(def->box_min[a] < low - slack ? "box.min" : "box.max", def, why, err);
        }
        if (side >= LEAST*d) continue;
        snprintf(why, sizeof why, tr("the box is %.6g m long in %c; allowed are %g spacings of the scene, "
                                     "%.6g m, or more"), side, "xyz"[a], LEAST, LEAST*d);
        return refuse("box.max", def, why, err);
    }
    return TOBI_OK;
}

/* Liquid goes from one side of a period to the other: a box has all of it, or none of either side. */
static tobi_status check_periods(const tobi_nest *n, const tobi_box *box, const tobi_nest_def *def,
                                 tobi_error *err)
{
    char why[200];
    for (int a = 0; a < box->dimension; a++) {
        const int low = !isfinite(n->lower[a]), high = !isfinite(n->upper[a]);
        if (!box->periodic[a] || low == high) continue;
        snprintf(why, sizeof why, tr("the box meets one of the two periodic sides in %c; allowed is one that "
                 "meets both, or stays %.4g m away from them"), "xyz"[a], n->rim);
        return refuse(low ? "box.min" : "box.max", def, why, err);
    }
    return TOBI_OK;
}

static tobi_status check_bodies(const tobi_world *w, const tobi_nest_def *def, tobi_error *err)
{
    for (int b = 0; b < w->sim.body_count; b++)
        if (w->sim.bodies[b].rigid.kind != TOBI_PRESCRIBED)
            return tobi_fail(err, TOBI_UNSUPPORTED, "nest '%s': body '%s' moves by forces; in a nest it has "
                             "a motion, such as that of the outer world", def->name, w->sim.bodies[b].name);
    return TOBI_OK;
}

static tobi_status check_worlds(const tobi_world *w, const tobi_world *outer, const tobi_nest_def *def,
                                tobi_error *err)
{
    const tobi_world_def *in = &w->sim.def, *out = &outer->sim.def;
    int same = in->dimension == out->dimension && w->system[0].method == outer->system[0].method &&
               w->system[0].fluid_count == outer->system[0].fluid_count;
    for (int a = 0; a < in->dimension; a++)
        same &= in->domain_min[a] == out->domain_min[a] && in->domain_max[a] == out->domain_max[a];
    if (w->started) return tobi_fail(err, TOBI_INVALID, "a started world becomes no nest");
    if (tobi_nest_count(outer) == TOBI_NEST_LIMIT)
        return tobi_fail(err, TOBI_INVALID, "nest '%s': a world has %d nests or fewer", def->name,
                         TOBI_NEST_LIMIT);
    if (outer->sim.nest.outer)
        return tobi_fail(err, TOBI_UNSUPPORTED, "nest '%s': the outer world is a nest itself", def->name);
    if (!outer->system[0].method->nests)
        return tobi_fail(err, TOBI_UNSUPPORTED, "nest '%s': the method %s has no nests; isph and dfsph have",
                         def->name, outer->system[0].method->name);
    if (outer->system_count > 1)
        return tobi_fail(err, TOBI_UNSUPPORTED, "nest '%s': there are solids; nests are for liquids alone",
                         def->name);
    if (tobi_system_density_ratio(&w->system[0]) > DENSITY_RATIO)
        return tobi_fail(err, TOBI_UNSUPPORTED, "nest '%s': the densities of the fluids are 1 : %.6g; a nest "
                         "takes fluids up to 1 : %g", def->name, tobi_system_density_ratio(&w->system[0]),
                         DENSITY_RATIO);
    if (!same)
        return tobi_fail(err, TOBI_INVALID, "nest '%s': domain, method and fluids must be those of the outer "
                         "world", def->name);
    if (fabs(in->spacing*def->refinement/out->spacing - 1) > 1e-9)
        return tobi_fail(err, TOBI_INVALID, "nest '%s': its spacing is %.9g m; %d times smaller than that of "
                         "the outer world is %.9g m", def->name, in->spacing, def->refinement,
                         out->spacing/def->refinement);
    if (w->sim.opening_count)
        return tobi_fail(err, TOBI_UNSUPPORTED, "nest '%s': a nest has no inlets and outlets", def->name);
    return check_bodies(w, def, err);
}

/* The buffers of the outer world are its own. */
static tobi_status check_openings(const tobi_world *outer, const tobi_nest *n, const tobi_nest_def *def,
                                  tobi_error *err)
{
    const tobi_system *s = &outer->system[0];
    char why[240];
    for (int k = 0; k < outer->sim.opening_count; k++) {
        const tobi_opening *o = &outer->sim.openings[k];
        const double wide = o->radius > 0 ? o->radius : hypot(o->half[0], o->half[1]);
        const double reach = wide + (o->outlet ? tobi_outlet_depth(o, &s->smoothing) : o->depth);
        if (tobi_nest_outside(n, s->box.dimension, o->centre) > n->rim + reach) continue;
        snprintf(why, sizeof why, tr("%s '%s' may lie in the box or within %.4g m of it, where the nest has "
                                     "no inlets and outlets"),
                 o->outlet ? tr("outlet") : tr("inlet"), o->name, n->rim + reach);
        return refuse("box.min", def, why, err);
    }
    return TOBI_OK;
}

void tobi_nest_middle(const tobi_simulation *outer, int body, double middle[3])
{
    const tobi_body *b = &outer->bodies[body];
    double low[3] = { INFINITY, INFINITY, INFINITY }, high[3] = { -INFINITY, -INFINITY, -INFINITY };
    for (int64_t v = 0; v < b->mesh.vertex_count; v++)
        for (int a = 0; a < 3; a++) {
            low[a] = fmin(low[a], b->vertex[v][a]);
            high[a] = fmax(high[a], b->vertex[v][a]);
        }
    for (int a = 0; a < 3; a++) middle[a] = 0.5*(low[a] + high[a]) - (b->is_absent ? b->away[a] : 0);
}

/* The box, a way from where it was at time 0. */
static void place(tobi_nest *n, const tobi_box *box, const double way[3])
{
    double at[2][3], domain[2][3] = { { 0 } };
    for (int a = 0; a < 3; a++) {
        at[0][a] = n->start[0][a] + way[a];
        at[1][a] = n->start[1][a] + way[a];
        domain[1][a] = box->size[a];
    }
    tobi_nest_open_sides(at, (const double (*)[3])domain, n->rim, box->dimension);
    memcpy(n->lower, at[0], sizeof n->lower);
    memcpy(n->upper, at[1], sizeof n->upper);
}

static tobi_status find_body(const tobi_world *outer, const tobi_nest_def *def, tobi_nest *n, tobi_error *err)
{
    char why[120];
    n->body = def->follow ? tobi_world_find_body(outer, def->follow) : -1;
    if (n->body >= 0) tobi_nest_middle(&outer->sim, n->body, n->middle);
    if (n->body >= 0 || !def->follow) return TOBI_OK;
    snprintf(why, sizeof why, tr("there is no body '%.60s' to follow"), def->follow);
    return refuse("follow", def, why, err);
}

tobi_status tobi_world_nest(tobi_world *w, tobi_world *outer, const tobi_nest_def *def, tobi_error *err)
{
    static const double none[3] = { 0 };
    TOBI_NEED_WORLD(w);
    TOBI_NEED_WORLD(outer);
    TOBI_NEED(def, "the definition");
    TOBI_TRY(tobi_param_check(&tobi_nest_table, def, err));
    if (!tobi_nest_name_fits(def->name))
        return refuse("name", def, tr("it names a folder: allowed are letters, digits, _ and -"), err);
    TOBI_TRY(check_worlds(w, outer, def, err));
    TOBI_TRY(check_box(outer, def, err));
    const tobi_box *box = &w->system[0].box;
    tobi_nest n = { .outer = &outer->system[0], .rim = tobi_nest_rim(&w->system[0]) };
    for (int a = 0; a < 3; a++) {
        n.start[0][a] = def->box_min[a] - box->lower[a];
        n.start[1][a] = def->box_max[a] - box->lower[a];
    }
    place(&n, box, none);
    TOBI_TRY(find_body(outer, def, &n, err));
    TOBI_TRY(check_periods(&n, box, def, err));
    TOBI_TRY(check_openings(outer, &n, def, err));
    w->sim.nest = n;
    w->outer = outer;
    tobi_nest_join(w);
    w->feeds = def->feedback;
    return TOBI_OK;
}

static void remember_range(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    for (int64_t i = begin; i < end; i++) s->sim->before[s->particles.id[i]] = s->particles.velocity[i];
}

tobi_status tobi_nest_remember(tobi_world *w, tobi_error *err)
{
    tobi_simulation *s = &w->sim;
    if (!w->first_nest) return TOBI_OK;
    if (s->next_id > s->before_room) {
        const int64_t room = s->next_id + s->next_id/2;
        tobi_float4 *more = realloc(s->before, (size_t)room*sizeof *more);
        if (!more) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a nest");
        s->before = more;
        s->before_room = room;
    }
    tobi_loop(s->exec.threads, w->system[0].particles.count, 0, remember_range, &w->system[0]);
    return TOBI_OK;
}

tobi_status tobi_world_feed(tobi_world *w, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    if (!w->outer) return tobi_fail(err, TOBI_INVALID, "the world is no nest, so that no other is fed by it");
    tobi_nest_press(w, w->outer);
    if (!w->feeds || w->system[0].particles.count == 0) return TOBI_OK;
    sph_nest_feed(&w->system[0], &w->outer->system[0]);
    w->outer->fresh = 0;
    return TOBI_OK;
}

void tobi_nest_follow(tobi_world *w)
{
    tobi_nest *n = &w->sim.nest;
    double middle[3], way[3];
    if (!n->outer || n->body < 0) return;
    tobi_nest_middle(n->outer->sim, n->body, middle);
    vec3_sub(way, middle, n->middle);
    place(n, &w->system[0].box, way);
}

/* Of a swimmer: along the straight way from where a place was when the outer step began to where it is. */
static tobi_status follow_swimmer(const tobi_simulation *s, const tobi_body *b, double t, int64_t n,
                                  const double (*rest)[3], double (*position)[3], tobi_error *err)
{
    const double share = s->dt > 0 ? (t - s->time)/s->dt : 0;      /* -1 when it began */
    TOBI_TRY(tobi_body_locate(b, s->time, n, rest, position, err));
    if (!(share < 0)) return TOBI_OK;
    double (*start)[3] = malloc((size_t)(n + 1)*sizeof *start), way[3];
    if (!start) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a nest");
    const tobi_status status = tobi_body_locate_start(b, s->time - s->dt, n, rest, start, err);
    for (int64_t k = 0; k < n && status == TOBI_OK; k++) {
        vec3_sub(way, position[k], start[k]);
        vec3_add_scaled(position[k], position[k], share, way);
    }
    free(start);
    return status;
}

tobi_status tobi_nest_motion(void *user, double t, int64_t n, const double (*rest)[3], double (*position)[3],
                             tobi_error *err)
{
    const tobi_nest_body *at = user;
    const tobi_simulation *s = &at->outer->sim;
    const tobi_body *b = &s->bodies[at->body];
    const tobi_rigid *r = &b->rigid;
    const double late = t - s->time;
    double turn[3], orientation[4], m[3][3];
    if (b->swimmer) return follow_swimmer(s, b, t, n, rest, position, err);
    memcpy(orientation, r->orientation, sizeof orientation);
    for (int a = 0; a < 3; a++) turn[a] = late*r->angular_velocity[a];
    tobi_quaternion_turn(orientation, turn);
    tobi_quaternion_matrix(orientation, m);
    for (int64_t k = 0; k < n; k++)
        for (int a = 0; a < 3; a++) {
            double x = r->position[a] + b->lower[a] + late*r->velocity[a];
            for (int c = 0; c < 3; c++) x += m[a][c]*(rest[k][c] - b->rest.centre[c]);
            position[k][a] = x;
        }
    return TOBI_OK;
}
