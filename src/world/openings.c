/* Columns of particles follow one another into the domain: each column goes as far as its share of the mean
   flow, and for each spacing that it has gone one particle is new behind it. So what has come in is a whole
   number, the same for any number of threads. Drawback: columns stand still across the flow; what leaves a
   buffer sideways is lost to them and free at once. */
#include "world/openings.h"
#include "world/scalars.h"
#include "world/names.h"
#include "base/error.h"
#include "base/param.h"
#include "geom/vec3.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Phases of columns are all n-ths, one after the other some golden ratio of n on, so that mass comes in
   evenly in time and neighbours are far from each other. */
static const double GOLDEN = 0.6180339887498949;
/* s: what a new particle's velocity is the mean of. */
static const double SOON = 1e-6;

static tobi_status refuse(const tobi_opening *o, const char *key, const char *why, tobi_error *err)
{
    return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "%s '%s' %s", o->outlet ? tr("outlet") : tr("inlet"),
                                      o->name, why), "%s", key);
}

/* The same when the world starts: the key is that of a scene. */
static tobi_status refuse_start(const tobi_world *w, const tobi_opening *o, const char *key, const char *why,
                                tobi_error *err)
{
    int number = 0;
    for (const tobi_opening *k = w->sim.openings; k < o; k++) number += k->outlet == o->outlet;
    refuse(o, key, why, err);
    if (err) snprintf(err->key, sizeof err->key, "%s[%d].%s", o->outlet ? "outlets" : "inlets", number, key);
    return TOBI_INVALID;
}

/* The unit vectors of a patch. */
static tobi_status set_axes(tobi_opening *o, const double normal[3], const double along[3], int dimension,
                            tobi_error *err)
{
    static const double axes[3][3] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
    memcpy(o->normal, normal, sizeof o->normal);
    if (dimension == 2) o->normal[2] = 0;
    if (!(vec3_length(o->normal) > 0))
        return refuse(o, "normal", tr("has a normal of zero; it must have a direction"), err);
    vec3_normalize(o->normal);
    if (dimension == 2) {
        o->along[0] = -o->normal[1];
        o->along[1] = o->normal[0];
        memcpy(o->across, axes[2], sizeof o->across);
        return TOBI_OK;
    }
    const double *n = o->normal;
    int flattest = fabs(n[0]) <= fabs(n[1]) ? 0 : 1;
    if (fabs(n[2]) < fabs(n[flattest])) flattest = 2;
    memcpy(o->along, vec3_length(along) > 0 ? along : axes[flattest], sizeof o->along);
    vec3_normalize(o->along);
    vec3_add_scaled(o->along, o->along, -vec3_dot(o->along, n), n);
    if (!(vec3_length(o->along) > 1e-6))
        return refuse(o, "along", tr("has its width along its normal; allowed is across"), err);
    vec3_normalize(o->along);
    vec3_cross(o->across, o->normal, o->along);
    return TOBI_OK;
}

static tobi_status set_patch(tobi_opening *o, double width, double height, double radius, int dimension,
                             tobi_error *err)
{
    o->half[0] = 0.5*width;
    o->half[1] = dimension == 2 ? 0 : 0.5*height;
    o->radius = dimension == 2 ? 0 : radius;
    if (dimension == 2) return width > 0 ? TOBI_OK : refuse(o, "width", tr("has no width"), err);
    if ((radius > 0) == (width > 0 || height > 0))
        return refuse(o, "radius", tr("needs a width and a height, or a radius"), err);
    return radius > 0 || (width > 0 && height > 0)
        ? TOBI_OK : refuse(o, "width", tr("needs a height beside its width"), err);
}

