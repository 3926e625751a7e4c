/* The process of a script: LuaJIT, and nothing else that can be reached.

   Two Lua environments live in one state: ours, with ffi, which walks the arrays of points, and the
   user's, with mathematics only. Because the walk is itself Lua, the user's function is compiled
   into it and runs at the speed of C. A timer of the process ends it wherever it is, inside a library
   function too. Where the script is at work in its own text, LuaJIT's profiler, which can interrupt at
   every line, finds the line first. Drawback: these checks cost compiled code up to a tenth.

   The optimiser's constant folding is off: it computes x^2 as x*x where the interpreter calls pow,
   and a restart, which begins interpreted, would not repeat the bits of a run that is compiled.

   Nothing that a script sees may differ from run to run: no addresses, and pairs() in the order of the keys
   (LuaJIT's own order depends on a random seed). */
#define _GNU_SOURCE 1
#include "rigid/script_process.h"
#include "base/error.h"
#include "base/limit.h"
#include <lauxlib.h>
#include <lua.h>
#include <luajit.h>
#include <lualib.h>
#include <math.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#define ADDRESS_SPACE ((uint64_t)1 << 29)      /* bytes beyond what is there: Lua's, and malloc's reserves */
#define GRACE_NS      200000000                /* for the line, after the time limit               */
#define DEPTH_LIMIT   50                       /* nesting of params                                */

typedef struct process {
    const tobi_script_job *job;
    tobi_script_channel *channel;
    lua_State *lua;
    size_t bytes;                              /* held by Lua now                                  */
    int walk, place, control;                  /* registry references                              */
    timer_t timer;
    volatile sig_atomic_t late;                /* signals of the timer during this request         */
} process;

