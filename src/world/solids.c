/* What a world tells about its solids. */
#include "base/error.h"
#include "base/param.h"
#include "exec/exec.h"
#include "world/world.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

int tobi_world_solid_count(const tobi_world *w)
{
    const tobi_system *s = w ? tobi_world_solids(w) : NULL;
    return s ? s->solid_count : 0;
}

static double cell_of(const tobi_system *s)
{
    double d = s->smoothing.spacing;
    return s->box.dimension == 3 ? d*d*d : d*d;
}

int64_t tobi_world_guess_particles(const tobi_world *w, const tobi_region *r)
{
    int64_t most = tobi_region_count(&w->system[r->system], r);
    double about = floor(r->volume/cell_of(&w->system[r->system]) + 0.5);
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
        const double mass = s->method->mass(s, i);
        info->particles++;
        info->mass += mass;
        for (int a = 0; a < 3; a++) {
            info->centre[a] += mass*(&s->particles.position[i].x)[a];
            info->velocity[a] += mass*(double)(&s->particles.velocity[i].x)[a];
        }
    }
    for (int a = 0; a < 3 && info->mass > 0; a++) {
        info->centre[a] = s->box.lower[a] + info->centre[a]/info->mass;
        info->velocity[a] /= info->mass;
    }
    tobi_world_liquid_force(w, solid, info->liquid_force);
    return TOBI_OK;
}

typedef struct pushed { const tobi_system *solids; int solid; } pushed;

static void add_pushes(const void *view, int64_t begin, int64_t end, double *totals)
{
    const pushed *v = view;
    const tobi_float4 *push = v->solids->sim->soft.push;
    for (int64_t i = begin; i < end; i++)
        for (int a = 0; a < 3 && v->solids->particles.fluid[i] == v->solid; a++)
            totals[a] += (double)(&push[i].x)[a];
}

void tobi_world_liquid_force(const tobi_world *w, int solid, double force[3])
{
    const tobi_soft *soft = &w->sim.soft;
    const pushed view = { soft->solids, solid };
    double t[TOBI_TOTALS] = { 0 };
    if (soft->solids && soft->push && w->sim.step > 0)
        tobi_launch((tobi_exec *)&w->sim.exec, TOBI_HOST(add_pushes, 3, 0), &view, 0,
                    soft->solids->particles.count, t);
    memcpy(force, t, 3*sizeof *force);
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
    char text[TOBI_NOTE], speed[TOBI_NOTE] = "";
    if (w->step_noted || !(stable > 0) || wish <= stable) return TOBI_OK;
    w->step_noted = 1;
    if (w->system[0].solid_count == 0) {
        snprintf(text, sizeof text, tr("%.4g s is longer than the %.3g s that sound in the liquid allows: "
                 "the run may run away\n"), wish, stable);
        return tobi_world_add_notes(w, "world", "time_step", text, err);
    }
    if (stable < 0.99*rest)
        snprintf(speed, sizeof speed, tr(", their %.3g m/s at the start"),
                 fmax(tobi_world_start_speed(w, &w->system[0]), w->sim.wall_speed));
    snprintf(text, sizeof text, tr("%.4g s is longer than the %.3g s that the stiffness of the solids%s and "
             "gravity allow: each is cut into %.9g or more\n"), wish, stable, speed, parts);
    return tobi_world_add_notes(w, "world", "time_step", text, err);
}

/* Times the density of what hangs on it: with less a clamp gives way as if it were a hinge. */
static const double CLAMP = 1e3;

/* A stationary solid holds others by its mass, as they share the velocity of nodes. */
tobi_status tobi_world_note_clamps(tobi_world *w, tobi_error *err)
{
    const tobi_system *s = tobi_world_solids(w);
    char text[TOBI_NOTE];
    double most = 0;
    for (int k = 0; s && k < s->solid_count; k++) {
        const tobi_solid_def *d = &s->solids[k].def;
        const int hangs = d->bonded && (d->model == TOBI_NEO_HOOKEAN || d->model == TOBI_COROTATED);
        if (hangs) most = fmax(most, d->density);
    }
    for (int k = 0; s && k < s->solid_count; k++) {
        const tobi_solid_def *d = &s->solids[k].def;
        if (d->model != TOBI_STATIONARY || !d->bonded || d->density >= CLAMP*most*(1 - 1e-9)) continue;
        snprintf(text, sizeof text, tr("holds what is bonded to it by its mass: lighter than %.3g kg/m3 it "
                 "gives way as if it were a hinge\n"), CLAMP*most);
        TOBI_TRY(tobi_world_add_notes(w, "solid", s->solids[k].name, text, err));
    }
    return TOBI_OK;
}

/* By default liquids slip along bodies: a stirrer in a paste would then feel next to no torque. */
static tobi_status note_slip(tobi_world *w, tobi_error *err)
{
    const char *text = tr("the liquid slips along it, with implicit_viscosity; for a liquid that sticks "
                               "to it: \"friction\": \"no-slip\"\n");
    for (int k = 0; w->sim.def.implicit_viscosity && k < w->sim.body_count; k++)
        if (w->sim.bodies[k].friction == TOBI_SLIP)
            TOBI_TRY(tobi_world_add_notes(w, "body", w->sim.bodies[k].name, text, err));
    return TOBI_OK;
}

tobi_status tobi_world_note_liquids(tobi_world *w, tobi_error *err)
{
    const tobi_system *s = tobi_world_solids(w);
    const char *text = tr("a liquid of mlsmpm does not keep its volume well and carries what is "
                               "heavier; unless it soaks sand or snow, write it into fluids, with dfsph or "
                               "isph, beside the solids\n");
    for (int k = 0; s && k < s->solid_count; k++)
        if (s->solids[k].def.model == TOBI_LIQUID)
            TOBI_TRY(tobi_world_add_notes(w, "solid", s->solids[k].name, text, err));
    return note_slip(w, err);
}

