/* What a run looks at while it steps, and what it says of it at the end: a solver that gave up, a liquid that
   is none any more, energy from nothing, forces that jump from step to step. Drawback: a resumed run knows
   only its own steps. */
#include "app.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Mean density error of a liquid that is not one any more; 0.002 is seen where all is well. */
static const double WRONG_DENSITY = 0.02;
/* Share of particles at a free surface: a pool of 10 spacings has 0.1 to 0.2. */
static const double COME_APART = 0.5;
/* Scatter of a force as a part of its mean, told after so many steps. */
static const double ROUGH_FORCE = 0.15;
enum { ENOUGH_STEPS = 20 };

void watch_begin(watch *w, const tobi_world *world)
{
    memset(w, 0, sizeof *w);
    w->body_count = tobi_world_body_count(world);
    w->body = calloc((size_t)w->body_count + 1, sizeof *w->body);
    if (!w->body) w->body_count = 0;
    w->last = *tobi_world_info(world);
    energy_begin(&w->energy, world, w->last.kinetic_energy, w->last.potential_energy, w->last.elastic_energy);
}

void watch_end(watch *w)
{
    free(w->body);
    w->body = NULL;
}

/* White noise of size n has second differences of size sqrt(6) n; smooth forces next to none. */
static void watch_force(body_watch *b, const tobi_body_info *info)
{
    double second = 0, size = 0;
    for (int a = 0; a < 3; a++) {
        double f = info->pressure_force[a], bend = f - 2*b->last[a] + b->before[a];
        second += bend*bend/6;
        size += f*f;
        b->before[a] = b->last[a];
        b->last[a] = f;
    }
    if (++b->steps <= 3) return;
    b->noise += sqrt(second);
    b->force += sqrt(size);
}

static void watch_energy(watch *w, const tobi_step_info *info, double time)
{
    energy_look(&w->energy, time, info->kinetic_energy, info->potential_energy, info->elastic_energy);
}

tobi_status watch_step(watch *w, const tobi_world *world, const tobi_step_info *info, tobi_error *err)
{
    tobi_body_info body;
    /* The energies are those of the last output, which came after the step before. */
    if (info->kinetic_energy != w->last.kinetic_energy) watch_energy(w, info, w->last.time);
    if (w->steps++ == 0) w->surface_start = info->surface_share;
    const int unconverged = !info->density_converged || !info->divergence_converged || info->viscosity_failed;
    w->unconverged += unconverged;
    if (unconverged && !(info->pressure_residual < w->worst.pressure_residual)) w->worst = *info;
    w->last = *info;
    for (int k = 0; k < w->body_count; k++)
        if (tobi_world_body(world, k, &body) == TOBI_OK) watch_force(&w->body[k], &body);
    if (!energy_absurd(&w->energy)) return TOBI_OK;
    snprintf(err->text, sizeof err->text, tr("the simulation diverged: by t = %g s the kinetic energy of "
             "liquid and solids has become %.3g J, and all that they and the bodies had at the start was "
             "%.3g J; shorter time steps (cfl, time_step) may help"), w->energy.time, w->energy.kinetic,
             w->energy.start + w->energy.bodies);
    return err->status = TOBI_DIVERGED;
}

static void say_liquid(const watch *w)
{
    if (w->last.density_error_mean > WRONG_DENSITY)
        complain(tr("at the end the density of particles is off by %.1f %% on average "
                    "(density_error_mean in history.csv): the liquid has cavities or is compressed, "
                    "or its layers did not fit (tobiuo check)"),
                 100*w->last.density_error_mean);
    if (w->last.surface_share > COME_APART && w->last.surface_share > 2*w->surface_start)
        complain(tr("at the end %.0f %% of the particles are at a free surface (surface_share in "
                    "history.csv; %.0f %% at the start): the liquid has come apart into drops and "
                    "films that the spacing does not resolve"),
                 100*w->last.surface_share, 100*w->surface_start);
}

static void say_energy(watch *w, const tobi_world *world)
{
    const tobi_step_info *end = tobi_world_info(world);
    watch_energy(w, end, end->time);
    if (!energy_gained(&w->energy)) return;
    complain(tr("by t = %g s liquid and solids have gained %.3g J from nothing, beside %.3g J that "
                "they had at the start (kinetic, potential and elastic energy in history.csv); "
                "shorter time steps (cfl, time_step) may help"),
             w->energy.time, w->energy.gain, w->energy.start);
}

void watch_say(watch *w, const tobi_world *world)
{
    if (w->unconverged)
        complain(tr("the solver did not converge in %lld of %lld steps; the worst was at t = %g s, "
                    "with a residual of %.3g after %d iterations (unconverged_steps and "
                    "pressure_residual_max in history.csv)"),
                 (long long)w->unconverged, (long long)w->steps, w->worst.time, w->worst.pressure_residual,
                 w->worst.density_iterations + w->worst.divergence_iterations);
    say_energy(w, world);
    say_liquid(w);
    if (w->last.particles_lost)
        complain(tr("%lld particles left the domain"), (long long)w->last.particles_lost);
    if (w->last.put_back)
        complain(tr("particles got past a side of the domain and were put back to it %lld times "
                    "(put_back in history.csv); mlsmpm.leaving says what becomes of them"),
                 (long long)w->last.put_back);
    for (int k = 0; k < w->body_count && w->last.surface_share > 0; k++)
        if (w->body[k].steps > ENOUGH_STEPS && w->body[k].noise > ROUGH_FORCE*w->body[k].force)
            complain(tr("the pressure force on '%s' scatters by %.0f %% from step to step; its means "
                        "over an output (mean_pressure_force in bodies.csv) are smoother, and so are "
                        "forces with a cfl of 0.1"),
                     tobi_world_body_name(world, k), 100*w->body[k].noise/w->body[k].force);
}