/* A lattice over the patch; n columns into out, or only their number. */
static int64_t lay_columns(const tobi_opening *o, double d, tobi_inlet_column *out)
{
    const double side[2] = { o->radius > 0 ? o->radius : o->half[0], o->radius > 0 ? o->radius : o->half[1] };
    int64_t n[2], count = 0;
    for (int a = 0; a < 2; a++) n[a] = side[a] > 0 ? (int64_t)fmax(1, floor(2*side[a]/d + 0.5)) : 1;
    for (int64_t j = 0; j < n[1]; j++)
        for (int64_t i = 0; i < n[0]; i++) {
            const double u = side[0]*((2*(double)i + 1)/(double)n[0] - 1),
                         v = side[1]*((2*(double)j + 1)/(double)n[1] - 1);
            if (o->radius > 0 && u*u + v*v > o->radius*o->radius) continue;
            if (out) out[count] = (tobi_inlet_column){ .along = u, .across = v };
            count++;
        }
    return count;
}

static void set_phases(tobi_opening *o)
{
    const int64_t n = o->column_count;
    int64_t stride = (int64_t)(GOLDEN*(double)n + 0.5), a, b;
    for (stride = stride > 0 ? stride : 1;; stride++) {
        for (a = n, b = stride; b > 0;) {
            const int64_t rest = a%b;
            a = b;
            b = rest;
        }
        if (a == 1) break;                      /* no common divisor: each phase comes once */
    }
    for (int64_t k = 0; k < n; k++) o->columns[k].phase = ((double)(k*stride%n) + 0.5)/(double)n;
}

/* The spacing within columns makes each particle's share of the flow its volume. */
static tobi_status make_columns(tobi_opening *o, const tobi_smoothing_constants *c, tobi_error *err)
{
    double mean = 0;
    free(o->columns);
    o->column_count = lay_columns(o, c->spacing, NULL);
    o->columns = malloc((size_t)(o->column_count + 1)*sizeof *o->columns);
    if (!o->columns) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for inlet '%s'", o->name);
    lay_columns(o, c->spacing, o->columns);
    set_phases(o);
    o->scale = 1;
    for (int64_t k = 0; k < o->column_count; k++)
        mean += tobi_opening_factor(o, o->columns[k].along, o->columns[k].across)/(double)o->column_count;
    o->scale = 1/mean;
    for (int64_t k = 0; k < o->column_count; k++)
        o->columns[k].factor = tobi_opening_factor(o, o->columns[k].along, o->columns[k].across);
    o->step = c->volume*(double)o->column_count/tobi_opening_area(o, c->dimension);
    o->depth = (floor(c->h/o->step) + 2)*o->step;
    return TOBI_OK;
}

/* A place by its coordinates. */
static void place(const tobi_opening *o, double normal, double along, double across, double x[3])
{
    for (int a = 0; a < 3; a++)
        x[a] = o->centre[a] + normal*o->normal[a] + along*o->along[a] + across*o->across[a];
}

/* The patch and its buffer, corner by corner. */
static tobi_status check_place(const tobi_opening *o, const tobi_box *box, const tobi_smoothing_constants *c,
                               tobi_error *err)
{
    const double u = o->radius > 0 ? o->radius : o->half[0], v = o->radius > 0 ? o->radius : o->half[1];
    const double far = o->outlet ? tobi_outlet_depth(o, c) : -o->depth;
    char text[TOBI_NOTE];
    for (int k = 0; k < 8; k++) {
        double x[3];
        place(o, k & 4 ? far : 0, k & 1 ? u : -u, k & 2 ? v : -v, x);
        for (int a = 0; a < box->dimension; a++) {
            const double slack = 1e-6*box->size[a];
            if (x[a] >= -slack && x[a] <= box->size[a] + slack) continue;
            snprintf(text, sizeof text, tr("reaches out of the domain at %c = %.4g m: %s its plane it needs "
                     "%.4g m for a buffer of particles"), "xyz"[a], x[a] + box->lower[a],
                     o->outlet ? tr("beyond") : tr("behind"), fabs(far));
            return refuse(o, "centre", text, err);
        }
    }
    return TOBI_OK;
}

/* Particles of a column between the plane and the end of the buffer. */
static int64_t count_layers(const tobi_opening *o) { return (int64_t)(o->depth/o->step + 0.5); }

/* How far from the plane a particle of a column starts. */
static double start_of(const tobi_opening *o, const tobi_inlet_column *c, int64_t layer)
{
    return ((double)layer + c->phase)*o->step - o->depth;
}

