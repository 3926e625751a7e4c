/* The JSON Schema of scenes. It accepts every scene that the reader accepts, and refuses unknown
   keys, wrong types, missing keys and values out of range. Its drawback: what needs more than one
   value (corners, overlaps, names, files) only the reader sees. */
#include "scene/bind.h"
#include "scene/describe/manual.h"
#include "scene/motions.h"
#include "scene/parts.h"
#include "scene/write.h"
#include "base/param.h"
#include "tobiuo/tobiuo.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void put_text(json_t *object, const char *key, const char *text)
{
    json_object_set_new(object, key, json_string(text));
}

static json_t *make_type(const char *type)
{
    json_t *schema = json_object();
    put_text(schema, "type", type);
    return schema;
}

/* An object that takes no other keys than those put into "properties" later. */
static json_t *make_object(void)
{
    json_t *schema = make_type("object");
    json_object_set_new(schema, "additionalProperties", json_false());
    json_object_set_new(schema, "properties", json_object());
    return schema;
}

static json_t *make_either(json_t *a, json_t *b)
{
    json_t *schema = json_object();
    json_object_set_new(schema, "anyOf", json_pack("[oo]", a, b));
    return schema;
}

static void require(json_t *schema, const char *key)
{
    json_t *list = json_object_get(schema, "required");
    if (!list) {
        list = json_array();
        json_object_set_new(schema, "required", list);
    }
    for (size_t i = 0; i < json_array_size(list); i++)
        if (strcmp(json_string_value(json_array_get(list, i)), key) == 0) return;
    json_array_append_new(list, json_string(key));
}

/* Whole limits without ".0". */
static json_t *make_limit(double v)
{
    return v == floor(v) && fabs(v) < 1e9 ? json_integer((json_int_t)v) : json_real(v);
}

static json_t *make_number(const tobi_param *row)
{
    json_t *schema = make_type(row->type == TOBI_PARAM_INT ? "integer" : "number");
    json_object_set_new(schema, "minimum", make_limit(row->min));
    json_object_set_new(schema, "maximum", make_limit(row->max));
    return schema;
}

static json_t *make_words(const char *choices)
{
    json_t *schema = json_object(), *list = json_array();
    int length;
    for (int i = 0; i < tobi_choice_count(choices); i++) {
        const char *word = tobi_choice_word(choices, i, &length);
        json_array_append_new(list, json_stringn(word, (size_t)length));
    }
    json_object_set_new(schema, "enum", list);
    return schema;
}

static json_t *make_vector(const tobi_param *row)
{
    json_t *list = make_type("array");
    json_object_set_new(list, "items", make_number(row));
    json_object_set_new(list, "minItems", json_integer(2));      /* in a 2-D scene */
    json_object_set_new(list, "maxItems", json_integer(3));
    if (row->text) return make_either(list, make_words(row->text));
    return row->positive ? make_either(make_number(row), list) : list;
}

static json_t *make_methods(void)
{
    json_t *schema = json_object(), *list = json_array();
    for (int i = 0; tobi_method_name(i); i++)
        json_array_append_new(list, json_string(tobi_method_name(i)));
    json_object_set_new(schema, "enum", list);
    return schema;
}

static json_t *make_fields(void)
{
    json_t *item = json_object(), *names = json_array(), *list = make_type("array");
    const char *name, *unit;
    int components;
    json_array_append_new(names, json_string("usual"));
    for (int i = 0; (name = tobi_world_field_name(i, &components, &unit)); i++)
        json_array_append_new(names, json_string(name));
    json_object_set_new(item, "enum", names);
    json_object_set_new(list, "items", item);
    return make_either(list, make_type("string"));
}

static json_t *make_name(void)
{
    json_t *schema = make_type("string");
    json_object_set_new(schema, "minLength", json_integer(1));
    json_object_set_new(schema, "maxLength", json_integer(100));
    put_text(schema, "pattern", "^[^.+=@/\\\\:*?\"<>|,-][^/\\\\:*?\"<>|,]*$");
    return schema;
}

/* At least three pairs of numbers, or two above a base. */
static json_t *make_points(void)
{
    json_t *pair = make_type("array"), *list = make_type("array");
    json_object_set_new(pair, "items", make_type("number"));
    json_object_set_new(pair, "minItems", json_integer(2));
    json_object_set_new(pair, "maxItems", json_integer(2));
    json_object_set_new(list, "items", pair);
    json_object_set_new(list, "minItems", json_integer(2));
    return list;
}

static json_t *make_names(void)
{
    json_t *list = make_type("array");
    json_object_set_new(list, "items", make_name());
    json_object_set_new(list, "minItems", json_integer(1));
    json_object_set_new(list, "uniqueItems", json_true());
    return list;
}

