/* What each key of the tank program's files means. Keys with a unit are read; the others are only told.
   Drawback: the sentences about keys that the program passed over repeat what its users know. */
#include "base/language.h"
#include "scene/import/tank.h"
#include <math.h>
#include <string.h>

#define K(name_) .param.key = name_
#define IN(type_, member_) .param.offset = offsetof(type_, member_)
#define REAL .param.type = TOBI_PARAM_REAL, .param.min = NAN, .param.max = NAN
#define POSITIVE .param.type = TOBI_PARAM_REAL, .param.min = 0, .param.max = NAN, .param.positive = true
#define VEC3 .param.type = TOBI_PARAM_VEC3, .param.min = NAN, .param.max = NAN
#define INT(a, b) .param.type = TOBI_PARAM_INT, .param.min = (a), .param.max = (b), .param.unit = "1"
#define TEXT(u) .param.type = TOBI_PARAM_TEXT, .param.min = NAN, .param.max = NAN, .param.unit = u
#define UNIT(u) .param.unit = (u)
#define BECOMES(b) .becomes = (b)
#define SAY(text) .param.doc = (text)
#define NEEDED .param.required = true

#define S(m) IN(tobi_tank_setting, m)
static const tobi_old_key setting_keys[] = {
    { K("particle_spacing"), S(spacing), POSITIVE, UNIT("m"), BECOMES("spacing"), NEEDED,
      SAY("distance of particles") },
    { K("CSML"), S(support), .param.type = TOBI_PARAM_REAL, .param.min = 2, .param.max = 4, UNIT("spacings"),
      BECOMES("isph.support"), SAY("radius at which the kernel is 0, as before"),
      .absent = "the method chooses the support" },
    { K("max_dt"), S(max_dt), POSITIVE, UNIT("s"), BECOMES("time_step_max"), NEEDED,
      SAY("the longest step; the first 10 steps were a hundredth of it, now they need not be") },
    { K("end_time"), S(end_time), POSITIVE, UNIT("s"), BECOMES("end_time"), NEEDED,
      SAY("where the run ends") },
    { K("end_time_step"), S(end_step), INT(1, 2000000000), BECOMES("end_time"), .unit = "s",
      SAY("the run ends after so many steps of max_dt, if that is sooner than end_time") },
    { K("RK_order"), S(order), INT(1, 4),
      SAY("isph is of order 2 in time with one pressure per step; see isph.time_order") },
    { K("initial_surface_z_position"), S(level), REAL, UNIT("m"),
      SAY("made the first pressure; now the first pressure is solved for") },
    { K("output_directory"), S(directory), TEXT("text"),
      SAY("results go to out/NAME, or where --out says") },
    { K("input_files"), SAY("one entry of fluids, bodies or probes each, below; what several claim is solid "
                            "before it is water, where the first in the list had it") },
    { .param.key = NULL }
};

#define O(m) IN(tobi_tank_object, m)
static const tobi_old_key object_keys[] = {
    { K("name"), O(name), TEXT("text"), BECOMES(".name"), NEEDED,
      SAY("of the object; spaces and signs become _") },
    { K("type"), O(type), TEXT("text"), NEEDED,
      SAY("Fluid, RigidBody or probe; now an entry of fluids, bodies or probes") },
    { K("objfile"), O(file), TEXT("text"), BECOMES(".mesh"),
      SAY("looked for by its last folders and its name beside the setting, in the working directory, in the "
          "folders above") },
    { K("location"), O(location), VEC3, UNIT("m"), BECOMES(".position"),
      SAY("at a wall the pressure on the wall, a mean over a disc of one spacing; it was a mean within 3.1 "
          "spacings") },
    { K("inactivate"), BECOMES(".absent"), SAY("between these times the body is not there") },
    { K("inactive"), BECOMES(".absent"), SAY("between these times the body is not there") },
    { K("ignore"), SAY("true leaves the object out, as programs of 2021 and 2022 did") },
    { .param.key = NULL }
};

const tobi_old_section
    tobi_tank_setting_section = { "setting.json", setting_keys, sizeof(tobi_tank_setting) },
    tobi_tank_object_section = { "the object", object_keys, sizeof(tobi_tank_object) };

static const char wave_codes[] =
    TR("of the wave codes: the tank program's bodies never moved; give a motion");
static const char older[] = TR("of the programs of 2021 and 2022; the tank program passes over it");

static const struct { const char *key, *remark; } passed_over[] = {
    { "velocity", wave_codes }, { "acceleration", wave_codes }, { "COM", wave_codes },
    { "isFixed", TR("every body was fixed, and is") },
    { "output_vtu_file_name", TR("results are named by the method's own rules") },
    { "output_pvd_file_name", TR("results are named by the method's own rules") },
    { "density", older }, { "mu", older }, { "initial_surface_height", older }, { "xbounds", older },
    { "ybounds", older }, { "zbounds", older }, { "total_volume", older }, { "volume_of_a_particle", older },
    { "rotate", older }, { "scale", older }, { "translate", older }, { "reverseNormal", older },
    { "depth_list", older },
};

const char *tobi_tank_passed_over(const char *key)
{
    static const char *const begins[] = { "C_", "kNS", "preparation_", "buckets_" };
    for (size_t k = 0; k < sizeof passed_over/sizeof *passed_over; k++)
        if (strcmp(passed_over[k].key, key) == 0) return passed_over[k].remark;
    for (size_t k = 0; k < sizeof begins/sizeof *begins; k++)
        if (strncmp(begins[k], key, strlen(begins[k])) == 0) return older;
    return strstr(key, "mooring") ? wave_codes : NULL;
}