/* A place in the buffer of an opening. */
static int is_in_buffer(const tobi_opening *o, const tobi_smoothing_constants *c, const double x[3])
{
    double at[3];
    tobi_opening_locate(o, x, at);
    return tobi_opening_faces(o, at) && (o->outlet ? at[0] > 0 && at[0] < tobi_outlet_depth(o, c)
                                                   : at[0] < 0 && at[0] > -o->depth);
}

/* Two buffers at one place would crowd it, or one takes what the other gives. */
static tobi_status check_others(const tobi_world *w, const tobi_opening *o, const double x[3],
                                tobi_error *err)
{
    char text[TOBI_NOTE];
    for (int k = 0; k < w->sim.opening_count; k++) {
        const tobi_opening *other = &w->sim.openings[k];
        if (other == o || !is_in_buffer(other, &w->system[0].smoothing, x)) continue;
        const double *lower = w->system[0].box.lower;
        snprintf(text, sizeof text, tr("has its buffer where %s '%s' has its own, at (%.4g, %.4g, %.4g) m"),
                 other->outlet ? tr("outlet") : tr("inlet"), other->name, x[0] + lower[0], x[1] + lower[1],
                 x[2] + lower[2]);
        return refuse_start(w, o, "centre", text, err);
    }
    return TOBI_OK;
}

static tobi_status check_point(const tobi_world *w, const tobi_opening *o, const double x[3],
                               tobi_error *err)
{
    char text[TOBI_NOTE];
    for (int b = 0; b < w->sim.body_count; b++) {
        if (!tobi_bvh_inside(w->sim.bodies[b].bvh, x)) continue;
        const double *lower = w->system[0].box.lower;
        snprintf(text, sizeof text, tr("lies inside body '%s' with its buffer, at (%.4g, %.4g, %.4g) m"),
                 w->sim.bodies[b].name, x[0] + lower[0], x[1] + lower[1], x[2] + lower[2]);
        return refuse(o, "centre", text, err);
    }
    return TOBI_OK;
}

/* No particle of the buffer starts inside a body: those that the world has already. */
static tobi_status check_bodies(const tobi_world *w, const tobi_opening *o, tobi_error *err)
{
    const int64_t layers = o->outlet ? 0 : count_layers(o);
    for (int64_t c = 0; c < o->column_count; c++)
        for (int64_t l = 0; l < layers; l++) {
            double x[3];
            place(o, start_of(o, &o->columns[c], l), o->columns[c].along, o->columns[c].across, x);
            TOBI_TRY(check_point(w, o, x, err));
        }
    return TOBI_OK;
}

static tobi_status check_method(const tobi_world *w, tobi_error *err)
{
    if (!w->system[0].method->solids) return TOBI_OK;
    return tobi_fail(err, TOBI_UNSUPPORTED, "%s has no inlets and outlets; the SPH methods have",
                     w->system[0].method->name);
}

static tobi_status add(tobi_world *w, const tobi_opening *o, int limit, tobi_error *err)
{
    tobi_simulation *s = &w->sim;
    int same = 0;
    for (int k = 0; k < s->opening_count; k++) same += s->openings[k].outlet == o->outlet;
    if (w->started) return tobi_fail(err, TOBI_INVALID, "a started world takes no more inlets and outlets");
    if (same >= limit) return tobi_fail(err, TOBI_UNSUPPORTED, "more than %d %s", limit,
                                        o->outlet ? tr("outlets") : tr("inlets"));
    TOBI_TRY(tobi_names_check_opening(w, o->outlet, o->name, err));
    TOBI_TRY(check_place(o, &w->system[0].box, &w->system[0].smoothing, err));
    TOBI_TRY(check_bodies(w, o, err));
    tobi_opening *more = realloc(s->openings, (size_t)(s->opening_count + 1)*sizeof *more);
    if (!more) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for an opening");
    s->openings = more;
    s->openings[s->opening_count++] = *o;
    return TOBI_OK;
}

