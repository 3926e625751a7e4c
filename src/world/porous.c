/* The world's porous zones: added by definition after the fluids, read by number (their places:
   porous_place.c). Drawback: what is in a zone is the same in all of it. */
#include "base/error.h"
#include "base/param.h"
#include "geom/vec3.h"
#include "world/names.h"
#include "world/world.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Stones that fill less of a zone leave its porosity out of account at little price. */
static const double OPEN_ENOUGH = 0.8;

/* 1/s and 1/m: a step of a stronger drag leaves less of a velocity than single precision keeps of it, and
   force and work, which are that rest times the drag, would be noise. */
static const double STRONGEST = 1e7;

#define REFUSE(key, ...) return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, __VA_ARGS__), "%s", key)

/* Which of the four it is: exactly one. */
static tobi_status check_kind(const tobi_porous_def *d, tobi_error *err)
{
    const int stones = d->stone_size > 0 || d->porosity > 0,
              stems = d->stem_number > 0 || d->stem_diameter > 0,
              screen = d->screen_loss > 0, direct = d->linear > 0 || d->quadratic > 0;
    if (stones + stems + screen + direct != 1)
        REFUSE("", tr("porous zone '%s' has %s of stones, stems, screen and resistance; allowed is one, with "
               "a value above 0"), d->name, stones + stems + screen + direct ? tr("more than one")
               : tr("none"));
    if (stones && !(d->stone_size > 0 && d->porosity > 0))
        REFUSE("stones", tr("porous zone '%s': stones have a size and a porosity"), d->name);
    if (stems && !(d->stem_number > 0 && d->stem_diameter > 0))
        REFUSE("stems", tr("porous zone '%s': stems have a number and a diameter"), d->name);
    return TOBI_OK;
}

/* The direction of stems or across a screen. */
static tobi_status find_direction(const tobi_world *w, const tobi_porous_def *def, tobi_porous *z,
                                  tobi_error *err)
{
    const int dimension = w->system[0].box.dimension, given = vec3_length(def->direction) > 0;
    memcpy(z->direction, def->direction, sizeof z->direction);
    if (!given && z->kind == TOBI_POROUS_ALONG) tobi_porous_thin_direction(z, dimension, z->direction);
    if (z->radial) return TOBI_OK;
    if (z->kind == TOBI_POROUS_ALONG && !(vec3_length(z->direction) > 0))
        REFUSE("direction", tr("porous zone '%s': a screen in a cylinder without an inner radius has no thin "
               "side; give its direction"), def->name);
    if (!given && z->kind == TOBI_POROUS_ACROSS) vec3_sub(z->direction, z->direction, w->sim.def.gravity);
    if (!(vec3_length(z->direction) > 0))
        REFUSE("direction", tr("porous zone '%s': stems stand upwards, and there is no gravity; give their "
               "direction"), def->name);
    vec3_normalize(z->direction);
    if (dimension == 3 || z->direction[2] == 0) return TOBI_OK;
    if (z->kind == TOBI_POROUS_ALONG || z->direction[0] != 0 || z->direction[1] != 0)
        REFUSE("direction", tr("porous zone '%s': a direction in 2-D lies in the plane, or is that of stems "
               "across it"), def->name);
    z->kind = TOBI_POROUS_ALL;
    z->direction[2] = 0;
    return TOBI_OK;
}

static void resist(const tobi_porous_def *d, tobi_porous *z, double across)
{
    const double n = d->porosity, solid = 1 - n, n3 = n*n*n;
    z->linear = d->linear;
    z->quadratic = d->quadratic + 0.5*d->stem_number*d->stem_diameter*d->stem_drag +
                   0.5*d->screen_loss/across;
    if (!(n > 0)) return;
    z->porosity = n;
    z->size = d->stone_size;
    z->per_viscosity = d->linear_coefficient*solid*solid/(n3*d->stone_size*d->stone_size);
    z->quadratic = d->quadratic_coefficient*solid/(n3*d->stone_size);
}

