/* Notes on numbers that are likely in other units than metres, kilograms and seconds: each is possible, and
   seldom meant. Drawback: a rule of thumb each, wide enough to say nothing of tanks, rivers and drops. */
#include "base/error.h"
#include "geom/vec3.h"
#include "sph/stages.h"
#include "world/world.h"
#include <math.h>
#include <stdio.h>

/* kg/m3: no liquid is lighter, gases are. Share of the liquid's density below which no method is trusted with
   a free body; and above which none is made of a solid. */
static const double GAS = 50, LIGHTEST = 0.01, HEAVIEST = 50;
/* m/s2: some thirty times the earth's. */
static const double STRONG = 300;
/* Degrees: no sand is as smooth; it is more than a right angle in radians. */
static const double SMOOTH = 2;
/* m/s: faster than any hose. */
static const double JET = 30;
/* m, and the share of its height that the liquid falls until the end: more than a first look takes. */
static const double HIGH = 10, FALLS = 0.1;
/* Steps until the end that viscosity alone asks for, and their length over that of a fall by a spacing. */
static const double MANY = 1e5, SHORT = 0.05;

static tobi_status note_gas(tobi_world *w, tobi_error *err)
{
    const tobi_system *s = &w->system[0];
    double least, most;
    char text[TOBI_NOTE];
    tobi_system_densities(s, &least, &most);
    if (!(most < GAS) || least < most) return TOBI_OK;      /* of two liquids the ratio counts */
    snprintf(text, sizeof text, tr("its density is %.3g kg/m3, that of a gas; water has 1000 kg/m3\n"), most);
    return tobi_world_add_notes(w, "fluid", s->fluid[0].name, text, err);
}

static tobi_status note_bodies(tobi_world *w, tobi_error *err)
{
    double least, most;
    char text[TOBI_NOTE];
    tobi_system_densities(&w->system[0], &least, &most);
    for (int k = 0; k < w->sim.body_count; k++) {
        const tobi_body *b = &w->sim.bodies[k];
        const double density = b->rigid.mass/b->rest.volume, part = density/most;
        if (b->rigid.kind == TOBI_PRESCRIBED || !(part < LIGHTEST || part > HEAVIEST)) continue;
        snprintf(text, sizeof text, tr("its density is %.3g kg/m3, %.3g times that of the liquid: are both "
                 "in kg/m3? %s\n"), density, part, part < 1 ? tr("Lighter than 0.01 times it bodies do not "
                 "float as they should") : tr("Water has 1000 kg/m3"));
        TOBI_TRY(tobi_world_add_notes(w, "body", b->name, text, err));
    }
    return TOBI_OK;
}

/* Mass inside a body is nowhere farther from an axis than its box reaches. */
static tobi_status note_inertia(tobi_world *w, tobi_error *err)
{
    for (int k = 0; k < w->sim.body_count; k++) {
        const tobi_body *b = &w->sim.bodies[k];
        double min[3], max[3], reach[3];
        char text[TOBI_NOTE];
        if (b->rigid.kind == TOBI_PRESCRIBED || b->rigid.deforms) continue;
        tobi_mesh_box(&b->mesh, min, max);
        for (int a = 0; a < 3; a++) reach[a] = fmax(max[a] - b->rest.centre[a], b->rest.centre[a] - min[a]);
        for (int a = w->sim.def.dimension == 2 ? 2 : 0; a < 3; a++) {
            const double far = hypot(reach[(a + 1)%3], reach[(a + 2)%3]);
            const double gyration = sqrt(b->rigid.inertia[4*a]/b->rigid.mass);
            if (!(gyration > 1.001*far)) continue;
            snprintf(text, sizeof text, tr("its radius of gyration about %c is %.3g m, and no part of it is "
                     "farther than %.3g m from there: is its inertia in kg m2, and its mass in kg?\n"),
                     "xyz"[a], gyration, far);
            TOBI_TRY(tobi_world_add_notes(w, "body", b->name, text, err));
        }
    }
    return TOBI_OK;
}

static tobi_status note_gravity(tobi_world *w, double g, tobi_error *err)
{
    char text[TOBI_NOTE];
    if (!(g > STRONG)) return TOBI_OK;
    snprintf(text, sizeof text, tr("is %.4g m/s2, %.4g times that of the earth: are lengths in metres?\n"), g,
             g/9.81);
    return tobi_world_add_notes(w, "world", "gravity", text, err);
}

/* A number without its sign: everything falls to the lid. */
static tobi_status note_up(tobi_world *w, double g, tobi_error *err)
{
    const int up = w->sim.def.dimension - 1;
    const double along = w->sim.def.gravity[up];
    char text[TOBI_NOTE];
    if (!(along > 0.5*g)) return TOBI_OK;
    snprintf(text, sizeof text, tr("points upwards: its %c is %.4g m/s2; on the earth it is -9.81\n"),
             "xyz"[up], along);
    return tobi_world_add_notes(w, "world", "gravity", text, err);
}

