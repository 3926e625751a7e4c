/* Notes on the start of a liquid: bodies that set off at full speed, liquid that begins beside a wall instead
   of at it, or that its own weight compresses. The scene says so, but its author seldom means it. Drawback:
   motions that jump later are not found. */
#include "base/error.h"
#include "geom/vec3.h"
#include "rigid/waves.h"
#include "sph/stages.h"
#include "world/world.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Of the speed of a fall from the liquid's height; slower starts press less than the liquid at rest. */
static const double JERK = 0.05;
/* Of the speed of such a fall; with 3 the liquid at the bottom is 5 % too dense. */
static const double SOUND_LEAST = 3;
/* s, over which a motion is looked at. */
static const double SOON = 1e-4;
/* Spacings: a layer of friction of so many is computed, thinner ones are as good as none. */
static const double LAYER = 2;
/* Spacings between liquid and wall that count as a gap, not as a place of its own. */
static const double GAP_LEAST = 0.6, GAP_MOST = 4;

/* m/s: the fastest that a body's surface goes into liquid or out of it, by the middles of its triangles: what
   slides along itself, as a round vessel that turns about its axis, presses nothing. */
static double find_normal_speed(const tobi_body *b)
{
    double most = 0;
    for (int64_t t = 0; t < b->mesh.triangle_count; t++) {
        const int32_t *v = b->mesh.triangles[t];
        double p[3], q[3], mean[3], normal[3];
        vec3_sub(p, b->vertex[v[1]], b->vertex[v[0]]);
        vec3_sub(q, b->vertex[v[2]], b->vertex[v[0]]);
        vec3_cross(normal, p, q);
        memcpy(mean, b->vertex_velocity[v[0]], sizeof mean);
        for (int k = 1; k < 3; k++) vec3_add_scaled(mean, mean, 1, b->vertex_velocity[v[k]]);
        most = fmax(most, fabs(vec3_dot(mean, normal))/3/fmax(vec3_length(normal), 1e-300));
    }
    return most;
}

static tobi_status note_jerk(tobi_world *w, tobi_body *b, tobi_error *err)
{
    double after = 0, twice = 0, pressing;
    char text[TOBI_NOTE];
    TOBI_TRY(tobi_body_predict(b, 0, 2*SOON, &twice, err));
    pressing = -find_normal_speed(b);
    TOBI_TRY(tobi_body_predict(b, 0, SOON, &after, err));
    pressing += 2*find_normal_speed(b);
    const double speed = 2*after - twice;            /* at once: an acceleration adds to the means */
    /* The shape of one that moves by forces: its own speed at the start is given. */
    const double *v = b->rigid.velocity, *spin = b->rigid.angular_velocity;
    const int forced = b->rigid.kind != TOBI_PRESCRIBED &&
                       (!b->swimmer || vec3_dot(v, v) + vec3_dot(spin, spin) > 0);
    if (forced || w->system[0].start_speed > 0) return TOBI_OK;
    /* Of wave makers stroke.c tells more. */
    if (b->motion == tobi_motion_positions && tobi_motion_waves(b->motion_user)) return TOBI_OK;
    if (!(pressing > fmax(JERK*sqrt(2*w->system[0].start_head), JERK*after))) return TOBI_OK;
    snprintf(text, sizeof text, tr("sets off at %.3g m/s: the force of the first step is an impulse over "
             "the time step; let the motion begin at rest\n"), speed);
    return tobi_world_add_notes(w, "body", b->name, text, err);
}

/* Whether it lies in the box around a vessel, whose walls then keep it from the sides of the domain. */
static int is_in_vessel(const tobi_world *w, const tobi_region *r)
{
    for (int k = 0; k < w->sim.body_count; k++) {
        const tobi_body *b = &w->sim.bodies[k];
        int inside = b->vessel;
        for (int a = 0; a < w->sim.def.dimension; a++) {
            double low = INFINITY, high = -INFINITY;
            for (int64_t i = 0; inside && i < b->mesh.vertex_count; i++) {
                low = fmin(low, b->mesh.vertices[i][a]);
                high = fmax(high, b->mesh.vertices[i][a]);
            }
            inside &= low < r->lower[a] && r->upper[a] < high;
        }
        if (inside) return 1;
    }
    return 0;
}

