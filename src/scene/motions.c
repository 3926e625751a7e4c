/* A motion is a script, keyframes or numbers, or a list of them: turns first, then all shifts. Drawback: what
   the kinds share, as times, stands in the table of each. */
#define _GNU_SOURCE 1
#include "scene/scene.h"
#include "scene/parts.h"
#include "scene/write.h"
#include "base/param_rows.h"
#include "base/param.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of what goes on at one speed, and of what swings. */
#define TIMES(def) \
    { .key = "start", REAL, AT(def, times.start), RANGE(-1e9, 1e9), .unit = "s", \
      .doc = "Until then it rests." }, \
    { .key = "stop", REAL, AT(def, times.stop), DURATION, .unit = "s", .text = "never", \
      .doc = "From then on it rests where it is." }, \
    { .key = "ramp", REAL, AT(def, times.ramp), RANGE(0, 1e9), .unit = "s", \
      .doc = "Its speed rises like (1 - cos(pi s/ramp))/2 in so many seconds after start, and falls so " \
             "before stop." }
#define RISE(def) \
    { .key = "start", REAL, AT(def, times.start), RANGE(-1e9, 1e9), .unit = "s", \
      .doc = "Until then it rests; the sine counts from time 0 all the same." }, \
    { .key = "ramp", REAL, AT(def, times.ramp), RANGE(0, 1e9), .unit = "s", \
      .doc = "Its amplitude rises like (1 - cos(pi s/ramp))/2 in so many seconds after start." }

static const tobi_param script_rows[] = {
    { .key = "script",
      TEXT, AT(tobi_script_def, script),
      .unit = "path",
      .required = true,
      .doc = "A Lua file that says where every point of the body is at a time; the object "
             "`params` beside this key is handed to it." },
    { 0 }
};
static const tobi_param translation_rows[] = {
    { .key = "velocity", VEC3, AT(tobi_translation_def, velocity), SPEED, .unit = "m/s", .required = true,
      .doc = "Constant velocity." },
    TIMES(tobi_translation_def),
    { 0 }
};
static const tobi_param rotation_rows[] = {
    { .key = "centre", VEC3, AT(tobi_rotation_def, center), PLACE, .unit = "m", .required = true,
      .doc = "A point on the axis." },
    { .key = "axis", VEC3, AT(tobi_rotation_def, axis), DIRECTION, .unit = "1", .def = { 0, 0, 1 },
      .doc = "Direction of the axis, of any length." },
    { .key = "rate", REAL, AT(tobi_rotation_def, rate), RANGE(-1e9, 1e9),
      .unit = "degrees/s", .required = true,
      .doc = "Speed of the turn, by the right-hand rule." },
    TIMES(tobi_rotation_def),
    { 0 }
};
static const tobi_param oscillation_rows[] = {
    { .key = "direction", VEC3, AT(tobi_oscillation_def, direction), DIRECTION, .unit = "1", .required = true,
      .doc = "Direction of the movement, of any length." },
    { .key = "amplitude", REAL, AT(tobi_oscillation_def, amplitude), PLACE, .unit = "m", .required = true,
      .doc = "Largest distance from the rest position: it moves by amplitude sin(2 pi frequency t "
             "+ phase)." },
    { .key = "frequency", REAL, AT(tobi_oscillation_def, frequency), RANGE(-1e9, 1e9),
      .unit = "Hz", .required = true,
      .doc = "Cycles per second." },
    { .key = "phase", REAL, AT(tobi_oscillation_def, phase), RANGE(-1e9, 1e9), .unit = "degrees",
      .doc = "Phase at time 0." },
    RISE(tobi_oscillation_def),
    { 0 }
};
#define SWING(measure) \
    { .key = "amplitude", REAL, AT(tobi_degree_def, amplitude), PLACE, .unit = measure, .required = true, \
      .doc = "It moves by amplitude sin(2 pi t/period + phase)." }, \
    { .key = "period", REAL, AT(tobi_degree_def, period), DURATION, .unit = "s", .required = true, \
      .doc = "Time of one cycle." }, \
    { .key = "phase", REAL, AT(tobi_degree_def, phase), RANGE(-1e9, 1e9), .unit = "degrees", \
      .doc = "Phase at time 0." }, \
    RISE(tobi_degree_def)
