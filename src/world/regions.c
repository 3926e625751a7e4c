/* What fills the world at the start: fluids and solids with their regions. */
#include "base/error.h"
#include "base/param.h"
#include "geom/outline.h"
#include "geom/texture.h"
#include "world/mixture.h"
#include "world/names.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Curvature needs more neighbours than shorter supports reach, docs/theory/surface_tension.md. */
static tobi_status note_tension(tobi_world *w, const tobi_fluid_def *def, tobi_error *err)
{
    const double support = w->system[0].smoothing.h/w->system[0].smoothing.spacing;
    char text[TOBI_NOTE];
    if (!(def->surface_tension > 0) || support > 3 - 1e-6) return TOBI_OK;
    snprintf(text, sizeof text, tr("surface tension needs a support of 2.5 or more, and drops swing too fast "
             "below 3; it is %g\n"), support);
    return tobi_world_add_notes(w, "fluid", def->name, text, err);
}

/* Reads and places the mesh of a region; its volume as the integrals have it. */
static tobi_status load_shape(const char *name, const tobi_fill_def *f, int dimension, tobi_region *r,
                              tobi_error *err)
{
    tobi_massprops props;
    if (f->mesh) TOBI_TRY(tobi_mesh_read(f->mesh, &r->shape, err));
    else TOBI_TRY(tobi_mesh_outline(name, &f->outline, dimension, &r->shape, err));
    TOBI_TRY(tobi_mesh_transform(&r->shape, f->scale, f->rotation_axis, f->rotation_angle, f->translation,
                                 err));
    TOBI_TRY(tobi_mesh_orient(&r->shape, f->mesh ? f->mesh : name, err));
    tobi_mesh_box(&r->shape, r->lower, r->upper);
    TOBI_TRY(dimension == 3 ? tobi_massprops_volume(&r->shape, &props, err)
                            : tobi_massprops_section(&r->shape, &props, err));
    r->volume = props.volume;
    if (r->shape.texture) r->shape.texture->front = dimension == 2;
    return TOBI_OK;
}

/* In messages. */
static const char *shape_of(const tobi_fill_def *f)
{
    return f->mesh ? f->mesh : tobi_outline_given(&f->outline) ? tr("an outline") : f->radius > 0
    ? tr("a sphere")
                                                                                             : tr("a box");
}

/* `name`: fluid or solid, in messages. */
static tobi_status measure_region(const tobi_system *s, const char *name, const tobi_fill_def *f,
                                  tobi_region *r, tobi_error *err)
{
    const int flat = s->box.dimension == 2, shaped = f->mesh || tobi_outline_given(&f->outline);
    memcpy(r->lower, f->box_min, sizeof r->lower);
    memcpy(r->upper, f->box_max, sizeof r->upper);
    memcpy(r->velocity, f->velocity, sizeof r->velocity);
    memcpy(r->spin, f->spin, sizeof r->spin);
    r->flow = f->flow;
    r->flow_user = f->flow_user;
    r->radius = f->radius;
    if (f->vessel) {                       /* the rest when all bodies are known: vessel.c */
        snprintf(r->vessel, sizeof r->vessel, "%s", f->vessel);
        memcpy(r->seed, f->seed, sizeof r->seed);
        r->level = f->level;
        return TOBI_OK;
    }
    if (shaped) TOBI_TRY(load_shape(name, f, s->box.dimension, r, err));
    for (int a = 0; a < 3; a++) {
        if (shaped || !(f->radius > 0)) continue;
        r->lower[a] = f->centre[a] - f->radius;
        r->upper[a] = f->centre[a] + f->radius;
    }
    for (int a = 0; a < s->box.dimension; a++) {
        if (!(r->upper[a] > r->lower[a]))
            return tobi_fail(err, TOBI_INVALID, "%s: box of fill[%d]: max %g is not above min %g along %c",
                             name, r->number, r->upper[a], r->lower[a], "xyz"[a]);
        if (r->upper[a] <= s->box.lower[a] || r->lower[a] >= s->box.lower[a] + s->box.size[a])
            return tobi_fail(err, TOBI_INVALID,
                             "%s: fill[%d], %s, reaches from %g to %g m along %c and lies outside the "
                             "domain, %g to %g m",
                             name, r->number, shape_of(f),
                             r->lower[a], r->upper[a], "xyz"[a], s->box.lower[a],
                             s->box.lower[a] + s->box.size[a]);
    }
    if (shaped) return TOBI_OK;
    double pi = acos(-1), side[3];
    for (int a = 0; a < 3; a++) side[a] = flat && a == 2 ? 1 : r->upper[a] - r->lower[a];
    r->volume = !(f->radius > 0) ? side[0]*side[1]*side[2]
                : flat           ? pi*f->radius*f->radius
                                 : 4*pi/3*f->radius*f->radius*f->radius;
    return TOBI_OK;
}

