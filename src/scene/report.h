/* The list of mistakes found in a scene. It ends at a limit, so that a hostile file with a million
   unknown keys gives an answer of a page. */
#pragma once
#include "tobiuo/scene.h"
#include "base/error.h"

enum { TOBI_REPORT_LIMIT = 200 };

/* NULL when out of memory. */
tobi_report *tobi_report_create(void);
/* Adds a formatted line; over the limit it is only counted. rank is the place to sort by, an offset
   in the scene's text; 0 comes first. */
void tobi_report_add(tobi_report *report, size_t rank, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* True once further lines are only counted: looking for more detail is then a waste. */
int tobi_report_full(const tobi_report *report);
/* The same for one mistake, which it counts then. */
int tobi_report_pass(tobi_report *report);
/* Mistakes so far, those that were only counted included. */
int64_t tobi_report_total(const tobi_report *report);
/* Sorts the lines and adds the one that says how many were left out, if any. */
void tobi_report_close(tobi_report *report);
/* Writes as many lines as fit into err and returns TOBI_INVALID, or TOBI_NO_MEMORY if a line could
   not be stored. */
tobi_status tobi_report_fail(const tobi_report *report, tobi_error *err);
