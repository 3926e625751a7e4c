/* tobiuo check SCENE: what a run would be, from its first steps at most. */
#include "app.h"
#include "language.h"
#include "tobiuo/matter.h"
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
        print_label(tr("solid"));
        printf(tr("%s: %lld particles, %.4g %s, %.4g kg/m3"), solid.name, (long long)solid.particles,
               solid.mass, dimension == 3 ? "kg" : "kg/m", solid.density);
        if (solid.time_step < 1.0) printf(tr(", time step at most %.3g s"), solid.time_step);
        printf("\n");
    }
}

/* Where it floats upright, and how stiffly: GM about the axes that it may turn about. */
static void print_flotation(const tobi_body_matter *m)
{
    static const char *const axes[] = { "x", "y", "z" };
    const char *and = "";
    if (!(m->draught > 0.0)) return;
    printf(tr("; floats with a draught of %.4g m, GM "), m->draught);
    for (int a = 0; a < 3; a++) {
        if (m->metacentre[a] == 0.0) continue;
        printf(tr("%s%.4g m about %s"), and, m->metacentre[a], axes[a]);
        and = ", ";
    }
}

enum { BODIES_LISTED = 12 };

/* Those that move by forces, as they start: the first ones, and how many there are. */
typedef struct moving_bodies {
    int count, number[BODIES_LISTED];
    tobi_body_matter matter[BODIES_LISTED];
} moving_bodies;

static void find_bodies(const tobi_world *world, moving_bodies *b)
{
    tobi_body_matter m;
    b->count = 0;
    for (int k = 0; tobi_world_body_matter(world, k, &m) == TOBI_OK; k++) {
        if (m.dynamics == TOBI_PRESCRIBED || b->count++ >= BODIES_LISTED) continue;
        b->number[b->count - 1] = k;
        b->matter[b->count - 1] = m;
    }
}

static void print_bodies(const tobi_world *world, const moving_bodies *b, int dimension)
{
    const char *each = dimension == 3 ? "" : "/m";
    for (int k = 0; k < b->count && k < BODIES_LISTED; k++) {
        const tobi_body_matter m = b->matter[k];
        print_label(tr("body"));
        printf("%s: %.4g kg%s, %.4g m3%s", tobi_world_body_name(world, b->number[k]), m.mass, each, m.volume,
               each);
        if (m.liquid > 0.0) printf(tr(", %.4g of the liquid's density"), m.mass / m.volume / m.liquid);
        if (dimension == 2) printf(tr(", centre of mass %.4g %.4g m"), m.centre[0], m.centre[1]);
        else printf(tr(", centre of mass %.4g %.4g %.4g m"), m.centre[0], m.centre[1], m.centre[2]);
        if (dimension == 3)
            printf(tr(", inertia %.4g %.4g %.4g kg m2"), m.inertia[0], m.inertia[4], m.inertia[8]);
        else printf(tr(", inertia %.4g kg m2/m"), m.inertia[8]);
        print_flotation(&m);
        if (m.solids > 0)
            printf(tr("; without the %d solid%s that it holds, so no draught"), m.solids,
                   m.solids > 1 ? "s" : "");
        printf("\n");
    }
    if (b->count > BODIES_LISTED) {
        print_label(tr("body"));
        printf(tr("and %d more that move by forces\n"), b->count - BODIES_LISTED);
    }
}

/* What porous zones resist, and how large they are. */
static void print_zones(const tobi_world *world, int dimension)
{
    tobi_porous_info z;
    const char *name;
    for (int k = 0; (name = tobi_world_porous(world, k, &z)); k++) {
        print_label(tr("porous zone"));
        printf("%s: %.4g 1/s, %.4g 1/m", name, z.linear, z.quadratic);
        if (z.direction[0] != 0.0 || z.direction[1] != 0.0 || z.direction[2] != 0.0)
            printf(z.radial ? tr(" away from (%.3g, %.3g, %.3g)") : z.along ? tr(" along (%.3g, %.3g, %.3g)")
                   : tr(" across (%.3g, %.3g, %.3g)"), z.direction[0], z.direction[1], z.direction[2]);
        printf(tr(", in %.4g %s\n"), z.extent, dimension == 2 ? "m2" : "m3");
    }
}