/* Takes the last `count` regions away again, and the notes that came with them. */
static void drop_regions(tobi_world *w, int count, int notes)
{
    for (int k = 0; k < count; k++) tobi_mesh_free(&w->regions[--w->region_count].shape);
    tobi_world_drop_notes(w, notes);
}

/* Appends the regions of the next fluid or solid of a system; *volume is their sum, m3 (2-D: m2). */
static tobi_status add_regions(tobi_world *w, const tobi_system *s, const char *kind, const char *name,
                               const tobi_fill_def *fills, int count, double *volume, tobi_error *err)
{
    tobi_region *more = realloc(w->regions, (size_t)(w->region_count + count + 1)*sizeof *more);
    if (!more) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for regions");
    w->regions = more;
    char whose[TOBI_NOTE];
    snprintf(whose, sizeof whose, "%s '%s'", tr(kind), name ? name : "");
    const int notes = w->note_count;
    *volume = 0;
    for (int k = 0; k < count; k++) {
        tobi_region *r = &w->regions[w->region_count];
        memset(r, 0, sizeof *r);
        r->system = (int)(s - w->system);
        r->owner = s->fluid_count + s->solid_count;
        r->number = k;
        tobi_status status = measure_region(s, whose, &fills[k], r, err);
        const char *shape = fills[k].mesh ? "mesh" : tobi_outline_given(&fills[k].outline) ? "outline"
                          : fills[k].radius > 0 ? "sphere" : "box";
        tobi_at_key(err, status, "fill[%d].%s", k, shape);
        w->region_count++;
        *volume += r->volume;
        if (status == TOBI_OK) status = tobi_world_add_notes(w, kind, name, r->shape.notes, err);
        if (status == TOBI_OK) continue;
        drop_regions(w, k + 1, notes);
        return status;
    }
    return TOBI_OK;
}

/* All regions are checked before any of them is read. */
static tobi_status check_fills(const tobi_world *w, const tobi_fill_def *fills, int count, tobi_error *err)
{
    const int room = TOBI_REGION_LIMIT - w->region_count;
    if (count < 0 || count > room || (count > 0 && !fills))
        return tobi_fail(err, TOBI_INVALID, "fill_count is %d%s, allowed is 0 to %d", count,
                         fills ? "" : tr(" and fills is NULL"), room);
    for (int k = 0; k < count; k++) TOBI_TRY(tobi_param_check(&tobi_fill_table, &fills[k], err));
    return TOBI_OK;
}

tobi_status tobi_world_add_fluid(tobi_world *w, const tobi_fluid_def *def,
                                 const tobi_fill_def *fills, int fill_count, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    TOBI_NEED(def, "the definition");
    TOBI_TRY(check_fills(w, fills, fill_count, err));
    tobi_system *s = &w->system[0];
    if (w->started) return tobi_fail(err, TOBI_INVALID, "a started world takes no more fluids");
    TOBI_TRY(tobi_param_check(&tobi_fluid_table, def, err));
    if (w->system[0].method->solids)
        return tobi_fail(err, TOBI_UNSUPPORTED, "%s takes solids, not fluids; a solid of model liquid is one",
                         w->system[0].method->name);
    if (s->fluid_count == TOBI_FLUID_LIMIT)
        return tobi_fail(err, TOBI_UNSUPPORTED, "more than %d fluids", TOBI_FLUID_LIMIT);
    const char *name = def->name ? def->name : "fluid";
    const int notes = w->note_count;
    double volume;
    TOBI_TRY(tobi_names_check_matter(w, "fluid", name, err));
    TOBI_TRY(tobi_mixture_add(w, def, err));
    TOBI_TRY(add_regions(w, s, "fluid", name, fills, fill_count, &volume, err));
    const tobi_status status = note_tension(w, def, err);
    if (status != TOBI_OK) {
        drop_regions(w, fill_count, notes);
        return status;
    }
    tobi_fluid *f = &s->fluid[s->fluid_count++];
    snprintf(f->name, sizeof f->name, "%s", name);
    f->density = def->density;
    f->viscosity = def->viscosity;
    f->yield_stress = def->yield_stress;
    f->flow_index = def->flow_index;
    f->creep_rate = def->creep_rate;
    f->smagorinsky = def->smagorinsky;
    f->tension = def->surface_tension;
    memcpy(f->color, def->color, sizeof f->color);
    f->visible = def->visible;
    return TOBI_OK;
}