static tobi_status note_gap(tobi_world *w, const tobi_region *r, tobi_error *err)
{
    const tobi_box *box = &w->system[0].box;
    const double d = w->system[0].smoothing.spacing;
    if (r->system != 0) return TOBI_OK;                /* a solid's                                */
    if (r->in_vessel || is_in_vessel(w, r)) return TOBI_OK;
    if (!(vec3_length(w->sim.def.gravity) > 0)) return TOBI_OK;
    for (int side = 0; side < 2*box->dimension; side++) {
        const int a = side/2, upper = side%2;
        const double gap = upper ? box->lower[a] + box->size[a] - r->upper[a] : r->lower[a] - box->lower[a];
        char text[TOBI_NOTE];
        if (box->periodic[a] || !(gap > GAP_LEAST*d && gap < GAP_MOST*d)) continue;
        if (w->sim.def.gravity[a]*(upper ? -1 : 1) > 0) continue;    /* the free surface, or a ceiling */
        snprintf(text, sizeof text, tr("fill[%d] begins %.3g m from the side at the %s %c: it falls there "
                 "first; let it begin at the side\n"),
                 r->number, gap, upper ? tr("upper") : tr("lower"), "xyz"[a]);
        return tobi_world_add_notes(w, "fluid", w->system[0].fluid[r->owner].name, text, err);
    }
    return TOBI_OK;
}

/* Where sound is not much faster than a fall from the liquid's height, its weight compresses it. */
static tobi_status note_compression(tobi_world *w, tobi_error *err)
{
    const tobi_system *s = &w->system[0];
    char text[TOBI_NOTE];
    if (!s->method->sound || s->method->solids) return TOBI_OK;
    const double sound = s->method->sound(s), fall = sqrt(2*s->start_head);
    if (!(sound < SOUND_LEAST*fall)) return TOBI_OK;
    snprintf(text, sizeof text, tr("its weight compresses it: sound goes through it at %.3g m/s, a fall from "
             "its height ends at %.3g m/s; %.0f times the %s.stiffness makes sound ten times as fast\n"),
             sound, fall, pow(10*fall/sound, 2), s->method->name);
    return tobi_world_add_notes(w, "fluid", s->fluid[0].name, text, err);
}

/* Whether no side and no body holds the liquid at its surface. */
static int is_slip_everywhere(const tobi_world *w)
{
    const tobi_world_def *d = &w->sim.def;
    int sides = 0, slip = 1;
    for (int a = 0; a < d->dimension; a++) {
        if (d->wall_min[a] == TOBI_WALL_PERIODIC) continue;
        slip &= d->wall_min[a] != TOBI_WALL_NO_SLIP && d->wall_max[a] != TOBI_WALL_NO_SLIP;
        sides += 2;
    }
    for (int k = 0; k < w->sim.body_count; k++) slip &= w->sim.bodies[k].friction == TOBI_SLIP;
    return slip && sides + w->sim.body_count > 0;
}

/* A layer of friction that no wall makes, but would grow wide enough to be seen: sqrt(nu t) at a plate that
   is moved at once (Stokes). */
static tobi_status note_slip(tobi_world *w, tobi_error *err)
{
    const tobi_system *s = &w->system[0];
    double thickest = 0;
    char text[TOBI_NOTE];
    int most = 0;
    if (s->method->solids || !is_slip_everywhere(w)) return TOBI_OK;
    for (int f = 0; f < s->fluid_count; f++) {
        const double nu = s->fluid[f].viscosity/s->fluid[f].density;
        if (nu > thickest) most = f;
        thickest = fmax(thickest, nu);
    }
    const double layer = sqrt(thickest*w->sim.def.end_time);
    if (!(layer > LAYER*s->smoothing.spacing)) return TOBI_OK;
    snprintf(text, sizeof text, tr("slips along all sides and bodies, as by default. One that held it would "
             "drag a layer of %.2g m along until the end: \"no-slip\" in domain.walls, and friction of "
             "bodies\n"), layer);
    return tobi_world_add_notes(w, "fluid", s->fluid[most].name, text, err);
}