static void set_name(tobi_opening *o, const char *name, const double centre[3], const tobi_box *box)
{
    snprintf(o->name, sizeof o->name, "%s", name ? name : "");
    for (int a = 0; a < 3; a++) o->centre[a] = a < box->dimension ? centre[a] - box->lower[a] : 0;
}

static tobi_status set_fluid(tobi_opening *o, const tobi_world *w, const char *fluid, tobi_error *err)
{
    char text[TOBI_NOTE];
    for (int f = 0; f < w->system[0].fluid_count; f++)
        if (!fluid || strcmp(w->system[0].fluid[f].name, fluid) == 0) {
            o->fluid = f;
            return TOBI_OK;
        }
    snprintf(text, sizeof text, tr("lets '%s' in, which is no fluid"), fluid ? fluid : "");
    return refuse(o, "fluid", text, err);
}

/* Mean and fastest speed. */
static tobi_status set_speed(tobi_opening *o, const tobi_world *w, const tobi_inlet_def *def, tobi_error *err)
{
    const int dimension = w->system[0].box.dimension;
    const double most = w->sim.def.speed_limit > 0 ? w->sim.def.speed_limit : TOBI_SPEED_LIMIT;
    char text[TOBI_NOTE];
    if ((def->speed > 0) + (def->flow_rate > 0) + (def->file != NULL) != 1)
        return refuse(o, "speed", tr("needs a speed, a flow_rate or a file, one of them"), err);
    if (def->file && (def->start > 0 || def->stop > 0 || def->ramp > 0))
        return refuse(o, "file", tr("has a file, which has times of its own: start, stop and ramp are not "
                      "for it"), err);
    const double area = tobi_opening_area(o, dimension);
    if (def->file) TOBI_TRY(tobi_at_key(err, tobi_opening_load_flow(o, def->file, area, err), "file"));
    else o->speed = def->speed > 0 ? def->speed : def->flow_rate/area;
    if (!(o->speed > 0)) return refuse(o, "file", tr("has a file in which nothing flows"), err);
    const double peak = o->speed*(o->parabolic ? o->radius > 0 ? 2 : dimension == 2 ? 1.5 : 2.25 : 1);
    if (peak <= most) return TOBI_OK;
    snprintf(text, sizeof text, tr("needs %.4g m/s at its fastest place for that flow; the limit is %.4g "
             "m/s: a larger patch or less flow is allowed"), peak, most);
    return refuse(o, def->speed > 0 ? "speed" : def->file ? "file" : "flow_rate", text, err);
}

static tobi_status make_inlet(const tobi_world *w, const tobi_inlet_def *def, tobi_opening *o,
                              tobi_error *err)
{
    const tobi_system *s = &w->system[0];
    *o = (tobi_opening){ .parabolic = def->profile == TOBI_PROFILE_PARABOLIC, .start = def->start,
                         .stop = def->stop, .ramp = def->ramp };
    set_name(o, def->name, def->centre, &s->box);
    TOBI_TRY(set_axes(o, def->normal, def->along, s->box.dimension, err));
    TOBI_TRY(set_patch(o, def->width, def->height, def->radius, s->box.dimension, err));
    TOBI_TRY(set_fluid(o, w, def->fluid, err));
    TOBI_TRY(set_speed(o, w, def, err));
    if (def->stop > 0 && def->stop <= def->start) return refuse(o, "stop", tr("stops before it starts"), err);
    return make_columns(o, &s->smoothing, err);
}

static void free_opening(tobi_opening *o)
{
    free(o->columns);
    free(o->rows);
}

tobi_status tobi_world_add_inlet(tobi_world *w, const tobi_inlet_def *def, tobi_error *err)
{
    tobi_opening o;
    TOBI_NEED_WORLD(w);
    TOBI_NEED(def, "the definition");
    TOBI_TRY(tobi_param_check(&tobi_inlet_table, def, err));
    TOBI_TRY(check_method(w, err));
    tobi_status status = make_inlet(w, def, &o, err);
    if (status == TOBI_OK) status = add(w, &o, TOBI_INLET_LIMIT, err);
    if (status != TOBI_OK) free_opening(&o);
    return status;
}

