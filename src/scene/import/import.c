/* Translating scenes of the Taichi program: what every key means, and the way from file to file. */
#define _GNU_SOURCE 1
#include "base/language.h"
#include "scene/import/import.h"
#include "tobiuo/scene.h"
#include "scene/write.h"
#include "base/param.h"
#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define K(name_) .param.key = name_
#define IN(type_, member_) .param.offset = offsetof(type_, member_)
#define REAL .param.type = TOBI_PARAM_REAL, .param.min = NAN, .param.max = NAN
#define FROM0 .param.type = TOBI_PARAM_REAL, .param.min = 0, .param.max = NAN
#define POSITIVE FROM0, .param.positive = true
#define VEC3 .param.type = TOBI_PARAM_VEC3, .param.min = NAN, .param.max = NAN
#define SCALE .param.type = TOBI_PARAM_VEC3, .param.min = 0, .param.max = NAN, .param.positive = true, \
    .param.def = { 1, 1, 1 }, .param.unit = "1"
#define COLOR .param.type = TOBI_PARAM_VEC3, .param.min = 0, .param.max = 255, .param.unit = "RGB"
#define INT(a, b) .param.type = TOBI_PARAM_INT, .param.min = (a), .param.max = (b), .param.unit = "1"
#define BOOL .param.type = TOBI_PARAM_BOOL, .param.min = 0, .param.max = 1, .param.unit = "1"
#define UNIT(u) .param.unit = (u)
#define DEF(v) .param.def = { v }
#define BECOMES(b) .becomes = (b)
#define SAY(text) .param.doc = (text)
#define NEEDED .param.required = true

#define C(m) IN(tobi_old_config, m)
#define RADIUS SAY("the spacing is two radii"), C(radius), POSITIVE, UNIT("m"), BECOMES("spacing")
#define RADIUS_RIGID SAY("two radii are the spacing of a body's own particles, which serve output: the " \
                         "water meets smooth surfaces"), \
    C(radius_rigid), POSITIVE, UNIT("m"), BECOMES("bodies[0].spacing")

