/* The particles of the cells around a place, for sensors and surfaces that look at few of them. */
#pragma once
#include "core/system.h"
#include <math.h>

/* Cells of a box around x in box coordinates, not wrapped. */
typedef struct sph_range { int first[3], last[3]; } sph_range;

static inline sph_range sph_cells_around(const tobi_system *s, const double x[3], double reach)
{
    sph_range r;
    for (int a = 0; a < 3; a++) {
        r.first[a] = (int)floor((x[a] - reach)*s->cells.inverse[a]);
        r.last[a] = (int)floor((x[a] + reach)*s->cells.inverse[a]);
        if (s->cells.periodic[a]) {
            if (r.last[a] - r.first[a] >= s->cells.n[a]) r.last[a] = r.first[a] + s->cells.n[a] - 1;
            continue;
        }
        /* particles that left the box are in its outermost cells */
        r.first[a] = r.first[a] < 0 ? 0 : r.first[a] >= s->cells.n[a] ? s->cells.n[a] - 1 : r.first[a];
        r.last[a] = r.last[a] < 0 ? 0 : r.last[a] >= s->cells.n[a] ? s->cells.n[a] - 1 : r.last[a];
    }
    return r;
}

static inline int sph_wrap_cell(const tobi_system *s, int axis, int k)
{
    int n = s->cells.n[axis];
    return s->cells.periodic[axis] ? ((k % n) + n) % n : k;
}

/* Offset of particle i from x, the nearest image along periodic axes. */
static inline void sph_offset(const tobi_system *s, int64_t i, const double x[3], double d[3])
{
    const double *p = &s->particles.position[i].x;
    for (int a = 0; a < 3; a++) {
        d[a] = p[a] - x[a];
        if (s->box.periodic[a]) d[a] -= s->box.size[a]*round(d[a]/s->box.size[a]);
    }
    if (s->box.dimension == 2) d[2] = 0;
}

/* Calls see(user, i, offset) for every particle of the cells. */
typedef void (*sph_visitor)(void *user, int64_t i, const double d[3]);

static inline void sph_visit(const tobi_system *s, const double x[3], const sph_range *r, sph_visitor see,
                             void *user)
{
    double d[3];
    for (int z = r->first[2]; z <= r->last[2]; z++)
        for (int y = r->first[1]; y <= r->last[1]; y++) {
            int64_t row = tobi_cells_row(&s->cells, sph_wrap_cell(s, 1, y), sph_wrap_cell(s, 2, z));
            for (int k = r->first[0]; k <= r->last[0]; k++) {
                const int32_t *cell = s->cells.start + row + sph_wrap_cell(s, 0, k);
                for (int64_t i = cell[0]; i < cell[1]; i++) {
                    sph_offset(s, i, x, d);
                    see(user, i, d);
                }
            }
        }
}
