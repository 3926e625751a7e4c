/* Translating the objects of a Taichi scene: blocks of water, blocks and meshes of bodies, the fish. */
#define _GNU_SOURCE 1
#include "base/language.h"
#include "scene/import/import.h"
#include "scene/import/tank.h"
#include "tobiuo/scene.h"
#include "geom/mesh.h"
#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const tobi_place root = { 0 };


/* The entries of a section; NULL if it is not there, and if it is no list or holds more than a world takes,
   which is told. */
static json_t *open_section(tobi_import *im, const tobi_old_section *section)
{
    tobi_place place = { &root, section->name, 0 };
    json_t *list = json_object_get(im->source->root, section->name);
    const int most = section == &tobi_old_fluid_block ? TOBI_FLUID_LIMIT*TOBI_FILL_LIMIT : TOBI_BODY_LIMIT;
    if (list && json_array_size(list) > (size_t)most) {
        tobi_source_mistake(im->source, &place, "has %zu entries, allowed are %d", json_array_size(list),
                            most);
        return NULL;
    }
    if (!list || json_is_array(list)) return list;
    tobi_source_mistake(im->source, &place, "is %s, must be a list [ { ... } ]", tobi_json_kind(list));
    return NULL;
}

/* Corners of a block, as the old program placed its particles. */
static void set_box(tobi_import *im, json_t *object, const tobi_old_block *b)
{
    double low[3], high[3];
    for (int a = 0; a < 3; a++) {
        low[a] = b->start[a] + b->translation[a];
        high[a] = b->scale[a] == 1 ? b->end[a] + b->translation[a]
                                   : low[a] + b->scale[a]*(b->end[a] - b->start[a]);
    }
    json_t *box = tobi_import_set(im, object, "box", json_object());
    tobi_import_set(im, box, "min", tobi_import_vector(low));
    tobi_import_set(im, box, "max", tobi_import_vector(high));
}

/* --- water -------------------------------------------------------------------------------- */

/* Blocks that agree in density, colour and visibility are one fluid; a world carries few. */
static size_t find_fluid(tobi_import *im, json_t *fluids, json_t *like)
{
    static const char *const keys[] = { "density", "viscosity", "color", "visible" };
    for (size_t i = 0; i < json_array_size(fluids); i++) {
        int same = 1;
        for (size_t k = 0; k < sizeof keys/sizeof *keys; k++) {
            json_t *a = json_object_get(json_array_get(fluids, i), keys[k]);
            json_t *b = json_object_get(like, keys[k]);
            same &= (!a && !b) || (a && b && json_equal(a, b));
        }
        if (same) return i;
    }
    char name[32];
    snprintf(name, sizeof name, "fluid_%zu", json_array_size(fluids));
    tobi_import_set(im, like, "name", json_string(name));
    tobi_import_set(im, like, "fill", json_array());
    size_t index = json_array_size(fluids);
    im->no_memory |= json_array_append(fluids, like) != 0;
    return index;
}

static void add_fluid_block(tobi_import *im, json_t *fluids, json_t *object, const tobi_place *place)
{
    const tobi_old_section *section = &tobi_old_fluid_block;
    tobi_old_block b;
    uint64_t given = tobi_import_read_taichi(im, section, object, place, &b);
    double density = tobi_import_has(section, given, "density") ? b.density : im->config.density;
    json_t *fluid = json_object(), *fill = json_object();
    tobi_import_set(im, fluid, "density", tobi_import_real(density));
    tobi_import_set(im, fluid, "viscosity", tobi_import_real(im->config.viscosity*density));
    if (tobi_import_has(section, given, "color"))
        tobi_import_set(im, fluid, "color", tobi_import_vector(b.color));
    if (tobi_import_hides(im, b.object)) tobi_import_set(im, fluid, "visible", json_false());
    size_t index = find_fluid(im, fluids, fluid);
    json_t *fills = json_object_get(json_array_get(fluids, index), "fill");
    json_decref(fluid);
    set_box(im, fill, &b);
    tobi_import_set(im, fill, "velocity", tobi_import_vector(b.velocity));
    char native[2][64];
    snprintf(native[0], sizeof native[0], "fluids[%zu].fill[%zu]", index, json_array_size(fills));
    snprintf(native[1], sizeof native[1], "fluids[%zu]", index);
    im->no_memory |= json_array_append_new(fills, fill) != 0;
    tobi_import_note_taichi(im, section, object, place, native[0], native[1]);
}