static const tobi_old_key configuration_keys[] = {
    { K("domainStart"), C(domain_start), VEC3, UNIT("m"), BECOMES("domain.min"),
      SAY("any sign is allowed; the old program took it as 0") },
    { K("domainEnd"), C(domain_end), VEC3, UNIT("m"), BECOMES("domain.max"), NEEDED,
      SAY("upper corner of the box; its sides are slip walls, water may touch them") },
    { K("particleRadius"), RADIUS },
    { K("particleRadiusFluid"), RADIUS },
    { K("particleRadiusFLuid"), RADIUS },
    { K("particleRadiusRigid"), RADIUS_RIGID },
    { K("particleRadiusRigidRigid"), RADIUS_RIGID },
    { K("numberOfStepsPerRenderUpdate"), C(steps), INT(1, 1000000), DEF(1), BECOMES("output.interval"),
      .unit = "s", SAY("time steps between outputs, times timeStepSize") },
    { K("density0"), C(density), POSITIVE, DEF(1000), UNIT("kg/m3"), BECOMES("fluids[0].density"),
      SAY("rest density; that of a block goes before it"), .absent = "1000 kg/m3 is taken" },
    { K("simulationMethod"), C(method), INT(0, 100), DEF(4), BECOMES("method"), .unit = "1",
      SAY("0 is WCSPH, 4 is DFSPH"), .absent = "DFSPH is taken" },
    { K("gravitation"), C(gravitation), VEC3, UNIT("m/s2"), BECOMES("gravity"), NEEDED,
      SAY("gravity, [0, -9.81, 0] where y is up, [0, 0, -9.81] where z is up") },
    { K("timeStepSize"), C(time_step), POSITIVE, UNIT("s"), BECOMES("time_step"),
      SAY("a fixed step, as before; --set time_step=adaptive chooses each step by itself and takes fewer"),
      .absent = "the step is adaptive" },
    { K("stiffness"), C(stiffness), POSITIVE, UNIT("Pa"), BECOMES("wcsph.stiffness"),
      SAY("of the Tait equation of WCSPH; DFSPH has no use for it") },
    { K("exponent"), C(exponent), POSITIVE, UNIT("1"), BECOMES("wcsph.exponent"),
      SAY("of the Tait equation of WCSPH; DFSPH has no use for it") },
    { K("boundaryHandlingMethod"), C(boundary), INT(-1000, 1000), SAY("never did anything") },
    { K("exportFrame"), C(frames), BOOL, BECOMES("output.frames"), SAY("a PNG picture at each output") },
    { K("exportPly"), C(ply), BOOL, BECOMES("output.ply"), SAY("positions of the water at each output") },
    { K("exportObj"), C(obj), BOOL, BECOMES("output.obj"), SAY("surfaces of the bodies at each output") },
    { K("simulationTime"), C(time), POSITIVE, UNIT("s"), BECOMES("end_time"), SAY("where the run ends"),
      .absent = "the old program ran until its window was closed; 5 s are taken" },
    { K("simEndFrame"), C(end_frame), INT(1, 1000000000), BECOMES("end_time"), .unit = "s",
      SAY("the number of the last output, times the time between outputs") },
    { K("viscosity"), C(viscosity), FROM0, DEF(0.01), UNIT("m2/s"), BECOMES("fluids[0].viscosity"),
      .unit = "Pa s", SAY("kinematic in the old program"),
      .absent = "0.01 m2/s stood in the old program itself: 10000 times water, which has 1e-6 m2/s; "
                "for water, set fluids[0].viscosity to 0.001 Pa s" },
    { K("surface_tension"), C(tension), REAL, UNIT("m3/s2"),
      SAY("kappa of Becker and Teschner (2007), not N/m: a pull between particles that changes with their "
          "size. Now fluids[].surface_tension is in N/m: 0.0728 for water, with a support of 2.5 or more") },
    { K("cameraPosition"), C(camera_position), VEC3, UNIT("m"), BECOMES("output.camera.position"),
      SAY("where the pictures are taken from") },
    { K("cameraLookat"), C(camera_look_at), VEC3, UNIT("m"), BECOMES("output.camera.look_at"),
      SAY("the point in the middle of the pictures") },
    { K("cameraFov"), C(camera_angle), .param.type = TOBI_PARAM_REAL, .param.min = 1, .param.max = 150,
      DEF(45), UNIT("degrees"), BECOMES("output.camera.angle"), SAY("vertical field of view") },
    { K("invisibleObjects"), SAY("the objects with these numbers are left out of pictures") },
    { .param.key = NULL }
};

#define B(m) IN(tobi_old_block, m)
#define BLOCK_KEYS \
    { K("start"), B(start), VEC3, UNIT("m"), NEEDED, BECOMES(".box.min"), SAY("plus translation") }, \
    { K("end"), B(end), VEC3, UNIT("m"), NEEDED, BECOMES(".box.max"), \
      SAY("start + translation + scale (end - start); may touch the walls") }, \
    { K("translation"), B(translation), VEC3, UNIT("m"), SAY("added to both corners") }, \
    { K("scale"), B(scale), SCALE, SAY("size factor about the start") }

static const tobi_old_key fluid_block_keys[] = {
    { K("objectId"), B(object), INT(0, 1000000), BECOMES("^name"), SAY("a number became a name") },
    BLOCK_KEYS,
    { K("velocity"), B(velocity), VEC3, UNIT("m/s"), BECOMES(".velocity"), SAY("at the start") },
    { K("density"), B(density), POSITIVE, UNIT("kg/m3"), BECOMES("^density"),
      SAY("goes before density0; in the old program only viscosity and tension knew it") },
    { K("color"), B(color), COLOR, BECOMES("^color"), SAY("in pictures; \"speed\" shows how fast it is") },
    { .param.key = NULL }
};

/* Of bodies that are not dynamic; the remarks about others are in objects.c. */
static const char *const dynamic_remark = TR("fixed, or moved by its motion");
static const char *const still_remark = TR("a body that is not dynamic never moved by it, and does not now");

