/* The systems of a world: made with their method, filled, started, counted. Drawback: two at most, that of
   the definition's method and one for solids beside fluids. */
#include "base/error.h"
#include "world/apart.h"
#include "world/fit.h"
#include "base/param.h"
#include "mpm/mlsmpm.h"
#include "world/nest.h"
#include "world/openings.h"
#include "world/scalars.h"
#include "world/vessel.h"
#include "world/world.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static double length(const double v[3]) { return sqrt(v[0]*v[0] + v[1]*v[1] + v[2]*v[2]); }

/* Keeps the first breach of a rule. */
static void keep_first(void *user, const char *path, const tobi_error *why)
{
    tobi_error *first = user;
    if (first->status == TOBI_OK) tobi_fail(first, why->status, "%s: %s", path, why->text);
}

/* beside: 1 for solids beside fluids. */
static tobi_status check_rules(const tobi_world_def *def, const tobi_method *method, const void *method_def,
                               int beside, tobi_error *err)
{
    tobi_world_def d = *def;
    d.method = method->name;
    tobi_error first = { 0 };
    const tobi_rules rules = { .tell = keep_first, .user = &first, .corners = 1, .numbers = 1 };
    if (beside) tobi_rules_beside(&rules, &d, method_def);
    else tobi_rules_world(&rules, &d, method_def);
    return first.status ? tobi_fail(err, first.status, "%s", first.text) : TOBI_OK;
}

/* Whether a system fills the domain: not half a layer of particles is missing over its smallest side. */
static int is_full_vessel(const tobi_world *w, const tobi_system *s)
{
    const tobi_world_def *d = &w->sim.def;
    double domain = 1, longest = 0, filled = 0;
    for (int a = 0; a < d->dimension; a++) {
        double side = d->domain_max[a] - d->domain_min[a];
        domain *= side;
        longest = fmax(longest, side);
    }
    for (int k = 0; k < w->region_count; k++)
        if (&w->system[w->regions[k].system] == s) filled += w->regions[k].volume;
    return filled > domain*(1 - 0.5*d->spacing/longest);
}

/* Whether a body or a side moves in a full vessel, warm liquid rises in it, or liquid is driven through a
   porous zone: behind it the pressure is low, where particles would cluster. */
static int is_stirred_vessel(const tobi_world *w, const tobi_system *s)
{
    int driven = w->sim.wall_speed > 0 || tobi_system_is_mixed(s) || w->sim.porous_count > 0 ||
                 tobi_body_any_free(w->sim.bodies, w->sim.body_count);
    for (int k = 0; k < w->sim.body_count; k++) driven |= w->sim.bodies[k].motion != NULL;
    for (int k = 0; k < TOBI_SCALAR_LIMIT; k++) driven |= w->sim.scalar[k].expansion != 0;
    return driven && is_full_vessel(w, s);
}

/* The kernel, and the box whose cells follow its support. Final when all regions and bodies are known. */
static void set_smoothing(tobi_world *w, tobi_system *s)
{
    const tobi_world_def *d = &w->sim.def;
    int shape = 0, periodic[3];
    double support = 2;
    if (s->method->smoothing) s->method->smoothing(s->def, is_stirred_vessel(w, s), &shape, &support);
    const double common = tobi_fit_find(w, d->spacing).spacing;
    const double spacing = s->method->solids ? mpm_spacing(s->def, common) : common;
    if (s->smoothing.h == support*spacing) return;
    tobi_smoothing_init(&s->smoothing, shape, d->dimension, spacing, support);
    for (int a = 0; a < 3; a++) periodic[a] = !s->method->solids && d->wall_min[a] == TOBI_WALL_PERIODIC;
    tobi_box_init(&s->box, d->dimension, d->domain_min, d->domain_max, periodic, s->smoothing.h);
}

tobi_status tobi_world_add_system(tobi_world *w, const tobi_method *method, const void *method_def,
                                  tobi_error *err)
{
    const tobi_param_table *table = tobi_method_table(method->name);
    void *params = calloc(1, method->params->size);
    if (!params) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a system");
    tobi_param_defaults(table, params);
    if (method_def) memcpy(params, method_def, method->params->size);
    tobi_status status = tobi_param_check(table, params, err);
    if (status == TOBI_OK) status = check_rules(&w->sim.def, method, params, w->system_count > 0, err);
    if (status != TOBI_OK) {
        free(params);
        return status;
    }
    tobi_system *s = &w->system[w->system_count++];
    *s = (tobi_system){ .sim = &w->sim, .number = w->system_count - 1, .method = method, .def = params };
    memcpy(s->gravity, w->sim.def.gravity, sizeof s->gravity);
    set_smoothing(w, s);
    return TOBI_OK;
}

