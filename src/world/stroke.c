/* Strokes: that of a wave maker must fit into the tank, another one is noted where it does not; and the
   method should keep the waves. Drawback: strokes are looked for at times, so that one that is out for a
   moment between them is missed. */
#include "rigid/waves.h"
#include "world/world.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { TIMES = 2000, SOME_TIMES = 200 };
/* Share of the liquid's height; the lattice fits to less. */
static const double OTHER_DEPTH = 0.05;

/* Along gravity a flap may turn below the floor, at its hinge. */
static int is_upright(const tobi_world *w, int axis)
{
    const double *g = w->sim.def.gravity;
    return g[axis]*g[axis] > 0.5*(g[0]*g[0] + g[1]*g[1] + g[2]*g[2]);
}

static tobi_status check_place(const tobi_world *w, const tobi_body *b, const double (*at)[3], double t,
                               tobi_error *err)
{
    const tobi_box *box = &w->system[0].box;
    const double slack = 1e-9*w->sim.def.spacing;
    for (int64_t i = 0; i < b->mesh.vertex_count; i++)
        for (int a = 0; a < box->dimension; a++) {
            const double lower = box->lower[a], upper = box->lower[a] + box->size[a];
            if (box->periodic[a] || is_upright(w, a)) continue;
            if (at[i][a] >= lower - slack && at[i][a] <= upper + slack) continue;
            return tobi_fail(err, TOBI_INVALID, "the stroke of '%s' is beyond the tank: at t = %.4g s a "
                             "vertex is at %c = %.4g m, allowed is %g to %g m", b->name, t, "xyz"[a],
                             at[i][a], lower, upper);
        }
    return TOBI_OK;
}

/* m: the depth that a wave maker is made for; 0 of another body. */
static double wave_depth(const tobi_body *b)
{
    return b->motion == tobi_motion_positions ? tobi_motion_wave_depth(b->motion_user) : 0;
}

static tobi_status check_stroke(const tobi_world *w, const tobi_body *b, int times, tobi_error *err)
{
    const int64_t n = b->mesh.vertex_count;
    double (*at)[3] = malloc((size_t)(n + 1)*sizeof *at);
    if (!at) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the vertices of '%s'", b->name);
    tobi_status status = TOBI_OK;
    for (int k = 0; k <= times && status == TOBI_OK; k++) {
        const double t = w->sim.def.end_time*k/times;
        status = b->motion(b->motion_user, t, n, (const double (*)[3])b->mesh.vertices, at, err);
        if (status == TOBI_OK) status = check_place(w, b, (const double (*)[3])at, t, err);
    }
    free(at);
    return status;
}

tobi_status tobi_world_check_stroke(const tobi_world *w, const tobi_body *b, tobi_error *err)
{
    return wave_depth(b) > 0 ? check_stroke(w, b, TIMES, err) : TOBI_OK;
}

/* The figures are of test/physics/wave_maker. */
static tobi_status note_method(tobi_world *w, const tobi_body *b, tobi_error *err)
{
    const tobi_method *m = w->system[0].method;
    char text[TOBI_NOTE];
    if (!m->damps_waves) return TOBI_OK;
    snprintf(text, sizeof text, tr("by %s its waves come out too low: on 10 layers of particles by up to a "
             "quarter, and they get lower on their way; isph keeps them\n"), m->name);
    return tobi_world_add_notes(w, "body", b->name, text, err);
}

/* A recorded stroke, or a body that is drawn through a side of the tank, which liquid does not pass. */
static tobi_status note_stroke(tobi_world *w, const tobi_body *b, tobi_error *err)
{
    tobi_error why = { 0 };
    char text[sizeof why.text + 2];
    if (b->motion != tobi_motion_positions || !tobi_motion_is_plain(b->motion_user)) return TOBI_OK;
    if (wave_depth(b) > 0 || b->absent[0] > 0) return TOBI_OK;
    const tobi_status status = check_stroke(w, b, SOME_TIMES, &why);
    if (status == TOBI_OK || status == TOBI_NO_MEMORY) return status;
    snprintf(text, sizeof text, "%s\n", why.text);
    return tobi_world_add_notes(w, "body", b->name, text, err);
}

/* With openings the head of the start is that of the whole domain. */
static tobi_status note_depth(tobi_world *w, const tobi_body *b, tobi_error *err)
{
    const double *g = w->sim.def.gravity, depth = wave_depth(b);
    const double height = w->system[0].start_head/sqrt(g[0]*g[0] + g[1]*g[1] + g[2]*g[2]);
    char text[TOBI_NOTE];
    if (w->sim.opening_count > 0 || !(height > 0) || fabs(depth - height) <= OTHER_DEPTH*height)
        return TOBI_OK;
    snprintf(text, sizeof text, tr("its waves are those of a depth of %.4g m, and the liquid starts %.4g m "
             "high: where the bottom is flat, its depth should be that\n"), depth, height);
    return tobi_world_add_notes(w, "body", b->name, text, err);
}

/* A focus without its short waves is lower and broader than asked for. */
static tobi_status note_focus(tobi_world *w, const tobi_body *b, tobi_error *err)
{
    const double least = tobi_waves_late(tobi_motion_waves(b->motion_user));
    char text[TOBI_NOTE];
    if (!(least > 0)) return TOBI_OK;
    snprintf(text, sizeof text, tr("the focus of its waves comes too early: waves of half the peak period "
             "are there at %.4g s\n"), least);
    return tobi_world_add_notes(w, "body", b->name, text, err);
}

/* The first wave of a sudden start is not of the kind that is asked for, and goes ahead of the others. */
static tobi_status note_start(tobi_world *w, const tobi_body *b, tobi_error *err)
{
    const double period = tobi_waves_sudden(tobi_motion_waves(b->motion_user));
    char text[TOBI_NOTE];
    if (!(period > 0)) return TOBI_OK;
    snprintf(text, sizeof text, tr("its waves begin at full height: the sudden start sends a shock ahead of "
             "them; a ramp of one or two periods, %.3g to %.3g s, makes them rise\n"), period, 2*period);
    return tobi_world_add_notes(w, "body", b->name, text, err);
}

tobi_status tobi_world_note_makers(tobi_world *w, tobi_error *err)
{
    if (w->system[0].method->solids) return TOBI_OK;
    for (int k = 0; k < w->sim.body_count; k++) {
        TOBI_TRY(note_stroke(w, &w->sim.bodies[k], err));
        if (!(wave_depth(&w->sim.bodies[k]) > 0)) continue;
        TOBI_TRY(note_method(w, &w->sim.bodies[k], err));
        TOBI_TRY(note_depth(w, &w->sim.bodies[k], err));
        TOBI_TRY(note_start(w, &w->sim.bodies[k], err));
        TOBI_TRY(note_focus(w, &w->sim.bodies[k], err));
    }
    return TOBI_OK;
}
