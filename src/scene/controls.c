/* `control` and `flow` are Lua files with parameters; the table is here because no definition of the
   library has these keys. Drawback: the reader knows these two by name. */
#include "scene/controls.h"
#include "scene/parts.h"
#include "scene/write.h"
#include <math.h>
#include <stdlib.h>

static const tobi_param rows[] = {
    { .key = "script", .type = TOBI_PARAM_TEXT, .offset = offsetof(tobi_control_def, script), .unit = "path",
      .required = true,
      .doc = "A Lua file with a function control(t, body) that returns { force = {x, y, z}, torque = "
             "{x, y, z}, phase = 2, hold = \"z,turn\", steer = {a, b, c}, state = {a, b, ...}, motor = "
             "{ NAME = value } }, all of them optional; body has position, orientation, velocity, "
             "angular_velocity, contact_force, contact_torque, mass, inertia, phase, phase_time, step, "
             "steer, state and joints. phase, a whole number that begins with 1, steer, numbers for the "
             "deform of the same body, and state, up to 16 numbers, are all that is kept from step to step "
             "and by a resumed run: globals cannot be assigned in control, and what it keeps in tables or "
             "locals outside of itself is lost on resume." },
    { 0 }
};
static const tobi_param flow_rows[] = {
    { .key = "script", .type = TOBI_PARAM_TEXT, .offset = offsetof(tobi_control_def, script), .unit = "path",
      .required = true,
      .doc = "A Lua file with a function velocity(x, y, z) that returns the velocity vx, vy, vz (m/s) of "
             "what is at that place (m) at the start; in 2-D z is 0 and vz is not used." },
    { 0 }
};
const tobi_param_table tobi_flow_table = {
    "flow", "A velocity of each place, in addition to velocity and spin of the region.",
    sizeof(tobi_control_def), flow_rows };
const tobi_param_table tobi_control_table = {
    "control", "The control program of a controlled body: a force (N) and a torque (N m) in every step.",
    sizeof(tobi_control_def), rows };

static const tobi_param_table *table_of(tobi_script_role role)
{
    return role == TOBI_FLOW_SCRIPT ? &tobi_flow_table : &tobi_control_table;
}

tobi_script *tobi_control_bind(const tobi_binder *binder, tobi_script_role role, json_t *value,
                               const tobi_place *place, tobi_control_def *def)
{
    const char *also[TOBI_PARTS];
    tobi_part_keys(table_of(role)->name, also);
    *def = (tobi_control_def){ 0 };
    int64_t before = tobi_report_total(binder->source->report);
    tobi_bind(binder, table_of(role), value, place, also, def);
    def->params = json_object_get(value, "params");
    tobi_place params = { place, "params", 0 }, script_place = { place, "script", 0 };
    if (def->params && !json_is_object(def->params))
        tobi_source_mistake(binder->source, &params, "is %s, must be an object { ... }",
                            tobi_json_kind(def->params));
    if (tobi_report_total(binder->source->report) > before) return NULL;

    tobi_script *script = NULL;
    tobi_error err = { 0 };
    char *text = def->params ? json_dumps(def->params, 0) : NULL;
    if (tobi_script_load(def->script, text, role, &script, &err) != TOBI_OK)
        tobi_source_mistake(binder->source, &script_place, "%s", err.text);
    free(text);
    return script;
}

json_t *tobi_control_write(tobi_script_role role, const tobi_control_def *def)
{
    json_t *object = tobi_write_def(table_of(role), def);
    int failed = !object;
    if (def->params) failed |= json_object_set(object, "params", def->params);
    if (!failed) return object;
    json_decref(object);
    return NULL;
}