double tobi_world_spacing(const tobi_world *w, const tobi_system *s)
{
    if (w->started) return s->smoothing.spacing;
    const double common = tobi_fit_find(w, w->sim.def.spacing).spacing;
    return s->method->solids ? mpm_spacing(s->def, common) : common;
}

tobi_system *tobi_world_solids(const tobi_world *w)
{
    for (int k = 0; k < w->system_count; k++)
        if (w->system[k].method->solids) return (tobi_system *)&w->system[k];
    return NULL;
}

tobi_system *tobi_world_fluids(const tobi_world *w)
{
    return !w->system[0].method->solids ? (tobi_system *)&w->system[0] : NULL;
}

int tobi_world_first_material(const tobi_world *w, const tobi_system *s)
{
    int first = 0;
    for (const tobi_system *k = w->system; k < s; k++) first += k->fluid_count + k->solid_count;
    return first;
}

void tobi_world_free_system(tobi_system *s)
{
    if (s->state) s->method->free(s->state);
    free(s->def);
    for (int k = 0; k < s->solid_count; k++) {
        free(s->solids[k].clamped_to);
        free(s->solids[k].clamp);
    }
    free(s->solids);
    free(s->row_of);
    tobi_cells_free(&s->cells);
    tobi_particles_free(&s->particles);
}

/* The optional particle fields that a system needs. */
static unsigned needed_fields(const tobi_world *w, const tobi_system *s)
{
    return s->method->needs ? s->method->needs(s, is_full_vessel(w, s)) : 0;
}

static int64_t row_bytes(const tobi_world *w, const tobi_system *s)
{
    return tobi_particles_row_bytes(s->method->fields, needed_fields(w, s)) +
           (s->method->solids ? 0 : TOBI_CELLS_ROW + (s->method->packs_lists ? TOBI_CELLS_FAR : 0));
}

/* Sorting, tiles and nodes of the grid, of a particle of solids (seen: 60 to 90). */
static const int64_t SOLID_GRID = 80;

/* Neighbours on the lattice of the start, the centre left out. */
static int count_lattice(int dimension, double r)
{
    const int far = (int)r, deep = dimension == 3 ? far : 0;
    int count = -1;
    for (int z = -deep; z <= deep; z++)
        for (int y = -far; y <= far; y++)
            for (int x = -far; x <= far; x++) count += x*x + y*y + z*z <= r*r;
    return count;
}

/* From where to where the regions of a system reach along an axis; upper below lower: it has none. */
static void find_extent(const tobi_world *w, const tobi_system *s, int axis, double *lower, double *upper)
{
    *lower = INFINITY;
    *upper = -INFINITY;
    for (int k = 0; k < w->region_count; k++) {
        if (&w->system[w->regions[k].system] != s) continue;
        *lower = fmin(*lower, w->regions[k].lower[axis]);
        *upper = fmax(*upper, w->regions[k].upper[axis]);
    }
}

/* Entries of a list, in whole groups of eight: as on the lattice, or as many as are in the ball or disc of
   the kernel, with half of a group. The sides of the liquid cut off some: a ball reaches 3/8 of its radius
   beyond a side in the mean over the places in it, a disc 4/(3 pi). */
static double guess_entries(const tobi_world *w, const tobi_system *s)
{
    const int solid = s->box.dimension == 3, size = s->method->packs_lists ? 2 : 4;
    const double r = s->smoothing.h/s->smoothing.spacing, beyond = solid ? 0.375 : 0.424, more = 1 + 1.0/64,
                 ball = (solid ? 4.19*r*r*r : 3.14*r*r) - 1;
    double sum = fmax(8*((count_lattice(s->box.dimension, r) + 7)/8), ball + 3.5);
    for (int a = 0; a < s->box.dimension; a++) {
        double lower, upper;
        find_extent(w, s, a, &lower, &upper);
        if (upper > lower && !s->box.periodic[a])
            sum *= fmax(1 - beyond*s->smoothing.h/(upper - lower), 0.5);
    }
    return fmax(more*sum, TOBI_CELLS_LIST/size);
}