/* Whether the solid meets another one that it is not bonded to and that rubs. */
static int meets_solids(const tobi_system *s, int solid)
{
    int meets = 0;
    for (int k = 0; k < s->solid_count; k++)
        meets |= k != solid && s->solids[k].def.model != TOBI_LIQUID &&
                 !(s->solids[k].def.bonded && s->solids[solid].def.bonded);
    return meets;
}

tobi_status tobi_world_note_friction(tobi_world *w, tobi_error *err)
{
    const tobi_system *s = tobi_world_solids(w);
    const tobi_solid_def usual = tobi_default_solid_def();
    const char *text = tr("its surface_friction does nothing, as there is no solid that it is not "
                               "bonded to; of bodies their friction_coefficient counts, of sides "
                               "domain.friction\n");
    for (int k = 0; s && k < s->solid_count; k++)
        if (s->solids[k].def.model != TOBI_LIQUID && !meets_solids(s, k) &&
            s->solids[k].def.surface_friction != usual.surface_friction)
            TOBI_TRY(tobi_world_add_notes(w, "solid", s->solids[k].name, text, err));
    return TOBI_OK;
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
            char text[TOBI_NOTE];
            if ((upper ? s->sim->def.wall_max : s->sim->def.wall_min)[axis] == TOBI_WALL_OPEN) continue;
            if (reach <= 0 || reach >= 1.5*cell) continue;
            snprintf(text, sizeof text, tr("lies within %.2g cells of the side at the %s %c, which carries "
                     "a part or all of what solids press on it there; from 1.5 cells on the body carries "
                     "all\n"),
                     reach/cell, upper ? tr("upper") : tr("lower"), "xyz"[axis]);
            TOBI_TRY(tobi_world_add_notes(w, "body", s->sim->bodies[k].name, text, err));
        }
    return TOBI_OK;
}

/* How far a blade's edge goes past each side during the run at most, m, < 0: not so far; and at the start. */
static tobi_status find_edge_reach(const tobi_world *w, const tobi_body *b, double most[6],
                                   double start[6], tobi_error *err)
{
    enum { SAMPLES = 64 };
    const tobi_box *box = &w->system[0].box;
    for (int side = 0; side < 6; side++) most[side] = start[side] = -INFINITY;
    for (int n = 0; n <= SAMPLES; n++)
        for (int64_t k = 0; k < b->edge_count; k++) {
            double rest[2][3], now[2][3];
            for (int a = 0; a < 3; a++) {
                rest[0][a] = b->rest.centre[a] + b->edge[k].a[a];
                rest[1][a] = b->rest.centre[a] + b->edge[k].b[a];
            }
            TOBI_TRY(b->motion(b->motion_user, w->sim.def.end_time*n/SAMPLES, 2,
                               (const double (*)[3])rest, now, err));
            for (int side = 0; side < 2*box->dimension; side++)
                for (int end = 0; end < 2; end++) {
                    const double at = now[end][side/2] - box->lower[side/2];
                    const double past = side%2 ? at - box->size[side/2] : -at;
                    most[side] = fmax(most[side], past);
                    if (n == 0) start[side] = fmax(start[side], past);
                }
        }
    return TOBI_OK;
}

static int has_material_at(const tobi_system *s, int side)
{
    for (int64_t i = 0; i < s->particles.count; i++) {
        const double at = (&s->particles.position[i].x)[side/2];
        if ((side%2 ? s->box.size[side/2] - at : at) < s->smoothing.spacing) return 1;
    }
    return 0;
}

/* Whether an edge that goes `past` spacings past a side leaves the last layer whole. Its particles sit half a
   spacing inside; at sides that hold the material, the edge presses them down before it. */
static int ends_at(const tobi_world_def *d, int side, double past)
{
    const tobi_wall wall = (side%2 ? d->wall_max : d->wall_min)[side/2];
    return wall != TOBI_WALL_OPEN && past > -1 && past < (wall == TOBI_WALL_SEPARATE ? -0.4 : 0.49);
}

tobi_status tobi_world_note_edges(tobi_world *w, tobi_error *err)
{
    const tobi_system *s = tobi_world_solids(w);
    if (!s) return TOBI_OK;
    const double spacing = s->smoothing.spacing;
    for (int k = 0; k < w->sim.body_count && s->solid_count > 0; k++) {
        const tobi_body *b = &w->sim.bodies[k];
        double most[6], start[6];
        if (!b->blade || !b->motion || b->rigid.kind != TOBI_PRESCRIBED) continue;
        TOBI_TRY(find_edge_reach(w, b, most, start, err));
        for (int side = 0; side < 2*s->box.dimension; side++) {
            char text[TOBI_NOTE];
            if (!ends_at(&w->sim.def, side, most[side]/spacing)) continue;
            if (most[side] - start[side] < spacing || !has_material_at(s, side)) continue;
            if (fabs(most[side]) < 1e-6*spacing) most[side] = 0;
            snprintf(text, sizeof text, tr("its edge comes to %.3g m %s the side at the %s %c, no farther: a "
                     "layer there may hold the pieces together; to part them, let it go half a spacing "
                     "(%.3g m) past the side\n"), fabs(most[side]), most[side] < 0 ? tr("before")
                     : tr("past"),
                     side%2 ? tr("upper") : tr("lower"), "xyz"[side/2], 0.5*spacing);
            TOBI_TRY(tobi_world_add_notes(w, "body", b->name, text, err));
        }
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
