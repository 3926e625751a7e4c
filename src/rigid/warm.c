/* The impulses of contacts for checkpoints: a resumed run starts its sweeps from the same ones. Drawback:
   keys of contacts are split over two doubles, as checkpoints hold nothing else. */
#include "rigid/dynamics_state.h"
#include "geom/vec3.h"
#include <stdlib.h>
#include <string.h>

enum { KEY_HALF = 30 };

int64_t tobi_rigid_warm(const tobi_dynamics_state *d, double *rows)
{
    int64_t n = 0;
    for (int64_t k = 0; k < d->contacts.count; k++) {
        const tobi_touch *c = &d->contacts.at[k];
        if (c->impulse == 0 && vec3_dot(c->slide, c->slide) == 0) continue;
        double row[TOBI_WARM] = { c->a, c->b, (double)(c->key >> KEY_HALF),
                                  (double)(c->key & (((int64_t)1 << KEY_HALF) - 1)), c->impulse,
                                  c->slide[0], c->slide[1], c->slide[2] };
        if (rows) memcpy(rows + TOBI_WARM*n, row, sizeof row);
        n++;
    }
    return n;
}

static tobi_status read_warm(const tobi_dynamics_state *d, int64_t count, const double *rows,
                             tobi_touch_list *out, tobi_error *err)
{
    for (int64_t k = 0; k < count; k++) {
        const double *row = rows + TOBI_WARM*k;
        for (int i = 0; i < TOBI_WARM; i++)
            if (!isfinite(row[i]) || fabs(row[i]) > 1e18)
                return tobi_fail(err, TOBI_DAMAGED, "the contact %lld of the bodies is no number",
                                 (long long)k);
        if (row[0] < 0 || row[0] >= d->count || row[1] < -TOBI_SIDES - d->world.plane_count ||
            row[1] >= d->count)
            return tobi_fail(err, TOBI_DAMAGED, "the contact %lld names no body of the scene", (long long)k);
        tobi_touch *c = tobi_touch_add(out);
        if (!c) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for contacts");
        c->a = (int32_t)row[0];
        c->b = (int32_t)row[1];
        c->key = (int64_t)((uint64_t)(int64_t)fmin(row[2], 1e10) << KEY_HALF) | (int64_t)row[3];
        c->impulse = row[4];
        memcpy(c->slide, row + 5, sizeof c->slide);
    }
    return TOBI_OK;
}

tobi_status tobi_rigid_set_warm(tobi_dynamics_state *d, int64_t count, const double *rows, tobi_error *err)
{
    tobi_touch_list read = { 0 };
    const tobi_status status = read_warm(d, count, rows, &read, err);
    if (status != TOBI_OK) {
        free(read.at);
        return status;
    }
    tobi_touch_list *kept = &d->contacts;      /* its memory, if that suffices: steps allocate nothing */
    if (kept->capacity >= read.count) {
        if (read.count > 0) memcpy(kept->at, read.at, (size_t)read.count*sizeof *read.at);
        kept->count = read.count;
        free(read.at);
    } else {
        free(kept->at);
        *kept = read;
    }
    return TOBI_OK;
}
