/* Means of the particles' fields at the vertices, while these lie where the level set has put them; smoothing
   then carries the values along. Drawback: an image in a flat side counts with the value of its particle, so
   that a velocity towards the side does not vanish there. */
#include "view/surface/surface.h"
#include <string.h>

tobi_status surface_take_values(surface_work *w, tobi_error *err)
{
    const tobi_surface_def *d = w->def;
    surface_view *v = &w->view;
    int32_t components[TOBI_SURFACE_FIELD_LIMIT];
    const double *values[TOBI_SURFACE_FIELD_LIMIT];
    for (int f = 0; f < d->field_count; f++) {
        const int64_t n = (w->vertices + 12*w->drops)*d->fields[f].components;
        components[f] = d->fields[f].components;
        values[f] = d->fields[f].values;
        w->fields[f] = tobi_array_make(n + 1, sizeof(float));
        if (!w->fields[f]) return surface_no_memory(err, 4.0*(double)n);
    }
    v->vertex = w->vertex;
    v->block_of = w->block_of;
    v->of = w->of;
    v->vertex_count = w->vertices;
    v->field_count = d->field_count;
    v->components = components;
    v->values = values;
    v->fields = w->fields;
    const int64_t chunks = (w->vertices + SURFACE_CHUNK - 1)/SURFACE_CHUNK;
    tobi_launch_each(&w->exec, tobi_view_kernels_for(w->exec.isa)->surface_values, v, chunks, NULL);
    v->components = NULL;
    v->values = NULL;
    return TOBI_OK;
}