static json_t *make_text(const tobi_param *row)
{
    if (strcmp(row->unit, "method") == 0) return make_methods();
    if (strcmp(row->unit, "points") == 0) return make_points();
    if (strcmp(row->unit, "names") == 0) return make_fields();
    if (strcmp(row->unit, "name or names") == 0) return make_either(make_name(), make_names());
    if (strcmp(row->unit, "path") != 0 && strcmp(row->unit, "text") != 0) return make_name();
    json_t *schema = make_type("string");
    json_object_set_new(schema, "minLength", json_integer(1));
    if (strcmp(row->unit, "text") == 0) json_object_set_new(schema, "maxLength", json_integer(200));
    return schema;
}

static json_t *make_value(const tobi_param *row)
{
    switch (row->type) {
    case TOBI_PARAM_VEC3: return make_vector(row);
    case TOBI_PARAM_TEXT: return make_text(row);
    case TOBI_PARAM_CHOICE: return make_words(row->choices);
    case TOBI_PARAM_BOOL: return make_type("boolean");
    default: return row->text ? make_either(make_number(row), make_words(row->text)) : make_number(row);
    }
}

/* What an editor shows beside the value, and what it fills in. */
static void add_help(json_t *schema, const tobi_param *row, const void *def)
{
    char text[600], limits[200], usual[200];
    tobi_bind_limits(row, limits, sizeof limits);
    tobi_bind_default(row, usual, sizeof usual);
    if (row->type == TOBI_PARAM_TEXT)
        snprintf(text, sizeof text, "%s (%s)", row->doc, row->unit);
    else if (strcmp(row->unit, "1") == 0 || row->type == TOBI_PARAM_CHOICE ||
             row->type == TOBI_PARAM_BOOL)
        snprintf(text, sizeof text, "%s Allowed: %s.", row->doc, limits);
    else snprintf(text, sizeof text, "%s Unit: %s. Allowed: %s.", row->doc, row->unit, limits);
    size_t used = strlen(text);
    if (row->required) snprintf(text + used, sizeof text - used, " Required.");
    else snprintf(text + used, sizeof text - used, " Default: %s.", usual);
    put_text(schema, "description", text);
    json_t *value = row->required ? NULL : tobi_write_member(row, def);
    if (value) json_object_set_new(schema, "default", value);
}

/* Rows "key[0]" and "key[1]" become one property: a list of two, or one word for both sides. */
static json_t *pair_up(json_t *one, const tobi_param *row)
{
    json_t *list = make_type("array"), *plain = make_value(row);
    json_object_set(list, "items", plain);
    json_object_set_new(list, "minItems", json_integer(2));
    json_object_set_new(list, "maxItems", json_integer(2));
    int word = row->type == TOBI_PARAM_CHOICE;
    json_t *schema = word ? make_either(json_incref(plain), list) : list;
    char text[600];
    snprintf(text, sizeof text, "Both sides along this axis: [lower, upper]%s. %s",
             word ? ", or one word for both" : "", row->doc);
    put_text(schema, "description", text);
    if (word) json_object_set(schema, "default", json_object_get(one, "default"));
    json_decref(plain);
    json_decref(one);
    return schema;
}

static void put_row(json_t *schema, const tobi_param *row, const void *def)
{
    const char *key = row->key;
    for (const char *dot; (dot = strchr(key, '.')); key = dot + 1) {
        char name[48];
        snprintf(name, sizeof name, "%.*s", (int)(dot - key), key);
        json_t *inside = json_object_get(schema, "properties");
        if (!json_object_get(inside, name)) json_object_set_new(inside, name, make_object());
        if (row->required) require(schema, name);
        schema = json_object_get(inside, name);
    }
    json_t *value = make_value(row), *properties = json_object_get(schema, "properties");
    add_help(value, row, def);
    char name[48];
    snprintf(name, sizeof name, "%.*s", (int)strcspn(key, "["), key);
    if (row->required) require(schema, name);
    if (!strchr(key, '[')) json_object_set_new(properties, name, value);
    else if (!json_object_get(properties, name))
        json_object_set_new(properties, name, pair_up(value, row));
    else json_decref(value);
}

static json_t *make_table(const tobi_param_table *table);

/* One of the motions: a script, whose keys stand in the motion itself, or one by numbers. */
static json_t *make_one_motion(void)
{
    const tobi_param_table *table = tobi_motion_table(0);
    json_t *schema = make_table(table), *kinds = json_array();
    json_t *properties = json_object_get(schema, "properties");
    json_object_del(schema, "required");
    for (int i = 0; (table = tobi_motion_table(i)); i++) {
        json_array_append_new(kinds, json_pack("{s[s]}", "required", table->name));
        if (i > 0) json_object_set_new(properties, table->name, make_table(table));
    }
    json_object_set_new(schema, "oneOf", kinds);
    json_object_set_new(schema, "dependencies",
                        json_pack("{s[s]}", "params", tobi_motion_table(0)->name));
    return schema;
}

static json_t *make_motion(void)
{
    static const char one[] = "#/definitions/motion";
    json_t *list = json_pack("{ss s{ss} si si}", "type", "array", "items", "$ref", one, "minItems", 1,
                             "maxItems", TOBI_MOTION_LIMIT);
    return json_pack("{s[{ss}o]}", "anyOf", "$ref", one, list);
}