static const tobi_old_key rigid_block_keys[] = {
    { K("objectId"), B(object), INT(0, 1000000), BECOMES(".name"), SAY("a number became a name") },
    BLOCK_KEYS,
    { K("velocity"), B(velocity), VEC3, UNIT("m/s"), BECOMES(".velocity"), .param.doc = still_remark },
    { K("density"), B(density), POSITIVE, UNIT("kg/m3"), BECOMES(".density"), SAY("for mass and inertia") },
    { K("color"), B(color), COLOR, BECOMES(".color"), SAY("in pictures") },
    { K("isDynamic"), B(dynamic), BOOL, BECOMES(".dynamics"), .param.doc = dynamic_remark },
    { .param.key = NULL }
};

#define R(m) IN(tobi_old_body, m)
#define FISH(name_, member_, unit_, text_) \
    { K(name_), R(member_), REAL, UNIT(unit_), BECOMES(".motion.params." name_), SAY(text_) }
#define FISH3(name_, member_, text_) \
    { K(name_), R(member_), VEC3, UNIT("m"), BECOMES(".motion.params." name_), SAY(text_) }

static const tobi_old_key rigid_body_keys[] = {
    { K("objectId"), R(object), INT(0, 1000000), SAY("bodies go by name; their order is kept") },
    { K("geometryFile"), R(file), .param.type = TOBI_PARAM_TEXT, UNIT("path"), NEEDED, BECOMES(".mesh"),
      SAY("looked up beside the scene, then in the working directory, then in the folders above the scene") },
    { K("translation"), R(translation), VEC3, UNIT("m"), BECOMES(".translation"), SAY("applied last") },
    { K("rotationAxis"), R(axis), VEC3, UNIT("1"), .param.def = { 0, 0, 1 }, BECOMES(".rotation.axis"),
      SAY("direction of the axis") },
    { K("rotationAngle"), R(angle), REAL, UNIT("degrees"), BECOMES(".rotation.angle"),
      SAY("about the mean of the vertices, as before: the translation is corrected, since a native turn is "
          "about the mesh's origin") },
    { K("scale"), R(scale), SCALE, BECOMES(".scale"), SAY("applied first") },
    { K("velocity"), R(velocity), VEC3, UNIT("m/s"), BECOMES(".velocity"), .param.doc = still_remark },
    { K("density"), R(density), POSITIVE, UNIT("kg/m3"), BECOMES(".density"), SAY("for mass and inertia") },
    { K("color"), R(color), COLOR, BECOMES(".color"), SAY("in pictures") },
    { K("isDynamic"), R(dynamic), BOOL, BECOMES(".dynamics"), .param.doc = dynamic_remark },
    FISH("fishLength", length, "m", "of the fish"),
    FISH("fishWidth", width, "m", "of the fish's body"),
    FISH("LEPos", lead, "m", "leading edge of the wings, ahead of the middle of the fish"),
    FISH("wingspan", wingspan, "m", "from tip to tip"),
    FISH("wingchord", wingchord, "m", "of the wings"),
    FISH("waveLength", wave_length, "m", "of the tail beat"),
    FISH("freq", freq, "Hz", "of the tail beat"),
    FISH("amplitude", amplitude, "m", "of the tail beat"),
    FISH("relax", relax, "s", "time to get into position"),
    FISH3("startPosition", start, "where it begins to swim"),
    FISH3("swimmingPosition", swim, "where it taxis"),
    FISH("pitchAngle", pitch, "degrees", "nose up"),
    { .param.key = NULL }
};

const tobi_old_section tobi_old_configuration = { "Configuration", configuration_keys,
                                                  sizeof(tobi_old_config) };
const tobi_old_section tobi_old_fluid_block = { "FluidBlocks", fluid_block_keys, sizeof(tobi_old_block) };
const tobi_old_section tobi_old_rigid_block = { "RigidBlocks", rigid_block_keys, sizeof(tobi_old_block) };
const tobi_old_section tobi_old_rigid_body = { "RigidBodies", rigid_body_keys, sizeof(tobi_old_body) };

/* Parts of the program's later versions that have no counterpart. */
static const struct { const char *key, *what; } refused[] = {
    { "Emitters", "emitters, which add fluid during a run, are not built yet" },
    { "FluidBodies", "water in the shape of a mesh is not translated; write a native scene, where "
                     "fluids[].fill[].mesh does it" },
};