tobi_status tobi_world_add_outlet(tobi_world *w, const tobi_outlet_def *def, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    TOBI_NEED(def, "the definition");
    TOBI_TRY(tobi_param_check(&tobi_outlet_table, def, err));
    TOBI_TRY(check_method(w, err));
    const tobi_box *box = &w->system[0].box;
    tobi_opening o = { .outlet = 1, .level = def->level, .pressure = def->pressure };
    const int pressure = def->pressure >= 0, level = def->level > TOBI_NO_LEVEL;
    o.gives = pressure ? TOBI_GIVES_PRESSURE : level ? TOBI_GIVES_LEVEL : TOBI_GIVES_NOTHING;
    set_name(&o, def->name, def->centre, box);
    const double *g = w->sim.def.gravity;
    if (level && !(g[0]*g[0] + g[1]*g[1] + g[2]*g[2] > 0))
        return refuse(&o, "level",
                      tr("has a level, and without gravity nothing is up; allowed is a pressure"),
                      err);
    if (pressure && level)
        return refuse(&o, "pressure", tr("has a level and a pressure; it may have one"), err);
    TOBI_TRY(set_axes(&o, def->normal, def->along, box->dimension, err));
    TOBI_TRY(set_patch(&o, def->width, def->height, def->radius, box->dimension, err));
    return add(w, &o, TOBI_OUTLET_LIMIT, err);
}

void tobi_openings_free(tobi_world *w)
{
    for (int k = 0; k < w->sim.opening_count; k++) free_opening(&w->sim.openings[k]);
    free(w->sim.openings);
    free(w->chosen);
    free(w->chosen_block);
    free(w->beyond);
}

double tobi_openings_peak(const tobi_simulation *s)
{
    double peak = 0;
    for (int k = 0; k < s->opening_count; k++)
        for (int64_t c = 0; c < s->openings[k].column_count; c++)
            peak = fmax(peak, s->openings[k].speed*s->openings[k].columns[c].factor);
    return peak;
}

/* --- the start ------------------------------------------------------------------------------- */

int64_t tobi_openings_count(const tobi_world *w)
{
    int64_t count = 0;
    for (int k = 0; k < w->sim.opening_count; k++)
        if (!w->sim.openings[k].outlet)
            count += w->sim.openings[k].column_count*count_layers(&w->sim.openings[k]);
    return count;
}

int tobi_openings_cover(const tobi_simulation *s, const double x[3])
{
    for (int k = 0; k < s->opening_count; k++) {
        const tobi_opening *o = &s->openings[k];
        double at[3];
        tobi_opening_locate(o, x, at);
        if (!tobi_opening_faces(o, at)) continue;
        if (!o->outlet && at[0] < 0 && at[0] >= -TOBI_OPENING_BEHIND*o->depth) return 1;
    }
    return 0;
}

/* A new particle of a column at a distance from the plane. */
static void put(tobi_system *s, const tobi_opening *o, const tobi_inlet_column *c, double at, double t,
                int64_t i)
{
    tobi_particles *p = &s->particles;
    double x[3];
    place(o, at, c->along, c->across, x);
    p->position[i] = (tobi_double3){ x[0], x[1], x[2] };
    const double u = tobi_opening_speed(o, t, SOON)*c->factor;
    for (int a = 0; a < 3; a++) (&p->velocity[i].x)[a] = (float)(u*o->normal[a]);
    p->fluid[i] = (uint8_t)o->fluid;
}

/* Where liquid lies at one side of a patch alone, it is before an outlet, and not behind an inlet: regions
   leave out what is near behind an inlet, so that more of it counts there. */