void tobi_import_fluids(tobi_import *im)
{
    tobi_place place = { &root, tobi_old_fluid_block.name, 0 };
    json_t *list = open_section(im, &tobi_old_fluid_block), *object;
    json_t *fluids = tobi_import_set(im, im->native, "fluids", json_array());
    size_t i;
    if (!json_object_get(im->source->root, place.key) || (list && json_array_size(list) == 0))
        tobi_source_mistake(im->source, &place, "is missing or empty: a scene needs at least one block "
                            "of water, { \"start\": [..], \"end\": [..] }");
    json_array_foreach(list, i, object) {
        tobi_place entry = { &place, NULL, i };
        add_fluid_block(im, fluids, object, &entry);
    }
}

/* --- bodies ------------------------------------------------------------------------------- */

/* A body that the water moves is a free one. velocity: NULL if it is not given. */
static void set_free(tobi_import *im, json_t *body, const double *velocity, int fish, const tobi_place *place)
{
    tobi_place at = { place, "isDynamic", 0 };
    if (fish)
        tobi_source_mistake(im->source, &at,
                            "is true, but the keys from fishLength to pitchAngle say how the body swims; "
                            "false lets it swim, and without those keys the water moves it");
    tobi_import_set(im, body, "dynamics", json_string("free"));
    if (velocity) tobi_import_set(im, body, "velocity", tobi_import_vector(velocity));
}

/* After the rows about the body were added. */
static void tell_free(tobi_import *im, int has_density, int has_velocity)
{
    tobi_import_remark(im, "isDynamic", "moved by gravity, the water and what it touches: there "
                       "restitution is 0 and friction_coefficient 0.5, unless the scene gives others%s",
                       has_density ? "" : tr("; its density is not given, 1000 kg/m3 is taken"));
    if (has_velocity) tobi_import_remark(im, "velocity", "of the centre of mass at the start");
}

static int is_taken(const json_t *list, const char *name)
{
    size_t i;
    json_t *entry;
    json_array_foreach(list, i, entry) {
        const char *other = json_string_value(json_object_get(entry, "name"));
        if (other && strcmp(other, name) == 0) return 1;
    }
    return 0;
}

void tobi_import_name(tobi_import *im, const json_t *list, const json_t *others, json_t *entry,
                      const char *stem, size_t length)
{
    char clean[54], name[80];                           /* room for a number within 63 bytes */
    if (length > sizeof clean - 1) {
        length = sizeof clean - 1;
        while ((stem[length] & 0xC0) == 0x80) length--;     /* whole characters of UTF-8 */
    }
    for (size_t i = 0; i < length; i++) {
        const unsigned char c = (unsigned char)stem[i];
        clean[i] = c >= 0x80 || isalnum(c) || (i > 0 && c == '-') ? stem[i] : '_';
    }
    clean[length] = '\0';
    if (!length) strcpy(clean, "body");
    snprintf(name, sizeof name, "%s", clean);
    for (int i = 2; is_taken(list, name) || is_taken(others, name) || strncmp(name, "fluid_", 6) == 0; i++)
        snprintf(name, sizeof name, "%s%s_%d", strncmp(clean, "fluid_", 6) == 0 ? "body_" : "", clean, i);
    tobi_import_set(im, entry, "name", json_string(name));
}