/* Our side: gets the user's environment, returns the walks. `at` tells C which point is in work. */
static const char DRIVER[] =
    "local user, tr = ...\n"
    "local ffi, math, string, table = require('ffi'), math, string, table\n"
    "require('jit.opt').start('-fold')\n"
    "local error, type, rawget, next, select, unpack = error, type, rawget, next, select, unpack\n"
    "local tostring = tostring\n"
    "for _, name in ipairs{'ipairs', 'select', 'tonumber', 'type', 'unpack', 'error', 'assert'} do\n"
    "    user[name] = _G[name]\n"
    "end\n"
    "user.math, user.table, user.string = {}, {}, {}\n"
    "for k, v in pairs(math) do user.math[k] = v end\n"
    "user.math.random, user.math.randomseed = nil, nil\n"
    "for _, k in ipairs{'concat', 'insert', 'remove', 'sort', 'maxn'} do user.table[k] = table[k] end\n"
    "for _, k in ipairs{'len', 'sub', 'byte', 'char', 'lower', 'upper'} do\n"
    "    user.string[k] = string[k]\n"
    "end\n"
    "getmetatable('').__index = user.string\n"
    /* Addresses differ from run to run: of what has one, the kind is all there is to see. */
    "local addressed = { table = true, ['function'] = true, userdata = true, thread = true }\n"
    "local function text(v)\n"
    "    local kind = type(v)\n"
    "    return addressed[kind] and kind or tostring(v)\n"
    "end\n"
    "user.tostring = text\n"
    "function user.string.format(form, ...)\n"
    "    local given, n = { ... }, select('#', ...)\n"
    "    if type(form) == 'string' and string.find((string.gsub(form, '%%%%', '')), '%%[^%a]*p') then\n"
    "        error(tr'string.format knows no %p: addresses differ from run to run', 2)\n"
    "    end\n"
    "    for k = 1, n do if addressed[type(given[k])] then given[k] = type(given[k]) end end\n"
    "    return string.format(form, unpack(given, 1, n))\n"
    "end\n"
    "function user.pairs(t)\n"
    "    if type(t) ~= 'table' then error(string.format(tr'pairs needs a table, not %s', type(t)), 2) end\n"
    "    local keys, texts, i = {}, {}, 0\n"
    "    for k in next, t do\n"
    "        local kind = type(k)\n"
    "        if kind == 'number' then keys[#keys + 1] = k\n"
    "        elseif kind == 'string' then texts[#texts + 1] = k\n"
    "        elseif kind ~= 'boolean' then\n"
    "            error(string.format(tr('pairs has no order for a key that is a %s; ' ..\n"
    "                  'allowed are numbers, texts, true and false'), kind), 2)\n"
    "        end\n"
    "    end\n"
    "    table.sort(keys)\n"
    "    table.sort(texts)\n"
    "    for k = 1, #texts do keys[#keys + 1] = texts[k] end\n"
    "    keys[#keys + 1] = false\n"
    "    keys[#keys + 1] = true\n"
    "    return function()\n"
    "        repeat i = i + 1 until keys[i] == nil or rawget(t, keys[i]) ~= nil\n"
    "        if keys[i] ~= nil then return keys[i], t[keys[i]] end\n"
    "    end\n"
    "end\n"
    /* The names move to another table, so that assigning to one that exists is seen, too. */
    "local function seal(remembered)\n"
    "    local names = {}\n"
    "    for k, v in pairs(user) do names[k] = v end\n"
    "    for k in pairs(names) do user[k] = nil end\n"
    "    setmetatable(names, { __index = function(_, k)\n"
    "        error(string.format(tr\"unknown name '%s'\", text(k)), 2)\n"
    "    end })\n"
    "    setmetatable(user, { __index = names, __newindex = function(_, k)\n"
    "        error(string.format(tr(\"assignment to the global '%s': write local; from one time \" ..\n"
    "              \"to the next %s is remembered\"), text(k), remembered), 2)\n"
    "    end })\n"
    "end\n"
    "local f, h, walked\n"
    "local function bind(name, points, control) walked, f, h = name, points, control end\n"
    "local function walk(n, t, from, to, at, a, b, c)\n"
    "    local steer = { a, b, c }\n"
    "    from, to = ffi.cast('const double *', from), ffi.cast('double *', to)\n"
    "    at = ffi.cast('double *', at)\n"
    "    for i = 0, n - 1 do\n"
    "        local k = 3 * i\n"
    "        at[0] = i\n"
    "        local x, y, z, more = f(from[k], from[k + 1], from[k + 2], t, steer)\n"
    "        if type(x) ~= 'number' or type(y) ~= 'number' or type(z) ~= 'number' or more ~= nil then\n"
    "            error(string.format(tr'%s must return three numbers', walked), 0)\n"
    "        end\n"
    "        to[k], to[k + 1], to[k + 2] = x, y, z\n"
    "    end\n"
    "end\n"
    "local known = { force = true, torque = true, phase = true, hold = true,\n"
    "    steer = true, state = true, motor = true }\n"
    "local function take(value, name, into, first)\n"
    "    if value == nil then return end\n"
    "    if type(value) ~= 'table' or value[4] ~= nil then value = {} end\n"
    "    for k = 1, 3 do\n"
    "        if type(value[k]) ~= 'number' then\n"
    "            error(string.format(tr'control must return a %s of three numbers', name), 0)\n"
    "        end\n"
    "        into[first + k - 1] = value[k]\n"
    "    end\n"
    "end\n"
    /* Up to 16 numbers; those that it leaves out become 0. */
    "local function keep(value, into)\n"
    "    if value == nil then return end\n"
    "    if type(value) ~= 'table' or #value > 16 then value = { false } end\n"
    "    for k = 1, 16 do\n"
    "        local number = value[k] == nil and k > #value and 0 or value[k]\n"
    "        if type(number) ~= 'number' then\n"
    "            error(tr'control must return a state of at most 16 numbers', 0)\n"
    "        end\n"
    "        into[9 + k] = number\n"
    "    end\n"
    "end\n"
    /* joints = { NAME = { angle, speed } }, of a guide { position, speed }; a misspelt name is told. */
    "local missing = { __index = function(t, k)\n"
    "    local names = {}\n"
    "    for name in next, t do names[#names + 1] = name end\n"
    "    table.sort(names)\n"
    "    error(string.format(tr\"body has no joint '%s'; it has %s\", text(k),\n"
    "          #names > 0 and table.concat(names, ', ') or tr'none'), 2)\n"
    "end }\n"
    "local function list(names, from)\n"
    "    local joints = {}\n"
    "    for k = 1, #names do\n"
    "        local place = from[48 + 3 * k] == 1 and 'position' or 'angle'\n"
    "        joints[names[k]] = { [place] = from[46 + 3 * k], speed = from[47 + 3 * k] }\n"
    "    end\n"
    "    return setmetatable(joints, missing)\n"
    "end\n"
    "local function drive(motor, names, joints, into)\n"
    "    if motor == nil then return end\n"
    "    if type(motor) ~= 'table' then\n"
    "        error(tr'control must return a motor as { NAME = number }', 0)\n"
    "    end\n"
    "    for name, value in user.pairs(motor) do\n"
    "        local known = joints[name]\n"
    "        if type(value) ~= 'number' then\n"
    "            error(tr'control must return a motor as { NAME = number }', 0)\n"
    "        end\n"
    "        for k = 1, #names do if names[k] == name then into[25 + k] = value end end\n"
    "    end\n"
    "end\n"
    "local inputs = { __index = function(_, k)\n"
    "    error(string.format(tr(\"body has no '%s'; it has position, orientation, velocity, \" ..\n"
    "          'angular_velocity, contact_force, contact_torque, mass, inertia, phase, phase_time, ' ..\n"
    "          'step, steer, state and joints'), text(k)), 2)\n"
    "end }\n"
    "local function control(from, into, names)\n"
    "    from, into = ffi.cast('const double *', from), ffi.cast('double *', into)\n"
    "    local function three(k) return { from[k], from[k + 1], from[k + 2] } end\n"
    "    local function several(first, n)\n"
    "        local list = {}\n"
    "        for k = 1, n do list[k] = from[first + k - 1] end\n"
    "        return list\n"
    "    end\n"
    "    local joints = list(names, from)\n"
    "    local answer = h(from[0], setmetatable({ position = three(1),\n"
    "        orientation = { from[4], from[5], from[6], from[7] }, velocity = three(8),\n"
    "        angular_velocity = three(11), contact_force = three(14),\n"
    "        contact_torque = three(17), mass = from[20], phase = from[21],\n"
    "        phase_time = from[22], step = from[23], steer = three(24),\n"
    "        inertia = several(27, 6), state = several(33, 16), joints = joints },\n"
    "        inputs))\n"
    "    if answer == nil then return end\n"
    "    if type(answer) ~= 'table' then error(tr'control must return a table or nothing', 0) end\n"
    "    local unknown\n"
    "    for key in next, answer do\n"
    "        local word = not known[key] and text(key)\n"
    "        if word and (not unknown or word < unknown) then unknown = word end\n"
    "    end\n"
    "    if unknown then\n"
    "        error(string.format(tr(\"control returned the unknown key '%s'; \" ..\n"
    "              'allowed are force, torque, phase, hold, steer, state, motor'), unknown), 0)\n"
    "    end\n"
    "    take(answer.force, 'force', into, 0)\n"
    "    take(answer.torque, 'torque', into, 3)\n"
    "    take(answer.steer, 'steer', into, 7)\n"
    "    keep(answer.state, into)\n"
    "    drive(answer.motor, names, joints, into)\n"
    "    if answer.phase ~= nil then\n"
    "        if type(answer.phase) ~= 'number' or answer.phase % 1 ~= 0 or\n"
    "           math.abs(answer.phase) > 1e9 then\n"
    "            error(tr'control must return a whole number as phase', 0)\n"
    "        end\n"
    "        into[6] = answer.phase\n"
    "    end\n"
    "    if answer.hold ~= nil and type(answer.hold) ~= 'string' then\n"
    "        error(tr'control must return a text as hold', 0)\n"
    "    end\n"
    "    return answer.hold\n"
    "end\n"
    "return seal, bind, walk, control\n";

