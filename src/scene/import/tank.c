/* Translating a setting of the tank program: setting.json and the object files that it names become a native
   scene. The first object is the tank; where its hollow is a box, the domain is that box, or else the tank is
   a body in the box around all meshes. Drawback: each mesh is read here and once more by the world. */
#define _GNU_SOURCE 1
#include "base/language.h"
#include "scene/import/tank.h"
#include "base/plain.h"
#include "tobiuo/scene.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What the program itself said; kg, m, s. */
static const double density = 998.21, viscosity = 0.001307, gravity = 9.82;
static const double head_room = 0.5;        /* of the air above, in heights of the tank */
enum { STEPS_PER_OUTPUT = 10, OUTPUTS = 1000 };

typedef struct tank {
    tobi_import im;
    tobi_tank_setting setting;
    uint64_t given;
    const char *directory;
    double low[3], high[3];          /* of the domain, without the air above */
    int has_box, closed;
    int cavity;                      /* 1: the domain is the hollow of the first object */
    json_t *fluids, *bodies, *probes, *paths;      /* paths: of the objects' files */
    struct object *objects;          /* object_count, in the order of input_files */
    size_t object_count;
} tank;

/* One object's file while it is read. */
typedef struct object {
    tobi_source source;              /* without a root: the file is none, which is told */
    tobi_tank_object def;
    uint64_t given;
    size_t index;                    /* in input_files */
    const char *name;                /* of the file, borrowed */
    char *stem;                      /* of its name */
    const char *objfile;
} object;

static const tobi_old_others others = { tobi_tank_passed_over,
                                        TR("not known: the tank program passes over it") };
static const tobi_place root = { 0 };
static const tobi_place files = { &root, "input_files", 0 }, longest_step = { &root, "max_dt", 0 };

int tobi_import_tank_applies(const json_t *json) { return json_object_get(json, "input_files") != NULL; }

/* --- the setting --------------------------------------------------------------------------- */

static double end_time(const tank *t)
{
    const double steps = t->setting.end_step*t->setting.max_dt;
    return steps > 0 && steps < t->setting.end_time ? steps : t->setting.end_time;
}

static double output_interval(const tank *t)
{
    return fmax(STEPS_PER_OUTPUT*t->setting.max_dt, end_time(t)/OUTPUTS);
}

static void read_setting(tank *t)
{
    tobi_import *im = &t->im;
    const tobi_old_section *section = &tobi_tank_setting_section;
    json_t *json = im->source->root, *bound = tobi_import_take_known(im, section, json, 0);
    t->given = tobi_import_read(im, section, bound, &root, &t->setting);
    json_decref(bound);
    tobi_import_note(im, section, json, &root, "", "");
    tobi_import_note_others(im, section, json, &root, &root, &others);
    if (t->setting.end_step > 0 && end_time(t) < t->setting.end_time) {
        tobi_import_remark(im, "end_time_step", "the run ends after so many steps of max_dt, as before: "
                           "that is sooner than end_time");
        tobi_import_remark(im, "end_time", "end_time_step ends the run sooner");
    }
}

