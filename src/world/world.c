/* A world: definitions become a simulation, the method steps it. */
#include "world/world.h"
#include "base/error.h"
#include "rigid/dynamics.h"
#include "world/bodies.h"
#include "world/fit.h"
#include "world/limits.h"
#include "world/note_pieces.h"
#include "world/params.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

const char *tobi_version(void) { return TOBI_VERSION; }

const char *tobi_status_text(tobi_status status)
{
    switch (status) {
#define X(code, text) case code: return text;
    TOBI_STATUS_LIST(X)
#undef X
    }
    return "unknown status";
}

static double length(const double v[3]) { return sqrt(v[0]*v[0] + v[1]*v[1] + v[2]*v[2]); }

/* A side moves along itself, and only where the fluid sticks to it. */
static tobi_status check_side(const double v[3], int axis, int wall, int dimension, tobi_error *err)
{
    if (!(length(v) > 0)) return TOBI_OK;
    if (wall != TOBI_WALL_NO_SLIP)
        return tobi_fail(err, TOBI_INVALID, "domain: a side along %c has a velocity but is not no-slip",
                         "xyz"[axis]);
    if (v[axis] != 0 || (dimension == 2 && v[2] != 0))
        return tobi_fail(err, TOBI_INVALID,
                         "domain: a side along %c moves by (%g, %g, %g) m/s, allowed is along itself",
                         "xyz"[axis], v[0], v[1], v[2]);
    return TOBI_OK;
}

static tobi_status check_world(const tobi_world_def *d, tobi_error *err)
{
    TOBI_TRY(tobi_param_check(&tobi_world_table, d, err));
    for (int a = 0; a < d->dimension; a++) {
        if (!(d->domain_max[a] > d->domain_min[a]))
            return tobi_fail(err, TOBI_INVALID, "domain: max %g is not above min %g along %c",
                             d->domain_max[a], d->domain_min[a], "xyz"[a]);
        if ((d->wall_min[a] == TOBI_WALL_PERIODIC) != (d->wall_max[a] == TOBI_WALL_PERIODIC))
            return tobi_fail(err, TOBI_INVALID,
                             "domain: only one side along %c is periodic; both or none are allowed",
                             "xyz"[a]);
        TOBI_TRY(check_side(d->wall_velocity_min[a], a, d->wall_min[a], d->dimension, err));
        TOBI_TRY(check_side(d->wall_velocity_max[a], a, d->wall_max[a], d->dimension, err));
    }
    return TOBI_OK;
}

static tobi_status check_limits(const tobi_world_def *d, const tobi_method *method, tobi_error *err)
{
    tobi_error why = { 0 };
    const char *key;
    tobi_status status = tobi_limits_check(d, (method->fields & TOBI_SPH) != 0, &key, &why);
    return status ? tobi_fail(err, status, "world: %s %s", key, why.text) : TOBI_OK;
}

static tobi_status check_open(const tobi_world_def *d, const tobi_method *method, tobi_error *err)
{
    for (int a = 0; a < d->dimension; a++)
        if ((d->wall_min[a] == TOBI_WALL_OPEN || d->wall_max[a] == TOBI_WALL_OPEN) &&
            !(method->fields & TOBI_MPM))
            return tobi_fail(err, TOBI_UNSUPPORTED,
                             "domain: a side along %c is open, which %s does not know; mlsmpm does", "xyz"[a],
                             method->name);
    return TOBI_OK;
}

/* Whether the regions fill the domain: not half a layer of particles is missing over its smallest side. */
static int is_full_vessel(const tobi_world *w)
{
    const tobi_world_def *d = &w->sim.def;
    double domain = 1, longest = 0, filled = 0;
    for (int a = 0; a < d->dimension; a++) {
        double side = d->domain_max[a] - d->domain_min[a];
        domain *= side;
        longest = fmax(longest, side);
    }
    for (int k = 0; k < w->region_count; k++) filled += w->regions[k].volume;
    return filled > domain*(1 - 0.5*d->spacing/longest);
}

/* Whether a body or a side moves in a full vessel. */
static int is_stirred_vessel(const tobi_world *w)
{
    int stirred = w->sim.wall_speed > 0 || tobi_body_any_free(w->sim.bodies, w->sim.body_count);
    for (int k = 0; k < w->sim.body_count; k++) stirred |= w->sim.bodies[k].motion != NULL;
    return stirred && is_full_vessel(w);
}