/* What it says, for the catalogue of texts. Values stay in the order of English: Lua has no %2$s. */
static const char *const said[] __attribute__((unused)) = {
    TR("string.format knows no %p: addresses differ from run to run"), TR("pairs needs a table, not %s"),
    TR("pairs has no order for a key that is a %s; allowed are numbers, texts, true and false"),
    TR("unknown name '%s'"),
    TR("assignment to the global '%s': write local; from one time to the next %s is remembered"),
    TR("%s must return three numbers"), TR("control must return a %s of three numbers"),
    TR("control must return a state of at most 16 numbers"), TR("body has no joint '%s'; it has %s"),
    TR("none"),
    TR("control must return a motor as { NAME = number }"),
    TR("body has no '%s'; it has position, orientation, velocity, angular_velocity, contact_force, "
       "contact_torque, mass, inertia, phase, phase_time, step, steer, state and joints"),
    TR("control must return a table or nothing"),
    TR("control returned the unknown key '%s'; allowed are force, torque, phase, hold, steer, state, motor"),
    TR("control must return a whole number as phase"), TR("control must return a text as hold")
};

static int translate(lua_State *lua)
{
    lua_pushstring(lua, tobi_text(luaL_checkstring(lua, 1)));
    return 1;
}

static void *allocate(void *user, void *p, size_t old, size_t size)
{
    process *s = user;
    if (!p) old = 0;
    if (size > old && s->bytes + (size - old) > TOBI_SCRIPT_MEMORY) return NULL;
    void *q = NULL;
    if (size == 0) free(p);
    else if (!(q = realloc(p, size))) return NULL;
    s->bytes += size - old;
    return q;
}

