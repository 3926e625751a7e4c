/* How much room inlets and outlets leave: for a free surface, and for more liquid. Drawback: what bodies take
   of the domain counts for notes alone, where those that reach into each other count twice. */
#include "world/openings.h"
#include "base/error.h"
#include <math.h>
#include <stdio.h>

static double measure_domain(const tobi_system *s)
{
    double size = 1;
    for (int a = 0; a < s->box.dimension; a++) size *= s->box.size[a];
    return size;
}

/* What bodies leave of it at the start. */
static double measure_room(const tobi_system *s)
{
    double room = measure_domain(s);
    for (int k = 0; k < s->sim->body_count; k++) {
        const tobi_body *b = &s->sim->bodies[k];
        if (!b->vessel && !b->is_absent) room -= b->rest.volume;
    }
    return room;
}

double tobi_openings_share(const tobi_system *s)
{
    int inlets = 0;
    for (int k = 0; k < s->sim->opening_count; k++) {
        if (s->sim->openings[k].outlet) return 0;
        inlets++;
    }
    return inlets ? (double)s->particles.count*s->smoothing.volume/measure_domain(s) : 0;
}

/* How much more liquid than the whole domain holds is no rounding of a lattice. */
static const double OVERFULL = 1.05;

/* Liquid that inlets press into a domain without room and without an outlet has no pressure that is right:
   methods crowd it, and then it is thrown about. */
tobi_status tobi_openings_check_room(const tobi_world *w, tobi_error *err)
{
    const double fill = tobi_openings_share(&w->system[0]), room = measure_domain(&w->system[0]);
    const char *unit = w->system[0].box.dimension == 2 ? "m2" : "m3";
    if (fill < OVERFULL) return TOBI_OK;
    return tobi_fail(err, TOBI_DIVERGED, "the inlets have overfilled the domain at t = %.9g s: %.4g %s of "
                     "liquid, the domain has %.4g %s; stop the inlets before, add an outlet, or make the "
                     "domain larger", w->sim.time, fill*room, unit, room, unit);
}

/* Share of the domain from which liquid leaves no room for a free surface, but in the buffers. */
static const double FULL = 0.8;
/* Particles beside an inlet that a lattice may leave there by rounding. */
enum { FEW = 4 };

/* How many particles lie beside or behind the place that is free behind the buffer of an inlet. */
static int64_t count_beside(const tobi_system *s, const tobi_opening *o)
{
    const double far = -TOBI_OPENING_BEHIND*o->depth, near = 1.5*s->smoothing.spacing;
    int64_t count = 0;
    for (int64_t i = 0; i < s->particles.count; i++) {
        const tobi_double3 *p = &s->particles.position[i];
        const double x[3] = { p->x, p->y, p->z };
        double at[3];
        tobi_opening_locate(o, x, at);
        if (at[0] > -o->depth || at[0] < far - near) continue;
        const double beside = o->radius > 0 ? hypot(at[1], at[2]) - o->radius
                                            : fmax(fabs(at[1]) - o->half[0], fabs(at[2]) - o->half[1]);
        count += at[0] < far ? beside < 0 : beside > 0 && beside < near;
    }
    return count;
}

tobi_status tobi_openings_note_pools(tobi_world *w, tobi_error *err)
{
    const tobi_system *s = &w->system[0];
    char text[TOBI_NOTE];
    for (int k = 0; k < w->sim.opening_count; k++) {
        const tobi_opening *o = &w->sim.openings[k];
        if (o->outlet || count_beside(s, o) < FEW) continue;
        snprintf(text, sizeof text, tr("lies in liquid: behind its buffer a hole is left free, %.3g m deep, "
                 "and the liquid beside it falls in at the start; put a body around the hole, or the inlet "
                 "above the liquid or at a side\n"), (TOBI_OPENING_BEHIND - 1)*o->depth);
        TOBI_TRY(tobi_world_add_notes(w, "inlet", o->name, text, err));
    }
    return TOBI_OK;
}

/* Whether an outlet with a pressure has liquid before its plane, less than that beyond it, and nothing that
   moves it there: gravity, an inlet, or its velocity. */