static const tobi_param shift_rows[] = { SWING("m"), { 0 } };
static const tobi_param turn_rows[] = {
    { .key = "centre", VEC3, AT(tobi_degree_def, center), PLACE, .unit = "m",
      .doc = "A point on the axis of the turn." },
    SWING("degrees"),
    { 0 }
};
static const tobi_param keyframes_rows[] = {
    { .key = "file",
      TEXT, AT(tobi_keyframes_def, file),
      .unit = "path",
      .required = true,
      .doc = "A CSV file whose first line names its columns: time (s), the shift x, y, z from the rest "
             "pose (m), and for a turn qw, qx, qy, qz or ax, ay, az, angle (degrees) or roll, pitch, yaw "
             "(degrees, about x, then y, then z). A name may bring a unit along, as in x [mm]: m, cm, mm, s, "
             "ms, min, h, degrees, deg, rad. Cubic between the rows; before the first and after the last "
             "the body stays." },
    { .key = "pivot", VEC3, AT(tobi_keyframes_def, pivot), PLACE, .unit = "m",
      .doc = "The point of the rest pose that turns are about." },
    { 0 }
};

#define WAVE AT(tobi_wave_maker_def,
#define HEIGHTS RANGE(1e-6, 1e4), .unit = "m", .text = "none"
#define MAKER \
    { .key = "direction", VEC3, WAVE direction), .def = { 1, 0, 0 }, DIRECTION, .unit = "1", \
      .doc = "Where the waves go, of any length." }, \
    { .key = "depth", REAL, WAVE depth), LENGTHS, .unit = "m", .required = true, \
      .doc = "Depth of the still water." }, \
    { .key = "gravity", REAL, WAVE gravity), RANGE(1e-6, 1e6), .unit = "m/s2", \
      .text = "that of the scene", .doc = "Size of gravity, for the theory." }, \
    { .key = "regular.height", REAL, WAVE height), HEIGHTS, \
      .doc = "Height of regular waves from trough to crest, by Biesel's transfer function. One of the " \
             "kinds of waves is given." }, \
    { .key = "regular.period", REAL, WAVE period), DURATION, .unit = "s", .text = "none", \
      .doc = "Their period." }, \
    { .key = "regular.phase", REAL, WAVE phase), RANGE(-1e9, 1e9), .unit = "degrees", \
      .doc = "Phase of the displacement at time 0." }, \
    { .key = "irregular.height", REAL, WAVE significant_height), HEIGHTS, \
      .doc = "Significant height of irregular waves, 4 sqrt(m0)." }, \
    { .key = "irregular.peak_period", REAL, WAVE peak_period), DURATION, .unit = "s", .text = "none", \
      .doc = "Period of the peak of their spectrum." }, \
    { .key = "irregular.spectrum", CHOICE("jonswap|pierson-moskowitz", 2), WAVE spectrum), \
      .doc = "The shape of their spectrum." }, \
    { .key = "irregular.peakedness", REAL, WAVE peakedness), .def = { 3.3 }, RANGE(1, 10), .unit = "1", \
      .doc = "Gamma of jonswap." }, \
    { .key = "irregular.seed", INT, WAVE seed), .def = { 1 }, RANGE(0, 2147483647), .unit = "1", \
      .doc = "Another number, other phases of the same spectrum." }, \
    { .key = "irregular.components", INT, WAVE components), .def = { 100 }, RANGE(1, 10000), .unit = "1", \
      .doc = "How many regular waves they are the sum of, between 0.5 and 3 peak frequencies." }, \
    { .key = "focused.height", REAL, WAVE focused_height), HEIGHTS, \
      .doc = "Height above still water of the highest crest of a focused group." }, \
    { .key = "focused.distance", REAL, WAVE focus_distance), RANGE(0, 1e7), .unit = "m", .text = "none", \
      .doc = "How far in front of the maker its crests meet." }, \
    { .key = "focused.time", REAL, WAVE focus_time), RANGE(-1e9, 1e9), .unit = "s", \
      .doc = "When they meet. Waves must have come so far by then." }, \
    { .key = "focused.peak_period", REAL, WAVE peak_period), DURATION, .unit = "s", .text = "none", \
      .doc = "Period of the peak of its spectrum." }, \
    { .key = "focused.spectrum", CHOICE("jonswap|pierson-moskowitz", 2), WAVE spectrum), \
      .doc = "The shape of its spectrum. Amplitudes go with the density (NewWave)." }, \
    { .key = "focused.peakedness", REAL, WAVE peakedness), .def = { 3.3 }, RANGE(1, 10), .unit = "1", \
      .doc = "Gamma of jonswap." }, \
    { .key = "focused.components", INT, WAVE components), .def = { 100 }, RANGE(1, 10000), .unit = "1", \
      .doc = "How many regular waves it is the sum of, between 0.5 and 3 peak frequencies. Their sum comes " \
             "again after their number over 2.5, in peak periods." }, \
    { .key = "recorded.file", TEXT, WAVE record_file), .unit = "path", \
      .doc = "A CSV file with the columns time (s) and level (m): waves whose level was measured. Its " \
             "times are those of the run, and its mean is still water. Other columns are not read." }, \
    { .key = "recorded.column", TEXT, WAVE record_column), .unit = "name", .text = "level", \
      .doc = "The name of the column with the level, without its unit, as G1_level of a probes.csv." }, \
    { .key = "recorded.distance", REAL, WAVE record_distance), RANGE(0, 1e7), .unit = "m", \
      .doc = "How far in front of the maker it was measured." }, \
    { .key = "recorded.longest_period", REAL, WAVE longest_period), DURATION, .unit = "s", \
      .text = "automatic", \
      .doc = "Longer waves of the record are left out. Automatic is twice the period of its peak." }, \
    { .key = "recorded.shortest_period", REAL, WAVE shortest_period), DURATION, .unit = "s", \
      .text = "automatic", \
      .doc = "Shorter waves of the record are left out. Automatic is a third of the period of its peak." }, \
    { .key = "start", REAL, WAVE start), RANGE(-1e9, 1e9), .unit = "s", .doc = "Until then it rests." }, \
    { .key = "ramp", REAL, WAVE ramp), RANGE(0, 1e9), .unit = "s", \
      .doc = "Displacements rise like (1 - cos(pi s/ramp))/2 in so many seconds after start; not those of " \
             "a solitary wave." }