tobi_status tobi_world_use_solids(tobi_world *w, const tobi_mlsmpm_def *def, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    if (w->started) return tobi_fail(err, TOBI_INVALID, "a started world takes no more solids");
    if (tobi_world_solids(w))
        return tobi_fail(err, TOBI_INVALID, "the method of the solids is chosen already; its parameters come "
                         "before the first solid");
    return tobi_world_add_system(w, tobi_method_find("mlsmpm"), def, err);
}

/* Behind the last solid of a system, not counted yet. */
static tobi_status make_solid(tobi_world *w, tobi_system *s, const tobi_solid_def *def, const char *name,
                              double volume, int fill_count, char note[TOBI_NOTE], tobi_error *err)
{
    tobi_solid *solid = &s->solids[s->solid_count];
    *solid = (tobi_solid){ .def = *def };
    snprintf(solid->name, sizeof solid->name, "%s", name);
    if (def->clamped_to && !(solid->clamped_to = strdup(def->clamped_to)))
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a solid");
    if (def->mass > 0 && volume > 0) solid->def.density = def->mass/volume;
    if (s->method->accept) TOBI_TRY(s->method->accept(s, s->solid_count, note, err));
    const tobi_texture *coordinates = NULL;
    for (int k = w->region_count - fill_count; k < w->region_count; k++)
        if (w->regions[k].shape.texture) coordinates = w->regions[k].shape.texture;
    return tobi_world_read_image(w, "solid", name, def->texture, coordinates, err);
}

static tobi_status add_solid(tobi_world *w, tobi_system *s, const tobi_solid_def *def,
                             const tobi_fill_def *fills, int fill_count, tobi_error *err)
{
    const char *name = def->name ? def->name : "solid";
    const int notes = w->note_count;
    double volume;
    char note[TOBI_NOTE] = "";
    TOBI_TRY(tobi_names_check_matter(w, "solid", name, err));
    if (s->solid_count == TOBI_SOLID_LIMIT)
        return tobi_fail(err, TOBI_UNSUPPORTED, "more than %d solids", TOBI_SOLID_LIMIT);
    tobi_solid *more = realloc(s->solids, (size_t)(s->solid_count + 1)*sizeof *more);
    if (!more) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a solid");
    s->solids = more;
    TOBI_TRY(add_regions(w, s, "solid", name, fills, fill_count, &volume, err));
    tobi_status status = make_solid(w, s, def, name, volume, fill_count, note, err);
    if (status == TOBI_OK) status = tobi_world_add_notes(w, "solid", name, note, err);
    if (status == TOBI_OK) s->solid_count++;
    else {
        free(s->solids[s->solid_count].clamped_to);
        drop_regions(w, fill_count, notes);
    }
    return status;
}

tobi_status tobi_world_add_solid(tobi_world *w, const tobi_solid_def *def, const tobi_fill_def *fills,
                                 int fill_count, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    TOBI_NEED(def, "the definition");
    TOBI_TRY(check_fills(w, fills, fill_count, err));
    if (w->started) return tobi_fail(err, TOBI_INVALID, "a started world takes no more solids");
    TOBI_TRY(tobi_param_check(&tobi_solid_table, def, err));
    const int alone = !tobi_world_solids(w);
    if (alone) TOBI_TRY(tobi_world_add_system(w, tobi_method_find("mlsmpm"), NULL, err));
    const tobi_status status = add_solid(w, tobi_world_solids(w), def, fills, fill_count, err);
    if (status != TOBI_OK && alone) tobi_world_free_system(&w->system[--w->system_count]);
    return status;
}

static tobi_status check_blades(const tobi_world *w, tobi_error *err)
{
    for (int k = 0; k < w->region_count; k++) {
        const tobi_region *r = &w->regions[k];
        if (!r->blade) continue;
        return tobi_fail(err, TOBI_INVALID,
                         "body '%s' is a blade and starts inside solid '%s': %lld particles lie in it or "
                         "within a quarter of a spacing; a blade starts outside of all solids",
                         w->sim.bodies[r->blade - 1].name, w->system[r->system].solids[r->owner].name,
                         (long long)r->cut);
    }
    return TOBI_OK;
}