static void build_setting(tank *t)
{
    tobi_import *im = &t->im;
    json_t *native = im->native;
    const double down[3] = { 0, 0, -gravity };
    tobi_import_set(im, native, "method", json_string("isph"));
    if (tobi_import_has(&tobi_tank_setting_section, t->given, "CSML")) {
        json_t *isph = tobi_import_set(im, native, "isph", json_object());
        tobi_import_set(im, isph, "support", tobi_import_real(t->setting.support));
    }
    json_t *domain = tobi_import_set(im, native, "domain", json_object());
    double high[3] = { t->high[0], t->high[1], t->high[2] };
    if (!t->closed) high[2] = round(1e9*(high[2] + head_room*(t->high[2] - t->low[2])))/1e9;
    tobi_import_set(im, domain, "min", tobi_import_vector(t->low));
    tobi_import_set(im, domain, "max", tobi_import_vector(high));
    tobi_import_set(im, native, "gravity", tobi_import_vector(down));
    tobi_import_set(im, native, "spacing", tobi_import_real(t->setting.spacing));
    tobi_import_set(im, native, "time_step_max", tobi_import_real(t->setting.max_dt));
    tobi_import_set(im, native, "end_time", tobi_import_real(end_time(t)));
    tobi_import_set(im, native, "fluids", json_incref(t->fluids));
    tobi_import_set(im, native, "bodies", json_incref(t->bodies));
    if (json_array_size(t->probes)) tobi_import_set(im, native, "probes", json_incref(t->probes));
    json_t *output = tobi_import_set(im, native, "output", json_object());
    tobi_import_set(im, output, "interval", tobi_import_real(output_interval(t)));
    im->no_memory |= tobi_source_add_origin(im->source, "output.interval", &longest_step) != TOBI_OK;
}

/* --- objects ------------------------------------------------------------------------------- */

static void widen(tank *t, const tobi_tank_shape *shape)
{
    for (int a = 0; a < 3; a++) {
        t->low[a] = t->has_box ? fmin(t->low[a], shape->low[a]) : shape->low[a];
        t->high[a] = t->has_box ? fmax(t->high[a], shape->high[a]) : shape->high[a];
    }
    t->has_box = 1;
}

/* The mesh of an object and its shape; NULL after a mistake. Owned by the caller. */
static char *find_mesh(tank *t, object *o, tobi_tank_shape *shape)
{
    const tobi_place at = { &root, "objfile", 0 };
    tobi_error err = { 0 };
    char *places, *mesh;
    if (!o->objfile || !*o->objfile) {
        const json_t *given = json_object_get(o->source.root, "objfile");
        if (!given || json_is_string(given))          /* another type is told where keys are read */
            tobi_source_mistake(&o->source, &at, "is missing: a closed mesh, in metres");
        return NULL;
    }
    mesh = tobi_tank_find(t->directory, o->objfile, &places);
    if (!mesh)
        tobi_source_mistake(&o->source, &at, "cannot find \"%s\", neither with its folders nor by its name; "
                            "looked in %s", o->objfile, places ? places : tr("no place: out of memory"));
    else if (tobi_tank_look(mesh, shape, &err) != TOBI_OK)
        tobi_source_mistake(&o->source, &at, "%s", err.text);
    free(places);
    return mesh;
}

static void add_fluid(tank *t, object *o, json_t *fluid)
{
    tobi_import *im = &t->im;
    tobi_tank_shape shape = { 0 };
    char *mesh = find_mesh(t, o, &shape);
    tobi_import_set(im, fluid, "density", tobi_import_real(density));
    tobi_import_set(im, fluid, "viscosity", tobi_import_real(viscosity));
    json_t *fills = tobi_import_set(im, fluid, "fill", json_array()), *fill = json_object();
    if (shape.box) {
        json_t *box = tobi_import_set(im, fill, "box", json_object());
        tobi_import_set(im, box, "min", tobi_import_vector(shape.low));
        tobi_import_set(im, box, "max", tobi_import_vector(shape.high));
    } else if (mesh) {
        tobi_import_set(im, fill, "mesh", json_string(mesh));
    }
    im->no_memory |= json_array_append_new(fills, fill) != 0;
    if (mesh && !t->cavity) widen(t, &shape);
    free(mesh);
    char *text = NULL;
    if (asprintf(&text, "fluids[%zu].fill[0].%s", json_array_size(t->fluids) - 1,
                 shape.box ? "box" : "mesh") < 0) {
        im->no_memory = 1;
        return;
    }
    tobi_import_tell(im, "objfile", text);
    if (shape.box) tobi_import_remark(im, "objfile", "the mesh is a box, so its corners are taken");
}

