/* The nests of a scene: for each a second copy of the scene, as it would be alone with the nest's spacing, a
   world of it and a run in the folder nests/NAME. Drawback: each nest reads the scene's meshes again. */
#include "base/error.h"
#include "scene/scene.h"
#include "tobiuo/run.h"
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

typedef struct one_nest {
    tobi_scene *scene;             /* owned                                       */
    tobi_world *world;             /* owned                                       */
    tobi_run *run;                 /* owned; NULL before it is recorded           */
    tobi_nest_body *body;          /* owned: of bodies that go as the outer ones  */
    const char *name;              /* of the scene                                */
} one_nest;

struct tobi_nests {
    int count;
    tobi_world *outer;             /* the caller's                                */
    one_nest at[TOBI_NEST_LIMIT];
};

void tobi_nests_check(const tobi_scene *scene, tobi_source *source)
{
    static const tobi_place root = { 0 }, list = { &root, "nests", 0 };
    for (int k = 0; k < scene->tank.nest_count; k++) {
        const tobi_nest_def *n = &scene->tank.nests[k];
        const tobi_place entry = { &list, NULL, (size_t)k }, name = { &entry, "name", 0 },
                         follow = { &entry, "follow", 0 };
        tobi_check_name(scene, source, &entry);
        if (n->name && !tobi_nest_name_fits(n->name))
            tobi_source_mistake(source, &name, "\"%s\" names a folder: allowed are letters, digits, _ and -",
                                n->name);
        if (n->follow && !tobi_scene_find_body(scene, n->follow))
            tobi_source_mistake(source, &follow, "\"%s\" is no body of the scene", n->follow);
    }
}

const tobi_nest_def *tobi_scene_nest_def(const tobi_scene *scene, int index)
{
    return scene && index >= 0 && index < scene->tank.nest_count ? &scene->tank.nests[index] : NULL;
}

static int is_inside(const tobi_nest_def *n, const double x[3], int dimension)
{
    for (int a = 0; a < dimension; a++)
        if (x[a] < n->box_min[a] || x[a] > n->box_max[a]) return 0;
    return 1;
}

/* Sensors at places where the nest has no liquid would read 0. */
static void drop_probes(tobi_scene *scene, const tobi_nest_def *n)
{
    int kept = 0;
    for (int k = 0; k < scene->probe_count; k++) {
        const tobi_probe_def *p = &scene->probes[k];
        if (!p->body && !n->follow && !is_inside(n, p->position, scene->world.dimension)) continue;
        scene->probes_bound[kept] = scene->probes_bound[k];
        scene->probes[kept++] = *p;
    }
    scene->probe_count = kept;
}

/* What moves by forces goes as in the outer world, and so do pistons that absorb. */
static tobi_status lead_bodies(one_nest *o, const tobi_world *outer, tobi_error *err)
{
    tobi_scene *s = o->scene;
    o->body = calloc((size_t)s->body_count + 1, sizeof *o->body);
    if (!o->body) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a nest");
    for (int k = 0; k < s->body_count; k++) {
        tobi_body_def *b = &s->bodies[k].def;
        o->body[k] = (tobi_nest_body){ outer, k };
        if (b->dynamics == TOBI_PRESCRIBED && !tobi_motion_absorbs(s->bodies[k].motion_def)) continue;
        tobi_body_def led = tobi_default_body_def();
        memcpy(&led, b, offsetof(tobi_body_def, motion));      /* shape and looks */
        memcpy(led.centre_of_mass, b->centre_of_mass, sizeof led.centre_of_mass);      /* of torques */
        led.motion = tobi_nest_motion;
        led.motion_user = &o->body[k];
        led.motion_rigid = b->dynamics == TOBI_PRESCRIBED || !b->motion;
        *b = led;
        tobi_script_free(s->bodies[k].control);
        s->bodies[k].control = NULL;
    }
    s->line_count = s->joint_count = 0;
    return TOBI_OK;
}

/* The scene of a nest, from that of the outer world. */
static tobi_status copy_scene(const tobi_scene *scene, one_nest *o, tobi_error *err)
{
    char *text = tobi_scene_resolved(scene);
    if (!text) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a nest");
    const tobi_status status =
        tobi_scene_parse(scene->source.name, text, strlen(text), NULL, &o->scene, NULL, err);
    free(text);
    return status;
}

static tobi_status make(const tobi_scene *scene, tobi_world *outer, const tobi_nest_def *def,
                        one_nest *o, tobi_error *err)
{
    o->name = def->name;
    TOBI_TRY(copy_scene(scene, o, err));
    o->scene->tank.nest_count = 0;
    o->scene->world.spacing /= def->refinement;
    o->scene->world.time_step /= def->refinement;
    o->scene->world.time_step_max /= def->refinement;
    o->scene->inlet_count = o->scene->outlet_count = 0;
    drop_probes(o->scene, def);
    TOBI_TRY(lead_bodies(o, outer, err));
    TOBI_TRY(tobi_scene_build(o->scene, &o->world, err));
    return tobi_world_nest(o->world, outer, def, err);
}

tobi_status tobi_nests_create(tobi_scene *scene, tobi_world *outer, tobi_nests **out, tobi_error *err)
{
    TOBI_NEED(out, "where the nests go");
    *out = NULL;
    TOBI_NEED(scene, "scene");
    TOBI_NEED(outer, "the outer world");
    tobi_nests *n = calloc(1, sizeof *n);
    if (!n) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for nests");
    n->outer = outer;
    tobi_status status = TOBI_OK;
    for (int k = 0; k < scene->tank.nest_count && status == TOBI_OK; k++) {
        n->count++;
        status = make(scene, outer, &scene->tank.nests[k], &n->at[k], err);
        status = tobi_scene_place_entry(scene, "nests", k, status, err);
    }
    if (status == TOBI_OK) *out = n;
    else tobi_nests_free(n);
    return status;
}

