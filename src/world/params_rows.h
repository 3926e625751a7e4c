/* How rows of the parameter tables are written, for the files that have them. */
#pragma once
#include "tobiuo/tobiuo.h"
#include "world/params.h"
#include <math.h>
#include <stddef.h>

#define AT(type, member_name) .offset = offsetof(type, member_name)
#define REAL     .type = TOBI_PARAM_REAL
#define INT      .type = TOBI_PARAM_INT
#define BOOL     .type = TOBI_PARAM_BOOL, .min = 0, .max = 1, .unit = "true or false"
#define VEC3     .type = TOBI_PARAM_VEC3
#define TEXT     .type = TOBI_PARAM_TEXT, .min = NAN, .max = NAN
#define ANY      .min = NAN, .max = NAN
#define FROM(a)  .min = (a), .max = NAN
#define RANGE(a, b) .min = (a), .max = (b)
#define POSITIVE .min = 0, .max = NAN, .positive = true
/* Red, green and blue; the word of the row stands for the default, which is no colour. */
#define COLOR .type = TOBI_PARAM_VEC3, .def = { -1, -1, -1 }, .min = 0, .max = 255, .unit = "RGB"
#define CHOICE(words, count) \
    .type = TOBI_PARAM_CHOICE, .min = 0, .max = (count) - 1, .choices = words, .unit = "word"
