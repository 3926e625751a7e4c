/* Parameter files of Python programs, as JSON: names = numbers, texts, lists, tuples and dicts,
   with arithmetic on numbers and on names given before. Nothing is run: what is not one of these is
   refused in words. */
#pragma once
#include "scene/report.h"

/* Whether a file of this name is read as Python. */
int tobi_python_applies(const char *name);
/* The assignments as the text of one JSON object, every value in the line it has in the file and,
   where there is room, in its column, so that places found in the JSON are those of the file. *json
   is NUL-terminated and owned by the caller. `import` lines are passed over, and so are tails of
   comments that wrapped. TOBI_INVALID with the mistakes in the report, TOBI_NO_MEMORY. */
tobi_status tobi_python_to_json(const char *name, const char *text, size_t size, char **json,
                                tobi_report *report, tobi_error *err);
