/* What the fluid presses and rubs each body with, on its surface: the pieces that the methods sum over, as
   triangles (2-D: lines) with their pressure and shear. Drawback: pieces share no corner, so that a file has
   three points a triangle. */
#include "sph/sensor/tractions.h"
#include "record/record.h"
#include "world/world.h"
#include <stdlib.h>
#include <string.h>

typedef struct tobi_tractions {
    int64_t count;
    double (*corner)[3];             /* m; [3 count], in 2-D [2 count]      */
    double *pressure, (*shear)[3];   /* Pa                                  */
} tobi_tractions;

/* Scratch of one body: its pieces. */
typedef struct pieces {
    const tobi_system *s;
    const tobi_body *b;
    double (*middle)[3], (*normal)[3], (*velocity)[3], *area;
    tobi_tractions *out;
} pieces;

static void look_at_pieces(const void *view, int64_t begin, int64_t end)
{
    const pieces *p = view;
    for (int64_t k = begin; k < end; k++) {
        sph_place place = { .point = p->b->point_of[k] };
        memcpy(place.x, p->middle[k], sizeof place.x);
        memcpy(place.normal, p->normal[k], sizeof place.normal);
        memcpy(place.velocity, p->velocity[k], sizeof place.velocity);
        sph_surface_look(p->s, p->b, &place, &p->out->pressure[k], p->out->shear[k]);
    }
}

static tobi_status look_at_body(const tobi_system *s, const tobi_body *b, tobi_tractions *t, tobi_error *err)
{
    const size_t n = (size_t)b->surface.count + 1;
    const int corners = b->surface.dimension;
    const double (*vertex)[3] = (const double (*)[3])b->vertex;
    const int32_t (*triangles)[3] = (const int32_t (*)[3])b->mesh.triangles;
    pieces p = { s, b, malloc(n*sizeof *p.middle), malloc(n*sizeof *p.normal), malloc(n*sizeof *p.velocity),
                 malloc(n*sizeof *p.area), t };
    *t = (tobi_tractions){ b->is_absent ? 0 : b->surface.count, malloc((size_t)corners*n*sizeof *t->corner),
                           malloc(n*sizeof *t->pressure), malloc(n*sizeof *t->shear) };
    const int there = p.middle && p.normal && p.velocity && p.area && t->corner && t->pressure && t->shear;
    if (there) {
        tobi_quadrature_update(&b->surface, vertex, triangles, p.middle, p.normal, p.area);
        tobi_quadrature_interpolate(&b->surface, triangles, (const double (*)[3])b->vertex_velocity,
                                    p.velocity);
        tobi_quadrature_corners(&b->surface, &b->mesh, vertex, t->corner);
        for (int64_t k = 0; k < corners*t->count; k++)
            for (int a = 0; a < 3; a++) t->corner[k][a] += b->lower[a];
        tobi_loop(s->sim->exec.threads, t->count, 0, look_at_pieces, &p);
    }
    free(p.middle);
    free(p.normal);
    free(p.velocity);
    free(p.area);
    return there ? TOBI_OK : tobi_fail(err, TOBI_NO_MEMORY, "output: out of memory");
}

tobi_status tobi_tractions_take(tobi_run *run, tobi_snapshot *snapshot, tobi_error *err)
{
    const tobi_system *s = tobi_world_fluids(run->world);
    snapshot->tractions = calloc((size_t)snapshot->surfaces + 1, sizeof *snapshot->tractions);
    if (!snapshot->tractions) return tobi_fail(err, TOBI_NO_MEMORY, "output: out of memory");
    TOBI_TRY(tobi_world_refresh(run->world, err));
    for (int b = 0; b < snapshot->surfaces; b++)
        TOBI_TRY(look_at_body(s, &run->world->sim.bodies[b], &snapshot->tractions[b], err));
    return TOBI_OK;
}

tobi_status tobi_tractions_write(tobi_run *run, const tobi_snapshot *snapshot, int b, tobi_error *err)
{
    const tobi_tractions *t = &snapshot->tractions[b];
    const tobi_vtk_array arrays[] = { { "pressure", TOBI_F64, 1, t->pressure },
                                      { "shear", TOBI_F64, 3, t->shear } };
    const tobi_vtk_cells cells = { .corners = run->world->sim.def.dimension, .count = t->count,
                                   .points = (const double (*)[3])t->corner, .arrays = arrays,
                                   .array_count = 2 };
    char *path = tobi_record_path(run->dir, "tractions/%s_%06lld.vtp", run->traction_file[b],
                                  (long long)snapshot->number);
    const tobi_status status =
        path ? tobi_vtp_write_cells(path, (tobi_compression)run->output.compression, &cells, err)
             : tobi_fail(err, TOBI_NO_MEMORY, "output: out of memory");
    free(path);
    return status;
}

void tobi_tractions_free(tobi_snapshot *snapshot)
{
    for (int b = 0; snapshot->tractions && b < snapshot->surfaces; b++) {
        free(snapshot->tractions[b].corner);
        free(snapshot->tractions[b].pressure);
        free(snapshot->tractions[b].shear);
    }
    free(snapshot->tractions);
}