/* --- time --------------------------------------------------------------------------------- */

static _Noreturn void end_late(process *s)
{
    s->channel->reply = TOBI_REPLY_LATE;
    _exit(0);
}

/* The time is over. At the second signal the script has not reached a line of its text since the first. */
static void notice_time(int signal, siginfo_t *info, void *context)
{
    process *s = info->si_value.sival_ptr;
    (void)signal, (void)context;
    if (info->si_code == SI_TIMER && s->late++) end_late(s);      /* others may send the signal, too */
}

static void notice_line(void *user, lua_State *lua, int samples, int state)
{
    process *s = user;
    lua_Debug at;
    (void)samples, (void)state;
    for (int level = 0; s->late && lua_getstack(lua, level, &at); level++) {
        lua_getinfo(lua, "Sl", &at);
        if (at.currentline <= 0 || strcmp(at.source, "=driver") == 0) continue;
        snprintf(s->channel->text, sizeof s->channel->text, "%s:%d: ", at.short_src, at.currentline);
        end_late(s);
    }
}

static bool create_timer(process *s)
{
    struct sigevent event = { .sigev_notify = SIGEV_SIGNAL, .sigev_signo = SIGXCPU,
                              .sigev_value.sival_ptr = s };
    struct sigaction action = { .sa_sigaction = notice_time, .sa_flags = SA_SIGINFO | SA_RESTART };
    sigset_t blocked;
    sigfillset(&blocked);
    sigdelset(&blocked, SIGXCPU);
    sigdelset(&blocked, SIGPROF);      /* the profiler's */
    return sigaction(SIGXCPU, &action, NULL) == 0 && sigprocmask(SIG_SETMASK, &blocked, NULL) == 0 &&
           timer_create(CLOCK_PROCESS_CPUTIME_ID, &event, &s->timer) == 0;
}

static void start_timer(process *s)
{
    double whole = floor(s->job->seconds);
    struct itimerspec time = { .it_value = { (time_t)whole, (long)((s->job->seconds - whole)*1e9) },
                               .it_interval = { 0, GRACE_NS } };
    s->late = 0;
    timer_settime(s->timer, 0, &time, NULL);
}

/* --- loading ------------------------------------------------------------------------------ */

