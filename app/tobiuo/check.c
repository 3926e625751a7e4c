/* tobiuo check SCENE: what a run would be, from its first steps at most. */
#include "app.h"
#include "tobiuo/params.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct check_options { const char *scene; overrides set; } check_options;

static const struct argp_option options[] = { SCENE_OPTIONS, { 0 } };

static error_t parse(int key, char *value, struct argp_state *state)
{
    check_options *o = state->input;
    return parse_scene_option(state, key, value, &o->set, &o->scene);
}

/* The step that the stiffness of solids or sound allow; without either what the CFL condition allows at the
   speed of a fall through the domain, the fastest that gravity alone can make: a run is seldom slower than
   this. Without gravity there is no guess. */
static double guess_step(const tobi_world_def *d, double stable)
{
    if (stable > 0.0) return d->time_step_max > 0.0 ? fmin(d->time_step_max, stable) : stable;
    double work = 0.0;
    for (int a = 0; a < d->dimension; a++)
        work += fabs(d->gravity[a]) * (d->domain_max[a] - d->domain_min[a]);
    double step = work > 0.0 ? d->cfl * d->spacing / sqrt(2.0 * work) : 0.0;
    return d->time_step_max > 0.0 && (step == 0.0 || step > d->time_step_max) ? d->time_step_max
                                                                              : step;
}

static void print_solids(const tobi_world *world, int dimension)
{
    tobi_solid_info solid;
    for (int k = 0; tobi_world_solid(world, k, &solid) == TOBI_OK; k++) {
        printf("solid            %s: %lld particles, %.4g %s, %.4g kg/m3", solid.name,
               (long long)solid.particles, solid.mass, dimension == 3 ? "kg" : "kg/m", solid.density);
        printf(solid.time_step < 1.0 ? ", time step at most %.3g s\n" : "\n", solid.time_step);
    }
}

/* Says what a fixed step costs: of the automatic one the shortest is guessed. Returns the step that is
   taken, 0 = it is not known. */
static double print_step(const tobi_world_def *d, const tobi_world *world)
{
    const double stable = tobi_world_stable_step(world), automatic = guess_step(d, stable);
    double step = automatic;
    if (d->time_step > 0.0)
        step = tobi_world_solid_count(world) && stable > 0.0 ? d->time_step / ceil(d->time_step / stable)
                                                             : d->time_step;
    if (step > 0.0)
        printf("time step        %s%.3g s, about %.9g steps to %g s",
               d->time_step > 0.0 ? "fixed, " : "about ", step, ceil(d->end_time / step), d->end_time);
    else
        printf("time step        adaptive, to %g s", d->end_time);
    if (d->time_step > 0.0 && step < 0.7 * automatic)
        printf(": up to %.2g times the steps and the time of \"adaptive\"", automatic / step);
    printf("\n");
    return step;
}

static double print_scene(const tobi_scene *scene, const tobi_world *world)
{
    const tobi_world_def *d = tobi_scene_world_def(scene);
    printf("scene            %s (%s, %d-D)\n", tobi_scene_name(scene), d->method, d->dimension);
    const double *low = d->domain_min, *high = d->domain_max;
    printf("domain           %g %g %g  to  %g %g %g m\n", low[0], low[1], low[2], high[0], high[1],
           high[2]);
    printf("spacing          %g m\n", d->spacing);
    const double step = print_step(d, world);
    print_solids(world, d->dimension);
    print_notes(world, stdout, "note             ");
    if (tobi_scene_import_table(scene))
        printf("\nA scene of %s. What became of its keys:\n\n%s\n", tobi_scene_import_program(scene),
               tobi_scene_import_table(scene));
    return step;
}

static void print_size(const tobi_scene *scene, const tobi_run_size *size)
{
    char bytes[32], *dir = results_path(scene, NULL), *objection = dir ? size_objection(size, dir) : NULL;
    const double every = tobi_scene_output_def(scene)->interval;
    const double left = remainder(tobi_scene_world_def(scene)->end_time, every);
    printf("outputs          %lld, every %g s%s: about %s in %.7g files\n", (long long)size->outputs, every,
           fabs(left) > 1e-9*every ? " and at the end" : "", bytes_text(size->bytes, bytes), size->files);
    if (objection) printf("note             %s\n", objection);
    free(objection);
    free(dir);
}

/* The world takes some steps. They are often longer than what is guessed for the whole run: the truth lies
   between. Where they are shorter (springs, viscosity, surface tension), they count. */
