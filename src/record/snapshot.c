/* Snapshots: what the files of an output hold, copied from the world in the types that files have.

   Taking one changes nothing in the world but derived fields, so that a run that writes often has the same
   bits. Triangles and skins are not copied: they never change while a run lasts. Drawback: per particle one
   field more than the files hold is in memory while it is converted. */
#include "geom/texture.h"
#include "record/record.h"
#include "world/world.h"
#include <stdlib.h>
#include <string.h>

static tobi_status fail_memory(tobi_error *err)
{
    return tobi_fail(err, TOBI_NO_MEMORY, "output: out of memory");
}

/* Turns n doubles into the type they have in files, in a new array. */
static void *convert(const double *from, int64_t n, int type)
{
    void *to = malloc((size_t)n * tobi_type_size((tobi_type)type) + 1);
    if (!to) return NULL;
    if (type == TOBI_F32) for (int64_t i = 0; i < n; i++) ((float *)to)[i] = (float)from[i];
    else if (type == TOBI_I32)
        for (int64_t i = 0; i < n; i++) ((int32_t *)to)[i] = (int32_t)from[i];
    else for (int64_t i = 0; i < n; i++) ((int64_t *)to)[i] = (int64_t)from[i];
    return to;
}

static tobi_status add_array(tobi_point_set *set, const char *name, int type, int components,
                             const double *values, tobi_error *err)
{
    void *data = convert(values, set->count * components, type);
    if (!data) return fail_memory(err);
    set->array[set->arrays++] = (tobi_vtk_array){ name, (tobi_type)type, components, data };
    return TOBI_OK;
}

static tobi_status take_fields(tobi_run *run, tobi_set of, tobi_point_set *set, double *buffer,
                               tobi_error *err)
{
    TOBI_TRY(tobi_world_read(run->world, of, "position", &set->position[0][0], 3 * set->count, err));
    for (int k = 0; k < run->field_count; k++) {
        const tobi_record_field *f = &run->field[k];
        if (of == TOBI_BODIES && !f->bodies) continue;
        TOBI_TRY(tobi_world_read(run->world, of, f->name, buffer, set->count, err));
        TOBI_TRY(add_array(set, f->name, f->type, f->components, buffer, err));
    }
    return TOBI_OK;
}

/* Files have no particles of bodies that are absent: what reads them has no need to know. */
static void drop_absent(const tobi_world *w, tobi_point_set *set)
{
    int64_t from = 0, to = 0;
    for (int k = 0; k < w->sim.body_count; k++) {
        const tobi_body *b = &w->sim.bodies[k];
        const size_t n = (size_t)b->particle_count;
        const int moves = !b->is_absent && to != from;
        if (moves) memmove(set->position + to, set->position + from, n*sizeof *set->position);
        for (int f = 0; moves && f < set->arrays; f++) {
            const tobi_vtk_array *a = &set->array[f];
            const size_t each = tobi_type_size(a->type)*(size_t)a->components;
            char *data = (char *)a->data;
            memmove(data + (size_t)to*each, data + (size_t)from*each, n*each);
        }
        from += b->particle_count;
        if (!b->is_absent) to += b->particle_count;
    }
    set->count = to;
}

static tobi_status take_particles(tobi_run *run, tobi_set of, tobi_point_set *set, tobi_error *err)
{
    int64_t n = set->count = tobi_world_count(run->world, of);
    set->position = malloc((size_t)n * sizeof *set->position + 1);
    double *buffer = malloc((size_t)n * 9 * sizeof *buffer + 1);
    tobi_status status = set->position && buffer ? take_fields(run, of, set, buffer, err) : fail_memory(err);
    free(buffer);
    if (status == TOBI_OK && of == TOBI_BODIES) drop_absent(run->world, set);
    return status;
}

static tobi_status take_grid(tobi_run *run, tobi_point_set *set, tobi_error *err)
{
    const tobi_grid *g;
    TOBI_TRY(tobi_world_grid(run->world, &g, err));
    set->count = g->count;
    set->position = malloc((size_t)g->count * sizeof *set->position + 1);
    if (!set->position) return fail_memory(err);
    if (g->count > 0) memcpy(set->position, g->position, (size_t)g->count * sizeof *set->position);
    TOBI_TRY(add_array(set, "velocity", TOBI_F32, 3, &g->velocity[0][0], err));
    TOBI_TRY(add_array(set, "mass", TOBI_F32, 1, g->mass, err));
    return add_array(set, "stress", TOBI_F32, 6, &g->stress[0][0], err);
}