/* inactivate and inactive; [from, until] in s. */
static void set_absence(tank *t, object *o, json_t *body, const char *key)
{
    tobi_import *im = &t->im;
    const tobi_place at = { &root, key, 0 };
    json_t *times = json_object_get(o->source.root, key);
    const double from = json_number_value(json_array_get(times, 0));
    const double until = json_number_value(json_array_get(times, 1));
    if (!times) return;
    if (json_array_size(times) != 2 || !json_is_number(json_array_get(times, 0)) ||
        !json_is_number(json_array_get(times, 1)) || !(from >= 0 && until > from)) {
        tobi_source_mistake(&o->source, &at, "must be two times, [from, until], in s and in this order");
        return;
    }
    if (json_object_get(body, "absent"))
        tobi_source_mistake(&o->source, &at, "says the same as inactivate; give one of them");
    json_t *absent = tobi_import_set(im, body, "absent", json_object());
    tobi_import_set(im, absent, "from", tobi_import_real(fmax(from, 1e-12)));
    if (until < end_time(t)) tobi_import_set(im, absent, "until", tobi_import_real(until));
    else tobi_import_remark(im, key, "from then on the body is not there: it is taken away at once");
}

static void add_body(tank *t, object *o, json_t *body)
{
    tobi_import *im = &t->im;
    tobi_tank_shape shape = { 0 };
    char *mesh = find_mesh(t, o, &shape);
    const int cavity = o->index == 0 && t->cavity;
    if (mesh) tobi_import_set(im, body, "mesh", json_string(mesh));
    set_absence(t, o, body, "inactivate");
    set_absence(t, o, body, "inactive");
    if (cavity) {
        memcpy(t->low, shape.cavity_low, sizeof t->low);
        memcpy(t->high, shape.cavity_high, sizeof t->high);
        t->closed = !shape.open;
        tobi_import_tell(im, "name", strdup("domain"));
        tobi_import_tell(im, "objfile", strdup("domain"));
        tobi_import_remark(im, "objfile", "its hollow is a box: the sides of the domain are its walls, "
                           "without friction");
    } else if (mesh && !t->cavity) {
        widen(t, &shape);
    }
    if (cavity) im->no_memory |= json_array_remove(t->bodies, json_array_size(t->bodies) - 1) != 0;
    free(mesh);
}

static void add_probe(tank *t, object *o, json_t *probe)
{
    const tobi_place at = { &root, "location", 0 };
    if (!tobi_import_has(&tobi_tank_object_section, o->given, "location"))
        tobi_source_mistake(&o->source, &at, "is missing: where the sensor sits, [x, y, z] in m");
    tobi_import_set(&t->im, probe, "position", tobi_import_vector(o->def.location));
}

/* Adds the entry of the native list and the rows of the table. */
static void add_entry(tank *t, object *o, json_t *list, const char *native,
                      void (*add)(tank *t, object *o, json_t *entry))
{
    tobi_import *im = &t->im;
    tobi_source *setting = im->source;
    char path[64];
    json_t *entry = json_object();
    const tobi_place shown = { &root, o->stem, 0 }, listed = { &files, NULL, o->index };
    snprintf(path, sizeof path, "%s[%zu]", native, json_array_size(list));
    const char *name = o->def.name ? o->def.name : "";
    tobi_import_name(im, list, list == t->fluids ? t->bodies : list == t->bodies ? t->fluids : NULL, entry,
                     name, strlen(name));
    im->no_memory |= json_array_append(list, entry) != 0;
    im->source = &o->source;
    tobi_import_note(im, &tobi_tank_object_section, o->source.root, &shown, path, "");
    tobi_import_note_others(im, &tobi_tank_object_section, o->source.root, &root, &shown, &others);
    im->source = setting;
    im->no_memory |= tobi_source_add_origin(setting, path, &listed) != TOBI_OK;
    add(t, o, entry);
    json_decref(entry);
}

