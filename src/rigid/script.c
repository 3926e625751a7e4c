/* Motion, control and flow scripts on LuaJIT.

   Two Lua environments live in one state: ours, with ffi, which walks the arrays of points, and the
   user's, with mathematics only. Because the walk is itself Lua, the user's function is compiled
   into it and runs at the speed of C. Endless loops end through the guards of script_guard.c,
   memory through a counting allocator. Turns alone would not do: one comparison of two texts of
   10 MB takes as long as a million turns, so every 256 of them the guard looks at the clock.

   The optimiser's constant folding is off: it computes x^2 as x*x where the interpreter calls pow,
   and a restart, which begins interpreted, would not repeat the bits of a run that is compiled. */
#include "rigid/script.h"
#include "rigid/script_guard.h"
#include <errno.h>
#include <jansson.h>
#include <lauxlib.h>
#include <lua.h>
#include <lualib.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MEMORY_LIMIT (64u << 20)      /* bytes a script may hold            */
#define FILE_LIMIT   (4 << 20)        /* bytes of a script file             */
#define TICK_LIMIT   10000000         /* loop turns and calls per point     */
#define SECONDS_LIMIT 3               /* processor time per point           */
#define POOL          (64 << 10)      /* bytes for making a state           */
#define DEPTH_LIMIT  50               /* nesting of params                  */

struct tobi_script {
    lua_State *lua;
    size_t bytes;             /* held by Lua now, outside of the pool        */
    size_t pooled;            /* of the pool given away                      */
    bool making;              /* the state is                                */
    char *label;              /* "motion script PATH", for messages              */
    const char *path;         /* its end                                         */
    tobi_script_role role;
    bool rigid;
    bool open;                /* Lua's libraries are, and DRIVER has run     */
    int deform, place, control;   /* registry references of the walks in DRIVER  */
    char hold[64];            /* the last answer of control                  */
    _Alignas(16) char pool[POOL];
    double pivot[3];          /* m                                           */
};