static const tobi_param piston_rows[] = {
    MAKER,
    { .key = "regular.order", INT, WAVE order), .def = { 1 }, RANGE(1, 2), .unit = "1",
      .doc = "2 adds what takes away the free second harmonic (Madsen 1971)." },
    { .key = "absorb", BOOL, WAVE absorb),
      .doc = "Whether the piston absorbs waves that come back, by the level a quarter of the depth in front "
             "of it. Such a piston may make no waves itself." },
    { .key = "absorb_period", REAL, WAVE absorb_period), DURATION, .unit = "s", .text = "its own",
      .doc = "Period of the waves that it absorbs best: that of its own waves, or long ones if it makes "
             "none." },
    { .key = "solitary.height", REAL, WAVE solitary_height), HEIGHTS,
      .doc = "Height of one solitary wave above the still water, by Goring 1978." },
    { 0 }
};
static const tobi_param flap_rows[] = {
    MAKER,
    { .key = "hinge", VEC3, WAVE hinge), PLACE, .unit = "m", .required = true,
      .doc = "A point of the axis that the flap turns about." },
    { .key = "hinge_height", REAL, WAVE hinge_height), PLACE, .unit = "m",
      .doc = "How far the hinge is above the bottom of the water; negative below." },
    { 0 }
};

static const tobi_param_table tables[] = {
    { "script", "motion: a user's program in Lua, for rigid and deforming bodies.",
      sizeof(tobi_script_def), script_rows },
    { "translation", "motion.translation: constant velocity.", sizeof(tobi_translation_def),
      translation_rows },
    { "rotation", "motion.rotation: a constant turn about a fixed axis.", sizeof(tobi_rotation_def),
      rotation_rows },
    { "oscillation", "motion.oscillation: to and fro along a line.", sizeof(tobi_oscillation_def),
      oscillation_rows },
    { "keyframes", "motion.keyframes: rows of a CSV file.", sizeof(tobi_keyframes_def), keyframes_rows },
    { "surge", "motion.surge: to and fro along x.", sizeof(tobi_degree_def), shift_rows },
    { "sway", "motion.sway: to and fro along y.", sizeof(tobi_degree_def), shift_rows },
    { "heave", "motion.heave: to and fro along z.", sizeof(tobi_degree_def), shift_rows },
    { "roll", "motion.roll: to and fro about an axis along x.", sizeof(tobi_degree_def), turn_rows },
    { "pitch", "motion.pitch: to and fro about an axis along y.", sizeof(tobi_degree_def), turn_rows },
    { "yaw", "motion.yaw: to and fro about an axis along z.", sizeof(tobi_degree_def), turn_rows },
    { "piston", "motion.piston: a wave maker that shifts; regular, solitary, irregular, focused or "
      "recorded waves.",
      sizeof(tobi_wave_maker_def), piston_rows },
    { "flap", "motion.flap: a wave maker that turns about a hinge; regular, irregular, focused or "
      "recorded waves.",
      sizeof(tobi_wave_maker_def), flap_rows }
};
enum { SCRIPT, TRANSLATION, ROTATION, OSCILLATION, KEYFRAMES, SURGE, ROLL = SURGE + 3,
       PISTON = ROLL + 3, FLAP };
