/* A world: definitions become a simulation, the method steps it. */
#include "world/mixture.h"
#include "world/world.h"
#include "world/absorb.h"
#include "world/beside.h"
#include "world/acceleration.h"
#include "base/error.h"
#include "rigid/dynamics.h"
#include "world/bodies.h"
#include "world/change.h"
#include "world/fit.h"
#include "world/limits.h"
#include "world/motors.h"
#include "world/names.h"
#include "world/nest.h"
#include "world/note_pieces.h"
#include "world/openings.h"
#include "world/scalars.h"
#include "world/overlap.h"
#include "base/param.h"
#include "world/step.h"
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

static tobi_status create_simulation(tobi_simulation *s, const tobi_world_def *def, tobi_error *err)
{
    s->def = *def;
    if (def->dimension == 2) s->def.gravity[2] = 0;
    for (int a = 0; a < def->dimension; a++)
        s->wall_speed = fmax(s->wall_speed, fmax(length(def->wall_velocity_min[a]),
                                                 length(def->wall_velocity_max[a])));
    return tobi_exec_init(&s->exec, def->threads, err);
}

/* The default of a definition is along z. */
static tobi_status note_flat_gravity(tobi_world *w, const tobi_world_def *def, tobi_error *err)
{
    const double *g = def->gravity;
    if (def->dimension != 2 || g[2] == 0 || g[0] != 0 || g[1] != 0) return TOBI_OK;
    return tobi_world_add_notes(w, "world", "gravity", tr("is along z alone, and a 2-D world has no z: "
                                "nothing falls; (0, -9.81, 0) m/s2 is down\n"), err);
}

static tobi_status refuse_method(const char *name, tobi_error *err)
{
    char known[200] = "";
    size_t used = 0;
    for (int k = 0; tobi_method_at(k) && used < sizeof known; k++)
        used += (size_t)snprintf(known + used, sizeof known - used, "%s%s", k ? ", " : "",
                                 tobi_method_at(k)->name);
    return tobi_fail(err, TOBI_INVALID, "there is no method '%s'; known are %s", name ? name : "", known);
}

tobi_status tobi_world_create(const tobi_world_def *def, const void *method_def, tobi_world **world,
                              tobi_error *err)
{
    TOBI_NEED(world, "where the world goes");
    *world = NULL;
    TOBI_NEED(def, "the definition");
    TOBI_TRY(tobi_param_check(&tobi_world_table, def, err));
    const tobi_method *method = tobi_method_find(def->method);
    if (!method) return refuse_method(def->method, err);
    tobi_world *w = calloc(1, sizeof *w);
    if (!w) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a world");
    w->alive = TOBI_ALIVE;
    tobi_status status = create_simulation(&w->sim, def, err);
    if (status == TOBI_OK) status = tobi_world_add_system(w, method, method_def, err);
    if (status != TOBI_OK) {
        tobi_world_destroy(w);
        return status;
    }
    status = note_flat_gravity(w, def, err);
    if (status != TOBI_OK) tobi_world_destroy(w);
    else *world = w;
    return status;
}

void tobi_world_destroy(tobi_world *w)
{
    if (!w) return;
    assert(w->alive == TOBI_ALIVE);
    w->alive = 0;
    tobi_nest_leave(w);
    for (int k = 0; k < w->system_count; k++) tobi_world_free_system(&w->system[k]);
    tobi_rigid_free(w->dynamics);
    tobi_world_free_drive(w);
    tobi_absorb_free(w);
    for (int k = 0; k < w->sim.body_count; k++) tobi_body_free(&w->sim.bodies[k]);
    for (int k = 0; k < w->region_count; k++) {
        tobi_mesh_free(&w->regions[k].shape);
        free(w->regions[k].points);
    }
    for (int k = 0; k < w->sim.porous_count; k++) free(w->sim.porous[k].corners);
    free(w->sim.bodies);
    free(w->regions);
    free(w->probes);
    tobi_openings_free(w);
    free(w->lines);
    free(w->seen);
    free(w->pressed);
    free(w->sim.before);
    tobi_constraints_free(&w->sim.constraints);
    tobi_motors_free(w);
    tobi_world_drop_notes(w, 0);
    free(w->notes);
    free(w->texture);
    tobi_world_free_images(w);
    tobi_world_free_grid(w);
    tobi_pieces_free(&w->pieces);
    tobi_exec_free(&w->sim.exec);
    free(w);
}