static tobi_status check_drag(const tobi_world *w, const char *name, const tobi_porous *z, tobi_error *err)
{
    const tobi_system *s = &w->system[0];
    double viscosity = 0;
    for (int k = 0; k < s->fluid_count; k++)
        viscosity = fmax(viscosity, s->fluid[k].viscosity/s->fluid[k].density);
    const double linear = z->linear + z->per_viscosity*viscosity;
    if (linear <= STRONGEST && z->quadratic <= STRONGEST) return TOBI_OK;
    REFUSE("", tr("porous zone '%s' resists by a = %.3g 1/s and b = %.3g 1/m, allowed are up to %g each: "
           "what lets next to nothing through is a body"), name, linear, z->quadratic, STRONGEST);
}

/* What is in it, of a zone that has its place. */
static tobi_status fill_zone(const tobi_world *w, const tobi_porous_def *def, tobi_porous *z, tobi_error *err)
{
    TOBI_TRY(check_kind(def, err));
    if (def->stem_number > 0) z->kind = TOBI_POROUS_ACROSS;
    if (def->screen_loss > 0) z->kind = TOBI_POROUS_ALONG;
    if (z->kind == TOBI_POROUS_ALL && vec3_length(def->direction) > 0)
        REFUSE("direction", tr("porous zone '%s': a direction is of stems and of a screen; stones and "
               "resistance act alike in all"), def->name);
    if (z->kind != TOBI_POROUS_ALL) TOBI_TRY(find_direction(w, def, z, err));
    resist(def, z, def->screen_loss > 0 ? tobi_porous_thickness(z, w->system[0].box.dimension) : 1);
    snprintf(z->name, sizeof z->name, "%s", def->name);
    return check_drag(w, def->name, z, err);
}

/* The body that carries it. */
static tobi_status find_carrier(const tobi_world *w, const tobi_porous_def *def, tobi_porous *z,
                                tobi_error *err)
{
    if (!def->body) return TOBI_OK;
    const int body = tobi_world_find_body(w, def->body);
    if (body < 0)
        return tobi_at_key(err, tobi_fail(err, TOBI_NOT_FOUND, "porous zone '%s' goes along with '%s', which "
                                          "is no body", def->name, def->body), "body");
    if (w->sim.bodies[body].deforms)
        return tobi_at_key(err, tobi_fail(err, TOBI_UNSUPPORTED, "porous zone '%s' goes along with '%s', "
                                          "which changes its shape; allowed are rigid bodies", def->name,
                                          def->body), "body");
    z->carrier = body + 1;
    z->answer.leads = 1;
    for (int k = 0; k < w->sim.porous_count; k++) z->answer.leads &= w->sim.porous[k].carrier != z->carrier;
    tobi_porous_attach(z, &w->sim.bodies[body]);         /* pictures need no start */
    return TOBI_OK;
}

tobi_status tobi_world_add_porous(tobi_world *w, const tobi_porous_def *def, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    TOBI_NEED(def, "the definition");
    TOBI_TRY(tobi_param_check(&tobi_porous_table, def, err));
    TOBI_NEED(def->name, "the name of the zone");
    tobi_porous z = { .kind = TOBI_POROUS_ALL };
    if (w->started) return tobi_fail(err, TOBI_INVALID, "a started world takes no more porous zones");
    if (w->system[0].method->solids)
        return tobi_fail(err, TOBI_UNSUPPORTED, "%s knows no porous zones; they are for the liquids of the "
                         "SPH methods", w->system[0].method->name);
    if (w->sim.porous_count == TOBI_POROUS_LIMIT)
        return tobi_fail(err, TOBI_UNSUPPORTED, "more than %d porous zones", TOBI_POROUS_LIMIT);
    TOBI_TRY(tobi_names_check_porous(w, def->name, err));
    tobi_status status = tobi_porous_place(w, def, &z, err);
    if (status == TOBI_OK) status = fill_zone(w, def, &z, err);
    if (status == TOBI_OK) status = find_carrier(w, def, &z, err);
    if (status == TOBI_OK) w->sim.porous[w->sim.porous_count++] = z;
    else free(z.corners);
    return status;
}