/* Leaves the Lua value of a JSON value on the stack; null is nil, arrays count from 1. */
static void push_json(lua_State *lua, const json_t *value, int depth)
{
    luaL_checkstack(lua, 4, "params");
    if (depth > DEPTH_LIMIT) luaL_error(lua, "%s", tr("params are nested too deeply"));
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

static void read_pivot(lua_State *lua, int user, double pivot[3])
{
    lua_getfield(lua, user, "pivot");
    if (!lua_isnil(lua, -1)) {
        if (!lua_istable(lua, -1)) luaL_error(lua, "%s", tr("pivot must be {x, y, z}"));
        for (int a = 0; a < 3; a++) {
            lua_rawgeti(lua, -1, a + 1);
            pivot[a] = lua_tonumber(lua, -1);
            if (lua_type(lua, -1) != LUA_TNUMBER || !isfinite(pivot[a]))
                luaL_error(lua, "%s", tr("pivot must be {x, y, z}, three finite numbers"));
            lua_pop(lua, 1);
        }
    }
    lua_pop(lua, 1);
}

/* Lua quotes the word at which it does not understand; in a file that is no script, any word. */
static int fail_syntax(lua_State *lua)
{
    const char *text = lua_tostring(lua, -1), *near = strstr(text, " near '"), *word = near ? near + 7 : NULL;
    if (!word || strlen(word) <= TOBI_EXCERPT + 1) return lua_error(lua);
    lua_pushlstring(lua, text, (size_t)(word - text));
    lua_pushstring(lua, tobi_excerpt(word).text);
    lua_pushstring(lua, "'");
    lua_concat(lua, 3);
    return lua_error(lua);
}

/* The user's functions that the role wants are there; they are bound to the walks. */
static int bind_functions(lua_State *lua, process *s, int user, int bind)
{
    const char *walked = s->job->role == TOBI_FLOW_SCRIPT ? "velocity" : "deform";
    lua_getfield(lua, user, "place");
    bool places = lua_isfunction(lua, -1);
    s->place = luaL_ref(lua, LUA_REGISTRYINDEX);
    lua_pushvalue(lua, bind);
    lua_pushstring(lua, walked);
    lua_getfield(lua, user, walked);
    lua_getfield(lua, user, "control");
    bool walks = lua_isfunction(lua, -2);
    if (s->job->role == TOBI_CONTROL_SCRIPT) {
        if (!lua_isfunction(lua, -1)) return luaL_error(lua, "%s", tr("define function control(t, body)"));
    } else if (s->job->role == TOBI_FLOW_SCRIPT) {
        if (!walks) return luaL_error(lua, "%s", tr("define function velocity(x, y, z)"));
    } else if (walks == places) {
        return luaL_error(lua, tr("define either function deform(x, y, z, t) or function place(t)%s"),
                          walks ? tr(", not both") : "");
    }
    s->channel->rigid = places;
    lua_call(lua, 3, 0);
    return 0;
}

/* Compiles and runs the user's text in its environment. */
static int load_protected(lua_State *lua)
{
    process *s = lua_touserdata(lua, 1);
    luaL_openlibs(lua);
    luaJIT_profile_start(lua, "li10", notice_line, s);
    lua_newtable(lua);
    int user = lua_gettop(lua), seal = user + 1, bind = user + 2;
    push_json(lua, s->job->params, 0);
    lua_setfield(lua, user, "params");

    if (luaL_loadbufferx(lua, DRIVER, sizeof DRIVER - 1, "=driver", "t")) return lua_error(lua);
    lua_pushvalue(lua, user);
    lua_pushcfunction(lua, translate);
    lua_call(lua, 2, 4);
    s->control = luaL_ref(lua, LUA_REGISTRYINDEX);
    s->walk = luaL_ref(lua, LUA_REGISTRYINDEX);

    if (luaL_loadbufferx(lua, s->job->text, s->job->length, s->job->name, "t")) return fail_syntax(lua);
    lua_pushvalue(lua, user);
    lua_setfenv(lua, -2);
    lua_call(lua, 0, 0);

    read_pivot(lua, user, s->channel->pivot);
    bind_functions(lua, s, user, bind);
    lua_pushvalue(lua, seal);
    lua_pushstring(lua, s->job->role == TOBI_CONTROL_SCRIPT
                        ? tr("only phase, steer and state, which control returns,") : tr("nothing"));
    lua_call(lua, 1, 0);
    return 0;
}

/* --- requests ----------------------------------------------------------------------------- */

static int call_walk(process *s)
{
    tobi_script_channel *c = s->channel;
    lua_rawgeti(s->lua, LUA_REGISTRYINDEX, s->walk);
    lua_pushnumber(s->lua, (double)c->count);
    lua_pushnumber(s->lua, c->time);
    lua_pushlightuserdata(s->lua, c->from);
    lua_pushlightuserdata(s->lua, c->to);
    lua_pushlightuserdata(s->lua, &c->at);
    for (int k = 0; k < 3; k++) lua_pushnumber(s->lua, c->steer[k]);
    return lua_pcall(s->lua, 8, 0, 0);
}

/* Answers that are no numbers become NAN, which the other side refuses. */
static int call_place(process *s)
{
    lua_rawgeti(s->lua, LUA_REGISTRYINDEX, s->place);
    lua_pushnumber(s->lua, s->channel->time);
    int code = lua_pcall(s->lua, 1, LUA_MULTRET, 0);
    s->channel->count = lua_gettop(s->lua);
    for (int k = 0; code == 0 && k < s->channel->count && k < 7; k++) {
        bool number = lua_type(s->lua, k + 1) == LUA_TNUMBER;
        s->channel->to[k/3][k%3] = number ? lua_tonumber(s->lua, k + 1) : NAN;
    }
    return code;
}

static int call_control(process *s)
{
    tobi_script_channel *c = s->channel;
    lua_rawgeti(s->lua, LUA_REGISTRYINDEX, s->control);
    lua_pushlightuserdata(s->lua, c->from);
    lua_pushlightuserdata(s->lua, c->to);
    lua_newtable(s->lua);
    for (int k = 0; k < c->count && k < TOBI_CONTROL_JOINTS; k++) {
        lua_pushstring(s->lua, c->joint[k]);
        lua_rawseti(s->lua, -2, k + 1);
    }
    int code = lua_pcall(s->lua, 3, 1, 0);
    const char *hold = code == 0 && lua_type(s->lua, -1) == LUA_TSTRING ? lua_tostring(s->lua, -1) : "";
    if (code == 0) snprintf(c->hold, sizeof c->hold, "%s", hold);
    return code;
}

static int call(process *s)
{
    if (s->lua) lua_settop(s->lua, 0);
    switch (s->channel->request) {
    case TOBI_REQUEST_WALK: return call_walk(s);
    case TOBI_REQUEST_PLACE: return call_place(s);
    case TOBI_REQUEST_CONTROL: return call_control(s);
    case TOBI_REQUEST_LOAD: break;
    }
    s->lua = lua_newstate(allocate, s);
    return s->lua ? lua_cpcall(s->lua, load_protected, s) : LUA_ERRMEM;
}

static void serve(process *s)
{
    tobi_script_channel *c = s->channel;
    c->text[0] = '\0';
    start_timer(s);
    int code = call(s);
    if (code != 0 && code != LUA_ERRMEM)
        /* Numbers are left out: converting one allocates, unprotected here. */
        snprintf(c->text, sizeof c->text, "%s",
                 lua_type(s->lua, -1) == LUA_TSTRING ? lua_tostring(s->lua, -1)
                 : tr("an error without a text"));
    c->reply = code == 0 ? TOBI_REPLY_DONE : code == LUA_ERRMEM ? TOBI_REPLY_FULL : TOBI_REPLY_FAILED;
}

/* No files, no children; of the descriptors only the socket is left, as 0. */
static void restrict_process(int fd)
{
    tobi_limit_memory(ADDRESS_SPACE);
    dup2(fd, 0);
#ifdef __SANITIZE_ADDRESS__      /* its reports go to 2 */
    close(1);
    closefrom(3);
#else
    closefrom(1);
#endif
    static const int none[] = { RLIMIT_NOFILE, RLIMIT_FSIZE, RLIMIT_NPROC };
    for (size_t k = 0; k < sizeof none/sizeof *none; k++) setrlimit(none[k], &(struct rlimit){ 0, 0 });
}

_Noreturn void tobi_script_serve(const tobi_script_job *job, tobi_script_channel *channel, int fd)
{
    process s = { .job = job, .channel = channel };
    char byte = 0;
    restrict_process(fd);
    if (!create_timer(&s)) _exit(1);
    do serve(&s);
    while (send(0, &byte, 1, MSG_NOSIGNAL) == 1 && recv(0, &byte, 1, 0) == 1);
    _exit(0);
}