static int64_t estimate_system(const tobi_world *w, const tobi_system *s, int64_t count)
{
    const int64_t fields = count*row_bytes(w, s), entry = s->method->packs_lists ? 2 : 4;
    tobi_cells cells = { 0 };
    tobi_particles none = { 0 };
    if (s->method->solids || count == 0) return fields + count*SOLID_GRID;
    tobi_cells_plan(&cells, &s->box, s->smoothing.h, count);
    const tobi_system_plan plan = { tobi_cells_points(&cells, &s->box, &none), count, guess_entries(w, s) };
    return fields + 4*cells.total + (int64_t)(plan.entries*(double)count)*entry +
           (s->method->estimate ? s->method->estimate(s, &plan) : 0);
}

/* Bytes of all. */
static int64_t count_bodies(const tobi_world *w)
{
    int64_t bytes = 0;
    for (int k = 0; k < w->sim.body_count; k++) bytes += tobi_body_bytes(&w->sim.bodies[k]);
    return bytes;
}

tobi_status tobi_world_estimate(tobi_world *w, int64_t *fluid_particles, int64_t *body_particles,
                                int64_t *bytes, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    TOBI_NEED(fluid_particles && body_particles && bytes, "where a number goes");
    *fluid_particles = *body_particles = *bytes = 0;
    if (!w->started) TOBI_TRY(tobi_vessel_resolve(w, err));
    for (int k = 0; k < w->system_count; k++) {
        tobi_system *s = &w->system[k];
        int64_t count = 0;
        if (!w->started) set_smoothing(w, s);
        for (int r = 0; r < w->region_count; r++)
            if (w->regions[r].system == k) count += tobi_world_guess_particles(w, &w->regions[r]);
        count = w->started ? s->particles.count : tobi_nest_share(w, count);
        *fluid_particles += count;
        *bytes += estimate_system(w, s, count);
    }
    for (int k = 0; k < w->sim.body_count; k++) *body_particles += w->sim.bodies[k].particle_count;
    *bytes += count_bodies(w);
    return w->started ? TOBI_OK : tobi_world_note_time_step(w, err);
}

/* The hydrostatic head of the common box of a system's regions. */
double tobi_world_start_head(const tobi_world *w, const tobi_system *s)
{
    double head = 0;
    for (int a = 0; a < s->box.dimension; a++) {
        double lower, upper;
        find_extent(w, s, a, &lower, &upper);
        if (w->sim.opening_count > 0) head += fabs(w->sim.def.gravity[a])*s->box.size[a];
        else if (upper > lower) head += fabs(w->sim.def.gravity[a])*(upper - lower);
    }
    const double peak = tobi_openings_peak(&w->sim);
    return head + peak*peak;
}

/* Of a region: its velocity, its spin at the farthest corner, and, once it is filled, its flow. */
static double find_start_speed(const tobi_world *w, const tobi_system *s, bool scripts)
{
    double fastest = 0;
    for (int k = 0; k < w->region_count; k++) {
        const tobi_region *r = &w->regions[k];
        double half[3] = {0.5*(r->upper[0] - r->lower[0]), 0.5*(r->upper[1] - r->lower[1]),
                          0.5*(r->upper[2] - r->lower[2])};
        double reach = r->radius > 0 ? r->radius : length(half);
        if (&w->system[r->system] != s) continue;
        fastest = fmax(fastest, length(r->velocity) + length(r->spin)*reach + (scripts ? r->flow_speed : 0));
    }
    return s == &w->system[0] ? fmax(fastest, tobi_openings_peak(&w->sim)) : fastest;
}

double tobi_world_start_speed(const tobi_world *w, const tobi_system *s)
{
    return find_start_speed(w, s, true);
}

double tobi_world_given_speed(const tobi_world *w)
{
    double fastest = 0;
    for (int k = 0; k < w->system_count; k++)
        fastest = fmax(fastest, find_start_speed(w, &w->system[k], false));
    return fastest;
}

/* Room for the particles of a system, and the particles. */
tobi_status tobi_world_fill_system(tobi_world *w, tobi_system *s, tobi_error *err)
{
    int64_t room = s == &w->system[0] ? tobi_openings_count(w) : 0;
    for (int k = 0; k < w->region_count; k++)
        if (&w->system[w->regions[k].system] == s) room += tobi_region_count(s, &w->regions[k]);
    room = tobi_nest_share(w, room);
    tobi_particles_free(&s->particles);
    TOBI_TRY(tobi_particles_reserve(&s->particles, s->method->fields, needed_fields(w, s), room, err));
    for (int k = 0; k < w->region_count; k++)
        if (&w->system[w->regions[k].system] == s) TOBI_TRY(tobi_region_fill(s, &w->regions[k], err));
    TOBI_TRY(tobi_regions_check_apart(s, (int)(s - w->system), w->regions, w->region_count, err));
    tobi_scalars_start(s);
    return s == &w->system[0] ? tobi_openings_fill(w, err) : TOBI_OK;
}

