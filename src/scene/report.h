/* The list of mistakes found in a scene. It ends at a limit, so that a hostile file with a million
   unknown keys gives an answer of a page. */
#pragma once
#include "tobiuo/scene.h"
#include "base/error.h"

enum { TOBI_REPORT_LIMIT = 200 };

/* NULL when out of memory. */
tobi_report *tobi_report_create(void);
/* Adds a formatted line; over the limit it is only counted. */
void tobi_report_add(tobi_report *report, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* True once further lines are only counted: looking for more detail is then a waste. */
int tobi_report_full(const tobi_report *report);
/* Adds the last line that says how many were left out, if any. */
void tobi_report_close(tobi_report *report);
/* Writes as many lines as fit into err and returns TOBI_INVALID, or TOBI_NO_MEMORY if a line could
   not be stored. */
tobi_status tobi_report_fail(const tobi_report *report, tobi_error *err);