int tobi_import_applies(const json_t *root) { return json_object_get(root, "Configuration") != NULL; }

uint64_t tobi_import_read(tobi_import *im, const tobi_old_section *section, json_t *object,
                          const tobi_place *place, void *def)
{
    enum { ROOM = 64 };
    tobi_param rows[ROOM] = { 0 };
    const char *also[4] = { NULL };
    int count = 0, others = 0;
    uint64_t given = 0;
    for (const tobi_old_key *k = section->keys; k->param.key; k++) {
        if (k->param.unit && count < ROOM - 1) rows[count++] = k->param;
        else if (others < 3) also[others++] = k->param.key;
    }
    tobi_param_table table = { section->name, section->name, section->size, rows };
    tobi_param_defaults(&table, def);
    tobi_bind(&im->binder, &table, object, place, also, def);
    for (int i = 0; section->keys[i].param.key; i++)
        if (json_object_get(object, section->keys[i].param.key)) given |= UINT64_C(1) << i;
    return given;
}

json_t *tobi_import_take_known(tobi_import *im, const tobi_old_section *section, json_t *object, int lists)
{
    if (object && !json_is_object(object)) return json_incref(object);
    json_t *known = json_object();
    for (const tobi_old_key *k = section->keys; k->param.key; k++) {
        json_t *value = json_object_get(object, k->param.key);
        if (value && (lists || k->param.unit)) tobi_import_set(im, known, k->param.key, json_incref(value));
    }
    return known;
}

uint64_t tobi_import_read_taichi(tobi_import *im, const tobi_old_section *section, json_t *object,
                                 const tobi_place *place, void *def)
{
    json_t *known = tobi_import_take_known(im, section, object, 1);
    const uint64_t given = known ? tobi_import_read(im, section, known, place, def) : 0;
    im->no_memory |= !known;
    json_decref(known);
    return given;
}

void tobi_import_note_taichi(tobi_import *im, const tobi_old_section *section, json_t *object,
                             const tobi_place *place, const char *entry, const char *fluid)
{
    static const tobi_old_others others = { NULL, TR("not known: the Taichi program passes over it") };
    tobi_import_note(im, section, object, place, entry, fluid);
    tobi_import_note_others(im, section, object, place, place, &others);
}

int tobi_import_has(const tobi_old_section *section, uint64_t given, const char *key)
{
    for (int i = 0; section->keys[i].param.key; i++)
        if (strcmp(section->keys[i].param.key, key) == 0) return given >> i & 1;
    return 0;
}

json_t *tobi_import_set(tobi_import *im, json_t *object, const char *key, json_t *value)
{
    int failed = !value || json_object_set_new(object, key, value) != 0;
    im->no_memory |= failed;
    return failed ? NULL : value;
}

/* Overflow of absurd numbers must reach the checks as a number. */
static double bounded(double v) { return isnan(v) ? 0 : fmax(-DBL_MAX, fmin(v, DBL_MAX)); }

json_t *tobi_import_real(double v) { return json_real(bounded(v)); }

json_t *tobi_import_vector(const double v[3])
{
    return json_pack("[fff]", bounded(v[0]), bounded(v[1]), bounded(v[2]));
}

/* --- the configuration ------------------------------------------------------------------- */


static const tobi_place root = { 0 };
static const tobi_place configuration = { &root, "Configuration", 0 };

static int gives(const tobi_import *im, const char *key)
{
    return tobi_import_has(&tobi_old_configuration, im->given, key);
}

/* Several spellings are known of each radius; two of them at once would leave one unheard. */
static void check_radii(tobi_import *im)
{
    static const char *const names[][3] = {
        { "particleRadius", "particleRadiusFluid", "particleRadiusFLuid" },
        { "particleRadiusRigid", "particleRadiusRigidRigid", NULL },
    };
    for (int group = 0; group < 2; group++) {
        const char *first = NULL;
        for (int i = 0; i < 3 && names[group][i]; i++) {
            tobi_place place = { &configuration, names[group][i], 0 };
            if (!gives(im, names[group][i])) continue;
            if (first)
                tobi_source_mistake(im->source, &place, "says the same as %s; give one of them", first);
            first = names[group][i];
        }
        tobi_place place = { &configuration, names[0][0], 0 };
        if (!first && group == 0)
            tobi_source_mistake(im->source, &place,
                                "is missing (greater than 0 m): half the distance between particles");
    }
}

