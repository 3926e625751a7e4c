/* How rows of the parameter tables are written, for the files that have them. */
#pragma once
#include "tobiuo/tobiuo.h"
#include "base/param.h"
#include <math.h>
#include <stddef.h>

#define AT(type, member_name) .offset = offsetof(type, member_name)
#define REAL     .type = TOBI_PARAM_REAL
#define INT      .type = TOBI_PARAM_INT
#define BOOL     .type = TOBI_PARAM_BOOL, .min = 0, .max = 1, .unit = "true or false"
#define VEC3     .type = TOBI_PARAM_VEC3
#define TEXT     .type = TOBI_PARAM_TEXT, .min = NAN, .max = NAN
#define RANGE(a, b) .min = (a), .max = (b)
/* Every number has a range: what lies outside of it is a slip of the pen, and what kernels make of all that
   lies within fits into single precision. test_limits.c steps worlds at both ends. */
#define PLACE    RANGE(-1e7, 1e7)                           /* m: within 10 000 km                     */
#define SPEED    RANGE(-TOBI_SPEED_LIMIT, TOBI_SPEED_LIMIT) /* m/s, and turns in rad/s                 */
#define LENGTHS  RANGE(1e-7, 1e5)                           /* m: of particles and grains              */
#define DURATION RANGE(1e-12, 1e9)                          /* s: up to 30 years                       */
#define DENSITY  RANGE(1e-6, 1e9)                           /* kg/m3                                   */
#define STIFFNESS RANGE(1e-6, 1e15)                         /* Pa: a thousand diamonds                 */
#define MASS     RANGE(1e-30, 1e30), .positive = true       /* kg: a written 0 is no mass               */
#define FRICTION RANGE(0, 1000)                             /* 1, of Coulomb                           */
#define DIRECTION RANGE(-1e9, 1e9)                          /* of any length                           */
#define ANGLE    RANGE(-1e6, 1e6)                           /* degrees                                 */
#define FACTOR   RANGE(1e-6, 1e6)                           /* 1, of sizes                             */
#define PULL     RANGE(-1e15, 1e15)                         /* N, N m                                  */
/* Red, green and blue; the word of the row stands for the default, which is no colour. */
#define COLOR .type = TOBI_PARAM_VEC3, .def = { -1, -1, -1 }, .min = 0, .max = 255, .unit = "RGB"
#define CHOICE(words, count) \
    .type = TOBI_PARAM_CHOICE, .min = 0, .max = (count) - 1, .choices = words, .unit = "word"
/* The keys of a member that is a tobi_outline_def, which the file of the table has included. */
#define OUTLINE_ROWS(type, member) \
    { .key = "outline.points", TEXT, AT(type, member.points), .unit = "points", \
      .doc = "Corners of a polygon, m: pairs of x and z, in 2-D of x and y. In 3-D it is extruded along " \
             "axis." }, \
    { .key = "outline.file", TEXT, AT(type, member.file), .unit = "path", \
      .doc = "A CSV file of the corners instead. Its first line names the two coordinates, as in x [mm]: " \
             "m, cm or mm." }, \
    { .key = "outline.base", REAL, AT(type, member.base), .def = { TOBI_NO_PLACE }, PLACE, \
      .unit = "m", .text = "none", .doc = "With it the points are a line to the right, as of a beach, and " \
             "the outline is what lies between it and this height." }, \
    { .key = "outline.axis", CHOICE("y|z|x", 3), AT(type, member.axis), \
      .doc = "Of the extrusion in 3-D: points are x and z for y, x and y for z, y and z for x." }, \
    { .key = "outline.from", REAL, AT(type, member.from), PLACE, .unit = "m", \
      .doc = "Where it begins along the axis; in 2-D it is not read." }, \
    { .key = "outline.to", REAL, AT(type, member.to), PLACE, .unit = "m", \
      .doc = "Where it ends along the axis; in 2-D it is not read." }
