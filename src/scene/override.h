/* Values from the command line, put into the JSON of a scene before it is bound, so that they are
   checked like everything else. */
#pragma once
#include "scene/source.h"

/* Applies "path=value" texts (ended by NULL, or NULL) in order. A path is keys with dots, entries
   of lists by [number] or by .name; missing objects on the way are made. Mistakes go to the report.
 */
tobi_status tobi_override_apply(tobi_source *source, const char *const *overrides, tobi_error *err);
