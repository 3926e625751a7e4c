/* The results of a run's nests, for pictures of the run. Where a nest has no results at a time, the scene
   alone is drawn. Drawback: of each nest the first trouble is told, and no other. */
#define _GNU_SOURCE
#include "app.h"
#include "tobiuo/drawing.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct nest_results {
    const tobi_scene *scene;
    tobi_scene *outer;                      /* owned: of the run around, if this is a nest; NULL */
    const tobi_nest_def *self;              /* of that, or NULL */
    const char *dir;
    int count, told[TOBI_NEST_LIMIT];
    tobi_results *of[TOBI_NEST_LIMIT];      /* NULL: none yet */
};

static tobi_status open_one(nest_results *n, int k, tobi_error *err)
{
    char *path = NULL;
    if (n->of[k]) return tobi_results_refresh(n->of[k], err);
    if (asprintf(&path, "%s/nests/%s", n->dir, tobi_scene_nest_def(n->scene, k)->name) < 0)
        return TOBI_NO_MEMORY;
    const tobi_status status = tobi_results_open(path, &n->of[k], err);
    free(path);
    return status;
}

/* For the folder of a nest: what it is in the scene of the run around it. */
static void find_self(nest_results *n)
{
    char *run = find_outer(n->dir), *own = realpath(n->dir, NULL), *path = NULL;
    const char *name = own ? strrchr(own, '/') : NULL;
    const tobi_nest_def *def;
    if (run && name && asprintf(&path, "%s/resolved.json", run) >= 0 &&
        tobi_scene_load(path, NULL, &n->outer, NULL, NULL) == TOBI_OK)
        for (int k = 0; (def = tobi_scene_nest_def(n->outer, k)) != NULL; k++)
            if (strcmp(def->name, name + 1) == 0) n->self = def;
    free(path);
    free(own);
    free(run);
}

int take_outer_colors(const nest_results *n, tobi_looks *looks)
{
    tobi_looks outer = { 0 };
    if (!n || !n->self) return 0;
    const int code = find_looks(n->outer, &outer);
    if (code == 0) looks->speed = outer.speed;
    tobi_looks_free(&outer);
    return code;
}

nest_results *open_nests(const tobi_scene *scene, const char *dir)
{
    nest_results *n = calloc(1, sizeof *n);
    if (!n) exit(complain("out of memory"));
    n->scene = scene;
    n->dir = dir;
    while (n->count < TOBI_NEST_LIMIT && tobi_scene_nest_def(scene, n->count)) n->count++;
    if (n->count == 0) find_self(n);
    return n;
}

void close_nests(nest_results *n)
{
    for (int k = 0; n && k < n->count; k++) tobi_results_free(n->of[k]);
    if (n) tobi_scene_free(n->outer);
    free(n);
}

/* The output at a time, or -1. */
static int64_t find_time(const tobi_results *results, double time)
{
    for (int64_t k = tobi_results_count(results) - 1; k >= 0; k--)
        if (fabs(tobi_results_time(results, k) - time) <= 1e-7*fabs(time)) return k;
    return -1;
}

static void tell(nest_results *n, int k, double time, const char *why)
{
    if (n->told[k]++ == 0)
        fprintf(stderr, tr("tobiuo: note: nest '%s' is not drawn at %g s: %s\n"),
                tobi_scene_nest_def(n->scene, k)->name, time, why);
}

static void add_one(nest_results *n, int k, const tobi_looks *looks, tobi_moment *m)
{
    const tobi_nest_def *def = tobi_scene_nest_def(n->scene, k);
    const double spacing = looks->spacing/def->refinement;
    tobi_moment own = { 0 };
    tobi_error err = { 0 };
    double box[2][3];
    tobi_status status = open_one(n, k, &err);
    const int64_t output = status == TOBI_OK ? find_time(n->of[k], m->time) : -1;
    if (status != TOBI_OK) return tell(n, k, m->time, err.text);
    if (output < 0) return tell(n, k, m->time, tr("it has no results of that time"));
    if (!tobi_nest_box(looks, def, m, box))
        return tell(n, k, m->time, tr("the output has no surface of the body that its box follows"));
    status = tobi_results_read(n->of[k], output, &own, &err);
    if (status == TOBI_OK)
        status = tobi_moment_add_nest(m, &own, (const double (*)[3])box, spacing, &err);
    tobi_moment_free(&own);
    if (status != TOBI_OK) tell(n, k, m->time, err.text);
}

/* The rim of a nest is left out of its own pictures. */
static void add_self(const nest_results *n, const tobi_looks *looks, tobi_moment *m)
{
    tobi_looks own = *looks;
    own.is_nest = 1;
    m->nest_count = tobi_nest_box(&own, n->self, m, m->nests[0]);
    m->nest_spacing[0] = looks->spacing;
}

void add_nests(nest_results *n, const tobi_looks *looks, tobi_moment *m)
{
    if (n && n->self) add_self(n, looks, m);
    for (int k = 0; n && k < n->count; k++) add_one(n, k, looks, m);
}
