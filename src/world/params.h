/* The parameter tables of every definition struct in tobiuo/types.h: the only place that says a
   member's scene key, unit, default, range and sentence. The world's is in params.c, the others are in
   params_matter.c, params_bodies.c and params_output.c. Each method brings its own (tobi_method.params).

   Conventions of the rows, on top of base/param.h:
   - A key with dots is a key of a nested object in a scene: "domain.min" is domain: { min: ... }.
   - "key[0]", "key[1]" are the entries of one list in a scene; one value alone stands for all.
   - TOBI_PARAM_TEXT: unit "name", "method" (the name of one), "path" (a file, looked up beside the
     scene), "names" (a list, of particle fields) or "text" (anything in one line).
   - Numbers: text, if set, is a word that may be written for the value 0 ("adaptive", "all"); of a
     number that must be positive only the word stands for it, and a written 0 is refused.
   - TOBI_PARAM_VEC3: text, if set, is a word for the default, which may lie out of the range
     ("automatic" for a colour).
   - TOBI_PARAM_VEC3 that must be positive (a scale) may be written as one number. */
#pragma once
#include "base/param.h"
#include "tobiuo/types.h"

extern const tobi_param_table tobi_world_table;
extern const tobi_param_table tobi_fluid_table;
extern const tobi_param_table tobi_solid_table;
extern const tobi_param_table tobi_fill_table;
extern const tobi_param_table tobi_body_table;
extern const tobi_param_table tobi_plane_table;
extern const tobi_param_table tobi_probe_table;
extern const tobi_param_table tobi_output_table;
extern const tobi_param_table tobi_reference_table;

/* Every table by index, NULL past the end. */
const tobi_param_table *tobi_param_table_at(int index);
/* The parameters of a method by its name ("dfsph"), NULL if there is no such method. */
const tobi_param_table *tobi_method_table(const char *method);

/* Whether a tobi_model reads a row of the solid table; the material constants that it reads, "a, b". */
int  tobi_solid_uses(int model, const char *key);
void tobi_solid_list(int model, char *text, size_t size);

/* The number of words in "a|b|c", and word i of it (not terminated), its length in *length;
   NULL past the end. */
int tobi_choice_count(const char *choices);
const char *tobi_choice_word(const char *choices, int i, int *length);