/* The kernel, and the box whose cells follow its support. Final when all regions and bodies are known. */
static void set_smoothing(tobi_world *w)
{
    tobi_simulation *s = &w->sim;
    const tobi_world_def *d = &s->def;
    int shape, periodic[3];
    double support;
    w->method->smoothing(w->method_def, is_stirred_vessel(w), &shape, &support);
    const double spacing = tobi_fit_find(w, d->spacing).spacing;
    if (s->smoothing.h == support*spacing) return;
    tobi_smoothing_init(&s->smoothing, shape, d->dimension, spacing, support);
    for (int a = 0; a < 3; a++) periodic[a] = d->wall_min[a] == TOBI_WALL_PERIODIC;
    tobi_box_init(&s->box, d->dimension, d->domain_min, d->domain_max, periodic, s->smoothing.h);
}

static tobi_status create_simulation(tobi_world *w, const tobi_world_def *def, tobi_error *err)
{
    tobi_simulation *s = &w->sim;
    s->def = *def;
    if (def->dimension == 2) s->def.gravity[2] = 0;
    memcpy(s->gravity, s->def.gravity, sizeof s->gravity);
    TOBI_TRY(tobi_exec_init(&s->exec, def->threads, err));
    for (int a = 0; a < def->dimension; a++)
        s->wall_speed = fmax(s->wall_speed, fmax(length(def->wall_velocity_min[a]),
                                                 length(def->wall_velocity_max[a])));
    set_smoothing(w);
    return TOBI_OK;
}

tobi_status tobi_world_create(const tobi_world_def *def, const void *method_def, tobi_world **world,
                              tobi_error *err)
{
    TOBI_NEED(world, "where the world goes");
    *world = NULL;
    TOBI_NEED(def, "the definition");
    TOBI_TRY(check_world(def, err));
    const tobi_method *method = tobi_method_find(def->method);
    if (!method)
        return tobi_fail(err, TOBI_INVALID, "there is no method '%s'; known is %s",
                         def->method ? def->method : "", tobi_method_at(0)->name);
    TOBI_TRY(check_open(def, method, err));
    TOBI_TRY(check_limits(def, method, err));
    const tobi_param_table *table = tobi_method_table(method->name);
    tobi_world *w = calloc(1, sizeof *w);
    void *params = calloc(1, method->def_size);
    if (!w || !params) {
        free(w);
        free(params);
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a world");
    }
    w->alive = TOBI_ALIVE;
    tobi_param_defaults(table, params);
    if (method_def) memcpy(params, method_def, method->def_size);
    w->method = method;
    w->method_def = params;
    tobi_status status = tobi_param_check(table, params, err);
    if (status == TOBI_OK) status = create_simulation(w, def, err);
    if (status != TOBI_OK) {
        tobi_world_destroy(w);
        return status;
    }
    *world = w;
    return TOBI_OK;
}

void tobi_world_destroy(tobi_world *w)
{
    if (!w) return;
    assert(w->alive == TOBI_ALIVE);
    w->alive = 0;
    if (w->method_state) w->method->free(w->method_state);
    tobi_rigid_free(w->dynamics);
    for (int k = 0; k < w->sim.body_count; k++) tobi_body_free(&w->sim.bodies[k]);
    for (int k = 0; k < w->region_count; k++) tobi_mesh_free(&w->regions[k].shape);
    free(w->sim.bodies);
    free(w->sim.solids);
    free(w->regions);
    free(w->probes);
    for (int k = 0; k < w->note_count; k++) free(w->notes[k]);
    free(w->notes);
    free(w->texture);
    free(w->row_of);
    tobi_world_free_grid(w);
    tobi_pieces_free(&w->pieces);
    free(w->method_def);
    tobi_near_free(&w->sim.near);
    tobi_contact_free(&w->sim.contacts);
    tobi_cells_free(&w->sim.cells);
    tobi_particles_free(&w->sim.particles);
    tobi_exec_free(&w->sim.exec);
    free(w);
}