/* The skin of a body whose mesh has a texture, made at the first output. */
static tobi_status find_skin(tobi_run *run, int body, tobi_error *err)
{
    tobi_mesh *mesh = &run->world->sim.bodies[body].mesh;
    if (!mesh->texture) return TOBI_OK;
    if (!run->skin)
        run->skin = calloc((size_t)tobi_world_body_count(run->world) + 1, sizeof *run->skin);
    if (!run->skin) return fail_memory(err);
    run->skin_count = tobi_world_body_count(run->world);
    if (run->skin[body].vertex_count > 0) return TOBI_OK;
    TOBI_TRY(tobi_texture_prepare(mesh->texture, err));
    return tobi_skin_build(mesh, &run->skin[body], err);
}

void tobi_snapshot_free_skins(tobi_run *run)
{
    for (int k = 0; k < run->skin_count; k++) tobi_skin_free(&run->skin[k]);
    free(run->skin);
}

static tobi_status take_surfaces(tobi_run *run, tobi_snapshot *s, tobi_error *err)
{
    int64_t vertices, triangles;
    const double (*vertex)[3];
    const int32_t (*triangle)[3];
    s->surface = calloc((size_t)s->surfaces + 1, sizeof *s->surface);
    if (!s->surface) return fail_memory(err);
    for (int b = 0; b < s->surfaces; b++) {
        TOBI_TRY(tobi_world_surface(run->world, b, &vertices, &vertex, &triangles, &triangle));
        if (vertices == 0) continue;
        s->surface[b] = malloc((size_t)vertices * sizeof *s->surface[b] + 1);
        if (!s->surface[b]) return fail_memory(err);
        memcpy(s->surface[b], vertex, (size_t)vertices * sizeof *s->surface[b]);
        if (run->output.surfaces) TOBI_TRY(find_skin(run, b, err));
    }
    return TOBI_OK;
}

static tobi_status take_lines(const tobi_run *run, tobi_snapshot *s, tobi_error *err)
{
    s->lines = tobi_world_line_count(run->world);
    s->tube = malloc((size_t)s->lines*sizeof *s->tube + 1);
    if (!s->tube) return fail_memory(err);
    for (int k = 0; k < s->lines; k++)
        tobi_line_draw(&run->world->lines[k], 0.15*run->world->sim.def.spacing, &s->tube[k]);
    return TOBI_OK;
}

static tobi_status take_all(tobi_run *run, tobi_snapshot *s, tobi_error *err)
{
    TOBI_TRY(take_particles(run, TOBI_FLUID, &s->set[TOBI_SET_FLUID], err));
    if (s->surfaces) TOBI_TRY(take_particles(run, TOBI_BODIES, &s->set[TOBI_SET_BODIES], err));
    if (run->output.surfaces || run->output.obj || run->output.frames) TOBI_TRY(take_surfaces(run, s, err));
    if (run->output.surfaces || run->output.frames) TOBI_TRY(take_lines(run, s, err));
    if (run->output.tractions) TOBI_TRY(tobi_tractions_take(run, s, err));
    if (run->output.grid) TOBI_TRY(take_grid(run, &s->set[TOBI_SET_GRID], err));
    if (run->output.surface) TOBI_TRY(tobi_record_take_surface(run, s, err));
    if (run->output.frames) TOBI_TRY(tobi_frames_take(run, s, err));
    return tobi_tables_take(run, s, err);
}

tobi_status tobi_snapshot_take(tobi_run *run, tobi_snapshot **out, tobi_error *err)
{
    tobi_snapshot *s = calloc(1, sizeof *s);
    *out = NULL;
    if (!s) return fail_memory(err);
    s->number = run->outputs;
    s->surfaces = tobi_world_body_count(run->world);
    tobi_status status = take_all(run, s, err);
    if (status == TOBI_OK) *out = s;
    else tobi_snapshot_free(s);
    return status;
}

void tobi_snapshot_free(tobi_snapshot *s)
{
    if (!s) return;
    for (int k = 0; k < TOBI_SETS; k++) {
        for (int a = 0; a < s->set[k].arrays; a++) free((void *)s->set[k].array[a].data);
        free(s->set[k].position);
    }
    for (int b = 0; s->surface && b < s->surfaces; b++) free(s->surface[b]);
    free(s->surface);
    tobi_record_free_surface(s->skin);
    tobi_tractions_free(s);
    tobi_frames_free(s);
    free(s->tube);
    free(s->bodies.text);
    free(s->solids.text);
    free(s->history.text);
    free(s);
}