enum { TABLE_COUNT = sizeof tables / sizeof tables[0] };

const tobi_param_table *tobi_motion_table(int index)
{
    return index >= 0 && index < TABLE_COUNT ? &tables[index] : NULL;
}

/* The motions that have the key, as "translation, rotation". */
static void list_owners(const char *key, char *text, size_t size)
{
    size_t used = 0;
    *text = '\0';
    for (int i = 0; i < TABLE_COUNT; i++)
        for (const tobi_param *row = tables[i].rows; row->key && used < size; row++)
            if (strcmp(row->key, key) == 0)
                used += (size_t)snprintf(text + used, size - used, "%s%s", used ? ", " : "", tables[i].name);
}

static int is_motion(const char *name)
{
    for (int i = 0; name && i < TABLE_COUNT; i++)
        if (strcmp(name, tables[i].name) == 0) return 1;
    return 0;
}

static void report_unknown(const tobi_binder *binder, const tobi_place *at, const json_t *value,
                           const char *const *keys, int count, const char *all)
{
    const char *near = tobi_suggest(at->key, keys, (size_t)count), *text = json_string_value(value);
    char owners[200];
    if (tobi_report_pass(binder->source->report)) return;
    list_owners(at->key, owners, sizeof owners);
    if (is_motion(text))
        tobi_source_mistake_at_key(binder->source, at, "unknown key; a motion is a key of its own: \"%s\": "
                                   "{ ... }", text);
    else if (*owners)
        tobi_source_mistake_at_key(binder->source, at, "unknown key; it belongs into the object of %s",
                                   owners);
    else if (near)
        tobi_source_mistake_at_key(binder->source, at, "unknown key; did you mean \"%s\"?", near);
    else
        tobi_source_mistake_at_key(binder->source, at, "unknown key; allowed here: %s; params with a script",
                                   all);
}

/* Finds which motion the object is; reports unknown keys and none or several motions. */
static const tobi_param_table *choose_table(const tobi_binder *binder, json_t *value,
                                            const tobi_place *place)
{
    const char *keys[TABLE_COUNT + 1] = { "params" };
    char all[400] = "";
    for (size_t i = 0, used = 0; i < TABLE_COUNT; i++) {
        keys[i + 1] = tables[i].name;
        if (used < sizeof all)
            used += (size_t)snprintf(all + used, sizeof all - used, "%s%s", i ? ", " : "",
                                     tables[i].name);
    }
    const tobi_param_table *chosen = NULL;
    int count = 0, unknown = 0;
    const char *key;
    json_t *member;
    json_object_foreach(value, key, member) {
        tobi_place at = { place, key, 0 };
        int known = strcmp(key, "params") == 0;
        for (int i = 0; i < TABLE_COUNT; i++) {
            if (strcmp(key, tables[i].name) != 0) continue;
            chosen = &tables[i];
            known = 1;
            count++;
        }
        if (known || json_object_get(value, "script")) continue;     /* a script checks its own */
        unknown = 1;
        report_unknown(binder, &at, member, keys, sizeof keys / sizeof keys[0], all);
    }
    if (count == 1) return chosen;
    if (count > 1 || !unknown)
        tobi_source_mistake(binder->source, place,
                            "must have exactly one of %s; it has %d", all, count);
    return NULL;
}