int tobi_nests_count(const tobi_nests *n) { return n ? n->count : 0; }

tobi_world *tobi_nests_world(const tobi_nests *n, int nest, const char **name)
{
    if (!n || nest < 0 || nest >= n->count) return NULL;
    if (name) *name = n->at[nest].name;
    return n->at[nest].world;
}

double tobi_nests_spacing(const tobi_nests *n, int nest)
{
    return n && nest >= 0 && nest < n->count ? n->at[nest].scene->world.spacing : 0;
}

static tobi_status start_all(tobi_nests *n, tobi_error *err)
{
    if (tobi_nests_count(n)) TOBI_TRY(tobi_world_start(n->outer, err));
    for (int k = 0; k < tobi_nests_count(n); k++) TOBI_TRY(tobi_world_start(n->at[k].world, err));
    return TOBI_OK;
}

tobi_status tobi_nests_follow(tobi_nests *n, tobi_error *err)
{
    TOBI_TRY(start_all(n, err));
    for (int k = 0; k < tobi_nests_count(n); k++) {
        tobi_world *w = n->at[k].world;
        if (!(tobi_world_time(w) < tobi_world_time(n->outer))) continue;
        TOBI_TRY(tobi_world_advance(w, tobi_world_time(n->outer), NULL, err));
        TOBI_TRY(tobi_world_feed(w, err));
    }
    return TOBI_OK;
}

/* dir/nests/NAME; the caller frees it. */
static char *folder_of(const one_nest *o, const char *dir)
{
    const size_t room = strlen(dir) + strlen(o->name) + sizeof "/nests/";
    char *path = malloc(room);
    if (path) snprintf(path, room, "%s/nests/%s", dir, o->name);
    return path;
}

/* The run of the outer world follows no link in its directory, and neither do those of its nests. */
static tobi_status check_folder(const char *path, int how, tobi_error *err)
{
    struct stat info;
    if (lstat(path, &info) != 0) return TOBI_OK;
    if (S_ISLNK(info.st_mode))
        return tobi_fail(err, TOBI_INVALID, "%s is a symbolic link: the results of a nest go into a plain "
                         "folder only", path);
    if (!S_ISDIR(info.st_mode))
        return tobi_fail(err, TOBI_INVALID, "%s is no folder, as the results of a nest need", path);
    return how == TOBI_NESTS_CREATE ? tobi_run_check_directory(path, err) : TOBI_OK;
}

tobi_status tobi_nests_prepare(tobi_nests *n, const char *dir, int how, tobi_error *err)
{
    TOBI_NEED(dir, "the directory");
    for (int k = 0; k < tobi_nests_count(n); k++) {
        char *path = folder_of(&n->at[k], dir);
        if (!path) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a nest");
        const tobi_status status = check_folder(path, how, err);
        free(path);
        TOBI_TRY(status);
    }
    return how == TOBI_NESTS_RESUME ? TOBI_OK : start_all(n, err);
}

static tobi_status record(one_nest *o, tobi_run *run, const char *dir, int how, tobi_error *err)
{
    const tobi_output_def *output = tobi_scene_output_def(o->scene);
    if (how == TOBI_NESTS_RESUME) TOBI_TRY(tobi_run_resume(o->world, output, dir, &o->run, err));
    else {
        char *text = tobi_scene_resolved(o->scene);
        if (!text) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a nest");
        const tobi_status status =
            tobi_run_create(o->world, output, dir, how == TOBI_NESTS_REPLACE, text, &o->run, err);
        free(text);
        TOBI_TRY(status);
    }
    return tobi_run_add_nest(run, o->run, err);
}

tobi_status tobi_nests_estimate(tobi_nests *n, double end, tobi_run_size *size, tobi_error *err)
{
    TOBI_NEED(size, "where the size goes");
    for (int k = 0; k < tobi_nests_count(n); k++) {
        tobi_run_size one;
        TOBI_TRY(tobi_run_estimate(n->at[k].world, tobi_scene_output_def(n->at[k].scene), end, &one, err));
        size->files += one.files;
        size->bytes += one.bytes;
        size->memory += one.memory;
    }
    return TOBI_OK;
}

tobi_status tobi_nests_record(tobi_nests *n, tobi_run *run, const char *dir, int how, tobi_error *err)
{
    TOBI_NEED(run, "run");
    TOBI_NEED(dir, "the directory");
    for (int k = 0; k < tobi_nests_count(n); k++) {
        char *path = folder_of(&n->at[k], dir);
        if (!path) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a nest");
        const tobi_status status = record(&n->at[k], run, path, how, err);
        free(path);
        TOBI_TRY(status);
    }
    return TOBI_OK;
}

void tobi_nests_close(tobi_nests *n)
{
    for (int k = 0; k < tobi_nests_count(n); k++) {
        tobi_run_free(n->at[k].run);
        n->at[k].run = NULL;
    }
}

void tobi_nests_free(tobi_nests *n)
{
    tobi_nests_close(n);
    for (int k = 0; k < tobi_nests_count(n); k++) {
        tobi_world_destroy(n->at[k].world);
        tobi_scene_free(n->at[k].scene);
        free(n->at[k].body);
    }
    free(n);
}