tobi_status tobi_world_add_notes(tobi_world *w, const char *kind, const char *name, const char *notes,
                                 tobi_error *err)
{
    for (const char *end; (end = strchr(notes, '\n')) != NULL; notes = end + 1) {
        char **more = realloc(w->notes, (size_t)(w->note_count + 1)*sizeof *more);
        size_t room = (size_t)(end - notes) + strlen(kind) + strlen(name ? name : "") + 8;
        char *text = malloc(room);
        if (more) w->notes = more;
        if (!more || !text) {
            free(text);
            return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a note");
        }
        snprintf(text, room, name ? "%s '%s': %.*s" : "%s %s%.*s", kind, name ? name : "", (int)(end - notes),
                 notes);
        w->notes[w->note_count++] = text;
    }
    return TOBI_OK;
}

const char *tobi_world_note(const tobi_world *w, int note)
{
    return w && note >= 0 && note < w->note_count ? w->notes[note] : NULL;
}

static tobi_status check_body(const tobi_world *w, const tobi_body *b, tobi_error *err)
{
    const tobi_box *box = &w->sim.box;
    for (int64_t i = 0; i < b->mesh.vertex_count; i++)
        for (int a = 0; a < box->dimension; a++)
            if (!box->periodic[a] && (b->vertex[i][a] < 0 || b->vertex[i][a] > box->size[a]))
                return tobi_fail(err, TOBI_INVALID,
                                 "body '%s' sticks out of the domain: a vertex is at %c = %g m, "
                                 "allowed is %g to %g m",
                                 b->name, "xyz"[a], b -> vertex[i][a] + box -> lower[a],
                                 box -> lower[a], box -> lower[a] + box -> size[a]);
    return TOBI_OK;
}

tobi_status tobi_world_add_body(tobi_world *w, const tobi_body_def *def, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    TOBI_NEED(def, "the definition");
    tobi_simulation *s = &w->sim;
    if (w->started) return tobi_fail(err, TOBI_INVALID, "a started world takes no more bodies");
    TOBI_TRY(tobi_param_check(&tobi_body_table, def, err));
    if (def->blade && !(w->method->fields & TOBI_MPM))
        return tobi_fail(err, TOBI_UNSUPPORTED,
                         "body '%s' is a blade, which the method %s does not know; "
                         "blades cut solids of mlsmpm",
                         def->name ? def->name : "", w->method->name);
    if (s->body_count == TOBI_BODY_LIMIT)
        return tobi_fail(err, TOBI_UNSUPPORTED, "more than %d bodies", TOBI_BODY_LIMIT);
    tobi_body *more = realloc(s->bodies, (size_t)(s->body_count + 1)*sizeof *more);
    if (!more) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a body");
    s->bodies = more;
    tobi_body *b = &s->bodies[s->body_count];
    /* Only SPH methods integrate over surfaces. */
    double pieces = (w->method->fields & TOBI_SPH ? 0.5 : 1e3)*s->def.spacing;
    tobi_body_def placed = *def;
    if (!(def->spacing > 0)) placed.spacing = s->def.spacing;
    TOBI_TRY(tobi_body_create(b, &placed, &s->box, pieces, err));
    tobi_status status = check_body(w, b, err);
    if (status == TOBI_OK) status = tobi_world_add_notes(w, "body", b->name, b->mesh.notes, err);
    if (status != TOBI_OK) tobi_body_free(b);
    else s->body_count++;
    return status;
}

/* The owners of the particle fields that this world needs. */
static int needed_fields(const tobi_world *w)
{
    int owners = TOBI_ALL | w->method->fields;
    for (int f = 0; f < w->sim.fluid_count; f++)
        if (w->sim.fluid[f].tension > 0) owners |= TOBI_TENSION;
    for (int k = 0; k < w->sim.body_count; k++)
        if (w->sim.bodies[k].blade) owners |= TOBI_BLADES;
    if (w->sim.body_count > 0 || is_full_vessel(w)) owners |= w->method->body_fields;
    return owners;
}

/* Beside the fields: neighbour lists and what a stopped step is taken back from, or sorting, tiles and nodes
   of the grid (seen: 60 to 90). */
static int64_t list_bytes(const tobi_world *w)
{
    const tobi_simulation *s = &w->sim;
    if (w->method->fields & TOBI_MPM) return 80;
    double r = s->smoothing.h/s->smoothing.spacing;
    return (int64_t)(4*(s->box.dimension == 3 ? 4.19*r*r*r : 3.14*r*r) + 36);
}

