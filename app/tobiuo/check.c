/* tobiuo check SCENE: what a run would be, without running. */
#include "app.h"
#include <math.h>
#include <stdio.h>
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
static double guess_step(const tobi_world_def *d, double stable, int solids)
{
    if (d->time_step > 0.0)
        return solids && stable > 0.0 ? d->time_step / ceil(d->time_step / stable) : d->time_step;
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

static void print_scene(const tobi_scene *scene, const tobi_world *world)
{
    const tobi_world_def *d = tobi_scene_world_def(scene);
    const tobi_output_def *out = tobi_scene_output_def(scene);
    printf("scene            %s (%s, %d-D)\n", tobi_scene_name(scene), d->method, d->dimension);
    const double *low = d->domain_min, *high = d->domain_max;
    printf("domain           %g %g %g  to  %g %g %g m\n", low[0], low[1], low[2], high[0], high[1],
           high[2]);
    printf("spacing          %g m\n", d->spacing);
    double step = guess_step(d, tobi_world_stable_step(world), tobi_world_solid_count(world));
    if (step > 0.0)
        printf("time step        %s%.3g s, about %.9g steps to %g s\n",
               d->time_step > 0.0 ? "" : "about ", step, ceil(d->end_time / step), d->end_time);
    else
        printf("time step        adaptive, to %g s\n", d->end_time);
    double outputs = floor(d->end_time / out->interval * (1.0 + 1e-9)) + 1.0;
    printf("outputs          %.0f, every %g s\n", outputs, out->interval);
}

/* Particles that are placed as a run would place them; a check of more takes an estimate, in no time. */
enum { START_LIMIT = 1000000 };

static int check_world(tobi_scene *scene)
{
    tobi_error err = { 0 };
    tobi_world *world = NULL;
    int64_t fluid = 0, bodies = 0, bytes = 0;
    tobi_status status = tobi_scene_build(scene, &world, &err);
    if (status == TOBI_OK) status = tobi_world_estimate(world, &fluid, &bodies, &bytes, &err);
    /* The start knows for certain what bodies and planes leave, and what a run would refuse. */
    const int small = fluid <= START_LIMIT;
    if (status == TOBI_OK && small) status = tobi_world_start(world, &err);
    if (status == TOBI_OK && small) status = tobi_world_estimate(world, &fluid, &bodies, &bytes, &err);
    if (status == TOBI_OK) {
        print_scene(scene, world);
        print_solids(world, tobi_scene_world_def(scene)->dimension);
        print_notes(world, stdout, "note             ");
    }
    int solids = status == TOBI_OK ? tobi_world_solid_count(world) : 0;
    tobi_world_destroy(world);
    if (status != TOBI_OK) return complain("%s", err.text);
    if (tobi_scene_import_table(scene))
        printf("\nA scene of the Taichi program. What became of its keys:\n\n%s\n",
               tobi_scene_import_table(scene));
    double machine = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
    if (fluid > 0) printf("%s particles  %lld\n", solids ? "solid" : "fluid", (long long)fluid);
    printf("body particles   %lld\n", (long long)bodies);
    printf("memory           %.1f MB of %.0f MB\n", (double)bytes * 1e-6, machine * 1e-6);
    if ((double)bytes > machine) return complain("more particles than this machine has memory for");
    return 0;
}

int tobiuo_check(int argc, char **argv)
{
    static const struct argp argp = {
        .options = options,
        .parser = parse,
        .args_doc = "SCENE",
        .doc =
            "Check a scene without running it: every mistake, particle counts, memory, time step."
    };
    check_options o = { 0 };
    argp_parse(&argp, argc, argv, 0, NULL, &o);
    tobi_scene *scene = load_scene(o.scene, &o.set);
    int code = scene ? check_world(scene) : EXIT_ERROR;
    tobi_scene_free(scene);
    return code;
}