/* Lengths in millimetres make a puddle an ocean, in which nothing happens within its seconds. */
static tobi_status note_size(tobi_world *w, double g, tobi_error *err)
{
    const double end = w->sim.def.end_time, height = w->system[0].start_head/g, fall = 0.5*g*end*end;
    char text[TOBI_NOTE];
    if (w->sim.opening_count > 0) return TOBI_OK;      /* their speed counts as a height, too */
    if (!(height > HIGH && end > 0 && fall < FALLS*height)) return TOBI_OK;
    snprintf(text, sizeof text, tr("is %.3g s, in which things fall by %.3g m, and the liquid is %.4g m "
             "high: are lengths in metres?\n"), end, fall, height);
    return tobi_world_add_notes(w, "world", "end_time", text, err);
}

static tobi_status note_viscosity(tobi_world *w, double g, tobi_error *err)
{
    const tobi_system *s = &w->system[0];
    const double step = sph_viscous_dt(s), fall = 0.25*sqrt(s->smoothing.spacing/fmax(g, 1e-12));
    int most = 0;
    char text[TOBI_NOTE];
    if (w->sim.def.implicit_viscosity) return TOBI_OK;
    if (!(w->sim.def.end_time/step > MANY && step < SHORT*fall) || w->sim.def.time_step > 0) return TOBI_OK;
    for (int f = 1; f < s->fluid_count; f++) {
        const tobi_fluid *a = &s->fluid[f], *b = &s->fluid[most];
        if (a->viscosity/a->density > b->viscosity/b->density) most = f;
    }
    snprintf(text, sizeof text, tr("its viscosity, %.4g Pa s, allows steps of %.2g s, %.0f of them until %g "
             "s; water has 0.001 Pa s, honey 10; implicit_viscosity has no such bound\n"),
             s->fluid[most].viscosity, step, w->sim.def.end_time/step,
             w->sim.def.end_time);
    return tobi_world_add_notes(w, "fluid", s->fluid[most].name, text, err);
}

static tobi_status note_jets(tobi_world *w, tobi_error *err)
{
    for (int k = 0; k < w->sim.opening_count; k++) {
        const tobi_opening *o = &w->sim.openings[k];
        char text[TOBI_NOTE];
        if (!(o->speed > JET)) continue;
        snprintf(text, sizeof text, tr("lets liquid in at up to %.4g m/s: are lengths in metres, and flow "
                 "rates in %s?\n"), o->speed, w->sim.def.dimension == 2 ? "m2/s" : "m3/s");
        TOBI_TRY(tobi_world_add_notes(w, "inlet", o->name, text, err));
    }
    return TOBI_OK;
}

static tobi_status note_sand(tobi_world *w, const tobi_system *s, tobi_error *err)
{
    for (int m = 0; m < s->solid_count; m++) {
        const tobi_solid_def *def = &s->solids[m].def;
        char text[TOBI_NOTE];
        if (def->model != TOBI_SAND || !(def->friction_angle > 0 && def->friction_angle < SMOOTH)) continue;
        snprintf(text, sizeof text,
                 tr("its friction_angle is %.3g degrees; that of sand is 25 to 45 degrees, "
                    "0.44 to 0.79 in radians\n"), def->friction_angle);
        TOBI_TRY(tobi_world_add_notes(w, "solid", s->solids[m].name, text, err));
    }
    return TOBI_OK;
}

/* A gel whose stiffness stands in kPa is a puddle. */
static tobi_status note_solids(tobi_world *w, const tobi_system *s, double g, tobi_error *err)
{
    for (int m = 0; m < s->solid_count; m++) {
        const tobi_solid_def *def = &s->solids[m].def;
        double low = INFINITY, high = -INFINITY;
        char text[TOBI_NOTE];
        if (def->model != TOBI_NEO_HOOKEAN && def->model != TOBI_COROTATED &&
            def->model != TOBI_VON_MISES && def->model != TOBI_SAND) continue;
        for (int64_t i = 0; i < s->particles.count; i++) {
            if (s->particles.fluid[i] != m) continue;
            const double x[3] = { s->particles.position[i].x, s->particles.position[i].y,
                                  s->particles.position[i].z };
            const double height = -vec3_dot(w->sim.def.gravity, x)/g;
            low = fmin(low, height);
            high = fmax(high, height);
        }
        const double weight = def->density*g*(high - low);
        if (!(weight > def->youngs_modulus)) continue;
        snprintf(text, sizeof text, tr("its own weight presses with %.3g Pa, more than its youngs_modulus of "
                 "%.3g Pa: are that in Pa and its density in kg/m3?\n"), weight, def->youngs_modulus);
        TOBI_TRY(tobi_world_add_notes(w, "solid", s->solids[m].name, text, err));
    }
    return TOBI_OK;
}

tobi_status tobi_world_note_units(tobi_world *w, tobi_error *err)
{
    const double g = vec3_length(w->sim.def.gravity);
    TOBI_TRY(note_gravity(w, g, err));
    TOBI_TRY(note_up(w, g, err));
    TOBI_TRY(note_jets(w, err));
    TOBI_TRY(note_inertia(w, err));
    for (int k = 0; k < w->system_count; k++) TOBI_TRY(note_sand(w, &w->system[k], err));
    for (int k = 0; k < w->system_count && g > 0; k++) TOBI_TRY(note_solids(w, &w->system[k], g, err));
    if (w->system[0].fluid_count == 0) return TOBI_OK;
    TOBI_TRY(note_gas(w, err));
    TOBI_TRY(note_bodies(w, err));
    if (g > 0) TOBI_TRY(note_size(w, g, err));
    return w->system[0].method->solids ? TOBI_OK : note_viscosity(w, g, err);
}
