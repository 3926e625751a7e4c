/* A script of the user: a text file in Lua; loading, control and flow are in tobiuo/motion.h. A motion script
   defines exactly one of

     function deform(x, y, z, t, steer) -- rest position (m), time (s), what control steers with
         return x, y, z                 -- position (m)
     end

     function place(t)                  -- time (s)
         return px, py, pz              -- shift of the body (m), or
         return px, py, pz, ax, ay, az, degrees   -- and a turn about the axis (ax, ay, az)
     end

   Rest positions are the points of the mesh after the scene's scale, rotation and translation. The
   turn of place() is right-handed, about the global `pivot = {x, y, z}` (rest coordinates, m;
   {0, 0, 0} when the script does not set it): position = pivot + p + R (rest - pivot).

   A control script defines

     function control(t, body)          -- time (s) and what the body does, see below
         return { force = {x, y, z}, torque = {x, y, z}, phase = 2, hold = "z,turn",
                  steer = {a, b, c}, state = {a, b, ...}, motor = { NAME = number } }
     end

   Every key of the answer may be left out, and no answer at all is no force. body has position (m),
   orientation (w, x, y, z), velocity, angular_velocity (rad/s), contact_force (N) and contact_torque (N m) of
   the last step as lists, and the numbers mass, phase, phase_time (s since the phase began) and step (s,
   the last), and inertia: xx, yy, zz, xy, xz, yz (kg m2) about the centre, in world axes, now. steer is
   what it answered last, for deform() of the same body; state likewise, up to 16 numbers for the program
   alone. The force acts on the centre of mass, in world axes. phase, a whole number, is 1 at the start and
   then what the script answered last. These three are the only memory a script may have, since a restart
   begins with them; globals cannot be assigned after loading, tables and locals outside control are not
   watched. hold names the axes that stand still in this step, like `locked` of a body. body.joints.NAME has
   angle (degrees) and speed (degrees/s) of each hinge of the body, position (m) and speed (m/s) of its guide;
   motor tells its motor what to do.

   A flow script defines

     function velocity(x, y, z)         -- place (m)
         return vx, vy, vz              -- velocity of what is there at the start (m/s)
     end

   The script sees `params` (motion.params, control.params or flow.params of the scene: numbers, texts,
   true/false, arrays from 1, objects), math (without random), table, ipairs, pairs, select, tonumber,
   tostring, type, unpack, error, assert, and string.format/len/sub/byte/char/lower/upper. Nothing else: no
   files, no processes, no compiled chunks, no foreign code. After loading, reading or assigning an unknown
   global is an error, because it is nearly always a misspelt name, and because a motion that
   remembers things would break restarts. Two runs see the same: pairs goes through numbers, then texts, in
   rising order, and tostring of a table is "table".

   A script has 3 s of processor time for a call (for each 8192 points of deform and velocity) and for
   its loading, and 64 MiB. One that needs more time is stopped for good: every later call repeats the
   reason. */
#pragma once
#include "base/error.h"
#include "tobiuo/motion.h"

/* A rigid placement; axis has unit length. */
typedef struct tobi_pose {
    double shift[3];      /* m        */
    double axis[3];       /* 1        */
    double degrees;       /* degrees  */
    double pivot[3];      /* m        */
} tobi_pose;

/* tobi_script_load with another limit of processor time, for tests. */
tobi_status tobi_script_load_within(const char *path, const char *params_json, tobi_script_role role,
                                    double seconds, tobi_script **out, tobi_error *err);

/* 1 when the script defines place(), 0 when it defines deform(). */
int tobi_script_is_rigid(const tobi_script *script);

/* What deform() gets as its last argument from now on. */
void tobi_script_steer(tobi_script *script, const double steer[3]);
/* Calls deform() for n points. */
tobi_status tobi_script_deform(tobi_script *script, double t, int64_t n, const double (*rest)[3],
                               double (*position)[3], tobi_error *err);
/* Calls place(). */
tobi_status tobi_script_place(tobi_script *script, double t, tobi_pose *pose, tobi_error *err);
