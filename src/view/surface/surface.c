/* The surface of particles: checks, then the stages one after the other over arrays in memory, for each
   spacing of particles in turn. Drawback: all blocks of the level set are kept until there are triangles. */
#include "view/surface/surface.h"
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

tobi_surface_def tobi_default_surface(void)
{
    return (tobi_surface_def){ .cell = 0.75, .smoothing = 20 };
}

static tobi_status check_box(const tobi_surface_def *d, tobi_error *err)
{
    for (int a = 0; a < 3; a++) {
        if (!d->flat_min[a] && !d->flat_max[a]) continue;
        if (!isfinite(d->box_min[a]) || !isfinite(d->box_max[a]) || !(d->box_min[a] < d->box_max[a]))
            return tobi_fail(err, TOBI_INVALID, "surface: the box is empty along %c", "xyz"[a]);
    }
    return TOBI_OK;
}

static tobi_status check_fields(const tobi_surface_def *d, tobi_error *err)
{
    if (d->field_count < 0 || d->field_count > TOBI_SURFACE_FIELD_LIMIT ||
        (d->field_count > 0 && !d->fields))
        return tobi_fail(err, TOBI_INVALID, "surface: %d fields, allowed are 0 to %d", d->field_count,
                         TOBI_SURFACE_FIELD_LIMIT);
    for (int f = 0; f < d->field_count; f++)
        if (d->fields[f].components < 1 || d->fields[f].components > 9 ||
            (d->particle_count > 0 && !d->fields[f].values))
            return tobi_fail(err, TOBI_INVALID, "surface: field %d has %d components and %s values, allowed "
                             "are 1 to 9", f, d->fields[f].components, d->fields[f].values ? tr("some")
                             : tr("no"));
    return TOBI_OK;
}

static tobi_status check_def(const tobi_surface_def *d, tobi_error *err)
{
    if (d->particle_count < 0 || d->particle_count > INT32_MAX/8 || (d->particle_count > 0 && !d->positions))
        return tobi_fail(err, TOBI_INVALID, "surface: %" PRId64 " particles%s, allowed are 0 to %d",
                         d->particle_count, d->positions ? "" : tr(" without positions"), INT32_MAX/8);
    if (!(d->spacing > 0) || !isfinite(d->spacing))
        return tobi_fail(err, TOBI_INVALID, "surface: a spacing of %g m, must be greater than 0",
                         d->spacing);
    if (!(d->cell >= 0.1 && d->cell <= 2))
        return tobi_fail(err, TOBI_INVALID, "surface: a cell of %g spacings, allowed are 0.1 to 2", d->cell);
    if (d->smoothing < 0 || d->smoothing > 100)
        return tobi_fail(err, TOBI_INVALID, "surface: %d rounds of smoothing, allowed are 0 to 100",
                         d->smoothing);
    for (int64_t i = 0; d->spacings && i < d->particle_count; i++)
        if (!(d->spacings[i] > 0) || !isfinite(d->spacings[i]))
            return tobi_fail(err, TOBI_INVALID, "surface: particle %" PRId64 " has a spacing of %g m, must "
                             "be greater than 0", i, d->spacings[i]);
    for (int64_t i = 0; d->group && i < d->particle_count; i++)
        if (d->group[i] >= 1 << 20)
            return tobi_fail(err, TOBI_INVALID, "surface: particle %" PRId64 " is of group %d, allowed are "
                             "those below %d", i, (int)d->group[i], 1 << 20);
    TOBI_TRY(check_box(d, err));
    return check_fields(d, err);
}

static tobi_status run_stages(surface_work *w, tobi_surface **surface, tobi_error *err)
{
    TOBI_TRY(surface_place_points(w, err));
    TOBI_TRY(surface_list_blocks(w, err));
    TOBI_TRY(surface_find_drops(w, err));
    TOBI_TRY(surface_march(w, err));
    TOBI_TRY(surface_find_parts(w, err));
    TOBI_TRY(surface_merge_short(w, err));
    TOBI_TRY(surface_take_values(w, err));
    TOBI_TRY(surface_make_fans(w, err));
    TOBI_TRY(surface_smooth(w, err));
    surface_make_normals(w);
    return surface_make_result(w, surface, err);
}

void surface_free_work(surface_work *w)
{
    void *const arrays[] = {
        w->x, w->y, w->z, w->count, w->strength, w->of, w->bin_key, w->block_key, w->bin_begin, w->node,
        w->beside, w->rows, w->vertex_begin, w->triangle_begin, w->vertex, w->sides, w->block_of, w->triangle,
        w->part,
        w->part_volume, w->fan_begin, w->fan, w->normal, w->drop
    };
    for (size_t k = 0; k < sizeof arrays/sizeof *arrays; k++) tobi_array_free(arrays[k]);
    for (int f = 0; f < TOBI_SURFACE_FIELD_LIMIT; f++) tobi_array_free(w->fields[f]);
    tobi_exec_free(&w->exec);
}

/* Of particles of one spacing. */
static tobi_status make_one(const tobi_surface_def *def, tobi_surface **surface, tobi_error *err)
{
    surface_work w = { .def = def };
    tobi_status status = tobi_exec_init(&w.exec, def->threads, err);
    if (status == TOBI_OK) status = tobi_exec_reserve(&w.exec, 8*def->particle_count + TOBI_BLOCK, err);
    if (status == TOBI_OK) status = run_stages(&w, surface, err);
    surface_free_work(&w);
    return status;
}

tobi_status tobi_surface_make(const tobi_surface_def *def, tobi_surface **surface, tobi_error *err)
{
    TOBI_NEED(surface, "surface");
    *surface = NULL;
    TOBI_NEED(def, "def");
    TOBI_TRY(check_def(def, err));
    return def->spacings ? surface_make_each(def, make_one, surface, err) : make_one(def, surface, err);
}
