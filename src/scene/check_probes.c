/* Sensors: what no table can see. The world says the same to C programs, without line and column. */
#include "scene/scene.h"
#include "base/param.h"
#include <math.h>
#include <string.h>

typedef struct one {
    const tobi_scene *scene;
    tobi_source *source;
    const tobi_probe_def *def;
    tobi_place entry;
} one;

static void tell(const one *o, const char *key, const char *what)
{
    const tobi_place at = { &o->entry, key, 0 };
    tobi_source_mistake(o->source, &at, "%s", what);
}

static void check_inside(const one *o, const char *key, const double x[3])
{
    const tobi_world_def *w = &o->scene->world;
    const tobi_place at = { &o->entry, key, 0 };
    for (int a = 0; tobi_check_has_domain(o->scene) && a < w->dimension; a++)
        if (x[a] < w->domain_min[a] || x[a] > w->domain_max[a])
            tobi_source_mistake(o->source, &at,
                                "is %.10g m in %c, the domain reaches from %.10g to %.10g m", x[a],
                                "xyz"[a], w->domain_min[a], w->domain_max[a]);
}

/* The kinds that read a key, as bits. */
#define OF(kind) (1 << TOBI_PROBE_##kind)
#define BOXES (OF(PATCH) | OF(FLOW) | OF(VOLUME))
static const struct { const char *key; int kinds; const char *why; } read_by[] = {
    { "end", OF(RUN_UP), TR("is for a run-up, and this is none") },
    { "normal", BOXES, TR("is for a patch, a flow or a volume") },
    { "along", BOXES, TR("is for a patch, a flow or a volume") },
    { "length", BOXES, TR("is for a patch, a flow or a volume") },
    { "width", BOXES, TR("is for a patch, a flow or a volume") },
    { "height", OF(VOLUME), TR("is for a volume") },
    { "fluid", ~(OF(POINT) | OF(PATCH)), TR("is for a level, a run-up, a flow or a volume") },
    { "body", ~OF(LEVEL), TR("is not for a level, which stands still; a run-up can sit on a body") },
};
enum { READ_BY = sizeof read_by/sizeof *read_by };

static int is_read(const tobi_probe_def *def, int k) { return read_by[k].kinds >> def->kind & 1; }

void tobi_probe_drop_unread(const tobi_probe_def *def, json_t *object)
{
    for (int k = 0; k < READ_BY; k++)
        if (!is_read(def, k)) json_object_del(object, read_by[k].key);
}

/* Where some value is wrong, a key may be for what the value was to say: one mistake after the other. */
static void check_keys(const one *o, tobi_bound bound)
{
    for (int k = 0; bound.given == bound.good && k < READ_BY; k++) {
        const tobi_place at = { &o->entry, read_by[k].key, 0 };
        if (tobi_bind_has(&tobi_probe_table, bound.given, read_by[k].key) && !is_read(o->def, k))
            tobi_source_mistake_at_key(o->source, &at, "%s", tr(read_by[k].why));
    }
}

static void check_sizes(const one *o, tobi_rows given)
{
    const tobi_probe_def *d = o->def;
    const int flat = o->scene->world.dimension == 2;
    if (d->kind == TOBI_PROBE_RUN_UP && !tobi_bind_has(&tobi_probe_table, given, "end"))
        tell(o, "end", tr("is missing: a run-up is a line"));
    else if (d->kind == TOBI_PROBE_RUN_UP) {
        check_inside(o, "end", d->end);
        if (memcmp(d->end, d->position, sizeof d->end) == 0) tell(o, "end", tr("is where the run-up begins"));
    }
    if (d->kind != TOBI_PROBE_PATCH && d->kind != TOBI_PROBE_FLOW && d->kind != TOBI_PROBE_VOLUME) return;
    if (!(d->length > 0)) tell(o, "length", tr("is missing (greater than 0 m)"));
    if (!flat && !(d->width > 0)) tell(o, "width", tr("is missing (greater than 0 m)"));
    if (d->kind == TOBI_PROBE_VOLUME && !(d->height > 0)) tell(o, "height",
                                                               tr("is missing (greater than 0 m)"));
    if (flat && d->normal[2] != 0) tell(o, "normal", tr("has a z, and the scene is 2-D"));
    if (flat && d->along[2] != 0) tell(o, "along", tr("has a z, and the scene is 2-D"));
}