/* Our side: gets the user's environment, returns the walks. `at` tells C which point is in work. */
static const char DRIVER[] =
    "local user, limit, seconds = ...\n"
    "local ffi, math, string = require('ffi'), math, string\n"
    "require('jit.opt').start('-fold')\n"
    "local error, type, tonumber = error, type, tonumber\n"
    "for _, name in ipairs{'ipairs', 'pairs', 'next', 'select', 'tonumber', 'tostring', 'type',\n"
    "                      'unpack', 'error', 'assert'} do user[name] = _G[name] end\n"
    "user.math, user.table, user.string = {}, {}, {}\n"
    "for k, v in pairs(math) do user.math[k] = v end\n"
    "user.math.random, user.math.randomseed = nil, nil\n"
    "for _, k in ipairs{'concat', 'insert', 'remove', 'sort', 'maxn'} do user.table[k] = table[k] end\n"
    "for _, k in ipairs{'format', 'len', 'sub', 'byte', 'char', 'lower', 'upper'} do\n"
    "    user.string[k] = string[k]\n"
    "end\n"
    "getmetatable('').__index = user.string\n"
    "ffi.cdef'struct tobi_time { long s, ns; }; int clock_gettime(int, struct tobi_time *);'\n"
    "local C, time = ffi.C, ffi.new('struct tobi_time')\n"
    "local count, look, began = 0, 256, 0\n"
    "local function is_late()\n"
    "    C.clock_gettime(3, time)\n"                     /* CLOCK_THREAD_CPUTIME_ID */
    "    local now = tonumber(time.s) + 1e-9*tonumber(time.ns)\n"
    "    if look == 256 then began = now end\n"
    "    look = look + 256\n"
    "    return now - began > seconds\n"
    "end\n"
    "user." TOBI_SCRIPT_TICK " = function()\n"
    "    count = count + 1\n"
    "    if count >= look and is_late() then\n"
    "        error('endless loop? stopped after ' .. seconds .. ' s at one point', 2)\n"
    "    end\n"
    "    if count > limit then\n"
    "        error('endless loop? stopped after ' .. limit .. ' turns and calls', 2)\n"
    "    end\n"
    "end\n"
    /* The names move to another table, so that assigning to one that exists is seen, too. */
    "local function seal(remembered)\n"
    "    local names = {}\n"
    "    for k, v in pairs(user) do names[k] = v end\n"
    "    for k in pairs(names) do user[k] = nil end\n"
    "    setmetatable(names, { __index = function(_, k)\n"
    "        error(\"unknown name '\" .. tostring(k) .. \"'\", 2)\n"
    "    end })\n"
    "    setmetatable(user, { __index = names, __newindex = function(_, k)\n"
    "        error(\"assignment to the global '\" .. tostring(k) .. \"': write local; from one time \" ..\n"
    "              \"to the next \" .. remembered .. \" is remembered\", 2)\n"
    "    end })\n"
    "end\n"
    "local f, g, h, walked\n"
    "local function bind(name, points, place, control) walked, f, g, h = name, points, place, control end\n"
    "local function deform(n, t, rest, position, at)\n"
    "    rest, position = ffi.cast('const double *', rest), ffi.cast('double *', position)\n"
    "    at = ffi.cast('double *', at)\n"
    "    for i = 0, n - 1 do\n"
    "        local k = 3 * i\n"
    "        at[0], count, look = i, 0, 256\n"
    "        local x, y, z, more = f(rest[k], rest[k + 1], rest[k + 2], t)\n"
    "        if type(x) ~= 'number' or type(y) ~= 'number' or type(z) ~= 'number' or more ~= nil then\n"
    "            error(walked .. ' must return three numbers', 0)\n"
    "        end\n"
    "        position[k], position[k + 1], position[k + 2] = x, y, z\n"
    "    end\n"
    "end\n"
    "local function place(t) count, look = 0, 256 return g(t) end\n"
    "local known = { force = true, torque = true, phase = true, hold = true }\n"
    "local function take(value, name, into, first)\n"
    "    if value == nil then return end\n"
    "    if type(value) ~= 'table' or value[4] ~= nil then value = {} end\n"
    "    for k = 1, 3 do\n"
    "        if type(value[k]) ~= 'number' then\n"
    "            error('control must return a ' .. name .. ' of three numbers', 0)\n"
    "        end\n"
    "        into[first + k - 1] = value[k]\n"
    "    end\n"
    "end\n"
    "local inputs = { __index = function(_, k)\n"
    "    error(\"body has no '\" .. tostring(k) .. \"'; it has position, orientation, velocity, \" ..\n"
    "          'angular_velocity, contact_force, contact_torque, mass, phase and phase_time', 2)\n"
    "end }\n"
    "local function control(from, into)\n"
    "    from, into = ffi.cast('const double *', from), ffi.cast('double *', into)\n"
    "    count, look = 0, 256\n"
    "    local function three(k) return { from[k], from[k + 1], from[k + 2] } end\n"
    "    local answer = h(from[0], setmetatable({ position = three(1),\n"
    "        orientation = { from[4], from[5], from[6], from[7] }, velocity = three(8),\n"
    "        angular_velocity = three(11), contact_force = three(14),\n"
    "        contact_torque = three(17), mass = from[20], phase = from[21],\n"
    "        phase_time = from[22] }, inputs))\n"
    "    if answer == nil then return end\n"
    "    if type(answer) ~= 'table' then error('control must return a table or nothing', 0) end\n"
    "    for key in pairs(answer) do\n"
    "        if not known[key] then\n"
    "            error(\"control returned the unknown key '\" .. tostring(key) ..\n"
    "                  \"'; allowed are force, torque, phase, hold\", 0)\n"
    "        end\n"
    "    end\n"
    "    take(answer.force, 'force', into, 0)\n"
    "    take(answer.torque, 'torque', into, 3)\n"
    "    if answer.phase ~= nil then\n"
    "        if type(answer.phase) ~= 'number' or answer.phase % 1 ~= 0 or\n"
    "           math.abs(answer.phase) > 1e9 then\n"
    "            error('control must return a whole number as phase', 0)\n"
    "        end\n"
    "        into[6] = answer.phase\n"
    "    end\n"
    "    if answer.hold ~= nil and type(answer.hold) ~= 'string' then\n"
    "        error('control must return a text as hold', 0)\n"
    "    end\n"
    "    return answer.hold\n"
    "end\n"
    "return seal, bind, deform, place, control\n";