/* What blocks and meshes have in common; NULL: not given. */
static void set_looks(tobi_import *im, json_t *body, const double *density, const double *color, int object)
{
    double radius = im->config.radius_rigid;
    if (density) tobi_import_set(im, body, "density", tobi_import_real(*density));
    if (color) tobi_import_set(im, body, "color", tobi_import_vector(color));
    if (tobi_import_hides(im, object)) tobi_import_set(im, body, "visible", json_false());
    if (radius > 0) tobi_import_set(im, body, "spacing", tobi_import_real(2*radius));
}

static void add_rigid_block(tobi_import *im, json_t *bodies, json_t *object, const tobi_place *place)
{
    const tobi_old_section *section = &tobi_old_rigid_block;
    tobi_old_block b;
    uint64_t given = tobi_import_read_taichi(im, section, object, place, &b);
    char name[32], native[64];
    json_t *body = json_object();
    int has_velocity = tobi_import_has(section, given, "velocity");
    int has_density = tobi_import_has(section, given, "density");
    if (b.dynamic) set_free(im, body, has_velocity ? b.velocity : NULL, 0, place);
    snprintf(name, sizeof name, "block_%d", b.object);
    tobi_import_name(im, bodies, NULL, body, name, strlen(name));
    set_box(im, body, &b);
    set_looks(im, body, has_density ? &b.density : NULL,
              tobi_import_has(section, given, "color") ? b.color : NULL, b.object);
    snprintf(native, sizeof native, "bodies[%zu]", json_array_size(bodies));
    im->no_memory |= json_array_append_new(bodies, body) != 0;
    tobi_import_note_taichi(im, section, object, place, native, "");
    if (b.dynamic) tell_free(im, has_density, has_velocity);
}

/* directory/path, absolute, if there is such a file. */
static char *existing_file(tobi_import *im, const char *directory, const char *path)
{
    char *joined = NULL, *found = NULL;
    int length = asprintf(&joined, "%s/%s", directory, path);
    int exists = length >= 0 && access(joined, F_OK) == 0;
    if (exists) found = realpath(joined, NULL);
    im->no_memory |= length < 0 || (exists && !found && errno == ENOMEM);
    if (length >= 0) free(joined);
    return found;
}

/* Beside the scene; where the program was started, as the old one did; in the folders above the scene, since
   old scenes lie in data/scenes and name data/models. NULL if it is nowhere. */
static char *find_mesh(tobi_import *im, const char *path)
{
    char above[PATH_MAX];
    if (path[0] == '/') {
        char *same = access(path, F_OK) == 0 ? strdup(path) : NULL;
        im->no_memory |= !same && errno == ENOMEM;
        return same;
    }
    char *found = existing_file(im, im->binder.directory, path), *slash;
    if (!found) found = existing_file(im, ".", path);
    snprintf(above, sizeof above, "%s", im->binder.directory);
    while (!found && (slash = strrchr(above, '/')) && slash > above) {
        *slash = '\0';
        found = existing_file(im, above, path);
    }
    return found;
}

char *tobi_import_find_mesh(tobi_import *im, const char *path)
{
    char *plain = tobi_tank_slashes(path), *found = plain ? find_mesh(im, plain) : NULL;
    im->no_memory |= !plain;
    free(plain);
    return found;
}

static int is_fish_key(const char *key)
{
    return strcmp(key, "fishLength") == 0 || strcmp(key, "fishWidth") == 0 || strcmp(key, "LEPos") == 0 ||
           strcmp(key, "wingspan") == 0 || strcmp(key, "wingchord") == 0 || strcmp(key, "waveLength") == 0 ||
           strcmp(key, "freq") == 0 || strcmp(key, "amplitude") == 0 || strcmp(key, "relax") == 0 ||
           strcmp(key, "startPosition") == 0 || strcmp(key, "swimmingPosition") == 0 ||
           strcmp(key, "pitchAngle") == 0;
}