static void sort_object(tank *t, object *o)
{
    static const char *const types[] = { "Fluid", "RigidBody", "probe" };
    const tobi_place at = { &root, "type", 0 }, leave = { &root, "ignore", 0 };
    const char *type = o->def.type ? o->def.type : "", *near;
    json_t *ignore = json_object_get(o->source.root, "ignore");
    if (ignore && !json_is_boolean(ignore)) tobi_source_mistake(&o->source, &leave, "must be true or false");
    if (json_is_true(ignore)) {
        const tobi_place shown = { &root, o->stem, 0 };
        tobi_import_note(&t->im, &tobi_tank_object_section, o->source.root, &shown, "nothing", "");
    } else if (strcmp(type, types[0]) == 0) add_entry(t, o, t->fluids, "fluids", add_fluid);
    else if (strcmp(type, types[1]) == 0) add_entry(t, o, t->bodies, "bodies", add_body);
    else if (strcmp(type, types[2]) == 0) add_entry(t, o, t->probes, "probes", add_probe);
    else if (*type) {
        near = tobi_suggest(type, types, 3);
        tobi_source_mistake(&o->source, &at, "\"%s\" is none of Fluid, RigidBody, probe%s%s%s", type,
                            near ? tr("; did you mean ") : "", near ? near : "", near ? "?" : "");
    }
}

static void read_object(tank *t, object *o)
{
    tobi_import *im = &t->im;
    tobi_source *setting = im->source;
    json_t *bound = tobi_import_take_known(im, &tobi_tank_object_section, o->source.root, 0);
    im->source = im->binder.source = &o->source;
    o->given = tobi_import_read(im, &tobi_tank_object_section, bound, &root, &o->def);
    im->source = im->binder.source = setting;
    const char *dot = strrchr(o->name, '.');
    o->stem = strndup(o->name, dot ? (size_t)(dot - o->name) : strlen(o->name));
    if (o->stem) sort_object(t, o);
    im->no_memory |= !o->stem;
    free(o->stem);
    json_decref(bound);
}

/* Parses the file at input_files[index]. */
static void open_object(tank *t, object *o, const json_t *entry)
{
    tobi_source *setting = t->im.source;
    const tobi_place at = { &files, NULL, o->index };
    char *path = NULL, *text = NULL;
    size_t size;
    tobi_error err = { 0 };
    o->name = json_string_value(entry);
    if (!o->name || !*o->name) {
        tobi_source_mistake(setting, &at, "must be the name of an object's file, beside this one");
        return;
    }
    if (asprintf(&path, "%s/%s", t->directory, o->name) < 0) {
        t->im.no_memory = 1;
        return;
    }
    t->im.no_memory |= json_array_append_new(t->paths, json_string(path)) != 0;
    tobi_status status = tobi_plain_read(path, tr("object"), TOBI_SOURCE_LIMIT, &text, &size, &err);
    if (status != TOBI_OK) tobi_source_mistake(setting, &at, "%s", err.text);
    else status = tobi_source_parse(&o->source, path, text, size, setting->report, &err);
    t->im.no_memory |= status == TOBI_NO_MEMORY;
    if (status != TOBI_OK) tobi_source_clear(&o->source);
    else o->objfile = json_string_value(json_object_get(o->source.root, "objfile"));
    free(text);
    free(path);
}

/* The shape of a body; 0 if the object is none, or wrong, which is told later. */
static int look_at_body(const tank *t, const object *o, tobi_tank_shape *shape)
{
    const json_t *json = o->source.root;
    const char *type = json_string_value(json_object_get(json, "type"));
    char *mesh = NULL, *places = NULL;
    tobi_error err;
    if (o->objfile && type && strcmp(type, "RigidBody") == 0 &&
        !json_is_true(json_object_get(json, "ignore")))
        mesh = tobi_tank_find(t->directory, o->objfile, &places);
    const int found = mesh && tobi_tank_look(mesh, shape, &err) == TOBI_OK;
    free(places);
    free(mesh);
    return found;
}

/* The sides of the domain are the walls if the first object is a box around a box and no other body reaches
   out of it: bodies stay in the domain. */
