/* Translating parameters.py of the program that cuts an apple (MLS-MPM on taichi_elements): what
   its numbers become in a native scene. Numbers that stood in the program itself are told below the
   table. */
#define _GNU_SOURCE 1
#include "base/language.h"
#include "scene/import/import.h"
#include "tobiuo/scene.h"
#include "geom/massprops.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define K(name_) .param.key = name_
#define IN(type_, member_) .param.offset = offsetof(type_, member_)
#define REAL .param.type = TOBI_PARAM_REAL, .param.min = NAN, .param.max = NAN
#define FROM0 .param.type = TOBI_PARAM_REAL, .param.min = 0, .param.max = NAN
#define POSITIVE FROM0, .param.positive = true
#define VEC3 .param.type = TOBI_PARAM_VEC3, .param.min = NAN, .param.max = NAN
#define INT(a, b) .param.type = TOBI_PARAM_INT, .param.min = (a), .param.max = (b), .param.unit = "1"
#define UNIT(u) .param.unit = (u)
#define BECOMES(b) .becomes = (b)
#define SAY(text) .param.doc = (text)
#define NEEDED .param.required = true

typedef struct cut_file {
    double time, size, gravity[3], dt, friction, air, restitution;
    int resolution, interval;
} cut_file;

typedef struct cut_object {
    const char *file;
    double translation[3], scale[3], mass, start_x[3], start_y[3];
} cut_object;

#define F(m) IN(cut_file, m)
static const tobi_old_key file_keys[] = {
    { K("SimulationTime"), F(time), POSITIVE, UNIT("s"), BECOMES("end_time"), NEEDED,
      SAY("where the run ends") },
    { K("CalculationSpace"), F(size), POSITIVE, UNIT("m"), BECOMES("domain.max"), NEEDED,
      SAY("a cube from 0; its sides stood 3 cells further inside, now they are the faces of the cube, "
          "without friction, and let go of what leaves them, as before") },
    { K("Resolution"), F(resolution), INT(8, 4096), BECOMES("spacing"), .unit = "m", NEEDED,
      SAY("cells along a side; two particles along each, 8 in a cell, as before, but on a lattice") },
    { K("gravity"), F(gravity), VEC3, UNIT("m/s2"), BECOMES("gravity"), NEEDED, SAY("the same") },
    { K("dt"), F(dt), POSITIVE, UNIT("s"), NEEDED,
      SAY("each step is chosen by the stiffness and the speed; --set time_step=.. fixes it") },
    { K("myu"), F(friction), FROM0, UNIT("1"), BECOMES("bodies[0].friction_coefficient"), NEEDED,
      SAY("Coulomb friction on the knife; there it could turn the sliding round, now it stops it at most") },
    { K("airresistance"), F(air), FROM0, UNIT("1/s"), BECOMES("bodies[0].air_resistance"), NEEDED,
      SAY("speeds of the knife decay like exp(-c t)") },
    { K("VTUinterval"), F(interval), INT(1, 1000000000), BECOMES("output.interval"), .unit = "s", NEEDED,
      SAY("steps between outputs, times dt") },
    { K("epsilon"), F(restitution), .param.type = TOBI_PARAM_REAL, .param.min = 0, .param.max = 1, UNIT("1"),
      BECOMES("bodies[0].restitution"), NEEDED, SAY("the same") },
    { K("apple") }, { K("knife") },
    { .param.key = NULL }
};

#define O(m) IN(cut_object, m)
#define COMMON() \
    { K("fileName"), O(file), .param.type = TOBI_PARAM_TEXT, UNIT("path"), NEEDED, BECOMES(".mesh"), \
      SAY("looked up beside the file, then in the working directory, then in the folders above") }, \
    { K("translation"), O(translation), VEC3, UNIT("m"), NEEDED, BECOMES(".translation"), \
      SAY("from CAD to the domain") }, \
    { K("scale"), O(scale), .param.type = TOBI_PARAM_VEC3, .param.min = 0, .param.max = NAN, \
      .param.positive = true, .param.def = { 1, 1, 1 }, UNIT("1"), BECOMES(".scale"), SAY("applied first") }

static const tobi_old_key apple_keys[] = {
    COMMON(),
    { K("mass"), O(mass), POSITIVE, UNIT("kg"), BECOMES("^mass"), NEEDED,
      SAY("of the whole apple; there every particle had the mass of a cell of water, 8 times too much") },
    { .param.key = NULL }
};

static const tobi_old_key knife_keys[] = {
    COMMON(),
    { K("COGx"), O(start_x), VEC3, UNIT("m"),
      SAY("only [0, 0, 0] is known; the centre of mass is that of the mesh") },
    { K("COGy"), O(start_y), VEC3, UNIT("m"), SAY("only [0, 0, 0] is known") },
    { K("mass"), O(mass), POSITIVE, UNIT("kg"), BECOMES(".mass"), NEEDED, SAY("the same") },
    { K("inertia"), SAY("was not used: the knife did not turn, and does not now (locked = turn)") },
    { .param.key = NULL }
};