/* Ids count on through the systems, then through the particles of bodies. */
static void number_particles(tobi_world *w)
{
    int64_t first = 0;
    for (int k = 0; k < w->system_count; k++) {
        w->system[k].first_id = first;
        first += w->system[k].started = w->system[k].particles.count;
    }
    w->sim.body_first_id = first;
    for (int k = 0; k < w->sim.body_count; k++) first += w->sim.bodies[k].particle_count;
    w->sim.next_id = first;
}

tobi_status tobi_world_fit_systems(tobi_world *w, tobi_error *err)
{
    number_particles(w);
    for (int k = 0; k < w->system_count; k++) TOBI_TRY(tobi_particles_fit(&w->system[k].particles, err));
    return TOBI_OK;
}

tobi_status tobi_world_start_system(tobi_world *w, tobi_system *s, tobi_error *err)
{
    double *memory;
    const int64_t n = s->particles.count;
    TOBI_TRY(tobi_exec_reserve(&w->sim.exec, n > 4096 ? n : 4096, err));
    for (int b = 0; b < w->sim.body_count; b++)       /* loops over the points of a body have sums too */
        TOBI_TRY(tobi_exec_reserve(&w->sim.exec, w->sim.bodies[b].point_count, err));
    tobi_cells_free(&s->cells);
    if (!s->method->solids)
        TOBI_TRY(tobi_cells_create(&s->cells, &s->box, s->smoothing.h, &s->particles, &w->sim.exec, err));
    if (!s->method->packs_lists) tobi_cells_widen(&s->cells);
    if (s->method->create && !s->state) TOBI_TRY(s->method->create(s, err));
    tobi_system_memory(s, &memory);
    memory[0] = s->start_speed = tobi_world_start_speed(w, s);
    if (s->start_speed > TOBI_SPEED_LIMIT)
        return tobi_fail(err, TOBI_INVALID, "a region starts with %g m/s, by velocity, spin and flow "
                         "together; allowed are up to %g m/s", s->start_speed, TOBI_SPEED_LIMIT);
    s->start_head = tobi_world_start_head(w, s);
    s->info.fluid_particles = n;
    return TOBI_OK;
}

static void account_particles(const tobi_particles *p, unsigned needs, tobi_account *a)
{
    const int64_t kept = tobi_particles_state_bytes(p->list, needs);
    tobi_account_add(a, "state of the particles", p->capacity*kept);
    tobi_account_add(a, "other fields of the particles",
                     p->capacity*(tobi_particles_row_bytes(p->list, needs) - kept));
}

static tobi_account account(const tobi_world *w)
{
    tobi_account a = { 0 };
    for (int k = 0; w && k < w->system_count; k++) {
        const tobi_system *s = &w->system[k];
        account_particles(&s->particles, needed_fields(w, s), &a);
        const int row = TOBI_CELLS_ROW + (s->cells.list_far ? TOBI_CELLS_FAR : 0);
        tobi_account_add(&a, "cells", s->cells.rows*row + (s->cells.total + s->row_capacity)*4);
        tobi_account_add(&a, "neighbour lists", s->cells.list_bytes);
        if (s->method->account && s->state) s->method->account(s, &a);
    }
    if (w) tobi_account_add(&a, "velocities and marks for nests",
                            w->seen_room + w->sim.before_room*(int64_t)sizeof *w->sim.before);
    if (w && w->sim.body_count > 0) tobi_account_add(&a, "bodies", count_bodies(w));
    return a;
}

const char *tobi_world_memory(const tobi_world *w, int part, int64_t *bytes)
{
    const tobi_account a = account(w);
    if (part < 0 || part >= a.count) return NULL;
    if (bytes) *bytes = a.bytes[part];
    return a.name[part];
}

int64_t tobi_world_bytes(const tobi_world *w)
{
    const tobi_account a = account(w);
    int64_t bytes = 0;
    for (int k = 0; k < a.count; k++) bytes += a.bytes[k];
    return bytes;
}