static int stays_dry(const tobi_system *s, const tobi_opening *o)
{
    const double *g = s->sim->def.gravity;
    int64_t before = 0, beyond = 0;
    double out = 0;
    for (int64_t i = 0; i < s->particles.count; i++) {
        const tobi_double3 *p = &s->particles.position[i];
        const tobi_float4 *v = &s->particles.velocity[i];
        double at[3];
        tobi_opening_locate(o, (double[3]){ p->x, p->y, p->z }, at);
        if (!tobi_opening_faces(o, at)) continue;
        beyond += at[0] >= 0 && at[0] < tobi_outlet_depth(o, &s->smoothing);
        if (at[0] >= 0 || at[0] < -s->smoothing.spacing) continue;
        before++;
        out += v->x*o->normal[0] + v->y*o->normal[1] + v->z*o->normal[2];
    }
    int driven = g[0]*g[0] + g[1]*g[1] + g[2]*g[2] > 0;
    for (int k = 0; k < s->sim->opening_count; k++) driven |= !s->sim->openings[k].outlet;
    return beyond < before && (driven ? out < 0 : out <= 0);
}

/* The pressure of an outlet acts by the particles beyond its plane, and new ones there are copies of them. */
tobi_status tobi_openings_note_dry(tobi_world *w, tobi_error *err)
{
    const tobi_system *s = &w->system[0];
    char text[TOBI_NOTE];
    for (int k = 0; k < w->sim.opening_count; k++) {
        const tobi_opening *o = &w->sim.openings[k];
        if (!o->gives || !stays_dry(s, o)) continue;
        snprintf(text, sizeof text, tr("presses by the liquid beyond its plane, and none is there at the "
                 "start: none comes in, and the pressure at the plane is 0; let the region before it reach "
                 "%.3g m beyond the plane\n"), tobi_outlet_depth(o, &s->smoothing));
        TOBI_TRY(tobi_world_add_notes(w, "outlet", o->name, text, err));
    }
    return TOBI_OK;
}

/* The name of an outlet without a pressure, or NULL. */
static const char *find_free_outlet(const tobi_simulation *s)
{
    for (int k = 0; k < s->opening_count; k++)
        if (s->openings[k].outlet && s->openings[k].gives == TOBI_GIVES_NOTHING) return s->openings[k].name;
    return NULL;
}

/* A full pipe that nothing but pressures at its ends drives, by a method that does not carry it. */
static tobi_status note_ends(tobi_world *w, tobi_error *err)
{
    const tobi_opening *o = w->sim.openings, *first = NULL;
    char text[TOBI_NOTE];
    int ends = 0;
    for (int k = 0; k < w->sim.opening_count; k++) {
        if (!o[k].outlet) return TOBI_OK;
        if (o[k].gives && ends++ == 0) first = &o[k];
    }
    if (ends < 2 || !w->system[0].method->sound) return TOBI_OK;
    snprintf(text, sizeof text, tr("drives a full pipe by its pressure: by %s such a flow swings more and "
             "more until it diverges; isph carries it, and an inlet with a speed or a flow_rate keeps it "
             "steady\n"), w->system[0].method->name);
    return tobi_world_add_notes(w, "outlet", first->name, text, err);
}

tobi_status tobi_openings_note(tobi_world *w, tobi_error *err)
{
    const tobi_system *s = &w->system[0];
    const char *outlet = find_free_outlet(&w->sim);
    char text[TOBI_NOTE];
    if (w->sim.opening_count == 0) return TOBI_OK;
    if ((double)s->particles.count*s->smoothing.volume < FULL*measure_room(s)) return TOBI_OK;
    TOBI_TRY(note_ends(w, err));
    if (s->method->fills_pipes && !outlet) return TOBI_OK;
    if (s->method->fills_pipes)
        snprintf(text, sizeof text, tr("where the pressure falls below 0 a full pipe gets cavities "
                 "(mass_held in history.csv falls); a pressure of the outlet '%s', density x speed^2 of the "
                 "fastest place, keeps it full\n"), outlet);
    else
        snprintf(text, sizeof text, tr("%s crowds or loses liquid where inlets and outlets leave no free "
                 "surface, as in a full pipe; isph keeps it\n"), s->method->name);
    return tobi_world_add_notes(w, "world", "method", text, err);
}