/* Temperature and concentration: their range after the first steps. */
static void print_scalars(const tobi_world *world)
{
    tobi_scalar_info s;
    for (int k = 0; tobi_world_scalar(world, k, &s); k++) {
        print_label(tr(s.field));
        printf(tr("%.4g to %.4g%s, mean %.4g\n"), s.least, s.most, strcmp(s.unit, "1") == 0 ? "" : " degC",
               s.mean);
    }
}

enum { LINES_LISTED = 12 };

/* The first steps of a run, and what they tell of all. */
typedef struct trial {
    tobi_line_info line[LINES_LISTED];       /* as they start               */
    moving_bodies bodies;
    int steps;               /* taken; below 2 nothing is known             */
    double wall, step;       /* of one of them, s                           */
    double least, most;      /* time step of the run, s; 0: it is not known */
    tobi_status status;
    tobi_error err;
} trial;

/* The step that is fixed, or where the shortest is guessed; 0: neither. */
static double find_step(const tobi_world_def *d, const tobi_world *world)
{
    const double stable = tobi_world_stable_step(world);
    if (!(d->time_step > 0.0)) return guess_step(d, stable);
    return tobi_world_solid_count(world) && stable > 0.0 ? d->time_step / ceil(d->time_step / stable)
                                                         : d->time_step;
}

/* The world takes some steps. They are longer than what is guessed where the liquid stays slower than a fall;
   the truth lies between. Where they are shorter (springs, viscosity, surface tension), they count. */
static void try_steps(const tobi_world_def *d, tobi_world *world, int starts, trial *t)
{
    *t = (trial){ .least = find_step(d, world) };
    t->most = t->least;
    for (int k = 0; k < LINES_LISTED; k++) tobi_world_line(world, k, &t->line[k]);
    find_bodies(world, &t->bodies);
    if (starts) t->status = measure_steps(world, d->end_time, &t->steps, &t->wall, &t->step, &t->err);
    if (t->status != TOBI_OK || t->steps < 2 || (d->time_step > 0.0 && t->step > 0.5 * t->least)) return;
    t->most = t->step;
    t->least = t->least > 0.0 ? fmin(t->least, t->step) : t->step;
}

#define ROUNDING 1e-9                /* N, of the places of a stiff line's ends */

/* Lines as they start. */
static void print_lines(const tobi_world *world, int dimension, const trial *t)
{
    const char *name;
    for (int k = 0; k < LINES_LISTED && (name = tobi_world_line(world, k, NULL)); k++) {
        const double tension = fabs(t->line[k].tension) < ROUNDING ? 0 : t->line[k].tension;
        print_label(tr("line"));
        printf(tr("%s: %.4g m from end to end, tension %.4g %s at the start\n"), name, t->line[k].distance,
               tension, dimension == 2 ? "N per m" : "N");
    }
}

static int is_range(const trial *t) { return t->most > 1.3 * t->least; }

/* Says what a fixed step costs: of the automatic one the shortest is guessed. */
static void print_step(const tobi_world_def *d, const tobi_world *world, const trial *t)
{
    const double automatic = guess_step(d, tobi_world_stable_step(world));
    print_label(tr("time step"));
    if (!(t->least > 0.0)) printf(tr("adaptive, to %g s"), d->end_time);
    else if (is_range(t))
        printf(tr("%.3g to %.3g s: %.9g to %.9g steps to %g s"), t->least, t->most,
               ceil(d->end_time / t->most), ceil(d->end_time / t->least), d->end_time);
    else
        printf(d->time_step > 0.0 ? tr("fixed, %.3g s, about %.9g steps to %g s")
               : tr("about %.3g s, about %.9g steps to %g s"), t->least, ceil(d->end_time / t->least),
               d->end_time);
    if (d->time_step > 0.0 && t->least < 0.7 * automatic)
        printf(tr(": up to %.2g times the steps and the time of \"adaptive\""), automatic / t->least);
    printf("\n");
}