static tobi_status create_script(const tobi_motion_def *def, tobi_motion **motion, tobi_error *err)
{
    char *params = def->params ? json_dumps(def->params, 0) : NULL;
    if (def->params && !params) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the scene");
    tobi_status status = tobi_motion_script(def->as.script.script, params, motion, err);
    free(params);
    return status;
}

/* Against gravity is along the last axis of the scene. */
static tobi_status create_wave_maker(const tobi_motion_def *def, int flap, tobi_motion **motion,
                                     tobi_error *err)
{
    tobi_wave_maker_def waves = def->as.waves;
    if (!(waves.gravity > 0)) waves.gravity = def->gravity;
    waves.flap = flap;
    waves.up[def->dimension - 1] = 1;
    return tobi_motion_wave_maker(&waves, motion, err);
}

static tobi_status create_kind(const tobi_motion_def *def, int kind, tobi_motion **motion, tobi_error *err)
{
    const tobi_rotation_def *turn = &def->as.rotation;
    const tobi_oscillation_def *swing = &def->as.oscillation;
    const tobi_degree_def *degree = &def->as.degree;
    const int axis = (kind - SURGE)%3;
    const double along[3] = { axis == 0, axis == 1, axis == 2 };
    switch (kind) {
    case SCRIPT: return create_script(def, motion, err);
    case TRANSLATION: return tobi_motion_translation(def->as.translation.velocity, motion, err);
    case ROTATION: return tobi_motion_rotation(turn->center, turn->axis, turn->rate, motion, err);
    case KEYFRAMES:
        return tobi_motion_keyframes(def->as.keyframes.file, def->as.keyframes.pivot, motion, err);
    case OSCILLATION:
        return tobi_motion_oscillation(swing->direction, swing->amplitude, swing->frequency, swing->phase,
                                       motion, err);
    }
    if (kind >= PISTON) return create_wave_maker(def, kind == FLAP, motion, err);
    const double rate = 1/degree->period;
    if (kind < ROLL)
        return tobi_motion_oscillation(along, degree->amplitude, rate, degree->phase, motion, err);
    return tobi_motion_swing(degree->center, along, degree->amplitude, rate, degree->phase, motion, err);
}

static tobi_status create_motion(const tobi_motion_def *def, tobi_motion **motion, tobi_error *err)
{
    const int kind = (int)(def->table - tables);
    const tobi_times_def *times = kind == TRANSLATION   ? &def->as.translation.times
                                  : kind == ROTATION    ? &def->as.rotation.times
                                  : kind == OSCILLATION ? &def->as.oscillation.times
                                  : kind >= SURGE && kind < PISTON ? &def->as.degree.times : NULL;
    TOBI_TRY(create_kind(def, kind, motion, err));
    if (!times) return TOBI_OK;
    const tobi_status status = tobi_motion_set_times(
        *motion, times->start, times->stop != 0 ? times->stop : INFINITY, times->ramp, err);
    if (status == TOBI_OK) return TOBI_OK;
    tobi_motion_free(*motion);
    *motion = NULL;
    return status;
}

/* Motions that leave the plane of a 2-D scene. */
static void check_plane(const tobi_binder *binder, const tobi_param_table *table, const tobi_place *place)
{
    const int kind = (int)(table - tables);
    if (binder->dimension == 2 && (kind == SURGE + 2 || kind == ROLL || kind == ROLL + 1))
        tobi_source_mistake_at_key(binder->source, place,
                                   "leaves the plane of a 2-D scene, which has surge, sway and yaw");
}