static void check_hidden(tobi_import *im, json_t *old)
{
    tobi_place place = { &configuration, "invisibleObjects", 0 };
    json_t *list = json_object_get(old, "invisibleObjects"), *entry;
    size_t i;
    if (list && !json_is_array(list))
        tobi_source_mistake(im->source, &place, "is %s, must be a list of objectId numbers",
                            tobi_json_kind(list));
    json_array_foreach(list, i, entry) {
        tobi_place at = { &place, NULL, i };
        if (!json_is_integer(entry))
            tobi_source_mistake(im->source, &at, "is %s, must be an objectId, a whole number",
                                tobi_json_kind(entry));
    }
}

int tobi_import_hides(const tobi_import *im, int object)
{
    json_t *list = json_object_get(json_object_get(im->source->root, "Configuration"),
                                   "invisibleObjects"), *entry;
    size_t i;
    json_array_foreach(list, i, entry)
        if (json_is_integer(entry) && json_integer_value(entry) == object) return 1;
    return 0;
}

/* What invisibleObjects became: fluids and bodies that are not visible. */
static void tell_hidden(tobi_import *im)
{
    static const char *const lists[] = { "fluids", "bodies" };
    json_t *entry;
    size_t i;
    char *text = NULL;
    for (int k = 0; k < 2; k++)
        json_array_foreach(json_object_get(im->native, lists[k]), i, entry) {
            char *longer = NULL;
            if (!json_is_false(json_object_get(entry, "visible"))) continue;
            if (asprintf(&longer, "%s%s%s[%zu].visible = false", text ? text : "", text ? ", " : "", lists[k],
                         i) < 0) {
                im->no_memory = 1;
                longer = NULL;
            }
            free(text);
            text = longer;
        }
    if (text) tobi_import_tell(im, "invisibleObjects", text);
    else if (gives(im, "invisibleObjects"))
        tobi_import_remark(im, "invisibleObjects", "no object has one of these numbers");
}

static const char *choose_method(tobi_import *im)
{
    tobi_place place = { &configuration, "simulationMethod", 0 };
    const char *method = im->config.method == 0 ? "wcsph" : "dfsph";
    if (im->config.method != 0 && im->config.method != 4)
        tobi_source_mistake(im->source, &place, "is %d; there are 0 (WCSPH) and 4 (DFSPH)",
                            im->config.method);
    return method;
}

static void build_output(tobi_import *im)
{
    const tobi_old_config *c = &im->config;
    json_t *output = tobi_import_set(im, im->native, "output", json_object());
    if (c->time_step > 0) tobi_import_set(im, output, "interval", tobi_import_real(c->steps*c->time_step));
    tobi_import_set(im, output, "frames", json_boolean(c->frames));
    tobi_import_set(im, output, "ply", json_boolean(c->ply));
    tobi_import_set(im, output, "obj", json_boolean(c->obj));
    if (gives(im, "cameraPosition")) {
        json_t *camera = tobi_import_set(im, output, "camera", json_object());
        double middle[3];
        for (int a = 0; a < 3; a++) middle[a] = 0.5*(c->domain_start[a] + c->domain_end[a]);
        tobi_import_set(im, camera, "position", tobi_import_vector(c->camera_position));
        tobi_import_set(im, camera, "look_at",
                        tobi_import_vector(gives(im, "cameraLookat") ? c->camera_look_at : middle));
        tobi_import_set(im, camera, "angle", tobi_import_real(c->camera_angle));
    }
}

static double end_time(const tobi_import *im)
{
    const tobi_old_config *c = &im->config;
    double interval = c->time_step > 0 ? c->steps*c->time_step : tobi_default_output_def().interval;
    if (gives(im, "simulationTime")) return c->time;
    return gives(im, "simEndFrame") ? c->end_frame*interval : 5;
}

