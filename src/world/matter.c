/* What a body is made of and how it floats, told before a run. Drawback: upright as it starts, in the only
   liquid of the world; that it trims or lists is not found. */
#include "base/error.h"
#include "geom/flotation.h"
#include "geom/vec3.h"
#include "tobiuo/matter.h"
#include "world/world.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* kg/m3, of the only liquid; 0: none or several. */
static double find_liquid(const tobi_world *w)
{
    int count = 0;
    double density = 0;
    for (int k = 0; k < w->system_count; k++) {
        count += w->system[k].fluid_count;
        if (w->system[k].fluid_count > 0) density = w->system[k].fluid[0].density;
    }
    return count == 1 ? density : 0;
}

/* The axis that gravity is along, and which way is up; -1: along none. */
static int find_up(const tobi_world *w, int *sign)
{
    int up = -1, count = 0;
    for (int a = 0; a < 3; a++) {
        const double g = w->sim.def.gravity[a];
        if (g == 0) continue;
        up = a;
        *sign = g < 0 ? 1 : -1;
        count++;
    }
    return count == 1 ? up : -1;
}

static int count_held(const tobi_world *w, const char *name)
{
    const size_t length = strlen(name);
    int count = 0;
    for (int k = 0; k < w->system_count; k++)
        for (int n = 0; n < w->system[k].solid_count; n++)
            for (const char *at = w->system[k].solids[n].clamped_to; at; at = strchr(at, ',')) {
                at += *at == ',';
                count += strncmp(at, name, length) == 0 && (at[length] == ',' || at[length] == '\0');
            }
    return count;
}

static int is_joined(const tobi_world *w, int body)
{
    const tobi_constraints *c = &w->sim.constraints;
    for (int k = 0; k < c->count; k++)
        if (c->at[k].body[0] == body || c->at[k].body[1] == body) return 1;
    return 0;
}

static void find_flotation(const tobi_world *w, const tobi_body *b, tobi_body_matter *m)
{
    tobi_error unused = { 0 };
    tobi_flotation f;
    int sign = 1;
    const int up = find_up(w, &sign), dimension = w->system[0].box.dimension;
    if (!(m->liquid > 0) || up < 0 || !(m->mass < m->liquid*m->volume)) return;
    if (b->vessel || b->deforms || b->mesh.overlapping || b->rigid.joint.kind) return;
    const double displaced = m->mass/m->liquid;
    if (tobi_flotation_find(&b->mesh, dimension, up, sign, displaced, &f, &unused) != TOBI_OK) return;
    m->draught = f.draught;
    for (int a = 0; a < 3; a++)
        if (a != up && (dimension == 3 || a == 2))
            m->metacentre[a] = f.inertia[a]/displaced + f.buoyancy - sign*(m->centre[up] - f.lowest);
}

/* Of a body whose centre of mass is given, as of a ship: a box that was dropped may well turn over. */
tobi_status tobi_world_note_balance(tobi_world *w, tobi_error *err)
{
    char text[TOBI_NOTE];
    tobi_body_matter m;
    for (int k = 0; tobi_world_body_matter(w, k, &m) == TOBI_OK; k++) {
        const tobi_body *b = &w->sim.bodies[k];
        if (vec3_dot(b->middle, b->middle) == 0) continue;
        for (int a = 0; a < 3; a++) {
            if (!(m.metacentre[a] < 0) || b->rigid.locked >> (3 + a) & 1) continue;
            snprintf(text, sizeof text, tr("it capsizes about %c: its GM is %.3g m, below 0. A lower "
                     "centre_of_mass, or ballast, makes it upright\n"), "xyz"[a], m.metacentre[a]);
            TOBI_TRY(tobi_world_add_notes(w, "body", b->name, text, err));
        }
    }
    return TOBI_OK;
}

tobi_status tobi_world_body_matter(const tobi_world *w, int body, tobi_body_matter *m)
{
    if (!w || !m) return TOBI_INVALID;
    if (body < 0 || body >= w->sim.body_count) return TOBI_NOT_FOUND;
    const tobi_body *b = &w->sim.bodies[body];
    *m = (tobi_body_matter){ .dynamics = b->rigid.kind, .mass = b->info.mass, .volume = b->info.volume,
                              .solids = count_held(w, b->name), .liquid = find_liquid(w) };
    memcpy(m->centre, b->rest.centre, sizeof m->centre);
    memcpy(m->inertia, b->info.inertia, sizeof m->inertia);
    if (b->rigid.kind != TOBI_PRESCRIBED && !is_joined(w, body) && m->solids == 0) find_flotation(w, b, m);
    return TOBI_OK;
}
