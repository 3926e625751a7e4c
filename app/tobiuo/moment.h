/* What commands take of the outputs of a finished run. */
#pragma once
#include "app.h"

/* NULL: the output has no field of this name. */
const tobi_moment_field *find_moment_field(const tobi_moment *moment, const char *name);
/* The field of this name, or the one of which it names a component, "velocity_x"; component: -1 of the
   whole. */
const tobi_moment_field *find_moment_part(const tobi_moment *moment, const char *name, int *component);
/* 1: the field numbers things, so that means of it say nothing. */
int is_label_field(const char *name);
/* ", velocity, pressure": the fields of an output, for messages. */
void list_moment_fields(const tobi_moment *moment, char *list, size_t size);

/* Of the points of bodies, which may be much nearer to each other than the water's, one in each cell as wide
   as the spacing; the same ones at every output. Begin with zeros; free `row`. */
typedef struct thinned { int64_t of, count; int64_t *row; } thinned;
/* Those of an output; *points is the caller's. 0, or an exit code after a complaint. */
int take_body_points(const tobi_results *results, int64_t output, double spacing, thinned *t,
                     double (**points)[3], int64_t *count);
