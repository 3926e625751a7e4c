/* Boxes take whole layers, and each particle the volume of its spacing: a spacing that does not divide the
   sides of a box leaves liquid out, or puts too much in. So the spacing of the system gives way by some per
   cent until the particles hold the volume of all boxes exactly, and layers are stretched by what is left
   (docs/decisions/0038-layers-that-fit.md). Drawback: one spacing for all boxes, of which each alone may hold
   a little more or less than its volume. */
#include "world/fit.h"
#include <math.h>
#include <stdio.h>

/* What is nearer than this fits already: the definition's spacing is taken, to the bit. */
static const double EXACT = 1e-6;
/* Shares of the spacing: what it may give way, and layers be stretched; what is worth a word. */
static const double MOST = 0.05, MUCH = 0.03, LITTLE = 1e-3;
static const double TOLD = 0.01;    /* of the volume of one fluid */
enum { TRIALS = 100,                /* spacings above and below the wish */
       THICK = 10 };                /* layers: fewer are stretched as they must and have no say */

/* A box of liquid, which the first system has. */
static int is_box(const tobi_region *r)
{
    return r->system == 0 && !r->shape.triangle_count && !(r->radius > 0) && !r->points && !r->vessel[0];
}

/* The spacing at which the layers that are counted at `trial` hold the boxes' volume, and how they are
   stretched then. 0 without boxes, or if that spacing asks for other layers. */
static int try_spacing(const tobi_world *w, double trial, tobi_fit *fit)
{
    const int dimension = w->system[0].box.dimension;
    double volume = 0, particles = 0;
    for (int k = 0; k < w->region_count; k++) {
        double count = 1;
        if (!is_box(&w->regions[k])) continue;
        for (int a = 0; a < dimension; a++) count *= tobi_region_layers(&w->regions[k], a, trial);
        particles += count;
        volume += w->regions[k].volume;
    }
    if (!(particles > 0)) return 0;
    *fit = (tobi_fit){ dimension == 3 ? cbrt(volume/particles) : sqrt(volume/particles), 0 };
    for (int k = 0; k < w->region_count; k++)
        for (int a = 0; a < dimension && is_box(&w->regions[k]); a++) {
            const tobi_region *r = &w->regions[k];
            const double layers = tobi_region_layers(r, a, trial), side = r->upper[a] - r->lower[a];
            if (layers != tobi_region_layers(r, a, fit->spacing)) return 0;
            if (layers >= THICK) fit->stretch = fmax(fit->stretch, fabs(side/(layers*fit->spacing) - 1));
        }
    return 1;
}

tobi_fit tobi_fit_find(const tobi_world *w, double wish)
{
    tobi_fit best = { wish, 0 }, found;
    double least = INFINITY;
    if (w->system[0].solid_count > 0) return best;
    if (w->outer) {       /* a nest divides the spacing that its outer world has taken */
        const double outer = w->outer->sim.def.spacing;
        best.spacing *= tobi_fit_find(w->outer, outer).spacing/outer;
        return best;
    }
    for (int k = 0; k <= 2*TRIALS; k++) {          /* the wish, and then farther and farther from it */
        const double way = MOST*(k + 1)/2/TRIALS*(k % 2 ? 1 : -1);
        if (!try_spacing(w, wish*(k ? 1 + way : 1), &found)) continue;
        const double off = fabs(found.spacing/wish - 1), cost = off + found.stretch;
        if (k == 0 && cost < EXACT) return best;
        if (off > MOST || found.stretch > MOST || cost > least - EXACT) continue;
        least = cost;
        best = found;
    }
    return best;
}

/* The nearest spacing above or below the wish that fits with little stretch; 0 = none within a third. */
static double find_neat(const tobi_world *w, double wish, int up)
{
    tobi_fit found;
    for (double share = 1e-3; share < 0.33; share += 1e-3)
        if (try_spacing(w, wish*(up ? 1 + share : 1 - share), &found) && found.stretch < MUCH &&
            (found.spacing > wish) == up) return found.spacing;
    return 0;
}

/* "; 0.0083 m or 0.0076 m would fit" */
static void tell_neat(const tobi_world *w, double wish, char text[TOBI_NOTE])
{
    const double below = find_neat(w, wish, 0), above = find_neat(w, wish, 1);
    text[0] = '\0';
    if (below > 0 && above > 0) snprintf(text, TOBI_NOTE, tr("; %.5g m or %.5g m would fit"), below, above);
    else if (below > 0 || above > 0) snprintf(text, TOBI_NOTE, tr("; %.5g m would fit"), below > 0 ? below
                                              : above);
}

/* What the particles of the boxes of a fluid hold over the boxes' volume; -1: of all fluids. */
static double find_amount(const tobi_world *w, int fluid)
{
    double volume = 0, held = 0;
    for (int k = 0; k < w->region_count; k++) {
        if (!is_box(&w->regions[k]) || (fluid >= 0 && w->regions[k].owner != fluid)) continue;
        volume += w->regions[k].volume;
        held += (double)tobi_region_count(&w->system[0], &w->regions[k])*w->system[0].smoothing.volume;
    }
    return volume > 0 ? held/volume : 1;
}

/* One spacing for all: a fluid alone may have more or less than its boxes. */
static tobi_status note_fluids(tobi_world *w, tobi_error *err)
{
    char text[TOBI_NOTE];
    for (int f = 0; f < w->system[0].fluid_count; f++) {
        const double amount = find_amount(w, f) - 1;
        if (fabs(amount) < TOLD) continue;
        snprintf(text, sizeof text, tr("its particles hold %.1f %% %s than its boxes\n"), 100*fabs(amount),
                 amount > 0 ? tr("more") : tr("less"));
        TOBI_TRY(tobi_world_add_notes(w, "fluid", w->system[0].fluid[f].name, text, err));
    }
    return TOBI_OK;
}

tobi_status tobi_fit_note(tobi_world *w, tobi_error *err)
{
    const double wish = w->sim.def.spacing, taken = w->system[0].smoothing.spacing;
    const double amount = find_amount(w, -1) - 1;
    tobi_fit fit = { wish, 0 };
    char text[TOBI_NOTE], neat[TOBI_NOTE];
    if (w->system[0].solid_count > 0 || w->outer) return TOBI_OK;
    tell_neat(w, wish, neat);
    if (fabs(amount) > LITTLE) {
        snprintf(text, sizeof text, tr("%.5g m: whole layers do not fit, so that the particles hold %.1f %% "
                 "%s than the boxes of liquid%s\n"), wish, 100*fabs(amount), amount > 0 ? tr("more")
                 : tr("less"), neat);
        return tobi_world_add_notes(w, "world", "spacing", text, err);
    }
    TOBI_TRY(note_fluids(w, err));
    if (fabs(taken/wish - 1) < LITTLE || !try_spacing(w, taken, &fit)) return TOBI_OK;
    size_t used = (size_t)snprintf(text, sizeof text, tr("%.5g m is taken instead of %.5g m, so that whole "
                                   "layers hold what the boxes of liquid hold"), taken, wish);
    if (fit.stretch > MUCH)
        used += (size_t)snprintf(text + used, sizeof text - used, tr("; some are stretched by %.1f %%%s"),
                                 100*fit.stretch, neat);
    snprintf(text + used, sizeof text - used, "\n");
    return tobi_world_add_notes(w, "world", "spacing", text, err);
}
