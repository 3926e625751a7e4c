/* Surfaces of particles of several spacings: a pass for each spacing, in which the others are left out, then
   one mesh. So each is as fine as its particles. Drawback: while two meshes become one, both are kept. */
#include "view/surface/surface.h"
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_SPACINGS = 16 };

/* Different spacings in the order of their first particles; how many, or -1 for too many. */
static int list_spacings(const tobi_surface_def *d, double spacing[MOST_SPACINGS])
{
    int n = 0, last = 0;
    for (int64_t i = 0; i < d->particle_count; i++) {
        if (n > 0 && d->spacings[i] == spacing[last]) continue;
        for (last = 0; last < n && spacing[last] != d->spacings[i];) last++;
        if (last < n) continue;
        if (n == MOST_SPACINGS) return -1;
        spacing[n++] = d->spacings[i];
    }
    return n;
}

/* Puts another array behind the one at `place`; false: no memory, and it stays as it was. */
static bool join(void *place, int64_t count, const void *more, int64_t more_count, size_t size)
{
    void *array;
    char *longer = tobi_array_make(count + more_count + 1, size);
    if (!longer) return false;
    memcpy(&array, place, sizeof array);      /* whatever it points to */
    memcpy(longer, array, (size_t)count*size);
    memcpy(longer + (size_t)count*size, more, (size_t)more_count*size);
    tobi_array_free(array);
    memcpy(place, &longer, sizeof longer);
    return true;
}

/* Adds a mesh to one with the same fields. */
static tobi_status add_mesh(tobi_surface *s, const tobi_surface *part, tobi_error *err)
{
    const int64_t n = s->vertex_count, m = s->triangle_count;
    const double bytes = 53.0*(double)(n + part->vertex_count) + 12.0*(double)(m + part->triangle_count);
    if (n + part->vertex_count > INT32_MAX) return surface_no_memory(err, bytes);
    bool good = join(&s->vertices, n, part->vertices, part->vertex_count, sizeof *s->vertices) &&
                join(&s->normals, n, part->normals, part->vertex_count, sizeof *s->normals) &&
                join(&s->group, n, part->group, part->vertex_count, sizeof *s->group) &&
                join(&s->sides, n, part->sides, part->vertex_count, sizeof *s->sides) &&
                join(&s->triangles, m, part->triangles, part->triangle_count, sizeof *s->triangles);
    for (int f = 0; good && f < s->field_count; f++)
        good = join(&s->fields[f], n, part->fields[f], part->vertex_count,
                    (size_t)s->field_components[f]*sizeof *s->fields[f]);
    if (!good) return surface_no_memory(err, bytes);
    for (int64_t k = m; k < m + part->triangle_count; k++)
        for (int a = 0; a < 3; a++) s->triangles[k][a] += (int32_t)n;
    s->vertex_count += part->vertex_count;
    s->triangle_count += part->triangle_count;
    return TOBI_OK;
}

tobi_status surface_make_each(const tobi_surface_def *def, surface_maker *make, tobi_surface **surface,
                              tobi_error *err)
{
    double spacing[MOST_SPACINGS] = { def->spacing };
    tobi_surface_def d = *def;
    const int count = list_spacings(def, spacing);
    if (count < 0)
        return tobi_fail(err, TOBI_INVALID, "surface: particles of more than %d different spacings",
                         MOST_SPACINGS);
    d.spacing = spacing[0];
    if (count <= 1) return make(&d, surface, err);
    int32_t *group = malloc((size_t)def->particle_count*sizeof *group);
    tobi_status status = group ? TOBI_OK : surface_no_memory(err, 4.0*(double)def->particle_count);
    d.group = group;
    for (int k = 0; status == TOBI_OK && k < count; k++) {
        tobi_surface *part = NULL;
        d.spacing = spacing[k];
        for (int64_t i = 0; i < def->particle_count; i++)
            group[i] = def->spacings[i] != spacing[k] ? -1 : def->group ? def->group[i] : 0;
        status = make(&d, &part, err);
        if (status == TOBI_OK && *surface) {
            status = add_mesh(*surface, part, err);
            tobi_surface_free(part);
        } else if (status == TOBI_OK) *surface = part;
    }
    free(group);
    if (status == TOBI_OK) return status;
    tobi_surface_free(*surface);
    *surface = NULL;
    return status;
}