static int print_time(const tobi_scene *scene, tobi_world *world, double step)
{
    const double end = tobi_scene_world_def(scene)->end_time;
    double wall, taken;
    char least[32], most[32];
    int steps;
    tobi_error err;
    if (measure_steps(world, end, &steps, &wall, &taken, &err) != TOBI_OK)
        return complain("after %d steps: %s", steps, err.text);
    if (steps < 2) return 0;
    if (step > 0 && taken < 0.5*step)
        printf("note             the first steps are %.3g s: about %.0f steps to %g s\n", taken, end/taken,
               end);
    if (step == 0 || taken < step) step = taken;
    duration_text(wall * end / taken, least);
    duration_text(wall * end / step, most);
    const int differ = taken > 1.3 * step && strcmp(least, most) != 0;
    printf("wall clock       about %s%s%s for the steps on this machine, if as fast as the first %d%s\n",
           differ ? least : "", differ ? " to " : "", most, steps,
           tobi_scene_output_def(scene)->frames ? "; pictures take more" : "");
    return 0;
}

/* So many particles are placed as a run would place them, and stepped; a check of more takes an estimate,
   in no time. */
enum { START_LIMIT = 1000000 };

/* What a run takes. The start knows for certain what bodies and planes leave, and what a run would
   refuse. */
typedef struct cost { int64_t fluid, bodies, bytes; tobi_run_size size; } cost;

static tobi_status find_cost(const tobi_scene *scene, tobi_world *world, cost *c, tobi_error *err)
{
    tobi_status status = tobi_world_estimate(world, &c->fluid, &c->bodies, &c->bytes, err);
    if (status == TOBI_OK && c->fluid <= START_LIMIT) status = tobi_world_start(world, err);
    if (status == TOBI_OK) status = tobi_world_estimate(world, &c->fluid, &c->bodies, &c->bytes, err);
    if (status != TOBI_OK) return status;
    return tobi_run_estimate(world, tobi_scene_output_def(scene), tobi_scene_world_def(scene)->end_time,
                             &c->size, err);
}

static double machine_bytes(void) { return (double)sysconf(_SC_PHYS_PAGES)*(double)sysconf(_SC_PAGESIZE); }

static const char too_many[] = "more particles than this machine has memory for";

tobi_status try_scene(tobi_scene *scene, tobi_error *err)
{
    tobi_world *world = NULL;
    cost c = { 0 };
    tobi_status status = tobi_scene_build(scene, &world, err);
    if (status == TOBI_OK) status = find_cost(scene, world, &c, err);
    if (status != TOBI_OK) tobi_scene_place_error(scene, err);
    if (status == TOBI_OK && (double)c.bytes > machine_bytes()) {
        status = TOBI_NO_MEMORY;
        snprintf(err->text, sizeof err->text, "%s", too_many);
    }
    tobi_world_destroy(world);
    return status;
}

/* What the particles are that the methods move. */
static const char *name_particles(const tobi_scene *scene, const tobi_world *world)
{
    tobi_method_info method = { 0 };
    if (tobi_world_solid_count(world) == 0) return "fluid particles";
    tobi_method_describe(tobi_scene_world_def(scene)->method, &method);
    return method.solids ? "solid particles" : "particles";
}

static int check_world(tobi_scene *scene)
{
    tobi_error err = { 0 };
    tobi_world *world = NULL;
    cost c = { 0 };
    tobi_status status = tobi_scene_build(scene, &world, &err);
    if (status == TOBI_OK) status = find_cost(scene, world, &c, &err);
    if (status != TOBI_OK) {
        tobi_scene_place_error(scene, &err);
        tobi_world_destroy(world);
        return complain("%s", err.text);
    }
    const double step = print_scene(scene, world);
    const double machine = machine_bytes();
    if (c.fluid > 0)
        printf("%-17s%lld\n", name_particles(scene, world), (long long)c.fluid);
    printf("body particles   %lld\n", (long long)c.bodies);
    printf("memory           %.1f MB of %.0f MB\n", (double)c.bytes * 1e-6, machine * 1e-6);
    print_size(scene, &c.size);
    int code = (double)c.bytes > machine ? complain("%s", too_many) : 0;
    if (c.fluid <= START_LIMIT) code |= print_time(scene, world, step);
    else printf("wall clock       not measured with more than %d particles\n", START_LIMIT);
    tobi_world_destroy(world);
    return code;
}

const struct argp check_argp = {
    .options = options,
    .parser = parse,
    .args_doc = "SCENE",
    .doc =
        "Check a scene without running it: every mistake, particle counts, memory, time step, size of "
        "the results, time that a run takes."
};

int tobiuo_check(int argc, char **argv)
{
    check_options o = { 0 };
    parse_arguments(&check_argp, argc, argv, &o);
    tobi_scene *scene = load_scene(o.scene, &o.set);
    int code = scene ? check_world(scene) : EXIT_ERROR;
    tobi_scene_free(scene);
    return code;
}