/* A piece of the pool, which serves while the state is made: LuaJIT crashes in lua_newstate when it gets its
   first piece and then one less. Pieces are never given back. */
static void *take_from_pool(tobi_script *script, const void *p, size_t old, size_t size)
{
    size_t begin = script->pooled;
    if (!script->making || size == 0 || size > POOL - begin) return NULL;
    script->pooled = begin + (size + 15)/16*16 < POOL ? begin + (size + 15)/16*16 : POOL;
    if (p) memcpy(script->pool + begin, p, old < size ? old : size);
    return script->pool + begin;
}

static void *allocate(void *user, void *p, size_t old, size_t size)
{
    tobi_script *script = user;
    bool pooled = p && (char *)p >= script->pool && (char *)p < script->pool + POOL;
    if (!p) old = 0;
    if (!p || pooled) {
        void *piece = take_from_pool(script, p, old, size);
        if (piece) return piece;
    }
    if (pooled) {
        void *moved = size ? allocate(script, NULL, 0, size) : NULL;
        if (moved) memcpy(moved, p, old < size ? old : size);
        return moved;
    }
    if (size > old && script->bytes + (size - old) > MEMORY_LIMIT) return NULL;
    void *q = NULL;
    if (size == 0) free(p);
    else if (!(q = realloc(p, size))) return NULL;
    script->bytes += size - old;
    return q;
}

static tobi_status read_text(const tobi_script *script, char **text, size_t *length, tobi_error *err)
{
    const char *label = script->label;
    FILE *file = fopen(script->path, "rb");
    if (!file)
        return tobi_fail(err, errno == ENOENT ? TOBI_NOT_FOUND : TOBI_IO,
                         "%s: %s", label, strerror(errno));
    *text = malloc(FILE_LIMIT + 1);
    *length = *text ? fread(*text, 1, FILE_LIMIT + 1, file) : 0;
    bool failed = ferror(file);
    int reason = errno;
    fclose(file);
    if (*text && !failed && *length <= FILE_LIMIT) return TOBI_OK;
    free(*text);
    if (failed) return tobi_fail(err, TOBI_IO, "%s: %s", label, strerror(reason));
    return tobi_fail(err, *text ? TOBI_INVALID : TOBI_NO_MEMORY,
                     "%s: larger than 4 MiB", label);
}

/* Leaves the Lua value of a JSON value on the stack; null is nil, arrays count from 1. */
static void push_json(lua_State *lua, const json_t *value, int depth)
{
    luaL_checkstack(lua, 4, "params");
    if (depth > DEPTH_LIMIT) luaL_error(lua, "params are nested too deeply");
    if (json_is_number(value)) lua_pushnumber(lua, json_number_value(value));
    else if (json_is_boolean(value)) lua_pushboolean(lua, json_is_true(value));
    else if (json_is_string(value))
        lua_pushlstring(lua, json_string_value(value), json_string_length(value));
    else if (json_is_array(value)) {
        lua_newtable(lua);
        for (size_t i = 0; i < json_array_size(value); i++) {
            push_json(lua, json_array_get(value, i), depth + 1);
            lua_rawseti(lua, -2, (int)i + 1);
        }
    } else if (json_is_object(value)) {
        const char *key;
        json_t *child;
        lua_newtable(lua);
        json_object_foreach((json_t *)value, key, child) {
            push_json(lua, child, depth + 1);
            lua_setfield(lua, -2, key);
        }
    } else {
        lua_pushnil(lua);
    }
}

/* What loading needs inside Lua's protected call. */
typedef struct load_job {
    tobi_script *script;
    const char *name;         /* of the file, for messages */
    const char *text;         /* guarded                   */
    const json_t *params;
} load_job;

static void read_pivot(lua_State *lua, int user, double pivot[3])
{
    lua_getfield(lua, user, "pivot");
    if (!lua_isnil(lua, -1)) {
        if (!lua_istable(lua, -1)) luaL_error(lua, "pivot must be {x, y, z}");
        for (int a = 0; a < 3; a++) {
            lua_rawgeti(lua, -1, a + 1);
            pivot[a] = lua_tonumber(lua, -1);
            if (lua_type(lua, -1) != LUA_TNUMBER || !isfinite(pivot[a]))
                luaL_error(lua, "pivot must be {x, y, z}, three finite numbers");
            lua_pop(lua, 1);
        }
    }
    lua_pop(lua, 1);
}