void tobi_world_drop_notes(tobi_world *w, int count)
{
    while (w->note_count > count) free(w->notes[--w->note_count]);
}

static tobi_status keep_note(tobi_world *w, char *text, tobi_error *err)
{
    char **more = text ? realloc(w->notes, (size_t)(w->note_count + 1)*sizeof *more) : NULL;
    if (!more) {
        free(text);
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a note");
    }
    w->notes = more;
    w->notes[w->note_count++] = text;
    return TOBI_OK;
}

tobi_status tobi_world_add_note(tobi_world *w, const char *text, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    TOBI_NEED(text, "the note");
    return keep_note(w, strdup(text), err);
}

tobi_status tobi_world_add_notes(tobi_world *w, const char *kind, const char *name, const char *notes,
                                 tobi_error *err)
{
    for (const char *end; (end = strchr(notes, '\n')) != NULL; notes = end + 1) {
        size_t room = (size_t)(end - notes) + strlen(tr(kind)) + strlen(name ? name : "") + 8;
        char *text = malloc(room);
        if (text)
            snprintf(text, room, name ? "%s '%s': %.*s" : "%s %s%.*s", tr(kind), name ? name : "",
                     (int)(end - notes), notes);
        TOBI_TRY(keep_note(w, text, err));
    }
    return TOBI_OK;
}

const char *tobi_world_note(const tobi_world *w, int note)
{
    return w && note >= 0 && note < w->note_count ? w->notes[note] : NULL;
}

/* A wall that ends at a side of the domain may miss it by the rounding of its sums. */
static tobi_status check_body(const tobi_world *w, const tobi_body *b, tobi_error *err)
{
    const tobi_box *box = &w->system[0].box;
    for (int64_t i = 0; i < b->mesh.vertex_count; i++)
        for (int a = 0; a < box->dimension; a++) {
            const double x = b->vertex[i][a], slack = 1e-9*w->sim.def.spacing;
            if (box->periodic[a] || (x >= -slack && x <= box->size[a] + slack)) continue;
            return tobi_fail(err, TOBI_INVALID, "body '%s' sticks out of the domain: a vertex%s is at %c = "
                             "%g m, allowed is %g to %g m", b->name,
                             b->vessel ? tr(" of its walls (outside of a mesh of its inside)") : "", "xyz"[a],
                             x + box->lower[a], box->lower[a], box->lower[a] + box->size[a]);
        }
    return tobi_at_key(err, tobi_world_check_stroke(w, b, err), "motion");
}