static tobi_status check_side(const tobi_world *w, const tobi_opening *o, tobi_error *err)
{
    const tobi_particles *p = &w->system[0].particles;
    const double reach = o->outlet ? 2*w->system[0].smoothing.h : (TOBI_OPENING_BEHIND + 1)*o->depth;
    int64_t behind = 0, ahead = 0;
    for (int64_t i = 0; i < p->count; i++) {
        const double x[3] = { p->position[i].x, p->position[i].y, p->position[i].z };
        double at[3];
        tobi_opening_locate(o, x, at);
        if (!tobi_opening_faces(o, at) || fabs(at[0]) > reach) continue;
        if (at[0] < 0) behind++;
        else ahead++;
    }
    if (o->outlet ? behind > 0 || ahead == 0 : ahead > 0 || behind == 0) return TOBI_OK;
    return refuse_start(w, o, "normal", o->outlet
                        ? tr("faces inwards: liquid lies on the side that its normal points "
                             "to, and none on the other")
                        : tr("faces away from the liquid, which lies behind it: its normal is the way that "
                             "liquid goes"), err);
}

tobi_status tobi_openings_fill(tobi_world *w, tobi_error *err)
{
    tobi_system *s = &w->system[0];
    for (int k = 0; k < w->sim.opening_count; k++) {
        tobi_opening *o = &w->sim.openings[k];
        if (!o->outlet) TOBI_TRY(make_columns(o, &s->smoothing, err));
        TOBI_TRY(check_side(w, o, err));
        if (o->outlet) continue;
        TOBI_TRY(check_place(o, &s->box, &s->smoothing, err));
        TOBI_TRY(check_bodies(w, o, err));
        const int64_t layers = count_layers(o);
        for (int64_t c = 0; c < o->column_count; c++)
            for (int64_t l = 0; l < layers; l++) {
                const int64_t i = tobi_particles_add(&s->particles);
                put(s, o, &o->columns[c], start_of(o, &o->columns[c], l), w->sim.time, i);
                tobi_scalars_place(s, i, k);
                const tobi_double3 *p = &s->particles.position[i];
                TOBI_TRY(check_others(w, o, (double[3]){ p->x, p->y, p->z }, err));
            }
    }
    return TOBI_OK;
}

/* --- a step ---------------------------------------------------------------------------------- */

/* Through any outlet. */
static int is_gone(const tobi_system *s, const void *none, int64_t i)
{
    const tobi_simulation *w = s->sim;
    (void)none;
    const tobi_double3 *p = &s->particles.position[i];
    const double x[3] = { p->x, p->y, p->z };
    for (int k = 0; k < w->opening_count; k++) {
        const tobi_opening *o = &w->openings[k];
        double at[3];
        if (!o->outlet) continue;
        tobi_opening_locate(o, x, at);
        if (at[0] > tobi_outlet_depth(o, &s->smoothing) && tobi_opening_faces(o, at)) return 1;
    }
    return 0;
}

/* Blocks of rows: how many of each are wanted; or, with their first place in the list, which. */
typedef struct choosing {
    const tobi_system *s;
    tobi_opening_wants wants;
    const void *o;
    int64_t *block;
    int32_t *row;
} choosing;

static void choose_range(const void *view, int64_t begin, int64_t end)
{
    const choosing *l = view;
    for (int64_t b = begin; b < end; b++) {
        const int64_t from = b*TOBI_BLOCK, to = from + TOBI_BLOCK, n = l->s->particles.count;
        int64_t found = l->row ? l->block[b] : 0;
        for (int64_t i = from; i < to && i < n; i++) {
            if (!l->wants(l->s, l->o, i)) continue;
            if (l->row) l->row[found] = (int32_t)i;
            found++;
        }
        if (!l->row) l->block[b] = found;
    }
}

static tobi_status grow(void **p, int64_t *room, int64_t need, size_t size, tobi_error *err)
{
    if (need <= *room) return TOBI_OK;
    void *more = realloc(*p, (size_t)(need + need/2 + 64)*size);
    if (!more)
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld particles at openings", (long long)need);
    *p = more;
    *room = need + need/2 + 64;
    return TOBI_OK;
}

tobi_status tobi_openings_choose(tobi_world *w, tobi_opening_wants wants, const tobi_opening *o,
                                 int64_t *count, tobi_error *err)
{
    return tobi_rows_choose(w, &w->system[0], wants, o, count, err);
}