tobi_status tobi_world_estimate(tobi_world *w, int64_t *fluid_particles, int64_t *body_particles,
                                int64_t *bytes, tobi_error *err)
{
    int64_t fluid = 0, body = 0;
    TOBI_NEED_WORLD(w);
    TOBI_NEED(fluid_particles && body_particles && bytes, "where a number goes");
    if (!w->started) set_smoothing(w);
    for (int k = 0; k < w->region_count; k++) fluid += tobi_world_guess_particles(w, &w->regions[k]);
    for (int k = 0; k < w->sim.body_count; k++) body += w->sim.bodies[k].particle_count;
    if (w->started) fluid = w->sim.particles.count;
    *fluid_particles = fluid;
    *body_particles = body;
    *bytes = fluid*(tobi_particles_row_bytes(needed_fields(w)) + list_bytes(w)) + body*48;
    return TOBI_OK;
}

static tobi_status check_memory(int64_t particles, int64_t bytes, tobi_error *err)
{
    double have = (double)sysconf(_SC_PHYS_PAGES)*(double)sysconf(_SC_PAGESIZE);
    if (particles > 2000000000)
        return tobi_fail(err, TOBI_NO_MEMORY, "%lld fluid particles; one machine takes at most 2e9",
                         (long long)particles);
    if ((double)bytes > 0.95*have)
        return tobi_fail(err, TOBI_NO_MEMORY,
                         "%lld fluid particles need %.1f GiB; this machine has %.1f GiB. A larger "
                         "spacing needs less",
                         (long long)particles, (double)bytes / 1073741824, have / 1073741824);
    return TOBI_OK;
}

/* The hydrostatic head of the regions' common box. */
static double start_head(const tobi_world *w)
{
    double head = 0;
    for (int a = 0; a < w->sim.box.dimension; a++) {
        double lower = INFINITY, upper = -INFINITY;
        for (int k = 0; k < w->region_count; k++) {
            lower = fmin(lower, w->regions[k].lower[a]);
            upper = fmax(upper, w->regions[k].upper[a]);
        }
        if (upper > lower) head += fabs(w->sim.def.gravity[a])*(upper - lower);
    }
    return head;
}

/* Of a region: its velocity, its spin at the farthest corner, and, once it is filled, its flow. */
double tobi_world_start_speed(const tobi_world *w)
{
    double fastest = 0;
    for (int k = 0; k < w->region_count; k++) {
        const tobi_region *r = &w->regions[k];
        double half[3] = {0.5*(r->upper[0] - r->lower[0]), 0.5*(r->upper[1] - r->lower[1]),
                          0.5*(r->upper[2] - r->lower[2])};
        double reach = r->radius > 0 ? r->radius : length(half);
        fastest = fmax(fastest, length(r->velocity) + length(r->spin)*reach + r->flow_speed);
    }
    return fastest;
}

tobi_status tobi_world_start(tobi_world *w, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    tobi_simulation *s = &w->sim;
    int64_t fluid, body, bytes, room = 0;
    if (w->started) return TOBI_OK;
    TOBI_TRY(tobi_world_estimate(w, &fluid, &body, &bytes, err));
    for (int k = 0; k < w->region_count; k++) room += tobi_region_count(s, &w->regions[k]);
    if (room + body == 0)
        return tobi_fail(err, TOBI_INVALID,
                         "no particles at all: the scene needs a region of a fluid or solid, or a body");
    TOBI_TRY(check_memory(fluid, bytes, err));
    tobi_particles_free(&s->particles);
    TOBI_TRY(tobi_particles_reserve(&s->particles, room, needed_fields(w), err));
    for (int k = 0; k < w->region_count; k++) TOBI_TRY(tobi_region_fill(s, &w->regions[k], err));
    TOBI_TRY(tobi_fit_note(w, err));
    TOBI_TRY(tobi_world_note_regions(w, err));
    TOBI_TRY(tobi_world_note_thin_bodies(w, err));
    TOBI_TRY(tobi_world_note_edges(w, err));
    TOBI_TRY(tobi_particles_fit(&s->particles, needed_fields(w), err));
    int64_t n = s->particles.count;
    TOBI_TRY(tobi_exec_reserve(&s->exec, n > 4096 ? n : 4096, err));
    tobi_cells_free(&s->cells);
    if (w->method->fields & TOBI_SPH)
        TOBI_TRY(tobi_cells_create(&s->cells, &s->box, s->smoothing.h, n, &s->exec, err));
    free(w->row_of);
    w->row_of = malloc((size_t)(n + 1)*sizeof *w->row_of);
    if (!w->row_of) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld rows", (long long)n);
    if (!w->method_state) TOBI_TRY(w->method->create(s, w->method_def, &w->method_state, err));
    double *memory;
    w->method->memory(w->method_state, &memory);
    memory[0] = s->start_speed = tobi_world_start_speed(w);
    if (s->start_speed > TOBI_SPEED_LIMIT)
        return tobi_fail(err, TOBI_INVALID, "a region starts with %g m/s, by velocity, spin and flow "
                         "together; allowed are up to %g m/s", s->start_speed, TOBI_SPEED_LIMIT);
    s->start_head = start_head(w);
    TOBI_TRY(tobi_world_start_bodies(w, err));
    TOBI_TRY(tobi_world_note_starts(w, err));
    /* How fast the bodies start: their motion around time 0. */
    s->body_speed = s->wall_speed;
    for (int k = 0; k < s->body_count; k++)
        TOBI_TRY(tobi_body_predict(&s->bodies[k], 0, 1e-4, &s->body_speed, err));
    /* What free bodies bring the material may have when they are slow already. */
    if (w->dynamics) s->start_speed = fmax(s->start_speed, s->body_speed);
    s->info.fluid_particles = n;
    w->started = 1;
    const tobi_status status = tobi_world_note_pieces(w, err);
    w->started = status == TOBI_OK;
    return status;
}