static void print_scene(const tobi_scene *scene, const tobi_world *world, const trial *t)
{
    const tobi_world_def *d = tobi_scene_world_def(scene);
    print_label(tr("scene"));
    printf(tr("%s (%s, %d-D)\n"), tobi_scene_name(scene), d->method, d->dimension);
    const double *low = d->domain_min, *high = d->domain_max;
    print_label(tr("domain"));
    if (d->dimension == 2) printf(tr("%g %g  to  %g %g m\n"), low[0], low[1], high[0], high[1]);
    else printf(tr("%g %g %g  to  %g %g %g m\n"), low[0], low[1], low[2], high[0], high[1], high[2]);
    print_label(tr("spacing"));
    printf("%g m\n", d->spacing);
    print_step(d, world, t);
    print_solids(world, d->dimension);
    print_bodies(world, &t->bodies, d->dimension);
    if (t->steps > 0) print_lines(world, d->dimension, t);
    print_zones(world, d->dimension);
    print_scalars(world);
    const char *note;
    for (int k = 0; (note = tobi_world_note(world, k)); k++) {
        print_label(tr("note"));
        printf("%s\n", note);
    }
    if (tobi_scene_import_table(scene))
        printf(tr("\nA scene of %s. What became of its keys:\n\n%s\n"), tr(tobi_scene_import_program(scene)),
               tobi_scene_import_table(scene));
}

/* Of all nests: their particles times the steps that they take in one of the scene, at the start and when
   liquid has come; bytes of memory then. */
typedef struct nest_cost { double start, most, bytes; } nest_cost;

/* Starts the nests and tells what they are. each: bytes of a particle of the scene. */
static tobi_status print_nests(const tobi_scene *scene, const tobi_nests *nests, double each, nest_cost *cost,
                               tobi_error *err)
{
    const char *name;
    tobi_world *w;
    *cost = (nest_cost){ 0 };
    for (int k = 0; (w = tobi_nests_world(nests, k, &name)) != NULL; k++) {
        int64_t fluid, bodies, size;
        const double spacing = tobi_nests_spacing(nests, k);
        tobi_status status = tobi_world_start(w, err);
        if (status == TOBI_OK) status = tobi_world_estimate(w, &fluid, &bodies, &size, err);
        if (status != TOBI_OK) return status;
        const int refinement = tobi_scene_nest_def(scene, k)->refinement;
        const double most = fmax(tobi_world_nest_most(w), (double)fluid);
        print_label(tr("nest"));
        printf(tr("%s: spacing %g m, %lld particles at the start, at most %lld when liquid has come\n"), name,
               spacing, (long long)fluid, (long long)most);
        cost->start += (double)fluid*refinement;
        cost->most += most*refinement;
        cost->bytes += (double)size + (most - (double)fluid)*each;
    }
    return TOBI_OK;
}

static void print_size(const tobi_scene *scene, const tobi_run_size *size)
{
    char bytes[32], *dir = results_path(scene, NULL), *objection = dir ? size_objection(size, dir) : NULL;
    const double every = tobi_scene_output_def(scene)->interval;
    const double left = remainder(tobi_scene_world_def(scene)->end_time, every);
    print_label(tr("outputs"));
    printf(tr("%lld, every %g s%s: about %s in %.7g files\n"), (long long)size->outputs, every,
           fabs(left) > 1e-9*every ? tr(" and at the end") : "", bytes_text(size->bytes, bytes), size->files);
    if (objection) {
        print_label(tr("note"));
        printf("%s\n", objection);
    }
    free(objection);
    free(dir);
}

/* Of nests over the time of the scene's own steps: at the start, and when liquid has come. */
static int print_time(const tobi_scene *scene, const trial *t, double start, double more)
{
    const double end = tobi_scene_world_def(scene)->end_time;
    char least[32], most[32];
    if (t->status != TOBI_OK) return complain("after %d steps: %s", t->steps, t->err.text);
    if (t->steps < 2) return 0;
    duration_text((1 + start) * t->wall * end / t->most, least);
    duration_text((1 + more) * t->wall * end / t->least, most);
    const int differ = (is_range(t) || more > start) && strcmp(least, most) != 0;
    print_label(tr("wall clock"));
    printf(tr("about %s%s%s for the steps on this machine, if as fast as the first %d%s%s\n"),
           differ ? least : "", differ ? tr(" to ") : "", most, t->steps,
           more > 0 ? tr(", nests by their particles") : "",
           tobi_scene_output_def(scene)->frames ? tr("; pictures take more") : "");
    return 0;
}