static tobi_motion *bind_one(const tobi_binder *binder, json_t *value, const tobi_place *place,
                             tobi_motion_def *def)
{
    const char *beside_script[TOBI_PARTS];
    tobi_part_keys("script", beside_script);
    *def = (tobi_motion_def){ .dimension = binder->dimension, .gravity = binder->gravity };
    int64_t before = tobi_report_total(binder->source->report);
    if (!json_is_object(value)) {
        tobi_source_mistake(binder->source, place, "is %s, must be an object { ... }",
                            tobi_json_kind(value));
        return NULL;
    }
    const tobi_param_table *table = choose_table(binder, value, place);
    if (!table) return NULL;
    tobi_param_defaults(table, &def->as);
    tobi_place inner = { place, table->name, 0 }, params = { place, "params", 0 };
    def->params = json_object_get(value, "params");
    const int script = table == &tables[0];
    const tobi_bound bound = tobi_bind(binder, table, script ? value : json_object_get(value, table->name),
                                       script ? place : &inner, script ? beside_script : NULL, &def->as);
    check_plane(binder, table, &inner);
    if (def->params && !script)
        tobi_source_mistake_at_key(binder->source, &params,
                                   "params belong to a script; %s takes none", table->name);
    else if (def->params && !json_is_object(def->params))
        tobi_source_mistake(binder->source, &params, "is %s, must be an object { ... }",
                            tobi_json_kind(def->params));
    if (tobi_report_total(binder->source->report) > before) return NULL;

    tobi_motion *motion = NULL;
    tobi_error err = { 0 };
    def->table = table;
    if (create_motion(def, &motion, &err) != TOBI_OK)
        tobi_source_mistake(binder->source, &inner, "%s", err.text);
    else tobi_unused_check_motion(binder->source, table, &inner, &def->as, bound);
    return motion;
}

static tobi_motion *add_up(const tobi_binder *binder, const tobi_place *place, tobi_motion **part, int count)
{
    tobi_motion *sum = NULL;
    tobi_error err = { 0 };
    if (tobi_motion_sum(part, count, &sum, &err) == TOBI_OK) return sum;
    tobi_source_mistake(binder->source, place, "%s", err.text);
    return NULL;
}

tobi_motion *tobi_motion_bind(const tobi_binder *binder, json_t *value, const tobi_place *place,
                              tobi_motion_def *def)
{
    tobi_motion *part[TOBI_MOTION_LIMIT], *sum = NULL;
    if (!json_is_array(value)) return bind_one(binder, value, place, def);
    const int count = (int)json_array_size(value);
    if (count < 1 || count > TOBI_MOTION_LIMIT) {
        tobi_source_mistake(binder->source, place, "has %d motions, allowed are 1 to %d", count,
                            TOBI_MOTION_LIMIT);
        return NULL;
    }
    int made = 0;
    for (int k = 0; k < count; k++) {
        const tobi_place entry = { place, NULL, (size_t)k };
        part[k] = bind_one(binder, json_array_get(value, (size_t)k), &entry, &def[k]);
        made += part[k] != NULL;
    }
    if (made == count) sum = add_up(binder, place, part, count);
    for (int k = 0; k < count && !sum; k++) tobi_motion_free(part[k]);
    return sum;
}

static json_t *write_one(const tobi_motion_def *def)
{
    json_t *own = tobi_write_def(def->table, &def->as), *motion = own;
    int failed = !own;
    tobi_unused_drop(NULL, def->table, &def->as, own);
    if (def->table == &tables[0]) {
        if (def->params) failed |= json_object_set(own, "params", def->params);
    } else {
        motion = json_object();
        failed |= json_object_set_new(motion, def->table->name, own);
    }
    if (!failed) return motion;
    json_decref(motion);
    return NULL;
}

json_t *tobi_motion_write(const tobi_motion_def *def)
{
    if (!def[0].table) return NULL;
    if (!def[1].table) return write_one(def);
    json_t *list = json_array();
    int failed = !list;
    for (int k = 0; k < TOBI_MOTION_LIMIT && def[k].table; k++)
        failed |= json_array_append_new(list, write_one(&def[k]));
    if (!failed) return list;
    json_decref(list);
    return NULL;
}

int tobi_motion_absorbs(const tobi_motion_def *def)
{
    for (int k = 0; k < TOBI_MOTION_LIMIT && def[k].table; k++)
        if (strcmp(def[k].table->name, "piston") == 0 && def[k].as.waves.absorb) return 1;
    return 0;
}