static json_t *make_part(const tobi_part *part)
{
    json_t *schema = part->form == TOBI_PART_OBJECT   ? make_table(part->table)
                     : part->form == TOBI_PART_LIST   ? make_type("array")
                     : part->form == TOBI_PART_MOTION ? make_motion()
                     : part->form == TOBI_PART_FREE   ? make_type("object")
                                                      : make_type("string");
    if (part->form == TOBI_PART_LIST) {
        json_object_set_new(schema, "items", make_table(part->table));
        json_object_set_new(schema, "minItems", json_integer(part->least));
        json_object_set_new(schema, "maxItems", json_integer(part->most));
    }
    put_text(schema, "description", part->doc);
    return schema;
}

/* A region or a body is a box, a mesh, one of the other shapes or, of regions, what a vessel holds; a porous
   zone is a box or an outline. The table cannot say that one is needed. */
static void require_region(json_t *schema)
{
    json_t *properties = json_object_get(schema, "properties"), *box = json_object_get(properties, "box");
    json_t *sphere = json_object_get(properties, "sphere"), *shapes;
    require(box, "min");
    require(box, "max");
    shapes = json_pack("[{s[s]}]", "required", "box");
    if (json_object_get(properties, "mesh"))
        json_array_append_new(shapes, json_pack("{s[s]}", "required", "mesh"));
    if (sphere) {
        if (!json_object_get(properties, "plate")) require(sphere, "centre");
        require(sphere, "radius");
        json_array_append_new(shapes, json_pack("{s[s]}", "required", "sphere"));
    }
    static const char *const more[][2] = { { "cylinder", "radius" }, { "capsule", "radius" },
                                           { "plate", "thickness" }, { "knife", "thickness" },
                                           { "outline", NULL }, { "terrain", "file" } };
    for (size_t k = 0; k < sizeof more/sizeof *more; k++) {
        json_t *shape = json_object_get(properties, more[k][0]);
        if (!shape) continue;
        if (more[k][1]) require(shape, more[k][1]);
        json_array_append_new(shapes, json_pack("{s[s]}", "required", more[k][0]));
    }
    if (json_object_get(properties, "level"))
        json_array_append_new(shapes, json_pack("{s[s]}", "required", "vessel"));
    json_object_set_new(schema, "oneOf", shapes);
}

static json_t *make_table(const tobi_param_table *table)
{
    json_t *schema = make_object();
    void *def = calloc(1, table->size);
    if (!def) return schema;
    tobi_param_defaults(table, def);
    put_text(schema, "description", table->doc);
    for (const tobi_param *row = table->rows; row->key; row++) put_row(schema, row, def);
    free(def);
    if (table == &tobi_fill_table || table == &tobi_body_table || table == &tobi_porous_table)
        require_region(schema);
    tobi_part part;
    for (int i = 0; tobi_part_at(i, &part); i++) {
        if (strcmp(part.owner, table->name) != 0) continue;
        json_object_set_new(json_object_get(schema, "properties"), part.key, make_part(&part));
        if (part.least > 0) require(schema, part.key);
    }
    return schema;
}

/* Methods that move solids need some, or bodies; the others need fluids, which fill regions or come in. */
static void require_matter(json_t *schema)
{
    json_t *names = json_array();
    tobi_method_info method;
    json_t *none = json_pack("{s:i}", "maxItems", 0), *some = json_pack("{s:i}", "minItems", 1);
    for (int i = 0; tobi_method_name(i); i++)
        if (tobi_method_describe(tobi_method_name(i), &method) && method.solids)
            json_array_append_new(names, json_string(method.name));
    json_object_set_new(schema, "if", json_pack("{s:[s],s:{s:{s:o}}}", "required", "method", "properties",
                                                "method", "enum", names));
    json_object_set_new(schema, "then",
                        json_pack("{s:{s:O,s:O},s:[{s:[s],s:{s:O}},{s:[s],s:{s:O}}]}", "properties", "fluids",
                                  none, "probes", none, "anyOf", "required", "solids", "properties", "solids",
                                  some, "required", "bodies", "properties", "bodies", some));
    json_t *filled = json_pack("{s:{s:{s:{s:[s]}}}}", "properties", "fluids", "items", "required", "fill");
    json_object_set_new(schema, "else",
                        json_pack("{s:[s],s:{s:O,s:O},s:[{s:[s]},o]}", "required", "fluids", "properties",
                                  "fluids", some, "planes", none, "anyOf", "required", "inlets", filled));
    json_decref(none);
    json_decref(some);
}

char *tobi_scene_schema(void)
{
    json_t *schema = json_object(), *root = make_table(&tobi_world_table);
    put_text(schema, "$schema", "http://json-schema.org/draft-07/schema#");
    put_text(schema, "title", "Tobiuo scene");
    json_object_update(schema, root);
    json_decref(root);
    require_matter(schema);
    json_object_set_new(schema, "definitions", json_pack("{so}", "motion", make_one_motion()));
    put_text(schema, "description", "A simulation: SI units, angles in degrees.");
    char *text = tobi_write_json(schema);
    json_decref(schema);
    return text;
}