/* Which key of the scene makes steps shorter, and its value. */
static const char *name_cfl(const tobi_world *w, double *value)
{
    const tobi_world_def *d = &w->sim.def;
    const int mpm = (w->method->fields & TOBI_MPM) != 0;
    *value = mpm ? ((const tobi_mlsmpm_def *)w->method_def)->cfl : d->time_step > 0 ? d->time_step : d->cfl;
    return mpm ? "mlsmpm.cfl" : d->time_step > 0 ? "time_step" : "cfl";
}

static tobi_status check_runaway(tobi_world *w, tobi_error *err)
{
    tobi_simulation *s = &w->sim;
    double limit = s->def.speed_limit, cfl;
    const char *key = name_cfl(w, &cfl);
    if (limit <= 0) {
        /* A few squeezed particles are slowed; when many are, or a number is no number, the run is lost. */
        const int64_t few = 20 + s->particles.count/200;
        if (s->info.speed_max < TOBI_SPEED_LIMIT && s->info.capped <= few) return TOBI_OK;
        limit = fmin(1.4*tobi_simulation_speed_scale(s), TOBI_SPEED_LIMIT);
    }
    if (s->info.speed_max < limit) return TOBI_OK;
    w->diverged = 1;
    for (int64_t i = 0; i < s->particles.count; i++) {
        tobi_float4 v = s->particles.velocity[i];
        tobi_double3 x = s->particles.position[i];
        double speed = sqrt((double)v.x*v.x + (double)v.y*v.y + (double)v.z*v.z);
        if (speed < limit || speed == 0) continue;   /* NaN goes on */
        if (!isfinite(speed))
            return tobi_fail(err, TOBI_DIVERGED,
                             "the simulation diverged at t = %.9g s, step %lld: the speed of particle %lld "
                             "at (%g, %g, %g) m is no number any more; a %s smaller than %g may help",
                             s->time, (long long)s->step, (long long)s->particles.id[i],
                             x.x + s->box.lower[0], x.y + s->box.lower[1], x.z + s->box.lower[2], key, cfl);
        return tobi_fail(err, TOBI_DIVERGED,
                         "the simulation diverged at t = %.9g s, step %lld: particle %lld at (%g, "
                         "%g, %g) m moves at %g m/s, the limit is %g m/s; a %s smaller than %g may "
                         "help",
                         s->time, (long long)s->step, (long long)s->particles.id[i],
                         x.x + s->box.lower[0], x.y + s->box.lower[1], x.z + s->box.lower[2], speed,
                         limit, key, cfl);
    }
    return tobi_fail(err, TOBI_DIVERGED,
                     "the simulation diverged at t = %.9g s: a speed reached %g m/s; a %s smaller than %g "
                     "may help", s->time, s->info.speed_max, key, cfl);
}

static void measure(tobi_world *w)
{
    tobi_simulation_measure(&w->sim);
    if (w->method->measure) w->method->measure(&w->sim, w->method_state);
}

