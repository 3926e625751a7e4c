/* What a world tells about its solids. */
#include "base/error.h"
#include "world/params.h"
#include "world/world.h"
#include <math.h>
#include <stdio.h>

int tobi_world_solid_count(const tobi_world *w)
{
    const tobi_system *s = w ? tobi_world_solids(w) : NULL;
    return s ? s->solid_count : 0;
}

static double cell_of(const tobi_world *w)
{
    double d = w->system[0].smoothing.spacing;
    return w->system[0].box.dimension == 3 ? d*d*d : d*d;
}

int64_t tobi_world_guess_particles(const tobi_world *w, const tobi_region *r)
{
    int64_t most = tobi_region_count(&w->system[r->system], r);
    double about = floor(r->volume/cell_of(w) + 0.5);
    if (r->radius > 0) about = fmax(about, 1);           /* the middle of the lattice is in it */
    return (r->shape.triangle_count || r->radius > 0) && about < (double)most ? (int64_t)about : most;
}

tobi_status tobi_world_solid(const tobi_world *w, int solid, tobi_solid_info *info)
{
    if (!w || !info) return TOBI_INVALID;
    const tobi_system *s = tobi_world_solids(w);
    if (!s || solid < 0 || solid >= s->solid_count) return TOBI_NOT_FOUND;
    *info = (tobi_solid_info){ .name = s->solids[solid].name, .density = s->solids[solid].def.density };
    for (int k = 0; k < w->region_count; k++) {
        if (&w->system[w->regions[k].system] != s || w->regions[k].owner != solid) continue;
        info->volume += w->regions[k].volume;
        if (!w->started) info->particles += tobi_world_guess_particles(w, &w->regions[k]);
    }
    info->mass = info->density*info->volume;
    if (s->method->stable_dt) info->time_step = s->method->stable_dt(s, solid, 0);
    if (!w->started) return TOBI_OK;
    info->mass = 0;
    for (int64_t i = 0; i < s->particles.count; i++) {
        if (s->particles.fluid[i] != solid) continue;
        info->particles++;
        info->mass += s->particles.strain[i].c[2].w;
    }
    return TOBI_OK;
}

/* Of the first system, which sets the step of all. */
static double find_step(const tobi_world *w, double speed)
{
    const tobi_system *s = &w->system[0];
    double least = INFINITY;
    for (int k = s->fluid_count ? TOBI_LIQUIDS : 0; k < s->solid_count && s->method->stable_dt; k++)
        least = fmin(least, s->method->stable_dt(s, k, speed));
    return isfinite(least) ? least : 0;
}

double tobi_world_stable_step(const tobi_world *w)
{
    return w ? find_step(w, fmax(tobi_world_start_speed(w, &w->system[0]), w->sim.wall_speed)) : 0;
}

tobi_status tobi_world_note_time_step(tobi_world *w, tobi_error *err)
{
    const double wish = w->sim.def.time_step, stable = tobi_world_stable_step(w), rest = find_step(w, 0),
                 parts = ceil(wish/stable*(1 - 1e-9));
    char text[240], speed[80] = "";
    if (!(stable > 0) || wish <= stable) return TOBI_OK;
    if (w->system[0].solid_count == 0) {
        snprintf(text, sizeof text, "%.4g s is longer than the %.3g s that sound in the liquid allows: the "
                 "run may run away\n", wish, stable);
        return tobi_world_add_notes(w, "world", "time_step", text, err);
    }
    if (stable < 0.99*rest)
        snprintf(speed, sizeof speed, ", their %.3g m/s at the start",
                 fmax(tobi_world_start_speed(w, &w->system[0]), w->sim.wall_speed));
    snprintf(text, sizeof text, "%.4g s is longer than the %.3g s that the stiffness of the solids%s and "
             "gravity allow: each is cut into %.9g or more\n", wish, stable, speed, parts);
    return tobi_world_add_notes(w, "world", "time_step", text, err);
}

/* How far a body reaches into the domain from a side, m. */
static double find_reach(const tobi_box *box, const tobi_body *b, int axis, int upper)
{
    double reach = 0;
    for (int64_t i = 0; i < b->mesh.vertex_count; i++) {
        const double at = b->vertex[i][axis] + b->lower[axis] - box->lower[axis];
        reach = fmax(reach, upper ? box->size[axis] - at : at);
    }
    return reach;
}

tobi_status tobi_world_note_thin_bodies(tobi_world *w, tobi_error *err)
{
    const tobi_system *s = tobi_world_solids(w);
    if (!s || s->solid_count == 0) return TOBI_OK;
    const double cell = ((const tobi_mlsmpm_def *)s->def)->cell*s->smoothing.spacing;
    for (int k = 0; k < s->sim->body_count; k++)
        for (int side = 0; side < 2*s->box.dimension; side++) {
            const int axis = side/2, upper = side%2;
            const double reach = find_reach(&s->box, &s->sim->bodies[k], axis, upper);
            char text[300];
            if ((upper ? s->sim->def.wall_max : s->sim->def.wall_min)[axis] == TOBI_WALL_OPEN) continue;
            if (reach <= 0 || reach >= 1.5*cell) continue;
            snprintf(text, sizeof text, "lies within %.2g cells of the side at the %s %c, which carries a "
                     "part or all of what solids press on it there; from 1.5 cells on the body carries all\n",
                     reach/cell, upper ? "upper" : "lower", "xyz"[axis]);
            TOBI_TRY(tobi_world_add_notes(w, "body", s->sim->bodies[k].name, text, err));
        }
    return TOBI_OK;
}

tobi_status tobi_world_pieces(tobi_world *w, const tobi_pieces **pieces, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    TOBI_NEED(pieces, "where the pieces go");
    *pieces = &w->pieces.found;
    tobi_system *s = tobi_world_solids(w);
    if (!s)
        return tobi_fail(err, TOBI_UNSUPPORTED, "%s has no solids, so no pieces", w->system[0].method->name);
    TOBI_TRY(tobi_world_refresh(w, err));
    return w->pieces.of ? TOBI_OK : tobi_pieces_find(s, s->row_of, &w->pieces, err);
}