tobi_status tobi_world_add_body(tobi_world *w, const tobi_body_def *def, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    TOBI_NEED(def, "the definition");
    tobi_system *s = &w->system[0];
    if (w->started) return tobi_fail(err, TOBI_INVALID, "a started world takes no more bodies");
    TOBI_TRY(tobi_param_check(&tobi_body_table, def, err));
    if (def->blade && !tobi_world_solids(w))
        return tobi_at_key(err, tobi_fail(err, TOBI_UNSUPPORTED, "body '%s' is a blade, which the method %s "
                                          "does not know; blades cut solids of mlsmpm",
                                          def->name ? def->name : "", w->system[0].method->name), "blade");
    if (s->sim->body_count == TOBI_BODY_LIMIT)
        return tobi_fail(err, TOBI_UNSUPPORTED, "more than %d bodies", TOBI_BODY_LIMIT);
    tobi_body *more = realloc(s->sim->bodies, (size_t)(s->sim->body_count + 1)*sizeof *more);
    if (!more) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a body");
    s->sim->bodies = more;
    tobi_body *b = &s->sim->bodies[s->sim->body_count];
    /* Only SPH methods integrate over surfaces. */
    double pieces = (!w->system[0].method->solids ? 0.5 : 1e3)*s->sim->def.spacing;
    tobi_body_def placed = *def;
    if (!(def->spacing > 0)) placed.spacing = s->sim->def.spacing;
    TOBI_TRY(tobi_body_create(b, &placed, &s->box, pieces, err));
    tobi_status status = tobi_names_check_matter(w, "body", b->name, err);
    if (status == TOBI_OK) status = tobi_body_plan_absence(b, &placed, &s->box, err);
    if (status == TOBI_OK) status = check_body(w, b, err);
    tobi_at_key(err, status, "%s", tobi_body_shape_key(def));
    if (status == TOBI_OK)
        status = tobi_world_read_image(w, "body", b->name, def->texture, b->mesh.texture, err);
    const int notes = w->note_count;
    if (status == TOBI_OK) status = tobi_world_add_notes(w, "body", b->name, b->mesh.notes, err);
    if (status == TOBI_OK)
        status = tobi_motors_add(w, &def->hinge_motor, "hinge.motor", 0, -1, s->sim->body_count, err);
    if (status == TOBI_OK)
        status = tobi_motors_add(w, &def->guide_motor, "guide.motor", 1, -1, s->sim->body_count, err);
    if (status == TOBI_OK) s->sim->body_count++;
    else {
        tobi_body_free(b);
        tobi_world_drop_notes(w, notes);
    }
    return status;
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

/* Their speed from their motion around time 0. What free bodies bring the material may have when they are
   slow already. */
static tobi_status start_bodies(tobi_world *w, tobi_error *err)
{
    tobi_simulation *s = &w->sim;
    TOBI_TRY(tobi_world_start_bodies(w, err));
    TOBI_TRY(tobi_world_note_starts(w, err));
    TOBI_TRY(tobi_world_note_units(w, err));
    TOBI_TRY(tobi_world_note_balance(w, err));
    TOBI_TRY(tobi_world_note_lines(w, err));
    TOBI_TRY(tobi_world_note_makers(w, err));
    TOBI_TRY(tobi_world_note_probes(w, err));
    s->body_speed = s->wall_speed;
    for (int k = 0; k < s->body_count; k++)
        TOBI_TRY(tobi_body_predict(&s->bodies[k], 0, 1e-4, &s->body_speed, err));
    for (int k = 0; k < w->system_count && w->dynamics; k++)
        w->system[k].start_speed = fmax(w->system[k].start_speed, s->body_speed);
    return TOBI_OK;
}

static tobi_status check_systems(tobi_world *w, tobi_error *err)
{
    if (w->system_count < 2) return TOBI_OK;
    if (w->system[0].fluid_count == 0)
        return tobi_fail(err, TOBI_INVALID, "%s has no fluid; the method of solids alone is %s",
                         w->system[0].method->name, w->system[1].method->name);
    w->sim.soft.solids = &w->system[1];
    return TOBI_OK;
}

/* Solids first: no fluid starts inside them. */
static tobi_status fill_systems(tobi_world *w, tobi_error *err)
{
    tobi_soft *soft = &w->sim.soft;
    tobi_status status = TOBI_OK;
    for (int k = w->system_count - 1; k >= 0 && status == TOBI_OK; k--) {
        status = tobi_world_fill_system(w, &w->system[k], err);
        const tobi_system *s = &w->system[k];
        const double between = 0.5*(s->smoothing.spacing + w->system[0].smoothing.spacing);
        if (status == TOBI_OK && soft->solids == s)
            status = tobi_overlap_create((const double (*)[3])s->particles.position, s->particles.count,
                                         s->box.dimension, between, &soft->start, err);
    }
    tobi_overlap_free(soft->start);
    soft->start = NULL;
    return status;
}

static tobi_status start(tobi_world *w, tobi_error *err)
{
    int64_t fluid, body, bytes, room = 0;
    TOBI_TRY(tobi_world_estimate(w, &fluid, &body, &bytes, err));
    for (int k = 0; k < w->region_count; k++)
        room += tobi_region_count(&w->system[w->regions[k].system], &w->regions[k]);
    if (room + body + tobi_openings_count(w) == 0)
        return tobi_fail(err, TOBI_INVALID,
                         "no particles at all: the scene needs a region of a fluid or solid, or a body");
    TOBI_TRY(check_memory(fluid, bytes, err));
    TOBI_TRY(check_systems(w, err));
    TOBI_TRY(tobi_mixture_start(w, err));
    TOBI_TRY(tobi_world_start_drive(w, err));
    TOBI_TRY(tobi_world_find_clamps(w, err));
    TOBI_TRY(fill_systems(w, err));
    TOBI_TRY(tobi_fit_note(w, err));
    TOBI_TRY(tobi_world_note_regions(w, err));
    TOBI_TRY(tobi_world_start_clamps(w, err));
    TOBI_TRY(tobi_world_note_thin_bodies(w, err));
    TOBI_TRY(tobi_world_note_clamps(w, err));
    TOBI_TRY(tobi_world_note_liquids(w, err));
    TOBI_TRY(tobi_world_note_friction(w, err));
    TOBI_TRY(tobi_openings_note(w, err));
    tobi_world_start_porous(w);
    TOBI_TRY(tobi_world_note_hinges(w, err));
    TOBI_TRY(tobi_world_note_porous(w, err));
    TOBI_TRY(tobi_world_note_scalars(w, err));
    TOBI_TRY(tobi_openings_note_pools(w, err));
    TOBI_TRY(tobi_openings_note_dry(w, err));
    TOBI_TRY(tobi_overlap_note_solids(w, err));
    TOBI_TRY(tobi_beside_check(w, err));
    TOBI_TRY(tobi_beside_note(w, err));
    TOBI_TRY(tobi_world_note_edges(w, err));
    TOBI_TRY(tobi_world_fit_systems(w, err));
    for (int k = 0; k < w->system_count; k++) TOBI_TRY(tobi_world_start_system(w, &w->system[k], err));
    TOBI_TRY(start_bodies(w, err));
    TOBI_TRY(tobi_absorb_start(w, err));
    tobi_step_sum_up(w);
    w->started = 1;
    const tobi_status status = tobi_world_note_pieces(w, err);
    w->started = status == TOBI_OK;
    return status;
}

tobi_status tobi_world_start(tobi_world *w, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    const int notes = w->note_count, step_noted = w->step_noted;
    if (w->started) return TOBI_OK;
    const tobi_status status = start(w, err);
    if (status == TOBI_OK) return TOBI_OK;
    tobi_world_drop_notes(w, notes);
    w->step_noted = step_noted;
    return status;
}

static void measure(tobi_world *w)
{
    for (int k = 0; k < w->system_count; k++) {
        tobi_system_measure(&w->system[k]);
        if (w->system[k].method->measure) w->system[k].method->measure(&w->system[k]);
    }
    tobi_step_sum_up(w);
}

tobi_status tobi_world_check_whole(const tobi_world *w, tobi_error *err)
{
    if (w->failure.status == TOBI_OK) return TOBI_OK;
    return tobi_fail(err, w->failure.status, "the simulation cannot go on: %s", w->failure.text);
}

/* `left`: s to the end that the caller wants. */
static tobi_status take_step(tobi_world *w, double max_dt, double left, tobi_step_info *info, tobi_error *err)
{
    tobi_simulation *s = &w->sim;
    const double before = s->time;
    TOBI_TRY(tobi_world_start(w, err));
    TOBI_TRY(tobi_world_check_whole(w, err));
    TOBI_TRY(tobi_world_check_motions(w, err));
    w->fresh = s->stopped = 0;
    TOBI_TRY(tobi_step_take(w, max_dt, err));
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

/* Rounding of a time that a caller has summed up is no way back. */
static tobi_status check_goal(const tobi_world *w, double t, tobi_error *err)
{
    if (!isfinite(t)) return tobi_fail(err, TOBI_INVALID, "the time to advance to is %g s, not finite", t);
    if (t >= w->sim.time - 1e-9*fabs(w->sim.time)) return TOBI_OK;
    return tobi_fail(err, TOBI_INVALID, "the time to advance to, %g s, has passed: it is %g s already; t is "
                     "the time to go on until, not how long", t, w->sim.time);
}

tobi_status tobi_world_step_to(tobi_world *w, double t, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    TOBI_TRY(check_goal(w, t, err));
    return w->sim.time < t ? tobi_world_step_towards(w, t, t, err) : TOBI_OK;
}

tobi_status tobi_world_advance(tobi_world *w, double t, tobi_step_info *info, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    TOBI_TRY(check_goal(w, t, err));
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
    if (w->started) measure((tobi_world *)w);          /* fills in sums of the present state */
    return &w->sim.info;
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

const char *tobi_world_stage(const tobi_world *w, int stage, double *seconds)
{
    if (!w || stage < 0 || stage >= w->sim.stages.count) return NULL;
    const tobi_stages *st = &w->sim.stages;
    if (seconds) *seconds = st->seconds[stage];
    return st->name[stage];
}