/* `left`: s to the end that the caller wants. */
static tobi_status take_step(tobi_world *w, double max_dt, double left, tobi_step_info *info, tobi_error *err)
{
    tobi_simulation *s = &w->sim;
    const double before = s->time;
    TOBI_TRY(tobi_world_start(w, err));
    if (w->diverged) return tobi_fail(err, TOBI_DIVERGED, "the simulation has diverged and cannot go on");
    w->fresh = s->stopped = 0;
    TOBI_TRY(tobi_simulation_heed(s, err));
    tobi_world_cap_step(w);
    tobi_status status = w->method->step(s, w->method_state, max_dt, err);
    if (status == TOBI_OK) status = tobi_world_kick_bodies(w, err);
    if (status != TOBI_OK) {
        w->diverged = status != TOBI_STOPPED;
        return status;
    }
    s->info.step = s->step;
    s->info.time = s->time;
    s->info.dt = s->dt;
    TOBI_TRY(check_runaway(w, err));
    if (info) {
        measure(w);
        *info = s->info;
    }
    return tobi_limits_progress(s, before, max_dt, left, &w->idle_steps, err);
}

tobi_status tobi_world_step(tobi_world *w, double max_dt, tobi_step_info *info, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    if (!(max_dt >= 0 && isfinite(max_dt)))
        return tobi_fail(err, TOBI_INVALID, "max_dt is %g s, allowed are finite numbers from 0, no cap, on",
                         max_dt);
    return take_step(w, max_dt, fmax(w->sim.def.end_time - w->sim.time, max_dt), info, err);
}

tobi_status tobi_world_step_towards(tobi_world *w, double t, double end, tobi_error *err)
{
    double way = t - w->sim.time;
    TOBI_TRY(take_step(w, way, end - w->sim.time, NULL, err));
    if (w->sim.dt >= way) w->sim.time = w->sim.info.time = t;      /* not a rounding beside it */
    return TOBI_OK;
}

tobi_status tobi_world_advance(tobi_world *w, double t, tobi_step_info *info, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    if (!isfinite(t)) return tobi_fail(err, TOBI_INVALID, "the time to advance to is %g s, not finite", t);
    while (w->sim.time < t) TOBI_TRY(tobi_world_step_towards(w, t, t, err));
    if (info) {
        measure(w);
        *info = w->sim.info;
    }
    return TOBI_OK;
}

void tobi_world_set_stop(tobi_world *w, tobi_stop_fn stop, void *user)
{
    if (!w) return;
    w->sim.stop = stop;
    w->sim.stop_user = user;
}

double tobi_world_time(const tobi_world *w) { return w ? w->sim.time : 0; }

const tobi_step_info *tobi_world_info(const tobi_world *w)
{
    if (!w) return NULL;
    tobi_simulation *s = (tobi_simulation *)&w->sim;   /* fills in sums of the present state */
    s->info.step = s->step;
    s->info.time = s->time;
    s->info.dt = s->dt;
    if (w->started) measure((tobi_world *)w);
    return &s->info;
}

int tobi_world_body_count(const tobi_world *w) { return w ? w->sim.body_count : 0; }

tobi_status tobi_world_body(const tobi_world *w, int body, tobi_body_info *info)
{
    if (!w || !info) return TOBI_INVALID;
    if (body < 0 || body >= w->sim.body_count) return TOBI_NOT_FOUND;
    *info = w->sim.bodies[body].info;
    return TOBI_OK;
}

const char *tobi_world_body_name(const tobi_world *w, int body)
{
    return !w || body < 0 || body >= w->sim.body_count ? NULL : w->sim.bodies[body].name;
}

int64_t tobi_world_bytes(const tobi_world *w)
{
    if (!w) return 0;
    const tobi_simulation *s = &w->sim;
    return s->particles.capacity * (tobi_particles_row_bytes(needed_fields(w)) + 4) +
           s->cells.list_capacity * 4 + s->cells.total * 4 +
           s->near.capacity * (int64_t)sizeof(tobi_near_entry) +
           (w->method->bytes && w->method_state ? w->method->bytes(w->method_state) : 0);
}

const char *tobi_world_stage(const tobi_world *w, int stage, double *seconds)
{
    if (!w || stage < 0 || stage >= w->sim.stages.count) return NULL;
    const tobi_stages *st = &w->sim.stages;
    if (seconds) *seconds = st->seconds[stage];
    return st->name[stage];
}