static const tobi_old_section file_section = { "the file", file_keys, sizeof(cut_file) },
    apple_section = { "apple", apple_keys, sizeof(cut_object) },
    knife_section = { "knife", knife_keys, sizeof(cut_object) };

/* What the program itself said; kg, m, s. */
static const double stiffness = 1e6, poisson = 0.3, stop = 0.1, rate = 600, speed = 1, resistance = 250;

static const tobi_place root = { 0 };

static json_t *fill_object(tobi_import *im, json_t *to, const cut_object *o, const char *mesh)
{
    tobi_import_set(im, to, "mesh", json_string(mesh));
    tobi_import_set(im, to, "scale", tobi_import_vector(o->scale));
    tobi_import_set(im, to, "translation", tobi_import_vector(o->translation));
    return to;
}

static void build_file(tobi_import *im, const cut_file *f)
{
    static const char *const axes[] = { "x", "y", "z" };
    json_t *domain = tobi_import_set(im, im->native, "domain", json_object());
    json_t *walls = tobi_import_set(im, domain, "walls", json_object());
    json_t *output = tobi_import_set(im, im->native, "output", json_object());
    const double zero[3] = { 0 }, size[3] = { f->size, f->size, f->size };
    tobi_import_set(im, im->native, "method", json_string("mlsmpm"));
    tobi_import_set(im, domain, "min", tobi_import_vector(zero));
    tobi_import_set(im, domain, "max", tobi_import_vector(size));
    for (int a = 0; a < 3; a++) tobi_import_set(im, walls, axes[a], json_string("separate"));
    tobi_import_set(im, im->native, "gravity", tobi_import_vector(f->gravity));
    tobi_import_set(im, im->native, "spacing", tobi_import_real(0.5*f->size/f->resolution));
    tobi_import_set(im, im->native, "end_time", tobi_import_real(f->time));
    tobi_import_set(im, output, "interval", tobi_import_real(f->interval*f->dt));
}

static void build_apple(tobi_import *im, const cut_object *apple, const char *mesh)
{
    json_t *solids = tobi_import_set(im, im->native, "solids", json_array()), *solid = json_object();
    tobi_import_set(im, solid, "name", json_string("apple"));
    tobi_import_set(im, solid, "model", json_string("corotated"));
    tobi_import_set(im, solid, "mass", tobi_import_real(apple->mass));
    tobi_import_set(im, solid, "youngs_modulus", tobi_import_real(stiffness));
    tobi_import_set(im, solid, "poissons_ratio", tobi_import_real(poisson));
    json_t *fills = tobi_import_set(im, solid, "fill", json_array());
    im->no_memory |= json_array_append_new(fills, fill_object(im, json_object(), apple, mesh)) != 0;
    im->no_memory |= json_array_append_new(solids, solid) != 0;
}

/* How far above the mesh's origin its centre of mass lies, m: the program's height was that of the
   origin. */
static double find_centre(tobi_import *im, const cut_object *knife, const char *file, const tobi_place *place)
{
    static const double none[3] = { 0, 0, 0 }, up[3] = { 0, 0, 1 };
    tobi_place at = { place, "fileName", 0 };
    tobi_mesh mesh = { 0 };
    tobi_massprops props = { 0 };
    tobi_error err = { 0 };
    tobi_status status = tobi_mesh_read(file, &mesh, &err);
    if (status == TOBI_OK) status = tobi_mesh_transform(&mesh, knife->scale, up, 0, none, &err);
    if (status == TOBI_OK) status = tobi_mesh_orient(&mesh, file, &err);
    if (status == TOBI_OK) status = tobi_massprops_volume(&mesh, &props, &err);
    if (status != TOBI_OK) tobi_source_mistake(im->source, &at, "%s", err.text);
    tobi_mesh_free(&mesh);
    return props.centre[2];
}

static void build_control(tobi_import *im, json_t *body, double centre)
{
    char *script = tobi_scene_shipped("apple_cut_seed/control.lua");
    json_t *control = tobi_import_set(im, body, "control", json_object());
    tobi_import_set(im, control, "script", json_string(script ? script : ""));
    json_t *params = tobi_import_set(im, control, "params", json_object());
    tobi_import_set(im, params, "rate", tobi_import_real(rate));
    tobi_import_set(im, params, "stop", tobi_import_real(stop + centre));
    tobi_import_set(im, params, "slide", tobi_import_real(0.1));
    tobi_import_set(im, params, "speed", tobi_import_real(speed));
    if (!script)
        tobi_source_mistake(im->source, &root, "the program of the knife, scenes/apple_cut_seed/control.lua, "
                            "is not where Tobiuo was installed");
    free(script);
}