/* 1 if the body is a fish; a fish that lacks some of its keys is told. */
static int check_fish(tobi_import *im, uint64_t given, const tobi_place *place)
{
    const tobi_old_section *section = &tobi_old_rigid_body;
    int fish = 0;
    for (const tobi_old_key *k = section->keys; k->param.key; k++)
        fish |= is_fish_key(k->param.key) && tobi_import_has(section, given, k->param.key);
    for (const tobi_old_key *k = section->keys; fish && k->param.key; k++) {
        tobi_place at = { place, k->param.key, 0 };
        if (is_fish_key(k->param.key) && !tobi_import_has(section, given, k->param.key))
            tobi_source_mistake(im->source, &at, "is missing: a swimming fish needs all of its keys, from "
                                "fishLength to pitchAngle");
    }
    return fish;
}

static void set_motion(tobi_import *im, json_t *body, const tobi_old_body *b, json_t *object,
                       const tobi_place *place)
{
    char *script = tobi_scene_shipped("flying_fish/motion.lua");
    json_t *motion = tobi_import_set(im, body, "motion", json_object());
    tobi_import_set(im, motion, "script", json_string(script ? script : ""));
    json_t *params = tobi_import_set(im, motion, "params", json_object());
    if (!script)
        tobi_source_mistake(im->source, place, "swims, but the program of its motion, "
                            "scenes/flying_fish/motion.lua, is not where Tobiuo was installed");
    tobi_import_set(im, params, "translation", tobi_import_vector(b->translation));
    for (const tobi_old_key *k = tobi_old_rigid_body.keys; k->param.key; k++) {
        json_t *value = json_object_get(object, k->param.key);      /* NULL: told by check_fish */
        if (value && is_fish_key(k->param.key)) tobi_import_set(im, params, k->param.key, json_incref(value));
    }
    tobi_import_set(im, params, "lagAngle", json_integer(72));      /* 0.8 of every point's angle */
    free(script);
}

static void mean_vertex(const tobi_mesh *mesh, double mean[3])
{
    memset(mean, 0, 3*sizeof *mean);
    for (int64_t i = 0; i < mesh->vertex_count; i++)
        for (int a = 0; a < 3; a++) mean[a] += mesh->vertices[i][a]/(double)mesh->vertex_count;
}

/* The old program turned a scaled mesh about the mean c of its vertices: x = R (v - c) + c + t. A native turn
   is about the origin, x = R v + t', so t' = t + c - R c. */
static void correct_turn(tobi_import *im, const tobi_old_body *b, const char *file, double translation[3],
                         const tobi_place *place)
{
    static const double none[3] = { 0, 0, 0 }, one[3] = { 1, 1, 1 };
    tobi_place at = { place, "geometryFile", 0 };
    tobi_mesh mesh = { 0 };
    tobi_error err = { 0 };
    double before[3], after[3];
    tobi_status status = tobi_mesh_read(file, &mesh, &err);
    if (status == TOBI_OK) status = tobi_mesh_transform(&mesh, b->scale, b->axis, 0, none, &err);
    if (status == TOBI_OK) mean_vertex(&mesh, before);
    if (status == TOBI_OK) status = tobi_mesh_transform(&mesh, one, b->axis, b->angle, none, &err);
    if (status == TOBI_OK) {
        mean_vertex(&mesh, after);
        for (int a = 0; a < 3; a++) translation[a] += before[a] - after[a];
    } else {
        tobi_source_mistake(im->source, &at, "%s", err.text);
    }
    tobi_mesh_free(&mesh);
}

/* The file of a body and, for a fish without one, the shipped fish; owned by the caller. */
static char *choose_mesh(tobi_import *im, const char *given, int fish, const char **remark)
{
    char *file = tobi_import_find_mesh(im, given);
    *remark = NULL;
    if (!file && !im->no_memory && fish && (file = tobi_scene_shipped(TOBI_STAND_IN)))
        *remark = TR("there is no such file, so the fish that comes with Tobiuo is taken: 0.2 m long, "
                     "0.2 m from tip to tip, as in the scene that these keys come from");
    return file;
}