static void choose_walls(tank *t)
{
    tobi_tank_shape wall, other;
    t->cavity = look_at_body(t, &t->objects[0], &wall) && wall.tank;
    for (size_t i = 1; i < t->object_count && t->cavity; i++) {
        if (!look_at_body(t, &t->objects[i], &other)) continue;
        const double tiny = 1e-6*(wall.high[0] - wall.low[0]);
        for (int a = 0; a < 3; a++)
            t->cavity &= other.low[a] >= wall.cavity_low[a] - tiny &&
                         other.high[a] <= wall.cavity_high[a] + tiny;
    }
}

static void read_objects(tank *t)
{
    json_t *list = json_object_get(t->im.source->root, "input_files"), *entry;
    size_t i;
    if (!json_is_array(list) || json_array_size(list) == 0 || json_array_size(list) > TOBI_BODY_LIMIT) {
        tobi_source_mistake(t->im.source, &files, "must be a list of 1 to %d names of files, the tank first",
                            TOBI_BODY_LIMIT);
        return;
    }
    const int64_t before = tobi_report_total(t->im.source->report);
    t->objects = calloc(json_array_size(list), sizeof *t->objects);
    t->im.no_memory |= !t->objects;
    if (!t->objects) return;
    t->object_count = json_array_size(list);
    json_array_foreach(list, i, entry) {
        t->objects[i].index = i;
        open_object(t, &t->objects[i], entry);
    }
    choose_walls(t);
    for (i = 0; i < t->object_count; i++) {
        if (t->objects[i].source.root) read_object(t, &t->objects[i]);
        tobi_source_clear(&t->objects[i].source);
    }
    if (json_array_size(t->fluids) == 0 && tobi_report_total(t->im.source->report) == before)
        tobi_source_mistake(t->im.source, &files, "names no object of type Fluid");
}

static char *write_closing(const tank *t)
{
    char *text = NULL;
    const int length = asprintf(&text,
        tr("Not in the files but in the program: density %g kg/m3, viscosity %g Pa s, gravity %g m/s2\n"
           "along -z, walls without friction, no surface tension. The method is isph; eisph is\n"
           "--set method=eisph.\n"
           "%s\n"
           "output.interval = %g s: %d steps of max_dt, as before, and at most %d outputs. Sensors are in\n"
           "probes.csv, NAME_pressure, after each step.\n"),
        density, viscosity, gravity,
        t->closed ? tr("The domain ends with the tank's lid.")
                  : tr("The domain reaches half the tank's height above it, between the same sides; there "
                       "was no lid."),
        output_interval(t), STEPS_PER_OUTPUT, OUTPUTS);
    return length < 0 ? NULL : text;
}

tobi_status tobi_import_translate_tank(tobi_source *source, tobi_texts *texts, const char *directory,
                                       char **table, json_t **object_files)
{
    tank t = { .im = { .source = source, .binder = { source, texts, directory, 3 } },
               .directory = directory };
    *table = NULL;
    t.im.native = json_object();
    t.fluids = json_array();
    t.bodies = json_array();
    t.probes = json_array();
    t.paths = *object_files = json_array();
    const int64_t before = tobi_report_total(source->report);
    read_setting(&t);
    read_objects(&t);
    build_setting(&t);
    t.im.closing = tobi_texts_keep(texts, write_closing(&t));
    tobi_status status = tobi_report_total(source->report) > before ? TOBI_INVALID : TOBI_OK;
    if (t.im.no_memory || texts->failed || !t.im.native || !t.fluids || !t.bodies || !t.probes ||
        !t.paths)
        status = TOBI_NO_MEMORY;
    if (status == TOBI_OK) status = tobi_import_finish(&t.im, table);
    free(t.objects);
    json_decref(t.fluids);
    json_decref(t.bodies);
    json_decref(t.probes);
    tobi_import_clear(&t.im);
    return status;
}