static void build_configuration(tobi_import *im)
{
    const tobi_old_config *c = &im->config;
    json_t *native = im->native, *domain = tobi_import_set(im, native, "domain", json_object());
    const char *method = choose_method(im);
    tobi_import_set(im, native, "method", json_string(method));
    tobi_import_set(im, domain, "min", tobi_import_vector(c->domain_start));
    tobi_import_set(im, domain, "max", tobi_import_vector(c->domain_end));
    tobi_import_set(im, native, "gravity", tobi_import_vector(c->gravitation));
    tobi_import_set(im, native, "spacing", tobi_import_real(2*c->radius));
    tobi_import_set(im, native, "end_time", tobi_import_real(end_time(im)));
    if (c->time_step > 0) tobi_import_set(im, native, "time_step", tobi_import_real(c->time_step));
    if (c->method == 0 && (gives(im, "stiffness") || gives(im, "exponent"))) {
        json_t *tait = tobi_import_set(im, native, method, json_object());
        if (gives(im, "stiffness")) tobi_import_set(im, tait, "stiffness", tobi_import_real(c->stiffness));
        if (gives(im, "exponent")) tobi_import_set(im, tait, "exponent", tobi_import_real(c->exponent));
    }
}

static void read_configuration(tobi_import *im)
{
    json_t *old = json_object_get(im->source->root, "Configuration");
    im->given = tobi_import_read_taichi(im, &tobi_old_configuration, old, &configuration, &im->config);
    check_radii(im);
    check_hidden(im, old);
    build_configuration(im);
    tobi_import_note_taichi(im, &tobi_old_configuration, old, &configuration, "", "");
    if (gives(im, "viscosity"))
        tobi_import_remark(im, "viscosity", "kinematic in the old program, so times density; %.4g times "
                           "water, which has 1e-6 m2/s or 0.001 Pa s", im->config.viscosity/1e-6);
    if (gives(im, "cameraLookat") && !gives(im, "cameraPosition"))
        tobi_import_remark(im, "cameraLookat", "nothing without cameraPosition");
}

/* --- the whole ---------------------------------------------------------------------------- */

static void check_top(tobi_import *im)
{
    static const char *const known[] = { "Configuration", "FluidBlocks", "RigidBlocks", "RigidBodies" };
    enum { KNOWN = sizeof known/sizeof *known };
    const char *key;
    json_t *value;
    json_object_foreach(im->source->root, key, value) {
        tobi_place place = { &root, key, 0 };
        size_t i = 0;
        while (i < KNOWN && strcmp(known[i], key) != 0) i++;
        if (i < KNOWN || tobi_report_pass(im->source->report)) continue;
        for (i = 0; i < sizeof refused/sizeof *refused && strcmp(refused[i].key, key) != 0; i++) { }
        const char *near = tobi_suggest(key, known, KNOWN);
        if (i < sizeof refused/sizeof *refused)
            tobi_source_mistake_at_key(im->source, &place, "%s", refused[i].what);
        else if (near)
            tobi_source_mistake_at_key(im->source, &place, "unknown key; did you mean \"%s\"?", near);
        else
            tobi_source_mistake_at_key(im->source, &place,
                                       "unknown key; a scene of the Taichi program has Configuration, "
                                       "FluidBlocks, RigidBlocks and RigidBodies");
    }
}

tobi_status tobi_import_translate(tobi_source *source, tobi_texts *texts, const char *directory,
                                  char **table, json_t **stand_ins)
{
    tobi_import im = { .source = source, .binder = { source, texts, directory, 3 }, .closing =
        TR("The water has its whole mass: the old program placed 0.8 of it, and the level sank.\n"
           "Walls and bodies are slip, as they were; water starts where the scene says.\n") };
    *table = NULL;
    *stand_ins = im.stand_ins = json_object();
    im.native = json_object();
    int64_t before = tobi_report_total(source->report);
    check_top(&im);
    read_configuration(&im);
    tobi_import_fluids(&im);
    tobi_import_bodies(&im);
    tell_hidden(&im);
    build_output(&im);
    tobi_status status = tobi_report_total(source->report) > before ? TOBI_INVALID : TOBI_OK;
    if (im.no_memory || !im.native || !im.stand_ins) status = TOBI_NO_MEMORY;
    if (status == TOBI_OK) status = tobi_import_finish(&im, table);
    tobi_import_clear(&im);
    return status;
}