/* Compiles and runs the user's text in its environment, then binds its function to the walks. */
static int load_protected(lua_State *lua)
{
    load_job *job = lua_touserdata(lua, 1);
    luaL_openlibs(lua);
    lua_newtable(lua);
    int user = lua_gettop(lua);
    push_json(lua, job->params, 0);
    lua_setfield(lua, user, "params");

    if (luaL_loadbufferx(lua, DRIVER, sizeof DRIVER - 1, "=driver", "t")) return lua_error(lua);
    lua_pushvalue(lua, user);
    lua_pushnumber(lua, TICK_LIMIT);
    lua_pushnumber(lua, SECONDS_LIMIT);
    lua_call(lua, 3, 5);
    int seal = user + 1, bind = user + 2;
    job->script->control = luaL_ref(lua, LUA_REGISTRYINDEX);
    job->script->place = luaL_ref(lua, LUA_REGISTRYINDEX);
    job->script->deform = luaL_ref(lua, LUA_REGISTRYINDEX);
    job->script->open = true;

    if (luaL_loadbufferx(lua, job->text, strlen(job->text), job->name, "t")) return lua_error(lua);
    lua_pushvalue(lua, user);
    lua_setfenv(lua, -2);
    lua_call(lua, 0, 0);

    read_pivot(lua, user, job->script->pivot);
    const char *walked = job->script->role == TOBI_FLOW_SCRIPT ? "velocity" : "deform";
    lua_pushvalue(lua, bind);
    lua_pushstring(lua, walked);
    lua_getfield(lua, user, walked);
    lua_getfield(lua, user, "place");
    lua_getfield(lua, user, "control");
    bool deforms = lua_isfunction(lua, -3), places = lua_isfunction(lua, -2);
    if (job->script->role == TOBI_CONTROL_SCRIPT) {
        if (!lua_isfunction(lua, -1)) return luaL_error(lua, "define function control(t, body)");
    } else if (job->script->role == TOBI_FLOW_SCRIPT) {
        if (!deforms) return luaL_error(lua, "define function velocity(x, y, z)");
    } else if (deforms == places)
        return luaL_error(lua, "define either function deform(x, y, z, t) or function place(t)%s",
                          deforms ? ", not both" : "");
    job->script->rigid = places;
    lua_call(lua, 4, 0);
    lua_pushvalue(lua, seal);
    lua_pushstring(lua, job->script->role == TOBI_CONTROL_SCRIPT ? "only the phase that control returns"
                                                                 : "nothing");
    lua_call(lua, 1, 0);
    return 0;
}

static const char *message(lua_State *lua)
{
    /* Numbers are left out: converting one allocates, unprotected here. */
    return lua_type(lua, -1) == LUA_TSTRING ? lua_tostring(lua, -1) : "an error without a text";
}

static tobi_status load(load_job *job, tobi_error *err)
{
    job->script->making = true;
    lua_State *lua = lua_newstate(allocate, job->script);
    job->script->making = false;
    if (!lua) return tobi_fail(err, TOBI_NO_MEMORY, "%s: no memory for Lua", job->script->label);
    job->script->lua = lua;
    if (lua_cpcall(lua, load_protected, job) == 0) return TOBI_OK;
    return tobi_fail(err, TOBI_SCRIPT, "%s: %s", job->script->label, message(lua));
}

/* Name of a chunk in messages: the file's own name, as Lua cuts long ones. */
static char *make_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *file = slash ? slash + 1 : path;
    char *name = malloc(strlen(file) + 2);
    if (name) sprintf(name, "@%s", file);
    return name;
}

static tobi_status guard_and_load(tobi_script *script, const json_t *params, tobi_error *err)
{
    char *text = NULL;
    size_t length = 0;
    TOBI_TRY(read_text(script, &text, &length, err));
    tobi_error why = { 0 };
    if (memchr(text, '\0', length) || (length > 0 && text[0] == '\x1b')) {
        free(text);
        return tobi_fail(err, TOBI_SCRIPT, "%s: not a text file", script->label);
    }
    char *guarded = tobi_script_guard(text, length, &why);
    free(text);
    if (!guarded) return tobi_fail(err, why.status, "%s: %s", script->label, why.text);
    char *name = make_name(script->path);
    load_job job = { script, name, guarded, params };
    tobi_status status = name ? load(&job, err) : tobi_fail(err, TOBI_NO_MEMORY, "out of memory");
    free(name);
    free(guarded);
    return status;
}