/* So many particles are placed as a run would place them, and stepped; a check of more takes an estimate,
   in no time. */
enum { START_LIMIT = 1000000 };

/* Bytes of the program before there is a world: libraries and tables (seen: 29 to 33 MB). */
static const double PROGRAM = 30e6;

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

/* Of the whole process; the world is as large as the estimate, or as it is after some steps. */
static double all_bytes(const cost *c, const tobi_world *world)
{
    return fmax((double)c->bytes, (double)tobi_world_bytes(world)) + c->size.memory + PROGRAM;
}

static double machine_bytes(void) { return (double)sysconf(_SC_PHYS_PAGES)*(double)sysconf(_SC_PAGESIZE); }

static const char too_many[] = TEXT("more particles than this machine has memory for");

tobi_status try_scene(tobi_scene *scene, tobi_error *err)
{
    tobi_world *world = NULL;
    cost c = { 0 };
    tobi_status status = tobi_scene_build(scene, &world, err);
    if (status == TOBI_OK) status = find_cost(scene, world, &c, err);
    if (status != TOBI_OK) tobi_scene_place_error(scene, err);
    if (status == TOBI_OK && all_bytes(&c, world) > machine_bytes()) {
        status = TOBI_NO_MEMORY;
        snprintf(err->text, sizeof err->text, "%s", tr(too_many));
    }
    tobi_world_destroy(world);
    return status;
}

/* What the particles are that the methods move. */
static const char *name_particles(const tobi_scene *scene, const tobi_world *world)
{
    tobi_method_info method = { 0 };
    if (tobi_world_solid_count(world) == 0) return tr("fluid particles");
    tobi_method_describe(tobi_scene_world_def(scene)->method, &method);
    return method.solids ? tr("solid particles") : tr("particles");
}

static int end_check(tobi_scene *scene, tobi_world *world, tobi_nests *nests, tobi_error *err)
{
    tobi_scene_place_error(scene, err);
    tobi_nests_free(nests);
    tobi_world_destroy(world);
    return complain("%s", err->text);
}

static int check_world(tobi_scene *scene)
{
    tobi_error err = { 0 };
    tobi_world *world = NULL;
    cost c = { 0 };
    tobi_nests *nests = NULL;
    nest_cost more;
    tobi_status status = tobi_scene_build(scene, &world, &err);
    if (status == TOBI_OK) status = tobi_nests_create(scene, world, &nests, &err);
    if (status == TOBI_OK) status = find_cost(scene, world, &c, &err);
    if (status != TOBI_OK) return end_check(scene, world, nests, &err);
    trial t;
    try_steps(tobi_scene_world_def(scene), world, c.fluid <= START_LIMIT, &t);
    print_scene(scene, world, &t);
    const double own = fmax((double)c.fluid, 1);
    if (print_nests(scene, nests, (double)c.bytes/own, &more, &err) != TOBI_OK ||
        tobi_nests_estimate(nests, tobi_scene_world_def(scene)->end_time, &c.size, &err) != TOBI_OK)
        return end_check(scene, world, nests, &err);
    const double machine = machine_bytes(), needed = all_bytes(&c, world) + more.bytes;
    if (c.fluid > 0) {
        print_label(name_particles(scene, world));
        printf("%lld\n", (long long)c.fluid);
    }
    print_label(tr("body particles"));
    printf("%lld\n", (long long)c.bodies);
    print_label(tr("memory"));
    printf(tr("%.1f MB of %.0f MB\n"), needed * 1e-6, machine * 1e-6);
    print_size(scene, &c.size);
    int code = needed > machine ? complain("%s", tr(too_many)) : 0;
    if (c.fluid <= START_LIMIT) code |= print_time(scene, &t, more.start/own, more.most/own);
    else {
        print_label(tr("wall clock"));
        printf(tr("not measured with more than %d particles\n"), START_LIMIT);
    }
    tobi_nests_free(nests);
    tobi_world_destroy(world);
    return code;
}

const struct argp check_argp = {
    .options = options,
    .parser = parse,
    .args_doc = "SCENE",
    .doc =
        "Check a scene without running it: every mistake, particle counts, mass and draught of bodies, "
        "memory, time step, size of the results, time that a run takes."
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