tobi_status tobi_rows_choose(tobi_world *w, const tobi_system *s, tobi_opening_wants wants, const void *o,
                             int64_t *count, tobi_error *err)
{
    const int64_t blocks = (s->particles.count + TOBI_BLOCK - 1)/TOBI_BLOCK;
    TOBI_TRY(grow((void **)&w->chosen_block, &w->chosen_blocks, blocks + 1, sizeof *w->chosen_block, err));
    choosing l = { s, wants, o, w->chosen_block, NULL };
    tobi_loop(w->sim.exec.threads, blocks, 8, choose_range, &l);
    *count = tobi_scan(&w->sim.exec, blocks, w->chosen_block);
    if (*count == 0) return TOBI_OK;
    TOBI_TRY(grow((void **)&w->chosen, &w->chosen_room, *count, sizeof *w->chosen, err));
    l.row = w->chosen;
    tobi_loop(w->sim.exec.threads, blocks, 8, choose_range, &l);
    return TOBI_OK;
}

static tobi_status remove_rows(tobi_world *w, tobi_error *err)
{
    tobi_system *s = &w->system[0];
    int64_t gone;
    int outlets = 0;
    for (int k = 0; k < w->sim.opening_count; k++) outlets += w->sim.openings[k].outlet;
    if (outlets == 0) return TOBI_OK;
    TOBI_TRY(tobi_openings_choose(w, is_gone, NULL, &gone, err));
    if (gone == 0) return TOBI_OK;
    tobi_particles_remove(&s->particles, w->chosen, gone);
    s->info.particles_out += gone;
    return TOBI_OK;
}

/* Particles that a column has let in when the mean flow has gone `way`. */
static int64_t count_in(const tobi_opening *o, const tobi_inlet_column *c, double way)
{
    return (int64_t)floor(way*c->factor/o->step + c->phase);
}

/* Of an inlet: what follows at the end of its buffer. */
static tobi_status follow(tobi_world *w, tobi_opening *o, tobi_error *err)
{
    tobi_system *s = &w->system[0];
    const double next = tobi_opening_way(o, w->sim.time);
    int64_t count = 0, row;
    for (int64_t c = 0; c < o->column_count; c++)
        count += count_in(o, &o->columns[c], next) - count_in(o, &o->columns[c], o->way);
    if (count > 0) TOBI_TRY(tobi_system_insert(s, count, &row, err));
    for (int64_t c = 0; c < o->column_count && count > 0; c++) {
        const tobi_inlet_column *col = &o->columns[c];
        const int64_t last = count_in(o, col, next);
        const double gone = next*col->factor/o->step + col->phase;
        for (int64_t n = count_in(o, col, o->way) + 1; n <= last; n++, row++) {
            put(s, o, col, (gone - (double)n)*o->step - o->depth, w->sim.time, row);
            tobi_scalars_place(s, row, (int)(o - w->sim.openings));
        }
    }
    o->way = next;
    s->info.particles_in += count;
    return TOBI_OK;
}

tobi_status tobi_openings_pass(tobi_world *w, tobi_error *err)
{
    tobi_system *s = &w->system[0];
    if (w->sim.opening_count == 0) return TOBI_OK;
    TOBI_TRY(remove_rows(w, err));
    for (int k = 0; k < w->sim.opening_count; k++)
        if (!w->sim.openings[k].outlet) TOBI_TRY(follow(w, &w->sim.openings[k], err));
    TOBI_TRY(tobi_openings_give(w, err));
    const double mass = s->smoothing.volume*s->fluid[0].density;
    s->info.mass_in = mass*(double)s->info.particles_in;
    s->info.mass_out = mass*(double)s->info.particles_out;
    s->info.fluid_particles = s->particles.count;
    return tobi_openings_check_room(w, err);
}

void tobi_openings_get(const tobi_world *w, double way[TOBI_OPENING_LIMIT])
{
    for (int k = 0; k < w->sim.opening_count; k++) way[k] = w->sim.openings[k].way;
}

void tobi_openings_set(tobi_world *w, const double way[TOBI_OPENING_LIMIT])
{
    for (int k = 0; k < w->sim.opening_count; k++) w->sim.openings[k].way = way[k];
}