static const char *const role_name[] = { "motion", "control", "flow" };

static tobi_status set_label(tobi_script *script, const char *path, tobi_script_role role)
{
    const char *kind = role_name[role];
    size_t room = strlen(path) + 20;
    script->role = role;
    script->label = malloc(room);
    if (!script->label) return TOBI_NO_MEMORY;
    script->path = script->label + snprintf(script->label, room, "%s script ", kind);
    snprintf(script->label + strlen(script->label), room - strlen(script->label), "%s", path);
    return TOBI_OK;
}

tobi_status tobi_script_load(const char *path, const char *params_json, tobi_script_role role,
                             tobi_script **out, tobi_error *err)
{
    *out = NULL;
    json_error_t where;
    json_t *params = json_loads(params_json ? params_json : "{}", 0, &where);
    if (!json_is_object(params)) {
        json_decref(params);
        return tobi_fail(err, TOBI_INVALID, "%s params: %s", role_name[role],
                         params ? "must be a JSON object" : where.text);
    }
    tobi_script *script = calloc(1, sizeof *script);
    tobi_status status = TOBI_OK;
    if (!script || set_label(script, path, role) != TOBI_OK)
        status = tobi_fail(err, TOBI_NO_MEMORY, "script %s: out of memory", path);
    else
        status = guard_and_load(script, params, err);
    json_decref(params);
    if (status == TOBI_OK) *out = script;
    else tobi_script_free(script);
    return status;
}

void tobi_script_free(tobi_script *script)
{
    if (!script) return;
    /* LuaJIT crashes when it closes a state whose libraries memory did not suffice for; it stays. */
    if (script->lua && script->open) lua_close(script->lua);
    free(script->label);
    free(script);
}

int tobi_script_is_rigid(const tobi_script *script) { return script->rigid; }

/* Calls the function of points. *why: what went wrong at point *bad, "" if its answer is not finite, NULL if
   nothing. */
static void walk(tobi_script *script, double t, int64_t n, const double (*from)[3], double (*to)[3],
                 int64_t *bad, const char **why)
{
    lua_State *lua = script->lua;
    double at = 0.0;
    lua_settop(lua, 0);
    lua_rawgeti(lua, LUA_REGISTRYINDEX, script->deform);
    lua_pushnumber(lua, (double)n);
    lua_pushnumber(lua, t);
    lua_pushlightuserdata(lua, (void *)from);
    lua_pushlightuserdata(lua, to);
    lua_pushlightuserdata(lua, &at);
    bool failed = lua_pcall(lua, 5, 0, 0) != 0;
    int64_t i = failed ? (int64_t)at : 0;
    while (!failed && i < n && isfinite(to[i][0] + to[i][1] + to[i][2])) i++;
    *bad = i;
    *why = failed ? message(lua) : i == n ? NULL : "";
}

tobi_status tobi_script_deform(tobi_script *script, double t, int64_t n, const double (*rest)[3],
                               double (*position)[3], tobi_error *err)
{
    int64_t i;
    const char *why;
    walk(script, t, n, rest, position, &i, &why);
    if (!why) return TOBI_OK;
    if (i >= n) return tobi_fail(err, TOBI_SCRIPT, "%s: %s", script->label, why);
    return tobi_fail(err, TOBI_SCRIPT,
                     "motion script %s: %s (t = %.9g s, rest point %.6g %.6g %.6g)", script->path,
                     *why ? why : "deform returned a number that is not finite", t, rest[i][0], rest[i][1],
                     rest[i][2]);
}

tobi_status tobi_script_flow(void *script, int64_t n, const double (*place)[3], double (*velocity)[3],
                             tobi_error *err)
{
    const tobi_script *s = script;
    int64_t i;
    const char *why;
    walk(script, 0, n, place, velocity, &i, &why);
    if (!why) return TOBI_OK;
    if (i >= n) i = 0;
    return tobi_fail(err, TOBI_SCRIPT, "flow script %s: %s (at %.6g %.6g %.6g m)", s->path,
                     *why ? why : "velocity returned a number that is not finite", place[i][0], place[i][1],
                     place[i][2]);
}