static void build_knife(tobi_import *im, const cut_file *f, const cut_object *knife, const char *mesh,
                        double centre)
{
    json_t *bodies = tobi_import_set(im, im->native, "bodies", json_array()), *body = json_object();
    tobi_import_set(im, body, "name", json_string("knife"));
    fill_object(im, body, knife, mesh);
    tobi_import_set(im, body, "dynamics", json_string("controlled"));
    tobi_import_set(im, body, "mass", tobi_import_real(knife->mass));
    tobi_import_set(im, body, "locked", json_string("turn"));
    tobi_import_set(im, body, "friction_coefficient", tobi_import_real(f->friction));
    tobi_import_set(im, body, "restitution", tobi_import_real(f->restitution));
    tobi_import_set(im, body, "air_resistance", tobi_import_real(f->air));
    tobi_import_set(im, body, "blade", json_true());
    tobi_import_set(im, body, "edge_resistance", tobi_import_real(resistance));
    build_control(im, body, centre);
    im->no_memory |= json_array_append_new(bodies, body) != 0;
}

/* Reads apple or knife; *mesh: the file found, or the name as given. Owned by the caller. */
static json_t *read_object(tobi_import *im, const tobi_old_section *section, const tobi_place *place,
                           cut_object *o, char **mesh)
{
    json_t *object = json_object_get(im->source->root, section->name);
    *o = (cut_object){ .scale = { 1, 1, 1 } };
    *mesh = NULL;
    if (!object) {
        tobi_source_mistake(im->source, place, "is missing: a dict with fileName, translation and mass");
        return NULL;
    }
    tobi_import_read(im, section, object, place, o);
    const char *file = json_string_value(json_object_get(object, "fileName"));
    if (file && file[0]) *mesh = tobi_import_find_mesh(im, file);
    if (file && !*mesh) {
        tobi_place at = { place, "fileName", 0 };
        tobi_source_mistake(im->source, &at, "cannot find the mesh \"%s\"", file);
    }
    return object;
}

static void check_start(tobi_import *im, const tobi_place *place, const char *key, const double at[3])
{
    tobi_place where = { place, key, 0 };
    if (at[0] != 0 || at[1] != 0 || at[2] != 0)
        tobi_source_mistake(im->source, &where,
                            "is [%g, %g, %g]; only [0, 0, 0] is known, translation places the knife", at[0],
                            at[1], at[2]);
}

static void note(tobi_import *im, json_t *apple, json_t *knife, const tobi_place places[2])
{
    json_t *plain = json_copy(im->source->root);
    json_object_del(plain, "apple");
    json_object_del(plain, "knife");
    tobi_import_note(im, &file_section, plain, &root, "", "");
    tobi_import_note(im, &apple_section, apple, &places[0], "solids[0].fill[0]", "solids[0]");
    tobi_import_note(im, &knife_section, knife, &places[1], "bodies[0]", "");
    json_decref(plain);
}

static const char closing[] = TR(
    "Not in the file but in the program: Young's modulus 1e6 Pa, Poisson's ratio 0.3, the corotated model\n"
    "(solids[0]). There the stiffness was taken times 0.3, in some versions times the size of the box, and\n"
    "stress and mass were 8 times too large: set solids[0].youngs_modulus to what the apple has, 3e6 Pa.\n"
    "The knife presses down with 600 N/s times the time until its origin is at z = 0.1 m, then slides\n"
    "along -y with a tenth of that force up to 1 m/s (bodies[0].control), as far as the side of the domain.\n"
    "bodies[0].edge_resistance = 250 J/m2 is that of apple: there was none, the apple parted where the\n"
    "grid failed.\n");

tobi_status tobi_import_translate_cut(tobi_source *source, tobi_texts *texts, const char *directory,
                                      char **table)
{
    tobi_import im = { .source = source, .binder = { source, texts, directory, 3 }, .closing = closing };
    const tobi_place places[2] = { { &root, "apple", 0 }, { &root, "knife", 0 } };
    char *meshes[2];
    cut_object apple, knife;
    cut_file file;
    double centre = 0;
    *table = NULL;
    im.native = json_object();
    int64_t before = tobi_report_total(source->report);
    tobi_import_read(&im, &file_section, source->root, &root, &file);
    json_t *apple_object = read_object(&im, &apple_section, &places[0], &apple, &meshes[0]);
    json_t *knife_object = read_object(&im, &knife_section, &places[1], &knife, &meshes[1]);
    check_start(&im, &places[1], "COGx", knife.start_x);
    check_start(&im, &places[1], "COGy", knife.start_y);
    if (meshes[1]) centre = find_centre(&im, &knife, meshes[1], &places[1]);
    tobi_status status = tobi_report_total(source->report) > before ? TOBI_INVALID : TOBI_OK;
    if (status == TOBI_OK) {
        build_file(&im, &file);
        build_apple(&im, &apple, meshes[0]);
        build_knife(&im, &file, &knife, meshes[1], centre);
        note(&im, apple_object, knife_object, places);
        status = tobi_report_total(source->report) > before ? TOBI_INVALID : TOBI_OK;
    }
    if (im.no_memory || !im.native) status = TOBI_NO_MEMORY;
    if (status == TOBI_OK) status = tobi_import_finish(&im, table);
    tobi_import_clear(&im);
    free(meshes[0]);
    free(meshes[1]);
    return status;
}