static void fill_rigid_body(tobi_import *im, json_t *body, const tobi_old_body *b, uint64_t given,
                            const char *mesh)
{
    const tobi_old_section *section = &tobi_old_rigid_body;
    tobi_import_set(im, body, "mesh", json_string(mesh));
    tobi_import_set(im, body, "scale", tobi_import_vector(b->scale));
    if (b->angle != 0) {
        json_t *rotation = tobi_import_set(im, body, "rotation", json_object());
        tobi_import_set(im, rotation, "axis", tobi_import_vector(b->axis));
        tobi_import_set(im, rotation, "angle", tobi_import_real(b->angle));
    }
    set_looks(im, body, tobi_import_has(section, given, "density") ? &b->density : NULL,
              tobi_import_has(section, given, "color") ? b->color : NULL, b->object);
}

static void add_rigid_body(tobi_import *im, json_t *bodies, json_t *object, const tobi_place *place)
{
    const tobi_old_section *section = &tobi_old_rigid_body;
    tobi_old_body b;
    uint64_t given = tobi_import_read_taichi(im, section, object, place, &b);
    const char *path = json_string_value(json_object_get(object, "geometryFile")), *remark;
    if (!path || !path[0]) return;               /* told by its table, or empty: told below */
    int fish = check_fish(im, given, place);
    char *mesh = choose_mesh(im, path, fish, &remark), native[64];
    double translation[3];
    memcpy(translation, b.translation, sizeof translation);
    if (mesh && b.angle != 0) correct_turn(im, &b, mesh, translation, place);

    const char *slash = strpbrk(path, "/\\"), *stem = path;
    for (; slash; slash = strpbrk(stem, "/\\")) stem = slash + 1;
    const char *dot = strrchr(stem, '.');
    json_t *body = json_object();
    tobi_import_name(im, bodies, NULL, body, stem, dot ? (size_t)(dot - stem) : strlen(stem));
    fill_rigid_body(im, body, &b, given, mesh ? mesh : b.file ? b.file : path);
    tobi_import_set(im, body, "translation", tobi_import_vector(translation));
    const char *name = json_string_value(json_object_get(body, "name"));
    if (remark && name) tobi_import_set(im, im->stand_ins, name, json_string(path));
    if (fish) set_motion(im, body, &b, object, place);
    int has_velocity = tobi_import_has(section, given, "velocity");
    if (b.dynamic) set_free(im, body, has_velocity ? b.velocity : NULL, fish, place);
    snprintf(native, sizeof native, "bodies[%zu]", json_array_size(bodies));
    im->no_memory |= json_array_append_new(bodies, body) != 0;
    tobi_import_note_taichi(im, section, object, place, native, "");
    if (b.dynamic) tell_free(im, tobi_import_has(section, given, "density"), has_velocity);
    if (remark) tobi_import_remark(im, "geometryFile", "%s", tr(remark));
    if (fish) tobi_import_remark(im, "pitchAngle", "nose up. The wings fold by 72 degrees, as the old "
                                 "formula did; motion.params.lagAngle changes it");
    free(mesh);
}

void tobi_import_bodies(tobi_import *im)
{
    static const struct {
        const tobi_old_section *section;
        void (*add)(tobi_import *im, json_t *bodies, json_t *object, const tobi_place *place);
    } kinds[] = { { &tobi_old_rigid_body, add_rigid_body }, { &tobi_old_rigid_block, add_rigid_block } };
    json_t *bodies = tobi_import_set(im, im->native, "bodies", json_array());
    for (size_t k = 0; k < sizeof kinds/sizeof *kinds; k++) {
        tobi_place place = { &root, kinds[k].section->name, 0 };
        json_t *list = open_section(im, kinds[k].section), *object;
        size_t i;
        json_array_foreach(list, i, object) {
            tobi_place entry = { &place, NULL, i };
            kinds[k].add(im, bodies, object, &entry);
        }
    }
}