/* Axis to unit length; a turn needs one. */
static tobi_status set_turn(const tobi_script *script, double t, const double r[7], tobi_pose *pose,
                            tobi_error *err)
{
    double length = sqrt(r[3] * r[3] + r[4] * r[4] + r[5] * r[5]);
    pose->degrees = r[6];
    if (r[6] == 0.0) return TOBI_OK;
    if (!(length > 0.0))
        return tobi_fail(err, TOBI_SCRIPT,
                         "motion script %s: place returned a turn about a zero axis"
                         " (t = %.9g s)",
                         script->path, t);
    for (int a = 0; a < 3; a++) pose->axis[a] = r[3 + a] / length;
    return TOBI_OK;
}

tobi_status tobi_script_place(tobi_script *script, double t, tobi_pose *pose, tobi_error *err)
{
    lua_State *lua = script->lua;
    lua_settop(lua, 0);
    lua_rawgeti(lua, LUA_REGISTRYINDEX, script->place);
    lua_pushnumber(lua, t);
    if (lua_pcall(lua, 1, LUA_MULTRET, 0) != 0)
        return tobi_fail(err, TOBI_SCRIPT, "motion script %s: %s (t = %.9g s)", script->path,
                         message(lua), t);
    int count = lua_gettop(lua);
    bool good = count == 3 || count == 7;
    double r[7] = { 0 };
    for (int k = 0; good && k < count; k++) {
        r[k] = lua_tonumber(lua, k + 1);
        good = lua_type(lua, k + 1) == LUA_TNUMBER && isfinite(r[k]);
    }
    if (!good)
        return tobi_fail(err, TOBI_SCRIPT,
                         "motion script %s: place must return three finite numbers "
                         "(shift) or seven (shift, axis, degrees) (t = %.9g s)",
                         script->path, t);
    *pose = (tobi_pose){ .shift = { r[0], r[1], r[2] }, .axis = { 0.0, 0.0, 1.0 } };
    memcpy(pose->pivot, script->pivot, sizeof pose->pivot);
    return count == 7 ? set_turn(script, t, r, pose, err) : TOBI_OK;
}

tobi_status tobi_script_control(void *user, const tobi_control_input *in, tobi_control_output *out,
                                tobi_error *err)
{
    tobi_script *script = user;
    lua_State *lua = script->lua;
    double from[23] = { in->time }, into[7] = { 0, 0, 0, 0, 0, 0, in->phase };
    memcpy(from + 1, in->position, 3*sizeof *from);
    memcpy(from + 4, in->orientation, 4*sizeof *from);
    memcpy(from + 8, in->velocity, 3*sizeof *from);
    memcpy(from + 11, in->angular_velocity, 3*sizeof *from);
    memcpy(from + 14, in->contact_force, 3*sizeof *from);
    memcpy(from + 17, in->contact_torque, 3*sizeof *from);
    from[20] = in->mass;
    from[21] = in->phase;
    from[22] = in->phase_time;
    lua_settop(lua, 0);
    lua_rawgeti(lua, LUA_REGISTRYINDEX, script->control);
    lua_pushlightuserdata(lua, from);
    lua_pushlightuserdata(lua, into);
    if (lua_pcall(lua, 2, 1, 0) != 0)
        return tobi_fail(err, TOBI_SCRIPT, "%s: %s (t = %.9g s)", script->label, message(lua), in->time);
    for (int k = 0; k < 6; k++)
        if (!isfinite(into[k]))
            return tobi_fail(err, TOBI_SCRIPT, "%s: control returned a %s that is not finite (t = %.9g s)",
                             script->label, k < 3 ? "force" : "torque", in->time);
    snprintf(script->hold, sizeof script->hold, "%s",
             lua_type(lua, -1) == LUA_TSTRING ? lua_tostring(lua, -1) : "");
    memcpy(out->force, into, sizeof out->force);
    memcpy(out->torque, into + 3, sizeof out->torque);
    out->phase = (int)into[6];
    out->hold = script->hold;
    return TOBI_OK;
}