/* What an owner's regions could not place: inside bodies, behind planes, inside solids, out of the domain. */
enum { COVERED, BEHIND, SOAKED, OUTSIDE, LOSSES };

/* A solid or fluid without a particle is left out of the run altogether, which nobody asks for. */
static tobi_status check_placed(const char *kind, const char *name, int64_t placed, int64_t taken,
                                const int64_t lost[LOSSES], tobi_error *err)
{
    const long long all = lost[COVERED] + lost[BEHIND] + lost[SOAKED] + lost[OUTSIDE];
    if (placed > 0) return TOBI_OK;
    if (taken > 0)
        return tobi_fail(err, TOBI_INVALID, "no particles are left in %s '%s': later entries of fluids start "
                         "in all of its regions and take its place; write it after them", tr(kind), name);
    if (all == 0)
        return tobi_fail(err, TOBI_INVALID,
                         "no particles at all in %s '%s': its regions are smaller than the distance of "
                         "particles, spacing; allowed are regions of a spacing or more", tr(kind), name);
    return tobi_fail(err, TOBI_INVALID,
                     "no particles at all in %s '%s': of the %lld that it would start with, %lld lie inside "
                     "bodies, %lld behind planes, %lld inside solids and %lld outside the domain; allowed is "
                     "a %s of which a part lies free", tr(kind), name, all, (long long)lost[COVERED],
                     (long long)lost[BEHIND], (long long)lost[SOAKED], (long long)lost[OUTSIDE], tr(kind));
}

/* A line per cause: what was cut off at the domain, by bodies and by planes. */
static tobi_status note_losses(tobi_world *w, const char *kind, const char *name,
                               const int64_t lost[LOSSES], tobi_error *err)
{
    static const char *const what[LOSSES] = { TR("inside bodies were cut out"),
                                             TR("behind planes were cut out"),
                                              TR("inside solids were cut out"),
                                              TR("outside the domain were left out") };
    for (int c = 0; c < LOSSES; c++) {
        char text[TOBI_NOTE];
        snprintf(text, sizeof text, tr("%lld particles that would start %s\n"), (long long)lost[c],
                 tr(what[c]));
        if (lost[c] > 0) TOBI_TRY(tobi_world_add_notes(w, kind, name, text, err));
    }
    return TOBI_OK;
}

/* What regions placed may have become another fluid since. */
static int64_t count_fluid(const tobi_particles *p, int fluid)
{
    int64_t count = 0;
    for (int64_t i = 0; i < p->count; i++) count += p->fluid[i] == fluid;
    return count;
}

static tobi_status note_owners(tobi_world *w, const tobi_system *s, tobi_error *err)
{
    const int solids = s->solid_count > 0, owners = solids ? s->solid_count : s->fluid_count;
    for (int k = 0; k < owners; k++) {
        const char *kind = solids ? "solid" : "fluid", *name = solids ? s->solids[k].name : s->fluid[k].name;
        int64_t lost[LOSSES] = { 0 }, placed = 0;
        int regions = 0;
        for (int n = 0; n < w->region_count; n++) {
            const tobi_region *r = &w->regions[n];
            if (&w->system[r->system] != s || r->owner != k) continue;
            lost[COVERED] += r->covered;
            lost[BEHIND] += r->behind;
            lost[SOAKED] += r->soaked;
            lost[OUTSIDE] += r->outside;
            placed += r->placed;
            regions++;
        }
        const int64_t held = solids ? placed : count_fluid(&s->particles, k);
        const tobi_status status =
            regions > 0 && !s->sim->nest.outer ? check_placed(kind, name, held, placed, lost, err) : TOBI_OK;
        TOBI_TRY(tobi_at_key(err, status, "%ss[%d].fill", kind, k));
        TOBI_TRY(note_losses(w, kind, name, lost, err));
    }
    return TOBI_OK;
}

tobi_status tobi_world_note_regions(tobi_world *w, tobi_error *err)
{
    TOBI_TRY(check_blades(w, err));
    for (int k = 0; k < w->system_count; k++) TOBI_TRY(note_owners(w, &w->system[k], err));
    return TOBI_OK;
}