enum { NAMES = 64 };

/* None of the names is the one that a key has. */
static void tell_nearest(const one *o, const char *key, const char *name, const char *const *names,
                         size_t count)
{
    const tobi_place at = { &o->entry, key, 0 };
    const char *near = tobi_suggest(name, names, count);
    if (near) tobi_source_mistake(o->source, &at, "there is no %s \"%s\"; did you mean \"%s\"?", key, name,
                                  near);
    else tobi_source_mistake(o->source, &at, "there is no %s \"%s\"", key, name);
}

static void check_fluid(const one *o)
{
    const char *names[NAMES], *name = o->def->fluid;
    size_t count = 0;
    if (!name) return;
    for (int f = 0; f < o->scene->fluid_count; f++) {
        const char *other = o->scene->fluids[f].def.name;
        if (!other) continue;
        if (strcmp(other, name) == 0) return;
        if (count < NAMES) names[count++] = other;
    }
    tell_nearest(o, "fluid", name, names, count);
}

static void check_body(const one *o)
{
    const char *names[NAMES], *name = o->def->body;
    const tobi_place at = { &o->entry, "body", 0 };
    size_t count = 0;
    if (!name) return;
    for (int b = 0; b < o->scene->body_count; b++) {
        const tobi_scene_body *body = &o->scene->bodies[b];
        if (!body->def.name) continue;
        if (strcmp(body->def.name, name) == 0) {
            if (body->motion && !body->def.motion_rigid)
                tobi_source_mistake(o->source, &at,
                                    "\"%s\" deforms: the sensor would have no place on it; "
                                    "output.tractions has the pressure on its surface", name);
            return;
        }
        if (count < NAMES) names[count++] = body->def.name;
    }
    tell_nearest(o, "body", name, names, count);
}

static void check_rate(const one *o)
{
    const tobi_probe_def *d = o->def;
    const double step = o->scene->world.time_step, steps = step > 0 ? 1/step : INFINITY;
    const double rate = d->rate > 0 ? d->rate : steps;
    const tobi_place at = { &o->entry, "rate", 0 }, filter = { &o->entry, "filter", 0 };
    const tobi_place cutoff = { &filter, "cutoff", 0 }, order = { &filter, "order", 0 };
    if (d->order && !(d->cutoff > 0))
        tobi_source_mistake_at_key(o->source, &order, "is of a filter, which needs a cutoff");
    if (d->rate > steps*(1 + 1e-9))
        tobi_source_mistake(o->source, &at,
                            "is %.10g Hz, more than a value per time step of %.10g s; allowed is up "
                            "to %.10g Hz", d->rate, step, steps);
    else if (d->cutoff > 0.5*rate)
        tobi_source_mistake(o->source, &cutoff,
                            "is %.10g Hz, more than half of %.10g values per second; allowed is "
                            "up to %.10g Hz", d->cutoff, rate, 0.5*rate);
}

void tobi_check_probes(const tobi_scene *scene, tobi_source *source)
{
    const tobi_place root = { 0 }, probes = { &root, "probes", 0 };
    for (int i = 0; i < scene->probe_count && !tobi_report_full(source->report); i++) {
        const one o = { scene, source, &scene->probes[i], { &probes, NULL, (size_t)i } };
        tobi_check_name(scene, source, &o.entry);
        check_inside(&o, "position", o.def->position);
        const tobi_bound bound = scene->probes_bound[i];
        check_keys(&o, bound);
        if (bound.given != bound.good) continue;
        check_sizes(&o, bound.given);
        check_body(&o);
        check_fluid(&o);
        check_rate(&o);
    }
}