/* With p = 0 at the particles that a rule calls surface, one that comes or goes changes the pressure of all
   below it; with loss they do so by and by. */
static tobi_status note_rough_surface(tobi_world *w, tobi_error *err)
{
    const char *text = tr("is p = 0 at the particles of the surface: with this surface_rule a tank at "
                               "rest does not stay so; loss, or 0.2 and more, keep it\n");
    const tobi_system *s = &w->system[0];
    const tobi_isph_def *def = s->def;
    if (strcmp(s->method->name, "isph") != 0 || def->surface_rule == TOBI_SURFACE_LOSS ||
        !(def->surface_height < SPH_LEAST_HEIGHT)) return TOBI_OK;
    return tobi_world_add_notes(w, "world", "isph.surface_height", text, err);
}

/* Angles of contact where no free surface has tension; 90 degrees, the default, asks for nothing. */
static tobi_status note_contact_angles(tobi_world *w, tobi_error *err)
{
    const char *text = tr("does nothing: no fluid has a surface_tension\n");
    const tobi_system *s = &w->system[0];
    for (int f = 0; f < s->fluid_count; f++)
        if (s->fluid[f].tension > 0) return TOBI_OK;
    if (w->sim.def.contact_angle != 90)
        TOBI_TRY(tobi_world_add_notes(w, "world", "domain.contact_angle", text, err));
    for (int k = 0; k < w->sim.body_count; k++)
        if (fabs(w->sim.bodies[k].contact_cosine) > 1e-9)
            TOBI_TRY(tobi_world_add_notes(w, "contact_angle of", w->sim.bodies[k].name, text, err));
    return TOBI_OK;
}

/* The least side of its box at rest. */
static double find_thickness(const tobi_body *b, int dimension)
{
    double low[3], high[3], least = INFINITY;
    tobi_bvh_box(b->bvh, low, high);
    for (int a = 0; a < dimension; a++) least = fmin(least, high[a] - low[a]);
    return least;
}

/* Contacts hold a solid at the surface of a body; what lies deeper than that in one that comes back meets
   none. Liquid deeper than a spacing lands in a layer beside the body at once, crowded. */
static tobi_status note_returns(tobi_world *w, tobi_error *err)
{
    const tobi_system *s = &w->system[0];
    char text[TOBI_NOTE];
    for (int k = 0; k < w->sim.body_count; k++) {
        const tobi_body *b = &w->sim.bodies[k];
        const int thick = find_thickness(b, s->box.dimension) > 2.001*s->smoothing.spacing;
        if (!(b->absent[1] > 0)) continue;
        if (tobi_world_solid_count(w) > 0) {
            snprintf(text, sizeof text, tr("comes back at %.4g s: a solid that lies in it then is not pushed "
                     "out; let it come by a motion, if one may\n"), b->absent[1]);
            TOBI_TRY(tobi_world_add_notes(w, "body", b->name, text, err));
        }
        if (s->method->solids || !thick) continue;
        snprintf(text, sizeof text, tr("comes back at %.4g s: liquid that lies in it then is thrown about, "
                 "as it is thicker than two spacings; let it come by a motion, if liquid may\n"),
                 b->absent[1]);
        TOBI_TRY(tobi_world_add_notes(w, "body", b->name, text, err));
    }
    return TOBI_OK;
}

tobi_status tobi_world_note_starts(tobi_world *w, tobi_error *err)
{
    TOBI_TRY(note_returns(w, err));
    if (w->system[0].fluid_count == 0) return TOBI_OK;
    for (int k = 0; k < w->sim.body_count; k++)
        TOBI_TRY(tobi_at_key(err, note_jerk(w, &w->sim.bodies[k], err), "bodies[%d].motion", k));
    for (int k = 0; k < w->region_count; k++) TOBI_TRY(note_gap(w, &w->regions[k], err));
    TOBI_TRY(note_slip(w, err));
    TOBI_TRY(note_contact_angles(w, err));
    TOBI_TRY(note_rough_surface(w, err));
    return note_compression(w, err);
}