const char *tobi_world_porous(const tobi_world *w, int zone, tobi_porous_info *info)
{
    if (!w || zone < 0 || zone >= w->sim.porous_count) return NULL;
    const tobi_porous *z = &w->sim.porous[zone];
    const tobi_fluid *f = &w->system[0].fluid[0];
    if (!info) return z->name;
    *info = (tobi_porous_info){ .power = z->power, .volume = z->volume, .quadratic = z->quadratic,
                                .linear = z->linear, .along = z->kind == TOBI_POROUS_ALONG,
                                .extent = z->extent, .radial = z->radial,
                                .body = z->carrier ? w->sim.bodies[z->carrier - 1].name : NULL };
    if (w->system[0].fluid_count > 0) info->linear += z->per_viscosity*f->viscosity/f->density;
    memcpy(info->force, z->force, sizeof info->force);
    if (z->kind != TOBI_POROUS_ALL) memcpy(info->direction, z->direction, sizeof info->direction);
    if (z->radial) info->direction[z->axis] = 1;
    return z->name;
}

void tobi_world_start_porous(tobi_world *w)
{
    for (int k = 0; k < w->sim.porous_count; k++) {
        tobi_porous *z = &w->sim.porous[k];
        if (z->carrier) tobi_porous_attach(z, &w->sim.bodies[z->carrier - 1]);
    }
}

/* Of a body with a motion, the mean over the step. */
static tobi_status ask_motion(const tobi_simulation *s, const tobi_body *b, tobi_porous *z, tobi_error *err)
{
    double centre[3], frame[3][3], *u = z->pose.now;
    memset(u, 0, sizeof z->pose.now);
    if (b->motion && s->dt > 0) {
        TOBI_TRY(tobi_body_find_frame(b, s->time + s->dt, centre, frame, err));
        for (int a = 0; a < 3; a++) u[a] = (centre[a] - b->centre[a])/s->dt;
        tobi_frame_rate((const double (*)[3])b->frame, (const double (*)[3])frame, s->dt, u + 3);
    }
    memcpy(z->pose.speed, u, sizeof z->pose.speed);
    return TOBI_OK;
}

tobi_status tobi_world_carry_porous(tobi_world *w, tobi_error *err)
{
    for (int k = 0; k < w->sim.porous_count; k++) {
        tobi_porous *z = &w->sim.porous[k];
        const tobi_body *b = z->carrier ? &w->sim.bodies[z->carrier - 1] : NULL;
        if (b) tobi_porous_follow(z, b);
        if (b && b->rigid.kind == TOBI_PRESCRIBED) TOBI_TRY(ask_motion(&w->sim, b, z, err));
    }
    return TOBI_OK;
}

/* Whether liquid is in it at the start, or may come. */
static int can_be_wet(const tobi_world *w, const tobi_porous *z)
{
    const tobi_system *s = &w->system[0];
    for (int64_t i = 0; i < s->particles.count; i++)
        if (tobi_porous_holds(z, s->box.dimension, &s->particles.position[i].x)) return 1;
    return 0;
}

tobi_status tobi_world_note_porous(tobi_world *w, tobi_error *err)
{
    const double d = w->system[0].smoothing.spacing;
    char text[TOBI_NOTE];
    for (int k = 0; k < w->sim.porous_count; k++) {
        const tobi_porous *z = &w->sim.porous[k];
        const double least = z->thickness;
        if (least < 2*d*(1 - 1e-9)) {
            snprintf(text, sizeof text, tr("is %.4g m thin, %.2g spacings: particles pass it in a few steps, "
                     "and its drag is that of a thicker or thinner one; a spacing of %.3g m would do\n"),
                     least, least/d, 0.5*least);
            TOBI_TRY(tobi_world_add_notes(w, "porous zone", z->name, text, err));
        }
        if (z->porosity > 0 && z->porosity < OPEN_ENOUGH) {
            snprintf(text, sizeof text, tr("has stones of a porosity of %.3g, and liquid fills it as if "
                     "there were none: levels in it change too slowly by this factor, and liquid in it has "
                     "too little inertia; it resists as it should\n"), z->porosity);
            TOBI_TRY(tobi_world_add_notes(w, "porous zone", z->name, text, err));
        }
        if (can_be_wet(w, z)) continue;
        TOBI_TRY(tobi_world_add_notes(w, "porous zone", z->name, tr("has no liquid in it at the start: it "
                                      "acts once liquid comes\n"), err));
    }
    return TOBI_OK;
}
